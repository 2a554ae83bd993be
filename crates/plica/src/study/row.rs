//! A state as a row of `history.csv`.

use super::table::{Quantity, Visitor};
use super::{ContactRow, ObstacleRow, PatchRow, Scale, State};
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
    /// Time; the column exists only if the stages have durations.
    pub time: Option<f64>,
    /// Grown length over length, Lmax/L.
    pub length_ratio: f64,
    /// Narrowest grown diameter over diameter, Dmin/D.
    pub diameter_ratio: f64,
    /// The muscles, in the order of the tube.
    pub muscles: Vec<MuscleRow>,
    /// The ends at z = 0 and z = L.
    pub ends: [EndRow; 2],
    /// Follower pressure on the inner wall; this and the next six columns exist only in runs with pressures.
    pub inner_pressure: Option<f64>,
    /// Follower pressure on the outer wall.
    pub outer_pressure: Option<f64>,
    /// Dead load on the inner wall, per area at rest.
    pub inner_dead_load: Option<f64>,
    /// Dead load on the outer wall, per area at rest.
    pub outer_dead_load: Option<f64>,
    /// Strain energy plus the potential of the pressures, which is zero at rest, and the energy of the foundations.
    pub potential: Option<f64>,
    /// Work done so far by the pressures on the inner wall; also exists only in runs with pressures.
    pub inner_wall_work: Option<f64>,
    /// Work done so far by the pressures on the outer wall; likewise.
    pub outer_wall_work: Option<f64>,
    /// Pressure on the inner wall; only in runs that drive the volume of the lumen in any stage.
    pub lumen_pressure: Option<f64>,
    /// Contact of the wall with itself; its columns exist only in runs with contact.
    pub contact: ContactRow,
    /// The obstacles, in the order of the tube.
    pub obstacles: Vec<ObstacleRow>,
    /// The patches, in the order of the tube.
    pub patches: Vec<PatchRow>,
    /// Energy of the foundations; exists only in runs with foundations.
    pub foundation_energy: Option<f64>,
    /// Strain energy W = ∫ w det Fp dV₀, over the grown volume.
    pub energy: f64,
    /// Strain energy ∫ w dV₀, over the ungrown volume, as some other programs report it.
    pub energy_ungrown_volume: f64,
    /// Relative residual without damping.
    pub residual: f64,
    /// Work done against damping since the previous state.
    pub damping_work: f64,
    /// Work done so far by muscles, patches, pressures, ends and on obstacles, less the work of damping and friction so far and the gain of the energies of strain, contact and foundations.
    pub released_energy: f64,
    /// Method by which the state was found: rest, newton, relaxation or pseudo-time.
    pub method: Method,
    /// Equilibrium: yes or no.
    pub in_equilibrium: bool,
    /// Linear solves since the previous state, including those of rejected attempts.
    pub iterations: usize,
    /// Conjugate-gradient iterations; 0 for the direct solver.
    pub cg_iterations: usize,
    /// Wall time since the previous state, in seconds.
    pub seconds: f64,
    /// Smallest radius of the outer wall, about the axis of the deformed tube.
    pub outer_radius_min: f64,
    /// Largest distance of the outer wall from the centre of its material ring.
    pub outer_radius_max: f64,
    /// Radius of the outer wall at the middle of the length at rest, the mean over the circumference.
    pub outer_radius_mid: f64,
    /// Axial position of the smallest radius.
    pub z_at_min: f64,
    /// Steepest angle of the outer wall to the axis; past 90 it overhangs.
    pub max_wall_angle_deg: f64,
    /// Largest distance over which the outer wall runs back along the axis.
    pub overhang: f64,
    /// The side on which the wall overhangs; in a table the name of the end on that side, or none.
    pub side: Side,
    /// Axial extent of the outer wall beyond ¾ of the depth of narrowing, over that beyond ¼; 0 for a tube that is not narrowed.
    pub flatness: f64,
    /// Smallest distance of a wall from itself; 0 if it crosses itself.
    pub gap: f64,
    /// Narrowest width of the lumen; negative where walls have passed through each other.
    pub lumen: f64,
    /// Volume of the lumen between flat ends.
    pub lumen_volume: f64,
    /// Smallest cross-section of the lumen.
    pub lumen_area_min: f64,
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
    /// Its target: Dmin/D or Lmax/L of this muscle, or its tension; the column of a tension is `tension_NAME`.
    pub target: f64,
    /// Its growth stretch where it is furthest from one; none for a muscle with active stress.
    pub stretch: Option<f64>,
    /// Shift of its zone along the tube; the column exists only if a stage moves the zone.
    pub shift: Option<f64>,
    /// Work that it has done so far.
    pub work: f64,
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
    /// Shift and tilt; only in runs in which an end leaves its axis.
    pub sideways: Option<SidewaysRow>,
    /// Axial force of the support, positive if it pulls the end outwards.
    pub axial_force: f64,
    /// Magnitude of the force of the support across the axis.
    pub shear_force: f64,
    /// Magnitude of the moment of the support about axes across the tube's.
    pub bending_moment: f64,
    /// Moment of the support about the axis, positive counterclockwise as seen from outside.
    pub torque: f64,
    /// Work that the support has done so far.
    pub work: f64,
}

