//! The bodies of plans, one of three families behind one interface. This is the only file of the room that
//! distinguishes the families; the code of each is in its folder.

use super::fault::PlanFault;
use super::node_paths::{self, NodePaths};
use super::operation_error::OperationError;
use super::program::Node;
use super::stages::{self, CellBox, Stages};
use super::stated::Stated;
use super::tracks::{self, Remap, Tracks};
use super::world::{DynamicsModel, World};
use crate::robot::{Library, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The motion of a plan, in the form of the family of its robot: articulated, lattice or truss.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// The motion of an articulated robot: piecewise polynomial joint positions, docking and undocking.
    Tracks(Tracks),
    /// The motion of a lattice of expanding cubes: trajectories in closed form, exact.
    Stages(Stages),
    /// The motion of a truss: paths of the nodes, from which strut lengths follow.
    NodePaths(NodePaths),
}

/// The configuration of a plan's robot at an instant.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshot {
    /// The joint positions, the bonds and the base pose of an articulated robot.
    Robot(State),
    /// The boxes of the cells of a lattice, by the number of the cell, in cell sizes.
    Cells(Vec<CellBox>),
    /// The world positions of the nodes of a truss, by the index of the node, m.
    Nodes(Vec<[f64; 3]>),
}

/// The motion of one body followed by that of another, as [`Body::joined`] returns it.
pub(super) struct Appended {
    /// The motion of both.
    pub(super) body: Body,
    /// The map of the second robot's names to those of the first; `None` for families whose robots have no names.
    pub(super) remap: Option<Remap>,
}

impl From<Tracks> for Body {
    fn from(tracks: Tracks) -> Body {
        Body::Tracks(tracks)
    }
}

impl From<Stages> for Body {
    fn from(stages: Stages) -> Body {
        Body::Stages(stages)
    }
}

impl From<NodePaths> for Body {
    fn from(paths: NodePaths) -> Body {
        Body::NodePaths(paths)
    }
}

impl Body {
    /// Returns the duration of the motion, s.
    pub fn duration(&self) -> f64 {
        match self {
            Body::Tracks(tracks) => tracks.duration,
            Body::Stages(stages) => stages.duration(),
            Body::NodePaths(paths) => paths.duration(),
        }
    }

    /// Returns the configuration at a time `t` from the start of the plan (s); before the start and after the end,
    /// that of the nearer end.
    pub fn state(&self, t: f64) -> Snapshot {
        match self {
            Body::Tracks(tracks) => Snapshot::Robot(tracks.state(t)),
            Body::Stages(stages) => Snapshot::Cells(stages.state(t)),
            Body::NodePaths(paths) => Snapshot::Nodes(paths.state(t)),
        }
    }

    /// Returns every instant (s from the start of the plan) at which the law of motion changes, with 0 and the end,
    /// ascending.
    pub fn instants(&self) -> Vec<f64> {
        match self {
            Body::Tracks(tracks) => tracks.instants(),
            Body::Stages(stages) => stages.instants(),
            Body::NodePaths(paths) => paths.instants(),
        }
    }

    /// Returns the tracks; `None` unless this is the plan of an articulated robot.
    pub fn tracks(&self) -> Option<&Tracks> {
        if let Body::Tracks(tracks) = self { Some(tracks) } else { None }
    }

    /// Returns the node paths; `None` unless this is the plan of a truss.
    pub fn node_paths(&self) -> Option<&NodePaths> {
        if let Body::NodePaths(paths) = self { Some(paths) } else { None }
    }

    /// Returns (count, unit): the number of units that the robot is made of, and the name of one, `module`, `cell` or
    /// `strut`.
    pub fn units(&self) -> (u64, &'static str) {
        match self {
            Body::Tracks(tracks) => (tracks.robot.modules.len() as u64, "module"),
            Body::Stages(stages) => (stages.count, "cell"),
            Body::NodePaths(paths) => (paths.struts.len() as u64, "strut"),
        }
    }

