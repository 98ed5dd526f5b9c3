//! Inverse kinematics that closes a loop: the joints on the way between two red docks bend until the
//! docks meet, while balls that come near each other are driven apart.
//!
//! Damped least squares for the six conditions of the meeting, under the condition that balls in
//! contact do not come nearer; joints off the loop make room. Every state on the way is kept: it is
//! the way to take where the straight one is not free.

use super::contacts::{Contact, Contacts};
use super::linear::Square;
use super::robot::{Dock, GAMMA, RED, mate};
use super::state::Joints;
use super::sweep::{APART, Scene};
use super::tree::{JointRef, Tree};
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{RigidTransform, Vec3};
use nalgebra::Vector6;
use std::f64::consts::FRAC_PI_2;

/// How a loop is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// Only the loop's joints move; balls are driven apart gently, and may pass through each other on
    /// the way: only the last state counts.
    Leap,
    /// All joints make room, and balls in contact do not come nearer: the way itself is free.
    Flow,
}

#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub iterations_max: usize,
    /// No joint turns farther in one iteration, rad.
    pub turn_max: f64,
    /// No ball goes farther in one iteration.
    pub step_max: f64,
    /// The loop is closed within this (pitches, rad): far below what docking needs, well above rounding.
    pub tol_closed: f64,
    /// Balls are kept this far apart where they can be.
    pub keep: f64,
    /// Balls nearer than this are driven apart, gently, by so much of what is missing.
    pub repulsion_reach: f64,
    pub repulsion_leap: f64,
    pub repulsion_flow: f64,
    /// Nearer to closed than this (pitches, rad), balls that do not overlap are left where they are.
    pub nearly_closed: f64,
    /// By so much more, for every module of the loop, may a step and the number of steps be.
    pub long: f64,
    /// The drift of the joints lasts so many iterations.
    pub drifting: usize,
    /// After so many iterations without a tenth of progress it is given up.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            iterations_max: 200,
            turn_max: 0.2,
            step_max: 0.3,
            tol_closed: 1e-11,
            keep: 1.002,
            repulsion_reach: 1.2,
            repulsion_leap: 0.3,
            repulsion_flow: 0.05,
            nearly_closed: 1e-2,
            long: 0.1,
            drifting: 12,
            patience: 25,
        }
    }
}

/// The loop that is to be closed, as seen from its first dock.
pub struct Loop {
    pub from: usize,
    pub to: usize,
    /// With the sign with which a turn carries the second dock.
    pub joints: Vec<(JointRef, f64)>,
}

impl Loop {
    pub fn new(tree: &Tree, a: Dock, b: Dock) -> Loop {
        let (from, to) = (tree.place[a.shoe()], tree.place[b.shoe()]);
        Loop { from, to, joints: joints_between(tree, from, to) }
    }

    /// What is missing: translation, then rotation vector, of the second shoe.
    fn error(&self, poses: &[RigidTransform]) -> Vector6<f64> {
        let wanted = poses[self.from].then(&mate(RED, 0, RED));
        let found = &poses[self.to];
        let place = wanted.translation - found.translation;
        let turn = rotation_vector(&(wanted.rotation * found.rotation.transpose()));
        Vector6::new(place.x, place.y, place.z, turn.x, turn.y, turn.z)
    }
}

/// The joints on the way from one place to another, with the sign with which a turn carries the other.
fn joints_between(tree: &Tree, from: usize, to: usize) -> Vec<(JointRef, f64)> {
    let mut joints = Vec::new();
    for step in tree.path(from, to).places.windows(2) {
        let (child, sign) = if step[1] > step[0] { (step[1], 1.0) } else { (step[0], -1.0) };
        joints.extend(tree.joints_at(child).map(|joint| (joint, sign)));
    }
    joints
}

/// A loop that is to be closed, and how.
pub struct Closing<'a> {
    pub scene: &'a Scene<'a>,
    pub lp: &'a Loop,
    pub manner: Manner,
    pub settings: &'a Settings,
}