/// Prescribed motion of an end beside and about the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SidewaysRow {
    /// Displacement along x and y.
    pub shift: [f64; 2],
    /// Rotation vector about x and y, in degrees.
    pub tilt_deg: [f64; 2],
}

impl SidewaysRow {
    /// Returns number k of the shift along x and y and the tilt about x and y.
    fn number(&mut self, k: usize) -> &mut f64 {
        match k {
            0 | 1 => &mut self.shift[k],
            _ => &mut self.tilt_deg[k - 2],
        }
    }
}

impl Row {
    /// Converts a state to the units of its case; totals continue those of the row of the previous state. The columns of
    /// pressures are written only if the case has pressures.
    pub fn new(state: &State, scale: &Scale, has_pressures: bool, previous: Option<&Self>) -> Self {
        let row = Self::without_totals(state, scale, has_pressures);
        row.with_totals(state, scale, previous)
    }

    fn without_totals(state: &State, scale: &Scale, has_pressures: bool) -> Self {
        let (length, energy, measures) = (scale.length, scale.energy, &state.measures);
        let [inner, outer] = state.load.pressures;
        let pressure = |p: f64| has_pressures.then_some(scale.stress * p);
        let muscles = state.muscles.iter().map(|muscle| MuscleRow {
            name: muscle.name.clone(),
            target: match muscle.stretch {
                Some(_) => muscle.target,
                None => scale.stress * muscle.target,
            },
            stretch: muscle.stretch,
            shift: muscle.shift.map(|shift| length * shift),
            work: 0.0,
        });
        let patches = state.patches.iter().map(|patch| PatchRow {
            name: patch.name.clone(),
            growth_through: patch.growth_through,
            work: 0.0,
        });
        let end = |i: usize| EndRow {
            name: state.end_names[i].clone(),
            displacement: length * state.load.ends[i].displacement,
            twist_deg: state.load.ends[i].twist.to_degrees(),
            sideways: state.has_sideways_ends.then(|| SidewaysRow {
                shift: state.load.ends[i].shift.map(|x| length * x),
                tilt_deg: state.load.ends[i].tilt.map(f64::to_degrees),
            }),
            axial_force: scale.force * state.reactions[i].axial_force(),
            shear_force: scale.force * state.reactions[i].shear_force(),
            bending_moment: scale.moment * state.reactions[i].bending_moment(),
            torque: scale.moment * state.reactions[i].torque(),
            work: 0.0,
        };
        Self {
            step: state.number,
            stage: state.stage.clone(),
            time: state.time,
            length_ratio: state.length_ratio(),
            diameter_ratio: state.diameter_ratio(),
            muscles: muscles.collect(),
            ends: [end(0), end(1)],
            inner_pressure: pressure(inner.follower),
            outer_pressure: pressure(outer.follower),
            inner_dead_load: pressure(inner.dead),
            outer_dead_load: pressure(outer.dead),
            potential: has_pressures.then_some(energy * state.potential),
            inner_wall_work: has_pressures.then_some(0.0),
            outer_wall_work: has_pressures.then_some(0.0),
            lumen_pressure: state.lumen_pressure.map(|p| scale.stress * p),
            contact: state
                .contact
                .as_ref()
                .map_or_else(ContactRow::default, |contact| {
                    ContactRow::new(contact, state.energy, scale)
                }),
            obstacles: state
                .obstacles
                .iter()
                .map(|obstacle| ObstacleRow::new(obstacle, scale))
                .collect(),
            patches: patches.collect(),
            foundation_energy: state.foundation_energy.map(|x| energy * x),
            energy: energy * state.energy,
            energy_ungrown_volume: energy * state.energy_ungrown_volume,
            residual: state.relative_residual,
            damping_work: energy * state.sectors * state.sector_damping_work,
            released_energy: 0.0,
            method: state.method,
            in_equilibrium: state.in_equilibrium,
            iterations: state.linear_solves,
            cg_iterations: state.inner_iterations,
            seconds: state.seconds,
            outer_radius_min: length * measures.outer_radius_min,
            outer_radius_max: length * state.dimensions.outer_radius_max,
            outer_radius_mid: length * state.dimensions.outer_radius_mid,
            z_at_min: length * measures.z_at_min,
            max_wall_angle_deg: measures.max_wall_angle_deg,
            overhang: length * measures.overhang,
            side: measures.side,
            flatness: measures.flatness,
            gap: length * measures.gap,
            lumen: length * measures.lumen,
            lumen_volume: scale.volume() * state.dimensions.lumen_volume,
            lumen_area_min: length * length * state.dimensions.lumen_area_min,
            shape: measures.shape,
            asymmetry: length * measures.asymmetry.amplitude,
            asymmetry_mode: measures.asymmetry.harmonic,
            asymmetry_angle_deg: measures.asymmetry.crest.to_degrees(),
            min_det_fe: state.min_det_fe,
            stability: state.stability.clone(),
        }
    }

