//! Exported files, read here: trajectories and tables are the plan's motion, scenes have its poses.
#![allow(non_snake_case)]

use super::{exported, planned, text};
use crate::dynamics::mjcf::PROGRAMS;
use modl::geometry::pose::shifted;
use modl::geometry::{HeightField, Placed, Pose, Shape, Vec3};
use modl::plan::verify::articulated::base_at;
use modl::plan::{Body, Plan, Tracks};
use modl::robot::Kinematics;
use serde_json::Value;
use std::collections::BTreeMap;

/// Times of a plan at which a trajectory is compared with it.
const TIMES: usize = 1000;

/// The greatest distance of a trajectory from its plan, rad or m.
const TOL: f64 = 1e-9;

fn tracks(plan: &Plan) -> &Tracks {
    plan.body.tracks().expect("the robot has joints")
}

/// The numbers of a joint's name in the plan.
fn joints_by_name(tracks: &Tracks) -> BTreeMap<String, usize> {
    tracks.robot.joints().enumerate().map(|(id, owner)| (tracks.robot.joint_name(owner), id)).collect()
}

/// A point as a controller of ROS reads it: time in s, then position, velocity and acceleration of each joint.
type Point = (f64, [Vec<f64>; 3]);

fn points(file: &Value) -> Vec<Point> {
    let reals = |value: &Value| -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let point = |point: &Value| {
        let time = &point["time_from_start"];
        let of = |key: &str| time[key].as_u64().expect("a whole number");
        let order = ["positions", "velocities", "accelerations"].map(|key| reals(&point[key]));
        (of("sec") as f64 + of("nanosec") as f64 * 1e-9, order)
    };
    file["points"].as_array().expect("a list").iter().map(point).collect()
}

/// Position `joint` at a time by the spline of degree 5 of `joint_trajectory_controller`, from its closed form in powers
/// of time.
fn spline(points: &[Point], joint: usize, t: f64) -> f64 {
    let [(_, only)] = points else { return spline_of_several(points, joint, t) };
    only[0][joint]
}

fn spline_of_several(points: &[Point], joint: usize, t: f64) -> f64 {
    let next = points.partition_point(|point| point.0 <= t).clamp(1, points.len() - 1);
    let ((t0, a), (t1, b)) = (&points[next - 1], &points[next]);
    let ([p0, v0, a0], [p1, v1, a1]) = ([0, 1, 2].map(|k| a[k][joint]), [0, 1, 2].map(|k| b[k][joint]));
    let (T, s) = (t1 - t0, (t - t0).clamp(0.0, t1 - t0));
    let (T2, T3) = (T * T, T * T * T);
    let c3 = (20.0 * (p1 - p0) - (8.0 * v1 + 12.0 * v0) * T - (3.0 * a0 - a1) * T2) / (2.0 * T3);
    let c4 = (30.0 * (p0 - p1) + (14.0 * v1 + 16.0 * v0) * T + (3.0 * a0 - 2.0 * a1) * T2) / (2.0 * T3 * T);
    let c5 = (12.0 * (p1 - p0) - 6.0 * (v1 + v0) * T + (a1 - a0) * T2) / (2.0 * T3 * T2);
    p0 + s * (v0 + s * (a0 / 2.0 + s * (c3 + s * (c4 + s * c5))))
}

#[test]
fn trajectories_are_the_motion_of_the_plan() {
    let own = [
        "use std.smores.Walk4\nlet p = plan(Walk4().walk())",
        "use std.smores.Driver1\nlet p = fastest(plan(Driver1().turn()), reserve: 0.2)",
        "use std.smores.Chain3\nlet c = Chain3()\n\
         let p = plan(follow(c.m[1].tilt, t => 20deg * (1 - cos(180deg/s * t)), for: 2s), world: world(ground: off, gravity: off, dynamics: statics))",
    ];
    for program in PROGRAMS.iter().chain(&own) {
        let plan = planned(program);
        let tracks = tracks(&plan);
        let names = joints_by_name(tracks);
        let mut from: Vec<f64> = tracks.events.iter().map(|event| event.time).filter(|t| *t > 0.0).collect();
        from.insert(0, 0.0);
        from.dedup();
        let files = exported(&plan, "trajectory-json");
        let mut moved = vec![];
        for file in &files {
            let file: Value = serde_json::from_slice(&file.bytes).expect("it is JSON");
            let points = points(&file);
            assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0), "{program}: times increase");
            let joints = file["joint_names"].as_array().expect("a list");
            moved.extend(joints.iter().map(|name| name.as_str().expect("a text").to_owned()));
            if files.len() > 1 {
                continue;
            }
            let last = points.last().expect("there are points").0;
            assert!((last - tracks.duration).abs() < 1e-8, "{program}: it lasts as long as the plan");
            for k in 0..TIMES {
                let t = tracks.duration * (k as f64 + 0.5) / TIMES as f64;
                let state = tracks.state(t).joints;
                for (index, name) in joints.iter().enumerate() {
                    let joint = names[name.as_str().expect("a text")];
                    let follows = joints_that_follow(tracks).contains(&joint);
                    let error = (spline(&points, index, t) - state[joint]).abs();
                    assert!(follows || error < TOL, "{program}: {name} is {error:e} off at {t} s");
                }
            }
        }
        for track in &tracks.tracks {
            let name = tracks.robot.name_of(track.joint);
            assert!(moved.contains(&name), "{program}: {name} moves, and is in no trajectory");
        }
    }
}

