//! The time steps of a simulation: semi-implicit Euler, with servos, stops and contacts at the end of the step.
//! Velocities are half a step behind positions: velocity products are taken half a step later, so that free motion is of
//! the second order.
//!
//! The velocities after a step of length h solve `(M + h D + h² K) (v⁺ - v) = h (τ - b + Jᵀ f)`, with all springs K and
//! dampers D of servos, stops and contacts on the left: they are inertias of joints and links to the articulated-body
//! method, which so stays linear in the number of links. Rounds find the contacts that stick, slide or part, and the motors
//! that are at their limits.

use super::coupling::{Couplings, Instant};
use super::ground_contact::GroundContacts;
use super::link_contact::LinkContacts;
use super::model::{CarryingBond, CoupledMotor, DrivenServo, Joint, Model};
use super::parameters::PARAMETERS;
use crate::geometry::pose::{length, turned};
use crate::geometry::{Mat3, Pose, Vec3, sin_cos_of_all};
use crate::robot::articulated_bodies::{ArticulatedBodies, Attachment};
use crate::robot::dynamics::Twist;
use crate::robot::spatial::SpatialVector;
use crate::robot::{Assembly, PortRef};

/// The state of a servo in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ServoState {
    /// The effort of a motor at its limit while the joint rests, N·m or N, and how much less it is for each unit of its rate;
    /// `None`: the servo is a spring with a damper.
    limited: Option<(f64, f64)>,
    /// The end of its range that the joint is at.
    stop: Option<f64>,
}

impl ServoState {
    /// Returns false if the motor is at its limit in one direction and this limit is in the other: the effort that it needs
    /// is between them, where it is a spring with a damper.
    fn leads_to(&self, (limit, _): &(f64, f64)) -> bool {
        self.limited.is_none_or(|(now, _)| now * limit >= 0.0)
    }
}

/// A robot in motion.
#[derive(Clone, Debug)]
pub(crate) struct Stepper<'a> {
    /// The model of the robot.
    pub model: &'a Model,
    /// The time step, s.
    pub step: f64,
    /// The acceleration of free fall, m/s².
    gravity: Vec3,
    bodies: ArticulatedBodies,
    /// The joints of the model with their bodies, side by side in memory.
    joints: Vec<(usize, Joint)>,
    /// The bases that move freely, by the indices of their bodies.
    floating: Vec<usize>,
    /// The contacts with the ground; `None` where there is none.
    pub ground: Option<GroundContacts>,
    /// The couplings of bodies: joints that follow others, bonds that are in no tree, contacts of links.
    pub couplings: Couplings,
    /// The world poses of the bodies at the start of the step taken last.
    poses: Vec<Pose>,
    /// Their rotations as matrices.
    turns: Vec<Mat3>,
    /// The poses of the bases now, by body; of other bodies they are of no use.
    bases: Vec<Pose>,
    /// Half the coordinates of the joints, with their sines and cosines, by body.
    halves: Vec<f64>,
    sines: Vec<f64>,
    cosines: Vec<f64>,
    /// The velocities of the bases, by body.
    twists: Vec<Twist>,
    /// The coordinates of the joints, by body, rad or m.
    pub coordinates: Vec<f64>,
    /// The rates of the joints, by body, rad/s or m/s.
    pub rates: Vec<f64>,
    /// The twists and rates of half a step later, if they go on to change as in the step before: those of the middle of the
    /// step in which velocities are half a step behind.
    mid_twists: Vec<Twist>,
    mid_rates: Vec<f64>,
    /// The efforts of the servos in the step taken last, by body, N·m or N, along the coordinates.
    pub efforts: Vec<f64>,
    servos: Vec<ServoState>,
    /// The states that a round found for servos whose motors drive several joints, before the limits of those motors.
    coupled_servos: Vec<ServoState>,
    /// The memory in which the efforts of joints that motors drive together are found, and those of the motors.
    coupled_efforts: Vec<f64>,
    needed: Vec<f64>,
    /// The point that spatial vectors were about in the step taken last, m.
    pub origin: Vec3,
    /// The height of the centre of mass at the start of the step taken last, m.
    centre_height: f64,
    /// The number of steps taken.
    number: u64,
}

