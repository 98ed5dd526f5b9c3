//! Plan files of every family, made by the planners of the language and then altered.

use super::damage::damaged_bytes;
use super::dice::Dice;
use super::json::Altered;
use super::project::{Desk, Project};
use modl::interpret::{Mode, Options};
use std::sync::LazyLock;

/// A robot whose joints hold weight, one of which follows others, and one of which slides.
pub const HELD: &str = r#"
connector Face { mates Face, turns 4, holds 200N, holds 20N*m, capture 2mm 5deg }
module Arm {
  mass 500g
  link body = box(40mm, 40mm, 40mm)
  link hand = box(38mm, 30mm, 30mm) at [40mm, 0mm, 0mm]
  link pin = box(10mm, 10mm, 10mm) at [0mm, 0mm, 30mm]
  link flag = box(4mm, 4mm, 20mm) at [0mm, 30mm, 0mm]
  joint bend: body -> hand = revolute(axis: Y, range: -45deg..45deg, max_speed: 2rad/s, max_accel: 40rad/s^2, max_torque: 3N*m)
  joint slide: body -> pin = prismatic(axis: Z, range: -4mm..6mm, max_speed: 20mm/s, max_force: 20N)
  joint turn: body -> flag = revolute(axis: Y)
  joint turn = 2 * bend
  touching body hand
  touching body pin
  touching body flag
  port back: Face on body at [-20mm, 0mm, 0mm] facing -X up +Z
  port front: Face on hand at [19mm, 0mm, 0mm] facing +X up +Z
}
config Three {
  part m[3]: Arm
  for i in 0..2 { connect m[i].front -- m[i + 1].back }
  base m[0]
  behavior bow = Sc(Pc(move(m[0].bend, to: 20deg), move(m[1].slide, to: 5mm)), move(m[2].bend, to: -30deg))
}
emit(plan(Three().bow(), world: world(ground: held)), "p.plan.json")
"#;

/// A robot on wheels that drives.
pub const ROLLS: &str = "use std.smores.Driver1\nemit(plan(Driver1().drive(t: 1s)), \"p.plan.json\")\n";

/// A chair of modules that becomes a snake.
pub const UNWINDS: &str = "use std.rofi.Chair\nemit(tosnake(Chair()), \"p.plan.json\")\n";

