//! `plica report` as its user meets it; what a browser makes of the page is held by scripts/check-page.

mod common;

use common::{plica, scratch, short_run, text};
use std::fs;
use std::path::Path;

/// The numbers in a page.
fn data(path: &Path) -> serde_json::Value {
    let page = fs::read_to_string(path).unwrap();
    let begin = "<script id=\"data\" type=\"application/json\">";
    let (_, rest) = page.split_once(begin).unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_run_is_told_on_one_page_that_needs_nothing_else() {
    let directory = scratch("report");
    let run = short_run(&directory);
    let history = fs::read(run.join("history.csv")).unwrap();
    let said = plica(&directory, &["report", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert!(text(&said.stdout).contains("report.html"));
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    for words in [
        "<h1><bdi>a short run</bdi></h1>",
        "Every stage was done. At its last state the tube is narrowed to a V.",
        "<dt>energy minimum</dt>",
        "drive.circular.diameter_ratio = 0.9",
        "12 × 8 × 4 control points, axisymmetric: 144 unknowns",
        "plica stability",
        "Okino et al. (2025)",
        // A number of the table, as in history.csv.
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
    let known = &data(&run.join("report.html"))["runs"][0];
    assert_eq!(known["scene"]["rows"], serde_json::json!([0, 1, 2, 3]));
    let rows = history.iter().filter(|byte| **byte == b'\n').count() - 1;
    assert_eq!(
        known["columns"][0]["values"].as_array().unwrap().len(),
        rows
    );
    // To tell changes nothing, and the same page comes out again.
    assert_eq!(fs::read(run.join("history.csv")).unwrap(), history);
    plica(
        &directory,
        &["report", "run", "-o", "again.html", "-t", "1"],
    );
    assert_eq!(
        fs::read_to_string(directory.join("again.html")).unwrap(),
        page
    );
}

#[test]
fn words_of_a_case_stay_words() {
    let directory = scratch("report-words");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let title = r#"</title><script>alert("1 & 2")</script>"#;
    let case = case.replace("\"a short run\"", &format!("'{title}'"));
    fs::write(directory.join("odd.toml"), case).unwrap();
    let said = plica(&directory, &["run", "odd.toml", "--out", "odd<b>"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let said = plica(&directory, &["report", "odd<b>", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let page = fs::read_to_string(directory.join("comparison.html")).unwrap();
    assert!(!page.contains("<script>alert") && !page.contains("odd<b>"));
    assert!(page.contains("&lt;script&gt;alert("));
    assert_eq!(
        data(&directory.join("comparison.html"))["runs"][0]["name"],
        "odd<b>"
    );
}

#[test]
fn pages_that_cannot_be_are_refused() {
    let directory = scratch("report-refused");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let units = "[units]\nlength = \"mm\"\nstress = \"kPa\"\n[material.neo-hookean]\nyoungs_modulus = 20.0\npoisson_ratio = 0.49\n[tube]\ndiameter = 1.0\n";
    fs::write(directory.join("mm.toml"), case.replace("[tube]\n", units)).unwrap();
    let said = plica(&directory, &["run", "mm.toml", "--out", "mm"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    for (arguments, code, what) in [
        (&["run", "mm"][..], 2, "give both cases the same units"),
        (&["nowhere"], 3, "nowhere"),
        (&["run", "mm/../run"], 2, "named twice"),
        (&["run", "--out", "run/history.csv"], 2, "must end in .html"),
        (
            &["run", "run", "run", "run", "run"],
            2,
            "no more were expected",
        ),
        (
            &["run", "--out", "no/such/page.html"],
            3,
            "no/such/page.html",
        ),
        (&[], 2, "RUN_DIR"),
    ] {
        let said = plica(&directory, &[&["report"], arguments].concat());
        let told = text(&said.stderr);
        assert_eq!(said.status.code(), Some(code), "{arguments:?}: {told}");
        assert!(told.contains(what), "{arguments:?}: {told}");
    }
    assert!(!directory.join("comparison.html").exists());
    // In units, they are on the page.
    let said = plica(&directory, &["report", "mm"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let page = fs::read_to_string(directory.join("mm/report.html")).unwrap();
    assert!(page.contains("overhang (mm)") && page.contains("strain energy density w (kPa)"));
}

#[test]
fn a_run_without_saved_states_has_a_page_of_numbers() {
    let directory = scratch("report-bare");
    let run = short_run(&directory);
    let case = fs::read_to_string(run.join("case.toml")).unwrap();
    let case = match case.contains("[output]") {
        true => case.replace("[output]", "[output]\nstates_every = 0"),
        false => case + "\n[output]\nstates_every = 0\n",
    };
    fs::write(directory.join("bare.toml"), case).unwrap();
    let said = plica(&directory, &["run", "bare.toml", "--out", "bare"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let said = plica(&directory, &["report", "bare"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let page = fs::read_to_string(directory.join("bare/report.html")).unwrap();
    assert!(page.contains("No state is saved in full") && page.contains("class=\"undrawn\""));
    let known = data(&directory.join("bare/report.html"));
    assert_eq!(known["runs"][0]["scene"]["drawn"], false);
    assert_eq!(known["stops"].as_array().unwrap().len(), 4);
    // Beside one that has states, its plots go along.
    let said = plica(&directory, &["report", "bare", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let known = data(&directory.join("comparison.html"));
    assert_eq!(known["runs"][1]["scene"]["drawn"], true);
    // What looks at states says that there are none.
    for command in ["render", "animate", "export"] {
        let said = plica(&directory, &[command, "bare"]);
        assert_eq!(said.status.code(), Some(2), "{command}");
        assert!(
            text(&said.stderr).contains("saved no states"),
            "{command}: {}",
            text(&said.stderr)
        );
    }
    let said = plica(&directory, &["plot", "bare", "overhang"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
}

#[test]
fn what_is_broken_is_left_out_and_told() {
    let directory = scratch("report-broken");
    let run = short_run(&directory);
    let state = run.join("states/state-0001.safetensors");
    let mut bytes = fs::read(&state).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&state, bytes).unwrap();
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let cut = history.len() - 40;
    fs::write(run.join("history.csv"), &history[..cut]).unwrap();
    let said = plica(&directory, &["report", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let told = text(&said.stderr);
    for what in ["state-0001.safetensors", "history.csv beyond state 2"] {
        assert!(told.contains(what), "{told}");
    }
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    assert!(page.contains("state-0001.safetensors: ") && page.contains("Not read: "));
    assert!(page.contains("history.csv beyond state 2"));
    let known = &data(&run.join("report.html"))["runs"][0];
    // The last state has lost its row, and is not shown either.
    assert_eq!(known["scene"]["rows"], serde_json::json!([0, 2]));
}
