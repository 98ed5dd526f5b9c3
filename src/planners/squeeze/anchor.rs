//! Cells that stand fast, and obstacles: what a problem with them must meet, and how its plan states them.

use super::shape::Shape;
use super::{Method, ModelChoice, Problem, Settings};
use crate::plan::{Anchor, ArithmeticRun, Ratio, Run, arithmetic_runs};
use std::collections::BTreeSet;
use std::fmt;

/// The reason why a problem with fixed cells or obstacles has no plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnchorFault {
    /// Obstacles are stated, but no fixed cell: the recoil would move the robot against them.
    Floating,
    /// A fixed cell is no cell of a shape.
    NotThere {
        /// The lattice site of the fixed cell, in cells.
        site: [i64; 3],
        /// True if the start lacks it; false if only the goal does.
        at_start: bool,
    },
    /// An obstacle is where a shape has a cell.
    Occupied {
        /// The lattice site of the obstacle, in cells.
        site: [i64; 3],
        /// True if it is a cell of the start; false if it is only one of the goal.
        at_start: bool,
    },
    /// The method that was asked for lets no cell stand fast.
    Method(Method),
    /// A balanced plan was asked for, which a robot that is held cannot have.
    Balanced,
    /// The blocks of the second shape, which tunnel, stand beside those of the first by an odd number of cells.
    Beside {
        /// The axis, 0 to 2.
        axis: usize,
    },
    /// The search found no way.
    NoWay,
}

impl fmt::Display for AnchorFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let shape = |at_start: bool| if at_start { "first" } else { "second" };
        match self {
            AnchorFault::Floating => f.write_str(
                "among obstacles some cells must be fixed: a robot that floats recoils against them",
            ),
            AnchorFault::NotThere { site: [x, y, z], at_start } => {
                write!(f, "the fixed cell ({x}, {y}, {z}) is no cell of the {} shape", shape(*at_start))
            }
            AnchorFault::Occupied { site: [x, y, z], at_start } => {
                write!(f, "the obstacle ({x}, {y}, {z}) is where the {} shape has a cell", shape(*at_start))
            }
            AnchorFault::Method(method) => {
                write!(f, "`{}` moves all cells: none stays fixed", method.name())
            }
            AnchorFault::Balanced => f.write_str(
                "what holds the fixed cells keeps the robot from turning: it is not balanced by itself",
            ),
            AnchorFault::Beside { axis } => {
                let axis = ["x", "y", "z"][*axis];
                write!(f, "the blocks of the two shapes stand an odd number of cells apart along {axis}")
            }
            AnchorFault::NoWay => f.write_str("no way was found on which the fixed cells stay"),
        }
    }
}

/// Checks that fixed cells are cells of both shapes of a problem, that obstacles are of neither, and that the settings
/// allow both.
///
/// # Errors
/// The first [`AnchorFault`] found; never [`AnchorFault::NoWay`] or [`AnchorFault::Beside`].
pub(super) fn check(problem: &Problem, settings: &Settings) -> Result<(), AnchorFault> {
    let Problem { start, goal, fixed, obstacles, .. } = problem;
    if fixed.is_empty() {
        return if obstacles.is_empty() { Ok(()) } else { Err(AnchorFault::Floating) };
    }
    let [start, goal] = [start, goal].map(|shape| shape.iter().collect::<BTreeSet<_>>());
    if let Some(site) = fixed.iter().find(|site| !start.contains(site) || !goal.contains(site)) {
        return Err(AnchorFault::NotThere { site: *site, at_start: !start.contains(&site) });
    }
    if let Some(site) = obstacles.iter().find(|site| start.contains(site) || goal.contains(site)) {
        return Err(AnchorFault::Occupied { site: *site, at_start: start.contains(&site) });
    }
    match (settings.method, settings.model) {
        (_, ModelChoice::Balanced) => Err(AnchorFault::Balanced),
        (Method::Auto | Method::Push | Method::Tunnel, _) => Ok(()),
        (method, _) => Err(AnchorFault::Method(method)),
    }
}

/// Returns the fixed cells and obstacles of a problem as its plan states them, where the cells have the numbers of the
/// sites of the start; `None` if no cell is fixed.
pub(super) fn of(problem: &Problem, start: &Shape) -> Option<Anchor> {
    let fixed: BTreeSet<[i64; 3]> = problem.fixed.iter().copied().collect();
    let numbered = start.positions.iter().zip(0..).filter(|(site, _)| fixed.contains(*site));
    let cells: Vec<u64> = numbered.map(|(_, number)| number).collect();
    let obstacles: BTreeSet<[i64; 3]> = problem.obstacles.iter().copied().collect();
    let sites: Vec<[i64; 3]> = obstacles.into_iter().collect();
    (!cells.is_empty()).then(|| Anchor { cells, obstacles: runs(&sites) })
}

/// Returns whole cells at lattice sites as runs, in cell sizes.
fn runs(sites: &[[i64; 3]]) -> Vec<Run> {
    let apart = |i: usize, j: usize| [0, 1, 2].map(|axis| sites[j][axis] - sites[i][axis]);
    let run = |s: ArithmeticRun| {
        let center = sites[s.first].map(|x| Ratio(2 * x + 1, 2));
        let step = |i: usize, j: usize| Some(apart(i, j).map(|step| Ratio(step, 1)));
        s.of_cells((center, [Ratio::ONE; 3]), step).expect("each step is there")
    };
    arithmetic_runs(sites.len(), |i, j| Some(apart(i, j))).into_iter().map(run).collect()
}
