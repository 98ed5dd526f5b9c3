//! Planar shapes to each other without a turn: pairs of cells spin against what moves.

use crate::support::lattices::{BALANCED, block, judged_plan, moved, plan_of, random_shape, unit_cell};
use crate::support::properties::whole;
use crate::support::recount_lattice::recount;
use modl::plan::file::{read, write};
use modl::plan::lattice::end_shapes;
use modl::plan::{Body, CheckKind, Plan, Ratio, StageEnd, Stages, reversed};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, ModelChoice, Problem, Refusal, Report, Settings, plan};
use modl::robot::Cell;
use std::collections::BTreeSet;

type Site = [i64; 3];

const RING: [&str; 4] = ["####", "#..#", "#..#", "####"];
const STAIRS: [&str; 6] = ["##.....", ".##....", "..##...", "...##..", "....##.", ".....##"];

fn balanced(method: Method) -> Settings {
    Settings { method, model: ModelChoice::Balanced, ..Settings::default() }
}

fn squeezed(from: &[Site], to: &[Site], settings: &Settings) -> Result<(Plan, Report), Refusal> {
    let problem = Problem::floating(unit_cell(), from.to_vec(), to.to_vec());
    let solution = plan(&problem, settings, &mut NoProgress)?;
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    Ok((plan_of(stages), solution.report))
}

fn stages(plan: &Plan) -> &Stages {
    let Body::Stages(stages) = &plan.body else { panic!("it is a lattice") };
    stages
}

/// Returns sites in ascending order, translated so that the least coordinates are 0.
fn normal(sites: &[Site]) -> Vec<Site> {
    let low = [0, 1, 2].map(|axis| sites.iter().map(|site| site[axis]).min().unwrap_or(0));
    let mut sites: Vec<Site> =
        sites.iter().map(|site| [0, 1, 2].map(|axis| site[axis] - low[axis])).collect();
    sites.sort_unstable();
    sites
}

/// Returns the greatest angular momentum about the centre of mass that a plan has at any time, in masses, lengths and units
/// of time: positions and velocities at samples of each stage, of point masses in floating point.
fn greatest_momentum(plan: &Plan) -> f64 {
    let number = |Ratio(above, below): Ratio| above as f64 / below as f64;
    let stages = stages(plan);
    let mut at: Vec<[f64; 2]> = vec![[0.0; 2]; stages.count as usize];
    for run in &stages.start {
        assert!(run.counters.iter().all(|counter| counter.count == 1), "the cells are listed one by one");
        at[run.first as usize] = [0, 1].map(|k| number(run.center[k]));
    }
    let mut most = 0.0_f64;
    for stage in &stages.stages {
        let StageEnd::Moves(moves) = &stage.end else { panic!("the stage states moves") };
        let by: Vec<[f64; 2]> = moves
            .of_cells()
            .map(|class| [0, 1].map(|k| number(moves.classes[class as usize].displacement[k])))
            .collect();
        let seconds = number(stage.time_squared).sqrt();
        for sample in 0..=4 {
            let time = f64::from(sample) / 4.0;
            // Speeding up for half of the time, slowing down for the other.
            let (done, rate) = if time <= 0.5 {
                (2.0 * time * time, 4.0 * time)
            } else {
                (1.0 - 2.0 * (1.0 - time) * (1.0 - time), 4.0 * (1.0 - time))
            };
            let momentum: f64 = at
                .iter()
                .zip(&by)
                .map(|(x, d)| {
                    let here = [x[0] + done * d[0], x[1] + done * d[1]];
                    (here[0] * d[1] - here[1] * d[0]) * rate / seconds
                })
                .sum();
            most = most.max(momentum.abs());
        }
        at.iter_mut().zip(&by).for_each(|(x, d)| (0..2).for_each(|k| x[k] += d[k]));
    }
    most
}

/// Plans, and checks the plan by the judge, by samples, and its ends and momentum by arithmetic of the tests.
fn check(from: &[Site], to: &[Site], method: Method) -> (Plan, Report) {
    let (plan, report) = squeezed(from, to, &balanced(method)).expect("there is a way");
    assert!(report.balanced);
    assert_eq!(stages(&plan).model, BALANCED);
    let verdict = judged_plan(&plan);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    let mut wrong = vec![];
    recount(&plan, &mut wrong);
    assert_eq!(wrong, Vec::<String>::new());
    let ends = end_shapes(stages(&plan)).expect("whole cells on a lattice");
    assert_eq!(ends, (normal(from), normal(to)));
    let momentum = greatest_momentum(&plan);
    assert!(momentum < 1e-9, "an angular momentum of {momentum}");
    (plan, report)
}

