//! Shaded surfaces: a z-buffer with smooth normals and a light.
//!
//! Parallel projection, so that lengths compare across the picture. A light from above the viewer's left shoulder falls
//! on both sides of a surface; light, not sRGB bytes, is averaged over the samples of a pixel.

use super::colour::Map;
use super::light::{Shader, cross, dot, minus, unit};
use super::{DrawError, Image};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of pixels that are drawn at a time.
const STRIP: usize = 16;
/// What counts as on an edge, in samples.
const NEAR: f64 = 1e-6;
/// What counts as a step in depth, in samples over one sample.
const STEP: f32 = 12.0;

/// A structured grid of quadrilaterals that carries a field.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Points along a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// `rows * columns` points, row after row, in units of D; a quadrilateral with a point that is
    /// not finite is left out.
    pub points: Vec<[f64; 3]>,
    /// The field at the points; NaN is drawn grey.
    pub values: Vec<f64>,
}

impl Surface {
    /// Whether the lists fill the grid.
    ///
    /// # Errors
    /// [`DrawError::Grid`] if they do not.
    pub fn check(&self) -> Result<(), DrawError> {
        let Surface { columns, rows, .. } = *self;
        let (points, values) = (self.points.len(), self.values.len());
        let wanted = columns.checked_mul(rows);
        if wanted == Some(points) && wanted == Some(values) {
            return Ok(());
        }
        // A product past usize fits no list: report it as the grid it is, without overflowing the message.
        let (columns, rows) = if wanted.is_some() {
            (columns, rows)
        } else {
            (0, 0)
        };
        Err(DrawError::Grid {
            columns,
            rows,
            points,
            values,
        })
    }

    /// Unit normals at the points from differences along the grid; zero where the grid is degenerate.
    fn normals(&self) -> Vec<[f64; 3]> {
        let (m, n) = (self.columns, self.rows);
        let at = |row: usize, column: usize| self.points[row * m + column];
        let mut normals = Vec::with_capacity(self.points.len());
        for row in 0..n {
            for column in 0..m {
                let along = minus(
                    at(row, (column + 1).min(m - 1)),
                    at(row, column.saturating_sub(1)),
                );
                let across = minus(
                    at((row + 1).min(n - 1), column),
                    at(row.saturating_sub(1), column),
                );
                normals.push(unit(cross(along, across)));
            }
        }
        normals
    }
}

/// A parallel view: unit axes of the page in space, and where the page lies on it.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Direction in space that runs to the right on the page.
    pub right: [f64; 3],
    /// Direction that runs up the page.
    pub up: [f64; 3],
    /// Direction towards the viewer.
    pub toward: [f64; 3],
    /// Page coordinates, in units of D, of the picture's top left corner.
    pub corner: (f64, f64),
    /// Pixels per unit of D.
    pub scale: f64,
    /// Width and height of the picture in pixels.
    pub size: (usize, usize),
}

impl View {
    /// The axes (right, up, toward) for a viewer in direction `toward`; the tube's axis z stays level on the page.
    #[must_use]
    pub fn axes(toward: [f64; 3]) -> [[f64; 3]; 3] {
        let toward = unit(toward);
        let right = unit(minus([0.0, 0.0, 1.0], toward.map(|c| c * toward[2])));
        [right, cross(toward, right), toward]
    }
}

