//! Forward dynamics of robots as trees of rigid bodies on floating or held bases: the accelerations that efforts and
//! outer forces give them, by articulated bodies (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, ch. 7).
//!
//! [`ArticulatedBodies`] takes trees of bodies with axes and inertias in the world, as a simulation has them;
//! [`ForwardDynamics`] the state of one robot, as a question about an instant has it.

use super::dynamics::{Dynamics, MotionState, RigidBody, Twist, Wrench};
use super::kinematics::Kinematics;
use super::spatial::{SpatialInertia, SpatialVector};
use crate::geometry::{Pose, Vec3};
use nalgebra::{Cholesky, Const, DVector, Matrix3};

/// The way in which a body hangs on others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attachment {
    /// The body is the base of a tree, and moves freely.
    #[default]
    Floating,
    /// The body is the base of a tree, and keeps its velocity, whatever force that takes.
    Held,
    /// A joint carries the body on the body of this index.
    Joint(usize),
    /// The body is fixed to the body of this index, by something whose wrench may be asked for.
    Fixed(usize),
    /// The body is a part of the body of this index: both are one.
    Part(usize),
}

/// The inertia of a body on the way through the passes.
#[derive(Clone, Copy, Debug, Default)]
struct Body {
    /// The index by which the body goes.
    index: usize,
    /// True if the body carries others; if not, its articulated inertia is its own.
    carries: bool,
    /// True if the body is the last of those that its parent carries: the first to add to the parent's articulated inertia.
    begins: bool,
    /// The effort of the joint, and the inertia that it has besides that of the bodies.
    effort: f64,
    armature: f64,
    /// The inertia and the bias force of the body itself, with what was added; the bias force is that of the drift, so that the
    /// passes know accelerations beyond it only, which are those of joints and bases.
    own_bias: SpatialVector,
    own_inertia: SpatialInertia,
    /// The articulated inertia and bias force.
    bias: SpatialVector,
    inertia: SpatialInertia,
}

/// The joint, or what else a body hangs on: all that the pass from the bases on needs to know of it.
#[derive(Clone, Copy, Debug, Default)]
struct Suspension {
    /// The way in which the body hangs on others, by their slots.
    attachment: Attachment,
    /// The twist of the body for a unit velocity of its joint; zero without one.
    axis: SpatialVector,
    /// The articulated inertia times the axis, and one divided by the axis times that with the armature.
    force: SpatialVector,
    mobility: f64,
    /// The effort that is left to accelerate the joint.
    effort: f64,
}

/// The twist of a body of which velocity products are taken, that of the middle of a step or the same, and the acceleration
/// that the body has of velocity products alone, where neither bases nor joints accelerate.
#[derive(Clone, Copy, Debug, Default)]
struct Drift {
    velocity: SpatialVector,
    acceleration: SpatialVector,
}

impl Body {
    /// Returns the articulated inertia.
    #[inline]
    fn articulated(&self) -> &SpatialInertia {
        if self.carries { &self.inertia } else { &self.own_inertia }
    }

    /// Adds the articulated inertia and bias force of a body that this one carries to its own; `begins`: true for the first
    /// that adds.
    #[inline(always)]
    fn carry(&mut self, inertia: &SpatialInertia, bias: &SpatialVector, begins: bool) {
        match begins {
            true => {
                self.inertia = self.own_inertia.plus(inertia);
                self.bias = self.own_bias.plus(bias, 1.0);
            }
            false => {
                self.inertia.add(inertia);
                self.bias = self.bias.plus(bias, 1.0);
            }
        }
    }
}

