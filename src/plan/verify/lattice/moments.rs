//! Contacts that come and go within a stage.
//!
//! A contact over a face holds on one stretch of the progress: along one axis the gap stays 0, along the
//! others the overlap, a least of linear functions, is positive. Between two instants at which a contact
//! begins or ends all contacts stay; so a stage is as many such stretches, each with one graph.

use super::boxes::pairs_near_on_the_way;
use super::grid::Cube;
use super::window::{Window, order, overlap};

/// A contact for a part of the stage, or for all of it.
#[derive(Clone, Copy, Debug)]
pub struct Passing {
    pub cells: (u32, u32),
    /// By how much the cells move against each other in the whole stage, twice, at most along an axis.
    pub parting: i64,
    pub window: Window,
}

/// Stretches times contacts and cells that are looked at: some seconds of work.
const WORK_MAX: usize = 300_000_000;

/// All contacts that hold at some time of the stage. `None`: too many pairs of cells come near each other.
pub fn passing(before: &[Cube], after: &[Cube]) -> Option<Vec<Passing>> {
    let mut found = Vec::new();
    pairs_near_on_the_way(before, after, |i, j| {
        let pair = [(&before[i], &after[i]), (&before[j], &after[j])];
        let window = (0..3).find_map(|axis| contact(pair, axis));
        if let Some(window) = window {
            let moved = |k: usize, axis: usize| after[k].middle(axis) - before[k].middle(axis);
            let parting = (0..3).map(|axis| (moved(i, axis) - moved(j, axis)).abs()).max();
            found.push(Passing { cells: (i as u32, j as u32), parting: parting.unwrap_or(0), window });
        }
    })?;
    Some(found)
}

/// When two cells are in contact across an axis: each with its two ends.
fn contact([a, b]: [(&Cube, &Cube); 2], axis: usize) -> Option<Window> {
    let closed =
        |p: (&Cube, &Cube), q: (&Cube, &Cube)| p.0.hi[axis] == q.0.lo[axis] && p.1.hi[axis] == q.1.lo[axis];
    if !closed(a, b) && !closed(b, a) {
        return None;
    }
    [(axis + 1) % 3, (axis + 2) % 3]
        .into_iter()
        .try_fold(Window::WHOLE, |window, across| overlap([a, b], across, window))
}

/// The stretches between instants at which a contact begins or ends, in order. `None`: too many for so
/// many cells.
pub fn stretches(passing: &[Passing], cells: usize) -> Option<Vec<Window>> {
    let ends = passing.iter().flat_map(|contact| [contact.window.from, contact.window.to]);
    let mut instants: Vec<_> = ends.chain([Window::WHOLE.from, Window::WHOLE.to]).collect();
    instants.sort_by(|a, b| order(*a, *b));
    instants.dedup_by(|a, b| order(*a, *b).is_eq());
    let work = instants.len().saturating_mul(cells + passing.len());
    (work <= WORK_MAX).then(|| instants.windows(2).map(|w| Window { from: w[0], to: w[1] }).collect())
}
