//! Whether Plica is right: cases whose answer is known otherwise, each a few rows of one table.
//!
//! | file | holds |
//! |---|---|
//! | [`one_dimension`] | the reference side: a tube of circles, and the waves that may grow on it; nothing else of the library is used there |
//! | `specimen` | Plica's side: rings and tubes between sliding plates |
//! | `rings`, `columns` | pressure, growth, buckling, thin and long limits |
//! | [`row`], `found` | rows, the table, the page |
//!
//! A row that is too far off says FAILED; its tolerance is the one that the mesh at hand should keep.
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod columns;
mod found;
pub mod one_dimension;
mod rings;
pub mod row;
pub mod specimen;

pub use found::{Findings, Observer, Trouble, Verification};
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
    quick("lame", "a ring under a small pressure", rings::lame),
    quick("inflation", "a ring that is blown up", rings::inflation),
    quick("growth", "a closed ring that has grown", rings::growth),
    quick(
        "ring-buckling",
        "rings under pressure from outside",
        rings::buckling,
    ),
    quick("thin-ring", "thinner and thinner rings", rings::thin_limit),
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
