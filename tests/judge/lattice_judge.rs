//! The judge of lattice plans: what it must reject, each for its reason, and what it must accept.

use crate::planners::squeeze::{to_halves, truth};
use crate::support::lattices::{
    BALANCED, Flat, PAPER, TERMS, UNIT, judged, judged_plan, plan_of, runs_of, stages_by_hand, stages_of,
};
use modl::plan::verify::verify;
use modl::plan::{
    Body, CellLimits, CheckKind, Counter, Ground, Law, Model, Plan, Ratio, Run, Snapshot, Stages, Verdict,
    World, WorldFrom, sliced,
};
use modl::planners::squeeze::{accordion, fold, shear, to_row};
use modl::robot::{Cell, Library};
use proptest::prelude::*;
use serde_json::Value;
use std::sync::Arc;

const HALF: Ratio = Ratio(1, 2);

fn ratio(above: i64, below: i64) -> Ratio {
    Ratio::new(above.into(), below.into()).expect("small")
}

fn stages(start: &[Flat], ends: &[(Ratio, Vec<Flat>)], model: Model) -> Stages {
    let ends: Vec<_> = ends.iter().map(|(time, end)| (Law::BangBang, *time, end.clone())).collect();
    stages_by_hand(start, &ends, model)
}

/// Of a row of `n` about its middle: cell `i` at `pitch` times its place.
fn row(n: i64, pitch: Ratio, width: Ratio) -> Vec<Flat> {
    let cell = |i: i64| [ratio((2 * i - n + 1) * pitch.0, 2 * pitch.1), Ratio::ZERO, width, Ratio::ONE];
    (0..n).map(cell).collect()
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|f| f.kind).collect();
    kinds.sort();
    kinds.dedup();
    kinds
}

fn faults(stages: Stages) -> Vec<CheckKind> {
    kinds(&judged_plan(&plan_of(stages)))
}

/// A row of eight that goes to another in the time of the squeeze, √7.
fn squeezed_to(pitch: Ratio, width: Ratio) -> Vec<CheckKind> {
    let end = row(8, pitch, width);
    faults(stages(&row(8, Ratio::ONE, Ratio::ONE), &[(Ratio(8, 1), end)], PAPER))
}

#[test]
fn the_squeeze_of_the_paper_is_accepted_in_its_time_and_not_sooner() {
    for n in [2, 3, 5, 8, 64] {
        assert_eq!(faults(to_halves(n, Ratio(n as i64 - 1, 1))), []);
        let sooner = ratio((n as i64 - 1) * 9801, 10_000);
        let found = faults(to_halves(n, sooner));
        // Of two cells the speed of the sizes binds as well.
        let expected: &[CheckKind] =
            if n == 2 { &[CheckKind::Speed, CheckKind::Acceleration] } else { &[CheckKind::Acceleration] };
        assert_eq!(found, expected, "{n}");
    }
}

#[test]
fn contact_forces_are_held_to_their_bound_exactly() {
    // The peak of a squeeze of 64 in √63 is 1024/63 = 16.25: as the square of the time, 1024/κ.
    let at = |time: Ratio, bound: Ratio| {
        let mut stages = to_halves(64, time);
        stages.model.contact_force = Some(bound);
        stages
    };
    assert_eq!(faults(at(Ratio(63, 1), Ratio(16, 1))), [CheckKind::BondLoad]);
    assert_eq!(faults(at(Ratio(64, 1), Ratio(16, 1))), []);
    assert_eq!(faults(at(Ratio(63, 1), Ratio(1024, 63))), []);
    assert_eq!(faults(at(Ratio(63, 1), Ratio(1023, 63))), [CheckKind::BondLoad]);
    let verdict = judged_plan(&plan_of(at(Ratio(63, 1), Ratio(16, 1))));
    assert!((verdict.failures[0].value - 1024.0 / 63.0).abs() < 1e-12, "{:?}", verdict.failures[0]);
}

#[test]
fn sizes_and_gaps_are_judged() {
    assert_eq!(squeezed_to(HALF, HALF), []);
    // Too close together; too small; too small for their distance.
    assert!(squeezed_to(Ratio(9, 20), HALF).contains(&CheckKind::Collision));
    assert!(squeezed_to(HALF, Ratio(9, 20)).contains(&CheckKind::JointRange));
    assert_eq!(squeezed_to(Ratio(3, 5), HALF), [CheckKind::Connectedness]);
    assert!(squeezed_to(Ratio(3, 2), Ratio(3, 2)).contains(&CheckKind::JointRange));
}

