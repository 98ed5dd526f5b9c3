//! Intervals of time in which the joints move as in an earlier interval, as in all cycles of a gait but the first: the
//! links have the same relative poses there, so that what was proved of them before holds again.

use super::tolerances::NUMERICS;
use crate::plan::{DockingKind, Segment, Track, Tracks};
use crate::robot::JointId;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// The greatest number of comparisons of the motions of a joint; a plan that needs more counts as one that repeats nothing.
/// 4 million take some tenths of a second.
const COMPARISONS_MAX: usize = 4_000_000;

/// The intervals of a plan that repeat earlier ones.
#[derive(Clone, Debug, Default)]
pub(super) struct Repetition {
    /// The times between which no segment begins or ends and no bond changes, ascending, s. Empty where nothing repeats.
    cuts: Vec<f64>,
    /// For each of the cuts, the number of intervals before it that repeat no earlier interval.
    fresh: Vec<usize>,
}

/// The motion of a joint over an interval in which none of its segments begins or ends.
#[derive(Clone, Copy)]
enum LocalMotion<'a> {
    /// The joint stays at a position, rad or m.
    Rest(f64),
    /// The joint moves along a segment from that time (s) after the segment's start on.
    Moves(&'a Segment, f64),
}

impl Repetition {
    /// Returns the intervals of a plan after the time `from` (s) in which bonds hold and joints move as in an earlier interval
    /// after `from`. `tracks` must be valid, or it panics.
    pub(super) fn new(tracks: &Tracks, from: f64) -> Repetition {
        let mut cuts: Vec<f64> = tracks.instants().into_iter().filter(|t| *t > from).collect();
        cuts.insert(0, from);
        cuts.dedup_by(|later, earlier| *later - *earlier <= NUMERICS.motion_equal);
        let middles: Vec<f64> = cuts.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
        let Some(hashes) = hashes(tracks, &cuts, &middles) else { return Repetition::default() };
        let mut comparisons = 0;
        let mut first: BTreeMap<u64, usize> = BTreeMap::new();
        let mut fresh = vec![0];
        for (k, hash) in hashes.into_iter().enumerate() {
            let repeats = first.get(&hash).is_some_and(|&earlier| {
                comparisons += tracks.tracks.len() + 1;
                comparisons <= COMPARISONS_MAX && are_equal(tracks, (&cuts, &middles), earlier, k)
            });
            if !repeats {
                first.entry(hash).or_insert(k);
            }
            fresh.push(fresh[k] + usize::from(!repeats));
        }
        if fresh.last() == Some(&(cuts.len() - 1)) {
            return Repetition::default();
        }
        Repetition { cuts, fresh }
    }

    /// Returns true if bonds hold and joints move all through the interval `from..to` (s) as they do before `from`. False for
    /// an instant.
    pub(super) fn repeats(&self, from: f64, to: f64) -> bool {
        let first = self.cuts.partition_point(|t| *t <= from);
        let last = self.cuts.partition_point(|t| *t < to);
        from < to && first > 0 && last < self.cuts.len() && self.fresh[first - 1] == self.fresh[last]
    }
}

/// Returns true if two intervals between cuts, given by their numbers, are equally long, with the same bonds and motions.
/// `middles`: the middles of all intervals, s.
fn are_equal(tracks: &Tracks, (cuts, middles): (&[f64], &[f64]), a: usize, b: usize) -> bool {
    let length = |k: usize| cuts[k + 1] - cuts[k];
    let moves_equally = |track: &Track| {
        let start = tracks.start.joints[track.joint.0 as usize];
        let [before, after] = [a, b].map(|k| LocalMotion::of(track, start, cuts[k], middles[k]));
        before.equals(&after)
    };
    (length(a) - length(b)).abs() <= NUMERICS.motion_equal
        && tracks.bonds(middles[a]) == tracks.bonds(middles[b])
        && tracks.tracks.iter().all(moves_equally)
}

