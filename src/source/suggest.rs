//! What a misspelt name may have meant.

/// The candidate nearest to `name`, if one is near enough to be what was meant.
/// Ties go to the candidate that comes first in alphabetical order.
pub(crate) fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .filter(|candidate| *candidate != name && !candidate.starts_with('_'))
        .map(|candidate| (distance(name, candidate), candidate))
        // One letter is like any other.
        .filter(|(d, candidate)| *d < name.len() || name.eq_ignore_ascii_case(candidate))
        .filter(|(d, candidate)| *d <= 1 + name.len().min(candidate.len()) / 4)
        .min()
        .map(|(_, candidate)| candidate)
}

/// Letter case is no difference of meaning: `smores` for `Smores` is one step.
fn distance(a: &str, b: &str) -> usize {
    if a.eq_ignore_ascii_case(b) {
        return 1;
    }
    strsim::osa_distance(a, b)
}
