//! Rigid obstacles in a run of the program.

use crate::common::{Table, fail, scratch, succeed};
use std::fs;

/// A tube that contracts onto a rod, which then widens.
const CASE: &str = r#"
[tube]
length = 1.0
[muscles.ring]
direction = "circular"
zone = [0.2, 0.8]
[mesh]
control_points = { axial = 24, around = 8, thickness = 4 }
[[obstacles]]
name = "scope"
shape = { rod = { radius = 0.3 } }
[[stages]]
name = "contract"
steps = 6
drive.ring.diameter_ratio = 0.5
[[stages]]
name = "widen"
steps = 3
drive.scope.radius = 0.35
[output]
pictures = false
"#;

#[test]
fn a_tube_that_contracts_onto_a_rod_has_its_contact_in_the_history() {
    let directory = scratch("obstacles");
    fs::write(directory.join("case.toml"), CASE).unwrap();
    succeed(&directory, &["run", "case.toml", "--out", "whole"]);
    let history = Table::history(&directory.join("whole"));
    let numbers = |name: &str| history.numbers(name);
    let (gap, force, area) = (
        numbers("contact_gap_scope"),
        numbers("contact_force_scope"),
        numbers("contact_area_scope"),
    );
    assert!(
        (gap[0] - 0.14).abs() < 1e-3 && gap.iter().all(|gap| *gap > 0.0),
        "{gap:?}"
    );
    for (i, force) in force.iter().enumerate() {
        // Contact begins within a quarter of an element.
        assert_eq!(*force > 0.0, area[i] > 0.0);
    }
    assert_eq!(force[..2], [0.0; 2]);
    assert!(force[6] > 0.0 && force[9] > 1.2 * force[6], "{force:?}");
    assert!(numbers("work_scope")[9] > 0.0);
    assert_eq!(numbers("work_scope")[..7], [0.0; 7]);
    assert_eq!(*numbers("radius_scope").last().unwrap(), 0.35);
    // The inner radius is the rod's and a gap.
    let outer = numbers("outer_radius_min");
    assert!(outer[9] > 0.38 && outer[9] < 0.41, "{outer:?}");
    // Symmetric about the middle of the tube.
    assert!(
        numbers("reaction_z_scope")
            .iter()
            .all(|force| force.abs() < 1e-9)
    );
}

#[test]
fn a_run_with_obstacles_is_resumed_to_the_same_bytes() {
    let directory = scratch("obstacles-resumed");
    let case = CASE.replace("{ radius = 0.3 } }", "{ radius = 0.3 } }\nfriction = 0.2");
    fs::write(directory.join("case.toml"), &case).unwrap();
    succeed(&directory, &["run", "case.toml", "--out", "whole"]);
    let until = [
        "run",
        "case.toml",
        "--out",
        "cut",
        "--until",
        "outer_radius_min < 0.42",
    ];
    succeed(&directory, &until);
    succeed(&directory, &["resume", "cut"]);
    let history = |run: &str| {
        let text = fs::read_to_string(directory.join(run).join("history.csv")).unwrap();
        crate::common::without_times(&text)
    };
    assert_eq!(history("whole"), history("cut"));
    let friction = Table::history(&directory.join("whole")).numbers("friction_work_scope");
    assert!(
        friction[6] > 0.0 && friction[9] > friction[6],
        "{friction:?}"
    );
    // The stability test follows the path with the friction of its states, and leaves it out of its verdicts.
    let stability = succeed(&directory, &["stability", "whole"]);
    assert!(
        stability.contains("left out               friction"),
        "{stability}"
    );
    // Another obstacle is another tube.
    let other = case.replace("radius = 0.3 }", "radius = 0.29 }");
    fs::write(directory.join("other.toml"), other).unwrap();
    let refusal = fail(
        &directory,
        &["run", "other.toml", "--out", "cut", "--resume"],
        2,
    );
    assert!(refusal.contains("the tube"), "{refusal}");
}
