//! Each mistake gives one message, at its place; several mistakes are reported together.

use super::*;
use crate::case::key::join;
use crate::case::read::Table as _;
use toml::{Table, Value};

/// A step on the path to a value: a name, or the index of a member of a list.
#[derive(Clone)]
enum Step {
    Name(String),
    Member(usize),
}

/// Appends the paths to all keys and members below a value.
fn paths(value: &Value, path: &[Step], found: &mut Vec<Vec<Step>>) {
    let below: Vec<(Step, &Value)> = match value {
        Value::Table(table) => {
            let step = |(name, value)| (Step::Name(String::clone(name)), value);
            table.iter().map(step).collect()
        }
        Value::Array(list) if list.iter().all(Value::is_table) => {
            let members = list.iter().enumerate();
            members.map(|(i, value)| (Step::Member(i), value)).collect()
        }
        _ => vec![],
    };
    for (step, value) in below {
        let path = [path, &[step]].concat();
        found.push(path.clone());
        paths(value, &path, found);
    }
}

fn at<'v>(mut value: &'v mut Value, path: &[Step]) -> &'v mut Value {
    for step in path {
        value = match step {
            Step::Name(name) => &mut value[name.as_str()],
            Step::Member(i) => &mut value[*i],
        };
    }
    value
}

/// Returns the dotted path, and the pattern of the key.
fn dotted(path: &[Step]) -> (String, String) {
    let (mut dotted, mut pattern) = (String::new(), String::new());
    for step in path {
        match step {
            Step::Name(name) => {
                let is_chosen = pattern == "muscles" || pattern == "stages[].drive";
                dotted = join(&dotted, name);
                pattern = match is_chosen {
                    true => format!("{pattern}.<name>"),
                    false if pattern.is_empty() => name.clone(),
                    false => format!("{pattern}.{name}"),
                };
            }
            Step::Member(i) => {
                dotted += &format!("[{}]", i + 1);
                pattern += "[]";
            }
        }
    }
    (dotted, pattern)
}

/// Returns every mistake in a single key of a case: its kind, the dotted path and the case.
fn mistakes(text: &str) -> Vec<(&'static str, String, Value)> {
    let case = Value::Table(text.parse::<Table>().unwrap());
    let (mut all, mut mistakes) = (vec![], vec![]);
    paths(&case, &[], &mut all);
    for path in all {
        let (key, pattern) = dotted(&path);
        let mut add = |kind, case| mistakes.push((kind, key.clone(), case));
        let mut wrong = case.clone();
        let place = at(&mut wrong, &path);
        *place = match place {
            Value::Integer(_) | Value::Float(_) | Value::Boolean(_) => Value::String("?".into()),
            _ => Value::Integer(7),
        };
        add("wrong type", wrong);
        let Some((Step::Name(name), table)) = path.split_last() else {
            continue;
        };
        if !pattern.ends_with("<name>") {
            let mut wrong = case.clone();
            let table = at(&mut wrong, table).as_table_mut().unwrap();
            let value = table.remove(name).unwrap();
            table.insert(format!("{name}x"), value);
            add("misspelt", wrong);
        }
        let mut is_required = false;
        visit(Case::KEYS, &mut |own, key| {
            is_required |= own == pattern && key.is_required()
        });
        // Without its name, a material of a library may be any law.
        if is_required && !pattern.ends_with("material.from") {
            let mut wrong = case.clone();
            at(&mut wrong, table).as_table_mut().unwrap().remove(name);
            add("missing", wrong);
        }
    }
    mistakes
}

#[test]
fn one_mistake_gives_one_message() {
    let mut count = 0;
    let mut all = cases();
    all.push(("rich".into(), RICH.into()));
    for (name, text) in all {
        for (kind, key, case) in mistakes(&text) {
            let text = toml::to_string(&case).unwrap();
            let found = problems(&text);
            assert_eq!(found.len(), 1, "{name}, {key} {kind}: {found:#?}\n{text}");
            assert!(
                found[0].key.starts_with(&key),
                "{name}, {key} {kind}: {found:?}"
            );
            count += 1;
        }
    }
    assert!(count > 500, "{count}");
}