    /// Adds the work since the previous state to its totals.
    fn with_totals(mut self, state: &State, scale: &Scale, previous: Option<&Self>) -> Self {
        let (Some(previous), work) = (previous, &state.work) else {
            return self;
        };
        let mut sum = 0.0;
        let mut total = |before: f64, work: f64| {
            sum += scale.energy * work;
            before + scale.energy * work
        };
        for (i, muscle) in self.muscles.iter_mut().enumerate() {
            muscle.work = total(previous.muscles[i].work, work.muscles[i]);
        }
        for (i, end) in self.ends.iter_mut().enumerate() {
            end.work = total(previous.ends[i].work, work.ends[i]);
        }
        for (i, obstacle) in self.obstacles.iter_mut().enumerate() {
            obstacle.work = total(previous.obstacles[i].work, work.obstacles[i]);
        }
        for (i, patch) in self.patches.iter_mut().enumerate() {
            patch.work = total(previous.patches[i].work, work.patches[i]);
        }
        for (now, before, work) in [
            (
                &mut self.inner_wall_work,
                previous.inner_wall_work,
                work.walls[0],
            ),
            (
                &mut self.outer_wall_work,
                previous.outer_wall_work,
                work.walls[1],
            ),
        ] {
            if let Some(now) = now {
                *now = total(before.unwrap_or(0.0), work);
            }
        }
        let stored = |row: &Self| {
            let obstacles = row.obstacles.iter();
            let contact = obstacles.fold(0.0, |sum, obstacle| sum + obstacle.energy);
            let foundation = row.foundation_energy.unwrap_or(0.0);
            row.energy + row.contact.energy.unwrap_or(0.0) + contact + foundation
        };
        let gained = stored(&self) - stored(previous);
        let by_friction = |row: &Self| {
            let on = row.obstacles.iter().filter_map(|on| on.friction_work);
            let own = row.contact.walls.iter().filter_map(|own| own.friction_work);
            on.chain(own).sum::<f64>()
        };
        let friction = by_friction(&self) - by_friction(previous);
        self.released_energy =
            previous.released_energy + (sum - self.damping_work - gained - friction);
        self
    }

    /// Adds the columns of pressures, with zeros, to a row without them.
    #[must_use]
    pub fn with_pressures(mut self) -> Self {
        for pressure in [
            &mut self.inner_pressure,
            &mut self.outer_pressure,
            &mut self.inner_dead_load,
            &mut self.outer_dead_load,
            &mut self.inner_wall_work,
            &mut self.outer_wall_work,
        ] {
            pressure.get_or_insert(0.0);
        }
        self.potential.get_or_insert(self.energy);
        self
    }

