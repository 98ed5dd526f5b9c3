//! The behavior room: durations against closed forms, conditions against crossing times found by
//! hand, the paper's meaning of setpoints, random programs.

use crate::support::programs::*;
use crate::support::robots::{FRONT, LEFT, RIGHT, TILT, at_rest, chain};
use modl::behavior::{Reason, Scheduled};
use modl::plan::time::TICK;
use modl::plan::{Action, CauseId, Command, ExemptionKind};
use modl::plan::{Compare, Condition, DockingKind, Node, Otherwise, Profile, Signal, Target};
use modl::robot::{Assembly, JointId, PortRef};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::Arc;

const L: u32 = LEFT as u32;
const R: u32 = RIGHT as u32;
const F: u32 = FRONT as u32;
const T: u32 = TILT as u32;
/// Greatest speed of every joint of the module, rad/s.
const V: f64 = 2.4086;

/// Durations are rounded up to the next tick, each.
fn near(found: f64, truth: f64) {
    assert!((found - truth).abs() <= 100.0 * TICK + 1e-12 * truth.abs(), "{found} should be {truth}");
}

fn done(program: Arc<Node>) -> Scheduled {
    plan(chain(3), program).expect("the program can be scheduled")
}

fn refused(program: Arc<Node>) -> Reason {
    plan(chain(3), program).expect_err("the program can't be scheduled").reason
}

fn at(s: &Scheduled, joint: u32, t: f64) -> f64 {
    s.tracks.state(t).joints[joint as usize]
}

/// One module whose tilt also states an acceleration limit.
fn braked(acceleration: f64) -> Assembly {
    let mut robot = chain(1);
    let mut library = (*robot.library).clone();
    for joint in &mut library.modules[0].joints {
        joint.limits.acceleration = Some(acceleration);
    }
    robot.library = Arc::new(library);
    robot
}

#[test]
fn a_smooth_move_takes_15_eighths_of_distance_by_speed() {
    let s = done(go(T, 1.0, 0));
    near(s.tracks.duration, 15.0 / 8.0 / V);
    // The peak is in the middle, and it is the limit.
    let track = s.tracks.track(JointId(T)).expect("it moves");
    near(track.velocity(s.tracks.duration / 2.0), V);
    near(at(&s, T, s.tracks.duration / 2.0), 0.5);
    assert_eq!(at(&s, T, s.tracks.duration), 1.0);
}

#[test]
fn no_motion_exceeds_speed_or_acceleration() {
    for profile in [Profile::Smooth, Profile::Trapezoid] {
        for distance in [0.01, 0.3, 1.5] {
            for a in [0.5, 3.0, 40.0] {
                let command = moving(T, Target::To(distance), None, profile);
                let s = plan(braked(a), act(command, 0)).expect("it can be scheduled");
                let track = s.tracks.track(JointId(T)).expect("it moves");
                let (d, n) = (s.tracks.duration, 4000);
                let speeds: Vec<f64> =
                    (0..=n).map(|i| track.velocity(d * f64::from(i) / f64::from(n))).collect();
                let peak = speeds.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let step = d / f64::from(n);
                let steepest = speeds.windows(2).fold(0.0_f64, |m, w| m.max((w[1] - w[0]).abs() / step));
                assert!(peak <= V * (1.0 + 1e-9), "{profile:?} {distance} {a}: speed {peak}");
                assert!(steepest <= a * (1.0 + 1e-6), "{profile:?} {distance} {a}: acceleration {steepest}");
                // And one of the two is reached: the time is the least.
                assert!(peak > V * (1.0 - 1e-5) || steepest > a * (1.0 - 1e-2), "{profile:?} {distance} {a}");
            }
        }
    }
}

