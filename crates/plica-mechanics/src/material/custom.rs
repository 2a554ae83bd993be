//! A law defined outside this crate.

use super::{Law, Moduli, ModuliData};
use crate::tensor::{Lanes, Real, Tensor2, with_vectors};
use fearless_simd::{Simd, f64x8};
use std::fmt;
use std::sync::Arc;

/// A law defined outside this crate, for [`Material::Custom`](super::Material::Custom).
///
/// Each evaluation is a virtual call with eight numbers per component. Two of these are equal if
/// they are clones of one.
#[derive(Clone)]
pub struct CustomLaw(Arc<dyn LaneLaw>);

impl CustomLaw {
    /// Wraps a law.
    pub fn new(law: impl Law + 'static) -> Self {
        Self(Arc::new(law))
    }
}

impl PartialEq for CustomLaw {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for CustomLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CustomLaw")
    }
}

impl Law for CustomLaw {
    type TangentData = ModuliData;

    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        Law::energy(&ByLanes(&*self.0), F)
    }

    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        Law::stress(&ByLanes(&*self.0), F)
    }

    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        Law::moduli(&ByLanes(&*self.0), F)
    }
}

/// A law whose numbers pass through memory, eight at a time, so that the element kernels call it.
#[derive(Clone, Copy)]
pub(super) struct ByLanes<'a, L: ?Sized>(pub &'a L);

impl<L: LaneLaw + ?Sized> Law for ByLanes<'_, L> {
    type TangentData = ModuliData;

    fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        F.0[0][0].like_lanes(self.0.energy(&lanes(F)))
    }

    fn stress<S: Real>(&self, F: &Tensor2<S>) -> Tensor2<S> {
        let P = self.0.stress(&lanes(F));
        Tensor2(P.0.map(|row| row.map(|x| F.0[0][0].like_lanes(x))))
    }

    fn moduli<S: Real>(&self, F: &Tensor2<S>) -> Moduli<S> {
        let A = self.0.moduli(&lanes(F));
        A.map(|row| row.map(|x| F.0[0][0].like_lanes(x)))
    }
}

/// A law evaluated on eight lanes, without generic methods.
pub(super) trait LaneLaw: Send + Sync {
    fn energy(&self, F: &Tensor2<Lanes>) -> Lanes;
    fn stress(&self, F: &Tensor2<Lanes>) -> Tensor2<Lanes>;
    fn moduli(&self, F: &Tensor2<Lanes>) -> Moduli<Lanes>;
}

impl<L: Law> LaneLaw for L {
    fn energy(&self, F: &Tensor2<Lanes>) -> Lanes {
        with_vectors!(simd => Lanes::store(Law::energy(self, &vectors(simd, F))))
    }

    fn stress(&self, F: &Tensor2<Lanes>) -> Tensor2<Lanes> {
        with_vectors!(simd => {
            let P = Law::stress(self, &vectors(simd, F));
            Tensor2(P.0.map(|row| row.map(Lanes::store)))
        })
    }

    fn moduli(&self, F: &Tensor2<Lanes>) -> Moduli<Lanes> {
        with_vectors!(simd => {
            Law::moduli(self, &vectors(simd, F)).map(|row| row.map(Lanes::store))
        })
    }
}

/// Stores the components of eight tensors.
pub(super) fn lanes<S: Real>(F: &Tensor2<S>) -> Tensor2<Lanes> {
    Tensor2(F.0.map(|row| row.map(Real::to_lanes)))
}

/// Loads the components of eight tensors.
#[inline(always)]
pub(super) fn vectors<S: Simd>(simd: S, F: &Tensor2<Lanes>) -> Tensor2<f64x8<S>> {
    Tensor2(F.0.map(|row| row.map(|x| x.load(simd))))
}
