//! Struts beside obstacles, going straight and rolling, against the distance to balls and boxes at many moments.

use super::truss_plans::*;
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Shape, Vec3};
use modl::plan::{CheckKind, Plan, Verdict};

/// An obstacle of the tests.
#[derive(Clone, Copy, Debug)]
enum Wall {
    /// A centre and a radius.
    Ball(Place, f64),
    /// A centre and half of the edges.
    Block(Place, Place),
}

impl Wall {
    fn placed(self) -> Placed {
        match self {
            Wall::Ball(centre, radius) => {
                Placed { pose: shifted(Vec3::from(centre)), shape: Shape::Sphere { radius } }
            }
            Wall::Block(centre, half) => {
                let size = Vec3::from(half) * 2.0;
                Placed { pose: shifted(Vec3::from(centre)), shape: Shape::Box { size } }
            }
        }
    }

    /// Returns the distance of a point, 0 inside.
    fn to_point(self, p: Place) -> f64 {
        match self {
            Wall::Ball(centre, radius) => (norm(minus(p, centre)) - radius).max(0.0),
            Wall::Block(centre, half) => {
                norm(std::array::from_fn(|k| ((p[k] - centre[k]).abs() - half[k]).max(0.0)))
            }
        }
    }

    /// Returns the distance of a segment, which is convex along it: thirds are left out, again and again.
    fn to_segment(self, [p, q]: [Place; 2]) -> f64 {
        let at = |part: f64| self.to_point(between(p, q, part));
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..45 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if at(a) <= at(b) { high = b } else { low = a }
        }
        at((low + high) / 2.0)
    }
}

const CLEARANCE: f64 = 0.1;

/// Asserts that a verdict says of one strut and some walls what many moments say. `at`: the strut's ends at a part of the
/// step, which lasts a second.
fn compared(verdict: &Verdict, walls: &[Wall], at: &dyn Fn(f64) -> [Place; 2], what: &str) -> Option<bool> {
    let apart = |part: f64| {
        let ends = at(part);
        walls.iter().map(|wall| wall.to_segment(ends)).fold(f64::INFINITY, f64::min)
    };
    let count = 600;
    let least = (0..=count).map(|k| apart(f64::from(k) / f64::from(count))).fold(f64::INFINITY, f64::min);
    // The value told is that of the time told.
    let from = |names: &[String], time: f64| {
        let wall = names[1].strip_prefix("obstacle ").and_then(|k| k.parse::<usize>().ok());
        walls[wall.expect("an obstacle") - 1].to_segment(at(time))
    };
    for failure in of(CheckKind::Collision, verdict) {
        assert!((0.0..=1.0).contains(&failure.time), "{what}: {failure:?}");
        let there = from(&failure.at, failure.time);
        assert!((failure.value.max(0.0) - there).abs() < 1e-6, "{what}: {failure:?} {there}");
        assert!(failure.value < CLEARANCE && failure.limit == CLEARANCE, "{what}: {failure:?}");
        assert!(failure.message.contains("comes within"), "{what}: {failure:?}");
    }
    let rim = apart(0.0).min(apart(1.0));
    match &verdict.clearance {
        Some(told) => {
            assert!((told.value.max(0.0) - from(&told.at, told.time)).abs() < 1e-6, "{what}: {told:?}");
            assert!(told.value <= rim + 1e-6 && told.value <= 2.0 * CLEARANCE, "{what}: {told:?} {rim}");
        }
        None => assert!(rim > 2.0 * CLEARANCE - 1e-9 && least > CLEARANCE, "{what}: {rim} {least}"),
    }
    let failed = !of(CheckKind::Collision, verdict).is_empty();
    if least < CLEARANCE - 0.005 {
        assert!(failed, "{what}: {least}");
        return Some(false);
    }
    // Between the moments a strut comes nearer by no more than half of its way from one to the next.
    if least > CLEARANCE + 0.01 {
        assert!(!failed, "{what}: {least} {:?}", verdict.failures);
        return Some(true);
    }
    None
}

fn beside(plan: Plan, walls: &[Wall]) -> Plan {
    with(plan, |paths| {
        paths.surroundings.obstacles = walls.iter().map(|wall| vec![wall.placed()]).collect();
    })
}

