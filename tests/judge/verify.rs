//! The judge: each kind of failure has a plan that must fail and a twin that must pass.

use crate::support::motions::{self, Motion, STATICS};
use crate::support::robots::{self, FRONT, LEFT, RIGHT, TILT};
use crate::support::verdicts::status;
use modl::plan::verify::articulated::{Detail, history, instants};
use modl::plan::verify::{verify, verify_state};
use modl::plan::{
    Body, CauseId, CheckKind, DockingEvent, DockingKind, Exemption, ExemptionKind, Ground, Plan, Settings,
    Stability, Status, Tracks, Verdict, World,
};
use modl::robot::Assembly;
use std::sync::Arc;

fn judged(motion: Motion) -> Verdict {
    verify(&motion.plan(STATICS))
}

fn kinds(verdict: &Verdict) -> Vec<CheckKind> {
    verdict.failures.iter().map(|f| f.kind).collect()
}

#[track_caller]
fn passes(verdict: &Verdict) {
    assert!(verdict.ok(), "{:#?}", verdict.failures);
}

#[track_caller]
fn fails(verdict: &Verdict, kind: CheckKind) {
    assert!(kinds(verdict).contains(&kind), "{verdict:#?}");
}

/// The paper's SQUARE: four drives and four turns.
fn square() -> Motion {
    let spread = 92.7 / (2.0 * 45.3);
    let turn = std::f64::consts::FRAC_PI_2 * spread;
    let mut m = Motion::new(robots::chain(1));
    let (mut t, mut left, mut right) = (0.0, 0.0, 0.0);
    for _ in 0..4 {
        m = m.spin("m0", LEFT, 2.0, t, t + 5.0).spin("m0", RIGHT, 2.0, t, t + 5.0);
        (t, left, right) = (t + 5.0, left + 10.0 - turn, right + 10.0 + turn);
        let (l, r) = (f64::to_degrees(left), f64::to_degrees(right));
        m = m.smooth("m0", LEFT, l, t, t + 2.0).smooth("m0", RIGHT, r, t, t + 2.0);
        t += 2.0;
    }
    m
}

#[test]
fn the_square_comes_back() {
    let verdict = judged(square());
    passes(&verdict);
    let [x, y, z] = verdict.travel;
    assert!(libm::hypot(x, y) < 0.02 && z.abs() < 1e-6, "{:?}", verdict.travel);
    assert!((verdict.heading - std::f64::consts::TAU).abs() < 0.01, "{}", verdict.heading);
}

#[test]
fn joints_keep_to_their_range() {
    fails(&judged(Motion::new(robots::chain(3)).smooth("m1", TILT, 95.0, 0.0, 4.0)), CheckKind::JointRange);
    let verdict = judged(Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 4.0));
    passes(&verdict);
    assert_eq!(status(&verdict, CheckKind::JointRange), Status::Proved);
}

#[test]
fn a_peak_between_two_samples_is_seen() {
    // It passes 90° by 0.1° for a few milliseconds.
    let over = |peak: f64| {
        let m = Motion::new(robots::chain(1)).smooth("m0", TILT, 89.0, 0.0, 2.0);
        let (joint, from) = (TILT, 89f64.to_radians());
        // A quadratic over 4 ms whose middle is halfway between its ends and its middle point.
        let middle = (2.0 * peak - 89.0).to_radians();
        m.segment(joint, 3.0, 3.2, vec![from, middle, from])
    };
    fails(&judged(over(90.1)), CheckKind::JointRange);
    passes(&judged(over(89.9)));
}

#[test]
fn joints_keep_to_their_speed() {
    let spin = |rate| {
        judged(
            Motion::new(robots::chain(1)).spin("m0", LEFT, rate, 0.0, 1.0).spin("m0", RIGHT, rate, 0.0, 1.0),
        )
    };
    fails(&spin(6.0), CheckKind::Speed);
    let verdict = spin(2.0);
    passes(&verdict);
    let margin = verdict.speed_margin.expect("wheels have a greatest speed").value;
    assert!((margin - (1.0 - 2.0 / 2.4086)).abs() < 1e-12);
}

