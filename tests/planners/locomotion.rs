//! `locomote`: one step against known optima, gradients against differences, the S of the paper in many
//! directions, and that nothing comes too near between the samples.

use crate::support::properties::whole;
use crate::support::trusses::{actuator, looked_at, octet, reels, robot, stepping, truth};
use modl::geometry::Vec3;
use modl::interrupt;
use modl::planners::NoProgress;
use modl::planners::locomote::{End, Hold, Objective, Settings, Travel, cost, follow_path, plan};
use modl::planners::truss::constraint::Constraint;
use modl::planners::truss::margins::margins;
use modl::planners::truss::motion::{Move, moved};
use modl::planners::truss::roll::rolled;
use modl::planners::truss::step::{QuadraticCost, StepProblem, WarmStart, step};
use modl::planners::truss::{Limits, Structure};
use nalgebra::{DMatrix, Rotation3};

/// Five strokes of 8, 6, 8, 6 and 8 from where the robot stands, turned by an angle in degrees.
fn s_path(turned: f64) -> Vec<[f64; 2]> {
    let (s, c) = libm::sincos(turned.to_radians());
    let (truss, start) = robot();
    let from = truss.centre_of_mass(&start);
    let corners: Vec<[f64; 2]> =
        serde_json::from_value(truth()["locomotion"]["path"].clone()).expect("places");
    let place = |[x, y]: [f64; 2]| [c * x - s * y + from.x, s * x + c * y + from.y];
    corners.into_iter().map(place).collect()
}

fn travelled(path: &[[f64; 2]], settings: &Settings) -> Travel {
    let (truss, start) = robot();
    follow_path(&truss, &start, path, settings, &mut NoProgress)
}

/// A truss so large that parts of its steps are found on two threads moves alike alone and beside another, which has the second thread.
#[test]
fn a_large_truss_walks_alike_alone_and_beside_another() {
    let (loose, start) = octet(9);
    let mut problem = reels(&loose, &start, &[[50.0, 0.0]]);
    problem.truss.strut.mass = 0.1;
    let settings = Settings { steps_max: 8, slip_max: 1.0, ..Settings::default() };
    let walk = || {
        let solution = plan(&problem, &settings, &mut NoProgress).expect("it bears itself");
        (solution.body, solution.report.steps)
    };
    let alone = walk();
    assert_eq!(alone.1, settings.steps_max);
    let (here, beside) = interrupt::join(walk, walk);
    assert!(alone == here && alone == beside);
}

#[test]
fn the_s_is_travelled() {
    // The truth found 655 to 690 steps, 28 to 43 rolls. The path is 720 strides long, of which rolls save some; three twentieths more are
    // for detours, and for steps that end early so that the truss stands. In the mean these take no more than rolls save.
    let mut cases = vec![(25.0, Objective::Springs), (200.0, Objective::Lengths { damping: 1.0 })];
    if whole() {
        let turned =
            [0.0, 10.0, 25.0, 45.0, 77.0, 90.0, 130.0, 157.0, 200.0, 222.0, 260.0, 300.0, 330.0, 345.0];
        let objectives =
            [Objective::Springs, Objective::Lengths { damping: 1.0 }, Objective::Restoring { damping: 1.0 }];
        cases = turned.iter().flat_map(|&turned| objectives.map(|aim| (turned, aim))).collect();
    }
    let (truss, start) = robot();
    let limits = Limits { rigidity: RIGIDITY, ..Limits::default() };
    let rigid = truss.clone().with_limits(&start, limits);
    let mut steps = vec![];
    for (turned, aim) in cases {
        for truss in [&truss, &rigid] {
            let travel = follow_path(truss, &start, &s_path(turned), &stepping(aim, 3000), &mut NoProgress);
            assert_eq!(travel.end, End::Arrived, "turned by {turned}, {aim:?}");
            assert_eq!(travel.reached, 6);
            assert!((640..=828).contains(&travel.steps), "{} steps", travel.steps);
            steps.push(travel.steps);
            assert!(travel.slip < 1.0, "{} m slid", travel.slip);
            if whole() {
                keeps_its_limits(&travel);
            }
            if truss.limits.rigidity > 0.0 {
                stays_rigid(&travel);
            }
        }
    }
    let mean = steps.iter().sum::<usize>() / steps.len();
    assert!(mean <= 720, "{mean} steps");
}

