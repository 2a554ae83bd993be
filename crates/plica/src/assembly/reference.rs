//! The kernel's plain twin, which tests hold it against: the whole tube in Cartesian control
//! points, one quadrature point after the other, every formula from its definition.
//!
//! It shares with the kernel the splines along z and through the wall, the quadrature rule, the law and
//! the control values of an imperfect geometry, which have tests of their own, and nothing else. Control point n = (a, c, j) lies at
//! row a along the tube, point c through the wall, ring j around it.

use super::SplineTube;
use crate::material::{Law, Material};
use crate::spline::gauss_legendre;
use crate::tensor::Tensor2;
use crate::tube::Load;
use std::f64::consts::TAU;

type Vector = [f64; 3];

/// A whole tube under a load.
pub struct ReferenceTube<'a> {
    spline: &'a SplineTube,
    load: &'a Load,
    /// δ of the control points of an imperfect geometry.
    shape: Option<Vec<Vector>>,
}

/// The splines of an element at a point of it.
pub struct ElementPoint {
    /// N_n, one per control point of the element.
    pub value: Vec<f64>,
    /// ∂N_n/∂X.
    gradient: Vec<Vector>,
    /// Reference position X.
    pub reference: Vector,
    /// Volume of the stress-free shape per unit of (z, R, s).
    volume: f64,
    /// Unit vectors along, outwards and around at X, as columns; turned with an imperfect wall.
    pub polar: Tensor2,
    /// A⁻¹ (R Fp Rᵀ)⁻¹: strain is measured from X + δ(X), with A = ∂(X + δ)/∂X, and the directions of
    /// Fp have turned by the rotation R nearest A. Both are one in a perfect tube.
    Fp_inverse: Tensor2,
    /// det Fp.
    growth: f64,
}

/// Energy and residual.
pub struct ReferenceForces {
    /// ∫ w det Fp dV₀, in E·D³.
    pub energy: f64,
    /// ∫ w dV₀, in E·D³.
    pub energy_ungrown: f64,
    /// R, numbered as the unknowns of the tube, in E·D².
    pub residual: Vec<f64>,
    /// Root of the sum of squares of what the elements add to the residual.
    pub residual_scale: f64,
}

impl<'a> ReferenceTube<'a> {
    /// The plain twin of a tube whose sector is the whole circumference.
    pub fn new(spline: &'a SplineTube, load: &'a Load) -> Self {
        assert_eq!(spline.sector.rings, spline.sector.around);
        let perfect = Self {
            spline,
            load,
            shape: None,
        };
        let shape = spline.geometric_imperfection();
        Self {
            shape: shape.map(|delta| perfect.cartesian(delta)),
            ..perfect
        }
    }

    /// The law of its wall.
    pub(super) fn law(&self) -> &Material {
        &self.spline.tube.material
    }

    /// Rings, and control points through the wall.
    fn shape(&self) -> [usize; 2] {
        [self.spline.sector.around, self.spline.wall.functions()]
    }

    fn nodes(&self) -> usize {
        let [rings, points] = self.shape();
        self.spline.axial.functions() * points * rings
    }

    /// Unit vectors (axial, radial, circumferential) at the ring of a control point.
    fn ring_frame(&self, node: usize) -> [Vector; 3] {
        let [rings, _] = self.shape();
        // Element 0 is centred on angle zero; its p + 1 rings lie evenly about its middle.
        let phi = ((node % rings) as f64 - 0.5 * self.spline.degree() as f64) * TAU / rings as f64;
        let (sin, cos) = phi.sin_cos();
        [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]
    }

    /// Reference position (z, x, y) of a control point.
    pub fn control_point(&self, node: usize) -> Vector {
        let [rings, points] = self.shape();
        let z = self.spline.axial.greville()[node / (rings * points)];
        let r = self.spline.wall.greville()[node / rings % points];
        let [_, outwards, _] = self.ring_frame(node);
        let r = r * self.spline.circle.control_radius;
        [z, r * outwards[1], r * outwards[2]]
    }

    /// Where a component of a control point is numbered among the unknowns of the tube.
    fn unknown(&self, node: usize, component: usize) -> usize {
        let [rings, _] = self.shape();
        (node / rings * 3 + component) * rings + node % rings
    }