/// The fastest of a joint's pieces counts, wherever it stands.
#[test]
fn a_joint_is_as_fast_as_its_fastest_piece() {
    let spins = |rates: [f64; 3]| {
        let turn = |m: Motion, (i, rate): (usize, f64)| {
            m.spin("m0", LEFT, rate, i as f64, i as f64 + 1.0).spin(
                "m0",
                RIGHT,
                rate,
                i as f64,
                i as f64 + 1.0,
            )
        };
        judged(rates.into_iter().enumerate().fold(Motion::new(robots::chain(1)), turn))
    };
    for rates in [[2.0, 1.0, 1.5], [1.0, 2.0, 1.5], [1.0, 1.5, 2.0]] {
        let verdict = spins(rates);
        passes(&verdict);
        let margin = verdict.speed_margin.expect("wheels have a greatest speed").value;
        assert!((margin - (1.0 - 2.0 / 2.4086)).abs() < 1e-12, "{rates:?}: {margin}");
        fails(&spins(rates.map(|rate| 1.5 * rate)), CheckKind::Speed);
    }
}

/// Joints that stop at once where no acceleration is limited are counted in words.
#[test]
fn joints_that_stop_at_once_are_told_and_counted() {
    let words = |wheels: &[usize]| {
        let turn = |m: Motion, wheel: &usize| m.spin("m0", *wheel, 2.0, 0.0, 1.0);
        let verdict = judged(wheels.iter().fold(Motion::new(robots::chain(1)), turn));
        match status(&verdict, CheckKind::Rest) {
            Status::NotChecked(words) => words,
            other => panic!("{other:?}"),
        }
    };
    let rest = "and no greatest acceleration is stated";
    assert_eq!(words(&[LEFT]), format!("m0.left stops at once from 2rad/s at the end, {rest}"));
    assert!(words(&[LEFT, RIGHT]).ends_with(&format!("from 2rad/s at the end (and 1 more), {rest}")));
    // Those that stop on the way are not of the same kind.
    let m = Motion::new(robots::chain(2)).spin("m0", LEFT, 2.0, 0.0, 1.0);
    let m = ["m0", "m1"].iter().fold(m, |m, module| m.spin(module, RIGHT, 2.0, 0.0, 0.5));
    let Status::NotChecked(found) = status(&judged(m), CheckKind::Rest) else { panic!("it stops at once") };
    assert_eq!(found, format!("m0.left stops at once from 2rad/s at the end, {rest}"));
}

/// Without ground nothing is touched, and the history says so.
#[test]
fn the_history_of_what_floats_has_no_contacts() {
    let plan = Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 1.0).plan(World::FREE);
    let moments = history(&plan, 1.0);
    assert!(moments.len() > 10);
    assert!(moments.iter().all(|m| m.contacts.is_empty() && m.support.is_empty() && m.margin.is_none()));
}

/// Nothing tips over that has no weight, and no joint bears any.
#[test]
fn the_history_of_what_weighs_nothing_has_neither_margins_nor_loads() {
    let plan = |gravity: f64| {
        let world = World { gravity, ..STATICS };
        Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 1.0).plan(world)
    };
    let moments = |gravity: f64| history(&plan(gravity), 1.0);
    assert!(moments(0.0).iter().all(|m| m.margin.is_none() && m.loads.is_empty()));
    assert!(moments(1.0).iter().all(|m| m.margin.is_some()));
    assert!(moments(1.0).iter().any(|m| !m.loads.is_empty()));
    let margin = |gravity: f64| instants(&plan(gravity), &[0.5], Detail::Loads, None)[0].margin;
    assert!(margin(0.0).is_none() && margin(1.0).is_some());
}

/// Loads take longer than poses, and a history has them at every eighth of its moments.
#[test]
fn the_history_has_loads_at_every_eighth_moment() {
    let plan = Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 1.0).plan(STATICS);
    let moments = history(&plan, 1.0);
    let loaded: Vec<usize> = (0..moments.len()).filter(|i| !moments[*i].loads.is_empty()).collect();
    assert!(loaded.len() > 5 && loaded.iter().all(|i| i % 8 == 0), "{loaded:?}");
}

