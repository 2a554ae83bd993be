//! The laws of the wall, and their active tension.

use super::super::keys::{self, Case, Law};
use super::super::problem::Problems;
use crate::material::{LengthTension, Tone};

/// Returns Young's modulus E in the units of the case, in which stresses are measured: of several layers the largest.
pub(super) fn youngs_modulus(case: &Case) -> f64 {
    let own = |law: &Law| match law {
        Law::NeoHookean(law) => match law.shear_modulus {
            Some(mu) if law.bulk.is_some() => 3.0 * mu,
            _ => law.youngs_modulus,
        },
        Law::MooneyRivlin(law) => law.youngs_modulus,
        Law::Yeoh(law) => 6.0 * law.c1,
        Law::Demiray(law) => 3.0 * law.shear_modulus,
        Law::Gent(law) => 3.0 * law.shear_modulus,
        // A form that is not positive definite is refused.
        Law::Fung(law) => {
            0.75 * law.c * (law.along + law.around - 2.0 * law.along_around).max(1e-9)
        }
    };
    let laws = case.layers.iter().map(|layer| layer.material.as_ref());
    let largest = laws.map(|law| own(&law.unwrap_or(&case.material).law));
    largest.reduce(f64::max).unwrap_or(own(&case.material.law))
}

/// Returns an active tension in E. `path` is its place in the case.
pub(super) fn tone(
    tone: &keys::Tone,
    path: &str,
    case: &Case,
    problems: &mut Problems,
) -> Option<Tone> {
    let tension = tone.tension / youngs_modulus(case);
    let stretches = [tone.best_stretch, tone.least_stretch, tone.width];
    let relation = relation(stretches, tone.table.as_ref(), path, problems)?;
    (tension > 0.0).then(|| Tone::new(tension, relation, tone.angle_degrees.to_radians()))
}

/// Returns the dependence of a tension on the stretch, from the best and the least stretch and the width, and the table;
/// none if the keys do not fit together.
pub(super) fn relation(
    [best_stretch, least_stretch, width]: [Option<f64>; 3],
    table: Option<&Vec<[f64; 2]>>,
    path: &str,
    problems: &mut Problems,
) -> Option<LengthTension> {
    let key = |name: &str| format!("{path}.{name}");
    let given = [
        ("best_stretch", best_stretch.is_some()),
        ("least_stretch", least_stretch.is_some()),
        ("width", width.is_some()),
        ("table", table.is_some()),
    ];
    // A key that cannot be read is not as if it were left out.
    if given
        .iter()
        .any(|(name, _)| !problems.are_sound(&[&key(name)]))
    {
        return None;
    }
    let given: Vec<&str> = given.iter().filter(|key| key.1).map(|key| key.0).collect();
    match (best_stretch, least_stretch, width, table) {
        (None, None, None, None) => Some(LengthTension::Constant),
        (Some(best), Some(least), None, None) => {
            if best < least + 1e-3 {
                let rule = "must be above least_stretch by 0.001 or more";
                problems.value(&key("best_stretch"), rule, "");
            }
            Some(LengthTension::Rachev { best, least })
        }
        (Some(best), None, Some(width), None) => Some(LengthTension::Gaussian { best, width }),
        (None, None, None, Some(points)) => {
            if let Some(rule) = rule_broken_by(points) {
                let help = "try [[0.6, 0.0], [1.2, 1.0], [1.6, 0.5]]";
                problems.value(&key("table"), rule, help);
                return None;
            }
            Some(LengthTension::Table(points.clone()))
        }
        (Some(_), None, None, None) => {
            let help = "add least_stretch or width";
            problems.key(&key("best_stretch"), "needs least_stretch or width", help);
            None
        }
        (None, _, _, None) => {
            problems.key(&key(given[0]), "needs best_stretch", "add best_stretch");
            None
        }
        _ => {
            let rule = format!(
                "only one of {} may be given",
                given[given.len() - 2..].join(" and ")
            );
            problems.key(&key(given[given.len() - 1]), rule, "");
            None
        }
    }
}

fn rule_broken_by(points: &[[f64; 2]]) -> Option<&'static str> {
    if !(2..=1000).contains(&points.len()) {
        Some("must have from 2 to 1000 points")
    } else if !points.is_sorted_by(|a, b| a[0] < b[0]) || points[0][0] < 0.0 {
        Some("stretches must rise from 0 or more")
    } else if points.iter().any(|point| !(0.0..=10.0).contains(&point[1])) {
        Some("the stress over T must be from 0 to 10")
    } else {
        None
    }
}