/// Returns a hash of each interval between neighbouring cuts, the same where bonds, length and motions are equal; `None`
/// where that needs more than [`COMPARISONS_MAX`] motions of joints. `middles`: the middles of the intervals, s.
fn hashes(tracks: &Tracks, cuts: &[f64], middles: &[f64]) -> Option<Vec<u64>> {
    let count = middles.len();
    // The number of the first interval whose middle is not before a time.
    let index = |time: f64| middles.partition_point(|middle| *middle < time);
    let mut hashes: Vec<u64> = (0..count).map(|k| hash_of(&rounded(cuts[k + 1] - cuts[k]))).collect();
    // The sums of hashes of joints at rest and of bonds that are added from each interval on.
    let mut lasting = vec![0_u64; count + 1];
    let mut comparisons = 0;
    for track in &tracks.tracks {
        let joint = track.joint;
        let rests = |position: f64| hash_of(&(joint.0, rounded(position)));
        let mut at_rest = rests(tracks.start.joints[joint.0 as usize]);
        let mut since = 0;
        for segment in &track.segments {
            let (begin, end) = (index(segment.start), index(segment.end));
            lasting[since] = lasting[since].wrapping_add(at_rest);
            lasting[begin] = lasting[begin].wrapping_sub(at_rest);
            comparisons += end.saturating_sub(begin) + 1;
            if comparisons > COMPARISONS_MAX {
                return None;
            }
            let shape = hash_of_shape(joint, segment);
            for k in begin..end {
                let moves = hash_of(&(shape, rounded(cuts[k] - segment.start)));
                hashes[k] = hashes[k].wrapping_add(moves);
            }
            (at_rest, since) = (rests(segment.last()), end);
        }
        lasting[since] = lasting[since].wrapping_add(at_rest);
    }
    for event in &tracks.events {
        let (bond, from) = (hash_of(&event.bond), index(event.time));
        lasting[from] = match event.kind {
            DockingKind::Dock => lasting[from].wrapping_add(bond),
            DockingKind::Undock => lasting[from].wrapping_sub(bond),
        };
    }
    let mut sum = 0_u64;
    for (hash, by) in hashes.iter_mut().zip(lasting) {
        sum = sum.wrapping_add(by);
        *hash = hash.wrapping_add(sum);
    }
    Some(hashes)
}

fn hash_of_shape(joint: JointId, segment: &Segment) -> u64 {
    let control: Vec<i64> = segment.control.iter().map(|c| rounded(*c)).collect();
    hash_of(&(joint.0, rounded(segment.end - segment.start), control))
}

fn rounded(value: f64) -> i64 {
    libm::round(value / NUMERICS.motion_grid) as i64
}

fn hash_of(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

impl<'a> LocalMotion<'a> {
    /// Returns the motion of a joint over an interval. `start`: its position at the start of the plan, rad or m; `from`, `middle`:
    /// the beginning and the middle of the interval, s.
    fn of(track: &'a Track, start: f64, from: f64, middle: f64) -> LocalMotion<'a> {
        match track.begun(middle).map(|index| &track.segments[index]) {
            None => LocalMotion::Rest(start),
            Some(segment) if segment.end <= middle => LocalMotion::Rest(segment.last()),
            Some(segment) => LocalMotion::Moves(segment, from - segment.start),
        }
    }

    fn equals(&self, other: &LocalMotion) -> bool {
        let equal = |a: f64, b: f64| (a - b).abs() <= NUMERICS.motion_equal;
        match (self, other) {
            (LocalMotion::Rest(a), LocalMotion::Rest(b)) => equal(*a, *b),
            (LocalMotion::Moves(a, since), LocalMotion::Moves(b, other)) => {
                equal(*since, *other)
                    && equal(a.end - a.start, b.end - b.start)
                    && a.control.len() == b.control.len()
                    && a.control.iter().zip(&b.control).all(|(a, b)| equal(*a, *b))
            }
            _ => false,
        }
    }
}
