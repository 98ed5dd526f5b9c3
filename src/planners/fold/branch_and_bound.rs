//! Branch and bound (Land and Doig 1960) for the layout (rooted spanning tree of the faces) of least energy.
//!
//! The bound of a node is the sum of shortest paths ([`shortest_paths`]) over the arcs that the node allows. If the
//! paths form a tree, it is the node's best layout. Else the bound is raised by Lagrangian relaxation
//! ([`lagrangian`]), and the node is branched on the face into which the paths disagree the most: it is entered across
//! one side in each child, so the children are disjoint and complete. If patterns may not overlap, a tree whose
//! pattern overlaps is branched along the path between two overlapping faces: any layout with all arcs of the path
//! overlaps, so child k keeps the first k arcs and leaves out the next.
//!
//! All roots share one queue, in which the node of least bound comes first (best-first search), so that the gap at the
//! end of a budget is as small as it can be. Roots that are equal by symmetry are searched once.
//!
//! Costs are perturbed by a tiny addition for every hinge, since symmetric targets with their ties would not end. The
//! proof holds up to the sum of the additions, `TOLERANCES.perturbation` of the energy.

use super::edge_exchange;
use super::lagrangian::{self, AscentLimits, Lagrangian};
use super::layout::Layout;
use super::observer::Observer;
use super::open_node::{Node, NodePaths};
use super::pattern::Pattern;
use super::shortest_paths::{self, Allowed, ShortestPaths, bits};
use super::symmetry;
use super::tabu_unfolding;
use super::target::{Arc, Target};
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// The greatest size of the queue of open nodes, bytes.
const QUEUE_BYTES_MAX: usize = 1 << 29;

/// The greatest number of rounds of one subgradient ascent.
const ROUNDS: usize = 6;

/// The least part of the gap that an ascent has to close for another one to follow before branching.
const GAP_CLOSED_MIN: f64 = 0.05;

/// The first step of an ascent is the last step of its parent's ascent divided by this.
const STEP_RESTART: f64 = 0.5;

/// The step length, as a fraction of the gap, below which an ascent has converged.
const LENGTH_MIN: f64 = 0.01;

/// The remaining budget divided by this is the budget of one tabu search for a layout that lies flat.
const FLAT_BUDGET_SHARE: u64 = 4;

/// The options of branch and bound for the layout of least energy.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The root of the layout, an index in [`Target::faces`] (else a panic); `None`, the default: the best of all.
    pub root: Option<usize>,
    /// True leaves out layouts whose patterns overlap in the plane. Default false.
    pub flat: bool,
    /// The greatest number of hinges on a path from the root; `None`, the default: any number.
    pub height: Option<usize>,
    /// The greatest number of search steps: nodes, faces settled on paths, exchanges evaluated. Default 100 million.
    pub budget: u64,
    /// The seed of the perturbations, which choose among layouts that tie. Default 0.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { root: None, flat: false, height: None, budget: 100_000_000, seed: 0 }
    }
}

/// The strength of the proof that a layout is an optimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// The optimum is proved: the bound is below the energy by less than `TOLERANCES.proof` of it.
    Optimal,
    /// The optimum is not proved: the budget, 512 MiB of open nodes or the caller ended the search before.
    Open,
}

/// The result of branch and bound: the best layout found, with a lower bound for all layouts that fit the settings.
/// [`Proof::Optimal`] alone says that no other is better; after a search that ended early one may be.
#[derive(Clone, Debug)]
pub struct Optimum {
    /// The best layout found that fits the settings and was not refused, rooted at its root.
    pub layout: Layout,
    /// The energy of the layout without the perturbations, N·m for steps of one second.
    pub energy: f64,
    /// A lower bound on the energy of all layouts that fit and were not refused, N·m for steps of one second; >= 0.
    pub bound: f64,
    /// The strength of the proof that the layout is optimal.
    pub proof: Proof,
    /// The roots (indices in [`Target::faces`], ascending) with which some layout reaches the energy up to
    /// `TOLERANCES.tie`, those that are equal by symmetry included, as far as they were found before the search ended.
    pub roots: Vec<usize>,
    /// The number of nodes of the search tree that were branched into children.
    pub nodes: u64,
}

