//! The paper's inverse kinematics: FABRIK (Aristidou and Lasenby 2011) over the chain of two tentacles joined
//! at their tips. For comparison; plans are made with [`inverse_kinematics`](super::inverse_kinematics).
//!
//! The chain begins at the shoulder of the one tentacle and is to end at that of the other. Backward and
//! forward passes take turns: a pass puts one end of the chain where it belongs, and then attaches segment
//! after segment, whose joints turn so that it comes as near as it can to where it was.

use super::robot::{Dock, FACES, GAMMA, RED, across, mate};
use super::segment::Segment;
use super::state::{Joints, State};
use super::tolerances::TOLERANCES;
use crate::geometry::{RigidTransform, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The settings of FABRIK (Aristidou and Lasenby 2011): when [`Chain::solve`] counts a chain as closed, and when it
/// gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The greatest number of iterations, each a backward and a forward pass. Default 1000, as in the program of
    /// [Mrázek et al.](super).
    pub iterations_max: usize,
    /// The deviation of the entries of the last shoe's pose from the goal below which the chain is closed, in pitches
    /// for positions and without unit for the rotation matrix. Default 0.02, as in the program of [Mrázek et
    /// al.](super).
    pub tol_closed: f64,
    /// The number of iterations without a hundredth of progress after which the chain is given up. Default 100; the
    /// program of [Mrázek et al.](super) goes on.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { iterations_max: 1000, tol_closed: 0.02, patience: 100 }
    }
}

/// The chain of two tentacles joined at their tips, which FABRIK closes.
pub struct Chain {
    segments: Vec<Segment>,
    /// Pose of the first shoe.
    base: RigidTransform,
    /// Pose that the last shoe is to have.
    goal: RigidTransform,
    /// Centres of the balls that do not move while the chain does.
    obstacles: Vec<Vec3>,
}

impl Chain {
    /// Returns the chain from the shoulder of dock `a`'s tentacle over both tips, which are to meet with their docks
    /// -Z, to the shoulder of `b`'s. A shoulder is a shoe of the module of the common ancestor of both docks in the
    /// tree, which does not move. `state`: the robot with its tree and poses.
    pub fn new(state: &State, a: Dock, b: Dock) -> Chain {
        let tree = &state.tree;
        let path = tree.path(tree.index[a.shoe()], tree.index[b.shoe()]);
        let shoe = |index: usize| tree.shoe[index];
        let top = shoe(path.indices[path.top]) / 2;
        let fixed = |index: &usize| shoe(*index) / 2 == top;
        let first = path.indices.iter().position(fixed).unwrap_or(path.top);
        let last = path.indices.iter().rposition(fixed).unwrap_or(path.top);
        let backwards = |indices: &[usize]| -> Vec<Segment> {
            let indices: Vec<usize> = indices.iter().rev().copied().collect();
            Segment::along(tree, &state.poses, &indices)
        };
        let mut segments = backwards(&path.indices[..=first]);
        segments.push(Segment::Mate(mate(RED, 0, RED)));
        segments.extend(backwards(&path.indices[last..]));
        let shoulders = [first.checked_sub(1), Some(last + 1).filter(|&next| next < path.indices.len())];
        let is_fixed = |index: &usize| {
            shoulders.iter().flatten().all(|&shoulder| !tree.is_in_subtree(*index, path.indices[shoulder]))
        };
        let obstacles = (0..tree.shoes()).filter(is_fixed);
        Chain {
            segments,
            base: state.poses[path.indices[first]],
            goal: state.poses[path.indices[last]],
            obstacles: obstacles.map(|index| state.poses[index].translation).collect(),
        }
    }

