//! The table of keys, the structs, the checker and the page say the same.

use super::keys::{Given, Kind, Limit};
use super::spec::*;
use super::*;
use crate::saved_state::{Array, Layout};
use crate::tube;
use std::collections::BTreeMap;
use std::path::Path;
use toml::{Table, Value};

/// A case in which every table that a key may stand in is there.
const BASE: &str = r#"
    [muscles.circular]
    direction = "circular"
    zone = [0.5, 1.0]
    [[stages]]
    [[stages]]
    drive.colon.displacement = 0.1
"#;

fn base(key: &Key) -> Table {
    let mut text = BASE.to_owned();
    if key.path.starts_with("solver.pseudo_time") {
        text += "[solver]\nscheme = 'newmark'\n";
    }
    if key.path.starts_with("units.") {
        text += "[units]\nlength = 'mm'\nstress = 'kPa'\n";
    }
    if key.path.starts_with("mesh.refine[]") {
        text += "[[mesh.refine]]\nzone = [0.5, 1.0]\n";
    }
    if key.path.starts_with("imperfections[]") {
        let shape = match key.path {
            "imperfections[].shape.mode" => "mode = 'mode'",
            path if path.contains(".random") => "random = { seed = 1 }",
            _ => "wave = { mode = 2 }",
        };
        let of = match key.path {
            "imperfections[].direction" => "'colon-end'",
            "imperfections[].shape.mode" => "'geometry'",
            _ => "{ muscle = 'circular' }",
        };
        text = format!("symmetry = 'none'\n{text}")
            + &format!("[[imperfections]]\nof = {of}\namplitude = 1e-4\nshape = {{ {shape} }}\n");
    }
    if key.path.ends_with(".length_ratio") {
        text = text.replace("\"circular\"", "\"longitudinal\"");
    }
    text.parse().unwrap()
}

/// The path of a key in the base case: the first member, the first name.
fn path_in_base(key: &Key) -> String {
    let ends = key.path.ends_with(".displacement") || key.path.ends_with(".twist_degrees");
    let name = match () {
        () if ends => "colon",
        () if key.path.ends_with("pressure") => "inner-wall",
        () => "circular",
    };
    key.path.replace("[]", "[1]").replace("<name>", name)
}

/// Puts a mark into a case, where a value will be written.
fn put_mark(case: &mut Table, path: &str) {
    let (tables, last) = path.rsplit_once('.').unwrap_or(("", path));
    let mut at = case;
    for step in tables.split('.').filter(|step| !step.is_empty()) {
        let (name, member) = match step.split_once('[') {
            Some((name, n)) => (name, n.trim_end_matches(']').parse::<usize>().ok()),
            None => (step, None),
        };
        let empty = || Value::Table(Table::new());
        let next = at.entry(name).or_insert_with(empty);
        let next = match member {
            Some(n) => &mut next.as_array_mut().unwrap()[n - 1],
            None => next,
        };
        if next.is_str() {
            *next = empty(); // a table in place of a word
        }
        at = next.as_table_mut().unwrap();
    }
    at.insert(last.to_owned(), Value::String(MARK.into()));
}

const MARK: &str = "@";

fn read_with(key: &Key, literal: &str) -> Result<Plan, CaseError> {
    let mut case = base(key);
    put_mark(&mut case, &path_in_base(key));
    let marked = toml::to_string(&case).unwrap();
    super::read_with(
        &marked.replace(&format!("\"{MARK}\""), literal),
        "case",
        &|_| Ok(state()),
    )
}

/// A state of the usual tube at rest, and an oval mode of it.
fn state() -> SavedState {
    let layout = Layout {
        length: 3.0,
        thickness: 0.06,
        mesh: tube::Mesh {
            axial: 4,
            around: 8,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            volumetric: Default::default(),
        },
        rings: 1,
    };
    SavedState {
        stage: "rest".into(),
        row: 0,
        along: 0.0,
        muscles: vec![],
        load: tube::Load {
            muscles: vec![],
            ends: Default::default(),
            pressures: Default::default(),
        },
        u: vec![0.0; layout.unknowns()],
        layout,
        arrays: [("mode", vec![4, 4, 3], 48), ("harmonic", vec![], 1)]
            .map(|(name, shape, count)| (name.to_owned(), (shape, count)))
            .map(|(name, (shape, count))| {
                let values = vec![if count == 1 { 2.0 } else { 1.0 }; count];
                (name, Array { shape, values })
            })
            .into(),
    }
}

