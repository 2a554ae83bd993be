//! Muscles: the zones of the wall that contract or relax, with direction and amount.
//!
//! A muscle changes the stress-free state of the wall (Rodriguez et al. 1994; Okino et al. 2025,
//! Eqs. (1)–(3)): F = Fe · Fp, Fp = θζ ζ⊗ζ + θη η⊗η + ξ⊗ξ. Over a zone [a, b] with profile s(z):
//!
//! - circular: θη(z) = 1 − (1 − Dmin/D) s(z)/max s, driven by the diameter ratio Dmin/D;
//! - longitudinal: θζ(z) = 1 + (Lmax/L − 1) L/∫s dz · s(z), driven by the length ratio Lmax/L,
//!   so that the grown tube is Lmax long.
//!
//! A driven shift c moves the zone along the tube: s(z − c) takes the place of s(z). A zone with repeats is there at
//! every distance d from itself, so that a shift makes a travelling wave. Where several muscles of a direction act at a
//! point, their θ multiply.
//!
//! A muscle with an active stress changes the stress instead. Its target is the tension T of its fibres, which adds
//! the energy T s(z)/max s · w(λ) of their stretch λ, with the law w of [`Tone`].
//!
//! | letter | meaning | unit | Rust |
//! |---|---|---|---|
//! | ζ, η, ξ | along, around, through the wall | – | [`Direction`] |
//! | θζ, θη | grown over ungrown length | – | [`Muscle::stretch`] |
//! | s | profile, 0 to 1 | – | [`Profile::value`] |
//! | a, b | ends of the zone | D | [`Muscle::zone`] |
//! | c | shift of the zone | D | [`crate::tube::Load::shifts`] |
//! | d | distance between repeats | D | [`Muscle::repeat`] |
//! | T | tension | E | [`Muscle::active_stress`] |

mod angular_sector;
mod profile;

pub use angular_sector::{AngularSector, smooth_rise};
pub use profile::Profile;

use crate::material::{LengthTension, Tone};

/// The direction in which a muscle shortens or lengthens the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Around the tube (η).
    Circular,
    /// Along the tube (ζ).
    Longitudinal,
}

/// A quantity that a stage drives a muscle to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MuscleTarget {
    /// Dmin/D of a circular muscle.
    DiameterRatio,
    /// Lmax/L of a longitudinal muscle.
    LengthRatio,
    /// The tension of a muscle with an active stress, in E.
    Tension,
}

impl MuscleTarget {
    /// Returns its value at rest.
    pub fn at_rest(self) -> f64 {
        match self {
            Self::DiameterRatio | Self::LengthRatio => 1.0,
            Self::Tension => 0.0,
        }
    }

    /// Returns its name in a case.
    pub fn name(self) -> &'static str {
        match self {
            Self::DiameterRatio => "diameter_ratio",
            Self::LengthRatio => "length_ratio",
            Self::Tension => "tension",
        }
    }
}

/// One muscle of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Muscle {
    /// Its name in the case file.
    pub name: String,
    /// Its direction.
    pub direction: Direction,
    /// Ends of the zone along the tube, in D, before any shift.
    pub zone: [f64; 2],
    /// Distance between repeats of the zone along the tube, in D, at least the length of the zone; none for one zone.
    pub repeat: Option<f64>,
    /// Distribution of the activity over the zone.
    pub profile: Profile,
    /// Sector of the circumference that it acts in; none for all around. Its function multiplies θ − 1, or the tension.
    pub sector: Option<AngularSector>,
    /// Energy of its fibres per tension, of a muscle that changes the stress; none for one that changes the stress-free
    /// state.
    pub active_stress: Option<Tone>,
}

impl Muscle {
    /// A muscle on one zone, in all layers and all around the tube.
    pub fn new(name: String, direction: Direction, zone: [f64; 2], profile: Profile) -> Self {
        Self {
            name,
            direction,
            zone,
            repeat: None,
            profile,
            sector: None,
            active_stress: None,
        }
    }

    /// Returns the same muscle with an active stress in place of its growth, by a relation of tension and stretch. Its
    /// fibres have an angle from the circumference toward the axis, in radians.
    #[must_use]
    pub fn with_active_stress(self, relation: LengthTension, angle: f64) -> Self {
        Self {
            active_stress: Some(Tone::new(1.0, relation, angle)),
            ..self
        }
    }

