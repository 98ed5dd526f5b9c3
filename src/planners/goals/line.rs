//! Straight lines and arcs of a frame in space, as piecewise cubic motions of joints.
//!
//! The frame goes along the line with the quintic law of time, and turns at the same rate about one axis. Postures at even
//! times follow each other by damped least squares, each from the one before; between them joints follow the cubics with
//! their positions and slopes. Deviations from the line are measured between the postures, and the number of postures is doubled
//! until they are within what is allowed.

use super::reach::{apart, quoted};
use crate::geometry::{Pose, Vec3};
use crate::planners::Progress;
use crate::robot::chain::{Chain, DescentSettings, Orientation, PoseError, Target};
use nalgebra::UnitQuaternion;
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt;

/// The form of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// The straight line.
    Line,
    /// The arc of a circle through this point, m.
    Arc(Vec3),
}

/// A way of a frame from where it is.
pub struct Problem<'a> {
    /// The chain from the link that stays where it is to the frame.
    pub chain: &'a Chain,
    /// The pose at the end, in the frame of that link.
    pub goal: Pose,
    /// The form of the way, in the frame of that link.
    pub form: Form,
    /// The positions of all joints in which the motion begins, rad or m.
    pub joints: &'a [f64],
    /// The names of all joints, for refusals.
    pub names: &'a [String],
    /// True if the orientation is free, so that only the position of the frame follows the way.
    pub free: bool,
    /// The greatest deviation from the way.
    pub within: PoseError,
}

/// The settings of [`plan`](plan()).
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The number of pieces at first. Default 16.
    pub pieces: usize,
    /// The greatest number of pieces. Default 1024.
    pub pieces_max: usize,
    /// The limits of each descent.
    pub descent: DescentSettings,
    /// The greatest change of a joint from one posture to the next, rad or m: more is a leap to another solution. Default
    /// 0.5.
    pub change_max: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { pieces: 16, pieces_max: 1024, descent: DescentSettings::default(), change_max: 0.5 }
    }
}

/// The motion along a way, over a unit of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// For each joint of the chain, in its order, the positions (rad or m) and their slopes over the unit of time, at even
    /// times from 0 to 1.
    pub joints: Vec<Vec<[f64; 2]>>,
    /// The greatest deviation that was measured.
    pub deviation: PoseError,
}

/// The reason why there is no motion along the way.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// A place on the way can't be reached from the one before.
    Unreachable {
        /// The part of the way, 0 to 1.
        part: f64,
        /// The error of the nearest posture.
        error: PoseError,
        /// The joints that are at an end of their range in it, by name.
        at_limit: Vec<String>,
    },
    /// The joints would have to leap: the way passes a posture in which directions of the frame are lost.
    Singular {
        /// The part of the way, 0 to 1.
        part: f64,
        /// The joint that would have to move most.
        joint: String,
    },
    /// The motion deviates more than allowed with as many pieces as may be.
    Deviates {
        /// The greatest deviation.
        found: PoseError,
        /// The number of pieces.
        pieces: usize,
    },
    /// The three points of an arc are in one line, or two are the same.
    NoArc,
    /// The chain has no joints that take commands.
    NoJoints,
    /// The observer ended the search.
    Stopped,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Unreachable { part, error, at_limit } => {
                write!(
                    f,
                    "{:.0} % of the way are within reach: beyond, it is {}",
                    100.0 * part,
                    apart(error)
                )?;
                match at_limit.as_slice() {
                    [] => Ok(()),
                    joints => write!(f, ", with {} at the end of the range", quoted(joints)),
                }
            }
            Refusal::Singular { part, joint } => write!(
                f,
                "at {:.0} % of the way `{joint}` would have to leap: the robot passes a singular posture there",
                100.0 * part
            ),
            Refusal::Deviates { found, pieces } => {
                write!(f, "with {pieces} pieces the motion is still up to {}", apart(found))
            }
            Refusal::NoArc => write!(f, "no arc goes through three points in one line"),
            Refusal::NoJoints => write!(f, "no joint that takes commands is on the way"),
            Refusal::Stopped => write!(f, "the search was stopped"),
        }
    }
}

impl Error for Refusal {}

/// Returns the part of a way at a part of the time by the quintic law, at rest at both ends.
fn quintic(t: f64) -> f64 {
    t * t * t * (10.0 - t * (15.0 - 6.0 * t))
}

/// The way that the frame is to go.
struct Way {
    start: Pose,
    goal: Pose,
    arc: Option<Arc>,
}

/// An arc: its centre, the vector from there to its beginning, and one across it in its plane.
struct Arc {
    centre: Vec3,
    out: Vec3,
    across: Vec3,
    angle: f64,
}

