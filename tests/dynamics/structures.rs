//! Closed loops, robots that dock on the way and held bases under full dynamics, beside their simulations in MuJoCo.

use super::mjcf::{Case, happens, number, played};
use crate::support::desk::run;
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use libm::hypot;
use modl::interpret::Mode;
use std::io::Write as _;

/// A plan and what is known of it.
pub struct Structure {
    /// The name of the row in docs/dynamics.md.
    pub name: &'static str,
    /// The declarations that the program needs besides the library's.
    declarations: &'static str,
    /// A program that leaves its behaviour in `b`.
    program: &'static str,
    /// The world of the plan.
    world: &'static str,
    /// True if the verdict and MuJoCo may differ, for the reason in docs/dynamics.md.
    differs: bool,
}

const RING: &str = "use std.smores.Smores
config Ring(n: Int) closed {
  part m[n]: Smores
  for i in 0..n {
    connect m[i].bottom -- m[(i + 1) % n].top
    set m[i].tilt = 360deg / n
  }
  base m[0]
  // Mirror images about two axes stay closed: n is a multiple of four.
  behavior squash(a: Angle, t: Time) = Pc(
    move(m[0].tilt, by: a, in: t), move(m[div(n, 2)].tilt, by: a, in: t),
    move(m[div(n, 4)].tilt, by: -a, in: t), move(m[div(3 * n, 4)].tilt, by: -a, in: t),
  )
  behavior widen(a: Angle) allows collision(m[3], m[4]) = Pc([move(m[i].tilt, by: a, in: 2s) for i in [2, 3, 5, 6]])
}
";

const FLAT: &str = "connector Hook { mates Hook, turns 4, capture 4mm 3deg }
module Link {
  link back = box(40mm, 60mm, 60mm, mass: 250g, friction: 0.6) at [20mm, 0mm, 0mm]
  link front = box(40mm, 60mm, 60mm, mass: 250g, friction: 0.6) at [70mm, 0mm, 0mm]
  touching back front
  joint turn : back -> front = revolute(axis: Z, range: -90deg..90deg, max_speed: 1rad/s, max_torque: 3N*m,
    max_accel: 10rad/s^2, stiffness: 150N*m/rad) at [45mm, 0mm, 0mm]
  port tail : Hook on back at [0mm, 0mm, 0mm] facing -X up +Z
  port head : Hook on front at [90mm, 0mm, 0mm] facing +X up +Z
}
config Flat(n: Int = 8) closed {
  part m[n]: Link
  for i in 0..n {
    connect m[i].head -- m[(i + 1) % n].tail
    set m[i].turn = 360deg / n
  }
  base m[0]
  behavior squash(a: Angle) = Pc(
    move(m[0].turn, by: a), move(m[div(n, 2)].turn, by: a),
    move(m[div(n, 4)].turn, by: -a), move(m[div(3 * n, 4)].turn, by: -a),
  )
}
let l = Flat()
let b = Sc(l.squash(20deg), l.squash(-20deg), l.squash(-20deg), l.squash(20deg))
";

const CRANE: &str = "module Crane {
  link mast = box(100mm, 100mm, 600mm, mass: 10kg) at [0mm, 0mm, 300mm]
  link jib = box(800mm, 40mm, 40mm, mass: 2kg) at [300mm, 0mm, 640mm]
  link trolley = box(60mm, 60mm, 30mm, mass: 1kg) at [100mm, 0mm, 600mm]
  link hook = box(40mm, 40mm, 40mm, mass: 3kg) at [100mm, 0mm, 500mm]
  touching jib trolley
  joint slew : mast -> jib = revolute(axis: Z, max_speed: 1rad/s, max_torque: 10N*m, max_accel: 3rad/s^2)
    at [0mm, 0mm, 620mm]
  joint run : jib -> trolley = prismatic(axis: X, range: 0mm..500mm, max_speed: 300mm/s, max_force: 20N,
    max_accel: 1m/s^2) at [100mm, 0mm, 600mm]
  joint lift : trolley -> hook = prismatic(axis: Z, range: -300mm..0mm, max_speed: 300mm/s, max_force: 60N,
    max_accel: 2m/s^2) at [100mm, 0mm, 560mm]
}
let k = Crane()
let b = Sc(
  move(k.lift, to: -200mm), Pc(move(k.slew, to: 90deg), move(k.run, to: 400mm)),
  move(k.lift, to: 0mm), Pc(move(k.slew, to: 0deg), move(k.run, to: 0mm)),
)
";

const ARM: &str = "use std.smores.Arm
let a = Arm(3)
let b = Sc(
  Pc(move(a.m[1].tilt, to: -60deg), move(a.m[2].tilt, to: 60deg)), move(a.m[0].pan, to: 90deg),
  Pc(move(a.m[1].tilt, to: 60deg), move(a.m[2].tilt, to: -60deg)),
)
";

