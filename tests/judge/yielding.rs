//! Motors at their limits, joints that move several links at once, and bodies that float or stand on a narrow foot: forces and
//! travel of full dynamics in closed form.

use crate::simulate::fixtures::GRAVITY;
use crate::support::desk::{messages, run_clean, stated};
use modl::plan::verify::articulated::{Detail, base_at, instants};
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Plan};

#[test]
fn a_rotor_that_turns_on_a_body_that_floats_bears_the_reduced_inertia() {
    // Both turn against each other about their common centre, which lies on the axle: the motor feels I J / (I + J).
    let plan = run_clean(
        "module Turner {
           link body = box(200mm, 200mm, 50mm, mass: 4kg)
           link rotor = box(100mm, 100mm, 50mm, mass: 1kg) at [0mm, 0mm, 50mm]
           joint spin : body -> rotor = revolute(axis: Z) at [0mm, 0mm, 50mm]
         }
         let turner = Turner()
         emit(plan(move(turner.spin, by: 1rad, in: 1s), world: world(gravity: off, ground: off, dynamics: full)), \"p.json\")
",
    )
    .plan("p.json");
    let [body, rotor] = [(4.0, 0.2), (1.0, 0.1)].map(|(m, a)| m * 2.0 * a * a / 12.0);
    let track = &plan.body.tracks().expect("a turner").tracks[0];
    for time in [0.2, 0.3, 0.7, 0.8] {
        let acceleration = (track.velocity(time + 0.025) - track.velocity(time - 0.025)) / 0.05;
        let expected = acceleration * body * rotor / (body + rotor);
        let effort = instants(&plan, &[time], Detail::Loads, None)[0].efforts[0].expect("known");
        assert!(
            (effort - expected).abs() < 0.02 * expected.abs() && expected.abs() > 1e-3,
            "{time}: {effort} of {expected}"
        );
    }
}

#[test]
fn a_box_on_a_narrow_foot_creeps_down_a_slope_by_its_viscous_friction_alone() {
    // Friction is viscous below 1 mm/s: a slip of s carries s / sqrt(s² + 1) of the friction of 1, here the tangent of the
    // slope. The moment of friction about the centre of mass, 50 mm above, tilts nothing, whatever the foot's length.
    for (along, across) in [("[1, 0, 0]", [10, 200]), ("[0, 1, 0]", [200, 10])] {
        let [x, y] = across;
        let plan = run_clean(&format!(
            "module Tower {{
               link body = box({x}mm, {y}mm, 100mm, mass: 2kg, friction: 1)
               link arm = sphere(radius: 5mm, mass: 1g) at [0mm, 0mm, 60mm]
               joint turn : body -> arm = revolute(axis: Z) at [0mm, 0mm, 60mm]
             }}
             let tower = Tower()
             emit(plan(move(tower.turn, by: 1rad, in: 10s), world: world(terrain: slope(4deg, along: {along}), dynamics: full)), \"p.json\")
"
        ))
        .plan("p.json");
        let at = |t: f64| base_at(&plan, t).expect("it stands").translation.vector;
        let tangent = libm::tan(4_f64.to_radians());
        let expected = 1e-2 * tangent / libm::sqrt(1.0 - tangent * tangent);
        let crept = (at(10.0) - at(0.0)).norm();
        assert!((crept - expected).abs() < 0.05 * expected, "{crept} of {expected} along {along}");
    }
}

/// Returns the messages about two arms on a broad base: one beyond its limit, and one with a hand 2 mm above the ground, which
/// it does not reach; `hand`: the limit of that one, N·m.
fn hanging(hand: f64) -> Vec<String> {
    messages(&format!(
        "module Arms {{
           link base = box(400mm, 400mm, 20mm, mass: 20kg) at [0mm, 0mm, 10mm]
           link bob = sphere(radius: 20mm, mass: 1kg) at [500mm, 0mm, 100mm]
           link hand = sphere(radius: 10mm, mass: 500g) at [-350mm, 0mm, 12mm]
           joint bend : base -> bob = revolute(axis: Y, max_torque: 4.87N*m, stiffness: 150N*m/rad) at [0mm, 0mm, 100mm]
           joint wrist : base -> hand = revolute(axis: Y, max_torque: {hand}N*m, stiffness: 150N*m/rad) at [-250mm, 0mm, 12mm]
         }}
         let arms = Arms()
         emit(plan(move(arms.bend, to: 0.01deg, in: 8s), world: world(ground: settle, dynamics: full)), \"p.json\")
"
    ))
}

#[test]
fn a_motor_within_its_limit_does_not_matter_to_the_sag_of_another() {
    // The wrist holds 0.49 N*m.
    for limit in [0.6, 0.8, 1.0, 1.5, 2.0, 3.0] {
        let found = hanging(limit);
        let found: Vec<&String> = found.iter().filter(|m| m.contains("N*m")).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        let sag = stated(found[0], "with its motors at their limits, Arms.bend would sag by", "deg");
        let expected = (4.87 / 150.0 + (0.5 * GRAVITY - 4.87) / 0.2).to_degrees();
        assert!((sag - expected).abs() < 0.006 * expected, "{sag} of {expected} in {}", found[0]);
    }
}