/// A net that becomes a tetrahedron.
pub const FOLDS: &str = "use std.shapes.tetrahedron\nuse std.mori.Mori
emit(fold(tetrahedron(edge: 80mm), module: Mori), \"p.plan.json\")\n";

/// A row of cells that becomes a block.
pub const SQUEEZES: &str = r#"
use std.crystal.ExpandingCube
lattice Row of ExpandingCube = cells("""
  ######
""")
lattice Block of ExpandingCube = cells("""
  ###
  ###
""")
emit(squeeze(Row, Block), "p.plan.json")
"#;

/// An octahedron of struts that becomes nearly a cube.
pub const MORPHS: &str = r#"
use std.shapes.cube
use std.truss.PneumaticReel
truss Octahedron of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
emit(morph(Octahedron, cube(edge: 1.2m), tolerance: 200mm, budget: 12), "p.plan.json")
"#;

/// An octahedron of struts that rolls past an obstacle.
pub const WALKS: &str = r#"
use std.truss.PneumaticReel
truss Octahedron of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
emit(locomote(Octahedron, path: [[1m, 0m, 0m]], budget: 10, obstacles: [placed(box(1m, 1m, 1m), at: [0m, 6m, 500mm])]), "p.plan.json")
"#;

/// Two tetrahedra of struts with an arm each, whose tips become one node, which rises and comes apart again.
pub const MERGES: &str = r#"
use std.truss.PneumaticReel
truss Towers of PneumaticReel {
  node l0 = [200mm, 0m, 0m]  node l1 = [2m, -1m, 0m]  node l2 = [2m, 1m, 0m]  node l3 = [1.7m, 0m, 1.4m]
  node r0 = [5800mm, 0m, 0m]  node r1 = [4m, -1m, 0m]  node r2 = [4m, 1m, 0m]  node r3 = [4.3m, 0m, 1.4m]
  node g = [2.1m, 0m, 2.4m]  node h = [3.9m, 0m, 2.4m]
  strut l0 -- l1  strut l0 -- l2  strut l1 -- l2  strut l0 -- l3  strut l1 -- l3  strut l2 -- l3
  strut r0 -- r1  strut r0 -- r2  strut r1 -- r2  strut r0 -- r3  strut r1 -- r3  strut r2 -- r3
  strut l1 -- r1  strut l2 -- r2  strut l1 -- r2  strut l3 -- r1  strut l3 -- r2  strut l3 -- r3
  strut g -- l1  strut g -- l2  strut g -- l3
  strut h -- r1  strut h -- r2  strut h -- r3
}
let met = move_nodes(at_rest(Towers), nodes: ["g", "h"], to: [[3m, 0m, 2.4m], [3m, 0m, 2.4m]])
let risen = move_nodes(merge_nodes(met, node: "h", into: "g"), nodes: ["g"], to: [[3m, 0m, 2.5m]])
let two = split_node(risen, node: "h", struts: ["g -- l1", "g -- r1", "g -- r3"])
emit(move_nodes(two, nodes: ["g", "h"], to: [[3m, 400mm, 2.3m], [3m, -400mm, 2.3m]]), "p.plan.json")
"#;

/// A robot that docks and parts on the ground, with an obstacle beside it.
const DOCKS: &str = r#"
connector Face { mates Face, turns 4, capture 4mm 5deg }
module Rod {
  link body = box(50mm, 20mm, 20mm, mass: 5kg)
  link slide = box(80mm, 20mm, 20mm, mass: 50g) at [0mm, 0mm, 30mm]
  joint out : body -> slide = prismatic(axis: X, range: -400mm..400mm, max_force: 50N) at [0mm, 0mm, 30mm]
  port front: Face on slide at [40mm, 0mm, 0mm] facing +X up +Z
  port back: Face on slide at [-40mm, 0mm, 0mm] facing -X up +Z
}
scene Two {
  part a: Rod
  part b: Rod at [200mm, 0mm, 0mm]
  obstacle post = box(20mm, 20mm, 20mm) at [0mm, 200mm, 10mm]
  behavior go = Sc(move(a.out, to: 60mm, in: 1s), move(b.out, to: -20mm, in: 1s), wait(1s))
}
emit(plan(Two().go(), world: world(ground: off, gravity: off)), "p.plan.json")
"#;

/// The plans of a family, with their files to be altered.
pub type Plans = Vec<Altered>;

/// The plans of robots with joints.
pub static ARTICULATED: LazyLock<Plans> = LazyLock::new(|| made(&[HELD, ROLLS, FOLDS, DOCKS]));
/// The plans of lattices.
pub static LATTICE: LazyLock<Plans> = LazyLock::new(|| made(&[SQUEEZES]));
/// The plans of trusses.
pub static TRUSS: LazyLock<Plans> = LazyLock::new(|| made(&[MORPHS, WALKS, MERGES]));

/// Returns the plans that programs emit as `p.plan.json`.
fn made(programs: &[&str]) -> Plans {
    let plan = |program: &&str| {
        let files = Project::of(program);
        let checked = modl::check::check(&files, "main.mod");
        let mut desk = Desk::default();
        let outcome = modl::execute::run(&checked, Mode::Run, &files, &mut desk, &Options::default());
        let errors: Vec<_> =
            checked.diagnostics.iter().chain(&outcome.diagnostics).filter(|d| d.is_error()).collect();
        assert!(errors.is_empty(), "the program of a plan is right: {errors:?}");
        let bytes = desk.written.get("p.plan.json").expect("the plan is written");
        Altered::new(serde_json::from_slice(bytes).expect("plans are JSON"))
    };
    programs.iter().map(plan).collect()
}

/// Returns the text of a plan file that was altered once or twice; now and then its bytes are.
pub fn altered(plans: &Plans, dice: &mut Dice) -> Vec<u8> {
    const PARTS: &[&str] = &["/body", "/body", "/body", "/library", "/world", ""];
    let plan = &plans[dice.below(plans.len())];
    let mut file = plan.file.clone();
    for _ in 0..1 + dice.below(2) {
        plan.alter(&mut file, dice, PARTS);
    }
    let bytes = file.to_string().into_bytes();
    if dice.below(32) == 31 { damaged_bytes(dice, &bytes) } else { bytes }
}

/// Returns the text of a plan file in which a number of its motion, its library or its world may be another: most can be read.
pub fn nearly_right(plans: &Plans, dice: &mut Dice) -> Vec<u8> {
    let plan = &plans[dice.below(plans.len())];
    let mut file = plan.file.clone();
    for _ in 0..dice.below(3) {
        plan.alter(&mut file, dice, &["/body/tracks", "/body/start", "/library", "/world", "/body"]);
    }
    file.to_string().into_bytes()
}
