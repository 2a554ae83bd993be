//! What is given: held ends, and what keeps a loose tube from drifting.

use super::imperfection::end_face;
use crate::rings::Sector;
use crate::tube::{End, Load, Support, Tube};
use std::f64::consts::TAU;

/// The displacements that are not free.
///
/// What keeps a loose tube from drifting is of a single harmonic, 0 or 1, as rigid motions are: one
/// unknown of a ring is pinned in that harmonic. Of one ring that is the unknown itself; of many it
/// is the mean over the rings, or their cosine and their sine, while the rings stay free otherwise.
/// So what is held is the same at every ring, and a tube that is held is block-circulant still.
#[derive(Clone, Debug)]
pub struct Supports {
    /// For every unknown, whether it is given: at the ends, and what is pinned if there is one ring.
    pub prescribed: Vec<bool>,
    /// What is pinned if there are many.
    pins: Vec<Pin>,
    /// The unknowns of a ring that are pinned in harmonics 0 and 1 of the tube.
    pinned: [Vec<usize>; 2],
    /// Number of displacements that are pinned so that a loose tube does not drift. They are as few
    /// as there are rigid motions left, so that they carry no force in equilibrium.
    pub rigid_body_constraints: usize,
    ends: Vec<EndUnknown>,
    rings: usize,
}

/// A wave over the rings that an unknown of a ring has no part in.
#[derive(Clone, Debug)]
struct Pin {
    unknown: usize,
    /// Of length one.
    wave: Vec<f64>,
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
        let mut prescribed = vec![false; z.len() * size];
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
                        prescribed[unknown] = true;
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
        let rings = sector.rings;
        let held = held(&ends, prescribed.len(), rings);
        let whole = rings == sector.around;
        let points: Vec<[f64; 2]> = z
            .iter()
            .flat_map(|&z| r.iter().map(move |&r| [z, r]))
            .collect();
        let pinned = [0, 1].map(|n| pins_of(motions_in_harmonic(n, &points), &held));
        let mut pins = vec![];
        if rings == 1 {
            for &unknown in &pinned[0] {
                prescribed[unknown] = true;
            }
        } else {
            let of_harmonic = |n: usize| pinned[n].iter().flat_map(move |&at| waves(at, n, rings));
            pins.extend(of_harmonic(0));
            pins.extend(of_harmonic(1).filter(|_| whole));
        }
        Self {
            rigid_body_constraints: if rings == 1 {
                pinned[0].len()
            } else {
                pins.len()
            },
            prescribed,
            pins,
            pinned,
            ends,
            rings,
        }
    }

    /// The given unknowns of circumferential harmonic n of the tube, of one ring.
    pub fn in_harmonic(&self, n: usize) -> Vec<bool> {
        let mut prescribed = self.held();
        for &unknown in self.pinned.get(n).into_iter().flatten() {
            prescribed[unknown] = true;
        }
        prescribed
    }

    /// For every unknown of a ring, whether an end gives it; loose motions are not pinned.
    pub fn held(&self) -> Vec<bool> {
        held(&self.ends, self.prescribed.len(), self.rings)
    }

    /// Takes what is pinned at many rings out of a displacement.
    pub fn take_out_pins(&self, u: &mut [f64]) {
        for Pin { unknown, wave } in &self.pins {
            let u = &mut u[unknown * self.rings..][..self.rings];
            let part: f64 = wave.iter().zip(&*u).map(|(w, u)| w * u).sum();
            for (u, w) in u.iter_mut().zip(wave) {
                *u -= part * w;
            }
        }
    }

    /// Writes the given unknowns of a load into `u`.
    pub fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
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

/// For every unknown of a ring, whether an end gives it.
fn held(ends: &[EndUnknown], unknowns: usize, rings: usize) -> Vec<bool> {
    let mut held = vec![false; unknowns / rings];
    for end in ends {
        held[end.unknown / rings] = true;
    }
    held
}

/// The waves of harmonic n of k rings, at an unknown of a ring: the mean, or cosine and sine.
fn waves(unknown: usize, n: usize, rings: usize) -> impl Iterator<Item = Pin> {
    let wave = move |quarter: usize| {
        let angle = |j: usize| TAU * (n * j) as f64 / rings as f64;
        let value = |j| {
            if quarter == 0 {
                angle(j).cos()
            } else {
                angle(j).sin()
            }
        };
        let wave: Vec<f64> = (0..rings).map(value).collect();
        let length = wave.iter().map(|w| w * w).sum::<f64>().sqrt();
        Pin {
            unknown,
            wave: wave.iter().map(|w| w / length).collect(),
        }
    };
    (0..=n.min(1)).map(wave)
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
fn pins_of(motions: Vec<Vec<f64>>, prescribed: &[bool]) -> Vec<usize> {
    let mut motions = left_by(motions, prescribed);
    let mut pins = vec![];
    while let Some(i) = eliminate(&mut motions, |_| true) {
        pins.push(i);
    }
    pins
}

/// The motions that the given unknowns do not stop; they are zero there.
pub fn left_by(mut motions: Vec<Vec<f64>>, prescribed: &[bool]) -> Vec<Vec<f64>> {
    while eliminate(&mut motions, |i| prescribed[i]).is_some() {}
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
