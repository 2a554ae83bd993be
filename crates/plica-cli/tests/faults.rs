//! A run that is killed before each of its operations on files in turn, or in the middle of writing, or finds a full disk from
//! there on; taken up again, it leaves what a run leaves that was let alone.
//!
//! Kills at random (`resume.rs`) hardly ever fall between two operations that follow each other; these always do. The system's
//! functions are replaced from outside (`faults/faults.c`), so that it is the program itself that is tried.

#![cfg(target_os = "linux")]

mod common;

use common::{assert_same_after, left, plica, scratch, text};
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
const PLAIN: &str = "[output]\nstates_every = 2\npictures = false\n";

/// What can become of an operation, and whether the process is gone then.
const FAULTS: [(&str, bool); 3] = [("kill", true), ("torn", true), ("full", false)];

/// The replaced functions of the system, as a library.
fn library(directory: &Path) -> PathBuf {
    let library = directory.join("faults.so");
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", "-o"])
        .arg(&library)
        .arg(common::tests().join("faults/faults.c"))
        .arg("-ldl")
        .output()
        .expect("cc, by which Rust links");
    assert!(built.status.success(), "{}", text(&built.stderr));
    library
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().flatten() {
        let (path, name) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &name);
        } else {
            fs::copy(path, name).unwrap();
        }
    }
}

/// What is done to a directory `cut` in the midst of which something happens.
struct Act<'a> {
    /// Of the scratch directory.
    name: &'a str,
    /// A run that is there before, if there is one: how its case ends.
    before: Option<&'a str>,
    /// How the case ends that is run.
    case: &'a str,
    /// What is done.
    act: &'a [&'a str],
    /// What mends it: the first of these that does.
    mend: &'a [&'a [&'a str]],
}

impl Act<'_> {
    /// Every so-manieth operation, from the first.
    fn survives(&self, every: usize) {
        let directory = scratch(self.name);
        let library = library(&directory);
        let does = |arguments: &[&str]| {
            let said = plica(&directory, arguments);
            assert!(said.status.success(), "{}", text(&said.stderr));
        };
        if let Some(before) = self.before {
            fs::write(directory.join("tube.toml"), HEAD.to_owned() + before).unwrap();
            does(&["run", "tube.toml", "--out", "before"]);
        }
        let cut = directory.join("cut");
        let again = || {
            let _ = fs::remove_dir_all(&cut);
            if self.before.is_some() {
                copy(&directory.join("before"), &cut);
            }
        };
        fs::write(directory.join("tube.toml"), HEAD.to_owned() + self.case).unwrap();
        again();
        does(self.act);
        let whole = left(&cut);
        for (how, gone) in FAULTS {
            let mut at = 1;
            loop {
                again();
                let said = Command::new(env!("CARGO_BIN_EXE_plica"))
                    .args(self.act)
                    .current_dir(&directory)
                    .env("LD_PRELOAD", &library)
                    .env("FAULT_AT", at.to_string())
                    .env("FAULT_HOW", how)
                    .output()
                    .unwrap();
                let told = text(&said.stderr);
                if said.status.success() {
                    break;
                }
                if gone {
                    assert_eq!(said.status.signal(), Some(9), "{how} at {at}: {told}");
                } else {
                    // Told as it should be.
                    assert_eq!(said.status.code(), Some(3), "{how} at {at}: {told}");
                    assert!(told.contains("No space left"), "{how} at {at}: {told}");
                }
                let what = format!("{}: {how} at {at}", self.name);
                self.mended(&directory, &what);
                assert_same_after(&what, &whole, &cut);
                at += every;
            }
            assert!(at > 20.max(every), "{how}: {at}");
            println!("{}: {how}: {at} operations", self.name);
        }
    }

    /// Does what mends it.
    fn mended(&self, directory: &Path, what: &str) {
        let mut told = vec![];
        for arguments in self.mend {
            let before = directory
                .join("cut")
                .exists()
                .then(|| left(&directory.join("cut")));
            let Output { status, stderr, .. } = plica(directory, arguments);
            if status.success() {
                return;
            }
            // What does not mend it leaves it as it is, and says why.
            assert!(
                matches!(status.code(), Some(2 | 3)),
                "{what}: {}",
                text(&stderr)
            );
            if let Some(before) = before {
                assert_same_after(what, &before, &directory.join("cut"));
            }
            told.push(text(&stderr));
        }
        panic!("{what}: {}", told.join("\n"));
    }
}

/// By another command, in a run whose case has a title of its file only.
const RESUME: &[&str] = &["resume", "cut"];
const RUN: &[&str] = &["run", "tube.toml", "--out", "cut"];
const GO_ON: &[&str] = &["run", "tube.toml", "--out", "cut", "--resume"];
const OVERWRITE: &[&str] = &["run", "tube.toml", "--out", "cut", "--overwrite"];

fn all(every: usize) {
    let plain = MORE.to_owned() + PLAIN;
    let fresh = Act {
        name: "faults-fresh",
        before: None,
        case: &plain,
        act: RUN,
        mend: &[GO_ON],
    };
    fresh.survives(every);
    Act {
        name: "faults-resume",
        case: &(MORE.to_owned() + "[output]\nstates_every = 2\n"),
        mend: &[RESUME, GO_ON],
        ..fresh
    }
    .survives(2 * every);
    // A former run of something else, which is to be replaced. As long as it is whole it is not taken for one of the new case.
    let other = plain.replace("1e-4", "2e-4");
    Act {
        name: "faults-overwrite",
        before: Some(&other),
        act: OVERWRITE,
        mend: &[GO_ON, OVERWRITE],
        ..fresh
    }
    .survives(every);
    // A complete run whose case has got another stage.
    Act {
        name: "faults-changed",
        before: Some(PLAIN),
        act: GO_ON,
        ..fresh
    }
    .survives(every);
    // To the end of pictures, and what is tidied up after them.
    Act {
        name: "faults-pictures",
        before: Some("[output]\nstates_every = 2\n"),
        case: &(MORE.to_owned() + "[output]\nstates_every = 2\n"),
        act: GO_ON,
        mend: &[GO_ON],
    }
    .survives(2 * every);
    // Pictures alone, of a run that was complete without.
    Act {
        name: "faults-drawn",
        before: Some("[output]\npictures = false\n"),
        case: "",
        act: GO_ON,
        mend: &[GO_ON],
    }
    .survives(2 * every);
    Act {
        name: "faults-stability",
        before: Some(&plain),
        act: &["stability", "cut"],
        mend: &[&["stability", "cut"]],
        ..fresh
    }
    .survives(every);
}

#[test]
fn a_run_survives_faults_here_and_there() {
    all(19);
}

/// For the slow suite: `cargo test --release -p plica-cli --test faults -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn a_run_survives_a_fault_at_every_operation_on_files() {
    all(1);
}