#[test]
fn mistakes_of_all_kinds_are_reported_together_in_the_order_of_the_text() {
    let text = "\
        [tube]\nlenght = 5.0\n\
        [material.neo-hookean]\npoisson_ratio = 0.5\n\
        [muscles.a]\ndirection = 'circular'\nzone = [1.0, 0.5]\n\
        [muscles.b]\ndirection = 'circular'\nzone = 0.5\n\
        [muscles.c]\nzone = [0.0, 0.2]\n\
        [mesh]\ncontrol_points = { axial = 2, around = 'many' }\n\
        [[stages]]\ndrive.a.length_ratio = 1.5\ndrive.b.diameter_ratio = true\ndrive.c.length_ratio = 1.5\n\
        drive.d.diameter_ratio = 0.5\n\
        [solver]\nmax_step_halvings = 0.5\npseudo_time = { damping = 1.0 }\n";
    let found = problems(text);
    let keys: Vec<&str> = found.iter().map(|p| p.key.as_str()).collect();
    assert_eq!(
        keys,
        [
            "tube.lenght",
            "material.neo-hookean.poisson_ratio",
            "muscles.a.zone",
            "muscles.b.zone",
            "muscles.c.direction",
            "mesh.control_points.axial",
            "mesh.control_points.around",
            "stages[1].drive.a.length_ratio",
            "stages[1].drive.b.diameter_ratio",
            "stages[1].drive.d",
            "solver.max_step_halvings",
            "solver.pseudo_time",
        ]
    );
    assert_eq!(
        found[1].to_string(),
        "material.neo-hookean.poisson_ratio = 0.5: must be at most 0.4999 (the law is compressible; the solver loses its accuracy beyond); try 0.495"
    );
    assert_eq!(&text[found[2].span.clone()], "[1.0, 0.5]");
}

#[test]
fn a_value_of_the_wrong_form_gets_the_right_form_as_help() {
    let stages = "[[stages]]\ndrive.ileum.displacement = 0.1\n";
    for (text, key, help) in [
        (
            "tube.length = '3.5'",
            "tube.length",
            "write 3.5, without quotes",
        ),
        ("mesh.degree = 3.0", "mesh.degree", "write 3"),
        (
            "mesh.degree = '2'",
            "mesh.degree",
            "write 2, without quotes",
        ),
        ("mesh.degree = '2.5'", "mesh.degree", "try 3"),
        (
            "material = 'neo-hookean'",
            "material",
            "write [material.neo-hookean]",
        ),
        (
            "material.youngs_modulus = 2",
            "material.youngs_modulus",
            "it belongs to material.neo-hookean or material.mooney-rivlin",
        ),
        (
            "symmetry = 'fold'",
            "symmetry",
            "write symmetry = { fold = ... }",
        ),
        (
            "symmetry = { none = 1 }",
            "symmetry.none",
            "write \"none\", without a table",
        ),
        (
            "units = { length = 'MM', stress = 'kPa' }",
            "units.length",
            "did you mean \"mm\"?",
        ),
        (
            "ends.colon = 'Fixed'",
            "ends.colon",
            "did you mean \"fixed\"?",
        ),
        ("mesh = 3", "mesh", "write [mesh]"),
        (
            "mesh.control_points = 40",
            "mesh.control_points",
            "write control_points = { axial = ... }",
        ),
        (
            "mesh.axial = 40",
            "mesh.axial",
            "it belongs to mesh.control_points",
        ),
        (
            "solver.ramp = 4",
            "solver.ramp",
            "it belongs to solver.pseudo_time",
        ),
        ("muscles = 3", "muscles", "write [muscles.NAME]"),
        (
            "muscles.zone = [0, 1]",
            "muscles.zone",
            "write muscles.NAME.zone, with a name",
        ),
        (
            "imperfections = 1",
            "imperfections",
            "write [[imperfections]]",
        ),
        ("mesh.refine = [1]", "mesh.refine[1]", ""),
        (
            "tube.colour = 'red'",
            "tube.colour",
            "the keys here are diameter, length, thickness, diameter_along, thickness_along",
        ),
    ] {
        let found = problems(&format!("{text}\n{stages}"));
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!(found[0].key, key);
        assert_eq!(found[0].help.as_deref().unwrap_or_default(), help, "{text}");
    }
    // A whole number is a number, of any length.
    assert!(read(&format!("tube.length = 4\n{stages}"), "case").is_ok());
    let found = problems(&format!("tube.length = 99999999999999999999\n{stages}"));
    assert!(
        found[0].rule.starts_with("must be from 0.01 to 1000"),
        "{found:?}"
    );
}

