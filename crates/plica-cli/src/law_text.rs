//! Laws in words, and as the lines of a case.

use plica::material::{Composite, Material, Matrix, Volumetric};
use std::fmt::Write;

/// Returns the name of a law with its fibres.
pub fn law_name(material: &Material) -> String {
    let (name, fibres) = match material {
        Material::NeoHookean(_) => ("neo-Hookean", 0),
        Material::MooneyRivlin(_) => ("Mooney–Rivlin", 0),
        Material::Custom(_) => ("a law of its own", 0),
        Material::Composite(law) => (law.matrix.name(), law.fibres.len()),
    };
    match fibres {
        0 => name.into(),
        1 => format!("{name}, 1 family of fibres"),
        n => format!("{name}, {n} families of fibres"),
    }
}

/// Returns the lines of a case for a law.
pub fn parameters(material: &Material) -> String {
    let alone;
    let law = match material {
        Material::NeoHookean(law) => {
            alone = composite(Matrix::NeoHookean(*law));
            &alone
        }
        Material::MooneyRivlin(law) => {
            alone = composite(Matrix::MooneyRivlin(*law));
            &alone
        }
        Material::Composite(law) => law,
        Material::Custom(_) => return String::new(),
    };
    let n = number;
    let mut text = match &law.matrix {
        Matrix::NeoHookean(law) if law.volumetric == Volumetric::Logarithmic => {
            let ratio = 0.5 * law.lambda / (law.lambda + law.mu);
            format!(
                "material.neo-hookean = {{ youngs_modulus = {}, poisson_ratio = {} }}\n",
                n(2.0 * law.mu * (1.0 + ratio)),
                n(ratio)
            )
        }
        Matrix::NeoHookean(law) => format!(
            "material.neo-hookean = {{ shear_modulus = {}, bulk = {} }}\n",
            n(law.mu),
            n(law.lambda)
        ),
        Matrix::MooneyRivlin(law) => {
            let (mu, lambda) = (law.a + law.b, law.lambda + 2.0 * law.b);
            let ratio = 0.5 * lambda / (lambda + mu);
            format!(
                "material.mooney-rivlin = {{ youngs_modulus = {}, poisson_ratio = {}, i2_share = {} }}\n",
                n(2.0 * mu * (1.0 + ratio)),
                n(ratio),
                n(law.b / mu)
            )
        }
        Matrix::Yeoh(law) => format!(
            "material.yeoh = {{ c1 = {}, c2 = {}, c3 = {}, bulk = {} }}\n",
            n(law.c[0]),
            n(law.c[1]),
            n(law.c[2]),
            n(law.bulk)
        ),
        Matrix::Demiray(law) => format!(
            "material.demiray = {{ shear_modulus = {}, stiffening = {}, bulk = {} }}\n",
            n(law.shear_modulus),
            n(law.stiffening),
            n(law.bulk)
        ),
        Matrix::Gent(law) => format!(
            "material.gent = {{ shear_modulus = {}, limit = {}, bulk = {} }}\n",
            n(law.shear_modulus),
            n(law.limit),
            n(law.bulk)
        ),
        Matrix::Fung(law) => {
            let a = &law.a;
            let mut outwards = String::new();
            if [a[0][1], a[1][1], a[1][2]] != [0.0; 3] {
                outwards = format!(
                    ", outwards = {}, along_outwards = {}, around_outwards = {}",
                    n(a[1][1]),
                    n(a[0][1]),
                    n(a[1][2])
                );
            }
            format!(
                "material.fung = {{ c = {}, along = {}, around = {}, along_around = {}{outwards}, bulk = {} }}\n",
                n(law.c),
                n(a[0][0]),
                n(a[2][2]),
                n(a[0][2]),
                n(law.bulk)
            )
        }
    };
    let mut families: Vec<String> = vec![];
    let mut rest = law.fibres.clone();
    while !rest.is_empty() {
        let family = rest.remove(0);
        let [along, _, around] = family.direction();
        let angle = along.atan2(around).to_degrees();
        let mirror = rest.iter().position(|other| {
            let [x, _, y] = other.direction();
            let same =
                (other.k1, other.k2, other.dispersion) == (family.k1, family.k2, family.dispersion);
            same && (x + along).abs() < 1e-12 && (y - around).abs() < 1e-12
        });
        let pair = match mirror {
            Some(i) => {
                rest.remove(i);
                ""
            }
            None => ", pair = false",
        };
        let dispersion = match family.dispersion {
            0.0 => String::new(),
            kappa => format!(", dispersion = {}", n(kappa)),
        };
        families.push(format!(
            "{{ k1 = {}, k2 = {}, angle_degrees = {}{dispersion}{pair} }}",
            n(family.k1),
            n(family.k2),
            n(angle)
        ));
    }
    if !families.is_empty() {
        let _ = writeln!(text, "fibres = [{}]", families.join(", "));
    }
    text
}

fn composite(matrix: Matrix) -> Composite {
    Composite {
        matrix,
        fibres: vec![],
        tones: vec![],
    }
}

/// Writes a number with six digits, as TOML.
pub fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}
