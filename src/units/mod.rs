//! Dimensions and units. Only here degrees and millimetres are known: all else is in SI.

mod dimension;
mod display;
mod table;

pub use dimension::{Dimension, NAMED};
pub use display::{
    base_units, counted, dimension_name, fitting_unit, fixed, is_unit, number, quantity, quantity_in,
    rounded, rounded_up, usual_unit,
};
pub use table::{UNITS, Unit, to_si, unit};
