//! Advice on driven tensions with which a wall loses ellipticity.
//!
//! The states of a stage are estimated as those of a thin tube of the same layers: its length is that of the tube, and its
//! circumference balances the pressures and the tensions, or encloses the driven volume. Ends, neighbouring sections and the
//! thickness of the wall change them.
#![allow(non_snake_case)] // the formulas keep the letters of their sources

use crate::homogeneous::{Homogeneous, Prescribed, Volume, homogeneous, least_wave_stiffness};
use crate::material::{Composite, Material, Matrix, Tone};
use crate::study::Plan;
use crate::tensor::Tensor2;
use crate::tube::{Load, Tube};

/// States of a stage that are estimated.
const STATES: usize = 16;
/// Points along the tube among which the place of the largest tension of a muscle is chosen.
const POINTS: usize = 96;
/// Step of the logarithm of the stretch around in the search for equilibrium.
const STEP: f64 = 0.02;
/// Steps of that search in each direction.
const REACH: usize = 60;

/// A state at which the law of a layer is not elliptic.
pub(super) struct Lost {
    /// Number of the stage.
    pub stage: usize,
    /// Name of the muscle.
    pub muscle: String,
    /// Its tension there, in E.
    pub tension: f64,
    /// Elastic stretches along and around.
    pub stretches: [f64; 2],
}

/// Returns the first estimated state of a plan at which the law of a layer is not elliptic because of a driven tension.
pub(super) fn lost(plan: &Plan, layer: usize) -> Option<Lost> {
    let tube = &plan.tube;
    let idle = &tube.layers[layer].idle_muscles;
    let mut muscles = vec![];
    for (m, muscle) in tube.muscles.iter().enumerate() {
        if !muscle.grows() && !idle.contains(&m) {
            muscles.push((m, 1.0));
        }
    }
    for (stage, own) in plan.stages.iter().enumerate() {
        let mut begin = plan.load_before(stage);
        if begin.lumen_volume.is_none() && own.load.lumen_volume.is_some() {
            // The volume at the start is that of the last estimate.
            let around = muscles.first().map_or(1.0, |(_, around)| *around);
            begin.lumen_volume = Some(enclosed(tube, &begin, around));
        }
        for state in 1..=STATES {
            let load = own.load_at(&begin, state as f64 / STATES as f64);
            for (m, around) in &mut muscles {
                if load.muscles[*m] == 0.0 && begin.muscles[*m] == 0.0 {
                    continue;
                }
                let section = Section::of(plan, &load, *m);
                if let Some(found) = section.stretch_around(*around) {
                    *around = found;
                }
                if section.tensions[layer].is_empty() {
                    continue;
                }
                let elliptic = |stretches: &[f64; 2]| section.is_elliptic(layer, *stretches);
                let lost = section.elastic(layer, *around).into_iter();
                let mut lost = lost.filter(|stretches| !elliptic(stretches));
                if let Some(stretches) = lost.next() {
                    return Some(Lost {
                        stage,
                        muscle: tube.muscles[*m].name.clone(),
                        tension: load.muscles[*m],
                        stretches,
                    });
                }
            }
        }
    }
    None
}

/// Returns the length of a tube under a load over that at rest.
fn extension(tube: &Tube, load: &Load) -> f64 {
    let [first, last] = load.ends.map(|end| end.displacement);
    1.0 + (last - first) / tube.length
}

/// Returns the volume of the lumen over that at rest, where the middle of the wall is stretched around by `around`.
fn enclosed(tube: &Tube, load: &Load, around: f64) -> f64 {
    let (inner, middle) = (tube.inner_radius(), middle(tube));
    let squares = around * around * extension(tube, load) - 1.0;
    1.0 + squares * (middle / inner).powi(2)
}

/// Returns the radius of the middle of the wall at rest.
fn middle(tube: &Tube) -> f64 {
    0.5 * (tube.inner_radius() + Tube::OUTER_RADIUS)
}

/// A section of the tube under a load.
struct Section<'a> {
    tube: &'a Tube,
    load: Load,
    /// Growth stretches of the layers.
    growth: Vec<[f64; 2]>,
    /// Tensions of the layers.
    tensions: Vec<Vec<Tone>>,
    /// Length over that at rest.
    extension: f64,
}

impl<'a> Section<'a> {
    /// Returns the section at which the tension of a muscle is largest.
    fn of(plan: &'a Plan, load: &Load, muscle: usize) -> Self {
        let tube = &plan.tube;
        let tension = |m: usize, z: f64| {
            let own = &tube.muscles[m];
            load.muscles[m] * own.activity(own.unshifted(z, load.shifts[m]))
        };
        let mut z = 0.0;
        for point in 0..=POINTS {
            let at = tube.length * point as f64 / POINTS as f64;
            if tension(muscle, at) > tension(muscle, z) {
                z = at;
            }
        }
        let layers = 0..tube.layers.len();
        let tones = |layer: usize| {
            let mut tones = vec![];
            for (m, own) in tube.muscles.iter().enumerate() {
                let acts = !tube.layers[layer].idle_muscles.contains(&m);
                if let (Some(unit), true) = (&own.active_stress, acts && tension(m, z) != 0.0) {
                    let mut tone = unit.clone();
                    tone.tension *= tension(m, z);
                    tones.push(tone);
                }
            }
            tones
        };
        let growth = |layer| <[f64; 2]>::from(tube.stretches(layer, z, load));
        Self {
            tube,
            load: load.clone(),
            growth: layers.clone().map(growth).collect(),
            tensions: layers.map(tones).collect(),
            extension: extension(tube, load),
        }
    }

