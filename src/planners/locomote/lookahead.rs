//! Lookahead: every step policy is rolled out for some steps, and the one that makes the fastest progress is
//! taken. If all get stuck, the search backtracks to the second best of an earlier choice (a depth-first search
//! with a bounded memory).

use super::objective::Objective;
use super::rollout::{End, Monitor, Rollout, StepPolicy};
use std::collections::VecDeque;

/// The number of choices that are remembered to backtrack to.
const CHOICES_KEPT: usize = 12;
/// The greatest number of backtracks in all.
const BACKTRACKS_MAX: usize = 20;

/// A rollout with its end; `None` if it may go on.
type Tried<'a> = (Rollout<'a>, Option<End>);

/// Continues a rollout to its end by depth-first search with lookahead: the step policy that makes the fastest progress
/// is taken, and a dead end leads back to an earlier choice. Returns the rollout at its end: arrival, the limit of
/// steps, or an end by `monitor`; if all policies get stuck, relaxed steps go on from where the least distance is left.
pub(super) fn search<'a>(rollout: Rollout<'a>, monitor: &mut Monitor) -> Rollout<'a> {
    let mut alternatives: VecDeque<Vec<Tried<'a>>> = VecDeque::new();
    let mut backtracks = 0;
    // The one with the least distance left of those that got stuck.
    let mut stuck: Option<Rollout<'a>> = None;
    let mut now = rollout;
    loop {
        // Roll out every policy.
        let mut tried: Vec<Tried<'a>> = Vec::new();
        for policy in policies(&now) {
            let mut rollout = now.clone();
            rollout.policy = policy;
            let end = rollout.advance_steps(now.settings.lookahead, monitor);
            if matches!(end, Some(End::Cancelled | End::Steps)) {
                return ended(rollout, end);
            }
            tried.push((rollout, end));
        }
        // Sort from the best to the worst; of equal ones the first comes first.
        let worth = |(rollout, _): &Tried| progress_rate(&now, rollout);
        tried.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
        let (open, closed): (Vec<_>, Vec<_>) =
            tried.into_iter().partition(|(_, end)| matches!(end, None | Some(End::Arrived)));
        for (rollout, end) in closed {
            if stuck.as_ref().is_none_or(|known| rollout.distance_left() < known.distance_left()) {
                stuck = Some(ended(rollout, end));
            }
        }
        alternatives.push_back(open);
        if alternatives.len() > CHOICES_KEPT {
            alternatives.pop_front();
        }
        // Take the best open alternative of the latest choice that has one.
        let next = loop {
            match alternatives.back_mut() {
                None => return without_lookahead(stuck.unwrap_or(now), monitor),
                Some(open) if open.is_empty() => {
                    alternatives.pop_back();
                    backtracks += 1;
                    if backtracks > BACKTRACKS_MAX {
                        return without_lookahead(stuck.unwrap_or(now), monitor);
                    }
                }
                Some(open) => break open.remove(0),
            }
        };
        now = match next {
            (rollout, None) => rollout,
            (rollout, end) => return ended(rollout, end),
        };
    }
}

/// Continues with fallbacks as without lookahead, where every choice got stuck.
fn without_lookahead<'a>(mut rollout: Rollout<'a>, monitor: &mut Monitor) -> Rollout<'a> {
    rollout.allow_fallbacks = true;
    let end = rollout.advance_steps(usize::MAX, monitor);
    ended(rollout, end)
}

/// Returns a rollout with its end; without one its steps are used up.
fn ended(mut rollout: Rollout, end: Option<End>) -> Rollout {
    rollout.travel.end = end.unwrap_or(End::Steps);
    rollout
}

/// Returns the policies to try: the present one, those with other objectives, and one that places nodes
/// before it would roll.
fn policies(rollout: &Rollout) -> Vec<StepPolicy> {
    let StepPolicy { objective, impact, thorough } = rollout.policy;
    let own = rollout.settings.objective;
    let objectives = [objective, own, Objective::Springs, Objective::LENGTHS, Objective::RESTORING];
    let mut found: Vec<StepPolicy> = Vec::new();
    let with_impact = rollout.settings.impact;
    let others =
        objectives.into_iter().map(|objective| StepPolicy { objective, impact: with_impact, thorough });
    let present = StepPolicy { objective, impact, thorough };
    for policy in
        [present].into_iter().chain(others).chain([StepPolicy { objective, impact: false, thorough }])
    {
        if !found.contains(&policy) {
            found.push(policy);
        }
    }
    found
}

/// Returns the distance by which a rollout came nearer to the end of its path, over the time of its motion,
/// m/s.
fn progress_rate(from: &Rollout, to: &Rollout) -> f64 {
    (from.distance_left() - to.distance_left())
        / (to.travel.duration - from.travel.duration).max(f64::MIN_POSITIVE)
}
