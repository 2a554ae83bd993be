//! `plica verify`.

use crate::common::{fail, scratch, succeed};
use std::fs;

#[test]
fn a_single_check_prints_its_rows_and_writes_a_page() {
    let directory = scratch("verify-alone");
    let table = succeed(&directory, &["verify", "--only", "lame", "-o", "page"]);
    assert!(
        table.contains("all 5 rows within their tolerances"),
        "{table}"
    );
    assert!(table.contains("2.93836"), "{table}");
    let page = fs::read_to_string(directory.join("page/verification.md")).unwrap();
    assert!(
        page.contains("| ring, small internal pressure | u(A)/p | 2.93836"),
        "{page}"
    );
}

#[test]
fn pictures_are_written_beside_the_page() {
    let directory = scratch("verify-pictures");
    succeed(&directory, &["verify", "--only", "convergence"]);
    let out = directory.join("runs/verification");
    let page = fs::read_to_string(out.join("verification.md")).unwrap();
    assert!(page.contains("](convergence.png)"), "{page}");
    assert!(
        fs::read(out.join("convergence.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
}

#[test]
fn checks_are_listed_and_unknown_ones_refused() {
    let directory = scratch("verify-list");
    let listed = succeed(&directory, &["verify", "--list"]);
    for check in plica_verify::verification::CHECKS {
        let slow = if check.slow { " (--full)" } else { "" };
        let line = format!("{}{slow}", check.description);
        let named = |l: &str| l.starts_with(check.name) && l.ends_with(&line);
        assert!(listed.lines().any(named), "{}: {listed}", check.name);
    }
    for (name, help) in [
        ("lamee", "see plica verify --list"),
        ("main-case-meshes", "it is slow: add --full"),
        ("", "see plica verify --list"),
    ] {
        let stderr = fail(&directory, &["verify", "--only", name], 2);
        assert!(stderr.contains(help), "{stderr}");
    }
    // Nothing was written.
    assert!(!directory.join("runs").exists());
}

#[test]
fn an_invalid_directory_is_refused_before_the_checks() {
    let directory = scratch("verify-nowhere");
    fs::write(directory.join("file"), "").unwrap();
    let stderr = fail(&directory, &["verify", "-o", "file/page"], 3);
    assert!(stderr.contains("file/page"), "{stderr}");
}

#[test]
fn verify_does_not_overwrite_files_of_the_user() {
    let directory = scratch("verify-page");
    let page = directory.join("verification.md");
    fs::write(&page, "# My notes\n").unwrap();
    let stderr = fail(&directory, &["verify", "--only", "lame", "-o", "."], 2);
    assert!(stderr.contains("choose another --out"));
    assert_eq!(fs::read_to_string(&page).unwrap(), "# My notes\n");
    // It overwrites its own page.
    fs::remove_file(&page).unwrap();
    for _ in 0..2 {
        succeed(&directory, &["verify", "--only", "lame", "-o", "."]);
    }
}
