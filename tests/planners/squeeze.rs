//! Lattice plans: the planner against values found another way, and what it plans before the judge.
//!
//! `tests/squeeze/truth.json` comes from an independent reference: an exact verifier of end points with
//! dense sampling, in another language. The whole range of sizes and a thousand random sets take some
//! minutes: `MODL_WHOLE=1 cargo test --release --test all squeeze` tries them all, in the release profile sooner.

use crate::support::lattices::{
    BALANCED, PAPER, TERMS, block, judged, judged_plan, plan_of, stages_of, unit_cell,
};
use crate::support::properties::whole;
use modl::plan::lattice::{end_shapes, peak_forces};
use modl::plan::{Body, Law, OperationError, Ratio, Stages, joined, reversed};
use modl::planners::NoProgress;
use modl::planners::squeeze::{
    Method, ModelChoice, Motion, Norm, PlanLimits, Problem, Profile, Refusal, Report, Settings, accordion,
    arms, fold, halve, shear, to_row, unroll,
};
use modl::robot::Cell;
use serde_json::Value;
use std::collections::BTreeSet;

type Construction = fn(PlanLimits, u64) -> Result<Motion, Refusal>;

const METHODS: [(&str, Construction); 3] = [("fold", fold), ("accordion", accordion), ("shear", shear)];

