//! Motion bounds of joints over an interval of time: position and rate in its middle, and a bound on the
//! difference of the rate from that, from Bernstein control points.

use super::polyline::Polyline;
use super::tolerances::Tolerances;
use crate::plan::{Tracks, polynomial};

/// The tracks of all joints with bounds on their accelerations and the jumps of their rates, from which motion bounds
/// over any interval of time follow.
#[derive(Clone, Debug)]
pub(super) struct MotionBounds {
    /// The position of each joint at the start of the plan, rad or m.
    start: Vec<f64>,
    /// The pieces of each joint, in order of time.
    pieces: Vec<Vec<Piece>>,
    /// The jumps of each joint's rate: (time, size).
    jumps: Vec<Vec<(f64, f64)>>,
    /// The times of all jumps, in order, s.
    jump_times: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Piece {
    start: f64,
    end: f64,
    control: Vec<f64>,
    /// Control points of the rate, rad/s or m/s.
    rates: Vec<f64>,
    /// A bound on the absolute second derivative, rad/s² or m/s².
    acceleration: f64,
}

/// An interval of time over which motion is bounded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Interval {
    /// The beginning of the interval, s.
    pub from: f64,
    /// The end of the interval, s.
    pub to: f64,
    /// The middle of the interval, s.
    pub middle: f64,
    /// Half the length of the interval, s.
    pub half: f64,
    /// True if no rate jumps within the interval: a rate then deviates in proportion to the time from the middle.
    pub smooth: bool,
}

/// The motion of a joint over an interval: exact in the middle, bounded elsewhere.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct JointMotion {
    /// The position of the joint in the middle of the interval, rad or m.
    pub at: f64,
    /// The rate of the joint in the middle of the interval, rad/s or m/s.
    pub rate: f64,
    /// A bound on the difference of the rate anywhere in the interval from that in the middle, rad/s or m/s.
    pub deviation: f64,
}

/// The motion of all joints that a search for collisions follows.
#[derive(Clone, Debug)]
pub(super) enum JointMotions {
    /// The motion as planned.
    Planned(MotionBounds),
    /// The motion as servos yield, known at instants.
    Deflected(Polyline),
}

impl JointMotions {
    /// Returns the number of joints of the robot.
    pub(super) fn joint_count(&self) -> usize {
        match self {
            JointMotions::Planned(bounds) => bounds.joint_count(),
            JointMotions::Deflected(line) => line.joint_count(),
        }
    }

    /// Returns the interval `from..to` (s), with a flag for rates that jump within it; a [`Polyline`] counts as if
    /// they always did.
    pub(super) fn interval(&self, from: f64, to: f64) -> Interval {
        match self {
            JointMotions::Planned(bounds) => bounds.interval(from, to),
            JointMotions::Deflected(line) => line.interval(from, to),
        }
    }

    /// Returns position and rate of a joint in the middle of an interval, with a bound on the rate's deviation;
    /// `joint`: the number in its [`JointId`](crate::robot::JointId).
    pub(super) fn over(&self, joint: usize, interval: &Interval) -> JointMotion {
        match self {
            JointMotions::Planned(bounds) => bounds.over(joint, interval),
            JointMotions::Deflected(line) => line.over(joint, interval),
        }
    }
}

impl MotionBounds {
    /// Computes the rates of all tracks of a plan, and bounds on their accelerations.
    pub(super) fn new(tracks: &Tracks) -> MotionBounds {
        let joints = tracks.start.joints.len();
        let mut bounds = MotionBounds {
            start: tracks.start.joints.clone(),
            pieces: vec![Vec::new(); joints],
            jumps: vec![Vec::new(); joints],
            jump_times: Vec::new(),
        };
        for track in &tracks.tracks {
            let joint = track.joint.0 as usize;
            let pieces: Vec<Piece> =
                track.segments.iter().map(|s| Piece::new(s.start, s.end, &s.control)).collect();
            bounds.jumps[joint] = jumps(&pieces);
            bounds.pieces[joint] = pieces;
        }
        bounds.jump_times = bounds.jumps.iter().flatten().map(|(time, _)| *time).collect();
        bounds.jump_times.sort_unstable_by(f64::total_cmp);
        bounds
    }

    /// Returns the number of joints of the robot.
    pub(super) fn joint_count(&self) -> usize {
        self.start.len()
    }

    /// Returns the interval `from..to` (s), with a flag for rates of joints that jump within it.
    pub(super) fn interval(&self, from: f64, to: f64) -> Interval {
        let first = self.jump_times.partition_point(|t| *t <= from);
        let smooth = self.jump_times.get(first).is_none_or(|t| *t >= to);
        Interval { from, to, middle: (from + to) / 2.0, half: (to - from) / 2.0, smooth }
    }

    /// Returns position and rate of a joint in the middle of an interval, with a bound on the rate's deviation;
    /// `joint`: the number in its [`JointId`](crate::robot::JointId).
    pub(super) fn over(&self, joint: usize, interval: &Interval) -> JointMotion {
        let pieces = &self.pieces[joint];
        let (at, rate) = position_and_rate(pieces, self.start[joint], interval.middle);
        let first = pieces.partition_point(|p| p.end <= interval.from);
        let within = pieces[first..].iter().take_while(|p| p.start < interval.to);
        let acceleration = within.map(|p| p.acceleration).fold(0.0, f64::max);
        let jumps = &self.jumps[joint];
        let first = jumps.partition_point(|(t, _)| *t <= interval.from);
        let jump: f64 = jumps[first..].iter().take_while(|(t, _)| *t < interval.to).map(|(_, by)| by).sum();
        JointMotion { at, rate, deviation: acceleration * interval.half + jump }
    }
}

impl Piece {
    fn new(start: f64, end: f64, control: &[f64]) -> Piece {
        let duration = end - start;
        let per_second = |points: Vec<f64>| points.iter().map(|c| c / duration).collect::<Vec<f64>>();
        let rates = per_second(polynomial::derivative(control));
        let (low, high) = polynomial::hull(&per_second(polynomial::derivative(&rates)));
        Piece { start, end, control: control.to_vec(), rates, acceleration: high.max(-low) }
    }

    fn last(points: &[f64]) -> f64 {
        points[points.len() - 1]
    }
}

fn position_and_rate(pieces: &[Piece], start: f64, t: f64) -> (f64, f64) {
    let Some(last) = pieces.partition_point(|p| p.start <= t).checked_sub(1) else { return (start, 0.0) };
    let piece = &pieces[last];
    if t >= piece.end {
        return (Piece::last(&piece.control), 0.0);
    }
    let u = (t - piece.start) / (piece.end - piece.start);
    (polynomial::value(&piece.control, u), polynomial::value(&piece.rates, u))
}

/// Returns the jumps of the rate of a track, which is at rest before, after and between its pieces.
fn jumps(pieces: &[Piece]) -> Vec<(f64, f64)> {
    let mut jumps = Vec::new();
    let (mut since, mut rate) = (f64::NEG_INFINITY, 0.0);
    for piece in pieces {
        if piece.start > since {
            jumps.push((since, f64::abs(rate)));
            rate = 0.0;
        }
        jumps.push((piece.start, (piece.rates[0] - rate).abs()));
        (since, rate) = (piece.end, Piece::last(&piece.rates));
    }
    jumps.push((since, rate.abs()));
    let tolerance = Tolerances::default().rate_jump;
    jumps.retain(|(_, by)| *by > tolerance);
    jumps
}
