//! The samples of a strip of a picture: which triangle lies before the others.

use super::scene::double_area;
use std::ops::Range;

/// What counts as on an edge, in samples.
const NEAR: f64 = 1e-6;
/// Samples that are covered at a time.
const LANES: usize = 8;

/// The nearest whole number to one from 0 to 2³¹, the even one of two: without the care of `as` for all others.
#[inline(always)]
fn nearest_whole(x: f64) -> usize {
    /// Beyond it, numbers are whole.
    const WHOLE: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²
    (x + WHOLE).to_bits() as u32 as usize
}

/// The larger of two numbers, and the second if one is none.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller of two numbers, and the second if one is none.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Before which of so many samples a place lies: they sit in the middle of their squares.
#[inline(always)]
fn whole(place: f64, count: usize) -> usize {
    nearest_whole(smaller(larger(place, 0.0), count as f64))
}

/// The rows of samples that a triangle may cover in a picture so high; none if it has no area, or no place.
pub(super) fn rows([a, b, c]: [[f64; 3]; 3], height: usize) -> Option<Range<usize>> {
    let double_area = double_area([a, b, c]);
    // What is thinner than that shows nowhere.
    if double_area.abs() < 1e-9 || !double_area.is_finite() || !(a[2] + b[2] + c[2]).is_finite() {
        return None;
    }
    let (top, bottom) = (a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let (first, end) = (whole(top, height), whole(bottom, height));
    (first < end).then_some(first..end)
}

/// What the samples of a strip hold. What is hidden gets no colour.
#[derive(Default)]
pub(super) struct Samples {
    /// How many lie side by side.
    pub width: usize,
    /// Rows of the picture's samples.
    pub rows: Range<usize>,
    /// Towards the viewer, row by row.
    pub depth: Vec<f32>,
    /// Name of the triangle, 0 for none.
    pub triangle: Vec<u32>,
}

impl Samples {
    /// Empties it for a strip.
    pub fn begin(&mut self, width: usize, rows: Range<usize>) {
        // What is covered is looked at in whole vectors.
        let count = width * rows.len() + LANES;
        (self.width, self.rows) = (width, rows);
        self.depth.clear();
        self.depth.resize(count, f32::NEG_INFINITY);
        self.triangle.clear();
        self.triangle.resize(count, 0);
    }

    /// Adds the triangle of a name.
    #[inline(always)]
    pub fn triangle(&mut self, corners: [[f64; 3]; 3], name: u32) {
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
        let long = Side::of(top, bottom);
        // The rows that end on the upper of the two short sides, and those on the lower.
        let turn = whole(middle[1], rows.end).max(rows.start);
        let parts = [
            (rows.start..turn, Side::of(top, middle)),
            (turn..rows.end, Side::of(middle, bottom)),
        ];
        for (rows, short) in parts {
            for row in rows {
                let y = row as f64 + 0.5;
                let (one, other) = (long.at(y), short.at(y));
                // A side that lies almost level may lead anywhere; a sample on a side belongs to both of its triangles,
                // whatever the rounding.
                let first = smaller(larger(smaller(one, other), left) - NEAR, right);
                let end = larger(smaller(larger(one, other), right) + NEAR, left);
                let first = nearest_whole(larger(first, 0.0));
                let end = nearest_whole(smaller(end, self.width as f64));
                if first >= end {
                    continue;
                }
                let start = (row - self.rows.start) * self.width + first;
                let depth = a[2] + (first as f64 + 0.5 - a[0]) * per_x + (y - a[1]) * per_y;
                self.cover(
                    start,
                    end - first,
                    [depth as f32, per_x as f32, deepest, nearest],
                    name,
                );
            }
        }
    }

    /// Puts a triangle before what is deeper, from a sample on for so many in its row: depth of the first, what it grows by from
    /// one to the next, and its least and largest.
    #[inline(always)]
    fn cover(
        &mut self,
        start: usize,
        count: usize,
        [first, per_x, deepest, nearest]: [f32; 4],
        name: u32,
    ) {
        let end = start + count.next_multiple_of(LANES);
        let depth = self.depth[start..end].as_chunks_mut::<LANES>().0;
        let triangle = self.triangle[start..end].as_chunks_mut::<LANES>().0;
        let count = count as f32;
        let mut from = 0.0f32;
        for (depth, triangle) in depth.iter_mut().zip(triangle) {
            for lane in 0..LANES {
                let i = from + lane as f32;
                // A triangle seen from its edge is steep: rounding must not take it out of itself.
                let own = first + i * per_x;
                let own = if own > deepest { own } else { deepest };
                let own = if own < nearest { own } else { nearest };
                let before = (own > depth[lane]) & (i < count);
                depth[lane] = if before { own } else { depth[lane] };
                triangle[lane] = if before { name } else { triangle[lane] };
            }
            from += LANES as f32;
        }
    }
}

/// A side of a triangle: where it begins, and how far it goes across from row to row.
#[derive(Clone, Copy)]
struct Side {
    from: [f64; 2],
    per_row: f64,
}

impl Side {
    #[inline(always)]
    fn of(from: [f64; 3], to: [f64; 3]) -> Self {
        Self {
            from: [from[0], from[1]],
            per_row: (to[0] - from[0]) / (to[1] - from[1]),
        }
    }

    /// How far across it is at a height.
    #[inline(always)]
    fn at(&self, y: f64) -> f64 {
        self.from[0] + (y - self.from[1]) * self.per_row
    }
}

/// Corners from the top.
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
