//! Prescribed displacements: boundary conditions at the ends, and rigid-body constraints.

use super::imperfection::end_face;
use crate::rings::Sector;
use crate::tube::{End, EndMotion, Load, Support, Tube};
use std::f64::consts::TAU;

/// Prescribed displacements of a tube.
///
/// Each rigid-body constraint belongs to a single harmonic, 0 or 1, as rigid motions do, and
/// constrains one unknown of a ring in that harmonic. For a sector of one ring that is the unknown
/// itself; for many rings it is the mean over the rings, or their cosine and sine, and the rings
/// are otherwise free. The constraints are therefore the same at every ring, and a constrained tube
/// stays block-circulant.
#[derive(Clone, Debug)]
pub struct BoundaryConditions {
    /// For every unknown, whether it is prescribed: at the ends, and by rigid-body constraints for
    /// one ring.
    pub prescribed: Vec<bool>,
    /// Rigid-body constraints for many rings.
    constraints: Vec<RigidBodyConstraint>,
    /// Constrained unknowns of a ring in harmonics 0 and 1 of the tube.
    constrained: [Vec<usize>; 2],
    ends: Vec<PrescribedUnknown>,
    rings: usize,
}

/// A rigid-body constraint: an unknown of a ring is orthogonal to a wave over the rings.
#[derive(Clone, Debug)]
struct RigidBodyConstraint {
    unknown: usize,
    /// The wave, of unit length.
    wave: Vec<f64>,
}

/// A prescribed unknown of an end face.
#[derive(Clone, Copy, Debug)]
struct PrescribedUnknown {
    unknown: usize,
    end: usize,
    component: usize,
    /// Radius of the control point.
    radius: f64,
    /// Angle of its ring.
    angle: f64,
    /// Displacement of the control point by imperfections: (axial, radial, circumferential).
    shift: [f64; 3],
}

impl BoundaryConditions {
    /// Returns the boundary conditions of a tube with control points at axial positions `z` and
    /// radii `r`. `shape` displaces the stress-free shape; the ends are fixed there.
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
                        ends.push(PrescribedUnknown {
                            unknown,
                            end,
                            component,
                            radius,
                            angle: sector.ring_angle(ring),
                            shift,
                        });
                    }
                }
            }
        }
        let rings = sector.rings;
        let at_ends = prescribed_at_ends(&ends, prescribed.len(), rings);
        let whole = rings == sector.around;
        let points: Vec<[f64; 2]> = z
            .iter()
            .flat_map(|&z| r.iter().map(move |&r| [z, r]))
            .collect();
        let constrained = [0, 1].map(|n| match tube.is_held_by_foundations(n) {
            true => vec![],
            false => constrained_unknowns(rigid_motions_in_harmonic(n, &points), &at_ends),
        });
        let mut constraints = vec![];
        if rings == 1 {
            for &unknown in &constrained[0] {
                prescribed[unknown] = true;
            }
        } else {
            let of_harmonic = |n: usize| {
                constrained[n]
                    .iter()
                    .flat_map(move |&at| waves(at, n, rings))
            };
            constraints.extend(of_harmonic(0));
            constraints.extend(of_harmonic(1).filter(|_| whole));
        }
        Self {
            prescribed,
            constraints,
            constrained,
            ends,
            rings,
        }
    }

    /// Returns the number of rigid-body constraints.
    #[cfg(test)]
    pub fn rigid_body_constraints(&self) -> usize {
        match self.rings {
            1 => self.constrained[0].len(),
            _ => self.constraints.len(),
        }
    }

    /// Returns for every unknown of one ring whether it is prescribed in circumferential harmonic n
    /// of the tube.
    pub fn prescribed_in_harmonic(&self, n: usize) -> Vec<bool> {
        let mut prescribed = self.prescribed_at_ends();
        for &unknown in self.constrained.get(n).into_iter().flatten() {
            prescribed[unknown] = true;
        }
        prescribed
    }

    /// Returns for every unknown of a ring whether an end prescribes it, without rigid-body
    /// constraints.
    pub fn prescribed_at_ends(&self) -> Vec<bool> {
        prescribed_at_ends(&self.ends, self.prescribed.len(), self.rings)
    }

    /// Projects a displacement onto those that satisfy the rigid-body constraints of many rings.
    pub fn project_out_constraints(&self, u: &mut [f64]) {
        for RigidBodyConstraint { unknown, wave } in &self.constraints {
            let u = &mut u[unknown * self.rings..][..self.rings];
            let part: f64 = wave.iter().zip(&*u).map(|(w, u)| w * u).sum();
            for (u, w) in u.iter_mut().zip(wave) {
                *u -= part * w;
            }
        }
    }

    /// Writes the prescribed unknowns of a load into `u`.
    pub fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        for e in &self.ends {
            let motion = load.ends[e.end];
            if motion.is_sideways() {
                u[e.unknown] = e.moved_sideways(&motion);
                continue;
            }
            let ([axial, radial, around], (sin, cos)) = (e.shift, motion.twist.sin_cos());
            // A point at angle zero rotated by ω moves by r (cos ω − 1) outwards and r sin ω
            // around; the displacement of an imperfection rotates with the face.
            u[e.unknown] = match e.component {
                0 => motion.displacement + axial,
                1 => e.radius * (cos - 1.0) + (radial * cos - around * sin),
                _ => e.radius * sin + (radial * sin + around * cos),
            };
        }
    }
}