/// Neighbours of a row that end up in each other are named.
#[test]
fn cells_in_each_other_are_named() {
    let end = row(3, Ratio(9, 20), HALF);
    let plan = plan_of(stages(&row(3, Ratio::ONE, Ratio::ONE), &[(Ratio(8, 1), end)], PAPER));
    let verdict = judged_plan(&plan);
    let meeting = verdict.failures.iter().find(|f| f.kind == CheckKind::Collision).expect("they overlap");
    assert_eq!(meeting.at, ["cell 0", "cell 1"]);
}

/// Margins are parts of limits: with cells of half a metre and other units of time they stay, if their limits do.
#[test]
fn margins_do_not_depend_on_units() {
    let mut plan = plan_of(to_halves(8, Ratio(8, 1)));
    let of = |plan: &Plan| {
        let verdict = judged_plan(plan);
        assert_eq!(kinds(&verdict), []);
        (verdict.speed_margin.expect("speeds are limited").value, verdict.torque_margin.map(|m| m.value))
    };
    let unit = of(&plan);
    let Body::Stages(stages) = &mut plan.body else { unreachable!("a lattice") };
    stages.time_unit = 0.25;
    // Half a metre in a quarter of a second, which is gained in as long.
    let cell = Cell {
        name: "Other".into(),
        size: 0.5,
        shrinks_to: 0.25,
        mass: 3.0,
        force: 24.0,
        speed: 2.0,
        slides: true,
    };
    plan.library = Arc::new(Library { cells: vec![cell], ..Library::default() });
    let other = of(&plan);
    assert!((unit.0 - other.0).abs() < 1e-12, "{unit:?} {other:?}");
    assert!(0.0 < unit.0 && unit.0 < 1.0);
}

/// No motion between two shapes is faster than the bound, which knows nothing of where a shape stands: of two cells that come
/// apart by two more each moves by one, from rest to rest in 2. If their speeds differ by 1 at most, they come apart in 2 and in
/// half a unit to speed up and slow down.
#[test]
fn the_lower_bound_is_that_of_shapes_wherever_they_stand() {
    use modl::plan::lattice::lower_bound::lower_bound;
    for shift in [0, 2, -14] {
        let along_x =
            |places: [i64; 2]| move |axis: usize| if axis == 0 { places.to_vec() } else { vec![0, 0] };
        for (speed_squared, least) in [(Ratio(4, 1), 2.0), (Ratio::ONE, 2.5), (Ratio(1, 100), 20.05)] {
            let bound = |end: i64| {
                lower_bound(along_x([0, 2]), along_x([shift, end + shift]), 1, speed_squared, None)
            };
            assert!((bound(6) - least).abs() < 1e-12, "{}", bound(6));
            assert_eq!(bound(2), 0.0);
        }
    }
}

#[test]
fn the_shifts_that_lemma_4_prints_make_cells_meet() {
    // One row of eight, squeezed; then each pair to the middle of its box, or as printed: the pairs of
    // the left half the other way.
    let half = |i: i64| ratio(2 * i - 7, 4);
    let boxes = |i: i64| ratio(2 * (i / 2) - 3, 2);
    let printed = |i: i64| ratio(2 * i - 7 + if (i % 2 == 1) == (i < 4) { 1 } else { -1 }, 4);
    let start = row(8, Ratio::ONE, Ratio::ONE);
    let squeezed = row(8, HALF, HALF);
    let level = |i: i64| if (i + i / 2) % 2 == 0 { Ratio(-1, 4) } else { Ratio(1, 4) };
    let swap =
        |x: &dyn Fn(i64) -> Ratio, w: Ratio| (0..8).map(|i| [x(i), level(i), w, HALF]).collect::<Vec<Flat>>();
    let contracted = (Ratio(1, 1), swap(&half, HALF));
    let way = |x: &dyn Fn(i64) -> Ratio| {
        let ends = [(Ratio(7, 1), squeezed.clone()), contracted.clone(), (Ratio(1, 1), swap(x, Ratio::ONE))];
        faults(stages(&start, &ends, PAPER))
    };
    assert_eq!(way(&boxes), []);
    assert!(way(&printed).contains(&CheckKind::Collision));
}

