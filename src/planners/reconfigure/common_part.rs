//! The common part of two configurations: which module of the goal a module of the start becomes, so that as many bonds
//! as possible need not change.
//!
//! Docks tell bonds apart: once a module of the goal is taken for one of the start, turned end for end or not, the bonds
//! that both have lead to the next pair of modules, and so on. So a connected common part follows from one pair, the seed
//! (as in [`crate::robot::matching`]). All seeds are tried, the largest parts first; what is left is matched by further
//! seeds, and at last module by module.

use crate::planners::disjoint_sets::DisjointSets;
use crate::planners::tosnake::robot::{ALPHA, BETA, DOCKS, FACES, GAMMA};
use crate::planners::tosnake::{Bond, Dock, Robot, Step};
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Greatest number of seeds that are looked at; of more, as many spread evenly.
const SEEDS_MAX: usize = 20_000;
/// Greatest number of seeds that are completed to correspondences.
const COMPLETED_MAX: usize = 240;
/// The cost of an exchange of a bond, in quarter turns of a joint; of a dock that has to be left before it can be
/// taken; and of a dock that a module taken alone has to leave.
const EXCHANGE_COST: f64 = 2.0;
const CONFLICT_COST: f64 = 1.0;

/// An image of a module of the goal: the module of the start, and true if it is turned end for end.
type Image = (usize, bool);

/// A configuration with the docked dock and the turn at each dock.
struct Docked<'a> {
    robot: &'a Robot,
    at: Vec<[Option<(Dock, u32)>; DOCKS]>,
}

impl<'a> Docked<'a> {
    fn new(robot: &'a Robot) -> Docked<'a> {
        let mut at = vec![[None; DOCKS]; robot.modules()];
        for (_, &Bond { a, b, turn }) in robot.held() {
            at[a.module][a.dock] = Some((b, turn));
            at[b.module][b.dock] = Some((a, turn));
        }
        Docked { robot, at }
    }
}

/// A correspondence: the goal in the start's modules, and the spanning trees of both that have the most in common.
#[derive(Clone, Debug)]
pub(super) struct Correspondence {
    /// The image of each module of the goal.
    image: Vec<Image>,
    /// The goal with its modules in the start's order: joint positions (rad), and the bonds in the order of the goal's.
    pub(super) goal: Robot,
    /// The bonds of the start outside its tree, by index.
    pub(super) start_loops: Vec<usize>,
    /// The bonds of the goal outside its tree, by index.
    pub(super) goal_loops: Vec<usize>,
    /// The bonds of the goal's tree, with their docks in ascending order.
    pub(super) wanted: BTreeSet<[usize; 5]>,
    /// The number of bonds of either tree that the other lacks.
    pub(super) exchanges: usize,
    /// The estimated cost of the motion, in quarter turns.
    cost: f64,
}

/// Returns a bond as numbers, the same for both orders of its docks.
pub(super) fn key(bond: &Bond) -> [usize; 5] {
    let (a, b) = (bond.a.min(bond.b), bond.a.max(bond.b));
    [a.module, a.dock, b.module, b.dock, bond.turn as usize]
}

/// Returns the bond of a key.
pub(super) fn bond_of(key: &[usize; 5]) -> Bond {
    let dock = |module: usize, dock: usize| Dock { module, dock };
    Bond { a: dock(key[0], key[1]), b: dock(key[2], key[3]), turn: key[4] as u32 }
}

/// Returns the dock of a module that is turned end for end, or not.
fn turned(dock: usize, end_for_end: bool) -> usize {
    if end_for_end { (dock + FACES) % DOCKS } else { dock }
}

/// Returns correspondences of two configurations of as many modules, the most promising first, at most `most`.
pub(super) fn correspondences(start: &Robot, goal: &Robot, most: usize) -> Vec<Correspondence> {
    let (a, b) = (Docked::new(start), Docked::new(goal));
    let count = start.modules();
    let all = 2 * count * count;
    let step = all.div_ceil(SEEDS_MAX).max(1);
    let seed = |number: usize| (number / (2 * count), (number / 2 % count, number % 2 == 1));
    let size = |number: usize| {
        let (of, image) = seed(number);
        let mut found = Images::new(count);
        (found.grow(&a, &b, of, image), number)
    };
    let mut seeds: Vec<(usize, usize)> = (0..all).step_by(step).map(size).collect();
    seeds.sort_by(|p, q| q.0.cmp(&p.0).then(p.1.cmp(&q.1)));
    let order: Vec<(usize, Image)> = seeds.iter().map(|(_, number)| seed(*number)).collect();
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for &first in order.iter().take(COMPLETED_MAX) {
        let image = completed(&a, &b, first, &order);
        if known.insert(image.clone()) {
            found.push(Correspondence::new(&a, &b, image));
        }
    }
    found.sort_by(|p, q| p.cost.total_cmp(&q.cost).then(p.image.cmp(&q.image)));
    found.truncate(most);
    found
}

/// The images that are settled so far.
struct Images {
    image: Vec<Option<Image>>,
    taken: Vec<bool>,
}

impl Images {
    fn new(count: usize) -> Images {
        Images { image: vec![None; count], taken: vec![false; count] }
    }