fn walls(number: &mut dyn FnMut(f64, f64) -> f64, count: usize) -> Vec<Wall> {
    let wall = |k: usize| {
        let centre: Place = std::array::from_fn(|_| number(-1.0, 1.0));
        if k.is_multiple_of(2) {
            Wall::Ball(centre, number(0.05, 0.2))
        } else {
            Wall::Block(centre, std::array::from_fn(|_| number(0.02, 0.2)))
        }
    };
    (0..count).map(wall).collect()
}

#[test]
fn a_strut_that_goes_straight_keeps_from_walls_what_many_moments_say() {
    let mut number = dice(53);
    let mut kept_apart = Tally::default();
    for round in 0..160 {
        let count = 1 + round % 2;
        let walls = walls(&mut number, count);
        let mut place = || -> Place { std::array::from_fn(|_| number(-1.0, 1.0)) };
        let (from, mut to) = ([place(), place()], [place(), place()]);
        match round % 8 {
            // Nothing moves; one end does; both go far.
            0 => to = from,
            1 | 2 => to[round % 8 - 1] = from[round % 8 - 1],
            3 => to = to.map(|p| p.map(|x| 4.0 * x)),
            _ => {}
        }
        let plan = plan(FREE, &[(0, 1)], vec![straight(0.0, &from), straight(1.0, &to)]);
        let verdict = judged(&beside(plan, &walls));
        let at = |part: f64| [0, 1].map(|k| between(from[k], to[k], part));
        kept_apart.count(compared(&verdict, &walls, &at, &format!("round {round}")));
    }
    let Tally { yes: kept, no: met } = kept_apart;
    assert!(kept > 20 && met > 20, "{kept} kept apart, {met} met");
}

#[test]
fn a_strut_that_rolls_keeps_from_walls_what_many_moments_say() {
    let mut number = dice(59);
    let mut kept_apart = Tally::default();
    for round in 0..100 {
        let walls = walls(&mut number, 4);
        let mut nodes: Vec<Place> = (0..4).map(|_| std::array::from_fn(|_| number(-1.0, 1.0))).collect();
        let edge = (nodes[1], minus(nodes[3], nodes[1]));
        let angle = number(-3.0, 3.0);
        // In some rounds an end is on the edge.
        if round % 4 == 0 {
            nodes[2] = between(nodes[1], nodes[3], 0.3);
        }
        let after: Vec<Place> = nodes.iter().map(|p| turned(*p, edge, angle)).collect();
        let keyframes = vec![straight(0.0, &nodes), roll(1.0, (1, 3), angle, &after)];
        let verdict = judged(&beside(plan(FREE, &[(0, 2)], keyframes), &walls));
        let at = |part: f64| [0, 2].map(|k| turned(nodes[k], edge, angle * part));
        kept_apart.count(compared(&verdict, &walls, &at, &format!("round {round}")));
    }
    let Tally { yes: kept, no: met } = kept_apart;
    assert!(kept > 20 && met > 20, "{kept} kept apart, {met} met");
}

/// A strut that only is there is beside its walls, too.
#[test]
fn a_strut_that_stays_keeps_from_walls() {
    let mut number = dice(61);
    for round in 0..40 {
        let walls = walls(&mut number, 2);
        let ends: [Place; 2] = [0, 1].map(|_| std::array::from_fn(|_| number(-1.0, 1.0)));
        let verdict = judged(&beside(plan(FREE, &[(0, 1)], vec![straight(0.0, &ends)]), &walls));
        compared(&verdict, &walls, &|_| ends, &format!("round {round}"));
    }
}

/// Past a ball at the clearance and a little more, as near as can be at either end and in the middle.
#[test]
fn a_strut_may_pass_at_its_clearance() {
    let radius = 0.2;
    for nearest in [0.0, 0.3, 0.5, 0.99, 1.0] {
        for (spare, passes) in [(1e-6, true), (-1e-6, false)] {
            let height = radius + CLEARANCE + spare;
            let at =
                |part: f64| [[-1.0, 2.0 * (part - nearest), height], [1.0, 2.0 * (part - nearest), height]];
            let plan = plan(FREE, &[(0, 1)], vec![straight(0.0, &at(0.0)), straight(1.0, &at(1.0))]);
            let verdict = judged(&beside(plan, &[Wall::Ball([0.0; 3], radius)]));
            assert_eq!(verdict.failures.is_empty(), passes, "{nearest} {spare}: {:?}", verdict.failures);
        }
    }
}
