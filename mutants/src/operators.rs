//! The mutation operators: what may stand in place of a sign, a constant, a name or the body of a function.

use syn::{BinOp, LitInt, ReturnType, Type};

/// Returns true for a sign that assigns.
pub fn assigns(op: &BinOp) -> bool {
    matches!(
        op,
        BinOp::AddAssign(_)
            | BinOp::SubAssign(_)
            | BinOp::MulAssign(_)
            | BinOp::DivAssign(_)
            | BinOp::RemAssign(_)
            | BinOp::BitXorAssign(_)
            | BinOp::BitAndAssign(_)
            | BinOp::BitOrAssign(_)
            | BinOp::ShlAssign(_)
            | BinOp::ShrAssign(_)
    )
}

/// Returns the signs that may stand in place of one, each with the name of its operator. A comparison is moved by its
/// boundary, and turned around.
pub fn other_signs(op: &BinOp) -> Vec<(&'static str, &'static str)> {
    let (operator, signs): (_, &[&str]) = match op {
        BinOp::Lt(_) => ("comparison", &["<=", ">="]),
        BinOp::Le(_) => ("comparison", &["<", ">"]),
        BinOp::Gt(_) => ("comparison", &[">=", "<="]),
        BinOp::Ge(_) => ("comparison", &[">", "<"]),
        BinOp::Eq(_) => ("comparison", &["!="]),
        BinOp::Ne(_) => ("comparison", &["=="]),
        BinOp::Add(_) => ("arithmetic", &["-"]),
        BinOp::Sub(_) => ("arithmetic", &["+"]),
        BinOp::Mul(_) => ("arithmetic", &["/"]),
        BinOp::Div(_) | BinOp::Rem(_) => ("arithmetic", &["*"]),
        BinOp::AddAssign(_) => ("arithmetic", &["-="]),
        BinOp::SubAssign(_) => ("arithmetic", &["+="]),
        BinOp::MulAssign(_) => ("arithmetic", &["/="]),
        BinOp::DivAssign(_) => ("arithmetic", &["*="]),
        BinOp::And(_) => ("logic", &["||"]),
        BinOp::Or(_) => ("logic", &["&&"]),
        BinOp::BitAnd(_) => ("logic", &["|"]),
        BinOp::BitOr(_) => ("logic", &["&"]),
        BinOp::BitAndAssign(_) => ("logic", &["|="]),
        BinOp::BitOrAssign(_) => ("logic", &["&="]),
        _ => ("", &[]),
    };
    signs.iter().map(|sign| (operator, *sign)).collect()
}

/// Returns what may stand in place of a floating-point constant: twice, half, and with the other sign.
pub fn other_floats(number: &str) -> Vec<String> {
    let digits = number.trim_end_matches("_f64").trim_end_matches("f64").replace('_', "");
    match digits.parse::<f64>() {
        Ok(0.0) => vec!["1.0".to_owned(), "-1.0".to_owned()],
        Ok(_) => vec![format!("{number} * 2.0"), format!("{number} * 0.5"), format!("-{number}")],
        Err(_) => Vec::new(),
    }
}

/// Returns what may stand in place of a whole number: one more, and one less where it is not zero.
pub fn other_integers(number: &LitInt) -> Vec<String> {
    let (Ok(value), suffix) = (number.base10_parse::<u64>(), number.suffix()) else { return Vec::new() };
    let less = value.checked_sub(1).map(|less| format!("{less}{suffix}"));
    value.checked_add(1).map(|more| format!("{more}{suffix}")).into_iter().chain(less).collect()
}

/// Returns the method of one argument that may stand in place of another.
pub fn other_method(name: &str) -> Option<&'static str> {
    Some(match name {
        "min" => "max",
        "max" => "min",
        "any" => "all",
        "all" => "any",
        "take" => "skip",
        "min_by" => "max_by",
        "max_by" => "min_by",
        "min_by_key" => "max_by_key",
        "max_by_key" => "min_by_key",
        "is_some_and" => "is_none_or",
        "is_none_or" => "is_some_and",
        _ => return None,
    })
}

/// Returns the function or constant that may stand in place of another.
pub fn other_path(name: &str) -> Option<&'static str> {
    Some(match name {
        "f64::min" => "f64::max",
        "f64::max" => "f64::min",
        "f64::INFINITY" => "f64::NEG_INFINITY",
        "f64::NEG_INFINITY" => "f64::INFINITY",
        _ => return None,
    })
}

/// Returns the values that a function may return at once, by its return type; an empty text is a return without value.
pub fn early_returns(output: &ReturnType) -> Vec<&'static str> {
    let ReturnType::Type(_, kind) = output else { return vec![""] };
    match &**kind {
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else { return Vec::new() };
            match last.ident.to_string().as_str() {
                "bool" => vec!["true", "false"],
                "Option" => vec!["None"],
                "Result" => vec!["Ok(Default::default())"],
                "f64" => vec!["0.0", "1.0"],
                "usize" | "u8" | "u16" | "u32" | "u64" | "i32" | "i64" | "i128" => vec!["0", "1"],
                "Vec" => vec!["Vec::new()"],
                "Vec3" => vec!["Vec3::zeros()"],
                "Pose" => vec!["Pose::identity()"],
                "Self" => Vec::new(),
                _ => vec!["Default::default()"],
            }
        }
        Type::Tuple(tuple) if tuple.elems.is_empty() => vec![""],
        Type::Tuple(_) | Type::Array(_) => vec!["Default::default()"],
        _ => Vec::new(),
    }
}
