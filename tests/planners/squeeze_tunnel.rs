//! Lattices of cells that do not slide: blocks tunnel.

use crate::support::lattices::{block, judged_plan, normal, plan_of, random_shape, stages, unit_cell};
use crate::support::recount_lattice::recount;
use modl::plan::file::{read, write};
use modl::plan::lattice::{end_shapes, time_lower_bound};
use modl::plan::{Body, CheckKind, Plan, Ratio, StageEnd, Verdict, joined, reversed};
use modl::planners::NoProgress;
use modl::planners::squeeze::{AnchorFault, Method, ModelChoice, Problem, Refusal, Settings, plan};
use modl::robot::{Cell, Library};
use std::sync::Arc;

type Site = [i64; 3];

fn docked_cell() -> Cell {
    Cell { slides: false, ..unit_cell() }
}

/// Returns the cells of blocks of 2 × 2 × 2.
fn enlarged(blocks: &[Site]) -> Vec<Site> {
    let cells = |b: &Site| {
        block([2, 2, 2]).into_iter().map(|cell| [0, 1, 2].map(|k| 2 * b[k] + cell[k])).collect::<Vec<_>>()
    };
    blocks.iter().flat_map(cells).collect()
}

fn problem(start: &[Site], goal: &[Site]) -> Problem {
    Problem::floating(docked_cell(), start.to_vec(), goal.to_vec())
}

fn planned(problem: &Problem, settings: &Settings) -> Result<Plan, Refusal> {
    let solution = plan(problem, settings, &mut NoProgress)?;
    assert_eq!(solution.report.method, Method::Tunnel);
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    let mut made = plan_of(stages);
    made.library = Arc::new(Library { cells: vec![problem.cell.clone()], ..Library::default() });
    Ok(made)
}

/// Returns the plan of a problem and its verdict, both checked: by the judge and by samples.
fn judged(problem: &Problem) -> (Plan, Verdict) {
    let found = planned(problem, &Settings::default()).expect("there is a way");
    let verdict = judged_plan(&found);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    let mut wrong = vec![];
    recount(&found, &mut wrong);
    assert_eq!(wrong, Vec::<String>::new());
    (found, verdict)
}

/// Checks the plan of a problem by the judge and by samples, and that each stage takes no longer than it must.
fn check(problem: &Problem) -> Plan {
    let (found, verdict) = judged(problem);
    let ends = end_shapes(stages(&found)).expect("whole cells on a lattice");
    assert_eq!(ends, (normal(&problem.start), normal(&problem.goal)));
    assert!(time_lower_bound(stages(&found), problem.cell.slides).expect("they are few") <= verdict.duration);
    for stage in &stages(&found).stages {
        // From rest to rest by d at an acceleration of 1 takes 2 √d.
        assert_eq!(Some(stage.time_squared), farthest(&stage.end).times(Ratio(4, 1)));
    }
    found
}

/// Returns the greatest displacement along an axis of a stage that states moves.
fn farthest(end: &StageEnd) -> Ratio {
    let StageEnd::Moves(moves) = end else { panic!("the stage states moves") };
    let along = moves.classes.iter().flat_map(|class| class.displacement);
    let most = along.map(|d| Ratio(d.0.abs(), d.1)).max_by(|a, b| a.order(*b));
    most.expect("something moves")
}

