//! Reference implementation of the element. Start here to understand the method.
//!
//! The wall is a tensor product of splines: open B-splines along z and through the radius R, uniform
//! periodic ones around. Their control points carry displacements u_a. In Cartesian coordinates,
//! with the stretches θζ, θη of the muscles (Okino et al. 2025, Eqs. (1)–(12)):
//!
//! - position X = Σ N_a X_a, displacement u = Σ N_a u_a, F = I + Σ u_a ⊗ ∇N_a, ∇ = ∂/∂X;
//! - growth Fp = θζ e_z ⊗ e_z + e_R ⊗ e_R + θη e_θ ⊗ e_θ, elastic part Fe = F Fp⁻¹ = Fp⁻¹ + Σ u_a ⊗ h_a
//!   with h_a = Fp⁻ᵀ ∇N_a;
//! - energy W = ∫ w(Fe) det Fp dV, with stress P = ∂w/∂Fe and moduli A = ∂P/∂Fe;
//! - residual R_a = ∂W/∂u_a = ∫ P h_a det Fp dV;
//! - tangent K_ab = ∂R_a/∂u_b = ∫ h_a · A · h_b det Fp dV;
//! - damping matrix C_ab = ∫ N_a N_b dV.
//!
//! The kernels of [`SplineTube`] give the same numbers: they work in the rotated frame of each
//! element, factorise the sums over a, and evaluate eight elements at once. Tests compare them with
//! this file, which shares with them the splines along z and R, the Gauss rule, the laws and the
//! control values of an imperfect geometry. Pressures and reduced integration are not here.
//!
//! Cartesian vectors are (z, x, y). Control point (i, c, j), the i-th along the tube, c-th through
//! the wall and j-th around, has the number (i · points through + c) · rings + j.

use super::SplineTube;
use crate::material::{Composite, Law, Material};
use crate::spline::gauss_legendre;
use crate::tensor::Tensor2;
use crate::tube::Load;
use std::f64::consts::TAU;

type Vector = [f64; 3];

/// A whole tube under a load, by the reference implementation.
pub struct ReferenceTube<'a> {
    spline: &'a SplineTube,
    load: &'a Load,
    /// Displacements δ_a from the perfect tube to the stress-free shape, where they differ.
    imperfection: Option<Vec<Vector>>,
}

/// Energy and residual of the wall.
pub struct ReferenceForces {
    /// ∫ w det Fp dV, in E·D³.
    pub energy: f64,
    /// ∫ w dV, in E·D³.
    pub energy_ungrown: f64,
    /// R, numbered as the unknowns of the tube, in E·D².
    pub residual: Vec<f64>,
    /// Root of the sum of squares of the contributions of the elements to R.
    pub residual_scale: f64,
}

/// An element at a point X.
pub(super) struct ElementPoint {
    /// N_a, one per control point of the element.
    pub(super) value: Vec<f64>,
    /// h_a = Fp⁻ᵀ ∇N_a.
    h: Vec<Vector>,
    /// dV per unit of (z, R, s), s the fraction of the element around.
    volume: f64,
    /// Volume free of residual stretch over dV, times the factor on the energy of each law: that of patches, and tensions.
    factors: Vec<f64>,
    /// Fp⁻¹; of an imperfect tube B⁻¹ Fp⁻¹, see [`ReferenceTube::at`]. Its columns are directions of the wall (along,
    /// outwards, around), to which laws with fibres refer.
    Fp_inverse: Tensor2,
    /// det Fp.
    growth: f64,
}

impl<'a> ReferenceTube<'a> {
    /// Takes over the splines of a tube.
    ///
    /// # Panics
    /// Unless all rings of the mesh are solved for.
    pub fn new(spline: &'a SplineTube, load: &'a Load) -> Self {
        assert_eq!(spline.sector.rings, spline.sector.around);
        let perfect = Self {
            spline,
            load,
            imperfection: None,
        };
        let delta = spline.geometric_imperfection();
        Self {
            imperfection: delta.map(|delta| perfect.cartesian(delta)),
            ..perfect
        }
    }