/// Trees of rigid bodies with the memory that their forward dynamics needs. Bodies go by their indices; those that
/// carry come before those that they carry.
#[derive(Clone, Debug)]
pub struct ArticulatedBodies {
    /// The bodies but for those that are parts of others, and in the same order what each hangs on, its velocity, its drift,
    /// its acceleration beyond the drift, and that of its joint: large robots do not fit the nearest caches, and few loops need
    /// all of it.
    bodies: Vec<Body>,
    suspensions: Vec<Suspension>,
    velocities: Vec<SpatialVector>,
    drifts: Vec<Drift>,
    accelerations: Vec<SpatialVector>,
    joint_accelerations: Vec<f64>,
    /// The slot in `bodies` of each body, by its index; of a part that of the whole.
    slots: Vec<u32>,
    /// The slots of the bases, with the decomposition of their articulated inertia where they float.
    bases: Vec<(usize, Option<Cholesky<f64, Const<6>>>)>,
}

impl ArticulatedBodies {
    /// Returns the trees in which bodies are attached so, by their indices; all without inertia. Panics if a body does
    /// not come after that which carries it.
    pub fn new(attachments: &[Attachment]) -> ArticulatedBodies {
        let mut bodies: Vec<Body> = Vec::with_capacity(attachments.len());
        let mut suspensions: Vec<Suspension> = Vec::with_capacity(attachments.len());
        let mut slots: Vec<u32> = Vec::with_capacity(attachments.len());
        for (index, attachment) in attachments.iter().enumerate() {
            let slot = |parent: usize| {
                assert!(parent < index, "bodies come after those that carry them");
                slots[parent] as usize
            };
            let attachment = match *attachment {
                Attachment::Joint(parent) => Attachment::Joint(slot(parent)),
                Attachment::Fixed(parent) => Attachment::Fixed(slot(parent)),
                Attachment::Part(whole) => {
                    slots.push(slot(whole) as u32);
                    continue;
                }
                base => base,
            };
            slots.push(bodies.len() as u32);
            bodies.push(Body { index, ..Body::default() });
            suspensions.push(Suspension { attachment, ..Suspension::default() });
        }
        for slot in (0..bodies.len()).rev() {
            if let Attachment::Joint(parent) | Attachment::Fixed(parent) = suspensions[slot].attachment {
                bodies[slot].begins = !bodies[parent].carries;
                bodies[parent].carries = true;
            }
        }
        let base = |of: &Suspension| matches!(of.attachment, Attachment::Floating | Attachment::Held);
        let count = bodies.len();
        ArticulatedBodies {
            bases: (0..count).filter(|&b| base(&suspensions[b])).map(|b| (b, None)).collect(),
            bodies,
            suspensions,
            velocities: vec![SpatialVector::default(); count],
            drifts: vec![Drift::default(); count],
            accelerations: vec![SpatialVector::default(); count],
            joint_accelerations: vec![0.0; count],
            slots,
        }
    }

    /// Returns the slot of the body of an index; of a part that of the whole.
    #[inline(always)]
    fn slot(&self, index: usize) -> usize {
        self.slots[index] as usize
    }

    /// Returns the body of an index to be changed; of a part the whole.
    #[inline(always)]
    fn body_mut(&mut self, index: usize) -> &mut Body {
        &mut self.bodies[self.slots[index] as usize]
    }

    /// Sets the motion of a base: its twist (rad/s, m/s), which it keeps if `held` is true, whatever force that takes.
    /// `mid_twist`: the twist of which velocity products are taken; that of the middle of a step makes steps of the second
    /// order.
    pub fn set_base(&mut self, body: usize, twist: SpatialVector, mid_twist: SpatialVector, held: bool) {
        let slot = self.slot(body);
        self.suspensions[slot].attachment = if held { Attachment::Held } else { Attachment::Floating };
        self.velocities[slot] = twist;
        self.drifts[slot] = Drift { velocity: mid_twist, ..Drift::default() };
    }

    /// Sets the spatial acceleration of a held base about O, rad/s² and m/s²: minus `ω × v` where its point at O keeps its
    /// velocity; it is 0 unless set.
    pub fn set_held_acceleration(&mut self, body: usize, acceleration: SpatialVector) {
        self.accelerations[self.slots[body] as usize] = acceleration;
    }

