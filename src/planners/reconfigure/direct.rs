//! The direct way: the start's tree of bonds becomes the goal's by exchanges, and what both have in common stays.
//!
//! Bonds that close loops and are not of the start's tree are undocked. An exchange brings the two docks of a bond of the
//! goal's tree together by inverse kinematics, docks them, and undocks one bond of the loop that this closes which is not
//! of the goal's tree; there is one, for a tree has no loop. At last the joints turn to the goal's positions, and the
//! goal's other bonds dock. A beam search for the shortest motion finds the order of
//! exchanges, the bonds that they replace and the postures. Half of the exchanges are made from the start and half from the goal, backwards: close
//! to either the robot is folded up, and between it is spread out. Every motion is checked over its whole duration, as in
//! [`tosnake`](crate::planners::tosnake).

use super::common_part::{Correspondence, bond_of, key};
use crate::optimize::random::SplitMix64;
use crate::planners::Progress;
use crate::planners::tosnake::inverse_kinematics::{self, IkMode, Loop, LoopClosure, MovingSide, clamped};
use crate::planners::tosnake::robot::GAMMA;
use crate::planners::tosnake::stance::Stance;
use crate::planners::tosnake::state::{Joints, State};
use crate::planners::tosnake::tree::JointRef;
use crate::planners::tosnake::{Dock, Robot, Step};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The settings of the beam search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The greatest number of correspondences of the two configurations that are tried in either direction. Default 4.
    pub correspondences_max: usize,
    /// The greatest number of exchanges. Default 24: of more the snake is the shorter way.
    pub exchanges_max: usize,
    /// The number of states kept after each exchange. Default 2.
    pub beam: usize,
    /// The greatest number of bonds that are followed from one state, those with the nearest docks first. Default 3.
    pub bonds_max: usize,
    /// The greatest number of postures that are tried for one bond. Default 4.
    pub closings_max: usize,
    /// The greatest number of forward kinematics of the whole robot for one correspondence. Default 250,000.
    pub budget: u64,
    /// The settings of the inverse kinematics, by default with 45 iterations at most, 10 of them without progress: another
    /// posture or bond is the cheaper attempt.
    pub inverse_kinematics: inverse_kinematics::Settings,
}

impl Default for Settings {
    fn default() -> Settings {
        let inverse_kinematics = inverse_kinematics::Settings {
            iterations_max: 45,
            patience: 10,
            ..inverse_kinematics::Settings::default()
        };
        Settings {
            correspondences_max: 4,
            exchanges_max: 24,
            beam: 2,
            bonds_max: 3,
            closings_max: 4,
            budget: 250_000,
            inverse_kinematics,
        }
    }
}

impl Settings {
    /// Returns the settings for robots on the floor, where most motions that are free of collisions are not made.
    pub fn on_floor() -> Settings {
        Settings {
            correspondences_max: 8,
            beam: 4,
            bonds_max: 6,
            closings_max: 18,
            budget: 500_000,
            ..Settings::default()
        }
    }
}

/// A direct way that was found: a motion from either end to one configuration between them.
pub(super) struct Found {
    /// The configuration between in the start's modules, and the steps from the start to it.
    pub(super) there: (Robot, Vec<Step>),
    /// The configuration between in the goal's modules, and the steps from the goal to it.
    pub(super) back: (Robot, Vec<Step>),
    /// The estimated duration of both, s.
    pub(super) duration: f64,
    /// The stance of the goal from which or to which the robot on the floor goes, in the start's modules.
    pub(super) end: Option<Stance>,
}

/// The duration of a smooth turn of a joint by an angle (rad), s.
pub(super) type Pace<'a> = &'a dyn Fn(usize, usize, f64) -> f64;

/// A search for the direct way of one correspondence.
pub(super) struct Search<'a> {
    pub(super) start: &'a Robot,
    pub(super) correspondence: &'a Correspondence,
    /// The stance of the start on the floor; `None` if the robot floats.
    pub(super) stance: Option<&'a Stance>,
    /// The stances in which the goal may rest on the floor, in the start's modules; empty if the robot floats.
    pub(super) ends: &'a [Stance],
    pub(super) pace: Pace<'a>,
    pub(super) settings: &'a Settings,
    pub(super) ik: inverse_kinematics::Settings,
    pub(super) rng: SplitMix64,
    /// The duration (s) that a way has to stay below to be of use.
    pub(super) limit: f64,
    /// The number of forward kinematics so far.
    pub(super) work: u64,
    /// The number of attempts at bonds so far.
    pub(super) tried: u64,
}

