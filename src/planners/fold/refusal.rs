//! The reasons for which [`plan`](super::plan()) finds no folding.

use super::energy_order;
use super::ground_faces::Protrusion;
use super::objective::Minimise;
use crate::behavior;
use crate::plan::Failure;
use crate::units::{Dimension, quantity};
use std::fmt;

/// The reason why [`plan`](super::plan()) gives no folding. Faces are indices in
/// [`Target::faces`](super::Target::faces), from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The root is not a face of the target.
    NoSuchRoot {
        /// The number of faces of the target.
        faces: usize,
    },
    /// The shape reaches farther below the ground on which its root would lie than a panel is thick.
    OffGround {
        /// True if the problem names the root; false if it names none and no face can be the root.
        is_root_given: bool,
        /// The root, or the first face that was tried as the root, as an index in
        /// [`Target::faces`](super::Target::faces).
        root: usize,
        /// The face that reaches the deepest below the ground, and its depth.
        protrusion: Protrusion,
    },
    /// The settings ask for the heuristic, which estimates the energy of moving joints without gravity, and for
    /// another objective or other conventions.
    HeuristicObjective,
    /// The settings ask for the heuristic, and the panels are not of equal mass.
    HeuristicMasses,
    /// The settings ask for the heuristic, and the sides of the panels are not all equal.
    HeuristicSides,
    /// The settings ask for the order of least energy, which is defined for moving joints without gravity only.
    SequenceUnderGravity,
    /// The settings ask for the order of least energy, and a layout has more than
    /// [`HEIGHT_MAX`](super::energy_order::HEIGHT_MAX) hinges on a path.
    SequenceTooHigh,
    /// Two panels penetrate each other in the folded shape.
    Interpenetrating {
        /// The indices of the two panels, those of their faces in [`Target::faces`](super::Target::faces).
        faces: [usize; 2],
        /// The angle between the two panels at their hinge in the folded shape, rad, π where they are level; `None`
        /// where no hinge joins them.
        opening: Option<f64>,
    },
    /// The pattern of every layout overlaps itself in the plane.
    AllOverlap,
    /// The budget or the observer ended the search before a pattern was found that does not overlap.
    NothingFlat,
    /// The target has too many faces for enumeration.
    TooManyFaces {
        /// The greatest number of faces that can be enumerated.
        limit: usize,
    },
    /// The target has too many pairs of a layout and a root for enumeration under this objective.
    TooManyLayouts {
        /// The greatest number of pairs of a layout and a root that can be enumerated.
        limit: u64,
    },
    /// Two faces of the given layout share no hinge.
    NoSuchHinge {
        /// The indices of the two faces in [`Target::faces`](super::Target::faces).
        faces: [usize; 2],
    },
    /// The given hinges are not a spanning tree of the faces.
    NotSpanning {
        /// The number of hinges that the problem gives.
        hinges: usize,
        /// The number of faces of the target.
        faces: usize,
    },
    /// The connectors of panels that are joined have no hinge.
    NoHinge,
    /// The time of a step is shorter than the limits of the hinges allow.
    StepTooShort {
        /// The least time of a step that is long enough, s.
        least: f64,
    },
    /// The folding program can't be scheduled, for the reason given.
    Schedule(behavior::Refusal),
    /// The judge refuses the layout that the problem gives, in the order asked for, for the reason given.
    GivenLayout(Rejection),
    /// The judge refuses every layout and order that was found, as the facts given show.
    NoFolding(Box<NoFolding>),
}

/// The facts found by a search for a folding in which none passed the judge.
#[derive(Clone, Debug, PartialEq)]
pub struct NoFolding {
    /// The reason why the first layout was refused; `None` if the search ended before any was evaluated.
    pub first: Option<Rejection>,
    /// The cost of the best flat pattern, with the leaves folded first.
    pub best: BestPattern,
    /// The least torque of hinges for which an order was found, and the hinge that needs it; `None` without gravity,
    /// and if no order was found for stronger hinges either.
    pub need: Option<TorqueNeed>,
    /// The torque that the weakest hinge holds, N·m; `None` where no limit is stated.
    pub torque: Option<f64>,
    /// True if the problem has gravity, so that torques of hinges are limited.
    pub is_under_gravity: bool,
}

