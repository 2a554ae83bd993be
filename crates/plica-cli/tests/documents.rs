//! The documents agree with the files, commands, tests and columns they name.

use crate::common::{SHORT, files, quoted, read, root, scratch, succeed};
use plica::study::Row;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the paths of all pages.
fn pages() -> Vec<PathBuf> {
    let mut pages = files(&root().join("docs"), "md");
    let top = fs::read_dir(root()).unwrap();
    pages.extend(top.map(|entry| entry.unwrap().path()));
    pages.retain(|page| page.extension().is_some_and(|e| e == "md"));
    assert!(pages.len() >= 9);
    pages
}

#[test]
fn links_point_to_existing_files() {
    for page in pages() {
        for link in read(&page).split("](").skip(1) {
            let target = link.split([')', '#']).next().unwrap();
            if !target.contains("://") {
                let file = page.parent().unwrap().join(target);
                assert!(file.exists(), "{}: {target}", page.display());
            }
        }
    }
}

/// Commands in shell blocks, of the program or run by cargo.
#[test]
fn the_commands_of_the_pages_exist() {
    let mut help = BTreeMap::new();
    let commands = succeed(&root(), &["--help"]);
    let mut checked = 0;
    for page in pages() {
        let text = read(&page);
        let blocks = text.split("```").skip(1).step_by(2);
        let lines = blocks.filter_map(|block| block.strip_prefix("sh\n"));
        for line in lines.flat_map(str::lines) {
            let line = line.split(" #").next().unwrap();
            let starts = ["plica ", "cargo run --release -- "];
            let Some(words) = starts.iter().find_map(|start| line.strip_prefix(start)) else {
                continue;
            };
            let mut words = words.split_whitespace();
            let command = words.next().unwrap().to_owned();
            let place = format!("{}: {line}", page.display());
            let exists = commands.contains(&format!("\n  {command} "));
            assert!(exists || command == "--help", "{place}");
            let help = help
                .entry(command.clone())
                .or_insert_with(|| match &command[..] {
                    "sweep" => ["check", "run", "status", "table", "picture", "point"]
                        .map(|own| succeed(&root(), &["sweep", own, "--help"]))
                        .concat(),
                    "materials" => ["show", "plot", "fit"]
                        .map(|own| succeed(&root(), &["materials", own, "--help"]))
                        .concat(),
                    command => succeed(&root(), &[command, "--help"]),
                });
            for word in words {
                if let Some(option) = word.strip_prefix("--") {
                    let option = format!("--{}", option.split('=').next().unwrap());
                    let is_end = |c: char| !c.is_alphanumeric() && c != '-';
                    let known = help
                        .match_indices(&option)
                        .any(|(at, _)| help[at + option.len()..].starts_with(is_end));
                    assert!(known, "{place}: {option}");
                }
                if word.starts_with("cases/") {
                    assert!(root().join(word).exists(), "{place}: {word}");
                }
            }
            checked += 1;
        }
    }
    assert!(checked > 10, "{checked} commands");
}

/// Returns the blocks of code of a page with their language.
fn blocks(page: &str) -> Vec<(&str, &str)> {
    let blocks = page.split("```").skip(1).step_by(2);
    blocks.filter_map(|block| block.split_once('\n')).collect()
}

/// Returns whether a text is as shown: `…` stands for the rest of a word, and alone in a line for any lines.
fn is_as_shown(text: &str, shown: &str) -> bool {
    let mut lines = text.lines();
    let same = |line: &str, shown: &str| {
        let mut words = line.split_whitespace();
        let as_shown = shown.split_whitespace().all(|shown| {
            let word = words.next().unwrap_or_default();
            match shown.split_once('…') {
                Some((before, after)) => word.starts_with(before) && word.ends_with(after),
                None => word == shown,
            }
        });
        as_shown && words.next().is_none()
    };
    let mut any = false;
    for line in shown.lines() {
        if line.trim() == "…" {
            any = true;
        } else if any {
            any = false;
            if !lines.any(|own| same(own, line)) {
                return false;
            }
        } else if !lines.next().is_some_and(|own| same(own, line)) {
            return false;
        }
    }
    any || lines.next().is_none()
}

