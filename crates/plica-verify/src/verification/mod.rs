//! Verification: quantities computed by Plica against reference values, as rows of one table.
//!
//! | module | contents |
//! |---|---|
//! | [`one_dimension`] | independent reference solution of axisymmetric tubes and their buckling |
//! | [`layered_wall`] | independent reference solution of tubes of layers with fibres |
//! | `tube_model` | the tubes that Plica solves for the comparisons |
//! | `exact` | identities that hold to rounding |
//! | `layers`, `layer_orders` | layers, laws, fibres and residual stretches; orders of convergence through layers |
//! | `rings`, `columns` | pressure, growth, buckling; limits of thin walls and long tubes |
//! | `volume` | tubes inflated by the volume of their lumen |
//! | `branches`, `chains` | folds and branch points with closed forms; a tube followed past its pressure maximum |
//! | `locking` | nearly incompressible thick walls |
//! | `manufactured` | orders of convergence on manufactured solutions |
//! | `contact`, `contact_pressure` | contact with obstacles, and its pressure along the tube |
//! | `cross_checks` | the same result computed in two ways |
//! | `main_case` | the main case of Okino et al. (2025) |
//! | [`row`], `report` | rows, table and page |
//!
//! A row outside its tolerance is marked FAILED. Tolerances are those that the meshes used should keep.
#![allow(non_snake_case)] // formulas keep the letters of their sources

mod active_stress;
mod branches;
mod chains;
mod columns;
mod contact;
mod contact_pressure;
mod creases;
mod cross_checks;
mod elastica;
mod error;
mod exact;
mod friction;
mod layer_orders;
pub mod layered_wall;
mod layers;
mod locking;
mod main_case;
mod manufactured;
pub mod one_dimension;
mod patches;
mod report;
mod rings;
pub mod row;
mod self_contact;
mod tube_model;
mod volume;

pub use error::VerificationError;
pub use report::{Recorder, TITLE, Verification};
pub use row::{Row, Tolerance};

use plica::monitor::Monitor;

