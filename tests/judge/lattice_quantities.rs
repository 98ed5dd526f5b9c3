//! Quantities that verdicts on lattices state, in SI units, by closed forms and by differences of the cells' places.

use crate::support::lattices::{
    BALANCED, Flat, PAPER, TERMS, plan_of, runs_of, stages_by_hand, stages_of, unit_cell,
};
use modl::plan::lattice::{peak_forces, time_lower_bound};
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, Failure, Law, Model, Plan, Ratio, Stage, Stages, Verdict};
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, accordion, fold, plan as squeezed, shear};
use modl::robot::{Cell, Library};
use std::sync::Arc;

/// The size (m), mass (kg) and unit of time (s) of the cells here: half a metre in a quarter of a second.
const SIZE: f64 = 0.5;
const MASS: f64 = 3.0;
const TIME: f64 = 0.25;
/// The units of speed (m/s) and acceleration (m/s²), which are the limits of the cells.
const SPEED: f64 = SIZE / TIME;
const ACCELERATION: f64 = SPEED / TIME;

fn cell() -> Cell {
    let (shrinks_to, force) = (SIZE / 2.0, MASS * ACCELERATION);
    Cell { name: "Other".into(), size: SIZE, shrinks_to, mass: MASS, force, speed: SPEED, slides: true }
}

/// Returns the plan of stages for cells that are not of unit size, mass and speed.
fn plan(mut stages: Stages) -> Plan {
    stages.time_unit = TIME;
    let mut plan = plan_of(stages);
    plan.library = Arc::new(Library { cells: vec![cell()], ..Library::default() });
    plan
}

fn judged(stages: Stages) -> Verdict {
    verify(&plan(stages))
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|f| f.kind).collect();
    kinds.dedup();
    kinds
}

/// The three ways to turn the axes into each other.
const TURNS: [usize; 3] = [0, 1, 2];

/// Returns the stages with their axes exchanged in turn: x becomes the axis of this number.
fn turned(mut stages: Stages, by: usize) -> Stages {
    let turn = |v: &mut [Ratio; 3]| v.rotate_right(by);
    for run in stages.start.iter_mut().chain(stages.stages.iter_mut().flat_map(runs_of)) {
        turn(&mut run.center);
        turn(&mut run.size);
        run.counters.iter_mut().for_each(|counter| turn(&mut counter.step));
    }
    stages
}

/// A cell by hand: centre and size along x and y, in eighths; 1 along z.
type Eighths = [i64; 4];

fn stages(start: &[Eighths], ends: &[(Law, Ratio, &[Eighths])], model: Model) -> Stages {
    let flat = |cells: &[Eighths]| cells.iter().map(|cell| cell.map(|eighths| Ratio(eighths, 8))).collect();
    let ends: Vec<_> = ends.iter().map(|(law, time, end)| (*law, *time, flat(end))).collect();
    let start: Vec<Flat> = flat(start);
    stages_by_hand(&start, &ends, model)
}

/// Returns the row of so many cells that squeezes to half its length in a time, the square of which is given.
fn squeeze(count: u64, time_squared: Ratio) -> Stages {
    let mut stages = stages_of(fold(TERMS, count).expect("there is a way"), PAPER);
    stages.stages.truncate(1);
    stages.stages[0].time_squared = time_squared;
    stages
}

/// The greatest of each quantity over all stages, by differences of places.
#[derive(Default)]
struct Greatest {
    speed: f64,
    energy: f64,
    turning: f64,
    /// The sum of the greatest energies of the stages.
    energies: f64,
}

