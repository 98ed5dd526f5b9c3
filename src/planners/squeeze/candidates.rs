//! Candidate motions between two shapes, put together from the constructions.

use super::accordion::{accordion, balanced_accordion, places_in_column};
use super::arms::arms;
use super::domain::{CellState, Domain};
use super::fold::fold;
use super::halve::halve;
use super::listed::Listed;
use super::melt::melt;
use super::motion::{Motion, PlanLimits};
use super::planar::to_row;
use super::push::push;
use super::shape::Shape;
use super::shear::shear;
use super::spin::{SPIN_MAX, spin};
use super::tunnel::tunnel;
use super::unroll::{pile, unroll, unroll_pile};
use super::{Method, Refusal};
use crate::planners::push::Bounds;

/// A motion between two shapes, or from one shape to the row that motions go through, with the method by which it was
/// constructed.
pub(super) struct Candidate {
    /// The method by which the motion was constructed.
    pub method: Method,
    /// The motion between the shapes, or from a shape to the row.
    pub motion: Motion,
}

/// Returns every motion from one shape to the other that the constructions give, of the method `wanted` or of all if
/// that is [`Method::Auto`]; empty if none applies. Of cells that do not slide blocks tunnel, which both shapes must
/// consist of.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits, [`Refusal::Defect`] if a construction fails.
pub(super) fn candidates(
    limits: PlanLimits,
    from: &Shape,
    to: &Shape,
    wanted: Method,
) -> Result<Vec<Candidate>, Refusal> {
    let mut found = Vec::new();
    let is_wanted = |method: Method| wanted == Method::Auto || wanted == method;
    if from.positions == to.positions {
        let motion = Listed::new(from.positions.iter().map(|place| CellState::whole(*place)).collect());
        let motion = motion.into_motion(limits, &(0..from.count()).collect::<Vec<u64>>())?;
        let method = if wanted == Method::Auto { Method::Accordion } else { wanted };
        return Ok(vec![Candidate { method, motion }]);
    }
    if wanted.tunnels(limits.slides) {
        return tunnelled(limits, (from, to), &[]);
    }
    let shrinks_to_half = limits.cell.smallest.order(crate::plan::Ratio(1, 2)).is_le();
    let boxes = from.is_box() && to.is_box();
    if is_wanted(Method::Fold)
        && shrinks_to_half
        && boxes
        // Between rows and columns the closed form does the same.
        && !((0..3).any(|k| from.is_row_along(k)) && (0..3).any(|k| to.is_row_along(k)))
        && let Some(motion) = halve(limits, from.sides, to.sides)
    {
        found.push(Candidate { method: Method::Fold, motion: motion? });
    }
    // Between boxes a merge is never the fastest: at its end it unfolds to the row as an accordion does,
    // and it has squeezed and swapped before.
    let merges = wanted == Method::Merge || (wanted == Method::Auto && !boxes);
    let context = Context { limits, shrinks_to_half, wanted, merges };
    // Motions go through a row; where one of the shapes is a row, through that one.
    let is_row = |axis: usize| from.is_row_along(axis) || to.is_row_along(axis);
    let any_row = (0..3).any(is_row);
    for axis in (0..3).filter(|&axis| !any_row || is_row(axis)) {
        let starts = context.to_row(from, axis, &|i| i)?;
        if starts.is_empty() {
            continue;
        }
        for end in context.to_row(to, axis, &|i| i)? {
            found.extend(starts.iter().map(|start| joined(start, None, &end)));
        }
        // Or through another row: the accordion takes one to the other.
        for other in (0..3).filter(|other| *other != axis) {
            if !merges || !flat_only(from) || !flat_only(to) || to.count() < 3 {
                continue;
            }
            let mut names = vec![0_u64; from.positions.len()];
            let positions = places_in_column(from.count());
            positions.iter().enumerate().for_each(|(cell, &place)| names[place as usize] = cell as u64);
            let turn = accordion(limits, from.count())?.turned(axes(axis, other));
            for end in context.to_row(to, other, &|i| names[i as usize])? {
                let merges = |c: &Candidate| c.method == Method::Merge || c.motion.transitions.is_empty();
                let starts = starts.iter().filter(|start| merges(start) && merges(&end));
                found.extend(starts.map(|start| joined(start, Some(&turn), &end)));
            }
        }
    }
    // Rows and boxes go to each other at once; other shapes, which go through a row, may be pushed in place.
    if wanted == Method::Push || (wanted == Method::Auto && !boxes) {
        let known = found.iter().map(|candidate| candidate.motion.duration()).reduce(f64::min);
        let pushed = pushed(limits, from, to, known.unwrap_or(f64::INFINITY))?;
        found.extend(pushed.map(|motion| Candidate { method: Method::Push, motion }));
    }
    if wanted == Method::Spin {
        found.extend(spun(limits, from, to)?);
    }
    let melts = wanted == Method::Melt || (wanted == Method::Auto && found.is_empty());
    if melts && shrinks_to_half && from.positions.len() <= MELT_MAX {
        let axis = (0..3).find(|&axis| is_row(axis)).unwrap_or(0);
        let (start, end) = (context.melted(from, axis)?, context.melted(to, axis)?);
        found.push(Candidate { method: Method::Melt, ..joined(&start, None, &end) });
    }
    Ok(found)
}

