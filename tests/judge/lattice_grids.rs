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
    Anchor, Body, CellLimits, CheckKind, Law, Model, Plan, Ratio, Run, Stage, StageEnd, Stages, joined,
    reversed,
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
    scaled(cells, Fraction::new(prime - 1, prime))
}

/// Returns the cells smaller by a factor, and as much nearer to the centre of mass.
fn scaled(cells: &[Place], part: Fraction) -> Vec<Place> {
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

/// The greatest force and speed of breaths of these cells: at most eight of them go 1/250 of a size each in 20 units of time,
/// so quickly as 2 d / T, by forces of at most 4 d / T² for each.
const BREATH_MAX: f64 = 1e-3;

/// Returns the checks that a plan fails, each once, and the numbers of its verdict that breaths do not change: angular momentum,
/// lower bound, force and speed.
fn findings(plan: &Plan) -> (Vec<CheckKind>, Option<[f64; 4]>) {
    let verdict = judged_plan(plan);
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
    kinds.sort();
    kinds.dedup();
    let numbers = verdict.dynamics.map(|dynamics| {
        let [force, speed] = [dynamics.peak_force, dynamics.peak_speed].map(|peak| peak.max(BREATH_MAX));
        [dynamics.angular_momentum, dynamics.lower_bound, force, speed]
    });
    (kinds, numbers)
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
            let numbers = found.1.expect("judged").into_iter().zip(expected.1.expect("judged"));
            numbers.for_each(|(found, expected)| assert!((found - expected).abs() < 1e-12, "{list:?}"));
            if found.0.is_empty() { taken += 1 } else { refused += 1 }
        }
    }
    assert!(taken > 5 && refused > 100, "{taken} taken, {refused} refused");
}

/// Returns a row of four whole cells that does nothing.
fn row_of_four(model: Model) -> Stages {
    let cell = |x: i64| [Ratio(x, 1), Ratio::ZERO, Ratio::ONE, Ratio::ONE];
    stages_by_hand(&(0..4).map(cell).collect::<Vec<_>>(), &[], model)
}

/// A row that breathes: the least fault of one cell is found in whichever stage it is.
#[test]
fn the_least_faults_are_found_on_every_grid() {
    let by_hand = row_of_four(BALANCED);
    let (start, _) = listed(&by_hand);
    let list = breathing(&start, &[]);
    let verdict = |list: &[Listed]| findings(&plan_of_small(stated(&by_hand, &start, list)));
    assert_eq!(verdict(&list), (vec![], Some([0.0, 0.0, BREATH_MAX, BREATH_MAX])));
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
    let by_hand = row_of_four(BALANCED);
    let (start, _) = listed(&by_hand);
    let mut list = breathing(&start, &[]);
    for prime in [(1 << 41) + 27, i128::from(i64::MAX) / 8] {
        for stage in [0, list.len() / 2, list.len() - 1] {
            // Rounded, these would be no fault that turns the row, or moves it.
            list[stage].1[1].center[2] = Fraction::new(1, prime);
            list[stage].1[2].center[2] = Fraction::new(-1, prime);
            let found = findings(&plan_of_small(stated(&by_hand, &start, &list)));
            assert_eq!(found, (vec![CheckKind::Form], None));
            (1..3).for_each(|cell| list[stage].1[cell].center[2] = Fraction::ZERO);
        }
    }
}

/// Files, reversal, shapes at the ends and joining take such plans as well.
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
    let (longer, _) = listed(&stages(&long));
    assert!(lines(&longer, &listed(&stages(&long)).1) > LINES_MAX.into());
    let sorted = |mut cells: Vec<[i64; 3]>| {
        cells.sort_unstable();
        cells
    };
    assert_eq!(end_shapes(&stages(&long)).expect("whole cells"), (sorted(square), sorted(other)));
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