    /// Sets the motion of a body that others carry, whose own must have been set: `axis` is its twist for a unit
    /// velocity of its joint, `rate` that velocity, rad/s or m/s, and `mid_rate` the one of which velocity products are taken.
    /// The motion of a part is that of the whole.
    #[inline(always)]
    pub fn set_joint(&mut self, body: usize, axis: SpatialVector, rate: f64, mid_rate: f64) {
        let slot = self.slot(body);
        let (Attachment::Joint(parent) | Attachment::Fixed(parent)) = self.suspensions[slot].attachment
        else {
            return;
        };
        if self.bodies[slot].index != body {
            return;
        }
        self.suspensions[slot].axis = axis;
        self.velocities[slot] = self.velocities[parent].plus(&axis, rate);
        let own = SpatialVector { angular: axis.angular * mid_rate, linear: axis.linear * mid_rate };
        let Drift { velocity, acceleration } = &self.drifts[parent];
        let velocity = velocity.plus(&own, 1.0);
        let acceleration = acceleration.plus(&velocity.cross(&own), 1.0);
        self.drifts[slot] = Drift { velocity, acceleration };
    }

    /// Sets the rigid inertia of a body, whose motion must have been set, and the outer wrench on it (N·m, N). The bias
    /// force follows; what was added to the body before is gone. Those of a part are added to those of the whole, which must
    /// have been set.
    #[inline]
    pub fn set_inertia(&mut self, body: usize, inertia: SpatialInertia, wrench: &SpatialVector) {
        let index = body;
        let Drift { velocity, acceleration } = &self.drifts[self.slot(index)];
        let products = velocity.cross_force(&inertia.times(velocity));
        let bias = products.plus(&inertia.times(acceleration), 1.0).plus(wrench, -1.0);
        let body = self.body_mut(index);
        if body.index == index {
            body.own_bias = bias;
            body.own_inertia = inertia;
        } else {
            body.own_bias = body.own_bias.plus(&bias, 1.0);
            body.own_inertia.add(&inertia);
        }
    }

    /// Sets inertia and weight of a rigid body with all its parts, whose motion must have been set; what was added to it before
    /// is gone. `R`: the rotation from its frame to the world; `com`: its centre of mass, from O in the world (m); `gravity`:
    /// the acceleration of free fall in the world, m/s².
    #[inline(always)]
    pub fn set_rigid(
        &mut self,
        body: usize,
        rigid: &RigidBody,
        R: &Matrix3<f64>,
        com: &Vec3,
        gravity: &Vec3,
    ) {
        let (inertia, central) = SpatialInertia::of_rigid(rigid, R, com);
        let Drift { velocity: SpatialVector { angular, linear }, acceleration } =
            &self.drifts[self.slot(body)];
        // The force that the centre of mass takes, and the moment about it (Newton-Euler).
        let momentum = (linear + angular.cross(com)) * rigid.mass;
        let force = angular.cross(&momentum) + (acceleration.at(com) - gravity) * rigid.mass;
        let moment = angular.cross(&central.times(angular)) + central.times(&acceleration.angular);
        let body = self.body_mut(body);
        body.own_inertia = inertia;
        body.own_bias = SpatialVector { angular: moment + com.cross(&force), linear: force };
    }

    /// Adds an inertia, such as that of an implicit contact, to a body, and a wrench that acts on it (N·m, N).
    #[inline(always)]
    pub fn add(&mut self, body: usize, inertia: &SpatialInertia, wrench: &SpatialVector) {
        let bias = inertia.times(&self.drifts[self.slot(body)].acceleration).plus(wrench, -1.0);
        let body = self.body_mut(body);
        body.own_inertia.add(inertia);
        body.own_bias = body.own_bias.plus(&bias, 1.0);
    }

    /// Sets the effort of a body's joint (N·m or N), and its armature: the inertia (kg·m² or kg) that it has besides that
    /// of the bodies, of its rotor or of an implicit servo.
    #[inline(always)]
    pub fn set_effort(&mut self, body: usize, effort: f64, armature: f64) {
        let body = self.body_mut(body);
        body.effort = effort;
        body.armature = armature;
    }

