//! The reasons why a file is no mesh, no cloud and no crease pattern.

use std::fmt;

/// The reason why a file of a mesh, a point cloud or a crease pattern can't be read. Lines count from 1, vertices and faces from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FormatFault {
    /// The bytes of a text format are not UTF-8.
    NotText,
    /// The file holds no lines but empty ones and comments.
    Empty,
    /// The file can be read, and holds none of what is wanted.
    Nothing {
        /// The things wanted, in words: points, faces, triangles.
        what: &'static str,
    },
    /// A coordinate is infinite or not a number.
    NotFinite {
        /// The index of the vertex in the file, from 0.
        vertex: usize,
    },
    /// A face has fewer than three corners.
    FewCorners {
        /// The index of the face in the file, from 0.
        face: usize,
    },
    /// A corner of a face is not a vertex of the file.
    NoVertex {
        /// The index of the face in the file, from 0.
        face: usize,
        /// The index of the vertex that the corner names, from 0.
        corner: usize,
        /// The number of vertices of the file.
        count: usize,
    },
    /// A corner of some face of an OBJ file is not a vertex of the file.
    NoSuchVertex,
    /// The first word of an OFF file is none of the format's.
    NotOff {
        /// The number of the line, from 1.
        line: usize,
        /// The word that stands in that place of the file.
        found: String,
    },
    /// The file is a binary OFF file.
    BinaryOff {
        /// The number of the line that says so, from 1.
        line: usize,
    },
    /// The line of an OFF file with the numbers of vertices and faces is missing.
    NoCounts,
    /// The number of vertices or of faces of an OFF file is missing.
    NoCount {
        /// The number of the line, from 1.
        line: usize,
        /// The things counted, as a word: vertices or faces.
        what: &'static str,
    },
    /// The number of vertices or of faces of an OFF file is not a whole number.
    BadCount {
        /// The number of the line, from 1.
        line: usize,
        /// The things counted, as a word: vertices or faces.
        what: &'static str,
        /// The word that stands in that place of the file.
        found: String,
    },
    /// An OFF file ends before all the vertices or faces that it announces.
    Ends {
        /// The things counted, as a word: vertices or faces.
        what: &'static str,
        /// The number of vertices or faces that were found.
        found: usize,
        /// The number of vertices or faces that the file announces.
        wanted: usize,
    },
    /// A line of an OFF or STL file does not hold the vertex or face that has to stand there.
    BadLine {
        /// The number of the line, from 1.
        line: usize,
        /// The thing wanted, in words: a vertex, a face.
        what: &'static str,
    },
    /// A line of an XYZ file does not begin with three numbers.
    NotThreeNumbers {
        /// The number of the line, from 1.
        line: usize,
    },
    /// A line of an OBJ file is not UTF-8.
    LineNotText {
        /// The number of the line, from 1.
        line: usize,
    },
    /// The length of an STL file is not that of its number of binary triangles, and it is not a text.
    StlLength,
    /// The number of corners of an STL text is not a multiple of three.
    IncompleteTriangle,
    /// The header of a PLY file announces more rows than the file has bytes.
    Announced {
        /// The name of the rows' element, such as `vertex`.
        element: String,
        /// The number of rows that the header announces.
        count: usize,
    },
    /// A vertex of a PLY file lacks a coordinate.
    NoCoordinates {
        /// The index of the vertex in the file, from 0.
        vertex: usize,
    },
    /// A face of a PLY file has no corners.
    NoCornerList {
        /// The index of the face in the file, from 0.
        face: usize,
    },
    /// A drawing has a part that is not read, or is no crease pattern.
    Drawing {
        /// The part that was found, in words, with its place.
        found: String,
        /// The remedy, in words.
        mend: String,
    },
    /// A failure that the crate which reads the format reports, in its words, with the line if it gives one.
    Reader(String),
}

impl FormatFault {
    /// Returns a hint to mend the file, as words for a message; `None` where the fault says it all.
    pub fn remedy(&self) -> Option<&str> {
        if let FormatFault::Drawing { mend, .. } = self { Some(mend) } else { None }
    }
}

impl fmt::Display for FormatFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            FormatFault::NotText => f.write_str("it is no text"),
            FormatFault::Empty => f.write_str("it is empty"),
            FormatFault::Nothing { what } => write!(f, "it holds no {what}"),
            FormatFault::NotFinite { vertex } => {
                write!(f, "a coordinate of vertex {vertex} is no finite number")
            }
            FormatFault::FewCorners { face } => write!(f, "face {face} has fewer than three corners"),
            FormatFault::NoVertex { face, corner, count } => {
                write!(f, "face {face} names vertex {corner}; there are {count}")
            }
            FormatFault::NoSuchVertex => f.write_str("a face names a vertex that there isn't"),
            FormatFault::NotOff { line, found } => write!(f, "line {line}: `OFF` is wanted, not `{found}`"),
            FormatFault::BinaryOff { line } => write!(f, "line {line}: binary OFF is not read"),
            FormatFault::NoCounts => f.write_str("the counts are missing"),
            FormatFault::NoCount { line, what } => {
                write!(f, "line {line}: the number of {what} is missing")
            }
            FormatFault::BadCount { line, what, found } => {
                write!(f, "line {line}: `{found}` is no number of {what}")
            }
            FormatFault::Ends { what, found, wanted } => {
                write!(f, "it ends after {found} of {wanted} {what}")
            }
            FormatFault::BadLine { line, what } => write!(f, "line {line} is no {what}"),
            FormatFault::NotThreeNumbers { line } => write!(f, "line {line}: three numbers are wanted"),
            FormatFault::LineNotText { line } => write!(f, "line {line}: no text"),
            FormatFault::StlLength => f.write_str("its length does not fit its triangles"),
            FormatFault::IncompleteTriangle => f.write_str("its last triangle is not complete"),
            FormatFault::Announced { element, count } => {
                write!(f, "its header announces {count} of `{element}`, which it does not hold")
            }
            FormatFault::NoCoordinates { vertex } => {
                write!(f, "vertex {vertex} has no numbers `x`, `y` and `z`")
            }
            FormatFault::NoCornerList { face } => write!(f, "face {face} has no list `vertex_indices`"),
            FormatFault::Drawing { found, .. } => f.write_str(found),
            FormatFault::Reader(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for FormatFault {}
