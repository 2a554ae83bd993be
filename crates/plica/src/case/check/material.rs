//! The laws of the wall.

use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::zone::tidy;
use crate::material::{
    Composite, Demiray, Fibres, Gent, Material, Matrix, MooneyRivlin, NeoHookean, Tone, Volumetric,
    Yeoh,
};

/// Returns Young's modulus E in the units of the case, in which stresses are measured: of several layers the largest.
pub(super) fn youngs_modulus(case: &Case) -> f64 {
    let own = |law: &keys::Material| match law {
        keys::Material::NeoHookean(law) => match law.shear_modulus {
            Some(mu) if law.bulk.is_some() => 3.0 * mu,
            _ => law.youngs_modulus,
        },
        keys::Material::MooneyRivlin(law) => law.youngs_modulus,
        keys::Material::Yeoh(law) => 6.0 * law.c1,
        keys::Material::Demiray(law) => 3.0 * law.shear_modulus,
        keys::Material::Gent(law) => 3.0 * law.shear_modulus,
    };
    let laws = case.layers.iter().map(|layer| layer.material.as_ref());
    let largest = laws.map(|law| own(law.unwrap_or(&case.material)));
    largest.reduce(f64::max).unwrap_or(own(&case.material))
}

/// Returns a law with its stresses in E. `path` is its place in the case.
pub(super) fn matrix(
    law: &keys::Material,
    path: &str,
    case: &Case,
    problems: &mut Problems,
) -> Matrix {
    let modulus = youngs_modulus(case);
    match law {
        keys::Material::NeoHookean(law) => Matrix::NeoHookean(neo_hookean(
            law,
            &format!("{path}.neo-hookean"),
            modulus,
            problems,
        )),
        keys::Material::MooneyRivlin(law) => {
            let path = format!("{path}.mooney-rivlin");
            Matrix::MooneyRivlin(mooney_rivlin(law, &path, modulus, problems))
        }
        keys::Material::Yeoh(law) => Matrix::Yeoh(Yeoh {
            c: [law.c1, law.c2, law.c3].map(|c| c / modulus),
            bulk: law.bulk / modulus,
        }),
        keys::Material::Demiray(law) => Matrix::Demiray(Demiray {
            shear_modulus: law.shear_modulus / modulus,
            stiffening: law.stiffening,
            bulk: law.bulk / modulus,
        }),
        keys::Material::Gent(law) => Matrix::Gent(Gent {
            shear_modulus: law.shear_modulus / modulus,
            limit: law.limit,
            bulk: law.bulk / modulus,
        }),
    }
}

/// Returns the law of a matrix with families of fibres and an active tension.
pub(super) fn with_fibres(matrix: Matrix, fibres: Vec<Fibres>, tone: Option<Tone>) -> Material {
    match (matrix, &fibres[..], tone) {
        (Matrix::NeoHookean(law), [], None) => Material::NeoHookean(law),
        (Matrix::MooneyRivlin(law), [], None) => Material::MooneyRivlin(law),
        _ => Material::Composite(Composite {
            matrix,
            fibres,
            tone,
        }),
    }
}

/// Returns an active tension in E. `path` is its place in the case.
pub(super) fn tone(
    tone: &keys::Tone,
    path: &str,
    case: &Case,
    problems: &mut Problems,
) -> Option<Tone> {
    let [best, least] = ["best_stretch", "least_stretch"].map(|key| format!("{path}.{key}"));
    let is_sound = problems.are_sound(&[&best, &least]);
    let stretches = match (tone.best_stretch, tone.least_stretch) {
        (None, None) => None,
        (Some(most), Some(less)) => {
            if most < less + 1e-3 && is_sound {
                problems.value(&best, "must be above least_stretch by 0.001 or more", "");
            }
            Some([most, less])
        }
        (Some(_), None) | (None, Some(_)) => {
            let (given, other) = match tone.best_stretch {
                Some(_) => (&best, "least_stretch"),
                None => (&least, "best_stretch"),
            };
            if is_sound {
                problems.key(given, format!("needs {other}"), format!("add {other}"));
            }
            None
        }
    };
    let tension = tone.tension / youngs_modulus(case);
    (tension > 0.0).then(|| Tone::new(tension, stretches, tone.angle_degrees.to_radians()))
}