/// Returns the motion from one shape to the other in which pairs of cells spin so that nothing turns; empty if none is found.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits.
pub(super) fn spun(limits: PlanLimits, from: &Shape, to: &Shape) -> Result<Vec<Candidate>, Refusal> {
    let shrinks_to_half = limits.cell.smallest.order(crate::plan::Ratio(1, 2)).is_le();
    if !limits.slides || !shrinks_to_half || from.positions.len() > SPIN_MAX {
        return Ok(vec![]);
    }
    let motion = spin(limits, from, to)?;
    Ok(motion.map(|motion| Candidate { method: Method::Spin, motion }).into_iter().collect())
}

/// The greatest number of cells of a shape for which [`melt`] is tried: each cell takes some stages, in each of which
/// all cells move a little.
pub(super) const MELT_MAX: usize = 400;

/// The bounds of a lattice that floats among nothing.
const FLOATING: Bounds = Bounds { fixed: &[], obstacles: &[] };

/// Returns the motion from one shape to the other in which blocks tunnel, while the cells at the sites `fixed` stay; empty if
/// none is found.
fn tunnelled(
    limits: PlanLimits,
    ends: (&Shape, &Shape),
    fixed: &[[i64; 3]],
) -> Result<Vec<Candidate>, Refusal> {
    let motion = tunnel(limits, ends, fixed)?;
    Ok(motion.map(|motion| Candidate { method: Method::Tunnel, motion }).into_iter().collect())
}

/// Returns the motion from one shape to the other, both where they stand, while the cells of the bounds stand fast: by
/// pushes, or by tunnelling blocks if cells do not slide or `wanted` is that method; empty if none is found.
///
/// # Errors
/// [`Refusal::TooLarge`] if a number does not fit 64 bits, [`Refusal::Defect`] if the construction fails.
pub(super) fn anchored_candidates(
    limits: PlanLimits,
    from: &Shape,
    to: &Shape,
    (bounds, wanted): (Bounds, Method),
) -> Result<Vec<Candidate>, Refusal> {
    if wanted.tunnels(limits.slides) {
        // Ways lead through sites of the two shapes alone, where there are no obstacles.
        return tunnelled(limits, (from, to), bounds.fixed);
    }
    let numbers: Vec<u64> = (0..from.count()).collect();
    let motion = push(limits, (from, to), &numbers, (bounds, f64::INFINITY))?;
    Ok(motion.map(|motion| Candidate { method: Method::Push, motion }).into_iter().collect())
}

/// The greatest number of cells of a row that is piled up before it is pushed into shape.
const PILE_MAX: u64 = 4096;

