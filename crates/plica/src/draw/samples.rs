//! The samples of a strip of a picture: which triangle lies before the others, and what light that makes of the pixels.

use super::light::Shader;
use super::raster::Scene;
use std::ops::Range;

/// What counts as on an edge, in samples.
const NEAR: f64 = 1e-6;
/// Samples that are covered at a time.
const LANES: usize = 8;
/// What counts as a step in depth, in samples over one sample.
const STEP: f32 = 12.0;
/// How bright an edge is beside what it bounds.
const DIM: f32 = 0.12;
/// Number for pixels that show several surfaces.
const SEVERAL: u16 = u16::MAX;

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

/// Twice the area of a triangle on the page, positive if its corners go around clockwise as the viewer sees it.
#[inline]
pub(super) fn double_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
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
    width: usize,
    /// Rows of the picture's samples.
    rows: Range<usize>,
    depth: Vec<f32>,
    /// Number of the triangle plus one, 0 for none.
    triangle: Vec<u32>,
    /// The pixels of a row, and of the next one.
    shown: [Vec<Shown>; 2],
}

/// What the samples of a pixel show: the number of the surface plus one, 0 for none, [`SEVERAL`] for more than one; and their
/// least and largest depth.
#[derive(Clone, Copy, Debug)]
struct Shown {
    surface: u16,
    low: f32,
    high: f32,
}

