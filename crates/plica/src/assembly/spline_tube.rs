//! A tube laid out in splines: numbering, slabs over threads, sums in their order.

use super::damping::damping;
use super::forces::{SlabForces, Worst, slab_forces};
use super::imperfection::geometry;
use super::pencil::RingLanes;
use super::place::Place;
use super::ring_damping::RingDamping;
use super::slab::SlabInput;
use super::stress_free::StressFree;
use super::supports::{Supports, left_by, motions_in_harmonic};
use super::tables::{Around, Layer, Slab, full_rules, reduced_rules};
use super::tangent::{SlabTangent, slab_tangent};
use crate::material::Material;
use crate::matrix::BlockBanded;
use crate::rings::{Sector, Turn};
use crate::spline::{Basis, Circle, gauss_legendre, graded_breakpoints};
use crate::tensor::Lanes;
use crate::tube::{Integration, Load, Mesh, Tube};
use rayon::prelude::*;
use std::sync::Arc;

/// A tube and the splines that carry its displacements.
///
/// The unknowns are numbered row by row along the tube; in a row point by point through the wall,
/// then component (axial, radial, circumferential), then ring of the sector.
#[derive(Clone, Debug)]
pub struct SplineTube {
    /// The tube.
    pub tube: Tube,
    /// Rings that are solved for, and how they repeat.
    pub sector: Sector,
    /// The spline circle.
    pub circle: Circle,
    /// Basis along the tube, over z.
    pub axial: Basis,
    /// Basis through the wall, over the reference radius R.
    pub wall: Basis,
    pub(super) supports: Supports,
    /// Of one ring alone.
    pub(super) ring_supports: Supports,
    pub(super) slabs: Vec<Slab>,
    pub(super) layers: Vec<Layer>,
    pub(super) around: Vec<Around>,
    pub(super) lanes: RingLanes,
    pub(super) imperfect: Option<Arc<Imperfect>>,
    /// What is integrated here: the law of the wall, or its part that resists a change of shape.
    pub(super) law: Material,
    /// The part that resists a change of volume, where it is integrated at fewer points.
    pub(super) volume: Option<Box<SplineTube>>,
}

/// An imperfect geometry.
#[derive(Clone, Debug)]
pub(super) struct Imperfect {
    /// δ, from the perfect tube to the stress-free shape: control values numbered as unknowns are.
    pub(super) displacement: Vec<f64>,
    /// The shape at the quadrature points, by slab: of one ring as slab kernels read it, of more
    /// pencil after pencil.
    pub(super) points: Vec<Vec<StressFree>>,
}

/// Energy and residual at a state.
#[derive(Clone, Debug)]
pub struct Forces {
    /// ∫ w det Fp dV₀ of the whole tube: the paper's W, in E·D³.
    pub energy: f64,
    /// ∫ w dV₀ of the whole tube, over the ungrown volume.
    pub energy_ungrown: f64,
    /// Π of the whole tube: W and the potential of the pressures, which is nothing at rest.
    pub potential: f64,
    /// R of the sector, in E·D²: ∂Π/∂u_cp of the whole tube over the number of repeats.
    pub residual: Vec<f64>,
    /// The forces in play: root of the sum of squares of what the elements add to R, before it
    /// cancels.
    pub residual_scale: f64,
    /// The smallest det Fe at any quadrature point; of those at which the resistance to a change of volume is
    /// integrated, if that is done apart.
    pub smallest_jacobian: f64,
}

/// An element is turned inside out: det Fe is not positive (or not a number).
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the wall is turned inside out (det Fe = {jacobian:.3e}, element {element:?})")]
pub struct Inverted {
    /// Element along the tube, through the wall and around the sector.
    pub element: [usize; 3],
    /// The worst point: the middle of its element along and around, its own depth.
    pub place: Place,
    /// det Fe there.
    pub jacobian: f64,
}

/// Calls a kernel that is compiled for the degree and for the law: neo-Hookean, or any other.
macro_rules! with_law_and_degree {
    ($self:ident, $law:expr, $kernel:ident, $($argument:expr),+) => {
        match &$law {
            Material::NeoHookean(law) => with_degree!($self, law, $kernel, $($argument),+),
            law => with_degree!($self, law, $kernel, $($argument),+),
        }
    };
}

