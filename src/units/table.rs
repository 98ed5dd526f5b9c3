//! The units of the language with their factors to SI.

use super::dimension::Dimension;

/// A unit of measure, which programs write after a number: `76mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The name of the unit as programs write it, such as `mm`.
    pub name: &'static str,
    /// The dimension of the quantities that the unit measures.
    pub dimension: Dimension,
    /// The value of one such unit in SI: `value_si = value * factor`.
    pub factor: f64,
}

const fn u(name: &'static str, dimension: Dimension, factor: f64) -> Unit {
    Unit { name, dimension, factor }
}

const POWER: Dimension = Dimension { length: 2, mass: 1, time: -3, angle: 0, param: 0, energy: false };

/// Every unit of the language. Values are converted by [`to_si`], so that `76mm` is exactly `76 / 1000` rounded once.
pub const UNITS: &[Unit] = &[
    u("nm", Dimension::LENGTH, 1e-9),
    u("um", Dimension::LENGTH, 1e-6),
    u("mm", Dimension::LENGTH, 1e-3),
    u("cm", Dimension::LENGTH, 1e-2),
    u("m", Dimension::LENGTH, 1.0),
    u("km", Dimension::LENGTH, 1e3),
    u("rad", Dimension::ANGLE, 1.0),
    u("deg", Dimension::ANGLE, std::f64::consts::PI / 180.0),
    u("turn", Dimension::ANGLE, std::f64::consts::TAU),
    u("rpm", Dimension::ANGULAR_SPEED, std::f64::consts::TAU / 60.0),
    u("us", Dimension::TIME, 1e-6),
    u("ms", Dimension::TIME, 1e-3),
    u("s", Dimension::TIME, 1.0),
    u("min", Dimension::TIME, 60.0),
    u("h", Dimension::TIME, 3600.0),
    u("mg", Dimension::MASS, 1e-6),
    u("g", Dimension::MASS, 1e-3),
    u("kg", Dimension::MASS, 1.0),
    u("N", Dimension::FORCE, 1.0),
    u("mN", Dimension::FORCE, 1e-3),
    u("kN", Dimension::FORCE, 1e3),
    u("J", Dimension::ENERGY, 1.0),
    u("mJ", Dimension::ENERGY, 1e-3),
    u("W", POWER, 1.0),
    u("Hz", Dimension::FREQUENCY, 1.0),
];

/// Returns the unit with this name, such as `mm`; `None` if the language has none.
pub fn unit(name: &str) -> Option<Unit> {
    UNITS.iter().copied().find(|unit| unit.name == name)
}

/// Returns `value`, in a unit of this factor ([`Unit::factor`]), in SI units. A factor below one is applied by
/// dividing by its exact inverse where that is a whole number: `76mm` is the double nearest to 0.076.
pub fn to_si(value: f64, factor: f64) -> f64 {
    let inverse = (1.0 / factor).round();
    if factor < 1.0 && inverse * factor == 1.0 { value / inverse } else { value * factor }
}
