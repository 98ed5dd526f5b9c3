//! The flat pattern of a layout in the plane, and its overlaps.

use super::layout::{Across, Layout};
use super::target::Target;
use super::tolerances::TOLERANCES;
use robust::{Coord, orient2d};

/// A point (x, y) of the plane of the flat pattern, m.
pub type Point = [f64; 2];

/// The flat pattern of a layout: its faces laid side by side in the plane, the root with its first corner at the origin
/// and its first side along x; counterclockwise as seen from outside.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// The corners of each face of the target in the plane, m: faces and corners in the order of [`Target::faces`].
    pub corners: Vec<Vec<Point>>,
    /// The cell of each face on the triangular lattice, as the sum of its three [`lattice_corners`], which no two
    /// cells share; `None` if the faces are not equilateral triangles of one size.
    pub cells: Option<Vec<[i64; 2]>>,
}

/// Returns true if all faces of a target are triangles and their sides of one length, to `TOLERANCES.equal_sides` of it.
pub fn has_equal_triangles(target: &Target) -> bool {
    let side = target.side_lengths(0)[0];
    target.faces.iter().all(|face| face.len() == 3)
        && target.check_sides(side, TOLERANCES.equal_sides * side).is_ok()
}

impl Pattern {
    /// Returns the flat pattern of a layout of a target: on the triangular lattice, exactly, if the faces are triangles
    /// whose sides are all equal (up to `TOLERANCES.equal_sides`); else laid out face by face from the root on, in
    /// floating point.
    pub fn of(target: &Target, layout: &Layout) -> Pattern {
        if has_equal_triangles(target) { on_lattice(target, layout) } else { in_plane(target, layout) }
    }

    /// Returns the pairs of faces (indices in [`Target::faces`]) whose interiors overlap, each with the lesser face
    /// first, in ascending order.
    pub fn overlaps(&self) -> Vec<[usize; 2]> {
        match &self.cells {
            Some(cells) => same_cells(cells),
            None => self.crossing(),
        }
    }

    /// Returns the pairs of polygons that overlap, by tests of all pairs whose circles do.
    fn crossing(&self) -> Vec<[usize; 2]> {
        let mut found = Vec::new();
        let circles: Vec<(Point, f64)> = self.corners.iter().map(|corners| circle(corners)).collect();
        let apart = |a: usize, b: usize| {
            let (([x, y], r), ([u, v], s)) = (circles[a], circles[b]);
            (x - u) * (x - u) + (y - v) * (y - v) > (r + s) * (r + s)
        };
        for b in 0..self.corners.len() {
            crate::interrupt::checkpoint();
            for a in 0..b {
                if !apart(a, b) && overlap(&self.corners[a], &self.corners[b]) {
                    found.push([a, b]);
                }
            }
        }
        found.sort_unstable();
        found
    }
}

/// Returns the circle around the mean of the corners with all of them in it.
fn circle(corners: &[Point]) -> (Point, f64) {
    let [x, y] = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64);
    let far = corners.iter().map(|[u, v]| (u - x) * (u - x) + (v - y) * (v - y)).fold(0.0, f64::max);
    ([x, y], libm::sqrt(far))
}

/// Returns the pairs of faces on one cell, in order.
fn same_cells(cells: &[[i64; 2]]) -> Vec<[usize; 2]> {
    let mut sorted: Vec<([i64; 2], usize)> = cells.iter().enumerate().map(|(i, c)| (*c, i)).collect();
    sorted.sort_unstable();
    let mut found = Vec::new();
    for group in sorted.chunk_by(|a, b| a.0 == b.0) {
        for (i, (_, b)) in group.iter().enumerate() {
            found.extend(group[..i].iter().map(|(_, a)| [*a, *b]));
        }
    }
    found.sort_unstable();
    found
}

