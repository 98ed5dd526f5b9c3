//! Shortest paths from the root to each face by itself: the lower bound of branch and bound.
//!
//! A layout's energy is a sum over faces of what their own path costs for them. Without the demand
//! that the paths be one tree, each face takes its cheapest path: no layout costs less.

use super::frontier::Frontier;
use super::layout::Layout;
use super::target::{Arc, Target};
use super::weights::Weights;
use std::rc::Rc;

/// The sides across which each face may be entered, by face: bit k stands for side k.
pub type Allowed = Vec<u32>;

/// Returns the sides in a set of sides, ascending.
#[inline]
pub fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let side = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(side)
    })
}

/// Restricts `allowed` to layouts with an arc: its face is entered by it alone, and the opposite arc is removed.
/// `target`: the surface; `an_arc`: the arc. Panics if the side has no hinge.
pub fn keep(target: &Target, allowed: &mut Allowed, an_arc: Arc) {
    let (face, side) = target.head(an_arc);
    allowed[face] = 1 << side;
    let (back, side) = target.head(reversed(target, an_arc));
    allowed[back] &= !(1 << side);
}

/// Returns the number of paths that use each arc; a path is a list of arcs. `target`: the surface that the paths are on.
pub fn uses(target: &Target, paths: &[Rc<[Arc]>]) -> Vec<u32> {
    let mut uses = vec![0; target.arc_count()];
    paths.iter().flat_map(|path| path.iter()).for_each(|arc| uses[*arc as usize] += 1);
    uses
}

/// Returns the face to branch on: the one other than the root with the most paths that enter by another arc than the
/// commonest, of equal ones that of least index; `None` if all paths into each face agree. `uses`: as [`uses`] returns
/// them, or empty, where none is disputed. `target`: the surface that the paths are on.
pub fn disputed(target: &Target, root: usize, uses: &[u32]) -> Option<usize> {
    if uses.is_empty() {
        return None;
    }
    let dissent = |face: &usize| {
        let u = &uses[target.arcs(*face)];
        u.iter().sum::<u32>() - u.iter().max().expect("a face has sides")
    };
    let faces = (0..target.faces.len()).filter(|face| *face != root);
    // Of equal ones the first.
    faces.rev().max_by_key(dissent).filter(|face| dissent(face) > 0)
}

/// Returns the layout that agreeing paths form. `paths`: for each face in their order, its arcs from the face back to
/// the root; the root's is empty. `target`: the surface that the paths are on; `root`: the face from which they lead.
/// Panics if they form no tree.
pub fn tree(target: &Target, root: usize, paths: &[Rc<[Arc]>]) -> Layout {
    let arcs = paths.iter().filter_map(|path| path.first());
    let hinge = |a: &Arc| target.hinge_at(*a).expect("arcs lead across hinges");
    let hinges: Vec<usize> = arcs.map(hinge).collect();
    Layout::of_hinges(target, &hinges, root).expect("paths that agree form a tree")
}

/// The search for shortest paths between the faces of one target, with its working memory. The cost of an arc depends
/// on the goal: each face to be carried has its own costs of hinges.
pub struct ShortestPaths<'t> {
    target: &'t Target,
    weights: &'t Weights,
    /// The cost of the cheapest path from a face to another for the other, by the other, then by the face.
    toward: Vec<Vec<f64>>,
    distance: Vec<f64>,
    entered: Vec<Arc>,
    queue: Frontier,
    /// The greatest number of hinges on a path that [`route`](Self::route) returns; no limit at first.
    pub longest: usize,
}

const UNREACHED: Arc = Arc::MAX;