pub fn truth() -> Value {
    serde_json::from_str(include_str!("../truth/squeeze.json")).expect("the truth is JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-9 * expected.abs().max(1.0)
}

#[test]
fn totals_are_those_of_the_reference() {
    for row in truth()["table"].as_array().expect("a list") {
        let n = row["n"].as_u64().expect("a number");
        for (name, construction) in METHODS {
            let found = construction(TERMS, n).expect("there is a way").duration();
            let expected = number(&row[name]);
            assert!(near(found, expected), "{name} of {n}: {found} where {expected} is right");
        }
    }
}

#[test]
fn each_stage_lasts_as_long_as_in_the_reference() {
    for (n, expected) in truth()["stage_durations"].as_object().expect("by number") {
        for (name, construction) in METHODS {
            let Some(expected) = expected[name].as_array() else { continue };
            let way = construction(TERMS, n.parse().expect("a number")).expect("there is a way");
            // What does not move is no stage here.
            let moving: Vec<&Value> = expected.iter().filter(|stage| number(&stage[1]) > 0.0).collect();
            assert_eq!(way.transitions.len(), moving.len(), "{name} of {n}");
            for (transition, stage) in way.transitions.iter().zip(moving) {
                let time = libm::sqrt(transition.time_squared.to_f64());
                assert!(
                    transition.name == stage[0] && near(time, number(&stage[1])),
                    "{name} of {n}: {stage}"
                );
            }
        }
    }
}

#[test]
fn small_plans_are_those_of_the_reference_to_the_last_fraction() {
    let cases: [(&str, Construction, u64); 6] = [
        ("fold_checker_n3", fold, 3),
        ("fold_checker_n4", fold, 4),
        ("fold_checker_n5", fold, 5),
        ("accordion_n4", accordion, 4),
        ("accordion_n9", accordion, 9),
        ("fold_checker_n4", |terms, _| halve(terms, [4, 1, 1], [1, 4, 1]).expect("by halves"), 4),
    ];
    let truth = truth();
    for (name, construction, n) in cases {
        let plan = &truth["small_plans"][name];
        let way = construction(TERMS, n).expect("there is a way");
        let ends = std::iter::once(&plan["start"])
            .chain(plan["stages"].as_array().expect("a list").iter().map(|stage| &stage["end"]));
        let stages = stages_of(way.clone(), PAPER);
        for (k, expected) in ends.enumerate() {
            let found = stages.before(k).expect("small numbers");
            let mut boxes: Vec<[Ratio; 4]> = (0..n as usize)
                .map(|i| ["x", "y", "w", "h"].map(|key| fraction(&expected[key][i])))
                .collect();
            let mut here: Vec<[Ratio; 4]> = cells(&found, n);
            let key = |b: &[Ratio; 4]| b.map(|r| (r.to_f64() * 1e9) as i64);
            boxes.sort_by_key(key);
            here.sort_by_key(key);
            assert_eq!(here, boxes, "{name}");
        }
        for (transition, stage) in way.transitions.iter().zip(plan["stages"].as_array().expect("a list")) {
            assert_eq!(transition.time_squared, fraction(&stage["T2"]), "{name}: {}", transition.name);
        }
    }
}

/// `-3/2`
fn fraction(text: &Value) -> Ratio {
    let text = text.as_str().expect("a fraction");
    let (above, below) = text.split_once('/').unwrap_or((text, "1"));
    let whole = |t: &str| t.parse::<i128>().expect("a number");
    Ratio::new(whole(above), whole(below)).expect("a small one")
}

/// Centre and size in the plane, cell by cell.
fn cells(runs: &[modl::plan::Run], n: u64) -> Vec<[Ratio; 4]> {
    let mut cells = vec![[Ratio::ZERO; 4]; n as usize];
    for run in runs {
        for k in 0..run.count() {
            let (mut rest, mut index) = (k, run.first as i64);
            let mut center = [run.center[0], run.center[1]];
            for counter in run.counters.iter().rev() {
                let at = (rest % counter.count) as i64;
                rest /= counter.count;
                index += at * counter.stride;
                for (axis, c) in center.iter_mut().enumerate() {
                    let step = counter.step[axis].times(Ratio(at, 1)).expect("small");
                    let above = i128::from(c.0) * i128::from(step.1) + i128::from(step.0) * i128::from(c.1);
                    *c = Ratio::new(above, i128::from(c.1) * i128::from(step.1)).expect("small");
                }
            }
            cells[index as usize] = [center[0], center[1], run.size[0], run.size[1]];
        }
    }
    cells
}

#[test]
fn shapes_of_the_reference_become_rows_in_the_same_time() {
    for shape in truth()["poly_to_row"].as_array().expect("a list") {
        let cell = |c: &Value| [0, 1].map(|k| c[k].as_i64().expect("a place"));
        let places: Vec<[i64; 2]> = shape["cells"].as_array().expect("a list").iter().map(cell).collect();
        let way = to_row(TERMS, &places, |i| i).expect("there is a way");
        assert!(near(way.duration(), number(&shape["T"])), "{}", shape["name"]);
        for (transition, stage) in
            way.transitions.iter().zip(shape["stages"].as_array().into_iter().flatten())
        {
            let time = libm::sqrt(transition.time_squared.to_f64());
            assert!(near(time, number(&stage[1])), "{}: {stage}", shape["name"]);
        }
        let stages = stages_of(way.clone(), PAPER);
        let (_, end) = end_shapes(&stages).expect("it ends on the lattice");
        assert_eq!(end, (0..places.len() as i64).map(|x| [x, 0, 0]).collect::<Vec<_>>());
        let verdict = judged(way, PAPER);
        assert!(verdict.ok(), "{}: {:?}", shape["name"], verdict.failures);
    }
}

#[test]
fn contact_forces_are_those_of_the_linear_programme() {
    let half = |n: u64| to_halves(n, Ratio(n as i64 - 1, 1));
    for (n, row) in truth()["lp_squeeze"].as_object().expect("by number") {
        let n: u64 = n.parse().expect("a number");
        let (peak, lines) = peak_forces(&half(n), true).expect("it can be judged")[0];
        for (name, bound) in [("strict", 1.0), ("kappa2", 2.0)] {
            let time = libm::sqrt((peak as f64 / lines as f64 / bound).max(n as f64 - 1.0));
            assert!(near(time, number(&row[format!("closed_{name}")])), "{name} of {n}");
            // The programme is discrete: it is right to its own tolerance.
            assert!((time - number(&row[name])).abs() < 1e-6 * time, "{name} of {n}");
        }
    }
}

/// The paper's squeeze: a row to cells of half the width, as stages.
pub fn to_halves(n: u64, time_squared: Ratio) -> Stages {
    let way = fold(TERMS, n).expect("there is a way");
    let mut stages = stages_of(way, PAPER);
    stages.stages.truncate(1);
    stages.stages[0].time_squared = time_squared;
    stages
}

fn sizes() -> Vec<u64> {
    if whole() {
        return (1..=2000).collect();
    }
    (1..=40)
        .chain([63, 64, 65, 96, 101, 127, 128, 129, 255, 256, 257, 400, 511, 700, 1000, 1023, 2000])
        .collect()
}

#[test]
fn every_row_becomes_a_column_and_a_row_again() {
    for n in sizes() {
        for (name, construction) in METHODS {
            let way = construction(TERMS, n).expect("there is a way");
            let balanced = way.is_balanced();
            let plan = plan_of(stages_of(way, if balanced { BALANCED } else { PAPER }));
            let verdict = judged_plan(&plan);
            assert!(verdict.ok(), "{name} of {n}: {:?}", verdict.failures);
            let dynamics = verdict.dynamics.expect("a lattice has them");
            assert_eq!(dynamics.angular_momentum == 0.0, balanced, "{name} of {n}");
            assert_ends(&plan.body, &row(n), &column(n));
            let back = reversed(&plan);
            let again = judged_plan(&back);
            assert!(
                again.ok() && near(again.duration, verdict.duration),
                "{name} of {n}: {:?}",
                again.failures
            );
        }
    }
}

#[test]
fn angular_momentum_vanishes_where_it_should() {
    for n in [16, 64, 100, 400] {
        assert!(accordion(TERMS, n).expect("there is a way").is_balanced(), "{n}");
    }
    for power in 2..11 {
        assert!(fold(TERMS, 1 << power).expect("there is a way").is_balanced(), "{power}");
    }
    assert!(!shear(TERMS, 9).expect("there is a way").is_balanced());
}

fn row(n: u64) -> Vec<[i64; 3]> {
    (0..n as i64).map(|x| [x, 0, 0]).collect()
}

fn column(n: u64) -> Vec<[i64; 3]> {
    (0..n as i64).map(|y| [0, y, 0]).collect()
}

/// Up to a translation.
fn assert_ends(body: &Body, from: &[[i64; 3]], to: &[[i64; 3]]) {
    let Body::Stages(stages) = body else { panic!("it is a lattice") };
    let settled = |places: &[[i64; 3]]| {
        let low = [0, 1, 2].map(|k| places.iter().map(|p| p[k]).min().unwrap_or(0));
        let mut places: Vec<[i64; 3]> =
            places.iter().map(|p| [p[0] - low[0], p[1] - low[1], p[2] - low[2]]).collect();
        places.sort_unstable();
        places
    };
    assert_eq!(end_shapes(stages).expect("cells are on the lattice"), (settled(from), settled(to)));
}

/// A problem with its settings.
#[derive(Clone, Copy)]
struct Task<'a> {
    from: &'a [[i64; 3]],
    to: &'a [[i64; 3]],
    method: Method,
    demand: ModelChoice,
    profile: Profile,
    max_force: Option<f64>,
    euclidean: bool,
}

