//! The squeeze problem of the paper: shapes whose cells shrink at the end, beside its lemmas in closed form.

use crate::support::lattices::{judged_plan, plan_of, random_shape, unit_cell};
use crate::support::recount_lattice::recount;
use modl::plan::{Body, CellBox, CheckKind, Ratio, Stages, joined, reversed};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, ModelChoice, Norm, Problem, Refusal, Report, Settings, plan};

type Site = [i64; 3];

fn squeezed(
    [start, goal]: [&[Site]; 2],
    sides: [f64; 3],
    settings: &Settings,
) -> Result<(Stages, Report), Refusal> {
    let problem = Problem { sides, ..Problem::floating(unit_cell(), start.to_vec(), goal.to_vec()) };
    let solution = plan(&problem, settings, &mut NoProgress)?;
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    Ok((stages, solution.report))
}

fn row(count: i64) -> Vec<Site> {
    (0..count).map(|x| [x, 0, 0]).collect()
}

/// Returns the time of the last stage, in units of time, and checks the plan and its reverse by the judge and by samples.
fn last_stage(stages: &Stages) -> f64 {
    let plan = plan_of(stages.clone());
    let again = judged_plan(&reversed(&plan));
    let verdict = judged_plan(&plan);
    assert!(verdict.ok() && again.ok(), "{:?} {:?}", verdict.failures, again.failures);
    let mut wrong = vec![];
    recount(&plan, &mut wrong);
    assert!(wrong.is_empty(), "{wrong:?}");
    libm::sqrt(stages.stages.last().expect("it moves").time_squared.to_f64())
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.max(1.0), "{found} where {expected} is right");
}

/// Lemma 2: a row of n cells takes √(n-1) units to half its length, and by Lemma 1 no motion takes less.
#[test]
fn a_row_shrinks_to_half_in_the_time_of_the_lemmas() {
    for count in [2, 3, 4, 9, 64, 101] {
        let shape = row(count);
        let (stages, report) =
            squeezed([&shape; 2], [0.5, 1.0, 1.0], &Settings::default()).expect("it shrinks");
        let time = libm::sqrt((count - 1) as f64);
        near(last_stage(&stages), time);
        near(report.lower_bound, time);
        assert!(report.balanced && stages.stages.len() == 1);
        // The middle joint holds floor(n²/4) / (n-1) times the greatest force of a cell.
        let forces = judged_plan(&plan_of(stages.clone())).dynamics.expect("of a lattice").peak_force;
        near(forces, (count * count / 4) as f64 / (count - 1) as f64);
        // Cells of half the length, close together, about the centre of mass.
        let mut cells: Vec<CellBox> = stages.state(stages.duration());
        cells.sort_by(|a, b| a.center[0].total_cmp(&b.center[0]));
        for (cell, number) in cells.iter().zip(0..) {
            near(cell.size[0], 0.5);
            near(cell.center[0], 0.5 * (f64::from(number) - 0.5 * (count - 1) as f64));
        }
    }
}

/// A distance D takes 2 √D; the farthest cell of a box of sides w goes (w - 1) (1 - s) / 2.
#[test]
fn other_shapes_and_sides_take_the_time_of_their_farthest_cell() {
    let block: Vec<Site> = (0..6).flat_map(|x| (0..3).map(move |y| [x, y, 0])).collect();
    let farthest = [5.0 * 0.25 / 2.0, 2.0 * 0.5 / 2.0];
    let (stages, report) = squeezed([&block; 2], [0.75, 0.5, 1.0], &Settings::default()).expect("it shrinks");
    near(last_stage(&stages), 2.0 * libm::sqrt(farthest[0]));
    assert!(report.balanced, "a box is alike on both sides of its axes");
    let euclidean = Settings { norm: Norm::Euclidean, ..Settings::default() };
    let (stages, _) = squeezed([&block; 2], [0.75, 0.5, 1.0], &euclidean).expect("it shrinks");
    let length = libm::hypot(farthest[0], farthest[1]);
    let (found, exact) = (last_stage(&stages), 2.0 * libm::sqrt(length));
    assert!((1.0..1.001).contains(&(found / exact)), "{found} where {exact} is the least");
}

