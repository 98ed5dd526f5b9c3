//! The reasons for which there is no plan.

use super::gravity::JointLoad;
use super::robot::Dock;
use super::status::SearchStatus;
use crate::behavior;
use std::error::Error;
use std::fmt;

/// The reason why there is no plan to the snake. Modules and bonds are named by their indices in the assembly.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The assembly is none of RoFI modules of one pitch, for the reason given.
    NotRofi(NotRofi),
    /// The start is not a valid configuration, for the reason given.
    InvalidStart(InvalidStart),
    /// The docks of a bond that closes a loop do not meet.
    OpenLoop {
        /// The index of the bond in the assembly.
        bond: usize,
        /// The greatest deviation of the docks from meeting: of positions in pitches, of entries of the rotation
        /// matrix without unit.
        residual: f64,
    },
    /// On the floor, the robot rolls over and over, or stands on a brink where it comes to rest.
    DoesNotStand {
        /// The distance of the centre of mass from the edge of the support polygon, along the floor, in pitches; below
        /// [`stability`](super::Tolerances::stability).
        margin: f64,
    },
    /// The world has gravity, which the method of [Mrázek et al.](super), chosen by
    /// [`Collisions`](super::Collisions), does not know.
    GravityUnsupported,
    /// The budget of forward kinematics is spent, and no joint was overloaded on the way; the status is that at the
    /// end.
    BudgetSpent(SearchStatus),
    /// The observer ended the search; the status is that at the end.
    Stopped(SearchStatus),
    /// The method of [Mrázek et al.](super) tried all pairs in every order that it came to; the status is that at the
    /// end.
    Exhausted(SearchStatus),
    /// The method of [Mrázek et al.](super) found no two free ends of different chains; the status is that at the
    /// end.
    NoFreeTips(SearchStatus),
    /// Joints would have to hold more than their torque limits in all that was tried.
    Overload(Overload),
    /// The steps can't be scheduled as a program, for the reason given.
    Schedule(behavior::Refusal),
}

/// The reason why an assembly is not a robot of RoFI modules.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotRofi {
    /// The module of this index, from 0, has other joints or ports than the RoFI universal module.
    Kind(usize),
    /// The module of this index, from 0, has another pitch than the first.
    Pitch(usize),
}

/// The reason why a configuration is not a valid start.
#[derive(Clone, Debug, PartialEq)]
pub enum InvalidStart {
    /// The module of this index, from 0, is not connected to the first by closed bonds.
    Disconnected(usize),
    /// Two modules of the robot overlap.
    Overlap {
        /// The indices of the two modules, from 0, the smaller first.
        modules: [usize; 2],
        /// The distance of the centres of two of their balls, in pitches; below
        /// [`min_distance`](super::Tolerances::min_distance).
        distance: f64,
        /// The bonds that force the overlap, by their indices in the assembly, from the one module to the other: as
        /// long as they hold, the two modules are where they are.
        bonds: Vec<usize>,
    },
}

/// An overload that ended a search: a joint would have had to hold more than its torque limit. A refusal has that of
/// the search that made the most merges of chains ([`SearchStatus::made`]); of equal ones, the smallest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overload {
    /// The overloaded joint, with its torque as a fraction of its limit.
    pub load: JointLoad,
    /// The operation that the overload ruled out.
    pub operation: Operation,
    /// The progress of the search that met the overload; attempts and work are those of all searches.
    pub status: SearchStatus,
}

/// The operation in which a joint of a robot that is held by one module would have been overloaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// The start configuration is held.
    HoldingStart,
    /// The bonds that close loops are undocked.
    OpeningLoops,
    /// The two docks are brought together, and the bond is undocked that the new one replaces.
    Joining(Dock, Dock),
    /// The snake is straightened.
    Straightening,
    /// The straight snake is held.
    HoldingSnake,
}

impl fmt::Display for NotRofi {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotRofi::Kind(module) => write!(f, "module {module} is no RoFI module"),
            NotRofi::Pitch(module) => write!(f, "module {module} has another pitch than module 0"),
        }
    }
}

impl fmt::Display for InvalidStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InvalidStart::Disconnected(module) => write!(f, "module {module} is not connected to module 0"),
            InvalidStart::Overlap { modules: [a, b], distance, bonds } => {
                write!(f, "modules {a} and {b} overlap: their balls are {distance:.4} pitches apart")?;
                write!(f, ", by the bonds {bonds:?} between them")
            }
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reached = |f: &mut fmt::Formatter<'_>, what: &str, status: &SearchStatus| {
            let SearchStatus { needed, made, tried, .. } = status;
            write!(f, "{what}: {made} of {needed} connections were made, and {tried} pairs of ends tried")
        };
        match self {
            Refusal::NotRofi(no) => no.fmt(f),
            Refusal::InvalidStart(invalid) => invalid.fmt(f),
            Refusal::OpenLoop { bond, residual } => {
                write!(f, "the docks of bond {bond} do not meet: {residual:.3} of a pitch is missing")
            }
            Refusal::DoesNotStand { margin } => write!(
                f,
                "it does not stand on the floor: its centre of mass is {margin:.4} of a pitch inside what supports it"
            ),
            Refusal::GravityUnsupported => write!(f, "the paper's own method does not know gravity"),
            Refusal::BudgetSpent(status) => reached(f, "no way to the snake within the budget", status),
            Refusal::Stopped(status) => reached(f, "the search was ended", status),
            Refusal::Exhausted(status) => {
                reached(f, "no order of pairs of tentacles leads to the snake", status)
            }
            Refusal::NoFreeTips(status) => reached(f, "no two tentacles have a free tip", status),
            Refusal::Overload(Overload { load, operation, status }) => {
                let JointLoad { module, joint, ratio } = load;
                let what = format!(
                    "joint {joint} of module {module} would have to hold {ratio:.3} of its torque limit \
                     ({operation:?})"
                );
                reached(f, &what, status)
            }
            Refusal::Schedule(refusal) => write!(f, "the steps can't be scheduled: {}", refusal.reason),
        }
    }
}

impl Error for Refusal {}
