//! The loops of creases round the vertices of a sheet: rotations about creases and by the angles of the faces between
//! them that come to no rotation in all (Belcastro and Hull 2002, *Modelling the folding of paper into three dimensions
//! using affine transformations*).

use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;
use crate::planners::fold::Target;
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::fmt;

/// The number of equations of a loop: the rotation that is left over, about three axes.
const EQUATIONS: usize = 3;

/// The reason why a surface is not a sheet that folds from flat without a cut.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSheet {
    /// The angles of the faces at a vertex inside come to more or less than a full turn.
    Curved {
        /// The index of the vertex in the mesh.
        vertex: usize,
        /// The sum of the angles of its faces, rad.
        sum: f64,
    },
    /// The surface is no disk: it is closed, or has holes.
    NoDisk,
    /// Faces touch at a vertex without a chain of common edges round it.
    Pinched {
        /// The index of the vertex in the mesh.
        vertex: usize,
    },
}

impl fmt::Display for NoSheet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoSheet::Curved { vertex, sum } => write!(
                f,
                "the faces at vertex {vertex} enclose {:.4} degrees; those of a flat sheet come to 360",
                sum.to_degrees()
            ),
            NoSheet::NoDisk => f.write_str("a sheet has one border: this surface is closed, or has holes"),
            NoSheet::Pinched { vertex } => {
                write!(f, "at vertex {vertex} faces touch that no chain of common edges joins")
            }
        }
    }
}

/// The loop of creases round a vertex inside a sheet.
#[derive(Clone, Debug)]
pub struct VertexLoop {
    /// The index of the vertex in the mesh.
    pub vertex: usize,
    /// The creases round the vertex, counterclockwise, as indices in [`Target::hinges`], each with the angle (rad) of the
    /// face that follows it.
    pub turns: Vec<(usize, f64)>,
}

/// The loops of all vertices inside a sheet.
#[derive(Clone, Debug)]
pub struct Loops {
    creases: usize,
    /// The loops in the order of their vertices.
    pub loops: Vec<VertexLoop>,
}

impl Loops {
    /// Returns the loops of a surface that is a sheet.
    ///
    /// # Errors
    /// The reason why it is none.
    pub fn of(target: &Target) -> Result<Loops, NoSheet> {
        let mut loops = Vec::new();
        let mut corners: Vec<Vec<(usize, usize)>> = vec![Vec::new(); target.vertices.len()];
        for (face, named) in target.faces.iter().enumerate() {
            named.iter().enumerate().for_each(|(corner, vertex)| corners[*vertex].push((face, corner)));
        }
        for (vertex, around) in corners.iter().enumerate() {
            let Some(&first) = around.first() else { continue };
            let turns = turns_about(target, first);
            match turns {
                Some(turns) if turns.len() == around.len() => {
                    let sum: f64 = turns.iter().map(|(_, angle)| angle).sum();
                    if (sum - 2.0 * PI).abs() > TOLERANCES.flat_vertex {
                        return Err(NoSheet::Curved { vertex, sum });
                    }
                    loops.push(VertexLoop { vertex, turns });
                }
                Some(_) => return Err(NoSheet::Pinched { vertex }),
                // At the border: the faces are one chain.
                None => {
                    let ends = around.iter().filter(|(face, corner)| target.sides[*face][*corner].is_none());
                    if ends.count() != 1 {
                        return Err(NoSheet::Pinched { vertex });
                    }
                }
            }
        }
        // Euler's characteristic of a disk.
        let used = corners.iter().filter(|around| !around.is_empty()).count();
        let edges: usize = target.arc_count() - target.hinges.len();
        if used + target.faces.len() != edges + 1 {
            return Err(NoSheet::NoDisk);
        }
        Ok(Loops { creases: target.hinges.len(), loops })
    }

    /// Returns the rotations that are left over round all vertices, as vectors (rad), three numbers for each; all 0 where
    /// the sheet is in one piece. `angles`: of the creases, in the order of [`Target::hinges`], rad.
    pub fn residuals(&self, angles: &[f64]) -> DVector<f64> {
        let mut all = DVector::zeros(EQUATIONS * self.loops.len());
        for (row, each) in self.loops.iter().enumerate() {
            let mut whole = Matrix3::<f64>::identity();
            each.turns.iter().for_each(|(crease, sector)| whole *= turn(angles[*crease], *sector));
            let left =
                [whole[(2, 1)] - whole[(1, 2)], whole[(0, 2)] - whole[(2, 0)], whole[(1, 0)] - whole[(0, 1)]];
            (0..EQUATIONS).for_each(|axis| all[EQUATIONS * row + axis] = left[axis] / 2.0);
        }
        all
    }

    /// Returns the greatest rotation that is left over round a vertex, rad.
    pub fn gap(&self, angles: &[f64]) -> f64 {
        let left = self.residuals(angles);
        (0..self.loops.len()).map(|k| left.fixed_rows::<EQUATIONS>(EQUATIONS * k).norm()).fold(0.0, f64::max)
    }

    /// Returns the derivatives of [`Loops::residuals`] by the angles where the loops are closed: the directions of the
    /// creases.
    pub fn jacobian(&self, angles: &[f64]) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(EQUATIONS * self.loops.len(), self.creases);
        for (row, each) in self.loops.iter().enumerate() {
            let mut before = Matrix3::<f64>::identity();
            for (crease, sector) in &each.turns {
                let axis: Vec3 = before * Vec3::x();
                (0..EQUATIONS).for_each(|k| all[(EQUATIONS * row + k, *crease)] += axis[k]);
                before *= turn(angles[*crease], *sector);
            }
        }
        all
    }
}

/// Returns the rotation about a crease, which lies along x, and then by the angle of a face to the next crease.
fn turn(fold: f64, sector: f64) -> Matrix3<f64> {
    (Rotation3::from_axis_angle(&Vec3::x_axis(), fold) * Rotation3::from_axis_angle(&Vec3::z_axis(), sector))
        .into_inner()
}

/// Returns the creases round a vertex, counterclockwise, each with the angle of the face that follows it, from the given
/// corner of a face on; `None` where the vertex is at the border.
fn turns_about(target: &Target, first: (usize, usize)) -> Option<Vec<(usize, f64)>> {
    let mut turns = Vec::new();
    let mut seen = BTreeSet::new();
    let (mut face, mut corner) = first;
    while seen.insert(face) {
        let outline = target.corners(face);
        let sides = outline.len();
        let before = (corner + sides - 1) % sides;
        let (ahead, back) =
            (outline[(corner + 1) % sides] - outline[corner], outline[before] - outline[corner]);
        // The face begins at its side from the vertex on, and ends at the side that comes to it.
        let crease = target.sides[face][corner]?;
        turns.push((crease, libm::atan2(ahead.cross(&back).norm(), ahead.dot(&back))));
        let hinge = &target.hinges[target.sides[face][before]?];
        let end = usize::from(hinge.faces[0] == face && hinge.sides[0] == before);
        (face, corner) = (hinge.faces[end], hinge.sides[end]);
    }
    Some(turns)
}