    /// Closes the chain by FABRIK (Aristidou and Lasenby 2011) from given joint positions (rad, by module). Returns
    /// (positions, iterations): the positions of all joints of the robot, rad, by module, or `None` if it does not
    /// converge; and the number of iterations in either case. With `avoid`, tilts keep out of positions in which a
    /// ball would overlap one that does not move, where they can. `work` counts forward kinematics. `settings`: the
    /// settings of FABRIK.
    pub fn solve(
        &self,
        from: &Joints,
        settings: &Settings,
        avoid: bool,
        work: &mut u64,
    ) -> (Option<Joints>, usize) {
        let mut joints = from.clone();
        let mut frames = self.frames(&joints);
        let (mut best, mut since) = (f64::INFINITY, 0);
        for iteration in 0..settings.iterations_max {
            crate::interrupt::checkpoint();
            let residual = self.residual(&frames);
            if residual < settings.tol_closed {
                return (Some(joints), iteration);
            }
            if residual < 0.99 * best {
                (best, since) = (residual, 0);
            } else {
                since += 1;
                if since > settings.patience {
                    return (None, iteration);
                }
            }
            *work += 2;
            self.backward_pass(&mut joints, &mut frames);
            self.forward_pass(&mut joints, &mut frames, avoid);
        }
        (None, settings.iterations_max)
    }

    /// Returns true if the chain, stretched out, is at least as long as the distance of its ends.
    pub fn is_long_enough(&self) -> bool {
        (self.goal.translation - self.base.translation).norm() <= self.segments.len() as f64
    }

    /// Returns the greatest deviation of an entry of the last frame from the goal.
    fn residual(&self, frames: &[RigidTransform]) -> f64 {
        let end = frames[frames.len() - 1];
        let turn = (end.rotation - self.goal.rotation).amax();
        turn.max((end.translation - self.goal.translation).amax())
    }

    /// Returns the poses of all shoes along the chain.
    fn frames(&self, joints: &Joints) -> Vec<RigidTransform> {
        let mut frames = vec![self.base];
        for segment in &self.segments {
            frames.push(frames[frames.len() - 1].then(&segment.pose(joints)));
        }
        frames
    }

    /// Puts the last shoe at the goal and attaches segment after segment, from the end to the base.
    fn backward_pass(&self, joints: &mut Joints, frames: &mut [RigidTransform]) {
        let last = frames.len() - 1;
        frames[last] = self.goal;
        for (index, segment) in self.segments.iter().enumerate().rev() {
            if let Segment::Module { module, near, far } = *segment {
                fit_module(&mut joints[module], [far, near], &frames[index + 1], &frames[index], &[]);
            }
            frames[index] = frames[index + 1].then(&segment.pose(joints).inverse());
        }
    }

    /// Puts the first shoe at the base and attaches segment after segment, from the base to the end.
    fn forward_pass(&self, joints: &mut Joints, frames: &mut [RigidTransform], avoid: bool) {
        frames[0] = self.base;
        let obstacles: &[Vec3] = if avoid { &self.obstacles } else { &[] };
        for (index, segment) in self.segments.iter().enumerate() {
            if let Segment::Module { module, near, far } = *segment {
                fit_module(&mut joints[module], [near, far], &frames[index], &frames[index + 1], obstacles);
            }
            frames[index + 1] = frames[index].then(&segment.pose(joints));
        }
    }
}

/// Points of a shoe by which two poses of it are compared: its centre and its docks, in pitches.
const POINTS: [[f64; 3]; FACES + 1] = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, -0.5]];

/// Rounds in which the joints of a module turn one after the other.
const ROUNDS: usize = 2;

