//! Control rings: unknowns in cylindrical components, and sectors of rings that repeat.
//!
//! The control points around the tube lie on N_C rings of control points that run along it, an
//! angle α = 2π/N_C apart. A displacement of ring j has the components (axial, radial,
//! circumferential) *at that ring*, so that turning the tube by α only renumbers the rings. A
//! sector of k rings repeats around the tube: ring j + k moves like ring j in its own components.
//! k = 1 is the axisymmetric tube (twist included), k = N_C the whole.
//!
//! Every element around the tube is the same element, turned. In the frame of an element, the
//! complex plane whose real axis points radially outwards at the element's middle, a radial and
//! circumferential pair (u_r, u_θ) of ring b turns into (u_r + i u_θ) exp(i φ_b). If the sector
//! has fewer rings than an element has functions, several functions belong to one ring; they are
//! added up once, here, and everything downstream sees *slots*: the distinct rings of an element.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | N_C | rings around the whole tube | [`Sector::around`] |
//! | k | rings of the sector | [`Sector::rings`] |
//! | α | angle between rings | [`Sector::angle`] |
//! | φ_b | angle of function b from the middle of its element | inside [`Sector::at`] |
//! | g, g' | Σ N_b over the functions of a slot, and its slope | [`SlotValues::axial`] |
//! | t, t' | Σ N_b exp(i φ_b), and its slope | [`SlotValues::turned`] |

mod circulant;
mod coupling;
mod harmonic_solver;
mod transform;

pub use circulant::Circulant;
pub use coupling::Coupling;
pub use harmonic_solver::HarmonicSolver;
pub use transform::{Transform, Wave};

use crate::spline::{self, Basis};
use std::f64::consts::TAU;

/// Rings that repeat around the tube.
#[derive(Clone, Debug)]
pub struct Sector {
    /// N_C: rings around the whole tube.
    pub around: usize,
    /// k: rings of the sector; divides N_C.
    pub rings: usize,
    basis: Basis,
}

/// What one slot of an element contributes at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlotValues {
    /// Factor of the axial component, and its slope along the element.
    pub axial: [f64; 2],
    /// Factor of (u_r + i u_θ) as (real, imaginary), and its slope.
    pub turned: [(f64, f64); 2],
}

/// What one slot contributes to the displacement in the element's frame, as a matrix on (axial,
/// radial, circumferential); its value and its slope along the element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Axial from axial.
    pub axial: [f64; 2],
    /// [outwards from radial, outwards from circumferential, around from radial, around from
    /// circumferential].
    pub plane: [[f64; 4]; 2],
}

impl From<&SlotValues> for Turn {
    fn from(slot: &SlotValues) -> Self {
        Self {
            axial: slot.axial,
            plane: slot.turned.map(|(re, im)| [re, -im, im, re]),
        }
    }
}

impl Sector {
    /// `rings` of `around` rings, splines of a degree.
    pub fn new(degree: usize, around: usize, rings: usize) -> Self {
        assert!(rings >= 1 && around.is_multiple_of(rings));
        Self {
            around,
            rings,
            basis: Basis::uniform_element(degree),
        }
    }

    /// The angle α between rings.
    pub fn angle(&self) -> f64 {
        TAU / self.around as f64
    }

    /// How often the sector repeats around the tube.
    pub fn repeats(&self) -> f64 {
        (self.around / self.rings) as f64
    }

    /// Distinct rings of one element.
    pub fn slots(&self) -> usize {
        self.rings.min(self.basis.degree() + 1)
    }

    /// The ring of the sector that slot `r` of element `e` stands for.
    pub fn ring(&self, e: usize, r: usize) -> usize {
        (e + r) % self.rings
    }

    /// The angle at which ring `j` lies: the middle of element 0 is at angle zero.
    pub fn ring_angle(&self, j: usize) -> f64 {
        (j as f64 - 0.5 * self.basis.degree() as f64) * self.angle()
    }

    /// c_n: the height of the control values of a wave of unit height and n turns, see
    /// [`spline::control_wave`].
    pub fn control_wave(&self, n: usize) -> f64 {
        spline::control_wave(self.basis.degree(), self.around, n)
    }

    /// The slots of an element at `s` in [0, 1] along it; slopes are per unit of `s`.
    pub fn at(&self, s: f64) -> Vec<SlotValues> {
        self.folded_at(s, self.slots())
    }

    /// Every function of an element at `s` as a slot of its own, as if the sector had rings enough.
    pub fn unfolded_at(&self, s: f64) -> Vec<SlotValues> {
        self.folded_at(s, self.basis.degree() + 1)
    }

    fn folded_at(&self, s: f64, slots: usize) -> Vec<SlotValues> {
        let v = self.basis.evaluate_in(0, s);
        let mut slots = vec![SlotValues::default(); slots];
        let distinct = slots.len();
        for b in 0..=self.basis.degree() {
            let slot = &mut slots[b % distinct];
            let (sin, cos) = self.ring_angle(b).sin_cos();
            for (d, n) in [v.value[b], v.slope[b]].into_iter().enumerate() {
                slot.axial[d] += n;
                slot.turned[d].0 += n * cos;
                slot.turned[d].1 += n * sin;
            }
        }
        slots
    }

    /// The two halves of a circumferential harmonic n ≥ 1 at `s` of an element: of the
    /// displacement (z cos nφ, r cos nφ, −θ sin nφ) of rings at angle φ, with n φ counted from
    /// the middle of the element and from a quarter wave before it. Over all elements of a tube
    /// that is the same all around, cos² and sin² are each a half and their product nothing, so
    /// that a quadratic form of the harmonic is the sum of those of the halves, N_C/2 times.
    pub fn harmonic_at(&self, n: usize, s: f64) -> [Turn; 2] {
        let v = self.basis.evaluate_in(0, s);
        let mut halves = [Turn::default(); 2];
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
                    let turned = [cos * r, -sin * t, sin * r, cos * t];
                    for (sum, x) in half.plane[d].iter_mut().zip(turned) {
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
    fn a_sector_of_one_ring_adds_up_the_whole_sector() {
        let (one, whole) = (Sector::new(3, 12, 1), Sector::new(3, 12, 12));
        let (folded, slots) = (one.at(0.3), whole.at(0.3));
        assert_eq!((folded.len(), slots.len()), (1, 4));
        assert!((folded[0].axial[0] - 1.0).abs() < 1e-15);
        assert!(folded[0].axial[1].abs() < 1e-14);
        for d in 0..2 {
            let sum: (f64, f64) = slots.iter().fold((0.0, 0.0), |s, v| {
                (s.0 + v.turned[d].0, s.1 + v.turned[d].1)
            });
            assert!((folded[0].turned[d].0 - sum.0).abs() < 1e-15);
            assert!((folded[0].turned[d].1 - sum.1).abs() < 1e-15);
        }
    }

    #[test]
    fn a_shifted_tube_is_shifted_everywhere() {
        // The rigid motion u = e_x: ring j moves by (cos φ_j, −sin φ_j) in its own components.
        let sector = Sector::new(3, 12, 12);
        let (element, s) = (5, 0.8);
        let turn = element as f64 * sector.angle();
        let (mut x, mut y) = (0.0, 0.0);
        for (r, slot) in sector.at(s).iter().enumerate() {
            let phi = sector.ring_angle(sector.ring(element, r));
            let (c, d) = (phi.cos(), -phi.sin());
            let (re, im) = slot.turned[0];
            x += re * c - im * d;
            y += re * d + im * c;
        }
        // Back from the element's frame to the laboratory.
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
