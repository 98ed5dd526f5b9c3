//! The designs of `std.smores` against `truth/smores.json`, which was computed from the authors' own
//! data: poses of the modules, centre of mass, contacts and the margins of both stability rules.
//!
//! The designs are reached through the language: a configuration with one part and the pose's joint
//! positions, whose plan is read back from the file that it is written to.

use crate::support::desk::run_clean;
use modl::geometry::Pose;
use modl::plan::{Body, Plan, file};
use modl::robot::Kinematics;
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use serde_json::Value;
use std::sync::LazyLock;

static TRUTH: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(include_str!("../truth/smores.json")).expect("the truth is JSON"));

/// Names of modules in the truth, and their paths in the library's design.
type Names = &'static [(&'static str, &'static str)];

/// A design of the truth: its name there, how the library makes it, and the path of each of its
/// modules under the names of the truth.
const DESIGNS: &[(&str, &str, Names)] = &[
    ("DRIVER1", "Driver1", &[("m", "m")]),
    ("CHAIN3", "Chain3", &[("head", "m[0]"), ("mid", "m[1]"), ("tail", "m[2]")]),
    ("LEG3", "Leg3", &[("hip", "thigh"), ("knee", "shin"), ("ankle", "foot")]),
    ("STEER3", "Steer3", &[("front", "front"), ("center", "center"), ("back", "back")]),
    ("PUMA4", "Puma4", &[("a0", "waist"), ("a1", "upper"), ("a2", "fore"), ("a3", "hand")]),
    ("CLIMBER4", "Climber4", &[("c1", "c[0]"), ("c2", "c[1]"), ("c3", "c[2]"), ("c4", "c[3]")]),
    (
        "GRASPER7",
        "Grasper7",
        &[
            ("m", "m"),
            ("ls", "l[0]"),
            ("le", "l[1]"),
            ("lw", "l[2]"),
            ("rs", "r[0]"),
            ("re", "r[1]"),
            ("rw", "r[2]"),
        ],
    ),
    (
        "WALK4",
        "Walk4",
        &[
            ("b0", "body.front"),
            ("b1", "body.core"),
            ("b2", "body.back"),
            ("fl_hip", "leg[0].thigh"),
            ("fl_knee", "leg[0].shin"),
            ("fl_ankle", "leg[0].foot"),
            ("fr_hip", "leg[1].thigh"),
            ("fr_knee", "leg[1].shin"),
            ("fr_ankle", "leg[1].foot"),
            ("bl_hip", "leg[2].thigh"),
            ("bl_knee", "leg[2].shin"),
            ("bl_ankle", "leg[2].foot"),
            ("br_hip", "leg[3].thigh"),
            ("br_knee", "leg[3].shin"),
            ("br_ankle", "leg[3].foot"),
        ],
    ),
    (
        "CAR",
        "Car",
        &[
            ("center", "steer.center"),
            ("front", "steer.front"),
            ("back", "steer.back"),
            ("fl", "wheel[0].m"),
            ("fr", "wheel[1].m"),
            ("bl", "wheel[2].m"),
            ("br", "wheel[3].m"),
        ],
    ),
    (
        "DRIVER5",
        "Driver5",
        &[
            ("center", "steer.center"),
            ("front", "steer.front"),
            ("back", "steer.back"),
            ("bl", "wheel[0].m"),
            ("br", "wheel[1].m"),
        ],
    ),
    (
        "TANK7",
        "Tank7",
        &[
            ("mid", "steer.center"),
            ("front", "steer.front"),
            ("back", "steer.back"),
            ("fl", "arm[0]"),
            ("fr", "arm[1]"),
            ("bl", "arm[2]"),
            ("br", "arm[3]"),
        ],
    ),
    (
        "MOBMANIP8",
        "MobManip8",
        &[
            ("m", "m"),
            ("ld", "wheel[0]"),
            ("rd", "wheel[1]"),
            ("fs", "support"),
            ("ag", "arm[0]"),
            ("al", "arm[1]"),
            ("an", "arm[2]"),
            ("ee", "arm[3]"),
        ],
    ),
    ("BACKHOE11", "Backhoe(4)", BACKHOE),
    ("BACKHOE14", "Backhoe(7)", BACKHOE),
    ("BACKHOE17", "Backhoe(10)", BACKHOE),
    (
        "DRIVER5_PUMA4",
        "Driver5Puma4",
        &[
            ("center", "car.steer.center"),
            ("front", "car.steer.front"),
            ("back", "car.steer.back"),
            ("bl", "car.wheel[0].m"),
            ("br", "car.wheel[1].m"),
            ("a0", "arm.waist"),
            ("a1", "arm.upper"),
            ("a2", "arm.fore"),
            ("a3", "arm.hand"),
        ],
    ),
];