fn dig(arm: usize) -> Plan {
    let m = Motion::new(robots::backhoe(arm)).set("a0", TILT, 90.0);
    m.linear("a1", TILT, -90.0, 0.0, 2.0).plan(STATICS)
}

#[test]
fn a_backhoe_falls_over_its_nose() {
    let verdict = verify(&dig(8));
    fails(&verdict, CheckKind::Stability);
    let fall = verdict.failures.iter().find(|f| f.kind == CheckKind::Stability).expect("it falls");
    assert!((fall.time - 0.9207).abs() < 5e-4, "{fall:?}");
    let stability = |verdict: &Verdict| kinds(verdict).contains(&CheckKind::Stability);
    assert!(!stability(&verify(&dig(4))));
}

fn ratio(verdict: &Verdict) -> f64 {
    1.0 - verdict.torque_margin.as_ref().expect("joints have limits").value
}

fn at_rest(robot: Assembly) -> Verdict {
    verify_state(&robot, &robots::at_rest(&robot), &STATICS, &Settings::default())
}

/// What the joint of `a1` has to hold with so many modules and its own block beyond it, level.
fn held_out(modules: usize) -> f64 {
    let m = Motion::new(hold_nothing(robots::backhoe(modules + 2))).set("a0", TILT, 90.0);
    let verdict = judged(m.set("a1", TILT, -90.0));
    let own = |f: &&modl::plan::Failure| f.at == ["a1.tilt"];
    verdict.failures.iter().find(own).map_or(f64::NAN, |f| f.value)
}

/// The same robot, its bonds without limits.
fn hold_nothing(mut robot: Assembly) -> Assembly {
    let mut library = (*robot.library).clone();
    library.connectors[0].holds_force = None;
    library.connectors[0].holds_moment = None;
    robot.library = Arc::new(library);
    robot
}

const MASS: f64 = 0.5572924;
const G: f64 = 9.80665;

#[test]
fn a_joint_holds_modules_out_by_their_lever() {
    // m g p n(n+1)/2; the centres of mass lie a little further out; and there is the own block and disc.
    let own = 0.309551 * 0.0082 + 0.045716 * 0.0437;
    for n in [3.0, 4.0] {
        let further = n * (own - 0.127498 * 0.0307);
        let expected = G * (MASS * 0.1 * n * (n + 1.0) / 2.0 + further + own);
        let held = held_out(n as usize);
        assert!((held - expected).abs() < 1e-4, "{held} {expected}");
    }
}

#[test]
fn loads_of_designs() {
    assert!(ratio(&at_rest(robots::chain(3))) < 0.12);
    assert!(ratio(&at_rest(robots::snake(6))) < 0.22);
    assert!((ratio(&at_rest(robots::car())) - 0.02).abs() < 0.005);
    let stowed = judged(Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0));
    assert!((ratio(&stowed) - 0.92).abs() < 0.005, "{}", ratio(&stowed));
}

const LEGS: [&str; 4] = ["fl", "fr", "bl", "br"];

fn standing(robot: Assembly) -> Motion {
    LEGS.iter().fold(Motion::new(robot), |m, leg| m.set(&format!("{leg}_hip"), TILT, -90.0))
}

fn on_two_legs(robot: Assembly) -> Motion {
    ["fl", "br"].iter().fold(standing(robot), |m, leg| {
        m.set(&format!("{leg}_knee"), TILT, 30.0).set(&format!("{leg}_ankle"), TILT, -30.0)
    })
}

#[test]
fn two_diagonal_legs_carry_a_walker_only_with_friction() {
    let verdict = judged(on_two_legs(hold_nothing(robots::walk4())));
    passes(&verdict);
    assert!((ratio(&verdict) - 0.95).abs() < 0.005, "{}", ratio(&verdict));
    assert!(verdict.notes.iter().any(|n| n.contains("needs friction: 1.90")), "{:?}", verdict.notes);
    let icy = World { friction: 0.0, ..STATICS };
    let slippery = verify(&on_two_legs(hold_nothing(robots::walk4())).plan(icy));
    fails(&slippery, CheckKind::Torque);
    // That no forces do is proved by the multipliers.
    assert!(slippery.notes.iter().all(|n| !n.contains("not proved")), "{:?}", slippery.notes);
}

