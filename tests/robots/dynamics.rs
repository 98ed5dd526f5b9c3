//! Inverse dynamics and the mass matrix: against the balance of energy, a closed form, and another library.
#![allow(non_snake_case)]

use super::urdf::{Urdf, python, run};
use crate::behavior::behaviors_of_designs::BEHAVIORS;
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use crate::support::robots;
use modl::geometry::{Pose, Vec3};
use modl::plan::file;
use modl::robot::dynamics::{Dynamics, InverseDynamics, MotionState, Twist};
use modl::robot::{Assembly, Kinematics};
use nalgebra::{DVector, Translation3, UnitQuaternion};
use serde_json::json;
use std::collections::BTreeSet;
use std::io::Write as _;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.80665);

/// A random motion at an instant: base pose, twist and its derivative, joints with velocities and accelerations.
struct Moving {
    base: Pose,
    twist: Twist,
    acceleration: Twist,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

fn random_vec(numbers: &mut Numbers, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| (numbers.next() - 0.5) * size)
}

impl Moving {
    fn random(numbers: &mut Numbers, joints: usize) -> Moving {
        let turn = UnitQuaternion::from_scaled_axis(random_vec(numbers, 4.0));
        let mut twist = || Twist { linear: random_vec(numbers, 2.0), angular: random_vec(numbers, 4.0) };
        let (velocity, acceleration) = (twist(), twist());
        let base = Pose::from_parts(Translation3::from(random_vec(numbers, 2.0)), turn);
        let mut list = |size: f64| (0..joints).map(|_| (numbers.next() - 0.5) * size).collect();
        Moving { base, twist: velocity, acceleration, q: list(3.0), v: list(6.0), a: list(20.0) }
    }

    fn poses(&self, kinematics: &Kinematics) -> Vec<Pose> {
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&self.q, &self.base, &mut poses);
        poses
    }

    /// The motion `dt` later, with constant accelerations.
    fn after(&self, dt: f64) -> Moving {
        let turn = (self.twist.angular + self.acceleration.angular * (dt / 2.0)) * dt;
        let shift = (self.twist.linear + self.acceleration.linear * (dt / 2.0)) * dt;
        let p = self.base.translation.vector + shift;
        let step = |x: &[f64], dx: &[f64]| x.iter().zip(dx).map(|(x, d)| x + d * dt).collect::<Vec<f64>>();
        let q = step(&self.q, &step(&self.v, &self.a.iter().map(|a| a / 2.0).collect::<Vec<_>>()));
        Moving {
            base: Pose::from_parts(p.into(), UnitQuaternion::from_scaled_axis(turn) * self.base.rotation),
            twist: Twist {
                linear: self.twist.linear + self.acceleration.linear * dt,
                angular: self.twist.angular + self.acceleration.angular * dt,
            },
            acceleration: self.acceleration,
            q,
            v: step(&self.v, &self.a),
            a: self.a.clone(),
        }
    }

    /// The velocity of base and joints in the order of the mass matrix.
    fn u(&self) -> DVector<f64> {
        let base = self.twist.linear.iter().chain(self.twist.angular.iter());
        DVector::from_iterator(6 + self.v.len(), base.chain(&self.v).copied())
    }

    fn udot(&self) -> DVector<f64> {
        let base = self.acceleration.linear.iter().chain(self.acceleration.angular.iter());
        DVector::from_iterator(6 + self.a.len(), base.chain(&self.a).copied())
    }
}

struct Machine {
    kinematics: Kinematics,
    dynamics: Dynamics,
}

impl Machine {
    fn new(robot: &Assembly) -> Machine {
        let kinematics = Kinematics::new(robot, &vec![true; robot.bonds.len()], robot.base);
        Machine { dynamics: Dynamics::new(robot), kinematics }
    }

    fn inverse(&self, moving: &Moving, gravity: &Vec3) -> InverseDynamics {
        let poses = moving.poses(&self.kinematics);
        let state = MotionState {
            poses: &poses,
            base: moving.twist,
            base_acceleration: moving.acceleration,
            velocities: &moving.v,
            accelerations: &moving.a,
        };
        self.dynamics.inverse(&self.kinematics, &state, gravity)
    }

