//! Dynamics of a robot as a tree of rigid bodies on a floating base: inverse dynamics by recursive Newton-Euler (Luh,
//! Walker and Paul 1980; Featherstone, *Rigid Body Dynamics Algorithms*, 2008, ch. 5) and the mass matrix by composite
//! rigid bodies (Walker and Orin 1982; Featherstone, ch. 6).
//!
//! Everything is in the axes of the world, or of whatever frame the poses of the links are given in; moments and
//! angular momenta are about a stated point, in [`InverseDynamics`] and the mass matrix about the origin O of the
//! base's frame. Bonds that close loops are not regarded: the wrenches that they carry are loads like any other.

use super::assembly::Assembly;
use super::jacobian::JointAxis;
use super::kinematics::Kinematics;
use crate::geometry::{Pose, Vec3};
use nalgebra::{DMatrix, Matrix3};

/// Threshold: the part of the sum of the moments of inertia up to which a product of inertia is zero.
const TOL_PRODUCT: f64 = 1e-14;

/// The mass of a link and its distribution, in the link's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    /// The mass of the body, kg.
    pub mass: f64,
    /// The centre of mass in the link's frame, m.
    pub com: Vec3,
    /// The 3 × 3 inertia about the centre of mass along the axes of the link's frame, kg·m².
    pub inertia: Matrix3<f64>,
}

impl RigidBody {
    /// Returns the body that parts make which hang together, each with the pose of its frame in that of the whole (m).
    pub fn of_parts(parts: &[(RigidBody, Pose)]) -> RigidBody {
        let mass: f64 = parts.iter().map(|(part, _)| part.mass).sum();
        let first: Vec3 =
            parts.iter().map(|(part, pose)| pose.transform_point(&part.com.into()).coords * part.mass).sum();
        let com = if mass > 0.0 { first / mass } else { Vec3::zeros() };
        let inertia: Matrix3<f64> = parts.iter().map(|(part, pose)| part.composite(pose, &com).inertia).sum();
        // Products that are the rounding of zero are zero: bodies with the axes of their frames take less.
        let zero = TOL_PRODUCT * inertia.trace();
        let inertia = inertia.map_with_location(|i, j, x| if i != j && x.abs() <= zero { 0.0 } else { x });
        RigidBody { mass, com, inertia }
    }

    /// Returns the body as a composite about the point `origin` (m, in the world), with its link at the world pose
    /// `pose`.
    pub fn composite(&self, pose: &Pose, origin: &Vec3) -> Composite {
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let d = pose.translation.vector + R * self.com - origin;
        let shifted = (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * self.mass;
        Composite {
            mass: self.mass,
            first: d * self.mass,
            inertia: R * self.inertia * R.transpose() + shifted,
        }
    }
}

/// The velocity of a frame, linear at its origin and angular, or the time derivative of both; along the axes of the
/// world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// The linear velocity of the frame's origin in the world, m/s; as a derivative its acceleration, m/s².
    pub linear: Vec3,
    /// The angular velocity of the frame in the world, rad/s; as a derivative the angular acceleration, rad/s².
    pub angular: Vec3,
}

impl Twist {
    /// Returns the velocity in the world (m/s) of the point that the frame carries along at `p` (m, in the axes of the
    /// world) from its origin.
    pub fn at(&self, p: &Vec3) -> Vec3 {
        self.linear + self.angular.cross(p)
    }
}

/// A force with its moment about a stated point, or a momentum with its angular momentum; along the axes of the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// The force in the world, N; as a momentum, N·s.
    pub force: Vec3,
    /// The moment about the stated point, in the world, N·m; as an angular momentum, N·m·s.
    pub moment: Vec3,
}

/// The motion of a robot at an instant: poses, velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub struct MotionState<'a> {
    /// The world poses of all links, by their numbers ([`Kinematics::link`]).
    pub poses: &'a [Pose],
    /// The velocity of the base's frame in the world.
    pub base: Twist,
    /// The acceleration of the base's frame in the world.
    pub base_acceleration: Twist,
    /// The velocity of each joint by [`JointId`](super::JointId), rad/s or m/s. Those of mimics are not read.
    pub velocities: &'a [f64],
    /// The acceleration of each joint by [`JointId`](super::JointId), rad/s² or m/s². Those of mimics are not read.
    pub accelerations: &'a [f64],
}