/// A block on a bar of two goes to its end: around a corner, which the cells on each way do in four stages.
#[test]
fn a_block_goes_around_a_corner() {
    let found = check(&problem(
        &enlarged(&[[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
        &enlarged(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]]),
    ));
    let count = stages(&found).stages.len();
    assert!(count <= 8 * 4, "{count}");
    // Back it goes, and the two plans are one.
    let back = reversed(&found);
    assert!(judged_plan(&back).ok() && judged_plan(&joined(&found, &back).expect("they meet")).ok());
    // A plan of cells that slide and one of cells that do not are not joined.
    let mut others = back;
    others.library = Arc::new(Library { cells: vec![unit_cell()], ..Library::default() });
    assert!(joined(&found, &others).is_err());
}

/// In a straight line the ways of a block take two stages, whatever the length of the line, and each of its four rows goes
/// twice: all at once, or two and two where arms on all sides of a block hang on rows that stay.
#[test]
fn a_block_goes_straight_through_others_in_few_stages() {
    for length in [3, 4, 9] {
        let sites = |from: i64, arms: &[Site]| {
            let line = (from..from + length).map(|x| [x, 0, 0]);
            enlarged(&line.chain(arms.iter().copied()).collect::<Vec<_>>())
        };
        let arms = [[2, 1, 0], [2, -1, 0], [2, 0, 1], [2, 0, -1]];
        for (arms, expected) in [(&arms[..], 8), (&[[1, 1, 0]][..], 4)] {
            let found = check(&problem(&sites(0, arms), &sites(1, arms)));
            assert_eq!(stages(&found).stages.len(), expected, "{length}");
        }
    }
}

/// Ways there and back, up and down, along stairs and through a ring.
#[test]
fn blocks_go_around_any_corners() {
    let stairs: Vec<Site> = (0..4).flat_map(|k| [[k, k, k], [k + 1, k, k], [k + 1, k + 1, k]]).collect();
    let u = [[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0]];
    let ring = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0], [1, 2, 0], [0, 2, 0], [0, 1, 0]];
    let at = |base: &[Site], others: &[Site]| [base, others].concat();
    let cases: Vec<(Vec<Site>, Vec<Site>)> = vec![
        (at(&stairs, &[[-1, 0, 0]]), at(&stairs, &[[4, 4, 4]])),
        (at(&u, &[[0, 3, 0]]), at(&u, &[[2, 3, 0]])),
        (at(&u, &[[-1, 2, 0]]), at(&u, &[[1, 2, 0]])),
        (at(&u, &[[0, 2, 1]]), at(&u, &[[2, 2, -1]])),
        (at(&ring, &[[-1, 1, 0]]), at(&ring, &[[1, 1, 0]])),
        (at(&ring, &[[1, 2, 1]]), at(&ring, &[[1, 0, -1]])),
    ];
    for (start, goal) in cases {
        check(&problem(&enlarged(&start), &enlarged(&goal)));
        check(&problem(&enlarged(&goal), &enlarged(&start)));
    }
}

#[test]
fn random_blocks_become_each_other() {
    let mut seed = 28;
    let pairs = if std::env::var_os("MODL_WHOLE").is_some() { 100 } else { 6 };
    for pair in 0..pairs {
        let (dimensions, count) = (2 + pair % 2, 4 + pair % 9);
        let mut shape = || enlarged(&random_shape(dimensions, pair % 3 == 0, &mut seed, count));
        let (start, goal) = (shape(), shape());
        if normal(&start) != normal(&goal) {
            check(&problem(&start, &goal));
        }
    }
}

/// Fixed cells stay where they are drawn, and what is between them and the goal is gone through.
#[test]
fn fixed_blocks_stay() {
    let base = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, -1, 0]];
    let with = |block: Site| [&base[..], &[block]].concat();
    let (start, goal) = (with([0, 1, 0]), with([2, 1, 0]));
    let task = |fixed: Vec<Site>| Problem { fixed, ..problem(&enlarged(&start), &enlarged(&goal)) };
    let obstacles = enlarged(&[[1, 1, 0], [0, -1, 0], [1, 0, 1]]);
    let (found, _) = judged(&Problem { obstacles, ..task(vec![[3, -1, 1]]) });
    let moved = |cell: usize| {
        let [before, after] = [0.0, found.body.duration()].map(|time| stages(&found).state(time)[cell]);
        before.center != after.center
    };
    let fixed: Vec<usize> =
        stages(&found).anchor.as_ref().expect("it has one").cells.iter().map(|&cell| cell as usize).collect();
    assert!(fixed.len() == 1 && !moved(fixed[0]));
    // The middle of the only way is fixed; and blocks a cell beside those of the start.
    let refused = |problem: &Problem| planned(problem, &Settings::default()).expect_err("no way");
    assert_eq!(refused(&task(vec![[3, 1, 1], [3, -1, 1]])), Refusal::Anchor(AnchorFault::NoWay));
    let beside: Vec<Site> = enlarged(&goal).iter().map(|[x, y, z]| [*x, *y - 1, *z]).collect();
    let beside = Problem { fixed: vec![[0, 0, 0]], ..problem(&enlarged(&start), &beside) };
    assert_eq!(refused(&beside), Refusal::Anchor(AnchorFault::Beside { axis: 1 }));
}