    /// Adds the column of the pressure in a driven lumen to a row without it.
    #[must_use]
    pub fn with_lumen_pressure(mut self) -> Self {
        let inner = self.inner_pressure.unwrap_or(0.0);
        self.lumen_pressure.get_or_insert(inner);
        self
    }

    /// Adds the columns of ends that leave their axis to a row without them.
    #[must_use]
    pub fn with_sideways_ends(mut self) -> Self {
        for end in &mut self.ends {
            end.sideways.get_or_insert_default();
        }
        self
    }

    /// Adds the columns of contact, with zeros, to a row without them.
    #[must_use]
    pub fn with_contact(mut self) -> Self {
        self.contact.fill_with_zeros();
        self
    }

    /// Adds the angles of contact, with zeros, to the columns of walls that may touch themselves and of obstacles.
    #[must_use]
    pub fn with_contact_angles(mut self) -> Self {
        let has_contact = self.has_contact();
        let walls = self.contact.walls.iter_mut().filter(|_| has_contact);
        let obstacles = self.obstacles.iter_mut();
        for angles in (walls.map(|wall| &mut wall.angles_deg))
            .chain(obstacles.map(|obstacle| &mut obstacle.angles_deg))
        {
            *angles = angles.map(|angle| Some(angle.unwrap_or_default()));
        }
        self
    }

    /// Returns whether the outer wall runs back along the axis: it has an angle of 90° or more and an overhang.
    pub fn overhangs(&self) -> bool {
        self.max_wall_angle_deg >= 90.0 && self.overhang > 0.0
    }

    /// Returns whether the run has contact.
    pub fn has_contact(&self) -> bool {
        self.contact.energy.is_some()
    }

    /// Returns whether a wall crosses itself. Nothing prevents it without contact.
    pub fn crosses_itself(&self) -> bool {
        self.gap == 0.0
    }

    /// Returns whether opposite walls touch or have passed through each other.
    pub fn has_closed(&self) -> bool {
        self.lumen <= 0.0
    }

    /// Returns a row of zeros, of a run without pressures and of muscles without active stress.
    pub fn zero(muscles: &[&str], ends: [&str; 2]) -> Self {
        let muscle = |name: &&str| MuscleRow {
            name: (*name).into(),
            stretch: Some(0.0),
            ..MuscleRow::default()
        };
        Self {
            step: 0,
            stage: String::new(),
            time: None,
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
            inner_wall_work: None,
            outer_wall_work: None,
            lumen_pressure: None,
            contact: ContactRow::default(),
            obstacles: vec![],
            patches: vec![],
            foundation_energy: None,
            energy: 0.0,
            energy_ungrown_volume: 0.0,
            residual: 0.0,
            damping_work: 0.0,
            released_energy: 0.0,
            method: Method::Rest,
            in_equilibrium: true,
            iterations: 0,
            cg_iterations: 0,
            seconds: 0.0,
            outer_radius_min: 0.0,
            outer_radius_max: 0.0,
            outer_radius_mid: 0.0,
            z_at_min: 0.0,
            max_wall_angle_deg: 0.0,
            overhang: 0.0,
            side: Side::None,
            flatness: 0.0,
            gap: 0.0,
            lumen: 0.0,
            lumen_volume: 0.0,
            lumen_area_min: 0.0,
            shape: Shape::Straight,
            asymmetry: 0.0,
            asymmetry_mode: 0,
            asymmetry_angle_deg: 0.0,
            min_det_fe: 0.0,
            stability: Stability::Stable,
        }
    }

    /// Makes muscles those with active stress, by their names.
    #[must_use]
    pub fn with_active_stresses(mut self, names: &[&str]) -> Self {
        for muscle in &mut self.muscles {
            if names.contains(&muscle.name.as_str()) {
                muscle.stretch = None;
            }
        }
        self
    }

    /// Adds the columns of obstacles, with zeros, to a row without them.
    #[must_use]
    pub fn with_obstacles(mut self, names: &[&str]) -> Self {
        let row = |name: &&str| ObstacleRow {
            name: (*name).into(),
            ..ObstacleRow::default()
        };
        self.obstacles = names.iter().map(row).collect();
        self
    }

