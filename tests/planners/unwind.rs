//! `tosnake` and `reconfigure` of modules that are not RoFI's: snakes whose form is known in closed form, and what modules
//! must have.

use super::tosnake::tracks;
use crate::support::desk::{run, run_clean};
use crate::support::suite::MapFiles;
use modl::geometry::{Pose, Vec3};
use modl::interpret::Mode;
use modl::plan::{self, Plan};
use modl::robot::{Kinematics, PortRef};
use modl::source::code;
use std::collections::BTreeMap;

/// Robots of SMORES and of modules made here.
const ROBOTS: &str = "
use std.smores.{Smores, SmoresEP}

/// Three arms of two modules on the faces of a seventh.
config Star {
  part middle: SmoresEP
  part arm[3]: Pair
  connect middle.top -- arm[0].head
  connect middle.left -- arm[1].head turn 90deg
  connect middle.right -- arm[2].head
}

config Pair {
  part m[2]: SmoresEP
  connect m[0].top -- m[1].bottom
  port head = m[0].bottom
  port tail = m[1].top
}

/// A stem of three modules with two prongs at its sides.
config Fork {
  part stem[3]: SmoresEP
  part prong[2]: Pair
  for i in 0..2 { connect stem[i].top -- stem[i + 1].bottom }
  connect stem[2].left -- prong[0].tail
  connect stem[1].right -- prong[1].head turn 180deg
}

/// The dock of the elbows.
connector Plate { mates Plate, turns 4, capture 1mm 1deg }

/// An elbow with two joints in the middle and a third dock at its side.
module Elbow {
  mass 200g
  link lower = box(30mm, 10mm, 10mm) at [-25mm, 0mm, 0mm]
  link middle = sphere(radius: 1mm, mass: 1g)
  link upper = box(30mm, 10mm, 10mm) at [25mm, 0mm, 0mm]
  joint bend : lower -> middle = revolute(axis: Y, range: -120deg..120deg, max_speed: 90deg/s, max_accel: 360deg/s^2)
  joint lean : middle -> upper = revolute(axis: Z, range: -120deg..120deg, max_speed: 90deg/s, max_accel: 360deg/s^2)
  port tail : Plate on lower at [-15mm, 0mm, 0mm] facing -X up +Z
  port side : Plate on upper at [0mm, 5mm, 0mm] facing +Y up +Z
  port head : Plate on upper at [15mm, 0mm, 0mm] facing +X up +Z
}

/// Elbows that grow from each other's sides.
config Bush {
  part stem[3]: Elbow
  part twig[3]: Elbow
  connect stem[0].head -- stem[1].tail
  connect stem[1].head -- stem[2].tail turn 90deg
  for i in 0..3 { connect stem[i].side -- twig[i].tail }
}
";

fn planned(expression: &str) -> Plan {
    let text = format!("{ROBOTS}\nemit({expression}, \"p.plan.json\")\n");
    plan::file::read(run_clean(&text).text("p.plan.json")).expect("it was written to be read")
}