    /// Returns the elastic stretches along and around of a layer at its two faces and between them.
    fn elastic(&self, layer: usize, around: f64) -> [[f64; 2]; 3] {
        let faces = self.tube.faces();
        let [inner, outer] = [faces[layer], faces[layer + 1]];
        [0.5 * (inner + outer), inner, outer].map(|radius| {
            let residual = self.tube.residual_stretch(layer, radius);
            let [theta_z, theta_t] = self.growth[layer];
            [
                self.extension / (theta_z * residual[0]),
                around / (theta_t * residual[1]),
            ]
        })
    }

    /// Returns the law of a layer with its tensions; none for a custom law.
    fn law(&self, layer: usize) -> Option<Material> {
        let mut law = match &self.tube.layers[layer].material {
            Material::NeoHookean(law) => Composite::of(Matrix::NeoHookean(*law)),
            Material::MooneyRivlin(law) => Composite::of(Matrix::MooneyRivlin(*law)),
            Material::Composite(law) => law.clone(),
            Material::Custom(_) => return None,
        };
        law.tones.extend(self.tensions[layer].iter().cloned());
        Some(Material::Composite(law))
    }

    fn state(&self, law: &Material, [along, around]: [f64; 2]) -> Option<Homogeneous> {
        let prescribed = Prescribed {
            along: Some(along),
            around: Some(around),
        };
        homogeneous(law, prescribed, Volume::Free)
    }

    /// Returns whether the law of a layer is elliptic at elastic stretches, or has no state there.
    fn is_elliptic(&self, layer: usize, stretches: [f64; 2]) -> bool {
        let Some(law) = self.law(layer) else {
            return true;
        };
        self.state(&law, stretches).is_none_or(|state| {
            let [along, outwards, around] = state.stretches;
            let Fe = Tensor2([[along, 0.0, 0.0], [0.0, outwards, 0.0], [0.0, 0.0, around]]);
            least_wave_stiffness(&law, &Fe) > 0.0
        })
    }

    /// Returns the stretch around of the middle of the wall; in equilibrium it is the one nearest to that before. None if
    /// there is none within reach.
    fn stretch_around(&self, before: f64) -> Option<f64> {
        let [inner, outer] = [self.tube.inner_radius(), Tube::OUTER_RADIUS];
        let middle = middle(self.tube);
        if let Some(volume) = self.load.lumen_volume {
            // The area of the wall falls as its length grows.
            let squares = volume * inner * inner + middle * middle - inner * inner;
            return Some((squares / self.extension).sqrt() / middle);
        }
        let pressure = self.load.pressures.map(|own| own.follower + own.dead);
        let force = (pressure[0] * inner - pressure[1] * outer) / self.tube.thickness;
        let laws: Option<Vec<Material>> = (0..self.growth.len()).map(|l| self.law(l)).collect();
        let laws = laws?;
        // Force around per thickness and length at rest, of the layers less that of the pressures.
        let excess = |around: f64| {
            let mut sum = 0.0;
            for (layer, law) in laws.iter().enumerate() {
                let [stretches, ..] = self.elastic(layer, around);
                let state = self.state(law, stretches)?;
                let own = state.cauchy[2] * state.stretches[1] / around;
                sum += self.tube.layers[layer].share * own;
            }
            Some(sum - force)
        };
        let first = excess(before)?;
        let way = if first > 0.0 { -STEP } else { STEP };
        let (mut near, mut far) = (before, before);
        for _ in 0..REACH {
            far *= way.exp();
            if (excess(far)? > 0.0) != (first > 0.0) {
                for _ in 0..12 {
                    let between = (near * far).sqrt();
                    match (excess(between)? > 0.0) == (first > 0.0) {
                        true => near = between,
                        false => far = between,
                    }
                }
                return Some(far);
            }
            near = far;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_and_tension_balance_in_the_estimate() {
        let text = "ends = { colon = 'sliding', ileum = 'sliding' }\n[muscles.ring]\ndirection = 'circular'\n\
                    zone = [0.5, 1.0]\nactive_stress = {}\n[[stages]]\n\
                    drive.inner-wall.pressure = 0.03\ndrive.ring.tension = 0.1\n";
        let plan = crate::case::read(text, "case").unwrap();
        let mut load = plan.stages[0].load.clone();
        // An incompressible membrane: (μ (λ − λ⁻³) + T)/λ = p R/H, with μ = 1/3.
        for (p, tension) in [(0.0, 0.1), (0.03, 0.0), (0.03, 0.1)] {
            (load.pressures[0].follower, load.muscles[0]) = (p, tension);
            let excess = |x: f64| ((x - x.powi(-3)) / 3.0 + tension) / x - p * 0.44 / 0.06;
            let (mut low, mut high) = (0.5, 1.5);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                match excess(middle) < 0.0 {
                    true => low = middle,
                    false => high = middle,
                }
            }
            let found = Section::of(&plan, &load, 0).stretch_around(1.0).unwrap();
            assert!(
                (found / low - 1.0).abs() < 0.02,
                "{p} {tension}: {found} {low}"
            );
        }
        // No equilibrium beyond the largest pressure that the membrane bears.
        load.pressures[0].follower = 0.06;
        assert_eq!(Section::of(&plan, &load, 0).stretch_around(1.0), None);
        // The driven volume decides, and is that of the estimate.
        load.lumen_volume = Some(1.7);
        let around = Section::of(&plan, &load, 0).stretch_around(1.0).unwrap();
        assert!((enclosed(&plan.tube, &load, around) - 1.7).abs() < 1e-12);
    }
}