const BACKHOE: Names = &[
    ("center", "car.steer.center"),
    ("front", "car.steer.front"),
    ("back", "car.steer.back"),
    ("fl", "car.wheel[0].m"),
    ("fr", "car.wheel[1].m"),
    ("bl", "car.wheel[2].m"),
    ("br", "car.wheel[3].m"),
    ("a0", "arm.m[0]"),
    ("a1", "arm.m[1]"),
    ("a2", "arm.m[2]"),
    ("a3", "arm.m[3]"),
    ("a4", "arm.m[4]"),
    ("a5", "arm.m[5]"),
    ("a6", "arm.m[6]"),
    ("a7", "arm.m[7]"),
    ("a8", "arm.m[8]"),
    ("a9", "arm.m[9]"),
];

/// SNAKE18 is named by number: module 3 i + j is `seg[i].m[j]`.
fn path_of(design: &str, module: &str) -> String {
    if design == "SNAKE18" {
        let n: usize = module[1..].parse().expect("s0 to s17");
        return format!("seg[{}].m[{}]", n / 3, n % 3);
    }
    let (_, _, names) = DESIGNS.iter().find(|(name, _, _)| *name == design).expect("a known design");
    let path = names.iter().find(|(name, _)| *name == module).expect("a known module").1;
    path.to_string()
}

/// Every design and pose of the truth: name, how the library makes it, pose.
fn poses() -> impl Iterator<Item = (&'static str, &'static str, &'static Value)> {
    let made = DESIGNS.iter().map(|(name, made, _)| (*name, *made)).chain([("SNAKE18", "Snake18")]);
    made.flat_map(|(name, made)| {
        let poses = TRUTH["proposed_designs"]["designs"][name]["poses"].as_array().expect("poses");
        poses.iter().map(move |pose| (name, made, pose))
    })
}

/// A program in whose configuration `T` the design stands in the pose.
fn program(name: &str, made: &str, pose: &Value) -> String {
    let library = made.split('(').next().expect("a name");
    let mut text = format!("use std.smores.{library}\nconfig T {{\n  part c: {made}\n");
    // The library's designs may stand in a pose of their own: every joint is set, those that the
    // pose does not name to zero.
    let first = &pose["chassis_pose_in_first_module"];
    for module in first.as_object().expect("modules").keys() {
        for (theirs, ours) in [("L", "left"), ("R", "right"), ("T_pan", "front"), ("B_tilt", "tilt")] {
            let degrees = pose["state_deg"][module][theirs].as_f64().unwrap_or(0.0);
            text.push_str(&format!("  set c.{}.{ours} = {degrees}deg\n", path_of(name, module)));
        }
    }
    let any = first.as_object().expect("modules").keys().next().expect("a module");
    let base = expected_first(pose);
    text.push_str(&format!("  base c.{}\n", path_of(name, base)));
    text.push_str(&format!("  behavior hold = move(c.{}.tilt, by: 0deg, in: 1ms)\n}}\n", path_of(name, any)));
    text
}

/// The module that stands at the origin of the truth's poses.
fn expected_first(pose: &Value) -> &str {
    let modules = pose["chassis_pose_in_first_module"].as_object().expect("modules");
    let first = modules.iter().find(|(_, p)| pose_from(p).translation.vector.norm() < 1e-12);
    first.expect("one module is the first").0
}

fn floating(name: &str, made: &str, pose: &Value) -> Plan {
    let text = program(name, made, pose)
        + "emit(plan(T().hold(), world: world(ground: off, gravity: off)), \"t.plan.json\")\n";
    let desk = run_clean(&text);
    file::read(desk.text("t.plan.json")).expect("a sound plan file")
}