fn greatest(stages: &Stages) -> Greatest {
    const PARTS: u32 = 600;
    let (instants, mut all) = (stages.instants(), Greatest::default());
    for pair in instants.windows(2) {
        let step = (pair[1] - pair[0]) / f64::from(PARTS);
        let mut energy_here: f64 = 0.0;
        let at = |k: u32| stages.state(pair[0] + step * f64::from(k));
        let mut before = at(0);
        for k in 0..PARTS {
            let after = at(k + 1);
            let (mut energy, mut turning) = (0.0, [0.0; 3]);
            for (a, b) in before.iter().zip(&after) {
                let speed = [0, 1, 2].map(|axis| (b.center[axis] - a.center[axis]) * SIZE / step);
                let place = a.center.map(|x| x * SIZE);
                let square: f64 = speed.iter().map(|v| v * v).sum();
                all.speed = all.speed.max(libm::sqrt(square));
                energy += MASS * square / 2.0;
                for (axis, turning) in turning.iter_mut().enumerate() {
                    let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
                    *turning += MASS * (place[y] * speed[z] - place[z] * speed[y]);
                }
            }
            energy_here = energy_here.max(energy);
            all.turning = all.turning.max(libm::sqrt(turning.iter().map(|l| l * l).sum()));
            before = after;
        }
        all.energy = all.energy.max(energy_here);
        all.energies += energy_here;
    }
    all
}

#[test]
fn speeds_energies_and_momenta_are_those_of_the_moving_cells() {
    for by in TURNS {
        for way in [shear(TERMS, 7), fold(TERMS, 6), accordion(TERMS, 6)] {
            let plan = plan(turned(stages_of(way.expect("there is a way"), PAPER), by));
            let Body::Stages(stages) = &plan.body else { unreachable!("a lattice") };
            let (verdict, expected) = (verify(&plan), greatest(stages));
            assert_eq!(kinds(&verdict), []);
            let found = verdict.dynamics.expect("a lattice has them");
            let near = |found: f64, expected: f64| {
                // By differences a peak is cut off by a part of a stage.
                assert!(found >= expected - 1e-9 && found * 0.99 <= expected + 1e-9, "{found} {expected}");
            };
            near(found.peak_speed, expected.speed);
            near(found.peak_energy, expected.energy);
            near(found.angular_momentum, expected.turning);
            near(verdict.energy, expected.energies);
            // The greatest force, by the stages one by one.
            let forces = peak_forces(stages, true).expect("they are few");
            let unit = MASS * ACCELERATION;
            let of = |((above, below), stage): (&(i128, i128), &Stage)| {
                *above as f64 / *below as f64 / stage.time_squared.to_f64() * unit
            };
            let peak = forces.iter().zip(&stages.stages).map(of).fold(0.0, f64::max);
            assert!((found.peak_force - peak).abs() < 1e-9 * peak && peak > 0.0);
            // No motion is faster than the bound, which the verdict states.
            let bound = time_lower_bound(stages, true).expect("they are few");
            assert_eq!(found.lower_bound, bound);
            assert!(0.0 < bound && bound <= verdict.duration);
        }
    }
}

/// In the middle of a row that squeezes, half of it is pushed: n² / 4 times what an end needs at once, along any axis.
#[test]
fn forces_of_a_squeeze_are_the_same_along_all_axes() {
    for by in TURNS {
        for n in [2, 4, 10, 64] {
            let forces =
                peak_forces(&turned(squeeze(n, Ratio(n as i64, 1)), by), true).expect("they are few");
            let [(above, below)] = forces[..] else { panic!("one stage") };
            // Cell k of a half moves by (2 k + 1) / 4, and all accelerate by four times that.
            assert_eq!(4 * above, i128::from(n) * i128::from(n) * below, "{n}");
        }
    }
}

/// A long row is judged by its order alone: the pairs that come near each other would be too many.
#[test]
fn a_long_row_is_judged_by_its_order() {
    let n = 4000;
    let verdict = judged(squeeze(n, Ratio(n as i64 - 1, 1)));
    assert_eq!(kinds(&verdict), []);
}

fn only(verdict: &Verdict) -> &Failure {
    assert_eq!(verdict.failures.len(), 1, "{verdict:?}");
    &verdict.failures[0]
}

