//! A matrix with fibres: the sum of another law, of any number of families of fibres, and of an active tension.
//!
//! Evaluated eight numbers at a time through memory, like a custom law: the element kernels are not compiled for it again.

use super::first_invariant::FirstInvariant;
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
    /// A constant active tension.
    pub tone: Option<Tone>,
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
            tone: Some(tone),
        }
    }

    /// Returns the parts without and with the volumetric constant of the matrix.
    pub(super) fn parts(&self) -> [Self; 2] {
        let [shape, volume] = self.matrix.parts();
        [
            Self {
                matrix: shape,
                fibres: self.fibres.clone(),
                tone: self.tone.clone(),
            },
            Self {
                matrix: volume,
                fibres: vec![],
                tone: None,
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
        let tone = self
            .tone
            .as_ref()
            .is_none_or(|tone| tone.is_mirror_symmetric());
        tone && self.fibres.iter().all(pairs)
    }
}

impl Law for Composite {
    type TangentData<S: Real> = ModuliData<S>;

    #[inline(always)]
    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        let matrix = with_matrix!(&self.matrix, law => law.energy(F));
        let w = self
            .fibres
            .iter()
            .fold(matrix, |w, family| w + family.energy(F));
        match &self.tone {
            Some(tone) => w + tone.energy(F),
            None => w,
        }
    }

    #[inline(always)]
    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let mut P = with_matrix!(&self.matrix, law => law.stress(F));
        for family in &self.fibres {
            family.add_stress(F, &mut P);
        }
        if let Some(tone) = &self.tone {
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
        if let Some(tone) = &self.tone {
            tone.add_moduli(F, &mut A);
        }
        A
    }
}