#[test]
fn a_motor_at_its_limit_that_moves_two_links_sags_under_both() {
    // The second finger moves as the first: the one motor bears 1 kg and 500 g at 0.3 m.
    let torque = 1.5 * 0.3 * GRAVITY;
    let limit = 4.40;
    let found = messages(&format!(
        "module Hand {{
           link base = box(100mm, 100mm, 20mm, mass: 10kg)
           link left = sphere(radius: 20mm, mass: 1kg) at [300mm, 100mm, 0mm]
           link right = sphere(radius: 20mm, mass: 500g) at [300mm, -100mm, 0mm]
           joint a : base -> left = revolute(axis: Y, max_torque: {limit}N*m, stiffness: 150N*m/rad) at [0mm, 100mm, 0mm]
           joint b : base -> right = revolute(axis: Y) at [0mm, -100mm, 0mm]
           joint b = a
         }}
         let hand = Hand()
         emit(plan(move(hand.a, to: 0.01deg, in: 8s), world: world(ground: held, dynamics: full)), \"p.json\")
"
    ));
    assert_eq!(found.len(), 1, "{found:?}");
    let sag = stated(&found[0], "with its motors at their limits, Hand.a would sag by", "deg");
    let expected = (limit / 150.0 + (torque - limit) / 0.2).to_degrees();
    assert!((sag - expected).abs() < 0.006 * expected, "{sag} of {expected} in {}", found[0]);
}

/// Returns the plan of a body of 3 kg with an arm of 10 g that turns on it, on feet with levers of 100 mm, of which the first two
/// move as one. `foot`: the mass of a foot, g; `feet`: the place of each along x and y (mm), and the facts of its knee.
fn stool(foot: u32, feet: &[((i32, i32), String)]) -> Plan {
    let mut links = String::new();
    for (i, ((x, y), facts)) in feet.iter().enumerate() {
        links += &format!(
            "link f{i} = sphere(15mm, mass: {foot}g, friction: 1) at [{x}mm, {y}mm, 15mm]
             joint k{i} : body -> f{i} = revolute(axis: Y, {facts}) at [{}mm, {y}mm, 15mm]\n",
            x + 100
        );
    }
    run_clean(&format!(
        "module Stool {{
           link body = box(100mm, 100mm, 40mm, mass: 3kg) at [0mm, 0mm, 80mm]
           {links}
           joint k1 = k0
           link arm = box(10mm, 10mm, 30mm, mass: 10g) at [0mm, 0mm, 115mm]
           joint turn : body -> arm = revolute(axis: Z)
         }}
         let stool = Stool()
         emit(plan(move(stool.turn, by: 0.1rad, in: 4s), world: world(dynamics: full)), \"p.json\")
"
    ))
    .plan("p.json")
}

#[test]
fn feet_on_knees_that_move_together_and_on_knees_at_their_stops_share_the_weight_by_symmetry() {
    // Four feet bear a quarter each, whatever their knees yield: two move as one, and two rest on stops 2 mrad away.
    for range in ["", ", range: -30deg..0.1deg"] {
        let places = [(150, 80), (150, -80), (-150, 80), (-150, -80)].into_iter().enumerate();
        let facts = |i| format!("stiffness: 100N*m/rad{}", if i < 2 { "" } else { range });
        let plan = stool(50, &places.map(|(i, place)| (place, facts(i))).collect::<Vec<_>>());
        let found = &instants(&plan, &[2.0], Detail::Loads, None)[0];
        let quarter = 3.21 / 4.0 * GRAVITY;
        let forces = found.forces.as_ref().expect("forces are known");
        assert_eq!(forces.len(), 4, "{range}");
        for force in forces {
            assert!((force.force.z / quarter - 1.0).abs() < 0.005, "{} of {quarter}{range}", force.force.z);
        }
        // The motor of two knees holds both feet, each with a lever of 100 mm.
        let effort = found.efforts[0].expect("known");
        let expected = -2.0 * 0.1 * (quarter - 0.05 * GRAVITY);
        assert!((effort / expected - 1.0).abs() < 0.005, "{effort} of {expected}{range}");
    }
}

