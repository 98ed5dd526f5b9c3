//! Squeeze: kinodynamic reconfiguration of lattices of expanding cubes, after "Asymptotically optimal
//! kinodynamic motion planning for a class of modular self-reconfigurable robots" (Reif and Slee).
//!
//! What is mended of the paper, what is better than it, and by which conditions plans are judged:
//! `docs/planners/squeeze.md`.

mod accordion;
mod domain;
mod explicit;
mod fold;
mod planar;
mod ranks;
mod shear;
mod way;

pub use accordion::accordion;
pub use domain::{Domain, Spot};
pub use fold::fold;
pub use planar::to_row;
pub use shear::shear;
pub use way::{Leg, Profile, Terms, Way};

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// Numbers beyond 64 bits.
    TooLarge,
}
