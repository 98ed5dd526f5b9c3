//! The folded form of a crease pattern: a flat sheet whose creases have stated angles.

use super::loops::{Loops, NoSheet};
use super::path;
use super::plan::{CREASES_MAX, spanning_tree};
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;
use crate::planners::fold::Target;
use crate::planners::fold::kinematics::poses_at;
use nalgebra::DVector;
use std::fmt;

/// The reason why a crease pattern has no folded form with its angles.
#[derive(Clone, Debug, PartialEq)]
pub enum Unclosed {
    /// The pattern is no flat sheet.
    NoSheet(NoSheet),
    /// The sheet has more creases than can be planned for.
    TooManyCreases {
        /// The number of creases.
        creases: usize,
    },
    /// The loop of creases round a vertex is open, and no angles near the stated ones close it.
    Open {
        /// The index of the vertex.
        vertex: usize,
        /// The rotation that is left over round it, rad.
        gap: f64,
    },
}

impl Unclosed {
    /// Returns the index of the vertex at which the sheet does not fold; `None` if it is not at a vertex.
    pub fn vertex(&self) -> Option<usize> {
        match self {
            Unclosed::Open { vertex, .. }
            | Unclosed::NoSheet(NoSheet::Curved { vertex, .. } | NoSheet::Pinched { vertex }) => {
                Some(*vertex)
            }
            Unclosed::NoSheet(NoSheet::NoDisk) | Unclosed::TooManyCreases { .. } => None,
        }
    }
}

impl fmt::Display for Unclosed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unclosed::NoSheet(why) => why.fmt(f),
            Unclosed::TooManyCreases { creases } => {
                write!(f, "the sheet has {creases} creases; at most {CREASES_MAX} can be planned")
            }
            Unclosed::Open { vertex, gap } => write!(
                f,
                "with these angles the sheet tears at vertex {vertex}: {:.2} degrees are left over round it, and no \
                 angles within a degree of these close all loops",
                gap.to_degrees()
            ),
        }
    }
}

/// Returns the places of the vertices (m) of a flat sheet when its creases have these angles (rad, positive where the fold
/// is convex as seen from the front), in the order of [`Target::hinges`]. Angles that leave loops open by what is rounded
/// are mended, none by more than a degree. Face 0 stays where it is.
///
/// # Errors
/// [`Unclosed`] where there is no such form.
pub fn folded(flat: &Target, angles: &[f64]) -> Result<Vec<Vec3>, Unclosed> {
    let loops = Loops::of(flat).map_err(Unclosed::NoSheet)?;
    if flat.hinges.len() > CREASES_MAX {
        return Err(Unclosed::TooManyCreases { creases: flat.hinges.len() });
    }
    let open = || {
        let left = loops.residuals(angles);
        let gap = |k: usize| left.fixed_rows::<3>(3 * k).norm();
        let worst = (0..loops.loops.len()).max_by(|a, b| gap(*a).total_cmp(&gap(*b)));
        let worst = worst.expect("without loops everything closes");
        Unclosed::Open { vertex: loops.loops[worst].vertex, gap: gap(worst) }
    };
    let stated = DVector::from_column_slice(angles);
    let closed = path::closed(&loops, stated.clone()).ok_or_else(open)?;
    if (&closed - &stated).amax() > TOLERANCES.stated {
        return Err(open());
    }
    let tree = spanning_tree(flat, 0);
    let poses = poses_at(flat, &tree, |face| tree.hinge[face].map_or(0.0, |hinge| closed[hinge]));
    let mut places = flat.vertices.clone();
    for &face in tree.order.iter().rev() {
        for &vertex in &flat.faces[face] {
            places[vertex] = poses[face].transform_point(&flat.vertices[vertex].into()).coords;
        }
    }
    Ok(places)
}
