//! Paths in space that a plan states of ports: straight lines and arcs, with the greatest deviation from them.
//!
//! A stated path is geometry, without times along it: so it holds of any part of the motion, and of the motion run backwards or
//! at another pace.

use super::cause::CauseId;
use crate::geometry::{Pose, Vec3};
use crate::robot::PortRef;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A path that a port keeps to over an interval of a plan of an articulated robot. All places are in the frame of the body of a
/// module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StatedPath {
    /// The port that keeps to the path.
    pub port: PortRef,
    /// The index of the module in whose body's frame the path is.
    pub module: usize,
    /// The beginning of the interval, s from the start of the plan.
    pub from: f64,
    /// The end of the interval, s from the start of the plan.
    pub to: f64,
    /// The pose of the port at the beginning of the path, m.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub start: Pose,
    /// The pose of the port at the end of the path, m; its orientation is reached from the first by the least turn about one
    /// axis.
    #[serde(with = "crate::geometry::json")]
    #[schemars(with = "crate::geometry::json::PoseText")]
    pub end: Pose,
    /// A point between the two, m, through which the path is an arc of a circle; absent for a straight line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub via: Option<[f64; 3]>,
    /// The greatest distance of the port from the path, m.
    pub within: f64,
    /// The greatest angle of the port from the turn, rad; absent where its orientation is free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turned_within: Option<f64>,
    /// The index in the plan's causes of the command that states the path.
    pub cause: CauseId,
}

impl StatedPath {
    /// Returns the point through which the path is an arc, m; `None` for a straight line.
    pub fn via(&self) -> Option<Vec3> {
        self.via.map(Vec3::from)
    }

    /// Returns the path over the part of its interval within two times (s), `from` being the new start of the plan; `None` if
    /// nothing of it is left.
    pub fn between(&self, from: f64, to: f64) -> Option<StatedPath> {
        let (begin, end) = (self.from.max(from), self.to.min(to));
        (begin < end).then(|| StatedPath { from: begin - from, to: end - from, ..self.clone() })
    }

    /// Returns the path in a plan that runs backwards and lasts `duration` (s).
    pub fn reversed(&self, duration: f64) -> StatedPath {
        StatedPath { from: duration - self.to, to: duration - self.from, ..self.clone() }
    }

    /// Returns the path at the times that `clock` (s to s, ascending) gives.
    pub fn retimed(&self, clock: &dyn Fn(f64) -> f64) -> StatedPath {
        StatedPath { from: clock(self.from), to: clock(self.to), ..self.clone() }
    }
}
