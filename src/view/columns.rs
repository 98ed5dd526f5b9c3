//! Curves in a page as whole multiples of a unit: each number but the first as its difference from the one before, so
//! that what changes little takes few letters.

use serde_json::{Value, json};

/// Returns numbers as `[unit, first, difference, ...]`, each rounded to whole multiples of `unit`; differences of zero at
/// the end are left out. Numbers that are not finite count as zero.
pub(super) fn column(unit: f64, numbers: impl IntoIterator<Item = f64>) -> Value {
    let mut before = 0;
    let mut steps: Vec<i64> = Vec::new();
    for number in numbers {
        let units = libm::round(number / unit);
        let units = if units.is_finite() { units as i64 } else { 0 };
        steps.push(units - before);
        before = units;
    }
    while steps.last() == Some(&0) {
        steps.pop();
    }
    let mut column = vec![json!(unit)];
    column.extend(steps.into_iter().map(Value::from));
    Value::Array(column)
}

/// Returns a power of ten of which numbers of this size are some thousands; 1 for zero.
pub(super) fn unit_of(size: f64) -> f64 {
    if !(size > 0.0 && size.is_finite()) {
        return 1.0;
    }
    let exponent = libm::floor(libm::log10(size)) as i32 - 3;
    // Read from text, so that 0.001 is not 0.0010000000000000002.
    format!("1e{exponent}").parse().unwrap_or(1.0)
}