/// Files, commands and what they print, in the order of the page.
#[test]
fn the_steps_of_the_tutorial_give_what_it_shows() {
    let directory = scratch("tutorial");
    let page = read("docs/tutorial.md");
    let (mut printed, mut runs, mut compared) = (String::new(), 0, 0);
    for (language, block) in blocks(&page) {
        match language {
            "toml" => {
                let name = block.lines().next().unwrap().trim_start_matches("# ");
                fs::write(directory.join(name), block).unwrap();
            }
            "sh" => {
                for line in block.lines() {
                    let words: Vec<&str> = line.split_whitespace().skip(1).collect();
                    printed = succeed(&directory, &words);
                    runs += 1;
                }
            }
            "text" => {
                assert!(is_as_shown(&printed, block), "{block}\nbut\n{printed}");
                compared += 1;
            }
            _ => assert_eq!(language, "python"),
        }
    }
    assert!(runs >= 5 && compared >= 3, "{runs} {compared}");
    for picture in ["tubes.png", "curve.png"] {
        assert!(directory.join(picture).exists(), "{picture}");
    }
}

#[test]
fn a_text_is_as_shown_only_if_its_lines_are() {
    assert!(is_as_shown("a 12 kPa\nb\nc\n", "a 1… kPa\n…\nc\n"));
    assert!(!is_as_shown("a 22 kPa\nb\nc\n", "a 1… kPa\n…\nc\n"));
    assert!(!is_as_shown("a 12 kPa\nb\n", "a 12 kPa\n…\nc\n"));
    assert!(!is_as_shown("a\nb\n", "a\n"));
}

/// Returns the keys of the whole case, which come first, and its tables.
fn split(case: &str) -> [String; 2] {
    let mut parts = [String::new(), String::new()];
    let mut tables = 0;
    for line in case.lines() {
        tables = tables.max(usize::from(line.starts_with('[')));
        parts[tables] += &format!("{line}\n");
    }
    parts
}

/// Checks that all points of a study of the starter case are valid cases.
fn check_study(study: &str) {
    let folder = scratch("documented-study");
    fs::write(folder.join("tube.toml"), plica::case::STARTER).unwrap();
    fs::write(folder.join("study.toml"), study).unwrap();
    let sweep = plica::sweep::Sweep::read(&folder.join("study.toml")).unwrap();
    for i in 0..sweep.size() {
        sweep.case(&sweep.point(i)).unwrap();
    }
}

/// Pieces of cases in the how-to guides, each with what the comment before it adds.
#[test]
fn the_pieces_of_cases_in_the_guides_are_valid() {
    let mut checked = 0;
    for path in files(&root().join("docs/how-to"), "md") {
        let page = read(&path);
        let mut rest = &page[..];
        while let Some((before, after)) = rest.split_once("```toml\n") {
            let (block, after) = after.split_once("```").unwrap();
            rest = after;
            if block.starts_with("base = ") {
                check_study(block);
                checked += 1;
                continue;
            }
            let comment = before.trim_end().strip_suffix("-->");
            let context = comment.map_or("", |text| text.rsplit_once("<!-- with\n").unwrap().1);
            if context.trim() == "a library" {
                assert!(block.parse::<toml::Table>().is_ok(), "{block}");
                continue;
            }
            let ([keys, tables], [more_keys, more_tables]) = (split(block), split(context));
            let mut case = keys + &more_keys + &more_tables + &tables;
            if !case.contains("[[stages]]") {
                case += "[[stages]]\nsteps = 1\ndrive.inner-wall.pressure = 1e-4\n";
            }
            let read = plica::case::read(&case, "piece");
            assert!(
                read.is_ok(),
                "{}:\n{case}\n{:?}",
                path.display(),
                read.err()
            );
            checked += 1;
        }
    }
    assert!(checked >= 12, "{checked}");
}

#[test]
fn the_cases_of_the_page_on_continuation_have_branches() {
    let page = read("docs/continuation.md");
    for file in files(&root().join("docs/continuation"), "toml") {
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(
            page.contains(&format!("docs/continuation/{name}")),
            "{name}"
        );
        let plan = plica::case::read(&fs::read_to_string(&file).unwrap(), name).unwrap();
        assert!(plan.following.is_some(), "{name}");
    }
}

/// Returns the names of the cases.
fn cases() -> Vec<String> {
    let cases = files(&root().join("cases"), "toml");
    let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    cases.iter().map(name).collect()
}