#[test]
fn bonds_hold_what_they_hold() {
    let verdict = judged(on_two_legs(robots::walk4()));
    fails(&verdict, CheckKind::BondLoad);
    passes(&judged(standing(robots::walk4())));
}

/// What excuses motors excuses no bond.
#[test]
fn an_overload_that_is_excused_is_one_of_joints() {
    let lifted = ["fl", "br"].iter().fold(standing(robots::walk4()), |m, leg| {
        let (knee, ankle) = (format!("{leg}_knee"), format!("{leg}_ankle"));
        let m = m.smooth(&knee, TILT, 30.0, 0.0, 1.0).smooth(&ankle, TILT, -30.0, 0.0, 1.0);
        m.smooth(&knee, TILT, 0.0, 1.0, 2.0).smooth(&ankle, TILT, 0.0, 1.0, 2.0)
    });
    let mut plan = lifted.plan(STATICS);
    let kind = ExemptionKind::Overload(None);
    plan.exemptions = vec![Exemption { from: 0.0, to: 1.9, kind, cause: CauseId(0) }];
    let verdict = verify(&plan);
    fails(&verdict, CheckKind::BondLoad);
    assert!(!kinds(&verdict).contains(&CheckKind::Torque), "{:#?}", verdict.failures);
}

/// An overload is excused as an overload until the end, and by what is for another check not at all.
#[test]
fn an_overload_is_excused_by_its_own_kind_alone() {
    let begins = |kind| {
        let verdict = excused(6, kind, 0.0, 2.0);
        verdict.failures.iter().find(|f| f.at == ["a1.tilt"]).expect("it is too heavy").time
    };
    assert_eq!(begins(ExemptionKind::Overload(None)), 2.0);
    for kind in [ExemptionKind::Acceleration, ExemptionKind::Traction, ExemptionKind::Unstable] {
        assert!(begins(kind.clone()) < 1.9, "{kind:?}");
    }
}

/// A start that can't be held is the fault of the lines that set the joints of who can't.
#[test]
fn a_start_that_does_not_hold_is_blamed_on_the_lines_that_set_it() {
    let robot = hold_nothing(robots::backhoe(8));
    let m = Motion::new(robot).set("a0", TILT, 90.0).set("a1", TILT, -90.0);
    let ids = ["a1", "a7"].map(|module| modl::robot::JointId(m.joint(module, TILT) as u32));
    let mut plan = m.plan(World { ground: Ground::Held, ..STATICS });
    plan.causes = (0..2).map(motions::cause).collect();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("a plan of modules") };
    tracks.start_causes = vec![(ids[0], CauseId(0)), (ids[1], CauseId(1))];
    let verdict = verify(&plan);
    let overload = verdict.failures.iter().find(|f| f.at == ["a1.tilt"]).expect("it is too heavy");
    assert!(overload.blames_start && overload.blame == [CauseId(0)], "{overload:?}");
}

/// Values that are nothing but rounding are told as zero.
#[test]
fn rounding_is_no_travel() {
    let there = Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 1.0);
    for motion in [there.there_and_back(), square()] {
        let verdict = judged(motion);
        let values = verdict.worst_values().map(|(_, worst)| worst.value);
        let all: Vec<f64> = values.chain(verdict.travel).chain([verdict.heading]).collect();
        assert!(all.iter().all(|value| *value == 0.0 || value.abs() >= 1e-9), "{all:?}");
        assert!(all.contains(&0.0), "{all:?}");
    }
}

#[test]
fn a_heavy_arm_is_blamed_on_who_lifts_it_out() {
    let plan = dig(6);
    let verdict = verify(&plan);
    fails(&verdict, CheckKind::Torque);
    let overload = verdict.failures.iter().find(|f| f.at == ["a1.tilt"]).expect("the joint that digs");
    assert_eq!(overload.blame, [CauseId(0)]);
    assert!(!overload.blames_start);
    // The same arm that starts level is the fault of the start pose.
    let m = Motion::new(robots::backhoe(6)).set("a0", TILT, 90.0).set("a1", TILT, -90.0);
    let verdict = judged(m);
    assert!(verdict.failures.iter().all(|f| f.blames_start));
}

