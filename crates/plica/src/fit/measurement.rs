//! Measurements of tension tests, and the table that they are read from.

use super::FitError;
use crate::homogeneous::Prescribed;
use crate::study::StressUnit;

/// A kind of stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressKind {
    /// Force per area at rest.
    Nominal,
    /// Force per deformed area.
    Cauchy,
}

/// A stress that was measured in a homogeneous deformation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The stretches; the stress in a direction without one is zero.
    pub prescribed: Prescribed,
    /// Direction of the stress: 0 along, 2 around.
    pub direction: usize,
    /// Kind of the stress.
    pub kind: StressKind,
    /// The stress.
    pub stress: f64,
}

/// The measurements of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    /// The measurements, in the order of the table.
    pub all: Vec<Measurement>,
    /// The unit of their stresses.
    pub unit: Option<StressUnit>,
}

/// Content of a column.
#[derive(Clone, Copy, PartialEq)]
enum Column {
    Stretch(usize),
    Stress(StressKind, usize),
}

impl Measurements {
    /// Reads a table with a header. A row with both stretches is a biaxial test; one with an empty cell, or a table without
    /// that column, is a test in which the stress in that direction is zero.
    ///
    /// # Errors
    /// [`FitError`] with the place.
    pub fn read(text: &str) -> Result<Self, FitError> {
        let mut table = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let header = table.headers()?.clone();
        let mut columns = vec![];
        let mut units = vec![];
        for name in &header {
            let (column, unit) = column(name).ok_or_else(|| FitError::Column {
                name: name.to_owned(),
            })?;
            if let Column::Stress(..) = column {
                units.push(unit);
            }
            columns.push(column);
        }
        if !columns.iter().any(|c| matches!(c, Column::Stretch(_))) {
            return Err(FitError::Missing { what: "stretch" });
        }
        let Some(&unit) = units.first() else {
            return Err(FitError::Missing { what: "stress" });
        };
        if units.iter().any(|other| *other != unit) {
            return Err(FitError::Units);
        }
        let mut all = vec![];
        for record in table.records() {
            let record = record?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut stretches = [None; 3];
            let mut stresses = vec![];
            for ((cell, &column), name) in record.iter().zip(&columns).zip(&header) {
                if cell.is_empty() {
                    continue;
                }
                let error = |rule| FitError::Cell {
                    line,
                    column: name.to_owned(),
                    cell: cell.to_owned(),
                    rule,
                };
                let number: f64 = cell.parse().map_err(|_| error("is no number"))?;
                if !number.is_finite() {
                    return Err(error("is not finite"));
                }
                match column {
                    Column::Stretch(_) if !(0.05..=20.0).contains(&number) => {
                        return Err(error("is not from 0.05 to 20 (1 is the length at rest)"));
                    }
                    Column::Stretch(i) => stretches[i] = Some(number),
                    Column::Stress(kind, i) => stresses.push((kind, i, number)),
                }
            }
            let prescribed = Prescribed {
                along: stretches[0],
                around: stretches[2],
            };
            let before = all.len();
            for (kind, direction, stress) in stresses {
                if stretches[direction].is_some() {
                    all.push(Measurement {
                        prescribed,
                        direction,
                        kind,
                        stress,
                    });
                }
            }
            if all.len() == before {
                return Err(FitError::Row { line });
            }
        }
        Ok(Self { all, unit })
    }
}

/// Returns the content and the unit of a column by its name.
fn column(name: &str) -> Option<(Column, Option<StressUnit>)> {
    let direction = |name: &str| match name {
        "along" => Some(0),
        "around" => Some(2),
        _ => None,
    };
    if let Some(rest) = name.strip_prefix("stretch_") {
        return Some((Column::Stretch(direction(rest)?), None));
    }
    let (kind, rest) = match name.strip_prefix("nominal_stress_") {
        Some(rest) => (StressKind::Nominal, rest),
        None => (StressKind::Cauchy, name.strip_prefix("cauchy_stress_")?),
    };
    let (rest, unit) = match rest.split_once('_') {
        None => (rest, None),
        Some((rest, "Pa")) => (rest, Some(StressUnit::Pascal)),
        Some((rest, "kPa")) => (rest, Some(StressUnit::Kilopascal)),
        Some((rest, "MPa")) => (rest, Some(StressUnit::Megapascal)),
        Some(_) => return None,
    };
    Some((Column::Stress(kind, direction(rest)?), unit))
}
