//! Tracks run backwards.

use super::motion::{DockingEvent, DockingKind, Segment, Track, Tracks};

impl Segment {
    fn reversed(&self, duration: f64) -> Segment {
        let control = self.control.iter().rev().copied().collect();
        Segment { start: duration - self.end, end: duration - self.start, control, cause: self.cause }
    }
}

impl Tracks {
    /// Returns the motion in reverse, from end to start; dockings become undockings, and the reverse. The base keeps
    /// its pose at the start.
    pub fn reversed(&self) -> Tracks {
        let d = self.duration;
        let track = |t: &Track| Track {
            joint: t.joint,
            segments: t.segments.iter().rev().map(|s| s.reversed(d)).collect(),
        };
        let dock = |k: &DockingEvent| {
            let kind = match k.kind {
                DockingKind::Dock => DockingKind::Undock,
                DockingKind::Undock => DockingKind::Dock,
            };
            DockingEvent { time: d - k.time, kind, ..k.clone() }
        };
        Tracks {
            start: self.end(),
            tracks: self.tracks.iter().map(track).collect(),
            events: self.events.iter().rev().map(dock).collect(),
            ..self.clone()
        }
    }
}
