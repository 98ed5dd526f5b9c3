//! The layout of least energy, with proof: branch and bound over the arcs into faces.
//!
//! The bound of a node is that of [`routes`](super::shortest_paths): each face takes its own cheapest path
//! over the arcs still allowed. Where the paths form a tree, it is the node's best layout. Else the
//! bound is raised by prices ([`lagrange`](super::lagrangian)), and the face into which paths disagree
//! most is entered across one side in each child: the children are disjoint and complete. Where the
//! pattern may not overlap, a tree whose pattern does is split along the path between two overlapping
//! faces: any layout with all of the path's arcs overlaps, so the children leave out the first arc;
//! keep it and leave out the second; and so on.
//!
//! All roots are searched together, always the node of least bound next, so that the gap at the end
//! of a budget is as small as it can be. Roots that are equal by symmetry are searched once.
//!
//! Equal costs are told apart by a tiny addition for every hinge, or symmetric targets would be
//! searched for ever. The proof holds up to what the additions come to, [`SLACK`] of the energy.

use super::edge_exchange;
use super::lagrangian::{self, Effort, Lagrangian, Multipliers};
use super::layout::Layout;
use super::pattern::Pattern;
use super::shortest_paths::{self, Allowed, Arc, ShortestPaths};
use super::symmetry;
use super::tabu_unfolding;
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

/// What may wait at one time, bytes.
const HELD_MAX: usize = 1 << 29;

/// What a node takes for each face, bytes: a path shared with its parent, a cost, uses, arcs.
const FACE_BYTES: usize = 48;

/// Rounds of one ascent.
const ROUNDS: usize = 6;

/// An ascent that closed less than this part of the gap is the last before branching.
const WORTHWHILE: f64 = 0.05;

/// Steps of an ascent that begins where another ended are longer by this.
const RESUMED: f64 = 0.5;

/// An ascent whose steps are shorter has converged.
const LENGTH_MIN: f64 = 0.01;

/// The part of the steps that are left which may go into one search for a layout that lies flat: one by this.
const FLATTENING: u64 = 4;

/// What is searched and how long.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// `None`: the best of all.
    pub root: Option<usize>,
    /// Whether patterns that overlap in the plane are left out.
    pub flat: bool,
    /// Layouts with more hinges on a path from the root are left out.
    pub height: Option<usize>,
    /// Faces settled on paths, exchanges weighed, and nodes, in all.
    pub budget: u64,
    /// Another seed, another choice among layouts that tie.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { root: None, flat: false, height: None, budget: 100_000_000, seed: 0 }
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
    /// Every layout overlaps in the plane, is too high, or was refused.
    AllOverlap,
    /// The budget ended, or the search was stopped, before any layout was found that does.
    Budget,
}

/// What is said of a layout that might be the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    Accept,
    /// The next best is sought.
    Refuse,
    /// Enough was asked: the search ends here.
    Stop,
}

/// The layout of least energy.
pub fn optimum(target: &Target, weights: &Weights, settings: &Settings) -> Result<Optimum, NoLayout> {
    search(target, weights, settings, None)
}

/// The layout of least energy among those that are accepted: layouts are asked for in order of their
/// energy. (Where the budget ends before one is accepted, a last one is asked for that need not be
/// the next.)
pub fn optimum_among(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    accepts: &mut dyn FnMut(&Layout) -> Decision,
) -> Result<Optimum, NoLayout> {
    search(target, weights, settings, Some(accepts))
}

