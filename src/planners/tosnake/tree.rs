//! The kinematic tree: shoes as bodies, joined by the joints of modules and by a spanning tree of the
//! closed bonds; forward kinematics, and the axes from which columns of the Jacobian are made.
//!
//! Bodies are indexed in depth-first order, so that every subtree is a contiguous range of indices: a
//! joint moves one range against all the rest.

use super::robot::{ALPHA, BETA, DOCKS, GAMMA, Robot, across, across_by_sines, mate};
use crate::geometry::{RigidTransform, Vec3, sin_cos};

/// The kinematic tree over the shoes of a robot, whose edges are modules and closed bonds.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The shoe at each index of the tree's order, which is depth-first from the root at 0; a shoe is named by its
    /// number as by [`Dock::shoe`](super::robot::Dock::shoe), twice the module plus one for shoe B.
    pub shoe: Vec<usize>,
    /// The index in the tree's order of each shoe, by its number: the inverse of `shoe`.
    pub index: Vec<usize>,
    /// The index in the tree's order of the parent of the shoe at each index; 0 for the root, whose index is 0.
    pub parent: Vec<usize>,
    /// The end of each shoe's subtree: for each index of the tree's order, one past the last index of the subtree.
    pub end: Vec<usize>,
    link: Vec<Link>,
    /// The indices in [`Robot::bonds`] of the closed bonds that are not of the tree, ascending: each closes a
    /// kinematic loop.
    pub closing: Vec<usize>,
}

/// The connection of a shoe to its parent.
#[derive(Clone, Copy, Debug)]
enum Link {
    /// None: it is the root.
    Root,
    /// The link between the two shoes of one module.
    Module,
    /// Both are docked to each other.
    Mate {
        bond: usize,
        /// The pose of the shoe in the frame of its parent.
        pose: RigidTransform,
    },
}

/// A joint of a module, with its position in the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointRef {
    /// The index in the tree's order of that shoe of the module whose parent is the module's other shoe.
    pub child: usize,
    /// The index of the module in [`Robot::joints`].
    pub module: usize,
    /// The joint of the module, 0 to 2: [`ALPHA`], [`BETA`] or [`GAMMA`].
    pub joint: usize,
}

/// The shoes that move against the root while the joints of some modules turn.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Their indices in the tree's order, ascending.
    pub shoes: Vec<usize>,
    /// Those that are placed one after the other, each by its pose in the frame of one before: (index, that of the one
    /// before), ascending.
    chain: Vec<(usize, usize)>,
    /// The pose of each of the chain in the frame of the one before.
    steps: Vec<RigidTransform>,
    /// Those of the chain whose own joints turn; all others move as the ones before them do.
    turned: Vec<Turned>,
    /// Those whose centres alone are placed: (index, that of the first shoe of the rigid part, centre in its frame).
    centres: Vec<(usize, usize, Vec3)>,
}

/// A shoe that its own joints turn against its parent, the other shoe of its module.
#[derive(Clone, Debug)]
struct Turned {
    /// The place in the chain.
    place: usize,
    module: usize,
    /// The joints in the order of [`across`]: that of the parent, that of the shoe, and gamma.
    order: [usize; 3],
    /// The positions of these joints, rad, for which `sines` holds (sine, cosine).
    known: [f64; 3],
    sines: [(f64, f64); 3],
}

impl Carried {
    /// Recomputes the poses of these shoes, or of some the centres alone (see `Carried::by_parts`); the others stay. `joints`:
    /// rad, by module; poses in pitches, in the frame of the root, in the tree's order.
    pub fn poses(&mut self, joints: &[[f64; 3]], poses: &mut [RigidTransform]) {
        for turned in &mut self.turned {
            // Often one of the three joints turns.
            for (k, joint) in turned.order.into_iter().enumerate() {
                let position = joints[turned.module][joint];
                if position != turned.known[k] {
                    (turned.known[k], turned.sines[k]) = (position, sin_cos(position));
                }
            }
            self.steps[turned.place] = across_by_sines(turned.sines);
        }
        for (&(index, before), step) in self.chain.iter().zip(&self.steps) {
            poses[index] = poses[before].then(step);
        }
        for (index, first, centre) in &self.centres {
            poses[*index].translation = poses[*first].rotation * centre + poses[*first].translation;
        }
    }