#[test]
fn a_row_does_not_become_an_array_in_one_stage() {
    let array =
        |i: i64| [ratio(2 * (i / 3) - 2, 2), ratio(2 * (if i / 3 == 1 { 2 - i % 3 } else { i % 3 }) - 2, 2)];
    let end = (0..9).map(|i| [array(i)[0], array(i)[1], Ratio::ONE, Ratio::ONE]).collect();
    let found = faults(stages(&row(9, Ratio::ONE, Ratio::ONE), &[(Ratio(100, 1), end)], PAPER));
    assert!(found.contains(&CheckKind::Collision) || found.contains(&CheckKind::Connectedness), "{found:?}");
}

#[test]
fn boxes_that_turn_one_way_touch_in_corners_only() {
    // The paper's figure 3: all pairs turn the same way. Its end points are those of the reference.
    let plan = &truth()["small_plans"]["fold_paper_n8"];
    let verdict = by_hand(plan, PAPER);
    assert_eq!(kinds(&verdict), [CheckKind::Connectedness]);
    let pieces = verdict.failures.iter().map(|f| f.value).fold(0.0, f64::max);
    let expected = plan["stages"].as_array().expect("a list").iter();
    let expected = expected.map(|s| s["face_components"].as_f64().expect("a number")).fold(0.0, f64::max);
    assert_eq!(pieces, expected);
    for name in ["fold_checker_n3", "fold_checker_n5", "accordion_n6_r3", "accordion_n9", "squeeze_n5"] {
        let verdict = by_hand(&truth()["small_plans"][name], PAPER);
        assert!(verdict.ok(), "{name}: {:?}", verdict.failures);
    }
}

fn by_hand(plan: &Value, model: Model) -> Verdict {
    let fraction = |value: &Value| {
        let text = value.as_str().expect("a fraction");
        let (above, below) = text.split_once('/').unwrap_or((text, "1"));
        ratio(above.parse().expect("a number"), below.parse().expect("a number"))
    };
    let cells = |end: &Value| -> Vec<Flat> {
        let count = end["x"].as_array().expect("a list").len();
        (0..count).map(|i| ["x", "y", "w", "h"].map(|key| fraction(&end[key][i]))).collect()
    };
    let ends: Vec<(Ratio, Vec<Flat>)> = plan["stages"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|stage| (fraction(&stage["T2"]), cells(&stage["end"])))
        .collect();
    judged_plan(&plan_of(stages(&cells(&plan["start"]), &ends, model)))
}

#[test]
fn a_plan_that_turns_the_robot_is_not_balanced() {
    let way = shear(TERMS, 9).expect("there is a way");
    assert_eq!(kinds(&judged(way.clone(), PAPER)), []);
    assert_eq!(kinds(&judged(way, BALANCED)), [CheckKind::Momentum]);
}

#[test]
fn corrupted_plans_are_rejected_each_for_its_reason() {
    let whole = stages_of(fold(TERMS, 16).expect("there is a way"), BALANCED);
    assert_eq!(faults(whole.clone()), []);
    // Each stage, a hundredth sooner.
    for stage in 0..whole.stages.len() {
        let mut stages = whole.clone();
        let time = &mut stages.stages[stage].time_squared;
        *time = time.times(Ratio(9801, 10_000)).expect("small");
        let found = faults(stages);
        assert!(
            !found.is_empty()
                && found.iter().all(|k| matches!(k, CheckKind::Acceleration | CheckKind::Speed)),
            "{stage}: {found:?}"
        );
    }
    // Some cells a quarter further in one of the stages.
    for stage in 0..whole.stages.len() {
        let mut stages = whole.clone();
        let center = &mut runs_of(&mut stages.stages[stage])[0].center[0];
        *center = ratio(4 * center.0 + center.1, 4 * center.1);
        let found = faults(stages);
        assert!(found.contains(&CheckKind::Momentum), "{stage}: {found:?}");
    }
    // One box turns the other way, and only in one stage: its cells would pass through each other.
    let mut stages = whole.clone();
    let snapshot = stages.state(stages.instants()[2]);
    let (a, b) = (2, 3);
    runs_of(&mut stages.stages[1]).extend([(a, b), (b, a)].map(|(cell, place): (usize, usize)| {
        let center = [snapshot[cell].center[0], snapshot[place].center[1], 0.0];
        Run {
            first: cell as u64,
            counters: vec![],
            center: center.map(|x| ratio((x * 8.0) as i64, 8)),
            size: [HALF, HALF, Ratio::ONE],
        }
    }));
    let found = faults(stages);
    assert!(found.contains(&CheckKind::Collision), "{found:?}");
    // A module that has no place; one that stays behind.
    let mut stages = whole.clone();
    stages.start = stages.start[1..].to_vec();
    let verdict = judged_plan(&plan_of(stages));
    assert_eq!(kinds(&verdict), [CheckKind::Form]);
    for stage in 0..whole.stages.len() {
        let mut stages = whole.clone();
        runs_of(&mut stages.stages[stage]).remove(0);
        assert!(!faults(stages).is_empty(), "{stage}");
    }
    // A jump: no time at all.
    let mut stages = whole.clone();
    stages.stages[3].time_squared = Ratio::ZERO;
    assert!(faults(stages).contains(&CheckKind::Speed));
}

