//! Broken lines.

use super::canvas::Place;

/// Cuts a run of places into strokes of `on`, `off` points apart, measured along the run.
pub(super) fn dashes(run: &[Place], (on, off): (f64, f64)) -> Vec<Vec<Place>> {
    let mut dashes = Vec::new();
    let mut dash: Vec<Place> = run.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, on);
    for ends in run.windows(2) {
        let (mut from, to) = (ends[0], ends[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                break;
            }
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            if drawing {
                dash.push(from);
                dashes.push(std::mem::take(&mut dash));
            } else {
                dash.push(from);
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        if drawing {
            dash.push(to);
        }
    }
    dashes.push(dash);
    dashes.retain(|d| d.len() > 1);
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_run_through_corners() {
        let run = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)];
        let got = dashes(&run, (2.0, 2.0));
        assert_eq!(
            got,
            [vec![(0.0, 0.0), (2.0, 0.0)], vec![(3.0, 1.0), (3.0, 3.0)]]
        );
    }
}
