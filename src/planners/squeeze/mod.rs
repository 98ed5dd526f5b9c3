//! Squeeze: kinodynamic reconfiguration of lattices of expanding cubes, after "Asymptotically optimal
//! kinodynamic motion planning for a class of modular self-reconfigurable robots" (Reif and Slee).
//!
//! What is mended of the paper, what is better than it, and by which conditions plans are judged:
//! `docs/planners/squeeze.md`.
//!
//! A problem is solved through a row: a way from either shape to one row, the second backwards
//! ([`ways`]). All ways are built from configurations in closed form ([`way`]); of those that the model
//! allows the fastest is taken ([`choose`]).

mod accordion;
mod arms;
mod choose;
mod domain;
mod explicit;
mod fold;
mod halve;
mod melt;
mod planar;
mod ranks;
mod retime;
mod shape;
mod shear;
mod unroll;
mod way;
mod ways;

pub use accordion::accordion;
pub use arms::arms;
pub use choose::squeeze;
pub use domain::{Domain, Spot};
pub use fold::fold;
pub use halve::halve;
pub use melt::melt;
pub use planar::to_row;
pub use shear::shear;
pub use unroll::unroll;
pub use way::{Frame, Leg, Profile, Terms, Way};

use crate::plan::{Ratio, Stages};

/// How to get from one shape to the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The fastest that the model allows.
    #[default]
    Auto,
    /// Rows fold up and unroll, boxes unroll: cells keep their size.
    Accordion,
    /// The paper's, mended: boxes whose sides differ by powers of two, and rows of any length.
    Fold,
    /// A row turns to a column in one go.
    Shear,
    /// A row to a column: its halves turn up, and merge.
    Arms,
    /// Any connected sets in planes.
    Merge,
    /// Any connected sets, in space too, one cell after another.
    Melt,
}

/// Whether something outside may turn the robot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Demand {
    /// Balanced where such a way is known; else what turns least.
    #[default]
    Auto,
    /// The angular momentum stays zero.
    Balanced,
    /// The paper's: translational forces only, angular momentum is not asked for.
    Paper,
}

/// What is to be done. Places are those of the lattice.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    pub from: &'a [[i64; 3]],
    pub to: &'a [[i64; 3]],
    pub method: Method,
    pub demand: Demand,
    pub profile: Profile,
    /// Greatest contact force, N.
    pub max_force: Option<f64>,
    /// Whether a cell's force bounds the length of its acceleration, not only the part along each axis.
    pub euclidean: bool,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Found {
    pub stages: Stages,
    /// Seconds.
    pub lower_bound: f64,
    pub method: Method,
    pub balanced: bool,
    /// Why this method, in words.
    pub why: String,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    Counts {
        from: usize,
        to: usize,
    },
    /// The cells shrink to more than half their size (this part of it).
    Stiff {
        smallest: Ratio,
    },
    /// A shape that is neither flat nor a box, of more cells than melt.
    Solid {
        first: bool,
        most: usize,
    },
    /// The method is for other shapes.
    Method {
        method: Method,
    },
    /// No way is known that keeps the angular momentum at zero.
    Unbalanced {
        method: Method,
    },
    /// Numbers beyond 64 bits, or too many cells.
    TooLarge,
    /// The construction did not come out right: a defect of the planner.
    Defect(String),
}

impl Method {
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Accordion => "accordion",
            Method::Fold => "fold",
            Method::Shear => "shear",
            Method::Arms => "arms",
            Method::Merge => "merge",
            Method::Melt => "melt",
        }
    }
}
