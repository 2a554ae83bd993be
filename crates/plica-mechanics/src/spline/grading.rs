//! Graded breakpoints, closer together in refined zones.

/// A zone of the axis whose elements are `factor` times as dense as elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Beginning of the zone.
    pub from: f64,
    /// End of the zone.
    pub to: f64,
    /// Density of elements relative to the other parts.
    pub factor: f64,
}

/// Returns `elements + 1` breakpoints on [0, length], uniform between the edges of the refinements,
/// which are breakpoints themselves. Where refinements overlap the densest counts. With fewer
/// elements than intervals between edges the mesh is uniform.
pub fn graded_breakpoints(length: f64, elements: usize, refinements: &[Refinement]) -> Vec<f64> {
    let mut edges = vec![0.0, length];
    for r in refinements {
        edges.extend([r.from, r.to].map(|x| x.clamp(0.0, length)));
    }
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * length);
    if elements < edges.len() - 1 {
        edges = vec![0.0, length];
    }

    let share: Vec<f64> = edges
        .windows(2)
        .map(|w| {
            let middle = 0.5 * (w[0] + w[1]);
            let density = refinements
                .iter()
                .filter(|r| r.from < middle && middle < r.to)
                .fold(1.0, |d: f64, r| d.max(r.factor));
            density * (w[1] - w[0])
        })
        .collect();
    let total: f64 = share.iter().sum();

    // One element each; then every further one goes to the interval that lacks most of its share.
    let mut counts = vec![1_usize; share.len()];
    for _ in counts.len()..elements {
        let deficit = |i: usize| share[i] / total * elements as f64 / counts[i] as f64;
        let most = (0..share.len()).max_by(|&i, &j| deficit(i).total_cmp(&deficit(j)));
        counts[most.unwrap_or(0)] += 1;
    }

    let mut breakpoints = vec![edges[0]];
    for (w, &n) in edges.windows(2).zip(&counts) {
        breakpoints.extend((1..n).map(|i| w[0] + (w[1] - w[0]) * i as f64 / n as f64));
        breakpoints.push(w[1]);
    }
    breakpoints
}

/// Returns `elements + 1` breakpoints on [0, length] between which the lengths form a geometric sequence: the first
/// element is `grading` times as long as the last one. A grading of 1 is uniform.
pub fn geometric_breakpoints(length: f64, elements: usize, grading: f64) -> Vec<f64> {
    let n = elements as f64;
    if elements < 2 || grading == 1.0 {
        return (0..=elements).map(|i| length * i as f64 / n).collect();
    }
    // Element i has the length q^i, so that i of them have (1 − q^i)/(1 − q).
    let ln_q = -grading.ln() / (n - 1.0);
    let part = |i: usize| (i as f64 * ln_q).exp_m1() / (n * ln_q).exp_m1();
    let mut breakpoints: Vec<f64> = (0..elements).map(|i| length * part(i)).collect();
    breakpoints.push(length);
    breakpoints
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refined_zones_are_dense_and_end_at_breakpoints() {
        let zone = Refinement {
            from: 0.5,
            to: 1.0,
            factor: 3.0,
        };
        let x = graded_breakpoints(3.0, 302, &[zone]);
        assert_eq!(x.len(), 303);
        assert!(x.windows(2).all(|w| w[0] < w[1]));
        assert!(x.contains(&0.5) && x.contains(&1.0) && x[302] == 3.0);
        let inside = x.iter().filter(|&&x| x > 0.5 && x <= 1.0).count();
        assert!((inside as f64 - 302.0 * 1.5 / 4.0).abs() <= 1.0, "{inside}");
    }

    #[test]
    fn lengths_form_a_geometric_sequence() {
        for (elements, grading) in [(2, 3.0), (9, 40.0), (9, 0.1), (30, 1.0 + 1e-9)] {
            let x = geometric_breakpoints(0.06, elements, grading);
            assert_eq!((x.len(), x[0], x[elements]), (elements + 1, 0.0, 0.06));
            let lengths: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
            let whole = lengths[0] / lengths[elements - 1];
            assert!((whole / grading - 1.0).abs() < 1e-12, "{whole}");
            let ratio = grading.powf(-1.0 / (elements as f64 - 1.0));
            for w in lengths.windows(2) {
                assert!((w[1] / w[0] / ratio - 1.0).abs() < 1e-12, "{lengths:?}");
            }
        }
    }

    #[test]
    fn a_grading_of_one_is_uniform_to_the_bit() {
        for elements in [1, 2, 5, 7] {
            let uniform = geometric_breakpoints(0.06, elements, 1.0);
            assert_eq!(uniform, graded_breakpoints(0.06, elements, &[]));
        }
    }

    #[test]
    fn breakpoints_without_refinement_are_uniform() {
        let x = graded_breakpoints(2.0, 4, &[]);
        assert_eq!(x, [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(
            graded_breakpoints(
                2.0,
                1,
                &[Refinement {
                    from: 0.5,
                    to: 1.0,
                    factor: 2.0
                }]
            )
            .len(),
            2
        );
    }
}
