//! Merging two chains into one: their ends dock, and a bond of the loop that this closes is undocked which is not a
//! snake bond.

use super::broad_phase;
use super::inverse_kinematics::{self, IkMode, Loop, LoopClosure, MovingSide};
use super::motion_check::Scene;
use super::robot::{Bond, Dock, FACES, GAMMA, RED};
use super::rrt_connect::RrtConnect;
use super::state::{Joints, State};
use super::tree::{JointRef, Tree};
use crate::optimize::random::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Two free docks -Z at the ends of different chains, which may be brought together.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The dock -Z of the shoe with the smaller number ([`Dock::shoe`]).
    pub a: Dock,
    /// The dock -Z of the shoe with the greater number ([`Dock::shoe`]).
    pub b: Dock,
    /// The number of modules between the two docks whose joints can bend the loop.
    pub length: usize,
    /// The estimated cost of bringing the docks together, less is more promising: the logit of failure, up to a
    /// constant, for a floating robot; a number of modules under gravity.
    pub cost: f64,
}

/// Returns all pairs of free docks -Z at the ends of different chains with their estimated costs, the most promising
/// first; of equal costs in order of their docks.
pub fn pairs(state: &State) -> Vec<Pair> {
    let densities = local_density(state);
    let pair = |[a, b]: [Dock; 2]| {
        let (length, moved) = bending(state, a, b);
        let density = [0, 1].map(|k| (densities[a.shoe()][k] + densities[b.shoe()][k]) as f64);
        let gap = gap(state, a, b);
        let cost = if state.gravity.is_some() {
            load_cost(length, gap)
        } else {
            failure_logit(length, gap, density, moved as f64)
        };
        Pair { a, b, length, cost }
    };
    let mut pairs: Vec<Pair> = free_ends(state).into_iter().map(pair).collect();
    pairs.sort_by(|p, q| p.cost.total_cmp(&q.cost).then((p.a, p.b).cmp(&(q.a, q.b))));
    pairs
}

/// Returns all pairs of free docks -Z at the ends of different chains, ascending by the numbers of their shoes
/// ([`Dock::shoe`]), of which the first in a pair is the smaller.
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

/// Returns the distance between the centres of two docks' shoes, in pitches.
fn gap(state: &State, a: Dock, b: Dock) -> f64 {
    let centre = |dock: Dock| state.poses[state.tree.index[dock.shoe()]].translation;
    (centre(a) - centre(b)).norm()
}

/// The radii within which balls around an end are counted, in pitches.
const DENSITY_RADII: [f64; 2] = [2.5, 5.0];

/// Returns the number of balls within each of the radii of each shoe's ball, itself included.
fn local_density(state: &State) -> Vec<[usize; 2]> {
    let mut density = vec![[1, 1]; state.poses.len()];
    broad_phase::pairs(&state.poses, DENSITY_RADII[1], &mut |a, b, squared| {
        for index in [a, b] {
            let density = &mut density[state.tree.shoe[index]];
            density[0] += usize::from(squared < DENSITY_RADII[0] * DENSITY_RADII[0]);
            density[1] += 1;
        }
    });
    density
}

/// Returns the logit of the probability that an attempt at a pair fails, but for a constant. The coefficients
/// are those of a logistic regression over 8,000 attempts in four random configurations: the density around
/// the ends counts most, then their distance, then the number of balls that move. Short loops hardly close.
fn failure_logit(length: usize, gap: f64, density: [f64; 2], moved: f64) -> f64 {
    let short = match length {
        0 | 1 => 1000.0,
        2 => 2.0,
        3 => 0.7,
        4 => 0.4,
        5 => 0.2,
        _ => 0.0,
    };
    let log = libm::log;
    1.5 * log(density[0]) + 0.7 * log(density[1]) + 0.9 * log(1.0 + gap) + 0.4 * log(1.0 + moved) + short
}

/// Returns the cost of a pair under gravity, in modules: long loops are heavy arms.
fn load_cost(length: usize, gap: f64) -> f64 {
    let short = match length {
        0 | 1 => 1000.0,
        2 => 6.0,
        3 => 2.0,
        _ => 0.0,
    };
    length as f64 + 0.3 * gap + short
}

