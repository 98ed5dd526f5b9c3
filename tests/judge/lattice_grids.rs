//! Plans of lattices whose stages have no grid of whole numbers in common are judged as strictly as others: plans that the judge
//! takes or refuses are judged again with breaths between their stages, in which all cells shrink towards the centre of mass and grow
//! again, each by another fraction.

use crate::support::lattices::{
    BALANCED, PAPER, TERMS, block, judged_plan, moved, plan_of, random_shape, stages_by_hand, stages_of,
    unit_cell,
};
use modl::plan::file::{read, write};
use modl::plan::lattice::{end_shapes, time_lower_bound};
use modl::plan::{
    Body, CellLimits, CheckKind, Law, Plan, Ratio, Run, Stage, StageEnd, Stages, joined, reversed,
};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, accordion, fold, plan};
use modl::robot::{Cell, Library};
use num_bigint::BigInt;
use num_integer::Integer;
use std::sync::Arc;

type Fraction = num_rational::Ratio<i128>;

/// Primes: each is the denominator of a breath.
const PRIMES: [i128; 12] = [1009, 1013, 1019, 1021, 1031, 1033, 1039, 1049, 1051, 1061, 1063, 1069];
/// The lines to a cell of the finest grid that the judge takes.
const LINES_MAX: u64 = 1 << 40;

/// A cell: its centre and size.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Place {
    center: [Fraction; 3],
    size: [Fraction; 3],
}

/// A stage as the square of its time and all cells at its end.
type Listed = (Ratio, Vec<Place>);

fn fraction(Ratio(above, below): Ratio) -> Fraction {
    Fraction::new(above.into(), below.into())
}

fn ratio(number: Fraction) -> Ratio {
    Ratio::new(*number.numer(), *number.denom()).expect("a short number")
}

fn write_runs(runs: &[Run], cells: &mut [Place]) {
    for run in runs {
        let count: u64 = run.counters.iter().map(|counter| counter.count).product();
        for number in 0..count {
            let (mut rest, mut cell) = (number, run.first as i64);
            let mut place = Place { center: run.center.map(fraction), size: run.size.map(fraction) };
            for counter in run.counters.iter().rev() {
                let step = (rest % counter.count) as i64;
                rest /= counter.count;
                cell += counter.stride * step;
                (0..3).for_each(|k| place.center[k] += fraction(counter.step[k]) * i128::from(step));
            }
            cells[cell as usize] = place;
        }
    }
}

/// Returns the cells at the start, and the stages.
fn listed(stages: &Stages) -> (Vec<Place>, Vec<Listed>) {
    let nowhere = Place { center: [Fraction::ZERO; 3], size: [Fraction::ZERO; 3] };
    let mut cells = vec![nowhere; stages.count as usize];
    write_runs(&stages.start, &mut cells);
    let start = cells.clone();
    let mut list = vec![];
    for stage in &stages.stages {
        assert_eq!(stage.law, Law::BangBang, "at rest at both ends");
        match &stage.end {
            StageEnd::Runs(runs) => write_runs(runs, &mut cells),
            StageEnd::Moves(moves) => {
                for (cell, class) in cells.iter_mut().zip(moves.of_cells()) {
                    let class = &moves.classes[class as usize];
                    for k in 0..3 {
                        cell.center[k] += fraction(class.displacement[k]);
                        cell.size[k] += fraction(class.growth[k]);
                    }
                }
            }
        }
        list.push((stage.time_squared, cells.clone()));
    }
    (start, list)
}

/// Returns the stages that state these places.
fn stated(like: &Stages, start: &[Place], list: &[Listed]) -> Stages {
    let runs = |cells: &[Place]| -> Vec<Run> {
        let run = |(first, place): (u64, &Place)| Run {
            first,
            counters: vec![],
            center: place.center.map(ratio),
            size: place.size.map(ratio),
        };
        (0..).zip(cells).map(run).collect()
    };
    let stage = |(time_squared, cells): &Listed| Stage {
        name: "by hand".into(),
        time_squared: *time_squared,
        law: Law::BangBang,
        end: runs(cells).into(),
        cause: modl::plan::CauseId(0),
    };
    Stages { start: runs(start), stages: list.iter().map(stage).collect(), ..like.clone() }
}

/// Returns true if no two cells overlap, and all hang together over faces.
fn is_whole(cells: &[Place]) -> bool {
    let common = |a: &Place, b: &Place, k: usize| {
        let half = Fraction::new(1, 2);
        let end = |p: &Place| p.center[k] + p.size[k] * half;
        let begin = |p: &Place| p.center[k] - p.size[k] * half;
        end(a).min(end(b)) - begin(a).max(begin(b))
    };
    let mut reached = vec![false; cells.len()];
    reached[0] = true;
    let mut open = vec![0];
    while let Some(i) = open.pop() {
        for j in (0..cells.len()).filter(|&j| j != i) {
            let mut common = [0, 1, 2].map(|k| common(&cells[i], &cells[j], k));
            common.sort();
            if common[0] > Fraction::ZERO {
                return false;
            }
            if common[0] == Fraction::ZERO && common[1] > Fraction::ZERO && !reached[j] {
                reached[j] = true;
                open.push(j);
            }
        }
    }
    !reached.contains(&false)
}

