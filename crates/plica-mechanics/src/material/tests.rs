use super::*;

/// Every law of the library, at several parameters. A new law adds a line.
fn laws() -> Vec<Material> {
    let neo_hookean = |law| Material::NeoHookean(law);
    let mooney_rivlin = |nu, share| Material::MooneyRivlin(MooneyRivlin::new(2.0, nu, share));
    vec![
        neo_hookean(NeoHookean::new(1.0, 0.495)),
        neo_hookean(NeoHookean::new(2.5, 0.3)),
        neo_hookean(NeoHookean::new(1.0, 0.0)),
        neo_hookean(quadratic(0.495)),
        mooney_rivlin(0.495, 0.3),
        mooney_rivlin(0.4, 1.0),
        mooney_rivlin(0.3, 0.0),
        Material::Custom(CustomLaw::new(MooneyRivlin::new(1.0, 0.4, 0.5))),
        composite(yeoh(), vec![]),
        composite(demiray(), vec![]),
        composite(gent(), vec![]),
    ]
}

fn composite(matrix: Matrix, fibres: Vec<Fibres>) -> Material {
    Material::Composite(Composite {
        matrix,
        fibres,
        tones: vec![],
    })
}

fn yeoh() -> Matrix {
    let (c, bulk) = ([0.2, 0.1, 0.03], 20.0);
    Matrix::Yeoh(Yeoh { c, bulk })
}

fn demiray() -> Matrix {
    Matrix::Demiray(Demiray {
        shear_modulus: 0.4,
        stiffening: 1.3,
        bulk: 20.0,
    })
}

fn gent() -> Matrix {
    Matrix::Gent(Gent {
        shear_modulus: 0.4,
        limit: 2.5,
        bulk: 20.0,
    })
}

/// Laws with fibres: without and with dispersion, of one hand and of both.
fn laws_with_fibres() -> Vec<Material> {
    let media = Fibres::new([0.8, 0.84], 0.0, 0.5);
    let dispersed = Fibres::new([0.3, 4.0], 0.226, 1.1);
    let linear = Fibres::new([0.5, 0.0], 0.1, 0.0);
    let neo_hookean = Matrix::NeoHookean(quadratic(0.45));
    vec![
        composite(neo_hookean, vec![media]),
        composite(neo_hookean, vec![media, media.mirrored()]),
        composite(
            Matrix::MooneyRivlin(MooneyRivlin::new(1.0, 0.4, 0.5)),
            vec![dispersed, dispersed.mirrored(), linear],
        ),
        composite(demiray(), vec![media, linear, dispersed]),
        composite(yeoh(), vec![linear]),
        composite(gent(), vec![media, dispersed]),
        composite(fung(), vec![]),
        composite(fung(), vec![media]),
    ]
}

/// Fung's law with the shear stiffness that follows, and with one of its own.
fn fung() -> Matrix {
    let a = [[0.9, 0.05, 0.2], [0.05, 0.4, 0.1], [0.2, 0.1, 1.1]];
    Matrix::Fung(Fung {
        shear: [0.3, 0.5, 0.2],
        ..Fung::new(0.6, a, 20.0)
    })
}

fn quadratic(poisson_ratio: f64) -> NeoHookean {
    NeoHookean {
        volumetric: Volumetric::Quadratic,
        ..NeoHookean::new(1.0, poisson_ratio)
    }
}

/// A deformation gradient far from the identity, with det > 0.
const DEFORMED: Tensor2 = Tensor2([[1.2, 0.3, -0.1], [0.15, 0.9, 0.25], [-0.2, 0.1, 0.85]]);

#[test]
fn every_law_satisfies_the_identities() {
    for law in laws().into_iter().chain(laws_with_fibres()) {
        // The law itself, with its own tangent data, and as a variant.
        with_law!(&law, own => check_law(own)).unwrap_or_else(|e| panic!("{law:?}: {e}"));
        check_law(&law).unwrap_or_else(|e| panic!("{law:?}: {e}"));
    }
}

