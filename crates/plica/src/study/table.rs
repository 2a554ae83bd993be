//! Rows as a table of texts: the names of its columns, their quantities, and cells.

use super::Row;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// Kind of quantity in a column of a history; it determines the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A text.
    Text,
    /// A whole number.
    Count,
    /// A number without unit.
    Ratio,
    /// An angle in degrees.
    Degrees,
    /// Seconds of wall time.
    Seconds,
    /// A time, in the unit of the durations of the case.
    Time,
    /// A length.
    Length,
    /// An area.
    Area,
    /// A volume.
    Volume,
    /// A force.
    Force,
    /// A moment.
    Moment,
    /// A stress or a pressure.
    Stress,
    /// An energy.
    Energy,
}

/// A cell of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Name of the column.
    pub name: String,
    /// Its kind of quantity.
    pub quantity: Quantity,
    /// The text in `history.csv`; a number has as many digits as it takes to read it back to the bit.
    pub text: String,
}

/// An action on each cell of a row.
pub(super) trait Visitor {
    /// Visits a cell.
    fn cell<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        quantity: Quantity,
        value: &mut T,
    );

    /// Visits the cell of a column of words, of which the index is given.
    fn word(&mut self, name: &str, words: &[String], index: &mut Option<usize>);

    /// Visits the cell of a column that not every history has.
    fn optional(&mut self, name: &str, quantity: Quantity, value: &mut Option<f64>) {
        if let Some(value) = value {
            self.cell(name, quantity, value);
        }
    }
}

impl Cell {
    /// Returns the number in the cell; none for a text.
    pub fn number(&self) -> Option<f64> {
        match self.quantity {
            Quantity::Text => None,
            _ => self.text.parse().ok(),
        }
    }
}

impl Row {
    /// Returns the cells in the order of `history.csv`.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Cells::default();
        self.clone().visit(&mut cells);
        cells.0
    }

    /// Returns the names of the columns.
    pub fn header(&self) -> Vec<String> {
        self.cells().into_iter().map(|cell| cell.name).collect()
    }

    /// Returns the texts of the cells.
    pub fn record(&self) -> Vec<String> {
        self.cells().into_iter().map(|cell| cell.text).collect()
    }
}

#[derive(Default)]
struct Cells(Vec<Cell>);

impl Visitor for Cells {
    fn cell<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        quantity: Quantity,
        value: &mut T,
    ) {
        self.0.push(Cell {
            name: name.into(),
            quantity,
            text: text(value),
        });
    }

    fn word(&mut self, name: &str, words: &[String], index: &mut Option<usize>) {
        self.0.push(Cell {
            name: name.into(),
            quantity: Quantity::Text,
            text: index.map_or(String::new(), |i| words[i].clone()),
        });
    }
}

/// Reads rows from a table, whose header names its muscles and ends.
#[derive(Clone, Debug)]
pub struct RowReader {
    /// Index of each column.
    columns: BTreeMap<String, usize>,
    /// A row with the muscles and ends of the table.
    zero: Row,
}

impl RowReader {
    /// Makes the reader of a table with a header.
    ///
    /// # Errors
    /// The first missing column, in words.
    pub fn new<'a>(header: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        let header: Vec<&str> = header.into_iter().collect();
        let named = |quantity: &'static str| {
            let names = header.iter();
            names.filter_map(move |name| name.strip_prefix(quantity))
        };
        let tensions: Vec<&str> = named("tension_").collect();
        let muscle = |name: &&'a str| {
            let names = ["target_", "tension_"].map(|quantity| name.strip_prefix(quantity));
            names[0].or(names[1])
        };
        let muscles: Vec<&str> = header.iter().filter_map(muscle).collect();
        let obstacles: Vec<&str> = named("radius_").collect();
        let patches: Vec<&str> = named("growth_through_").collect();
        let ends: Vec<&str> = named("displacement_").collect();
        let Ok(ends) = ends.try_into() else {
            return Err("there are not two columns `displacement_` with the name of an end".into());
        };
        let reader = Self {
            columns: header.iter().copied().map(String::from).zip(0..).collect(),
            zero: Row::zero(&muscles, ends)
                .with_active_stresses(&tensions)
                .with_obstacles(&obstacles)
                .with_patches(&patches),
        };
        let missing = |name: &String| !reader.columns.contains_key(name);
        match reader.zero.header().into_iter().find(missing) {
            Some(name) => Err(format!("the column `{name}` is missing")),
            None => Ok(reader),
        }
    }

    /// Reads a row from its cells.
    ///
    /// # Errors
    /// The first cell that cannot be read, in words.
    pub fn row<'a>(&self, cells: impl IntoIterator<Item = &'a str>) -> Result<Row, String> {
        let mut row = self.zero.clone();
        let mut reading = Reading {
            columns: &self.columns,
            cells: cells.into_iter().collect(),
            error: None,
        };
        row.visit(&mut reading);
        reading.error.map_or(Ok(row), Err)
    }
}

