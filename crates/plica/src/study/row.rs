//! A state as a row of `history.csv`.

use super::{Scale, State};
use crate::equilibrium::Stability;
use crate::measure::{Shape, Side};
use crate::solve::Method;
use serde::{Deserialize, Serialize};

/// The numbers of an accepted state: a row of `history.csv`. Lengths in D, energies in E·D³ and pressures in E, unless
/// the case has units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the state, from 0 (the tube at rest, or the state the study starts from).
    pub step: usize,
    /// Name of the stage.
    pub stage: String,
    /// Grown length over length, Lmax/L.
    pub length_ratio: f64,
    /// Narrowest grown diameter over diameter, Dmin/D.
    pub diameter_ratio: f64,
    /// Axial displacement of the colon end.
    pub colon_displacement: f64,
    /// Axial displacement of the ileum end.
    pub ileum_displacement: f64,
    /// Twist of the colon end about the axis, in degrees.
    pub colon_twist_deg: f64,
    /// Twist of the ileum end.
    pub ileum_twist_deg: f64,
    /// Follower pressure on the inner wall; this and the next four columns exist only in runs with pressures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_pressure: Option<f64>,
    /// Follower pressure on the outer wall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_pressure: Option<f64>,
    /// Dead load on the inner wall, per area at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_dead_load: Option<f64>,
    /// Dead load on the outer wall, per area at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_dead_load: Option<f64>,
    /// Strain energy plus the potential of the pressures, which is zero at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub potential: Option<f64>,
    /// Strain energy W = ∫ w det Fp dV₀, over the grown volume.
    pub energy: f64,
    /// Strain energy ∫ w dV₀, over the ungrown volume, as some other programs report it.
    pub energy_ungrown_volume: f64,
    /// Relative residual without damping.
    pub residual: f64,
    /// Work done against damping since the previous state.
    pub damping_work: f64,
    /// Method by which the state was found: rest, newton, relaxation or pseudo-time.
    pub method: Method,
    /// Whether the state is in equilibrium: yes or no.
    #[serde(rename = "equilibrium", with = "yes_or_no")]
    pub in_equilibrium: bool,
    /// Linear solves since the previous state, including those of rejected attempts.
    pub iterations: usize,
    /// Conjugate-gradient iterations; 0 for the direct solver.
    pub cg_iterations: usize,
    /// Wall time since the previous state, in seconds.
    pub seconds: f64,
    /// Smallest radius of the outer wall, about the axis of the deformed tube.
    pub outer_radius_min: f64,
    /// Axial position of the smallest radius.
    pub z_at_min: f64,
    /// Steepest angle of the outer wall to the axis; past 90 it overhangs.
    pub max_wall_angle_deg: f64,
    /// Largest distance over which the outer wall runs back along the axis.
    pub overhang: f64,
    /// The side on which the wall overhangs: colon, ileum or none.
    pub side: Side,
    /// Axial extent of the outer wall beyond ¾ of the depth of narrowing, over that beyond ¼; 0 for a tube that is not narrowed.
    pub flatness: f64,
    /// Smallest distance of a wall from itself; 0 if it crosses itself.
    pub gap: f64,
    /// Narrowest width of the lumen; negative where walls have passed through each other.
    pub lumen: f64,
    /// Shape of the contracting region: V, U, square, invaginated, swollen, collapsed or straight.
    pub shape: Shape,
    /// Asymmetry amplitude: amplitude of the largest circumferential wave of the outer wall.
    pub asymmetry: f64,
    /// Circumferential mode of that wave; 0 if the tube is axisymmetric.
    pub asymmetry_mode: usize,
    /// Reference angle of a crest of that wave, from −180/n to 180/n.
    pub asymmetry_angle_deg: f64,
    /// Smallest det Fe at any quadrature point.
    pub min_det_fe: f64,
    /// Modes with negative eigenvalues of the tangent; see [`crate::equilibrium::test_stability`].
    #[serde(rename = "unstable_modes")]
    pub stability: Stability,
}

impl Row {
    /// Converts a state to the units of its case. The columns of pressures are written only if the case has pressures.
    pub fn new(state: &State, scale: &Scale, has_pressures: bool) -> Self {
        let (length, energy, measures) = (scale.length, scale.energy, &state.measures);
        let [colon, ileum] = state.load.ends;
        let [inner, outer] = state.load.pressures;
        let pressure = |p: f64| has_pressures.then_some(scale.stress * p);
        Self {
            step: state.number,
            stage: state.stage.clone(),
            length_ratio: state.length_ratio(),
            diameter_ratio: state.diameter_ratio(),
            colon_displacement: length * colon.displacement,
            ileum_displacement: length * ileum.displacement,
            colon_twist_deg: colon.twist.to_degrees(),
            ileum_twist_deg: ileum.twist.to_degrees(),
            inner_pressure: pressure(inner.follower),
            outer_pressure: pressure(outer.follower),
            inner_dead_load: pressure(inner.dead),
            outer_dead_load: pressure(outer.dead),
            potential: has_pressures.then_some(energy * state.potential),
            energy: energy * state.energy,
            energy_ungrown_volume: energy * state.energy_ungrown_volume,
            residual: state.relative_residual,
            damping_work: energy * state.sectors * state.sector_damping_work,
            method: state.method,
            in_equilibrium: state.in_equilibrium,
            iterations: state.linear_solves,
            cg_iterations: state.inner_iterations,
            seconds: state.seconds,
            outer_radius_min: length * measures.outer_radius_min,
            z_at_min: length * measures.z_at_min,
            max_wall_angle_deg: measures.max_wall_angle_deg,
            overhang: length * measures.overhang,
            side: measures.side,
            flatness: measures.flatness,
            gap: length * measures.gap,
            lumen: length * measures.lumen,
            shape: measures.shape,
            asymmetry: length * measures.asymmetry.amplitude,
            asymmetry_mode: measures.asymmetry.harmonic,
            asymmetry_angle_deg: measures.asymmetry.crest.to_degrees(),
            min_det_fe: state.min_det_fe,
            stability: state.stability.clone(),
        }
    }

    /// Adds the columns of pressures, with zeros, to a row without them.
    #[must_use]
    pub fn with_pressures(mut self) -> Self {
        for pressure in [
            &mut self.inner_pressure,
            &mut self.outer_pressure,
            &mut self.inner_dead_load,
            &mut self.outer_dead_load,
        ] {
            pressure.get_or_insert(0.0);
        }
        self.potential.get_or_insert(self.energy);
        self
    }

    /// Returns whether a wall crosses itself. Nothing prevents it without contact.
    pub fn crosses_itself(&self) -> bool {
        self.gap == 0.0
    }

    /// Returns whether opposite walls touch or have passed through each other.
    pub fn has_closed(&self) -> bool {
        self.lumen <= 0.0
    }
}

/// A truth value written as `yes` or `no`.
mod yes_or_no {
    use serde::de::{Deserialize, Deserializer, Error};

    pub fn serialize<S: serde::Serializer>(value: &bool, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(if *value { "yes" } else { "no" })
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<bool, D::Error> {
        match String::deserialize(from)?.as_str() {
            "yes" => Ok(true),
            "no" => Ok(false),
            other => Err(D::Error::custom(format!("`{other}` is neither yes nor no"))),
        }
    }
}
