//! Reading of `history.csv`.

use super::{HISTORY, RunDirectory, RunError, record};
use crate::study::{Row, RowReader};
use std::fs;

impl RunDirectory {
    /// Returns the rows of `history.csv`.
    ///
    /// # Errors
    /// [`RunError::File`] if it cannot be read, is damaged or has other columns.
    pub fn history(&self) -> Result<Vec<Row>, RunError> {
        match self.readable_history()? {
            (rows, None) => Ok(rows),
            (_, Some(broken)) => Err(RunError::File {
                path: self.path.join(HISTORY),
                source: std::io::Error::other(broken),
            }),
        }
    }

    /// Returns the rows of `history.csv` before the first damaged one, and the fault of that one, if there is one. A power failure or a
    /// full disk can leave a damaged row.
    ///
    /// # Errors
    /// [`RunError::File`] if it cannot be read, or if its first row is damaged or has other columns.
    pub fn readable_history(&self) -> Result<(Vec<Row>, Option<String>), RunError> {
        let path = self.path.join(HISTORY);
        let error_at = |error: csv::Error| RunError::File {
            path: path.clone(),
            source: std::io::Error::other(error),
        };
        if path.exists() && !path.is_file() {
            let what = std::io::Error::other("not a regular file");
            return Err(error_at(what.into()));
        }
        let mut table = csv::Reader::from_path(&path).map_err(error_at)?;
        let reader = RowReader::new(table.headers().map_err(error_at)?);
        let reader = reader.map_err(|error| error_at(std::io::Error::other(error).into()))?;
        let mut rows: Vec<Row> = vec![];
        for record in table.records() {
            let row = record.map_err(|error| error.to_string());
            let number = rows.len();
            let read = |record| {
                reader
                    .row(&record)
                    .map_err(|e| format!("row {number}: {e}"))
            };
            match row.and_then(read) {
                Ok(row) => rows.push(row),
                Err(error) if rows.is_empty() => {
                    return Err(error_at(std::io::Error::other(error).into()));
                }
                Err(error) => return Ok((rows, Some(error))),
            }
        }
        Ok((rows, None))
    }

    /// Returns the rows of `history.csv` that can be read, whatever is between them. Its own header may be damaged: rows with as
    /// many cells as another header are read with that one.
    pub(super) fn recorded_rows(&self, header: &str) -> Vec<Row> {
        let bytes = fs::read(self.path.join(HISTORY)).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        let mut lines = text.lines();
        let own = lines.next().unwrap_or_default();
        let cells = |line: &str| line.matches(',').count();
        let header_of = |line: &str| match cells(line) == cells(header) {
            true => header.to_owned(),
            false => own.to_owned(),
        };
        let row = |line: &str| {
            let table = format!("{}\n{line}\n", header_of(line));
            record::rows_of(&table).pop()?
        };
        lines.filter_map(row).collect()
    }
}
