//! `squeeze`: kinodynamic reconfiguration of lattices of expanding cubes, after "Asymptotically optimal
//! kinodynamic motion planning for a class of modular self-reconfigurable robots" (Reif and Slee). Plans are
//! time-optimal in order: O(√n) for n cells of bounded acceleration.
//!
//! The mistakes of the paper that are mended, the improvements, and the conditions by which plans are judged:
//! `docs/planners/squeeze.md`.
//!
//! A problem is solved through a row: a motion from either shape to one row, the second backwards
//! (`candidates`); or in place, where most cells stay (`push`). All motions are built from configurations in closed form (`motion`); of those that the
//! model allows the fastest is taken (`selection`).
//!
//! ```
//! use modl::planners::squeeze::{self, Method, Problem, Settings};
//! use modl::planners::NoProgress;
//! use modl::robot::Cell;
//!
//! let name = "Cube".to_owned();
//! let cell = Cell { name, size: 1.0, shrinks_to: 0.5, speed: 1.0, force: 1.0, mass: 1.0, slides: true };
//! let row: Vec<[i64; 3]> = (0..16).map(|i| [i, 0, 0]).collect();
//! let column: Vec<[i64; 3]> = (0..16).map(|i| [0, i, 0]).collect();
//! let problem = Problem::floating(cell, row, column);
//! let settings = Settings { method: Method::Accordion, ..Settings::default() };
//! let solution = squeeze::plan(&problem, &settings, &mut NoProgress)?;
//! assert!(solution.report.balanced);
//! assert!((solution.body.duration() - 14.697).abs() < 1e-3);
//! # Ok::<(), squeeze::Refusal>(())
//! ```

mod accordion;
mod anchor;
mod arms;
mod candidates;
mod compression;
mod convey;
mod domain;
mod floating;
mod fold;
mod fraction;
mod halve;
mod listed;
mod melt;
mod motion;
mod pair;
mod planar;
mod push;
mod ranks;
mod rectangles;
mod refill;
mod retime;
mod selection;
mod shape;
mod shear;
mod spin;
mod tolerances;
mod tunnel;
mod unroll;

pub use accordion::accordion;
pub use anchor::AnchorFault;
pub use arms::arms;
pub use domain::{CellState, Domain};
pub use fold::fold;
pub use halve::halve;
pub use melt::melt;
pub use motion::{Motion, PlanHeader, PlanLimits, Profile, Transition};
pub use planar::to_row;
pub use selection::plan;
pub use shear::shear;
pub use unroll::unroll;

use crate::plan::Ratio;
use crate::robot::Cell;
use std::fmt;

/// A method of `squeeze`: a construction of motions between shapes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The fastest of the other methods that the model allows.
    #[default]
    Auto,
    /// The accordion: rows fold up and unroll, boxes unroll; cells keep their size.
    Accordion,
    /// The folds of [Reif and Slee](self), mended: between boxes whose sides differ by powers of two, and from rows
    /// of any length to columns.
    Fold,
    /// The shear: a row shears to a column in one stage.
    Shear,
    /// The arms: a row of at least four cells becomes a column as its halves turn up and merge.
    Arms,
    /// The merging of rows, two by two, for any connected sets of cells in planes.
    Merge,
    /// The pushing of lines of cells, in place, for connected sets of cells that are laid over each other.
    Push,
    /// The melting of one cell after another (Rus and Vona 2001), for any connected sets of at most 400 cells, in
    /// space too.
    Melt,
    /// The spinning of pairs of cells against one cell after another that goes through the robot, for connected sets of at
    /// most 400 cells in a plane; the angular momentum stays zero.
    Spin,
    /// The tunnelling of blocks of 2 × 2 × 2 cells through others (Vassilvitskii, Yim and Suh 2002; Aloupis et al. 2009),
    /// the one for cells that do not slide.
    Tunnel,
}

/// The choice of the model of angular momentum, by which motions are allowed or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ModelChoice {
    /// Zero angular momentum if a quick motion without any is known for the shapes; otherwise any motion, but the shear,
    /// which turns the robot most, only if [`Method::Shear`] is asked for, and the slow [`Method::Spin`] likewise.
    #[default]
    Auto,
    /// Zero angular momentum at all times: a free robot does not turn. [`Refusal::Unbalanced`] if no such motion is
    /// known.
    Balanced,
    /// The model of [Reif and Slee](self): translational forces only, and any angular momentum.
    Paper,
}