/// Returns the number of modules that bend between two docks, and the number of balls that they move.
fn bending(state: &State, a: Dock, b: Dock) -> (usize, usize) {
    let tree = &state.tree;
    let (mut p, mut q) = (tree.index[a.shoe()], tree.index[b.shoe()]);
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

/// The options of one attempt to bring the docks of a pair together.
pub struct Attempt<'a> {
    /// The pair whose docks are to be brought together.
    pub pair: &'a Pair,
    /// The mode of the inverse kinematics.
    pub mode: IkMode,
    /// True if, in the endpoint mode, RRT-Connect looks for a detour where the straight motion is not free.
    pub detour: bool,
    /// The spread of the random start (endpoint mode) as a fraction, 0 to 1, of half the joints' ranges, or of the
    /// random initial bias (collision-free mode) as a fraction, 0 to 1, of the greatest.
    pub spread: f64,
    /// The side of the loop whose joints move.
    pub side: MovingSide,
    /// The settings of the inverse kinematics that closes the loop.
    pub settings: &'a inverse_kinematics::Settings,
}

impl Attempt<'_> {
    /// Returns a path in joint space whose last posture has the docks together and whose straight segments are free;
    /// the postures come in order, without the first, `here` (rad, by module). `None` if this attempt finds none.
    /// `work` counts forward kinematics. `scene`: the robot as checks of collisions see it; `rng`: the generator of
    /// random starts.
    pub fn path(
        &self,
        scene: &Scene,
        here: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        match self.mode {
            IkMode::Endpoint => self.path_to_endpoint(scene, here, rng, work),
            IkMode::CollisionFree => self.path_of_descent(scene, here, rng, work),
        }
    }

    /// Returns a straight path to the endpoint, or a detour; `None` if neither is found.
    fn path_to_endpoint(
        &self,
        scene: &Scene,
        here: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        let there = self.closed_posture(scene, here, rng, work)?;
        if scene.is_free(here, &there, work) {
            return Some(vec![there]);
        }
        if !self.detour {
            return None;
        }
        let mut own = SplitMix64(rng.next_u64());
        let joints: Vec<JointRef> =
            self.moving_loop(scene.tree).joints.iter().map(|(joint, _)| *joint).collect();
        RrtConnect { scene, joints: &joints }.path(here, &there, &mut own, work)
    }

    /// Returns the postures of a collision-free descent, in as few straight segments as bisection finds; `None` if the
    /// descent does not close the loop, or two successive postures have no free motion between them.
    fn path_of_descent(
        &self,
        scene: &Scene,
        here: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Vec<Joints>> {
        let lp = self.moving_loop(scene.tree);
        let mut initial_bias = vec![0.0; 3 * here.len()];
        for (joint, _) in &lp.joints {
            initial_bias[3 * joint.module + joint.joint] = INITIAL_BIAS_MAX * self.spread * rng.next_signed();
        }
        let descent = self.closure(scene, &lp).solve(here, &initial_bias, work)?;
        let last = descent.last()?.clone();
        if scene.is_free(here, &last, work) {
            return Some(vec![last]);
        }
        let mut path = Vec::new();
        connect(scene, &descent, 0, descent.len() - 1, work, &mut path).then_some(path)
    }

    /// Returns a posture (rad, by module) with the docks together and without overlap, found by inverse kinematics
    /// from a random start near the positions `from`; the motion there is not checked. `None` if the descent does not
    /// close the loop. `work` counts forward kinematics. `scene`: the robot as checks of collisions see it; `rng`:
    /// the generator of random starts.
    pub fn closed_posture(
        &self,
        scene: &Scene,
        from: &Joints,
        rng: &mut SplitMix64,
        work: &mut u64,
    ) -> Option<Joints> {
        let lp = self.moving_loop(scene.tree);
        let mut start = from.clone();
        for (joint, _) in &lp.joints {
            let q = &mut start[joint.module][joint.joint];
            let range = if joint.joint == GAMMA { PI } else { FRAC_PI_2 };
            *q = inverse_kinematics::clamped(joint.joint, *q + self.spread * range * rng.next_signed());
        }
        self.closure(scene, &lp).solve(&start, &[], work)?.pop()
    }

    /// Returns the number of random numbers that [`Attempt::path`] draws at most.
    pub fn draws(&self, tree: &Tree) -> usize {
        self.moving_loop(tree).joints.len() + usize::from(self.detour)
    }

    /// Returns the loop of the pair with the joints of the moving side alone.
    fn moving_loop(&self, tree: &Tree) -> Loop {
        Loop::new(tree, self.pair.a, self.pair.b).of_side(self.side)
    }

    /// Returns the problem of inverse kinematics that closes a loop.
    fn closure<'a>(&'a self, scene: &'a Scene<'a>, lp: &'a Loop) -> LoopClosure<'a> {
        LoopClosure { scene, lp, mode: self.mode, settings: self.settings }
    }
}

