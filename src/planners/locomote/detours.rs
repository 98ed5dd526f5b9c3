//! Detours: where a rollout gets stuck, it goes on from some steps before by another objective, or over other edges, which
//! brings the truss there in another shape.

use super::objective::Objective;
use super::rollout::{End, Monitor, Rollout};

/// The number of steps after which a state is kept to go back to.
const STEPS_KEPT: usize = 20;
/// The numbers of kept states that detours go back, in the order in which they are tried: farther where the truss got into a
/// bad shape long before.
const BACK: [usize; 5] = [1, 2, 4, 8, 16];
/// The greatest number of detours in all.
const DETOURS_MAX: usize = 60;
/// The distance, units, by which a detour has to come nearer to the end of the path than what got stuck, so that the search
/// goes on from it: ten strides, more than what slides along the same dead end.
const GAIN: f64 = 0.5;
/// The number of kept states one after another, none of them nearer by as much than the nearest before, after which a rollout goes
/// to and fro: more steps than it takes to put nodes down, to reshape the truss, or to go aside.
const IN_VAIN: usize = 10;
/// The distance to the side of the way, units, and half of it ahead, of the place that a detour aside goes to first: two or
/// three rolls, over other edges.
const ASIDE: f64 = 2.0;

/// Continues a rollout to its end: arrival, the limit of steps, or an end by `monitor`; if all detours get stuck, that
/// which came nearest to the end of the path, of those and of others with thorough steps. Without fallbacks there are no detours.
pub(super) fn search<'a>(mut rollout: Rollout<'a>, monitor: &mut Monitor) -> Rollout<'a> {
    let found = searched(rollout.clone(), monitor);
    if rollout.policy.thorough || !rollout.settings.fallbacks || !is_stuck(&found) {
        return found;
    }
    rollout.policy.thorough = true;
    let thorough = searched(rollout, monitor);
    if thorough.distance_left() < found.distance_left() { thorough } else { found }
}

/// Continues a rollout to its end, as [`search`] does, with steps as its policy has them.
fn searched<'a>(rollout: Rollout<'a>, monitor: &mut Monitor) -> Rollout<'a> {
    let ways = ways(rollout.policy.objective);
    let mut trail = vec![rollout.clone()];
    let mut nearest = followed(rollout, &mut trail, monitor);
    let gain = GAIN * nearest.truss.unit;
    let mut detours = if nearest.settings.fallbacks { DETOURS_MAX } else { 0 };
    'stuck: while is_stuck(&nearest) {
        // The farthest goes back to the start, where nothing bad has happened yet.
        let mut starts = BACK.map(|back| trail.len().saturating_sub(back)).to_vec();
        starts.dedup();
        for (from, &(objective, aside)) in
            starts.iter().flat_map(|from| ways.iter().map(move |way| (*from, way)))
        {
            if detours == 0 {
                break 'stuck;
            }
            let mut now = trail[from].clone();
            // The same again would get stuck again.
            if (now.policy.objective, aside, now.aside) == (objective, 0.0, None) {
                continue;
            }
            detours -= 1;
            now.policy.objective = objective;
            now.go_aside(aside);
            let mut branch = Vec::new();
            let now = followed(now, &mut branch, monitor);
            if !is_stuck(&now) {
                return now;
            }
            if now.distance_left() < nearest.distance_left() - gain {
                trail.truncate(from + 1);
                trail.append(&mut branch);
                nearest = now;
                continue 'stuck;
            }
        }
        break;
    }
    nearest
}

/// Returns the ways in which detours go on from a state, in the order in which they are tried, each as (objective, distance to the
/// left in units): by what seldom gets stuck, then by `own` aside to the left and to the right, then by the other objectives, and by
/// `own` last. In the S of the paper in 72 directions under weight this takes less time than other objectives first.
fn ways(own: Objective) -> Vec<(Objective, f64)> {
    let straight = |objective| (objective, 0.0);
    let others = [Objective::LENGTHS, Objective::Springs].map(straight);
    let ways = [straight(Objective::RESTORING), (own, ASIDE), (own, -ASIDE)].into_iter().chain(others);
    ways.filter(|way| *way != straight(own)).chain([straight(own)]).collect()
}

/// Returns a rollout at its end, with its states on the way at the end of `trail`; one that goes to and fro as it was when it
/// had come nearest.
fn followed<'a>(
    mut rollout: Rollout<'a>,
    trail: &mut Vec<Rollout<'a>>,
    monitor: &mut Monitor,
) -> Rollout<'a> {
    let gain = GAIN * rollout.truss.unit;
    let (mut nearest, mut kept) = (rollout.kept(), trail.len());
    loop {
        if let Some(end) = rollout.advance_steps(STEPS_KEPT, monitor) {
            rollout.travel.end = end;
            return rollout;
        }
        if rollout.distance_left() < nearest.distance_left() - gain {
            (nearest, kept) = (rollout.kept(), trail.len() + 1);
        } else if trail.len() - kept == IN_VAIN {
            // Detours begin where it came no nearer.
            trail.truncate(kept);
            nearest.travel.end = End::ToAndFro;
            return nearest;
        }
        trail.push(rollout.kept());
    }
}

/// Returns true if a rollout ended where a detour may go on.
fn is_stuck(rollout: &Rollout) -> bool {
    !matches!(rollout.travel.end, End::Arrived | End::Steps | End::Cancelled)
}

impl Rollout<'_> {
    /// Makes the centre of mass go to a place beside the way to the next point of the path first, on the left by a distance
    /// in units, negative for right, and half of it ahead; straight on if it is 0.
    fn go_aside(&mut self, left: f64) {
        self.aside = None;
        let Some(place) = self.next_place().filter(|_| left != 0.0) else { return };
        let centre = self.truss.centre_of_mass(&self.x);
        let way = [place[0] - centre.x, place[1] - centre.y];
        let distance = libm::hypot(way[0], way[1]).max(f64::MIN_POSITIVE);
        let [ahead, left] = [left.abs() / 2.0, left].map(|part| part * self.truss.unit / distance);
        self.aside =
            Some([centre.x + way[0] * ahead - way[1] * left, centre.y + way[1] * ahead + way[0] * left]);
    }
}