    /// Cartesian vectors of control points from unknowns of the tube.
    pub fn cartesian(&self, u: &[f64]) -> Vec<Vector> {
        let vector = |node| {
            let frame = self.ring_frame(node);
            [0, 1, 2].map(|x| {
                (0..3)
                    .map(|i| frame[i][x] * u[self.unknown(node, i)])
                    .sum::<f64>()
            })
        };
        (0..self.nodes()).map(vector).collect()
    }

    /// Unknowns of the tube from Cartesian vectors of control points.
    pub fn cylindrical(&self, vectors: &[Vector]) -> Vec<f64> {
        let mut u = vec![0.0; 3 * vectors.len()];
        for (node, v) in vectors.iter().enumerate() {
            for (i, unit) in self.ring_frame(node).iter().enumerate() {
                u[self.unknown(node, i)] = dot(unit, v);
            }
        }
        u
    }

    /// Elements along the tube, through the wall and around it.
    fn elements(&self) -> Vec<[usize; 3]> {
        let (along, through) = (self.spline.axial.elements(), self.spline.wall.elements());
        let mut elements = vec![];
        for e in 0..along {
            for t in 0..through {
                elements.extend((0..self.shape()[0]).map(|g| [e, t, g]));
            }
        }
        elements
    }

    /// The control points of an element.
    pub fn element_nodes(&self, [e, t, g]: [usize; 3]) -> Vec<usize> {
        let ([rings, points], p) = (self.shape(), self.spline.degree());
        let mut nodes = vec![];
        for a in e..=e + p {
            for c in t..=t + p {
                nodes.extend((g..=g + p).map(|j| (a * points + c) * rings + j % rings));
            }
        }
        nodes
    }