/// A plan with its report.
#[derive(Debug)]
struct Found {
    stages: Stages,
    lower_bound: f64,
    method: Method,
    balanced: bool,
}

fn squeeze(cell: &Cell, task: &Task) -> Result<Found, Refusal> {
    let Task { method, demand: model, profile, max_force, euclidean, .. } = *task;
    let problem = Problem::floating(cell.clone(), task.from.to_vec(), task.to.to_vec());
    let norm = if euclidean { Norm::Euclidean } else { Norm::EachAxis };
    let settings = Settings { method, model, profile, max_force, norm };
    let solution = modl::planners::squeeze::plan(&problem, &settings, &mut NoProgress)?;
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    let Report { lower_bound, method, balanced, .. } = solution.report;
    Ok(Found { stages, lower_bound, method, balanced })
}

fn task<'a>(from: &'a [[i64; 3]], to: &'a [[i64; 3]]) -> Task<'a> {
    Task {
        from,
        to,
        method: Method::Auto,
        demand: ModelChoice::Auto,
        profile: Profile::BangBang,
        max_force: None,
        euclidean: false,
    }
}

fn found(task: &Task) -> Found {
    squeeze(&unit_cell(), task).expect("there is a plan")
}

/// Found, judged, ends as asked, and the same backwards.
fn check(task: &Task) -> Found {
    let found = found(task);
    let plan = plan_of(found.stages.clone());
    let verdict = judged_plan(&plan);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    assert!(found.lower_bound <= verdict.duration * (1.0 + 1e-12));
    assert_ends(&plan.body, task.from, task.to);
    let again = judged_plan(&reversed(&plan));
    assert!(again.ok() && near(again.duration, verdict.duration), "{:?}", again.failures);
    found
}

