//! Words of other languages with their counterparts in modl, for hints.

/// Returns the hint for a word that means nothing in modl but does in another language; `None` for other words.
pub(crate) fn instead(word: &str) -> Option<&'static str> {
    INSTEAD.iter().find(|(words, _)| words.contains(&word)).map(|(_, instead)| *instead)
}

/// Returns, in words, the type of modl for the name of a type in another language; `None` for other names.
pub(crate) fn of_type(name: &str) -> Option<&'static str> {
    TYPES.iter().find(|(names, _)| names.contains(&name)).map(|(_, ty)| *ty)
}

/// Returns the unit of modl for a longer name of it, such as `deg` for `degrees`; `None` for other names.
pub(crate) fn unit(name: &str) -> Option<&'static str> {
    UNITS.iter().find(|(names, _)| names.contains(&name)).map(|(_, unit)| *unit)
}

/// Returns what a unit that modl does not have is in one that it has, such as `an inch is 25.4mm`; `None` if the
/// name is not known.
pub(crate) fn measure(name: &str) -> Option<&'static str> {
    MEASURES.iter().find(|(names, _)| names.contains(&name)).map(|(_, measure)| *measure)
}

/// Returns the present name of a renamed parameter, field or behaviour `word` of the declaration `of`; `None` if it
/// was not renamed.
pub(crate) fn renamed(of: &str, word: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(owner, old, _)| (*owner, *old) == (of, word)).map(|(_, _, new)| *new)
}

/// Renamed parameters, fields and behaviours: function, record or configuration, old name, new name.
const RENAMED: &[(&str, &str, &str)] = &[
    ("locomote", "ladder", "fallbacks"),
    ("Travel", "eased", "relaxed_steps"),
    ("Puma4", "reach", "posture"),
    ("Driver5Puma4", "reach", "reach_out"),
];

/// Words of other languages with their hints.
const INSTEAD: &[(&[&str], &str)] = &[
    (&["def", "func", "function", "fun"], "a function is written `fn name(x: Length) -> Length = 2 * x`"),
    (&["lambda"], "a function without a name is written `x => 2 * x`, where one is wanted"),
    (
        &["ensure"],
        "`ensure` begins a contract before a word, a number or a text on its line: \
         turn the comparison round where it would begin with a bracket",
    ),
    (&["return"], "what a function gives stands behind its `=`, or last in its `{ }`"),
    (
        &["import", "from", "include", "using"],
        "names are brought in by `use std.smores.{Smores}`, or `use \"file.mod\".{Name}`",
    ),
    (
        &["class", "struct", "type", "data", "dataclass"],
        "values under names are a `record Name { a: Length, b: Angle }`; robots are a `module` or a `config`",
    ),
    (&["var", "const", "mut", "val"], "a name is given its value by `let name = ...`"),
    (
        &["while", "loop", "do"],
        "there is no such loop: `for i in 0..4 { ... }` goes through a list or a range",
    ),
    (&["elif", "elsif", "elseif"], "write `else if c { ... }`"),
    (&["switch", "match", "case"], "write `if c { ... } else if d { ... } else { ... }`"),
    (
        &["try", "except", "catch", "throw", "raise", "async", "await", "yield"],
        "nothing is thrown: what is wrong is told where it stands",
    ),
    (&["with"], "a changed copy of a record is written `d with { bend: 40deg }`"),
    (&["assert"], "write `expect condition` in a `test`, `require condition, \"why\"` in a body"),
    (&["pass"], "a body without clauses is `{ }`"),
    (
        &["del", "delete", "global", "nonlocal", "break", "continue"],
        "a value never changes, and a loop goes to its end: a list is made by `[e for x in list if c]`",
    ),
    (&["echo", "printf", "println", "console"], "write `print(value)`"),
    (&["True", "TRUE"], "write `true`"),
    (&["False", "FALSE"], "write `false`"),
    (
        &["None", "null", "nil", "undefined"],
        "what is not given is left out; `x else y` takes `y` where `x` is missing",
    ),
    (&["range", "xrange"], "`0..n` are the whole numbers from 0 up to, but without, `n`"),
    (&["map", "filter"], "a list is made by `[e for x in list if c]`"),
    (
        &["foldl", "accumulate"],
        "a value is carried along a list by `reduce(list, f, from: ...)`; `scan` keeps all on the way",
    ),
    (&["str", "repr", "format", "to_string"], "a text takes a value in: `\"{value}\"`"),
    (&["int", "float"], "`floor(x)`, `ceil(x)` and `round(x)` give whole numbers; every `Int` is a `Number`"),
    (&["is"], "`==` compares, `!=` tells what differs"),
    (&["math", "np", "numpy"], "`sqrt`, `sin`, `atan2` and the rest are there without an import"),
    (&["radians", "degrees"], "units stick to numbers: `90deg`, `1.5rad`"),
    (&["pi", "PI"], "a half turn is `180deg`, or `0.5turn`"),
    (&["pow"], "write `x^2`"),
    (&["self", "this"], "members are named as they are: `a`, not `self.a`"),
    (&["help", "quit", "exit", "dir", "vars", "doc"], "in a session: `help`, `:vars`, `:doc NAME`, `quit`"),
    (
        &["input", "open", "eval", "exec"],
        "a program reads nothing but what it names with `use`, `load` and `mesh`",
    ),
];

