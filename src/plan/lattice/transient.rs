//! Contacts that begin or end within a stage.
//!
//! A contact over a face holds on one interval of the path parameter: along one axis the gap stays 0, along
//! the others the overlap, a minimum of linear functions, is positive. Between two successive instants at which a
//! contact begins or ends the contact graph is constant, so a stage falls into intervals with one graph each.

use super::boxes::for_swept_pairs;
use super::grid::Cube;
use super::window::{Window, order, overlap};

/// A contact of two cells for a part of the stage, or for all of it.
#[derive(Clone, Copy, Debug)]
pub struct TransientContact {
    /// The numbers of the two cells, the lower first.
    pub cells: (u32, u32),
    /// Twice the greatest relative displacement of the cells along an axis over the whole stage, in grid lines.
    pub relative: i64,
    /// The open interval of the path parameter in which the contact holds.
    pub window: Window,
}

/// The greatest product of intervals with contacts and cells that is examined: some seconds of work.
const WORK_MAX: usize = 300_000_000;

/// Returns all contacts that hold at some time of the stage between `before` and `after`, the cells by number. `None`
/// if too many pairs of cells come near each other.
pub fn transient_contacts(before: &[Cube], after: &[Cube]) -> Option<Vec<TransientContact>> {
    let mut found = Vec::new();
    for_swept_pairs(before, after, |i, j| {
        let pair = [(&before[i], &after[i]), (&before[j], &after[j])];
        let window = (0..3).find_map(|axis| contact(pair, axis));
        if let Some(window) = window {
            let moved = |k: usize, axis: usize| after[k].middle(axis) - before[k].middle(axis);
            let relative = (0..3).map(|axis| (moved(i, axis) - moved(j, axis)).abs()).max();
            found.push(TransientContact {
                cells: (i as u32, j as u32),
                relative: relative.unwrap_or(0),
                window,
            });
        }
    })?;
    Some(found)
}

/// Returns the window in which two cells are in contact across an axis; each is given before and after the stage.
/// `None` if there is none.
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

/// Returns the intervals of the path parameter between successive instants at which one of the contacts `passing`
/// begins or ends, ascending from 0 to 1. `None` if there are more than are examined for a lattice of `cells` cells.
pub fn contact_intervals(passing: &[TransientContact], cells: usize) -> Option<Vec<Window>> {
    let ends = passing.iter().flat_map(|contact| [contact.window.from, contact.window.to]);
    let mut instants: Vec<_> = ends.chain([Window::WHOLE.from, Window::WHOLE.to]).collect();
    instants.sort_by(|a, b| order(*a, *b));
    instants.dedup_by(|a, b| order(*a, *b).is_eq());
    let work = instants.len().saturating_mul(cells + passing.len());
    (work <= WORK_MAX).then(|| instants.windows(2).map(|w| Window { from: w[0], to: w[1] }).collect())
}
