//! Good layouts without proof: greedy growth, then local search by edge exchange (one hinge for another on the
//! cycle that it closes).

use super::layout::Layout;
use super::target::Target;
use super::tolerances::TOLERANCES;
use super::weights::Weights;

/// The number of exchanges that gain, the best first, of which the first that is allowed is made.
const TRIED_MAX: usize = 256;

/// The number of sums that take about as long as the evaluation of one exchange.
const SUMS: usize = 64;

/// Returns a greedy layout (a spanning tree of the faces) grown from `root` (an index in [`Target::faces`]): in each
/// step the face is added whose path from the root costs the least for it (N·m for steps of one second); of equal ones
/// the first. `target`: the surface; `weights`: the costs of its hinges for the faces that they carry. Panics if the
/// hinges do not connect all faces.
pub fn grown(target: &Target, weights: &Weights, root: usize) -> Layout {
    let n = target.faces.len();
    // For each face: the hinges between it and the root, once it belongs to the tree.
    let mut paths: Vec<Option<Vec<usize>>> = vec![None; n];
    paths[root] = Some(Vec::new());
    let mut hinges = Vec::with_capacity(n - 1);
    // The cheapest hinge so far to add each face by.
    let mut best: Vec<(f64, usize, usize)> = vec![(f64::INFINITY, 0, 0); n];
    let mut newest = root;
    for _ in 1..n {
        for (hinge, other) in target.around(newest) {
            if paths[other].is_none() {
                let path = paths[newest].as_ref().expect("it belongs to the tree");
                let cost = path.iter().chain([&hinge]).map(|&h| weights.at(h, other)).sum();
                if cost < best[other].0 {
                    best[other] = (cost, hinge, newest);
                }
            }
        }
        let outside = (0..n).filter(|&face| paths[face].is_none());
        newest = outside.min_by(|&a, &b| best[a].0.total_cmp(&best[b].0)).expect("a face is left");
        let (_, hinge, parent) = best[newest];
        let mut path = paths[parent].clone().expect("it belongs to the tree");
        path.push(hinge);
        paths[newest] = Some(path);
        hinges.push(hinge);
    }
    Layout::of_hinges(target, &hinges, root).expect("every face was added by one hinge")
}

/// Returns a layout of no greater energy with the same root, improved by exchanges of one hinge of the tree for another
/// on the cycle that it closes, as long as that lowers the energy (steepest descent). `steps` counts down by one for
/// each exchange evaluated, and for every `SUMS` sums that are computed anew after each exchange made; at 0 the search
/// ends with what it has. `target`: the surface; `weights`: the costs of its hinges for the faces that they carry.
pub fn improved(target: &Target, weights: &Weights, layout: Layout, steps: &mut u64) -> Layout {
    improved_where(target, weights, layout, steps, &|_| true)
}

/// Returns a layout improved as by [`improved`], by exchanges that lead to layouts for which `allowed` returns true;
/// `steps` counts down as for [`improved`]. `target` and `weights`: as for [`improved`].
pub fn improved_where(
    target: &Target,
    weights: &Weights,
    layout: Layout,
    steps: &mut u64,
    allowed: &dyn Fn(&Layout) -> bool,
) -> Layout {
    improved_by(target, weights, layout, steps, &Rules { fits: &|_, _| true, allowed })
}

/// The rules that exchanges of hinges keep to, besides that the energy has to become less.
pub struct Rules<'r> {
    /// A filter of every exchange that lowers the energy: called with a layout and two indices in [`Target::hinges`],
    /// it returns true if the first hinge, which folds, may be exchanged for the second.
    pub fits: &'r dyn Fn(&Layout, [usize; 2]) -> bool,
    /// A filter of the layouts that the 256 best exchanges lead to: true if the layout is allowed.
    pub allowed: &'r dyn Fn(&Layout) -> bool,
}

/// Returns a layout improved as by [`improved`], by exchanges that keep to the rules; `steps` counts down as for
/// [`improved`]. `target` and `weights`: as for [`improved`].
pub fn improved_by(
    target: &Target,
    weights: &Weights,
    mut layout: Layout,
    steps: &mut u64,
    rules: &Rules,
) -> Layout {
    let gain = layout.energy(weights) * TOLERANCES.gain;
    let mut branches = Branches::default();
    while let Some(better) = exchange(target, weights, &layout, (gain, &mut branches), steps, rules) {
        crate::interrupt::checkpoint();
        layout = better;
    }
    layout
}

/// The costs of the branches of a layout, by which an exchange is evaluated without making its layout.
#[derive(Default)]
struct Branches {
    faces: usize,
    /// The cost that a hinge would spend on carrying a face and all below it, by hinge, then by face.
    below: Vec<f64>,
    /// The cost that the hinges between the root and b would spend on carrying c and all below it, by face b,
    /// then by face c.
    along: Vec<f64>,
}

