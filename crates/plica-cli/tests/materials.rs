//! `plica materials`.

use crate::common::{fail, read, root, scratch, succeed};
use std::fs;

#[test]
fn the_library_is_listed_and_shown() {
    let list = succeed(&root(), &["materials"]);
    assert!(list.lines().count() >= 6, "{list}");
    let line = list
        .lines()
        .find(|line| line.starts_with("carotid-media-hgo-2000"));
    let line = line.unwrap_or_else(|| panic!("{list}"));
    for part in [
        "rabbit",
        "neo-Hookean, 2 families of fibres",
        "doi:10.1023/A:1010835316564",
    ] {
        assert!(line.contains(part), "{line}");
    }
    let shown = succeed(&root(), &["materials", "show", "carotid-media-hgo-2000"]);
    for part in [
        "material.neo-hookean = { shear_modulus = 3.0, bulk = 1000.0 }",
        "fibres = [{ k1 = 2.3632, k2 = 0.8393, angle_degrees = 29.0 }]",
        "material.from = \"carotid-media-hgo-2000\"",
    ] {
        assert!(shown.contains(part), "{shown}");
    }
    let unknown = fail(&root(), &["materials", "show", "granite"], 2);
    assert!(unknown.contains("no material has this name"), "{unknown}");
}

#[test]
fn curves_of_materials_and_cases_are_written() {
    let directory = scratch("material-curves");
    let name = "carotid-adventitia-hgo-2000";
    let csv = [
        "--incompressible",
        "--csv",
        "curves.csv",
        "--out",
        "curves.svg",
    ];
    succeed(
        &directory,
        &[&["materials", "plot", name][..], &csv].concat(),
    );
    let table = read(directory.join("curves.csv"));
    assert!(table.starts_with("material,test,stretch_along,"), "{table}");
    assert!(read(directory.join("curves.svg")).contains("nominal stress (kPa)"));
    let case = root().join("cases/carotid.toml");
    let plot = [
        "materials",
        "plot",
        case.to_str().unwrap(),
        "--inflation",
        "--out",
        "tube.png",
    ];
    succeed(&directory, &plot);
    assert!(fs::metadata(directory.join("tube.png")).unwrap().len() > 1000);
    let nothing = fail(&directory, &["materials", "plot", name], 2);
    assert!(nothing.contains("--out or --csv"), "{nothing}");
}

#[test]
fn a_law_is_fitted_to_a_table_of_a_user() {
    let directory = scratch("material-fit");
    // The nominal stress of an incompressible neo-Hookean material with μ = 12 kPa in uniaxial tension.
    let mut table = "stretch_around,nominal_stress_around_kPa\n".to_owned();
    for step in 1..=8 {
        let x = 1.0 + 0.05 * f64::from(step);
        table += &format!("{x},{}\n", 12.0 * (x - x.powi(-2)));
    }
    fs::write(directory.join("tests.csv"), table).unwrap();
    let found = succeed(
        &directory,
        &["materials", "fit", "tests.csv", "--law", "neo-hookean"],
    );
    assert!(found.contains("R²             1.000000"), "{found}");
    let line = "material.neo-hookean = { shear_modulus = 12.0, bulk = 1200.0 }";
    assert!(found.contains(line), "{found}");
    fs::write(directory.join("bad.csv"), "stretch_around,stress\n").unwrap();
    let bad = fail(
        &directory,
        &["materials", "fit", "bad.csv", "--law", "gent"],
        2,
    );
    assert!(bad.contains("bad.csv: column `stress`"), "{bad}");
}

#[test]
fn a_run_keeps_the_library_of_its_case() {
    let directory = scratch("material-library");
    let library =
        "[soft]\nmaterial.demiray = { shear_modulus = 0.3, stiffening = 1.0, bulk = 20.0 }\n";
    fs::write(directory.join("mine.toml"), library).unwrap();
    let case = "material = { from = 'soft', file = 'mine.toml' }\n\
        [mesh]\ncontrol_points = { axial = 24, around = 24, thickness = 4 }\n\
        [[stages]]\nsteps = 2\ndrive.ileum.displacement = 0.1\n[output]\npictures = false\n";
    fs::write(directory.join("tube.toml"), case).unwrap();
    succeed(&directory, &["run", "tube.toml"]);
    let kept = directory.join("runs/tube/materials/library-01.toml");
    assert_eq!(read(&kept), library);
    // The run does not need the file of the user any more.
    fs::remove_file(directory.join("mine.toml")).unwrap();
    succeed(&directory, &["table", "runs/tube"]);
    succeed(&directory, &["resume", "runs/tube"]);
}
