//! Fields at the points of a VTK file.

use super::point::{PointData, Rotation};
use super::points::Points;
use plica::study::Scale;

/// A field at the points.
pub(super) struct Field {
    /// Name in the file.
    pub name: &'static str,
    /// Names of the components; empty for a scalar field.
    pub components: &'static [&'static str],
    /// Returns the values at all points.
    pub values: fn(&Points, &Scale) -> Vec<f32>,
}

const XYZ: &[&str] = &["x", "y", "z"];

/// All fields.
pub(super) const FIELDS: &[Field] = &[
    Field {
        name: "displacement",
        components: XYZ,
        values: |points, scale| {
            let length = scale.length as f32;
            components(points, |point, rotation| {
                rotation.vector_f32(point.displacement).map(|x| length * x)
            })
        },
    },
    Field {
        name: "det_Fe",
        components: &[],
        values: |points, _| scalar(points, |point| point.jacobian),
    },
    Field {
        name: "theta_zeta",
        components: &[],
        values: |points, _| scalar(points, |point| point.grown[0]),
    },
    Field {
        name: "theta_eta",
        components: &[],
        values: |points, _| scalar(points, |point| point.grown[1]),
    },
    Field {
        name: "strain_energy_density",
        components: &[],
        values: |points, scale| {
            let stress = scale.stress as f32;
            scalar(points, |point| stress * point.energy_density)
        },
    },
    Field {
        name: "cauchy_stress",
        components: &["xx", "yy", "zz", "xy", "yz", "xz"],
        values: |points, scale| {
            let stress = scale.stress as f32;
            components(points, |point, rotation| {
                rotation.tensor(point.stress).map(|x| stress * x)
            })
        },
    },
    Field {
        name: "von_mises_stress",
        components: &[],
        values: |points, scale| {
            let stress = scale.stress as f32;
            scalar(points, |point| stress * point.von_mises)
        },
    },
    Field {
        name: "elastic_stretch",
        components: &["1", "2", "3"],
        values: |points, _| components(points, |point, _| point.stretches),
    },
    Field {
        name: "elastic_direction_1",
        components: XYZ,
        values: |points, _| {
            components(points, |point, rotation| {
                rotation.vector_f32(point.directions[0])
            })
        },
    },
    Field {
        name: "elastic_direction_2",
        components: XYZ,
        values: |points, _| {
            components(points, |point, rotation| {
                rotation.vector_f32(point.directions[1])
            })
        },
    },
    Field {
        name: "elastic_direction_3",
        components: XYZ,
        values: |points, _| {
            components(points, |point, rotation| {
                rotation.vector_f32(point.directions[2])
            })
        },
    },
    Field {
        name: "green_lagrange_strain",
        components: &[
            "zeta-zeta",
            "eta-eta",
            "xi-xi",
            "zeta-eta",
            "eta-xi",
            "zeta-xi",
        ],
        values: |points, _| components(points, |point, _| point.strain),
    },
];

fn scalar(points: &Points, of: impl Fn(&PointData) -> f32) -> Vec<f32> {
    points.map(|point, _| of(point)).collect()
}

fn components<const N: usize>(
    points: &Points,
    of: impl Fn(&PointData, &Rotation) -> [f32; N],
) -> Vec<f32> {
    points.map(of).flatten().collect()
}
