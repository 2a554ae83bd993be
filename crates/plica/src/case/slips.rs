//! One slip, one message; several slips, as many, all at once.

use super::keys::{Given, Kind, key};
use super::*;
use std::path::Path;
use toml::{Table, Value};

/// A case with a table of every kind.
const RICH: &str = r#"
title = "rich"
symmetry = { fold = 2 }
[units]
length = "mm"
stress = "kPa"
[tube]
diameter = 20.0
length = 100.0
thickness = 1.0
[material.neo-hookean]
youngs_modulus = 50.0
poisson_ratio = 0.4
volumetric = "quadratic"
[muscles.ring]
direction = "circular"
zone = [70.0, 90.0]
profile = "half-sine"
[muscles.next]
direction = "circular"
zone = [90.0, 95.0]
profile = { smooth-box = { edge = 0.25 } }
[muscles.long]
direction = "longitudinal"
zone = [70.0, 90.0]
profile = { table = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]] }
[ends]
colon = "fixed"
ileum = "sliding"
[mesh]
control_points = { axial = 40, around = 24, thickness = 6 }
degree = 3
volumetric_integration = "reduced"
refine = [{ zone = [80.0, 85.0], factor = 2.0 }]
[[stages]]
name = "both"
steps = 3
drive.ring.diameter_ratio = 0.8
drive.long.length_ratio = 1.1
drive.ileum.displacement = -2.0
drive.colon.twist_degrees = 10
[[stages]]
drive.inner-wall.pressure = 0.5
drive.outer-wall.dead_load = 0.25
drive.next.diameter_ratio = 0.9
[[imperfections]]
of = "colon-end"
direction = "axial"
amplitude = 0.01
shape = { wave = { mode = 2, phase_degrees = 20 } }
[[imperfections]]
of = { muscle = "ring" }
amplitude = 0.1
shape = { random = { seed = 7, modes = 4, half_waves = 2 } }
[[imperfections]]
of = "geometry"
amplitude = 0.01
shape = { wave = { mode = 4, axial = { zone = [20.0, 40.0] } } }
[solver]
scheme = "newmark"
tolerance = 1e-7
newton_iterations = 20
relaxation_steps = 100
relaxation_damping = 2.0
max_step_halvings = 6
pseudo_time = { damping = 50.0, ramp = 5, tolerance = 1e-6, max_steps = 1000, equilibrate = false }
[output]
pictures = false
profiles_every = 2
states_every = 2
stability_modes = 2
wall_points = 101
"#;

/// A case in which nothing is as what stands in for it.
const UNLIKE: &str = r#"
symmetry = "none"
[tube]
length = 8.0
[muscles.b]
direction = "longitudinal"
zone = [6.0, 7.0]
[muscles.c]
direction = "longitudinal"
zone = [7.0, 7.5]
[ends]
colon = "free"
ileum = "sliding"
[mesh]
control_points = { axial = 80, around = 16, thickness = 4 }
[[stages]]
name = "stage-2"
drive.b.length_ratio = 1.2
[[stages]]
name = "stage-1"
drive.c.length_ratio = 1.1
drive.ileum.displacement = 0.2
[[imperfections]]
of = "geometry"
amplitude = 0.01
shape = { wave = { mode = 4, axial = "uniform" } }
[[imperfections]]
of = "ileum-end"
direction = "axial"
amplitude = 0.01
shape = { wave = { mode = 3 } }
[solver]
scheme = "backward-euler"
pseudo_time = { damping = 5.0 }
"#;

/// Those two and the cases that come along, by their names.
fn cases() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut cases: Vec<(String, String)> = [("rich", RICH), ("unlike", UNLIKE)]
        .map(|(name, text)| (name.to_owned(), text.to_owned()))
        .into();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        cases.push((name, std::fs::read_to_string(path).unwrap()));
    }
    for (name, text) in &cases {
        read(text, name).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    cases
}

/// One step on the way to a key: its name, or its place in a list.
#[derive(Clone, Debug)]
enum Step {
    Name(String),
    Member(usize),
}

