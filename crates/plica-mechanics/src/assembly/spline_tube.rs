//! The discretised tube: its bases, the numbering of its unknowns, and its boundary conditions.

use super::barrier::Barrier;
use super::boundary_conditions::{BoundaryConditions, permitted_by, rigid_motions_in_harmonic};
use super::circumferential::PaddedRings;
use super::coulomb::ELASTIC_SLIP;
use super::imperfection::geometry;
use super::stress_free::StressFreeStretch;
use super::tables::{AxialBatch, CircumferentialPoint, Layer, bases, full_rules, reduced_rules};
use crate::activation::Muscle;
use crate::material::{Composite, Material};
use crate::rings::Sector;
use crate::spline::{Basis, Circle, gauss_legendre};
use crate::tube::{Integration, Load, Mesh, Tube};
use std::ops::Range;
use std::sync::Arc;

/// A tube discretised by splines.
///
/// Unknowns are numbered by row of control points along the tube, then by point through the wall,
/// component (axial, radial, circumferential), and ring of the sector.
#[derive(Clone, Debug)]
pub struct SplineTube {
    /// The tube.
    pub tube: Tube,
    /// The cyclic sector: its control rings and their number around the tube.
    pub sector: Sector,
    /// The spline circle.
    pub circle: Circle,
    /// Basis along the tube, over z.
    pub axial: Basis,
    /// Basis through the wall, over the reference radius R.
    pub wall: Basis,
    pub(super) boundary_conditions: BoundaryConditions,
    /// Boundary conditions of a sector of one ring.
    pub(super) ring_boundary_conditions: BoundaryConditions,
    pub(super) batches: Vec<AxialBatch>,
    /// Elements through the wall of this part of it.
    pub(super) layers: Vec<Layer>,
    pub(super) around: Vec<CircumferentialPoint>,
    pub(super) padded_rings: PaddedRings,
    pub(super) stress_free_shape: Option<Arc<StressFreeShape>>,
    /// Law integrated at the points of `layers`: that of a layer of the wall, or one of its parts.
    pub(super) law: Material,
    /// Number of the layer of the wall.
    pub(super) wall_layer: usize,
    /// The energy that `law` is.
    pub(super) kind: PartKind,
    /// The other parts of the wall: its other layers, the volumetric parts of laws, and active stresses.
    pub(super) parts: Vec<SplineTube>,
    /// Barrier of contact with obstacles.
    pub(super) barrier: Barrier,
    /// Largest elastic slip of friction, in ranges of the barrier.
    pub(super) elastic_slip: f64,
}

/// The energy of a part of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PartKind {
    /// Energy of the law of a layer, or of its shear part.
    Law,
    /// Energy of the volumetric part of a law, integrated at fewer points than the shear part.
    Volume,
    /// Energy of the active stress of a muscle in a layer: a law for a tension of one, which the tension of the muscle multiplies.
    Muscle(usize),
}

/// Stress-free shape of an imperfect wall.
#[derive(Clone, Debug)]
pub(super) struct StressFreeShape {
    /// δ, from the perfect tube to the stress-free shape: control values numbered like the
    /// unknowns.
    pub(super) displacement: Vec<f64>,
    /// The shape at the quadrature points, by axial batch: in the order of the axial kernels for
    /// one ring, else one circumferential batch after the other.
    pub(super) points: Vec<Vec<StressFreeStretch>>,
}

impl SplineTube {
    /// Discretises a tube by a mesh; `rings` of the mesh's rings form the cyclic sector. Panics
    /// unless the degree is from 1 to 5, and with reduced integration 3 or 5 and no law a
    /// custom one, or if the layers of the mesh are not those of the tube.
    pub fn new(tube: &Tube, mesh: &Mesh, rings: usize) -> Self {
        let p = mesh.degree;
        assert!((1..=5).contains(&p), "degree {p} is not between 1 and 5");
        let layers = mesh.elements_of_layers();
        assert_eq!(layers.len(), tube.layers.len(), "layers of mesh and tube");
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
        let control_points = [axial.greville(), control_radii];
        let boundary_conditions =
            BoundaryConditions::new(tube, &sector, &control_points, displacement.as_deref());
        let ring = Sector::new(p, around, 1);
        let of_ring = displacement.as_deref().map(|u| first_ring(u, rings));
        let ring_boundary_conditions =
            BoundaryConditions::new(tube, &ring, &control_points, of_ring.as_deref());
        let rule = gauss_legendre(p + 1);
        let spline = Self {
            batches: AxialBatch::all(&axial, &full_rules(&axial)),
            layers: vec![],
            around: CircumferentialPoint::all(&sector, &circle, &rule),
            padded_rings: PaddedRings::new(sector.rings),
            barrier: Barrier::of_mesh(&axial, mesh.contact_range),
            elastic_slip: ELASTIC_SLIP,
            tube: tube.clone(),
            sector,
            circle,
            axial,
            wall,
            boundary_conditions,
            ring_boundary_conditions,
            stress_free_shape: None,
            law: tube.layers[0].material.clone(),
            wall_layer: 0,
            kind: PartKind::Law,
            parts: vec![],
        };
        spline.with_parts(&layers, mesh.volumetric, displacement.as_deref())
    }

