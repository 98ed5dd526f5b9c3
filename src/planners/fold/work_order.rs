//! Dynamic programming for the order of folding with the least work against gravity (Eq. 15 to 17).
//!
//! The root lies on the ground with its outside down. To fold hinge i when the set F has folded costs
//! `|PE(F + i) - PE(F)|`. Branches of the root move independently; within a branch every subset of its hinges
//! is a state of a dynamic program: `b 2^b` steps instead of `b!` orders. The changes telescope, so no order
//! goes below `|PE(all) - PE(none)|` of its branch; where the leaves-first order (Alg. 2) reaches that,
//! nothing more is computed.

use super::kinematics::about;
use super::layout::Layout;
use super::steps;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::turns::Turn;
use crate::geometry::Pose;

/// The greatest number of hinges of a branch of the root for which [`least_work`] visits all subsets.
pub const BRANCH_MAX: usize = 18;

/// An order of folding, one hinge after the other, with its work against gravity.
#[derive(Clone, Debug)]
pub struct WorkOrder {
    /// All faces but the root, as indices in [`Target::faces`], in the order in which their hinges fold.
    pub order: Vec<usize>,
    /// The work of the order (Eq. 17 of [Yao et al.](super)), J.
    pub work: f64,
    /// The lower bound on the work of all orders of the layout, J.
    pub bound: f64,
    /// True if it is proved that no order takes less work: always, unless a branch of the root has more than
    /// [`BRANCH_MAX`] hinges and neither usual order of the branch reaches its bound.
    pub optimal: bool,
}

/// Returns an order of little work against gravity (Eq. 17 of [Yao et al.](super)) of a layout whose root lies on the
/// ground with its outside down: the order of least work, by dynamic programming over subsets of hinges, branch by
/// branch of the root, unless a branch is too large for all subsets ([`BRANCH_MAX`]). Of such a branch it is the
/// better of leaves first and root first, which need not be the best; [`WorkOrder::optimal`] tells. `target`: the
/// surface that the layout is of; `weights`: by face, N.
pub fn least_work(target: &Target, layout: &Layout, weights: &[f64]) -> WorkOrder {
    let mut all = WorkOrder { order: Vec::new(), work: 0.0, bound: 0.0, optimal: true };
    for &child in &layout.children()[layout.root] {
        let branch = Branch::new(target, layout, weights, child);
        let part = branch.least();
        all.order.extend(part.order);
        all.work += part.work;
        all.bound += part.bound;
        all.optimal &= part.optimal;
    }
    all
}

/// Returns a lower bound on the work of all orders of a layout, J: the sum over the root's branches of the absolute
/// change of their potential energy; `weights`: by face, N. `target`: the surface that the layout is of.
pub fn bound(target: &Target, layout: &Layout, weights: &[f64]) -> f64 {
    let flat = super::kinematics::poses(target, layout, |_| false);
    let gain = |face: usize| {
        let level = height(target, layout, face, &flat[face]);
        weights[face] * (height(target, layout, face, &Pose::identity()) - level)
    };
    let branches = layout.children().swap_remove(layout.root);
    let of_branch = |child: usize| -> f64 {
        let below = (0..flat.len()).filter(|face| layout.is_above(child, *face));
        below.map(gain).sum::<f64>().abs()
    };
    branches.into_iter().map(of_branch).sum()
}

/// Returns the work of Eq. 17 of [Yao et al.](super) for an order of all faces but the root (indices in
/// [`Target::faces`]), J, computed step by step from the poses of all faces; `weights`: by face, N. `target` and
/// `layout`: the surface and how it is unfolded.
pub fn work(target: &Target, layout: &Layout, weights: &[f64], order: &[usize]) -> f64 {
    let mut folded = vec![false; target.faces.len()];
    let mut height = potential(target, layout, weights, &folded);
    let mut sum = 0.0;
    for &face in order {
        folded[face] = true;
        let next = potential(target, layout, weights, &folded);
        sum += (next - height).abs();
        height = next;
    }
    sum
}

/// Returns the work of Eq. 17 of [Yao et al.](super) for turns of hinges one after the other, J, as [`work`] does.
pub(super) fn work_of_turns(target: &Target, layout: &Layout, weights: &[f64], turns: &[Vec<Turn>]) -> f64 {
    let mut angles = vec![0.0; target.faces.len()];
    let lifted = |angles: &[f64]| {
        potential_at(target, layout, weights, &super::kinematics::poses_at(target, layout, |f| angles[f]))
    };
    let mut height = lifted(&angles);
    let mut sum = 0.0;
    for turn in turns.iter().flatten() {
        angles[turn.face] = turn.to;
        let next = lifted(&angles);
        sum += (next - height).abs();
        height = next;
    }
    sum
}

/// Returns the potential energy over the root's plane, J.
fn potential(target: &Target, layout: &Layout, weights: &[f64], folded: &[bool]) -> f64 {
    potential_at(target, layout, weights, &super::kinematics::poses(target, layout, |face| folded[face]))
}

/// Returns the potential energy over the root's plane of faces that are displaced so from the target, J.
fn potential_at(target: &Target, layout: &Layout, weights: &[f64], poses: &[Pose]) -> f64 {
    let faces = 0..target.faces.len();
    faces.map(|face| weights[face] * height(target, layout, face, &poses[face])).sum()
}

/// Returns the height of a face's centroid over the root's plane, m: against the root's outward normal.
fn height(target: &Target, layout: &Layout, face: usize, pose: &Pose) -> f64 {
    let centroid = pose * nalgebra::Point3::from(target.centroid(face));
    target.normal(layout.root).dot(&(target.centroid(layout.root) - centroid.coords))
}

