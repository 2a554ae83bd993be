//! Tables of the lowest eigenvalues.

use super::{Eigenvalue, Spectra, Spectrum};
use crate::run_directory::{RunDirectory, RunError, StabilityCoverage};
use crate::tube::Tube;
use std::fmt::Write;

/// Name of the table.
pub(super) const PAIRS: &str = "eigenpairs.csv";

impl Spectra {
    /// Returns the table of eigenvalues that `plica stability` prints.
    pub fn table(&self, tube: &Tube) -> String {
        let mut page = String::new();
        let stage = |state: &Spectrum| state.stage.chars().count();
        let width = self.states.iter().map(stage).max().unwrap_or(0).max(5);
        let _ = writeln!(
            page,
            "  {:>5}  {:<width$}  {:>7}  {:>7}  {:>8}  {:>4}  {:>12}  {:>8}  circumferential modes",
            "state", "stage", "Lmax/L", "Dmin/D", "unstable", "mode", "eigenvalue", "residual",
        );
        for state in &self.states {
            for (number, eigenvalue) in (1..).zip(&state.lowest) {
                let columns = if number == 1 {
                    format!(
                        "{:>5}  {:<width$}  {:>7.4}  {:>7.4}  {:>8}",
                        state.row,
                        state.stage,
                        tube.length_ratio(&state.load),
                        tube.diameter_ratio(&state.load),
                        state.unstable(),
                    )
                } else {
                    " ".repeat(width + 35)
                };
                let _ = writeln!(
                    page,
                    "  {columns}  {number:>4}  {:>12.5e}  {:>8.0e}  {}",
                    eigenvalue.value,
                    eigenvalue.residual,
                    eigenvalue.content(),
                );
            }
        }
        let inaccurate = self.states.iter().flat_map(|state| &state.lowest);
        let inaccurate = inaccurate.filter(|eigenvalue| !eigenvalue.found).count();
        if inaccurate > 0 {
            let _ = writeln!(
                page,
                "  {inaccurate} eigenvalue(s) were not found to full accuracy; their residuals show the error"
            );
        }
        let _ = writeln!(page, "  {:<22} states {}", "tested", self.coverage().list());
        if self.leaves_out_friction {
            let _ = writeln!(page, "  {:<22} friction", "left out");
        }
        page
    }

    /// Returns the states whose eigenvalues were computed.
    pub fn coverage(&self) -> StabilityCoverage {
        StabilityCoverage {
            states: self.states.iter().map(|state| state.row).collect(),
            highest_mode: None,
        }
    }

    /// Writes `eigenpairs.csv` into the directory of the run.
    ///
    /// # Errors
    /// [`RunError`] if the file cannot be written.
    pub fn write(&self, tube: &Tube, directory: &RunDirectory) -> Result<String, RunError> {
        let header = [
            "state",
            "stage",
            "along",
            "length_ratio",
            "diameter_ratio",
            "mode",
            "eigenvalue",
            "residual",
            "found",
            "iterations",
            "circumferential_mode",
            "shares",
        ];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for state in &self.states {
            for (number, eigenvalue) in (1..).zip(&state.lowest) {
                let shares = eigenvalue.parts();
                let shares = shares.iter().map(|(n, share)| format!("{n}:{share:.4}"));
                rows.push(vec![
                    format!("{}", state.row),
                    state.stage.clone(),
                    format!("{:.9}", state.along),
                    format!("{:.9}", tube.length_ratio(&state.load)),
                    format!("{:.9}", tube.diameter_ratio(&state.load)),
                    format!("{number}"),
                    format!("{:.9e}", eigenvalue.value),
                    format!("{:.2e}", eigenvalue.residual),
                    if eigenvalue.found { "yes" } else { "no" }.into(),
                    format!("{}", state.iterations),
                    format!("{}", eigenvalue.harmonic()),
                    shares.collect::<Vec<_>>().join(" "),
                ]);
            }
        }
        let name = PAIRS.to_owned();
        directory.write_records(&name, rows)?;
        let mut names = self.modes.clone();
        names.push(name.clone());
        directory.keep_stability(&names, Some(self.coverage()))?;
        Ok(name)
    }
}

impl Spectrum {
    /// Formats the number of negative eigenvalues; `>=` marks a count that may be incomplete.
    pub fn unstable(&self) -> String {
        match self.negative() {
            (count, true) => format!("{count}"),
            (count, false) => format!(">= {count}"),
        }
    }
}

impl Eigenvalue {
    /// Formats the largest shares of circumferential modes, for example `2 (97 %), 4 (3 %)`.
    pub fn content(&self) -> String {
        let parts = self.parts();
        let part = |(n, share): &(usize, f64)| format!("{n} ({:.0} %)", 100.0 * share);
        parts
            .iter()
            .take(4)
            .map(part)
            .collect::<Vec<_>>()
            .join(", ")
    }
}
