//! Limit points: positions at which a path turns back, so that its load has an extreme value.

use super::continuation::PreviousPoint;
use super::operator::dot;

/// Distance of an extrapolated limit point from the last state, over that of the position at which no state was found,
/// up to which the one explains the other.
const REACH: f64 = 1.5;

/// Returns the position t of a limit point, if two states of a path show that there is one between the last of them and
/// the position `failed`, at which no state was found.
///
/// At a limit point du/dt is infinite, but t is a smooth function of the distance s = v · (u − u₀) along the direction
/// v = du/dt of the last state, with slope dt/ds = 1/(v · du/dt). The slope is extrapolated linearly from both states to
/// zero. It does not fall at a bifurcation, at which du/dt remains bounded, nor before an element inverts.
pub(super) fn limit_point(
    previous: &PreviousPoint,
    t: f64,
    u: &[f64],
    tangent: &[f64],
    failed: f64,
) -> Option<f64> {
    let displacement: Vec<f64> = u.iter().zip(&previous.u).map(|(u, was)| u - was).collect();
    let distance = dot(tangent, &displacement);
    let [before, after] = [&previous.tangent[..], tangent].map(|du_dt| 1.0 / dot(tangent, du_dt));
    let ahead = 0.5 * after * after * distance / (before - after);
    (0.0 < after && after < before && 0.0 < ahead && ahead <= REACH * (failed - t))
        .then_some(t + ahead)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the limit point that the states at 0.5 and 0.6 of a path show, where t is a function of the first unknown
    /// and the second is 0.3 t, if no state was found at `failed`.
    fn found(u: fn(f64) -> f64, du_dt: fn(f64) -> f64, failed: f64) -> Option<f64> {
        let previous = PreviousPoint {
            t: 0.5,
            u: vec![u(0.5), 0.15],
            tangent: vec![du_dt(0.5), 0.3],
        };
        limit_point(&previous, 0.6, &[u(0.6), 0.18], &[du_dt(0.6), 0.3], failed)
    }

    #[test]
    fn a_path_that_turns_back_has_a_limit_point_where_its_slope_vanishes() {
        // t = 0.7 − (1 − u)², and with a sixth of the cube of 1 − u.
        let parabola = |failed| {
            found(
                |t| 1.0 - (0.7 - t).sqrt(),
                |t| 0.5 / (0.7 - t).sqrt(),
                failed,
            )
        };
        let limit = parabola(0.7).unwrap();
        assert!((limit - 0.7).abs() < 0.01, "{limit}");
        // The position at which no state was found need not be quite so far, but the limit point explains none that is
        // much nearer.
        assert!(parabola(0.68).is_some() && parabola(0.65).is_none());
    }

    #[test]
    fn a_path_that_does_not_turn_back_has_none() {
        // Constant, slowing down, and with a slope that would vanish at 0.9 only.
        assert_eq!(found(|t| t, |_| 1.0, 0.7), None);
        assert_eq!(found(|t| t.sqrt(), |t| 0.5 / t.sqrt(), 0.7), None);
        assert_eq!(
            found(|t| 1.0 - (0.9 - t).sqrt(), |t| 0.5 / (0.9 - t).sqrt(), 0.65),
            None
        );
        // A path whose direction turns by more than a right angle gives no slope.
        assert_eq!(
            found(|t| (t - 0.58).abs(), |t| 100.0 * (t - 0.58).signum(), 0.7),
            None
        );
    }
}