#[test]
fn a_trapezoid_takes_distance_by_speed_and_one_ramp() {
    let s = plan(braked(6.0), act(moving(T, Target::To(1.5), None, Profile::Trapezoid), 0));
    near(s.expect("it can be scheduled").tracks.duration, 1.5 / V + V / 6.0);
    let s = plan(braked(1.0), act(moving(T, Target::To(1.5), None, Profile::Trapezoid), 0));
    near(s.expect("it can be scheduled").tracks.duration, 2.0 * libm::sqrt(1.5));
    // With the time given, the ramps are as short as the acceleration allows: a·r·(T-r) = distance.
    let s = plan(braked(2.0), act(moving(T, Target::To(1.5), Some(2.0), Profile::Trapezoid), 0));
    let s = s.expect("it can be scheduled");
    let ramp = s.tracks.tracks[0].segments[0].end;
    near(2.0 * ramp * (2.0 - ramp), 1.5);
}

#[test]
fn a_linear_move_takes_distance_by_speed() {
    near(done(act(moving(T, Target::To(-1.0), None, Profile::Linear), 0)).tracks.duration, 1.0 / V);
}

#[test]
fn spinning_for_a_time_ends_by_holding() {
    let s = done(series(vec![spin_for(L, 2.0, 5.0, 0), wait(1.0)]));
    assert_eq!(s.tracks.duration, 6.0);
    assert_eq!(at(&s, L, 5.5), 10.0);
    assert_eq!(at(&s, L, 2.5), 5.0);
}

#[test]
fn a_spin_lasts_until_the_next_command() {
    let s = done(series(vec![spin(L, 2.0, 0), wait(1.5), by(L, 1.0, 1)]));
    assert_eq!(at(&s, L, 1.5), 3.0);
    assert_eq!(at(&s, L, s.tracks.duration), 4.0);
    near(s.tracks.duration, 1.5 + 15.0 / 8.0 / V);
}

#[test]
fn a_plan_ends_at_rest_or_names_what_still_turns() {
    let refusal = plan(chain(1), series(vec![spin(L, 2.0, 7), wait(1.0)])).expect_err("it still turns");
    assert_eq!(refusal.cause, Some(CauseId(7)));
    assert_eq!(refusal.reason, Reason::StillTurning { joint: "m0.left".into(), speed: 2.0 });
}

#[test]
fn with_an_acceleration_limit_spins_have_ramps() {
    let a = 4.0;
    let s = plan(braked(a), spin_for(L, 2.0, 5.0, 0)).expect("it can be scheduled");
    assert_eq!(s.tracks.duration, 5.0);
    // Two ramps of v/a cost one ramp's time of travel.
    near(at(&s, L, 5.0), 2.0 * (5.0 - 2.0 / a));
    // What takes over brakes first: v/a and v²/2a, then moves from there to its target.
    let s = plan(braked(a), series(vec![spin(L, 2.0, 0), wait(2.0), by(L, 0.0, 1)]));
    let s = s.expect("it can be scheduled");
    let passed = 2.0 * (2.0 - 1.0 / a);
    near(at(&s, L, 2.0), passed);
    near(at(&s, L, 2.0 + 2.0 / a), passed + 4.0 / (2.0 * a));
    near(at(&s, L, s.tracks.duration), passed);
}

#[test]
fn a_setpoint_stays_in_force_after_its_condition_held() {
    // The move is complete for its successors at 0.4 rad, and goes on to 1 rad.
    let first =
        until(moving(T, Target::To(1.0), Some(2.0), Profile::Linear), angle(T, Compare::Greater, 0.4), 0);
    let s = done(series(vec![node(first), go_in(F, 1.0, 0.25, 1)]));
    let front = &s.tracks.track(JointId(F)).expect("it moves").segments[0];
    near(front.start, 0.8);
    assert_eq!(s.tracks.duration, 2.0, "the plan lasts until every joint is at rest");
    assert_eq!(at(&s, T, 2.0), 1.0);
    assert!(s.nominal);
}

