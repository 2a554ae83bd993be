//! Runs the program, compares its output with files, and reads files of the repository.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Path of the program.
pub const PLICA: &str = env!("CARGO_BIN_EXE_plica");

/// Runs the program in a directory.
pub fn plica(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(PLICA)
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

/// Runs the program, which must succeed, and returns its standard output.
#[track_caller]
pub fn succeed(directory: &Path, arguments: &[&str]) -> String {
    let output = plica(directory, arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        text(&output.stderr)
    );
    text(&output.stdout)
}

/// Runs the program, which must exit with a code, and returns its standard error.
#[track_caller]
pub fn fail(directory: &Path, arguments: &[&str], code: i32) -> String {
    let output = plica(directory, arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    stderr
}

/// Directory of these tests.
pub fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

/// Root of the repository.
pub fn root() -> PathBuf {
    tests().join("../../..")
}

/// Reads a file of the repository.
pub fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text.replace("\r\n", "\n")
}

/// Returns the files with an extension in a directory and its subdirectories.
pub fn files(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found
}

/// Returns the parts of a text between backticks.
pub fn quoted(text: &str) -> Vec<String> {
    let quoted = text.split('`').skip(1).step_by(2);
    quoted.map(str::to_owned).collect()
}

/// Creates an empty directory for a test.
pub fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Converts output to text with the line ends and program name of Unix.
pub fn text(bytes: &[u8]) -> String {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    text.replace("\r\n", "\n").replace("plica.exe", "plica")
}

/// Compares a text with a file beside the tests, or writes the file if `PLICA_BLESS` is set.
#[track_caller]
pub fn compare(file: &str, text: &str) {
    let path = tests().join(file);
    if std::env::var_os("PLICA_BLESS").is_some() {
        fs::write(&path, text).unwrap();
    }
    let expected = fs::read_to_string(&path)
        .unwrap_or_default()
        .replace("\r\n", "\n");
    for (n, (old, new)) in expected.lines().zip(text.lines()).enumerate() {
        assert!(old == new, "{file}, line {}: {old:?} is now {new:?}", n + 1);
    }
    assert_eq!(expected.len(), text.len(), "length of {file}");
}

/// A tube that contracts slightly in three steps.
pub const SHORT: &str = r#"
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

/// Runs a short case in a directory and returns the directory of the run.
pub fn short_run(directory: &Path) -> PathBuf {
    fs::write(directory.join("case.toml"), SHORT).unwrap();
    succeed(directory, &["run", "case.toml", "--out", "run"]);
    directory.join("run")
}

/// Flips the last bit of a file.
pub fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(path, bytes).unwrap();
}

/// Copies a directory.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().flatten() {
        let (path, name) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &name);
        } else {
            fs::copy(path, name).unwrap();
        }
    }
}

/// A table with named columns.
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Cells by row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads the `history.csv` of a run.
    pub fn history(run: &Path) -> Self {
        let table = fs::read_to_string(run.join("history.csv")).unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let mut lines = table.lines();
        let names: Vec<String> = cells(lines.next().unwrap());
        let rows: Vec<Vec<String>> = lines.map(cells).collect();
        assert!(rows.iter().all(|row| row.len() == names.len()));
        Self { names, rows }
    }

    /// Returns the cells of a column.
    pub fn words(&self, name: &str) -> Vec<&str> {
        let column = self.names.iter().position(|column| column == name);
        let column = column.expect(name);
        self.rows.iter().map(|row| row[column].as_str()).collect()
    }

    /// Returns the numbers of a column.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let words = self.words(name);
        words.iter().map(|word| word.parse().unwrap()).collect()
    }
}

/// Returns the rows of a `history.csv` without wall times; the last row may be incomplete.
pub fn without_times(history: &str) -> String {
    let mut table = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(history.as_bytes());
    let headers = table.headers().unwrap();
    let seconds = headers.iter().position(|head| head == "seconds");
    let row = |row: csv::StringRecord| {
        let cells = row.iter().enumerate().filter(|(i, _)| Some(*i) != seconds);
        let cells: Vec<&str> = cells.map(|(_, cell)| cell).collect();
        cells.join(",") + "\n"
    };
    table.records().map(|record| row(record.unwrap())).collect()
}

/// Returns the files of a run by relative path, without wall times, manifest and lock.
pub fn contents(run: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
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
                "history.csv" => without_times(&fs::read_to_string(&path).unwrap()).into_bytes(),
                _ => fs::read(&path).unwrap(),
            };
            files.insert(name, bytes);
        }
    }
    files
}

/// Asserts that a run has the expected [`contents`].
#[track_caller]
pub fn assert_contents(what: &str, expected: &BTreeMap<PathBuf, Vec<u8>>, run: &Path) {
    let found = contents(run);
    let names: Vec<_> = found.keys().collect();
    assert_eq!(names, expected.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in expected {
        assert!(found[name] == *bytes, "{what}: {} differs", name.display());
    }
}
