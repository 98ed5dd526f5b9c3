//! Forward and inverse dynamics, each with the forward kinematics that it needs, beside pinocchio's on the same robots in
//! the same run.
//!
//! `cargo bench --bench dynamics`. The other library is used if `MODL_PYTHON` or `target/python/bin/python` has it
//! (`.ci/run` makes that environment).

#![allow(non_snake_case)]

mod beside_pinocchio;

use beside_pinocchio::{RUNS, fastest, support, urdf};
use modl::geometry::{Pose, Vec3};
use modl::robot::articulated_bodies::{ForcedState, ForwardDynamics};
use modl::robot::dynamics::{Dynamics, MotionState, Twist, Wrench};
use modl::robot::{Assembly, Kinematics};
use serde_json::json;
use std::hint::black_box;
use support::robots;
use urdf::{Urdf, python, run};

/// Evaluations of one link in a run.
const LINKS: usize = 400_000;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.80665);

/// Pinocchio's times, in seconds for an evaluation: articulated bodies, and recursive Newton-Euler.
const THEIRS: &str = r#"
import json, sys, time, numpy as np, pinocchio as pin
task = json.load(sys.stdin)
model = pin.buildModelFromXML(task["urdf"], pin.JointModelFreeFlyer())
data = model.createData()
q, v, a = pin.neutral(model), np.full(model.nv, 0.1), np.full(model.nv, 0.2)
def least(call):
    best = float("inf")
    for _ in range(task["runs"]):
        begin = time.perf_counter()
        for _ in range(task["rounds"]):
            call(model, data, q, v, a)
        best = min(best, (time.perf_counter() - begin) / task["rounds"])
    return best
json.dump([least(pin.aba), least(pin.rnea)], sys.stdout)
"#;

fn main() {
    for robot in [robots::chain(1), robots::walk4(), robots::snake(100)] {
        beside(&robot);
    }
}

/// Prints the times of one robot.
fn beside(robot: &Assembly) {
    let kinematics = Kinematics::new(robot, &vec![true; robot.bonds.len()], robot.base);
    let dynamics = Dynamics::new(robot);
    let (links, joints) = (kinematics.link_count(), kinematics.joint_count());
    let mut poses = vec![Pose::identity(); links];
    let (q, v, a, zero) = (vec![0.1; joints], vec![0.1; joints], vec![0.2; joints], vec![0.0; joints]);
    let wrenches = vec![Wrench::default(); links];
    let base = Twist::default();
    let mut bodies = ForwardDynamics::new(dynamics.clone(), kinematics.clone());
    let rounds = LINKS / links;
    let forward = fastest(rounds, || {
        kinematics.link_poses(black_box(&q), &Pose::identity(), &mut poses);
        let state = ForcedState {
            poses: &poses,
            base,
            held: false,
            velocities: &v,
            efforts: &a,
            armatures: &zero,
            wrenches: &wrenches,
        };
        black_box(bodies.accelerations(&state, &GRAVITY));
    });
    let inverse = fastest(rounds, || {
        kinematics.link_poses(black_box(&q), &Pose::identity(), &mut poses);
        let motion =
            MotionState { poses: &poses, base, base_acceleration: base, velocities: &v, accelerations: &a };
        black_box(dynamics.inverse(&kinematics, &motion, &GRAVITY));
    });
    let us = |seconds: f64| seconds * 1e6;
    print!(
        "{:3} modules, {links:4} links: forward {:7.1} us, inverse {:7.1} us",
        robot.modules.len(),
        us(forward),
        us(inverse)
    );
    let Some(python) = python() else {
        println!("; no Python with pinocchio");
        return;
    };
    let urdf = Urdf::new(robot, &kinematics);
    let theirs = run(&python, THEIRS, &json!({ "urdf": urdf.text, "rounds": rounds, "runs": RUNS }));
    let [aba, rnea] = [0, 1].map(|i| theirs[i].as_f64().expect("a time"));
    println!(
        "; pinocchio {:7.1} us and {:7.1} us: x{:.2} and x{:.2}",
        us(aba),
        us(rnea),
        forward / aba,
        inverse / rnea
    );
}
