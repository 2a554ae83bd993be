//! What Plica builds on: under which licences, and why.

mod common;

use common::{root, text};
use std::process::Command;

/// Whether one may choose among the licences of an expression (SPDX; `/` is an old way to write OR) so that all are allowed.
fn is_allowed(expression: &str, allowed: &[String]) -> bool {
    let bare = expression.replace(['(', ')'], " ").replace('/', " OR ");
    // Every part that must hold has an alternative that is allowed: stricter than the expression where brackets nest.
    bare.split(" AND ").all(|part| {
        part.split(" OR ")
            .any(|licence| allowed.iter().any(|one| one == licence.trim()))
    })
}

#[test]
fn licences_go_together() {
    // Those that a program under MIT or Apache 2.0 may be made of; cargo deny takes them from there, too.
    let deny: toml::Table = text("deny.toml").parse().unwrap();
    let allowed = deny["licenses"]["allow"].as_array().unwrap();
    let allowed: Vec<String> = allowed
        .iter()
        .map(|one| one.as_str().unwrap().to_owned())
        .collect();
    let is_allowed = |expression: &str| is_allowed(expression, &allowed);
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