impl Arc {
    /// Returns the arc from one point through another to a third; `None` if they are in one line.
    fn through(a: &Vec3, b: &Vec3, c: &Vec3) -> Option<Arc> {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(&v);
        let size = normal.norm_squared();
        if size <= f64::EPSILON * u.norm_squared() * v.norm_squared() {
            return None;
        }
        let to_centre =
            (v.cross(&normal) * u.norm_squared() + normal.cross(&u) * v.norm_squared()) / (2.0 * size);
        let centre = a + to_centre;
        let out = a - centre;
        let across = normal.normalize().cross(&out);
        let angle = |p: &Vec3| {
            let d = p - centre;
            let found = libm::atan2(d.dot(&across), d.dot(&out));
            if found < 0.0 { found + TAU } else { found }
        };
        // Seen along this normal the second point comes before the third.
        Some(Arc { centre, out, across, angle: angle(c) })
    }
}

impl Way {
    /// Returns the pose at a part of the way, 0 to 1.
    fn at(&self, part: f64) -> Pose {
        let (from, to) = (&self.start, &self.goal);
        let p = match &self.arc {
            None => from.translation.vector.lerp(&to.translation.vector, part),
            Some(arc) => {
                let (s, c) = crate::geometry::sin_cos(part * arc.angle);
                arc.centre + arc.out * c + arc.across * s
            }
        };
        Pose::from_parts(p.into(), turned(&from.rotation, &to.rotation, part))
    }

    /// Returns the deviation of a pose: the distance from the way and the angle from the orientation at `part`.
    fn deviation(&self, pose: &Pose, part: f64) -> PoseError {
        let p = pose.translation.vector;
        let distance = match &self.arc {
            None => {
                let (a, b) = (self.start.translation.vector, self.goal.translation.vector);
                let along = (p - a).dot(&(b - a)) / (b - a).norm_squared().max(f64::MIN_POSITIVE);
                (p - a - (b - a) * along.clamp(0.0, 1.0)).norm()
            }
            Some(arc) => {
                let normal = arc.out.cross(&arc.across).normalize();
                let d = p - arc.centre;
                let height = d.dot(&normal);
                libm::hypot(height, (d - normal * height).norm() - arc.out.norm())
            }
        };
        let wanted = self.at(part);
        let target =
            Target { position: wanted.translation.vector, orientation: Orientation::Full(wanted.rotation) };
        PoseError { distance, angle: Chain::error(pose, &target).0.angle }
    }
}

/// Returns the orientation at a part of the turn about one axis from one to another.
fn turned(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>, part: f64) -> UnitQuaternion<f64> {
    let whole =
        crate::geometry::RigidTransform::from(&Pose::from_parts(Vec3::zeros().into(), to * from.inverse()));
    let turn = crate::geometry::rigid_transform::rotation_vector(&whole.rotation) * part;
    let angle = turn.norm();
    if angle == 0.0 {
        return *from;
    }
    crate::geometry::pose::turned(turn / angle, angle).rotation * from
}

/// Returns the motion of the chain's joints along the way, over a unit of time.
///
/// # Errors
/// A [`Refusal`] where a place on the way is out of reach, joints would have to leap, or the motion deviates too much.
pub fn plan(problem: &Problem, settings: &Settings, progress: &mut dyn Progress) -> Result<Path, Refusal> {
    let chain = problem.chain;
    if chain.joints().is_empty() {
        return Err(Refusal::NoJoints);
    }
    let start = chain.pose(problem.joints);
    let arc = match problem.form {
        Form::Line => None,
        Form::Arc(via) => {
            let (a, c) = (start.translation.vector, problem.goal.translation.vector);
            Some(Arc::through(&a, &via, &c).ok_or(Refusal::NoArc)?)
        }
    };
    let way = Way { start, goal: problem.goal, arc };
    let PoseError { distance, angle } = problem.within;
    let inner = PoseError { distance: INNER * distance, angle: INNER * angle };
    let mut pieces = settings.pieces;
    loop {
        let postures = postures(problem, &way, settings, pieces, progress);
        let last = pieces >= settings.pieces_max;
        match postures {
            // With finer steps a leap may turn out to be a quick turn.
            Err(Refusal::Singular { .. }) if !last => {}
            Err(refusal) => return Err(refusal),
            Ok(postures) => {
                let joints = slopes(chain, &postures);
                let deviation = deviation(problem, &way, &joints, pieces);
                if deviation.is_within(&inner) {
                    return Ok(Path { joints, deviation });
                }
                if last {
                    return Err(Refusal::Deviates { found: deviation, pieces });
                }
            }
        }
        pieces *= 2;
    }
}

