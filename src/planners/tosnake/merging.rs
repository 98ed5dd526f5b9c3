//! Two chains become one: their ends meet, and a bond that is none of a snake is let go.

use super::closing::{self, Loop, Manner};
use super::detour::Detour;
use super::near;
use super::robot::{Bond, Dock, FACES, GAMMA, RED};
use super::state::{Joints, State};
use super::sweep::Scene;
use super::tree::{JointRef, Tree};
use crate::planners::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Two free red docks of different chains.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub a: Dock,
    pub b: Dock,
    /// Modules that bend between them.
    pub length: usize,
    /// Small is promising.
    pub cost: f64,
}

/// All pairs of free ends of different chains, the most promising first.
pub fn pairs(state: &State) -> Vec<Pair> {
    let crowds = crowds(state);
    let pair = |[a, b]: [Dock; 2]| {
        let (length, moved) = bending(state, a, b);
        let crowd = [0, 1].map(|k| (crowds[a.shoe()][k] + crowds[b.shoe()][k]) as f64);
        let gap = gap(state, a, b);
        let cost = if state.weight.is_some() {
            burden(length, gap)
        } else {
            odds_against(length, gap, crowd, moved as f64)
        };
        Pair { a, b, length, cost }
    };
    let mut pairs: Vec<Pair> = free_ends(state).into_iter().map(pair).collect();
    pairs.sort_by(|p, q| p.cost.total_cmp(&q.cost).then((p.a, p.b).cmp(&(q.a, q.b))));
    pairs
}

/// All pairs of free ends of different chains, in order.
pub fn free_ends(state: &State) -> Vec<[Dock; 2]> {
    let at = state.robot.bond_at();
    let chains = state.chains();
    let free: Vec<Dock> = (0..2 * state.robot.modules())
        .map(Dock::red)
        .filter(|dock| at[dock.module][dock.dock].is_none())
        .collect();
    let mut pairs = Vec::new();
    for (i, &a) in free.iter().enumerate() {
        pairs.extend(free[i + 1..].iter().filter(|b| chains[a.module] != chains[b.module]).map(|&b| [a, b]));
    }
    pairs
}

/// The straight distance of two docks' shoes.
fn gap(state: &State, a: Dock, b: Dock) -> f64 {
    let place = |dock: Dock| state.poses[state.tree.place[dock.shoe()]].translation;
    (place(a) - place(b)).norm()
}

/// How much is around ends, in balls: within so many pitches of them.
const CROWDS: [f64; 2] = [2.5, 5.0];

/// By shoe: how many balls are near its own, itself among them.
fn crowds(state: &State) -> Vec<[usize; 2]> {
    let mut crowds = vec![[1, 1]; state.poses.len()];
    near::pairs(&state.poses, CROWDS[1], &mut |a, b, squared| {
        for place in [a, b] {
            let crowd = &mut crowds[state.tree.shoe[place]];
            crowd[0] += usize::from(squared < CROWDS[0] * CROWDS[0]);
            crowd[1] += 1;
        }
    });
    crowds
}

/// The odds against a pair: their logarithm, but for a constant. From 8,000 attempts in four tangles, by logistic
/// regression: what counts is how crowded it is around the ends, then how far they are from each other,
/// then how many balls move. Loops of few modules hardly close.
fn odds_against(length: usize, gap: f64, crowd: [f64; 2], moved: f64) -> f64 {
    let short = match length {
        0 | 1 => 1000.0,
        2 => 2.0,
        3 => 0.7,
        4 => 0.4,
        5 => 0.2,
        _ => 0.0,
    };
    let log = libm::log;
    1.5 * log(crowd[0]) + 0.7 * log(crowd[1]) + 0.9 * log(1.0 + gap) + 0.4 * log(1.0 + moved) + short
}

/// Where something pulls, long loops hang on their joints.
fn burden(length: usize, gap: f64) -> f64 {
    let short = match length {
        0 | 1 => 1000.0,
        2 => 6.0,
        3 => 2.0,
        _ => 0.0,
    };
    length as f64 + 0.3 * gap + short
}

/// How many modules bend on the way between two docks, and how many balls they move against the rest.
fn bending(state: &State, a: Dock, b: Dock) -> (usize, usize) {
    let tree = &state.tree;
    let (mut p, mut q) = (tree.place[a.shoe()], tree.place[b.shoe()]);
    let (mut count, mut moved) = (0, [0; 2]);
    while p != q {
        let (lower, moved) = if p > q { (&mut p, &mut moved[0]) } else { (&mut q, &mut moved[1]) };
        let parent = tree.parent[*lower];
        if tree.shoe[*lower] / 2 == tree.shoe[parent] / 2 {
            count += 1;
            *moved = tree.end[*lower] - *lower;
        }
        *lower = parent;
    }
    (count, moved[0] + moved[1])
}

/// One way of bringing two docks together.
pub struct Attempt<'a> {
    pub pair: &'a Pair,
    pub manner: Manner,
    /// Whether a leap takes another way where the straight one is not free.
    pub detour: bool,
    /// How far from where it is the loop sets out: 0 to 1.
    pub size: f64,
    pub side: Side,
    pub closing: &'a closing::Settings,
}

/// Whose joints bend: those on the way from either dock, or from one to where their ways meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Both,
    First,
    Second,
}