    fn set(&mut self, of: usize, image: Image) {
        self.image[of] = Some(image);
        self.taken[image.0] = true;
    }

    /// Takes a module of the goal for one of the start, and all that follow from common bonds; returns how many those
    /// are, 0 if either is settled already.
    fn grow(&mut self, a: &Docked, b: &Docked, of: usize, image: Image) -> usize {
        if self.image[of].is_some() || self.taken[image.0] {
            return 0;
        }
        self.set(of, image);
        let mut queue = vec![(of, image)];
        let mut next = 0;
        while let Some(&(of, image)) = queue.get(next) {
            next += 1;
            for dock in 0..DOCKS {
                let here = a.at[image.0][turned(dock, image.1)];
                let (Some((far, turn)), Some((near, same))) = (b.at[of][dock], here) else { continue };
                let end_for_end = far.dock != near.dock;
                let fits = turn == same && turned(far.dock, end_for_end) == near.dock;
                if fits && self.image[far.module].is_none() && !self.taken[near.module] {
                    self.set(far.module, (near.module, end_for_end));
                    queue.push((far.module, (near.module, end_for_end)));
                }
            }
        }
        queue.len()
    }
}

/// Returns all images, with one seed first and others in their order, then module by module.
fn completed(a: &Docked, b: &Docked, first: (usize, Image), order: &[(usize, Image)]) -> Vec<Image> {
    let count = b.robot.modules();
    let mut images = Images::new(count);
    images.grow(a, b, first.0, first.1);
    for &(of, image) in order {
        // One module alone is better placed by what its docks hold.
        let mut tried = Images { image: images.image.clone(), taken: images.taken.clone() };
        if images.image[of].is_none() && !images.taken[image.0] && tried.grow(a, b, of, image) > 1 {
            images = tried;
        }
    }
    for of in 0..count {
        if images.image[of].is_some() {
            continue;
        }
        let free = (0..count).filter(|&module| !images.taken[module]);
        let choices = free.flat_map(|module| [(module, false), (module, true)]);
        let cost = |image: &Image| alone_cost(a, b, of, *image);
        let best = choices.min_by(|p, q| cost(p).total_cmp(&cost(q)).then(p.cmp(q)));
        images.set(of, best.expect("there are as many modules on either side"));
    }
    images.image.into_iter().map(|image| image.expect("all are settled")).collect()
}

/// Returns the cost of taking a module of the goal for one of the start without regard to others: docks that are
/// taken in both, and turns of joints.
fn alone_cost(a: &Docked, b: &Docked, of: usize, image: Image) -> f64 {
    let taken = |dock: &usize| b.at[of][*dock].is_some() && a.at[image.0][turned(*dock, image.1)].is_some();
    let docks = (0..DOCKS).filter(taken).count() as f64;
    let q = joints(&b.robot.joints[of], image.1);
    CONFLICT_COST * docks + greatest_turn(&a.robot.joints[image.0], &q) / FRAC_PI_2
}

/// Returns the joint positions of a module that is turned end for end, or not.
fn joints(q: &[f64; 3], end_for_end: bool) -> [f64; 3] {
    if end_for_end { [q[BETA], q[ALPHA], q[GAMMA]] } else { *q }
}

/// Returns the greatest turn of a joint between two postures of a module, rad; the twist goes the short way.
fn greatest_turn(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    let twist = to[GAMMA] - from[GAMMA];
    let twist = twist - TAU * libm::round(twist / TAU);
    (to[ALPHA] - from[ALPHA]).abs().max((to[BETA] - from[BETA]).abs()).max(twist.abs())
}

impl Correspondence {
    fn new(a: &Docked, b: &Docked, image: Vec<Image>) -> Correspondence {
        let start = a.robot;
        let carried = |dock: Dock| {
            let (module, end_for_end) = image[dock.module];
            Dock { module, dock: turned(dock.dock, end_for_end) }
        };
        let mut goal = b.robot.clone();
        for (of, &(module, end_for_end)) in image.iter().enumerate() {
            goal.joints[module] = joints(&b.robot.joints[of], end_for_end);
        }
        for bond in &mut goal.bonds {
            *bond = Bond { a: carried(bond.a), b: carried(bond.b), turn: bond.turn };
        }
        let keys = |robot: &Robot| robot.held().map(|(_, bond)| key(bond)).collect::<BTreeSet<_>>();
        let (of_start, of_goal) = (keys(start), keys(&goal));
        let common: Vec<[usize; 5]> = of_start.intersection(&of_goal).copied().collect();
        let others = |of: &BTreeSet<[usize; 5]>| {
            of.iter().filter(|key| !common.contains(key)).copied().collect::<Vec<[usize; 5]>>()
        };
        // New bonds are to be at docks that are free, and old ones not in their way.
        let (old, new) = (others(&of_start), others(&of_goal));
        let shared = spanning(start.modules(), &[], &common);
        let wanted = spanning(start.modules(), &shared, &by_conflicts(new, &old));
        let missing: Vec<[usize; 5]> = wanted.iter().filter(|key| !shared.contains(key)).copied().collect();
        let held = spanning(start.modules(), &shared, &by_conflicts(old, &missing));
        let in_the_way = held
            .iter()
            .filter(|key| !shared.contains(key))
            .map(|key| conflicts(key, &missing))
            .sum::<usize>();
        let loops = |robot: &Robot, tree: &[[usize; 5]]| {
            robot.held().filter(|(_, bond)| !tree.contains(&key(bond))).map(|(index, _)| index).collect()
        };
        let turns = start.joints.iter().zip(&goal.joints).map(|(from, to)| greatest_turn(from, to));
        let cost = EXCHANGE_COST * missing.len() as f64
            + CONFLICT_COST * in_the_way as f64
            + turns.fold(0.0, f64::max) / FRAC_PI_2;
        Correspondence {
            start_loops: loops(start, &held),
            goal_loops: loops(&goal, &wanted),
            exchanges: missing.len(),
            wanted: wanted.into_iter().collect(),
            image,
            goal,
            cost,
        }
    }
}

impl Correspondence {
    /// Returns the shoe of the start that a shoe of the goal becomes, both by their numbers
    /// ([`Dock::shoe`]). The frames of both shoes of a module are alike, so poses need no change. Panics if there is no
    /// such shoe.
    pub(super) fn shoe(&self, shoe: usize) -> usize {
        let (module, end_for_end) = self.image[shoe / 2];
        2 * module + (shoe + usize::from(end_for_end)) % 2
    }

