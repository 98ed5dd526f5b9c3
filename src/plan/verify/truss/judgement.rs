//! A truss plan under judgement, one of its steps, and how failures are recorded.

use super::events::Stretch;
use super::sample_budget::SampleBudget;
use super::shape::Corner;
use super::surroundings::Obstacle;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::plan::{CauseId, CheckKind, Failure, Interpolation, NodePaths, Progress, Ramps};
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
    /// The index of the keyframe to which the step leads; `None` for a moment at which nothing moves.
    pub keyframe: Option<usize>,
}

impl Step {
    /// Returns a moment at a time (s) as a step in which nothing moves, with the nodes at `x` in the world (m).
    pub(super) fn still(x: &[Vec3], time: f64) -> Step {
        Step {
            from: x.to_vec(),
            to: x.to_vec(),
            interpolation: Interpolation::Linear,
            ramps: Ramps::NONE,
            start: time,
            duration: 1.0,
            keyframe: None,
        }
    }

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
        if self.keyframe.is_none() { self.start } else { self.start + self.progress().time(part) }
    }
}

/// A truss plan under judgement, with the topology of the moment. Nodes that ride along with others are left out: the
/// judgement has indices of its own for those that do not.
pub(super) struct Judgement<'a> {
    /// The body of the plan: its nodes, struts and keyframes.
    pub paths: &'a NodePaths,
    /// The index in the plan of each node that moves on its own.
    pub nodes: Vec<usize>,
    /// The number of nodes in the place of each of these: itself, and those that ride along with it.
    pub carried: Vec<f64>,
    /// The ends of each strut of the plan, as indices of nodes here.
    pub struts: Vec<(usize, usize)>,
    /// The keyframes between which the topology stays, and the nodes that meet there.
    pub stretch: Stretch,
    /// The command of the event that is looked at, which is to blame for what fails then.
    pub event: Option<CauseId>,
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
        let (a, b) = self.struts[strut];
        self.paths.strut_name((self.nodes[a], self.nodes[b]))
    }

    /// Returns the name of a node, by its index here.
    pub(super) fn node_name(&self, node: usize) -> String {
        self.paths.node_names[self.nodes[node]].clone()
    }

    /// Returns a failure of a check at a time (s), without value and limit, blamed on the command that leads to the
    /// first keyframe after that time, or on that of the event that is looked at. `at`: the names of the parts concerned.
    pub(super) fn failure(&self, kind: CheckKind, time: f64, at: Vec<String>, message: String) -> Failure {
        let cause =
            self.paths.keyframes.iter().find(|keyframe| keyframe.time > time).map(|keyframe| keyframe.cause);
        let cause = self.event.or(cause);
        Failure { kind, time, at, blame: cause.into_iter().collect(), ..Failure::form(message) }
    }
}