/// The least singular value that walks are asked to keep.
const RIGIDITY: f64 = 0.05;

/// At the ends and in the middle of steps, of all where the whole is asked for, by nalgebra's eigenvalues: the planner
/// counts pivots and iterates.
fn stays_rigid(travel: &Travel) {
    let (truss, mut x) = robot();
    let every = if whole() { 1 } else { 7 };
    for (number, step) in travel.moves.iter().enumerate() {
        let Move::Linear(y, _) = step else {
            x = moved(&x, step).into_owned();
            continue;
        };
        for part in [0.5, 1.0].into_iter().filter(|_| number % every == 0) {
            let at: Vec<Vec3> = x.iter().zip(y).map(|(p, q)| p + (q - p) * part).collect();
            let mut squares = DMatrix::<f64>::zeros(3 * at.len(), 3 * at.len());
            for &(a, b) in &truss.struts {
                let e = (at[a] - at[b]).normalize();
                let block = e * e.transpose();
                for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                    let mut part = squares.fixed_view_mut::<3, 3>(3 * row, 3 * column);
                    part += block * sign;
                }
            }
            let mut values: Vec<f64> = squares.symmetric_eigenvalues().iter().copied().collect();
            values.sort_by(f64::total_cmp);
            let least = RIGIDITY - 1e-6;
            assert!(values[6] > least * least, "{} in step {number}", values[6].max(0.0).sqrt());
        }
        x.clone_from(y);
    }
}

