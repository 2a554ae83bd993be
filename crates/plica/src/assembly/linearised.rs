//! A tube of many rings at a state, by pencils: its forces, and its tangent without a matrix.

use super::SplineTube;
use super::forces::{SlabForces, Worst};
use super::pencil::{
    AVERAGED, Kept, PencilInput, kept_len, pencil_forces, pencil_keep, pencil_product,
    pencil_stress_free, slab_offsets,
};
use super::pressure::Pressed;
use super::spline_tube::{with_degree, with_law_and_degree};
use super::stress_free::StressFree;
use super::tables::{Around, Layer, Slab};
use super::tangent::SlabTangent;
use crate::material::Material;
use crate::matrix::BlockBanded;
use crate::rings::Circulant;
use crate::tensor::{LANES, Lanes};
use crate::tube::Load;
use rayon::prelude::*;

/// The tangent stiffness at a state: what its products need, and its average around the tube.
#[derive(Clone, Debug, Default)]
pub struct Linearised {
    /// 1/θζ and 1/θη, element by element along the tube.
    stretch: Vec<Vec<(Lanes, Lanes)>>,
    /// By slab.
    kept: Vec<Kept>,
    pressed: Option<Pressed>,
    /// Of the part that resists a change of volume, where that is integrated apart; its average is in
    /// the whole's.
    volume: Option<Box<Linearised>>,
    /// The tangent averaged over the rings; every unknown is free.
    pub average: Circulant,
}

impl SplineTube {
    /// The tangent stiffness ∂R/∂u_cp of the sector at a state, for products. The state must not
    /// be inverted (see [`SplineTube::forces`]). Stores the law's
    /// tangent data in single precision at every quadrature point.
    pub fn linearised(&self, load: &Load, u: &[f64]) -> Linearised {
        let mut at = Linearised::default();
        self.linearise(load, u, &mut at);
        at
    }

    /// The same in the memory of another state's.
    pub fn linearise(&self, load: &Load, u: &[f64], at: &mut Linearised) {
        at.pressed = self.pressed(load, u);
        self.linearise_elastic(load, u, at);
        if let Some(volume) = &self.volume {
            let apart = at.volume.get_or_insert_default();
            volume.linearise_elastic(load, u, apart);
            at.average.add(&apart.average);
        }
        if let Some(pressed) = &at.pressed {
            self.add_average_pressure(pressed, &mut at.average);
        }
    }

    fn linearise_elastic(&self, load: &Load, u: &[f64], at: &mut Linearised) {
        let u = self.lanes.pad(u);
        let lanes = |slab: &Slab| {
            let of = |lane| self.pencil_stretch(slab, lane, &self.around, load);
            (0..slab.elements).map(of).collect::<Vec<_>>()
        };
        at.stretch = self.slabs.iter().flat_map(lanes).collect();
        at.kept.resize(self.slabs.len(), vec![]);
        let stretch = &at.stretch;
        let functions = self.degree() + 1;
        let element = functions.pow(3) * self.layers.len() * AVERAGED;
        let offsets: Vec<Vec<SlabTangent>> = (&self.slabs, &mut at.kept)
            .into_par_iter()
            .enumerate()
            .map(|(number, (slab, kept))| {
                let (layers, rings) = (self.layers.len(), self.lanes.vectors());
                let len = with_law_and_degree!(self, self.law, kept_len, layers, rings);
                kept.resize(len * slab.elements, [0.0; 16]);
                let mut averaged = vec![0.0; element * slab.elements];
                for lane in 0..slab.elements {
                    let stretch = &stretch[slab.first + lane];
                    let input = self.pencil((number, lane), stretch, &u);
                    let kept = &mut kept[lane * len..][..len];
                    let averaged = &mut averaged[lane * element..][..element];
                    with_law_and_degree!(self, self.law, pencil_keep, &input, kept, averaged);
                }
                self.slab_offsets(slab, &averaged)
            })
            .collect();
        self.circulant(&offsets, &mut at.average);
    }

