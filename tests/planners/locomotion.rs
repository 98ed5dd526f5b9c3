//! `locomote`: one step against known optima, gradients against differences, the S of the paper in many
//! directions, and that nothing comes too near between the samples.

use crate::support::trusses::{actuator, along, looked_at, robot, truth};
use modl::geometry::Vec3;
use modl::planners::truss::bound::Bound;
use modl::planners::truss::locomote::{End, Move, Travel, Wish, locomote};
use modl::planners::truss::locomotion::{Aim, objective};
use modl::planners::truss::roll::rolled;
use modl::planners::truss::step::{Memory, Objective, Task, step};
use modl::planners::truss::{Limits, Loop, Structure};

/// Five strokes of 8, 6, 8, 6 and 8 from where the robot stands, turned by an angle in degrees.
fn s_path(turned: f64, aim: Aim) -> Wish {
    let (s, c) = libm::sincos(turned.to_radians());
    let (truss, start) = robot();
    let from = truss.centre(&start);
    let corners: Vec<[f64; 2]> =
        serde_json::from_value(truth()["locomotion"]["path"].clone()).expect("places");
    let place = |[x, y]: [f64; 2]| [c * x - s * y + from.x, s * x + c * y + from.y];
    along(corners.into_iter().map(place).collect(), aim, 3000)
}

fn travelled(wish: &Wish) -> Travel {
    let (truss, start) = robot();
    locomote(&truss, &start, wish, &|_| true)
}

#[test]
fn the_s_is_travelled() {
    // The truth found 655 to 690 steps, 28 to 43 rolls.
    let mut cases = vec![(25.0, Aim::Springs), (200.0, Aim::Lengths { still: 1.0 })];
    if std::env::var_os("MODL_WHOLE").is_some() {
        let turned =
            [0.0, 10.0, 25.0, 45.0, 77.0, 90.0, 130.0, 157.0, 200.0, 222.0, 260.0, 300.0, 330.0, 345.0];
        let aims = [Aim::Springs, Aim::Lengths { still: 1.0 }, Aim::Restoring { still: 1.0 }];
        cases = turned.iter().flat_map(|&turned| aims.map(|aim| (turned, aim))).collect();
    }
    for (turned, aim) in cases {
        let travel = travelled(&s_path(turned, aim));
        assert_eq!(travel.end, End::Arrived, "turned by {turned}, {aim:?}");
        assert_eq!(travel.reached, 6);
        assert!((640..=720).contains(&travel.steps), "{} steps", travel.steps);
        if std::env::var_os("MODL_WHOLE").is_some() {
            keeps_its_limits(&travel);
        }
    }
}

/// At fifty moments of every step.
fn keeps_its_limits(travel: &Travel) {
    let (truss, mut x) = robot();
    for step in &travel.moves {
        x = match step {
            Move::Roll(roll) => rolled(&x, *roll),
            Move::Step(y) => {
                let (apart, height, (shortest, longest)) = looked_at(&truss, &x, y, 50);
                assert!(apart > 0.1 - 1e-9, "{apart}");
                assert!(height > -1e-9, "{height}");
                assert!(shortest > 0.3 - 1e-9 && longest < 3.0 + 1e-9, "{shortest} {longest}");
                y.clone()
            }
        };
    }
}

#[test]
fn nothing_comes_too_near_between_the_samples() {
    let mut wish = s_path(90.0, Aim::Springs);
    wish.path.truncate(3);
    let travel = travelled(&wish);
    keeps_its_limits(&travel);
    assert!(travel.rolls > 2);
}

/// A node is put down before the centre of mass crosses an edge: nothing falls on the whole way.
#[test]
fn it_rolls_without_impact() {
    let whole = s_path(25.0, Aim::Springs);
    let path = whole.path[..3].to_vec();
    let travel = travelled(&Wish { impact: false, path, ..whole });
    assert_eq!(travel.end, End::Arrived);
    assert_eq!(travel.rolls, 0);
    assert!(travel.footholds > 5);
    let (truss, mut x) = robot();
    for step in &travel.moves {
        let Move::Step(y) = step else { panic!("it fell") };
        let (apart, height, _) = looked_at(&truss, &x, y, 5);
        assert!(apart > 0.1 - 1e-9 && height > -1e-9, "{apart} {height}");
        x.clone_from(y);
    }
}

/// The least change of lengths that moves the centre of mass at unit speed, with nodes held: what each
/// strut's length changes by.
fn least_change(held: &[usize], aim: Aim) -> Vec<f64> {
    const SMALL: f64 = 1e-2;
    let (mut truss, x) = robot();
    // The centre of the truth is the mean of the nodes.
    truss.shares = vec![1.0 / truss.nodes as f64; truss.nodes];
    let objective = objective(aim, &truss, &x, 0.0);
    let centre = [(0, SMALL), (1, 0.0), (2, 0.0)];
    let task = Task {
        truss: &truss,
        x: &x,
        objective: &objective,
        held,
        centre: &centre,
        ground: false,
        cap: f64::INFINITY,
    };
    let y = step(&task, &mut Memory::default()).expect("nothing is in the way");
    let change = |&(a, b): &(usize, usize)| {
        let along = (x[a] - x[b]).normalize();
        along.dot(&((y[a] - x[a]) - (y[b] - x[b]))) / SMALL
    };
    truss.struts.iter().map(change).collect()
}

