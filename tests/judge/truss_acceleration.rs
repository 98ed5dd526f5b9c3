//! Velocity profiles of trusses: how struts speed up, what the judge says of it, and what inertia does to forces.

use super::truss_judge::{plan_in, straight};
use crate::plans::plan_operations::plan_of;
use crate::support::programs::{plan, wait};
use crate::support::robots::chain;
use modl::plan::{
    Body, CauseId, CheckKind, Exemption, ExemptionKind, Ground, Keyframe, NodePaths, Plan, Ramps, Status,
    Verdict, World, joined, reversed, sliced, verify,
};
use modl::robot::Library;
use std::sync::Arc;

type Place = [f64; 3];

/// Root of three quarters.
const HIGH: f64 = 0.866_025_403_784_438_6;
const A: Place = [0.0, 0.0, 0.0];
const B: Place = [1.0, 0.0, 0.0];
const C: Place = [0.5, HIGH, 0.0];
const TETRA: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
const STANDING: World = World { gravity: 9.80665, ground: Ground::Settle, ..World::FREE };

fn top(height: f64) -> Place {
    [0.5, HIGH / 3.0, height]
}

/// The keyframe at a time of a step with these ramps up and down.
fn ramped(time: f64, (up, down): (f64, f64), nodes: &[Place]) -> Keyframe {
    Keyframe { ramps: Ramps { up, down, ..Ramps::NONE }, ..straight(time, nodes) }
}

/// A plan whose struts accelerate by at most `acceleration` (m/s²), move at up to 10 m/s and bear `force` (N).
fn limited(world: World, keyframes: Vec<Keyframe>, acceleration: f64, force: f64) -> Plan {
    let mut plan = plan_in(world, &TETRA, keyframes);
    let mut library = Library::clone(&plan.library);
    let strut = &mut library.struts[0];
    (strut.acceleration, strut.speed, strut.force) = (Some(acceleration), 10.0, force);
    plan.library = Arc::new(library);
    plan
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    let mut kinds: Vec<CheckKind> = verdict.failures.iter().map(|failure| failure.kind).collect();
    kinds.dedup();
    kinds
}

/// The node paths of a plan.
fn paths(plan: &Plan) -> &NodePaths {
    let Body::NodePaths(paths) = &plan.body else { unreachable!("a truss's plan") };
    paths
}

/// The greatest acceleration of a strut's length by second differences, m/s².
fn greatest(paths: &NodePaths) -> f64 {
    let h = paths.duration() / 4000.0;
    let lengths = |k: usize| paths.lengths(k as f64 * h);
    let along = (1..4000).map(|k| [lengths(k - 1), lengths(k), lengths(k + 1)]);
    let of = |[a, b, c]: [Vec<f64>; 3]| {
        let each = a.iter().zip(&b).zip(&c).map(|((a, b), c)| ((a - 2.0 * b + c) / (h * h)).abs());
        each.fold(0.0, f64::max)
    };
    along.map(of).fold(0.0, f64::max)
}

/// One strut of the base twice as long in two seconds, evenly faster for one and slower for one: half of a t² is half of the
/// way in half of the time, so that the acceleration is 1 m/s², and all else moves less.
#[test]
fn a_step_from_rest_to_rest_takes_the_acceleration_of_its_ramps() {
    let far = [[0.0; 3], [2.0, 0.0, 0.0], C, top(0.8)];
    let keyframes = || vec![straight(0.0, &[A, B, C, top(0.8)]), ramped(2.0, (1.0, 1.0), &far)];
    let enough = verify::verify(&limited(World::FREE, keyframes(), 2.0, 200.0));
    assert_eq!(enough.failures, vec![]);
    let status = enough.checks.iter().find(|check| check.kind == CheckKind::Acceleration);
    assert_eq!(status.expect("checked").status, Status::Proved);
    let little = verify::verify(&limited(World::FREE, keyframes(), 0.999, 200.0));
    assert_eq!(kinds(&little), [CheckKind::Acceleration]);
    assert!(little.failures.iter().any(|failure| failure.at == ["n0 -- n1"]), "{:?}", little.failures);
    // A strut of no limit is not asked, and told.
    let verdict = verify::verify(&plan_in(World::FREE, &TETRA, vec![straight(0.0, &[A, B, C, top(0.8)])]));
    let status = verdict.checks.iter().find(|check| check.kind == CheckKind::Acceleration);
    assert_eq!(status.expect("checked").status, Status::NoLimit);
}

