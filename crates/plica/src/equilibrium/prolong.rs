//! Transfer of a state to another mesh and symmetry.

use crate::assembly::SplineTube;
use crate::rings::Sector;
use crate::spline::transfer;
use std::f64::consts::TAU;

/// Returns the unknowns on `to` of the displacements with the unknowns `u` on `from`, for two meshes and symmetries of one
/// tube. The symmetry of `to` must be that of `from` or a lower one.
///
/// The new spline interpolates the old one at Greville points along the tube and through the wall, and at the angles of
/// the rings around it. If the new mesh only adds knots, the displacements are the same everywhere. With the
/// same degree and number of rings, the displacements of every ring are the same to the bit.
pub fn prolong(from: &SplineTube, to: &SplineTube, u: &[f64]) -> Vec<f64> {
    assert_eq!(u.len(), from.unknowns());
    let (old, new) = (from.sector.rings, to.sector.rings);
    let along = transfer(&from.axial, &to.axial, u, from.row_size());
    let rows = along.chunks_exact(from.row_size());
    let through = rows.flat_map(|row| transfer(&from.wall, &to.wall, row, 3 * old));
    let through: Vec<f64> = through.collect();
    let around = Around::new(&from.sector, from.degree(), &to.sector, to.degree());
    let mut prolonged = vec![0.0; to.unknowns()];
    for (u, point) in prolonged
        .chunks_exact_mut(3 * new)
        .zip(through.chunks_exact(3 * old))
    {
        around.apply(point, u);
    }
    prolonged
}

/// Transfer from the rings of one cyclic sector to those of another.
enum Around {
    /// Every new ring has the displacements of one old ring.
    Same,
    /// Weights of the old rings for every new ring: of the axial component, and of u_r + i u_θ.
    Weights(Vec<Vec<(f64, Complex)>>),
}

type Complex = (f64, f64);

impl Around {
    fn new(from: &Sector, from_degree: usize, to: &Sector, to_degree: usize) -> Self {
        if from.around == to.around && from_degree == to_degree {
            return Self::Same;
        }
        // N(new ring i at the angle of ring j), which depends on i − j alone, and its inverse.
        let k = to.rings;
        let row = at_angle(to, to.ring_angle(0));
        let axial = inverse(&row.iter().map(|(a, _)| (*a, 0.0)).collect::<Vec<_>>());
        let turned = inverse(&row.iter().map(|(_, t)| *t).collect::<Vec<_>>());
        let old: Vec<_> = (0..k).map(|j| at_angle(from, to.ring_angle(j))).collect();
        let weights = |j: usize| {
            let mut sum = vec![(0.0, (0.0, 0.0)); from.rings];
            for d in 0..k {
                for (sum, old) in sum.iter_mut().zip(&old[(j + d) % k]) {
                    sum.0 += axial[d].0 * old.0;
                    let product = times(turned[d], old.1);
                    sum.1 = (sum.1.0 + product.0, sum.1.1 + product.1);
                }
            }
            sum
        };
        Self::Weights((0..k).map(weights).collect())
    }

    /// Transfers the components of one point of the cross-section, ring by ring.
    fn apply(&self, old: &[f64], new: &mut [f64]) {
        let (m, k) = (old.len() / 3, new.len() / 3);
        for j in 0..k {
            let [z, r, t] = match self {
                Self::Same => [0, 1, 2].map(|i| old[i * m + j % m]),
                Self::Weights(weights) => {
                    let mut sum = [0.0; 3];
                    for (i, (axial, turned)) in weights[j].iter().enumerate() {
                        let plane = times(*turned, (old[m + i], old[2 * m + i]));
                        sum = [sum[0] + axial * old[i], sum[1] + plane.0, sum[2] + plane.1];
                    }
                    sum
                }
            };
            (new[j], new[k + j], new[2 * k + j]) = (z, r, t);
        }
    }
}

