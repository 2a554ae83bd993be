//! A spline tube as a problem for the solver.

use super::friction_step::FrictionStep;
use super::harmonic_tangent::{HarmonicSystem, HarmonicTangent, HarmonicTube};
use super::lumen::{DrivenLumen, without_lumen};
use crate::assembly::{Forces, Inverted, ObstacleContact, SplineTube};
use crate::contact::{ContactReport, MeridianContact, PressureField, SelfContact};
use crate::matrix::{BlockBanded, CoupledBanded, CoupledFactor, Singular};
use crate::monitor::Monitor;
use crate::solve::{
    Direct, EQUILIBRIUM, Equilibrium, NegativeCurvature, ResidualEvaluation, Solved, Solver,
    Tangent,
};
use crate::tube::{Load, Tube};
use std::f64::consts::PI;
use std::sync::Arc;

/// The equilibrium of a spline tube under muscles, moved ends and pressures.
#[derive(Clone, Debug)]
pub struct TubeProblem {
    /// The tube.
    pub tube: Arc<SplineTube>,
    /// Contact of the wall with itself, if the problem has it.
    pub contact: Option<Arc<SelfContact>>,
    /// Friction in the load step that a path has begun; none without friction.
    friction: Option<Arc<FrictionStep>>,
    /// Driven volume of the lumen; none if no load drives it.
    lumen: Option<DrivenLumen>,
    rings: Rings,
    prescribed: Arc<[bool]>,
    /// Reference volume of the cyclic sector.
    volume: f64,
    /// Smallest residual scale. The rounding errors of a tube at rest, about 1e-17 times the stiffness of the wall, are small
    /// relative to it.
    at_rest: f64,
}

/// The assembled damping matrix of one ring, or the shared data of the tangents of several rings.
#[derive(Clone, Debug)]
enum Rings {
    One(Arc<BlockBanded>),
    Many(Arc<HarmonicTube>),
}

/// The tangent stiffness of a tube: assembled for one ring, matrix-free for several.
#[derive(Clone, Debug)]
pub enum TubeTangent {
    /// One ring.
    Direct(Direct),
    /// Several rings.
    Harmonic(HarmonicTangent),
}

/// The solver of a [`TubeTangent`].
#[derive(Debug)]
pub enum TubeSolver {
    /// One ring.
    Direct(CoupledFactor),
    /// Several rings.
    Harmonic(Box<HarmonicSystem>),
}

impl TubeProblem {
    /// Makes the problem of a tube.
    pub fn new(tube: SplineTube) -> Self {
        let at_rest = 3e-11 * tube.tube.longitudinal_modulus();
        let (outer, inner) = (Tube::OUTER_RADIUS, tube.tube.inner_radius());
        let tube = Arc::new(tube);
        Self {
            rings: if tube.sector.rings == 1 {
                Rings::One(Arc::new(tube.damping()))
            } else {
                Rings::Many(Arc::new(HarmonicTube::new(tube.clone(), None)))
            },
            prescribed: tube.prescribed().into(),
            volume: PI * (outer * outer - inner * inner) * tube.tube.length / tube.sector.repeats(),
            at_rest,
            contact: None,
            friction: None,
            lumen: None,
            tube,
        }
    }

    /// Returns the problem with contact of the wall with itself. The circumferential displacements of a tube of one ring are
    /// prescribed to be zero: a tube that buckles by twisting leaves the meridians on which contact is found.
    pub fn with_contact(mut self) -> Self {
        let contact = Arc::new(SelfContact::new(&self.tube));
        if let Rings::Many(_) = self.rings {
            let tube = HarmonicTube::new(self.tube.clone(), Some(contact.clone()));
            self.rings = Rings::Many(Arc::new(tube));
        } else {
            let prescribed = self.prescribed.iter().enumerate();
            self.prescribed = prescribed.map(|(i, own)| *own || i % 3 == 2).collect();
        }
        self.contact = Some(contact);
        self
    }