fn drawn(rows: &[&str]) -> Vec<Site> {
    let row = |(y, row): (usize, &&str)| -> Vec<Site> {
        row.chars().enumerate().filter(|(_, c)| *c == '#').map(|(x, _)| [x as i64, -(y as i64), 0]).collect()
    };
    rows.iter().enumerate().flat_map(row).collect()
}

#[test]
fn shapes_in_a_plane_become_each_other_without_a_turn() {
    let (ring, stairs) = (drawn(&RING), drawn(&STAIRS));
    let comb = drawn(&["#.#.#", "#.#.#", "#####", "....#"]);
    let (_, report) = check(&ring, &stairs, Method::Auto);
    assert_eq!(report.method, Method::Spin);
    assert_eq!(report.why, "spin: the fastest way that nothing outside has to turn");
    check(&stairs, &comb, Method::Spin);
    check(&comb, &ring, Method::Spin);
    // A corner that goes to the other end of a block, which a push does in 4 units with a turn.
    let square = block([6, 6, 1]);
    check(&square, &moved(square.clone(), [5, 5, 0], [0, -1, 0]), Method::Auto);
}

/// Between a row and a column there is no common part to go through: the way leads by a block.
#[test]
fn rows_become_columns_where_no_arms_are_balanced() {
    let row: Vec<Site> = (0..10).map(|x| [x, 0, 0]).collect();
    let column: Vec<Site> = (0..10).map(|y| [0, y, 0]).collect();
    let (_, report) = check(&row, &column, Method::Spin);
    assert_eq!(report.method, Method::Spin);
}

#[test]
fn shapes_in_any_plane_are_taken() {
    let up = |cells: &[Site]| -> Vec<Site> { cells.iter().map(|c| [0, c[0], c[1]]).collect() };
    let (from, to) = (drawn(&["#####", "#....", "#...."]), drawn(&["###", "###", "#.."]));
    let problem = |from: &[Site], to: &[Site]| squeezed(from, to, &balanced(Method::Spin));
    let (flat, _) = problem(&from, &to).expect("there is a way");
    let (upright, report) = problem(&up(&from), &up(&to)).expect("there is a way");
    assert!(report.balanced && judged_plan(&upright).ok());
    assert!((stages(&flat).duration() - stages(&upright).duration()).abs() < 1e-9);
    // From a plane to another there is none.
    let refused = problem(&from, &up(&to)).expect_err("they are in two planes");
    assert_eq!(refused, Refusal::Method { method: Method::Spin });
}

/// Random polyominoes, thick and with branches; every one of the plans is checked by sums of the tests.
#[test]
fn random_shapes_become_each_other_without_a_turn() {
    let rounds = if whole() { 60 } else { 6 };
    let mut seed = 28;
    for round in 0..rounds {
        let count = 9 + 3 * (round % 6);
        let branches = round % 2 == 1;
        let mut shape = || random_shape(2, branches, &mut seed, count);
        let (from, to) = (shape(), shape());
        check(&from, &to, Method::Spin);
    }
}

/// The plan holds fractions that no common grid of all its stages holds; it is written and read, turned around, and judged
/// again all the same.
#[test]
fn such_plans_are_written_and_reversed() {
    let (from, to) = (drawn(&RING), drawn(&STAIRS));
    let (plan, _) = check(&from, &to, Method::Spin);
    let denominators = stages(&plan).stages.iter().flat_map(|stage| {
        let StageEnd::Moves(moves) = &stage.end else { panic!("the stage states moves") };
        moves.classes.iter().flat_map(|class| class.ratios()).map(|ratio| ratio.1 as u128)
    });
    let common = denominators.fold(1_u128, |all, each| if all > 1 << 60 { all } else { lcm(all, each) });
    assert!(common > 1 << 41, "a grid of {common} lines holds all");
    let text = write(&plan).expect("it can be written");
    assert_eq!(read(&text).expect("it can be read"), plan);
    let Body::Stages(back) = reversed(&plan).body else { panic!("it is a lattice") };
    let back = plan_of(back);
    assert!(judged_plan(&back).ok());
    assert_eq!(end_shapes(stages(&back)).expect("whole cells"), (normal(&to), normal(&from)));
}

