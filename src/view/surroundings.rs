//! The surroundings of a truss as solids to draw: its obstacles, and the part of the terrain that it walks
//! on.

use crate::geometry::{HeightField, Placed, Pose, Shape, Vec3};
use crate::plan::{NodePaths, Plan};

/// The most grid squares of terrain that are drawn in each direction.
const SQUARES_MAX: usize = 48;
/// The margin of drawn terrain around the nodes, in widths of the truss at the start.
const AROUND: f64 = 0.5;

/// Returns true if a flat floor is drawn, level or a [`slope`]: the world has a floor, and no terrain replaces it.
pub(super) fn floor(plan: &Plan) -> bool {
    let uneven = plan.body.node_paths().is_some_and(|paths| paths.surroundings.terrain.is_some());
    !uneven && plan.worlds.first().is_none_or(|world| world.world.has_floor())
}

/// Returns the rise of the floor along x and along y, m per m; `None` where it is level.
pub(super) fn slope(plan: &Plan) -> Option<[f64; 2]> {
    plan.worlds.first().filter(|first| first.world.is_sloped()).map(|first| first.world.slope)
}

/// Returns the obstacles of a truss, then the terrain on which it walks, each as its name and its shapes placed in the
/// world, m: of a fine terrain every second height, third, ..., around the nodes alone.
pub fn solids(paths: &NodePaths) -> Vec<(String, Vec<Placed>)> {
    let around = &paths.surroundings;
    let obstacles = around.obstacles.iter().enumerate();
    let named = obstacles.map(|(i, shapes)| (format!("obstacle {}", i + 1), shapes.clone()));
    let terrain = around.terrain.as_ref().map(|field| ("ground".to_owned(), vec![ground(paths, field)]));
    named.chain(terrain).collect()
}

/// Returns the terrain under the truss as triangles; of a fine grid every second height, third, ...
fn ground(paths: &NodePaths, field: &HeightField) -> Placed {
    let range = |axis: usize, keyframes: usize| {
        let nodes = paths.keyframes[..keyframes].iter().flat_map(|keyframe| &keyframe.nodes).map(|p| p[axis]);
        nodes.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let lines = |axis: usize, count: usize| {
        let ((low, high), (first, last)) = (range(axis, paths.keyframes.len()), range(axis, 1));
        let more = AROUND * (last - first);
        let at = |x: f64| ((x - field.corner[axis]) / field.spacing).clamp(0.0, (count - 1) as f64);
        let (from, to) = (libm::floor(at(low - more)) as usize, libm::ceil(at(high + more)) as usize);
        let to = to.max(from + 1).min(count - 1);
        let from = from.min(to - 1);
        let stride = (to - from).div_ceil(SQUARES_MAX);
        (from..to).step_by(stride).chain([to]).collect::<Vec<usize>>()
    };
    let (columns, rows) = (lines(0, field.columns), lines(1, field.rows()));
    let place = |column: usize, row: usize| {
        let [x, y] = [(0, column), (1, row)].map(|(k, i)| field.corner[k] + i as f64 * field.spacing);
        Vec3::new(x, y, field.heights[row * field.columns + column])
    };
    let vertices =
        rows.iter().flat_map(|&row| columns.iter().map(move |&column| place(column, row))).collect();
    let number = |column: usize, row: usize| (row * columns.len() + column) as u32;
    let squares = (0..rows.len() - 1).flat_map(|row| (0..columns.len() - 1).map(move |column| (column, row)));
    let triangles = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let triangles = triangles.collect();
    Placed { pose: Pose::identity(), shape: Shape::Mesh { name: "ground".into(), vertices, triangles } }
}