/// Asserts the amounts of a single failure, in SI units, and the cells that it names.
#[track_caller]
fn states(verdict: &Verdict, kind: CheckKind, [value, limit]: [f64; 2], at: &[&str]) {
    let failure = only(verdict);
    assert_eq!(failure.kind, kind, "{failure:?}");
    assert!((failure.value - value).abs() < 1e-9, "{failure:?} is not {value}");
    assert!((failure.limit - limit).abs() < 1e-12, "{failure:?} is not of {limit}");
    assert_eq!(failure.at, at, "{failure:?}");
}

const PAIR: [Eighths; 2] = [[-4, 0, 8, 8], [4, 0, 8, 8]];

#[test]
fn accelerations_and_speeds_that_are_too_great_are_stated() {
    for by in TURNS {
        // The ends of a row of eight go 7/4, from rest to rest in √6: faster than 1 by a sixth.
        let verdict = judged(turned(squeeze(8, Ratio(6, 1)), by));
        states(&verdict, CheckKind::Acceleration, [7.0 / 6.0 * ACCELERATION, ACCELERATION], &["cell 0"]);
        // By 1/4 and by 1/8 across: along each axis as fast as may be, and together faster.
        let skewed: &[Eighths] = &[[-2, 1, 4, 8], [2, -1, 4, 8]];
        let skew = |time: Ratio, euclidean: bool| {
            let model = Model { euclidean, ..PAPER };
            judged(turned(stages(&PAIR, &[(Law::BangBang, time, skewed)], model), by))
        };
        assert_eq!(kinds(&skew(Ratio::ONE, false)), []);
        assert_eq!(kinds(&skew(Ratio(9, 8), true)), []);
        let value = 4.0 * libm::hypot(0.25, 0.125) * ACCELERATION;
        states(&skew(Ratio::ONE, true), CheckKind::Acceleration, [value, ACCELERATION], &["cell 0"]);
    }
}

/// Two cells, one above the other, that slide past each other by half a cell, or halve, at speeds of which a half is allowed.
#[test]
fn cells_that_slide_or_shrink_too_fast_are_stated() {
    let slow = |stages: Stages| {
        let mut plan = plan(stages);
        let Body::Stages(stages) = &mut plan.body else { unreachable!("a lattice") };
        stages.limits.speed_squared = Ratio(1, 4);
        plan.library =
            Arc::new(Library { cells: vec![Cell { speed: SPEED / 2.0, ..cell() }], ..Library::default() });
        verify(&plan)
    };
    let tower: [Eighths; 2] = [[0, -4, 8, 8], [0, 4, 8, 8]];
    let slid: &[Eighths] = &[[2, -4, 8, 8], [-2, 4, 8, 8]];
    let halved: &[Eighths] = &[[-2, 0, 4, 8], [2, 0, 4, 8]];
    for by in TURNS {
        let slides = |time: Ratio| slow(turned(stages(&tower, &[(Law::BangBang, time, slid)], PAPER), by));
        assert_eq!(kinds(&slides(Ratio(4, 1))), []);
        let limits = [SPEED / libm::sqrt(3.0), SPEED / 2.0];
        states(&slides(Ratio(3, 1)), CheckKind::Speed, limits, &["cell 0", "cell 1"]);
        // The sides of both by half a cell, and the cells towards each other by as much.
        let shrinks = |time: Ratio| slow(turned(stages(&PAIR, &[(Law::BangBang, time, halved)], PAPER), by));
        assert_eq!(kinds(&shrinks(Ratio(4, 1))), []);
        let verdict = shrinks(Ratio(3, 1));
        assert_eq!(verdict.failures.len(), 2);
        for (failure, at) in verdict.failures.iter().zip([&["cell 0"][..], &["cell 0", "cell 1"]]) {
            assert_eq!(
                (failure.kind, &failure.at[..]),
                (CheckKind::Speed, &at.iter().map(|c| (*c).to_string()).collect::<Vec<_>>()[..])
            );
            assert!((failure.value - limits[0]).abs() < 1e-9 && (failure.limit - limits[1]).abs() < 1e-12);
        }
    }
}