/// Turns a module's joints so that, with one shoe at `here`, its other shoe comes as near as it can to `there`
/// in the least-squares sense (cyclic coordinate descent; each joint in closed form). `near` is the tilt of
/// the shoe at `here`, which also avoids the obstacles.
fn fit_module(
    q: &mut [f64; 3],
    [near, far]: [usize; 2],
    here: &RigidTransform,
    there: &RigidTransform,
    obstacles: &[Vec3],
) {
    // In the frame of the shoe that stays.
    let wanted = here.inverse().then(there);
    let wanted: Vec<Vec3> = POINTS.iter().map(|p| at(&wanted, p)).collect();
    for _ in 0..ROUNDS {
        for joint in [near, GAMMA, far] {
            let other = across(q[near], q[far], q[GAMMA]);
            let (axis, point) = match joint {
                GAMMA => (other.translation, Vec3::zeros()),
                _ if joint == near => (Vec3::x(), Vec3::zeros()),
                _ => (-other.rotation.column(0), other.translation),
            };
            // The angle that minimises the sum of squared distances is that of (along, across).
            let (mut along, mut aside) = (0.0, 0.0);
            for (p, want) in POINTS.iter().zip(&wanted) {
                let (found, want) = (at(&other, p) - point, want - point);
                along += (found - axis * axis.dot(&found)).dot(&want);
                aside += axis.cross(&found).dot(&want);
            }
            if libm::hypot(along, aside) > TOLERANCES.indifferent {
                let to = q[joint] + libm::atan2(aside, along);
                q[joint] = if joint == GAMMA { wrapped(to) } else { to.clamp(-FRAC_PI_2, FRAC_PI_2) };
            }
        }
        if !obstacles.is_empty() {
            q[near] = nearest_free_tilt(q[near], here, obstacles);
        }
    }
}

/// Returns a point given in the frame of a pose.
fn at(pose: &RigidTransform, point: &[f64; 3]) -> Vec3 {
    pose.rotation * Vec3::from(*point) + pose.translation
}

/// Returns an angle plus whole turns, in [-π, π).
fn wrapped(angle: f64) -> f64 {
    angle - TAU * libm::floor((angle + PI) / TAU)
}

/// Returns the tilt (rad) nearest to a wanted one at which the ball that it carries, on a circle of radius 1
/// about the shoe at `here`, overlaps no obstacle; the wanted one if there is none.
fn nearest_free_tilt(wanted: f64, here: &RigidTransform, obstacles: &[Vec3]) -> f64 {
    // The intervals of tilts that each obstacle forbids.
    let mut forbidden: Vec<(f64, f64)> = Vec::new();
    for ball in obstacles {
        let p = here
            .inverse()
            .then(&RigidTransform { translation: *ball, ..RigidTransform::identity() })
            .translation;
        let radius = libm::hypot(p.y, p.z);
        // The shoe itself, and balls on the axis: their distance does not depend on the tilt.
        if p.norm() < TOLERANCES.coincident || radius < TOLERANCES.on_axis {
            continue;
        }
        // distance² = p² + 1 - 2 · radius · cos(angle between)
        let cosine = (p.norm_squared() + 1.0 - TOUCHING * TOUCHING) / (2.0 * radius);
        if cosine < 1.0 {
            // At the tilt 0 the ball is at +z, at a tilt of 90 degrees at -y.
            let middle = libm::atan2(-p.y, p.z);
            let half = libm::acos(cosine.max(-1.0));
            forbidden.push((middle - half, middle + half));
        }
    }
    let free = |tilt: f64| {
        tilt.abs() <= FRAC_PI_2
            && forbidden.iter().all(|(low, high)| {
                let off = wrapped(tilt - 0.5 * (low + high)).abs();
                off >= 0.5 * (high - low) - TOLERANCES.interval
            })
    };
    if free(wanted) {
        return wanted;
    }
    // The nearest end of an interval that no other forbids.
    let ends = forbidden.iter().flat_map(|(low, high)| [wrapped(*low), wrapped(*high)]);
    let near = ends.filter(|end| free(*end)).min_by(|a, b| (a - wanted).abs().total_cmp(&(b - wanted).abs()));
    near.unwrap_or(wanted)
}

/// The distance of centres, in pitches, below which balls overlap for the program of [Mrázek et al.](super), which
/// rounds squared distances to three decimals.
pub const TOUCHING: f64 = 0.99975;
