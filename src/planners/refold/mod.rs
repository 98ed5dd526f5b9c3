//! Refolding: from one shape to another of the same panels, through a flat sheet that unfolds from the first and
//! folds into the second, with few changes of connections in the plane. If one shape has fewer faces, the other panels hang
//! on it in a flat strip ([`with_equal_counts`]).
//!
//! The entry is [`plan()`]. [`sheets`] grows sheets that both shapes nearly share and bounds the number of changes,
//! [`rearrangement`] and [`walks`] search strokes from one sheet to another, [`lattice_sheet`] carries them out.
#![allow(non_snake_case)]

mod face_groups;
mod flat_panels;
pub mod lattice_sheet;
pub mod rearrangement;
mod sheet_pairs;
pub mod sheets;
pub mod walks;

mod plan;

pub use flat_panels::with_equal_counts;
pub use plan::{Problem, Refusal, Report, Settings, plan};

/// The sides of panels that are examined for each face at least, whatever the budget, so that two sheets are found.
const SIDES_MIN: u64 = 100;