    /// Adds the columns of patches, with zeros, to a row without them.
    #[must_use]
    pub fn with_patches(mut self, names: &[&str]) -> Self {
        let row = |name: &&str| PatchRow {
            name: (*name).into(),
            ..PatchRow::default()
        };
        self.patches = names.iter().map(row).collect();
        self
    }

    /// Adds the column of foundations, with zero, to a row without it.
    #[must_use]
    pub fn with_foundations(mut self) -> Self {
        self.foundation_energy.get_or_insert(0.0);
        self
    }

    /// Returns the name of the end on a side, or none.
    pub fn name_of(&self, side: Side) -> &str {
        match side {
            Side::Colon => &self.ends[0].name,
            Side::Ileum => &self.ends[1].name,
            Side::None => "none",
        }
    }

    /// Visits the columns in the order of `history.csv`. A column of a muscle or an end is named by its quantity, an
    /// underscore and the name in the case.
    pub(super) fn visit(&mut self, visitor: &mut impl Visitor) {
        use Quantity::{
            Area, Count, Degrees, Energy, Force, Length, Moment, Ratio, Seconds, Stress, Text,
            Time, Volume,
        };
        let v = visitor;
        v.cell("step", Count, &mut self.step);
        v.cell("stage", Text, &mut self.stage);
        v.optional("time", Time, &mut self.time);
        v.cell("length_ratio", Ratio, &mut self.length_ratio);
        v.cell("diameter_ratio", Ratio, &mut self.diameter_ratio);
        for muscle in &mut self.muscles {
            let name = &muscle.name;
            match muscle.stretch {
                Some(_) => v.cell(&format!("target_{name}"), Ratio, &mut muscle.target),
                None => v.cell(&format!("tension_{name}"), Stress, &mut muscle.target),
            }
            v.optional(&format!("stretch_{name}"), Ratio, &mut muscle.stretch);
            v.optional(&format!("shift_{name}"), Length, &mut muscle.shift);
        }
        for (quantity, of, field) in [
            ("displacement", Length, displacement as OfEnd),
            ("twist_deg", Degrees, |end| &mut end.twist_deg),
            ("axial_force", Force, |end| &mut end.axial_force),
            ("shear_force", Force, |end| &mut end.shear_force),
            ("bending_moment", Moment, |end| &mut end.bending_moment),
            ("torque", Moment, |end| &mut end.torque),
        ] {
            for end in &mut self.ends {
                let name = format!("{quantity}_{}", end.name);
                v.cell(&name, of, field(end));
            }
        }
        for (k, (quantity, of)) in [
            ("offset_x", Length),
            ("offset_y", Length),
            ("tilt_x_deg", Degrees),
            ("tilt_y_deg", Degrees),
        ]
        .into_iter()
        .enumerate()
        {
            for end in &mut self.ends {
                let mut value = end.sideways.as_mut().map(|row| *row.number(k));
                v.optional(&format!("{quantity}_{}", end.name), of, &mut value);
                if let Some(value) = value {
                    *end.sideways.get_or_insert_default().number(k) = value;
                }
            }
        }
        v.optional("inner_pressure", Stress, &mut self.inner_pressure);
        v.optional("outer_pressure", Stress, &mut self.outer_pressure);
        v.optional("inner_dead_load", Stress, &mut self.inner_dead_load);
        v.optional("outer_dead_load", Stress, &mut self.outer_dead_load);
        v.optional("potential", Energy, &mut self.potential);
        self.contact.visit(v);
        for obstacle in &mut self.obstacles {
            obstacle.visit(v);
        }
        for patch in &mut self.patches {
            patch.visit(v);
        }
        let foundation = &mut self.foundation_energy;
        v.optional("foundation_energy", Energy, foundation);
        v.cell("energy", Energy, &mut self.energy);
        let ungrown = &mut self.energy_ungrown_volume;
        v.cell("energy_ungrown_volume", Energy, ungrown);
        v.cell("residual", Ratio, &mut self.residual);
        v.cell("damping_work", Energy, &mut self.damping_work);
        for muscle in &mut self.muscles {
            let name = format!("work_{}", muscle.name);
            v.cell(&name, Energy, &mut muscle.work);
        }
        for obstacle in &mut self.obstacles {
            let name = format!("work_{}", obstacle.name);
            v.cell(&name, Energy, &mut obstacle.work);
        }
        for patch in &mut self.patches {
            let name = format!("work_{}", patch.name);
            v.cell(&name, Energy, &mut patch.work);
        }
        v.optional("work_inner-wall", Energy, &mut self.inner_wall_work);
        v.optional("work_outer-wall", Energy, &mut self.outer_wall_work);
        for end in &mut self.ends {
            let name = format!("work_{}", end.name);
            v.cell(&name, Energy, &mut end.work);
        }
        v.cell("released_energy", Energy, &mut self.released_energy);
        v.cell("method", Text, &mut self.method);
        let mut answer = YesOrNo::from(self.in_equilibrium);
        v.cell("equilibrium", Text, &mut answer);
        self.in_equilibrium = answer == YesOrNo::Yes;
        v.cell("iterations", Count, &mut self.iterations);
        v.cell("cg_iterations", Count, &mut self.cg_iterations);
        v.cell("seconds", Seconds, &mut self.seconds);
        v.cell("outer_radius_min", Length, &mut self.outer_radius_min);
        v.cell("outer_radius_max", Length, &mut self.outer_radius_max);
        v.cell("outer_radius_mid", Length, &mut self.outer_radius_mid);
        v.cell("z_at_min", Length, &mut self.z_at_min);
        v.cell("max_wall_angle_deg", Degrees, &mut self.max_wall_angle_deg);
        v.cell("overhang", Length, &mut self.overhang);
        let sides = [Side::Colon, Side::Ileum, Side::None];
        let names = sides.map(|side| self.name_of(side).to_owned());
        let mut index = sides.iter().position(|side| *side == self.side);
        v.word("side", &names, &mut index);
        self.side = index.map_or(Side::None, |i| sides[i]);
        v.cell("flatness", Ratio, &mut self.flatness);
        v.cell("gap", Length, &mut self.gap);
        v.cell("lumen", Length, &mut self.lumen);
        v.cell("lumen_volume", Volume, &mut self.lumen_volume);
        v.optional("lumen_pressure", Stress, &mut self.lumen_pressure);
        v.cell("lumen_area_min", Area, &mut self.lumen_area_min);
        v.cell("shape", Text, &mut self.shape);
        v.cell("asymmetry", Length, &mut self.asymmetry);
        v.cell("asymmetry_mode", Count, &mut self.asymmetry_mode);
        let angle = &mut self.asymmetry_angle_deg;
        v.cell("asymmetry_angle_deg", Degrees, angle);
        v.cell("min_det_fe", Ratio, &mut self.min_det_fe);
        v.cell("unstable_modes", Text, &mut self.stability);
    }
}

