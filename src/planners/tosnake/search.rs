//! The whole way to the snake.

use super::alongside::Party;
use super::attempts::{self, Job};
use super::closing::{Loop, Manner};
use super::lattice;
use super::merging::{self, Attempt, Pair, Side};
use super::opening;
use super::paper;
use super::robot::{ALPHA, BETA, Dock, GAMMA, Robot};
use super::shortening::shortened;
use super::sound;
use super::state::{Joints, State};
use super::weight::{Load, Weight};
use super::{Collisions, Doing, Found, Heavy, Progress, Refusal, Settings};
use crate::planners::random::SplitMix64;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// How pairs of ends are tried: in which manner, from how far a posture of their own, and how many of
/// them. What is cheap comes first.
const ATTEMPTS: [(Manner, f64, usize); 5] = [
    (Manner::Leap, 0.02, 60),
    (Manner::Leap, 0.3, 60),
    (Manner::Flow, 0.0, 10),
    (Manner::Leap, 1.0, 20),
    (Manner::Flow, 0.5, 10),
];

/// From how far a posture of their own loops set out that may take a detour.
const DETOUR_SIZE: f64 = 0.3;

/// For smaller robots threads are not worth it.
const PARALLEL_MIN: usize = 16;

/// Under weight more is tried of each pair, and no more pairs than so many.
const HEAVY_PAIRS: usize = 20;

/// Under weight it matters which tentacle moves: all of them, and each alone, are tried.
const SIDES: [Side; 3] = [Side::Both, Side::First, Side::Second];

/// By how much the order of pairs is shuffled for every round in which none was brought together.
const NOISE: f64 = 0.4;

