//! Lengths of struts, their rates and accelerations, on single struts and tetrahedra, and the time and the command that a
//! failure is told with.

use super::truss_plans::*;
use modl::interrupt::{self, CancelState};
use modl::plan::{CauseId, CheckKind, Exemption, ExemptionKind, LengthSum, Status, World, WorldFrom, verify};
use std::cell::RefCell;
use std::rc::Rc;

/// Returns the plan of one strut in free fall, whose ends go straight from one pair of places to another.
fn one(seconds: f64, from: [Place; 2], to: [Place; 2]) -> modl::plan::Plan {
    plan(FREE, &[(0, 1)], vec![straight(0.0, &from), straight(seconds, &to)])
}

/// Returns the least and the greatest length with their times, and the greatest rate, at many moments.
fn looked_at(seconds: f64, from: [Place; 2], to: [Place; 2]) -> ([(f64, f64); 2], f64) {
    let count = 20_000;
    let length = |k: usize| {
        let part = k as f64 / count as f64;
        norm(minus(between(from[0], to[0], part), between(from[1], to[1], part)))
    };
    let (mut least, mut most, mut rate) = ((f64::INFINITY, 0.0), (0.0, 0.0), 0.0f64);
    for k in 0..=count {
        let (l, time) = (length(k), k as f64 / count as f64 * seconds);
        if l < least.0 {
            least = (l, time);
        }
        if l > most.0 {
            most = (l, time);
        }
        if k > 0 {
            rate = rate.max((l - length(k - 1)).abs() / (seconds / count as f64));
        }
    }
    ([least, most], rate)
}

#[test]
fn the_least_and_the_greatest_length_and_rate_are_those_of_many_moments() {
    let mut number = dice(11);
    for round in 0..40 {
        let mut place = || -> Place { std::array::from_fn(|_| number(-1.0, 1.0)) };
        let (from, to) = ([place(), place()], [place(), place()]);
        // In some rounds the strut does not change.
        let still = round % 8 == 7;
        let to = if still { from } else { to };
        let seconds = 3.0;
        let ([least, most], rate) = looked_at(seconds, from, to);
        if least.0 < 0.1 {
            continue;
        }
        let plan = one(seconds, from, to);
        let ranged = |low: f64, high: f64| {
            let verdict = judged(&of_strut(plan.clone(), |strut| strut.length = (low, high)));
            of(CheckKind::JointRange, &verdict)
        };
        assert_eq!(ranged(least.0 - 1e-6, most.0 + 1e-6), vec![], "round {round}");
        let short = ranged(least.0 + 1e-6, 100.0);
        let [failure] = &short[..] else { panic!("round {round}: one failure: {short:?}") };
        assert!((failure.value - least.0).abs() < 1e-6 && failure.limit == least.0 + 1e-6, "{failure:?}");
        assert!(still || (failure.time - least.1).abs() < 2e-3, "round {round}: {failure:?} {least:?}");
        let long = ranged(0.01, most.0 - 1e-6);
        let [failure] = &long[..] else { panic!("round {round}: one failure: {long:?}") };
        assert!((failure.value - most.0).abs() < 1e-6 && failure.limit == most.0 - 1e-6, "{failure:?}");
        assert!(still || (failure.time - most.1).abs() < 2e-3, "round {round}: {failure:?} {most:?}");
        // The margin of speed is what is left of it.
        let speed = 2.0;
        let verdict = judged(&of_strut(plan.clone(), |strut| strut.speed = speed));
        let margin = verdict.speed_margin.as_ref().expect("told").value;
        assert!((margin - (1.0 - rate / speed)).abs() < 1e-3, "round {round}: {margin} {rate}");
        assert_eq!(of(CheckKind::Speed, &verdict).is_empty(), rate < speed, "round {round}");
    }
}

