//! Which unknowns are given: held ends, and what keeps a loose tube from drifting.

use super::imperfection::end_face;
use crate::rings::Sector;
use crate::tube::{End, Load, Support, Tube};

/// The unknowns that are not free.
#[derive(Clone, Debug)]
pub struct Supports {
    /// For every unknown, whether it is given.
    pub given: Vec<bool>,
    /// Number of unknowns that were pinned so that a loose tube does not drift. They are as few
    /// as there are rigid motions left, so that they carry no force.
    pub anchors: usize,
    ends: Vec<EndUnknown>,
}

/// A given unknown of an end face.
#[derive(Clone, Copy, Debug)]
struct EndUnknown {
    unknown: usize,
    end: usize,
    component: usize,
    /// Radius of its control point.
    radius: f64,
    /// Where imperfections put the control point: (axial, radial, circumferential).
    shift: [f64; 3],
}

impl Supports {
    /// The supports of a tube with control points at the axial positions `z` and radii `r`, whose
    /// stress-free shape is displaced by `shape`: ends are held where they are free of stress.
    pub fn new(
        tube: &Tube,
        sector: &Sector,
        [z, r]: &[Vec<f64>; 2],
        shape: Option<&[f64]>,
    ) -> Self {
        let size = r.len() * 3 * sector.rings;
        let mut given = vec![false; z.len() * size];
        let mut ends = vec![];
        for (end, row, name) in [(0, 0, End::Colon), (1, z.len() - 1, End::Ileum)] {
            let face = end_face(tube, sector, name, r);
            let components = match tube.ends[end] {
                Support::Fixed => 0..3,
                Support::Sliding => 0..1,
                Support::Free => 0..0,
            };
            for component in components {
                for (c, &radius) in r.iter().enumerate() {
                    for ring in 0..sector.rings {
                        let unknown = row * size + (c * 3 + component) * sector.rings + ring;
                        given[unknown] = true;
                        let mut shift = face[c * sector.rings + ring];
                        for (i, shift) in shift.iter_mut().enumerate() {
                            let own = row * size + (c * 3 + i) * sector.rings + ring;
                            *shift += shape.map_or(0.0, |shape| shape[own]);
                        }
                        ends.push(EndUnknown {
                            unknown,
                            end,
                            component,
                            radius,
                            shift,
                        });
                    }
                }
            }
        }
        let pins = pins(rigid_motions(sector, z, r), &given);
        for &pin in &pins {
            given[pin] = true;
        }
        Self {
            given,
            anchors: pins.len(),
            ends,
        }
    }

    /// The given unknowns of circumferential harmonic n of an axisymmetric tube with control
    /// points at `z` and `r`. The rigid motions of a harmonic other than 0 are, in its first, a
    /// shift sideways and a tilt.
    pub fn in_harmonic(&self, n: usize, z: &[f64], r: &[f64]) -> Vec<bool> {
        if n == 0 {
            return self.given.clone();
        }
        let mut given = self.held();
        let points: Vec<[f64; 2]> = z
            .iter()
            .flat_map(|&z| r.iter().map(move |&r| [z, r]))
            .collect();
        for pin in pins(motions_in_harmonic(n, &points), &given) {
            given[pin] = true;
        }
        given
    }

    /// For every unknown, whether an end gives it; loose motions are not pinned.
    pub fn held(&self) -> Vec<bool> {
        let mut held = vec![false; self.given.len()];
        for end in &self.ends {
            held[end.unknown] = true;
        }
        held
    }

    /// Writes the given unknowns of a load into `u`.
    pub fn impose(&self, load: &Load, u: &mut [f64]) {
        for e in &self.ends {
            let motion = load.ends[e.end];
            let ([axial, radial, around], (sin, cos)) = (e.shift, motion.twist.sin_cos());
            // A point at angle zero turned by ω: r (cos ω − 1) outwards, r sin ω around. What an
            // imperfection adds turns with the face.
            u[e.unknown] = match e.component {
                0 => motion.displacement + axial,
                1 => e.radius * (cos - 1.0) + (radial * cos - around * sin),
                _ => e.radius * sin + (radial * sin + around * cos),
            };
        }
    }
}

