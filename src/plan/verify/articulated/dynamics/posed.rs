//! The robot at an instant: poses in level axes about its centre of mass, joints in motion, and the points at which the
//! ground may bear it.

use super::super::minimum_power::along_ground;
use super::super::model::Model;
use super::super::rollout_input::Rollout;
use super::super::tolerances::NUMERICS;
use super::loads::{self, Loop, Stop};
use super::tolerances::PARAMETERS;
use crate::geometry::Mat3;
use crate::geometry::ground_features::{Feature, tread};
use crate::geometry::{Pose, Vec3};
use crate::plan::{Ground, World};
use crate::robot::JointOwner;
use crate::robot::dynamics::{Dynamics, MotionState, Twist, Wrench};
use nalgebra::{Matrix6, Rotation3, UnitQuaternion, Vector6};

/// A point of the robot so low that the ground may bear it: a candidate for contact.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// The link of the point, by its number among all links.
    pub link: usize,
    /// The index of the point's feature in [`Model::features`], and the number of the point in it.
    pub feature: (usize, u8),
    /// The position from the centre of mass in level axes, m.
    pub p: Vec3,
    /// The height above the lowest point of the robot, m.
    pub gap: f64,
    /// The coefficient of friction: that of the link times the factor of the world, without unit.
    pub friction: f64,
    /// The velocity of the point by the joints alone, with the base still, m/s, in level axes.
    pub by_joints: Vec3,
}

/// The robot at an instant: its poses in level axes about its centre of mass, and the motion of its joints.
pub(super) struct Posed<'a> {
    /// The model of the robot with the bonds that hold.
    pub model: &'a Model<'a>,
    /// The masses of the robot's links.
    pub dynamics: &'a Dynamics,
    /// The poses of all links in level axes, with the robot's centre of mass at the origin, m.
    pub poses: Vec<Pose>,
    /// The positions of the joints, by [`crate::robot::JointId`], rad or m.
    pub joints: Vec<f64>,
    /// The mean velocity of each joint over the window, rad/s or m/s.
    pub velocities: Vec<f64>,
    /// The mean acceleration of each joint over the window, rad/s² or m/s².
    pub accelerations: Vec<f64>,
    /// The heading of the level axes in the frame of the ground, rad.
    pub yaw: f64,
}

