//! `locomote`: a truss of linear actuators moves over the ground, its centre of mass along a path, and rolls
//! over the edges of its support polygon (section IV of the linear-actuator-robots paper; the kernel is
//! [`planners::truss`](super::truss)). Quasi-static: gravity makes it roll, and nothing swings.
//!
//! ```
//! use modl::geometry::Vec3;
//! use modl::planners::truss::{Limits, problem::TrussProblem};
//! use modl::planners::{NoProgress, locomote};
//! use modl::robot::Strut;
//!
//! // A regular octahedron with edges of √2 m.
//! let along = |axis: Vec3| [axis, -axis];
//! let nodes = [along(Vec3::x()), along(Vec3::y()), along(Vec3::z())].concat();
//! let pairs = (0..6).flat_map(|i| (i + 1..6).map(move |j| (i, j)));
//! let struts: Vec<(usize, usize)> = pairs.filter(|(i, j)| i / 2 != j / 2).collect();
//! let name = "Actuator".to_owned();
//! let (acceleration, buckling, node_mass) = (Some(2.0), None, None);
//! let (length, clearance) = ((0.3, 3.0), 0.05);
//! let (speed, force, mass) = (1.0, 300.0, 1.0);
//! let strut = Strut { name, length, speed, acceleration, force, mass, clearance, buckling, node_mass };
//! let truss = TrussProblem {
//!     strut,
//!     node_names: (0..6).map(|i| format!("n[{i}]")).collect(),
//!     nodes,
//!     struts,
//!     limits: Limits::default(),
//!     obstacles: Vec::new(),
//!     terrain: None,
//!     friction: 1.0,
//! };
//! let problem = locomote::Problem { truss, path: vec![[2.0, 0.3]] };
//! let solution = locomote::plan(&problem, &locomote::Settings::default(), &mut NoProgress)?;
//! assert_eq!(solution.report.end, locomote::End::Arrived);
//! assert!(solution.report.rolls > 0);
//! assert!(solution.body.duration() > 1.0);
//! # Ok::<(), locomote::Refusal>(())
//! ```

mod detours;
mod footholds;
mod landing;
mod lookahead;
mod objective;
mod rollout;

pub use objective::{Objective, cost};
pub use rollout::{End, Foothold, Hold, Settings, Travel, follow_path};

use super::truss::constraint::Constraint;
use super::truss::motion::{moved, node_paths, travelled_distance};
use super::truss::problem::{InvalidTruss, TrussProblem};
use super::truss::{Structure, forces, rigidity_weakest, roll};
use super::{Progress, Solution};
use crate::geometry::Vec3;
use crate::geometry::soundness::{EXTENT_MAX, in_reach};
use crate::plan::Body;
use crate::robot::truss_statics::{Forces, ForcesError};
use crate::units::{Dimension, number, quantity};
use std::fmt;

/// The part of what struts bear that steps may use at rest, where struts have a limit on their acceleration.
const STRENGTH_AT_REST: f64 = 0.98;

/// A problem of locomotion: a truss, and the path that its centre of mass has to follow.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The truss, in the world's frame; it is put down on the ground and falls to where it rests.
    pub truss: TrussProblem,
    /// The points (x, y) in the world's frame, m, that the centre of mass has to reach one after another; at least one.
    pub path: Vec<[f64; 2]>,
}

/// The figures of a motion along a path and of the search for it: how far it came and why it ended, with the numbers
/// of steps and rolls.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The reason why the motion ends; unless it is [`End::Arrived`], before the end of the path.
    pub end: End,
    /// The reason why the motion ends in words, for a message.
    pub ended: String,
    /// The number of points of the path that the centre of mass reached, one after another.
    pub reached: usize,
    /// The length of the path of the centre of mass over the ground, m.
    pub distance: f64,
    /// The number of steps made, those included that were taken back because a roll after them was blocked.
    pub steps: usize,
    /// The number of rolls made, those included that were taken back.
    pub rolls: usize,
    /// The number of nodes placed beyond an edge before the centre of mass went there.
    pub footholds: usize,
    /// The number of steps that were easier ones of [`Settings::fallbacks`], since no ordinary step was found, those
    /// included that were taken back.
    pub relaxed_steps: usize,
    /// The distance that nodes in contact slid over the ground in steps, summed over nodes, m.
    pub slip: f64,
}

/// The reason why [`plan`] gives no motion at all.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The truss can't be planned for, for the reason given.
    Truss(InvalidTruss),
    /// The path that the problem gives has no point.
    EmptyPath,
    /// A coordinate of a point of the path is farther than [`EXTENT_MAX`] from 0, or not finite.
    TooFar,
    /// The truss does not come to rest on the ground.
    NeverRests,
    /// The struts would bear more than they can where the truss rests at first, however forces are distributed.
    Overloaded {
        /// The name of the strut that would bear most, from the names of its nodes: `a -- b`.
        strut: String,
        /// Its force, N, positive.
        force: f64,
        /// The greatest force that it bears, N.
        limit: f64,
    },
    /// No forces of any size hold a node where the truss rests at first.
    NoHold {
        /// The name of the node.
        node: String,
    },
    /// The nodes slide where the truss rests at first.
    Slides {
        /// The name of a node that slides.
        node: String,
        /// The coefficient of friction of nodes on the ground, without unit.
        friction: f64,
        /// The least coefficient that would hold it, without unit; `None` if none does.
        needed: Option<f64>,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Refusal::Truss(invalid) => invalid.fmt(f),
            Refusal::EmptyPath => f.write_str("a path has at least one place"),
            Refusal::TooFar => write!(f, "a path leads to places at most {EXTENT_MAX} m away"),
            Refusal::NeverRests => f.write_str("the truss does not come to rest on the ground"),
            Refusal::Overloaded { strut, force, limit } => {
                let [force, limit] = [force, limit].map(|force| quantity(*force, Dimension::FORCE));
                write!(
                    f,
                    "the strut {strut} would bear {force} where the truss rests at first; it can bear {limit}"
                )
            }
            Refusal::NoHold { node } => {
                write!(f, "no forces, of any size, hold the node {node} where the truss rests at first")
            }
            Refusal::Slides { node, friction, needed } => {
                let friction = number(*friction);
                write!(
                    f,
                    "the node {node} slides where the truss rests at first, with a friction of {friction}"
                )?;
                needed.map_or(Ok(()), |needed| write!(f, "; it takes {}", number(needed)))
            }
        }
    }
}

