//! Which circumferential harmonics an axisymmetric state is unstable to.

use super::TubeProblem;
use crate::solve::State;
use crate::tube::Load;
use rayon::prelude::*;

/// Circumferential displacement, in D, from which a tube counts as twisted.
const TWISTED: f64 = 1e-9;

/// Negative eigenvalues of the tangent, harmonic by harmonic, as `harmonic:count`, or none.
///
/// For an axisymmetric run without twist the harmonics 0 to `harmonics` are looked at: 0 is the
/// run's own tangent, the others are blocks of the whole tube's (1 tilts or shifts sideways, 2
/// turns oval, and so on). For any other run only the run's own tangent is, whose eigenvalues
/// cannot be told apart by harmonic and are listed as `any:count`.
pub fn unstable_harmonics(problem: &TubeProblem, state: &State<Load>, harmonics: usize) -> String {
    let tube = &problem.tube;
    let own = state.negative_pivots;
    if tube.sector.rings > 1 {
        return if own == 0 {
            "none".into()
        } else {
            format!("any:{own}")
        };
    }
    let twisted = state.u.iter().skip(2).step_by(3).any(|u| u.abs() > TWISTED);
    let looked_at = if twisted {
        0
    } else {
        harmonics.min((tube.sector.around - 1) / 2)
    };
    let negative = |n: usize| {
        let mut tangent = tube.harmonic_tangent(&state.load, &state.u, n);
        tangent.constrain(&tube.given_in_harmonic(n));
        // A singular block is at the edge of stability; it counts as lost.
        tangent
            .factor()
            .map_or(1, |factor| factor.negative_pivots())
    };
    let mut counts = vec![(0, own)];
    counts.par_extend((1..=looked_at).into_par_iter().map(|n| (n, negative(n))));
    let lost: Vec<String> = counts
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(n, count)| format!("{n}:{count}"))
        .collect();
    if lost.is_empty() {
        "none".into()
    } else {
        lost.join(" ")
    }
}
