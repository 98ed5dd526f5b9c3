//! Ports that keep to the paths that a plan states of them.
//!
//! The distance from the path is proved: it is measured at samples, and between two of them the port leaves the chord by no more
//! than h²/8 times a bound on its acceleration, which follows from the rates of the joints, bounded by their control points,
//! and from the length of the chain. Samples are added where that does not suffice. The angle from the stated turn is
//! measured at the samples.

use super::tolerances::Tolerances;
use crate::geometry::rigid_transform::rotation_vector;
use crate::geometry::{Pose, RigidTransform, Vec3};
use crate::plan::polynomial::{derivative, part};
use crate::plan::verify::ledger::Ledger;
use crate::plan::{CheckKind, Failure, Plan, StatedPath, Status, Tracks};
use crate::robot::chain::Chain;
use crate::robot::jacobian::LinkFrame;
use crate::robot::{JointKind, JointOwner, Kinematics};
use crate::units::{Dimension, quantity};
use nalgebra::UnitQuaternion;

/// The greatest number of samples of one path: where more are needed, nothing is proved between them.
const SAMPLES_MAX: usize = 200_000;
/// The least number of samples of one path at which its orientation is measured.
const SAMPLES_MIN: usize = 64;

/// Judges the paths that a plan states, if it states any.
pub(super) fn judge(plan: &Plan, tracks: &Tracks, tolerances: &Tolerances, ledger: &mut Ledger) {
    if plan.paths.is_empty() {
        return;
    }
    let (mut samples, mut proved) = (0, true);
    for path in &plan.paths {
        let mut judged = match Judged::new(tracks, path) {
            Some(judged) => judged,
            None => {
                ledger.fail(failure(
                    tracks,
                    path,
                    path.from,
                    "is not connected with the frame of its path",
                    0.0,
                ));
                continue;
            }
        };
        judged.run(tolerances.path_part);
        samples += judged.samples;
        proved &= judged.proved && path.turned_within.is_none();
        if let Some((time, distance)) = judged.distance.filter(|(_, distance)| *distance > path.within) {
            let words = |x: f64| quantity(x, Dimension::LENGTH);
            let found =
                format!("is {} off its path, and {} are allowed", words(distance), words(path.within));
            ledger.fail(Failure { limit: path.within, ..failure(tracks, path, time, &found, distance) });
        }
        if let (Some((time, angle)), Some(limit)) = (judged.angle, path.turned_within)
            && angle > limit
        {
            let words = |x: f64| quantity(x, Dimension::ANGLE);
            let found =
                format!("is turned by {} from its path, and {} are allowed", words(angle), words(limit));
            ledger.fail(Failure { limit, ..failure(tracks, path, time, &found, angle) });
        }
    }
    ledger.check(CheckKind::Path, if proved { Status::Proved } else { Status::Sampled(samples) });
}

/// Returns the failure of a path at a time (s).
fn failure(tracks: &Tracks, path: &StatedPath, time: f64, found: &str, value: f64) -> Failure {
    let port = tracks.robot.port_name(path.port);
    Failure {
        kind: CheckKind::Path,
        time,
        until: None,
        message: format!("`{port}` {found}"),
        at: vec![port],
        value,
        limit: 0.0,
        blame: vec![path.cause],
        blames_start: false,
    }
}

/// The path as geometry.
struct Geometry {
    start: Pose,
    end: Pose,
    /// The centre of the arc, its unit normal and radius; `None` for a straight line.
    arc: Option<(Vec3, Vec3, f64)>,
    /// The unit axis of the turn from the first to the last orientation, and its angle, rad; the axis is 0 without a turn.
    turn: (Vec3, f64),
}

impl Geometry {
    fn new(path: &StatedPath) -> Geometry {
        let (a, c) = (path.start.translation.vector, path.end.translation.vector);
        let whole = vector(&(path.end.rotation * path.start.rotation.inverse()));
        let angle = whole.norm();
        let axis = if angle > 0.0 { whole / angle } else { Vec3::zeros() };
        let arc = path.via().and_then(|b| circle(a, b, c));
        Geometry { start: path.start, end: path.end, arc, turn: (axis, angle) }
    }

    /// Returns the distance of a point from the line or circle, m; from the ends where it lies beyond a line's.
    fn distance(&self, p: &Vec3) -> f64 {
        match &self.arc {
            Some((centre, normal, radius)) => {
                let (height, away) = from_axis(&(p - centre), normal);
                libm::hypot(height, away - radius)
            }
            None => {
                let (a, b) = (self.start.translation.vector, self.end.translation.vector);
                let ab = b - a;
                let along = (p - a).dot(&ab) / ab.norm_squared().max(f64::MIN_POSITIVE);
                (p - a - ab * along.clamp(0.0, 1.0)).norm()
            }
        }
    }

