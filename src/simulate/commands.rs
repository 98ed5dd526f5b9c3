//! Commanded positions and velocities of a plan's joints over time.

use crate::plan::{Track, Tracks, polynomial};

/// The commanded position and velocity of every joint, by the number of its id, at ascending times.
#[derive(Clone, Debug)]
pub(super) struct Commands<'a> {
    tracks: &'a [Track],
    /// The index of the segment of each track that has begun last, or that comes first.
    current: Vec<usize>,
    /// The derivative of that segment by its argument, as control points; empty until it is needed.
    rates: Vec<Vec<f64>>,
    /// The position (rad or m) and velocity (rad/s or m/s) of each joint at the time asked for last.
    pub joints: Vec<(f64, f64)>,
}

impl<'a> Commands<'a> {
    /// Returns the commands of a plan, at its start.
    pub(super) fn new(tracks: &'a Tracks) -> Commands<'a> {
        Commands {
            tracks: &tracks.tracks,
            current: vec![0; tracks.tracks.len()],
            rates: vec![Vec::new(); tracks.tracks.len()],
            joints: tracks.start.joints.iter().map(|&position| (position, 0.0)).collect(),
        }
    }

    /// Finds the commands at a time (s), which must not be before that asked for last. Before the start and after the end
    /// of the plan joints are at rest.
    pub(super) fn advance(&mut self, time: f64) {
        for ((track, current), rates) in self.tracks.iter().zip(&mut self.current).zip(&mut self.rates) {
            while track.segments.get(*current + 1).is_some_and(|next| next.start <= time) {
                *current += 1;
                rates.clear();
            }
            let Some(segment) = track.segments.get(*current) else { continue };
            if time < segment.start {
                continue;
            }
            let joint = &mut self.joints[track.joint.0 as usize];
            if time >= segment.end {
                *joint = (segment.last(), 0.0);
                continue;
            }
            if rates.is_empty() {
                *rates = polynomial::derivative(&segment.control);
            }
            let argument = segment.argument(time);
            let rate = polynomial::value(rates, argument) / (segment.end - segment.start);
            *joint = (polynomial::value(&segment.control, argument), rate);
        }
    }
}
