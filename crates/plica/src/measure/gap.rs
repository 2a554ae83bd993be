//! Smallest distance of a wall from itself.

use super::Wall;

impl Wall {
    /// Returns the smallest distance between two points that are at least `min_arc_length` apart along the
    /// wall, or between its ends if the wall is shorter than that; 0 if the wall crosses itself.
    pub fn gap(&self, min_arc_length: f64) -> f64 {
        let points = &self.points;
        let [first, .., last] = points[..] else {
            return 0.0;
        };
        let lengths: Vec<f64> = points.windows(2).map(|p| distance(p[0], p[1])).collect();
        let longest = lengths.iter().fold(0.0_f64, |most, l| most.max(*l));
        if !(longest > 0.0 && longest.is_finite()) {
            return distance(first, last);
        }
        let along: Vec<f64> = std::iter::once(0.0)
            .chain(lengths.iter().scan(0.0, |sum, l| {
                *sum += l;
                Some(*sum)
            }))
            .collect();
        let mut gap = f64::INFINITY;
        for i in 0..points.len() {
            let mut j = i + 2;
            while j < points.len() {
                let far = distance(points[i], points[j]);
                let crosses = i + 1 < points.len()
                    && j + 1 < points.len()
                    && cross([points[i], points[i + 1]], [points[j], points[j + 1]]);
                if crosses {
                    return 0.0;
                }
                if along[j] - along[i] >= min_arc_length {
                    gap = gap.min(far);
                }
                // Points move at most `longest` per index, so none of the skipped ones is nearer or crosses.
                let margin = far - gap.max(2.0 * longest);
                j += 1 + (margin / longest).max(0.0) as usize;
            }
        }
        if gap.is_finite() {
            gap
        } else {
            distance(first, last)
        }
    }
}

/// A point (z, ρ).
type Point = (f64, f64);

fn distance(a: Point, b: Point) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// Returns whether two straight segments intersect; collinear segments do not.
fn cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let turn = |a: Point, b: Point, c: Point| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    let sides = |a: Point, b: Point, c: Point, d: Point| turn(a, b, c) * turn(a, b, d) < 0.0;
    sides(a, b, c, d) && sides(c, d, a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(points: Vec<Point>) -> Wall {
        Wall {
            angle: 0.0,
            reference_z: vec![0.0; points.len()],
            points,
        }
    }

    /// Returns a wall through 100 points on each straight line between corners.
    fn through(corners: &[Point]) -> Wall {
        let lines = corners.windows(2).flat_map(|ends| {
            let [(a, b), (c, d)] = [ends[0], ends[1]];
            (0..100).map(move |i| {
                let t = f64::from(i) / 100.0;
                (a + t * (c - a), b + t * (d - b))
            })
        });
        wall(lines.collect())
    }

    #[test]
    fn the_gap_of_a_straight_wall_is_the_least_arc_length() {
        let gap = through(&[(0.0, 0.5), (3.0, 0.5)]).gap(0.06);
        assert!((0.06..0.1).contains(&gap), "{gap}");
    }

    #[test]
    fn the_gap_of_a_short_wall_is_the_distance_of_its_ends() {
        let short = wall(vec![(0.0, 0.5), (0.02, 0.5), (0.04, 0.47)]);
        assert!((short.gap(0.06) - 0.05).abs() < 1e-12);
        assert_eq!(wall(vec![(0.1, 0.5); 3]).gap(0.06), 0.0);
    }

    #[test]
    fn the_gap_of_a_fold_is_its_width() {
        let fold = through(&[
            (0.0, 0.5),
            (1.0, 0.5),
            (1.0, 0.48),
            (0.5, 0.48),
            (0.5, 0.2),
            (3.0, 0.2),
        ]);
        let gap = fold.gap(0.06);
        assert!((gap - 0.02).abs() < 1e-3, "{gap}");
    }

    #[test]
    fn a_wall_that_crosses_itself_has_no_gap() {
        let fold = through(&[(0.0, 0.5), (1.0, 0.5), (1.0, 0.4), (0.7, 0.6), (0.7, 0.7)]);
        assert_eq!(fold.gap(0.06), 0.0);
        // Also in a loop of three points.
        let loop_ = through(&[
            (0.0, 0.5),
            (1.0, 0.5),
            (1.001, 0.501),
            (1.0, 0.501),
            (1.001, 0.499),
            (2.0, 0.4),
        ]);
        assert_eq!(loop_.gap(0.06), 0.0);
    }

    #[test]
    fn the_gap_equals_that_of_all_pairs_of_points() {
        let mut fold = through(&[(0.0, 0.5), (1.0, 0.45), (0.6, 0.3), (1.4, 0.25), (3.0, 0.5)]);
        for (i, p) in fold.points.iter_mut().enumerate() {
            p.1 += 1e-3 * (i as f64 * 0.7).sin();
        }
        let mut along = vec![0.0];
        for p in fold.points.windows(2) {
            along.push(along[along.len() - 1] + distance(p[0], p[1]));
        }
        for apart in [0.02, 0.06, 0.3] {
            let mut expected = f64::INFINITY;
            for i in 0..fold.points.len() {
                for j in (0..i).filter(|&j| along[i] - along[j] >= apart) {
                    expected = expected.min(distance(fold.points[i], fold.points[j]));
                }
            }
            assert_eq!(fold.gap(apart), expected, "{apart}");
        }
    }
}
