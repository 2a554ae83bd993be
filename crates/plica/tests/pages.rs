//! Holds the pages against the files, the tests and the tables that they speak of.

mod common;

use common::{files, quoted, root, text};
use plica::study::Row;
use std::fs;

#[test]
fn links_lead_somewhere() {
    let mut pages = files(&root().join("docs"), "md");
    let top = fs::read_dir(root()).unwrap();
    pages.extend(top.map(|entry| entry.unwrap().path()));
    pages.retain(|page| page.extension().is_some_and(|e| e == "md"));
    assert!(pages.len() >= 9);
    for page in pages {
        for link in text(&page).split("](").skip(1) {
            let target = link.split([')', '#']).next().unwrap();
            if !target.contains("://") {
                let file = page.parent().unwrap().join(target);
                assert!(file.exists(), "{}: {target}", page.display());
            }
        }
    }
}

#[test]
fn the_readme_shows_the_case_it_runs() {
    let case = text("cases/invagination.toml");
    assert!(text("README.md").contains(&format!("```toml\n{case}```")));
}

#[test]
fn verification_names_tests_that_exist() {
    let sources = files(&root().join("crates"), "rs");
    let sources: Vec<String> = sources.iter().map(text).collect();
    let page = text("docs/verification.md");
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
fn the_columns_of_the_history_are_listed() {
    let row = Row {
        step: 0,
        stage: String::new(),
        length_ratio: 0.0,
        diameter_ratio: 0.0,
        colon_displacement: 0.0,
        ileum_displacement: 0.0,
        colon_twist_deg: 0.0,
        ileum_twist_deg: 0.0,
        inner_pressure: Some(0.0),
        outer_pressure: Some(0.0),
        inner_dead_load: Some(0.0),
        outer_dead_load: Some(0.0),
        potential: Some(0.0),
        energy: 0.0,
        energy_ungrown_volume: 0.0,
        residual: 0.0,
        damping_work: 0.0,
        method: String::new(),
        equilibrium: String::new(),
        iterations: 0,
        cg_iterations: 0,
        seconds: 0.0,
        outer_radius_min: 0.0,
        z_at_min: 0.0,
        max_wall_angle_deg: 0.0,
        overhang: 0.0,
        flatness: 0.0,
        gap: 0.0,
        lumen: 0.88,
        side: String::new(),
        shape: String::new(),
        asymmetry: 0.0,
        asymmetry_mode: 0,
        asymmetry_angle_deg: 0.0,
        min_det_fe: 0.0,
        unstable_modes: String::new(),
    };
    let mut writer = csv::Writer::from_writer(vec![]);
    writer.serialize(&row).unwrap();
    let written = String::from_utf8(writer.into_inner().unwrap()).unwrap();
    let columns: Vec<&str> = written.lines().next().unwrap().split(',').collect();

    let page = text("docs/run-directory.md");
    let (_, section) = page.split_once("## `history.csv`").unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let listed: Vec<String> = rows.map(|row| quoted(row).remove(0)).collect();
    assert_eq!(listed, columns);
}