/// Type names of other languages with the types of modl.
const TYPES: &[(&[&str], &str)] = &[
    (&["int", "integer", "i32", "i64", "u32", "usize"], "`Int`"),
    (&["float", "double", "f32", "f64", "real"], "`Number`, or a quantity such as `Length` or `Angle`"),
    (&["str", "string", "String"], "`Text`"),
    (&["bool", "boolean", "Boolean"], "`Bool`"),
    (&["list", "array", "Array", "Vec"], "`List<Length>`, or of another type"),
    (&["dict", "tuple", "object", "Dict", "Tuple"], "`List<Length>`, or a `record` of your own"),
];

/// Longer names of units.
const UNITS: &[(&[&str], &str)] = &[
    (&["degree", "degrees", "degs", "°"], "deg"),
    (&["radian", "radians", "rads"], "rad"),
    (&["turns", "rev", "revs"], "turn"),
    (&["second", "seconds", "sec", "secs"], "s"),
    (&["millisecond", "milliseconds", "msec"], "ms"),
    (&["minute", "minutes", "mins"], "min"),
    (&["hour", "hours"], "h"),
    (&["meter", "meters", "metre", "metres"], "m"),
    (&["millimeter", "millimeters", "millimetre", "millimetres"], "mm"),
    (&["centimeter", "centimeters", "centimetre", "centimetres"], "cm"),
    (&["gram", "grams"], "g"),
    (&["kilogram", "kilograms", "kgs"], "kg"),
    (&["newton", "newtons"], "N"),
    (&["Nm"], "N*m"),
    (&["joule", "joules"], "J"),
    (&["hz"], "Hz"),
    (&["RPM"], "rpm"),
    (&["rps"], "turn/s"),
    (&["dps"], "deg/s"),
    (&["kph", "kmh", "kmph"], "km/h"),
    (&["mps"], "m/s"),
    (&["watt", "watts"], "W"),
];

/// Units that modl does not have, in those that it has (BIPM, The International System of Units, 9th edition, and
/// NIST Special Publication 811, appendix B).
const MEASURES: &[(&[&str], &str)] = &[
    (&["inch", "inches", "in"], "an inch is `25.4mm`"),
    (&["ft", "foot", "feet"], "a foot is `0.3048m`"),
    (&["yd", "yard", "yards"], "a yard is `0.9144m`"),
    (&["mile", "miles"], "a mile is `1609.344m`"),
    (&["mph"], "a mile per hour is `0.44704m/s`"),
    (&["lb", "lbs", "pound", "pounds"], "a pound is `0.45359237kg`"),
    (&["oz", "ounce", "ounces"], "an ounce is `28.349523125g`"),
    (&["t", "ton", "tons", "tonne", "tonnes"], "a tonne is `1000kg`"),
    (&["lbf"], "a pound-force is `4.4482216152605N`"),
    (&["kgf"], "a kilogram-force is `9.80665N`"),
    (&["Nmm"], "a newton millimetre is `1N*mm`"),
    (&["hp"], "a horsepower is `745.7W`"),
    (&["kW"], "a kilowatt is `1000W`"),
    (&["mW"], "a milliwatt is `0.001W`"),
    (&["kHz"], "a kilohertz is `1000Hz`"),
    (&["kJ"], "a kilojoule is `1000J`"),
    (&["Wh"], "a watt-hour is `3600J`"),
    (&["ns"], "a nanosecond is `0.001us`"),
    (&["percent", "pct"], "a percent is `0.01`"),
];
