//! Runs of behaviours: what they count, how they repeat, and what cycles take over from their bodies.

use crate::support::programs::*;
use crate::support::robots::{LEFT, TILT, at_rest, chain};
use modl::behavior::{
    Ending, Execution, IssueKind, Problem, Reason, Refusal, Scheduled, Sensors, Settings, schedule,
};
use modl::plan::{CauseId, ExemptionKind, Node, Profile, Signal, Target};
use modl::robot::Assembly;
use std::sync::Arc;

const L: u32 = LEFT as u32;
const T: u32 = TILT as u32;

fn within(program: Arc<Node>, settings: Settings) -> Result<Scheduled, Refusal> {
    let robot = chain(1);
    let start = at_rest(&robot);
    schedule(Problem { robot, start, program, start_causes: vec![], bond_causes: vec![], settings })
}

fn done(program: Arc<Node>) -> Scheduled {
    within(program, Settings::default()).expect("the program can be scheduled")
}

fn refused(program: Arc<Node>, settings: Settings) -> Reason {
    within(program, settings).expect_err("the program can't be scheduled").reason
}

fn phase(body: Arc<Node>, shift: f64) -> Arc<Node> {
    Arc::new(Node::Phase { body, shift, cause: CauseId(5) })
}

fn stretch(body: Arc<Node>, duration: f64) -> Arc<Node> {
    Arc::new(Node::Stretch { body, duration, cause: CauseId(5) })
}

/// To half a radian and back, in two seconds.
fn wave() -> Arc<Node> {
    series(vec![go_in(T, 0.5, 1.0, 0), go_in(T, 0.0, 1.0, 1)])
}

#[test]
fn limits_are_by_default_as_they_are_documented() {
    let settings = Settings::default();
    assert_eq!(
        [
            settings.actions_max,
            settings.segments_max,
            settings.steps_max,
            settings.depth_max,
            settings.cycles_max
        ],
        [5_000_000, 10_000_000, 50_000_000, 1000, 8]
    );
    assert_eq!([settings.tol_begin, settings.tol_duration], [1e-6, 1e-9]);
}

/// Nodes count wherever they are entered: a cycle runs its body twice, a stretch once, a repetition as often as it says.
#[test]
fn nodes_count_in_the_bodies_of_cycles_too() {
    let body = 3;
    for (program, steps) in [
        (wave(), body),
        (repeat(wave(), 4), 1 + 4 * body),
        (series(vec![phase(wave(), 0.25); 3]), 1 + 3 * (1 + 2 * body)),
        (series(vec![stretch(wave(), 3.0); 5]), 1 + 5 * (1 + body)),
        (phase(stretch(phase(wave(), 0.5), 4.0), 0.5), 1 + 2 * (1 + 1 + 2 * body)),
    ] {
        let settings = |steps_max: u64| Settings { steps_max, ..Settings::default() };
        assert!(within(program.clone(), settings(steps)).is_ok(), "{steps}");
        let limit = steps - 1;
        assert_eq!(refused(program, settings(limit)), Reason::Limit { what: "steps", limit });
    }
}

#[test]
fn cycles_are_in_each_other_as_deep_as_the_limit_says() {
    let nested = |depth: usize| {
        (0..depth).fold(
            wave(),
            |body, level| {
                if level % 2 == 0 { stretch(body, 3.0) } else { phase(body, 0.0) }
            },
        )
    };
    for limit in [1, 2, 3, 8] {
        let settings = Settings { cycles_max: limit, ..Settings::default() };
        assert!(within(nested(limit as usize), settings).is_ok(), "{limit}");
        let expected = Reason::Limit { what: "cycles in cycles", limit };
        assert_eq!(refused(nested(limit as usize + 1), settings), expected);
    }
}

/// A move to where the joint is takes the time that is stated, as often as it is repeated.
#[test]
fn a_repeated_move_takes_its_time_every_time() {
    for times in 1..5 {
        let s = done(repeat(go_in(T, 0.5, 2.0, 0), times));
        assert_eq!(s.tracks.duration, 2.0 * times as f64);
        assert_eq!(s.actions, times);
    }
}

/// A cycle that begins where the joint is already begins at once; elsewhere the joint is brought there first.
#[test]
fn a_cycle_begins_at_once_where_its_joint_is() {
    assert_eq!(done(phase(wave(), 0.0)).tracks.duration, 2.0);
    assert_eq!(done(series(vec![go_in(T, 0.5, 1.0, 0), phase(wave(), 0.5)])).tracks.duration, 3.0);
    assert!(done(phase(wave(), 0.5)).tracks.duration > 2.1);
}

/// Faults of a body are noted once, also if the body is a cycle's.
#[test]
fn durations_that_are_too_short_are_noted_in_cycles() {
    let quick = series(vec![go_in(T, 0.5, 0.01, 3), go_in(T, 0.0, 1.0, 1)]);
    for program in
        [phase(quick.clone(), 0.0), stretch(quick.clone(), 8.0), repeat(phase(quick.clone(), 0.0), 3), quick]
    {
        let s = done(program);
        assert_eq!(s.issues.len(), 1);
        assert_eq!(s.issues[0].cause, CauseId(3));
        let IssueKind::TooShort { given, needed, .. } = &s.issues[0].kind else { panic!("{:?}", s.issues) };
        assert!(*given == 0.01 && *needed > 0.1, "{given} {needed}");
    }
}

