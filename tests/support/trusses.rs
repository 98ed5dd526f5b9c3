//! The robot of the linear-actuator-robots paper and its targets, for the tests of its planners.

use modl::geometry::Vec3;
use modl::planners::locomote::{self, Objective, Settings};
use modl::planners::morph::{Surface, Target};
use modl::planners::truss::problem::TrussProblem;
use modl::planners::truss::{Limits, Structure, rigidity_kept};
use modl::robot::Strut;
use serde_json::Value;

/// Numbers found by another program; the file says how.
pub fn truth() -> Value {
    serde_json::from_str(include_str!("../truth/truss.json")).expect("JSON")
}

/// Struts of a length of 1 at first.
pub fn actuator() -> Strut {
    let name = "Actuator".to_owned();
    let (acceleration, buckling, node_mass) = (None, None, None);
    let (length, clearance) = ((0.3, 3.0), 0.1);
    Strut { name, length, speed: 1.0, force: 1.0, mass: 1.0, clearance, acceleration, buckling, node_mass }
}

/// By the steps of the paper, with relaxed ones where they are needed.
pub fn stepping(objective: Objective, steps_max: usize) -> Settings {
    Settings { objective, steps_max, ..Settings::default() }
}

pub fn robot() -> (Structure, Vec<Vec3>) {
    let truth = truth();
    let places: Vec<[f64; 3]> = serde_json::from_value(truth["vertices"].clone()).expect("places");
    let start: Vec<Vec3> = places.into_iter().map(Vec3::from).collect();
    let struts: Vec<(usize, usize)> = serde_json::from_value(truth["edges"].clone()).expect("pairs");
    (Structure::new(&actuator(), &start, &struts), start)
}

/// A target of rectangles, with points in the middles of squares of an eighth (`targets` of the truth).
fn rectangles(sides: &[[[f64; 3]; 3]]) -> Target {
    const APART: f64 = 0.125;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for [o, u, v] in sides.iter().map(|side| side.map(Vec3::from)) {
        let count = |edge: &Vec3| libm::round(edge.norm() / APART).max(1.0);
        let (n, m) = (count(&u), count(&v));
        for i in 0..n as usize {
            for j in 0..m as usize {
                points.push(o + u * ((i as f64 + 0.5) / n) + v * ((j as f64 + 0.5) / m));
            }
        }
        triangles.extend([[o, o + u, o + u + v], [o, o + u + v, o + v]]);
    }
    Target { surface: Some(Surface::new(triangles)), ..Target::cloud(points) }
}

/// Side 2.
pub fn cube() -> Target {
    let mut sides = Vec::new();
    for k in 0..3 {
        for c in [0.0, 2.0] {
            let along = |axis: usize, length: f64| {
                let mut v = [0.0; 3];
                v[axis % 3] = length;
                v
            };
            sides.push([along(k, c), along(k + 1, 2.0), along(k + 2, 2.0)]);
        }
    }
    rectangles(&sides)
}

