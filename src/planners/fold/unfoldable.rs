//! The reasons why a mesh can't be folded from one sheet.

use std::fmt;

/// The reason why a mesh is no target. Faces are numbered as in the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfoldable {
    /// The mesh has no faces.
    Empty,
    /// The mesh has more faces than can be planned.
    TooLarge {
        /// The number of faces.
        faces: usize,
        /// The greatest number of faces.
        limit: usize,
    },
    /// A face with another number of corners than three.
    NotTriangle {
        /// The face.
        face: usize,
        /// The number of its corners.
        corners: usize,
    },
    /// A face of no area, or that names a vertex that there isn't, or one twice.
    Degenerate {
        /// The face.
        face: usize,
    },
    /// A face with a corner farther from the origin than anything may be.
    TooFar {
        /// The face.
        face: usize,
    },
    /// An edge at which more than two faces meet.
    NonManifold {
        /// All faces at the edge.
        faces: Vec<usize>,
    },
    /// Two faces that run along their common edge in the same direction.
    Orientation {
        /// The two faces.
        faces: [usize; 2],
    },
    /// Two faces with the same corners, back to back.
    FoldedFlat {
        /// The two faces.
        faces: [usize; 2],
    },
    /// Faces that no chain of hinges joins.
    Disconnected {
        /// One face of two pieces each.
        faces: [usize; 2],
    },
    /// Faces that no chain of hinges joins of which each has a face with motors.
    Undriven {
        /// One face of two pieces each.
        faces: [usize; 2],
    },
    /// A side of another length (m) than all panels have.
    UnequalSides {
        /// The face.
        face: usize,
        /// The length of its side, m.
        side: f64,
        /// The length of the panels' sides, m.
        wanted: f64,
    },
}

impl Unfoldable {
    /// Returns a hint how to mend the mesh.
    pub fn remedy(&self) -> &'static str {
        match self {
            Unfoldable::Empty => "a target has at least one triangle",
            Unfoldable::TooLarge { .. } => "fold a coarser mesh, or its parts one by one",
            Unfoldable::NotTriangle { .. } => "cut such faces into triangles",
            Unfoldable::Degenerate { .. } => {
                "leave the face out, or move its corners apart and off one line; it names each vertex once"
            }
            Unfoldable::TooFar { .. } => "a scale, or the unit of a file, may be wrong",
            Unfoldable::NonManifold { .. } => "leave out faces until two are left at the edge",
            Unfoldable::Orientation { .. } => {
                "list the corners of every face counterclockwise, as they are seen from outside"
            }
            Unfoldable::FoldedFlat { .. } => {
                "leave one of them out: two panels on a hinge can't lie on each other"
            }
            Unfoldable::Disconnected { .. } => {
                "make one vertex of those that coincide, or fold the pieces one by one"
            }
            Unfoldable::Undriven { .. } => "one of two panels on a hinge has to be active",
            Unfoldable::UnequalSides { .. } => "give the mesh and the module the same side",
        }
    }
}

impl fmt::Display for Unfoldable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unfoldable::Empty => write!(f, "the mesh has no faces"),
            Unfoldable::TooLarge { faces, limit } => {
                write!(f, "the mesh has {faces} faces; at most {limit} can be planned")
            }
            Unfoldable::NotTriangle { face, corners } => {
                write!(f, "face {face} has {corners} corners; only triangles fold")
            }
            Unfoldable::Degenerate { face } => write!(f, "face {face} has no area"),
            Unfoldable::TooFar { face } => write!(f, "face {face} has a corner farther away than 1 km"),
            Unfoldable::NonManifold { faces } => {
                let names: Vec<String> = faces.iter().map(usize::to_string).collect();
                write!(f, "faces {} meet at one edge; a hinge joins two", listed(&names))
            }
            Unfoldable::Orientation { faces: [a, b] } => {
                write!(f, "faces {a} and {b} are not turned the same way: one is seen from inside")
            }
            Unfoldable::FoldedFlat { faces: [a, b] } => {
                write!(f, "faces {a} and {b} lie on each other")
            }
            Unfoldable::Disconnected { faces: [a, b] } => {
                write!(f, "no chain of common edges leads from face {a} to face {b}")
            }
            Unfoldable::Undriven { faces: [a, b] } => {
                write!(f, "no chain of hinges with motors leads from face {a} to face {b}")
            }
            Unfoldable::UnequalSides { face, side, wanted } => write!(
                f,
                "face {face} has a side of {:.4} mm; the panels' sides are {:.4} mm",
                side * 1e3,
                wanted * 1e3
            ),
        }
    }
}

impl std::error::Error for Unfoldable {}

/// Returns `1, 2 and 3`.
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
