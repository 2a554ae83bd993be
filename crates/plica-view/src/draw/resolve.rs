//! Conversion of samples to pixels: the mean light of the samples, and dark lines along edges.

use super::depth_buffer::DepthBuffer;
use super::interpolate::Interpolator;
use super::light::Shader;
use super::scene::Scene;

/// Slope of the depth, in samples per sample, above which an edge is drawn.
const EDGE_SLOPE: f32 = 12.0;
/// Brightness of an edge relative to the surface.
const EDGE_BRIGHTNESS: f32 = 0.12;
/// Marks a pixel that shows several surfaces.
const SEVERAL: u32 = u32::MAX;

/// A row of pixels: the surface of each, 0 for none, [`SEVERAL`] for more than one; and its smallest and largest depth.
#[derive(Default)]
struct Row {
    surface: Vec<u32>,
    low: Vec<f32>,
    high: Vec<f32>,
}

/// Content of a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// No surface.
    Paper,
    /// One surface, which continues to the right and below.
    Filled,
    /// One surface that is steep or has an edge.
    Steep,
    /// Several surfaces, or one that ends here.
    Mixed,
}

/// Buffers for the rows being processed.
#[derive(Default)]
pub(super) struct Resolver {
    here: Row,
    below: Row,
    /// A row of samples.
    samples: Row,
    kinds: Vec<Kind>,
}