#[test]
fn every_law_is_isotropic() {
    let (s, c) = 0.7_f64.sin_cos();
    let Q = Tensor2([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
    for law in laws() {
        let (w, rotated) = (law.energy(&DEFORMED), law.energy(&DEFORMED.times(Q)));
        assert!((rotated / w - 1.0).abs() < 1e-13, "{law:?}");
    }
}

#[test]
fn laws_without_fibres_along_a_plane_are_mirror_symmetric() {
    let expected = [false, true, true, false, true, false, true, false];
    for (law, expected) in laws_with_fibres().iter().zip(expected) {
        assert_eq!(law.is_mirror_symmetric(), expected, "{law:?}");
        // Reflection of the direction along the tube.
        let mut reflected = Tensor2::IDENTITY;
        reflected.0[0][0] = -1.0;
        let F = DEFORMED.times(reflected);
        let F = reflected.times(F);
        let same = (law.energy(&F) / law.energy(&DEFORMED) - 1.0).abs() < 1e-13;
        assert_eq!(same, expected, "{law:?}");
    }
}

#[test]
fn stress_and_moduli_of_a_tone_are_the_derivatives_of_its_energy() {
    let matrix = Matrix::NeoHookean(quadratic(0.45));
    let rachev = |best, least| LengthTension::Rachev { best, least };
    let gaussian = LengthTension::Gaussian {
        best: 1.1,
        width: 0.3,
    };
    let table = LengthTension::Table(vec![[0.5, 0.0], [1.5, 1.0]]);
    for (tone, symmetric) in [
        (Tone::new(0.7, LengthTension::Constant, 0.0), true),
        (Tone::new(0.7, rachev(1.4, 0.8), 0.0), true),
        (Tone::new(0.7, rachev(1.1, 0.6), 0.4), false),
        (Tone::new(0.7, gaussian, 0.4), false),
        (Tone::new(0.7, table, 0.0), true),
        // Beyond its range there is no tension.
        (Tone::new(0.7, rachev(0.6, 0.5), 0.4), false),
    ] {
        let law = Material::Composite(Composite {
            matrix,
            fibres: vec![],
            tones: vec![tone.clone()],
        });
        assert!(law.has_tone() && law.is_mirror_symmetric() == symmetric);
        assert!(law.energy(&Tensor2::IDENTITY).abs() < 1e-14);
        let (P, A) = (law.stress(&DEFORMED), law.moduli(&DEFORMED));
        let moved = |i: usize, j: usize, h: f64| {
            let mut F = DEFORMED;
            F.0[i][j] += h;
            F
        };
        for j in 0..3 {
            for k in 0..3 {
                let h = 1e-5;
                let slope = law.energy(&moved(j, k, h)) - law.energy(&moved(j, k, -h));
                assert!((slope / (2.0 * h) - P.0[j][k]).abs() < 1e-8, "{tone:?}");
                let (above, below) = (law.stress(&moved(j, k, h)), law.stress(&moved(j, k, -h)));
                for i in 0..3 {
                    for l in k..3 {
                        let slope = (above.0[i][l] - below.0[i][l]) / (2.0 * h);
                        assert!((slope - A[3 * k + j][3 * l + i]).abs() < 1e-7, "{tone:?}");
                    }
                }
            }
        }
        let none = composite(matrix, vec![]).stress(&DEFORMED);
        let is_none = none.0 == P.0;
        assert_eq!(is_none, tone.relation == rachev(0.6, 0.5), "{tone:?}");
    }
    // The nominal stress along the fibres is T at λM.
    let tone = Tone::new(0.7, rachev(1.2, 0.8), 0.0);
    let mut F = Tensor2::IDENTITY;
    F.0[2][2] = 1.2;
    let mut P = Tensor2([[0.0; 3]; 3]);
    tone.add_stress(&F, &mut P);
    assert!((P.0[2][2] - 0.7).abs() < 1e-14);
}

#[test]
fn fibres_have_the_values_of_their_formulas() {
    // Uniaxial stretch around the tube of fibres at 30° from the circumference.
    let (k1, k2, kappa, stretch) = (0.7, 1.9, 0.12, 1.2_f64);
    let family = Fibres::new([k1, k2], kappa, 30.0_f64.to_radians());
    let mut F = Tensor2::IDENTITY;
    F.0[2][2] = stretch;
    let I4 = 0.25 + 0.75 * stretch * stretch;
    let E = kappa * (stretch * stretch - 1.0) + (1.0 - 3.0 * kappa) * (I4 - 1.0);
    let expected = 0.5 * k1 / k2 * ((k2 * E * E).exp() - 1.0);
    assert!((family.energy(&F) / expected - 1.0).abs() < 1e-13);
    // No energy in compression.
    F.0[2][2] = 0.9;
    assert_eq!(family.energy(&F), 0.0);
    // Without the exponent it is the limit of a small one, and full dispersion is isotropic.
    F.0[2][2] = stretch;
    let small = Fibres::new([k1, 1e-6], kappa, 0.3).energy(&F);
    let none = Fibres::new([k1, 0.0], kappa, 0.3).energy(&F);
    assert!((small / none - 1.0).abs() < 1e-6);
    let of_angle = |angle| Fibres::new([k1, k2], 1.0 / 3.0, angle).energy(&DEFORMED);
    assert!((of_angle(0.1) / of_angle(1.2) - 1.0).abs() < 1e-12);
}

#[test]
fn laws_with_fibres_are_elliptic_at_large_deformations() {
    // Waves along n with displacements m have the stiffness m ⊗ n : A : m ⊗ n.
    for law in laws_with_fibres() {
        for scale in [-0.8, 0.5, 0.9] {
            let mut F = Tensor2::IDENTITY;
            for i in 0..3 {
                for j in 0..3 {
                    F.0[i][j] += scale * (DEFORMED.0[i][j] - Tensor2::IDENTITY.0[i][j]);
                }
            }
            let A = law.moduli(&F);
            for s in 0..40 {
                let unit = |seed: f64| {
                    let (a, b) = (
                        seed * 2.399_963,
                        (1.0 - 2.0 * ((0.618_034 * seed) % 1.0)).acos(),
                    );
                    [b.sin() * a.cos(), b.sin() * a.sin(), b.cos()]
                };
                let (n, m) = (unit(f64::from(s)), unit(f64::from(3 * s % 40) + 0.3));
                let mut stiffness = 0.0;
                for k in 0..3 {
                    for l in 0..3 {
                        for j in 0..3 {
                            for i in 0..3 {
                                let (r, c) = (3 * k + j, 3 * l + i);
                                let a = if k <= l { A[r][c] } else { A[c][r] };
                                stiffness += m[j] * n[k] * a * m[i] * n[l];
                            }
                        }
                    }
                }
                assert!(stiffness > 0.0, "{law:?}: {stiffness}");
            }
        }
    }
}

#[test]
fn laws_of_the_first_invariant_have_their_limits() {
    let mu = 0.4;
    let neo_hookean = NeoHookean {
        mu,
        lambda: 20.0,
        volumetric: Volumetric::Quadratic,
    };
    let expected = neo_hookean.energy(&DEFORMED);
    for (matrix, tolerance) in [
        (
            Matrix::Yeoh(Yeoh {
                c: [0.5 * mu, 0.0, 0.0],
                bulk: 20.0,
            }),
            1e-14,
        ),
        (
            Matrix::Demiray(Demiray {
                shear_modulus: mu,
                stiffening: 1e-6,
                bulk: 20.0,
            }),
            1e-5,
        ),
        (
            Matrix::Gent(Gent {
                shear_modulus: mu,
                limit: 1e6,
                bulk: 20.0,
            }),
            1e-5,
        ),
    ] {
        let found = composite(matrix, vec![]).energy(&DEFORMED);
        assert!((found / expected - 1.0).abs() < tolerance, "{matrix:?}");
        assert_eq!(matrix.shear_modulus(), mu);
    }
    // Beyond the limit of the extension there is no energy.
    let mut F = Tensor2::IDENTITY;
    F.0[0][0] = 2.5;
    assert!(composite(gent(), vec![]).energy(&F).is_nan());
}

#[test]
fn the_parts_of_a_law_add_up_to_it() {
    for law in laws().into_iter().chain(laws_with_fibres()) {
        if let Some([shape, volume]) = law.parts() {
            let sum = shape.energy(&DEFORMED) + volume.energy(&DEFORMED);
            assert!((sum / law.energy(&DEFORMED) - 1.0).abs() < 1e-13, "{law:?}");
        }
    }
}

#[test]
fn small_strains_follow_hooke() {
    // Uniaxial stress: with the transverse strain −ν e the axial stress is E e.
    let (E, nu, e) = (2.5, 0.3, 1e-7);
    let mut F = Tensor2::IDENTITY;
    F.0[0][0] += e;
    F.0[1][1] -= nu * e;
    F.0[2][2] -= nu * e;
    for law in [
        Material::NeoHookean(NeoHookean::new(E, nu)),
        Material::MooneyRivlin(MooneyRivlin::new(E, nu, 0.6)),
    ] {
        let P = law.stress(&F);
        assert!((P.0[0][0] / (E * e) - 1.0).abs() < 1e-6, "{law:?}");
        assert!(P.0[1][1].abs() < 1e-6 * E * e, "{law:?}");
        let modulus = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)); // λ + 2μ
        assert!(
            (law.longitudinal_modulus() / modulus - 1.0).abs() < 1e-14,
            "{law:?}"
        );
    }
}