/// The reason why branch and bound found no layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLayout {
    /// Every layout overlaps in the plane, is too high, or was refused by the caller.
    AllOverlap,
    /// The budget or the memory ended, or the search was stopped, before a layout was found.
    Budget,
}

/// The caller's decision about a layout that [`optimum_among`] proposes as the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The layout may be the answer; only layouts that tie with it or are better are proposed after it.
    Accept,
    /// The layout is not the answer; the search goes on to the next best.
    Refuse,
    /// The layout is not the answer; the search ends with what was accepted before, if anything.
    Stop,
}

/// Returns the best layout that fits found within the budget (Land and Doig 1960). Panics if the root is not a face.
///
/// # Errors
/// [`NoLayout::AllOverlap`] if no layout lies flat or is low enough, else [`NoLayout::Budget`] if none was found.
pub fn optimum(target: &Target, weights: &Weights, settings: &Settings) -> Result<Optimum, NoLayout> {
    search(target, weights, settings, None, &Observer::none())
}

/// Returns, as [`optimum`], the layout of least energy found that `accepts` accepts, asked in order of ascending
/// energy up to ties; if the budget ends before it accepts one, also about what a local search finds.
///
/// # Errors
/// [`NoLayout::AllOverlap`] if no layout fits or all were refused, else [`NoLayout::Budget`] if none was accepted.
pub fn optimum_among(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    accepts: &mut dyn FnMut(&Layout) -> Decision,
) -> Result<Optimum, NoLayout> {
    search(target, weights, settings, Some(accepts), &Observer::none())
}

/// Runs [`optimum_among`]; without `accepts` the first layout that fits is accepted. `observer` may end the search.
///
/// # Errors
/// As for [`optimum_among`].
pub(crate) fn search<'a>(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    accepts: Option<&'a mut (dyn FnMut(&Layout) -> Decision + 'a)>,
    observer: &Observer,
) -> Result<Optimum, NoLayout> {
    let n = target.faces.len();
    // Roots to search: one of each orbit of the target's symmetries.
    let plain = ShortestPaths::new(target, weights);
    let equals = match settings.root {
        Some(root) => vec![root; n],
        None => symmetry::orbits(target, weights),
    };
    let asked: Vec<usize> = match settings.root {
        Some(root) => vec![root],
        None => (0..n).filter(|face| equals[*face] == *face).collect(),
    };
    // Perturbed costs separate ties.
    let least = asked.iter().map(|root| plain.bound(*root)).fold(f64::INFINITY, f64::min);
    // If nothing costs anything, any perturbation will do.
    let slack = if least > 0.0 { TOLERANCES.perturbation * least } else { TOLERANCES.perturbation };
    let perturbed = perturbed(target, weights, slack, settings.seed);
    let mut search = Search {
        target,
        weights,
        perturbed: &perturbed,
        flat: settings.flat,
        seed: settings.seed,
        without_overlaps: false,
        height: settings.height.unwrap_or(n),
        accepts,
        stopped: false,
        slack,
        best: None,
        reached: vec![f64::INFINITY; n],
        optimum_estimates: vec![f64::INFINITY; n],
        open_nodes: BinaryHeap::new(),
        queue_bytes: 0,
        open_bound: f64::INFINITY,
        nodes: 0,
        budget_left: settings.budget,
        observer,
    };
    // The queue begins with one node for each root, under the bound of shortest paths.
    for root in asked {
        search.push(Node { root, bound: plain.bound(root), number: 0, ways: None });
    }
    let mut routes = ShortestPaths::new(target, &perturbed);
    routes.longest = search.height;
    let mut bounds = Bounds { routes, relaxation: None };
    search.run(&mut bounds);
    // A bound for a root holds for its orbit.
    let equals: Vec<Option<usize>> = match settings.root {
        Some(root) => (0..n).map(|face| (face == root).then_some(root)).collect(),
        None => equals.into_iter().map(Some).collect(),
    };
    search.finish(&equals)
}

