//! `plica table`, and `plica run --strict`.

use crate::common::{SHORT, fail, plica, scratch, succeed};
use std::fs;

/// The short case, contracted and opened again.
fn cycle() -> String {
    format!(
        "{SHORT}name = \"contract\"\n[[stages]]\nname = \"open\"\nsteps = 3\ndrive.circular.diameter_ratio = 1.0\n"
    )
}

#[test]
fn the_table_of_a_run_is_that_which_the_run_has_printed_and_json_has_its_numbers() {
    let directory = scratch("table");
    fs::write(directory.join("case.toml"), cycle()).unwrap();
    let printed = succeed(
        &directory,
        &["run", "case.toml", "--out", "run", "--strict"],
    );
    let table = succeed(&directory, &["table", "run"]);
    for line in table.lines().filter(|line| !line.starts_with("  verdict")) {
        assert!(printed.contains(line), "{line}");
    }
    assert!(table.contains(
        "stage contract         states 1 to 3, Dmin/D = 1.0000 to 0.9000; at the end W = "
    ));
    assert!(table.contains(
        "state 6 has the load of state 0 (rest) and is the same state: the tube has recovered"
    ));
    assert!(table.ends_with("verdict                complete\n"));

    let json = succeed(&directory, &["table", "run", "run", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json.as_array().unwrap().len(), 2);
    let found = &json[0]["findings"];
    assert_eq!(json[0]["verdict"], "complete");
    assert_eq!(json[0]["unphysical_states"], 0);
    assert_eq!(found["stages"][1]["states"], serde_json::json!([4, 6]));
    assert_eq!(found["returned"]["is_same"], true);
    assert_eq!(found["work"]["states"], 7);
    let target = &found["stages"][0]["to"][0];
    assert_eq!(
        (&target["name"], &target["value"]),
        (&"Dmin/D".into(), &0.9.into())
    );

    fail(&directory, &["table", "nowhere"], 3);
}

#[test]
fn a_strict_run_with_untested_states_is_complete_and_has_an_exit_code_of_its_own() {
    let directory = scratch("strict");
    // Of a twisted tube only mode 0 is tested.
    let untested = format!("{SHORT}drive.colon.twist_degrees = 5\n[output]\npictures = false\n");
    fs::write(directory.join("case.toml"), untested).unwrap();
    let stderr = fail(
        &directory,
        &["run", "case.toml", "--out", "run", "--strict"],
        4,
    );
    assert!(
        stderr.contains("the stability of 3 is not known"),
        "{stderr}"
    );
    let manifest = fs::read_to_string(directory.join("run/manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["verdict"], "complete");
    assert_eq!(manifest["states_untested"], 3);
    assert_eq!(manifest["states_crossing"], 0);
    let overwrite = ["run", "case.toml", "--out", "run", "--overwrite"];
    assert!(plica(&directory, &overwrite).status.success());
    // Without the test nothing is said to be stable.
    let table = succeed(&directory, &["table", "run"]);
    assert!(
        table.contains("stability              not determined: states 1 to 3 (stage-1, Dmin/D = "),
        "{table}"
    );
}