/// A quantity that changes evenly over a triangle: at its first corner, and what it grows by a sample to the right and down.
type Plane = [f32; 3];

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

    /// Adds the triangle of a number.
    #[inline(always)]
    pub fn triangle(&mut self, corners: [[f64; 3]; 3], number: u32) {
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
                    number + 1,
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
        number: u32,
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
                triangle[lane] = if before { number } else { triangle[lane] };
            }
            from += LANES as f32;
        }
    }

    /// Means over the samples of each pixel from a row of samples on, with a fine dark line where a surface ends or another
    /// begins. Where one surface fills a pixel, light changes little across it, and the sample in the middle does for all.
    #[inline(always)]
    pub fn resolve<const S: usize>(
        &mut self,
        pixels: &mut [[u8; 3]],
        from: usize,
        scene: &Scene,
        shader: &Shader,
    ) {
        let across = self.width / S;
        let [mut here, mut below] = std::mem::take(&mut self.shown);
        self.show::<S>(from, scene, &mut below);
        for (k, line) in pixels.chunks_mut(across.max(1)).enumerate() {
            let row = from + k * S;
            std::mem::swap(&mut here, &mut below);
            if row + S < self.rows.len() {
                self.show::<S>(row + S, scene, &mut below);
            }
            // At the foot of the picture nothing is below.
            let next = if row + S < self.rows.len() {
                &below
            } else {
                &here
            };
            let mut lit = Lit::new(scene, self.rows.start);
            for (pixel, out) in line.iter_mut().enumerate() {
                let column = pixel * S;
                let around = [here[pixel], here[(pixel + 1).min(across - 1)], next[pixel]];
                match self.filled::<S>(column, row, around, scene) {
                    Some(0) => {} // the paper is white
                    Some(_) => {
                        let (x, y) = (column + S / 2, row + S / 2);
                        let number = self.triangle[y * self.width + x];
                        *out = shader.pixel(lit.at(number, x, y, shader));
                    }
                    None => {
                        let mut sum = [0.0f32; 3];
                        for y in row..row + S {
                            for x in column..column + S {
                                let dim = if self.is_edge(x, y, S, scene) {
                                    DIM
                                } else {
                                    1.0
                                };
                                let number = self.triangle[y * self.width + x];
                                let light = lit.at(number, x, y, shader);
                                for (s, l) in sum.iter_mut().zip(light) {
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
        self.shown = [here, below];
    }

    /// Of which surface a sample is, plus one; 0 for none.
    #[inline]
    fn surface(&self, sample: usize, scene: &Scene) -> u16 {
        surface(self.triangle[sample], scene)
    }

    /// What each pixel of a row shows, which begins with a row of samples.
    #[inline(always)]
    fn show<const S: usize>(&self, row: usize, scene: &Scene, shown: &mut Vec<Shown>) {
        shown.clear();
        for pixel in 0..self.width / S {
            let first = row * self.width + pixel * S;
            let number = self.triangle[first];
            let (mut low, mut high) = (self.depth[first], self.depth[first]);
            let mut one = true;
            for y in 0..S {
                let line = first + y * self.width;
                for sample in line..line + S {
                    let depth = self.depth[sample];
                    low = if depth < low { depth } else { low };
                    high = if depth > high { depth } else { high };
                    one &= self.triangle[sample] == number;
                }
            }
            let own = surface(number, scene);
            let alike = one
                || (0..S).all(|y| {
                    let line = first + y * self.width;
                    let mut others = self.triangle[line..line + S].iter();
                    others.all(|&other| surface(other, scene) == own)
                });
            let surface = if alike { own } else { SEVERAL };
            shown.push(Shown { surface, low, high });
        }
    }

    /// The surface that all samples of a pixel show, 0 for none, if no edge runs through it; what it shows, and the pixels to its
    /// right and below, with which its samples are compared.
    #[inline(always)]
    fn filled<const S: usize>(
        &self,
        column: usize,
        row: usize,
        around: [Shown; 3],
        scene: &Scene,
    ) -> Option<u16> {
        let surface = around[0].surface;
        if surface == SEVERAL || around.iter().any(|pixel| pixel.surface != surface) {
            return None;
        }
        let [mut low, mut high] = [around[0].low, around[0].high];
        for pixel in &around[1..] {
            low = if pixel.low < low { pixel.low } else { low };
            high = if pixel.high > high { pixel.high } else { high };
        }
        let whole = surface == 0
            || high - low <= STEP * S as f32
            || (row..row + S).all(|y| (column..column + S).all(|x| !self.is_edge(x, y, S, scene)));
        whole.then_some(surface)
    }

    /// Whether another surface, nothing, or a step in depth begins `reach` samples to the right or below; rows are counted in
    /// the strip, which reaches as far beyond what is drawn of it.
    fn is_edge(&self, x: usize, y: usize, reach: usize, scene: &Scene) -> bool {
        let here = y * self.width + x;
        let surface = self.surface(here, scene);
        let differs = |there: usize, back: Option<usize>| {
            if surface != self.surface(there, scene) {
                return true;
            }
            // A fold before its own far side: a jump, not a slope that was as steep before.
            let rise = |i: usize| (self.depth[here] - self.depth[i]).abs();
            let jump = rise(there);
            let before = back.map_or(0.0, |i| {
                if self.surface(i, scene) == surface {
                    rise(i)
                } else {
                    0.0
                }
            });
            surface != 0 && jump > STEP * reach as f32 && jump > 6.0 * before
        };
        let (left, above) = (
            x.checked_sub(reach).map(|_| here - reach),
            y.checked_sub(reach),
        );
        let above = above.map(|_| here - reach * self.width);
        (x + reach < self.width && differs(here + reach, left))
            || (y + reach < self.rows.len() && differs(here + reach * self.width, above))
    }
}

/// Of which surface a triangle is by its number plus one; 0 for none.
#[inline]
fn surface(number: u32, scene: &Scene) -> u16 {
    match number.checked_sub(1) {
        Some(number) => scene.surface[number as usize],
        None => 0,
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

/// The light of triangles, each worked out once as long as samples stay on it.
struct Lit<'a> {
    scene: &'a Scene,
    /// First row of the strip.
    top: usize,
    number: u32,
    /// Where the first corner lies: close to it, differences have all digits.
    at: [f64; 2],
    shade: Plane,
    body: Plane,
    gloss: Plane,
}

impl<'a> Lit<'a> {
    fn new(scene: &'a Scene, top: usize) -> Self {
        let none = [0.0; 3];
        Self {
            scene,
            top,
            number: 0,
            at: [0.0; 2],
            shade: none,
            body: none,
            gloss: none,
        }
    }

    /// The light of a sample that shows a triangle, by its number plus one; rows are counted in the strip.
    #[inline(always)]
    fn at(&mut self, number: u32, x: usize, y: usize, shader: &Shader) -> [f32; 3] {
        if number == 0 {
            return [1.0; 3];
        }
        if number != self.number {
            self.turn_to(number);
        }
        let (x, y) = (
            (x as f64 + 0.5 - self.at[0]) as f32,
            ((y + self.top) as f64 + 0.5 - self.at[1]) as f32,
        );
        let on = |plane: &Plane| plane[0] + x * plane[1] + y * plane[2];
        shader.light(on(&self.shade), on(&self.body), on(&self.gloss))
    }

    #[inline(always)]
    fn turn_to(&mut self, number: u32) {
        self.number = number;
        let corners = self.scene.triangles[number as usize - 1];
        let corners = corners.map(|corner| &self.scene.corners[corner as usize]);
        let places = corners.map(|corner| corner.place);
        let double_area = double_area(places);
        let per_area = 1.0 / double_area;
        // Corners go around the normal; on the page, whose rows run down, that is against the clock where it points to the viewer.
        let side = usize::from(double_area > 0.0);
        let [a, b, c] = places;
        let [bx, by] = [b[0] - a[0], b[1] - a[1]];
        let [cx, cy] = [c[0] - a[0], c[1] - a[1]];
        let plane = |[at_a, at_b, at_c]: [f32; 3]| {
            let [to_b, to_c] = [f64::from(at_b - at_a), f64::from(at_c - at_a)];
            [
                at_a,
                ((to_b * cy - to_c * by) * per_area) as f32,
                ((to_c * bx - to_b * cx) * per_area) as f32,
            ]
        };
        self.at = [a[0], a[1]];
        self.shade = plane(corners.map(|corner| corner.shade));
        self.body = plane(corners.map(|corner| corner.lit[side][0]));
        self.gloss = plane(corners.map(|corner| corner.lit[side][1]));
    }
}