impl Branches {
    /// Computes the costs for a layout; the memory of another one is used again.
    fn compute(&mut self, target: &Target, weights: &Weights, layout: &Layout) {
        let faces = target.faces.len();
        self.faces = faces;
        self.below.clear();
        (0..target.hinges.len()).for_each(|hinge| self.below.extend_from_slice(weights.of_hinge(hinge)));
        let upwards: Vec<(usize, usize)> =
            layout.order[1..].iter().rev().map(|&face| (face, layout.parent[face])).collect();
        for row in self.below.chunks_exact_mut(faces) {
            for &(face, parent) in &upwards {
                row[parent] += row[face];
            }
        }
        self.along.resize(faces * faces, 0.0);
        self.along[layout.root * faces..][..faces].fill(0.0);
        for &b in &layout.order[1..] {
            let hinge = layout.hinge[b].expect("only the root has none");
            let carried = &self.below[hinge * faces..][..faces];
            let (b, parent) = (b * faces, layout.parent[b] * faces);
            let (before, after) = self.along.split_at_mut(b.max(parent));
            let (to, from) = if b < parent {
                (&mut before[b..][..faces], &after[..faces])
            } else {
                (&mut after[..faces], &before[parent..][..faces])
            };
            for ((to, from), carried) in to.iter_mut().zip(from).zip(carried) {
                *to = from + carried;
            }
        }
    }

    #[inline]
    fn below(&self, face: usize, hinge: usize) -> f64 {
        self.below[hinge * self.faces + face]
    }

    #[inline]
    fn along(&self, c: usize, b: usize) -> f64 {
        self.along[b * self.faces + c]
    }
}

/// Returns the layout of the best single exchange that is allowed; `None` if none gains more than `gain`.
///
/// One more hinge between a and b closes a cycle; on a's side of it, some face c loses the hinge to its
/// parent, and the branch below c is attached to b by its face a. Outside the branch nothing changes. Within
/// it, the hinges between c and a carry what was on their other side.
fn exchange(
    target: &Target,
    weights: &Weights,
    layout: &Layout,
    (gain, branches): (f64, &mut Branches),
    steps: &mut u64,
    rules: &Rules,
) -> Option<Layout> {
    branches.compute(target, weights, layout);
    *steps = steps.saturating_sub(((branches.below.len() + branches.along.len()) / SUMS) as u64);
    let depths = layout.depths();
    let folding = |face: usize| layout.hinge[face].expect("only the root has none");
    let mut better: Vec<(f64, usize, usize)> = Vec::new();
    let mut way = Vec::new();
    let mut turned: Vec<(usize, f64)> = Vec::new();
    for (added, hinge) in target.hinges.iter().enumerate() {
        let [p, q] = hinge.faces;
        if layout.hinge[p] == Some(added) || layout.hinge[q] == Some(added) {
            continue;
        }
        for (a, b) in [(p, q), (q, p)] {
            side_of_cycle(layout, &depths, a, b, &mut way);
            turned.clear();
            for &c in &way {
                *steps = steps.checked_sub(1)?;
                let turns = turned.iter().map(|&(between, twice)| branches.below(c, between) - twice);
                let now = branches.along(c, b) + branches.below(c, added) + turns.sum::<f64>();
                let change = now - branches.along(c, c);
                turned.push((folding(c), 2.0 * branches.below(c, folding(c))));
                if change < -gain && (rules.fits)(layout, [folding(c), added]) {
                    better.push((change, added, folding(c)));
                }
            }
        }
    }
    // Of equal ones the first.
    better.sort_by(|x, y| x.0.total_cmp(&y.0));
    let exchanged = |&(_, added, dropped): &(f64, usize, usize)| layout.exchanged(target, dropped, added);
    better.iter().take(TRIED_MAX).map(exchanged).find(|layout| (rules.allowed)(layout))
}

/// Collects the faces from `a` up to where its path to the root meets that of `b`, without that face.
fn side_of_cycle(layout: &Layout, depths: &[usize], a: usize, b: usize, way: &mut Vec<usize>) {
    way.clear();
    let (mut x, mut y) = (a, b);
    while x != y {
        if depths[x] >= depths[y] {
            way.push(x);
            x = layout.parent[x];
        } else {
            y = layout.parent[y];
        }
    }
}

/// Returns the hinges (indices in [`Target::hinges`]) of the tree between two faces: those from `a` upwards, then
/// those from `b` upwards, both without the part that they share; empty for the same face. `layout`: the tree; `a`
/// and `b`: the faces as indices in [`Target::faces`](super::target::Target::faces).
pub fn path(layout: &Layout, a: usize, b: usize) -> Vec<usize> {
    let up = |mut face: usize| {
        let mut way = Vec::new();
        while let Some(hinge) = layout.hinge[face] {
            way.push(hinge);
            face = layout.parent[face];
        }
        way
    };
    let (mut from_a, mut from_b) = (up(a), up(b));
    while let (Some(x), Some(y)) = (from_a.last(), from_b.last())
        && x == y
    {
        from_a.pop();
        from_b.pop();
    }
    from_a.extend(from_b);
    from_a
}
