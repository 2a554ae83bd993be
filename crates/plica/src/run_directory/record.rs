//! The record of a run: a copy of its history and the checksums of its files, kept in every checkpoint.

use super::write::table_of;
use crate::saved_state::Array;
use crate::study::{Row, RowReader};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The rows of a run without their wall times, and the checksums of its profiles and saved states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// The rows as CSV, with a header.
    table: String,
    files: BTreeMap<String, Sum>,
}

/// Length and checksum (BLAKE3) of a file.
#[derive(Clone, Debug, PartialEq)]
struct Sum {
    length: u64,
    hash: String,
}

/// A fault of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It does not exist.
    Missing,
    /// Its content is not what was written.
    Damaged,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Missing => "missing",
            Self::Damaged => "damaged",
        })
    }
}

/// Bytes of text in a number: integers of so many bytes are exact.
const PACKED: usize = 6;

impl Record {
    /// Returns the record of rows without files.
    pub fn of(rows: &[Row]) -> Self {
        let mut record = Self::default();
        rows.iter().for_each(|row| record.add_row(row));
        record
    }

    /// Replaces the rows by others, and keeps the files.
    pub(super) fn replace_rows(&mut self, rows: &[Row]) {
        self.table = Self::of(rows).table;
    }

    /// Adds a row.
    pub fn add_row(&mut self, row: &Row) {
        let row = Row {
            seconds: 0.0,
            ..row.clone()
        };
        // Writing to memory cannot fail.
        let text = String::from_utf8(table_of(&[row]).unwrap_or_default()).unwrap_or_default();
        let begin = match self.table.is_empty() {
            true => 0,
            false => text.find('\n').map_or(0, |end| end + 1),
        };
        self.table += &text[begin..];
    }

    /// Adds a file by its relative path.
    pub(super) fn add_file(&mut self, name: &str, bytes: &[u8]) {
        let sum = Sum {
            length: bytes.len() as u64,
            hash: blake3::hash(bytes).to_string(),
        };
        self.files.insert(name.to_owned(), sum);
    }

    /// Returns its rows; none if they cannot be read.
    pub fn rows(&self) -> Option<Vec<Row>> {
        rows_of(&self.table).into_iter().collect()
    }

    /// Returns the names of the columns of its rows as a line.
    pub(super) fn header(&self) -> &str {
        self.table.lines().next().unwrap_or_default()
    }

    /// Returns the relative paths of its files.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Returns the files in a directory that are missing or have another length.
    pub fn missing(&self, directory: &Path) -> Vec<(String, Fault)> {
        self.faults(|name, sum| match fs::metadata(directory.join(name)) {
            Err(_) => Some(Fault::Missing),
            Ok(about) if !about.is_file() || about.len() != sum.length => Some(Fault::Damaged),
            Ok(_) => None,
        })
    }

    /// Returns the files in a directory that are missing or have another content. Reads all of them.
    pub fn damaged(&self, directory: &Path) -> Vec<(String, Fault)> {
        let missing: BTreeMap<String, Fault> = self.missing(directory).into_iter().collect();
        self.faults(
            |name, sum| match (missing.get(name), fs::read(directory.join(name))) {
                (Some(fault), _) => Some(*fault),
                (None, Ok(bytes)) if blake3::hash(&bytes).to_string() == sum.hash => None,
                (None, _) => Some(Fault::Damaged),
            },
        )
    }

    fn faults(&self, fault: impl Fn(&str, &Sum) -> Option<Fault>) -> Vec<(String, Fault)> {
        let files = self.files.iter();
        files
            .filter_map(|(name, sum)| Some((name.clone(), fault(name, sum)?)))
            .collect()
    }

    /// Returns its rows and its files as arrays of a saved state.
    pub(super) fn arrays(&self) -> [Array; 2] {
        let line = |(name, sum): (&String, &Sum)| format!("{} {} {name}\n", sum.hash, sum.length);
        let files: String = self.files.iter().map(line).collect();
        [pack(&self.table), pack(&files)]
    }

