//! Materials of libraries, Fung's law, relations of active tension, and open sectors.

use super::*;
use crate::material::{Composite, LengthTension, Material, Matrix};
use crate::tube::{Opening, WallLayer};

const UNITS: &str = "units = { length = 'mm', stress = 'kPa' }\n";
const STAGE: &str = "[[stages]]\ndrive.ileum.displacement = 0.1\n";

fn with_library(text: &str) -> Result<Plan, CaseError> {
    read_with(text, "case", &|wanted| match wanted {
        InputFile::Materials(1, "my.toml") => Ok(Input::Text(MATERIALS.into())),
        InputFile::Materials(_, "bad.toml") => Ok(Input::Text("[a]\nmaterial.gent = {}\n".into())),
        _ => Err(std::io::Error::from(std::io::ErrorKind::NotFound).into()),
    })
}

fn layers(text: &str) -> Vec<WallLayer> {
    let read = with_library(&format!("{text}{STAGE}"));
    read.unwrap_or_else(|error| panic!("{text}: {error}"))
        .tube
        .layers
}

/// Returns the only problem of a case.
fn problem(text: &str) -> String {
    let error = with_library(&format!("{text}{STAGE}")).expect_err(text);
    assert_eq!(error.problems.len(), 1, "{error}");
    error.to_string()
}

#[test]
fn every_material_of_the_library_has_a_source_and_is_used_by_its_name() {
    let library = library();
    assert!(library.len() >= 5);
    for material in library {
        let name = &material.name;
        let doi = material.doi.as_deref().unwrap_or("");
        assert!(doi.starts_with("10.") && material.valid.is_some(), "{name}");
        assert!(
            material.unit.is_some() && material.tissue.is_some(),
            "{name}"
        );
        let layers = layers(&format!("{UNITS}material.from = '{name}'\n"));
        let (Material::Composite(own), Material::Composite(used)) =
            (&material.material, &layers[0].material)
        else {
            panic!("{name}");
        };
        assert_eq!(own.fibres.len(), used.fibres.len());
        let ratio = own.fibres[0].k1 / own.matrix.shear_modulus();
        let of_case = used.fibres[0].k1 / used.matrix.shear_modulus();
        assert!((ratio / of_case - 1.0).abs() < 1e-14, "{name}");
    }
}

#[test]
fn a_material_of_a_library_is_the_same_as_its_law_written_out() {
    let layer = |own: &str| format!("[[layers]]\nname = 'a'\nthickness = 0.03\n{own}\n");
    let written = "material.neo-hookean = { shear_modulus = 3.0, bulk = 1000.0 }\n\
        fibres = [{ k1 = 2.3632, k2 = 0.8393, angle_degrees = 29.0 }]";
    let named = "material.from = 'carotid-media-hgo-2000'";
    let of = |own: &str| layers(&format!("{UNITS}{}", layer(own)));
    assert_eq!(of(named), of(written));
    // In another unit, with another constant, and as the material of the whole wall.
    let megapascal = "units = { length = 'mm', stress = 'MPa' }\n";
    let other = "material = { from = 'carotid-media-hgo-2000', bulk = 2.0 }\n";
    let written = written
        .replace("3.0", "0.003")
        .replace("1000.0", "2.0")
        .replace("2.3632", "0.0023632");
    let [a, b] = [
        layers(&format!(
            "{megapascal}{other}[[layers]]\nthickness = 0.03\n"
        )),
        layers(&format!("{megapascal}{}", layer(&written))),
    ];
    let (Material::Composite(a), Material::Composite(b)) = (&a[0].material, &b[0].material) else {
        panic!();
    };
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
    assert!(close(a.fibres[0].k1, b.fibres[0].k1));
    let bulk = |law: &Composite| match law.matrix {
        Matrix::NeoHookean(law) => law.lambda,
        _ => panic!(),
    };
    assert!(close(bulk(a), bulk(b)) && close(bulk(a), 2.0 / 0.009));
}

