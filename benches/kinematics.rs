//! Forward kinematics and the collision judge, beside pinocchio and coal on the same robots, parts,
//! pairs and states in the same run.
//!
//! `cargo bench --bench kinematics`. The other libraries are used if `MODL_PYTHON` or
//! `target/python/bin/python` has them (`.ci/run` makes that environment).

#![allow(non_snake_case)]

mod beside_pinocchio;

use beside_pinocchio::{fastest, support, urdf};
use modl::geometry::{Placed, Pose, Shape};
use modl::plan::verify::articulated::Precision;
use modl::plan::verify::articulated::collision::judge;
use modl::plan::{CauseId, Segment, Settings, Track, Tracks};
use modl::robot::{Assembly, JointId, Kinematics};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::hint::black_box;
use support::robots;

fn main() {
    place();
    let mut tasks = Vec::new();
    for (name, tracks) in [("WALK4 walking", walking()), ("snake of 100", slithering(100))] {
        let rate = verify(name, &tracks);
        tasks.push((name, rate, task(&tracks)));
    }
    verify("snake of 300", &slithering(300));
    let Some(python) = urdf::python() else {
        println!("no Python with pinocchio: nothing to stand beside");
        return;
    };
    for (name, rate, task) in tasks {
        let theirs = urdf::run(&python, COLLISIONS, &task);
        let (states, seconds) = (theirs["states"].as_f64(), theirs["seconds"].as_f64());
        let (states, seconds) = (states.expect("a count"), seconds.expect("a time"));
        let (pairs, hits) = (&theirs["pairs"], &theirs["hits"]);
        let factor = rate * seconds / states;
        println!(
            "{name:<16} pinocchio+coal {:10.0} states/s  ({pairs} pairs, {hits} in collision): x{factor:.1}",
            states / seconds
        );
    }
}

/// All four joints of every module move from one call to the next.
fn place() {
    for robot in [robots::chain(1), robots::walk4(), robots::snake(100), robots::snake(300)] {
        let kinematics = Kinematics::new(&robot, &vec![true; robot.bonds.len()], robot.base);
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        let mut joints = vec![0.0; robot.joints().count()];
        let rounds = 300_000 / robot.modules.len();
        let least = fastest(1, || {
            for round in 0..rounds {
                let q = round as f64 * 1e-4;
                joints.iter_mut().enumerate().for_each(|(i, joint)| *joint = q + i as f64 * 1e-3);
                kinematics.link_poses(black_box(&joints), &Pose::identity(), &mut poses);
                black_box(&poses);
            }
        });
        let each = least * 1e9 / (rounds * robot.modules.len()) as f64;
        println!("forward kinematics, {:3} modules: {each:6.1} ns per module", robot.modules.len());
    }
}

/// States are counted at the default sampling; that every instant between them is judged too comes free.
fn verify(name: &str, tracks: &Tracks) -> f64 {
    let settings = Settings::default();
    let mut stretches = 0;
    let least = fastest(1, || {
        let found = judge(tracks, &settings, &[], &Precision::default()).expect("sound shapes");
        assert!(found.collisions.is_empty(), "{name} collides: {:?}", found.collisions);
        stretches = found.samples;
    });
    let states = tracks.duration / settings.sample;
    let rate = states / least;
    println!("{name:<16} modl           {rate:10.0} states/s  ({stretches} stretches for {states} states)");
    rate
}

fn plan(robot: Assembly, motions: Vec<(usize, Vec<Segment>)>, duration: f64) -> Tracks {
    let mut start = robots::at_rest(&robot);
    motions.iter().for_each(|(joint, segments)| start.joints[*joint] = segments[0].control[0]);
    let track = |(joint, segments)| Track { joint: JointId(joint as u32), segments };
    let tracks = motions.into_iter().map(track).collect();
    Tracks { tracks, duration, ..Tracks::at_rest(robot, start) }
}

