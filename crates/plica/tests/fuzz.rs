//! Readers of cases, saved states and checkpoints return a value or an error for any input, in bounded time, and never panic.
//!
//! The inputs are mutations of valid ones from a seed. `PLICA_FUZZ_SECONDS=3600 cargo test --release -p plica fuzz` runs for an
//! hour with new seeds and writes inputs that fail to the directory of temporary files.

use crate::common::{Chance, files, root};
use plica::case;
use plica::run_directory::Checkpoint;
use plica::saved_state::SavedState;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Mutations of each kind among the other tests.
const FEW: usize = 1500;
/// No answer takes longer, not even on a busy machine about the largest mesh, whose imperfect wall is looked at everywhere.
const SOON: Duration = Duration::from_secs(120);
/// Words of cases, and extreme numbers.
const WORDS: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e-308",
    "0",
    "-0.0",
    "-1",
    "2.5",
    "9223372036854775807",
    "true",
    "[]",
    "{}",
    "\"\"",
    "''",
    "[0.5, 1.0]",
    "[1.0, 0.5]",
    "[[0.0, 0.0], [1.0, 1.0]]",
    "\"none\"",
    "{ fold = 3 }",
    "{ fold = 60 }",
    "\"geometry\"",
    "\"colon-end\"",
    "{ wave = { mode = 2 } }",
    "{ random = { seed = 7 } }",
    "{ smooth-box = { edge = 0.25 } }",
    "\"half-sine\"",
    "\"free\"",
    "\"sliding\"",
    "\"newmark\"",
    "\"reduced\"",
    "\"quadratic\"",
    "\n[units]\nlength = \"mm\"\nstress = \"kPa\"\n",
    "\n[[stages]]\n",
    "\n[[imperfections]]\n",
    "\n[mesh]\n",
    "\n[ends]\n",
    "drive.colon.displacement = 0.1\n",
    "drive.inner-wall.pressure = 1e-3\n",
    "\u{0}",
    "é",
    "\r\n",
    "#",
    "\"\"\"",
    "=",
    ".",
    "title = 3\n",
];

impl Chance {
    fn mutated(&mut self, bytes: &[u8], others: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..1 + self.below(4) {
            let at = self.below(bytes.len() + 1);
            let end = (at + self.below(24)).min(bytes.len());
            match self.below(7) {
                0 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let again = bytes[at..end].to_vec();
                    bytes.splice(end..end, again);
                }
                3 => bytes.truncate(at.max(bytes.len() / 2)),
                4 => {
                    let word = WORDS[self.below(WORDS.len())];
                    bytes.splice(at..end, word.bytes());
                }
                // A value in the place of another.
                5 => {
                    let sign = bytes[at..]
                        .iter()
                        .position(|b| *b == b'=')
                        .map(|i| at + i + 1);
                    let line = sign.and_then(|from| {
                        let length = bytes[from..].iter().position(|b| *b == b'\n')?;
                        Some(from..from + length)
                    });
                    if let Some(line) = line {
                        let word = format!(" {}", WORDS[self.below(WORDS.len())]);
                        bytes.splice(line, word.bytes());
                    }
                }
                _ => {
                    let other = &others[self.below(others.len())];
                    let from = self.below(other.len());
                    let to = (from + self.below(80)).min(other.len());
                    bytes.splice(at..end, other[from..to].iter().copied());
                }
            }
        }
        bytes
    }
}

/// Reads mutations of what there is, a few or for as long as is asked for.
fn survives(name: &str, corpus: &[Vec<u8>], finish: fn(&mut [u8]), read: impl Fn(&[u8])) {
    let seconds = std::env::var("PLICA_FUZZ_SECONDS").ok();
    let seconds: Option<u64> = seconds.and_then(|text| text.parse().ok());
    let begin = Instant::now();
    let clock = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let seed = seconds
        .and(clock.ok())
        .map_or(1, |now| now.as_nanos() as u64 | 1);
    let mut chance = Chance(seed);
    let mut count = 0;
    while seconds.map_or(count < FEW, |seconds| begin.elapsed().as_secs() < seconds) {
        let mut bytes = chance.mutated(&corpus[chance.0 as usize % corpus.len()], corpus);
        finish(&mut bytes);
        let since = Instant::now();
        let answered = catch_unwind(AssertUnwindSafe(|| read(&bytes)));
        if answered.is_err() || since.elapsed() > SOON {
            let path = std::env::temp_dir().join(format!("plica-fuzz-{name}-{seed}-{count}"));
            std::fs::write(&path, &bytes).unwrap();
            panic!(
                "seed {seed}, mutation {count}, after {:?}: {}",
                since.elapsed(),
                path.display()
            );
        }
        count += 1;
    }
    println!("{name}: {count} mutations from seed {seed}");
}

#[test]
fn nearly_cases_are_answered() {
    let mut paths = files(&root().join("cases"), "toml");
    paths.extend(files(&root().join("crates/plica-cli/tests/broken"), "toml"));
    let corpus: Vec<Vec<u8>> = paths
        .iter()
        .map(|path| std::fs::read(path).unwrap())
        .collect();
    assert!(corpus.len() > 50);
    survives(
        "case",
        &corpus,
        |_| {},
        |bytes| {
            if let Ok(text) = std::str::from_utf8(bytes) {
                match case::read(text, "nearly") {
                    Ok(plan) => {
                        case::advice(&plan);
                        plica::study::forecast(&plan);
                    }
                    Err(error) => {
                        assert!(!error.problems.is_empty());
                        for problem in error.problems {
                            assert!(text.get(problem.span).is_some(), "outside the text");
                        }
                    }
                }
            }
        },
    );
}

/// A checkpoint's bytes, of a very small tube.
fn checkpoint() -> Vec<u8> {
    let case = "[mesh]\ncontrol_points = { axial = 5, around = 8, thickness = 4 }\n[muscles.circular]\ndirection = 'circular'\nzone = [1.0, 2.0]\n\
        [[stages]]\nsteps = 2\ndrive.circular.diameter_ratio = 0.95\n[output]\npictures = false\n";
    let plan = case::read(case, "small").unwrap();
    let path = std::env::temp_dir().join(format!("plica-fuzz-{}", std::process::id()));
    let mut directory = plica::run_directory::RunDirectory::create(&path, case, "", true).unwrap();
    plica::run_directory::run(&plan, &mut directory, &mut ()).unwrap();
    let bytes = std::fs::read(path.join("checkpoint.safetensors")).unwrap();
    std::fs::remove_dir_all(path).unwrap();
    assert!(SavedState::from_bytes(&bytes).is_ok());
    bytes
}

/// Gives a mutation the checksum that it would have, so that what lies behind it is reached.
fn checksummed(bytes: &mut [u8]) {
    let name = b"blake3\\\":\\\"";
    let Some(at) = bytes.windows(name.len()).position(|window| window == name) else {
        return;
    };
    let digits = at + name.len()..at + name.len() + 64;
    if digits.end > bytes.len() {
        return;
    }
    bytes[digits.clone()].fill(b'0');
    let hash = blake3::hash(bytes).to_string();
    bytes[digits].copy_from_slice(hash.as_bytes());
}

#[test]
fn nearly_checkpoints_are_answered() {
    let corpus = [checkpoint()];
    let read = |bytes: &[u8]| {
        if let Ok(state) = SavedState::from_bytes(bytes) {
            let _ = Checkpoint::from_state(state);
        }
    };
    survives("raw", &corpus, |_| {}, read);
    survives("checkpoint", &corpus, checksummed, read);
}
