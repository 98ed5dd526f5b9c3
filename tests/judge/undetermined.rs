//! Travel that friction or servos do not determine: wheels that pull against skids with nearly as much friction.

use crate::support::desk::{self, stated};

/// Returns the messages about a cart whose wheels turn by 4 rad in 10 s: two of 50 mm radius at x = 100 mm, and as many at
/// -100 mm if there are `four`; with two skids, `skid` the place of each along x and its height above the ground (mm), each
/// on a knee with a lever of 100 mm and a servo of this stiffness (N·m/rad).
fn messages(four: bool, skid: [f64; 2], stiffness: f64, allows: &str) -> Vec<String> {
    said(four, skid, stiffness, &format!("behavior go{allows} = turning()"))
}

/// Returns the messages about such a cart with the behaviours `behaviours`, of which `go` is planned.
fn said(four: bool, skid: [f64; 2], stiffness: f64, behaviours: &str) -> Vec<String> {
    let [x, height] = skid;
    let mut links = "link body = box(100mm, 100mm, 40mm, mass: 2kg) at [0mm, 0mm, 80mm]\n".to_owned();
    let mut moves = Vec::new();
    let wheels = [(100.0, 80.0), (100.0, -80.0), (-100.0, 80.0), (-100.0, -80.0)];
    for (i, (x, y)) in wheels.iter().take(if four { 4 } else { 2 }).enumerate() {
        links += &format!(
            "link w{i} = cylinder(radius: 50mm, length: 20mm, axis: Y, mass: 50g, friction: 1) at [{x}mm, {y}mm, 50mm]
             joint t{i} : body -> w{i} = revolute(axis: Y) at [{x}mm, {y}mm, 50mm]\n"
        );
        moves.push(format!("move(m.t{i}, by: 4rad, in: 10s)"));
    }
    for (i, y) in [60.0, -60.0].iter().enumerate() {
        links += &format!(
            "link s{i} = sphere(15mm, mass: 50g, friction: 1) at [{x}mm, {y}mm, {}mm]
             joint k{i} : body -> s{i} = revolute(axis: Y, stiffness: {stiffness}N*m/rad) at [{}mm, {y}mm, {}mm]\n",
            15.0 + height,
            x + 100.0,
            15.0 + height
        );
    }
    let program = format!(
        "module M {{\n{links}}}
         config C {{ part m: M  behavior turning = Pc({})  {behaviours} }}
         let cart = C()
         emit(plan(cart.go(), world: world(dynamics: full)), \"p.json\")
",
        moves.join(", ")
    );
    desk::messages(&program)
}

/// Returns the distances in the message about undetermined travel, mm.
fn distances(message: &str) -> [f64; 2] {
    [stated(message, "not determined:", "mm"), stated(message, "but", "mm elsewhere")]
}

#[test]
fn wheels_that_hardly_win_against_skids_do_not_determine_the_travel() {
    // The wheels bear 52 % of the weight, and pull the cart on. Had what slides more friction, the skids would hold it.
    let found = messages(false, [-108.0, 0.0], 1000.0, "");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("if contacts that slide had 1.25 times the friction and the others 0.8 times"),
        "{found:?}"
    );
    assert!(found[0].contains("at t = 0ms"), "the whole plan is meant: {found:?}");
    let [length, away] = distances(&found[0]);
    // Friction is viscous below 1 mm/s, so that who wins still creeps, by s of s / sqrt(s² + 1) = the ratio of both, mm/s.
    let creep = |ratio: f64| 10.0 * ratio / libm::sqrt(1.0 - ratio * ratio);
    let expected = 200.0 - creep(0.4825 / 0.5175);
    assert!((length - expected).abs() < 5.0, "{length} of {expected}");
    // Under the variation the skids would win for good; from step to step it changes speed only as its friction allows.
    let most = expected - creep(0.8 * 0.5175 / (1.25 * 0.4825));
    assert!(away > 0.5 * length && away < most + 5.0, "{away} of {most}");
    // Where the wheels bear three quarters, they win whatever the friction.
    let found = messages(false, [-300.0, 0.0], 1000.0, "");
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn undetermined_travel_may_be_allowed_to_the_end_of_a_plan() {
    // What is allowed is no failure, and the permission is needed.
    let found = messages(false, [-108.0, 0.0], 1000.0, " allows traction");
    assert!(found.is_empty(), "{found:?}");
    // Where the wheels win whatever the friction, it is idle.
    let found = messages(false, [-300.0, 0.0], 1000.0, " allows traction");
    assert!(found.iter().any(|m| m.contains("traction")), "{found:?}");
}

#[test]
fn skids_that_stiff_servos_press_down_do_not_determine_the_travel() {
    // Skids 1 mm lower than the wheels: 2 servos of 75 N*m/rad press with 15 N of some 22, with 0.4 times the stiffness 6 N.
    let found = messages(true, [0.0, -1.0], 75.0, "");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("elsewhere if servos were 0.4 times as stiff"), "{found:?}");
    let [length, away] = distances(&found[0]);
    assert!(length < 20.0 && (away - 180.0).abs() < 30.0, "{length} and {away}");
    // Skids that press with 6 N let the wheels win; 3.3 times the stiffness would press them down.
    let found = messages(true, [0.0, -1.0], 30.0, "");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("elsewhere if servos were 3.3 times as stiff"), "{found:?}");
    let [length, away] = distances(&found[0]);
    assert!((length - 190.0).abs() < 20.0 && (away - length).abs() < 20.0, "{length} and {away}");
}

#[test]
fn each_of_several_permissions_for_undetermined_travel_is_needed() {
    let behaviours = "
  behavior first allows traction = turning()
  behavior second allows traction = turning()
  behavior go = Sc(first(), second())";
    let found = said(false, [-108.0, 0.0], 1000.0, behaviours);
    assert!(found.is_empty(), "{found:?}");
}
