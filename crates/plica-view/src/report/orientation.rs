//! Orientation of a tube that is not axisymmetric in pictures.

use plica::study::{Row, Scale};

/// Smallest visible asymmetry, in units of D.
pub(crate) const VISIBLE_ASYMMETRY: f64 = 2e-3;

/// Returns the angle around the tube that points up in all pictures of the given states, in radians: the crest of the largest
/// visible asymmetry. A common angle keeps the tube from rotating between states.
pub(crate) fn upward_angle<'a>(rows: impl IntoIterator<Item = &'a Row>, scale: &Scale) -> f64 {
    let largest = (rows.into_iter()).max_by(|a, b| a.asymmetry.total_cmp(&b.asymmetry));
    let visible = largest.filter(|row| row.asymmetry > VISIBLE_ASYMMETRY * scale.length);
    visible.map_or(0.0, |row| row.asymmetry_angle_deg.to_radians())
}
