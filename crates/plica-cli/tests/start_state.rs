//! Cases that start from a saved state.

use crate::common::{Table, compare, damage, fail, plica, scratch, succeed, text};
use plica::saved_state::SavedState;
use std::fs;
use std::path::Path;

/// A contraction on a coarse mesh.
const FIRST: &str = "\
[muscles.ring]
direction = \"circular\"
zone = [0.5, 1.5]

[mesh]
control_points = { axial = 24, around = 24, thickness = 4 }

[output]
pictures = false

[[stages]]
name = \"contract\"
steps = 2
drive.ring.diameter_ratio = 0.8
";

/// Returns a case that continues from a state of that case.
fn next(state: &str) -> String {
    FIRST
        .replace("contract", "continue")
        .replace("0.8", "0.75")
        .replace("[mesh]", &format!("[start]\nstate = \"{state}\"\n\n[mesh]"))
}

/// Runs a case under a name. Returns exit code and standard error.
fn run(directory: &Path, name: &str, case: &str) -> (Option<i32>, String) {
    let file = format!("cases/{name}.toml");
    fs::create_dir_all(directory.join("cases")).unwrap();
    fs::write(directory.join(&file), case).unwrap();
    let output = plica(directory, &["run", &file, "--out", name]);
    (output.status.code(), text(&output.stderr))
}

const STATE: &str = "../first/states/state-0002.safetensors";

#[test]
fn a_run_from_a_state_on_the_same_mesh_continues_the_path() {
    let directory = scratch("start-same");
    let stages = "\n[[stages]]\nname = \"continue\"\nsteps = 2\ndrive.ring.diameter_ratio = 0.75\n";
    for (name, case) in [
        ("whole", FIRST.to_owned() + stages),
        ("first", FIRST.to_owned()),
        ("second", next(STATE)),
    ] {
        let (code, stderr) = run(&directory, name, &case);
        assert_eq!(code, Some(0), "{name}: {stderr}");
    }
    let [whole, second] = ["whole", "second"].map(|name| directory.join(name));
    assert_eq!(
        Table::history(&second).words("stage"),
        ["start", "continue", "continue"]
    );
    // The start state is in equilibrium.
    assert_eq!(Table::history(&second).words("iterations")[0], "0");
    assert_eq!(Table::history(&second).numbers("diameter_ratio")[0], 0.8);
    let (all, rest) = (
        Table::history(&whole).numbers("energy"),
        Table::history(&second).numbers("energy"),
    );
    for (a, b) in all[2..].iter().zip(&rest) {
        assert!((a / b - 1.0).abs() < 1e-9, "{all:?}, {rest:?}");
    }
    let manifest = fs::read_to_string(second.join("manifest.json")).unwrap();
    assert!(
        manifest.contains(&format!("\"start_state\": \"{STATE}\"")),
        "{manifest}"
    );
    // The stability test uses the run's own states.
    fs::remove_dir_all(directory.join("first")).unwrap();
    succeed(&directory, &["stability", "second", "--harmonics", "2"]);
}

#[test]
fn a_state_is_transferred_to_another_symmetry_and_mesh() {
    let directory = scratch("start-other");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    let energy = *Table::history(&directory.join("first"))
        .numbers("energy")
        .last()
        .unwrap();
    let fold = format!("symmetry = {{ fold = 12 }}\n{}", next(STATE));
    let finer = "{ axial = 44, around = 36, thickness = 5 }";
    let coarse = "{ axial = 24, around = 24, thickness = 4 }";
    let fine = fold.replace(coarse, finer);
    for (name, case, iterations, close) in
        [("fold", fold, 0..=0, 1e-12), ("fine", fine, 1..=20, 2e-2)]
    {
        let (code, stderr) = run(&directory, name, &case);
        assert_eq!(code, Some(0), "{name}: {stderr}");
        let path = directory.join(name);
        let found = Table::history(&path).numbers("energy")[0];
        assert!(
            (found / energy - 1.0).abs() < close,
            "{name}: {found}, {energy}"
        );
        assert!(
            iterations.contains(&(Table::history(&path).numbers("iterations")[0] as usize)),
            "{name}"
        );
        assert!(
            Table::history(&path)
                .numbers("residual")
                .iter()
                .all(|&r| r <= 1e-6),
            "{name}"
        );
    }
    // Every ring has the displacement of the axisymmetric state.
    let read = |name| SavedState::read(&directory.join(name)).unwrap();
    let one = read("first/states/state-0002.safetensors");
    let fold = read("fold/states/state-0000.safetensors");
    assert_eq!((one.layout.rings, fold.layout.rings), (1, 2));
    assert!(fold.u.iter().enumerate().all(|(i, x)| *x == one.u[i / 2]));
}

#[test]
fn unsuitable_start_states_are_explained() {
    let directory = scratch("start-broken");
    let fold = format!("symmetry = {{ fold = 12 }}\n{FIRST}");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    assert_eq!(run(&directory, "fold", &fold).0, Some(0));
    let state = directory.join("first/states/state-0002.safetensors");
    let whole = fs::read(&state).unwrap();
    fs::write(directory.join("cases/short"), &whole[..100]).unwrap();
    fs::write(directory.join("cases/text"), "[[stages]]\n").unwrap();
    fs::copy(&state, directory.join("cases/flipped")).unwrap();
    damage(&directory.join("cases/flipped"));
    let other = "../fold/states/state-0002.safetensors";
    let mut page = String::new();
    for (what, case) in [
        ("no file", next("nowhere")),
        ("a directory", next(".")),
        ("a file cut short", next("short")),
        ("a file of something else", next("text")),
        ("a flipped bit", next("flipped")),
        (
            "another tube",
            format!("[tube]\nlength = 4.0\n{}", next(STATE)),
        ),
        ("another muscle", next(STATE).replace("ring", "sphincter")),
        ("less symmetry", next(other)),
        (
            "no multiple",
            format!("symmetry = {{ fold = 8 }}\n{}", next(other)),
        ),
        (
            "nothing driven from there",
            next(STATE).replace("0.75", "0.8"),
        ),
    ] {
        fs::write(directory.join("cases/case.toml"), case).unwrap();
        let mut stderr = fail(&directory, &["check", "cases/case.toml"], 2);
        // The checksum depends on the version.
        if let Some((before, _)) = stderr.split_once("its checksum is ") {
            stderr = format!("{before}its checksum is ...\n");
        }
        page += &format!("==== {what}\n{stderr}\n");
    }
    compare("start_state.txt", &page);
}

#[test]
fn a_case_reads_only_files_in_allowed_directories() {
    let directory = scratch("start-reach");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    let folder = directory.join("cases");
    fs::write(folder.join("next.toml"), next(STATE)).unwrap();
    // The state lies in the working directory of the first command, but not of the others.
    succeed(&directory, &["check", "cases/next.toml"]);
    for command in [&["check", "next.toml"][..], &["run", "next.toml"]] {
        let stderr = fail(&folder, command, 2);
        assert!(
            stderr.contains("next.toml:") && stderr.contains("--within DIR"),
            "{stderr}"
        );
        assert!(!folder.join("runs").exists());
        let asked = [command, &["--within", ".."]].concat();
        succeed(&folder, &asked);
    }
    // Symbolic links are followed before the check.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(
            directory.join(STATE.trim_start_matches("../")),
            folder.join("link"),
        )
        .unwrap();
        fs::write(folder.join("next.toml"), next("link")).unwrap();
        assert_eq!(
            plica(&folder, &["check", "next.toml"]).status.code(),
            Some(2)
        );
    }
    fail(&folder, &["check", "next.toml", "--within", "nowhere"], 2);
}
