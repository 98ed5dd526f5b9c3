//! Folded forms of crease patterns that state mountains and valleys and leave open how far these fold.
//!
//! From the flat sheet several ways lead off. A small form near to the pattern's own proportions is closed by Newton's
//! method, and if its mountains and valleys are those of the pattern it is on one of their ways. From there the angles grow
//! along the gradient of their sum, weighted by these proportions, on the forms whose loops are closed.

use super::loops::{Loops, NoSheet};
use super::path::{closed, free_part};
use super::plan::CREASES_MAX;
use super::tolerances::TOLERANCES;
use crate::planners::fold::Target;
use nalgebra::DVector;
use std::fmt;

/// The widest angles of the small forms that are tried in turn, rad.
const SMALL: [f64; 5] = [0.05, 0.1, 0.2, 0.4, 0.02];

/// The number of times that a small form is brought nearer to the proportions of the pattern.
const APPROACHES: usize = 20;

/// The greatest change of an angle in a step, rad.
const STEP: f64 = 0.04;

/// The most steps, and the most halvings of one.
const STEPS_MAX: usize = 1000;
const HALVINGS_MAX: usize = 48;

/// The reason why no form with the mountains and valleys of a pattern was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Unassigned {
    /// The pattern is no flat sheet.
    NoSheet(NoSheet),
    /// The sheet has more creases than can be planned for.
    TooManyCreases {
        /// The number of creases.
        creases: usize,
    },
    /// All creases stay flat.
    Flat,
    /// Near flat no form has these mountains and valleys.
    Contradicts {
        /// The index in [`Target::hinges`] of a crease that the loops fold the other way, or not at all.
        crease: usize,
    },
    /// The creases do not fold so far.
    Ends {
        /// The angle of the crease that folds widest where the way ends, rad.
        widest: f64,
    },
}

impl fmt::Display for Unassigned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unassigned::NoSheet(why) => why.fmt(f),
            Unassigned::TooManyCreases { creases } => {
                write!(f, "the sheet has {creases} creases; at most {CREASES_MAX} can be planned")
            }
            Unassigned::Flat => f.write_str("no crease is a mountain or a valley"),
            Unassigned::Contradicts { .. } => f.write_str(
                "near flat no form was found with these mountains and valleys: the others fold one of them the other way, \
                 or leave it flat",
            ),
            Unassigned::Ends { widest } => write!(
                f,
                "with these mountains and valleys a way was found up to {:.1} degrees of the widest crease, where panels \
                 would have to bend",
                widest.to_degrees()
            ),
        }
    }
}

/// Returns angles (rad) that close all loops of a flat sheet, of which the widest is `widest` (rad): mountains and valleys are
/// as in `stated`, and near flat the angles are as nearly as can be in its proportions. `stated`: for each crease, in the order
/// of [`Target::hinges`], positive at a mountain.
///
/// # Errors
/// [`Unassigned`] where no such form was found.
pub fn assigned(flat: &Target, stated: &[f64], widest: f64) -> Result<Vec<f64>, Unassigned> {
    let loops = Loops::of(flat).map_err(Unassigned::NoSheet)?;
    if flat.hinges.len() > CREASES_MAX {
        return Err(Unassigned::TooManyCreases { creases: flat.hinges.len() });
    }
    let stated = DVector::from_column_slice(stated);
    if stated.amax() == 0.0 {
        return Err(Unassigned::Flat);
    }
    let wanted = &stated / stated.amax();
    let mut at = small(&loops, &wanted, widest)?;
    for _ in 0..STEPS_MAX {
        crate::interrupt::checkpoint();
        let ends = Unassigned::Ends { widest: at.amax() };
        let direction = free_part(&loops.jacobian(at.as_slice()), &wanted).ok_or(ends.clone())?;
        if direction.amax() < TOLERANCES.growth {
            return Err(ends);
        }
        // A step is halved until its loops close, and until it does not lead beyond the goal.
        let mut by = STEP / direction.amax();
        let mut next = None;
        let mut beyond = false;
        for _ in 0..HALVINGS_MAX {
            let tried = closed(&loops, &at + &direction * by);
            let tried = tried.filter(|tried| (tried - &at).amax() < 2.0 * by * direction.amax());
            let over = tried.as_ref().is_some_and(|tried| tried.amax() > widest);
            beyond |= over;
            next = tried.filter(|_| !over);
            if next.is_some() {
                break;
            }
            by /= 2.0;
        }
        let reached = |at: &DVector<f64>| widest - at.amax() <= TOLERANCES.place * widest;
        match next {
            Some(next) => at = next,
            None if beyond => return agreeing(&at, &wanted),
            None => return Err(ends),
        }
        if reached(&at) {
            return agreeing(&at, &wanted);
        }
    }
    Err(Unassigned::Ends { widest: at.amax() })
}

/// Returns angles at which the loops are closed, small and near to the proportions that are wanted.
///
/// # Errors
/// [`Unassigned::Contradicts`] where none has the same mountains and valleys.
fn small(loops: &Loops, wanted: &DVector<f64>, widest: f64) -> Result<DVector<f64>, Unassigned> {
    let mut fault = Unassigned::Flat;
    for size in SMALL {
        let goal = wanted * size.min(widest / 2.0);
        let Some(mut at) = closed(loops, goal.clone()) else { continue };
        for _ in 0..APPROACHES {
            let free = free_part(&loops.jacobian(at.as_slice()), &(&goal - &at));
            match free.and_then(|free| closed(loops, &at + free)) {
                Some(next) => at = next,
                None => break,
            }
        }
        match agreeing(&at, wanted) {
            Ok(_) if at.amax() < widest => return Ok(at),
            Ok(_) => {}
            Err(why) => fault = why,
        }
    }
    Err(fault)
}

/// Returns angles as a list if their mountains and valleys are those that are wanted.
///
/// # Errors
/// [`Unassigned::Contradicts`] with the crease that is farthest from that.
fn agreeing(angles: &DVector<f64>, wanted: &DVector<f64>) -> Result<Vec<f64>, Unassigned> {
    let along = |crease: &usize| angles[*crease] * wanted[*crease].signum();
    let folds = (0..wanted.len()).filter(|crease| wanted[*crease] != 0.0);
    let least = folds.min_by(|a, b| along(a).total_cmp(&along(b)));
    match least.filter(|crease| along(crease) <= TOLERANCES.folds * angles.amax()) {
        Some(crease) => Err(Unassigned::Contradicts { crease }),
        None => Ok(angles.iter().copied().collect()),
    }
}
