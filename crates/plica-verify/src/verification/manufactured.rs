//! Orders of convergence on manufactured solutions.
//!
//! The forces f_i = ∫ P(Fe*) : ∂N_i/∂F dV₀ of a chosen displacement u* are integrated in cylindrical components on the
//! exact circle, with a stress written out here and more quadrature points than the kernel has. The solution under
//! these forces differs from u* by O(h^{p+1}).

use super::VerificationError;
use super::report::Recorder;
use super::row::Tolerance;
use super::tube_model::tight_settings;
use plica::activation::{Direction, Muscle, Profile};
use plica::assembly::{Inverted, SplineTube};
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean};
use plica::solve::{Effort, Equilibrium, ResidualEvaluation, newton};
use plica::spline::gauss_legendre;
use plica::tube::{Load, Mesh, Support, Tube, WallLayer};
use plica_view::draw::{Chart, Curve, Stroke};
use std::f64::consts::{PI, TAU};

const LENGTH: f64 = 1.0;
const THICKNESS: f64 = 0.2;
const NU: f64 = 0.3;
/// Gauss points per element and direction.
const POINTS: usize = 8;

/// Returns u* along and outwards at (z, R), and the derivatives (∂z, ∂R) of each.
fn exact_solution(z: f64, R: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    let t = (R - 0.4) / THICKNESS;
    let (s, c) = (PI * z / LENGTH).sin_cos();
    let k = PI / LENGTH;
    let g = (1.5 * t).exp();
    let dg = 1.5 * g / THICKNESS;
    // Zero at both ends, which are fixed.
    let u = [0.01 * s * (t + 0.4).sin(), -0.01 * s * s * g];
    let gradients = [
        [
            0.01 * k * c * (t + 0.4).sin(),
            0.01 * s * (t + 0.4).cos() / THICKNESS,
        ],
        [-0.02 * k * s * c * g, -0.01 * s * s * dg],
    ];
    (u, gradients)
}

fn tube() -> Tube {
    // Smooth along the whole tube.
    let muscle =
        |direction| Muscle::new("m".into(), direction, [0.0, LENGTH], Profile::RaisedCosine);
    Tube {
        length: LENGTH,
        thickness: THICKNESS,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, NU,
        )))],
        muscles: vec![muscle(Direction::Circular), muscle(Direction::Longitudinal)],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    }
}

/// Targets of the circular and the longitudinal muscle.
const TARGETS: [f64; 2] = [0.8, 1.1];

/// Returns the growth stretches θζ and θη.
fn growth(z: f64) -> [f64; 2] {
    let s = 0.5 * (1.0 - (TAU * z / LENGTH).cos());
    [
        1.0 + (TARGETS[1] - 1.0) * 2.0 * s,
        1.0 - (1.0 - TARGETS[0]) * s,
    ]
}

/// Returns w det Fp, and P Fp⁻ᵀ det Fp with the entries (zz, zr, rz, rr, θθ), at (z, R); formulas of docs/model.md.
fn elastic(z: f64, R: f64, [uz, ur]: [[f64; 2]; 2], u_r: f64) -> (f64, [f64; 5]) {
    let [gz, gt] = growth(z);
    // Fe = F Fp⁻¹.
    let (zz, zr) = ((1.0 + uz[0]) / gz, uz[1]);
    let (rz, rr) = (ur[0] / gz, 1.0 + ur[1]);
    let tt = (1.0 + u_r / R) / gt;
    let plane = zz * rr - zr * rz;
    let J = plane * tt;
    let (mu, lambda) = (0.5 / (1.0 + NU), NU / ((1.0 + NU) * (1.0 - 2.0 * NU)));
    let p = lambda * J.ln() - mu;
    // F⁻ᵀ = cofactor / J.
    let P = [
        mu * zz + p * rr / plane,
        mu * zr - p * rz / plane,
        mu * rz - p * zr / plane,
        mu * rr + p * zz / plane,
        mu * tt + p / tt,
    ];
    let det = gz * gt;
    let I1 = zz * zz + zr * zr + rz * rz + rr * rr + tt * tt;
    let w = 0.5 * mu * (I1 - 3.0) - mu * J.ln() + 0.5 * lambda * J.ln().powi(2);
    let forces = [P[0] / gz, P[1], P[2] / gz, P[3], P[4] / gt].map(|force| force * det);
    (w * det, forces)
}

