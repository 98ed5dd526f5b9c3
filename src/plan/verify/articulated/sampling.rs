//! Sample times of a plan: every instant at which something begins or ends, and between those often enough
//! that no joint turns far from one sample to the next.

use super::tolerances::Tolerances;
use crate::plan::{Exemption, Settings, Tracks, WorldFrom};
use crate::robot::JointId;

/// Returns the instants (s) of a rollout that are samples whatever the settings are, ascending, each once: its start and
/// end, the ends of segments, dockings, changes of the world, and the ends of exemptions. `from`: the start of the rollout, s.
pub(super) fn instants(
    tracks: &Tracks,
    from: f64,
    worlds: &[WorldFrom],
    exemptions: &[Exemption],
) -> Vec<f64> {
    let mut all = tracks.instants();
    all.push(from);
    all.extend(worlds.iter().map(|w| w.from));
    all.extend(exemptions.iter().flat_map(|e| [e.from, e.to]));
    all.retain(|t| (from..=tracks.duration).contains(t));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Returns the number of samples from `t0` (left out) to `t1` (s), two neighbouring instants: as many as keep samples
/// no farther apart in time than `settings.sample`, and joints moving no farther between them than
/// `tolerances.turn_sample` (rad or m). 0 where no joint moves.
pub(super) fn divisions(
    tracks: &Tracks,
    t0: f64,
    t1: f64,
    settings: &Settings,
    tolerances: &Tolerances,
) -> usize {
    let travel = tracks.tracks.iter().map(|track| travel(tracks, track.joint, t0, t1)).fold(0.0, f64::max);
    if travel == 0.0 {
        return 0;
    }
    let by_time = libm::ceil((t1 - t0) / settings.sample - tolerances.sample_count);
    let by_turn = libm::ceil(travel / tolerances.turn_sample - tolerances.sample_count);
    // Beyond the range of whole numbers the greatest one.
    by_time.max(by_turn).max(1.0) as usize
}

/// Returns the number of samples of a rollout, without those by which it halves a step. `instants`: those that
/// [`instants`] returns.
pub(super) fn count(
    instants: &[f64],
    tracks: &Tracks,
    settings: &Settings,
    tolerances: &Tolerances,
) -> usize {
    let between = instants.windows(2).map(|w| divisions(tracks, w[0], w[1], settings, tolerances).max(1));
    between.fold(1, usize::saturating_add)
}

/// Returns an upper bound on the distance that a joint moves, back and forth, rad or m: the length of its control
/// polygon.
fn travel(tracks: &Tracks, joint: JointId, t0: f64, t1: f64) -> f64 {
    let Some(track) = tracks.track(joint) else { return 0.0 };
    let first = track.segments.partition_point(|s| s.end <= t0);
    let within = track.segments[first..].iter().take_while(|s| s.start < t1);
    let start = tracks.start.joints[joint.0 as usize];
    let mut sum = (track.position(start, t0) - before(tracks, joint, t0)).abs();
    for segment in within {
        let share = ((t1.min(segment.end) - t0.max(segment.start)) / (segment.end - segment.start)).min(1.0);
        if segment.control.iter().all(|c| *c == segment.control[0]) {
            continue;
        }
        let steps = segment.control.windows(2).map(|w| (w[1] - w[0]).abs());
        let degree = (segment.control.len() - 1) as f64;
        // The greatest rate over the share of time, and never more than the whole polygon.
        let fastest = steps.clone().fold(0.0, f64::max) * degree * share;
        sum += fastest.min(steps.sum());
    }
    sum
}

/// Returns the position just before a time: where the joint jumps, that before the jump.
fn before(tracks: &Tracks, joint: JointId, t: f64) -> f64 {
    let start = tracks.start.joints[joint.0 as usize];
    let Some(track) = tracks.track(joint) else { return start };
    let begun = track.segments.partition_point(|s| s.start < t);
    begun.checked_sub(1).map_or(start, |i| track.segments[i].position(t))
}

/// The number of ground features for which a sample counts once: a sample of a robot with k times as many takes longer,
/// and counts k times.
const FEATURES_PER_SAMPLE: usize = 100;

/// Returns the number of samples that the rollout of a robot may take: `samples_max` of the settings, divided by the
/// number of full hundreds of its ground `features` ([`Model::features`]) if there are any.
pub(super) fn samples_max(settings: &Settings, features: usize) -> usize {
    settings.samples_max / (features / FEATURES_PER_SAMPLE).max(1)
}