#[test]
fn one_step_is_the_known_optimum() {
    let optima = truth()["one_step_optima_at_start_ground_is_face_z0"].clone();
    for optimum in optima.as_array().expect("a list") {
        if optimum["com_rows"] != "xyz" {
            continue;
        }
        let held: Vec<usize> = serde_json::from_value(optimum["pinned_vertices"].clone()).expect("nodes");
        let wanted = optimum["min_norm_Ldot"].as_f64().expect("a number");
        let changes = least_change(&held, Aim::Lengths { still: 0.0 });
        let found = libm::sqrt(changes.iter().map(|c| c * c).sum());
        assert!((found - wanted).abs() < 1e-5, "{found} and not {wanted}, held {held:?}");
        let wanted = optimum["min_L1"].as_f64().expect("a number");
        let found: f64 = least_change(&held, Aim::Fewest { still: 0.0 }).iter().map(|c| c.abs()).sum();
        assert!((found - wanted).abs() < 1e-5, "{found} and not {wanted} of sizes, held {held:?}");
    }
}

#[test]
fn gradients_are_what_differences_say() {
    let (truss, mut x) = robot();
    let around = Loop { struts: vec![4, 17, 60], range: (0.0, 0.0) };
    let limits = Limits { angle: 0.2, rigidity: 0.05, loops: vec![around], ..Limits::default() };
    let truss = truss.limited(&x, limits);
    // Off the regular shape, where many distances have two nearest points.
    for (i, p) in x.iter_mut().enumerate() {
        let wiggle = |k: usize| 0.05 * libm::sin((3 * i + k) as f64 * 1.7);
        *p += Vec3::new(wiggle(0), wiggle(1), wiggle(2));
    }
    let struts = [(0, 50), (3, 40), (10, 90), (20, 70), (33, 107)];
    let apart = struts.iter().filter(|(i, j)| !truss.share_node(*i, *j)).map(|&(i, j)| Bound::Apart(i, j));
    let others = [Bound::Shortest(7), Bound::Longest(30), Bound::Above(4), Bound::EndApart(3, 1, 40)];
    let shapes =
        [Bound::Angle(0, 1), Bound::Least(0), Bound::Most(0), Bound::Rigid(0, 0), Bound::Rigid(2, 2)];
    for bound in apart.chain(others).chain(shapes) {
        const SMALL: f64 = 1e-6;
        let mut found = vec![Vec3::zeros(); truss.nodes];
        bound.gradient(&truss, &x).iter().for_each(|(node, g)| found[*node] += g);
        for node in 0..truss.nodes {
            for k in 0..3 {
                let at = |by: f64| {
                    let mut y = x.clone();
                    y[node][k] += by;
                    bound.value(&truss, &y)
                };
                let difference = (at(SMALL) - at(-SMALL)) / (2.0 * SMALL);
                assert!((difference - found[node][k]).abs() < 1e-8, "{bound:?} node {node} axis {k}");
            }
        }
    }
}

/// The paper's Algorithm 1 asks for ever that a strut at its limit gets no longer to first order, and a
/// turn makes it longer to second order.
#[test]
fn a_strut_at_its_limit_may_turn() {
    let x = [Vec3::zeros(), Vec3::new(3.0, 0.0, 0.0)];
    let truss = Structure::new(&actuator(), &x, &[(0, 1)]);
    let aside = Objective {
        sizes: Vec::new(),
        hessian: (0..6).map(|i| (i, i, 1.0)).collect(),
        linear: vec![0.0, 0.0, 0.0, 0.0, -0.5, 0.0],
    };
    let task =
        Task { truss: &truss, x: &x, objective: &aside, held: &[0], centre: &[], ground: false, cap: 1.0 };
    let y = step(&task, &mut Memory::default()).expect("it can turn");
    assert!(y[1].y > 0.4, "{y:?}");
    assert!(y[1].norm() <= 3.0 + 1e-9, "{}", y[1].norm());
}

/// Plain (14) throws the robot flat: it has to end with a reason, and in bounded work.
#[test]
fn plain_changes_of_length_end_with_a_reason() {
    let wish = Wish { ladder: false, ..s_path(0.0, Aim::Lengths { still: 0.0 }) };
    let travel = travelled(&wish);
    assert!(matches!(travel.end, End::Stuck(_)), "{:?}", travel.end);
}

#[test]
fn a_path_that_is_too_long_for_the_budget_ends() {
    let travel = travelled(&Wish { steps_max: 20, ..s_path(0.0, Aim::Springs) });
    assert_eq!((travel.end, travel.steps), (End::Steps, 20));
}
