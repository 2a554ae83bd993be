//! Closed forms, laws with fibres, and the loss of ellipticity.

use super::*;
use crate::material::{Composite, Demiray, Fibres, Law, Material, Matrix, NeoHookean, Volumetric};
use crate::tensor::Tensor2;

fn neo_hookean(bulk: f64) -> NeoHookean {
    NeoHookean {
        mu: 0.7,
        lambda: bulk,
        volumetric: Volumetric::Quadratic,
    }
}

fn composite(matrix: Matrix, fibres: Vec<Fibres>) -> Material {
    Material::Composite(Composite {
        matrix,
        fibres,
        tones: vec![],
    })
}

fn at(law: &Material, test: MechanicalTest, stretch: f64, volume: Volume) -> Homogeneous {
    homogeneous(law, test.prescribed(stretch), volume).unwrap()
}

#[test]
fn a_neo_hookean_material_of_constant_volume_has_its_closed_forms() {
    let law = Material::NeoHookean(neo_hookean(30.0));
    let mu = 0.7;
    for x in [0.3_f64, 0.8, 1.0, 1.7, 4.0] {
        let nominal =
            |test: MechanicalTest| at(&law, test, x, Volume::Constant).nominal()[test.direction()];
        for (test, expected) in [
            (MechanicalTest::UniaxialAlong, mu * (x - x.powi(-2))),
            (MechanicalTest::UniaxialAround, mu * (x - x.powi(-2))),
            (MechanicalTest::Equibiaxial, mu * (x - x.powi(-5))),
            (MechanicalTest::StripAlong, mu * (x - x.powi(-3))),
            (MechanicalTest::StripAround, mu * (x - x.powi(-3))),
        ] {
            let found = nominal(test);
            assert!(
                (found - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                "{test:?} {x}"
            );
        }
        // A thin tube of constant length: p R/H = μ (1 − λ⁻⁴).
        let tube = at(&law, MechanicalTest::StripAround, x, Volume::Constant);
        let expected = mu * (1.0 - x.powi(-4));
        assert!((tube.thin_tube_pressure() - expected).abs() < 1e-9 * (1.0 + expected.abs()));
    }
}

#[test]
fn lateral_stresses_vanish_and_the_volume_is_that_of_the_law() {
    let media = Fibres::new([0.8, 0.84], 0.0, 0.5);
    let demiray = Matrix::Demiray(Demiray {
        shear_modulus: 0.4,
        stiffening: 1.3,
        bulk: 20.0,
    });
    for law in [
        Material::NeoHookean(neo_hookean(3.0)),
        Material::NeoHookean(NeoHookean::new(1.0, 0.495)),
        composite(demiray, vec![media, media.mirrored()]),
        composite(
            Matrix::NeoHookean(neo_hookean(40.0)),
            vec![media, media.mirrored()],
        ),
    ] {
        for x in [0.5, 0.9, 1.2, 1.5] {
            let found = at(&law, MechanicalTest::UniaxialAround, x, Volume::Free);
            // Another route: the derivative of the energy by each stretch.
            let energy = |stretches: [f64; 3]| {
                let mut F = Tensor2::IDENTITY;
                for i in 0..3 {
                    F.0[i][i] = stretches[i];
                }
                law.energy(&F)
            };
            let slope = |i: usize| {
                let [mut ahead, mut behind] = [found.stretches; 2];
                let h = 1e-6;
                ahead[i] += h;
                behind[i] -= h;
                (energy(ahead) - energy(behind)) / (2.0 * h)
            };
            let nominal = found.nominal();
            for i in 0..3 {
                assert!((slope(i) - nominal[i]).abs() < 1e-7, "{law:?} at {x}");
            }
            assert!(nominal[0].abs() < 1e-9 && nominal[1].abs() < 1e-9);
        }
        // A material that hardly changes its volume is nearly one that does not.
        let [free, constant] = [Volume::Free, Volume::Constant]
            .map(|volume| at(&law, MechanicalTest::Equibiaxial, 1.1, volume).nominal()[0]);
        assert!((free / constant - 1.0).abs() < 0.2, "{free} {constant}");
    }
}

#[test]
fn a_stiffer_volumetric_energy_approaches_the_limit_of_constant_volume() {
    let media = Fibres::new([0.8, 0.84], 0.1, 0.5);
    let off = |bulk: f64| {
        let matrix = Matrix::NeoHookean(neo_hookean(bulk));
        let law = composite(matrix, vec![media, media.mirrored()]);
        let [free, constant] = [Volume::Free, Volume::Constant]
            .map(|volume| at(&law, MechanicalTest::UniaxialAlong, 1.4, volume).nominal()[0]);
        (free / constant - 1.0).abs()
    };
    let ratio = off(1e3) / off(1e4);
    assert!((9.0..11.0).contains(&ratio), "{ratio}");
}

#[test]
fn ellipticity_is_lost_where_the_closed_form_says() {
    // w = μ/2 (I₁ − 3) − μ ln J + λ/2 (ln J)² at F = s I: a wave along n with m = n has the stiffness
    // 2μ/2 + (μ + λ (1 − ln J))/s² … = μ + (μ + λ (1 − 3 ln s))/s².
    let law = NeoHookean::new(1.0, 0.495);
    let material = Material::NeoHookean(law);
    for s in [0.8_f64, 1.0, 1.3, 1.45] {
        let mut F = Tensor2::IDENTITY;
        for i in 0..3 {
            F.0[i][i] = s;
        }
        let longitudinal = law.mu + (law.mu + law.lambda * (1.0 - 3.0 * s.ln())) / (s * s);
        let expected = longitudinal.min(law.mu);
        let found = least_wave_stiffness(&material, &F);
        assert!(
            (found / expected - 1.0).abs() < 1e-5,
            "{s}: {found} {expected}"
        );
    }
    // A strip that keeps its volume stays elliptic.
    for limit in [0.25, 4.0] {
        assert_eq!(
            loses_ellipticity(&material, MechanicalTest::UniaxialAround, limit),
            None
        );
    }
}

#[test]
fn an_active_tension_that_falls_costs_ellipticity() {
    use crate::material::{LengthTension, Tone};
    let tone = |tension| {
        let relation = LengthTension::Rachev {
            best: 1.2,
            least: 0.8,
        };
        Material::Composite(Composite {
            matrix: Matrix::NeoHookean(neo_hookean(30.0)),
            fibres: vec![],
            tones: vec![Tone::new(tension, relation, 0.0)],
        })
    };
    let lost = |tension| loses_ellipticity(&tone(tension), MechanicalTest::UniaxialAround, 1.6);
    assert_eq!(lost(0.01), None);
    // The tension falls with the slope −2 T (λ − λM)/(λM − λ0)² along the fibres.
    let stretch = lost(3.0).unwrap();
    assert!((1.2..1.6).contains(&stretch), "{stretch}");
    let law = tone(3.0);
    let [elliptic, not] = [0.999, 1.001].map(|factor| {
        let state = at(
            &law,
            MechanicalTest::UniaxialAround,
            factor * stretch,
            Volume::Free,
        );
        let mut F = Tensor2::IDENTITY;
        for i in 0..3 {
            F.0[i][i] = state.stretches[i];
        }
        least_wave_stiffness(&law, &F)
    });
    assert!(elliptic > 0.0 && not <= 0.0, "{elliptic} {not}");
}

#[test]
fn a_law_in_another_unit_has_other_stresses_and_nothing_else() {
    let media = Fibres::new([0.8, 0.84], 0.1, 0.5);
    let demiray = Matrix::Demiray(Demiray {
        shear_modulus: 0.4,
        stiffening: 1.3,
        bulk: 20.0,
    });
    let F = Tensor2([[1.2, 0.3, -0.1], [0.15, 0.9, 0.25], [-0.2, 0.1, 0.85]]);
    for law in [
        Material::NeoHookean(neo_hookean(3.0)),
        composite(demiray, vec![media, media.mirrored()]),
    ] {
        let ratio = scaled(&law, 8.0).energy(&F) / law.energy(&F);
        assert!((ratio - 8.0).abs() < 1e-12);
    }
}
