//! Circumferential harmonics in words.

/// What a harmonic does to a tube.
pub fn effect(harmonic: usize) -> String {
    match harmonic {
        0 => "swells, or tilts along z".into(),
        1 => "tilts sideways".into(),
        2 => "turns oval".into(),
        n => format!("folds into {n} lobes"),
    }
}

/// A harmonic as a row of the history names it: by its number, or `any`.
pub fn named(harmonic: &str) -> String {
    match harmonic.parse() {
        Ok(n) => format!("harmonic {n} ({})", effect(n)),
        Err(_) => "its own lowest mode".into(),
    }
}
