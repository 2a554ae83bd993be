//! Holds ARCHITECTURE.md's table of rooms and arrows against the source.

mod common;

use common::{files, quoted, root, text};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// What each room uses.
type Arrows = BTreeMap<String, BTreeSet<String>>;

#[test]
fn rooms_use_what_the_page_says() {
    let mut used = Arrows::new();
    for entry in fs::read_dir(root().join("crates/plica/src")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let room = path.file_name().unwrap().to_str().unwrap().to_owned();
            let mut rooms: BTreeSet<String> =
                files(&path, "rs").iter().flat_map(|f| named(f)).collect();
            rooms.remove(&room);
            used.insert(room, rooms);
        }
    }
    // Left: ARCHITECTURE.md. Right: `crate::…` in the source.
    assert_eq!(table().1, used);
}

#[test]
fn arrows_point_up_the_page() {
    let (order, table) = table();
    for (at, room) in order.iter().enumerate() {
        for used in &table[room] {
            assert!(order[..at].contains(used), "{room} uses {used}");
        }
    }
}

#[test]
fn every_file_is_compiled() {
    for crate_ in ["crates/plica/src", "crates/plica-cli/src"] {
        for file in files(&root().join(crate_), "rs") {
            let (folder, name) = (file.parent().unwrap(), file.file_stem().unwrap());
            let name = name.to_str().unwrap();
            if !["mod", "lib", "main"].contains(&name) {
                let parents = ["mod.rs", "lib.rs", "main.rs"].map(|parent| folder.join(parent));
                let parent = parents.iter().find(|parent| parent.exists()).unwrap();
                let declared = text(parent).contains(&format!("mod {name};"));
                assert!(declared, "{} is in no module", file.display());
            }
        }
    }
}

/// The rows of the page's table: the rooms in their order, and what each may use.
fn table() -> (Vec<String>, Arrows) {
    let (mut order, mut table) = (vec![], Arrows::new());
    let page = text("ARCHITECTURE.md");
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').collect();
        let room = quoted(cells[1]).remove(0);
        order.push(room.clone());
        table.insert(room, quoted(cells[3]).into_iter().collect());
    }
    (order, table)
}

/// The rooms that a file names after `crate::`, tests and comments aside.
fn named(file: &Path) -> BTreeSet<String> {
    if is_test(file) {
        return BTreeSet::new();
    }
    let text = text(file);
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let code: Vec<&str> = code
        .lines()
        .map(|l| l.split("//").next().unwrap())
        .collect();
    let mut rooms = BTreeSet::new();
    for after in code.join("\n").split("crate::").skip(1) {
        // `crate::room::…`, or `crate::{room, room::…}`.
        let paths: Vec<&str> = match after.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap().split(',').collect(),
            None => vec![after],
        };
        for path in paths {
            let end = |c: char| !c.is_ascii_alphanumeric() && c != '_';
            rooms.insert(path.trim().split(end).next().unwrap().to_owned());
        }
    }
    rooms
}

/// A file of tests alone, in its own folder or not; plain twins are there for tests only.
fn is_test(file: &Path) -> bool {
    let within = file
        .parent()
        .is_some_and(|folder| folder.ends_with("tests"));
    within || file.ends_with("tests.rs") || file.ends_with("plain.rs")
}
