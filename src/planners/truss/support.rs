//! What a truss stands on: the hull of the nodes on the ground, and how far inside it the centre of mass
//! is.

use super::structure::Structure;
use crate::geometry::Vec3;

/// Nodes below this part of the unit are on the ground.
pub const ON_GROUND: f64 = 1e-4;

/// Nodes on the ground.
pub fn contacts(truss: &Structure, x: &[Vec3]) -> Vec<usize> {
    (0..truss.nodes).filter(|&node| truss.around.above(x[node]) <= ON_GROUND * truss.unit).collect()
}

/// Whether a node that is on the ground at both ends of its way is so in between.
pub fn stays_down(truss: &Structure, from: Vec3, to: Vec3) -> bool {
    let terrain = truss.around.terrain.as_ref().filter(|_| from != to);
    terrain.is_none_or(|terrain| {
        let mut stays = true;
        terrain.profile(from, to, |_, height| stays &= height <= ON_GROUND * truss.unit);
        stays
    })
}

/// Their hull, counter-clockwise from above, without nodes on its edges.
pub fn hull(x: &[Vec3], contacts: &[usize]) -> Vec<usize> {
    let mut order = contacts.to_vec();
    order.sort_by(|&a, &b| x[a].x.total_cmp(&x[b].x).then(x[a].y.total_cmp(&x[b].y)));
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for node in order {
            while let [.., a, b] = chain[..]
                && left(x[a], x[b], x[node]) <= 0.0
            {
                chain.pop();
            }
            chain.push(node);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut order.iter().copied());
    hull.extend(half(&mut order.iter().rev().copied()));
    if hull.is_empty() { order } else { hull }
}

/// Twice the area of the triangle from above: positive if c is left of the way from a to b.
fn left(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The edge of a hull that a point is least inside of, and how far (m; negative outside). A hull of two
/// nodes has no inside. `None` with fewer.
pub fn margin(x: &[Vec3], hull: &[usize], at: Vec3) -> Option<(f64, (usize, usize))> {
    if hull.len() < 2 {
        return None;
    }
    let edges = (0..hull.len()).map(|i| (hull[i], hull[(i + 1) % hull.len()]));
    let inside = |(a, b): (usize, usize)| {
        let along = libm::hypot(x[b].x - x[a].x, x[b].y - x[a].y);
        (left(x[a], x[b], at) / along, (a, b))
    };
    edges.map(inside).min_by(|p, q| p.0.total_cmp(&q.0))
}

/// The three nodes of a hull whose triangle holds the centre of mass farthest inside; all of a hull of
/// fewer.
pub fn feet(x: &[Vec3], hull: &[usize], at: Vec3) -> Vec<usize> {
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
    best.map_or_else(|| hull.to_vec(), |(_, feet)| feet)
}
