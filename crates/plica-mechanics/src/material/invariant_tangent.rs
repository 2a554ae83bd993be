//! Tangent of a law of the invariants I₁, I₂ and J and of squared stretches of fibres, from few numbers.
//!
//! With F = Fe, C = cof F, and structure tensors M = κ I + γ a ⊗ a of unit vectors a,
//!
//! A : dF = e dF + m C dFᵀ C + b (C : dF) C − d (dF FᵀF + F dFᵀ F + F Fᵀ dF) + Σ (p dF a ⊗ a + q (F M : dF) F M)
//!
//! The numbers are F, m, b, e, and q and p of every structure tensor; d, κ, γ and a are constants of the law. With two families
//! of fibres in a neo-Hookean matrix they are sixteen, where the general moduli are 45.

use super::custom::{lanes, vectors};
use super::{Fibres, Material, Matrix, ModuliData, TangentData, Tone};
use crate::tensor::{Lanes, Real, Tensor2, with_vectors};

/// Structure tensors from which on the general moduli are stored.
const TOO_MANY: usize = 9;

/// Tangent data of a [`Material`]: those of this file, or the moduli of a law that is not of this form.
pub enum MaterialData {}

/// The constants of a law of this form that a product needs.
#[derive(Clone, Copy)]
struct Invariants<'a> {
    /// False if the law consists of tensions alone: e, m and b are zero.
    has_matrix: bool,
    /// True if the matrix depends on I₁ other than linearly; its structure tensor is then the first.
    is_curved: bool,
    /// d.
    second: f64,
    fibres: &'a [Fibres],
    tones: &'a [Tone],
}

/// A structure tensor M = κ I + γ a ⊗ a.
#[derive(Clone, Copy)]
pub(super) struct Structure {
    /// κ.
    pub isotropic: f64,
    /// γ.
    pub directed: f64,
    /// Components of a along the tube and around it.
    pub direction: [f64; 2],
}

/// m, b and e; then q and p of every structure tensor.
type Coefficients<S> = ([S; 3], [[S; 2]; TOO_MANY - 1]);

/// The structure tensor of the first invariant.
const FIRST_INVARIANT: Structure = Structure {
    isotropic: 1.0,
    directed: 0.0,
    direction: [0.0; 2],
};

impl Invariants<'_> {
    /// Returns the constants of a law; none if it has another form.
    #[inline(always)]
    fn of(material: &Material) -> Option<Invariants<'_>> {
        let plain = Invariants {
            has_matrix: true,
            is_curved: false,
            second: 0.0,
            fibres: &[],
            tones: &[],
        };
        let law = match material {
            Material::NeoHookean(_) => plain,
            Material::MooneyRivlin(law) => Invariants {
                is_curved: true,
                second: law.b,
                ..plain
            },
            Material::Composite(law) => Invariants {
                has_matrix: !law.matrix.is_nothing(),
                is_curved: law.matrix.is_curved(),
                second: match &law.matrix {
                    Matrix::MooneyRivlin(law) => law.b,
                    Matrix::Fung(_) => return None,
                    _ => 0.0,
                },
                fibres: &law.fibres,
                tones: &law.tones,
            },
            Material::Custom(_) => return None,
        };
        (law.structures() < TOO_MANY).then_some(law)
    }

    /// Returns the number of structure tensors.
    #[inline(always)]
    fn structures(&self) -> usize {
        usize::from(self.is_curved) + self.fibres.len() + self.tones.len()
    }

    #[inline(always)]
    fn coefficients<S: Real>(&self, matrix: &Matrix, F: &Tensor2<S>) -> Coefficients<S> {
        let ([m, bulk, mut e], curvature) = matrix.coefficients(F);
        let J = F.determinant();
        let square = J * J;
        let mut of_structures = [[J.like(0.0); 2]; TOO_MANY - 1];
        let mut n = 0;
        if self.is_curved {
            of_structures[n][0] = curvature;
            n += 1;
        }
        for family in self.fibres {
            let [curvature, slope] = family.derivatives(F);
            let structure = family.structure();
            e += slope.times(structure.isotropic);
            of_structures[n] = [curvature, slope.times(structure.directed)];
            n += 1;
        }
        for tone in self.tones {
            of_structures[n] = tone.derivatives(F);
            n += 1;
        }
        ([m / square, bulk / square, e], of_structures)
    }

    /// Returns the coefficients of eight states.
    fn coefficients_by_lanes(&self, matrix: &Matrix, F: &Tensor2<Lanes>) -> Coefficients<Lanes> {
        with_vectors!(simd => {
            let (plain, of_structures) = self.coefficients(matrix, &vectors(simd, F));
            (plain.map(Lanes::store), of_structures.map(|pair| pair.map(Lanes::store)))
        })
    }

    #[inline(always)]
    fn product<S: Real>(&self, pair: impl Fn(usize) -> [S; 2], dF: &Tensor2<S>) -> Tensor2<S> {
        let ([f00, f01], [f02, f10], [f11, f12]) = (pair(0), pair(1), pair(2));
        let ([f20, f21], [f22, m], [b, e]) = (pair(3), pair(4), pair(5));
        let F = Tensor2([[f00, f01, f02], [f10, f11, f12], [f20, f21, f22]]);
        let none = e.like(0.0);
        let mut P = match self.has_matrix {
            true => of_volume(&F, [m, b, e], dF),
            false => dF.scaled(none),
        };
        if self.second != 0.0 {
            add_second_invariant(&F, self.second, dF, &mut P);
        }
        let dispersed = |family: &Fibres| family.dispersion != 0.0;
        let spherical = self.is_curved || self.fibres.iter().any(dispersed);
        let mut sum = Sum {
            P,
            of_F: none,
            trace: if spherical { F.dot(*dF) } else { none },
        };
        let mut n = 6;
        if self.is_curved {
            sum.add(FIRST_INVARIANT, pair(n), &F, dF);
            n += 1;
        }
        for family in self.fibres {
            sum.add(family.structure(), pair(n), &F, dF);
            n += 1;
        }
        for tone in self.tones {
            sum.add(tone.structure(), pair(n), &F, dF);
            n += 1;
        }
        if spherical {
            for i in 0..3 {
                for k in 0..3 {
                    sum.P.0[i][k] = sum.of_F.mul_add(F.0[i][k], sum.P.0[i][k]);
                }
            }
        }
        sum.P
    }
}

