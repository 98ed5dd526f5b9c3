//! Search for a layout and an order of folding together, for the least energy without gravity: descent by exchanges
//! of one hinge for another from several layouts, where each layout is taken with the best order known for it, and
//! random exchanges to get away from where the descent ends (iterated local search).

use super::carried_moments::CarriedMoments;
use super::edge_exchange;
use super::energy_order;
use super::inertia::Inertia;
use super::layout::Layout;
use super::order_descent;
use super::pattern::Pattern;
use super::tolerances::TOLERANCES;
use super::weights::Weights;
use crate::optimize::random::SplitMix64;

/// The number of foldings that are kept for the judge.
const KEPT: usize = 48;

/// The number of exchanges whose layout gets an order of its own in each step of a descent: those that are the best
/// with the order of the layout before. For layouts of `n` faces at least [`FULL_FACES`] by `n`.
const ORDERED: usize = 6;

/// The number of faces, summed over layouts, that get an order of their own in each step of a descent.
const FULL_FACES: usize = 480;

/// The greatest height of a tree for which the best order is computed instead of a good one.
const HEIGHT_MAX: usize = 5;

/// The greatest number of random exchanges after which a descent begins anew, in a series without progress.
const KICKS_IDLE_MAX: usize = 40;

/// The greatest number of exchanges in one kick.
const KICK_MAX: usize = 4;

/// A layout with an order of folding and its energy.
#[derive(Clone)]
pub(super) struct OrderedLayout {
    /// The layout by which the surface folds.
    pub layout: Layout,
    /// The faces but the root (indices in [`Target::faces`](super::target::Target::faces)) in the order in which
    /// their hinges fold.
    pub order: Vec<usize>,
    /// The energy, N·m for steps of one second.
    pub energy: f64,
}

/// The search for layouts and orders of little energy.
pub(super) struct JointSearch<'s> {
    /// The moments of inertia that hinges carry.
    pub moments: &'s CarriedMoments<'s>,
    /// The costs of hinges with the leaves first, from which layouts to begin with are grown.
    pub weights: &'s Weights,
    /// The mass of each face, kg, and how it is spread.
    pub masses: &'s [f64],
    /// The distribution of the mass of a panel.
    pub inertia: Inertia,
    /// Lower bounds on the energy by root, N·m for steps of one second; infinite for faces that are no root.
    pub bounds: Vec<f64>,
    /// The number of steps that are left: faces carried in what is evaluated.
    pub budget_left: u64,
    /// The seed of the random exchanges.
    pub seed: u64,
    /// The layouts that lie flat, best first.
    pub kept: Vec<OrderedLayout>,
}

