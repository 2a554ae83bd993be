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

const fn field(
    name: &'static str,
    components: &'static [&'static str],
    values: fn(&Points, &Scale) -> Vec<f32>,
) -> Field {
    Field {
        name,
        components,
        values,
    }
}

/// The fields of runs with contact.
pub(super) const OF_CONTACT: &[Field] = &[field("contact_pressure", &[], |points, scale| {
    let stress = scale.stress as f32;
    scalar(points, |point| stress * point.contact_pressure)
})];

/// The fields of runs with patches.
pub(super) const OF_PATCHES: &[Field] = &[
    field("theta_xi", &[], |points, _| {
        scalar(points, |point| point.grown_through)
    }),
    field("stiffness_factor", &[], |points, _| {
        scalar(points, |point| point.stiffness)
    }),
];

/// The fields of runs with foundations.
pub(super) const OF_FOUNDATIONS: &[Field] = &[field("foundation_force", XYZ, |points, scale| {
    let stress = scale.stress as f32;
    components(points, |point, rotation| {
        rotation.vector_f32(point.foundation).map(|x| stress * x)
    })
})];

/// The fields of runs with active stresses.
pub(super) const OF_TENSIONS: &[Field] = &[field("tension", &[], |points, scale| {
    let stress = scale.stress as f32;
    scalar(points, |point| stress * point.tension)
})];

/// The fields of all runs.
pub(super) const FIELDS: &[Field] = &[
    field("displacement", XYZ, |points, scale| {
        let length = scale.length as f32;
        components(points, |point, rotation| {
            rotation.vector_f32(point.displacement).map(|x| length * x)
        })
    }),
    field("det_Fe", &[], |points, _| {
        scalar(points, |point| point.jacobian)
    }),
    field("theta_zeta", &[], |points, _| {
        scalar(points, |point| point.grown[0])
    }),
    field("theta_eta", &[], |points, _| {
        scalar(points, |point| point.grown[1])
    }),
    field("strain_energy_density", &[], |points, scale| {
        let stress = scale.stress as f32;
        scalar(points, |point| stress * point.energy_density)
    }),
    field(
        "cauchy_stress",
        &["xx", "yy", "zz", "xy", "yz", "xz"],
        |points, scale| {
            let stress = scale.stress as f32;
            components(points, |point, rotation| {
                rotation.tensor(point.stress).map(|x| stress * x)
            })
        },
    ),
    field("axial_stress", &[], |points, scale| {
        let stress = scale.stress as f32;
        scalar(points, |point| stress * point.wall_stresses[0])
    }),
    field("radial_stress", &[], |points, scale| {
        let stress = scale.stress as f32;
        scalar(points, |point| stress * point.wall_stresses[1])
    }),
    field("hoop_stress", &[], |points, scale| {
        let stress = scale.stress as f32;
        scalar(points, |point| stress * point.wall_stresses[2])
    }),
    field("von_mises_stress", &[], |points, scale| {
        let stress = scale.stress as f32;
        scalar(points, |point| stress * point.von_mises)
    }),
    field("elastic_stretch", &["1", "2", "3"], |points, _| {
        components(points, |point, _| point.stretches)
    }),
    field("elastic_direction_1", XYZ, |points, _| {
        components(points, |point, rotation| {
            rotation.vector_f32(point.directions[0])
        })
    }),
    field("elastic_direction_2", XYZ, |points, _| {
        components(points, |point, rotation| {
            rotation.vector_f32(point.directions[1])
        })
    }),
    field("elastic_direction_3", XYZ, |points, _| {
        components(points, |point, rotation| {
            rotation.vector_f32(point.directions[2])
        })
    }),
    field(
        "green_lagrange_strain",
        &[
            "zeta-zeta",
            "eta-eta",
            "xi-xi",
            "zeta-eta",
            "eta-xi",
            "zeta-xi",
        ],
        |points, _| components(points, |point, _| point.strain),
    ),
];

fn scalar(points: &Points, of: impl Fn(&PointData) -> f32) -> Vec<f32> {
    points.evaluate(|point, _| of(point)).collect()
}

fn components<const N: usize>(
    points: &Points,
    of: impl Fn(&PointData, &Rotation) -> [f32; N],
) -> Vec<f32> {
    points.evaluate(of).flatten().collect()
}