/// Returns the weights perturbed by an addition for every hinge. The additions of one layout come to no more than
/// `slack`, since it has fewer pairs of a face and a hinge above it than the square of its faces.
fn perturbed(target: &Target, weights: &Weights, slack: f64, seed: u64) -> Weights {
    let n = target.faces.len();
    let step = slack / (n * n) as f64;
    let extra: Vec<f64> = (0..target.hinges.len()).map(|hinge| step * fraction(hinge, seed)).collect();
    weights.perturbed(&extra)
}

struct Search<'s, 'a, 'o> {
    target: &'s Target,
    weights: &'s Weights,
    /// The weights with their perturbations.
    perturbed: &'s Weights,
    flat: bool,
    seed: u64,
    /// True once the tabu search for a layout that lies flat was run.
    without_overlaps: bool,
    /// The greatest number of hinges on a path.
    height: usize,
    accepts: Option<&'a mut (dyn FnMut(&Layout) -> Decision + 'a)>,
    stopped: bool,
    /// The greatest sum of perturbations in one layout, N·m.
    slack: f64,
    best: Option<Found>,
    /// The least perturbed energy found, by root.
    reached: Vec<f64>,
    /// An estimate of the energy of the best layout of each root, flat or not, for Polyak's step.
    optimum_estimates: Vec<f64>,
    open_nodes: BinaryHeap<Node>,
    /// The size of the open nodes, bytes.
    queue_bytes: usize,
    /// The least bound of the nodes that were left unsearched.
    open_bound: f64,
    nodes: u64,
    budget_left: u64,
    observer: &'s Observer<'o>,
}

struct Found {
    layout: Layout,
    energy: f64,
}

/// The computation of bounds.
struct Bounds<'s> {
    routes: ShortestPaths<'s>,
    /// The relaxation; `None` until it is first needed.
    relaxation: Option<Lagrangian<'s>>,
}

impl<'s> Search<'s, '_, '_> {
    /// Expands open nodes, that of least bound first, until none is left or the search has to end.
    fn run(&mut self, bounds: &mut Bounds<'s>) {
        while let Some(node) = self.open_nodes.pop() {
            let least = self.best.as_ref().map(|best| best.energy);
            let (nodes, queued) = (self.nodes, self.open_nodes.len());
            crate::interrupt::progress_checkpoint(|| {
                super::progress_text::searched(nodes, queued, least, node.bound)
            });
            self.queue_bytes -= node.size();
            if node.bound >= self.cutoff(node.root) {
                continue;
            }
            if self.budget_left == 0
                || self.queue_bytes > QUEUE_BYTES_MAX
                || self.stopped
                || !self.observer.should_continue()
            {
                self.open_bound = self.open_bound.min(node.bound);
                if self.best.is_none() && !self.stopped {
                    self.start(node.root);
                }
                return;
            }
            self.budget_left -= 1;
            self.expand(bounds, node);
        }
    }

    fn push(&mut self, node: Node) {
        if node.bound < self.cutoff(node.root) {
            self.queue_bytes += node.size();
            self.open_nodes.push(node);
        }
    }

    /// Expands a node by one step: shortest paths, then a better bound, then its children or its answer.
    fn expand(&mut self, bounds: &mut Bounds<'s>, node: Node) {
        let Node { root, bound, ways, .. } = node;
        let Some(mut ways) = ways else {
            let Some(ways) = self.first(&mut bounds.routes, root) else { return };
            let bound = bound.max(ways.costs.iter().sum());
            return self.push(Node { root, bound, number: 0, ways: Some(ways) });
        };
        match shortest_paths::disputed(self.target, root, &shortest_paths::uses(self.target, &ways.paths)) {
            None => self.settle(bounds, root, bound, ways),
            Some(_) if ways.rising => {
                let better = self.ascend(bounds, root, bound, &mut ways);
                if let Some(bound) = better {
                    self.push(Node { root, bound, number: self.nodes, ways: Some(ways) });
                }
            }
            Some(by_paths) => {
                let face = shortest_paths::disputed(self.target, root, &ways.uses)
                    .filter(|face| ways.allowed[*face].count_ones() > 1);
                self.enter_across_each(bounds, root, bound, &ways, face.unwrap_or(by_paths));
            }
        }
    }

