//! The model of a robot for the judge: kinematics with the bonds that hold, masses, and features that can touch
//! the ground.

use crate::geometry::Mat3;
use crate::geometry::ground_features::{self, Feature};
use crate::geometry::{Pose, Vec3};
use crate::robot::{Assembly, JointOwner, Kinematics, Step};
use std::ops::Range;

/// A robot with the bonds that hold, compiled for statics and ground contact.
pub struct Model<'a> {
    /// The assembly that was compiled.
    pub robot: &'a Assembly,
    /// The kinematics of the assembly for the bonds that hold, with the base module as the root.
    pub kinematics: Kinematics,
    /// The bodies, one for every link of the assembly by its number in `kinematics`, also for those that are not
    /// connected with the base.
    pub bodies: Vec<Body>,
    /// The numbers of the links connected with the base ([`Kinematics::link`]), ascending.
    pub attached: Vec<usize>,
    /// The features of the attached links, each in the frame of its link, ascending by link.
    pub features: Vec<Feature>,
    /// The number of the link of each ground feature, in the order of `features`.
    pub link_of: Vec<usize>,
    /// The mass of all attached links together, kg.
    pub mass: f64,
    /// The joints that move one step of the tree each and whose range has ends.
    pub ranged: Vec<RangedJoint>,
}

/// A joint whose range has ends, and the step of the tree that it moves.
#[derive(Clone, Copy, Debug)]
pub struct RangedJoint {
    /// The joint, by the number in its [`crate::robot::JointId`].
    pub joint: usize,
    /// The index of the joint's step in [`Kinematics::steps`].
    pub step: usize,
    /// The factor of the joint in the motion of the step: 1 or -1.
    pub factor: f64,
    /// The lowest and the highest position of the joint, rad or m.
    pub range: (f64, f64),
}

/// A link with its mass, friction and ground features, as statics needs them.
#[derive(Clone, Debug)]
pub struct Body {
    /// The index in the assembly of the module that the link belongs to.
    pub module: usize,
    /// The mass of the link, kg.
    pub mass: f64,
    /// The centre of mass in the link's frame, m.
    pub com: Vec3,
    /// The coefficient of friction of the link against the ground, without unit and without the factor of the world.
    pub friction: f64,
    /// The greatest gap at which the link counts as touching the ground, m.
    pub contact: f64,
    /// The indices of the link's features in [`Model::features`].
    pub features: Range<usize>,
}

/// The poses of all links in the frame of the base module's body.
#[derive(Clone, Debug)]
pub struct Posture {
    /// The orientation of each link in the base's frame, by its number; those of links that are not connected with
    /// the base mean nothing.
    pub R: Vec<Mat3>,
    /// The position of each link's origin in the base's frame, by its number, m.
    pub p: Vec<Vec3>,
    /// The centre of mass of the attached links in the base's frame, m; without mass the origin.
    pub centre: Vec3,
}

