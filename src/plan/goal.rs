//! Motions that are stated by their goal: they stand in behaviours only, and become actions when a behaviour is planned.

use super::cause::CauseId;
use super::program::{Action, Node, Profile};
use crate::geometry::{Pose, Vec3};
use crate::robot::PortRef;
use crate::robot::chain::{Orientation, PoseError};
use std::sync::Arc;

/// A motion that is stated by its goal, such as a pose of a port. The motion of joints follows from the state in which it
/// begins, which is known when the behaviour that it stands in is planned; no plan has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// The goal, and the way to it.
    pub kind: GoalKind,
    /// An action for each joint that the motion may command, by which conflicts with other commands are found: no such
    /// action is carried out.
    pub stand_ins: Vec<Action>,
    /// The index in the plan's causes of the source command that the motion comes from.
    pub cause: CauseId,
}

/// A port, and what its pose is measured against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalFrame {
    /// The port that moves.
    pub port: PortRef,
    /// The module, by its index in the assembly, in whose body's frame places are given and whose body stays where it is;
    /// `None`: places are in the world, and the base of the port's robot stays where it is.
    pub module: Option<usize>,
}

/// The end of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineEnd {
    /// The port comes to a pose, m.
    To(Pose),
    /// The port moves by a vector, m, and keeps its orientation.
    By(Vec3),
}

/// The kind of a motion that is stated by its goal.
#[derive(Clone, Debug, PartialEq)]
pub enum GoalKind {
    /// A port comes to a place, and the joints move together, from rest to rest.
    Reach {
        /// The port that moves, and what against.
        frame: GoalFrame,
        /// The position of the port, m.
        position: Vec3,
        /// The orientation of the port.
        orientation: Orientation,
        /// The duration, s; `None`: the least that the joints' limits allow.
        duration: Option<f64>,
        /// The law of time of all joints.
        profile: Profile,
        /// The greatest number of postures from which the search begins.
        starts: usize,
        /// The seed of the random ones among them.
        seed: u64,
    },
    /// A port goes straight, or along an arc.
    Line {
        /// The port that moves, and what against.
        frame: GoalFrame,
        /// The end of the way.
        end: LineEnd,
        /// The point of an arc between its ends, m; `None` for a straight line.
        via: Option<Vec3>,
        /// The duration, s; `None`: the least that the joints' limits allow.
        duration: Option<f64>,
        /// True if the port's orientation is free on the way and at its end.
        free: bool,
        /// The greatest deviation from the way.
        within: PoseError,
    },
    /// Joints come to where a behaviour would bring them, on a way on which nothing meets.
    Avoid {
        /// The behaviour, of which only the posture at its end counts.
        body: Arc<Node>,
        /// The distance that bodies keep, m.
        clearance: f64,
        /// The greatest number of postures that are examined.
        budget: u64,
        /// The seed of the search.
        seed: u64,
    },
}

impl Goal {
    /// Returns the name of the built-in that makes such a goal: `reach`, `line`, `arc` or `avoid`.
    pub fn name(&self) -> &'static str {
        match &self.kind {
            GoalKind::Reach { .. } => "reach",
            GoalKind::Line { via: None, .. } => "line",
            GoalKind::Line { via: Some(_), .. } => "arc",
            GoalKind::Avoid { .. } => "avoid",
        }
    }

    /// Returns true if it makes a difference where in the world the robots are.
    pub fn is_placed(&self) -> bool {
        match &self.kind {
            GoalKind::Reach { frame, .. } | GoalKind::Line { frame, .. } => frame.module.is_none(),
            GoalKind::Avoid { .. } => true,
        }
    }

    /// Returns the behaviour whose end is the goal, if it is one.
    pub fn body(&self) -> Option<&Arc<Node>> {
        match &self.kind {
            GoalKind::Avoid { body, .. } => Some(body),
            GoalKind::Reach { .. } | GoalKind::Line { .. } => None,
        }
    }

    /// Returns the same goal with another behaviour whose end it is, if it has one.
    pub fn with_body(&self, new: impl Fn(&Arc<Node>) -> Arc<Node>) -> Goal {
        let mut goal = self.clone();
        if let GoalKind::Avoid { body, .. } = &mut goal.kind {
            *body = new(body);
        }
        goal
    }
}