/// Returns the postures (all joints) at even times, each found from the one before.
fn postures(
    problem: &Problem,
    way: &Way,
    settings: &Settings,
    pieces: usize,
    progress: &mut dyn Progress,
) -> Result<Vec<Vec<f64>>, Refusal> {
    let chain = problem.chain;
    let mut found = vec![problem.joints.to_vec()];
    for piece in 1..=pieces {
        let part = quintic(piece as f64 / pieces as f64);
        let pose = way.at(part);
        let orientation = if problem.free { Orientation::Free } else { Orientation::Full(pose.rotation) };
        let target = Target { position: pose.translation.vector, orientation };
        let last = &found[piece - 1];
        let mut joints = last.clone();
        let (error, _) = chain.descend(&target, &mut joints, &settings.descent);
        if !error.is_within(&settings.descent.tolerance) {
            let at_limit = chain.joints().iter().filter(|joint| {
                joints[joint.joint] <= joint.limits.0 || joints[joint.joint] >= joint.limits.1
            });
            let at_limit = at_limit.map(|joint| problem.names[joint.joint].clone()).collect();
            let before = quintic((piece - 1) as f64 / pieces as f64);
            return Err(Refusal::Unreachable { part: before, error, at_limit });
        }
        let change = |joint: usize| (joints[joint] - last[joint]).abs();
        let most = chain.joints().iter().max_by(|a, b| change(a.joint).total_cmp(&change(b.joint)));
        if let Some(most) = most.filter(|most| change(most.joint) > settings.change_max) {
            return Err(Refusal::Singular { part, joint: problem.names[most.joint].clone() });
        }
        found.push(joints);
        progress.report(&|| format!("{piece} of {pieces} postures on the way"));
        if !progress.should_continue() {
            return Err(Refusal::Stopped);
        }
    }
    Ok(found)
}

/// Returns for each joint of the chain its positions with their slopes by central differences of fourth order; near the ends,
/// where all is at rest, of second.
fn slopes(chain: &Chain, postures: &[Vec<f64>]) -> Vec<Vec<[f64; 2]>> {
    let last = postures.len() - 1;
    let step = 1.0 / last as f64;
    let of = |joint: usize, limits: (f64, f64)| {
        let q = |k: usize| postures[k][joint];
        // With these slopes the control points of the cubics, and so the cubics, are within the range of the joint.
        let room = |k: usize| (3.0 / step * (q(k) - limits.0).min(limits.1 - q(k))).max(0.0);
        let slope = |k: usize| match k {
            0 => 0.0,
            k if k == last => 0.0,
            k if k == 1 || k == last - 1 => (q(k + 1) - q(k - 1)) / (2.0 * step),
            k => (8.0 * (q(k + 1) - q(k - 1)) - (q(k + 2) - q(k - 2))) / (12.0 * step),
        };
        (0..=last).map(|k| [q(k), slope(k).clamp(-room(k), room(k))]).collect()
    };
    chain.joints().iter().map(|joint| of(joint.joint, joint.limits)).collect()
}

/// The part of the greatest deviation that is allowed, without unit, within which the motion is measured: between the places where
/// it is measured it may deviate more, and the judge proves the whole.
const INNER: f64 = 0.8;
/// The number of places in each piece at which the deviation is measured.
const LOOKS: usize = 4;

/// Returns the greatest deviation of the cubics from the way.
fn deviation(problem: &Problem, way: &Way, joints: &[Vec<[f64; 2]>], pieces: usize) -> PoseError {
    let chain = problem.chain;
    let step = 1.0 / pieces as f64;
    let mut worst = PoseError { distance: 0.0, angle: 0.0 };
    let mut all = problem.joints.to_vec();
    for piece in 0..pieces {
        for look in 1..=LOOKS {
            let u = look as f64 / (LOOKS + 1) as f64;
            for (joint, keys) in chain.joints().iter().zip(joints) {
                let ([p, v], [q, w]) = (keys[piece], keys[piece + 1]);
                let (b, c) = (p + v * step / 3.0, q - w * step / 3.0);
                let x = 1.0 - u;
                all[joint.joint] = x * x * (x * p + 3.0 * u * b) + u * u * (3.0 * x * c + u * q);
            }
            let found = way.deviation(&chain.pose(&all), quintic((piece as f64 + u) * step));
            worst.distance = worst.distance.max(found.distance);
            if !problem.free {
                worst.angle = worst.angle.max(found.angle);
            }
        }
    }
    worst
}
