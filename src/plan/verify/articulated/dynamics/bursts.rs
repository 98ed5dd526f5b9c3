//! Motions that are short beside the window: bursts, whose accelerations a window of usual length would average away,
//! and steps of velocity, whose accelerations are not known.

use super::tolerances::PARAMETERS;
use crate::plan::Tracks;

/// Motions of single joints from rest to rest, or from one jump of the velocity to the next, that last less than
/// `burst_windows` times the `window` of [`PARAMETERS`], and the jumps of velocity.
pub(super) struct Bursts {
    /// The begin and the end of each, s, in order of begin, then of end.
    spans: Vec<(f64, f64)>,
    /// The steps of velocity, in order of time, then of joint.
    steps: Vec<VelocityStep>,
}

/// A jump of a joint's velocity at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VelocityStep {
    /// The time of the step, s.
    pub time: f64,
    /// The joint, by [`crate::robot::JointId`].
    pub joint: usize,
}

impl Bursts {
    /// Returns the short motions and the jumps of velocity of all joints of a plan.
    pub(super) fn new(tracks: &Tracks) -> Bursts {
        let (mut spans, mut steps) = (Vec::new(), Vec::new());
        for track in &tracks.tracks {
            let joint = track.joint.0 as usize;
            let mut begin: Option<f64> = None;
            let mut rate = 0.0;
            let mut step = |time: f64, change: f64| {
                if change.abs() > PARAMETERS.rest_speed {
                    steps.push(VelocityStep { time, joint });
                }
            };
            for (index, segment) in track.segments.iter().enumerate() {
                let from = *begin.get_or_insert(segment.start);
                let speed = segment.velocity(segment.end);
                step(segment.start, segment.velocity(segment.start) - rate);
                let next = track.segments.get(index + 1).filter(|next| next.start <= segment.end);
                rate = if next.is_some() { speed } else { 0.0 };
                step(segment.end, rate - speed);
                let flows = |next: &crate::plan::Segment| {
                    let jump = (next.velocity(next.start) - speed).abs();
                    speed.abs() > PARAMETERS.rest_speed && jump <= PARAMETERS.rest_speed
                };
                if next.is_some_and(flows) {
                    continue;
                }
                if segment.end - from < PARAMETERS.window * PARAMETERS.burst_windows {
                    spans.push((from, segment.end));
                }
                begin = None;
            }
        }
        spans.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        spans.dedup();
        steps.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.joint.cmp(&b.joint)));
        Bursts { spans, steps }
    }

    /// Returns the jumps of velocity, in order of time, then of joint.
    pub(super) fn steps(&self) -> &[VelocityStep] {
        &self.steps
    }

    /// Returns true if the velocity of a joint jumps within the longest window (`window` of [`PARAMETERS`]) before or
    /// after a time (s).
    pub(super) fn near_step(&self, time: f64) -> bool {
        let first = self.steps.partition_point(|step| step.time < time - PARAMETERS.window);
        self.steps.get(first).is_some_and(|step| step.time <= time + PARAMETERS.window)
    }

    /// Returns the times (s) within short motions at which loads are determined besides those of samples, ascending,
    /// each once: evenly spaced, they divide each motion into `burst_instants` parts.
    pub(super) fn instants(&self) -> Vec<f64> {
        let parts = PARAMETERS.burst_instants;
        let inside = |&(from, to): &(f64, f64)| {
            (1..parts).map(move |k| from + (to - from) * f64::from(k) / f64::from(parts))
        };
        let mut times: Vec<f64> = self.spans.iter().flat_map(inside).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Returns the length of the window centred on a time (s) over which velocities and accelerations are means, s:
    /// the shortest short motion that comes within half of `window` ([`PARAMETERS`]) of it, divided by
    /// `burst_windows`, at least `window_min`; `window` if there is none.
    pub(super) fn window(&self, time: f64) -> f64 {
        let half = PARAMETERS.window / 2.0;
        let begun = self.spans.partition_point(|span| span.0 <= time + half);
        let longest = PARAMETERS.window * PARAMETERS.burst_windows;
        let first = self.spans.partition_point(|span| span.0 < time - half - longest);
        let near = self.spans[first..begun].iter().filter(|span| span.1 >= time - half);
        let shortest = near.map(|(from, to)| (to - from) / PARAMETERS.burst_windows);
        shortest.fold(PARAMETERS.window, f64::min).max(PARAMETERS.window_min)
    }
}