/// At fifty moments of every step.
fn keeps_its_limits(travel: &Travel) {
    let (truss, mut x) = robot();
    for step in &travel.moves {
        x = match step {
            Move::Roll(roll) => rolled(&x, *roll),
            Move::Linear(y, _) => {
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
    let travel = travelled(&s_path(90.0)[..3], &stepping(Objective::Springs, 3000));
    keeps_its_limits(&travel);
    assert!(travel.rolls > 2);
}

/// A node is put down before the centre of mass crosses an edge: nothing falls on the whole way.
#[test]
fn it_rolls_without_impact() {
    let settings = Settings { impact: false, hold: Hold::Three, ..stepping(Objective::Springs, 3000) };
    let travel = travelled(&s_path(25.0)[..3], &settings);
    assert_eq!(travel.end, End::Arrived);
    assert_eq!(travel.rolls, 0);
    assert!(travel.footholds > 5);
    let (truss, mut x) = robot();
    for step in &travel.moves {
        let Move::Linear(y, _) = step else { panic!("it fell") };
        let (apart, height, _) = looked_at(&truss, &x, y, 5);
        assert!(apart > 0.1 - 1e-9 && height > -1e-9, "{apart} {height}");
        x.clone_from(y);
    }
}

/// The least change of lengths that moves the centre of mass at unit speed, with nodes pinned: what each
/// strut's length changes by.
fn least_change(pinned: &[usize], aim: Objective) -> Vec<f64> {
    const SMALL: f64 = 1e-2;
    let (mut truss, x) = robot();
    // The centre of the truth is the mean of the nodes.
    truss.mass_fractions = vec![1.0 / truss.nodes as f64; truss.nodes];
    let cost = cost(aim, &truss, &x, 0.0);
    let centre = [(0, SMALL), (1, 0.0), (2, 0.0)];
    let problem = StepProblem {
        truss: &truss,
        x: &x,
        cost: &cost,
        pinned,
        centre_of_mass: &centre,
        ground: false,
        displacement_max: f64::INFINITY,
        thorough: false,
    };
    let y = step(&problem, &mut WarmStart::default()).expect("nothing is in the way");
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
        let pinned: Vec<usize> = serde_json::from_value(optimum["pinned_vertices"].clone()).expect("nodes");
        let wanted = optimum["min_norm_Ldot"].as_f64().expect("a number");
        let changes = least_change(&pinned, Objective::Lengths { damping: 0.0 });
        let found = libm::sqrt(changes.iter().map(|c| c * c).sum());
        assert!((found - wanted).abs() < 1e-5, "{found} and not {wanted}, pinned {pinned:?}");
        let wanted = optimum["min_L1"].as_f64().expect("a number");
        let found: f64 =
            least_change(&pinned, Objective::Fewest { damping: 0.0 }).iter().map(|c| c.abs()).sum();
        assert!((found - wanted).abs() < 1e-5, "{found} and not {wanted} of sizes, pinned {pinned:?}");
    }
}

#[test]
fn gradients_are_what_differences_say() {
    let (truss, mut x) = robot();
    let limits = Limits { angle: 0.2, rigidity: 0.05, loops: vec![vec![4, 17, 60]], ..Limits::default() };
    let truss = truss.with_limits(&x, limits);
    // Off the regular shape, where many distances have two nearest points.
    for (i, p) in x.iter_mut().enumerate() {
        let wiggle = |k: usize| 0.05 * libm::sin((3 * i + k) as f64 * 1.7);
        *p += Vec3::new(wiggle(0), wiggle(1), wiggle(2));
    }
    let struts = [(0, 50), (3, 40), (10, 90), (20, 70), (33, 107)];
    let apart =
        struts.iter().filter(|(i, j)| !truss.share_node(*i, *j)).map(|&(i, j)| Constraint::Clearance(i, j));
    let others = [
        Constraint::LengthMin(7),
        Constraint::LengthMax(30),
        Constraint::NodeHeight(4),
        Constraint::EndClearance(3, 1, 40),
    ];
    let shapes = [
        Constraint::Angle(0, 1),
        Constraint::LoopMin(0),
        Constraint::LoopMax(0),
        Constraint::Rigidity(0, 0),
        Constraint::Rigidity(2, 2),
    ];
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
    let aside = QuadraticCost {
        absolutes: Vec::new(),
        hessian: (0..6).map(|i| (i, i, 1.0)).collect(),
        linear: vec![0.0, 0.0, 0.0, 0.0, -0.5, 0.0],
    };
    let problem = StepProblem {
        truss: &truss,
        x: &x,
        cost: &aside,
        pinned: &[0],
        centre_of_mass: &[],
        ground: false,
        displacement_max: 1.0,
        thorough: false,
    };
    let y = step(&problem, &mut WarmStart::default()).expect("it can turn");
    assert!(y[1].y > 0.4, "{y:?}");
    assert!(y[1].norm() <= 3.0 + 1e-9, "{}", y[1].norm());
}

/// Plain (14) throws the robot flat: it has to end with a reason, and in bounded work.
#[test]
fn plain_changes_of_length_end_with_a_reason() {
    let settings = Settings { fallbacks: false, ..stepping(Objective::Lengths { damping: 0.0 }, 3000) };
    let travel = travelled(&s_path(0.0), &settings);
    assert!(matches!(travel.end, End::Stuck(_)), "{:?}", travel.end);
}

#[test]
fn a_path_that_is_too_long_for_the_budget_ends() {
    let travel = travelled(&s_path(0.0), &stepping(Objective::Springs, 20));
    assert_eq!((travel.end, travel.steps), (End::Steps, 20));
}

/// Walks that once rolled over an edge and back without end: they end, far below the limit, or go on by another objective.
#[test]
fn walks_that_come_no_nearer_end() {
    let (truss, start) = robot();
    let from = truss.centre_of_mass(&start);
    for (turned, objective) in [(16.0, Objective::Springs), (336.0, Objective::LENGTHS)] {
        let path = s_path(turned);
        let corners: Vec<[f64; 2]> = path.iter().map(|[x, y]| [x - from.x, y - from.y]).collect();
        let problem = reels(&truss, &start, &corners);
        for fallbacks in [false, true] {
            let settings = Settings { fallbacks, ..stepping(objective, 6000) };
            let report = plan(&problem, &settings, &mut NoProgress).expect("it stands").report;
            let ends = if fallbacks { report.end == End::Arrived } else { report.end != End::Steps };
            assert!(ends && report.steps < 3000, "{} steps, then {:?}", report.steps, report.end);
        }
    }
}

#[test]
fn a_margin_of_the_support_is_stated_where_the_truss_stands() {
    let (truss, start) = octet(2);
    assert!(margins(&truss, &start, true).support.is_some_and(|inside| inside > 0.0));
    // Tilted about an edge of its base so far that it would roll on, as between two rolls.
    let tilt = Rotation3::from_axis_angle(&Vec3::x_axis(), libm::acos(1.0 / 3.0) - 0.05);
    let tilted: Vec<Vec3> = start.iter().map(|p| tilt * p).collect();
    let lowest = tilted.iter().filter(|p| p.z.abs() < 1e-9).count();
    assert_eq!(lowest, 3, "{tilted:?}");
    assert_eq!(margins(&truss, &tilted, true).support, None);
}