#[test]
fn every_key_of_the_table_is_read() {
    for key in KEYS {
        if let Err(error) = read_with(key, key.example()) {
            panic!("{} = {}: {error}", key.path, key.example());
        }
    }
}

#[test]
fn the_defaults_of_the_table_are_those_of_a_case_that_leaves_them_out() {
    for key in KEYS {
        let default = match key.given {
            Given::Or(default) => default,
            Given::OrElse(words, default) if !words.is_empty() => default,
            _ => continue,
        };
        let without = read(&toml::to_string(&base(key)).unwrap(), "case");
        let with = read_with(key, default);
        assert_eq!(with.unwrap(), without.unwrap(), "{}", key.path);
    }
}

#[test]
fn every_field_of_the_structs_is_in_the_table() {
    // No `..Default::default()`: a new field must be added here, and so to the table.
    let muscle = |profile| Muscle {
        direction: Direction::Circular,
        zone: [0.5, 1.0],
        profile,
    };
    let drive = Drive {
        diameter_ratio: Some(1.0),
        length_ratio: Some(1.0),
        displacement: Some(0.0),
        twist_degrees: Some(0.0),
        pressure: Some(0.0),
        dead_load: Some(0.0),
    };
    let spec = Spec {
        title: Some("t".into()),
        symmetry: Symmetry::Fold(2),
        units: Some(Units {
            length: "mm".into(),
            stress: "kPa".into(),
        }),
        tube: Tube {
            diameter: 1.0,
            length: Some(3.0),
            thickness: Some(0.06),
        },
        material: Material::NeoHookean(NeoHookean {
            youngs_modulus: 1.0,
            poisson_ratio: 0.3,
            volumetric: Volumetric::Quadratic,
        }),
        muscles: BTreeMap::from([
            (
                "a".into(),
                muscle(Profile::SmoothBox(SmoothBox { edge: 0.1 })),
            ),
            ("b".into(), muscle(Profile::Table(vec![[0.0, 1.0]]))),
            ("c".into(), muscle(Profile::HalfSine)),
        ]),
        ends: Ends {
            colon: Support::Fixed,
            ileum: Support::Free,
        },
        mesh: Mesh {
            control_points: ControlPoints {
                axial: 1,
                around: 2,
                thickness: 3,
            },
            degree: 3,
            volumetric_integration: Integration::Reduced,
            refine: Some(vec![Refine {
                zone: [0.0, 1.0],
                factor: 2.0,
            }]),
        },
        start: Some(Start {
            state: String::new(),
        }),
        stages: vec![Stage {
            name: Some("s".into()),
            steps: 1,
            drive: BTreeMap::from([("a".into(), drive)]),
        }],
        imperfections: vec![
            Imperfection {
                of: Part::Muscle("a".into()),
                amplitude: 0.1,
                direction: Some(Push::Axial),
                shape: Shape::Wave(Wave {
                    mode: 1,
                    phase_degrees: 0.0,
                    axial: Some(Axial::Zone([0.0, 1.0])),
                }),
            },
            Imperfection {
                of: Part::ColonEnd,
                amplitude: 0.1,
                direction: None,
                shape: Shape::Wave(Wave {
                    mode: 1,
                    phase_degrees: 0.0,
                    axial: Some(Axial::Uniform),
                }),
            },
            Imperfection {
                of: Part::Geometry,
                amplitude: 0.1,
                direction: None,
                shape: Shape::Random(Random {
                    seed: 1,
                    modes: Some(2),
                    half_waves: Some(3),
                }),
            },
            Imperfection {
                of: Part::Geometry,
                amplitude: 0.1,
                direction: None,
                shape: Shape::Mode(String::new()),
            },
        ],
        solver: Solver {
            scheme: Scheme::BackwardEuler,
            tolerance: 1e-8,
            newton_iterations: 1,
            relaxation_steps: 1,
            relaxation_damping: 1.0,
            max_step_halvings: 1,
            pseudo_time: Some(PseudoTime {
                damping: Some(1.0),
                ramp: 1,
                tolerance: 1.0,
                max_steps: 1,
                equilibrate: true,
            }),
        },
        output: Output {
            pictures: true,
            profiles_every: 1,
            states_every: 3,
            stability_modes: 1,
            wall_points: 1,
        },
    };
    let mut written = Vec::new();
    leaves(
        "",
        &Value::Table(Table::try_from(&spec).unwrap()),
        &mut written,
    );
    for path in &written {
        assert!(
            KEYS.iter().any(|key| key.path == path),
            "{path} is not in the table"
        );
    }
    for key in KEYS {
        let listed = matches!(key.kind, Kind::Tables | Kind::Choice) || key.path == "symmetry";
        assert!(
            listed || written.iter().any(|path| path == key.path),
            "{}",
            key.path
        );
    }
}

