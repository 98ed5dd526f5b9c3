//! The paper's own method, for comparison: tentacles that meet by [`fabrik`](super::fabrik), and backtracking
//! over pairs of tips. Only ends of moves are checked for collisions, not the motions between them, so its
//! plans are for the judge to refuse.
//!
//! One thing differs from the paper: a pair of one chain is not tried, for nothing is gained by it and the
//! search would not end.

use super::broad_phase;
use super::fabrik::{Chain, TOUCHING};
use super::merging;
use super::refusal::Refusal;
use super::robot::{Bond, Dock, Robot};
use super::search::StepSequence;
use super::settings::{Collisions, Settings};
use super::state::State;
use super::status::{Reporter, SearchStatus};
use super::tree::Tree;
use super::validation;
use crate::geometry::Vec3;

/// A node of the depth-first search: a state, and the pairs of tips that are still to be tried from there,
/// the next one last.
struct Level {
    state: State,
    pairs: Vec<[Dock; 2]>,
}

/// Searches for the steps to the snake by the algorithm TOSNAKE of [Mrázek et al.](super), a depth-first search over
/// pairs of free docks.
///
/// # Errors
/// A [`Refusal`]: the start is invalid, all pairs were tried, the budget of forward kinematics is spent, or the
/// observer ended the search.
pub(super) fn unwind(
    robot: &Robot,
    settings: &Settings,
    reporter: &mut Reporter,
) -> Result<StepSequence, Refusal> {
    validation::check(robot)?;
    // Loops are opened.
    let mut state = State::new(robot.clone());
    root_in_centre(&mut state);
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    root_in_centre(&mut state);
    let needed = state.other_bonds();
    let mut status = SearchStatus { needed, ..SearchStatus::default() };
    status.count_chains(&state);
    let (mut work, mut best) = (state.work, status);
    let mut levels = vec![Level { pairs: pairs(&state), state }];
    let mut without_tips = true;
    while let Some(level) = levels.last_mut() {
        // One chain is a snake but for its joints.
        if level.state.other_bonds() == 0 {
            let mut state = level.state.clone();
            state.move_to(&vec![[0.0; 3]; robot.modules()]);
            status.work = work;
            return Ok(StepSequence { robot: state.robot, steps: state.steps, status });
        }
        status.made = needed - level.state.other_bonds();
        status.work = work;
        if status.made > best.made {
            status.count_chains(&level.state);
            best = status;
        }
        if work > settings.budget || !reporter.report(&status) {
            let reached = SearchStatus { tried: status.tried, work, ..best };
            return Err(if work > settings.budget {
                Refusal::BudgetSpent(reached)
            } else {
                Refusal::Stopped(reached)
            });
        }
        // The next pair; without one the search backtracks.
        let Some(pair) = level.pairs.pop() else {
            levels.pop();
            continue;
        };
        without_tips = false;
        status.tried += 1;
        if let Some(state) = connected_and_cut(&level.state, pair, settings, &mut work) {
            levels.push(Level { pairs: pairs(&state), state });
        }
    }
    let reached = SearchStatus { tried: status.tried, work, ..best };
    Err(if without_tips { Refusal::NoFreeTips(reached) } else { Refusal::Exhausted(reached) })
}

/// Returns the state with the tips of a pair docked, and the first bond between them undocked that is not a snake bond
/// (`CONNECTANDCUT` of the paper); `None` if the tips do not come together, or balls overlap then and collisions are
/// checked.
fn connected_and_cut(state: &State, [a, b]: [Dock; 2], settings: &Settings, work: &mut u64) -> Option<State> {
    let chain = Chain::new(state, a, b);
    if !chain.is_long_enough() {
        return None;
    }
    let avoid = settings.collisions == Collisions::Avoidance;
    let (joints, _) = chain.solve(&state.robot.joints, &settings.fabrik, avoid, work);
    let joints = joints?;
    let tree = &state.tree;
    let path = tree.path(tree.index[a.shoe()], tree.index[b.shoe()]);
    let mut bonds = path.indices.windows(2).filter_map(|step| tree.bond(step[0].max(step[1])));
    let cut = bonds.find(|bond| !state.robot.bonds[*bond].is_snake_bond())?;
    let mut next = state.clone();
    next.move_to(&joints);
    next.dock(Bond { a, b, turn: 0 });
    next.undock(cut);
    root_in_centre(&mut next);
    *work += 1;
    let free = settings.collisions == Collisions::None
        || broad_phase::least_distance(&next.tree, &next.docked, &next.poses, TOUCHING) >= TOUCHING;
    free.then_some(next)
}

/// Grows the tree from the module nearest to the centroid of all balls.
fn root_in_centre(state: &mut State) {
    let centroid = state.poses.iter().fold(Vec3::zeros(), |sum, pose| sum + pose.translation);
    let centroid = centroid / state.poses.len() as f64;
    let squared_distance = |module: usize| {
        let balls = [2 * module, 2 * module + 1].map(|shoe| state.poses[state.tree.index[shoe]].translation);
        (0.5 * (balls[0] + balls[1]) - centroid).norm_squared()
    };
    let nearest = (0..state.robot.modules())
        .min_by(|&m, &n| squared_distance(m).total_cmp(&squared_distance(n)))
        .unwrap_or(0);
    state.tree = Tree::grow(&state.robot, nearest).expect("the bond that was undocked closed a loop");
    state.docked = broad_phase::docked(&state.robot, &state.tree);
    state.update_poses();
}

/// Returns the ordered pairs of free tips of different chains, the first to be tried last. The order of the two decides from
/// which the chain is closed, and which bond is cut.
fn pairs(state: &State) -> Vec<[Dock; 2]> {
    let pairs = merging::free_ends(state);
    let mut ordered: Vec<[Dock; 2]> = pairs.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]).collect();
    ordered.sort_unstable_by(|p, q| q.cmp(p));
    ordered
}