    /// Returns the problem with friction of the wall with itself, if it has one ring and contact.
    #[must_use]
    pub fn with_friction(mut self, coefficient: f64) -> Self {
        if let Some(contact) = self.meridian_contact() {
            let contact = contact.clone().with_friction(coefficient);
            self.contact = Some(Arc::new(SelfContact::Meridian(contact)));
        }
        self
    }

    /// Returns the problem for loads that drive the volume of the lumen.
    #[must_use]
    pub fn with_driven_lumen(mut self) -> Self {
        self.lumen = Some(DrivenLumen::new(&self.tube));
        self
    }

    /// Returns the volume of the lumen of the stress-free shape, of a problem whose loads drive the volume.
    pub fn driven_lumen_at_rest(&self) -> Option<f64> {
        self.lumen.as_ref().map(DrivenLumen::at_rest)
    }

    /// Returns the smallest residual scale under a load: the rounding errors of a tube grow as its ends leave their axis.
    fn smallest_scale(&self, load: &Load) -> f64 {
        let numbers = load
            .ends
            .iter()
            .flat_map(|end| end.shift.iter().chain(&end.tilt));
        let away = numbers.fold(0.0_f64, |most, x| most.max(x.abs()));
        self.at_rest * (1.0 + 100.0 * away)
    }

    fn meridian_contact(&self) -> Option<&MeridianContact> {
        match self.contact.as_deref() {
            Some(SelfContact::Meridian(contact)) => Some(contact),
            _ => None,
        }
    }

    /// Returns whether the tube has friction.
    pub fn has_friction(&self) -> bool {
        let contact = self.meridian_contact();
        self.tube.has_friction() || contact.is_some_and(|contact| contact.has_friction())
    }

    /// Returns the same problem without friction, whose tangent has an energy at any state.
    #[must_use]
    pub fn without_friction(&self) -> Self {
        Self {
            friction: None,
            ..self.clone()
        }
    }

    /// Evaluates energy and residual at a state, with pressures, obstacles, and friction in the step that a path has begun;
    /// without contact of the wall with itself.
    ///
    /// # Errors
    ///
    /// If an element is inverted.
    pub fn forces_on_tube(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let mut forces = self.tube.forces(load, u)?;
        if let Some(step) = &self.friction {
            step.add_on_obstacles(&self.tube, load, u, &mut forces);
        }
        Ok(forces)
    }

    /// Returns the contact of a state with each obstacle, with friction in the step that a path has begun.
    pub fn obstacle_contacts(&self, load: &Load, u: &[f64]) -> Vec<ObstacleContact> {
        let mut contacts = self.tube.obstacle_contacts(load, u);
        let Some(step) = &self.friction else {
            return contacts;
        };
        let all = step.on_obstacles(&self.tube, load, u);
        for (number, (contact, friction)) in contacts.iter_mut().zip(all).enumerate() {
            if self.tube.tube.obstacles[number].friction > 0.0 {
                for (sum, part) in contact.reaction.iter_mut().zip(friction.reaction) {
                    *sum += part;
                }
                contact.friction = Some(friction);
            }
        }
        contacts
    }

    /// Sums up the contact of a state; none of a problem without contact.
    pub fn contact_report(&self, load: &Load, u: &[f64]) -> Option<ContactReport> {
        let contact = self.contact.as_ref()?;
        let mut report = contact.report(&self.tube, load, u);
        let meridian = self.meridian_contact();
        if let (Some(step), Some(contact)) = (&self.friction, meridian)
            && contact.has_friction()
        {
            report.friction = Some(step.on_faces(Some(contact), u));
        }
        Some(report)
    }

