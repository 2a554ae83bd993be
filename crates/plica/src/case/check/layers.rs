//! The layers of the wall.

use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::law::{fibres, matrix, with_fibres};
use super::material::{tone, youngs_modulus};
use super::muscles::is_name;
use super::residual::residuals;
use super::zone::length;
use crate::activation::Muscle;
use crate::tube::{MeshLayer, WallLayer};

/// Thickness of the wall, in D, if the case does not give it.
const THICKNESS: f64 = 0.06;
/// Relative difference between the thickness of the wall and the sum of those of its layers that rounding may cause.
const SAME: f64 = 1e-6;
/// Least thickness of a layer over that of the wall.
const THINNEST: f64 = 1e-3;

/// Returns the thickness of the wall, in D: as it is given, or that of its layers.
pub(super) fn whole_thickness(case: &Case, problems: &mut Problems) -> f64 {
    let diameter = case.tube.diameter;
    let given = case.tube.thickness.map(|x| x / diameter);
    if case.layers.is_empty() {
        return given.unwrap_or(THICKNESS);
    }
    let sum: f64 = case.layers.iter().map(|layer| layer.thickness).sum();
    let sum = sum / diameter;
    if let Some(given) = given
        && (given - sum).abs() > SAME * sum
        && problems.are_sound(&["tube.thickness", "tube.diameter", "layers"])
    {
        let rule = format!("its layers are {} thick together", length(case, sum));
        problems.value("tube.thickness", rule, "leave it out, or change a layer");
    }
    sum
}

/// Returns the layers of the wall.
pub(super) fn layers(
    case: &Case,
    thickness: f64,
    muscles: &[Muscle],
    problems: &mut Problems,
) -> Vec<WallLayer> {
    let modulus = youngs_modulus(case);
    if case.layers.is_empty() {
        let own = &case.material;
        let law = matrix(&own.law, "material", modulus, problems);
        let fibres = fibres(&own.fibres, "material", modulus, problems);
        check_places(case, &[], problems);
        return vec![WallLayer::of(with_fibres(law, fibres, None))];
    }
    let names: Vec<String> = (0..case.layers.len()).map(|i| name(case, i)).collect();
    check_names(&names, problems);
    check_places(case, &names, problems);
    let share = |layer: &keys::WallLayer| layer.thickness / case.tube.diameter / thickness;
    let residuals = residuals(case, thickness, problems);
    let layers = case.layers.iter().enumerate().map(|(i, layer)| {
        let path = format!("layers[{}]", i + 1);
        let (own, key) = match &layer.material {
            Some(own) => (own, format!("{path}.material")),
            None => (&case.material, "material".to_owned()),
        };
        let law = matrix(&own.law, &key, modulus, problems);
        let mut families = fibres(&own.fibres, &key, modulus, problems);
        let key = format!("{path}.fibres");
        families.extend(fibres(&layer.fibres, &key, modulus, problems));
        let tone = layer
            .tone
            .as_ref()
            .and_then(|own| tone(own, &format!("{path}.tone"), case, problems));
        let key = format!("{path}.thickness");
        if share(layer) < THINNEST && problems.are_sound(&["layers"]) {
            let rule = "must be at least a thousandth of that of the wall";
            problems.value(&key, rule, "join it with the next layer");
        }
        WallLayer {
            name: names[i].clone(),
            share: share(layer),
            material: with_fibres(law, families, tone),
            residual: residuals[i],
            idle_muscles: idle(case, muscles, &names[i]),
        }
    });
    layers.collect()
}

/// Returns the elements of the layers; none for a wall of one layer.
pub(super) fn mesh_layers(case: &Case, layers: &[WallLayer]) -> Vec<MeshLayer> {
    if layers.len() < 2 {
        return vec![];
    }
    let pairs = layers.iter().zip(&case.layers);
    let mesh_layer = |(layer, written): (&WallLayer, &keys::WallLayer)| MeshLayer {
        share: layer.share,
        elements: written.elements,
    };
    pairs.map(mesh_layer).collect()
}

/// Returns the name of a layer.
fn name(case: &Case, i: usize) -> String {
    let given = case.layers[i].name.clone();
    given.unwrap_or(format!("layer-{}", i + 1))
}

fn check_names(names: &[String], problems: &mut Problems) {
    for (i, name) in names.iter().enumerate() {
        let key = format!("layers[{}].name", i + 1);
        if !problems.are_sound(&[&key]) {
            continue;
        }
        if !is_name(name) {
            let rule = "must consist of letters, digits, - and _, at most 40 of them";
            problems.value(&key, rule, "try media");
        } else if names[..i].contains(name) {
            problems.value(&key, "another layer has this name", "choose another name");
        }
    }
}

/// Checks that the layers that muscles name exist.
fn check_places(case: &Case, names: &[String], problems: &mut Problems) {
    for (muscle, written) in &case.muscles {
        let key = format!("{}.layer", super::super::key::join("muscles", muscle));
        let Some(layer) = &written.layer else {
            continue;
        };
        if names.contains(layer) || !problems.are_sound(&[&key, "layers"]) {
            continue;
        }
        let help = match names {
            [] => "add [[layers]], or leave it out".to_owned(),
            names => format!("the layers are {}", names.join(", ")),
        };
        problems.value(&key, "no layer has this name", help);
    }
}

/// Returns the muscles that act in another layer only.
fn idle(case: &Case, muscles: &[Muscle], name: &str) -> Vec<usize> {
    let elsewhere = |muscle: &Muscle| {
        let layer = case
            .muscles
            .get(&muscle.name)
            .and_then(|m| m.layer.as_ref());
        layer.is_some_and(|layer| layer != name)
    };
    let muscles = muscles.iter().enumerate();
    muscles
        .filter(|(_, muscle)| elsewhere(muscle))
        .map(|(m, _)| m)
        .collect()
}
