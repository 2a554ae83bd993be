//! `plica verify` as its user meets it.

mod common;

use common::{plica, scratch, text};
use std::fs;

#[test]
fn a_check_alone_prints_its_rows_and_leaves_a_page() {
    let directory = scratch("verify-alone");
    let said = plica(&directory, &["verify", "--only", "lame", "-o", "page"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let table = text(&said.stdout);
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
fn pictures_are_written_beside_the_page_that_shows_them() {
    let directory = scratch("verify-pictures");
    let said = plica(&directory, &["verify", "--only", "convergence"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
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
fn checks_are_listed_and_others_are_refused() {
    let directory = scratch("verify-list");
    let listed = plica(&directory, &["verify", "--list"]);
    assert!(listed.status.success());
    let listed = text(&listed.stdout);
    for check in plica_verify::verification::CHECKS {
        let slow = if check.slow { " (--full)" } else { "" };
        let line = format!("{}{slow}", check.description);
        let named = |l: &str| l.starts_with(check.name) && l.ends_with(&line);
        assert!(listed.lines().any(named), "{}: {listed}", check.name);
    }
    for (name, cure) in [
        ("lamee", "plica verify --list names them"),
        ("main-case-meshes", "it is a slow one: add --full"),
        ("", "plica verify --list names them"),
    ] {
        let said = plica(&directory, &["verify", "--only", name]);
        assert_eq!(said.status.code(), Some(2), "{name}");
        assert!(text(&said.stderr).contains(cure), "{}", text(&said.stderr));
    }
    // Nothing was computed, nothing written.
    assert!(!directory.join("runs").exists());
}

#[test]
fn a_directory_that_cannot_be_is_told_before_the_work() {
    let directory = scratch("verify-nowhere");
    fs::write(directory.join("file"), "").unwrap();
    let said = plica(&directory, &["verify", "-o", "file/page"]);
    assert_eq!(said.status.code(), Some(3), "{}", text(&said.stderr));
    assert!(said.stdout.is_empty());
}

#[test]
fn a_page_of_someone_else_s_is_not_replaced() {
    let directory = scratch("verify-page");
    let page = directory.join("verification.md");
    fs::write(&page, "# My notes\n").unwrap();
    let said = plica(&directory, &["verify", "--only", "lame", "-o", "."]);
    assert_eq!(said.status.code(), Some(2));
    assert!(text(&said.stderr).contains("choose another --out"));
    assert_eq!(fs::read_to_string(&page).unwrap(), "# My notes\n");
    // Its own is.
    fs::remove_file(&page).unwrap();
    for _ in 0..2 {
        let said = plica(&directory, &["verify", "--only", "lame", "-o", "."]);
        assert!(said.status.success(), "{}", text(&said.stderr));
    }
}
