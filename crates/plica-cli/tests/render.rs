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
    if std::process::Command::new("ffmpeg")
        .arg("-version")
        .output()
        .is_ok()
    {
        let arguments = ["animate", "run", "--width", "700", "--out", "path.mp4"];
        let said = plica(&directory, &arguments);
        assert!(said.status.success(), "{}", text(&said.stderr));
        let film = fs::read(directory.join("path.mp4")).unwrap();
        assert_eq!(&film[4..8], b"ftyp");
    }
    let arguments = [&["render", "run", "--see-through"], &states[..]].concat();
    let said = plica(&directory, &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    // To look changes nothing.
    assert_eq!(fs::read(run.join("history.csv")).unwrap(), history);
}

#[test]
fn numbers_and_walls_are_plotted_for_screen_and_print() {
    let directory = scratch("plot");
    let run = short_run(&directory);
    let said = plica(&directory, &["plot", "run"]);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert_eq!(looked_at(&run.join("pictures/energy-path.png")).0, 1800);
    let along = ["--along", "diameter_ratio"];
    let arguments = [&["plot", "run", "outer_radius_min", "walls"], &along[..]].concat();
    let said = plica(&directory, &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    let svg = |name: &str| fs::read_to_string(run.join("pictures").join(name)).unwrap();
    let plot = svg("outer_radius_min-along-diameter_ratio-path.svg");
    assert!(plot.contains("smallest radius of the outer wall (") && plot.contains("<path d="));
    assert!(svg("walls-state-0003.svg").contains("inner wall"));
    let arguments = [
        "plot", "run", "walls", "--state", "0", "--state", "2", "--out", "two.svg",
    ];
    let said = plica(&directory, &arguments);
    assert!(said.status.success(), "{}", text(&said.stderr));
    assert!(directory.join("two.svg").exists() && !directory.join("two.png").exists());
    for (arguments, what) in [
        (&["beauty"][..], "these are: walls, length_ratio"),
        (&["energy", "--along", "beauty"], "beauty: not a column"),
        (
            &["inner_pressure"],
            "not a column that can be plotted of this run",
        ),
        (&["energy", "walls", "--out", "x.svg"], "plot one at a time"),
        (&["energy", "--out", "x.pdf"], "must end in .svg or .png"),
        (&["walls", "--state", "9"], "these are: 0, 1, 2, 3"),
    ] {
        let said = plica(&directory, &[&["plot", "run"], arguments].concat());
        assert_eq!(said.status.code(), Some(2), "{arguments:?}");
        let told = text(&said.stderr);
        assert!(told.contains(what), "{arguments:?}: {told}");
    }
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
