//! Lattice and truss plans as SVG: one small drawing per stage, in a view from a corner.

use super::colour::{AROUND, Rgb};
use super::drawing::{Drawing, INK, SOFT, around};
use super::input::RenderInput;
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;
use crate::plan::{CellBox, NodePaths, Stages};

/// The most panels of one file.
const PANELS_MAX: usize = 24;
/// The most cells of one panel; of a larger lattice every second, third, ... cell is drawn.
const CELLS_MAX: usize = 4000;

/// The side of a panel in pixels.
const PANEL: f64 = 260.0;
/// The number of panels in a row.
const COLUMNS: usize = 4;
/// The height of a panel's title in pixels.
const HEAD: f64 = 26.0;

/// One panel: its title, and its polygons from the farthest to the nearest.
struct Panel {
    name: String,
    pieces: Vec<Flat>,
}

/// A polygon in the plane of the drawing, with its SVG attributes.
struct Flat {
    points: Vec<[f64; 2]>,
    look: String,
}

/// Returns the SVG of a lattice plan: a panel for the start and one for the end of each stage, as many as fit.
pub(super) fn lattice(input: &RenderInput, stages: &Stages) -> String {
    let instants = stages.instants();
    let name = |i: usize| match i.checked_sub(1) {
        None => "start".to_owned(),
        Some(stage) => format!("{i}. {}", stages.stages[stage].name),
    };
    let shown = instants.len().min(PANELS_MAX);
    let obstacles = stages.obstacles();
    let panels = (0..shown)
        .map(|i| Panel { name: name(i), pieces: cubes(&stages.state(instants[i]), &obstacles) })
        .collect();
    laid_out(input, panels, instants.len() - shown)
}

/// Returns the SVG of a truss plan: a panel for each keyframe, as many as fit.
pub(super) fn truss(input: &RenderInput, paths: &NodePaths) -> String {
    let shown = paths.keyframes.len().min(PANELS_MAX);
    let panels = paths.keyframes[..shown].iter().enumerate().map(|(i, keyframe)| {
        let name = if i == 0 {
            "start".to_owned()
        } else {
            format!("after {} s", super::number::short(keyframe.time))
        };
        let at = |n: usize| flat(&Vec3::from(keyframe.nodes[n]));
        let look = |colour: &str| format!("fill=\"none\" stroke=\"{colour}\"");
        let struts = paths.struts(keyframe.time);
        let lines = struts.iter().map(|&(a, b)| Flat { points: vec![at(a), at(b)], look: look(INK) });
        Panel { name, pieces: lines.collect() }
    });
    laid_out(input, panels.collect(), paths.keyframes.len() - shown)
}

/// Returns the orthographic projection of a point: x to the right, y down.
fn flat(p: &Vec3) -> [f64; 2] {
    let (back, up) = (Vec3::new(0.57, -0.71, 0.52).normalize(), Vec3::z());
    let right = up.cross(&back).normalize();
    [p.dot(&right), -p.dot(&back.cross(&right))]
}

/// Returns the three visible faces of each cube, cells and obstacles, the farthest cubes first.
fn cubes(cells: &[CellBox], obstacles: &[CellBox]) -> Vec<Flat> {
    let back = Vec3::new(0.57, -0.71, 0.52);
    let colour = |cell: &CellBox| Rgb::ramp(cell.size.iter().product());
    let some = cells.iter().step_by(cells.len().div_ceil(CELLS_MAX).max(1));
    let mut order: Vec<(&CellBox, Rgb)> = some.map(|cell| (cell, colour(cell))).collect();
    order.extend(obstacles.iter().map(|obstacle| (obstacle, AROUND)));
    order.sort_by(|(a, _), (b, _)| {
        let near = |c: &CellBox| Vec3::from(c.center).dot(&back);
        near(a).total_cmp(&near(b))
    });
    order.into_iter().flat_map(|(cube, colour)| faces(cube, colour)).collect()
}

/// Returns the three faces of a cube that face the viewer.
fn faces(cell: &CellBox, colour: Rgb) -> [Flat; 3] {
    // The sides towards +x, -y and +z, which the view from the corner shows.
    [(0, 1.0, 0.78), (1, -1.0, 0.62), (2, 1.0, 1.0)].map(|(axis, side, light)| {
        let corner = |u: f64, v: f64| {
            let mut p = Vec3::from(cell.center);
            p[axis] += side * cell.size[axis] / 2.0;
            p[(axis + 1) % 3] += u * cell.size[(axis + 1) % 3] / 2.0;
            p[(axis + 2) % 3] += v * cell.size[(axis + 2) % 3] / 2.0;
            flat(&p)
        };
        let points = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let fill = colour.mixed(Rgb([1.0; 3]), 0.25).0.map(|c| c * light);
        Flat { points, look: format!("fill=\"{}\" stroke=\"{INK}\"", Rgb(fill).code()) }
    })
}

/// Returns the SVG of panels in rows; `undrawn` is the number of panels left out.
fn laid_out(input: &RenderInput, panels: Vec<Panel>, undrawn: usize) -> String {
    let all = || panels.iter().flat_map(|p| p.pieces.iter().flat_map(|f| f.points.iter().copied()));
    let (from, size) = around(all(), 0.0);
    let scale = (PANEL - 30.0) / size[0].max(size[1]).max(TOLERANCES.size);
    let mut drawing = Drawing::default();
    for (i, panel) in panels.iter().enumerate() {
        let corner = [(i % COLUMNS) as f64 * PANEL, (i / COLUMNS) as f64 * (PANEL + HEAD)];
        let offset = [0, 1].map(|k| corner[k] + (PANEL - size[k] * scale) / 2.0 - from[k] * scale);
        drawing.words([corner[0] + PANEL / 2.0, corner[1] + 14.0], 12.0, INK, &panel.name);
        for piece in &panel.pieces {
            let points: Vec<[f64; 2]> = piece
                .points
                .iter()
                .map(|p| [p[0] * scale + offset[0], p[1] * scale + offset[1] + HEAD])
                .collect();
            drawing.polygon(&points, &format!("{} stroke-width=\"0.7\"", piece.look));
        }
    }
    let rows = panels.len().div_ceil(COLUMNS);
    let mut tall = rows as f64 * (PANEL + HEAD);
    if undrawn > 0 {
        drawing.words([PANEL, tall + 10.0], 12.0, SOFT, &format!("and {undrawn} more, which are not drawn"));
        tall += HEAD;
    }
    drawing.finish(input.title, [0.0; 2], [panels.len().min(COLUMNS) as f64 * PANEL, tall + 10.0], "px")
}