/// The ways to all keys and members below a value.
fn ways(value: &Value, way: &[Step], found: &mut Vec<Vec<Step>>) {
    let steps: Vec<(Step, &Value)> = match value {
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
    for (step, value) in steps {
        let way = [way, &[step]].concat();
        found.push(way.clone());
        ways(value, &way, found);
    }
}

fn at<'v>(mut value: &'v mut Value, way: &[Step]) -> &'v mut Value {
    for step in way {
        value = match step {
            Step::Name(name) => &mut value[name.as_str()],
            Step::Member(i) => &mut value[*i],
        };
    }
    value
}

/// The path in a case, and its pattern in the table of keys.
fn paths(way: &[Step]) -> (String, String) {
    let (mut path, mut pattern) = (String::new(), String::new());
    for step in way {
        match step {
            Step::Name(name) => {
                let chosen = pattern == "muscles" || pattern == "stages[].drive";
                path = keys::join(&path, name);
                pattern = keys::join(&pattern, if chosen { "<name>" } else { name });
            }
            Step::Member(i) => {
                path += &format!("[{}]", i + 1);
                pattern += "[]";
            }
        }
    }
    (path, pattern)
}

/// Every slip in one key of a case, and what it was.
fn slips(text: &str) -> Vec<(String, Value)> {
    let case = Value::Table(text.parse::<Table>().unwrap());
    let (mut all, mut slips) = (vec![], vec![]);
    ways(&case, &[], &mut all);
    for way in all {
        let (path, pattern) = paths(&way);
        let mut wrong = case.clone();
        let place = at(&mut wrong, &way);
        *place = match place {
            Value::Integer(_) | Value::Float(_) | Value::Boolean(_) => Value::String("?".into()),
            _ => Value::Integer(7),
        };
        slips.push((format!("{path}, of another type"), wrong));
        let Some((Step::Name(name), table)) = way.split_last() else {
            continue;
        };
        if !pattern.ends_with("<name>") {
            let mut misspelt = case.clone();
            let table = at(&mut misspelt, table).as_table_mut().unwrap();
            let value = table.remove(name).unwrap();
            table.insert(format!("{name}x"), value);
            slips.push((format!("{path}, misspelt"), misspelt));
        }
        if key(&pattern).is_some_and(|key| matches!(key.given, Given::Always(_))) {
            let mut missing = case.clone();
            at(&mut missing, table).as_table_mut().unwrap().remove(name);
            slips.push((format!("{path}, left out"), missing));
        }
    }
    slips
}

#[test]
fn one_slip_is_one_message() {
    let mut seen = 0;
    for (name, text) in cases() {
        for (what, case) in slips(&text) {
            let text = toml::to_string(&case).unwrap();
            let told = read(&text, &name).expect_err(&what).problems;
            assert_eq!(told.len(), 1, "{name}, {what}: {told:#?}\n{text}");
            let (path, _) = what.split_once(',').unwrap();
            let about = told[0].key.starts_with(path);
            assert!(about, "{name}, {what}: {told:?}");
            seen += 1;
        }
    }
    assert!(seen > 500, "{seen}");
}

#[test]
fn two_slips_are_two_messages() {
    let case: Value = Value::Table(RICH.parse().unwrap());
    let tables: Vec<&String> = case.as_table().unwrap().keys().collect();
    let slips = slips(RICH);
    for (i, one) in tables.iter().enumerate() {
        for other in &tables[..i] {
            // The first slip deep in each of the two tables.
            let of = |table: &str| {
                let below = |what: &str| {
                    what.strip_prefix(table)
                        .is_some_and(|rest| !rest.starts_with(','))
                };
                let found = slips.iter().find(|(what, _)| below(what));
                let found =
                    found.or_else(|| slips.iter().find(|(what, _)| what.starts_with(table)));
                found.unwrap().1[table].clone()
            };
            let mut wrong = case.clone();
            for table in [one, other] {
                wrong[table.as_str()] = of(table);
            }
            let text = toml::to_string(&wrong).unwrap();
            let told = read(&text, "case").unwrap_err().problems;
            assert_eq!(told.len(), 2, "{one}, {other}: {told:#?}");
        }
    }
}

