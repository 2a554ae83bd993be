//! Constitutive laws and fibres.

use super::super::keys::{self, Law};
use super::super::problem::Problems;
use super::zone::tidy;
use crate::material::{
    Composite, Demiray, Fibres, Fung, Gent, Material, Matrix, MooneyRivlin, NeoHookean, Tone,
    Volumetric, Yeoh,
};

/// Returns a law with fibres whose keys are `material` and `fibres` of the table `path`, with its stresses over `modulus`.
pub(in super::super) fn material(
    law: &Law,
    families: &[keys::Fibres],
    path: &str,
    modulus: f64,
    problems: &mut Problems,
) -> Material {
    let matrix = matrix(law, &format!("{path}.material"), modulus, problems);
    let fibres = fibres(families, &format!("{path}.fibres"), modulus, problems);
    with_fibres(matrix, fibres, None)
}

/// Returns a law with its stresses over `modulus`. `path` is its place in the case.
pub(super) fn matrix(law: &Law, path: &str, modulus: f64, problems: &mut Problems) -> Matrix {
    match law {
        Law::NeoHookean(law) => Matrix::NeoHookean(neo_hookean(
            law,
            &format!("{path}.neo-hookean"),
            modulus,
            problems,
        )),
        Law::MooneyRivlin(law) => {
            let path = format!("{path}.mooney-rivlin");
            Matrix::MooneyRivlin(mooney_rivlin(law, &path, modulus, problems))
        }
        Law::Yeoh(law) => Matrix::Yeoh(Yeoh {
            c: [law.c1, law.c2, law.c3].map(|c| c / modulus),
            bulk: law.bulk / modulus,
        }),
        Law::Demiray(law) => Matrix::Demiray(Demiray {
            shear_modulus: law.shear_modulus / modulus,
            stiffening: law.stiffening,
            bulk: law.bulk / modulus,
        }),
        Law::Gent(law) => Matrix::Gent(Gent {
            shear_modulus: law.shear_modulus / modulus,
            limit: law.limit,
            bulk: law.bulk / modulus,
        }),
        Law::Fung(law) => Matrix::Fung(fung(law, &format!("{path}.fung"), modulus, problems)),
    }
}

/// Returns the law of a matrix with families of fibres and an active tension.
pub(super) fn with_fibres(matrix: Matrix, fibres: Vec<Fibres>, tone: Option<Tone>) -> Material {
    match (matrix, &fibres[..], &tone) {
        (Matrix::NeoHookean(law), [], None) => Material::NeoHookean(law),
        (Matrix::MooneyRivlin(law), [], None) => Material::MooneyRivlin(law),
        _ => Material::Composite(Composite {
            matrix,
            fibres,
            tones: tone.into_iter().collect(),
        }),
    }
}

/// Returns families of fibres with their stresses over `modulus`.
pub(super) fn fibres(
    list: &[keys::Fibres],
    path: &str,
    modulus: f64,
    problems: &mut Problems,
) -> Vec<Fibres> {
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

fn fung(law: &keys::Fung, path: &str, modulus: f64, problems: &mut Problems) -> Fung {
    let (zr, zt, rt) = (law.along_outwards, law.along_around, law.around_outwards);
    let a = [
        [law.along, zr, zt],
        [zr, law.outwards, rt],
        [zt, rt, law.around],
    ];
    let own = Fung::new(law.c / modulus, a, law.bulk / modulus);
    if !own.is_positive_definite() && problems.are_sound(&[path]) {
        let rule = "the quadratic form Q must be positive definite";
        let help = match [zr, law.outwards, rt] == [0.0; 3] {
            true => {
                let largest = tidy((law.along * law.around).sqrt());
                format!("make the size of along_around less than {largest}")
            }
            false => "make along_around, along_outwards and around_outwards smaller".into(),
        };
        problems.key(path, rule, help);
    }
    own
}
