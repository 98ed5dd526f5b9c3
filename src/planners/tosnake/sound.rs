//! Whether a configuration can be: in one piece, loops closed, no overlap. Files of tangled robots say
//! of some modules that they hold each other in two ways that contradict each other.

use super::Refusal;
use super::near;
use super::robot::Robot;
use super::sweep::APART;
use super::tree::Tree;
use crate::geometry::RigidTransform;

/// Docks of a loop that are farther from meeting than this hold nothing, whatever is said of them; the
/// limit of RoFI's own tools.
pub const OPEN_MAX: f64 = 1e-3;

/// What keeps a configuration from being.
#[derive(Clone, Debug, PartialEq)]
pub enum Unsound {
    /// This module hangs on nothing.
    Loose(usize),
    /// These modules are in each other, with the distance of the balls in parts of the pitch.
    Overlap(usize, usize, f64),
}

/// Whether all bonds meet, and no two modules are in each other.
pub fn check(robot: &Robot) -> Result<(), Refusal> {
    let tree = Tree::grow(robot, 0).ok_or_else(|| Refusal::Unsound(Unsound::Loose(loose(robot))))?;
    let mut poses = Vec::new();
    tree.poses(&robot.joints, &mut poses);
    for &bond in &tree.closing {
        let missing = tree.missing(robot, bond, &poses);
        if missing > OPEN_MAX {
            return Err(Refusal::Open { bond, missing });
        }
    }
    match overlap(robot, &tree, &poses) {
        Some(overlap) => Err(Refusal::Unsound(overlap)),
        None => Ok(()),
    }
}

/// Lets go the bonds that can't hold; gives their numbers. Of two bonds that contradict each other the
/// first counts, unless only the other leaves no overlap.
pub fn mend(robot: &mut Robot) -> Result<Vec<usize>, Unsound> {
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

/// Contradictions of which all combinations are tried.
const TWINS_MAX: usize = 10;

/// Another bond between the same two modules.
fn twin(robot: &Robot, bond: usize) -> Option<usize> {
    let modules = |bond: usize| {
        let ends = robot.bonds[bond];
        (ends.a.module.min(ends.b.module), ends.a.module.max(ends.b.module))
    };
    robot.held().map(|(other, _)| other).find(|&other| other != bond && modules(other) == modules(bond))
}

/// What follows if some bonds do not count.
#[derive(Clone)]
struct Choice {
    /// Those, and the others that do not meet then.
    open: Vec<usize>,
    overlap: Option<Unsound>,
}

impl Choice {
    fn without(robot: &Robot, avoided: &[usize]) -> Result<Choice, Unsound> {
        let mut tried = robot.clone();
        avoided.iter().for_each(|&bond| tried.undock(bond));
        let tree = Tree::grow(&tried, 0).ok_or_else(|| Unsound::Loose(loose(&tried)))?;
        let mut poses = Vec::new();
        tree.poses(&tried.joints, &mut poses);
        let mut open = avoided.to_vec();
        open.extend(tree.closing.iter().filter(|&&bond| tree.missing(&tried, bond, &poses) > OPEN_MAX));
        open.sort_unstable();
        Ok(Choice { open, overlap: overlap(&tried, &tree, &poses) })
    }
}

fn overlap(robot: &Robot, tree: &Tree, poses: &[RigidTransform]) -> Option<Unsound> {
    let docked = near::docked(robot, tree);
    let mut found = None;
    near::pairs(poses, APART, &mut |a, b, squared| {
        if found.is_none() && !near::touch_always(tree, a, b, &docked) {
            let (a, b) = (tree.shoe[a] / 2, tree.shoe[b] / 2);
            found = Some(Unsound::Overlap(a.min(b), a.max(b), libm::sqrt(squared)));
        }
    });
    found
}

/// A module that does not hang together with the first.
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