#[test]
fn speed_is_passed_on_between_stages_or_missed() {
    let whole = plan_of(stages_of(shear(TERMS, 9).expect("there is a way"), PAPER));
    assert!(verify(&whole).ok());
    // Half of a shear ends, or begins, in motion.
    let Body::Stages(stages) = &whole.body else { panic!("it is a lattice") };
    let times = stages.instants();
    for (from, to) in [(times[0], times[1]), (times[1], times[2])] {
        let half = sliced(&whole, from, to).expect("between stages");
        assert_eq!(kinds(&verify(&half)), [CheckKind::Rest]);
    }
    // Slower in the second half, it would have to stop at once.
    let mut stages = stages.clone();
    stages.stages[1].time_squared = Ratio(5, 1);
    assert_eq!(faults(stages), [CheckKind::Acceleration]);
}

#[test]
fn lattices_are_judged_in_their_own_world_and_within_their_cells_limits() {
    let plan = plan_of(stages_of(accordion(TERMS, 9).expect("there is a way"), PAPER));
    let heavy = Plan { worlds: vec![WorldFrom { from: 0.0, world: World::default() }], ..plan.clone() };
    assert_eq!(kinds(&verify(&heavy)), [CheckKind::Form]);
    let settling = World { gravity: 0.0, ground: Ground::Settle, ..World::default() };
    let grounded = Plan { worlds: vec![WorldFrom { from: 0.0, world: settling }], ..plan.clone() };
    assert_eq!(kinds(&verify(&grounded)), [CheckKind::Form]);
    for change in [
        |stages: &mut Stages| stages.time_unit = 0.99,
        |stages: &mut Stages| stages.limits.smallest = Ratio(1, 3),
        |stages: &mut Stages| stages.limits.speed_squared = Ratio(101, 100),
    ] {
        let Body::Stages(mut stages) = plan.body.clone() else { panic!("it is a lattice") };
        change(&mut stages);
        assert_eq!(faults(stages), [CheckKind::Form]);
    }
}

/// A row by where it begins at the start and at the end, and by the gaps between its cells at both.
type Sliding = (i64, i64, Vec<(i64, i64)>);

/// Rows one above the other.
fn rows(rows: &[Sliding]) -> (Vec<Flat>, Vec<Flat>) {
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (y, (start, end, gaps)) in rows.iter().enumerate() {
        let (mut x, mut u) = (*start, *end);
        for gap in std::iter::once(&(0, 0)).chain(gaps) {
            (x, u) = (x + gap.0, u + gap.1);
            before.push([Ratio(x, 1), Ratio(y as i64, 1), Ratio::ONE, Ratio::ONE]);
            after.push([Ratio(u, 1), Ratio(y as i64, 1), Ratio::ONE, Ratio::ONE]);
            (x, u) = (x + 1, u + 1);
        }
    }
    (before, after)
}

/// About the centre of mass, for cells of one layer of whole places.
fn centred(cells: &[Flat]) -> Vec<Flat> {
    let sum: i64 = cells.iter().map(|c| c[0].0).sum();
    let n = cells.len() as i64;
    cells.iter().map(|c| [ratio(n * c[0].0 - sum, n), c[1], c[2], c[3]]).collect()
}

