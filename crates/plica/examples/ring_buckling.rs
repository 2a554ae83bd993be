//! A ring under external pressure loses stability to an oval.
//!
//! A short tube whose ends slide between two plates is a ring in plane strain. A follower pressure p acts on its outer wall.
//! The perfect ring stays round; the tangent of the whole tube, block by block for each circumferential mode n, shows at which
//! pressure it becomes unstable. The limit for thin rings is p = (n² − 1) E h³ / (12 (1 − ν²) R³), with R the radius of the middle
//! of the wall: 6.9e-4 E for n = 2.
//!
//! Expected (H = 0.06 D, ν = 0.495): p = 6.94351e-4 E for mode 2 and 1.883913e-3 E for mode 3, from an eigenvalue
//! problem in one dimension.

use plica::equilibrium::UnstableMode;
use plica::{Study, case};
use std::error::Error;

/// Returns the pressures, in E, between which a mode loses stability.
fn bracket(mode: usize, from: f64, to: f64, steps: usize) -> Result<[f64; 2], Box<dyn Error>> {
    let text = format!(
        "
        tube = {{ length = 0.5, thickness = 0.06 }}
        ends = {{ colon = 'sliding', ileum = 'sliding' }}
        mesh.control_points = {{ axial = 6, around = 60, thickness = 8 }}
        [[stages]]
        steps = 1
        drive.outer-wall.pressure = {from:e}
        [[stages]]
        steps = {steps}
        drive.outer-wall.pressure = {to:e}
        "
    );
    let plan = case::read(&text, "ring")?;
    let mut stable = 0.0;
    for state in Study::new(&plan)? {
        let state = state?;
        let pressure = state.load.pressures[1].follower;
        let mut modes = state.stability.unstable_modes();
        if modes.any(|unstable| unstable == UnstableMode::Circumferential(mode)) {
            return Ok([stable, pressure]);
        }
        stable = pressure;
    }
    Err("the mode stays stable".into())
}

fn main() -> Result<(), Box<dyn Error>> {
    for (mode, exact) in [(2, 6.94351e-4), (3, 1.883913e-3)] {
        let [from, to] = bracket(mode, 1e-4, 2e-3, 19)?;
        let [from, to] = bracket(mode, from, to, 20)?;
        let [from, to] = bracket(mode, from, to, 20)?;
        println!(
            "mode {mode} loses stability between p = {from:.5e} and {to:.5e} E (expected {exact:.6e})"
        );
    }
    Ok(())
}
