//! The shape of the tube, its wall and its ends.

use super::super::problem::Problems;
use super::super::spec::{self, Spec};
use super::muscles::muscles;
use crate::material::{Material, NeoHookean, Volumetric};
use crate::tube::{Support, Tube};

/// The tube, dimensionless.
pub(super) fn tube(spec: &Spec, problems: &mut Problems) -> Tube {
    let diameter = spec.tube.diameter;
    let length = spec.tube.length.map_or(3.0, |x| x / diameter);
    let thickness = spec.tube.thickness.map_or(0.06, |x| x / diameter);
    if problems.none_about(&["tube.thickness", "tube.diameter"]) {
        if thickness >= 0.5 {
            let rule = format!("must be below half the diameter, {}", 0.5 * diameter);
            let cure = format!("try {}", tidy(0.06 * diameter));
            problems.value("tube.thickness", rule, Some(cure));
        } else if thickness < 1e-3 {
            let rule = format!(
                "must be at least a thousandth of the diameter, {} (a wall this thin is a shell)",
                tidy(1e-3 * diameter)
            );
            problems.value("tube.thickness", rule, None);
        }
    }
    if problems.none_about(&["tube.length", "tube.diameter"]) && !(0.01..=1000.0).contains(&length)
    {
        let (low, high) = (tidy(0.01 * diameter), tidy(1000.0 * diameter));
        let rule = format!("must be from 0.01 to 1000 diameters, {low} to {high}");
        let cure = format!("try {}", tidy(3.0 * diameter));
        problems.value("tube.length", rule, Some(cure));
    }
    let spec::Material::NeoHookean(law) = &spec.material;
    let ratio = "material.neo-hookean.poisson_ratio";
    if matches!(law.volumetric, spec::Volumetric::Quadratic)
        && law.poisson_ratio < 0.0
        && problems.none_about(&[ratio, "material.neo-hookean.volumetric"])
    {
        let rule =
            "the quadratic law has no lowest energy for a negative Poisson's ratio".to_owned();
        let cure = "try 0.3, or volumetric = \"logarithmic\"".to_owned();
        problems.value(ratio, rule, Some(cure));
    }
    Tube {
        length,
        thickness,
        // Stresses in E: the law's own Young's modulus is one.
        material: Material::NeoHookean(NeoHookean {
            volumetric: match law.volumetric {
                spec::Volumetric::Logarithmic => Volumetric::Logarithmic,
                spec::Volumetric::Quadratic => Volumetric::Quadratic,
            },
            ..NeoHookean::new(1.0, law.poisson_ratio)
        }),
        muscles: muscles(spec, length, problems),
        ends: [spec.ends.colon, spec.ends.ileum].map(support),
        imperfections: vec![], // checked against the mesh, later
    }
}

fn support(support: spec::Support) -> Support {
    match support {
        spec::Support::Fixed => Support::Fixed,
        spec::Support::Sliding => Support::Sliding,
        spec::Support::Free => Support::Free,
    }
}

/// Without the digits that scaling leaves behind.
pub(super) fn tidy(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}