/// Returns the corners of all faces of a target of triangles whose sides are all equal, in the order of [`Target::faces`], as
/// whole numbers of the triangular lattice's two steps, which enclose 60°; the root's are (0, 0), (1, 0) and (0, 1).
/// They are exact: a face's free corner is the mirror image of its parent's, `a + b - c`. `layout`: the tree of
/// hinges across which faces are laid side by side.
pub fn lattice_corners(target: &Target, layout: &Layout) -> Vec<[[i64; 2]; 3]> {
    let mut corners = vec![[[0, 0]; 3]; target.faces.len()];
    corners[layout.root] = [[0, 0], [1, 0], [0, 1]];
    for &face in &layout.order[1..] {
        let Across { parent, parent_side: k, side: m } = layout.across(target, face);
        let p = corners[parent];
        let (a, b, c) = (p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
        corners[face][m] = b;
        corners[face][(m + 1) % 3] = a;
        corners[face][(m + 2) % 3] = [a[0] + b[0] - c[0], a[1] + b[1] - c[1]];
    }
    corners
}

/// Lays out a layout of equal sides on the triangular lattice.
fn on_lattice(target: &Target, layout: &Layout) -> Pattern {
    let lattice = lattice_corners(target, layout);
    let side = target.side_lengths(layout.root)[0];
    let height = libm::sqrt(0.75);
    let point = |[i, j]: [i64; 2]| [side * (i as f64 + 0.5 * j as f64), side * height * j as f64];
    let cells = lattice.iter().map(|c| [c[0][0] + c[1][0] + c[2][0], c[0][1] + c[1][1] + c[2][1]]);
    Pattern { cells: Some(cells.collect()), corners: lattice.iter().map(|c| c.map(point).to_vec()).collect() }
}

/// Lays out a layout of any sides, face by face from the root on.
fn in_plane(target: &Target, layout: &Layout) -> Pattern {
    let mut corners: Vec<Vec<Point>> = target.faces.iter().map(|face| vec![[0.0; 2]; face.len()]).collect();
    for &face in &layout.order {
        // Along the side at the hinge from `from` to `to`, which the face has on its left.
        let (m, from, to) = if face == layout.root {
            (0, [0.0, 0.0], [target.side_lengths(face)[0], 0.0])
        } else {
            let Across { parent, parent_side: k, side: m } = layout.across(target, face);
            (m, corners[parent][(k + 1) % target.side_count(parent)], corners[parent][k])
        };
        let own = target.corners(face);
        let sides = own.len();
        let (a, b) = (own[m], own[(m + 1) % sides]);
        let along = (b - a).normalize();
        let length = (b - a).norm();
        let u = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
        corners[face][m] = from;
        corners[face][(m + 1) % sides] = to;
        for k in (2..sides).map(|k| (m + k) % sides) {
            // All of a convex face is to the left of each of its sides.
            let c = own[k];
            let (x, y) = ((c - a).dot(&along), (c - a).cross(&along).norm());
            corners[face][k] = [from[0] + u[0] * x - u[1] * y, from[1] + u[1] * x + u[0] * y];
        }
    }
    Pattern { corners, cells: None }
}

/// Returns true if the interiors of two counterclockwise convex polygons meet: no side of either separates them.
fn overlap(a: &[Point], b: &[Point]) -> bool {
    !parts(a, b) && !parts(b, a)
}

/// Returns true if the line through a side of `a` has all of `b` on its outer side. The side on which a
/// corner lies is computed without rounding; the tolerance is for the rounding of the corners themselves.
fn parts(a: &[Point], b: &[Point]) -> bool {
    let coordinate = |[x, y]: Point| Coord { x, y };
    (0..a.len()).any(|k| {
        let (p, q) = (a[k], a[(k + 1) % a.len()]);
        let [dx, dy] = [q[0] - p[0], q[1] - p[1]];
        let tol = TOLERANCES.overlap * (dx * dx + dy * dy);
        b.iter().all(|&x| orient2d(coordinate(p), coordinate(q), coordinate(x)) <= tol)
    })
}