    /// Returns the twist of a body about O, rad/s and m/s.
    #[inline]
    pub fn velocity(&self, body: usize) -> &SpatialVector {
        &self.velocities[self.slot(body)]
    }

    /// Returns the spatial acceleration of a body about O, rad/s² and m/s², as found last. The acceleration of the body's
    /// point at `p` is that of [`SpatialVector::at`] with `ω × v` of that point besides.
    #[inline]
    pub fn acceleration(&self, body: usize) -> SpatialVector {
        let slot = self.slot(body);
        self.accelerations[slot].plus(&self.drifts[slot].acceleration, 1.0)
    }

    /// Returns the acceleration of a body's joint, rad/s² or m/s², as found last; 0 without a joint.
    #[inline]
    pub fn joint_acceleration(&self, body: usize) -> f64 {
        self.joint_accelerations[self.slot(body)]
    }

    /// Returns the wrench about O that a body's joint or fixing exerts on it, N·m and N, as found last; for a base what
    /// holds it, which is zero if it floats. For a part it is that on the whole.
    pub fn transmitted(&self, body: usize) -> SpatialVector {
        let slot = self.slot(body);
        let body = &self.bodies[slot];
        body.articulated().times(&self.accelerations[slot]).plus(&body.bias, 1.0)
    }

    /// Finds the accelerations of all bodies, in time linear in their number (Featherstone 2008, table 7.1). `None` where
    /// a joint or a floating base has no inertia.
    #[must_use]
    #[inline(always)]
    pub fn accelerate(&mut self) -> Option<()> {
        for index in (0..self.bodies.len()).rev() {
            let (before, after) = self.bodies.split_at_mut(index);
            let (body, suspension) = (&mut after[0], &mut self.suspensions[index]);
            if !body.carries {
                body.bias = body.own_bias;
            }
            match suspension.attachment {
                Attachment::Joint(parent) => {
                    let (inertia, bias) = (body.articulated(), &body.bias);
                    let force = inertia.times(&suspension.axis);
                    let joint_inertia = suspension.axis.dot(&force) + body.armature;
                    if joint_inertia.is_nan() || joint_inertia <= 0.0 {
                        return None;
                    }
                    let effort = body.effort - suspension.axis.dot(bias);
                    let mobility = 1.0 / joint_inertia;
                    let left = inertia.less(&force, mobility);
                    let pushed = bias.plus(&force, effort * mobility);
                    before[parent].carry(&left, &pushed, body.begins);
                    (suspension.force, suspension.mobility, suspension.effort) = (force, mobility, effort);
                }
                Attachment::Fixed(parent) => {
                    before[parent].carry(body.articulated(), &body.bias, body.begins);
                }
                Attachment::Floating | Attachment::Held | Attachment::Part(_) => {}
            }
        }
        for (base, decomposed) in &mut self.bases {
            *decomposed = None;
            if self.suspensions[*base].attachment == Attachment::Floating {
                let body = &self.bodies[*base];
                let cholesky = body.articulated().matrix().cholesky()?;
                let solved = cholesky.solve(&-body.bias.vector());
                self.accelerations[*base] = SpatialVector::from_vector(&solved);
                *decomposed = Some(cholesky);
            }
        }
        for (index, suspension) in self.suspensions.iter().enumerate() {
            match suspension.attachment {
                Attachment::Joint(parent) => {
                    let carried = &self.accelerations[parent];
                    let relative = (suspension.effort - suspension.force.dot(carried)) * suspension.mobility;
                    self.joint_accelerations[index] = relative;
                    self.accelerations[index] = carried.plus(&suspension.axis, relative);
                }
                Attachment::Fixed(parent) => self.accelerations[index] = self.accelerations[parent],
                Attachment::Floating | Attachment::Held | Attachment::Part(_) => {}
            }
        }
        Some(())
    }