/// The forces that a motion needs: the result of inverse dynamics.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseDynamics {
    /// The wrench that the surroundings must exert on the robot, in the world; the moment is about the origin of the
    /// base's frame.
    pub base: Wrench,
    /// The torque or force of each joint by [`JointId`](super::JointId), N·m or N; 0 for mimics, whose share is in
    /// the joints that they follow.
    pub efforts: Vec<f64>,
}

/// A step of the kinematics at an instant: its axis, and the motion of its child against its parent.
#[derive(Clone, Copy, Debug)]
struct MovingStep {
    /// The axis of the motion, in the world; `None` for a fixed step.
    axis: Option<JointAxis>,
    /// The velocity along or about the axis, rad/s or m/s.
    velocity: f64,
    /// The acceleration along or about the axis, rad/s² or m/s².
    acceleration: f64,
}

/// A robot compiled for dynamics: the rigid bodies of its links.
#[derive(Clone, Debug)]
pub struct Dynamics {
    bodies: Vec<RigidBody>,
}

impl Dynamics {
    /// Returns the dynamics of a robot, whose links are numbered as in its [`Kinematics`]. Panics if a module names a
    /// type that is not in the library.
    pub fn new(robot: &Assembly) -> Dynamics {
        let mut bodies = Vec::new();
        for module in 0..robot.modules.len() {
            bodies.extend(robot.module_type(module).links.iter().map(|link| {
                let [xx, yy, zz, xy, xz, yz] = link.inertia;
                let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                RigidBody { mass: link.mass, com: link.com, inertia }
            }));
        }
        Dynamics { bodies }
    }

    /// Returns the rigid body of each link, by its number ([`Kinematics::link`]).
    pub fn bodies(&self) -> &[RigidBody] {
        &self.bodies
    }

    /// Returns the forces that a motion needs under `gravity` (m/s² in the world, the vector of free fall) where
    /// nothing else acts, by recursive Newton-Euler (Luh, Walker and Paul 1980). `kinematics` must be that of the
    /// same robot. Panics if a slice of `state` is shorter than the robot's links or joints.
    pub fn inverse(&self, kinematics: &Kinematics, state: &MotionState, gravity: &Vec3) -> InverseDynamics {
        let root = kinematics.link(kinematics.root, 0);
        let origin = position(state.poses, root);
        let mut wrenches = self.link_wrenches(kinematics, state, gravity, &origin);
        let efforts = self.efforts(kinematics, state.poses, &mut wrenches, &origin);
        InverseDynamics { base: wrenches[root], efforts }
    }

    /// Returns the wrench that each link needs for its own motion under `gravity` (m/s² in the world, the vector of
    /// free fall), about the point `origin` (m, in the world), by the numbers of the links: the forward pass of
    /// recursive Newton-Euler (Luh, Walker and Paul 1980). Zero for links that are not connected with the root.
    /// `kinematics`: the kinematics of the same robot. Panics if a slice of `state` is too short.
    pub fn link_wrenches(
        &self,
        kinematics: &Kinematics,
        state: &MotionState,
        gravity: &Vec3,
        origin: &Vec3,
    ) -> Vec<Wrench> {
        let root = kinematics.link(kinematics.root, 0);
        let mut motion = vec![(Twist::default(), Twist::default()); self.bodies.len()];
        motion[root] = (state.base, state.base_acceleration);
        let mut wrenches = vec![Wrench::default(); self.bodies.len()];
        wrenches[root] = self.needed(root, &state.poses[root], &motion[root], gravity, origin);
        for step in &kinematics.steps {
            let sum = |of: &[f64]| step.terms().iter().map(|&(joint, factor)| factor * of[joint]).sum();
            let moving = MovingStep {
                axis: step.joint_axis(state.poses),
                velocity: sum(state.velocities),
                acceleration: sum(state.accelerations),
            };
            let (p_A, p_B) = (position(state.poses, step.parent), position(state.poses, step.link));
            motion[step.link] = carried(&motion[step.parent], &moving, &p_A, &p_B);
            let pose = &state.poses[step.link];
            wrenches[step.link] = self.needed(step.link, pose, &motion[step.link], gravity, origin);
        }
        wrenches
    }

