//! General behaviour of the command line.

use crate::common::{PLICA, compare, fail, plica, read, root, scratch, succeed, text};
use std::fs;

/// A case of three states on a coarse mesh.
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

#[test]
fn help_texts_match_the_snapshot() {
    let mut page = String::new();
    for arguments in [
        &["--help"][..],
        &["run", "--help"],
        &["resume", "--help"],
        &["stability", "--help"],
        &["follow", "--help"],
        &["verify", "--help"],
        &["reproduce", "--help"],
        &["export", "--help"],
        &["render", "--help"],
        &["plot", "--help"],
        &["animate", "--help"],
        &["report", "--help"],
        &["sweep", "--help"],
        &["check", "--help"],
        &["new", "--help"],
    ] {
        let help = succeed(&root(), arguments);
        page += &format!("==== plica {}\n{help}\n", arguments.join(" "));
    }
    compare("help.txt", &page);
}

#[test]
fn check_describes_a_valid_case() {
    let stdout = succeed(&root(), &["check", "cases/small.toml"]);
    // The estimates of memory and time depend on the machine.
    let mut page = String::new();
    for line in stdout.lines() {
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
fn wrong_arguments_and_missing_files_have_different_exit_codes() {
    let directory = scratch("codes");
    let code = |arguments: &[&str]| plica(&directory, arguments).status.code();
    assert_eq!(code(&["march"]), Some(2));
    assert_eq!(code(&["run"]), Some(2));
    assert_eq!(code(&["run", "a.toml", "--threads", "0"]), Some(2));
    assert_eq!(code(&["check", "nowhere.toml"]), Some(3));
    fs::write(directory.join("latin.toml"), b"title = \"\xe9\"").unwrap();
    assert_eq!(code(&["check", "latin.toml"]), Some(2));
    assert_eq!(code(&["--version"]), Some(0));
    assert_eq!(code(&["completions", "bash"]), Some(0));
}

#[test]
fn check_warns_of_letters_missing_in_the_fonts_of_pictures() {
    let directory = scratch("letters");
    let case = read("cases/small.toml");
    let (_, rest) = case.split_once('\n').unwrap();
    let warns = |title: &str, stage: &str| {
        let rest = rest.replace("\"contract\"", &format!("\"{stage}\""));
        let case = format!("title = \"{title}\"\n{rest}");
        fs::write(directory.join("case.toml"), case).unwrap();
        succeed(&directory, &["check", "case.toml"]).contains("warning: ")
    };
    assert!(warns("腸重積", "contract"));
    assert!(warns("gut", "収縮"));
    assert!(!warns("Ελιά, è", "contract"));
}

#[test]
fn new_writes_a_valid_case_and_never_overwrites() {
    let directory = scratch("new");
    succeed(&directory, &["new"]);
    succeed(&directory, &["check", "case.toml"]);
    fs::write(directory.join("case.toml"), "mine").unwrap();
    fail(&directory, &["new"], 3);
    let kept = fs::read_to_string(directory.join("case.toml")).unwrap();
    assert_eq!(kept, "mine");
    assert_eq!(succeed(&directory, &["new", "-"]), plica::case::STARTER);
}

#[test]
fn run_writes_a_directory_and_overwrites_only_runs() {
    let directory = scratch("run");
    fs::write(directory.join("quick.toml"), QUICK).unwrap();
    let run = |arguments: &[&str]| {
        let output = plica(&directory, &[&["run", "quick.toml"], arguments].concat());
        (output.status.code(), text(&output.stderr))
    };
    let (code, stderr) = run(&["--threads", "1"]);
    assert_eq!(code, Some(0), "{stderr}");
    // There is one line per state.
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
    let numbers = stderr
        .lines()
        .filter_map(first)
        .filter_map(|word| word.parse().ok());
    assert_eq!(numbers.collect::<Vec<usize>>(), [0, 1, 2], "{stderr}");
    for file in ["case.toml", "manifest.json"] {
        assert!(directory.join("runs/quick").join(file).exists(), "{file}");
    }
    let (code, stderr) = run(&[]);
    assert_eq!(code, Some(3), "{stderr}");
    assert!(stderr.contains("--overwrite"), "{stderr}");
    assert_eq!(run(&["--overwrite"]).0, Some(0));

    let precious = directory.join("precious");
    fs::create_dir(&precious).unwrap();
    fs::write(precious.join("thesis.tex"), "years").unwrap();
    assert_eq!(run(&["--out", "precious", "--overwrite"]).0, Some(3));
    assert!(precious.join("thesis.tex").exists());
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    #[test]
    fn an_interrupted_run_writes_its_results() {
        let directory = scratch("interrupt");
        let long = QUICK.replace("steps = 2", "steps = 20000");
        fs::write(directory.join("long.toml"), long).unwrap();
        let mut run = Command::new(PLICA)
            .args(["run", "long.toml"])
            .current_dir(&directory)
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(run.stderr.take().unwrap()).lines();
        // The heading is printed with the first state.
        assert!(lines.any(|line| line.unwrap().contains("Lmax/L")));
        let pid = run.id().to_string();
        Command::new("kill").args(["-INT", &pid]).status().unwrap();
        let rest: Vec<String> = lines.map(Result::unwrap).collect();
        assert_eq!(run.wait().unwrap().code(), Some(130), "{rest:?}");
        assert!(rest.last().unwrap().starts_with("interrupted"), "{rest:?}");
        assert!(directory.join("runs/long/manifest.json").exists());
    }

    #[test]
    fn a_closed_pipe_is_not_an_error() {
        let mut new = Command::new(PLICA)
            .args(["completions", "zsh"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(new.stdout.take());
        let output = new.wait_with_output().unwrap();
        assert!(output.status.success());
        assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    }
}
