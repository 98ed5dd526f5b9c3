//! `locomote`: the centre of mass along a path, step by step, and over the edge where it leaves the
//! support (sections IV.A to IV.C of the paper).

use super::bound::Bound;
use super::locomotion::{self, Aim};
use super::roll::{self, Roll};
use super::step::{CUSHION, Memory, Stuck, Task, step};
use super::structure::Structure;
use super::support;
use crate::geometry::Vec3;

/// Rolls in a row: a robot that still falls is a wheel.
const ROLLS_MAX: usize = 50;
/// Rungs of the ladder that are taken one after another without the next step being an ordinary one.
const EASED_MAX: usize = 60;
/// Halvings of a step in which the centre of mass leaves the support.
const HALVINGS: usize = 60;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Three nodes on the ground, around the centre of mass; others may slide.
    Three,
    /// All nodes on the ground.
    All,
}

#[derive(Clone, Debug)]
pub struct Wish {
    /// Places (x, y) for the centre of mass, m; the first may be where it is.
    pub path: Vec<[f64; 2]>,
    /// A place is reached when the centre of mass is so near, m.
    pub near: f64,
    /// How far the centre of mass goes in a step, m.
    pub stride: f64,
    pub aim: Aim,
    pub hold: Hold,
    /// Whether the ladder of easier steps is gone down where a step is not found.
    pub ladder: bool,
    pub steps_max: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Move {
    /// Every node straight on.
    Step(Vec<Vec3>),
    Roll(Roll),
}

#[derive(Clone, Debug, PartialEq)]
pub enum End {
    Arrived,
    /// No step was found, not even an easier one.
    Stuck(Stuck),
    /// It stands on one node, or rolls for ever.
    Falls,
    /// The steps allowed were not enough.
    Steps,
    Cancelled,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Travel {
    pub moves: Vec<Move>,
    pub end: End,
    /// Places reached, and steps and rolls made.
    pub reached: usize,
    pub steps: usize,
    pub rolls: usize,
    /// Steps from further down the ladder.
    pub eased: usize,
    /// How far nodes slid over the ground, all together, m.
    pub slip: f64,
}

/// An easier step.
struct Rung {
    speed: f64,
    level: bool,
    other_hold: bool,
    springs: bool,
}

const RUNGS: [Rung; 8] = [
    Rung { speed: 1.0, level: true, other_hold: false, springs: false },
    Rung { speed: 0.5, level: true, other_hold: false, springs: false },
    Rung { speed: 0.25, level: true, other_hold: false, springs: false },
    Rung { speed: 1.0, level: false, other_hold: false, springs: false },
    Rung { speed: 1.0, level: true, other_hold: true, springs: false },
    Rung { speed: 1.0, level: true, other_hold: false, springs: true },
    Rung { speed: 0.5, level: true, other_hold: false, springs: true },
    // It stands still and gets into shape.
    Rung { speed: 0.0, level: true, other_hold: false, springs: true },
];

/// Moves a truss that stands on the ground at height 0. `going` is asked before every step.
pub fn locomote(truss: &Structure, start: &[Vec3], wish: &Wish, going: &dyn Fn(usize) -> bool) -> Travel {
    let truss = &truss.cautious(CUSHION);
    let mut walk = Walk {
        truss,
        wish,
        x: start.to_vec(),
        memory: Memory::default(),
        eased_in_a_row: 0,
        travel: Travel::new(),
    };
    walk.travel.end = walk.settle().err().unwrap_or_else(|| walk.go(going));
    walk.travel
}

impl Travel {
    fn new() -> Travel {
        Travel { moves: Vec::new(), end: End::Arrived, reached: 0, steps: 0, rolls: 0, eased: 0, slip: 0.0 }
    }
}

struct Walk<'a> {
    truss: &'a Structure,
    wish: &'a Wish,
    x: Vec<Vec3>,
    memory: Memory,
    eased_in_a_row: usize,
    travel: Travel,
}

impl Walk<'_> {
    fn go(&mut self, going: &dyn Fn(usize) -> bool) -> End {
        while let Some(place) = self.wish.path.get(self.travel.reached) {
            let centre = self.truss.centre(&self.x);
            let away = [place[0] - centre.x, place[1] - centre.y];
            let distance = libm::hypot(away[0], away[1]);
            if distance < self.wish.near {
                self.travel.reached += 1;
                continue;
            }
            if !going(self.travel.reached) {
                return End::Cancelled;
            }
            if self.travel.steps >= self.wish.steps_max {
                return End::Steps;
            }
            let stride = self.wish.stride.min(distance) / distance;
            let y = match self.next([away[0] * stride, away[1] * stride]) {
                Ok(y) => y,
                Err(stuck) => return End::Stuck(stuck),
            };
            self.travel.steps += 1;
            self.advance(y);
            if let Err(end) = self.settle() {
                return end;
            }
        }
        End::Arrived
    }