    /// Raises the bound by Lagrangian relaxation, and returns it; `None` where nothing below the cutoff is left.
    fn ascend(
        &mut self,
        bounds: &mut Bounds<'s>,
        root: usize,
        bound: f64,
        ways: &mut NodePaths,
    ) -> Option<f64> {
        if self.optimum_estimates[root].is_infinite() {
            self.start(root);
        }
        let cutoff = self.cutoff(root);
        let optimum_estimate =
            if cutoff.is_finite() { cutoff } else { self.optimum_estimates[root].max(bound) };
        let (target, perturbed) = (self.target, self.perturbed);
        let relaxation = bounds.relaxation.get_or_insert_with(|| Lagrangian::new(target, perturbed));
        let (mut left, mut allowed) = (self.budget_left, ways.allowed.clone());
        let limits = AscentLimits { cutoff, optimum_estimate, rounds: ROUNDS, length: ways.length };
        let found =
            relaxation.ascend(root, &mut allowed, &ways.multipliers, limits, &mut left, |chosen, steps| {
                let layout = Layout::of_hinges(target, &lagrangian::repaired(target, root, chosen), root);
                let layout = layout.expect("what was repaired is a tree");
                self.consider(edge_exchange::improved(target, self.weights, layout, steps));
                self.cutoff(root)
            });
        self.budget_left = left;
        ways.multipliers = found.multipliers.into();
        ways.uses = found.uses;
        // A child begins with steps that are not yet as short as its parent's last.
        ways.length = (found.length / STEP_RESTART).min(1.0);
        let cutoff = self.cutoff(root);
        let optimum_estimate = if cutoff.is_finite() { cutoff } else { optimum_estimate };
        ways.rising =
            found.bound - bound > GAP_CLOSED_MIN * (optimum_estimate - bound) && found.length > LENGTH_MIN;
        let bound = bound.max(found.bound);
        if bound >= cutoff || !self.reroute(&mut bounds.routes, root, ways, allowed) {
            return None;
        }
        Some(bound.max(ways.costs.iter().sum()))
    }

    /// Handles a node whose paths form a tree: it is the node's best layout, unless its pattern overlaps.
    fn settle(&mut self, bounds: &mut Bounds<'s>, root: usize, bound: f64, ways: NodePaths) {
        let layout = shortest_paths::tree(self.target, root, &ways.paths);
        if let Some(path) = self.flat.then(|| overlapping_path(self.target, &layout)).flatten() {
            return self.without_path(bounds, root, bound, &ways, &path);
        }
        let arcs: Vec<Arc> = ways.paths.iter().filter_map(|path| path.first().copied()).collect();
        match self.offer(layout) {
            Decision::Accept => {}
            // All other layouts of the node lack one of its arcs.
            Decision::Refuse => self.without_path(bounds, root, bound, &ways, &arcs),
            Decision::Stop => self.open_bound = self.open_bound.min(bound),
        }
    }

    /// Branches on a face: one child for each side across which it may be entered.
    fn enter_across_each(
        &mut self,
        bounds: &mut Bounds<'s>,
        root: usize,
        bound: f64,
        ways: &NodePaths,
        face: usize,
    ) {
        self.nodes += 1;
        for side in bits(ways.allowed[face]) {
            let mut allowed = ways.allowed.clone();
            shortest_paths::keep(self.target, &mut allowed, self.target.arc(face, side));
            self.child(bounds, root, bound, ways, allowed);
        }
    }

    /// Branches on a path: child k keeps the first k arcs and leaves out the next.
    fn without_path(
        &mut self,
        bounds: &mut Bounds<'s>,
        root: usize,
        bound: f64,
        ways: &NodePaths,
        path: &[Arc],
    ) {
        self.nodes += 1;
        let mut allowed = ways.allowed.clone();
        for &an_arc in path {
            let mut left_out = allowed.clone();
            let (face, side) = self.target.head(an_arc);
            left_out[face] &= !(1 << side);
            self.child(bounds, root, bound, ways, left_out);
            shortest_paths::keep(self.target, &mut allowed, an_arc);
        }
    }

