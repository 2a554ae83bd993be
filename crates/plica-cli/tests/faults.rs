//! Faults injected at each operation on files: the process is killed before it or in the middle of a write, or the disk is full
//! from there on. The resumed run must have the same files as an uninterrupted run.
//!
//! Random kills (`resume.rs`) rarely hit the short time between two successive operations. A preloaded library
//! (`faults/faults.c`) replaces the functions of the system, so that the unmodified program is tested.

use crate::common::{PLICA, assert_contents, contents, copy, plica, scratch, succeed, text};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const HEAD: &str = r#"
[tube]
length = 2.0
thickness = 0.1
[muscles.circular]
direction = "circular"
zone = [0.5, 1.5]
[mesh]
control_points = { axial = 8, around = 8, thickness = 4 }
[[stages]]
name = "contract"
steps = 2
drive.circular.diameter_ratio = 0.9
"#;
const MORE: &str = "[[stages]]\nname = \"press\"\nsteps = 2\ndrive.outer-wall.pressure = 1e-4\n";
const WITHOUT_PICTURES: &str = "[output]\nstates_every = 2\npictures = false\n";

/// Kinds of faults, and whether the process dies of them.
const FAULTS: [(&str, bool); 3] = [("kill", true), ("torn", true), ("full", false)];

/// Compiles the library with the replaced functions.
fn library(directory: &Path) -> PathBuf {
    let library = directory.join("faults.so");
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", "-o"])
        .arg(&library)
        .arg(crate::common::tests().join("faults/faults.c"))
        .arg("-ldl")
        .output()
        .expect("the C compiler that Rust links with");
    assert!(built.status.success(), "{}", text(&built.stderr));
    library
}

/// A command on the directory `cut` that a fault interrupts.
struct Scenario<'a> {
    /// Name of the scratch directory.
    name: &'a str,
    /// End of the case of an earlier run in the directory, if there is one.
    before: Option<&'a str>,
    /// End of the case.
    case: &'a str,
    /// Arguments of the command.
    command: &'a [&'a str],
    /// Commands to repair the directory; the first that succeeds must complete the run.
    repair: &'a [&'a [&'a str]],
}

impl Scenario<'_> {
    /// Injects a fault at every `every`-th operation, from the first.
    fn survives(&self, every: usize) {
        let directory = scratch(self.name);
        let library = library(&directory);
        if let Some(before) = self.before {
            fs::write(directory.join("tube.toml"), HEAD.to_owned() + before).unwrap();
            succeed(&directory, &["run", "tube.toml", "--out", "before"]);
        }
        let cut = directory.join("cut");
        let reset = || {
            let _ = fs::remove_dir_all(&cut);
            if self.before.is_some() {
                copy(&directory.join("before"), &cut);
            }
        };
        fs::write(directory.join("tube.toml"), HEAD.to_owned() + self.case).unwrap();
        reset();
        succeed(&directory, self.command);
        let expected = contents(&cut);
        for (how, kills) in FAULTS {
            let mut at = 1;
            loop {
                reset();
                let output = Command::new(PLICA)
                    .args(self.command)
                    .current_dir(&directory)
                    .env("LD_PRELOAD", &library)
                    .env("FAULT_AT", at.to_string())
                    .env("FAULT_HOW", how)
                    .output()
                    .unwrap();
                let stderr = text(&output.stderr);
                if output.status.success() {
                    break;
                }
                if kills {
                    assert_eq!(output.status.signal(), Some(9), "{how} at {at}: {stderr}");
                } else {
                    assert_eq!(output.status.code(), Some(3), "{how} at {at}: {stderr}");
                    assert!(
                        stderr.contains("No space left") && stderr.contains("; make room, then "),
                        "{how} at {at}: {stderr}"
                    );
                }
                let what = format!("{}: {how} at {at}", self.name);
                self.repair(&directory, &what);
                assert_contents(&what, &expected, &cut);
                at += every;
            }
            assert!(at > 20.max(every), "{how}: {at}");
            println!("{}: {how}: {at} operations", self.name);
        }
    }

    /// Runs the repair commands until one succeeds.
    fn repair(&self, directory: &Path, what: &str) {
        let mut errors = vec![];
        for arguments in self.repair {
            let before = directory
                .join("cut")
                .exists()
                .then(|| contents(&directory.join("cut")));
            let Output { status, stderr, .. } = plica(directory, arguments);
            if status.success() {
                return;
            }
            // A refused repair leaves the directory unchanged.
            assert!(
                matches!(status.code(), Some(2 | 3)),
                "{what}: {}",
                text(&stderr)
            );
            if let Some(before) = before {
                assert_contents(what, &before, &directory.join("cut"));
            }
            errors.push(text(&stderr));
        }
        panic!("{what}: {}", errors.join("\n"));
    }
}

const RESUME: &[&str] = &["resume", "cut"];
const RUN: &[&str] = &["run", "tube.toml", "--out", "cut"];
const RUN_RESUME: &[&str] = &["run", "tube.toml", "--out", "cut", "--resume"];
const OVERWRITE: &[&str] = &["run", "tube.toml", "--out", "cut", "--overwrite"];

/// Injects faults at every `every`-th operation of all scenarios.
fn test_all(every: usize) {
    let case = MORE.to_owned() + WITHOUT_PICTURES;
    let fresh = Scenario {
        name: "faults-fresh",
        before: None,
        case: &case,
        command: RUN,
        repair: &[RUN_RESUME],
    };
    fresh.survives(every);
    Scenario {
        name: "faults-resume",
        case: &(MORE.to_owned() + "[output]\nstates_every = 2\n"),
        repair: &[RESUME, RUN_RESUME],
        ..fresh
    }
    .survives(2 * every);
    // Overwrite the run of another case. Until it is removed it must not be mistaken for a run of the new case.
    let other = case.replace("1e-4", "2e-4");
    Scenario {
        name: "faults-overwrite",
        before: Some(&other),
        command: OVERWRITE,
        repair: &[RUN_RESUME, OVERWRITE],
        ..fresh
    }
    .survives(every);
    // Resume a complete run whose case has a new stage.
    Scenario {
        name: "faults-changed",
        before: Some(WITHOUT_PICTURES),
        command: RUN_RESUME,
        ..fresh
    }
    .survives(every);
    // Include pictures and the removal of temporary files after them.
    Scenario {
        name: "faults-pictures",
        before: Some("[output]\nstates_every = 2\n"),
        case: &(MORE.to_owned() + "[output]\nstates_every = 2\n"),
        command: RUN_RESUME,
        repair: &[RUN_RESUME],
    }
    .survives(2 * every);
    // Draw the pictures of a run that was completed without them.
    Scenario {
        name: "faults-drawn",
        before: Some("[output]\npictures = false\n"),
        case: "",
        command: RUN_RESUME,
        repair: &[RUN_RESUME],
    }
    .survives(2 * every);
    Scenario {
        name: "faults-stability",
        before: Some(&case),
        command: &["stability", "cut"],
        repair: &[&["stability", "cut"]],
        ..fresh
    }
    .survives(every);
}

#[test]
fn runs_survive_faults_at_some_file_operations() {
    test_all(19);
}

#[test]
#[ignore = "takes minutes"]
fn runs_survive_faults_at_every_file_operation() {
    test_all(1);
}
