//! Inverse dynamics of the library's designs at random states, beside MuJoCo's on the exported models: wheels, floating
//! bases, and joints in all poses.
#![allow(non_snake_case)]

use super::mjcf::{Case, answers, of_the_library};
use crate::support::numbers::Numbers;
use modl::geometry::{Pose, Vec3};
use modl::robot::Kinematics;
use modl::robot::dynamics::{Dynamics, MotionState, Twist};
use nalgebra::{Translation3, UnitQuaternion};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Contacts, constraints, limits, armatures and damping are no part of the rigid bodies' dynamics.
const THEIRS: &str = r#"
import json, mujoco, numpy
out = []
for task in json.load(sys.stdin):
    model = mujoco.MjModel.from_xml_string(task["model"])
    model.opt.gravity[:] = task["gravity"]
    for flag in ("CONTACT", "EQUALITY", "LIMIT", "FRICTIONLOSS"):
        model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, "mjDSBL_" + flag))
    model.dof_armature[:] = 0
    model.dof_damping[:] = 0
    data = mujoco.MjData(model)
    ids = [model.joint(name) for name in task["joints"]]
    forces = []
    for s in task["states"]:
        x, y, z, w = s["turn"]
        data.qpos[0:7] = [*s["place"], w, x, y, z]
        R = numpy.zeros(9)
        mujoco.mju_quat2Mat(R, data.qpos[3:7])
        R = R.reshape(3, 3)
        data.qvel[0:6] = [*s["v"][0:3], *(R.T @ s["v"][3:6])]
        data.qacc[0:6] = [*s["a"][0:3], *(R.T @ s["a"][3:6])]
        for j, joint in enumerate(ids):
            data.qpos[joint.qposadr[0]] = s["q"][j]
            data.qvel[joint.dofadr[0]] = s["v"][6 + j]
            data.qacc[joint.dofadr[0]] = s["a"][6 + j]
        mujoco.mj_inverse(model, data)
        tau = data.qfrc_inverse
        forces.append([*tau[0:3], *(R @ tau[3:6]), *(tau[joint.dofadr[0]] for joint in ids)])
    out.append(forces)
json.dump(out, sys.stdout)
"#;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.80665);

/// The relative difference allowed: rounding over thirty joints in a row, and the inertia of links that have none, 1e-12
/// kg·m² in the models.
const TOL: f64 = 1e-9;

/// A robot that is a tree, and random states of it.
struct Design {
    name: String,
    kinematics: Kinematics,
    dynamics: Dynamics,
    states: Vec<State>,
}

/// A state: the base's pose, its velocity and acceleration, and the positions, velocities and accelerations of joints.
struct State {
    base: Pose,
    twist: [Twist; 2],
    joints: [Vec<f64>; 3],
}

impl Design {
    /// The design of a case with as many random states; `None` for one with loops or with joints that follow others.
    fn of(case: &Case, states: usize, numbers: &mut Numbers) -> Option<Design> {
        let tracks = case.plan.body.tracks().expect("the robot has joints");
        let robot = &tracks.robot;
        let kinematics = Kinematics::new(robot, &tracks.start.bonds, robot.base);
        let follows = |step: &modl::robot::Step| step.terms().iter().any(|(_, factor)| factor.abs() != 1.0);
        let tree = kinematics.tree.closing.is_empty() && tracks.events.is_empty();
        if !tree || kinematics.steps.iter().any(follows) {
            return None;
        }
        let count = kinematics.joint_count();
        let random = |numbers: &mut Numbers, size: f64| Vec3::from_fn(|_, _| (numbers.next() - 0.5) * size);
        let state = |_| {
            let turn = UnitQuaternion::from_scaled_axis(random(numbers, 4.0));
            let place = Translation3::from(random(numbers, 2.0));
            let twist = [2.0, 8.0]
                .map(|size| Twist { linear: random(numbers, size), angular: random(numbers, 2.0 * size) });
            let joints =
                [3.0, 6.0, 20.0].map(|size| (0..count).map(|_| (numbers.next() - 0.5) * size).collect());
            State { base: Pose::from_parts(place, turn), twist, joints }
        };
        let states = (0..states).map(state).collect();
        Some(Design { name: robot.name.clone(), dynamics: Dynamics::new(robot), kinematics, states })
    }

    fn task(&self, case: &Case) -> Value {
        let robot = &case.plan.body.tracks().expect("the robot has joints").robot;
        let joints: Vec<String> = robot.joints().map(|joint| robot.joint_name(joint)).collect();
        let state = |state: &State| {
            let (p, r) = (state.base.translation.vector, state.base.rotation);
            let stacked = |twist: &Twist, joints: &[f64]| -> Vec<f64> {
                twist.linear.iter().chain(&twist.angular).chain(joints).copied().collect()
            };
            json!({ "place": [p.x, p.y, p.z], "turn": [r.i, r.j, r.k, r.w], "q": state.joints[0],
                "v": stacked(&state.twist[0], &state.joints[1]), "a": stacked(&state.twist[1], &state.joints[2]) })
        };
        json!({ "model": case.model, "joints": joints, "gravity": [GRAVITY.x, GRAVITY.y, GRAVITY.z],
            "states": self.states.iter().map(state).collect::<Vec<_>>() })
    }

    /// The force and the moment on the base, and the effort of each joint.
    fn forces(&self, state: &State) -> Vec<f64> {
        let mut poses = vec![Pose::identity(); self.kinematics.link_count()];
        self.kinematics.link_poses(&state.joints[0], &state.base, &mut poses);
        let motion = MotionState {
            poses: &poses,
            base: state.twist[0],
            base_acceleration: state.twist[1],
            velocities: &state.joints[1],
            accelerations: &state.joints[2],
        };
        let found = self.dynamics.inverse(&self.kinematics, &motion, &GRAVITY);
        let base = found.base.force.iter().chain(found.base.moment.iter());
        base.chain(&found.efforts).copied().collect()
    }
}

#[test]
fn mujoco_needs_the_same_forces() {
    let whole = std::env::var_os("MODL_WHOLE").is_some();
    let (_, cases, _) = of_the_library(3);
    let mut numbers = Numbers(14);
    let mut known = BTreeSet::new();
    let mut designs: Vec<(Design, &Case)> = vec![];
    for case in &cases {
        let name = case.plan.body.tracks().expect("the robot has joints").robot.name.clone();
        if known.insert(name) {
            let design = Design::of(case, if whole { 1000 } else { 20 }, &mut numbers);
            designs.extend(design.map(|design| (design, case)));
        }
    }
    assert!(designs.len() >= if whole { 15 } else { 1 }, "{} designs", designs.len());
    let tasks: Vec<Value> = designs.iter().map(|(design, case)| design.task(case)).collect();
    let Some(theirs) = answers(THEIRS, &tasks) else { return };
    for ((design, _), theirs) in designs.iter().zip(&theirs) {
        for (state, theirs) in design.states.iter().zip(theirs.as_array().expect("a list of states")) {
            let theirs: Vec<f64> =
                theirs.as_array().expect("a list").iter().map(super::mjcf::number).collect();
            let ours = design.forces(state);
            assert_eq!(ours.len(), theirs.len());
            let scale = theirs.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            let error = ours.iter().zip(&theirs).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
            assert!(error < TOL * scale, "{}: {error:e} of {scale}", design.name);
        }
    }
}
