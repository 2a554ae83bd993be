//! Advice on laws that lose ellipticity where a plan may use them.
//!
//! The elastic stretch that a stage may reach is estimated from its stress-free stretches: it is their inverse where the wall
//! keeps its length, and less far from one where it follows.

use super::tension_ellipticity::lost;
use crate::homogeneous::{MechanicalTest, loses_ellipticity};
use crate::study::{Plan, Scale};
use crate::tube::Load;

/// Points along the tube at which stress-free stretches are taken.
const POINTS: usize = 240;

/// Returns a sentence for each layer whose law loses ellipticity within the stretches of a stage.
pub(super) fn advice(plan: &Plan) -> Vec<String> {
    let of = |layer| of_layer(plan, layer).or_else(|| of_tensions(plan, layer));
    (0..plan.tube.layers.len()).filter_map(of).collect()
}

/// Returns the name of a layer in a sentence.
fn name(plan: &Plan, layer: usize) -> String {
    match plan.tube.layers.len() {
        1 => "the wall".into(),
        _ => format!("the layer {}", plan.tube.layers[layer].name),
    }
}

fn of_tensions(plan: &Plan, layer: usize) -> Option<String> {
    let lost = lost(plan, layer)?;
    let [along, around] = lost.stretches;
    let scale = Scale::of(plan.units.as_ref());
    Some(format!(
        "with the tension of muscles.{}, {} loses ellipticity at stretches of {along:.3} along and {around:.3} around the tube, \
         which stage {} may reach at a tension of {:.3} {}; bands would depend on the mesh",
        lost.muscle,
        name(plan, layer),
        plan.stages[lost.stage].name,
        lost.tension * scale.stress,
        scale.stress_name,
    ))
}

fn of_layer(plan: &Plan, layer: usize) -> Option<String> {
    // Ranges of the stages, along and around.
    let mut before = plan.first_load();
    let mut ranges = vec![];
    for stage in &plan.stages {
        let mut own = range(plan, layer, &before);
        for load in stage.loads() {
            let other = range(plan, layer, load);
            own = [0, 1].map(|i| [own[i][0].min(other[i][0]), own[i][1].max(other[i][1])]);
        }
        ranges.push(own);
        before = stage.load.clone();
    }
    let own = &plan.tube.layers[layer];
    let tests = [
        MechanicalTest::UniaxialAlong,
        MechanicalTest::UniaxialAround,
    ];
    for (direction, test) in tests.into_iter().enumerate() {
        for side in [0, 1] {
            let ends = ranges.iter().map(|range| range[direction][side]);
            let far = |a: f64, b: f64| if b.ln().abs() > a.ln().abs() { b } else { a };
            let limit = ends.fold(1.0, far);
            let Some(stretch) = loses_ellipticity(&own.material, test, limit) else {
                continue;
            };
            let reaches =
                |range: &[[f64; 2]; 2]| range[direction][side].ln().abs() >= stretch.ln().abs();
            let stage = ranges.iter().position(reaches).unwrap_or(0);
            let [low, high] = ranges[stage][direction];
            let way = ["along", "around"][direction];
            let name = name(plan, layer);
            return Some(format!(
                "the law of {name} loses ellipticity at a stretch of {stretch:.3} {way} the tube; stage {} may stretch it by \
                 {low:.3} to {high:.3} there, and creases or bands would depend on the mesh",
                plan.stages[stage].name
            ));
        }
    }
    None
}

/// Returns the least and the largest elastic stretch along and around where the wall keeps its shape under a load, 1
/// included.
fn range(plan: &Plan, layer: usize, load: &Load) -> [[f64; 2]; 2] {
    let tube = &plan.tube;
    let faces = tube.faces();
    let residual = [faces[layer], faces[layer + 1]].map(|r| tube.residual_stretch(layer, r));
    let [first, last] = load.ends.map(|end| end.displacement);
    let extension = 1.0 + (last - first) / tube.length;
    let mut ranges = [[1.0_f64; 2]; 2];
    for point in 0..=POINTS {
        let z = tube.length * point as f64 / POINTS as f64;
        let (along, around) = tube.stretches(layer, z, load);
        for residual in residual {
            let elastic = [
                extension / (along * residual[0]),
                1.0 / (around * residual[1]),
            ];
            for (range, x) in ranges.iter_mut().zip(elastic) {
                *range = [range[0].min(x), range[1].max(x)];
            }
        }
    }
    ranges
}

