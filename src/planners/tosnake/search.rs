//! The search for a sequence of steps to the snake.
//!
//! Loops are opened. Then, round by round, all tilts are straightened as far as they are free to, and the
//! most promising pairs of chain ends are tried until one comes together, each by inverse kinematics and
//! a check of the motion. A round in which none does ends with a perturbation. At last the snake is
//! straightened, and the steps are shortened.

use super::attempts::{self, Job};
use super::concurrent_merges::ConcurrentMerges;
use super::gravity::{GravityModel, JointLoad};
use super::inverse_kinematics::{IkMode, Loop, MovingSide};
use super::lattice_closure;
use super::merging::{self, Attempt, Pair};
use super::paper;
use super::refusal::{Operation, Overload, Refusal};
use super::robot::{ALPHA, BETA, Dock, GAMMA, Robot};
use super::settings::{Collisions, Settings};
use super::shortcut::shortened;
use super::state::{Joints, State, Step};
use super::status::{Reporter, SearchStatus};
use super::straighten;
use super::validation;
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The attempts of a round, cheap ones first: mode of the inverse kinematics, spread of its random start
/// as a fraction of the joints' ranges, and the number of pairs, the most promising first, that are tried with them.
const ATTEMPTS: [(IkMode, f64, usize); 5] = [
    (IkMode::Endpoint, 0.02, 60),
    (IkMode::Endpoint, 0.3, 60),
    (IkMode::CollisionFree, 0.0, 10),
    (IkMode::Endpoint, 1.0, 20),
    (IkMode::CollisionFree, 0.5, 10),
];

/// Spread of the random start of attempts that may take a detour, as a fraction of the joints' ranges.
const DETOUR_SPREAD: f64 = 0.3;

/// Smaller robots are searched on one thread: starting more costs more than it gains.
const PARALLEL_MODULES_MIN: usize = 16;

/// Greatest number of pairs tried of each kind under gravity, where each pair is tried with more settings.
const GRAVITY_PAIRS_MAX: usize = 20;

/// The sides that move under gravity, where that makes a difference: both of them, and each alone.
const GRAVITY_SIDES: [MovingSide; 3] = MovingSide::ALL;

/// Relative noise on the costs of pairs for each round in which none came together.
const COST_NOISE: f64 = 0.4;

/// Greatest number of searches under gravity, each with the next random numbers, when overload ends them.
const RESTARTS_MAX: usize = 20;

/// Rounds without a merge after which a search under gravity starts again.
const STALLED_ROUNDS_MAX: usize = 4;

/// Between merges, joints are straightened only up to this fraction of their torque limits, so that
/// something is left for the next merge.
const LOAD_SHARE_BETWEEN_MERGES: f64 = 0.6;

/// Cost of a pair whose joints hold all that they can, in modules of the loop.
const LOAD_COST: f64 = 8.0;

/// Cost of each failed attempt at a pair, as a logit; added to [`merging::Pair::cost`]. Forgotten when another number
/// of modules bends between the ends.
const FAILED_ATTEMPT_COST: f64 = 0.7;

/// A sequence of steps from a start to the snake, as a search found it.
#[derive(Clone, Debug)]
pub struct StepSequence {
    /// The configuration in the end: alpha and beta are 0, gamma is a multiple of a whole turn. Its list
    /// of bonds begins with those of the start, and holds all that the steps dock.
    pub robot: Robot,
    /// The steps in order, from the start; bonds are indices in [`Robot::bonds`] of `robot`.
    pub steps: Vec<Step>,
    /// The figures of the search at its end.
    pub status: SearchStatus,
}

