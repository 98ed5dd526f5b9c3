//! The judge: each kind of failure has a plan that must fail and a twin that must pass.

use crate::motions::Motion;
use crate::robots::{self, LEFT, RIGHT, TILT};
use modl::plan::verify::{verify, verify_state};
use modl::plan::{CheckKind, Plan, Settings, Status, Verdict, World};

fn judged(motion: Motion) -> Verdict {
    verify(&motion.plan(World::default()))
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

fn status(verdict: &Verdict, kind: CheckKind) -> &Status {
    &verdict.checks.iter().find(|c| c.kind == kind).expect("the check was made").status
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
    assert_eq!(status(&verdict, CheckKind::JointRange), &Status::Proved);
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

fn dig(arm: usize) -> Plan {
    let m = Motion::new(robots::backhoe(arm)).set("a0", TILT, 90.0);
    m.linear("a1", TILT, -90.0, 0.0, 2.0).plan(World::default())
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

/// A chain held by its middle over the ground: how much its joints have to hold.
fn ratio(verdict: &Verdict) -> f64 {
    1.0 - verdict.torque_margin.as_ref().expect("joints have limits").value
}

#[test]
fn explore_torque() {
    for (name, robot) in [("chain3", robots::chain(3)), ("snake6", robots::snake(6)), ("car", robots::car())]
    {
        let v = verify_state(&robot, &robots::at_rest(&robot), &World::default(), &Settings::default());
        println!("A {name} {} {:?} bond {:?}", ratio(&v), v.torque_margin, v.bond_margin);
    }
    let v = verify(&Motion::new(robots::backhoe(8)).set("a0", TILT, 90.0).plan(World::default()));
    println!(
        "A backhoe {} {:?} {:?} {:?}",
        ratio(&v),
        v.torque_margin,
        v.bond_margin,
        v.failures.iter().map(|f| &f.message).collect::<Vec<_>>()
    );
    let legs = ["fl", "fr", "bl", "br"];
    let m =
        legs.iter().fold(Motion::new(robots::walk4()), |m, leg| m.set(&format!("{leg}_hip"), TILT, -90.0));
    let m = ["fl", "br"].iter().fold(m, |m, leg| {
        m.set(&format!("{leg}_knee"), TILT, 30.0).set(&format!("{leg}_ankle"), TILT, -30.0)
    });
    let v = verify(&m.plan(World::default()));
    println!(
        "A walk4 {} {:?} {:?} {:?} {:?}",
        ratio(&v),
        v.torque_margin,
        v.bond_margin,
        v.notes,
        v.failures.iter().map(|f| &f.message).collect::<Vec<_>>()
    );
    for n in 1..=4 {
        let m = Motion::new(robots::backhoe(n + 1)).set("a0", TILT, 90.0).set("a1", TILT, -90.0);
        let v = verify(&m.plan(World::default()));
        println!(
            "A out {n} {} {:?} {:?}",
            ratio(&v) * 2.3,
            v.torque_margin,
            v.failures.iter().map(|f| &f.message).collect::<Vec<_>>()
        );
    }
}