    /// Returns the pressure of contact in a state; none of a problem without contact.
    pub fn contact_pressure(&self, u: &[f64]) -> Option<PressureField<'_>> {
        let contact = self.contact.as_ref()?;
        Some(contact.pressure(&self.tube, u))
    }

    /// Assembles the tangent of one ring, with contact, for a circumferential mode at a state without twist. Friction, which
    /// has no energy of its own, is left out. Where the load drives the volume of the lumen, mode 0 is that at a held volume.
    pub fn ring_tangent(&self, load: &Load, u: &[f64], mode: usize) -> CoupledBanded {
        let mut tangent = self.with_self_contact(
            u,
            mode,
            match mode {
                0 => self.tube.tangent(load, u),
                n => self.tube.tangent_in_harmonic(load, u, n),
            },
        );
        // Other modes do not change the volume.
        let lumen = self.lumen.as_ref().filter(|_| mode == 0);
        tangent.term = lumen.and_then(|lumen| lumen.holding_term(&self.tube, load, u));
        tangent
    }

    /// Assembles the tangent of one ring with contact and friction.
    fn tangent_of_step(&self, load: &Load, u: &[f64]) -> CoupledBanded {
        let mut tangent = self.tube.tangent(load, u);
        let step = self.friction.as_deref();
        if let Some(friction) = step.and_then(FrictionStep::friction) {
            self.tube
                .add_friction_tangent(friction, load, u, &mut tangent);
        }
        let mut tangent = self.with_self_contact(u, 0, tangent);
        let own = step.and_then(FrictionStep::own);
        if let (Some(contact), Some(own)) = (self.meridian_contact(), own) {
            contact.add_friction_tangent(own, u, |row, column, value| {
                tangent.add_at(row, column, value);
            });
        }
        tangent
    }

    fn with_self_contact(&self, u: &[f64], mode: usize, tangent: BlockBanded) -> CoupledBanded {
        let mut tangent = CoupledBanded::from(tangent);
        if let Some(contact) = self.meridian_contact() {
            contact.add_tangent(&contact.at(u), mode, |row, column, value| {
                tangent.add_at(row, column, value);
            });
        }
        tangent
    }
}