impl<'t> ShortestPaths<'t> {
    /// Returns the search with the costs of the shortest paths between all pairs of faces over all arcs, computed by
    /// Dijkstra's algorithm (1959); they are the heuristic of A* (Hart, Nilsson and Raphael 1968). `target`: the
    /// surface; `weights`: the costs of its hinges for the faces that they carry.
    pub fn new(target: &'t Target, weights: &'t Weights) -> ShortestPaths<'t> {
        let n = target.faces.len();
        let mut routes = ShortestPaths {
            target,
            weights,
            toward: vec![Vec::new(); n],
            distance: vec![f64::INFINITY; n],
            entered: vec![UNREACHED; n],
            queue: Frontier::default(),
            longest: usize::MAX,
        };
        for face in 0..n {
            routes.dijkstra(face);
            routes.toward[face] = routes.distance.clone();
        }
        routes
    }

    /// Returns the lower bound on the energy of layouts with the root `root` (an index in [`Target::faces`]): the sum
    /// of the costs of the shortest paths to all faces over all arcs, of any number of hinges; N·m for steps of one
    /// second. Panics if there is no such face.
    pub fn bound(&self, root: usize) -> f64 {
        self.toward.iter().map(|toward| toward[root]).sum()
    }

    /// Computes costs for `goal` from everywhere by Dijkstra's algorithm; paths cost the same in both
    /// directions.
    fn dijkstra(&mut self, goal: usize) {
        crate::interrupt::checkpoint();
        self.distance.fill(f64::INFINITY);
        self.distance[goal] = 0.0;
        self.queue.begin(goal);
        while let Some((cost, face)) = self.queue.pop() {
            if cost > self.distance[face] {
                continue;
            }
            for (hinge, other) in self.target.around(face) {
                let further = cost + self.weights.at(hinge, goal);
                if further < self.distance[other] {
                    self.distance[other] = further;
                    self.queue.push(further, other);
                }
            }
        }
    }

    /// Returns (cost, path) of the cheapest path from the root to `goal` (both indices in [`Target::faces`]) over
    /// allowed arcs with at most `longest` hinges: the cost in N·m for steps of one second, and the arcs from the goal
    /// back to the root; `None` if there is none. The method is A*, whose heuristic is the cost over all arcs, or the
    /// Bellman-Ford algorithm where `longest` is less than the number of faces. Panics if there is no such face.
    pub fn route(&mut self, root: usize, goal: usize, allowed: &[u32]) -> Option<(f64, Rc<[Arc]>)> {
        if self.longest < self.toward.len() {
            return self.route_in_layers(root, goal, allowed);
        }
        let ahead = &self.toward[goal];
        self.distance.fill(f64::INFINITY);
        self.distance[root] = 0.0;
        self.entered[root] = UNREACHED;
        self.queue.begin(root);
        while let Some((cost, face)) = self.queue.pop() {
            if face == goal {
                return Some((self.distance[goal], self.path_to(root, goal)));
            }
            let here = self.distance[face];
            if cost > here + ahead[face] {
                continue;
            }
            for (index, other) in self.target.around(face) {
                let hinge = &self.target.hinges[index];
                let side = hinge.side_of(other);
                if allowed[other] & (1 << side) == 0 {
                    continue;
                }
                let further = here + self.weights.at(index, goal);
                if further < self.distance[other] {
                    self.distance[other] = further;
                    self.entered[other] = self.target.arc(other, side);
                    self.queue.push(further + ahead[other], other);
                }
            }
        }
        None
    }

    /// Returns the cheapest path with at most `longest` hinges by the Bellman-Ford algorithm, one more hinge
    /// in each round; `None` if there is none.
    fn route_in_layers(&self, root: usize, goal: usize, allowed: &[u32]) -> Option<(f64, Rc<[Arc]>)> {
        let mut costs = vec![f64::INFINITY; self.toward.len()];
        costs[root] = 0.0;
        // For each round, then for each face: the arc by which it is entered where that became cheaper.
        let mut entered: Vec<Vec<Arc>> = Vec::new();
        for _ in 0..self.longest {
            let mut next = costs.clone();
            let mut arcs = vec![UNREACHED; costs.len()];
            for face in (0..costs.len()).filter(|face| costs[*face].is_finite()) {
                for (index, other) in self.target.around(face) {
                    let hinge = &self.target.hinges[index];
                    let side = hinge.side_of(other);
                    let further = costs[face] + self.weights.at(index, goal);
                    if allowed[other] & (1 << side) != 0 && further < next[other] {
                        (next[other], arcs[other]) = (further, self.target.arc(other, side));
                    }
                }
            }
            if next == costs {
                break;
            }
            costs = next;
            entered.push(arcs);
        }
        let mut path = Vec::new();
        let mut at = goal;
        for arcs in entered.iter().rev() {
            if arcs[at] != UNREACHED {
                path.push(arcs[at]);
                at = tail(self.target, arcs[at]);
            }
        }
        costs[goal].is_finite().then(|| (costs[goal], path.into()))
    }

    /// Returns the arcs of the path that was found to `goal`, from there back to the root.
    fn path_to(&self, root: usize, goal: usize) -> Rc<[Arc]> {
        let mut path = Vec::new();
        let mut at = goal;
        while at != root {
            path.push(self.entered[at]);
            at = tail(self.target, self.entered[at]);
        }
        path.into()
    }
}

/// Returns the face (an index in [`Target::faces`]) from which an arc comes. `target`: the surface that the arc is
/// on. Panics if its side has no hinge.
#[inline]
pub fn tail(target: &Target, arc: Arc) -> usize {
    let hinge = target.hinge_at(arc).expect("arcs lead across hinges");
    target.hinges[hinge].other(target.entered(arc))
}

/// Returns the arc across the same hinge in the opposite direction. `target`: the surface that the arc is on;
/// `an_arc`: the arc. Panics if the arc's side has no hinge.
#[inline]
pub fn reversed(target: &Target, an_arc: Arc) -> Arc {
    let hinge = &target.hinges[target.hinge_at(an_arc).expect("arcs lead across hinges")];
    let end = usize::from(hinge.faces[0] == target.entered(an_arc));
    target.arc(hinge.faces[end], hinge.sides[end])
}
