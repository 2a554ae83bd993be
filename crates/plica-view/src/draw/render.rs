//! Rendering of shaded surfaces with a depth buffer, one light source and dark lines along edges.
//!
//! The projection is parallel. The light comes from above the left shoulder of the viewer and illuminates both sides of a
//! surface. Its intensity is computed at the points of the surface and interpolated linearly over its triangles. The samples
//! of a pixel are averaged in linear light, not in sRGB.

use super::colour::ColourMap;
use super::depth_buffer::{DepthBuffer, rows};
use super::light::Shader;
use super::resolve::Resolver;
use super::scene::Scene;
use super::view::View;
use super::{DrawError, Image, Surface};
use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

/// Rows of pixels per strip.
const STRIP: usize = 16;

/// Renders surfaces on white; `range` is the range of the colour `map`.
///
/// A pixel is the mean of `samples` by `samples` samples, at most 4 by 4. Threads share the strips of the picture; the
/// samples of a strip fit into a cache, and the result does not depend on the number of threads.
///
/// # Errors
/// [`DrawError::Grid`] for lists that do not match the grid, [`DrawError::Size`] for a picture that is too small or too
/// large, [`DrawError::Triangles`] for too many triangles.
pub(super) fn render(
    surfaces: &[Surface],
    view: &View,
    range: (f64, f64),
    map: ColourMap,
    samples: usize,
) -> Result<Image, DrawError> {
    let mut image = Image::white(view.size.0 as f64, view.size.1 as f64)?;
    let samples = samples.clamp(1, 4);
    let shader = Shader::new(range, map);
    let scene = Scene::new(surfaces, view, samples, &shader)?;
    let size = (image.width * samples, image.height * samples);
    let (width, height) = (image.width, STRIP * samples);
    // The triangles of every strip, including those just above and below, which the search for edges needs.
    let mut strips: Vec<Vec<u32>> = vec![vec![]; image.height.div_ceil(STRIP)];
    for (number, triangle) in scene.triangles.iter().enumerate() {
        let Some(rows) = rows(scene.positions(triangle.corners), size.1) else {
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
    strips.for_each_init(<(DepthBuffer, Resolver)>::default, |buffers, (k, (pixels, triangles))| {
        let top = (k * height).saturating_sub(samples);
        let bottom = ((k + 1) * height + samples).min(size.1);
        buffers.0.reset(size.0, top..bottom);
        let from = k * height - top;
        dispatch!(Level::new(), _simd => strip(buffers, pixels, from, &triangles, samples, &scene, &shader));
    });
    Ok(image)
}

/// Draws the pixels of a strip from its triangles; `from` is the first row of samples of the first row of pixels.
#[inline(always)]
fn strip(
    (buffer, resolver): &mut (DepthBuffer, Resolver),
    pixels: &mut [[u8; 3]],
    from: usize,
    triangles: &[u32],
    per_side: usize,
    scene: &Scene,
    shader: &Shader,
) {
    for &number in triangles {
        let corners = scene.triangles[number as usize].corners;
        buffer.draw(scene.positions(corners), scene.id(number));
    }
    match per_side {
        1 => resolver.resolve::<1>(buffer, pixels, from, scene, shader),
        2 => resolver.resolve::<2>(buffer, pixels, from, scene, shader),
        3 => resolver.resolve::<3>(buffer, pixels, from, scene, shader),
        _ => resolver.resolve::<4>(buffer, pixels, from, scene, shader),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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

    /// Renders surfaces in the default view with values from 0 to 1.
    fn image(surfaces: &[Surface], samples: usize) -> Image {
        render(surfaces, &view(), (0.0, 1.0), ColourMap::Viridis, samples).unwrap()
    }

    /// A square in x and y from `low` to `high` at height z, with one value.
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
        let image = image(&[square(4.0, 10.0, 0.0, 0.5)], 1);
        let inked: Vec<usize> = (0..400).filter(|&i| image.pixels[i] != WHITE).collect();
        // y from 4 to 10 points up: rows 10 to 15, plus the line along the left and upper edge.
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
    fn the_nearer_surface_hides_the_other_in_any_order() {
        let (near, far) = (square(2.0, 18.0, 1.0, 1.0), square(2.0, 18.0, -1.0, 0.0));
        let one = image(&[near.clone(), far.clone()], 2);
        let other = image(&[far, near], 2);
        assert_eq!(one, other);
        let [r, _, b] = one.pixels[10 * 20 + 10];
        assert!(r > 2 * b, "the yellow end of the map is in front: {r}, {b}");
    }

    #[test]
    fn leaving_out_hidden_sides_changes_no_pixels() {
        let neck = |zeta: f64| 0.3 * (-(12.0 * (zeta - 0.4)).powi(2)).exp();
        for kept in [(3.1, 6.2), (0.0, std::f64::consts::TAU)] {
            let opening = Opening::uniform(kept, [60, 40, 4]);
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
                    |surfaces| render(surfaces, &view, (0.0, 1.0), ColourMap::Viridis, 2).unwrap();
                let (one, other) = (drawn(&body), drawn(&whole));
                assert!(one.pixels.iter().filter(|p| **p != WHITE).count() > 3000);
                let off = one.pixels.iter().zip(&other.pixels).filter(|(a, b)| a != b);
                assert!(off.count() < 3);
            }
        }
    }

    #[test]
    fn light_illuminates_the_visible_side() {
        // Tilted towards the light or away from it.
        let tilted = |slope: f64| {
            let mut surface = square(2.0, 18.0, 0.0, 0.5);
            for point in &mut surface.points {
                point[2] = slope * point[0];
            }
            surface
        };
        let reversed = |mut surface: Surface| {
            surface.points.swap(0, 1);
            surface.points.swap(2, 3);
            surface
        };
        let drawn = |surface| image(&[surface], 2);
        let bright = |image: Image| image.pixels[10 * 20 + 10][1];
        let [lit, same] = [tilted(0.8), reversed(tilted(0.8))].map(|s| bright(drawn(s)));
        assert!(lit.abs_diff(same) < 2, "{lit} {same}");
        let away = bright(drawn(tilted(-0.8)));
        assert!(lit > away + 8, "{lit} {away}");
    }

    #[test]
    fn invalid_grids_are_errors_and_nan_points_are_left_out() {
        let mut short = square(2.0, 18.0, 0.0, 0.5);
        short.values.pop();
        assert!(matches!(
            render(&[short], &view(), (0.0, 1.0), ColourMap::Viridis, 1),
            Err(DrawError::Grid { .. })
        ));
        let mut hole = square(2.0, 18.0, 0.0, f64::NAN);
        hole.points[0][0] = f64::NAN;
        assert!(image(&[hole], 1).pixels.iter().all(|&p| p == WHITE));
    }

    #[test]
    fn strip_boundaries_are_invisible() {
        let surfaces = [square(3.0, 90.0, 0.0, 0.2), square(20.0, 60.0, 40.0, 0.9)];
        let from = |top: f64| {
            let view = View {
                right: [0.9, 0.1, 0.0],
                up: [-0.3, 0.8, 0.1],
                corner: (-30.0, top),
                size: (130, 100),
                ..view()
            };
            let image = render(&surfaces, &view, (0.0, 1.0), ColourMap::Viridis, 3).unwrap();
            image.pixels
        };
        let (here, lower) = (from(80.0), from(75.0));
        let drawn = here.iter().filter(|&&pixel| pixel != WHITE).count();
        assert!(drawn > 3000, "{drawn}");
        // The view is shifted by five rows: the pixels agree up to rounding.
        let near = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) < 3);
        let same = here[5 * 130..].iter().zip(&lower);
        let off = same.filter(|(a, b)| !near(a, b)).count();
        assert!(off < 20, "{off}");
    }
}