/// Joints that follow others, whose positions a state does not hold.
fn joints_that_follow(tracks: &Tracks) -> Vec<usize> {
    let robot = &tracks.robot;
    let mut first = 0;
    let mut all = vec![];
    for module in 0..robot.modules.len() {
        let joints = &robot.module_type(module).joints;
        all.extend((0..joints.len()).filter(|j| joints[*j].mimic.is_some()).map(|j| first + j));
        first += joints.len();
    }
    all
}

#[test]
fn two_topologies_are_two_trajectories_that_meet() {
    let plan = planned(PROGRAMS[0]);
    let tracks = tracks(&plan);
    // The ring opens and closes at two places: a second each, so that the states are open, closed, open and closed.
    let times: Vec<f64> = tracks.events.iter().map(|event| event.time).collect();
    let files = exported(&plan, "trajectory-json");
    let mut changes: Vec<f64> = times.into_iter().filter(|t| *t > 0.0).collect();
    changes.dedup();
    assert_eq!(files.len(), changes.len() + 1);
    assert!(files[0].name == "plan-1.trajectory.json" && files[1].name == "plan-2.trajectory.json");
}

#[test]
fn a_table_of_joints_is_the_plan_at_its_times() {
    let plan = planned("use std.smores.Driver1\nlet p = plan(Driver1().drive(t: 1s))");
    let tracks = tracks(&plan);
    let files = exported(&plan, "csv");
    let lines: Vec<Vec<&str>> =
        text(&files, "plan.csv").lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines[0][0], "time [s]");
    let names = joints_by_name(tracks);
    let columns: Vec<usize> =
        lines[0][1..].iter().map(|head| names[head.strip_suffix(" [rad]").expect("they turn")]).collect();
    assert!(lines.len() as f64 > tracks.duration * 100.0);
    for line in &lines[1..] {
        let row: Vec<f64> = line.iter().map(|cell| cell.parse().expect("a number")).collect();
        let state = tracks.state(row[0]).joints;
        for (value, joint) in row[1..].iter().zip(&columns) {
            assert_eq!(*value, state[*joint]);
        }
    }
    assert_eq!(lines.last().expect("a line")[0].parse::<f64>(), Ok(tracks.duration));
}

#[test]
fn controls_and_docking_have_the_names_of_the_model() {
    let plan = planned(PROGRAMS[0]);
    let files = exported(&plan, "mjcf");
    let model = text(&files, "plan.mjcf.xml");
    let named = |element: &str| -> Vec<String> {
        let lines =
            model.lines().map(str::trim).filter(|line| line.starts_with(&format!("<{element} name=")));
        lines.map(|line| line.split('"').nth(1).expect("a name").replace("&gt;", ">")).collect()
    };
    let actuators = named("position");
    let controls = text(&files, "plan.controls.csv");
    let head: Vec<&str> = controls.lines().next().expect("a head").split(',').collect();
    assert_eq!(head[1..], actuators);
    let constraints = named("weld");
    let tracks = tracks(&plan);
    let docking: Vec<Vec<&str>> =
        text(&files, "plan.docking.csv").lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(docking.len(), tracks.events.len());
    for (row, event) in docking.iter().zip(&tracks.events) {
        assert!(constraints.iter().any(|name| name == row[1]), "{row:?}");
        assert_eq!(row[0].parse::<f64>(), Ok(event.time));
        assert_eq!(row[2] == "1", event.kind == modl::plan::DockingKind::Dock);
    }
}

/// The JSON and the binary part of a GLB file.
fn parts(glb: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four bytes")) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let text = word(12);
    let json = serde_json::from_slice(&glb[20..20 + text]).expect("the first part is JSON");
    (json, glb[28 + text..].to_vec())
}

