//! The residual stretches of the layers, or the sector to which they open.

use super::super::keys::Case;
use super::super::problem::Problems;
use crate::tube::{Opening, ResidualStretch, Tube};
use std::ops::RangeInclusive;

/// Residual stretches.
const ALLOWED: RangeInclusive<f64> = 0.1..=10.0;

/// Checks the residual stretches of the layers and returns them. `thickness` is that of the wall, in D.
pub(super) fn residuals(
    case: &Case,
    thickness: f64,
    problems: &mut Problems,
) -> Vec<ResidualStretch> {
    let diameter = case.tube.diameter;
    let mut faces = vec![Tube::OUTER_RADIUS - thickness];
    for layer in &case.layers {
        faces.push(faces[faces.len() - 1] + layer.thickness / diameter);
    }
    let mut found: Vec<ResidualStretch> = vec![];
    for (i, layer) in case.layers.iter().enumerate() {
        let (written, path) = (&layer.residual, format!("layers[{}].residual", i + 1));
        for (name, stretches) in [("around", written.around), ("along", written.along)] {
            let key = format!("{path}.{name}");
            if !stretches.iter().all(|x| ALLOWED.contains(x)) && problems.are_sound(&[&key]) {
                let rule = format!("must be from {} to {}", ALLOWED.start(), ALLOWED.end());
                problems.value(&key, rule, "try [0.9, 1.1]");
            }
        }
        let [angle, radius] =
            ["opening_degrees", "opening_radius"].map(|key| format!("{path}.{key}"));
        if written.opening_radius.is_some()
            && written.opening_degrees.is_none()
            && problems.are_sound(&[&angle, &radius])
        {
            problems.key(&radius, "needs opening_degrees", "add opening_degrees");
        }
        let around = format!("{path}.around");
        if written.opening_degrees.is_some()
            && problems.is_given(&around)
            && problems.are_sound(&[&angle, &around])
        {
            let rule = "cannot be given together with opening_degrees";
            problems.key(&around, rule, "leave it out");
        }
        let before = i.checked_sub(1).map(|i| &case.layers[i].residual);
        let opening = written.opening_degrees.map(|degrees| {
            let fraction = 1.0 - degrees / 360.0;
            let together = before.is_some_and(|b| b.opening_degrees == Some(degrees));
            let shift = match (written.opening_radius, together) {
                (Some(radius), _) => radius / diameter - faces[i],
                (None, true) => found[i - 1].opening.map_or(0.0, |opening| opening.shift),
                (None, false) => {
                    // The middle of the layers that open together keeps its length: R q = r.
                    let later = case.layers[i + 1..].iter().take_while(|layer| {
                        let later = &layer.residual;
                        later.opening_degrees == Some(degrees) && later.opening_radius.is_none()
                    });
                    let middle = 0.5 * (faces[i] + faces[i + 1 + later.count()]);
                    middle / fraction - middle
                }
            };
            Opening { fraction, shift }
        });
        let own = ResidualStretch {
            along: written.along,
            around: written.around,
            opening: opening.filter(|opening| opening.fraction < 1.0 || opening.shift != 0.0),
        };
        let stretches = [faces[i], faces[i + 1]].map(|r| own.at(0.0, r)[1]);
        let key = match written.opening_radius {
            Some(_) => &radius,
            None => &angle,
        };
        if own.opening.is_some()
            && !stretches.iter().all(|x| ALLOWED.contains(x))
            && problems.are_sound(&[key, "layers", "tube"])
        {
            let rule = format!(
                "makes the stress-free length around {:.3} to {:.3} of that at rest; it must be from {} to {}",
                stretches[0],
                stretches[1],
                ALLOWED.start(),
                ALLOWED.end()
            );
            problems.value(key, rule, "");
        }
        found.push(own);
    }
    found
}