/// A connected set in a plane that grows by random neighbours: the same for the same seed.
fn random_set(seed: &mut u64, count: usize) -> Vec<[i64; 3]> {
    random_set_in(2, seed, count)
}

fn random_set_in(dimensions: usize, seed: &mut u64, count: usize) -> Vec<[i64; 3]> {
    let mut random = |below: usize| {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((*seed >> 33) % below as u64) as usize
    };
    let (mut places, mut known) = (vec![[0_i64; 3]], BTreeSet::from([[0_i64; 3]]));
    while places.len() < count {
        let mut place = places[random(places.len())];
        place[random(dimensions)] += if random(2) == 0 { 1 } else { -1 };
        if known.insert(place) {
            places.push(place);
        }
    }
    places
}

#[test]
fn random_sets_become_each_other() {
    let (sets, most) = if whole() { (1000, 400) } else { (40, 100) };
    let mut seed = 7;
    for i in 0..sets {
        let count = 1 + (i * 7919) % most;
        let (from, to) = (random_set(&mut seed, count), random_set(&mut seed, count));
        check(&task(&from, &to));
    }
    let (from, to) = (random_set(&mut seed, 400), random_set(&mut seed, 400));
    check(&task(&from, &to));
}

#[test]
fn sets_in_space_melt_and_grow() {
    let corner = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    assert_eq!(check(&Task { method: Method::Melt, ..task(&row(4), &corner) }).method, Method::Melt);
    let (sets, most) = if whole() { (100, 120) } else { (20, 30) };
    let mut seed = 11;
    for i in 0..sets {
        let count = 5 + (i * 31) % most;
        let (from, to) = (random_set_in(3, &mut seed, count), random_set_in(3, &mut seed, count));
        check(&task(&from, &to));
        check(&Task { method: Method::Melt, ..task(&row(count as u64), &to) });
    }
    // A header of a cube, whose boxes close loops, and a solid one.
    let edge = |p: &[i64; 3]| p.iter().filter(|&&x| x == 0 || x == 3).count() >= 2;
    let header: Vec<[i64; 3]> = block([4, 4, 4]).into_iter().filter(edge).collect();
    check(&task(&header, &block([2, 4, 4])));
    check(&Task { method: Method::Melt, ..task(&block([3, 3, 3]), &row(27)) });
}

#[test]
fn arms_turn_up_in_balance_and_faster_than_an_accordion_folds() {
    for n in 4..=if whole() { 2000 } else { 70 } {
        let way = arms(TERMS, n).expect("there is a way");
        // Levels swap in turns: an even number of them turns nothing.
        assert_eq!(way.is_balanced(), n % 4 < 2, "{n}");
        let (duration, balanced) = (way.duration(), way.is_balanced());
        let plan = plan_of(stages_of(way, if balanced { BALANCED } else { PAPER }));
        let verdict = judged_plan(&plan);
        assert!(verdict.ok(), "{n}: {:?}", verdict.failures);
        assert_ends(&plan.body, &row(n), &column(n));
        let again = judged_plan(&reversed(&plan));
        assert!(again.ok() && near(again.duration, verdict.duration), "{n}: {:?}", again.failures);
        // Arms of one level more than they are long, from rest to rest; then the squeezed column spreads.
        if n >= 16 {
            let level = n.div_ceil(2) as f64;
            let closed = 2.0 * libm::sqrt(level - 1.5) + libm::sqrt(n as f64 - 1.0);
            assert!((closed..closed + 6.0).contains(&duration), "{n}: {duration} for {closed}");
            assert!(duration < accordion(TERMS, n).expect("there is a way").duration(), "{n}");
        }
    }
    let (from, to) = (row(101), column(101));
    let balanced = found(&Task { demand: ModelChoice::Balanced, ..task(&from, &to) });
    assert_eq!(balanced.method, Method::Arms);
}

