//! Curves of mechanical tests of laws: charts and tables.

use crate::draw::{Chart, Curve, Stroke};
use plica::homogeneous::{Homogeneous, MechanicalTest, Volume, curve};
use plica::material::Material;

/// Points of a curve on either side of rest.
const POINTS: usize = 60;
/// Largest nominal stress of a curve, over its slope at rest: stiffening laws grow without bounds.
const STEEPEST: f64 = 5.0;

/// A law with its name in a chart.
#[derive(Clone, Debug)]
pub struct NamedLaw {
    /// Its name; may be empty if it is the only one.
    pub name: String,
    /// The law.
    pub material: Material,
}

/// A chart of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawChart {
    /// Nominal stress over stretch in uniaxial and equibiaxial tension.
    Tension,
    /// p R/H over the stretch around of a thin tube of constant length.
    Inflation,
}

/// A curve of a law: the driven stretches and states of a test.
#[derive(Clone, Debug)]
pub struct LawCurve {
    /// The test.
    pub test: MechanicalTest,
    /// The states, in the order of the driven stretch.
    pub states: Vec<Homogeneous>,
}

/// Returns the curves of all tests of a law between two stretches on either side of 1, or as far as the law has states whose
/// stress is not far above the others.
pub fn law_curves(law: &Material, range: [f64; 2], volume: Volume) -> Vec<LawCurve> {
    let states = |test: MechanicalTest| {
        let nominal = |state: &Homogeneous| state.nominal()[test.direction()];
        let side = |end: f64| {
            let at = |i: usize| 1.0 + (end - 1.0) * i as f64 / POINTS as f64;
            curve(law, test, (0..=POINTS).map(at), volume)
        };
        let [mut below, mut above] = range.map(side);
        if let [rest, first, ..] = &above[..] {
            let step = first.stretches[test.direction()] - 1.0;
            let rest = nominal(rest);
            let largest = STEEPEST * (nominal(first) - rest) / step;
            for side in [&mut below, &mut above] {
                let end = side
                    .iter()
                    .position(|s| (nominal(s) - rest).abs() > largest);
                side.truncate(end.unwrap_or(side.len()));
            }
        }
        below.drain(..1.min(below.len()));
        below.reverse();
        below.append(&mut above);
        below
    };
    let tests = MechanicalTest::ALL.into_iter();
    tests
        .map(|test| LawCurve {
            test,
            states: states(test),
        })
        .collect()
}

/// Returns a chart of laws. `unit` is that of their stresses.
pub fn law_chart(
    what: LawChart,
    laws: &[NamedLaw],
    range: [f64; 2],
    volume: Volume,
    unit: &str,
) -> Chart {
    let mut curves = vec![];
    for (i, law) in laws.iter().enumerate() {
        for own in law_curves(&law.material, range, volume) {
            for (direction, name, stroke) in lines(what, own.test) {
                let point = |state: &Homogeneous| match what {
                    LawChart::Tension => (state.stretches[direction], state.nominal()[direction]),
                    LawChart::Inflation => (state.stretches[2], state.thin_tube_pressure()),
                };
                let label = match (&law.name[..], name) {
                    ("", name) => name.to_owned(),
                    (law, "") => law.to_owned(),
                    (law, name) => format!("{law}, {name}"),
                };
                curves.push(Curve {
                    label,
                    points: own.states.iter().map(point).collect(),
                    colour: if laws.len() > 1 { i } else { curves.len() },
                    stroke,
                    dots: false,
                });
            }
        }
    }
    let (x_label, y_label) = match what {
        LawChart::Tension => ("stretch", format!("nominal stress ({unit})")),
        LawChart::Inflation => ("stretch around", format!("*p* *R*/*H* ({unit})")),
    };
    Chart {
        x_label: x_label.into(),
        y_label,
        curves,
        ..Chart::default()
    }
}

/// Returns the lines of a test in a chart: direction of the stress, name and stroke.
fn lines(what: LawChart, test: MechanicalTest) -> Vec<(usize, &'static str, Stroke)> {
    match (what, test) {
        (LawChart::Tension, MechanicalTest::UniaxialAround) => vec![(2, "around", Stroke::Solid)],
        (LawChart::Tension, MechanicalTest::UniaxialAlong) => vec![(0, "along", Stroke::Dashed)],
        (LawChart::Tension, MechanicalTest::Equibiaxial) => vec![
            (2, "equibiaxial, around", Stroke::Thin),
            (0, "equibiaxial, along", Stroke::Thin),
        ],
        (LawChart::Inflation, MechanicalTest::StripAround) => vec![(2, "", Stroke::Solid)],
        _ => vec![],
    }
}

/// Returns the header and the rows of all curves of laws, as text. `unit` is that of their stresses.
pub fn law_table(
    laws: &[NamedLaw],
    range: [f64; 2],
    volume: Volume,
    unit: &str,
) -> Vec<Vec<String>> {
    let mut header: Vec<String> = ["material", "test"].map(String::from).into();
    let directions = ["along", "outwards", "around"];
    header.extend(directions.map(|direction| format!("stretch_{direction}")));
    for kind in ["nominal", "cauchy"] {
        header.extend(["along", "around"].map(|way| format!("{kind}_stress_{way}_{unit}")));
    }
    header.push(format!("thin_tube_pressure_{unit}"));
    let mut rows = vec![header];
    for law in laws {
        for own in law_curves(&law.material, range, volume) {
            for state in &own.states {
                let (nominal, cauchy) = (state.nominal(), state.cauchy);
                let mut numbers = state.stretches.to_vec();
                numbers.extend([nominal[0], nominal[2], cauchy[0], cauchy[2]]);
                numbers.push(state.thin_tube_pressure());
                let mut row = vec![law.name.clone(), own.test.name().into()];
                row.extend(numbers.iter().map(|x| format!("{x:.9e}")));
                rows.push(row);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use plica::case::library;
    use plica::material::{NeoHookean, Volumetric};

    #[test]
    fn curves_of_a_material_are_drawn_and_written() {
        let mu = 0.7;
        let law = Material::NeoHookean(NeoHookean {
            mu,
            lambda: 50.0,
            volumetric: Volumetric::Quadratic,
        });
        let laws = [NamedLaw {
            name: String::new(),
            material: law,
        }];
        let range = [0.8, 1.5];
        let rows = law_table(&laws, range, Volume::Constant, "kPa");
        assert_eq!(rows.len(), 1 + 5 * (2 * POINTS + 1));
        let column = |name: &str| rows[0].iter().position(|n| n == name).unwrap();
        for row in rows.iter().filter(|row| row[1] == "uniaxial-around") {
            let number = |name: &str| row[column(name)].parse::<f64>().unwrap();
            let x = number("stretch_around");
            let expected = mu * (x - x.powi(-2));
            assert!((number("nominal_stress_around_kPa") - expected).abs() < 1e-8);
            assert!(number("nominal_stress_along_kPa").abs() < 1e-8);
        }
        for (what, count) in [(LawChart::Tension, 4), (LawChart::Inflation, 1)] {
            let chart = law_chart(what, &laws, range, Volume::Constant, "kPa");
            assert_eq!(chart.curves.len(), count);
            assert!(chart.svg().unwrap().contains("(kPa)"));
        }
    }

    #[test]
    fn every_material_of_the_library_has_curves() {
        for material in library() {
            let curves = law_curves(&material.material, [0.8, 1.5], Volume::Constant);
            assert!(
                curves.iter().all(|c| c.states.len() > POINTS / 4),
                "{}",
                material.name
            );
        }
    }
}