impl Closing<'_> {
    /// Closes the loop from given positions of the joints. Gives all states on the way, the last of them
    /// closed and without overlap. `drift` is by how much joints drift in each of the first steps; it may
    /// be empty.
    pub fn close(&self, start: &[[f64; 3]], drift: &[f64], work: &mut u64) -> Option<Vec<Joints>> {
        let Closing { scene, lp, manner, settings } = *self;
        let tree = scene.tree;
        let mut way = vec![start.to_vec()];
        let mut joints = start.to_vec();
        let mut poses = Vec::new();
        tree.poses(&joints, &mut poses);
        let bends = |module| lp.joints.iter().any(|(joint, _)| joint.module == module);
        let turns = |module: usize| manner == Manner::Flow || bends(module);
        let carried = tree.carried(turns);
        // Long loops have a long way to go.
        let long = 1.0 + lp.joints.len() as f64 / 3.0 * settings.long;
        let drifting = if drift.is_empty() { 0 } else { settings.drifting };
        // What matters in a leap is what overlaps and what is driven apart; in a flow all that may meet
        // within one step.
        let reach = match manner {
            Manner::Leap => settings.repulsion_reach.max(APART),
            Manner::Flow => 1.0 + 2.0 * settings.step_max * long,
        };
        let mut near = Contacts::new(scene, (lp.from, lp.to), tree.parts(turns));
        let (mut best, mut since) = (f64::INFINITY, 0);
        for iteration in 0..(settings.iterations_max as f64 * long) as usize {
            crate::interrupt::checkpoint();
            tree.poses_of(&carried, &joints, &mut poses);
            *work += STEP_WORK;
            let error = lp.error(&poses);
            let size = error.norm();
            let contacts = near.within(reach, &poses);
            let least = contacts.iter().fold(f64::INFINITY, |least, c| least.min(c.distance));
            let overlap = (APART - least).max(0.0);
            if size < settings.tol_closed && overlap == 0.0 {
                return Some(way);
            }
            let missing = size + OVERLAP_WEIGHT * overlap;
            if missing < 0.9 * best {
                (best, since) = (missing, 0);
            } else {
                since += 1;
                if since > settings.patience + drifting {
                    return None;
                }
            }
            let gentle = match manner {
                _ if size < settings.nearly_closed && overlap == 0.0 => 0.0,
                Manner::Leap => settings.repulsion_leap,
                Manner::Flow => settings.repulsion_flow,
            };
            let drift = if iteration < drifting { drift } else { &[] };
            let problem = Problem {
                manner,
                long,
                tree,
                poses: &poses,
                joints: &joints,
                contacts: &contacts,
                settings,
                gentle,
                drift,
            };
            let change = problem.change(lp, &error);
            for joint in tree.all_joints() {
                let q = &mut joints[joint.module][joint.joint];
                *q = limited(joint.joint, *q + change[3 * joint.module + joint.joint]);
            }
            way.push(joints.clone());
        }
        None
    }
}

/// A step of the descent takes about as long as working out so many poses.
const STEP_WORK: u64 = 10;

/// By how much an overlap counts more than a gap.
const OVERLAP_WEIGHT: f64 = 10.0;

pub fn limited(joint: usize, q: f64) -> f64 {
    if joint == GAMMA { q } else { q.clamp(-FRAC_PI_2, FRAC_PI_2) }
}

/// One step of the descent: which change of the joints.
struct Problem<'a> {
    manner: Manner,
    long: f64,
    tree: &'a Tree,
    poses: &'a [RigidTransform],
    joints: &'a [[f64; 3]],
    contacts: &'a [Contact],
    settings: &'a Settings,
    gentle: f64,
    drift: &'a [f64],
}

/// A linear condition on the changes of joints: `Σ factor · change = goal`, or at least that.
struct Row {
    terms: Vec<(usize, f64)>,
    goal: f64,
}

/// Conditions that are taken in at most, and rounds of taking in and dropping.
const ACTIVE_MAX: usize = 100;
const ROUNDS: usize = 12;
/// What may be missing of a condition.
const SLACK: f64 = 1e-3;