    /// Queues the child of a node with fewer arcs, if every face can still be reached.
    fn child(
        &mut self,
        bounds: &mut Bounds<'s>,
        root: usize,
        bound: f64,
        parent: &NodePaths,
        allowed: Allowed,
    ) {
        let mut ways = NodePaths {
            allowed: Vec::new(),
            paths: parent.paths.clone(),
            costs: parent.costs.clone(),
            multipliers: parent.multipliers.clone(),
            length: parent.length,
            rising: true,
            uses: Vec::new(),
        };
        if self.reroute(&mut bounds.routes, root, &mut ways, allowed) {
            let bound = bound.max(ways.costs.iter().sum());
            self.push(Node { root, bound, number: self.nodes, ways: Some(ways) });
        }
    }

    /// Restricts a node to fewer arcs: only paths that lost an arc are searched again. Returns false where a face can't
    /// be reached any more.
    fn reroute(
        &mut self,
        routes: &mut ShortestPaths,
        root: usize,
        ways: &mut NodePaths,
        allowed: Allowed,
    ) -> bool {
        for face in 0..ways.paths.len() {
            let lost = ways.paths[face].iter().any(|&a| {
                let (entered, side) = self.target.head(a);
                allowed[entered] & (1 << side) == 0
            });
            if lost {
                self.budget_left = self.budget_left.saturating_sub(ways.paths[face].len() as u64);
                let Some((cost, path)) = routes.route(root, face, &allowed) else { return false };
                (ways.costs[face], ways.paths[face]) = (cost, path);
            }
        }
        ways.allowed = allowed;
        true
    }

    /// Returns the perturbed energy from which on a layout is no better than those known.
    fn cutoff(&self, root: usize) -> f64 {
        let tie = self
            .best
            .as_ref()
            .map_or(f64::INFINITY, |best| best.energy * (1.0 + TOLERANCES.tie) + self.slack);
        tie.min(self.reached[root] * (1.0 - TOLERANCES.bound))
    }

    /// Adds a first layout: a greedy tree, improved by exchanges (primal heuristic).
    fn start(&mut self, root: usize) {
        let grown = edge_exchange::grown(self.target, self.weights, root);
        let mut first = edge_exchange::improved(self.target, self.weights, grown, &mut self.budget_left);
        if let Some(best) = &self.best {
            let rerooted = best.layout.rerooted(self.target, root);
            let other = edge_exchange::improved(self.target, self.weights, rerooted, &mut self.budget_left);
            if other.energy(self.weights) < first.energy(self.weights) {
                first = other;
            }
        }
        if self.flat {
            first = self.flat_start(first);
        }
        if self.accepts.is_some() && (self.budget_left == 0 || self.queue_bytes > QUEUE_BYTES_MAX) {
            self.offer(first);
        } else {
            self.consider(first);
        }
    }

    /// Returns a first flat layout: from the best one, or by tabu search while there is none (primal heuristic).
    fn flat_start(&mut self, first: Layout) -> Layout {
        let (target, weights) = (self.target, self.weights);
        let is_flat = |layout: &Layout| Pattern::of(target, layout).overlaps().is_empty();
        if is_flat(&first) || self.best.is_none() && std::mem::replace(&mut self.without_overlaps, true) {
            return first;
        }
        if let Some(best) = &self.best {
            let rerooted = best.layout.rerooted(target, first.root);
            return edge_exchange::improved_where(target, weights, rerooted, &mut self.budget_left, &is_flat);
        }
        // Only a part of the budget: the rest is for the proof.
        let mut part = self.budget_left / FLAT_BUDGET_SHARE;
        let granted = part;
        let flat = tabu_unfolding::without_overlaps(target, weights, first.clone(), self.seed, &mut part);
        self.budget_left -= granted - part;
        flat.unwrap_or(first)
    }

    /// Takes a layout of the primal heuristic, which need not be the next best: where the caller decides, it only
    /// improves the estimate of the optimum.
    fn consider(&mut self, layout: Layout) {
        let root = layout.root;
        self.optimum_estimates[root] = self.optimum_estimates[root].min(layout.energy(self.perturbed));
        if self.accepts.is_none() {
            self.offer(layout);
        }
    }

