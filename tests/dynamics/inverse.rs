//! Inverse dynamics of the library's designs at random states, beside MuJoCo's on the exported models: wheels, floating
//! bases, and joints in all poses.

use super::mjcf::{answers, number};
use crate::behavior::behaviors_of_designs::BEHAVIORS;
use crate::robots::dynamics::{GRAVITY, Machine, Moving, library_plan, robot_of};
use crate::support::numbers::Numbers;
use crate::support::properties::whole;
use modl::formats::mjcf;
use modl::plan::Plan;
use modl::robot::Step;
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

/// The relative difference allowed: rounding over thirty joints in a row, and the inertia of links that have none, 1e-12
/// kg·m² in the models.
const TOL: f64 = 1e-9;

/// A robot that is a tree, and random states of it.
struct Design {
    name: &'static str,
    plan: Plan,
    machine: Machine,
    states: Vec<Moving>,
}

impl Design {
    /// The design of a name with as many random states; `None` for one with loops or with joints that follow others.
    fn of(name: &'static str, states: usize, numbers: &mut Numbers) -> Option<Design> {
        let plan = library_plan(name);
        let machine = Machine::new(robot_of(&plan));
        let follows = |step: &Step| step.terms().iter().any(|(_, factor)| factor.abs() != 1.0);
        let kinematics = &machine.kinematics;
        if !kinematics.tree.closing.is_empty() || kinematics.steps.iter().any(follows) {
            return None;
        }
        let joints = kinematics.joint_count();
        let states = (0..states).map(|_| Moving::random(numbers, joints)).collect();
        Some(Design { name, plan, machine, states })
    }

    fn task(&self) -> Value {
        let robot = robot_of(&self.plan);
        let joints: Vec<String> = robot.joints().map(|joint| robot.joint_name(joint)).collect();
        let model = mjcf::write(&self.plan).expect("the robot has links and joints");
        let states: Vec<Value> = self.states.iter().map(Moving::json).collect();
        json!({ "model": model, "joints": joints, "gravity": GRAVITY.as_slice(), "states": states })
    }
}

#[test]
fn mujoco_needs_the_same_forces() {
    let whole = whole();
    let some = &BEHAVIORS[..if whole { BEHAVIORS.len() } else { 3 }];
    let names: BTreeSet<&str> = some.iter().map(|(robot, ..)| *robot).collect();
    let mut numbers = Numbers(14);
    let states = if whole { 1000 } else { 20 };
    let designs: Vec<Design> =
        names.into_iter().filter_map(|name| Design::of(name, states, &mut numbers)).collect();
    assert!(designs.len() >= if whole { 15 } else { 1 }, "{} designs", designs.len());
    let tasks: Vec<Value> = designs.iter().map(Design::task).collect();
    let Some(theirs) = answers(THEIRS, &tasks) else { return };
    for (design, theirs) in designs.iter().zip(&theirs) {
        for (state, theirs) in design.states.iter().zip(theirs.as_array().expect("a list of states")) {
            let theirs: Vec<f64> = theirs.as_array().expect("a list").iter().map(number).collect();
            let ours = design.machine.forces(state, &GRAVITY);
            assert_eq!(ours.len(), theirs.len());
            let scale = theirs.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            let error = ours.iter().zip(&theirs).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
            assert!(error < TOL * scale, "{}: {error:e} of {scale}", design.name);
        }
    }
}