    /// Returns the amount by which the distance from the path may be greater on a chord between two points than at them, m.
    fn bulge(&self, p0: &Vec3, p1: &Vec3) -> f64 {
        let Some((centre, normal, _)) = &self.arc else { return 0.0 };
        let [away0, away1] = [p0, p1].map(|p| from_axis(&(p - centre), normal).1);
        let chord = (p1 - p0).norm();
        // Inside a circle the distance from it is not convex; that from its axis has a second derivative along the chord of at
        // most the inverse of the least one there, and changes by at most half of the chord.
        let least = away0.min(away1) - chord / 2.0;
        let most = chord / 2.0;
        if least > 0.0 { most.min(chord * chord / (8.0 * least)) } else { most }
    }

    /// Returns the angle of an orientation from the nearest one on the turn, rad.
    fn angle(&self, rotation: &UnitQuaternion<f64>) -> f64 {
        let (axis, whole) = &self.turn;
        let from_start = rotation * self.start.rotation.inverse();
        // The part of the rotation about the axis (swing and twist).
        let along = from_start.imag().dot(axis);
        let twist = 2.0 * libm::atan2(along, from_start.w);
        // Of the angles that are whole turns apart the one nearest to the middle of the turn: a rotation has two quaternions.
        let turns = ((twist - whole / 2.0) / std::f64::consts::TAU).round();
        let twist = twist - turns * std::f64::consts::TAU;
        let twist = twist.clamp(0.0, *whole);
        let wanted = match *whole > 0.0 {
            true => crate::geometry::pose::turned(*axis, twist).rotation * self.start.rotation,
            false => self.start.rotation,
        };
        vector(&(rotation * wanted.inverse())).norm()
    }
}

/// Returns the part of a vector along a unit vector, and the length of what is across it, m.
fn from_axis(off: &Vec3, axis: &Vec3) -> (f64, f64) {
    let along = off.dot(axis);
    (along, (off - axis * along).norm())
}

/// Returns the rotation vector of a rotation, rad.
fn vector(rotation: &UnitQuaternion<f64>) -> Vec3 {
    rotation_vector(&RigidTransform::from(&Pose::from_parts(Vec3::zeros().into(), *rotation)).rotation)
}

/// Returns (centre, unit normal, radius) of the circle through three points, m; `None` if they are in one line.
fn circle(a: Vec3, b: Vec3, c: Vec3) -> Option<(Vec3, Vec3, f64)> {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(&v);
    let size = normal.norm_squared();
    if size <= f64::EPSILON * u.norm_squared() * v.norm_squared() {
        return None;
    }
    let out = (v.cross(&normal) * u.norm_squared() + normal.cross(&u) * v.norm_squared()) / (2.0 * size);
    Some((a + out, normal.normalize(), out.norm()))
}

/// A path under judgement.
struct Judged<'a> {
    tracks: &'a Tracks,
    path: &'a StatedPath,
    geometry: Geometry,
    chain: Chain,
    /// The joints of the chain with the kind of motion: true for those that slide.
    joints: Vec<(usize, bool)>,
    /// The positions of all joints, as far as the chain is concerned.
    positions: Vec<f64>,
    samples: usize,
    proved: bool,
    /// The greatest distance and angle with their times, as (s, m or rad).
    distance: Option<(f64, f64)>,
    angle: Option<(f64, f64)>,
}