impl JointSearch<'_> {
    /// Searches from these layouts, from one grown at each root, and by random exchanges from the best; what is found
    /// is in `kept`.
    pub(super) fn run(&mut self, starts: &[Layout]) {
        for layout in starts {
            self.descend(layout.clone());
        }
        let mut roots: Vec<usize> =
            (0..self.bounds.len()).filter(|root| self.bounds[*root].is_finite()).collect();
        roots.sort_by(|a, b| self.bounds[*a].total_cmp(&self.bounds[*b]).then(a.cmp(b)));
        let for_roots = self.budget_left / 2;
        for root in roots {
            if self.budget_left < for_roots {
                break;
            }
            if self.bounds[root] < self.least() {
                let grown = edge_exchange::grown(self.moments.target, self.weights, root);
                let grown =
                    edge_exchange::improved(self.moments.target, self.weights, grown, &mut self.budget_left);
                self.descend(grown);
            }
        }
        self.kick();
    }

    /// Returns the least energy found, N·m for steps of one second; infinite if there is none.
    pub(super) fn least(&self) -> f64 {
        self.kept.first().map_or(f64::INFINITY, |best| best.energy)
    }

    /// Goes on from layouts that a few random exchanges make of the best ones.
    fn kick(&mut self) {
        let mut rng = SplitMix64(self.seed);
        let mut idle = 0;
        while idle < KICKS_IDLE_MAX && self.budget_left > 0 && !self.kept.is_empty() {
            let least = self.least();
            if self.bounds.iter().all(|bound| *bound >= least * (1.0 - TOLERANCES.proof)) {
                return;
            }
            let from = rng.below(self.kept.len().min(3));
            let mut layout = self.kept[from].layout.clone();
            for _ in 0..=rng.below(KICK_MAX) {
                layout = self.exchanged_at_random(&layout, &mut rng);
            }
            self.descend(layout);
            idle = if self.least() < least * (1.0 - TOLERANCES.tie) { 0 } else { idle + 1 };
        }
    }

    /// Returns a layout with one hinge exchanged, or rooted at a neighbour of its root.
    fn exchanged_at_random(&self, layout: &Layout, rng: &mut SplitMix64) -> Layout {
        let target = self.moments.target;
        let roots: Vec<usize> = target
            .around(layout.root)
            .map(|(_, other)| other)
            .filter(|root| self.bounds[*root] < self.least())
            .collect();
        if !roots.is_empty() && rng.below(4) == 0 {
            return layout.rerooted(target, roots[rng.below(roots.len())]);
        }
        let folding = layout.hinges();
        let open: Vec<usize> =
            (0..target.hinges.len()).filter(|hinge| folding.binary_search(hinge).is_err()).collect();
        if open.is_empty() {
            return layout.clone();
        }
        let added = open[rng.below(open.len())];
        let [a, b] = target.hinges[added].faces;
        let ring = edge_exchange::path(layout, a, b);
        layout.exchanged(target, ring[rng.below(ring.len())], added)
    }

    /// Descends from a layout by exchanges, as long as they lower the energy.
    fn descend(&mut self, layout: Layout) {
        let from = order_descent::leaves_first(&layout);
        let mut at = self.ordered(layout, from);
        self.keep(&at);
        while let Some(better) = self.exchange(&at) {
            at = better;
        }
    }

    /// Returns a layout with its best order, or a good one, from the places `rank` on.
    pub(super) fn ordered(&mut self, layout: Layout, rank: Vec<usize>) -> OrderedLayout {
        if layout.heights()[layout.root] <= HEIGHT_MAX
            && let Some((order, energy)) =
                energy_order::least_energy(self.moments.target, &layout, self.masses, self.inertia)
        {
            self.budget_left = self.budget_left.saturating_sub(order.len() as u64 * 16);
            return OrderedLayout { layout, order, energy };
        }
        let (rank, energy) = order_descent::improved(self.moments, &layout, rank, &mut self.budget_left);
        let order = order_descent::order(&layout, &rank);
        OrderedLayout { layout, order, energy }
    }

    /// Returns the first exchange, those that look best first, that lowers the energy and lies flat.
    fn exchange(&mut self, from: &OrderedLayout) -> Option<OrderedLayout> {
        let target = self.moments.target;
        let faces = target.faces.len();
        let OrderedLayout { layout, order, energy } = from;
        // Places by hinge: what is attached to another face keeps the order of its hinges.
        let mut places = vec![usize::MAX; target.hinges.len()];
        for (place, face) in order.iter().enumerate() {
            places[layout.hinge[*face].expect("it folds")] = place;
        }
        let inherited = |dropped: usize, added: usize| {
            let other = layout.exchanged(target, dropped, added);
            let place = |hinge: usize| places[if hinge == added { dropped } else { hinge }];
            let rank: Vec<usize> = other.hinge.iter().map(|hinge| hinge.map_or(usize::MAX, place)).collect();
            (other, rank)
        };
        let mut found: Vec<(f64, usize, usize)> = Vec::new();
        for added in (0..target.hinges.len()).filter(|hinge| places[*hinge] == usize::MAX) {
            let [a, b] = target.hinges[added].faces;
            for dropped in edge_exchange::path(layout, a, b) {
                if self.budget_left == 0 {
                    return None;
                }
                let (other, rank) = inherited(dropped, added);
                let mut visited = 0;
                let reached = self.moments.energy(&other, &rank, &mut visited);
                self.budget_left = self.budget_left.saturating_sub(visited);
                found.push((reached, dropped, added));
            }
        }
        crate::interrupt::checkpoint();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, dropped, added) in found.into_iter().take(ORDERED.max(FULL_FACES / faces)) {
            let (other, rank) = inherited(dropped, added);
            let other = self.ordered(other, rank);
            self.keep(&other);
            if other.energy < energy * (1.0 - TOLERANCES.tie)
                && Pattern::of(target, &other.layout).overlaps().is_empty()
            {
                return Some(other);
            }
        }
        None
    }

    /// Keeps a folding if it is among the best, lies flat, and is not known.
    pub(super) fn keep(&mut self, found: &OrderedLayout) {
        let place = self.kept.partition_point(|other| other.energy <= found.energy);
        let is_known = |other: &OrderedLayout| other.layout == found.layout && other.order == found.order;
        if place >= KEPT
            || self.kept.iter().any(is_known)
            || !Pattern::of(self.moments.target, &found.layout).overlaps().is_empty()
        {
            return;
        }
        self.kept.insert(place, found.clone());
        self.kept.truncate(KEPT);
    }
}