#[test]
fn between_boxes_no_merge_is_missed() {
    for (from, to) in
        [([4, 3, 1], [6, 2, 1]), ([3, 3, 1], [9, 1, 1]), ([5, 3, 1], [3, 5, 1]), ([4, 4, 1], [8, 2, 1])]
    {
        let (from, to) = (block(from), block(to));
        let any = Task { demand: ModelChoice::Paper, ..task(&from, &to) };
        let merged = found(&Task { method: Method::Merge, ..any });
        assert!(found(&any).stages.duration() < merged.stages.duration());
        assert!(found(&task(&from, &to)).balanced || !merged.balanced);
    }
}

#[test]
fn plans_are_joined_where_the_shapes_are_the_same() {
    let (tee, ell) = (
        [[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [1, 2, 0], [1, 3, 0]],
        [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0], [2, 3, 0]],
    );
    let slab = block([2, 3, 1]);
    let plan = |from: &[[i64; 3]], to: &[[i64; 3]]| plan_of(found(&task(from, to)).stages);
    let (first, second) = (plan(&tee, &ell), plan(&ell, &slab));
    // The cells of the second plan are numbered in another way, and end in other places.
    for (p, q, to) in [(&first, &second, &slab[..]), (&first, &reversed(&first), &tee)] {
        let both = joined(p, q).expect("the one ends as the other starts");
        let verdict = judged_plan(&both);
        assert!(verdict.ok(), "{:?}", verdict.failures);
        assert!(near(verdict.duration, p.body.duration() + q.body.duration()));
        assert_ends(&both.body, &tee, to);
        let Body::Stages(stages) = &both.body else { panic!("it is a lattice") };
        let jump = stages.state(p.body.duration() * (1.0 - 1e-9));
        let seam = stages.state(p.body.duration() * (1.0 + 1e-9));
        let apart = |k: usize| jump.iter().zip(&seam).map(move |(a, b)| (a.center[k] - b.center[k]).abs());
        assert!((0..3).all(|axis| apart(axis).all(|distance| distance < 1e-6)), "no cell jumps");
    }
    assert_eq!(joined(&second, &first), Err(OperationError::Shapes));
    let more = plan(&row(5), &column(5));
    assert_eq!(joined(&first, &more), Err(OperationError::CellCounts { first: 6, second: 5 }));
    let mut others = second.clone();
    let cell = Cell { name: "Other".into(), ..unit_cell() };
    others.library = std::sync::Arc::new(modl::robot::Library { cells: vec![cell], ..Default::default() });
    assert_eq!(joined(&first, &others), Err(OperationError::Cells));
}

#[test]
fn boxes_become_boxes() {
    let cases =
        [([2, 3, 4], [24, 1, 1]), ([3, 3, 3], [1, 27, 1]), ([4, 6, 1], [8, 3, 1]), ([2, 2, 5], [1, 4, 5])];
    for (from, to) in cases {
        check(&task(&block(from), &block(to)));
    }
    let (from, to) = (block([8, 4, 2]), block([2, 8, 4]));
    let folded = check(&Task { method: Method::Fold, ..task(&from, &to) });
    assert_eq!(folded.method, Method::Fold);
    for sides in [[1, 1, 7], [5, 4, 3], [2, 1, 6], [3, 5, 1]] {
        let way = unroll(TERMS, sides).expect("there is a way");
        assert!(judged(way, PAPER).ok(), "{sides:?}");
    }
}