    /// Kinetic and potential energy, summed over the bodies' own velocities by differences of their poses.
    fn energy(&self, moving: &Moving) -> f64 {
        let dt = 1e-6;
        let [before, now, after] = [-dt, 0.0, dt].map(|t| moving.after(t).poses(&self.kinematics));
        let mut energy = 0.0;
        for (link, body) in self.dynamics.bodies().iter().enumerate() {
            let c = |poses: &[Pose]| poses[link].transform_point(&body.com.into()).coords;
            let v = (c(&after) - c(&before)) / (2.0 * dt);
            let turn = after[link].rotation * before[link].rotation.inverse();
            let w = now[link].rotation.inverse() * (turn.scaled_axis() / (2.0 * dt));
            energy += body.mass * v.norm_squared() / 2.0 + w.dot(&(body.inertia * w)) / 2.0;
            energy -= body.mass * GRAVITY.dot(&c(&now));
        }
        energy
    }
}

#[test]
fn the_power_of_all_forces_is_the_change_of_energy() {
    let mut numbers = Numbers(11);
    for robot in [robots::chain(3), robots::walk4(), robots::backhoe(4)] {
        let machine = Machine::new(&robot);
        for _ in 0..10 {
            let moving = Moving::random(&mut numbers, machine.kinematics.joint_count());
            let forces = machine.inverse(&moving, &GRAVITY);
            let base =
                forces.base.force.dot(&moving.twist.linear) + forces.base.moment.dot(&moving.twist.angular);
            let power: f64 = base + forces.efforts.iter().zip(&moving.v).map(|(f, v)| f * v).sum::<f64>();
            let dt = 1e-4;
            let change =
                (machine.energy(&moving.after(dt)) - machine.energy(&moving.after(-dt))) / (2.0 * dt);
            let scale = forces.base.force.norm() + 1.0;
            assert!((power - change).abs() < 1e-4 * scale, "{}: {power} for {change}", robot.name);
        }
    }
}

#[test]
fn the_mass_matrix_gives_the_kinetic_energy_and_the_change_of_forces() {
    let mut numbers = Numbers(12);
    for robot in [robots::chain(3), robots::walk4(), robots::ring12()] {
        let machine = Machine::new(&robot);
        let moving = Moving::random(&mut numbers, machine.kinematics.joint_count());
        let M = machine.dynamics.mass_matrix(&machine.kinematics, &moving.poses(&machine.kinematics));
        assert!((&M - M.transpose()).amax() < 1e-12, "it is symmetric");
        // Inverse dynamics without gravity is linear in the accelerations, and M is that map.
        let still =
            Moving { acceleration: Twist::default(), a: vec![0.0; moving.a.len()], ..moving.after(0.0) };
        let (with, without) =
            (machine.inverse(&moving, &Vec3::zeros()), machine.inverse(&still, &Vec3::zeros()));
        let stacked = |f: &InverseDynamics| {
            let base = f.base.force.iter().chain(f.base.moment.iter());
            DVector::from_iterator(6 + f.efforts.len(), base.chain(&f.efforts).copied())
        };
        let difference = stacked(&with) - stacked(&without) - &M * moving.udot();
        assert!(difference.amax() < 1e-10, "{}: {:e}", robot.name, difference.amax());
        let u = moving.u();
        let kinetic = (u.transpose() * &M * &u)[(0, 0)] / 2.0;
        let potential: f64 = {
            let poses = moving.poses(&machine.kinematics);
            let bodies = machine.dynamics.bodies().iter().zip(&poses);
            bodies.map(|(b, X)| -b.mass * GRAVITY.dot(&X.transform_point(&b.com.into()).coords)).sum()
        };
        let energy = machine.energy(&moving);
        assert!((kinetic + potential - energy).abs() < 1e-6 * energy.abs(), "{}", robot.name);
    }
}