impl<'a> Judged<'a> {
    /// Prepares the judgement of a path; `None` if nothing connects the port with the module.
    fn new(tracks: &'a Tracks, path: &'a StatedPath) -> Option<Judged<'a>> {
        let robot = &tracks.robot;
        let kinematics = Kinematics::new(robot, &tracks.bonds(path.from), path.module);
        let frame = LinkFrame::of_port(robot, &kinematics, path.port);
        let chain = Chain::new(robot, &kinematics, kinematics.link(path.module, 0), &frame)?;
        let slides = |owner: JointOwner| match owner {
            JointOwner::Module { module, joint } => {
                robot.module_type(module).joints[joint].kind == JointKind::Prismatic
            }
            JointOwner::Bond(_) => false,
        };
        // Joints that follow others, and passive ones, move the port, too.
        let joints = robot.joints().enumerate().map(|(joint, owner)| (joint, slides(owner)));
        let moved =
            |joint: &(usize, bool)| tracks.tracks.iter().any(|track| track.joint.0 as usize == joint.0);
        let joints: Vec<(usize, bool)> =
            joints.filter(moved).filter(|(joint, _)| chain.factor(*joint) > 0.0).collect();
        let known = |joint: usize| chain.joints().iter().any(|known| known.joint == joint);
        let proved = joints.iter().all(|(joint, slides)| !slides || known(*joint));
        Some(Judged {
            geometry: Geometry::new(path),
            joints,
            positions: tracks.state(path.from).joints,
            chain,
            tracks,
            path,
            samples: 0,
            // The length of a chain counts the travel of slides that take commands alone.
            proved,
            distance: None,
            angle: None,
        })
    }

    /// Looks at the whole interval. `part`: the part of the stated distance down to which a bound is refined.
    fn run(&mut self, part: f64) {
        let mut times = vec![self.path.from, self.path.to];
        for (joint, _) in &self.joints {
            let track = self.tracks.tracks.iter().find(|track| track.joint.0 as usize == *joint);
            for segment in track.into_iter().flat_map(|track| &track.segments) {
                times.extend([segment.start, segment.end].into_iter().filter(|t| self.within(*t)));
            }
        }
        let even = (1..SAMPLES_MIN)
            .map(|i| self.path.from + (self.path.to - self.path.from) * i as f64 / SAMPLES_MIN as f64);
        times.extend(even);
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut before = self.look(times[0]);
        for pair in times.windows(2) {
            let after = self.look(pair[1]);
            self.refine((pair[0], before), (pair[1], after), part);
            before = after;
        }
    }

    fn within(&self, time: f64) -> bool {
        self.path.from < time && time < self.path.to
    }

    /// Measures at a time (s), and returns (position, distance from the path), m.
    fn look(&mut self, time: f64) -> (Vec3, f64) {
        self.samples += 1;
        let start = &self.tracks.start.joints;
        for (joint, _) in &self.joints {
            let track = self.tracks.tracks.iter().find(|track| track.joint.0 as usize == *joint);
            self.positions[*joint] = track.map_or(start[*joint], |track| track.position(start[*joint], time));
        }
        let pose = self.chain.pose(&self.positions);
        let p = pose.translation.vector;
        let distance = self.geometry.distance(&p);
        if self.distance.is_none_or(|(_, most)| distance > most) {
            self.distance = Some((time, distance));
        }
        if self.path.turned_within.is_some() {
            let angle = self.geometry.angle(&pose.rotation);
            if self.angle.is_none_or(|(_, most)| angle > most) {
                self.angle = Some((time, angle));
            }
        }
        (p, distance)
    }

    /// Bounds the distance between two samples within one piece of every track, halving where the bound does not suffice.
    fn refine(&mut self, first: (f64, (Vec3, f64)), last: (f64, (Vec3, f64)), part: f64) {
        let mut stack = vec![(first, last)];
        while let Some(((t0, (p0, d0)), (t1, (p1, d1)))) = stack.pop() {
            let h = t1 - t0;
            let off = h * h / 8.0 * self.acceleration(t0, t1) + self.geometry.bulge(&p0, &p1);
            let worst = d0.max(d1);
            if worst > self.path.within || worst + off <= self.path.within || off <= part * self.path.within {
                continue;
            }
            if self.samples >= SAMPLES_MAX || !off.is_finite() {
                self.proved = false;
                continue;
            }
            let middle = (t0 + t1) / 2.0;
            let between = (middle, self.look(middle));
            stack.push(((t0, (p0, d0)), between));
            stack.push((between, (t1, (p1, d1))));
        }
    }

    /// Returns a bound on the acceleration of the port between two times (s) within one piece of every track, m/s².
    ///
    /// With λ the greatest distance of the port from the axis of a joint that turns, and 1 for one that slides, the port
    /// moves by at most λ|q'| per time; its derivative by two joints is at most the λ of the inner one.
    fn acceleration(&self, t0: f64, t1: f64) -> f64 {
        let lever = self.chain.length();
        let (mut linear, mut rates, mut fastest) = (0.0, 0.0, 0.0);
        for (joint, slides) in &self.joints {
            let (rate, change) = self.rates(*joint, t0, t1);
            let factor = self.chain.factor(*joint);
            let own = factor * if *slides { 1.0 } else { lever };
            linear += own * change;
            rates += own * rate;
            fastest += if *slides { 0.0 } else { factor * rate };
        }
        linear + 2.0 * rates * fastest
    }

    /// Returns bounds on the rate and its change of a joint between two times (s), rad/s and rad/s² or m/s and m/s².
    fn rates(&self, joint: usize, t0: f64, t1: f64) -> (f64, f64) {
        let track = self.tracks.tracks.iter().find(|track| track.joint.0 as usize == joint);
        let segment = track.and_then(|track| track.segments.iter().find(|s| s.start <= t0 && t1 <= s.end));
        let Some(segment) = segment else { return (0.0, 0.0) };
        let length = segment.end - segment.start;
        let (u0, u1) = ((t0 - segment.start) / length, (t1 - segment.start) / length);
        let size = |control: &[f64]| control.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let first = derivative(&segment.control);
        let second = derivative(&first);
        let bound = |control: &[f64]| if control.is_empty() { 0.0 } else { size(&part(control, u0, u1)) };
        (bound(&first) / length, bound(&second) / (length * length))
    }
}
