//! Imperfections as control values: displaced faces of the ends, and the stress-free shape of the
//! wall.
//!
//! A wave of harmonic n, ψ = φ − φ₀, displaces a cross-section by
//!
//! - radially a cos nψ, circumferentially −(a/n) sin nψ, so that rings keep their length (n = 0:
//!   radially a); n = 1 is a sideways shift;
//! - or axially a (2R/D) cos nψ (n = 0: a); n = 1 is a tilt.
//!
//! In the plane of the cross-section, as complex numbers, the first is
//!
//! a exp(iφ) (cos nψ − (i/n) sin nψ) = a exp(iφ) (½ (1 − 1/n) exp(inψ) + ½ (1 + 1/n) exp(−inψ)),
//!
//! two waves of n + 1 and n − 1 periods. The control values of each are scaled so that the spline
//! is its best approximation by least squares: c_m of [`Sector::control_wave`].

use super::tables::bases;
use crate::rings::Sector;
use crate::spline::{Basis, Values, interpolate, transfer};
use crate::tube::{Axial, End, EndDirection, Imperfection, Mode, Part, Shape, Support, Tube, Wave};
use std::f64::consts::PI;

/// Distance from a fixed end, in D, over which a geometric imperfection that is uniform along the
/// tube rises from zero.
const RISE: f64 = 0.5;

/// Returns the (axial, radial, circumferential) displacement of an end's control points by its
/// imperfections, at the control radii `r`; ring `j` of point `c` is at `c * k + j`.
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
            let shape = WaveShape::new(wave, sector);
            for ring in 0..k {
                let ([radial, around], axial) = (shape.across(ring), shape.axial(ring));
                for (c, &r) in r.iter().enumerate() {
                    let point = &mut face[c * k + ring];
                    match push {
                        EndDirection::Across => {
                            point[1] += size * radial;
                            point[2] += size * around;
                        }
                        EndDirection::Axial if wave.harmonic == 0 => point[0] += size,
                        EndDirection::Axial => point[0] += size * axial * (r / Tube::OUTER_RADIUS),
                    }
                }
            }
        }
    }
    face
}

