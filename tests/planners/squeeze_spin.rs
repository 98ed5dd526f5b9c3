//! Planar shapes to each other without a turn: pairs of cells spin against what moves.

use crate::support::lattices::{
    BALANCED, block, judged_plan, moved, normal, plan_of, random_shape, stages, stages_by_hand, unit_cell,
};
use crate::support::properties::whole;
use crate::support::recount_lattice::recount;
use modl::plan::file::{read, write};
use modl::plan::lattice::end_shapes;
use modl::plan::{Body, CellMove, CheckKind, Law, Moves, Plan, Ratio, StageEnd, Stages, reversed};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, ModelChoice, Problem, Refusal, Report, Settings, plan};
use modl::robot::Cell;
use num_bigint::BigInt;
use serde_json::Value;
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

type Exact = num_rational::BigRational;

/// Returns a number of a plan file: a whole one, or numerator and denominator.
fn exact(value: &Value) -> Exact {
    let whole = |value: &Value| BigInt::from(value.as_i64().expect("a whole number"));
    match value.as_array() {
        Some(parts) => Exact::new(whole(&parts[0]), whole(&parts[1])),
        None => Exact::from_integer(whole(value)),
    }
}

/// Adds up what is said of each stage of a plan file, exactly: no stage moves the centre of mass or has an angular momentum
/// about it, at no time, for x grows by s d and its rate is s' d for all cells with one law s, so that the sum of
/// (x + s d) × s' d is s' times that of x × d.
fn check_momentum_of_file(text: &str) {
    let file: Value = serde_json::from_str(text).expect("a file in JSON");
    let stages = &file["body"]["stages"];
    let vector = |value: &Value| [exact(&value[0]), exact(&value[1]), exact(&value[2])];
    let mut at: Vec<[Exact; 3]> =
        vec![Default::default(); stages["count"].as_u64().expect("a count") as usize];
    for run in stages["start"].as_array().expect("a list") {
        assert_eq!(run["counters"], Value::Array(vec![]), "the cells are listed one by one");
        at[run["first"].as_u64().expect("a number") as usize] = vector(&run["center"]);
    }
    for stage in stages["stages"].as_array().expect("a list") {
        let classes: Vec<[Exact; 3]> = stage["moves"]["classes"]
            .as_array()
            .expect("the stage states moves")
            .iter()
            .map(|class| vector(&class["displacement"]))
            .collect();
        let spans = stage["moves"]["cells"].as_array().expect("a list").iter();
        let class_of_cells = spans.flat_map(|span| {
            let number = |value: &Value| value.as_u64().expect("a whole number") as usize;
            let (class, count) = match span.as_array() {
                Some(parts) => (number(&parts[0]), number(&parts[1])),
                None => (number(span), 1),
            };
            vec![class; count]
        });
        let (mut drift, mut turning): ([Exact; 3], [Exact; 3]) = Default::default();
        for (x, class) in at.iter_mut().zip(class_of_cells) {
            let d = &classes[class];
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                drift[k] += &d[k];
                turning[k] += &x[i] * &d[j] - &x[j] * &d[i];
            }
            (0..3).for_each(|k| x[k] += &d[k]);
        }
        assert_eq!((drift, turning), Default::default(), "{}", stage["name"]);
    }
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
    check_momentum_of_file(&write(&plan).expect("it can be written"));
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

/// The plan holds fractions that no common grid of all its stages holds, of those that the judge takes; it is written and read, turned around, and judged
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
    // Sides lie half a size from the centre.
    assert!(2 * common > 1 << 40, "a grid of {} lines holds all", 2 * common);
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

