//! Random cases that are sound: they run to their end, or end with a reason that has a name, and nothing that they leave is odd.
//!
//! Cases come from a seed. Among the other tests they are few; `PLICA_SOUND_CASES=2000 cargo test --release -p plica --test sound`
//! runs more.

mod common;

use common::Chance;
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

/// Cases among the other tests.
const FEW: usize = 25;
/// After so many solves a run is asked to stop, and does.
const MANY: usize = 100;

impl Chance {
    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.below(words.len())]
    }

    /// Between two numbers, with three digits.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let x = low + (high - low) * self.below(1001) as f64 / 1000.0;
        (1000.0 * x).round() / 1000.0
    }
}

/// A case whose values are each within their range; now and then they do not go together.
fn random(chance: &mut Chance) -> String {
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

/// Counts what takes time, from solve to solve.
#[derive(Default)]
struct Patience {
    solves: usize,
}

impl Monitor for Patience {
    fn working(&mut self, _: &dyn Display, _: f64) {
        self.solves += 1;
        assert!(
            self.solves <= MANY + 1,
            "the run went on after it was cancelled"
        );
    }
    fn is_cancelled(&self) -> bool {
        self.solves >= MANY
    }
}

/// Checks the numbers of an accepted state.
fn check(row: &Row) {
    assert!(row.min_det_fe > 0.0);
    assert!(row.energy >= -1e-12, "{}", row.energy);
    assert!(!row.in_equilibrium || row.residual <= 1e-6 || row.method == Method::Rest);
}

/// The floating-point numbers in a file of VTK as Plica writes it: columns in packed blocks, behind a head in XML.
fn numbers(file: &[u8]) -> Vec<f64> {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = file.windows(mark.len()).position(|window| window == mark);
    let (head, data) = file.split_at(at.unwrap() + mark.len());
    let head = String::from_utf8_lossy(head);
    let word = |tag: &str, name: &str| -> Option<String> {
        let value = tag.split_once(&format!(" {name}=\""))?.1;
        Some(value.split_once('"')?.0.to_owned())
    };
    let mut found = vec![];
    for tag in head.split("<DataArray").skip(1) {
        let offset: usize = word(tag, "offset").unwrap().parse().unwrap();
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
        match word(tag, "type").unwrap().as_str() {
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

/// Runs a case and looks at what it leaves; how it ended.
fn run(plan: &Plan, text: &str, path: &Path) -> Ending {
    let mut directory = RunDirectory::create(path, text, "", true).unwrap();
    let summary = run_directory::run(plan, &mut directory, &mut Patience::default()).unwrap();
    summary.rows().iter().for_each(check);
    let rows = directory.history().unwrap_or_default();
    let states = directory.states().unwrap();
    assert_eq!(rows.len(), states.len());
    for name in ["history.csv", "manifest.json"] {
        let bytes = directory.read(name).unwrap_or_default();
        let text = String::from_utf8(bytes).unwrap().to_ascii_lowercase();
        let odd = text
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| ["nan", "inf"].contains(&word));
        assert!(!odd, "{name}: {text}");
    }
    if let (Some(row), Some(state)) = (rows.last(), states.last()) {
        let state = SavedState::read(state).unwrap();
        plan.accepts(&state).unwrap();
        // The inside of a whole tube that is not round takes too long.
        let round = plan.mesh.rings(plan.symmetry) == 1;
        for what in [Geometry::Walls, Geometry::Linear] {
            if what == Geometry::Linear && !round {
                continue;
            }
            let numbers = numbers(&Exporter::new(plan).file(what, &state, row));
            // Three coordinates and 32 fields of every point.
            assert!(numbers.len() > 1000, "{}", numbers.len());
            assert!(numbers.iter().all(|x| x.is_finite()));
        }
    }
    summary.ending().clone()
}

#[test]
fn sound_cases_run_or_end_with_a_reason() {
    let count = std::env::var("PLICA_SOUND_CASES").ok();
    let count = count.and_then(|text| text.parse().ok()).unwrap_or(FEW);
    let path = std::env::temp_dir().join(format!("plica-sound-{}", std::process::id()));
    let mut ended = [0; 3];
    let (mut seed, mut refused) = (0, 0);
    while ended.iter().sum::<usize>() < count {
        seed += 1;
        let mut chance = Chance(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed));
        let text = random(&mut chance);
        let plan = match case::read(&text, "random") {
            Ok(plan) => plan,
            Err(error) => {
                // Told by its key and line; most do go together.
                assert!(
                    error
                        .problems
                        .iter()
                        .all(|problem| !problem.rule.is_empty())
                );
                refused += 1;
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
    println!("complete, lost, stopped: {ended:?}; {refused} did not go together");
    assert!(refused < count, "{refused}");
    assert!(3 * ended[0] > count, "{ended:?}");
}

/// A scale that is none makes every number of a table so.
#[test]
fn a_number_that_is_none_ends_a_run_as_lost() {
    let case = "[mesh]\ncontrol_points = { axial = 5, around = 8, thickness = 4 }\n[units]\nlength = 'mm'\nstress = 'kPa'\n\
        [muscles.circular]\ndirection = 'circular'\nzone = [1.0, 2.0]\n[[stages]]\nsteps = 2\ndrive.circular.diameter_ratio = 0.95\n";
    let mut plan = case::read(case, "none").unwrap();
    plan.units.as_mut().unwrap().diameter = f64::NAN;
    let path = std::env::temp_dir().join(format!("plica-none-{}", std::process::id()));
    let mut directory = RunDirectory::create(&path, case, "", true).unwrap();
    let ended = run_directory::run(&plan, &mut directory, &mut Patience::default());
    assert!(matches!(ended, Err(RunError::NotFinite { .. })));
    assert_eq!(directory.verdict(), Verdict::Lost);
    let manifest = std::fs::read_to_string(path.join("manifest.json")).unwrap();
    assert!(
        manifest.contains("NaN") && manifest.contains("of row 0"),
        "{manifest}"
    );
    std::fs::remove_dir_all(path).unwrap();
}
