//! Label markup: italics (`*z*/*D*`), subscripts (`*L*_{max}`) and superscripts (`10^{−3}`).

/// Part of a label in one style.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fragment {
    pub text: String,
    pub italic: bool,
    pub level: Level,
}

/// Vertical position of a fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Level {
    Baseline,
    Subscript,
    Superscript,
}

impl Level {
    /// Returns the font size relative to that of the label.
    pub fn size(self) -> f64 {
        if self == Level::Baseline { 1.0 } else { 0.72 }
    }

    /// Returns the downward offset from the baseline, relative to the font size of the label.
    pub fn offset(self) -> f64 {
        match self {
            Level::Baseline => 0.0,
            Level::Subscript => 0.2,
            Level::Superscript => -0.36,
        }
    }
}

/// Splits a label into fragments. An unmatched mark extends to the end of the text.
pub(super) fn parse(text: &str) -> Vec<Fragment> {
    let mut fragments = Vec::new();
    let mut run = Fragment {
        text: String::new(),
        italic: false,
        level: Level::Baseline,
    };
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        let (italic, level) = match letter {
            '*' => (!run.italic, run.level),
            '_' if letters.next_if_eq(&'{').is_some() => (run.italic, Level::Subscript),
            '^' if letters.next_if_eq(&'{').is_some() => (run.italic, Level::Superscript),
            '}' if run.level != Level::Baseline => (run.italic, Level::Baseline),
            _ => {
                // A label is one line, and XML forbids these characters.
                let is_allowed = !letter.is_control() && !matches!(letter, '\u{fffe}' | '\u{ffff}');
                run.text.push(if is_allowed { letter } else { ' ' });
                continue;
            }
        };
        let next = Fragment {
            text: String::new(),
            italic,
            level,
        };
        fragments.push(std::mem::replace(&mut run, next));
    }
    fragments.push(run);
    fragments.retain(|p| !p.text.is_empty());
    fragments
}

/// Returns a label as HTML.
pub fn html(label: &str) -> String {
    let fragment = |fragment: Fragment| {
        let escaped = fragment.text.replace('&', "&amp;").replace('<', "&lt;");
        let text = if fragment.italic {
            format!("<i>{escaped}</i>")
        } else {
            escaped
        };
        match fragment.level {
            Level::Baseline => text,
            Level::Subscript => format!("<sub>{text}</sub>"),
            Level::Superscript => format!("<sup>{text}</sup>"),
        }
    };
    parse(label).into_iter().map(fragment).collect()
}

/// Returns a label as plain text: *L*_{max} becomes Lmax and *D*^{3} becomes D³.
pub fn plain(label: &str) -> String {
    let superscript = |letter: char| match letter {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32(letter as u32 - '4' as u32 + '⁴' as u32).unwrap_or(letter),
        '-' | '−' => '⁻',
        other => other,
    };
    let fragment = |fragment: Fragment| match fragment.level {
        Level::Superscript => fragment.text.chars().map(superscript).collect(),
        _ => fragment.text,
    };
    parse(label).into_iter().map(fragment).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_splits_a_label() {
        let got = parse("*L*_{max}/*L* = 10^{−3}");
        let texts: Vec<_> = got
            .iter()
            .map(|p| (p.text.as_str(), p.italic, p.level))
            .collect();
        assert_eq!(
            texts,
            [
                ("L", true, Level::Baseline),
                ("max", false, Level::Subscript),
                ("/", false, Level::Baseline),
                ("L", true, Level::Baseline),
                (" = 10", false, Level::Baseline),
                ("−3", false, Level::Superscript),
            ]
        );
        assert_eq!(parse("plain_text }")[0].text, "plain_text }");
        assert_eq!(parse("a\u{1}b\nc\u{ffff}$")[0].text, "a b c $");
    }

    #[test]
    fn labels_convert_to_html_and_plain_text() {
        let label = "*L*_{max}/*L* < 10^{−34}";
        assert_eq!(
            html(label),
            "<i>L</i><sub>max</sub>/<i>L</i> &lt; 10<sup>−34</sup>"
        );
        assert_eq!(plain(label), "Lmax/L < 10⁻³⁴");
    }
}