/// The small rigid motions that the sector admits, one vector of unknowns each: along z and about
/// z, and for the whole circumference also sideways and tilting.
pub fn rigid_motions(sector: &Sector, z: &[f64], r: &[f64]) -> Vec<Vec<f64>> {
    let (k, layers) = (sector.rings, r.len());
    let motion = |field: &dyn Fn(f64, f64, f64) -> [f64; 3]| {
        let mut u = vec![0.0; z.len() * r.len() * 3 * k];
        for (a, &z) in z.iter().enumerate() {
            for (c, &r) in r.iter().enumerate() {
                for ring in 0..k {
                    let value = field(z, r, sector.ring_angle(ring));
                    for (i, value) in value.into_iter().enumerate() {
                        u[((a * layers + c) * 3 + i) * k + ring] = value;
                    }
                }
            }
        }
        u
    };
    let mut motions = vec![
        motion(&|_, _, _| [1.0, 0.0, 0.0]),
        motion(&|_, r, _| [0.0, 0.0, r]),
    ];
    if k == sector.around {
        motions.push(motion(&|_, _, phi| [0.0, phi.cos(), -phi.sin()]));
        motions.push(motion(&|_, _, phi| [0.0, phi.sin(), phi.cos()]));
        motions.push(motion(&|z, r, phi| {
            [-r * phi.cos(), z * phi.cos(), -z * phi.sin()]
        }));
        motions.push(motion(&|z, r, phi| {
            [-r * phi.sin(), z * phi.sin(), z * phi.cos()]
        }));
    }
    motions
}

/// The small rigid motions of circumferential harmonic n of an axisymmetric tube without twist whose
/// control points are at (z, r): along and about the axis; a shift sideways and a tilt.
pub fn motions_in_harmonic(n: usize, points: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let motion = |of: &dyn Fn(f64, f64) -> [f64; 3]| -> Vec<f64> {
        points.iter().flat_map(|&[z, r]| of(z, r)).collect()
    };
    match n {
        0 => vec![
            motion(&|_, _| [1.0, 0.0, 0.0]),
            motion(&|_, r| [0.0, 0.0, r]),
        ],
        1 => vec![motion(&|_, _| [0.0, 1.0, 1.0]), motion(&|z, r| [-r, z, z])],
        _ => vec![],
    }
}

/// Each motion that the given unknowns leave is stopped at the unknown where it is largest.
fn pins(motions: Vec<Vec<f64>>, given: &[bool]) -> Vec<usize> {
    let mut motions = left_by(motions, given);
    let mut pins = vec![];
    while let Some(i) = eliminate(&mut motions, |_| true) {
        pins.push(i);
    }
    pins
}

/// The motions that the given unknowns do not stop; they are zero there.
pub fn left_by(mut motions: Vec<Vec<f64>>, given: &[bool]) -> Vec<Vec<f64>> {
    while eliminate(&mut motions, |i| given[i]).is_some() {}
    motions
}

/// Takes the motion with the largest entry over some unknowns out of all others, and away; gives
/// the unknown. None if there is no such entry.
fn eliminate(motions: &mut Vec<Vec<f64>>, over: impl Fn(usize) -> bool) -> Option<usize> {
    let (m, i, _) = largest(motions, over).filter(|(_, _, size)| *size >= 1e-9)?;
    let pivot = motions.swap_remove(m);
    for motion in motions {
        let factor = motion[i] / pivot[i];
        for (x, p) in motion.iter_mut().zip(&pivot) {
            *x -= factor * p;
        }
    }
    Some(i)
}

/// The largest entry of all motions over some unknowns: motion, unknown, size.
fn largest(motions: &[Vec<f64>], over: impl Fn(usize) -> bool) -> Option<(usize, usize, f64)> {
    let mut best = None;
    for (m, motion) in motions.iter().enumerate() {
        for (i, x) in motion.iter().enumerate().filter(|(i, _)| over(*i)) {
            if best.is_none_or(|(_, _, size)| x.abs() > size) {
                best = Some((m, i, x.abs()));
            }
        }
    }
    best
}