/// Unwinds a configuration whose bonds all meet. `watch` is told how far it has come, and says whether
/// to go on.
pub fn unwind(
    robot: &Robot,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Found, Refusal> {
    unwind_under(robot, None, settings, watch)
}

/// The same where something pulls, so that joints hold what hangs on them all the way.
pub fn unwind_under(
    robot: &Robot,
    weight: Option<&Weight>,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Found, Refusal> {
    if settings.collisions != Collisions::Motion {
        return paper::unwind(robot, settings, watch);
    }
    sound::check(robot)?;
    let Some(weight) = weight else {
        let state = opened(robot, None);
        return Search::new(state, SplitMix64(settings.seed), settings, watch).found(robot);
    };
    let weight = Arc::new(weight.clone());
    let mut rng = SplitMix64(settings.seed);
    let mut spent = Progress::default();
    let mut nearest: Option<Heavy> = None;
    for _ in 0..FRESH_STARTS {
        let mut search = Search::new(opened(robot, Some(&weight)), rng, settings, watch);
        (search.progress.tried, search.state.work) = (spent.tried, spent.work);
        let found = search.try_found(robot);
        (rng, spent) = (search.rng, search.progress);
        let (heavy, over) = match found {
            Err(Refusal::Heavy(heavy)) => (heavy, matches!(heavy.doing, Doing::Standing | Doing::Opening)),
            // The budget is spent because everything was too heavy.
            Err(Refusal::Budget(progress)) if search.heavy.is_some() || nearest.is_some() => {
                let own = search.heavy.map(|(load, doing)| Heavy { load, doing, progress });
                (own.or(nearest).expect("one of them is"), true)
            }
            other => return other,
        };
        let rank = |h: &Heavy| (h.progress.made, -h.load.ratio);
        if nearest.is_none_or(|known| rank(&heavy) > rank(&known)) {
            nearest = Some(heavy);
        }
        if over {
            break;
        }
    }
    let mut heavy = nearest.expect("every start ended so");
    (heavy.progress.tried, heavy.progress.work) = (spent.tried, spent.work);
    Err(Refusal::Heavy(heavy))
}

/// The robot with all loops open.
fn opened(robot: &Robot, weight: Option<&Arc<Weight>>) -> State {
    let mut state = State::with_weight(robot.clone(), weight.cloned());
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    state.regrow();
    state
}

/// How often a search under weight begins again where what it came to is too heavy.
const FRESH_STARTS: usize = 20;

/// Rounds in which a search under weight gets no farther before it begins again.
const IDLE_MAX: usize = 4;

/// Between merges joints turn straight as long as no load is greater than this part of its limit, so
/// that something is left for what has to be held next.
const EASY: f64 = 0.6;

/// By so much, in modules on the way, a pair is less promising whose joints hold all that they can.
const HEAVY_COST: f64 = 8.0;

/// By so much, in modules on the way, a pair is less promising for every time that it was tried in vain, with as
/// many modules on the way as now.
const VAIN_COST: f64 = 0.7;

struct Search<'a> {
    state: State,
    rng: SplitMix64,
    settings: &'a Settings,
    watch: &'a mut dyn FnMut(&Progress) -> bool,
    progress: Progress,
    /// Of all that was too heavy what was least so.
    heavy: Option<(Load, Doing)>,
    /// How often pairs were tried in vain, with the modules that bent between them then.
    vain: BTreeMap<[Dock; 2], (usize, u32)>,
}

impl<'a> Search<'a> {
    fn new(
        state: State,
        rng: SplitMix64,
        settings: &'a Settings,
        watch: &'a mut dyn FnMut(&Progress) -> bool,
    ) -> Search<'a> {
        let mut progress = Progress { needed: state.bad_bonds(), ..Progress::default() };
        progress.see(&state);
        Search { state, rng, settings, watch, progress, heavy: None, vain: BTreeMap::new() }
    }

    fn found(mut self, robot: &Robot) -> Result<Found, Refusal> {
        self.try_found(robot)
    }

    fn try_found(&mut self, robot: &Robot) -> Result<Found, Refusal> {
        self.snake()?;
        self.report()?;
        let end = self.state.robot.clone();
        let held = |bond| robot.holds.get(bond).copied().unwrap_or(false);
        let holds = (0..end.bonds.len()).map(held).collect();
        let start = Robot { joints: robot.joints.clone(), bonds: end.bonds.clone(), holds };
        let weight = self.state.weight.clone();
        let steps = shortened(start, weight, &self.state.steps, &mut self.state.work);
        self.progress.work = self.state.work;
        Ok(Found { robot: end, steps, progress: self.progress })
    }

    fn snake(&mut self) -> Result<(), Refusal> {
        self.stands()?;
        let mut tilted = self.straighten();
        let mut idle = 0;
        while self.state.bad_bonds() > 0 {
            self.report()?;
            if self.merge(idle)? {
                idle = 0;
            } else {
                idle += 1;
                self.tire(idle)?;
                self.shake();
            }
            tilted = self.straighten();
        }
        self.ends_light()?;
        (self.heavy, idle) = (None, 0);
        while tilted > 0 {
            self.report()?;
            idle += 1;
            self.tire(idle)?;
            self.shake();
            tilted = self.straighten();
        }
        self.untwist();
        Ok(())
    }

    /// Whether joints hold what hangs on them before anything moves.
    fn stands(&self) -> Result<(), Refusal> {
        match self.state.load() {
            Some(load) if load.ratio > 1.0 => {
                let whole = self.state.steps.is_empty();
                Err(self.heavy(load, if whole { Doing::Standing } else { Doing::Opening }))
            }
            _ => Ok(()),
        }
    }

    /// Whether they will hold the straight snake.
    fn ends_light(&self) -> Result<(), Refusal> {
        let mut end = self.state.clone();
        end.robot.joints.iter_mut().for_each(|q| (q[ALPHA], q[BETA]) = (0.0, 0.0));
        end.place();
        match end.load() {
            Some(load) if load.ratio > 1.0 => Err(self.heavy(load, Doing::Ending)),
            _ => Ok(()),
        }
    }

    /// After many rounds without progress, because something was too heavy, it is given up.
    fn tire(&mut self, idle: usize) -> Result<(), Refusal> {
        match self.heavy {
            Some((load, doing)) if idle > IDLE_MAX => Err(self.heavy(load, doing)),
            _ => Ok(()),
        }
    }

    fn heavy(&self, load: Load, doing: Doing) -> Refusal {
        Refusal::Heavy(Heavy { load, doing, progress: self.progress })
    }

    /// Tilts turn to zero; gives how many are left.
    fn straighten(&mut self) -> usize {
        let last = self.state.bad_bonds() == 0;
        let now = self.state.load().map_or(0.0, |load| load.ratio);
        self.state.share = if last { 1.0 } else { f64::max(EASY, now) };
        let tilted = opening::straighten(&mut self.state, &mut self.rng);
        self.state.share = 1.0;
        if last {
            blame(&mut self.heavy, &self.state, Doing::Straightening);
        }
        self.state.refused.take();
        tilted
    }

    /// Brings the ends of two chains together, whichever first. `idle` rounds before found none.
    fn merge(&mut self, idle: usize) -> Result<bool, Refusal> {
        let pairs = self.pairs(idle);
        let (jobs, rng) = self.jobs(&pairs);
        let Search { state, settings, watch, progress, heavy, vain, .. } = self;
        let (mut work, mut won, mut refusal) = (0, None, None);
        let alone = state.weight.is_some() || state.robot.modules() < PARALLEL_MIN;
        let threads = if alone { 1 } else { settings.threads };
        attempts::in_order(state, &jobs, threads, &mut |made| {
            progress.tried += 1;
            work += made.work;
            let pair = jobs[made.job].attempt.pair;
            if let Some(way) = made.way
                && (state.weight.is_none() || merged_within_limits(state, pair, &way).is_some())
            {
                won = Some((made.job, way));
                return true;
            }
            blame(heavy, state, Doing::Joining(pair.a, pair.b));
            let known = vain.entry([pair.a, pair.b]).or_default();
            *known = (pair.length, if known.0 == pair.length { known.1 + 1 } else { 1 });
            progress.work = state.work + work;
            refusal = told(progress, settings, watch).err();
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
            (None, Some(pair), Some((_, way))) => Ok(self.take(&pair, way, &pairs)),
            _ => self.merge_on_lattice(idle, &pairs),
        }
    }

    /// All attempts in their order, each with its rng; and the rng after them.
    fn jobs<'p>(&self, pairs: &'p [Pair]) -> (Vec<Job<'p>>, SplitMix64)
    where
        'a: 'p,
    {
        let (sides, most) =
            if self.state.weight.is_some() { (&SIDES[..], HEAVY_PAIRS) } else { (&SIDES[..1], usize::MAX) };
        let mut rng = self.rng.clone();
        let mut jobs = Vec::new();
        let straight = ATTEMPTS.map(|(manner, size, many)| (manner, false, size, many));
        let around = (Manner::Leap, true, DETOUR_SIZE, self.settings.detours);
        for (manner, detour, size, many) in straight.into_iter().chain([around]) {
            for pair in pairs.iter().take(many.min(most)) {
                for &side in sides {
                    let attempt =
                        Attempt { pair, manner, detour, size, side, closing: &self.settings.closing };
                    let throws = attempt.throws(&self.state.tree);
                    jobs.push(Job { attempt, rng: rng.clone() });
                    rng.skip(throws);
                }
            }
        }
        (jobs, rng)
    }

    /// Where descent brought nothing together, short loops close on the lattice of quarter turns.
    fn merge_on_lattice(&mut self, idle: usize, pairs: &[Pair]) -> Result<bool, Refusal> {
        if idle == 0 {
            return Ok(false);
        }
        for pair in pairs.iter().filter(|pair| pair.length <= lattice::LENGTH_MAX) {
            self.progress.tried += 1;
            let mut work = 0;
            let there = lattice::leap(&self.state, pair, &mut work);
            self.state.work += work;
            if there.is_some_and(|there| self.take(pair, vec![there], pairs)) {
                return Ok(true);
            }
            blame(&mut self.heavy, &self.state, Doing::Joining(pair.a, pair.b));
            self.report()?;
        }
        Ok(false)
    }

    /// Goes a way that brings a pair together, and others with it where one turn does that. Says no
    /// where joints would not hold what hangs on them afterwards.
    fn take(&mut self, pair: &Pair, mut way: Vec<Joints>, pairs: &[Pair]) -> bool {
        if self.state.weight.is_some() {
            let Some(after) = merged_within_limits(&self.state, pair, &way) else { return false };
            self.state = after;
            self.progress.made += 1;
            self.progress.see(&self.state);
            return true;
        }
        let mut together = vec![*pair];
        if let [joints] = &mut way[..] {
            let mut work = 0;
            let Settings { at_once, closing, .. } = self.settings;
            let party = Party { pairs: together, joints: std::mem::take(joints) };
            let counts = (&mut self.progress.tried, &mut work);
            let party = party.grown(&self.state, pairs, *at_once, closing, &mut self.rng, counts);
            self.state.work += work;
            (together, *joints) = (party.pairs, party.joints);
        }
        way.iter().for_each(|joints| self.state.go(joints));
        merging::make(&mut self.state, &together);
        self.progress.made += together.len();
        self.progress.see(&self.state);
        true
    }

    fn pairs(&mut self, idle: usize) -> Vec<Pair> {
        let mut pairs = merging::pairs(&self.state);
        if let Some(weight) = &self.state.weight {
            let loads = weight.loads(&self.state.tree, &self.state.poses);
            for pair in &mut pairs {
                let lp = Loop::new(&self.state.tree, pair.a, pair.b);
                let bends = |load: &&Load| {
                    lp.joints.iter().any(|(j, _)| (j.module, j.joint) == (load.module, load.joint))
                };
                let most = loads.iter().filter(bends).fold(0.0, |most: f64, load| most.max(load.ratio));
                pair.cost += HEAVY_COST * most;
            }
        }
        for pair in &mut pairs {
            if self.state.weight.is_none() {
                let vain = self.vain.get(&[pair.a, pair.b]).filter(|(length, _)| *length == pair.length);
                pair.cost += VAIN_COST * vain.map_or(0.0, |(_, times)| f64::from(*times));
            }
            pair.cost *= 1.0 + 0.5 * NOISE * idle as f64 * (1.0 + self.rng.next_signed());
        }
        pairs.sort_by(|p, q| p.cost.total_cmp(&q.cost).then((p.a, p.b).cmp(&(q.a, q.b))));
        pairs
    }

    fn shake(&mut self) {
        self.progress.shakes += 1;
        let Settings { shake_turns, shake_slack, .. } = *self.settings;
        let now = self.state.load().map_or(0.0, |load| load.ratio);
        self.state.share = f64::max(EASY, now);
        opening::shake(&mut self.state, &mut self.rng, shake_turns, shake_slack);
        self.state.share = 1.0;
        self.state.refused.take();
    }

    /// A straight snake turns its modules about its own line, which moves no ball.
    fn untwist(&mut self) {
        let mut joints = self.state.robot.joints.clone();
        joints.iter_mut().for_each(|q| q[GAMMA] = TAU * libm::round(q[GAMMA] / TAU));
        self.state.go(&joints);
    }

    fn report(&mut self) -> Result<(), Refusal> {
        self.progress.work = self.state.work;
        told(&self.progress, self.settings, self.watch)
    }
}

/// Whether to go on, after whoever watches was told.
fn told(
    progress: &Progress,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<(), Refusal> {
    if progress.work > settings.budget {
        return Err(Refusal::Budget(*progress));
    }
    if watch(progress) { Ok(()) } else { Err(Refusal::Stopped(*progress)) }
}

/// What was too heavy just now, if anything was, was so in doing this.
fn blame(heavy: &mut Option<(Load, Doing)>, state: &State, doing: Doing) {
    let Some(load) = state.refused.take() else { return };
    if heavy.is_none_or(|(known, _)| load.ratio < known.ratio) {
        *heavy = Some((load, doing));
    }
}

/// The robot after a way and the merge that it is for; `None` where joints would not hold what hangs on
/// them then.
fn merged_within_limits(state: &State, pair: &Pair, way: &[Joints]) -> Option<State> {
    let mut there = state.clone();
    way.iter().for_each(|joints| there.go(joints));
    let after = merging::made_within_limits(&there, pair);
    state.refused.set(there.refused.get());
    after
}
