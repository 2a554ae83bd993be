use super::*;
use crate::study::fixture::short;
use crate::tube::{Mesh, Tube};

/// Returns a tube of 43 × 12 × 4 cubic control points, and a state whose outer face has a narrow hairpin.
pub(super) fn hairpin(gap: f64) -> (SplineTube, Vec<f64>) {
    let mesh = Mesh {
        axial: 43,
        around: 12,
        thickness: 4,
        degree: 3,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    };
    let tube = SplineTube::new(
        &Tube {
            length: 3.0,
            ..short()
        },
        &mesh,
        1,
    );
    // The face runs forward, back a little lower, and forward again lower still; the inner face runs likewise.
    let length = tube.tube.length;
    let u = tube.control_values_from(|z, radius, _| {
        let s = 3.0 * z / length;
        let way = if s < 1.0 {
            [s, 0.0]
        } else if s < 2.0 {
            [2.0 - s, -(1.0 + 0.3 * (s - 1.0)) * gap]
        } else {
            [s - 2.0, -2.3 * gap]
        };
        let wave = 0.1 * gap * (5.0 * z).sin();
        [way[0] - z, way[1] + wave + 0.3 * (0.5 - radius), 0.0]
    });
    (tube, u)
}

/// Returns `u` with every unknown but the circumferential ones moved along a wave.
pub(super) fn moved(u: &[f64], step: f64) -> Vec<f64> {
    let wave = |i: usize| {
        if i % 3 == 2 {
            0.0
        } else {
            (1.3 * i as f64 + 0.2 * (i % 7) as f64).sin()
        }
    };
    u.iter()
        .enumerate()
        .map(|(i, u)| u + step * wave(i))
        .collect()
}

pub(super) fn contact(tube: &SplineTube) -> MeridianContact {
    MeridianContact::new(tube).with_range(0.02)
}

#[test]
fn a_tube_at_rest_and_a_narrowed_tube_touch_nowhere() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    let rest = vec![0.0; u.len()];
    assert!(contact.at(&rest).is_empty());
    let narrow = tube.control_values_from(|z, _, _| {
        let w = z - 0.5 * tube.tube.length;
        [0.0, -0.3 * (-30.0 * w * w).exp(), 0.0]
    });
    assert!(contact.at(&narrow).is_empty());
    assert_eq!(contact.crossing(&narrow), None);
}

#[test]
fn forces_are_the_derivative_of_the_energy() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    let energy = |t: f64| {
        let u = moved(&u, t);
        contact
            .add_forces(&contact.at(&u), &mut vec![0.0; u.len()])
            .energy
    };
    assert!(energy(0.0) > 0.0);
    let mut residual = vec![0.0; u.len()];
    contact.add_forces(&contact.at(&u), &mut residual);
    let direction = moved(&vec![0.0; u.len()], 1.0);
    let slope: f64 = residual.iter().zip(&direction).map(|(r, d)| r * d).sum();
    let error = |h: f64| ((energy(h) - energy(-h)) / (2.0 * h) - slope).abs() / slope.abs();
    let order = (error(2e-4) / error(1e-4)).log2();
    assert!((order - 2.0).abs() < 0.2, "order {order}");
    assert!(error(1e-5) < 1e-5, "{}", error(1e-5));
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    let residual = |t: f64| {
        let u = moved(&u, t);
        let mut residual = vec![0.0; u.len()];
        contact.add_forces(&contact.at(&u), &mut residual);
        residual
    };
    let direction = moved(&vec![0.0; u.len()], 1.0);
    let mut product = vec![0.0; u.len()];
    contact.add_tangent(&contact.at(&u), 0, |i, j, value| {
        assert!(i >= j);
        product[i] += value * direction[j];
        if i != j {
            product[j] += value * direction[i];
        }
    });
    let size = product.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    let error = |h: f64| {
        let (low, high) = (residual(-h), residual(h));
        let pairs = low.iter().zip(&high).zip(&product);
        let errors = pairs.map(|((low, high), p)| ((high - low) / (2.0 * h) - p).abs());
        errors.fold(0.0, f64::max) / size
    };
    let order = (error(2e-5) / error(1e-5)).log2();
    assert!((order - 2.0).abs() < 0.2, "order {order}");
    assert!(error(1e-6) < 1e-5, "{}", error(1e-6));
}

