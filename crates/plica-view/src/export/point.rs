//! Position and fields of a point of the wall in (x, y, z) coordinates.
#![allow(non_snake_case)] // the formulas use the letters of their sources

use crate::sampled_tube::FieldSample;
use plica::tensor::Tensor2;

/// Position and field values of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointData {
    /// Position in units of D.
    pub position: [f64; 3],
    /// Displacement from the stress-free state in units of D.
    pub displacement: [f32; 3],
    /// det Fe.
    pub jacobian: f32,
    /// Growth stretches θζ and θη.
    pub grown: [f32; 2],
    /// Growth stretch through the wall.
    pub grown_through: f32,
    /// Tension of the muscles with active stress in units of E.
    pub tension: f32,
    /// Factor of patches on the energy.
    pub stiffness: f32,
    /// Force of the foundations per area at rest in units of E.
    pub foundation: [f32; 3],
    /// Strain energy density w in units of E.
    pub energy_density: f32,
    /// Cauchy stress σ in units of E: xx, yy, zz, xy, yz, xz.
    pub stress: [f32; 6],
    /// Cauchy stress along the meridian, through the wall and along the circle of the deformed wall, in units of E.
    pub wall_stresses: [f32; 3],
    /// Von Mises stress in units of E.
    pub von_mises: f32,
    /// Principal stretches of Fe, largest first.
    pub stretches: [f32; 3],
    /// Principal directions.
    pub directions: [[f32; 3]; 3],
    /// Pressure of contact in units of E.
    pub contact_pressure: f32,
    /// Green–Lagrange strain ½ (FᵀF − 1): ζζ, ηη, ξξ, ζη, ηξ, ζξ.
    pub strain: [f32; 6],
}

/// A rotation about the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rotation {
    sin: f64,
    cos: f64,
}

impl Rotation {
    /// Creates the rotation by an angle in radians.
    pub fn by(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { sin, cos }
    }

    /// Rotates a vector.
    pub fn vector(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let Self { sin, cos } = self;
        [x * cos - y * sin, x * sin + y * cos, z]
    }

    /// Rotates a vector in single precision.
    pub fn vector_f32(&self, x: [f32; 3]) -> [f32; 3] {
        self.vector(x.map(f64::from)).map(|x| x as f32)
    }

    /// Rotates a symmetric tensor (xx, yy, zz, xy, yz, xz).
    pub fn tensor(&self, t: [f32; 6]) -> [f32; 6] {
        let [xx, yy, zz, xy, yz, xz] = t.map(f64::from);
        let Self { sin: s, cos: c } = *self;
        [
            c * c * xx - 2.0 * c * s * xy + s * s * yy,
            s * s * xx + 2.0 * c * s * xy + c * c * yy,
            zz,
            c * s * (xx - yy) + (c * c - s * s) * xy,
            s * xz + c * yz,
            c * xz - s * yz,
        ]
        .map(|x| x as f32)
    }
}