/// A number of an end.
type OfEnd = fn(&mut EndRow) -> &mut f64;

fn displacement(end: &mut EndRow) -> &mut f64 {
    &mut end.displacement
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_judged_on_both_sides_of_every_threshold() {
        let row = |angle: f64, overhang: f64, gap: f64, lumen: f64| {
            let row = Row {
                max_wall_angle_deg: angle,
                overhang,
                gap,
                lumen,
                ..Row::zero(&[], ["colon", "ileum"])
            };
            [row.overhangs(), row.crosses_itself(), row.has_closed()]
        };
        assert_eq!(row(90.0, 1e-9, 1e-9, 1e-9), [true, false, false]);
        assert_eq!(row(89.9, 1e-9, 0.0, 1e-9), [false, true, false]);
        assert_eq!(row(120.0, 0.0, 1e-9, 0.0), [false, false, true]);
        assert_eq!(row(0.0, 0.0, 1e-9, -1e-9), [false, false, true]);
    }

    #[test]
    fn a_row_without_pressures_continues_one_with_them() {
        let plain = Row {
            energy: 3.0,
            ..Row::zero(&["ring"], ["colon", "ileum"])
        };
        let row = plain.clone().with_pressures();
        assert_eq!(
            (row.inner_pressure, row.outer_dead_load),
            (Some(0.0), Some(0.0))
        );
        assert_eq!((row.potential, row.outer_wall_work), (Some(3.0), Some(0.0)));
        assert_eq!(row.header().len(), plain.header().len() + 7);
        assert_eq!(row.clone().with_pressures(), row);
    }
}
