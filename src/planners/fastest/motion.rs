//! Joint trajectories (tracks) from paths and time laws: each piece of a path is composed with its time law, exactly.

use super::path::{Part, Stretch};
use super::time_law::TimeLaw;
use super::tolerances::TOLERANCES;
use crate::plan::polynomial::{composed, derivative, elevated, greatest_size, hull};
use crate::plan::time::{tick_after, tick_near};
use crate::plan::{DockingEvent, Segment, Track, Tracks};
use crate::robot::Drive;

/// A part of a plan, a pause or a stretch in motion, with its time law.
pub(super) enum Timed {
    /// A pause with its begin and end in the plan, s.
    Pause(f64, f64),
    /// A stretch with its time law, and the factor on its duration by which it is slowed down, at least 1.
    Stretch(Stretch, TimeLaw, f64),
}

/// The map from the times of a plan to those of the retimed one.
#[derive(Clone)]
pub struct Clock {
    /// The parts of the plan, in order of time, without gaps.
    parts: Vec<ClockPart>,
    /// The new duration, s.
    duration: f64,
}

/// The new times of a part of a plan.
#[derive(Clone)]
struct ClockPart {
    /// The beginning in the plan, s.
    from: f64,
    /// The end in the plan, s.
    to: f64,
    /// The new beginning, s.
    start: f64,
    /// The new end, s.
    end: f64,
    /// The new times along a stretch; `None` for a pause.
    law: Option<ClockLaw>,
}

/// The new times along a stretch.
#[derive(Clone)]
struct ClockLaw {
    stretch: Stretch,
    /// The parameters of the grid.
    nodes: Vec<f64>,
    /// The new time at each point of the grid, s.
    times: Vec<f64>,
    /// The middle control point of the time law of each interval, as [`middle`] returns it.
    middles: Vec<f64>,
}

impl Clock {
    /// Returns the time in the retimed plan (s) for a time of the plan (s), never decreasing, on a whole tick; a time
    /// before the beginning counts as the beginning, one after the end as the end.
    pub fn at(&self, time: f64) -> f64 {
        let last = self.parts.partition_point(|part| part.from <= time);
        let Some(part) = last.checked_sub(1).map(|i| &self.parts[i]) else { return 0.0 };
        if time >= part.to {
            return part.end;
        }
        let Some(ClockLaw { stretch, nodes, times, middles }) = &part.law else {
            return tick_near(part.start + (time - part.from)).clamp(part.start, part.end);
        };
        let place = stretch.place(time);
        let next = nodes.partition_point(|node| *node <= place).clamp(1, nodes.len() - 1);
        let share = ((place - nodes[next - 1]) / (nodes[next] - nodes[next - 1])).clamp(0.0, 1.0);
        // The root of 2 m w (1 - w) + w² = share.
        let m = middles[next - 1];
        let root = libm::sqrt((m * m + (1.0 - 2.0 * m) * share).max(0.0));
        let w = if share > 0.0 { share / (m + root) } else { 0.0 };
        tick_near(times[next - 1] + w * (times[next] - times[next - 1])).clamp(part.start, part.end)
    }

    /// Returns the duration of the retimed plan, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the beginning and the end of each part of the plan in the retimed plan, s, in order of time.
    pub(super) fn spans(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.parts.iter().map(|part| (part.start, part.end))
    }
}

impl Timed {
    /// Returns a part with its time law, not slowed down; a pause ignores `law`. Panics if a stretch has none.
    pub(super) fn new(part: Part, law: Option<TimeLaw>) -> Timed {
        match part {
            Part::Pause { from, to } => Timed::Pause(from, to),
            Part::Stretch(stretch) => Timed::Stretch(stretch, law.expect("each stretch has a law"), 1.0),
        }
    }
}

/// Returns the durations of the intervals of a law, times a factor, s: whole ticks, rounded up.
fn durations(law: &TimeLaw, factor: f64) -> Vec<f64> {
    (0..law.grid.nodes.len() - 1).map(|k| tick_after(factor * law.duration(k))).collect()
}

/// Returns the middle control point of the time law of an interval with these speeds at its ends: a quadratic Bernstein
/// polynomial that maps the part of its duration to the part of its length, with the other control points 0 and 1.
fn middle(speeds: &[f64]) -> f64 {
    speeds[0] / (speeds[0] + speeds[1])
}

/// Returns the piece of the path of a joint in an interval of the grid, composed with its time law; at most one, as the
/// grid has all ends of pieces, and `None` if the joint does not move in it. Begin and end of the piece are parameters
/// still, not times.
fn piece(track: &Track, nodes: &[f64], speeds: &[f64]) -> Option<Segment> {
    let next = track.segments.partition_point(|s| s.end <= nodes[0]);
    let mut piece = track.segments.get(next).and_then(|s| s.between(nodes[0], nodes[1]))?;
    let (low, high) = hull(&piece.control);
    if low == high {
        return None;
    }
    if speeds[0] != speeds[1] {
        piece.control = composed(&piece.control, middle(speeds));
    }
    // Both ends equal those of the pieces beside them bit by bit, so that rounding does not add up.
    let last = piece.control.len() - 1;
    for (index, node) in [(0, nodes[0]), (last, nodes[1])] {
        piece.control[index] = track.position(piece.control[index], node);
    }
    Some(piece)
}