    /// Returns the tube with the parts of its wall: every layer, with the volumetric part of its law apart if that is
    /// integrated at fewer points, and the muscles with active stress in it. `displacement` is that of the stress-free shape.
    fn with_parts(
        self,
        layers: &[Range<usize>],
        integration: Integration,
        displacement: Option<&[f64]>,
    ) -> Self {
        let rules = full_rules(&self.wall);
        let mut parts = vec![];
        for (l, elements) in layers.iter().enumerate() {
            let law = &self.tube.layers[l].material;
            let rules = &rules[elements.clone()];
            let (law, volume) = match integration {
                Integration::Full => (law.clone(), None),
                Integration::Reduced => {
                    let [shear, volume] = law
                        .parts()
                        .expect("reduced integration needs a law with volumetric part");
                    (shear, Some(volume))
                }
            };
            let part = |rules: &[_], law, kind| {
                let part = self.part((l, elements.start), rules, law, kind);
                match displacement {
                    Some(displacement) => part.with_stress_free_shape(displacement.to_vec()),
                    None => part,
                }
            };
            let own = part(rules, law, PartKind::Law);
            let active = self.active_parts(&own);
            parts.push(own);
            if let Some(volume) = volume {
                let reduced = reduced_rules(self.degree(), elements.len());
                parts.push(part(&reduced, volume, PartKind::Volume));
            }
            parts.extend(active);
        }
        let others = parts.split_off(1);
        let first = parts.swap_remove(0);
        Self {
            parts: others,
            ..first
        }
    }

    /// Returns a part of the wall: the elements of a layer from the first on, with their quadrature rules and a law.
    fn part(
        &self,
        (layer, first): (usize, usize),
        rules: &[Vec<(f64, f64)>],
        law: Material,
        kind: PartKind,
    ) -> Self {
        Self {
            layers: self.with_residual(layer, Layer::all(&self.wall, first, rules)),
            law,
            wall_layer: layer,
            kind,
            parts: vec![],
            ..self.clone()
        }
    }

    /// Returns the active stresses of the muscles of a layer, at the quadrature points of its part.
    fn active_parts(&self, layer: &Self) -> Vec<Self> {
        let idle = &self.tube.layers[layer.wall_layer].idle_muscles;
        let part = |(m, muscle): (usize, &Muscle)| {
            let tone = muscle.active_stress.clone()?;
            Some(Self {
                law: Material::Composite(Composite::only(tone)),
                kind: PartKind::Muscle(m),
                ..layer.clone()
            })
        };
        let muscles = self.tube.muscles.iter().enumerate();
        muscles
            .filter(|(m, _)| !idle.contains(m))
            .filter_map(part)
            .collect()
    }

    /// Adds the residual stretch of a layer of the wall to its elements.
    pub(super) fn with_residual(&self, layer: usize, elements: Vec<Layer>) -> Vec<Layer> {
        if self.tube.layers[layer].residual.is_none() {
            return elements;
        }
        let stretch = |radius| self.tube.residual_stretch(layer, radius);
        let with_residual = |element: Layer| element.with_residual(stretch);
        elements.into_iter().map(with_residual).collect()
    }

