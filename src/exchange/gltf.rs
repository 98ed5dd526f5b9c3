//! Plans as animated scenes in glTF 2.0, in one binary file (GLB): a node for each link, cell or strut, for each
//! obstacle, and for ground that is not flat.

use super::export::{Export, ExportFile};
use super::refusal::Refusal;
use crate::geometry::{Placed, Pose, Shape, Vec3};
use crate::plan::verify::articulated::LinkPaths;
use crate::plan::{NodePaths, Plan, Stages, Tracks};
use crate::robot::Library;
use crate::view::{Triangle, link_colours, surrounding_solids, triangles};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The samples of a motion a second, besides those where its law changes.
const RATE: f64 = 30.0;
/// The greatest number of samples of the nodes of a scene, all together: of a longer or larger one there are fewer.
const SAMPLES_MAX: usize = 1_000_000;
/// The greatest number of nodes.
const NODES_MAX: usize = 100_000;
/// The distance of a position (m), scale (1) or part of a quaternion (1) from the straight line between its neighbours
/// within which a sample is left out.
const STRAIGHT: f64 = 2e-5;
/// The radius of a strut, in parts of its least length.
const STRUT_RADIUS: f64 = 0.015;

/// The colour of obstacles and of ground that is not flat: red, green and blue, linear, 0..1.
const AROUND: [f64; 3] = [0.55, 0.53, 0.49];

/// The place of a node at a time: position, orientation, and scale along the axes of its mesh.
#[derive(Clone, Copy, PartialEq)]
struct Place {
    pose: Pose,
    scale: Vec3,
}

/// A node with its mesh, by index.
struct Node {
    name: String,
    mesh: usize,
}

/// A scene before it is written: meshes as (index of the geometry, colour).
struct Scene {
    geometries: Vec<Vec<Triangle>>,
    meshes: Vec<(usize, [f64; 3])>,
    nodes: Vec<Node>,
    times: Vec<f64>,
    /// The places of all nodes at each time.
    places: Vec<Vec<Place>>,
}

impl Scene {
    /// Adds bodies that stand still, each as its name and its shapes in the world.
    fn surround<'a>(&mut self, bodies: impl Iterator<Item = (String, &'a [Placed])>) {
        let before = self.nodes.len();
        for (name, shapes) in bodies {
            let drawn = triangles(shapes);
            // A mesh of the format has corners.
            if !drawn.is_empty() {
                self.meshes.push((self.geometries.len(), AROUND));
                self.geometries.push(drawn);
                self.nodes.push(Node { name, mesh: self.meshes.len() - 1 });
            }
        }
        let still = Place { pose: Pose::identity(), scale: Vec3::repeat(1.0) };
        for places in &mut self.places {
            places.extend(std::iter::repeat_n(still, self.nodes.len() - before));
        }
    }
}

/// Returns the scene of a plan as a GLB file.
///
/// # Errors
/// [`Refusal::TooMany`] for a robot of too many links, cells or struts.
pub(super) fn write(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let plan = export.plan;
    let scene = match &plan.body {
        crate::plan::Body::Tracks(tracks) => links(plan, tracks)?,
        crate::plan::Body::Stages(stages) => cells(plan, stages, &plan.library)?,
        crate::plan::Body::NodePaths(paths) => struts(plan, paths)?,
    };
    Ok(vec![ExportFile { name: format!("{}.glb", export.stem), bytes: glb(&scene, export.title) }])
}

/// Returns the times of a scene of some nodes, s.
///
/// # Errors
/// [`Refusal::TooMany`] for too many nodes.
fn times(plan: &Plan, what: &'static str, nodes: usize) -> Result<Vec<f64>, Refusal> {
    if nodes > NODES_MAX {
        return Err(Refusal::TooMany { what, count: nodes, most: NODES_MAX });
    }
    let duration = plan.body.duration();
    let most = (SAMPLES_MAX / nodes.max(1)).max(2);
    let steps = ((duration * RATE).ceil() as usize).clamp(1, most);
    let mut times: Vec<f64> = (0..=steps).map(|k| duration * k as f64 / steps as f64).collect();
    let instants = plan.body.instants();
    if instants.len() <= most {
        times.extend(instants);
    }
    times.sort_by(f64::total_cmp);
    // Times are written in single precision, and have to increase there.
    times.dedup_by_key(|t| *t as f32);
    Ok(times)
}

