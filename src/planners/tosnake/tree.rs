//! The tree of shoes over the bonds that hold, and where everything is.
//!
//! Shoes are numbered in the order of a walk down the tree, so that all that hangs on a shoe is one
//! stretch of numbers: what a joint moves is a stretch, or all the rest.

use super::robot::{ALPHA, BETA, DOCKS, GAMMA, Robot, across, mate};
use crate::geometry::{RigidTransform, Vec3};

#[derive(Clone, Debug)]
pub struct Tree {
    /// The shoe of each place in the walk.
    pub shoe: Vec<usize>,
    /// The place of each shoe.
    pub place: Vec<usize>,
    /// The place of the parent; 0 for the first.
    pub parent: Vec<usize>,
    /// One past the last place of what hangs on a shoe.
    pub end: Vec<usize>,
    link: Vec<Link>,
    /// Bonds that hold and are not of the tree.
    pub closing: Vec<usize>,
}

/// How a shoe hangs on its parent.
#[derive(Clone, Copy, Debug)]
enum Link {
    Root,
    /// As the other shoe of the module.
    Module,
    /// By a bond.
    Mate {
        bond: usize,
        pose: RigidTransform,
    },
}

/// A joint that the tree's motion knows: of the module whose shoe is at `place`, against its other shoe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointRef {
    /// The place of the shoe that hangs on the other.
    pub place: usize,
    pub module: usize,
    /// [`ALPHA`], [`BETA`] or [`GAMMA`].
    pub joint: usize,
}

impl Tree {
    /// The tree from a root module; `None` where the modules do not hang together.
    pub fn grow(robot: &Robot, root: usize) -> Option<Tree> {
        let at = robot.bond_at();
        // Breadth first decides which bonds are of the tree, so that branches are short.
        let in_tree = spanning(robot, &at, root)?;
        let shoes = 2 * robot.modules();
        let mut tree = Tree {
            shoe: Vec::with_capacity(shoes),
            place: vec![0; shoes],
            parent: Vec::with_capacity(shoes),
            end: vec![0; shoes],
            link: Vec::with_capacity(shoes),
            closing: robot.held().map(|(bond, _)| bond).filter(|bond| !in_tree[*bond]).collect(),
        };
        let mut open = vec![(2 * root, 0, Link::Root)];
        while let Some((shoe, parent, link)) = open.pop() {
            let place = tree.shoe.len();
            tree.shoe.push(shoe);
            tree.place[shoe] = place;
            tree.parent.push(parent);
            tree.link.push(link);
            let side = shoe % 2 * (DOCKS / 2);
            for (dock, bond) in at[shoe / 2].iter().enumerate().skip(side).take(DOCKS / 2) {
                let Some(bond) = bond.filter(|bond| in_tree[*bond]) else { continue };
                if matches!(link, Link::Mate { bond: by, .. } if by == bond) {
                    continue;
                }
                let ends = robot.bonds[bond];
                let here = (ends.a.module, ends.a.dock) == (shoe / 2, dock);
                let (near, far) = if here { (ends.a, ends.b) } else { (ends.b, ends.a) };
                let pose = mate(near.face(), ends.turn, far.face());
                open.push((far.shoe(), place, Link::Mate { bond, pose }));
            }
            if !matches!(link, Link::Module) {
                open.push((shoe ^ 1, place, Link::Module));
            }
        }
        for place in (0..shoes).rev() {
            tree.end[place] = tree.end[place].max(place + 1);
            let parent = tree.parent[place];
            tree.end[parent] = tree.end[parent].max(tree.end[place]);
        }
        Some(tree)
    }

    pub fn shoes(&self) -> usize {
        self.shoe.len()
    }

    /// Poses of all shoes by place, the first at the identity.
    pub fn poses(&self, joints: &[[f64; 3]], poses: &mut Vec<RigidTransform>) {
        poses.clear();
        for place in 0..self.shoes() {
            poses.push(self.pose(place, joints, poses));
        }
    }

    /// Of some shoes, in order of place; the others are where they were.
    pub fn poses_of(&self, moved: &[usize], joints: &[[f64; 3]], poses: &mut [RigidTransform]) {
        for &place in moved {
            poses[place] = self.pose(place, joints, poses);
        }
    }

    fn pose(&self, place: usize, joints: &[[f64; 3]], poses: &[RigidTransform]) -> RigidTransform {
        match &self.link[place] {
            Link::Root => RigidTransform::identity(),
            Link::Mate { pose, .. } => poses[self.parent[place]].then(pose),
            Link::Module => {
                let shoe = self.shoe[place];
                let [near, far] = if shoe % 2 == 1 { [ALPHA, BETA] } else { [BETA, ALPHA] };
                let q = &joints[shoe / 2];
                poses[self.parent[place]].then(&across(q[near], q[far], q[GAMMA]))
            }
        }
    }

