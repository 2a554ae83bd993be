//! The fields that points have.

use super::node::{Node, Turn};
use super::nodes::Nodes;
use plica::study::Scale;

/// A field: its name, the names of its components (none if it is a number), and its numbers.
pub struct Field {
    /// What it is called in a file.
    pub name: &'static str,
    /// What its components are called.
    pub components: &'static [&'static str],
    /// Its numbers at all points.
    pub numbers: fn(&Nodes, &Scale) -> Vec<f32>,
}

const XYZ: &[&str] = &["x", "y", "z"];

/// All fields.
pub const FIELDS: &[Field] = &[
    Field {
        name: "displacement",
        components: XYZ,
        numbers: |nodes, scale| {
            let length = scale.length as f32;
            several(nodes, |node, turn| {
                turn.of_short(node.displacement).map(|x| length * x)
            })
        },
    },
    Field {
        name: "det_Fe",
        components: &[],
        numbers: |nodes, _| single(nodes, |node| node.jacobian),
    },
    Field {
        name: "theta_zeta",
        components: &[],
        numbers: |nodes, _| single(nodes, |node| node.grown[0]),
    },
    Field {
        name: "theta_eta",
        components: &[],
        numbers: |nodes, _| single(nodes, |node| node.grown[1]),
    },
    Field {
        name: "strain_energy_density",
        components: &[],
        numbers: |nodes, scale| {
            let stress = scale.stress as f32;
            single(nodes, |node| stress * node.energy_density)
        },
    },
    Field {
        name: "cauchy_stress",
        components: &["xx", "yy", "zz", "xy", "yz", "xz"],
        numbers: |nodes, scale| {
            let stress = scale.stress as f32;
            several(nodes, |node, turn| {
                turn.of_tensor(node.stress).map(|x| stress * x)
            })
        },
    },
    Field {
        name: "von_mises_stress",
        components: &[],
        numbers: |nodes, scale| {
            let stress = scale.stress as f32;
            single(nodes, |node| stress * node.von_mises)
        },
    },
    Field {
        name: "elastic_stretch",
        components: &["1", "2", "3"],
        numbers: |nodes, _| several(nodes, |node, _| node.stretches),
    },
    Field {
        name: "elastic_direction_1",
        components: XYZ,
        numbers: |nodes, _| several(nodes, |node, turn| turn.of_short(node.directions[0])),
    },
    Field {
        name: "elastic_direction_2",
        components: XYZ,
        numbers: |nodes, _| several(nodes, |node, turn| turn.of_short(node.directions[1])),
    },
    Field {
        name: "elastic_direction_3",
        components: XYZ,
        numbers: |nodes, _| several(nodes, |node, turn| turn.of_short(node.directions[2])),
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
        numbers: |nodes, _| several(nodes, |node, _| node.strain),
    },
];

fn single(nodes: &Nodes, of: impl Fn(&Node) -> f32) -> Vec<f32> {
    nodes.all(|node, _| of(node)).collect()
}

fn several<const N: usize>(nodes: &Nodes, of: impl Fn(&Node, &Turn) -> [f32; N]) -> Vec<f32> {
    nodes.all(of).flatten().collect()
}
