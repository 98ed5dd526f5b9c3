//! Lists of words in sentences.

/// Returns words as a sentence lists them: `1, 2 and 3`; empty without any.
pub(crate) fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
