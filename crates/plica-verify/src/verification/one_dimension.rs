//! The reference side: a tube whose every cross-section is a circle is a function r(R), and the waves
//! that may grow on it are three more. Both in one polynomial of high degree through the wall.
//!
//! Nothing of the rest of the library is used here: no spline, no kernel, no law, no solver. A mistake
//! would have to be made twice to stay unseen.
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | A, B | inner and outer radius at rest | D |
//! | r(R) | radius of what was at R | D |
//! | ℓ | axial stretch, the same everywhere | – |
//! | θη, θζ | grown stretches around and along | – |
//! | p | true pressure on the inner and the outer wall | E |
//! | n, k | waves around; wave number along, π over the length of half a wave | –, 1/D |

use std::f64::consts::PI;

/// Degree of the polynomial.
const DEGREE: usize = 16;
/// Points through the wall.
const POINTS: usize = DEGREE + 1;
/// Newton's steps, of which ten are many.
const STEPS: usize = 60;

/// How the wall resists a change of volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Resistance {
    /// λ/2 (ln J)².
    #[default]
    Logarithm,
    /// λ/4 (J² − 1 − 2 ln J).
    Square,
}

/// A wall under a load, from radius to radius.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// A and B.
    pub radii: [f64; 2],
    /// Young's modulus and Poisson's ratio.
    pub elastic: [f64; 2],
    /// What resists a change of volume.
    pub resistance: Resistance,
    /// ℓ.
    pub stretch: f64,
    /// θη and θζ.
    pub grown: [f64; 2],
    /// On the inner and the outer wall.
    pub pressures: [f64; 2],
}

/// A wall in equilibrium.
#[derive(Clone, Debug)]
pub struct Balanced {
    wall: Wall,
    /// r at the nodes.
    r: Vec<f64>,
}

/// No equilibrium was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the one-dimensional wall finds no equilibrium")]
pub struct Unbalanced;

impl Wall {
    /// At rest, E = 1.
    pub fn new(radii: [f64; 2], poisson_ratio: f64) -> Self {
        Self {
            radii,
            elastic: [1.0, poisson_ratio],
            resistance: Resistance::Logarithm,
            stretch: 1.0,
            grown: [1.0; 2],
            pressures: [0.0; 2],
        }
    }

    /// λ and μ.
    fn lame(&self) -> (f64, f64) {
        let [E, nu] = self.elastic;
        (
            E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            E / (2.0 * (1.0 + nu)),
        )
    }

    /// U, J U′ and J (J U′)′ at J.
    fn volume(&self, J: f64) -> (f64, f64, f64) {
        let (lambda, _) = self.lame();
        match self.resistance {
            Resistance::Logarithm => {
                let ln = J.ln();
                (0.5 * lambda * ln * ln, lambda * ln, lambda)
            }
            Resistance::Square => (
                0.25 * lambda * (J * J - 1.0 - 2.0 * J.ln()),
                0.5 * lambda * (J * J - 1.0),
                lambda * J * J,
            ),
        }
    }

    /// Elastic stretches outwards, around and along, of r and r′ at R.
    fn elastic_stretches(&self, R: f64, r: f64, slope: f64) -> [f64; 3] {
        [slope, r / (R * self.grown[0]), self.stretch / self.grown[1]]
    }

    /// w and its slopes over the elastic stretches.
    fn energy(&self, s: [f64; 3]) -> (f64, [f64; 3]) {
        let (_, mu) = self.lame();
        let J = s[0] * s[1] * s[2];
        let (U, h, _) = self.volume(J);
        let shape: f64 = s.iter().map(|s| s * s - 1.0).sum();
        let w = 0.5 * mu * shape - mu * J.ln() + U;
        (w, s.map(|s| mu * s + (h - mu) / s))
    }