    /// Returns the effort of each joint by [`JointId`](super::JointId), N·m or N, that carries a wrench on each link,
    /// about the point `origin` (m, in the world): the backward pass of recursive Newton-Euler (Luh, Walker and Paul
    /// 1980). On return `wrenches` holds for each link the sum over all that it carries. `poses` are the world poses
    /// of all links, by their numbers. `kinematics`: the kinematics of the same robot. Panics if a slice is too
    /// short.
    pub fn efforts(
        &self,
        kinematics: &Kinematics,
        poses: &[Pose],
        wrenches: &mut [Wrench],
        origin: &Vec3,
    ) -> Vec<f64> {
        let mut efforts = vec![0.0; kinematics.joint_count()];
        for step in kinematics.steps.iter().rev() {
            let wrench = wrenches[step.link];
            if let Some(axis) = step.joint_axis(poses) {
                let effort = along(&axis, &wrench, origin);
                step.terms().iter().for_each(|&(joint, factor)| efforts[joint] += factor * effort);
            }
            let parent = &mut wrenches[step.parent];
            parent.force += wrench.force;
            parent.moment += wrench.moment;
        }
        efforts
    }

    /// Returns the momentum of the robot (N·s) and its angular momentum about the point `origin` (N·m·s), as force
    /// and moment in the world, with the velocity `base` of the base's frame and the velocities of the joints by
    /// [`JointId`](super::JointId) (rad/s or m/s). `poses` are the world poses of all links, by their numbers;
    /// `origin` is in the world, m. `kinematics`: the kinematics of the same robot. Panics if a slice is too short.
    pub fn momentum(
        &self,
        kinematics: &Kinematics,
        poses: &[Pose],
        base: &Twist,
        velocities: &[f64],
        origin: &Vec3,
    ) -> Wrench {
        let motion = twists(kinematics, poses, base, velocities);
        let links = kinematics.steps.iter().map(|step| step.link);
        let root = kinematics.link(kinematics.root, 0);
        self.momentum_of_links(std::iter::once(root).chain(links), (poses, &motion), origin)
    }

    /// Returns the momentum (N·s) of some links, given by their numbers, and its angular momentum about the point `origin`
    /// (N·m·s), as [`momentum`](Self::momentum) does of all. `poses` and `motion`: the world poses and twists of all links.
    /// Panics for a link that has none.
    pub fn momentum_of_links(
        &self,
        links: impl Iterator<Item = usize>,
        (poses, motion): (&[Pose], &[Twist]),
        origin: &Vec3,
    ) -> Wrench {
        let own = |link: usize| self.momentum_of(link, &poses[link], &motion[link], origin);
        links.fold(Wrench::default(), |sum, link| {
            let own = own(link);
            Wrench { force: sum.force + own.force, moment: sum.moment + own.moment }
        })
    }

    /// Returns the momentum (N·s) of one body with the twist `v` of its link's frame, and its angular momentum about
    /// `origin` (N·m·s).
    fn momentum_of(&self, link: usize, pose: &Pose, v: &Twist, origin: &Vec3) -> Wrench {
        let body = &self.bodies[link];
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let r = R * body.com;
        let force = (v.linear + v.angular.cross(&r)) * body.mass;
        let spin = R * body.inertia * R.transpose() * v.angular;
        Wrench { force, moment: spin + (pose.translation.vector + r - origin).cross(&force) }
    }

