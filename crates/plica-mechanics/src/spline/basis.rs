//! B-spline bases by the recurrence of Cox and de Boor.

/// A B-spline basis.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    degree: usize,
    knots: Vec<f64>,
    /// The first function of every element, which is the number of its knot span.
    first: Vec<usize>,
}

/// Values at a point of the p + 1 functions that are not zero on an element.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    /// Element.
    pub element: usize,
    /// The first function that is not zero on the element; entry `b` below belongs to function `first + b`.
    pub first: usize,
    /// N, one per function.
    pub value: Vec<f64>,
    /// dN/dx.
    pub slope: Vec<f64>,
}

impl Basis {
    /// Creates a basis on open knots, with the first and last control points on the ends.
    /// `breakpoints` rise strictly, one more than there are elements.
    pub fn open(degree: usize, breakpoints: &[f64]) -> Self {
        assert!(degree >= 1 && breakpoints.len() >= 2);
        assert!(breakpoints.windows(2).all(|w| w[0] < w[1]));
        Self::with_multiplicities(degree, breakpoints, &vec![1; breakpoints.len() - 2])
    }

    /// Creates a basis on open knots whose inner breakpoints are repeated: with multiplicity m, functions have p − m
    /// continuous derivatives there; with m = p they have a kink.
    pub fn with_multiplicities(
        degree: usize,
        breakpoints: &[f64],
        multiplicities: &[usize],
    ) -> Self {
        assert_eq!(multiplicities.len() + 2, breakpoints.len());
        let (first, last) = (breakpoints[0], breakpoints[breakpoints.len() - 1]);
        let mut knots = vec![first; degree + 1];
        let mut starts = vec![0];
        for (&t, &m) in breakpoints[1..].iter().zip(multiplicities) {
            knots.extend(vec![t; m]);
            starts.push(knots.len() - 1 - degree);
        }
        knots.extend(vec![last; degree + 1]);
        Self {
            degree,
            knots,
            first: starts,
        }
    }

    /// Creates the element [0, 1] of a uniform periodic basis.
    pub fn uniform_element(degree: usize) -> Self {
        let p = degree as i32;
        Self {
            degree,
            knots: (-p..=p + 1).map(f64::from).collect(),
            first: vec![0],
        }
    }

