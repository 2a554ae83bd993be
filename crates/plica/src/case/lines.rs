//! The lines of a text, and which of them are headers of tables.

use std::ops::Range;

/// The lines of a text: where each begins, and whether it is the header of a table.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
    /// The lines that are headers, by their number.
    headers: Vec<usize>,
}

impl<'a> Lines<'a> {
    /// What begins like a header may be a line of a list.
    pub fn of(text: &'a str, values: &[Range<usize>]) -> Self {
        let breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        let starts: Vec<usize> = std::iter::once(0).chain(breaks).collect();
        let within_value = |start: usize| {
            let next = values.partition_point(|value| value.start < start);
            let value = next.checked_sub(1).and_then(|k| values.get(k));
            value.is_some_and(|value| start < value.end)
        };
        let is_header = |start: usize| {
            let line = text[start..].trim_start_matches([' ', '\t']);
            line.starts_with('[') && !within_value(start)
        };
        let headers = (0..starts.len()).filter(|&line| is_header(starts[line]));
        Self {
            text,
            headers: headers.collect(),
            starts,
        }
    }

    fn number(&self, place: usize) -> usize {
        self.starts.partition_point(|start| *start <= place) - 1
    }

    /// Where the line of a place begins.
    pub fn start(&self, place: usize) -> usize {
        self.starts[self.number(place)]
    }

    /// Whether a place lies in the header of a table.
    pub fn is_header(&self, place: usize) -> bool {
        self.headers.binary_search(&self.number(place)).is_ok()
    }

    /// What an error makes unusable: the lines it is in, and of a header all of its table.
    pub fn unusable(&self, place: &Range<usize>) -> Range<usize> {
        let (first, mut last) = (self.number(place.start), self.number(place.end));
        if let Ok(header) = self.headers.binary_search(&first) {
            let next = self.headers.get(header + 1);
            last = last.max(next.map_or(self.starts.len(), |next| *next) - 1);
        }
        let end = self
            .starts
            .get(last + 1)
            .map_or(self.text.len(), |next| next - 1);
        self.starts[first]..end.max(place.end)
    }
}