#[test]
fn one_fold_of_an_array_takes_what_lemma_4_says() {
    for (m, n) in [(1, 8), (3, 6), (4, 10)] {
        let way = halve(TERMS, [n, m, 1], [n / 2, 2 * m, 1]).expect("by halves").expect("there is a way");
        let expected = libm::sqrt(n as f64 - 1.0) + 2.0 + libm::sqrt(2.0 * m as f64 - 1.0);
        assert!(near(way.duration(), expected), "{m} x {n}");
        assert!(judged(way, PAPER).ok());
    }
}

#[test]
fn the_fastest_is_taken_that_the_model_allows() {
    let (from, to) = (row(100), column(100));
    let free = found(&task(&from, &to));
    assert_eq!((free.method, free.balanced), (Method::Arms, true));
    // An array with even sides is as good as the squarest: 20 by 50 for 1000.
    let (long, high) = (row(1000), column(1000));
    let even = found(&Task { method: Method::Accordion, ..task(&long, &high) });
    assert_eq!((even.method, even.balanced), (Method::Accordion, true));
    assert!(even.stages.duration() < 1.05 * accordion(TERMS, 1000).expect("there is a way").duration());
    let paper = found(&Task { demand: ModelChoice::Paper, ..task(&from, &to) });
    assert_eq!(paper.method, Method::Shear);
    assert!(near(paper.stages.duration(), paper.lower_bound), "the shear meets the bound");
    assert!(near(paper.lower_bound, libm::sqrt(2.0 * 99.0)));
    let held = squeeze(
        &unit_cell(),
        &Task { demand: ModelChoice::Balanced, method: Method::Shear, ..task(&from, &to) },
    );
    assert_eq!(held.expect_err("it turns"), Refusal::Unbalanced { method: Method::Shear });
}

#[test]
fn accelerations_are_bound_in_length_where_asked() {
    let (from, to) = (row(64), column(64));
    let shear = Task { method: Method::Shear, ..task(&from, &to) };
    let (each, whole) = (found(&shear), check(&Task { euclidean: true, ..shear }));
    // Every cell moves by as much along x as along y.
    let slower = whole.stages.duration() / each.stages.duration();
    assert!((slower - libm::pow(2.0, 0.25)).abs() < 1e-8, "{slower}");
    let mut quick = each.stages;
    quick.model.euclidean = true;
    let verdict = judged_plan(&plan_of(quick));
    assert!(verdict.failures.iter().all(|f| f.kind == modl::plan::CheckKind::Acceleration));
    assert!(!verdict.ok());
    // Stages along one axis stay as they are.
    let fold = Task { method: Method::Fold, ..task(&from, &to) };
    assert_eq!(check(&Task { euclidean: true, ..fold }).stages.duration(), found(&fold).stages.duration());
}

#[test]
fn a_bound_on_contact_forces_slows_plans_down_and_holds() {
    let (from, to) = (row(64), column(64));
    for method in [Method::Accordion, Method::Fold, Method::Shear] {
        let slow = Task { method, max_force: Some(1.0), ..task(&from, &to) };
        let found = check(&slow);
        let verdict = judged_plan(&plan_of(found.stages.clone()));
        let margin = verdict.bond_margin.expect("there is a bound").value;
        assert!(margin.abs() < 1e-9, "no slower than needed: {margin}");
        let force = verdict.dynamics.expect("a lattice has them").peak_force;
        assert!(force <= 1.0 + 1e-9, "{force}");
    }
    // The shear's forces are those of a squeeze: the retimed time is in the notes.
    let found = found(&Task { method: Method::Shear, max_force: Some(1.0), ..task(&from, &to) });
    assert!(near(found.stages.duration(), libm::sqrt(2.0 * 1024.0)));
}

