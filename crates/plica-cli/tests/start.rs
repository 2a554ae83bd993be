//! Cases that start from a saved state.

mod common;

use common::{compare, plica, scratch, text};
use plica::study::SavedState;
use std::fs;
use std::path::Path;

/// A ring contracts on a coarse mesh.
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

/// The same tube goes on from there.
fn next(state: &str) -> String {
    FIRST
        .replace("contract", "go-on")
        .replace("0.8", "0.75")
        .replace("[mesh]", &format!("[start]\nstate = \"{state}\"\n\n[mesh]"))
}

/// Runs a case of a name: exit code and standard error.
fn run(directory: &Path, name: &str, case: &str) -> (Option<i32>, String) {
    let file = format!("cases/{name}.toml");
    fs::create_dir_all(directory.join("cases")).unwrap();
    fs::write(directory.join(&file), case).unwrap();
    let said = plica(directory, &["run", &file, "--out", name]);
    (said.status.code(), text(&said.stderr))
}

/// Cells of a column of a history.
fn column(run: &Path, name: &str) -> Vec<String> {
    let table = fs::read_to_string(run.join("history.csv")).unwrap();
    let cells = |line: &str| -> Vec<String> { line.split(',').map(str::to_owned).collect() };
    let names = cells(table.lines().next().unwrap());
    let at = names.iter().position(|n| n == name).unwrap();
    table
        .lines()
        .skip(1)
        .map(|line| cells(line)[at].clone())
        .collect()
}

fn numbers(run: &Path, name: &str) -> Vec<f64> {
    column(run, name)
        .iter()
        .map(|cell| cell.parse().unwrap())
        .collect()
}

const STATE: &str = "../first/states/state-0002.safetensors";

#[test]
fn a_run_goes_on_from_a_state_of_its_own_mesh_as_if_it_had_not_stopped() {
    let directory = scratch("start-same");
    let stages = "\n[[stages]]\nname = \"go-on\"\nsteps = 2\ndrive.ring.diameter_ratio = 0.75\n";
    for (name, case) in [
        ("whole", FIRST.to_owned() + stages),
        ("first", FIRST.to_owned()),
        ("second", next(STATE)),
    ] {
        let (code, told) = run(&directory, name, &case);
        assert_eq!(code, Some(0), "{name}: {told}");
    }
    let [whole, second] = ["whole", "second"].map(|name| directory.join(name));
    assert_eq!(column(&second, "stage"), ["start", "go-on", "go-on"]);
    // The state is in equilibrium already.
    assert_eq!(column(&second, "iterations")[0], "0");
    assert_eq!(numbers(&second, "diameter_ratio")[0], 0.8);
    let (all, rest) = (numbers(&whole, "energy"), numbers(&second, "energy"));
    for (a, b) in all[2..].iter().zip(&rest) {
        assert!((a / b - 1.0).abs() < 1e-9, "{all:?}, {rest:?}");
    }
    let manifest = fs::read_to_string(second.join("manifest.json")).unwrap();
    assert!(
        manifest.contains(&format!("\"start_state\": \"{STATE}\"")),
        "{manifest}"
    );
    // Its stability is told from its own states.
    fs::remove_dir_all(directory.join("first")).unwrap();
    let said = plica(&directory, &["stability", "second", "--harmonics", "2"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
}

#[test]
fn a_state_is_carried_to_another_symmetry_and_another_mesh() {
    let directory = scratch("start-other");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    let energy = *numbers(&directory.join("first"), "energy").last().unwrap();
    let fold = format!("symmetry = {{ fold = 12 }}\n{}", next(STATE));
    let finer = "{ axial = 44, around = 36, thickness = 5 }";
    let coarse = "{ axial = 24, around = 24, thickness = 4 }";
    let fine = fold.replace(coarse, finer);
    for (name, case, iterations, close) in
        [("fold", fold, 0..=0, 1e-12), ("fine", fine, 1..=20, 2e-2)]
    {
        let (code, told) = run(&directory, name, &case);
        assert_eq!(code, Some(0), "{name}: {told}");
        let path = directory.join(name);
        let found = numbers(&path, "energy")[0];
        assert!(
            (found / energy - 1.0).abs() < close,
            "{name}: {found}, {energy}"
        );
        assert!(
            iterations.contains(&(numbers(&path, "iterations")[0] as usize)),
            "{name}"
        );
        assert!(
            numbers(&path, "residual").iter().all(|&r| r <= 1e-6),
            "{name}"
        );
    }
    // Every ring moves as the one did.
    let read = |name| SavedState::read(&directory.join(name)).unwrap();
    let one = read("first/states/state-0002.safetensors");
    let fold = read("fold/states/state-0000.safetensors");
    assert_eq!((one.layout.rings, fold.layout.rings), (1, 2));
    assert!(fold.u.iter().enumerate().all(|(i, x)| *x == one.u[i / 2]));
}

#[test]
fn a_state_that_is_none_of_this_tube_is_explained() {
    let directory = scratch("start-broken");
    let fold = format!("symmetry = {{ fold = 12 }}\n{FIRST}");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    assert_eq!(run(&directory, "fold", &fold).0, Some(0));
    let state = directory.join("first/states/state-0002.safetensors");
    let whole = fs::read(&state).unwrap();
    fs::write(directory.join("cases/short"), &whole[..100]).unwrap();
    fs::write(directory.join("cases/text"), "[[stages]]\n").unwrap();
    let mut damaged = whole;
    *damaged.last_mut().unwrap() ^= 1;
    fs::write(directory.join("cases/flipped"), damaged).unwrap();
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
        let said = plica(&directory, &["check", "cases/case.toml"]);
        let mut told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(2), "{what}: {told}");
        // A checksum is of the version that wrote it.
        if let Some((before, _)) = told.split_once("its checksum is ") {
            told = format!("{before}its checksum is ...\n");
        }
        page += &format!("==== {what}\n{told}\n");
    }
    compare("start.txt", &page);
}

#[test]
fn a_case_does_not_reach_out_of_its_folder_by_itself() {
    let directory = scratch("start-reach");
    assert_eq!(run(&directory, "first", FIRST).0, Some(0));
    let folder = directory.join("cases");
    fs::write(folder.join("next.toml"), next(STATE)).unwrap();
    // From where the program runs it is within; from the folder of the case it is not.
    assert!(
        plica(&directory, &["check", "cases/next.toml"])
            .status
            .success()
    );
    for command in [&["check", "next.toml"][..], &["run", "next.toml"]] {
        let said = plica(&folder, command);
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(2), "{told}");
        assert!(
            told.contains("next.toml:") && told.contains("--within DIR"),
            "{told}"
        );
        assert!(!folder.join("runs").exists());
        let asked = [command, &["--within", ".."]].concat();
        assert!(plica(&folder, &asked).status.success());
    }
    // Nor through a link.
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
    let said = plica(&folder, &["check", "next.toml", "--within", "nowhere"]);
    assert_eq!(said.status.code(), Some(2));
}
