//! Faults in the form of the plan of a lattice.

use crate::plan::fault::PlanFault;
use crate::plan::lattice::LatticeFault;
use std::fmt;

/// A fault of the plan of a lattice.
#[derive(Clone, Debug, PartialEq)]
pub enum StagesFault {
    /// More cells than a lattice may have.
    CellCount {
        /// The greatest number of cells that is allowed.
        most: u64,
    },
    /// A unit of time of the lattice that is not positive.
    TimeUnit,
    /// A least size that is not in (0, 1], or a greatest speed that is not positive.
    CellLimits,
    /// A greatest contact force of the lattice's model that is not positive.
    ContactForce,
    /// A start whose runs name fewer cells than there are.
    Start,
    /// A stage whose squared duration is negative.
    StageDuration {
        /// The name of the stage, as the plan states it.
        stage: String,
    },
    /// A ramp whose fraction of the time has too large a denominator.
    RampTooFine,
    /// A ramp that takes none of the time, or too much of it.
    RampPart,
    /// A run of no cells, or of more than there are.
    RunSize,
    /// A run that names cells which there are not: the lowest and the highest that it names.
    RunCells {
        /// The lowest number of a cell that the run names.
        low: i128,
        /// The highest number of a cell that the run names.
        high: i128,
        /// The number of cells of the lattice, which are numbered from 0.
        count: u64,
    },
    /// A pair of numbers that is no rational number with a positive denominator.
    Ratio {
        /// The numerator that was found.
        numerator: i64,
        /// The denominator that was found.
        denominator: i64,
    },
    /// A stage that states neither the positions of cells at its end nor their moves, or both.
    StageEnd {
        /// The name of the stage, as the plan states it.
        stage: String,
    },
    /// A span of moves of no cells, or of a class that there is not.
    MoveSpan {
        /// The name of the stage, as the plan states it.
        stage: String,
        /// The index of the class, from 0, that the span states.
        class: u32,
        /// The number of classes of the stage.
        classes: usize,
    },
    /// Moves of more or fewer cells than there are.
    MoveCells {
        /// The name of the stage, as the plan states it.
        stage: String,
        /// The number of cells whose moves the stage states.
        stated: u64,
        /// The number of cells of the lattice.
        count: u64,
    },
    /// An anchor without cells, or with cells that are not in ascending order or not there.
    AnchorCells,
    /// A size of an obstacle that is not positive.
    ObstacleSize,
    /// A plan that is to be balanced though cells stand fast.
    AnchorBalance,
    /// Moves that lead to positions without exact arithmetic, for the reason given.
    Inexact(LatticeFault),
}

impl From<StagesFault> for PlanFault {
    fn from(fault: StagesFault) -> PlanFault {
        PlanFault::Stages(fault)
    }
}

impl fmt::Display for StagesFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StagesFault::CellCount { most } => write!(f, "more than {most} cells"),
            StagesFault::TimeUnit => write!(f, "the unit of time must be positive"),
            StagesFault::CellLimits => write!(f, "the limits of the cells are out of range"),
            StagesFault::ContactForce => write!(f, "the greatest contact force must be positive"),
            StagesFault::Start => write!(f, "the start does not say where every cell is"),
            StagesFault::StageDuration { stage } => write!(f, "stage `{stage}` lasts no real time"),
            StagesFault::RampTooFine => write!(f, "a ramp is too fine a part of the time"),
            StagesFault::RampPart => write!(f, "a ramp takes none of the time, or too much"),
            StagesFault::RunSize => write!(f, "a run of no cells, or of too many"),
            StagesFault::RunCells { low, high, count } => {
                write!(f, "a run holds the cells {low} to {high}: there are {count}")
            }
            StagesFault::StageEnd { stage } => {
                write!(f, "stage `{stage}` must state either the positions of cells, `end`, or their `moves`")
            }
            StagesFault::MoveSpan { stage, class, classes } => {
                write!(f, "moves of stage `{stage}`: a span of no cells, or of class {class} of {classes}")
            }
            StagesFault::MoveCells { stage, stated, count } => {
                write!(f, "stage `{stage}` states the moves of {stated} cells: there are {count}")
            }
            StagesFault::AnchorCells => {
                write!(f, "the fixed cells must be some of the cells there are, in ascending order")
            }
            StagesFault::ObstacleSize => write!(f, "the size of an obstacle must be positive"),
            StagesFault::AnchorBalance => {
                write!(f, "a lattice with fixed cells is held from turning: it is not balanced by itself")
            }
            StagesFault::Inexact(fault) => write!(f, "the moves add up to no exact positions: {fault}"),
            StagesFault::Ratio { numerator, denominator } => {
                write!(f, "{numerator} / {denominator} is no rational number with a positive denominator")
            }
        }
    }
}
