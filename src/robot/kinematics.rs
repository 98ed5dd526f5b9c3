//! Forward kinematics: the poses of all links from the positions of the joints.
//!
//! An [`Assembly`] is compiled once, for a root and the bonds that hold, into one [`Step`] per link,
//! parents first. Links of all modules are numbered in order of module, then of link.

use super::assembly::{Assembly, JointOwner, PortRef};
use super::step::{Motion, Step, driven};
use super::tree::{self, Tree};
use crate::geometry::pose::turned;
use crate::geometry::{Pose, Vec3};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// The forward kinematics of an assembly with a fixed set of bonds that hold: the spanning tree from a root, and one
/// step for each link. Links and joints go by numbers among those of the whole assembly.
#[derive(Clone, Debug)]
pub struct Kinematics {
    /// The index in [`Assembly::modules`] of the module whose body carries all others.
    pub root: usize,
    /// The spanning tree of modules over the bonds that hold.
    pub tree: Tree,
    /// One step for every link that is connected with the root but the root's body itself, parents before children.
    /// Links are named by their numbers ([`Kinematics::link`]).
    pub steps: Vec<Step>,
    /// Index of the first link of each module, and the number of links at the end.
    first_link: Vec<usize>,
    /// Index of the first joint of each module, and the number of modules' joints at the end.
    first_joint: Vec<usize>,
    /// The number of joints of the assembly, hinges of bonds included.
    joint_count: usize,
    /// The joint of each bond; `None` for a bond without a hinge.
    hinge_joint: Vec<Option<usize>>,
    /// Index in `steps` of each link's own step; `None` for the root and for loose links.
    step_of: Vec<Option<usize>>,
}

/// The closure error of a bond that closes a kinematic loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// The index of the bond in [`Assembly::bonds`].
    pub bond: usize,
    /// The distance of the second port from its position in a perfect mate, m.
    pub distance: f64,
    /// The angle between the orientation of the second port and that in a perfect mate, rad, 0 to π.
    pub angle: f64,
}

impl Kinematics {
    /// Compiles `robot` with the bonds for which `holds` is true, seen from the module of index `root`. Panics
    /// unless `holds` has one flag for every bond, and if there is no such module.
    pub fn new(robot: &Assembly, holds: &[bool], root: usize) -> Kinematics {
        assert_eq!(holds.len(), robot.bonds.len(), "one flag for every bond");
        let first_link = sums(robot, |module| robot.module_type(module).links.len());
        let first_joint = sums(robot, |module| robot.module_type(module).joints.len());
        let mut hinges = robot.joints().enumerate().filter_map(|(id, owner)| match owner {
            JointOwner::Bond(bond) => Some((bond, id)),
            JointOwner::Module { .. } => None,
        });
        let mut hinge_joint = vec![None; robot.bonds.len()];
        hinges.by_ref().for_each(|(bond, id)| hinge_joint[bond] = Some(id));
        let tree = tree::grow(robot, holds, root);
        let links = first_link[robot.modules.len()];
        let mut compiled = Kinematics {
            root,
            tree: Tree { order: vec![], closing: vec![], loose: vec![] },
            steps: Vec::with_capacity(links),
            first_link,
            first_joint,
            joint_count: robot.joints().count(),
            hinge_joint,
            step_of: vec![None; links],
        };
        for &(module, bond) in &tree.order {
            compiled.add_module(robot, module, bond);
        }
        compiled.tree = tree;
        compiled
    }

    /// Returns the number of links of all modules, also of those that are not connected with the root.
    pub fn link_count(&self) -> usize {
        self.step_of.len()
    }

    /// Returns the number of joints of the assembly, hinges of bonds included.
    pub fn joint_count(&self) -> usize {
        self.joint_count
    }

    /// Returns the number of a module's link among all links, from 0, which are numbered module by module; `module` is
    /// the index of the module, `link` that of the link in the module. The indices are not checked: one out of range
    /// may give the number of another link, or panic.
    pub fn link(&self, module: usize, link: usize) -> usize {
        self.first_link[module] + link
    }

