//! The case file as a JSON schema, for editors that complete and check while one writes.

use super::keys::{Given, Key, Kind, Limit};
use super::table::KEYS;
use serde_json::{Map, Value, json};

/// A place in the file: what may be written there, and what lies beneath.
#[derive(Default)]
struct Node {
    key: Option<&'static Key>,
    children: Vec<(&'static str, Node)>,
}

/// The schema (JSON Schema, 2020-12), from the table of keys. Rules between keys are not in it: `plica check` has them all.
pub fn schema() -> Value {
    let mut root = Node::default();
    for key in KEYS {
        let mut node = &mut root;
        for name in key.path.split('.') {
            node = node.child(name.trim_end_matches("[]"));
        }
        node.key = Some(key);
    }
    let mut schema = root.table();
    schema.insert(
        "$schema".into(),
        "https://json-schema.org/draft/2020-12/schema".into(),
    );
    schema.insert("title".into(), "A case of Plica".into());
    Value::Object(schema)
}

impl Node {
    fn child(&mut self, name: &'static str) -> &mut Self {
        let place = self.children.iter().position(|(own, _)| *own == name);
        let place = place.unwrap_or_else(|| {
            self.children.push((name, Self::default()));
            self.children.len() - 1
        });
        &mut self.children[place].1
    }

    /// Whether it must be there, wherever what is around it is.
    fn is_needed(&self) -> bool {
        self.key
            .is_some_and(|key| matches!(key.given, Given::Always(_)))
    }

    /// What may be written in its place.
    fn schema(&self) -> Value {
        let table = || Value::Object(self.table());
        let Some(key) = self.key else {
            return table();
        };
        let own = match key.kind {
            Kind::Tables => json!({ "type": "array", "items": table() }),
            Kind::Choice => table(),
            _ if self.children.is_empty() => value(key),
            _ => json!({ "anyOf": [value(key), table()] }),
        };
        let Value::Object(mut own) = own else {
            return own;
        };
        own.insert("description".into(), described(key).into());
        // What TOML and JSON write alike.
        if let Given::Or(default) = key.given
            && let Ok(default) = serde_json::from_str::<Value>(default)
        {
            own.insert("default".into(), default);
        }
        Value::Object(own)
    }

