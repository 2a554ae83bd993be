//! A state as a row of `history.csv`.

use super::table::{Quantity, Visitor};
use super::{Scale, State};
use crate::equilibrium::Stability;
use crate::measure::{Shape, Side};
use crate::solve::Method;
use serde::{Deserialize, Serialize};

/// The numbers of an accepted state: a row of `history.csv`. Lengths in D, energies in E·D³ and pressures in E, unless
/// the case has units.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the state, from 0 (the tube at rest, or the state the study starts from).
    pub step: usize,
    /// Name of the stage.
    pub stage: String,
    /// Grown length over length, Lmax/L.
    pub length_ratio: f64,
    /// Narrowest grown diameter over diameter, Dmin/D.
    pub diameter_ratio: f64,
    /// The muscles, in the order of the tube.
    pub muscles: Vec<MuscleRow>,
    /// The ends at z = 0 and z = L.
    pub ends: [EndRow; 2],
    /// Follower pressure on the inner wall; this and the next four columns exist only in runs with pressures.
    pub inner_pressure: Option<f64>,
    /// Follower pressure on the outer wall.
    pub outer_pressure: Option<f64>,
    /// Dead load on the inner wall, per area at rest.
    pub inner_dead_load: Option<f64>,
    /// Dead load on the outer wall, per area at rest.
    pub outer_dead_load: Option<f64>,
    /// Strain energy plus the potential of the pressures, which is zero at rest.
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
    pub stability: Stability,
}

/// The numbers of a muscle in a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MuscleRow {
    /// Its name in the case.
    pub name: String,
    /// Its target: Dmin/D or Lmax/L of this muscle.
    pub target: f64,
    /// Its growth stretch where it is furthest from one.
    pub stretch: f64,
}

/// The numbers of an end in a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EndRow {
    /// Its name.
    pub name: String,
    /// Prescribed axial displacement.
    pub displacement: f64,
    /// Prescribed twist about the axis, in degrees.
    pub twist_deg: f64,
}