impl std::error::Error for Refusal {}

/// Plans a motion along the path, as far as it gets (Section IV of [Usevitch et al.](super::truss)): a search that gets
/// stuck, or that `progress` ends, gives the motion so far, and the report says why. The body is node paths in the
/// world's frame, for a world with gravity and ground. `problem`: the truss and the path; `settings`: the settings of
/// the search.
///
/// # Errors
/// A [`Refusal`] if the truss is invalid or does not come to rest on the ground, if nothing holds it there within the
/// limits, or if the path is empty or reaches too far.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let mut truss = problem.truss.structure(settings.tolerances).map_err(Refusal::Truss)?;
    truss.limits.forces = settings.forces.then(|| problem.truss.weight());
    let start = roll::settled(&truss, &problem.truss.nodes).ok_or(Refusal::NeverRests)?;
    problem.truss.check_start(&truss, &start).map_err(Refusal::Truss)?;
    if problem.path.is_empty() {
        return Err(Refusal::EmptyPath);
    }
    if !problem.path.iter().all(|place| in_reach(place)) {
        return Err(Refusal::TooFar);
    }
    bears_its_weight(&problem.truss, &truss, &start)?;
    // A part of the strength is left for the inertia of the nodes while they accelerate.
    let mut resting = truss.clone();
    if truss.acceleration.is_some() {
        resting.limits.forces =
            truss.limits.forces.clone().map(|model| model.with_strength(STRENGTH_AT_REST));
    }
    let travel = follow_path(&resting, &start, &problem.path, settings, progress);
    let report = Report {
        ended: ended(&problem.truss, &truss, settings, (&start, &travel)),
        distance: travelled_distance(&truss, &start, &travel.moves),
        reached: travel.reached,
        steps: travel.steps,
        rolls: travel.rolls,
        footholds: travel.footholds,
        relaxed_steps: travel.relaxed_steps,
        slip: travel.slip,
        end: travel.end,
    };
    let mut paths = node_paths(&problem.truss, &truss, &start, &travel.moves, settings.time_law, true);
    paths.limits.slip = if settings.slip_max.is_finite() { settings.slip_max } else { 0.0 };
    Ok(Solution { body: Body::NodePaths(paths), program: None, report })
}

/// Checks that forces within the limits hold a truss with its nodes at `x`, m, if they are limited.
///
/// # Errors
/// The refusal of a truss that they do not hold.
fn bears_its_weight(problem: &TrussProblem, truss: &Structure, x: &[Vec3]) -> Result<(), Refusal> {
    let Some(model) = &truss.limits.forces else { return Ok(()) };
    if forces::holds(truss, x) {
        return Ok(());
    }
    let node = |node: usize| problem.node_names[node].clone();
    match forces::levelled(truss, x) {
        Ok(found) if found.ratio > 1.0 => {
            let force = found.struts[found.strut].abs();
            let (strut, limit) = (problem.strut_name(found.strut), force / found.ratio);
            Err(Refusal::Overloaded { strut, force, limit })
        }
        Ok(_) => Ok(()),
        Err(ForcesError::Slides(at)) => {
            let (node, friction) = (node(at), model.friction);
            Err(Refusal::Slides { node, friction, needed: forces::friction_needed(truss, x) })
        }
        Err(ForcesError::NoHold(_) | ForcesError::Falls) => {
            Err(Refusal::NoHold { node: node(rigidity_weakest(truss, x)) })
        }
    }
}

/// Returns the reason why a motion ends in words. `travel`: the motion, from the positions of the nodes at its start, m.
fn ended(
    problem: &TrussProblem,
    truss: &Structure,
    settings: &Settings,
    (start, travel): (&[Vec3], &Travel),
) -> String {
    match &travel.end {
        End::Arrived => "arrived".to_string(),
        End::Steps => format!("{} steps were not enough", settings.steps_max),
        End::Falls => "it does not come to rest on three nodes".to_string(),
        End::Stuck(error) if error.constraints().contains(&Constraint::Force) => {
            let last = travel.moves.iter().fold(start.to_vec(), |x, step| moved(&x, step).into_owned());
            match forces::levelled(truss, &last) {
                Ok(found) => format!("no step keeps all limits: {}", loaded(problem, &found)),
                Err(_) => problem.explain(truss, error),
            }
        }
        End::Stuck(error) => problem.explain(truss, error),
        End::Blocked(constraint) => {
            format!("it would fall over an edge: {}", problem.explain_constraint(truss, *constraint))
        }
        End::ToAndFro => "it rolls to and fro, and comes no nearer".to_string(),
        End::Cancelled => "it was ended".to_string(),
    }
}

/// Returns in words what the strut that bears most bears where a motion ends.
fn loaded(problem: &TrussProblem, found: &Forces) -> String {
    let force = found.struts[found.strut].abs();
    let [bears, limit] = [force, force / found.ratio].map(|force| quantity(force, Dimension::FORCE));
    let strut = problem.strut_name(found.strut);
    format!("{strut} bears {bears} at best of the {limit} that it can, and more on the way on")
}
