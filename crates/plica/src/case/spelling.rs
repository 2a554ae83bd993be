//! The word that was probably meant.

/// The nearest of some words, if one is near.
pub(super) fn nearest<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |w: &str| {
        w.to_lowercase()
            .replace(['-', ' '], "_")
            .replace(['µ', 'μ'], "u")
    };
    let written = plain(word);
    let letters = written.chars().count();
    let slips = (letters / 3).max(1);
    let distance = |candidate: &str| {
        let candidate = plain(candidate);
        // Names may be long, and many.
        let letters = candidate.chars().count();
        if letters.abs_diff(written.chars().count()) > slips && !candidate.starts_with(&written) {
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
    let near = words
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(d, _)| d <= slips);
    let (nearest, near) = near.fold(
        (None, 0),
        |(best, count): (Option<(usize, &str)>, _), next| match best {
            Some((least, _)) if least < next.0 => (best, count),
            Some((least, _)) if least == next.0 => (best, count + 1),
            _ => (Some(next), 1),
        },
    );
    // A few letters are as near to one unit as to another.
    let plain = |&(d, _): &(usize, &str)| d == 0 || letters > 3 || near == 1;
    nearest.filter(plain).map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_are_forgiven_and_other_words_are_not() {
        let words = ["diameter", "length", "thickness", "poisson_ratio"];
        assert_eq!(nearest("diametre", words), Some("diameter"));
        assert_eq!(nearest("Length", words), Some("length"));
        assert_eq!(nearest("poisson", words), Some("poisson_ratio"));
        assert_eq!(nearest("poisson-ratio", words), Some("poisson_ratio"));
        assert_eq!(nearest("colour", words), None);
        assert_eq!(nearest("", words), None);
    }
}