/// The amplitude of a motion at a time (s), as a part of that at the start: it grows by a ten-thousandth a second, so that no
/// cycle repeats another. The judge examines a cycle that repeats once, and the peer examines it every time.
fn amplitude(time: f64) -> f64 {
    1.0 + 1e-4 * time
}

/// Two diagonal pairs of legs lift, swing and stand in turn; one step takes a second.
fn walking() -> Tracks {
    const STEPS: usize = 8;
    let robot = robots::walk4();
    let index = |name: &str| robot.modules.iter().position(|m| m.name == name).expect("a module of WALK4");
    let smooth = |start: f64, end: f64, from: f64, to: f64| Segment {
        start,
        end,
        control: vec![from, from, from, to, to, to],
        cause: CauseId(0),
    };
    let mut motions = Vec::new();
    for (leg, (body, side)) in [
        ("fl", ("b0", robots::L)),
        ("br", ("b2", robots::R)),
        ("fr", ("b0", robots::R)),
        ("bl", ("b2", robots::L)),
    ] {
        let late = if matches!(leg, "fl" | "br") { 0.0 } else { 1.0 };
        let lift = |angle: f64| -> Vec<Segment> {
            let steps = (0..STEPS).filter(|step| (step % 2) as f64 == late);
            let up_and_down = steps.flat_map(|step| {
                let t = step as f64;
                let angle = angle * amplitude(t);
                [smooth(t, t + 0.5, 0.0, angle), smooth(t + 0.5, t + 1.0, angle, 0.0)]
            });
            up_and_down.collect()
        };
        let swing: Vec<Segment> = (0..STEPS)
            .map(|step| {
                let sign = if (step % 2) as f64 == late { 1.0 } else { -1.0 };
                smooth(step as f64, step as f64 + 1.0, -0.2 * sign, 0.2 * sign)
            })
            .collect();
        let hip = 4 * index(&format!("{leg}_hip")) + robots::TILT;
        motions.push((hip, vec![smooth(0.0, 0.1, -FRAC_PI_2, -FRAC_PI_2)]));
        motions.push((4 * index(&format!("{leg}_knee")) + robots::TILT, lift(0.6)));
        motions.push((4 * index(&format!("{leg}_ankle")) + robots::TILT, lift(-0.6)));
        motions.push((4 * index(body) + if side == robots::L { robots::LEFT } else { robots::RIGHT }, swing));
    }
    motions.sort_by_key(|(joint, _)| *joint);
    plan(robot, motions, STEPS as f64)
}

/// A wave runs along the snake; every tilt moves all the time. A track is cubics of a tenth of a second.
fn slithering(n: usize) -> Tracks {
    const DURATION: f64 = 4.0;
    const STEP: f64 = 0.1;
    let motions = (0..n).map(|module| {
        let phase = |t: f64| TAU * (t / 2.0 - module as f64 / 10.0);
        let at = |t: f64| 0.35 * amplitude(t) * libm::sin(phase(t));
        let rate = |t: f64| 0.35 * amplitude(t) * TAU / 2.0 * libm::cos(phase(t));
        let segments = (0..(DURATION / STEP) as usize).map(|i| {
            let (start, end) = (i as f64 * STEP, (i + 1) as f64 * STEP);
            let (p, q) = (at(start), at(end));
            let control = vec![p, p + rate(start) * STEP / 3.0, q - rate(end) * STEP / 3.0, q];
            Segment { start, end, control, cause: CauseId(0) }
        });
        (4 * module + robots::TILT, segments.collect())
    });
    plan(robots::snake(n), motions.collect(), DURATION)
}