/// Docks the ends of pairs that were brought together, undocks for each pair one of the bonds that the new one can
/// replace (that which frees the most docks -Z), and rebuilds the tree. `state`: the robot, which is changed. Panics
/// if a pair is of one chain.
pub fn merge(state: &mut State, pairs: &[Pair]) {
    let replaced: Vec<usize> = pairs.iter().map(|pair| replaceable_bonds(state, pair)[0]).collect();
    for (pair, bond) in pairs.iter().zip(replaced) {
        state.dock(Bond { a: pair.a, b: pair.b, turn: 0 });
        state.undock(bond);
    }
    state.rebuild_tree();
}

/// Docks the ends of a pair and undocks the first replaceable bond, in the order that [`merge`] prefers, after which no
/// joint bears more than [`State::load_share`] of its torque limit; returns the state after that. `None` if there is no
/// such bond, and for a floating robot. Overloads met on the way are noted in [`State::least_overload`], also if a
/// later bond succeeds. Panics if the pair is of one chain.
pub fn merged_within_limits(state: &State, pair: &Pair) -> Option<State> {
    replaceable_bonds(state, pair).into_iter().find_map(|bond| {
        let mut after = state.clone();
        after.dock(Bond { a: pair.a, b: pair.b, turn: 0 });
        after.undock(bond);
        after.rebuild_tree();
        let load = after.load()?;
        if load.ratio <= after.load_share {
            return Some(after);
        }
        state.note_overload(load);
        None
    })
}

/// Greatest initial bias of a joint in one step of a collision-free descent, rad.
const INITIAL_BIAS_MAX: f64 = 0.15;

/// Appends postures of a descent between which straight motions are free, as few as bisection finds;
/// returns false if two successive postures have none. The whole from first to last was checked before.
fn connect(
    scene: &Scene,
    descent: &[Joints],
    from: usize,
    to: usize,
    work: &mut u64,
    path: &mut Vec<Joints>,
) -> bool {
    if (from, to) != (0, descent.len() - 1) && scene.is_free(&descent[from], &descent[to], work) {
        path.push(descent[to].clone());
        return true;
    }
    if to == from + 1 {
        return false;
    }
    let middle = (from + to) / 2;
    connect(scene, descent, from, middle, work, path) && connect(scene, descent, middle, to, work, path)
}

/// Returns the bonds between the docks of a pair that are not snake bonds; there is at least one. Those come first
/// that free a dock -Z.
fn replaceable_bonds(state: &State, pair: &Pair) -> Vec<usize> {
    let tree = &state.tree;
    let path = tree.path(tree.index[pair.a.shoe()], tree.index[pair.b.shoe()]);
    let bonds = path.indices.windows(2).filter_map(|step| tree.bond(step[0].max(step[1])));
    let others = bonds.filter(|bond| !state.robot.bonds[*bond].is_snake_bond());
    let freed = |bond: &usize| {
        let Bond { a, b, .. } = state.robot.bonds[*bond];
        [a, b].iter().filter(|dock| dock.dock % FACES == RED).count()
    };
    let mut others: Vec<usize> = others.collect();
    assert!(!others.is_empty(), "between two chains there is a bond that is no snake bond");
    others.sort_by_key(freed);
    others.reverse();
    others
}