    /// Adds to the accelerations found last what wrenches on bodies (N·m and N about O, by the index of the body), and
    /// efforts of joints (N·m or N), change in them. `out` receives the changes of all bodies' accelerations and of
    /// their joints'; it is resized. The inertias are those of the last call of [`accelerate`](Self::accelerate).
    pub fn respond(&self, loads: &[Load], out: &mut Response) {
        out.bias.clear();
        out.bias.resize(self.bodies.len(), SpatialVector::default());
        out.efforts.clear();
        out.efforts.resize(self.bodies.len(), 0.0);
        out.bodies.resize(self.bodies.len(), SpatialVector::default());
        out.joints.resize(self.bodies.len(), 0.0);
        for load in loads {
            match *load {
                Load::Wrench(body, wrench) => {
                    let bias = &mut out.bias[self.slots[body] as usize];
                    *bias = bias.plus(&wrench, -1.0);
                }
                Load::Effort(body, effort) => out.efforts[self.slots[body] as usize] += effort,
            }
        }
        for (index, suspension) in self.suspensions.iter().enumerate().rev() {
            let bias = out.bias[index];
            match suspension.attachment {
                Attachment::Joint(parent) => {
                    let effort = out.efforts[index] - suspension.axis.dot(&bias);
                    out.efforts[index] = effort;
                    let pushed = bias.plus(&suspension.force, effort * suspension.mobility);
                    out.bias[parent] = out.bias[parent].plus(&pushed, 1.0);
                }
                Attachment::Fixed(parent) => out.bias[parent] = out.bias[parent].plus(&bias, 1.0),
                Attachment::Floating | Attachment::Held | Attachment::Part(_) => {}
            }
        }
        for (base, cholesky) in &self.bases {
            out.bodies[*base] = cholesky.as_ref().map_or(SpatialVector::default(), |cholesky| {
                SpatialVector::from_vector(&cholesky.solve(&-out.bias[*base].vector()))
            });
        }
        for (index, suspension) in self.suspensions.iter().enumerate() {
            match suspension.attachment {
                Attachment::Joint(parent) => {
                    let carried = out.bodies[parent];
                    let relative =
                        (out.efforts[index] - suspension.force.dot(&carried)) * suspension.mobility;
                    out.joints[index] = relative;
                    out.bodies[index] = carried.plus(&suspension.axis, relative);
                }
                Attachment::Fixed(parent) => out.bodies[index] = out.bodies[parent],
                Attachment::Floating | Attachment::Held | Attachment::Part(_) => {}
            }
        }
    }

    /// Returns the change of the spatial acceleration of a body about O that [`respond`](Self::respond) found, rad/s² and
    /// m/s².
    pub fn change<'r>(&self, response: &'r Response, body: usize) -> &'r SpatialVector {
        &response.bodies[self.slots[body] as usize]
    }

    /// Returns the change of the acceleration of a body's joint that [`respond`](Self::respond) found, rad/s² or m/s²; 0
    /// without a joint.
    pub fn joint_change(&self, response: &Response, body: usize) -> f64 {
        response.joints[self.slots[body] as usize]
    }

    /// Adds changes of accelerations, as [`respond`](Self::respond) finds them, to those found last.
    pub fn add_response(&mut self, response: &Response) {
        for (index, body) in self.bodies.iter_mut().enumerate() {
            self.accelerations[index] = self.accelerations[index].plus(&response.bodies[index], 1.0);
            self.joint_accelerations[index] += response.joints[index];
            // The bodies that a joint carries pass on the loads on them, too.
            body.bias = body.bias.plus(&response.bias[index], 1.0);
        }
    }
}

/// A load besides those of the last accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A wrench about O on the body of this index, N·m and N.
    Wrench(usize, SpatialVector),
    /// An effort of the joint of the body of this index, N·m or N.
    Effort(usize, f64),
}

/// The changes of accelerations under additional loads, with the memory that they are found in.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// The changes of the bodies' accelerations and of those of their joints, by slot.
    bodies: Vec<SpatialVector>,
    joints: Vec<f64>,
    bias: Vec<SpatialVector>,
    efforts: Vec<f64>,
}