#[test]
fn modules_stand_where_the_truth_has_them() {
    for (name, made, pose) in poses() {
        let plan = floating(name, made, pose);
        let Body::Tracks(tracks) = &plan.body else { panic!("a robot has tracks") };
        let robot = &tracks.robot;
        let kinematics = Kinematics::new(robot, &tracks.start.bonds, robot.base);
        let mut links = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&tracks.start.joints, &Pose::identity(), &mut links);
        let expected = pose["chassis_pose_in_first_module"].as_object().expect("modules");
        assert_eq!(expected.len(), robot.modules.len(), "{name}");
        let pose_of = |module: &str| {
            let path = format!("c.{}", path_of(name, module));
            let index = robot.modules.iter().position(|m| m.name == path);
            kinematics.module_pose(index.unwrap_or_else(|| panic!("{name} has no {path}")), &links)
        };
        let first = pose_of(expected_first(pose));
        for (module, p) in expected {
            let (want, have) = (pose_from(p), first.inverse() * pose_of(module));
            let apart = want.inverse() * have;
            // The truth is printed with nine decimals; an angle is twice as sensitive as a quaternion.
            assert!(apart.translation.vector.norm() < 3e-9, "{name} {} {module}: {apart}", pose["pose"]);
            assert!(apart.rotation.angle() < 3e-8, "{name} {} {module}: {apart}", pose["pose"]);
        }
    }
}

fn pose_from(p: &Value) -> Pose {
    let numbers = |key: &str| -> Vec<f64> {
        p[key].as_array().expect("numbers").iter().map(|v| v.as_f64().expect("a number")).collect()
    };
    let (t, q) = (numbers("position"), numbers("quat_wxyz"));
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
    Pose::from_parts(Translation3::new(t[0], t[1], t[2]), rotation)
}

/// In millimetres: the margin on the ground that holds the first module upright by the footprint and
/// by the paper's rule, and the centre of mass along the ground.
struct Judged {
    footprint: f64,
    centres: f64,
    com: [f64; 2],
}

fn judged(name: &str, made: &str, pose: &Value) -> Judged {
    let text = program(name, made, pose)
        + "let held = world(ground: fixed)\n\
           print(verify(T(), world: held).margin)\n\
           print(verify(T(), world: held, stability: centres).margin)\n\
           print(com(T()).x)\nprint(com(T()).y)\n";
    let desk = run_clean(&text);
    let values: Vec<f64> = desk.printed.iter().map(|line| millimetres(line)).collect();
    let [footprint, centres, x, y] = values[..] else { panic!("four values: {values:?}") };
    Judged { footprint, centres, com: [x, y] }
}

/// A length as `print` shows it.
fn millimetres(text: &str) -> f64 {
    let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("no length: {text}"));
    if text == "infinite" {
        return f64::INFINITY;
    }
    match text.strip_suffix("mm") {
        Some(text) => number(text),
        None => number(text.trim_end_matches('m')) * 1e3,
    }
}

/// How far the footprints may be apart, mm. The truth has the wheels as polygons and takes every corner
/// within the contact tolerance of the ground, so its wheels touch up to sqrt(2 R t - t²) before and
/// behind their lowest point (R = 45.3, t = 4); here wheels are exact circles and touch at that point.
const FOOTPRINT_APART: f64 = 18.62;

/// LEG3 lifted rests on a disc 3.8 mm below the wheels, within 0.2 mm of the contact tolerance: whether
/// the wheels touch is decided by the corners of the truth's polygons.
const UNDECIDED: (&str, &str) = ("LEG3", "lift");

#[test]
fn margins_and_centres_of_mass_are_those_of_the_truth() {
    let mut wrong = String::new();
    for (name, made, pose) in poses() {
        let have = judged(name, made, pose);
        let shown = pose["pose"].as_str().expect("a name");
        let millimetres = |v: &Value| v.as_f64().map(|m| m * 1e3);
        let mut compare = |what: &str, have: f64, want: f64, within: f64| {
            if (have - want).abs() > within {
                wrong.push_str(&format!("{name} {shown}: {what} {have}, in the truth {want}\n"));
            }
        };
        // The truth is printed to a micrometre, and so is what the program prints.
        for (axis, have) in have.com.iter().enumerate() {
            let want = millimetres(&pose["com_after_raise_m"][axis]).expect("a number");
            compare("centre of mass", *have, want, 2e-3);
        }
        // The paper's rule: exact inside. Outside, the truth measures to the lines through the edges and
        // we to the hull itself, which is not nearer.
        if let Some(want) = millimetres(&pose["paper_rule"]["margin_m"]) {
            match want < 0.0 {
                true => compare("centres", have.centres.min(want), have.centres, 0.0),
                false => compare("centres", have.centres, want, 2e-3),
            }
        }
        if let Some(want) = millimetres(&pose["footprint_fixed_root"]["margin_m"])
            && (name, shown) != UNDECIDED
        {
            compare("footprint", have.footprint, want, FOOTPRINT_APART);
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
