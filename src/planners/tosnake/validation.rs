//! Validation of a start configuration: connected, loops closed, no overlap.

use super::broad_phase;
use super::refusal::{InvalidStart, Refusal};
use super::robot::Robot;
use super::tolerances::TOLERANCES;
use super::tree::Tree;
use crate::geometry::RigidTransform;

/// Checks that closed bonds connect all modules, that the docks of those that close loops meet, and that no two modules
/// overlap.
///
/// # Errors
/// [`Refusal::InvalidStart`] for a robot that is not connected or overlaps, [`Refusal::OpenLoop`] for a bond whose
/// docks do not meet.
pub(super) fn check(robot: &Robot) -> Result<(), Refusal> {
    let tree = Tree::grow(robot, 0)
        .ok_or_else(|| Refusal::InvalidStart(InvalidStart::Disconnected(loose(robot))))?;
    let mut poses = Vec::new();
    tree.poses(&robot.joints, &mut poses);
    for &bond in &tree.closing {
        let residual = tree.residual(robot, bond, &poses);
        if residual > TOLERANCES.closure {
            return Err(Refusal::OpenLoop { bond, residual });
        }
    }
    // The one that the fewest bonds force is the easiest to mend.
    match overlaps(robot, &tree, &poses).iter().min_by_key(|overlap| overlap.bonds(&tree).len()) {
        Some(overlap) => Err(Refusal::InvalidStart(overlap.refusal(&tree))),
        None => Ok(()),
    }
}

/// Two balls that overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overlap {
    /// The indices of the two balls in the tree's order, the smaller first.
    pub(super) balls: [usize; 2],
    /// The distance of their centres, in pitches.
    pub(super) distance: f64,
}

impl Overlap {
    /// Returns the closed bonds between the two balls in the tree, by their indices in [`Robot::bonds`], from the one
    /// ball to the other: as long as these hold and no joint turns, the overlap stays.
    pub(super) fn bonds(&self, tree: &Tree) -> Vec<usize> {
        let path = tree.path(self.balls[0], self.balls[1]);
        path.indices.windows(2).filter_map(|step| tree.bond(step[0].max(step[1]))).collect()
    }

    /// Returns the refusal of a start with this overlap; `tree`: that by whose order balls are counted.
    pub(super) fn refusal(&self, tree: &Tree) -> InvalidStart {
        let [a, b] = self.balls.map(|ball| tree.shoe[ball] / 2);
        let mut bonds = self.bonds(tree);
        if a > b {
            bonds.reverse();
        }
        InvalidStart::Overlap { modules: [a.min(b), a.max(b)], distance: self.distance, bonds }
    }
}

/// Returns the overlaps of balls, in the order in which the broad phase finds them. `poses`: of the shoes, in the
/// tree's order, in pitches.
pub(super) fn overlaps(robot: &Robot, tree: &Tree, poses: &[RigidTransform]) -> Vec<Overlap> {
    let docked = broad_phase::docked(robot, tree);
    let mut found = Vec::new();
    broad_phase::pairs(poses, TOLERANCES.min_distance, &mut |a, b, squared| {
        if !broad_phase::always_touch(tree, a, b, &docked) {
            found.push(Overlap { balls: [a.min(b), a.max(b)], distance: libm::sqrt(squared) });
        }
    });
    found
}

/// Returns a module that is not connected to the first.
pub(super) fn loose(robot: &Robot) -> usize {
    let mut reached = vec![false; robot.modules()];
    let mut open = vec![0];
    reached[0] = true;
    while let Some(module) = open.pop() {
        for (_, bond) in robot.held().filter(|(_, b)| b.a.module == module || b.b.module == module) {
            let other = if bond.a.module == module { bond.b.module } else { bond.a.module };
            if !reached[other] {
                reached[other] = true;
                open.push(other);
            }
        }
    }
    reached.iter().position(|reached| !reached).unwrap_or(0)
}
