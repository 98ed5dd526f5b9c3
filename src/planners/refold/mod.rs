//! Refolding: from one shape to another through a flat sheet that unfolds from the first and folds into the
//! second, with few changes of connections in the plane.

pub mod lattice_sheet;
pub mod rearrangement;
pub mod sheets;