/// Returns the cells smaller by the factor 1 - 1/p, and as much nearer to the centre of mass.
fn breath(cells: &[Place], prime: i128) -> Vec<Place> {
    let part = Fraction::new(prime - 1, prime);
    let mean =
        [0, 1, 2].map(|k| cells.iter().map(|cell| cell.center[k]).sum::<Fraction>() / cells.len() as i128);
    let smaller = |cell: &Place| Place {
        center: [0, 1, 2].map(|k| mean[k] + (cell.center[k] - mean[k]) * part),
        size: cell.size.map(|size| size * part),
    };
    cells.iter().map(smaller).collect()
}

/// Returns the same with a breath before each stage and after the last, where the cells hang together.
fn breathing(start: &[Place], list: &[Listed]) -> Vec<Listed> {
    let slow = Ratio(400, 1);
    let mut long = vec![];
    let mut primes = PRIMES.iter().cycle();
    let mut breathe = |cells: &[Place], long: &mut Vec<Listed>| {
        if is_whole(cells) {
            long.push((slow, breath(cells, *primes.next().expect("there are always more"))));
            long.push((slow, cells.to_vec()));
        }
    };
    breathe(start, &mut long);
    for (time, cells) in list {
        long.push((*time, cells.clone()));
        breathe(cells, &mut long);
    }
    // As many as it takes until no grid holds all.
    while long.len() < list.len() + 2 * PRIMES.len() {
        breathe(start, &mut long);
        let back = long.split_off(long.len() - 2);
        long.splice(0..0, back);
    }
    long
}

/// Returns the number of lines to a cell of the grid of all stages.
fn lines(start: &[Place], list: &[Listed]) -> BigInt {
    let cells = list.iter().flat_map(|(_, cells)| cells).chain(start);
    let numbers = cells.flat_map(|cell| cell.center.into_iter().chain(cell.size));
    numbers.fold(BigInt::from(2), |all, number| all.lcm(&BigInt::from(2 * number.denom())))
}

/// Returns a plan of cells that shrink to a quarter.
fn plan_of_small(mut stages: Stages) -> Plan {
    stages.limits = CellLimits { smallest: Ratio(1, 4), ..stages.limits };
    let cell = Cell { shrinks_to: 0.25, ..unit_cell() };
    Plan { library: Arc::new(Library { cells: vec![cell], ..Library::default() }), ..plan_of(stages) }
}

/// Returns the checks that a plan fails, each once, and the numbers of its verdict that breaths do not change.
fn findings(plan: &Plan) -> (Vec<CheckKind>, Option<f64>) {
    let verdict = judged_plan(plan);
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
    kinds.sort();
    kinds.dedup();
    (kinds, verdict.dynamics.map(|dynamics| dynamics.angular_momentum))
}

/// Plans of other methods, in a plane and in space, by constructions and by search.
fn known_plans() -> Vec<Stages> {
    let mut known = vec![
        stages_of(fold(TERMS, 8).expect("a way"), BALANCED),
        stages_of(accordion(TERMS, 9).expect("a way"), PAPER),
    ];
    let mut seed = 2028;
    let mut pushed = |dimensions: usize, count: usize| {
        let mut shape = || random_shape(dimensions, false, &mut seed, count);
        let problem = Problem::floating(unit_cell(), shape(), shape());
        let settings = Settings { method: Method::Push, ..Settings::default() };
        plan(&problem, &settings, &mut NoProgress).ok().map(|solution| match solution.body {
            Body::Stages(stages) => stages,
            _ => panic!("it is a lattice"),
        })
    };
    known.extend([(2, 8), (2, 11), (3, 9), (2, 6), (3, 7)].into_iter().filter_map(|(d, n)| pushed(d, n)));
    assert!(known.len() >= 5);
    known
}

#[test]
fn breaths_between_stages_change_no_verdict() {
    let (mut refused, mut taken) = (0, 0);
    for known in known_plans() {
        let (start, list) = listed(&known);
        let mut tried = vec![list.clone()];
        let small = Fraction::new(1, 7);
        for stage in 0..list.len() {
            // Too fast; a cell aside; one too large; two exchanged; a stage less.
            let mut wrong = list.clone();
            wrong[stage].0 = wrong[stage].0.times(Ratio(9, 10)).expect("short");
            tried.push(wrong);
            let cell = (stage * 5) % start.len();
            let mut wrong = list.clone();
            wrong[stage].1[cell].center[stage % 2] += small;
            tried.push(wrong);
            let mut wrong = list.clone();
            wrong[stage].1[cell].size[0] += small;
            tried.push(wrong);
            let mut wrong = list.clone();
            wrong[stage].1.swap(cell, (cell + 1) % start.len());
            tried.push(wrong);
            let mut wrong = list.clone();
            wrong.remove(stage);
            tried.push(wrong);
        }
        for list in tried {
            let plain = plan_of_small(stated(&known, &start, &list));
            let long = breathing(&start, &list);
            assert!(lines(&start, &list) <= LINES_MAX.into() && lines(&start, &long) > LINES_MAX.into());
            let breathing = plan_of_small(stated(&known, &start, &long));
            let (found, expected) = (findings(&breathing), findings(&plain));
            assert_eq!(found.0, expected.0, "{list:?}");
            let (turning, expected_turning) = (found.1.expect("judged"), expected.1.expect("judged"));
            assert!((turning - expected_turning).abs() < 1e-12);
            if found.0.is_empty() { taken += 1 } else { refused += 1 }
        }
    }
    assert!(taken > 5 && refused > 100, "{taken} taken, {refused} refused");
}