/// Many small cells on a large one, whose projections on every axis overlap so that no plane separates them; the last
/// of the small cells is there twice. A long row of cells beside them affords many comparisons to the whole.
fn crowd_with_a_twin() -> Stages {
    let (small, side) = (ratio(1, 20), 12_i64);
    let step = |x: i64, y: i64, z: i64| [ratio(x, 40), ratio(y, 40), ratio(z, 40)];
    let counter = |stride: i64, step: [Ratio; 3]| Counter { count: side as u64, stride, step };
    let crowd = Run {
        first: 0,
        counters: vec![
            counter(side * side, step(2, 0, 1)),
            counter(side, step(1, 2, 0)),
            counter(1, step(0, 1, 2)),
        ],
        center: step(21, 3, 41),
        size: [small; 3],
    };
    let count = (side * side * side) as u64;
    let last = 3 * (side - 1);
    let one = |first: u64, center: [Ratio; 3], size: Ratio| Run {
        first,
        counters: vec![],
        center,
        size: [size; 3],
    };
    let row = Run {
        first: count + 3,
        counters: vec![Counter { count: 1500, stride: 1, step: step(-40, 0, 0) }],
        center: step(-20, 20, 20),
        size: [Ratio::ONE; 3],
    };
    let start = vec![
        crowd,
        one(count, step(21 + last, 3 + last, 41 + last), small),
        one(count + 1, step(20, 20, 20), Ratio::ONE),
        one(count + 2, step(41, 20, 40), small),
        row,
    ];
    let limits = CellLimits { smallest: small, ..UNIT };
    Stages {
        cell: 0,
        count: count + 1503,
        time_unit: 1.0,
        limits,
        model: PAPER,
        anchor: None,
        start,
        stages: vec![],
    }
}

#[test]
fn a_start_with_too_many_near_pairs_to_examine_is_not_proved() {
    let mut plan = plan_of(crowd_with_a_twin());
    let small = Cell { shrinks_to: 0.05, ..plan.library.cells[0].clone() };
    plan.library = Arc::new(Library { cells: vec![small], ..Library::default() });
    let verdict = judged_plan(&plan);
    assert_eq!(kinds(&verdict), [CheckKind::Form]);
    assert!(verdict.failures[0].message.contains("the start is too entangled"), "{verdict:?}");
}

#[test]
fn contacts_may_come_and_go_as_long_as_some_hold() {
    let sliding = |shift: i64, time: Ratio| {
        let (before, after) = rows(&[(0, 0, vec![(0, 0); 5]), (0, shift, vec![(0, 0); 3])]);
        stages(&centred(&before), &[(time, centred(&after))], PAPER)
    };
    // No pair of cells is in contact all the while, and there is always one that is. By 3 in 6 units of
    // time: at half of it the rows pass each other at 1.
    assert_eq!(faults(sliding(3, Ratio(36, 1))), []);
    assert_eq!(faults(sliding(3, Ratio(35, 1))), [CheckKind::Speed]);
    // The forces between the rows: six cells by 12/10, four by 18/10 the other way.
    let verdict = judged_plan(&plan_of(sliding(3, Ratio(36, 1))));
    let force = verdict.dynamics.expect("a lattice has them").peak_force;
    assert!((force - 7.2 * 4.0 / 36.0).abs() < 1e-12, "{force}");
    // A cell that slides on after it has left the other two: they are 2 wide, of 3.
    let (before, after) = rows(&[(0, 0, vec![(0, 0)]), (0, 3, vec![])]);
    let lost = stages(&centred(&before), &[(Ratio(36, 1), centred(&after))], PAPER);
    let verdict = judged_plan(&plan_of(lost));
    assert_eq!(kinds(&verdict), [CheckKind::Connectedness]);
    let expected = 6.0 * (1.0 - libm::sqrt(1.0 / 6.0));
    assert!((verdict.failures[0].time - expected).abs() < 1e-9, "{:?}", verdict.failures[0]);
}

