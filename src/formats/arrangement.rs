//! The arrangement of straight lines in the plane: the points in which they end, meet and cross, the edges between these,
//! and the closed walks round the faces (de Berg, Cheong, van Kreveld and Overmars 2008, *Computational Geometry*, 2.2).

use std::collections::{BTreeMap, BTreeSet};

/// A point in the plane.
type Point = [f64; 2];

/// Two lines whose directions enclose an angle with a sine below this do not cross: where they come near to each other,
/// ends lie on the other line.
const PARALLEL_SINE: f64 = 1e-9;

/// Lines that are split where they meet.
#[derive(Debug, Default)]
pub(super) struct Arrangement {
    /// The points, no two of which are within the tolerance of each other.
    pub(super) points: Vec<Point>,
    /// The lines that cover each edge, as indices among those given; an edge is named by its points, the lesser first.
    pub(super) edges: BTreeMap<[usize; 2], Vec<usize>>,
}

/// The points of an arrangement, with those near to a place in reach.
struct Points {
    tol: f64,
    origin: Point,
    points: Vec<Point>,
    cells: BTreeMap<[i64; 2], Vec<usize>>,
}

impl Points {
    /// Returns the index of the first point within the tolerance of a place, which is added where there is none.
    fn index(&mut self, place: Point) -> usize {
        let cell = [0, 1].map(|axis| libm::floor((place[axis] - self.origin[axis]) / self.tol) as i64);
        let around = (0..9).map(|k| [cell[0].saturating_add(k % 3 - 1), cell[1].saturating_add(k / 3 - 1)]);
        let known = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let near = |index: &usize| length(minus(self.points[*index], place)) <= self.tol;
        let found = known.copied().filter(near).min();
        found.unwrap_or_else(|| {
            self.points.push(place);
            self.cells.entry(cell).or_default().push(self.points.len() - 1);
            self.points.len() - 1
        })
    }
}

/// Returns the arrangement of lines: points within `tol` of each other are one, and a line goes through every point that
/// is within `tol` of it. `None` if it has more than `points_max` points or edges.
pub(super) fn arrangement(lines: &[[Point; 2]], tol: f64, points_max: usize) -> Option<Arrangement> {
    let origin = [0, 1].map(|axis| lines.iter().flatten().map(|point| point[axis]).fold(f64::MAX, f64::min));
    let mut points = Points { tol, origin, points: Vec::new(), cells: BTreeMap::new() };
    let ends: Vec<[usize; 2]> = lines.iter().map(|line| line.map(|end| points.index(end))).collect();
    for (k, a) in ends.iter().enumerate() {
        for b in &ends[k + 1..] {
            let line = |ends: &[usize; 2]| ends.map(|end| points.points[end]);
            if let Some(crossing) = crossing(line(a), line(b)) {
                points.index(crossing);
            }
        }
        if points.points.len() > points_max {
            return None;
        }
    }
    let points = points.points;
    let mut edges: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (index, &[a, b]) in ends.iter().enumerate() {
        if a == b {
            continue;
        }
        let (from, to) = (points[a], points[b]);
        let mut on: Vec<(f64, usize)> = vec![(0.0, a), (1.0, b)];
        for (point, place) in points.iter().enumerate() {
            if point != a && point != b {
                on.extend(part_on([from, to], *place, tol).map(|part| (part, point)));
            }
        }
        on.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for pair in on.windows(2) {
            let (a, b) = (pair[0].1, pair[1].1);
            edges.entry([a.min(b), a.max(b)]).or_default().push(index);
        }
        if edges.len() > points_max {
            return None;
        }
    }
    Some(Arrangement { points, edges })
}

/// Returns the point in which two lines cross, ends included; `None` if they do not, or are parallel.
fn crossing([p, q]: [Point; 2], [r, s]: [Point; 2]) -> Option<Point> {
    let (along, other, apart) = (minus(q, p), minus(s, r), minus(r, p));
    let sine = cross(along, other);
    if sine.abs() <= PARALLEL_SINE * length(along) * length(other) {
        return None;
    }
    let (part, part_of_other) = (cross(apart, other) / sine, cross(apart, along) / sine);
    let inside = 0.0..=1.0;
    let meet = inside.contains(&part) && inside.contains(&part_of_other);
    meet.then(|| [p[0] + part * along[0], p[1] + part * along[1]])
}

/// Returns the part of a line at which a point lies on it, strictly between 0 and 1; `None` if it is farther away than
/// `tol`.
pub(super) fn part_on([from, to]: [Point; 2], point: Point, tol: f64) -> Option<f64> {
    let (along, away) = (minus(to, from), minus(point, from));
    let size = length(along);
    let part = (along[0] * away[0] + along[1] * away[1]) / (size * size);
    (part > 0.0 && part < 1.0 && cross(along, away).abs() <= tol * size).then_some(part)
}

/// Returns the closed walks along edges in the plane that have the same face on the left all the way, as the points in
/// their order, each walk from its first edge on. Those round faces are counterclockwise, those along the outside clockwise.
pub(super) fn walks(points: &[Point], edges: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let direction = |from: usize, to: usize| {
        libm::atan2(points[to][1] - points[from][1], points[to][0] - points[from][0])
    };
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for &[a, b] in edges {
        around[a].push(b);
        around[b].push(a);
    }
    for (from, others) in around.iter_mut().enumerate() {
        others.sort_by(|a, b| direction(from, *a).total_cmp(&direction(from, *b)).then(a.cmp(b)));
    }
    // At each point the way goes on along the edge that is next to the right, which keeps the face on the left.
    let next = |from: usize, to: usize| {
        let others = &around[to];
        let back = others.iter().position(|other| *other == from).expect("edges lead both ways");
        others[(back + others.len() - 1) % others.len()]
    };
    let mut seen = BTreeSet::new();
    let mut walks = Vec::new();
    for &[a, b] in edges {
        for start in [[a, b], [b, a]] {
            let mut walk = Vec::new();
            let [mut from, mut to] = start;
            while seen.insert([from, to]) {
                walk.push(from);
                (from, to) = (to, next(from, to));
            }
            if !walk.is_empty() {
                walks.push(walk);
            }
        }
    }
    walks
}

/// Returns twice the area that a closed walk encloses, positive where it is counterclockwise.
pub(super) fn area(points: &[Point], walk: &[usize]) -> f64 {
    let corner = |k: usize| points[walk[k % walk.len()]];
    (0..walk.len()).map(|k| cross(corner(k), corner(k + 1))).sum()
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(a: Point) -> f64 {
    libm::hypot(a[0], a[1])
}
