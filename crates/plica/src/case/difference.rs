//! The keys that two case files give different values.

use std::collections::BTreeMap;
use std::fmt;

/// A key that two case files give different values.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The key with all its tables, such as `stages[2].steps`.
    pub key: String,
    /// Its value in the first text; none if it is not given.
    pub old: Option<String>,
    /// Its value in the second text.
    pub new: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = |value: &Option<String>| value.clone().unwrap_or("not given".into());
        write!(
            f,
            "{}: {} -> {}",
            self.key,
            value(&self.old),
            value(&self.new)
        )
    }
}

/// Returns the keys with different values in two texts, whatever their spaces, comments and order. A text
/// that is not TOML has no keys.
pub fn differences(old: &str, new: &str) -> Vec<Difference> {
    let [old, new] = [old, new].map(|text| {
        let mut values = BTreeMap::new();
        if let Ok(table) = text.parse::<toml::Table>() {
            flatten("", &toml::Value::Table(table), &mut values);
        }
        values
    });
    let keys = old.keys().chain(new.keys());
    let mut keys: Vec<&String> = keys.collect();
    keys.sort();
    keys.dedup();
    let differ = keys
        .into_iter()
        .filter(|key| old.get(*key) != new.get(*key));
    let difference = |key: &String| Difference {
        key: key.clone(),
        old: old.get(key).cloned(),
        new: new.get(key).cloned(),
    };
    differ.map(difference).collect()
}

fn flatten(key: &str, value: &toml::Value, values: &mut BTreeMap<String, String>) {
    match value {
        toml::Value::Table(table) => {
            for (name, value) in table {
                let dot = if key.is_empty() { "" } else { "." };
                flatten(&format!("{key}{dot}{name}"), value, values);
            }
        }
        toml::Value::Array(list) if list.iter().any(toml::Value::is_table) => {
            for (i, value) in list.iter().enumerate() {
                flatten(&format!("{key}[{}]", i + 1), value, values);
            }
        }
        value => {
            values.insert(key.to_owned(), value.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_values_are_compared() {
        let old = "title = 'a'\n[tube]\nlength = 3.0 # long\n[[stages]]\nsteps = 4\n[[stages]]\nsteps = 5\n";
        let new = "title='a'\n[tube]\nlength = 4.0\nthickness = 0.1\n[[stages]]\nsteps = 4\n[[stages]]\nsteps = 6\n";
        let found: Vec<String> = differences(old, new)
            .iter()
            .map(ToString::to_string)
            .collect();
        assert_eq!(
            found,
            [
                "stages[2].steps: 5 -> 6",
                "tube.length: 3.0 -> 4.0",
                "tube.thickness: not given -> 0.1"
            ]
        );
        assert!(differences(old, old).is_empty());
    }
}
