//! The mass matrix of a circumferential harmonic.

use crate::assembly::SplineTube;
use crate::matrix::BlockBanded;
use crate::rings::{Rotation, Sector};
use crate::spline::{Basis, gauss_legendre};

/// The mass matrix ∫ N N dV₀ (unit density, reference volume) of harmonic n of an axisymmetric
/// tube: of the displacements (z cos nφ, r cos nφ, −θ sin nφ), scaled as
/// [`SplineTube::tangent_in_harmonic`] is for n ≥ 1 and [`SplineTube::tangent`] for n = 0.
///
/// A form of harmonic n is N_C/2 times that of the two halves of [`Sector::harmonic_at`] on one
/// element, added up, and the tangent's block is given without the N_C/2; so is this. Harmonic 0
/// is N_C times one element, and its tangent is given without the N_C. Eigenvalues of the pair are
/// therefore those of the whole tube's tangent and mass. In the integral, dV₀ = (C × C′) dζ R dR ds
/// parts into a factor along the tube, one through the wall and one around it.
pub fn harmonic_mass(tube: &SplineTube, n: usize) -> BlockBanded {
    let along = overlaps(&tube.axial, |_| 1.0);
    let through = overlaps(&tube.wall, |radius| radius);
    let around = around(tube, n);
    let (p, points) = (tube.degree(), tube.wall.functions());
    let mut matrix = BlockBanded::zeros(tube.axial.functions(), 3 * points, p);
    let mut entries = vec![];
    for c in 0..points {
        for e in 0..points {
            let overlap = through[c.min(e)].get(c.abs_diff(e)).unwrap_or(&0.0);
            for i in 0..3 {
                for k in 0..3 {
                    entries.push((3 * c + i, 3 * e + k, overlap * around[i][k]));
                }
            }
        }
    }
    for d in 0..=p {
        let place = |&(row, column, entry)| (matrix.place(d, row, column), entry);
        let placed: Vec<(usize, f64)> = entries.iter().map(place).collect();
        for (panel, along) in matrix.panels_mut().zip(&along) {
            for &(place, entry) in &placed {
                panel[place] = along[d] * entry;
            }
        }
    }
    matrix
}

/// ∫ N_a N_b weight(x) dx of the functions of a basis, for every b those with a = b, b + 1, …, b + p.
fn overlaps(basis: &Basis, weight: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
    let mut overlaps = vec![vec![0.0; basis.degree() + 1]; basis.functions()];
    for element in 0..basis.elements() {
        let (from, to) = basis.element(element);
        for (s, w) in gauss_legendre(basis.degree() + 1) {
            let x = from + (to - from) * s;
            let value = basis.evaluate_in(element, x).value;
            for b in 0..value.len() {
                for a in b..value.len() {
                    let product = value[a] * value[b];
                    overlaps[element + b][a - b] += w * (to - from) * weight(x) * product;
                }
            }
        }
    }
    overlaps
}

/// ∫ Tᵀ T (C × C′) ds over one element, T what turns (axial, radial, circumferential) into the
/// displacement; halves added up.
fn around(tube: &SplineTube, n: usize) -> [[f64; 3]; 3] {
    let one = Sector::new(tube.degree(), tube.sector.around, 1);
    let mut sum = [[0.0; 3]; 3];
    for (s, w) in gauss_legendre(tube.degree() + 1) {
        let slot = one.at(s)[0];
        let [(x, y), (dx, dy)] = slot.rotated;
        let area = w * tube.circle.control_radius.powi(2) * (x * dy - y * dx);
        let halves = match n {
            0 => vec![Rotation::from(&slot)],
            n => one.harmonic_at(n, s).to_vec(),
        };
        for half in halves {
            let [[a, b, c, d], _] = half.plane;
            let turn = [[half.axial[0], 0.0, 0.0], [0.0, a, b], [0.0, c, d]];
            for i in 0..3 {
                for k in 0..3 {
                    let product: f64 = turn.iter().map(|row| row[i] * row[k]).sum();
                    sum[i][k] += area * product;
                }
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Mesh, Support, Tube};

    fn tube(rings: usize) -> SplineTube {
        let tube = Tube {
            length: 1.3,
            thickness: 0.1,
            material: Material::NeoHookean(NeoHookean::new(1.0, 0.3)),
            muscles: vec![],
            imperfections: vec![],
            ends: [Support::Fixed; 2],
        };
        let mesh = Mesh {
            axial: 7,
            around: 10,
            thickness: 5,
            degree: 3,
            refinements: vec![],
            volumetric: Default::default(),
        };
        SplineTube::new(&tube, &mesh, rings)
    }

    #[test]
    fn harmonic_zero_is_the_drag_matrix() {
        let tube = tube(1);
        let (mass, damping) = (harmonic_mass(&tube, 0), tube.damping());
        for i in 0..mass.unknowns() {
            for j in 0..=i {
                assert!(
                    (mass.entry(i, j) - damping.entry(i, j)).abs() < 1e-15,
                    "{i}, {j}"
                );
            }
        }
    }

    #[test]
    fn a_harmonic_weighs_what_the_whole_tube_does() {
        let (one, whole) = (tube(1), tube(10));
        let x: Vec<f64> = (0..one.unknowns())
            .map(|i| (i as f64 * 0.7).sin())
            .collect();
        let damping = whole.damping();
        for n in 1..=4 {
            let mut y = vec![0.0; whole.unknowns()];
            for (i, x) in x.iter().enumerate() {
                for ring in 0..10 {
                    let wave = n as f64 * whole.sector.ring_angle(ring);
                    let factor = if i % 3 == 2 { -wave.sin() } else { wave.cos() };
                    y[10 * i + ring] = factor * x;
                }
            }
            let form = |m: &BlockBanded, x: &[f64]| {
                let mut product = vec![0.0; x.len()];
                m.multiply_add(1.0, x, &mut product);
                product.iter().zip(x).map(|(a, b)| a * b).sum::<f64>()
            };
            let (weight, expected) = (form(&harmonic_mass(&one, n), &x), form(&damping, &y));
            assert!(
                (5.0 * weight / expected - 1.0).abs() < 1e-13,
                "{n}: {weight}, {expected}"
            );
        }
    }
}