/// The branch below one child of the root.
struct Branch {
    /// Its faces; bit i of a state is face i of these.
    faces: Vec<usize>,
    /// The bits of the path from the root to each face of the branch, the root's child first.
    paths: Vec<Vec<usize>>,
    /// The potential energy of each face of the branch by which bits of its path have folded, where all
    /// subsets are visited.
    potentials: Vec<Vec<f64>>,
    /// The leaves-first and the root-first order, with their work.
    known: Vec<(Vec<usize>, f64)>,
    bound: f64,
}

impl Branch {
    /// Sets up the branch of one child of the root, with its two usual orders and its bound.
    fn new(target: &Target, layout: &Layout, weights: &[f64], child: usize) -> Branch {
        let faces: Vec<usize> =
            layout.order.iter().copied().filter(|&face| layout.is_above(child, face)).collect();
        let bit = |face: usize| faces.iter().position(|f| *f == face).expect("paths stay in the branch");
        let mut paths: Vec<Vec<usize>> = Vec::new();
        for &face in &faces {
            let mut path = if face == child { Vec::new() } else { paths[bit(layout.parent[face])].clone() };
            path.push(paths.len());
            paths.push(path);
        }
        // The same work, with no weight elsewhere.
        let mut own = vec![0.0; target.faces.len()];
        faces.iter().for_each(|&face| own[face] = weights[face]);
        let heights = [vec![false; own.len()], vec![true; own.len()]]
            .map(|folded| potential(target, layout, &own, &folded));
        let in_branch = |steps: Vec<Vec<usize>>| -> Vec<usize> {
            steps.into_iter().flatten().filter(|face| faces.contains(face)).collect()
        };
        let known = [steps::leaves_first(layout), steps::root_first(layout)].map(|steps| {
            let order = in_branch(steps);
            let work = work(target, layout, &own, &order);
            (order, work)
        });
        let potentials = if faces.len() <= BRANCH_MAX {
            potentials(target, layout, weights, &faces, &paths)
        } else {
            vec![]
        };
        Branch { faces, paths, potentials, known: known.to_vec(), bound: (heights[1] - heights[0]).abs() }
    }

    /// Returns the order of least work of the branch, or the better usual order of a branch that is too large.
    fn least(&self) -> WorkOrder {
        let reached = |work: f64| work <= self.bound * (1.0 + TOLERANCES.work) + f64::MIN_POSITIVE;
        let best = self.known.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("there are two");
        if reached(self.known[0].1) || self.potentials.is_empty() {
            let (order, work) = if reached(self.known[0].1) { &self.known[0] } else { best };
            let optimal = reached(*work);
            return WorkOrder { order: order.clone(), work: *work, bound: self.bound, optimal };
        }
        let (order, work) = self.by_subsets();
        // Of equal orders one with the fewest steps: leaves first or root first, as the tree is high.
        let known = self.known.iter().find(|known| known.1 <= work * (1.0 + TOLERANCES.work));
        let order = known.map_or(order, |known| known.0.clone());
        WorkOrder { order, work, bound: work, optimal: true }
    }

    /// Returns the order of least work by dynamic programming over all subsets of the branch, with that work.
    fn by_subsets(&self) -> (Vec<usize>, f64) {
        let bits = self.faces.len();
        let energies: Vec<f64> = (0..1usize << bits).map(|set| self.energy(set)).collect();
        let mut least = vec![f64::INFINITY; 1 << bits];
        let mut last = vec![0u8; 1 << bits];
        least[0] = 0.0;
        for set in 0..1usize << bits {
            crate::interrupt::checkpoint();
            for bit in (0..bits).filter(|bit| set >> bit & 1 == 0) {
                let next = set | 1 << bit;
                let work = least[set] + (energies[next] - energies[set]).abs();
                if work < least[next] {
                    (least[next], last[next]) = (work, bit as u8);
                }
            }
        }
        let mut order = Vec::with_capacity(bits);
        let mut set = (1 << bits) - 1;
        while set != 0 {
            order.push(self.faces[last[set] as usize]);
            set &= !(1 << last[set]);
        }
        order.reverse();
        (order, least[(1 << bits) - 1])
    }

    /// Returns the potential energy of the branch, J, when the faces of a set of bits have folded.
    fn energy(&self, set: usize) -> f64 {
        let of_face = |(path, table): (&Vec<usize>, &Vec<f64>)| {
            let folded: usize = path.iter().enumerate().map(|(i, bit)| (set >> bit & 1) << i).sum();
            table[folded]
        };
        self.paths.iter().zip(&self.potentials).map(of_face).sum()
    }
}

/// Returns the potential energy of each face of the branch by which hinges of its path have folded.
fn potentials(
    target: &Target,
    layout: &Layout,
    weights: &[f64],
    faces: &[usize],
    paths: &[Vec<usize>],
) -> Vec<Vec<f64>> {
    let places = paths.iter().zip(faces).map(|(path, &face)| {
        // A face's pose is that of its path, which is walked from the root on.
        let mut poses = vec![Pose::identity()];
        for &bit in path {
            let hinge = &target.hinges[layout.hinge[faces[bit]].expect("no face of a branch is the root")];
            let turn = about(&hinge.point, hinge.axis_from(layout.parent[faces[bit]]), -hinge.angle);
            let level: Vec<Pose> = poses.iter().map(|pose| pose * turn).collect();
            // The bit of the newest hinge is the highest.
            poses = level.into_iter().chain(poses).collect();
        }
        poses.iter().map(|pose| weights[face] * height(target, layout, face, pose)).collect()
    });
    places.collect()
}
