//! The size of the tube, its wall and its ends.

use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::muscles::muscles;
use super::zone::{length, tidy};
use crate::material::{Material, MooneyRivlin, NeoHookean, Volumetric};
use crate::tube::{Tube, WallLayer};

/// Returns the tube without its imperfections, dimensionless.
pub(super) fn tube(case: &Case, problems: &mut Problems) -> Tube {
    let diameter = case.tube.diameter;
    let length = case.tube.length.map_or(3.0, |x| x / diameter);
    let thickness = case.tube.thickness.map_or(0.06, |x| x / diameter);
    if problems.are_sound(&["tube.thickness", "tube.diameter"]) {
        if thickness >= 0.5 {
            let rule = format!(
                "must be below half the diameter, {}",
                self::length(case, 0.5)
            );
            let help = format!("try {}", tidy(0.06 * diameter));
            problems.value("tube.thickness", rule, help);
        } else if thickness < 1e-3 {
            let rule = format!(
                "must be at least a thousandth of the diameter, {} (a thinner wall is a shell)",
                self::length(case, 1e-3)
            );
            problems.value("tube.thickness", rule, "");
        }
    }
    if problems.are_sound(&["tube.length", "tube.diameter"]) && !(0.01..=1000.0).contains(&length) {
        let (low, high) = (tidy(0.01 * diameter), self::length(case, 1000.0));
        let rule = format!("must be from 0.01 to 1000 diameters, {low} to {high}");
        let help = format!("try {}", tidy(3.0 * diameter));
        problems.value("tube.length", rule, help);
    }
    Tube {
        length,
        thickness,
        layers: vec![WallLayer::of(material(case, problems))],
        muscles: muscles(case, length, problems),
        ends: [case.ends.colon, case.ends.ileum],
        imperfections: vec![],
        obstacles: vec![],
    }
}

/// Returns the law of the wall with its stresses in E.
fn material(case: &Case, problems: &mut Problems) -> Material {
    match &case.material {
        keys::Material::NeoHookean(law) => {
            let ratio = "material.neo-hookean.poisson_ratio";
            if law.volumetric == Volumetric::Quadratic
                && law.poisson_ratio < 0.0
                && problems.are_sound(&[ratio, "material.neo-hookean.volumetric"])
            {
                let rule = "the quadratic energy has no minimum for a negative Poisson's ratio";
                problems.value(ratio, rule, "try 0.3, or volumetric = \"logarithmic\"");
            }
            Material::NeoHookean(NeoHookean {
                volumetric: law.volumetric,
                ..NeoHookean::new(1.0, law.poisson_ratio)
            })
        }
        keys::Material::MooneyRivlin(law) => {
            let [ratio, share] =
                ["poisson_ratio", "i2_share"].map(|key| format!("material.mooney-rivlin.{key}"));
            let largest = law.poisson_ratio / (1.0 - 2.0 * law.poisson_ratio);
            if law.i2_share > largest && problems.are_sound(&[&ratio, &share]) {
                let rule = format!(
                    "must be at most {} for Poisson's ratio {} (else the energy of a vanishing volume \
                     has no lower bound)",
                    tidy(largest),
                    law.poisson_ratio
                );
                problems.value(
                    &share,
                    rule,
                    "make it smaller, or poisson_ratio at least 1/3",
                );
            }
            let (ratio, share) = (law.poisson_ratio, law.i2_share);
            Material::MooneyRivlin(MooneyRivlin::new(1.0, ratio, share))
        }
    }
}

/// Returns Young's modulus in the units of the case.
pub(super) fn youngs_modulus(case: &Case) -> f64 {
    match &case.material {
        keys::Material::NeoHookean(law) => law.youngs_modulus,
        keys::Material::MooneyRivlin(law) => law.youngs_modulus,
    }
}