/// Blocks of cells that slide may tunnel as well; connections that hold less make it slower, to the bound.
#[test]
fn tunnelling_is_a_method_like_others() {
    let (start, goal) = (enlarged(&[[0, 0, 0], [1, 0, 0], [0, 1, 0]]), block([6, 2, 2]));
    let settings = |method: Method| Settings { method, ..Settings::default() };
    let sliding = Problem { cell: unit_cell(), ..problem(&start, &goal) };
    let found = planned(&sliding, &settings(Method::Tunnel)).expect("there is a way");
    assert!(judged_plan(&found).ok());
    let peak = |plan: &Plan| judged_plan(plan).dynamics.expect("a lattice has them").peak_force;
    let free = planned(&problem(&start, &goal), &Settings::default()).expect("there is a way");
    let weak = Settings { max_force: Some(1.0), ..Settings::default() };
    let weak = planned(&problem(&start, &goal), &weak).expect("slower");
    assert!(judged_plan(&weak).ok());
    assert!(peak(&free) > 1.0 && peak(&weak) <= 1.0 + 1e-9);
    assert!(weak.body.duration() > free.body.duration());
}

#[test]
fn what_does_not_tunnel_is_refused() {
    let bar = block([4, 2, 2]);
    let refused = |start: &[Site], goal: &[Site], settings: &Settings| {
        planned(&problem(start, goal), settings).expect_err("no way is known")
    };
    let auto = Settings::default();
    // Cells that are in no block, of the first shape and of the second, where they are drawn.
    let row: Vec<Site> = (0..16).map(|x| [x, 5, 0]).collect();
    assert_eq!(refused(&row, &bar, &auto), Refusal::Blocks { first: true, site: [0, 5, 0] });
    let shifted: Vec<Site> = enlarged(&[[0, 0, 0]])
        .into_iter()
        .chain(block([2, 2, 2]).iter().map(|[x, y, z]| [x + 2, y + 1, *z]))
        .collect();
    assert!(matches!(refused(&bar, &shifted, &auto), Refusal::Blocks { first: false, .. }));
    for method in [Method::Accordion, Method::Fold, Method::Merge, Method::Push, Method::Melt] {
        let settings = Settings { method, ..Settings::default() };
        assert_eq!(refused(&bar, &block([2, 4, 2]), &settings), Refusal::Docked { method });
    }
    let balanced = Settings { model: ModelChoice::Balanced, ..Settings::default() };
    assert_eq!(refused(&bar, &block([2, 4, 2]), &balanced), Refusal::Unbalanced { method: Method::Auto });
    let stiff =
        Problem { cell: Cell { shrinks_to: 0.6, ..docked_cell() }, ..problem(&bar, &block([2, 4, 2])) };
    assert_eq!(plan(&stiff, &auto, &mut NoProgress).map(drop), Err(Refusal::Stiff { smallest: Ratio(3, 5) }));
    let long = block([2050, 2, 1]);
    assert!(matches!(refused(&long, &block([2, 2050, 1]), &auto), Refusal::TooMany { most: 2048 }));
    // A shape that stays needs no way: not even blocks, and it shrinks as ever.
    let shrunk = Problem { sides: [0.5, 1.0, 1.0], ..problem(&row, &row) };
    let solution = plan(&shrunk, &auto, &mut NoProgress).expect("one stage");
    let Body::Stages(found) = solution.body else { panic!("it is a lattice") };
    assert_eq!(found.stages.iter().map(|stage| stage.time_squared).collect::<Vec<_>>(), [Ratio(15, 1)]);
}

/// The judge goes by what a file says of the cells: those that do not slide are refused the plan of those that do.
#[test]
fn files_say_if_cells_slide() {
    let (start, goal) = (block([4, 4, 2]), block([8, 2, 2]));
    let found = planned(&problem(&start, &goal), &Settings::default()).expect("there is a way");
    let text = write(&found).expect("it has a file");
    assert!(text.contains("\"slides\": false"));
    assert_eq!(read(&text).expect("a plan").library.cells, [docked_cell()]);
    let sliding = Problem { cell: unit_cell(), ..problem(&start, &goal) };
    let solution = plan(&sliding, &Settings::default(), &mut NoProgress).expect("there is a way");
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    let mut slid = plan_of(stages);
    assert!(judged_plan(&slid).ok());
    assert!(!write(&slid).expect("it has a file").contains("slides"));
    slid.library = found.library;
    let kinds: Vec<CheckKind> = judged_plan(&slid).failures.iter().map(|failure| failure.kind).collect();
    assert!(kinds.contains(&CheckKind::Connectedness), "{kinds:?}");
}
