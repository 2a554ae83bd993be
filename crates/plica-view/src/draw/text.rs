//! Lines of text: a label's runs set after each other.

use super::label::{Piece, pieces};
use super::letters::Letters;

/// Height of a capital letter, in text sizes.
pub(super) const CAPITAL: f64 = 0.73;

/// A run of a line; lengths in points.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub text: String,
    pub italic: bool,
    pub letters: Letters,
    /// Size of its letters.
    pub size: f64,
    /// How far it starts from the start of the line, and below its baseline.
    pub at: (f64, f64),
}

impl Run {
    pub fn width(&self) -> f64 {
        self.letters.width * self.size
    }
}

/// A label set in a size in points: its runs, and its width.
pub(super) fn line(label: &str, size: f64) -> (Vec<Run>, f64) {
    let mut width = 0.0;
    let mut run = |piece: Piece| {
        let letters = Letters::set(&piece.text, piece.italic);
        let run = Run {
            letters,
            size: size * piece.level.size(),
            at: (width, size * piece.level.drop()),
            text: piece.text,
            italic: piece.italic,
        };
        width += run.width();
        run
    };
    let runs = pieces(label).into_iter().map(&mut run).collect();
    (runs, width)
}

/// Width of a label in points.
pub(super) fn text_width(label: &str, size: f64) -> f64 {
    line(label, size).1
}

/// A label, or as much of its beginning as fits into a width, in points.
pub(super) fn fitting(label: &str, size: f64, width: f64) -> String {
    if text_width(label, size) <= width {
        return label.to_owned();
    }
    let letters: Vec<char> = label.chars().collect();
    let cut = |count: usize| letters[..count].iter().collect::<String>() + "…";
    let fits = |count: &usize| text_width(&cut(*count), size) <= width;
    let counts: Vec<usize> = (0..letters.len()).collect();
    cut(counts.partition_point(fits).saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_label_is_cut_where_it_fits() {
        assert_eq!(fitting("short", 10.0, 90.0), "short");
        let long = "a title that goes on and on, and on";
        let cut = fitting(long, 10.0, 90.0);
        assert!(cut.ends_with('…') && long.starts_with(cut.trim_end_matches('…')));
        let width = text_width(&cut, 10.0);
        assert!((75.0..=90.0).contains(&width), "{width}");
        assert_eq!(fitting(long, 10.0, 0.0), "…");
    }

    #[test]
    fn widths_count_spaces_and_levels() {
        let width = |label| text_width(label, 10.0);
        assert!((width("a b") - width("a") - width("b") - width(" ")).abs() < 0.5);
        assert!(width("x_{max}") < width("xmax"));
        let (runs, width) = line("*L*_{max}/*L*", 10.0);
        assert_eq!(runs.len(), 4);
        for pair in runs.windows(2) {
            assert!((pair[0].at.0 + pair[0].width() - pair[1].at.0).abs() < 1e-12);
        }
        assert!((runs[3].at.0 + runs[3].width() - width).abs() < 1e-12);
        assert!((runs[1].size - 7.2).abs() < 1e-12 && runs[1].at.1 == 2.0);
    }
}
