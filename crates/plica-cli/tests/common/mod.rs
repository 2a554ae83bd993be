//! Running the program, and comparing what it says with a file.

#![allow(dead_code)] // every file of tests uses a part

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program, in a directory.
pub fn plica(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plica"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

/// The directory of these tests.
pub fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

/// The root of the repository.
pub fn root() -> PathBuf {
    tests().join("../../..")
}

/// An empty directory of one test.
pub fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Bytes as text, with the line ends and the program's name that they have everywhere.
pub fn text(bytes: &[u8]) -> String {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    text.replace("\r\n", "\n").replace("plica.exe", "plica")
}

/// Holds a text against a file beside the tests; with `PLICA_BLESS` set, writes the file.
pub fn compare(file: &str, text: &str) {
    let path = tests().join(file);
    if std::env::var_os("PLICA_BLESS").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let written = std::fs::read_to_string(&path)
        .unwrap_or_default()
        .replace("\r\n", "\n");
    if let Some(n) = (0..)
        .zip(written.lines().zip(text.lines()))
        .find(|(_, (a, b))| a != b)
    {
        panic!("{file}, line {}: {:?} is now {:?}", n.0 + 1, n.1.0, n.1.1);
    }
    assert_eq!(written.len(), text.len(), "{file} ends elsewhere");
}

/// A tube that contracts a little, in three steps.
const SHORT: &str = r#"
title = "a short run"
[tube]
length = 2.0
thickness = 0.1
[muscles.circular]
direction = "circular"
zone = [0.5, 1.5]
[mesh]
control_points = { axial = 12, around = 8, thickness = 4 }
[[stages]]
steps = 3
drive.circular.diameter_ratio = 0.9
"#;

/// Runs it in a directory, and gives that of the run.
pub fn short_run(directory: &Path) -> PathBuf {
    std::fs::write(directory.join("case.toml"), SHORT).unwrap();
    let said = plica(directory, &["run", "case.toml", "--out", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    directory.join("run")
}

/// A table of states without its wall times; the last row may be torn.
pub fn timeless(history: &str) -> String {
    let mut table = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(history.as_bytes());
    let seconds = table
        .headers()
        .unwrap()
        .iter()
        .position(|head| head == "seconds");
    let row = |row: csv::StringRecord| {
        let cells = row.iter().enumerate().filter(|(i, _)| Some(*i) != seconds);
        cells
            .map(|(_, cell)| cell.to_owned())
            .collect::<Vec<String>>()
            .join(",")
    };
    table
        .records()
        .map(|record| row(record.unwrap()) + "\n")
        .collect()
}

/// What a run has left, by relative paths: of the history all but the wall times, of the manifest and the lock nothing.
pub fn left(run: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![run.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(run).unwrap().to_owned();
            let bytes = match name.to_str().unwrap() {
                "manifest.json" | "lock" => continue,
                "history.csv" => timeless(&fs::read_to_string(&path).unwrap()).into_bytes(),
                _ => fs::read(&path).unwrap(),
            };
            files.insert(name, bytes);
        }
    }
    files
}

/// That a run has left the same.
pub fn assert_same(whole: &BTreeMap<PathBuf, Vec<u8>>, run: &Path) {
    assert_same_after("", whole, run);
}

/// That a run has left the same after something.
pub fn assert_same_after(what: &str, whole: &BTreeMap<PathBuf, Vec<u8>>, run: &Path) {
    let got = left(run);
    let names: Vec<_> = got.keys().collect();
    assert_eq!(names, whole.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in whole {
        assert!(got[name] == *bytes, "{what}: {} differs", name.display());
    }
}
