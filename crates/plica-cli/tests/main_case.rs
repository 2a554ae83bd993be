//! The paper's main case, from its case file to its run directory.

mod common;

use common::{compare, plica, root, scratch, tests, text};
use std::path::Path;

/// The rows of a `history.csv`, and what its columns are called.
struct History {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl History {
    fn read(run: &Path) -> Self {
        let table = std::fs::read_to_string(run.join("history.csv")).unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let mut lines = table.lines();
        let names: Vec<String> = cells(lines.next().unwrap());
        let rows: Vec<Vec<String>> = lines.map(cells).collect();
        assert!(rows.iter().all(|row| row.len() == names.len()));
        Self { names, rows }
    }

    fn words(&self, name: &str) -> Vec<&str> {
        let named = |column: &String| column == name;
        let column = self.names.iter().position(named).expect(name);
        self.rows.iter().map(|row| row[column].as_str()).collect()
    }

    fn numbers(&self, name: &str) -> Vec<f64> {
        let words = self.words(name);
        words.iter().map(|word| word.parse().unwrap()).collect()
    }

    /// The last state of a grown length.
    fn at(&self, length_ratio: f64) -> usize {
        let lengths = self.numbers("length_ratio");
        let near = |length: &f64| (length - length_ratio).abs() < 1e-9; // rounding
        lengths.iter().rposition(near).unwrap()
    }