/// Two cells in a row become a column in 1.5 by the shear, for their speeds must not differ by more than 1: no motion is faster.
/// From three on the acceleration alone bounds the time, √(2 (n - 1)).
#[test]
fn no_motion_of_few_cells_is_faster_than_the_shear() {
    for (n, least) in [(2, 1.5), (3, 2.0), (4, libm::sqrt(6.0))] {
        let (from, to) = (row(n), column(n));
        let shear = found(&Task { method: Method::Shear, demand: ModelChoice::Paper, ..task(&from, &to) });
        assert!(near(shear.lower_bound, least), "{n}: {}", shear.lower_bound);
        assert!(near(shear.stages.duration(), least), "{n}: {}", shear.stages.duration());
    }
}

#[test]
fn limits_of_the_cell_scale_the_plan() {
    let (from, to) = (row(64), column(64));
    // Twice the size at the same force: times grow by √2, where speed does not bind.
    let cell = Cell { size: 2.0, shrinks_to: 1.0, speed: 10.0, ..unit_cell() };
    let quick = squeeze(&cell, &task(&from, &to)).expect("there is a plan");
    let unit = found(&task(&from, &to));
    assert!(near(quick.stages.time_unit, libm::sqrt(2.0)));
    assert!(quick.stages.duration() <= unit.stages.duration() * libm::sqrt(2.0) + 1e-9);
    assert!(near(quick.lower_bound, unit.lower_bound * libm::sqrt(2.0)));
    // A slow cell: every stage lasts as long as its contacts need.
    let slow = Cell { speed: 0.01, ..unit_cell() };
    let fixed = Task { method: Method::Accordion, ..task(&from, &to) };
    let slow = squeeze(&slow, &fixed).expect("there is a plan");
    assert!(slow.stages.stages.iter().all(|stage| stage.time_squared == Ratio(40_000, 1)));
    // With stretches of constant speed it takes little more than half of that.
    let terms = Task { profile: Profile::Trapezoid, ..fixed };
    let cell = Cell { speed: 0.01, ..unit_cell() };
    let steady = squeeze(&cell, &terms).expect("there is a plan");
    assert!(steady.stages.duration() < 0.6 * slow.stages.duration());
    let mut plan = plan_of(steady.stages);
    plan.library = std::sync::Arc::new(modl::robot::Library { cells: vec![cell], ..Default::default() });
    let verdict = judged_plan(&plan);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    let Body::Stages(stages) = &plan.body else { panic!("it is a lattice") };
    assert!(stages.stages.iter().all(|stage| matches!(stage.law, Law::Trapezoid(_))));
    // Cells that hardly shrink can't fold, and need not for the accordion.
    let stiff = Cell { shrinks_to: 0.9, ..unit_cell() };
    assert!(squeeze(&stiff, &task(&from, &to)).is_ok());
    let fold = Task { method: Method::Fold, ..task(&from, &to) };
    assert_eq!(squeeze(&stiff, &fold).expect_err("too stiff"), Refusal::Stiff { smallest: Ratio(9, 10) });
}

#[test]
fn what_is_not_covered_is_refused() {
    // Six arms of 80 cells: more cells than melt, and a bounding box of four million sites.
    let arm = |axis: usize| {
        (-80..=80).filter(move |&at| at != 0 || axis == 0).map(move |at| {
            let mut place = [0; 3];
            place[axis] = at;
            place
        })
    };
    let star: Vec<[i64; 3]> = (0..3).flat_map(arm).collect();
    assert_eq!(
        squeeze(&unit_cell(), &task(&row(481), &star)).expect_err("in space"),
        Refusal::Solid { first: false, most: 400 }
    );
    assert_eq!(
        squeeze(&unit_cell(), &task(&row(4), &row(5))).expect_err("one more"),
        Refusal::Counts { from: 4, to: 5 }
    );
    let (tee, bar) = ([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]], row(4));
    assert_eq!(
        squeeze(&unit_cell(), &Task { method: Method::Shear, ..task(&bar, &tee) }).expect_err("no column"),
        Refusal::Method { method: Method::Shear }
    );
}
