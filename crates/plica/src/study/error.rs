//! Errors of a study.

use super::Lost;
use crate::contact::Face;

/// An error that ends a study.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The tube could not be followed further.
    #[error(transparent)]
    Lost(Box<Lost>),
    /// The study needs more memory than the machine has.
    #[error(
        "the case needs about {needed_gib:.1} GiB of memory and the machine has {available_gib:.1} \
         GiB free; use fewer control points or a symmetry that repeats more often"
    )]
    OutOfMemory {
        /// Forecast, in GiB.
        needed_gib: f64,
        /// Free, in GiB.
        available_gib: f64,
    },
    /// The state to start from passes through itself, and the study has contact.
    #[error(
        "the state to start from passes through itself at the {0}, and a wall with contact cannot: start from an earlier state, or set contact = false"
    )]
    Crosses(Face),
    /// The state to resume from does not belong to the plan.
    #[error("the study cannot be resumed: {0}")]
    Resume(String),
}

#[cfg(test)]
mod tests {
    use super::super::{Start, Study, fixture};
    use crate::assembly::SplineTube;
    use crate::tube::{Mesh, Symmetry};

    #[test]
    fn a_state_to_start_from_that_crosses_itself_is_refused_with_contact_only() {
        let mut plan = fixture::plan(Symmetry::Axisymmetric);
        plan.mesh = Mesh {
            axial: 30,
            ..fixture::coarse()
        };
        let tube = SplineTube::new(&plan.tube, &plan.mesh, 1);
        // The wall runs to z = 0.5, back under itself or above itself, and on.
        let looped = |depth: f64| {
            tube.control_values_from(|z, _, _| {
                let way = if z < 0.4 {
                    z
                } else if z < 0.6 {
                    0.8 - z
                } else {
                    z - 0.4
                };
                let wave = (3.0 * std::f64::consts::TAU * (z - 0.4)).sin();
                let down = if (0.4..0.9).contains(&z) { wave } else { 0.0 };
                [way - z, depth * down, 0.0]
            })
        };
        plan.start = Some(Start {
            file: "loop.safetensors".into(),
            load: plan.tube.rest(),
            state: fixture::state(&plan, 0),
        });
        plan.contact = true;
        assert!(Study::new(&plan).is_ok());
        for depth in [0.05, -0.05] {
            if let Some(start) = &mut plan.start {
                start.state.u = looped(depth);
            }
            plan.contact = true;
            let refused = Study::new(&plan).err().expect("a refusal").to_string();
            assert_eq!(
                refused,
                "the state to start from passes through itself at the outer wall, and a wall with contact cannot: start \
                 from an earlier state, or set contact = false"
            );
            plan.contact = false;
            assert!(Study::new(&plan).is_ok());
        }
    }
}
