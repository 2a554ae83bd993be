//! A tube cut open, as a picture shows it.

use super::Field;
use super::tolerance::{Meshed, Seen, Tolerance};
use crate::draw::{Cutaway, DrawError, Opening, REAR_HALF, Range, Surface};
use plica::assembly::{Point, SplineTube};
use plica::tube::Load;
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// What of a tube is shown, and what it is coloured by.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Angles, in radians, between which the wall stays.
    pub kept: (f64, f64),
    /// Where it is looked at.
    pub points: Points,
    /// Its colour.
    pub field: Field,
    /// By how much values are multiplied.
    pub factor: f64,
}

/// Where a tube is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Points {
    /// So many points along, around what stays, and through the wall.
    Evenly([usize; 3]),
    /// As many as it takes.
    Within(Tolerance),
}

/// Pieces along a tube, at least.
pub(super) const ALONG: usize = 200;

/// By how many pixels what is drawn may be off the wall, at most: cut along, joined along, and cut around by a third of it each.
const PIXELS: f64 = 0.4;
/// By how much of what the colours span it may be off the field.
const COLOURS: f64 = 0.03;

impl Look {
    /// The near half taken away, coloured by strain energy density.
    pub fn half(tube: &SplineTube) -> Self {
        // Long elements are curved.
        let elements = tube.axial.elements();
        let along = elements * ALONG.div_ceil(elements.max(1)).max(2);
        Self {
            kept: REAR_HALF,
            points: Points::Evenly([along + 1, 97, 13]),
            field: Field::EnergyDensity,
            factor: 1.0,
        }
    }

    /// With an angle of the wall taken away, in degrees: 180 the near half, 90 its upper quarter, 0 nothing. As many even points stand
    /// for what is left, whatever that is.
    #[must_use]
    pub fn cut(mut self, degrees: f64) -> Self {
        self.kept = (degrees.to_radians(), TAU);
        self
    }

    /// At few even points, as many pieces along at least and so many points through the wall: for the room it takes, and what its
    /// colours span and its field's own ends, which every point counts alike for.
    #[must_use]
    pub fn coarse(mut self, tube: &SplineTube, [along, through]: [usize; 2]) -> Self {
        let elements = tube.axial.elements();
        let along = elements * along.div_ceil(elements.max(1));
        let around = if tube.sector.rings == 1 { 33 } else { 49 };
        self.points = Points::Evenly([along + 1, around, through]);
        self
    }

    /// At as many points as it takes in a picture so many pixels wide that has coarse looks at the tubes so far; and its colour bar,
    /// which then tells the same in pictures of any size.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn fine(mut self, coarse: &Cutaway, width: usize) -> Result<(Self, Range), DrawError> {
        let spanned = coarse.colour_range()?;
        self.points = Points::Within(Tolerance {
            place: PIXELS / coarse.pixels_per_unit(width)?,
            value: COLOURS,
            colours: (spanned.low, spanned.high),
        });
        Ok((self, Range::Resolved(spanned)))
    }

    /// What [`Look::cut`] takes away; none if that is nothing.
    pub fn taken_away(&self) -> Option<Self> {
        let mut other = *self;
        other.kept = (0.0, self.kept.0);
        (self.kept.0 > 0.0).then_some(other)
    }
}

/// The surfaces of a tube with its near half taken away, coloured by strain energy density, in E; the
/// meridian at the angle `upwards` is uppermost.
pub fn opened(tube: &SplineTube, load: &Load, u: &[f64], upwards: f64) -> Vec<Surface> {
    looked_at(tube, load, u, upwards, &Look::half(tube))
}

/// The surfaces of a tube; the meridian at the angle `upwards` is uppermost.
pub fn looked_at(
    tube: &SplineTube,
    load: &Load,
    u: &[f64],
    upwards: f64,
    look: &Look,
) -> Vec<Surface> {
    let elements = tube.axial.elements();
    let sample = |along: f64, angle: f64, xi: f64| {
        let z = tube.axial.elements_on(along);
        let radius = tube.tube.inner_radius() + xi * tube.tube.thickness;
        let sample = tube.sample(load, u, Point { z, radius, angle });
        (sample.position, look.factor * look.field.of(&sample))
    };
    // Where every meridian is the same, one is sampled and turned.
    let axisymmetric = tube.sector.rings == 1;
    let known: RefCell<HashMap<[u64; 2], Seen>> = RefCell::default();
    let wall = |along: f64, angle: f64, xi: f64| {
        if !axisymmetric {
            let ([z, x, y], value) = sample(along, angle + upwards, xi);
            let (sin, cos) = upwards.sin_cos();
            return ([x * cos + y * sin, y * cos - x * sin, z], value);
        }
        // The same place, however it was come by.
        let place = [along, xi].map(|x| (x * f64::from(1u32 << 30)).round() as u64);
        let ([z, x, y], value) = *known
            .borrow_mut()
            .entry(place)
            .or_insert_with(|| sample(along, 0.0, xi));
        let (sin, cos) = angle.sin_cos();
        ([x * cos - y * sin, x * sin + y * cos, z], value)
    };
    let opening = match look.points {
        Points::Evenly(points) => Opening::uniform(look.kept, points),
        Points::Within(tolerance) => {
            let meshed = Meshed {
                elements: [elements, tube.wall.elements()],
                axisymmetric,
            };
            tolerance.opening(look.kept, meshed, wall)
        }
    };
    opening.surfaces(|zeta, angle, xi| wall(zeta * elements as f64, angle, xi))
}