/// The degree p as the number of functions p + 1 that a kernel is compiled for.
macro_rules! with_degree {
    ($self:ident, $law:ident, $kernel:ident, $($argument:expr),+) => {
        match $self.degree() {
            1 => $kernel::<_, 2>($law, $($argument),+),
            2 => $kernel::<_, 3>($law, $($argument),+),
            3 => $kernel::<_, 4>($law, $($argument),+),
            4 => $kernel::<_, 5>($law, $($argument),+),
            5 => $kernel::<_, 6>($law, $($argument),+),
            degree => unreachable!("degree {degree} is refused by SplineTube::new"),
        }
    };
}

pub(super) use {with_degree, with_law_and_degree};

impl SplineTube {
    /// Lays a mesh over a tube; `rings` of the mesh's rings are solved for and repeat. Panics unless the
    /// degree is from 1 to 5, and with reduced integration 3 or 5 and the law not a custom one.
    pub fn new(tube: &Tube, mesh: &Mesh, rings: usize) -> Self {
        let p = mesh.degree;
        assert!((1..=5).contains(&p), "degree {p} is not between 1 and 5");
        let around = mesh.elements()[1];
        let sector = Sector::new(p, around, rings);
        let circle = Circle::new(p, around);
        let [axial, wall] = bases(tube, mesh);
        let displacement = geometry(tube, &tube.imperfections, &sector, [&axial, &wall]);
        let control_radii: Vec<f64> = wall
            .greville()
            .iter()
            .map(|r| r * circle.control_radius)
            .collect();
        let places = [axial.greville(), control_radii];
        let supports = Supports::new(tube, &sector, &places, displacement.as_deref());
        let ring = Sector::new(p, around, 1);
        let of_ring = displacement.as_deref().map(|u| first_ring(u, rings));
        let ring_supports = Supports::new(tube, &ring, &places, of_ring.as_deref());
        let rule = gauss_legendre(p + 1);
        let spline = Self {
            slabs: Slab::all(&axial, &full_rules(&axial)),
            layers: Layer::all(&wall, &full_rules(&wall)),
            around: Around::all(&sector, &circle, &rule),
            lanes: RingLanes::new(sector.rings),
            tube: tube.clone(),
            sector,
            circle,
            axial,
            wall,
            supports,
            ring_supports,
            imperfect: None,
            law: tube.material.clone(),
            volume: None,
        };
        let spline = match displacement {
            Some(displacement) => spline.imperfect(displacement),
            None => spline,
        };
        match mesh.volumetric {
            Integration::Full => spline,
            Integration::Reduced => spline.volume_apart(),
        }
    }

    /// The same with the part of the law that resists a change of volume integrated at fewer points through
    /// the wall.
    fn volume_apart(self) -> Self {
        let [shape, volume] = self
            .law
            .parts()
            .expect("reduced integration needs a law with volumetric part");
        let apart = Self {
            layers: Layer::all(&self.wall, &reduced_rules(&self.wall)),
            law: volume,
            imperfect: None,
            ..self.clone()
        };
        let apart = match &self.imperfect {
            Some(own) => apart.imperfect(own.displacement.clone()),
            None => apart,
        };
        Self {
            law: shape,
            volume: Some(Box::new(apart)),
            ..self
        }
    }

    /// The same tube with one ring to solve for: axisymmetric. Where its geometry is not, it has that
    /// of its first ring all around.
    pub fn of_one_ring(&self) -> Self {
        let sector = Sector::new(self.degree(), self.sector.around, 1);
        let rule: Vec<_> = self.around.iter().map(|at| (at.s, at.weight)).collect();
        let ring = Self {
            around: Around::all(&sector, &self.circle, &rule),
            lanes: RingLanes::new(1),
            supports: self.ring_supports.clone(),
            sector,
            imperfect: None,
            volume: self
                .volume
                .as_ref()
                .map(|volume| Box::new(volume.of_one_ring())),
            ..self.clone()
        };
        match &self.imperfect {
            Some(own) => ring.imperfect(first_ring(&own.displacement, self.sector.rings)),
            None => ring,
        }
    }

    /// The degree p.
    pub fn degree(&self) -> usize {
        self.axial.degree()
    }

    /// Unknowns of one row of control points.
    pub fn row_size(&self) -> usize {
        self.wall.functions() * 3 * self.sector.rings
    }