    /// y += factor · K v.
    pub fn product(&self, at: &Linearised, factor: f64, v: &[f64], y: &mut [f64]) {
        if let Some(pressed) = &at.pressed {
            self.pressure_product(pressed, factor, v, y);
        }
        let v = self.lanes.pad(v);
        self.elastic_product(at, factor, &v, y);
        if let (Some(volume), Some(apart)) = (&self.volume, &at.volume) {
            volume.elastic_product(apart, factor, &v, y);
        }
    }

    /// The product of the wall's part, on v in padded rows.
    fn elastic_product(&self, at: &Linearised, factor: f64, v: &[f64], y: &mut [f64]) {
        let row = self.wall.functions() * 3 * self.lanes.padded;
        let parts: Vec<Vec<f64>> = self
            .slabs
            .par_iter()
            .zip(&at.kept)
            .enumerate()
            .map(|(number, (slab, kept))| {
                let mut out = vec![0.0; (slab.elements + self.degree()) * row];
                let len = kept.len() / slab.elements;
                for lane in 0..slab.elements {
                    let stretch = &at.stretch[slab.first + lane];
                    let input = self.pencil((number, lane), stretch, v);
                    let kept = &kept[lane * len..][..len];
                    let out = &mut out[lane * row..][..(self.degree() + 1) * row];
                    with_law_and_degree!(self, self.law, pencil_product, &input, kept, out);
                }
                out
            })
            .collect();
        for (slab, part) in self.slabs.iter().zip(&parts) {
            self.add_rows(slab, factor, part, y);
        }
    }

    /// What [`SplineTube::forces`] wants of a slab.
    pub(super) fn forces_by_pencils(&self, number: usize, load: &Load, u: &[f64]) -> SlabForces {
        let slab = &self.slabs[number];
        let row = self.wall.functions() * 3 * self.lanes.padded;
        let mut residual = vec![0.0; (slab.elements + self.degree()) * row];
        let mut sum = SlabForces {
            worst: Worst {
                jacobian: f64::INFINITY,
                ..Worst::default()
            },
            ..SlabForces::default()
        };
        for lane in 0..slab.elements {
            let stretch = self.pencil_stretch(slab, lane, &self.around, load);
            let input = self.pencil((number, lane), &stretch, u);
            let residual = &mut residual[lane * row..][..(self.degree() + 1) * row];
            let part = with_law_and_degree!(self, self.law, pencil_forces, &input, residual);
            sum.energy += part.energy;
            sum.energy_ungrown += part.energy_ungrown;
            sum.squares += part.squares;
            let worse = part.worst.jacobian.is_nan() || part.worst.jacobian < sum.worst.jacobian;
            if worse && !sum.worst.jacobian.is_nan() {
                sum.worst = part.worst;
                sum.worst.element[0] = lane;
            }
        }
        sum.residual = vec![0.0; (slab.elements + self.degree()) * self.row_size()];
        let alone = Slab {
            first: 0,
            ..slab.clone()
        };
        self.add_rows(&alone, 1.0, &residual, &mut sum.residual);
        sum
    }

    /// Adds the padded rows of a slab to those of the tube.
    fn add_rows(&self, slab: &Slab, factor: f64, part: &[f64], y: &mut [f64]) {
        let k = self.sector.rings;
        let rows = y[slab.first * self.row_size()..].chunks_exact_mut(k);
        for (y, part) in rows.zip(part.chunks_exact(self.lanes.padded)) {
            for (y, x) in y.iter_mut().zip(part) {
                *y += factor * x;
            }
        }
    }

    /// What a slab adds to the blocks between rings: moduli summed around the tube, element after
    /// element.
    fn slab_offsets(&self, slab: &Slab, summed: &[f64]) -> Vec<SlabTangent> {
        let (points, layers) = (self.wall.functions(), &self.layers);
        let (sector, around) = (&self.sector, &self.around);
        match self.degree() {
            1 => slab_offsets::<2>(slab, layers, points, sector, around, summed),
            2 => slab_offsets::<3>(slab, layers, points, sector, around, summed),
            3 => slab_offsets::<4>(slab, layers, points, sector, around, summed),
            4 => slab_offsets::<5>(slab, layers, points, sector, around, summed),
            5 => slab_offsets::<6>(slab, layers, points, sector, around, summed),
            degree => unreachable!("degree {degree} is refused by SplineTube::new"),
        }
    }

