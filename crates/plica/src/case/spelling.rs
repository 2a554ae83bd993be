//! The word that was probably meant.

/// The nearest of some words, if one is near.
pub(super) fn nearest<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |w: &str| w.to_lowercase().replace(['-', ' '], "_");
    let written = plain(word);
    let slips = (written.chars().count() / 3).max(1);
    let distance = |candidate: &str| {
        let candidate = plain(candidate);
        // `poisson` for `poisson_ratio`.
        if written.len() >= 3 && candidate.starts_with(&written) {
            return 1;
        }
        strsim::damerau_levenshtein(&written, &candidate)
    };
    words
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|&(d, _)| d <= slips)
        .min_by_key(|&(d, _)| d)
        .map(|(_, candidate)| candidate)
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