/// A check: some rows of the table.
pub struct Check {
    /// Name by which it is selected.
    pub name: &'static str,
    /// Subject of the check.
    pub description: &'static str,
    /// True if only the full verification includes it.
    pub slow: bool,
    run: fn(&mut Recorder<'_>) -> Result<(), VerificationError>,
}

/// All checks, in the order of the table.
pub const CHECKS: &[Check] = &[
    quick("rest", "a tube at rest", exact::rest),
    quick(
        "free-growth",
        "stress-free growth of a tube with a free end",
        exact::free_growth,
    ),
    quick(
        "objectivity",
        "rigid motion of an active tube",
        exact::objectivity,
    ),
    quick(
        "muscle-rotation",
        "rotation of an uneven muscle",
        exact::muscle_rotation,
    ),
    quick(
        "splines",
        "spline circle and projection on splines",
        exact::splines,
    ),
    quick("lame", "a ring under a small pressure", rings::lame),
    quick("inflation", "finite inflation of a ring", rings::inflation),
    quick(
        "quadratic-law",
        "finite inflation with the quadratic volumetric energy",
        rings::quadratic,
    ),
    quick(
        "growth",
        "circumferential growth of a closed ring",
        rings::growth,
    ),
    quick(
        "mooney-rivlin",
        "inflation and growth of a Mooney–Rivlin ring",
        rings::mooney_rivlin,
    ),
    quick("laws", "inflation of rings of other laws", layers::laws),
    quick(
        "layer-orders",
        "orders of convergence through a wall of layers",
        layer_orders::orders,
    ),
    quick("artery", "inflation of a carotid artery", layers::artery),
    quick(
        "active-stress",
        "tubes whose muscles contract under pressure",
        active_stress::constriction,
    ),
    quick(
        "opening-angle",
        "a carotid artery that springs open",
        layers::opening_angle,
    ),
    quick(
        "helical-fibres",
        "twist of a tube with fibres of one hand",
        layers::helical_fibres,
    ),
    quick(
        "patch-growth",
        "growth of a patch through the wall",
        patches::growth,
    ),
    quick(
        "foundation",
        "a ring and a tube on elastic foundations",
        patches::foundation,
    ),
    quick(
        "lumen-volume",
        "inflation of a ring by volume, past a pressure maximum",
        volume::ring,
    ),
    quick(
        "lumen-symmetries",
        "inflation by volume in all symmetries",
        volume::symmetries,
    ),
    quick(
        "branches",
        "folds and branch points of structures",
        branches::structures,
    ),
    quick(
        "balloon-branch",
        "a ring followed in the pressure past its maximum",
        branches::balloon,
    ),
    quick(
        "ring-buckling",
        "buckling of rings under external pressure",
        rings::buckling,
    ),
    quick("thin-ring", "buckling of thin rings", rings::thin_limit),
    quick(
        "thick-cylinder",
        "a thick, nearly incompressible cylinder",
        locking::thick_cylinder,
    ),
    quick(
        "thick-contraction",
        "contraction of a thick tube with one element through the wall",
        locking::contraction,
    ),
    quick(
        "convergence",
        "orders of convergence on manufactured solutions",
        manufactured::orders,
    ),
    quick(
        "compression",
        "a tube compressed between sliding plates",
        columns::plates,
    ),
    quick(
        "thin-shell",
        "axial buckling of thin shells",
        columns::thin_shell,
    ),
    quick("column", "Euler buckling of long tubes", columns::column),
    quick(
        "contact",
        "rings that contract onto a rod and grow into a sheath",
        contact::rings,
    ),
    quick(
        "contact-symmetries",
        "contact of one ring and of the whole tube",
        contact::symmetries,
    ),
    quick(
        "contact-patch",
        "even contact on a mesh of uneven elements",
        contact_pressure::patch_test,
    ),
    quick(
        "hertz",
        "a ball that widens in a thick tube",
        contact_pressure::hertz,
    ),
    quick(
        "flat-ring",
        "a ring whose opposite walls touch under pressure",
        self_contact::flat_ring,
    ),
    quick(
        "fold-symmetries",
        "a fold that touches itself, of one ring and of many",
        self_contact::symmetries,
    ),
    quick(
        "friction",
        "a tube in a sheath that is pushed to and fro",
        friction::sliding,
    ),
    quick(
        "pull-out",
        "a tube that is pulled out of a sheath",
        friction::pull_out,
    ),
    quick(
        "friction-symmetries",
        "friction of one ring and of the whole tube",
        friction::symmetries,
    ),
    quick(
        "plates",
        "a thin ring between rigid plates",
        contact::plates,
    ),
    quick(
        "tangents",
        "tangents against differences of the residual",
        cross_checks::tangents,
    ),
    quick(
        "solvers",
        "iterative against direct linear solver",
        cross_checks::solvers,
    ),
    quick(
        "symmetries",
        "one ring, a cyclic sector, the whole tube",
        cross_checks::symmetries,
    ),
    quick(
        "schemes",
        "Newton, relaxation, pseudo-time",
        cross_checks::schemes,
    ),
    quick(
        "threads",
        "one thread against several",
        cross_checks::threads,
    ),
    quick(
        "main-case",
        "the main case of the paper",
        main_case::main_case,
    ),
    quick("biot", "instability of a compressed surface", creases::biot),
    slow(
        "flat-contact",
        "a ring whose opposite walls touch along a line",
        self_contact::flat_contact,
    ),
    slow(
        "creases",
        "creases of a compressed surface",
        creases::creases,
    ),
    slow(
        "main-case-radii",
        "smallest radii of the main case",
        main_case::radii,
    ),
    slow(
        "main-case-stability",
        "stability of the main case to circumferential modes",
        main_case::stability,
    ),
    slow(
        "main-case-meshes",
        "mesh convergence of the main case",
        main_case::meshes,
    ),
    slow(
        "relaxation-alone",
        "stability of a tube that relaxes without contracting",
        main_case::relaxation_alone,
    ),
];

const fn quick(
    name: &'static str,
    description: &'static str,
    run: fn(&mut Recorder<'_>) -> Result<(), VerificationError>,
) -> Check {
    Check {
        name,
        description,
        slow: false,
        run,
    }
}

const fn slow(
    name: &'static str,
    description: &'static str,
    run: fn(&mut Recorder<'_>) -> Result<(), VerificationError>,
) -> Check {
    Check {
        slow: true,
        ..quick(name, description, run)
    }
}

/// Runs the selected checks of the quick or the full verification.
///
/// A check that ends with an error becomes a failed row. The monitor gets failed rows as notices.
///
/// # Errors
/// [`VerificationError::Cancelled`] if the monitor cancels.
pub fn verify(
    full: bool,
    selected: &dyn Fn(&Check) -> bool,
    monitor: &mut dyn Monitor,
) -> Result<Verification, VerificationError> {
    let checks: Vec<&Check> = CHECKS
        .iter()
        .filter(|check| (full || !check.slow) && selected(check))
        .collect();
    let mut recorder = Recorder::new(full, monitor);
    for (done, check) in checks.iter().enumerate() {
        recorder.begin(check.description, done, checks.len());
        match (check.run)(&mut recorder) {
            Ok(()) => {}
            Err(VerificationError::Cancelled) => return Err(VerificationError::Cancelled),
            Err(error) => recorder.failed(&error),
        }
    }
    Ok(recorder.finish())
}