impl Equilibrium for TubeProblem {
    type Load = Load;
    type EvaluationError = Inverted;
    type Tangent = TubeTangent;

    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        self.tube.apply_prescribed(load, u);
        if self.meridian_contact().is_some() {
            u.iter_mut().skip(2).step_by(3).for_each(|u| *u = 0.0);
        }
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        from.towards(to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<ResidualEvaluation, Inverted> {
        let lumen = self.lumen.as_ref();
        let held = lumen.and_then(|lumen| lumen.held(&self.tube, load, u));
        let (load, of_lumen) = held
            .as_ref()
            .map_or((load, 0.0), |(load, energy)| (load, *energy));
        let mut forces = self.forces_on_tube(load, u)?;
        forces.potential += forces.contact + forces.friction;
        if of_lumen != 0.0 {
            forces.potential += of_lumen;
        }
        if let Some(contact) = &self.contact {
            let of_contact = contact.add_forces(u, &mut forces.residual);
            forces.potential += self.tube.sector.repeats() * of_contact.energy;
            forces.residual_scale = forces.residual_scale.hypot(of_contact.squares.sqrt());
            let own = self.friction.as_ref().and_then(|step| step.own());
            if let (Some(contact), Some(own)) = (self.meridian_contact(), own) {
                let of_friction = contact.add_friction(own, u, &mut forces.residual);
                forces.potential += self.tube.sector.repeats() * of_friction.energy;
                forces.residual_scale = forces.residual_scale.hypot(of_friction.squares.sqrt());
            }
        }
        self.tube.project_out_constraints(&mut forces.residual);
        // The energy of one cyclic sector, whose derivative is the residual.
        let [strain, energy] =
            [forces.energy, forces.potential].map(|x| x / self.tube.sector.repeats());
        Ok(ResidualEvaluation {
            energy,
            residual: forces.residual,
            residual_scale: forces.residual_scale.max(self.smallest_scale(load)),
            // Every quadrature point adds a rounding error of its energy density.
            rounding: 4.0 * f64::EPSILON * self.volume + 1e-13 * strain.abs().max(energy.abs()),
        })
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> TubeTangent {
        let lumen = self.lumen.as_ref();
        let term = lumen.and_then(|lumen| lumen.term(&self.tube, load, u));
        let held = lumen.and_then(|lumen| lumen.held(&self.tube, load, u));
        let load = held.as_ref().map_or(load, |(load, _)| load);
        match &self.rings {
            Rings::One(damping) => {
                let mut tangent = self.tangent_of_step(load, u);
                tangent.term = term;
                TubeTangent::Direct(Direct::new(
                    tangent,
                    damping.clone(),
                    self.prescribed.clone(),
                ))
            }
            Rings::Many(tube) => {
                let friction = self.friction.as_ref().and_then(|step| step.friction());
                TubeTangent::Harmonic(tube.tangent(load, u, friction, term))
            }
        }
    }
    fn begin_step(&mut self, load: &Load, u: &[f64], history: &[f64]) {
        if let Some(lumen) = &mut self.lumen {
            lumen.begin_step(&self.tube, (load, u), history);
        }
        let contact = self.meridian_contact();
        let history = without_lumen(history);
        let step = FrictionStep::begin(&self.tube, contact, (load, u), history);
        self.friction = step.map(Arc::new);
    }
    fn begin_segment(&mut self, from: Load, to: &Load, u: &[f64], history: &mut Vec<f64>) -> Load {
        match &mut self.lumen {
            Some(lumen) => lumen.begin_segment(&self.tube, (from, to), u, history),
            None => from,
        }
    }
    fn completed(&self, load: Load, u: &[f64]) -> Load {
        match &self.lumen {
            Some(lumen) => lumen.completed(&self.tube, load, u),
            None => load,
        }
    }
    fn repetition_tolerance(&self, load: &Load, tolerance: f64) -> f64 {
        match load.lumen_volume {
            Some(_) if self.friction.is_none() => tolerance,
            _ => tolerance.max(EQUILIBRIUM),
        }
    }
    fn update(&mut self, load: &Load, u: &[f64]) -> bool {
        let lumen = self.lumen.as_mut();
        let renewed = lumen.is_some_and(|lumen| lumen.renew(&self.tube, load, u));
        let Some(mut step) = self.friction.take() else {
            return renewed;
        };
        let contact = self.meridian_contact();
        Arc::make_mut(&mut step).update(&self.tube, contact, (load, u));
        self.friction = Some(step);
        true
    }
    fn history(&self, load: &Load, u: &[f64]) -> Vec<f64> {
        let lumen = self.lumen.as_ref();
        let mut history = lumen.map_or(vec![], |lumen| lumen.history(&self.tube, load, u));
        if let Some(step) = &self.friction {
            let contact = self.meridian_contact();
            history.extend(step.history(&self.tube, contact, (load, u)));
        }
        history
    }
    fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        let contact = self.contact.as_ref();
        contact.map_or(1.0, |contact| contact.longest_step(u, step))
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        match &self.rings {
            Rings::One(damping) => damping.multiply_add(factor, v, y),
            Rings::Many(tube) => {
                let mut force = vec![0.0; v.len()];
                tube.damping(factor, v, &mut force);
                self.tube.project_out_constraints(&mut force);
                y.iter_mut().zip(&force).for_each(|(y, f)| *y += f);
            }
        }
    }
}

impl Tangent for TubeTangent {
    type Solver = TubeSolver;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        match self {
            Self::Direct(tangent) => tangent.multiply_add(factor, v, y),
            Self::Harmonic(tangent) => tangent.multiply_add(factor, v, y),
        }
    }
    fn shifted(&self, alpha: f64) -> Result<TubeSolver, Singular> {
        match self {
            Self::Direct(tangent) => tangent.shifted(alpha).map(TubeSolver::Direct),
            Self::Harmonic(tangent) => tangent.shifted(alpha).map(TubeSolver::harmonic),
        }
    }
    fn into_shifted(self, alpha: f64) -> Result<TubeSolver, Singular> {
        match self {
            Self::Direct(tangent) => tangent.into_shifted(alpha).map(TubeSolver::Direct),
            Self::Harmonic(tangent) => tangent.into_shifted(alpha).map(TubeSolver::harmonic),
        }
    }
}

