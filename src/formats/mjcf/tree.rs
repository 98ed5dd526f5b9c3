//! The robot as MuJoCo sees it: trees of links that hang together during the whole plan, and the bonds besides.

use crate::geometry::Pose;
use crate::plan::{LastingTrees, Tracks};
use crate::robot::{Assembly, ClusterPose, JointOwner, Kinematics, Limits, Link, Servo, Step};

/// The least extent of a joint's range, rad or m.
const RANGE_MIN: f64 = 1e-6;

/// The kinematic trees of a plan's robot over the bonds that are closed during the whole plan, with the names of its
/// links and joints. Links and joints are given by their indices among all those of the robot, from 0.
pub(super) struct Trees<'a> {
    /// The robot.
    pub(super) robot: &'a Assembly,
    /// The roots: the body of the base module first, then that of a module of each further tree; each with its world
    /// pose at the start.
    pub(super) roots: Vec<(usize, Pose)>,
    /// The links that hang on each link, by number among all links ([`Kinematics::link`]).
    pub(super) children: Vec<Vec<usize>>,
    /// The step from its parent to each link; `None` for roots.
    pub(super) steps: Vec<Option<Step>>,
    /// The joint that moves each link against its parent; `None` for roots and links that nothing moves against it.
    pub(super) joint_of: Vec<Option<usize>>,
    /// The bonds that hold at some time and are in no tree, ascending.
    pub(super) constraints: Vec<usize>,
    /// The ports of those bonds on each link: the bond, and true if it is its second port.
    pub(super) constraints_at: Vec<Vec<(usize, bool)>>,
    /// A position of 0 for every joint.
    pub(super) zero: Vec<f64>,
    /// The kinematics of the whole robot at the start, from its base.
    pub(super) start: Kinematics,
    /// The module, and the index there, of every link.
    links: Vec<(usize, usize)>,
    /// The owner of every joint, by id.
    joints: Vec<JointOwner>,
}

impl<'a> Trees<'a> {
    /// Returns the trees of a plan's robots; `X_WB`: the world pose of the base module's body at the start, m; `clusters`:
    /// those of the references of further clusters then.
    pub(super) fn new(tracks: &'a Tracks, X_WB: &Pose, clusters: &[ClusterPose]) -> Trees<'a> {
        let robot = &tracks.robot;
        let links: Vec<(usize, usize)> = (0..robot.modules.len())
            .flat_map(|module| (0..robot.module_type(module).links.len()).map(move |link| (module, link)))
            .collect();
        let LastingTrees { trees: kinematics, joint_of, constraints, start, poses } =
            LastingTrees::new(tracks, X_WB, clusters, &[]);
        let mut trees = Trees {
            robot,
            roots: Vec::new(),
            children: vec![Vec::new(); links.len()],
            steps: vec![None; links.len()],
            joint_of,
            constraints,
            constraints_at: vec![Vec::new(); links.len()],
            zero: vec![0.0; tracks.start.joints.len()],
            start,
            links,
            joints: robot.joints().collect(),
        };
        for kinematics in kinematics {
            let root = kinematics.link(kinematics.root, 0);
            trees.roots.push((root, poses[root]));
            for step in kinematics.steps {
                trees.children[step.parent].push(step.link);
                let link = step.link;
                trees.steps[link] = Some(step);
            }
        }
        for &bond in &trees.constraints {
            for (port, second) in [(robot.bonds[bond].a, false), (robot.bonds[bond].b, true)] {
                let link = trees.start.port_link(robot, port);
                trees.constraints_at[link].push((bond, second));
            }
        }
        trees
    }

    /// Returns the indices of the links of all trees in the order of MuJoCo's bodies: tree by tree, depth first.
    pub(super) fn depth_first(&self) -> Vec<usize> {
        let mut order = Vec::new();
        for &(root, _) in &self.roots {
            let mut open = vec![root];
            while let Some(link) = open.pop() {
                order.push(link);
                open.extend(self.children[link].iter().rev());
            }
        }
        order
    }

    /// Returns the depth of the deepest tree: the number of links on the longest path from a root, both ends counted.
    pub(super) fn depth(&self) -> usize {
        let mut depth = vec![1; self.steps.len()];
        for link in self.depth_first() {
            if let Some(step) = &self.steps[link] {
                depth[link] = depth[step.parent] + 1;
            }
        }
        depth.into_iter().max().unwrap_or(0)
    }

    /// Returns the joints of the model with the links that they move, as (index of the joint, index of the link), in
    /// the order of MuJoCo's joints.
    pub(super) fn moved(&self) -> Vec<(usize, usize)> {
        self.depth_first().into_iter().filter_map(|link| Some((self.joint_of[link]?, link))).collect()
    }

    /// Returns the link of this index among all links of the robot. Panics if there is none.
    pub(super) fn link(&self, link: usize) -> &'a Link {
        let (module, index) = self.links[link];
        &self.robot.module_type(module).links[index]
    }

    /// Returns (type, link) for the link of this index among all links: the index of its module's type in the library,
    /// and its own index in that type.
    pub(super) fn kind(&self, link: usize) -> (usize, usize) {
        let (module, index) = self.links[link];
        (self.robot.modules[module].kind, index)
    }

    /// Returns the name of a link in the model: its module's path name, a dot, and its own name.
    pub(super) fn link_name(&self, link: usize) -> String {
        format!("{}.{}", self.robot.modules[self.links[link].0].name, self.link(link).name)
    }

    /// Returns the name of a joint, as in plan files.
    pub(super) fn joint_name(&self, joint: usize) -> String {
        self.robot.joint_name(self.joints[joint])
    }

    /// Returns the range of a joint, rad or m, as (least, greatest), the second larger by at least 1e-6 as MuJoCo
    /// requires; `None` if the joint has no limits of position.
    pub(super) fn range(&self, joint: usize) -> Option<[f64; 2]> {
        let (low, high) = self.limits(joint).range?;
        Some([low, high.max(low + RANGE_MIN)])
    }

    /// Returns the limits of position, speed, acceleration and effort of the joint of this index; no limits for a bond
    /// without a hinge.
    pub(super) fn limits(&self, joint: usize) -> Limits {
        match self.joints[joint] {
            JointOwner::Module { module, joint } => self.robot.module_type(module).joints[joint].limits,
            JointOwner::Bond(bond) => self.robot.hinge(bond).map_or(Limits::default(), |hinge| hinge.limits),
        }
    }

    /// Returns the stiffness of a joint's servo, N·m/rad, or N/m if it slides, and what is stated of the servo.
    pub(super) fn servo(&self, joint: usize) -> (f64, Servo) {
        let owner = self.joints[joint];
        (self.robot.servo_stiffness(owner), self.robot.servo(owner))
    }

    /// Returns true if a joint is prismatic, so that its positions are in m; false if they are in rad.
    pub(super) fn slides(&self, joint: usize) -> bool {
        self.robot.slides(self.joints[joint])
    }

    /// Returns true if a joint has an actuator in the model: it is not passive, not fixed, and follows no other joint.
    /// Joints that share motors have one each, and hinges of bonds always have one.
    pub(super) fn is_driven(&self, joint: usize) -> bool {
        self.robot.takes_commands(self.joints[joint])
    }
}
