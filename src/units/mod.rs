//! Dimensions and units. Only here degrees and millimetres are known: all else is in SI.

pub mod dimension;
pub mod display;
pub mod table;

pub use dimension::Dimension;
pub use display::{is_unit, quantity};
pub use table::{Unit, unit};
