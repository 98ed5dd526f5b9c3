//! Support polygons, the convex hulls of points on the ground, and the static stability margin: the distance
//! of the centre of mass inside such a polygon (McGhee and Frank 1968).

use crate::plan::tolerances::TOLERANCES;

/// A point on the ground: x and y in the world, m.
pub(super) type Point = [f64; 2];

/// The position of a point on the ground, such as the projected centre of mass, relative to a support polygon: the
/// static stability margin (McGhee and Frank 1968).
#[derive(Clone, Debug, PartialEq)]
pub struct Margin {
    /// The distance of the point to the nearest edge, m: positive inside, negative outside.
    pub distance: f64,
    /// The two ends of the nearest edge, as indices in the list of points that span the polygon, from 0,
    /// counter-clockwise seen from above.
    pub edge: (usize, usize),
    /// The least width of the polygon, m.
    pub width: f64,
}

/// Returns the corners of the support polygon, the convex hull of the points (Andrew's monotone chain),
/// counter-clockwise seen from above, as indices in `points`; points within an edge are left out, and of coinciding
/// points all but the first. One or two corners are left if the points span no area, none without points.
pub(super) fn hull(points: &[Point]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])).then(a.cmp(&b))
    });
    order.dedup_by(|b, a| points[*a] == points[*b]);
    if order.len() < 3 {
        return order;
    }
    let mut corners = chain(points, order.iter().copied());
    corners.pop();
    let mut upper = chain(points, order.iter().rev().copied());
    upper.pop();
    corners.extend(upper);
    corners
}

/// Returns one side of the hull, always turning left, as indices.
fn chain(points: &[Point], order: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut side: Vec<usize> = Vec::new();
    for index in order {
        while let [.., a, b] = side[..] {
            if cross(points[a], points[b], points[index]) > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(index);
    }
    side
}

/// Returns the static stability margin of the point `at`, the projected centre of mass, in the support polygon of
/// `points`. `None` if they span no area, or a polygon no wider than the tolerance `polygon_width`.
pub(super) fn margin(points: &[Point], at: Point) -> Option<Margin> {
    let corners = hull(points);
    if corners.len() < 3 {
        return None;
    }
    let edges = (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let mut nearest: Option<Margin> = None;
    let (mut inside, mut width) = (true, f64::INFINITY);
    for (a, b) in edges {
        let length = distance(points[a], points[b]);
        let height = cross(points[a], points[b], at) / length;
        inside &= height >= 0.0;
        let across = corners.iter().map(|&c| cross(points[a], points[b], points[c]) / length);
        width = width.min(across.fold(0.0, f64::max));
        let away = to_segment(points[a], points[b], at);
        if nearest.as_ref().is_none_or(|n| away < n.distance) {
            nearest = Some(Margin { distance: away, edge: (a, b), width: 0.0 });
        }
    }
    let nearest = nearest.filter(|_| width > TOLERANCES.polygon_width)?;
    let distance = if inside { nearest.distance } else { -nearest.distance };
    Some(Margin { distance, width, ..nearest })
}

/// Returns twice the signed area of a triangle, positive if `c` is on the left of `a b`.
fn cross(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn distance(a: Point, b: Point) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

fn to_segment(a: Point, b: Point, at: Point) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = (at[0] - a[0]) * dx + (at[1] - a[1]) * dy;
    let u = (along / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    distance([a[0] + u * dx, a[1] + u * dy], at)
}