impl<'a> Posed<'a> {
    /// Returns the robot at a time of a rollout. `(time, window)`: the time and the length of the window centred on
    /// it over which velocities and accelerations are means, s; `(R, yaw)`: the orientation of the base in level axes, and
    /// the heading of these (rad).
    pub(super) fn new(
        model: &'a Model<'a>,
        dynamics: &'a Dynamics,
        rollout: &Rollout,
        (time, window): (f64, f64),
        (R, yaw): (&Mat3, f64),
    ) -> Posed<'a> {
        let tracks = rollout.tracks;
        let mut joints = tracks.start.joints.clone();
        let mut velocities = vec![0.0; joints.len()];
        let mut accelerations = vec![0.0; joints.len()];
        let (from, to) = (time - window / 2.0, time + window / 2.0);
        for track in &tracks.tracks {
            let joint = track.joint.0 as usize;
            let start = joints[joint];
            // The joint is at rest before the start of the plan, after its end, and from when it is held.
            let end = rollout.held.filter(|held| held.0 == joint).map_or(rollout.end, |held| held.1);
            let at = |t: f64| track.position(start, t.clamp(0.0, end));
            let rate = |t: f64| if t >= 0.0 && t < end { track.velocity(t) } else { 0.0 };
            velocities[joint] = (at(to) - at(from)) / window;
            accelerations[joint] = (rate(to) - rate(from)) / window;
            joints[joint] = at(time);
        }
        let mut poses = Vec::new();
        let posture = model.posture(&joints, &mut poses);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*R));
        let base = Pose::from_parts((-(R * posture.centre)).into(), turn);
        poses.iter_mut().for_each(|pose| *pose = base * *pose);
        Posed { model, dynamics, poses, joints, velocities, accelerations, yaw }
    }

    /// Returns the twist at the centre of mass that the joints alone, with the base still, give each link, by the
    /// number of the link, in level axes (m/s, rad/s); zero for links that are not connected with the base.
    fn by_joints(&self) -> Vec<Twist> {
        let mut twists = vec![Twist::default(); self.poses.len()];
        for step in &self.model.kinematics.steps {
            let mut twist = twists[step.parent];
            if let Some(axis) = step.joint_axis(&self.poses) {
                let (linear, angular) = axis.velocity(&Vec3::zeros());
                let velocity: f64 = step.terms().iter().map(|&(j, factor)| factor * self.velocities[j]).sum();
                twist.linear += linear * velocity;
                twist.angular += angular * velocity;
            }
            twists[step.link] = twist;
        }
        twists
    }

    /// Returns the points that the ground may bear, the lowest first: those at most
    /// [`gap_max`](super::tolerances::Parameters::gap_max) above the lowest, no two of one link nearer to each other
    /// than [`candidate_distance`](super::tolerances::Parameters::candidate_distance). `friction`: the world's factor
    /// on the coefficients of friction.
    pub(super) fn candidates(&self, friction: f64) -> Vec<Candidate> {
        let up = Vec3::z();
        let (heights, lowest) = self.feature_heights();
        let mut near = Vec::new();
        let mut points = Vec::new();
        for &link in &self.model.attached {
            let pose = &self.poses[link];
            let R = *pose.rotation.to_rotation_matrix().matrix();
            let mut before: Option<(usize, Feature)> = None;
            let mut plane = None;
            for index in self.model.bodies[link].features.clone() {
                if heights[index] - lowest > PARAMETERS.gap_max {
                    continue;
                }
                let feature = self.model.features[index].placed(&R, &pose.translation.vector);
                points.clear();
                let limit = lowest + PARAMETERS.gap_max + NUMERICS.point_height;
                feature.points_below(&up, limit, &mut plane, &mut points);
                let low = points.iter().filter(|(_, p)| p.z - lowest <= PARAMETERS.gap_max);
                near.extend(low.map(|&(k, p)| (p.z - lowest, link, index, k, p)));
                let rims = before.filter(|(other, _)| other + 1 == index);
                if let Some(p) = rims.and_then(|(_, other)| tread(&other, &feature, &up, &mut plane)) {
                    near.push((p.z - lowest, link, index - 1, feature.points(), p));
                }
                before = Some((index, feature));
            }
        }
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2, a.3).cmp(&(b.1, b.2, b.3))));
        let by_joints = self.by_joints();
        let mut kept: Vec<Candidate> = Vec::with_capacity(near.len());
        let mut on_link: Vec<Vec<Vec3>> = vec![Vec::new(); self.poses.len()];
        for (gap, link, index, k, p) in near {
            let others = &mut on_link[link];
            if others.iter().any(|other| (other - p).norm() < PARAMETERS.candidate_distance) {
                continue;
            }
            others.push(p);
            kept.push(Candidate {
                link,
                feature: (index, k),
                p,
                gap,
                friction: friction * self.model.bodies[link].friction,
                by_joints: by_joints[link].at(&p),
            });
        }
        kept
    }

    /// Returns the height of the lowest point of each feature over the centre of mass, m, and the least of these
    /// heights; infinity without features.
    fn feature_heights(&self) -> (Vec<f64>, f64) {
        let mut heights = Vec::with_capacity(self.model.features.len());
        for &link in &self.model.attached {
            let pose = &self.poses[link];
            let up = pose.rotation.inverse_transform_vector(&Vec3::z());
            let own = &self.model.features[self.model.bodies[link].features.clone()];
            heights.extend(own.iter().map(|feature| feature.lowest(&up) + pose.translation.vector.z));
        }
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        (heights, lowest)
    }

    /// Returns the height of each link's lowest point, by the link's number, above the lowest point of the robot, m;
    /// infinite for links without features.
    pub(super) fn heights(&self) -> Vec<f64> {
        let (of_features, lowest) = self.feature_heights();
        let mut heights = vec![f64::INFINITY; self.poses.len()];
        for (index, height) in of_features.iter().enumerate() {
            let link = &mut heights[self.model.link_of[index]];
            *link = link.min(height - lowest);
        }
        heights
    }

    /// Returns the greatest height of a point of a link that the ground may bear in the posture `after`, above the lowest
    /// point of the robot, m; 0 if it may bear none. `after` has the same links.
    pub(super) fn height_of_landing(&self, after: &Posed, link: usize) -> f64 {
        let (before, lowest) = self.feature_heights();
        let (heights, ground) = after.feature_heights();
        let own = self.model.bodies[link].features.clone();
        let lands = own.filter(|index| heights[*index] - ground <= PARAMETERS.gap_max);
        lands.map(|index| before[index] - lowest).fold(0.0, f64::max)
    }

    /// Returns the twist of the base's own frame, at its origin, for a twist of the base at the centre of mass, both
    /// in level axes (m/s, rad/s).
    pub(super) fn of_base(&self, at_centre: &Twist) -> Twist {
        let p = self.poses[self.model.base_link()].translation.vector;
        Twist { linear: at_centre.linear + at_centre.angular.cross(&p), angular: at_centre.angular }
    }

    /// Returns the linear momentum (N·s) and the angular momentum about the centre of mass (N·m·s) that the joints'
    /// motion gives the robot if its base stands still, in level axes.
    pub(super) fn momentum(&self) -> Wrench {
        self.dynamics.momentum(
            &self.model.kinematics,
            &self.poses,
            &Twist::default(),
            &self.velocities,
            &Vec3::zeros(),
        )
    }

    /// Returns the twist of the base's own frame (m/s, rad/s), in level axes, at which the whole robot has a momentum (N·s,
    /// and N·m·s about its centre of mass, in level axes): none if it floats and has started from rest. `None` for a robot
    /// without mass.
    pub(super) fn drifting(&self, momentum: &Wrench) -> Option<Twist> {
        let own = self.momentum();
        let lacking = Wrench { force: own.force - momentum.force, moment: own.moment - momentum.moment };
        self.compensating(&lacking)
    }

    /// Returns the wrenches of [`link_wrenches`](Self::link_wrenches) for a robot that floats: the base, whose velocity
    /// is given, accelerates such that no force from outside is needed.
    fn floating_wrenches(&self, base: &Twist) -> Vec<Wrench> {
        let still = (*base, Twist::default());
        let acceleration =
            self.compensating(&sum(&self.link_wrenches(Some(&still), &Vec3::zeros()))).unwrap_or_default();
        self.link_wrenches(Some(&(*base, acceleration)), &Vec3::zeros())
    }

    /// Returns the twist of the base's frame, with the joints still, whose momentum about the centre of mass cancels
    /// this one; for a wrench it is the acceleration whose inertial wrench does so. `None` for a robot without mass.
    fn compensating(&self, wrench: &Wrench) -> Option<Twist> {
        let still = vec![0.0; self.velocities.len()];
        let mut inertia = Matrix6::zeros();
        for axis in 0..6 {
            let unit = Vec3::ith(axis % 3, 1.0);
            let (linear, angular) = if axis < 3 { (unit, Vec3::zeros()) } else { (Vec3::zeros(), unit) };
            let twist = Twist { linear, angular };
            let momentum =
                self.dynamics.momentum(&self.model.kinematics, &self.poses, &twist, &still, &Vec3::zeros());
            inertia.fixed_view_mut::<3, 1>(0, axis).copy_from(&momentum.force);
            inertia.fixed_view_mut::<3, 1>(3, axis).copy_from(&momentum.moment);
        }
        let mut right = Vector6::zeros();
        right.fixed_rows_mut::<3>(0).copy_from(&-wrench.force);
        right.fixed_rows_mut::<3>(3).copy_from(&-wrench.moment);
        let twist = inertia.lu().solve(&right)?;
        Some(Twist { linear: twist.fixed_rows::<3>(0).into(), angular: twist.fixed_rows::<3>(3).into() })
    }

    /// Returns the moment of inertia of the whole robot about the vertical through the centre of mass, kg·m².
    pub(super) fn yaw_inertia(&self) -> f64 {
        let unit = Twist { linear: self.spun(), angular: Vec3::z() };
        let still = vec![0.0; self.velocities.len()];
        self.dynamics.momentum(&self.model.kinematics, &self.poses, &unit, &still, &Vec3::zeros()).moment.z
    }

    /// Returns the velocity of the base's origin when the robot turns about the vertical at 1 rad/s, m/s.
    fn spun(&self) -> Vec3 {
        Vec3::z().cross(&self.poses[self.model.base_link()].translation.vector)
    }

    /// Returns the wrench that each link, by its number, needs for a motion under gravity (m/s², in level axes), about the
    /// centre of mass of the robot, in level axes (N, N·m); zero for links that are not connected with the base.
    /// `motion`: velocity and acceleration of the base's own frame; `None` for a robot at rest.
    pub(super) fn link_wrenches(&self, motion: Option<&(Twist, Twist)>, gravity: &Vec3) -> Vec<Wrench> {
        let still = vec![0.0; self.velocities.len()];
        let (base, base_acceleration) = motion.copied().unwrap_or_default();
        let (velocities, accelerations) = match motion {
            Some(_) => (&self.velocities, &self.accelerations),
            None => (&still, &still),
        };
        let state = MotionState { poses: &self.poses, base, base_acceleration, velocities, accelerations };
        self.dynamics.link_wrenches(&self.model.kinematics, &state, gravity, &Vec3::zeros())
    }
}

