//! The robot of a plan as trees of rigid bodies with servos, for a simulation.

use super::parameters::PARAMETERS;
use super::settings::{ServoGains, Settings};
use crate::geometry::broad_phase::Aabb;
use crate::geometry::ground_features::{self, Feature};
use crate::geometry::{Mat3, Pose, Vec3};
use crate::optimize::random::SplitMix64;
use crate::plan::{Ground, LastingTrees, Tracks, World};
use crate::robot::articulated_bodies::Attachment;
use crate::robot::dynamics::{Dynamics, RigidBody};
use crate::robot::{
    self, Assembly, Bond, ClusterPose, JointKind, JointOwner, Kinematics, Link, PortRef, Servo, Step,
    motor_efforts,
};
use std::collections::BTreeSet;

/// A link with what carries it.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// The way in which the body hangs on others, by their indices in [`Model::bodies`].
    pub attachment: Attachment,
    /// The index of the body that it is a part of, or its own.
    pub whole: usize,
    /// The step from the body that carries it; `None` for a base.
    pub step: Option<Step>,
    /// Mass, centre of mass and inertia, with those of all its parts; those of a part are its own.
    pub rigid: RigidBody,
    /// The joint that moves the body.
    pub joint: Option<Joint>,
    /// The surface, as contacts feel it.
    pub surface: Surface,
    /// The box along the axes of the link's frame that holds all its ground features, m.
    pub bounds: Aabb,
    /// The parts of its surface that can touch the ground, in the frame of the link.
    pub features: Vec<Feature>,
}

/// A joint as a coordinate of its own, which is the position of the step that it moves.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// The number in its [`crate::robot::JointId`].
    pub id: usize,
    /// The factor from the joint's position to the coordinate: 1 or -1.
    pub factor: f64,
    /// True if it slides, false if it turns.
    pub slides: bool,
    /// The servo that drives it; `None` for a passive joint, and for one that follows others.
    pub servo: Option<DrivenServo>,
    /// The inertia of its rotor, kg·m² or kg; 0 without a servo.
    pub armature: f64,
    /// The damping of its bearing, N·m·s/rad or N·s/m; 0 with a servo, whose own counts.
    pub damping: f64,
    /// True if motors with limits drive it together with others.
    pub is_coupled: bool,
    /// The least and greatest coordinate, rad or m; `None` without ends, and for one that follows others.
    pub range: Option<(f64, f64)>,
}

/// A position servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrivenServo {
    /// Stiffness, N·m/rad or N/m.
    pub stiffness: f64,
    /// The coordinate at which it is where zero is commanded, rad or m.
    pub zero: f64,
    /// Damping, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// The effort that it is held to, N·m or N; infinite where none is stated, or motors have no limits.
    pub effort: f64,
    /// The greatest effort that is stated, N·m or N.
    pub limit: Option<f64>,
    /// The speed at which no effort is left, rad/s or m/s; infinite where none is stated, or motors have no limits.
    pub no_load_speed: f64,
}

impl DrivenServo {
    /// Returns what the motor supplies in place of an effort (N·m or N) that is more than it can at a rate (rad/s or m/s): an
    /// effort at rest, and how much less it is for each unit of the rate; `None` where it can. The effort that drives a motion
    /// is the less the faster that is, down to nothing at the speed without load.
    pub(crate) fn limit_at(&self, effort: f64, rate: f64) -> Option<(f64, f64)> {
        let (most, sign) = (self.effort, effort.signum());
        let driving = rate * sign;
        let limit = if driving <= 0.0 || self.no_load_speed.is_infinite() {
            (sign * most, 0.0)
        } else if driving < self.no_load_speed {
            (sign * most, most / self.no_load_speed)
        } else {
            (0.0, 0.0)
        };
        (effort.abs() > (limit.0 - limit.1 * rate).abs()).then_some(limit)
    }
}

/// A surface as contacts feel it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surface {
    /// The coefficient of friction while it slides.
    pub friction: f64,
    /// The coefficient of friction up to which it sticks.
    pub static_friction: f64,
    /// The stiffness of a contact, N/m.
    pub stiffness: f64,
    /// The damping of a contact of unit stiffness, s.
    pub damping: f64,
}

