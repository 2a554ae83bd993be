//! The same numbers, to the bit, for any number of threads: more than this machine has as well.

mod common;

use common::{plica, root, scratch, text, timeless};
use std::fs;
use std::path::Path;
use std::process::Command;

/// What a run of a case leaves on so many threads: history without wall times, states, profiles.
fn left(directory: &Path, case: &str, threads: usize) -> Vec<(String, Vec<u8>)> {
    let out = directory.join(format!("{threads}"));
    // Not by --threads, which never takes more than there are.
    let said = Command::new(env!("CARGO_BIN_EXE_plica"))
        .args(["run", case, "--out"])
        .arg(&out)
        .env("RAYON_NUM_THREADS", threads.to_string())
        .current_dir(directory)
        .output()
        .unwrap();
    assert!(
        matches!(said.status.code(), Some(0 | 1)),
        "{case}: {}",
        text(&said.stderr)
    );
    let mut files = vec![];
    for folder in ["states", "profiles"] {
        for entry in fs::read_dir(out.join(folder)).unwrap().flatten() {
            let name = entry
                .path()
                .strip_prefix(&out)
                .unwrap()
                .display()
                .to_string();
            files.push((name, fs::read(entry.path()).unwrap()));
        }
    }
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    files.push(("history.csv".into(), timeless(&history).into_bytes()));
    files.sort();
    files
}

fn same_for_any_number(name: &str, case: &str) {
    let directory = scratch(&format!("threads-{name}"));
    fs::write(directory.join("case.toml"), case).unwrap();
    let alone = left(&directory, "case.toml", 1);
    assert!(alone.len() > 3, "{name}");
    for threads in [2, 8] {
        assert!(
            left(&directory, "case.toml", threads) == alone,
            "{name} differs on {threads} threads"
        );
    }
}

/// A case that comes along, with fewer steps if it is to be short.
fn coming(name: &str) -> String {
    fs::read_to_string(root().join("cases").join(name)).unwrap() + "\n"
}

#[test]
fn a_run_is_the_same_on_one_two_and_eight_threads() {
    same_for_any_number(
        "small",
        &coming("small.toml")
            .replace("steps = 15", "steps = 5")
            .replace("steps = 25", "steps = 5"),
    );
    let tilted = "symmetry = \"none\"\n[muscles.circular]\ndirection = \"circular\"\nzone = [0.5, 1.5]\n[mesh]\ncontrol_points = { axial = 20, around = 12, thickness = 4 }\n\
        [[imperfections]]\nof = \"colon-end\"\namplitude = 0.01\nshape = { wave = { mode = 1 } }\n[[stages]]\nsteps = 4\ndrive.circular.diameter_ratio = 0.7\n";
    same_for_any_number("tilted", tilted);
}

/// For the slow suite: `cargo test --release -p plica-cli --test threads -- --ignored`.
#[test]
#[ignore = "takes many minutes"]
fn every_case_that_comes_along_is_the_same_on_one_two_and_eight_threads() {
    for entry in fs::read_dir(root().join("cases")).unwrap().flatten() {
        let name = entry.file_name().into_string().unwrap();
        if name.ends_with(".toml") {
            same_for_any_number(&name, &coming(&name));
        }
    }
}

#[test]
fn more_threads_than_there_are_are_not_used() {
    let directory = scratch("threads-many");
    let run = common::short_run(&directory);
    let case = run.join("case.toml").display().to_string();
    let said = plica(
        &directory,
        &["run", &case, "--out", "many", "--threads", "1024"],
    );
    assert!(said.status.success());
    assert!(
        text(&said.stderr).contains("1024 threads are asked for"),
        "{}",
        text(&said.stderr)
    );
}