/// Returns the scene of articulated robots among their obstacles.
fn links(plan: &Plan, tracks: &Tracks) -> Result<Scene, Refusal> {
    let robot = &tracks.robot;
    let names = super::names::Names::of(robot).links;
    let times = times(plan, "links", names.len())?;
    let mut geometry_of = BTreeMap::new();
    let mut geometries = Vec::new();
    for (kind, module) in robot.library.modules.iter().enumerate() {
        for (index, link) in module.links.iter().enumerate() {
            let drawn = triangles(&link.shape);
            if !drawn.is_empty() && robot.modules.iter().any(|instance| instance.kind == kind) {
                geometry_of.insert((kind, index), geometries.len());
                geometries.push(drawn);
            }
        }
    }
    let colours = link_colours(robot);
    let kinds = robot.modules.iter().flat_map(|instance| {
        (0..robot.library.modules[instance.kind].links.len()).map(move |link| (instance.kind, link))
    });
    let mut meshes: Vec<(usize, [f64; 3])> = Vec::new();
    let mut nodes = Vec::new();
    let mut drawn = Vec::new();
    for (link, kind) in kinds.enumerate() {
        let Some(&geometry) = geometry_of.get(&kind) else { continue };
        let wanted = (geometry, colours[link]);
        let mesh = meshes.iter().position(|mesh| *mesh == wanted).unwrap_or_else(|| {
            meshes.push(wanted);
            meshes.len() - 1
        });
        nodes.push(Node { name: names[link].clone(), mesh });
        drawn.push(link);
    }
    let paths = LinkPaths::of(plan).ok_or(Refusal::NoJoints { format: "a scene of links" })?;
    let one = Vec3::repeat(1.0);
    let at = |time: &f64| {
        let poses = paths.at(*time);
        drawn.iter().map(|link| Place { pose: poses[*link], scale: one }).collect()
    };
    let places = times.iter().map(at).collect();
    let mut scene = Scene { geometries, meshes, nodes, times, places };
    scene.surround(tracks.obstacles.iter().map(|obstacle| (obstacle.name.clone(), &obstacle.shapes[..])));
    Ok(scene)
}

/// Returns the scene of a lattice: a cube for each cell, and for each that is kept clear of.
fn cells(plan: &Plan, stages: &Stages, library: &Library) -> Result<Scene, Refusal> {
    let count = stages.count as usize;
    let obstacles = stages.obstacles();
    let times = times(plan, "cells", count + obstacles.len())?;
    let size = library.cells.get(stages.cell).map_or(1.0, |cell| cell.size);
    let cube = Placed { pose: Pose::identity(), shape: Shape::Box { size: Vec3::repeat(1.0) } };
    let low = |cell: &crate::plan::CellBox| cell.center[2] - cell.size[2] / 2.0;
    let floor = stages.state(0.0).iter().chain(&obstacles).map(low).fold(f64::INFINITY, f64::min);
    let floor = if floor.is_finite() { floor } else { 0.0 };
    let at = |time: &f64| {
        let place = |cell: &crate::plan::CellBox| {
            let centre = (Vec3::from(cell.center) - Vec3::new(0.0, 0.0, floor)) * size;
            let pose = crate::geometry::pose::shifted(centre);
            Place { pose, scale: Vec3::from(cell.size) * size }
        };
        stages.state(*time).iter().chain(&obstacles).map(place).collect()
    };
    let cells = (0..count).map(|cell| Node { name: format!("cell {cell}"), mesh: 0 });
    let around = (0..obstacles.len()).map(|number| Node { name: format!("obstacle {number}"), mesh: 1 });
    let meshes = [(0, [0.22, 0.40, 0.83]), (0, AROUND)];
    Ok(Scene {
        geometries: vec![triangles(&[cube])],
        meshes: meshes[..if obstacles.is_empty() { 1 } else { 2 }].to_vec(),
        nodes: cells.chain(around).collect(),
        places: times.iter().map(at).collect(),
        times,
    })
}

