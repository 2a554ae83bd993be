//! What is found, as tables.

use super::{Change, How, Stability, Station};
use crate::equilibrium::{UnstableMode, mode_effect};
use crate::run_directory::{RunDirectory, RunError};
use crate::saved_state::Array;
use crate::tube::Tube;
use std::fmt::Write;

impl Change {
    /// Lost, or regained.
    pub fn verb(&self) -> &'static str {
        if self.is_loss() { "lost" } else { "regained" }
    }

    /// The critical value with so many digits; a word where there is none.
    fn critical(&self, digits: usize) -> String {
        match self.how {
            How::Smooth => self.quantity.format(self.critical, digits),
            How::Snap => "a snap".into(),
            How::Unfollowed => "unknown".into(),
        }
    }
}

impl How {
    /// In one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Snap => "snap",
            Self::Unfollowed => "unfollowed",
        }
    }
}

impl Stability {
    /// The table of critical values, as the program prints it.
    pub fn table(&self, tube: &Tube) -> String {
        let mut page = String::new();
        let states = self.stations.iter().filter(|s| s.row.is_some()).count();
        let highest = self.highest;
        if self.changes.is_empty() {
            let unstable = |s: &&Station| s.tested.iter().any(|t| t.negative > 0);
            let what = match self.stations.iter().filter(unstable).count() {
                0 => "stable",
                _ => "as unstable as at rest",
            };
            return format!("  all {states} states are {what}, to harmonics 0 to {highest}\n");
        }
        let stage = |change: &Change| change.stage.chars().count();
        let width = self.changes.iter().map(stage).max().unwrap_or(0).max(5);
        // Digits that the tolerance leaves, and one more.
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
            "  {:<width$}  {:>8}  {:<24}  {:<8}  {:>8}  {:<at$}  {:>wide$}  {:>wide$}  {:>wide$}",
            "stage", "harmonic", "the tube", "", "unstable", "at", "critical", "from", "to",
        );
        for change in &self.changes {
            let [before, after] = change.negative;
            let [from, to] = change.between.map(|x| change.quantity.format(x, digits));
            let _ = writeln!(
                page,
                "  {:<width$}  {:>8}  {:<24}  {:<8}  {:>8}  {:<at$}  {:>wide$}  {from:>wide$}  {to:>wide$}",
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
            let place = match change.how {
                How::Smooth => format!("{name} = {}", written(change.critical)),
                how => format!("{name} = {from} to {to} ({})", how.name()),
            };
            let n = change.harmonic;
            format!(
                "{}, at {place}",
                UnstableMode::Circumferential(n).describe()
            )
        });
        let line = |page: &mut String, name: &str, value: &str| {
            let _ = writeln!(page, "  {name:<22} {value}");
        };
        line(&mut page, "first to go", &first);
        let tested = format!("{states} states, harmonics 0 to {highest}");
        line(&mut page, "tested", &tested);
        page
    }

    /// Writes `stability.csv`, `eigenvalues.csv` and the modes into the directory of the run;
    /// gives their names.
    ///
    /// # Errors
    /// [`RunError`] if a file cannot be written.
    pub fn write(&self, tube: &Tube, directory: &RunDirectory) -> Result<Vec<String>, RunError> {
        directory.clear_stability()?;
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
        Ok(names)
    }

    fn critical_values(&self, tube: &Tube) -> Vec<Vec<String>> {
        let header = [
            "number",
            "stage",
            "harmonic",
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
                change.how.name().into(),
            ]);
        }
        rows
    }

    fn eigenvalues(&self, tube: &Tube) -> Vec<Vec<String>> {
        let named = ["state", "stage", "along", "length_ratio", "diameter_ratio"];
        let mut header = named.map(str::to_owned).to_vec();
        for what in ["negative", "lowest"] {
            header.extend((0..=self.highest).map(|n| format!("{what}_{n}")));
        }
        let mut rows = vec![header];
        for Station {
            stage,
            row,
            along,
            load,
            tested,
        } in &self.stations
        {
            let mut cells = vec![
                row.map(|row| row.to_string()).unwrap_or_default(),
                stage.clone(),
                format!("{along:.9}"),
                format!("{:.9}", tube.length_ratio(load)),
                format!("{:.9}", tube.diameter_ratio(load)),
            ];
            cells.extend(tested.iter().map(|tested| tested.negative.to_string()));
            cells.extend(tested.iter().map(|tested| format!("{:.9e}", tested.lowest)));
            rows.push(cells);
        }
        rows
    }
}
