//! Every declared key is read, with its default, its range and its unit.

use super::*;
use crate::case::key::{Default, LENGTH, Limit, STIFFNESS, STRESS, join};
use crate::case::read::Table as _;
use crate::solve::{PseudoTime, Scheme, Settings};
use crate::study::Output;
use std::collections::BTreeSet;
use toml::{Table, Value};

/// All declared keys with their patterns.
fn keys() -> Vec<(String, &'static Key)> {
    let mut keys = vec![];
    visit(Case::KEYS, &mut |pattern, key| {
        keys.push((pattern.to_owned(), key))
    });
    keys
}

/// A case in which a key of this pattern may be written.
fn base(pattern: &str) -> String {
    let mut text = "[muscles.circular]\ndirection = 'circular'\nzone = [0.5, 1.0]\n\
        [[stages]]\n[[stages]]\ndrive.colon.displacement = 0.1\n"
        .to_owned();
    if pattern.starts_with("solver.pseudo_time") {
        text += "[solver]\nscheme = 'newmark'\n";
    }
    if pattern.starts_with("units.") {
        text += "[units]\nlength = 'mm'\nstress = 'kPa'\n";
    }
    // The laws with the keys that they need.
    let laws = [
        ("mooney-rivlin", ""),
        ("yeoh", "c1 = 0.2, bulk = 20.0"),
        (
            "demiray",
            "shear_modulus = 0.3, stiffening = 1.0, bulk = 20.0",
        ),
        ("gent", "shear_modulus = 0.3, limit = 30.0, bulk = 20.0"),
        ("fung", "c = 0.2, along = 1.0, around = 1.5, bulk = 20.0"),
        ("neo-hookean", "shear_modulus = 0.3, bulk = 20.0"),
    ];
    let needs_both = pattern.ends_with(".shear_modulus") || pattern.ends_with(".bulk");
    let own = |law: &&(&str, &str)| {
        let is_own = pattern.contains(&format!("material.{}.", law.0));
        is_own && (law.0 != "neo-hookean" || needs_both)
    };
    let law = laws.iter().find(own);
    let mut law = law.map_or(String::new(), |(name, keys)| {
        format!("{name} = {{ {keys} }}")
    });
    if ["material.from", "material.file", "material.bulk"]
        .iter()
        .any(|end| pattern.ends_with(end))
    {
        law = "from = 'carotid-media-hgo-2000'".into();
        text += "[units]\nlength = 'mm'\nstress = 'kPa'\n";
    }
    if pattern.starts_with("layers[]") || pattern.ends_with(".layer") {
        let law = match &law[..] {
            "" => String::new(),
            law => format!("material = {{ {law} }}\n"),
        };
        let fibres = match pattern.contains(".fibres[]") {
            true => "fibres = [{ k1 = 0.5, k2 = 0.8, angle_degrees = 29.0 }]\n",
            false => "",
        };
        // One of them needs the other.
        let tone = match pattern {
            _ if pattern.ends_with("best_stretch") => {
                "tone = { tension = 0.1, least_stretch = 0.8 }\n"
            }
            _ if pattern.ends_with("least_stretch") => {
                "tone = { tension = 0.1, best_stretch = 1.4 }\n"
            }
            _ if pattern.ends_with("tone.width") => {
                "tone = { tension = 0.1, best_stretch = 1.4 }\n"
            }
            _ if pattern.contains(".tone.") => "tone = { tension = 0.1 }\n",
            _ => "",
        };
        let residual = match pattern.ends_with("opening_radius") {
            true => "residual = { opening_degrees = 60.0 }\n",
            false => "",
        };
        text += &format!(
            "[[layers]]\nname = 'media'\nthickness = 0.03\n{law}{fibres}{tone}{residual}\
             [[layers]]\nname = 'adventitia'\nthickness = 0.03\n"
        );
    } else if !law.is_empty() {
        text = format!("material = {{ {law} }}\n{text}");
    }
    if pattern.starts_with("mesh.refine[]") {
        text += "[[mesh.refine]]\nzone = [0.5, 1.0]\n";
    }
    let is_of_obstacle = ["drive.<name>.radius", "drive.<name>.position"];
    let is_of_obstacle = is_of_obstacle.iter().any(|end| pattern.ends_with(end));
    if pattern.starts_with("obstacles[]") || is_of_obstacle {
        let shape = match pattern {
            _ if pattern.contains(".sheath") => "sheath = { radius = 0.7 }",
            _ if pattern.contains(".ball") => {
                "ball = { radius = 0.2, position = [0.0, 0.0, -0.5] }"
            }
            _ if pattern.contains(".plate") => {
                "plate = { position = [0.7, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }"
            }
            _ => "rod = { radius = 0.2 }",
        };
        text = format!(
            "symmetry = 'none'\n{text}[[obstacles]]\nname = 'bolus'\nshape = {{ {shape} }}\n"
        );
    }
    let is_patch = pattern.starts_with("patches[]");
    if is_patch || pattern.ends_with("growth_through") {
        text += "[[patches]]\nname = 'scar'\nzone = [0.5, 1.0]\n";
    }
    if pattern.starts_with("foundations[]") {
        let direction = match pattern.ends_with("tension_only") {
            true => "direction = 'normal'\n",
            false => "",
        };
        let zone = match pattern.ends_with(".edge") {
            true => "zone = [0.5, 1.0]\n",
            false => "",
        };
        text += &format!("[[foundations]]\nstiffness = 0.01\n{direction}{zone}");
    }
    if pattern.contains(".sector") {
        let sector = "sector.width_degrees = 180.0\n";
        if pattern.starts_with("muscles.<name>.sector.") {
            text = text.replace("zone", &format!("{sector}zone"));
        } else if pattern.contains(".sector.") {
            text += sector;
        }
        text = format!("symmetry = 'none'\n{text}");
    }
    if pattern.starts_with("imperfections[]") {
        let shape = match pattern {
            "imperfections[].shape.mode" => "mode = 'mode'",
            _ if pattern.contains(".random") => "random = { seed = 1 }",
            _ => "wave = { mode = 2 }",
        };
        let of = match pattern {
            "imperfections[].direction" => "'colon-end'",
            "imperfections[].shape.mode" => "'geometry'",
            _ => "{ muscle = 'circular' }",
        };
        text = format!("symmetry = 'none'\n{text}");
        text += &format!("[[imperfections]]\nof = {of}\namplitude = 1e-4\nshape = {{ {shape} }}\n");
    }
    if pattern.starts_with("continuation") {
        text = text.replace(
            "[[stages]]\n[[stages]]",
            "[[stages]]\nname = 'contract'\n[[stages]]",
        );
        text += "[muscles.longitudinal]\ndirection = 'longitudinal'\nzone = [0.5, 1.0]\n";
        if pattern.contains('.') {
            text += "[continuation]\nof = 'longitudinal.length_ratio'\nbetween = [1.0, 1.25]\n";
        }
        if pattern.contains("switch[]") {
            text += "[[continuation.switch]]\n";
        }
    }
    if pattern.ends_with(".offset") || pattern.ends_with(".tilt_degrees") {
        text = format!("symmetry = 'none'\n{text}");
    }
    if pattern.contains(".active_stress.") || pattern.ends_with("drive.<name>.tension") {
        // One of them needs the other.
        let keys = match pattern.rsplit('.').next() {
            Some("best_stretch") => "least_stretch = 0.8",
            Some("least_stretch" | "width") => "best_stretch = 1.4",
            _ => "",
        };
        text = text.replace("zone", &format!("active_stress = {{ {keys} }}\nzone"));
    }
    if pattern.ends_with(".length_ratio") {
        text = text.replace("'circular'", "'longitudinal'");
    }
    text
}

