//! The part of the sky that points of the ground see, on a grid: it changes slowly, but each direction of the sky would draw
//! a shadow with an edge.

use super::light::Light;
use crate::geometry::Vec3;

/// The number of points of the grid along each side.
const SIZE: usize = 192;

/// Half the width of the grid, in radii of the scene. Farther away nearly all of the sky is seen.
const REACH: f64 = 4.0;

/// The part of the way from the middle to the rim of the grid beyond which what is hidden fades away.
const FADE: f64 = 0.6;

/// The visible part of the sky over the ground around a scene.
pub(super) struct Openness {
    /// The first point of the grid, m.
    corner: [f64; 2],
    /// The distance between points, m.
    step: f64,
    /// The visible part of the sky at the points, 0..1, row by row along x.
    open: Vec<f32>,
}

impl Openness {
    /// Returns the openness around a ball, as (centre, radius) in m, of a plane with this unit normal. `point`: the point of
    /// the plane at x and y, m.
    pub(super) fn new(
        light: &Light,
        (middle, radius): (Vec3, f64),
        normal: &Vec3,
        point: impl Fn(f64, f64) -> Vec3,
    ) -> Openness {
        let step = 2.0 * REACH * radius / (SIZE - 1) as f64;
        let corner = [middle.x - REACH * radius, middle.y - REACH * radius];
        let half = (SIZE - 1) as f64 / 2.0;
        let at = |index: usize| {
            let (column, row) = ((index % SIZE) as f64, (index / SIZE) as f64);
            let out = (libm::hypot(column - half, row - half) / half - FADE) / (1.0 - FADE);
            let kept = 1.0 - out.clamp(0.0, 1.0);
            if kept == 0.0 {
                return 1.0;
            }
            let p = point(corner[0] + step * column, corner[1] + step * row);
            (1.0 - kept * (1.0 - light.sky_over(&p, normal))) as f32
        };
        let open: Vec<f32> = (0..SIZE * SIZE).map(at).collect();
        // Each pass takes the mean of three neighbours along a row, and turns rows into columns.
        let open = (0..4).fold(open, |open, _| smoothed(&open));
        Openness { corner, step, open }
    }

    /// Returns the visible part of the sky at a point of the plane, 0..1, interpolated between four points of the grid; 1
    /// beyond it.
    pub(super) fn at(&self, p: &Vec3) -> f64 {
        let (x, y) = ((p.x - self.corner[0]) / self.step, (p.y - self.corner[1]) / self.step);
        let last = (SIZE - 1) as f64;
        if !(x >= 0.0 && x < last && y >= 0.0 && y < last) {
            return 1.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f64, y - row as f64);
        let first = row * SIZE + column;
        let between =
            |index: usize| f64::from(self.open[index]) * (1.0 - u) + f64::from(self.open[index + 1]) * u;
        between(first) * (1.0 - v) + between(first + SIZE) * v
    }
}

/// Returns the means of three neighbours in each row, with rows and columns exchanged.
fn smoothed(open: &[f32]) -> Vec<f32> {
    let mean = |index: usize| {
        let (row, column) = (index % SIZE, index / SIZE);
        let (before, after) = (column.saturating_sub(1), (column + 1).min(SIZE - 1));
        (open[row * SIZE + before] + open[row * SIZE + column] + open[row * SIZE + after]) / 3.0
    };
    (0..SIZE * SIZE).map(mean).collect()
}