    /// The next step, from the first rung of the ladder that holds.
    fn next(&mut self, stride: [f64; 2]) -> Result<Vec<Vec3>, Stuck> {
        let contacts = support::contacts(self.truss, &self.x);
        let mut first = None;
        let rungs = if self.wish.ladder { &RUNGS[..] } else { &RUNGS[..1] };
        for (index, rung) in rungs.iter().enumerate() {
            match self.attempt(rung, stride, &contacts) {
                Ok(y) => {
                    let eased = index > 0;
                    self.travel.eased += usize::from(eased);
                    self.eased_in_a_row = if eased { self.eased_in_a_row + 1 } else { 0 };
                    if self.eased_in_a_row <= EASED_MAX {
                        return Ok(y);
                    }
                }
                Err(stuck) => {
                    first.get_or_insert(stuck);
                }
            }
        }
        Err(first.unwrap_or(Stuck::Unsettled(Vec::new())))
    }

    fn attempt(&mut self, rung: &Rung, stride: [f64; 2], contacts: &[usize]) -> Result<Vec<Vec3>, Stuck> {
        let hold = match (self.wish.hold, rung.other_hold) {
            (Hold::Three, false) | (Hold::All, true) => Hold::Three,
            _ => Hold::All,
        };
        let held = match hold {
            Hold::Three => {
                support::feet(&self.x, &support::hull(&self.x, contacts), self.truss.centre(&self.x))
            }
            Hold::All => contacts.to_vec(),
        };
        let aim = if rung.springs { Aim::Springs } else { self.wish.aim };
        let mut centre = vec![(0, stride[0] * rung.speed), (1, stride[1] * rung.speed)];
        if rung.level {
            centre.push((2, 0.0));
        }
        let objective = locomotion::objective(aim, self.truss, &self.x, self.wish.stride / self.truss.unit);
        let task = Task {
            truss: self.truss,
            x: &self.x,
            objective: &objective,
            held: &held,
            centre: &centre,
            ground: true,
            cap: f64::INFINITY,
        };
        let mut memory = self.memory.clone();
        let y = step(&task, &mut memory)?;
        self.memory = memory;
        Ok(y)
    }

    /// Goes on to y, or as far towards it as the robot stands.
    fn advance(&mut self, y: Vec<Vec3>) {
        let towards = |part: f64| self.x.iter().zip(&y).map(|(p, q)| p + (q - p) * part).collect::<Vec<_>>();
        // What is lifted on the way, or comes down, carries nothing.
        let before = support::contacts(self.truss, &self.x);
        let feet = |x: &[Vec3]| {
            let now = support::contacts(self.truss, x);
            before.iter().copied().filter(|node| now.contains(node)).collect::<Vec<_>>()
        };
        let stands =
            |x: &[Vec3]| roll::standing(self.truss, x, &feet(x)).is_some_and(|(inside, _)| inside >= 0.0);
        let next = if stands(&y) {
            y
        } else {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = (low + high) / 2.0;
                if stands(&towards(middle)) { low = middle } else { high = middle }
            }
            towards(low)
        };
        for node in feet(&next) {
            let slid = next[node] - self.x[node];
            self.travel.slip += libm::hypot(slid.x, slid.y);
        }
        if next != self.x {
            self.x.clone_from(&next);
            self.travel.moves.push(Move::Step(next));
        }
    }

    /// Rolls until it stands.
    fn settle(&mut self) -> Result<(), End> {
        for _ in 0..ROLLS_MAX {
            let contacts = support::contacts(self.truss, &self.x);
            let Some((inside, edge)) = roll::standing(self.truss, &self.x, &contacts) else {
                return Err(End::Falls);
            };
            if inside > SAFE * self.truss.unit {
                return Ok(());
            }
            let Some(roll) = roll::over(self.truss, &self.x, edge) else { return Err(End::Falls) };
            self.x = roll::rolled(&self.x, roll);
            self.memory.near.retain(|bound| !matches!(bound, Bound::Above(_)));
            self.travel.rolls += 1;
            self.travel.moves.push(Move::Roll(roll));
        }
        Err(End::Falls)
    }
}

/// A centre of mass that is less inside the support than this part of the unit falls over the edge.
const SAFE: f64 = 1e-9;