    /// Returns the numbers among all links of the links of a module, given by its index. Panics if there is no such
    /// module.
    pub fn links_of(&self, module: usize) -> Range<usize> {
        self.first_link[module]..self.first_link[module + 1]
    }

    /// Returns the index in [`Assembly::modules`] of the module of a link, given by its number among all links; the
    /// number of modules for a number that is no link's.
    pub fn module_of(&self, link: usize) -> usize {
        self.first_link.partition_point(|&first| first <= link) - 1
    }

    /// Returns the number, from 0, of a module's joint among all joints, that of its [`super::JointId`]; `module` is
    /// the index of the module, `joint` that of the joint in the module. The indices are not checked: one out of range
    /// may give the number of another joint, or panic.
    pub fn joint(&self, module: usize, joint: usize) -> usize {
        self.first_joint[module] + joint
    }

    /// Returns the number among all joints, that of its [`super::JointId`], of the hinge of the bond of this index;
    /// `None` if the bond does not turn. Panics if there is no such bond.
    pub fn hinge(&self, bond: usize) -> Option<usize> {
        self.hinge_joint[bond]
    }

    /// Returns the step from a link's parent to the link, given by its number; `None` for the root's body and for
    /// links that are not connected with it. Panics if there is no such link.
    pub fn step(&self, link: usize) -> Option<&Step> {
        self.step_of[link].map(|index| &self.steps[index])
    }

    /// Iterates over the steps from a link, given by its number, up to the root: the link's own first. Nothing for the
    /// root's body and for links that are not connected with it. Panics if there is no such link.
    pub fn ancestors(&self, link: usize) -> impl Iterator<Item = &Step> {
        std::iter::successors(self.step(link), |step| self.step(step.parent))
    }

    /// Returns (step, sign) of two links, given by their numbers, that are neighbours in the tree, such as those that
    /// follow each other on a [`path`](Self::path): the step between them, and +1 where it leads from the first to the
    /// second, -1 where it leads back. Panics if the links are not neighbours.
    pub fn step_between(&self, from: usize, to: usize) -> (&Step, f64) {
        let down = self.step(to).filter(|step| step.parent == from).map(|step| (step, 1.0));
        let up = || self.step(from).filter(|step| step.parent == to).map(|step| (step, -1.0));
        down.or_else(up).expect("the links are neighbours in the tree")
    }

    /// Writes the world poses of all links, `X_WL`, by their numbers, with the root module's body at `X_WR`. `joints`
    /// holds the position (rad or m) of each joint by [`super::JointId`]. The entries of `out` of links that are not
    /// connected with the root stay as they are. Panics if `joints` or `out` is too short.
    pub fn link_poses(&self, joints: &[f64], X_WR: &Pose, out: &mut [Pose]) {
        crate::interrupt::checkpoint();
        out[self.first_link[self.root]] = *X_WR;
        for step in &self.steps {
            out[step.link] = step.child_pose(&out[step.parent], joints);
        }
    }

    /// Writes the world poses of all links to `out`, as [`link_poses`](Self::link_poses) does, with the body of the
    /// module of index `base` at `X_WB`, which need not be the root but must be connected with it. `joints`: the
    /// position (rad or m) of each joint by [`super::JointId`]. Panics if `joints` or `out` is too short.
    pub fn link_poses_from(&self, base: usize, joints: &[f64], X_WB: &Pose, out: &mut [Pose]) {
        self.link_poses(joints, &Pose::identity(), out);
        let X_WR = X_WB * out[self.link(base, 0)].inverse();
        self.link_poses(joints, &X_WR, out);
    }

    /// Returns the world pose of the module of this index, that of its body (the first link), from the world poses of
    /// all links, by their numbers. Panics if there is no such module.
    pub fn module_pose(&self, module: usize, poses: &[Pose]) -> Pose {
        poses[self.link(module, 0)]
    }

    /// Returns the number of the link of a port among all links. `robot`: the assembly that was compiled. Panics if
    /// the assembly has no such port.
    pub fn port_link(&self, robot: &Assembly, port: PortRef) -> usize {
        self.link(port.module, robot.module_type(port.module).ports[port.port].link)
    }

