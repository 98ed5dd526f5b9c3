//! `morph`: a truss of linear actuators takes on a shape (section V of the linear-actuator-robots paper; the
//! kernel is [`planners::truss`](super::truss)). There is neither gravity nor ground, as in the paper.
//!
//! ```
//! use modl::geometry::Vec3;
//! use modl::planners::morph::{self, TargetShape};
//! use modl::planners::truss::{Limits, problem::TrussProblem};
//! use modl::planners::NoProgress;
//! use modl::robot::Strut;
//!
//! // A regular tetrahedron with edges of one metre.
//! let (a, b) = (3f64.sqrt() / 2.0, (2f64 / 3.0).sqrt());
//! let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, a, 0.0], [0.5, a / 3.0, b]].map(Vec3::from);
//! let name = "Actuator".to_owned();
//! let (acceleration, buckling, node_mass) = (Some(2.0), None, None);
//! let (length, clearance) = ((0.3, 3.0), 0.05);
//! let (speed, force, mass) = (1.0, 300.0, 1.0);
//! let strut = Strut { name, length, speed, acceleration, force, mass, clearance, buckling, node_mass };
//! let truss = TrussProblem {
//!     strut,
//!     node_names: (0..4).map(|i| format!("n[{i}]")).collect(),
//!     nodes: nodes.to_vec(),
//!     struts: vec![(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)],
//!     limits: Limits::default(),
//!     obstacles: Vec::new(),
//!     terrain: None,
//!     friction: 1.0,
//! };
//! // The same tetrahedron, half as large again.
//! let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
//! let target = TargetShape::Mesh(faces.iter().map(|face| face.map(|i| nodes[i] * 1.5)).collect());
//! let problem = morph::Problem { truss, target };
//! let solution = morph::plan(&problem, &morph::Settings::default(), &mut NoProgress)?;
//! assert_eq!(solution.report.end, morph::End::Done);
//! assert!(solution.report.distance.target_to_surface < 0.02);
//! # Ok::<(), morph::Refusal>(())
//! ```

mod descent;
mod fit;
mod measure;
mod surface;
mod target;

pub use descent::{Descent, End, Settings, descend};
pub use fit::Distance;
pub use surface::{ClosestPoint, Open, Surface, outer};
pub use target::Target;

use super::truss::motion::{Findings, Move, node_paths};
use super::truss::problem::{InvalidTruss, TrussProblem};
use super::{Progress, Solution};
use crate::geometry::soundness::{EXTENT_MAX, in_reach};
use crate::geometry::{Pose, Vec3};
use crate::plan::Body;
use std::fmt;

/// The least number of points of a cloud that is a target.
const POINTS_MIN: usize = 4;

/// A problem of shape morphing: a truss, and the shape that it has to take on.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The truss, in the world's frame.
    pub truss: TrussProblem,
    /// The shape, m, in the world's frame; it is moved so that its centroid is the mean of the nodes at the start.
    pub target: TargetShape,
}

/// A shape that a truss has to take on, given as a surface or as points.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetShape {
    /// A surface, given by the corners of its triangles, m.
    Mesh(Vec<[Vec3; 3]>),
    /// A cloud of points on a surface, m, of equal weight.
    Cloud(Vec<Vec3>),
}

impl TargetShape {
    /// Returns the shape transformed by `X`: one in frame T for `X_WT` becomes one in frame W.
    #[allow(non_snake_case)]
    fn moved(&self, X: &Pose) -> TargetShape {
        let at = |p: &Vec3| X.transform_point(&(*p).into()).coords;
        match self {
            TargetShape::Mesh(triangles) => {
                TargetShape::Mesh(triangles.iter().map(|t| t.each_ref().map(at)).collect())
            }
            TargetShape::Cloud(points) => TargetShape::Cloud(points.iter().map(at).collect()),
        }
    }
}

/// The figures of a morph: the fit at its start and at its end, and why it ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The distances between the outer surface and the target at the end, over the whole of both.
    pub distance: Distance,
    /// The distances between the outer surface and the target at the start, over the whole of both, with the target in its
    /// final orientation.
    pub start: Distance,
    /// The target where the truss takes it on, in the world's frame.
    pub target: TargetShape,
    /// The reason why the motion ends; unless it is [`End::Done`], short of the tolerance.
    pub end: End,
    /// The reason why the motion ends in words, for a message.
    pub ended: String,
}

