//! Foldings of more turns than hinges, where no order of whole turns is free of collisions: hinges stop on their way, others
//! fold, and they go on later.
//!
//! The way of each hinge from level to its fold angle is divided into equal parts, whose ends are its *stations*. A state
//! is a station for each hinge, and A* (Hart, Nilsson, Raphael 1968) finds a series of the fewest turns of one hinge at a
//! time from the flat pattern to the folded shape; a hinge that is not yet folded needs one turn at least. Stations
//! are made finer, from two parts on. No hinge turns back, so the search ends.
//!
//! Two panels meet or pass while a hinge goes from one station to the next by the hinges between the two alone. So what
//! samples show is remembered for each pair by the stations of these, not for whole states. The judge decides on what is
//! found; where it refuses a turn, the part of the way on which it does is barred, and another series is sought.

use super::branch_and_bound::{self, Decision};
use super::layout::Layout;
use super::load_limits::LoadLimits;
use super::proposals::Proposals;
use super::refusal::Refusal;
use super::sweep_collision::SweepCheck;
use super::target::Target;
use super::task::{Outcome, Task};
use super::turns::Stop;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// The numbers of parts into which the way of a hinge is divided, one after the other.
const PARTS: [u8; 5] = [2, 4, 8, 16, 32];

/// The number of states that are sampled of a whole way, evenly in the angle; but at least [`SAMPLES_MIN`] of each part.
const SAMPLES: usize = 48;
/// The least number of states that are sampled of a part of a way.
const SAMPLES_MIN: usize = 3;

/// The number of samples of pairs of panels in all; a pair that is looked up counts as one, and so does a panel in a sample
/// of limits.
const PAIRS_MAX: usize = 4_000_000;

/// The number of states that one search may reach.
const STATES_MAX: usize = 200_000;

/// The greatest number of layouts that are tried, in order of their value with the leaves first.
const LAYOUTS_MAX: usize = 8;

/// The number of series of one layout, with stations of one fineness, that are put before the judge.
const JUDGED_MAX: usize = 8;

/// The station of every hinge, by face: how many parts of its way are behind it. That of the root is 0.
type Stations = Vec<u8>;

/// A turn of one hinge from one station to another.
#[derive(Clone, Copy)]
struct Run {
    face: usize,
    from: u8,
    to: u8,
}

impl Task<'_> {
    /// Returns a folding in which hinges stop on their way, of the fewest turns that the stations allow for the first
    /// layout for which there is one that the judge lets through; `None` if none was found. `found`: the layouts known
    /// so far, and the search for more.
    ///
    /// # Errors
    /// A [`Refusal`] that holds for every layout, as [`Task::judged`] says.
    pub(super) fn with_stops(&self, found: &Proposals) -> Result<Option<Outcome>, Refusal> {
        let layouts = self.first_layouts(found);
        let limits = self.load_limits();
        let mut pairs_left = PAIRS_MAX;
        let mut searches_left = PARTS.len() * layouts.len();
        for parts in PARTS {
            for layout in &layouts {
                if !self.observer.should_continue() {
                    return Ok(None);
                }
                let share = pairs_left / searches_left;
                searches_left -= 1;
                let check = SweepCheck::thick(self.target, layout, &self.panels.solids);
                let mut search =
                    StationSearch::new(self.target, layout, check, limits.as_ref(), parts, share);
                let outcome = self.of_stations(layout, &mut search)?;
                if outcome.is_some() {
                    return Ok(outcome);
                }
                pairs_left -= share - search.pairs_left;
            }
        }
        Ok(None)
    }

    /// Returns the first layouts in order of their value.
    fn first_layouts(&self, found: &Proposals) -> Vec<Layout> {
        let mut layouts: Vec<Layout> = found.layouts.iter().take(LAYOUTS_MAX).cloned().collect();
        if let Some(settings) = found.next_best() {
            let mut decide = |layout: &Layout| {
                if !layouts.contains(layout) {
                    layouts.push(layout.clone());
                }
                if layouts.len() >= LAYOUTS_MAX { Decision::Stop } else { Decision::Refuse }
            };
            let weights = &self.objective.weights;
            // All that it proposes is refused, so that it goes on to the next: the layouts are kept on the way.
            let _ =
                branch_and_bound::search(self.target, weights, &settings, Some(&mut decide), self.observer);
        }
        layouts
    }

    /// Puts series of turns of a layout before the judge until it lets one through.
    fn of_stations(&self, layout: &Layout, search: &mut StationSearch) -> Result<Option<Outcome>, Refusal> {
        for _ in 0..JUDGED_MAX {
            let Some(runs) = search.fewest_turns() else { return Ok(None) };
            let steps: Vec<Vec<usize>> = runs.iter().map(|run| vec![run.face]).collect();
            let is_stop = |run: &Run| run.to < search.parts;
            let stop = |(step, run): (usize, &Run)| {
                is_stop(run).then(|| Stop { step, face: run.face, angle: search.angle(run.face, run.to) })
            };
            let stops: Vec<Stop> = runs.iter().enumerate().filter_map(stop).collect();
            match self.judged_with_stops(layout, &steps, &stops)? {
                Ok(solution) => {
                    return Ok(Some(Outcome { solution, layout: layout.clone(), steps, stops }));
                }
                Err(failure) => search.bar(&runs, failure.time / self.conventions.step),
            }
        }
        Ok(None)
    }
}

