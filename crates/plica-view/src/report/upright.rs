//! Which way is up in a picture of a tube that is not axisymmetric.

use plica::study::{Row, Scale};

/// Departure from axisymmetry, in D, that can be seen.
pub const VISIBLE: f64 = 2e-3;

/// The angle around the tube that points up in all pictures of some states, in radians: that of the crest of the largest wave
/// around that can be seen in any of them. A picture that moves, or shows several states, does not turn the tube.
pub fn upright<'a>(rows: impl IntoIterator<Item = &'a Row>, scale: &Scale) -> f64 {
    let largest = (rows.into_iter()).max_by(|a, b| a.asymmetry.total_cmp(&b.asymmetry));
    let visible = largest.filter(|row| row.asymmetry > VISIBLE * scale.length);
    visible.map_or(0.0, |row| row.asymmetry_angle_deg.to_radians())
}
