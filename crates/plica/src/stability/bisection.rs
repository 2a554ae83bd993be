//! Bisection of the path between two states that differ in stability.

use super::{Harmonics, Quantity, StabilityError, Transition};
use crate::equilibrium::TubeProblem;
use crate::monitor::Monitor;
use crate::solve::{ContinuationState, Method, Path, Segment, Settings, State};
use crate::tube::Load;

/// Largest difference of two solutions that count as the same state, in D.
const SAME: f64 = 1e-4;
/// Maximum number of halvings; the loads hardly differ beyond it.
const HALVINGS: usize = 48;

/// A state of the path.
#[derive(Clone, Debug)]
pub struct Point {
    pub along: f64,
    pub load: Load,
    pub u: Vec<f64>,
    /// History of friction.
    pub history: Vec<f64>,
    /// Number of negative eigenvalues of every circumferential mode.
    pub negative: Vec<usize>,
}

/// Two neighbouring states that differ in stability.
#[derive(Clone, Debug)]
pub struct Bracket {
    pub ends: [Point; 2],
    pub transition: Transition,
}

/// Computes states between two states of a run.
pub struct Bisection<'a> {
    pub problem: &'a TubeProblem,
    pub harmonics: &'a Harmonics,
    pub settings: &'a Settings,
    pub quantity: Quantity,
    pub tolerance: f64,
}

/// A state that was found between two others.
struct Found {
    state: State<Load>,
    /// History of friction.
    history: Vec<f64>,
    method: Method,
}

/// Result of following the path from one state to the load of another.
struct Connection {
    transition: Transition,
    /// True if the path ends at the other state.
    reaches: bool,
}

impl Bisection<'_> {
    /// Returns all brackets between two neighbouring states of a run, in the order of the path.
    ///
    /// # Errors
    /// [`StabilityError::Cancelled`] if the monitor cancels.
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
        // The bisection is meaningful only if the path from `a` reaches the state of the run.
        let connection = self.connect(a, b, monitor)?;
        match connection.transition {
            _ if connection.reaches => self.narrow(a, b, HALVINGS, &mut found, monitor)?,
            Transition::Unfollowed => found.push(bracket(a, b, Transition::Unfollowed)),
            _ => found.push(bracket(a, b, Transition::Snap)),
        }
        Ok(found)
    }

    /// Bisects until the brackets are narrower than the tolerance.
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
            let connection = self.connect(a, b, monitor)?;
            let transition = match connection.transition {
                Transition::Smooth if !connection.reaches => Transition::Snap,
                transition => transition,
            };
            found.push(bracket(a, b, transition));
            return Ok(());
        }
        let Some(Found { state, history, .. }) = self.advance(a, b, 0.5, monitor)? else {
            found.push(bracket(a, b, Transition::Unfollowed));
            return Ok(());
        };
        let middle = Point {
            along: 0.5 * (a.along + b.along),
            negative: self.harmonics.negative(&state.load, &state.u),
            load: state.load,
            u: state.u,
            history,
        };
        self.narrow(a, &middle, halvings - 1, found, monitor)?;
        self.narrow(&middle, b, halvings - 1, found, monitor)
    }

    /// Follows the path from one state to the load of another.
    fn connect(
        &self,
        a: &Point,
        b: &Point,
        monitor: &mut dyn Monitor,
    ) -> Result<Connection, StabilityError> {
        let Some(end) = self.advance(a, b, 1.0, monitor)? else {
            return Ok(Connection {
                transition: Transition::Unfollowed,
                reaches: false,
            });
        };
        let apart = end.state.u.iter().zip(&b.u).map(|(x, y)| (x - y).abs());
        Ok(Connection {
            transition: match end.method {
                Method::Relaxation => Transition::Snap,
                _ => Transition::Smooth,
            },
            reaches: apart.fold(0.0, f64::max) <= SAME,
        })
    }

    /// Returns the state at the fraction `t` of the load step between two states; none if no equilibrium was found.
    fn advance(
        &self,
        a: &Point,
        b: &Point,
        t: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<Found>, StabilityError> {
        let begun = Path::resume(
            self.problem.clone(),
            Segment::between(a.load.clone(), a.load.clone()),
            a.load.clone(),
            a.u.clone(),
            ContinuationState::at_start(vec![0.0; a.u.len()], a.history.clone()),
            self.settings.clone(),
        );
        let Ok(mut path) = begun else {
            return Ok(None);
        };
        path.begin_segment(b.load.clone());
        let step = match path.advance(t, monitor) {
            Ok(step) => step,
            Err(error) if error.is_cancelled() => return Err(StabilityError::Cancelled),
            Err(_) => return Ok(None),
        };
        Ok(Some(Found {
            state: path.state().clone(),
            history: path.history().to_vec(),
            method: step.method,
        }))
    }
}

