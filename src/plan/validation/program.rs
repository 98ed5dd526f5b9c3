//! The validation of programs and exemptions: joints, ports, modules and causes that they name.

use crate::plan::cause::CauseId;
use crate::plan::fault::{PlanFault, need_index};
use crate::plan::program::{Action, Command, Condition, Node, Signal};
use crate::plan::stated_path::StatedPath;
use crate::plan::visit::Graph;
use crate::plan::world::ExemptionKind;
use crate::robot::{Assembly, JointId, PortRef};

/// The numbers of joints, ports and causes within which the indices of a program must lie.
pub(super) struct Names<'a> {
    robot: &'a Assembly,
    joints: usize,
    causes: usize,
}

impl Names<'_> {
    /// Returns the numbers for programs of this robot, in a plan of `causes` causes.
    pub(super) fn of(robot: &Assembly, causes: usize) -> Names<'_> {
        Names { robot, joints: robot.joints().count(), causes }
    }

    /// Checks that the modules or the joint that an exemption is about are those of the robot.
    ///
    /// # Errors
    /// [`PlanFault::Index`] for the first index that is none of the robot.
    pub(super) fn exemption(&self, kind: &ExemptionKind) -> Result<(), PlanFault> {
        match kind {
            ExemptionKind::Collision(Some((a, b))) => {
                let modules = self.robot.modules.len();
                need_index(*a, modules, "module").and(need_index(*b, modules, "module"))
            }
            ExemptionKind::Overload(Some(joint)) => self.joint(JointId(*joint)),
            ExemptionKind::Unstable
            | ExemptionKind::Slip
            | ExemptionKind::Acceleration
            | ExemptionKind::Balance
            | ExemptionKind::Traction
            | ExemptionKind::Saturation
            | ExemptionKind::Collision(None)
            | ExemptionKind::Overload(None) => Ok(()),
        }
    }

    /// Checks that a path is of a port of the robot, in the frame of one of its modules, over an interval, with deviations that
    /// are not negative.
    pub(super) fn path(&self, path: &StatedPath) -> Result<(), PlanFault> {
        self.port(path.port)?;
        self.modules(&[path.module])?;
        self.cause(path.cause)?;
        let sound =
            path.from <= path.to && path.within >= 0.0 && path.turned_within.is_none_or(|angle| angle >= 0.0);
        if sound { Ok(()) } else { Err(PlanFault::PathNumbers) }
    }

    /// Checks that the indices in every node of a program are within their lists.
    ///
    /// # Errors
    /// [`PlanFault::Index`] for the first index that is not.
    pub(super) fn nodes(&self, graph: &Graph) -> Result<(), PlanFault> {
        graph.nodes.iter().try_for_each(|node| match &***node {
            Node::Action(action) => self.action(action),
            Node::Phase { cause, .. } | Node::Approach { cause, .. } | Node::Stretch { cause, .. } => {
                self.cause(*cause)
            }
            Node::Exempt { kind, cause, .. } => self.cause(*cause).and_then(|()| self.exemption(kind)),
            Node::Repeat { until, .. } => self.until(until.as_ref()),
            Node::Series(_) | Node::Parallel(_) => Ok(()),
            Node::Contract { .. } => Err(PlanFault::Contract),
            Node::Goal(goal) => Err(PlanFault::Goal { name: goal.name() }),
        })
    }

    fn action(&self, action: &Action) -> Result<(), PlanFault> {
        self.cause(action.cause)?;
        match &action.command {
            Command::Move { joint, .. } | Command::Spin { joint, .. } | Command::Follow { joint, .. } => {
                self.joint(*joint)?;
            }
            Command::Dock { a, b } => self.port(*a).and(self.port(*b))?,
            Command::Undock { port } => self.port(*port)?,
            Command::Wait { .. } => {}
        }
        self.until(action.until.as_ref())
    }

    /// Checks the condition that ends something, if there is one.
    fn until(&self, condition: Option<&Condition>) -> Result<(), PlanFault> {
        condition.map_or(Ok(()), |condition| self.condition(condition))
    }

    /// Checks a condition, whose nesting is limited by that of the text.
    fn condition(&self, condition: &Condition) -> Result<(), PlanFault> {
        match condition {
            Condition::Compare { signal, .. } => match signal {
                Signal::Angle(joint) | Signal::Speed(joint) | Signal::Effort(joint) => self.joint(*joint),
                Signal::Separation(a, b) => self.port(*a).and(self.port(*b)),
                Signal::Tilt(module) => need_index(*module, self.robot.modules.len(), "module"),
                Signal::Elapsed => Ok(()),
            },
            Condition::Touching(modules) => self.modules(modules),
            Condition::TouchingEachOther(a, b) => self.modules(a).and(self.modules(b)),
            Condition::Docked(port) => self.port(*port),
            Condition::Mated(a, b) => self.port(*a).and(self.port(*b)),
            Condition::And(a, b) | Condition::Or(a, b) => self.condition(a).and(self.condition(b)),
            Condition::Not(a) => self.condition(a),
        }
    }

    fn modules(&self, modules: &[usize]) -> Result<(), PlanFault> {
        modules.iter().try_for_each(|module| need_index(*module, self.robot.modules.len(), "module"))
    }

    fn joint(&self, joint: JointId) -> Result<(), PlanFault> {
        need_index(joint.0 as usize, self.joints, "joint")
    }

    fn port(&self, port: PortRef) -> Result<(), PlanFault> {
        need_index(port.module, self.robot.modules.len(), "module")?;
        need_index(port.port, self.robot.module_type(port.module).ports.len(), "port")
    }

    fn cause(&self, cause: CauseId) -> Result<(), PlanFault> {
        need_index(cause.0 as usize, self.causes, "cause")
    }
}
