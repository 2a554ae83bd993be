//! The modules and their dependencies are those of ARCHITECTURE.md.

use crate::common::{files, quoted, read, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The libraries.
const LIBRARIES: [&str; 4] = ["plica-mechanics", "plica", "plica-view", "plica-verify"];

/// Modules that each module uses. Names of modules are unique across the libraries.
type Uses = BTreeMap<String, BTreeSet<String>>;

#[test]
fn modules_use_only_what_the_page_allows() {
    let mut found = Uses::new();
    for library in LIBRARIES {
        let source = root().join("crates").join(library).join("src");
        for entry in fs::read_dir(source).unwrap() {
            let path = entry.unwrap().path();
            let module = path.file_stem().unwrap().to_str().unwrap().to_owned();
            let sources = match path.is_dir() {
                true => files(&path, "rs"),
                false if module != "lib" => vec![path],
                false => continue,
            };
            let mut used: BTreeSet<String> = sources.iter().flat_map(|f| used_by(f)).collect();
            used.remove(&module);
            let previous = found.insert(module.clone(), used);
            assert!(previous.is_none(), "two modules are named {module}");
        }
    }
    let (_, allowed) = table();
    let modules = |uses: &Uses| uses.keys().cloned().collect::<Vec<String>>();
    assert_eq!(
        modules(&allowed),
        modules(&found),
        "modules of the page and of the source"
    );
    for (module, used) in &found {
        assert_eq!(
            &allowed[module], used,
            "`{module}`: uses on the page and in the source"
        );
    }
}

#[test]
fn dependencies_point_up_the_page() {
    let (order, allowed) = table();
    for (at, module) in order.iter().enumerate() {
        for used in &allowed[module] {
            assert!(order[..at].contains(used), "{module} uses {used}");
        }
    }
}

#[test]
fn every_file_is_compiled() {
    for source in LIBRARIES.iter().chain(&["plica-cli"]) {
        for file in files(&root().join("crates").join(source).join("src"), "rs") {
            let (folder, name) = (file.parent().unwrap(), file.file_stem().unwrap());
            let name = name.to_str().unwrap();
            if !["mod", "lib", "main"].contains(&name) {
                let parents = ["mod.rs", "lib.rs", "main.rs"].map(|parent| folder.join(parent));
                let parent = parents.iter().find(|parent| parent.exists()).unwrap();
                let declared = read(parent).contains(&format!("mod {name};"));
                assert!(declared, "{} is not part of any module", file.display());
            }
        }
    }
}

/// Reads the rows `| module | contents | may use |` of the page: the modules in their order, and what each may use.
fn table() -> (Vec<String>, Uses) {
    let (mut order, mut uses) = (vec![], Uses::new());
    for row in read("ARCHITECTURE.md")
        .lines()
        .filter(|line| line.starts_with("| `"))
    {
        let cells: Vec<&str> = row.split('|').collect();
        let module = quoted(cells[1]).remove(0);
        order.push(module.clone());
        uses.insert(module, quoted(cells[3]).into_iter().collect());
    }
    (order, uses)
}

/// Returns the modules that a file names in paths from the root of a library, except in tests and comments.
fn used_by(file: &Path) -> BTreeSet<String> {
    let name = file.file_name().unwrap().to_str().unwrap();
    let is_tests = name.ends_with("tests.rs") || file.parent().unwrap().ends_with("tests");
    if is_tests {
        return BTreeSet::new();
    }
    let text = read(file);
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let lines = code.lines().map(|line| line.split("//").next().unwrap());
    let code = lines.collect::<Vec<&str>>().join("\n");
    let mut modules = BTreeSet::new();
    for root in ["crate::", "plica::", "plica_view::"] {
        for (at, _) in code.match_indices(root) {
            let is_name = |c: char| c.is_alphanumeric() || c == '_';
            if !code[..at].ends_with(is_name) {
                modules.extend(first_names(&code[at + root.len()..]));
            }
        }
    }
    // The other names are items that the root exports.
    modules.retain(|name| name.starts_with(|c: char| c.is_ascii_lowercase()));
    modules
}

/// Returns the first names of a path, or of each path of a list in braces.
fn first_names(path: &str) -> Vec<String> {
    let name = |path: &str| {
        let end = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        path.trim_start().split(end).next().unwrap().to_owned()
    };
    if !path.starts_with('{') {
        return vec![name(path)];
    }
    let (mut names, mut depth) = (vec![], 0);
    for (at, c) in path.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 1 && (c == '{' || c == ',') {
            names.push(name(&path[at + 1..]));
        }
        if depth == 0 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}