    /// The places that modules carry whose joints turn, in order; the others stay where the root is.
    pub fn carried(&self, turns: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut carried = vec![false; self.shoes()];
        for place in 1..self.shoes() {
            let own = matches!(self.link[place], Link::Module) && turns(self.shoe[place] / 2);
            carried[place] = own || carried[self.parent[place]];
        }
        (0..self.shoes()).filter(|&place| carried[place]).collect()
    }

    /// By place: balls of one number do not move against each other when modules turn.
    pub fn parts(&self, turns: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut part = vec![0; self.shoes()];
        for place in 1..part.len() {
            let own = matches!(self.link[place], Link::Module) && turns(self.shoe[place] / 2);
            part[place] = if own { place } else { part[self.parent[place]] };
        }
        part
    }

    /// The bond by which a shoe hangs on its parent.
    pub fn bond(&self, place: usize) -> Option<usize> {
        match self.link[place] {
            Link::Mate { bond, .. } => Some(bond),
            Link::Root | Link::Module => None,
        }
    }

    /// How far two docked shoes are from where the bond wants them: entries of the matrices, at most.
    pub fn missing(&self, robot: &Robot, bond: usize, poses: &[RigidTransform]) -> f64 {
        let ends = robot.bonds[bond];
        let wanted = poses[self.place[ends.a.shoe()]].then(&mate(ends.a.face(), ends.turn, ends.b.face()));
        let found = &poses[self.place[ends.b.shoe()]];
        let turn = (wanted.rotation - found.rotation).amax();
        turn.max((wanted.translation - found.translation).amax())
    }

    /// The joints between a shoe and its parent: three where the two are one module's.
    pub fn joints_at(&self, place: usize) -> impl Iterator<Item = JointRef> {
        let module = self.shoe[place] / 2;
        let count = if matches!(self.link[place], Link::Module) { 3 } else { 0 };
        (0..count).map(move |joint| JointRef { place, module, joint })
    }

    /// All joints of the robot.
    pub fn all_joints(&self) -> Vec<JointRef> {
        (0..self.shoes()).flat_map(|place| self.joints_at(place)).collect()
    }

    /// The axis about which a joint turns what hangs on its shoe, and a point on it.
    pub fn axis(&self, joint: JointRef, poses: &[RigidTransform]) -> (Vec3, Vec3) {
        let (child, parent) = (&poses[joint.place], &poses[self.parent[joint.place]]);
        let child_is_b = self.shoe[joint.place] % 2 == 1;
        let near = if child_is_b { ALPHA } else { BETA };
        if joint.joint == GAMMA {
            (child.translation - parent.translation, parent.translation)
        } else if joint.joint == near {
            (parent.rotation.column(0).into_owned(), parent.translation)
        } else {
            (-child.rotation.column(0), child.translation)
        }
    }

    /// Whether the shoe at a place hangs on the one at another (or is it).
    pub fn hangs_on(&self, place: usize, on: usize) -> bool {
        (on..self.end[on]).contains(&place)
    }

    /// The places from one to another along the tree, both included.
    pub fn path(&self, from: usize, to: usize) -> Path {
        let mut up = vec![from];
        let mut down = vec![to];
        let (mut a, mut b) = (from, to);
        while a != b {
            if a > b {
                a = self.parent[a];
                up.push(a);
            } else {
                b = self.parent[b];
                down.push(b);
            }
        }
        down.pop();
        let top = up.len() - 1;
        up.extend(down.into_iter().rev());
        Path { places: up, top }
    }
}

/// A way through the tree: up to the place `places[top]`, then down.
#[derive(Clone, Debug)]
pub struct Path {
    pub places: Vec<usize>,
    pub top: usize,
}

/// Which bonds a breadth-first walk from a module takes.
fn spanning(robot: &Robot, at: &[[Option<usize>; DOCKS]], root: usize) -> Option<Vec<bool>> {
    let mut taken = vec![false; robot.bonds.len()];
    let mut reached = vec![false; robot.modules()];
    let mut queue = vec![root];
    reached[root] = true;
    let mut next = 0;
    while next < queue.len() {
        let module = queue[next];
        // In order of bond, as everywhere.
        let mut bonds: Vec<usize> = at[module].iter().flatten().copied().collect();
        bonds.sort_unstable();
        for bond in &bonds {
            let Some(ends) = robot.bonds.get(*bond) else { continue };
            let other = if ends.a.module == module { ends.b.module } else { ends.a.module };
            if !reached[other] {
                reached[other] = true;
                taken[*bond] = true;
                queue.push(other);
            }
        }
        next += 1;
    }
    (queue.len() == robot.modules()).then_some(taken)
}