    /// A table with what lies beneath, and nothing else.
    fn table(&self) -> Map<String, Value> {
        let mut properties = Map::new();
        let mut others = Value::Bool(false);
        for (name, child) in &self.children {
            match *name {
                "<name>" => others = child.schema(),
                name => {
                    properties.insert(name.into(), child.schema());
                }
            }
        }
        let needed = self.children.iter().filter(|(_, child)| child.is_needed());
        let needed: Vec<&str> = needed.map(|(name, _)| *name).collect();
        let mut table = Map::new();
        table.insert("type".into(), "object".into());
        table.insert("properties".into(), Value::Object(properties));
        table.insert("additionalProperties".into(), others);
        if !needed.is_empty() {
            table.insert("required".into(), needed.into());
        }
        table
    }
}

fn described(key: &Key) -> String {
    let unit = match key.unit {
        "" => String::new(),
        unit => format!(" ({unit})"),
    };
    let range = match key.range.words() {
        words if words.is_empty() => words,
        words => format!(" {words}."),
    };
    format!("{}{unit}{range}", key.meaning.replace('`', ""))
}

/// The value of a key that is no table.
fn value(key: &Key) -> Value {
    let number = || json!({ "type": "number" });
    match key.kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Zone => json!({ "type": "array", "items": number(), "minItems": 2, "maxItems": 2 }),
        Kind::Points => {
            let point = json!({ "type": "array", "items": number(), "minItems": 2, "maxItems": 2 });
            json!({ "type": "array", "items": point, "minItems": 2 })
        }
        Kind::Count | Kind::Number => {
            let mut schema = Map::new();
            let kind = if key.kind == Kind::Count {
                "integer"
            } else {
                "number"
            };
            schema.insert("type".into(), kind.into());
            for (limit, [at, beyond]) in [
                (key.range.low, ["minimum", "exclusiveMinimum"]),
                (key.range.high, ["maximum", "exclusiveMaximum"]),
            ] {
                match limit {
                    Limit::None => {}
                    Limit::At(x) => {
                        schema.insert(at.into(), x.into());
                    }
                    Limit::Beyond(x) => {
                        schema.insert(beyond.into(), x.into());
                    }
                }
            }
            Value::Object(schema)
        }
        // Their tables say it all.
        Kind::Tables | Kind::Choice => json!({}),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The part of the schema for a value at a path of a case, if it allows one there.
    fn at<'a>(schema: &'a Value, value: &toml::Value) -> Result<(), String> {
        let choices = schema["anyOf"].as_array();
        if let Some(choices) = choices {
            let fits = choices.iter().any(|choice| at(choice, value).is_ok());
            return if fits {
                Ok(())
            } else {
                Err(format!("{value} is none of {schema}"))
            };
        }
        match value {
            toml::Value::Table(table) => {
                for (name, value) in table {
                    let own: &'a Value = match &schema["properties"][name] {
                        Value::Null => &schema["additionalProperties"],
                        own => own,
                    };
                    if *own == Value::Bool(false) || own.is_null() {
                        return Err(format!("{name} is not allowed"));
                    }
                    at(own, value)?;
                }
                let needed = schema["required"].as_array().into_iter().flatten();
                let missing =
                    |name: &&Value| !table.contains_key(name.as_str().unwrap_or_default());
                match needed.into_iter().find(missing) {
                    Some(name) => Err(format!("{name} is missing")),
                    None => Ok(()),
                }
            }
            toml::Value::Array(list) if schema["type"] == "array" => list
                .iter()
                .try_for_each(|value| at(&schema["items"], value)),
            toml::Value::String(word) => match schema["enum"].as_array() {
                Some(words) if !words.contains(&word.as_str().into()) => {
                    Err(format!("{word} is none of {words:?}"))
                }
                None if schema["type"] != "string" => Err(format!("{word} is no {schema}")),
                _ => Ok(()),
            },
            toml::Value::Integer(_) | toml::Value::Float(_) => {
                let x = value
                    .as_float()
                    .or(value.as_integer().map(|n| n as f64))
                    .unwrap_or(0.0);
                let whole = schema["type"] == "integer" && value.is_integer();
                if !whole && schema["type"] != "number" {
                    return Err(format!("{value} is no {schema}"));
                }
                let low = schema["minimum"].as_f64().is_none_or(|low| x >= low);
                let above = schema["exclusiveMinimum"]
                    .as_f64()
                    .is_none_or(|low| x > low);
                if low && above {
                    Ok(())
                } else {
                    Err(format!("{x} is too small"))
                }
            }
            toml::Value::Boolean(_) if schema["type"] == "boolean" => Ok(()),
            other => Err(format!("{other} is no {schema}")),
        }
    }

    #[test]
    fn the_cases_that_come_along_are_what_it_says() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        let schema = schema();
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            if entry
                .path()
                .extension()
                .is_some_and(|ending| ending == "toml")
            {
                let text = std::fs::read_to_string(entry.path()).unwrap();
                let case: toml::Table = text.parse().unwrap();
                let fits = at(&schema, &toml::Value::Table(case));
                assert_eq!(fits, Ok(()), "{}", entry.path().display());
                count += 1;
            }
        }
        assert!(count > 5);
    }

    #[test]
    fn what_is_wrong_is_not() {
        let schema = schema();
        for case in [
            "",
            "[[stages]]\nstepps = 3",
            "[[stages]]\nsteps = 0",
            "[[stages]]\nsteps = 2.5",
            "symmetry = 'oval'\n[[stages]]\nsteps = 1",
            "[tube]\nlength = 'long'\n[[stages]]\nsteps = 1",
            "[muscles.a]\ndirection = 'circular'\n[[stages]]\nsteps = 1",
        ] {
            let table: toml::Table = case.parse().unwrap();
            assert!(at(&schema, &toml::Value::Table(table)).is_err(), "{case}");
        }
    }

    #[test]
    fn every_key_is_in_it_with_its_meaning() {
        let text = schema().to_string();
        for key in KEYS {
            let meaning = serde_json::to_string(&described(key)).unwrap();
            assert!(text.contains(&meaning), "{}", key.path);
        }
    }
}