    /// Makes a record from arrays; none if they are not those of a record.
    pub(super) fn from_arrays([table, files]: [&[f64]; 2]) -> Option<Self> {
        let file = |line: &str| {
            let mut words = line.splitn(3, ' ');
            let (hash, length) = (words.next()?.to_owned(), words.next()?.parse().ok()?);
            Some((words.next()?.to_owned(), Sum { length, hash }))
        };
        Some(Self {
            table: unpack(table)?,
            files: unpack(files)?.lines().map(file).collect::<Option<_>>()?,
        })
    }
}

/// Returns the rows of a table with a header, none for those that cannot be read.
pub(super) fn rows_of(table: &str) -> Vec<Option<Row>> {
    let mut table = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(table.as_bytes());
    let reader = table.headers().map(RowReader::new);
    let Ok(Ok(reader)) = reader else {
        return vec![];
    };
    let records = table.records();
    records
        .map(|record| reader.row(&record.ok()?).ok())
        .collect()
}

/// Returns a text as integers: its length in bytes, then six bytes in each number.
fn pack(text: &str) -> Array {
    let number = |bytes: &[u8]| {
        let digit = |sum: u64, byte: &u8| 256 * sum + u64::from(*byte);
        bytes.iter().fold(0, digit) as f64
    };
    let mut values = vec![text.len() as f64];
    values.extend(text.as_bytes().chunks(PACKED).map(number));
    Array {
        shape: vec![values.len()],
        values,
    }
}

/// Returns the text that [`pack`] has packed.
fn unpack(values: &[f64]) -> Option<String> {
    let (length, numbers) = values.split_first()?;
    let most = (PACKED * numbers.len()) as f64;
    let is_length = *length == length.trunc() && (0.0..=most).contains(length);
    let mut left = is_length.then_some(*length as usize)?;
    let mut bytes = Vec::with_capacity(left);
    for number in numbers {
        let count = left.min(PACKED);
        let is_packed =
            *number == number.trunc() && (0.0..2_f64.powi(8 * count as i32)).contains(number);
        let word = is_packed.then_some(*number as u64)?.to_be_bytes();
        bytes.extend(&word[8 - count..]);
        left -= count;
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_unpacked_as_it_was_packed() {
        for text in ["", "a", "state", "state,", "state,stage\n0,Ruhe – ζ\n"] {
            assert_eq!(unpack(&pack(text).values).unwrap(), text);
        }
        let mut values = pack("state,stage").values;
        values[1] += 0.5;
        assert!(unpack(&values).is_none());
        assert!(unpack(&[7.0, 1.0]).is_none() && unpack(&[]).is_none());
        assert!(unpack(&[1.0, 256.0]).is_none());
    }

    #[test]
    fn missing_and_damaged_files_are_found() {
        let path = super::super::scratch("record");
        let mut record = Record::default();
        for name in ["whole", "flipped", "longer", "missing"] {
            record.add_file(name, b"content");
            fs::write(path.join(name), "content").unwrap();
        }
        let [table, files] = record.arrays();
        assert_eq!(
            Record::from_arrays([&table.values, &files.values]).unwrap(),
            record
        );
        assert!(record.damaged(&path).is_empty());
        fs::write(path.join("flipped"), "cOntent").unwrap();
        fs::write(path.join("longer"), "content.").unwrap();
        fs::remove_file(path.join("missing")).unwrap();
        let found = |faults: Vec<(String, Fault)>| {
            let text = |(name, fault): (String, Fault)| format!("{name} {fault}");
            faults.into_iter().map(text).collect::<Vec<_>>().join(", ")
        };
        assert_eq!(
            found(record.missing(&path)),
            "longer damaged, missing missing"
        );
        assert_eq!(
            found(record.damaged(&path)),
            "flipped damaged, longer damaged, missing missing"
        );
        fs::remove_dir_all(path).unwrap();
    }
}
