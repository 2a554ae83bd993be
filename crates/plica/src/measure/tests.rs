//! Measures of tilted, shifted, oval and twisted tubes with known values.

use super::{Asymmetry, Measures, Meridians, Side};
use crate::assembly::SplineTube;
use crate::material::{Material, NeoHookean};
use crate::tube::{Mesh, Support, Tube, WallLayer};

/// Returns a tube with 24 control points around, which approximate a circle to 1.2e-5.
fn tube(rings: usize) -> SplineTube {
    let tube = Tube {
        length: 3.0,
        thickness: 0.06,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.3,
        )))],
        muscles: vec![],
        ends: [Support::Free; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    };
    let mesh = Mesh {
        axial: 15,
        around: 24,
        thickness: 4,
        degree: 3,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    };
    SplineTube::new(&tube, &mesh, rings)
}

/// Returns the unknowns that move every control point (z, x, y) to `to([z, x, y])`.
fn mapped(tube: &SplineTube, to: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
    tube.control_values_from(|z, r, ring| {
        let r = r * tube.circle.control_radius;
        let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
        let at = to([z, r * cos, r * sin]);
        let (x, y) = (at[1] - r * cos, at[2] - r * sin);
        [at[0] - z, x * cos + y * sin, y * cos - x * sin]
    })
}

fn measures(tube: &SplineTube, u: &[f64]) -> Measures {
    Measures::of(tube, &tube.tube.rest(), u)
}

/// Narrows the middle, and twists the tube about its axis.
fn narrow([z, x, y]: [f64; 3]) -> [f64; 3] {
    let narrow = 1.0 - 0.6 * (-(z - 1.5_f64).powi(2) / 0.1).exp();
    let (sin, cos) = (0.5 * z).sin_cos();
    [
        z,
        narrow * (x * cos - y * sin),
        narrow * (x * sin + y * cos),
    ]
}

#[test]
fn a_twisted_axisymmetric_tube_of_all_rings_has_the_measures_of_one_ring() {
    let (one, whole) = (tube(1), tube(24));
    let (a, b) = (
        measures(&one, &mapped(&one, narrow)),
        measures(&whole, &mapped(&whole, narrow)),
    );
    assert_eq!(b.asymmetry, Asymmetry::default());
    assert!((a.outer_radius_min - b.outer_radius_min).abs() < 1e-5);
    let off = a.max_wall_angle_deg - b.max_wall_angle_deg;
    assert!(off.abs() < 1e-2, "{off}");
    assert_eq!((a.z_at_min, a.shape, a.side), (b.z_at_min, b.shape, b.side));
}

#[test]
fn a_shear_that_moves_the_axis_out_of_the_lumen_keeps_the_radius() {
    // The meridians have the angle atan ½.
    let whole = tube(24);
    let (sin, cos) = 0.7_f64.sin_cos();
    let u = mapped(&whole, |[z, x, y]| {
        [z, x + 0.5 * z * cos, y + 0.5 * z * sin]
    });
    let found = measures(&whole, &u);
    let Asymmetry {
        amplitude,
        harmonic,
        crest,
    } = found.asymmetry;
    assert_eq!(harmonic, 1);
    assert!((amplitude - 1.5).abs() < 1e-6, "{amplitude}");
    assert!((crest - 0.7).abs() < 1e-6, "{crest}");
    assert!((found.max_wall_angle_deg - 0.5_f64.atan().to_degrees()).abs() < 1e-4);
    let off = found.outer_radius_min - 0.5;
    assert!(off.abs() < 2e-5, "{off}");
    assert_eq!((found.overhang, found.side), (0.0, Side::None));
    // Sections across the inclined axis are ovals.
    let width = 0.88 * 0.5_f64.atan().cos();
    assert!((found.lumen / width - 1.0).abs() < 2e-3, "{}", found.lumen);
    // The meridian at the trough passes straight through the axis.
    let rest = whole.tube.rest();
    let meridians = Meridians::of(&whole, &rest, &u);
    let trough = found.asymmetry.crest_and_trough()[1];
    let wall = &meridians.walls(super::Face::Outer, &[trough], &[0.5, 2.5])[0];
    for &(z, radius) in &wall.points {
        assert!((radius - (0.5 - 0.5 * z)).abs() < 2e-5, "{wall:?}");
    }
}