#[test]
fn mooney_rivlin_without_the_second_invariant_is_neo_hookean() {
    let (neo_hookean, mooney_rivlin) = (
        NeoHookean::new(1.0, 0.45),
        MooneyRivlin::new(1.0, 0.45, 0.0),
    );
    let (a, b) = (
        neo_hookean.energy(&DEFORMED),
        mooney_rivlin.energy(&DEFORMED),
    );
    assert!((a / b - 1.0).abs() < 1e-14);
    let (a, b) = (
        neo_hookean.moduli(&DEFORMED),
        mooney_rivlin.moduli(&DEFORMED),
    );
    for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
        assert!((a - b).abs() < 1e-14 * neo_hookean.lambda);
    }
}

#[test]
fn mistakes_in_a_law_are_found() {
    #[derive(Clone, Copy)]
    struct Wrong(LawError);
    impl Law for Wrong {
        type TangentData = ModuliData;
        fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
            let w = NeoHookean::new(1.0, 0.4).energy(F);
            match self.0 {
                LawError::Reference(_) => w + w.like(1e-9),
                LawError::Lanes(_) => w + w.like(if size_of::<S>() > 8 { 1e-9 } else { 0.0 }),
                _ => w,
            }
        }
        fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
            let mut P = NeoHookean::new(1.0, 0.4).stress(F);
            if let LawError::Stress(_) = self.0 {
                P.0[1][2] += F.0[1][2] * F.0[1][2];
            }
            P
        }
        fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
            let mut A = NeoHookean::new(1.0, 0.4).moduli(F);
            if let LawError::Moduli(_) = self.0 {
                A[3][5] = -A[3][5];
            }
            A
        }
    }
    for mistake in [
        LawError::Reference(0.0),
        LawError::Stress(0.0),
        LawError::Moduli(0.0),
        LawError::Lanes(0.0),
    ] {
        let found = check_law(&Wrong(mistake)).unwrap_err();
        assert_eq!(
            std::mem::discriminant(&found),
            std::mem::discriminant(&mistake),
            "{found}"
        );
    }
}

