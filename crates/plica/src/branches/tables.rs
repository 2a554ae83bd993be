//! Branches and their special points as tables.

use super::{Branch, Branches, PointKind, SpecialPoint};

/// Columns of the history that a branch, which has no time and no work, does not have.
const LEFT_OUT: [&str; 10] = [
    "step",
    "stage",
    "time",
    "damping_work",
    "released_energy",
    "method",
    "equilibrium",
    "iterations",
    "cg_iterations",
    "seconds",
];

impl Branch {
    /// Returns its table as CSV.
    pub fn csv(&self) -> Vec<u8> {
        csv_of(&self.records())
    }

    /// Returns its table, the header first: arc length, parameter, label, number of negative eigenvalues of each mode, and
    /// the columns of the history that belong to a state alone.
    pub fn records(&self) -> Vec<Vec<String>> {
        let modes = self.states.iter().map(|state| state.negative.len()).max();
        let modes = modes.unwrap_or(0);
        let mut records = vec![];
        for state in &self.states {
            let cells = state.row.cells().into_iter().filter(|cell| {
                !LEFT_OUT.contains(&cell.name.as_str()) && !cell.name.starts_with("work_")
            });
            let (names, texts): (Vec<String>, Vec<String>) =
                cells.map(|cell| (cell.name, cell.text)).unzip();
            if records.is_empty() {
                let mut header = ["arc_length", "parameter", "label"]
                    .map(String::from)
                    .to_vec();
                header.extend((0..modes).map(|mode| format!("negative_mode_{mode}")));
                header.extend(names);
                records.push(header);
            }
            let mut record = vec![
                state.s.to_string(),
                state.parameter.to_string(),
                state.label.clone().unwrap_or_default(),
            ];
            record.extend((0..modes).map(|mode| {
                let count = state.negative.get(mode);
                count.map_or(String::new(), ToString::to_string)
            }));
            record.extend(texts);
            records.push(record);
        }
        records
    }
}

/// Returns records as CSV.
fn csv_of(records: &[Vec<String>]) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(vec![]);
    for record in records {
        // Writing to memory does not fail, and all records have the same length.
        let _ = table.write_record(record);
    }
    table.into_inner().unwrap_or_default()
}

impl Branches {
    /// Returns the table of the special points as CSV.
    pub fn points_csv(&self) -> Vec<u8> {
        csv_of(&self.point_records())
    }

    /// Returns the table of the special points, the header first.
    pub fn point_records(&self) -> Vec<Vec<String>> {
        let header = [
            "label",
            "branch",
            "arc_length",
            "parameter",
            "bracket_from",
            "bracket_to",
            "event",
            "alpha",
            "gamma",
            "beta",
            "gap",
            "curvature",
            "eigenvalue_rate",
        ];
        let mut records = vec![header.map(String::from).to_vec()];
        records.extend(self.points.iter().map(SpecialPoint::record));
        records
    }

    /// Returns a summary for people: a line for every special point and for every branch.
    pub fn summary(&self) -> String {
        let mut lines = format!(
            "  {:<7} {:>6}  {:>14}  event\n",
            "point", "branch", self.parameter
        );
        for point in &self.points {
            let value = format!("{:.8}", Significant(point.parameter));
            lines += &format!(
                "  {:<7} {:>6}  {value:>14}  {}\n",
                point.label,
                point.branch,
                point.describe()
            );
        }
        for branch in &self.branches {
            let from = match &branch.from {
                Some(label) => format!(", from {label},"),
                None => String::new(),
            };
            lines += &format!(
                "  branch {}{from} {} after {} states\n",
                branch.number,
                branch.end,
                branch.states.len()
            );
        }
        lines
    }
}

/// A number with as many significant digits as the precision says.
struct Significant(f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(6) as i32;
        let before = match self.0.abs() {
            0.0 => 1,
            size => size.log10().floor() as i32 + 1,
        };
        if before < -2 {
            return write!(f, "{:.*e}", (digits - 1).max(0) as usize, self.0);
        }
        write!(f, "{:.*}", (digits - before).max(0) as usize, self.0)
    }
}

impl SpecialPoint {
    fn record(&self) -> Vec<String> {
        let [alpha, gamma, beta, gap] = match &self.kind {
            PointKind::BranchPoint(Some((form, gap))) => {
                [form.alpha, form.gamma, form.beta, *gap].map(Some)
            }
            _ => [None; 4],
        };
        let curvature = match &self.kind {
            PointKind::Fold(curvature) => *curvature,
            PointKind::BranchPoint(Some((form, _))) if form.is_pitchfork() => {
                Some(2.0 * form.curvature())
            }
            _ => None,
        };
        let rate = match &self.kind {
            PointKind::Mode(_, rate) => Some(*rate),
            _ => None,
        };
        let number = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:.6e}"));
        vec![
            self.label.clone(),
            self.branch.to_string(),
            self.s.to_string(),
            self.parameter.to_string(),
            self.bracket[0].to_string(),
            self.bracket[1].to_string(),
            self.describe(),
            number(alpha),
            number(gamma),
            number(beta),
            number(gap),
            number(curvature),
            number(rate),
        ]
    }
}
