//! The layout of least energy, with proof: branch and bound over the arcs into faces.
//!
//! The bound of a node is that of [`routes`](super::routes): each face takes its own cheapest path
//! over the arcs still allowed. Where the paths form a tree, it is the node's best layout. Else the
//! face into which they disagree most is entered across one side in each child: the children are
//! disjoint and complete. Where the pattern may not overlap, a tree whose pattern does is split
//! along the path between two overlapping faces: any layout with all of the path's arcs overlaps, so
//! the children leave out the first arc; keep it and leave out the second; and so on.
//!
//! Equal costs are told apart by a tiny addition for every hinge, or symmetric targets would be
//! searched for ever. The proof holds up to what the additions come to, [`SLACK`] of the energy.

use super::layout::Layout;
use super::local;
use super::pattern::Pattern;
use super::routes::{self, Allowed, Arc, Routes};
use super::target::Target;
use super::weights::Weights;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// Part of the energy that the additions may come to in all.
pub const SLACK: f64 = 1e-9;

/// Layouts within this part of the least energy are equally good.
pub const TOL_TIE: f64 = 1e-9;

/// A bound this near to the best energy, as part of it, is rounding away from it.
const TOL_BOUND: f64 = 1e-12;

/// Nodes that wait at one time, so that memory stays bounded.
const WAITING_MAX: usize = 100_000;

/// What is searched and how long.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// `None`: the best of all.
    pub root: Option<usize>,
    /// Whether patterns that overlap in the plane are left out.
    pub flat: bool,
    /// Nodes and tried exchanges in all.
    pub budget: u64,
    /// Another seed, another choice among layouts that tie.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { root: None, flat: false, budget: 100_000_000, seed: 0 }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// No layout costs less than this one by more than [`SLACK`] of its energy.
    Optimal,
    /// The budget ended the search; the gap to the bound is open.
    Open,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Optimum {
    pub layout: Layout,
    /// N·m for steps of one second.
    pub energy: f64,
    /// No layout among those asked for costs less.
    pub bound: f64,
    pub proof: Proof,
    /// Roots that reach the energy, to [`TOL_TIE`] of it, in order; those found before the budget
    /// ended.
    pub roots: Vec<usize>,
    /// Branchings.
    pub nodes: u64,
}

/// Why there is no optimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLayout {
    /// Every layout overlaps in the plane.
    AllOverlap,
    /// The budget ended before any layout was found that does not overlap.
    Budget,
}

/// The layout of least energy.
pub fn optimum(target: &Target, weights: &Weights, settings: &Settings) -> Result<Optimum, NoLayout> {
    let bounds = Routes::new(target, weights);
    let mut roots: Vec<(f64, usize)> = match settings.root {
        Some(root) => vec![(bounds.bound(root), root)],
        None => (0..target.faces.len()).map(|root| (bounds.bound(root), root)).collect(),
    };
    roots.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // Where nothing costs anything, any addition will do.
    let slack = if roots[0].0 > 0.0 { SLACK * roots[0].0 } else { SLACK };
    let raised = raised(target, weights, slack, settings.seed);
    let mut routes = Routes::new(target, &raised);
    let mut search = Search {
        target,
        weights,
        raised: &raised,
        flat: settings.flat,
        slack,
        best: None,
        reached: Vec::new(),
        open: f64::INFINITY,
        nodes: 0,
        left: settings.budget,
    };
    for &(bound, root) in &roots {
        if search.best.as_ref().is_none_or(|best| bound <= best.energy * (1.0 + TOL_TIE)) {
            search.at_root(&mut routes, root);
        }
    }
    search.finish()
}

/// The weights with an addition for every hinge; no layout's additions come to more than the slack,
/// for it has fewer pairs of a face and a hinge above it than the square of its faces.
fn raised(target: &Target, weights: &Weights, slack: f64, seed: u64) -> Weights {
    let n = target.faces.len();
    let step = slack / (n * n) as f64;
    let extra: Vec<f64> = (0..target.hinges.len()).map(|hinge| step * fraction(hinge, seed)).collect();
    weights.raised(&extra)
}

struct Found {
    layout: Layout,
    energy: f64,
}

struct Search<'s> {
    target: &'s Target,
    weights: &'s Weights,
    /// With the additions.
    raised: &'s Weights,
    flat: bool,
    /// The most that the additions come to in one layout, N·m.
    slack: f64,
    best: Option<Found>,
    /// (root, least energy found there, with the additions)
    reached: Vec<(usize, f64)>,
    /// Least bound of what was left unsearched.
    open: f64,
    nodes: u64,
    left: u64,
}