    /// The blocks between rings, of what the slabs add to them.
    fn circulant(&self, parts: &[Vec<SlabTangent>], average: &mut Circulant) {
        let (p, m) = (self.degree(), self.wall.functions() * 3);
        let zeros = || BlockBanded::zeros(self.axial.functions(), m, p);
        average.offsets.resize_with(p + 1, zeros);
        average.angle = self.sector.angle();
        average
            .offsets
            .par_iter_mut()
            .enumerate()
            .for_each(|(d, matrix)| {
                matrix.clear();
                for (slab, part) in self.slabs.iter().zip(parts) {
                    part[d].add_to(matrix, slab.first, m, p);
                }
            });
    }

    /// The stress-free shape at the points of a pencil, under displacements of the perfect tube.
    pub(super) fn pencil_shape(
        &self,
        slab: &Slab,
        lane: usize,
        layers: &[Layer],
        around: &[Around],
        displacement: &[f64],
    ) -> Vec<StressFree> {
        let row = self.wall.functions() * 3 * self.lanes.padded;
        let perfect = PencilInput {
            slab,
            lane,
            layers,
            around,
            points: self.wall.functions(),
            rings: &self.lanes,
            inverse_stretch: &[],
            stress_free: None,
            u: &displacement[(slab.first + lane) * row..][..(self.degree() + 1) * row],
        };
        match self.degree() {
            1 => pencil_stress_free::<2>(&perfect),
            2 => pencil_stress_free::<3>(&perfect),
            3 => pencil_stress_free::<4>(&perfect),
            4 => pencil_stress_free::<5>(&perfect),
            5 => pencil_stress_free::<6>(&perfect),
            degree => unreachable!("degree {degree} is refused by SplineTube::new"),
        }
    }

    /// What a pencil kernel reads, at an element along the tube: a slab's number, and a lane of it.
    fn pencil<'a>(
        &'a self,
        (number, lane): (usize, usize),
        inverse_stretch: &'a [(Lanes, Lanes)],
        u: &'a [f64],
    ) -> PencilInput<'a> {
        let slab = &self.slabs[number];
        let row = self.wall.functions() * 3 * self.lanes.padded;
        PencilInput {
            slab,
            lane,
            layers: &self.layers,
            around: &self.around,
            points: self.wall.functions(),
            rings: &self.lanes,
            inverse_stretch,
            stress_free: self.imperfect.as_ref().map(|imperfect| {
                let points = &imperfect.points[number];
                let pencil = points.len() / slab.elements;
                &points[lane * pencil..][..pencil]
            }),
            u: &u[(slab.first + lane) * row..][..(self.degree() + 1) * row],
        }
    }

    /// 1/θζ and 1/θη at the points of an element along the tube; where a muscle is not the same all
    /// around, for every point around and every vector of elements too.
    pub(super) fn pencil_stretch(
        &self,
        slab: &Slab,
        lane: usize,
        around: &[Around],
        load: &Load,
    ) -> Vec<(Lanes, Lanes)> {
        let inverse = |at: &dyn Fn(usize) -> (f64, f64)| {
            let stretches: [(f64, f64); LANES] = std::array::from_fn(at);
            (
                Lanes(stretches.map(|(along, _)| 1.0 / along)),
                Lanes(stretches.map(|(_, around)| 1.0 / around)),
            )
        };
        let mut stretch = vec![];
        for z in slab.z.iter().map(|z| z.0[lane]) {
            if !self.tube.muscles_vary_around() {
                stretch.push(inverse(&|_| self.tube.stretches(z, load)));
                continue;
            }
            for point in around {
                for v in 0..self.lanes.vectors() {
                    stretch.push(inverse(&|lane| {
                        let element = (v * LANES + lane) % self.sector.rings;
                        // The middle of element 0 is at angle zero.
                        let phi = (element as f64 + point.s - 0.5) * self.sector.angle();
                        self.tube.stretches_at(z, phi, load)
                    }));
                }
            }
        }
        stretch
    }
}
