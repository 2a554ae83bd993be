//! Layout of a label on one line.

use super::glyphs::GlyphRun;
use super::label::{Fragment, parse};

/// Font size of titles, in points.
pub(super) const TITLE_SIZE: f64 = 9.0;
/// Font size of all other text, in points.
pub(super) const TEXT_SIZE: f64 = 8.0;
/// Half the height of a capital letter of ordinary text, in points.
pub(super) const HALF_CAP: f64 = TEXT_SIZE * CAP_HEIGHT / 2.0;
/// Height of a row of text, in points.
pub(super) const ROW_HEIGHT: f64 = 12.0;
/// Height of a capital letter divided by the font size.
pub(super) const CAP_HEIGHT: f64 = 0.73;

/// Part of a line in one style; lengths in points.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub text: String,
    pub italic: bool,
    pub glyphs: GlyphRun,
    /// Font size.
    pub size: f64,
    /// Offset from the start of the line, to the right and downwards.
    pub at: (f64, f64),
}

impl Run {
    pub fn width(&self) -> f64 {
        self.glyphs.width * self.size
    }
}

/// Lays out a label in a font size; returns its runs and its width in points.
pub(super) fn layout(label: &str, size: f64) -> (Vec<Run>, f64) {
    let mut width = 0.0;
    let mut run = |fragment: Fragment| {
        let glyphs = GlyphRun::shape(&fragment.text, fragment.italic);
        let run = Run {
            glyphs,
            size: size * fragment.level.size(),
            at: (width, size * fragment.level.offset()),
            text: fragment.text,
            italic: fragment.italic,
        };
        width += run.width();
        run
    };
    let runs = parse(label).into_iter().map(&mut run).collect();
    (runs, width)
}

/// Returns the width of a label in points.
pub(super) fn text_width(label: &str, size: f64) -> f64 {
    layout(label, size).1
}

/// Returns a label, shortened with an ellipsis if it is wider than `width` points.
pub(super) fn truncated(label: &str, size: f64, width: f64) -> String {
    if text_width(label, size) <= width {
        return label.to_owned();
    }
    let characters: Vec<char> = label.chars().collect();
    let cut = |count: usize| characters[..count].iter().collect::<String>() + "…";
    let fits = |count: &usize| text_width(&cut(*count), size) <= width;
    let counts: Vec<usize> = (0..characters.len()).collect();
    cut(counts.partition_point(fits).saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_label_is_truncated_to_the_width() {
        assert_eq!(truncated("short", 10.0, 90.0), "short");
        let long = "a title that goes on and on, and on";
        let cut = truncated(long, 10.0, 90.0);
        assert!(cut.ends_with('…') && long.starts_with(cut.trim_end_matches('…')));
        let width = text_width(&cut, 10.0);
        assert!((75.0..=90.0).contains(&width), "{width}");
        assert_eq!(truncated(long, 10.0, 0.0), "…");
    }

    #[test]
    fn widths_count_spaces_and_levels() {
        let width = |label| text_width(label, 10.0);
        assert!((width("a b") - width("a") - width("b") - width(" ")).abs() < 0.5);
        assert!(width("x_{max}") < width("xmax"));
        let (runs, width) = layout("*L*_{max}/*L*", 10.0);
        assert_eq!(runs.len(), 4);
        for pair in runs.windows(2) {
            assert!((pair[0].at.0 + pair[0].width() - pair[1].at.0).abs() < 1e-12);
        }
        assert!((runs[3].at.0 + runs[3].width() - width).abs() < 1e-12);
        assert!((runs[1].size - 7.2).abs() < 1e-12 && runs[1].at.1 == 2.0);
    }
}
