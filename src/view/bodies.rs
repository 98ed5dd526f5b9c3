//! The visible bodies of a plan at one time: coloured triangle meshes in the world frame.

use super::colour::{AROUND, FAILED, METAL, NODE, PALETTE, Rgb, groups};
use super::fittings::fittings;
use super::input::RenderInput;
use super::mesh::Mesh;
use super::primitives::along;
use super::{findings, surroundings};
use crate::geometry::pose::shifted;
use crate::geometry::{Pose, Vec3};
use crate::plan::verify::articulated::{ClusterPaths, base_at};
use crate::plan::{Body, CellBox, NodePaths, Stages, Tracks};
use crate::robot::{Kinematics, Library};

/// The most cells in one picture; of a larger lattice every second, third, ... cell is drawn.
const CELLS_MAX: usize = 20_000;

/// The most cells whose faces have plates.
const CELLS_PLATED_MAX: usize = 2_000;
/// The width and height of the plates on the faces of a cell, as parts of its size, and the shade of their colour.
const PLATE_WIDTH: f64 = 0.72;
const PLATE_HEIGHT: f64 = 0.985;
const PLATE_SHADE: usize = 5;

/// A triangle mesh in the world frame, in metres, with its colour.
pub(super) struct Drawn {
    /// The mesh of the body in the world frame, in metres.
    pub mesh: Mesh,
    /// The colour of all faces of the body.
    pub colour: Rgb,
    /// True for bare metal, which shines.
    pub metal: bool,
}

impl Drawn {
    /// Returns a body of a colour.
    fn painted(mesh: Mesh, colour: Rgb) -> Drawn {
        Drawn { mesh, colour, metal: false }
    }

    /// Returns a body of bare metal.
    fn bare(mesh: Mesh) -> Drawn {
        Drawn { mesh, colour: METAL, metal: true }
    }
}

/// Returns the bodies at a time in seconds, in the order in which they are drawn: the links of a robot with their fittings, then obstacles; the cells of
/// a lattice, of a very large one every second or third; the struts of a truss, then its nodes and surroundings. `width`: the
/// width of the picture in pixels.
pub(super) fn drawn(input: &RenderInput, time: f64, width: usize) -> Vec<Drawn> {
    let plan = input.plan;
    match &plan.body {
        Body::Tracks(tracks) => robot(input, tracks, time, &link_poses(input, tracks, time), width),
        Body::Stages(stages) => cells(stages, &plan.library, time, width),
        Body::NodePaths(paths) => truss(paths, time, width),
    }
}

/// Returns the links of an articulated robot with their world poses at a time in seconds, failed modules in the colour
/// of failure, and the obstacles around it. `width`: the width of the picture in pixels.
pub(super) fn robot(
    input: &RenderInput,
    tracks: &Tracks,
    time: f64,
    poses: &[Pose],
    width: usize,
) -> Vec<Drawn> {
    let group = groups(&tracks.robot);
    let failed = findings::failed_modules(input.plan, time);
    let mut drawn = Vec::new();
    let library = &tracks.robot.library;
    let meshes: Vec<Vec<(Mesh, Mesh)>> = library
        .modules
        .iter()
        .map(|kind| {
            let of = |link: usize| {
                let fittings = fittings(library, kind, link);
                (Mesh::rounded(&kind.links[link].shape, width), Mesh::rounded(&fittings, width))
            };
            (0..kind.links.len()).map(of).collect()
        })
        .collect();
    let mut link = 0;
    for (module, instance) in tracks.robot.modules.iter().enumerate() {
        let own = if failed.contains(&module) { FAILED } else { PALETTE[group[module] % PALETTE.len()] };
        for (index, (mesh, fitted)) in meshes[instance.kind].iter().enumerate() {
            drawn.push(Drawn::painted(mesh.moved(&poses[link]), own.shaded(index)));
            if !fitted.triangles.is_empty() {
                drawn.push(Drawn::bare(fitted.moved(&poses[link])));
            }
            link += 1;
        }
    }
    let obstacles = tracks.obstacles.iter();
    drawn.extend(obstacles.map(|o| Drawn::painted(Mesh::rounded(&o.shapes, width), AROUND)));
    drawn
}