    /// Returns the parts of the wall, this one first.
    pub(super) fn all_parts(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.parts)
    }

    /// Returns true if this part is the volumetric part of a law.
    pub(super) fn is_volumetric(&self) -> bool {
        self.kind == PartKind::Volume
    }

    /// Returns true if this part is the active stress of a muscle without tension.
    pub(super) fn is_idle(&self, load: &Load) -> bool {
        matches!(self.kind, PartKind::Muscle(m) if load.muscles[m] == 0.0)
    }

    /// Returns all elements through the wall.
    pub(super) fn elements_through(&self) -> impl Iterator<Item = &Layer> {
        let parts = self.all_parts().filter(|part| part.kind == PartKind::Law);
        parts.flat_map(|part| &part.layers)
    }

    /// Returns the axisymmetric tube: a sector of one ring. If the geometry varies around the tube,
    /// that of the first ring applies all around.
    pub fn axisymmetric(&self) -> Self {
        let sector = Sector::new(self.degree(), self.sector.around, 1);
        let rule: Vec<_> = self.around.iter().map(|at| (at.s, at.weight)).collect();
        let ring = Self {
            around: CircumferentialPoint::all(&sector, &self.circle, &rule),
            padded_rings: PaddedRings::new(1),
            boundary_conditions: self.ring_boundary_conditions.clone(),
            sector,
            stress_free_shape: None,
            parts: self.parts.iter().map(Self::axisymmetric).collect(),
            ..self.clone()
        };
        match &self.stress_free_shape {
            Some(shape) => {
                ring.with_stress_free_shape(first_ring(&shape.displacement, self.sector.rings))
            }
            None => ring,
        }
    }

    /// Returns the same tube with another barrier of contact, with obstacles and of the wall with itself.
    pub fn with_barrier(self, barrier: Barrier) -> Self {
        Self { barrier, ..self }
    }

    /// Returns the same tube with another largest elastic slip of friction, in ranges of contact.
    pub fn with_elastic_slip(self, elastic_slip: f64) -> Self {
        Self {
            elastic_slip,
            ..self
        }
    }

    /// Returns the largest elastic slip of friction, in D.
    pub fn elastic_slip(&self) -> f64 {
        self.elastic_slip * self.barrier.range
    }

    /// Returns the barrier of contact, with obstacles and of the wall with itself.
    pub fn barrier(&self) -> &Barrier {
        &self.barrier
    }

    /// Returns the degree p.
    pub fn degree(&self) -> usize {
        self.axial.degree()
    }

    /// Returns the number of unknowns in a row of control points.
    pub fn row_size(&self) -> usize {
        self.wall.functions() * 3 * self.sector.rings
    }

    /// Returns control values, numbered like the unknowns, from a function of a control point's z,
    /// reference radius and ring that returns (axial, radial, circumferential).
    pub fn control_values_from(&self, of: impl Fn(f64, f64, usize) -> [f64; 3]) -> Vec<f64> {
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

    /// Returns the number of unknowns of the sector, prescribed ones included.
    pub fn unknowns(&self) -> usize {
        self.axial.functions() * self.row_size()
    }

    /// Returns for every unknown whether it is prescribed: at the ends, and for a sector of one
    /// ring by rigid-body constraints (for more rings see
    /// `SplineTube::project_out_constraints`).
    pub fn prescribed(&self) -> &[bool] {
        &self.boundary_conditions.prescribed
    }

    /// Projects `u` orthogonally onto the displacements that satisfy the rigid-body constraints of
    /// a sector of many rings. For each rigid motion that the ends permit, one unknown of a ring
    /// has no mean over the rings (motion along and about z), or no cosine and sine (two shifts,
    /// two tilts). Leaves `u` unchanged for one ring, whose constrained unknowns are prescribed.
    pub fn project_out_constraints(&self, u: &mut [f64]) {
        self.boundary_conditions.project_out_constraints(u);
    }

    /// Writes the values that the ends prescribe under a load into `u`.
    pub fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        self.boundary_conditions.apply_prescribed(load, u);
    }

    /// Returns for every unknown of circumferential harmonic n of the tube whether the ends or a
    /// rigid-body constraint prescribe it.
    pub fn prescribed_in_harmonic(&self, n: usize) -> Vec<bool> {
        self.boundary_conditions.prescribed_in_harmonic(n)
    }

    /// Returns for every unknown of one ring whether an end prescribes it, without rigid-body
    /// constraints.
    pub fn prescribed_at_ends(&self) -> Vec<bool> {
        self.ring_boundary_conditions.prescribed_at_ends()
    }

    /// Returns the infinitesimal rigid motions of circumferential harmonic n that ends and foundations permit,
    /// at an axisymmetric state without twist, as displacements like those of
    /// [`SplineTube::tangent_in_harmonic`].
    pub fn rigid_motions_in_harmonic(&self, u: &[f64], n: usize) -> Vec<Vec<f64>> {
        assert!(self.sector.rings == 1);
        if self.tube.is_held_by_foundations(n) {
            return vec![];
        }
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
        permitted_by(
            rigid_motions_in_harmonic(n, &points),
            &self.prescribed_at_ends(),
        )
    }
}

/// Returns the unknowns of the first of several rings.
fn first_ring(u: &[f64], rings: usize) -> Vec<f64> {
    u.iter().step_by(rings).copied().collect()
}