/// Returns the fastest motion by pushes that is found and takes less than `limit`, in units of time; a row is piled up
/// first if that is faster.
fn pushed(limits: PlanLimits, from: &Shape, to: &Shape, limit: f64) -> Result<Option<Motion>, Refusal> {
    let numbers: Vec<u64> = (0..from.count()).collect();
    let direct = push(limits, (from, to), &numbers, (FLOATING, limit))?;
    let limit = direct.as_ref().map_or(limit, Motion::duration).min(limit);
    let (row, other, backwards) = match [from, to].map(|shape| (0..3).find(|&axis| shape.is_row_along(axis)))
    {
        [Some(axis), _] => (axis, to, false),
        [None, Some(axis)] => (axis, from, true),
        _ => return Ok(direct),
    };
    if from.count() > PILE_MAX {
        return Ok(direct);
    }
    let piled = piled(limits, row, other, limit)?;
    Ok(piled.map(|motion| if backwards { motion.reversed() } else { motion }).or(direct))
}

/// Returns the fastest motion of less than `limit` units of time from the row along an axis over a pile, about as long
/// and wide as the shape, to the shape.
fn piled(limits: PlanLimits, axis: usize, to: &Shape, mut limit: f64) -> Result<Option<Motion>, Refusal> {
    let count = to.count();
    let mut best = None;
    for (x, z) in [((axis + 1) % 3, (axis + 2) % 3), ((axis + 2) % 3, (axis + 1) % 3)] {
        // The sides of the shape, each as much smaller as makes their box hold as many cells as there are.
        let flat = (0..3).filter(|&axis| to.sides[axis] > 1).count() as f64;
        let volume: f64 = to.sides.iter().map(|&side| side as f64).product();
        let scale = libm::pow(count as f64 / volume, 1.0 / flat.max(1.0));
        let side = |k: usize| {
            if to.sides[k] == 1 {
                1
            } else {
                (libm::round(to.sides[k] as f64 * scale) as u64).clamp(1, count)
            }
        };
        let sides = [side(x), side(z)];
        let turn = [x, axis, z];
        let unrolled = unroll_pile(limits, count, sides)?.turned(turn);
        let mut piled: Vec<([i64; 3], u64)> = pile(count, sides)
            .into_iter()
            .zip(0..)
            .map(|(site, number)| {
                let mut place = site;
                (0..3).for_each(|k| place[turn[k]] = site[k]);
                (place, number)
            })
            .collect();
        piled.sort_unstable();
        let (places, numbers): (Vec<[i64; 3]>, Vec<u64>) = piled.into_iter().unzip();
        let rest = limit - unrolled.duration();
        if rest > 0.0
            && let Some(pushed) = push(limits, (&Shape::of(&places), to), &numbers, (FLOATING, rest))?
        {
            let motion = unrolled.reversed().then(pushed);
            if motion.duration() < limit {
                limit = motion.duration();
                best = Some(motion);
            }
        }
    }
    Ok(best)
}

/// Returns true if the cells lie in a plane.
fn flat_only(shape: &Shape) -> bool {
    (0..3).any(|axis| shape.is_flat_across(axis))
}

/// The conditions under which candidates are made.
struct Context {
    limits: PlanLimits,
    /// True if a cell can contract to half its size or less.
    shrinks_to_half: bool,
    wanted: Method,
    /// True if merges are tried.
    merges: bool,
}

/// Returns the permutation of axes that takes x to `x` and y to `y`.
fn axes(x: usize, y: usize) -> [usize; 3] {
    [x, y, 3 - x - y]
}

/// Returns the motion from one shape to the row, by `turn` to another row if there is one, and on to the other shape.
fn joined(start: &Candidate, turn: Option<&Motion>, end: &Candidate) -> Candidate {
    // A motion that rests has no method of its own.
    let method = match (start.motion.transitions.is_empty(), end.motion.transitions.is_empty()) {
        (true, _) => end.method,
        (_, true) => start.method,
        _ if start.method == end.method => start.method,
        _ => Method::Merge,
    };
    let motion = match turn {
        Some(turn) => start.motion.clone().then(turn.clone()),
        None => start.motion.clone(),
    };
    Candidate { method, motion: motion.then(end.motion.clone().reversed()) }
}