/// Returns the world poses of all modules at the end, and the bonds that hold, as the ports that they join.
pub fn end(plan: &Plan) -> (Vec<Pose>, Vec<[PortRef; 2]>) {
    let tracks = tracks(plan);
    let (robot, state) = (&tracks.robot, tracks.end());
    let kinematics = Kinematics::new(robot, &state.bonds, robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    let modules = (0..robot.modules.len()).map(|module| kinematics.module_pose(module, &poses));
    (modules.collect(), closed(plan, &state.bonds))
}

/// Returns the bonds of a plan's robot of which `holds` says that they hold, as the ports that they join.
pub fn closed(plan: &Plan, holds: &[bool]) -> Vec<[PortRef; 2]> {
    let bonds = tracks(plan).robot.bonds.iter().zip(holds).filter(|(_, holds)| **holds);
    bonds.map(|(bond, _)| [bond.a, bond.b]).collect()
}

/// Judges a plan, and holds its end to a straight snake: each bond joins the ends of two modules, and every module is at a
/// multiple of the length (m) of one along a line, turned alike.
pub fn is_straight(expression: &str, plan: &Plan, ends: [&str; 2], length: f64) {
    assert!(plan::verify::verify(plan).ok(), "{expression}");
    let robot = &tracks(plan).robot;
    let (poses, bonds) = end(plan);
    assert_eq!(bonds.len(), poses.len() - 1, "{expression}");
    let port = |port: &PortRef| robot.module_type(port.module).ports[port.port].name.clone();
    for [a, b] in &bonds {
        let mut names = [port(a), port(b)];
        names.sort();
        let mut wanted = ends.map(String::from);
        wanted.sort();
        assert_eq!(names, wanted, "{expression}");
    }
    let along = poses[0].rotation * Vec3::x();
    let mut places: Vec<f64> = Vec::new();
    for pose in &poses {
        let away = pose.translation.vector - poses[0].translation.vector;
        let place = away.dot(&along);
        assert!((away - along * place).norm() < 1e-6, "{expression}: {away}");
        assert!(pose.rotation.angle_to(&poses[0].rotation) < 1e-6, "{expression}");
        places.push(place);
    }
    places.sort_by(f64::total_cmp);
    for pair in places.windows(2) {
        assert!((pair[1] - pair[0] - length).abs() < 1e-6, "{expression}: {places:?}");
    }
}

#[test]
fn robots_of_any_modules_unwind_to_straight_snakes() {
    for (expression, ends, length) in [
        ("tosnake(Star)", ["top", "bottom"], 0.08),
        ("tosnake(Fork)", ["top", "bottom"], 0.08),
        ("tosnake(Bush)", ["tail", "head"], 0.08),
    ] {
        is_straight(expression, &planned(expression), ends, length);
    }
}

#[test]
fn the_same_seed_gives_the_same_plan_of_any_modules() {
    let text = || {
        run_clean(&format!("{ROBOTS}\nemit(tosnake(Bush, seed: 5), \"p.plan.json\")\n"))
            .text("p.plan.json")
            .to_owned()
    };
    assert_eq!(text(), text());
}

/// Bonds by the types and ports that they join, counted.
pub fn sorts(plan: &Plan, bonds: &[[PortRef; 2]]) -> BTreeMap<[String; 2], usize> {
    let robot = &tracks(plan).robot;
    let mut sorts = BTreeMap::new();
    for bond in bonds {
        let mut names = bond.map(|port| robot.module_type(port.module).ports[port.port].name.clone());
        names.sort();
        *sorts.entry(names).or_insert(0) += 1;
    }
    sorts
}

#[test]
fn robots_of_any_modules_become_each_other() {
    let there = planned("reconfigure(Star, Fork)");
    assert!(plan::verify::verify(&there).ok());
    let (_, bonds) = end(&there);
    let sort = |names: [&str; 2], count| (names.map(String::from), count);
    let wanted = [sort(["bottom", "right"], 1), sort(["bottom", "top"], 4), sort(["left", "top"], 1)];
    assert_eq!(sorts(&there, &bonds), BTreeMap::from(wanted));
}

#[test]
fn what_modules_lack_is_named() {
    let others = "
use std.mori.Mori
connector Plug { mates Socket }
connector Socket { mates Plug }
module Gendered {
  mass 100g
  link body = box(40mm, 40mm, 40mm)
  port a : Plug on body at [20mm, 0mm, 0mm] facing +X up +Z
  port b : Socket on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
module Block {
  mass 100g
  link body = box(40mm, 40mm, 40mm)
  port a : Plate on body at [20mm, 0mm, 0mm] facing +X up +Z
  port b : Plate on body at [-20mm, 0mm, 0mm] facing -X up +Z
}
";
    for (call, wanted, words) in [
        ("tosnake(Gendered)", code::NOT_COVERED, "no two ports that mate"),
        ("tosnake(Block)", code::NOT_COVERED, "no joint of"),
        ("tosnake(Mori)", code::NOT_COVERED, "are hinges"),
        ("tosnake(Star, budget: 1)", code::NO_WAY, "within the budget: "),
        ("tosnake(Star, gravity: on)", code::NOT_COVERED, "no RoFI module"),
        ("tosnake(Star, collisions: none)", code::NOT_COVERED, "no RoFI module"),
        ("reconfigure(Star, Pair)", code::NO_WAY, "7 modules can't become one of 2"),
        ("reconfigure(Star, Bush)", code::NO_WAY, "7 modules can't become one of 6"),
    ] {
        let text = format!("{ROBOTS}{others}\nprint({call})\n");
        let (observed, _, _) = run(&MapFiles::of(&text), Mode::Run);
        let errors: Vec<_> = observed.diagnostics.iter().filter(|d| d.code == wanted).collect();
        let [error] = errors[..] else { panic!("{call}: {:?}", observed.diagnostics) };
        assert!(error.message.contains(words), "{call}: {}", error.message);
    }
}
