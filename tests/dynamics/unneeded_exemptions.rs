//! Exemptions that nothing needs: what a verdict says of travel does not depend on them.

use super::mjcf::played;
use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use serde_json::{Value, json};

/// A chain of boxes that scrubs as it curls.
const CHAIN: &str = "\
connector Plug { mates Socket, turns 4, holds 80N }
connector Socket { mates Plug, turns 4, holds 80N }
module Hinge {
  mass 150g
  link base = box(40mm, 40mm, 40mm)
  link tip = box(40mm, 40mm, 40mm) at [60mm, 0mm, 0mm]
  joint bend : base -> tip = revolute(axis: Y, range: -90deg..90deg, max_speed: 60deg/s, max_torque: 4N*m) at [30mm, 0mm, 0mm]
  port back : Socket on base at [-20mm, 0mm, 0mm] facing -X up +Z
  port front : Plug on tip at [20mm, 0mm, 0mm] facing +X up +Z
}
config Arm {
  part h[6]: Hinge
  for i in 0..5 { connect h[i].front -- h[i + 1].back turn if i % 2 == 0 { 90deg } else { 0deg } }
  base h[0]
  behavior curl(to: Angle) ALLOWS = Pc([move(x.bend, to: to) for x in h])
}
let arm = Arm()
let p = plan(Sc(arm.curl(30deg), arm.curl(0deg)))
emit(p, \"p.plan.json\")
save(p, \"p.mjcf.xml\")
";

/// Returns the plan with its verdict, and the model.
fn of(allows: &str) -> (Value, String) {
    let (observed, files, _) = desk::run(&MapFiles::of(&CHAIN.replace("ALLOWS", allows)), Mode::Run);
    let codes: Vec<String> = observed.diagnostics.iter().map(|d| d.code.to_string()).collect();
    assert!(codes.iter().all(|code| code == "W0004"), "{codes:?}");
    let text = |name: &str| files.text(name).to_owned();
    (serde_json::from_str(&text("p.plan.json")).expect("a plan file is JSON"), text("p.mjcf.xml"))
}

#[test]
fn a_chain_that_scrubs_travels_in_time_whatever_it_allows_and_does_not_need() {
    let (plan, model) = of("");
    let (allowed, _) = of("allows unstable");
    let travel = |plan: &Value| -> Vec<f64> {
        let travel = plan["verdict"]["travel"].as_array().expect("it is stated");
        travel.iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    assert_eq!(travel(&plan), travel(&allowed));
    for stiffness in [60.0, 150.0, 500.0] {
        let tasks = [json!({ "plan": allowed, "model": model })];
        let Some(simulated) = played(&tasks, stiffness, "play", "") else { return };
        let theirs = |axis: usize| simulated[0]["travel"][axis].as_f64().expect("a number");
        let ours = travel(&allowed);
        let off = libm::hypot(theirs(0) - ours[0], theirs(1) - ours[1]);
        // By the rollout alone it ends 16 mm elsewhere.
        assert!(off < 5e-3, "{stiffness} N m/rad: {off} m off");
    }
}