impl Context {
    /// Returns the fastest motion to a row along an axis, by melting where no other wanted method applies.
    fn melted(&self, shape: &Shape, axis: usize) -> Result<Candidate, Refusal> {
        let others = self.to_row(shape, axis, &|i| i)?;
        let quickest = others.into_iter().min_by(|a, b| a.motion.duration().total_cmp(&b.motion.duration()));
        if let Some(quickest) = quickest {
            return Ok(quickest);
        }
        let to = axes(axis, (axis + 1) % 3);
        let positions: Vec<[i64; 3]> = shape.positions.iter().map(|p| to.map(|k| p[k])).collect();
        let motion = melt(self.limits, &positions, |i| i)?.turned(to);
        Ok(Candidate { method: Method::Melt, motion })
    }

    /// Returns the motions to a row along an axis in which cell `name(i)` is at `i`.
    fn to_row(
        &self,
        shape: &Shape,
        axis: usize,
        name: &dyn Fn(u64) -> u64,
    ) -> Result<Vec<Candidate>, Refusal> {
        let (limits, count) = (self.limits, shape.count());
        let is_wanted = |method: Method| self.wanted == Method::Auto || self.wanted == method;
        let mut found = Vec::new();
        let mut add = |method: Method, motion: Motion| found.push(Candidate { method, motion });
        let renamed = (0..count).any(|i| name(i) != i);
        // The row itself rests.
        if shape.is_row_along(axis) && !renamed {
            let all: Vec<Domain> = Domain::new(0, &[(count, 1)]).into_iter().collect();
            let row = Motion::rest(count, &all, |i| CellState::whole([i as i64, 0, 0]))?;
            add(Method::Accordion, row.turned(axes(axis, (axis + 1) % 3)));
            return Ok(found);
        }
        // A row along another axis: the constructions from row to column, backwards.
        let column = (0..3).find(|&k| k != axis && shape.is_row_along(k));
        if let (Some(column), false) = (column, renamed) {
            let turn = axes(axis, column);
            if is_wanted(Method::Accordion) || self.wanted == Method::Merge {
                add(Method::Accordion, accordion(limits, count)?.turned(turn).reversed());
                if let Some(motion) = balanced_accordion(limits, count) {
                    add(Method::Accordion, motion?.turned(turn).reversed());
                }
            }
            if is_wanted(Method::Fold) && self.shrinks_to_half {
                add(Method::Fold, fold(limits, count)?.turned(turn).reversed());
            }
            if is_wanted(Method::Arms) && self.shrinks_to_half && count >= 4 {
                add(Method::Arms, arms(limits, count)?.turned(turn).reversed());
            }
            if is_wanted(Method::Shear) && self.shrinks_to_half {
                add(Method::Shear, shear(limits, count)?.turned(turn).reversed());
            }
            return Ok(found);
        }
        // A box unrolls in either order of its other axes, and a flat shape merges in its plane.
        if shape.is_box() && !renamed && is_wanted(Method::Accordion) {
            for (x, z) in [((axis + 1) % 3, (axis + 2) % 3), ((axis + 2) % 3, (axis + 1) % 3)] {
                let sides = [shape.sides[x], shape.sides[axis], shape.sides[z]];
                add(Method::Accordion, unroll(limits, sides)?.turned([x, axis, z]));
            }
        }
        if self.merges && self.shrinks_to_half {
            for across in (0..3).filter(|&k| k != axis && shape.is_flat_across(k)) {
                let other = 3 - axis - across;
                let positions: Vec<[i64; 2]> = shape.positions.iter().map(|p| [p[axis], p[other]]).collect();
                add(Method::Merge, to_row(limits, &positions, name)?.turned([axis, other, across]));
            }
        }
        Ok(found)
    }
}