impl Surface {
    /// Returns that of a link with a factor on friction.
    fn new(link: &Link, factor: f64) -> Surface {
        let facts = &link.surface;
        Surface {
            friction: link.friction * factor,
            static_friction: facts.static_friction.map_or(link.friction, |f| f.max(link.friction)) * factor,
            stiffness: facts.stiffness.unwrap_or(robot::Surface::STIFFNESS_DEFAULT),
            damping: PARAMETERS.contact_damping,
        }
    }

    /// Returns that of a contact of two: friction is that of the rougher one, and the softer one yields.
    pub(crate) fn against(&self, other: &Surface) -> Surface {
        Surface {
            friction: self.friction.max(other.friction),
            static_friction: self.static_friction.max(other.static_friction),
            stiffness: self.stiffness.min(other.stiffness),
            damping: self.damping.min(other.damping),
        }
    }
}

/// A joint that follows others.
#[derive(Clone, Debug)]
pub(crate) struct Follower {
    /// The index of the body that it moves.
    pub body: usize,
    /// The bodies whose coordinates it follows, each with its factor.
    pub terms: Vec<(usize, f64)>,
}

/// Motors that drive several joints of a module together.
#[derive(Clone, Debug)]
pub(crate) struct Coupled {
    /// The bodies that the joints move, each with the sign of its coordinate.
    pub bodies: Vec<(usize, f64)>,
    /// The motors.
    pub motors: Vec<CoupledMotor>,
}

/// A motor that drives several joints.
#[derive(Clone, Debug)]
pub(crate) struct CoupledMotor {
    /// The greatest effort, N·m or N; infinite where none is stated.
    pub effort: f64,
    /// The factor of each joint in the motor's position, which is that of the motor's effort in the joint's.
    pub factors: Vec<f64>,
    /// The factor of each joint's effort in the motor's.
    pub shares: Vec<f64>,
}

/// A bond of a tree that states what it holds.
#[derive(Clone, Debug)]
pub(crate) struct CarryingBond {
    /// The index of the bond in the assembly.
    pub bond: usize,
    /// The body that the bond carries.
    pub carried: usize,
    /// The body of the bond's first port, and the port's pose in the frame of its link.
    pub port: (usize, Pose),
}

/// The robot of a plan for a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// The links, those that carry before those that are carried.
    pub bodies: Vec<Body>,
    /// The index in `bodies` of each link, by its number.
    body_of: Vec<usize>,
    /// The index of the module of each body; `usize::MAX` of what stands fast.
    pub module_of: Vec<usize>,
    /// The index of the body that stands fast and carries obstacles, the last; `None` without obstacles.
    pub fixture: Option<usize>,
    /// The kinematics of the whole robot, which numbers links and joints.
    kinematics: Kinematics,
    /// The index in `bodies` of the body that each joint moves, by the number of its id; `None` for those that move none.
    pub moved_by: Vec<Option<usize>>,
    /// The joints that follow others.
    pub followers: Vec<Follower>,
    /// The motors that drive several joints.
    pub coupled: Vec<Coupled>,
    /// The bonds that hold at some time and are in no tree.
    pub constraints: Vec<usize>,
    /// The pairs of modules that bonds of the trees hold together, the lesser index first.
    pub bonded: BTreeSet<(usize, usize)>,
    /// The bonds of the trees that state what they hold.
    pub carrying: Vec<CarryingBond>,
    /// The pose of each body at the start, by its index in `bodies`.
    pub start: Vec<Pose>,
    /// The mass of all bodies, kg.
    pub mass: f64,
}