#[test]
fn names_with_dots_are_single_names() {
    let text = "'tube.length' = 1\n'' = 2\n[tube]\nlength = 0.5\n[muscles.'a.b']\ndirection = 'circular'\nzone = [1, 2]\n[[stages]]\ndrive.ileum.displacement = 0.1\n";
    let found = problems(text);
    let places = found
        .iter()
        .map(|p| (p.key.as_str(), &text[p.span.clone()]));
    assert_eq!(
        places.collect::<Vec<_>>(),
        [
            ("\"tube.length\"", "'tube.length'"),
            ("\"\"", "''"),
            ("muscles.\"a.b\"", "'a.b'"),
            ("muscles.\"a.b\".zone", "[1, 2]"),
        ]
    );
}

#[test]
fn one_mistake_of_syntax_gives_one_message_in_its_line() {
    for (name, text) in cases() {
        let lines: Vec<&str> = text.lines().collect();
        for (n, line) in lines.iter().enumerate() {
            let line = line.split(" #").next().unwrap();
            let mistakes: Vec<String> = match line.split_once(" = ") {
                Some((key, _)) if !line.starts_with('#') => [
                    "1.2.3",
                    "word",
                    "0,5",
                    "05",
                    "",
                    "\"open",
                    "[1, 2",
                    "{ a = 1",
                    "\"\"\"open",
                ]
                .map(|value| format!("{key} = {value}"))
                .into_iter()
                .chain([line.replacen('=', " ", 1), line.replacen(" =", ":", 1)])
                .collect(),
                None if line.starts_with('[') => vec![line.replacen(']', "", 1)],
                _ => vec![],
            };
            for mistake in mistakes {
                let mut wrong = lines.clone();
                wrong[n] = &mistake;
                let text = wrong.join("\n");
                let found = problems(&text);
                assert_eq!(found.len(), 1, "{name}, {mistake}: {found:#?}");
                let line = text[..found[0].span.start].matches('\n').count();
                assert_eq!(line, n, "{name}, {mistake}: {found:?}");
            }
        }
    }
}

#[test]
fn mistakes_of_syntax_are_reported_together() {
    for (text, lines) in [
        ("[ends]\ncolon = fre\nileum = fixd\n", &[2, 3][..]),
        ("[output]\npictures\nstates_every\n", &[2, 3]),
        ("[tube\nlength = 3,5\n[tube]\n[[stages]\n", &[1, 2, 4]),
        ("a = [1, 2\nb = 3\n", &[1]),
        ("[mesh]\ndegree = 3\ndegree = 2\n[tube]\n[tube]\n", &[3, 5]),
    ] {
        let found = problems(text);
        let line = |p: &Problem| text[..p.span.start].matches('\n').count() + 1;
        assert_eq!(
            found.iter().map(line).collect::<Vec<_>>(),
            lines,
            "{found:?}"
        );
    }
    let twice = problems("[stages]\nsteps = 1\n[stages]\nsteps = 2\n");
    assert_eq!(twice[0].help.as_deref(), Some("write [[stages]] each time"));
}

#[test]
fn mistakes_of_syntax_get_help() {
    for (rest, help) in [
        (" = thick", "write \"thick\" if it is text"),
        (" = none", ""),
        (" = 1/3", ""),
        (" = True", "write true"),
        (" = NaN", ""),
        (" = fals", "write \"fals\" if it is text"),
        (" = 3,5", "write the number with a decimal point"),
        (" = 3,", ""),
        (": 3.0", "write = instead of the colon"),
        (" : 3.0", "write = instead of the colon"),
        (":3.0", "write = instead of the colon"),
        (" in D = 3.0", "a key has no blanks; write _ instead"),
        (" 3.0", "write key = value"),
    ] {
        let found = problems(&format!("[tube]\nlength{rest}\n[[stages]]\n"));
        assert_eq!(found.len(), 1, "{rest}: {found:?}");
        assert_eq!(found[0].help.as_deref().unwrap_or_default(), help, "{rest}");
    }
}

