//! Validation of a start configuration: connected, loops closed, no overlap. Files of tangled robots name
//! some modules as connected by bonds that contradict each other; [`repair`] opens such bonds.

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
    match overlap(robot, &tree, &poses) {
        Some(overlap) => Err(Refusal::InvalidStart(overlap)),
        None => Ok(()),
    }
}

/// Opens the closed bonds whose docks do not meet, and returns their indices in [`Robot::bonds`], ascending. Of two
/// bonds between the same modules that contradict each other the one in the tree of a breadth-first search from module
/// 0 counts, unless only the other leaves no overlap; up to `TWINS_MAX` contradictions are tried in all combinations.
///
/// # Errors
/// [`InvalidStart`]: the robot is not connected, or modules overlap in all combinations; then nothing is opened.
pub fn repair(robot: &mut Robot) -> Result<Vec<usize>, InvalidStart> {
    let first = Choice::without(robot, &[])?;
    // Bonds for which the open ones could stand in.
    let twins: Vec<usize> = first.open.iter().filter_map(|&bond| twin(robot, bond)).collect();
    let choices = 1..1u32 << twins.len().min(TWINS_MAX);
    let others = choices.filter_map(|choice| {
        let avoided = twins.iter().enumerate().filter(|(i, _)| choice >> i & 1 == 1);
        let avoided: Vec<usize> = avoided.map(|(_, &bond)| bond).collect();
        Choice::without(robot, &avoided).ok()
    });
    let best = std::iter::once(first.clone()).chain(others).find(|choice| choice.overlap.is_none());
    match (best, first.overlap) {
        (Some(choice), _) => {
            choice.open.iter().for_each(|&bond| robot.undock(bond));
            Ok(choice.open)
        }
        (None, overlap) => Err(overlap.expect("the first choice is a choice")),
    }
}

/// Greatest number of contradictions of which all combinations are tried: 1,024 forward kinematics.
const TWINS_MAX: usize = 10;

/// Returns another closed bond between the same two modules; `None` if there is none.
fn twin(robot: &Robot, bond: usize) -> Option<usize> {
    let modules = |bond: usize| {
        let ends = robot.bonds[bond];
        (ends.a.module.min(ends.b.module), ends.a.module.max(ends.b.module))
    };
    robot.held().map(|(other, _)| other).find(|&other| other != bond && modules(other) == modules(bond))
}

/// The configuration without some bonds.
#[derive(Clone)]
struct Choice {
    /// Those bonds, and the others that do not meet then.
    open: Vec<usize>,
    overlap: Option<InvalidStart>,
}

impl Choice {
    fn without(robot: &Robot, avoided: &[usize]) -> Result<Choice, InvalidStart> {
        let mut tried = robot.clone();
        avoided.iter().for_each(|&bond| tried.undock(bond));
        let tree = Tree::grow(&tried, 0).ok_or_else(|| InvalidStart::Disconnected(loose(&tried)))?;
        let mut poses = Vec::new();
        tree.poses(&tried.joints, &mut poses);
        let mut open = avoided.to_vec();
        open.extend(
            tree.closing.iter().filter(|&&bond| tree.residual(&tried, bond, &poses) > TOLERANCES.closure),
        );
        open.sort_unstable();
        Ok(Choice { open, overlap: overlap(&tried, &tree, &poses) })
    }
}

/// Returns the first overlap of two modules that is found; `None` if there is none.
fn overlap(robot: &Robot, tree: &Tree, poses: &[RigidTransform]) -> Option<InvalidStart> {
    let docked = broad_phase::docked(robot, tree);
    let mut found = None;
    broad_phase::pairs(poses, TOLERANCES.min_distance, &mut |a, b, squared| {
        if found.is_none() && !broad_phase::always_touch(tree, a, b, &docked) {
            let (a, b) = (tree.shoe[a] / 2, tree.shoe[b] / 2);
            found =
                Some(InvalidStart::Overlap { modules: [a.min(b), a.max(b)], distance: libm::sqrt(squared) });
        }
    });
    found
}

/// Returns a module that is not connected to the first.
fn loose(robot: &Robot) -> usize {
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