impl Model {
    /// Compiles the robots of a plan that start at these poses, those of the base and of the references of further clusters, in
    /// a world, with servos of these gains. `apart`:
    /// the bonds that are not in the trees although they hold all the time.
    pub(crate) fn new(
        tracks: &Tracks,
        (X_WB, clusters): (&Pose, &[ClusterPose]),
        world: &World,
        settings: &Settings,
        apart: &[usize],
    ) -> Model {
        let (robot, gains) = (&tracks.robot, &settings.servo);
        let lasting = LastingTrees::new(tracks, X_WB, clusters, apart);
        let held = matches!(world.ground, Ground::Fixed | Ground::Held);
        let rigid = Dynamics::new(robot);
        let owners: Vec<JointOwner> = robot.joints().collect();
        let links: Vec<(usize, usize)> = (0..robot.modules.len())
            .flat_map(|module| (0..robot.module_type(module).links.len()).map(move |link| (module, link)))
            .collect();
        let mut model = Model {
            bodies: Vec::with_capacity(links.len()),
            body_of: vec![usize::MAX; links.len()],
            moved_by: vec![None; owners.len()],
            followers: Vec::new(),
            coupled: Vec::new(),
            constraints: lasting.constraints,
            module_of: Vec::with_capacity(links.len()),
            fixture: None,
            kinematics: lasting.start,
            bonded: BTreeSet::new(),
            carrying: Vec::new(),
            start: Vec::with_capacity(links.len()),
            mass: 0.0,
        };
        for (index, tree) in lasting.trees.iter().enumerate() {
            let base = if held && index == 0 { Attachment::Held } else { Attachment::Floating };
            let root = tree.link(tree.root, 0);
            let steps = tree.steps.iter().map(|step| (step.link, Some(step)));
            for (link, step) in std::iter::once((root, None)).chain(steps) {
                let (module, own) = links[link];
                let declared = &robot.module_type(module).links[own];
                let features = ground_features::features(&declared.collides);
                let joint = lasting.joint_of[link]
                    .zip(step)
                    .map(|(id, step)| joint_of(robot, owners[id], id, step, gains));
                let attachment = step.map_or(base, |step| match joint {
                    Some(_) => Attachment::Joint(model.body_of[step.parent]),
                    None => Attachment::Fixed(model.body_of[step.parent]),
                });
                let at = model.bodies.len();
                model.body_of[link] = at;
                model.module_of.push(module);
                if let Some(joint) = &joint {
                    model.moved_by[joint.id] = Some(at);
                }
                model.mass += declared.mass * settings.mass;
                model.start.push(lasting.poses[link]);
                model.bodies.push(Body {
                    attachment,
                    whole: at,
                    step: step.cloned(),
                    rigid: heavier(&rigid.bodies()[link], settings.mass),
                    joint,
                    surface: Surface::new(declared, world.friction * settings.friction),
                    bounds: Aabb::around(features.iter().map(Feature::bounds).flat_map(|b| [b.low, b.high])),
                    features,
                });
            }
        }
        for &(module, bond) in lasting.trees.iter().flat_map(|tree| &tree.tree.order) {
            let Some(bond) = bond else { continue };
            let Bond { a, b, .. } = robot.bonds[bond];
            model.bonded.insert((a.module.min(b.module), a.module.max(b.module)));
            if robot.bond_strength(bond) == (None, None) {
                continue;
            }
            let carried = model.port(robot, if b.module == module { b } else { a }).0;
            model.carrying.push(CarryingBond { bond, carried, port: model.port(robot, a) });
        }
        model.unite();
        model.follow();
        if !gains.unlimited {
            model.couple(robot, gains);
        }
        model
    }

    /// Adds a body that stands fast, to carry obstacles with this factor on friction. It comes after those of the robot, and is
    /// of no module.
    pub(crate) fn stand_fast(&mut self, friction: f64) {
        let friction = Link::FRICTION_DEFAULT * friction;
        let surface = Surface {
            friction,
            static_friction: friction,
            stiffness: robot::Surface::STIFFNESS_DEFAULT,
            damping: PARAMETERS.contact_damping,
        };
        self.fixture = Some(self.bodies.len());
        self.module_of.push(usize::MAX);
        self.start.push(Pose::identity());
        self.bodies.push(Body {
            attachment: Attachment::Held,
            whole: self.bodies.len(),
            step: None,
            rigid: RigidBody { mass: 0.0, com: Vec3::zeros(), inertia: Mat3::zeros() },
            joint: None,
            surface,
            bounds: Aabb::around([]),
            features: Vec::new(),
        });
    }

