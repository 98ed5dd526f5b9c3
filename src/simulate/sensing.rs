//! The sensors of a simulated robot: conditions of an executed program are evaluated on what they report.

use crate::behavior::Sensors;
use crate::geometry::pose::lean;
use crate::plan::Signal;
use crate::plan::forward_dynamics::Stepper;
use crate::robot::{Assembly, JointId, PortRef};

/// The sensors of a robot that is simulated: joints as they are after the step taken last, places and touch as they were at
/// its start.
pub(super) struct Measured<'s, 'a> {
    /// The robot in motion.
    pub stepper: &'s Stepper<'a>,
    /// The robot as the plan knows it.
    pub robot: &'s Assembly,
    /// The commanded position and rate of each joint: those that move no body are where they are commanded to be.
    pub commands: &'s [(f64, f64)],
}

impl Measured<'_, '_> {
    /// Returns the position (rad or m), rate and effort (N·m or N) of a joint.
    fn joint(&self, joint: JointId) -> [f64; 3] {
        let number = joint.0 as usize;
        self.stepper.sensed(number).unwrap_or_else(|| {
            let (position, rate) = self.commands[number];
            [position, rate, 0.0]
        })
    }
}

impl Sensors for Measured<'_, '_> {
    fn value(&self, signal: Signal) -> f64 {
        match signal {
            Signal::Angle(joint) => self.joint(joint)[0],
            Signal::Speed(joint) => self.joint(joint)[1],
            Signal::Effort(joint) => self.joint(joint)[2],
            Signal::Elapsed => unreachable!("the time of an action is not asked for"),
            Signal::Separation(a, b) => {
                let origin = |port: PortRef| self.stepper.port_pose(self.robot, port).translation.vector;
                (origin(a) - origin(b)).norm()
            }
            Signal::Tilt(module) => {
                let (start, now) = self.stepper.module_poses(module);
                lean(&(now.rotation * start.rotation.inverse()))
            }
        }
    }

    fn touches(&self, modules: &[usize], others: Option<&[usize]>) -> bool {
        self.stepper.touches(modules, others)
    }
}