#[test]
fn a_library_of_a_user_comes_before_that_of_plica_and_is_kept() {
    let text = format!("{UNITS}material = {{ from = 'soft', file = 'my.toml' }}\n{STAGE}");
    let plan = with_library(&text).unwrap();
    let Material::Composite(law) = &plan.tube.layers[0].material else {
        panic!();
    };
    let Matrix::Fung(fung) = law.matrix else {
        panic!();
    };
    // c = 500 Pa = 0.5 kPa over E = 3 c (1 + 1.5)/4.
    assert!((fung.c - 0.5 / 0.9375).abs() < 1e-15 && law.fibres.len() == 2);
    assert!((law.fibres[0].k1 / fung.c - 4.0).abs() < 1e-14);
    assert_eq!(
        (&plan.materials[0].file[..], &plan.materials[0].text[..]),
        ("my.toml", MATERIALS)
    );
    // A material without a unit has that of the case, or none.
    let own = "material = { from = 'carotid-media-hgo-2000', file = 'my.toml' }\n";
    assert_eq!(layers(own), layers(&format!("{UNITS}{own}")));
}

#[test]
fn mistakes_in_the_name_of_a_material_are_reported_at_their_place() {
    for (text, expected) in [
        (
            "material.from = 'carotid-media-hgo-2000'\n",
            "material.from = 'carotid-media-hgo-2000': its stresses are in kPa, and the case has no units; \
             write units = { length = \"mm\", stress = \"kPa\" }",
        ),
        (
            "material.from = 'carotid-media-hgo'\n",
            "material.from = 'carotid-media-hgo': no material has this name; did you mean \"carotid-media-hgo-2000\"?",
        ),
        (
            "material = { from = 'soft', file = 'bad.toml' }\n",
            "material.file = 'bad.toml': a.material.gent.shear_modulus: missing; for example, shear_modulus = 0.3; \
             a.material.gent.limit: missing; for example, limit = 30.0; \
             a.material.gent.bulk: missing; for example, bulk = 20.0",
        ),
        (
            "material = { from = 'soft', yeoh = { c1 = 1.0, bulk = 2.0 } }\n",
            "material: only one of from and yeoh may be given",
        ),
        (
            "material.bulk = 2.0\n",
            "material.from: missing; for example, from = \"carotid-media-hgo-2000\"",
        ),
        (
            "material.fung = { c = 1.0, along = 1.0, around = 0.25, along_around = 0.5, bulk = 9.0 }\n",
            "material.fung: the quadratic form Q must be positive definite; make the size of along_around less than 0.5",
        ),
    ] {
        assert_eq!(problem(text), expected);
    }
    let text = format!(
        "{UNITS}[[layers]]\nthickness = 0.03\nmaterial.from = 'carotid-media-hgo-2000'\n\
         fibres = [{{ k1 = 1.0, k2 = 1.0, angle_degrees = 20.0 }}]\n"
    );
    assert_eq!(
        problem(&text),
        "layers[1].fibres: carotid-media-hgo-2000 has fibres of its own; leave them out, or write the law out"
    );
    let missing = "material = { from = 'soft', file = 'none.toml' }\n";
    assert!(problem(missing).starts_with("material.file = 'none.toml': "));
}

