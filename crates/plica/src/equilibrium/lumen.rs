//! A driven volume of the lumen, with the pressure as its multiplier.
//!
//! W(u) is to be stationary among the states of volume V(u) = V*. The energy
//!
//! W(u) − p₀ (V − V*) + ½ κ (V − V*)²
//!
//! is stationary at the same state if p₀ is the pressure that holds it, and the pressure p = p₀ − κ (V − V*) at its
//! stationary point is nearer to that than p₀ by the factor 1 + κ dV/dp (augmented Lagrangian; Hestenes 1969, Powell 1969).
//! So a step is repeated with p₀ renewed: once by this pressure, then along the secant of the two solutions. At the end the
//! volume is exact, and κ is of no influence.
//!
//! The tangent is K(p) + κ g gᵀ with g = ∂V/∂u. It is positive definite where the state is stable at a held volume, also
//! beyond a maximum of the pressure, where K(p) is not, as long as κ exceeds −dp/dV. An iterative solver needs one
//! scalar product more for it.

use crate::assembly::SplineTube;
use crate::matrix::RankOne;
use crate::tube::Load;

/// κ dV/dp of the tube at rest. A smaller one needs more repetitions; a larger one makes the energy so stiff that steps which
/// change the shape of the tube are cut short.
const STIFFNESS: f64 = 100.0;

/// Factor of κ in the tangent whose eigenvalues are reported: they are those at a held volume up to its reciprocal.
const HELD: f64 = 1e4;

/// Largest error of the volume that is left, relative to that at rest.
const EXACT: f64 = 1e-11;

/// First number of a history that begins with that of a driven volume. Other histories begin with no negative number.
const MARK: f64 = -1.0;

/// The driven volume of a problem. Volumes are those of the whole tube.
#[derive(Clone, Debug)]
pub struct DrivenLumen {
    /// κ.
    stiffness: f64,
    /// Volume of the stress-free shape.
    at_rest: f64,
    step: Option<Step>,
}

/// The step that a path has begun. Volumes are ratios to that at rest.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    /// Pressure and volume of the state at which the segment of the path begins.
    start: [f64; 2],
    /// Pressure and volume of the state at which the step begins.
    from: [f64; 2],
    /// Change of the pressure with the volume in the step before.
    slope: f64,
    /// p₀, once it is renewed.
    renewed: Option<f64>,
    /// p₀ and V − V* of the solution before the last one.
    before: Option<[f64; 2]>,
}

/// Splits a history into the numbers of the driven volume (pressure and volume at the start of the segment, and the slope) and
/// the rest.
fn split(history: &[f64]) -> (Option<[f64; 3]>, &[f64]) {
    match history {
        [MARK, pressure, volume, slope, rest @ ..] => (Some([*pressure, *volume, *slope]), rest),
        all => (None, all),
    }
}

/// Returns a history without the numbers of a driven volume.
pub fn without_lumen(history: &[f64]) -> &[f64] {
    split(history).1
}

/// Returns the load at the start of a segment that leads to another load, from the history of a state on the segment: with the
/// pressure and the volume of the state at which it began.
pub fn segment_start(from: Load, to: &Load, history: &[f64]) -> Load {
    match split(history).0 {
        Some([pressure, volume, _]) => switched(from, to, [pressure, volume]),
        None => from,
    }
}

/// Returns the load at the start of a segment, which drives the same of pressure and volume as its end.
fn switched(mut from: Load, to: &Load, [pressure, volume]: [f64; 2]) -> Load {
    if from.lumen_volume.is_some() != to.lumen_volume.is_some() {
        from.pressures[0].follower = pressure;
        from.lumen_volume = to.lumen_volume.map(|_| volume);
    }
    from
}

impl DrivenLumen {
    /// Makes the driven volume of a tube.
    pub fn new(tube: &SplineTube) -> Self {
        let at_rest = tube.lumen_volume_at_rest();
        let radius = tube.tube.inner_radius();
        let membrane =
            2.0 * radius * at_rest / (tube.tube.longitudinal_modulus() * tube.tube.thickness);
        let usual = compliance(&tube.axisymmetric()).unwrap_or(membrane);
        Self {
            stiffness: STIFFNESS / usual,
            at_rest,
            step: None,
        }
    }

    /// Returns the volume of the stress-free shape.
    pub fn at_rest(&self) -> f64 {
        self.at_rest
    }

    /// Begins a step at a state with its history.
    pub fn begin_step(&mut self, tube: &SplineTube, (load, u): (&Load, &[f64]), history: &[f64]) {
        let pressure = load.pressures[0].follower;
        let volume = || tube.lumen_volume(u) / self.at_rest;
        let from = [pressure, load.lumen_volume.unwrap_or_else(volume)];
        let [start @ .., slope] = split(history).0.unwrap_or([from[0], from[1], 0.0]);
        self.step = Some(Step {
            start,
            from,
            slope: load.lumen_volume.map_or(0.0, |_| slope),
            renewed: None,
            before: None,
        });
    }