/// A quadrature point with the basis functions there.
struct Point {
    z: f64,
    R: f64,
    /// Quadrature weight times R: volume per radian.
    volume: f64,
    /// Index of the axial unknown of each basis function (the radial one follows), with value, ∂z and ∂R.
    functions: Vec<(usize, [f64; 3])>,
}

/// Calls `each` at every quadrature point of a tube of one ring.
fn for_each_point(spline: &SplineTube, mut each: impl FnMut(&Point)) {
    let rule = gauss_legendre(POINTS);
    let mut functions = vec![];
    for e in 0..spline.axial.elements() {
        let (z0, z1) = spline.axial.element(e);
        for w in 0..spline.wall.elements() {
            let (r0, r1) = spline.wall.element(w);
            for (x, y) in rule.iter().flat_map(|x| rule.iter().map(move |y| (x, y))) {
                let (z, R) = (z0 + (z1 - z0) * x.0, r0 + (r1 - r0) * y.0);
                let along = spline.axial.evaluate_in(e, z);
                let through = spline.wall.evaluate_in(w, R);
                functions.clear();
                for (a, (n, dn)) in along.value.iter().zip(&along.slope).enumerate() {
                    for (c, (m, dm)) in through.value.iter().zip(&through.slope).enumerate() {
                        let at = (e + a) * spline.row_size() + (w + c) * 3;
                        functions.push((at, [n * m, dn * m, n * dm]));
                    }
                }
                let point = Point {
                    z,
                    R,
                    volume: R * x.1 * y.1 * (z1 - z0) * (r1 - r0),
                    functions: std::mem::take(&mut functions),
                };
                each(&point);
                functions = point.functions;
            }
        }
    }
}

/// The tube under the forces of the manufactured solution.
struct Manufactured {
    problem: TubeProblem,
    forces: Vec<f64>,
    /// Potential energy of u* per ring.
    potential: f64,
}

impl Manufactured {
    fn new(degree: usize, elements: [usize; 2]) -> Self {
        let around = if degree == 1 { 4000 } else { 400 };
        let mesh = Mesh {
            axial: elements[0] + degree,
            around,
            thickness: elements[1] + degree,
            degree,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        let spline = SplineTube::new(&tube(), &mesh, 1);
        let mut forces = vec![0.0; spline.unknowns()];
        let mut potential = 0.0;
        // Angle per ring, and the radial displacement of the wall per unit of its control value.
        let share = TAU / around as f64;
        let circle = 1.0 / spline.circle.control_radius;
        for_each_point(&spline, |at| {
            let (u, [uz, ur]) = exact_solution(at.z, at.R);
            let (w, [zz, zr, rz, rr, tt]) = elastic(at.z, at.R, [uz, ur], u[1]);
            let volume = share * at.volume;
            let work = zz * uz[0] + zr * uz[1] + rz * ur[0] + rr * ur[1] + tt * u[1] / at.R;
            potential += volume * (w - work);
            for (i, [value, over_z, over_R]) in &at.functions {
                forces[*i] += volume * (zz * over_z + zr * over_R);
                let outwards = rz * over_z + rr * over_R + tt * value / at.R;
                forces[i + 1] += volume * circle * outwards;
            }
        });
        Self {
            problem: TubeProblem::new(spline),
            forces,
            potential,
        }
    }

    fn load(&self) -> Load {
        Load {
            muscles: TARGETS.to_vec(),
            ..self.problem.tube.tube.rest()
        }
    }

    /// Returns the relative errors of u in L2, of its gradient in L2, and of the potential energy.
    fn errors(&self) -> Result<[f64; 3], VerificationError> {
        let spline = &self.problem.tube;
        let circle = 1.0 / spline.circle.control_radius;
        // Starts from u* at the Greville abscissae.
        let mut start = spline.control_values_from(|z, r, _| {
            let ([along, outwards], _) = exact_solution(z, r);
            [along, outwards / circle, 0.0]
        });
        self.apply_prescribed(&self.load(), &mut start);
        let found = newton(
            self,
            &self.load(),
            start,
            &tight_settings(),
            &mut Effort::default(),
            &mut (),
        );
        let found = found.map_err(|failed| VerificationError::Solve(failed.to_string()))?;
        let (mut errors, mut norms) = ([0.0; 2], [0.0; 2]);
        for_each_point(spline, |at| {
            // Value, ∂z and ∂R of each component.
            let mut u = [[0.0; 3]; 2];
            for (i, functions) in &at.functions {
                let x = [found.u[*i], circle * found.u[i + 1]];
                for c in 0..2 {
                    for (u, n) in u[c].iter_mut().zip(functions) {
                        *u += n * x[c];
                    }
                }
            }
            let (exact, slopes) = exact_solution(at.z, at.R);
            for c in 0..2 {
                errors[0] += at.volume * (u[c][0] - exact[c]).powi(2);
                norms[0] += at.volume * exact[c].powi(2);
                for d in 0..2 {
                    errors[1] += at.volume * (u[c][1 + d] - slopes[c][d]).powi(2);
                    norms[1] += at.volume * slopes[c][d].powi(2);
                }
            }
        });
        let potential = (found.forces.energy / self.potential - 1.0).abs();
        let [value, slope] = [0, 1].map(|d| (errors[d] / norms[d]).sqrt());
        Ok([value, slope, potential])
    }
}

impl Equilibrium for Manufactured {
    type Load = Load;
    type EvaluationError = Inverted;
    type Tangent = <TubeProblem as Equilibrium>::Tangent;