/// A node that passes by another at a distance d with the speed v: the length accelerates by v²/d where they are nearest.
#[test]
fn a_node_that_passes_by_another_accelerates_by_the_square_of_its_speed_over_the_distance() {
    for (d, half, seconds) in [(0.5, 0.3, 2.0), (1.0, 2.0, 3.0), (4.0, 2.0, 0.5), (0.25, 1.0, 10.0)] {
        let speed = 2.0 * half / seconds;
        let most = speed * speed / d;
        let plan = one(seconds, [[0.0; 3], [d, -half, 0.0]], [[0.0; 3], [d, half, 0.0]]);
        // Those told at once are of the jumps at both ends.
        let found = |limit: f64| {
            let verdict = judged(&of_strut(plan.clone(), |strut| strut.acceleration = Some(limit)));
            let mut found = of(CheckKind::Acceleration, &verdict);
            found.retain(|failure| failure.value < f64::MAX);
            found
        };
        assert_eq!(found(most * 1.001), vec![], "{d} {half}");
        let [failure] = &found(most * 0.999)[..] else { panic!("one failure") };
        assert!((failure.value - most).abs() < 1e-9 * most, "{failure:?} {most}");
    }
}

/// From rest to rest, twice as long in two seconds: half of a t² is half of the way in half of the time. What is exactly
/// the limit is no failure, of the speed neither.
#[test]
fn limits_may_be_used_up() {
    let keyframes = vec![
        straight(0.0, &[[0.0; 3], [1.0, 0.0, 0.0]]),
        ramped(2.0, (1.0, 1.0), &[[0.0; 3], [2.0, 0.0, 0.0]]),
    ];
    let limits = |acceleration: f64, speed: f64| {
        let plan = plan(FREE, &[(0, 1)], keyframes.clone());
        judged(&of_strut(plan, |strut| {
            (strut.length, strut.acceleration, strut.speed) = ((1.0, 2.0), Some(acceleration), speed);
        }))
    };
    let used = limits(1.0, 1.0);
    assert_eq!(used.failures, vec![]);
    assert_eq!(used.speed_margin.expect("told").value, 0.0);
    assert_eq!(limits(1.0 - 1e-6, 1.0).failures.len(), 1);
    assert_eq!(limits(1.0, 1.0 - 1e-6).failures.len(), 1);
    assert!((limits(1.0, 4.0).speed_margin.expect("told").value - 0.75).abs() < 1e-12);
}

#[test]
fn what_is_excused_from_its_acceleration_is_told_so() {
    let plan = one(1.0, [[0.0; 3], [1.0, 0.0, 0.0]], [[0.0; 3], [2.0, 0.0, 0.0]]);
    let mut plan = of_strut(plan, |strut| strut.acceleration = Some(1.0));
    assert_eq!(status(&judged(&plan), CheckKind::Acceleration), Status::Failed);
    let kind = ExemptionKind::Acceleration;
    plan.exemptions = vec![Exemption { kind, from: 0.0, to: 1.0, cause: CauseId(0) }];
    let verdict = judged(&plan);
    assert_eq!(verdict.failures, vec![]);
    assert_eq!(status(&verdict, CheckKind::Acceleration), Status::Exempt);
    assert_eq!(verdict.unneeded_exemptions, Vec::<usize>::new());
}

/// The rate jumps at the keyframes: the start is blamed on the first step, the middle on the step that it begins, and what
/// is left at the end on none.
#[test]
fn a_failure_is_blamed_on_the_step_that_it_begins() {
    let at = |time: f64, x: f64| straight(time, &[[0.0; 3], [x, 0.0, 0.0]]);
    let keyframes = vec![at(0.0, 1.0), at(1.0, 2.0), at(2.0, 4.0)];
    let plan = plan(FREE, &[(0, 1)], keyframes);
    let verdict = judged(&of_strut(plan, |strut| strut.acceleration = Some(1.0)));
    let told: Vec<(f64, Vec<CauseId>)> =
        verdict.failures.into_iter().map(|failure| (failure.time, failure.blame)).collect();
    assert_eq!(told, [(0.0, vec![CauseId(1)]), (1.0, vec![CauseId(2)]), (2.0, vec![])]);
}

