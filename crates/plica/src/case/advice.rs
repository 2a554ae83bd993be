//! Advice on plans that are valid but perhaps not meant.

use crate::activation::Profile;
use crate::spline::Circle;
use crate::study::{Plan, Stage};
use crate::tube::{Support, Symmetry};

/// Number of elements along a zone that resolves a fold.
const FINE: usize = 30;
/// Growth stretch above which a wall is likely to cross itself. In the tube of Okino et al. (2025), contracted to a quarter, the
/// invaginated wall crosses itself from 6.5 on; the paper reaches 4.
const LARGEST_STRETCH: f64 = 6.0;
/// Deviation from the circle, in D, that affects energies.
const ROUND: f64 = 1e-5;

/// Returns advice on a plan, a sentence each.
pub fn advice(plan: &Plan) -> Vec<String> {
    let mut advice = Vec::new();
    let (tube, mesh) = (&plan.tube, &plan.mesh);
    let breakpoints = mesh.breakpoints_along(tube.length);
    for (m, muscle) in tube.muscles.iter().enumerate() {
        let [from, to] = muscle.zone;
        let stays = muscle.repeat.is_none() && !plan.shifts_muscle(m);
        let middle = |w: &[f64]| 0.5 * (w[0] + w[1]);
        let inside = |w: &&[f64]| from < middle(w) && middle(w) < to;
        let across = breakpoints.windows(2).filter(inside).count();
        let name = &muscle.name;
        // A muscle of the whole tube makes no fold by itself.
        let is_whole = from <= 0.0 && to >= tube.length;
        if stays && !is_whole && across < FINE {
            advice.push(format!(
                "the zone of muscles.{name} is only {across} elements long; a fold needs {FINE} or more"
            ));
        }
        let largest = largest_stretch(plan, muscle.name.as_str());
        if largest > LARGEST_STRETCH {
            let end = match plan.contact {
                true => "touches itself",
                false => "crosses itself, as there is no contact",
            };
            advice.push(format!(
                "muscles.{name} makes the wall grow {largest:.1}-fold within its zone; above about {LARGEST_STRETCH}-fold a wall \
                 usually folds until it {end}: choose a smaller target or a longer zone"
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
    advice.extend(super::ellipticity::advice(plan));
    advice
}

/// Returns the largest growth stretch that a muscle reaches in its zone at the end of a stage.
fn largest_stretch(plan: &Plan, name: &str) -> f64 {
    let Some(m) = plan.tube.muscles.iter().position(|m| m.name == name) else {
        return 1.0;
    };
    let muscle = &plan.tube.muscles[m];
    let loads = plan.stages.iter().flat_map(Stage::loads);
    let stretches = loads.map(|load| muscle.extreme_stretch(load.muscles[m], plan.tube.length));
    stretches.fold(1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::advice;

    #[test]
    fn a_growth_stretch_beyond_six_is_advised_against() {
        let stretched = |zone: &str, ratio: f64| {
            let text = format!(
                "[muscles.long]\ndirection = 'longitudinal'\nzone = {zone}\n\
                 [[stages]]\ndrive.long.length_ratio = {ratio}\n"
            );
            let plan = crate::case::read(&text, "case").unwrap();
            let advice = advice(&plan);
            advice
                .into_iter()
                .find(|line| line.contains("-fold within its zone"))
        };
        // The paper's tube grows fourfold in the middle of the zone.
        assert_eq!(stretched("[0.5, 1.0]", 1.25), None);
        assert_eq!(stretched("[0.5, 1.0]", 1.41), None);
        let line = stretched("[0.5, 1.0]", 1.43).unwrap();
        assert!(
            line.starts_with("muscles.long makes the wall grow 6.2-fold"),
            "{line}"
        );
        assert!(stretched("[0.5, 0.6]", 1.25).unwrap().contains("16.0-fold"));
    }
}
