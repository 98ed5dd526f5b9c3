//! `planar_path`: the shortest way of a point in the plane among obstacles, for robots that drive.
//!
//! The obstacles are solids seen from above: convex [outlines](Outline), grown by the clearance that the robot needs.
//! The shortest way among convex polygons has its corners at theirs, so it is the shortest way in their visibility
//! graph (Lozano-Pérez and Wesley 1979), found by A* with the straight distance as its bound; edges are tested when the
//! search comes to their first corner. The union of outlines that overlap has corners that are none of theirs; they
//! are concave, and no shortest way turns there. The way is exact for the polygons, which are bounded by tangents: a
//! corner that is rounded by the clearance has an edge for each 22.5 degrees.
//!
//! ```
//! use modl::geometry::{Placed, Pose, Shape, Vec3};
//! use modl::plan::Obstacle;
//! use modl::planners::{NoProgress, planar_path};
//!
//! let shape = Shape::Box { size: Vec3::new(2.0, 2.0, 1.0) };
//! let wall = Obstacle { name: "wall".into(), shapes: vec![Placed { pose: Pose::identity(), shape }] };
//! let problem = planar_path::Problem { obstacles: &[wall], from: [-2.0, 0.0], to: [2.0, 0.5], clearance: 0.0 };
//! let path = planar_path::plan(&problem, &planar_path::Settings::default(), &mut NoProgress);
//! assert_eq!(path.map(|path| path.points), Ok(vec![[-2.0, 0.0], [-1.0, 1.0], [1.0, 1.0], [2.0, 0.5]]));
//! ```

mod outline;
mod tolerances;

pub use outline::{Outline, Point};

use super::Progress;
use crate::plan::Obstacle;
use outline::distance;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::error::Error;
use std::fmt;

/// A way that is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The obstacles, in the world's frame; z makes no difference.
    pub obstacles: &'a [Obstacle],
    /// The point at which the way begins, m.
    pub from: Point,
    /// The point at which the way ends, m.
    pub to: Point,
    /// The least distance of the way from all obstacles, seen from above, m; not negative.
    pub clearance: f64,
}

/// The settings of [`plan`](plan()).
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The greatest number of corners of all grown outlines together. Default 4,000.
    pub corners: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { corners: 4_000 }
    }
}

/// A way in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The points at which the way turns, from the start to the goal, both included, m.
    pub points: Vec<Point>,
    /// The length of the way, m.
    pub length: f64,
}

/// The reason why [`plan`](plan()) gives no way.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The start is closer to an obstacle than the clearance.
    Start {
        /// The name of the obstacle.
        obstacle: String,
    },
    /// The goal is closer to an obstacle than the clearance.
    Goal {
        /// The name of the obstacle.
        obstacle: String,
    },
    /// The obstacles, grown by the clearance, enclose the start or the goal.
    Enclosed {
        /// The names of the obstacles on the straight way, in the order of the problem.
        obstacles: Vec<String>,
    },
    /// The grown outlines have too many corners.
    Corners {
        /// The number of corners.
        found: usize,
        /// The greatest number that is allowed.
        most: usize,
    },
    /// The observer ended the search.
    Stopped,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Start { obstacle } => write!(f, "the way begins too close to `{obstacle}`"),
            Refusal::Goal { obstacle } => write!(f, "the way ends too close to `{obstacle}`"),
            Refusal::Enclosed { obstacles } => {
                write!(f, "there is no way: {} in the way", in_words(obstacles))
            }
            Refusal::Corners { found, most } => {
                write!(f, "the outlines of the obstacles have {found} corners, more than {most}")
            }
            Refusal::Stopped => write!(f, "the search was stopped"),
        }
    }
}

impl Error for Refusal {}

/// Returns a list of names with the verb `is` or `are`.
fn in_words(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [one] => format!("{one} is"),
        _ => format!("{} are", quoted.join(", ")),
    }
}