/// Returns u₀ of the stress-free shape X + u₀(X) of a tube with imperfections: control values
/// numbered like the unknowns. None without imperfections of the geometry. `bases` are those along
/// the tube and through the wall.
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
            let shape = WaveShape::new(wave, sector);
            let factors = axial
                .greville()
                .iter()
                .map(|&z| along(wave, tube, z))
                .collect();
            let rows = u.chunks_exact_mut(points * 3 * k);
            for (row, factor) in rows.zip(interpolate(axial, factors, 1)) {
                let size = imperfection.amplitude * wave.share * factor;
                for ring in 0..k {
                    let [radial, around] = shape.across(ring);
                    for point in row.chunks_exact_mut(3 * k) {
                        point[k + ring] += size * radial;
                        point[2 * k + ring] += size * around;
                    }
                }
            }
        }
        if let Shape::Outline(outline) = &imperfection.shape {
            // Control values that are those of the shape at the Greville abscissae reproduce a linear shape, and round a
            // corner over p elements without overshooting.
            let height = imperfection.amplitude * sector.control_wave(1);
            let rows = u.chunks_exact_mut(points * 3 * k);
            for (row, z) in rows.zip(axial.greville()) {
                for (point, radius) in row.chunks_exact_mut(3 * k).zip(wall.greville()) {
                    let size = [tube.length, tube.thickness];
                    let [along, outwards] = outline.displacement(z, radius, size);
                    for ring in 0..k {
                        point[ring] += imperfection.amplitude * along;
                        point[k + ring] += height * outwards;
                    }
                }
            }
        }
        if let Shape::Mode(mode) = &imperfection.shape {
            let shape = ModeShape::new(mode, tube);
            let size = imperfection.amplitude / shape.largest_displacement();
            for (point, values) in u.chunks_exact_mut(3 * k).zip(shape.on_mesh(bases, sector)) {
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

/// A buckling mode, represented by the splines of its own mesh.
struct ModeShape<'a> {
    mode: &'a Mode,
    bases: [Basis; 2],
    /// Ratios of control value to wave for n, |n − 1| and n + 1 periods.
    heights: [f64; 3],
}

/// Sampling points per element, along the tube and through the wall, for the largest displacement
/// of a mode.
const SAMPLES: [usize; 2] = [8, 4];

impl<'a> ModeShape<'a> {
    fn new(mode: &'a Mode, tube: &Tube) -> Self {
        let sector = Sector::new(mode.mesh.degree, mode.mesh.elements()[1], 1);
        Self {
            mode,
            bases: bases(tube, &mode.mesh),
            heights: heights(&sector, mode.harmonic),
        }
    }

    /// Converts control values to other ratios of control value to wave. (r cos nψ, −θ sin nψ) is ½
    /// (r − θ) times a wave of n + 1 periods and ½ (r + θ) times one of n − 1, see above.
    fn with_heights(&self, [z, r, t]: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        let [axial, back, forth] = [0, 1, 2].map(|i| to[i] / self.heights[i]);
        if self.mode.harmonic == 0 {
            return [z, r * forth, t * forth];
        }
        let (forth, back) = (0.5 * (r - t) * forth, 0.5 * (r + t) * back);
        [z * axial, back + forth, back - forth]
    }

    /// Returns the largest displacement of a point of the wall.
    fn largest_displacement(&self) -> f64 {
        let [axial, wall] = &self.bases;
        let points = wall.functions();
        let sampled = |basis: &Basis, count: usize| -> Vec<Values> {
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
        let through = sampled(wall, SAMPLES[1]);
        let mut largest = 0.0_f64;
        for along in sampled(axial, SAMPLES[0]) {
            for through in &through {
                let mut u = [0.0; 3];
                for (a, n) in along.value.iter().enumerate() {
                    for (c, m) in through.value.iter().enumerate() {
                        let point = (along.first + a) * points + through.first + c;
                        for (u, x) in u.iter_mut().zip(&self.mode.values[3 * point..]) {
                            *u += n * m * x;
                        }
                    }
                }
                let [z, r, t] = self.with_heights(u, [1.0; 3]);
                // At a crest, or a quarter wave from it; for harmonic 0 all components together.
                let size = match self.mode.harmonic {
                    0 => (z * z + r * r + t * t).sqrt(),
                    _ => z.hypot(r).max(t.abs()),
                };
                largest = largest.max(size);
            }
        }
        largest
    }

    /// Returns (z, r, θ) of the control points of a ring of another mesh.
    fn on_mesh(&self, [axial, wall]: [&Basis; 2], sector: &Sector) -> Vec<[f64; 3]> {
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

/// Returns c_n, c_|n − 1| and c_n+1 of [`Sector::control_wave`].
fn heights(sector: &Sector, n: usize) -> [f64; 3] {
    [n, n.abs_diff(1), n + 1].map(|m| sector.control_wave(m))
}

/// A wave of unit height, represented by splines.
struct WaveShape<'a> {
    wave: &'a Wave,
    sector: &'a Sector,
    /// Amplitudes of the control values: radial, circumferential, and axial per control radius.
    heights: [f64; 3],
}

impl<'a> WaveShape<'a> {
    fn new(wave: &'a Wave, sector: &'a Sector) -> Self {
        let c = |m| sector.control_wave(m);
        let heights = match wave.harmonic {
            0 => [c(1), 0.0, 1.0],
            n => {
                let forth = 0.5 * (1.0 - 1.0 / n as f64) * c(n + 1);
                let back = 0.5 * (1.0 + 1.0 / n as f64) * c(n - 1);
                // The control radius is c₁ times the radius.
                [forth + back, forth - back, c(n) / c(1)]
            }
        };
        Self {
            wave,
            sector,
            heights,
        }
    }

    /// Returns sin nψ and cos nψ at a ring.
    fn sin_cos(&self, ring: usize) -> (f64, f64) {
        let psi = self.sector.ring_angle(ring) - self.wave.phase;
        (self.wave.harmonic as f64 * psi).sin_cos()
    }

    /// Returns radial and circumferential control values.
    fn across(&self, ring: usize) -> [f64; 2] {
        let (sin, cos) = self.sin_cos(ring);
        [self.heights[0] * cos, self.heights[1] * sin]
    }

    /// Returns the axial control value, per control radius in D/2 unless n = 0.
    fn axial(&self, ring: usize) -> f64 {
        self.heights[2] * self.sin_cos(ring).1
    }
}

/// Returns the factor along the tube: that of the wave, zero at fixed ends.
fn along(wave: &Wave, tube: &Tube, z: f64) -> f64 {
    let factor = wave.axial.value(z, [0.0, tube.length]);
    if wave.axial != Axial::Uniform {
        return factor; // zero at both ends already
    }
    let rise = RISE.min(0.25 * tube.length);
    let from_end = |end: usize, distance: f64| match tube.ends[end] {
        Support::Fixed if distance < rise => 0.5 * (1.0 - (PI * distance.max(0.0) / rise).cos()),
        _ => 1.0,
    };
    factor * from_end(0, z) * from_end(1, tube.length - z)
}
