//! Loads that are open: those of joints as good as limp that bear them together, and those of soft legs that much friction
//! turns.

use crate::support::desk::{run_clean, stated};
use crate::support::verdicts::status;
use modl::plan::verify::verify;
use modl::plan::{CheckKind, Plan, Status};

/// Returns the plan of a body on three feet, one of them on a leg that two joints turn together, at rest for a time.
/// `stiffness`: that of each of the two servos, N·m/rad.
fn plan(stiffness: f64, time: &str) -> Plan {
    let program = format!(
        "
module Tripod {{
  link body = box(200mm, 200mm, 40mm, mass: 1kg) at [0mm, 0mm, 60mm]
  link left = box(20mm, 20mm, 40mm, mass: 50g) at [-80mm, 80mm, 20mm]
  link right = box(20mm, 20mm, 40mm, mass: 50g) at [-80mm, -80mm, 20mm]
  link leg = box(100mm, 20mm, 40mm, mass: 100g) at [150mm, 0mm, 20mm]
  link dial = cylinder(10mm, 10mm, mass: 10g) at [0mm, 0mm, 85mm]
  link disc = cylinder(10mm, 10mm, mass: 10g) at [50mm, 0mm, 85mm]
  joint a : body -> dial = revolute(axis: Z, stiffness: {stiffness:e}N*m/rad) at [0mm, 0mm, 85mm]
  joint b : body -> disc = revolute(axis: Z, stiffness: {stiffness:e}N*m/rad) at [50mm, 0mm, 85mm]
  joint l : body -> left = fixed() at [0mm, 0mm, 0mm]
  joint r : body -> right = fixed() at [0mm, 0mm, 0mm]
  joint c : body -> leg = revolute(axis: Y) at [100mm, 0mm, 40mm]
  joint c = a + b
}}
config One {{ part t: Tripod  behavior rest = wait({time}) }}
emit(plan(One().rest(), world: world(dynamics: full)), \"p.json\")
"
    );
    run_clean(&program).plan("p.json")
}

/// Two servos that yield without end bear a leg by any parts, so that no loads are found, and no check by loads is made.
#[test]
fn loads_that_are_not_found_are_not_judged_be_it_at_a_single_instant() {
    for (time, instants) in [("0s", 1), ("500ms", 2)] {
        let limp = verify(&plan(1e-300, time));
        let firm = verify(&plan(100.0, time));
        for kind in [CheckKind::Balance, CheckKind::Traction] {
            let unknown = format!("at {instants} of {instants} instants no loads were found");
            assert_eq!(status(&limp, kind), Status::NotChecked(unknown), "{kind:?}");
            assert_eq!(status(&firm, kind), Status::Sampled(instants), "{kind:?}");
        }
    }
}

/// Returns at how many instants of how many, as a note says, loads and friction did not come to agree, of a robot with two feet
/// on slides, of which one moves forth and one back, and three on knees that friction turns at a lever of 100 mm.
/// `stiffness`: that of the knees, N·m/rad; `None` without such a note.
fn disagreeing(stiffness: f64) -> Option<[f64; 2]> {
    let foot = |name: &str, x: f64, y: f64| {
        format!("link {name} = sphere(15mm, mass: 50g, friction: 1) at [{x}mm, {y}mm, 15mm]\n")
    };
    let knee = |name: &str, foot: &str, x: f64, y: f64| {
        let servo = format!("revolute(axis: Y, stiffness: {stiffness:e}N*m/rad)");
        format!("joint {name} : body -> {foot} = {servo} at [{x}mm, {y}mm, 100mm]\n")
    };
    let slide = |name: &str, foot: &str, y: f64| {
        format!(
            "joint {name} : body -> {foot} = prismatic(axis: X, stiffness: 1e5N/m) at [-80mm, {y}mm, 100mm]\n"
        )
    };
    let parts = [
        foot("a", 20.0, 60.0) + &foot("b", 20.0, -60.0) + &foot("f", 80.0, 0.0),
        foot("c", -80.0, 60.0) + &foot("d", -80.0, -60.0),
        knee("ka", "a", 0.0, 60.0) + &knee("kb", "b", 0.0, -60.0) + &knee("kf", "f", 80.0, 0.0),
        slide("sc", "c", 60.0) + &slide("sd", "d", -60.0),
    ];
    let moves = [("ka", "5deg"), ("kb", "-5deg"), ("sc", "40mm"), ("sd", "-40mm")];
    let moves = moves.map(|(joint, by)| format!("move(m.{joint}, by: {by}, in: 1s)")).join(", ");
    let program = format!(
        "
module M {{
  link body = box(100mm, 100mm, 40mm, mass: 2kg) at [0mm, 0mm, 120mm]
  {}
}}
config One {{ part m: M  behavior go = Pc({moves}) }}
emit(plan(One().go(), world: world(dynamics: full, friction: 10)), \"p.json\")
",
        parts.concat()
    );
    let verdict = verify(&run_clean(&program).plan("p.json"));
    let note = verdict.notes.iter().find(|note| note.contains("did not come to agree"))?;
    Some([stated(note, "at", " of"), stated(note, " of", " instants")])
}

/// Friction of ten times the load turns soft knees by more than the load does, and firm ones by nothing.
#[test]
fn instants_without_agreement_of_loads_and_friction_are_counted() {
    let [some, all] = disagreeing(20.0).expect("soft knees leave it open");
    // The move lasts a second, and instants are 10 ms apart.
    assert!((1.0..=all).contains(&some) && (all - 101.0).abs() < 1e-9, "{some} of {all}");
    assert_eq!(disagreeing(1e5), None);
}
