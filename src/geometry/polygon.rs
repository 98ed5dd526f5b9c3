//! Polygons in space as triangles.

use super::pose::Vec3;

/// Threshold: corners are in line if their triangle has at most this fraction of the polygon's area. 1e-12: a thousand times
/// what rounding makes of it metres away from the origin.
const TOL_IN_LINE: f64 = 1e-12;

/// Returns the triangles of a plane polygon, convex or not, whose `corners` (m) are given in order: three indices of
/// its corners each, from 0, with the same orientation; none for fewer than three corners. The method is ear clipping
/// (Meisters 1975), in cubic time. A polygon that crosses itself gives triangles, too, but they overlap.
pub fn triangulate(corners: &[Vec3]) -> Vec<[usize; 3]> {
    // Newell's normal, of twice the area.
    let n = corners.len();
    let normal: Vec3 = (0..n).map(|i| corners[i].cross(&corners[(i + 1) % n])).sum();
    let turn = |a: usize, b: usize, c: usize| {
        (corners[b] - corners[a]).cross(&(corners[c] - corners[b])).dot(&normal)
    };
    // Corners in line, which rounding may put on either side of it, are neither an ear nor outside of one.
    let in_line = TOL_IN_LINE * normal.norm_squared();
    let mut rest: Vec<usize> = (0..n).collect();
    let mut triangles = Vec::new();
    while rest.len() > 3 {
        let around =
            |i: usize| (rest[(i + rest.len() - 1) % rest.len()], rest[i], rest[(i + 1) % rest.len()]);
        let ear = |i: &usize| {
            let (a, b, c) = around(*i);
            let inside = |p: usize| [(a, b), (b, c), (c, a)].iter().all(|&(q, r)| turn(q, r, p) >= -in_line);
            turn(a, b, c) > in_line && !rest.iter().any(|&p| p != a && p != b && p != c && inside(p))
        };
        let cut = (0..rest.len()).find(ear).unwrap_or(0);
        let (a, b, c) = around(cut);
        triangles.push([a, b, c]);
        rest.remove(cut);
    }
    if let [a, b, c] = rest[..] {
        triangles.push([a, b, c]);
    }
    triangles
}