/// The paths of all values, with `<name>` and `[]`.
fn leaves(path: &str, value: &Value, found: &mut Vec<String>) {
    let named = path == "muscles" || path.ends_with(".drive");
    match value {
        Value::Table(table) => {
            for (name, value) in table {
                let name = if named { "<name>" } else { name };
                leaves(&keys::join(path, name), value, found);
            }
        }
        Value::Array(list) if list.iter().any(Value::is_table) => {
            for member in list {
                leaves(&format!("{path}[]"), member, found);
            }
        }
        _ => found.push(path.to_owned()),
    }
}

#[test]
fn ranges_end_where_the_table_says() {
    for key in KEYS {
        let count = key.kind == Kind::Count;
        for (limit, outwards) in [(key.range.low, -1.0), (key.range.high, 1.0)] {
            let next = |x: f64, way: f64| match count {
                true => x + way,
                false if way < 0.0 => x.next_down(),
                false => x.next_up(),
            };
            let (inside, outside) = match limit {
                Limit::None => continue,
                Limit::At(x) => (x, next(x, outwards)),
                Limit::Beyond(x) => (next(x, -outwards), x),
            };
            let literal = |x: f64| {
                if count {
                    format!("{x}")
                } else {
                    format!("{x:?}")
                }
            };
            let rule = key.range.broken_by(outside).unwrap();
            let breaks = |x: f64| {
                let found = read_with(key, &literal(x)).err();
                let problems = found.map_or(vec![], |error| error.problems);
                let mut rules = problems.iter().filter(|p| p.key == path_in_base(key));
                rules.any(|p| p.rule == rule)
            };
            assert!(breaks(outside), "{} = {}", key.path, literal(outside));
            assert!(!breaks(inside), "{} = {}", key.path, literal(inside));
        }
        if key.kind == Kind::Number {
            for strange in ["nan", "inf", "-inf"] {
                assert!(read_with(key, strange).is_err(), "{} = {strange}", key.path);
            }
        }
    }
}

