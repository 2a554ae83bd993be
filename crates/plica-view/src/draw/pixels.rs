//! The pixels of a strip: the mean of what their samples show, and a fine dark line at edges.

use super::light::Shader;
use super::lit::Lit;
use super::samples::Samples;
use super::scene::Scene;

/// What counts as a step in depth, in samples over one sample.
const STEP: f32 = 12.0;
/// How bright an edge is beside what it bounds.
const DIM: f32 = 0.12;
/// Stands for several surfaces.
const SEVERAL: u32 = u32::MAX;

/// A row of pixels: the surface that each shows, 0 for none, [`SEVERAL`] for more than one; and its least and largest depth.
#[derive(Default)]
struct Row {
    surface: Vec<u32>,
    low: Vec<f32>,
    high: Vec<f32>,
}

/// What a pixel is made of.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Nothing.
    Paper,
    /// One surface, which goes on to the right and below.
    Filled,
    /// One that is steep, or has an edge.
    Steep,
    /// Several, or one that ends.
    Mixed,
}

/// Room for rows that are looked at.
#[derive(Default)]
pub(super) struct Pixels {
    here: Row,
    below: Row,
    /// The samples of a row, as one.
    one: Row,
    kinds: Vec<Kind>,
}

impl Pixels {
    /// Means over the samples of each pixel from a row of samples on, with a fine dark line where a surface ends or another
    /// begins. Where one surface fills a pixel, light changes little across it, and the sample in the middle does for all.
    #[inline(always)]
    pub fn resolve<const S: usize>(
        &mut self,
        samples: &Samples,
        pixels: &mut [[u8; 3]],
        from: usize,
        scene: &Scene,
        shader: &Shader,
    ) {
        let across = samples.width / S;
        let mut lit = Lit::new(scene, samples.rows.start);
        let is_edge = |x: usize, y: usize| is_edge(samples, x, y, S, scene);
        self.below.look::<S>(&mut self.one, samples, from, scene);
        for (k, line) in pixels.chunks_mut(across.max(1)).enumerate() {
            let row = from + k * S;
            std::mem::swap(&mut self.here, &mut self.below);
            // At the foot of the picture nothing is below.
            let next = if row + S < samples.rows.len() {
                self.below.look::<S>(&mut self.one, samples, row + S, scene);
                &self.below
            } else {
                &self.here
            };
            self.here.kinds::<S>(next, &mut self.kinds);
            for ((pixel, out), kind) in line.iter_mut().enumerate().zip(&self.kinds) {
                let column = pixel * S;
                let one = match kind {
                    Kind::Paper => continue, // it is white
                    Kind::Filled => true,
                    Kind::Steep => {
                        !(row..row + S).any(|y| (column..column + S).any(|x| is_edge(x, y)))
                    }
                    Kind::Mixed => false,
                };
                let mut light = |x: usize, y: usize| {
                    lit.at(samples.triangle[y * samples.width + x], x, y, shader)
                };
                if one {
                    *out = shader.pixel(light(column + S / 2, row + S / 2));
                    continue;
                }
                let mut sum = [0.0f32; 3];
                for y in row..row + S {
                    for x in column..column + S {
                        let dim = if is_edge(x, y) { DIM } else { 1.0 };
                        for (s, l) in sum.iter_mut().zip(light(x, y)) {
                            *s += l * dim;
                        }
                    }
                }
                let per_sample = 1.0 / (S * S) as f32;
                *out = shader.pixel(sum.map(|s| s * per_sample));
            }
        }
    }
}

