//! `plica reproduce` as its user meets it.

mod common;

use common::{plica, scratch, text};
use std::fs;

#[test]
fn a_figure_is_told_and_its_runs_are_not_done_again() {
    let directory = scratch("reproduce-fig6");
    let said = plica(&directory, &["reproduce", "6A", "--out", "out"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let table = text(&said.stdout);
    assert!(
        table.contains("3 of 3 statements of the paper agree"),
        "{table}"
    );
    let out = directory.join("out");
    let page = fs::read_to_string(out.join("fig6.md")).unwrap();
    assert!(page.contains("](fig6-walls.png)"), "{page}");
    assert!(page.contains("| `colon-side` | `cases/colon-side.toml` |"));
    let picture = fs::read(out.join("fig6-walls.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    let summary = fs::read_to_string(out.join("reproduction.md")).unwrap();
    assert!(summary.contains("| [6A](fig6.md) |"), "{summary}");
    // What was run can be run by itself, and is not run a second time.
    let history = out.join("runs/colon-side/history.csv");
    let written = fs::metadata(&history).unwrap().modified().unwrap();
    let said = plica(&directory, &["reproduce", "fig6", "--out", "out"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert_eq!(text(&said.stdout), table);
    let again = fs::metadata(&history).unwrap().modified().unwrap();
    assert_eq!(again, written);
}

#[test]
fn figures_are_listed_and_others_are_refused() {
    let directory = scratch("reproduce-list");
    let listed = plica(&directory, &["reproduce", "--list"]);
    assert!(listed.status.success());
    let listed = text(&listed.stdout);
    for figure in plica_verify::reproduction::FIGURES {
        assert!(listed.contains(figure.title), "{listed}");
    }
    let said = plica(&directory, &["reproduce", "fig8"]);
    assert_eq!(said.status.code(), Some(2));
    assert!(text(&said.stderr).contains("these are: fig3, fig4"));
    let said = plica(&directory, &["reproduce", "--quick", "--full"]);
    assert_eq!(said.status.code(), Some(2));
    // Nothing was computed, nothing written.
    assert!(!directory.join("runs").exists());
}

#[test]
fn a_summary_of_someone_else_s_is_not_replaced() {
    let directory = scratch("reproduce-page");
    let page = directory.join("reproduction.md");
    fs::write(&page, "# My notes\n").unwrap();
    let said = plica(&directory, &["reproduce", "fig6", "--out", "."]);
    assert_eq!(said.status.code(), Some(2));
    assert!(text(&said.stderr).contains("plica reproduce did not write it"));
    assert_eq!(fs::read_to_string(&page).unwrap(), "# My notes\n");
    // Nor anything else that lies there: a run of the user's own could have the name of one of these.
    fs::remove_file(&page).unwrap();
    let own = directory.join("runs/invagination");
    fs::create_dir_all(&own).unwrap();
    fs::write(own.join("history.csv"), "mine").unwrap();
    let said = plica(&directory, &["reproduce", "fig6", "--out", "."]);
    assert_eq!(said.status.code(), Some(2));
    assert!(text(&said.stderr).contains("choose another --out"));
    assert_eq!(fs::read_to_string(own.join("history.csv")).unwrap(), "mine");
}
