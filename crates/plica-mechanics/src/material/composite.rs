//! A matrix with fibres: the sum of another law, of any number of families of fibres, and of active tensions.
//!
//! Evaluated eight numbers at a time through memory, like a custom law: the element kernels are not compiled for it again.

use super::first_invariant::{self, FirstInvariant};
use super::{Demiray, Fibres, Fung, Gent, Law, Moduli, ModuliData, MooneyRivlin, NeoHookean};
use super::{Tone, Volumetric, Yeoh};
use crate::tensor::{Real, Tensor2};

/// A matrix with fibres.
#[derive(Clone, Debug, PartialEq)]
pub struct Composite {
    /// The part without fibres.
    pub matrix: Matrix,
    /// The families of fibres.
    pub fibres: Vec<Fibres>,
    /// Constant active tensions; they add up.
    pub tones: Vec<Tone>,
}

/// A law without fibres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Matrix {
    /// Compressible neo-Hookean.
    NeoHookean(NeoHookean),
    /// Compressible Mooney–Rivlin.
    MooneyRivlin(MooneyRivlin),
    /// Yeoh.
    Yeoh(Yeoh),
    /// Demiray, exponential in the first invariant.
    Demiray(Demiray),
    /// Gent, with a limit of the extension.
    Gent(Gent),
    /// Fung, orthotropic.
    Fung(Fung),
}

/// Evaluates an expression with the law of a [`Matrix`].
macro_rules! with_matrix {
    ($matrix:expr, $law:ident => $value:expr) => {
        match $matrix {
            Matrix::NeoHookean($law) => $value,
            Matrix::MooneyRivlin($law) => $value,
            Matrix::Yeoh($law) => $value,
            Matrix::Demiray($law) => $value,
            Matrix::Gent($law) => $value,
            Matrix::Fung($law) => $value,
        }
    };
}

impl Matrix {
    /// Returns the shear modulus μ at small strains.
    pub fn shear_modulus(&self) -> f64 {
        match self {
            Self::NeoHookean(law) => law.mu,
            Self::MooneyRivlin(law) => law.a + law.b,
            Self::Yeoh(law) => law.shear_modulus(),
            Self::Demiray(law) => law.shear_modulus,
            Self::Gent(law) => law.shear_modulus,
            Self::Fung(law) => law.shear_modulus(),
        }
    }

    /// Returns the name of the law.
    pub fn name(&self) -> &'static str {
        match self {
            Self::NeoHookean(_) => "neo-Hookean",
            Self::MooneyRivlin(_) => "Mooney–Rivlin",
            Self::Yeoh(_) => "Yeoh",
            Self::Demiray(_) => "Demiray",
            Self::Gent(_) => "Gent",
            Self::Fung(_) => "Fung",
        }
    }

    /// Returns whether the energy depends on I₁ other than linearly.
    #[inline(always)]
    pub(super) fn is_curved(&self) -> bool {
        !matches!(self, Self::NeoHookean(_))
    }

    /// Returns whether the energy is zero.
    #[inline(always)]
    pub(super) fn is_nothing(&self) -> bool {
        matches!(self, Self::NeoHookean(law) if law.mu == 0.0 && law.lambda == 0.0)
    }

    /// Returns the coefficients of F⁻ᵀ dFᵀ F⁻ᵀ, of (F⁻ᵀ : dF) F⁻ᵀ and of dF in A : dF, and that of (F : dF) F.
    #[inline(always)]
    pub(super) fn coefficients<S: Real>(&self, F: &Tensor2<S>) -> ([S; 3], S) {
        let none = F.0[0][0].like(0.0);
        match self {
            Self::NeoHookean(law) => (law.coefficients(F), none),
            Self::MooneyRivlin(law) => law.coefficients(F),
            Self::Yeoh(law) => first_invariant::coefficients(law, F),
            Self::Demiray(law) => first_invariant::coefficients(law, F),
            Self::Gent(law) => first_invariant::coefficients(law, F),
            // Its tangent has another form, see `invariant_tangent`.
            Self::Fung(_) => ([none; 3], none),
        }
    }

    /// Returns the parts without and with the volumetric constant alone.
    fn parts(self) -> [Self; 2] {
        let volume = |bulk| {
            Self::NeoHookean(NeoHookean {
                mu: 0.0,
                lambda: bulk,
                volumetric: Volumetric::Quadratic,
            })
        };
        match self {
            Self::NeoHookean(law) => law.parts().map(Self::NeoHookean),
            Self::MooneyRivlin(law) => law.parts().map(Self::MooneyRivlin),
            Self::Yeoh(law) => [Self::Yeoh(Yeoh { bulk: 0.0, ..law }), volume(law.bulk)],
            Self::Demiray(law) => [
                Self::Demiray(Demiray { bulk: 0.0, ..law }),
                volume(law.bulk),
            ],
            Self::Gent(law) => [Self::Gent(Gent { bulk: 0.0, ..law }), volume(law.bulk)],
            Self::Fung(law) => [Self::Fung(Fung { bulk: 0.0, ..law }), volume(law.bulk)],
        }
    }
}