#[test]
fn sizes_out_of_their_range_are_stated() {
    for by in TURNS {
        let sizes = |end: &[Eighths]| {
            judged(turned(stages(&PAIR, &[(Law::BangBang, Ratio(100, 1), end)], PAPER), by))
        };
        let small = sizes(&[[-1, 0, 3, 8], [2, 0, 3, 8]]);
        let failure = small.failures.iter().find(|f| f.kind == CheckKind::JointRange).expect("too small");
        assert!(failure.message.contains("cell 0 shrinks to"), "{failure:?}");
        assert_eq!((failure.value, failure.limit), (3.0 / 8.0 * SIZE, SIZE / 2.0));
        let large = sizes(&[[-4, 0, 8, 8], [5, 0, 10, 8]]);
        let failure = large.failures.iter().find(|f| f.kind == CheckKind::JointRange).expect("too large");
        assert!(failure.message.contains("cell 1 grows to"), "{failure:?}");
        assert_eq!((failure.value, failure.limit), (10.0 / 8.0 * SIZE, SIZE));
    }
}

/// Failures without an amount state none: cells that meet, and a centre of mass that moves.
#[test]
fn failures_without_an_amount_state_none() {
    for (by, axis) in TURNS.into_iter().zip(["x", "y", "z"]) {
        let ends = |start: &[Eighths], end: &[Eighths]| {
            judged(turned(stages(start, &[(Law::BangBang, Ratio(100, 1), end)], PAPER), by))
        };
        let closer = ends(&PAIR, &[[-3, 0, 8, 8], [3, 0, 8, 8]]);
        states(&closer, CheckKind::Collision, [0.0, 0.0], &["cell 0", "cell 1"]);
        assert_eq!(only(&closer).time, 10.0 * TIME);
        let moved = ends(&PAIR, &[[-3, 0, 8, 8], [5, 0, 8, 8]]);
        states(&moved, CheckKind::Momentum, [0.0, 0.0], &[]);
        assert!(only(&moved).message.contains(&format!("moves along {axis}")), "{moved:?}");
    }
}

/// Two cells that slide past each other by half a cell turn about their centre: 2 m v at half a cell, v half the relative speed.
#[test]
fn momenta_of_a_plan_that_is_to_be_balanced_are_stated() {
    let tower: [Eighths; 2] = [[0, -4, 8, 8], [0, 4, 8, 8]];
    let slid: &[Eighths] = &[[2, -4, 8, 8], [-2, 4, 8, 8]];
    for by in TURNS {
        let verdict = judged(turned(stages(&tower, &[(Law::BangBang, Ratio(4, 1), slid)], BALANCED), by));
        // By 1/4 of a cell each, at twice the mean speed.
        let momentum = 2.0 * MASS * (0.25 * SIZE * 2.0 / (2.0 * TIME)) * SIZE / 2.0;
        states(&verdict, CheckKind::Momentum, [momentum, 0.0], &[]);
    }
}

/// Cells that do not move at first, or not at all, are where they are: they may not be in each other, and hang together.
#[test]
fn a_start_without_motion_is_judged_by_itself() {
    let apart: [Eighths; 2] = [[-5, 0, 8, 8], [5, 0, 8, 8]];
    let meeting: [Eighths; 2] = [[-3, 0, 8, 8], [3, 0, 8, 8]];
    let halved: &[Eighths] = &[[-2, 0, 4, 8], [2, 0, 4, 8]];
    let cases =
        [(&PAIR, vec![]), (&apart, vec![CheckKind::Connectedness]), (&meeting, vec![CheckKind::Collision])];
    for (start, expected) in cases {
        assert_eq!(kinds(&judged(stages(start, &[], PAPER))), expected);
        // A stage in which nothing moves, in no time or in some, and then one that moves.
        for time in [Ratio::ZERO, Ratio::ONE] {
            let waits = stages(start, &[(Law::BangBang, time, &[][..])], PAPER);
            let found: Vec<CheckKind> = kinds(&judged(waits));
            assert!(found.iter().eq(expected.iter()), "{found:?} {expected:?}");
        }
    }
    let no_time = [(Law::BangBang, Ratio::ZERO, &[][..]), (Law::BangBang, Ratio::ONE, halved)];
    assert_eq!(kinds(&judged(stages(&PAIR, &no_time, PAPER))), []);
}

