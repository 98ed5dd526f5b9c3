//! Forward dynamics of a robot as a tree of rigid bodies on a floating or held base: the accelerations that efforts and
//! outer forces give it, by articulated bodies (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, ch. 7).
//!
//! All spatial quantities are along the axes of the world and about one point, the origin O of the base's frame: a link's
//! articulated inertia is added to that of its parent as it is. A twist about O is the angular velocity, and the
//! velocity of the link's point that is at O.

use super::dynamics::{Composite, Dynamics, MotionState, Twist, Wrench};
use super::jacobian::JointAxis;
use super::kinematics::Kinematics;
use crate::geometry::{Pose, Vec3};
use nalgebra::{DVector, Matrix3, Matrix6, Vector6};

/// A robot at an instant with the forces that act on it: the input of [`ArticulatedBodies::accelerations`].
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
pub struct ArticulatedBodies {
    dynamics: Dynamics,
    kinematics: Kinematics,
    /// True if each joint moves one step: only then one pass up and one down suffice.
    simple: bool,
    /// The state of each link, by its number.
    links: Vec<LinkState>,
    /// The state of each step of the tree.
    steps: Vec<StepState>,
}

/// A link on the way through the passes.
#[derive(Clone, Copy, Debug, Default)]
struct LinkState {
    /// The twist of the link.
    velocity: Spatial,
    /// The articulated inertia.
    inertia: Inertia,
    /// The articulated bias force.
    bias: Spatial,
    /// The spatial acceleration, less that of free fall.
    acceleration: Spatial,
}

/// A step of the tree on the way through the passes.
#[derive(Clone, Copy, Debug, Default)]
struct StepState {
    /// The twist of the child for a unit velocity of the joint; zero for a fixed step.
    axis: Spatial,
    /// The velocity-product acceleration.
    product: Spatial,
    /// The articulated inertia times the axis, and the axis times that with the armature.
    force: Spatial,
    inertia: f64,
    /// The effort that is left to accelerate the joint, N·m or N.
    effort: f64,
}

/// A spatial vector about O: a twist (rad/s, m/s), an acceleration, or a wrench (N·m, N).
#[derive(Clone, Copy, Debug, Default)]
struct Spatial {
    angular: Vec3,
    linear: Vec3,
}

impl Spatial {
    fn dot(&self, other: &Spatial) -> f64 {
        self.angular.dot(&other.angular) + self.linear.dot(&other.linear)
    }

    fn plus(&self, other: &Spatial, factor: f64) -> Spatial {
        Spatial {
            angular: self.angular + other.angular * factor,
            linear: self.linear + other.linear * factor,
        }
    }

    /// Returns the cross product of this twist with another (Featherstone, eq. 2.31).
    fn cross(&self, other: &Spatial) -> Spatial {
        Spatial {
            angular: self.angular.cross(&other.angular),
            linear: self.linear.cross(&other.angular) + self.angular.cross(&other.linear),
        }
    }

    /// Returns the cross product of this twist with a wrench or momentum (Featherstone, eq. 2.32).
    fn cross_force(&self, force: &Spatial) -> Spatial {
        Spatial {
            angular: self.angular.cross(&force.angular) + self.linear.cross(&force.linear),
            linear: self.angular.cross(&force.linear),
        }
    }
}

/// A spatial inertia about O, symmetric: rows angular and linear, `[[angular, mixed], [mixedᵀ, linear]]`.
#[derive(Clone, Copy, Debug, Default)]
struct Inertia {
    angular: Matrix3<f64>,
    mixed: Matrix3<f64>,
    linear: Matrix3<f64>,
}

impl Inertia {
    /// Returns the inertia of bodies that move as one, whose moments are about O.
    fn of(composite: &Composite) -> Inertia {
        Inertia {
            angular: composite.inertia,
            mixed: composite.first.cross_matrix(),
            linear: Matrix3::from_diagonal_element(composite.mass),
        }
    }

    fn times(&self, v: &Spatial) -> Spatial {
        Spatial {
            angular: self.angular * v.angular + self.mixed * v.linear,
            linear: self.mixed.tr_mul(&v.angular) + self.linear * v.linear,
        }
    }

    fn add(&mut self, other: &Inertia) {
        self.angular += other.angular;
        self.mixed += other.mixed;
        self.linear += other.linear;
    }

    /// Returns the inertia less `u uᵀ / d`.
    fn less(&self, u: &Spatial, d: f64) -> Inertia {
        let (angular, linear) = (u.angular / d, u.linear / d);
        Inertia {
            angular: self.angular - angular * u.angular.transpose(),
            mixed: self.mixed - angular * u.linear.transpose(),
            linear: self.linear - linear * u.linear.transpose(),
        }
    }

    fn matrix(&self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.angular);
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.mixed);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&self.mixed.transpose());
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.linear);
        matrix
    }
}

impl ArticulatedBodies {
    /// Returns the forward dynamics of a robot; `kinematics` must be that of the same robot.
    pub fn new(dynamics: Dynamics, kinematics: Kinematics) -> ArticulatedBodies {
        let mut known = vec![false; kinematics.joint_count()];
        let own = |known: &mut Vec<bool>, terms: &[(usize, f64)]| match terms {
            [] => true,
            [(joint, _)] => !std::mem::replace(&mut known[*joint], true),
            _ => false,
        };
        let simple = kinematics.steps.iter().all(|step| own(&mut known, step.terms()));
        let links = vec![LinkState::default(); dynamics.bodies().len()];
        let steps = vec![StepState::default(); kinematics.steps.len()];
        ArticulatedBodies { dynamics, kinematics, simple, links, steps }
    }