/// The sum over structure tensors.
struct Sum<S> {
    /// The sum without the multiple of F.
    P: Tensor2<S>,
    /// The factor of F.
    of_F: S,
    /// F : dF, if a structure tensor has a κ.
    trace: S,
}

impl<S: Real> Sum<S> {
    /// Adds p dF a ⊗ a + q (F M : dF) F M.
    #[inline(always)]
    fn add(&mut self, structure: Structure, [q, p]: [S; 2], F: &Tensor2<S>, dF: &Tensor2<S>) {
        let (kappa, gamma) = (structure.isotropic, structure.directed);
        if gamma == 0.0 {
            self.of_F = (self.trace * q).mul_add(q.like(kappa * kappa), self.of_F);
            return;
        }
        let [along, around] = structure.direction;
        let (Fa, dFa) = (F.across(along, around), dF.across(along, around));
        let dot = Fa[0].mul_add(dFa[0], Fa[1].mul_add(dFa[1], Fa[2] * dFa[2]));
        let mut s = dot.times(gamma);
        if kappa != 0.0 {
            s += self.trace.times(kappa);
            self.of_F = (s * q).mul_add(q.like(kappa), self.of_F);
        }
        let s = (s * q).times(gamma);
        for i in 0..3 {
            let f = s.mul_add(Fa[i], p * dFa[i]);
            self.P.0[i][0] = f.mul_add(f.like(along), self.P.0[i][0]);
            self.P.0[i][2] = f.mul_add(f.like(around), self.P.0[i][2]);
        }
    }
}

/// Returns e dF + m C dFᵀ C + b (C : dF) C.
#[inline(always)]
fn of_volume<S: Real>(F: &Tensor2<S>, [m, b, e]: [S; 3], dF: &Tensor2<S>) -> Tensor2<S> {
    let C = F.cofactor();
    let H = dF.transpose().times(C);
    let trace = C.dot(*dF) * b;
    let mut middle = H.scaled(m);
    for i in 0..3 {
        middle.0[i][i] += trace;
    }
    let mut P = C.times(middle);
    for i in 0..3 {
        for k in 0..3 {
            P.0[i][k] = e.mul_add(dF.0[i][k], P.0[i][k]);
        }
    }
    P
}

/// Subtracts d (dF FᵀF + F dFᵀ F + F Fᵀ dF).
#[inline(always)]
fn add_second_invariant<S: Real>(F: &Tensor2<S>, d: f64, dF: &Tensor2<S>, P: &mut Tensor2<S>) {
    let transposed = F.transpose();
    let mixed = transposed.times(*dF).0;
    let mut change = mixed;
    for k in 0..3 {
        for l in 0..3 {
            change[k][l] = mixed[k][l] + mixed[l][k];
        }
    }
    let first = dF.times(transposed.times(*F));
    let second = F.times(Tensor2(change));
    for i in 0..3 {
        for k in 0..3 {
            P.0[i][k] += (first.0[i][k] + second.0[i][k]).times(-d);
        }
    }
}

impl TangentData<Material> for MaterialData {
    #[inline(always)]
    fn count(law: &Material) -> usize {
        match Invariants::of(law) {
            Some(law) => 12 + 2 * law.structures(),
            None => ModuliData::count(law),
        }
    }

    #[inline(always)]
    fn linearise<S: Real>(law: &Material, F: &Tensor2<S>, mut store: impl FnMut([S; 2])) {
        let matrix = match law {
            Material::NeoHookean(law) => Matrix::NeoHookean(*law),
            Material::MooneyRivlin(law) => Matrix::MooneyRivlin(*law),
            Material::Composite(law) => law.matrix,
            Material::Custom(_) => return ModuliData::linearise(law, F, store),
        };
        let Some(invariants) = Invariants::of(law) else {
            return ModuliData::linearise(law, F, store);
        };
        let (plain, of_structures) = invariants.coefficients_by_lanes(&matrix, &lanes(F));
        let like = |x| F.0[0][0].like_lanes(x);
        let [m, b, e] = plain.map(like);
        let [x, y, z] = F.0;
        store([x[0], x[1]]);
        store([x[2], y[0]]);
        store([y[1], y[2]]);
        store([z[0], z[1]]);
        store([z[2], m]);
        store([b, e]);
        for pair in &of_structures[..invariants.structures()] {
            store(pair.map(like));
        }
    }

    #[inline(always)]
    fn tangent_product<S: Real>(
        law: &Material,
        pair: impl Fn(usize) -> [S; 2],
        dF: &Tensor2<S>,
    ) -> Tensor2<S> {
        match Invariants::of(law) {
            Some(invariants) => invariants.product(pair, dF),
            None => ModuliData::tangent_product(law, pair, dF),
        }
    }
}