#[test]
fn feet_on_knees_at_their_stops_share_the_weight_with_knees_that_move_together_as_all_yield() {
    // Contacts have 1e5 N/m, stops 1e3 N*m/rad. One motor holds both feet in the middle; those before and behind rest on
    // their stops, 2.3 degrees away. All have levers of 100 mm, and the body sinks level.
    let (contact, stop, gap, lever) = (1e5, 1e3, 2.3_f64.to_radians(), 0.1);
    let (both, alone, foot) = (25.0, 10.0, 0.02 * GRAVITY);
    let places = [(0, 80), (0, -80), (150, 80), (150, -80), (-150, 80), (-150, -80)].into_iter().enumerate();
    let facts = |i| match i {
        0 | 1 => format!("stiffness: {both}N*m/rad"),
        _ => format!("stiffness: {alone}N*m/rad, range: -30deg..2.3deg"),
    };
    let plan = stool(20, &places.map(|(i, place)| (place, facts(i))).collect::<Vec<_>>());
    // A foot bears (sink + rest) / yields.
    let middle = (2.0 * lever * lever / both * foot, 1.0 / contact + 2.0 * lever * lever / both);
    let stopped = lever / (alone + stop);
    let outer = (stopped * (lever * foot - stop * gap), 1.0 / contact + stopped * lever);
    let weight = 3.13 * GRAVITY;
    let sink =
        (weight - 2.0 * middle.0 / middle.1 - 4.0 * outer.0 / outer.1) / (2.0 / middle.1 + 4.0 / outer.1);
    let found = &instants(&plan, &[2.0], Detail::Loads, None)[0];
    let base = base_at(&plan, 2.0).expect("it stands").translation.vector;
    let forces = found.forces.as_ref().expect("forces are known");
    assert_eq!(forces.len(), 6);
    for force in forces {
        let (rest, yields) = if (force.point.x - base.x).abs() < 0.05 { middle } else { outer };
        let expected = (sink + rest) / yields;
        assert!((force.force.z / expected - 1.0).abs() < 0.005, "{} of {expected}", force.force.z);
    }
}

#[test]
fn friction_lifts_trailing_skids_as_far_as_it_then_presses() {
    // Round wheels pull four skids, 1 mm lower, on knees 50 mm ahead of them and 90 mm above the ground. Contacts have 1e5 N/m.
    let (stiffness, lever, height, contact) = (30.0, 0.05, 0.09, 1e5);
    let mut links = "link body = box(100mm, 100mm, 40mm, mass: 6kg) at [0mm, 0mm, 80mm]\n".to_owned();
    let mut moves = Vec::new();
    for (i, (x, y)) in [(100, 80), (100, -80), (-100, 80), (-100, -80)].into_iter().enumerate() {
        links += &format!(
            "link w{i} = sphere(radius: 50mm, mass: 50g, friction: 1) at [{x}mm, {y}mm, 50mm]
             joint t{i} : body -> w{i} = revolute(axis: Y) at [{x}mm, {y}mm, 50mm]\n"
        );
        moves.push(format!("move(m.t{i}, by: 4rad, in: 10s)"));
    }
    for (i, (x, y)) in [(150, 40), (150, -40), (-150, 40), (-150, -40)].into_iter().enumerate() {
        links += &format!(
            "link s{i} = sphere(15mm, mass: 1g, friction: 0.5) at [{x}mm, {y}mm, 14mm]
             joint k{i} : body -> s{i} = revolute(axis: Y, stiffness: {stiffness}N*m/rad) at [{}mm, {y}mm, 89mm]\n",
            x + 50
        );
    }
    let plan = run_clean(&format!(
        "module M {{\n{links}}}
         config C {{ part m: M  behavior go allows traction = Pc({}) }}
         emit(plan(C().go(), world: world(dynamics: full)), \"p.json\")
",
        moves.join(", ")
    ))
    .plan("p.json");
    let found = &instants(&plan, &[5.0], Detail::Loads, None)[0];
    let forces = found.forces.as_ref().expect("forces are known");
    let base = base_at(&plan, 5.0).expect("it stands").translation.vector;
    let of_skids = forces.iter().filter(|f| (f.point.y - base.y).abs() < 0.05);
    let skids = of_skids.map(|f| f.force.z).sum::<f64>() / 4.0;
    let yields = 1.0 / contact + lever * (lever + 0.5 * height) / stiffness;
    let expected = (6.204 * GRAVITY / 4.0 + contact * 1e-3) / (contact * yields + 1.0);
    assert!((skids / expected - 1.0).abs() < 0.02, "{skids} of {expected}");
}

#[test]
fn nothing_is_said_of_the_links_of_an_arm_while_one_of_its_joints_gives_way() {
    // With 0.4 times its stiffness the shoulder of 12 N*m/rad yields by 0.4 rad, with that of 100 N*m/rad by 3 degrees. The
    // wrist hardly yields.
    for (stiffness, checked) in [(12.0, false), (100.0, true)] {
        let plan = run_clean(&format!(
            "module Arm {{
               link base = box(100mm, 100mm, 20mm, mass: 10kg)
               link bob = sphere(radius: 20mm, mass: 600g) at [300mm, 0mm, 100mm]
               link hand = sphere(radius: 10mm, mass: 50g) at [400mm, 0mm, 100mm]
               joint shoulder : base -> bob = revolute(axis: Y, stiffness: {stiffness}N*m/rad) at [0mm, 0mm, 100mm]
               joint wrist : bob -> hand = revolute(axis: Y, stiffness: 100N*m/rad) at [350mm, 0mm, 100mm]
             }}
             let arm = Arm()
             emit(plan(move(arm.wrist, by: 1deg, in: 8s), world: world(ground: held, dynamics: full)), \"p.json\")
"
        ))
        .plan("p.json");
        let verdict = verify(&plan);
        let made = verdict.checks.iter().any(|check| check.kind == CheckKind::Deflection);
        assert_eq!(made, checked, "{stiffness}: {:?}", verdict.checks);
    }
}
