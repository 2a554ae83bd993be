//! What imperfections displace, as control values: the faces of held ends, and the stress-free
//! shape of the wall.
//!
//! A wave of harmonic n, ψ = φ − φ₀, displaces a cross-section by
//!
//! - radially a cos nψ, circumferentially −(a/n) sin nψ, so that rings keep their length (n = 0:
//!   radially a); n = 1 is a shift sideways;
//! - or axially a (2R/D) cos nψ (n = 0: a); n = 1 is a tilt.
//!
//! In the plane of the cross-section, as complex numbers, the first is
//!
//! a exp(iφ) (cos nψ − (i/n) sin nψ) = a exp(iφ) (½ (1 − 1/n) exp(inψ) + ½ (1 + 1/n) exp(−inψ)),
//!
//! two waves of n + 1 and n − 1 turns. The control points of each are as high as makes the spline
//! draw it right in the sense of least squares: c_m of [`Sector::control_wave`].

use super::spline_tube::bases;
use super::spline_tube::{FEW_RINGS, Imperfect};
use super::stress_free::{StressFree, slab_stress_free};
use super::tables::Slab;
use super::{Inverted, SplineTube};
use crate::rings::Sector;
use crate::spline::{Basis, Values, through, transfer};
use crate::tube::{Axial, End, Imperfection, Mode, Part, Push, Shape, Support, Tube, Wave};
use rayon::prelude::*;
use std::borrow::Cow;
use std::f64::consts::PI;
use std::sync::Arc;

/// Distance from a held end, in D, over which a geometric imperfection that is the same all along
/// the tube comes in.
const RISE: f64 = 0.5;

/// (Axial, radial, circumferential) displacement that the imperfections of an end give its control
/// points, at the control radii `r`; ring `j` of point `c` is at `c * k + j`.
pub(super) fn end_face(tube: &Tube, sector: &Sector, end: End, r: &[f64]) -> Vec<[f64; 3]> {
    let k = sector.rings;
    let mut face = vec![[0.0; 3]; r.len() * k];
    for imperfection in &tube.imperfections {
        let Part::End(of, push) = imperfection.of else {
            continue;
        };
        if of != end {
            continue;
        }
        for wave in imperfection.shape.waves() {
            let size = imperfection.amplitude * wave.share;
            let drawn = Drawn::new(wave, sector);
            for ring in 0..k {
                let ([radial, around], axial) = (drawn.across(ring), drawn.axial(ring));
                for (c, &r) in r.iter().enumerate() {
                    let point = &mut face[c * k + ring];
                    match push {
                        Push::Across => {
                            point[1] += size * radial;
                            point[2] += size * around;
                        }
                        Push::Axial if wave.harmonic == 0 => point[0] += size,
                        Push::Axial => point[0] += size * axial * (r / Tube::OUTER_RADIUS),
                    }
                }
            }
        }
    }
    face
}

/// u₀ of the stress-free shape X + u₀(X) of a tube with imperfections: control values numbered as
/// unknowns are. None if none is of the geometry. `bases` are those along the tube and through the
/// wall.
pub(super) fn geometry(
    tube: &Tube,
    imperfections: &[Imperfection],
    sector: &Sector,
    bases: [&Basis; 2],
) -> Option<Vec<f64>> {
    let [axial, wall] = bases;
    let (k, points) = (sector.rings, wall.functions());
    let mut u: Option<Vec<f64>> = None;
    for imperfection in imperfections.iter().filter(|i| i.of == Part::Geometry) {
        let u = u.get_or_insert_with(|| vec![0.0; axial.functions() * points * 3 * k]);
        for wave in imperfection.shape.waves() {
            let drawn = Drawn::new(wave, sector);
            let factors = axial
                .greville()
                .iter()
                .map(|&z| along(wave, tube, z))
                .collect();
            let rows = u.chunks_exact_mut(points * 3 * k);
            for (row, factor) in rows.zip(through(axial, factors, 1)) {
                let size = imperfection.amplitude * wave.share * factor;
                for ring in 0..k {
                    let [radial, around] = drawn.across(ring);
                    for point in row.chunks_exact_mut(3 * k) {
                        point[k + ring] += size * radial;
                        point[2 * k + ring] += size * around;
                    }
                }
            }
        }
        if let Shape::Mode(mode) = &imperfection.shape {
            let own = DrawnMode::new(mode, tube);
            let size = imperfection.amplitude / own.largest();
            for (point, values) in u.chunks_exact_mut(3 * k).zip(own.on(bases, sector)) {
                for ring in 0..k {
                    let (sin, cos) = (mode.harmonic as f64 * sector.ring_angle(ring)).sin_cos();
                    let around = if mode.harmonic == 0 { 1.0 } else { -sin };
                    point[ring] += size * cos * values[0];
                    point[k + ring] += size * cos * values[1];
                    point[2 * k + ring] += size * around * values[2];
                }
            }
        }
    }
    u
}