/// The way in which the surroundings support the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Support {
    /// The robot rests on the ground, over which friction moves it.
    Settles,
    /// The robot rests on the ground, and its base keeps its place.
    Stays,
    /// A fixture holds the base, and bears any force and moment.
    Held,
    /// The robot floats: nothing supports it, and gravity does not pull it.
    Floats,
}

impl Support {
    /// Returns the support in a world: on a fixed base ([`Ground::Fixed`]) without gravity it is that of a fixture.
    pub(super) fn of(world: &World) -> Support {
        match world.ground {
            Ground::Settle => Support::Settles,
            Ground::Fixed if world.gravity > 0.0 => Support::Stays,
            Ground::Fixed | Ground::Held => Support::Held,
            Ground::Off => Support::Floats,
        }
    }

    /// Returns true if the robot rests on the ground, whether its base keeps its place or not.
    pub(super) fn rests(self) -> bool {
        matches!(self, Support::Settles | Support::Stays)
    }
}

/// The robot at an instant with the wrenches that its motion needs, and all that may supply them: the input of the
/// methods that find forces.
pub(super) struct Situation<'a> {
    /// The robot.
    pub posed: &'a Posed<'a>,
    /// The points at which the ground may bear the robot; none unless it rests on the ground.
    pub candidates: Vec<Candidate>,
    /// The stops that joints are at or near.
    pub stops: Vec<Stop>,
    /// The bonds that close loops.
    pub loops: Vec<Loop>,
    /// The wrench that each link needs, by its number, about the centre of mass in level axes, N and N·m; zero for
    /// links that are not connected with the base.
    pub needed: Vec<Wrench>,
    /// The wrench that the surroundings must exert on the whole robot, about the centre of mass in level axes, N and
    /// N·m.
    pub base: Wrench,
    /// The stiffness of each joint, by [`crate::robot::JointId`], N·m/rad or N/m.
    pub stiffness: Vec<f64>,
    /// The support of the robot.
    pub support: Support,
    /// The weight, N.
    pub weight: f64,
    /// True on a slope, where friction bears a part of the weight.
    pub sloped: bool,
    /// The greatest horizontal distance of a candidate from the centre of mass, m; at least 5 cm.
    pub size: f64,
}

