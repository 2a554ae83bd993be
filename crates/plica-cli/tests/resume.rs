//! `plica resume`: runs that were killed, stopped or ended by a full disk, or whose checkpoints are damaged. The resumed run must
//! have the same files as an uninterrupted run, except for wall times.

use crate::common::{PLICA, assert_contents, contents, fail, plica, scratch, succeed, text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// An axisymmetric case with two stages, which saves every third state and keeps others for pictures only.
const AXISYMMETRIC: &str = r#"
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
steps = 6
drive.circular.diameter_ratio = 0.7
[[stages]]
name = "press"
steps = 4
drive.outer-wall.pressure = 1e-4
[output]
states_every = 3
"#;

/// A three-dimensional case with an imperfect end.
const TILTED: &str = r#"
symmetry = "none"
[tube]
length = 2.0
thickness = 0.1
[muscles.circular]
direction = "circular"
zone = [0.5, 1.5]
[mesh]
control_points = { axial = 14, around = 8, thickness = 4 }
[[imperfections]]
of = "colon-end"
amplitude = 0.02
shape = { wave = { mode = 1 } }
[[stages]]
steps = 4
drive.circular.diameter_ratio = 0.7
[[stages]]
steps = 2
drive.ileum.twist_degrees = 10
"#;

/// Returns a case in pseudo-time, whose velocity is part of the checkpoint.
fn damped() -> String {
    AXISYMMETRIC.replace("[output]", "[solver]\nscheme = \"newmark\"\n[solver.pseudo_time]\nequilibrate = false\n[output]\nprofiles_every = 2")
}

/// Runs a case without interruption. Returns the contents of the run and the time it took.
fn uninterrupted(directory: &Path, case: &str) -> (BTreeMap<PathBuf, Vec<u8>>, Duration) {
    fs::write(directory.join("case.toml"), case).unwrap();
    let begin = Instant::now();
    succeed(directory, &["run", "case.toml", "--out", "whole"]);
    (contents(&directory.join("whole")), begin.elapsed())
}

/// Pseudo-random numbers from a seed.
struct Chance(u64);

impl Chance {
    /// Returns a number from 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Starts or resumes a run and sends a signal after a time.
fn interrupt(directory: &Path, after: Duration, signal: &str) -> ExitStatus {
    let mut child = Command::new(PLICA)
        .args(["run", "case.toml", "--out", "cut", "--resume"])
        .current_dir(directory)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    while begin.elapsed() < after {
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let pid = child.id().to_string();
    Command::new("kill")
        .args(["-s", signal, &pid])
        .stderr(Stdio::null())
        .status()
        .unwrap();
    child.wait().unwrap()
}

/// Kills runs of a case at random times until `kills` signals have been sent, and compares what they resume to.
fn kill_at_random(name: &str, case: &str, kills: usize, seed: u64) {
    let directory = scratch(name);
    let (expected, took) = uninterrupted(&directory, case);
    let mut chance = Chance(seed);
    let mut killed = 0;
    while killed < kills {
        let _ = fs::remove_dir_all(directory.join("cut"));
        loop {
            let after = took.mul_f64(0.7 * chance.next());
            let signal = ["KILL", "TERM", "INT"][(3.0 * chance.next()) as usize];
            let status = interrupt(&directory, after, signal);
            if status.success() {
                break;
            }
            // Killed by the signal, or stopped on request.
            assert!(matches!(status.code(), None | Some(130)), "{status}");
            killed += 1;
        }
        assert_contents("", &expected, &directory.join("cut"));
    }
}

#[test]
fn runs_killed_at_random_times_resume() {
    kill_at_random("resume-round", AXISYMMETRIC, 4, 1);
    kill_at_random("resume-tilted", TILTED, 3, 2);
    kill_at_random("resume-damped", &damped(), 3, 3);
}

#[test]
#[ignore = "takes minutes"]
fn runs_killed_two_hundred_times_resume() {
    kill_at_random("resume-many-round", AXISYMMETRIC, 80, 11);
    kill_at_random("resume-many-tilted", TILTED, 70, 12);
    kill_at_random("resume-many-damped", &damped(), 60, 13);
}

/// Starts a run and kills it after some states.
fn kill_after_some_states(directory: &Path) -> PathBuf {
    let run = directory.join("cut");
    for _ in 0..50 {
        let _ = fs::remove_dir_all(&run);
        let mut child = Command::new(PLICA)
            .args(["run", "case.toml", "--out", "cut"])
            .current_dir(directory)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let lines = || {
            fs::read_to_string(run.join("history.csv"))
                .unwrap_or_default()
                .lines()
                .count()
        };
        while lines() < 5 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        if !child.wait().unwrap().success() && run.join("checkpoint-before.safetensors").exists() {
            return run;
        }
    }
    panic!("every run ended before it could be killed");
}

/// Flips a bit in the middle of a file.
fn flip(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_damaged_checkpoint_is_detected_and_the_previous_one_used() {
    let directory = scratch("resume-broken");
    let (expected, _) = uninterrupted(&directory, TILTED);
    type Damage = fn(&Path, &Path);
    let damages: [(Damage, &str); 4] = [
        (|now, _| flip(now), "damaged"),
        (
            |now, _| {
                let bytes = fs::read(now).unwrap();
                fs::write(now, &bytes[..bytes.len() - 100]).unwrap();
            },
            "cut short",
        ),
        (|now, _| fs::write(now, "").unwrap(), "cut short"),
        // The checkpoint of another run of the same tube.
        (
            |now, other| {
                fs::copy(other.join("checkpoint.safetensors"), now).unwrap();
            },
            "history.csv",
        ),
    ];
    fs::write(directory.join("other.toml"), TILTED.replace("0.02", "0.01")).unwrap();
    succeed(&directory, &["run", "other.toml", "--out", "other"]);
    for (damage, what) in damages {
        let run = kill_after_some_states(&directory);
        let now = run.join("checkpoint.safetensors");
        if !now.exists() {
            // Killed between two operations: only the previous one exists.
            fs::copy(run.join("checkpoint-before.safetensors"), &now).unwrap();
        }
        damage(&now, &directory.join("other"));
        let output = plica(&directory, &["resume", "cut"]);
        let stderr = text(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        assert!(
            stderr.contains(what) && stderr.contains("the checkpoint before"),
            "{stderr}"
        );
        assert_contents("", &expected, &run);
    }
    // Without a valid checkpoint the run is left unchanged.
    let run = kill_after_some_states(&directory);
    for name in ["checkpoint.safetensors", "checkpoint-before.safetensors"] {
        fs::write(run.join(name), "nonsense").unwrap();
    }
    let before = contents(&run);
    let stderr = fail(&directory, &["resume", "cut"], 3);
    assert!(
        stderr.contains("cannot be resumed") && stderr.contains("--overwrite"),
        "{stderr}"
    );
    assert_contents("", &before, &run);
}

#[test]
fn later_stages_of_a_case_may_change() {
    let directory = scratch("resume-changed");
    let case = AXISYMMETRIC.replace("states_every = 3", "states_every = 1");
    let (expected, _) = uninterrupted(&directory, &case);
    // A complete run continues with a new stage.
    let short = case
        .split("[[stages]]\nname = \"press\"")
        .next()
        .unwrap()
        .to_owned()
        + "[output]\nstates_every = 1\n";
    fs::write(directory.join("case.toml"), &short).unwrap();
    succeed(&directory, &["run", "case.toml", "--out", "cut"]);
    fs::write(directory.join("case.toml"), &case).unwrap();
    succeed(
        &directory,
        &["run", "case.toml", "--out", "cut", "--resume"],
    );
    assert_contents("", &expected, &directory.join("cut"));
    // What has been computed must not change.
    for (from, to, what) in [
        ("length = 2.0", "length = 2.5", "tube.length: 2.0 -> 2.5"),
        (
            "axial = 40",
            "axial = 41",
            "mesh.control_points.axial: 40 -> 41",
        ),
        (
            "= 0.7",
            "= 0.8",
            "stages[1].drive.circular.diameter_ratio: 0.7 -> 0.8",
        ),
    ] {
        fs::write(directory.join("case.toml"), case.replace(from, to)).unwrap();
        let stderr = fail(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
            2,
        );
        assert!(
            stderr.contains(what) && stderr.contains("must not change"),
            "{stderr}"
        );
        assert_contents("", &expected, &directory.join("cut"));
    }
}

#[test]
fn resume_refuses_other_directories_and_starts_missing_runs() {
    let directory = scratch("resume-none");
    fs::write(directory.join("case.toml"), TILTED).unwrap();
    fs::create_dir(directory.join("mine")).unwrap();
    fs::write(directory.join("mine/notes.txt"), "notes").unwrap();
    for arguments in [
        &["run", "case.toml", "--out", "mine", "--resume"][..],
        &["resume", "mine"],
        &["resume", "nowhere"],
    ] {
        fail(&directory, arguments, 3);
        assert_eq!(fs::read_dir(directory.join("mine")).unwrap().count(), 1);
    }
    fail(
        &directory,
        &["run", "case.toml", "--resume", "--overwrite"],
        2,
    );
    succeed(
        &directory,
        &["run", "case.toml", "--out", "new", "--resume"],
    );
}

#[test]
fn a_complete_run_stays_unchanged() {
    let directory = scratch("resume-complete");
    let (expected, _) = uninterrupted(&directory, AXISYMMETRIC);
    for arguments in [
        &["resume", "whole"][..],
        &["run", "case.toml", "--out", "whole", "--resume"],
    ] {
        let stdout = succeed(&directory, arguments);
        assert!(stdout.contains("there is nothing to resume"));
        assert_contents("", &expected, &directory.join("whole"));
    }
    // The steps of a completed stage must not change.
    fs::write(
        directory.join("case.toml"),
        AXISYMMETRIC.replace("steps = 4", "steps = 5"),
    )
    .unwrap();
    fail(
        &directory,
        &["run", "case.toml", "--out", "whole", "--resume"],
        2,
    );
    assert_contents("", &expected, &directory.join("whole"));
    // A run of another version, whose checkpoint and history do not match, is not started again.
    let run = directory.join("whole");
    fs::remove_file(run.join("checkpoint.safetensors")).unwrap();
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    fs::write(
        run.join("history.csv"),
        history.replacen(",lumen,", ",width,", 1),
    )
    .unwrap();
    fs::write(run.join("manifest.json"), "{\"program\": \"plica\"}").unwrap();
    fail(&directory, &["resume", "whole"], 3);
    assert!(run.join("states/state-0010.safetensors").exists());
}

#[test]
fn a_run_killed_while_its_directory_was_created_starts() {
    let directory = scratch("resume-begun");
    let (expected, _) = uninterrupted(&directory, TILTED);
    let run = directory.join("cut");
    let beginnings: [&[(&str, &str)]; 4] = [
        &[("lock", "process 1\n")],
        &[("lock", ""), ("manifest.part", "{")],
        &[("manifest.json", "{\"program\": \"plica\"}")],
        &[
            ("manifest.json", "{\"program\": \"plica\"}"),
            ("case.toml", TILTED),
            ("history.csv", "step,sta"),
        ],
    ];
    for files in beginnings {
        let _ = fs::remove_dir_all(&run);
        fs::create_dir(&run).unwrap();
        for (name, content) in files {
            fs::write(run.join(name), content).unwrap();
        }
        succeed(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        assert_contents("", &expected, &run);
    }
}

/// The run directory keeps a copy of the start state, whose file may change before the run is resumed.
#[test]
fn a_run_resumes_with_its_original_start_state() {
    let directory = scratch("resume-start");
    fs::write(directory.join("first.toml"), AXISYMMETRIC).unwrap();
    succeed(&directory, &["run", "first.toml", "--out", "first"]);
    let start = directory.join("start.safetensors");
    fs::copy(first_state(&directory, 6), &start).unwrap();
    let head = AXISYMMETRIC.split("[[stages]]").next().unwrap();
    let case = format!(
        "{head}\n[start]\nstate = \"start.safetensors\"\n[[stages]]\nsteps = 8\ndrive.circular.diameter_ratio = 0.5\n[output]\nstates_every = 0\n"
    );
    let (expected, _) = uninterrupted(&directory, &case);
    let resume = || {
        let output = plica(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        (output.status.code(), text(&output.stderr))
    };
    let changes: [fn(&Path, &Path); 2] = [
        |first, start| {
            fs::copy(first.join("states/state-0003.safetensors"), start).unwrap();
        },
        |_, start| fs::remove_file(start).unwrap(),
    ];
    for change in changes {
        let run = kill_after_some_states(&directory);
        change(&directory.join("first"), &start);
        let (code, stderr) = resume();
        assert_eq!(code, Some(0), "{stderr}");
        assert_contents("", &expected, &run);
        fs::copy(first_state(&directory, 6), &start).unwrap();
    }
    // A damaged copy is reported under its own name.
    let run = kill_after_some_states(&directory);
    flip(&run.join("start.safetensors"));
    let (code, stderr) = resume();
    assert_eq!(code, Some(3), "{stderr}");
    assert!(
        stderr.contains("cut/start.safetensors") && stderr.contains("damaged"),
        "{stderr}"
    );
    // A file of another name is compared with the copy.
    let run = kill_after_some_states(&directory);
    let other = directory.join("other.safetensors");
    fs::write(
        directory.join("case.toml"),
        case.replace("\"start.safe", "\"other.safe"),
    )
    .unwrap();
    fs::copy(first_state(&directory, 3), &other).unwrap();
    let before = contents(&run);
    let (code, stderr) = resume();
    assert_eq!(code, Some(2), "{stderr}");
    let difference = "start.state: \"start.safetensors\" -> \"other.safetensors\"";
    assert!(
        stderr.contains(
            "must not change the state to start from (`other.safetensors` holds another)"
        ) && stderr.contains(difference),
        "{stderr}"
    );
    assert_contents("", &before, &run);
    fs::copy(first_state(&directory, 6), &other).unwrap();
    let (code, stderr) = resume();
    assert_eq!(code, Some(0), "{stderr}");
    let found = contents(&run);
    let differs = |(name, _): &(&PathBuf, &Vec<u8>)| name.as_path() != Path::new("case.toml");
    assert!(
        found
            .iter()
            .filter(differs)
            .eq(expected.iter().filter(differs))
    );
}

fn first_state(directory: &Path, number: usize) -> PathBuf {
    directory.join(format!("first/states/state-{number:04}.safetensors"))
}

#[test]
fn a_run_directory_is_locked_by_its_process() {
    let directory = scratch("resume-owner");
    fs::write(
        directory.join("case.toml"),
        AXISYMMETRIC.replace("steps = 6", "steps = 600"),
    )
    .unwrap();
    let mut first = Command::new(PLICA)
        .args(["run", "case.toml", "--out", "cut"])
        .current_dir(&directory)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let run = directory.join("cut");
    let begin = Instant::now();
    while !run.join("checkpoint.safetensors").exists() {
        assert!(
            begin.elapsed() < Duration::from_secs(60),
            "the first run does not reach a state"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    for arguments in [
        &["run", "case.toml", "--out", "cut", "--overwrite"][..],
        &["resume", "cut"],
        &["stability", "cut"],
    ] {
        let stderr = fail(&directory, arguments, 3);
        assert!(
            stderr.contains(&format!("process {}", first.id())),
            "{stderr}"
        );
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // The lock of a killed process does not block others.
    fs::write(
        directory.join("case.toml"),
        AXISYMMETRIC.replace("steps = 6", "steps = 7"),
    )
    .unwrap();
    succeed(
        &directory,
        &["run", "case.toml", "--out", "cut", "--overwrite"],
    );
}

/// The shell's limit on the size of files interrupts a write, as a full disk does.
#[test]
fn runs_resume_after_a_full_disk() {
    let directory = scratch("resume-full");
    let (expected, _) = uninterrupted(&directory, TILTED);
    // In blocks of 512 bytes: the history, or checkpoints of later states, do not fit.
    let sizes: Vec<u64> = [
        ("checkpoint.safetensors", 2),
        ("states/state-0002.safetensors", 1),
    ]
    .map(|(name, part)| {
        fs::metadata(directory.join("whole").join(name))
            .unwrap()
            .len()
            / 512
            / part
            - 1
    })
    .to_vec();
    for blocks in [2, 5, sizes[0], sizes[1]] {
        let _ = fs::remove_dir_all(directory.join("cut"));
        let script =
            format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" run case.toml --out cut");
        let output = Command::new("sh")
            .args(["-c", &script, PLICA])
            .current_dir(&directory)
            .output()
            .unwrap();
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{blocks}: {stderr}");
        assert!(stderr.contains("error: cut/"), "{stderr}");
        succeed(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        assert_contents("", &expected, &directory.join("cut"));
    }
}
