//! Meridians of a state, in planes that turn with the tube; and how far it is from axisymmetric.

use super::{Face, Wall};
use crate::assembly::{Point, SplineTube};
use crate::tube::{Load, Tube};
use std::f64::consts::{PI, TAU};

/// Meridians that are looked at where they differ: harmonics up to 7 of the sector are told apart.
pub(super) const MERIDIANS: usize = 16;

/// Departure, in D, up to which a tube counts as axisymmetric: what solvers leave of nothing.
const ROUND: f64 = 1e-9;

/// An angle, in radians, below which what parts a crest from half a turn is rounding.
const SAME_SIDE: f64 = 1e-4;

/// A state, and where its meridians have turned to.
pub struct Meridians<'a> {
    tube: &'a SplineTube,
    load: &'a Load,
    u: &'a [f64],
    /// Where meridians may differ, the axisymmetric part of the state: its tube and its unknowns.
    mean: Option<(SplineTube, Vec<f64>)>,
}

/// How far a state is from axisymmetric: the largest wave around its outer face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asymmetry {
    /// Amplitude of the wave's displacement along the axis and of the radius, together; in D.
    pub amplitude: f64,
    /// Its waves around the tube, at least 1; 0 if the tube is axisymmetric.
    pub harmonic: usize,
    /// Reference angle of a crest, in radians, from −π/n to π/n.
    pub crest: f64,
}

impl Asymmetry {
    /// Reference angles of a crest and of the trough beside it: both sides of a tube that leans,
    /// the widest and the narrowest meridian of an oval one.
    pub fn crest_and_trough(&self) -> [f64; 2] {
        [
            self.crest,
            self.crest + 0.5 * TAU / self.harmonic.max(1) as f64,
        ]
    }
}

impl<'a> Meridians<'a> {
    /// The meridians of a state.
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

    /// Meridians of a face at reference angles, through points at reference positions along the tube.
    pub fn walls(&self, face: Face, angles: &[f64], reference_z: &[f64]) -> Vec<Wall> {
        let radius = match face {
            Face::Outer => Tube::OUTER_RADIUS,
            Face::Inner => self.tube.tube.inner_radius(),
        };
        let at = |z: f64, angle: f64| Point { z, radius, angle };
        // exp(iω) where rings may be turned against where they were, and the radius there, now and
        // at rest.
        let turned = |&z: &f64| {
            let (tube, u) = self.mean.as_ref()?;
            let sample = tube.sample(self.load, u, at(z, 0.0));
            let ([_, x, y], [_, x0, y0]) = (sample.position, sample.reference);
            let (size, drawn) = (x.hypot(y), x0.hypot(y0));
            Some(if size > 0.0 {
                [x / size, y / size, size, drawn]
            } else {
                [1.0, 0.0, size, drawn]
            })
        };
        let turned: Vec<Option<[f64; 4]>> = reference_z.iter().map(turned).collect();
        let wall = |&angle: &f64| {
            let (sin, cos) = angle.sin_cos();
            let point = |(&z, turned): (&f64, &Option<[f64; 4]>)| {
                let sample = self.tube.sample(self.load, self.u, at(z, angle));
                let [z, x, y] = sample.position;
                match turned {
                    None => (z, x.hypot(y)),
                    &Some([c, s, size, drawn]) => {
                        // Splines draw a circle with waves of their own, which are no departure.
                        let at_rest = sample.reference[1].hypot(sample.reference[2]);
                        let radius = x * (c * cos - s * sin) + y * (s * cos + c * sin);
                        (z, radius - size * (at_rest / drawn - 1.0))
                    }
                }
            };
            Wall {
                angle,
                points: reference_z.iter().zip(&turned).map(point).collect(),
                reference_z: reference_z.to_vec(),
            }
        };
        angles.iter().map(wall).collect()
    }

    /// The largest wave around the outer face.
    pub fn asymmetry(&self) -> Asymmetry {
        let mut largest = Asymmetry::default();
        if self.mean.is_none() {
            return largest;
        }
        let walls = self.walls(Face::Outer, &self.around(0.0), &self.every_element());
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
                    // What rounding makes of a crest at half a turn is at the same side always.
                    let angle = if re < 0.0 && im < 0.0 && im > SAME_SIDE * re {
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
        if largest.amplitude > ROUND {
            largest
        } else {
            Asymmetry::default()
        }
    }

    /// Reference angles spread over the sector that repeats, from one on; one if all meridians are
    /// the same.
    pub(super) fn around(&self, first: f64) -> Vec<f64> {
        if self.mean.is_none() {
            return vec![0.0];
        }
        let span = TAU / self.tube.sector.repeats();
        let angle = |i: usize| first + span * i as f64 / MERIDIANS as f64;
        (0..MERIDIANS).map(angle).collect()
    }

    /// Walls at the angles of [`Meridians::around`], as seen from the tube's own axis: that about
    /// which the radii of the first face have no first harmonic. (In a sector that repeats none have.)
    pub(super) fn about_own_axis<const N: usize>(&self, faces: [&[Wall]; N]) -> [Vec<Wall>; N] {
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

    /// Smallest width across a face, whose meridians are those at the angles of [`Meridians::around`].
    pub(super) fn narrowest_across(&self, walls: &[Wall]) -> f64 {
        // Half a turn on is a meridian of the same kind: half a sector on if an odd number of them makes the tube.
        let odd = self.mean.is_some() && self.tube.sector.repeats() % 2.0 == 1.0;
        let on = if odd { walls.len() / 2 } else { 0 };
        let across = |(i, wall): (usize, &Wall)| {
            let opposite = &walls[(i + on) % walls.len()];
            let pairs = wall.points.iter().zip(&opposite.points);
            pairs.fold(f64::INFINITY, |least, (a, b)| least.min(a.1 + b.1))
        };
        let widths = walls.iter().enumerate().map(across);
        widths.fold(f64::INFINITY, f64::min)
    }

    /// A point per element along the tube.
    fn every_element(&self) -> Vec<f64> {
        self.tube.axial.spread(self.tube.axial.elements() + 1)
    }
}

/// (a, b) of the wave a cos nφ + b sin nφ in what evenly spread meridians hold.
fn wave(walls: &[Wall], harmonic: usize, of: impl Fn(&Wall) -> f64) -> (f64, f64) {
    let scale = 2.0 / walls.len() as f64;
    walls.iter().fold((0.0, 0.0), |(a, b), wall| {
        let (sin, cos) = (harmonic as f64 * wall.angle).sin_cos();
        let value = scale * of(wall);
        (a + value * cos, b + value * sin)
    })
}