    /// Returns the quantity that a stage drives it to.
    pub fn target(&self) -> MuscleTarget {
        match (&self.active_stress, self.direction) {
            (Some(_), _) => MuscleTarget::Tension,
            (None, Direction::Circular) => MuscleTarget::DiameterRatio,
            (None, Direction::Longitudinal) => MuscleTarget::LengthRatio,
        }
    }

    /// Returns true if it changes the stress-free state of the wall.
    pub fn grows(&self) -> bool {
        self.active_stress.is_none()
    }

    /// Returns s(z)/max s at a place that [`Muscle::unshifted`] returns.
    pub fn activity(&self, z: f64) -> f64 {
        let [a, b] = self.zone;
        if z < a || z > b {
            return 0.0;
        }
        self.profile.value((z - a) / (b - a)) / self.profile.largest()
    }

    /// Returns the place z − c in the zone before its shift, or between it and its next repeat.
    pub fn unshifted(&self, z: f64, shift: f64) -> f64 {
        let (z, from) = (z - shift, self.zone[0]);
        self.repeat
            .map_or(z, |distance| from + (z - from).rem_euclid(distance))
    }

    /// Returns the grown stretch θ at a place that [`Muscle::unshifted`] returns, for a target ratio (Dmin/D, or Lmax/L
    /// by one whole zone) and the length of the tube. It is one for a muscle with an active stress.
    pub fn stretch(&self, z: f64, ratio: f64, length: f64) -> f64 {
        let [a, b] = self.zone;
        if z < a || z > b {
            return 1.0;
        }
        1.0 + self.amplitude(ratio, length) * self.profile.value((z - a) / (b - a))
    }

    /// Returns θ − 1 where the profile is one.
    fn amplitude(&self, ratio: f64, length: f64) -> f64 {
        let [a, b] = self.zone;
        match self.target() {
            MuscleTarget::DiameterRatio => (ratio - 1.0) / self.profile.largest(),
            MuscleTarget::LengthRatio => {
                (ratio - 1.0) * length / ((b - a) * self.profile.integral())
            }
            MuscleTarget::Tension => 0.0,
        }
    }

    /// Returns the target ratio at which θ is `stretch` where the profile is largest.
    pub fn ratio_of(&self, stretch: f64, length: f64) -> f64 {
        match self.direction {
            Direction::Circular => stretch,
            Direction::Longitudinal => {
                1.0 + (stretch - 1.0) / (self.extreme_stretch(2.0, length) - 1.0)
            }
        }
    }

    /// Returns the θ in the zone that is furthest from one, for a target ratio.
    pub fn extreme_stretch(&self, ratio: f64, length: f64) -> f64 {
        1.0 + self.amplitude(ratio, length) * self.profile.largest()
    }