impl Attempt<'_> {
    /// Positions of the joints one after the other, the last of them with the docks together, and the
    /// ways between them free.
    pub fn way(
        &self,
        scene: &Scene,
        here: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        if self.manner == Manner::Leap {
            let there = self.leap(scene, here, rng, work)?;
            if scene.is_free(here, &there, work) {
                return Some(vec![there]);
            }
            if !self.detour {
                return None;
            }
            let mut own = SplitMix64(rng.next_u64());
            let joints: Vec<JointRef> =
                self.bending(scene.tree).joints.iter().map(|(joint, _)| *joint).collect();
            let detour = Detour { scene, joints: &joints };
            return detour.way(here, &there, &mut own, work);
        }
        let lp = self.bending(scene.tree);
        let mut drift = vec![0.0; 3 * here.len()];
        for (joint, _) in &lp.joints {
            drift[3 * joint.module + joint.joint] = DRIFT * self.size * rng.next_signed();
        }
        let way = self.closing(scene, &lp).close(here, &drift, work)?;
        let last = way.last()?.clone();
        if scene.is_free(here, &last, work) {
            return Some(vec![last]);
        }
        let mut stops = Vec::new();
        connect(scene, &way, 0, way.len() - 1, work, &mut stops).then_some(stops)
    }

    /// Where the loop's joints bring the docks together, set out from near given positions; whatever is
    /// on the way there.
    pub fn leap(&self, scene: &Scene, from: &Joints, rng: &mut SplitMix64, work: &mut u64) -> Option<Joints> {
        let lp = self.bending(scene.tree);
        let mut start = from.clone();
        for (joint, _) in &lp.joints {
            let q = &mut start[joint.module][joint.joint];
            let range = if joint.joint == GAMMA { PI } else { FRAC_PI_2 };
            *q = closing::limited(joint.joint, *q + self.size * range * rng.next_signed());
        }
        self.closing(scene, &lp).close(&start, &[], work)?.pop()
    }

    /// How many numbers of the rng the way takes.
    pub fn throws(&self, tree: &Tree) -> usize {
        self.bending(tree).joints.len() + usize::from(self.detour)
    }

    fn bending(&self, tree: &Tree) -> Loop {
        let mut lp = Loop::new(tree, self.pair.a, self.pair.b);
        match self.side {
            Side::Both => {}
            Side::First => lp.joints.retain(|(_, sign)| *sign < 0.0),
            Side::Second => lp.joints.retain(|(_, sign)| *sign > 0.0),
        }
        lp
    }

    fn closing<'a>(&'a self, scene: &'a Scene<'a>, lp: &'a Loop) -> closing::Closing<'a> {
        closing::Closing { scene, lp, manner: self.manner, settings: self.closing }
    }
}

/// The ends of pairs that were brought together dock, and for each of them another bond is let go:
/// the best one.
pub fn make(state: &mut State, pairs: &[Pair]) {
    let cuts: Vec<usize> = pairs.iter().map(|pair| cuts(state, pair)[0]).collect();
    for (pair, cut) in pairs.iter().zip(cuts) {
        state.dock(Bond { a: pair.a, b: pair.b, turn: 0 });
        state.undock(cut);
    }
    state.regrow();
}

/// The ends of a pair dock, and the best of those bonds is let go without which the joints hold what
/// hangs on them. `None` where that is true of none; then the state knows what was too much.
pub fn made_within_limits(state: &State, pair: &Pair) -> Option<State> {
    cuts(state, pair).into_iter().find_map(|cut| {
        let mut after = state.clone();
        after.dock(Bond { a: pair.a, b: pair.b, turn: 0 });
        after.undock(cut);
        after.regrow();
        let load = after.load()?;
        if load.ratio <= after.share {
            return Some(after);
        }
        state.refuse(load);
        None
    })
}

/// How far a joint drifts in one step of a flow at most, rad.
const DRIFT: f64 = 0.15;

/// The states between which the straight way is free, as few as halving finds.
fn connect(
    scene: &Scene,
    way: &[Joints],
    from: usize,
    to: usize,
    work: &mut u64,
    stops: &mut Vec<Joints>,
) -> bool {
    if (from, to) != (0, way.len() - 1) && scene.is_free(&way[from], &way[to], work) {
        stops.push(way[to].clone());
        return true;
    }
    if to == from + 1 {
        return false;
    }
    let middle = (from + to) / 2;
    connect(scene, way, from, middle, work, stops) && connect(scene, way, middle, to, work, stops)
}

/// Which bonds of the loop may be let go: those that are none of a snake. What frees a red dock comes
/// first; there is at least one.
fn cuts(state: &State, pair: &Pair) -> Vec<usize> {
    let tree = &state.tree;
    let path = tree.path(tree.place[pair.a.shoe()], tree.place[pair.b.shoe()]);
    let bonds = path.places.windows(2).filter_map(|step| tree.bond(step[0].max(step[1])));
    let bad = bonds.filter(|bond| !state.robot.bonds[*bond].is_good());
    let freed = |bond: &usize| {
        let Bond { a, b, .. } = state.robot.bonds[*bond];
        [a, b].iter().filter(|dock| dock.dock % FACES == RED).count()
    };
    let mut bad: Vec<usize> = bad.collect();
    assert!(!bad.is_empty(), "between two chains there is a bond that is none of a snake");
    bad.sort_by_key(freed);
    bad.reverse();
    bad
}
