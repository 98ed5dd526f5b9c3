//! Slowing down where the judge finds loads that are too great: for robots that stand on the ground, whose contact
//! forces no time law is linear in, for closed loops, and for the loads of bonds.

use super::motion::{Clock, Timed, tracks};
use super::tolerances::TOLERANCES;
use super::{Refusal, Settings};
use crate::plan::verify::verify;
use crate::plan::{CheckKind, Failure, Plan, Tracks, Verdict, is_full, retimed};
use crate::planners::Progress;

/// The greatest number of times that a stretch is slowed down, to 9 times its duration in all, before it counts as one
/// that no slowness helps.
const SLOWINGS_MAX: u32 = 15;

/// The number of bisections of the factors of slowed stretches.
const HALVINGS: usize = 3;

/// The result of [`slowed`]: the trajectory with the map of times, the greatest slowdown and the number of verdicts.
pub(super) struct Slowed {
    /// The joint trajectories of the slowed motion.
    pub(super) tracks: Tracks,
    /// The map from the times of the plan to those of the slowed motion.
    pub(super) clock: Clock,
    /// The greatest factor on the duration of a stretch by which it was slowed down; 1 if none was.
    pub(super) factor: f64,
    /// The number of verdicts that it took.
    pub(super) verdicts: usize,
}

/// A bracket of the factor on the duration of a stretch with which its loads are held.
#[derive(Clone, Copy)]
struct Bracket {
    /// The number of times that the stretch was slowed down.
    times: u32,
    /// The greatest factor that was found too small; 1 at first.
    low: f64,
    /// The least factor that was found great enough, or the one to be tried next; 1 at first.
    high: f64,
}

/// Returns the trajectory of a plan whose stretches are slowed down until the judge finds no load too great, if it is
/// judged under full dynamics; otherwise the trajectory by the time laws as they are.
///
/// # Errors
/// [`Refusal::Unholdable`] where a load is too great at any speed; [`Refusal::Stopped`] if `progress` ends the search.
pub(super) fn slowed(
    plan: &Plan,
    old: &Tracks,
    parts: &mut [Timed],
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Slowed, Refusal> {
    let mut brackets = vec![Bracket { times: 0, low: 1.0, high: 1.0 }; parts.len()];
    let mut trials = Trials { plan, old, reserve: settings.reserve, verdicts: 0, progress };
    if is_full(&plan.worlds) {
        trials.lengthen(parts, &mut brackets)?;
        trials.shorten(parts, &mut brackets)?;
    }
    let factor = brackets.iter().map(|bracket| bracket.high).fold(1.0, f64::max);
    let verdicts = trials.verdicts;
    let (tracks, clock) = tracks(old, parts);
    Ok(Slowed { tracks, clock, factor, verdicts })
}

/// Verdicts on slower and slower motions.
struct Trials<'a> {
    plan: &'a Plan,
    /// The tracks of the plan.
    old: &'a Tracks,
    /// The part of the limits of loads that is left unused, from 0 to below 1.
    reserve: f64,
    /// The number of verdicts so far.
    verdicts: usize,
    progress: &'a mut dyn Progress,
}