/// Plans that are spoilt are refused, each for its reason: a stage left out, a pair that spins the other way round, one that does not
/// spin, stages that are too quick, and a cell that goes nowhere or aside.
#[test]
fn spoilt_plans_are_refused() {
    let (from, to) = (drawn(&["#####", "#....", "#...."]), drawn(&["###", "###", "#.."]));
    let (good, _) = check(&from, &to, Method::Spin);
    let count = stages(&good).stages.len();
    let spoilt = |by: &dyn Fn(&mut Stages)| {
        let mut plan = good.clone();
        let Body::Stages(body) = &mut plan.body else { panic!("it is a lattice") };
        by(body);
        let kinds: BTreeSet<CheckKind> = judged_plan(&plan).failures.iter().map(|f| f.kind).collect();
        kinds
    };
    let mut spinning = 0;
    for index in 0..count {
        let StageEnd::Moves(moves) = &stages(&good).stages[index].end else { panic!("it states moves") };
        let of_cell: Vec<u32> = moves.of_cells().collect();
        let class = |cell: usize| &moves.classes[of_cell[cell] as usize];
        // Cells of pairs that spin: two that grow alike and move oppositely.
        let opposite = |a: usize, b: usize| {
            let sum = |k: usize| {
                let [a, b] = [a, b].map(|cell| class(cell).displacement[k]);
                i128::from(a.0) * i128::from(b.1) + i128::from(b.0) * i128::from(a.1)
            };
            class(a).growth == class(b).growth
                && class(a).growth != [Ratio::ZERO; 3]
                && (0..3).all(|k| sum(k) == 0)
        };
        let cells = 0..of_cell.len();
        let pair =
            cells.clone().flat_map(|a| cells.clone().map(move |b| (a, b))).find(|&(a, b)| opposite(a, b));
        let with_classes = |body: &mut Stages, classes: Vec<u32>| {
            body.stages[index].end = StageEnd::Moves(Moves::new(&moves.classes, classes.into_iter()));
        };
        if let Some((a, b)) = pair {
            spinning += 1;
            let mut turned = of_cell.clone();
            turned.swap(a, b);
            let kinds = spoilt(&|body| with_classes(body, turned.clone()));
            assert!(kinds.contains(&CheckKind::Momentum), "{index}: the other way round: {kinds:?}");
            let still = cells.clone().find(|&cell| class(cell).growth == [Ratio::ZERO; 3]);
            if let Some(still) = still {
                let mut missing = of_cell.clone();
                (missing[a], missing[b]) = (of_cell[still], of_cell[still]);
                let kinds = spoilt(&|body| with_classes(body, missing.clone()));
                assert!(kinds.contains(&CheckKind::Momentum), "{index}: without the pair: {kinds:?}");
            }
        }
        // Without the last stage all before it is right, but for where it ends.
        let shorter = !spoilt(&|body| drop(body.stages.remove(index))).is_empty();
        assert_eq!(shorter, index + 1 < count, "{index}: a stage left out");
        let hasty = |body: &mut Stages| {
            let time = &mut body.stages[index].time_squared;
            *time = time.times(Ratio(98, 100)).expect("a small number");
        };
        let kinds = spoilt(&hasty);
        let quick = [CheckKind::Acceleration, CheckKind::Speed];
        assert!(quick.iter().any(|kind| kinds.contains(kind)), "{index}: too quick: {kinds:?}");
        // Aside by the least that a grid of some stages would not see.
        let aside = |body: &mut Stages| {
            let mut classes = moves.classes.to_vec();
            classes.push(CellMove { displacement: [Ratio::ZERO; 3], ..*class(0) });
            let [x, y, _] = class(0).displacement;
            classes.last_mut().expect("there is one").displacement = [x, y, Ratio(1, 10_007)];
            let mut numbers = of_cell.clone();
            numbers[0] = classes.len() as u32 - 1;
            body.stages[index].end = StageEnd::Moves(Moves::new(&classes, numbers.into_iter()));
        };
        assert!(spoilt(&aside).contains(&CheckKind::Momentum), "{index}: aside");
    }
    assert!(spinning > 3, "{spinning} stages with a pair");
}

