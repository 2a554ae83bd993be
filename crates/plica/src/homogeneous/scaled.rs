//! A law in another unit of stress.

use crate::material::{Material, Matrix};

/// Returns a law with all its stresses multiplied by a factor. A custom law stays as it is.
pub fn scaled(law: &Material, factor: f64) -> Material {
    let mut law = law.clone();
    match &mut law {
        Material::NeoHookean(law) => multiply(&mut [&mut law.mu, &mut law.lambda], factor),
        Material::MooneyRivlin(law) => {
            multiply(&mut [&mut law.a, &mut law.b, &mut law.lambda], factor);
        }
        Material::Custom(_) => {}
        Material::Composite(law) => {
            match &mut law.matrix {
                Matrix::NeoHookean(law) => multiply(&mut [&mut law.mu, &mut law.lambda], factor),
                Matrix::MooneyRivlin(law) => {
                    multiply(&mut [&mut law.a, &mut law.b, &mut law.lambda], factor);
                }
                Matrix::Yeoh(law) => {
                    let [a, b, c] = &mut law.c;
                    multiply(&mut [a, b, c, &mut law.bulk], factor);
                }
                Matrix::Demiray(law) => {
                    multiply(&mut [&mut law.shear_modulus, &mut law.bulk], factor);
                }
                Matrix::Gent(law) => {
                    multiply(&mut [&mut law.shear_modulus, &mut law.bulk], factor);
                }
                Matrix::Fung(law) => multiply(&mut [&mut law.c, &mut law.bulk], factor),
            }
            for family in &mut law.fibres {
                family.k1 *= factor;
            }
            for tone in &mut law.tones {
                tone.tension *= factor;
            }
        }
    }
    law
}

fn multiply(stresses: &mut [&mut f64], factor: f64) {
    for stress in stresses {
        **stress *= factor;
    }
}
