//! Tubes whose diameter and thickness vary, and ends that leave their axis.

use plica::assembly::Point;
use plica::case;
use plica::study::{State, Study};
use std::f64::consts::PI;

/// Runs a case to its end.
fn run(text: &str) -> (Study, Vec<State>) {
    let plan = case::read(text, "case").unwrap();
    let mut study = Study::new(&plan).unwrap();
    let states: Vec<State> = study.by_ref().map(Result::unwrap).collect();
    (study, states)
}

#[test]
fn a_cone_under_pressure_has_the_hoop_stress_of_a_membrane() {
    // A dead load of this size is nearly a pressure.
    for load in ["pressure", "dead_load"] {
        cone_under(load);
    }
}

fn cone_under(inner_wall: &str) {
    let text = "[tube]\nlength = 1.5\nthickness = 0.02\ndiameter_along = [[0.0, 1.0], [1.5, 0.7]]\n\
                [material.neo-hookean]\npoisson_ratio = 0.3\n\
                [mesh]\ncontrol_points = { axial = 40, around = 60, thickness = 5 }\n\
                [[stages]]\nsteps = 1\ndrive.inner-wall.";
    let (study, states) = run(&format!("{text}{inner_wall} = 1e-5"));
    let [first, last] = [0, 1].map(|i| &states[i]);
    assert!(
        first.energy == 0.0 && first.relative_residual < 1e-6,
        "{first:?}"
    );
    // The inner face is one thickness from the outer one, but for the ends.
    let slope = 0.15_f64 / 1.5;
    let cos = 1.0 / slope.hypot(1.0);
    let [a, b] = [0.5, 0.35].map(|radius| radius - 0.02 / cos);
    let lumen = PI * 1.5 / 3.0 * (a * a + a * b + b * b);
    assert!((first.dimensions.lumen_volume / lumen - 1.0).abs() < 1e-4);
    // Gauss points through the wall.
    let inner = study.tube().tube.inner_radius();
    let points = [(0.211_324_865, 0.5), (0.788_675_135, 0.5)];
    let mean: f64 = points
        .iter()
        .map(|(x, weight)| {
            let radius = inner + x * (0.5 - inner);
            let at = Point {
                z: 0.75,
                radius,
                angle: 0.0,
            };
            weight
                * study
                    .tube()
                    .sample(&last.load, &last.unknowns, at)
                    .wall_stresses()[2]
        })
        .sum();
    // N = p r/cos α, with r to the inner face, which the pressure acts on.
    let expected = 1e-5 * (0.425 - 0.02 * cos) / cos / 0.02;
    assert!((mean / expected - 1.0).abs() < 0.01, "{mean} {expected}");
}

#[test]
fn a_thinner_end_widens_more_under_pressure() {
    let text = "[tube]\nlength = 2.0\nthickness_along = [[0.5, 0.06], [1.5, 0.03]]\n\
                [material.neo-hookean]\npoisson_ratio = 0.3\n\
                [ends]\ncolon = 'sliding'\nileum = 'sliding'\n\
                [mesh]\ncontrol_points = { axial = 30, around = 60, thickness = 4 }\n\
                [[stages]]\nsteps = 1\ndrive.inner-wall.pressure = 1e-5";
    let (study, states) = run(text);
    let moved = |z: f64, radius: f64| {
        let at = Point {
            z,
            radius,
            angle: 0.3,
        };
        let [rest, now] = [0, 1].map(|i| {
            let sample = study
                .tube()
                .sample(&states[i].load, &states[i].unknowns, at);
            sample.position[1].hypot(sample.position[2])
        });
        (rest, now - rest)
    };
    // Lamé's tube in plane strain, at the outer face: u = p a² b (1 − ν²) 2/(E (b² − a²)).
    for (z, thickness) in [(0.02, 0.06), (1.98, 0.03)] {
        let (rest, inner) = (moved(z, 0.5).0, 0.5 - thickness);
        assert!((rest - 0.5).abs() < 1e-6);
        assert!((moved(z, study.tube().tube.inner_radius()).0 - inner).abs() < 1e-6);
        let lame = 2e-5 * inner * inner * 0.5 * 0.91 / (0.25 - inner * inner);
        let found = moved(z, 0.5).1;
        // The ends feel the step in thickness and the axial force a little.
        assert!((found / lame - 1.0).abs() < 0.05, "{z}: {found} {lame}");
    }
}

/// A whole tube between fixed ends, with stages.
fn whole(length: f64, stages: &str) -> String {
    format!(
        "symmetry = 'none'\n[tube]\nlength = {length}\nthickness = 0.1\n\
         [material.neo-hookean]\npoisson_ratio = 0.3\n\
         [mesh]\ncontrol_points = {{ axial = 20, around = 16, thickness = 4 }}\n\
         [output]\nstability_modes = 0\n{stages}"
    )
}