    /// Returns the same shoes, with the centres alone of those placed that bear no shoe which its own joints turn, each from
    /// the first shoe of its rigid part: the rotations in poses are then not theirs. `parts`: those that
    /// [`Tree::parts`] returns for the modules that turn; `poses`: of all shoes at any joint positions.
    pub(super) fn by_parts(self, tree: &Tree, parts: &[usize], poses: &[RigidTransform]) -> Carried {
        let mut bears = vec![false; tree.shoes()];
        self.turned.iter().for_each(|turned| bears[tree.parent[self.chain[turned.place].0]] = true);
        let mut split = Carried { chain: Vec::new(), steps: Vec::new(), ..self };
        let mut turned = split.turned.iter_mut();
        for (&(index, before), step) in self.chain.iter().zip(&self.steps) {
            let first = parts[index];
            let back = poses[first].rotation.transpose();
            let translation = back * (poses[index].translation - poses[first].translation);
            if index == first {
                turned.next().expect("a part begins where joints turn").place = split.chain.len();
                split.chain.push((index, before));
                split.steps.push(*step);
            } else if bears[index] {
                split.chain.push((index, first));
                split.steps.push(RigidTransform { rotation: back * poses[index].rotation, translation });
            } else {
                split.centres.push((index, first, translation));
            }
        }
        split
    }
}

