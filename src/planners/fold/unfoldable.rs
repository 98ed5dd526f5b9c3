//! The reasons why a mesh can't be folded from one sheet.

use crate::plan::listed;
use std::fmt;

/// The reason why a mesh is not a target of a folding. Faces are indices in the mesh, from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfoldable {
    /// The mesh has no faces at all.
    Empty,
    /// The mesh has more faces than can be planned for.
    TooLarge {
        /// The number of faces of the mesh.
        faces: usize,
        /// The greatest number of faces that is allowed.
        limit: usize,
    },
    /// A face has another number of corners than three.
    NotTriangle {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The number of corners of the face.
        corners: usize,
    },
    /// A face has no area, a coordinate that is not a number, or a corner that is not a vertex, or names a vertex
    /// twice.
    Degenerate {
        /// The index of the face in the mesh, from 0.
        face: usize,
    },
    /// A coordinate of a face's corner is farther from 0 than [`EXTENT_MAX`](crate::geometry::soundness::EXTENT_MAX).
    TooFar {
        /// The index of the face in the mesh, from 0.
        face: usize,
    },
    /// More than two faces meet at one edge.
    NonManifold {
        /// The indices in the mesh of all faces at the edge.
        faces: Vec<usize>,
    },
    /// Two faces run along their common edge in the same direction, so that one of them is turned over.
    Orientation {
        /// The indices of the two faces in the mesh.
        faces: [usize; 2],
    },
    /// Two faces with a common edge lie on each other, back to back: their fold angle is half a turn.
    FoldedFlat {
        /// The indices of the two faces in the mesh.
        faces: [usize; 2],
    },
    /// No chain of hinges joins all faces.
    Disconnected {
        /// The indices in the mesh of two faces that no chain joins.
        faces: [usize; 2],
    },
    /// No chain of hinges joins all faces if each hinge needs a face with motors.
    Undriven {
        /// The indices in the mesh of two faces that no chain joins.
        faces: [usize; 2],
    },
    /// The length of a face's side is not that of the panels.
    UnequalSides {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The length of the face's side, m.
        side: f64,
        /// The length of the panels' sides, m.
        wanted: f64,
    },
}

impl Unfoldable {
    /// Returns a hint to mend the mesh, as words for a message.
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
