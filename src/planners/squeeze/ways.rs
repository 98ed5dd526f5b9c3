//! Ways between two shapes, put together from the constructions.

use super::accordion::{accordion, balanced_accordion, places_in_column};
use super::arms::arms;
use super::domain::{Domain, Spot};
use super::explicit::Listed;
use super::fold::fold;
use super::halve::halve;
use super::melt::melt;
use super::planar::to_row;
use super::shape::Shape;
use super::shear::shear;
use super::unroll::unroll;
use super::way::{Terms, Way};
use super::{Method, Refusal};

/// A way with the method that it stands for.
pub struct Candidate {
    pub method: Method,
    pub way: Way,
}

/// Every way that the constructions give, of one method or of all.
pub fn ways(terms: Terms, from: &Shape, to: &Shape, wanted: Method) -> Result<Vec<Candidate>, Refusal> {
    let mut found = Vec::new();
    let is_wanted = |method: Method| wanted == Method::Auto || wanted == method;
    if from.places == to.places {
        let motion = Listed::new(from.places.iter().map(|place| Spot::whole(*place)).collect());
        let way = motion.way(terms, &(0..from.count()).collect::<Vec<u64>>())?;
        let method = if wanted == Method::Auto { Method::Accordion } else { wanted };
        return Ok(vec![Candidate { method, way }]);
    }
    let supple = terms.limits.smallest.order(crate::plan::Ratio(1, 2)).is_le();
    let boxes = from.is_box() && to.is_box();
    if is_wanted(Method::Fold)
        && supple
        && boxes
        // Between rows and columns the closed form does the same.
        && !((0..3).any(|k| from.is_row_along(k)) && (0..3).any(|k| to.is_row_along(k)))
        && let Some(way) = halve(terms, from.sides, to.sides)
    {
        found.push(Candidate { method: Method::Fold, way: way? });
    }
    // Between boxes a merge is never the fastest: at its end it unfolds to the row as an accordion does,
    // and it has squeezed and swapped before.
    let merges = wanted == Method::Merge || (wanted == Method::Auto && !boxes);
    let context = Context { terms, supple, wanted, merges };
    // Where one of the shapes is a row, it is that row that the ways go through.
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
        // By way of another row: the accordion turns one to the other.
        for other in (0..3).filter(|other| *other != axis) {
            if !merges || !flat_only(from) || !flat_only(to) || to.count() < 3 {
                continue;
            }
            let mut names = vec![0_u64; from.places.len()];
            let places = places_in_column(from.count());
            places.iter().enumerate().for_each(|(cell, &place)| names[place as usize] = cell as u64);
            let turn = accordion(terms, from.count())?.turned(axes(axis, other));
            for end in context.to_row(to, other, &|i| names[i as usize])? {
                let merges = |c: &Candidate| c.method == Method::Merge || c.way.legs.is_empty();
                let starts = starts.iter().filter(|start| merges(start) && merges(&end));
                found.extend(starts.map(|start| joined(start, Some(&turn), &end)));
            }
        }
    }
    let melts = wanted == Method::Melt || (wanted == Method::Auto && found.is_empty());
    if melts && supple && from.places.len() <= MELT_MAX {
        let axis = (0..3).find(|&axis| is_row(axis)).unwrap_or(0);
        let (start, end) = (context.melted(from, axis)?, context.melted(to, axis)?);
        found.push(Candidate { method: Method::Melt, ..joined(&start, None, &end) });
    }
    Ok(found)
}

/// Cells that melt: each takes some stages, in all of which all cells move a little.
pub const MELT_MAX: usize = 400;

/// In a plane.
fn flat_only(shape: &Shape) -> bool {
    (0..3).any(|axis| shape.is_flat_across(axis))
}

struct Context {
    terms: Terms,
    supple: bool,
    wanted: Method,
    /// Whether merges are tried.
    merges: bool,
}

/// What was along x goes along `x`, what was along y along `y`.
fn axes(x: usize, y: usize) -> [usize; 3] {
    [x, y, 3 - x - y]
}