/// Draws surfaces on white; `range` spans the colour `map`.
///
/// A pixel is the mean of `samples` by `samples` samples, 4 by 4 at most. The picture is drawn in strips, for which threads
/// take turns: a strip's samples fit a cache, and what a strip shows depends on nothing but the surfaces.
///
/// # Errors
/// [`DrawError::Grid`] for a surface whose lists do not fill its grid, [`DrawError::Size`] for an absurd picture.
pub fn render(
    surfaces: &[Surface],
    view: &View,
    range: (f64, f64),
    map: Map,
    samples: usize,
) -> Result<Image, DrawError> {
    let mut image = Image::white(view.size.0 as f64, view.size.1 as f64)?;
    let samples = samples.clamp(1, 4);
    let scene = Scene::of(surfaces, view, samples)?;
    let size = (image.width * samples, image.height * samples);
    let (width, height) = (image.width, STRIP * samples);
    // Of every strip its triangles, those just above and below it too: edges look there.
    let mut strips: Vec<Vec<u32>> = vec![vec![]; image.height.div_ceil(STRIP)];
    for (number, corners) in scene.triangles.iter().enumerate() {
        let Some(rows) = rows(scene.places(*corners), size.1) else {
            continue;
        };
        let first = rows.start.saturating_sub(samples) / height;
        let last = ((rows.end - 1 + samples) / height).min(strips.len() - 1);
        for strip in &mut strips[first..=last] {
            strip.push(number as u32);
        }
    }
    let shader = Shader::new(range, map);
    let pixels = image.pixels.par_chunks_mut(STRIP * width);
    let strips = pixels.zip(strips).enumerate();
    strips.for_each_init(Samples::default, |buffer, (k, (pixels, own))| {
        let top = (k * height).saturating_sub(samples);
        let bottom = ((k + 1) * height + samples).min(size.1);
        buffer.begin(size.0, top..bottom);
        for number in own {
            let corners = scene.triangles[number as usize];
            buffer.triangle(
                scene.places(corners),
                number,
                scene.surface[number as usize],
            );
        }
        buffer.resolve(pixels, k * height, samples, &scene, &shader);
    });
    Ok(image)
}

/// All triangles by their corners.
#[derive(Default)]
struct Scene {
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
    /// Of every triangle, the number of its surface plus one.
    surface: Vec<u16>,
}

/// A corner of a triangle: page place in samples, depth towards the viewer, normal in page axes, field.
#[derive(Clone, Copy)]
struct Corner {
    place: [f64; 3],
    normal: [f64; 3],
    value: f64,
}

impl Scene {
    fn of(surfaces: &[Surface], view: &View, samples: usize) -> Result<Self, DrawError> {
        let mut scene = Self::default();
        let scale = view.scale * samples as f64;
        for (number, surface) in surfaces.iter().enumerate() {
            surface.check()?;
            if surface.columns < 2 || surface.rows < 2 {
                continue;
            }
            let id = (number % usize::from(u16::MAX)) as u16 + 1;
            let first = scene.corners.len();
            let points = surface.points.iter().zip(surface.normals());
            let corners = points.zip(&surface.values).map(|((&p, n), &value)| {
                let across = (dot(p, view.right) - view.corner.0) * scale;
                let down = (view.corner.1 - dot(p, view.up)) * scale;
                Corner {
                    place: [across, down, dot(p, view.toward) * scale],
                    normal: [dot(n, view.right), dot(n, view.up), dot(n, view.toward)],
                    value,
                }
            });
            scene.corners.extend(corners);
            for row in 0..surface.rows - 1 {
                for column in 0..surface.columns - 1 {
                    let i = first + row * surface.columns + column;
                    let (a, b, c, d) = (i, i + 1, i + surface.columns, i + surface.columns + 1);
                    for corners in [[a, b, d], [a, d, c]] {
                        scene.triangles.push(corners.map(|corner| corner as u32));
                        scene.surface.push(id);
                    }
                }
            }
        }
        Ok(scene)
    }

    fn places(&self, corners: [u32; 3]) -> [[f64; 3]; 3] {
        corners.map(|corner| self.corners[corner as usize].place)
    }
}

/// The least whole number that is not less, zero at least; `as` cuts towards zero and stays inside.
#[inline]
fn from_above(x: f64) -> usize {
    let below = x as usize;
    below + usize::from((below as f64) < x)
}

/// The largest whole number that is not more, zero at least.
#[inline]
fn from_below(x: f64) -> usize {
    x as usize
}

