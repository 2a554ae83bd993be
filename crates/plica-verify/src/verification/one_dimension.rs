//! Independent reference solution: an axisymmetric tube r(R) that is uniform along its axis, and the waves
//! to which it may lose stability. Both are polynomials of high degree through the wall.
//!
//! Nothing of the rest of the library is used here: no spline, no kernel, no law, no solver.
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | A, B | inner and outer radius at rest | D |
//! | r(R) | current radius of the point at R | D |
//! | ℓ | axial stretch, uniform | – |
//! | θη, θζ | growth stretches around and along | – |
//! | p | follower pressure on the inner and the outer wall | E |
//! | n, k | circumferential mode; axial wave number, π over the length of a half wave | –, 1/D |
//!
//! The law, in the elastic principal stretches s with I₁ = Σ s², I₂ = Σ (J/s)² and J = s₁ s₂ s₃, is
//!
//! w = a/2 (I₁ − 3) + b/2 (I₂ − 3) − (a + 2b) ln J + U(J),
//!
//! neo-Hookean for b = 0 and a = μ.

use std::f64::consts::PI;

/// Degree of the polynomials.
const DEGREE: usize = 16;
/// Nodes through the wall.
const POINTS: usize = DEGREE + 1;
/// Limit of Newton's iterations.
const STEPS: usize = 60;

/// Volumetric energy U(J).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VolumetricEnergy {
    /// λ/2 (ln J)².
    #[default]
    Logarithmic,
    /// λ/4 (J² − 1 − 2 ln J).
    Quadratic,
}

/// A wall with its law and its load.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// A and B.
    pub radii: [f64; 2],
    /// Constants a and b of the law.
    pub shear: [f64; 2],
    /// Constant λ of the volumetric energy.
    pub lambda: f64,
    /// Volumetric energy.
    pub volumetric: VolumetricEnergy,
    /// Axial stretch ℓ.
    pub stretch: f64,
    /// Growth stretches θη and θζ.
    pub growth: [f64; 2],
    /// Follower pressures on the inner and the outer wall.
    pub pressures: [f64; 2],
}

/// A wall in equilibrium.
#[derive(Clone, Debug)]
pub struct Solution {
    wall: Wall,
    /// Current radii of the nodes.
    r: Vec<f64>,
}

/// Newton's method found no equilibrium of the one-dimensional wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the one-dimensional reference solution has no equilibrium")]
pub struct NoEquilibrium;

impl Wall {
    /// Creates an unloaded neo-Hookean wall with E = 1.
    pub fn new(radii: [f64; 2], nu: f64) -> Self {
        Self {
            radii,
            shear: [1.0 / (2.0 * (1.0 + nu)), 0.0],
            lambda: nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            volumetric: VolumetricEnergy::Logarithmic,
            stretch: 1.0,
            growth: [1.0; 2],
            pressures: [0.0; 2],
        }
    }

    /// Creates an unloaded Mooney–Rivlin wall with E = 1 and the share of I₂ in the shear modulus.
    ///
    /// Its Lamé constants at small strains, a + b and λ + 2b, are those of [`Wall::new`].
    pub fn mooney_rivlin(radii: [f64; 2], nu: f64, share: f64) -> Self {
        let neo_hookean = Self::new(radii, nu);
        let mu = neo_hookean.shear[0];
        Self {
            shear: [(1.0 - share) * mu, share * mu],
            lambda: neo_hookean.lambda - 2.0 * share * mu,
            ..neo_hookean
        }
    }

    /// Returns U, J U′ and J (J U′)′ at J.
    fn volume(&self, J: f64) -> (f64, f64, f64) {
        let lambda = self.lambda;
        match self.volumetric {
            VolumetricEnergy::Logarithmic => {
                let ln = J.ln();
                (0.5 * lambda * ln * ln, lambda * ln, lambda)
            }
            VolumetricEnergy::Quadratic => (
                0.25 * lambda * (J * J - 1.0 - 2.0 * J.ln()),
                0.5 * lambda * (J * J - 1.0),
                lambda * J * J,
            ),
        }
    }

    /// Returns the elastic stretches outwards, around and along of r and r′ at R.
    fn elastic_stretches(&self, R: f64, r: f64, slope: f64) -> [f64; 3] {
        [
            slope,
            r / (R * self.growth[0]),
            self.stretch / self.growth[1],
        ]
    }

