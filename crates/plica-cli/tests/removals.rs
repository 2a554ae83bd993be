//! Files and directories that another program removes, moves or damages, during a run and after it: nothing is lost in silence,
//! nothing is written elsewhere, and what is left can be used.

use crate::common::{
    PLICA, assert_contents, contents, copy, damage, fail, plica, scratch, succeed, text,
};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A case of many short steps.
const CASE: &str = r#"
[tube]
length = 2.0
thickness = 0.1
[muscles.circular]
direction = "circular"
zone = [0.5, 1.5]
[mesh]
control_points = { axial = 40, around = 8, thickness = 4 }
[[stages]]
name = "contract"
steps = 60
drive.circular.diameter_ratio = 0.8
[output]
pictures = false
states_every = 2
"#;

/// Starts the run and waits until it has so many states.
fn start(directory: &Path, states: usize) -> Child {
    let run = directory.join("cut");
    let _ = fs::remove_dir_all(&run);
    let child = Command::new(PLICA)
        .args(["run", "case.toml", "--out", "cut"])
        .current_dir(directory)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let count = || {
        let history = fs::read_to_string(run.join("history.csv")).unwrap_or_default();
        history.lines().count()
    };
    while count() <= states {
        assert!(begin.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

/// Waits for the end of the run; returns its exit code and standard error.
fn end(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.signal(), None);
    (output.status.code(), text(&output.stderr))
}

/// Makes a directory with the case, and returns it with the contents of the undisturbed run.
fn undisturbed(name: &str) -> (PathBuf, std::collections::BTreeMap<PathBuf, Vec<u8>>) {
    let directory = scratch(name);
    fs::write(directory.join("case.toml"), CASE).unwrap();
    succeed(&directory, &["run", "case.toml", "--out", "whole"]);
    let expected = contents(&directory.join("whole"));
    (directory, expected)
}

#[test]
fn a_run_whose_directory_is_moved_or_removed_stops_and_writes_nowhere_else() {
    let (directory, expected) = undisturbed("removed-directory");
    let [run, moved] = ["cut", "moved"].map(|name| directory.join(name));
    for states in [1, 7, 23] {
        let child = start(&directory, states);
        fs::rename(&run, &moved).unwrap();
        let (code, stderr) = end(child);
        assert_eq!(code, Some(3), "{stderr}");
        assert!(
            stderr.contains("cut was removed, moved or replaced"),
            "{stderr}"
        );
        assert!(!run.exists());
        // It resumes in its new place.
        succeed(&directory, &["resume", "moved"]);
        assert_contents("moved", &expected, &moved);
        fs::remove_dir_all(&moved).unwrap();

        let child = start(&directory, states);
        fs::rename(&run, &moved).unwrap();
        fs::create_dir(&run).unwrap();
        let (code, stderr) = end(child);
        assert_eq!(code, Some(3), "{stderr}");
        // A file that was being written while the directory was replaced may be in the new one.
        assert!(fs::read_dir(&run).unwrap().count() <= 1);
        fs::remove_dir_all(&moved).unwrap();

        let child = start(&directory, states);
        // The run may write a file while the directory is emptied.
        while fs::remove_dir_all(&run).is_err() {}
        let (code, stderr) = end(child);
        assert_eq!(code, Some(3), "{stderr}");
        assert!(!run.exists(), "{stderr}");
    }
}

#[test]
fn a_run_whose_files_are_removed_stops_keeps_its_history_and_resumes() {
    let (directory, expected) = undisturbed("removed-files");
    let run = directory.join("cut");
    for (name, states) in [
        ("history.csv", 1),
        ("history.csv", 9),
        ("history.csv", 30),
        ("case.toml", 5),
        ("manifest.json", 5),
        ("lock", 5),
    ] {
        let child = start(&directory, states);
        fs::remove_file(run.join(name)).unwrap();
        let (code, stderr) = end(child);
        assert_eq!(code, Some(3), "{name}: {stderr}");
        assert!(
            stderr.contains(&format!("cut/{name} was removed"))
                && stderr.contains("plica resume cut"),
            "{name}: {stderr}"
        );
        let manifest = fs::read_to_string(run.join("manifest.json")).unwrap();
        assert!(manifest.contains("\"verdict\": \"stopped\""), "{manifest}");
        succeed(&directory, &["resume", "cut"]);
        assert_contents(name, &expected, &run);
    }
    // Another content is no history of the run either.
    let child = start(&directory, 9);
    let history = fs::read(run.join("history.csv")).unwrap();
    fs::write(run.join("history.csv"), &history[..history.len() / 2]).unwrap();
    let (code, stderr) = end(child);
    assert_eq!(code, Some(3), "{stderr}");
    succeed(&directory, &["resume", "cut"]);
    assert_contents("truncated", &expected, &run);
    // With everything removed, the history and the last state are written again; the rest is listed.
    let child = start(&directory, 9);
    // The run is paused meanwhile: it would stop at the first missing file, and write files that are removed after it.
    let signal = |name: &str| {
        let pid = child.id().to_string();
        let sent = Command::new("kill").args([name, &pid]).status();
        assert!(sent.unwrap().success());
    };
    let is_writing = || {
        let folders = ["", "profiles", "states"].map(|name| fs::read_dir(run.join(name)));
        let files = folders.into_iter().flatten().flatten().flatten();
        files
            .map(|file| file.file_name())
            .any(|name| name.to_string_lossy().contains(".part"))
    };
    loop {
        signal("-STOP");
        // Its threads stop a moment after the signal was sent.
        std::thread::sleep(std::time::Duration::from_millis(200));
        if !is_writing() {
            break;
        }
        signal("-CONT");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    for name in ["profiles", "states"] {
        let _ = fs::remove_dir_all(run.join(name));
    }
    for entry in fs::read_dir(&run).unwrap().flatten() {
        let _ = fs::remove_file(entry.path());
    }
    signal("-CONT");
    let (code, stderr) = end(child);
    assert_eq!(code, Some(3), "{stderr}");
    let resumed = plica(&directory, &["resume", "cut"]);
    let stderr = text(&resumed.stderr);
    assert!(resumed.status.success(), "{stderr}");
    assert!(
        stderr.contains("states/state-0000.safetensors is missing"),
        "{stderr}"
    );
    let found = contents(&run);
    for name in ["history.csv", "checkpoint.safetensors", "case.toml"] {
        assert!(
            found[Path::new(name)] == expected[Path::new(name)],
            "{name}"
        );
    }
    let manifest = fs::read_to_string(run.join("manifest.json")).unwrap();
    assert!(manifest.contains("missing_files"), "{manifest}");
}

#[test]
fn files_of_earlier_states_that_are_removed_during_a_run_are_listed_at_its_end() {
    let (directory, _) = undisturbed("removed-states");
    let run = directory.join("cut");
    for name in ["states/state-0002.safetensors", "profiles/state-0003.csv"] {
        let child = start(&directory, 9);
        fs::remove_file(run.join(name)).unwrap();
        let (code, stderr) = end(child);
        assert_eq!(code, Some(3), "{stderr}");
        assert!(stderr.contains(&format!("{name} (missing)")), "{stderr}");
        let manifest = fs::read_to_string(run.join("manifest.json")).unwrap();
        assert!(
            manifest.contains(name) && manifest.contains("\"complete\""),
            "{manifest}"
        );
    }
}

#[test]
fn a_damaged_history_is_restored_from_the_checkpoint() {
    let (directory, expected) = undisturbed("damaged-history");
    let run = directory.join("cut");
    let mut killed = start(&directory, 12);
    killed.kill().unwrap();
    killed.wait().unwrap();
    let table = fs::read(run.join("history.csv")).unwrap();
    let before = directory.join("before");
    fs::rename(&run, &before).unwrap();
    // Bits all over the table: the header, names, digits, commas and line ends.
    for part in 0..24 {
        copy(&before, &run);
        let mut bytes = table.clone();
        let at = part * (bytes.len() - 1) / 23;
        bytes[at] ^= 1 << (part % 7);
        fs::write(run.join("history.csv"), bytes).unwrap();
        let output = plica(&directory, &["resume", "cut"]);
        assert!(output.status.success(), "{part}: {}", text(&output.stderr));
        assert_contents(&format!("bit {part}"), &expected, &run);
        fs::remove_dir_all(&run).unwrap();
    }
    for content in [None, Some(""), Some("nonsense")] {
        copy(&before, &run);
        match content {
            None => fs::remove_file(run.join("history.csv")).unwrap(),
            Some(text) => fs::write(run.join("history.csv"), text).unwrap(),
        }
        let output = plica(&directory, &["resume", "cut"]);
        let stderr = text(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        assert!(stderr.contains("restored from the checkpoint"), "{stderr}");
        assert_contents("no table", &expected, &run);
        fs::remove_dir_all(&run).unwrap();
    }
}

#[test]
fn damage_to_a_complete_run_is_noticed_by_resume_and_by_whatever_reads_it() {
    let (directory, expected) = undisturbed("damaged-complete");
    let run = directory.join("whole");
    let warning = |arguments: &[&str]| text(&plica(&directory, arguments).stderr);
    // A digit of the energy of state 3.
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let line = history.lines().nth(4).unwrap();
    let at = history.find(line).unwrap() + line.len() / 2;
    let mut bytes = history.clone().into_bytes();
    bytes[at] ^= 1;
    for bytes in [bytes, history.as_bytes()[..history.len() / 3].to_vec()] {
        fs::write(run.join("history.csv"), bytes).unwrap();
        for arguments in [
            &["plot", "whole"][..],
            &["report", "whole"],
            &["export", "whole"],
        ] {
            let stderr = warning(arguments);
            assert!(
                stderr.contains("whole/history.csv is damaged or incomplete at state"),
                "{stderr}"
            );
        }
        for folder in ["vtk", "pictures"] {
            let _ = fs::remove_dir_all(run.join(folder));
        }
        let _ = fs::remove_file(run.join("report.html"));
        succeed(&directory, &["resume", "whole"]);
        assert_contents("restored", &expected, &run);
    }
    assert_eq!(warning(&["plot", "whole"]), "");
    // A saved state that is gone, and a profile and a state with another content.
    damage(&run.join("profiles/state-0005.csv"));
    fs::remove_file(run.join("states/state-0004.safetensors")).unwrap();
    damage(&run.join("states/state-0006.safetensors"));
    let stderr = fail(&directory, &["resume", "whole"], 3);
    for what in [
        "profiles/state-0005.csv (damaged)",
        "states/state-0004.safetensors (missing)",
        "states/state-0006.safetensors (damaged)",
    ] {
        assert!(stderr.contains(what), "{stderr}");
    }
    for arguments in [
        &["render", "whole"][..],
        &["report", "whole"],
        &["export", "whole"],
    ] {
        let stderr = warning(arguments);
        assert!(
            stderr.contains("whole/states/state-0004.safetensors is missing"),
            "{stderr}"
        );
    }
    let stderr = fail(&directory, &["render", "whole", "--state", "6"], 3);
    assert!(
        stderr.contains("whole/states/state-0006.safetensors"),
        "{stderr}"
    );
}