#[test]
fn ends_that_move_together_carry_the_tube_along_without_stress() {
    // The second end of a tube that turns by 0.7 about (0.6, 0.8) through the middle of the first.
    let (angle, [a, b]) = (0.7_f64, [0.6, 0.8]);
    let (sin, cos) = angle.sin_cos();
    let length = 2.0;
    let tilt = [a, b].map(|x| x * angle.to_degrees());
    let text = whole(
        length,
        &format!(
            "[[stages]]\nsteps = 2\n\
             drive.colon.offset = [0.2, -0.1]\ndrive.ileum.offset = [0.2, -0.1]\n\
             [[stages]]\nsteps = 4\n\
             drive.colon.tilt_degrees = [{0}, {1}]\n\
             drive.ileum = {{ tilt_degrees = [{0}, {1}], offset = [{2}, {3}], displacement = {4} }}\n",
            tilt[0],
            tilt[1],
            0.2 + length * b * sin,
            -0.1 - length * a * sin,
            length * (cos - 1.0),
        ),
    );
    let (study, states) = run(&text);
    for i in [2, 6] {
        let state = &states[i];
        assert!(state.energy < 1e-14, "{}", state.energy);
        for reaction in &state.reactions {
            assert!(reaction.shear_force() < 1e-8 && reaction.bending_moment() < 1e-8);
        }
    }
    let at = Point {
        z: length,
        radius: 0.45,
        angle: 1.1,
    };
    let sample = study
        .tube()
        .sample(&states[2].load, &states[2].unknowns, at);
    let [_, x, y] = [0, 1, 2].map(|i| sample.position[i] - sample.reference[i]);
    assert!((x - 0.2).abs() < 1e-14 && (y + 0.1).abs() < 1e-14);
    // On the way the tube is bent.
    assert!(states[4].energy > 1e-6);
}

#[test]
fn opposite_tilts_bend_the_tube_with_the_moment_of_a_beam() {
    // Small, as the ends do not approach each other, and a bent tube is longer than its chord.
    let (length, angle) = (6.0, 0.04_f64);
    let half = 0.5 * angle;
    let text = whole(
        length,
        &format!(
            "[[stages]]\nsteps = 1\ndrive.colon.tilt_degrees = [0.0, {0}]\ndrive.ileum.tilt_degrees = [0.0, -{0}]\n",
            half.to_degrees()
        ),
    );
    let (_, states) = run(&text);
    let inertia = 0.25 * PI * (0.5_f64.powi(4) - 0.4_f64.powi(4));
    let expected = inertia * angle / length;
    for reaction in &states[1].reactions {
        let moment = reaction.bending_moment();
        assert!(
            (moment / expected - 1.0).abs() < 0.03,
            "{moment} {expected}"
        );
        assert!(reaction.shear_force() < 1e-3 * expected);
    }
    let work = &states[1].work.ends;
    assert!((work[0] / work[1] - 1.0).abs() < 1e-6);
}

#[test]
fn tables_offsets_and_volumes_are_in_the_unit_of_the_case() {
    let text = |tube: &str, drive: &str| {
        format!(
            "symmetry = 'none'\nunits = {{ length = 'mm', stress = 'kPa' }}\n\
             [tube]\ndiameter = 25.0\nlength = 80.0\nthickness = 1.5\n{tube}\n\
             [mesh]\ncontrol_points = {{ axial = 20, around = 12, thickness = 4 }}\n\
             [[stages]]\ndrive.{drive}"
        )
    };
    let tables = "diameter_along = [[0.0, 25.0], [60.0, 25.0], [80.0, 20.0]]\n\
                  thickness_along = [[10.0, 1.5], [20.0, 1.0]]";
    let plan = case::read(&text(tables, "ileum.offset = [5.0, -10.0]"), "case").unwrap();
    let outline = plan.tube.outline().unwrap();
    assert_eq!(outline.diameter, [[0.0, 1.0], [2.4, 1.0], [3.2, 0.8]]);
    assert_eq!(outline.thickness, [[0.4, 0.06], [0.8, 0.04]]);
    assert_eq!(plan.stages[0].load.ends[1].shift, [0.2, -0.4]);
    // Of the cylinder, and of the shape that the tables give.
    let ratio = |tube: &str, volume: f64| {
        let text = text(tube, &format!("lumen.volume = {volume:e}"));
        let plan = case::read(&text, "case").unwrap();
        plan.stages[0].load.lumen_volume.unwrap()
    };
    let cylinder = PI * 11.0 * 11.0 * 80.0;
    assert!((ratio("", 2.0 * cylinder) - 2.0).abs() < 1e-12);
    let wider = ratio("diameter_along = [[0.0, 50.0]]", cylinder);
    assert!(
        (wider * (23.5_f64 / 11.0).powi(2) - 1.0).abs() < 1e-3,
        "{wider}"
    );
}

#[test]
fn springs_hold_a_cone_that_its_ends_push_along() {
    // Its ends move together by d, and the springs pull back with k A d, A the area of the outer face.
    let (k, d) = (1e-4, 1e-4);
    let text = format!(
        "[tube]\nlength = 1.5\nthickness = 0.06\ndiameter_along = [[0.0, 1.0], [1.5, 0.7]]\n\
         [mesh]\ncontrol_points = {{ axial = 20, around = 60, thickness = 4 }}\n\
         [[foundations]]\nstiffness = {k:e}\n\
         [[stages]]\nsteps = 1\ndrive.colon.displacement = {d:e}\ndrive.ileum.displacement = {d:e}\n"
    );
    let (_, states) = run(&text);
    let area = PI * (0.5 + 0.35) * 0.15_f64.hypot(1.5);
    // Positive if they pull the end outwards, so that the colon end pushes.
    let [colon, ileum] = [0, 1].map(|end| states[1].reactions[end].axial_force());
    let found = ileum - colon;
    assert!((found / (k * area * d) - 1.0).abs() < 1e-3, "{found}");
}
