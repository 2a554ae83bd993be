//! One row per accepted state: the content of `history.csv`.

use serde::{Deserialize, Serialize};

/// An accepted state in numbers. Lengths in D, energies in E·D³ and pressures in E, unless the case
/// gives units; forces relative to the forces in play.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the state, from 0 (the tube at rest, or where it started).
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
    /// True pressure on the inner wall; none if the run has no pressures, as below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_pressure: Option<f64>,
    /// True pressure on the outer wall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_pressure: Option<f64>,
    /// Dead pressure on the inner wall, per area at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_dead_load: Option<f64>,
    /// Dead pressure on the outer wall, per area at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_dead_load: Option<f64>,
    /// Strain energy and the potential of the pressures, which is nothing at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub potential: Option<f64>,
    /// Strain energy W = ∫ w det Fp dV₀, over the grown volume.
    pub energy: f64,
    /// Strain energy ∫ w dV₀, over the ungrown volume, as some other programs report it.
    pub energy_ungrown_volume: f64,
    /// Residual without drag over the forces in play.
    pub residual: f64,
    /// Energy spent on drag on the way to this state.
    pub damping_work: f64,
    /// How the state was found: rest, newton, relaxation or pseudo-time.
    pub method: String,
    /// Whether the state is in equilibrium: yes, or no.
    pub equilibrium: String,
    /// Linear solves, counting those of rejected tries.
    pub iterations: usize,
    /// Conjugate-gradient iterations; 0 where the solver is direct.
    pub cg_iterations: usize,
    /// Wall time since the state before.
    pub seconds: f64,
    /// Smallest radius of the outer wall, about the tube's own axis.
    pub outer_radius_min: f64,
    /// Where along the tube that is.
    pub z_at_min: f64,
    /// Steepest angle of the outer wall to the axis; past 90 it overhangs.
    pub max_wall_angle_deg: f64,
    /// How far the outer wall runs back along the axis, at most.
    pub overhang: f64,
    /// The side it invaginates to: colon, ileum or none.
    pub side: String,
    /// Axial extent of the outer wall deeper than ¾ of the depth, over that deeper than ¼; 0 of a tube that is not narrowed.
    pub flatness: f64,
    /// How near a wall comes to itself; 0 if it crosses itself.
    pub gap: f64,
    /// Narrowest width of the lumen; negative where walls have passed through each other.
    pub lumen: f64,
    /// V, U, square, invaginated, swollen or collapsed; straight where nothing is contracted.
    pub shape: String,
    /// How far the outer wall is from axisymmetric: amplitude of its largest wave around.
    pub asymmetry: f64,
    /// Circumferential harmonic of that wave; 0 if there is none.
    pub asymmetry_mode: usize,
    /// Angle of a crest of that wave, where the wall at rest was, from −180/n to 180/n.
    pub asymmetry_angle_deg: f64,
    /// Smallest det Fe.
    pub min_det_fe: f64,
    /// Circumferential harmonics with negative eigenvalues of the tangent, as `harmonic:count`
    /// separated by spaces, or none. An axisymmetric state is looked at for harmonics 0 to
    /// `output.stability_modes` (only 0 if it twists). Any other only at the lowest eigenvalue of the
    /// run's own tangent: `any:1` if it is negative, unknown if its sign does not show.
    pub unstable_modes: String,
}

impl Row {
    /// The same with numbers for pressures, if the case has come to have some.
    #[must_use]
    pub fn pressed(mut self) -> Self {
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

    /// The harmonics it is unstable to, as the column names them: numbers, `any`, or `unknown`; none if it is stable.
    pub fn lost_harmonics(&self) -> impl Iterator<Item = &str> {
        let all = self.unstable_modes.split(' ');
        let lost = all.filter(|harmonic| *harmonic != "none");
        lost.map(|harmonic| harmonic.split(':').next().unwrap_or(harmonic))
    }

    /// Whether the wall crosses itself somewhere, which nothing prevents.
    pub fn crosses_itself(&self) -> bool {
        self.gap == 0.0
    }

    /// Whether opposite walls touch, or have passed through each other.
    pub fn has_closed(&self) -> bool {
        self.lumen <= 0.0
    }
}