/// The robot, its parts and states for the other libraries: the same pairs are exempt.
fn task(tracks: &Tracks) -> Value {
    let robot = &tracks.robot;
    let kinematics = Kinematics::new(robot, &tracks.start.bonds, robot.base);
    let urdf = urdf::Urdf::new(robot, &kinematics);
    let mut parts = Vec::new();
    let mut exempt = Vec::new();
    for module in 0..robot.modules.len() {
        let kind = robot.module_type(module);
        for (index, link) in kind.links.iter().enumerate() {
            let link_index = kinematics.link(module, index);
            parts.extend(link.collides.iter().map(|placed| part(link_index, &urdf.X_UL[link_index], placed)));
        }
        exempt.extend(
            kind.joints.iter().map(|j| [kinematics.link(module, j.parent), kinematics.link(module, j.child)]),
        );
    }
    exempt.extend(robot.bonds.iter().map(|bond| {
        [bond.a, bond.b].map(|p| kinematics.link(p.module, robot.module_type(p.module).ports[p.port].link))
    }));
    const STATES: usize = 40;
    let states: Vec<Vec<f64>> =
        (0..STATES).map(|i| tracks.state(tracks.duration * i as f64 / STATES as f64).joints).collect();
    json!({ "urdf": urdf.text, "joints": urdf.joints, "parts": parts, "exempt": exempt, "states": states })
}

fn part(link: usize, X_UL: &Pose, placed: &Placed) -> Value {
    let pose = X_UL * placed.pose;
    let (kind, numbers, pose) = match &placed.shape {
        Shape::Box { size } => ("box", vec![[size.x, size.y, size.z]], pose),
        Shape::Cylinder { radius, length, axis } => {
            let along = nalgebra::UnitQuaternion::rotation_between(&nalgebra::Vector3::z(), axis);
            ("cylinder", vec![[*radius, *length, 0.0]], pose * along.expect("no axis is -z"))
        }
        Shape::Hull { points } => ("hull", points.iter().map(|p| [p.x, p.y, p.z]).collect(), pose),
        _ => unreachable!("SMORES has no other shapes"),
    };
    let pose: Vec<f64> = pose.to_homogeneous().transpose().iter().copied().collect();
    json!({ "link": link, "kind": kind, "numbers": numbers, "pose": pose })
}

const COLLISIONS: &str = r#"
import json, sys, time, numpy as np, pinocchio as pin, coal
task = json.load(sys.stdin)
model = pin.buildModelFromXML(task["urdf"])
geometry = pin.GeometryModel()
links = []
for i, part in enumerate(task["parts"]):
    frame = model.getFrameId("l%d" % part["link"])
    pose = np.array(part["pose"]).reshape(4, 4)
    n = part["numbers"]
    if part["kind"] == "box":
        shape = coal.Box(*n[0])
    elif part["kind"] == "cylinder":
        shape = coal.Cylinder(n[0][0], n[0][1])
    else:
        points = coal.StdVec_Vec3s()
        for p in n:
            points.append(np.array(p))
        shape = coal.Convex.convexHull(points, True, "Qt")
    placement = model.frames[frame].placement * pin.SE3(pose[:3, :3], pose[:3, 3])
    joint = model.frames[frame].parentJoint
    geometry.addGeometryObject(pin.GeometryObject("p%d" % i, joint, frame, placement, shape))
    links.append(part["link"])
links = np.array(links)
active = np.triu(links[:, None] != links[None, :])
for a, b in task["exempt"]:
    active &= ~(((links[:, None] == a) & (links[None, :] == b)) | ((links[:, None] == b) & (links[None, :] == a)))
geometry.setCollisionPairs(active)
data, gdata = model.createData(), geometry.createData()
states = []
for state in task["states"]:
    q = pin.neutral(model)
    for name, value in zip(task["joints"], state):
        q[model.joints[model.getJointId(name)].idx_q] = value
    states.append(q)
best, hits = float("inf"), 0
for _ in range(3):
    hits = 0
    begin = time.perf_counter()
    for q in states:
        hits += pin.computeCollisions(model, data, geometry, gdata, q, False)
    best = min(best, time.perf_counter() - begin)
json.dump({"states": len(states), "seconds": best, "pairs": len(geometry.collisionPairs), "hits": hits}, sys.stdout)
"#;
