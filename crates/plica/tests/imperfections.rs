//! Small imperfections grow where the perfect tube is about to lose stability.

use plica::assembly::SplineTube;
use plica::study::{State, Study};

/// Runs a case. Returns for every state the length ratio and the largest displacement of the inner wall since the first state in
/// circumferential mode n, by its parts in phase with cos nφ and sin nφ.
fn waves(name: &str, case: &str, n: usize) -> Vec<(f64, [f64; 2])> {
    let plan = plica::case::read(case, name).unwrap();
    let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
    let states: Result<Vec<State>, _> = Study::new(&plan).unwrap().collect();
    let states = states.unwrap();
    let rest = &states[0].unknowns;
    let waves = states.iter().map(|state| {
        let displacement = state.unknowns.iter().zip(rest);
        let displacement: Vec<f64> = displacement.map(|(u, r)| u - r).collect();
        (state.length_ratio(), largest_wave(&tube, &displacement, n))
    });
    waves.collect()
}

/// Returns the amplitudes of these waves.
fn growth(name: &str, case: &str, n: usize) -> Vec<(f64, f64)> {
    let waves = waves(name, case, n).into_iter();
    waves.map(|(ratio, [x, y])| (ratio, x.hypot(y))).collect()
}

/// Returns the largest wave of circumferential mode n in the radial control values of the innermost points.
fn largest_wave(tube: &SplineTube, u: &[f64], n: usize) -> [f64; 2] {
    let k = tube.sector.rings;
    let wave = |row: &[f64]| {
        let radial = row[k..2 * k].iter().enumerate();
        let sum = radial.fold([0.0, 0.0], |sum, (j, u)| {
            let (sin, cos) = (n as f64 * tube.sector.ring_angle(j)).sin_cos();
            [sum[0] + u * cos, sum[1] + u * sin]
        });
        sum.map(|x| 2.0 / k as f64 * x)
    };
    let waves = u.chunks(tube.row_size()).map(wave);
    let size = |[x, y]: &[f64; 2]| x.hypot(*y);
    let largest = waves.max_by(|a, b| size(a).total_cmp(&size(b)));
    largest.unwrap_or_default()
}

#[test]
fn an_oval_imperfection_of_the_wall_grows_along_its_crest() {
    // A crest at 30°, and one perpendicular to it.
    for (name, degrees, side) in [("oval-30", 30.0_f64, 1.0), ("oval-120", 120.0, -1.0)] {
        let case = format!(
            "symmetry = {{ fold = 2 }}
            [muscles.longitudinal]
            direction = 'longitudinal'
            zone = [0.5, 1.0]
            [mesh]
            control_points = {{ axial = 24, around = 16, thickness = 4 }}
            [output]
            profiles_every = 0
            states_every = 0
            [[stages]]
            steps = 4
            drive.longitudinal.length_ratio = 1.06
            [[imperfections]]
            of = 'geometry'
            amplitude = 1e-4
            shape = {{ wave = {{ mode = 2, phase_degrees = {degrees} }} }}"
        );
        let waves = waves(name, &case, 2);
        let [x, y] = waves[4].1;
        let (sin, cos) = 60.0_f64.to_radians().sin_cos();
        // The wave is in phase with the crest and grows.
        let size = x.hypot(y);
        assert!(side * (x * cos + y * sin) > 0.99 * size, "{waves:?}");
        let before = waves[2].1;
        assert!(size > 2.0 * before[0].hypot(before[1]), "{waves:?}");
    }
}

/// Returns a case on a coarse mesh whose colon end has an imperfection in one circumferential mode.
fn case(symmetry: &str, around: usize, harmonic: usize, stages: &str) -> String {
    format!(
        "symmetry = {symmetry}
        [muscles.longitudinal]
        direction = 'longitudinal'
        zone = [0.5, 1.0]
        [mesh]
        control_points = {{ axial = 24, around = {around}, thickness = 4 }}
        [[imperfections]]
        of = 'colon-end'
        amplitude = 1e-4
        shape = {{ wave = {{ mode = {harmonic} }} }}
        {stages}"
    )
}

#[test]
fn an_oval_end_makes_a_relaxing_tube_oval_near_its_critical_value() {
    let relaxing = "[[stages]]
        steps = 6
        drive.longitudinal.length_ratio = 1.06";
    let oval = growth("oval", &case("{ fold = 2 }", 16, 2, relaxing), 2);
    // The perfect tube loses stability to mode 2 near Lmax/L = 1.07 on this mesh. Far from there the oval grows in proportion
    // to the relaxation, close to it much faster.
    let at = |step: usize| oval[step].1;
    assert!(at(1) > 1e-6 && at(2) < 2.5 * at(1), "{oval:?}");
    assert!(at(6) > 4.0 * at(3), "{oval:?}");
}

#[test]
fn a_shifted_end_makes_an_invaginating_tube_tilt_near_its_critical_value() {
    let invaginating = "[muscles.circular]
        direction = 'circular'
        zone = [0.5, 1.0]
        [[stages]]
        steps = 4
        drive.circular.diameter_ratio = 0.25
        [[stages]]
        steps = 19
        drive.longitudinal.length_ratio = 1.19";
    let tilt = growth("tilt", &case("'none'", 12, 1, invaginating), 1);
    // The perfect tube loses stability to mode 1 near Lmax/L = 1.19 on this mesh.
    let at = |step: usize| tilt[step].1;
    assert!((tilt[21].0 - 1.17).abs() < 1e-12);
    assert!(at(19) < 1.3 * at(17), "{tilt:?}");
    assert!(at(23) > 2.0 * at(21), "{tilt:?}");
}
