//! Finite inflation of a thick tube in plane strain, compared with the exact solution.
//!
//! A tube with sliding ends keeps its length (λz = 1), and a follower pressure p acts on its inner wall. Equilibrium of an
//! axisymmetric tube is one equation, d σr / dr = (σθ − σr) / r, whose solution by quadrature gives the pressure at which
//! the inner radius a has grown to 1.1 and 1.5 times its value A = 0.44 D at rest.
//!
//! Expected (E = 1, ν = 0.495, H = 0.06 D): p(1.1) = 0.0122352033 E and p(1.5) = 0.0329557773 E, from a one-dimensional
//! integration to the digits shown.

use plica::measure::{Face, Meridians};
use plica::{Study, case};
use std::error::Error;

/// Pressures in E and the inner radii a/A that belong to them.
const EXACT: [(f64, f64); 2] = [(0.0122352033, 1.1), (0.0329557773, 1.5)];

fn main() -> Result<(), Box<dyn Error>> {
    let [(first, _), (second, _)] = EXACT;
    let text = format!(
        "
        tube = {{ length = 0.2, thickness = 0.06 }}
        ends = {{ colon = 'sliding', ileum = 'sliding' }}
        mesh.control_points = {{ axial = 4, around = 60, thickness = 8 }}
        output.stability_modes = 0
        [[stages]]
        steps = 4
        drive.inner-wall.pressure = {first:e}
        [[stages]]
        steps = 8
        drive.inner-wall.pressure = {second:e}
        "
    );
    let plan = case::read(&text, "inflation")?;
    let mut study = Study::new(&plan)?;
    let mut radii = vec![];
    while let Some(state) = study.next() {
        let state = state?;
        if state.ends_stage {
            let meridians = Meridians::of(study.tube(), &state.load, &state.unknowns);
            let wall = &meridians.walls(Face::Inner, &[0.0], &[0.1])[0];
            radii.push(wall.points[0].1 / plan.tube.inner_radius());
        }
    }
    // The first state is the tube at rest.
    for ((pressure, exact), radius) in EXACT.iter().zip(&radii[1..]) {
        println!("p = {pressure:.10} E: a/A = {radius:.8} (expected {exact:.8})");
    }
    Ok(())
}
