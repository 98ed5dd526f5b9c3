//! The library's scenes: `drive_to` against the geometry of where it was sent, and its refusals.

use crate::support::desk;
use crate::support::suite::MapFiles;
use modl::interpret::Mode;

/// The beginning of a program: a tank among others, and how far a port ends from a goal (mm and degrees).
const PRELUDE: &str = "use std.scenes.{Stance, chain_drive, chain_turn, drive_to, drive_and_dock, stance, tank_turn}\n\
    use std.smores.{Chain3, Tank7}\n\
    fn off(p: Port, b: Behavior, x: Length, y: Length, heading: Angle) -> Bool = {\n\
      let at = plan(b).end.pose(p)\n\
      let way: Vec3<Length> = [at.position.x - x, at.position.y - y, 0m]\n\
      let ahead: Vec3<Number> = [cos(heading), sin(heading), 0]\n\
      norm(way) < 1mm and dot(direction(at, X), ahead) > cos(0.2deg)\n\
    }\n";

/// Returns what a program prints after the prelude, and its messages.
fn run(program: &str) -> (Vec<String>, Vec<String>) {
    let (observed, _, _) = desk::run(&MapFiles::of(&format!("{PRELUDE}{program}")), Mode::Run);
    let messages = observed.diagnostics.iter().map(|d| d.message.to_string()).collect();
    (observed.printed, messages)
}

#[test]
fn ports_are_driven_to_where_they_are_sent() {
    let goals = [
        ("1m", "400mm", "90deg"),
        ("-500mm", "100mm", "0deg"),
        ("150mm", "0mm", "-170deg"),
        ("800mm", "0mm", "0deg"),
    ];
    for (x, y, heading) in goals {
        for (port, closing) in
            [("nose", "0mm"), ("nose", "100mm"), ("tail", "50mm"), ("steer.side[0]", "0mm")]
        {
            let (printed, diagnostics) = run(&format!(
                "let t = Tank7()\n\
                 let goal = Stance(x: {x}, y: {y}, heading: {heading})\n\
                 let way = drive_to(t.{port}, goal, (v, u) => t.drive(v, u), a => tank_turn(t, a), closing: {closing})\n\
                 print(off(t.{port}, way, {x}, {y}, {heading}))\n"
            ));
            assert_eq!(printed, ["true"], "{port} to {x}, {y}, {heading}, {closing}: {diagnostics:?}");
        }
    }
}

#[test]
fn the_way_leads_round_the_obstacles_or_through_them_as_asked() {
    for (avoiding, ok) in [(true, "true"), (false, "false")] {
        let (printed, diagnostics) = run(&format!(
            "scene Yard {{ part a: Tank7  obstacle wall = box(50mm, 800mm, 200mm) at [700mm, 150mm, 100mm] }}\n\
             let y = Yard()\n\
             let goal = Stance(x: 1.5m, y: 0m, heading: 0deg)\n\
             let way = drive_to(y.a.nose, goal, (v, t) => y.a.drive(v, t), a => tank_turn(y.a, a), avoiding: {avoiding})\n\
             print(off(y.a.nose, way, 1.5m, 0m, 0deg))\nprint(verify(way).ok)\n"
        ));
        assert_eq!(printed, ["true", ok], "{diagnostics:?}");
    }
}

#[test]
fn what_does_not_repeat_is_refused() {
    let goal = "Stance(x: 1m, y: 300mm, heading: 0deg)";
    let turn = "a => tank_turn(t, a)";
    let calls = [
        (format!("drive_to(t.nose, {goal}, (v, u) => t.drive(v, min(u, 3s)), {turn})"), "do not repeat"),
        (format!("drive_to(t.nose, {goal}, (v, u) => t.drive(v, 1s), {turn})"), "does not get on"),
        (
            format!("drive_to(t.nose, {goal}, (v, u) => t.drive(v, u), a => tank_turn(t, -a))"),
            "does not turn",
        ),
        (
            format!("drive_to(t.steer.side[0], {goal}, (v, u) => t.drive(v, u), {turn}, closing: 50mm)"),
            "90.0deg aside",
        ),
    ];
    for (call, words) in calls {
        let (printed, diagnostics) = run(&format!("let t = Tank7()\nprint(plan({call}))\n"));
        assert!(printed.is_empty(), "{call}: {printed:?}");
        assert!(diagnostics.iter().any(|d| d.contains(words)), "{call}: {diagnostics:?}");
    }
}

#[test]
fn scenes_of_the_library_pass_the_judge() {
    let (printed, diagnostics) = run("use std.scenes.{Carrier, Rendezvous, ThreeInOne}\n\
         let r = Rendezvous()\nprint(verify(Sc(r.meet(), r.together(), r.leave())).ok)\n\
         let t = ThreeInOne()\nprint(verify(Sc(t.build(), t.drive())).ok)\n\
         let c = Carrier()\nprint(verify(Sc(c.take(), c.carry(), c.put())).ok)\n");
    assert_eq!(printed, ["true"; 3], "{diagnostics:?}");
}

#[test]
fn the_rendezvous_docks_on_rigid_bodies() {
    // Simulated, the ports meet within the reach of the magnets, 4 mm and 5 degrees; a second set of slips, too.
    let (printed, diagnostics) = run("use std.scenes.Rendezvous\n\
         let s = simulate(Rendezvous().meet(), runs: 3, friction_spread: 0.1, mass_spread: 0.1)\n\
         print(s.dock_error < 4mm and s.dock_angle < 5deg, s.misses, len(s.failures))\n");
    assert_eq!(printed, ["true 0 0"], "{diagnostics:?}");
}