const THEIRS: &str = r#"
import json, sys, numpy as np, pinocchio as pin
task = json.load(sys.stdin)
model = pin.buildModelFromXML(task["urdf"], pin.JointModelFreeFlyer())
model.gravity.linear = np.array(task["gravity"])
data = model.createData()
ids = [model.joints[model.getJointId(n)] for n in task["joints"]]
out = []
for s in task["states"]:
    q, v, a = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
    R = pin.Quaternion(*[s["turn"][i] for i in (3, 0, 1, 2)]).matrix()
    q[0:3], q[3:7] = s["place"], s["turn"]
    lin, ang = R.T @ s["v"][0:3], R.T @ s["v"][3:6]
    v[0:6] = np.concatenate([lin, ang])
    a[0:3], a[3:6] = R.T @ s["a"][0:3] - np.cross(ang, lin), R.T @ s["a"][3:6]
    for j, joint in enumerate(ids):
        q[joint.idx_q], v[joint.idx_v], a[joint.idx_v] = s["q"][j], s["v"][6 + j], s["a"][6 + j]
    order = list(range(6)) + [joint.idx_v for joint in ids]
    T = np.eye(model.nv)
    T[0:3, 0:3] = T[3:6, 3:6] = R
    tau = T @ pin.rnea(model, data, q, v, a)
    M = pin.crba(model, data, q)
    M = np.triu(M) + np.triu(M, 1).T
    M = (T @ M @ T.T)[np.ix_(order, order)]
    out.append({"tau": tau[order].tolist(), "M": M.flatten().tolist()})
json.dump(out, sys.stdout)
"#;

/// A design of `std.smores` by its name.
fn of_the_library(name: &str) -> Assembly {
    let program = format!(
        "use std.smores.{name}\nconfig D {{ part d: {name}\n  behavior rest = wait(1s) }}\n\
         emit(plan(D().rest(), world: world(ground: off, gravity: off)), \"p.json\")"
    );
    let plan = file::read(run_clean(&program).text("p.json")).expect("a plan that was written is read");
    plan.body.tracks().expect("the robot has joints").robot.clone()
}

/// The relative difference allowed of forces and masses between the two libraries.
const TOL: f64 = 1e-9;

#[test]
fn an_independent_library_needs_the_same_forces() {
    let Some(python) = python() else {
        writeln!(std::io::stderr(), "skipped: dynamics against another library: no Python with pinocchio")
            .expect("stderr is open");
        return;
    };
    let mut numbers = Numbers(13);
    let whole = std::env::var_os("MODL_WHOLE").is_some();
    let mut all =
        vec![robots::chain(3), robots::walk4(), robots::car(), robots::backhoe(4), robots::ring12()];
    if whole {
        let names: BTreeSet<&str> = BEHAVIORS.iter().map(|(robot, ..)| *robot).collect();
        all.extend(names.into_iter().map(of_the_library));
    }
    for robot in all {
        let machine = Machine::new(&robot);
        let urdf = Urdf::new(&robot, &machine.kinematics);
        let all: Vec<Moving> = (0..if whole { 1000 } else { 200 })
            .map(|_| Moving::random(&mut numbers, machine.kinematics.joint_count()))
            .collect();
        let states: Vec<_> = all
            .iter()
            .map(|m| {
                let (p, r) = (m.base.translation.vector, m.base.rotation);
                json!({ "place": [p.x, p.y, p.z], "turn": [r.i, r.j, r.k, r.w], "q": m.q,
                    "v": m.u().as_slice(), "a": m.udot().as_slice() })
            })
            .collect();
        let gravity = [GRAVITY.x, GRAVITY.y, GRAVITY.z];
        let task = json!({ "urdf": urdf.text, "joints": urdf.joints, "states": states, "gravity": gravity });
        let theirs = run(&python, THEIRS, &task);
        for (moving, theirs) in all.iter().zip(theirs.as_array().expect("a list of states")) {
            let numbers = |key: &str| -> Vec<f64> {
                theirs[key]
                    .as_array()
                    .expect("a list")
                    .iter()
                    .map(|x| x.as_f64().expect("a number"))
                    .collect()
            };
            let ours = machine.inverse(moving, &GRAVITY);
            let base = ours.base.force.iter().chain(ours.base.moment.iter());
            let forces: Vec<f64> = base.chain(&ours.efforts).copied().collect();
            let M = machine.dynamics.mass_matrix(&machine.kinematics, &moving.poses(&machine.kinematics));
            for (ours, theirs) in [(&forces, numbers("tau")), (&M.as_slice().to_vec(), numbers("M"))] {
                let scale = theirs.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
                assert_eq!(ours.len(), theirs.len());
                let error = ours.iter().zip(&theirs).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
                assert!(error < TOL * scale, "{}: {error:e} of {scale}", robot.name);
            }
        }
    }
}