/// Returns the pose of each link in the world (`X_WL`) at a time in seconds, in the order of [`Kinematics`]'s links:
/// those of the first module, then those of the second, and so on.
pub(super) fn link_poses(input: &RenderInput, tracks: &Tracks, time: f64) -> Vec<Pose> {
    let state = tracks.state(time);
    let kinematics = Kinematics::new(&tracks.robot, &state.bonds, tracks.robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    if let Some(paths) = ClusterPaths::of(input.plan, time) {
        paths.place(time, &mut poses);
        return poses;
    }
    let base = base_at(input.plan, time).unwrap_or(state.base);
    kinematics.link_poses(&state.joints, &base, &mut poses);
    poses
}

/// Returns the cells of a lattice as cubes.
fn cells(stages: &Stages, library: &Library, time: f64, width: usize) -> Vec<Drawn> {
    let size = library.cells.get(stages.cell).map_or(1.0, |cell| cell.size);
    let cells = stages.state(time);
    let low = |cell: &CellBox| cell.center[2] - cell.size[2] / 2.0;
    let obstacles = stages.obstacles();
    let floor = cells.iter().chain(&obstacles).map(low).fold(f64::INFINITY, f64::min);
    let stride = cells.len().div_ceil(CELLS_MAX).max(1);
    let plated = cells.len() <= CELLS_PLATED_MAX;
    let place = |cell: &CellBox| {
        let at = shifted((Vec3::from(cell.center) - Vec3::new(0.0, 0.0, floor)) * size);
        (at, Vec3::from(cell.size) * size)
    };
    let cube = |cell: &CellBox| {
        let (at, whole) = place(cell);
        let colour = Rgb::ramp(cell.size.iter().product());
        let mut body = Mesh::for_width(width);
        body.rounded_box(&at, &(whole * 0.97));
        let mut plates = Mesh::for_width(width);
        for axis in (0..3).filter(|_| plated) {
            let mut plate = whole * PLATE_WIDTH;
            plate[axis] = whole[axis] * PLATE_HEIGHT;
            plates.rounded_box(&at, &plate);
        }
        [Drawn::painted(body, colour), Drawn::painted(plates, colour.shaded(PLATE_SHADE))]
    };
    let around = |obstacle: &CellBox| {
        let (at, whole) = place(obstacle);
        let mut body = Mesh::for_width(width);
        body.rounded_box(&at, &whole);
        Drawn::painted(body, AROUND)
    };
    let drawn = cells.iter().step_by(stride).flat_map(cube).chain(obstacles.iter().map(around));
    drawn.filter(|drawn| !drawn.mesh.triangles.is_empty()).collect()
}

/// Returns the struts of a truss as cylinders and its nodes as balls.
fn truss(paths: &NodePaths, time: f64, width: usize) -> Vec<Drawn> {
    let nodes: Vec<Vec3> = paths.state(time).into_iter().map(Vec3::from).collect();
    let lengths = paths.lengths(time);
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let thick = 0.03 * mean;
    let mut drawn = Vec::new();
    for (&(a, b), length) in paths.struts(time).iter().zip(&lengths) {
        let middle = shifted((nodes[a] + nodes[b]) / 2.0) * along(&(nodes[b] - nodes[a]));
        let part = |mesh: &mut Mesh, at: f64, radius: f64, of: f64| {
            let place = middle * shifted(Vec3::new(0.0, 0.0, at * length));
            mesh.rounded_tube(&place, radius * thick, of * length);
        };
        let (mut tube, mut rod) = (Mesh::for_width(width), Mesh::for_width(width));
        part(&mut tube, -0.21, 0.5, 0.5);
        part(&mut rod, 0.0, 0.28, 0.96);
        part(&mut rod, 0.03, 0.62, 0.03);
        drawn.push(Drawn::painted(tube, PALETTE[0]));
        drawn.push(Drawn::bare(rod));
    }
    for node in &nodes {
        let mut mesh = Mesh::for_width(width);
        mesh.ball(&shifted(*node), 1.3 * thick);
        drawn.push(Drawn::painted(mesh, NODE));
    }
    for (_, shapes) in surroundings::solids(paths) {
        drawn.push(Drawn::painted(Mesh::rounded(&shapes, width), AROUND));
    }
    drawn
}