    /// Computes energy and residual at displacements `u`, unknowns of the tube.
    pub fn forces(&self, u: &[f64]) -> ReferenceForces {
        let u = self.cartesian(u);
        let (mut energy, mut energy_ungrown, mut squares) = (0.0, 0.0, 0.0);
        let mut R = vec![[0.0; 3]; self.nodes()];
        for element in self.elements() {
            let (nodes, points) = (self.element_nodes(element), self.quadrature(element));
            for (k, law) in self.laws(element).iter().enumerate() {
                let mut Re = vec![[0.0; 3]; nodes.len()];
                for (q, dV) in &points {
                    let dV = dV * q.factors[k];
                    let Fe = self.elastic(&nodes, q, &u);
                    let (w, P) = (law.energy(&Fe), law.stress(&Fe));
                    let grown = q.growth * dV; // det Fp dV
                    energy += w * grown;
                    energy_ungrown += w * dV;
                    for (Ra, h) in Re.iter_mut().zip(&q.h) {
                        let Ph = apply(&P, h);
                        for i in 0..3 {
                            Ra[i] += Ph[i] * grown; // δu ⊗ h : P
                        }
                    }
                }
                for (&a, Ra) in nodes.iter().zip(&Re) {
                    squares += dot(Ra, Ra);
                    for i in 0..3 {
                        R[a][i] += Ra[i];
                    }
                }
            }
        }
        ReferenceForces {
            energy,
            energy_ungrown,
            residual: self.cylindrical(&R),
            residual_scale: squares.sqrt(),
        }
    }

    /// Computes the tangent K at displacements `u`, dense, row after row.
    pub fn tangent(&self, u: &[f64]) -> Vec<f64> {
        let u = self.cartesian(u);
        let mut K = vec![0.0; 9 * self.nodes() * self.nodes()];
        for element in self.elements() {
            let (laws, nodes) = (self.laws(element), self.element_nodes(element));
            let n = nodes.len();
            let mut Ke = vec![[[0.0; 3]; 3]; n * n]; // K_ab for a ≤ b
            for (q, dV) in self.quadrature(element) {
                let A = moduli(&laws, &q.factors, &self.elastic(&nodes, &q, &u));
                let (h, grown) = (&q.h, q.growth * dV);
                for b in 0..n {
                    let mut Ah = [[[0.0; 3]; 3]; 3]; // A_ikjl h_bl
                    for i in 0..3 {
                        for k in 0..3 {
                            for j in 0..3 {
                                Ah[i][k][j] = dot(&A[i][k][j], &h[b]) * grown;
                            }
                        }
                    }
                    for a in 0..=b {
                        for i in 0..3 {
                            for j in 0..3 {
                                // δu ⊗ h_a : A : du ⊗ h_b
                                Ke[a * n + b][i][j] += h[a][0] * Ah[i][0][j]
                                    + h[a][1] * Ah[i][1][j]
                                    + h[a][2] * Ah[i][2][j];
                            }
                        }
                    }
                }
            }
            for b in 0..n {
                for a in 0..=b {
                    let Kab = Tensor2(Ke[a * n + b]);
                    self.add_block(&mut K, [nodes[a], nodes[b]], &Kab);
                    if a != b {
                        self.add_block(&mut K, [nodes[b], nodes[a]], &Kab.transpose());
                    }
                }
            }
        }
        K
    }

    /// Computes the damping matrix C, dense, row after row.
    pub fn damping(&self) -> Vec<f64> {
        let mut C = vec![0.0; 9 * self.nodes() * self.nodes()];
        for element in self.elements() {
            let nodes = self.element_nodes(element);
            let points = self.quadrature(element);
            for (a, &row) in nodes.iter().enumerate() {
                for (b, &column) in nodes.iter().enumerate() {
                    let NN = |(q, dV): &(ElementPoint, f64)| q.value[a] * q.value[b] * dV;
                    let sum = points.iter().map(NN).sum(); // δu · v
                    self.add_block(&mut C, [row, column], &Tensor2::IDENTITY.scaled(sum));
                }
            }
        }
        C
    }

