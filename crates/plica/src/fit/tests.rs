//! Fits of curves with known parameters, and of tables.

use super::*;
use crate::homogeneous::{MechanicalTest, Prescribed, Volume, homogeneous};
use crate::study::StressUnit;

/// Returns the stresses of a law in tension along and around, and in biaxial tension, with errors of a size.
fn measured(law: FittedLaw, values: &[f64], size: f64) -> Vec<Measurement> {
    let material = law.material(values);
    let mut all = vec![];
    // Numbers between −1 and 1 with the mean zero.
    let mut phase = 0.0_f64;
    for test in MechanicalTest::ALL {
        for step in 1..=4 {
            let prescribed = test.prescribed(1.0 + 0.075 * f64::from(step));
            let state = homogeneous(&material, prescribed, Volume::Constant).unwrap();
            for (direction, given) in [(0, prescribed.along), (2, prescribed.around)] {
                if given.is_some() {
                    phase += 2.4;
                    all.push(Measurement {
                        prescribed,
                        direction,
                        kind: StressKind::Nominal,
                        stress: state.nominal()[direction] + size * phase.sin(),
                    });
                }
            }
        }
    }
    all
}

#[test]
fn parameters_of_exact_curves_are_found_again() {
    for (law, values) in [
        (FittedLaw::NeoHookean, vec![12.0]),
        (FittedLaw::Yeoh, vec![5.0, 3.0, 2.0]),
        (FittedLaw::Demiray, vec![8.0, 2.5]),
        (FittedLaw::Gent, vec![9.0, 1.4]),
        (FittedLaw::Fung, vec![20.0, 1.1, 2.3, 0.4]),
        (FittedLaw::Hgo, vec![3.0, 2.3632, 0.8393, 29.0]),
        (FittedLaw::Goh, vec![14.3, 290.22, 4.87, 35.01, 0.224]),
    ] {
        let found = fit(law, &measured(law, &values, 0.0)).unwrap();
        for (parameter, value) in found.parameters.iter().zip(&values) {
            let off = (parameter.value / value - 1.0).abs();
            assert!(
                off < 1e-4,
                "{law:?} {}: {}",
                parameter.name,
                parameter.value
            );
        }
        assert!(found.determination > 1.0 - 1e-9, "{law:?}");
    }
}

#[test]
fn standard_errors_are_those_of_linear_regression() {
    // The stress of the neo-Hookean law is μ times a known function g: the error of μ is s/√Σg².
    let law = FittedLaw::NeoHookean;
    let data = measured(law, &[12.0], 0.5);
    let found = fit(law, &data).unwrap();
    let unit = law.material(&[1.0]);
    let g = data.iter().map(|m| {
        let state = homogeneous(&unit, m.prescribed, Volume::Constant).unwrap();
        (state.nominal()[m.direction], m.stress)
    });
    let (mut gg, mut gs, mut ss) = (0.0, 0.0, 0.0);
    for (g, s) in g {
        gg += g * g;
        gs += g * s;
        ss += s * s;
    }
    let mu = gs / gg;
    let squares = ss - mu * gs;
    let error = (squares / (data.len() - 1) as f64 / gg).sqrt();
    let parameter = &found.parameters[0];
    assert!((parameter.value / mu - 1.0).abs() < 1e-7);
    assert!((parameter.standard_error.unwrap() / error - 1.0).abs() < 1e-4);
    assert!((found.deviation / (squares / data.len() as f64).sqrt() - 1.0).abs() < 1e-6);
    assert!(found.determination < 1.0 && found.stresses == data.len());
}

#[test]
fn a_table_is_read_with_its_units_and_its_mistakes_have_a_place() {
    let text = "# rabbit\nstretch_along, stretch_around, cauchy_stress_along_kPa, cauchy_stress_around_kPa\n\
        1.1, 1.2, 3.0, 4.0\n, 1.3,, 5.0\n";
    let table = Measurements::read(text).unwrap();
    assert_eq!(
        (table.unit, table.all.len()),
        (Some(StressUnit::Kilopascal), 3)
    );
    let last = Measurement {
        prescribed: Prescribed {
            along: None,
            around: Some(1.3),
        },
        direction: 2,
        kind: StressKind::Cauchy,
        stress: 5.0,
    };
    assert_eq!(table.all[2], last);
    for (text, expected) in [
        ("stretch_around,stress\n", "column `stress`: "),
        (
            "stretch_around,nominal_stress_around_psi\n",
            "column `nominal_stress_around_psi`: ",
        ),
        ("stretch_around\n", "the table has no column of a stress"),
        (
            "nominal_stress_around\n",
            "the table has no column of a stretch",
        ),
        (
            "stretch_around,nominal_stress_around_Pa,nominal_stress_along_kPa\n",
            "the stresses are in several units: use one",
        ),
        (
            "stretch_around,nominal_stress_around\n1.1,x\n",
            "line 2, nominal_stress_around: `x` is no number",
        ),
        (
            "stretch_around,nominal_stress_around\n1.1,2.0\n110,3.0\n",
            "line 3, stretch_around: `110` is not from 0.05 to 20 (1 is the length at rest)",
        ),
        (
            "stretch_around,nominal_stress_along\n1.1,2.0\n",
            "line 2: a row needs a stretch and a stress in the same direction",
        ),
    ] {
        let error = Measurements::read(text).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
    let few = fit(FittedLaw::Hgo, &table.all).unwrap_err().to_string();
    assert_eq!(
        few,
        "3 stresses cannot determine 4 parameters: at least 5 are needed"
    );
}
