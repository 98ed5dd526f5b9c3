//! Display of quantities with units, as people write them.

use super::dimension::Dimension;
use super::table::{UNITS, to_si, unit};

/// Returns a value in SI units as text with a unit, as a program would write it: 0.076 m as `76mm`, angles in
/// degrees. Digits are those of [`number`]; a dimension without a usual unit is shown in base units (`0.25kg*m^2`).
pub fn quantity(value: f64, dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        return number(value);
    }
    let (suffix, factor) = fitting_unit(value, dimension);
    format!("{}{}", number(value / to_si(1.0, factor)), suffix)
}

/// Returns a value in SI units as text, rounded up to a whole number of a unit, given by its name. Panics if the language
/// has no such unit.
pub fn rounded_up(value: f64, name: &str) -> String {
    /// The part of a unit by which a value may exceed a whole number: what conversions of units leave.
    const ROUNDING: f64 = 1e-9;
    let unit = unit(name).expect("a unit of the language");
    let whole = libm::ceil(value / to_si(1.0, unit.factor) - ROUNDING);
    quantity(to_si(whole, unit.factor), unit.dimension)
}

/// The greatest difference from a decimal number of ten digits, relative, that is rounding: a unit's factor leaves
/// some.
const EXACT: f64 = 4.0 * f64::EPSILON;

/// Returns a plain number as text: whole numbers and what has at most ten digits exactly, everything else with six
/// significant digits, but never fewer than stand before the point. No trailing zeros; an exponent below 1e-5 and from
/// 1e15 on. Infinities and NaN as `inf`, `-inf` and `NaN`.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let magnitude = libm::floor(libm::log10(value.abs())) as i32;
    if !(-5..15).contains(&magnitude) {
        let text = format!("{value:.5e}");
        let (mantissa, exponent) = text.split_once('e').expect("formatted with an exponent");
        return format!("{}e{exponent}", trim_zeros(mantissa));
    }
    let ten = format!("{value:.9e}").parse().unwrap_or(value);
    let exact = (value - ten).abs() <= EXACT * value.abs();
    let decimals = (if exact { 9 - magnitude } else { 5 - magnitude }).max(0) as usize;
    trim_zeros(&format!("{value:.decimals$}")).to_string()
}

/// Returns a plain number as text with at most this many decimals, otherwise as [`number`] does.
pub fn rounded(value: f64, decimals: usize) -> String {
    let scale = (0..decimals).fold(1.0, |scale, _| scale * 10.0);
    number(libm::round(value * scale) / scale)
}

/// Returns a number of things in words: `1 module`, `3 modules`; `what` is the singular.
pub fn counted<N: From<u8> + PartialEq + std::fmt::Display>(n: N, what: &str) -> String {
    format!("{n} {what}{}", if n == N::from(1) { "" } else { "s" })
}

/// Returns a value in SI units as text in a unit, given as (name, factor to SI), and with this many decimals. `None`
/// for the unit: one that suits the value; `None` for the decimals: the digits of [`number`]. An infinite value is
/// `infinite` or `-infinite`, without unit. `dimension`: that of the value.
pub fn quantity_in(
    value: f64,
    dimension: Dimension,
    unit: Option<(&str, f64)>,
    decimals: Option<usize>,
) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "infinite" } else { "-infinite" }.into();
    }
    let (name, factor) = match unit {
        Some((name, factor)) => (name.to_string(), factor),
        None if dimension == Dimension::NUMBER => (String::new(), 1.0),
        None => fitting_unit(value, dimension),
    };
    let value = value / to_si(1.0, factor);
    let digits = decimals.map_or_else(|| number(value), |places| fixed(value, places));
    format!("{digits}{name}")
}

/// Returns a number as text with this many decimals; one that rounds to zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.bytes().any(|b| matches!(b, b'1'..=b'9')) {
        text
    } else {
        text.trim_start_matches('-').to_string()
    }
}

fn trim_zeros(text: &str) -> &str {
    if text.contains('.') {
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" { "0" } else { text }
    } else {
        text
    }
}

/// Returns the unit to show a value (SI) of a dimension in, as (name, factor to SI): the largest in which the value
/// reaches 1, else the smallest. Base units with the factor 1 if none is usual.
pub fn fitting_unit(value: f64, dimension: Dimension) -> (String, f64) {
    const DEG: f64 = std::f64::consts::PI / 180.0;
    let units: &[(&str, f64)] = match dimension.name() {
        Some("Length") => &[("m", 1.0), ("mm", 1e-3)],
        Some("Angle") => &[("deg", DEG)],
        Some("Time") => &[("s", 1.0), ("ms", 1e-3)],
        Some("Mass") => &[("kg", 1.0), ("g", 1e-3)],
        Some("Speed") => &[("m/s", 1.0), ("mm/s", 1e-3)],
        Some("AngularSpeed") => &[("rad/s", 1.0)],
        Some("Force") => &[("N", 1.0)],
        Some("Torque") => &[("N*m", 1.0)],
        Some("Energy") => &[("J", 1.0)],
        Some("Power") => &[("W", 1.0)],
        Some("Frequency") => &[("Hz", 1.0)],
        _ => return (base_units(dimension), 1.0),
    };
    let last = units[units.len() - 1];
    let (name, factor) = *units.iter().find(|(_, f)| value.abs() >= f * (1.0 - 1e-12)).unwrap_or(&last);
    (name.to_string(), factor)
}

/// Returns a dimension as a product of base units, as it could be written: `kg*m^2/s^2`, `s^-2`; empty for a plain
/// number. `D` is a dimension parameter.
pub fn base_units(dimension: Dimension) -> String {
    let parts = [
        ("D", dimension.param),
        ("kg", dimension.mass),
        ("m", dimension.length),
        ("rad", dimension.angle),
        ("s", dimension.time),
    ];
    let power = |name: &str, n: i16| if n == 1 { name.to_string() } else { format!("{name}^{n}") };
    let above: Vec<String> =
        parts.iter().filter(|(_, n)| *n > 0).map(|(s, n)| power(s, i16::from(*n))).collect();
    // Alone they are written with negative exponents, after others as divisors.
    let sign = if above.is_empty() { 1 } else { -1 };
    let below = parts.iter().filter(|(_, n)| *n < 0).map(|(s, n)| power(s, sign * i16::from(*n)));
    let below: Vec<String> = below.collect();
    match (above.is_empty(), below.is_empty()) {
        (_, true) => above.join("*"),
        (true, false) => below.join("*"),
        (false, false) => format!("{}/{}", above.join("*"), below.join("/")),
    }
}

/// Returns the name that programs give to the type of quantities of a dimension: `Length`, `Quantity<kg*m^2>`.
pub fn dimension_name(dimension: Dimension) -> String {
    dimension.name().map_or_else(|| format!("Quantity<{}>", base_units(dimension)), str::to_string)
}

/// Returns the usual unit of a dimension, for messages: `rad/s` for an angular speed, base units if none is usual;
/// empty for a plain number.
pub fn usual_unit(dimension: Dimension) -> String {
    match dimension.name() {
        Some("Number") => String::new(),
        _ => fitting_unit(f64::MAX, dimension).0,
    }
}

/// Returns true if the language has a unit of this name, such as `mm`.
pub fn is_unit(name: &str) -> bool {
    UNITS.iter().any(|unit| unit.name == name)
}