/// The path of a key in its base case: the first member of each list, and a name that fits.
fn path(pattern: &str) -> String {
    let last = pattern.rsplit('.').next().unwrap();
    let name = match last {
        "displacement" | "twist_degrees" | "offset" | "tilt_degrees" => "colon",
        "volume" | "volume_ratio" => "lumen",
        "pressure" | "dead_load" => "inner-wall",
        "radius" | "position" => "bolus",
        "growth_through" => "scar",
        _ => "circular",
    };
    pattern.replace("[]", "[1]").replace("<name>", name)
}

/// Returns the base case of a key with a value written, or none if TOML cannot express that.
fn written(pattern: &str, literal: &str) -> Option<String> {
    edited(&base(pattern), &[(path(pattern), literal)]).ok()
}

fn read_case(text: &str) -> Result<Plan, CaseError> {
    read_with(text, "case", &|wanted| {
        Ok(match wanted {
            InputFile::Materials(..) => Input::Text(MATERIALS.into()),
            _ => state().into(),
        })
    })
}

#[test]
fn the_example_of_every_key_is_valid() {
    for (pattern, key) in keys() {
        let Some(text) = written(&pattern, &key.example()) else {
            let in_base = ["muscles", "stages"];
            assert!(in_base.contains(&pattern.as_str()), "{pattern}");
            continue;
        };
        if let Err(error) = read_case(&text) {
            panic!("{error}\n{text}");
        }
    }
}