/// Returns the only problem of the usual case in millimetres with a line at its end.
fn problem_with(line: &str) -> Problem {
    let text = format!(
        "[units]\nlength = 'mm'\nstress = 'kPa'\n\
         [tube]\ndiameter = 25.0\nlength = 75.0\nthickness = 1.5\n\
         [material.neo-hookean]\nyoungs_modulus = 20.0\n\
         [muscles.ring]\ndirection = 'circular'\nzone = [20.0, 40.0]\n\
         [[stages]]\ndrive.ring.diameter_ratio = 0.5\n{line}\n"
    );
    let mut found = problems(&text);
    assert_eq!(found.len(), 1, "{line}: {found:#?}");
    found.remove(0)
}

#[test]
fn names_of_columns_in_a_stage_lead_to_their_targets() {
    for (line, meant) in [
        (
            "drive.inner_pressure = 0.5",
            "write stages[1].drive.inner-wall.pressure",
        ),
        (
            "drive.inner_pressure.pressure = 0.5",
            "write stages[1].drive.inner-wall.pressure",
        ),
        (
            "drive.outer_dead_load = 0.5",
            "write stages[1].drive.outer-wall.dead_load",
        ),
        (
            "drive.displacement_ileum = 1",
            "write stages[1].drive.ileum.displacement",
        ),
    ] {
        assert_eq!(problem_with(line).help.as_deref(), Some(meant), "{line}");
    }
}

#[test]
fn only_targets_of_the_driven_thing_are_offered() {
    for (line, help) in [
        (
            "drive.ring.displacment = 1.0",
            "a circular muscle has diameter_ratio, stretch, and shift",
        ),
        (
            "drive.colon.diameter_rat = 0.5",
            "an end of the tube has displacement, twist_degrees, offset, and tilt_degrees",
        ),
        (
            "drive.colon.displacment = 0.5",
            "did you mean displacement?",
        ),
        (
            "drive.inner-wall.foo = 0.5",
            "a surface of the tube has pressure and dead_load",
        ),
    ] {
        assert_eq!(problem_with(line).help.as_deref(), Some(help), "{line}");
    }
}

#[test]
fn limits_are_in_the_units_of_the_case() {
    let wave = "shape = { wave = { mode = 0 } }";
    for (line, rule) in [
        (
            format!("[[imperfections]]\nof = 'geometry'\namplitude = 1.0\n{wave}"),
            "must be at most a quarter of the wall's thickness, 0.375 mm",
        ),
        (
            "drive.inner-wall.dead_load = 300".into(),
            "must be from -200 kPa to 200 kPa, ten times Young's modulus",
        ),
        (
            "[muscles.more]\ndirection = 'longitudinal'\nzone = [70.0, 80.0]".into(),
            "must lie within the tube, 0 to 75 mm",
        ),
    ] {
        assert_eq!(problem_with(&line).rule, rule);
    }
}

#[test]
fn a_case_that_is_nested_too_deeply_gives_one_message() {
    let deep = 20_000;
    for text in [
        format!("x = {}{}", "[".repeat(deep), "]".repeat(deep)),
        format!("x = {}1{}", "{a=".repeat(deep), "}".repeat(deep)),
        format!("x = {}", "[".repeat(deep)),
        format!("{}b = 1", "a.".repeat(deep)),
        format!("[{}b]", "a.".repeat(deep)),
        format!("x = [\n{}", "[\n".repeat(deep)),
    ] {
        let found = problems(&text);
        assert_eq!(found.len(), 1, "{:.20}: {:#?}", text, found);
        assert_eq!(found[0].rule, "tables and lists are nested too deeply");
        assert!(found[0].span.len() <= 1, "{:?}", found[0].span);
    }
}
