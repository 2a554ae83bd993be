//! `plica export`. `scripts/check-vtk` reads the files with VTK.

use crate::common::{damage, fail, scratch, short_run, succeed};
use std::fs;
use std::path::Path;

/// Returns the sorted names of the files in a directory.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn export_writes_all_walls_and_the_requested_volumes() {
    let directory = scratch("export");
    let run = short_run(&directory);
    let stdout = succeed(&directory, &["export", "run", "--state", "1", "--linear"]);
    assert!(stdout.contains("walls: 4 files"));
    let vtk = run.join("vtk");
    assert_eq!(names(&vtk.join("walls")).len(), 4);
    assert_eq!(names(&vtk.join("volume")), ["state-0001.vtu"]);
    assert_eq!(names(&vtk.join("linear")), ["state-0001.vtu"]);
    // 9 elements along, thrice, and one through the wall, thrice.
    assert_eq!(names(&vtk.join("meridian")).len(), 4);
    let meridian = fs::read(vtk.join("meridian/state-0001.vtp")).unwrap();
    let head = String::from_utf8_lossy(&meridian[..4000]);
    assert!(
        head.contains(&format!("NumberOfPoints=\"{}\"", 28 * 4)),
        "{head}"
    );
    assert!(head.contains("Name=\"cauchy_stress\"") && meridian.len() < 30_000);
    let volume = fs::read(vtk.join("volume/state-0001.vtu")).unwrap();
    let head = String::from_utf8_lossy(&volume[..4000]);
    // 9 × 8 × 1 elements of 4³ nodes, of which neighbours share a face.
    let points = format!("NumberOfPoints=\"{}\"", (9 * 3 + 1) * 8 * 3 * 4);
    assert!(head.contains(&points), "{head}");
    assert!(head.contains("Name=\"cauchy_stress\""), "{head}");
    // The default is the last state; the collection keeps files written before.
    succeed(&directory, &["export", "run"]);
    let collection = fs::read_to_string(vtk.join("volume.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 2, "{collection}");
    assert!(collection.contains("file=\"volume/state-0003.vtu\""));
    // Overwriting a run removes its exported files.
    succeed(
        &directory,
        &["run", "case.toml", "--out", "run", "--overwrite"],
    );
    assert!(
        names(&vtk.join("walls")).is_empty()
            && names(&vtk.join("meridian")).is_empty()
            && !vtk.join("volume.pvd").exists()
    );
}

#[test]
fn export_refuses_missing_and_damaged_states() {
    let directory = scratch("export-refused");
    let run = short_run(&directory);
    let refuses = |arguments: &[&str], code: i32, what: &str| {
        let stderr = fail(&directory, arguments, code);
        assert!(stderr.contains(what), "{stderr}");
        assert!(!run.join("vtk").exists());
    };
    refuses(
        &["export", "run", "--state", "9"],
        2,
        "choose from 0, 1, 2, 3",
    );
    refuses(
        &["export", "run", "--state", "1", "--all"],
        2,
        "cannot be used with",
    );
    refuses(&["export", "nowhere"], 3, "nowhere");
    refuses(&["export", "."], 3, "");
    let state = run.join("states/state-0003.safetensors");
    damage(&state);
    let stderr = fail(&directory, &["export", "run"], 3);
    assert!(stderr.contains("damaged"));
    for file in names(&run.join("states")) {
        fs::remove_file(run.join("states").join(file)).unwrap();
    }
    let stderr = fail(&directory, &["export", "run"], 2);
    assert!(stderr.contains("has saved no states"));
}

#[test]
fn several_exports_and_pages_of_a_run_at_a_time_succeed() {
    use std::process::{Child, Command, Stdio};
    let directory = scratch("export-together");
    let run = short_run(&directory);
    let commands: [&[&str]; 8] = [
        &["export", "run", "--all"],
        &["export", "run", "--all"],
        &["export", "run", "--state", "1", "--linear"],
        &["report", "run"],
        &["report", "run"],
        &["plot", "run"],
        &["plot", "run"],
        &["render", "run", "--out", "picture.png", "--width", "600"],
    ];
    let start = |arguments: &&[&str]| {
        let mut command = Command::new(crate::common::PLICA);
        command.args(*arguments).current_dir(&directory);
        command.stdout(Stdio::null()).spawn().unwrap()
    };
    let children: Vec<Child> = commands.iter().map(start).collect();
    for (mut child, arguments) in children.into_iter().zip(commands) {
        assert!(child.wait().unwrap().success(), "{arguments:?}");
    }
    assert!(crate::common::files(&directory, "part").is_empty());
    let collection = fs::read_to_string(run.join("vtk/volume.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 4, "{collection}");
}

#[test]
fn a_reader_without_plica_evaluates_the_spline_of_a_saved_state() {
    let python = |arguments: &[&str]| {
        let output = std::process::Command::new("python3")
            .args(arguments)
            .output();
        output.ok().filter(|output| output.status.success())
    };
    if python(&["-c", "import numpy"]).is_none() {
        return;
    }
    let directory = scratch("evaluate");
    let run = short_run(&directory);
    let profile = fs::read_to_string(run.join("profiles/state-0003.csv")).unwrap();
    let state = run.join("states/state-0003.safetensors");
    let script = crate::common::root().join("docs/evaluate_state.py");
    for line in profile.lines().skip(1).step_by(150) {
        let numbers: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let z = numbers[0].to_string();
        let paths = [script.to_str().unwrap(), state.to_str().unwrap()];
        let printed = python(&[paths[0], paths[1], &z, "0.5", "0.0"]).unwrap();
        let found: Vec<f64> = crate::common::text(&printed.stdout)
            .split_whitespace()
            .map(|x| x.parse().unwrap())
            .collect();
        // The profile has ten digits.
        for (a, b) in [
            (found[2], numbers[1]),
            (found[0].hypot(found[1]), numbers[2]),
        ] {
            assert!((a - b).abs() < 1e-8, "{line}: {found:?}");
        }
    }
}