/// Returns families of fibres with their stresses in E.
pub(super) fn fibres(
    list: &[keys::Fibres],
    path: &str,
    case: &Case,
    problems: &mut Problems,
) -> Vec<Fibres> {
    let modulus = youngs_modulus(case);
    let mut fibres = vec![];
    for (i, family) in list.iter().enumerate() {
        let path = format!("{path}[{}]", i + 1);
        let k = [family.k1 / modulus, family.k2];
        let own = Fibres::new(k, family.dispersion, family.angle_degrees.to_radians());
        fibres.push(own);
        if !family.pair {
            continue;
        }
        fibres.push(own.mirrored());
        let key = format!("{path}.angle_degrees");
        if [0.0, 90.0].contains(&family.angle_degrees.abs()) && problems.are_sound(&[&key]) {
            let rule = "has itself as its mirror image, so that a pair counts it twice";
            problems.value(&key, rule, "write pair = false");
        }
    }
    fibres
}

fn neo_hookean(
    law: &keys::NeoHookean,
    path: &str,
    modulus: f64,
    problems: &mut Problems,
) -> NeoHookean {
    let key = |name: &str| format!("{path}.{name}");
    if let (Some(mu), Some(bulk)) = (law.shear_modulus, law.bulk) {
        for name in ["youngs_modulus", "poisson_ratio", "volumetric"] {
            if problems.is_given(&key(name)) && problems.are_sound(&[&key(name)]) {
                let rule = "cannot be given together with shear_modulus and bulk";
                problems.key(&key(name), rule, "leave it out");
            }
        }
        return NeoHookean {
            mu: mu / modulus,
            lambda: bulk / modulus,
            volumetric: Volumetric::Quadratic,
        };
    }
    let alone = [
        ("shear_modulus", law.shear_modulus, "bulk"),
        ("bulk", law.bulk, "shear_modulus"),
    ];
    for (name, value, other) in alone {
        if value.is_some() && problems.are_sound(&[&key(name), &key(other)]) {
            let help = format!("add {other}, or write youngs_modulus and poisson_ratio instead");
            problems.key(&key(name), format!("needs {other}"), help);
        }
    }
    let ratio = key("poisson_ratio");
    if law.volumetric == Volumetric::Quadratic
        && law.poisson_ratio < 0.0
        && problems.are_sound(&[&ratio, &key("volumetric")])
    {
        let rule = "the quadratic energy has no minimum for a negative Poisson's ratio";
        problems.value(&ratio, rule, "try 0.3, or volumetric = \"logarithmic\"");
    }
    NeoHookean {
        volumetric: law.volumetric,
        ..NeoHookean::new(law.youngs_modulus / modulus, law.poisson_ratio)
    }
}

fn mooney_rivlin(
    law: &keys::MooneyRivlin,
    path: &str,
    modulus: f64,
    problems: &mut Problems,
) -> MooneyRivlin {
    let [ratio, share] = ["poisson_ratio", "i2_share"].map(|key| format!("{path}.{key}"));
    let largest = law.poisson_ratio / (1.0 - 2.0 * law.poisson_ratio);
    if law.i2_share > largest && problems.are_sound(&[&ratio, &share]) {
        let rule = format!(
            "must be at most {} for Poisson's ratio {} (else the energy of a vanishing volume \
             has no lower bound)",
            tidy(largest),
            law.poisson_ratio
        );
        let help = "make it smaller, or poisson_ratio at least 1/3";
        problems.value(&share, rule, help);
    }
    MooneyRivlin::new(
        law.youngs_modulus / modulus,
        law.poisson_ratio,
        law.i2_share,
    )
}