#[test]
fn a_speed_that_changes_at_once_is_refused_unless_it_is_excused() {
    let keyframes = || vec![straight(0.0, &[A, B, C, top(0.8)]), straight(2.0, &[A, B, C, top(0.9)])];
    let mut plan = limited(World::FREE, keyframes(), 100.0, 200.0);
    let verdict = verify::verify(&plan);
    let [start, end] = &verdict.failures[..] else { panic!("start and end: {:?}", verdict.failures) };
    assert_eq!((start.kind, start.time, end.time), (CheckKind::Acceleration, 0.0, 2.0));
    assert!(start.message.contains("changes its speed at once"), "{}", start.message);
    let kind = ExemptionKind::Acceleration;
    plan.exemptions = vec![Exemption { kind, from: 0.0, to: 2.0, cause: CauseId(0) }];
    assert_eq!(verify::verify(&plan).failures, vec![]);
    plan.exemptions[0].to = 1.0;
    assert_eq!(verify::verify(&plan).failures.len(), 1);
}

/// The judge's bound is never below what second differences of the lengths find, and at most a few times above.
#[test]
fn the_bound_on_accelerations_holds_for_random_steps() {
    let mut dice = modl::optimize::random::SplitMix64(7);
    let mut number = move |low: f64, high: f64| low + (high - low) * dice.next_f64();
    let mut tight = 0;
    for round in 0..60 {
        let mut shape = || -> Vec<Place> {
            [A, B, C, top(0.8)].iter().map(|p| p.map(|x| x + number(-0.15, 0.15))).collect()
        };
        let (from, to) = (shape(), shape());
        let (up, down) = (number(0.1, 1.0), number(0.1, 1.0));
        let end = up + down + number(0.0, 1.0);
        let keyframes = vec![straight(0.0, &from), ramped(end, (up, down), &to)];
        let passes = |limit: f64| {
            let verdict = verify::verify(&limited(World::FREE, keyframes.clone(), limit, 200.0));
            !kinds(&verdict).contains(&CheckKind::Acceleration)
        };
        let found = greatest(paths(&limited(World::FREE, keyframes.clone(), 1.0, 200.0)));
        assert!(!passes(found * 0.999), "round {round}: the limit is below what differences find");
        tight += usize::from(passes(found * 1.5));
    }
    assert!(tight > 50, "the bound is within half of the truth for {tight} of 60");
}