/// Returns the weights of the rings of a cyclic sector at an angle: of the axial displacement, and of u_r + i u_θ at
/// that angle.
fn at_angle(sector: &Sector, angle: f64) -> Vec<(f64, Complex)> {
    // Element 0 is centred on angle zero.
    let turns = angle / sector.angle() + 0.5;
    // The angle of a ring is an edge or the middle of an element; rounding must not decide otherwise.
    let turns = if (2.0 * turns - (2.0 * turns).round()).abs() < 1e-9 {
        (2.0 * turns).round() / 2.0
    } else {
        turns
    };
    let (element, s) = (turns.floor(), turns - turns.floor());
    let first = (element as i64).rem_euclid(sector.rings as i64) as usize;
    // Rotates from the frame of the element to that of the angle.
    let (sin, cos) = (element * sector.angle() - angle).sin_cos();
    let mut weights = vec![(0.0, (0.0, 0.0)); sector.rings];
    for (r, slot) in sector.at(s).iter().enumerate() {
        let weight = &mut weights[sector.ring(first, r)];
        let turned = times(slot.rotated[0], (cos, sin));
        weight.0 += slot.axial[0];
        weight.1 = (weight.1.0 + turned.0, weight.1.1 + turned.1);
    }
    weights
}

/// Returns a row of the inverse of a circulant matrix: c with Σ_d c_d w_{j+d} = v_j for
/// w_j = Σ_d a_d v_{j+d}.
fn inverse(a: &[Complex]) -> Vec<Complex> {
    let k = a.len();
    let wave = |n: usize| {
        let (sin, cos) = (TAU * (n % k) as f64 / k as f64).sin_cos();
        (cos, sin)
    };
    let sum = |terms: &mut dyn Iterator<Item = Complex>| {
        terms.fold((0.0, 0.0), |s, x| (s.0 + x.0, s.1 + x.1))
    };
    // Inverts the eigenvalues and transforms back.
    let eigen = |m: usize| {
        let (re, im) = sum(&mut (0..k).map(|d| times(a[d], wave(m * d))));
        let size = re * re + im * im;
        (re / size, -im / size)
    };
    let eigen: Vec<Complex> = (0..k).map(eigen).collect();
    let entry = |d: usize| {
        let (re, im) = sum(&mut (0..k).map(|m| {
            let (cos, sin) = wave(m * d);
            times(eigen[m], (cos, -sin))
        }));
        (re / k as f64, im / k as f64)
    };
    (0..k).map(entry).collect()
}

fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Point;
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Mesh, Support, Tube, WallLayer};

    fn tube() -> Tube {
        Tube {
            length: 1.3,
            thickness: 0.1,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.3,
            )))],
            muscles: vec![],
            imperfections: vec![],
            obstacles: vec![],
            ends: [Support::Free; 2],
            patches: vec![],
            foundations: vec![],
        }
    }

    fn laid([axial, around, thickness]: [usize; 3], degree: usize, rings: usize) -> SplineTube {
        let mesh = Mesh {
            axial: axial + degree,
            around,
            thickness: thickness + degree,
            degree,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        SplineTube::new(&tube(), &mesh, rings)
    }

    fn wavy(tube: &SplineTube) -> Vec<f64> {
        (0..tube.unknowns())
            .map(|i| 0.01 * (i as f64 * 0.7).sin())
            .collect()
    }

    /// Returns control values of smooth waves.
    fn smooth(tube: &SplineTube) -> Vec<f64> {
        let (points, rings) = (tube.wall.functions(), tube.sector.rings);
        let place = |i: usize| {
            let (ring, component) = (i % rings, i / rings % 3);
            let z = tube.axial.greville()[i / rings / 3 / points];
            let phi = tube.sector.ring_angle(ring);
            let wave = if component == 2 {
                (2.0 * phi).sin()
            } else {
                (2.0 * phi).cos()
            };
            0.1 * (2.0 * z).sin() * wave
        };
        (0..tube.unknowns()).map(place).collect()
    }

    /// Returns the largest difference of the displacements at points across the wall.
    fn apart(a: (&SplineTube, &[f64]), b: (&SplineTube, &[f64])) -> f64 {
        let rest = tube().rest();
        let mut most = 0.0_f64;
        for i in 0..400 {
            let part = |n: f64| (f64::from(i) * n).fract();
            let at = Point {
                z: 1.3 * part(0.618),
                radius: 0.4 + 0.1 * part(0.414),
                angle: TAU * part(0.732),
            };
            let moved = |(tube, u): (&SplineTube, &[f64])| {
                let sample = tube.sample(&rest, u, at);
                [0, 1, 2].map(|i| sample.position[i] - sample.reference[i])
            };
            let (a, b) = (moved(a), moved(b));
            let difference = [0, 1, 2].map(|i| (a[i] - b[i]).abs());
            most = difference.into_iter().fold(most, f64::max);
        }
        most
    }

    #[test]
    fn rings_of_a_lower_symmetry_get_the_same_displacements_to_the_bit() {
        let one = laid([4, 12, 2], 3, 1);
        let u = wavy(&one);
        let energy = one.forces(&tube().rest(), &u).unwrap().energy;
        for rings in [2, 3, 12] {
            let fold = laid([4, 12, 2], 3, rings);
            let prolonged = prolong(&one, &fold, &u);
            for (i, x) in prolonged.iter().enumerate() {
                assert_eq!(x.to_bits(), u[i / rings].to_bits());
            }
            let found = fold.forces(&tube().rest(), &prolonged).unwrap().energy;
            assert!((found / energy - 1.0).abs() < 1e-12, "{rings} rings");
        }
        // From a cyclic sector to a multiple of it.
        let (three, six) = (laid([4, 12, 2], 3, 3), laid([4, 12, 2], 3, 6));
        let u = wavy(&three);
        assert!(apart((&three, &u), (&six, &prolong(&three, &six, &u))) < 1e-15);
    }

    #[test]
    fn a_mesh_with_added_knots_has_the_same_displacements_everywhere() {
        for degree in 1..=5 {
            for rings in [1, 4, 12] {
                // Three elements for one around the tube, so that their edges coincide.
                let coarse = laid([4, 12, 2], degree, rings);
                let fine = laid([8, 36, 6], degree, 3 * rings);
                let u = wavy(&coarse);
                let prolonged = prolong(&coarse, &fine, &u);
                let error = apart((&coarse, &u), (&fine, &prolonged));
                assert!(error < 1e-13, "degree {degree}, {rings} rings: {error:e}");
                // The transfer back to the coarse mesh restores the unknowns.
                let back = prolong(&fine, &coarse, &prolonged);
                let error = back.iter().zip(&u).map(|(a, b)| (a - b).abs());
                assert!(error.fold(0.0, f64::max) < 1e-13);
            }
        }
    }

    #[test]
    fn a_mesh_with_added_knots_has_the_same_energy() {
        // The circle is the same, and the strains are so smooth that quadrature is exact to rounding.
        let (coarse, fine) = (laid([16, 12, 3], 4, 6), laid([48, 12, 6], 4, 12));
        let u = smooth(&coarse);
        let rest = tube().rest();
        let energy = |tube: &SplineTube, u: &[f64]| tube.forces(&rest, u).unwrap().energy;
        let (a, b) = (
            energy(&coarse, &u),
            energy(&fine, &prolong(&coarse, &fine, &u)),
        );
        assert!((b / a - 1.0).abs() < 1e-12, "{:e}", b / a - 1.0);
    }

    #[test]
    fn another_degree_with_as_many_control_points_approximates_the_displacements() {
        // Of a smooth state: the numbers of unknowns, rings and points agree, the splines do not.
        for (old, new) in [(2, 3), (3, 2), (3, 4)] {
            let with = |degree: usize| laid([24 - degree, 24, 8 - degree], degree, 24);
            let (from, to) = (with(old), with(new));
            assert_eq!(from.unknowns(), to.unknowns());
            let u = smooth(&from);
            let error = apart((&from, &u), (&to, &prolong(&from, &to, &u)));
            let copied = apart((&from, &u), (&to, &u));
            assert!(error < 1e-3 && error < 0.1 * copied, "{error:e} {copied:e}");
        }
    }

    #[test]
    fn other_meshes_approximate_the_displacements() {
        let fine = laid([60, 60, 3], 3, 60);
        let u = smooth(&fine);
        let error = |n: usize| {
            let other = laid([n, 2 * n, 2], 3, 2 * n);
            apart((&fine, &u), (&other, &prolong(&fine, &other, &u)))
        };
        let (coarse, finer) = (error(7), error(14));
        assert!(
            coarse < 2e-3 && coarse / finer > 12.0,
            "{coarse:e}, {finer:e}"
        );
    }
}