/// Contracts and exemptions of a body that is stretched last as long in proportion.
#[test]
fn intervals_are_stretched_with_their_behaviour() {
    let contract = |body: Arc<Node>| Arc::new(Node::Contract { body, number: 7, cause: CauseId(2) });
    let exempt =
        |body: Arc<Node>| Arc::new(Node::Exempt { body, kind: ExemptionKind::Slip, cause: CauseId(3) });
    let body = series(vec![wait(1.0), contract(exempt(go_in(T, 0.5, 2.0, 0))), wait(1.0)]);
    for (duration, scale) in [(4.0, 1.0), (8.0, 2.0), (2.0, 0.5)] {
        let s = done(series(vec![wait(0.5), stretch(body.clone(), duration), wait(0.5)]));
        assert_eq!(s.tracks.duration, duration + 1.0);
        let [contract] = s.contracts[..] else { panic!("{:?}", s.contracts) };
        assert_eq!((contract.number, contract.from, contract.to), (7, 0.5 + scale, 0.5 + 3.0 * scale));
        let [exemption] = &s.exemptions[..] else { panic!("{:?}", s.exemptions) };
        assert_eq!((exemption.from, exemption.to), (0.5 + scale, 0.5 + 3.0 * scale));
    }
}

#[test]
fn durations_are_finite_and_not_negative() {
    for duration in [-1.0, -1e-9, f64::NEG_INFINITY, f64::INFINITY, f64::NAN] {
        for (program, what) in [
            (wait(duration), "a wait"),
            (go_in(T, 0.5, duration, 0), "a duration"),
            (spin_for(L, 1.0, duration, 0), "a duration"),
            (stretch(wave(), duration), "a duration"),
        ] {
            let Reason::BadNumber { what: found, value } = refused(program, Settings::default()) else {
                panic!("{what} of {duration} is refused as a number")
            };
            assert_eq!(found, what);
            assert!(value.to_bits() == duration.to_bits(), "{value} is {duration}");
        }
    }
    for zero in [wait(0.0), spin_for(L, 1.0, 0.0, 0)] {
        assert_eq!(done(zero).tracks.duration, 0.0);
    }
}

/// A joint without a limit of speed, whose acceleration has one, comes to rest at its target, but not as soon as asked for.
#[test]
fn time_to_stop_counts_where_no_speed_is_limited() {
    let mut robot: Assembly = chain(1);
    let mut library = (*robot.library).clone();
    for joint in &mut library.modules[0].joints {
        (joint.limits.speed, joint.limits.acceleration) = (None, Some(4.0));
    }
    library.modules[0].motors.clear();
    robot.library = Arc::new(library);
    // Half a second to a speed of 2, another half at it: at 1.5; it stops at 2 half a second later.
    let stop = |duration: f64| {
        let there = act(moving(L, Target::To(2.0), Some(duration), Profile::Linear), 4);
        plan(robot.clone(), series(vec![spin(L, 2.0, 0), wait(1.0), there])).expect("it can be scheduled")
    };
    assert!(stop(0.5).issues.is_empty());
    let s = stop(0.25);
    let [issue] = &s.issues[..] else { panic!("{:?}", s.issues) };
    assert_eq!(issue.cause, CauseId(4));
    let IssueKind::TooShort { given, needed, .. } = issue.kind else { panic!("{issue:?}") };
    assert_eq!((given, needed), (0.25, 0.5));
}

/// A robot that feels nothing.
struct Numb;

impl Sensors for Numb {
    fn value(&self, _: Signal) -> f64 {
        0.0
    }

    fn touches(&self, _: &[usize], _: Option<&[usize]>) -> bool {
        false
    }
}

/// A controller commands the plan's motion, and rates that are those of the positions that it commands.
#[test]
fn commanded_rates_are_the_slopes_of_commanded_positions() {
    let program = series(vec![
        go_in(T, 0.5, 1.0, 0),
        wait(0.5),
        parallel(vec![go_in(T, -0.5, 2.0, 1), spin_for(L, 1.5, 1.0, 2)]),
        act(moving(T, Target::To(0.0), Some(1.0), Profile::Trapezoid), 3),
    ]);
    let planned = done(program.clone());
    let mut execution = Execution::new(&planned.tracks, &program);
    const STEP: f64 = 1.0 / 1024.0;
    let mut fastest: f64 = 0.0;
    for k in 0..4608 {
        let now = f64::from(k) * STEP;
        assert!(execution.advance(now, &Numb).is_empty());
        for joint in [T as usize, L as usize] {
            let (position, rate) = execution.command(joint, now);
            assert!((position - planned.tracks.state(now).joints[joint]).abs() < 1e-9, "{now}");
            // From just after this instant to just before the next.
            let near = 1e-6;
            let slope = (execution.command(joint, now + near).0 - position) / near;
            assert!((slope - rate).abs() < 1e-4, "{joint} at {now}: {rate} is not {slope}");
            fastest = fastest.max(rate.abs());
        }
    }
    assert!(fastest > 1.4, "{fastest}");
    execution.advance(4.6, &Numb);
    assert_eq!(execution.ending(), Some((&Ending::Done, 4.5)));
}