impl<'a> Situation<'a> {
    /// Returns the situation of a robot at rest in a world: joints and base have no velocity and no acceleration.
    pub(super) fn at_rest(posed: &'a Posed<'a>, world: &World) -> Situation<'a> {
        Situation::new(posed, world, None)
    }

    /// Returns the situation of a robot in motion. `motion`: velocity (m/s, rad/s) and acceleration (m/s², rad/s²) of
    /// the base's own frame, in level axes; the acceleration of a floating one follows from the forces and is not read.
    pub(super) fn moving(posed: &'a Posed<'a>, world: &World, motion: &(Twist, Twist)) -> Situation<'a> {
        Situation::new(posed, world, Some(motion))
    }

    fn new(posed: &'a Posed<'a>, world: &World, motion: Option<&(Twist, Twist)>) -> Situation<'a> {
        let support = Support::of(world);
        let candidates = if support.rests() { posed.candidates(world.friction) } else { vec![] };
        let reach = candidates.iter().map(|c| libm::hypot(c.p.x, c.p.y));
        let size = reach.fold(PARAMETERS.size_min, f64::max);
        let gravity = if support == Support::Floats { 0.0 } else { world.gravity };
        let needed = match motion {
            Some(motion) if support == Support::Floats => posed.floating_wrenches(&motion.0),
            _ => posed.link_wrenches(motion, &(world.down(posed.yaw) * gravity)),
        };
        Situation {
            base: sum(&needed),
            stops: loads::stops(posed),
            loops: loads::loops(posed),
            stiffness: stiffness(posed.model),
            weight: posed.model.mass * gravity,
            sloped: world.is_sloped(),
            posed,
            candidates,
            needed,
            support,
            size,
        }
    }
}

/// Returns the stiffness of each joint's servo, by [`crate::robot::JointId`], N·m/rad or N/m
/// ([`servo_stiffness`](crate::robot::Assembly::servo_stiffness)), or
/// [`passive_stiffness`](super::tolerances::Parameters::passive_stiffness).
fn stiffness(model: &Model) -> Vec<f64> {
    let robot = model.robot;
    let of = |owner| match owner {
        JointOwner::Module { module, joint } if robot.module_type(module).joints[joint].passive => {
            PARAMETERS.passive_stiffness
        }
        _ => robot.servo_stiffness(owner),
    };
    robot.joints().map(of).collect()
}

/// Returns the sum of wrenches about one point.
fn sum(wrenches: &[Wrench]) -> Wrench {
    let add = |sum: Wrench, w: &Wrench| Wrench { force: sum.force + w.force, moment: sum.moment + w.moment };
    wrenches.iter().fold(Wrench::default(), add)
}

/// Returns a twist turned about the normal of the ground by `yaw` (rad): given in level axes, it is returned in those of the
/// ground.
pub(super) fn turned(twist: &Twist, yaw: f64) -> Twist {
    Twist { linear: along_ground(&twist.linear, yaw), angular: along_ground(&twist.angular, yaw) }
}
