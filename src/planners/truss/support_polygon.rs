//! Static stability: the support polygon, the convex hull of the contacts with the ground, and the signed
//! distance of the centre of mass from its boundary (the static stability margin of McGhee and Frank 1968).

use super::positions::towards;
use super::structure::Structure;
use crate::geometry::{Vec3, monotone_chain};

/// Returns the indices of the nodes on the ground, ascending: those at most the tolerance `contact_height` (in unit
/// lengths) above it. `x`: the positions of the nodes, m.
pub(in crate::planners) fn contacts(truss: &Structure, x: &[Vec3]) -> Vec<usize> {
    let height = truss.tolerances.contact_height * truss.unit;
    (0..truss.nodes).filter(|&node| truss.surroundings.height(x[node]) <= height).collect()
}

/// Returns true if a node on the ground at both ends, `from` and `to` (m), of a linear motion stays on it in between;
/// always true without terrain.
pub(in crate::planners) fn stays_in_contact(truss: &Structure, from: Vec3, to: Vec3) -> bool {
    let height_max = truss.tolerances.contact_height * truss.unit;
    let terrain = truss.surroundings.terrain.as_ref().filter(|_| from != to);
    terrain.is_none_or(|terrain| {
        let mut stays = true;
        terrain.profile(from, to, |_, height| stays &= height <= height_max);
        stays
    })
}

/// The number of bisections of a step: more than a double has bits.
const BISECTIONS: usize = 60;

/// Returns the indices of the nodes that stay on the ground while they move linearly from `x` to `y`, m.
pub(in crate::planners) fn staying(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<usize> {
    let now = contacts(truss, y);
    let stays = |node: &usize| now.contains(node) && stays_in_contact(truss, x[*node], y[*node]);
    contacts(truss, x).into_iter().filter(stays).collect()
}

/// Returns the positions of the nodes, m, as far on the way from `x` to `y` as the truss is statically stable on the
/// nodes that stay on the ground till then (by bisection).
pub(in crate::planners) fn standing(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<Vec3> {
    let stable = |z: &[Vec3]| {
        let margin = stability_margin(truss, z, &staying(truss, x, z));
        margin.is_some_and(|(inside, _)| inside >= 0.0)
    };
    if stable(y) { y.to_vec() } else { towards(x, y, bisected(x, y, stable).0) }
}

/// Returns true if the truss is statically stable all the way from `x` to `z` (m), up to the tolerance `stability_dip`, on the
/// nodes that stay on the ground. The ends tell where these are at rest, since the distance of the centre of mass from
/// each edge is linear then. Conservative advancement tells where some slide: that distance changes no faster than the
/// fastest of them moves against the centre of mass.
pub(in crate::planners) fn stands_all_the_way(truss: &Structure, x: &[Vec3], z: &[Vec3]) -> bool {
    let feet = staying(truss, x, z);
    let dip = truss.tolerances.stability_dip * truss.unit;
    let centre = truss.centre_of_mass(z) - truss.centre_of_mass(x);
    let against = |&node: &usize| {
        let way = z[node] - x[node] - centre;
        libm::hypot(way.x, way.y)
    };
    let slides = |&node: &usize| x[node] != z[node];
    let fastest = if feet.iter().any(slides) { feet.iter().map(against).fold(0.0, f64::max) } else { 0.0 };
    let mut part = 0.0;
    loop {
        let margin = stability_margin(truss, &towards(x, z, part), &feet);
        let Some((inside, _)) = margin.filter(|(inside, _)| *inside >= -dip) else { return false };
        if part >= 1.0 {
            return true;
        }
        part = if fastest > 0.0 { (part + (inside + 2.0 * dip) / fastest).min(1.0) } else { 1.0 };
    }
}

/// Returns the positions of the nodes, m, at which the first node touches the ground on the way from `x` to `y` that is not on
/// it at `x` (by bisection); `y` if none does.
pub(in crate::planners) fn touching_down(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<Vec3> {
    let touches = |z: &[Vec3]| contacts(truss, z).len() > staying(truss, x, z).len();
    if touches(y) { towards(x, y, bisected(x, y, |z| !touches(z)).1) } else { y.to_vec() }
}

/// Returns the parts of the way from `x` to `y`, next to each other, at which something still holds, and no longer (by
/// bisection). It must hold at `x`, and not at `y`.
fn bisected(x: &[Vec3], y: &[Vec3], holds: impl Fn(&[Vec3]) -> bool) -> (f64, f64) {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = (low + high) / 2.0;
        if holds(&towards(x, y, middle)) { low = middle } else { high = middle }
    }
    (low, high)
}

/// Returns the support polygon as indices of nodes: the convex hull of the contacts seen from above, counter-clockwise,
/// without nodes on its edges (Andrew's monotone chain). `x`: the positions of the nodes, m; `contacts`: their indices.
pub(in crate::planners) fn hull(x: &[Vec3], contacts: &[usize]) -> Vec<usize> {
    let mut order = contacts.to_vec();
    order.sort_by(|&a, &b| x[a].x.total_cmp(&x[b].x).then(x[a].y.total_cmp(&x[b].y)));
    let hull = monotone_chain(&order, |a, b, c| cross(x[a], x[b], x[c]) > 0.0);
    if hull.is_empty() { order } else { hull }
}

/// Returns twice the signed area of a triangle seen from above, m²; positive if c is left of the line from
/// a to b.
fn cross(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Returns (distance, edge): the signed distance of the point `at` from the boundary of a hull (nodes as by [`hull`])
/// seen from above, m, positive inside, and the edge that it is nearest to, as two nodes. A hull of two nodes has no
/// inside. `None` with fewer. `x`: the positions of the nodes, m.
pub(in crate::planners) fn margin(x: &[Vec3], hull: &[usize], at: Vec3) -> Option<(f64, (usize, usize))> {
    if hull.len() < 2 {
        return None;
    }
    let edges = (0..hull.len()).map(|i| (hull[i], hull[(i + 1) % hull.len()]));
    let inside = |(a, b): (usize, usize)| {
        let along = libm::hypot(x[b].x - x[a].x, x[b].y - x[a].y);
        (cross(x[a], x[b], at) / along, (a, b))
    };
    edges.map(inside).min_by(|p, q| p.0.total_cmp(&q.0))
}

/// Returns (margin, edge): the static stability margin (McGhee and Frank 1968) of the truss on some contacts (indices
/// of nodes), m, negative if it topples, and the edge of the support polygon nearest to the centre of mass, as two
/// nodes. `None` with fewer than two contacts.
pub(in crate::planners) fn stability_margin(
    truss: &Structure,
    x: &[Vec3],
    contacts: &[usize],
) -> Option<(f64, (usize, usize))> {
    margin(x, &hull(x, contacts), truss.centre_of_mass(x))
}

/// Returns the three nodes of a hull (as by [`hull`]) whose triangle holds the point `at` (x and y in m) with the
/// greatest margin; all nodes of a hull of fewer.
pub(in crate::planners) fn support_triangle(x: &[Vec3], hull: &[usize], at: Vec3) -> Vec<usize> {
    let mut best: Option<(f64, Vec<usize>)> = None;
    for (i, &a) in hull.iter().enumerate() {
        for (j, &b) in hull.iter().enumerate().skip(i + 1) {
            for &c in &hull[j + 1..] {
                let Some((inside, _)) = margin(x, &[a, b, c], at) else { continue };
                if best.as_ref().is_none_or(|(most, _)| inside > *most) {
                    best = Some((inside, vec![a, b, c]));
                }
            }
        }
    }
    best.map_or_else(|| hull.to_vec(), |(_, nodes)| nodes)
}
