//! Travel of robots whose contacts scrub: that of motion in time, with soft and stiff servos.

use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;
use modl::plan::verify::verify;
use modl::plan::{Body, CheckKind, DynamicsModel, Plan, Status, World};
use modl::robot::Surface;
use modl::simulate::{ServoGains, Settings, simulate};
use std::sync::Arc;

/// A cross with a leg too few, which treads on the spot and drags its feet (seed 69 of the random gaits). In MuJoCo it goes 4 mm
/// with servos of 60 N·m/rad, 3 mm with those of 150 and 1 mm with those of 500; with loads at rest it would go 1 mm back.
const CROSS: &str = "\
use std.smores.Smores
config Robot {
  part m[7]: Smores
  connect m[1].bottom -- m[2].top
  connect m[0].left -- m[1].top
  set m[1].tilt = -58.60deg
  connect m[3].bottom -- m[4].top
  connect m[0].right -- m[3].top
  set m[3].tilt = -58.60deg
  set m[4].tilt = -31.40deg
  connect m[5].bottom -- m[6].top
  connect m[0].top -- m[5].top
  set m[5].tilt = -58.60deg
  set m[6].tilt = -31.40deg
  base m[0]
}
let r = Robot()
let b = Sc(
  Pc(move(r.m[1].tilt, to: -49.51deg, in: 433ms), move(r.m[3].tilt, to: -59.54deg, in: 433ms)),
  Pc(move(r.m[1].tilt, to: -58.60deg, in: 623ms), move(r.m[3].tilt, to: -58.60deg, in: 623ms)),
  Pc(move(r.m[1].tilt, to: -67.51deg, in: 1.023s), move(r.m[3].tilt, to: -49.49deg, in: 1.023s)),
  Pc(move(r.m[1].tilt, to: -58.60deg, in: 702ms), move(r.m[3].tilt, to: -58.60deg, in: 702ms)),
)
";

/// An inchworm of eight modules. In MuJoCo it goes 1 mm with servos of 60 N·m/rad, 20 mm with those of 150 and 24 mm with those
/// of 500 (seed 100132 of the random gaits): softer servos sag, and other discs bear.
const INCHWORM: &str = "\
use std.smores.SmoresEP
config Robot {
  part m[8]: SmoresEP
  connect m[0].bottom -- m[1].top
  connect m[1].bottom -- m[2].top
  connect m[2].bottom -- m[3].top
  connect m[3].bottom -- m[4].top
  connect m[4].bottom -- m[5].top
  connect m[0].left -- m[6].right
  connect m[0].right -- m[7].left
  base m[3]
  behavior creep = Sc(
    Pc(move(m[3].tilt, to: 45.49deg, in: 813ms), move(m[2].tilt, to: -24.37deg, in: 813ms), move(m[4].tilt, to: -33.56deg, in: 813ms)),
    move(m[2].tilt, to: 0deg, in: 503ms),
    Pc(move(m[3].tilt, to: 0deg, in: 863ms), move(m[4].tilt, to: 0deg, in: 863ms)),
  )
  behavior anyhow allows traction = creep()
}
let r = Robot()
";

/// Returns the plan of a program that leaves its behaviour in `b`, under full dynamics with a friction.
fn plan(program: &str, friction: f64) -> Plan {
    let free = "emit(plan(b, world: world(ground: off, gravity: off, dynamics: statics)), \"p.json\")\n";
    let (observed, written, _) = desk::run(&MapFiles::of(&format!("{program}{free}")), Mode::Run);
    assert!(observed.diagnostics.is_empty(), "{:?}", observed.diagnostics);
    let mut plan = written.plan("p.json");
    plan.worlds[0].world = World { friction, dynamics: DynamicsModel::Full, ..World::default() };
    plan
}

#[test]
fn a_robot_that_scrubs_goes_as_it_does_in_time() {
    let plan = plan(CROSS, 0.642);
    let verdict = verify(&plan);
    assert!(verdict.ok(), "{:?}", verdict.failures);
    assert!(verdict.notes.iter().any(|note| note.starts_with("contacts scrub:")), "{:?}", verdict.notes);
    // The stiffest servos stand on contacts that are four times as stiff.
    let played = |(factor, contacts): (f64, f64)| {
        let servo = ServoGains { factor, ..ServoGains::default() };
        let settings = Settings { step: 1e-3, servo, ..Settings::default() };
        let mut plan = plan.clone();
        let Body::Tracks(tracks) = &mut plan.body else { panic!("it has joints") };
        for module in &mut Arc::make_mut(&mut tracks.robot.library).modules {
            let stiffness = Some(contacts * Surface::STIFFNESS_DEFAULT);
            module.links.iter_mut().for_each(|link| link.surface.stiffness = stiffness);
        }
        simulate(&plan, &settings).expect("it can be simulated")
    };
    let all = [(0.4, 1.0), (1.0, 1.0), (3.3, 4.0)].map(played);
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let apart = |&(a, b): &(usize, usize)| (all[a].travel - all[b].travel).xy().norm();
    let farthest = pairs.into_iter().max_by(|x, y| apart(x).total_cmp(&apart(y))).expect("there are three");
    let middle = (all[farthest.0].travel + all[farthest.1].travel) / 2.0;
    // As far as MuJoCo goes, within 5 mm: see the gait.
    assert!(verdict.travel[1] < -1.5e-3 && verdict.travel[1] > -4.4e-3, "{:?}", verdict.travel);
    let off = libm::hypot(verdict.travel[0] - middle.x, verdict.travel[1] - middle.y);
    assert!(off < 1e-5, "{off} m off");
    let turns = all.map(|simulation| simulation.heading);
    let (least, most) = (turns.iter().fold(9.0, |a, b| b.min(a)), turns.iter().fold(-9.0, |a, b| b.max(a)));
    assert!((verdict.heading - (least + most) / 2.0).abs() < 1e-4, "{} rad", verdict.heading);
}

#[test]
fn a_robot_that_goes_elsewhere_with_other_servos_is_refused_unless_its_travel_may_be_open() {
    let verdict = verify(&plan(&format!("{INCHWORM}let b = r.creep()\n"), 0.62));
    let [failure] = &verdict.failures[..] else { panic!("it fails once: {:?}", verdict.failures) };
    assert_eq!(failure.kind, CheckKind::Traction);
    assert!(failure.message.contains("the travel is not determined: in motion"), "{}", failure.message);
    // The bound is at least 1.25 times half of what MuJoCo's ends are apart, 23 mm, and at most 1.25 times all of that: see the
    // gait.
    assert!((0.014..0.029).contains(&failure.value), "{} m", failure.value);
    let traction = verdict.checks.iter().find(|check| check.kind == CheckKind::Traction);
    assert_eq!(traction.map(|check| &check.status), Some(&Status::Failed));
    let anyhow = "emit(plan(r.anyhow(), world: world(friction: 0.62, dynamics: full)), \"p.json\")\n";
    assert_eq!(desk::messages(&format!("{INCHWORM}{anyhow}")), Vec::<String>::new());
}
