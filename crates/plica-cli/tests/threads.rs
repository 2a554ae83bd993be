//! Results are bitwise equal for any number of threads, also for more than the machine has.

use crate::common::{
    PLICA, assert_contents, contents, plica, read, root, scratch, short_run, text,
};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Asserts that the results of a case are the same on one, two and eight threads.
fn assert_same(name: &str, case: &str) {
    let directory = scratch(&format!("threads-{name}"));
    fs::write(directory.join("case.toml"), case).unwrap();
    let run = |threads: usize| {
        // --threads uses at most as many as the machine has.
        let output = Command::new(PLICA)
            .args(["run", "case.toml", "--out", &threads.to_string()])
            .env("RAYON_NUM_THREADS", threads.to_string())
            .current_dir(&directory)
            .output()
            .unwrap();
        let stderr = text(&output.stderr);
        assert!(
            matches!(output.status.code(), Some(0 | 1)),
            "{name}: {stderr}"
        );
        directory.join(threads.to_string())
    };
    let expected = contents(&run(1));
    assert!(expected.len() > 3, "{name}");
    for threads in [2, 8] {
        let what = format!("{name} on {threads} threads");
        assert_contents(&what, &expected, &run(threads));
    }
}

/// Reads a case of the repository.
fn case(name: &str) -> String {
    read(Path::new("cases").join(name)) + "\n"
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    assert_same(
        "small",
        &case("small.toml")
            .replace("steps = 15", "steps = 5")
            .replace("steps = 25", "steps = 5"),
    );
    let tilted = "symmetry = \"none\"\n[muscles.circular]\ndirection = \"circular\"\nzone = [0.5, 1.5]\n[mesh]\ncontrol_points = { axial = 20, around = 12, thickness = 4 }\n\
        [[imperfections]]\nof = \"colon-end\"\namplitude = 0.01\nshape = { wave = { mode = 1 } }\n[[stages]]\nsteps = 4\ndrive.circular.diameter_ratio = 0.7\n";
    assert_same("tilted", tilted);
}

#[test]
#[ignore = "takes many minutes"]
fn results_of_all_cases_do_not_depend_on_the_number_of_threads() {
    for entry in fs::read_dir(root().join("cases")).unwrap().flatten() {
        let name = entry.file_name().into_string().unwrap();
        // A case that starts from a state of another run needs that run.
        if name.ends_with(".toml") && !case(&name).contains("start.state") {
            assert_same(&name, &case(&name));
        }
    }
}

#[test]
fn no_more_threads_than_cores_are_used() {
    let directory = scratch("threads-many");
    let output = plica(
        &short_run(&directory),
        &["report", ".", "--threads", "1024"],
    );
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    assert!(
        stderr.contains("--threads 1024: this machine has"),
        "{stderr}"
    );
}