/// The fault of a step that can't be taken: inertias or forces that are not finite, or no inertia where some is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoInertia;

impl<'a> Stepper<'a> {
    /// Returns a robot at rest with its joints at `joints` (rad or m, by their ids). `gravity`: m/s², downwards; `ground`:
    /// that under it, if there is one; `step`: the time step, s.
    pub(crate) fn new(
        model: &'a Model,
        couplings: Couplings,
        joints: &[f64],
        gravity: f64,
        ground: Option<GroundContacts>,
        step: f64,
    ) -> Stepper<'a> {
        let attachments: Vec<Attachment> = model.bodies.iter().map(|body| body.attachment).collect();
        let count = model.bodies.len();
        let own = model.bodies.iter().enumerate().filter_map(|(at, body)| Some((at, body.joint.clone()?)));
        Stepper {
            model,
            step,
            gravity: Vec3::new(0.0, 0.0, -gravity),
            bodies: ArticulatedBodies::new(&attachments),
            joints: own.collect(),
            floating: (0..count).filter(|at| attachments[*at] == Attachment::Floating).collect(),
            ground,
            couplings,
            poses: model.start.clone(),
            turns: vec![Mat3::identity(); count],
            bases: model.start.clone(),
            halves: vec![0.0; count],
            sines: vec![0.0; count],
            cosines: vec![0.0; count],
            twists: vec![Twist::default(); count],
            coordinates: model.coordinates(joints),
            rates: vec![0.0; count],
            mid_twists: vec![Twist::default(); count],
            mid_rates: vec![0.0; count],
            efforts: vec![0.0; count],
            servos: vec![ServoState::default(); count],
            coupled_servos: vec![ServoState::default(); count],
            coupled_efforts: Vec::new(),
            needed: Vec::new(),
            origin: Vec3::zeros(),
            centre_height: 0.0,
            number: 0,
        }
    }

    /// Takes a step from `time` (s) on. `commands`: the commanded position and rate of each joint at its end, by the number of
    /// its id.
    ///
    /// # Errors
    /// [`NoInertia`] where a joint or base has no inertia, or values are not finite any more.
    pub(crate) fn take(&mut self, commands: &[(f64, f64)], time: f64) -> Result<(), NoInertia> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the instructions that the function was compiled for.
            return unsafe { self.take_with_avx2(commands, time) };
        }
        self.take_any(commands, time)
    }

    /// Takes a step as [`take`](Self::take) does, with the wider instructions of newer processors. They do the same
    /// arithmetic: a product and a sum are never rounded as one.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn take_with_avx2(&mut self, commands: &[(f64, f64)], time: f64) -> Result<(), NoInertia> {
        self.take_any(commands, time)
    }

    /// Takes a step as [`take`](Self::take) does, with the instructions that its caller is compiled for.
    #[inline(always)]
    fn take_any(&mut self, commands: &[(f64, f64)], time: f64) -> Result<(), NoInertia> {
        self.number += 1;
        let origin = self.bases[0].translation.vector;
        self.origin = origin;
        self.place(&origin, commands);
        if let Some(ground) = &mut self.ground {
            ground.find(self.model, &self.bodies, (&self.poses, &self.turns), &origin, self.number);
        }
        let at = Instant {
            time,
            step: self.step,
            poses: &self.poses,
            turns: &self.turns,
            origin,
            coordinates: &self.coordinates,
        };
        self.couplings.find(self.model, &self.bodies, &at, commands, self.number);
        let weight = self.model.mass * length(&self.gravity).max(1.0);
        for round in 0..PARAMETERS.rounds_max {
            if let Some(ground) = &self.ground {
                let (model, poses, turns) = (self.model, &self.poses, &self.turns);
                let gravity = &self.gravity;
                ground.add_to(&mut self.bodies, round > 0, |bodies, body| {
                    set_rigid(bodies, body, model, (&poses[body], &turns[body]), &origin, gravity);
                });
            }
            self.bodies.accelerate().ok_or(NoInertia)?;
            let solved = self.couplings.solve(self.model, &mut self.bodies, self.step, &self.rates);
            solved.ok_or(NoInertia)?;
            let of_ground = match &mut self.ground {
                Some(ground) => ground.update(&self.bodies),
                None => 0.0,
            };
            let change = self.couplings.update(&self.bodies, self.step).max(of_ground);
            let settled = self.update_servos(commands, round == 0);
            if settled && change <= PARAMETERS.force_change * weight {
                break;
            }
        }
        if let Some(ground) = &mut self.ground {
            ground.keep(self.number);
        }
        self.couplings.keep(self.model, &self.bodies, self.step, self.number);
        self.move_on(&origin)
    }

    /// Finds the poses, twists and rigid inertias of all bodies, and sets the efforts of their joints; spatial vectors are
    /// about `origin`.
    #[inline(always)]
    fn place(&mut self, origin: &Vec3, commands: &[(f64, f64)]) {
        for (half, coordinate) in self.halves.iter_mut().zip(&self.coordinates) {
            *half = 0.5 * coordinate;
        }
        sin_cos_of_all(&self.halves, &mut self.sines, &mut self.cosines);
        let mut first = 0.0;
        for (at, body) in self.model.bodies.iter().enumerate() {
            match (&body.step, body.attachment) {
                (Some(step), Attachment::Joint(parent) | Attachment::Fixed(parent)) => {
                    let (pose, turn) = step.child_pose_turned(
                        &self.poses[parent],
                        &self.turns[parent],
                        self.coordinates[at],
                        (self.sines[at], self.cosines[at]),
                    );
                    let axis = step.axis_turned(&self.poses[parent], &pose, &turn);
                    let axis =
                        axis.map_or(SpatialVector::default(), |axis| SpatialVector::of_axis(&axis, origin));
                    self.bodies.set_joint(at, axis, self.rates[at], self.mid_rates[at]);
                    (self.poses[at], self.turns[at]) = (pose, turn);
                    self.set_servo(at, commands);
                }
                (Some(step), Attachment::Part(parent)) => {
                    let whole = (&self.poses[parent], &self.turns[parent]);
                    (self.poses[at], self.turns[at]) =
                        step.child_pose_turned(whole.0, whole.1, 0.0, (0.0, 1.0));
                    continue;
                }
                _ => {
                    self.poses[at] = self.bases[at];
                    self.turns[at] = *self.poses[at].rotation.to_rotation_matrix().matrix();
                    let from = origin - self.poses[at].translation.vector;
                    let about = |Twist { linear, angular }: Twist| SpatialVector {
                        angular,
                        linear: linear + angular.cross(&from),
                    };
                    let held = body.attachment == Attachment::Held;
                    self.bodies.set_base(at, about(self.twists[at]), about(self.mid_twists[at]), held);
                }
            }
            let pose = (&self.poses[at], &self.turns[at]);
            let com = set_rigid(&mut self.bodies, at, self.model, pose, origin, &self.gravity);
            first += com.z * body.rigid.mass;
        }
        self.centre_height = if self.model.mass > 0.0 { origin.z + first / self.model.mass } else { 0.0 };
    }

    /// Sets the effort of a body's joint, if it has one, as its servo is now.
    #[inline(always)]
    fn set_servo(&mut self, at: usize, commands: &[(f64, f64)]) {
        let h = self.step;
        let Some(joint) = &self.model.bodies[at].joint else { return };
        let (q, v) = (self.coordinates[at], self.rates[at]);
        let (mut effort, mut armature) = (-joint.damping * v, joint.armature + h * joint.damping);
        match (joint.servo, self.servos[at].limited) {
            (Some(_), Some((limited, falling))) => {
                effort += limited - falling * v;
                armature += h * falling;
            }
            (Some(servo), None) => {
                let command = command(commands, joint.id, joint.factor);
                effort += spring(&servo, h, q, v, command);
                armature += h * (h * servo.stiffness + servo.damping);
            }
            (None, _) => {}
        }
        if let Some(end) = self.servos[at].stop {
            let stiffness = stop_stiffness(joint);
            effort += stop_effort(stiffness, end, h, q, v);
            armature += h * (h + PARAMETERS.contact_damping) * stiffness;
        }
        self.bodies.set_effort(at, effort, armature);
    }

    /// Sets a servo to another state. Returns true if it is not another.
    #[inline]
    fn change_servo(&mut self, at: usize, now: ServoState, commands: &[(f64, f64)]) -> bool {
        let same = now == self.servos[at];
        if !same {
            self.servos[at] = now;
            self.set_servo(at, commands);
        }
        same
    }

    /// Finds which motors are at their limits and which joints at their stops, for the accelerations of a round. Returns
    /// true if that was known. `first`: true in the first round, in which stops are those of the step before: one that pulls
    /// lets go.
    #[inline(always)]
    fn update_servos(&mut self, commands: &[(f64, f64)], first: bool) -> bool {
        let h = self.step;
        let mut settled = true;
        for number in 0..self.joints.len() {
            let (at, joint) = &self.joints[number];
            let at = *at;
            let q = self.coordinates[at];
            let v = self.rates[at] + h * self.bodies.joint_acceleration(at);
            let mut now = ServoState::default();
            if let Some(servo) = &joint.servo {
                let effort = spring(servo, h, q, v, command(commands, joint.id, joint.factor));
                now.limited = servo.limit_at(effort, v).filter(|limit| self.servos[at].leads_to(limit));
                self.efforts[at] = now.limited.map_or(effort, |(limited, falling)| limited - falling * v);
            }
            if let Some((low, high)) = joint.range {
                let next = q + h * v;
                now.stop = if next > high { Some(high) } else { (next < low).then_some(low) };
                if first && let Some(end) = self.servos[at].stop.filter(|end| now.stop == Some(*end)) {
                    let outwards = if end == high { 1.0 } else { -1.0 };
                    now.stop = Some(end)
                        .filter(|_| stop_effort(stop_stiffness(joint), end, h, q, v) * outwards < 0.0);
                }
            }
            if joint.is_coupled {
                self.coupled_servos[at] = now;
            } else {
                settled &= self.change_servo(at, now, commands);
            }
        }
        for coupled in &self.model.coupled {
            let of = |(body, sign): &(usize, f64)| self.efforts[*body] * sign;
            self.coupled_efforts.clear();
            self.coupled_efforts.extend(coupled.bodies.iter().map(of));
            let efforts = &self.coupled_efforts;
            self.needed.clear();
            self.needed.extend(coupled.motors.iter().map(|motor| dot(&motor.shares, efforts)));
            let exceeds = |(motor, needed): (&CoupledMotor, &f64)| needed.abs() > motor.effort;
            let limited = coupled.motors.iter().zip(&self.needed).any(exceeds);
            for (number, (body, sign)) in coupled.bodies.iter().enumerate() {
                let mut now = self.coupled_servos[*body];
                if limited {
                    let drives = |(motor, needed): (&CoupledMotor, &f64)| {
                        motor.factors[number] * needed.clamp(-motor.effort, motor.effort)
                    };
                    let effort = sign * coupled.motors.iter().zip(&self.needed).map(drives).sum::<f64>();
                    self.efforts[*body] = effort;
                    now.limited = Some((effort, 0.0)).filter(|limit| self.servos[*body].leads_to(limit));
                }
                settled &= self.change_servo(*body, now, commands);
            }
        }
        settled
    }

    /// Moves on by the accelerations found.
    #[inline(always)]
    fn move_on(&mut self, origin: &Vec3) -> Result<(), NoInertia> {
        let h = self.step;
        let mut sum = 0.0;
        for &(at, _) in &self.joints {
            let change = h * self.bodies.joint_acceleration(at);
            self.rates[at] += change;
            self.mid_rates[at] = self.rates[at] + change / 2.0;
            self.coordinates[at] += h * self.rates[at];
            sum += self.coordinates[at];
        }
        for &at in &self.floating {
            let base = &mut self.bases[at];
            let twist = &mut self.twists[at];
            let acceleration = self.bodies.acceleration(at);
            let from = base.translation.vector - origin;
            let mid_twist = &mut self.mid_twists[at];
            let linear = (acceleration.at(&from) + mid_twist.angular.cross(&mid_twist.linear)) * h;
            let angular = acceleration.angular * h;
            twist.linear += linear;
            twist.angular += angular;
            mid_twist.linear = twist.linear + linear / 2.0;
            mid_twist.angular = twist.angular + angular / 2.0;
            base.translation.vector += twist.linear * h;
            let turn = turned(twist.angular, length(&twist.angular) * h).rotation;
            base.rotation = nalgebra::UnitQuaternion::new_normalize(*(turn * base.rotation));
            sum += base.translation.vector.sum();
        }
        if f64::is_finite(sum) { Ok(()) } else { Err(NoInertia) }
    }

    /// Lets a bond, by its index in the assembly, hold from now on or no longer. Returns the distance (m) and the angle
    /// (rad) of its ports from a perfect mate; `None` if it is in a tree.
    pub(crate) fn hold(&mut self, bond: usize, holds: bool, commands: &[(f64, f64)]) -> Option<(f64, f64)> {
        self.couplings.hold(bond, holds, &self.poses, commands)
    }

    /// Returns the load of each bond that states what it holds, as (index of the bond in the assembly, part of what it
    /// holds, true if it is in no tree), for the step taken last.
    pub(crate) fn bond_loads(&self, robot: &Assembly) -> Vec<(usize, f64, bool)> {
        let mut loads = self.couplings.loads(robot, &self.poses);
        let origin = self.origin;
        for &CarryingBond { bond, carried, port } in &self.model.carrying {
            let SpatialVector { angular, linear } = self.bodies.transmitted(carried);
            let X_WP = self.poses[port.0] * port.1;
            let point = X_WP.translation.vector - origin;
            let wrench = [linear, angular - point.cross(&linear)];
            // The load is that of the first port on the second; the tree may carry the first by the second.
            let sign = if port.0 == carried { -1.0 } else { 1.0 };
            let load = super::coupling::load(robot, bond, &X_WP, wrench.map(|w| w * sign));
            loads.push((bond, load, false));
        }
        loads
    }

    /// Returns the position (rad or m), the rate and the effort (N·m or N) of a joint as its sensors have them now, by the
    /// number of its id: the position is off by the error of its zero. `None` for a joint that moves no body of a tree.
    pub(crate) fn sensed(&self, joint: usize) -> Option<[f64; 3]> {
        let body = self.model.moved_by[joint]?;
        let moves = self.model.bodies[body].joint.as_ref()?;
        let position = self.coordinates[body] - moves.servo.as_ref().map_or(0.0, |servo| servo.zero);
        Some([position, self.rates[body], self.efforts[body]].map(|value| value * moves.factor))
    }

    /// Returns the world pose of a port at the start of the step taken last.
    pub(crate) fn port_pose(&self, robot: &Assembly, port: PortRef) -> Pose {
        let (body, X_BP) = self.model.port(robot, port);
        self.poses[body] * X_BP
    }

    /// Returns the world poses of a module's body: as the simulation begins, and at the start of the step taken last.
    pub(crate) fn module_poses(&self, module: usize) -> (Pose, Pose) {
        let body = self.model.body(module, 0);
        (self.model.start[body], self.poses[body])
    }

    /// Returns true if one of some modules, given by their indices, touched one of `others`, or the ground or another module where
    /// there is `None`, in the step taken last. Modules that are docked to each other do not touch.
    pub(crate) fn touches(&self, modules: &[usize], others: Option<&[usize]>) -> bool {
        let module = |body: usize| self.model.module_of[body];
        let among = |body: usize| modules.contains(&module(body));
        let meant = |a: usize, b: usize| match others {
            None => among(a) != among(b),
            Some(others) => [(a, b), (b, a)].iter().any(|(a, b)| among(*a) && others.contains(&module(*b))),
        };
        let docked = |a: usize, b: usize| {
            let (a, b) = (module(a), module(b));
            self.model.bonded.contains(&(a.min(b), a.max(b))) || self.couplings.docks(self.model, a, b)
        };
        let ground = self.ground.iter().flat_map(|ground| ground.touching());
        let links = self.couplings.links.iter().flat_map(LinkContacts::touching);
        others.is_none() && ground.into_iter().any(among)
            || links.into_iter().any(|(a, b)| meant(a, b) && !docked(a, b))
    }

    /// Returns the world poses of the bodies at the start of the step taken last.
    pub(crate) fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Returns the height of the centre of mass at the start of the step taken last, m.
    pub(crate) fn centre_height(&self) -> f64 {
        self.centre_height
    }

    /// Returns the way that each body has slid over the ground since the start, m; nothing without ground.
    pub(crate) fn slid(&self) -> &[f64] {
        self.ground.as_ref().map_or(&[], |ground| &ground.slid)
    }

    /// Returns the greatest speed at which a point came down on the ground in the step taken last that had not touched it
    /// before, m/s.
    pub(crate) fn impact(&self) -> f64 {
        self.ground.as_ref().map_or(0.0, GroundContacts::impact)
    }

    /// Returns the world pose of a base now; `body`: its index.
    pub(crate) fn base(&self, body: usize) -> &Pose {
        &self.bases[body]
    }
}