/// A configuration that exchanges lead to.
struct Destination {
    /// Its bonds, which are a tree.
    wanted: BTreeSet<[usize; 5]>,
    joints: Joints,
    /// The stances that a robot on the floor may have in it.
    stances: Vec<Stance>,
}

/// A state of the beam, with the duration of the motion to it and an estimate of the rest, s.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) state: State,
    pub(super) time: f64,
    rest: f64,
}

/// Estimated duration of an exchange, s.
const EXCHANGE_TIME: f64 = 2.0;
/// The part of the time of the final motion that counts in estimates: what is turned on the way counts once.
const FINAL_SHARE: f64 = 0.7;
/// The spreads of random starts, as parts of the joints' ranges.
const SPREADS: [f64; 3] = [0.05, 0.2, 0.6];
/// Greatest number of bonds that one closing may replace.
const REPLACED_MAX: usize = 3;
/// Greatest number of closings of one bond that are followed.
const FOLLOWED_MAX: usize = 2;
/// Greatest number of stances of the goal from which the way is met.
const ENDS_MAX: usize = 3;
/// Greatest number of exchanges that are all made from the start.
const ONE_SIDED_MAX: usize = 2;
/// Number of states halfway that are met from the goal.
const HALFWAY_MAX: usize = 2;

impl Search<'_> {
    /// Searches, and returns the shortest way found; `None` if there is none. `progress` may end the search.
    pub(super) fn run(&mut self, progress: &mut dyn Progress) -> Option<Found> {
        let Correspondence { goal, wanted, exchanges, start_loops, goal_loops, .. } = self.correspondence;
        let aim =
            Destination { wanted: wanted.clone(), joints: goal.joints.clone(), stances: self.ends.to_vec() };
        let levels = if *exchanges <= ONE_SIDED_MAX { *exchanges } else { exchanges.div_ceil(2) };
        let first = opened(self.start, start_loops, self.stance);
        let lasts: Vec<Node> = if self.stance.is_some() {
            self.ends.iter().take(ENDS_MAX).map(|end| opened(goal, goal_loops, Some(end))).collect()
        } else {
            vec![opened(goal, goal_loops, None)]
        };
        if !first.state.stands() {
            return None;
        }
        let halfway = self.advance(first, &aim, levels, progress);
        let mut best: Option<Found> = None;
        for there in halfway.into_iter().take(HALFWAY_MAX) {
            let (time, there, back) = if missing(&there.state, &aim.wanted).is_empty() {
                let Some(there) = self.finished(there, &aim) else { continue };
                // Nothing moves from the goal's end, whose stance is that to which it came.
                let last = opened(goal, goal_loops, there.state.stance.as_ref());
                (there.time, there, (last.state.stance.clone(), last))
            } else {
                let wanted = there.state.robot.held().map(|(_, bond)| key(bond)).collect();
                let halfway = Destination {
                    wanted,
                    joints: there.state.robot.joints.clone(),
                    stances: there.state.stance.iter().cloned().collect(),
                };
                let limit = self.limit;
                self.limit = f64::max(0.0, limit - there.time);
                let back = lasts.iter().filter(|last| last.state.stands()).find_map(|last| {
                    let way = self.all_the_way(last.clone(), &halfway, progress)?;
                    Some((last.state.stance.clone(), way))
                });
                self.limit = limit;
                let Some(back) = back else { continue };
                (there.time + back.1.time, there, back)
            };
            if time < self.limit && best.as_ref().is_none_or(|known| time < known.duration) {
                let (end, back) = back;
                let back = self.correspondence.in_goals_modules(back.state.robot, back.state.steps);
                let there = (there.state.robot, there.state.steps);
                best = Some(Found { there, back, duration: time, end });
            }
        }
        best
    }

    /// Makes all exchanges to an aim, and turns the joints to its positions.
    fn all_the_way(&mut self, first: Node, aim: &Destination, progress: &mut dyn Progress) -> Option<Node> {
        let levels = 2 * missing(&first.state, &aim.wanted).len() + 1;
        let mut best: Option<Node> = None;
        for node in self.advance(first, aim, levels, progress) {
            let least = best.as_ref().map_or(self.limit, |best| best.time);
            if missing(&node.state, &aim.wanted).is_empty()
                && node.time < least
                && let Some(end) = self.finished(node, aim)
                && end.time < least
            {
                best = Some(end);
            }
        }
        best
    }

    /// Makes up to `levels` exchanges; returns the states of the beam after the last that could be made.
    fn advance(
        &mut self,
        first: Node,
        aim: &Destination,
        levels: usize,
        progress: &mut dyn Progress,
    ) -> Vec<Node> {
        let mut nodes = vec![first];
        for _ in 0..levels {
            if missing(&nodes[0].state, &aim.wanted).is_empty()
                || self.work > self.settings.budget
                || !progress.should_continue()
            {
                break;
            }
            let mut next = Vec::new();
            for detours in [false, true] {
                if next.is_empty() {
                    next = nodes.iter().flat_map(|node| self.children(node, aim, detours)).collect();
                }
            }
            if next.is_empty() {
                let mut straight = nodes.clone();
                straight.iter_mut().for_each(|node| self.straighten(node));
                next = straight.iter().flat_map(|node| self.children(node, aim, true)).collect();
            }
            let best = self.best(next);
            if best.is_empty() {
                break;
            }
            nodes = best;
        }
        nodes
    }

    /// Returns the states of the beam: those of the least estimated duration, at most two with the same bonds.
    fn best(&self, mut nodes: Vec<Node>) -> Vec<Node> {
        nodes.sort_by(|p, q| (p.time + p.rest).total_cmp(&(q.time + q.rest)));
        let mut same: BTreeMap<Vec<bool>, usize> = BTreeMap::new();
        let mut kept = Vec::new();
        for node in nodes {
            let count = same.entry(node.state.robot.holds.clone()).or_default();
            *count += 1;
            if *count <= 2 && kept.len() < self.settings.beam && node.time < self.limit {
                kept.push(node);
            }
        }
        kept
    }

    /// Returns the states after one exchange.
    fn children(&mut self, node: &Node, aim: &Destination, detours: bool) -> Vec<Node> {
        let at = node.state.robot.bond_at();
        let mut children = Vec::new();
        let is_free = |dock: Dock| at[dock.module][dock.dock].is_none();
        let centre = |dock: Dock| node.state.poses[node.state.tree.index[dock.shoe()]].translation;
        let mut possible: Vec<(f64, [usize; 5])> = Vec::new();
        for wanted in missing(&node.state, &aim.wanted) {
            let bond = bond_of(&wanted);
            if is_free(bond.a) && is_free(bond.b) {
                possible.push(((centre(bond.a) - centre(bond.b)).norm(), wanted));
            }
        }
        possible.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let mut followed = 0;
        for (_, wanted) in possible {
            if followed == self.settings.bonds_max {
                break;
            }
            let (bond, before) = (bond_of(&wanted), children.len());
            let replaceable = replaceable(&node.state, &wanted, &aim.wanted);
            for (time, path) in self.closings(&node.state, &wanted, aim, detours) {
                for &other in replaceable.iter().take(REPLACED_MAX) {
                    let mut state = node.state.clone();
                    if !path.iter().all(|joints| state.try_move_to(joints)) {
                        continue;
                    }
                    state.dock(bond);
                    state.undock(other);
                    state.rebuild_tree();
                    if !state.stands() {
                        continue;
                    }
                    let left = missing(&state, &aim.wanted).len() as f64;
                    let goal = near(&aim.joints, &state.robot.joints);
                    let rest = EXCHANGE_TIME * left + FINAL_SHARE * self.time(&state.robot.joints, &goal);
                    children.push(Node { state, time: node.time + time, rest });
                }
            }
            followed += usize::from(children.len() > before);
        }
        children
    }

    /// Returns free motions that bring the docks of a bond together, the shortest first, each with its duration.
    fn closings(
        &mut self,
        state: &State,
        wanted: &[usize; 5],
        aim: &Destination,
        detours: bool,
    ) -> Vec<(f64, Vec<Joints>)> {
        let scene = state.scene();
        let (here, ik) = (&state.robot.joints, self.ik);
        let whole = Loop::of_bond(&state.tree, &bond_of(wanted));
        // A robot stands the better the less of it moves.
        let sides = if state.stance.is_some() { &MovingSide::ALL[..] } else { &MovingSide::ALL[..1] };
        let mut found: Vec<(f64, Vec<Joints>)> = Vec::new();
        if whole.joints.is_empty() {
            return found;
        }
        let goal = near(&aim.joints, here);
        let mut failed = Vec::new();
        for attempt in 0..self.settings.closings_max {
            let (number, side) = (attempt / sides.len(), sides[attempt % sides.len()]);
            let lp = whole.of_side(side);
            if lp.joints.is_empty() {
                continue;
            }
            if found.len() == FOLLOWED_MAX {
                break;
            }
            crate::interrupt::checkpoint();
            self.tried += 1;
            let start = self.posture(number, here, &goal, &lp);
            let closure = LoopClosure { scene: &scene, lp: &lp, mode: IkMode::Endpoint, settings: &ik };
            let Some(there) =
                closure.solve(&start, &[], &mut self.work).and_then(|mut postures| postures.pop())
            else {
                continue;
            };
            let time = self.time(here, &there);
            if scene.is_free(here, &there, &mut self.work) {
                found.push((time, vec![there]));
            } else if found.is_empty()
                && let Some(path) = self.by_turns(state, &there)
            {
                found.push((self.duration(here, &path), path));
            } else {
                failed.push(there);
            }
        }
        if detours
            && found.is_empty()
            && let Some(there) = failed.into_iter().next()
        {
            let joints: Vec<JointRef> = whole.joints.iter().map(|(joint, _)| *joint).collect();
            found.extend(self.detour(&scene, &joints, here, &there));
        }
        found.sort_by(|p, q| p.0.total_cmp(&q.0));
        found.truncate(FOLLOWED_MAX);
        found
    }

    /// Returns a posture from which inverse kinematics starts: the present one, that of the goal, the middle between,
    /// then random ones near these.
    fn posture(&mut self, number: usize, here: &Joints, goal: &Joints, lp: &Loop) -> Joints {
        let part = [0.0, 1.0, 0.5][number % 3];
        let spread = if number < 3 { 0.0 } else { SPREADS[(number / 3 - 1).min(SPREADS.len() - 1)] };
        let mut start = here.clone();
        for (joint, _) in &lp.joints {
            let (m, k) = (joint.module, joint.joint);
            let range = if k == GAMMA { PI } else { FRAC_PI_2 };
            let noise = if spread > 0.0 { spread * range * self.rng.next_signed() } else { 0.0 };
            start[m][k] = clamped(k, here[m][k] + part * (goal[m][k] - here[m][k]) + noise);
        }
        start
    }

    /// Turns the joints to the goal's positions; `None` if no way there is found.
    fn finished(&mut self, mut node: Node, aim: &Destination) -> Option<Node> {
        let goal = near(&aim.joints, &node.state.robot.joints);
        let path = self.way(&node.state, &goal, &aim.stances)?;
        let mut from = node.state.robot.joints.clone();
        for joints in path {
            node.time += self.time(&from, &joints);
            if !node.state.try_move_to(&joints) {
                return None;
            }
            from = joints;
        }
        node.state.rests_as_any(&aim.stances).then_some(node)
    }
}