    /// Returns the wrench about `origin` (N, N·m) that one body needs under gravity for the velocity and acceleration
    /// of its link's frame: the equations of Newton and Euler.
    fn needed(
        &self,
        link: usize,
        pose: &Pose,
        (v, a): &(Twist, Twist),
        gravity: &Vec3,
        origin: &Vec3,
    ) -> Wrench {
        let body = &self.bodies[link];
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let r = R * body.com;
        let inertia = R * body.inertia * R.transpose();
        let acceleration = a.linear + a.angular.cross(&r) + v.angular.cross(&v.angular.cross(&r));
        let force = (acceleration - gravity) * body.mass;
        let spin = inertia * a.angular + v.angular.cross(&(inertia * v.angular));
        Wrench { force, moment: spin + (pose.translation.vector + r - origin).cross(&force) }
    }

    /// Returns the symmetric mass matrix M (6 + n square, n joints), by the composite-rigid-body method (Walker and
    /// Orin 1982): the kinetic energy is `½ uᵀ M u` (J) with u the linear velocity of the base's origin (m/s, rows 0
    /// to 2), its angular velocity (rad/s, rows 3 to 5), both in the world, and the velocities of the joints by
    /// [`JointId`](super::JointId). Rows of mimics and fixed joints are zero. `poses` are the world poses of all
    /// links, by their numbers. `kinematics`: the kinematics of the same robot. Panics if `poses` is too short.
    pub fn mass_matrix(&self, kinematics: &Kinematics, poses: &[Pose]) -> DMatrix<f64> {
        let root = kinematics.link(kinematics.root, 0);
        let origin = position(poses, root);
        let mut composites = vec![Composite::default(); self.bodies.len()];
        composites[root] = self.bodies[root].composite(&poses[root], &origin);
        for step in &kinematics.steps {
            composites[step.link] = self.bodies[step.link].composite(&poses[step.link], &origin);
        }
        for step in kinematics.steps.iter().rev() {
            let carried = composites[step.link];
            composites[step.parent].add(&carried);
        }
        let n = 6 + kinematics.joint_count();
        let mut matrix = DMatrix::zeros(n, n);
        matrix.fixed_view_mut::<6, 6>(0, 0).copy_from(&composites[root].matrix());
        for step in &kinematics.steps {
            let Some(axis) = step.joint_axis(poses) else { continue };
            let (linear, angular) = axis.velocity(&origin);
            let momentum = composites[step.link].momentum(&linear, &angular);
            for above in kinematics.ancestors(step.link) {
                let Some(axis) = above.joint_axis(poses) else { continue };
                let value = along(&axis, &momentum, &origin);
                for &(i, f) in above.terms() {
                    for &(j, g) in step.terms() {
                        matrix[(6 + i, 6 + j)] += f * g * value;
                        if above.link != step.link {
                            matrix[(6 + j, 6 + i)] += f * g * value;
                        }
                    }
                }
            }
            for &(joint, factor) in step.terms() {
                for axis in 0..3 {
                    for (row, value) in [(axis, momentum.force[axis]), (3 + axis, momentum.moment[axis])] {
                        matrix[(row, 6 + joint)] += factor * value;
                        matrix[(6 + joint, row)] += factor * value;
                    }
                }
            }
        }
        matrix
    }
}

/// Returns the twist of each link's frame, by its number, with the velocity `base` of the base's frame and the velocities of
/// the joints by [`JointId`](super::JointId) (rad/s or m/s); zero for links that are not connected with the base. `poses` are
/// the world poses of all links. Panics if a slice is too short.
pub fn twists(kinematics: &Kinematics, poses: &[Pose], base: &Twist, velocities: &[f64]) -> Vec<Twist> {
    let mut motion = vec![Twist::default(); poses.len()];
    motion[kinematics.link(kinematics.root, 0)] = *base;
    for step in &kinematics.steps {
        let moving = MovingStep {
            axis: step.joint_axis(poses),
            velocity: step.terms().iter().map(|&(joint, factor)| factor * velocities[joint]).sum(),
            acceleration: 0.0,
        };
        let (p_A, p_B) = (position(poses, step.parent), position(poses, step.link));
        motion[step.link] = carried(&(motion[step.parent], Twist::default()), &moving, &p_A, &p_B).0;
    }
    motion
}

