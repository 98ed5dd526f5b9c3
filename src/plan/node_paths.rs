//! The body of plans of trusses: paths of the nodes; strut lengths follow.

use super::CauseId;
use crate::geometry::{HeightField, Placed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A truss whose nodes move between keyframes, on straight lines or as one rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodePaths {
    /// Index in [`Library::struts`](crate::robot::Library).
    pub strut: usize,
    pub node_names: Vec<String>,
    /// Pairs of nodes.
    pub struts: Vec<(usize, usize)>,
    /// In order of time; the first at 0.
    pub keyframes: Vec<Keyframe>,
    /// What it keeps beside the limits of its struts.
    #[serde(default, skip_serializing_if = "TrussLimits::is_none")]
    pub limits: TrussLimits,
    #[serde(default, skip_serializing_if = "Surroundings::is_none")]
    pub surroundings: Surroundings,
}

/// What is around a truss, in the world's frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surroundings {
    /// Solids that struts keep their clearance from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Vec<Placed>>,
    /// The ground that nodes stand on, where it is not flat at height 0. Nodes are taken to be balls as
    /// thick as the clearance on each side, struts as half of it: between its nodes a strut may be half a
    /// clearance below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<HeightField>,
}

impl Surroundings {
    pub fn is_none(&self) -> bool {
        *self == Surroundings::default()
    }

    /// How far a place is above the ground, m.
    pub fn above(&self, p: crate::geometry::Vec3) -> f64 {
        self.terrain.as_ref().map_or(p.z, |terrain| terrain.above(p))
    }
}

/// Limits of a truss beside those that every strut has.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrussLimits {
    /// The least angle between struts that share a node, rad; of 0 there is none.
    #[serde(default)]
    pub angle: f64,
    /// What the singular values of the rigidity matrix (rows of unit vectors) that belong to no rigid motion
    /// stay above at the keyframes; of 0 there is nothing.
    #[serde(default)]
    pub rigidity: f64,
    /// Struts whose lengths stay, and sums of lengths that do.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sums: Vec<LengthSum>,
}

/// Struts whose lengths add up to something that stays: one that failed, or those of one tube.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthSum {
    /// Indices of struts.
    pub struts: Vec<usize>,
    /// The least and the greatest sum, m.
    pub range: (f64, f64),
}

impl TrussLimits {
    pub fn is_none(&self) -> bool {
        *self == TrussLimits::default()
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Seconds.
    pub time: f64,
    /// The motion of the nodes from the keyframe before to this one; without meaning at the first.
    pub interpolation: Interpolation,
    /// World position of each node, m.
    pub nodes: Vec<[f64; 3]>,
    pub cause: CauseId,
    #[serde(default, skip_serializing_if = "Margins::is_none")]
    pub margins: Margins,
}

/// By how much a truss is within its limits at a keyframe; negative outside. Nothing of limits that it has not, nor of
/// distances that are more than twice the clearance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Margins {
    /// To the nearer end of the range of a strut's lengths, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Beyond the clearance between struts that share no node, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Beyond the clearance from obstacles, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<f64>,
    /// Of the centre of mass inside the hull of the nodes on the ground, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support: Option<f64>,
    /// Beyond the least angle between struts that share a node, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Of the least singular value above its limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rigidity: Option<f64>,
    /// To the nearer end of the range of a sum of lengths, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sum: Option<f64>,
}

impl Margins {
    pub fn is_none(&self) -> bool {
        *self == Margins::default()
    }
}

/// The motion of the nodes between two keyframes, at a constant rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Interpolation {
    /// Every node moves along a straight line at constant speed.
    Linear,
    /// The whole truss turns as a rigid body about the line through two nodes that stay, from the
    /// first to the second by the right-hand rule; radians. No strut changes its length.
    RigidRoll { edge: (usize, usize), angle: f64 },
}

impl NodePaths {
    /// Seconds.
    pub fn duration(&self) -> f64 {
        self.keyframes.last().map_or(0.0, |k| k.time)
    }

    /// World position of each node at a time in seconds, m.
    pub fn state(&self, t: f64) -> Vec<[f64; 3]> {
        let after = self.keyframes.partition_point(|k| k.time <= t);
        let Some(before) = after.checked_sub(1).map(|i| &self.keyframes[i]) else {
            return self.keyframes.first().map_or_else(Vec::new, |k| k.nodes.clone());
        };
        let Some(next) = self.keyframes.get(after) else { return before.nodes.clone() };
        let part = (t - before.time) / (next.time - before.time);
        match next.interpolation {
            Interpolation::Linear => straight(&before.nodes, &next.nodes, part),
            Interpolation::RigidRoll { edge, angle } => rolled(&before.nodes, edge, angle * part),
        }
    }

    /// Length of each strut at a time, m.
    pub fn lengths(&self, t: f64) -> Vec<f64> {
        let nodes = self.state(t);
        let at = |i: usize| crate::geometry::Vec3::from(nodes[i]);
        self.struts.iter().map(|&(a, b)| (at(a) - at(b)).norm()).collect()
    }
}

fn straight(from: &[[f64; 3]], to: &[[f64; 3]], part: f64) -> Vec<[f64; 3]> {
    let along = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part);
    from.iter().zip(to).map(along).collect()
}

/// Nodes turned about the line through two of them.
fn rolled(nodes: &[[f64; 3]], edge: (usize, usize), angle: f64) -> Vec<[f64; 3]> {
    use crate::geometry::{Vec3, pose::turned};
    let origin = Vec3::from(nodes[edge.0]);
    let turn = turned(Vec3::from(nodes[edge.1]) - origin, angle);
    nodes.iter().map(|&p| (origin + turn.rotation * (Vec3::from(p) - origin)).into()).collect()
}