/// The states that a search has reached: the turns that each takes, and the last of them with the state before it; none of
/// the flat pattern.
type Reached = BTreeMap<Stations, (usize, Option<(Stations, Run)>)>;

/// Two panels without a common hinge of the layout.
struct Pair {
    faces: [usize; 2],
    /// The faces whose hinges are between the two.
    between: Vec<usize>,
}

/// A part of a way that panels pass: the pair (an index), the face whose hinge turns, and the stations of the hinges
/// between the two.
type Passage = (usize, usize, Stations);

/// The search for the fewest turns of one layout with stations of one fineness.
struct StationSearch<'t> {
    target: &'t Target,
    layout: &'t Layout,
    check: SweepCheck<'t>,
    limits: Option<&'t LoadLimits>,
    /// The number of parts of the way of each hinge.
    parts: u8,
    /// The folded shape: every hinge that folds at its last station.
    folded: Stations,
    pairs: Vec<Pair>,
    /// For each face the pairs (indices) that its hinge is between.
    parted: Vec<Vec<usize>>,
    /// The passages that were sampled, and whether nothing meets on them.
    passages: BTreeMap<Passage, bool>,
    /// True for the parts of ways on which limits are kept: the stations at which each begins, and the face whose hinge turns. Parts
    /// on which the judge has refused a turn are here, too.
    kept: BTreeMap<(Stations, usize), bool>,
    /// The number of pairs of panels that may still be sampled or looked up.
    pairs_left: usize,
}

