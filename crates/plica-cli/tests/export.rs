//! `plica export` as its user meets it. What VTK itself reads of its files, `scripts/check-vtk` tells.

mod common;

use common::{plica, scratch, short_run, text};
use std::fs;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn walls_of_every_state_and_volumes_of_those_asked_for() {
    let directory = scratch("export");
    let run = short_run(&directory);
    let said = plica(&directory, &["export", "run", "--state", "1", "--linear"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert!(text(&said.stdout).contains("walls: 4 files"));
    let vtk = run.join("vtk");
    assert_eq!(names(&vtk.join("walls")).len(), 4);
    assert_eq!(names(&vtk.join("volume")), ["state-0001.vtu"]);
    assert_eq!(names(&vtk.join("linear")), ["state-0001.vtu"]);
    let volume = fs::read(vtk.join("volume/state-0001.vtu")).unwrap();
    let head = String::from_utf8_lossy(&volume[..4000]);
    // 9 elements of 4³ nodes, 8 around, 1 through the wall: shared.
    let points = format!("NumberOfPoints=\"{}\"", (9 * 3 + 1) * 8 * 3 * 4);
    assert!(head.contains(&points), "{head}");
    assert!(head.contains("Name=\"cauchy_stress\""), "{head}");
    // Without being asked the last state; what was written before stays in the collection.
    let said = plica(&directory, &["export", "run"]);
    assert!(said.status.success());
    let collection = fs::read_to_string(vtk.join("volume.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 2, "{collection}");
    assert!(collection.contains("file=\"volume/state-0003.vtu\""));
    // A run that is replaced takes its files along.
    let said = plica(
        &directory,
        &["run", "case.toml", "--out", "run", "--overwrite"],
    );
    assert!(said.status.success());
    assert!(names(&vtk.join("walls")).is_empty() && !vtk.join("volume.pvd").exists());
}

#[test]
fn what_is_not_there_is_refused() {
    let directory = scratch("export-refused");
    let run = short_run(&directory);
    let refused = |arguments: &[&str], code: i32, what: &str| {
        let said = plica(&directory, arguments);
        assert_eq!(said.status.code(), Some(code), "{arguments:?}");
        assert!(text(&said.stderr).contains(what), "{}", text(&said.stderr));
        assert!(!run.join("vtk").exists());
    };
    refused(
        &["export", "run", "--state", "9"],
        2,
        "these are: 0, 1, 2, 3",
    );
    refused(
        &["export", "run", "--state", "1", "--all"],
        2,
        "cannot be used with",
    );
    refused(&["export", "nowhere"], 3, "nowhere");
    refused(&["export", "."], 3, "");
    let state = run.join("states/state-0003.safetensors");
    let mut bytes = fs::read(&state).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&state, bytes).unwrap();
    let said = plica(&directory, &["export", "run"]);
    assert_eq!(said.status.code(), Some(3));
    assert!(text(&said.stderr).contains("damaged"));
    for file in names(&run.join("states")) {
        fs::remove_file(run.join("states").join(file)).unwrap();
    }
    let said = plica(&directory, &["export", "run"]);
    assert_eq!(said.status.code(), Some(2));
    assert!(text(&said.stderr).contains("has saved no states"));
}
