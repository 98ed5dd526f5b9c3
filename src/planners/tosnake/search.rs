//! The whole way to the snake.

use super::alongside::Party;
use super::closing::Manner;
use super::lattice;
use super::merging::{self, Pair};
use super::opening;
use super::paper;
use super::robot::{GAMMA, Robot};
use super::shortening::shortened;
use super::sound;
use super::state::{Joints, State};
use super::{Collisions, Found, Progress, Refusal, Settings};
use crate::planners::random::Dice;
use std::f64::consts::TAU;

/// How pairs of ends are tried: in which manner, from how far a posture of their own, and how many of
/// them. What is cheap comes first.
const ATTEMPTS: [(Manner, f64, usize); 5] = [
    (Manner::Leap, 0.02, 20),
    (Manner::Leap, 0.3, 20),
    (Manner::Flow, 0.0, 10),
    (Manner::Leap, 1.0, 20),
    (Manner::Flow, 0.5, 10),
];

/// By how much the order of pairs is shuffled for every round in which none was brought together.
const NOISE: f64 = 0.4;

/// Unwinds a configuration whose bonds all meet. `watch` is told how far it has come, and says whether
/// to go on.
pub fn unwind(
    robot: &Robot,
    settings: &Settings,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Found, Refusal> {
    if settings.collisions != Collisions::Motion {
        return paper::unwind(robot, settings, watch);
    }
    sound::check(robot)?;
    let mut state = State::new(robot.clone());
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    state.regrow();
    let needed = state.bad_bonds();
    let mut progress = Progress { needed, ..Progress::default() };
    progress.see(&state);
    let mut search = Search { state, dice: Dice(settings.seed), settings, watch, progress };
    search.snake()?;
    search.report()?;
    let State { robot: end, steps, mut work, .. } = search.state;
    let holds = (0..end.bonds.len()).map(|bond| robot.holds.get(bond).copied().unwrap_or(false)).collect();
    let start = Robot { joints: robot.joints.clone(), bonds: end.bonds.clone(), holds };
    let steps = shortened(start, &steps, &mut work);
    search.progress.work = work;
    Ok(Found { robot: end, steps, progress: search.progress })
}

struct Search<'a> {
    state: State,
    dice: Dice,
    settings: &'a Settings,
    watch: &'a mut dyn FnMut(&Progress) -> bool,
    progress: Progress,
}

impl Search<'_> {
    fn snake(&mut self) -> Result<(), Refusal> {
        let mut tilted = opening::straighten(&mut self.state, &mut self.dice);
        let mut idle = 0;
        while self.state.bad_bonds() > 0 {
            self.report()?;
            if self.merge(idle)? {
                idle = 0;
            } else {
                idle += 1;
                self.shake();
            }
            tilted = opening::straighten(&mut self.state, &mut self.dice);
        }
        while tilted > 0 {
            self.report()?;
            self.shake();
            tilted = opening::straighten(&mut self.state, &mut self.dice);
        }
        self.untwist();
        Ok(())
    }

    /// Brings the ends of two chains together, whichever first. `idle` rounds before found none.
    fn merge(&mut self, idle: usize) -> Result<bool, Refusal> {
        let pairs = self.pairs(idle);
        for (manner, size, many) in ATTEMPTS {
            for pair in pairs.iter().take(many) {
                self.progress.tried += 1;
                let attempt = merging::Attempt { pair, manner, size, closing: &self.settings.closing };
                let mut work = 0;
                let way = attempt.way(&self.state, &mut self.dice, &mut work);
                self.state.work += work;
                if let Some(way) = way {
                    self.take(pair, way, &pairs);
                    return Ok(true);
                }
                self.report()?;
            }
        }
        self.merge_on_lattice(idle, &pairs)
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
            if let Some(there) = there {
                self.take(pair, vec![there], pairs);
                return Ok(true);
            }
            self.report()?;
        }
        Ok(false)
    }

    /// Goes a way that brings a pair together, and others with it where one turn does that.
    fn take(&mut self, pair: &Pair, mut way: Vec<Joints>, pairs: &[Pair]) {
        let mut together = vec![*pair];
        if let [joints] = &mut way[..] {
            let mut work = 0;
            let Settings { at_once, closing, .. } = self.settings;
            let party = Party { pairs: together, joints: std::mem::take(joints) };
            let counts = (&mut self.progress.tried, &mut work);
            let party = party.grown(&self.state, pairs, *at_once, closing, &mut self.dice, counts);
            self.state.work += work;
            (together, *joints) = (party.pairs, party.joints);
        }
        way.iter().for_each(|joints| self.state.go(joints));
        merging::make(&mut self.state, &together);
        self.progress.made += together.len();
        self.progress.see(&self.state);
    }

    fn pairs(&mut self, idle: usize) -> Vec<Pair> {
        let mut pairs = merging::pairs(&self.state);
        for pair in &mut pairs {
            pair.cost *= 1.0 + 0.5 * NOISE * idle as f64 * (1.0 + self.dice.signed());
        }
        pairs.sort_by(|p, q| p.cost.total_cmp(&q.cost).then((p.a, p.b).cmp(&(q.a, q.b))));
        pairs
    }

    fn shake(&mut self) {
        let Settings { shake_turns, shake_slack, .. } = *self.settings;
        opening::shake(&mut self.state, &mut self.dice, shake_turns, shake_slack);
    }

    /// A straight snake turns its modules about its own line, which moves no ball.
    fn untwist(&mut self) {
        let mut joints = self.state.robot.joints.clone();
        joints.iter_mut().for_each(|q| q[GAMMA] = TAU * libm::round(q[GAMMA] / TAU));
        self.state.go(&joints);
    }

    fn report(&mut self) -> Result<(), Refusal> {
        self.progress.work = self.state.work;
        if self.state.work > self.settings.budget {
            return Err(Refusal::Budget(self.progress));
        }
        if (self.watch)(&self.progress) { Ok(()) } else { Err(Refusal::Stopped(self.progress)) }
    }
}