impl SplineTube {
    /// The tube with a stress-free shape that is displaced from its own.
    pub(super) fn imperfect(mut self, displacement: Vec<f64>) -> Self {
        let points = if self.sector.rings < FEW_RINGS {
            let slabs = self.slabs.par_iter();
            slabs
                .map(|slab| self.slab_shape(slab, &displacement))
                .collect()
        } else {
            let u = self.lanes.pad(&displacement);
            let slabs = self.slabs.par_iter();
            slabs
                .map(|slab| {
                    let pencils = 0..slab.elements;
                    let shape =
                        |lane| self.pencil_shape(slab, lane, &self.layers, &self.around, &u);
                    pencils.flat_map(shape).collect()
                })
                .collect()
        };
        self.imperfect = Some(Arc::new(Imperfect {
            displacement,
            points,
        }));
        self
    }

    /// The stress-free shape as slab kernels read it, under displacements of the perfect tube.
    fn slab_shape(&self, slab: &Slab, displacement: &[f64]) -> Vec<StressFree> {
        let perfect = self.input(slab, (&[], None), displacement);
        match self.degree() {
            1 => slab_stress_free::<2>(&perfect),
            2 => slab_stress_free::<3>(&perfect),
            3 => slab_stress_free::<4>(&perfect),
            4 => slab_stress_free::<5>(&perfect),
            5 => slab_stress_free::<6>(&perfect),
            degree => unreachable!("degree {degree} is refused by SplineTube::new"),
        }
    }

    /// The stress-free shape of a slab as slab kernels read it, if it is not the perfect tube's.
    pub(super) fn shape_of_slab(&self, number: usize) -> Option<Cow<'_, [StressFree]>> {
        let imperfect = self.imperfect.as_ref()?;
        Some(if self.sector.rings < FEW_RINGS {
            Cow::Borrowed(&imperfect.points[number])
        } else {
            Cow::Owned(self.slab_shape(&self.slabs[number], &imperfect.displacement))
        })
    }

    /// u₀ of the stress-free shape X + u₀(X): control values numbered as unknowns are. None if the
    /// tube has no imperfection of its geometry.
    ///
    /// Waves are zero at fixed ends, and other ends, or modes, are held where u₀ puts them, so that a
    /// tube that is let go at rest finds its stress-free shape: there u = u₀ is free of stress.
    pub fn geometric_imperfection(&self) -> Option<&[f64]> {
        let imperfect = self.imperfect.as_ref();
        imperfect.map(|imperfect| &imperfect.displacement[..])
    }

    /// Whether the stress-free shape of a tube with these imperfections is one.
    ///
    /// # Errors
    /// [`Inverted`] where that is folded: det ∂(X + u₀)/∂X is not positive.
    pub fn can_have(&self, imperfections: &[Imperfection]) -> Result<(), Inverted> {
        let bases = [&self.axial, &self.wall];
        let Some(u) = geometry(&self.tube, imperfections, &self.sector, bases) else {
            return Ok(());
        };
        let perfect = Self {
            imperfect: None,
            ..self.clone()
        };
        perfect.forces(&self.tube.rest(), &u).map(drop)
    }

    /// Where to look for the tube at rest: nothing, or what imperfections displace, spread along
    /// the tube. The ends are held as they are at rest.
    pub fn start(&self) -> Vec<f64> {
        let mut u = match self.geometric_imperfection() {
            Some(u) => u.to_vec(),
            None => vec![0.0; self.unknowns()],
        };
        // What ends are displaced from there.
        let mut held = u.clone();
        self.apply_prescribed(&self.tube.rest(), &mut held);
        let (m, z) = (self.row_size(), self.axial.greville());
        let from_shape = |row: usize| -> Vec<f64> {
            let row = row * m..(row + 1) * m;
            held[row.clone()]
                .iter()
                .zip(&u[row])
                .map(|(h, u)| h - u)
                .collect()
        };
        let (first, last) = (from_shape(0), from_shape(z.len() - 1));
        for (row, z) in z.iter().enumerate() {
            let x = z / self.tube.length;
            for i in 0..m {
                u[row * m + i] += (1.0 - x) * first[i] + x * last[i];
            }
        }
        self.apply_prescribed(&self.tube.rest(), &mut u);
        u
    }
}

/// A mode as the splines of its own mesh draw it.
struct DrawnMode<'a> {
    mode: &'a Mode,
    bases: [Basis; 2],
    /// What the control values of a wave of n, |n − 1| and n + 1 turns are higher than the wave.
    heights: [f64; 3],
}

/// Where the displacement of a mode is looked at: so many points to an element along the tube, and
/// through the wall.
const LOOKED_AT: [usize; 2] = [8, 4];

impl<'a> DrawnMode<'a> {
    fn new(mode: &'a Mode, tube: &Tube) -> Self {
        let sector = Sector::new(mode.mesh.degree, mode.mesh.elements()[1], 1);
        Self {
            mode,
            bases: bases(tube, &mode.mesh),
            heights: heights(&sector, mode.harmonic),
        }
    }