/// The norm of a cell's acceleration that its force bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Norm {
    /// The maximum norm: the greatest component along an axis.
    #[default]
    EachAxis,
    /// The Euclidean norm: the length of the acceleration.
    Euclidean,
}

/// A reconfiguration problem: two shapes of lattice cells of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The kind of all cells: size, mass, force, speed; it has the index 0 in the plan's library.
    pub cell: Cell,
    /// The lattice sites of the cells at the start, in cell sizes, in any order: all different, and connected over
    /// faces.
    pub start: Vec<[i64; 3]>,
    /// The lattice sites of the cells at the end, in cell sizes, in any order: all different, connected over faces,
    /// as many as at the start; a translation of all makes no difference unless cells are fixed.
    pub goal: Vec<[i64; 3]>,
    /// The lattice sites of the cells that stand fast, in cell sizes, of the start and of the goal; none for a robot
    /// that floats, whose centre of mass stays instead.
    pub fixed: Vec<[i64; 3]>,
    /// The lattice sites of obstacles, in cell sizes, which no cell overlaps at any time; none without fixed cells.
    pub obstacles: Vec<[i64; 3]>,
    /// The sides of every cell at the end along x, y, z, in parts of its size, each from what it shrinks to to 1: the
    /// goal with its cells drawn together about the centre of mass. All 1 with fixed cells.
    pub sides: [f64; 3],
}

impl Problem {
    /// Returns the problem of a robot that floats among nothing, whose cells are whole at the end.
    pub fn floating(cell: Cell, start: Vec<[i64; 3]>, goal: Vec<[i64; 3]>) -> Problem {
        Problem { cell, start, goal, fixed: vec![], obstacles: vec![], sides: [1.0; 3] }
    }
}

/// The settings of `squeeze`. By default the method and the model are chosen for the shapes, and the limits are those
/// of [Reif and Slee](self).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The method. Default [`Method::Auto`], the fastest that the model allows.
    pub method: Method,
    /// The model of angular momentum. Default [`ModelChoice::Auto`].
    pub model: ModelChoice,
    /// The velocity profile of stages. Default bang-bang, as in [Reif and Slee](self).
    pub profile: Profile,
    /// The greatest contact force, N; `None`, the default, for no limit, as in [Reif and Slee](self).
    pub max_force: Option<f64>,
    /// The norm of a cell's acceleration that its force bounds. Default that of each axis, as in [Reif and
    /// Slee](self).
    pub norm: Norm,
}

/// The figures of a reconfiguration, with the lower bound that its duration is compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// A lower bound on the duration of any motion between the shapes under the same limits, s.
    pub lower_bound: f64,
    /// The method that was taken; never [`Method::Auto`].
    pub method: Method,
    /// True if the angular momentum stays zero during the whole motion.
    pub balanced: bool,
    /// The reason for the method in words, for a message.
    pub why: String,
    /// The name and duration (s) of each stage, in the order of time.
    pub stages: Vec<(String, f64)>,
}

