//! Changes keys in the text of a case.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key that cannot be changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The case, or the case with the key changed, is not TOML.
    #[error("{key}: {error}")]
    Syntax {
        /// The dotted key.
        key: String,
        /// The syntax error.
        error: String,
    },
    /// The path of the key passes through something that is not a table.
    #[error("{key}: {step} is not a table or a member of a list")]
    NotATable {
        /// The dotted key.
        key: String,
        /// The part of the path that is not a table.
        step: String,
    },
    /// The key is a table that is not written in braces, within other such tables or in a list.
    #[error(
        "{key}: a table that is not written in braces cannot be replaced here; change its keys"
    )]
    WithoutBraces {
        /// The dotted key.
        key: String,
    },
}

/// Returns the text of a case with keys changed or added; comments and everything else stay, but a table with
/// a header that is replaced is removed with all text up to the next header. A key is
/// dotted, with members of lists counted from one, as in messages (`stages[2].steps`). A value is
/// written as in TOML (`0.25`, `"newmark"`). The result is not checked as a case.
///
/// ```
/// let case = "[tube]\nlength = 3.0 # in diameters\n\n[[stages]]\nsteps = 5\n";
/// let changes = [("stages[1].steps", "8"), ("mesh.degree", "2")];
/// let changed = plica::case::edited(case, &changes).unwrap();
/// assert!(changed.contains("length = 3.0 # in diameters") && changed.contains("steps = 8"));
/// assert!(changed.contains("[mesh]\ndegree = 2"));
/// ```
///
/// # Errors
/// [`EditError`] if the text or a value is not TOML, or a key passes through something that is not a
/// table.
pub fn edited<K: AsRef<str>, V: AsRef<str>>(
    text: &str,
    changes: &[(K, V)],
) -> Result<String, EditError> {
    let mut text = text.to_owned();
    for (key, value) in changes {
        let (key, value) = (key.as_ref(), value.as_ref());
        let syntax = |error: toml::de::Error| EditError::Syntax {
            key: key.into(),
            error: error.to_string(),
        };
        DeValue::parse(value).map_err(syntax)?;
        let root = DeTable::parse(&text).map_err(syntax)?;
        let mut changed =
            without_tables(&text, root.get_ref(), key).unwrap_or_else(|| text.clone());
        let root = DeTable::parse(&changed).map_err(syntax)?;
        let (place, written) = find(&changed, &root, key, value)?;
        changed.replace_range(place, &written);
        DeTable::parse(&changed).map_err(syntax)?;
        text = changed;
    }
    Ok(text)
}

/// Returns the text without the tables that have a header with the key or a key below it; none if there is no such table.
fn without_tables(text: &str, root: &DeTable, key: &str) -> Option<String> {
    let mut headers = vec![];
    collect_headers(text, root, "", &mut headers);
    headers.sort_unstable();
    headers.dedup_by_key(|(start, _)| *start);
    let is_removed = |path: &str| {
        let below = path.strip_prefix(key);
        below.is_some_and(|below| below.is_empty() || below.starts_with('.'))
    };
    if !headers.iter().any(|(_, path)| is_removed(path)) {
        return None;
    }
    let first = headers.first().map_or(text.len(), |(start, _)| *start);
    let mut others = text[..first].to_owned();
    for (i, (start, path)) in headers.iter().enumerate() {
        let end = headers.get(i + 1).map_or(text.len(), |(start, _)| *start);
        if !is_removed(path) {
            others += &text[*start..end];
        }
    }
    Some(others)
}

/// Collects the places and the dotted keys of all headers of tables.
fn collect_headers(text: &str, table: &DeTable, path: &str, headers: &mut Vec<(usize, String)>) {
    for (name, value) in table {
        let path = match path {
            "" => name.get_ref().to_string(),
            _ => format!("{path}.{}", name.get_ref()),
        };
        let one = std::slice::from_ref(value);
        let members = value.get_ref().as_array().map_or(one, |list| list);
        for member in members {
            let start = member.span().start;
            let Some(table) = member.get_ref().as_table() else {
                continue;
            };
            if text[start..].starts_with('[') {
                headers.push((start, path.clone()));
            }
            if !text[start..].starts_with('{') {
                collect_headers(text, table, &path, headers);
            }
        }
    }
}

