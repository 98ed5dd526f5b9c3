//! The nodes at which a truss is held, so that it can't move as a rigid body.

use super::truss::TOLERANCES;
use crate::geometry::Vec3;

/// Three nodes of a truss far from each other: node 0, one that it turns about with the first, and a third one beside them.
pub(super) struct PinnedNodes {
    /// The index of the node that is farthest from node 0.
    pub second: usize,
    /// The index of the node that is farthest from the line of both.
    pub third: usize,
    /// The vector from node 0 to the second one, m.
    pub along: Vec3,
    /// The unit normal of the plane of the three.
    pub normal: Vec3,
}

impl PinnedNodes {
    /// Returns three of some nodes, given by their positions (m); `None` where all lie on a line.
    pub(super) fn of(nodes: &[Vec3]) -> Option<PinnedNodes> {
        let far = |weigh: &dyn Fn(&Vec3) -> f64| {
            (0..nodes.len()).max_by(|&i, &j| weigh(&nodes[i]).total_cmp(&weigh(&nodes[j])))
        };
        let first = *nodes.first()?;
        let second = far(&|p| (p - first).norm())?;
        let along = nodes[second] - first;
        let third = far(&|p| along.cross(&(p - first)).norm())?;
        let normal = along.cross(&(nodes[third] - first));
        if normal.norm() <= along.norm_squared() * TOLERANCES.on_line {
            return None;
        }
        Some(PinnedNodes { second, third, along, normal: normal.normalize() })
    }
}
