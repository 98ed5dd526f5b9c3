//! Motion bounds of joints over an interval of time: position and rate in its middle, and a bound on the
//! difference of the rate from that, from Bernstein control points.

use super::tolerances::Tolerances;
use crate::plan::{Tracks, polynomial};

/// The tracks of all joints, with bounds of their derivatives.
#[derive(Clone, Debug)]
pub(super) struct MotionBounds {
    start: Vec<f64>,
    /// The pieces of each joint, in order of time.
    pieces: Vec<Vec<Piece>>,
    /// The jumps of each joint's rate: (time, size).
    jumps: Vec<Vec<(f64, f64)>>,
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

/// All joints over one interval; lists are indexed by the number in a [`JointId`](crate::robot::JointId).
#[derive(Clone, Debug, Default)]
pub(super) struct Interval {
    /// The middle, s.
    pub middle: f64,
    /// Half the length, s.
    pub half: f64,
    /// Positions in the middle, rad or m.
    pub at: Vec<f64>,
    /// Rates in the middle, rad/s or m/s.
    pub rate: Vec<f64>,
    /// Bounds on the difference of each rate from that in the middle, rad/s or m/s.
    pub deviation: Vec<f64>,
    /// True if no rate jumps within: then it deviates in proportion to the time from the middle.
    pub smooth: bool,
}

impl MotionBounds {
    /// Computes the derivatives of all tracks and their bounds.
    pub(super) fn new(tracks: &Tracks) -> MotionBounds {
        let joints = tracks.start.joints.len();
        let mut bounds = MotionBounds {
            start: tracks.start.joints.clone(),
            pieces: vec![Vec::new(); joints],
            jumps: vec![Vec::new(); joints],
        };
        for track in &tracks.tracks {
            let joint = track.joint.0 as usize;
            let pieces: Vec<Piece> =
                track.segments.iter().map(|s| Piece::new(s.start, s.end, &s.control)).collect();
            bounds.jumps[joint] = jumps(&pieces);
            bounds.pieces[joint] = pieces;
        }
        bounds
    }

    /// Writes the motion of all joints over `from..to` (s) to `out`.
    pub(super) fn over(&self, from: f64, to: f64, out: &mut Interval) {
        out.middle = (from + to) / 2.0;
        out.half = (to - from) / 2.0;
        out.smooth = true;
        out.at.clear();
        out.rate.clear();
        out.deviation.clear();
        for joint in 0..self.start.len() {
            let pieces = &self.pieces[joint];
            let (at, rate) = position_and_rate(pieces, self.start[joint], out.middle);
            let first = pieces.partition_point(|p| p.end <= from);
            let within = pieces[first..].iter().take_while(|p| p.start < to);
            let acceleration = within.map(|p| p.acceleration).fold(0.0, f64::max);
            let jumps = &self.jumps[joint];
            let first = jumps.partition_point(|(t, _)| *t <= from);
            let jump: f64 = jumps[first..].iter().take_while(|(t, _)| *t < to).map(|(_, by)| by).sum();
            out.smooth &= jump == 0.0;
            out.at.push(at);
            out.rate.push(rate);
            out.deviation.push(acceleration * out.half + jump);
        }
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
