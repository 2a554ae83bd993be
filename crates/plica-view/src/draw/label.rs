//! Labels with a little markup: `*z*/*D*` slants, `*L*_{max}` lowers, `10^{−3}` raises.

/// A run of letters of one kind.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub text: String,
    pub italic: bool,
    pub level: Level,
}

/// Where a run stands on its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Level {
    Line,
    Lower,
    Upper,
}

impl Level {
    /// Size against that of the line.
    pub fn size(self) -> f64 {
        if self == Level::Line { 1.0 } else { 0.72 }
    }

    /// Fall below the baseline, in the line's size.
    pub fn drop(self) -> f64 {
        match self {
            Level::Line => 0.0,
            Level::Lower => 0.2,
            Level::Upper => -0.36,
        }
    }
}

/// The runs of a label. Unmatched marks are harmless: the last run just ends with the text.
pub(super) fn pieces(text: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut run = Piece {
        text: String::new(),
        italic: false,
        level: Level::Line,
    };
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        let (italic, level) = match letter {
            '*' => (!run.italic, run.level),
            '_' if letters.next_if_eq(&'{').is_some() => (run.italic, Level::Lower),
            '^' if letters.next_if_eq(&'{').is_some() => (run.italic, Level::Upper),
            '}' if run.level != Level::Line => (run.italic, Level::Line),
            _ => {
                // A line is a line, and XML has no place for these.
                let is_letter = !letter.is_control() && !matches!(letter, '\u{fffe}' | '\u{ffff}');
                run.text.push(if is_letter { letter } else { ' ' });
                continue;
            }
        };
        let next = Piece {
            text: String::new(),
            italic,
            level,
        };
        pieces.push(std::mem::replace(&mut run, next));
    }
    pieces.push(run);
    pieces.retain(|p| !p.text.is_empty());
    pieces
}

/// A label as HTML.
pub fn html(label: &str) -> String {
    let piece = |piece: Piece| {
        let escaped = piece.text.replace('&', "&amp;").replace('<', "&lt;");
        let text = if piece.italic {
            format!("<i>{escaped}</i>")
        } else {
            escaped
        };
        match piece.level {
            Level::Line => text,
            Level::Lower => format!("<sub>{text}</sub>"),
            Level::Upper => format!("<sup>{text}</sup>"),
        }
    };
    pieces(label).into_iter().map(piece).collect()
}

/// A label in letters alone: *L*_{max} is Lmax, *D*^{3} is D³.
pub fn plain(label: &str) -> String {
    let raised = |letter: char| match letter {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32(letter as u32 - '4' as u32 + '⁴' as u32).unwrap_or(letter),
        '-' | '−' => '⁻',
        other => other,
    };
    let piece = |piece: Piece| match piece.level {
        Level::Upper => piece.text.chars().map(raised).collect(),
        _ => piece.text,
    };
    pieces(label).into_iter().map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_split_a_label() {
        let got = pieces("*L*_{max}/*L* = 10^{−3}");
        let texts: Vec<_> = got
            .iter()
            .map(|p| (p.text.as_str(), p.italic, p.level))
            .collect();
        assert_eq!(
            texts,
            [
                ("L", true, Level::Line),
                ("max", false, Level::Lower),
                ("/", false, Level::Line),
                ("L", true, Level::Line),
                (" = 10", false, Level::Line),
                ("−3", false, Level::Upper),
            ]
        );
        assert_eq!(pieces("plain_text }")[0].text, "plain_text }");
        assert_eq!(pieces("a\u{1}b\nc\u{ffff}$")[0].text, "a b c $");
    }

    #[test]
    fn a_label_elsewhere_than_in_a_picture() {
        let label = "*L*_{max}/*L* < 10^{−34}";
        assert_eq!(
            html(label),
            "<i>L</i><sub>max</sub>/<i>L</i> &lt; 10<sup>−34</sup>"
        );
        assert_eq!(plain(label), "Lmax/L < 10⁻³⁴");
    }
}