    /// Returns the dynamics that plans of this family are judged under in a world: for articulated robots those of the
    /// world, though a plan of several worlds is judged under full dynamics in all of them if one asks for them
    /// ([`is_full`](super::is_full)); [`DynamicsModel::Statics`] for trusses, and [`DynamicsModel::Kinodynamic`] for
    /// lattices.
    pub fn dynamics(&self, world: &World) -> DynamicsModel {
        match self {
            Body::Tracks(_) => world.dynamics,
            Body::NodePaths(_) => DynamicsModel::Statics,
            Body::Stages(_) => DynamicsModel::Kinodynamic,
        }
    }

    /// Returns true if a plan file needs what version 3 added, of lattices.
    pub(super) fn needs_version_3(&self) -> bool {
        matches!(self, Body::Stages(stages) if stages.needs_version_3())
    }

    /// Returns true if a plan file needs what version 4 added: trusses whose nodes merge and split.
    pub(super) fn needs_version_4(&self) -> bool {
        self.node_paths().is_some_and(|paths| !paths.events.is_empty() || !paths.merged.is_empty())
    }

    /// Returns the motion in reverse, from its end to its start.
    pub(super) fn reversed(&self) -> Body {
        match self {
            Body::Tracks(tracks) => tracks.reversed().into(),
            Body::Stages(stages) => stages.reversed().into(),
            Body::NodePaths(paths) => paths.reversed().into(),
        }
    }

    /// Returns the motion between two times, s from the start of the plan, which must lie within it, the lesser
    /// first.
    ///
    /// # Errors
    /// [`OperationError::InsideStage`] for a lattice whose cells move at one of the times.
    pub(super) fn sliced(&self, from: f64, to: f64) -> Result<Body, OperationError> {
        Ok(match self {
            Body::Tracks(tracks) => tracks.sliced(from, to).into(),
            Body::Stages(stages) => stages.sliced(from, to)?.into(),
            Body::NodePaths(paths) => paths.sliced(from, to).into(),
        })
    }

    /// Returns this motion and then another, whose causes are numbered from `causes` on. Each body is given with the
    /// library that its indices refer to.
    ///
    /// # Errors
    /// The [`OperationError`] that keeps the two from following each other: of another family, another robot, kind of
    /// cells or truss, or another state where they meet; or a number of a lattice's motion that 64 bits do not hold.
    pub(super) fn joined(
        &self,
        library: &Library,
        next: &Body,
        library_of_next: &Library,
        causes: u32,
    ) -> Result<Appended, OperationError> {
        match (self, next) {
            (Body::Tracks(a), Body::Tracks(b)) => {
                let remap = tracks::fitted(a, b, causes)?;
                Ok(Appended { body: remap.tracks(a, b).into(), remap: Some(remap) })
            }
            (Body::Stages(a), Body::Stages(b)) => {
                if library.cells.get(a.cell) != library_of_next.cells.get(b.cell) {
                    return Err(OperationError::Cells);
                }
                Ok(Appended { body: stages::joined(a, b, causes)?.into(), remap: None })
            }
            (Body::NodePaths(a), Body::NodePaths(b)) => {
                Ok(Appended { body: node_paths::joined(a, b, causes)?.into(), remap: None })
            }
            _ => Err(OperationError::Families),
        }
    }

    /// Returns a program that makes the robot move as the body states, by the clock: its actions last as long as the
    /// pieces of motion, and no condition ends them.
    ///
    /// # Errors
    /// [`OperationError::NoJoints`] for a robot without joints, [`OperationError::NoCommand`] for a motion that no
    /// command states.
    pub(super) fn timeline(&self) -> Result<Arc<Node>, OperationError> {
        self.tracks().map_or(Err(OperationError::NoJoints), tracks::timeline)
    }