    /// Begins a segment between two loads at a state, whose history becomes that at the start of the segment. Returns the
    /// load of the state from which the segment begins.
    pub fn begin_segment(
        &mut self,
        tube: &SplineTube,
        (from, to): (Load, &Load),
        u: &[f64],
        history: &mut Vec<f64>,
    ) -> Load {
        let (before, rest) = split(history);
        let slope = before.map_or(0.0, |[.., slope]| slope);
        let pressure = from.pressures[0].follower;
        let volume = || tube.lumen_volume(u) / self.at_rest;
        let volume = from.lumen_volume.unwrap_or_else(volume);
        *history = [&[MARK, pressure, volume, slope], rest].concat();
        let from = switched(from, to, [pressure, volume]);
        self.begin_step(tube, (&from, u), history);
        from
    }

    /// Returns p₀ of a load.
    fn multiplier(&self, load: &Load, volume: f64) -> f64 {
        match &self.step {
            None => load.pressures[0].follower,
            Some(step) => {
                let predicted = step.from[0] + step.slope * (volume - step.from[1]);
                step.renewed.unwrap_or(predicted)
            }
        }
    }

    /// Returns V − V*, p₀ and p at a state; none of a load that does not drive the volume.
    fn pressure(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Option<[f64; 3]> {
        let volume = load.lumen_volume?;
        let excess = tube.lumen_volume(u) - volume * self.at_rest;
        let multiplier = self.multiplier(load, volume);
        Some([excess, multiplier, multiplier - self.stiffness * excess])
    }

    /// Returns the load with the pressure p at a state, and the energy to be added to that under it on the whole tube.
    pub fn held(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Option<(Load, f64)> {
        let [excess, multiplier, pressure] = self.pressure(tube, load, u)?;
        let mut held = load.clone();
        held.pressures[0].follower = pressure;
        // The potential of the pressure is −p (V − V₀), with V₀ at zero displacement.
        let volume = excess + load.lumen_volume.unwrap_or(0.0) * self.at_rest;
        let change = volume - tube.lumen_volume_of_cylinder();
        let energy =
            pressure * change - multiplier * excess + 0.5 * self.stiffness * excess * excess;
        Some((held, energy))
    }

    /// Returns the load with the pressure p at a state, if it drives the volume.
    pub fn completed(&self, tube: &SplineTube, load: Load, u: &[f64]) -> Load {
        match self.held(tube, &load, u) {
            Some((held, _)) => held,
            None => load,
        }
    }

    /// Returns the term of the tangent of a sector under a load that drives the volume.
    pub fn term(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Option<RankOne> {
        load.lumen_volume?;
        // The energy of a sector is that of the tube over their number, and its V changes by that number times g · du.
        Some(RankOne {
            factor: self.stiffness * tube.sector.repeats(),
            vector: tube.lumen_volume_slope(u),
        })
    }

    /// Returns the term with a κ that holds the volume in eigenvalues.
    pub fn holding_term(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Option<RankOne> {
        let mut term = self.term(tube, load, u)?;
        term.factor *= HELD;
        Some(term)
    }

    /// Renews p₀ from a solution. Returns false if the volume is exact.
    pub fn renew(&mut self, tube: &SplineTube, load: &Load, u: &[f64]) -> bool {
        let Some([excess, multiplier, pressure]) = self.pressure(tube, load, u) else {
            return false;
        };
        let Some(step) = self
            .step
            .as_mut()
            .filter(|_| excess.abs() > EXACT * self.at_rest)
        else {
            return false;
        };
        let secant = step.before.map(|[before, more]| {
            let slope = (excess - more) / (multiplier - before);
            multiplier - excess / slope
        });
        // The secant goes on where the first renewal led to, and not much farther.
        let farther = |p: &f64| (p - multiplier).abs() <= 10.0 * (pressure - multiplier).abs();
        step.renewed = Some(secant.filter(farther).unwrap_or(pressure));
        step.before = Some([multiplier, excess]);
        true
    }

    /// Returns the numbers with which the history of a state begins.
    pub fn history(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Vec<f64> {
        let Some(step) = &self.step else {
            return vec![];
        };
        let mut slope = step.slope;
        if let (Some(volume), Some([.., pressure])) =
            (load.lumen_volume, self.pressure(tube, load, u))
            && volume != step.from[1]
        {
            slope = (pressure - step.from[0]) / (volume - step.from[1]);
        }
        vec![MARK, step.start[0], step.start[1], slope]
    }
}

/// Returns dV/dp of a tube of one ring at rest; none if that is not positive.
fn compliance(ring: &SplineTube) -> Option<f64> {
    let zero = vec![0.0; ring.unknowns()];
    let u = ring.geometric_imperfection().unwrap_or(&zero);
    let mut stiffness = ring.tangent(&ring.tube.rest(), u);
    stiffness.constrain(ring.prescribed());
    let mut slope = ring.lumen_volume_slope(u);
    for (g, prescribed) in slope.iter_mut().zip(ring.prescribed()) {
        *g = if *prescribed { 0.0 } else { *g };
    }
    let mut moved = slope.clone();
    stiffness.factor().ok()?.solve(&mut moved);
    let change: f64 = slope.iter().zip(&moved).map(|(g, u)| g * u).sum();
    let compliance = ring.sector.repeats() * change;
    (compliance > 0.0 && compliance.is_finite()).then_some(compliance)
}
