//! The lines of a text, and which of them are headers of tables.

use std::collections::BTreeMap;
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

    /// The bytes of a place's line, its end aside.
    pub fn of_place(&self, place: usize) -> Range<usize> {
        let line = self.number(place);
        let next = self.starts.get(line + 1);
        self.starts[line]..next.map_or(self.text.len(), |next| next - 1)
    }

    /// The path of a key that stands in the line of a place.
    pub fn path(&self, place: usize, key: &str) -> String {
        let line = self.number(place);
        let content = |line: usize| self.text[self.of_place(self.starts[line])].trim();
        // Of a list of tables, the last member so far.
        let mut lists: BTreeMap<&str, usize> = BTreeMap::new();
        let mut table = String::new();
        for &header in self.headers.iter().take_while(|header| **header <= line) {
            let name = content(header).trim_matches(['[', ']', ' ', '\t']);
            if content(header).starts_with("[[") {
                *lists.entry(name).or_default() += 1;
            }
            let (first, rest) = match name.split_once('.') {
                Some((first, rest)) => (first, Some(rest)),
                None => (name, None),
            };
            let member = |n: &usize| format!("{first}[{n}]");
            table = lists.get(first).map_or(first.to_owned(), member);
            if let Some(rest) = rest {
                table = format!("{table}.{rest}");
            }
        }
        match table.as_str() {
            "" => key.to_owned(),
            _ => format!("{table}.{key}"),
        }
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