/// Returns the place where the value of a key belongs, and the text to write there.
///
/// # Errors
/// [`EditError::NotATable`] and [`EditError::WithoutBraces`].
fn find(
    text: &str,
    root: &Spanned<DeTable>,
    key: &str,
    value: &str,
) -> Result<(Range<usize>, String), EditError> {
    let not_a_table = |step: &str| EditError::NotATable {
        key: key.into(),
        step: step.into(),
    };
    let steps: Vec<&str> = key.split('.').collect();
    let mut table = root.get_ref();
    // The innermost table with braces or a header: where a key is inserted, the text before and after
    // it, and its path in that table.
    let mut insertion = None;
    let mut path: Vec<&str> = vec![];
    for (i, &step) in steps.iter().enumerate() {
        let (name, member) = match step.strip_suffix(']').and_then(|step| step.split_once('[')) {
            Some((name, number)) => (
                name,
                Some(number.parse::<usize>().map_err(|_| not_a_table(step))?),
            ),
            None => (step, None),
        };
        let found = match (table.get(name), member) {
            (None, None) => {
                path.extend(&steps[i..]);
                break;
            }
            (found, None) => found,
            (found, Some(n)) => {
                let list = found.and_then(|list| list.get_ref().as_array());
                list.and_then(|list| list.get(n.checked_sub(1)?))
            }
        };
        let found = found.ok_or_else(|| not_a_table(step))?;
        let (span, is_last) = (found.span(), i + 1 == steps.len());
        let is_inline = text[span.clone()].starts_with('{');
        if is_last && (is_inline || !found.get_ref().is_table()) {
            return Ok((span, value.to_owned()));
        }
        if is_last {
            return Err(EditError::WithoutBraces { key: key.into() });
        }
        table = found
            .get_ref()
            .as_table()
            .ok_or_else(|| not_a_table(step))?;
        path.push(step);
        if is_inline {
            let after = if table.is_empty() { " " } else { "," };
            insertion = Some((span.start + 1, " ", after));
            path.clear();
        } else if text[span.clone()].starts_with('[') {
            insertion = Some(match text[span.end..].find('\n') {
                Some(end) => (span.end + end + 1, "", "\n"),
                None => (text.len(), "\n", ""),
            });
            path.clear();
        }
    }
    let end = text.len()..text.len();
    Ok(match (insertion, steps.split_last()) {
        (Some((at, before, after)), _) => {
            let path = path.join(".");
            (at..at, format!("{before}{path} = {value}{after}"))
        }
        (None, Some((name, tables))) if !tables.is_empty() => {
            let table = tables.join(".");
            (end, format!("\n[{table}]\n{name} = {value}\n"))
        }
        _ => (0..0, format!("{key} = {value}\n")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "title = \"x\" # a title

[mesh]
control_points = { axial = 60, around = 16, thickness = 4 }

[material.neo-hookean]

[[stages]]
name = \"contract\"
drive.circular.diameter_ratio = 0.25 # narrow";

    #[test]
    fn keys_of_every_kind_of_table_are_changed_and_added() {
        let changes = [
            ("title", "\"y\""),
            ("mesh.control_points.axial", "90"),
            ("mesh.refine", "[]"),
            ("stages[1].drive.circular.diameter_ratio", "0.3"),
            ("stages[1].drive.colon.displacement", "0.1"),
            ("stages[1].drive.colon.twist_degrees", "1"),
            ("solver.pseudo_time.damping", "5.0"),
            ("solver.pseudo_time.ramp", "3"),
            ("solver.scheme", "'newmark'"),
            ("material.neo-hookean.poisson_ratio", "0.3"),
        ];
        let text = edited(CASE, &changes).unwrap();
        let expected: toml::Table = "title = 'y'
            mesh = { control_points = { axial = 90, around = 16, thickness = 4 }, refine = [] }
            material.neo-hookean.poisson_ratio = 0.3
            solver = { scheme = 'newmark', pseudo_time = { damping = 5.0, ramp = 3 } }
            [[stages]]
            name = 'contract'
            drive.circular.diameter_ratio = 0.3
            drive.colon = { displacement = 0.1, twist_degrees = 1 }"
            .parse()
            .unwrap();
        assert_eq!(text.parse::<toml::Table>().unwrap(), expected, "{text}");
        assert!(text.contains("# a title") && text.contains("# narrow"));
        assert_eq!(edited(CASE, &[("", ""); 0]).unwrap(), CASE);
    }

    #[test]
    fn a_key_that_is_added_to_braces_needs_no_header() {
        let text = edited(
            "a = { b = 1 }\nc = {}\n",
            &[("a.x", "2"), ("c.d.e", "3"), ("t", "1")],
        );
        assert_eq!(
            text.unwrap(),
            "t = 1\na = { x = 2, b = 1 }\nc = { d.e = 3 }\n"
        );
        // A value replaces all of a table in braces.
        let points = edited(CASE, &[("mesh.control_points", "{ axial = 8 }")]).unwrap();
        assert!(
            points.contains("control_points = { axial = 8 }\n"),
            "{points}"
        );
    }

    #[test]
    fn a_value_replaces_a_table_with_a_header_and_the_tables_below_it() {
        let text = "a = [[1], [2]]\n[solver]\nscheme = 'newmark'\n[solver.pseudo_time]\nramp = 3\n[mesh]\ndegree = 2\n";
        let changed = edited(text, &[("solver", "{ scheme = 'static' }")]);
        assert_eq!(
            changed.unwrap(),
            "solver = { scheme = 'static' }\na = [[1], [2]]\n[mesh]\ndegree = 2\n"
        );
    }

    #[test]
    fn a_table_is_replaced_below_the_header_of_its_parent() {
        let text =
            "[solver]\nscheme = 'newmark'\n[solver.pseudo_time]\nramp = 3\n[mesh]\ndegree = 2\n";
        let changed = edited(text, &[("solver.pseudo_time", "{ ramp = 4 }")]);
        assert_eq!(
            changed.unwrap(),
            "[solver]\npseudo_time = { ramp = 4 }\nscheme = 'newmark'\n[mesh]\ndegree = 2\n"
        );
        // Without a header of its own, the parent gets one.
        let text = "[solver.pseudo_time]\nramp = 3\n[solver.other.below]\n[mesh]\ndegree = 2\n";
        for (key, other) in [
            ("solver.pseudo_time", "other"),
            ("solver.other", "pseudo_time"),
        ] {
            let changed = edited(text, &[(key, "{ x = 4 }")]).unwrap();
            let table: toml::Table = changed.parse().unwrap();
            let name = key.strip_prefix("solver.").unwrap();
            assert_eq!(
                table["solver"][name]["x"].as_integer(),
                Some(4),
                "{changed}"
            );
            assert!(table["solver"][other].is_table(), "{changed}");
        }
        let text = "[[stages]]\nsteps = 1\n[[stages]]\nsteps = 2\n[mesh]\n";
        let changed = edited(text, &[("stages", "[{ steps = 3 }]")]).unwrap();
        assert_eq!(changed, "stages = [{ steps = 3 }]\n[mesh]\n");
    }

    #[test]
    fn a_table_without_braces_in_a_list_or_of_dotted_keys_is_not_replaced() {
        let text =
            "mesh.degree = 3\n[[stages]]\nsteps = 1\n[stages.drive.ring]\ndiameter_ratio = 0.5\n";
        for key in [
            "stages[1]",
            "stages[1].drive",
            "stages[1].drive.ring",
            "mesh",
        ] {
            let error = edited(text, &[(key, "{ x = 1 }")]).unwrap_err();
            assert_eq!(error, EditError::WithoutBraces { key: key.into() });
            let rule =
                "a table that is not written in braces cannot be replaced here; change its keys";
            assert_eq!(error.to_string(), format!("{key}: {rule}"));
        }
        // Its keys are changed, and members in braces replaced.
        let changed = edited(text, &[("stages[1].drive.ring.diameter_ratio", "0.25")]).unwrap();
        assert!(changed.ends_with("diameter_ratio = 0.25\n"), "{changed}");
        let changed = edited("a = [{ b = 1 }, { b = 2 }]\n", &[("a[2]", "{ c = 3 }")]).unwrap();
        assert_eq!(changed, "a = [{ b = 1 }, { c = 3 }]\n");
    }

    #[test]
    fn keys_that_cannot_be_changed_are_errors() {
        let error = |key, value| edited(CASE, &[(key, value)]).unwrap_err().to_string();
        for (key, step) in [("stages[2].steps", "stages[2]"), ("title.more", "title")] {
            let rule = format!("{key}: {step} is not a table or a member of a list");
            assert_eq!(error(key, "1"), rule);
        }
        assert!(error("title", "y z").starts_with("title: "));
        assert!(matches!(
            edited("=", &[("a", "1")]),
            Err(EditError::Syntax { .. })
        ));
    }
}
