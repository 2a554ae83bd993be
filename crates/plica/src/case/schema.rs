//! The JSON schema of the case file, for editors that complete and check a case.

use super::key::{Key, Kind, Limit, Range};
use super::keys::Case;
use super::read::Table;
use serde_json::{Map, Value, json};

/// Returns the schema (JSON Schema, 2020-12). It does not include the rules between keys, which
/// `plica check` checks.
pub fn schema() -> Value {
    let mut schema = table(Case::KEYS);
    schema.insert(
        "$schema".into(),
        "https://json-schema.org/draft/2020-12/schema".into(),
    );
    schema.insert("title".into(), "A case of Plica".into());
    Value::Object(schema)
}

/// Returns the schema of a table with these keys and no others.
fn table(keys: &[Key]) -> Map<String, Value> {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|key| (key.name.into(), Value::Object(property(key))))
        .collect();
    let required = keys.iter().filter(|key| key.is_required());
    let required: Vec<&str> = required.map(|key| key.name).collect();
    let mut table = Map::new();
    table.insert("type".into(), "object".into());
    table.insert("properties".into(), Value::Object(properties));
    table.insert("additionalProperties".into(), false.into());
    if !required.is_empty() {
        table.insert("required".into(), required.into());
    }
    table
}

/// Returns the schema of a table with exactly one of these keys.
fn one_key(keys: &[Key]) -> Map<String, Value> {
    let mut tables = table(keys);
    tables.insert("minProperties".into(), 1.into());
    tables.insert("maxProperties".into(), 1.into());
    tables
}

/// Returns the schema of a key's value, with its description and default.
fn property(key: &Key) -> Map<String, Value> {
    let mut property = value(key);
    property.insert("description".into(), description(key).into());
    // TOML and JSON write numbers, booleans and words alike.
    let default = key.default().map(|default| serde_json::from_str(&default));
    if let Some(Ok(default)) = default {
        property.insert("default".into(), default);
    }
    property
}

pub(super) fn description(key: &Key) -> String {
    let unit = match key.rule.unit {
        "" => String::new(),
        unit => format!(" ({unit})"),
    };
    let range = match key.rule.range.words() {
        words if words.is_empty() => words,
        words => format!(" {words}."),
    };
    format!("{}{unit}{range}", key.meaning().replace('`', ""))
}

fn value(key: &Key) -> Map<String, Value> {
    let numbers = |count: usize| json!({ "type": "array", "items": { "type": "number" }, "minItems": count, "maxItems": count });
    let pair = numbers(2);
    let value = match key.kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Integer => json!({ "type": "integer" }),
        Kind::Number => json!({ "type": "number" }),
        Kind::Zone => pair,
        Kind::Position => numbers(3),
        Kind::Points => json!({ "type": "array", "items": pair, "minItems": 2 }),
        Kind::Numbers => json!({ "type": "object", "additionalProperties": { "type": "number" } }),
        Kind::Course => json!({ "anyOf": [
            number_in(&key.rule.range),
            { "type": "array", "minItems": 1, "items": {
                "type": "array", "minItems": 2, "maxItems": 2,
                "prefixItems": [{ "type": "number", "minimum": 0 }, number_in(&key.rule.range)],
            } },
        ] }),
        Kind::VectorCourse(size) => json!({ "anyOf": [
            numbers(size),
            { "type": "array", "minItems": 1, "items": numbers(size + 1) },
        ] }),
        Kind::Table(keys) => return table(keys),
        Kind::List(keys) => json!({ "type": "array", "items": table(keys) }),
        Kind::Named(keys) => json!({ "type": "object", "additionalProperties": table(keys) }),
        Kind::Either(keys, alternatives) => {
            let (alone, together) = keys.split_at(alternatives);
            json!({ "anyOf": [one_key(alone), table(together)] })
        }
        Kind::Choice(words, keys) => {
            let tables = one_key(keys);
            match (words, keys) {
                (_, []) => json!({ "enum": words }),
                ([], _) => return tables,
                _ => json!({ "anyOf": [{ "enum": words }, tables] }),
            }
        }
    };
    let Value::Object(mut value) = value else {
        return Map::new();
    };
    match key.kind {
        Kind::Numbers | Kind::Course | Kind::VectorCourse(_) => {}
        _ => value.extend(limits(&key.rule.range)),
    }
    value
}

/// Returns the schema of a number in a range.
fn number_in(range: &Range) -> Value {
    let mut value = limits(range);
    value.insert("type".into(), "number".into());
    Value::Object(value)
}

/// Returns the limits of a range.
fn limits(range: &Range) -> Map<String, Value> {
    let mut value = Map::new();
    let limits = [
        (range.low, ["minimum", "exclusiveMinimum"]),
        (range.high, ["maximum", "exclusiveMaximum"]),
    ];
    for (limit, [inclusive, exclusive]) in limits {
        let (name, x) = match limit {
            Limit::None => continue,
            Limit::Inclusive(x) => (inclusive, x),
            Limit::Exclusive(x) => (exclusive, x),
        };
        value.insert(name.into(), x.into());
    }
    value
}
