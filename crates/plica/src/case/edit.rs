//! A case with some of its keys changed.

use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Why a key cannot be changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The case is not TOML.
    #[error("the case is not TOML: {0}")]
    Case(String),
    /// The value is not TOML.
    #[error("{key} = {value}: the value is not TOML ({error})")]
    Value {
        /// The dotted key.
        key: String,
        /// The value.
        value: String,
        /// What is wrong with it.
        error: String,
    },
    /// There is something on the way to the key that holds no keys.
    #[error("{key}: {step} is not a table, or no member of a list")]
    Way {
        /// The dotted key.
        key: String,
        /// Where it goes wrong.
        step: String,
    },
}

/// The text of a case with keys changed or added; comments and everything else stay. A key is dotted, with members of
/// lists counted from one, as in messages (`stages[2].steps`); a value is written as in TOML (`0.25`, `"newmark"`).
/// Whether the outcome is a case is for [`super::read`] to say.
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
/// [`EditError`] for what is not TOML, and for a key that leads through something else than tables.
pub fn edited<K: AsRef<str>, V: AsRef<str>>(
    text: &str,
    changes: &[(K, V)],
) -> Result<String, EditError> {
    let document = text.parse::<DocumentMut>();
    let mut document = document.map_err(|error| EditError::Case(error.to_string()))?;
    for (key, value) in changes {
        let (key, value) = (key.as_ref(), value.as_ref());
        let parsed = value.parse::<Value>().map_err(|error| EditError::Value {
            key: key.into(),
            value: value.into(),
            error: error.to_string(),
        })?;
        let steps: Vec<&str> = key.split('.').collect();
        set(document.as_table_mut(), &steps, parsed).map_err(|step| EditError::Way {
            key: key.into(),
            step,
        })?;
    }
    Ok(document.to_string())
}

/// # Errors
/// The step at which the way ends.
fn set(table: &mut dyn TableLike, steps: &[&str], value: Value) -> Result<(), String> {
    let Some((&step, rest)) = steps.split_first() else {
        return Ok(());
    };
    let (name, member) = match step.split_once('[') {
        Some((name, rest)) => {
            let number = rest.strip_suffix(']').and_then(|n| n.parse().ok());
            (name, Some(number.filter(|n| *n > 0).ok_or(step)?))
        }
        None => (step, None::<usize>),
    };
    if rest.is_empty() && member.is_none() {
        match table.get_mut(name) {
            // What is written around the value stays.
            Some(Item::Value(old)) => {
                let decor = old.decor().clone();
                *old = value;
                *old.decor_mut() = decor;
            }
            _ => {
                table.insert(name, Item::Value(value));
            }
        }
        return Ok(());
    }
    if member.is_none() && !table.contains_key(name) {
        table.insert(name, toml_edit::table());
    }
    let item = table.get_mut(name).ok_or(step)?;
    let inner = match member {
        None => item.as_table_like_mut(),
        Some(n) => match item {
            Item::ArrayOfTables(list) => list.get_mut(n - 1).map(|t| t as &mut dyn TableLike),
            Item::Value(Value::Array(list)) => list
                .get_mut(n - 1)
                .and_then(Value::as_inline_table_mut)
                .map(|t| t as &mut dyn TableLike),
            _ => None,
        },
    };
    set(inner.ok_or(step)?, rest, value)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "title = \"x\" # what it is

[mesh]
control_points = { axial = 60, around = 16, thickness = 4 }

[[stages]]
name = \"contract\"
drive.circular.diameter_ratio = 0.25 # narrow
";

    #[test]
    fn every_kind_of_table_is_gone_through() {
        let changes = [
            ("title", "\"y\""),
            ("mesh.control_points.axial", "90"),
            ("stages[1].drive.circular.diameter_ratio", "0.3"),
            ("stages[1].drive.colon.displacement", "0.1"),
            ("solver.pseudo_time.damping", "5.0"),
        ];
        let text = edited(CASE, &changes).unwrap();
        let table: toml::Table = text.parse().unwrap();
        assert_eq!(table["title"].as_str(), Some("y"));
        assert_eq!(
            table["mesh"]["control_points"]["axial"].as_integer(),
            Some(90)
        );
        assert_eq!(
            table["mesh"]["control_points"]["around"].as_integer(),
            Some(16)
        );
        let drive = &table["stages"][0]["drive"];
        assert_eq!(drive["circular"]["diameter_ratio"].as_float(), Some(0.3));
        assert_eq!(drive["colon"]["displacement"].as_float(), Some(0.1));
        assert_eq!(
            table["solver"]["pseudo_time"]["damping"].as_float(),
            Some(5.0)
        );
        assert!(text.contains("# what it is") && text.contains("# narrow"));
        assert_eq!(edited(CASE, &[("", ""); 0]).unwrap(), CASE);
    }

    #[test]
    fn what_cannot_be_changed_says_why() {
        let way = |key| edited(CASE, &[(key, "1")]).unwrap_err().to_string();
        assert_eq!(
            way("stages[2].steps"),
            "stages[2].steps: stages[2] is not a table, or no member of a list"
        );
        assert_eq!(
            way("title.more"),
            "title.more: title is not a table, or no member of a list"
        );
        assert!(matches!(
            edited(CASE, &[("title", "y z")]),
            Err(EditError::Value { .. })
        ));
        assert!(matches!(
            edited("=", &[("a", "1")]),
            Err(EditError::Case(_))
        ));
    }
}
