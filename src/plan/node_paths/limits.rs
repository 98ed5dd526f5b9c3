//! The limits of a truss beside those of its struts, its surroundings, and its margins from both.

use crate::geometry::{HeightField, Placed, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The surroundings of a truss, in the world's frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surroundings {
    /// The solids that struts keep their clearance from, each the union of some shapes, in the world's frame (m).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Vec<Placed>>,
    /// The ground that nodes stand on, in the world's frame; `None`: flat at height 0. Nodes are taken to be balls as
    /// thick as the clearance on each side, struts as half of it: between its nodes a strut may be half a clearance
    /// below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<HeightField>,
}

impl Surroundings {
    /// Returns true if there are no obstacles, and the ground is flat at height 0.
    pub fn is_none(&self) -> bool {
        *self == Surroundings::default()
    }

    /// Returns the height of a world position (m) above the ground, measured along z, m; negative below it.
    pub fn above(&self, p: Vec3) -> f64 {
        self.terrain.as_ref().map_or(p.z, |terrain| terrain.above(p))
    }

    /// Returns the normal of the ground below a world position (m), a unit vector that points up.
    pub fn normal(&self, p: Vec3) -> Vec3 {
        let [a, b] = self.terrain.as_ref().map_or([0.0; 2], |terrain| terrain.slope(p.x, p.y));
        Vec3::new(-a, -b, 1.0).normalize()
    }
}

/// The limits of a truss beside those that every strut has.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrussLimits {
    /// The least angle between struts that share a node, rad; 0: no limit.
    #[serde(default)]
    pub angle: f64,
    /// The value above which the least singular value of the rigidity matrix (rows of unit vectors) that belongs to
    /// no rigid motion stays; without unit; 0: the judge's default limit, 0.05, or an eighth of the value at the start
    /// if that is less.
    #[serde(default)]
    pub rigidity: f64,
    /// The greatest distance that nodes on the ground slide, summed over all, m; 0: no limit.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub slip: f64,
    /// Sums of lengths that stay in a range; a single strut whose length stays is one, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sums: Vec<LengthSum>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The range of a sum of strut lengths: of several struts of one tube, or of a single strut that has failed and keeps
/// its length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthSum {
    /// The indices of the struts in the plan's list, from 0.
    pub struts: Vec<usize>,
    /// The least and the greatest sum of the lengths, m.
    pub range: (f64, f64),
}

impl TrussLimits {
    /// Returns true if the truss has no limits beside those of its struts.
    pub fn is_none(&self) -> bool {
        *self == TrussLimits::default()
    }
}

/// The margins of a truss from its limits at a keyframe; negative beyond a limit. `None` for limits that it does not
/// have, and for distances that are more than twice the clearance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Margins {
    /// The least distance of a strut's length to the nearer end of its range, m; `None` if the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// The least distance between struts that share no node minus the clearance, m; `None` if none are nearer than
    /// twice the clearance, or the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// The least distance of a strut from an obstacle minus the clearance, m; `None` if none is nearer than twice the
    /// clearance, or the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<f64>,
    /// The distance of the centre of mass inside the hull of the nodes on the ground, m; `None` without ground, or if
    /// the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support: Option<f64>,
    /// The least angle between struts that share a node minus the limit, rad; `None` without a limit, or if the
    /// margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// The least singular value of the rigidity matrix minus its limit, without unit; `None` without a limit, or if
    /// the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rigidity: Option<f64>,
    /// The least distance of a sum of lengths to the nearer end of its range, m; `None` without limited sums, or if
    /// the margin is not stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sum: Option<f64>,
}

impl Margins {
    /// Returns true if no margin is stated.
    pub fn is_none(&self) -> bool {
        *self == Margins::default()
    }
}