    /// Checks that the body is well formed, by the rules of its family. `library`: that of the plan; `causes`: the
    /// number of causes of the plan.
    ///
    /// In every family indices must be within their lists and times in order. Of tracks also: modules have different
    /// names, the start has a position for every joint and a state for every bond, segments have 2 to
    /// [`DEGREE_MAX`](super::polynomial::DEGREE_MAX) + 1 control points and begin where the joint is, and a bond is
    /// closed before it opens and open before it closes. Of stages: there are not too many cells, runs name cells
    /// there are, and ratios, limits and ramps are in their ranges. Of node paths: keyframes begin at 0 s and place
    /// every node, and a roll is about two different nodes.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(super) fn validate(&self, library: &Library, causes: usize) -> Result<(), PlanFault> {
        match self {
            Body::Tracks(tracks) => tracks.validate(causes),
            Body::Stages(stages) => stages.validate(library, causes),
            Body::NodePaths(paths) => paths.validate(library, causes),
        }
    }

    /// Checks that all numbers of the motion of an articulated robot are finite, before the references are checked.
    /// Does nothing for the other families: the numbers of stages are whole, those of node paths are checked by
    /// [`check_ranges`](Self::check_ranges).
    ///
    /// # Errors
    /// [`PlanFault::Unwritable`] for the first number that is not finite.
    pub(super) fn check_numbers(&self) -> Result<(), PlanFault> {
        self.tracks().map_or(Ok(()), Tracks::check_numbers)
    }

    /// Checks that the numbers of the body are in their ranges, and what depends on them: of tracks that joints can be
    /// moved and stay in their bounds and that docked ports mate, of node paths that numbers are finite, obstacles are
    /// solids, and struts and rolls have a length; of stages nothing is left to check. The references must have been
    /// checked, or it panics. `library`: that of the plan.
    ///
    /// # Errors
    /// The first [`PlanFault`] found.
    pub(super) fn check_ranges(&self, library: &Arc<Library>) -> Result<(), PlanFault> {
        match self {
            Body::Tracks(tracks) => tracks.check_ranges(library),
            // Whole numbers are in their ranges where their references are right.
            Body::Stages(_) => Ok(()),
            Body::NodePaths(paths) => paths.check_ranges(),
        }
    }
}

/// A body as it stands in a plan file.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename = "Body", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum BodyJson<'a> {
    Tracks(tracks::TracksJson<'a>),
    Stages(stages::StagesJson<'a>),
    NodePaths(node_paths::NodePathsJson<'a>),
}

impl<'a> BodyJson<'a> {
    /// Returns a body as it stands in a plan file, with names out of `library` beside indices; long lists are
    /// borrowed.
    pub(super) fn of(body: &'a Body, library: &Library) -> BodyJson<'a> {
        match body {
            Body::Tracks(tracks) => BodyJson::Tracks(tracks::TracksJson::of(tracks)),
            Body::Stages(stages) => BodyJson::Stages(stages::StagesJson::of(stages, library)),
            Body::NodePaths(paths) => BodyJson::NodePaths(node_paths::NodePathsJson::of(paths, library)),
        }
    }

    /// Adds the names that the file states beside indices to `stated`, in the order of the file.
    pub(super) fn names(&self, stated: &mut Stated) {
        match self {
            BodyJson::Tracks(tracks) => tracks.names(stated),
            BodyJson::Stages(stages) => stages.names(stated),
            BodyJson::NodePaths(paths) => paths.names(stated),
        }
    }

    /// Returns the body that stands in a file; `library`: the one that its indices refer to. Nothing else is checked.
    ///
    /// # Errors
    /// [`StagesFault::StageEnd`](super::StagesFault::StageEnd) for a stage of a lattice that states its end in no
    /// way, or in two.
    pub(super) fn into_body(self, library: &Arc<Library>) -> Result<Body, PlanFault> {
        Ok(match self {
            BodyJson::Tracks(tracks) => tracks.into_tracks(library).into(),
            BodyJson::Stages(stages) => stages.into_stages()?.into(),
            BodyJson::NodePaths(paths) => paths.into_node_paths().into(),
        })
    }
}
