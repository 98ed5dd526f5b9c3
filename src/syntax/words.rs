//! The words of the language.

/// Reserved everywhere; every other word is a keyword only where an item or its clause stands.
pub const RESERVED: &[&str] = &[
    "and", "or", "not", "if", "else", "for", "in", "let", "fn", "use", "true", "false", "expect", "require",
    "X", "Y", "Z",
];

/// What begins an item that is a declaration.
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

/// What begins a statement, besides an expression.
pub const STATEMENTS: &[&str] = &["let", "expect", "require", "if", "for"];

/// What begins a clause of a module.
pub const MODULE: &[&str] = &[
    "mass", "touch", "contact", "link", "joint", "port", "motor", "touching", "alias", "let", "require",
    "if", "for",
];

/// What begins a clause of a configuration.
pub const CONFIG: &[&str] =
    &["part", "port", "base", "behavior", "connect", "set", "let", "require", "if", "for"];

/// What begins a clause of a truss.
pub const TRUSS: &[&str] = &["node", "strut", "let", "require", "if", "for"];

/// What a clause goes on with, also on a new line.
pub(super) const GOING_ON: &[&str] = &[
    "and", "or", "else", "in", "at", "turned", "collides", "facing", "up", "on", "of", "as", "is", "turn",
    "allows", "closed",
];

pub(super) fn is_reserved(word: &str) -> bool {
    RESERVED.contains(&word)
}

/// How items and clauses are written, by the word that begins them.
const FORMS: &[(&str, &str)] = &[
    ("use", "use std.smores.{Smores}"),
    ("let", "let name = value"),
    ("fn", "fn name(a: Length) -> Length = value"),
    ("connector", "connector Name { mates Name, turns 4 }"),
    ("module", "module Name(length: Length = 40mm) { ... }"),
    ("cell", "cell Name { size 100mm  mass 1kg }"),
    ("config", "config Name(n: Int = 4) { ... }"),
    ("lattice", "lattice Name of Cell = row(4)"),
    ("truss", "truss Name of Strut { ... }"),
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
    ("node", "node name = [0m, 0m, 0m]"),
    ("for", "for i in 0..4 { ... }"),
    ("if", "if condition { ... } else { ... }"),
];

/// How what begins with this word is written.
pub(super) fn form(word: &str) -> Option<&'static str> {
    FORMS.iter().find(|(first, _)| *first == word).map(|(_, form)| *form)
}
