//! `plica follow`: its files, and what it refuses.

use crate::common::{fail, scratch, succeed};
use std::fs;

const CASE: &str = "
title = 'a coarse balloon'
[tube]
length = 1.5
[mesh]
control_points = { axial = 16, around = 16, thickness = 4 }
[output]
stability_modes = 1
[[stages]]
steps = 1
drive.inner-wall.pressure = 0.01
[continuation]
of = 'inner-wall.pressure'
between = [0.01, 0.05]
points = 60
longest_step = 0.1
switch = [{ mode = 1 }]
plot = ['lumen_volume']
";

#[test]
fn branches_points_states_and_diagrams_are_written() {
    let folder = scratch("follow");
    fs::write(folder.join("balloon.toml"), CASE).unwrap();
    let said = succeed(&folder, &["follow", "balloon.toml"]);
    assert!(said.contains("fold, maximum of the parameter"), "{said}");
    let out = folder.join("runs/balloon-branches");
    let points = fs::read_to_string(out.join("points.csv")).unwrap();
    let fold = points.lines().find(|line| line.starts_with("LP1,1,"));
    assert!(fold.is_some_and(|fold| fold.contains("fold")), "{points}");
    for name in [
        "case.toml",
        "branches/01.csv",
        "points/LP1.safetensors",
        "modes/LP1.safetensors",
        "diagram-lumen_volume.png",
        "diagram-lumen_volume.svg",
    ] {
        assert!(out.join(name).exists(), "{name}");
    }
    let branch = fs::read_to_string(out.join("branches/01.csv")).unwrap();
    assert!(branch.starts_with("arc_length,parameter,label,negative_mode_0,negative_mode_1,"));

    // The directory is replaced on request only, and no other directory ever is.
    let refused = fail(&folder, &["follow", "balloon.toml"], 2);
    assert!(refused.contains("--overwrite"), "{refused}");
    let again = [
        "follow",
        "balloon.toml",
        "--overwrite",
        "--set",
        "continuation.points=3",
    ];
    succeed(&folder, &again);
    assert!(!out.join("points/LP1.safetensors").exists());
    let other = ["follow", "balloon.toml", "--overwrite", "--out", "."];
    let refused = fail(&folder, &other, 2);
    assert!(refused.contains("not a directory of branches"), "{refused}");

    // A state on the branch is one to start a run from.
    let start = "[start]\nstate = 'runs/balloon-branches/points/LP1.safetensors'\n";
    succeed(&folder, &["follow", "balloon.toml", "--overwrite"]);
    let case = CASE.replace("[[stages]]", &format!("{start}[[stages]]"));
    let case = case.split("[continuation]").next().unwrap();
    fs::write(folder.join("start.toml"), case).unwrap();
    succeed(&folder, &["check", "start.toml"]);
}

#[test]
fn a_case_without_continuation_is_refused() {
    let folder = scratch("follow-nothing");
    let case = CASE.split("[continuation]").next().unwrap();
    fs::write(folder.join("case.toml"), case).unwrap();
    let refused = fail(&folder, &["follow", "case.toml"], 2);
    assert!(refused.contains("[continuation]"), "{refused}");
}
