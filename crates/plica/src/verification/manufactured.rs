//! Manufactured solutions: a displacement is chosen, the forces that it needs are worked out, and the tube is
//! asked for the displacement.
//!
//! The forces are f_i = ∫ P(Fe*) : ∂N_i/∂F dV₀ at the displacement u* that was chosen, in cylindrical components on
//! the exact circle, with a stress that is written out here, under many more points than the kernel has. What the
//! kernel, its spline circle and its splines make of the same forces is then off by O(h^{p+1}) in u.

use super::found::{Findings, Trouble};
use super::specimen::tight;
use crate::activation::{Direction, Muscle, Profile};
use crate::assembly::{Inverted, SplineTube};
use crate::draw::{Chart, Curve};
use crate::material::{Material, NeoHookean};
use crate::solve::{Balance, Equilibrium, newton};
use crate::spline::gauss_legendre;
use crate::study::TubeProblem;
use crate::tube::{Load, Mesh, Support, Tube};
use std::f64::consts::{PI, TAU};

const LENGTH: f64 = 1.0;
const THICKNESS: f64 = 0.2;
const NU: f64 = 0.3;
/// Gauss points to an element and direction.
const POINTS: usize = 8;

/// u* along and outwards at (z, R), and its gradients (∂z, ∂R) of each.
fn chosen(z: f64, R: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    let t = (R - 0.4) / THICKNESS;
    let (s, c) = (PI * z / LENGTH).sin_cos();
    let k = PI / LENGTH;
    let g = (1.5 * t).exp();
    let dg = 1.5 * g / THICKNESS;
    // Zero at both ends, where the tube is fixed.
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
    let muscle = |direction| Muscle {
        name: "m".into(),
        direction,
        // Smooth in all of the tube.
        zone: [0.0, LENGTH],
        profile: Profile::RaisedCosine,
    };
    Tube {
        length: LENGTH,
        thickness: THICKNESS,
        material: Material::NeoHookean(NeoHookean::new(1.0, NU)),
        muscles: vec![muscle(Direction::Circular), muscle(Direction::Longitudinal)],
        ends: [Support::Fixed; 2],
        imperfections: vec![],
    }
}

/// Targets of the two muscles.
const TARGETS: [f64; 2] = [0.8, 1.1];

/// θζ and θη.
fn grown(z: f64) -> [f64; 2] {
    let s = 0.5 * (1.0 - (TAU * z / LENGTH).cos());
    [
        1.0 + (TARGETS[1] - 1.0) * 2.0 * s,
        1.0 - (1.0 - TARGETS[0]) * s,
    ]
}

/// P Fp⁻ᵀ det Fp at (z, R), entries (zz, zr, rz, rr, θθ), from the formulas of docs/model.md.
fn forces_at(z: f64, R: f64, [uz, ur]: [[f64; 2]; 2], u_r: f64) -> [f64; 5] {
    let [gz, gt] = grown(z);
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
    [
        P[0] / gz * det,
        P[1] * det,
        P[2] / gz * det,
        P[3] * det,
        P[4] / gt * det,
    ]
}