#[test]
fn a_fall_is_blamed_on_the_joint_that_leaned_out() {
    let mut m = Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0).linear("a1", TILT, -90.0, 0.0, 2.0);
    // Something else that moves meanwhile, and has nothing to do with it.
    m = m.linear("a7", FRONT, 45.0, 0.5, 1.5);
    let verdict = judged(m);
    let fall = verdict.failures.iter().find(|f| f.kind == CheckKind::Stability).expect("it falls");
    assert_eq!(fall.blame, [CauseId(0)]);
    assert!(fall.at.contains(&"a0".to_owned()), "{:?}", fall.at);
}

/// `dig` with an exemption over a stretch.
fn excused(arm: usize, kind: ExemptionKind, from: f64, to: f64) -> Verdict {
    let mut plan = dig(arm);
    plan.exemptions.push(Exemption { kind, from, to, cause: CauseId(0) });
    verify(&plan)
}

#[test]
fn exemptions_excuse_but_not_the_end() {
    let verdict = excused(8, ExemptionKind::Unstable, 0.0, 2.0);
    assert!(!kinds(&verdict).contains(&CheckKind::Stability), "{:?}", verdict.failures);
    assert_eq!(status(&verdict, CheckKind::Stability), Status::Exempt);
    assert!(verdict.events.iter().any(|e| e.1.contains("tips over")));
    // The arm is still out at the end, and that is not excused.
    let verdict = excused(6, ExemptionKind::Overload(None), 0.0, 2.0);
    let overload = verdict.failures.iter().find(|f| f.kind == CheckKind::Torque).expect("at the end");
    assert_eq!(overload.time, 2.0);
    // One that nothing needed is told.
    let verdict = excused(2, ExemptionKind::Unstable, 0.0, 2.0);
    assert_eq!(verdict.unneeded_exemptions, [0]);
    // Another joint's overload is not excused.
    let verdict = excused(6, ExemptionKind::Overload(Some(0)), 0.0, 2.0);
    fails(&verdict, CheckKind::Torque);
}

/// A chain that throws its head over and back: how long it is without support.
#[test]
fn support_may_be_missing_for_as_long_as_is_said() {
    // The backhoe leans out beyond its edge and back.
    let lean = |unstable_for: f64| {
        let m = Motion::new(hold_nothing(robots::backhoe(8))).set("a0", TILT, 90.0);
        let m = m.linear("a1", TILT, -44.0, 0.0, 1.0).linear("a1", TILT, 0.0, 1.0, 2.0);
        let mut plan = m.plan(STATICS);
        plan.settings.unstable_for = unstable_for;
        verify(&plan)
    };
    let stability = |v: &Verdict| v.failures.iter().any(|f| f.kind == CheckKind::Stability);
    // It crosses the edge at -41.42°: 2.58 of 44 degrees before and after the turning point.
    let away = 2.0 * 2.58 / 44.0;
    assert!(stability(&lean(0.0)));
    assert!(stability(&lean(away - 0.02)));
    assert!(!stability(&lean(away + 0.03)));
}

#[test]
fn a_held_base_may_not_go_underground() {
    let fixed = World { ground: Ground::Fixed, ..STATICS };
    let down = |degrees| Motion::new(robots::chain(3)).smooth("m1", TILT, degrees, 0.0, 2.0);
    fails(&verify(&down(-30.0).plan(fixed)), CheckKind::Ground);
    assert!(!kinds(&verify(&down(30.0).plan(fixed))).contains(&CheckKind::Ground));
    let off = World { ground: Ground::Off, ..STATICS };
    let verdict = verify(&down(-30.0).plan(off));
    passes(&verdict);
    assert!(matches!(status(&verdict, CheckKind::Torque), Status::NotChecked(_)));
}

