//! Ways in the plane: against closed forms, and against a search over all orders of corners written another way.

use crate::support::numbers::Numbers;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Shape, Vec3};
use modl::plan::Obstacle;
use modl::planners::NoProgress;
use modl::planners::planar_path::{Path, Problem, Refusal, Settings, plan};
use std::f64::consts::PI;

fn obstacle(name: &str, shape: Shape, x: f64, y: f64) -> Obstacle {
    let pose = shifted(Vec3::new(x, y, 0.1));
    Obstacle { name: name.to_owned(), shapes: vec![Placed { pose, shape }] }
}

fn block(name: &str, size: [f64; 2], x: f64, y: f64) -> Obstacle {
    obstacle(name, Shape::Box { size: Vec3::new(size[0], size[1], 0.2) }, x, y)
}

fn way(obstacles: &[Obstacle], from: [f64; 2], to: [f64; 2], clearance: f64) -> Result<Path, Refusal> {
    plan(&Problem { obstacles, from, to, clearance }, &Settings::default(), &mut NoProgress)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()
}

#[test]
fn the_way_round_a_square_turns_at_its_corners() {
    let square = [block("wall", [2.0, 2.0], 0.0, 0.0)];
    let path = way(&square, [-3.0, 0.0], [3.0, 0.1], 0.0).expect("there is a way");
    assert_eq!(path.points, [[-3.0, 0.0], [-1.0, 1.0], [1.0, 1.0], [3.0, 0.1]]);
    let length = 5.0_f64.sqrt() + 2.0 + (4.0_f64 + 0.81).sqrt();
    assert!((path.length - length).abs() < 1e-12, "{} instead of {length}", path.length);
    // Along its side, and past it, the way is straight.
    assert_eq!(way(&square, [-3.0, 1.0], [3.0, 1.0], 0.0).map(|path| path.points.len()), Ok(2));
    assert_eq!(way(&square, [-3.0, 1.0 - 1e-6], [3.0, 1.0], 0.0).map(|path| path.points.len()), Ok(3));
}

#[test]
fn the_way_round_a_disc_is_two_tangents_and_an_arc() {
    // From 5 m before to 5 m behind a disc that is 3 m wide with its clearance: tangents of 4 m that meet it at an
    // angle acos(3/5) from the axis, and the arc between them.
    let arc = PI - 2.0 * libm::acos(3.0 / 5.0);
    let length = 8.0 + 3.0 * arc;
    for (shape, clearance) in [
        (Shape::Sphere { radius: 1.0 }, 2.0),
        (Shape::Cylinder { radius: 2.5, length: 1.0, axis: Vec3::z() }, 0.5),
        (Shape::Capsule { radius: 3.0, length: 4.0, axis: Vec3::z() }, 0.0),
    ] {
        let path = way(&[obstacle("post", shape, 0.0, 0.0)], [-5.0, 0.0], [5.0, 0.0], clearance);
        let found = path.expect("there is a way").length;
        // Tangents round an arc are longer than it, by at most tan(x)/x with x a sixteenth of half a turn.
        assert!(found >= length - 1e-9, "{found} is shorter than {length}");
        assert!(found <= length * 1.013, "{found} instead of {length}");
    }
}

#[test]
fn a_lying_cylinder_is_seen_as_a_rectangle() {
    let log = obstacle("log", Shape::Cylinder { radius: 0.5, length: 4.0, axis: Vec3::y() }, 0.0, 0.0);
    let path = way(&[log], [-0.501, 0.0], [0.501, 0.0], 0.0).expect("half a millimetre beside it is outside");
    assert!((path.length - 5.0).abs() < 2e-3, "{}", path.length);
}