/// Returns a configuration with some bonds undocked, as a state from which a search begins; `stance`: that of a robot on
/// the floor.
fn opened(robot: &Robot, loops: &[usize], stance: Option<&Stance>) -> Node {
    let mut state = State::new(robot.clone());
    state.stance = stance.cloned();
    loops.iter().for_each(|&bond| state.undock(bond));
    state.rebuild_tree();
    Node { state, time: 0.0, rest: 0.0 }
}

/// Returns the bonds of an aim that are not docked.
fn missing(state: &State, wanted: &BTreeSet<[usize; 5]>) -> Vec<[usize; 5]> {
    let held: BTreeSet<[usize; 5]> = state.robot.held().map(|(_, bond)| key(bond)).collect();
    wanted.difference(&held).copied().collect()
}

/// Returns the positions of an aim, with twists at the whole turns that are nearest to a posture.
fn near(aim: &Joints, here: &Joints) -> Joints {
    let mut goal = aim.clone();
    for (goal, here) in goal.iter_mut().zip(here) {
        goal[GAMMA] += TAU * libm::round((here[GAMMA] - goal[GAMMA]) / TAU);
    }
    goal
}

/// Returns the bonds that a new one can replace, by index: those of its loop that are not of the goal's tree. Those
/// come first that free a dock which the goal's tree wants.
fn replaceable(state: &State, wanted: &[usize; 5], of_goal: &BTreeSet<[usize; 5]>) -> Vec<usize> {
    let (tree, bond) = (&state.tree, bond_of(wanted));
    let path = tree.path(tree.index[bond.a.shoe()], tree.index[bond.b.shoe()]);
    let bonds = path.indices.windows(2).filter_map(|step| tree.bond(step[0].max(step[1])));
    let mut others: Vec<usize> =
        bonds.filter(|&bond| !of_goal.contains(&key(&state.robot.bonds[bond]))).collect();
    let missing = missing(state, of_goal);
    let docks: BTreeSet<(usize, usize)> =
        missing.iter().flat_map(|key| [(key[0], key[1]), (key[2], key[3])]).collect();
    let freed = |bond: &usize| {
        let bond = state.robot.bonds[*bond];
        [bond.a, bond.b].iter().filter(|dock| docks.contains(&(dock.module, dock.dock))).count()
    };
    others.sort_by_key(|bond| std::cmp::Reverse(freed(bond)));
    others
}
