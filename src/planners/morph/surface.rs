//! The outer surface of a truss, and closest points of triangle meshes by a bounding sphere tree.

use crate::geometry::Vec3;
use crate::planners::truss::Structure;
use std::collections::BTreeMap;

/// The reason why a truss has no outer surface: its triangles of struts do not close one.
#[derive(Clone, Debug, PartialEq)]
pub struct Open {
    /// The edges of the truss's convex hull that do not lie between exactly two triangles of struts, as pairs of
    /// indices of nodes, the lesser first; empty if the hull has no such triangle.
    pub edges: Vec<(usize, usize)>,
}

/// Returns the outer triangles of struts with the nodes at `x`, m, each as three indices of nodes, counter-clockwise
/// as seen from outside: the boundary of the convex hull if struts triangulate it, else that of the union of the
/// tetrahedra of struts. `truss`: the truss with its struts.
///
/// # Errors
/// [`Open`] if neither boundary is closed.
pub fn outer(truss: &Structure, x: &[Vec3]) -> Result<Vec<[usize; 3]>, Open> {
    let mut after: Vec<Vec<usize>> = vec![Vec::new(); truss.nodes];
    for &(a, b) in &truss.struts {
        after[a.min(b)].push(a.max(b));
    }
    after.iter_mut().for_each(|list| list.sort_unstable());
    let hull = hull(truss, x, &after);
    let open = open_edges(&hull);
    if open.is_empty() && !hull.is_empty() {
        return Ok(hull);
    }
    let solid = solid(truss, x, &after);
    if open_edges(&solid).is_empty() && !solid.is_empty() { Ok(solid) } else { Err(Open { edges: open }) }
}

/// Returns the triangles of struts that have all nodes on one side.
fn hull(truss: &Structure, x: &[Vec3], after: &[Vec<usize>]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for [a, b, c] in cliques(after) {
        let normal = (x[b] - x[a]).cross(&(x[c] - x[a])).normalize();
        let sides = x.iter().map(|p| normal.dot(&(p - x[a])));
        let (low, high) = sides.fold((0.0f64, 0.0f64), |(low, high), s| (low.min(s), high.max(s)));
        let tolerance = truss.tolerances.coplanar * truss.unit;
        if high <= tolerance {
            triangles.push([a, b, c]);
        } else if low >= -tolerance {
            triangles.push([a, c, b]);
        }
    }
    triangles
}

/// Returns the triangles that belong to exactly one tetrahedron of struts.
fn solid(truss: &Structure, x: &[Vec3], after: &[Vec<usize>]) -> Vec<[usize; 3]> {
    let mut sides: BTreeMap<[usize; 3], (usize, [usize; 3])> = BTreeMap::new();
    for [a, b, c] in cliques(after) {
        let all = |d: &&usize| after[a].contains(d) && after[b].contains(d);
        for &d in after[c].iter().filter(all) {
            let volume = (x[b] - x[a]).cross(&(x[c] - x[a])).dot(&(x[d] - x[a]));
            if volume.abs() <= truss.tolerances.coplanar * truss.unit * truss.unit * truss.unit {
                continue;
            }
            for (mut side, across) in [([a, b, c], d), ([a, b, d], c), ([a, c, d], b), ([b, c, d], a)] {
                let key = side;
                let normal = (x[side[1]] - x[side[0]]).cross(&(x[side[2]] - x[side[0]]));
                if normal.dot(&(x[across] - x[side[0]])) > 0.0 {
                    side.swap(1, 2);
                }
                sides.entry(key).or_insert((0, side)).0 += 1;
            }
        }
    }
    sides.into_values().filter(|(uses, _)| *uses == 1).map(|(_, side)| side).collect()
}

/// Returns the triples of nodes, ascending, with struts between all three.
fn cliques(after: &[Vec<usize>]) -> Vec<[usize; 3]> {
    let mut found = Vec::new();
    for (a, others) in after.iter().enumerate() {
        for (i, &b) in others.iter().enumerate() {
            let both = others[i + 1..].iter().filter(|c| after[b].contains(c));
            found.extend(both.map(|&c| [a, b, c]));
        }
    }
    found
}

/// Returns the edges that are not between exactly two triangles.
fn open_edges(triangles: &[[usize; 3]]) -> Vec<(usize, usize)> {
    let mut uses: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *uses.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    uses.into_iter().filter(|(_, n)| *n != 2).map(|(edge, _)| edge).collect()
}

