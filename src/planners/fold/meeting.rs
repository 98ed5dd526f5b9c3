//! Whether panels meet on the way, as triangles without thickness, in samples: a quick look that
//! keeps the judge from plans that it would reject. What it lets through is not proved.

use super::folded::poses_at;
use super::layout::Layout;
use super::simulation::quintic;
use super::target::Target;
use crate::geometry::Vec3;

/// States of each step that are looked at.
const SAMPLES: usize = 24;

/// An axis shorter than this part of the square of a side is rounding.
const TOL_AXIS: f64 = 1e-9;

type Triangle = [Vec3; 3];

/// Two faces that meet, and the step in which they first do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    pub step: usize,
    pub faces: [usize; 2],
}

/// The first meeting while a layout is folded in steps. `shrunk`: by which part triangles are made
/// smaller, so that those do not meet which share an edge.
pub fn meeting(target: &Target, layout: &Layout, steps: &[Vec<usize>], shrunk: f64) -> Option<Meeting> {
    let small: Vec<Triangle> = (0..target.faces.len())
        .map(|face| {
            let middle = target.centroid(face);
            target.corners(face).map(|corner| middle + (corner - middle) * (1.0 - shrunk))
        })
        .collect();
    let reach: Vec<f64> = (0..small.len())
        .map(|face| small[face].iter().map(|p| (p - target.centroid(face)).norm()).fold(0.0, f64::max))
        .collect();
    let full = |face: usize| layout.hinge[face].map_or(0.0, |hinge| target.hinges[hinge].angle);
    let mut angles = vec![0.0; small.len()];
    for (number, step) in steps.iter().enumerate() {
        let moving = moving_against(layout, step);
        for sample in 1..=SAMPLES {
            let part = quintic(sample as f64 / SAMPLES as f64, 1.0).angle;
            step.iter().for_each(|face| angles[*face] = full(*face) * part);
            let poses = poses_at(target, layout, |face| angles[face]);
            let placed = |face: usize| small[face].map(|p| poses[face].transform_point(&p.into()).coords);
            let placed: Vec<Triangle> = (0..small.len()).map(placed).collect();
            let centres: Vec<Vec3> = placed.iter().map(|t| (t[0] + t[1] + t[2]) / 3.0).collect();
            let near = |a: usize, b: usize| (centres[a] - centres[b]).norm() < reach[a] + reach[b];
            let meets = |&&[a, b]: &&[usize; 2]| near(a, b) && !parted(&placed[a], &placed[b]);
            if let Some(&faces) = moving.iter().find(meets) {
                return Some(Meeting { step: number, faces });
            }
        }
    }
    None
}

/// Pairs of faces with a moving hinge between them.
fn moving_against(layout: &Layout, step: &[usize]) -> Vec<[usize; 2]> {
    let faces = layout.parent.len();
    let mut carried = vec![0usize; faces];
    // By face: a number for the set of moving hinges above it.
    for &face in &layout.order[1..] {
        let above = carried[layout.parent[face]];
        carried[face] = if step.contains(&face) { face + 1 } else { above };
    }
    // No two hinges of one path move in the same step, so one hinge tells the set.
    let pairs = (0..faces).flat_map(|b| (0..b).map(move |a| [a, b]));
    pairs.filter(|&[a, b]| carried[a] != carried[b]).collect()
}

/// Whether a plane across some axis has two triangles on its two sides.
fn parted(a: &Triangle, b: &Triangle) -> bool {
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (of_a, of_b) = (edges(a), edges(b));
    let (normal_a, normal_b) = (of_a[0].cross(&of_a[1]), of_b[0].cross(&of_b[1]));
    let parts = |axis: Vec3, scale: f64| {
        let range = |t: &Triangle| {
            let d = t.map(|p| axis.dot(&p));
            (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
        };
        let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
        axis.norm() > TOL_AXIS * scale && (high_a < low_b || high_b < low_a)
    };
    let area = normal_a.norm().max(normal_b.norm());
    // Those of triangles in one plane as well.
    parts(normal_a, area)
        || parts(normal_b, area)
        || of_a.iter().any(|u| of_b.iter().any(|v| parts(u.cross(v), area)))
        || of_a.iter().any(|u| parts(normal_a.cross(u), area * u.norm()))
        || of_b.iter().any(|u| parts(normal_b.cross(u), area * u.norm()))
}