    /// ∂²w over the elastic stretches.
    fn curvature(&self, s: [f64; 3]) -> [[f64; 3]; 3] {
        let (_, mu) = self.lame();
        let (_, h, q) = self.volume(s[0] * s[1] * s[2]);
        let entry = |i: usize, j: usize| {
            let own = if i == j {
                mu + (mu - h) / (s[i] * s[i])
            } else {
                0.0
            };
            own + q / (s[i] * s[j])
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }

    /// In equilibrium, by Newton from rest. Large loads are reached in steps.
    ///
    /// # Errors
    /// [`Unbalanced`] where there is none, or it is too far.
    pub fn balance(&self, steps: usize) -> Result<Balanced, Unbalanced> {
        let nodes = Nodes::new(self.radii);
        let mut r = nodes.at.clone();
        for step in 1..=steps {
            let t = step as f64 / steps as f64;
            let part = Self {
                stretch: 1.0 + t * (self.stretch - 1.0),
                grown: self.grown.map(|g| 1.0 + t * (g - 1.0)),
                pressures: self.pressures.map(|p| t * p),
                ..*self
            };
            part.newton(&nodes, &mut r)?;
        }
        Ok(Balanced { wall: *self, r })
    }

    fn newton(&self, nodes: &Nodes, r: &mut [f64]) -> Result<(), Unbalanced> {
        let grown = self.grown[0] * self.grown[1];
        for _ in 0..STEPS {
            let mut force = vec![0.0; POINTS];
            let mut stiffness = vec![vec![0.0; POINTS]; POINTS];
            for point in &nodes.points {
                let (value, slope) = point.read(r);
                let s = self.elastic_stretches(point.R, value, slope);
                let (_, P) = self.energy(s);
                let A = self.curvature(s);
                let weight = 2.0 * PI * point.R * point.weight * grown;
                let around = 1.0 / (point.R * self.grown[0]);
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
            // Π − p π r(A)² ℓ, and the other way outside.
            for (end, sign, p) in [
                (0, -1.0, self.pressures[0]),
                (DEGREE, 1.0, self.pressures[1]),
            ] {
                let push = 2.0 * PI * sign * p * self.stretch;
                force[end] += push * r[end];
                stiffness[end][end] += push;
            }
            let step = solve(stiffness, force).ok_or(Unbalanced)?;
            let size = step.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            // No further than a tenth of the radius at once.
            let part = (0.1 * self.radii[0] / size).min(1.0);
            for (r, step) in r.iter_mut().zip(&step) {
                *r -= part * step;
            }
            if !size.is_finite() {
                return Err(Unbalanced);
            }
            if size < 1e-13 * self.radii[1] {
                return Ok(());
            }
        }
        Err(Unbalanced)
    }
}

impl Balanced {
    /// r at A and at B.
    pub fn radii(&self) -> [f64; 2] {
        [self.r[0], self.r[DEGREE]]
    }

    /// W over the length at rest, in E·D².
    pub fn energy(&self) -> f64 {
        let grown = self.wall.grown[0] * self.wall.grown[1];
        let nodes = Nodes::new(self.wall.radii);
        let points = nodes.points.iter().map(|point| {
            let (r, slope) = point.read(&self.r);
            let (w, _) = self
                .wall
                .energy(self.wall.elastic_stretches(point.R, r, slope));
            2.0 * PI * point.R * point.weight * grown * w
        });
        points.sum()
    }

    /// Cauchy stress outwards, around and along at A and at B.
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

    /// How many ways there are for a wave n around and k along to lower the energy: the negative
    /// eigenvalues of the second variation. Under pressure only for k = 0, where the area that it encloses
    /// tells its work; panics else.
    pub fn negative(&self, n: usize, k: f64) -> usize {
        let wall = &self.wall;
        assert!(k == 0.0 || wall.pressures == [0.0; 2]);
        let (_, mu) = wall.lame();
        let grown = [1.0, wall.grown[0], wall.grown[1]];
        let n = n as f64;
        // Means of cos² and sin² around and along.
        let mean = |wave: bool| if wave { [0.5, 0.5] } else { [1.0, 0.0] };
        let (around, along) = (mean(n > 0.0), mean(k > 0.0));
        let mut form = vec![vec![0.0; 3 * POINTS]; 3 * POINTS];
        let nodes = Nodes::new(wall.radii);
        for point in &nodes.points {
            let (r, slope) = point.read(&self.r);
            let s = wall.elastic_stretches(point.R, r, slope);
            let (_, h, q) = wall.volume(s[0] * s[1] * s[2]);
            let weight = 2.0 * PI * point.R * point.weight * wall.grown[0] * wall.grown[1];
            // Gradient of (f cos nφ cos kZ, g sin nφ cos kZ, w cos nφ sin kZ), amplitudes only: rows
            // and columns (outwards, around, along).
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
                H.map(|row| [row[0], row[1] / grown[1], row[2] / grown[2]])
            };
            // cos or sin of each component, around and along.
            let share = |i: usize, j: usize| {
                let sine_around = usize::from((i == 1) != (j == 1));
                let sine_along = usize::from((i == 2) != (j == 2));
                around[sine_around] * along[sine_along]
            };
            let gradients: Vec<_> = (0..3 * POINTS).map(gradient).collect();
            for (a, G) in gradients.iter().enumerate() {
                for (b, H) in gradients.iter().enumerate() {
                    let mut sum = 0.0;
                    let (mut trace_G, mut trace_H) = (0.0, 0.0);
                    for i in 0..3 {
                        trace_G += G[i][i] / s[i];
                        trace_H += H[i][i] / s[i];
                        for j in 0..3 {
                            sum += share(i, j)
                                * (mu * G[i][j] * H[i][j]
                                    + (mu - h) * G[i][j] * H[j][i] / (s[i] * s[j]));
                        }
                    }
                    sum += share(0, 0) * q * trace_G * trace_H;
                    form[a][b] += weight * sum;
                }
            }
        }
        // The area within a circle with a wave on it: ½ ∮ f̂² + ĝ² + f̂ ĝ′ − ĝ f̂′ beyond first order.
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

/// Where a count first differs from none between two numbers, to the last digits; not a number where it
/// is none at the second, too.
pub fn first<E>(
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

/// The polynomial's nodes, and where it is integrated.
struct Nodes {
    at: Vec<f64>,
    /// Slope at node i of the polynomial that is one at node j.
    slopes: Vec<Vec<f64>>,
    points: Vec<Place>,
}

/// The polynomials at a point.
struct Place {
    R: f64,
    weight: f64,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Place {
    fn read(&self, r: &[f64]) -> (f64, f64) {
        let sum = |of: &[f64]| of.iter().zip(r).map(|(n, r)| n * r).sum();
        (sum(&self.value), sum(&self.slope))
    }
}

impl Nodes {
    /// Chebyshev's points, ends among them, and barycentric weights (Berrut and Trefethen 2004).
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
            Place {
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

/// Gauss's points and weights on −1 to 1, by Newton on Legendre's polynomial.
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

/// x of A x = b, by elimination with the largest pivots of columns; none if A is singular.
fn solve(mut A: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
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

/// Negative pivots of a symmetric matrix, its negative eigenvalues; a row of zeros is left out.
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

    /// E = 1, ν = 0.495, from 0.44 to 0.5.
    fn wall() -> Wall {
        Wall::new([0.44, 0.5], 0.495)
    }

    fn near(found: f64, expected: f64, digits: f64) {
        let off = (found / expected - 1.0).abs();
        assert!(off < digits, "{found} not {expected}: off by {off:.1e}");
    }

    #[test]
    fn lame_s_displacements_and_stresses() {
        let p = 1e-6;
        let wall = Wall {
            pressures: [p, 0.0],
            ..wall()
        };
        let balanced = wall.balance(1).unwrap();
        let [a, b] = balanced.radii();
        near((a - 0.44) / p, 2.93835994, 3e-5);
        near((b - 0.5) / p, 2.59154539, 3e-5);
        let [inner, outer] = balanced.stress();
        near(inner[1] / p, 7.86524823, 3e-5);
        near(outer[1] / p, 6.86524823, 3e-5);
        near(inner[2] / p, 3.39829787, 3e-5);
    }

    #[test]
    fn inflation_and_growth_as_others_found_them() {
        for (p, b, [at_a, at_b]) in [
            (0.0122352033, 0.5391973105, [0.11511727, 0.10041075]),
            (0.0329557773, 0.7016189198, [0.56679648, 0.48463349]),
        ] {
            let wall = Wall {
                pressures: [p, 0.0],
                ..wall()
            };
            let balanced = wall.balance(8).unwrap();
            near(balanced.radii()[1], b, 3e-9);
            near(balanced.stress()[0][1], at_a, 1e-7);
            near(balanced.stress()[1][1], at_b, 1e-7);
        }
        for (g, a, b, W, at_a) in [
            (0.75, 0.3227579338, 0.3827173371, 1.32551829e-5, -0.02939486),
            (0.5, 0.2058835933, 0.2656827340, 7.91898869e-5, -0.08803335),
        ] {
            let wall = Wall {
                grown: [g, 1.0],
                ..wall()
            };
            let balanced = wall.balance(8).unwrap();
            near(balanced.radii()[0], a, 1e-9);
            near(balanced.radii()[1], b, 1e-9);
            near(balanced.energy(), W, 1e-8);
            near(balanced.stress()[0][1], at_a, 1e-6);
        }
    }

    #[test]
    fn buckling_as_others_found_it() {
        let pressed = |n: usize, p: f64| {
            let wall = Wall {
                pressures: [0.0, p],
                ..wall()
            };
            wall.balance(1).map(|balanced| balanced.negative(n, 0.0))
        };
        for (n, p) in [(2, 6.94351e-4), (3, 1.883913e-3)] {
            let found = first(0.0, 2.0 * p, |p| pressed(n, p)).unwrap();
            near(found, p, 1e-6);
        }
        let shortened = |n: usize, m: usize, strain: f64| {
            let wall = Wall {
                stretch: 1.0 - strain,
                ..wall()
            };
            let k = PI * m as f64 / 3.0;
            wall.balance(1).map(|balanced| balanced.negative(n, k))
        };
        for (n, m, strain) in [(2, 2, 0.0552884), (0, 9, 0.0805741), (3, 5, 0.0762781)] {
            let found = first(0.0, 1.5 * strain, |strain| shortened(n, m, strain)).unwrap();
            near(found, strain, 2e-6);
        }
    }
}