    /// Returns the quadrature points of an element with their weighted dV.
    fn quadrature(&self, element: [usize; 3]) -> Vec<(ElementPoint, f64)> {
        let rule = gauss_legendre(self.spline.degree() + 1);
        let (z0, z1) = self.spline.axial.element(element[0]);
        let (r0, r1) = self.spline.wall.element(element[1]);
        let mut points = vec![];
        for &(z, wz) in &rule {
            for &(r, wr) in &rule {
                for &(s, ws) in &rule {
                    let at = self.at(element, z0 + (z1 - z0) * z, r0 + (r1 - r0) * r, s);
                    let dV = wz * (z1 - z0) * wr * (r1 - r0) * ws * at.volume;
                    points.push((at, dV));
                }
            }
        }
        points
    }

    /// Returns Fe = Fp⁻¹ + Σ u_a ⊗ h_a.
    pub(super) fn elastic(&self, nodes: &[usize], at: &ElementPoint, u: &[Vector]) -> Tensor2 {
        let mut Fe = at.Fp_inverse;
        for (&a, h) in nodes.iter().zip(&at.h) {
            add_product(&mut Fe, &u[a], h);
        }
        Fe
    }

    /// Evaluates an element at (z, R) and the fraction s around it.
    pub(super) fn at(&self, element: [usize; 3], z: f64, radius: f64, s: f64) -> ElementPoint {
        let (spline, p) = (self.spline, self.spline.degree());
        let nodes = self.element_nodes(element);
        let axial = spline.axial.evaluate_in(element[0], z);
        let wall = spline.wall.evaluate_in(element[1], radius);
        let mut value = vec![];
        let mut derivative = vec![]; // ∂N/∂(z, R, s)
        for i in 0..=p {
            for c in 0..=p {
                for j in 0..=p {
                    // On the element [0, 1] function j is the cardinal spline of [j − p, j + 1].
                    let x = s + (p - j) as f64;
                    let n = cardinal(p, x);
                    let dn = cardinal(p - 1, x) - cardinal(p - 1, x - 1.0);
                    value.push(axial.value[i] * wall.value[c] * n);
                    derivative.push([
                        axial.slope[i] * wall.value[c] * n,
                        axial.value[i] * wall.slope[c] * n,
                        axial.value[i] * wall.value[c] * dn,
                    ]);
                }
            }
        }

        // The map from (z, R, s) to X and its derivative D; ∇N = D⁻ᵀ ∂N/∂(z, R, s).
        let (mut X, mut D) = ([0.0; 3], Tensor2([[0.0; 3]; 3]));
        for (k, &a) in nodes.iter().enumerate() {
            let Xa = self.control_point(a);
            for i in 0..3 {
                X[i] += value[k] * Xa[i];
            }
            add_product(&mut D, &Xa, &derivative[k]);
        }
        let inverse_transpose = D.cofactor().scaled(1.0 / D.determinant());
        let gradient: Vec<Vector> = derivative
            .iter()
            .map(|d| apply(&inverse_transpose, d))
            .collect();

        // An imperfect tube is free of stress at X + δ: strain is measured from there with
        // B = I + ∇δ, dV grows by det B, and the directions of growth turn by the rotation nearest B.
        let mut B = Tensor2::IDENTITY;
        if let Some(delta) = &self.imperfection {
            for (&a, gradient) in nodes.iter().zip(&gradient) {
                add_product(&mut B, &delta[a], gradient);
            }
        }
        let [_, x, y] = X;
        let (cos, sin) = (x / x.hypot(y), y / x.hypot(y));
        let polar = Tensor2([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]]);
        let polar = nearest_rotation(&B).times(polar);

