//! Cases whose geometry has the shape of a mode.

mod common;

use common::{compare, plica, text};
use plica::study::SavedState;
use std::fs;
use std::path::{Path, PathBuf};

/// An empty directory of one test, with a place for cases.
fn scratch(name: &str) -> PathBuf {
    let path = common::scratch(name);
    fs::create_dir(path.join("cases")).unwrap();
    path
}

/// A tube relaxes on a coarse mesh, past where it turns oval.
const PERFECT: &str = "\
[muscles.long]
direction = \"longitudinal\"
zone = [0.5, 1.0]

[mesh]
control_points = { axial = 24, around = 16, thickness = 4 }

[output]
pictures = false

[[stages]]
name = \"relax\"
steps = 4
drive.long.length_ratio = 1.08
";

/// The same tube, imperfect in the shape of a mode.
fn imperfect(symmetry: &str, mode: &str) -> String {
    format!(
        "symmetry = {symmetry}\n{PERFECT}
[[imperfections]]
of = \"geometry\"
amplitude = 1e-4
shape = {{ mode = \"{mode}\" }}
"
    )
}

/// Runs a case of a name.
fn run(directory: &Path, name: &str, case: &str) {
    let file = format!("cases/{name}.toml");
    fs::write(directory.join(&file), case).unwrap();
    let said = plica(directory, &["run", &file, "--out", name, "-t", "2"]);
    assert!(said.status.success(), "{name}: {}", text(&said.stderr));
}

/// The perfect tube's mode of harmonic 2, saved as a mode of a harmonic and changed otherwise.
fn save(directory: &Path, name: &str, harmonic: f64, change: impl Fn(usize, &mut f64)) {
    let mut mode = SavedState::read(&directory.join(MODE)).unwrap();
    mode.arrays.get_mut("harmonic").unwrap().values = vec![harmonic];
    let values = &mut mode.arrays.get_mut("mode").unwrap().values;
    values
        .iter_mut()
        .enumerate()
        .for_each(|(i, x)| change(i, x));
    fs::write(directory.join("cases").join(name), mode.to_bytes().unwrap()).unwrap();
}

const MODE: &str = "perfect/modes/mode-01-harmonic-2.safetensors";

/// A directory with a run of the perfect tube and its modes.
fn tested(name: &str) -> PathBuf {
    let directory = scratch(name);
    run(&directory, "perfect", PERFECT);
    let said = plica(&directory, &["stability", "perfect", "--harmonics", "2"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert!(directory.join(MODE).exists(), "{}", text(&said.stdout));
    directory
}

/// The numbers of a column of a history.
fn numbers(run: &Path, name: &str) -> Vec<f64> {
    let table = fs::read_to_string(run.join("history.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let at = lines
        .next()
        .unwrap()
        .iter()
        .position(|n| *n == name)
        .unwrap();
    lines.map(|cells| cells[at].parse().unwrap()).collect()
}

#[test]
fn a_tube_that_has_the_shape_of_its_mode_leaves_its_path_in_it() {
    let directory = tested("modes-oval");
    let case = imperfect("{ fold = 2 }", &format!("../{MODE}"));
    // To just before the perfect tube would turn oval.
    run(&directory, "oval", &case.replace("1.08", "1.06"));
    let path = directory.join("oval");
    // At rest it is where it is imperfect, and free of stress.
    let state = |n: usize| {
        let file = format!("states/state-{n:04}.safetensors");
        SavedState::read(&path.join(file)).unwrap().u
    };
    let largest = |u: &[f64]| u.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let rest = state(0);
    // Control values are somewhat higher than the wall that they draw.
    assert!(
        (0.99..1.15).contains(&(largest(&rest) / 1e-4)),
        "{}",
        largest(&rest)
    );
    assert_eq!(numbers(&path, "energy")[0], 0.0);
    assert!(numbers(&path, "residual").iter().all(|&r| r <= 1e-6));
    // What differs from ring to ring grows in the shape of the mode.
    let oval = |u: &[f64]| -> Vec<f64> {
        let rings = u.chunks_exact(8);
        let wave = |rings: &[f64]| {
            rings
                .iter()
                .map(|x| x - rings.iter().sum::<f64>() / 8.0)
                .collect()
        };
        rings
            .flat_map(|rings| -> Vec<f64> { wave(rings) })
            .collect()
    };
    let shape = oval(&rest);
    let along = |n: usize| -> f64 {
        let own = oval(&state(n));
        let size: f64 = shape.iter().map(|x| x * x).sum();
        own.iter().zip(&shape).map(|(a, b)| a * b).sum::<f64>() / size
    };
    let grown = [0, 2, 4].map(along);
    assert!((grown[0] - 1.0).abs() < 1e-9 && grown[1] > 1.0, "{grown:?}");
    assert!(grown[2] > 2.0 * grown[1], "{grown:?}");

    // The run keeps the mode, and names it.
    let kept = fs::read(path.join("imperfections/mode-01.safetensors")).unwrap();
    assert_eq!(kept, fs::read(directory.join(MODE)).unwrap());
    let manifest = fs::read_to_string(path.join("manifest.json")).unwrap();
    assert!(manifest.contains(&format!("\"../{MODE}\"")), "{manifest}");
}

#[test]
fn the_stability_of_a_tube_with_an_imperfect_geometry_is_told_from_what_its_run_has_kept() {
    let directory = tested("modes-round");
    // Of harmonic 0, without twist.
    save(&directory, "round", 0.0, |i, x| {
        if i % 3 == 2 {
            *x = 0.0;
        }
    });
    run(&directory, "round", &imperfect("\"axisymmetric\"", "round"));
    fs::remove_file(directory.join("cases/round")).unwrap();
    let said = plica(&directory, &["stability", "round", "--harmonics", "2"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert!(
        text(&said.stdout).contains("turns oval"),
        "{}",
        text(&said.stdout)
    );
}

#[test]
fn a_mode_that_cannot_be_the_shape_of_a_tube_is_explained() {
    let directory = tested("modes-broken");
    let mode = format!("../{MODE}");
    let none = imperfect("\"none\"", &mode);
    save(&directory, "fifth", 5.0, |_, _| ());
    save(&directory, "half", 0.5, |_, _| ());
    save(&directory, "nothing", 2.0, |_, x| *x = 0.0);
    // Rows go to and fro along the tube.
    save(&directory, "crumpled", 2.0, |i, x| {
        let row = i / 12;
        *x = if i % 3 == 0 && row % 2 == 1 { 1.0 } else { 0.0 };
    });
    let (_, block) = none.split_once("\n[[imperfections]]").unwrap();
    let folded = format!("{none}{}", format!("\n[[imperfections]]{block}").repeat(9));
    let mut page = String::new();
    for (what, case) in [
        ("no file", imperfect("\"none\"", "nowhere")),
        (
            "a state",
            imperfect("\"none\"", "../perfect/states/state-0001.safetensors"),
        ),
        ("another tube", format!("{none}\n[tube]\nlength = 4.0\n")),
        ("axisymmetric", imperfect("\"axisymmetric\"", &mode)),
        ("another fold", imperfect("{ fold = 4 }", &mode)),
        ("too many waves", imperfect("\"none\"", "fifth")),
        ("half a wave", imperfect("\"none\"", "half")),
        ("zeros", imperfect("\"none\"", "nothing")),
        ("of an end", none.replace("\"geometry\"", "\"colon-end\"")),
        (
            "a shape that is folded over",
            folded.replace("1e-4", "0.015").replace(&mode, "crumpled"),
        ),
    ] {
        fs::write(directory.join("cases/case.toml"), case).unwrap();
        let said = plica(&directory, &["check", "cases/case.toml"]);
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(2), "{what}: {told}");
        page += &format!("==== {what}\n{told}\n");
    }
    compare("modes.txt", &page);
}
