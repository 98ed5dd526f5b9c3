//! Inverse kinematics of two ends that are to meet: damped least squares, which plans are made with,
//! beside the paper's FABRIK. Both from the same straightened tangles, for the same pairs of ends.
//!
//! `cargo bench --bench tosnake_closing`. FABRIK closes to the paper's 0.02, and looks at no collision; least
//! squares close to 1e-11 with no ball in another, or fail. So what FABRIK closes is counted twice: as it
//! is, and where no ball is in another.

use modl::optimize::random::SplitMix64;
use modl::planners::tosnake::fabrik::{self, Chain, TOUCHING};
use modl::planners::tosnake::inverse_kinematics::{self, IkMode, MovingSide};
use modl::planners::tosnake::merging::{self, Attempt, Pair};
use modl::planners::tosnake::random_configuration::random_configuration;
use modl::planners::tosnake::state::State;
use modl::planners::tosnake::{broad_phase, straighten};
use std::time::Instant;

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const SIZES: [usize; 5] = [12, 24, 48, 96, 192];
const SEEDS: u64 = 4;
/// The most promising of every tangle.
const PAIRS: usize = 20;

/// Microseconds of calls that closed and of calls that did not.
#[derive(Default)]
struct Times {
    closed: Vec<f64>,
    failed: Vec<f64>,
    free: usize,
}

impl Times {
    fn count(&mut self, time: f64, closed: bool, free: bool) {
        if closed {
            self.closed.push(time)
        } else {
            self.failed.push(time)
        }
        self.free += usize::from(free);
    }

    fn print(&mut self, modules: usize, name: &str) {
        let calls = self.closed.len() + self.failed.len();
        let median = |times: &mut Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times.get(times.len() / 2).map_or_else(|| "none".into(), |time| format!("{time:.0} us"))
        };
        let (closed, failed) = (median(&mut self.closed), median(&mut self.failed));
        let share = |count: usize| 100.0 * count as f64 / calls.max(1) as f64;
        println!(
            "| {modules} | {name} | {calls} | {:.0} % | {:.0} % | {closed} | {failed} |",
            share(self.closed.len()),
            share(self.free)
        );
    }
}

fn main() {
    println!("| modules | method | calls | closed | closed and free | a call that closes | one that fails |");
    println!("|---|---|---|---|---|---|---|");
    for modules in SIZES {
        let (mut squares, mut paper) = (Times::default(), Times::default());
        for seed in 0..SEEDS {
            let state = opened(modules, seed);
            for pair in merging::pairs(&state).iter().take(PAIRS) {
                least_squares(&state, pair, &mut squares);
                walks(&state, pair, &mut paper);
            }
        }
        squares.print(modules, "least squares");
        paper.print(modules, "FABRIK");
    }
}

/// A tangle without loops, as straight as it comes.
fn opened(modules: usize, seed: u64) -> State {
    let mut state = State::new(random_configuration(modules, 1_000, seed));
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    state.rebuild_tree();
    straighten::straighten(&mut state, &mut SplitMix64(seed));
    state
}

fn least_squares(state: &State, pair: &Pair, times: &mut Times) {
    let settings = inverse_kinematics::Settings::default();
    let attempt = Attempt {
        pair,
        mode: IkMode::Endpoint,
        detour: false,
        spread: 0.02,
        side: MovingSide::Both,
        settings: &settings,
    };
    let (scene, mut work) = (state.scene(), 0);
    let start = Instant::now();
    let closed = attempt.closed_posture(&scene, &state.robot.joints, &mut SplitMix64(1), &mut work).is_some();
    times.count(microseconds(start), closed, closed);
}

fn walks(state: &State, pair: &Pair, times: &mut Times) {
    let (settings, mut work) = (fabrik::Settings::default(), 0);
    let start = Instant::now();
    let chain = Chain::new(state, pair.a, pair.b);
    let joints = chain.solve(&state.robot.joints, &settings, false, &mut work).0;
    let time = microseconds(start);
    let free = joints.as_ref().is_some_and(|joints| {
        let mut poses = Vec::new();
        state.tree.poses(joints, &mut poses);
        let meeting = [pair.a, pair.b].map(|dock| state.tree.index[dock.shoe()]);
        let mut docked = state.docked.clone();
        docked.push((meeting[0].min(meeting[1]), meeting[0].max(meeting[1])));
        docked.sort_unstable();
        broad_phase::least_distance(&state.tree, &docked, &poses, TOUCHING) >= TOUCHING
    });
    times.count(time, joints.is_some(), free);
}

fn microseconds(since: Instant) -> f64 {
    1e6 * since.elapsed().as_secs_f64()
}