/// The rows of samples that a triangle may cover in a picture so high; none if it has no area, or no place.
fn rows([a, b, c]: [[f64; 3]; 3], height: usize) -> Option<Range<usize>> {
    let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if double_area == 0.0 || !double_area.is_finite() || !(a[2] + b[2] + c[2]).is_finite() {
        return None;
    }
    let (top, bottom) = (a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    // Samples sit in the middle of their squares; `as` saturates outside the picture.
    let (first, end) = (from_above(top - 0.5), from_below(bottom + 0.5).min(height));
    (first < end).then_some(first..end)
}

/// What the samples of a strip of the picture hold: which triangle lies there, and where on it. What is hidden is never lit.
#[derive(Default)]
struct Samples {
    width: usize,
    /// Rows of the picture's samples.
    rows: Range<usize>,
    depth: Vec<f32>,
    /// Number of the surface plus one, 0 for none.
    surface: Vec<u16>,
    triangle: Vec<u32>,
    /// Weights of the triangle's second and third corner.
    weights: Vec<[f32; 2]>,
}

impl Samples {
    /// Empties it for a strip.
    fn begin(&mut self, width: usize, rows: Range<usize>) {
        let count = width * rows.len();
        (self.width, self.rows) = (width, rows);
        self.depth.clear();
        self.depth.resize(count, f32::NEG_INFINITY);
        self.surface.clear();
        self.surface.resize(count, 0);
        // Where there is no surface these are not read.
        self.triangle.resize(count, 0);
        self.weights.resize(count, [0.0; 2]);
    }

    fn triangle(&mut self, [a, b, c]: [[f64; 3]; 3], number: u32, id: u16) {
        let Some(rows) = rows([a, b, c], self.rows.end) else {
            return;
        };
        let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let (left, right) = (a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
        // Barycentric weights of b and c are affine in the place.
        let per_area = 1.0 / double_area;
        let (bx, by) = ((c[1] - a[1]) * per_area, (a[0] - c[0]) * per_area);
        let (cx, cy) = ((a[1] - b[1]) * per_area, (b[0] - a[0]) * per_area);
        let slopes = [bx, cx, -bx - cx];
        let per_slope = slopes.map(|slope| 1.0 / slope);
        for row in rows.start.max(self.rows.start)..rows.end {
            let y = row as f64 + 0.5 - a[1];
            // From where to where no weight is negative, beside a.
            let (mut from, mut to) = (left - a[0], right - a[0]);
            let at_a = [by * y, cy * y, 1.0 - (by + cy) * y];
            for (at_a, (slope, per_slope)) in
                at_a.into_iter().zip(slopes.into_iter().zip(per_slope))
            {
                let end = -at_a * per_slope;
                if slope > 0.0 {
                    from = from.max(end);
                } else if slope < 0.0 {
                    to = to.min(end);
                } else if at_a < -NEAR {
                    to = f64::NEG_INFINITY;
                }
            }
            // A sample on an edge belongs to both sides, whatever the rounding.
            let first = from_above(from + a[0] - 0.5 - NEAR);
            let end = from_below(to + a[0] + 0.5 + NEAR).min(self.width);
            for column in first..end {
                let x = column as f64 + 0.5 - a[0];
                let (wb, wc) = (bx * x + by * y, cx * x + cy * y);
                let depth = ((1.0 - wb - wc) * a[2] + wb * b[2] + wc * c[2]) as f32;
                let sample = (row - self.rows.start) * self.width + column;
                if depth > self.depth[sample] {
                    self.depth[sample] = depth;
                    self.surface[sample] = id;
                    self.triangle[sample] = number;
                    self.weights[sample] = [wb as f32, wc as f32];
                }
            }
        }
    }

    /// The light of a sample.
    fn light(&self, sample: usize, scene: &Scene, shader: &Shader) -> [f32; 3] {
        if self.surface[sample] == 0 {
            return [1.0; 3];
        }
        let corners = scene.triangles[self.triangle[sample] as usize];
        let [p, q, r] = corners.map(|corner| &scene.corners[corner as usize]);
        let [wb, wc] = self.weights[sample].map(f64::from);
        let wa = 1.0 - wb - wc;
        let normal =
            std::array::from_fn(|i| wa * p.normal[i] + wb * q.normal[i] + wc * r.normal[i]);
        shader.light(normal, wa * p.value + wb * q.value + wc * r.value)
    }

    /// Means over the samples of each pixel from a row of samples on, with a fine dark line where a surface ends or another
    /// begins. Where one surface fills a pixel, light changes little across it, and the sample in the middle does for all.
    fn resolve(
        &self,
        pixels: &mut [[u8; 3]],
        from: usize,
        samples: usize,
        scene: &Scene,
        shader: &Shader,
    ) {
        let across = self.width / samples;
        for (pixel, out) in pixels.iter_mut().enumerate() {
            let row = from - self.rows.start + pixel / across * samples;
            let column = pixel % across * samples;
            let filled = self.fills(column, row, samples);
            if filled == Some(0) {
                continue; // the paper is white
            }
            let mut sum = [0.0f32; 3];
            let mut add = |x: usize, y: usize, dim: f32| {
                let light = self.light(y * self.width + x, scene, shader);
                for (s, l) in sum.iter_mut().zip(light) {
                    *s += l * dim;
                }
            };
            let count = if filled.is_some() {
                add(column + samples / 2, row + samples / 2, 1.0);
                1
            } else {
                for y in row..row + samples {
                    for x in column..column + samples {
                        let dim = if self.is_edge(x, y, samples) {
                            0.12
                        } else {
                            1.0
                        };
                        add(x, y, dim);
                    }
                }
                samples * samples
            };
            *out = sum.map(|s| shader.byte(s / count as f32));
        }
    }

    /// The surface that all samples of a pixel show, 0 for none, if no edge runs through it.
    fn fills(&self, column: usize, row: usize, samples: usize) -> Option<u16> {
        let surface = self.surface[row * self.width + column];
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        let mut is_of_it = |column: usize, row: usize| {
            (row..row + samples).all(|y| {
                let line = y * self.width + column..y * self.width + column + samples;
                for &depth in &self.depth[line.clone()] {
                    (low, high) = (low.min(depth), high.max(depth));
                }
                self.surface[line].iter().all(|&one| one == surface)
            })
        };
        // Samples are compared with those of the pixels to the right and below.
        let (right, below) = (column + samples, row + samples);
        let alone = is_of_it(column, row)
            && (right >= self.width || is_of_it(right, row))
            && (below >= self.rows.len() || is_of_it(column, below));
        let whole = alone
            && (surface == 0
                || high - low <= STEP * samples as f32
                || (row..below).all(|y| (column..right).all(|x| !self.is_edge(x, y, samples))));
        whole.then_some(surface)
    }

    /// Whether another surface, nothing, or a step in depth begins `reach` samples to the right or below; rows are counted in
    /// the strip, which reaches as far beyond what is drawn of it.
    fn is_edge(&self, x: usize, y: usize, reach: usize) -> bool {
        let here = y * self.width + x;
        let differs = |there: usize, back: Option<usize>| {
            if self.surface[here] != self.surface[there] {
                return true;
            }
            // A fold before its own far side: a jump, not a slope that was as steep before.
            let rise = |i: usize| (self.depth[here] - self.depth[i]).abs();
            let jump = rise(there);
            let before = back.map_or(0.0, |i| {
                if self.surface[i] == self.surface[here] {
                    rise(i)
                } else {
                    0.0
                }
            });
            self.surface[here] != 0 && jump > STEP * reach as f32 && jump > 6.0 * before
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

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: [u8; 3] = [255; 3];

    fn view() -> View {
        let (right, up, toward) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        View {
            right,
            up,
            toward,
            corner: (0.0, 20.0),
            scale: 1.0,
            size: (20, 20),
        }
    }

    /// A square over x and y from `low` to `high` at height z, of one value.
    fn square(low: f64, high: f64, z: f64, value: f64) -> Surface {
        let points = vec![
            [low, low, z],
            [high, low, z],
            [low, high, z],
            [high, high, z],
        ];
        Surface {
            columns: 2,
            rows: 2,
            points,
            values: vec![value; 4],
        }
    }

    #[test]
    fn a_square_covers_its_pixels() {
        let image = render(
            &[square(4.0, 10.0, 0.0, 0.5)],
            &view(),
            (0.0, 1.0),
            Map::Viridis,
            1,
        )
        .unwrap();
        let inked: Vec<usize> = (0..400).filter(|&i| image.pixels[i] != WHITE).collect();
        // y from 4 to 10 is up: rows 10 to 15, plus the line of the edge to the left and above.
        for row in 10..16 {
            for column in 4..10 {
                assert!(
                    inked.contains(&(row * 20 + column)),
                    "row {row}, column {column}"
                );
            }
        }
        assert!(
            inked
                .iter()
                .all(|i| (9..16).contains(&(i / 20)) && (3..10).contains(&(i % 20)))
        );
    }

    #[test]
    fn the_nearer_surface_hides_the_other_in_either_order() {
        let (near, far) = (square(2.0, 18.0, 1.0, 1.0), square(2.0, 18.0, -1.0, 0.0));
        let one = render(
            &[near.clone(), far.clone()],
            &view(),
            (0.0, 1.0),
            Map::Viridis,
            2,
        )
        .unwrap();
        let other = render(&[far, near], &view(), (0.0, 1.0), Map::Viridis, 2).unwrap();
        assert_eq!(one, other);
        let [r, _, b] = one.pixels[10 * 20 + 10];
        assert!(
            r > 2 * b,
            "the yellow end of the map lies in front: {r}, {b}"
        );
    }

    #[test]
    fn bad_grids_and_points() {
        let mut short = square(2.0, 18.0, 0.0, 0.5);
        short.values.pop();
        assert!(matches!(
            render(&[short], &view(), (0.0, 1.0), Map::Viridis, 1),
            Err(DrawError::Grid { .. })
        ));
        let mut hole = square(2.0, 18.0, 0.0, f64::NAN);
        hole.points[0][0] = f64::NAN;
        assert!(
            render(&[hole], &view(), (0.0, 1.0), Map::Viridis, 1)
                .unwrap()
                .pixels
                .iter()
                .all(|&p| p == WHITE)
        );
    }

    #[test]
    fn strips_leave_no_seam() {
        let surfaces = [square(3.0, 90.0, 0.0, 0.2), square(20.0, 60.0, 40.0, 0.9)];
        let from = |top: f64| {
            let view = View {
                right: [0.9, 0.1, 0.0],
                up: [-0.3, 0.8, 0.1],
                corner: (-30.0, top),
                size: (130, 100),
                ..view()
            };
            let image = render(&surfaces, &view, (0.0, 1.0), Map::Viridis, 3).unwrap();
            image.pixels
        };
        let (here, lower) = (from(80.0), from(75.0));
        let drawn = here.iter().filter(|&&pixel| pixel != WHITE).count();
        assert!(drawn > 3000, "{drawn}");
        // Five rows further down everything is the same, but for rounding.
        let near = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) < 3);
        let same = here[5 * 130..].iter().zip(&lower);
        let off = same.filter(|(a, b)| !near(a, b)).count();
        assert!(off < 20, "{off}");
    }

    #[test]
    fn the_tube_lies_level() {
        let [right, up, toward] = View::axes([0.4, 0.8, -0.3]);
        assert!(dot([0.0, 0.0, 1.0], up).abs() < 1e-12 && right[2] > 0.0);
        assert!(dot(cross(right, up), toward) > 0.999_999);
    }
}