#[test]
fn what_is_in_the_way_is_named() {
    let walls = [
        block("north", [4.0, 0.2], 0.0, 2.0),
        block("south", [4.0, 0.2], 0.0, -2.0),
        block("east", [0.2, 4.4], 2.0, 0.0),
        block("west", [0.2, 4.4], -2.0, 0.0),
    ];
    let name = |name: &str| vec![name.to_owned()];
    assert_eq!(way(&walls, [0.0, 0.0], [9.0, 0.0], 0.1), Err(Refusal::Enclosed { obstacles: name("east") }));
    assert_eq!(way(&walls, [0.0, 9.0], [0.0, 0.0], 0.1), Err(Refusal::Enclosed { obstacles: name("north") }));
    assert_eq!(way(&walls, [1.85, 0.0], [0.0, 0.0], 0.1), Err(Refusal::Start { obstacle: "east".into() }));
    assert_eq!(way(&walls, [0.0, 0.0], [0.0, -2.15], 0.1), Err(Refusal::Goal { obstacle: "south".into() }));
    assert!(way(&walls, [0.0, 0.0], [1.5, 1.5], 0.1).is_ok());
    // A gap of 0.6 m lets through what needs less than 0.3 m on each side.
    let gate = [block("left", [0.2, 9.0], 0.0, 4.8), block("right", [0.2, 9.0], 0.0, -4.8)];
    assert_eq!(way(&gate, [-2.0, 0.0], [2.0, 0.0], 0.299).map(|path| path.points.len()), Ok(2));
    assert!(way(&gate, [-2.0, 0.0], [2.0, 0.0], 0.301).is_ok_and(|path| path.length > 18.0));
    let many: Vec<Obstacle> =
        (0..1001).map(|i| block(&i.to_string(), [0.1, 0.1], f64::from(i), 5.0)).collect();
    assert_eq!(way(&many, [0.0, 0.0], [1.0, 0.0], 0.0), Err(Refusal::Corners { found: 4004, most: 4000 }));
}

/// Returns true if a segment passes through a convex polygon of counter-clockwise corners, looked at in 2,000 points.
fn passes(corners: &[[f64; 2]], from: [f64; 2], to: [f64; 2]) -> bool {
    (1..2000).any(|i| {
        let s = f64::from(i) / 2000.0;
        let p = [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])];
        (0..corners.len()).all(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 1e-6
        })
    })
}

/// Returns the length of the shortest way among turned rectangles by relaxing all pairs of their corners (Floyd 1962).
fn relaxed(polygons: &[Vec<[f64; 2]>], from: [f64; 2], to: [f64; 2]) -> f64 {
    let mut nodes = vec![from, to];
    nodes.extend(polygons.iter().flatten());
    let count = nodes.len();
    let mut lengths = vec![vec![f64::INFINITY; count]; count];
    for i in 0..count {
        for j in 0..count {
            if !polygons.iter().any(|polygon| passes(polygon, nodes[i], nodes[j])) {
                lengths[i][j] = distance(nodes[i], nodes[j]);
            }
        }
    }
    for k in 0..count {
        for i in 0..count {
            for j in 0..count {
                lengths[i][j] = f64::min(lengths[i][j], lengths[i][k] + lengths[k][j]);
            }
        }
    }
    lengths[0][1]
}

#[test]
fn ways_among_random_blocks_are_the_shortest() {
    let mut random = Numbers(7);
    let (mut ways, mut bent) = (0, 0);
    for _ in 0..60 {
        let (mut obstacles, mut polygons) = (Vec::new(), Vec::new());
        for i in 0..5 {
            let [x, y, turn] =
                [random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(0.0, PI)];
            let half = [random.between(0.1, 0.9), random.between(0.1, 0.9)];
            let pose = shifted(Vec3::new(x, y, 0.0)) * turned(Vec3::z(), turn);
            let shape = Shape::Box { size: Vec3::new(2.0 * half[0], 2.0 * half[1], 1.0) };
            obstacles.push(Obstacle { name: i.to_string(), shapes: vec![Placed { pose, shape }] });
            let (s, c) = (libm::sin(turn), libm::cos(turn));
            let corner = |a: f64, b: f64| {
                [x + a * half[0] * c - b * half[1] * s, y + a * half[0] * s + b * half[1] * c]
            };
            polygons.push(vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
        }
        let (from, to) = ([-3.5, random.between(-2.0, 2.0)], [3.5, random.between(-2.0, 2.0)]);
        let path = way(&obstacles, from, to, 0.0).expect("the ends are outside");
        let shortest = relaxed(&polygons, from, to);
        // The samples of the other search miss a corner that is cut by less than 2 mm or so.
        assert!((path.length - shortest).abs() < 3e-3, "{} and {shortest}: {obstacles:?}", path.length);
        for pair in path.points.windows(2) {
            assert!(!polygons.iter().any(|polygon| passes(polygon, pair[0], pair[1])), "{path:?}");
        }
        ways += 1;
        bent += usize::from(path.points.len() > 2);
    }
    assert!(ways == 60 && bent >= 30, "{bent} of {ways} ways turn");
}