/// The point of a surface that is closest to a given point.
#[derive(Clone, Copy, Debug)]
pub struct ClosestPoint {
    /// The index in [`Surface::triangles`] of the triangle that the point lies on.
    pub triangle: usize,
    /// The barycentric coordinates of the point over the triangle's corners in their order, which sum to 1.
    pub weights: [f64; 3],
    /// The position of the point, m, in the frame of the surface.
    pub at: Vec3,
    /// The distance of the point from the one that was asked for, m.
    pub distance: f64,
}

/// The triangle of a surface that is closest to a point, or the point of a cloud, by index, and a lower bound of the distances
/// of all others from that point, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub triangle: usize,
    pub others: f64,
}

impl Nearest {
    /// Nothing is known: any may be the closest.
    pub(super) const UNKNOWN: Nearest = Nearest { triangle: 0, others: f64::NEG_INFINITY };
}

/// The number of moves like the last one for which a search looks ahead: so much farther it looks for other triangles.
const REACH: f64 = 8.0;
/// The part of the radius of a surface up to which a search looks ahead: farther, it finds too many triangles.
const REACH_MAX: f64 = 0.1;

/// A triangle mesh with a bounding sphere tree, for queries of closest points.
pub struct Surface {
    corners: Vec<[Vec3; 3]>,
    /// The planes that bound each triangle.
    sides: Vec<Sides>,
    /// The distance, m, by which rounding may make a bound too great.
    slack: f64,
    /// The spheres of the tree, depth first: the descendants of one follow it.
    balls: Vec<Ball>,
}

/// The part of the greatest coordinate by which rounding may make a bound of a distance too great: some hundreds of units in the
/// last place, where a bound takes some ten operations.
const SLACK: f64 = 512.0 * f64::EPSILON;

/// The plane of a triangle, and those through its edges at right angles to it: unit normals n and offsets d, m, with
/// n·p = d on the plane, and n·p > d beyond the edge. All zero for a triangle without area.
struct Sides {
    plane: (Vec3, f64),
    edges: [(Vec3, f64); 3],
}

impl Sides {
    fn of(&[a, b, c]: &[Vec3; 3]) -> Sides {
        let unit = |v: Vec3| v.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let normal = unit((b - a).cross(&(c - a)));
        let through = |normal: Vec3, p: Vec3| (normal, normal.dot(&p));
        let edge = |from: Vec3, to: Vec3| through(unit((to - from).cross(&normal)), from);
        Sides { plane: through(normal, a), edges: [edge(a, b), edge(b, c), edge(c, a)] }
    }

    /// Returns a lower bound of the squared distance of a point from the triangle.
    fn distance_squared(&self, p: &Vec3) -> f64 {
        let beyond = |(normal, along): &(Vec3, f64)| normal.dot(p) - along;
        let across = beyond(&self.plane);
        let [a, b, c] = self.edges.each_ref().map(beyond);
        let outside = a.max(b).max(c).max(0.0);
        across * across + outside * outside
    }
}

/// A bounding sphere of the tree, m.
struct Ball {
    middle: Vec3,
    radius: f64,
    /// The index of the first sphere that is no descendant.
    after: usize,
    /// The index of the triangle of a leaf; `None` for other spheres.
    triangle: Option<usize>,
}

impl Surface {
    /// Returns the surface with a bounding sphere tree over its triangles, given by their corners, m, in any
    /// orientation; there may be none.
    pub fn new(corners: Vec<[Vec3; 3]>) -> Surface {
        let mut order: Vec<usize> = (0..corners.len()).collect();
        let sides = corners.iter().map(Sides::of).collect();
        let slack = SLACK * corners.iter().flatten().map(Vec3::amax).fold(0.0, f64::max);
        let mut surface = Surface { balls: Vec::with_capacity(2 * corners.len()), sides, slack, corners };
        surface.grow(&mut order);
        surface
    }

