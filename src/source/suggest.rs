//! Suggestions for misspelt names.

/// Returns the candidate nearest to `name` by edit distance; `None` if none is near enough to be a misspelling
/// of it. The distance may be 1, and one more for every four letters of the shorter name. Names that begin with
/// `_` are left out; of equally near ones the first in alphabetical order is returned.
pub(crate) fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .filter(|candidate| *candidate != name && !candidate.starts_with('_'))
        .map(|candidate| (distance(name, candidate), candidate))
        // A single letter is as near to every other one.
        .filter(|(d, candidate)| *d < name.len() || name.eq_ignore_ascii_case(candidate))
        .filter(|(d, candidate)| *d <= 1 + name.len().min(candidate.len()) / 4)
        .min()
        .map(|(_, candidate)| candidate)
}

/// Returns the edit distance. Letter case counts one step: `smores` for `Smores`.
fn distance(a: &str, b: &str) -> usize {
    if a.eq_ignore_ascii_case(b) {
        return 1;
    }
    strsim::osa_distance(a, b)
}
