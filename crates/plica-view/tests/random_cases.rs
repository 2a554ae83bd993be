//! Random valid cases: each run completes or ends with a reason, and its output contains only finite numbers.
//!
//! `PLICA_RANDOM_CASES=2000 cargo test --release -p plica-view --test random_cases` runs more cases than by default.

use plica::case;
use plica::monitor::Monitor;
use plica::run_directory::{self, RunDirectory, RunError, Verdict};
use plica::saved_state::SavedState;
use plica::solve::Method;
use plica::study::{Ending, Plan, Row};
use plica_view::export::{Exporter, Geometry};
use std::fmt::Display;
use std::fmt::Write;
use std::io::Read;
use std::path::Path;

/// Default number of cases.
const COUNT: usize = 25;
/// Number of solves after which a run is cancelled.
const MAX_SOLVES: usize = 100;

/// Deterministic random numbers (xorshift); the seed must not be 0.
struct Random(u64);

impl Random {
    /// Returns a number from 0 to n − 1.
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.below(words.len())]
    }

    /// Returns a number between `low` and `high` with three decimals.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let x = low + (high - low) * self.below(1001) as f64 / 1000.0;
        (1000.0 * x).round() / 1000.0
    }
}

/// Returns a case in which every value is valid by itself; occasionally the combination is not.
fn random_case(chance: &mut Random) -> String {
    let mut case = String::new();
    let around = 4 * (2 + chance.below(3));
    let fold = chance.of(&["1", "1", "2", "none"]);
    match fold {
        "none" => case += "symmetry = \"none\"\n",
        "2" => case += "symmetry = { fold = 2 }\n",
        _ => {}
    }
    let degree = 1 + chance.below(3);
    let (length, thickness) = (chance.between(0.5, 4.0), chance.between(0.01, 0.3));
    let mut add = |text: std::fmt::Arguments<'_>| case.write_fmt(text).unwrap();
    if chance.one_in(4) {
        add(format_args!("[units]\nlength = \"mm\"\nstress = \"kPa\"\n"));
    }
    add(format_args!(
        "[tube]\nlength = {length}\nthickness = {thickness}\n"
    ));
    add(format_args!(
        "[material.neo-hookean]\npoisson_ratio = {}\nvolumetric = \"{}\"\n",
        chance.of(&["0.0", "0.3", "0.45", "0.495", "0.4999"]),
        chance.of(&["logarithmic", "quadratic"])
    ));
    let mut muscles = vec![];
    for (name, direction) in [("ring", "circular"), ("band", "longitudinal")] {
        if chance.one_in(3) && (name == "band" || !muscles.is_empty()) {
            continue;
        }
        let from = chance.between(0.0, 0.6 * length);
        let to = chance.between(from + 0.1 * length, length);
        add(format_args!(
            "[muscles.{name}]\ndirection = \"{direction}\"\nzone = [{from}, {to}]\nprofile = {}\n",
            chance.of(&[
                "\"raised-cosine\"",
                "\"half-sine\"",
                "{ smooth-box = { edge = 0.3 } }",
                "{ table = [[0.0, 0.0], [0.3, 1.0], [1.0, 0.2]] }"
            ])
        ));
        muscles.push(name);
    }
    let ends = [0, 1].map(|_| chance.of(&["fixed", "fixed", "sliding", "free"]));
    add(format_args!(
        "[ends]\ncolon = \"{}\"\nileum = \"{}\"\n",
        ends[0], ends[1]
    ));
    add(format_args!(
        "[mesh]\ndegree = {degree}\ncontrol_points = {{ axial = {}, around = {around}, thickness = {} }}\nvolumetric_integration = \"{}\"\n",
        degree + 4 + chance.below(12),
        degree + 1 + chance.below(2),
        chance.of(&["full", "full", "reduced"]),
    ));
    if chance.one_in(3) {
        add(format_args!("refine = []\n"));
    }
    for _ in 0..chance.below(3) {
        let of = chance.of(&["\"geometry\"", "\"colon-end\"", "{ muscle = \"ring\" }"]);
        let shape = match (of, fold) {
            ("\"geometry\"", _) => "{ random = { seed = 7 } }",
            (_, "none") => "{ wave = { mode = 1 } }",
            (_, "2") => "{ wave = { mode = 2 } }",
            _ => "{ wave = { mode = 0 } }",
        };
        let amplitude =
            chance.between(0.0, 0.2) * if of.starts_with('{') { 1.0 } else { thickness };
        add(format_args!(
            "[[imperfections]]\nof = {of}\namplitude = {amplitude}\nshape = {shape}\n"
        ));
    }
    for _ in 0..1 + chance.below(2) {
        add(format_args!(
            "[[stages]]\nsteps = {}\n",
            1 + chance.below(3)
        ));
        for muscle in &muscles {
            let (key, from, to) = match *muscle {
                "ring" => ("diameter_ratio", 0.2, 1.3),
                _ => ("length_ratio", 0.9, 1.5),
            };
            add(format_args!(
                "drive.{muscle}.{key} = {}\n",
                chance.between(from, to)
            ));
        }
        if chance.one_in(3) && ends[1] != "free" {
            add(format_args!(
                "drive.ileum.displacement = {}\n",
                chance.between(-0.2, 0.2) * length
            ));
        }
        if chance.one_in(4) && ends[0] == "fixed" {
            add(format_args!(
                "drive.colon.twist_degrees = {}\n",
                chance.between(-90.0, 90.0)
            ));
        }
        if chance.one_in(3) {
            let (wall, kind) = (
                chance.of(&["inner-wall", "outer-wall"]),
                chance.of(&["pressure", "dead_load"]),
            );
            add(format_args!(
                "drive.{wall}.{kind} = {}e-3\n",
                chance.between(0.0, 5.0)
            ));
        }
    }
    add(format_args!(
        "[solver]\nscheme = \"{}\"\nmax_step_halvings = {}\n[output]\npictures = false\nwall_points = 51\n",
        chance.of(&["static", "static", "static", "backward-euler", "newmark"]),
        chance.below(6)
    ));
    case
}

