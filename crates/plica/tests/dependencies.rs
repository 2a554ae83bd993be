//! What Plica builds on: under which licences, and why.

mod common;

use common::{root, text};
use std::process::Command;

/// Licences that a program under MIT or Apache 2.0 may be made of.
const ALLOWED: &[&str] = &[
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-1-Clause",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "0BSD",
    "CC0-1.0",
    "Unlicense",
    "Unicode-3.0",
    "BSL-1.0",
];

/// Whether one may choose among the licences of an expression (SPDX; `/` is an old way to write OR) so that all are allowed.
fn is_allowed(expression: &str) -> bool {
    let bare = expression.replace(['(', ')'], " ").replace('/', " OR ");
    // Every part that must hold has an alternative that is allowed: stricter than the expression where brackets nest.
    bare.split(" AND ").all(|part| {
        part.split(" OR ")
            .any(|licence| ALLOWED.contains(&licence.trim()))
    })
}

#[test]
fn licences_go_together() {
    assert!(
        is_allowed("MIT OR GPL-3.0-only")
            && is_allowed("(MIT OR Apache-2.0) AND Unicode-3.0")
            && is_allowed("MIT/Apache-2.0")
    );
    assert!(!is_allowed("GPL-3.0-only") && !is_allowed("MIT AND LGPL-2.1"));
    let told = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(
        told.status.success(),
        "{}",
        String::from_utf8_lossy(&told.stderr)
    );
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
    let packages = told["packages"].as_array().unwrap();
    assert!(packages.len() > 50);
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("none");
        assert!(
            is_allowed(licence),
            "{} {}: {licence}",
            package["name"],
            package["version"]
        );
    }
}

#[test]
fn every_dependency_says_what_it_is_for() {
    for file in ["crates/plica/Cargo.toml", "crates/plica-cli/Cargo.toml"] {
        let mut within = false;
        for line in text(file).lines() {
            if line.starts_with('[') {
                within = line.contains("dependencies");
            } else if within && line.contains('=') && !line.starts_with("plica") {
                assert!(line.contains('#'), "{file}: {line}");
            }
        }
    }
}
