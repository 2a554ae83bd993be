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

use super::SplineTube;
use crate::rings::Sector;
use crate::tube::{Axial, End, Imperfection, Part, Push, Support, Tube, Wave};
use std::f64::consts::PI;

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

impl SplineTube {
    /// u₀ of the stress-free shape X + u₀(X): control values numbered as unknowns are. None if the
    /// tube has no imperfection of its geometry.
    ///
    /// u₀ is zero at fixed ends, so that a tube that is let go at rest finds its stress-free shape:
    /// there u = u₀ is free of stress.
    pub fn geometric_imperfection(&self) -> Option<Vec<f64>> {
        let geometric = |imperfection: &&Imperfection| imperfection.of == Part::Geometry;
        let imperfections = self.tube.imperfections.iter().filter(geometric);
        let (k, m, z) = (self.sector.rings, self.row_size(), self.axial.greville());
        let mut u: Option<Vec<f64>> = None;
        for imperfection in imperfections {
            let u = u.get_or_insert_with(|| vec![0.0; self.unknowns()]);
            for wave in imperfection.shape.waves() {
                let drawn = Drawn::new(wave, &self.sector);
                for (row, &z) in u.chunks_exact_mut(m).zip(&z) {
                    let size = imperfection.amplitude * wave.share * along(wave, &self.tube, z);
                    for ring in 0..k {
                        let [radial, around] = drawn.across(ring);
                        for point in row.chunks_exact_mut(3 * k) {
                            point[k + ring] += size * radial;
                            point[2 * k + ring] += size * around;
                        }
                    }
                }
            }
        }
        u
    }

    /// Where to look for the tube at rest: nothing, or what imperfections displace, spread along
    /// the tube. The ends are held as they are at rest.
    pub fn start(&self) -> Vec<f64> {
        let mut u = self
            .geometric_imperfection()
            .unwrap_or_else(|| vec![0.0; self.unknowns()]);
        let mut held = vec![0.0; self.unknowns()];
        self.impose(&self.tube.rest(), &mut held);
        let (m, z) = (self.row_size(), self.axial.greville());
        let (first, last) = (&held[..m], &held[held.len() - m..]);
        for (row, z) in z.iter().enumerate() {
            let x = z / self.tube.length;
            for i in 0..m {
                u[row * m + i] += (1.0 - x) * first[i] + x * last[i];
            }
        }
        u
    }
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
