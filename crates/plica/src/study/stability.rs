//! Which circumferential harmonics an axisymmetric state is unstable to.

use super::TubeProblem;
use crate::solve::State;
use crate::tube::Load;
use rayon::prelude::*;

/// Circumferential displacement, in D, from which a tube counts as twisted.
const TWISTED: f64 = 1e-9;

/// Displacement from ring to ring, in D, up to which a tube counts as axisymmetric.
const ROUND: f64 = 1e-9;

/// Negative eigenvalues of the tangent, harmonic by harmonic, as `harmonic:count`, or none.
///
/// For an axisymmetric state without twist the harmonics 0 to `harmonics` are looked at, whatever
/// the symmetry of the run: in an axisymmetric run 0 is the run's own tangent, all others are blocks
/// of the whole tube's (1 tilts or shifts sideways, 2 turns oval, and so on). Of any other state only
/// the run's own tangent is, whose eigenvalues cannot be told apart by harmonic and are listed as
/// `any:count`: all of them in an axisymmetric run, else those that the solver met.
pub fn unstable_harmonics(problem: &TubeProblem, state: &State<Load>, harmonics: usize) -> String {
    let tube = &problem.tube;
    let (own, k) = (state.negative_pivots, tube.sector.rings);
    let round = state
        .u
        .chunks_exact(k)
        .all(|rings| rings.iter().all(|x| (x - rings[0]).abs() <= ROUND));
    let of_ring: Vec<f64> = state.u.iter().step_by(k).copied().collect();
    let twisted = of_ring.iter().skip(2).step_by(3).any(|u| u.abs() > TWISTED);
    if !round || (twisted && k > 1) {
        return if own == 0 {
            "none".into()
        } else {
            format!("any:{own}")
        };
    }
    let looked_at = if twisted {
        0
    } else {
        harmonics.min((tube.sector.around - 1) / 2)
    };
    // The blocks of an axisymmetric state are those of its ring alone.
    let ring = (k > 1).then(|| tube.of_one_ring());
    let ring = ring.as_ref().unwrap_or(tube);
    let negative = |n: usize| {
        let mut tangent = match n {
            0 => ring.tangent(&state.load, &of_ring),
            n => ring.harmonic_tangent(&state.load, &of_ring, n),
        };
        tangent.constrain(&ring.given_in_harmonic(n));
        // A singular block is at the edge of stability; it counts as lost.
        tangent
            .factor()
            .map_or(1, |factor| factor.negative_pivots())
    };
    let mut counts = vec![(0, if k == 1 { own } else { negative(0) })];
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