#[test]
fn a_rotation_about_a_transverse_axis_is_a_mode_of_one_wave() {
    let (sin, cos) = 0.3_f64.sin_cos();
    let whole = tube(24);
    let u = mapped(&whole, |[z, x, y]| {
        [z * cos - x * sin, z * sin + x * cos, y]
    });
    let found = measures(&whole, &u);
    assert_eq!(found.asymmetry.harmonic, 1);
    assert!(found.asymmetry.crest.abs() < 1e-6);
    // At the far end the amplitudes are 3 sin β across and ½ sin β along the axis.
    let expected = 3.0_f64.hypot(0.5) * sin;
    assert!((found.asymmetry.amplitude - expected).abs() < 1e-5);
    assert!((found.max_wall_angle_deg - 0.3_f64.to_degrees()).abs() < 1e-4);
    assert!((found.lumen - 0.88).abs() < 1e-4, "{}", found.lumen);
}

#[test]
fn the_smallest_radius_of_an_oval_is_its_short_axis_at_any_phase() {
    let whole = tube(24);
    for phase in [0.0, 0.4, -1.2] {
        // Longer by a fifth in the direction of the phase, shorter by a fifth across.
        let u = mapped(&whole, |at| {
            let [z, x, y] = narrow(at);
            let turned = phase + 0.5 * z;
            let (s, c) = turned.sin_cos();
            let (long, short) = (1.2 * (x * c + y * s), 0.8 * (y * c - x * s));
            [z, long * c - short * s, long * s + short * c]
        });
        let round = measures(&whole, &mapped(&whole, narrow));
        let found = measures(&whole, &u);
        let expected = 0.8 * round.outer_radius_min;
        assert_eq!(found.asymmetry.harmonic, 2);
        assert!((found.asymmetry.crest - phase).abs() < 1e-3, "{found:?}");
        assert!(
            (found.asymmetry.amplitude / 0.1 - 1.0).abs() < 1e-3,
            "{found:?}"
        );
        assert!(
            (found.outer_radius_min / expected - 1.0).abs() < 1e-3,
            "{found:?}"
        );
        let open = found.lumen / (0.8 * round.lumen) - 1.0;
        assert!(open.abs() < 1e-3 && round.lumen > 0.3, "{found:?}");
    }
}

#[test]
fn the_asymmetry_of_a_sector_is_a_multiple_of_its_repeats() {
    let sector = tube(8);
    let u = mapped(&sector, |[z, x, y]| {
        let scale = 1.0 + 0.02 * (3.0 * y.atan2(x)).cos();
        [z, scale * x, scale * y]
    });
    let measured = measures(&sector, &u);
    let found = measured.asymmetry;
    assert_eq!(found.harmonic, 3);
    // e^{iφ} cos 3φ is the sum of waves 4 and 2, each scaled by the splines.
    let scale = |turns| sector.sector.control_wave(1) / sector.sector.control_wave(turns);
    let expected = 0.01 * 0.5 * (scale(4) + scale(2));
    // The width is that of the circle through the three troughs, inside the section.
    let inscribed = 0.88 * (1.0 - 0.01 * (scale(4) + scale(2)));
    assert!(
        (measured.lumen / inscribed - 1.0).abs() < 1e-4,
        "{measured:?} {inscribed}"
    );
    let off = found.amplitude / expected - 1.0;
    assert!(
        off.abs() < 0.01 && found.crest.abs() < 1e-6,
        "{found:?}, off by {off}"
    );
}

#[test]
fn walls_that_have_passed_through_each_other_have_a_negative_lumen() {
    let whole = tube(24);
    let flat = |short: f64| {
        let u = mapped(&whole, |[z, x, y]| [z, 1.4 * x, short * y]);
        measures(&whole, &u).lumen
    };
    let (open, crossed) = (flat(0.1), flat(-0.1));
    assert!((open - 0.088).abs() < 1e-4, "{open}");
    assert!((crossed + 0.088).abs() < 1e-4, "{crossed}");
}

