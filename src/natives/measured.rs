//! Time series of simulations: values of signals as they were measured.

use super::Native;
use super::show::simulated_of;
use super::simulate::Simulated;
use crate::geometry::Pose;
use crate::geometry::pose::lean;
use crate::interpret::argument::parameters;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::{Measure, MovingFrame, Value};
use crate::plan::{Signal, Tracks};
use crate::robot::JointId;
use crate::simulate::{MeasuredLinks, Moment};
use crate::units::Dimension;
use std::rc::Rc;

/// The built-ins for samples of a simulation.
pub(super) const TABLE: &[Native] =
    &[Native::on_run("Simulation.series", parameters![self: &Value, of: &Value], series)];

/// Runs `s.series(of)`: lists the values of a signal as they were measured, at the times of `s.times`.
///
/// # Errors
/// A fault where the signal is of another robot, or is not measured.
fn series(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(Simulated { planned, outcome, .. }) = simulated_of(call.arg("self")) else {
        return Ok(Value::Unknown);
    };
    let Value::Signal(signal) = call.get::<&Value>("of")? else {
        unreachable!("`check` lets only signals through")
    };
    interpreter.common_robot(Some(&planned.robot), signal.robot.as_deref(), call.span)?;
    let tracks = planned.plan.body.tracks().expect("only robots with joints are simulated");
    let dimension = |joint: JointId| {
        let owner = tracks.robot.joints().nth(joint.0 as usize).expect("the joint is one of the robot's");
        if tracks.robot.slides(owner) { Dimension::LENGTH } else { Dimension::ANGLE }
    };
    let listed = |dimension: Dimension, of: &dyn Fn(&Moment) -> f64| {
        Value::list(outcome.motion.iter().map(|moment| Value::Quantity(of(moment), dimension)).collect())
    };
    let links = || MeasuredLinks::new(tracks, outcome);
    match &signal.measure {
        Measure::Sensed(Signal::Angle(joint)) => {
            Ok(listed(dimension(*joint), &|moment| moment.joints[joint.0 as usize]))
        }
        Measure::Sensed(Signal::Effort(joint)) => {
            let own =
                |drive: &crate::simulate::Drive| drive.joint == joint.0 as usize && drive.motor.is_none();
            let Some(drive) = outcome.drives.iter().position(own) else {
                return Err(call.refuse("of", "no motor drives this joint"));
            };
            let slides = dimension(*joint) == Dimension::LENGTH;
            let dimension = if slides { Dimension::FORCE } else { Dimension::TORQUE };
            Ok(listed(dimension, &|moment| moment.efforts[drive]))
        }
        Measure::Sensed(Signal::Elapsed) => Ok(listed(Dimension::TIME, &|moment| moment.time)),
        Measure::Sensed(Signal::Tilt(module)) => {
            let links = links();
            let frame = MovingFrame::Module(*module);
            let turn = |moment: &Moment| pose(&links, tracks, frame, &links.poses(moment)).rotation;
            let first = outcome.motion.first().map_or_else(Default::default, turn);
            Ok(listed(Dimension::ANGLE, &|moment| lean(&(turn(moment) * first.inverse()))))
        }
        Measure::Sensed(Signal::Separation(a, b)) => {
            let links = links();
            Ok(listed(Dimension::LENGTH, &|moment| {
                let poses = links.poses(moment);
                let [a, b] = [a, b].map(|port| pose(&links, tracks, MovingFrame::Port(*port), &poses));
                (a.translation.vector - b.translation.vector).norm()
            }))
        }
        Measure::Pose(frame) | Measure::Position(frame) => {
            let links = links();
            let whole = matches!(signal.measure, Measure::Pose(_));
            let value = |moment| match pose(&links, tracks, *frame, &links.poses(moment)) {
                pose if whole => Value::Pose(Rc::new(pose)),
                pose => Value::Vec3(pose.translation.vector, Dimension::LENGTH),
            };
            Ok(Value::list(outcome.motion.iter().map(value).collect()))
        }
        Measure::Sensed(Signal::Speed(_)) => Err(not_kept(call, "speeds")),
        Measure::Clearance => Err(not_kept(call, "distances of links")),
        Measure::Margin => Err(not_kept(call, "margins of stability")),
        Measure::GroundForce(_) => Err(not_kept(call, "forces of the ground")),
    }
}

/// Returns the pose of a frame in the world where the links have these poses.
fn pose(links: &MeasuredLinks, tracks: &Tracks, frame: MovingFrame, poses: &[Pose]) -> Pose {
    match frame {
        MovingFrame::Module(module) => links.kinematics().module_pose(module, poses),
        MovingFrame::Port(port) => links.kinematics().port_pose(&tracks.robot, port, poses),
    }
}

/// Returns the fault of a signal that a simulation doesn't keep.
fn not_kept(call: &Call, what: &str) -> Stop {
    call.refuse(
        "of",
        format!("a simulation keeps no {what}: positions, efforts, poses, `tilt` and `separation`"),
    )
}
