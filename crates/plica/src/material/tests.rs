//! Every law is held to the same identities; a new law adds one line to [`laws`].

use super::*;
use fearless_simd::{Level, SimdBase, dispatch, f64x8};

fn laws() -> Vec<(&'static str, NeoHookean)> {
    vec![
        ("neo-Hookean, nu = 0.495", NeoHookean::new(1.0, 0.495)),
        ("neo-Hookean, nu = 0.3", NeoHookean::new(2.5, 0.3)),
        ("neo-Hookean, nu = 0", NeoHookean::new(1.0, 0.0)),
        ("neo-Hookean, quadratic", quadratic(0.495)),
    ]
}

fn quadratic(poisson_ratio: f64) -> NeoHookean {
    NeoHookean {
        volumetric: Volumetric::Quadratic,
        ..NeoHookean::new(1.0, poisson_ratio)
    }
}

/// A deformation gradient far from the identity, with det > 0.
fn deformation() -> Tensor2<f64> {
    Tensor2([[1.2, 0.3, -0.1], [0.15, 0.9, 0.25], [-0.2, 0.1, 0.85]])
}

fn moved(F: &Tensor2<f64>, H: &Tensor2<f64>, h: f64) -> Tensor2<f64> {
    let mut G = *F;
    for i in 0..3 {
        for j in 0..3 {
            G.0[i][j] += h * H.0[i][j];
        }
    }
    G
}

/// The observed order of an error that should fall as h², from steps h and h/2.
fn order(error: impl Fn(f64) -> f64) -> f64 {
    let h = 1e-2;
    (error(h) / error(h / 2.0)).log2()
}

const SHIFT: Tensor2<f64> = Tensor2([[0.3, -0.7, 0.2], [0.5, 0.4, -0.1], [0.6, 0.1, -0.8]]);

fn stress_is_the_slope_of_energy(name: &str, law: impl Law) {
    let F = deformation();
    let exact = law.stress(&F).dot(SHIFT);
    let error = |h: f64| {
        let slope =
            (law.energy(&moved(&F, &SHIFT, h)) - law.energy(&moved(&F, &SHIFT, -h))) / (2.0 * h);
        (slope - exact).abs()
    };
    let order = order(error);
    assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");
}

fn moduli_are_the_slope_of_stress(name: &str, law: impl Law) {
    let F = deformation();
    let A = law.moduli(&F);
    let mut exact = Tensor2([[0.0; 3]; 3]);
    for k in 0..3 {
        for l in 0..3 {
            for j in 0..3 {
                for i in 0..3 {
                    let a = if k <= l {
                        A[3 * k + j][3 * l + i]
                    } else {
                        A[3 * l + i][3 * k + j]
                    };
                    exact.0[j][k] += a * SHIFT.0[i][l];
                }
            }
        }
    }
    let error = |h: f64| {
        let (a, b) = (
            law.stress(&moved(&F, &SHIFT, h)),
            law.stress(&moved(&F, &SHIFT, -h)),
        );
        let mut sum = 0.0;
        for i in 0..3 {
            for j in 0..3 {
                sum += ((a.0[i][j] - b.0[i][j]) / (2.0 * h) - exact.0[i][j]).powi(2);
            }
        }
        sum.sqrt()
    };
    let order = order(error);
    assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");
}

fn change_is_the_slope_of_stress(name: &str, law: impl Law) {
    let F = deformation();
    let exact = law.change(&law.keep(&F), &SHIFT);
    let error = |h: f64| {
        let (a, b) = (
            law.stress(&moved(&F, &SHIFT, h)),
            law.stress(&moved(&F, &SHIFT, -h)),
        );
        let slope = moved(&a, &b, -1.0).scaled(1.0 / (2.0 * h));
        let off = moved(&slope, &exact, -1.0);
        off.dot(off).sqrt()
    };
    let order = order(error);
    assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");
}

fn energy_does_not_see_rotations(name: &str, law: impl Law) {
    let (c, s) = (0.7_f64.cos(), 0.7_f64.sin());
    let Q = Tensor2([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
    let R = Tensor2([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]).times(Q);
    let F = deformation();
    let w = law.energy(&F);
    assert!(
        (law.energy(&R.times(F)) - w).abs() < 1e-13 * w.abs(),
        "{name}: turned in space"
    );
    assert!(
        (law.energy(&F.times(R)) - w).abs() < 1e-13 * w.abs(),
        "{name}: isotropic"
    );
}

fn rest_is_free_of_stress(name: &str, law: impl Law) {
    let I = Tensor2::IDENTITY;
    assert_eq!(law.energy(&I), 0.0, "{name}");
    assert_eq!(law.stress(&I), Tensor2([[0.0; 3]; 3]), "{name}");
}

fn lanes_agree_with_scalars(name: &str, law: impl Law) {
    let F = deformation();
    dispatch!(Level::new(), simd => {
        let wide = Tensor2(F.0.map(|row| row.map(|x| f64x8::splat(simd, x))));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
        assert!(close(law.energy(&wide)[5], law.energy(&F)), "{name}");
        assert!(close(law.stress(&wide).0[1][2][7], law.stress(&F).0[1][2]), "{name}");
        assert!(close(law.moduli(&wide)[1][5][0], law.moduli(&F)[1][5]), "{name}");
    });
}

#[test]
fn every_law_keeps_the_identities() {
    for (name, law) in laws() {
        stress_is_the_slope_of_energy(name, law);
        moduli_are_the_slope_of_stress(name, law);
        change_is_the_slope_of_stress(name, law);
        energy_does_not_see_rotations(name, law);
        rest_is_free_of_stress(name, law);
        lanes_agree_with_scalars(name, law);
    }
}

#[test]
fn small_strains_follow_hooke() {
    // Uniaxial stress: with the transverse strain −ν e the axial stress is E e.
    let (E, nu, e) = (2.5, 0.3, 1e-7);
    let law = NeoHookean::new(E, nu);
    let mut F = Tensor2::IDENTITY;
    F.0[0][0] += e;
    F.0[1][1] -= nu * e;
    F.0[2][2] -= nu * e;
    let P = law.stress(&F);
    assert!((P.0[0][0] / (E * e) - 1.0).abs() < 1e-6);
    assert!(P.0[1][1].abs() < 1e-6 * E * e);
}

#[test]
fn only_the_quadratic_law_stays_elliptic_where_a_wall_expands() {
    // a ⊗ b : A : a ⊗ b, the stiffness of a wave along b that moves along a; here both along x.
    let stiffness = |law: NeoHookean, J: f64| {
        let mut F = Tensor2::IDENTITY;
        F.0[0][0] = J;
        law.moduli(&F)[0][0]
    };
    let expansions = [1.0, 2.0, 4.0, 8.0, 16.0];
    for nu in [0.0, 0.3, 0.495] {
        let found = expansions.map(|J| stiffness(quadratic(nu), J));
        assert!(found.iter().all(|a| *a > 0.3), "{nu}: {found:?}");
        let NeoHookean { mu, lambda, .. } = NeoHookean::new(1.0, nu);
        let formula = |J: f64| mu * (1.0 + 1.0 / (J * J)) + 0.5 * lambda * (1.0 + J * J) / (J * J);
        assert!(
            found
                .iter()
                .zip(expansions)
                .all(|(a, J)| (a / formula(J) - 1.0).abs() < 1e-12)
        );
    }
    let found = expansions.map(|J| stiffness(NeoHookean::new(1.0, 0.495), J));
    assert!(found[0] > 1.0 && found[2] < 0.0, "{found:?}");
}