#[test]
fn one_slip_of_toml_is_one_message() {
    for (name, text) in cases() {
        let lines: Vec<&str> = text.lines().collect();
        for (n, line) in lines.iter().enumerate() {
            let line = line.split(" #").next().unwrap();
            let slips = match line.split_once(" = ").filter(|_| !line.starts_with('#')) {
                Some((key, _)) => [
                    "1.2.3", "word", "0,5", "05", "", "\"open", "[1, 2", "{ a = 1",
                ]
                .map(|value| format!("{key} = {value}"))
                .into_iter()
                .chain([line.replacen('=', " ", 1)])
                .collect(),
                None if line.starts_with('[') => vec![line.replacen(']', "", 1)],
                None => vec![],
            };
            for slip in slips {
                let mut wrong = lines.clone();
                wrong[n] = &slip;
                let text = wrong.join("\n");
                let told = read(&text, &name).expect_err(&slip).problems;
                assert_eq!(told.len(), 1, "{name}, {slip}: {told:#?}");
                let place = told[0].span.clone().unwrap().start;
                let line = text[..place].matches('\n').count();
                assert_eq!(line, n, "{name}, {slip}: {told:?}");
            }
        }
    }
}

#[test]
fn a_key_one_table_too_high_is_one_message() {
    let material = "[material]\nyoungs_modulus = 50\npoisson_ratio = 0.4\n";
    for (text, keys) in [
        (
            material,
            &["material.youngs_modulus", "material.poisson_ratio"][..],
        ),
        ("[mesh]\naxial = 40\n", &["mesh.axial"]),
        ("[mesh]\naxial = 'x'\n", &["mesh.axial", "mesh.axial"]),
        ("[solver]\nramp = 4\n", &["solver.ramp"]),
        (
            "[muscles.a]\ndirection = 'circular'\nzone = [0.5, 1.0]\nedge = 0.2\n",
            &["muscles.a.edge"],
        ),
        (
            "[[imperfections]]\nof = 'geometry'\namplitude = 1e-3\nwave = { mode = 0 }\n",
            &["imperfections[1].wave"],
        ),
        (
            "[[imperfections]]\nof = 'geometry'\namplitude = 1e-3\nshape = { mode = 0 }\n",
            &["imperfections[1].shape.harmonic"],
        ),
        (
            "[muscles]\ndirection = 'circular'\nzone = [0.5, 1.0]\n",
            &["muscles"],
        ),
    ] {
        let text = format!("{text}[[stages]]\ndrive.ileum.displacement = 0.1\n");
        let problems = read(&text, "case").unwrap_err().problems;
        let told: Vec<&str> = problems.iter().map(|p| p.key.as_str()).collect();
        assert_eq!(told, keys, "{text}");
    }
}

#[test]
fn what_is_there_twice_is_told_each_time() {
    let text = "[tube]\nlength = 3.0\n[mesh]\ndegree = 3\ndegree = 2\n[[stages]]\ndrive.ileum.displacement = 0.1\n\
        [tube]\nlength = 4.0\n[output]\npictures = true\npictures = false\n[mesh]\n";
    let problems = read(text, "case").unwrap_err().problems;
    let lines = problems
        .iter()
        .map(|p| text[..p.span.clone().unwrap().start].matches('\n').count() + 1);
    assert_eq!(lines.collect::<Vec<_>>(), [5, 8, 12, 13], "{problems:?}");
}

#[test]
fn slips_of_toml_hide_nothing_where_the_keys_are_known() {
    for (text, told) in [
        ("[ends]\ncolon = fre\nileum = 'fixd'\n", &[2, 3][..]),
        ("ends = { colon = fre, ileum = fixd }\n", &[1, 1]),
        ("[output]\npictures\nharmonics = 'x'\n", &[2, 3]),
        ("[tube]\nlength\nthickness = 0.7\n", &[2, 3]),
        ("[tube]\nlength = -3\n[tube]\nthickness = 'x'\n", &[2, 3, 4]),
        ("[muscles.a]\ndirection\nzone = [2.0, 1.0]\n", &[2, 3]),
        (
            "[[imperfections]]\nof\namplitude = 'x'\nshape = { wave = { mode = 0 } }\n",
            &[2, 3],
        ),
        (
            "[mesh.control_points]\naxial = 2\naround = 12 34\n",
            &[2, 3],
        ),
    ] {
        let text = format!("{text}[[stages]]\ndrive.ileum.displacement = 0.1\nsteps = 0\n");
        let problems = read(&text, "case").unwrap_err().problems;
        let lines = problems
            .iter()
            .map(|p| text[..p.span.clone().unwrap().start].matches('\n').count() + 1);
        let last = text.lines().count();
        assert_eq!(
            lines.collect::<Vec<_>>(),
            [told, &[last]].concat(),
            "{text}{problems:?}"
        );
    }
}

