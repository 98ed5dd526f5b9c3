//! The path of a plan: cut at the instants at which the robot has to be at rest, and given over a parameter that takes
//! the place of time: the distance along a straight line, or the plan's own time along a curve.

use super::Refusal;
use super::tolerances::TOLERANCES;
use crate::plan::polynomial::{DEGREE_MAX, derivative, elevated};
use crate::plan::{Segment, Track, Tracks};

/// A part of a plan between two instants of rest.
pub(super) enum Part {
    /// Nothing moves: a pause, which keeps its duration.
    Pause {
        /// The beginning in the plan, s.
        from: f64,
        /// The end in the plan, s.
        to: f64,
    },
    /// A stretch: joints move.
    Stretch(Stretch),
}

/// A part of a plan in which joints move, from rest to rest: its path over a parameter that takes the place of time.
#[derive(Clone)]
pub(super) struct Stretch {
    /// The beginning in the plan, s.
    pub(super) from: f64,
    /// The end in the plan, s.
    pub(super) to: f64,
    /// The positions of all joints at the beginning, rad or m.
    pub(super) start: Vec<f64>,
    /// The path: tracks of the moving joints over the parameter, which takes the place of time and goes from 0 to
    /// `length`. On a straight path it is the distance that the joint which moves farthest, the leader, has gone, rad
    /// or m; otherwise the time in the plan since `from`, s.
    pub(super) path: Vec<Track>,
    /// The parameter at the end, rad, m or s.
    pub(super) length: f64,
    /// True for a straight line in the space of joints.
    pub(super) straight: bool,
    /// True at begin and end if all joints are at rest there at any velocity of the parameter, since the derivative of
    /// the path is zero; false on a straight path.
    pub(super) free: [bool; 2],
    /// The map from times of the plan to the parameter.
    places: Places,
}

/// The map from times of the plan to the parameter of a stretch.
#[derive(Clone)]
enum Places {
    /// The parameter is the time since the beginning of the stretch.
    Time,
    /// The parameter is the distance that leaders have gone: for each of the straight stretches that are joined, the
    /// distance before it (rad or m), and the segments of its leader in the plan.
    Distances(Vec<(f64, Vec<Segment>)>),
}

/// An instant of the plan at which the velocities of joints change, or bonds do.
struct Instant {
    /// The time in the plan, s.
    time: f64,
    /// True if the velocity of the path has to be zero.
    stop: bool,
    /// True if all joints are at rest just before, and just after.
    rest: [bool; 2],
}

/// Cuts a plan into pauses and stretches at the instants of rest, in order of time; together they take all of its
/// duration.
///
/// # Errors
/// [`Refusal::Degree`] for a curve whose polynomials are of a degree too high to be composed with a time law.
pub(super) fn parts(tracks: &Tracks) -> Result<Vec<Part>, Refusal> {
    let moving = moving(tracks);
    let cuts: Vec<Instant> =
        instants(tracks, &moving).into_iter().filter(|i| i.stop || i.rest == [true; 2]).collect();
    let mut parts: Vec<Part> = Vec::new();
    for pair in cuts.windows(2) {
        let (from, to) = (pair[0].time, pair[1].time);
        let within = within(&moving, from, to);
        if within.is_empty() {
            parts.push(Part::Pause { from, to });
            continue;
        }
        let start = tracks.state(from).joints;
        let free = [pair[0].rest[1], pair[1].rest[0]];
        let stretch = match straight(&within, &start, from, to) {
            Some(stretch) => stretch,
            None => curve(within, start, from, to, free, tracks)?,
        };
        let event = tracks.events.iter().any(|event| event.time == from);
        match parts.last_mut() {
            Some(Part::Stretch(before)) if !event && before.continues_in(&stretch) => before.append(stretch),
            _ => parts.push(Part::Stretch(stretch)),
        }
    }
    Ok(parts)
}

/// Returns the tracks without the segments, and the joints, that do not move.
fn moving(tracks: &Tracks) -> Vec<Track> {
    let moves = |s: &&Segment| s.control.iter().any(|c| *c != s.control[0]);
    let track =
        |t: &Track| Track { joint: t.joint, segments: t.segments.iter().filter(moves).cloned().collect() };
    tracks.tracks.iter().map(track).filter(|t| !t.segments.is_empty()).collect()
}

