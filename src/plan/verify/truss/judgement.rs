//! A truss plan under judgement, one of its steps, and how failures are recorded.

use super::sample_budget::SampleBudget;
use super::shape::Corner;
use super::surroundings::Obstacle;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::plan::{CheckKind, Failure, Interpolation, NodePaths, Progress, Ramps};
use crate::robot::Strut;
use crate::robot::truss_statics::Layout;

/// The motion from one keyframe to the next.
pub(super) struct Step {
    /// The positions of the nodes at the start of the step, by index of the node, in the world, m.
    pub from: Vec<Vec3>,
    /// The positions of the nodes at the end of the step, by index of the node, in the world, m.
    pub to: Vec<Vec3>,
    /// The interpolation of the nodes between start and end.
    pub interpolation: Interpolation,
    /// The velocity profile of the step.
    pub ramps: Ramps,
    /// The time at which the step starts, s from the start of the plan.
    pub start: f64,
    /// The duration of the step, s; positive.
    pub duration: f64,
}

impl Step {
    /// Returns the progress of the step by time.
    pub(super) fn progress(&self) -> Progress {
        self.ramps.progress(self.duration)
    }

    /// Returns the positions of the nodes at which a linear step has progressed by a part, 0 to 1, in the world, m.
    pub(super) fn at(&self, part: f64) -> Vec<Vec3> {
        self.from.iter().zip(&self.to).map(|(p, q)| p + (q - p) * part).collect()
    }

    /// Returns the time at which the step has progressed by a part, 0 to 1, s from the start of the plan.
    pub(super) fn time(&self, part: f64) -> f64 {
        self.start + self.progress().time(part)
    }
}

/// A truss plan under judgement.
pub(super) struct Judgement<'a> {
    /// The body of the plan: its nodes, struts and keyframes.
    pub paths: &'a NodePaths,
    /// The tolerances of all checks.
    pub tolerances: Tolerances,
    /// The samples that the checks may still take.
    pub samples: SampleBudget,
    /// The pairs of struts that share a node, if the plan limits angles; otherwise empty.
    pub corners: Vec<Corner>,
    /// The type of all struts.
    pub strut: &'a Strut,
    /// The obstacles of the plan's surroundings.
    pub obstacles: Vec<Obstacle>,
    /// The envelope of the matrices of stiffness and rigidity.
    pub layout: Layout,
    /// The limit on the least singular value of the rigidity matrix, without unit; 0 for a truss that is not rigid at
    /// its start.
    pub rigidity: f64,
    /// The greatest slope of uneven ground, without unit; 0 on flat ground.
    pub steepest: f64,
}

impl Judgement<'_> {
    /// Returns the name that reports give to a strut, by its index in the plan: the names of its nodes, `a -- b`.
    pub(super) fn strut_name(&self, strut: usize) -> String {
        let (a, b) = self.paths.struts[strut];
        format!("{} -- {}", self.paths.node_names[a], self.paths.node_names[b])
    }

    /// Returns a failure of a check at a time (s), without value and limit, blamed on the command that leads to the
    /// first keyframe after that time. `at`: the names of the parts concerned.
    pub(super) fn failure(&self, kind: CheckKind, time: f64, at: Vec<String>, message: String) -> Failure {
        let cause =
            self.paths.keyframes.iter().find(|keyframe| keyframe.time > time).map(|keyframe| keyframe.cause);
        Failure { kind, time, at, blame: cause.into_iter().collect(), ..Failure::form(message) }
    }
}
