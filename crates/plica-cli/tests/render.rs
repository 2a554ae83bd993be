//! `plica render`, `plica animate` and `plica plot`.

use crate::common::{fail, scratch, short_run, succeed};
use std::fs;
use std::path::Path;

/// Returns width, height and number of frames of a PNG file.
fn dimensions(path: &Path) -> (u32, u32, u32) {
    let bytes = fs::read(path).unwrap();
    assert!(bytes.starts_with(b"\x89PNG"));
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    let control = bytes.windows(4).position(|chunk| chunk == b"acTL");
    (word(16), word(20), control.map_or(1, |at| word(at + 4)))
}

#[test]
fn states_and_animations_are_drawn() {
    let directory = scratch("render");
    let run = short_run(&directory);
    let history = fs::read(run.join("history.csv")).unwrap();
    succeed(&directory, &["render", "run", "--width", "600"]);
    let one = dimensions(&run.join("pictures/energy-state-0003.png"));
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
    succeed(&directory, &arguments);
    let two = dimensions(&run.join("pictures/von-mises-state-0001-0002.png"));
    assert!(two.1 > one.1, "{two:?}");
    let arguments = ["animate", "run", "--width", "700", "--out", "path.apng"];
    succeed(&directory, &arguments);
    let path = dimensions(&directory.join("path.apng"));
    assert_eq!((path.0, path.2), (700, 4));
    if std::process::Command::new("ffmpeg")
        .arg("-version")
        .output()
        .is_ok()
    {
        let arguments = ["animate", "run", "--width", "700", "--out", "path.mp4"];
        succeed(&directory, &arguments);
        let video = fs::read(directory.join("path.mp4")).unwrap();
        assert_eq!(&video[4..8], b"ftyp");
    }
    let arguments = [&["render", "run", "--see-through"], &states[..]].concat();
    succeed(&directory, &arguments);
    // Drawing does not change the run.
    assert_eq!(fs::read(run.join("history.csv")).unwrap(), history);
}

#[test]
fn columns_and_walls_are_plotted_as_svg_and_png() {
    let directory = scratch("plot");
    let run = short_run(&directory);
    succeed(&directory, &["plot", "run"]);
    assert_eq!(dimensions(&run.join("pictures/energy-path.png")).0, 1800);
    let against = ["--against", "diameter_ratio"];
    let arguments = [&["plot", "run", "outer_radius_min", "walls"], &against[..]].concat();
    succeed(&directory, &arguments);
    let svg = |name: &str| fs::read_to_string(run.join("pictures").join(name)).unwrap();
    let plot = svg("outer_radius_min-against-diameter_ratio-path.svg");
    assert!(plot.contains("smallest outer radius (") && plot.contains("<path d="));
    assert!(svg("walls-state-0003.svg").contains("inner wall"));
    // Any column against any other, also those that the page leaves out.
    let columns = [
        "lumen_volume",
        "work_circular",
        "--against",
        "axial_force_ileum",
    ];
    succeed(&directory, &[&["plot", "run"], &columns[..]].concat());
    let plot = svg("work_circular-against-axial_force_ileum-path.svg");
    assert!(plot.contains("axial force at the ileum end ("));
    let arguments = [
        "plot", "run", "walls", "--state", "0", "--state", "2", "--out", "two.svg",
    ];
    succeed(&directory, &arguments);
    assert!(directory.join("two.svg").exists() && !directory.join("two.png").exists());
    for (arguments, what) in [
        (&["beauty"][..], "choose one of walls, length_ratio"),
        (
            &["energy", "--against", "beauty"],
            "choose one of length_ratio",
        ),
        (&["inner_pressure"], "not a column of this run"),
        (&["energy", "walls", "--out", "x.svg"], "plot one at a time"),
        (&["energy", "--out", "x.pdf"], "must end in .svg or .png"),
        (&["walls", "--state", "9"], "choose from 0, 1, 2, 3"),
    ] {
        let stderr = fail(&directory, &[&["plot", "run"], arguments].concat(), 2);
        assert!(stderr.contains(what), "{arguments:?}: {stderr}");
    }
}

#[test]
fn render_refuses_invalid_appearances() {
    let directory = scratch("render-refused");
    let run = short_run(&directory);
    for (arguments, what) in [
        (&["--field", "beauty"][..], "von-mises"),
        (&["--view", "0,0,1"], "not along the tube"),
        (&["--view", "behind"], "oblique"),
        (&["--cutaway", "400"], "0 to 350"),
        (&["--range", "1,0"], "LOW < HIGH"),
        (&["--range", "nan,1"], "LOW < HIGH"),
        (&["--width", "9"], "600..=8000"),
        (&["--state", "7"], "choose from 0, 1, 2, 3"),
    ] {
        let stderr = fail(&directory, &[&["render", "run"], arguments].concat(), 2);
        assert!(stderr.contains(what), "{arguments:?}: {stderr}");
    }
    fail(
        &directory,
        &["render", "run", "--out", "no/such/folder.png"],
        3,
    );
    fail(&directory, &["animate", "run", "--fps", "0"], 2);
    assert!(!run.join("pictures").exists());
}