struct Node {
    bound: f64,
    number: u64,
    allowed: Allowed,
    paths: Vec<Rc<[Arc]>>,
    costs: Vec<f64>,
}

/// The least bound is the greatest; of equal ones the newest.
impl Ord for Node {
    fn cmp(&self, other: &Node) -> Ordering {
        other.bound.total_cmp(&self.bound).then(self.number.cmp(&other.number))
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

impl Search<'_> {
    fn at_root(&mut self, routes: &mut Routes, root: usize) {
        let Some(first) = self.first(routes, root) else { return };
        let mut at_root = f64::INFINITY;
        if disputed(self.target, root, &first.paths).is_some() {
            self.start(root, &mut at_root);
        }
        let mut waiting = BinaryHeap::from([first]);
        while let Some(node) = waiting.pop() {
            if node.bound >= self.cutoff(at_root) {
                break;
            }
            if self.left == 0 || waiting.len() > WAITING_MAX {
                self.open = self.open.min(node.bound);
                break;
            }
            self.left -= 1;
            for child in self.branch(routes, root, node, &mut at_root) {
                if child.bound < self.cutoff(at_root) {
                    waiting.push(child);
                }
            }
        }
        if at_root.is_finite() {
            self.reached.push((root, at_root));
        }
    }

    /// Under the raised weights: what reaches this is no better than what is known.
    fn cutoff(&self, at_root: f64) -> f64 {
        let tie = self.best.as_ref().map_or(f64::INFINITY, |best| best.energy * (1.0 + TOL_TIE) + self.slack);
        tie.min(at_root * (1.0 - TOL_BOUND))
    }

    /// A layout to begin with, by growth and exchange.
    fn start(&mut self, root: usize, at_root: &mut f64) {
        let mut first = match &self.best {
            Some(best) => best.layout.rerooted(self.target, root),
            None => local::grown(self.target, self.weights, root),
        };
        first = local::improved(self.target, self.weights, first, &mut self.left);
        if !self.flat || Pattern::of(self.target, &first).overlaps().is_empty() {
            self.offer(first, at_root);
        }
    }

    fn offer(&mut self, layout: Layout, at_root: &mut f64) {
        let energy = layout.energy(self.weights);
        *at_root = at_root.min(layout.energy(self.raised));
        if self.best.as_ref().is_none_or(|best| energy < best.energy * (1.0 - TOL_TIE)) {
            self.best = Some(Found { layout, energy });
        }
    }

    fn first(&mut self, routes: &mut Routes, root: usize) -> Option<Node> {
        let n = self.target.faces.len();
        let mut allowed: Allowed = vec![0; n];
        for (face, sides) in self.target.sides.iter().enumerate().filter(|(face, _)| *face != root) {
            allowed[face] = (0..3).filter(|&k| sides[k].is_some()).map(|k| 1 << k).sum();
        }
        let mut node =
            Node { bound: 0.0, number: 0, allowed, paths: vec![Rc::from([]); n], costs: vec![0.0; n] };
        for face in (0..n).filter(|face| *face != root) {
            (node.costs[face], node.paths[face]) = routes.route(root, face, &node.allowed)?;
        }
        node.bound = node.costs.iter().sum();
        Some(node)
    }

    /// What is left of a node: nothing where its best layout is its answer.
    fn branch(&mut self, routes: &mut Routes, root: usize, node: Node, at_root: &mut f64) -> Vec<Node> {
        if let Some(face) = disputed(self.target, root, &node.paths) {
            self.nodes += 1;
            let sides = (0..3).filter(|side| node.allowed[face] & (1 << side) != 0);
            let kept = sides.map(|side| {
                let mut allowed = node.allowed.clone();
                keep(self.target, &mut allowed, routes::arc(face, side));
                allowed
            });
            let kept: Vec<Allowed> = kept.collect();
            return kept.into_iter().filter_map(|allowed| self.child(routes, root, &node, allowed)).collect();
        }
        let layout = self.layout(root, &node.paths);
        if self.flat
            && let Some(path) = overlapping_path(self.target, &layout)
        {
            self.nodes += 1;
            return self.without_path(routes, root, &node, &path);
        }
        self.offer(layout, at_root);
        Vec::new()
    }

    fn without_path(&mut self, routes: &mut Routes, root: usize, node: &Node, path: &[Arc]) -> Vec<Node> {
        let mut children = Vec::new();
        let mut allowed = node.allowed.clone();
        for &an_arc in path {
            let mut left_out = allowed.clone();
            let (face, side) = routes::head(an_arc);
            left_out[face] &= !(1 << side);
            children.extend(self.child(routes, root, node, left_out));
            keep(self.target, &mut allowed, an_arc);
        }
        children
    }

    /// The node under fewer arcs: only paths that lost one are sought anew.
    fn child(&mut self, routes: &mut Routes, root: usize, node: &Node, allowed: Allowed) -> Option<Node> {
        let (mut paths, mut costs) = (node.paths.clone(), node.costs.clone());
        for face in 0..paths.len() {
            let lost = paths[face].iter().any(|&a| {
                let (entered, side) = routes::head(a);
                allowed[entered] & (1 << side) == 0
            });
            if lost {
                (costs[face], paths[face]) = routes.route(root, face, &allowed)?;
            }
        }
        let bound = costs.iter().sum();
        Some(Node { bound, number: self.nodes, allowed, paths, costs })
    }

    /// The tree that paths form which agree.
    fn layout(&self, root: usize, paths: &[Rc<[Arc]>]) -> Layout {
        let arcs = paths.iter().filter_map(|path| path.first());
        let hinge = |a: &Arc| {
            let (face, side) = routes::head(*a);
            self.target.sides[face][side].expect("arcs lead across hinges")
        };
        let hinges: Vec<usize> = arcs.map(hinge).collect();
        Layout::of_hinges(self.target, &hinges, root).expect("paths that agree form a tree")
    }

    fn finish(self) -> Result<Optimum, NoLayout> {
        let closed = self.open.is_infinite();
        let Some(best) = self.best else {
            return Err(if closed { NoLayout::AllOverlap } else { NoLayout::Budget });
        };
        let tie = best.energy * (1.0 + TOL_TIE) + self.slack;
        let reaching = self.reached.iter().filter(|(_, energy)| *energy <= tie);
        let mut roots: Vec<usize> = reaching.map(|(root, _)| *root).collect();
        roots.sort_unstable();
        // The additions make bounds greater, by at most the slack.
        let bound = (self.open.min(best.energy * (1.0 - TOL_BOUND)) - self.slack).max(0.0);
        let proof = if closed { Proof::Optimal } else { Proof::Open };
        Ok(Optimum { layout: best.layout, energy: best.energy, bound, proof, roots, nodes: self.nodes })
    }
}

/// A number in (0, 1] for every hinge, without pattern: two rounds of SplitMix64.
fn fraction(hinge: usize, seed: u64) -> f64 {
    let mixed = [hinge as u64 + 1, seed].into_iter().fold(0, |state: u64, word| {
        let x = (state ^ word).wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    });
    ((mixed >> 32) as f64 + 1.0) / (1u64 << 32) as f64
}

/// Demands an arc: the face is entered by it alone, and it is not gone back.
fn keep(target: &Target, allowed: &mut Allowed, an_arc: Arc) {
    let (face, side) = routes::head(an_arc);
    allowed[face] = 1 << side;
    let (back, side) = routes::head(routes::reversed(target, an_arc));
    allowed[back] &= !(1 << side);
}

/// The face into which most paths differ from the commonest way; `None` where all agree.
fn disputed(target: &Target, root: usize, paths: &[Rc<[Arc]>]) -> Option<usize> {
    let mut uses = vec![[0u32; 3]; target.faces.len()];
    for &an_arc in paths.iter().flat_map(|path| path.iter()) {
        let (face, side) = routes::head(an_arc);
        uses[face][side] += 1;
    }
    let dissent = |face: &usize| {
        let u = uses[*face];
        u.iter().sum::<u32>() - u.iter().max().expect("there are three")
    };
    let faces = (0..uses.len()).filter(|face| *face != root);
    // Of equal ones the first.
    faces.rev().max_by_key(dissent).filter(|face| dissent(face) > 0)
}

/// The arcs of the shortest path in the tree between two faces that overlap in the plane.
fn overlapping_path(target: &Target, layout: &Layout) -> Option<Vec<Arc>> {
    let pairs = Pattern::of(target, layout).overlaps();
    let paths = pairs.iter().map(|&[a, b]| local::path(layout, a, b));
    let shortest = paths.min_by_key(Vec::len)?;
    let arc_of = |&index: &usize| {
        let [a, b] = target.hinges[index].faces;
        let below = if layout.hinge[b] == Some(index) { b } else { a };
        routes::arc(below, layout.across(target, below).side)
    };
    Some(shortest.iter().map(arc_of).collect())
}