/// The tube under the forces of a displacement that was chosen.
struct Manufactured {
    problem: TubeProblem,
    forces: Vec<f64>,
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
            volumetric: Default::default(),
        };
        let spline = SplineTube::new(&tube(), &mesh, 1);
        let mut forces = vec![0.0; spline.unknowns()];
        // A ring's share of the circumference; its control values move the wall by the radius that the
        // spline circle has over that of its control points.
        let share = TAU / around as f64;
        let rule = gauss_legendre(POINTS);
        for e in 0..spline.axial.elements() {
            let (z0, z1) = spline.axial.element(e);
            for w in 0..spline.wall.elements() {
                let (r0, r1) = spline.wall.element(w);
                for (x, weight_z) in &rule {
                    for (y, weight_r) in &rule {
                        let (z, R) = (z0 + (z1 - z0) * x, r0 + (r1 - r0) * y);
                        let (u, gradients) = chosen(z, R);
                        let [zz, zr, rz, rr, tt] = forces_at(z, R, gradients, u[1]);
                        let volume = share * R * weight_z * weight_r * (z1 - z0) * (r1 - r0);
                        let (along, through) = (
                            spline.axial.evaluate_in(e, z),
                            spline.wall.evaluate_in(w, R),
                        );
                        for (a, (n, dn)) in along.value.iter().zip(&along.slope).enumerate() {
                            for (c, (m, dm)) in through.value.iter().zip(&through.slope).enumerate()
                            {
                                let at = (e + a) * spline.row_size() + (w + c) * 3;
                                forces[at] += volume * (zz * dn * m + zr * n * dm);
                                // A ring moved outwards by its control value moves the wall by as much
                                // as the circle's radius over its control points' radius.
                                let outwards = rz * dn * m + rr * n * dm + tt * n * m / R;
                                forces[at + 1] += volume * outwards / spline.circle.control_radius;
                            }
                        }
                    }
                }
            }
        }
        Self {
            problem: TubeProblem::new(spline),
            forces,
        }
    }

    fn load(&self) -> Load {
        Load {
            muscles: TARGETS.to_vec(),
            ..self.problem.tube.tube.rest()
        }
    }

    /// Errors of u in L2 and of its gradient in L2, over those of u* itself.
    fn errors(&self) -> Result<[f64; 2], Trouble> {
        let spline = &self.problem.tube;
        // From u* at Greville's abscissae, which is near.
        let start = spline.control_values(|z, r, _| {
            let (u, _) = chosen(z, r);
            [u[0], u[1] * spline.circle.control_radius, 0.0]
        });
        let mut start = start;
        self.impose(&self.load(), &mut start);
        let found = newton(self, &self.load(), start, &tight(), &mut ());
        let u = found
            .map_err(|failed| Trouble::Solve(failed.to_string()))?
            .u;
        let rule = gauss_legendre(POINTS);
        let (mut off, mut all) = ([0.0; 2], [0.0; 2]);
        for e in 0..spline.axial.elements() {
            let (z0, z1) = spline.axial.element(e);
            for w in 0..spline.wall.elements() {
                let (r0, r1) = spline.wall.element(w);
                for (x, weight_z) in &rule {
                    for (y, weight_r) in &rule {
                        let (z, R) = (z0 + (z1 - z0) * x, r0 + (r1 - r0) * y);
                        let (exact, slopes) = chosen(z, R);
                        let (along, through) = (
                            spline.axial.evaluate_in(e, z),
                            spline.wall.evaluate_in(w, R),
                        );
                        let (mut value, mut slope) = ([0.0; 2], [[0.0; 2]; 2]);
                        for (a, (n, dn)) in along.value.iter().zip(&along.slope).enumerate() {
                            for (c, (m, dm)) in through.value.iter().zip(&through.slope).enumerate()
                            {
                                let at = (e + a) * spline.row_size() + (w + c) * 3;
                                let x = [u[at], u[at + 1] / spline.circle.control_radius];
                                for i in 0..2 {
                                    value[i] += n * m * x[i];
                                    slope[i][0] += dn * m * x[i];
                                    slope[i][1] += n * dm * x[i];
                                }
                            }
                        }
                        let volume = R * weight_z * weight_r * (z1 - z0) * (r1 - r0);
                        for i in 0..2 {
                            off[0] += volume * (value[i] - exact[i]).powi(2);
                            all[0] += volume * exact[i].powi(2);
                            for j in 0..2 {
                                off[1] += volume * (slope[i][j] - slopes[i][j]).powi(2);
                                all[1] += volume * slopes[i][j].powi(2);
                            }
                        }
                    }
                }
            }
        }
        Ok([0, 1].map(|d| (off[d] / all[d]).sqrt()))
    }
}

impl Equilibrium for Manufactured {
    type Load = Load;
    type Broken = Inverted;
    type Tangent = <TubeProblem as Equilibrium>::Tangent;

    fn given(&self) -> &[bool] {
        self.problem.given()
    }
    fn impose(&self, load: &Load, u: &mut [f64]) {
        self.problem.impose(load, u);
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        self.problem.between(from, to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<Balance, Inverted> {
        let mut balance = self.problem.forces(load, u)?;
        for ((residual, force), u) in balance.residual.iter_mut().zip(&self.forces).zip(u) {
            *residual -= force;
            balance.energy -= force * u;
        }
        Ok(balance)
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> Self::Tangent {
        self.problem.tangent(load, u)
    }
    fn drag(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.problem.drag(factor, v, y);
    }
}

/// Orders of convergence for degrees 1 to 4.
pub fn orders(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let mut curves = vec![];
    for degree in 1..=4 {
        let meshes: &[usize] = match (degree, found.full) {
            (1, false) => &[8, 16, 32, 64],
            (1, true) => &[8, 16, 32, 64, 128],
            (_, false) => &[4, 8, 16, 32],
            (_, true) => &[4, 8, 16, 32, 64],
        };
        let mut errors = vec![];
        found.case(format!("manufactured solution, p = {degree}"))?;
        for &n in meshes {
            found.go_on()?;
            errors.push(Manufactured::new(degree, [2 * n, n / 2]).errors()?);
        }
        let names = ["u in L2", "its gradient in L2 (the energy norm)"];
        for (d, name) in names.into_iter().enumerate() {
            let [.., coarse, fine] = errors.as_slice() else {
                unreachable!("four meshes")
            };
            let slope = (coarse[d] / fine[d]).log2();
            let order = (degree + 1 - d) as f64;
            let most = meshes[meshes.len() - 1];
            let quantity = format!("order of {name}, {} to {most} elements", most / 2);
            found.row(
                quantity,
                slope,
                (order, ["p + 1", "p"][d]),
                super::Tolerance::Absolute(0.1),
            );
            curves.push(Curve {
                label: if d == 0 {
                    format!("*p* = {degree}")
                } else {
                    String::new()
                },
                points: meshes
                    .iter()
                    .zip(&errors)
                    .map(|(n, e)| ((*n as f64).log2(), e[d].log10()))
                    .collect(),
                colour: degree,
                stroke: if d == 0 {
                    Default::default()
                } else {
                    crate::draw::Stroke::Dashed
                },
                dots: true,
            });
        }
    }
    found.picture(
        "orders.png",
        "Manufactured solutions of degrees 1 to 4: error of the displacement in L2 (solid, order p + 1) and of its gradient \
         (dashed, order p), over those of the solution, against elements to a diameter of length.",
        Chart {
            x_label: "log_{2} *n*".into(),
            y_label: "log_{10} error".into(),
            curves,
            width_pt: 360.0,
            ..Chart::default()
        },
    );
    Ok(())
}