#[test]
fn forces_of_both_sides_balance() {
    let (tube, u) = hairpin(0.01);
    let mut residual = vec![0.0; u.len()];
    contact(&tube).add_forces(&contact(&tube).at(&u), &mut residual);
    for i in 0..2 {
        let components = residual.iter().skip(i).step_by(3);
        let (sum, size) = components.fold((0.0, 0.0), |(sum, size), r| (sum + r, size + r.abs()));
        assert!(
            size > 0.0 && f64::abs(sum) < 1e-12 * size,
            "{i}: {sum} of {size}"
        );
    }
}

#[test]
fn flanks_press_with_the_slope_of_the_barrier() {
    // Flat flanks at the gap g feel the pressure −b′(g) on their area at rest.
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    let report = contact.report(&tube, &tube.tube.rest(), &u);
    let outer = report.faces[0].unwrap();
    assert!(report.energy > 0.0 && outer.force > 0.0);
    let pressure = |gap: f64| -contact.barrier().at(gap).slope;
    let mean = 2.0 * outer.force / outer.area;
    assert!(
        pressure(0.02) < mean && mean < pressure(outer.gap),
        "{outer:?}"
    );
}

#[test]
fn pressures_carry_the_forces_of_the_flanks() {
    // ∫ p da over one flank is the force between both; over all points it counts twice. Both flanks are curved.
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    let pressed = contact.pressed_points(&u, Face::Outer);
    let carried: f64 = pressed
        .iter()
        .map(|point| point.pressure * point.area)
        .sum();
    let report = contact.report(&tube, &tube.tube.rest(), &u);
    let force = report.faces[0].unwrap().force;
    assert!(
        (carried / (2.0 * force) - 1.0).abs() < 0.02,
        "{carried} {force}"
    );
}

#[test]
fn a_step_through_a_flank_is_cut_short_and_a_crossing_is_named() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    assert_eq!(contact.crossing(&u), None);
    let (_, wide) = hairpin(-0.01);
    let step: Vec<f64> = u.iter().zip(&wide).map(|(a, b)| b - a).collect();
    let part = contact.longest_step(&u, &step);
    assert!(part > 0.2 && part < 0.5, "{part}");
    let after: Vec<f64> = u.iter().zip(&step).map(|(u, s)| u + part * s).collect();
    assert_eq!(contact.crossing(&after), None);
}

#[test]
fn the_tangent_of_a_mode_is_the_second_derivative_of_the_energy_of_its_wave() {
    // At each angle the distance between waved faces is found by brute force; the energy is averaged around.
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube);
    // Every thirty-first pair, which is what the energy below sums up.
    let mut pairs = contact.at(&u);
    for pairs in &mut pairs.0 {
        *pairs = pairs.iter().step_by(31).copied().collect();
    }
    let direction: Vec<f64> = (0..u.len())
        .map(|i| 1e-3 * (0.9 * i as f64).sin())
        .collect();
    for mode in 1..=3 {
        let mut quadratic = 0.0;
        contact.add_tangent(&pairs, mode, |i, j, value| {
            let both = if i == j { 1.0 } else { 2.0 };
            quadratic += both * value * direction[i] * direction[j];
        });
        let energy = |t: f64| wave::energy(&contact, &pairs, &direction, mode, t);
        // E(t) = E₀ + ½ (cos² + sin² parts)/2 t²: the mode's scale is twice the average around.
        let second = |h: f64| (energy(h) - 2.0 * energy(0.0) + energy(-h)) / (h * h);
        let found = 2.0 * second(0.02);
        assert!(
            (found - quadratic).abs() < 2e-3 * quadratic.abs(),
            "{mode}: {found} {quadratic}"
        );
    }
}

