//! Runs that do not converge: their messages, and resuming them with other settings.

use crate::common::{fail, plica, scratch, succeed, text};
use std::fs;

const CASE: &str = r#"
symmetry = { fold = 2 }
[tube]
length = 2.0
thickness = 0.1
[muscles.circular]
direction = "circular"
zone = [0.5, 1.0]
[mesh]
control_points = { axial = 24, around = 16, thickness = 4 }
[[stages]]
name = "contract"
steps = 2
drive.circular.diameter_ratio = 0.9
[[stages]]
name = "strangle"
steps = 1
drive.circular.diameter_ratio = 0.3
[solver]
newton_iterations = 4
relaxation_steps = 4
max_step_halvings = 0
[output]
pictures = false
"#;

#[test]
fn a_lost_run_reports_the_place_and_a_remedy_that_works() {
    let directory = scratch("lost");
    fs::write(directory.join("case.toml"), CASE).unwrap();
    let stderr = fail(&directory, &["run", "case.toml", "--out", "run"], 1);
    let last = stderr.lines().last().unwrap();
    for word in [
        "in stage `strangle`",
        "newton:",
        "relaxation: not in equilibrium after 4 solves",
        "the last good state is kept",
        "largest residual at z = ",
        "largest strain energy density at z = ",
        "θ = ",
        "wall",
        "solver.max_step_halvings",
    ] {
        assert!(last.contains(word), "{word}: {last}");
    }
    // The residual is largest near the muscle.
    let z = last.split("largest residual at z = ").nth(1).unwrap();
    let z: f64 = z.split(' ').next().unwrap().parse().unwrap();
    assert!((0.4..1.1).contains(&z), "{last}");
    let manifest = fs::read_to_string(directory.join("run/manifest.json")).unwrap();
    assert!(
        manifest.contains(r#""verdict": "lost""#) && manifest.contains("largest residual at z = ")
    );
    assert!(directory.join("run/states/state-0002.safetensors").exists());
    // Follow the advice.
    fs::write(
        directory.join("case.toml"),
        CASE.replace("max_step_halvings = 0", "max_step_halvings = 8"),
    )
    .unwrap();
    succeed(
        &directory,
        &["run", "case.toml", "--out", "run", "--resume"],
    );
    assert!(directory.join("run/states/state-0003.safetensors").exists());
}

#[test]
fn a_run_without_a_first_state_reports_that() {
    let directory = scratch("lost-first");
    let oval = "[[imperfections]]\nof = \"colon-end\"\namplitude = 0.025\nshape = { wave = { mode = 2 } }\n";
    let case = CASE
        .replace("newton_iterations = 4", "newton_iterations = 1")
        .replace("relaxation_steps = 4", "relaxation_steps = 1")
        .replace(
            "[[stages]]\nname = \"contract\"",
            &(oval.to_owned() + "[[stages]]\nname = \"contract\""),
        );
    fs::write(directory.join("case.toml"), case).unwrap();
    let output = plica(&directory, &["run", "case.toml", "--out", "run"]);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(text(&output.stdout).ends_with("no state was accepted\n"));
    let last = stderr.lines().last().unwrap();
    for word in [
        "no equilibrium of the tube at rest",
        "no first state",
        "smaller imperfection",
    ] {
        assert!(last.contains(word), "{word}: {last}");
    }
    assert!(
        !last.contains("last good state") && !last.contains("max_step_halvings"),
        "{last}"
    );
}
