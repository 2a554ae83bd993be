//! Tables of the stability of a path.

use super::{PathStability, StabilityChange, TestedState, Transition};
use crate::equilibrium::{UnstableMode, mode_effect};
use crate::run_directory::{RunDirectory, RunError, StabilityCoverage};
use crate::saved_state::Array;
use crate::tube::Tube;
use std::fmt::Write;

impl StabilityChange {
    /// Returns `lost` or `regained`.
    pub fn verb(&self) -> &'static str {
        if self.is_loss() { "lost" } else { "regained" }
    }

    /// Formats the critical value, or says why there is none.
    fn critical(&self, digits: usize) -> String {
        match self.transition {
            Transition::Smooth => self.quantity.format(self.critical, digits),
            Transition::Snap => "a snap".into(),
            Transition::Unfollowed => "unknown".into(),
        }
    }
}

impl Transition {
    /// Returns its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Snap => "snap",
            Self::Unfollowed => "unfollowed",
        }
    }
}

impl PathStability {
    /// Returns the table of critical values that `plica stability` prints.
    pub fn table(&self, tube: &Tube) -> String {
        let mut page = String::new();
        let states = self.coverage().states.len();
        let numbers = self.coverage().list();
        let highest = self.highest;
        let line = |page: &mut String, name: &str, value: &str| {
            let _ = writeln!(page, "  {name:<22} {value}");
        };
        if self.changes.is_empty() {
            let unstable = |s: &TestedState| s.modes.iter().any(|mode| mode.negative > 0);
            let verdict = match self.states.iter().any(unstable) {
                true => "unstable to the same of the circumferential modes",
                false => "stable to circumferential modes",
            };
            let _ = writeln!(
                page,
                "  all {states} states ({numbers}) are {verdict} 0 to {highest}"
            );
            if self.leaves_out_friction {
                line(&mut page, "left out", "friction");
            }
            return page;
        }
        let stage = |change: &StabilityChange| change.stage.chars().count();
        let width = self.changes.iter().map(stage).max().unwrap_or(0).max(5);
        // One digit more than the tolerance.
        let digits = (1.0 - self.tolerance.log10().floor()).clamp(3.0, 12.0) as usize;
        let pressures = self.changes.iter().any(|c| c.quantity.is_pressure());
        let wide = digits + if pressures { 6 } else { 3 };
        let names = self.changes.iter().map(|c| c.quantity.name(tube));
        let at = names
            .map(|name| name.chars().count())
            .max()
            .unwrap_or(0)
            .max(6);
        let _ = writeln!(
            page,
            "  {:<width$}  {:>4}  {:<24}  {:<9}  {:>8}  {:<at$}  {:>wide$}  {:>wide$}  {:>wide$}",
            "stage", "mode", "the tube", "stability", "negative", "at", "critical", "from", "to",
        );
        for change in &self.changes {
            let [before, after] = change.negative;
            let [from, to] = change.between.map(|x| change.quantity.format(x, digits));
            let _ = writeln!(
                page,
                "  {:<width$}  {:>4}  {:<24}  {:<9}  {:>8}  {:<at$}  {:>wide$}  {from:>wide$}  {to:>wide$}",
                change.stage,
                change.harmonic,
                mode_effect(change.harmonic),
                change.verb(),
                format!("{before} > {after}"),
                change.quantity.name(tube),
                change.critical(digits),
            );
        }
        let first = self.first_loss().map_or("none".into(), |change| {
            let name = change.quantity.name(tube);
            let written = |x| change.quantity.format(x, digits);
            let [from, to] = change.between.map(written);
            let place = match change.transition {
                Transition::Smooth => format!("{name} = {}", written(change.critical)),
                transition => {
                    format!("{name} = {from} to {to} ({})", transition.name())
                }
            };
            let n = change.harmonic;
            format!(
                "{}, at {place}",
                UnstableMode::Circumferential(n).describe()
            )
        });
        line(&mut page, "first loss", &first);
        let tested = format!("{states} states ({numbers}), circumferential modes 0 to {highest}");
        line(&mut page, "tested", &tested);
        if self.leaves_out_friction {
            line(&mut page, "left out", "friction");
        }
        page
    }

