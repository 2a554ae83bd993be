//! A law of your own: three methods, checked, and run in a tube.
//!
//! The law is that of Blatz and Ko (1962) with f = 1 and ν = 1/3, here with a shear modulus of 3/8, so that E = 1:
//!
//! w = μ/2 (I₁ + J⁻² − 4),  P = μ (Fe − J⁻² Fe⁻ᵀ),  I₁ = tr(FeᵀFe),  J = det Fe.
//!
//! A tube with sliding ends under a small pressure p on its inner wall, of radius A, has the displacement of Lamé's solution
//! there: u = (1 + ν) p A² / (B² − A²) · ((1 − 2ν) A + B²/A).
//!
//! Expected: u/p as in Lamé's solution, to about the strain, 1e-4.

#![allow(non_snake_case)] // the formulas keep the letters of the law

use plica::material::{CustomLaw, Law, Material, Moduli, ModuliData, check_law};
use plica::measure::{Face, Meridians};
use plica::tensor::{Real, Tensor2};
use plica::{Study, case};
use std::error::Error;

const NU: f64 = 1.0 / 3.0;

/// The law of Blatz and Ko with ν = 1/3; its constant has the unit of a stress.
struct BlatzKo {
    mu: f64,
}

impl Law for BlatzKo {
    // The default: the moduli themselves are stored at every quadrature point.
    type TangentData = ModuliData;

    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let (I1, J) = (F.dot(*F), F.determinant());
        (I1 + J.like(1.0) / (J * J) - J.like(4.0)).times(0.5 * self.mu)
    }

    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let cofactor = F.cofactor(); // J F⁻ᵀ
        let J = F.determinant_with(cofactor);
        let p = J.like(-1.0) / (J * J * J);
        let mut P = F.0;
        for i in 0..3 {
            for k in 0..3 {
                P[i][k] = (P[i][k] + p * cofactor.0[i][k]).times(self.mu);
            }
        }
        Tensor2(P)
    }

    // A_{jk il} = μ (δ_ij δ_kl + J⁻² (G_jl G_ik + 2 G_jk G_il)),  G = Fe⁻ᵀ
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let cofactor = F.cofactor();
        let J = F.determinant_with(cofactor);
        let G = cofactor.scaled(J.like(1.0) / J).0;
        let s = J.like(1.0) / (J * J);
        let mut A = [[J.like(0.0); 9]; 9];
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let mut entry = s * (G[j][l] * G[i][k] + (G[j][k] * G[i][l]).times(2.0));
                        if i == j && k == l {
                            entry += J.like(1.0);
                        }
                        A[3 * k + j][3 * l + i] = entry.times(self.mu);
                    }
                }
            }
        }
        A
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let law = BlatzKo { mu: 0.375 };
    check_law(&law)?;
    let pressure = 1e-5;
    let text = format!(
        "
        tube = {{ length = 0.2, thickness = 0.06 }}
        ends = {{ colon = 'sliding', ileum = 'sliding' }}
        mesh.control_points = {{ axial = 4, around = 60, thickness = 8 }}
        [[stages]]
        steps = 1
        drive.inner-wall.pressure = {pressure:e}
        "
    );
    let mut plan = case::read(&text, "own law")?;
    plan.tube.layers[0].material = Material::Custom(CustomLaw::new(law));
    let mut study = Study::new(&plan)?;
    let mut radii = vec![];
    while let Some(state) = study.next() {
        let state = state?;
        let meridians = Meridians::of(study.tube(), &state.load, &state.unknowns);
        radii.push(meridians.walls(Face::Inner, &[0.0], &[0.1])[0].points[0].1);
    }
    // The spline circle is round to 3e-7 only, so the radius at rest is subtracted.
    let found = (radii[1] - radii[0]) / pressure;
    let (A, B) = (plan.tube.inner_radius(), 0.5);
    let lame = (1.0 + NU) * A * A / (B * B - A * A) * ((1.0 - 2.0 * NU) * A + B * B / A);
    println!("u/p = {found:.5} (expected {lame:.5})");
    Ok(())
}