impl PrescribedUnknown {
    /// Returns the displacement by a motion of the end: a twist, then a tilt about the centre of the face, then a shift. A
    /// rigid motion of the face is that of its control points.
    fn moved_sideways(&self, motion: &EndMotion) -> f64 {
        let [axial, radial, around] = self.shift;
        let from = self.radius + radial;
        let (sin, cos) = (self.angle + motion.twist).sin_cos();
        // (z, x, y) from the centre of the face.
        let point = [axial, from * cos - around * sin, from * sin + around * cos];
        let [z, x, y] = tilted(point, motion.tilt);
        let [x, y] = [x + motion.shift[0], y + motion.shift[1]];
        let (sin, cos) = self.angle.sin_cos();
        match self.component {
            0 => motion.displacement + z,
            1 => x * cos + y * sin - self.radius,
            _ => y * cos - x * sin,
        }
    }
}

/// Returns a point (z, x, y) rotated by a rotation vector in the plane of x and y (Rodrigues' formula).
fn tilted(point: [f64; 3], [a, b]: [f64; 2]) -> [f64; 3] {
    let angle = a.hypot(b);
    if angle == 0.0 {
        return point;
    }
    let [a, b] = [a / angle, b / angle];
    let ([z, x, y], (sin, cos)) = (point, angle.sin_cos());
    let along = (a * x + b * y) * (1.0 - cos);
    [
        z * cos + (a * y - b * x) * sin,
        x * cos + b * z * sin + a * along,
        y * cos - a * z * sin + b * along,
    ]
}

/// Returns for every unknown of a ring whether an end prescribes it.
fn prescribed_at_ends(ends: &[PrescribedUnknown], unknowns: usize, rings: usize) -> Vec<bool> {
    let mut at_ends = vec![false; unknowns / rings];
    for end in ends {
        at_ends[end.unknown / rings] = true;
    }
    at_ends
}

/// Returns the constraints of an unknown of a ring to the waves of harmonic n of k rings: the mean,
/// or cosine and sine.
fn waves(unknown: usize, n: usize, rings: usize) -> impl Iterator<Item = RigidBodyConstraint> {
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
        RigidBodyConstraint {
            unknown,
            wave: wave.iter().map(|w| w / length).collect(),
        }
    };
    (0..=n.min(1)).map(wave)
}

/// Returns the infinitesimal rigid motions of circumferential harmonic n of an axisymmetric tube
/// without twist with control points at (z, r): along and about the axis; a sideways shift and a
/// tilt.
pub fn rigid_motions_in_harmonic(n: usize, points: &[[f64; 2]]) -> Vec<Vec<f64>> {
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

/// Returns one unknown for each motion that the prescribed unknowns permit: the one where it is
/// largest.
fn constrained_unknowns(motions: Vec<Vec<f64>>, prescribed: &[bool]) -> Vec<usize> {
    let mut motions = permitted_by(motions, prescribed);
    let mut constraints = vec![];
    while let Some(i) = eliminate(&mut motions, |_| true) {
        constraints.push(i);
    }
    constraints
}

/// Returns the motions that the prescribed unknowns permit; they are zero there.
pub fn permitted_by(mut motions: Vec<Vec<f64>>, prescribed: &[bool]) -> Vec<Vec<f64>> {
    while eliminate(&mut motions, |i| prescribed[i]).is_some() {}
    motions
}

/// Eliminates the motion with the largest entry over some unknowns from all others and removes it.
/// Returns the unknown, or none if there is no such entry.
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

/// Returns the largest entry of all motions over some unknowns: motion, unknown, size.
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
