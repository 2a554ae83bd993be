//! Stability of tubes by circumferential mode against closed forms.

use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean};
use plica::solve::{Path, Settings};
use plica::stability::{Harmonics, ModeStability};
use plica::tube::{Mesh, Support, Tube, WallLayer};
use std::f64::consts::PI;

/// Returns an axisymmetric tube without muscles.
fn passive(
    [length, thickness, poisson_ratio]: [f64; 3],
    ends: Support,
    [axial, around, through]: [usize; 3],
) -> TubeProblem {
    let tube = Tube {
        length,
        thickness,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0,
            poisson_ratio,
        )))],
        muscles: vec![],
        imperfections: vec![],
        obstacles: vec![],
        ends: [ends; 2],
        patches: vec![],
        foundations: vec![],
    };
    let mesh = Mesh {
        axial,
        around,
        thickness: through,
        degree: 3,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    };
    TubeProblem::new(SplineTube::new(&tube, &mesh, 1))
}

/// Euler's strain between fixed ends is ε = 4π² I/(A L²); with shear it is ε/(1 + ε E/(κG)), κ = ½ for a thin ring
/// (Timoshenko and Gere 1961).
#[test]
fn a_compressed_tube_buckles_at_euler_s_load() {
    let (length, thickness, poisson_ratio) = (30.0, 0.06, 0.3);
    let inner = 0.5 - thickness;
    let gyration = (0.25 + inner * inner) / 4.0; // I/A
    let euler = 4.0 * PI * PI * gyration / (length * length);
    let shear = 2.0 * (1.0 + poisson_ratio) / 0.5; // E/(κG)
    let expected = euler / (1.0 + euler * shear);

    let size = [length, thickness, poisson_ratio];
    let problem = passive(size, Support::Fixed, [63, 12, 4]);
    let harmonics = Harmonics::new(&problem, 3);
    let (rest, u) = (problem.tube.tube.rest(), vec![0.0; problem.tube.unknowns()]);
    let mut path = Path::begin(&problem, rest.clone(), u, Settings::default()).unwrap();
    let mut loaded = rest;
    loaded.ends[1].displacement = -1.2 * expected * length;
    path.begin_segment(loaded);
    let mut tested = |factor: f64| -> Vec<ModeStability> {
        path.advance(factor / 1.2, &mut ()).unwrap();
        harmonics.test(&path.state().load, &path.state().u).unwrap()
    };
    let (below, above) = (tested(0.9), tested(1.1));
    assert!(
        below
            .iter()
            .all(|tested| tested.negative == 0 && tested.lowest > 0.0)
    );
    let negative: Vec<usize> = above.iter().map(|tested| tested.negative).collect();
    assert_eq!(negative, [0, 1, 0, 0]);
    // Linear interpolation.
    let (a, b) = (below[1].lowest, above[1].lowest);
    let critical = 0.9 + 0.2 * a / (a - b);
    println!(
        "critical strain {:.6}, expected {expected:.6}",
        critical * expected
    );
    assert!(
        (critical - 1.0).abs() < 0.02,
        "relative error {:e}",
        critical - 1.0
    );
}

/// A thin ring between sliding plates is free to translate and to rotate. Its lowest other modes stretch the wall, with
/// λ = (1 + n²) E/(1 − ν²)/r² for n = 0 and 1, also under pressure.
#[test]
fn neutral_rigid_motions_are_excluded() {
    let (length, thickness, poisson_ratio) = (0.1, 0.01, 0.3);
    let size = [length, thickness, poisson_ratio];
    let problem = passive(size, Support::Sliding, [4, 60, 5]);
    let rest = problem.tube.tube.rest();
    let harmonics = Harmonics::new(&problem, 1);
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(&problem, rest.clone(), u, Settings::default()).unwrap();
    let mut loaded = rest;
    loaded.pressures[1].follower = 1e-6;
    path.begin_segment(loaded);
    for t in [0.0, 1.0] {
        path.advance(t, &mut ()).unwrap();
        let tested = harmonics.test(&path.state().load, &path.state().u).unwrap();
        for (n, tested) in tested.iter().enumerate() {
            let middle = 0.5 - 0.5 * thickness;
            let stretched = (1 + n * n) as f64 / (1.0 - poisson_ratio * poisson_ratio);
            let expected = stretched / (middle * middle);
            assert_eq!(tested.negative, 0);
            let error = tested.lowest / expected - 1.0;
            assert!(error.abs() < 1e-3, "n = {n}: {}, {expected}", tested.lowest);
        }
    }
}