#[test]
fn a_key_that_is_left_out_has_its_default() {
    for (pattern, key) in keys() {
        // The base case has muscles.
        if pattern != "muscles"
            && matches!(key.rule.default, Default::Value(_))
            && let Some(text) = written(&pattern, &key.example())
        {
            let (with, without) = (read_case(&text), read_case(&base(&pattern)));
            assert_eq!(with, without, "{pattern}");
        }
    }
    let plan = |scheme: &str| read(&format!("{}\n[solver]\n{scheme}", base("")), "case").unwrap();
    assert_eq!(plan("").solver, Settings::default());
    assert_eq!(plan("").output, Output::default());
    let pseudo_time = Scheme::PseudoTime(PseudoTime::default());
    assert_eq!(plan("scheme = 'newmark'").solver.scheme, pseudo_time);
    assert_eq!(
        plan("scheme = 'newmark'\npseudo_time = {}").solver.scheme,
        pseudo_time
    );
}

#[test]
fn every_range_ends_at_its_declared_limits() {
    let mut count = 0;
    for (pattern, key) in keys() {
        let is_integer = matches!(key.kind, Kind::Integer);
        let limits = [(key.rule.range.low, -1.0), (key.rule.range.high, 1.0)];
        for (limit, outwards) in limits {
            let next = |x: f64, way: f64| match is_integer {
                true => x + way,
                false if way < 0.0 => x.next_down(),
                false => x.next_up(),
            };
            let (inside, outside) = match limit {
                Limit::None => continue,
                Limit::Inclusive(x) => (x, next(x, outwards)),
                Limit::Exclusive(x) => (next(x, -outwards), x),
            };
            let rule = key.rule.range.broken_by(outside).unwrap();
            let is_broken = |x: f64| {
                let literal = if is_integer {
                    format!("{x}")
                } else {
                    format!("{x:?}")
                };
                let read = read_case(&written(&pattern, &literal).unwrap());
                let problems = read.map_or_else(|error| error.problems, |_| vec![]);
                let own = path(&pattern);
                problems.iter().any(|p| p.key == own && p.rule == rule)
            };
            assert!(is_broken(outside), "{pattern} = {outside}");
            assert!(!is_broken(inside), "{pattern} = {inside}");
            count += 1;
        }
        if matches!(key.kind, Kind::Number | Kind::Course) {
            for literal in ["nan", "inf", "-inf"] {
                let read = read_case(&written(&pattern, literal).unwrap());
                let problems = read.unwrap_err().problems;
                assert_eq!(problems[0].rule, "must be a finite number", "{pattern}");
            }
        }
    }
    assert!(count > 60, "{count}");
}