    /// Returns the world pose of a port, `X_WP`, from the world poses of all links, by their numbers. `robot`: the
    /// assembly that was compiled. Panics if the assembly has no such port.
    pub fn port_pose(&self, robot: &Assembly, port: PortRef, poses: &[Pose]) -> Pose {
        poses[self.port_link(robot, port)] * robot.module_type(port.module).ports[port.port].pose
    }

    /// Returns the numbers of the links from `a` to `b` along the tree, both included, in order; `None` if bonds do
    /// not connect them.
    pub fn path(&self, a: usize, b: usize) -> Option<Vec<usize>> {
        let to_root = |link: usize| {
            let parents = self.ancestors(link).map(|step| step.parent);
            std::iter::once(link).chain(parents).collect::<Vec<_>>()
        };
        let (mut up, mut down) = (to_root(a), to_root(b));
        if up.last() != down.last() {
            return None;
        }
        let mut meeting = None;
        while let (Some(x), Some(y)) = (up.last(), down.last()) {
            if x != y {
                break;
            }
            meeting = up.pop();
            down.pop();
        }
        up.extend(meeting);
        up.extend(down.into_iter().rev());
        Some(up)
    }

    /// Returns (centre, mass) of the links that are connected with the root: their centre of mass in the world, m, and
    /// their mass, kg; if they have no mass, the world's origin and 0. `poses` are the world poses of all links, by
    /// their numbers. `robot`: the assembly that was compiled.
    pub fn centre_of_mass(&self, robot: &Assembly, poses: &[Pose]) -> (Vec3, f64) {
        let (mut moment, mut mass) = (Vec3::zeros(), 0.0);
        for &(module, _) in &self.tree.order {
            for (link, declared) in self.links_of(module).zip(&robot.module_type(module).links) {
                moment += poses[link].transform_point(&declared.com.into()).coords * declared.mass;
                mass += declared.mass;
            }
        }
        (if mass > 0.0 { moment / mass } else { moment }, mass)
    }

    /// Returns the closure errors (m, rad) of the bonds that close loops, ascending by bond. `joints`: the positions
    /// (rad or m) of all joints, by [`super::JointId`]; `poses`: the world poses of all links at these positions, by
    /// their numbers. `robot`: the assembly that was compiled.
    pub fn residuals(&self, robot: &Assembly, joints: &[f64], poses: &[Pose]) -> Vec<Residual> {
        self.tree.closing.iter().map(|&bond| self.residual(robot, bond, joints, poses)).collect()
    }

    /// Returns the closure error of the bond of this index, which may be open: the distance (m) and the angle (rad) of
    /// its second port from a perfect mate with the first. `poses` are the world poses of all links, by their numbers;
    /// `joints` (rad or m, by [`super::JointId`]) matter only for the bond's own hinge. `robot`: the assembly that was
    /// compiled. Panics if there is no such bond.
    pub fn residual(&self, robot: &Assembly, bond: usize, joints: &[f64], poses: &[Pose]) -> Residual {
        let Pair { p, q } = self.mated(robot, bond, joints, poses);
        let error = p.inverse() * q;
        Residual { bond, distance: error.translation.vector.norm(), angle: error.rotation.angle() }
    }

    /// Returns the world poses of the second port of a bond: that of a perfect mate with the first, and the actual
    /// one.
    fn mated(&self, robot: &Assembly, bond: usize, joints: &[f64], poses: &[Pose]) -> Pair {
        let declared = &robot.bonds[bond];
        let hinge = robot.hinge(bond).zip(self.hinge_joint[bond]);
        let open = hinge.map_or(Pose::identity(), |(hinge, joint)| turned(hinge.axis, joints[joint]));
        let wanted = self.port_pose(robot, declared.a, poses) * open * mate(robot, bond);
        Pair { p: wanted, q: self.port_pose(robot, declared.b, poses) }
    }

