//! The documents agree with the files, commands, tests and columns they name.

use crate::common::{SHORT, files, quoted, read, root, succeed};
use plica::study::Row;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

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
    let page = read("README.md");
    let block = page.split("```rust\n").nth(1).unwrap();
    let shown = lines(block.split("```").next().unwrap());
    let tested = lines(include_str!("documents.rs"));
    assert!(
        tested.windows(shown.len()).any(|lines| lines == shown),
        "the code of README.md differs from `readme` in this file"
    );
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
    let row = Row::zero(&["M"], ["END", "END"]);
    let mut row = row.with_pressures().with_contact().with_obstacles(&["O"]);
    row = row.with_patches(&["P"]).with_foundations();
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