    /// The splines of an element at (z, R) and the fraction s around it.
    pub fn at(&self, element: [usize; 3], z: f64, radius: f64, s: f64) -> ElementPoint {
        let (spline, p) = (self.spline, self.spline.degree());
        let axial = spline.axial.evaluate_in(element[0], z);
        let wall = spline.wall.evaluate_in(element[1], radius);
        let mut value = vec![];
        let mut over = vec![]; // ∂N/∂(z, R, s)
        for a in 0..=p {
            for c in 0..=p {
                for b in 0..=p {
                    // On the element [0, 1] function b is the cardinal spline of [b − p, b + 1].
                    let x = s + (p - b) as f64;
                    let n = cardinal(p, x);
                    let dn = cardinal(p - 1, x) - cardinal(p - 1, x - 1.0);
                    value.push(axial.value[a] * wall.value[c] * n);
                    over.push([
                        axial.slope[a] * wall.value[c] * n,
                        axial.value[a] * wall.slope[c] * n,
                        axial.value[a] * wall.value[c] * dn,
                    ]);
                }
            }
        }

        let (mut reference, mut D) = ([0.0; 3], [[0.0; 3]; 3]); // X, ∂X/∂(z, R, s)
        for (k, node) in self.element_nodes(element).into_iter().enumerate() {
            let X = self.control_point(node);
            for i in 0..3 {
                reference[i] += value[k] * X[i];
                for alpha in 0..3 {
                    D[i][alpha] += X[i] * over[k][alpha];
                }
            }
        }
        let D = Tensor2(D);
        let volume = D.determinant();
        let G = D.cofactor().scaled(1.0 / volume); // D⁻ᵀ
        let gradient: Vec<Vector> = over.iter().map(|d| apply(&G, d)).collect();

        let [_, x, y] = reference;
        let (cos, sin) = (x / x.hypot(y), y / x.hypot(y));
        let polar = Tensor2([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]]);
        let (theta_z, theta_t) = spline.tube.stretches(z, self.load);
        let shrink = Tensor2([
            [1.0 / theta_z, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0 / theta_t],
        ]);
        let mut A = Tensor2::IDENTITY;
        if let Some(delta) = &self.shape {
            for (&node, gradient) in self.element_nodes(element).iter().zip(&gradient) {
                for i in 0..3 {
                    for j in 0..3 {
                        A.0[i][j] += delta[node][i] * gradient[j];
                    }
                }
            }
        }
        let directions = rotation(&A).times(polar);
        let A_inverse = A.cofactor().transpose().scaled(1.0 / A.determinant());
        let shrink = directions.times(shrink).times(directions.transpose());
        ElementPoint {
            value,
            gradient,
            reference,
            volume: volume * A.determinant(),
            polar: directions,
            Fp_inverse: A_inverse.times(shrink),
            growth: theta_z * theta_t,
        }
    }

    /// The quadrature points of an element with their weighted dV₀.
    fn quadrature(&self, element: [usize; 3]) -> Vec<(ElementPoint, f64)> {
        let rule = gauss_legendre(self.spline.degree() + 1);
        let (z0, z1) = self.spline.axial.element(element[0]);
        let (r0, r1) = self.spline.wall.element(element[1]);
        let mut points = vec![];
        for &(z, wz) in &rule {
            for &(r, wr) in &rule {
                for &(s, ws) in &rule {
                    let at = self.at(element, z0 + (z1 - z0) * z, r0 + (r1 - r0) * r, s);
                    let volume = wz * (z1 - z0) * wr * (r1 - r0) * ws * at.volume;
                    points.push((at, volume));
                }
            }
        }
        points
    }

    /// Fe = F Fp⁻¹ with F = I + Σ u_n ⊗ ∂N_n/∂X.
    pub fn elastic(&self, nodes: &[usize], at: &ElementPoint, u: &[Vector]) -> Tensor2 {
        let mut F = Tensor2::IDENTITY;
        for (&node, gradient) in nodes.iter().zip(&at.gradient) {
            for i in 0..3 {
                for j in 0..3 {
                    F.0[i][j] += u[node][i] * gradient[j];
                }
            }
        }
        F.times(at.Fp_inverse)
    }

    /// W = ∫ w det Fp dV₀ and R = ∫ P Fp⁻ᵀ ∂N/∂X det Fp dV₀.
    pub fn forces(&self, u: &[f64]) -> ReferenceForces {
        let (law, u) = (self.law(), self.cartesian(u));
        let (mut energy, mut energy_ungrown, mut squares) = (0.0, 0.0, 0.0);
        let mut residual = vec![[0.0; 3]; self.nodes()];
        for element in self.elements() {
            let nodes = self.element_nodes(element);
            let mut force = vec![[0.0; 3]; nodes.len()];
            for (at, volume) in self.quadrature(element) {
                let Fe = self.elastic(&nodes, &at, &u);
                let w = law.energy(&Fe);
                energy += w * at.growth * volume;
                energy_ungrown += w * volume;
                let P = law.stress(&Fe).times(at.Fp_inverse.transpose());
                for (f, gradient) in force.iter_mut().zip(&at.gradient) {
                    let df = apply(&P, gradient);
                    for i in 0..3 {
                        f[i] += df[i] * at.growth * volume;
                    }
                }
            }
            for (&node, f) in nodes.iter().zip(&force) {
                squares += dot(f, f);
                for i in 0..3 {
                    residual[node][i] += f[i];
                }
            }
        }
        ReferenceForces {
            energy,
            energy_ungrown,
            residual: self.cylindrical(&residual),
            residual_scale: squares.sqrt(),
        }
    }

    /// K = ∫ Bᵀ A B det Fp dV₀, dense, row after row.
    pub fn tangent(&self, u: &[f64]) -> Vec<f64> {
        let (law, u) = (self.law(), self.cartesian(u));
        let mut K = vec![0.0; 9 * self.nodes() * self.nodes()];
        for element in self.elements() {
            let nodes = self.element_nodes(element);
            let n = nodes.len();
            let mut Ke = vec![[[0.0; 3]; 3]; n * n];
            for (at, volume) in self.quadrature(element) {
                let A = full(law, &self.elastic(&nodes, &at, &u));
                let Fp_inverse_transposed = at.Fp_inverse.transpose();
                let h: Vec<Vector> = at
                    .gradient
                    .iter()
                    .map(|g| apply(&Fp_inverse_transposed, g))
                    .collect();
                for b in 0..n {
                    // D_{ikj} = A_{ik jl} h_l
                    let mut D = [[[0.0; 3]; 3]; 3];
                    for i in 0..3 {
                        for k in 0..3 {
                            for j in 0..3 {
                                D[i][k][j] = dot(&A[i][k][j], &h[b]) * at.growth * volume;
                            }
                        }
                    }
                    for a in 0..=b {
                        for i in 0..3 {
                            for j in 0..3 {
                                Ke[a * n + b][i][j] += h[a][0] * D[i][0][j]
                                    + h[a][1] * D[i][1][j]
                                    + h[a][2] * D[i][2][j];
                            }
                        }
                    }
                }
            }
            for b in 0..n {
                for a in 0..=b {
                    self.add_block(&mut K, [nodes[a], nodes[b]], Ke[a * n + b]);
                    if a != b {
                        let transposed = Tensor2(Ke[a * n + b]).transpose().0;
                        self.add_block(&mut K, [nodes[b], nodes[a]], transposed);
                    }
                }
            }
        }
        K
    }

    /// C = ∫ N N dV₀, dense, row after row.
    pub fn damping(&self) -> Vec<f64> {
        let mut C = vec![0.0; 9 * self.nodes() * self.nodes()];
        for element in self.elements() {
            let nodes = self.element_nodes(element);
            let points = self.quadrature(element);
            for (a, &row) in nodes.iter().enumerate() {
                for (b, &column) in nodes.iter().enumerate() {
                    let sum: f64 = points
                        .iter()
                        .map(|(at, volume)| at.value[a] * at.value[b] * volume)
                        .sum();
                    let block = Tensor2::IDENTITY.scaled(sum).0;
                    self.add_block(&mut C, [row, column], block);
                }
            }
        }
        C
    }

    /// Adds a Cartesian block for two control points to a dense matrix over the tube's unknowns.
    fn add_block(&self, matrix: &mut [f64], nodes: [usize; 2], block: [Vector; 3]) {
        let width = 3 * self.nodes();
        let [left, right] = nodes.map(|node| self.ring_frame(node));
        for i in 0..3 {
            for j in 0..3 {
                let at = self.unknown(nodes[0], i) * width + self.unknown(nodes[1], j);
                matrix[at] += dot(&left[i], &apply(&Tensor2(block), &right[j]));
            }
        }
    }
}

