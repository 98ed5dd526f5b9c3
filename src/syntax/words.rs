//! The keywords of the language.

/// The words reserved everywhere. Every other keyword is one only where an item or a clause has it, and a name
/// elsewhere.
pub const RESERVED: &[&str] = &[
    "and", "or", "not", "if", "else", "for", "in", "let", "fn", "use", "true", "false", "expect", "require",
    "X", "Y", "Z",
];

/// The keywords that begin an item other than a statement (`let` begins either).
pub const ITEMS: &[&str] = &[
    "use",
    "let",
    "fn",
    "record",
    "extern",
    "connector",
    "module",
    "cell",
    "strut",
    "config",
    "scene",
    "lattice",
    "truss",
    "study",
    "test",
];

/// The keywords that begin a declaration with instances.
pub(super) const FAMILIES: &[&str] = &["module", "cell", "strut", "config", "scene", "lattice", "truss"];

/// The keywords after which a name is declared, sorted.
pub const DECLARING: &[&str] = &[
    "behavior",
    "cell",
    "config",
    "connector",
    "fn",
    "joint",
    "lattice",
    "let",
    "link",
    "module",
    "motor",
    "node",
    "obstacle",
    "part",
    "port",
    "record",
    "scene",
    "strut",
    "study",
    "truss",
];

/// The keywords that begin a statement; an expression is a statement, too.
pub const STATEMENTS: &[&str] = &["let", "expect", "require", "if", "for", "ensure"];

/// The keywords that begin an item or a statement at the top of a file.
pub(super) const ITEMS_AND_STATEMENTS: &[&str] = &{
    // Both lists have `let`, the first of the statements.
    let mut all = [""; ITEMS.len() + STATEMENTS.len() - 1];
    let mut i = 0;
    while i < all.len() {
        all[i] = if i < ITEMS.len() { ITEMS[i] } else { STATEMENTS[i - ITEMS.len() + 1] };
        i += 1;
    }
    all
};

/// The keywords that begin a clause of a module.
pub const MODULE: &[&str] = &[
    "mass", "touch", "contact", "link", "joint", "port", "motor", "touching", "alias", "let", "require",
    "if", "for",
];

/// The keywords that begin a clause of a configuration.
pub const CONFIG: &[&str] = &[
    "part", "port", "base", "behavior", "connect", "set", "let", "require", "if", "for", "obstacle", "world",
];

/// The keywords that begin a clause of a truss.
pub const TRUSS: &[&str] = &["node", "strut", "let", "require", "if", "for"];

/// The words with which a clause goes on, even at the beginning of a new line.
pub(super) const GOING_ON: &[&str] = &[
    "and", "or", "else", "in", "at", "turned", "collides", "facing", "up", "on", "of", "as", "is", "turn",
    "allows", "closed", "by", "each",
];

/// Returns true if a word is reserved everywhere.
pub(super) fn is_reserved(word: &str) -> bool {
    RESERVED.contains(&word)
}

/// The forms of items and clauses, by their first word.
const FORMS: &[(&str, &str)] = &[
    ("use", "use std.smores.{Smores}"),
    ("let", "let name = value"),
    ("fn", "fn name(a: Length) -> Length = value"),
    ("record", "record Name { a: Length = 1m, b: Angle }"),
    ("connector", "connector Name { mates Name, turns 4 }"),
    ("module", "module Name(length: Length = 40mm) { ... }"),
    ("cell", "cell Name { size 100mm  mass 1kg }"),
    ("config", "config Name(n: Int = 4) { ... }"),
    ("scene", "scene Name(gap: Length = 600mm) { ... }"),
    ("lattice", "lattice Name of Cell = row(4)"),
    ("truss", "truss Name of Strut { ... }"),
    ("study", "study name(a in 1mm..9mm) by sobol(64) = Row(...)"),
    ("test", "test \"what holds\" { expect condition }"),
    ("link", "link name = box(1mm, 1mm, 1mm) at [0mm, 0mm, 0mm]"),
    ("joint", "joint name : parent -> child = revolute(axis: Y) at [0mm, 0mm, 0mm]"),
    ("motor", "motor name = a + b (max_speed: 60deg/s)"),
    ("touching", "touching a b"),
    ("alias", "alias new = old"),
    ("part", "part name[4] : Type(n: 1)"),
    ("behavior", "behavior name(n: Int = 1) = value"),
    ("connect", "connect a.port -- b.port turn 90deg"),
    ("set", "set a.joint = 30deg"),
    ("base", "base a.part"),
    ("obstacle", "obstacle name = box(20mm, 1m, 200mm) at [300mm, 0mm, 100mm]"),
    ("world", "world(terrain: slope(5deg), friction: 0.8)"),
    ("node", "node name = [0m, 0m, 0m]"),
    ("for", "for i in 0..4 { ... }"),
    ("if", "if condition { ... } else { ... }"),
];

/// Returns an example of the form of the item or clause that begins with this word: `truss Name of Strut { ... }`.
/// `None` for words without one.
pub(super) fn form(word: &str) -> Option<&'static str> {
    FORMS.iter().find(|(first, _)| *first == word).map(|(_, form)| *form)
}
