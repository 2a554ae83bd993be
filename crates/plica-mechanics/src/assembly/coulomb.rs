//! The law of friction: Coulomb's, smoothed over a small elastic slip.

/// Largest elastic slip ε, in ranges of contact.
pub const ELASTIC_SLIP: f64 = 0.1;

/// Friction force over the slip s of a point that sticks to a place by an elastic slip of at most ε: per unit of its limit
/// μλ it is f₁(s) = 2 s/ε − (s/ε)², and 1 from ε on. f₁ is the derivative of f₀ (Li et al. 2020, incremental potential
/// contact), which has continuous second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// f₀, zero without slip, in D.
    pub energy: f64,
    /// f₁/s, in 1/D.
    pub secant: f64,
    /// (f₁′ − f₁/s)/s², in 1/D³: the second derivative of f₀(|s|) is the secant times the identity, plus this times s ⊗ s.
    pub second: f64,
}

impl Slip {
    /// Evaluates the law at a slip, for a largest elastic slip.
    pub fn at(slip: f64, elastic: f64) -> Self {
        let part = slip / elastic;
        if part < 1.0 {
            // The second derivative is finite, and vanishes with s ⊗ s at no slip.
            let second = -1.0 / (elastic * elastic * slip.max(1e-12 * elastic));
            Self {
                energy: slip * part * (1.0 - part / 3.0),
                secant: (2.0 - part) / elastic,
                second,
            }
        } else {
            Self {
                energy: slip - elastic / 3.0,
                secant: 1.0 / slip,
                second: -1.0 / (slip * slip * slip),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTIC: f64 = 1e-3;

    #[test]
    fn force_and_stiffness_are_derivatives_of_the_energy() {
        for slip in [1e-6, 3e-4, 9.9e-4, 1.3e-3, 0.2] {
            let h = 1e-4 * slip;
            let [low, high] = [slip - h, slip + h].map(|s| (s, Slip::at(s, ELASTIC)));
            let at = Slip::at(slip, ELASTIC);
            let force = (high.1.energy - low.1.energy) / (2.0 * h);
            assert!((force - at.secant * slip).abs() < 1e-6, "{slip}");
            let force = |(s, slip): (f64, Slip)| s * slip.secant;
            let stiffness = (force(high) - force(low)) / (2.0 * h);
            let exact = at.secant + slip * slip * at.second;
            assert!((stiffness - exact).abs() < 1e-6 / ELASTIC, "{slip}");
        }
    }

    #[test]
    fn the_force_is_bounded_by_its_limit_and_continuous_where_sliding_begins() {
        let [before, after] = [-1e-12, 1e-12].map(|h| Slip::at(ELASTIC + h, ELASTIC));
        assert!((before.energy / after.energy - 1.0).abs() < 1e-8);
        assert!((before.secant / after.secant - 1.0).abs() < 1e-8);
        assert!((before.second / after.second - 1.0).abs() < 1e-8);
        assert_eq!(Slip::at(0.0, ELASTIC).energy, 0.0);
        for slip in [0.0, 5e-4, 1e-3, 0.1] {
            assert!(slip * Slip::at(slip, ELASTIC).secant <= 1.0);
        }
    }
}