/// Scales all values of a case that have a unit.
fn scale(
    value: &mut Value,
    pattern: &str,
    [length, stress]: [f64; 2],
    seen: &mut BTreeSet<String>,
) {
    fn numbers(value: &mut Value, factor: f64) {
        match value {
            Value::Float(x) => *x *= factor,
            Value::Array(list) => list.iter_mut().for_each(|value| numbers(value, factor)),
            _ => panic!("a quantity with a unit is a decimal number"),
        }
    }
    let key = keys().into_iter().find(|(own, _)| own == pattern);
    let unit = key.map_or("", |(_, key)| key.rule.unit);
    match value {
        Value::Table(table) => {
            let of_muscle = table.get("of").is_some_and(Value::is_table);
            for (name, value) in table {
                let named = pattern == "muscles" || pattern.ends_with(".drive");
                let below = match named {
                    true => format!("{pattern}.<name>"),
                    false => join(pattern, name),
                };
                let below = below.replace("\"\"", "");
                // The amplitude of a muscle has no unit.
                if !(of_muscle && name == "amplitude") {
                    scale(value, &below, [length, stress], seen);
                }
            }
        }
        Value::Array(list) if list.iter().any(Value::is_table) => {
            for value in list {
                scale(value, &format!("{pattern}[]"), [length, stress], seen);
            }
        }
        value if [LENGTH, STRESS, STIFFNESS].contains(&unit) => {
            seen.insert(pattern.to_owned());
            let factor = match unit {
                LENGTH => length,
                STRESS => stress,
                _ => stress / length,
            };
            numbers(value, factor);
        }
        _ => {}
    }
}

#[test]
fn units_scale_a_case_and_change_nothing_else() {
    let plan = read(RICH, "case").unwrap();
    let mut seen = BTreeSet::new();
    let mut case = Value::Table(RICH.parse::<Table>().unwrap());
    scale(&mut case, "", [1.0 / 16.0, 1.0 / 64.0], &mut seen);
    case.as_table_mut().unwrap().remove("units");
    let ratios = read(&toml::to_string(&case).unwrap(), "case").unwrap();
    let units = plan.units.clone().unwrap();
    assert_eq!((units.diameter, units.youngs_modulus), (16.0, 64.0));
    assert_eq!(plan.stages[1].load.pressures[0].follower, 0.5 / 64.0);
    assert_eq!(
        Plan {
            units: None,
            ..plan
        },
        ratios
    );
    let has_unit = |key: &Key| [LENGTH, STRESS, STIFFNESS].contains(&key.rule.unit);
    let all = keys().into_iter().filter(|(_, key)| has_unit(key));
    // A layer has only one law.
    let is_other = |pattern: &str| {
        let of_layer = pattern.starts_with("layers[]");
        let others = [
            "mooney-rivlin",
            "demiray",
            "gent",
            "fung",
            if of_layer { "neo-hookean" } else { "yeoh" },
        ];
        // The case has a symmetry, which excludes the first, and a tube of constant diameter.
        let excluded = ["offset", "diameter_along", "thickness_along"];
        let is_excluded = excluded.iter().any(|end| pattern.ends_with(end));
        let is_second =
            pattern.starts_with("material.neo-hookean.") && !pattern.ends_with("youngs_modulus");
        // Materials of a library and open sectors have tests of their own.
        let is_elsewhere =
            pattern.ends_with("material.bulk") || pattern.ends_with("opening_radius");
        is_second
            || is_elsewhere
            || is_excluded
            || others
                .iter()
                .any(|law| pattern.contains(&format!("material.{law}.")))
    };
    let all = all
        .map(|(pattern, _)| pattern)
        .filter(|pattern| !is_other(pattern));
    assert_eq!(seen, all.collect());
}

#[test]
fn no_value_and_no_part_of_a_text_makes_the_reader_panic() {
    let odd = [
        "nan",
        "-1",
        "0",
        "1e300",
        "5e-324",
        "99999999999999999999",
        "-9223372036854775808",
        "'x'",
        "''",
        "true",
        "[]",
        "{}",
        "[[]]",
        "[1]",
        "[0.0, 0.0]",
        "[nan, inf]",
        "[{}]",
        "[1, {}]",
        "1979-05-27",
        "{ x = 1 }",
        "{ fold = 0 }",
        "{ table = [] }",
    ];
    for (pattern, _) in keys() {
        for literal in odd {
            let _ = written(&pattern, literal).map(|text| read_case(&text));
        }
    }
    for end in (0..STARTER.len()).filter(|&end| STARTER.is_char_boundary(end)) {
        let _ = read(&STARTER[..end], "case");
        let _ = read(&STARTER[end..], "case");
    }
    for name in ["'a.b'", "''", "'stages[1]'", "'[0]'", "\"\\u001b\"", "'ä'"] {
        let _ = read(&base("").replace("circular]", &format!("{name}]")), "case");
        let _ = read(
            &base("").replace("drive.colon", &format!("drive.{name}")),
            "case",
        );
    }
}

