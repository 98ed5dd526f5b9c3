//! An order of folding in which no panels meet, where the usual orders have none.
//!
//! The folding is undone, one hinge after the other, back to the flat pattern: a search in depth over
//! the sets of hinges that are still folded, with those that led nowhere remembered. Most panels are
//! in each other's way when they are folded, so it is there that choices matter. Of the hinges that can
//! be opened that one goes first which a wished order folds last. What was found is put into steps
//! again: a hinge folds with the one before it where neither carries the other and nothing meets.

use super::layout::Layout;
use super::load_limits::{LoadLimits, Violation};
use super::sweep_collision::{Solids, SweepCheck};
use super::target::Target;
use crate::interrupt;
use std::collections::{BTreeMap, BTreeSet};

/// One step: the hinges that have folded before it, and the face whose hinge folds in it.
type Turn = (Vec<bool>, usize);

/// A search in one layout. What the judge refused can be told it; then it finds another way.
pub struct OrderSearch<'t> {
    layout: &'t Layout,
    target: &'t Target,
    look: SweepCheck<'t>,
    burden: Option<&'t LoadLimits>,
    free: BTreeMap<Turn, bool>,
    refused: BTreeSet<Turn>,
    /// Steps that may still be looked at.
    pub left: usize,
    /// The least overload that stood against a step, and the face on whose hinge it is, N·m.
    pub overload: Option<(f64, usize)>,
}

impl<'t> OrderSearch<'t> {
    /// `looks`: steps that are looked at at most.
    pub fn new(
        target: &'t Target,
        layout: &'t Layout,
        solids: &Solids,
        burden: Option<&'t LoadLimits>,
        looks: usize,
    ) -> OrderSearch<'t> {
        let (free, refused) = (BTreeMap::new(), BTreeSet::new());
        let look = SweepCheck::thick(target, layout, solids);
        OrderSearch { layout, target, look, burden, free, refused, left: looks, overload: None }
    }

    /// All faces but the root in an order in which each can fold. `wished`: such an order, to which it
    /// is to be like.
    pub fn order(&mut self, wished: &[usize]) -> Option<Vec<usize>> {
        let mut folded = vec![true; self.layout.parent.len()];
        folded[self.layout.root] = false;
        let mut dead: BTreeSet<Vec<bool>> = BTreeSet::new();
        // Opened so far; for each depth how many of the wished were tried.
        let mut opened: Vec<usize> = Vec::new();
        let mut tried = vec![0];
        while opened.len() < wished.len() {
            interrupt::checkpoint();
            let next = tried.last_mut().expect("one for each depth");
            let Some(&face) = wished.iter().rev().nth(*next) else {
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

    /// The order in steps.
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

    /// Whether nothing is seen to stand against these steps.
    pub fn is_collision_free(&self, steps: &[Vec<usize>]) -> bool {
        let mut folded = vec![false; self.layout.parent.len()];
        steps.iter().all(|step| {
            let passes = self.passes(&folded, step);
            step.iter().for_each(|face| folded[*face] = true);
            passes
        })
    }

    /// A step of an order that was found is not to be taken any more.
    pub fn refuse(&mut self, order: &[usize], step: usize) {
        let mut folded = vec![false; self.layout.parent.len()];
        order[..step].iter().for_each(|face| folded[*face] = true);
        self.refused.insert((folded, order[step]));
    }

    /// `None` where no more may be looked at.
    fn is_free(&mut self, folded: &[bool], face: usize) -> Option<bool> {
        let turn = (folded.to_vec(), face);
        if self.refused.contains(&turn) {
            return Some(false);
        }
        if let Some(&known) = self.free.get(&turn) {
            return Some(known);
        }
        self.left = self.left.checked_sub(1)?;
        if let Some(Violation::Overload { face, torque }) = self.obstacle(folded, &[face])
            && self.overload.is_none_or(|(least, _)| torque < least)
        {
            self.overload = Some((torque, face));
        }
        let is_free = self.passes(folded, &[face]);
        self.free.insert(turn, is_free);
        Some(is_free)
    }

    fn obstacle(&self, folded: &[bool], moving: &[usize]) -> Option<Violation> {
        self.burden?.obstacle(self.target, self.layout, folded, moving)
    }

    fn passes(&self, folded: &[bool], moving: &[usize]) -> bool {
        self.obstacle(folded, moving).is_none() && self.look.during(folded, moving).is_none()
    }
}