/// Cells of a pair have a corner in common only, while they turn it: at the end of a row that is allowed for an instant, and not as
/// long as others move.
#[test]
fn pairs_at_ends_do_not_rest_at_corners() {
    let flat = |x: i64, y: i64, size: [Ratio; 2]| [Ratio(x, 4), Ratio(y, 4), size[0], size[1]];
    let (half, whole) = (Ratio(1, 2), Ratio::ONE);
    // A row of two pairs at its ends, split across it, with two whole cells between.
    let start = vec![
        flat(-6, -1, [whole, half]),
        flat(-6, 1, [whole, half]),
        flat(-2, 0, [whole, whole]),
        flat(2, 0, [whole, whole]),
        flat(6, -1, [whole, half]),
        flat(6, 1, [whole, half]),
    ];
    // The pairs spin oppositely to the corners of their paths, and on until they are split along the row.
    let (mut corner, mut along) = (start.clone(), start.clone());
    for (cell, x, y) in [(0, -7, -1), (1, -5, 1), (4, 7, -1), (5, 5, 1)] {
        corner[cell] = flat(x, y, [half, half]);
        along[cell] = flat(x, 0, [half, whole]);
    }
    // The cells between get lower and higher again.
    let mut lower = corner.clone();
    (2..4).for_each(|cell| lower[cell][3] = half);
    let kinds = |ends: &[&Vec<_>]| -> Vec<CheckKind> {
        let ends: Vec<_> = ends.iter().map(|end| (Law::BangBang, Ratio::ONE, (*end).clone())).collect();
        let verdict = judged_plan(&plan_of(stages_by_hand(&start, &ends, BALANCED)));
        verdict.failures.iter().map(|failure| failure.kind).collect()
    };
    assert_eq!(kinds(&[&corner, &along]), []);
    assert_eq!(kinds(&[&corner, &lower, &corner, &along]), [CheckKind::Connectedness; 2]);
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
                check_momentum_of_file(&write(&plan).expect("it can be written"));
                let ends = end_shapes(stages(&plan)).expect("whole cells on a lattice");
                assert_eq!(ends, (normal(shape), normal(last)));
                ways += 1;
            }
            Err(refused) => assert_eq!(refused, Refusal::Method { method: Method::Spin }, "{shape:?}"),
        }
    }
    assert!(3 * ways > shapes.len() / step, "{ways} ways of {} shapes", shapes.len() / step);
}

/// A way that winds to and fro, and a comb, which have little in common: there is a way, or the search ends with its budget; no
/// budget of so many cells holds more stages.
#[test]
fn long_ways_end() {
    let width = if whole() { 20 } else { 8 };
    let count = (width * width) as usize;
    let sites = || (0..2 * width).flat_map(|y| (0..width).map(move |x| (x, y)));
    // Along the way, so that each site is beside the one before it.
    let winding = sites().filter(|&(x, y)| y % 2 == 0 || x == width - 1);
    let winding = winding.map(|(x, y)| [if y % 4 < 2 { x } else { width - 1 - x }, y, 0]);
    let comb = sites().filter(|&(x, y)| y == 0 || x % 2 == 0).map(|(x, y)| [x, y, 0]);
    let (from, to): (Vec<Site>, Vec<Site>) = (winding.take(count).collect(), comb.take(count).collect());
    assert_eq!(from.len(), to.len());
    match squeezed(&from, &to, &balanced(Method::Spin)) {
        Ok((plan, report)) => {
            assert!(report.balanced && judged_plan(&plan).ok());
            assert!(stages(&plan).stages.len() * from.len() < 80_000_000);
        }
        Err(refused) => {
            let expected = [Refusal::Budget, Refusal::TooLarge, Refusal::Method { method: Method::Spin }];
            assert!(expected.contains(&refused), "{refused}");
        }
    }
}

/// Slow cells and those whose contacts hold little take longer, by what they can; the stages are the same.
#[test]
fn limits_of_cells_are_kept() {
    let (from, to) = (drawn(&["#####", "#....", "#...."]), drawn(&["###", "###", "#.."]));
    let (plain, _) = check(&from, &to, Method::Spin);
    let duration = |cell: Cell, settings: &Settings| {
        let problem = Problem { cell, ..Problem::floating(unit_cell(), from.clone(), to.clone()) };
        let solution = plan(&problem, settings, &mut NoProgress).expect("a way");
        let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
        stages.duration()
    };
    let spin = balanced(Method::Spin);
    let unit = stages(&plain).duration();
    assert!((duration(unit_cell(), &spin) - unit).abs() < 1e-9);
    // Whatever is done by a quarter of the force takes twice as long, if no speed is at its limit.
    let quick = |force: f64| duration(Cell { force, speed: 1e3, ..unit_cell() }, &spin);
    assert!((quick(0.25) - 2.0 * quick(1.0)).abs() < 1e-9);
    assert!(quick(1.0) < unit);
    let soft = duration(unit_cell(), &Settings { max_force: Some(1.0), ..spin });
    assert!(soft > unit, "{soft} {unit}");
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