/// Sets inertia and weight of a body, whose motion must have been set. Returns its centre of mass, from `origin`, m. `pose`: its
/// pose in the world, with the rotation as a matrix.
#[inline(always)]
fn set_rigid(
    bodies: &mut ArticulatedBodies,
    body: usize,
    model: &Model,
    (pose, turn): (&Pose, &Mat3),
    origin: &Vec3,
    gravity: &Vec3,
) -> Vec3 {
    let rigid = &model.bodies[body].rigid;
    let com = pose.translation.vector + turn * rigid.com - origin;
    bodies.set_rigid(body, rigid, turn, &com, gravity);
    com
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the commanded coordinate of a joint and its rate.
fn command(commands: &[(f64, f64)], joint: usize, factor: f64) -> (f64, f64) {
    let (position, rate) = commands[joint];
    (position * factor, rate * factor)
}

/// Returns the effort of a servo at the end of a step that begins at the coordinate `q` and has the rate `v`.
fn spring(servo: &DrivenServo, step: f64, q: f64, v: f64, (wanted, rate): (f64, f64)) -> f64 {
    servo.stiffness * (wanted + servo.zero - q - step * v) + servo.damping * (rate - v)
}

/// Returns the stiffness of the stops of a joint, N·m/rad or N/m.
fn stop_stiffness(joint: &Joint) -> f64 {
    if joint.slides { PARAMETERS.slide_stop_stiffness } else { PARAMETERS.stop_stiffness }
}

/// Returns the effort of the stop of a stiffness (N·m/rad or N/m) at an end of a joint's range, N·m or N, at the end of a step that begins at the coordinate `q`
/// and has the rate `v`.
fn stop_effort(stiffness: f64, end: f64, step: f64, q: f64, v: f64) -> f64 {
    stiffness * (end - q - step * v - PARAMETERS.contact_damping * v)
}
