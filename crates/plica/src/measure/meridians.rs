//! Meridians of a state in planes that rotate with the tube, and the asymmetry of the state.

use super::{Face, Wall};
use crate::assembly::{Point, SplineTube};
use crate::tube::Load;
use std::f64::consts::{PI, TAU};

/// Meridians sampled where they differ, which resolve the harmonics up to 7 of the sector.
const MERIDIANS: usize = 16;

/// Amplitude, in D, up to which a tube counts as axisymmetric; solvers leave errors of this size.
const AXISYMMETRIC: f64 = 1e-9;

/// Angle, in radians, below which the deviation of a crest from half a turn is rounding.
const ROUNDING: f64 = 1e-4;

/// A state whose meridians are evaluated.
pub struct Meridians<'a> {
    tube: &'a SplineTube,
    load: &'a Load,
    u: &'a [f64],
    /// Axisymmetric part of the state, as a tube of one ring and its unknowns; none if all meridians are the same.
    mean: Option<(SplineTube, Vec<f64>)>,
}

/// Deviation of a state from axisymmetry: the largest wave around its outer face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asymmetry {
    /// Amplitude √(aᶻ² + aᵨ²) of its axial and radial parts, in D.
    pub amplitude: f64,
    /// Circumferential mode n of the wave, at least 1; 0 if the tube is axisymmetric.
    pub harmonic: usize,
    /// Reference angle of a crest, in radians, from −π/n to π/n.
    pub crest: f64,
}

impl Asymmetry {
    /// Returns the reference angles of a crest and of the next trough: the two sides of a tilted tube, or the widest
    /// and the narrowest meridian of an oval one.
    pub fn crest_and_trough(&self) -> [f64; 2] {
        [
            self.crest,
            self.crest + 0.5 * TAU / self.harmonic.max(1) as f64,
        ]
    }
}

impl<'a> Meridians<'a> {
    /// Prepares the meridians of a state.
    pub fn of(tube: &'a SplineTube, load: &'a Load, u: &'a [f64]) -> Self {
        let rings = tube.sector.rings;
        let mean = (rings > 1).then(|| {
            let mean = |u: &[f64]| u.iter().sum::<f64>() / rings as f64;
            let mean = u.chunks_exact(rings).map(mean).collect();
            (tube.axisymmetric(), mean)
        });
        Self {
            tube,
            load,
            u,
            mean,
        }
    }

    /// Returns the meridians of a face at reference angles, each through points at axial reference positions.
    pub fn walls(&self, face: Face, angles: &[f64], reference_z: &[f64]) -> Vec<Wall> {
        let radius = face.radius(&self.tube.tube);
        let at = |z: f64, angle: f64| Point { z, radius, angle };
        // exp(iω) of the axisymmetric part as (cos ω, sin ω), its radius, and its radius at rest.
        let mean_at = |&z: &f64| {
            let (tube, u) = self.mean.as_ref()?;
            let sample = tube.sample(self.load, u, at(z, 0.0));
            let ([_, x, y], [_, x0, y0]) = (sample.position, sample.reference);
            let (size, size_at_rest) = (x.hypot(y), x0.hypot(y0));
            Some(if size > 0.0 {
                [x / size, y / size, size, size_at_rest]
            } else {
                [1.0, 0.0, size, size_at_rest]
            })
        };
        let means: Vec<Option<[f64; 4]>> = reference_z.iter().map(mean_at).collect();
        let wall = |&angle: &f64| {
            let (sin, cos) = angle.sin_cos();
            let point = |(&z, mean): (&f64, &Option<[f64; 4]>)| {
                let sample = self.tube.sample(self.load, self.u, at(z, angle));
                let [z, x, y] = sample.position;
                match mean {
                    None => (z, x.hypot(y)),
                    &Some([c, s, size, size_at_rest]) => {
                        // The waves of the spline circle itself are no asymmetry.
                        let at_rest = sample.reference[1].hypot(sample.reference[2]);
                        let radius = x * (c * cos - s * sin) + y * (s * cos + c * sin);
                        (z, radius - size * (at_rest / size_at_rest - 1.0))
                    }
                }
            };
            Wall {
                angle,
                points: reference_z.iter().zip(&means).map(point).collect(),
                reference_z: reference_z.to_vec(),
            }
        };
        angles.iter().map(wall).collect()
    }