/// Two cells that speed up as they shrink: they can't begin the next stage at rest, whatever its duration.
#[test]
fn speed_does_not_end_between_stages() {
    let less: &[Eighths] = &[[-3, 0, 6, 8], [3, 0, 6, 8]];
    let least: &[Eighths] = &[[-2, 0, 4, 8], [2, 0, 4, 8]];
    for time in [Ratio::ONE, Ratio(2, 2), Ratio(7, 4)] {
        let up = (Law::SpeedUp(Ratio::ONE), time, less);
        let next = |law: Law| kinds(&judged(stages(&PAIR, &[up, (law, time, least)], PAPER)));
        assert_eq!(next(Law::SlowDown(Ratio::ONE)), []);
        assert_eq!(next(Law::BangBang), [CheckKind::Acceleration]);
    }
}

/// The limits of a plan are those of its cells, but for rounding: by a part in 10⁹.
#[test]
fn limits_of_a_plan_may_differ_from_those_of_its_cells_by_rounding() {
    let found = |time_unit: f64| {
        let mut plan = plan(squeeze(4, Ratio(3, 1)));
        let Body::Stages(stages) = &mut plan.body else { unreachable!("a lattice") };
        stages.time_unit = time_unit;
        let fast = Cell { speed: 2.0 * SPEED, ..cell() };
        plan.library = Arc::new(Library { cells: vec![fast], ..Library::default() });
        kinds(&verify(&plan))
    };
    // The unit of acceleration is more by twice the part by which that of time is less.
    assert_eq!(found(TIME * (1.0 - 0.45e-9)), []);
    assert_eq!(found(TIME * (1.0 - 0.55e-9)), [CheckKind::Form]);
}

/// Limits are stated as short fractions where cells have such, whichever way they are rounded as floating-point numbers.
#[test]
fn limits_near_short_fractions_are_those() {
    for below in 1..=60_i64 {
        for above in 1..=2 * below {
            let x = above as f64 / below as f64;
            let expected = Ratio::new(above.into(), below.into());
            for (low, high) in [(x, x * (1.0 + 1e-12)), (x * (1.0 - 1e-12), x), (x, x)] {
                assert_eq!(Ratio::simplest(low, high), expected, "{above}/{below}");
            }
        }
    }
    assert_eq!(Ratio::simplest(3.1, 3.2), Some(Ratio(16, 5)));
    // The continued fraction of π: 3, 22/7, 333/106, 355/113.
    let pi = std::f64::consts::PI;
    assert_eq!(Ratio::simplest(pi - 3e-7, pi + 3e-7), Some(Ratio(355, 113)));
    for (low, high) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (2.0, 1.0),
        (1e15, 1e16),
        (1e-16, 1e-15),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert_eq!(Ratio::simplest(low, high), None, "{low} {high}");
    }
    // A cell that shrinks to three quarters.
    let cell = Cell { shrinks_to: 0.75, ..unit_cell() };
    let row: Vec<[i64; 3]> = (0..9).map(|x| [x, 0, 0]).collect();
    let column: Vec<[i64; 3]> = (0..9).map(|y| [0, y, 0]).collect();
    let problem = Problem::floating(cell, row, column);
    let settings = Settings { method: Method::Accordion, ..Settings::default() };
    let solution = squeezed(&problem, &settings, &mut NoProgress).expect("no cell shrinks in it");
    let Body::Stages(stages) = solution.body else { panic!("it is a lattice") };
    assert_eq!(stages.limits.smallest, Ratio(3, 4));
}
