//! The body of plans of trusses: trajectories of the nodes, from which strut lengths follow.

use super::limits::{Margins, Surroundings, TrussLimits};
use super::ramps::Ramps;
use super::topology::TopologyEvent;
use crate::geometry::Vec3;
use crate::geometry::pose::turned;
use crate::plan::cause::CauseId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The trajectory of a truss: its nodes move between keyframes, on straight lines or as one rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodePaths {
    /// The index of the strut type in [`Library::struts`](crate::robot::Library).
    pub strut: usize,
    /// The names of the nodes; the index of a node here, from 0, names it in the whole plan.
    pub node_names: Vec<String>,
    /// The struts with the ends that they have at the start, each a pair of indices of nodes; the index of a strut here,
    /// from 0, names it in the whole plan.
    pub struts: Vec<(usize, usize)>,
    /// The nodes that ride along with others at the start, ascending, each with the node that it was merged into.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub merged: Vec<(usize, usize)>,
    /// The keyframes, in order of time; the first at 0.
    pub keyframes: Vec<Keyframe>,
    /// The nodes that merge and split, in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<TopologyEvent>,
    /// The limits of the truss beside those of its struts.
    #[serde(default, skip_serializing_if = "TrussLimits::is_none")]
    pub limits: TrussLimits,
    /// The obstacles and the terrain, in the world's frame.
    #[serde(default, skip_serializing_if = "Surroundings::is_none")]
    pub surroundings: Surroundings,
}

/// The positions of all nodes at an instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// The time of the keyframe from the start of the plan, s.
    pub time: f64,
    /// The motion of the nodes from the keyframe before to this one; without meaning at the first.
    pub interpolation: Interpolation,
    /// The velocity profile of a linear motion to this keyframe; none: its rate is constant.
    #[serde(default = "no_ramps", skip_serializing_if = "Ramps::is_none")]
    pub ramps: Ramps,
    /// The world position of each node, by its index in [`NodePaths::node_names`], m.
    pub nodes: Vec<[f64; 3]>,
    /// The index in the plan's causes of the source command that this keyframe comes from.
    pub cause: CauseId,
    /// The margins from the limits at this keyframe, as the planner states them.
    #[serde(default, skip_serializing_if = "Margins::is_none")]
    pub margins: Margins,
}

fn no_ramps() -> Ramps {
    Ramps::NONE
}

/// The path of the nodes between two keyframes; the rate at which they follow it is constant, but for [`Keyframe::ramps`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Interpolation {
    /// Every node moves along a straight line, and all progress alike.
    Linear,
    /// The whole truss turns as a rigid body about the line through two nodes that stay, directed from the first to
    /// the second, by the right-hand rule. No strut changes its length.
    RigidRoll {
        /// The indices of the two nodes that stay, in [`NodePaths::node_names`].
        edge: (usize, usize),
        /// The angle of the roll, rad.
        angle: f64,
    },
}

impl NodePaths {
    /// Returns the duration of the plan, the time of the last keyframe, s.
    pub fn duration(&self) -> f64 {
        self.keyframes.last().map_or(0.0, |k| k.time)
    }

    /// Returns the times of the keyframes, s, ascending.
    pub fn instants(&self) -> Vec<f64> {
        self.keyframes.iter().map(|k| k.time).collect()
    }

    /// Returns the world position of each node, by index, m, at the time `t` (s); before the start and after the end,
    /// that of the nearer end. Empty without keyframes.
    pub fn state(&self, t: f64) -> Vec<[f64; 3]> {
        let after = self.keyframes.partition_point(|k| k.time <= t);
        let Some(before) = after.checked_sub(1).map(|i| &self.keyframes[i]) else {
            return self.keyframes.first().map_or_else(Vec::new, |k| k.nodes.clone());
        };
        let Some(next) = self.keyframes.get(after) else { return before.nodes.clone() };
        let part = next.ramps.progress(next.time - before.time).at(t - before.time);
        match next.interpolation {
            Interpolation::Linear => straight(&before.nodes, &next.nodes, part),
            Interpolation::RigidRoll { edge, angle } => rolled(&before.nodes, edge, angle * part),
        }
    }

    /// Returns the length (m) of each strut, by its index in [`NodePaths::struts`], at the time `t` (s).
    pub fn lengths(&self, t: f64) -> Vec<f64> {
        let nodes = self.state(t);
        let at = |i: usize| Vec3::from(nodes[i]);
        self.struts(t).iter().map(|&(a, b)| (at(a) - at(b)).norm()).collect()
    }
}

fn straight(from: &[[f64; 3]], to: &[[f64; 3]], part: f64) -> Vec<[f64; 3]> {
    let along = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part);
    from.iter().zip(to).map(along).collect()
}

/// Returns the nodes turned about the line through two of them by an angle, rad.
fn rolled(nodes: &[[f64; 3]], edge: (usize, usize), angle: f64) -> Vec<[f64; 3]> {
    let origin = Vec3::from(nodes[edge.0]);
    let turn = turned(Vec3::from(nodes[edge.1]) - origin, angle);
    nodes.iter().map(|&p| (origin + turn.rotation * (Vec3::from(p) - origin)).into()).collect()
}
