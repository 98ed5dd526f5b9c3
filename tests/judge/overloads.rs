//! The words about overloads under full dynamics, in closed form: a ball of 1 kg at the end of a weightless lever of 0.5 m, on a
//! base that is held.

use crate::support::desk::{self, run, stated};
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// The torque of the ball's weight on a level lever, N·m.
const LEVEL: f64 = 9.80665 * 0.5;

/// Returns the messages about an arm whose motor has these limits, as it
/// moves from one angle to another in 8 s; `side`: 1 for a lever along +x, -1 along -x.
fn messages_on(ground: &str, facts: &str, side: i32, [from, to]: [&str; 2], options: &str) -> Vec<String> {
    let program = format!(
        "module Arm {{
           link base = box(800mm, 400mm, 20mm, mass: 10kg)
           link bob = sphere(radius: 20mm, mass: 1kg) at [{side} * 500mm, 0mm, 100mm]
           joint bend : base -> bob = revolute(axis: Y, {facts}) at [0mm, 0mm, 100mm]
         }}
         config C {{ part m: Arm  set m.bend = {from} }}
         let arm = C()
         emit(plan(move(arm.m.bend, to: {to}, in: 8s), world: world(ground: {ground}, dynamics: full)), \"p.json\"{options})
"
    );
    desk::messages(&program).into_iter().filter(|m| m.contains("N*m")).collect()
}

fn messages(facts: &str, side: i32, ends: [&str; 2], options: &str) -> Vec<String> {
    messages_on("held", facts, side, ends, options)
}

/// A move that is as good as none.
const LEVEL_STILL: [&str; 2] = ["0deg", "0.01deg"];

#[test]
fn a_joint_sags_by_what_its_servo_keeps_of_its_stiffness_beyond_its_limit() {
    // At its limit L a servo of 150 N*m/rad has yielded by L / 150; beyond that it keeps 0.2 N*m/rad.
    // A broad base on the ground holds the arm as a fixture does.
    for (ground, limit, side) in
        [("held", 4.89, 1), ("held", 4.89, -1), ("held", 4.87, 1), ("held", 4.87, -1), ("settle", 4.87, 1)]
    {
        let facts = format!("max_torque: {limit}N*m, stiffness: 150N*m/rad");
        let found = messages_on(ground, &facts, side, LEVEL_STILL, "");
        assert_eq!(found.len(), 1, "{found:?}");
        let sag = stated(&found[0], "with its motors at their limits, m.bend would sag by", "deg");
        let expected = (limit / 150.0 + (LEVEL - limit) / 0.2).to_degrees();
        assert!((sag - expected).abs() < 0.006 * expected, "{sag} of {expected} in {}", found[0]);
    }
    // Beyond 20 degrees linear springs say nothing.
    let found = messages("max_torque: 4.8N*m, stiffness: 150N*m/rad", 1, LEVEL_STILL, "");
    assert!(found[0].contains("it would give way"), "{found:?}");
}

#[test]
fn the_shares_of_an_overload_are_those_of_its_worst_instant() {
    // From nearly upright to level: the overload begins on the way, and is worst near the end.
    let found =
        messages("max_torque: 4N*m, range: -90deg..0deg, stiffness: 600N*m/rad", 1, ["-80deg", "0deg"], "");
    assert!(!found.is_empty());
    let most = found.iter().map(|m| stated(m, "; ", "N*m at rest")).fold(0.0, f64::max);
    assert!(most < LEVEL + 1e-3 && most > 0.99 * LEVEL, "{most} of {LEVEL} in {found:?}");
}

#[test]
fn a_move_that_is_too_fast_is_told_how_much_slower_it_would_hold() {
    // About a vertical axis nothing bears weight, so that the torque falls with the square of the time: the least time for
    // a limit follows from the torque that another took.
    let least = |limit: f64| -> f64 {
        let program = |time: f64| {
            format!(
                "module Arm {{
                   link base = box(100mm, 100mm, 20mm, mass: 10kg)
                   link bob = sphere(radius: 20mm, mass: 1kg) at [500mm, 0mm, 100mm]
                   joint turn : base -> bob = revolute(axis: Z, max_torque: {limit}N*m)
                 }}
                 let arm = Arm()
                 emit(plan(move(arm.turn, by: 1rad, in: {time}s), world: world(ground: held, dynamics: full)), \"p.json\")"
            )
        };
        let (mut low, mut high) = (0.2, 4.0);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            let (observed, ..) = run(&MapFiles::of(&program(middle)), Mode::Run);
            if observed.diagnostics.is_empty() { high = middle } else { low = middle }
        }
        let (observed, ..) = run(&MapFiles::of(&program(high / 1.55)), Mode::Run);
        let message = &observed.diagnostics[0].message;
        let slower = stated(message, "it would hold about", " times slower");
        // Rounded up to a tenth.
        assert!((slower - 1.6).abs() < 0.051, "{slower} in {message}");
        assert!(message.contains("0N*m at rest, 0N*m of it without friction"), "{message}");
        high
    };
    let (one, four) = (least(1.0), least(0.25));
    assert!((four / one - 2.0).abs() < 0.02, "four times the time for a quarter: {one} and {four}");
}

#[test]
fn a_reserve_is_told_with_what_it_leaves_of_the_limit() {
    let found = messages("max_torque: 5N*m", 1, LEVEL_STILL, ", reserve: 0.1");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("4.5N*m with a reserve of 10 %"), "{found:?}");
    assert!(!found[0].contains("slower"), "at rest nothing is gained by time: {found:?}");
    // Within its whole limit it does not sag.
    assert!(!found[0].contains("sag") && !found[0].contains("give way"), "{found:?}");
    assert!(messages("max_torque: 5N*m", 1, LEVEL_STILL, "").is_empty());
}
