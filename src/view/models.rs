//! Links as triangles and colours, for programs that draw them by themselves.

use super::colour::{PALETTE, groups};
use super::mesh::Mesh;
use crate::geometry::{Placed, Vec3};
use crate::robot::Assembly;

/// A triangle as (corners in metres, counter-clockwise as seen from outside; normals at them, of length 1, outwards).
pub type Triangle = ([Vec3; 3], [Vec3; 3]);

/// Returns shapes as triangles, in the frame in which the shapes are placed. Round shapes have 40 facets around.
pub fn triangles(shapes: &[Placed]) -> Vec<Triangle> {
    Mesh::of(shapes).triangles
}

/// Returns the colour of each link of a robot, red, green and blue in 0..1, sRGB encoded, in the order of the links'
/// numbers: those of pictures and pages.
pub fn link_colours(robot: &Assembly) -> Vec<[f64; 3]> {
    let group = groups(robot);
    let of = |module: usize| {
        let own = PALETTE[group[module] % PALETTE.len()];
        (0..robot.module_type(module).links.len()).map(move |link| own.shaded(link).0)
    };
    (0..robot.modules.len()).flat_map(of).collect()
}