impl Tree {
    /// Grows the tree of a robot from shoe A of the module `root`, over bonds chosen by breadth-first search, so that
    /// branches are short. Returns `None` if closed bonds do not connect all modules. Panics if there is no such
    /// module.
    pub fn grow(robot: &Robot, root: usize) -> Option<Tree> {
        let at = robot.bond_at();
        // Breadth-first search chooses the bonds of the tree, so that branches are short.
        let in_tree = spanning(robot, &at, root)?;
        let shoes = 2 * robot.modules();
        let mut tree = Tree {
            shoe: Vec::with_capacity(shoes),
            index: vec![0; shoes],
            parent: Vec::with_capacity(shoes),
            end: vec![0; shoes],
            link: Vec::with_capacity(shoes),
            closing: robot.held().map(|(bond, _)| bond).filter(|bond| !in_tree[*bond]).collect(),
        };
        // Depth-first search gives the order.
        let mut open = vec![(2 * root, 0, Link::Root)];
        while let Some((shoe, parent, link)) = open.pop() {
            let index = tree.shoe.len();
            tree.shoe.push(shoe);
            tree.index[shoe] = index;
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
                open.push((far.shoe(), index, Link::Mate { bond, pose }));
            }
            if !matches!(link, Link::Module) {
                open.push((shoe ^ 1, index, Link::Module));
            }
        }
        // Subtrees end where their last child's does.
        for index in (0..shoes).rev() {
            tree.end[index] = tree.end[index].max(index + 1);
            let parent = tree.parent[index];
            tree.end[parent] = tree.end[parent].max(tree.end[index]);
        }
        Some(tree)
    }

    /// Returns the number of shoes of the robot, two for each module.
    pub fn shoes(&self) -> usize {
        self.shoe.len()
    }

    /// Replaces `poses` by the poses of all shoes, in the tree's order, in pitches, in the frame of the root (forward
    /// kinematics); `joints`: rad, by module.
    pub fn poses(&self, joints: &[[f64; 3]], poses: &mut Vec<RigidTransform>) {
        self.carried(|_| false, joints, poses);
    }

    /// Returns the pose of a shoe in the frame of its parent, that of the root in its own.
    fn step(&self, index: usize, joints: &[[f64; 3]]) -> RigidTransform {
        match &self.link[index] {
            Link::Root => RigidTransform::identity(),
            Link::Mate { pose, .. } => *pose,
            Link::Module => {
                let [near, far, gamma] =
                    self.across_order(index).map(|joint| joints[self.shoe[index] / 2][joint]);
                across(near, far, gamma)
            }
        }
    }

    /// Returns the joints of the module of a shoe in the order in which [`across`] takes them from the module's other shoe.
    fn across_order(&self, index: usize) -> [usize; 3] {
        if self.shoe[index] % 2 == 1 { [ALPHA, BETA, GAMMA] } else { [BETA, ALPHA, GAMMA] }
    }

    /// Returns the shoes that move against the root when the joints of those modules move for whose index `turns` returns
    /// true. `joints`: the positions of all joints, rad, by module, where those of the other modules stay. Replaces `poses` by
    /// those of all shoes, as [`Tree::poses`] does.
    pub fn carried(
        &self,
        turns: impl Fn(usize) -> bool,
        joints: &[[f64; 3]],
        poses: &mut Vec<RigidTransform>,
    ) -> Carried {
        let mut moves = vec![false; self.shoes()];
        let mut carried = Carried {
            shoes: Vec::new(),
            chain: Vec::new(),
            steps: Vec::new(),
            turned: Vec::new(),
            centres: Vec::new(),
        };
        poses.clear();
        poses.push(RigidTransform::identity());
        for index in 1..self.shoes() {
            let step = self.step(index, joints);
            poses.push(poses[self.parent[index]].then(&step));
            let own = matches!(self.link[index], Link::Module) && turns(self.shoe[index] / 2);
            moves[index] = own || moves[self.parent[index]];
            if own {
                let (place, module, order) =
                    (carried.shoes.len(), self.shoe[index] / 2, self.across_order(index));
                let known = order.map(|joint| joints[module][joint]);
                carried.turned.push(Turned { place, module, order, known, sines: known.map(sin_cos) });
            }
            if moves[index] {
                carried.shoes.push(index);
                carried.chain.push((index, self.parent[index]));
                carried.steps.push(step);
            }
        }
        carried
    }

    /// Returns for each shoe, in the tree's order, the rigid part that it belongs to when the joints of those modules
    /// move for whose index `turns` returns true. A part is named by the least index in it: shoes of one part do not
    /// move against each other.
    pub fn parts(&self, turns: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut part = vec![0; self.shoes()];
        for index in 1..part.len() {
            let own = matches!(self.link[index], Link::Module) && turns(self.shoe[index] / 2);
            part[index] = if own { index } else { part[self.parent[index]] };
        }
        part
    }

    /// Returns the index in [`Robot::bonds`] of the bond by which the shoe at `index` of the tree's order is docked
    /// to its parent; `None` for the root, and where the parent is the other shoe of the module. Panics if there is
    /// no such index.
    pub fn bond(&self, index: usize) -> Option<usize> {
        match self.link[index] {
            Link::Mate { bond, .. } => Some(bond),
            Link::Root | Link::Module => None,
        }
    }

    /// Returns the closure residual of a bond, given by its index in [`Robot::bonds`]: the greatest absolute
    /// deviation of an entry of its second shoe's pose from the pose that the bond asks for, in pitches for positions
    /// and without unit for rotation matrices. `poses`: of the shoes, in the tree's order, in pitches. `robot`: the
    /// configuration of which it is a bond. Panics if there is no such bond.
    pub fn residual(&self, robot: &Robot, bond: usize, poses: &[RigidTransform]) -> f64 {
        let ends = robot.bonds[bond];
        let wanted = poses[self.index[ends.a.shoe()]].then(&mate(ends.a.face(), ends.turn, ends.b.face()));
        let found = &poses[self.index[ends.b.shoe()]];
        let turn = (wanted.rotation - found.rotation).amax();
        turn.max((wanted.translation - found.translation).amax())
    }

    /// Returns the joints between the shoe at `index` of the tree's order and its parent: alpha, beta and gamma if
    /// both are of one module, else none. Panics if there is no such index.
    pub fn joints_at(&self, index: usize) -> impl Iterator<Item = JointRef> {
        let module = self.shoe[index] / 2;
        let count = if matches!(self.link[index], Link::Module) { 3 } else { 0 };
        (0..count).map(move |joint| JointRef { child: index, module, joint })
    }

    /// Returns all joints of the robot, ascending by their child's index in the tree's order, then by joint.
    pub fn all_joints(&self) -> Vec<JointRef> {
        (0..self.shoes()).flat_map(|index| self.joints_at(index)).collect()
    }

    /// Returns (axis, point): the unit axis about which a joint turns the subtree of its child, and a point on it, in
    /// pitches, both in the frame of the root. The joint's column of the Jacobian of a point p of the subtree is `axis
    /// × (p - point)`, and of its angular velocity `axis`. `poses`: of the shoes, in the tree's order, in pitches, in
    /// the frame of the root.
    pub fn axis(&self, joint: JointRef, poses: &[RigidTransform]) -> (Vec3, Vec3) {
        let (child, parent) = (&poses[joint.child], &poses[self.parent[joint.child]]);
        let child_is_b = self.shoe[joint.child] % 2 == 1;
        let near = if child_is_b { ALPHA } else { BETA };
        if joint.joint == GAMMA {
            (child.translation - parent.translation, parent.translation)
        } else if joint.joint == near {
            (parent.rotation.column(0).into_owned(), parent.translation)
        } else {
            (-child.rotation.column(0), child.translation)
        }
    }

    /// Returns true if the shoe at `index` is in the subtree of the one at `root`, itself included; both are indices
    /// in the tree's order. Panics if `root` is not an index of the tree.
    pub fn is_in_subtree(&self, index: usize, root: usize) -> bool {
        (root..self.end[root]).contains(&index)
    }

    /// Returns the path along the tree from one shoe to another, both given by their indices in the tree's order.
    /// Panics if an index is none of the tree.
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
        Path { indices: up, top }
    }
}

/// A path through the tree between two shoes: up to their common ancestor, then down.
#[derive(Clone, Debug)]
pub struct Path {
    /// The indices in the tree's order of the shoes on the path, both ends included, from the first to the last.
    pub indices: Vec<usize>,
    /// The index in [`Path::indices`] of the common ancestor.
    pub top: usize,
}

/// Returns true, by bond, if a breadth-first search from a module takes it; `None` if it does not reach all.
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
