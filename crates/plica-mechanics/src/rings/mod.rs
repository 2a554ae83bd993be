//! Control rings: cylindrical components, cyclic sectors, and the harmonic solver.
//!
//! The control points lie on N_C control rings that run along the tube, an angle α = 2π/N_C apart.
//! A displacement of ring j has the components (axial, radial, circumferential) *at that ring*, so
//! a rotation of the tube by α only renumbers the rings. A cyclic [`Sector`] of k rings repeats
//! around the tube: ring j + k has the displacement of ring j in its own components. k = 1 is an
//! axisymmetric tube (with twist), k = N_C the whole tube.
//!
//! Every element around the tube is the same element, rotated. In the frame of an element, the
//! complex plane whose real axis points radially outwards at the element's middle, the radial and
//! circumferential components of ring b become (u_r + i u_θ) exp(i φ_b). If a sector has fewer
//! rings than an element has functions, several functions belong to one ring; their values are
//! added here, and kernels see only the *distinct rings* of an element, by local index r.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | N_C | rings around the whole tube | [`Sector::around`] |
//! | k | rings of the sector | [`Sector::rings`] |
//! | α | angle between rings | [`Sector::angle`] |
//! | φ_b | angle of function b from the middle of its element | inside [`Sector::at`] |
//! | g, g' | Σ N_b over the functions of a ring, and its slope | [`RingValues::axial`] |
//! | t, t' | Σ N_b exp(i φ_b), and its slope | [`RingValues::rotated`] |

mod arc;
mod circulant;
mod harmonic_solver;
mod low_harmonic_correction;
mod transform;

pub use arc::shortest_arc;
pub use circulant::Circulant;
pub use harmonic_solver::HarmonicSolver;
pub use low_harmonic_correction::LowHarmonicCorrection;
pub use transform::{HarmonicColumns, Transform};

use crate::spline::{self, Basis};
use std::f64::consts::TAU;

/// A cyclic sector: control rings that repeat around the tube.
#[derive(Clone, Debug)]
pub struct Sector {
    /// N_C: rings around the whole tube.
    pub around: usize,
    /// k: rings of the sector; divides N_C.
    pub rings: usize,
    basis: Basis,
}

/// Basis functions of one of an element's distinct rings at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RingValues {
    /// Factor of the axial component, and its slope along the element.
    pub axial: [f64; 2],
    /// Factor of (u_r + i u_θ) as (real, imaginary), and its slope.
    pub rotated: [(f64, f64); 2],
}

/// Contribution of a ring to the displacement in the element's frame, as a matrix on (axial,
/// radial, circumferential): value and slope along the element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rotation {
    /// Axial from axial.
    pub axial: [f64; 2],
    /// [outwards from radial, outwards from circumferential, around from radial, around from
    /// circumferential].
    pub plane: [[f64; 4]; 2],
}

impl From<&RingValues> for Rotation {
    fn from(ring: &RingValues) -> Self {
        Self {
            axial: ring.axial,
            plane: ring.rotated.map(|(re, im)| [re, -im, im, re]),
        }
    }
}

impl Sector {
    /// Returns a sector of `rings` of the tube's `around` rings, for splines of a degree. Panics
    /// unless `rings` divides `around`.
    pub fn new(degree: usize, around: usize, rings: usize) -> Self {
        assert!(rings >= 1 && around.is_multiple_of(rings));
        Self {
            around,
            rings,
            basis: Basis::uniform_element(degree),
        }
    }

    /// Returns the angle α between rings.
    pub fn angle(&self) -> f64 {
        TAU / self.around as f64
    }

    /// Returns the number of sectors around the tube.
    pub fn repeats(&self) -> f64 {
        (self.around / self.rings) as f64
    }

    /// Returns the number of distinct rings of an element.
    pub fn local_rings(&self) -> usize {
        self.rings.min(self.basis.degree() + 1)
    }

    /// Returns the ring of the sector with local index `r` in element `e`.
    pub fn ring(&self, e: usize, r: usize) -> usize {
        (e + r) % self.rings
    }

    /// Returns the angle of ring `j`; the middle of element 0 is at angle zero.
    pub fn ring_angle(&self, j: usize) -> f64 {
        (j as f64 - 0.5 * self.basis.degree() as f64) * self.angle()
    }

    /// Returns c_n, the amplitude of the control values of a wave of unit amplitude and n periods,
    /// see [`spline::control_wave`].
    pub fn control_wave(&self, n: usize) -> f64 {
        spline::control_wave(self.basis.degree(), self.around, n)
    }