/// The reason why [`plan`] gives no motion at all.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The truss can't be planned for, for the reason given.
    Truss(InvalidTruss),
    /// A coordinate of a corner or point of the target is farther than [`EXTENT_MAX`] from 0, or not finite.
    TooFar,
    /// The triangles of the target have no area.
    NoArea,
    /// The cloud of points has fewer than four.
    FewPoints {
        /// The number of points of the cloud.
        points: usize,
    },
    /// The truss has no outer surface of triangles of struts.
    NoSurface {
        /// The edges of the truss's convex hull that do not lie between two triangles of struts, as pairs of indices
        /// of nodes, the lesser first.
        edges: Vec<(usize, usize)>,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Refusal::Truss(invalid) => invalid.fmt(f),
            Refusal::TooFar => write!(f, "a target reaches to at most {EXTENT_MAX} m"),
            Refusal::NoArea => f.write_str("a surface without area is no target"),
            Refusal::FewPoints { points } => {
                write!(f, "a target has at least {POINTS_MIN} points; these are {points}")
            }
            Refusal::NoSurface { .. } => {
                f.write_str("a truss that morphs has an outer surface: its hull, of triangles of struts")
            }
        }
    }
}

impl std::error::Error for Refusal {}

/// Plans a motion towards the target, as near as it gets (Section V of [Usevitch et al.](super::truss)): a search that
/// gets stuck, or that `progress` ends, gives the motion to the best fit so far, and the report says why. The body is
/// node paths in the world's frame, for a world without gravity and ground. `problem`: the truss and the target;
/// `settings`: the settings of the descent.
///
/// # Errors
/// A [`Refusal`] if the truss is invalid or has no outer surface of triangles, or if the target reaches too far, has no
/// area, or has too few points.
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let truss = problem.truss.structure(settings.tolerances).map_err(Refusal::Truss)?;
    let start = &problem.truss.nodes;
    problem.truss.check_start(&truss, start).map_err(Refusal::Truss)?;
    let target = target(&problem.target, settings.sample_spacing * truss.unit)?;
    let found = descend(&truss, start, &target, settings, progress)
        .map_err(|open| Refusal::NoSurface { edges: open.edges })?;
    let ended = match &found.end {
        End::Done => "done".to_string(),
        End::Steps => format!("{} steps were not enough", settings.steps_max),
        End::Stuck(error) => problem.truss.explain(&truss, error),
        End::Cancelled => "it was ended".to_string(),
    };
    let moves: Vec<Move> = found.steps.into_iter().map(|y| Move::Linear(y, Findings::default())).collect();
    let paths = node_paths(&problem.truss, &truss, start, &moves, settings.time_law, false);
    let target = problem.target.moved(&found.target);
    let (distance, start) = (found.measured, found.start_measured);
    let report = Report { distance, start, target, end: found.end, ended };
    Ok(Solution { body: Body::NodePaths(paths), program: None, report })
}

/// Returns the target with its sample points; `spacing` in m.
fn target(shape: &TargetShape, spacing: f64) -> Result<Target, Refusal> {
    let near = |p: &Vec3| in_reach(p.as_slice());
    let in_reach = match shape {
        TargetShape::Mesh(triangles) => triangles.iter().flatten().all(near),
        TargetShape::Cloud(points) => points.iter().all(near),
    };
    if !in_reach {
        return Err(Refusal::TooFar);
    }
    match shape {
        TargetShape::Mesh(triangles) => {
            let area: f64 = triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a)).norm()).sum();
            if area <= 0.0 {
                return Err(Refusal::NoArea);
            }
            Ok(Target::surface(triangles.clone(), spacing))
        }
        TargetShape::Cloud(points) if points.len() < POINTS_MIN => {
            Err(Refusal::FewPoints { points: points.len() })
        }
        TargetShape::Cloud(points) => Ok(Target::cloud(points.clone())),
    }
}
