//! Good layouts without proof: greedy growth, then exchange of hinges.

use super::layout::Layout;
use super::target::Target;
use super::weights::Weights;

/// An exchange has to gain this part of the energy, or rounding would go round in circles.
const GAIN_MIN: f64 = 1e-13;

/// A tree grown from the root: always the face is added whose path costs it least.
pub fn grown(target: &Target, weights: &Weights, root: usize) -> Layout {
    let n = target.faces.len();
    // By face: the hinges between it and the root, once it belongs to the tree.
    let mut paths: Vec<Option<Vec<usize>>> = vec![None; n];
    paths[root] = Some(Vec::new());
    let mut hinges = Vec::with_capacity(n - 1);
    // By face: the cheapest way to add it so far.
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

/// Exchanges a hinge that folds for one that doesn't as long as that helps. `steps`: how many
/// layouts may be tried, counted down.
pub fn improved(target: &Target, weights: &Weights, mut layout: Layout, steps: &mut u64) -> Layout {
    let mut energy = layout.energy(weights);
    while let Some((better, less)) = exchange(target, weights, &layout, energy, steps) {
        (layout, energy) = (better, less);
    }
    layout
}

/// The best single exchange, if one helps.
fn exchange(
    target: &Target,
    weights: &Weights,
    layout: &Layout,
    energy: f64,
    steps: &mut u64,
) -> Option<(Layout, f64)> {
    let mut best: Option<(Layout, f64)> = None;
    let folding = layout.hinges();
    for added in (0..target.hinges.len()).filter(|h| folding.binary_search(h).is_err()) {
        for dropped in cycle(target, layout, added) {
            if *steps == 0 {
                return best;
            }
            *steps -= 1;
            let hinges: Vec<usize> = folding.iter().map(|&h| if h == dropped { added } else { h }).collect();
            let Some(other) = Layout::of_hinges(target, &hinges, layout.root) else { continue };
            let less = other.energy(weights);
            if less < best.as_ref().map_or(energy * (1.0 - GAIN_MIN), |b| b.1) {
                best = Some((other, less));
            }
        }
    }
    best
}

/// The hinges of the tree on the cycle that one more hinge closes.
fn cycle(target: &Target, layout: &Layout, added: usize) -> Vec<usize> {
    let [a, b] = target.hinges[added].faces;
    path(layout, a, b)
}

/// The hinges of the tree between two faces.
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
