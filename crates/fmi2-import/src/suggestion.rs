//! Near names for misspelt ones.

/// Longest name, bytes, that a nearer one is looked for.
const LONGEST: usize = 1000;

/// The candidate nearest to `name` by edit distance, or `None` if all are too far off to be what was meant.
///
/// At most a third of the name's characters, and at least one, may differ. Of equally near candidates the first wins.
pub fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    // Of a text that nobody has typed no slip can be told.
    if name.len() > LONGEST {
        return None;
    }
    let length = name.chars().count();
    let allowed = (length / 3).max(1);
    candidates
        .into_iter()
        // The distance takes memory and time by the product of the lengths, and is no less than their difference.
        .filter(|candidate| candidate.chars().count().abs_diff(length) <= allowed)
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate.to_owned())
}