/// Returns the shortest way among the obstacles that keeps the clearance from all of them. Of several the first that
/// the search finds, always the same.
///
/// # Errors A [`Refusal`] where the start or the goal is too close to an obstacle, no way leads from one to the other,
/// the outlines have more corners than the settings allow, or the observer ends the search.
pub fn plan(problem: &Problem, settings: &Settings, progress: &mut dyn Progress) -> Result<Path, Refusal> {
    let grown: Vec<Vec<Outline>> = problem
        .obstacles
        .iter()
        .map(|obstacle| Outline::of_solid(&obstacle.shapes, problem.clearance))
        .collect();
    let name = |obstacle: usize| problem.obstacles[obstacle].name.clone();
    let within = |point| grown.iter().position(|outlines| outlines.iter().any(|o| o.contains(point)));
    if let Some(obstacle) = within(problem.from) {
        return Err(Refusal::Start { obstacle: name(obstacle) });
    }
    if let Some(obstacle) = within(problem.to) {
        return Err(Refusal::Goal { obstacle: name(obstacle) });
    }
    let outlines: Vec<&Outline> = grown.iter().flatten().collect();
    let found = outlines.iter().map(|outline| outline.corners.len()).sum();
    if found > settings.corners {
        return Err(Refusal::Corners { found, most: settings.corners });
    }
    let mut nodes = vec![problem.from, problem.to];
    let free = |corner: &&Point| !outlines.iter().any(|outline| outline.contains(**corner));
    nodes.extend(outlines.iter().flat_map(|outline| &outline.corners).filter(free));
    let before = search(&nodes, &outlines, progress)?;
    if before[GOAL].is_none() {
        let crossed = |o: &usize| grown[*o].iter().any(|outline| outline.blocks(problem.from, problem.to));
        let obstacles = (0..grown.len()).filter(crossed).map(name).collect();
        return Err(Refusal::Enclosed { obstacles });
    }
    let mut points = vec![nodes[GOAL]];
    let mut node = GOAL;
    while let Some(earlier) = before[node] {
        points.push(nodes[earlier]);
        node = earlier;
    }
    points.reverse();
    let length = points.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    Ok(Path { points, length })
}

/// The nodes at which the way begins and ends.
const START: usize = 0;
const GOAL: usize = 1;

/// A node that the search may visit next.
struct Open {
    /// The least length that a way over the node can have, m.
    bound: f64,
    node: usize,
}

impl Ord for Open {
    /// Compares so that the heap, which gives the greatest first, gives the least bound, and of equal ones the first
    /// node.
    fn cmp(&self, other: &Open) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// Returns for each node the one before it on the shortest way from the start, as far as the search for the goal came.
///
/// # Errors
/// [`Refusal::Stopped`] where the observer ends the search.
fn search(
    nodes: &[Point],
    outlines: &[&Outline],
    progress: &mut dyn Progress,
) -> Result<Vec<Option<usize>>, Refusal> {
    let mut lengths = vec![f64::INFINITY; nodes.len()];
    let mut before = vec![None; nodes.len()];
    let mut done = vec![false; nodes.len()];
    lengths[START] = 0.0;
    let mut open = BinaryHeap::from([Open { bound: distance(nodes[START], nodes[GOAL]), node: START }]);
    while let Some(Open { node, .. }) = open.pop() {
        if std::mem::replace(&mut done[node], true) {
            continue;
        }
        if node == GOAL {
            break;
        }
        progress.report(&|| {
            format!("{} of {} corners visited", done.iter().filter(|d| **d).count(), nodes.len())
        });
        if !progress.should_continue() {
            return Err(Refusal::Stopped);
        }
        for next in 0..nodes.len() {
            let length = lengths[node] + distance(nodes[node], nodes[next]);
            let blocked = || outlines.iter().any(|outline| outline.blocks(nodes[node], nodes[next]));
            if done[next] || length >= lengths[next] || blocked() {
                continue;
            }
            lengths[next] = length;
            before[next] = Some(node);
            open.push(Open { bound: length + distance(nodes[next], nodes[GOAL]), node: next });
        }
    }
    Ok(before)
}
