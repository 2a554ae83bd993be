//! Studies of many tubes.

use crate::common::{fail, plica, read, scratch, succeed, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// A ring of muscle that contracts, in a second or less.
const BASE: &str = r#"
[tube]
length = 1.0
thickness = 0.1
[muscles.ring]
direction = "circular"
zone = [0.2, 0.8]
[mesh]
control_points = { axial = 14, around = 8, thickness = 4 }
[[stages]]
name = "contract"
steps = 6
drive.ring.diameter_ratio = 0.7
"#;

const STUDY: &str = r#"
base = "ring.toml"
[axes]
"tube.thickness" = [0.08, 0.1]
"stages.contract.drive.ring.diameter_ratio" = { from = 0.5, to = 0.9, points = 3 }
"#;

/// Bisects the depth at which a contraction becomes a V.
const REFINED: &str = r#"
base = "ring.toml"
[axes]
"stages.contract.drive.ring.diameter_ratio" = [0.9, 0.99]
"tube.thickness" = [0.08, 0.1]
[refine]
of = "shape"
until = { "stages.contract.drive.ring.diameter_ratio" = 0.01 }
"#;

fn folder(name: &str, study: &str) -> PathBuf {
    let folder = scratch(name);
    fs::write(folder.join("ring.toml"), BASE).unwrap();
    fs::write(folder.join("study.toml"), study).unwrap();
    folder
}

/// Returns the cells of a column of the table.
fn column(folder: &Path, name: &str) -> Vec<String> {
    let mut table = csv::Reader::from_path(folder.join("studies/study/table.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let place = header.iter().position(|column| column == name).unwrap();
    let cell = |record: csv::StringRecord| record[place].to_owned();
    table
        .records()
        .map(|record| cell(record.unwrap()))
        .collect()
}

#[test]
fn a_study_computes_every_point_once_and_its_table_has_their_findings() {
    let folder = folder("sweep", STUDY);
    let told = succeed(&folder, &["sweep", "check", "study.toml"]);
    assert!(told.contains("6 points of ring.toml"), "{told}");
    succeed(&folder, &["sweep", "run", "study.toml", "--jobs", "2"]);
    assert_eq!(column(&folder, "status"), ["complete"; 6]);
    assert_eq!(column(&folder, "states"), ["7"; 6]);
    let ratios = column(&folder, "stages.contract.drive.ring.diameter_ratio");
    assert_eq!(ratios, ["0.5", "0.7", "0.9", "0.5", "0.7", "0.9"]);
    // The same as a run of the case with the same keys.
    let set = "stages[1].drive.ring.diameter_ratio=0.5";
    let alone = [
        "run",
        "ring.toml",
        "--set",
        set,
        "--set",
        "tube.thickness=0.08",
        "--out",
        "alone",
    ];
    succeed(&folder, &alone);
    let history = crate::common::Table::history(&folder.join("alone"));
    let energy: Vec<f64> = column(&folder, "energy")
        .iter()
        .map(|cell| cell.parse().unwrap())
        .collect();
    assert_eq!(Some(&energy[0]), history.numbers("energy").last());
    assert!(energy[0] > energy[1] && energy[3] > energy[0], "{energy:?}");
    // A second run computes nothing, and a study that overlaps shares runs.
    let table = read(folder.join("studies/study/table.csv"));
    let again = plica(&folder, &["sweep", "run", "study.toml"]);
    assert!(
        !text(&again.stderr).contains("/6"),
        "{}",
        text(&again.stderr)
    );
    assert_eq!(read(folder.join("studies/study/table.csv")), table);
    let picture = ["sweep", "picture", "study.toml"];
    succeed(&folder, &picture);
    assert!(
        fs::read(folder.join("studies/study/picture.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
}

#[test]
fn killed_at_any_time_a_study_ends_in_the_same_table() {
    let whole = folder("sweep-whole", REFINED);
    succeed(&whole, &["sweep", "run", "study.toml"]);
    let table = read(whole.join("studies/study/table.csv"));
    // Bisected from 0.1 to less than 0.01 for both thicknesses.
    let ratios = column(&whole, "stages.contract.drive.ring.diameter_ratio");
    assert_eq!(ratios.len(), 4 + 2 * 4, "{ratios:?}");
    let killed = folder("sweep-killed", REFINED);
    for millis in [5, 40, 80, 160, 320] {
        let mut process = Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["sweep", "run", "study.toml", "--jobs", "2"])
            .current_dir(&killed)
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(millis));
        let _ = process.kill();
        process.wait().unwrap();
    }
    let begun = fs::read_dir(killed.join("studies/study/points")).unwrap();
    assert!(begun.count() > 0, "killed before anything had begun");
    succeed(&killed, &["sweep", "run", "study.toml", "--jobs", "1"]);
    assert_eq!(read(killed.join("studies/study/table.csv")), table);
}

#[test]
fn two_processes_share_the_points_of_a_study() {
    let folder = folder("sweep-shared", STUDY);
    let start = || {
        Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["sweep", "run", "study.toml", "--jobs", "1"])
            .current_dir(&folder)
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let both = [start(), start()];
    let mut computed = 0;
    for process in both {
        let output = process.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        computed += text(&output.stderr).matches("/6  ").count();
    }
    assert_eq!(column(&folder, "status"), ["complete"; 6]);
    assert_eq!(computed, 6, "each point once");
    // A task of a job array computes one point, which is there already.
    let told = succeed(&folder, &["sweep", "point", "study.toml", "4"]);
    assert!(told.starts_with("point 4, tube.thickness = 0.1"), "{told}");
    let wrong = fail(&folder, &["sweep", "point", "study.toml", "6"], 2);
    assert!(wrong.contains("6 points, 0 to 5"), "{wrong}");
}

#[test]
fn points_that_cannot_be_computed_have_a_row_with_the_reason() {
    let study = STUDY.replace("[0.08, 0.1]", "[0.08, 0.7]");
    let folder = folder("sweep-invalid", &study);
    let told = plica(&folder, &["sweep", "check", "study.toml"]);
    let told = text(&told.stderr).to_owned();
    assert!(
        told.contains("3 points are not valid cases") && told.contains("tube.thickness = 0.7"),
        "{told}"
    );
    succeed(&folder, &["sweep", "run", "study.toml"]);
    assert_eq!(column(&folder, "status")[2..4], ["complete", "invalid"]);
    assert!(column(&folder, "reason")[3].contains("tube.thickness = 0.7: must be"));
}

#[test]
fn mistakes_of_a_study_are_shown_with_place_and_help() {
    for (from, to, expected) in [
        (
            "base = \"ring.toml\"",
            "base = \"rings.toml\"",
            "give the path of a case file",
        ),
        (
            "stages.contract",
            "stages.relax",
            "no stage relax; it has contract",
        ),
        (
            "points = 3",
            "points = 2000000",
            "whole number from 1 to 1000000",
        ),
        (
            "points = 3",
            "points = 900000",
            "the axes have 1800000 points",
        ),
        ("points = 3", "steps = 3", "unknown key steps"),
        ("[0.08, 0.1]", "[]", "must be a list of values or a range"),
        ("[axes]", "[axis]", "unknown key"),
        ("[axes]", "design = \"none.csv\"\n[axes]", "none.csv"),
        (
            "from = 0.5",
            "scale = \"log\", from = 0.0",
            "must be positive",
        ),
    ] {
        let folder = folder("sweep-wrong", &STUDY.replace(from, to));
        let told = fail(&folder, &["sweep", "run", "study.toml"], 2);
        assert!(
            told.contains(expected) && told.contains("study.toml"),
            "{from} -> {to}: {told}"
        );
        assert!(!folder.join("studies").exists());
    }
    let told = fail(
        &folder("sweep-refine", &REFINED.replace("shape", "colour")),
        &["sweep", "run", "study.toml"],
        2,
    );
    assert!(told.contains("of must be one of shape, side"), "{told}");
}

#[test]
fn a_design_gives_the_points_one_by_one() {
    let folder = folder(
        "sweep-design",
        "base = \"ring.toml\"\ndesign = \"points.csv\"\n",
    );
    let points = "tube.thickness,mesh.degree\n0.08,2\n0.1,3\n";
    fs::write(folder.join("points.csv"), points).unwrap();
    succeed(&folder, &["sweep", "run", "study.toml"]);
    assert_eq!(column(&folder, "mesh.degree"), ["2", "3"]);
    assert_eq!(column(&folder, "status"), ["complete"; 2]);
}