fn search<'a>(
    target: &Target,
    weights: &Weights,
    settings: &Settings,
    accepts: Option<&'a mut (dyn FnMut(&Layout) -> Decision + 'a)>,
) -> Result<Optimum, NoLayout> {
    let n = target.faces.len();
    let plain = ShortestPaths::new(target, weights);
    let equals = match settings.root {
        Some(root) => vec![root; n],
        None => symmetry::orbits(target, weights),
    };
    let asked: Vec<usize> = match settings.root {
        Some(root) => vec![root],
        None => (0..n).filter(|face| equals[*face] == *face).collect(),
    };
    let least = asked.iter().map(|root| plain.bound(*root)).fold(f64::INFINITY, f64::min);
    // Where nothing costs anything, any addition will do.
    let slack = if least > 0.0 { SLACK * least } else { SLACK };
    let raised = raised(target, weights, slack, settings.seed);
    let mut search = Search {
        target,
        weights,
        raised: &raised,
        flat: settings.flat,
        seed: settings.seed,
        without_overlaps: false,
        height: settings.height.unwrap_or(n),
        accepts,
        stopped: false,
        slack,
        best: None,
        reached: vec![f64::INFINITY; n],
        aims: vec![f64::INFINITY; n],
        waiting: BinaryHeap::new(),
        held: 0,
        open: f64::INFINITY,
        nodes: 0,
        left: settings.budget,
    };
    for root in asked {
        search.push(Node { root, bound: plain.bound(root), number: 0, ways: None });
    }
    let mut routes = ShortestPaths::new(target, &raised);
    routes.longest = search.height;
    let mut bounds = Bounds { routes, lagrange: None };
    search.run(&mut bounds);
    let equals: Vec<Option<usize>> = match settings.root {
        Some(root) => (0..n).map(|face| (face == root).then_some(root)).collect(),
        None => equals.into_iter().map(Some).collect(),
    };
    search.finish(&equals)
}

/// The weights with an addition for every hinge; no layout's additions come to more than the slack,
/// for it has fewer pairs of a face and a hinge above it than the square of its faces.
fn raised(target: &Target, weights: &Weights, slack: f64, seed: u64) -> Weights {
    let n = target.faces.len();
    let step = slack / (n * n) as f64;
    let extra: Vec<f64> = (0..target.hinges.len()).map(|hinge| step * fraction(hinge, seed)).collect();
    weights.raised(&extra)
}

struct Search<'s, 'a> {
    target: &'s Target,
    weights: &'s Weights,
    /// With the additions.
    raised: &'s Weights,
    flat: bool,
    seed: u64,
    /// Whether a layout that lies flat was looked for by exchanges.
    without_overlaps: bool,
    /// The most hinges on a path.
    height: usize,
    accepts: Option<&'a mut (dyn FnMut(&Layout) -> Decision + 'a)>,
    stopped: bool,
    /// The most that the additions come to in one layout, N·m.
    slack: f64,
    best: Option<Found>,
    /// By root: least energy found there, with the additions.
    reached: Vec<f64>,
    /// By root: about what its best layout costs, were it to lie flat.
    aims: Vec<f64>,
    waiting: BinaryHeap<Node>,
    /// What the waiting nodes take, bytes.
    held: usize,
    /// Least bound of what was left unsearched.
    open: f64,
    nodes: u64,
    left: u64,
}

struct Found {
    layout: Layout,
    energy: f64,
}

struct Node {
    root: usize,
    bound: f64,
    number: u64,
    /// `None`: nothing is known yet but the bound.
    ways: Option<Ways>,
}

/// What is known of a node.
struct Ways {
    allowed: Allowed,
    paths: Vec<Rc<[Arc]>>,
    costs: Vec<f64>,
    prices: Rc<Multipliers>,
    /// Of the next step of an ascent.
    length: f64,
    /// Whether another ascent may raise the bound further.
    rising: bool,
    /// How often paths entered each face across each of its sides at the end of the last ascent.
    uses: Vec<[u32; 3]>,
}

/// The least bound is the greatest; of equal ones the newest, then the first root's.
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

/// What computes bounds.
struct Bounds<'s> {
    routes: ShortestPaths<'s>,
    /// Made when it is first needed.
    lagrange: Option<Lagrangian<'s>>,
}

