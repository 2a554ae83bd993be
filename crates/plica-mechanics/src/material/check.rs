//! Numerical check of a law.

use super::custom::LaneLaw;
use super::{Law, Moduli, TangentData};
use crate::tensor::{Lanes, Tensor2};

/// An identity that a law violates, with the relative error.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// w(I) = 0 and P(I) = 0.
    #[error("the undeformed state has energy or stress ({0:.1e} of the stiffness)")]
    Reference(f64),
    /// P = ∂w/∂Fe.
    #[error("the stress is not the derivative of the energy (relative error {0:.1e})")]
    Stress(f64),
    /// A = ∂P/∂Fe.
    #[error("the moduli are not the derivative of the stress (relative error {0:.1e})")]
    Moduli(f64),
    /// The product of the tangent data with dF is A : dF.
    #[error("the tangent data and the moduli disagree (relative error {0:.1e})")]
    TangentData(f64),
    /// w(Q Fe) = w(Fe) for a rotation Q.
    #[error("the energy changes with a rotation of space (relative error {0:.1e})")]
    Objectivity(f64),
    /// Vectors of eight numbers give what single numbers give.
    #[error("eight lanes and one number disagree (relative error {0:.1e})")]
    Lanes(f64),
}

/// Checks the derivatives, the objectivity and the undeformed state of a law at eight deformations.
///
/// Derivatives are compared with differences of fourth order. The energy must be finite where
/// principal stretches lie between 0.7 and 1.4.
///
/// # Errors
/// The first identity that the law violates.
pub fn check_law<L: Law>(law: &L) -> Result<(), LawError> {
    let I = Tensor2::IDENTITY;
    let stiffness = law.moduli(&I)[0][0];
    let within = |error: f64, scale: f64, tolerance: f64, kind: fn(f64) -> LawError| {
        let error = error / scale.max(stiffness);
        // NaN is an error, too.
        if error <= tolerance {
            Ok(())
        } else {
            Err(kind(error))
        }
    };

    let rest = law.energy(&I).abs() + norm(law.stress(&I));
    within(rest, stiffness, 1e-13, LawError::Reference)?;

    let states = deformations();
    for F in &states {
        let (w, P, A) = (law.energy(F), law.stress(F), law.moduli(F));
        let dw = P.dot(DIRECTION); // dw = P : dF
        let slope = difference(|h| law.energy(&shifted(F, h)));
        within((slope - dw).abs(), dw.abs(), 1e-7, LawError::Stress)?;

        let dP = contracted(&A); // dP = A : dF
        for i in 0..3 {
            for j in 0..3 {
                let slope = difference(|h| law.stress(&shifted(F, h)).0[i][j]);
                within((slope - dP.0[i][j]).abs(), norm(dP), 1e-7, LawError::Moduli)?;
            }
        }

        let mut data = vec![];
        L::TangentData::linearise(law, F, |pair| data.push(pair));
        let product = L::TangentData::tangent_product(law, |n| data[n], &DIRECTION);
        let counted = L::TangentData::count(law) == 2 * data.len();
        let error = if counted {
            norm(minus(product, dP))
        } else {
            f64::NAN
        };
        within(error, norm(dP), 1e-12, LawError::TangentData)?;

        let rotated = law.energy(&rotation().times(*F));
        within((rotated - w).abs(), w.abs(), 1e-12, LawError::Objectivity)?;
    }

    let side_by_side =
        |i: usize, j: usize| Lanes([0, 1, 2, 3, 4, 5, 6, 7].map(|n| states[n].0[i][j]));
    let F = Tensor2([0, 1, 2].map(|i| [0, 1, 2].map(|j| side_by_side(i, j))));
    let (w, P, A) = (
        LaneLaw::energy(law, &F),
        LaneLaw::stress(law, &F),
        LaneLaw::moduli(law, &F),
    );
    for (n, F) in states.iter().enumerate() {
        let error = (w.0[n] - law.energy(F)).abs();
        let lane = Tensor2(P.0.map(|row| row.map(|x| x.0[n])));
        let error = error + norm(minus(lane, law.stress(F)));
        let lane = A.map(|row| row.map(|x| x.0[n]));
        let (lane, dP) = (contracted(&lane), contracted(&law.moduli(F)));
        let error = error + norm(minus(lane, dP));
        within(error, norm(dP), 1e-12, LawError::Lanes)?;
    }
    Ok(())
}

/// Direction dF of the derivatives.
const DIRECTION: Tensor2 = Tensor2([[0.3, -0.7, 0.2], [0.5, 0.4, -0.1], [0.6, 0.1, -0.8]]);

/// Deformation gradients on a line from the identity to a large deformation, without the identity: the stress of fibres that
/// bear no compression has a kink there.
fn deformations() -> [Tensor2; 8] {
    let H = [[0.2, 0.3, -0.1], [0.15, -0.1, 0.25], [-0.2, 0.1, -0.15]];
    [0, 1, 2, 3, 4, 5, 6, 7].map(|n| {
        let mut F = Tensor2::IDENTITY;
        for i in 0..3 {
            for j in 0..3 {
                F.0[i][j] += f64::from(n + 1) / 8.0 * H[i][j];
            }
        }
        F
    })
}

/// A rotation about no coordinate axis.
fn rotation() -> Tensor2 {
    let (s, c) = 0.7_f64.sin_cos();
    let about_x = Tensor2([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]);
    about_x.times(Tensor2([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
}

/// F + h dF.
fn shifted(F: &Tensor2, h: f64) -> Tensor2 {
    minus(*F, DIRECTION.scaled(-h))
}

/// df/dh at zero, with an error of fourth order.
fn difference(f: impl Fn(f64) -> f64) -> f64 {
    let h = 1e-3;
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

/// A : dF.
fn contracted(A: &Moduli<f64>) -> Tensor2 {
    let mut dP = Tensor2([[0.0; 3]; 3]);
    for k in 0..3 {
        for l in 0..3 {
            for j in 0..3 {
                for i in 0..3 {
                    let (r, c) = (3 * k + j, 3 * l + i);
                    let a = if k <= l { A[r][c] } else { A[c][r] };
                    dP.0[j][k] += a * DIRECTION.0[i][l];
                }
            }
        }
    }
    dP
}

fn minus(a: Tensor2, b: Tensor2) -> Tensor2 {
    Tensor2([0, 1, 2].map(|i| [0, 1, 2].map(|j| a.0[i][j] - b.0[i][j])))
}

fn norm(a: Tensor2) -> f64 {
    a.dot(a).sqrt()
}
