//! Ranges of angles around the tube.

/// Returns the shortest arc that contains all angles of a cyclic sector, both in radians: its first angle from 0 to that of
/// the sector, and its last, which may lie beyond. The arc is the whole sector where neighbouring angles are nowhere more
/// than `spacing` apart. None without angles.
pub fn shortest_arc(
    angles: impl IntoIterator<Item = f64>,
    sector: f64,
    spacing: f64,
) -> Option<[f64; 2]> {
    let mut angles: Vec<f64> = angles.into_iter().map(|a| a.rem_euclid(sector)).collect();
    angles.sort_unstable_by(f64::total_cmp);
    let last = *angles.last()?;
    let (mut widest, mut arc) = (angles[0] + sector - last, [angles[0], last]);
    for pair in angles.windows(2) {
        if pair[1] - pair[0] > widest {
            widest = pair[1] - pair[0];
            arc = [pair[1], pair[0] + sector];
        }
    }
    Some(match widest > spacing {
        true => arc,
        false => [0.0, sector],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_may_contain_the_angle_zero() {
        let arc = |angles: &[f64]| shortest_arc(angles.iter().copied(), 6.0, 0.5);
        assert_eq!(arc(&[]), None);
        assert_eq!(arc(&[2.0]), Some([2.0, 2.0]));
        assert_eq!(arc(&[2.0, 1.0, 1.5]), Some([1.0, 2.0]));
        assert_eq!(arc(&[0.5, 5.75, 0.0]), Some([5.75, 6.5]));
        assert_eq!(arc(&[-0.25, 0.5, 0.0]), Some([5.75, 6.5]));
        let all = (0..24).map(|i| 0.25 * f64::from(i));
        assert_eq!(shortest_arc(all.clone(), 6.0, 0.5), Some([0.0, 6.0]));
        assert_eq!(
            shortest_arc(all.skip(2), 6.0, 0.5),
            Some([0.5, 5.75]),
            "a gap of three quarters"
        );
    }
}
