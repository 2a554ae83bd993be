//! Rows of the table: a computed quantity, its reference and its tolerance.

use std::fmt::Write as _;

/// Largest accepted error of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Relative to the reference.
    Relative(f64),
    /// In the unit of the quantity.
    Absolute(f64),
}

/// A computed quantity with its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Problem for which it is computed.
    pub case: String,
    /// Name of the quantity; symbols are those of docs/model.md.
    pub quantity: String,
    /// Value computed by Plica; NaN if the computation failed.
    pub computed: f64,
    /// Reference value.
    pub reference: f64,
    /// Source of the reference value.
    pub source: String,
    /// Largest accepted error.
    pub tolerance: Tolerance,
    /// Error message of a failed computation.
    pub failure: Option<String>,
}

impl Row {
    /// Returns the error, relative or absolute as the tolerance is.
    pub fn error(&self) -> f64 {
        let difference = (self.computed - self.reference).abs();
        match self.tolerance {
            Tolerance::Relative(_) => difference / self.reference.abs(),
            Tolerance::Absolute(_) => difference,
        }
    }

    /// Returns whether the error is within the tolerance; false for NaN.
    pub fn passes(&self) -> bool {
        let (Tolerance::Relative(most) | Tolerance::Absolute(most)) = self.tolerance;
        self.error() <= most
    }
}

impl Tolerance {
    fn text(self) -> String {
        match self {
            Self::Relative(most) => short(most),
            Self::Absolute(most) => format!("± {}", short(most)),
        }
    }
}

/// Headings of the table's columns.
const COLUMNS: [&str; 8] = [
    "case",
    "quantity",
    "computed",
    "reference",
    "error",
    "tolerance",
    "",
    "source",
];

/// Returns the cells of a row, in the order of the columns.
fn cells(row: &Row) -> [String; 8] {
    [
        row.case.clone(),
        row.quantity.clone(),
        long(row.computed),
        long(row.reference),
        short(row.error()),
        row.tolerance.text(),
        if row.passes() { "ok" } else { "FAILED" }.into(),
        match &row.failure {
            Some(failure) => format!("{} ({failure})", row.source),
            None => row.source.clone(),
        },
    ]
}

/// Formats a number with eight digits.
fn long(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (1e-2..1e4).contains(&x.abs()) {
        let before = x.abs().log10().floor() as i32;
        format!("{x:.*}", (7 - before).clamp(0, 9) as usize)
    } else {
        format!("{x:.7e}")
    }
}

fn short(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else {
        format!("{x:.1e}")
    }
}

/// Returns the rows as a table in aligned columns, for a terminal.
pub fn in_columns(rows: &[Row]) -> String {
    let cells: Vec<[String; 8]> = std::iter::once(COLUMNS.map(String::from))
        .chain(rows.iter().map(cells))
        .collect();
    let widths: [usize; 8] = std::array::from_fn(|i| {
        let widths = cells.iter().map(|row| row[i].chars().count());
        widths.max().unwrap_or(0)
    });
    let mut text = String::new();
    let mut case = "";
    for (at, row) in cells.iter().enumerate() {
        let mut line = String::new();
        for (i, cell) in row.iter().enumerate() {
            // A case is written in its first row only.
            let cell = if i == 0 && at > 0 && cell == case {
                ""
            } else {
                cell
            };
            let space = " ".repeat(widths[i] - cell.chars().count());
            let _ = match i {
                2..=5 => write!(line, "{space}{cell}  "),
                _ => write!(line, "{cell}{space}  "),
            };
        }
        case = &row[0];
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// Returns the rows as a table of Markdown.
pub fn in_markdown(rows: &[Row]) -> String {
    let line = |cells: [String; 8]| {
        format!(
            "| {} |\n",
            cells.map(|cell| cell.replace('|', "\\|")).join(" | ")
        )
    };
    let mut text = line(COLUMNS.map(String::from));
    text += "|---|---|--:|--:|--:|--:|---|---|\n";
    for row in rows {
        text += &line(cells(row));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(computed: f64, tolerance: Tolerance) -> Row {
        Row {
            case: "ring".into(),
            quantity: "u(A)".into(),
            computed,
            reference: 2.0,
            source: "Lamé".into(),
            tolerance,
            failure: None,
        }
    }

    #[test]
    fn a_row_passes_within_its_tolerance_and_never_with_nan() {
        assert!(row(2.001, Tolerance::Relative(1e-3)).passes());
        assert!(!row(2.003, Tolerance::Relative(1e-3)).passes());
        assert!(row(2.003, Tolerance::Absolute(4e-3)).passes());
        assert!(!row(2.003, Tolerance::Absolute(2e-3)).passes());
        assert!(!row(f64::NAN, Tolerance::Relative(1.0)).passes());
    }

    #[test]
    fn columns_are_aligned() {
        let rows = [
            row(2.0, Tolerance::Relative(1e-3)),
            row(1.5, Tolerance::Absolute(1e-3)),
        ];
        let text = in_columns(&rows);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[1].find("2.0000000"),
            Some(lines[0].find("computed").unwrap() - 1)
        );
        assert!(lines[1].ends_with("ok      Lamé") && lines[2].contains("FAILED"));
        assert_eq!(in_markdown(&rows).lines().count(), 4);
    }
}