/// Checks a value against the parts of JSON Schema that the schema uses.
fn conforms(schema: &serde_json::Value, value: &Value) -> Result<(), String> {
    let wrong = || Err(format!("{value} does not conform to {schema}"));
    if let Some(choices) = schema["anyOf"].as_array() {
        let fits = choices.iter().any(|choice| conforms(choice, value).is_ok());
        return if fits { Ok(()) } else { wrong() };
    }
    if let Some(words) = schema["enum"].as_array() {
        let word = value.as_str().unwrap_or_default();
        return if words.contains(&word.into()) {
            Ok(())
        } else {
            wrong()
        };
    }
    let bound = |name: &str| schema[name].as_f64();
    match value {
        Value::Table(table) if schema["type"] == "object" => {
            let others = &schema["additionalProperties"];
            for (name, value) in table {
                let own = schema["properties"].get(name).unwrap_or(others);
                if *own == false {
                    return Err(format!("{name} is not allowed"));
                }
                conforms(own, value)?;
            }
            let required = schema["required"].as_array().into_iter().flatten();
            let mut missing = required.filter(|name| !table.contains_key(name.as_str().unwrap()));
            let size = table.len() as f64;
            let fits = bound("minProperties").is_none_or(|least| size >= least)
                && bound("maxProperties").is_none_or(|most| size <= most);
            if missing.next().is_some() || !fits {
                wrong()
            } else {
                Ok(())
            }
        }
        Value::Array(list) if schema["type"] == "array" => list
            .iter()
            .try_for_each(|value| conforms(&schema["items"], value)),
        Value::String(_) if schema["type"] == "string" => Ok(()),
        Value::Boolean(_) if schema["type"] == "boolean" => Ok(()),
        Value::Integer(_) | Value::Float(_) => {
            let x = value
                .as_float()
                .unwrap_or_else(|| value.as_integer().unwrap() as f64);
            let fits =
                schema["type"] == "number" || schema["type"] == "integer" && value.is_integer();
            let in_range = bound("minimum").is_none_or(|low| x >= low)
                && bound("exclusiveMinimum").is_none_or(|low| x > low)
                && bound("maximum").is_none_or(|high| x <= high)
                && bound("exclusiveMaximum").is_none_or(|high| x < high);
            if fits && in_range { Ok(()) } else { wrong() }
        }
        _ => wrong(),
    }
}

#[test]
fn valid_cases_conform_to_the_schema_and_others_do_not() {
    let schema = schema();
    let conforms = |text: &str| conforms(&schema, &Value::Table(text.parse().unwrap()));
    for (name, text) in cases() {
        assert_eq!(conforms(&text), Ok(()), "{name}");
    }
    for (pattern, key) in keys() {
        if let Some(text) = written(&pattern, &key.example()) {
            assert_eq!(conforms(&text), Ok(()), "{text}");
        }
    }
    for text in [
        "",
        "[[stages]]\nstepps = 3",
        "[[stages]]\nsteps = 0",
        "[[stages]]\nsteps = 2.5",
        "symmetry = 'oval'\n[[stages]]\nsteps = 1",
        "symmetry = {}\n[[stages]]\nsteps = 1",
        "[tube]\nlength = 'long'\n[[stages]]\nsteps = 1",
        "[muscles.a]\ndirection = 'circular'\n[[stages]]\nsteps = 1",
    ] {
        assert!(conforms(text).is_err(), "{text}");
    }
    let text = schema.to_string();
    for (pattern, key) in keys().into_iter().filter(|(_, key)| key.name != "stages") {
        let meaning = serde_json::to_string(&schema::description(key)).unwrap();
        assert!(text.contains(&meaning), "{pattern}");
        assert!(key.meaning().ends_with('.'), "{pattern}");
    }
}