#[test]
fn nothing_that_can_be_written_makes_the_reader_panic() {
    let odd = [
        "nan",
        "-1",
        "0",
        "1e300",
        "5e-324",
        "99999999999999999999",
        "-9223372036854775808",
        "\"x\"",
        "\"\"",
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
    for key in KEYS {
        for literal in odd {
            let _ = read_with(key, literal);
        }
    }
    for end in (0..STARTER.len()).filter(|&end| STARTER.is_char_boundary(end)) {
        let _ = read(&STARTER[..end], "case");
        let _ = read(&STARTER[end..], "case");
    }
    for name in ["'a.b'", "''", "'stages[1]'", "'[0]'", "\"\\u001b\"", "'ä'"] {
        let _ = read(&BASE.replace("circular]", &format!("{name}]")), "case");
        let _ = read(
            &BASE.replace("drive.colon", &format!("drive.{name}")),
            "case",
        );
    }
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn the_reference_page_is_the_table() {
    let page = root().join("docs/case-file.md");
    if std::env::var_os("PLICA_BLESS").is_some() {
        std::fs::write(&page, reference()).unwrap();
    }
    let written = std::fs::read_to_string(page).unwrap_or_default();
    assert!(
        written == reference(),
        "docs/case-file.md is old; PLICA_BLESS=1 cargo test rewrites it"
    );
}

#[test]
fn all_cases_are_read_and_mean_the_same_tube() {
    let mut plans = BTreeMap::new();
    for entry in std::fs::read_dir(root().join("cases")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let plan = read(&std::fs::read_to_string(&path).unwrap(), &name);
        plans.insert(name.clone(), plan.unwrap_or_else(|e| panic!("{name}: {e}")));
    }
    let (main, mm) = (&plans["invagination"], &plans["millimetres"]);
    assert_eq!((&main.tube, &main.mesh), (&mm.tube, &mm.mesh));
    assert_eq!(main.stages, mm.stages);
    assert_eq!(mm.units.as_ref().unwrap().diameter, 25.0);
    assert_eq!(main.tube, plans["paper-scheme"].tube);

    let starter = read(STARTER, "starter").unwrap();
    assert_eq!((&main.tube, &main.mesh), (&starter.tube, &starter.mesh));
}

#[test]
fn a_case_means_what_it_says() {
    let text = "symmetry = { fold = 4 }\n\
        [tube]\ndiameter = 2.0\nlength = 5.0\n\
        [ends]\nileum = 'sliding'\n\
        [muscles.m]\ndirection = 'longitudinal'\nzone = [1.0, 3.0]\n\
        profile = { smooth-box = { edge = 0.25 } }\n\
        [[stages]]\ndrive.m.length_ratio = 1.25\ndrive.colon.twist_degrees = 180\n\
        [[stages]]\nname = 'push'\nsteps = 3\ndrive.ileum.displacement = -0.5\n\
        [solver]\nscheme = 'dragged'\n";
    let plan = read(text, "named").unwrap();
    assert_eq!((plan.title.as_str(), plan.tube.length), ("named", 2.5));
    assert_eq!(
        (plan.tube.thickness, plan.tube.muscles[0].zone),
        (0.06, [0.5, 1.5])
    );
    assert_eq!(plan.mesh.rings(plan.symmetry), 15);
    // Elements end at the kinks of the profile.
    let edges: Vec<f64> = plan.mesh.refinements.iter().map(|r| r.to).collect();
    assert_eq!(edges, [0.75, 1.25, 1.5]);

    let names: Vec<&str> = plan.stages.iter().map(|s| s.name.as_str()).collect();
    assert_eq!((names, plan.stages[1].steps), (vec!["stage-1", "push"], 3));
    // What a stage does not name stays.
    let load = &plan.stages[1].load;
    assert_eq!(
        (load.muscles[0], load.ends[0].twist),
        (1.25, std::f64::consts::PI)
    );
    assert_eq!(load.ends[1].displacement, -0.25);

    let crate::solve::Scheme::PseudoTime(scheme) = plan.solver.scheme else {
        panic!("{:?}", plan.solver.scheme)
    };
    assert_eq!(scheme.integrator, crate::solve::Integrator::BackwardEuler);
    assert_eq!(
        (scheme.damping, scheme.ramp, scheme.equilibrate),
        (5.0, 10, true)
    );
}

#[test]
fn slips_are_found_all_at_once_and_in_the_order_of_the_text() {
    let text = "[tube]\nthickness = 0.6\n[material.neo-hookean]\npoisson_ratio = 0.5\n\
                [muscles.m]\ndirection = 'circular'\nzone = [2.0, 4.0]\n\
                [[stages]]\nsteps = 0\ndrive.m.diameter_ratio = nan";
    let problems = read(text, "case").unwrap_err().problems;
    let keys: Vec<&str> = problems.iter().map(|p| p.key.as_str()).collect();
    let expected = [
        "tube.thickness",
        "material.neo-hookean.poisson_ratio",
        "muscles.m.zone",
        "stages[1].steps",
        "stages[1].drive.m.diameter_ratio",
    ];
    assert_eq!(keys, expected);
    assert_eq!(
        problems[1].to_string(),
        "material.neo-hookean.poisson_ratio = 0.5: must be below 0.5 (the law is compressible); try 0.495"
    );
    assert_eq!(&text[problems[2].span.clone().unwrap()], "[2.0, 4.0]");
}
