//! Colour ranges and extreme values of fields, from the same points in every picture, page and animation.

use super::Field;
use crate::draw::{DrawError, Range, ResolvedRange, Spread};
use crate::sampled_tube::{SampledState, SampledTube};
use plica::assembly::{Point, SplineTube};
use plica::saved_state::SavedState;
use plica::study::Plan;
use rayon::prelude::*;
use std::borrow::Borrow;
use std::f64::consts::TAU;

/// Minimum number of intervals between the points along the tube.
const ALONG: usize = 120;
/// Points through the wall: of an axisymmetric tube, and of any other.
const THROUGH: [usize; 2] = [9, 5];
/// Points around a tube that is not axisymmetric.
const AROUND: usize = 32;

/// Spreads of all fields in one or several states, without dimension.
///
/// The points depend on the mesh alone, and the spread of several states is the smallest that contains those of each. The
/// scale of a state therefore does not depend on the size, the view or the cut of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldScales {
    /// In the order of [`Field::ALL`]; none for a field without a finite value.
    spreads: [Option<Spread>; Field::ALL.len()],
}

impl FieldScales {
    /// Evaluates all fields of a state.
    pub(crate) fn of(state: &SampledState<'_>) -> Self {
        let mut values = vec![vec![]; Field::ALL.len()];
        for point in points(state.tube()) {
            let sample = state.at(point);
            for (values, field) in values.iter_mut().zip(Field::ALL) {
                values.push(field.of(&sample));
            }
        }
        let mut scales = Self::default();
        for (spread, values) in scales.spreads.iter_mut().zip(values) {
            *spread = Spread::of(values.into_iter());
        }
        scales
    }

    /// Evaluates all fields of several states of a plan.
    pub fn of_states<S: Borrow<SavedState>>(
        plan: &Plan,
        states: impl ParallelIterator<Item = S>,
    ) -> Self {
        let tube = SampledTube::of(plan);
        let of = |state: S| Self::of(&tube.state(&state.borrow().load, &state.borrow().u));
        let scales: Vec<Self> = states.map(of).collect();
        Self::union(scales)
    }

    /// Returns the scales of several states together.
    pub fn union(all: impl IntoIterator<Item = Self>) -> Self {
        all.into_iter().fold(Self::default(), |mut both, other| {
            for (spread, other) in both.spreads.iter_mut().zip(other.spreads) {
                *spread = match (*spread, other) {
                    (Some(a), Some(b)) => Some(a.union(b)),
                    (one, other) => one.or(other),
                };
            }
            both
        })
    }

    /// Returns the colour range of a field and its extreme values in the unit of [`Field::label`], with the ends of the
    /// colours given or by the rule of the field.
    ///
    /// # Errors
    /// [`DrawError::Empty`] if no value is finite, [`DrawError::Range`] for an invalid given range.
    pub fn range(
        &self,
        field: Field,
        plan: &Plan,
        given: Option<[f64; 2]>,
    ) -> Result<ResolvedRange, DrawError> {
        let index = Field::ALL.iter().position(|one| *one == field);
        let spread = index.and_then(|index| self.spreads[index]);
        let rule = match given {
            Some([low, high]) => Range::Given(low, high),
            None => field.range(),
        };
        rule.of(spread.map(|spread| spread.times(field.label(plan).1)))
    }
}

/// Returns the points at which fields are evaluated.
fn points(tube: &SplineTube) -> Vec<Point> {
    let elements = tube.axial.elements().max(1);
    let z = tube
        .axial
        .positions(elements * ALONG.div_ceil(elements) + 1);
    let sector = &tube.sector;
    let axisymmetric = sector.rings == 1;
    let radii = tube.wall.positions(THROUGH[usize::from(!axisymmetric)]);
    let sectors = sector.around / sector.rings.max(1);
    let angles = if axisymmetric {
        1
    } else {
        AROUND.div_ceil(sectors).max(4)
    };
    let mut points = vec![];
    for j in 0..angles {
        let angle = TAU * j as f64 / (angles * sectors) as f64;
        for &radius in &radii {
            points.extend(z.iter().map(|&z| Point { z, radius, angle }));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use plica::tube::Symmetry;

    #[test]
    fn scales_are_those_of_the_field_in_the_unit_of_its_label() {
        use plica::study::{LengthUnit, StressUnit, Units};
        let mut plan = fixture::plan(Symmetry::Fold(4));
        let state = fixture::state(&plan, 1);
        let scales = FieldScales::of_states(&plan, [&state].into_par_iter());
        let bare = scales.range(Field::Displacement, &plan, None).unwrap();
        // The displacement (0.1 z², 0.2 zr, 0.3 zr) is largest at z = 1, r = 1/2, and coarsely represented.
        assert!((bare.max - 0.0425_f64.sqrt()).abs() < 0.01, "{bare:?}");
        assert!(bare.min == 0.0 && bare.high <= bare.max + 0.05);
        plan.units = Some(Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 20.0,
        });
        let found = scales.range(Field::Displacement, &plan, None).unwrap();
        assert!((found.max / bare.max - 25.0).abs() < 1e-12);
        let given = scales.range(Field::Displacement, &plan, Some([1.0, 2.0]));
        let given = given.unwrap();
        assert_eq!([given.low, given.high, given.max], [1.0, 2.0, found.max]);
        assert!(
            scales
                .range(Field::Displacement, &plan, Some([2.0, 1.0]))
                .is_err()
        );
    }
}
