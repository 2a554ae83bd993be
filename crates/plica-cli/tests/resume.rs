//! Runs that are killed, stopped, cut off by a full disk or found with broken checkpoints, and taken up again: what they leave
//! in the end is what a run leaves that was let alone, to the byte, wall times aside.

mod common;

use common::{assert_same, left, plica, scratch, text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

const PLICA: &str = env!("CARGO_BIN_EXE_plica");

/// Axisymmetric, through two stages, with states that are saved and others that are kept for pictures only.
const ROUND: &str = r#"
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

/// In three dimensions, with an imperfect end.
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

/// Through pseudo-time, whose velocity is carried on.
fn damped() -> String {
    ROUND.replace("[output]", "[solver]\nscheme = \"newmark\"\n[solver.pseudo_time]\nsettle = false\n[output]\nprofiles_every = 2")
}

/// A case, and what its run leaves that is let alone; how long that takes.
fn undisturbed(directory: &Path, case: &str) -> (BTreeMap<PathBuf, Vec<u8>>, Duration) {
    fs::write(directory.join("case.toml"), case).unwrap();
    let begin = Instant::now();
    let said = plica(directory, &["run", "case.toml", "--out", "whole"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    (left(&directory.join("whole")), begin.elapsed())
}

/// Numbers that look random, the same every time.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Runs or goes on, and sends a signal if it is not done by then.
fn cut(directory: &Path, after: Duration, signal: &str) -> ExitStatus {
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

/// Kills runs of a case at random moments, so often in all.
fn survives(name: &str, case: &str, kills: usize, seed: u64) {
    let directory = scratch(name);
    let (whole, took) = undisturbed(&directory, case);
    let mut chance = Chance(seed);
    let mut killed = 0;
    while killed < kills {
        let _ = fs::remove_dir_all(directory.join("cut"));
        loop {
            let after = took.mul_f64(0.7 * chance.next());
            let signal = ["KILL", "TERM", "INT"][(3.0 * chance.next()) as usize];
            let status = cut(&directory, after, signal);
            if status.success() {
                break;
            }
            // By the signal, or with what a run says that was asked to stop.
            assert!(matches!(status.code(), None | Some(130)), "{status}");
            killed += 1;
        }
        assert_same(&whole, &directory.join("cut"));
    }
}

#[test]
fn a_run_that_is_killed_is_taken_up_again() {
    survives("resume-round", ROUND, 4, 1);
    survives("resume-tilted", TILTED, 3, 2);
    survives("resume-damped", &damped(), 3, 3);
}

/// For the slow suite: `cargo test --release -p plica-cli --test resume -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn runs_that_are_killed_two_hundred_times_are_taken_up_again() {
    survives("resume-many-round", ROUND, 80, 11);
    survives("resume-many-tilted", TILTED, 70, 12);
    survives("resume-many-damped", &damped(), 60, 13);
}

/// A run that was killed on its way, after some states.
fn stopped(directory: &Path) -> PathBuf {
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
    panic!("no run was caught on its way");
}

fn flip(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_broken_checkpoint_is_noticed_and_the_one_before_it_used() {
    let directory = scratch("resume-broken");
    let (whole, _) = undisturbed(&directory, TILTED);
    type Break = fn(&Path, &Path);
    let breaks: [(Break, &str); 4] = [
        (|now, _| flip(now), "damaged"),
        (
            |now, _| {
                let bytes = fs::read(now).unwrap();
                fs::write(now, &bytes[..bytes.len() - 100]).unwrap();
            },
            "cut short",
        ),
        (|now, _| fs::write(now, "").unwrap(), "cut short"),
        // Of another run of the same tube.
        (
            |now, other| {
                fs::copy(other.join("checkpoint.safetensors"), now).unwrap();
            },
            "history.csv",
        ),
    ];
    fs::write(directory.join("other.toml"), TILTED.replace("0.02", "0.01")).unwrap();
    let said = plica(&directory, &["run", "other.toml", "--out", "other"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    for (break_it, what) in breaks {
        let run = stopped(&directory);
        let now = run.join("checkpoint.safetensors");
        if !now.exists() {
            // Killed between the two: there is only the one before.
            fs::copy(run.join("checkpoint-before.safetensors"), &now).unwrap();
        }
        break_it(&now, &directory.join("other"));
        let said = plica(&directory, &["resume", "cut"]);
        let told = text(&said.stderr);
        assert!(said.status.success(), "{told}");
        assert!(
            told.contains(what) && told.contains("the checkpoint before"),
            "{told}"
        );
        assert_same(&whole, &run);
    }
    // With neither there is nothing to go on from, and nothing is touched.
    let run = stopped(&directory);
    for name in ["checkpoint.safetensors", "checkpoint-before.safetensors"] {
        fs::write(run.join(name), "nonsense").unwrap();
    }
    let before = left(&run);
    let said = plica(&directory, &["resume", "cut"]);
    let told = text(&said.stderr);
    assert_eq!(said.status.code(), Some(3), "{told}");
    assert!(
        told.contains("nothing to go on from") && told.contains("--overwrite"),
        "{told}"
    );
    assert_same(&before, &run);
}

#[test]
fn a_case_may_change_ahead_of_where_the_run_is() {
    let directory = scratch("resume-changed");
    let case = ROUND.replace("states_every = 3", "states_every = 1");
    let (whole, _) = undisturbed(&directory, &case);
    // A run that is complete has another stage before it when the case gets one.
    let short = case
        .split("[[stages]]\nname = \"press\"")
        .next()
        .unwrap()
        .to_owned()
        + "[output]\nstates_every = 1\n";
    fs::write(directory.join("case.toml"), &short).unwrap();
    let said = plica(&directory, &["run", "case.toml", "--out", "cut"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    fs::write(directory.join("case.toml"), &case).unwrap();
    let said = plica(
        &directory,
        &["run", "case.toml", "--out", "cut", "--resume"],
    );
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert_same(&whole, &directory.join("cut"));
    // What lies behind may not.
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
        let said = plica(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(2), "{told}");
        assert!(told.contains(what) && told.contains("must stay"), "{told}");
        assert_same(&whole, &directory.join("cut"));
    }
}

#[test]
fn what_is_no_run_is_not_taken_up_and_what_is_not_there_begins() {
    let directory = scratch("resume-none");
    fs::write(directory.join("case.toml"), TILTED).unwrap();
    fs::create_dir(directory.join("mine")).unwrap();
    fs::write(directory.join("mine/notes.txt"), "notes").unwrap();
    for arguments in [
        &["run", "case.toml", "--out", "mine", "--resume"][..],
        &["resume", "mine"],
        &["resume", "nowhere"],
    ] {
        let said = plica(&directory, arguments);
        assert_eq!(said.status.code(), Some(3), "{arguments:?}");
        assert_eq!(fs::read_dir(directory.join("mine")).unwrap().count(), 1);
    }
    let said = plica(&directory, &["run", "case.toml", "--resume", "--overwrite"]);
    assert_eq!(said.status.code(), Some(2));
    let said = plica(
        &directory,
        &["run", "case.toml", "--out", "new", "--resume"],
    );
    assert!(said.status.success(), "{}", text(&said.stderr));
}

#[test]
fn a_run_that_is_complete_stays_as_it_is() {
    let directory = scratch("resume-complete");
    let (whole, _) = undisturbed(&directory, ROUND);
    for arguments in [
        &["resume", "whole"][..],
        &["run", "case.toml", "--out", "whole", "--resume"],
    ] {
        let said = plica(&directory, arguments);
        assert!(said.status.success(), "{}", text(&said.stderr));
        assert!(text(&said.stdout).contains("nothing to go on with"));
        assert_same(&whole, &directory.join("whole"));
    }
    // Its steps are behind it.
    fs::write(
        directory.join("case.toml"),
        ROUND.replace("steps = 4", "steps = 5"),
    )
    .unwrap();
    let said = plica(
        &directory,
        &["run", "case.toml", "--out", "whole", "--resume"],
    );
    assert_eq!(said.status.code(), Some(2), "{}", text(&said.stderr));
    assert_same(&whole, &directory.join("whole"));
    // One of another version has no checkpoint that fits, and maybe another history; neither is a reason to begin again.
    let run = directory.join("whole");
    fs::remove_file(run.join("checkpoint.safetensors")).unwrap();
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    fs::write(
        run.join("history.csv"),
        history.replacen(",lumen,", ",width,", 1),
    )
    .unwrap();
    fs::write(run.join("manifest.json"), "{\"program\": \"plica\"}").unwrap();
    let said = plica(&directory, &["resume", "whole"]);
    assert_eq!(said.status.code(), Some(3), "{}", text(&said.stderr));
    assert!(run.join("states/state-0010.safetensors").exists());
}

#[test]
fn a_run_that_was_killed_while_it_began_begins() {
    let directory = scratch("resume-begun");
    let (whole, _) = undisturbed(&directory, TILTED);
    let run = directory.join("cut");
    let begun: [&[(&str, &str)]; 4] = [
        &[("lock", "process 1\n")],
        &[("lock", ""), ("manifest.part", "{")],
        &[("manifest.json", "{\"program\": \"plica\"}")],
        &[
            ("manifest.json", "{\"program\": \"plica\"}"),
            ("case.toml", TILTED),
            ("history.csv", "step,sta"),
        ],
    ];
    for files in begun {
        let _ = fs::remove_dir_all(&run);
        fs::create_dir(&run).unwrap();
        for (name, content) in files {
            fs::write(run.join(name), content).unwrap();
        }
        let said = plica(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        assert!(said.status.success(), "{files:?}: {}", text(&said.stderr));
        assert_same(&whole, &run);
    }
}

/// What a case names may have changed by the time that it is taken up again; what it was then is kept.
#[test]
fn a_run_goes_on_with_the_state_that_it_began_from() {
    let directory = scratch("resume-start");
    fs::write(directory.join("first.toml"), ROUND).unwrap();
    let said = plica(&directory, &["run", "first.toml", "--out", "first"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let start = directory.join("start.safetensors");
    fs::copy(first_state(&directory, 6), &start).unwrap();
    let head = ROUND.split("[[stages]]").next().unwrap();
    let case = format!(
        "{head}\n[start]\nstate = \"start.safetensors\"\n[[stages]]\nsteps = 8\ndrive.circular.diameter_ratio = 0.5\n[output]\nstates_every = 0\n"
    );
    let (whole, _) = undisturbed(&directory, &case);
    let resume = || {
        let said = plica(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        (said.status.code(), text(&said.stderr))
    };
    let changes: [fn(&Path, &Path); 2] = [
        |first, start| {
            fs::copy(first.join("states/state-0003.safetensors"), start).unwrap();
        },
        |_, start| fs::remove_file(start).unwrap(),
    ];
    for change in changes {
        let run = stopped(&directory);
        change(&directory.join("first"), &start);
        let (code, told) = resume();
        assert_eq!(code, Some(0), "{told}");
        assert_same(&whole, &run);
        fs::copy(first_state(&directory, 6), &start).unwrap();
    }
    // What is kept is told of by its own name where it is damaged.
    let run = stopped(&directory);
    flip(&run.join("start.safetensors"));
    let (code, told) = resume();
    assert_eq!(code, Some(3), "{told}");
    assert!(
        told.contains("cut/start.safetensors") && told.contains("damaged"),
        "{told}"
    );
    // Under another name it is looked at; the same state is the same start.
    let run = stopped(&directory);
    let other = directory.join("other.safetensors");
    fs::write(
        directory.join("case.toml"),
        case.replace("\"start.safe", "\"other.safe"),
    )
    .unwrap();
    fs::copy(first_state(&directory, 3), &other).unwrap();
    let before = left(&run);
    let (code, told) = resume();
    assert_eq!(code, Some(2), "{told}");
    let difference = "start.state: \"start.safetensors\" -> \"other.safetensors\"";
    assert!(
        told.contains("the state that it starts from (`other.safetensors` is another) must stay")
            && told.contains(difference),
        "{told}"
    );
    assert_same(&before, &run);
    fs::copy(first_state(&directory, 6), &other).unwrap();
    let (code, told) = resume();
    assert_eq!(code, Some(0), "{told}");
    let went_on = left(&run);
    let apart = |(name, _): &(&PathBuf, &Vec<u8>)| name.as_path() != Path::new("case.toml");
    assert!(went_on.iter().filter(apart).eq(whole.iter().filter(apart)));
}

fn first_state(directory: &Path, number: usize) -> PathBuf {
    directory.join(format!("first/states/state-{number:04}.safetensors"))
}

#[test]
fn a_directory_has_one_owner() {
    let directory = scratch("resume-owner");
    fs::write(
        directory.join("case.toml"),
        ROUND.replace("steps = 6", "steps = 600"),
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
            "the first run does not come to a state"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    for arguments in [
        &["run", "case.toml", "--out", "cut", "--overwrite"][..],
        &["resume", "cut"],
        &["stability", "cut"],
    ] {
        let said = plica(&directory, arguments);
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(3), "{arguments:?}: {told}");
        assert!(told.contains(&format!("process {}", first.id())), "{told}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // A lock is never stale.
    fs::write(
        directory.join("case.toml"),
        ROUND.replace("steps = 6", "steps = 7"),
    )
    .unwrap();
    let said = plica(
        &directory,
        &["run", "case.toml", "--out", "cut", "--overwrite"],
    );
    assert!(said.status.success(), "{}", text(&said.stderr));
}

/// A file that cannot be written to its end, as on a full disk: the limit of a shell on the size of files.
#[test]
fn a_full_disk_loses_nothing() {
    let directory = scratch("resume-full");
    let (whole, _) = undisturbed(&directory, TILTED);
    // In units of 512 bytes: checkpoints of later states do not fit, or history does not.
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
        let said = Command::new("sh")
            .args(["-c", &script, PLICA])
            .current_dir(&directory)
            .output()
            .unwrap();
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(3), "{blocks}: {told}");
        assert!(told.contains("error: cut/"), "{told}");
        let said = plica(
            &directory,
            &["run", "case.toml", "--out", "cut", "--resume"],
        );
        assert!(said.status.success(), "{blocks}: {}", text(&said.stderr));
        assert_same(&whole, &directory.join("cut"));
    }
}