/// A robot at an instant with the forces that act on it: the input of [`ForwardDynamics::accelerations`].
#[derive(Clone, Copy, Debug)]
pub struct ForcedState<'a> {
    /// The world poses of all links, by their numbers ([`Kinematics::link`]).
    pub poses: &'a [Pose],
    /// The velocity of the base's frame in the world.
    pub base: Twist,
    /// True if the base is held: it keeps its velocity, whatever force that takes.
    pub held: bool,
    /// The velocity of each joint by [`JointId`](super::JointId), rad/s or m/s. Those of mimics are not read.
    pub velocities: &'a [f64],
    /// The effort of each joint by [`JointId`](super::JointId), N·m or N. Those of mimics are not read.
    pub efforts: &'a [f64],
    /// The inertia that each joint has besides that of the links, by [`JointId`](super::JointId), kg·m² or kg: the
    /// armature of its motor, and what an implicit servo adds.
    pub armatures: &'a [f64],
    /// The outer wrench on each link, by its number, in the world; its moment is about the origin of the base's frame.
    pub wrenches: &'a [Wrench],
}

/// A robot compiled for forward dynamics, with the memory that it needs.
#[derive(Clone, Debug)]
pub struct ForwardDynamics {
    dynamics: Dynamics,
    kinematics: Kinematics,
    /// The links that are connected with the root as bodies, the root first, then in the order of the steps; `None` if a
    /// joint moves several steps: passes up and down do not suffice then.
    bodies: Option<ArticulatedBodies>,
}

impl ForwardDynamics {
    /// Returns the forward dynamics of a robot; `kinematics` must be that of the same robot.
    pub fn new(dynamics: Dynamics, kinematics: Kinematics) -> ForwardDynamics {
        let mut known = vec![false; kinematics.joint_count()];
        let own = |known: &mut Vec<bool>, terms: &[(usize, f64)]| match terms {
            [] => true,
            [(joint, _)] => !std::mem::replace(&mut known[*joint], true),
            _ => false,
        };
        let simple = kinematics.steps.iter().all(|step| own(&mut known, step.terms()));
        let mut body_of = vec![0; kinematics.link_count()];
        let mut attachments = vec![Attachment::Floating];
        for step in &kinematics.steps {
            body_of[step.link] = attachments.len();
            let parent = body_of[step.parent];
            let moves = !step.terms().is_empty();
            attachments.push(if moves { Attachment::Joint(parent) } else { Attachment::Part(parent) });
        }
        let bodies = simple.then(|| ArticulatedBodies::new(&attachments));
        ForwardDynamics { dynamics, kinematics, bodies }
    }

    /// Returns (acceleration of the base's frame, acceleration of each joint) of a robot under `gravity` (m/s² in the
    /// world, the vector of free fall): m/s² and rad/s² in the world, and rad/s² or m/s² by
    /// [`JointId`](super::JointId), 0 for mimics. The method is that of articulated bodies (Featherstone 2008, table
    /// 7.1), in time linear in the links; where joints move several steps, it is the mass matrix with its Cholesky
    /// decomposition. `None` where a joint or the base has no inertia. Panics if a slice of `state` is too short.
    pub fn accelerations(&mut self, state: &ForcedState, gravity: &Vec3) -> Option<(Twist, Vec<f64>)> {
        if self.bodies.is_some() {
            self.by_passes(state, gravity)
        } else {
            self.by_mass_matrix(state, gravity)
        }
    }