impl Row {
    /// Converts a state to the units of its case. The columns of pressures are written only if the case has pressures.
    pub fn new(state: &State, scale: &Scale, has_pressures: bool) -> Self {
        let (length, energy, measures) = (scale.length, scale.energy, &state.measures);
        let [inner, outer] = state.load.pressures;
        let pressure = |p: f64| has_pressures.then_some(scale.stress * p);
        let muscles = state.muscles.iter().map(|muscle| MuscleRow {
            name: muscle.name.clone(),
            target: muscle.target,
            stretch: muscle.stretch,
        });
        let end = |i: usize| EndRow {
            name: ["colon", "ileum"][i].into(),
            displacement: length * state.load.ends[i].displacement,
            twist_deg: state.load.ends[i].twist.to_degrees(),
        };
        Self {
            step: state.number,
            stage: state.stage.clone(),
            length_ratio: state.length_ratio(),
            diameter_ratio: state.diameter_ratio(),
            muscles: muscles.collect(),
            ends: [end(0), end(1)],
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

    /// Returns a row of zeros, of a run without pressures.
    pub fn zero(muscles: &[&str], ends: [&str; 2]) -> Self {
        let muscle = |name: &&str| MuscleRow {
            name: (*name).into(),
            ..MuscleRow::default()
        };
        Self {
            step: 0,
            stage: String::new(),
            length_ratio: 0.0,
            diameter_ratio: 0.0,
            muscles: muscles.iter().map(muscle).collect(),
            ends: ends.map(|name| EndRow {
                name: name.into(),
                ..EndRow::default()
            }),
            inner_pressure: None,
            outer_pressure: None,
            inner_dead_load: None,
            outer_dead_load: None,
            potential: None,
            energy: 0.0,
            energy_ungrown_volume: 0.0,
            residual: 0.0,
            damping_work: 0.0,
            method: Method::Rest,
            in_equilibrium: true,
            iterations: 0,
            cg_iterations: 0,
            seconds: 0.0,
            outer_radius_min: 0.0,
            z_at_min: 0.0,
            max_wall_angle_deg: 0.0,
            overhang: 0.0,
            side: Side::None,
            flatness: 0.0,
            gap: 0.0,
            lumen: 0.0,
            shape: Shape::Straight,
            asymmetry: 0.0,
            asymmetry_mode: 0,
            asymmetry_angle_deg: 0.0,
            min_det_fe: 0.0,
            stability: Stability::Stable,
        }
    }

    /// Visits the columns in the order of `history.csv`. A column of a muscle or an end is named by its quantity, an
    /// underscore and the name in the case.
    pub(super) fn visit(&mut self, visitor: &mut impl Visitor) {
        use Quantity::{Count, Degrees, Energy, Length, Ratio, Seconds, Stress, Text};
        let v = visitor;
        v.cell("step", Count, &mut self.step);
        v.cell("stage", Text, &mut self.stage);
        v.cell("length_ratio", Ratio, &mut self.length_ratio);
        v.cell("diameter_ratio", Ratio, &mut self.diameter_ratio);
        for MuscleRow {
            name,
            target,
            stretch,
        } in &mut self.muscles
        {
            v.cell(&format!("target_{name}"), Ratio, target);
            v.cell(&format!("stretch_{name}"), Ratio, stretch);
        }
        for end in &mut self.ends {
            let name = format!("displacement_{}", end.name);
            v.cell(&name, Length, &mut end.displacement);
        }
        for end in &mut self.ends {
            let name = format!("twist_deg_{}", end.name);
            v.cell(&name, Degrees, &mut end.twist_deg);
        }
        v.optional("inner_pressure", Stress, &mut self.inner_pressure);
        v.optional("outer_pressure", Stress, &mut self.outer_pressure);
        v.optional("inner_dead_load", Stress, &mut self.inner_dead_load);
        v.optional("outer_dead_load", Stress, &mut self.outer_dead_load);
        v.optional("potential", Energy, &mut self.potential);
        v.cell("energy", Energy, &mut self.energy);
        let ungrown = &mut self.energy_ungrown_volume;
        v.cell("energy_ungrown_volume", Energy, ungrown);
        v.cell("residual", Ratio, &mut self.residual);
        v.cell("damping_work", Energy, &mut self.damping_work);
        v.cell("method", Text, &mut self.method);
        let mut answer = YesOrNo::from(self.in_equilibrium);
        v.cell("equilibrium", Text, &mut answer);
        self.in_equilibrium = answer == YesOrNo::Yes;
        v.cell("iterations", Count, &mut self.iterations);
        v.cell("cg_iterations", Count, &mut self.cg_iterations);
        v.cell("seconds", Seconds, &mut self.seconds);
        v.cell("outer_radius_min", Length, &mut self.outer_radius_min);
        v.cell("z_at_min", Length, &mut self.z_at_min);
        v.cell("max_wall_angle_deg", Degrees, &mut self.max_wall_angle_deg);
        v.cell("overhang", Length, &mut self.overhang);
        v.cell("side", Text, &mut self.side);
        v.cell("flatness", Ratio, &mut self.flatness);
        v.cell("gap", Length, &mut self.gap);
        v.cell("lumen", Length, &mut self.lumen);
        v.cell("shape", Text, &mut self.shape);
        v.cell("asymmetry", Length, &mut self.asymmetry);
        v.cell("asymmetry_mode", Count, &mut self.asymmetry_mode);
        let angle = &mut self.asymmetry_angle_deg;
        v.cell("asymmetry_angle_deg", Degrees, angle);
        v.cell("min_det_fe", Ratio, &mut self.min_det_fe);
        v.cell("unstable_modes", Text, &mut self.stability);
    }
}

/// A truth value in a table.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum YesOrNo {
    Yes,
    No,
}

impl From<bool> for YesOrNo {
    fn from(value: bool) -> Self {
        if value { Self::Yes } else { Self::No }
    }
}