    /// Multiplies the stiffness of the contacts of each module, given by its index, by a factor, and the damping of all contacts of
    /// unit stiffness by another.
    pub(crate) fn scale_contacts(&mut self, factors: &[f64], damping: f64) {
        for (body, module) in self.bodies.iter_mut().zip(&self.module_of) {
            body.surface.stiffness *= factors.get(*module).copied().unwrap_or(1.0);
            body.surface.damping *= damping;
        }
    }

    /// Returns the body of a link, given by the index of its module and its own in the module.
    pub(crate) fn body(&self, module: usize, link: usize) -> usize {
        self.body_of[self.kinematics.link(module, link)]
    }

    /// Returns the number of the link that each body is, among those of all modules in order; 0 for what stands fast.
    pub(crate) fn links(&self) -> Vec<usize> {
        let mut links = vec![0; self.bodies.len()];
        self.body_of.iter().enumerate().for_each(|(link, body)| links[*body] = link);
        links
    }

    /// Returns the body of a port, and the port's pose in the frame of its link.
    pub(crate) fn port(&self, robot: &Assembly, port: PortRef) -> (usize, Pose) {
        let link = self.kinematics.port_link(robot, port);
        (self.body_of[link], robot.module_type(port.module).ports[port.port].pose)
    }

    /// Makes links that are fixed to each other one body, but for those that bonds carry which state what they hold.
    fn unite(&mut self) {
        let carried: BTreeSet<usize> = self.carrying.iter().map(|bond| bond.carried).collect();
        let mut parts: Vec<Vec<(RigidBody, Pose)>> = Vec::with_capacity(self.bodies.len());
        // The poses of the bodies in the frames of their wholes.
        let mut within: Vec<Pose> = Vec::with_capacity(self.bodies.len());
        for at in 0..self.bodies.len() {
            parts.push(Vec::new());
            within.push(Pose::identity());
            if let (Attachment::Fixed(parent), Some(step)) =
                (self.bodies[at].attachment, &self.bodies[at].step)
                && !carried.contains(&at)
            {
                let whole = self.bodies[parent].whole;
                within[at] = step.child_pose_at(&within[parent], 0.0);
                self.bodies[at].attachment = Attachment::Part(parent);
                self.bodies[at].whole = whole;
            }
            parts[self.bodies[at].whole].push((self.bodies[at].rigid, within[at]));
        }
        for (body, parts) in self.bodies.iter_mut().zip(&parts).filter(|(_, parts)| parts.len() > 1) {
            body.rigid = RigidBody::of_parts(parts);
        }
    }

    /// Finds the joints that follow others.
    fn follow(&mut self) {
        for (at, body) in self.bodies.iter().enumerate() {
            let (Some(joint), Some(step)) = (&body.joint, &body.step) else { continue };
            if matches!(step.terms(), [(id, _)] if *id == joint.id) {
                continue;
            }
            let of = |&(id, factor): &(usize, f64)| {
                let followed = self.moved_by[id]?;
                Some((followed, factor * self.bodies[followed].joint.as_ref()?.factor))
            };
            let terms = step.terms().iter().filter_map(of).collect();
            self.followers.push(Follower { body: at, terms });
        }
    }

    /// Finds the motors that drive several joints and have limits of effort.
    fn couple(&mut self, robot: &Assembly, gains: &ServoGains) {
        for module in 0..robot.modules.len() {
            let kind = robot.module_type(module);
            let Some(efforts) = motor_efforts(kind) else { continue };
            if kind.motors.iter().all(|motor| motor.limits.effort.is_none()) {
                continue;
            }
            let mut joints: Vec<usize> =
                kind.motors.iter().flat_map(|m| m.joints.iter().map(|j| j.0)).collect();
            joints.sort_unstable();
            joints.dedup();
            let bodies: Option<Vec<(usize, f64)>> = joints
                .iter()
                .map(|joint| {
                    let body = self.moved_by[self.kinematics.joint(module, *joint)]?;
                    Some((body, self.bodies[body].joint.as_ref()?.factor))
                })
                .collect();
            let Some(bodies) = bodies else { continue };
            let of = |terms: &[(usize, f64)]| {
                let of = |joint: &usize| terms.iter().filter(|(j, _)| j == joint).map(|(_, f)| f).sum();
                joints.iter().map(of).collect::<Vec<f64>>()
            };
            let motors = kind.motors.iter().zip(&efforts).map(|(motor, effort)| CoupledMotor {
                effort: motor.limits.effort.map_or(f64::INFINITY, |effort| effort * gains.effort),
                factors: of(&motor.joints),
                shares: of(effort),
            });
            let motors = motors.collect();
            for (body, _) in &bodies {
                if let Some(joint) = &mut self.bodies[*body].joint {
                    joint.is_coupled = true;
                }
            }
            self.coupled.push(Coupled { bodies, motors });
        }
    }

