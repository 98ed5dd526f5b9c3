//! Nodes of branch and bound that are open, in the order of best-first search.

use super::lagrangian::Multipliers;
use super::shortest_paths::Allowed;
use super::target::Arc;
use std::cmp::Ordering;
use std::rc::Rc;

/// The size of a node by its faces, bytes: a path shared with its parent, a cost, uses, arcs.
const FACE_BYTES: usize = 48;

/// A node of the branch and bound tree: all layouts of one root that use only the arcs still allowed.
pub(super) struct Node {
    /// The root of its layouts, an index in [`Target::faces`](super::target::Target::faces).
    pub(super) root: usize,
    /// The lower bound on the energy of its layouts, N·m for steps of one second.
    pub(super) bound: f64,
    /// The number of branchings before it, which orders nodes of equal bound.
    pub(super) number: u64,
    /// The paths of the node; `None` while only its bound is known.
    pub(super) ways: Option<NodePaths>,
}

/// The solution of the relaxed problem at a node: a shortest path to each face, with the multipliers.
pub(super) struct NodePaths {
    /// The arcs that are not left out.
    pub(super) allowed: Allowed,
    /// The shortest path to each face, by face: its arcs from the face back to the root.
    pub(super) paths: Vec<Rc<[Arc]>>,
    /// The cost of each path, by face, N·m for steps of one second.
    pub(super) costs: Vec<f64>,
    /// The multipliers from which the next ascent begins.
    pub(super) multipliers: Rc<Multipliers>,
    /// The length of the next step of an ascent, without unit: the factor of Polyak's step.
    pub(super) length: f64,
    /// True while another ascent may raise the bound further.
    pub(super) rising: bool,
    /// The number of paths that used each arc at the end of the last ascent; empty before the first.
    pub(super) uses: Vec<u32>,
}

/// The node of least bound is the greatest; of equal ones the newest, then that of the first root.
impl Ord for Node {
    fn cmp(&self, other: &Node) -> Ordering {
        let newest = self.number.cmp(&other.number);
        other.bound.total_cmp(&self.bound).then(newest).then(other.root.cmp(&self.root))
    }
}
impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Node) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Node {
    fn eq(&self, other: &Node) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Node {}

impl Node {
    /// Returns an estimate of the memory that the node takes, bytes; 0 while only its bound is known.
    pub(super) fn size(&self) -> usize {
        let Some(ways) = &self.ways else { return 0 };
        FACE_BYTES * ways.paths.len() + size_of_val(&*ways.multipliers)
    }
}
