//! `plica reproduce`.

use crate::common::{fail, scratch, succeed};
use std::fs;

#[test]
fn a_figure_is_reproduced_and_its_runs_are_reused() {
    let directory = scratch("reproduce-fig6");
    let table = succeed(&directory, &["reproduce", "6A", "--out", "out"]);
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
    // The run is not repeated.
    let history = out.join("runs/colon-side/history.csv");
    let written = fs::metadata(&history).unwrap().modified().unwrap();
    let again = succeed(&directory, &["reproduce", "fig6", "--out", "out"]);
    assert_eq!(again, table);
    let again = fs::metadata(&history).unwrap().modified().unwrap();
    assert_eq!(again, written);
}

#[test]
fn figures_are_listed_and_unknown_ones_refused() {
    let directory = scratch("reproduce-list");
    let listed = succeed(&directory, &["reproduce", "--list"]);
    for figure in plica_verify::reproduction::FIGURES {
        assert!(listed.contains(figure.title), "{listed}");
    }
    let stderr = fail(&directory, &["reproduce", "fig8"], 2);
    assert!(stderr.contains("choose one of fig3, fig4"));
    fail(&directory, &["reproduce", "--quick", "--full"], 2);
    // Nothing was written.
    assert!(!directory.join("runs").exists());
}

#[test]
fn reproduce_does_not_overwrite_files_of_the_user() {
    let directory = scratch("reproduce-page");
    let page = directory.join("reproduction.md");
    fs::write(&page, "# My notes\n").unwrap();
    let stderr = fail(&directory, &["reproduce", "fig6", "--out", "."], 2);
    assert!(stderr.contains("plica reproduce did not write"));
    assert_eq!(fs::read_to_string(&page).unwrap(), "# My notes\n");
    // A run of the user could have the same name as one of these runs.
    fs::remove_file(&page).unwrap();
    let own = directory.join("runs/invagination");
    fs::create_dir_all(&own).unwrap();
    fs::write(own.join("history.csv"), "mine").unwrap();
    let stderr = fail(&directory, &["reproduce", "fig6", "--out", "."], 2);
    assert!(stderr.contains("choose another --out"));
    assert_eq!(fs::read_to_string(own.join("history.csv")).unwrap(), "mine");
}