    /// Makes a layout the incumbent where it is better, lies flat if it has to, and the caller accepts it.
    fn offer(&mut self, layout: Layout) -> Decision {
        let (energy, perturbed, root) =
            (layout.energy(self.weights), layout.energy(self.perturbed), layout.root);
        if perturbed >= self.reached[root]
            || self.height < self.target.faces.len() && layout.heights()[root] > self.height
            || self.flat && !Pattern::of(self.target, &layout).overlaps().is_empty()
        {
            return Decision::Accept;
        }
        let word = self.accepts.as_mut().map_or(Decision::Accept, |accepts| accepts(&layout));
        self.stopped |= word == Decision::Stop;
        if word != Decision::Accept {
            return word;
        }
        self.reached[root] = perturbed;
        if self.best.as_ref().is_none_or(|best| energy < best.energy * (1.0 - TOLERANCES.tie)) {
            self.best = Some(Found { layout, energy });
        }
        word
    }

    /// Returns the shortest paths of a root over all arcs; `None` if a face can't be reached within the height.
    fn first(&mut self, routes: &mut ShortestPaths, root: usize) -> Option<NodePaths> {
        let n = self.target.faces.len();
        let mut allowed: Allowed = vec![0; n];
        for (face, sides) in self.target.sides.iter().enumerate().filter(|(face, _)| *face != root) {
            allowed[face] = (0..sides.len()).filter(|&k| sides[k].is_some()).map(|k| 1 << k).sum();
        }
        let mut ways = NodePaths {
            allowed,
            paths: vec![Rc::from([]); n],
            costs: vec![0.0; n],
            multipliers: Rc::from([]),
            length: 1.0,
            rising: true,
            uses: Vec::new(),
        };
        for face in (0..n).filter(|face| *face != root) {
            (ways.costs[face], ways.paths[face]) = routes.route(root, face, &ways.allowed)?;
        }
        Some(ways)
    }

    /// Returns the result; `equals`: by face, the equivalent root that was searched instead, if any.
    fn finish(self, equals: &[Option<usize>]) -> Result<Optimum, NoLayout> {
        let closed = self.open_bound.is_infinite();
        let Some(best) = self.best else {
            return Err(if closed { NoLayout::AllOverlap } else { NoLayout::Budget });
        };
        let tie = best.energy * (1.0 + TOLERANCES.tie) + self.slack;
        let reaches = |root: &usize| equals[*root].is_some_and(|searched| self.reached[searched] <= tie);
        let roots = (0..equals.len()).filter(reaches).collect();
        // Layouts at least as good as the best of their root were left out; perturbations make bounds greater, by at
        // most the slack.
        let reached = self.reached.iter().copied().fold(best.energy, f64::min) * (1.0 - TOLERANCES.bound);
        let bound = (self.open_bound.min(reached) - self.slack).max(0.0);
        // Nodes that are still open near the best are ties with it.
        let proof = if TOLERANCES.prove(best.energy, bound) { Proof::Optimal } else { Proof::Open };
        Ok(Optimum { layout: best.layout, energy: best.energy, bound, proof, roots, nodes: self.nodes })
    }
}

/// Returns a pseudorandom number in (0, 1] for a hinge: two rounds of SplitMix64.
fn fraction(hinge: usize, seed: u64) -> f64 {
    let mixed = [hinge as u64 + 1, seed].into_iter().fold(0, |state: u64, word| {
        let x = (state ^ word).wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    });
    ((mixed >> 32) as f64 + 1.0) / (1u64 << 32) as f64
}

/// Returns the arcs of the shortest tree path between two faces that overlap in the plane; `None` where none do.
fn overlapping_path(target: &Target, layout: &Layout) -> Option<Vec<Arc>> {
    let pairs = Pattern::of(target, layout).overlaps();
    let paths = pairs.iter().map(|&[a, b]| edge_exchange::path(layout, a, b));
    let shortest = paths.min_by_key(Vec::len)?;
    let arc_of = |&index: &usize| {
        let [a, b] = target.hinges[index].faces;
        let below = if layout.hinge[b] == Some(index) { b } else { a };
        target.arc(below, layout.across(target, below).side)
    };
    Some(shortest.iter().map(arc_of).collect())
}