/// Returns the scene of a truss: a cylinder for each strut, named by its ends at the start and with the ends of the moment,
/// among its obstacles and on its terrain.
fn struts(plan: &Plan, paths: &NodePaths) -> Result<Scene, Refusal> {
    let times = times(plan, "struts", paths.struts.len())?;
    let least = plan.library.struts.get(paths.strut).map_or(1.0, |strut| strut.length.0);
    let tube = Shape::Cylinder { radius: STRUT_RADIUS * least, length: 1.0, axis: Vec3::z() };
    let tube = Placed { pose: Pose::identity(), shape: tube };
    let at = |time: &f64| {
        let nodes: Vec<Vec3> = paths.state(*time).into_iter().map(Vec3::from).collect();
        let place = |&(a, b): &(usize, usize)| {
            let along = nodes[b] - nodes[a];
            let turn = nalgebra::UnitQuaternion::rotation_between(&Vec3::z(), &along);
            let half = nalgebra::Quaternion::new(0.0, 1.0, 0.0, 0.0);
            let turn = turn.unwrap_or_else(|| nalgebra::UnitQuaternion::new_unchecked(half));
            let pose = Pose::from_parts(((nodes[a] + nodes[b]) / 2.0).into(), turn);
            Place { pose, scale: Vec3::new(1.0, 1.0, along.norm()) }
        };
        paths.struts(*time).iter().map(place).collect()
    };
    let mut scene = Scene {
        geometries: vec![triangles(&[tube])],
        meshes: vec![(0, [0.22, 0.40, 0.83])],
        nodes: paths.struts.iter().map(|ends| Node { name: paths.strut_name(*ends), mesh: 0 }).collect(),
        places: times.iter().map(at).collect(),
        times,
    };
    let around = surrounding_solids(paths);
    scene.surround(around.iter().map(|(name, shapes)| (name.clone(), &shapes[..])));
    Ok(scene)
}

/// The binary part of a file with its views and accessors.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds numbers as a view of its own and an accessor; returns the accessor's index. `parts`: the numbers of an
    /// element, 1, 3 or 4. `target`: that of the view, for the corners of meshes. `bounded`: states least and greatest.
    fn add(&mut self, numbers: &[f32], parts: usize, target: Option<u32>, bounded: bool) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": numbers.len() * 4 });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        let kind = ["SCALAR", "", "VEC3", "VEC4"][parts - 1];
        let mut accessor = json!({
            "bufferView": self.views.len(), "componentType": 5126, "count": numbers.len() / parts, "type": kind,
        });
        if bounded {
            let bound = |pick: fn(f32, f32) -> f32, start: f32| -> Vec<f32> {
                let of = |part: usize| numbers.iter().skip(part).step_by(parts).copied().fold(start, pick);
                (0..parts).map(of).collect()
            };
            accessor["min"] = json!(bound(f32::min, f32::INFINITY));
            accessor["max"] = json!(bound(f32::max, f32::NEG_INFINITY));
        }
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// The target of a view that holds corners of meshes.
const ARRAY_BUFFER: u32 = 34962;