/// The reason why [`plan`] gives no motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The shapes differ in their number of cells.
    Counts {
        /// The number of cells at the start.
        from: usize,
        /// The number of cells at the end.
        to: usize,
    },
    /// The cells do not shrink to half their size, as every method but the accordion and the pushes needs.
    Stiff {
        /// The least size of a cell, as a fraction of its full size, without unit.
        smallest: Ratio,
    },
    /// A shape is neither flat nor a box, has too many cells to melt, and no way by pushes was found.
    Solid {
        /// True if the start is such a shape; false if only the goal is.
        first: bool,
        /// The greatest number of cells that the method melt takes.
        most: usize,
    },
    /// The method that was asked for does not apply to these shapes.
    Method {
        /// The method that the settings ask for.
        method: Method,
    },
    /// The cells do not slide along each other, as they do in every method but the tunnelling of blocks.
    Docked {
        /// The method that the settings ask for.
        method: Method,
    },
    /// A shape does not consist of blocks of 2 × 2 × 2 cells on one lattice, as the tunnelling of blocks needs.
    Blocks {
        /// True if the start is such a shape; false if only the goal is.
        first: bool,
        /// The lattice site of a cell whose block is not whole, in cells, where the lowest corners of the shape are those of
        /// blocks.
        site: [i64; 3],
    },
    /// A shape has too many cells for the tunnelling of blocks.
    TooMany {
        /// The greatest number of cells.
        most: usize,
    },
    /// The model asks for zero angular momentum, and no motion of the method is known that keeps the angular momentum
    /// zero.
    Unbalanced {
        /// The method that the settings ask for.
        method: Method,
    },
    /// Fixed cells and obstacles leave no way that is known.
    Anchor(AnchorFault),
    /// A side that the cells are to have at the end is shorter than they shrink to, or longer than they are.
    Side {
        /// The axis, 0 to 2.
        axis: usize,
        /// The least side of a cell, as a fraction of its full size, without unit.
        smallest: f64,
    },
    /// Cells that stand fast keep their size, and the others were to shrink at the end.
    FixedSides,
    /// A number of the plan, which is exact, does not fit 64 bits.
    TooLarge,
    /// The method spin has examined as many stages as it may, and found no way.
    Budget,
    /// The observer ended the search before there was a plan.
    Cancelled,
    /// The construction failed for this reason, which is a defect of the planner and not of the problem.
    Defect(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let cells = |n: usize| if n == 1 { "1 cell".to_string() } else { format!("{n} cells") };
        match self {
            Refusal::Counts { from, to } => {
                write!(f, "{} do not become {}: there are as many in the end", cells(*from), cells(*to))
            }
            Refusal::Stiff { .. } => {
                f.write_str("the cells do not shrink to half their size, as this method needs")
            }
            Refusal::Solid { most, .. } => {
                write!(f, "no way is known between these shapes in space of more than {most} cells")
            }
            Refusal::Docked { .. } => f.write_str(
                "the cells do not slide along each other: they hold only where the middles of their faces meet",
            ),
            Refusal::Blocks { site: [x, y, z], .. } => {
                write!(f, "the cell ({x}, {y}, {z}) is in no whole block of 2 × 2 × 2 cells")
            }
            Refusal::TooMany { most } => write!(f, "blocks of more than {most} cells are not tunnelled"),
            Refusal::Side { axis, smallest } => {
                let [axis, smallest] = [["x", "y", "z"][*axis].to_owned(), crate::units::number(*smallest)];
                write!(f, "along {axis} the sides of cells are from {smallest} to 1 of their size")
            }
            Refusal::FixedSides => {
                f.write_str("fixed cells keep their size: the others can't shrink at the end")
            }
            Refusal::Method { method } => {
                let covered = match method {
                    Method::Shear => "`shear` takes a row to a column",
                    Method::Arms => "`arms` takes a row of at least four cells to a column",
                    Method::Fold => {
                        "`fold` takes rows to columns, and boxes to boxes whose sides differ by powers of two"
                    }
                    Method::Accordion => "`accordion` takes rows and boxes to each other",
                    Method::Merge => "`merge` takes shapes in a plane to each other",
                    Method::Push => "`push` found no way from the one to the other",
                    Method::Melt => "`melt` takes shapes of up to 400 cells to each other",
                    Method::Spin => {
                        "`spin` takes shapes of up to 400 cells in one plane to each other, in each of which two cells can slip into the sites beside them"
                    }
                    Method::Tunnel => "`tunnel` found no way from the one to the other",
                    Method::Auto => "no method takes the one to the other",
                };
                write!(f, "the method does not fit these shapes: {covered}")
            }
            Refusal::Unbalanced { .. } => {
                f.write_str("no way is known on which the angular momentum stays zero")
            }
            Refusal::Anchor(fault) => fault.fmt(f),
            Refusal::Budget => f.write_str("`spin` found no way before its budget of stages was spent"),
            Refusal::TooLarge => f.write_str("the numbers of this plan are too large to be kept exactly"),
            Refusal::Cancelled => f.write_str("the search was ended before there was a plan"),
            Refusal::Defect(what) => write!(f, "the planner failed: {what}"),
        }
    }
}

impl std::error::Error for Refusal {}

impl Method {
    /// Returns true if blocks tunnel where this method is asked for, of cells that slide or do not.
    fn tunnels(self, slides: bool) -> bool {
        !slides || self == Method::Tunnel
    }

    /// Returns the word for the method in programs, such as `accordion`.
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Accordion => "accordion",
            Method::Fold => "fold",
            Method::Shear => "shear",
            Method::Arms => "arms",
            Method::Merge => "merge",
            Method::Push => "push",
            Method::Melt => "melt",
            Method::Spin => "spin",
            Method::Tunnel => "tunnel",
        }
    }
}