    /// Adds the steps of a module's links, from the link that the bond holds outwards.
    fn add_module(&mut self, robot: &Assembly, module: usize, bond: Option<usize>) {
        let kind = robot.module_type(module);
        let entry = bond.map_or(0, |bond| {
            let (parent, child) = self.across(robot, bond, module);
            self.add_bond(robot, bond, parent, child);
            kind.ports[child.port].link
        });
        let mut placed = vec![false; kind.links.len()];
        placed[entry] = true;
        let mut frontier = vec![entry];
        while let Some(from) = frontier.pop() {
            for index in 0..kind.joints.len() {
                let joint = &kind.joints[index];
                let (to, forward) = match (joint.parent == from, joint.child == from) {
                    (true, _) => (joint.child, true),
                    (_, true) => (joint.parent, false),
                    _ => continue,
                };
                if !placed[to] {
                    placed[to] = true;
                    frontier.push(to);
                    self.add_joint(robot, module, index, forward);
                }
            }
        }
    }

    fn add_joint(&mut self, robot: &Assembly, module: usize, index: usize, forward: bool) {
        let kind = robot.module_type(module);
        let joint = &kind.joints[index];
        let (from, to) = if forward { (joint.parent, joint.child) } else { (joint.child, joint.parent) };
        let X_JM = joint.pose.inverse();
        let sign = if forward { 1.0 } else { -1.0 };
        let motion = Motion::new(joint.kind, joint.axis * sign);
        let terms = driven(kind, index, self.first_joint[module]);
        let (X_JA, X_JB) = (X_JM * kind.links[from].pose, X_JM * kind.links[to].pose);
        self.push(Step::new(self.link(module, from), self.link(module, to), &X_JA, &X_JB, motion, terms));
    }

    /// Returns the ports of a bond, the parent's in the tree first.
    fn across(&self, robot: &Assembly, bond: usize, child: usize) -> (PortRef, PortRef) {
        let bond = &robot.bonds[bond];
        if bond.b.module == child { (bond.a, bond.b) } else { (bond.b, bond.a) }
    }

    /// Adds the step over a bond. The hinge turns the frame of port `a` of the bond, whichever side the
    /// parent is on.
    fn add_bond(&mut self, robot: &Assembly, bond: usize, parent: PortRef, child: PortRef) {
        let declared = robot.bonds[bond];
        let port = |at: PortRef| &robot.module_type(at.module).ports[at.port];
        let X_PA = port(declared.a).pose.inverse();
        let X_PB = mate(robot, bond) * port(declared.b).pose.inverse();
        let forward = declared.a == parent;
        let sign = if forward { 1.0 } else { -1.0 };
        let (X_Pparent, X_Pchild) = if forward { (X_PA, X_PB) } else { (X_PB, X_PA) };
        let (motion, terms) = match robot.hinge(bond).zip(self.hinge_joint[bond]) {
            Some((hinge, joint)) => (Motion::revolute(hinge.axis * sign), vec![(joint, 1.0)]),
            None => (Motion::Fixed, vec![]),
        };
        let (from, to) = (self.port_link(robot, parent), self.port_link(robot, child));
        self.push(Step::new(from, to, &X_Pparent, &X_Pchild, motion, terms));
    }

    fn push(&mut self, step: Step) {
        self.step_of[step.link] = Some(self.steps.len());
        self.steps.push(step);
    }
}

/// The world poses of a bond's second port: in a perfect mate, and the actual one.
struct Pair {
    p: Pose,
    q: Pose,
}

/// Returns the pose `X_PQ` of the second port in the frame of the first for a bond (by index) whose hinge, if it has
/// one, is at zero: `Rz(180°) · Rx(turn · 360° / turns)`, and then its misalignment ([`Assembly::misalignments`]).
/// `robot`: the assembly. Panics if there is no such bond.
pub fn mate(robot: &Assembly, bond: usize) -> Pose {
    let declared = &robot.bonds[bond];
    let turns = f64::from(robot.connector(declared.a).turns);
    let perfect = turned(Vec3::z(), PI) * turned(Vec3::x(), TAU * f64::from(declared.turn) / turns);
    if robot.misalignments.is_empty() { perfect } else { perfect * robot.misalignment(bond) }
}

/// Returns running sums over the modules, from 0 to the whole.
fn sums(robot: &Assembly, count: impl Fn(usize) -> usize) -> Vec<usize> {
    let mut sums = vec![0];
    for module in 0..robot.modules.len() {
        sums.push(sums[module] + count(module));
    }
    sums
}