/// Cancels a run after a number of solves.
#[derive(Default)]
struct Limit {
    solves: usize,
}

impl Monitor for Limit {
    fn working(&mut self, _: &dyn Display, _: f64) {
        self.solves += 1;
        assert!(
            self.solves <= MAX_SOLVES + 1,
            "the run went on after it was cancelled"
        );
    }
    fn is_cancelled(&self) -> bool {
        self.solves >= MAX_SOLVES
    }
}

/// Checks the numbers of an accepted state.
fn check(row: &Row) {
    assert!(row.min_det_fe > 0.0);
    assert!(row.energy >= -1e-12, "{}", row.energy);
    assert!(!row.in_equilibrium || row.residual <= 1e-6 || row.method == Method::Rest);
}

/// Returns the floating-point numbers in a VTK file: compressed arrays after an XML header.
fn numbers(file: &[u8]) -> Vec<f64> {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = file.windows(mark.len()).position(|window| window == mark);
    let (header, data) = file.split_at(at.unwrap() + mark.len());
    let header = String::from_utf8_lossy(header);
    let attribute = |tag: &str, name: &str| -> Option<String> {
        let value = tag.split_once(&format!(" {name}=\""))?.1;
        Some(value.split_once('"')?.0.to_owned())
    };
    let mut found = vec![];
    for tag in header.split("<DataArray").skip(1) {
        let offset: usize = attribute(tag, "offset").unwrap().parse().unwrap();
        let length = |k: usize| {
            let bytes = data[offset + 8 * k..][..8].try_into().unwrap();
            u64::from_le_bytes(bytes) as usize
        };
        let (blocks, mut from) = (length(0), offset + 8 * (3 + length(0)));
        let mut bytes = vec![];
        for block in 0..blocks {
            let to = from + length(3 + block);
            let mut block = flate2::read::ZlibDecoder::new(&data[from..to]);
            block.read_to_end(&mut bytes).unwrap();
            from = to;
        }
        match attribute(tag, "type").unwrap().as_str() {
            "Float32" => {
                let words = bytes.chunks_exact(4);
                found.extend(words.map(|w| f64::from(f32::from_le_bytes(w.try_into().unwrap()))));
            }
            "Float64" => {
                let words = bytes.chunks_exact(8);
                found.extend(words.map(|w| f64::from_le_bytes(w.try_into().unwrap())));
            }
            _ => {}
        }
    }
    found
}