    /// Returns the degree p.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the number of functions, which is that of control points.
    pub fn functions(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// Returns the number of elements (non-empty knot spans).
    pub fn elements(&self) -> usize {
        self.first.len()
    }

    /// Returns the first function that is not zero on an element; there are p + 1 of them.
    pub fn first(&self, element: usize) -> usize {
        self.first[element]
    }

    /// Returns the ends of an element.
    pub fn element(&self, e: usize) -> (f64, f64) {
        let span = self.degree + self.first[e];
        (self.knots[span], self.knots[span + 1])
    }

    /// Returns the knots, repeated ones included.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns the position at an element number with fraction: 2.5 is the middle of the third.
    pub fn position(&self, at: f64) -> f64 {
        let e = (at as usize).min(self.elements() - 1);
        let (from, to) = self.element(e);
        from + (to - from) * (at - e as f64)
    }

    /// Returns `count` ≥ 2 positions from end to end, as dense as the elements.
    pub fn positions(&self, count: usize) -> Vec<f64> {
        let elements = self.elements() as f64;
        let at = |i: usize| elements * i as f64 / (count - 1) as f64;
        (0..count).map(|i| self.position(at(i))).collect()
    }

    /// Returns the element that contains `x`; the nearest one if `x` is outside.
    pub fn find(&self, x: f64) -> usize {
        let inner = &self.knots[self.degree + 1..self.knots.len() - self.degree - 1];
        let span = inner.partition_point(|&t| t <= x);
        match self.first.get(span) {
            Some(&first) if first == span => span,
            _ => self.first.partition_point(|&first| first <= span) - 1,
        }
    }

    /// Returns the Greville abscissae, the control values of x.
    pub fn greville(&self) -> Vec<f64> {
        (0..self.functions())
            .map(|a| self.knots[a + 1..=a + self.degree].iter().sum::<f64>() / self.degree as f64)
            .collect()
    }

    /// Returns the integral of every function.
    pub fn integrals(&self) -> Vec<f64> {
        let p = self.degree;
        (0..self.functions())
            .map(|a| (self.knots[a + p + 1] - self.knots[a]) / (p + 1) as f64)
            .collect()
    }

    /// Returns the control values of 1, x and x², function by function. Degree 1 interpolates x² at
    /// the knots.
    pub fn quadratics(&self) -> Vec<[f64; 3]> {
        let p = self.degree;
        let of = |a: usize| {
            let knots = &self.knots[a + 1..=a + p];
            let mean = knots.iter().sum::<f64>() / p as f64;
            // Mean of the products of two of the knots: the blossom of x².
            let squares: f64 = knots.iter().map(|t| t * t).sum();
            let pairs = (p * p) as f64 * mean * mean - squares;
            let square = if p == 1 {
                squares
            } else {
                pairs / (p * (p - 1)) as f64
            };
            [1.0, mean, square]
        };
        (0..self.functions()).map(of).collect()
    }

    /// Returns the Bézier form of an element: for each of its p + 1 control points the factors of the p + 1 functions
    /// that are not zero there.
    pub fn bezier_points(&self, element: usize) -> Vec<Vec<f64>> {
        let p = self.degree;
        let t = &self.knots[self.first[element]..];
        let (from, to) = self.element(element);
        // Control point k is the blossom at p − k times the first end and k times the last, by de Boor's algorithm.
        let blossom = |k: usize, function: usize| {
            let mut d = vec![0.0; p + 1];
            d[function] = 1.0;
            for level in 1..=p {
                let x = if level <= k { to } else { from };
                for i in (level..=p).rev() {
                    let (low, high) = (t[i], t[i + 1 + p - level]);
                    let ratio = (x - low) / (high - low);
                    d[i] = (1.0 - ratio) * d[i - 1] + ratio * d[i];
                }
            }
            d[p]
        };
        (0..=p)
            .map(|k| (0..=p).map(|function| blossom(k, function)).collect())
            .collect()
    }

    /// Returns values and slopes at a point.
    pub fn evaluate(&self, x: f64) -> Values {
        self.evaluate_in(self.find(x), x)
    }

    /// Returns values and slopes at a point of a given element (on a shared edge the side matters).
    pub fn evaluate_in(&self, element: usize, x: f64) -> Values {
        let p = self.degree;
        let first = self.first[element];
        let lower = self.values(first, x, p - 1);
        // N'_{i,p} = p ( N_{i,p−1} / (t_{i+p} − t_i) − N_{i+1,p−1} / (t_{i+p+1} − t_{i+1}) )
        let t = &self.knots[first..];
        let scaled: Vec<f64> = (0..p)
            .map(|b| p as f64 * lower[b] / (t[b + 1 + p] - t[b + 1]))
            .collect();
        let slope = (0..=p)
            .map(|b| {
                let left = if b > 0 { scaled[b - 1] } else { 0.0 };
                let right = if b < p { scaled[b] } else { 0.0 };
                left - right
            })
            .collect();
        Values {
            element,
            first,
            value: self.values(first, x, p),
            slope,
        }
    }

    /// Returns the d + 1 functions of degree d that are not zero on the element of a first function.
    fn values(&self, first: usize, x: f64, d: usize) -> Vec<f64> {
        let span = first + self.degree;
        let t = &self.knots;
        let mut n = vec![0.0; d + 1];
        n[0] = 1.0;
        for k in 1..=d {
            let mut saved = 0.0;
            for b in 0..k {
                let (left, right) = (t[span + 1 + b - k], t[span + 1 + b]);
                let ratio = n[b] / (right - left);
                n[b] = saved + (right - x) * ratio;
                saved = (x - left) * ratio;
            }
            n[k] = saved;
        }
        n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bases() -> impl Iterator<Item = Basis> {
        (1..=5).map(|p| Basis::open(p, &[0.0, 0.3, 0.5, 0.55, 1.4, 3.0]))
    }

    /// Bases with a kink at 0.5.
    fn kinked() -> impl Iterator<Item = Basis> {
        let breakpoints = [0.0, 0.3, 0.5, 0.55, 1.4, 3.0];
        (1..=5).map(move |p| Basis::with_multiplicities(p, &breakpoints, &[1, p, 1, 1]))
    }

    #[test]
    fn a_repeated_knot_separates_the_functions_on_its_sides() {
        for basis in kinked() {
            let p = basis.degree();
            assert_eq!((basis.elements(), basis.functions()), (5, 5 + p + p - 1));
            assert_eq!([0, 1, 2, 3].map(|e| basis.first(e)), [0, 1, p + 1, p + 2]);
            assert_eq!(basis.element(2), (0.5, 0.55));
            assert_eq!(
                [0.0, 0.4, 0.5, 0.52, 1.3, 2.0, 9.0].map(|x| basis.find(x)),
                [0, 1, 2, 2, 3, 4, 4]
            );
            // The function of the knot is one there, and all the others are zero.
            for element in [1, 2] {
                let at = basis.evaluate_in(element, 0.5);
                let one = p + 1 - at.first;
                assert!((at.value[one] - 1.0).abs() < 1e-14, "{at:?}");
            }
            assert!((basis.greville()[p + 1] - 0.5).abs() < 1e-15);
            // Its slope jumps: the two sides are independent.
            let slopes = [1, 2].map(|e| basis.evaluate_in(e, 0.5).slope);
            assert!(slopes[0][p] > 0.0 && slopes[1][0] < 0.0);
        }
    }

    const POINTS: [f64; 7] = [0.0, 0.12, 0.3, 0.52, 1.0, 2.99, 3.0];

    #[test]
    fn control_values_of_quadratics_are_exact() {
        for p in 2..=5 {
            let basis = Basis::open(p, &[0.3, 0.5, 0.6, 1.0]);
            let control = basis.quadratics();
            for x in [0.3, 0.41, 0.55, 0.9] {
                let at = basis.evaluate(x);
                for (power, exact) in [1.0, x, x * x].into_iter().enumerate() {
                    let values = at.value.iter().zip(&control[at.first..]);
                    let value: f64 = values.map(|(n, c)| n * c[power]).sum();
                    assert!((value - exact).abs() < 1e-14, "{p} {x}: {value} {exact}");
                }
            }
        }
    }

    #[test]
    fn bezier_points_describe_the_same_curve() {
        for basis in bases().chain(kinked()) {
            let p = basis.degree();
            for element in 0..basis.elements() {
                let (from, to) = basis.element(element);
                let bezier = basis.bezier_points(element);
                for xi in [0.0, 0.3, 1.0] {
                    let values = basis.evaluate_in(element, from + xi * (to - from)).value;
                    for (function, value) in values.iter().enumerate() {
                        // De Casteljau's algorithm.
                        let mut points: Vec<f64> = bezier.iter().map(|k| k[function]).collect();
                        for level in (1..=p).rev() {
                            for i in 0..level {
                                points[i] = (1.0 - xi) * points[i] + xi * points[i + 1];
                            }
                        }
                        assert!((points[0] - value).abs() < 1e-14);
                    }
                }
            }
        }
    }

    #[test]
    fn functions_sum_to_one_and_slopes_to_zero() {
        for basis in bases().chain(kinked()) {
            for x in POINTS {
                let v = basis.evaluate(x);
                assert!((v.value.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(v.slope.iter().sum::<f64>().abs() < 1e-12);
                assert!(v.value.iter().all(|&n| n >= 0.0));
            }
        }
    }

    #[test]
    fn greville_abscissae_reproduce_a_line() {
        for basis in bases().chain(kinked()) {
            let g = basis.greville();
            assert_eq!((g[0], g[g.len() - 1]), (0.0, 3.0));
            for x in POINTS {
                let v = basis.evaluate(x);
                let sum = |n: &[f64]| -> f64 {
                    n.iter().enumerate().map(|(b, n)| n * g[v.first + b]).sum()
                };
                assert!((sum(&v.value) - x).abs() < 1e-14);
                assert!((sum(&v.slope) - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn slopes_are_the_derivatives_of_values() {
        for basis in bases().filter(|b| b.degree() > 1) {
            let (x, e) = (0.9, basis.find(0.9));
            let error = |h: f64| -> f64 {
                let (a, b) = (basis.evaluate_in(e, x + h), basis.evaluate_in(e, x - h));
                let exact = basis.evaluate_in(e, x);
                (0..=basis.degree())
                    .map(|b_| ((a.value[b_] - b.value[b_]) / (2.0 * h) - exact.slope[b_]).abs())
                    .sum()
            };
            // Central differences are exact for parabolas, second order beyond.
            let order = (error(0.1) / error(0.05)).log2();
            assert!(
                error(0.1) < 1e-12 || (order - 2.0).abs() < 0.1,
                "order {order}"
            );
        }
    }

    #[test]
    fn splines_are_smooth_across_knots() {
        for basis in bases().filter(|b| b.degree() > 1) {
            let (left, right) = (basis.evaluate_in(1, 0.5), basis.evaluate_in(2, 0.5));
            // Function e+1+b is number b+1 on the left and b on the right.
            for b in 0..basis.degree() {
                assert!((left.value[b + 1] - right.value[b]).abs() < 1e-14);
                assert!((left.slope[b + 1] - right.slope[b]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn find_takes_the_right_element_at_edges_and_the_nearest_outside() {
        let basis = Basis::open(3, &[0.0, 1.0, 2.0]);
        assert_eq!(
            [-1.0, 0.0, 0.5, 1.0, 2.0, 5.0].map(|x| basis.find(x)),
            [0, 0, 0, 1, 1, 1]
        );
    }
}
