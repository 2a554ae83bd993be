//! Shaded surfaces: a z-buffer, a light, and a fine dark line at edges.
//!
//! Parallel projection, so that lengths compare across the picture. A light from above the viewer's left shoulder falls
//! on both sides of a surface. How much of it a point throws back is worked out at the points of the surface and changes
//! evenly over its triangles; light, not sRGB bytes, is averaged over the samples of a pixel.

use super::colour::Map;
use super::light::{Shader, cross, minus, unit};
use super::pixels::Pixels;
use super::samples::{Samples, rows};
use super::scene::Scene;
use super::{DrawError, Image, Surface};
use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

/// Rows of pixels that are drawn at a time.
const STRIP: usize = 16;

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
/// [`DrawError::Grid`] for a surface whose lists do not fill its grid, [`DrawError::Size`] for an absurd picture,
/// [`DrawError::Triangles`] for too many.
pub fn render(
    surfaces: &[Surface],
    view: &View,
    range: (f64, f64),
    map: Map,
    samples: usize,
) -> Result<Image, DrawError> {
    let mut image = Image::white(view.size.0 as f64, view.size.1 as f64)?;
    let samples = samples.clamp(1, 4);
    let shader = Shader::new(range, map);
    let scene = Scene::of(surfaces, view, samples, &shader)?;
    let size = (image.width * samples, image.height * samples);
    let (width, height) = (image.width, STRIP * samples);
    // Of every strip its triangles, those just above and below it too: edges look there.
    let mut strips: Vec<Vec<u32>> = vec![vec![]; image.height.div_ceil(STRIP)];
    for (number, triangle) in scene.triangles.iter().enumerate() {
        let Some(rows) = rows(scene.places(triangle.corners), size.1) else {
            continue;
        };
        let first = rows.start.saturating_sub(samples) / height;
        let last = ((rows.end - 1 + samples) / height).min(strips.len() - 1);
        for strip in &mut strips[first..=last] {
            strip.push(number as u32);
        }
    }
    let pixels = image.pixels.par_chunks_mut(STRIP * width);
    let strips = pixels.zip(strips).enumerate();
    strips.for_each_init(<(Samples, Pixels)>::default, |room, (k, (pixels, own))| {
        let top = (k * height).saturating_sub(samples);
        let bottom = ((k + 1) * height + samples).min(size.1);
        room.0.begin(size.0, top..bottom);
        let from = k * height - top;
        dispatch!(Level::new(), _simd => strip(room, pixels, from, &own, samples, &scene, &shader));
    });
    Ok(image)
}

/// Draws the pixels of a strip, which begin with a row of its samples, from its own triangles.
#[inline(always)]
fn strip(
    (samples, room): &mut (Samples, Pixels),
    pixels: &mut [[u8; 3]],
    from: usize,
    own: &[u32],
    per_side: usize,
    scene: &Scene,
    shader: &Shader,
) {
    for &number in own {
        let corners = scene.triangles[number as usize].corners;
        samples.triangle(scene.places(corners), scene.name(number));
    }
    match per_side {
        1 => room.resolve::<1>(samples, pixels, from, scene, shader),
        2 => room.resolve::<2>(samples, pixels, from, scene, shader),
        3 => room.resolve::<3>(samples, pixels, from, scene, shader),
        _ => room.resolve::<4>(samples, pixels, from, scene, shader),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::light::dot;
    use crate::draw::{Opening, Sides};

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
            sides: Sides::Both,
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
    fn what_a_body_hides_need_not_be_drawn() {
        let neck = |zeta: f64| 0.3 * (-(12.0 * (zeta - 0.4)).powi(2)).exp();
        for kept in [(3.1, 6.2), (0.0, std::f64::consts::TAU)] {
            let opening = Opening::evenly(kept, [60, 40, 4]);
            let body = opening.surfaces(|zeta, eta, xi| {
                let r = 0.4 - neck(zeta) + 0.1 * xi;
                let z = 2.0 * zeta + 0.5 * neck(zeta);
                ([r * eta.cos(), r * eta.sin(), z], zeta)
            });
            assert_eq!(body[0].sides, Sides::Back);
            let mut whole = body.clone();
            for surface in &mut whole {
                surface.sides = Sides::Both;
            }
            for toward in [
                [0.4, 1.0, -0.3],
                [0.3, -1.0, 0.2],
                [1.0, 0.2, 0.9],
                [0.1, 0.2, -1.0],
            ] {
                let [right, up, toward] = View::axes(toward);
                let view = View {
                    right,
                    up,
                    toward,
                    corner: (-1.5, 1.5),
                    scale: 70.0,
                    size: (300, 210),
                };
                let drawn =
                    |surfaces| render(surfaces, &view, (0.0, 1.0), Map::Viridis, 2).unwrap();
                let (one, other) = (drawn(&body), drawn(&whole));
                assert!(one.pixels.iter().filter(|p| **p != WHITE).count() > 3000);
                let off = one.pixels.iter().zip(&other.pixels).filter(|(a, b)| a != b);
                assert!(off.count() < 3);
            }
        }
    }

    #[test]
    fn light_falls_on_the_side_that_is_seen() {
        // Tilted, so that light from the left and above tells its sides apart.
        let tilted = |slope: f64| {
            let mut surface = square(2.0, 18.0, 0.0, 0.5);
            for point in &mut surface.points {
                point[2] = slope * point[0];
            }
            surface
        };
        let turned = |mut surface: Surface| {
            surface.points.swap(0, 1);
            surface.points.swap(2, 3);
            surface
        };
        let seen = |surface| render(&[surface], &view(), (0.0, 1.0), Map::Viridis, 2).unwrap();
        let bright = |image: Image| image.pixels[10 * 20 + 10][1];
        let [lit, same] = [tilted(0.8), turned(tilted(0.8))].map(|s| bright(seen(s)));
        assert!(lit.abs_diff(same) < 2, "{lit} {same}");
        let away = bright(seen(tilted(-0.8)));
        assert!(lit > away + 8, "{lit} {away}");
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
