//! Finds the word that a misspelt one probably stands for.

/// Returns the nearest of some words, if one is near.
pub(super) fn nearest<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |w: &str| {
        w.to_lowercase()
            .replace(['-', ' '], "_")
            .replace(['µ', 'μ'], "u")
    };
    let written = plain(word);
    let letters = written.chars().count();
    let allowed = (letters / 3).max(1);
    let distance = |candidate: &str| {
        let candidate = plain(candidate);
        // The names of muscles may be long, and many.
        let is_far = candidate.chars().count().abs_diff(letters) > allowed;
        if is_far && !candidate.starts_with(&written) {
            return usize::MAX;
        }
        if candidate == written {
            return 0;
        }
        // `poisson` for `poisson_ratio`.
        if written.len() >= 3 && candidate.starts_with(&written) {
            return 1;
        }
        strsim::damerau_levenshtein(&written, &candidate)
    };
    let near: Vec<(usize, &str)> = words
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(d, _)| d <= allowed)
        .collect();
    let &(least, nearest) = near.iter().min_by_key(|(d, _)| *d)?;
    let as_near = near.iter().filter(|(d, _)| *d == least).count();
    // A short word that is as near to two words is near to none.
    (least == 0 || letters > 3 || as_near == 1).then_some(nearest)
}

/// Returns the target in a stage that another name for it, such as that of a column of the history, stands for.
pub(super) fn target(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if has(&["lumen"]) {
        return has(&["vol"]).then_some("lumen.volume_ratio");
    }
    let place = ["inner", "outer", "colon", "ileum"].map(|word| has(&[word]));
    let place = place.iter().position(|is_meant| *is_meant)?;
    let targets = match place {
        0 => ["inner-wall.pressure", "inner-wall.dead_load"],
        1 => ["outer-wall.pressure", "outer-wall.dead_load"],
        2 => ["colon.displacement", "colon.twist_degrees"],
        _ => ["ileum.displacement", "ileum.twist_degrees"],
    };
    let words: [&[&str]; 2] = match place {
        0 | 1 => [&["press"], &["dead"]],
        _ => [&["displ", "push", "move"], &["twist", "turn", "rot"]],
    };
    let which = [1, 0].into_iter().find(|&i| has(words[i]))?;
    Some(targets[which])
}

#[cfg(test)]
mod tests {
    use super::{nearest, target};

    #[test]
    fn columns_of_the_history_stand_for_the_targets_that_they_hold() {
        for (name, meant) in [
            ("inner_pressure", Some("inner-wall.pressure")),
            ("Outer-Pressure", Some("outer-wall.pressure")),
            ("inner_dead_load", Some("inner-wall.dead_load")),
            ("displacement_colon", Some("colon.displacement")),
            ("twist_deg_ileum", Some("ileum.twist_degrees")),
            ("lumen_volume", Some("lumen.volume_ratio")),
            ("pressure", None),
            ("inner", None),
            ("circular", None),
        ] {
            assert_eq!(target(name), meant, "{name}");
        }
    }

    #[test]
    fn a_misspelt_word_is_found_and_another_word_is_not() {
        let words = ["diameter", "length", "thickness", "poisson_ratio"];
        assert_eq!(nearest("diametre", words), Some("diameter"));
        assert_eq!(nearest("Length", words), Some("length"));
        assert_eq!(nearest("poisson", words), Some("poisson_ratio"));
        assert_eq!(nearest("poisson-ratio", words), Some("poisson_ratio"));
        assert_eq!(nearest("colour", words), None);
        assert_eq!(nearest("", words), None);
    }

    #[test]
    fn units_are_not_guessed_from_a_letter() {
        let (lengths, stresses) = (["m", "cm", "mm", "um"], ["Pa", "kPa", "MPa"]);
        assert_eq!(nearest("MM", lengths), Some("mm"));
        assert_eq!(nearest("µm", lengths), Some("um"));
        assert_eq!(nearest("nm", lengths), None);
        assert_eq!(nearest("kpa", stresses), Some("kPa"));
        assert_eq!(nearest("mpa", stresses), Some("MPa"));
        assert_eq!(nearest("GPa", stresses), None);
    }
}