#[test]
fn only_the_quadratic_volumetric_energy_stays_elliptic_under_expansion() {
    // a ⊗ b : A : a ⊗ b, the stiffness of a wave along b with displacements along a; here both along x.
    let stiffness = |law: NeoHookean, J: f64| {
        let mut F = Tensor2::IDENTITY;
        F.0[0][0] = J;
        law.moduli(&F)[0][0]
    };
    let expansions = [1.0, 2.0, 4.0, 8.0, 16.0];
    for nu in [0.0, 0.3, 0.495] {
        let NeoHookean { mu, lambda, .. } = NeoHookean::new(1.0, nu);
        for J in expansions {
            let a = stiffness(quadratic(nu), J);
            let formula = mu * (1.0 + 1.0 / (J * J)) + 0.5 * lambda * (1.0 + J * J) / (J * J);
            assert!(
                a > 0.3 && (a / formula - 1.0).abs() < 1e-12,
                "{nu}, {J}: {a}"
            );
        }
    }
    let logarithmic = expansions.map(|J| stiffness(NeoHookean::new(1.0, 0.495), J));
    assert!(
        logarithmic[0] > 1.0 && logarithmic[2] < 0.0,
        "{logarithmic:?}"
    );
}

#[test]
fn fung_is_isotropic_where_its_coefficients_are_and_refuses_indefinite_ones() {
    // a_ii = λ + 2μ, a_ij = λ: Q = λ (tr E)² + 2 μ E : E.
    let (c, lambda, mu) = (0.7, 0.3, 0.45);
    let mut a = [[lambda; 3]; 3];
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += 2.0 * mu;
    }
    let law = Fung::new(c, a, 3.0);
    assert!(law.is_positive_definite() && (law.shear_modulus() - c * mu).abs() < 1e-15);
    let (s, k) = 0.7_f64.sin_cos();
    for Q in [
        Tensor2([[k, -s, 0.0], [s, k, 0.0], [0.0, 0.0, 1.0]]),
        Tensor2([[1.0, 0.0, 0.0], [0.0, k, -s], [0.0, s, k]]),
    ] {
        let ratio = law.energy(&DEFORMED.times(Q)) / law.energy(&DEFORMED);
        assert!((ratio - 1.0).abs() < 1e-13);
    }
    // Uniaxial stretch: E₁₁ alone.
    let mut F = Tensor2::IDENTITY;
    F.0[2][2] = 1.2_f64;
    let E = 0.22_f64;
    let shape = 0.5 * c * ((a[2][2] * E * E).exp() - 1.0);
    let volume = 0.25 * 3.0 * (1.44 - 1.0 - 2.0 * 1.2_f64.ln());
    assert!((law.energy(&F) - shape - volume).abs() < 1e-14);
    let form = |a: [[f64; 3]; 3]| Fung::new(1.0, a, 1.0).is_positive_definite();
    assert!(form([[1.0, 0.0, 0.9], [0.0, 0.0, 0.0], [0.9, 0.0, 1.0]]));
    assert!(!form([[1.0, 0.0, 1.1], [0.0, 0.0, 0.0], [1.1, 0.0, 1.0]]));
    assert!(!form([[1.0, 0.9, 0.0], [0.9, 0.5, 0.0], [0.0, 0.0, 1.0]]));
    assert!(!form([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]));
}