impl Trials<'_> {
    /// Returns the loads that the judge finds too great in a motion, with the reserve.
    ///
    /// # Errors
    /// [`Refusal::Stopped`].
    fn judge(&mut self, parts: &[Timed]) -> Result<Over, Refusal> {
        self.verdicts += 1;
        let verdicts = self.verdicts;
        self.progress.report(&|| format!("verdict {verdicts} on slower motions"));
        if !self.progress.should_continue() {
            return Err(Refusal::Stopped);
        }
        let (tracks, clock) = tracks(self.old, parts);
        let mut slower = retimed(self.plan, tracks, &|time| clock.at(time), self.reserve);
        slower.settings.reserve = self.reserve;
        Ok(overloaded(&verify(&slower), &clock, parts))
    }

    /// Slows stretches down, by steps that double, in which loads are too great, until none is.
    ///
    /// # Errors
    /// [`Refusal::Unholdable`], [`Refusal::Stopped`].
    fn lengthen(&mut self, parts: &mut [Timed], brackets: &mut [Bracket]) -> Result<(), Refusal> {
        loop {
            let over = self.judge(parts)?;
            let Some(first) = over.first else { return Ok(()) };
            let mut slower = false;
            for (index, bracket) in brackets.iter_mut().enumerate() {
                if over.parts[index] && bracket.times < SLOWINGS_MAX {
                    bracket.low = bracket.high;
                    bracket.high += TOLERANCES.slower * f64::from(1u32 << bracket.times);
                    bracket.times += 1;
                    set(&mut parts[index], bracket.high);
                    slower = true;
                }
            }
            if !slower {
                return Err(Refusal::Unholdable { failure: Box::new(first) });
            }
        }
    }

    /// Bisects the factor of each stretch that was slowed down more than once, between the greatest that was too small
    /// and the least that was great enough. All stretches are tried at a time, and a shorter one is kept only where no
    /// load of the whole motion is too great.
    ///
    /// # Errors
    /// [`Refusal::Stopped`].
    fn shorten(&mut self, parts: &mut [Timed], brackets: &mut [Bracket]) -> Result<(), Refusal> {
        let middle = |bracket: &Bracket| (bracket.low + bracket.high) / 2.0;
        for _ in 0..HALVINGS {
            if brackets.iter().all(|bracket| bracket.times < 2) {
                break;
            }
            for (part, bracket) in parts.iter_mut().zip(brackets.iter()).filter(|(_, b)| b.times > 1) {
                set(part, middle(bracket));
            }
            let over = self.judge(parts)?;
            for (index, bracket) in brackets.iter_mut().enumerate().filter(|(_, b)| b.times > 1) {
                let middle = middle(bracket);
                if over.parts[index] {
                    bracket.low = middle;
                } else if over.first.is_none() {
                    bracket.high = middle;
                }
            }
        }
        for (part, bracket) in parts.iter_mut().zip(brackets.iter()) {
            set(part, bracket.high);
        }
        Ok(())
    }
}

/// Sets the factor on the duration of a stretch; a pause stays.
fn set(part: &mut Timed, factor: f64) {
    if let Timed::Stretch(_, _, own) = part {
        *own = factor;
    }
}

/// The loads of a motion that are too great.
struct Over {
    /// The first of them; `None` if there is none.
    first: Option<Failure>,
    /// True for each part of the plan that is a stretch in which one is.
    parts: Vec<bool>,
}

/// Returns the loads of joints, bonds and balance that are too great by a verdict, and the stretches nearest to them.
fn overloaded(verdict: &Verdict, clock: &Clock, parts: &[Timed]) -> Over {
    let mut over = Over { first: None, parts: vec![false; parts.len()] };
    let loads = [CheckKind::Torque, CheckKind::BondLoad, CheckKind::Balance];
    let failures = verdict.failures.iter().filter(|failure| loads.contains(&failure.kind));
    for failure in failures {
        over.mark(clock, parts, failure.time, failure.until.unwrap_or(failure.time));
        over.first.get_or_insert_with(|| failure.clone());
    }
    over
}

impl Over {
    /// Marks the stretches between two new times (s), or the nearest one.
    fn mark(&mut self, clock: &Clock, parts: &[Timed], from: f64, to: f64) {
        let stretches: Vec<(usize, f64)> = clock
            .spans()
            .enumerate()
            .filter(|(index, _)| matches!(parts[*index], Timed::Stretch(..)))
            .map(|(index, (start, end))| (index, (start - to).max(from - end).max(0.0)))
            .collect();
        let nearest = stretches.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
        for (index, _) in stretches.iter().filter(|(_, distance)| *distance <= nearest) {
            self.parts[*index] = true;
        }
    }
}
