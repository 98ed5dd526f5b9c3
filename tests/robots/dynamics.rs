//! Inverse dynamics and the mass matrix: against the balance of energy, a closed form, and another library.
#![allow(non_snake_case)]

use super::urdf::{Urdf, python, run};
use crate::behavior::behaviors_of_designs::BEHAVIORS;
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use crate::support::properties::whole;
use crate::support::robots;
use modl::geometry::{Pose, Vec3};
use modl::plan::Plan;
use modl::robot::articulated_bodies::{ForcedState, ForwardDynamics};
use modl::robot::dynamics::{Dynamics, InverseDynamics, MotionState, RigidBody, Twist, Wrench};
use modl::robot::spatial::SpatialInertia;
use modl::robot::{Assembly, Kinematics};
use nalgebra::{DVector, Matrix3, Point3, Translation3, UnitQuaternion};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::Write as _;
use std::sync::Arc;

pub const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.80665);

/// A random motion at an instant: base pose, twist and its derivative, joints with velocities and accelerations.
pub struct Moving {
    base: Pose,
    twist: Twist,
    acceleration: Twist,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// The wrench on the base, N and N·m, and the effort of each joint: not those of the motion.
    forces: Vec<f64>,
}

fn random_vec(numbers: &mut Numbers, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| (numbers.next() - 0.5) * size)
}

