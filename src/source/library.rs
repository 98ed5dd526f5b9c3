//! The standard library, embedded in the binary: every file of `stdlib/` (a test compares).

/// Pairs the names of library files with their texts.
macro_rules! embed {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../stdlib/", $name)))),*]
    };
}

/// The files of the standard library, each as (name such as `smores.mod`, text), sorted by name; the prelude is one
/// of them.
pub const FILES: &[(&str, &str)] = embed![
    "crystal.mod",
    "gaits.mod",
    "legs.mod",
    "lists.mod",
    "mori.mod",
    "prelude.mod",
    "rofi.mod",
    "scenes.mod",
    "servos.mod",
    "shapes.mod",
    "smores.mod",
    "truss.mod",
];

/// Returns the text of a library file, such as `smores.mod` for `std.smores`; `None` if there is no such file.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(file, _)| *file == name).map(|(_, text)| *text)
}

/// Returns the library file, without its ending, that declares a public name: `smores` for `Smores`; `None` if
/// none does. The prelude is not searched.
pub fn declares(name: &str) -> Option<&'static str> {
    let keywords = [
        "module",
        "config",
        "scene",
        "connector",
        "cell",
        "strut",
        "lattice",
        "truss",
        "fn",
        "let",
        "record",
        "study",
        "extern fn",
    ];
    let begins = |line: &str| {
        let named = keywords.iter().find_map(|word| line.strip_prefix(word)?.strip_prefix(' '));
        let rest = named.and_then(|named| named.strip_prefix(name));
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    };
    let files = FILES.iter().filter(|(file, _)| *file != "prelude.mod" && !name.starts_with('_'));
    let found = files.clone().find(|(_, text)| text.lines().any(begins));
    found.and_then(|(file, _)| file.strip_suffix(".mod"))
}