impl<'s> Search<'s, '_> {
    fn run(&mut self, bounds: &mut Bounds<'s>) {
        while let Some(node) = self.waiting.pop() {
            let least = self.best.as_ref().map(|best| best.energy);
            let (nodes, wait) = (self.nodes, self.waiting.len());
            crate::interrupt::progress_checkpoint(|| {
                super::progress_text::searched(nodes, wait, least, node.bound)
            });
            self.held -= node.size();
            if node.bound >= self.cutoff(node.root) {
                continue;
            }
            if self.left == 0 || self.held > HELD_MAX || self.stopped {
                self.open = self.open.min(node.bound);
                if self.best.is_none() && !self.stopped {
                    self.start(node.root);
                }
                return;
            }
            self.left -= 1;
            self.look(bounds, node);
        }
    }

    fn push(&mut self, node: Node) {
        if node.bound < self.cutoff(node.root) {
            self.held += node.size();
            self.waiting.push(node);
        }
    }

    /// One step further with a node: paths, then a better bound, then its children or its answer.
    fn look(&mut self, bounds: &mut Bounds<'s>, node: Node) {
        let Node { root, bound, ways, .. } = node;
        let Some(mut ways) = ways else {
            let Some(ways) = self.first(&mut bounds.routes, root) else { return };
            let bound = bound.max(ways.costs.iter().sum());
            return self.push(Node { root, bound, number: 0, ways: Some(ways) });
        };
        match shortest_paths::disputed(root, &shortest_paths::uses(self.target, &ways.paths)) {
            None => self.settle(bounds, root, bound, ways),
            Some(_) if ways.rising => {
                let raised = self.rise(bounds, root, bound, &mut ways);
                if let Some(bound) = raised {
                    self.push(Node { root, bound, number: self.nodes, ways: Some(ways) });
                }
            }
            Some(by_paths) => {
                let face = shortest_paths::disputed(root, &ways.uses)
                    .filter(|face| ways.allowed[*face].count_ones() > 1);
                self.enter_across_each(bounds, root, bound, &ways, face.unwrap_or(by_paths));
            }
        }
    }

    /// Raises the bound by prices; the new one, or `None` where nothing below the cutoff is left.
    fn rise(&mut self, bounds: &mut Bounds<'s>, root: usize, bound: f64, ways: &mut Ways) -> Option<f64> {
        if self.aims[root].is_infinite() {
            self.start(root);
        }
        let cutoff = self.cutoff(root);
        let aim = if cutoff.is_finite() { cutoff } else { self.aims[root].max(bound) };
        let (target, raised) = (self.target, self.raised);
        let lagrange = bounds.lagrange.get_or_insert_with(|| Lagrangian::new(target, raised));
        let (mut left, mut allowed) = (self.left, ways.allowed.clone());
        let effort = Effort { cutoff, aim, rounds: ROUNDS, length: ways.length };
        let found = lagrange.ascend(root, &mut allowed, &ways.prices, effort, &mut left, |chosen, steps| {
            let layout = Layout::of_hinges(target, &lagrangian::mended(target, root, chosen), root);
            let layout = layout.expect("what was mended is a tree");
            self.consider(edge_exchange::improved(target, self.weights, layout, steps));
            self.cutoff(root)
        });
        self.left = left;
        ways.prices = found.prices.into();
        ways.uses = found.uses;
        // A child begins with steps that are not yet as short as its parent's last.
        ways.length = (found.length / RESUMED).min(1.0);
        let cutoff = self.cutoff(root);
        let aim = if cutoff.is_finite() { cutoff } else { aim };
        ways.rising = found.bound - bound > WORTHWHILE * (aim - bound) && found.length > LENGTH_MIN;
        let bound = bound.max(found.bound);
        if bound >= cutoff || !self.reroute(&mut bounds.routes, root, ways, allowed) {
            return None;
        }
        Some(bound.max(ways.costs.iter().sum()))
    }

    /// Paths that agree are the node's best layout, if it may lie as it does.
    fn settle(&mut self, bounds: &mut Bounds<'s>, root: usize, bound: f64, ways: Ways) {
        let layout = shortest_paths::tree(self.target, root, &ways.paths);
        if let Some(path) = self.flat.then(|| overlapping_path(self.target, &layout)).flatten() {
            return self.without_path(bounds, root, bound, &ways, &path);
        }
        let arcs: Vec<Arc> = ways.paths.iter().filter_map(|path| path.first().copied()).collect();
        match self.offer(layout) {
            Decision::Accept => {}
            // All other layouts of the node lack one of its arcs.
            Decision::Refuse => self.without_path(bounds, root, bound, &ways, &arcs),
            Decision::Stop => self.open = self.open.min(bound),
        }
    }

    fn enter_across_each(
        &mut self,
        bounds: &mut Bounds<'s>,
        root: usize,
        bound: f64,
        ways: &Ways,
        face: usize,
    ) {
        self.nodes += 1;
        for side in (0..3).filter(|side| ways.allowed[face] & (1 << side) != 0) {
            let mut allowed = ways.allowed.clone();
            shortest_paths::keep(self.target, &mut allowed, shortest_paths::arc(face, side));
            self.child(bounds, root, bound, ways, allowed);
        }
    }

    fn without_path(&mut self, bounds: &mut Bounds<'s>, root: usize, bound: f64, ways: &Ways, path: &[Arc]) {
        self.nodes += 1;
        let mut allowed = ways.allowed.clone();
        for &an_arc in path {
            let mut left_out = allowed.clone();
            let (face, side) = shortest_paths::head(an_arc);
            left_out[face] &= !(1 << side);
            self.child(bounds, root, bound, ways, left_out);
            shortest_paths::keep(self.target, &mut allowed, an_arc);
        }
    }

    fn child(&mut self, bounds: &mut Bounds<'s>, root: usize, bound: f64, parent: &Ways, allowed: Allowed) {
        let mut ways = Ways {
            allowed: Vec::new(),
            paths: parent.paths.clone(),
            costs: parent.costs.clone(),
            prices: parent.prices.clone(),
            length: parent.length,
            rising: true,
            uses: Vec::new(),
        };
        if self.reroute(&mut bounds.routes, root, &mut ways, allowed) {
            let bound = bound.max(ways.costs.iter().sum());
            self.push(Node { root, bound, number: self.nodes, ways: Some(ways) });
        }
    }

    /// Puts a node under other arcs: only paths that lost one are sought anew. `false` where a face
    /// can't be reached any more.
    fn reroute(
        &mut self,
        routes: &mut ShortestPaths,
        root: usize,
        ways: &mut Ways,
        allowed: Allowed,
    ) -> bool {
        for face in 0..ways.paths.len() {
            let lost = ways.paths[face].iter().any(|&a| {
                let (entered, side) = shortest_paths::head(a);
                allowed[entered] & (1 << side) == 0
            });
            if lost {
                self.left = self.left.saturating_sub(ways.paths[face].len() as u64);
                let Some((cost, path)) = routes.route(root, face, &allowed) else { return false };
                (ways.costs[face], ways.paths[face]) = (cost, path);
            }
        }
        ways.allowed = allowed;
        true
    }

    /// Under the raised weights: what reaches this is no better than what is known.
    fn cutoff(&self, root: usize) -> f64 {
        let tie = self.best.as_ref().map_or(f64::INFINITY, |best| best.energy * (1.0 + TOL_TIE) + self.slack);
        tie.min(self.reached[root] * (1.0 - TOL_BOUND))
    }

    /// A layout to begin with, by growth and exchange.
    fn start(&mut self, root: usize) {
        let grown = edge_exchange::grown(self.target, self.weights, root);
        let mut first = edge_exchange::improved(self.target, self.weights, grown, &mut self.left);
        if let Some(best) = &self.best {
            let rerooted = best.layout.rerooted(self.target, root);
            let other = edge_exchange::improved(self.target, self.weights, rerooted, &mut self.left);
            if other.energy(self.weights) < first.energy(self.weights) {
                first = other;
            }
        }
        if self.flat {
            first = self.flat_start(first);
        }
        if self.accepts.is_some() && (self.left == 0 || self.held > HELD_MAX) {
            self.offer(first);
        } else {
            self.consider(first);
        }
    }

    /// The same for layouts that lie flat: from the best one, if there is one yet.
    fn flat_start(&mut self, first: Layout) -> Layout {
        let (target, weights) = (self.target, self.weights);
        let is_flat = |layout: &Layout| Pattern::of(target, layout).overlaps().is_empty();
        if is_flat(&first) || self.best.is_none() && std::mem::replace(&mut self.without_overlaps, true) {
            return first;
        }
        if let Some(best) = &self.best {
            let rerooted = best.layout.rerooted(target, first.root);
            return edge_exchange::improved_where(target, weights, rerooted, &mut self.left, &is_flat);
        }
        // The budget goes on to the proof, whatever comes of this.
        let mut part = self.left / FLATTENING;
        let granted = part;
        let flat = tabu_unfolding::without_overlaps(target, weights, first.clone(), self.seed, &mut part);
        self.left -= granted - part;
        flat.unwrap_or(first)
    }

    /// A layout that need not be the next best: where each is asked for, it is only something to aim
    /// at.
    fn consider(&mut self, layout: Layout) {
        let root = layout.root;
        self.aims[root] = self.aims[root].min(layout.energy(self.raised));
        if self.accepts.is_none() {
            self.offer(layout);
        }
    }

    /// Takes a layout for the best where it is better, and lies flat if it has to.
    fn offer(&mut self, layout: Layout) -> Decision {
        let (energy, raised, root) = (layout.energy(self.weights), layout.energy(self.raised), layout.root);
        if raised >= self.reached[root]
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
        self.reached[root] = raised;
        if self.best.as_ref().is_none_or(|best| energy < best.energy * (1.0 - TOL_TIE)) {
            self.best = Some(Found { layout, energy });
        }
        word
    }

    fn first(&mut self, routes: &mut ShortestPaths, root: usize) -> Option<Ways> {
        let n = self.target.faces.len();
        let mut allowed: Allowed = vec![0; n];
        for (face, sides) in self.target.sides.iter().enumerate().filter(|(face, _)| *face != root) {
            allowed[face] = (0..3).filter(|&k| sides[k].is_some()).map(|k| 1 << k).sum();
        }
        let mut ways = Ways {
            allowed,
            paths: vec![Rc::from([]); n],
            costs: vec![0.0; n],
            prices: Rc::from([]),
            length: 1.0,
            rising: true,
            uses: Vec::new(),
        };
        for face in (0..n).filter(|face| *face != root) {
            (ways.costs[face], ways.paths[face]) = routes.route(root, face, &ways.allowed)?;
        }
        Some(ways)
    }

    /// `equals`: by face, the root that was searched in its place, if any.
    fn finish(self, equals: &[Option<usize>]) -> Result<Optimum, NoLayout> {
        let closed = self.open.is_infinite();
        let Some(best) = self.best else {
            return Err(if closed { NoLayout::AllOverlap } else { NoLayout::Budget });
        };
        let tie = best.energy * (1.0 + TOL_TIE) + self.slack;
        let reaches = |root: &usize| equals[*root].is_some_and(|searched| self.reached[searched] <= tie);
        let roots = (0..equals.len()).filter(reaches).collect();
        // The additions make bounds greater, by at most the slack.
        let bound = (self.open.min(best.energy * (1.0 - TOL_BOUND)) - self.slack).max(0.0);
        let proof = if closed { Proof::Optimal } else { Proof::Open };
        Ok(Optimum { layout: best.layout, energy: best.energy, bound, proof, roots, nodes: self.nodes })
    }
}

impl Node {
    /// About what it takes, bytes.
    fn size(&self) -> usize {
        let Some(ways) = &self.ways else { return 0 };
        FACE_BYTES * ways.paths.len() + size_of_val(&*ways.prices)
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

/// The arcs of the shortest path in the tree between two faces that overlap in the plane.
fn overlapping_path(target: &Target, layout: &Layout) -> Option<Vec<Arc>> {
    let pairs = Pattern::of(target, layout).overlaps();
    let paths = pairs.iter().map(|&[a, b]| edge_exchange::path(layout, a, b));
    let shortest = paths.min_by_key(Vec::len)?;
    let arc_of = |&index: &usize| {
        let [a, b] = target.hinges[index].faces;
        let below = if layout.hinge[b] == Some(index) { b } else { a };
        shortest_paths::arc(below, layout.across(target, below).side)
    };
    Some(shortest.iter().map(arc_of).collect())
}
