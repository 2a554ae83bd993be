//! Depth buffer of a strip of a picture: the nearest triangle of every sample.

use super::scene::double_area;
use std::ops::Range;

/// Distance to an edge, in samples, below which a sample is on it.
const EDGE_TOLERANCE: f64 = 1e-6;
/// Samples processed at a time.
const LANES: usize = 8;

/// Rounds a number from 0 to 2³¹ to the nearest integer, ties to even. It is faster than a cast because it does not treat other numbers.
#[inline(always)]
fn round_fast(x: f64) -> usize {
    /// Numbers of this size have no fractional bits.
    const SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²
    (x + SHIFT).to_bits() as u32 as usize
}

/// Returns the larger of two numbers, or the second one if either is NaN.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the smaller of two numbers, or the second one if either is NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the index of the first sample whose centre lies at or beyond a position.
#[inline(always)]
fn first_sample(position: f64, count: usize) -> usize {
    round_fast(smaller(larger(position, 0.0), count as f64))
}

/// Returns the rows of samples that a triangle may cover; `None` if it has no area or is not finite.
pub(super) fn rows([a, b, c]: [[f64; 3]; 3], height: usize) -> Option<Range<usize>> {
    let double_area = double_area([a, b, c]);
    // Thinner triangles cover no sample.
    if double_area.abs() < 1e-9 || !double_area.is_finite() || !(a[2] + b[2] + c[2]).is_finite() {
        return None;
    }
    let (top, bottom) = (a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let (first, end) = (first_sample(top, height), first_sample(bottom, height));
    (first < end).then_some(first..end)
}

/// Depth and triangle of every sample of a strip. Colours are computed later, for visible samples only.
#[derive(Default)]
pub(super) struct DepthBuffer {
    /// Samples per row.
    pub width: usize,
    /// Rows of samples of the picture that the strip covers.
    pub rows: Range<usize>,
    /// Depth towards the viewer, row by row.
    pub depth: Vec<f32>,
    /// Identifier of the nearest triangle, 0 for none.
    pub triangle: Vec<u32>,
}

impl DepthBuffer {
    /// Clears the buffer for a strip.
    pub fn reset(&mut self, width: usize, rows: Range<usize>) {
        // The padding allows access in whole vectors.
        let count = width * rows.len() + LANES;
        (self.width, self.rows) = (width, rows);
        self.depth.clear();
        self.depth.resize(count, f32::NEG_INFINITY);
        self.triangle.clear();
        self.triangle.resize(count, 0);
    }

    /// Draws a triangle.
    #[inline(always)]
    pub fn draw(&mut self, corners: [[f64; 3]; 3], id: u32) {
        let Some(rows) = rows(corners, self.rows.end) else {
            return;
        };
        let rows = rows.start.max(self.rows.start)..rows.end;
        let [a, b, c] = corners;
        let per_area = 1.0 / double_area(corners);
        let [to_b, to_c] = [b, c].map(|corner| [0, 1, 2].map(|i| corner[i] - a[i]));
        let per_x = (to_b[2] * to_c[1] - to_c[2] * to_b[1]) * per_area;
        let per_y = (to_c[2] * to_b[0] - to_b[2] * to_c[0]) * per_area;
        let ends = |i: usize| (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i]));
        let ((left, right), (deepest, nearest)) = (ends(0), ends(2));
        let (left, right) = (larger(left, 0.0), smaller(right, self.width as f64));
        let [deepest, nearest] = [deepest, nearest].map(|depth| depth as f32);
        let [top, middle, bottom] = by_row(corners);
        let long = Side::new(top, bottom);
        // Rows above the middle corner end on the upper short side, the others on the lower one.
        let turn = first_sample(middle[1], rows.end).max(rows.start);
        let parts = [
            (rows.start..turn, Side::new(top, middle)),
            (turn..rows.end, Side::new(middle, bottom)),
        ];
        for (rows, short) in parts {
            for row in rows {
                let y = row as f64 + 0.5;
                let (one, other) = (long.at(y), short.at(y));
                // An almost horizontal side may extrapolate too far. A sample on a side belongs to both adjacent triangles,
                // whatever the rounding.
                let first = smaller(larger(smaller(one, other), left) - EDGE_TOLERANCE, right);
                let end = larger(smaller(larger(one, other), right) + EDGE_TOLERANCE, left);
                let first = round_fast(larger(first, 0.0));
                let end = round_fast(smaller(end, self.width as f64));
                if first >= end {
                    continue;
                }
                let start = (row - self.rows.start) * self.width + first;
                let depth = a[2] + (first as f64 + 0.5 - a[0]) * per_x + (y - a[1]) * per_y;
                self.cover(
                    start,
                    end - first,
                    [depth as f32, per_x as f32, deepest, nearest],
                    id,
                );
            }
        }
    }

    /// Draws a triangle on `count` samples of a row from `start`, where it is the nearest. The array holds the depth of the
    /// first sample, the increment per sample, and the smallest and largest depth.
    #[inline(always)]
    fn cover(
        &mut self,
        start: usize,
        count: usize,
        [first, per_x, deepest, nearest]: [f32; 4],
        id: u32,
    ) {
        let end = start + count.next_multiple_of(LANES);
        let depth = self.depth[start..end].as_chunks_mut::<LANES>().0;
        let triangle = self.triangle[start..end].as_chunks_mut::<LANES>().0;
        let count = count as f32;
        let mut from = 0.0f32;
        for (depth, triangle) in depth.iter_mut().zip(triangle) {
            for lane in 0..LANES {
                let i = from + lane as f32;
                // Rounding must not move the depth of a steep triangle beyond that of its corners.
                let own = first + i * per_x;
                let own = if own > deepest { own } else { deepest };
                let own = if own < nearest { own } else { nearest };
                let nearer = (own > depth[lane]) & (i < count);
                depth[lane] = if nearer { own } else { depth[lane] };
                triangle[lane] = if nearer { id } else { triangle[lane] };
            }
            from += LANES as f32;
        }
    }
}

/// A side of a triangle: its start, and its horizontal increment per row.
#[derive(Clone, Copy)]
struct Side {
    from: [f64; 2],
    per_row: f64,
}

impl Side {
    #[inline(always)]
    fn new(from: [f64; 3], to: [f64; 3]) -> Self {
        Self {
            from: [from[0], from[1]],
            per_row: (to[0] - from[0]) / (to[1] - from[1]),
        }
    }

    /// Returns the horizontal position at a height.
    #[inline(always)]
    fn at(&self, y: f64) -> f64 {
        self.from[0] + (y - self.from[1]) * self.per_row
    }
}

/// Sorts corners from top to bottom.
#[inline(always)]
fn by_row([mut a, mut b, mut c]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    if b[1] < a[1] {
        (a, b) = (b, a);
    }
    if c[1] < b[1] {
        (b, c) = (c, b);
    }
    if b[1] < a[1] {
        (a, b) = (b, a);
    }
    [a, b, c]
}