#[test]
fn a_tone_has_one_relation_between_stretch_and_stress() {
    let tone =
        |keys: &str| format!("[[layers]]\nthickness = 0.03\ntone = {{ tension = 0.1{keys} }}\n");
    let relation = |keys: &str| match &layers(&tone(keys))[0].material {
        Material::Composite(law) => law.tones.first().map(|tone| tone.relation.clone()),
        _ => None,
    };
    let gaussian = LengthTension::Gaussian {
        best: 1.2,
        width: 0.3,
    };
    assert_eq!(
        relation(", best_stretch = 1.2, width = 0.3"),
        Some(gaussian)
    );
    let table = LengthTension::Table(vec![[0.5, 0.0], [1.0, 1.0]]);
    assert_eq!(relation(", table = [[0.5, 0.0], [1.0, 1.0]]"), Some(table));
    assert_eq!(relation(""), Some(LengthTension::Constant));
    for (keys, expected) in [
        (
            ", best_stretch = 1.2",
            "best_stretch: needs least_stretch or width; add least_stretch or width",
        ),
        (
            ", width = 0.3",
            "width: needs best_stretch; add best_stretch",
        ),
        (
            ", best_stretch = 1.2, least_stretch = 0.5, width = 0.3",
            "width: only one of least_stretch and width may be given",
        ),
        (
            ", best_stretch = 1.2, table = [[0.5, 0.0], [1.0, 1.0]]",
            "table: only one of best_stretch and table may be given",
        ),
        (
            ", table = [[0.5, 0.0], [0.4, 1.0]]",
            "table: stretches must rise from 0 or more; \
             try [[0.6, 0.0], [1.2, 1.0], [1.6, 0.5]]",
        ),
        (
            ", table = [[0.5, -0.1], [1.0, 1.0]]",
            "table: the stress over T must be from 0 to 10; \
             try [[0.6, 0.0], [1.2, 1.0], [1.6, 0.5]]",
        ),
    ] {
        let expected = format!("layers[1].tone.{expected}");
        assert_eq!(problem(&tone(keys)), expected);
    }
}

#[test]
fn layers_with_one_opening_angle_open_together() {
    // The carotid artery of Holzapfel et al. (2000): radii 0.71, 0.97 and 1.10 mm.
    let text = |media: &str, adventitia: &str| {
        format!(
            "{UNITS}tube = {{ diameter = 2.2 }}\n\
             [[layers]]\nthickness = 0.26\nresidual = {{ {media} }}\n\
             [[layers]]\nthickness = 0.13\nresidual = {{ {adventitia} }}\n"
        )
    };
    let openings = |text: &str| -> Vec<Opening> {
        let layers = layers(text);
        let own = layers.iter().map(|layer| layer.residual.opening.unwrap());
        own.collect()
    };
    let check = |found: &[Opening], shifts: [f64; 2]| {
        for (opening, shift) in found.iter().zip(shifts) {
            assert!((opening.fraction - 200.0 / 360.0).abs() < 1e-15);
            assert!((opening.shift * 2.2 - shift).abs() < 1e-12, "{opening:?}");
        }
    };
    let angle = "opening_degrees = 160.0";
    let given = format!("{angle}, opening_radius = 1.43");
    check(&openings(&text(&given, angle)), [0.72, 0.72]);
    // The middle radius of the wall, 0.905, becomes 9/5 of it.
    check(&openings(&text(angle, angle)), [0.724, 0.724]);
    // Two sectors: the middle radii of the layers are 0.84 and 1.035.
    let alone = format!("{angle}, opening_radius = 1.70");
    check(&openings(&text(angle, &alone)), [0.84 * 0.8, 0.73]);

    let one = |keys: &str| format!("[[layers]]\nthickness = 0.06\nresidual = {{ {keys} }}\n");
    for (keys, expected) in [
        (
            "opening_radius = 1.0",
            "opening_radius: needs opening_degrees; add opening_degrees",
        ),
        (
            "opening_degrees = 60.0, around = [0.9, 1.1]",
            "around: cannot be given together with opening_degrees; leave it out",
        ),
        (
            "opening_degrees = 60.0, opening_radius = 9.0",
            "opening_radius = 9.0: makes the stress-free length around 17.045 to 15.100 of that at rest; \
             it must be from 0.1 to 10",
        ),
    ] {
        let expected = format!("layers[1].residual.{expected}");
        assert_eq!(problem(&one(keys)), expected);
    }
}