        // The residual stretch is growth that is always there: dV is that of the wall free of it.
        let layer = self.wall_layer(element);
        let phi = (element[2] as f64 + s - 0.5) * spline.sector.angle();
        let (theta_z, theta_t) = spline.tube.stretches_at(layer, z, phi, self.load);
        let through = spline.tube.growth_through(layer, z, phi, self.load);
        let stiffness = spline.tube.stiffness_factor(layer, z, phi);
        let active = self.active_muscles(layer);
        let tension = |(m, _)| spline.tube.tension([layer, m], z, phi, self.load);
        let factors = [stiffness].into_iter().chain(active.map(tension));
        let residual = spline.tube.residual_stretch(layer, radius);
        let [grown_z, grown_t] = [theta_z * residual[0], theta_t * residual[1]];
        let shrink = [1.0 / grown_z, 1.0 / through, 1.0 / grown_t];
        let shrink = Tensor2([0, 1, 2].map(|i| [0, 1, 2].map(|j| polar.0[i][j] * shrink[j])));
        let B_inverse = B.cofactor().transpose().scaled(1.0 / B.determinant());
        let Fp_inverse = B_inverse.times(shrink);
        let Fp_inverse_transpose = Fp_inverse.transpose();
        ElementPoint {
            value,
            h: gradient
                .iter()
                .map(|g| apply(&Fp_inverse_transpose, g))
                .collect(),
            volume: D.determinant() * B.determinant(),
            factors: factors
                .map(|factor| residual[0] * residual[1] * factor)
                .collect(),
            Fp_inverse,
            growth: theta_z * theta_t * through,
        }
    }

    /// Returns the elements: along the tube, through the wall and around it.
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

    /// Returns the control points of an element.
    pub(super) fn element_nodes(&self, [e, t, g]: [usize; 3]) -> Vec<usize> {
        let ([rings, points], p) = (self.shape(), self.spline.degree());
        let mut nodes = vec![];
        for i in e..=e + p {
            let first = self.spline.wall.first(t);
            for c in first..=first + p {
                nodes.extend((g..=g + p).map(|j| (i * points + c) * rings + j % rings));
            }
        }
        nodes
    }

    /// Returns the law of an element.
    pub(super) fn law(&self, element: [usize; 3]) -> &Material {
        &self.spline.tube.layers[self.wall_layer(element)].material
    }

    /// Returns the laws of an element: that of its layer, and those of muscles with active stress for a tension of one.
    fn laws(&self, element: [usize; 3]) -> Vec<Material> {
        let own = self.law(element).clone();
        let active = self.active_muscles(self.wall_layer(element));
        [own]
            .into_iter()
            .chain(active.map(|(_, law)| law))
            .collect()
    }

    /// Returns the muscles with active stress in a layer, by their numbers, and their laws for a tension of one.
    fn active_muscles(&self, layer: usize) -> impl Iterator<Item = (usize, Material)> {
        let tube = &self.spline.tube;
        let muscles = tube.muscles.iter().enumerate();
        muscles.filter_map(move |(m, muscle)| {
            let acts = !tube.layers[layer].idle_muscles.contains(&m);
            let tone = muscle.active_stress.clone().filter(|_| acts);
            tone.map(|tone| (m, Material::Composite(Composite::only(tone))))
        })
    }

    /// Returns the layer of the wall that an element lies in.
    fn wall_layer(&self, [_, t, _]: [usize; 3]) -> usize {
        let (from, to) = self.spline.wall.element(t);
        let faces = self.spline.tube.faces();
        let above = |face: &&f64| **face > 0.5 * (from + to);
        faces[1..faces.len() - 1]
            .iter()
            .filter(|face| !above(face))
            .count()
    }

    /// Counts rings, and control points through the wall.
    fn shape(&self) -> [usize; 2] {
        [self.spline.sector.around, self.spline.wall.functions()]
    }

    /// Counts control points.
    fn nodes(&self) -> usize {
        let [rings, points] = self.shape();
        self.spline.axial.functions() * points * rings
    }

    /// Returns the unit vectors (axial, radial, circumferential) at the ring of a control point.
    fn ring_frame(&self, node: usize) -> [Vector; 3] {
        let [rings, _] = self.shape();
        // Element 0 is centred on angle zero, and so are its p + 1 rings.
        let phi = ((node % rings) as f64 - 0.5 * self.spline.degree() as f64) * TAU / rings as f64;
        let (sin, cos) = phi.sin_cos();
        [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]
    }

    /// Returns the reference position X_a of a control point.
    pub(super) fn control_point(&self, node: usize) -> Vector {
        let [rings, points] = self.shape();
        let z = self.spline.axial.greville()[node / (rings * points)];
        let r = self.spline.wall.greville()[node / rings % points];
        let [_, outwards, _] = self.ring_frame(node);
        let r = r * self.spline.circle.control_radius;
        [z, r * outwards[1], r * outwards[2]]
    }

    /// Returns the index of a component of a control point among the unknowns of the tube.
    fn unknown(&self, node: usize, component: usize) -> usize {
        let [rings, _] = self.shape();
        (node / rings * 3 + component) * rings + node % rings
    }

    /// Converts unknowns of the tube to Cartesian vectors of the control points.
    pub(super) fn cartesian(&self, u: &[f64]) -> Vec<Vector> {
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

    /// Converts Cartesian vectors of the control points to unknowns of the tube.
    pub(super) fn cylindrical(&self, vectors: &[Vector]) -> Vec<f64> {
        let mut u = vec![0.0; 3 * vectors.len()];
        for (node, v) in vectors.iter().enumerate() {
            for (i, unit) in self.ring_frame(node).iter().enumerate() {
                u[self.unknown(node, i)] = dot(unit, v);
            }
        }
        u
    }

    /// Adds a Cartesian block for two control points to a dense matrix over the unknowns.
    fn add_block(&self, matrix: &mut [f64], nodes: [usize; 2], block: &Tensor2) {
        let width = 3 * self.nodes();
        let [left, right] = nodes.map(|node| self.ring_frame(node));
        for i in 0..3 {
            for j in 0..3 {
                let at = self.unknown(nodes[0], i) * width + self.unknown(nodes[1], j);
                matrix[at] += dot(&left[i], &apply(block, &right[j]));
            }
        }
    }
}

