//! Between two states of a run that differ in stability.

use super::{Harmonics, How, Quantity, StabilityError};
use crate::equilibrium::TubeProblem;
use crate::monitor::Monitor;
use crate::solve::{Method, Path, Settings, State};
use crate::tube::Load;

/// Largest distance of two solutions that are the same state, in D.
const SAME: f64 = 1e-4;
/// Halvings at most: beyond, loads no longer differ.
const HALVINGS: usize = 48;

/// A state on the way.
#[derive(Clone, Debug)]
pub struct Point {
    pub along: f64,
    pub load: Load,
    pub u: Vec<f64>,
    /// Negative eigenvalues of every harmonic.
    pub negative: Vec<usize>,
}

/// Two states close together that differ in stability.
#[derive(Clone, Debug)]
pub struct Bracket {
    pub ends: [Point; 2],
    pub how: How,
}

/// Goes between states.
pub struct Bisection<'a> {
    pub problem: &'a TubeProblem,
    pub harmonics: &'a Harmonics<'a>,
    pub settings: &'a Settings,
    pub quantity: Quantity,
    pub tolerance: f64,
}

/// Whether and how one state leads to another.
enum Way {
    Smooth,
    Snap,
    Lost,
}

impl Bisection<'_> {
    /// All brackets between two neighbouring states of a run, in order.
    ///
    /// # Errors
    /// [`StabilityError::Stopped`] if someone asks to.
    pub fn brackets(
        &self,
        a: &Point,
        b: &Point,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Bracket>, StabilityError> {
        let mut found = vec![];
        if a.negative == b.negative {
            return Ok(found);
        }
        // A path that begins anew must lead where the run went, or what lies between is another's.
        match self.way(a, b, monitor)? {
            (_, true) => self.narrow(a, b, HALVINGS, &mut found, monitor)?,
            (Way::Lost, _) => found.push(bracket(a, b, How::Unfollowed)),
            _ => found.push(bracket(a, b, How::Snap)),
        }
        Ok(found)
    }

    fn narrow(
        &self,
        a: &Point,
        b: &Point,
        halvings: usize,
        found: &mut Vec<Bracket>,
        monitor: &mut dyn Monitor,
    ) -> Result<(), StabilityError> {
        if a.negative == b.negative {
            return Ok(());
        }
        let tube = &self.problem.tube.tube;
        let [from, to] = [a, b].map(|point| self.quantity.of(tube, &point.load));
        let unit = if self.quantity.is_pressure() {
            from.abs().max(to.abs())
        } else {
            1.0
        };
        if (to - from).abs() <= self.tolerance * unit || halvings == 0 {
            let how = match self.way(a, b, monitor)? {
                (Way::Smooth, true) => How::Smooth,
                (Way::Lost, _) => How::Unfollowed,
                _ => How::Snap,
            };
            found.push(bracket(a, b, how));
            return Ok(());
        }
        let Some((state, _)) = self.go(a, b, 0.5, monitor)? else {
            found.push(bracket(a, b, How::Unfollowed));
            return Ok(());
        };
        let middle = Point {
            along: 0.5 * (a.along + b.along),
            negative: self.harmonics.negative(&state.load, &state.u),
            load: state.load,
            u: state.u,
        };
        self.narrow(a, &middle, halvings - 1, found, monitor)?;
        self.narrow(&middle, b, halvings - 1, found, monitor)
    }

    /// How the path from one state leads to the load of another, and whether to that state.
    fn way(
        &self,
        a: &Point,
        b: &Point,
        monitor: &mut dyn Monitor,
    ) -> Result<(Way, bool), StabilityError> {
        let Some((end, method)) = self.go(a, b, 1.0, monitor)? else {
            return Ok((Way::Lost, false));
        };
        let apart = end.u.iter().zip(&b.u).map(|(x, y)| (x - y).abs());
        let way = match method {
            Method::Relaxation => Way::Snap,
            _ => Way::Smooth,
        };
        Ok((way, apart.fold(0.0, f64::max) <= SAME))
    }

    /// Part of the way from one state to the load of another; none if the tube is lost.
    fn go(
        &self,
        a: &Point,
        b: &Point,
        t: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<(State<Load>, Method)>, StabilityError> {
        let begun = Path::begin(
            self.problem,
            a.load.clone(),
            a.u.clone(),
            self.settings.clone(),
        );
        let Ok(mut path) = begun else {
            return Ok(None);
        };
        path.begin_segment(b.load.clone());
        let step = match path.advance(t, monitor) {
            Ok(step) => step,
            Err(error) if error.is_cancelled() => return Err(StabilityError::Stopped),
            Err(_) => return Ok(None),
        };
        Ok(Some((path.state().clone(), step.method)))
    }
}

fn bracket(a: &Point, b: &Point, how: How) -> Bracket {
    Bracket {
        ends: [a.clone(), b.clone()],
        how,
    }
}
