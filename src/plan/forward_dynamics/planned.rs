//! The positions and velocities of joints that a plan commands at ascending times, and its changes of bonds.

use crate::plan::{DockingEvent, Track, Tracks, polynomial};

/// The motion of a plan.
pub(crate) struct Planned<'a> {
    tracks: &'a Tracks,
    /// The index of the segment of each track that has begun last, or that comes first.
    current: Vec<usize>,
    /// The number of events that have been told.
    told: usize,
}

impl<'a> Planned<'a> {
    /// Returns the motion at its start.
    pub(crate) fn new(tracks: &'a Tracks) -> Planned<'a> {
        Planned { tracks, current: vec![0; tracks.tracks.len()], told: 0 }
    }

    /// Returns its duration, s.
    pub(crate) fn duration(&self) -> f64 {
        self.tracks.duration
    }

    /// Returns the changes of bonds up to a time (s, not before that of the last call), each once.
    pub(crate) fn events(&mut self, time: f64) -> &'a [DockingEvent] {
        let first = self.told;
        self.told = self.tracks.events.partition_point(|event| event.time <= time);
        &self.tracks.events[first..self.told]
    }

    /// Finds the position (rad or m) and velocity (rad/s or m/s) of each joint at a time (s), which must not be before that
    /// asked for last. Before the start and after the end joints are at rest.
    pub(crate) fn advance(&mut self, time: f64, joints: &mut [(f64, f64)]) {
        let tracks: &[Track] = &self.tracks.tracks;
        for (track, current) in tracks.iter().zip(&mut self.current) {
            while track.segments.get(*current + 1).is_some_and(|next| next.start <= time) {
                *current += 1;
            }
            let Some(segment) = track.segments.get(*current) else { continue };
            if time < segment.start {
                continue;
            }
            let joint = &mut joints[track.joint.0 as usize];
            if time >= segment.end {
                *joint = (segment.last(), 0.0);
                continue;
            }
            let (position, rate) = polynomial::value_and_rate(&segment.control, segment.argument(time));
            *joint = (position, rate / (segment.end - segment.start));
        }
    }
}
