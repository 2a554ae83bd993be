//! Whether Plica is right: cases whose answer is known otherwise, each a few rows of one table.
//!
//! | file | holds |
//! |---|---|
//! | [`one_dimension`] | the reference side: a tube of circles, and the waves that may grow on it; nothing else of the library is used there |
//! | `specimen` | Plica's side: rings and tubes between sliding plates |
//! | `exact` | what must be so to rounding |
//! | `rings`, `columns` | pressure, growth, buckling, thin and long limits |
//! | `locking` | a thick cylinder that is nearly incompressible |
//! | `manufactured` | orders of convergence |
//! | `routes` | the same answer by a second way through the code |
//! | `paper` | the main case of Okino et al. (2025) |
//! | [`row`], `found` | rows, the table, the page |
//!
//! A row that is too far off says FAILED; its tolerance is the one that the mesh at hand should keep.
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod columns;
mod exact;
mod found;
mod locking;
mod manufactured;
pub mod one_dimension;
mod paper;
mod rings;
mod routes;
pub mod row;
mod specimen;

pub use found::{Findings, Observer, TITLE, Trouble, Verification};
pub use row::{Row, Tolerance};

/// Something that is checked.
pub struct Check {
    /// Its name, for those who want it alone.
    pub name: &'static str,
    /// What is checked.
    pub about: &'static str,
    /// Whether the quick verification leaves it out.
    pub slow: bool,
    run: fn(&mut Findings<'_>) -> Result<(), Trouble>,
}

/// All checks, in the order of the table.
pub const CHECKS: &[Check] = &[
    quick("rest", "a tube at rest", exact::rest),
    quick(
        "free-growth",
        "a tube that is free to grow",
        exact::free_growth,
    ),
    quick(
        "objectivity",
        "a tube that is turned as a whole",
        exact::objectivity,
    ),
    quick("frame", "muscles that are turned", exact::frame),
    quick("splines", "what splines draw", exact::splines),
    quick("lame", "a ring under a small pressure", rings::lame),
    quick("inflation", "a ring that is blown up", rings::inflation),
    quick(
        "quadratic-law",
        "the quadratic law, blown up",
        rings::quadratic,
    ),
    quick("growth", "a closed ring that has grown", rings::growth),
    quick(
        "ring-buckling",
        "rings under pressure from outside",
        rings::buckling,
    ),
    quick("thin-ring", "thinner and thinner rings", rings::thin_limit),
    quick(
        "thick-cylinder",
        "a thick cylinder that is nearly incompressible",
        locking::thick_cylinder,
    ),
    quick(
        "thick-contraction",
        "a thick tube that contracts, with one element through it",
        locking::contraction,
    ),
    quick(
        "orders",
        "manufactured solutions, finer and finer",
        manufactured::orders,
    ),
    quick("plates", "a tube between plates", columns::plates),
    quick(
        "thin-shell",
        "thinner and thinner tubes between plates",
        columns::thin_shell,
    ),
    quick(
        "column",
        "longer and longer tubes between plates",
        columns::column,
    ),
    quick("tangents", "tangents against differences", routes::tangents),
    quick(
        "solvers",
        "two ways to solve with a tangent",
        routes::solvers,
    ),
    quick("symmetries", "one ring, a fold, all", routes::symmetries),
    quick(
        "schemes",
        "Newton, relaxation, pseudo-time",
        routes::schemes,
    ),
    quick("threads", "one thread, several", routes::threads),
    quick("main-case", "the paper's main case", paper::main_case),
    slow(
        "main-case-radii",
        "where the main case is narrowest",
        paper::narrowest,
    ),
    slow(
        "main-case-stability",
        "which harmonics the main case loses",
        paper::stability,
    ),
    slow(
        "main-case-meshes",
        "the main case on finer and finer meshes",
        paper::meshes,
    ),
    slow(
        "relaxation-alone",
        "which harmonics relaxation alone loses",
        paper::relaxation_alone,
    ),
];

const fn quick(
    name: &'static str,
    about: &'static str,
    run: fn(&mut Findings<'_>) -> Result<(), Trouble>,
) -> Check {
    Check {
        name,
        about,
        slow: false,
        run,
    }
}

const fn slow(
    name: &'static str,
    about: &'static str,
    run: fn(&mut Findings<'_>) -> Result<(), Trouble>,
) -> Check {
    Check {
        slow: true,
        ..quick(name, about, run)
    }
}

/// Holds every check whose name `wanted` says yes to: those of the quick verification, or all.
///
/// # Errors
/// [`Trouble::Stopped`] if the observer asked to stop. Any other trouble is a row of its own.
pub fn verify(
    full: bool,
    wanted: &dyn Fn(&Check) -> bool,
    observer: &mut dyn Observer,
) -> Result<Verification, Trouble> {
    let checks: Vec<&Check> = CHECKS
        .iter()
        .filter(|check| (full || !check.slow) && wanted(check))
        .collect();
    let mut found = Findings::new(full, observer);
    for (done, check) in checks.iter().enumerate() {
        found.begins(check.about, done, checks.len());
        found.case = check.about.into();
        match (check.run)(&mut found) {
            Ok(()) => {}
            Err(Trouble::Stopped) => return Err(Trouble::Stopped),
            Err(trouble) => found.failed(&trouble),
        }
    }
    Ok(Verification {
        full,
        rows: found.rows,
        charts: found.charts,
    })
}
