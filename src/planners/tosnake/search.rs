//! The whole way to the snake.

use super::closing::Manner;
use super::merging::{self, Pair};
use super::opening;
use super::robot::{GAMMA, Robot};
use super::shortening::shortened;
use super::sound;
use super::state::State;
use super::{Found, Progress, Refusal, Settings};
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
    sound::check(robot)?;
    let mut state = State::new(robot.clone());
    for bond in state.tree.closing.clone() {
        state.undock(bond);
    }
    state.regrow();
    let needed = state.bad_bonds();
    let progress = Progress { needed, made: 0, tried: 0, work: 0 };
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
                if attempt.merge(&mut self.state, &mut self.dice) {
                    self.progress.made += 1;
                    return Ok(true);
                }
                self.report()?;
            }
        }
        Ok(false)
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
