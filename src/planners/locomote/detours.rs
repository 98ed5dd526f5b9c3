//! Detours: where a rollout gets stuck, it goes on from a few steps before by another objective, which brings the truss
//! there in another shape.

use super::objective::Objective;
use super::rollout::{End, Monitor, Rollout};

/// The number of steps after which a state is kept to go back to.
const STEPS_KEPT: usize = 20;
/// The greatest number of detours in all.
const DETOURS_MAX: usize = 24;

/// Continues a rollout to its end: arrival, the limit of steps, or an end by `monitor`; if all detours get stuck, that
/// which came nearest to the end of the path. Without fallbacks there are no detours.
pub(super) fn search<'a>(rollout: Rollout<'a>, monitor: &mut Monitor) -> Rollout<'a> {
    let own = rollout.policy.objective;
    let mut others = vec![Objective::RESTORING, Objective::Springs, Objective::LENGTHS];
    others.retain(|objective| *objective != own);
    others.push(own);
    let mut kept = vec![rollout.clone()];
    let mut now = rollout;
    let mut nearest: Option<Rollout<'a>> = None;
    let mut detours = 0;
    loop {
        let Some(end) = now.advance_steps(STEPS_KEPT, monitor) else {
            kept.push(now.clone());
            continue;
        };
        let over = matches!(end, End::Arrived | End::Steps | End::Cancelled);
        now.travel.end = end;
        if over {
            return now;
        }
        let settings = now.settings;
        if nearest.as_ref().is_none_or(|known| now.distance_left() < known.distance_left()) {
            nearest = Some(now);
        }
        // Every objective from the state before, then from ever earlier ones.
        if detours > 0 && detours % others.len() == 0 {
            kept.truncate(kept.len().saturating_sub(detours / others.len()).max(1));
        }
        let Some(before) = kept.last().filter(|_| settings.fallbacks && detours < DETOURS_MAX) else { break };
        now = before.clone();
        now.policy.objective = others[detours % others.len()];
        detours += 1;
    }
    nearest.unwrap_or_else(|| kept.swap_remove(0))
}
