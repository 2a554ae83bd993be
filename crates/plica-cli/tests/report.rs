//! `plica report`. `scripts/check-page` opens the page in a browser.

use crate::common::{damage, fail, plica, scratch, short_run, succeed, text};
use std::fs;
use std::path::Path;

/// Returns the JSON data of a page.
fn page_data(path: &Path) -> serde_json::Value {
    let page = fs::read_to_string(path).unwrap();
    let begin = "<script id=\"data\" type=\"application/json\">";
    let (_, rest) = page.split_once(begin).unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_report_is_one_self_contained_page() {
    let directory = scratch("report");
    let run = short_run(&directory);
    let history = fs::read(run.join("history.csv")).unwrap();
    let stdout = succeed(&directory, &["report", "run"]);
    assert!(stdout.contains("report.html"));
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    for words in [
        "<h1><bdi>a short run</bdi></h1>",
        "All stages were completed. In the last state the tube is narrowed to a V.",
        "<dt>energy minimum</dt>",
        "drive.circular.diameter_ratio = 0.9",
        "12 × 8 × 4 control points, axisymmetric: 144 unknowns",
        "plica stability",
        "Okino et al. (2025)",
        // A number of the table of states, as in history.csv.
        "<td class=\"number\">0.9667</td>",
    ] {
        assert!(page.contains(words), "{words}");
    }
    for attribute in [
        "src=\"http",
        "href=\"http",
        "src=\"//",
        "@import",
        "url(http",
    ] {
        assert!(!page.contains(attribute), "{attribute}");
    }
    let data = &page_data(&run.join("report.html"))["runs"][0];
    assert_eq!(data["scene"]["rows"], serde_json::json!([0, 1, 2, 3]));
    let rows = history.iter().filter(|byte| **byte == b'\n').count() - 1;
    assert_eq!(data["columns"][0]["values"].as_array().unwrap().len(), rows);
    // A report does not change the run, and is reproducible.
    assert_eq!(fs::read(run.join("history.csv")).unwrap(), history);
    succeed(
        &directory,
        &["report", "run", "-o", "again.html", "-t", "1"],
    );
    assert_eq!(
        fs::read_to_string(directory.join("again.html")).unwrap(),
        page
    );
}

#[test]
fn the_text_of_a_case_is_escaped() {
    let directory = scratch("report-words");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let title = r#"</title><script>alert("1 & 2")</script>"#;
    let case = case.replace("\"a short run\"", &format!("'{title}'"));
    fs::write(directory.join("odd.toml"), case).unwrap();
    succeed(&directory, &["run", "odd.toml", "--out", "odd<b>"]);
    succeed(&directory, &["report", "odd<b>", "run"]);
    let page = fs::read_to_string(directory.join("comparison.html")).unwrap();
    assert!(!page.contains("<script>alert") && !page.contains("odd<b>"));
    assert!(page.contains("&lt;script&gt;alert("));
    assert_eq!(
        page_data(&directory.join("comparison.html"))["runs"][0]["name"],
        "odd<b>"
    );
}

#[test]
fn report_refuses_invalid_arguments() {
    let directory = scratch("report-refused");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let units = "[units]\nlength = \"mm\"\nstress = \"kPa\"\n[material.neo-hookean]\nyoungs_modulus = 20.0\npoisson_ratio = 0.49\n[tube]\ndiameter = 1.0\n";
    fs::write(directory.join("mm.toml"), case.replace("[tube]\n", units)).unwrap();
    succeed(&directory, &["run", "mm.toml", "--out", "mm"]);
    for (arguments, code, what) in [
        (&["run", "mm"][..], 2, "give both cases the same units"),
        (&["nowhere"], 3, "nowhere"),
        (&["run", "mm/../run"], 2, "given twice"),
        (&["run", "--out", "run/history.csv"], 2, "must end in .html"),
        (
            &["run", "run", "run", "run", "run"],
            2,
            "5 runs are too many for one page; name 4 at most",
        ),
        (
            &["run", "--out", "no/such/page.html"],
            3,
            "no/such/page.html",
        ),
        (&[], 2, "RUN_DIR"),
    ] {
        let stderr = fail(&directory, &[&["report"], arguments].concat(), code);
        assert!(stderr.contains(what), "{arguments:?}: {stderr}");
    }
    assert!(!directory.join("comparison.html").exists());
    // The page of a case with units shows them.
    succeed(&directory, &["report", "mm"]);
    let page = fs::read_to_string(directory.join("mm/report.html")).unwrap();
    assert!(page.contains("overhang (mm)") && page.contains("strain energy density w (kPa)"));
}

#[test]
fn a_run_without_saved_states_has_a_report_without_pictures() {
    let directory = scratch("report-bare");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let case = match case.contains("[output]") {
        true => case.replace("[output]", "[output]\nstates_every = 0"),
        false => case + "\n[output]\nstates_every = 0\n",
    };
    fs::write(directory.join("bare.toml"), case).unwrap();
    succeed(&directory, &["run", "bare.toml", "--out", "bare"]);
    succeed(&directory, &["report", "bare"]);
    let page = fs::read_to_string(directory.join("bare/report.html")).unwrap();
    assert!(page.contains("No state is saved in full") && page.contains("class=\"undrawn\""));
    let data = page_data(&directory.join("bare/report.html"));
    assert_eq!(data["runs"][0]["scene"]["drawn"], false);
    assert_eq!(data["stops"].as_array().unwrap().len(), 4);
    // It can be compared with a run that has states.
    succeed(&directory, &["report", "bare", "run"]);
    let data = page_data(&directory.join("comparison.html"));
    assert_eq!(data["runs"][1]["scene"]["drawn"], true);
    // Commands that need states report that there are none.
    for command in ["render", "animate", "export"] {
        let stderr = fail(&directory, &[command, "bare"], 2);
        assert!(stderr.contains("saved no states"), "{command}: {stderr}");
    }
    succeed(&directory, &["plot", "bare", "overhang"]);
}

#[test]
fn damaged_states_and_rows_are_skipped_and_reported() {
    let directory = scratch("report-broken");
    let run = short_run(&directory);
    let state = run.join("states/state-0001.safetensors");
    damage(&state);
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let cut = history.len() - 40;
    fs::write(run.join("history.csv"), &history[..cut]).unwrap();
    let report = || {
        let output = plica(&directory, &["report", "run"]);
        let stderr = text(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        let page = fs::read_to_string(run.join("report.html")).unwrap();
        assert!(page.contains("state-0001.safetensors: ") && page.contains("Could not read: "));
        let rows = page_data(&run.join("report.html"))["runs"][0]["scene"]["rows"].clone();
        (stderr, page, rows)
    };
    // The checkpoint has a copy of the rows.
    let (stderr, _, rows) = report();
    for what in [
        "state-0001.safetensors",
        "history.csv is damaged or incomplete at state 3",
    ] {
        assert!(stderr.contains(what), "{stderr}");
    }
    assert_eq!(rows, serde_json::json!([0, 2, 3]));
    // Without it, the last state has lost its row and is not shown.
    fs::remove_file(run.join("checkpoint.safetensors")).unwrap();
    let (stderr, page, rows) = report();
    assert!(stderr.contains("history.csv beyond state 2"), "{stderr}");
    assert!(page.contains("history.csv beyond state 2"));
    assert_eq!(rows, serde_json::json!([0, 2]));
}