/// A row that breathes: the least fault of one cell is found in whichever stage it is.
#[test]
fn the_least_faults_are_found_on_every_grid() {
    let cell = |x: i64| [Ratio(x, 1), Ratio::ZERO, Ratio::ONE, Ratio::ONE];
    let row: Vec<_> = (0..4).map(cell).collect();
    let by_hand = stages_by_hand(&row, &[], BALANCED);
    let (start, _) = listed(&by_hand);
    let list = breathing(&start, &[]);
    let verdict = |list: &[Listed]| findings(&plan_of_small(stated(&by_hand, &start, list)));
    assert_eq!(verdict(&list), (vec![], Some(0.0)));
    let least = Fraction::new(1, 65_537);
    for stage in 0..list.len() {
        let fault = |by: &dyn Fn(&mut Vec<Place>)| {
            let mut wrong = list.clone();
            by(&mut wrong[stage].1);
            verdict(&wrong).0
        };
        // The outer cells come nearer by as much as each other, or go apart.
        let apart = |by: Fraction| {
            fault(&move |cells| {
                cells[3].center[0] += by;
                cells[0].center[0] -= by;
            })
        };
        assert!(apart(-least).contains(&CheckKind::Collision), "{stage}");
        assert!(apart(least).contains(&CheckKind::Connectedness), "{stage}");
        assert!(fault(&|cells| cells[2].center[1] += least).contains(&CheckKind::Momentum), "{stage}");
        // One up, the other down: the row turns.
        let turned = fault(&|cells| {
            cells[3].center[1] += least;
            cells[0].center[1] -= least;
        });
        assert_eq!(turned, [CheckKind::Momentum], "{stage}");
        if stage % 2 == 1 {
            let large = fault(&|cells| cells.iter_mut().for_each(|cell| cell.size[1] += least));
            assert_eq!(large, [CheckKind::JointRange], "{stage}");
        }
    }
}

/// Numbers that no grid of one stage holds are refused, not rounded.
#[test]
fn stages_that_are_too_fine_by_themselves_are_not_judged() {
    let cell = |x: i64| [Ratio(x, 1), Ratio::ZERO, Ratio::ONE, Ratio::ONE];
    let row: Vec<_> = (0..4).map(cell).collect();
    let by_hand = stages_by_hand(&row, &[], BALANCED);
    let (start, _) = listed(&by_hand);
    let mut list = breathing(&start, &[]);
    for prime in [(1 << 41) + 27, i128::from(i64::MAX) / 8] {
        for stage in [0, list.len() / 2, list.len() - 1] {
            let before = list[stage].1[1].center[2];
            list[stage].1[1].center[2] = Fraction::new(1, prime);
            let verdict = judged_plan(&plan_of_small(stated(&by_hand, &start, &list)));
            assert!(!verdict.ok());
            list[stage].1[1].center[2] = before;
        }
    }
}

/// What else goes through the stages of a plan takes such plans as well: files, reversal, shapes at the ends, joining.
#[test]
fn plans_without_a_common_grid_are_plans() {
    let square = block([3, 3, 1]);
    let other = moved(square.clone(), [2, 2, 0], [0, 3, 0]);
    let problem = Problem::floating(unit_cell(), square.clone(), other.clone());
    let solution = plan(&problem, &Settings::default(), &mut NoProgress).expect("a push");
    let Body::Stages(known) = solution.body else { panic!("it is a lattice") };
    let (start, list) = listed(&known);
    let long = plan_of_small(stated(&known, &start, &breathing(&start, &list)));
    let stages = |plan: &Plan| match &plan.body {
        Body::Stages(stages) => stages.clone(),
        _ => panic!("it is a lattice"),
    };
    assert_eq!(end_shapes(&stages(&long)), end_shapes(&known));
    let bound = |stages: &Stages| time_lower_bound(stages, true).expect("whole numbers");
    assert!((bound(&stages(&long)) - bound(&known)).abs() < 1e-12);
    assert_eq!(read(&write(&long).expect("a file")).expect("a plan"), long);
    let back = reversed(&long);
    let both = joined(&long, &back).expect("they meet");
    assert!(judged_plan(&back).ok() && judged_plan(&both).ok());
    let (first, last) = end_shapes(&stages(&both)).expect("whole cells");
    assert_eq!(first, last);
    assert_eq!(stages(&both).stages.len(), 2 * stages(&long).stages.len());
}