    /// Returns w and ∂w/∂s.
    fn energy(&self, s: [f64; 3]) -> (f64, [f64; 3]) {
        let [a, b] = self.shear;
        let J = s[0] * s[1] * s[2];
        let (U, h, _) = self.volume(J);
        let I1: f64 = s.iter().map(|s| s * s).sum();
        let I2: f64 = s.iter().map(|s| (J / s).powi(2)).sum();
        let w = 0.5 * a * (I1 - 3.0) + 0.5 * b * (I2 - 3.0) - (a + 2.0 * b) * J.ln() + U;
        let slope = |s: f64| s * (a + b * (I1 - s * s)) + (h - a - 2.0 * b) / s;
        (w, s.map(slope))
    }

    /// Returns ∂²w/∂s∂s.
    fn curvature(&self, s: [f64; 3]) -> [[f64; 3]; 3] {
        let [a, b] = self.shear;
        let (_, h, q) = self.volume(s[0] * s[1] * s[2]);
        let I1: f64 = s.iter().map(|s| s * s).sum();
        let entry = |i: usize, j: usize| {
            let shape = if i == j {
                a + b * (I1 - s[i] * s[i]) + (a + 2.0 * b - h) / (s[i] * s[i])
            } else {
                2.0 * b * s[i] * s[j]
            };
            shape + q / (s[i] * s[j])
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }

    /// Solves for equilibrium by Newton's method from rest, with the load applied in `steps` equal steps.
    ///
    /// # Errors
    /// [`NoEquilibrium`] if a step does not converge.
    pub fn solve(&self, steps: usize) -> Result<Solution, NoEquilibrium> {
        let nodes = Nodes::new(self.radii);
        let mut r = nodes.at.clone();
        for step in 1..=steps {
            let t = step as f64 / steps as f64;
            let part = Self {
                stretch: 1.0 + t * (self.stretch - 1.0),
                growth: self.growth.map(|g| 1.0 + t * (g - 1.0)),
                pressures: self.pressures.map(|p| t * p),
                ..*self
            };
            part.newton(&nodes, &mut r)?;
        }
        Ok(Solution { wall: *self, r })
    }

    fn newton(&self, nodes: &Nodes, r: &mut [f64]) -> Result<(), NoEquilibrium> {
        let volume = self.growth[0] * self.growth[1];
        for _ in 0..STEPS {
            let mut force = vec![0.0; POINTS];
            let mut stiffness = vec![vec![0.0; POINTS]; POINTS];
            for point in &nodes.points {
                let (value, slope) = point.interpolate(r);
                let s = self.elastic_stretches(point.R, value, slope);
                let (_, P) = self.energy(s);
                let A = self.curvature(s);
                let weight = 2.0 * PI * point.R * point.weight * volume;
                let around = 1.0 / (point.R * self.growth[0]);
                for i in 0..POINTS {
                    let d = [point.slope[i], around * point.value[i]];
                    force[i] += weight * (P[0] * d[0] + P[1] * d[1]);
                    for j in 0..POINTS {
                        let e = [point.slope[j], around * point.value[j]];
                        stiffness[i][j] += weight
                            * (d[0] * (A[0][0] * e[0] + A[0][1] * e[1])
                                + d[1] * (A[1][0] * e[0] + A[1][1] * e[1]));
                    }
                }
            }
            // Work of the pressures: p π r² ℓ inside, −p π r² ℓ outside.
            for (end, sign, p) in [
                (0, -1.0, self.pressures[0]),
                (DEGREE, 1.0, self.pressures[1]),
            ] {
                let push = 2.0 * PI * sign * p * self.stretch;
                force[end] += push * r[end];
                stiffness[end][end] += push;
            }
            let step = solve_linear(stiffness, force).ok_or(NoEquilibrium)?;
            let size = step.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            // A step changes no radius by more than a tenth of A.
            let part = (0.1 * self.radii[0] / size).min(1.0);
            for (r, step) in r.iter_mut().zip(&step) {
                *r -= part * step;
            }
            if !size.is_finite() {
                return Err(NoEquilibrium);
            }
            if size < 1e-13 * self.radii[1] {
                return Ok(());
            }
        }
        Err(NoEquilibrium)
    }
}

impl Solution {
    /// Returns the current inner and outer radius.
    pub fn radii(&self) -> [f64; 2] {
        [self.r[0], self.r[DEGREE]]
    }

    /// Returns the strain energy over the length at rest, in E·D².
    pub fn energy(&self) -> f64 {
        let volume = self.wall.growth[0] * self.wall.growth[1];
        let nodes = Nodes::new(self.wall.radii);
        let points = nodes.points.iter().map(|point| {
            let (r, slope) = point.interpolate(&self.r);
            let (w, _) = self
                .wall
                .energy(self.wall.elastic_stretches(point.R, r, slope));
            2.0 * PI * point.R * point.weight * volume * w
        });
        points.sum()
    }