impl PointData {
    /// Converts a sample of the tube from (z, outwards, around) to (x, y, z).
    pub fn new(sample: &FieldSample) -> Self {
        let rotation = Rotation::by(sample.element_angle);
        let reorder = |[z, x, y]: [f64; 3]| [x, y, z];
        let vector = |v: [f64; 3]| rotation.vector(reorder(v));
        let tensor = |t: &Tensor2| {
            let t = t.0;
            let [zz, xx, yy] = [0, 1, 2].map(|i| t[i][i]);
            rotation.tensor([xx, yy, zz, t[1][2], t[2][0], t[1][0]].map(|x| x as f32))
        };
        let Fe = sample.elastic;
        let stretches = sample.stretches();
        let [theta_z, theta_t] = sample.grown;
        let mut F = Fe;
        for row in &mut F.0 {
            row[1] *= sample.grown_through;
            (row[0], row[2]) = (theta_z * row[0], theta_t * row[2]);
        }
        let C = F.transpose().times(F).0;
        let E = |i: usize, j: usize| 0.5 * (C[i][j] - f64::from(u8::from(i == j)));
        let (position, reference) = (reorder(sample.position), reorder(sample.reference));
        // Stress and energy do not exist in an inverted element and are set to zero; det Fe shows the reason.
        let inverted = sample.is_inverted();
        let existing = |x: f64| if inverted { 0.0 } else { x };
        let jacobian = if inverted {
            sample.jacobian.min(Fe.determinant())
        } else {
            sample.jacobian
        };
        Self {
            position,
            displacement: [0, 1, 2].map(|i| (position[i] - reference[i]) as f32),
            jacobian: jacobian as f32,
            grown: sample.grown.map(|x| x as f32),
            grown_through: sample.grown_through as f32,
            tension: sample.tension as f32,
            stiffness: sample.stiffness as f32,
            foundation: vector(sample.foundation).map(|x| x as f32),
            energy_density: existing(sample.energy_density) as f32,
            stress: tensor(&Tensor2(sample.stress.0.map(|row| row.map(existing)))),
            wall_stresses: sample.wall_stresses().map(|x| existing(x) as f32),
            von_mises: existing(sample.von_mises()) as f32,
            stretches: stretches.map(|(stretch, _)| stretch as f32),
            directions: stretches.map(|(_, v)| vector(oriented(v)).map(|x| x as f32)),
            contact_pressure: sample.contact_pressure as f32,
            strain: [(0, 0), (2, 2), (1, 1), (0, 2), (2, 1), (0, 1)].map(|(i, j)| E(i, j) as f32),
        }
    }
}

/// Returns the direction or its opposite, such that the largest component is positive. Neighbours then point the same way.
fn oriented(v: [f64; 3]) -> [f64; 3] {
    let largest = v
        .iter()
        .fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
    if largest < 0.0 { v.map(|x| -x) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::sampled_tube::SampledState;
    use plica::assembly::{Point, SplineTube};
    use plica::material::{Material, NeoHookean, Volumetric};
    use plica::tube::{Integration, Mesh, Tube, WallLayer};

    /// Both volumetric laws, with full and with reduced integration.
    #[test]
    fn inverted_elements_have_zero_stress_and_no_nan() {
        for volumetric in [Volumetric::Logarithmic, Volumetric::Quadratic] {
            for integration in [Integration::Full, Integration::Reduced] {
                let tube = Tube {
                    layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean {
                        volumetric,
                        ..NeoHookean::new(1.0, 0.3)
                    }))],
                    ..fixture::short()
                };
                let mesh = Mesh {
                    volumetric: integration,
                    ..fixture::coarse()
                };
                let tube = SplineTube::new(&tube, &mesh, 1);
                // In the middle of the tube the inner face moves beyond the outer one.
                let u = tube.control_values_from(|z, r, _| {
                    [
                        0.0,
                        4.0 * (0.45 - r) * (-40.0 * (z - 0.5).powi(2)).exp(),
                        0.0,
                    ]
                });
                let load = tube.tube.rest();
                let (mut inverted, mut valid) = (0, 0);
                for k in 0..=60 {
                    for layer in 0..=6 {
                        let (z, radius) = (f64::from(k) / 60.0, 0.4 + 0.1 * f64::from(layer) / 6.0);
                        let state = SampledState::without_contact(&tube, &load, &u);
                        let sample = state.at(Point {
                            z,
                            radius,
                            angle: 0.0,
                        });
                        let point = PointData::new(&sample);
                        let stresses = [
                            point.stress,
                            [point.von_mises; 6],
                            [point.wall_stresses, point.wall_stresses]
                                .concat()
                                .try_into()
                                .unwrap(),
                            [point.energy_density; 6],
                        ];
                        let all = stresses.as_flattened();
                        assert!(all.iter().all(|x| x.is_finite()));
                        if sample.is_inverted() {
                            inverted += 1;
                            assert!(point.jacobian <= 0.0);
                            assert!(all.iter().all(|x| *x == 0.0));
                        } else {
                            valid += 1;
                        }
                    }
                }
                assert!(inverted > 10 && valid > 100, "{inverted}, {valid}");
            }
        }
    }
}
