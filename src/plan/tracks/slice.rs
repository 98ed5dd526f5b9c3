//! Tracks between two times.

use super::motion::{Track, Tracks};

impl Tracks {
    /// Returns the trajectories between two times, s from the start of the plan. Bonds that change at the first
    /// instant have changed at the start of the slice, those that change at the last instant change at its end.
    pub(in crate::plan) fn sliced(&self, from: f64, to: f64) -> Tracks {
        let track = |t: &Track| {
            let pieces = t.segments.iter().filter_map(|s| s.between(from, to)).map(|mut s| {
                (s.start, s.end) = (s.start - from, s.end - from);
                s
            });
            Track { joint: t.joint, segments: pieces.collect() }
        };
        let docks = self.events.iter().filter(|d| from < d.time && d.time <= to).cloned().map(|mut d| {
            d.time -= from;
            d
        });
        Tracks {
            start: self.state(from),
            tracks: self.tracks.iter().map(track).filter(|t| !t.segments.is_empty()).collect(),
            events: docks.collect(),
            duration: to - from,
            ..self.clone()
        }
    }
}