    /// Returns a configuration and steps in the start's modules as ones in the goal's. Its list of bonds begins with the
    /// goal's.
    pub(super) fn in_goals_modules(&self, robot: Robot, steps: Vec<Step>) -> (Robot, Vec<Step>) {
        // The module of the goal that each of the start's is, with the same turn end for end.
        let mut source = vec![(0, false); self.image.len()];
        for (of, &(module, end_for_end)) in self.image.iter().enumerate() {
            source[module] = (of, end_for_end);
        }
        let dock = |dock: Dock| {
            let (module, end_for_end) = source[dock.module];
            Dock { module, dock: turned(dock.dock, end_for_end) }
        };
        let turn = |&(module, joint, to): &(usize, usize, f64)| {
            let (module, end_for_end) = source[module];
            let joint = match joint {
                ALPHA if end_for_end => BETA,
                BETA if end_for_end => ALPHA,
                joint => joint,
            };
            (module, joint, to)
        };
        let step = |step: Step| match step {
            Step::Turn(turns) => Step::Turn(turns.iter().map(turn).collect()),
            other => other,
        };
        let positions = self.image.iter().map(|&(module, turned)| joints(&robot.joints[module], turned));
        let bonds = robot.bonds.iter().map(|b| Bond { a: dock(b.a), b: dock(b.b), turn: b.turn });
        let robot = Robot { joints: positions.collect(), bonds: bonds.collect(), holds: robot.holds };
        (robot, steps.into_iter().map(step).collect())
    }
}

/// Returns how many docks a bond shares with others.
fn conflicts(bond: &[usize; 5], others: &[[usize; 5]]) -> usize {
    let docks = |key: &[usize; 5]| [(key[0], key[1]), (key[2], key[3])];
    let own = docks(bond);
    others.iter().flat_map(docks).filter(|dock| own.contains(dock)).count()
}

/// Returns bonds in ascending order of the docks that they share with others.
fn by_conflicts(mut bonds: Vec<[usize; 5]>, others: &[[usize; 5]]) -> Vec<[usize; 5]> {
    bonds.sort_by_key(|bond| (conflicts(bond, others), *bond));
    bonds
}

/// Returns bonds that join modules without a loop: `first`, and then of `next` those that join what was apart (Kruskal).
fn spanning(count: usize, first: &[[usize; 5]], next: &[[usize; 5]]) -> Vec<[usize; 5]> {
    let mut joined = DisjointSets::new(count);
    first.iter().chain(next).filter(|bond| joined.join(bond[0], bond[2])).copied().collect()
}