    fn energy(&self, length_ratio: f64) -> f64 {
        self.numbers("energy")[self.at(length_ratio)]
    }
}

/// Lmax/L and W/(E D³) of an independent program on the paper's mesh.
const REFERENCE: [(f64, f64); 3] = [(1.0, 2.998736e-3), (1.1, 7.962128e-4), (1.13, 6.671367e-4)];

/// The last state before the snap: how the tube gets there is the same on every machine.
const BEFORE_THE_SNAP: f64 = 1.19;

/// Runs a case and reads what it left.
fn history(case: &str, threads: &str, run: &Path) -> History {
    let out = run.to_str().unwrap();
    let arguments = ["run", case, "--threads", threads, "--out", out];
    let said = plica(&root(), &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    History::read(run)
}

#[test]
fn the_small_case_invaginates_as_the_paper_says() {
    let [run, alone] = ["small", "small-alone"].map(|name| scratch(name).join("run"));
    let history_of_two = history("cases/small.toml", "2", &run);
    it_has_the_energies(&history_of_two);
    it_invaginates_to_the_colon(&history_of_two);
    it_is_in_equilibrium_and_tilts_before_it_snaps(&history_of_two);
    it_takes_the_same_way_as_before(&history_of_two);
    its_directory_is_complete(&run, history_of_two.rows.len());
    its_path_tilts_sideways_and_back(&run);
    let history_of_one = history("cases/small.toml", "1", &alone);
    they_are_equal_but_for_their_times(&history_of_two, &history_of_one);
}

fn it_has_the_energies(history: &History) {
    for (length_ratio, energy) in [
        (1.0, 3.0001e-3),
        (1.1, 7.9637e-4),
        (1.13, 6.6742e-4),
        (1.25, 1.5063e-3),
    ] {
        let found = history.energy(length_ratio);
        // Half a unit of the fifth digit.
        let off = (found / energy - 1.0).abs();
        assert!(off < 5e-5, "at {length_ratio}: {found:e}");
    }
    for (length_ratio, energy) in REFERENCE {
        // The small mesh is off by 0.05 %.
        let off = (history.energy(length_ratio) / energy - 1.0).abs();
        assert!(off < 2e-3, "at {length_ratio}: off by {off:e}");
    }
    let relaxing = history.at(1.0)..;
    let energies = &history.numbers("energy")[relaxing.clone()];
    let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(least, history.energy(1.13));
}

fn it_invaginates_to_the_colon(history: &History) {
    let angles = history.numbers("max_wall_angle_deg");
    let first = angles.iter().position(|&angle| angle >= 90.0).unwrap();
    assert!(
        [history.at(1.19), history.at(1.2)].contains(&first),
        "overhangs from state {first}"
    );
    assert_eq!(history.words("side").last(), Some(&"colon"));
    assert_eq!(history.words("shape").last(), Some(&"invaginated"));
}

fn it_is_in_equilibrium_and_tilts_before_it_snaps(history: &History) {
    assert!(history.numbers("residual").iter().all(|&r| r <= 1e-6));
    assert!(history.words("equilibrium").iter().all(|&e| e == "yes"));
    let unstable = history.words("unstable_modes");
    assert!(unstable.iter().any(|&harmonics| harmonics != "none"));
    for (state, harmonics) in unstable.into_iter().enumerate() {
        if harmonics != "none" {
            assert!((history.at(1.17)..=history.at(1.2)).contains(&state));
            for harmonic in harmonics.split(' ') {
                assert!(harmonic.starts_with("1:"), "state {state}: {harmonics}");
            }
        }
    }
}

/// Methods and solves, against `main_case.txt`. Rounding may cost a solve or save one: up to three
/// are as before. After the snap they may be anything, and are only printed.
fn it_takes_the_same_way_as_before(history: &History) {
    let golden = match std::env::var_os("PLICA_BLESS") {
        Some(_) => String::new(),
        None => std::fs::read_to_string(tests().join("main_case.txt")).unwrap_or_default(),
    };
    let mut page = String::from("state  Dmin/D  Lmax/L  method      solves\n");
    let mut before = golden.lines().skip(1);
    let [diameters, lengths] = ["diameter_ratio", "length_ratio"].map(|name| history.numbers(name));
    let methods = history.words("method");
    for (state, solves) in history.words("iterations").into_iter().enumerate() {
        let (diameter, length, method) = (diameters[state], lengths[state], methods[state]);
        let way = format!("{state:5}  {diameter:6.2}  {length:6.2}  {method:10}");
        let line = format!("{way}  {solves:>6}");
        let same = |before: &str| {
            let number = |solves: &str| solves.trim().parse::<i64>().unwrap();
            let solves_before = before.strip_prefix(way.as_str()).map(number);
            solves_before.is_some_and(|before| (before - number(solves)).abs() <= 3)
        };
        page += match before.next() {
            Some(before) if length > BEFORE_THE_SNAP + 1e-9 => {
                println!("was {before}\nis  {line}");
                before
            }
            Some(before) if same(before) => before,
            _ => &line,
        };
        page += "\n";
    }
    compare("main_case.txt", &page);
}

fn its_directory_is_complete(run: &Path, states: usize) {
    let manifest = std::fs::read_to_string(run.join("manifest.json")).unwrap();
    assert!(manifest.contains("\"verdict\": \"complete\""), "{manifest}");
    for state in 0..states {
        let name = format!("profiles/state-{state:04}.csv");
        let profile = std::fs::read_to_string(run.join(&name)).unwrap();
        assert!(profile.lines().count() > 100, "{name}");
        for number in profile.lines().skip(1).flat_map(|line| line.split(',')) {
            assert!(number.parse::<f64>().unwrap().is_finite(), "{name}");
        }
    }
    let saved = |state| format!("states/state-{state:04}.safetensors");
    for state in (0..states).map(saved) {
        let state = plica::study::SavedState::read(&run.join(state)).unwrap();
        assert_eq!(state.u.len(), 100 * 5 * 3);
    }
    for picture in ["energy.png", "walls.png", "tube.png"] {
        let bytes = std::fs::read(run.join(picture)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{picture}");
    }
}

/// As on the paper's mesh: lost between 1.17 and 1.18, regained near 1.20.
fn its_path_tilts_sideways_and_back(run: &Path) {
    let said = plica(
        &root(),
        &["stability", run.to_str().unwrap(), "--tolerance", "1e-3"],
    );
    assert!(said.status.success(), "{}", text(&said.stderr));
    let table = std::fs::read_to_string(run.join("stability.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 1 + 2, "{table}");
    for (row, change, between) in [(1, "lost", 1.17..1.18), (2, "regained", 1.19..1.21)] {
        assert_eq!([rows[row][2], rows[row][4]], ["1", change], "{table}");
        assert!(
            between.contains(&rows[row][6].parse::<f64>().unwrap()),
            "{table}"
        );
    }
}

fn they_are_equal_but_for_their_times(one: &History, other: &History) {
    assert_eq!(one.names, other.names);
    for name in one.names.iter().filter(|&name| name != "seconds") {
        assert_eq!(one.words(name), other.words(name), "{name}");
    }
}

#[test]
fn the_paper_s_mesh_has_the_energies_of_an_independent_program() {
    let case = std::fs::read_to_string(root().join("cases/invagination.toml")).unwrap();
    let (steps, length) = ("steps = 25", "length_ratio = 1.25");
    assert!(case.contains(steps) && case.contains(length));
    let cut = case
        .replace(steps, "steps = 13")
        .replace(length, "length_ratio = 1.13");
    let directory = scratch("paper");
    let path = directory.join("cut.toml");
    std::fs::write(&path, cut + "\n[output]\npictures = false\n").unwrap();
    let history = history(path.to_str().unwrap(), "2", &directory.join("run"));
    for (length_ratio, energy) in REFERENCE {
        // Off by 1.5e-5 at most.
        let off = (history.energy(length_ratio) / energy - 1.0).abs();
        assert!(off < 1e-4, "at {length_ratio}: off by {off:e}");
    }
}