#[test]
fn slips_of_every_kind_are_told_together() {
    let text = "\
        [tube]\nlenght = 5.0\n\
        [material.neo-hookean]\npoisson_ratio = 0.5\n\
        [muscles.a]\ndirection = 'circular'\nzone = [1.0, 0.5]\n\
        [muscles.b]\ndirection = 'circular'\nzone = 0.5\n\
        [muscles.c]\nzone = [0.0, 0.2]\n\
        [mesh]\ncontrol_points = { axial = 2, around = 'many' }\n\
        [[stages]]\ndrive.a.length_ratio = 1.5\ndrive.b.diameter_ratio = true\ndrive.c.length_ratio = 1.5\n\
        drive.d.diameter_ratio = 0.5\n\
        [solver]\nhalvings = 0.5\npseudo_time = { damping = 1.0 }\n";
    let problems = read(text, "case").unwrap_err().problems;
    let keys: Vec<&str> = problems.iter().map(|p| p.key.as_str()).collect();
    let expected = [
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
    ];
    assert_eq!(keys, expected);
    // The same where one value cannot be read.
    let broken = format!("title = none\n{text}");
    let problems = read(&broken, "case").unwrap_err().problems;
    let keys: Vec<&str> = problems.iter().map(|p| p.key.as_str()).collect();
    assert_eq!(keys, [&[""], &expected[..]].concat());
}

#[test]
fn names_with_dots_are_names() {
    let text = "'tube.length' = 1\n'' = 2\n[tube]\nlength = 0.5\n[muscles.'a.b']\ndirection = 'circular'\nzone = [1, 2]\n[[stages]]\ndrive.ileum.displacement = 0.1\n";
    let problems = read(text, "case").unwrap_err().problems;
    let told: Vec<(&str, &str)> = problems
        .iter()
        .map(|p| (p.key.as_str(), &text[p.span.clone().unwrap()]))
        .collect();
    let expected = [
        ("\"tube.length\"", "'tube.length'"),
        ("\"\"", "''"),
        ("muscles.\"a.b\"", "'a.b'"),
        ("muscles.\"a.b\".zone", "[1, 2]"),
    ];
    assert_eq!(told, expected);
}

#[test]
fn where_keys_are_lost_the_others_are_held_against_the_table() {
    let text = "title = ' '\n[tube\nlength = 3.0\n[mesh]\n[[stages]]\nsteps = 0\n";
    let problems = read(text, "case").unwrap_err().problems;
    let keys: Vec<&str> = problems.iter().map(|p| p.key.as_str()).collect();
    assert_eq!(keys, ["title", "", "stages[1].steps"]);
}

#[test]
fn bare_words_are_told_what_they_should_be() {
    for (word, cure) in [
        ("thick", Some("write \"thick\" if it is a text")),
        ("none", None),
        ("1/3", None),
        ("True", Some("write true")),
        ("NaN", None),
        ("fals", Some("write \"fals\" if it is a text")),
        ("3,500", None),
        ("3,5", Some("write the number with a point")),
        (": 3.0", Some("write = for the colon")),
        (" : 3.0", Some("write = for the colon")),
        (":3.0", Some("write = for the colon")),
        (" in D = 3.0", Some("write length_in_D")),
        (" 3.0", Some("write = before the value")),
        ("3,", None),
    ] {
        let sign = if word.contains("3.0") { "" } else { " = " };
        let text =
            format!("[tube]\nlength{sign}{word}\n[[stages]]\ndrive.ileum.displacement = 0.1\n");
        let problems = read(&text, "case").unwrap_err().problems;
        assert_eq!(problems.len(), 1, "{word}: {problems:?}");
        assert_eq!(problems[0].cure.as_deref(), cure, "{word}");
    }
}

#[test]
fn something_can_stand_in_for_every_key_that_must_be_given() {
    for key in KEYS
        .iter()
        .filter(|key| matches!(key.given, Given::Always(_)))
    {
        let mut table = DeTable::new();
        stand_in::stand_in(&mut table, key);
        assert!(table.contains_key(key.name()), "{}", key.path);
        assert!(key.kind != Kind::Tables || key.path == "stages");
    }
}