impl Resolver {
    /// Computes rows of pixels from the row of samples `from` on: the mean light of their S by S samples, with a dark line
    /// where a surface ends or another begins. A pixel filled by one surface takes the light of its middle sample.
    #[inline(always)]
    pub fn resolve<const S: usize>(
        &mut self,
        buffer: &DepthBuffer,
        pixels: &mut [[u8; 3]],
        from: usize,
        scene: &Scene,
        shader: &Shader,
    ) {
        let across = buffer.width / S;
        let mut light_at = Interpolator::new(scene, buffer.rows.start);
        let is_edge = |x: usize, y: usize| is_edge(buffer, x, y, S, scene);
        self.below.load::<S>(&mut self.samples, buffer, from, scene);
        for (k, line) in pixels.chunks_mut(across.max(1)).enumerate() {
            let row = from + k * S;
            std::mem::swap(&mut self.here, &mut self.below);
            // The last row of the picture has no row below.
            let next = if row + S < buffer.rows.len() {
                self.below
                    .load::<S>(&mut self.samples, buffer, row + S, scene);
                &self.below
            } else {
                &self.here
            };
            self.here.kinds::<S>(next, &mut self.kinds);
            for ((pixel, out), kind) in line.iter_mut().enumerate().zip(&self.kinds) {
                let column = pixel * S;
                let is_uniform = match kind {
                    Kind::Paper => continue, // already white
                    Kind::Filled => true,
                    Kind::Steep => {
                        !(row..row + S).any(|y| (column..column + S).any(|x| is_edge(x, y)))
                    }
                    Kind::Mixed => false,
                };
                let mut light = |x: usize, y: usize| {
                    light_at.sample(buffer.triangle[y * buffer.width + x], x, y, shader)
                };
                if is_uniform {
                    *out = shader.pixel(light(column + S / 2, row + S / 2));
                    continue;
                }
                let mut sum = [0.0f32; 3];
                for y in row..row + S {
                    for x in column..column + S {
                        let brightness = if is_edge(x, y) { EDGE_BRIGHTNESS } else { 1.0 };
                        for (s, l) in sum.iter_mut().zip(light(x, y)) {
                            *s += l * brightness;
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
    /// Reads the pixels whose first row of samples is `row`; `one` is a buffer for a row of samples.
    #[inline(always)]
    fn load<const S: usize>(
        &mut self,
        one: &mut Row,
        buffer: &DepthBuffer,
        row: usize,
        scene: &Scene,
    ) {
        let (width, across) = (buffer.width, buffer.width / S);
        let line = |y: usize| (row + y) * width..(row + y + 1) * width;
        one.resize(width);
        for (own, &id) in one.surface.iter_mut().zip(&buffer.triangle[line(0)]) {
            *own = scene.surface(id);
        }
        one.low.copy_from_slice(&buffer.depth[line(0)]);
        one.high.copy_from_slice(&buffer.depth[line(0)]);
        for y in 1..S {
            for (own, &id) in one.surface.iter_mut().zip(&buffer.triangle[line(y)]) {
                let differs = scene.surface(id) != *own;
                *own = if differs { SEVERAL } else { *own };
            }
            let ends = one.low.iter_mut().zip(&mut one.high);
            for ((low, high), &depth) in ends.zip(&buffer.depth[line(y)]) {
                (*low, *high) = (smaller(depth, *low), larger(depth, *high));
            }
        }
        self.resize(across);
        for (own, all) in self.surface.iter_mut().zip(one.surface.as_chunks::<S>().0) {
            let uniform = (1..S).fold(true, |uniform, x| uniform & (all[x] == all[0]));
            *own = if uniform { all[0] } else { SEVERAL };
        }
        for (low, all) in self.low.iter_mut().zip(one.low.as_chunks::<S>().0) {
            *low = (1..S).fold(all[0], |low, x| smaller(all[x], low));
        }
        for (high, all) in self.high.iter_mut().zip(one.high.as_chunks::<S>().0) {
            *high = (1..S).fold(all[0], |high, x| larger(all[x], high));
        }
    }

    fn resize(&mut self, count: usize) {
        self.surface.resize(count, 0);
        self.low.resize(count, 0.0);
        self.high.resize(count, 0.0);
    }

    /// Classifies the pixels by comparison with those to their right and below.
    #[inline(always)]
    fn kinds<const S: usize>(&self, below: &Row, kinds: &mut Vec<Kind>) {
        let steep = EDGE_SLOPE * S as f32;
        let count = self.surface.len();
        kinds.resize(count, Kind::Paper);
        for (pixel, kind) in kinds.iter_mut().enumerate() {
            let right = (pixel + 1).min(count - 1);
            let surface = self.surface[pixel];
            let low = smaller(smaller(self.low[right], self.low[pixel]), below.low[pixel]);
            let high = larger(
                larger(self.high[right], self.high[pixel]),
                below.high[pixel],
            );
            let uniform = (surface != SEVERAL)
                & (surface == self.surface[right])
                & (surface == below.surface[pixel]);
            *kind = if !uniform {
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

/// Returns the smaller of two numbers.
#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Returns the larger of two numbers.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Returns true if another surface, the paper, or a jump in depth begins `reach` samples to the right or below. Rows are
/// counted within the strip, which extends by `reach` beyond the pixels drawn.
fn is_edge(buffer: &DepthBuffer, x: usize, y: usize, reach: usize, scene: &Scene) -> bool {
    let (width, depth) = (buffer.width, &buffer.depth);
    let surface_of = |sample: usize| scene.surface(buffer.triangle[sample]);
    let here = y * width + x;
    let surface = surface_of(here);
    let differs = |there: usize, back: Option<usize>| {
        if surface != surface_of(there) {
            return true;
        }
        // A jump in depth, as opposed to a slope that is equally steep before: a fold in front of its own far side.
        let rise = |i: usize| (depth[here] - depth[i]).abs();
        let jump = rise(there);
        let before = back.filter(|&i| surface_of(i) == surface).map_or(0.0, rise);
        surface != 0 && jump > EDGE_SLOPE * reach as f32 && jump > 6.0 * before
    };
    let (left, above) = (
        x.checked_sub(reach).map(|_| here - reach),
        y.checked_sub(reach).map(|_| here - reach * width),
    );
    (x + reach < width && differs(here + reach, left))
        || (y + reach < buffer.rows.len() && differs(here + reach * width, above))
}
