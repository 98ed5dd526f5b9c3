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
/// A node is put down beyond an edge when the centre of mass comes so near to it, in units; how far beyond;
/// how much its way down weighs beside everything else; steps until another is taken.
const FOOTHOLD_AT: f64 = 0.1;
const FOOTHOLD_BEYOND: f64 = 0.2;
const FOOTHOLD_WEIGHT: f64 = 100.0;
const FOOTHOLD_STEPS: usize = 60;
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
    /// Whether it may fall over an edge onto other nodes; else it puts one down beyond the edge first, where
    /// it can (as variable topology trusses roll without impact).
    pub impact: bool,
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
    /// Nodes put down beyond an edge before the centre of mass went there.
    pub footholds: usize,
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
        reaching: None,
        out_of_reach: Vec::new(),
        travel: Travel::new(),
    };
    walk.travel.end = walk.settle().err().unwrap_or_else(|| walk.go(going));
    walk.travel
}

impl Travel {
    fn new() -> Travel {
        Travel {
            moves: Vec::new(),
            end: End::Arrived,
            reached: 0,
            steps: 0,
            rolls: 0,
            eased: 0,
            footholds: 0,
            slip: 0.0,
        }
    }
}

struct Walk<'a> {
    truss: &'a Structure,
    wish: &'a Wish,
    x: Vec<Vec3>,
    memory: Memory,
    eased_in_a_row: usize,
    /// The node that is being put down, for so many steps.
    reaching: Option<(usize, usize)>,
    /// Nodes that could not be put down from where it stands.
    out_of_reach: Vec<usize>,
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
            if !self.wish.impact && self.put_down([away[0] * stride, away[1] * stride]) {
                if let Err(end) = self.settle() {
                    return end;
                }
                continue;
            }
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

    /// Where the next step would bring the centre of mass near an edge of the support: a step that brings a
    /// node down beyond it, while the centre of mass stays. False where there is nothing to put down.
    fn put_down(&mut self, stride: [f64; 2]) -> bool {
        let unit = self.truss.unit;
        let contacts = support::contacts(self.truss, &self.x);
        if let Some((node, _)) = self.reaching.filter(|(node, _)| contacts.contains(node)) {
            self.travel.footholds += 1;
            self.out_of_reach.clear();
            self.out_of_reach.push(node);
            self.reaching = None;
        }
        let hull = support::hull(&self.x, &contacts);
        let ahead = self.truss.centre(&self.x) + Vec3::new(stride[0], stride[1], 0.0);
        let Some((inside, (a, b))) = support::margin(&self.x, &hull, ahead) else { return false };
        if inside > FOOTHOLD_AT * unit {
            self.reaching = None;
            return false;
        }
        let (from, along) = (self.x[a], (self.x[b] - self.x[a]).normalize());
        let beyond = |node: &usize| (self.x[*node] - from).cross(&along).z > FOOTHOLD_BEYOND * unit;
        let open = (0..self.truss.nodes)
            .filter(|node| !contacts.contains(node) && !self.out_of_reach.contains(node) && beyond(node));
        let lowest = open.min_by(|i, j| self.x[*i].z.total_cmp(&self.x[*j].z));
        let (node, tries) = match (self.reaching, lowest) {
            (Some(reaching), _) => reaching,
            (None, Some(node)) => (node, 0),
            (None, None) => return false,
        };
        let step = if tries < FOOTHOLD_STEPS { self.lower(node, &hull) } else { None };
        let Some(y) = step else {
            self.out_of_reach.push(node);
            self.reaching = None;
            return self.put_down(stride);
        };
        self.reaching = Some((node, tries + 1));
        self.travel.steps += 1;
        self.advance(y);
        true
    }

    fn lower(&mut self, node: usize, hull: &[usize]) -> Option<Vec<Vec3>> {
        let down = self.x[node].z.min(self.wish.stride);
        let pace = self.wish.stride / self.truss.unit;
        let mut objective = locomotion::objective(self.wish.aim, self.truss, &self.x, pace);
        objective.hessian.push((3 * node + 2, 3 * node + 2, FOOTHOLD_WEIGHT));
        objective.linear[3 * node + 2] += FOOTHOLD_WEIGHT * down;
        let task = Task {
            truss: self.truss,
            x: &self.x,
            objective: &objective,
            held: &support::feet(&self.x, hull, self.truss.centre(&self.x)),
            centre: &[(0, 0.0), (1, 0.0)],
            ground: true,
            cap: f64::INFINITY,
        };
        let mut memory = self.memory.clone();
        let y = step(&task, &mut memory).ok()?;
        self.memory = memory;
        // Nothing is gained where other limits hold it up.
        (self.x[node].z - y[node].z > 0.1 * down).then_some(y)
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
            self.reaching = None;
            self.out_of_reach.clear();
            self.travel.moves.push(Move::Roll(roll));
        }
        Err(End::Falls)
    }
}

/// A centre of mass that is less inside the support than this part of the unit falls over the edge.
const SAFE: f64 = 1e-9;
