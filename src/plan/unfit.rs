//! Why an operation on plans cannot be done.

use crate::robot::Mismatch;

/// SI units; modules by path name.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfit {
    /// A slice that ends before it begins.
    Times { from: f64, to: f64 },
    /// A lattice plan is cut only between stages.
    InsideStage { time: f64 },
    /// Plans of different families.
    Families,
    /// The end of the one is not the start of the other.
    Robots(Mismatch),
    /// Two trusses that differ in their struts, or in where a node is.
    Trusses { node: Option<String> },
    /// Lattice plans are joined by the planner that makes them.
    Lattices,
    /// Together they are longer than a plan may be, s.
    TooLong { duration: f64 },
}

impl std::fmt::Display for Unfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unfit::Times { from, to } => write!(f, "nothing lies between {from:.6} s and {to:.6} s"),
            Unfit::InsideStage { time } => {
                write!(f, "at {time:.6} s the cells move: a lattice plan is cut only between its stages")
            }
            Unfit::Families => write!(f, "the plans are of different kinds of robot"),
            Unfit::Robots(mismatch) => {
                write!(f, "the first plan does not end where the second starts: {mismatch}")
            }
            Unfit::Trusses { node: None } => write!(f, "the plans are of different trusses"),
            Unfit::Trusses { node: Some(node) } => {
                write!(f, "node `{node}` is not where the second plan starts when the first ends")
            }
            Unfit::Lattices => write!(f, "plans of lattices cannot be joined; plan the whole way at once"),
            Unfit::TooLong { duration } => {
                write!(f, "together the plans last {duration} s, longer than a plan may be")
            }
        }
    }
}