    /// Adds the sphere around some triangles and its descendants, split at the median of their centroids along
    /// the longest side of the centroids' box.
    fn grow(&mut self, triangles: &mut [usize]) {
        if triangles.is_empty() {
            return;
        }
        let corners = &self.corners;
        let middle = |t: &usize| corners[*t].iter().sum::<Vec3>() / 3.0;
        let low = triangles.iter().map(middle).reduce(|a, b| a.inf(&b)).expect("there are some");
        let high = triangles.iter().map(middle).reduce(|a, b| a.sup(&b)).expect("there are some");
        let centre = (low + high) / 2.0;
        let points = triangles.iter().flat_map(|t| corners[*t]);
        let radius = points.map(|p| (p - centre).norm()).fold(0.0, f64::max);
        let at = self.balls.len();
        let triangle = (triangles.len() == 1).then(|| triangles[0]);
        if triangle.is_none() {
            let side = (high - low).imax();
            triangles.sort_by(|a, b| middle(a)[side].total_cmp(&middle(b)[side]).then(a.cmp(b)));
        }
        self.balls.push(Ball { middle: centre, radius, after: 0, triangle });
        if triangle.is_none() {
            let (left, right) = triangles.split_at_mut(triangles.len() / 2);
            self.grow(left);
            self.grow(right);
        }
        self.balls[at].after = self.balls.len();
    }

    /// Returns the corners of all triangles in the order given to [`Surface::new`], m.
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.corners
    }

    /// Returns the point of the surface closest to `p`, m; of triangles equally near that of least index. The index in
    /// [`Surface::triangles`] of a triangle that is known to be near may be given as a `guess` to prune the search,
    /// `None` otherwise; the result does not depend on it. Panics if the surface has no triangle, or none of that
    /// index.
    pub fn closest(&self, p: Vec3, guess: Option<usize>) -> ClosestPoint {
        self.closest_and_others(p, guess.unwrap_or(0), 0.0).0
    }

    /// Returns the point of the surface closest to `p`, as [`closest`](Self::closest) does. `nearest`: what was found before
    /// point and corners of the surface have moved, the one from the others by at most `moved`, m; it is renewed. The others
    /// are searched only where one of them may be nearer by now.
    pub(super) fn follow(&self, p: Vec3, nearest: &mut Nearest, moved: f64) -> ClosestPoint {
        nearest.others -= moved + self.slack;
        if nearest.others > 0.0 {
            let foot = self.closest_of(nearest.triangle, p);
            if foot.distance < nearest.others {
                return foot;
            }
        }
        let reach = Some(REACH * moved).filter(|reach| *reach <= REACH_MAX * self.balls[0].radius);
        let (foot, others) = self.closest_and_others(p, nearest.triangle, reach.unwrap_or(0.0));
        *nearest = Nearest { triangle: foot.triangle, others };
        foot
    }

    /// Returns the point of the surface closest to `p`, and a lower bound of the distances of all other triangles, which is
    /// not more than `reach` above the least.
    fn closest_and_others(&self, p: Vec3, guess: usize, reach: f64) -> (ClosestPoint, f64) {
        let mut best = self.closest_of(guess, p);
        let mut others = f64::INFINITY;
        let mut i = 0;
        while let Some(ball) = self.balls.get(i) {
            let near = others.min(best.distance + reach) + self.slack;
            let apart = near + ball.radius;
            if (p - ball.middle).norm_squared() > apart * apart {
                i = ball.after;
                continue;
            }
            i += 1;
            let Some(triangle) = ball.triangle.filter(|triangle| *triangle != best.triangle) else {
                continue;
            };
            let bound = self.sides[triangle].distance_squared(&p);
            if bound > near * near {
                continue;
            }
            let nearer = best.distance + self.slack;
            if bound > nearer * nearer {
                others = others.min(bound.sqrt());
                continue;
            }
            let found = self.closest_of(triangle, p);
            let replaces = found.distance < best.distance
                || (found.distance == best.distance && triangle < best.triangle);
            others = others.min(if replaces { best.distance } else { found.distance });
            if replaces {
                best = found;
            }
        }
        (best, others.min(best.distance + reach))
    }

    /// Returns the point of a triangle closest to `p`.
    fn closest_of(&self, triangle: usize, p: Vec3) -> ClosestPoint {
        let corners = &self.corners[triangle];
        let weights = closest_weights(p, corners);
        let at = (0..3).map(|k| corners[k] * weights[k]).sum::<Vec3>();
        ClosestPoint { triangle, weights, at, distance: (p - at).norm() }
    }
}

/// Returns the barycentric coordinates of the point of a triangle closest to `p` (Ericson, Real-Time Collision
/// Detection, 5.1.5).
fn closest_weights(p: Vec3, &[a, b, c]: &[Vec3; 3]) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(&(p - a)), ac.dot(&(p - a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (ab.dot(&(p - b)), ac.dot(&(p - b)));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let (d5, d6) = (ab.dot(&(p - c)), ac.dot(&(p - c)));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let total = va + vb + vc;
    [va / total, vb / total, vc / total]
}
