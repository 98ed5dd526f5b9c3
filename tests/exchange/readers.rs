//! Exported files, read by the programs that they are for: pinocchio, yourdfpy, MuJoCo, PyYAML, mcap (from PyPI) and the
//! validator of glTF (from npm). What is not installed is skipped, with a message.
#![allow(non_snake_case)]

use super::{exported, planned};
use crate::behavior::behaviors_of_designs::BEHAVIORS;
use crate::dynamics::mjcf::{PROGRAMS, random};
use crate::support::numbers::Numbers;
use crate::support::properties::whole;
use modl::exchange::{ExportFile, PlanFormat};
use modl::geometry::Pose;
use modl::plan::verify::verify;
use modl::plan::{DockingKind, Plan, headline};
use modl::robot::{Assembly, JointKind, JointOwner, Kinematics, driven};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Random robots in the gate, and in `.ci/full exchange`.
const FEW: u64 = 6;
const MANY: u64 = 100;
/// Random states of each robot.
const STATES: usize = 3;

fn skipped(what: &str, why: &str) {
    writeln!(std::io::stderr(), "skipped: {what}: {why}").expect("stderr is open");
}

/// A Python with all readers: the one that `MODL_PYTHON` names, or that of the environment that `.ci/run` makes.
fn python() -> Option<PathBuf> {
    let local = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/python/bin/python");
    let python = std::env::var_os("MODL_PYTHON").map_or(local, PathBuf::from);
    let readers = "import pinocchio, mujoco, yourdfpy, mcap, mcap_ros2, yaml";
    let found = Command::new(&python).args(["-c", readers]).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success()).then_some(python)
}

/// Plans of every kind of module: those of the tests of MuJoCo's models, random robots, a folding with hulls and hinges, a
/// scene in which a crate is docked and put down, a snake of RoFI modules; with `MODL_WHOLE=1` the behaviours of `std.smores` and more random robots.
fn plans() -> Vec<(String, Plan)> {
    let whole = whole();
    let own = [
        "use std.smores.Walk4\nlet p = plan(Walk4().walk())",
        "use std.mori.Mori\nuse std.shapes.octahedron\nlet p = fold(octahedron(edge: 80mm), module: Mori)",
        "use std.scenes.Carrier\nlet c = Carrier()\nlet p = plan(Sc(c.take(), c.put()))",
        "use std.rofi.Snake\nlet s = Snake(n: 4)
let p = plan(move(s.m[3].beta, to: 10deg), world: world(ground: off, gravity: off))",
    ];
    let programs = PROGRAMS.iter().chain(&own);
    let mut plans: Vec<(String, Plan)> = programs.map(|p| ((*p).to_owned(), planned(p))).collect();
    let seeds = 0..if whole { MANY } else { FEW };
    plans.extend(seeds.map(|seed| (format!("robot {seed}"), random(seed))));
    if whole {
        plans.extend(BEHAVIORS.iter().map(|(robot, behavior, _)| {
            let program = format!("use std.smores.{robot}\nlet x = {robot}()\nlet p = plan({behavior})");
            (program.clone(), planned(&program))
        }));
    }
    plans
}

/// Writes files below a folder.
fn write(folder: &Path, files: &[ExportFile]) {
    for file in files {
        let path = folder.join(&file.name);
        std::fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder can be made");
        std::fs::write(path, &file.bytes).expect("a file can be written");
    }
}

/// Positions of all joints, random but for those that follow others.
fn positions(robot: &Assembly, numbers: &mut Numbers) -> Vec<f64> {
    let free: Vec<f64> = robot.joints().map(|_| (numbers.next() - 0.5) * 2.0).collect();
    let mut first = 0;
    let mut all = free.clone();
    for module in 0..robot.modules.len() {
        let kind = robot.module_type(module);
        for joint in 0..kind.joints.len() {
            if kind.joints[joint].mimic.is_some() {
                let terms = driven(kind, joint, first);
                all[first + joint] = terms.iter().map(|(joint, factor)| factor * free[*joint]).sum();
            }
        }
        first += kind.joints.len();
    }
    all
}

