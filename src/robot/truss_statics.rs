//! Statics of trusses: the stiffness matrix of a truss, the least singular values of its rigidity matrix, and the
//! forces in struts and contacts that hold it under its weight.
//!
//! Struts are pin-jointed bars; a positive force is tension. The sparse matrices of all of them have the same envelope
//! ([`Layout`]), which is found once for a truss.

pub use super::rigidity_bounds::LinearMotion;
pub(crate) use super::rigidity_bounds::norm_bound;
pub use super::truss_forces::{Contact, FRICTION, ForceChange, ForceModel, Forces, ForcesError, Weights};
pub use super::truss_layout::Layout;
pub use super::truss_modes::{LowerBound, Mode, Modes, ShiftedFactor};