/// An L has a product of inertia: drawn together along one axis it turns, drawn together alike it does not.
#[test]
fn lopsided_shapes_turn_unless_they_shrink_alike() {
    let ell: Vec<Site> = vec![[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [0, 2, 0]];
    let balanced = Settings { model: ModelChoice::Balanced, ..Settings::default() };
    let refused = squeezed([&ell; 2], [0.5, 1.0, 1.0], &balanced).expect_err("it would turn");
    assert_eq!(refused, Refusal::Unbalanced { method: Method::Auto });
    let (stages, report) = squeezed([&ell; 2], [0.5, 0.5, 1.0], &balanced).expect("it shrinks alike");
    assert!(report.balanced);
    last_stage(&stages);
    let (stages, report) =
        squeezed([&ell; 2], [0.5, 1.0, 1.0], &Settings::default()).expect("it turns a little");
    assert!(!report.balanced);
    last_stage(&stages);
}

#[test]
fn what_is_squeezed_comes_after_the_way_and_grows_again_before_another() {
    let (bar, pole): (Vec<Site>, Vec<Site>) = (row(16), (0..16).map(|y| [0, y, 0]).collect());
    let (short, _) = squeezed([&bar, &pole], [1.0, 0.5, 1.0], &Settings::default()).expect("there is a way");
    let (whole, _) = squeezed([&bar, &pole], [1.0; 3], &Settings::default()).expect("there is a way");
    near(short.duration(), whole.duration() + libm::sqrt(15.0));
    last_stage(&short);
    // A row of half cells grows, and becomes a column.
    let (half, _) = squeezed([&bar; 2], [0.5, 1.0, 1.0], &Settings::default()).expect("it shrinks");
    let both = joined(&reversed(&plan_of(half)), &plan_of(whole)).expect("they meet");
    assert!(judged_plan(&both).ok());
}

#[test]
fn random_shapes_shrink_to_any_sides() {
    let mut seed = 7;
    for count in [2, 5, 12, 30] {
        for sides in [[0.5, 1.0, 1.0], [0.6, 0.7, 0.9], [0.5; 3], [1.0, 0.8125, 0.5]] {
            for dimensions in [2, 3] {
                let shape = random_shape(dimensions, true, &mut seed, count);
                let (stages, report) =
                    squeezed([&shape; 2], sides, &Settings::default()).expect("it shrinks");
                last_stage(&stages);
                assert!(report.lower_bound <= stages.duration() * (1.0 + 1e-12));
            }
        }
    }
}

#[test]
fn faster_than_the_lemma_fails() {
    let shape = row(16);
    let (mut stages, _) = squeezed([&shape; 2], [0.5, 1.0, 1.0], &Settings::default()).expect("it shrinks");
    let time = &mut stages.stages[0].time_squared;
    *time = time.times(Ratio(98, 100)).expect("it fits");
    let failures = judged_plan(&plan_of(stages)).failures;
    assert_eq!(failures.iter().map(|failure| failure.kind).collect::<Vec<_>>(), [CheckKind::Acceleration]);
}

#[test]
fn sides_beyond_those_of_the_cell_are_refused() {
    let shape = row(4);
    for (axis, side) in [(0, 0.49), (1, 1.01), (2, 0.0), (0, -1.0), (1, f64::NAN), (2, f64::INFINITY)] {
        let mut sides = [1.0; 3];
        sides[axis] = side;
        let refused = squeezed([&shape; 2], sides, &Settings::default()).expect_err("it is no side");
        assert_eq!(refused, Refusal::Side { axis, smallest: 0.5 });
    }
}
