//! Errors of the operations on plans: why plans are not cut, or not put one after the other.

use crate::robot::Mismatch;

/// The reason why an operation on plans cannot be done. SI units; modules by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum OperationError {
    /// A slice that ends before it begins.
    Times {
        /// The beginning, s.
        from: f64,
        /// The end, s.
        to: f64,
    },
    /// A lattice plan is cut only between stages.
    InsideStage {
        /// The time, s.
        time: f64,
    },
    /// Plans of different families.
    Families,
    /// The end of the one is not the start of the other.
    Robots(Mismatch),
    /// Two trusses that differ in their struts, or in where a node is.
    Trusses {
        /// The name of the first node that is elsewhere, if the struts are the same.
        node: Option<String>,
    },
    /// Two trusses among different obstacles, or on different ground.
    Surroundings,
    /// Two lattices of different cells.
    Cells,
    /// Two lattices with other numbers of cells.
    CellCounts {
        /// The cells of the first plan.
        first: u64,
        /// The cells of the second plan.
        second: u64,
    },
    /// The shape in which the one ends is not that in which the other starts.
    Shapes,
    /// The numbers of lattice plans do not fit into those of a plan together.
    Inexact,
    /// Together they are longer than a plan may be, s.
    TooLong {
        /// The duration, s.
        duration: f64,
    },
    /// Between two times, s, a joint moves by a law that no command of a program states.
    NoCommand {
        /// The beginning, s.
        from: f64,
        /// The end, s.
        to: f64,
    },
    /// The plan's robot has no joints, and only a robot with joints has a program.
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