impl Moving {
    pub fn random(numbers: &mut Numbers, joints: usize) -> Moving {
        let turn = UnitQuaternion::from_scaled_axis(random_vec(numbers, 4.0));
        let mut twist = || Twist { linear: random_vec(numbers, 2.0), angular: random_vec(numbers, 4.0) };
        let (velocity, acceleration) = (twist(), twist());
        let base = Pose::from_parts(Translation3::from(random_vec(numbers, 2.0)), turn);
        let mut list = |size: f64| (0..joints).map(|_| (numbers.next() - 0.5) * size).collect();
        let (q, v, a) = (list(3.0), list(6.0), list(20.0));
        let forces = [0.0; 6].into_iter().chain(list(4.0)).collect();
        Moving { base, twist: velocity, acceleration, q, v, a, forces }
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
            forces: self.forces.clone(),
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

    /// The motion as a script reads it: joints in the order of the assembly, everything along the axes of the world.
    pub fn json(&self) -> Value {
        let (p, r) = (self.base.translation.vector, self.base.rotation);
        json!({ "place": [p.x, p.y, p.z], "turn": [r.i, r.j, r.k, r.w], "q": self.q,
            "v": self.u().as_slice(), "a": self.udot().as_slice(), "f": self.forces })
    }
}

/// A robot compiled for dynamics, with all of its bonds.
pub struct Machine {
    pub kinematics: Kinematics,
    dynamics: Dynamics,
}

impl Machine {
    pub fn new(robot: &Assembly) -> Machine {
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

    /// The force and the moment on the base and the effort of each joint that a motion needs, in one list.
    pub fn forces(&self, moving: &Moving, gravity: &Vec3) -> Vec<f64> {
        let needed = self.inverse(moving, gravity);
        let base = needed.base.force.iter().chain(needed.base.moment.iter());
        base.chain(&needed.efforts).copied().collect()
    }

    /// The acceleration of base and joints under a wrench on the base and efforts of joints, in one list.
    fn forward(&self, moving: &Moving, forces: &[f64], gravity: &Vec3) -> Vec<f64> {
        let poses = moving.poses(&self.kinematics);
        let root = self.kinematics.link(self.kinematics.root, 0);
        let mut wrenches = vec![Wrench::default(); poses.len()];
        wrenches[root] = Wrench {
            force: Vec3::from_column_slice(&forces[..3]),
            moment: Vec3::from_column_slice(&forces[3..6]),
        };
        let state = ForcedState {
            poses: &poses,
            base: moving.twist,
            held: false,
            velocities: &moving.v,
            efforts: &forces[6..],
            armatures: &vec![0.0; moving.v.len()],
            wrenches: &wrenches,
        };
        let mut bodies = ForwardDynamics::new(self.dynamics.clone(), self.kinematics.clone());
        let (base, joints) = bodies.accelerations(&state, gravity).expect("all links have masses");
        base.linear.iter().chain(&base.angular).copied().chain(joints).collect()
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
        let forces = |moving: &Moving| DVector::from_vec(machine.forces(moving, &Vec3::zeros()));
        let difference = forces(&moving) - forces(&still) - &M * moving.udot();
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

/// Joints that follow others, with factors, and that slide.
const FOLLOWERS: &str = "module Odd {
  link rail = box(200mm, 50mm, 50mm, mass: 1kg)
  link cart = box(20mm, 30mm, 20mm, mass: 200g) at [0mm, 0mm, 80mm]
  link twin = cylinder(radius: 20mm, length: 30mm, axis: Y, mass: 200g) at [0mm, 0mm, 130mm]
  link arm = box(100mm, 10mm, 10mm, mass: 100g) at [50mm, 90mm, 0mm]
  link lever = box(10mm, 60mm, 10mm, mass: 50g) at [0mm, -80mm, 0mm]
  joint x : rail -> cart = prismatic(axis: X)
  joint y : cart -> twin = prismatic(axis: X + Y)
  joint y = 0.5 * x
  joint a : rail -> arm = revolute(axis: Z) at [0mm, 90mm, 0mm]
  joint b : rail -> lever = revolute(axis: X) at [0mm, -40mm, 10mm]
  joint b = a - 0.5 * x
}
config D { part d: Odd
  behavior rest = wait(1s) }
emit(plan(D().rest(), world: world(ground: off, gravity: off)), \"p.json\")";

#[test]
fn the_efforts_of_a_motion_give_back_the_motion() {
    let mut numbers = Numbers(15);
    let followers = run_clean(FOLLOWERS).plan("p.json");
    let followers = robot_of(&followers).clone();
    for robot in [robots::chain(3), robots::walk4(), robots::ring12(), followers] {
        let machine = Machine::new(&robot);
        for held in [false, true] {
            let mut moving = Moving::random(&mut numbers, machine.kinematics.joint_count());
            let poses = moving.poses(&machine.kinematics);
            let armatures: Vec<f64> = moving.v.iter().map(|_| numbers.next() * 0.01).collect();
            let M = machine.dynamics.mass_matrix(&machine.kinematics, &poses);
            let follows = |joint: usize| M[(6 + joint, 6 + joint)] == 0.0;
            (0..moving.a.len()).filter(|&joint| follows(joint)).for_each(|joint| moving.a[joint] = 0.0);
            if held {
                moving.acceleration = Twist::default();
            }
            let needed = machine.inverse(&moving, &GRAVITY);
            let root = machine.kinematics.link(machine.kinematics.root, 0);
            let mut wrenches = vec![Wrench::default(); poses.len()];
            // A wrench on the last link is felt by the base and by the joints on the way.
            let outer =
                Wrench { force: random_vec(&mut numbers, 2.0), moment: random_vec(&mut numbers, 1.0) };
            let last = poses.len() - 1;
            let mut carried = vec![Wrench::default(); poses.len()];
            carried[last] = outer;
            let origin = poses[root].translation.vector;
            let felt = machine.dynamics.efforts(&machine.kinematics, &poses, &mut carried, &origin);
            wrenches[last] = outer;
            if !held {
                wrenches[root].force += needed.base.force - carried[root].force;
                wrenches[root].moment += needed.base.moment - carried[root].moment;
            }
            let own = |joint: usize| needed.efforts[joint] - felt[joint] + armatures[joint] * moving.a[joint];
            let efforts: Vec<f64> = (0..moving.a.len()).map(own).collect();
            let state = ForcedState {
                poses: &poses,
                base: moving.twist,
                held,
                velocities: &moving.v,
                efforts: &efforts,
                armatures: &armatures,
                wrenches: &wrenches,
            };
            let mut bodies = ForwardDynamics::new(machine.dynamics.clone(), machine.kinematics.clone());
            let (base, joints) = bodies.accelerations(&state, &GRAVITY).expect("all links have masses");
            let off = (base.linear - moving.acceleration.linear).norm()
                + (base.angular - moving.acceleration.angular).norm();
            let error = joints.iter().zip(&moving.a).fold(off, |e, (x, y)| e.max((x - y).abs()));
            assert!(error < 1e-8, "{} held {held}: {error:e}", robot.name);
        }
    }
}

/// Returns a random symmetric inertia that a body can have, kg·m²; with the axes of the frame if `aligned` is true.
fn random_inertia(numbers: &mut Numbers, aligned: bool) -> Matrix3<f64> {
    let size = random_vec(numbers, 1.0).map(f64::abs);
    let moments = Vec3::new(size.y + size.z, size.x + size.z, size.x + size.y);
    let turn = if aligned { Vec3::zeros() } else { random_vec(numbers, 4.0) };
    let R = UnitQuaternion::from_scaled_axis(turn).to_rotation_matrix();
    R.matrix() * Matrix3::from_diagonal(&moments) * R.matrix().transpose()
}

#[test]
fn inertias_of_bodies_parts_and_points_are_those_of_their_matrices() {
    let mut numbers = Numbers(5);
    let close = |a: &SpatialInertia, b: &SpatialInertia| {
        let off = (a.matrix() - b.matrix()).abs().max();
        assert!(off < 1e-13 * (1.0 + b.matrix().abs().max()), "{off}");
    };
    for round in 0..40 {
        let aligned = round % 2 == 0;
        let mut body = || RigidBody {
            mass: 0.1 + numbers.next(),
            com: random_vec(&mut numbers, 1.0),
            inertia: random_inertia(&mut numbers, aligned),
        };
        let (first, second) = (body(), body());
        let mut pose = || {
            let turn = UnitQuaternion::from_scaled_axis(random_vec(&mut numbers, 4.0));
            Pose::from_parts(Translation3::from(random_vec(&mut numbers, 2.0)), turn)
        };
        let (X_WA, X_AB) = (pose(), pose());
        let origin = random_vec(&mut numbers, 1.0);
        let of = |body: &RigidBody, pose: &Pose| SpatialInertia::from(body.composite(pose, &origin));
        let (R, com) =
            (X_WA.rotation.to_rotation_matrix(), X_WA * Point3::from(first.com) - Point3::from(origin));
        close(&SpatialInertia::of_rigid(&first, R.matrix(), &com).0, &of(&first, &X_WA));
        let both = RigidBody::of_parts(&[(first, Pose::identity()), (second, X_AB)]);
        close(&of(&both, &X_WA), &of(&first, &X_WA).plus(&of(&second, &(X_WA * X_AB))));
        let (across, along) = (numbers.next(), numbers.next());
        close(
            &SpatialInertia::at_point_of_level(across, along, &origin),
            &SpatialInertia::at_point(across, along, &Vec3::z(), &origin),
        );
    }
    // Boxes that hang together at right angles keep the axes of their frames, although a quarter turn is rounded.
    let box_of = |x: f64| RigidBody {
        mass: 1.0,
        com: Vec3::new(x, 0.0, 0.0),
        inertia: Matrix3::from_diagonal(&(Vec3::new(1.0, 2.0, 2.5) * 1e-3)),
    };
    let quarter = UnitQuaternion::from_scaled_axis(Vec3::x() * std::f64::consts::FRAC_PI_2);
    let pose = Pose::from_parts(Translation3::new(0.1, 0.0, 0.0), quarter);
    let both = RigidBody::of_parts(&[(box_of(0.02), Pose::identity()), (box_of(-0.03), pose)]);
    assert_eq!(both.inertia, Matrix3::from_diagonal(&both.inertia.diagonal()));
}

#[test]
fn what_has_no_inertia_has_no_acceleration() {
    let mut robot = robots::chain(1);
    let mut library = (*robot.library).clone();
    let disc = library.modules[robot.modules[0].kind].links.last_mut().expect("a module has links");
    (disc.mass, disc.inertia) = (0.0, [0.0; 6]);
    robot.library = Arc::new(library);
    let machine = Machine::new(&robot);
    let moving = Moving::random(&mut Numbers(16), machine.kinematics.joint_count());
    let poses = moving.poses(&machine.kinematics);
    let zero = vec![0.0; moving.v.len()];
    let wrenches = vec![Wrench::default(); poses.len()];
    let state = ForcedState {
        poses: &poses,
        base: Twist::default(),
        held: false,
        velocities: &zero,
        efforts: &zero,
        armatures: &zero,
        wrenches: &wrenches,
    };
    let mut bodies = ForwardDynamics::new(machine.dynamics, machine.kinematics);
    assert_eq!(bodies.accelerations(&state, &GRAVITY), None, "a wheel without mass");
    let geared = vec![1e-3; zero.len()];
    let (base, joints) = bodies
        .accelerations(&ForcedState { armatures: &geared, ..state }, &GRAVITY)
        .expect("the motors have inertia");
    assert!((base.linear - GRAVITY).norm() < 1e-12, "it falls");
    assert!(joints.iter().all(|a| a.abs() < 1e-9), "as one body");
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
    efforts = np.zeros(model.nv)
    efforts[order] = s["f"]
    free = pin.aba(model, data, q, v, T.T @ efforts)
    free[0:3] = R @ (free[0:3] + np.cross(ang, lin))
    free[3:6] = R @ free[3:6]
    M = pin.crba(model, data, q)
    M = np.triu(M) + np.triu(M, 1).T
    M = (T @ M @ T.T)[np.ix_(order, order)]
    out.append({"tau": tau[order].tolist(), "M": M.flatten().tolist(), "free": free[order].tolist()})
json.dump(out, sys.stdout)
"#;

/// The plan of a design of `std.smores` that floats at rest, by the design's name.
pub fn library_plan(name: &str) -> Plan {
    let program = format!(
        "use std.smores.{name}\nconfig D {{ part d: {name}\n  behavior rest = wait(1s) }}\n\
         emit(plan(D().rest(), world: world(ground: off, gravity: off)), \"p.json\")"
    );
    run_clean(&program).plan("p.json")
}

/// The robot of a plan.
pub fn robot_of(plan: &Plan) -> &Assembly {
    &plan.body.tracks().expect("the robot has joints").robot
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
    let whole = whole();
    let mut all =
        vec![robots::chain(3), robots::walk4(), robots::car(), robots::backhoe(4), robots::ring12()];
    if whole {
        let names: BTreeSet<&str> = BEHAVIORS.iter().map(|(robot, ..)| *robot).collect();
        all.extend(names.into_iter().map(|name| robot_of(&library_plan(name)).clone()));
    }
    for robot in all {
        let machine = Machine::new(&robot);
        let urdf = Urdf::new(&robot, &machine.kinematics);
        let all: Vec<Moving> = (0..if whole { 1000 } else { 200 })
            .map(|_| Moving::random(&mut numbers, machine.kinematics.joint_count()))
            .collect();
        let states: Vec<Value> = all.iter().map(Moving::json).collect();
        let gravity = GRAVITY.as_slice();
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
            let forces = machine.forces(moving, &GRAVITY);
            let M = machine.dynamics.mass_matrix(&machine.kinematics, &moving.poses(&machine.kinematics));
            let free = machine.forward(moving, &moving.forces, &GRAVITY);
            let ours = [&forces, &M.as_slice().to_vec(), &free];
            for (ours, theirs) in ours.into_iter().zip(["tau", "M", "free"].map(numbers)) {
                let scale = theirs.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
                assert_eq!(ours.len(), theirs.len());
                let error = ours.iter().zip(&theirs).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
                assert!(error < TOL * scale, "{}: {error:e} of {scale}", robot.name);
            }
        }
    }
}