impl<'a> Model<'a> {
    /// Compiles `robot` with the bonds for which `bonds`, by the bond's index in the assembly, is true. Panics unless
    /// there is one flag for every bond.
    pub fn new(robot: &'a Assembly, bonds: &[bool]) -> Model<'a> {
        let kinematics = Kinematics::new(robot, bonds, robot.base);
        let mut model = Model {
            robot,
            bodies: Vec::with_capacity(kinematics.link_count()),
            kinematics,
            attached: Vec::new(),
            features: Vec::new(),
            link_of: Vec::new(),
            mass: 0.0,
            ranged: Vec::new(),
        };
        model.ranged = ranged(robot, &model.kinematics);
        let mut shapes: Vec<Option<Vec<Vec<Feature>>>> = vec![None; robot.library.modules.len()];
        for module in 0..robot.modules.len() {
            let declared = robot.module_type(module);
            let shapes = shapes[robot.modules[module].kind].get_or_insert_with(|| {
                declared.links.iter().map(|link| ground_features::features(&link.collides)).collect()
            });
            let loose = model.kinematics.tree.loose.binary_search(&module).is_ok();
            for (index, link) in declared.links.iter().enumerate() {
                let first = model.features.len();
                if !loose {
                    let number = model.bodies.len();
                    model.attached.push(number);
                    model.mass += link.mass;
                    model.features.extend_from_slice(&shapes[index]);
                    model.link_of.resize(model.features.len(), number);
                }
                model.bodies.push(Body {
                    module,
                    mass: link.mass,
                    com: link.com,
                    friction: link.friction,
                    contact: declared.contact,
                    features: first..model.features.len(),
                });
            }
        }
        model
    }

    /// Returns the poses of all links in the base's frame with the joints at these positions (rad or m), one for
    /// every joint of the assembly by the number in its `JointId`. `poses` is a buffer, which is resized and
    /// overwritten. Panics if `joints` is too short.
    pub fn posture(&self, joints: &[f64], poses: &mut Vec<Pose>) -> Posture {
        poses.resize(self.bodies.len(), Pose::identity());
        self.kinematics.link_poses(joints, &Pose::identity(), poses);
        let R: Vec<Mat3> = poses.iter().map(|X| *X.rotation.to_rotation_matrix().matrix()).collect();
        let p: Vec<Vec3> = poses.iter().map(|X| X.translation.vector).collect();
        let mut moment = Vec3::zeros();
        for &link in &self.attached {
            moment += (R[link] * self.bodies[link].com + p[link]) * self.bodies[link].mass;
        }
        let centre = if self.mass > 0.0 { moment / self.mass } else { p[self.base_link()] };
        Posture { R, p, centre }
    }

    /// Returns the number of the link that is the body of the base module ([`Kinematics::link`]).
    pub fn base_link(&self) -> usize {
        self.kinematics.link(self.robot.base, 0)
    }

    /// Returns all ground features, in the order of [`Model::features`], in axes that `R` turns the base's frame to,
    /// with the centre of mass at the origin, m. `posture`: one of this model.
    pub fn placed(&self, posture: &Posture, R: &Mat3) -> Vec<Feature> {
        let mut placed = Vec::with_capacity(self.features.len());
        for &link in &self.attached {
            let R_link = R * posture.R[link];
            let p = R * (posture.p[link] - posture.centre);
            let own = &self.features[self.bodies[link].features.clone()];
            placed.extend(own.iter().map(|feature| feature.placed(&R_link, &p)));
        }
        placed
    }

    /// Returns the path name of the module that a link belongs to; `link`: the link's number ([`Kinematics::link`]).
    /// Panics if there is no such link.
    pub fn module_name(&self, link: usize) -> &str {
        &self.robot.modules[self.bodies[link].module].name
    }
}

/// Returns the joints of a robot that move one step each and whose range has ends, in the order of the steps.
fn ranged(robot: &Assembly, kinematics: &Kinematics) -> Vec<RangedJoint> {
    let of = |owner| match owner {
        JointOwner::Module { module, joint } => robot.module_type(module).joints[joint].limits.range,
        JointOwner::Bond(bond) => robot.hinge(bond).and_then(|hinge| hinge.limits.range),
    };
    let ranges: Vec<Option<(f64, f64)>> = robot.joints().map(of).collect();
    let ranged = |(step, moved): (usize, &Step)| match *moved.terms() {
        [(joint, factor)] if factor.abs() == 1.0 => {
            Some(RangedJoint { joint, step, factor, range: ranges[joint]? })
        }
        _ => None,
    };
    // A joint that others follow has one stop, at the first of its steps.
    let mut known = vec![false; ranges.len()];
    let first = |ranged: &RangedJoint| !std::mem::replace(&mut known[ranged.joint], true);
    kinematics.steps.iter().enumerate().filter_map(ranged).filter(first).collect()
}
