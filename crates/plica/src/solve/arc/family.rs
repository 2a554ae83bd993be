//! Families of problems with a parameter.

use super::super::equilibrium::Equilibrium;

/// A family of equilibrium problems with a parameter λ, all with the same unknowns. Problem, load and prescribed values are
/// smooth functions of λ.
pub trait Family {
    /// A problem of the family.
    type Problem: Equilibrium;

    /// Returns the problem and its load at a value of the parameter; none if there is none.
    fn at(&self, parameter: f64) -> Option<(Self::Problem, <Self::Problem as Equilibrium>::Load)>;
}

/// One problem under loads on the straight line through two.
#[derive(Clone, Debug)]
pub struct LoadFamily<P: Equilibrium> {
    /// The problem.
    pub problem: P,
    /// The two loads.
    pub loads: [P::Load; 2],
    /// The values of the parameter at which they hold.
    pub range: [f64; 2],
}

impl<P: Equilibrium + Clone> Family for LoadFamily<P> {
    type Problem = P;

    fn at(&self, parameter: f64) -> Option<(P, P::Load)> {
        let ([from, to], [a, b]) = (&self.loads, self.range);
        let load = self.problem.between(from, to, (parameter - a) / (b - a));
        Some((self.problem.clone(), load))
    }
}
