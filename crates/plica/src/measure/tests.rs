//! Tilted, shifted, oval and twisted tubes, whose measures are known.

use super::{Asymmetry, Measures, Meridians, Side};
use crate::assembly::SplineTube;
use crate::material::{Material, NeoHookean};
use crate::tube::{Mesh, Support, Tube};

/// A long tube of `rings` rings of 24, which draw a circle to 1.2e-5.
fn tube(rings: usize) -> SplineTube {
    let tube = Tube {
        length: 3.0,
        thickness: 0.06,
        material: Material::NeoHookean(NeoHookean::new(1.0, 0.3)),
        muscles: vec![],
        ends: [Support::Free; 2],
        imperfections: vec![],
    };
    let mesh = Mesh {
        axial: 15,
        around: 24,
        thickness: 4,
        degree: 3,
        refinements: vec![],
        volumetric: Default::default(),
    };
    SplineTube::new(&tube, &mesh, rings)
}

/// Unknowns that take every control point at (z, x, y) where a map says.
fn moved(tube: &SplineTube, to: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
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

/// A narrow place in the middle, and a turn about the axis that grows along it.
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
fn a_tube_that_is_round_has_the_measures_of_one_ring_though_it_twists() {
    let (one, whole) = (tube(1), tube(24));
    let (a, b) = (
        measures(&one, &moved(&one, narrow)),
        measures(&whole, &moved(&whole, narrow)),
    );
    assert_eq!(b.asymmetry, Asymmetry::default());
    assert!((a.outer_radius_min - b.outer_radius_min).abs() < 1e-5);
    let off = a.max_wall_angle_deg - b.max_wall_angle_deg;
    assert!(off.abs() < 1e-2, "{off}");
    assert_eq!((a.z_at_min, a.shape, a.side), (b.z_at_min, b.shape, b.side));
}

#[test]
fn a_shift_that_takes_the_axis_out_of_the_lumen_bends_no_wall_and_narrows_nothing() {
    // Half a diameter sideways for every diameter along: the meridians lean by atan ½.
    let whole = tube(24);
    let (sin, cos) = 0.7_f64.sin_cos();
    let u = moved(&whole, |[z, x, y]| {
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
    assert!((found.lumen - 0.88).abs() < 4e-5, "{}", found.lumen);
    // The meridian on the lee side goes through the axis as straight as it came.
    let rest = whole.tube.rest();
    let meridians = Meridians::of(&whole, &rest, &u);
    let lee = found.asymmetry.crest_and_trough()[1];
    let wall = &meridians.walls(super::Face::Outer, &[lee], &[0.5, 2.5])[0];
    for &(z, radius) in &wall.points {
        assert!((radius - (0.5 - 0.5 * z)).abs() < 2e-5, "{wall:?}");
    }
}

#[test]
fn a_tube_turned_about_an_axis_across_it_leans_by_that_angle() {
    let (sin, cos) = 0.3_f64.sin_cos();
    let whole = tube(24);
    let u = moved(&whole, |[z, x, y]| {
        [z * cos - x * sin, z * sin + x * cos, y]
    });
    let found = measures(&whole, &u);
    assert_eq!(found.asymmetry.harmonic, 1);
    assert!(found.asymmetry.crest.abs() < 1e-6);
    // At its far end: 3 sin β sideways, ½ sin β along.
    let expected = 3.0_f64.hypot(0.5) * sin;
    assert!((found.asymmetry.amplitude - expected).abs() < 1e-5);
    assert!((found.max_wall_angle_deg - 0.3_f64.to_degrees()).abs() < 1e-4);
}

#[test]
fn an_oval_is_as_narrow_as_its_short_axis_wherever_that_points() {
    let whole = tube(24);
    for phase in [0.0, 0.4, -1.2] {
        // Longer along the phase by a fifth, shorter across.
        let u = moved(&whole, |at| {
            let [z, x, y] = narrow(at);
            let turned = phase + 0.5 * z;
            let (s, c) = turned.sin_cos();
            let (long, short) = (1.2 * (x * c + y * s), 0.8 * (y * c - x * s));
            [z, long * c - short * s, long * s + short * c]
        });
        let round = measures(&whole, &moved(&whole, narrow));
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
fn departures_of_a_fold_are_its_harmonics() {
    let fold = tube(8);
    let u = moved(&fold, |[z, x, y]| {
        let scale = 1.0 + 0.02 * (3.0 * y.atan2(x)).cos();
        [z, scale * x, scale * y]
    });
    let measured = measures(&fold, &u);
    // A crest lies across from a trough: nowhere is it narrower than a round one, but for what waves of the second
    // order and a polygon of 24 make of it.
    assert!((measured.lumen / 0.88 - 1.0).abs() < 1e-3, "{measured:?}");
    let found = measured.asymmetry;
    assert_eq!(found.harmonic, 3);
    // e^{iφ} cos 3φ: waves of four turns and of two, flattened as the splines draw them.
    let drawn = |turns| fold.sector.control_wave(1) / fold.sector.control_wave(turns);
    let expected = 0.01 * 0.5 * (drawn(4) + drawn(2));
    let off = found.amplitude / expected - 1.0;
    assert!(
        off.abs() < 0.01 && found.crest.abs() < 1e-6,
        "{found:?}, off by {off}"
    );
}

#[test]
fn walls_that_have_passed_through_each_other_leave_a_lumen_of_negative_width() {
    let whole = tube(24);
    let flat = |short: f64| {
        let u = moved(&whole, |[z, x, y]| [z, 1.4 * x, short * y]);
        measures(&whole, &u).lumen
    };
    let (open, crossed) = (flat(0.1), flat(-0.1));
    assert!((open - 0.088).abs() < 1e-4, "{open}");
    assert!((crossed + 0.088).abs() < 1e-4, "{crossed}");
}