    /// Returns the Cauchy stresses outwards, around and along at the inner and at the outer radius.
    pub fn stress(&self) -> [[f64; 3]; 2] {
        let nodes = Nodes::new(self.wall.radii);
        [0, DEGREE].map(|end| {
            let slope = (0..POINTS).map(|j| nodes.slopes[end][j] * self.r[j]).sum();
            let s = self
                .wall
                .elastic_stretches(nodes.at[end], self.r[end], slope);
            let J = s[0] * s[1] * s[2];
            let (_, P) = self.wall.energy(s);
            [0, 1, 2].map(|i| P[i] * s[i] / J)
        })
    }

    /// Returns the number of negative eigenvalues of the second variation of the energy for the circumferential mode
    /// n and the axial wave number k.
    ///
    /// # Panics
    /// Under pressure with k ≠ 0: only for k = 0 is the work of the pressure that on the enclosed area.
    pub fn negative_eigenvalues(&self, n: usize, k: f64) -> usize {
        let wall = &self.wall;
        assert!(k == 0.0 || wall.pressures == [0.0; 2]);
        let [a, b] = wall.shear;
        let growth = [1.0, wall.growth[0], wall.growth[1]];
        let n = n as f64;
        // Means of cos² and sin² around and along.
        let mean = |wave: bool| if wave { [0.5, 0.5] } else { [1.0, 0.0] };
        let (around, along) = (mean(n > 0.0), mean(k > 0.0));
        let mut form = vec![vec![0.0; 3 * POINTS]; 3 * POINTS];
        let nodes = Nodes::new(wall.radii);
        for point in &nodes.points {
            let (r, slope) = point.interpolate(&self.r);
            let s = wall.elastic_stretches(point.R, r, slope);
            let (_, h, _) = wall.volume(s[0] * s[1] * s[2]);
            let A = wall.curvature(s);
            let weight = 2.0 * PI * point.R * point.weight * wall.growth[0] * wall.growth[1];
            // Amplitudes of the gradient of (f cos nφ cos kZ, g sin nφ cos kZ, w cos nφ sin kZ): rows and columns
            // (outwards, around, along).
            let gradient = |at: usize| -> [[f64; 3]; 3] {
                let (value, slope) = (point.value[at / 3], point.slope[at / 3]);
                let over = value / point.R;
                let mut H = [[0.0; 3]; 3];
                match at % 3 {
                    0 => {
                        H[0] = [slope, -n * over, -k * value];
                        H[1][1] = over;
                    }
                    1 => {
                        H[1] = [slope, n * over, -k * value];
                        H[0][1] = -over;
                    }
                    _ => H[2] = [slope, -n * over, k * value],
                }
                H.map(|row| [row[0], row[1] / growth[1], row[2] / growth[2]])
            };
            // Mean of the product of the waves of components ij.
            let mean_of = |i: usize, j: usize| {
                let sine_around = usize::from((i == 1) != (j == 1));
                let sine_along = usize::from((i == 2) != (j == 2));
                around[sine_around] * along[sine_along]
            };
            let gradients: Vec<_> = (0..3 * POINTS).map(gradient).collect();
            // Moduli of an isotropic law in the principal frame: A_iijj = ∂²w/∂s_i∂s_j, and for i ≠ j with k the third
            // A_ijij = a + b s_k² and A_ijji = −b s_i s_j + (a + 2b − h)/(s_i s_j).
            for (row, G) in gradients.iter().enumerate() {
                for (column, H) in gradients.iter().enumerate() {
                    let mut sum = 0.0;
                    for i in 0..3 {
                        for j in 0..3 {
                            sum += mean_of(i, i) * A[i][j] * G[i][i] * H[j][j];
                            if i != j {
                                let product = s[i] * s[j];
                                let same = a + b * s[3 - i - j].powi(2);
                                let crossed = (a + 2.0 * b - h) / product - b * product;
                                sum += mean_of(i, j)
                                    * (same * G[i][j] * H[i][j] + crossed * G[i][j] * H[j][i]);
                            }
                        }
                    }
                    form[row][column] += weight * sum;
                }
            }
        }
        // Second variation of the area within a circle with a wave: ½ ∮ f̂² + ĝ² + f̂ ĝ′ − ĝ f̂′.
        for (end, sign, p) in [
            (0, -1.0, wall.pressures[0]),
            (DEGREE, 1.0, wall.pressures[1]),
        ] {
            let push = 2.0 * PI * sign * p * wall.stretch;
            let (f, g) = (3 * end, 3 * end + 1);
            form[f][f] += push * around[0];
            form[g][g] += push * around[1];
            let both = 0.5 * push * n * (around[0] + around[1]);
            form[f][g] += both;
            form[g][f] += both;
        }
        negative_pivots(form)
    }
}

/// Returns the load between a stable and an unstable one at which the number of negative eigenvalues first differs
/// from zero, by bisection to a relative width of 1e-11; NaN if it is zero at `unstable` too.
///
/// # Errors
/// The error of `negative`.
pub fn critical_load<E>(
    mut stable: f64,
    mut unstable: f64,
    mut negative: impl FnMut(f64) -> Result<usize, E>,
) -> Result<f64, E> {
    if negative(unstable)? == 0 {
        return Ok(f64::NAN);
    }
    while (unstable - stable).abs() > 1e-11 * unstable.abs() {
        let middle = 0.5 * (stable + unstable);
        if negative(middle)? > 0 {
            unstable = middle;
        } else {
            stable = middle;
        }
    }
    Ok(0.5 * (stable + unstable))
}

/// Interpolation nodes and quadrature points.
struct Nodes {
    at: Vec<f64>,
    /// Slope at node i of the polynomial that is one at node j.
    slopes: Vec<Vec<f64>>,
    points: Vec<Point>,
}

/// The Lagrange polynomials at a quadrature point.
struct Point {
    R: f64,
    weight: f64,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Point {
    /// Returns r and r′ of nodal values.
    fn interpolate(&self, r: &[f64]) -> (f64, f64) {
        let sum = |of: &[f64]| of.iter().zip(r).map(|(n, r)| n * r).sum();
        (sum(&self.value), sum(&self.slope))
    }
}

impl Nodes {
    /// Creates Chebyshev points of the second kind with barycentric weights (Berrut and Trefethen 2004).
    fn new([inner, outer]: [f64; 2]) -> Self {
        let place = |x: f64| inner + 0.5 * (outer - inner) * (1.0 + x);
        let at: Vec<f64> = (0..POINTS)
            .map(|i| place(-(PI * i as f64 / DEGREE as f64).cos()))
            .collect();
        let weight = |i: usize| {
            let half = if i == 0 || i == DEGREE { 0.5 } else { 1.0 };
            if i.is_multiple_of(2) { half } else { -half }
        };
        let mut slopes = vec![vec![0.0; POINTS]; POINTS];
        for i in 0..POINTS {
            for j in (0..POINTS).filter(|&j| j != i) {
                slopes[i][j] = weight(j) / weight(i) / (at[i] - at[j]);
                slopes[i][i] -= slopes[i][j];
            }
        }
        let points = gauss(DEGREE + 6).into_iter().map(|(x, w)| {
            let R = place(x);
            let parts: Vec<f64> = (0..POINTS).map(|j| weight(j) / (R - at[j])).collect();
            let all: f64 = parts.iter().sum();
            let value: Vec<f64> = parts.iter().map(|part| part / all).collect();
            let slope = (0..POINTS)
                .map(|j| (0..POINTS).map(|i| value[i] * slopes[i][j]).sum())
                .collect();
            Point {
                R,
                weight: 0.5 * (outer - inner) * w,
                value,
                slope,
            }
        });
        Self {
            points: points.collect(),
            at,
            slopes,
        }
    }
}

/// Returns Gauss points and weights on −1 to 1, by Newton's method on the Legendre polynomial.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let legendre = |x: f64| {
        let (mut before, mut now) = (1.0, x);
        for m in 2..=count {
            let m = m as f64;
            (before, now) = (now, ((2.0 * m - 1.0) * x * now - (m - 1.0) * before) / m);
        }
        (now, count as f64 * (x * now - before) / (x * x - 1.0))
    };
    let point = |i: usize| {
        let mut x = -(PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
        for _ in 0..50 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let (_, slope) = legendre(x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(point).collect()
}

/// Solves A x = b by elimination with partial pivoting; none if A is singular.
fn solve_linear(mut A: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&j, &k| A[j][i].abs().total_cmp(&A[k][i].abs()))?;
        A.swap(i, pivot);
        b.swap(i, pivot);
        if A[i][i] == 0.0 || A[i][i].is_nan() {
            return None;
        }
        for j in i + 1..n {
            let part = A[j][i] / A[i][i];
            for k in i..n {
                A[j][k] -= part * A[i][k];
            }
            b[j] -= part * b[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| A[i][k] * b[k]).sum();
        b[i] = (b[i] - known) / A[i][i];
    }
    Some(b)
}

/// Returns the number of negative pivots of a symmetric matrix, that of its negative eigenvalues; zero rows are
/// left out.
fn negative_pivots(mut A: Vec<Vec<f64>>) -> usize {
    let n = A.len();
    let largest = (0..n).fold(0.0_f64, |most, i| most.max(A[i][i].abs()));
    let mut negative = 0;
    for i in 0..n {
        let pivot = A[i][i];
        if pivot.abs() <= 1e-300 + 1e-30 * largest {
            continue;
        }
        negative += usize::from(pivot < 0.0);
        for j in i + 1..n {
            let part = A[j][i] / pivot;
            for k in i + 1..n {
                A[j][k] -= part * A[i][k];
            }
        }
    }
    negative
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a wall with E = 1, ν = 0.495, A = 0.44 and B = 0.5.
    fn wall() -> Wall {
        Wall::new([0.44, 0.5], 0.495)
    }

    fn assert_near(computed: f64, expected: f64, tolerance: f64) {
        let error = (computed / expected - 1.0).abs();
        assert!(
            error < tolerance,
            "{computed} instead of {expected}: error {error:.1e}"
        );
    }

    #[test]
    fn small_pressure_gives_the_displacements_and_stresses_of_lame() {
        let p = 1e-6;
        let wall = Wall {
            pressures: [p, 0.0],
            ..wall()
        };
        let solution = wall.solve(1).unwrap();
        let [a, b] = solution.radii();
        assert_near((a - 0.44) / p, 2.93835994, 3e-5);
        assert_near((b - 0.5) / p, 2.59154539, 3e-5);
        let [inner, outer] = solution.stress();
        assert_near(inner[1] / p, 7.86524823, 3e-5);
        assert_near(outer[1] / p, 6.86524823, 3e-5);
        assert_near(inner[2] / p, 3.39829787, 3e-5);
    }

    #[test]
    fn inflation_and_growth_agree_with_independent_codes() {
        for (p, b, [at_a, at_b]) in [
            (0.0122352033, 0.5391973105, [0.11511727, 0.10041075]),
            (0.0329557773, 0.7016189198, [0.56679648, 0.48463349]),
        ] {
            let wall = Wall {
                pressures: [p, 0.0],
                ..wall()
            };
            let solution = wall.solve(8).unwrap();
            assert_near(solution.radii()[1], b, 3e-9);
            assert_near(solution.stress()[0][1], at_a, 1e-7);
            assert_near(solution.stress()[1][1], at_b, 1e-7);
        }
        for (g, a, b, W, at_a) in [
            (0.75, 0.3227579338, 0.3827173371, 1.32551829e-5, -0.02939486),
            (0.5, 0.2058835933, 0.2656827340, 7.91898869e-5, -0.08803335),
        ] {
            let wall = Wall {
                growth: [g, 1.0],
                ..wall()
            };
            let solution = wall.solve(8).unwrap();
            assert_near(solution.radii()[0], a, 1e-9);
            assert_near(solution.radii()[1], b, 1e-9);
            assert_near(solution.energy(), W, 1e-8);
            assert_near(solution.stress()[0][1], at_a, 1e-6);
        }
    }

    #[test]
    fn buckling_loads_agree_with_independent_codes() {
        let negative_under_pressure = |n: usize, p: f64| {
            let wall = Wall {
                pressures: [0.0, p],
                ..wall()
            };
            wall.solve(1)
                .map(|solution| solution.negative_eigenvalues(n, 0.0))
        };
        for (n, p) in [(2, 6.94351e-4), (3, 1.883913e-3)] {
            let found = critical_load(0.0, 2.0 * p, |p| negative_under_pressure(n, p)).unwrap();
            assert_near(found, p, 1e-6);
        }
        let negative_when_shortened = |n: usize, m: usize, strain: f64| {
            let wall = Wall {
                stretch: 1.0 - strain,
                ..wall()
            };
            let k = PI * m as f64 / 3.0;
            wall.solve(1)
                .map(|solution| solution.negative_eigenvalues(n, k))
        };
        for (n, m, strain) in [(2, 2, 0.0552884), (0, 9, 0.0805741), (3, 5, 0.0762781)] {
            let found = critical_load(0.0, 1.5 * strain, |strain| {
                negative_when_shortened(n, m, strain)
            })
            .unwrap();
            assert_near(found, strain, 2e-6);
        }
    }
}