/// Arms of length 3, width and height 1.
pub fn ell() -> Target {
    let mut sides = Vec::new();
    for y in [0.0, 1.0] {
        sides.push([[0.0, y, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        sides.push([[0.0, y, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
    }
    let across = [0.0, 1.0, 0.0];
    for (o, u) in [
        ([0.0, 0.0, 0.0], [3.0, 0.0, 0.0]),
        ([3.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.0, 1.0], [2.0, 0.0, 0.0]),
        ([1.0, 0.0, 1.0], [0.0, 0.0, 2.0]),
        ([0.0, 0.0, 3.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 3.0]),
    ] {
        sides.push([o, u, across]);
    }
    rectangles(&sides)
}

/// A bar of length 3 on a post of height 2, width and depth 1.
pub fn tee() -> Target {
    let mut sides = Vec::new();
    for y in [0.0, 1.0] {
        sides.push([[0.0, y, 2.0], [3.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        sides.push([[1.0, y, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
    }
    let across = [0.0, 1.0, 0.0];
    for (o, u) in [
        ([0.0, 0.0, 3.0], [3.0, 0.0, 0.0]),
        ([0.0, 0.0, 2.0], [1.0, 0.0, 0.0]),
        ([2.0, 0.0, 2.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
        ([3.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, 2.0]),
        ([2.0, 0.0, 0.0], [0.0, 0.0, 2.0]),
        ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
    ] {
        sides.push([o, u, across]);
    }
    rectangles(&sides)
}

/// The least distance of two segments, by looking: a grid of places on one, and for each the nearest of
/// the other, again and again around the best.
pub fn distance(p: [Vec3; 2], q: [Vec3; 2]) -> f64 {
    let to_q = |point: Vec3| {
        let along = q[1] - q[0];
        let part = ((point - q[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (point - q[0] - along * part).norm()
    };
    let (mut low, mut high) = (0.0, 1.0);
    let at = |part: f64| to_q(p[0] + (p[1] - p[0]) * part);
    // The distance to a segment is convex along another.
    for _ in 0..60 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(a) <= at(b) { high = b } else { low = a }
    }
    at((low + high) / 2.0)
}

/// The least distance of struts that share no node, the least height, and the lengths, at `samples`
/// moments between two places of the nodes.
pub fn looked_at(truss: &Structure, x: &[Vec3], y: &[Vec3], samples: usize) -> (f64, f64, (f64, f64)) {
    let (mut apart, mut height, mut lengths) = (f64::INFINITY, f64::INFINITY, (f64::INFINITY, 0.0f64));
    // No point of a strut moves more than its ends do; so a distance bounds that of the later moments.
    let way = |node: usize| (y[node] - x[node]).norm();
    let mut bounds = vec![f64::NEG_INFINITY; truss.struts.len() * truss.struts.len()];
    for sample in 0..=samples {
        let part = sample as f64 / samples as f64;
        let at: Vec<Vec3> = x.iter().zip(y).map(|(p, q)| p + (q - p) * part).collect();
        height = at.iter().map(|p| p.z).fold(height, f64::min);
        for (i, &(a, b)) in truss.struts.iter().enumerate() {
            let length = (at[a] - at[b]).norm();
            lengths = (lengths.0.min(length), lengths.1.max(length));
            for (j, &(c, d)) in truss.struts.iter().enumerate().skip(i + 1) {
                if a == c || a == d || b == c || b == d {
                    continue;
                }
                let bound = &mut bounds[i * truss.struts.len() + j];
                let travel = (way(a).max(way(b)) + way(c).max(way(d))) * part + 1e-12;
                // Balls around them say enough of most.
                let far = ((at[a] + at[b]) - (at[c] + at[d])).norm() / 2.0;
                let reach = (length + (at[c] - at[d]).norm()) / 2.0;
                if *bound - travel >= apart || far - reach >= apart {
                    continue;
                }
                let gap = distance([at[a], at[b]], [at[c], at[d]]);
                *bound = gap + travel - 2e-12;
                apart = apart.min(gap);
            }
        }
    }
    (apart, height, lengths)
}

/// Returns the problem of a program: the truss of pneumatic reels of the library, with the rigidity that programs keep.
pub fn reels(truss: &Structure, start: &[Vec3], corners: &[[f64; 2]]) -> locomote::Problem {
    let from = truss.centre_of_mass(start);
    let limits = Limits { rigidity: rigidity_kept(start, &truss.struts), ..Limits::default() };
    let strut = Strut {
        name: "PneumaticReel".to_owned(),
        length: (0.3, 3.0),
        speed: 0.05,
        acceleration: Some(0.25),
        force: 1500.0,
        mass: 1.0,
        clearance: 0.1,
        buckling: None,
        node_mass: None,
    };
    let truss = TrussProblem {
        strut,
        node_names: (0..truss.nodes).map(|i| format!("n[{i}]")).collect(),
        nodes: start.to_vec(),
        struts: truss.struts.clone(),
        limits,
        obstacles: Vec::new(),
        terrain: None,
        friction: 1.0,
    };
    locomote::Problem { truss, path: corners.iter().map(|[x, y]| [from.x + x, from.y + y]).collect() }
}

/// A tetrahedron of so many divisions, with what is inside, edges of 1.
pub fn octet(divisions: i64) -> (Structure, Vec<Vec3>) {
    let high = libm::sqrt(3.0) / 2.0;
    let mut places = Vec::new();
    for k in 0..=divisions {
        for j in 0..=divisions - k {
            for i in 0..=divisions - k - j {
                let (i, j, k) = (i as f64, j as f64, k as f64);
                let up = libm::sqrt(2.0 / 3.0) * k;
                places.push(Vec3::new(i + j / 2.0 + k / 2.0, high * j + high / 3.0 * k, up));
            }
        }
    }
    let near = |a: usize, b: usize| (places[a] - places[b]).norm() < 1.01;
    let pairs = (0..places.len()).flat_map(|a| (a + 1..places.len()).map(move |b| (a, b)));
    let struts: Vec<(usize, usize)> = pairs.filter(|&(a, b)| near(a, b)).collect();
    (Structure::new(&actuator(), &places, &struts), places)
}