    /// Returns the smallest θ in the zone for a target ratio.
    pub fn smallest_stretch(&self, ratio: f64, length: f64) -> f64 {
        1.0 + (self.amplitude(ratio, length) * self.profile.largest()).min(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::gauss_legendre;

    fn muscle(direction: Direction, profile: Profile) -> Muscle {
        Muscle::new("m".into(), direction, [0.5, 1.0], profile)
    }

    #[test]
    fn the_grown_tube_has_the_target_length() {
        let table = Profile::Table(vec![(0.0, 0.0), (0.25, 1.0), (0.75, 0.5), (1.0, 0.0)]);
        for profile in [
            Profile::RaisedCosine,
            Profile::HalfSine,
            Profile::SmoothBox { edge: 0.2 },
            table,
        ] {
            let m = muscle(Direction::Longitudinal, profile);
            let mut grown = 0.0;
            for i in 0..600 {
                for (x, w) in gauss_legendre(4) {
                    grown += 0.005 * w * m.stretch(0.005 * (f64::from(i) + x), 1.25, 3.0);
                }
            }
            assert!((grown - 3.75).abs() < 1e-8, "{:?}: {grown}", m.profile);
        }
    }

    #[test]
    fn the_main_case_grows_to_four_and_contracts_to_a_quarter() {
        let relaxed = muscle(Direction::Longitudinal, Profile::RaisedCosine);
        assert!((relaxed.stretch(0.75, 1.25, 3.0) - 4.0).abs() < 1e-14);
        let contracted = muscle(Direction::Circular, Profile::RaisedCosine);
        assert!((contracted.stretch(0.75, 0.25, 3.0) - 0.25).abs() < 1e-14);
        assert_eq!(contracted.stretch(0.49, 0.25, 3.0), 1.0);
        let low = Profile::Table(vec![(0.0, 0.0), (0.5, 0.1), (1.0, 0.0)]);
        let contracted = muscle(Direction::Circular, low);
        assert!((contracted.stretch(0.75, 0.25, 3.0) - 0.25).abs() < 1e-14);
        assert!((contracted.smallest_stretch(0.25, 3.0) - 0.25).abs() < 1e-14);
    }

    #[test]
    fn an_active_stress_leaves_the_stress_free_state_and_has_an_activity() {
        let table = Profile::Table(vec![(0.0, 0.0), (0.5, 0.4), (1.0, 0.0)]);
        for direction in [Direction::Circular, Direction::Longitudinal] {
            let m = muscle(direction, table.clone());
            assert!(m.grows() && m.target().at_rest() == 1.0);
            let m = m.with_active_stress(LengthTension::Constant, 0.0);
            assert_eq!(m.target(), MuscleTarget::Tension);
            assert!(!m.grows() && m.target().at_rest() == 0.0);
            assert_eq!([0.6, 0.75].map(|z| m.stretch(z, 0.3, 3.0)), [1.0; 2]);
            for (z, activity) in [(0.4, 0.0), (0.625, 0.5), (0.75, 1.0), (1.1, 0.0)] {
                assert!((m.activity(z) - activity).abs() < 1e-14, "{z}");
            }
        }
    }

    #[test]
    fn a_zone_is_shifted_and_repeated() {
        let mut m = muscle(Direction::Circular, Profile::RaisedCosine);
        let at = |m: &Muscle, z: f64, shift| m.stretch(m.unshifted(z, shift), 0.25, 3.0);
        for (z, shift, theta) in [(0.75, 0.0, 0.25), (0.75, 0.5, 1.0), (1.25, 0.5, 0.25)] {
            assert!((at(&m, z, shift) - theta).abs() < 1e-14, "{z} {shift}");
        }
        m.repeat = Some(0.8);
        // In the zone at 0.5, in the gap, in the repeats at 1.3 and −0.3, and the same with the shift of a repeat.
        for shift in [0.0, 0.8, -1.6] {
            for (z, theta) in [(0.75, 0.25), (1.15, 1.0), (1.55, 0.25), (-0.05, 0.25)] {
                assert!((at(&m, z, shift) - theta).abs() < 1e-12, "{z} {shift}");
            }
        }
    }

    #[test]
    fn a_target_gives_the_stretch_that_it_was_made_from() {
        for direction in [Direction::Circular, Direction::Longitudinal] {
            let m = muscle(direction, Profile::Table(vec![(0.0, 0.2), (1.0, 0.7)]));
            for stretch in [0.3, 1.0, 1.8] {
                let ratio = m.ratio_of(stretch, 3.0);
                assert!((m.extreme_stretch(ratio, 3.0) - stretch).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_extreme_stretch_is_the_one_furthest_from_one() {
        let table = Profile::Table(vec![(0.0, 0.0), (0.25, 0.5), (0.75, 0.1), (1.0, 0.2)]);
        for profile in [Profile::HalfSine, table] {
            for direction in [Direction::Circular, Direction::Longitudinal] {
                let m = muscle(direction, profile.clone());
                for ratio in [0.9, 1.2] {
                    let stretches = (0..=1000).map(|i| m.stretch(0.001 * f64::from(i), ratio, 3.0));
                    let far = stretches.reduce(|a, b| {
                        if (b - 1.0).abs() > (a - 1.0).abs() {
                            b
                        } else {
                            a
                        }
                    });
                    let (far, found) = (far.unwrap(), m.extreme_stretch(ratio, 3.0));
                    assert!((far - found).abs() < 1e-4, "{m:?} {ratio}: {far} {found}");
                    let least = m.smallest_stretch(ratio, 3.0);
                    assert_eq!(least, found.min(1.0));
                }
            }
        }
    }

    #[test]
    fn a_muscle_acts_on_its_zone_with_its_edges_and_nowhere_else() {
        let level = Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]);
        let m = muscle(Direction::Circular, level);
        for (z, theta) in [(0.4999, 1.0), (0.5, 0.8), (1.0, 0.8), (1.0001, 1.0)] {
            assert!((m.stretch(z, 0.8, 3.0) - theta).abs() < 1e-15, "{z}");
        }
    }
}
