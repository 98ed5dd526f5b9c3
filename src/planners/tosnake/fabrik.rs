//! The paper's inverse kinematics: FABRIK (Aristidou and Lasenby 2011) over the chain of two tentacles
//! joined at their tips. For comparison; [`closing`](super::closing) is what plans are made with.
//!
//! The chain begins where the one tentacle is mounted, and is to end where the other one is. It is walked
//! from either end in turns. On every walk the end is put where it belongs, and then piece after piece is
//! joined on anew: its joints turn so that it comes as near as it can to where it was.

use super::piece::Piece;
use super::robot::{Dock, FACES, GAMMA, RED, across, mate};
use super::state::{Joints, State};
use crate::geometry::{RigidTransform, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Walks there and back.
    pub iterations_max: usize,
    /// No entry of the matrices is farther off in the end; the paper's program has 0.02.
    pub tol: f64,
    /// After so many walks without a hundredth of progress it is given up; the paper's program goes on.
    pub patience: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { iterations_max: 1000, tol: 0.02, patience: 100 }
    }
}

/// The chain of two tentacles.
pub struct Chain {
    pieces: Vec<Piece>,
    /// Where it begins and where it is to end.
    base: RigidTransform,
    goal: RigidTransform,
    /// Balls of what does not move while the chain does.
    standing: Vec<Vec3>,
}

impl Chain {
    /// From the shoulder of dock `a`'s tentacle over both tips to that of `b`'s. Both hang on the same
    /// module, which does not move.
    pub fn new(state: &State, a: Dock, b: Dock) -> Chain {
        let tree = &state.tree;
        let path = tree.path(tree.place[a.shoe()], tree.place[b.shoe()]);
        let shoe = |place: usize| tree.shoe[place];
        let top = shoe(path.places[path.top]) / 2;
        let fixed = |place: &usize| shoe(*place) / 2 == top;
        let first = path.places.iter().position(fixed).unwrap_or(path.top);
        let last = path.places.iter().rposition(fixed).unwrap_or(path.top);
        let backwards = |places: &[usize]| -> Vec<Piece> {
            let places: Vec<usize> = places.iter().rev().copied().collect();
            Piece::along(tree, &state.poses, &places)
        };
        let mut pieces = backwards(&path.places[..=first]);
        pieces.push(Piece::Mate(mate(RED, 0, RED)));
        pieces.extend(backwards(&path.places[last..]));
        let shoulders = [first.checked_sub(1), Some(last + 1).filter(|&next| next < path.places.len())];
        let stands = |place: &usize| {
            shoulders.iter().flatten().all(|&shoulder| !tree.hangs_on(*place, path.places[shoulder]))
        };
        let standing = (0..tree.shoes()).filter(stands);
        Chain {
            pieces,
            base: state.poses[path.places[first]],
            goal: state.poses[path.places[last]],
            standing: standing.map(|place| state.poses[place].translation).collect(),
        }
    }