/// The rotation nearest A: A U⁻¹ with U² = AᵀA, in the principal directions of U.
fn rotation(A: &Tensor2) -> Tensor2 {
    let C = A.transpose().times(*A);
    let dense = faer::Mat::from_fn(3, 3, |i, j| C.0[i][j]);
    let eigen = dense.self_adjoint_eigen(faer::Side::Lower).unwrap();
    let (Q, squares) = (eigen.U(), eigen.S().column_vector());
    let mut U_inverse = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            U_inverse[i][j] = (0..3)
                .map(|k| Q[(i, k)] * Q[(j, k)] / squares[k].sqrt())
                .sum();
        }
    }
    A.times(Tensor2(U_inverse))
}

/// The cardinal B-spline of degree p, on the knots 0, 1, …, p + 1.
fn cardinal(p: usize, x: f64) -> f64 {
    if p == 0 {
        return f64::from((0.0..1.0).contains(&x));
    }
    let (below, above) = (cardinal(p - 1, x), cardinal(p - 1, x - 1.0));
    (x * below + (p as f64 + 1.0 - x) * above) / p as f64
}

/// A_{ik jl} = ∂²w/∂F_{ik}∂F_{jl}, from the half that a law fills.
fn full(law: &Material, Fe: &Tensor2) -> [[[[f64; 3]; 3]; 3]; 3] {
    let half = law.moduli(Fe);
    let mut A = [[[[0.0; 3]; 3]; 3]; 3];
    for i in 0..3 {
        for k in 0..3 {
            for j in 0..3 {
                for l in 0..3 {
                    let (ik, jl) = (3 * k + i, 3 * l + j);
                    A[i][k][j][l] = if k <= l { half[ik][jl] } else { half[jl][ik] };
                }
            }
        }
    }
    A
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn apply(T: &Tensor2, v: &Vector) -> Vector {
    T.0.map(|row| dot(&row, v))
}