impl Row {
    /// Looks at pixels from a row of samples on; `one` is room for a row of samples.
    #[inline(always)]
    fn look<const S: usize>(
        &mut self,
        one: &mut Row,
        samples: &Samples,
        row: usize,
        scene: &Scene,
    ) {
        let (width, across) = (samples.width, samples.width / S);
        let line = |y: usize| (row + y) * width..(row + y + 1) * width;
        one.resize(width);
        for (own, &name) in one.surface.iter_mut().zip(&samples.triangle[line(0)]) {
            *own = scene.surface(name);
        }
        one.low.copy_from_slice(&samples.depth[line(0)]);
        one.high.copy_from_slice(&samples.depth[line(0)]);
        for y in 1..S {
            for (own, &name) in one.surface.iter_mut().zip(&samples.triangle[line(y)]) {
                let differs = scene.surface(name) != *own;
                *own = if differs { SEVERAL } else { *own };
            }
            let ends = one.low.iter_mut().zip(&mut one.high);
            for ((low, high), &depth) in ends.zip(&samples.depth[line(y)]) {
                (*low, *high) = (less(depth, *low), more(depth, *high));
            }
        }
        self.resize(across);
        for (own, all) in self.surface.iter_mut().zip(one.surface.as_chunks::<S>().0) {
            let alike = (1..S).fold(true, |alike, x| alike & (all[x] == all[0]));
            *own = if alike { all[0] } else { SEVERAL };
        }
        for (low, all) in self.low.iter_mut().zip(one.low.as_chunks::<S>().0) {
            *low = (1..S).fold(all[0], |low, x| less(all[x], low));
        }
        for (high, all) in self.high.iter_mut().zip(one.high.as_chunks::<S>().0) {
            *high = (1..S).fold(all[0], |high, x| more(all[x], high));
        }
    }

    fn resize(&mut self, count: usize) {
        self.surface.resize(count, 0);
        self.low.resize(count, 0.0);
        self.high.resize(count, 0.0);
    }

    /// What its pixels are made of, with those to their right and below.
    #[inline(always)]
    fn kinds<const S: usize>(&self, below: &Row, kinds: &mut Vec<Kind>) {
        let steep = STEP * S as f32;
        let count = self.surface.len();
        kinds.resize(count, Kind::Paper);
        for (pixel, kind) in kinds.iter_mut().enumerate() {
            let right = (pixel + 1).min(count - 1);
            let surface = self.surface[pixel];
            let low = less(less(self.low[right], self.low[pixel]), below.low[pixel]);
            let high = more(more(self.high[right], self.high[pixel]), below.high[pixel]);
            let alike = (surface != SEVERAL)
                & (surface == self.surface[right])
                & (surface == below.surface[pixel]);
            *kind = if !alike {
                Kind::Mixed
            } else if surface == 0 {
                Kind::Paper
            } else if high - low <= steep {
                Kind::Filled
            } else {
                Kind::Steep
            };
        }
    }
}

/// The smaller of two numbers.
#[inline(always)]
fn less(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
#[inline(always)]
fn more(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Whether another surface, nothing, or a step in depth begins `reach` samples to the right or below; rows are counted in
/// the strip, which reaches as far beyond what is drawn of it.
fn is_edge(samples: &Samples, x: usize, y: usize, reach: usize, scene: &Scene) -> bool {
    let (width, depth) = (samples.width, &samples.depth);
    let surface_of = |sample: usize| scene.surface(samples.triangle[sample]);
    let here = y * width + x;
    let surface = surface_of(here);
    let differs = |there: usize, back: Option<usize>| {
        if surface != surface_of(there) {
            return true;
        }
        // A fold before its own far side: a jump, not a slope that was as steep before.
        let rise = |i: usize| (depth[here] - depth[i]).abs();
        let jump = rise(there);
        let before = back.filter(|&i| surface_of(i) == surface).map_or(0.0, rise);
        surface != 0 && jump > STEP * reach as f32 && jump > 6.0 * before
    };
    let (left, above) = (
        x.checked_sub(reach).map(|_| here - reach),
        y.checked_sub(reach).map(|_| here - reach * width),
    );
    (x + reach < width && differs(here + reach, left))
        || (y + reach < samples.rows.len() && differs(here + reach * width, above))
}