/// Returns for each interval of a time law the factor on its duration with which all limits of speed and acceleration
/// hold: the greatest of all ratios of speed to its limit and of the square roots of those of acceleration, without
/// unit; above 1 where a limit is exceeded.
pub(super) fn ratios(stretch: &Stretch, law: &TimeLaw, drives: &[Drive]) -> Vec<f64> {
    let times = durations(law, 1.0);
    let of = |k: usize| {
        let pieces: Vec<(usize, Vec<f64>)> = stretch
            .path
            .iter()
            .filter_map(|track| {
                let piece = piece(track, &law.grid.nodes[k..k + 2], &law.speeds[k..k + 2])?;
                Some((track.joint.0 as usize, piece.control))
            })
            .collect();
        drives.iter().map(|drive| ratio(drive, &pieces, times[k])).fold(0.0, f64::max)
    };
    (0..times.len()).map(of).collect()
}

/// Returns the greatest ratio of one drive, of speed or the root of that of acceleration, over an interval that lasts
/// `time` (s). `pieces`: the moving joints with their control points over the interval, rad or m.
fn ratio(drive: &Drive, pieces: &[(usize, Vec<f64>)], time: f64) -> f64 {
    let of = |&(joint, factor): &(usize, f64)| {
        pieces.iter().find(|(j, _)| *j == joint).map(|(_, control)| (factor, control))
    };
    let terms: Vec<(f64, &Vec<f64>)> = drive.terms.iter().filter_map(of).collect();
    let Some(degree) = terms.iter().map(|(_, control)| control.len() - 1).max() else { return 0.0 };
    let mut sum = vec![0.0; degree + 1];
    for (factor, control) in terms {
        sum.iter_mut().zip(elevated(control, degree)).for_each(|(s, c)| *s += factor * c);
    }
    let rates = derivative(&sum);
    let size = |control: &[f64]| {
        let (low, high) = hull(control);
        let bound = high.max(-low);
        move |limit: f64, control: &[f64]| {
            if bound <= limit { bound } else { greatest_size(control, TOLERANCES.extremum).0 }
        }
    };
    let speed = drive.limits.speed.map_or(0.0, |v| size(&rates)(v * time, &rates) / (v * time));
    let seconds = derivative(&rates);
    let square = time * time;
    let acceleration =
        drive.limits.acceleration.map_or(0.0, |a| size(&seconds)(a * square, &seconds) / (a * square));
    speed.max(libm::sqrt(acceleration))
}

/// Returns (tracks, clock): the joint trajectories of a plan composed with the time laws of its parts, docking
/// included, and the map from old times to new ones. `old`: the tracks of the plan; `parts`: its parts in order of
/// time.
pub(super) fn tracks(old: &Tracks, parts: &[Timed]) -> (Tracks, Clock) {
    let mut new: Vec<Track> =
        old.tracks.iter().map(|t| Track { joint: t.joint, segments: Vec::new() }).collect();
    let mut clock = Clock { parts: Vec::with_capacity(parts.len()), duration: 0.0 };
    for part in parts {
        let start = clock.duration;
        let part = match part {
            Timed::Pause(from, to) => {
                ClockPart { from: *from, to: *to, start, end: start + (to - from), law: None }
            }
            Timed::Stretch(stretch, law, factor) => {
                let mut times = vec![start];
                for time in durations(law, *factor) {
                    times.push(times[times.len() - 1] + time);
                }
                append(&mut new, stretch, law, &times);
                let middles = law.speeds.windows(2).map(middle).collect();
                let end = times[times.len() - 1];
                let nodes = law.grid.nodes.clone();
                let law = Some(ClockLaw { stretch: stretch.clone(), nodes, times, middles });
                ClockPart { from: stretch.from, to: stretch.to, start, end, law }
            }
        };
        clock.duration = part.end;
        clock.parts.push(part);
    }
    new.retain(|track| !track.segments.is_empty());
    let event = |event: &DockingEvent| DockingEvent { time: clock.at(event.time), ..event.clone() };
    let events = old.events.iter().map(event).collect();
    (Tracks { tracks: new, events, duration: clock.duration, ..old.clone() }, clock)
}

/// Appends the segments of a stretch to the tracks of their joints. `times`: the new times of the points of its grid,
/// s.
fn append(new: &mut [Track], stretch: &Stretch, law: &TimeLaw, times: &[f64]) {
    for track in &stretch.path {
        let Some(own) = new.iter_mut().find(|t| t.joint == track.joint) else { continue };
        for k in 0..times.len() - 1 {
            let Some(mut piece) = piece(track, &law.grid.nodes[k..k + 2], &law.speeds[k..k + 2]) else {
                continue;
            };
            (piece.start, piece.end) = (times[k], times[k + 1]);
            own.segments.push(piece);
        }
    }
}