    /// Returns the values of an element's distinct rings at `s` in [0, 1] of the element; slopes
    /// are per unit of `s`.
    pub fn at(&self, s: f64) -> Vec<RingValues> {
        self.grouped_values_at(s, self.local_rings())
    }

    /// Returns the values of every function of an element at `s`, like those of a sector with a
    /// ring for each.
    pub fn function_values_at(&self, s: f64) -> Vec<RingValues> {
        self.grouped_values_at(s, self.basis.degree() + 1)
    }

    fn grouped_values_at(&self, s: f64, count: usize) -> Vec<RingValues> {
        let v = self.basis.evaluate_in(0, s);
        let mut ring_values = vec![RingValues::default(); count];
        for b in 0..=self.basis.degree() {
            let ring = &mut ring_values[b % count];
            let (sin, cos) = self.ring_angle(b).sin_cos();
            for (d, n) in [v.value[b], v.slope[b]].into_iter().enumerate() {
                ring.axial[d] += n;
                ring.rotated[d].0 += n * cos;
                ring.rotated[d].1 += n * sin;
            }
        }
        ring_values
    }

    /// Returns the two halves of circumferential harmonic n ≥ 1 at `s` of an element: of the
    /// displacement (z cos nφ, r cos nφ, −θ sin nφ) of rings at angle φ, with n φ measured from the
    /// middle of the element and from a quarter wave before it. Summed over all elements of an
    /// axisymmetric tube, cos² and sin² each average to one half and their product to zero, so a
    /// quadratic form of the harmonic is N_C/2 times the sum over the two halves.
    pub fn harmonic_at(&self, n: usize, s: f64) -> [Rotation; 2] {
        let v = self.basis.evaluate_in(0, s);
        let mut halves = [Rotation::default(); 2];
        for b in 0..=self.basis.degree() {
            let phi = self.ring_angle(b);
            let (sin, cos) = phi.sin_cos();
            let (wave_sin, wave_cos) = (n as f64 * phi).sin_cos();
            for (half, [r, t]) in halves
                .iter_mut()
                .zip([[wave_cos, -wave_sin], [-wave_sin, -wave_cos]])
            {
                for (d, n) in [v.value[b], v.slope[b]].into_iter().enumerate() {
                    half.axial[d] += n * r;
                    let rotated = [cos * r, -sin * t, sin * r, cos * t];
                    for (sum, x) in half.plane[d].iter_mut().zip(rotated) {
                        *sum += n * x;
                    }
                }
            }
        }
        halves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_ring_sector_sums_all_functions() {
        let (one, whole) = (Sector::new(3, 12, 1), Sector::new(3, 12, 12));
        let (folded, ring_values) = (one.at(0.3), whole.at(0.3));
        assert_eq!((folded.len(), ring_values.len()), (1, 4));
        assert!((folded[0].axial[0] - 1.0).abs() < 1e-15);
        assert!(folded[0].axial[1].abs() < 1e-14);
        for d in 0..2 {
            let sum: (f64, f64) = ring_values.iter().fold((0.0, 0.0), |s, v| {
                (s.0 + v.rotated[d].0, s.1 + v.rotated[d].1)
            });
            assert!((folded[0].rotated[d].0 - sum.0).abs() < 1e-15);
            assert!((folded[0].rotated[d].1 - sum.1).abs() < 1e-15);
        }
    }

    #[test]
    fn rigid_shift_is_reproduced_at_every_point() {
        // The rigid motion u = e_x: ring j moves by (cos φ_j, −sin φ_j) in its own components.
        let sector = Sector::new(3, 12, 12);
        let (element, s) = (5, 0.8);
        let turn = element as f64 * sector.angle();
        let (mut x, mut y) = (0.0, 0.0);
        for (r, ring) in sector.at(s).iter().enumerate() {
            let phi = sector.ring_angle(sector.ring(element, r));
            let (c, d) = (phi.cos(), -phi.sin());
            let (re, im) = ring.rotated[0];
            x += re * c - im * d;
            y += re * d + im * c;
        }
        // From the element's frame to the laboratory.
        let lab = (
            x * turn.cos() - y * turn.sin(),
            x * turn.sin() + y * turn.cos(),
        );
        assert!(
            (lab.0 - 1.0).abs() < 1e-15 && lab.1.abs() < 1e-15,
            "{lab:?}"
        );
    }
}