    /// Returns the largest wave around the outer face, sampled once per axial element.
    pub fn asymmetry(&self) -> Asymmetry {
        let mut largest = Asymmetry::default();
        if self.mean.is_none() {
            return largest;
        }
        let z = self.tube.axial.positions(self.tube.axial.elements() + 1);
        let walls = self.walls(Face::Outer, &self.sample_angles(0.0), &z);
        for i in 0..walls[0].points.len() {
            for m in 1..MERIDIANS / 2 {
                let harmonic = m * self.tube.sector.repeats() as usize;
                let along = wave(&walls, harmonic, |wall| wall.points[i].0);
                let radial = wave(&walls, harmonic, |wall| wall.points[i].1);
                let size = |(re, im): (f64, f64)| re.hypot(im);
                let amplitude = size(along).hypot(size(radial));
                if amplitude > largest.amplitude {
                    let (re, im) = if size(radial) >= size(along) {
                        radial
                    } else {
                        along
                    };
                    // A crest at half a turn gets the angle π, also where rounding makes it −π.
                    let angle = if re < 0.0 && im < 0.0 && im > ROUNDING * re {
                        PI
                    } else {
                        im.atan2(re)
                    };
                    largest = Asymmetry {
                        amplitude,
                        harmonic,
                        crest: angle / harmonic as f64,
                    };
                }
            }
        }
        if largest.amplitude > AXISYMMETRIC {
            largest
        } else {
            Asymmetry::default()
        }
    }

    /// Returns reference angles spread evenly over the sector that repeats, beginning with `first`; one angle if all
    /// meridians are the same.
    pub(super) fn sample_angles(&self, first: f64) -> Vec<f64> {
        if self.mean.is_none() {
            return vec![0.0];
        }
        let span = TAU / self.tube.sector.repeats();
        let angle = |i: usize| first + span * i as f64 / MERIDIANS as f64;
        (0..MERIDIANS).map(angle).collect()
    }

    /// Returns the walls at [`Meridians::sample_angles`] with radii about the tube's own axis, about which the radii
    /// of the first face have no first harmonic. In a sector that repeats that is the axis itself.
    pub(super) fn centred<const N: usize>(&self, faces: [&[Wall]; N]) -> [Vec<Wall>; N] {
        let mut centred = faces.map(<[Wall]>::to_vec);
        if self.mean.is_none() || self.tube.sector.repeats() > 1.0 {
            return centred;
        }
        for i in 0..faces[0][0].points.len() {
            let (x, y) = wave(faces[0], 1, |wall| wall.points[i].1);
            for wall in centred.iter_mut().flatten() {
                let (sin, cos) = wall.angle.sin_cos();
                wall.points[i].1 -= x * cos + y * sin;
            }
        }
        centred
    }

    /// Returns the smallest ρ(φ) + ρ(φ + π) of a face, negative where opposite points have passed each other, from its
    /// meridians at [`Meridians::sample_angles`].
    pub(super) fn min_width(&self, walls: &[Wall]) -> f64 {
        // With an odd number of sectors the opposite meridian is half a sector further, with an even number it repeats
        // this one.
        let odd = self.mean.is_some() && self.tube.sector.repeats() % 2.0 == 1.0;
        let offset = if odd { walls.len() / 2 } else { 0 };
        let width = |(i, wall): (usize, &Wall)| {
            let opposite = &walls[(i + offset) % walls.len()];
            let pairs = wall.points.iter().zip(&opposite.points);
            pairs.fold(f64::INFINITY, |least, (a, b)| least.min(a.1 + b.1))
        };
        let widths = walls.iter().enumerate().map(width);
        widths.fold(f64::INFINITY, f64::min)
    }
}

/// Returns the Fourier coefficients (a, b) of a cos nφ + b sin nφ of a quantity of evenly spread meridians.
fn wave(walls: &[Wall], harmonic: usize, of: impl Fn(&Wall) -> f64) -> (f64, f64) {
    let scale = 2.0 / walls.len() as f64;
    walls.iter().fold((0.0, 0.0), |(a, b), wall| {
        let (sin, cos) = (harmonic as f64 * wall.angle).sin_cos();
        let value = scale * of(wall);
        (a + value * cos, b + value * sin)
    })
}