    /// Control values, numbered as the unknowns, from a function of a control point's z, its
    /// reference radius and its ring that gives (axial, radial, circumferential).
    pub fn control_values(&self, of: impl Fn(f64, f64, usize) -> [f64; 3]) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.unknowns());
        for z in self.axial.greville() {
            for r in self.wall.greville() {
                let point: Vec<[f64; 3]> =
                    (0..self.sector.rings).map(|ring| of(z, r, ring)).collect();
                for i in 0..3 {
                    values.extend(point.iter().map(|u| u[i]));
                }
            }
        }
        values
    }

    /// Unknowns of the sector, given ones included.
    pub fn unknowns(&self) -> usize {
        self.axial.functions() * self.row_size()
    }

    /// For every unknown, whether a support gives it: at a held end, or of one ring so that a loose
    /// tube does not drift (of more see [`SplineTube::take_out_pins`]).
    pub fn prescribed(&self) -> &[bool] {
        &self.supports.prescribed
    }

    /// Displacements pinned so that a loose tube does not drift.
    pub fn rigid_body_constraints(&self) -> usize {
        self.supports.rigid_body_constraints
    }

    /// Takes the pinned displacements of a tube of many rings out of `u`, by orthogonal projection:
    /// at one unknown of a ring for each rigid motion that the ends leave open, the mean over the
    /// rings (along z, about z) or their cosine and sine (two shifts, two tilts). The rest of u stays
    /// as it is; of one ring, all of it, for what is pinned is given.
    pub fn take_out_pins(&self, u: &mut [f64]) {
        self.supports.take_out_pins(u);
    }

    /// Writes what the ends prescribe under a load into `u`.
    pub fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        self.supports.apply_prescribed(load, u);
    }

    /// Energy and residual of a state `u` under a load.
    pub fn forces(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let mut forces = self.elastic_forces(load, u)?;
        if let Some(volume) = &self.volume {
            let apart = volume.elastic_forces(load, u)?;
            forces.energy += apart.energy;
            forces.energy_ungrown += apart.energy_ungrown;
            forces.residual_scale = forces.residual_scale.hypot(apart.residual_scale);
            // Where volume is not resisted det Fe may be anything, as long as it is positive.
            forces.smallest_jacobian = apart.smallest_jacobian;
            for (sum, part) in forces.residual.iter_mut().zip(&apart.residual) {
                *sum += part;
            }
        }
        forces.potential = forces.energy;
        self.add_pressure(load, u, &mut forces);
        Ok(forces)
    }

    /// Energy and residual of the wall, without pressures and the part that is integrated apart.
    fn elastic_forces(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let slabs: Vec<SlabForces> = if self.sector.rings < FEW_RINGS {
            let forces = |(number, slab): (usize, &Slab)| {
                let stretch = self.inverse_stretch(slab, load);
                let shape = self.shape_of_slab(number);
                let input = self.input(slab, (&stretch, shape.as_deref()), u);
                with_law_and_degree!(self, self.law, slab_forces, &input)
            };
            self.slabs.par_iter().enumerate().map(forces).collect()
        } else {
            let u = self.lanes.pad(u);
            let forces = |number| self.forces_by_pencils(number, load, &u);
            (0..self.slabs.len()).into_par_iter().map(forces).collect()
        };

        let repeats = self.sector.repeats();
        let mut forces = Forces {
            energy: 0.0,
            energy_ungrown: 0.0,
            potential: 0.0,
            residual: vec![0.0; u.len()],
            residual_scale: 0.0,
            smallest_jacobian: f64::INFINITY,
        };
        for (slab, part) in self.slabs.iter().zip(&slabs) {
            let Worst {
                jacobian,
                element: [lane, layer, around],
                qr,
            } = part.worst;
            if jacobian.is_nan() || jacobian <= 0.0 {
                let along = slab.first + slab.row(lane);
                let (from, to) = self.axial.element(along);
                return Err(Inverted {
                    element: [along, layer, around],
                    place: self.place(
                        f64::midpoint(from, to),
                        self.layers[layer].radius[qr],
                        around,
                    ),
                    jacobian,
                });
            }
            forces.smallest_jacobian = forces.smallest_jacobian.min(jacobian);
            forces.energy += repeats * part.energy;
            forces.energy_ungrown += repeats * part.energy_ungrown;
            forces.residual_scale += part.squares;
            let rows = &mut forces.residual[slab.first * self.row_size()..];
            for (sum, part) in rows.iter_mut().zip(&part.residual) {
                *sum += part;
            }
        }
        forces.residual_scale = forces.residual_scale.sqrt();
        Ok(forces)
    }

    /// The tangent stiffness ∂R/∂u_cp of the sector at a state; every unknown is free in it. The
    /// state must not be inverted (see [`SplineTube::forces`]).
    pub fn tangent(&self, load: &Load, u: &[f64]) -> BlockBanded {
        let turns = |at: &Around| vec![at.slots.iter().map(Turn::from).collect()];
        self.tangent_on(load, u, &turns)
    }

    /// The block of the whole tube's tangent that belongs to circumferential harmonic n ≥ 1, at
    /// an axisymmetric state without twist: the tangent is block-circulant there, and real on
    /// displacements (z cos nφ, r cos nφ, −θ sin nφ). Scaled by 2/N_C; every unknown is free.
    pub fn harmonic_tangent(&self, load: &Load, u: &[f64], n: usize) -> BlockBanded {
        assert!(self.sector.rings == 1 && n >= 1);
        let turns = |at: &Around| {
            self.sector
                .harmonic_at(n, at.s)
                .map(|half| vec![half])
                .to_vec()
        };
        self.tangent_on(load, u, &turns)
    }

    /// For every unknown of circumferential harmonic n of the tube, whether a support gives it or it
    /// is pinned against a rigid motion of that harmonic.
    pub fn prescribed_in_harmonic(&self, n: usize) -> Vec<bool> {
        self.supports.in_harmonic(n)
    }

    /// For every unknown of one ring, whether an end gives it; nothing is pinned.
    pub fn held_in_harmonics(&self) -> Vec<bool> {
        self.ring_supports.held()
    }

    /// The small rigid motions of circumferential harmonic n that the ends leave, at an axisymmetric
    /// state without twist: displacements as those of [`SplineTube::harmonic_tangent`].
    pub fn rigid_motions_in_harmonic(&self, u: &[f64], n: usize) -> Vec<Vec<f64>> {
        assert!(self.sector.rings == 1);
        let (rows, points) = (self.axial.greville(), self.wall.greville());
        let points: Vec<[f64; 2]> = u
            .chunks_exact(3)
            .enumerate()
            .map(|(at, u)| {
                let (row, point) = (at / points.len(), at % points.len());
                let radius = points[point] * self.circle.control_radius;
                [rows[row] + u[0], radius + u[1]]
            })
            .collect();
        left_by(motions_in_harmonic(n, &points), &self.held_in_harmonics())
    }

    /// The tangent where the slots of a point around are turned as `turns` says.
    fn tangent_on(
        &self,
        load: &Load,
        u: &[f64],
        turns: &dyn Fn(&Around) -> Vec<Vec<Turn>>,
    ) -> BlockBanded {
        let (p, m) = (self.degree(), self.row_size());
        let mut matrix = BlockBanded::zeros(self.axial.functions(), m, p);
        let all = |tube: &Self| tube.around.iter().map(turns).collect::<Vec<_>>();
        let own = all(self);
        self.add_elastic_tangent(load, u, &own, &mut matrix);
        if let Some(volume) = &self.volume {
            volume.add_elastic_tangent(load, u, &all(volume), &mut matrix);
        }
        self.add_pressure_tangent(load, u, &own, &mut matrix);
        matrix
    }

    fn add_elastic_tangent(
        &self,
        load: &Load,
        u: &[f64],
        turns: &[Vec<Vec<Turn>>],
        matrix: &mut BlockBanded,
    ) {
        let (p, m) = (self.degree(), self.row_size());
        // What is held before it is summed: a few slabs at a time when rows are large.
        let slab_bytes = 8 * (p + 1) * m * m * (8 + p);
        let together = (SLAB_MEMORY / slab_bytes).clamp(2, self.slabs.len().max(2));
        let mut before: Option<(usize, SlabTangent)> = None;
        for (chunk, slabs) in self.slabs.chunks(together).enumerate() {
            let mut parts: Vec<(usize, SlabTangent)> = slabs
                .par_iter()
                .enumerate()
                .map(|(number, slab)| {
                    let stretch = self.inverse_stretch(slab, load);
                    let shape = self.shape_of_slab(chunk * together + number);
                    let input = self.input(slab, (&stretch, shape.as_deref()), u);
                    (
                        slab.first,
                        with_law_and_degree!(self, self.law, slab_tangent, &input, turns),
                    )
                })
                .collect();
            // A row takes what its own slab left, then what the slab before left.
            let first = parts[0].0;
            let last = parts[parts.len() - 1].0 + slabs[slabs.len() - 1].elements;
            let end = if last == self.axial.elements() {
                last + p
            } else {
                last
            };
            let places = self.places(matrix);
            let parts_before = before.as_slice();
            matrix.panels_mut().enumerate().collect::<Vec<_>>()[first..end]
                .par_iter_mut()
                .for_each(|(row, panel)| {
                    for (from, part) in parts.iter().chain(parts_before) {
                        if (*from..from + part.rows).contains(row) {
                            for (i, &place) in places.iter().enumerate() {
                                panel[place] += part.entries[i * part.rows + *row - from];
                            }
                        }
                    }
                });
            before = parts.pop();
        }
    }

    /// The drag matrix ∫ N N dV₀ of the sector.
    pub fn damping(&self) -> BlockBanded {
        let shape = [self.axial.functions(), self.wall.functions()];
        damping(
            &self.slabs,
            &self.layers,
            &self.around,
            &self.sector,
            shape,
            self.degree(),
        )
    }

    /// The drag matrix of the sector as a product of three small ones.
    pub fn ring_damping(&self) -> RingDamping {
        RingDamping::new(
            &self.slabs,
            &self.layers,
            &self.around,
            &self.sector,
            [self.axial.functions(), self.wall.functions()],
            self.degree(),
        )
    }

    /// Where the entries of a slab's tangent sit in a panel, in their order.
    fn places(&self, matrix: &BlockBanded) -> Vec<usize> {
        let m = self.row_size();
        let mut places = Vec::with_capacity((self.degree() + 1) * m * m);
        for d in 0..=self.degree() {
            for column in 0..m {
                places.extend((0..m).map(|row| matrix.place(d, row, column)));
            }
        }
        places
    }

    pub(super) fn inverse_stretch(&self, slab: &Slab, load: &Load) -> Vec<(Lanes, Lanes)> {
        let at = |z: &Lanes| {
            let (mut along, mut around) = (Lanes::default(), Lanes::default());
            for l in 0..z.0.len() {
                // Angle zero stands for all: imperfections that vary around are not seen here.
                let (theta_z, theta_t) = self.tube.stretches_at(z.0[l], 0.0, load);
                along.0[l] = 1.0 / theta_z;
                around.0[l] = 1.0 / theta_t;
            }
            (along, around)
        };
        slab.z.iter().map(at).collect()
    }

    pub(super) fn input<'a>(
        &'a self,
        slab: &'a Slab,
        (inverse_stretch, stress_free): (&'a [(Lanes, Lanes)], Option<&'a [StressFree]>),
        u: &'a [f64],
    ) -> SlabInput<'a> {
        let m = self.row_size();
        let rows = slab.elements + self.degree();
        SlabInput {
            slab,
            layers: &self.layers,
            around: &self.around,
            points: self.wall.functions(),
            rings: self.sector.rings,
            inverse_stretch,
            stress_free,
            u: &u[slab.first * m..(slab.first + rows) * m],
        }
    }
}

/// Bases along a tube, over z, and through its wall, over the reference radius.
pub(super) fn bases(tube: &Tube, mesh: &Mesh) -> [Basis; 2] {
    let [along, _, through] = mesh.elements();
    let breakpoints = graded_breakpoints(tube.length, along, &mesh.refinements);
    let radii = graded_breakpoints(tube.thickness, through, &[]);
    let radii: Vec<f64> = radii.iter().map(|h| tube.inner_radius() + h).collect();
    [
        Basis::open(mesh.degree, &breakpoints),
        Basis::open(mesh.degree, &radii),
    ]
}

/// The unknowns of the first of several rings.
fn first_ring(u: &[f64], rings: usize) -> Vec<f64> {
    u.iter().step_by(rings).copied().collect()
}

/// Rings from which their elements share enough to be worked on as pencils.
pub(super) const FEW_RINGS: usize = 2;

/// Bytes of slab tangents that are held before they are summed.
const SLAB_MEMORY: usize = 256 << 20;