#[test]
fn stability_that_is_not_checked_says_why() {
    let why = |ground, gravity| {
        let world = World { ground, gravity, ..STATICS };
        let verdict = verify(&Motion::new(robots::chain(3)).smooth("m1", TILT, 30.0, 0.0, 2.0).plan(world));
        status(&verdict, CheckKind::Stability).to_string()
    };
    assert_eq!(why(Ground::Fixed, 0.0), "not checked: there is no gravity");
    assert_eq!(why(Ground::Off, 0.0), "not checked: there is no ground");
    assert_eq!(why(Ground::Held, STATICS.gravity), "not checked: what is held fast does not fall");
}

/// The paper's rule rejects a straight chain and takes a car.
#[test]
fn the_rule_of_centres_is_kept_by_name() {
    let settings = Settings { stability: Stability::Centres, ..Settings::default() };
    let judged = |robot: Assembly| verify_state(&robot, &robots::at_rest(&robot), &STATICS, &settings);
    let chain = judged(robots::chain(3));
    fails(&chain, CheckKind::Stability);
    assert_eq!(chain.margin.expect("a chain in a line has no room").value, 0.0);
    let car = judged(robots::car());
    passes(&car);
    assert!((car.margin.expect("a car stands").value - 0.1).abs() < 1e-9);
}

#[test]
fn loops_stay_closed() {
    let ring = || {
        let m = Motion::new(hold_nothing(robots::ring12_closed()));
        (0..12).fold(m, |m, i| m.set(&format!("r{i}"), TILT, 30.0))
    };
    assert!(!kinds(&judged(ring())).contains(&CheckKind::Closure));
    let driven = ring().smooth("r3", TILT, 20.0, 0.0, 1.0);
    let verdict = judged(driven);
    fails(&verdict, CheckKind::Closure);
    let failure = verdict.failures.iter().find(|f| f.kind == CheckKind::Closure).expect("just found");
    assert_eq!(failure.blame, [CauseId(0)]);
}

fn docked(angle: f64) -> Verdict {
    let mut m = Motion::new(hold_nothing(robots::ring12_closed()));
    m = (0..12).fold(m, |m, i| m.set(&format!("r{i}"), TILT, 30.0));
    m = m.set("r3", TILT, angle).smooth("r3", FRONT, 0.0, 0.0, 1.0);
    m.tracks.start.bonds[11] = false;
    m.tracks.events = vec![DockingEvent { time: 1.0, kind: DockingKind::Dock, bond: 11, cause: CauseId(0) }];
    judged(m)
}

#[test]
fn ports_dock_within_capture() {
    assert!(!kinds(&docked(30.0)).contains(&CheckKind::Docking));
    fails(&docked(24.0), CheckKind::Docking);
}

#[test]
fn nothing_falls_off() {
    let undock = |bond| {
        let mut m = Motion::new(hold_nothing(robots::ring12_closed()));
        m = (0..12).fold(m, |m, i| m.set(&format!("r{i}"), TILT, 30.0));
        m.tracks.events =
            vec![DockingEvent { time: 0.5, kind: DockingKind::Undock, bond, cause: CauseId(0) }];
        m.tracks.duration = 1.0;
        m.tracks.tracks = vec![];
        let mut plan = m.plan(STATICS);
        plan.causes = vec![motions::cause(0)];
        plan
    };
    assert!(!kinds(&verify(&undock(3))).contains(&CheckKind::Connectedness));
    // A robot that comes apart on the way is two; one that is two at the start is none.
    let mut apart = undock(3);
    let Body::Tracks(tracks) = &mut apart.body else { unreachable!("a plan of tracks") };
    (tracks.start.bonds[3], tracks.start.bonds[7]) = (false, false);
    tracks.events.clear();
    let verdict = verify(&apart);
    fails(&verdict, CheckKind::Connectedness);
    let apart = verdict.failures.iter().find(|f| f.kind == CheckKind::Connectedness).expect("just found");
    assert!(apart.time == 0.0 && apart.blames_start, "{apart:#?}");
}

#[test]
fn a_limit_on_samples_ends_the_judgement_with_a_refusal() {
    let mut plan = square().plan(STATICS);
    plan.settings.samples_max = 10;
    fails(&verify(&plan), CheckKind::Form);
}

