//! Mass matrix of a circumferential mode.

use crate::assembly::SplineTube;
use crate::matrix::BlockBanded;
use crate::rings::{Rotation, Sector};
use crate::spline::{Basis, gauss_legendre};

/// Assembles the mass matrix ∫ N N dV₀ (unit density, reference volume) of mode n of an axisymmetric tube, for
/// displacements (z cos nφ, r cos nφ, −θ sin nφ).
///
/// Bilinear forms of mode n are N_C/2 times the sum over the two halves of [`Sector::harmonic_at`] on one element;
/// those of mode 0 are N_C times one element. Like `SplineTube::tangent_in_harmonic` and [`SplineTube::tangent`] the
/// matrix omits these factors, so the eigenvalues of the pair are those of the whole tube. The volume element
/// dV₀ = (C × C′) dζ R dR ds factorises into the axial, the radial and the circumferential direction.
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

/// Returns ∫ N_a N_b weight(x) dx for every function b of a basis and a = b, …, b + p.
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
                    overlaps[basis.first(element) + b][a - b] +=
                        w * (to - from) * weight(x) * product;
                }
            }
        }
    }
    overlaps
}

/// Returns ∫ Tᵀ T (C × C′) ds over one element, summed over the halves; T maps the amplitudes (axial, radial,
/// circumferential) to the displacement.
fn around(tube: &SplineTube, n: usize) -> [[f64; 3]; 3] {
    let one = Sector::new(tube.degree(), tube.sector.around, 1);
    let mut sum = [[0.0; 3]; 3];
    for (s, w) in gauss_legendre(tube.degree() + 1) {
        let function = one.at(s)[0];
        let [(x, y), (dx, dy)] = function.rotated;
        let area = w * tube.circle.control_radius.powi(2) * (x * dy - y * dx);
        let halves = match n {
            0 => vec![Rotation::from(&function)],
            n => one.harmonic_at(n, s).to_vec(),
        };
        for half in halves {
            let [[a, b, c, d], _] = half.plane;
            let map = [[half.axial[0], 0.0, 0.0], [0.0, a, b], [0.0, c, d]];
            for i in 0..3 {
                for k in 0..3 {
                    let product: f64 = map.iter().map(|row| row[i] * row[k]).sum();
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
    use crate::tube::{Mesh, Support, Tube, WallLayer};

    fn tube(rings: usize) -> SplineTube {
        let tube = Tube {
            length: 1.3,
            thickness: 0.1,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.3,
            )))],
            muscles: vec![],
            imperfections: vec![],
            obstacles: vec![],
            ends: [Support::Fixed; 2],
            patches: vec![],
            foundations: vec![],
        };
        let mesh = Mesh {
            axial: 7,
            around: 10,
            thickness: 5,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        SplineTube::new(&tube, &mesh, rings)
    }

    #[test]
    fn the_mass_of_mode_zero_is_the_damping_matrix() {
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
    fn the_mass_of_a_mode_is_that_of_the_whole_tube() {
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
            let (mass, expected) = (form(&harmonic_mass(&one, n), &x), form(&damping, &y));
            assert!(
                (5.0 * mass / expected - 1.0).abs() < 1e-13,
                "{n}: {mass}, {expected}"
            );
        }
    }
}