    /// Returns the coordinates of all bodies' joints for the positions (rad or m) of the robot's joints by their ids; 0
    /// for bodies without a joint.
    pub(crate) fn coordinates(&self, joints: &[f64]) -> Vec<f64> {
        let of = |body: &Body| match (&body.joint, &body.step) {
            (Some(_), Some(step)) => step.position(joints),
            _ => 0.0,
        };
        self.bodies.iter().map(of).collect()
    }
}

/// Returns the joint of an id that moves a step.
fn joint_of(robot: &Assembly, owner: JointOwner, id: usize, step: &Step, gains: &ServoGains) -> Joint {
    // A joint that follows others is stopped with them.
    let (limits, stops, passive) = match owner {
        JointOwner::Module { module, joint } => {
            let declared = &robot.module_type(module).joints[joint];
            let stops = declared.mimic.is_none() && declared.kind != JointKind::Fixed;
            (declared.limits, stops, declared.passive)
        }
        JointOwner::Bond(bond) => (robot.hinge(bond).map(|h| h.limits).unwrap_or_default(), true, false),
    };
    let driven = stops && !passive;
    let factor = match step.terms() {
        [(same, factor)] if *same == id => *factor,
        _ => 1.0,
    };
    let stated = robot.servo(owner);
    let stiffness = gains.stiffness.map_or_else(
        || robot.servo_stiffness(owner),
        |turning| if robot.slides(owner) { turning / (SERVO_LEVER * SERVO_LEVER) } else { turning },
    ) * gains.factor;
    let (most, seed) = gains.zero_error;
    let off = || {
        let mut numbers = SplitMix64(seed);
        numbers.skip(id);
        most * numbers.next_signed()
    };
    let servo = driven.then_some(DrivenServo {
        stiffness,
        zero: if most > 0.0 && !robot.slides(owner) { off() } else { 0.0 },
        damping: match gains.damping {
            Some(damping) => damping * stiffness,
            // Gains other than those of the modules have a damping to match.
            None if gains.stiffness.is_some() => Servo::DAMPING_DEFAULT * stiffness,
            None => stated.damping_with(stiffness / gains.factor) * gains.factor,
        },
        // Without a limit at rest there is none that falls with the speed.
        no_load_speed: stated
            .no_load_speed
            .filter(|_| !gains.unlimited && limits.effort.is_some())
            .unwrap_or(f64::INFINITY),
        effort: if gains.unlimited {
            f64::INFINITY
        } else {
            limits.effort.map_or(f64::INFINITY, |e| e * gains.effort)
        },
        limit: limits.effort.map(|effort| effort * gains.effort),
    });
    let armature = stated.armature_with(robot.servo_stiffness(owner));
    let range = limits.range.filter(|_| stops).map(|(low, high)| {
        let ends = (low * factor, high * factor);
        (ends.0.min(ends.1), ends.0.max(ends.1))
    });
    Joint {
        id,
        factor,
        slides: robot.slides(owner),
        servo,
        armature: if driven { armature } else { 0.0 },
        damping: stated.damping.filter(|_| passive).unwrap_or(0.0),
        is_coupled: false,
        range,
    }
}

/// Returns a rigid body with its mass and inertia times a factor.
fn heavier(body: &RigidBody, factor: f64) -> RigidBody {
    RigidBody { mass: body.mass * factor, inertia: body.inertia * factor, ..*body }
}

/// The lever at which the servo of a joint that slides is as stiff as that of one that turns, m.
const SERVO_LEVER: f64 = 0.1;
