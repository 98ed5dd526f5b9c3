//! The standard library, embedded in the binary: every file of `stdlib/` (a test compares).

/// Pairs the names of library files with their texts.
macro_rules! embed {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../stdlib/", $name)))),*]
    };
}

/// Name and text of each file, in order of name.
pub const FILES: &[(&str, &str)] = embed![
    "crystal.mod",
    "gaits.mod",
    "mori.mod",
    "prelude.mod",
    "rofi.mod",
    "shapes.mod",
    "smores.mod",
    "truss.mod",
];

/// The text of a library file, such as `smores.mod` for `std.smores`.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(file, _)| *file == name).map(|(_, text)| *text)
}