/// The start is judged as part of the first step, once.
#[test]
fn what_fails_at_the_start_is_told_once() {
    let plan = one(1.0, [[0.0; 3], [3.0, 0.0, 0.0]], [[0.0; 3], [1.0, 0.0, 0.0]]);
    let verdict = judged(&of_strut(plan, |strut| strut.length = (0.5, 2.0)));
    assert_eq!(verdict.failures.len(), 1, "{:?}", verdict.failures);
    assert_eq!((verdict.failures[0].value, verdict.failures[0].time), (3.0, 0.0));
}

/// A top that is beyond its feet all the time, in a world that gets its weight after half of it, and the other way round.
#[test]
fn each_step_is_judged_in_the_world_of_its_time() {
    let aside = tetra([2.5, 0.3, 0.8]);
    let keyframes: Vec<_> = (0..4).map(|k| straight(f64::from(k), &aside)).collect();
    let told = |first: World, second: World| {
        let mut plan = plan(first, &TETRA, keyframes.clone());
        plan.worlds.push(WorldFrom { from: 2.0, world: second });
        let falls = of(CheckKind::Stability, &judged(&plan));
        falls.iter().map(|failure| failure.time).collect::<Vec<f64>>()
    };
    assert_eq!(told(FREE, STANDING), [2.0]);
    assert_eq!(told(STANDING, FREE), [0.0, 1.0]);
    assert_eq!(told(STANDING, STANDING), [0.0, 1.0, 2.0]);
}

