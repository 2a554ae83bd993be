//! The programs under `examples/` print what they expect.

use crate::common::{files, root};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Largest relative error of a number, unless its line says `within N %`.
const TOLERANCE: f64 = 1e-3;

/// Lines of the form `FOUND (expected EXPECTED)` or `FOUND (expected EXPECTED within N %)`: every word of EXPECTED must be in
/// FOUND, and every number up to the tolerance.
#[test]
fn every_example_prints_what_it_expects() {
    for source in files(&root().join("crates/plica/examples"), "rs") {
        let name = source.file_stem().unwrap().to_str().unwrap();
        let output = Command::new(program(name))
            .arg(env!("CARGO_TARGET_TMPDIR"))
            .output()
            .unwrap();
        let stdout = String::from_utf8(output.stdout).unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {stdout}{stderr}");
        let mut compared = 0;
        for line in stdout.lines() {
            if let Some((found, rest)) = line.split_once("(expected ") {
                let expected = rest.trim_end().trim_end_matches(')');
                assert!(agree(found, expected), "{name}: {line}");
                compared += 1;
            }
        }
        assert!(compared > 0, "{name} prints no expected number:\n{stdout}");
    }
}

/// Returns the path of an example, which `cargo test` builds together with the tests.
fn program(name: &str) -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let profile = test.parent().and_then(Path::parent).unwrap();
    let path = profile.join("examples").join(name);
    let path = path.with_extension(std::env::consts::EXE_EXTENSION);
    let command =
        "build the examples first: cargo build -p plica --examples, in the profile of the tests";
    assert!(path.exists(), "{}: {command}", path.display());
    path
}

/// Returns whether a line has the expected words and numbers.
fn agree(found: &str, expected: &str) -> bool {
    let (expected, tolerance) = match expected.split_once(" within ") {
        Some((expected, percent)) => {
            let percent = percent.trim_end_matches('%').trim();
            (expected, percent.parse::<f64>().unwrap() / 100.0)
        }
        None => (expected, TOLERANCE),
    };
    let words = |text: &str| -> Vec<String> {
        let words = text.split_whitespace();
        let trimmed = words.map(|word| word.trim_matches([',', ':', ';']));
        trimmed.map(str::to_owned).collect()
    };
    let found = words(found);
    words(expected)
        .iter()
        .all(|word| match word.parse::<f64>() {
            Ok(expected) => found
                .iter()
                .filter_map(|word| word.parse::<f64>().ok())
                .any(|found| (found - expected).abs() <= tolerance * expected.abs()),
            Err(_) => found.contains(word),
        })
}