/// Returns the instants of a plan at which segments of moving joints begin or end, or bonds change, with 0 and the end,
/// ascending.
fn instants(tracks: &Tracks, moving: &[Track]) -> Vec<Instant> {
    let tol = TOLERANCES.velocity;
    let all = Tracks { tracks: moving.to_vec(), ..tracks.clone() }.instants();
    let instant = |time: f64| {
        let (mut stop, mut rest) = (time == 0.0 || time == tracks.duration, [true; 2]);
        stop |= tracks.events.iter().any(|event| event.time == time);
        for track in moving {
            let next = track.segments.partition_point(|s| s.end <= time);
            let after = track.segments.get(next).filter(|s| s.start <= time);
            let last = track.segments.partition_point(|s| s.start < time);
            let before = last.checked_sub(1).map(|i| &track.segments[i]).filter(|s| s.end >= time);
            let [before, after] = [before, after].map(|s| s.map_or(0.0, |s| s.velocity(time)));
            stop |= (after - before).abs() > tol;
            rest[0] &= before.abs() <= tol;
            rest[1] &= after.abs() <= tol;
        }
        Instant { time, stop, rest }
    };
    all.into_iter().map(instant).collect()
}

/// Returns the tracks between two times, without those that do not move then. Times stay those of the plan.
fn within(moving: &[Track], from: f64, to: f64) -> Vec<Track> {
    let track = |t: &Track| {
        let first = t.segments.partition_point(|s| s.end <= from);
        let segments = t.segments[first..].iter().take_while(|s| s.start < to);
        Track { joint: t.joint, segments: segments.filter_map(|s| s.between(from, to)).collect() }
    };
    moving.iter().map(track).filter(|t| !t.segments.is_empty()).collect()
}

/// Returns the stretch between two times of the plan (s) if its path is a straight line in the space of joints, up to
/// `TOLERANCES.straight`, along which no joint turns back; `None` otherwise. `start`: the positions of all joints at
/// `from`, rad or m.
fn straight(tracks: &[Track], start: &[f64], from: f64, to: f64) -> Option<Stretch> {
    let displacement = |t: &Track| t.segments.last().map_or(0.0, Segment::last) - start[t.joint.0 as usize];
    let farther = |a, b| if displacement(b).abs() > displacement(a).abs() { b } else { a };
    let leader = tracks.iter().fold(&tracks[0], farther);
    let length = displacement(leader).abs();
    if length <= TOLERANCES.straight {
        return None;
    }
    let sign = displacement(leader).signum();
    let forward = |s: &Segment| derivative(&s.control).iter().all(|rate| sign * rate >= 0.0);
    if !leader.segments.iter().all(forward) {
        return None;
    }
    let mut path = Vec::with_capacity(tracks.len());
    for track in tracks {
        let at = start[track.joint.0 as usize];
        let ratio = displacement(track) / displacement(leader);
        let aligned = leader.segments.iter().all(|s| {
            let origin = start[leader.joint.0 as usize];
            follows(track, at, s, origin, ratio)
        });
        let inside = track.segments.iter().all(|s| covered(&leader.segments, s));
        if !aligned || !inside {
            return None;
        }
        path.push(lines(track, leader, start));
    }
    let places = Places::Distances(vec![(0.0, leader.segments.clone())]);
    Some(Stretch { from, to, start: start.to_vec(), path, length, straight: true, free: [false; 2], places })
}

/// Returns true if at each instant of a segment of the leader a joint has gone `ratio` times as far from `at` as the
/// leader from `origin`, up to `TOLERANCES.straight` (rad or m).
fn follows(track: &Track, at: f64, leader: &Segment, origin: f64, ratio: f64) -> bool {
    let mut cuts = vec![leader.start, leader.end];
    let ends = track.segments.iter().flat_map(|s| [s.start, s.end]);
    cuts.extend(ends.filter(|t| leader.start < *t && *t < leader.end));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts.windows(2).all(|cut| {
        let Some(of_leader) = leader.between(cut[0], cut[1]) else { return true };
        let own = match track.segments.iter().find_map(|s| s.between(cut[0], cut[1])) {
            Some(piece) => piece.control,
            None => vec![track.position(at, cut[0])],
        };
        let degree = own.len().max(of_leader.control.len()) - 1;
        let (own, of_leader) = (elevated(&own, degree), elevated(&of_leader.control, degree));
        let off = |(q, p): (&f64, &f64)| ((q - at) - ratio * (p - origin)).abs();
        own.iter().zip(&of_leader).all(|pair| off(pair) <= TOLERANCES.straight)
    })
}