impl Composite {
    /// Returns a law without fibres and tensions.
    pub fn of(matrix: Matrix) -> Self {
        Self {
            matrix,
            fibres: vec![],
            tones: vec![],
        }
    }

    /// Returns an active tension without a matrix.
    pub fn only(tone: Tone) -> Self {
        let nothing = NeoHookean {
            mu: 0.0,
            lambda: 0.0,
            volumetric: Volumetric::Quadratic,
        };
        Self {
            matrix: Matrix::NeoHookean(nothing),
            fibres: vec![],
            tones: vec![tone],
        }
    }

    /// Returns the parts without and with the volumetric constant of the matrix.
    pub(super) fn parts(&self) -> [Self; 2] {
        let [shape, volume] = self.matrix.parts();
        [
            Self {
                matrix: shape,
                fibres: self.fibres.clone(),
                tones: self.tones.clone(),
            },
            Self {
                matrix: volume,
                fibres: vec![],
                tones: vec![],
            },
        ]
    }

    /// Returns whether reflection in a plane through the axis leaves the law unchanged: every family has a mirrored one, or
    /// its own mirror image. A wall without this symmetry twists when it is loaded.
    pub fn is_mirror_symmetric(&self) -> bool {
        let same = |a: &Fibres, b: &Fibres| {
            let ([x, _, y], [p, _, q]) = (a.direction(), b.direction());
            let parallel = (x * q - y * p).abs() < 1e-9;
            parallel && (a.k1, a.k2, a.dispersion) == (b.k1, b.k2, b.dispersion)
        };
        let count = |family: &Fibres| self.fibres.iter().filter(|f| same(f, family)).count();
        let pairs = |family: &Fibres| count(family) == count(&family.mirrored());
        let tones = self.tones.iter().all(Tone::is_mirror_symmetric);
        tones && self.fibres.iter().all(pairs)
    }
}

impl Law for Composite {
    type TangentData = ModuliData;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let matrix = with_matrix!(&self.matrix, law => law.energy(F));
        let w = self
            .fibres
            .iter()
            .fold(matrix, |w, family| w + family.energy(F));
        self.tones.iter().fold(w, |w, tone| w + tone.energy(F))
    }

    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let mut P = with_matrix!(&self.matrix, law => law.stress(F));
        for family in &self.fibres {
            family.add_stress(F, &mut P);
        }
        for tone in &self.tones {
            tone.add_stress(F, &mut P);
        }
        P
    }

    #[inline(always)]
    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let mut A = with_matrix!(&self.matrix, law => law.moduli(F));
        for family in &self.fibres {
            family.add_moduli(F, &mut A);
        }
        for tone in &self.tones {
            tone.add_moduli(F, &mut A);
        }
        A
    }
}