/// The reason why a layout was refused in one order of folding.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejection {
    /// Two panels, taken without thickness, collide in a sample of a step.
    Meet {
        /// The indices of the two panels, those of their faces in [`Target::faces`](super::Target::faces).
        faces: [usize; 2],
        /// The index of the step, from 0.
        step: usize,
    },
    /// A failure found by the judge, the first in time.
    Judged(Failure),
}

/// The cost of a layout that lies flat, with the leaves folded first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BestPattern {
    /// The quantity that was minimised: energy, peak torque, or steps.
    pub minimise: Minimise,
    /// The value of the minimised quantity for this pattern: its peak torque, else its energy; N·m.
    pub reached: f64,
    /// The lower bound on that quantity for all layouts with the leaves folded first, N·m; at most `reached`.
    pub bound: f64,
    /// The gap between `reached` and `bound` as a fraction of `reached`; 0 where the bound proves the value.
    pub gap: f64,
}

/// The least torque limit under which an order was found, and the hinge that needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueNeed {
    /// The torque that the hinge has to hold, N·m.
    pub torque: f64,
    /// The face that the hinge carries, and its parent, as indices in [`Target::faces`](super::Target::faces).
    pub faces: [usize; 2],
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejection::Meet { faces: [a, b], step } => {
                write!(f, "panels {a} and {b} meet in step {}", step + 1)
            }
            Rejection::Judged(failure) => {
                write!(f, "at {}: {}", quantity(failure.time, Dimension::TIME), failure.message)
            }
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::NoSuchRoot { faces } => write!(f, "there is no such face: there are {faces}"),
            Refusal::OffGround { is_root_given, root, protrusion } => {
                let (face, depth) = (protrusion.face, quantity(protrusion.depth, Dimension::LENGTH));
                if *is_root_given {
                    write!(f, "face {face} reaches {depth} below face {root}, which would lie on the ground")
                } else {
                    write!(
                        f,
                        "whichever face lies on the ground, others reach below it: below face {root} face \
                         {face} does by {depth}"
                    )
                }
            }
            Refusal::HeuristicObjective => {
                f.write_str("the heuristic estimates energies of moving joints without gravity, nothing else")
            }
            Refusal::HeuristicMasses => f.write_str("the heuristic takes all panels for equally heavy"),
            Refusal::HeuristicSides => f.write_str("the heuristic takes all panels for equal"),
            Refusal::SequenceUnderGravity => f.write_str(
                "this order is found for moving joints without gravity only; `least_work` knows gravity",
            ),
            Refusal::SequenceTooHigh => {
                let limit = energy_order::HEIGHT_MAX;
                write!(f, "this order is sought in layouts of at most {limit} hinges on a path")
            }
            Refusal::Interpenetrating { faces: [a, b], opening: None } => {
                write!(f, "in the folded shape panels {a} and {b} are in each other")
            }
            Refusal::Interpenetrating { faces: [a, b], opening: Some(opening) } => {
                let opening = quantity(*opening, Dimension::ANGLE);
                write!(
                    f,
                    "in the folded shape panels {a} and {b} are in each other: at their common edge they close to \
                     {opening}, farther than their thickness leaves room"
                )
            }
            Refusal::AllOverlap => f.write_str("every flat pattern of this shape overlaps itself"),
            Refusal::NothingFlat => {
                f.write_str("the budget ended before any pattern was found that does not overlap")
            }
            Refusal::TooManyFaces { limit } => {
                write!(f, "shapes of more than {limit} faces have too many layouts to look at each")
            }
            Refusal::TooManyLayouts { limit } => write!(
                f,
                "shapes of more than {limit} layouts with roots have too many layouts to look at each"
            ),
            Refusal::NoSuchHinge { faces: [a, b] } => write!(f, "faces {a} and {b} share no hinge"),
            Refusal::NotSpanning { hinges, faces } => {
                write!(f, "{hinges} hinges that join not all {faces} faces")
            }
            Refusal::NoHinge => f.write_str("no panel: its edges have no hinge"),
            Refusal::StepTooShort { .. } => f.write_str("the hinges can't fold as fast as that"),
            Refusal::Schedule(refusal) => refusal.reason.fmt(f),
            Refusal::GivenLayout(why) => write!(f, "this layout does not fold so: {why}"),
            Refusal::NoFolding(found) => {
                f.write_str("no order of folding was found that the judge lets through: ")?;
                found.first.as_ref().map_or(Ok(()), |why| why.fmt(f))
            }
        }
    }
}

impl std::error::Error for Refusal {}
