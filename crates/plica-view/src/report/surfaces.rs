//! Surfaces of a tube cut open.

use super::Field;
use super::sampling::{MeshInfo, Sampled, Tolerance};
use crate::draw::{Cutaway, DrawError, Opening, REAR_HALF, ResolvedRange, Surface};
use crate::sampled_tube::SampledState;
use plica::assembly::{Point, SplineTube};
use plica::tube::Load;
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The part of a tube that is drawn, its sampling and its field.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceOptions {
    /// Range of angles of the part that is kept, in radians.
    pub kept: (f64, f64),
    /// Sampling points.
    pub sampling: Sampling,
    /// Field of the colours.
    pub field: Field,
    /// Factor for the values of the field.
    pub factor: f64,
}

/// Sampling points of a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sampling {
    /// Equally spaced points along the tube, around the kept part and through the wall.
    Uniform([usize; 3]),
    /// As many points as the tolerance requires.
    Adaptive(Tolerance),
}

/// Minimum number of intervals along a tube.
const MIN_ALONG: usize = 200;
/// Minimum number of intervals along a tube whose bounds are sought.
const COARSE_ALONG: usize = 160;

/// Maximum error of the drawn wall in pixels; subdividing along, merging along and subdividing around may use a third each.
const MAX_ERROR_PIXELS: f64 = 0.4;
/// Maximum error of the drawn field, relative to the colour range.
const MAX_ERROR_COLOUR: f64 = 0.03;

impl SurfaceOptions {
    /// Removes the near half and selects the strain energy density.
    pub fn half(tube: &SplineTube) -> Self {
        // Long elements are curved and need at least two intervals.
        let elements = tube.axial.elements();
        let along = elements * MIN_ALONG.div_ceil(elements.max(1)).max(2);
        Self {
            kept: REAR_HALF,
            sampling: Sampling::Uniform([along + 1, 97, 13]),
            field: Field::EnergyDensity,
            factor: 1.0,
        }
    }

    /// Sets the removed angle in degrees: 180 removes the near half, 90 its upper quarter, 0 nothing.
    #[must_use]
    pub fn cut(mut self, degrees: f64) -> Self {
        self.kept = (degrees.to_radians(), TAU);
        self
    }

    /// Selects a coarse uniform sampling, which serves to find the bounds.
    #[must_use]
    pub fn coarse(mut self, tube: &SplineTube) -> Self {
        let elements = tube.axial.elements();
        let along = elements * COARSE_ALONG.div_ceil(elements.max(1));
        let around = if tube.sector.rings == 1 { 33 } else { 49 };
        self.sampling = Sampling::Uniform([along + 1, around, 2]);
        self
    }

    /// Selects an adaptive sampling for a picture `width` pixels wide with a colour range. `coarse` is the same picture with a
    /// coarse sampling.
    ///
    /// # Errors
    /// As [`Cutaway::png`].
    pub fn fine(
        mut self,
        coarse: &Cutaway,
        range: ResolvedRange,
        width: usize,
    ) -> Result<Self, DrawError> {
        self.sampling = Sampling::Adaptive(Tolerance {
            position: MAX_ERROR_PIXELS / coarse.pixels_per_unit(width)?,
            value: MAX_ERROR_COLOUR,
            colours: (range.low, range.high),
        });
        Ok(self)
    }

    /// Returns the options for the part removed by [`SurfaceOptions::cut`], if any.
    pub fn removed(&self) -> Option<Self> {
        let mut other = *self;
        other.kept = (0.0, self.kept.0);
        (self.kept.0 > 0.0).then_some(other)
    }
}

/// Returns the surfaces of a tube without its near half and with the strain energy density in units of E; the angle `upwards`
/// points up.
pub fn open_tube_surfaces(tube: &SplineTube, load: &Load, u: &[f64], upwards: f64) -> Vec<Surface> {
    let state = SampledState::without_contact(tube, load, u);
    tube_surfaces(&state, upwards, &SurfaceOptions::half(tube))
}

/// Returns the surfaces of a tube; the angle `upwards` points up.
pub(super) fn tube_surfaces(
    state: &SampledState<'_>,
    upwards: f64,
    look: &SurfaceOptions,
) -> Vec<Surface> {
    let tube = state.tube();
    let elements = tube.axial.elements();
    let sample = |along: f64, angle: f64, xi: f64| {
        let z = tube.axial.position(along);
        let radius = tube.tube.inner_radius() + xi * tube.tube.thickness;
        let sample = state.at(Point { z, radius, angle });
        (sample.position, look.factor * look.field.of(&sample))
    };
    // An axisymmetric tube is sampled on one meridian, which is rotated.
    let axisymmetric = tube.sector.rings == 1;
    let cache: RefCell<HashMap<[u64; 2], Sampled>> = RefCell::default();
    let wall = |along: f64, angle: f64, xi: f64| {
        if !axisymmetric {
            let ([z, x, y], value) = sample(along, angle + upwards, xi);
            let (sin, cos) = upwards.sin_cos();
            return ([x * cos + y * sin, y * cos - x * sin, z], value);
        }
        // Rounded coordinates, so that equal points are found in the cache.
        let key = [along, xi].map(|x| (x * f64::from(1u32 << 30)).round() as u64);
        let ([z, x, y], value) = *cache
            .borrow_mut()
            .entry(key)
            .or_insert_with(|| sample(along, 0.0, xi));
        let (sin, cos) = angle.sin_cos();
        ([x * cos - y * sin, x * sin + y * cos, z], value)
    };
    let opening = match look.sampling {
        Sampling::Uniform(points) => Opening::uniform(look.kept, points),
        Sampling::Adaptive(tolerance) => {
            let meshed = MeshInfo {
                elements: [elements, tube.wall.elements()],
                axisymmetric,
            };
            tolerance.opening(look.kept, meshed, wall)
        }
    };
    opening.surfaces(|zeta, angle, xi| wall(zeta * elements as f64, angle, xi))
}