fn lcm(a: u128, b: u128) -> u128 {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    a / x * b
}

/// A pair that spins less than it should lets the robot turn, and one that spins too fast accelerates too much.
#[test]
fn the_judge_finds_what_turns() {
    let (from, to) = (drawn(&["#####", "#....", "#...."]), drawn(&["###", "###", "#.."]));
    let (good, _) = check(&from, &to, Method::Spin);
    let mut turning = good.clone();
    let Body::Stages(body) = &mut turning.body else { panic!("it is a lattice") };
    body.stages.remove(1);
    let verdict = judged_plan(&turning);
    assert!(!verdict.ok());
    let mut hasty = good;
    let Body::Stages(body) = &mut hasty.body else { panic!("it is a lattice") };
    for stage in &mut body.stages {
        stage.time_squared = stage.time_squared.times(Ratio(99, 100)).expect("a small number");
    }
    let verdict = judged_plan(&hasty);
    assert!(verdict.failures.iter().any(|failure| failure.kind == CheckKind::Acceleration));
}

#[test]
fn what_is_too_small_or_stiff_is_refused() {
    let (ell, tee) = (drawn(&["##", "#."]), drawn(&["###"]));
    let refused = squeezed(&ell, &tee, &balanced(Method::Auto)).expect_err("three cells have no pairs");
    assert_eq!(refused, Refusal::Unbalanced { method: Method::Auto });
    let refused = squeezed(&ell, &tee, &balanced(Method::Spin)).expect_err("three cells have no pairs");
    assert_eq!(refused, Refusal::Method { method: Method::Spin });
    let (from, to) = (drawn(&["#####", "#....", "#...."]), drawn(&["###", "###", "#.."]));
    let stiff = Cell { shrinks_to: 0.8, ..unit_cell() };
    let problem = Problem { cell: stiff, ..Problem::floating(unit_cell(), from, to) };
    let refused = plan(&problem, &balanced(Method::Spin), &mut NoProgress).expect_err("no pair fits a site");
    assert!(matches!(refused, Refusal::Stiff { .. }), "{refused:?}");
}

/// All shapes of a few cells, to one of them: no plan that is given is refused by the judge, and nothing else goes wrong.
#[test]
fn small_shapes_are_taken_to_each_other() {
    let count = if whole() { 8 } else { 7 };
    let shapes = polyominoes(count);
    // Fixed polyominoes up to translation (OEIS A001168).
    assert_eq!(shapes.len(), [1, 1, 2, 6, 19, 63, 216, 760, 2725][count]);
    let step = if whole() { 1 } else { 19 };
    let mut ways = 0;
    let last = &shapes[shapes.len() / 2];
    for shape in shapes.iter().step_by(step).filter(|shape| *shape != last) {
        match squeezed(shape, last, &balanced(Method::Spin)) {
            Ok((plan, _)) => {
                assert!(judged_plan(&plan).ok(), "{shape:?}");
                assert!(greatest_momentum(&plan) < 1e-9);
                ways += 1;
            }
            Err(refused) => assert_eq!(refused, Refusal::Method { method: Method::Spin }, "{shape:?}"),
        }
    }
    println!("{ways} ways of {} shapes", shapes.len().div_ceil(step));
    assert!(ways > 0);
}

/// Returns all connected sets of cells in a plane, up to translation.
fn polyominoes(count: usize) -> Vec<Vec<Site>> {
    let mut shapes: BTreeSet<Vec<Site>> = BTreeSet::from([vec![[0, 0, 0]]]);
    for _ in 1..count {
        let mut next = BTreeSet::new();
        for shape in &shapes {
            for cell in shape {
                for by in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
                    let site = [cell[0] + by[0], cell[1] + by[1], 0];
                    if !shape.contains(&site) {
                        let mut larger = shape.clone();
                        larger.push(site);
                        next.insert(normal(&larger));
                    }
                }
            }
        }
        shapes = next;
    }
    shapes.into_iter().collect()
}