fn joined(start: &Candidate, turn: Option<&Way>, end: &Candidate) -> Candidate {
    // The method that says most: what rests has none of its own.
    let method = match (start.way.legs.is_empty(), end.way.legs.is_empty()) {
        (true, _) => end.method,
        (_, true) => start.method,
        _ if start.method == end.method => start.method,
        _ => Method::Merge,
    };
    let way = match turn {
        Some(turn) => start.way.clone().then(turn.clone()),
        None => start.way.clone(),
    };
    Candidate { method, way: way.then(end.way.clone().reversed()) }
}

impl Context {
    /// A way to a row along an axis: melted, where there is none of another kind that is wanted.
    fn melted(&self, shape: &Shape, axis: usize) -> Result<Candidate, Refusal> {
        let others = self.to_row(shape, axis, &|i| i)?;
        let quickest = others.into_iter().min_by(|a, b| a.way.duration().total_cmp(&b.way.duration()));
        if let Some(quickest) = quickest {
            return Ok(quickest);
        }
        let to = axes(axis, (axis + 1) % 3);
        let places: Vec<[i64; 3]> = shape.places.iter().map(|p| to.map(|k| p[k])).collect();
        let way = melt(self.terms, &places, |i| i)?.turned(to);
        Ok(Candidate { method: Method::Melt, way })
    }

    /// Ways to a row along an axis, in which cell `name(i)` is at `i`.
    fn to_row(
        &self,
        shape: &Shape,
        axis: usize,
        name: &dyn Fn(u64) -> u64,
    ) -> Result<Vec<Candidate>, Refusal> {
        let (terms, count) = (self.terms, shape.count());
        let is_wanted = |method: Method| self.wanted == Method::Auto || self.wanted == method;
        let mut found = Vec::new();
        let mut add = |method: Method, way: Way| found.push(Candidate { method, way });
        let renamed = (0..count).any(|i| name(i) != i);
        if shape.is_row_along(axis) && !renamed {
            let all: Vec<Domain> = Domain::new(0, &[(count, 1)]).into_iter().collect();
            let row = Way::rest(count, &all, |i| Spot::whole([i as i64, 0, 0]))?;
            add(Method::Accordion, row.turned(axes(axis, (axis + 1) % 3)));
            return Ok(found);
        }
        let column = (0..3).find(|&k| k != axis && shape.is_row_along(k));
        if let (Some(column), false) = (column, renamed) {
            let turn = axes(axis, column);
            if is_wanted(Method::Accordion) || self.wanted == Method::Merge {
                add(Method::Accordion, accordion(terms, count)?.turned(turn).reversed());
                if let Some(way) = balanced_accordion(terms, count) {
                    add(Method::Accordion, way?.turned(turn).reversed());
                }
            }
            if is_wanted(Method::Fold) && self.supple {
                add(Method::Fold, fold(terms, count)?.turned(turn).reversed());
            }
            if is_wanted(Method::Arms) && self.supple && count >= 4 {
                add(Method::Arms, arms(terms, count)?.turned(turn).reversed());
            }
            if is_wanted(Method::Shear) && self.supple {
                add(Method::Shear, shear(terms, count)?.turned(turn).reversed());
            }
            return Ok(found);
        }
        if shape.is_box() && !renamed && is_wanted(Method::Accordion) {
            for (x, z) in [((axis + 1) % 3, (axis + 2) % 3), ((axis + 2) % 3, (axis + 1) % 3)] {
                let sides = [shape.sides[x], shape.sides[axis], shape.sides[z]];
                add(Method::Accordion, unroll(terms, sides)?.turned([x, axis, z]));
            }
        }
        if self.merges && self.supple {
            for across in (0..3).filter(|&k| k != axis && shape.is_flat_across(k)) {
                let other = 3 - axis - across;
                let places: Vec<[i64; 2]> = shape.places.iter().map(|p| [p[axis], p[other]]).collect();
                add(Method::Merge, to_row(terms, &places, name)?.turned([axis, other, across]));
            }
        }
        Ok(found)
    }
}