/// The answers that readers must give of a description of the robot with these bonds: joints, and of each link the orientation and the
/// centre of mass in the frame of the root, by our own kinematics.
fn states(robot: &Assembly, holds: &[bool], root: usize, numbers: &mut Numbers) -> Vec<Value> {
    let kinematics = Kinematics::new(robot, holds, root);
    let state = |_| {
        let joints = positions(robot, numbers);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
        let mut links = BTreeMap::new();
        let mut mass = 0.0;
        for &(module, _) in &kinematics.tree.order {
            for (index, link) in robot.module_type(module).links.iter().enumerate() {
                let X = poses[kinematics.link(module, index)];
                let turn = X.rotation.to_rotation_matrix().matrix().transpose();
                let centre = X.transform_point(&link.com.into());
                let name = format!("{}.{}", robot.modules[module].name, link.name);
                links.insert(
                    name,
                    json!({ "turn": turn.as_slice(), "centre": [centre.x, centre.y, centre.z] }),
                );
                mass += link.mass;
            }
        }
        let named = robot.joints().zip(&joints).filter(|(owner, _)| match owner {
            JointOwner::Module { module, joint } => {
                robot.module_type(*module).joints[*joint].kind != JointKind::Fixed
            }
            JointOwner::Bond(_) => true,
        });
        let joints: BTreeMap<String, f64> = named.map(|(owner, q)| (robot.joint_name(owner), *q)).collect();
        json!({ "joints": joints, "links": links, "mass": mass })
    };
    (0..STATES).map(state).collect()
}

/// The bonds of each topology and the roots of what hangs together, found apart from the writer: events in turn, and what
/// is reached from the base, then from the first module that is not.
fn pieces(plan: &Plan) -> Vec<(Vec<bool>, usize)> {
    let tracks = plan.body.tracks().expect("the robot has joints");
    let mut holds = tracks.start.bonds.clone();
    let mut topologies = vec![];
    let mut at = 0.0;
    for event in &tracks.events {
        if event.time > at {
            topologies.push(holds.clone());
            at = event.time;
        }
        holds[event.bond] = event.kind == DockingKind::Dock;
    }
    topologies.push(holds);
    let mut pieces = vec![];
    for holds in topologies {
        let mut open: Vec<usize> = (0..tracks.robot.modules.len()).collect();
        let mut root = tracks.robot.base;
        loop {
            let tree = Kinematics::new(&tracks.robot, &holds, root).tree;
            open.retain(|module| !tree.order.iter().any(|(reached, _)| reached == module));
            pieces.push((holds.clone(), root));
            match open.first() {
                Some(next) => root = *next,
                None => break,
            }
        }
    }
    pieces
}

