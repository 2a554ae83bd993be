//! Licences and purposes of the dependencies.

use crate::common::{read, root, text};
use std::process::Command;

/// Returns whether an SPDX expression can be satisfied by allowed licences only. `/` is an old notation of OR.
fn is_allowed(expression: &str, allowed: &[String]) -> bool {
    let bare = expression.replace(['(', ')'], " ").replace('/', " OR ");
    // Each operand of AND needs an allowed alternative: stricter than the expression where brackets nest.
    bare.split(" AND ").all(|part| {
        part.split(" OR ")
            .any(|licence| allowed.iter().any(|one| one == licence.trim()))
    })
}

#[test]
fn licences_are_compatible() {
    // `cargo deny` uses the same list.
    let deny: toml::Table = read("deny.toml").parse().unwrap();
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
    let cargo = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO"))
            .args(arguments)
            .current_dir(root())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    // Packages of other platforms may not have been downloaded.
    let version = cargo(&["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    let metadata = cargo(&[
        "metadata",
        "--format-version=1",
        "--locked",
        "--offline",
        "--filter-platform",
        host.unwrap(),
    ]);
    let metadata: serde_json::Value = serde_json::from_str(&metadata).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
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
fn every_dependency_has_a_purpose() {
    for name in ["plica", "plica-view", "plica-verify", "plica-cli"] {
        let file = format!("crates/{name}/Cargo.toml");
        let mut within = false;
        for line in read(&file).lines() {
            if line.starts_with('[') {
                within = line.contains("dependencies");
            } else if within && line.contains('=') && !line.starts_with("plica") {
                assert!(line.contains('#'), "{file}: {line}");
            }
        }
    }
}