    /// The same displacement, by control values for waves of other heights. (r cos nψ, −θ sin nψ) is
    /// ½ (r − θ) times a wave of n + 1 turns and ½ (r + θ) times one of n − 1, see above.
    fn with_heights(&self, [z, r, t]: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        let [axial, back, forth] = [0, 1, 2].map(|i| to[i] / self.heights[i]);
        if self.mode.harmonic == 0 {
            return [z, r * forth, t * forth];
        }
        let (forth, back) = (0.5 * (r - t) * forth, 0.5 * (r + t) * back);
        [z * axial, back + forth, back - forth]
    }

    /// The largest displacement of a point of the wall.
    fn largest(&self) -> f64 {
        let [axial, wall] = &self.bases;
        let points = wall.functions();
        let places = |basis: &Basis, count: usize| -> Vec<Values> {
            let last = basis.elements() * count;
            (0..=last)
                .map(|i| {
                    let element = (i / count).min(basis.elements() - 1);
                    let (from, to) = basis.element(element);
                    let x = (i - element * count) as f64 / count as f64;
                    basis.evaluate_in(element, from + (to - from) * x)
                })
                .collect()
        };
        let through = places(wall, LOOKED_AT[1]);
        let mut largest = 0.0_f64;
        for along in places(axial, LOOKED_AT[0]) {
            for through in &through {
                let mut u = [0.0; 3];
                for (a, n) in along.value.iter().enumerate() {
                    for (c, m) in through.value.iter().enumerate() {
                        let point = (along.element + a) * points + through.element + c;
                        for (u, x) in u.iter_mut().zip(&self.mode.values[3 * point..]) {
                            *u += n * m * x;
                        }
                    }
                }
                let [z, r, t] = self.with_heights(u, [1.0; 3]);
                // At a crest, or a quarter wave from it; of harmonic 0 all at once.
                let size = match self.mode.harmonic {
                    0 => (z * z + r * r + t * t).sqrt(),
                    _ => z.hypot(r).max(t.abs()),
                };
                largest = largest.max(size);
            }
        }
        largest
    }

    /// (z, r, θ) of the control points of a ring of another mesh.
    fn on(&self, [axial, wall]: [&Basis; 2], sector: &Sector) -> Vec<[f64; 3]> {
        let width = 3 * self.bases[1].functions();
        let rows = transfer(&self.bases[0], axial, &self.mode.values, width);
        let heights = heights(sector, self.mode.harmonic);
        let mut out = vec![];
        for row in rows.chunks_exact(width) {
            let points = transfer(&self.bases[1], wall, row, 3);
            let points = points.as_chunks::<3>().0.iter();
            out.extend(points.map(|&point| match heights == self.heights {
                true => point,
                false => self.with_heights(point, heights),
            }));
        }
        out
    }
}

/// c_n, c_|n − 1| and c_n+1 of [`Sector::control_wave`].
fn heights(sector: &Sector, n: usize) -> [f64; 3] {
    [n, n.abs_diff(1), n + 1].map(|m| sector.control_wave(m))
}

/// A wave of unit height as the splines draw it.
struct Drawn<'a> {
    wave: &'a Wave,
    sector: &'a Sector,
    /// Heights of the control values: radial, circumferential, and axial per control radius.
    heights: [f64; 3],
}

impl<'a> Drawn<'a> {
    fn new(wave: &'a Wave, sector: &'a Sector) -> Self {
        let c = |m| sector.control_wave(m);
        let heights = match wave.harmonic {
            0 => [c(1), 0.0, 1.0],
            n => {
                let forth = 0.5 * (1.0 - 1.0 / n as f64) * c(n + 1);
                let back = 0.5 * (1.0 + 1.0 / n as f64) * c(n - 1);
                // A control radius is c₁ times the radius.
                [forth + back, forth - back, c(n) / c(1)]
            }
        };
        Self {
            wave,
            sector,
            heights,
        }
    }

    /// sin nψ and cos nψ at a ring.
    fn turn(&self, ring: usize) -> (f64, f64) {
        let psi = self.sector.ring_angle(ring) - self.wave.phase;
        (self.wave.harmonic as f64 * psi).sin_cos()
    }

    /// Radial and circumferential control values.
    fn across(&self, ring: usize) -> [f64; 2] {
        let (sin, cos) = self.turn(ring);
        [self.heights[0] * cos, self.heights[1] * sin]
    }

    /// Axial control value, per control radius in D/2 unless n = 0.
    fn axial(&self, ring: usize) -> f64 {
        self.heights[2] * self.turn(ring).1
    }
}

/// The factor along the tube: that of the wave, and zero at fixed ends.
fn along(wave: &Wave, tube: &Tube, z: f64) -> f64 {
    let factor = wave.axial.value(z, [0.0, tube.length]);
    if wave.axial != Axial::Uniform {
        return factor; // zero at both ends as it is
    }
    let rise = RISE.min(0.25 * tube.length);
    let from_end = |end: usize, distance: f64| match tube.ends[end] {
        Support::Fixed if distance < rise => 0.5 * (1.0 - (PI * distance.max(0.0) / rise).cos()),
        _ => 1.0,
    };
    factor * from_end(0, z) * from_end(1, tube.length - z)
}
