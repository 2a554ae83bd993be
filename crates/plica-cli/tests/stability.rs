//! `plica stability`.

use crate::common::{PLICA, compare, plica, scratch, succeed, text};
use plica::saved_state::SavedState;
use std::fs;
use std::path::Path;

/// A relaxing tube on a coarse mesh.
const RELAXING: &str = "\
[mesh]
control_points = { axial = 60, around = 48, thickness = 4 }

[muscles.long]
direction = \"longitudinal\"
zone = [0.5, 1.0]

[[stages]]
name = \"relax\"
steps = 6
drive.long.length_ratio = 1.07

[output]
pictures = false
";

/// Runs a case and tests its stability. Returns exit code, standard output and standard error.
fn run_and_test(directory: &Path, case: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    fs::write(directory.join("case.toml"), case).unwrap();
    let run = ["run", "case.toml", "--out", "run", "--overwrite"];
    succeed(directory, &run);
    stability(directory, arguments)
}

/// Tests the stability of the run. Returns exit code, standard output and standard error.
fn stability(directory: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = plica(directory, &[&["stability", "run"], arguments].concat());
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

#[test]
fn a_relaxing_tube_becomes_oval_first() {
    let directory = scratch("stability");
    let (code, stdout, stderr) = run_and_test(&directory, RELAXING, &["--threads", "2"]);
    assert_eq!(code, Some(0), "{stderr}");
    let lost = stdout.lines().find(|line| line.contains(" lost ")).unwrap();
    let cells: Vec<&str> = lost.split_whitespace().collect();
    assert_eq!(
        cells[..8],
        ["relax", "2", "turns", "oval", "lost", "0", ">", "1"],
        "{stdout}"
    );
    let [critical, from, to] = [9, 10, 11].map(|i| cells[i].parse::<f64>().unwrap());
    // 1.0681 on finer meshes.
    assert!((critical - 1.0681).abs() < 2e-3, "{stdout}");
    assert!(
        from <= critical && critical <= to && to - from <= 1.01e-4,
        "{stdout}"
    );
    assert!(
        stdout.contains("first loss             circumferential mode 2 (turns oval), at Lmax/L"),
        "{stdout}"
    );
    // Three lines of heading and one line per state.
    assert_eq!(stderr.lines().count(), 3 + 7, "{stderr}");

    let run = directory.join("run");
    let mode = SavedState::read(&run.join("modes/mode-01-harmonic-2.safetensors")).unwrap();
    let (shape, harmonic) = (&mode.arrays["mode"], &mode.arrays["harmonic"]);
    assert_eq!(
        (shape.shape.as_slice(), harmonic.values.as_slice()),
        (&[60, 4, 3][..], &[2.0][..])
    );
    assert!((-1e-2..0.0).contains(&mode.arrays["eigenvalue"].values[0]));
    let largest = shape.values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    assert_eq!(largest, 1.0);
    assert!((mode.load.muscles[0] - to).abs() < 1e-5, "{stdout}");
    for picture in ["stability.png", "mode.png"] {
        let bytes = fs::read(run.join(picture)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{picture}");
    }
    let table = |name: &str| fs::read_to_string(run.join(name)).unwrap();
    let (critical_values, eigenvalues) = (table("stability.csv"), table("eigenvalues.csv"));
    assert_eq!(critical_values.lines().count(), 2, "{critical_values}");
    // Seven states and the two limits of the bracket.
    assert_eq!(eigenvalues.lines().count(), 1 + 7 + 2, "{eigenvalues}");

    // The results do not depend on the number of threads. A test of fewer modes removes the previous results.
    let (_, alone, _) = stability(&directory, &["--threads", "1"]);
    assert_eq!((alone, table("eigenvalues.csv")), (stdout, eigenvalues));
    let (code, stdout, _) = stability(&directory, &["--harmonics", "1"]);
    assert_eq!(code, Some(0));
    assert!(
        stdout.starts_with("  all 7 states (0 to 6) are stable to circumferential modes 0 to 1\n"),
        "{stdout}"
    );
    assert!(!run.join("modes/mode-01-harmonic-2.safetensors").exists());
    assert!(!run.join("mode.png").exists() && run.join("stability.png").exists());
}

#[test]
fn runs_that_cannot_be_tested_are_explained() {
    let directory = scratch("stability-refused");
    let mut page = String::new();
    let mut note =
        |what: &str, expected: i32, (code, stdout, stderr): (Option<i32>, String, String)| {
            assert_eq!(
                (code, stdout.as_str()),
                (Some(expected), ""),
                "{what}: {stderr}"
            );
            // Without the heading and the states.
            let error = stderr
                .find("error: ")
                .map_or(stderr.as_str(), |at| &stderr[at..]);
            page += &format!("==== {what}\n{error}\n");
        };
    let short = RELAXING
        .replace("steps = 6", "steps = 1")
        .replace("1.07", "1.01");
    note("no directory", 3, stability(&directory, &[]));
    fs::create_dir(directory.join("run")).unwrap();
    note("an empty directory", 3, stability(&directory, &[]));
    let none = format!("{short}states_every = 0\n");
    note("no states", 2, run_and_test(&directory, &none, &[]));
    let fold = format!("symmetry = {{ fold = 24 }}\n{short}");
    note(
        "circumferential modes of several rings",
        2,
        run_and_test(&directory, &fold, &["--harmonics", "2"]),
    );
    note(
        "a state that was not saved",
        2,
        stability(&directory, &["--state", "7"]),
    );
    let twisted = short.replace("[output]", "drive.ileum.twist_degrees = 5.0\n[output]");
    note("twisted", 2, run_and_test(&directory, &twisted, &[]));

    let state = directory.join("run/states/state-0001.safetensors");
    let case = directory.join("run/case.toml");
    assert_eq!(run_and_test(&directory, &short, &[]).0, Some(0));
    note(
        "modes of one ring",
        2,
        stability(&directory, &["--modes", "2"]),
    );
    let whole = fs::read(&state).unwrap();
    fs::write(&state, &whole[..whole.len() - 8]).unwrap();
    note("a state cut short", 3, stability(&directory, &[]));
    let rest = fs::read(directory.join("run/states/state-0000.safetensors")).unwrap();
    let mut other = SavedState::from_bytes(&rest).unwrap();
    (other.row, other.load.muscles[0]) = (1, 1.01);
    fs::write(&state, other.to_bytes().unwrap()).unwrap();
    let (code, stdout, stderr) = stability(&directory, &[]);
    // The residual depends on the machine.
    let (about, rule) = stderr.rsplit_once("residual ").unwrap();
    let rule = &rule[rule.find("): if").unwrap()..];
    note(
        "no equilibrium",
        3,
        (code, stdout, format!("{about}residual ...{rule}")),
    );
    other.layout.mesh.axial = 61;
    other.u.extend([0.0; 12]);
    fs::write(&state, other.to_bytes().unwrap()).unwrap();
    note("another mesh", 3, stability(&directory, &[]));
    fs::write(&case, fs::read_to_string(&case).unwrap() + "# mine\n").unwrap();
    note("another case", 3, stability(&directory, &[]));
    note(
        "a tolerance of nothing",
        2,
        stability(&directory, &["--tolerance", "0"]),
    );
    compare("stability.txt", &page);
}

#[test]
fn the_lowest_modes_of_a_three_dimensional_tube_are_found() {
    let directory = scratch("stability-modes");
    let case = "\
symmetry = { fold = 2 }
[mesh]
control_points = { axial = 20, around = 12, thickness = 4 }
[muscles.long]
direction = \"longitudinal\"
zone = [0.5, 1.0]
[[imperfections]]
of = \"colon-end\"
amplitude = 5e-3
shape = { wave = { mode = 2, phase_degrees = 30 } }
[[stages]]
name = \"relax\"
steps = 1
drive.long.length_ratio = 1.02
[output]
pictures = false
";
    let modes = ["--modes", "2", "--state", "1"];
    let (code, stdout, stderr) = run_and_test(&directory, case, &modes);
    assert_eq!(code, Some(0), "{stderr}");
    // A heading, two modes, the states and the names of the files.
    let lines: Vec<&str> = stdout.lines().collect();
    assert_eq!(lines.len(), 5, "{stdout}");
    assert!(
        stderr.ends_with("note: stability was tested at states 1 only, not at 0\n"),
        "{stderr}"
    );
    let first: Vec<&str> = lines[1].split_whitespace().collect();
    assert_eq!(first[..6], ["1", "relax", "1.0200", "1.0000", "0", "1"]);
    assert_eq!(first[8], "2", "turns oval: {stdout}");
    let run = directory.join("run");
    let table = fs::read_to_string(run.join("eigenpairs.csv")).unwrap();
    assert_eq!(table.lines().count(), 3, "{table}");
    let read = |number: usize| {
        let name = format!("modes/mode-state-0001-{number}.safetensors");
        SavedState::read(&run.join(name)).unwrap()
    };
    let (one, two) = (read(1), read(2));
    let value = |mode: &SavedState, name: &str| mode.arrays[name].values[0];
    assert!(value(&one, "eigenvalue") <= value(&two, "eigenvalue"));
    assert!(value(&one, "residual") <= 1e-4 && value(&one, "harmonic") == 2.0);
    assert_eq!(one.arrays["mode"].shape, [20, 4, 3, 6]);
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    assert_eq!(largest(&one.arrays["mode"].values), 1.0);
    let shares = &one.arrays["shares"].values;
    assert!(
        (shares.iter().sum::<f64>() - 1.0).abs() < 1e-12,
        "{shares:?}"
    );
    assert!(shares.iter().skip(1).step_by(2).all(|&share| share == 0.0));
    let picture = fs::read(run.join("mode.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n"));

    // The results do not depend on the number of threads.
    let (_, alone, _) = stability(&directory, &[&modes[..], &["--threads", "1"]].concat());
    assert_eq!(alone, stdout);
    assert_eq!(
        fs::read_to_string(run.join("eigenpairs.csv")).unwrap(),
        table
    );
    // Results of one state do not replace those of another; those of the same state do.
    let (code, both, stderr) = stability(&directory, &["--modes", "1", "--state", "0"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(!stderr.contains("not at"), "{stderr}");
    assert!(both.contains("states 0 to 1\n"), "{both}");
    let merged = fs::read_to_string(run.join("eigenpairs.csv")).unwrap();
    let kept = table.split_once('\n').unwrap().1;
    assert!(
        merged.lines().count() == 4 && merged.ends_with(kept),
        "{merged}"
    );
    let manifest = fs::read_to_string(run.join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["stability"]["states"], serde_json::json!([0, 1]));
    stability(&directory, &["--modes", "1"]);
    assert!(!run.join("modes/mode-state-0001-2.safetensors").exists());
}

#[test]
fn results_say_which_states_they_cover_when_a_stage_is_added() {
    let directory = scratch("stability-added");
    let short = RELAXING
        .replace("steps = 6", "steps = 2")
        .replace("1.07", "1.02");
    assert_eq!(run_and_test(&directory, &short, &[]).0, Some(0));
    let added = "[[stages]]\nname = \"more\"\nsteps = 1\ndrive.long.length_ratio = 1.03\n[output]";
    fs::write(
        directory.join("case.toml"),
        short.replace("[output]", added),
    )
    .unwrap();
    let output = plica(
        &directory,
        &["run", "case.toml", "--out", "run", "--resume"],
    );
    let stderr = text(&output.stderr);
    let gaps = "stability was tested at states 0 to 2 only, not at 3";
    assert!(output.status.success() && stderr.contains(gaps), "{stderr}");
    succeed(&directory, &["report", "run"]);
    let page = || fs::read_to_string(directory.join("run/report.html")).unwrap();
    assert!(page().contains(gaps));
    assert_eq!(stability(&directory, &[]).0, Some(0));
    succeed(&directory, &["report", "run"]);
    assert!(!page().contains("stability was tested at states"));
}

#[cfg(unix)]
#[test]
fn an_interrupted_stability_test_writes_nothing() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    let directory = scratch("stability-interrupt");
    let case = RELAXING.replace("steps = 6", "steps = 60");
    fs::write(directory.join("case.toml"), case).unwrap();
    succeed(&directory, &["run", "case.toml", "--out", "run"]);
    let mut test = Command::new(PLICA)
        .args(["stability", "run", "--tolerance", "1e-9"])
        .current_dir(&directory)
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(test.stderr.take().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().contains("lowest eigenvalue")));
    let pid = test.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().unwrap();
    let rest: Vec<String> = lines.map(Result::unwrap).collect();
    assert_eq!(test.wait().unwrap().code(), Some(130), "{rest:?}");
    assert_eq!(rest.last().unwrap(), "interrupted; nothing was written");
    assert!(!directory.join("run/stability.csv").exists());
}