/// Runs a case, checks its output, and returns the ending.
fn run(plan: &Plan, text: &str, path: &Path) -> Ending {
    let mut directory = RunDirectory::create(path, text, "", true).unwrap();
    let summary = run_directory::run(plan, &mut directory, &mut Limit::default()).unwrap();
    summary.rows().iter().for_each(check);
    let rows = directory.history().unwrap_or_default();
    let states = directory.states().unwrap();
    assert_eq!(rows.len(), states.len());
    for name in ["history.csv", "manifest.json"] {
        let bytes = directory.read(name).unwrap_or_default();
        let text = String::from_utf8(bytes).unwrap().to_ascii_lowercase();
        let not_finite = text
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| ["nan", "inf"].contains(&word));
        assert!(!not_finite, "{name}: {text}");
    }
    if let (Some(row), Some(state)) = (rows.last(), states.last()) {
        let state = SavedState::read(state).unwrap();
        plan.accepts(&state).unwrap();
        // The volume of a tube without symmetry takes too long.
        let axisymmetric = plan.mesh.rings(plan.symmetry) == 1;
        for geometry in [Geometry::Walls, Geometry::Linear] {
            if geometry == Geometry::Linear && !axisymmetric {
                continue;
            }
            let numbers = numbers(&Exporter::new(plan).file(geometry, &state, row));
            // Three coordinates and 32 field components per point.
            assert!(numbers.len() > 1000, "{}", numbers.len());
            assert!(numbers.iter().all(|x| x.is_finite()));
        }
    }
    summary.ending().clone()
}

#[test]
fn random_cases_complete_or_end_with_a_reason() {
    let count = std::env::var("PLICA_RANDOM_CASES").ok();
    let count = count.and_then(|text| text.parse().ok()).unwrap_or(COUNT);
    let path = std::env::temp_dir().join(format!("plica-random-{}", std::process::id()));
    let mut ended = [0; 3];
    let (mut seed, mut refused) = (0, 0);
    while ended.iter().sum::<usize>() < count {
        seed += 1;
        let mut chance = Random(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed));
        let text = random_case(&mut chance);
        let plan = match case::read(&text, "random") {
            Ok(plan) => plan,
            Err(error) => {
                // The combination of values is invalid.
                assert!(
                    error
                        .problems
                        .iter()
                        .all(|problem| !problem.rule.is_empty())
                );
                refused += 1;
                assert!(refused < count, "{refused}");
                continue;
            }
        };
        let running = std::panic::AssertUnwindSafe(|| run(&plan, &text, &path));
        match std::panic::catch_unwind(running) {
            Ok(Ending::Complete) => ended[0] += 1,
            Ok(Ending::Lost(lost)) => {
                assert!(!lost.error.attempts.is_empty());
                ended[1] += 1;
            }
            Ok(Ending::Stopped) => ended[2] += 1,
            Err(_) => panic!("seed {seed}:\n{text}"),
        }
    }
    std::fs::remove_dir_all(path).unwrap();
    println!("complete, lost, stopped: {ended:?}; {refused} invalid");
    assert!(3 * ended[0] > count, "{ended:?}");
}

/// A NaN in the units makes every number of the history NaN.
#[test]
fn a_nan_in_the_history_ends_the_run() {
    let case = "[mesh]\ncontrol_points = { axial = 5, around = 8, thickness = 4 }\n[units]\nlength = 'mm'\nstress = 'kPa'\n\
        [muscles.circular]\ndirection = 'circular'\nzone = [1.0, 2.0]\n[[stages]]\nsteps = 2\ndrive.circular.diameter_ratio = 0.95\n";
    let mut plan = case::read(case, "nan").unwrap();
    plan.units.as_mut().unwrap().diameter = f64::NAN;
    let path = std::env::temp_dir().join(format!("plica-nan-{}", std::process::id()));
    let mut directory = RunDirectory::create(&path, case, "", true).unwrap();
    let ended = run_directory::run(&plan, &mut directory, &mut Limit::default());
    assert!(matches!(ended, Err(RunError::NotFinite { .. })));
    assert_eq!(directory.verdict(), Verdict::Lost);
    let manifest = std::fs::read_to_string(path.join("manifest.json")).unwrap();
    assert!(
        manifest.contains("NaN") && manifest.contains("of row 0"),
        "{manifest}"
    );
    std::fs::remove_dir_all(path).unwrap();
}