fn bracket(a: &Point, b: &Point, transition: Transition) -> Bracket {
    Bracket {
        ends: [a.clone(), b.clone()],
        transition,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::SplineTube;
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Mesh, Support, Tube, WallLayer};

    #[test]
    fn a_critical_pressure_is_narrowed_to_the_tolerance_times_the_pressure() {
        let tube = Tube {
            length: 0.1,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.3,
            )))],
            muscles: vec![],
            ends: [Support::Sliding; 2],
            imperfections: vec![],
            obstacles: vec![],
            patches: vec![],
            foundations: vec![],
        };
        let mesh = Mesh {
            axial: 4,
            around: 24,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        let problem = TubeProblem::new(SplineTube::new(&tube, &mesh, 1));
        let harmonics = Harmonics::new(&problem, 2);
        let settings = Settings::default();
        let mut path = Path::begin(
            &problem,
            tube.rest(),
            vec![0.0; problem.tube.unknowns()],
            settings.clone(),
        )
        .unwrap();
        let mut load = tube.rest();
        load.pressures[1].follower = 1e-3;
        path.begin_segment(load);
        let mut point = |along: f64| {
            path.advance(along, &mut ()).unwrap();
            let state = path.state();
            Point {
                along,
                load: state.load.clone(),
                u: state.u.clone(),
                history: vec![],
                negative: harmonics.negative(&state.load, &state.u),
            }
        };
        let [a, b] = [0.25, 1.0].map(&mut point);
        assert_eq!(
            (&a.negative[..], &b.negative[..]),
            (&[0, 0, 0][..], &[0, 0, 1][..])
        );
        for tolerance in [1e-1, 1e-3] {
            let quantity = Quantity::Pressure(1);
            let bisection = Bisection {
                problem: &problem,
                harmonics: &harmonics,
                settings: &settings,
                quantity,
                tolerance,
            };
            let found = bisection.brackets(&a, &b, &mut ()).unwrap();
            let [bracket] = &found[..] else {
                panic!("{} brackets", found.len())
            };
            assert_eq!(bracket.transition, Transition::Smooth);
            let ends = &bracket.ends;
            let [from, to] = [0, 1].map(|i| quantity.of(&tube, &ends[i].load));
            assert!(from < to && to - from <= tolerance * to, "{from} {to}");
            // Not much further: each halving costs the eigenvalues of a state.
            assert!(to - from > 0.4 * tolerance * to, "{from} {to}");
            assert_eq!([0, 1].map(|i| ends[i].negative[2]), [0, 1]);
            for end in ends {
                let pressure = quantity.of(&tube, &end.load);
                assert!((end.along - pressure / 1e-3).abs() < 1e-12, "{}", end.along);
            }
            // Of a thin ring in plane strain.
            let thin = 0.25 * (0.06_f64 / 0.47).powi(3) / (1.0 - 0.3 * 0.3);
            assert!(from < 1.1 * thin && to > 0.9 * thin, "{from} {to} {thin}");
            assert!(bisection.brackets(&a, &a, &mut ()).unwrap().is_empty());
        }
    }
}