/// The numbers of an accessor.
fn numbers(json: &Value, binary: &[u8], accessor: &Value) -> Vec<f64> {
    let accessor = &json["accessors"][accessor.as_u64().expect("an index") as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("an index") as usize];
    let of = |key: &str| view[key].as_u64().expect("a number") as usize;
    let bytes = &binary[of("byteOffset")..of("byteOffset") + of("byteLength")];
    bytes.chunks(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().expect("four bytes")))).collect()
}

/// The place of a node of a scene at a time (s): that of its animation, or the one that it has without.
fn place_at(json: &Value, binary: &[u8], node: usize, t: f64) -> Vec3 {
    let still = json["nodes"][node]["translation"].as_array().expect("numbers");
    let mut at = Vec3::from_iterator(still.iter().map(|x| x.as_f64().expect("a number")));
    let animation = &json["animations"][0];
    for channel in animation["channels"].as_array().expect("channels") {
        if channel["target"]["node"] == node as u64 && channel["target"]["path"] == "translation" {
            let sampler = &animation["samplers"][channel["sampler"].as_u64().expect("an index") as usize];
            let times = numbers(json, binary, &sampler["input"]);
            let values = numbers(json, binary, &sampler["output"]);
            let next = times.partition_point(|time| *time <= t).clamp(1, times.len() - 1);
            let part = (t - times[next - 1]) / (times[next] - times[next - 1]);
            let key = |k: usize| Vec3::new(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
            at = key(next - 1) + (key(next) - key(next - 1)) * part;
        }
    }
    at
}

/// A strut is in the middle between the ends that it has at the moment, before and after nodes merge and split.
#[test]
fn struts_of_scenes_have_the_ends_of_the_moment() {
    let example = include_str!("../../examples/merging.mod");
    let plan = planned(&format!("{}\nlet p = ridge", example.replace("emit(ridge", "// emit(ridge")));
    let paths = plan.body.node_paths().expect("a truss's plan");
    let (json, binary) = parts(&exported(&plan, "glb")[0].bytes);
    let mut moved = 0;
    for k in 0..=40 {
        let t = plan.body.duration() * f64::from(k) / 40.0;
        let nodes: Vec<Vec3> = paths.state(t).into_iter().map(Vec3::from).collect();
        for (strut, (a, b)) in paths.struts(t).into_iter().enumerate() {
            let apart = (place_at(&json, &binary, strut + 1, t) - (nodes[a] + nodes[b]) / 2.0).norm();
            assert!(apart < 1e-3, "strut {strut} is {apart} m off at {t} s");
            let first = paths.struts[strut];
            moved += usize::from((nodes[a] + nodes[b] - nodes[first.0] - nodes[first.1]).norm() > 0.1);
        }
    }
    assert!(moved > 10, "with the ends of the start some were elsewhere: {moved}");
}

#[test]
fn scenes_have_a_node_for_each_link_at_its_pose() {
    let plan = planned("use std.smores.Driver1\nlet p = plan(Driver1().drive(t: 1s))");
    let tracks = tracks(&plan);
    let (json, binary) = parts(&exported(&plan, "glb")[0].bytes);
    let nodes = json["nodes"].as_array().expect("nodes");
    let kinematics = Kinematics::new(&tracks.robot, &tracks.bonds(0.0), tracks.robot.base);
    assert_eq!(nodes.len(), kinematics.link_count() + 1);
    let mut farthest = 0.0_f64;
    for k in 0..=20 {
        let t = tracks.duration * f64::from(k) / 20.0;
        let base = base_at(&plan, t).expect("the plan is valid");
        let mut poses = vec![Pose::identity(); kinematics.link_count()];
        kinematics.link_poses(&tracks.state(t).joints, &base, &mut poses);
        for (link, X) in poses.iter().enumerate() {
            let apart = (place_at(&json, &binary, link + 1, t) - X.translation.vector).norm();
            farthest = farthest.max((X.translation.vector - tracks.start.base.translation.vector).norm());
            assert!(apart < 1e-3, "link {link} is {apart} m off at {t} s");
        }
    }
    assert!(farthest > 0.05, "it drives: {farthest}");
}

#[test]
fn obstacles_stand_in_scenes_where_they_are() {
    let plan = planned(
        "use std.smores.Driver1
scene S {
  part d: Driver1
  obstacle wall = box(20mm, 1m, 200mm) at [300mm, 700mm, 100mm] turned(Z, 90deg)
  behavior go = d.drive(t: 300ms)
}
let p = plan(S().go())",
    );
    // A metre along x, 20 mm along y, from the ground to 200 mm.
    still_box(&plan, "wall", [(-0.2, 0.8), (0.69, 0.71), (0.0, 0.2)]);
}

/// Checks that one node of a plan's scene has this name, that nothing moves it, and that it fills a box: by axis the least
/// and the greatest coordinate, m.
fn still_box(plan: &Plan, name: &str, sides: [(f64, f64); 3]) {
    let (json, _) = parts(&exported(plan, "glb")[0].bytes);
    let nodes = json["nodes"].as_array().expect("nodes");
    let named: Vec<usize> = (0..nodes.len()).filter(|node| nodes[*node]["name"] == name).collect();
    let [index] = named[..] else { panic!("one {name}: {nodes:?}") };
    let channels = json["animations"][0]["channels"].as_array();
    assert!(
        channels.is_none_or(|all| all.iter().all(|channel| channel["target"]["node"] != index)),
        "{name}"
    );
    let node = &nodes[index];
    let mesh = &json["meshes"][node["mesh"].as_u64().expect("an index") as usize];
    let points = mesh["primitives"][0]["attributes"]["POSITION"].as_u64().expect("an index") as usize;
    let three = |value: &Value, absent: f64| -> Vec<f64> {
        let stated = value.as_array();
        stated.map_or(vec![absent; 3], |all| all.iter().map(|x| x.as_f64().expect("a number")).collect())
    };
    assert!(node.get("rotation").is_none_or(|turn| *turn == serde_json::json!([0.0, 0.0, 0.0, 1.0])));
    let (moved, scale) = (three(&node["translation"], 0.0), three(&node["scale"], 1.0));
    let bounds = ["min", "max"].map(|side| three(&json["accessors"][points][side], f64::NAN));
    for (axis, (low, high)) in sides.into_iter().enumerate() {
        for (bound, wanted) in bounds.iter().zip([low, high]) {
            let found = bound[axis] * scale[axis] + moved[axis];
            assert!((found - wanted).abs() < 1e-6, "{name}, axis {axis}: {found}, {wanted}");
        }
    }
}

#[test]
fn obstacles_of_lattices_and_trusses_stand_in_scenes() {
    let lattice = planned(
        "use std.crystal.ExpandingCube
lattice Left of ExpandingCube = cells(\"\"\"
  ##.....
  #######
  #######
\"\"\")
lattice Right of ExpandingCube = cells(\"\"\"
  .....##
  #######
  #######
\"\"\")
let wall = cells(\"\"\"
  ...#...
  .......
  .......
\"\"\")
let p = squeeze(Left, Right, fixed: row(7), obstacles: wall)",
    );
    let Body::Stages(stages) = &lattice.body else { panic!("it is a lattice") };
    let size = lattice.library.cells[stages.cell].size;
    still_box(&lattice, "obstacle 0", [3.0, 2.0, 0.0].map(|low| (low * size, (low + 1.0) * size)));
    let mut truss = planned(
        "use std.truss.PneumaticReel
truss Pyramid of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let p = locomote(Pyramid, path: [[0.3m, 0m, 0m]])",
    );
    let Body::NodePaths(paths) = &mut truss.body else { panic!("it is a truss") };
    let shape = Shape::Box { size: Vec3::new(1.0, 2.0, 3.0) };
    paths.surroundings.obstacles = vec![vec![Placed { pose: shifted(Vec3::new(9.0, 8.0, 1.5)), shape }]];
    let flat = HeightField { corner: [-9.0, -9.0], spacing: 18.0, columns: 2, heights: vec![0.0; 4] };
    paths.surroundings.terrain = Some(flat);
    still_box(&truss, "obstacle 1", [(8.5, 9.5), (7.0, 9.0), (0.0, 3.0)]);
    still_box(&truss, "ground", [(-9.0, 9.0), (-9.0, 9.0), (0.0, 0.0)]);
}

#[test]
fn moving_pictures_have_as_many_pictures_as_they_say() {
    let plan = planned("use std.smores.Driver1\nlet p = plan(Driver1().drive(t: 300ms))");
    let files = exported(&plan, "gif");
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(&files[0].bytes[..]).expect("it is a GIF");
    let mut shown = 0;
    let mut all = vec![];
    while let Some(frame) = decoder.read_next_frame().expect("its pictures are whole") {
        shown += u32::from(frame.delay);
        all.push(frame.buffer.to_vec());
    }
    let duration = tracks(&plan).duration;
    assert!(all.len() >= 2 && all.first() != all.last(), "the robot moves");
    assert!((f64::from(shown) / 100.0 - duration).abs() < duration / 2.0 + 0.1, "{shown} of {duration} s");
    assert_eq!(exported(&plan, "frames").len(), all.len());
}