struct Reading<'a> {
    columns: &'a BTreeMap<String, usize>,
    cells: Vec<&'a str>,
    /// The first error.
    error: Option<String>,
}

impl Visitor for Reading<'_> {
    fn cell<T: Serialize + DeserializeOwned>(&mut self, name: &str, _: Quantity, value: &mut T) {
        let cell = self.columns.get(name).and_then(|&i| self.cells.get(i));
        let text = cell.copied().unwrap_or_default();
        match csv::StringRecord::from(vec![text]).deserialize(None) {
            Ok(read) => *value = read,
            Err(_) => {
                let error = || format!("`{text}` is not a value of the column `{name}`");
                self.error.get_or_insert_with(error);
            }
        }
    }

    fn word(&mut self, name: &str, words: &[String], index: &mut Option<usize>) {
        let mut text = String::new();
        self.cell(name, Quantity::Text, &mut text);
        *index = words.iter().position(|word| *word == text);
        if index.is_none() {
            let error = || format!("`{text}` is not a value of the column `{name}`");
            self.error.get_or_insert_with(error);
        }
    }

    fn optional(&mut self, name: &str, quantity: Quantity, value: &mut Option<f64>) {
        if self.columns.contains_key(name) {
            self.cell(name, quantity, value.insert(0.0));
        }
    }
}

/// Returns the text of a value in a table.
fn text(value: &impl Serialize) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .quote_style(csv::QuoteStyle::Never)
        .buffer_capacity(64)
        .from_writer(vec![]);
    // Writing to memory cannot fail. With a second cell an empty text needs no quotation marks.
    let _ = writer.serialize((value, 0));
    let bytes = writer.into_inner().unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    text.strip_suffix(",0\n").unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sets every cell to a number of its own.
    struct Fill(f64);

    impl Visitor for Fill {
        fn cell<T: Serialize + DeserializeOwned>(&mut self, _: &str, _: Quantity, value: &mut T) {
            self.0 += 1.0 / 3.0;
            let text = text(&self.0);
            for text in [text, format!("{:.0}", self.0)] {
                if let Ok(read) = csv::StringRecord::from(vec![text]).deserialize(None) {
                    *value = read;
                    return;
                }
            }
        }
        fn word(&mut self, _: &str, _: &[String], index: &mut Option<usize>) {
            *index = Some(1);
        }
        fn optional(&mut self, name: &str, quantity: Quantity, value: &mut Option<f64>) {
            self.cell(name, quantity, value.insert(0.0));
        }
    }

    fn filled() -> Row {
        let mut row = Row::zero(&["circular", "long-1"], ["proximal", "distal"])
            .with_obstacles(&["bolus", "scope"])
            .with_patches(&["scar", "polyp"]);
        let method = row.method;
        row.visit(&mut Fill(0.0));
        (row.stage, row.method, row.in_equilibrium) = ("a, \"b\"".into(), method, false);
        row
    }

    #[test]
    fn a_row_is_read_back_to_the_bit_with_the_names_in_its_header() {
        for (row, pressures) in [(filled(), true), (Row::zero(&[], ["a", "b"]), false)] {
            let header = row.header();
            let reader = RowReader::new(header.iter().map(String::as_str)).unwrap();
            let back = reader.row(row.record().iter().map(String::as_str));
            assert_eq!(back.unwrap(), row);
            assert_eq!(header.contains(&"potential".to_owned()), pressures);
            let side = header.iter().position(|name| name == "side").unwrap();
            let word = if pressures { "distal" } else { "none" };
            assert_eq!(row.record()[side], word);
        }
    }

    #[test]
    fn no_two_columns_have_the_same_name() {
        let mut names = filled().header();
        for name in ["target_long-1", "stretch_circular", "displacement_distal"] {
            assert!(names.contains(&name.to_owned()), "{name}");
        }
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn a_missing_column_and_a_damaged_cell_are_named() {
        let row = filled();
        let mut header = row.header();
        let mut cells = row.record();
        let at = header.iter().position(|name| name == "overhang").unwrap();
        cells[at] = "0.1x".into();
        let reader = RowReader::new(header.iter().map(String::as_str)).unwrap();
        let error = reader.row(cells.iter().map(String::as_str)).unwrap_err();
        assert!(
            error.contains("`0.1x`") && error.contains("`overhang`"),
            "{error}"
        );
        header.remove(at);
        let error = RowReader::new(header.iter().map(String::as_str)).unwrap_err();
        assert!(error.contains("`overhang`"), "{error}");
    }
}