impl<'t> StationSearch<'t> {
    fn new(
        target: &'t Target,
        layout: &'t Layout,
        check: SweepCheck<'t>,
        limits: Option<&'t LoadLimits>,
        parts: u8,
        pairs_left: usize,
    ) -> StationSearch<'t> {
        let faces = layout.parent.len();
        let folds = |face: usize| layout.angle(target, face) != 0.0;
        let folded = (0..faces).map(|face| if folds(face) { parts } else { 0 }).collect();
        let pair = |[a, b]: [usize; 2]| {
            let is_between = |face: &usize| layout.is_above(*face, a) != layout.is_above(*face, b);
            Pair { faces: [a, b], between: (0..faces).filter(is_between).collect() }
        };
        // Panels on a common hinge are built to touch.
        let pairs: Vec<Pair> = (0..faces)
            .flat_map(|b| (0..b).map(move |a| [a, b]))
            .map(pair)
            .filter(|pair| pair.between.len() > 1)
            .collect();
        let mut parted = vec![Vec::new(); faces];
        for (index, pair) in pairs.iter().enumerate() {
            pair.between.iter().for_each(|face| parted[*face].push(index));
        }
        let (passages, kept) = (BTreeMap::new(), BTreeMap::new());
        StationSearch {
            target,
            layout,
            check,
            limits,
            parts,
            folded,
            pairs,
            parted,
            passages,
            kept,
            pairs_left,
        }
    }

    /// Returns the angle of the hinge of a face at a station, rad.
    fn angle(&self, face: usize, station: u8) -> f64 {
        self.angle_at(face, f64::from(station))
    }

    /// Returns the angle of the hinge of a face when so many parts of its way are behind it, rad.
    fn angle_at(&self, face: usize, parts: f64) -> f64 {
        self.layout.angle(self.target, face) * (parts / f64::from(self.parts))
    }

    /// Returns the fewest turns that lead from the flat pattern to the folded shape; `None` if none do, or no more pairs
    /// may be sampled. Among series of as many turns those that are nearer to the end are followed first.
    fn fewest_turns(&mut self) -> Option<Vec<Run>> {
        let flat: Stations = vec![0; self.folded.len()];
        let mut reached = Reached::new();
        let mut open = BinaryHeap::new();
        reached.insert(flat.clone(), (0, None));
        open.push(Reverse(self.estimate(0, flat)));
        while let Some(Reverse((_, _, turns, at))) = open.pop() {
            if at == self.folded {
                return Some(traced(&reached, at));
            }
            if reached[&at].0 < turns {
                continue;
            }
            for face in 0..at.len() {
                let mut next = at.clone();
                while next[face] < self.folded[face] && self.is_way_clear(&next, face)? {
                    next[face] += 1;
                    let more = turns + 1;
                    if reached.get(&next).is_none_or(|(known, _)| more < *known) {
                        if reached.len() == STATES_MAX {
                            return None;
                        }
                        let run = Run { face, from: at[face], to: next[face] };
                        reached.insert(next.clone(), (more, Some((at.clone(), run))));
                        open.push(Reverse(self.estimate(more, next.clone())));
                    }
                }
            }
        }
        None
    }

    /// Returns a state with what it is ordered by: the least number of turns of a series through it, the parts of ways that
    /// are left, and the turns that led to it.
    fn estimate(&self, turns: usize, at: Stations) -> (usize, usize, usize, Stations) {
        let left = self.folded.iter().zip(&at).map(|(end, station)| usize::from(end - station));
        let open = left.clone().filter(|left| *left > 0).count();
        (turns + open, left.sum(), turns, at)
    }

    /// Returns true if no sample shows a collision or a violated limit while the hinge of a face goes on to its next
    /// station, and the judge has not refused that; `None` if no more pairs may be sampled.
    fn is_way_clear(&mut self, at: &Stations, face: usize) -> Option<bool> {
        self.pairs_left = self.pairs_left.checked_sub(1 + self.parted[face].len())?;
        let way = (at.clone(), face);
        if self.kept.get(&way) == Some(&false) || !self.are_passages_clear(at, face)? {
            return Some(false);
        }
        if self.limits.is_none() || self.kept.contains_key(&way) {
            return Some(true);
        }
        self.pairs_left = self.pairs_left.checked_sub(self.samples() * at.len())?;
        let is_within = self.is_within_limits(at, face);
        self.kept.insert(way, is_within);
        Some(is_within)
    }

    /// Returns true if no sample shows that panels meet; `None` if no more pairs may be sampled.
    fn are_passages_clear(&mut self, at: &Stations, face: usize) -> Option<bool> {
        let mut unknown = Vec::new();
        for &pair in &self.parted[face] {
            let between = self.pairs[pair].between.iter().map(|face| at[*face]).collect();
            let passage = (pair, face, between);
            match self.passages.get(&passage) {
                Some(false) => return Some(false),
                Some(true) => {}
                None => unknown.push((passage, true)),
            }
        }
        if unknown.is_empty() {
            return Some(true);
        }
        let samples = self.samples();
        self.pairs_left = self.pairs_left.checked_sub(samples * unknown.len())?;
        for sample in 1..=samples {
            let state = self.check.state(|hinge| self.sampled(at, face, hinge, sample));
            for ((pair, _, _), is_clear) in unknown.iter_mut().filter(|(_, is_clear)| *is_clear) {
                *is_clear = !self.check.meet(&state, self.pairs[*pair].faces);
            }
        }
        let are_clear = unknown.iter().all(|(_, is_clear)| *is_clear);
        self.passages.extend(unknown);
        Some(are_clear)
    }

    /// Returns true if no sample shows a violated limit of ground or hinges, or there are none.
    fn is_within_limits(&self, at: &Stations, face: usize) -> bool {
        let Some(limits) = self.limits else { return true };
        (1..=self.samples()).all(|sample| {
            let state = self.check.state(|hinge| self.sampled(at, face, hinge, sample));
            limits.violation_at(self.target, self.layout, &state.poses).is_none()
        })
    }

    /// Returns the number of states that are sampled of a part of a way.
    fn samples(&self) -> usize {
        (SAMPLES / usize::from(self.parts)).max(SAMPLES_MIN)
    }

    /// Returns the angle of a hinge, rad, in a sample of the part of a way that begins at these stations, on which the
    /// hinge of `face` turns.
    fn sampled(&self, at: &Stations, face: usize, hinge: usize, sample: usize) -> f64 {
        let part = if hinge == face { sample as f64 / self.samples() as f64 } else { 0.0 };
        self.angle_at(hinge, f64::from(at[hinge]) + part)
    }

    /// Bars the part of a way on which the judge has refused a series of turns; `steps`: the time of the failure, in
    /// steps since the beginning.
    fn bar(&mut self, runs: &[Run], steps: f64) {
        let index = (steps as usize).min(runs.len() - 1);
        let mut at: Stations = vec![0; self.folded.len()];
        runs[..index].iter().for_each(|run| at[run.face] = run.to);
        let Run { face, from, to } = runs[index];
        let done = super::simulation::quintic((steps - index as f64).clamp(0.0, 1.0), 1.0).angle;
        let parts = (done * f64::from(to - from)) as u8;
        at[face] = (from + parts).min(to - 1);
        self.kept.insert((at, face), false);
    }
}

/// Returns the turns that led to a state.
fn traced(reached: &Reached, mut at: Stations) -> Vec<Run> {
    let mut runs = Vec::new();
    while let Some((before, run)) = &reached[&at].1 {
        runs.push(*run);
        at.clone_from(before);
    }
    runs.reverse();
    runs
}