/// Whether at an instant all cells hang together over faces.
fn hangs_together(cells: &[modl::plan::CellBox]) -> bool {
    let touch = |a: usize, b: usize| {
        let gap = |axis: usize| {
            (cells[a].center[axis] - cells[b].center[axis]).abs()
                - (cells[a].size[axis] + cells[b].size[axis]) / 2.0
        };
        (0..3).any(|k| gap(k).abs() < 1e-9 && (0..3).all(|other| other == k || gap(other) < -1e-9))
    };
    let mut reached = vec![0];
    let mut next = 0;
    while next < reached.len() {
        let here = reached[next];
        reached.extend(
            (0..cells.len()).filter(|&b| touch(here, b)).filter(|b| !reached.contains(b)).collect::<Vec<_>>(),
        );
        next += 1;
    }
    reached.len() == cells.len()
}

/// Looks at many instants whether cells overlap: slowly, and in another way than the judge.
fn overlaps(stages: &Stages) -> bool {
    let whole = stages.duration();
    (0..=200).any(|k| {
        let cells = stages.state(whole * f64::from(k) / 200.0);
        (0..cells.len()).any(|i| {
            (0..i).any(|j| {
                (0..3).all(|axis| {
                    let apart = (cells[i].center[axis] - cells[j].center[axis]).abs();
                    apart < (cells[i].size[axis] + cells[j].size[axis]) / 2.0 - 1e-9
                })
            })
        })
    })
}

#[test]
fn no_cells_overlap_at_any_instant_that_is_looked_at() {
    let ell = [[0, 0], [1, 0], [2, 0], [0, 1], [0, 2], [2, 1], [2, 2]];
    let ways = [accordion(TERMS, 13), fold(TERMS, 13), shear(TERMS, 8), to_row(TERMS, &ell, |i| i)];
    for way in ways {
        assert!(!overlaps(&stages_of(way.expect("there is a way"), PAPER)));
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(200))]

    /// Rows that slide past each other, and open and close: the judge finds them in one piece just where
    /// sampling does.
    #[test]
    fn pieces_are_found_as_by_sampling(
        all in proptest::collection::vec(
            (0..4_i64, 0..4_i64, proptest::collection::vec((0..2_i64, 0..2_i64), 0..4)),
            2..4,
        )
    ) {
        let (before, after) = rows(&all);
        let stages = stages(&before, &[(Ratio(10_000, 1), after)], PAPER);
        // Contacts begin and end at fractions with denominators up to 12: between two of them there are
        // several of these instants.
        let whole = (0..400).all(|k| {
            let part = Law::BangBang.part((f64::from(k) + 0.517) / 400.0);
            hangs_together(&stages.state(stages.duration() * part))
        });
        let found = faults(stages);
        prop_assert_eq!(!found.contains(&CheckKind::Connectedness), whole, "{:?}", found);
        prop_assert!(!found.contains(&CheckKind::Collision), "{:?}", found);
    }

    /// Cells that go from one random arrangement to another: where sampling finds an overlap, so does
    /// the judge.
    #[test]
    fn what_sampling_finds_the_judge_finds(
        places in proptest::collection::vec((0..5_i64, 0..5_i64, 0..5_i64, 0..5_i64), 2..5)
    ) {
        let cell = |x: i64, y: i64| [ratio(3 * x, 4), ratio(3 * y, 4), Ratio(3, 4), Ratio(3, 4)];
        let start: Vec<Flat> = places.iter().map(|p| cell(p.0, p.1)).collect();
        let end: Vec<Flat> = places.iter().map(|p| cell(p.2, p.3)).collect();
        let stages = stages(&start, &[(Ratio(400, 1), end)], PAPER);
        let sampled = overlaps(&stages);
        let found = faults(stages);
        prop_assert!(!sampled || found.contains(&CheckKind::Collision), "{:?}", found);
    }
}

#[test]
fn a_plan_that_was_written_is_judged_the_same() {
    let plan = plan_of(stages_of(fold(TERMS, 37).expect("there is a way"), PAPER));
    let text = modl::plan::file::write(&plan).expect("it can be written");
    let again = modl::plan::file::read(&text).expect("it can be read");
    assert_eq!(again.body, plan.body);
    assert_eq!(verify(&again), verify(&plan));
    let Snapshot::Cells(cells) = again.body.state(0.0) else { panic!("it is a lattice") };
    assert_eq!(cells.len(), 37);
}
