//! What must not fall below zero: lengths, distances between struts, heights. Each has a value and a
//! gradient over the nodes.

use super::segment::{self, Witness};
use super::structure::Structure;
use crate::geometry::Vec3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bound {
    /// Of a strut.
    Shortest(usize),
    Longest(usize),
    /// Two struts, the lower first.
    Apart(usize, usize),
    /// An end (0 or 1) of a strut and another strut: beside `Apart` where two are nearly parallel, so
    /// that their nearest points jump from end to end.
    EndApart(usize, usize, usize),
    /// A node above the ground.
    Above(usize),
}

impl Bound {
    /// Metres; not below zero.
    pub fn value(self, truss: &Structure, x: &[Vec3]) -> f64 {
        match self {
            Bound::Shortest(strut) => truss.length(x, strut) - truss.length.0,
            Bound::Longest(strut) => truss.length.1 - truss.length(x, strut),
            Bound::Apart(..) | Bound::EndApart(..) => self.witness(truss, x).distance - truss.clearance,
            Bound::Above(node) => x[node].z,
        }
    }

    /// By node.
    pub fn gradient(self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
        match self {
            Bound::Shortest(strut) | Bound::Longest(strut) => {
                let (a, b) = truss.struts[strut];
                let sign = if matches!(self, Bound::Shortest(_)) { 1.0 } else { -1.0 };
                let along = (x[a] - x[b]).normalize() * sign;
                vec![(a, along), (b, -along)]
            }
            Bound::Apart(i, j) | Bound::EndApart(i, _, j) => {
                let Witness { normal, along: (s, t), .. } = self.witness(truss, x);
                let ((a, b), (c, d)) = (truss.struts[i], truss.struts[j]);
                vec![(a, normal * (1.0 - s)), (b, normal * s), (c, -normal * (1.0 - t)), (d, -normal * t)]
            }
            Bound::Above(node) => vec![(node, Vec3::z())],
        }
    }

    fn witness(self, truss: &Structure, x: &[Vec3]) -> Witness {
        match self {
            Bound::Apart(i, j) => segment::nearest(truss.segment(x, i), truss.segment(x, j)),
            Bound::EndApart(i, end, j) => {
                segment::nearest_to_end(truss.segment(x, i), end, truss.segment(x, j))
            }
            _ => unreachable!("only distances have witnesses"),
        }
    }
}
