//! The words of the language.

/// Reserved everywhere; every other word is a keyword only where an item or its clause stands.
pub const RESERVED: &[&str] = &[
    "and", "or", "not", "if", "else", "for", "in", "let", "fn", "use", "true", "false", "expect", "require",
    "X", "Y", "Z",
];

/// What begins an item, besides the words that begin a statement.
pub const ITEMS: &[&str] = &[
    "use",
    "let",
    "fn",
    "extern",
    "connector",
    "module",
    "cell",
    "strut",
    "config",
    "lattice",
    "truss",
    "test",
];

pub fn is_reserved(word: &str) -> bool {
    RESERVED.contains(&word)
}