#[test]
fn readers_of_robots_trajectories_and_recordings_find_what_the_plan_says() {
    let Some(python) = python() else {
        skipped("exported files in their readers", "no Python with all readers (.ci/run installs it)");
        return;
    };
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let mut numbers = Numbers(24);
    let mut tasks = vec![];
    let mut robots = 0;
    for (index, (name, mut plan)) in plans().into_iter().enumerate() {
        let verdict = verify(&plan);
        let headline = headline(&plan, &verdict);
        plan.verdict = Some(verdict);
        let below = folder.path().join(index.to_string());
        let robot = &plan.body.tracks().expect("the robot has joints").robot;
        let export = modl::exchange::Export::new(&plan, "robot", "plan");
        let mut urdfs = vec![];
        if let Ok(files) = PlanFormat::named("urdf").expect("it is a format").write(&export) {
            robots += 1;
            write(&below, &files);
            let written: Vec<&ExportFile> =
                files.iter().filter(|file| file.name.ends_with(".urdf")).collect();
            let pieces = pieces(&plan);
            if written.len() == pieces.len() {
                for (file, (holds, root)) in written.iter().zip(pieces) {
                    let states = states(robot, &holds, root, &mut numbers);
                    urdfs.push(json!({ "path": below.join(&file.name), "states": states }));
                }
            }
            // A piece that goes on over a change of bonds elsewhere is written once.
            assert!(
                !urdfs.is_empty() || written.len() < self::pieces(&plan).len(),
                "{name}: a file for each piece"
            );
        } else {
            let closes = pieces(&plan)
                .iter()
                .any(|(holds, root)| !Kinematics::new(robot, holds, *root).tree.closing.is_empty());
            assert!(closes, "{name}: only closed loops are refused");
        }
        let mut trajectories = vec![];
        for format in ["trajectory", "trajectory-json"] {
            let files = exported(&plan, format);
            write(&below, &files);
            trajectories = files.iter().map(|file| below.join(file.name.replace(".json", ""))).collect();
        }
        write(&below, &exported(&plan, "mcap"));
        tasks.push(json!({
            "name": name, "urdfs": urdfs, "trajectories": trajectories,
            "recording": below.join("plan.mcap"), "headline": headline,
        }));
    }
    assert!(robots >= 10, "most robots have descriptions: {robots}");
    let task = folder.path().join("task.json");
    std::fs::write(&task, json!(tasks).to_string()).expect("a file can be written");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/exchange/readers.py");
    let ran = Command::new(python).arg(script).arg(&task).output().expect("Python runs, it has before");
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(ran.status.success() && said.is_empty(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
}

const VALIDATE: &str = "
const { createRequire } = require('module');
const validator = createRequire(process.argv[1] + '/')('gltf-validator');
const fs = require('fs');
(async () => {
  for (const file of process.argv.slice(2)) {
    const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    if (issues.numErrors + issues.numWarnings > 0) console.log(file, JSON.stringify(issues.messages.slice(0, 3)));
  }
})();
";

/// Recordings in Rerun's own importer (the wheel `rerun-sdk`): it finds no fault, and draws what it has a picture for.
#[test]
fn rerun_shows_what_recordings_hold() {
    let rerun = python().map(|python| python.with_file_name("rerun")).filter(|rerun| rerun.is_file());
    let Some(rerun) = rerun else {
        skipped("recordings in Rerun", "it is not installed (.ci/full exchange installs it)");
        return;
    };
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    for (index, (name, mut plan)) in plans().into_iter().enumerate() {
        let verdict = verify(&plan);
        plan.verdict = Some(verdict);
        let path = folder.path().join(format!("{index}.mcap"));
        std::fs::write(&path, &exported(&plan, "mcap")[0].bytes).expect("a file can be written");
        let shown = folder.path().join(format!("{index}.rrd"));
        let run = |arguments: &[&std::ffi::OsStr]| {
            let mut command = Command::new(&rerun);
            command.args(arguments).env("NO_COLOR", "1").env("RUST_LOG", "error");
            let ran = command.output().expect("rerun runs");
            let said =
                format!("{}{}", String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
            assert!(ran.status.success() && !said.contains("ERROR"), "{name}: {said}");
            said
        };
        let checked = run(&["mcap".as_ref(), "check".as_ref(), path.as_ref()]);
        let topics: Vec<&str> = checked.lines().filter(|line| line.contains("  /")).collect();
        let sound = topics.len() >= 4 && topics.iter().all(|line| line.starts_with("ok "));
        assert!(sound, "{name}: {checked}");
        run(&["mcap".as_ref(), "convert".as_ref(), path.as_ref(), "-o".as_ref(), shown.as_ref()]);
        let holds = run(&["rrd".as_ref(), "print".as_ref(), shown.as_ref()]);
        for part in ["TextLog:text", "Transform3D:translation", "/joint_states/position"] {
            assert!(holds.contains(part), "{name}: no {part}");
        }
    }
}

#[test]
fn the_validator_of_gltf_finds_no_fault_in_scenes() {
    let local = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/gltf");
    let folder = std::env::var_os("MODL_GLTF").map_or(local, PathBuf::from);
    if !folder.join("node_modules/gltf-validator").is_dir() {
        skipped("scenes in the validator of glTF", "it is not installed (.ci/full exchange installs it)");
        return;
    }
    let written = tempfile::TempDir::new().expect("a temporary folder");
    let mut files = vec![];
    let others = [
        "use std.crystal.ExpandingCube\nlattice A of ExpandingCube = row(4)\nlattice B of ExpandingCube = column(4)\nlet p = squeeze(A, B)",
    ];
    let others = others.iter().map(|program| ((*program).to_owned(), planned(program)));
    for (index, (_, plan)) in plans().into_iter().chain(others).enumerate() {
        let path = written.path().join(format!("{index}.glb"));
        std::fs::write(&path, &exported(&plan, "glb")[0].bytes).expect("a file can be written");
        files.push(path);
    }
    let ran = Command::new("node").args(["-e", VALIDATE]).arg(&folder).args(&files).output();
    let ran = ran.expect("node runs");
    let said = String::from_utf8_lossy(&ran.stdout);
    assert!(ran.status.success() && said.is_empty(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
}
