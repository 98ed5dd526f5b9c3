//! Errors of the operations on plans: the reasons why plans are not cut, or not put one after the other.

use crate::robot::Mismatch;

/// The reason why an operation on plans (slice, concatenation, derivation of a program) cannot be done. Numbers are
/// in SI units; modules are given by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum OperationError {
    /// A slice that ends before it begins.
    Times {
        /// The time at which the slice would begin, s.
        from: f64,
        /// The time at which the slice would end, s.
        to: f64,
    },
    /// A lattice plan that would be cut within a stage.
    InsideStage {
        /// The time of the cut, s.
        time: f64,
    },
    /// Two plans of different families of robots: articulated, lattice, truss.
    Families,
    /// Two articulated robots of which the first at its end does not match the second at its start, for the reason
    /// given.
    Robots(Mismatch),
    /// Two trusses that differ in their struts, or in the position of a node where the plans meet.
    Trusses {
        /// The name of the first node that is elsewhere; `None` if the struts or the number of nodes differ.
        node: Option<String>,
    },
    /// Two trusses whose nodes are merged otherwise where the plans meet.
    Topologies,
    /// Two trusses among different obstacles, or two robots on different ground.
    Surroundings,
    /// Two lattices of different cells, or with different units of time.
    Cells,
    /// Two lattices with different numbers of cells.
    CellCounts {
        /// The number of cells of the first plan.
        first: u64,
        /// The number of cells of the second plan.
        second: u64,
    },
    /// Two lattices of which the first ends in another shape than the second starts in.
    Shapes,
    /// Two lattice plans whose numbers 64 bits do not hold together.
    Inexact,
    /// Two plans that together are longer than a plan may be.
    TooLong {
        /// The duration of both plans together, s.
        duration: f64,
    },
    /// A joint that moves between two times by a law that no command of a program states.
    NoCommand {
        /// The time at which the piece of the joint's motion begins, s.
        from: f64,
        /// The time at which the piece of the joint's motion ends, s.
        to: f64,
    },
    /// A robot without joints, of which none has a program.
    NoJoints,
}

impl std::fmt::Display for OperationError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OperationError::Times { from, to } => write!(f, "nothing lies between {from:.6} s and {to:.6} s"),
            OperationError::InsideStage { time } => {
                write!(f, "at {time:.6} s the cells move: a lattice plan is cut only between its stages")
            }
            OperationError::Families => write!(f, "the plans are of different kinds of robot"),
            OperationError::Robots(mismatch) => {
                write!(f, "the first plan does not end where the second starts: {mismatch}")
            }
            OperationError::Trusses { node: None } => write!(f, "the plans are of different trusses"),
            OperationError::Trusses { node: Some(node) } => {
                write!(f, "node `{node}` is not where the second plan starts when the first ends")
            }
            OperationError::Topologies => write!(
                f,
                "at the end of the first plan other nodes are merged than at the start of the second"
            ),
            OperationError::Surroundings => {
                write!(f, "the plans are among different obstacles, or on different ground")
            }
            OperationError::Cells => write!(f, "the plans are of different cells"),
            OperationError::CellCounts { first, second } => {
                write!(f, "the first plan moves {first} cells, the second {second}")
            }
            OperationError::Shapes => {
                write!(f, "the first plan does not end in the shape in which the second starts")
            }
            OperationError::Inexact => {
                write!(f, "the plans together have numbers too large to be kept exactly")
            }
            OperationError::TooLong { duration } => {
                write!(f, "together the plans last {duration} s, longer than a plan may be")
            }
            OperationError::NoCommand { from, to } => {
                write!(f, "between {from:.3} s and {to:.3} s a joint moves by a law that no command states")
            }
            OperationError::NoJoints => write!(f, "only joints have a program"),
        }
    }
}

impl std::error::Error for OperationError {}
