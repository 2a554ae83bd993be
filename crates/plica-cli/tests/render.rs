//! `plica render` and `plica animate` as their user meets them.

mod common;

use common::{plica, scratch, short_run, text};
use std::fs;
use std::path::Path;

/// Width and height of a PNG file, and how many pictures follow each other in it.
fn looked_at(path: &Path) -> (u32, u32, u32) {
    let bytes = fs::read(path).unwrap();
    assert!(bytes.starts_with(b"\x89PNG"));
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    let control = bytes.windows(4).position(|chunk| chunk == b"acTL");
    (word(16), word(20), control.map_or(1, |at| word(at + 4)))
}

#[test]
fn states_and_the_whole_path_are_drawn() {
    let directory = scratch("render");
    let run = short_run(&directory);
    let history = fs::read(run.join("history.csv")).unwrap();
    let said = plica(&directory, &["render", "run", "--width", "600"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let one = looked_at(&run.join("pictures/energy-state-0003.png"));
    assert_eq!((one.0, one.2), (600, 1));
    let look = [
        "--field",
        "von-mises",
        "--cutaway",
        "90deg",
        "--view",
        "colon",
    ];
    let states = ["--state", "1", "--state", "2", "--width", "600"];
    let arguments = [&["render", "run"], &look[..], &states[..]].concat();
    let said = plica(&directory, &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let two = looked_at(&run.join("pictures/von-mises-state-0001-0002.png"));
    assert!(two.1 > one.1, "{two:?}");
    let arguments = ["animate", "run", "--width", "700", "--out", "path.apng"];
    let said = plica(&directory, &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let path = looked_at(&directory.join("path.apng"));
    assert_eq!((path.0, path.2), (700, 4));
    // To look changes nothing.
    assert_eq!(fs::read(run.join("history.csv")).unwrap(), history);
}

#[test]
fn looks_that_are_none_are_refused() {
    let directory = scratch("render-refused");
    let run = short_run(&directory);
    for (arguments, what) in [
        (&["--field", "beauty"][..], "von-mises"),
        (&["--view", "0,0,1"], "not along the tube"),
        (&["--view", "behind"], "oblique"),
        (&["--cutaway", "400"], "0 to 350"),
        (&["--range", "1,0"], "the first below the second"),
        (&["--range", "nan,1"], "the first below the second"),
        (&["--width", "9"], "600..=8000"),
        (&["--state", "7"], "these are: 0, 1, 2, 3"),
    ] {
        let said = plica(&directory, &[&["render", "run"], arguments].concat());
        assert_eq!(said.status.code(), Some(2), "{arguments:?}");
        let told = text(&said.stderr);
        assert!(told.contains(what), "{arguments:?}: {told}");
    }
    let said = plica(
        &directory,
        &["render", "run", "--out", "no/such/folder.png"],
    );
    assert_eq!(said.status.code(), Some(3));
    let said = plica(&directory, &["animate", "run", "--fps", "0"]);
    assert_eq!(said.status.code(), Some(2));
    assert!(!run.join("pictures").exists());
}