#[cfg(test)]
#[allow(non_snake_case)] // F
mod tests {
    use super::*;
    use crate::homogeneous::{Prescribed, Volume, homogeneous, least_wave_stiffness};
    use crate::material::{Composite, Material, Matrix, Tone};
    use crate::tensor::Tensor2;

    fn advice_on(layer: &str, drive: &str) -> Vec<String> {
        let text = format!(
            "[[layers]]\nthickness = 0.06\n{layer}\n[muscles.ring]\ndirection = 'circular'\nzone = [0.5, 1.0]\n\
             [[stages]]\nname = 'first'\nsteps = 1\n[[stages]]\nname = 'second'\n{drive}\n"
        );
        advice(&crate::case::read(&text, "case").unwrap())
    }

    #[test]
    fn a_falling_tension_is_advised_against_where_a_stage_reaches_it() {
        let tone = "tone = { tension = 1.0, best_stretch = 1.2, least_stretch = 0.8 }";
        let contract = "drive.ring.diameter_ratio = 0.6";
        let found = advice_on(tone, contract);
        let start = "the law of the wall loses ellipticity at a stretch of 1.";
        assert!(found.len() == 1 && found[0].starts_with(start), "{found:?}");
        let end = "around the tube; stage second may stretch it by 1.000 to 1.667 there, and creases or bands would \
            depend on the mesh";
        assert!(found[0].ends_with(end), "{found:?}");
        // Not where the stage does not reach it, nor with the laws of the paper.
        assert!(advice_on(tone, "drive.ring.diameter_ratio = 0.9").is_empty());
        assert!(advice_on("", "drive.ring.diameter_ratio = 0.25").is_empty());
        assert!(advice_on("", "drive.ileum.displacement = 3.0").is_empty());
    }

    #[test]
    fn a_driven_tension_is_advised_against_where_the_estimated_states_reach_its_fall() {
        let text = |tension: f64, volume: f64| {
            format!(
                "tube.length = 2.0\nends = {{ colon = 'sliding', ileum = 'sliding' }}\n[muscles.ring]\n\
                 direction = 'circular'\nzone = [0.5, 1.5]\n\
                 active_stress = {{ best_stretch = 1.1, least_stretch = 0.8 }}\n\
                 [[stages]]\nname = 'fill'\n\
                 drive.ring.tension = {tension}\ndrive.lumen.volume_ratio = {volume}\n"
            )
        };
        let on = |tension, volume| {
            let plan = crate::case::read(&text(tension, volume), "case").unwrap();
            (advice(&plan), plan)
        };
        // Independent of the estimate: the law with the tension, at the stretch of the middle of an incompressible wall.
        let least = |plan: &Plan, fraction: f64| {
            let muscle = plan.tube.muscles[0].active_stress.clone().unwrap();
            let Material::NeoHookean(law) = plan.tube.layers[0].material else {
                panic!("the law of the paper");
            };
            let tones = vec![Tone::new(3.0 * fraction, muscle.relation, 0.0)];
            let law = Composite::of(Matrix::NeoHookean(law));
            let law = Material::Composite(Composite { tones, ..law });
            let (inner, middle) = (0.44_f64, 0.47_f64);
            let around = (1.0 + 1.6 * fraction * (inner / middle).powi(2)).sqrt();
            let prescribed = Prescribed {
                along: Some(1.0),
                around: Some(around),
            };
            let [along, outwards, _] = homogeneous(&law, prescribed, Volume::Free)
                .unwrap()
                .stretches;
            let F = Tensor2([[along, 0.0, 0.0], [0.0, outwards, 0.0], [0.0, 0.0, around]]);
            (around, least_wave_stiffness(&law, &F))
        };
        let (found, plan) = on(3.0, 2.6);
        let start = "with the tension of muscles.ring, the wall loses ellipticity at stretches of 1.000 along and 1.";
        assert!(found.len() == 1 && found[0].starts_with(start), "{found:?}");
        assert!(found[0].contains("which stage fill may reach at a tension of"));
        assert!(found[0].ends_with(" E; bands would depend on the mesh"));
        let stretch: f64 = found[0][start.len() - 2..][..5].parse().unwrap();
        let states = (1..=16).map(|n| least(&plan, f64::from(n) / 16.0));
        let first = states.into_iter().find(|(_, least)| *least <= 0.0).unwrap();
        assert!(
            (stretch - first.0).abs() < 6e-4 && stretch > 1.1,
            "{stretch} {first:?}"
        );
        // Neither with a smaller volume, nor with a tension that the wall bears.
        assert!(on(3.0, 1.1).0.is_empty());
        assert!(on(0.05, 2.6).0.is_empty());
    }
}
