//! A configuration as robotics sees it: an assembly with its start state and kinematics.

use crate::geometry::{Pose, Vec3};
use crate::plan::{Obstacle, World};
use crate::robot::{Assembly, JointId, JointOwner, Kinematics, Residual, State};
use std::sync::Arc;

/// A robot that a design describes, or the robots of a scene, assembled, with the poses of the links in the start state.
pub struct Robot {
    /// The modules, the bonds, and the library of module types and connectors.
    pub assembly: Arc<Assembly>,
    /// The start state: joints as `set`, all bonds closed, the base module's body at the origin; the robots of a scene
    /// where they are placed.
    pub start: State,
    /// The forward kinematics for the bonds of the start state: in a scene, of the base's robot alone.
    pub kinematics: Kinematics,
    /// The poses of all links in the start state, by their numbers in the kinematics, in the frame of the base
    /// module's body; of the robots of a scene in the world, before they settle.
    pub poses: Vec<Pose>,
    /// The obstacles of a scene, in the world's frame; none for a robot alone.
    pub obstacles: Arc<[Obstacle]>,
    /// The world that a scene states for its plans; `None` for a robot alone, and where a scene states none.
    pub world: Option<World>,
}

impl Robot {
    /// Returns a robot alone with this start state, its base module's body at the origin.
    pub fn alone(assembly: Assembly, start: State) -> Robot {
        let kinematics = Kinematics::new(&assembly, &start.bonds, assembly.base);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&start.joints, &Pose::identity(), &mut poses);
        Robot {
            assembly: Arc::new(assembly),
            start,
            kinematics,
            poses,
            obstacles: Arc::default(),
            world: None,
        }
    }

    /// Returns the number of the joint of a module or a bond among those of the assembly. The indices of a module and
    /// its joint are not checked: one out of range may give the number of another joint, or panic. Panics for a bond
    /// that is not there or has no hinge.
    pub fn joint_of(&self, owner: JointOwner) -> JointId {
        let index = joint_index(&self.kinematics, owner);
        JointId(u32::try_from(index).expect("joints are counted in 32 bits"))
    }

    /// Returns the path name of a joint; empty if there is no such joint.
    pub fn joint_name(&self, joint: JointId) -> String {
        let owner = self.assembly.joints().nth(joint.0 as usize);
        owner.map_or_else(String::new, |owner| self.assembly.joint_name(owner))
    }

    /// Returns the closure errors (positions in m, angles in rad, as [`Residual`] has them) of the bonds that close
    /// loops in the start state, ascending by bond; empty for a kinematic tree.
    pub fn residuals(&self) -> Vec<Residual> {
        let (robot, start) = (&self.assembly, &self.start);
        let mut found = self.kinematics.residuals(robot, &start.joints, &self.poses);
        for cluster in &start.clusters {
            let kinematics = Kinematics::new(robot, &start.bonds, cluster.reference);
            found.extend(kinematics.residuals(robot, &start.joints, &self.poses));
        }
        found.sort_by_key(|residual| residual.bond);
        found
    }

    /// Returns (centre, mass): the centre of mass in the start state (m, in the frame of [`poses`](Self::poses)), and
    /// the mass (kg), of all robots of a scene together.
    pub fn centre_of_mass(&self) -> (Vec3, f64) {
        self.centre_of(&self.poses)
    }

    /// Returns (centre, mass) of all modules: the centre of mass, m, and the mass, kg. `poses`: those of all links, by
    /// their numbers in the kinematics, in the frame of the centre.
    pub fn centre_of(&self, poses: &[Pose]) -> (Vec3, f64) {
        if self.start.clusters.is_empty() {
            return self.kinematics.centre_of_mass(&self.assembly, poses);
        }
        self.centre_of_modules(0..self.assembly.modules.len(), poses)
    }

    /// Returns (centre, mass) of some modules, given by their indices, as [`centre_of`](Self::centre_of) does of all.
    pub fn centre_of_modules(&self, modules: impl Iterator<Item = usize>, poses: &[Pose]) -> (Vec3, f64) {
        let (mut moment, mut mass) = (Vec3::zeros(), 0.0);
        for module in modules {
            for (link, declared) in
                self.kinematics.links_of(module).zip(&self.assembly.module_type(module).links)
            {
                moment += poses[link].transform_point(&declared.com.into()).coords * declared.mass;
                mass += declared.mass;
            }
        }
        (if mass > 0.0 { moment / mass } else { moment }, mass)
    }
}

/// Returns the number of a joint, from 0, among those of the assembly, as in a [`JointId`]. `kinematics`: the
/// kinematics of the assembly; `owner`: the module or bond that has the joint. An `owner` out of range is treated as in
/// [`Robot::joint_of`].
pub fn joint_index(kinematics: &Kinematics, owner: JointOwner) -> usize {
    match owner {
        JointOwner::Module { module, joint } => kinematics.joint(module, joint),
        JointOwner::Bond(bond) => kinematics.hinge(bond).expect("only hinges are named"),
    }
}