    /// Writes `stability.csv`, `eigenvalues.csv` and the modes into the directory of the run; returns their names.
    ///
    /// # Errors
    /// [`RunError`] if a file cannot be written.
    pub fn write(&self, tube: &Tube, directory: &RunDirectory) -> Result<Vec<String>, RunError> {
        let mut names = vec!["stability.csv".to_owned(), "eigenvalues.csv".to_owned()];
        directory.write_records(&names[0], self.critical_values(tube))?;
        directory.write_records(&names[1], self.eigenvalues(tube))?;
        for (number, mode) in self.modes() {
            let [axial, thickness, components, _] = mode.state.layout.shape();
            let mut state = mode.state.clone();
            let scalar = |x: f64| Array {
                shape: vec![],
                values: vec![x],
            };
            let shape = Array {
                shape: vec![axial, thickness, components],
                values: mode.shape.clone(),
            };
            state.arrays = [
                ("mode".to_owned(), shape),
                ("harmonic".to_owned(), scalar(mode.harmonic as f64)),
                ("eigenvalue".to_owned(), scalar(mode.eigenvalue)),
            ]
            .into();
            let name = format!("mode-{number:02}-harmonic-{}", mode.harmonic);
            names.push(directory.write_mode(&name, &state)?);
        }
        // Last, so that earlier results stay until these are complete.
        directory.keep_stability(&names, Some(self.coverage()))?;
        Ok(names)
    }

    /// Returns the saved states and the modes that were tested.
    pub fn coverage(&self) -> StabilityCoverage {
        StabilityCoverage {
            states: self.states.iter().filter_map(|state| state.row).collect(),
            highest_mode: Some(self.highest),
        }
    }

    fn critical_values(&self, tube: &Tube) -> Vec<Vec<String>> {
        let header = [
            "number",
            "stage",
            "mode",
            "effect",
            "change",
            "quantity",
            "critical",
            "from",
            "to",
            "negative_before",
            "negative_after",
            "how",
        ];
        let mut rows = vec![header.map(str::to_owned).to_vec()];
        for (number, change) in (1..).zip(&self.changes) {
            let [before, after] = change.negative;
            let written = |x| change.quantity.format(x, 9);
            let [from, to] = change.between.map(written);
            rows.push(vec![
                format!("{number}"),
                change.stage.clone(),
                format!("{}", change.harmonic),
                mode_effect(change.harmonic),
                change.verb().into(),
                change.quantity.name(tube),
                written(change.critical),
                from,
                to,
                format!("{before}"),
                format!("{after}"),
                change.transition.name().into(),
            ]);
        }
        rows
    }

    fn eigenvalues(&self, tube: &Tube) -> Vec<Vec<String>> {
        let named = ["state", "stage", "along", "length_ratio", "diameter_ratio"];
        let mut header = named.map(str::to_owned).to_vec();
        for name in ["negative", "lowest"] {
            header.extend((0..=self.highest).map(|n| format!("{name}_{n}")));
        }
        let mut rows = vec![header];
        for TestedState {
            stage,
            row,
            along,
            load,
            modes,
        } in &self.states
        {
            let mut cells = vec![
                row.map(|row| row.to_string()).unwrap_or_default(),
                stage.clone(),
                format!("{along:.9}"),
                format!("{:.9}", tube.length_ratio(load)),
                format!("{:.9}", tube.diameter_ratio(load)),
            ];
            cells.extend(modes.iter().map(|mode| mode.negative.to_string()));
            cells.extend(modes.iter().map(|mode| format!("{:.9e}", mode.lowest)));
            rows.push(cells);
        }
        rows
    }
}