impl Problem<'_> {
    fn change(&self, lp: &Loop, error: &Vector6<f64>) -> Vec<f64> {
        let count = 3 * self.joints.len();
        let mut rows = self.closing_rows(lp, error);
        let wish = self.wish(lp, count);
        let candidates = match self.manner {
            Manner::Leap => &[],
            Manner::Flow => self.contacts,
        };
        let damping = 1e-4 * error.norm_squared().min(1.0) + 1e-12;
        let mut fixed = vec![false; count];
        let mut active: Vec<usize> = Vec::new();
        let mut change = vec![0.0; count];
        for round in 0..ROUNDS {
            rows.truncate(6);
            rows.extend(active.iter().map(|&c| self.row(&candidates[c])));
            let (solved, multipliers) = solve(&rows, &wish, &fixed, damping);
            change = solved;
            self.shorten(&mut change);
            if round + 1 == ROUNDS {
                break;
            }
            // Conditions that hold the balls together are dropped.
            let mut kept = Vec::new();
            for (i, &c) in active.iter().enumerate() {
                if multipliers[6 + i] >= 0.0 {
                    kept.push(c);
                }
            }
            let mut changed = kept.len() != active.len();
            active = kept;
            let going = if candidates.is_empty() { Vec::new() } else { self.going(&change) };
            let far = going.iter().map(|v: &Vec3| v.norm()).fold(0.0, f64::max);
            let mut violated: Vec<(f64, usize)> = candidates
                .iter()
                .enumerate()
                .filter(|(c, contact)| {
                    contact.distance < self.settings.keep + 2.0 * far && !active.contains(c)
                })
                .map(|(c, contact)| {
                    let parting = contact.normal.dot(&(going[contact.b] - going[contact.a]));
                    (parting - self.least_parting(contact), c)
                })
                .filter(|(slack, _)| *slack < -SLACK)
                .collect();
            violated.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            for (_, c) in violated.into_iter().take(ACTIVE_MAX.saturating_sub(active.len())) {
                active.push(c);
                changed = true;
            }
            for (index, fixed) in fixed.iter_mut().enumerate() {
                let (module, joint) = (index / 3, index % 3);
                let q = self.joints[module][joint] + change[index];
                if !*fixed && limited(joint, q) != q {
                    *fixed = true;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        change
    }

    /// The six conditions of the meeting, no more of them than a step can make good.
    fn closing_rows(&self, lp: &Loop, error: &Vector6<f64>) -> Vec<Row> {
        let (place, turn) = (error.fixed_rows::<3>(0).norm(), error.fixed_rows::<3>(3).norm());
        let scale = f64::min(1.0, f64::min(self.long / place.max(1e-30), 0.4 / turn.max(1e-30)));
        let tip = self.poses[lp.to].translation;
        let mut rows: Vec<Row> = (0..6)
            .map(|i| Row { terms: Vec::with_capacity(lp.joints.len()), goal: error[i] * scale })
            .collect();
        for (joint, sign) in &lp.joints {
            let (axis, point) = self.tree.axis(*joint, self.poses);
            let v = axis.cross(&(tip - point)) * *sign;
            let index = 3 * joint.module + joint.joint;
            for i in 0..3 {
                rows[i].terms.push((index, v[i]));
                rows[3 + i].terms.push((index, axis[i] * *sign));
            }
        }
        rows
    }

    /// How a contact's distance changes with the joints, and how much it must.
    fn row(&self, contact: &Contact) -> Row {
        let at = self.poses[contact.b].translation;
        let between = joints_between(self.tree, contact.a, contact.b);
        let term = |(joint, sign): &(JointRef, f64)| {
            let (axis, point) = self.tree.axis(*joint, self.poses);
            // A turn about the joint carries b, or the other way round a: the distance is the same.
            let v = axis.cross(&(at - point)) * *sign;
            (3 * joint.module + joint.joint, contact.normal.dot(&v))
        };
        Row { terms: between.iter().map(term).collect(), goal: self.least_parting(contact) }
    }

    /// By how much two balls must part in one step at least; less than nothing where they may draw nearer.
    fn least_parting(&self, contact: &Contact) -> f64 {
        let missing = self.settings.keep - contact.distance;
        if missing > 0.0 { (0.5 * missing).min(0.05) } else { missing }
    }

    /// Gently apart.
    fn wish(&self, lp: &Loop, count: usize) -> Vec<f64> {
        let mut wish = if self.drift.is_empty() { vec![0.0; count] } else { self.drift.to_vec() };
        if self.gentle == 0.0 {
            return wish;
        }
        let push = Push::new(self.poses, self.contacts, self.settings.repulsion_reach);
        let joints = match self.manner {
            Manner::Leap => lp.joints.iter().map(|(joint, _)| *joint).collect(),
            Manner::Flow => self.tree.all_joints(),
        };
        for joint in joints {
            let (axis, point) = self.tree.axis(joint, self.poses);
            let torque = push.torque(self.tree, joint.place, &axis, &point);
            wish[3 * joint.module + joint.joint] += self.gentle * torque;
        }
        wish
    }

    /// No joint turns too far, and no ball goes too far.
    fn shorten(&self, change: &mut [f64]) {
        let greatest = change.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let mut scale = f64::min(1.0, self.settings.turn_max / greatest.max(1e-30));
        if self.manner == Manner::Flow {
            let far = self.farthest(change);
            scale = scale.min(self.settings.step_max * self.long / far.max(1e-30));
        }
        change.iter_mut().for_each(|c| *c *= scale);
    }

    /// How far the ball goes that goes farthest, to first order.
    fn farthest(&self, change: &[f64]) -> f64 {
        libm::sqrt(self.going(change).iter().map(Vec3::norm_squared).fold(0.0, f64::max))
    }

    /// By place: which way its ball goes, and how far, to first order.
    fn going(&self, change: &[f64]) -> Vec<Vec3> {
        let mut twist = vec![(Vec3::zeros(), Vec3::zeros()); self.poses.len()];
        let mut going = vec![Vec3::zeros(); self.poses.len()];
        for place in 1..self.poses.len() {
            let (mut v, mut w) = twist[self.tree.parent[place]];
            for joint in self.tree.joints_at(place) {
                let turn = change[3 * joint.module + joint.joint];
                if turn != 0.0 {
                    let (axis, point) = self.tree.axis(joint, self.poses);
                    v -= axis.cross(&point) * turn;
                    w += axis * turn;
                }
            }
            twist[place] = (v, w);
            going[place] = v + w.cross(&self.poses[place].translation);
        }
        going
    }
}

/// The change nearest to the wish that meets the conditions, the first six of them softly; with the
/// multipliers of the conditions.
fn solve(rows: &[Row], wish: &[f64], fixed: &[bool], damping: f64) -> (Vec<f64>, Vec<f64>) {
    let count = wish.len();
    let mut dense = vec![0.0; rows.len() * count];
    for (row, out) in rows.iter().zip(dense.chunks_mut(count)) {
        for &(joint, factor) in row.terms.iter().filter(|(joint, _)| !fixed[*joint]) {
            out[joint] += factor;
        }
    }
    let mut square = Square::zeros(rows.len());
    let mut right = vec![0.0; rows.len()];
    for i in 0..rows.len() {
        for &(joint, _) in &rows[i].terms {
            let factor = dense[i * count + joint];
            if factor == 0.0 {
                continue;
            }
            for j in 0..=i {
                square.add(i, j, factor * dense[j * count + joint]);
            }
        }
        right[i] = rows[i].goal
            - rows[i].terms.iter().map(|&(joint, _)| dense[i * count + joint] * wish[joint]).sum::<f64>();
    }
    let trace = square.trace().max(1e-9);
    for i in 0..rows.len() {
        square.add(i, i, if i < 6 { damping + 1e-10 * trace } else { 1e-6 });
    }
    square.solve(&mut right);
    let mut change: Vec<f64> =
        wish.iter().zip(fixed).map(|(w, fixed)| if *fixed { 0.0 } else { *w }).collect();
    for (i, row) in rows.iter().enumerate() {
        for &(joint, _) in &row.terms {
            change[joint] += dense[i * count + joint] * right[i];
        }
    }
    (change, right)
}

/// What drives the balls apart: sums of forces and of their moments over the places before each.
struct Push {
    force: Vec<Vec3>,
    moment: Vec<Vec3>,
}

impl Push {
    fn new(poses: &[RigidTransform], contacts: &[Contact], reach: f64) -> Push {
        let mut force = vec![Vec3::zeros(); poses.len()];
        for contact in contacts.iter().filter(|c| c.distance < reach) {
            let push = contact.normal * (reach - contact.distance);
            force[contact.b] += push;
            force[contact.a] -= push;
        }
        let (mut f, mut m) = (Vec3::zeros(), Vec3::zeros());
        let (mut forces, mut moments) = (vec![f], vec![m]);
        for (force, pose) in force.iter().zip(poses) {
            f += force;
            m += pose.translation.cross(force);
            forces.push(f);
            moments.push(m);
        }
        Push { force: forces, moment: moments }
    }

    /// Of all that hangs on a place, about an axis.
    fn torque(&self, tree: &Tree, place: usize, axis: &Vec3, point: &Vec3) -> f64 {
        let end = tree.end[place];
        let force = self.force[end] - self.force[place];
        let moment = self.moment[end] - self.moment[place];
        axis.dot(&(moment - point.cross(&force)))
    }
}