/// Corrupts a good plan and wants it refused.
fn refused(corrupt: impl FnOnce(&mut Plan, &mut Tracks)) {
    let mut plan = square().plan(STATICS);
    let Body::Tracks(mut tracks) = plan.body.clone() else { unreachable!("a plan of tracks") };
    corrupt(&mut plan, &mut tracks);
    plan.body = Body::Tracks(tracks);
    let verdict = verify(&plan);
    assert!(!verdict.ok());
    fails(&verdict, CheckKind::Form);
}

#[test]
fn corrupted_plans_are_refused_as_values() {
    refused(|_, t| t.tracks[0].segments[1].start -= 1.0);
    refused(|_, t| t.tracks[0].segments[1].control[2] = f64::NAN);
    refused(|_, t| t.tracks[0].segments[0].end = f64::INFINITY);
    refused(|_, t| t.tracks[0].segments[1].control[0] += 0.1);
    refused(|_, t| t.tracks[0].segments[1].control.clear());
    refused(|_, t| t.tracks[0].joint = modl::robot::JointId(99));
    refused(|_, t| t.tracks.swap(0, 1));
    refused(|_, t| t.start.joints.truncate(1));
    refused(|_, t| t.start.base.translation.vector.x = f64::NAN);
    refused(|_, t| t.robot.base = 7);
    refused(|_, t| t.robot.modules[0].kind = 7);
    refused(|_, t| t.duration = -1.0);
    refused(|_, t| t.duration = f64::NAN);
    refused(|_, t| {
        t.events.push(DockingEvent { time: 1.0, kind: DockingKind::Dock, bond: 3, cause: CauseId(0) })
    });
    refused(|p, _| p.causes.clear());
    refused(|p, _| p.worlds.clear());
    refused(|p, _| p.worlds[0].world.gravity = f64::NAN);
    refused(|p, _| p.settings.sample = 0.0);
    refused(|p, _| p.settings.sample = f64::NAN);
    refused(|p, _| {
        let cause = CauseId(99);
        p.exemptions.push(Exemption { kind: ExemptionKind::Slip, from: 0.0, to: 1.0, cause });
    });
    refused(|p, t| {
        let mut library = (*p.library).clone();
        library.modules[0].links[0].mass = -1.0;
        p.library = Arc::new(library);
        t.robot.library = p.library.clone();
    });
}

#[test]
fn a_long_snake_is_carried_by_contact_forces_that_are_spread_as_it_needs() {
    // Spread as over elastic ground, the loads would bend the middle of three hundred modules by
    // more than the joints hold: the whole leans by the half pitch between its contacts' centre and
    // its centre of mass.
    let n = 300;
    let snake = (0..n).fold(Motion::new(hold_nothing(robots::snake(n))), |m, i| {
        m.set(&format!("s{i}"), TILT, if i % 2 == 0 { -2.0 } else { 2.0 })
    });
    let verdict = judged(snake);
    passes(&verdict);
    assert!(verdict.notes.iter().any(|n| n.contains("spread evenly")), "{:?}", verdict.notes);
    assert!(verdict.notes.iter().all(|n| !n.contains("needs friction")), "{:?}", verdict.notes);
}

#[test]
fn a_sample_of_a_large_robot_counts_as_several() {
    let judged = |ground: Ground, modules: usize| {
        let mut plan = Motion::new(robots::chain(modules))
            .linear("m0", robots::TILT, 1.0, 0.0, 1.0)
            .plan(World { ground, ..STATICS });
        plan.settings.samples_max = 150;
        verify(&plan)
    };
    let refusal = |verdict: &Verdict| {
        let form = verdict.failures.iter().find(|f| f.kind == CheckKind::Form);
        form.map(|failure| failure.message.clone())
    };
    assert_eq!(refusal(&judged(Ground::Settle, 3)), None);
    assert_eq!(refusal(&judged(Ground::Off, 60)), None);
    let refused = refusal(&judged(Ground::Settle, 60)).expect("a sample counts as several");
    assert!(refused.contains("corners and rims that can touch the ground (150 of a small one)"), "{refused}");
}