/// Searches for the steps from a configuration to the snake. With a gravity model, no joint exceeds its torque limit
/// during the motion, as far as the planner checks; without one the robot floats. The method of [Mrázek et
/// al.](super), chosen by [`Settings::collisions`], ignores the gravity model. `settings`: the settings of the
/// search.
///
/// # Errors
/// [`Refusal`]: the start is invalid, torque limits or the budget do not suffice, the paper's method has tried all
/// pairs, or `progress` ended the search.
pub fn unwind(
    robot: &Robot,
    gravity: Option<&GravityModel>,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<StepSequence, Refusal> {
    let mut reporter = Reporter::new(progress);
    if settings.collisions != Collisions::Motion {
        return paper::unwind(robot, settings, &mut reporter);
    }
    validation::check(robot)?;
    match gravity {
        None => {
            let state = loops_opened(robot, None);
            Search::new(state, SplitMix64(settings.seed), settings, &mut reporter).sequence(robot)
        }
        Some(gravity) => unwind_with_restarts(robot, gravity, settings, &mut reporter),
    }
}

/// Searches under gravity, again and again with other random numbers where overload ends a search. The
/// refusal reports the smallest overload of those searches that made the most merges.
fn unwind_with_restarts(
    robot: &Robot,
    gravity: &GravityModel,
    settings: &Settings,
    reporter: &mut Reporter,
) -> Result<StepSequence, Refusal> {
    let gravity = Arc::new(gravity.clone());
    let mut rng = SplitMix64(settings.seed);
    let mut spent = SearchStatus::default();
    let mut nearest: Option<Overload> = None;
    for _ in 0..RESTARTS_MAX {
        // Budget and figures are those of all searches together.
        let mut search = Search::new(loops_opened(robot, Some(&gravity)), rng, settings, reporter);
        (search.status.tried, search.state.work) = (spent.tried, spent.work);
        let found = search.sequence(robot);
        (rng, spent) = (search.rng, search.status);
        let (overload, is_last) = match found {
            Err(Refusal::Overload(overload)) => {
                // Another search would begin with the same overload.
                (overload, matches!(overload.operation, Operation::HoldingStart | Operation::OpeningLoops))
            }
            // The budget is spent because everything was too heavy.
            Err(Refusal::BudgetSpent(status)) if search.overload.is_some() || nearest.is_some() => {
                let own = search.overload.map(|(load, operation)| Overload { load, operation, status });
                (own.or(nearest).expect("one of them is"), true)
            }
            other => return other,
        };
        let rank = |o: &Overload| (o.status.made, -o.load.ratio);
        if nearest.is_none_or(|known| rank(&overload) > rank(&known)) {
            nearest = Some(overload);
        }
        if is_last {
            break;
        }
    }
    let mut overload = nearest.expect("every search ended so");
    (overload.status.tried, overload.status.work) = (spent.tried, spent.work);
    Err(Refusal::Overload(overload))
}

/// Returns the robot with all bonds undocked that close loops.
fn loops_opened(robot: &Robot, gravity: Option<&Arc<GravityModel>>) -> State {
    let mut state = State::with_gravity(robot.clone(), gravity.cloned());
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    state.rebuild_tree();
    state
}

/// One search, from opened loops to the snake.
struct Search<'s, 'p> {
    state: State,
    rng: SplitMix64,
    settings: &'s Settings,
    reporter: &'s mut Reporter<'p>,
    status: SearchStatus,
    /// The smallest overload so far, and the operation that it ruled out; `None` without any.
    overload: Option<(JointLoad, Operation)>,
    /// The number of modules that bent between the ends at the last failed attempt, and the number of
    /// attempts that failed with it, by pair.
    failed_attempts: BTreeMap<[Dock; 2], (usize, u32)>,
}

impl<'s, 'p> Search<'s, 'p> {
    fn new(
        state: State,
        rng: SplitMix64,
        settings: &'s Settings,
        reporter: &'s mut Reporter<'p>,
    ) -> Search<'s, 'p> {
        let mut status = SearchStatus { needed: state.other_bonds(), ..SearchStatus::default() };
        status.count_chains(&state);
        Search { state, rng, settings, reporter, status, overload: None, failed_attempts: BTreeMap::new() }
    }

    /// Searches, and shortens the steps found. `robot` is the start.
    fn sequence(&mut self, robot: &Robot) -> Result<StepSequence, Refusal> {
        self.reach_snake()?;
        self.report()?;
        let end = self.state.robot.clone();
        let held = |bond| robot.holds.get(bond).copied().unwrap_or(false);
        let holds = (0..end.bonds.len()).map(held).collect();
        let start = Robot { joints: robot.joints.clone(), bonds: end.bonds.clone(), holds };
        let gravity = self.state.gravity.clone();
        let threads = if start.modules() < PARALLEL_MODULES_MIN { 1 } else { self.settings.threads };
        let steps = shortened(start, gravity, &self.state.steps, threads, &mut self.state.work);
        self.status.work = self.state.work;
        Ok(StepSequence { robot: end, steps, status: self.status })
    }

    /// Merges chains until there is one, and straightens it.
    fn reach_snake(&mut self) -> Result<(), Refusal> {
        self.check_start_load()?;
        let mut tilted = self.straighten();
        let mut stalled_rounds = 0;
        while self.state.other_bonds() > 0 {
            self.report()?;
            if self.merge(stalled_rounds)? {
                stalled_rounds = 0;
            } else {
                stalled_rounds += 1;
                self.check_for_stall(stalled_rounds)?;
                self.perturb();
            }
            tilted = self.straighten();
        }
        self.check_final_load()?;
        (self.overload, stalled_rounds) = (None, 0);
        while tilted > 0 {
            self.report()?;
            stalled_rounds += 1;
            self.check_for_stall(stalled_rounds)?;
            self.perturb();
            tilted = self.straighten();
        }
        self.zero_twist();
        Ok(())
    }

    /// Refuses if a joint is overloaded before anything moves.
    fn check_start_load(&self) -> Result<(), Refusal> {
        match self.state.load() {
            Some(load) if load.ratio > 1.0 => {
                let whole = self.state.steps.is_empty();
                Err(self
                    .overloaded(load, if whole { Operation::HoldingStart } else { Operation::OpeningLoops }))
            }
            _ => Ok(()),
        }
    }

    /// Refuses if a joint would be overloaded in the straight snake.
    fn check_final_load(&self) -> Result<(), Refusal> {
        let mut end = self.state.clone();
        end.robot.joints.iter_mut().for_each(|q| (q[ALPHA], q[BETA]) = (0.0, 0.0));
        end.update_poses();
        match end.load() {
            Some(load) if load.ratio > 1.0 => Err(self.overloaded(load, Operation::HoldingSnake)),
            _ => Ok(()),
        }
    }

    /// Gives up after many rounds without progress if something was overloaded.
    fn check_for_stall(&mut self, stalled_rounds: usize) -> Result<(), Refusal> {
        match self.overload {
            Some((load, operation)) if stalled_rounds > STALLED_ROUNDS_MAX => {
                Err(self.overloaded(load, operation))
            }
            _ => Ok(()),
        }
    }

    /// Returns the refusal for an overload.
    fn overloaded(&self, load: JointLoad, operation: Operation) -> Refusal {
        Refusal::Overload(Overload { load, operation, status: self.status })
    }

    /// Turns tilts (alpha and beta) to zero; returns how many are left.
    fn straighten(&mut self) -> usize {
        let last = self.state.other_bonds() == 0;
        let now = self.state.load().map_or(0.0, |load| load.ratio);
        self.state.load_share = if last { 1.0 } else { f64::max(LOAD_SHARE_BETWEEN_MERGES, now) };
        let tilted = straighten::straighten(&mut self.state, &mut self.rng);
        self.state.load_share = 1.0;
        if last {
            record_overload(&mut self.overload, &self.state, Operation::Straightening);
        }
        self.state.least_overload.take();
        tilted
    }

    /// Brings the ends of two chains together, of the first pair with which that succeeds; returns false
    /// if it does with none. `stalled_rounds` is the number of such rounds before.
    fn merge(&mut self, stalled_rounds: usize) -> Result<bool, Refusal> {
        let pairs = self.pairs(stalled_rounds);
        let (jobs, rng) = self.jobs(&pairs);
        let Search { state, settings, reporter, status, overload, failed_attempts, .. } = self;
        let (mut work, mut won, mut refusal) = (0, None, None);
        // Loads are recorded in the state, which threads can't share.
        let alone = state.gravity.is_some() || state.robot.modules() < PARALLEL_MODULES_MIN;
        let threads = if alone { 1 } else { settings.threads };
        attempts::in_order(state, &jobs, threads, &mut |done| {
            status.tried += 1;
            work += done.work;
            let pair = jobs[done.job].attempt.pair;
            if let Some(path) = done.path
                && (state.gravity.is_none() || merged_within_limits(state, pair, &path).is_some())
            {
                won = Some((done.job, path));
                return true;
            }
            record_overload(overload, state, Operation::Joining(pair.a, pair.b));
            let known = failed_attempts.entry([pair.a, pair.b]).or_default();
            *known = (pair.length, if known.0 == pair.length { known.1 + 1 } else { 1 });
            status.work = state.work + work;
            refusal = report(status, settings, reporter).err();
            refusal.is_some()
        });
        let (pair, next) = match &won {
            Some((job, _)) => (Some(*jobs[*job].attempt.pair), jobs.get(job + 1).map(|job| job.rng.clone())),
            None => (None, None),
        };
        self.state.work += work;
        self.rng = next.unwrap_or(rng);
        match (refusal, pair, won) {
            (Some(refusal), ..) => Err(refusal),
            (None, Some(pair), Some((_, path))) => Ok(self.apply(&pair, path, &pairs)),
            _ => self.merge_on_lattice(stalled_rounds, &pairs),
        }
    }

    /// Returns all attempts of a round in their order, each with its random numbers, and the generator
    /// after them all.
    fn jobs<'j>(&self, pairs: &'j [Pair]) -> (Vec<Job<'j>>, SplitMix64)
    where
        's: 'j,
    {
        let (sides, pairs_max) = if self.state.gravity.is_some() {
            (&GRAVITY_SIDES[..], GRAVITY_PAIRS_MAX)
        } else {
            (&GRAVITY_SIDES[..1], usize::MAX)
        };
        let mut rng = self.rng.clone();
        let mut jobs = Vec::new();
        let direct = ATTEMPTS.map(|(mode, spread, many)| (mode, false, spread, many));
        let detours = (IkMode::Endpoint, true, DETOUR_SPREAD, self.settings.detour_pairs_max);
        for (mode, detour, spread, many) in direct.into_iter().chain([detours]) {
            for pair in pairs.iter().take(many.min(pairs_max)) {
                for &side in sides {
                    let settings = &self.settings.inverse_kinematics;
                    let attempt = Attempt { pair, mode, detour, spread, side, settings };
                    let draws = attempt.draws(&self.state.tree);
                    jobs.push(Job { attempt, rng: rng.clone() });
                    rng.skip(draws);
                }
            }
        }
        (jobs, rng)
    }

    /// Closes short loops on the lattice of quarter turns, where inverse kinematics closed none in two
    /// rounds.
    fn merge_on_lattice(&mut self, stalled_rounds: usize, pairs: &[Pair]) -> Result<bool, Refusal> {
        if stalled_rounds == 0 {
            return Ok(false);
        }
        for pair in pairs.iter().filter(|pair| pair.length <= lattice_closure::LENGTH_MAX) {
            self.status.tried += 1;
            let mut work = 0;
            let closed = lattice_closure::closed_posture(&self.state, pair, &mut work);
            self.state.work += work;
            if closed.is_some_and(|closed| self.apply(pair, vec![closed], pairs)) {
                return Ok(true);
            }
            record_overload(&mut self.overload, &self.state, Operation::Joining(pair.a, pair.b));
            self.report()?;
        }
        Ok(false)
    }

    /// Moves along a path that brings a pair together, and merges it, with other pairs where the path is
    /// one step. Returns false if joints would be overloaded afterwards.
    fn apply(&mut self, pair: &Pair, mut path: Vec<Joints>, pairs: &[Pair]) -> bool {
        if self.state.gravity.is_some() {
            let Some(after) = merged_within_limits(&self.state, pair, &path) else { return false };
            self.state = after;
            self.status.made += 1;
            self.status.count_chains(&self.state);
            return true;
        }
        let mut together = vec![*pair];
        if let [joints] = &mut path[..] {
            let mut work = 0;
            let merges = ConcurrentMerges { pairs: together, joints: std::mem::take(joints) };
            let counts = (&mut self.status.tried, &mut work);
            let merges = merges.extended(&self.state, pairs, self.settings, &mut self.rng, counts);
            self.state.work += work;
            (together, *joints) = (merges.pairs, merges.joints);
        }
        path.iter().for_each(|joints| self.state.move_to(joints));
        merging::merge(&mut self.state, &together);
        self.status.made += together.len();
        self.status.count_chains(&self.state);
        true
    }

    /// Returns all pairs of ends, the most promising first. To the cost of [`merging::pairs`] come the load
    /// of the loop's joints, failed attempts, and noise that grows with the number of stalled rounds.
    fn pairs(&mut self, stalled_rounds: usize) -> Vec<Pair> {
        let mut pairs = merging::pairs(&self.state);
        if let Some(gravity) = &self.state.gravity {
            let loads = gravity.loads(&self.state.tree, &self.state.poses);
            for pair in &mut pairs {
                let lp = Loop::new(&self.state.tree, pair.a, pair.b);
                let bends = |load: &&JointLoad| {
                    lp.joints.iter().any(|(j, _)| (j.module, j.joint) == (load.module, load.joint))
                };
                let most = loads.iter().filter(bends).fold(0.0, |most: f64, load| most.max(load.ratio));
                pair.cost += LOAD_COST * most;
            }
        }
        for pair in &mut pairs {
            if self.state.gravity.is_none() {
                let failed = self.failed_attempts.get(&[pair.a, pair.b]);
                let failed = failed.filter(|(length, _)| *length == pair.length);
                pair.cost += FAILED_ATTEMPT_COST * failed.map_or(0.0, |(_, times)| f64::from(*times));
            }
            pair.cost *= 1.0 + 0.5 * COST_NOISE * stalled_rounds as f64 * (1.0 + self.rng.next_signed());
        }
        pairs.sort_by(|p, q| p.cost.total_cmp(&q.cost).then((p.a, p.b).cmp(&(q.a, q.b))));
        pairs
    }

    /// Turns single joints at random, so that the robot spreads.
    fn perturb(&mut self) {
        self.status.perturbations += 1;
        let Settings { perturbation_turns, perturbation_slack, .. } = *self.settings;
        let now = self.state.load().map_or(0.0, |load| load.ratio);
        self.state.load_share = f64::max(LOAD_SHARE_BETWEEN_MERGES, now);
        straighten::perturb(&mut self.state, &mut self.rng, perturbation_turns, perturbation_slack);
        self.state.load_share = 1.0;
        self.state.least_overload.take();
    }

    /// Turns gamma of every module of the straight snake to the nearest whole turn, which moves no ball.
    fn zero_twist(&mut self) {
        let mut joints = self.state.robot.joints.clone();
        joints.iter_mut().for_each(|q| q[GAMMA] = TAU * libm::round(q[GAMMA] / TAU));
        self.state.move_to(&joints);
    }

    /// Reports the status with the work so far, as [`report`] does.
    fn report(&mut self) -> Result<(), Refusal> {
        self.status.work = self.state.work;
        report(&self.status, self.settings, self.reporter)
    }
}

/// Reports the status; refuses if the budget is spent or the observer ends the search.
fn report(status: &SearchStatus, settings: &Settings, reporter: &mut Reporter) -> Result<(), Refusal> {
    if status.work > settings.budget {
        return Err(Refusal::BudgetSpent(*status));
    }
    if reporter.report(status) { Ok(()) } else { Err(Refusal::Stopped(*status)) }
}

/// Moves the overload that the state noted last, if there is one and it is the smallest so far, to
/// `overload`, with the operation that it ruled out.
fn record_overload(overload: &mut Option<(JointLoad, Operation)>, state: &State, operation: Operation) {
    let Some(load) = state.least_overload.take() else { return };
    if overload.is_none_or(|(known, _)| load.ratio < known.ratio) {
        *overload = Some((load, operation));
    }
}

/// Returns the robot after a path and the merge that it is for; `None` if a joint would be overloaded.
fn merged_within_limits(state: &State, pair: &Pair, path: &[Joints]) -> Option<State> {
    let mut there = state.clone();
    path.iter().for_each(|joints| there.move_to(joints));
    let after = merging::merged_within_limits(&there, pair);
    state.least_overload.set(there.least_overload.get());
    after
}
