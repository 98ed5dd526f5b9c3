//! The kinematic trees of a plan's robot over the bonds that hold all the time, as simulators need them: what hangs
//! together during the whole plan is one tree; bonds that close loops, dock or undock are constraints besides.
#![allow(non_snake_case)]

use super::motion::{DockingKind, Tracks};
use crate::geometry::Pose;
use crate::robot::{Assembly, ClusterPose, JointKind, Kinematics};

/// The kinematic trees of a plan's robot over the bonds that hold during the whole plan. Links and joints go by their
/// numbers among all those of the robot.
#[derive(Clone, Debug)]
pub struct LastingTrees {
    /// The kinematics of each tree: that of the base module first, then those of further modules in order.
    pub trees: Vec<Kinematics>,
    /// The joint that moves each link against its parent; `None` for roots and links that nothing moves against it.
    pub joint_of: Vec<Option<usize>>,
    /// The bonds that hold at some time and are in no tree, ascending.
    pub constraints: Vec<usize>,
    /// The kinematics of the whole robot at the start, from its base.
    pub start: Kinematics,
    /// The world pose of each link at the start, m. Modules that no bond connects with the base then are where the other
    /// bonds would put them.
    pub poses: Vec<Pose>,
}

impl LastingTrees {
    /// Returns the trees of a plan's robot, whose bonds have the misalignments with which they hold at the start. `X_WB`: the
    /// world pose of its base module's body then, m; `clusters`: the poses of further clusters then; `apart`: the bonds, by
    /// their indices, that are constraints although they hold all the time, or never.
    pub fn new(tracks: &Tracks, X_WB: &Pose, clusters: &[ClusterPose], apart: &[usize]) -> LastingTrees {
        let mut ever = tracks.start.bonds.clone();
        let mut lasting = ever.clone();
        for event in &tracks.events {
            lasting[event.bond] = false;
            ever[event.bond] |= event.kind == DockingKind::Dock;
        }
        apart.iter().for_each(|&bond| (lasting[bond], ever[bond]) = (false, true));
        let errors = tracks.start.misalignments.iter().map(|error| (error.bond, error.pose)).collect();
        let robot = &Assembly { misalignments: errors, ..tracks.robot.clone() };
        let start = Kinematics::new(robot, &tracks.start.bonds, robot.base);
        let all = Kinematics::new(robot, &vec![true; robot.bonds.len()], robot.base);
        let mut poses = vec![Pose::identity(); start.link_count()];
        all.link_poses(&tracks.start.joints, X_WB, &mut poses);
        start.link_poses(&tracks.start.joints, X_WB, &mut poses);
        for cluster in clusters {
            let own = Kinematics::new(robot, &tracks.start.bonds, cluster.reference);
            own.link_poses(&tracks.start.joints, &cluster.pose, &mut poses);
        }
        let mut found = LastingTrees {
            trees: Vec::new(),
            joint_of: vec![None; start.link_count()],
            constraints: Vec::new(),
            start,
            poses,
        };
        let mut reached = vec![false; robot.modules.len()];
        let mut next = Some(robot.base);
        while let Some(root) = next {
            let kinematics = Kinematics::new(robot, &lasting, root);
            for &(module, bond) in &kinematics.tree.order {
                reached[module] = true;
                bond.into_iter().for_each(|bond| ever[bond] = false);
            }
            found.name_joints(robot, &kinematics);
            found.trees.push(kinematics);
            next = reached.iter().position(|reached| !reached);
        }
        found.constraints = (0..ever.len()).filter(|&bond| ever[bond]).collect();
        found
    }

    /// Finds the joints that move the links of a tree.
    fn name_joints(&mut self, robot: &Assembly, kinematics: &Kinematics) {
        for &(module, bond) in &kinematics.tree.order {
            if let Some(bond) = bond {
                let declared = &robot.bonds[bond];
                let at = if declared.b.module == module { declared.b } else { declared.a };
                let link = kinematics.port_link(robot, at);
                self.joint_of[link] = kinematics.hinge(bond);
            }
            for (index, joint) in robot.module_type(module).joints.iter().enumerate() {
                let [a, b] = [joint.parent, joint.child].map(|link| kinematics.link(module, link));
                let step = |link, parent| kinematics.step(link).filter(|step| step.parent == parent);
                let moved = step(b, a).or_else(|| step(a, b));
                let moved = moved.filter(|step| joint.kind != JointKind::Fixed && !step.terms().is_empty());
                if let Some(step) = moved {
                    self.joint_of[step.link] = Some(kinematics.joint(module, index));
                }
            }
        }
    }
}