/// The greatest and the least sum of the lengths of two struts from one node, whose other ends are fixed, at many moments:
/// each is least at another time, so that the sum of the least lengths says too little.
#[test]
fn sums_of_lengths_are_those_of_many_moments() {
    let mut number = dice(5);
    for round in 0..30 {
        let mut place = || -> Place { std::array::from_fn(|_| number(-1.0, 1.0)) };
        let (a, b, from, to) = (place(), place(), place(), place());
        let sum = |part: f64| {
            let x = between(from, to, part);
            norm(minus(x, a)) + norm(minus(x, b))
        };
        let sums: Vec<f64> = (0..=20_000).map(|k| sum(f64::from(k) / 20_000.0)).collect();
        let (low, high) = (
            sums.iter().copied().fold(f64::INFINITY, f64::min),
            sums.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        let plan = plan(
            FREE,
            &[(2, 0), (2, 1), (0, 1)],
            vec![straight(0.0, &[a, b, from]), straight(1.0, &[a, b, to])],
        );
        let ranged = |range: (f64, f64)| {
            let sum = LengthSum { struts: vec![0, 1], range };
            let verdict = judged(&with(plan.clone(), |paths| paths.limits.sums = vec![sum.clone()]));
            let mut found = of(CheckKind::JointRange, &verdict);
            found.retain(|failure| failure.at.len() == 2);
            found
        };
        assert_eq!(ranged((low - 1e-5, high + 1e-9)), vec![], "round {round}");
        for range in [(low + 1e-5, high + 1.0), (0.0, high - 1e-5)] {
            let [failure] = &ranged(range)[..] else { panic!("round {round}: one failure") };
            // The sum told is that of the time told.
            assert!((sum(failure.time) - failure.value).abs() < 1e-9, "round {round}: {failure:?}");
            assert!(!(range.0..=range.1).contains(&failure.value), "round {round}: {failure:?}");
        }
    }
}

/// A strut that has failed keeps its length while others move.
#[test]
fn a_length_that_stays_may_be_both_ends_of_its_range() {
    let from = tetra([0.5, 0.3, 0.8]);
    let mut to = from.clone();
    // The first two nodes go aside together, the others as they like.
    to[0] = [0.25, 0.5, 0.0];
    to[1] = [1.25, 0.5, 0.0];
    to[3][2] = 0.9;
    let plan = plan(FREE, &TETRA, vec![straight(0.0, &from), straight(1.0, &to)]);
    let kept = |length: f64| {
        let sum = LengthSum { struts: vec![0], range: (length, length) };
        let verdict = judged(&with(plan.clone(), |paths| paths.limits.sums = vec![sum.clone()]));
        of(CheckKind::JointRange, &verdict).len()
    };
    assert_eq!(kept(1.0), 0);
    assert_eq!((kept(1.0 - 1e-8), kept(1.0 + 1e-8)), (1, 1));
}

/// A node slides along a tube that is bent by a micrometre: the sum of the lengths on both sides is hardly more than its
/// limit all the way, which intervals can prove only after very many. What is told is the sum at some moment.
#[test]
fn a_sum_that_stays_at_its_limit_is_told_as_not_proved() {
    let ends = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let (from, to) = ([-0.5, 1e-3, 0.0], [0.6, 2e-3, 0.0]);
    let sum = |part: f64| {
        let x = between(from, to, part);
        norm(minus(x, ends[0])) + norm(minus(x, ends[1]))
    };
    let nodes = |x: Place| [ends[0], ends[1], x];
    let struts = [(2, 0), (2, 1), (0, 1)];
    let plan = plan(FREE, &struts, vec![straight(0.0, &nodes(from)), straight(1.0, &nodes(to))]);
    let low = (0..=1000).map(|k| sum(f64::from(k) / 1000.0)).fold(f64::INFINITY, f64::min);
    let limit = LengthSum { struts: vec![0, 1], range: (low - 2e-9, 10.0) };
    let verdict = judged(&with(plan, |paths| paths.limits.sums = vec![limit.clone()]));
    let [failure] = &of(CheckKind::JointRange, &verdict)[..] else { panic!("one: {:?}", verdict.failures) };
    assert!(failure.message.contains("not proved"), "{failure:?}");
    assert!((sum(failure.time) - failure.value).abs() < 1e-12, "{failure:?}");
}

/// Two nodes that stay in one place with a strut of no length between them: nothing accelerates there.
#[test]
fn a_strut_of_no_length_that_stays_does_not_accelerate() {
    let nodes = |x: f64| [[0.0; 3], [0.0; 3], [x, 0.0, 0.0]];
    let plan =
        plan(FREE, &[(0, 1), (1, 2)], vec![straight(0.0, &nodes(1.0)), ramped(2.0, (1.0, 1.0), &nodes(2.0))]);
    let verdict = judged(&of_strut(plan, |strut| strut.acceleration = Some(1.0)));
    assert_eq!(of(CheckKind::Acceleration, &verdict), vec![]);
}

/// Whoever asks for progress at every report hears of every step; whoever cancels gets no verdict.
#[test]
fn the_judge_tells_its_progress_and_ends_when_it_is_cancelled() {
    let keyframes = (0..4).map(|k| straight(f64::from(k), &tetra([0.5, 0.3, 0.8]))).collect();
    let plan = plan(FREE, &TETRA, keyframes);
    let (token, heard) = (CancelState::default(), Rc::new(RefCell::new(Vec::new())));
    let (asks, hears) = (token.clone(), heard.clone());
    token.request_progress();
    let report = move |line| {
        hears.borrow_mut().push(line);
        asks.request_progress();
    };
    assert!(interrupt::catch(&token, report, || verify::verify(&plan)).is_ok());
    assert_eq!(*heard.borrow(), ["step 1 of 3", "step 2 of 3", "step 3 of 3"]);
    token.cancel();
    let ended = interrupt::catch(&token, |_| {}, || verify::verify(&plan)).err();
    assert_eq!(ended, Some(interrupt::Ended::Cancelled));
}