#[test]
fn pieces_of_a_step_move_as_the_whole_does() {
    let from = [A, B, C, top(0.8)];
    let keyframes = vec![
        straight(0.0, &from),
        ramped(3.0, (0.5, 1.5), &[A, [1.2, 0.0, 0.0], C, top(1.0)]),
        ramped(5.0, (1.0, 1.0), &[A, B, C, top(0.7)]),
    ];
    let truss = limited(World::FREE, keyframes, 10.0, 200.0);
    let base = plan_of(plan(chain(1), wait(1.0)).expect("it can be scheduled"));
    let whole = Plan { library: truss.library.clone(), body: truss.body.clone(), program: None, ..base };
    let near = |a: &[Place], b: &[Place]| {
        a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    // Ends in ramps, between them, and in both steps.
    for (from, to) in [(0.25, 0.4), (0.1, 2.9), (1.0, 1.25), (0.75, 2.0), (2.0, 4.5), (2.5, 2.75), (0.0, 5.0)]
    {
        let piece = sliced(&whole, from, to).expect("a piece");
        for k in 0..=20 {
            let t = (to - from) * f64::from(k) / 20.0;
            assert!(near(&paths(&piece).state(t), &paths(&whole).state(from + t)), "{from}..{to} at {t}");
        }
        let back = reversed(&piece);
        for k in 0..=20 {
            let t = (to - from) * f64::from(k) / 20.0;
            assert!(
                near(&paths(&back).state(to - from - t), &paths(&piece).state(t)),
                "{from}..{to} back at {t}"
            );
        }
        // A piece begins in motion, unless it begins where the truss is at rest.
        let rests = |t: f64| [0.0, 3.0, 5.0].contains(&t);
        let verdict = verify::verify(&piece);
        assert_eq!(
            kinds(&verdict).contains(&CheckKind::Acceleration),
            !(rests(from) && rests(to)),
            "{from}..{to}: {:?}",
            verdict.failures
        );
    }
    let (a, b) = (sliced(&whole, 0.0, 1.25).expect("a part"), sliced(&whole, 1.25, 5.0).expect("a part"));
    assert_eq!(verify::verify(&joined(&a, &b).expect("they fit")).failures, vec![]);
}

/// A tripod whose top rises by a in the first half: its legs carry the top's half struts as if gravity were g + a. It is
/// slower when it brakes, where they carry g - a.
#[test]
fn what_accelerates_weighs_more() {
    let lift = 0.2;
    let mass = 1.5;
    let leg = |height: f64, acceleration: f64| {
        mass * (9.80665 + acceleration) / 3.0 * libm::sqrt(height * height + 1.0 / 3.0) / height
    };
    for seconds in [0.5, 1.0, 5.0] {
        let acceleration = 4.0 * lift / (seconds * seconds);
        let half = seconds / 2.0;
        let nodes = |height: f64| [A, B, C, top(height)];
        let up = vec![straight(0.0, &nodes(0.8)), ramped(seconds, (half, half), &nodes(0.8 + lift))];
        let verdict = verify::verify(&limited(STANDING, up.clone(), 100.0, 200.0));
        assert_eq!(verdict.failures, vec![]);
        let most = leg(0.8, acceleration);
        let margin = verdict.force_margin.expect("told").value;
        assert!((margin - (1.0 - most / 200.0)).abs() < 1e-4, "in {seconds} s: {margin}");
        // Struts that bear the weight, and not this.
        let force = (leg(0.8, 0.0) + most) / 2.0;
        assert_eq!(kinds(&verify::verify(&limited(STANDING, up, 100.0, force))), [CheckKind::StrutLoad]);
    }
}

#[test]
fn ramps_that_no_step_has_are_refused() {
    let step = |ramps: Ramps, time: f64| {
        let second = Keyframe { ramps, ..straight(time, &[A, B, C, top(0.9)]) };
        let plan = limited(World::FREE, vec![straight(0.0, &[A, B, C, top(0.8)]), second], 1.0, 200.0);
        modl::plan::validation::check(&plan).map_err(|fault| fault.to_string())
    };
    let ramps = |up: f64, down: f64, before: f64, after: f64| Ramps { up, down, before, after };
    assert_eq!(step(ramps(1.0, 1.0, 0.0, 0.0), 2.0), Ok(()));
    assert_eq!(step(ramps(1.0, 1.5, 0.3, 0.2), 2.0), Ok(()));
    for (what, ramps) in [
        ("they overlap", ramps(1.5, 1.0, 0.0, 0.0)),
        ("a negative one", ramps(-1.0, 1.0, 0.0, 0.0)),
        ("more is over than there is", ramps(0.5, 0.5, 0.6, 0.0)),
        ("more is left than there is", ramps(0.5, 0.0, 0.0, 0.1)),
        ("not a number", ramps(f64::NAN, 1.0, 0.0, 0.0)),
        ("infinite", ramps(1.0, f64::INFINITY, 0.0, 0.0)),
    ] {
        assert!(step(ramps, 2.0).is_err(), "{what}");
    }
    let short = step(Ramps::NONE, 1e-300).expect_err("too short to be cut");
    assert!(short.contains("lasts less than"), "{short}");
}