/// Cells that get lower and higher again under an obstacle that they touch: they may, but no cell may reach into it, in whichever
/// stage, by the least bit.
#[test]
fn obstacles_are_met_on_every_grid() {
    let mut by_hand = row_of_four(PAPER);
    let box_above = Run {
        first: 0,
        counters: vec![],
        center: [Ratio(3, 1), Ratio::ONE, Ratio::ZERO],
        size: [Ratio::ONE; 3],
    };
    by_hand.anchor = Some(Anchor { cells: vec![0], obstacles: vec![box_above] });
    let (start, _) = listed(&by_hand);
    let slow = Ratio(400, 1);
    let mut list = vec![];
    for prime in PRIMES {
        let mut lower = start.clone();
        lower[1..].iter_mut().for_each(|cell| cell.size[1] = Fraction::new(prime - 1, prime));
        list.extend([(slow, lower), (slow, start.clone())]);
    }
    assert!(lines(&start, &list) > LINES_MAX.into());
    let kinds = |list: &[Listed]| findings(&plan_of_small(stated(&by_hand, &start, list))).0;
    assert_eq!(kinds(&list), []);
    for stage in 0..list.len() {
        let raised = |by: Fraction| {
            let mut wrong = list.clone();
            let cell = &mut wrong[stage].1[3];
            cell.center[1] = (Fraction::ONE - cell.size[1]) * Fraction::new(1, 2) + by;
            kinds(&wrong)
        };
        assert_eq!(raised(Fraction::ZERO), [], "{stage}");
        assert_eq!(raised(Fraction::new(1, 65_537)), [CheckKind::Collision], "{stage}");
    }
}

/// Shrinking that goes on from one stage to the next: its speed may not jump by the least bit.
#[test]
fn speeds_go_on_on_every_grid() {
    let by_hand = row_of_four(BALANCED);
    let (start, _) = listed(&by_hand);
    let slow = Ratio(400, 1);
    let part = |parts: i128, prime: i128| Fraction::new(prime - parts, prime);
    let mut list = vec![];
    for prime in PRIMES {
        let half = scaled(&start, part(1, prime));
        list.extend([(slow, half), (slow, scaled(&start, part(2, prime))), (slow, start.clone())]);
    }
    assert!(lines(&start, &list) > LINES_MAX.into());
    let kinds = |list: &[Listed]| {
        let mut stages = stated(&by_hand, &start, list);
        for three in stages.stages.chunks_exact_mut(3) {
            (three[0].law, three[1].law) = (Law::SpeedUp(Ratio::ONE), Law::SlowDown(Ratio::ONE));
        }
        findings(&plan_of_small(stages)).0
    };
    assert_eq!(kinds(&list), []);
    for (group, prime) in PRIMES.into_iter().enumerate() {
        for by in [-1, 1] {
            let mut wrong = list.clone();
            wrong[3 * group].1 = scaled(&start, part(1, prime) + Fraction::new(by, 65_537));
            assert_eq!(kinds(&wrong), [CheckKind::Acceleration], "{group}");
        }
    }
}

/// Cells far from the origin: there the grid has to be coarsened before it has as many lines as it may.
#[test]
fn far_cells_are_judged_as_near_ones() {
    let cell = |x: i64| [Ratio(x, 1), Ratio::ZERO, Ratio::ONE, Ratio::ONE];
    for far in [0, 300, 4000] {
        let by_hand = stages_by_hand(&[cell(far), cell(far + 1)], &[], BALANCED);
        let (start, _) = listed(&by_hand);
        let mut list = vec![];
        for prime in [1009, 1013, 1019, 251, 1021] {
            list.extend([(Ratio(400, 1), breath(&start, prime)), (Ratio(400, 1), start.clone())]);
        }
        // Without the last prime there are fewer lines than the finest grid has.
        assert!(lines(&start, &list[..8]) < LINES_MAX.into() && lines(&start, &list) > LINES_MAX.into());
        let kinds = |list: &[Listed]| findings(&plan_of_small(stated(&by_hand, &start, list))).0;
        assert_eq!(kinds(&list), [], "{far}");
        let mut wrong = list.clone();
        wrong[6].1[1].center[0] -= Fraction::new(1, 65_537);
        assert!(kinds(&wrong).contains(&CheckKind::Collision), "{far}");
    }
}

/// Parts of plans may end in configurations that no grid holds together: they are judged, and no lower bound is known of them.
#[test]
fn ends_without_a_common_grid_are_judged() {
    let by_hand = row_of_four(BALANCED);
    let (whole, _) = listed(&by_hand);
    let (first, second) = ((1 << 31) - 1, 1_000_003);
    let slow = Ratio(400, 1);
    let list = [(slow, whole.clone()), (slow, scaled(&whole, Fraction::new(second - 1, second)))];
    let from = scaled(&whole, Fraction::new(first - 1, first));
    assert!(lines(&from, &list) > LINES_MAX.into());
    let (kinds, numbers) = findings(&plan_of_small(stated(&by_hand, &from, &list)));
    assert_eq!((kinds, numbers.expect("judged")[..2].to_vec()), (vec![], vec![0.0, 0.0]));
}
