//! Intersection of triangles in space, and the point of one that is nearest to a given point.

/// A point in space.
pub type Point = [f64; 3];

/// A triangle.
pub type Triangle = [Point; 3];

/// Share of a triangle's area by which a point may lie outside and still count as inside.
const ROUNDING: f64 = 1e-12;

/// Returns a − b.
pub fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a · b.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns a × b.
pub fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Returns the point a + t (b − a).
fn between(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

/// Returns the point of a triangle with given weights of its corners.
pub fn combine(corners: &Triangle, weights: [f64; 3]) -> Point {
    [0, 1, 2].map(|i| (0..3).map(|c| weights[c] * corners[c][i]).sum())
}

/// Returns the distance of two points.
pub fn distance(a: Point, b: Point) -> f64 {
    let d = minus(a, b);
    dot(d, d).sqrt()
}

/// Returns whether two triangles intersect: an edge of one crosses the other. Triangles in one plane do not.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    let edges = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    edges(a).iter().any(|edge| crosses(edge, b)) || edges(b).iter().any(|edge| crosses(edge, a))
}

/// Returns whether a segment with ends on either side of the triangle's plane passes through the triangle.
fn crosses([p, q]: &[Point; 2], [a, b, c]: &Triangle) -> bool {
    let normal = cross(minus(*b, *a), minus(*c, *a));
    let (from, to) = (dot(normal, minus(*p, *a)), dot(normal, minus(*q, *a)));
    if from * to >= 0.0 {
        return false;
    }
    let x = between(*p, *q, from / (from - to));
    let margin = -ROUNDING * dot(normal, normal);
    let inside = |a: Point, b: Point| dot(normal, cross(minus(b, a), minus(x, a))) >= margin;
    inside(*a, *b) && inside(*b, *c) && inside(*c, *a)
}

/// Returns the weights of the corners of a triangle in its point nearest to another (Ericson 2004, section 5.1.5).
pub fn nearest(p: Point, [a, b, c]: &Triangle) -> [f64; 3] {
    let (ab, ac, ap) = (minus(*b, *a), minus(*c, *a), minus(p, *a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = minus(p, *b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let cp = minus(p, *c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let va = d3 * d6 - d5 * d4;
    let (on_b, on_c) = (d4 - d3, d5 - d6);
    if va <= 0.0 && on_b >= 0.0 && on_c >= 0.0 {
        let t = on_b / (on_b + on_c);
        return [0.0, 1.0 - t, t];
    }
    [va, vb, vc].map(|v| v / (va + vb + vc))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: Triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn triangles_intersect_where_an_edge_passes_through_the_other() {
        let upright = |z: f64, x: f64| [[x, 0.2, z], [x, 0.2, z + 1.0], [x + 0.1, 0.3, z + 1.0]];
        for (z, x, expected) in [
            (-0.5, 0.2, true),
            (0.01, 0.2, false),
            (-1.01, 0.2, false),
            (-0.5, 0.79, true),
            (-0.5, 0.81, false),
            (-0.5, -0.2, false),
        ] {
            let other = upright(z, x);
            assert_eq!(intersect(&FLAT, &other), expected, "{z} {x}");
            assert_eq!(intersect(&other, &FLAT), expected, "{z} {x}");
        }
        assert!(!intersect(&FLAT, &FLAT));
    }

    #[test]
    fn the_nearest_point_lies_on_the_face_or_an_edge_or_is_a_corner() {
        for (p, expected) in [
            ([0.2, 0.2, 0.3], 0.3),
            ([0.5, -0.4, 0.3], 0.5),
            ([-0.4, 0.5, 0.3], 0.5),
            ([1.0, 1.0, 0.0], 0.5_f64.sqrt()),
            ([-0.3, -0.4, 1.2], 1.3),
            ([1.3, -0.4, 0.0], 0.5),
            ([-0.3, 1.4, 0.0], 0.5),
            ([0.3, 0.9, 0.0], 0.02_f64.sqrt()),
        ] {
            let found = distance(p, combine(&FLAT, nearest(p, &FLAT)));
            assert!((found - expected).abs() < 1e-14, "{p:?}: {found}");
        }
    }
}
