//! The program as a user meets it.

mod common;

use common::{compare, plica, root, scratch, text};
use std::path::Path;

/// A case of a second: few states on a coarse mesh.
const QUICK: &str = "\
[mesh]
control_points = { axial = 24, around = 24, thickness = 4 }

[muscles.ring]
direction = \"circular\"
zone = [0.5, 1.5]

[[stages]]
steps = 2
drive.ring.diameter_ratio = 0.9

[output]
pictures = false
";

fn quick(directory: &Path) {
    std::fs::write(directory.join("quick.toml"), QUICK).unwrap();
}

#[test]
fn help_is_worth_reading() {
    let mut page = String::new();
    for arguments in [
        &["--help"][..],
        &["run", "--help"],
        &["stability", "--help"],
        &["check", "--help"],
        &["new", "--help"],
    ] {
        let said = plica(&root(), arguments);
        assert!(said.status.success());
        page += &format!(
            "==== plica {}\n{}\n",
            arguments.join(" "),
            text(&said.stdout)
        );
    }
    compare("help.txt", &page);
}

#[test]
fn a_sound_case_is_described() {
    let said = plica(&root(), &["check", "cases/small.toml"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    // Time and memory are of the machine and of the day.
    let mut page = String::new();
    for line in text(&said.stdout).lines() {
        page += match line.split_whitespace().next() {
            Some("memory") => "  memory     about ...",
            Some("time") => "  time       about ...",
            _ => line,
        };
        page += "\n";
    }
    compare("check.txt", &page);
}

#[test]
fn wrong_arguments_and_missing_files_have_their_codes() {
    let directory = scratch("codes");
    let code = |arguments: &[&str]| plica(&directory, arguments).status.code();
    assert_eq!(code(&["march"]), Some(2));
    assert_eq!(code(&["run"]), Some(2));
    assert_eq!(code(&["run", "a.toml", "--threads", "0"]), Some(2));
    assert_eq!(code(&["check", "nowhere.toml"]), Some(3));
    std::fs::write(directory.join("latin.toml"), b"title = \"\xe9\"").unwrap();
    assert_eq!(code(&["check", "latin.toml"]), Some(2));
    assert_eq!(code(&["--version"]), Some(0));
    assert_eq!(code(&["completions", "bash"]), Some(0));
}

#[test]
fn titles_and_names_that_pictures_cannot_write_are_told() {
    let directory = scratch("letters");
    let case = std::fs::read_to_string(root().join("cases/small.toml")).unwrap();
    let (_, rest) = case.split_once('\n').unwrap();
    let told = |title: &str, stage: &str| {
        std::fs::write(
            directory.join("a.toml"),
            format!(
                "title = \"{title}\"\n{}",
                rest.replace("\"contract\"", &format!("\"{stage}\""))
            ),
        )
        .unwrap();
        let output = plica(&directory, &["check", "a.toml"]);
        assert!(output.status.success());
        String::from_utf8(output.stdout)
            .unwrap()
            .contains("PNGs show boxes")
    };
    assert!(told("腸重積", "contract"));
    assert!(told("gut", "収縮"));
    assert!(!told("Ελιά, è", "contract"));
}

#[test]
fn a_new_case_is_sound_and_never_overwrites() {
    let directory = scratch("new");
    assert!(plica(&directory, &["new"]).status.success());
    assert!(plica(&directory, &["check", "case.toml"]).status.success());
    std::fs::write(directory.join("case.toml"), "mine").unwrap();
    assert_eq!(plica(&directory, &["new"]).status.code(), Some(3));
    let kept = std::fs::read_to_string(directory.join("case.toml")).unwrap();
    assert_eq!(kept, "mine");
    let printed = plica(&directory, &["new", "-"]);
    assert_eq!(text(&printed.stdout), plica::case::STARTER);
}

#[test]
fn a_run_leaves_its_directory_and_replaces_only_runs() {
    let directory = scratch("run");
    quick(&directory);
    let run = |arguments: &[&str]| {
        let said = plica(&directory, &[&["run", "quick.toml"], arguments].concat());
        (said.status.code(), text(&said.stderr))
    };
    let (code, told) = run(&["--threads", "1"]);
    assert_eq!(code, Some(0), "{told}");
    // One line a state, under a heading.
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
    let numbers = told
        .lines()
        .filter_map(first)
        .filter_map(|word| word.parse().ok());
    assert_eq!(numbers.collect::<Vec<usize>>(), [0, 1, 2], "{told}");
    for file in ["case.toml", "manifest.json"] {
        assert!(directory.join("runs/quick").join(file).exists(), "{file}");
    }
    let (code, told) = run(&[]);
    assert_eq!(code, Some(3), "{told}");
    assert!(told.contains("--overwrite"), "{told}");
    assert_eq!(run(&["--overwrite"]).0, Some(0));

    let precious = directory.join("precious");
    std::fs::create_dir(&precious).unwrap();
    std::fs::write(precious.join("thesis.tex"), "years").unwrap();
    assert_eq!(run(&["--out", "precious", "--overwrite"]).0, Some(3));
    assert!(precious.join("thesis.tex").exists());
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    #[test]
    fn an_interrupted_run_writes_what_it_has() {
        let directory = scratch("interrupt");
        let many = QUICK.replace("steps = 2", "steps = 20000");
        std::fs::write(directory.join("long.toml"), many).unwrap();
        let mut run = Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["run", "long.toml"])
            .current_dir(&directory)
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let mut told = BufReader::new(run.stderr.take().unwrap()).lines();
        // The heading comes with the first state.
        assert!(told.any(|line| line.unwrap().contains("Lmax/L")));
        let pid = run.id().to_string();
        Command::new("kill").args(["-INT", &pid]).status().unwrap();
        let rest: Vec<String> = told.map(Result::unwrap).collect();
        assert_eq!(run.wait().unwrap().code(), Some(130), "{rest:?}");
        assert!(rest.last().unwrap().starts_with("interrupted"), "{rest:?}");
        assert!(directory.join("runs/long/manifest.json").exists());
    }

    #[test]
    fn a_closed_pipe_is_no_error() {
        let mut new = Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["completions", "zsh"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(new.stdout.take());
        let ended = new.wait_with_output().unwrap();
        assert!(ended.status.success());
        assert!(ended.stderr.is_empty(), "{}", text(&ended.stderr));
    }
}
