//! The keys of constitutive laws, fibres, active tension and residual stress, and of materials of a library.

use super::key::{Key, Kind, LENGTH, STRESS, default, described, required};
use super::problem::Problems;
use super::read::{Fields, Read, Table, Value, choice, choose, table};
use crate::material::Volumetric;
use toml::de::DeValue;

/// The law of a wall or layer.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// The law; of a material of a library a placeholder until it is looked up.
    pub law: Law,
    /// The fibres of a material of a library.
    pub fibres: Vec<Fibres>,
    /// The material of a library that it is.
    pub named: Option<NamedMaterial>,
}

table! {
    NamedMaterial {
        /// The name of a material of the library (`plica materials` lists them), or of `file`. It brings its law and fibres,
        /// in the units of the case.
        from: String = required("carotid-media-hgo-2000");
        /// Path of a library of your own, a TOML file. Its place as for `start.state`.
        file: Option<String> = described("the library of Plica", "my-materials.toml");
        /// The constant K of the volumetric energy, instead of that in the library.
        bulk: Option<f64> = described("that of the library", "1000.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

const LAWS: &[Key] = Law::KIND.keys();
const NAMED: &[Key] = NamedMaterial::KEYS;

/// The laws, and the keys of a material of a library.
const MATERIAL: &[Key] = &{
    let mut keys = [LAWS[0]; LAWS.len() + NAMED.len()];
    let mut i = 0;
    while i < keys.len() {
        keys[i] = match i < LAWS.len() {
            true => LAWS[i],
            false => NAMED[i - LAWS.len()],
        };
        i += 1;
    }
    keys
};

impl Read for Material {
    const KIND: Kind = Kind::Either(MATERIAL, LAWS.len());

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let has = |name: &str| match value.get_ref() {
            DeValue::Table(table) => table.contains_key(name),
            _ => false,
        };
        if !NAMED.iter().any(|key| has(key.name)) {
            // The laws, and `from` in suggestions.
            let kind = Kind::Choice(&[], MATERIAL.split_at(LAWS.len() + 1).0);
            let law = Law::read(problems, &Key { kind, ..*key }, path, value)?;
            return Some(Self::of(law));
        }
        if let Some(law) = LAWS.iter().find(|law| has(law.name)) {
            let rule = format!("only one of from and {} may be given", law.name);
            problems.key(path, rule, "");
            return None;
        }
        let named = NamedMaterial::read(problems, key, path, value)?;
        Some(Self {
            named: Some(named),
            ..Self::of(Law::NeoHookean(NeoHookean::fallback(key)))
        })
    }
}

impl Material {
    fn of(law: Law) -> Self {
        Self {
            law,
            fibres: vec![],
            named: None,
        }
    }
}

/// A law that a case writes out.
#[derive(Clone, Debug)]
pub(super) enum Law {
    NeoHookean(NeoHookean),
    MooneyRivlin(MooneyRivlin),
    Yeoh(Yeoh),
    Demiray(Demiray),
    Gent(Gent),
    Fung(Fung),
}

choice! { Law {
    /// The compressible neo-Hookean law.
    "neo-hookean": NeoHookean = described("", "{}") => Law::NeoHookean,
    /// The compressible Mooney–Rivlin law.
    "mooney-rivlin": MooneyRivlin = described("", "{}") => Law::MooneyRivlin,
    /// Yeoh's law, a polynomial in I₁ − 3.
    "yeoh": Yeoh = described("", "{ c1 = 0.2, bulk = 20.0 }") => Law::Yeoh,
    /// Demiray's law, exponential in I₁ − 3: μ/(2b) (exp(b (I₁ − 3)) − 1).
    "demiray": Demiray = described("", "{ shear_modulus = 0.3, stiffening = 1.0, bulk = 20.0 }") => Law::Demiray,
    /// Gent's law, with a limit j of the extension: −μ/2 j ln(1 − (I₁ − 3)/j).
    "gent": Gent = described("", "{ shear_modulus = 0.3, limit = 30.0, bulk = 20.0 }") => Law::Gent,
    /// Fung's orthotropic law, c/2 (exp(Q) − 1) with a quadratic form Q of the components of the strain E = ½ (FeᵀFe − I):
    /// Q = `along` E_z² + `around` E_θ² + `outwards` E_r² + 2 (`along_around` E_z E_θ + `along_outwards` E_z E_r +
    /// `around_outwards` E_θ E_r), and shear with the stiffness of an isotropic law in each plane.
    "fung": Fung = described("", "{ c = 0.2, along = 1.0, around = 1.5, along_around = 0.3, bulk = 20.0 }") => Law::Fung,
} }

table! {
    NeoHookean {
        /// Young's modulus E at small strains.
        youngs_modulus: f64 = default("1.0").unit(STRESS).from(1e-12).to(1e15);
        /// Poisson's ratio ν at small strains.
        poisson_ratio: f64 = default("0.495").from(-0.5).to(0.4999).because("the law is compressible; the solver loses its accuracy beyond");
        /// The volumetric energy: λ/2 (ln J)², as in the paper, or λ/4 (J² − 1 − 2 ln J), which stays
        /// elliptic where the wall expands strongly and needs ν ≥ 0.
        volumetric: Volumetric = default("logarithmic");
        /// The shear modulus μ at small strains. With `bulk` it takes the place of the keys above; the volumetric energy is
        /// then the quadratic one.
        shear_modulus: Option<f64> = described("from `youngs_modulus`", "0.3").unit(STRESS).from(1e-12).to(1e15);
        /// The constant K of the volumetric energy K/4 (J² − 1 − 2 ln J).
        bulk: Option<f64> = described("from `poisson_ratio`", "20.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

table! {
    MooneyRivlin {
        /// Young's modulus E at small strains.
        youngs_modulus: f64 = default("1.0").unit(STRESS).from(1e-12).to(1e15);
        /// Poisson's ratio ν at small strains.
        poisson_ratio: f64 = default("0.495").from(0.0).to(0.4999).because("the law is compressible; the solver loses its accuracy beyond");
        /// The share s of the second invariant I₂ in the shear modulus, at most ν/(1 − 2ν). The
        /// neo-Hookean law has s = 0.
        i2_share: f64 = default("0.5").from(0.0).to(1.0);
    }
}

table! {
    Yeoh {
        /// The factor c₁ of I₁ − 3, half the shear modulus at small strains.
        c1: f64 = required("0.2").unit(STRESS).from(1e-12).to(1e15);
        /// The factor c₂ of (I₁ − 3)².
        c2: f64 = default("0.0").unit(STRESS).from(0.0).to(1e15);
        /// The factor c₃ of (I₁ − 3)³.
        c3: f64 = default("0.0").unit(STRESS).from(0.0).to(1e15);
        /// The constant K of the volumetric energy K/4 (J² − 1 − 2 ln J).
        bulk: f64 = required("20.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

table! {
    Demiray {
        /// The shear modulus μ at small strains.
        shear_modulus: f64 = required("0.3").unit(STRESS).from(1e-12).to(1e15);
        /// The stiffening b, the factor of I₁ − 3 in the exponent.
        stiffening: f64 = required("1.0").from(1e-6).to(1e6);
        /// The constant K of the volumetric energy K/4 (J² − 1 − 2 ln J).
        bulk: f64 = required("20.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

table! {
    Gent {
        /// The shear modulus μ at small strains.
        shear_modulus: f64 = required("0.3").unit(STRESS).from(1e-12).to(1e15);
        /// The value j of I₁ − 3 at which the law becomes infinitely stiff.
        limit: f64 = required("30.0").from(1e-3).to(1e9);
        /// The constant K of the volumetric energy K/4 (J² − 1 − 2 ln J).
        bulk: f64 = required("20.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

table! {
    Fung {
        /// The stiffness c.
        c: f64 = required("0.2").unit(STRESS).from(1e-12).to(1e15);
        /// The coefficient of the square of the strain along the tube. Q is positive definite.
        along: f64 = required("1.0").above(0.0).to(1e6);
        /// The coefficient of the square of the strain around the tube.
        around: f64 = required("1.5").above(0.0).to(1e6);
        /// The coefficient of twice the product of the strains along and around.
        along_around: f64 = default("0.0").from(-1e6).to(1e6);
        /// The coefficient of the square of the strain through the wall. Where it and the next two are 0, only the volumetric
        /// energy bears that strain, as in a formula for a membrane.
        outwards: f64 = default("0.0").from(0.0).to(1e6);
        /// The coefficient of twice the product of the strains along and through the wall.
        along_outwards: f64 = default("0.0").from(-1e6).to(1e6);
        /// The coefficient of twice the product of the strains around and through the wall.
        around_outwards: f64 = default("0.0").from(-1e6).to(1e6);
        /// The constant K of the volumetric energy K/4 (J² − 1 − 2 ln J).
        bulk: f64 = required("20.0").unit(STRESS).from(1e-12).to(1e15);
    }
}

table! {
    Fibres {
        /// The stiffness k₁ in k₁/(2 k₂) (exp(k₂ ⟨E⟩²) − 1), E = κ (I₁ − 3) + (1 − 3κ)(I₄ − 1). ⟨E⟩ is E where it is
        /// positive, and else zero.
        k1: f64 = required("0.5").unit(STRESS).from(0.0).to(1e15);
        /// The stiffening k₂. With 0 the energy is k₁/2 ⟨E⟩².
        k2: f64 = required("0.8").from(0.0).to(1e6);
        /// The angle from the circumference toward the axis: 0 is around the tube, 90 along it.
        angle_degrees: f64 = required("30.0").unit("degrees").from(-90.0).to(90.0);
        /// True if there is a second family at minus this angle. One family alone twists the tube.
        pair: bool = default("true");
        /// The dispersion κ: 0 for fibres of one direction, 1/3 for all directions alike.
        dispersion: f64 = default("0.0").from(0.0).to(0.333_333_333_333_333_3);
    }
}

table! {
    ActiveStress {
        /// The angle of the fibres from the circumference toward the axis.
        angle_degrees: Option<f64> = described("0 for a circular muscle, 90 for a longitudinal one", "30.0")
            .unit("degrees").from(-90.0).to(90.0);
        /// The stretch λM of the fibres at which their stress is the tension T. With `least_stretch` it is
        /// T (1 − ((λM − λ)/(λM − λ0))²) at another stretch λ, where that is positive.
        best_stretch: Option<f64> = described("T at any stretch", "1.4").from(0.1).to(10.0);
        /// The stretch λ0 below which the fibres have no stress.
        least_stretch: Option<f64> = described("T at any stretch", "0.8").from(0.0).to(10.0);
        /// The width b of a Gaussian curve, with `best_stretch`: T exp(−(λ − λM)²/(2 b²)).
        width: Option<f64> = described("T at any stretch", "0.3").from(0.01).to(10.0);
        /// Points (stretch, stress over T) of any other curve, as in `layers[].tone.table`.
        table: Option<Vec<[f64; 2]>> = described("T at any stretch", "[[0.6, 0.0], [1.2, 1.0], [1.6, 0.5]]");
    }
}

table! {
    Tone {
        /// The nominal stress T along the muscle cells, from rest on. It does not depend on the stages; that of a muscle with
        /// `active_stress` does.
        tension: f64 = required("0.1").unit(STRESS).from(0.0).to(1e15);
        /// The angle of the cells from the circumference toward the axis.
        angle_degrees: f64 = default("0.0").unit("degrees").from(-90.0).to(90.0);
        /// The stretch λM of the cells at which their stress is T. With `least_stretch` it is
        /// T (1 − ((λM − λ)/(λM − λ0))²) at another stretch λ, where that is positive.
        best_stretch: Option<f64> = described("T at any stretch", "1.4").from(0.1).to(10.0);
        /// The stretch λ0 below which the cells have no stress.
        least_stretch: Option<f64> = described("T at any stretch", "0.8").from(0.0).to(10.0);
        /// The width b of a Gaussian curve, with `best_stretch`: T exp(−(λ − λM)²/(2 b²)).
        width: Option<f64> = described("T at any stretch", "0.3").from(0.01).to(10.0);
        /// Points (stretch, stress over T) of any other curve, linear in between and constant beyond. Stretches rise.
        table: Option<Vec<[f64; 2]>> = described("T at any stretch", "[[0.6, 0.0], [1.2, 1.0], [1.6, 0.5]]");
    }
}

table! {
    Residual {
        /// The stress-free length around the tube over the length at rest, at the inner and the outer face of the layer;
        /// linear in between.
        around: [f64; 2] = default("[1.0, 1.0]");
        /// The same along the tube.
        along: [f64; 2] = default("[1.0, 1.0]");
        /// The opening angle, in the place of `around`: cut along its length, the tube springs open to a sector from which this
        /// angle is missing to a full circle (twice the opening angle as Fung defines it). Layers with the same angle that lie
        /// next to each other open together.
        opening_degrees: Option<f64> = described("none", "160.0").unit("degrees").from(0.0).to(350.0);
        /// The inner radius of the layer in the open sector.
        opening_radius: Option<f64> = described("the middle of the layers that open together keeps its length", "0.7").unit(LENGTH).above(0.0);
    }
}

choice! { Volumetric {
    "logarithmic" => Volumetric::Logarithmic,
    "quadratic" => Volumetric::Quadratic,
} }
