//! The pages about codes, embedded in the binary: every file of `docs/errors/` (a test compares).

/// Pairs codes with the texts of their pages.
macro_rules! embed {
    ($($code:literal),* $(,)?) => {
        &[$(($code, include_str!(concat!("../../docs/errors/", $code, ".md")))),*]
    };
}

/// Code and page, in order of code.
const PAGES: &[(&str, &str)] = embed![];

/// The page of a code, such as `E0301`.
pub fn page(code: &str) -> Option<&'static str> {
    PAGES.iter().find(|(known, _)| *known == code).map(|(_, page)| *page)
}
