//! The paper's own method, to compare with: tentacles that meet by [`fabrik`](super::fabrik), and going
//! back over pairs of tips. It looks at the ends of moves, not at what is on the way, so its plans are
//! for the judge to refuse.
//!
//! Different from the paper: a pair that lies on one chain is not tried, for nothing is gained by it
//! and the search would not end; each pair is tried once, not in either order.

use super::fabrik::{Chain, TOUCHING};
use super::merging;
use super::near;
use super::robot::{Bond, Dock, Robot};
use super::sound;
use super::state::State;
use super::tree::Tree;
use super::{Collisions, Found, Progress, Refusal, Settings};
use crate::geometry::Vec3;

/// A state, and the pairs of tips that are still to be tried from there.
struct Level {
    state: State,
    pairs: Vec<[Dock; 2]>,
}

/// `TOSNAKE` of the paper.
pub fn unwind(
    robot: &Robot,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Found, Refusal> {
    sound::check(robot)?;
    let mut state = State::new(robot.clone());
    root(&mut state);
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    root(&mut state);
    let needed = state.bad_bonds();
    let mut progress = Progress { needed, ..Progress::default() };
    progress.see(&state);
    let (mut work, mut best) = (state.work, progress);
    let mut levels = vec![Level { pairs: pairs(&state), state }];
    let mut without_tips = true;
    while let Some(level) = levels.last_mut() {
        if level.state.bad_bonds() == 0 {
            let mut state = level.state.clone();
            state.go(&vec![[0.0; 3]; robot.modules()]);
            progress.work = work;
            return Ok(Found { robot: state.robot, steps: state.steps, progress });
        }
        progress.made = needed - level.state.bad_bonds();
        progress.work = work;
        if progress.made > best.made {
            progress.see(&level.state);
            best = progress;
        }
        if work > settings.budget || !watch(&progress) {
            let reached = Progress { tried: progress.tried, work, ..best };
            return Err(if work > settings.budget {
                Refusal::Budget(reached)
            } else {
                Refusal::Stopped(reached)
            });
        }
        let Some(pair) = level.pairs.pop() else {
            levels.pop();
            continue;
        };
        without_tips = false;
        progress.tried += 1;
        if let Some(state) = connected_and_cut(&level.state, pair, settings, &mut work) {
            levels.push(Level { pairs: pairs(&state), state });
        }
    }
    let reached = Progress { tried: progress.tried, work, ..best };
    Err(if without_tips { Refusal::NoTips(reached) } else { Refusal::Exhausted(reached) })
}

/// `CONNECTANDCUT` of the paper: the state with the tips of a pair together, and another bond let go.
fn connected_and_cut(state: &State, [a, b]: [Dock; 2], settings: &Settings, work: &mut u64) -> Option<State> {
    let chain = Chain::new(state, a, b);
    if !chain.reaches() {
        return None;
    }
    let avoid = settings.collisions == Collisions::Avoidance;
    let (joints, _) = chain.close(&state.robot.joints, &settings.fabrik, avoid, work);
    let joints = joints?;
    let tree = &state.tree;
    let path = tree.path(tree.place[a.shoe()], tree.place[b.shoe()]);
    let mut bonds = path.places.windows(2).filter_map(|step| tree.bond(step[0].max(step[1])));
    let cut = bonds.find(|bond| !state.robot.bonds[*bond].is_good())?;
    let mut next = state.clone();
    next.go(&joints);
    next.dock(Bond { a, b, turn: 0 });
    next.undock(cut);
    root(&mut next);
    *work += 1;
    let free = settings.collisions == Collisions::None
        || near::least(&next.tree, &next.docked, &next.poses, TOUCHING) >= TOUCHING;
    free.then_some(next)
}

/// Grows the tree from the module that is nearest to the middle of all.
fn root(state: &mut State) {
    let middle = state.poses.iter().fold(Vec3::zeros(), |sum, pose| sum + pose.translation);
    let middle = middle / state.poses.len() as f64;
    let off = |module: usize| {
        let balls = [2 * module, 2 * module + 1].map(|shoe| state.poses[state.tree.place[shoe]].translation);
        (0.5 * (balls[0] + balls[1]) - middle).norm_squared()
    };
    let nearest = (0..state.robot.modules()).min_by(|&m, &n| off(m).total_cmp(&off(n))).unwrap_or(0);
    state.tree = Tree::grow(&state.robot, nearest).expect("what is let go closed a loop");
    state.docked = near::docked(&state.robot, &state.tree);
    state.place();
}

/// Pairs of free tips of different chains, the first to be tried last.
fn pairs(state: &State) -> Vec<[Dock; 2]> {
    let mut pairs = merging::free_ends(state);
    pairs.reverse();
    pairs
}