impl TubeSolver {
    fn harmonic(system: HarmonicSystem) -> Self {
        Self::Harmonic(Box::new(system))
    }
}

impl Solver for TubeSolver {
    fn negative_pivots(&self) -> usize {
        match self {
            Self::Direct(factor) => Solver::negative_pivots(factor),
            Self::Harmonic(system) => system.negative_pivots(),
        }
    }
    fn is_unstable(&self) -> bool {
        match self {
            Self::Direct(factor) => factor.is_unstable(),
            Self::Harmonic(system) => system.is_unstable(),
        }
    }
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        match self {
            Self::Direct(factor) => Solver::solve(factor, b, accuracy, monitor),
            Self::Harmonic(system) => system.solve(b, accuracy, monitor),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, NeoHookean};
    use crate::solve::{Method, Path, Settings};
    use crate::tube::{Axial, Imperfection, Mesh, Part, Shape, Support, WallLayer, Wave};

    #[test]
    fn an_oval_ring_of_one_element_along_passes_its_pressures_in_few_solves() {
        let tube = Tube {
            length: 0.5,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.3,
            )))],
            muscles: vec![],
            ends: [Support::Sliding; 2],
            obstacles: vec![],
            imperfections: vec![Imperfection {
                of: Part::Geometry,
                amplitude: 3e-3,
                shape: Shape::Wave(Wave::new(2, 0.0, Axial::Uniform)),
            }],
            patches: vec![],
            foundations: vec![],
        };
        let mesh = Mesh {
            axial: 4,
            around: 24,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        let problem = TubeProblem::new(SplineTube::new(&tube, &mesh, 12));
        let (rest, start) = (tube.rest(), problem.tube.initial_guess());
        let mut path = Path::begin(&problem, rest.clone(), start, Settings::default()).unwrap();
        let mut load = rest;
        load.pressures[1].follower = 4e-4;
        path.begin_segment(load);
        // Radial displacements of the first control point, a quarter turn apart.
        let wave = |u: &[f64]| 0.5 * (u[12] - u[18]);
        let before = wave(&path.state().u);
        let mut critical = vec![];
        // From an asymmetry of 0.005 D on, low harmonics are coupled.
        for t in [0.5, 1.0] {
            let step = path.advance(t, &mut ()).unwrap();
            assert_eq!(step.method, Method::Newton);
            assert!(step.effort.linear_solves <= 7, "{step:?}");
            assert!(step.effort.inner_iterations <= 30, "{step:?}");
            assert_eq!(path.state().negative_pivots, 0);
            // The wave grows by 1/(1 − p/p_c).
            let growth = wave(&path.state().u) / before;
            critical.push(t * 4e-4 / (1.0 - 1.0 / growth));
        }
        assert!(wave(&path.state().u) > 0.006, "{}", wave(&path.state().u));
        // Of a thin ring in plane strain; this one is thick.
        let radius = 0.5 - 0.03;
        let thin = 0.25 * (0.06_f64 / radius).powi(3) / (1.0 - 0.3 * 0.3);
        for critical in &critical {
            assert!((critical / thin - 1.0).abs() < 0.1, "{critical} {thin}");
        }
        assert!(
            (critical[1] / critical[0] - 1.0).abs() < 0.03,
            "{critical:?}"
        );
    }
}