/// Returns the tube with cross-sections R (e^{iφ} + b e^{4iφ} + c e^{−2iφ}), R the reference radius, as a sector.
fn lobed(b: f64, c: f64) -> (SplineTube, Vec<f64>) {
    let sector = tube(8);
    // The splines scale every wave.
    let scale = |turns| sector.sector.control_wave(turns) / sector.sector.control_wave(1);
    let (b, c) = (b * scale(4), c * scale(2));
    let u = mapped(&sector, |[z, x, y]| {
        let (r, phi) = (x.hypot(y), y.atan2(x));
        let wave = |size: f64, n: f64| [size * (n * phi).cos(), size * (n * phi).sin()];
        let [one, four, two] = [wave(r, 1.0), wave(b * r, 4.0), wave(c * r, -2.0)];
        [z, one[0] + four[0] + two[0], one[1] + four[1] + two[1]]
    });
    (sector, u)
}

/// Returns the gap of the inner face's cross-section, from all pairs of its points, and how often it crosses itself.
fn gap_of_section((tube, u): &(SplineTube, Vec<f64>)) -> (f64, usize) {
    const POINTS: usize = 1200;
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / POINTS as f64;
    let at = |i: usize| {
        let (z, radius, angle) = (1.5, tube.tube.inner_radius(), angle(i % POINTS));
        let [_, x, y] = tube
            .sample(
                &tube.tube.rest(),
                u,
                crate::assembly::Point { z, radius, angle },
            )
            .position;
        (x, y)
    };
    let points: Vec<(f64, f64)> = (0..=POINTS).map(at).collect();
    let distance = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1);
    let mut along = vec![0.0];
    for p in points.windows(2) {
        along.push(along[along.len() - 1] + distance(p[0], p[1]));
    }
    let turn = |a: (f64, f64), b: (f64, f64), c: (f64, f64)| {
        (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
    };
    let separates = |a, b, c, d| turn(a, b, c) * turn(a, b, d) < 0.0;
    let (mut gap, mut crossings) = (f64::INFINITY, 0);
    for i in 0..POINTS {
        for j in i + 2..POINTS {
            let (a, b, c, d) = (points[i], points[i + 1], points[j], points[j + 1]);
            crossings += usize::from(separates(a, b, c, d) && separates(c, d, a, b));
            let apart = along[j] - along[i];
            let apart = apart.min(along[POINTS] - apart);
            let far = distance(a, c);
            if apart >= tube.tube.thickness.max(2.0 * far) {
                gap = gap.min(far);
            }
        }
    }
    (gap, crossings)
}

/// b, c, and whether the cross-section crosses itself.
const LOBES: [(f64, f64, bool); 5] = [
    (0.3, 0.6, false),
    (0.4, 0.55, false),
    (0.38, 0.6, false),
    (0.42, 0.6, true),
    (0.4, 0.1, true),
];

#[test]
fn lobes_that_nearly_meet_have_their_distance_as_gap_and_lobes_that_cross_none() {
    for (b, c, crosses) in LOBES {
        let state = lobed(b, c);
        let (gap, crossings) = gap_of_section(&state);
        assert_eq!(crossings > 0, crosses, "{b} {c}");
        let found = measures(&state.0, &state.1);
        if crosses {
            assert_eq!(found.gap, 0.0, "{b} {c}: {gap}");
        } else {
            assert!(
                (found.gap - gap).abs() < 0.02 * gap + 5e-4,
                "{b} {c}: {} {gap}",
                found.gap
            );
        }
    }
}

#[test]
fn the_lumen_of_three_lobes_is_the_inscribed_circle_until_they_meet() {
    for (b, c, expected) in [(0.3, 0.6, 0.088), (0.38, 0.6, 0.0176), (0.42, 0.6, 0.0)] {
        let (tube, u) = lobed(b, c);
        let lumen = measures(&tube, &u).lumen;
        // The control points of the fourth wave also have a wave of −20 turns, 0.2⁴ times as large.
        let aliased = 0.88 * b * 0.2_f64.powi(4);
        assert!((lumen - expected).abs() < 2.0 * aliased, "{b} {c}: {lumen}");
        assert_eq!(lumen <= 0.0, expected == 0.0);
    }
    // Neighbouring lobes that touch leave the lumen open.
    let (tube, u) = lobed(0.4, 0.1);
    assert!(measures(&tube, &u).lumen > 0.3);
}