    /// Returns (acceleration of the base's frame, acceleration of each joint) of a robot under `gravity` (m/s² in the
    /// world, the vector of free fall): m/s² and rad/s² in the world, and rad/s² or m/s² by
    /// [`JointId`](super::JointId), 0 for mimics. The method is that of articulated bodies (Featherstone 2008, table
    /// 7.1), in time linear in the links; where joints move several steps, it is the mass matrix with its Cholesky
    /// decomposition. `None` where a joint or the base has no inertia. Panics if a slice of `state` is too short.
    pub fn accelerations(&mut self, state: &ForcedState, gravity: &Vec3) -> Option<(Twist, Vec<f64>)> {
        if self.simple { self.by_passes(state, gravity) } else { self.by_mass_matrix(state, gravity) }
    }

    fn by_passes(&mut self, state: &ForcedState, gravity: &Vec3) -> Option<(Twist, Vec<f64>)> {
        let root = self.kinematics.link(self.kinematics.root, 0);
        let origin = state.poses[root].translation.vector;
        self.velocities(state, root, &origin);
        self.inertias(state)?;
        // Free fall is an acceleration of the frame: bodies need no weight.
        let turning = state.base.angular.cross(&state.base.linear);
        let base = &self.links[root];
        let start = if state.held {
            Spatial { angular: Vec3::zeros(), linear: -gravity - turning }
        } else {
            let right = Vector6::from_iterator(base.bias.angular.iter().chain(&base.bias.linear).map(|x| -x));
            let solved = base.inertia.matrix().cholesky()?.solve(&right);
            Spatial { angular: solved.fixed_rows::<3>(0).into(), linear: solved.fixed_rows::<3>(3).into() }
        };
        self.links[root].acceleration = start;
        let mut accelerations = vec![0.0; self.kinematics.joint_count()];
        for (step, at) in self.kinematics.steps.iter().zip(&self.steps) {
            let mut acceleration = self.links[step.parent].acceleration.plus(&at.product, 1.0);
            if let [(joint, factor)] = step.terms() {
                let relative = (at.effort - at.force.dot(&acceleration)) / at.inertia;
                acceleration = acceleration.plus(&at.axis, relative);
                accelerations[*joint] = relative / factor;
            }
            self.links[step.link].acceleration = acceleration;
        }
        let linear = start.linear + gravity + turning;
        Some((Twist { linear, angular: start.angular }, accelerations))
    }

    /// Finds the twists, rigid inertias and bias forces of all links, from the root on.
    fn velocities(&mut self, state: &ForcedState, root: usize, origin: &Vec3) {
        let base = Spatial { angular: state.base.angular, linear: state.base.linear };
        self.links[root] = self.link(state, root, base, origin);
        for index in 0..self.kinematics.steps.len() {
            let step = &self.kinematics.steps[index];
            let axis = match step.joint_axis(state.poses) {
                None => Spatial::default(),
                Some(JointAxis::Prismatic { axis }) => Spatial { angular: Vec3::zeros(), linear: axis },
                Some(JointAxis::Revolute { axis, point }) => {
                    Spatial { angular: axis, linear: (point - origin).cross(&axis) }
                }
            };
            let rate: f64 =
                step.terms().iter().map(|&(joint, factor)| factor * state.velocities[joint]).sum();
            let velocity = self.links[step.parent].velocity.plus(&axis, rate);
            let own = Spatial::default().plus(&axis, rate);
            self.steps[index] = StepState { axis, product: velocity.cross(&own), ..StepState::default() };
            self.links[step.link] = self.link(state, step.link, velocity, origin);
        }
    }

    fn link(&self, state: &ForcedState, link: usize, velocity: Spatial, origin: &Vec3) -> LinkState {
        let inertia = Inertia::of(&self.dynamics.composite(link, &state.poses[link], origin));
        let Wrench { force, moment } = state.wrenches[link];
        let outer = Spatial { angular: moment, linear: force };
        let bias = velocity.cross_force(&inertia.times(&velocity)).plus(&outer, -1.0);
        LinkState { velocity, inertia, bias, acceleration: Spatial::default() }
    }

    /// Finds the articulated inertias and bias forces, from the leaves to the root; `None` where a joint has no inertia.
    fn inertias(&mut self, state: &ForcedState) -> Option<()> {
        for (step, at) in self.kinematics.steps.iter().zip(&mut self.steps).rev() {
            let LinkState { inertia, bias, .. } = self.links[step.link];
            let (inertia, bias) = match step.terms() {
                [(joint, factor)] => {
                    // The armature is that of the joint, which the step's motion is a multiple of.
                    let armature = state.armatures[*joint] / (factor * factor);
                    at.force = inertia.times(&at.axis);
                    at.inertia = at.axis.dot(&at.force) + armature;
                    at.effort = state.efforts[*joint] / factor - at.axis.dot(&bias);
                    if at.inertia.is_nan() || at.inertia <= 0.0 {
                        return None;
                    }
                    let left = inertia.less(&at.force, at.inertia);
                    let moved = bias.plus(&left.times(&at.product), 1.0);
                    (left, moved.plus(&at.force, at.effort / at.inertia))
                }
                _ => (inertia, bias),
            };
            let parent = &mut self.links[step.parent];
            parent.inertia.add(&inertia);
            parent.bias = parent.bias.plus(&bias, 1.0);
        }
        Some(())
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