/// Returns a scene as the bytes of a GLB file.
fn glb(scene: &Scene, title: &str) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let corners: Vec<(usize, usize)> = scene.geometries.iter().map(|g| geometry(&mut buffer, g)).collect();
    let mut colours: Vec<[f64; 3]> = Vec::new();
    let meshes: Vec<Value> = scene
        .meshes
        .iter()
        .map(|(geometry, colour)| {
            let material = colours.iter().position(|known| known == colour).unwrap_or_else(|| {
                colours.push(*colour);
                colours.len() - 1
            });
            let (positions, normals) = corners[*geometry];
            let attributes = json!({ "POSITION": positions, "NORMAL": normals });
            json!({ "primitives": [{ "attributes": attributes, "material": material }] })
        })
        .collect();
    let linear = |c: f64| if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
    let materials = colours.iter().map(|colour| {
        let [r, g, b] = colour.map(linear);
        json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7 } })
    });
    let materials: Vec<Value> = materials.collect();
    // The first node turns the world, whose z is up, into that of glTF, whose y is.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let children: Vec<usize> = (1..=scene.nodes.len()).collect();
    let mut root = json!({ "name": title, "rotation": [-half, 0.0, 0.0, half] });
    if !children.is_empty() {
        root["children"] = json!(children);
    }
    let mut nodes = vec![root];
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for (index, node) in scene.nodes.iter().enumerate() {
        let places: Vec<Place> = scene.places.iter().map(|places| places[index]).collect();
        nodes.push(placed(node, &places[0]));
        animate(&mut buffer, (&scene.times, &places), index + 1, &mut samplers, &mut channels);
    }
    let mut file = json!({
        "asset": { "version": "2.0", "generator": concat!("modl ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": nodes,
    });
    let lists = [
        ("meshes", meshes),
        ("materials", materials),
        ("accessors", buffer.accessors),
        ("bufferViews", buffer.views),
    ];
    for (key, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        file[key] = Value::Array(list);
    }
    if !buffer.bytes.is_empty() {
        file["buffers"] = json!([{ "byteLength": buffer.bytes.len() }]);
    }
    if !channels.is_empty() {
        file["animations"] = json!([{ "name": "plan", "samplers": samplers, "channels": channels }]);
    }
    container(file.to_string().into_bytes(), buffer.bytes)
}

/// Adds the corners and normals of triangles; returns their accessors.
fn geometry(buffer: &mut Buffer, triangles: &[Triangle]) -> (usize, usize) {
    let corners: Vec<f32> =
        triangles.iter().flat_map(|(p, _)| p.iter().flat_map(|v| v.iter().map(|c| *c as f32))).collect();
    let unit = |n: &Vec3| {
        let n = n.try_normalize(0.0).unwrap_or_else(Vec3::z);
        [n.x as f32, n.y as f32, n.z as f32]
    };
    let normals: Vec<f32> = triangles.iter().flat_map(|(_, n)| n.iter().flat_map(unit)).collect();
    (buffer.add(&corners, 3, Some(ARRAY_BUFFER), true), buffer.add(&normals, 3, Some(ARRAY_BUFFER), false))
}

/// Returns a quaternion in the order x y z w.
fn quaternion(pose: &Pose) -> [f64; 4] {
    let q = &pose.rotation;
    [q.i, q.j, q.k, q.w]
}

fn placed(node: &Node, place: &Place) -> Value {
    let mut value = json!({
        "name": node.name,
        "mesh": node.mesh,
        "translation": place.pose.translation.vector.as_slice(),
        "rotation": quaternion(&place.pose),
    });
    if place.scale != Vec3::repeat(1.0) {
        value["scale"] = json!(place.scale.as_slice());
    }
    value
}

/// Adds the animation of a node for each of its properties that changes. `path`: times and places.
fn animate(
    buffer: &mut Buffer,
    path: (&[f64], &[Place]),
    node: usize,
    samplers: &mut Vec<Value>,
    channels: &mut Vec<Value>,
) {
    let (times, places) = path;
    let positions: Vec<Vec<f64>> =
        places.iter().map(|p| p.pose.translation.vector.as_slice().to_vec()).collect();
    let scales: Vec<Vec<f64>> = places.iter().map(|p| p.scale.as_slice().to_vec()).collect();
    let mut turns: Vec<Vec<f64>> = Vec::with_capacity(places.len());
    for place in places {
        let mut q = quaternion(&place.pose).to_vec();
        // Of the two quaternions of an orientation the one nearer to that before.
        if turns.last().is_some_and(|last| last.iter().zip(&q).map(|(a, b)| a * b).sum::<f64>() < 0.0) {
            q.iter_mut().for_each(|x| *x = -*x);
        }
        turns.push(q);
    }
    for (name, values) in [("translation", positions), ("rotation", turns), ("scale", scales)] {
        let kept = kept(times, &values);
        let still = kept.iter().all(|&k| values[k] == values[0]);
        if still || kept.len() < 2 {
            continue;
        }
        let input: Vec<f32> = kept.iter().map(|&k| times[k] as f32).collect();
        let output: Vec<f32> = kept.iter().flat_map(|&k| values[k].iter().map(|x| *x as f32)).collect();
        let input = buffer.add(&input, 1, None, true);
        let output = buffer.add(&output, values[0].len(), None, false);
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": name } }));
        samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }
}

/// Returns the indices of the samples that are kept: the first, the last, and as few between as keep all others within
/// [`STRAIGHT`] of the line between their neighbours (greedy, from the start).
fn kept(times: &[f64], values: &[Vec<f64>]) -> Vec<usize> {
    let mut kept = vec![0];
    let mut from = 0;
    for to in 2..times.len() {
        let straight = |k: usize| {
            let part = (times[k] - times[from]) / (times[to] - times[from]);
            let near = |i: usize| {
                let line = values[from][i] + (values[to][i] - values[from][i]) * part;
                (line - values[k][i]).abs() <= STRAIGHT
            };
            (0..values[k].len()).all(near)
        };
        if !(from + 1..to).all(straight) || to - from > 64 {
            from = to - 1;
            kept.push(from);
        }
    }
    if times.len() > 1 {
        kept.push(times.len() - 1);
    }
    kept
}

/// Returns the bytes of a GLB file with a part of JSON and one of numbers.
fn container(mut text: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let parts: [(&[u8; 4], &[u8]); 2] = [(b"JSON", &text), (b"BIN\0", &binary)];
    let parts = parts.into_iter().filter(|(_, bytes)| !bytes.is_empty());
    let mut body = Vec::new();
    for (name, bytes) in parts {
        body.extend((bytes.len() as u32).to_le_bytes());
        body.extend(name);
        body.extend(bytes);
    }
    let mut file = b"glTF".to_vec();
    file.extend(2_u32.to_le_bytes());
    file.extend((body.len() as u32 + 12).to_le_bytes());
    file.extend(body);
    file
}