    fn prescribed(&self) -> &[bool] {
        self.problem.prescribed()
    }
    fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        self.problem.apply_prescribed(load, u);
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        self.problem.between(from, to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<ResidualEvaluation, Inverted> {
        let mut evaluation = self.problem.forces(load, u)?;
        for ((residual, force), u) in evaluation.residual.iter_mut().zip(&self.forces).zip(u) {
            *residual -= force;
            evaluation.energy -= force * u;
        }
        Ok(evaluation)
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> Self::Tangent {
        self.problem.tangent(load, u)
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.problem.damping(factor, v, y);
    }
}

/// Quantities whose errors are measured, and their orders for degree p.
const ERRORS: [(&str, &str); 3] = [
    ("u in L2", "p + 1"),
    ("its gradient in L2 (the energy norm)", "p"),
    ("the potential energy", "2p"),
];

/// Relative error below which rounding affects the order.
const ROUNDING: f64 = 1e-10;

/// Records the orders of convergence of degrees 1 to 4.
pub fn orders(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let mut curves = vec![];
    for degree in 1..=4 {
        let finest = match (degree, recorder.full) {
            (1, false) => 64,
            (1, true) => 128,
            (_, false) => 32,
            (_, true) => 64,
        };
        let meshes: Vec<usize> = (0..4).rev().map(|halvings| finest >> halvings).collect();
        let mut errors = vec![];
        recorder.case(format!("manufactured solution, p = {degree}"))?;
        for &n in &meshes {
            recorder.check_cancelled()?;
            errors.push(Manufactured::new(degree, [2 * n, n / 2]).errors()?);
        }
        // The potential energy of quartics is exact to rounding on all but the coarsest mesh.
        let quantities = if degree < 4 { 3 } else { 2 };
        for (d, (name, source)) in ERRORS.into_iter().take(quantities).enumerate() {
            // Between the two finest meshes with errors above rounding.
            let usable = errors
                .iter()
                .take_while(|error| error[d] > ROUNDING)
                .count();
            let (at, slope) = match usable.checked_sub(1) {
                Some(at) if at > 0 => (at, (errors[at - 1][d] / errors[at][d]).log2()),
                _ => (1, f64::NAN),
            };
            let quantity = format!(
                "order of {name}, {} to {} elements",
                meshes[at - 1],
                meshes[at]
            );
            let order = [degree + 1, degree, 2 * degree][d] as f64;
            recorder.row(
                quantity,
                slope,
                (order, source),
                Tolerance::Absolute([0.1, 0.1, 0.3][d]),
            );
            if d < 2 {
                let points = meshes.iter().zip(&errors);
                curves.push(Curve {
                    label: if d == 0 {
                        format!("*p* = {degree}")
                    } else {
                        String::new()
                    },
                    points: points
                        .map(|(n, e)| ((*n as f64).log2(), e[d].log10()))
                        .collect(),
                    colour: degree,
                    stroke: if d == 0 {
                        Stroke::Solid
                    } else {
                        Stroke::Dashed
                    },
                    dots: true,
                });
            }
        }
    }
    recorder.chart(
        "convergence.png",
        "Manufactured solutions of degrees 1 to 4: relative error of the displacement in L2 (solid, order p + 1) and of its \
         gradient (dashed, order p) against elements per diameter of length.",
        Chart {
            x_label: "log_{2} *n*".into(),
            y_label: "log_{10} error".into(),
            x_range: Some((1.8, if recorder.full { 7.2 } else { 6.2 })),
            curves,
            width_pt: 360.0,
            ..Chart::default()
        },
    );
    Ok(())
}