#[test]
fn every_case_has_a_page_in_the_gallery() {
    let index = read("docs/gallery/index.md");
    for name in cases() {
        assert!(index.contains(&format!(":link: {name}\n")), "{name}");
        let case: toml::Table = read(format!("cases/{name}.toml")).parse().unwrap();
        let page = read(format!("docs/gallery/{name}.md"));
        let title = format!("\n# {}\n", case["title"].as_str().unwrap());
        assert!(
            page.contains(&title),
            "{name}: run scripts/make-gallery {name}"
        );
        let picture = Path::new("docs/gallery").join(format!("{name}.png"));
        assert_eq!(
            page.contains(&format!("]({name}.png)")),
            root().join(picture).exists(),
            "{name}"
        );
    }
}

#[test]
fn the_page_on_laws_shows_code_of_the_library() {
    let page = read("CONTRIBUTING.md");
    let page = page.replace("\n   ", "\n"); // code in lists is indented
    let laws = files(&root().join("crates/plica-mechanics/src/material"), "rs");
    let sources: String = laws.iter().map(read).collect();
    let blocks: Vec<&str> = page.split("```rust\n").skip(1).collect();
    for block in &blocks {
        let code = block.split("```").next().unwrap();
        assert!(sources.contains(code), "not in the library:\n{code}");
    }
    assert!(blocks.len() >= 6);
}

#[test]
fn the_readme_shows_the_case_it_runs() {
    let case = read("cases/invagination.toml");
    assert!(read("README.md").contains(&format!("```toml\n{case}```")));
}

/// The code of README.md.
fn readme(text: &str) -> Result<(), Box<dyn std::error::Error>> {
    for state in plica::Study::new(&plica::case::read(text, "tube")?)? {
        let state = state?; // typed, in D and E
        println!(
            "{} {:.4} {:.4e}",
            state.stage,
            state.length_ratio(),
            state.energy
        );
    }
    Ok(())
}

#[test]
fn the_rust_code_of_the_readme_runs() {
    readme(SHORT).unwrap();
    let lines =
        |text: &str| -> Vec<String> { text.lines().map(|line| line.trim().to_owned()).collect() };
    let tested = lines(include_str!("documents.rs"));
    for name in ["README.md", "docs/index.md", "docs/rust-api.md"] {
        let page = read(name);
        let block = page.split("```rust\n").nth(1).unwrap();
        let shown = lines(block.split("```").next().unwrap());
        assert!(
            tested.windows(shown.len()).any(|lines| lines == shown),
            "the code of {name} differs from `readme` in this file"
        );
    }
}

#[test]
fn the_tests_named_in_verification_exist() {
    let sources = files(&root().join("crates"), "rs");
    let sources: Vec<String> = sources.iter().map(read).collect();
    let page = read("docs/verification.md");
    let (_, table) = page.split_once("## By test").unwrap();
    let rows = table.lines().filter(|line| line.ends_with("` |"));
    let names: Vec<String> = rows
        .flat_map(|row| quoted(row.split('|').nth(3).unwrap()))
        .collect();
    assert!(names.len() > 30);
    for name in names {
        let test = format!("#[test]\nfn {name}(");
        let exists = |source: &String| source.replace("\n    ", "\n").contains(&test);
        assert!(sources.iter().any(exists), "{name}");
    }
}

#[test]
fn the_columns_of_the_history_are_documented() {
    // A muscle that grows, and one with active stress.
    let mut row = Row::zero(&["M", "M"], ["END", "END"]);
    row.muscles[1].stretch = None;
    let mut row = row.with_pressures().with_contact().with_obstacles(&["O"]);
    row = row.with_patches(&["P"]).with_foundations();
    row = row.with_contact_angles();
    row = row.with_sideways_ends().with_lumen_pressure();
    for wall in &mut row.contact.walls {
        (wall.friction_force, wall.friction_work) = (Some(0.0), Some(0.0));
    }
    for obstacle in &mut row.obstacles {
        (obstacle.friction_force, obstacle.friction_work) = (Some(0.0), Some(0.0));
    }
    (row.time, row.muscles[0].shift) = (Some(0.0), Some(0.0));
    let mut columns = row.header();
    columns.dedup();

    let page = read("docs/run-directory.md");
    let (_, section) = page.split_once("## `history.csv`").unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let listed: Vec<String> = rows.map(|row| quoted(row).remove(0)).collect();
    assert_eq!(listed, columns);
}