/// Returns true if there is a segment of a list, in order of time, at each instant of another segment.
fn covered(list: &[Segment], segment: &Segment) -> bool {
    let mut reached = segment.start;
    for s in list.iter().filter(|s| s.end > segment.start) {
        if s.start <= reached {
            reached = s.end;
        }
    }
    reached >= segment.end
}

/// Returns a track of a straight stretch over the distance that its leader has gone: a line for each of its segments.
/// `start`: the positions of all joints at the beginning, rad or m.
fn lines(track: &Track, leader: &Track, start: &[f64]) -> Track {
    let origin = start[leader.joint.0 as usize];
    let distance = |t: f64| (leader.position(origin, t) - origin).abs();
    let mut at = start[track.joint.0 as usize];
    let mut reached = 0.0;
    let mut segments = Vec::with_capacity(track.segments.len());
    for s in &track.segments {
        let end = distance(s.end);
        if end > reached {
            segments.push(Segment { start: reached, end, control: vec![at, s.last()], cause: s.cause });
            (reached, at) = (end, s.last());
        }
    }
    Track { joint: track.joint, segments }
}

/// Returns a stretch between two times of the plan (s) over the plan's own time.
///
/// # Errors
/// [`Refusal::Degree`] for the first segment whose degree is too high to be doubled by a time law.
fn curve(
    mut path: Vec<Track>,
    start: Vec<f64>,
    from: f64,
    to: f64,
    free: [bool; 2],
    tracks: &Tracks,
) -> Result<Stretch, Refusal> {
    for track in &mut path {
        for s in &mut track.segments {
            let degree = s.control.len() - 1;
            if 2 * degree > DEGREE_MAX {
                let joint = tracks.robot.name_of(track.joint);
                return Err(Refusal::Degree { joint, time: s.start, degree });
            }
            (s.start, s.end) = (s.start - from, s.end - from);
        }
    }
    let length = to - from;
    Ok(Stretch { from, to, start, path, length, straight: false, free, places: Places::Time })
}

impl Stretch {
    /// Returns the parameter of the path (rad, m or s, as [`Stretch::path`] says) at a time of the plan (s), which is
    /// clamped to the stretch.
    pub(super) fn place(&self, time: f64) -> f64 {
        let time = time.clamp(self.from, self.to);
        match &self.places {
            Places::Time => time - self.from,
            Places::Distances(distances) => {
                let begun = distances.iter().rev().find(|(_, segments)| segments[0].start <= time);
                let Some((before, segments)) = begun else { return 0.0 };
                let origin = segments[0].control[0];
                let last = segments.partition_point(|s| s.start <= time).max(1);
                before + (segments[last - 1].position(time) - origin).abs()
            }
        }
    }

    /// Returns true if another stretch goes on in the same direction, both straight.
    fn continues_in(&self, next: &Stretch) -> bool {
        let tol = TOLERANCES.direction;
        self.straight
            && next.straight
            && self.path.len() == next.path.len()
            && self
                .path
                .iter()
                .zip(&next.path)
                .all(|(a, b)| a.joint == b.joint && (self.slope(a) - next.slope(b)).abs() <= tol)
    }

    /// Returns the derivative of a joint's position by the parameter on a straight path, the mean over the stretch: rad
    /// or m of the joint per rad or m of the leader.
    pub(super) fn slope(&self, track: &Track) -> f64 {
        let displacement = |s: &Segment| s.last() - s.control[0];
        track.segments.iter().map(displacement).sum::<f64>() / self.length
    }

    /// Appends a straight stretch that goes on in the same direction.
    fn append(&mut self, next: Stretch) {
        for (track, more) in self.path.iter_mut().zip(next.path) {
            track.segments.extend(more.segments.into_iter().map(|s| Segment {
                start: s.start + self.length,
                end: s.end + self.length,
                ..s
            }));
        }
        if let (Places::Distances(distances), Places::Distances(more)) = (&mut self.places, next.places) {
            distances.extend(more.into_iter().map(|(before, segments)| (before + self.length, segments)));
        }
        (self.length, self.to) = (self.length + next.length, next.to);
    }

    /// Returns the parameters (rad, m or s) at which a piece of the path of any joint begins or ends, ascending and
    /// each once, with 0 and `length`.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let ends = self.path.iter().flat_map(|t| t.segments.iter().flat_map(|s| [s.start, s.end]));
        let mut all: Vec<f64> = ends.chain([0.0, self.length]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
