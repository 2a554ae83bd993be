//! `plica run --set` and `--until`, and names of ends.

use crate::common::{SHORT, fail, scratch, succeed, text};
use std::fs;
use std::path::{Path, PathBuf};

fn case(name: &str) -> PathBuf {
    let directory = scratch(name);
    fs::write(directory.join("case.toml"), SHORT).unwrap();
    directory
}

/// Returns the lines of the history without the header.
fn rows(run: &Path) -> usize {
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    history.lines().count() - 1
}

/// Returns the history without the columns of times.
fn without_times(run: &Path) -> Vec<Vec<String>> {
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let lines: Vec<Vec<String>> = history
        .lines()
        .map(|line| line.split(',').map(String::from).collect())
        .collect();
    let seconds = lines[0].iter().position(|name| name == "seconds").unwrap();
    let without = |mut line: Vec<String>| {
        line.remove(seconds);
        line
    };
    lines.into_iter().map(without).collect()
}

#[test]
fn keys_are_set_in_the_case_of_the_run() {
    let directory = case("set");
    let set = ["--set", "stages[1].steps=2", "--set", "title=other words"];
    let stderr = fail(&directory, &[&["run", "case.toml"], &set[..]].concat(), 2);
    assert!(
        stderr.contains("--set title=other words: not a key and a value"),
        "{stderr}"
    );
    let set = [
        "--set",
        "stages[1].steps=2",
        "--set",
        "title = changed",
        "--set",
        "output.pictures=false",
    ];
    succeed(
        &directory,
        &[&["run", "case.toml", "--out", "run"], &set[..]].concat(),
    );
    let run = directory.join("run");
    assert_eq!(rows(&run), 3);
    let written = fs::read_to_string(run.join("case.toml")).unwrap();
    assert!(written.contains("steps = 2\n") && written.contains("title = \"changed\""));
    assert!(!run.join("tube.png").exists());
    assert_eq!(
        fs::read_to_string(directory.join("case.toml")).unwrap(),
        SHORT
    );
    for (setting, what) in [
        ("mesh.degre=2", "did you mean degree?"),
        ("mesh.degree=9", "mesh.degree: must be at most 5"),
        ("title.more=1", "--set title.more: title is not a table"),
        ("mesh.degree", "must be KEY=VALUE"),
    ] {
        let stderr = fail(&directory, &["run", "case.toml", "--set", setting], 2);
        assert!(stderr.contains(what), "{setting}: {stderr}");
    }
}

#[test]
fn a_run_stops_at_the_first_state_that_fulfils_a_condition_and_resume_goes_on() {
    let directory = case("until");
    let run = directory.join("run");
    let until = ["--until", "outer_radius_min < 0.48"];
    let arguments = [&["run", "case.toml", "--out", "run"], &until[..]].concat();
    let output = crate::common::plica(&directory, &arguments);
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    let said = "stopped at the first state with outer_radius_min < 0.48, as asked; `plica resume run` goes on";
    assert!(stderr.contains(said), "{stderr}");
    assert_eq!(rows(&run), 3);
    let manifest = || fs::read_to_string(run.join("manifest.json")).unwrap();
    assert!(manifest().contains("\"verdict\": \"complete\""));
    assert!(manifest().contains("\"until\": \"outer_radius_min < 0.48\""));
    assert!(run.join("tube.png").exists());
    succeed(&directory, &["resume", "run"]);
    assert_eq!(rows(&run), 4);
    assert!(!manifest().contains("until") && manifest().contains("\"verdict\": \"complete\""));
    succeed(&directory, &["run", "case.toml", "--out", "whole"]);
    assert_eq!(without_times(&run), without_times(&directory.join("whole")));
    for (condition, what) in [
        ("shape = W", "--until: shape is never `W`"),
        ("beauty > 1", "--until: `beauty` is not a column"),
    ] {
        let stderr = fail(&directory, &["run", "case.toml", "--until", condition], 2);
        assert!(stderr.contains(what), "{condition}: {stderr}");
    }
}

#[test]
fn ends_have_the_names_of_the_case() {
    let directory = case("end-names");
    let names = [
        "--set",
        "ends.colon_name=proximal",
        "--set",
        "ends.ileum_name=distal",
    ];
    succeed(
        &directory,
        &[&["run", "case.toml", "--out", "run"], &names[..]].concat(),
    );
    let run = directory.join("run");
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let header = history.lines().next().unwrap();
    assert!(
        header.contains("axial_force_proximal,axial_force_distal"),
        "{header}"
    );
    assert!(
        !header.contains("colon") && !header.contains("ileum"),
        "{header}"
    );
    succeed(&directory, &["report", "run"]);
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    assert!(page.contains("\"ends\":[\"proximal\",\"distal\"]"));
    for (names, what) in [
        (["ends.colon_name=ileum", "title=x"], "the other end"),
        (["ends.colon_name=a", "ends.ileum_name=a"], "the other end"),
        (["ends.colon_name=circular", "title=x"], "a muscle"),
    ] {
        let [a, b] = names;
        let stderr = fail(&directory, &["run", "case.toml", "--set", a, "--set", b], 2);
        assert!(stderr.contains(what), "{names:?}: {stderr}");
    }
}