/// A composite rigid body: bodies that move as one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Composite {
    /// The mass, kg.
    pub mass: f64,
    /// The first moment of mass about a stated point, such as the origin of the base's frame, in the world, kg·m.
    pub first: Vec3,
    /// The inertia about that point, in the world, kg·m².
    pub inertia: Matrix3<f64>,
}

impl Composite {
    /// Adds the bodies of another composite.
    fn add(&mut self, other: &Composite) {
        self.mass += other.mass;
        self.first += other.first;
        self.inertia += other.inertia;
    }

    /// Returns the momentum (N·s) and the angular momentum about the origin (N·m·s) with the velocity `linear` of the
    /// origin (m/s) and the angular velocity `angular` (rad/s).
    fn momentum(&self, linear: &Vec3, angular: &Vec3) -> Wrench {
        Wrench {
            force: linear * self.mass + angular.cross(&self.first),
            moment: self.first.cross(linear) + self.inertia * angular,
        }
    }

    /// Returns the spatial inertia, which maps `[linear; angular]` velocity to `[momentum; angular momentum]`, both at
    /// the origin.
    fn matrix(&self) -> nalgebra::Matrix6<f64> {
        let mut matrix = nalgebra::Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.mass);
        let cross = self.first.cross_matrix();
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&-cross);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&cross);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.inertia);
        matrix
    }
}

/// Returns the position of the origin of a link's frame in the world, m.
fn position(poses: &[Pose], link: usize) -> Vec3 {
    poses[link].translation.vector
}

/// Returns the component of a wrench about `origin` (m), all in the world, that does work along a joint: the moment
/// (N·m) about the axis of a revolute joint, the force (N) along that of a prismatic one; for a momentum likewise.
pub fn along(axis: &JointAxis, wrench: &Wrench, origin: &Vec3) -> f64 {
    match axis {
        JointAxis::Revolute { axis, point } => {
            axis.dot(&(wrench.moment - (point - origin).cross(&wrench.force)))
        }
        JointAxis::Prismatic { axis } => axis.dot(&wrench.force),
    }
}

/// Returns velocity and acceleration of a link's frame with its origin at `p_B` (m) from those of its parent's with its
/// origin at `p_A` (m), with the Coriolis and centripetal terms of the joint's motion.
fn carried((v_A, a_A): &(Twist, Twist), step: &MovingStep, p_A: &Vec3, p_B: &Vec3) -> (Twist, Twist) {
    // The frame that moves with the parent through the child's origin.
    let through = |p: &Vec3| {
        let r = p - p_A;
        let v = v_A.linear + v_A.angular.cross(&r);
        let a = a_A.linear + a_A.angular.cross(&r) + v_A.angular.cross(&v_A.angular.cross(&r));
        (v, a)
    };
    match step.axis {
        None => {
            let (v, a) = through(p_B);
            (Twist { linear: v, angular: v_A.angular }, Twist { linear: a, angular: a_A.angular })
        }
        Some(JointAxis::Prismatic { axis }) => {
            let (v, a) = through(p_B);
            let slide = axis * step.velocity;
            let acceleration = axis * step.acceleration + v_A.angular.cross(&slide) * 2.0;
            (
                Twist { linear: v + slide, angular: v_A.angular },
                Twist { linear: a + acceleration, angular: a_A.angular },
            )
        }
        Some(JointAxis::Revolute { axis, point }) => {
            let (v, a) = through(&point);
            let spin = axis * step.velocity;
            let angular = v_A.angular + spin;
            let angular_acceleration = a_A.angular + axis * step.acceleration + v_A.angular.cross(&spin);
            let d = p_B - point;
            let v = v + angular.cross(&d);
            let a = a + angular_acceleration.cross(&d) + angular.cross(&angular.cross(&d));
            (Twist { linear: v, angular }, Twist { linear: a, angular: angular_acceleration })
        }
    }
}