    /// Positions of all joints with the chain closed, and the walks that took; `None` where it does not
    /// close. With `avoid`, tilts keep out of positions in which a ball would be in one that stands.
    pub fn close(
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
            let missing = self.missing(&frames);
            if missing < settings.tol {
                return (Some(joints), iteration);
            }
            if missing < 0.99 * best {
                (best, since) = (missing, 0);
            } else {
                since += 1;
                if since > settings.patience {
                    return (None, iteration);
                }
            }
            *work += 2;
            self.walk_back(&mut joints, &mut frames);
            self.walk_there(&mut joints, &mut frames, avoid);
        }
        (None, settings.iterations_max)
    }

    /// Whether the chain can be as long as the way that it has to go.
    pub fn reaches(&self) -> bool {
        (self.goal.translation - self.base.translation).norm() <= self.pieces.len() as f64
    }

    fn missing(&self, frames: &[RigidTransform]) -> f64 {
        let end = frames[frames.len() - 1];
        let turn = (end.rotation - self.goal.rotation).amax();
        turn.max((end.translation - self.goal.translation).amax())
    }

    /// Of all shoes along the chain.
    fn frames(&self, joints: &Joints) -> Vec<RigidTransform> {
        let mut frames = vec![self.base];
        for piece in &self.pieces {
            frames.push(frames[frames.len() - 1].then(&piece.pose(joints)));
        }
        frames
    }

    fn walk_back(&self, joints: &mut Joints, frames: &mut [RigidTransform]) {
        let last = frames.len() - 1;
        frames[last] = self.goal;
        for (index, piece) in self.pieces.iter().enumerate().rev() {
            if let Piece::Module { module, near, far } = *piece {
                relink(&mut joints[module], [far, near], &frames[index + 1], &frames[index], &[]);
            }
            frames[index] = frames[index + 1].then(&piece.pose(joints).inverse());
        }
    }

    fn walk_there(&self, joints: &mut Joints, frames: &mut [RigidTransform], avoid: bool) {
        frames[0] = self.base;
        let standing: &[Vec3] = if avoid { &self.standing } else { &[] };
        for (index, piece) in self.pieces.iter().enumerate() {
            if let Piece::Module { module, near, far } = *piece {
                relink(&mut joints[module], [near, far], &frames[index], &frames[index + 1], standing);
            }
            frames[index + 1] = frames[index].then(&piece.pose(joints));
        }
    }
}

/// Points of a shoe by which two placements of it are compared: its ball and its docks.
const POINTS: [[f64; 3]; FACES + 1] = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, -0.5]];

/// Rounds in which the joints of a module turn one after the other.
const ROUNDS: usize = 2;

/// Turns a module's joints, seen from the shoe at `here`, so that its other shoe comes as near to `there`
/// as it can. `order` are its tilts, that of `here` first; balls of `standing` are kept out of.
fn relink(
    q: &mut [f64; 3],
    [near, far]: [usize; 2],
    here: &RigidTransform,
    there: &RigidTransform,
    standing: &[Vec3],
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
            let (mut along, mut aside) = (0.0, 0.0);
            for (p, want) in POINTS.iter().zip(&wanted) {
                let (found, want) = (at(&other, p) - point, want - point);
                along += (found - axis * axis.dot(&found)).dot(&want);
                aside += axis.cross(&found).dot(&want);
            }
            // Where nothing depends on the joint it stays.
            if libm::hypot(along, aside) > INDIFFERENT {
                let to = q[joint] + libm::atan2(aside, along);
                q[joint] = if joint == GAMMA { wrapped(to) } else { to.clamp(-FRAC_PI_2, FRAC_PI_2) };
            }
        }
        if !standing.is_empty() {
            q[near] = evaded(q[near], here, standing);
        }
    }
}

/// Sums of products of lengths, in parts of the squared pitch.
const INDIFFERENT: f64 = 1e-12;

fn at(pose: &RigidTransform, point: &[f64; 3]) -> Vec3 {
    pose.rotation * Vec3::from(*point) + pose.translation
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * libm::floor((angle + PI) / TAU)
}

/// The tilt nearest to a wanted one at which the ball that it carries, on a circle of radius 1 about the
/// shoe at `here`, is in none that stands; the wanted one where there is none.
fn evaded(wanted: f64, here: &RigidTransform, standing: &[Vec3]) -> f64 {
    let mut forbidden: Vec<(f64, f64)> = Vec::new();
    for ball in standing {
        let p = here
            .inverse()
            .then(&RigidTransform { translation: *ball, ..RigidTransform::identity() })
            .translation;
        let radius = libm::hypot(p.y, p.z);
        // The shoe itself is as near as it is.
        if p.norm() < 1e-6 || radius < 1e-9 {
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
                off >= 0.5 * (high - low) - 1e-9
            })
    };
    if free(wanted) {
        return wanted;
    }
    let ends = forbidden.iter().flat_map(|(low, high)| [wrapped(*low), wrapped(*high)]);
    let near = ends.filter(|end| free(*end)).min_by(|a, b| (a - wanted).abs().total_cmp(&(b - wanted).abs()));
    near.unwrap_or(wanted)
}

/// Balls nearer than this are in each other; rounded as the paper's program does.
pub const TOUCHING: f64 = 0.99975;
