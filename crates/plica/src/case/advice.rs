//! Advice on plans that are valid but perhaps not meant.

use crate::activation::Profile;
use crate::spline::{Circle, graded_breakpoints};
use crate::study::Plan;
use crate::tube::{Support, Symmetry};

/// Number of elements along a zone that resolves a fold.
const FINE: usize = 30;
/// Deviation from the circle, in D, that affects energies.
const ROUND: f64 = 1e-5;

/// Returns advice on a plan, a sentence each.
pub fn advice(plan: &Plan) -> Vec<String> {
    let mut advice = Vec::new();
    let (tube, mesh) = (&plan.tube, &plan.mesh);
    let breakpoints = graded_breakpoints(tube.length, mesh.elements()[0], &mesh.refinements);
    for muscle in &tube.muscles {
        let [from, to] = muscle.zone;
        let middle = |w: &[f64]| 0.5 * (w[0] + w[1]);
        let inside = |w: &&[f64]| from < middle(w) && middle(w) < to;
        let across = breakpoints.windows(2).filter(inside).count();
        let name = &muscle.name;
        if across < FINE {
            advice.push(format!(
                "the zone of muscles.{name} is only {across} elements long; a fold needs {FINE} or more"
            ));
        }
        if muscle.profile == Profile::HalfSine {
            advice.push(format!(
                "the half-sine profile of muscles.{name} has kinks at the edges of its zone"
            ));
        }
    }
    let error = Circle::new(mesh.degree, mesh.around).error;
    if error > ROUND {
        advice.push(format!(
            "{} splines of degree {} around approximate the circle to {error:.1e} only",
            mesh.around, mesh.degree
        ));
    }
    if mesh.degree < 3 {
        advice.push(format!(
            "splines of degree {} lock in a nearly incompressible wall",
            mesh.degree
        ));
    }
    let held = |support: Support| tube.ends.contains(&support);
    if !held(Support::Fixed) {
        let motion = match (plan.symmetry, held(Support::Sliding)) {
            (Symmetry::Axisymmetric, true) => "turn",
            (Symmetry::Axisymmetric, false) => "turn and drift along its axis",
            (_, true) => "turn and drift sideways",
            (_, false) => "turn and drift",
        };
        advice.push(format!(
            "no end is fixed: nothing keeps the tube from starting to {motion}"
        ));
    }
    advice
}
