//! The stretches at which lateral stresses vanish.

use crate::material::{Law, Material};
use crate::tensor::Tensor2;

/// Newton iterations.
const ITERATIONS: usize = 100;
/// Largest change of a logarithmic stretch in an iteration.
const LARGEST_STEP: f64 = 0.3;
/// Relative size of a lateral stress that counts as zero.
const ZERO: f64 = 1e-11;

/// Treatment of the change of volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Volume {
    /// As the law has it.
    Free,
    /// The volume is constant, and a pressure takes the place of the volumetric energy.
    Constant,
}

/// Prescribed stretches; the stress in a direction without one is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prescribed {
    /// Along the tube.
    pub along: Option<f64>,
    /// Around it.
    pub around: Option<f64>,
}

/// A homogeneous deformation without stress through the wall. Directions are along, outwards, around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous {
    /// Stretches.
    pub stretches: [f64; 3],
    /// Cauchy stresses.
    pub cauchy: [f64; 3],
}

impl Homogeneous {
    /// Returns the nominal stresses: force per area at rest.
    pub fn nominal(&self) -> [f64; 3] {
        let J: f64 = self.stretches.iter().product();
        [0, 1, 2].map(|i| J * self.cauchy[i] / self.stretches[i])
    }

    /// Returns p R/H of a thin tube: its pressure times its radius over its thickness, both at rest.
    pub fn thin_tube_pressure(&self) -> f64 {
        let [_, outwards, around] = self.stretches;
        self.cauchy[2] * outwards / around
    }
}

/// Returns the deformation with some prescribed stretches, or none if no such state is found: a law may have none.
pub fn homogeneous(law: &Material, prescribed: Prescribed, volume: Volume) -> Option<Homogeneous> {
    let given = [prescribed.along, None, prescribed.around];
    // Logarithmic stretches e = e0 + Σ q d over the directions d of the unknowns q.
    let mut e = given.map(|x| x.map_or(0.0, f64::ln));
    let mut unknowns: Vec<[f64; 3]> = vec![];
    for i in [0, 2] {
        if given[i].is_none() {
            let mut d = [0.0; 3];
            d[i] = 1.0;
            if volume == Volume::Constant {
                d[1] = -1.0;
            }
            unknowns.push(d);
            // Nearly that of an isotropic law without change of volume.
            e[i] = -0.5 * e[2 - i];
        }
    }
    e[1] = -e[0] - e[2];
    if volume == Volume::Free {
        unknowns.push([0.0, 1.0, 0.0]);
    }
    for _ in 0..ITERATIONS {
        let here = At::new(law, e)?;
        let scale = here.stiffness();
        let r: Vec<f64> = unknowns.iter().map(|d| dot(*d, here.t)).collect();
        if r.iter().all(|r| r.abs() <= ZERO * scale) {
            return Some(here.result(volume));
        }
        let mut step = here.newton_step(&unknowns, &r);
        let largest = step.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        step = step.map(|x| x * (LARGEST_STEP / largest).min(1.0));
        // The state is a minimum of the energy.
        let mut factor = 1.0;
        e = loop {
            let ahead = [0, 1, 2].map(|i| e[i] + factor * step[i]);
            let lower = At::new(law, ahead).is_some_and(|at| at.w <= here.w + 1e-14 * scale);
            if lower {
                break ahead;
            }
            factor *= 0.5;
            if factor < 1e-12 {
                return None;
            }
        };
    }
    None
}

/// A law at logarithmic stretches e: w, t_i = ∂w/∂e_i = P_i λ_i, and S = ∂t/∂e.
struct At {
    stretches: [f64; 3],
    w: f64,
    t: [f64; 3],
    S: [[f64; 3]; 3],
}

impl At {
    /// Returns none where the law has no finite stress.
    fn new(law: &Material, e: [f64; 3]) -> Option<Self> {
        let stretches = e.map(f64::exp);
        let mut F = Tensor2::IDENTITY;
        for i in 0..3 {
            F.0[i][i] = stretches[i];
        }
        let (w, P, A) = (law.energy(&F), law.stress(&F), law.moduli(&F));
        let t = [0, 1, 2].map(|i| P.0[i][i] * stretches[i]);
        let mut S = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in i..3 {
                S[i][j] = stretches[i] * A[4 * i][4 * j] * stretches[j];
                S[j][i] = S[i][j];
            }
            S[i][i] += t[i];
        }
        let finite = w.is_finite() && S.iter().flatten().chain(&t).all(|x| x.is_finite());
        finite.then_some(Self { stretches, w, t, S })
    }

    fn stiffness(&self) -> f64 {
        let S = &self.S;
        let stresses = self.t.iter().map(|t| t.abs());
        stresses.fold(S[0][0].abs().max(S[2][2].abs()), f64::max)
    }

    /// Returns the change of e that solves r + Bᵀ S B q = 0, or one that lowers the energy where that matrix is indefinite.
    fn newton_step(&self, unknowns: &[[f64; 3]], r: &[f64]) -> [f64; 3] {
        let k = |a: [f64; 3], b: [f64; 3]| {
            let Sb = [0, 1, 2].map(|i| dot(self.S[i], b));
            dot(a, Sb)
        };
        let q: Vec<f64> = match unknowns {
            [d] => vec![-r[0] / k(*d, *d).abs()],
            [c, d] => {
                let (cc, cd, dd) = (k(*c, *c), k(*c, *d), k(*d, *d));
                let det = cc * dd - cd * cd;
                match cc > 0.0 && det > 0.0 {
                    true => vec![(cd * r[1] - dd * r[0]) / det, (cd * r[0] - cc * r[1]) / det],
                    false => vec![-r[0] / cc.abs(), -r[1] / dd.abs()],
                }
            }
            _ => vec![],
        };
        [0, 1, 2].map(|i| unknowns.iter().zip(&q).map(|(d, q)| q * d[i]).sum())
    }

    fn result(&self, volume: Volume) -> Homogeneous {
        let cauchy = match volume {
            Volume::Free => {
                let J: f64 = self.stretches.iter().product();
                self.t.map(|t| t / J)
            }
            Volume::Constant => self.t.map(|t| t - self.t[1]),
        };
        Homogeneous {
            stretches: self.stretches,
            cauchy,
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
