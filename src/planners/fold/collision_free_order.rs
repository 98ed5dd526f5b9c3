//! Depth-first search for a collision-free order of folding, where the usual orders collide.
//!
//! The folding is undone, one hinge after the other, back to the flat pattern: a depth-first search over the
//! sets of hinges that are still folded, with dead ends remembered. Most panels are obstacles to each other
//! when they are folded, so it is there that choices matter. Of the hinges that can be opened that one goes
//! first which a preferred order folds last. The order found is put into steps again: a hinge folds with the
//! one before it where neither carries the other and nothing meets.

use super::layout::Layout;
use super::load_limits::{LoadLimits, Violation};
use super::sweep_collision::{Solids, SweepCheck};
use super::target::Target;
use crate::interrupt;
use std::collections::{BTreeMap, BTreeSet};

/// One step: the hinges that have folded before it, and the face whose hinge folds in it.
type FoldStep = (Vec<bool>, usize);

/// The search for a collision-free order in which the hinges of one layout fold. Steps that the judge refused can be
/// forbidden; then it finds another order.
pub struct OrderSearch<'t> {
    layout: &'t Layout,
    target: &'t Target,
    check: SweepCheck<'t>,
    limits: Option<&'t LoadLimits>,
    free: BTreeMap<FoldStep, bool>,
    forbidden: BTreeSet<FoldStep>,
    /// The number of steps that [`order`](Self::order) may still sample; a step that was sampled before counts
    /// nothing.
    pub samples_left: usize,
    /// The least torque beyond the limit that a sampled step would have taken, N·m, and the face (index in
    /// [`Target::faces`]) that the overloaded hinge carries; `None` while none did.
    pub overload: Option<(f64, usize)>,
}

impl<'t> OrderSearch<'t> {
    /// Sets up the search; `limits`: the limits of ground and hinges under gravity, `None` without; `samples`: the
    /// greatest number of steps that [`order`](Self::order) samples in all. `target` and `layout`: the surface and
    /// how it is unfolded; `solids`: the panels with their thickness.
    pub fn new(
        target: &'t Target,
        layout: &'t Layout,
        solids: &Solids,
        limits: Option<&'t LoadLimits>,
        samples: usize,
    ) -> OrderSearch<'t> {
        let (free, forbidden) = (BTreeMap::new(), BTreeSet::new());
        let check = SweepCheck::thick(target, layout, solids);
        OrderSearch { layout, target, check, limits, free, forbidden, samples_left: samples, overload: None }
    }

    /// Returns all faces but the root (indices in [`Target::faces`]) in an order in which each can fold alone after
    /// those before it, as far as samples show; `None` if there is no such order or `samples_left` is used up.
    /// `preferred`: all faces but the root in the order that the result follows where it can.
    pub fn order(&mut self, preferred: &[usize]) -> Option<Vec<usize>> {
        let mut folded = vec![true; self.layout.parent.len()];
        folded[self.layout.root] = false;
        let mut dead: BTreeSet<Vec<bool>> = BTreeSet::new();
        // Opened so far; for each depth how many of the preferred were tried.
        let mut opened: Vec<usize> = Vec::new();
        let mut tried = vec![0];
        while opened.len() < preferred.len() {
            interrupt::checkpoint();
            let next = tried.last_mut().expect("one for each depth");
            let Some(&face) = preferred.iter().rev().nth(*next) else {
                dead.insert(folded.clone());
                tried.pop();
                folded[opened.pop()?] = true;
                continue;
            };
            *next += 1;
            if !folded[face] {
                continue;
            }
            folded[face] = false;
            if !dead.contains(&folded) && self.is_free(&folded, face)? {
                opened.push(face);
                tried.push(0);
            } else {
                folded[face] = true;
            }
        }
        opened.reverse();
        Some(opened)
    }

    /// Lays an order of faces (indices in [`Target::faces`]) into steps: a hinge folds with those before it if none of
    /// them carries another and no sample shows a collision or a violated limit. The result has one list of faces for
    /// each step, in the order of folding. Its samples do not count against [`samples_left`](Self::samples_left).
    pub fn steps(&self, order: &[usize]) -> Vec<Vec<usize>> {
        let mut folded = vec![false; self.layout.parent.len()];
        let mut steps: Vec<Vec<usize>> = Vec::new();
        for &face in order {
            if let Some(step) = steps.last_mut() {
                step.push(face);
                let apart = step[..step.len() - 1].iter().all(|other| !self.layout.comparable(face, *other));
                if apart && self.passes(&folded, step) {
                    continue;
                }
                step.pop();
                step.iter().for_each(|face| folded[*face] = true);
            }
            steps.push(vec![face]);
        }
        steps
    }

    /// Returns true if no sample of these steps, each a list of faces (indices in [`Target::faces`]) whose hinges fold
    /// at the same time, shows a collision or a violated limit. Its samples do not count against
    /// [`samples_left`](Self::samples_left).
    pub fn is_collision_free(&self, steps: &[Vec<usize>]) -> bool {
        let mut folded = vec![false; self.layout.parent.len()];
        steps.iter().all(|step| {
            let passes = self.passes(&folded, step);
            step.iter().for_each(|face| folded[*face] = true);
            passes
        })
    }

    /// Forbids the step at index `step` (from 0) of `order`, a list of faces: later calls of [`order`](Self::order) do
    /// not fold the hinge of that face when exactly the faces before it have folded. Panics if the order is not longer
    /// than `step`.
    pub fn forbid(&mut self, order: &[usize], step: usize) {
        let mut folded = vec![false; self.layout.parent.len()];
        order[..step].iter().for_each(|face| folded[*face] = true);
        self.forbidden.insert((folded, order[step]));
    }

    /// Returns true if a hinge can be opened; `None` where no more may be sampled.
    fn is_free(&mut self, folded: &[bool], face: usize) -> Option<bool> {
        let turn = (folded.to_vec(), face);
        if self.forbidden.contains(&turn) {
            return Some(false);
        }
        if let Some(&known) = self.free.get(&turn) {
            return Some(known);
        }
        self.samples_left = self.samples_left.checked_sub(1)?;
        if let Some(Violation::Overload { face, torque }) = self.violation(folded, &[face])
            && self.overload.is_none_or(|(least, _)| torque < least)
        {
            self.overload = Some((torque, face));
        }
        let is_free = self.passes(folded, &[face]);
        self.free.insert(turn, is_free);
        Some(is_free)
    }

    /// Returns the first violation of a limit in a step; `None` if there is none, or no limits.
    fn violation(&self, folded: &[bool], moving: &[usize]) -> Option<Violation> {
        self.limits?.violation(self.target, self.layout, folded, moving)
    }

    /// Returns true if no sample of a step shows a collision or a violated limit.
    fn passes(&self, folded: &[bool], moving: &[usize]) -> bool {
        self.violation(folded, moving).is_none() && self.check.pair_during(folded, moving).is_none()
    }
}