/// The energy of contact of a face with a circumferential wave, from three-dimensional distances.
mod wave {
    use super::super::bezier::Point;
    use super::super::curve::FaceCurve;
    use super::super::{MeridianContact, MeridianPairs};
    use crate::contact::bernstein::MAX_POINTS;
    use std::f64::consts::TAU;

    /// Angles around the tube at which the energy is evaluated.
    const ANGLES: usize = 8;

    /// A wave on a face: its curve at rest of the wave, and the amplitudes (z, r, θ) of its displacement.
    struct Waved<'a> {
        face: &'a FaceCurve,
        direction: &'a [f64],
        mode: usize,
        size: f64,
    }

    impl Waved<'_> {
        /// Returns the displaced position (z, x, y) of a place of an element at the angle φ.
        fn at(
            &self,
            element: usize,
            position: Point,
            values: &[f64; MAX_POINTS],
            phi: f64,
        ) -> [f64; 3] {
            let amplitudes = self.face.amplitudes(self.mode);
            let mut d = [0.0; 3];
            for (first, value) in self.face.unknowns(element).zip(values) {
                for (i, amplitude) in amplitudes.iter().enumerate() {
                    for (d, a) in d.iter_mut().zip(amplitude) {
                        *d += self.size * value * self.direction[first + i] * a;
                    }
                }
            }
            let (sin, cos) = (self.mode as f64 * phi).sin_cos();
            let (z, r, theta) = (
                position[0] + d[0] * cos,
                position[1] + d[1] * cos,
                -d[2] * sin,
            );
            [
                z,
                r * phi.cos() - theta * phi.sin(),
                r * phi.sin() + theta * phi.cos(),
            ]
        }
    }

    /// Returns the energy of the pairs of a state, of one sector, averaged around the tube.
    pub fn energy(
        contact: &MeridianContact,
        pairs: &MeridianPairs,
        direction: &[f64],
        mode: usize,
        size: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for ((face, _), pairs) in contact.faces.iter().zip(&pairs.0) {
            let curves = face.curves(&super::hairpin(0.01).1);
            let waved = Waved {
                face,
                direction,
                mode,
                size,
            };
            for pair in pairs {
                let x = curves[pair.x.0].at(pair.places[0]).position;
                for i in 0..ANGLES {
                    let phi = TAU * (i as f64 + 0.3) / ANGLES as f64;
                    let x = waved.at(pair.x.0, x, &pair.x.1, phi);
                    let distance = |eta: f64, psi: f64| {
                        let values = face.functions(pair.y.0, eta)[0];
                        let position = curves[pair.y.0].at(eta).position;
                        let y = waved.at(pair.y.0, position, &values, phi + psi);
                        (0..3).map(|i| (x[i] - y[i]).powi(2)).sum::<f64>().sqrt()
                    };
                    let gap = nearest(distance, pair.places[1]);
                    let barrier = contact.barrier().at(gap);
                    sum += 0.5 * pair.area * barrier.value / ANGLES as f64;
                }
            }
        }
        sum
    }

    /// Minimises a function of (η, ψ) near (η₀, 0) by Newton's method with differences.
    fn nearest(f: impl Fn(f64, f64) -> f64, eta: f64) -> f64 {
        let square = |x: f64, y: f64| 0.5 * f(x, y).powi(2);
        let (mut x, mut y, h) = (eta, 0.0, 1e-4);
        for _ in 0..8 {
            let c = square(x, y);
            let [e, w, n, s] =
                [(h, 0.0), (-h, 0.0), (0.0, h), (0.0, -h)].map(|(dx, dy)| square(x + dx, y + dy));
            let cross = (square(x + h, y + h) - square(x + h, y - h) - square(x - h, y + h)
                + square(x - h, y - h))
                / (4.0 * h * h);
            let (gx, gy) = ((e - w) / (2.0 * h), (n - s) / (2.0 * h));
            let (xx, yy) = ((e - 2.0 * c + w) / (h * h), (n - 2.0 * c + s) / (h * h));
            let det = xx * yy - cross * cross;
            x -= (yy * gx - cross * gy) / det;
            y -= (xx * gy - cross * gx) / det;
        }
        f(x, y)
    }
}