const STRUCTURES: &[Structure] = &[
    Structure {
        name: "a ring of 8 that stands is squashed and drawn out",
        declarations: RING,
        program: "let r = Ring(8)\nlet b = Sc(r.squash(10deg, 2s), r.squash(-20deg, 3s), r.squash(10deg, 2s))\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "a ring of 12 is squashed",
        declarations: RING,
        program: "let r = Ring(12)\nlet b = Sc(r.squash(4deg, 2s), r.squash(-4deg, 2s))\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "a ring of 12 is drawn out",
        declarations: RING,
        program: "let r = Ring(12)\nlet b = Sc(r.squash(-6deg, 2s), r.squash(6deg, 2s))\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "a ring of 8 opens and closes at its top",
        declarations: RING,
        program: "let r = Ring(8)
let b = Sc(r.squash(8deg, 2s), undock(r.m[3].bottom), wait(500ms), dock(r.m[3].bottom, r.m[4].top), r.squash(-8deg, 2s))\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "it opens, parts by 60°, and closes",
        declarations: RING,
        program: "let r = Ring(8)
let b = Sc(
  r.squash(8deg, 2s), undock(r.m[3].bottom), r.widen(-15deg), wait(500ms), r.widen(15deg),
  dock(r.m[3].bottom, r.m[4].top), r.squash(-8deg, 2s),
)\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "two docked cars drive, let go at one axle, drive on",
        declarations: "",
        program: "use std.smores.TwoCars\nlet t = TwoCars()\nlet b = Sc(t.drive(t: 2s), t.open(), t.drive(t: 2s))\n",
        world: "world()",
        differs: false,
    },
    Structure {
        name: "an arm of three whose base is held swings",
        declarations: "",
        program: ARM,
        world: "world(ground: held)",
        differs: false,
    },
    Structure {
        name: "a crane with two joints that slide",
        declarations: "",
        program: CRANE,
        world: "world(ground: held)",
        differs: false,
    },
    Structure {
        name: "a ring of 8 that lies flat is squashed",
        declarations: "",
        program: FLAT,
        world: "world()",
        differs: false,
    },
    Structure {
        name: "`Spider.crawl` of `std.rofi`: four hips in a ring",
        declarations: "",
        program: "use std.rofi.Spider\nlet b = Spider().crawl(steps: 1)\n",
        world: "world()",
        differs: true,
    },
];

/// The stiffness of the servos, N·m/rad, of each column.
const GAINS: [f64; 3] = [60.0, 150.0, 500.0];

/// The stiffness up to which the greatest torque is compared, N·m/rad: wheels on stiffer servos chatter.
const SMOOTH_GAIN: f64 = 150.0;

/// The error allowed of the greatest torque, relative to the simulated one, and in parts of the limit.
const TORQUE_ERROR: (f64, f64) = (0.15, 0.12);

/// Returns the first structures, with `MODL_WHOLE=1` all, and their cases.
pub fn of_structures(few: usize) -> (&'static [Structure], Vec<Case>) {
    let whole = whole();
    let some = &STRUCTURES[..if whole { STRUCTURES.len() } else { few }];
    let case = |structure: &Structure| {
        let plan = format!("let p = plan(b, world: {})\nemit(p, \"p.json\")", structure.world);
        let program = format!("{}{}{plan}", structure.declarations, structure.program);
        let (observed, desk, _) = run(&MapFiles::of(&program), Mode::Run);
        let errors: Vec<_> = observed.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(errors.is_empty(), "{errors:?} in\n{program}");
        Case::new(structure.name, desk.plan("p.json"))
    };
    (some, some.iter().map(case).collect())
}

#[test]
fn loops_docking_and_held_bases_are_as_in_a_simulation() {
    let whole = whole();
    let (some, cases) = of_structures(1);
    let gains = if whole { &GAINS[..] } else { &GAINS[1..2] };
    let tasks: Vec<_> = cases.iter().map(Case::task).collect();
    let mut simulated = vec![];
    for gain in gains {
        let Some(all) = played(&tasks, *gain, "both", "") else { return };
        simulated.push(all);
    }
    let mut wrong = vec![];
    for (index, (structure, case)) in some.iter().zip(&cases).enumerate() {
        let verdict = case.plan.verdict.as_ref().expect("it was verified");
        let needed = 1.0 - verdict.torque_margin.as_ref().expect("its motors have limits").value;
        let travel = hypot(verdict.travel[0], verdict.travel[1]);
        let mut row = format!("| {} | {:.0} mm | {needed:.2} |", structure.name, 1e3 * travel);
        let mut alike = verdict.ok();
        for (gain, theirs) in gains.iter().zip(simulated.iter().map(|all| &all[index])) {
            let get = |key: &str, index: usize| number(&theirs[key][index]);
            let (theirs_travel, theirs_needed) =
                (hypot(get("travel", 0), get("travel", 1)), get("needed", 0));
            let lag = get("lag", 0).to_degrees();
            row += &format!(" {:.0} mm | {lag:.1}° | {theirs_needed:.2} |", 1e3 * theirs_travel);
            let away = hypot(get("travel", 0) - verdict.travel[0], get("travel", 1) - verdict.travel[1]);
            let error = (theirs_needed - needed).abs();
            alike &= happens(verdict, theirs)
                && away < (0.1 * theirs_travel).max(0.005)
                && (*gain > SMOOTH_GAIN || error < (TORQUE_ERROR.0 * theirs_needed).max(TORQUE_ERROR.1));
        }
        writeln!(std::io::stderr(), "{row}").expect("stderr is open");
        if alike == structure.differs {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
