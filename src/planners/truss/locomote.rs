//! `locomote`: the centre of mass along a path, step by step, and over the edge where it leaves the
//! support (sections IV.A to IV.C of the paper).

use super::ahead;
use super::bound::Bound;
use super::locomotion::{self, Aim};
use super::roll::{self, Fate, Roll};
use super::step::{CUSHION, Memory, Stuck, Task, step};
use super::structure::Structure;
use super::support;
use crate::geometry::Vec3;

/// Rungs of the ladder that are taken one after another without the next step being an ordinary one, and so
/// where other ways to go on are known.
const EASED_MAX: usize = 60;
const EASED_MAX_AHEAD: usize = 3;
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
    /// Steps that each way to go on is tried for before the best is taken; of 0 none is tried.
    pub ahead: usize,
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
    /// It would fall over an edge, and into this.
    Blocked(Bound),
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
    /// How long it all takes, s; a roll a second a radian.
    pub lasts: f64,
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

/// Moves a truss that stands on the ground. `going` is asked before every step, with the places reached.
pub fn locomote(truss: &Structure, start: &[Vec3], wish: &Wish, going: &dyn Fn(usize) -> bool) -> Travel {
    let truss = &truss.cautious(CUSHION);
    let mut walk = Walk {
        truss,
        wish,
        manner: Manner { aim: wish.aim, impact: wish.impact },
        x: start.to_vec(),
        memory: Memory::default(),
        eased_in_a_row: 0,
        patient: wish.ahead == 0,
        careful: false,
        reaching: None,
        out_of_reach: Vec::new(),
        travel: Travel::new(),
    };
    walk.travel.end = match walk.settle() {
        Err(end) => end,
        Ok(()) if wish.ahead > 0 => return ahead::best(walk, going).travel,
        Ok(()) => walk.go(usize::MAX, going).unwrap_or(End::Steps),
    };
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
            lasts: 0.0,
        }
    }
}

/// How a truss walks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    pub aim: Aim,
    pub impact: bool,
}

#[derive(Clone)]
pub struct Walk<'a> {
    pub truss: &'a Structure,
    pub wish: &'a Wish,
    pub manner: Manner,
    pub x: Vec<Vec3>,
    memory: Memory,
    eased_in_a_row: usize,
    /// Whether it goes on as long as it can with easier steps.
    pub patient: bool,
    /// Whether something is in the way of the next roll, so that a node has to be put down first.
    careful: bool,
    /// The node that is being put down, for so many steps.
    reaching: Option<(usize, usize)>,
    /// Nodes that could not be put down from where it stands.
    out_of_reach: Vec<usize>,
    pub travel: Travel,
}

impl Walk<'_> {
    /// Goes on for some steps at most; `None` if that is all there is to say.
    pub fn go(&mut self, steps: usize, going: &dyn Fn(usize) -> bool) -> Option<End> {
        let first = self.travel.steps;
        while let Some(place) = self.wish.path.get(self.travel.reached) {
            let centre = self.truss.centre(&self.x);
            let away = [place[0] - centre.x, place[1] - centre.y];
            let distance = libm::hypot(away[0], away[1]);
            if distance < self.wish.near {
                self.travel.reached += 1;
                continue;
            }
            if self.travel.steps >= self.wish.steps_max {
                return Some(End::Steps);
            }
            if self.travel.steps - first >= steps {
                return None;
            }
            if !going(self.travel.reached) {
                return Some(End::Cancelled);
            }
            let stride = self.wish.stride.min(distance) / distance;
            if let Err(end) = self.one([away[0] * stride, away[1] * stride]) {
                return Some(end);
            }
        }
        Some(End::Arrived)
    }

    /// One step, with the rolls that follow.
    fn one(&mut self, stride: [f64; 2]) -> Result<(), End> {
        if (!self.manner.impact || self.careful) && self.put_down(stride) {
            return self.settle();
        }
        let before = (self.x.clone(), self.travel.moves.len(), self.travel.lasts, self.travel.slip);
        let y = self.next(stride).map_err(End::Stuck)?;
        self.travel.steps += 1;
        self.advance(y);
        let settled = self.settle();
        if matches!(settled, Err(End::Blocked(_))) && !self.careful {
            // As if it had not gone there: a node is put down first.
            self.careful = true;
            self.memory = Memory::default();
            self.x = before.0;
            self.travel.moves.truncate(before.1);
            (self.travel.lasts, self.travel.slip) = (before.2, before.3);
            return Ok(());
        }
        settled
    }

    /// How far there is still to go, straight from place to place, m.
    pub fn left(&self) -> f64 {
        let centre = self.truss.centre(&self.x);
        let rest = &self.wish.path[self.travel.reached.min(self.wish.path.len())..];
        let places: Vec<[f64; 2]> = [[centre.x, centre.y]].into_iter().chain(rest.iter().copied()).collect();
        places.windows(2).map(|p| libm::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1])).sum()
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
        let height = |node: &usize| self.truss.around.above(self.x[*node]);
        let lowest = open.min_by(|i, j| height(i).total_cmp(&height(j)));
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
        let down = self.truss.around.above(self.x[node]).min(self.wish.stride);
        let pace = self.wish.stride / self.truss.unit;
        let mut objective = locomotion::objective(self.manner.aim, self.truss, &self.x, pace);
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
                    let most = if self.patient { EASED_MAX } else { EASED_MAX_AHEAD };
                    if self.eased_in_a_row <= most {
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
        let aim = if rung.springs { Aim::Springs } else { self.manner.aim };
        let mut centre = vec![(0, stride[0] * rung.speed), (1, stride[1] * rung.speed)];
        if rung.level {
            let from = self.truss.centre(&self.x);
            let to = [from.x + centre[0].1, from.y + centre[1].1];
            centre.push((2, self.truss.around.rise([from.x, from.y], to, self.truss.unit)));
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
            let stays =
                |node: &usize| now.contains(node) && support::stays_down(self.truss, self.x[*node], x[*node]);
            before.iter().copied().filter(stays).collect::<Vec<_>>()
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
            let rate = self.truss.rates(&self.x, &next).fold(0.0, f64::max);
            self.travel.lasts += rate / self.truss.speed;
            self.x.clone_from(&next);
            self.travel.moves.push(Move::Step(next));
        }
    }

    /// Rolls until it stands.
    fn settle(&mut self) -> Result<(), End> {
        for _ in 0..roll::FALLS_MAX {
            let roll = match roll::fate(self.truss, &self.x) {
                Some(Fate::Rests) => return Ok(()),
                Some(Fate::Rolls(roll)) => roll,
                Some(Fate::Tips(_)) | None => return Err(End::Falls),
            };
            if let Some(bound) = roll::blocked(self.truss, &self.x, roll) {
                return Err(End::Blocked(bound));
            }
            self.x = roll::rolled(&self.x, roll);
            let moved = |bound: &Bound| matches!(bound, Bound::Above(_) | Bound::Over(..) | Bound::Clear(..));
            self.memory.near.retain(|bound| !moved(bound));
            self.travel.rolls += 1;
            self.travel.lasts += roll.angle.abs();
            self.careful = false;
            self.reaching = None;
            self.out_of_reach.clear();
            self.travel.moves.push(Move::Roll(roll));
        }
        Err(End::Falls)
    }
}