#[test]
fn conditions_on_other_joints_are_found_where_they_cross() {
    // The front turns until the tilt, on its smooth way to 1 rad in 2 s, passes 1/2: at 1 s.
    let front = until(spinning(F, 1.0, Some(9.0)), angle(T, Compare::GreaterEqual, 0.5), 1);
    let s = done(parallel(vec![go_in(T, 1.0, 2.0, 0), node(front)]));
    near(at(&s, F, 2.0), 1.0);
    // Speeds cross, too: 1.2 s of the way by a cubic whose rate is 3t² - 2t³'s derivative 6u(1-u).
    let keyframes = vec![[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let slow = Condition::And(
        Box::new(Condition::Compare {
            signal: Signal::Speed(JointId(T)),
            compare: Compare::Less,
            value: 1.0,
        }),
        Box::new(angle(T, Compare::Greater, 0.5)),
    );
    let follow = act(Command::Follow { joint: JointId(T), keyframes }, 0);
    let s = done(parallel(vec![follow, node(until(spinning(F, 1.0, Some(9.0)), slow, 1))]));
    near(at(&s, F, 9.0), (3.0 + libm::sqrt(3.0)) / 6.0);
}

#[test]
fn a_condition_that_becomes_true_at_the_very_end_is_met() {
    let there = until(
        moving(T, Target::To(1.0), Some(1.0), Profile::Smooth),
        angle(T, Compare::GreaterEqual, 1.0),
        0,
    );
    assert_eq!(done(series(vec![node(there), wait(0.5)])).tracks.duration, 1.5);
    let beyond =
        until(moving(T, Target::To(1.0), Some(1.0), Profile::Smooth), angle(T, Compare::Greater, 1.0), 0);
    assert_eq!(refused(node(beyond)), Reason::NeverHolds);
}

#[test]
fn steady_turning_meets_its_condition_in_closed_form() {
    let turn = until(spinning(L, 2.0, None), angle(L, Compare::Greater, FRAC_PI_2), 0);
    let s = done(series(vec![node(turn), act(spinning(L, 0.0, Some(0.0)), 1)]));
    near(s.tracks.duration, FRAC_PI_4);
    let elapsed = Condition::Compare { signal: Signal::Elapsed, compare: Compare::GreaterEqual, value: 0.75 };
    let s = done(series(vec![wait(1.0), node(until(spinning(L, 2.0, Some(9.0)), elapsed, 0))]));
    near(s.tracks.duration, 1.75);
    assert!(!s.nominal, "a clock is no sensor");
}

fn timed(otherwise: Otherwise) -> Arc<Node> {
    let never =
        until(moving(T, Target::To(0.5), Some(1.0), Profile::Linear), angle(T, Compare::Greater, 2.0), 3);
    node(Action { timeout: Some(0.5), otherwise, ..never })
}

#[test]
fn a_timeout_proceeds_aborts_or_branches() {
    let s = done(series(vec![timed(Otherwise::Proceed), go_in(F, 0.1, 0.25, 1)]));
    assert_eq!(s.tracks.track(JointId(F)).expect("it moves").segments[0].start, 0.5);
    assert_eq!(at(&s, T, 1.0), 0.5, "the setpoint stays in force");
    let s = done(timed(Otherwise::Node(series(vec![wait(0.25), go_in(T, 0.0, 1.0, 1)]))));
    assert_eq!(s.tracks.duration, 1.75);
    assert_eq!(at(&s, T, 0.75), 0.375, "the branch takes over from where the joint is");
    assert_eq!(s.actions, 3);
    let refusal = plan(chain(1), timed(Otherwise::Abort("blocked".into()))).expect_err("it aborts");
    assert_eq!(refusal.cause, Some(CauseId(3)));
    assert_eq!(refusal.reason, Reason::Aborted { message: "blocked".into(), time: 0.5 });
}

#[test]
fn repetition_shares_its_body() {
    let stroke = series(vec![go_in(T, 0.5, 0.25, 0), go_in(T, -0.5, 0.25, 1)]);
    let s = done(repeat(repeat(stroke, 1000), 100));
    assert_eq!(s.actions, 200_000);
    assert_eq!(s.tracks.duration, 50_000.0);
    assert_eq!(s.tracks.tracks[0].segments.len(), 200_000);
}

#[test]
fn empty_repetition_ends_at_a_limit() {
    let empty = repeat(repeat(repeat(series(vec![]), u64::MAX), u64::MAX), u64::MAX);
    assert!(matches!(refused(empty), Reason::Limit { what: "steps", .. }));
    assert!(matches!(refused(repeat(wait(1.0), 1_000_000)), Reason::Limit { what: "seconds", .. }));
}

#[test]
fn what_is_too_deep_is_refused_and_does_not_overflow() {
    let deep = (0..5_000).fold(wait(0.0), |inner, _| series(vec![inner]));
    assert!(matches!(refused(deep), Reason::Limit { what: "nested behaviours", .. }));
}

#[test]
fn a_followed_function_begins_where_the_joint_is() {
    let keyframes = vec![[0.0, 0.2, 1.0], [0.5, 0.5, 0.0]];
    let follow = act(Command::Follow { joint: JointId(T), keyframes }, 0);
    let jump = Reason::Jump { joint: "m0.tilt".into(), at: 0.0, begins: 0.2 };
    assert_eq!(refused(follow.clone()), jump);
    let s = done(series(vec![go(T, 0.2, 0), follow]));
    assert_eq!(at(&s, T, s.tracks.duration), 0.5);
    let track = s.tracks.track(JointId(T)).expect("it moves");
    near(track.velocity(track.segments[1].start), 1.0);
}

#[test]
fn exemptions_cover_their_own_interval_wherever_they_are_composed() {
    let risky = Arc::new(Node::Exempt { body: wait(1.0), kind: ExemptionKind::Unstable, cause: CauseId(9) });
    let s = done(series(vec![wait(0.5), repeat(series(vec![risky, wait(0.25)]), 2)]));
    let spans: Vec<(f64, f64)> = s.exemptions.iter().map(|e| (e.from, e.to)).collect();
    assert_eq!(spans, [(0.5, 1.5), (1.75, 2.75)]);
}

#[test]
fn a_ring_closes_by_docking_with_the_turn_that_fits() {
    let mut ring = crate::support::robots::ring12();
    ring.closed = true;
    let bend = PI / 6.0;
    let tilts = (0..12).map(|m| go(4 * m + T, bend, m)).collect();
    let (tail, head) = (PortRef { module: 11, port: 3 }, PortRef { module: 0, port: 2 });
    // Turned by 90° against the chassis, the head's disc takes another turn of the bond.
    let turned = vec![parallel(tilts), go(F, -FRAC_PI_2, 20), act(Command::Dock { a: tail, b: head }, 30)];
    let docked = plan(ring.clone(), series(turned)).expect("the ring closes");
    assert_eq!(docked.tracks.robot.bonds.len(), 12);
    let bond = docked.tracks.robot.bonds[11];
    assert_eq!((bond.a, bond.b), (tail, head));
    let mut robot = docked.tracks.robot.clone();
    robot.closed = true;
    let end = docked.tracks.end();
    let kinematics = modl::robot::Kinematics::new(&robot, &end.bonds, 0);
    let mut poses = vec![modl::geometry::Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&end.joints, &end.base, &mut poses);
    for residual in kinematics.residuals(&robot, &end.joints, &poses) {
        assert!(residual.distance < 1e-9 && residual.angle < 1e-6, "{residual:?}");
    }
    assert_eq!(docked.tracks.events[0].kind, DockingKind::Dock);
    assert!(!docked.tracks.start.bonds[11] && end.bonds[11]);
}

#[test]
fn docking_twice_and_undocking_air_are_refused() {
    let (a, b) = (PortRef { module: 0, port: 3 }, PortRef { module: 2, port: 2 });
    let taken = Reason::PortTaken { port: "m0.bottom".into(), by: "m1.top".into() };
    assert_eq!(refused(act(Command::Dock { a, b }, 0)), taken);
    let air = PortRef { module: 0, port: 2 };
    assert_eq!(refused(act(Command::Undock { port: air }, 0)), Reason::PortFree { port: "m0.top".into() });
}

#[test]
fn equal_setpoints_in_parallel_do_not_disturb_each_other() {
    let s = done(parallel(vec![go(T, 1.0, 0), series(vec![wait(0.25), go(T, 1.0, 1)])]));
    near(s.tracks.duration, 15.0 / 8.0 / V);
    assert_eq!(s.tracks.tracks[0].segments.len(), 1);
}

fn wave() -> Arc<Node> {
    series(vec![go_in(T, 0.5, 1.0, 0), go_in(T, -0.5, 1.0, 1)])
}

fn phase(body: Arc<Node>, shift: f64) -> Arc<Node> {
    Arc::new(Node::Phase { body, shift, cause: CauseId(5) })
}

#[test]
fn a_phase_begins_its_cycle_elsewhere_and_goes_round() {
    // In its second round the wave goes from -1/2 to 1/2 and back; a quarter in it is at 0.
    let s = done(phase(wave(), 0.25));
    assert_eq!(s.tracks.duration, 2.0);
    for t in [0.0, 0.3, 0.5, 1.0, 1.4] {
        let rising = |u: f64| u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) - 0.5;
        let u = 0.5 + t;
        near(at(&s, T, t), if u <= 1.0 { rising(u) } else { -rising(u - 1.0) });
    }
    // Half round it begins at 1/2: the joint is brought there first.
    let s = done(repeat(phase(wave(), 0.5), 3));
    let lead = 15.0 / 8.0 * 0.5 / V;
    near(s.tracks.duration, lead + 6.0);
    near(at(&s, T, lead), 0.5);
    near(at(&s, T, lead + 1.0), -0.5);
    assert_eq!(s.actions, 6);
}

#[test]
fn a_phase_of_a_turning_wheel_needs_no_lead() {
    let s = done(repeat(phase(series(vec![spin_for(L, 1.0, 1.0, 0), spin_for(L, 2.0, 1.0, 0)]), 0.5), 2));
    assert_eq!(s.tracks.duration, 4.0);
    near(at(&s, L, 1.0), 2.0);
    near(at(&s, L, 2.0), 3.0);
    near(at(&s, L, 4.0), 6.0);
}

#[test]
fn a_stretch_scales_time_and_nothing_else() {
    let body = series(vec![go(T, 0.5, 0), go(T, -0.5, 1)]);
    let natural = done(body.clone());
    let s = done(Arc::new(Node::Stretch { body, duration: 3.0, cause: CauseId(5) }));
    assert_eq!(s.tracks.duration, 3.0);
    for i in 0..=10 {
        let u = f64::from(i) / 10.0;
        let (a, b) = (at(&s, T, 3.0 * u), at(&natural, T, natural.tracks.duration * u));
        assert!((a - b).abs() < 1e-9);
    }
}

#[test]
fn durations_below_the_least_are_noted_where_they_stand() {
    let s = done(series(vec![go_in(T, 1.0, 0.5, 4), wait(0.0)]));
    assert_eq!(s.issues.len(), 1);
    assert_eq!(s.issues[0].cause, CauseId(4));
    let least = 15.0 / 8.0 / V;
    assert!(done(go_in(T, 1.0, least, 4)).issues.is_empty());
}

#[test]
fn wheels_that_drive_together_do_so_over_the_same_time() {
    let s = done(parallel(vec![spin_for(L, 2.0, 5.0, 0), spin_for(R, 2.0, 5.0, 1)]));
    let ends: Vec<f64> = s.tracks.tracks.iter().map(|t| t.segments[0].end).collect();
    assert_eq!(ends, [5.0, 5.0]);
    let rest = at_rest(&s.tracks.robot);
    assert_eq!(s.tracks.state(0.0), rest);
}