    fn by_passes(&mut self, state: &ForcedState, gravity: &Vec3) -> Option<(Twist, Vec<f64>)> {
        let bodies = self.bodies.as_mut()?;
        let root = self.kinematics.link(self.kinematics.root, 0);
        let origin = state.poses[root].translation.vector;
        let rigid = |link: usize| {
            let composite = self.dynamics.bodies()[link].composite(&state.poses[link], &origin);
            let outer = SpatialVector::from(state.wrenches[link]);
            let wrench = outer.plus(&SpatialVector::weight(&composite, gravity), 1.0);
            (SpatialInertia::from(composite), wrench)
        };
        let base = SpatialVector { angular: state.base.angular, linear: state.base.linear };
        bodies.set_base(0, base, base, state.held);
        let (inertia, wrench) = rigid(root);
        bodies.set_inertia(0, inertia, &wrench);
        for (index, step) in self.kinematics.steps.iter().enumerate() {
            let axis = step.joint_axis(state.poses);
            let axis = axis.map_or(SpatialVector::default(), |axis| SpatialVector::of_axis(&axis, &origin));
            let rate = step.position(state.velocities);
            bodies.set_joint(1 + index, axis, rate, rate);
            let (inertia, wrench) = rigid(step.link);
            bodies.set_inertia(1 + index, inertia, &wrench);
            if let [(joint, factor)] = step.terms() {
                // The armature is that of the joint, which the step's motion is a multiple of.
                let armature = state.armatures[*joint] / (factor * factor);
                bodies.set_effort(1 + index, state.efforts[*joint] / factor, armature);
            }
        }
        if state.held {
            // The origin keeps its velocity; the point of the body that is there does not accelerate.
            let turning = SpatialVector {
                angular: Vec3::zeros(),
                linear: -state.base.angular.cross(&state.base.linear),
            };
            bodies.set_held_acceleration(0, turning);
        }
        bodies.accelerate()?;
        let start = bodies.acceleration(0);
        let linear = start.linear + state.base.angular.cross(&state.base.linear);
        let mut accelerations = vec![0.0; self.kinematics.joint_count()];
        for (index, step) in self.kinematics.steps.iter().enumerate() {
            if let [(joint, factor)] = step.terms() {
                accelerations[*joint] = bodies.joint_acceleration(1 + index) / factor;
            }
        }
        Some((Twist { linear, angular: start.angular }, accelerations))
    }

    fn by_mass_matrix(&self, state: &ForcedState, gravity: &Vec3) -> Option<(Twist, Vec<f64>)> {
        let kinematics = &self.kinematics;
        let root = kinematics.link(kinematics.root, 0);
        let origin = state.poses[root].translation.vector;
        let n = kinematics.joint_count();
        let still = vec![0.0; n];
        let motion = MotionState {
            poses: state.poses,
            base: state.base,
            base_acceleration: Twist::default(),
            velocities: state.velocities,
            accelerations: &still,
        };
        let mut wrenches = self.dynamics.link_wrenches(kinematics, &motion, gravity, &origin);
        for (needed, outer) in wrenches.iter_mut().zip(state.wrenches) {
            needed.force -= outer.force;
            needed.moment -= outer.moment;
        }
        let needed = self.dynamics.efforts(kinematics, state.poses, &mut wrenches, &origin);
        let mut matrix = self.dynamics.mass_matrix(kinematics, state.poses);
        let mut right = DVector::zeros(6 + n);
        right.fixed_rows_mut::<3>(0).copy_from(&-wrenches[root].force);
        right.fixed_rows_mut::<3>(3).copy_from(&-wrenches[root].moment);
        for joint in 0..n {
            matrix[(6 + joint, 6 + joint)] += state.armatures[joint];
            right[6 + joint] = state.efforts[joint] - needed[joint];
        }
        let moves = |row: usize| if row < 6 { !state.held } else { matrix[(row, row)] > 0.0 };
        let rows: Vec<usize> = (0..6 + n).filter(|&row| moves(row)).collect();
        let solved =
            matrix.select_rows(&rows).select_columns(&rows).cholesky()?.solve(&right.select_rows(&rows));
        let mut found = DVector::zeros(6 + n);
        rows.iter().zip(solved.iter()).for_each(|(row, value)| found[*row] = *value);
        let base =
            Twist { linear: found.fixed_rows::<3>(0).into(), angular: found.fixed_rows::<3>(3).into() };
        Some((base, found.rows(6, n).iter().copied().collect()))
    }
}