/// Returns the rotation nearest B: B U⁻¹ with U² = BᵀB = Σ λ n ⊗ n.
fn nearest_rotation(B: &Tensor2) -> Tensor2 {
    let mut U_inverse = Tensor2([[0.0; 3]; 3]);
    for (square, n) in B.transpose().times(*B).eigenpairs() {
        add_product(&mut U_inverse, &n.map(|x| x / square.sqrt()), &n);
    }
    B.times(U_inverse)
}

/// Returns the cardinal B-spline of degree p, on the knots 0, 1, …, p + 1.
fn cardinal(p: usize, x: f64) -> f64 {
    if p == 0 {
        return f64::from((0.0..1.0).contains(&x));
    }
    let (below, above) = (cardinal(p - 1, x), cardinal(p - 1, x - 1.0));
    (x * below + (p as f64 + 1.0 - x) * above) / p as f64
}

/// Returns all moduli A_{ik jl} = Σ f ∂²w/∂F_{ik}∂F_{jl} of laws with factors f; a law fills the blocks k ≤ l.
fn moduli(laws: &[Material], factors: &[f64], Fe: &Tensor2) -> [[[[f64; 3]; 3]; 3]; 3] {
    let mut A = [[[[0.0; 3]; 3]; 3]; 3];
    for (law, factor) in laws.iter().zip(factors) {
        let half = law.moduli(Fe);
        for i in 0..3 {
            for k in 0..3 {
                for j in 0..3 {
                    for l in 0..3 {
                        let (ik, jl) = (3 * k + i, 3 * l + j);
                        let entry = if k <= l { half[ik][jl] } else { half[jl][ik] };
                        A[i][k][j][l] += factor * entry;
                    }
                }
            }
        }
    }
    A
}

/// Adds a ⊗ b to a tensor.
fn add_product(sum: &mut Tensor2, a: &Vector, b: &Vector) {
    for i in 0..3 {
        for j in 0..3 {
            sum.0[i][j] += a[i] * b[j];
        }
    }
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn apply(T: &Tensor2, v: &Vector) -> Vector {
    T.0.map(|row| dot(&row, v))
}
