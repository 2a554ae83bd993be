//! Geometric imperfections with the shape of a buckling mode.

use crate::common::{self, Table, compare, fail, succeed};
use plica::saved_state::SavedState;
use std::fs;
use std::path::{Path, PathBuf};

/// Creates an empty directory for a test, with a directory for cases.
fn scratch(name: &str) -> PathBuf {
    let path = common::scratch(name);
    fs::create_dir(path.join("cases")).unwrap();
    path
}

/// A tube that relaxes on a coarse mesh until after it becomes oval.
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

/// Returns the case of the same tube with an imperfection in the shape of a mode.
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

/// Runs a case under a name.
fn run(directory: &Path, name: &str, case: &str) {
    let file = format!("cases/{name}.toml");
    fs::write(directory.join(&file), case).unwrap();
    succeed(directory, &["run", &file, "--out", name, "-t", "2"]);
}

/// Saves the perfect tube's mode 2 with another circumferential mode number and changed values.
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

/// Creates a directory with a run of the perfect tube and its modes.
fn perfect(name: &str) -> PathBuf {
    let directory = scratch(name);
    run(&directory, "perfect", PERFECT);
    let stdout = succeed(&directory, &["stability", "perfect", "--harmonics", "2"]);
    assert!(directory.join(MODE).exists(), "{}", stdout);
    directory
}

#[test]
fn a_mode_shaped_imperfection_grows_along_the_path() {
    let directory = perfect("modes-oval");
    let case = imperfect("{ fold = 2 }", &format!("../{MODE}"));
    // Stop just before the critical value of the perfect tube.
    run(&directory, "oval", &case.replace("1.08", "1.06"));
    let path = directory.join("oval");
    let history = Table::history(&path);
    // The first state is the imperfect shape, free of stress.
    let state = |n: usize| {
        let file = format!("states/state-{n:04}.safetensors");
        SavedState::read(&path.join(file)).unwrap().u
    };
    let largest = |u: &[f64]| u.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let rest = state(0);
    // Control values slightly exceed the displacement they describe.
    assert!(
        (0.99..1.15).contains(&(largest(&rest) / 1e-4)),
        "{}",
        largest(&rest)
    );
    assert_eq!(history.numbers("energy")[0], 0.0);
    assert!(history.numbers("residual").iter().all(|&r| r <= 1e-6));
    // The non-axisymmetric part grows in the shape of the mode.
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

    // The run directory contains the mode, and the manifest names it.
    let kept = fs::read(path.join("imperfections/mode-01.safetensors")).unwrap();
    assert_eq!(kept, fs::read(directory.join(MODE)).unwrap());
    let manifest = fs::read_to_string(path.join("manifest.json")).unwrap();
    assert!(manifest.contains(&format!("\"../{MODE}\"")), "{manifest}");
}

#[test]
fn stability_uses_the_mode_kept_in_the_run_directory() {
    let directory = perfect("modes-round");
    // Circumferential mode 0 without twist.
    save(&directory, "round", 0.0, |i, x| {
        if i % 3 == 2 {
            *x = 0.0;
        }
    });
    run(&directory, "round", &imperfect("\"axisymmetric\"", "round"));
    fs::remove_file(directory.join("cases/round")).unwrap();
    let stdout = succeed(&directory, &["stability", "round", "--harmonics", "2"]);
    assert!(stdout.contains("turns oval"), "{}", stdout);
}

#[test]
fn unsuitable_modes_are_explained() {
    let directory = perfect("modes-broken");
    let mode = format!("../{MODE}");
    let none = imperfect("\"none\"", &mode);
    save(&directory, "fifth", 5.0, |_, _| ());
    save(&directory, "half", 0.5, |_, _| ());
    save(&directory, "nothing", 2.0, |_, x| *x = 0.0);
    // Rows alternate along the tube.
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
        let stderr = fail(&directory, &["check", "cases/case.toml"], 2);
        page += &format!("==== {what}\n{stderr}\n");
    }
    compare("mode_imperfections.txt", &page);
}
