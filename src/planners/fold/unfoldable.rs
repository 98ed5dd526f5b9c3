//! The reasons why a mesh can't be folded from one sheet.

use super::polygon::OutlineFault;
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
    /// A face has fewer than three corners, or more than can be planned for.
    Corners {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The number of corners of the face.
        corners: usize,
        /// The greatest number of corners that is allowed.
        limit: usize,
    },
    /// The corners of a face are not in one plane.
    NotPlanar {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The corner that is farthest from the plane, as its number in the face, from 0.
        corner: usize,
        /// The distance of the corner from the mean plane of all corners of the face, m.
        off: f64,
    },
    /// A face is not convex: it does not turn left at a corner, or goes round more than once.
    NotConvex {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The corner, as its number in the face, from 0.
        corner: usize,
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
    /// The number of a face's sides is not that of the panels.
    UnequalCorners {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The number of sides of the face.
        sides: usize,
        /// The number of sides of the panels.
        wanted: usize,
    },
    /// None of several panels is congruent with a face.
    NoPanel {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The lengths of the sides of the face, m.
        sides: Vec<f64>,
    },
    /// The sides of a face are as long as those of the panels, but its angles are others.
    UnequalAngles {
        /// The index of the face in the mesh, from 0.
        face: usize,
        /// The length of a diagonal of the face from a corner to the next but one, m.
        diagonal: f64,
        /// The length of that diagonal of the panels, m.
        wanted: f64,
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
    /// Returns the reason for the face of this index whose outline has a fault.
    pub(super) fn of_outline(face: usize, fault: OutlineFault) -> Unfoldable {
        match fault {
            OutlineFault::Degenerate => Unfoldable::Degenerate { face },
            OutlineFault::NotPlanar { corner, off } => Unfoldable::NotPlanar { face, corner, off },
            OutlineFault::NotConvex { corner } => Unfoldable::NotConvex { face, corner },
        }
    }

    /// Returns a hint to mend the mesh, as words for a message.
    pub fn remedy(&self) -> &'static str {
        match self {
            Unfoldable::Empty => "a target has at least one face",
            Unfoldable::TooLarge { .. } => "fold a coarser mesh, or its parts one by one",
            Unfoldable::Corners { .. } => "cut such faces into several",
            Unfoldable::NotPlanar { .. } => {
                "a panel is flat: cut the face into triangles, or move its corners into one plane"
            }
            Unfoldable::NotConvex { .. } => {
                "cut the face into convex ones, and leave out corners on a straight side"
            }
            Unfoldable::UnequalCorners { .. }
            | Unfoldable::UnequalAngles { .. }
            | Unfoldable::NoPanel { .. } => "panels have to be congruent with their faces",
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
            Unfoldable::Corners { face, corners, limit } => {
                write!(f, "face {face} has {corners} corners; 3 to {limit} can be planned")
            }
            Unfoldable::NotPlanar { face, corner, off } => write!(
                f,
                "face {face} is not flat: its corner {corner} is {:.4} mm off the plane of the others",
                off * 1e3
            ),
            Unfoldable::NotConvex { face, corner } => {
                write!(f, "face {face} is not convex at its corner {corner}")
            }
            Unfoldable::UnequalCorners { face, sides, wanted } => {
                write!(f, "face {face} has {sides} sides; the panels have {wanted}")
            }
            Unfoldable::NoPanel { face, sides } => {
                let lengths: Vec<String> = sides.iter().map(|side| format!("{:.4} mm", side * 1e3)).collect();
                write!(f, "face {face}, with sides of {}, is as none of the panels", listed(&lengths))
            }
            Unfoldable::UnequalAngles { face, diagonal, wanted } => write!(
                f,
                "face {face} has a diagonal of {:.4} mm; that of the panels is {:.4} mm",
                diagonal * 1e3,
                wanted * 1e3
            ),
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
