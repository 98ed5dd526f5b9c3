//! Uneven ground: a height field over a grid, with flat triangles between.

use super::pose::Vec3;
use super::soundness::EXTENT_MAX;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A height field: heights at the corners of equal squares, each of which is two triangles with a common side from
/// its corner of the least x and y to that of the greatest. Beyond the rim the height is that of the nearest point
/// of the rim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightField {
    /// The position (x, y) of the first height in the world's frame, m.
    pub corner: [f64; 2],
    /// The distance of neighbours along x and y, m; positive.
    pub spacing: f64,
    /// The number of heights along x, at least 2.
    pub columns: usize,
    /// The heights in the world, m, row by row along y: that of column i and row j at index `j · columns + i`; at
    /// least two rows.
    pub heights: Vec<f64>,
}

impl HeightField {
    /// Returns the fault of the field in words, as a clause for a message; `None` if the field is sound, which the
    /// other methods require.
    pub fn fault(&self) -> Option<&'static str> {
        let rows = self.heights.len().checked_div(self.columns).unwrap_or(0);
        let faults = [
            (self.columns < 2 || rows < 2, "the ground has less than two rows or columns of heights"),
            (rows * self.columns != self.heights.len(), "the rows of the ground have different lengths"),
            (!(self.spacing > 0.0 && self.spacing.is_finite()), "the heights of the ground are not apart"),
            (!self.in_reach(rows), "the ground reaches, or is, farther than 1 km from the origin"),
        ];
        faults.into_iter().find_map(|(bad, why)| bad.then_some(why))
    }

    /// Returns true if all points of the ground, of so many `rows`, are finite and within [`EXTENT_MAX`] along each
    /// axis.
    fn in_reach(&self, rows: usize) -> bool {
        let ends = [(self.corner[0], self.columns), (self.corner[1], rows)];
        let ends = ends.map(|(corner, count)| corner + self.spacing * (count as f64 - 1.0));
        self.heights.iter().chain(&self.corner).chain(&ends).all(|x| x.abs() <= EXTENT_MAX)
    }

    /// Returns the number of heights along y, at least 2 for a sound field.
    pub fn rows(&self) -> usize {
        self.heights.len() / self.columns
    }

    /// Returns the height of the ground at a point (x, y) of the world, m; outside the field that of the nearest
    /// point of its rim.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let (triangle, [u, v]) = self.triangle(x, y);
        triangle.height + triangle.slope[0] * u + triangle.slope[1] * v
    }

    /// Returns the derivatives of the height by x and by y at a point (m), without unit; on a crease those of one of
    /// its sides, and 0 along an axis along which the point is beyond the rim.
    pub fn slope(&self, x: f64, y: f64) -> [f64; 2] {
        let (triangle, _) = self.triangle(x, y);
        let inside = [self.along(0, x), self.along(1, y)].map(|(_, clamped)| !clamped);
        [0, 1].map(|k| if inside[k] { triangle.slope[k] / self.spacing } else { 0.0 })
    }

    /// Returns the unit normal of the ground at a point (x, y) of the world, upwards; on a crease that of one of its sides.
    pub fn normal(&self, x: f64, y: f64) -> Vec3 {
        let [along_x, along_y] = self.slope(x, y);
        Vec3::new(-along_x, -along_y, 1.0).normalize()
    }

    /// Returns the greatest height, m.
    pub fn highest(&self) -> f64 {
        self.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the ground that rises evenly along a horizontal direction, through the origin of the world, by `rise` for
    /// each metre (without unit), up to 500 m from it along each axis. `along`: a unit vector. Heights are sound up to a
    /// rise of √2.
    pub fn plane(along: [f64; 2], rise: f64) -> HeightField {
        const HALF: f64 = HeightField::PLANE_HALF;
        let at = |x: f64, y: f64| rise * (along[0] * x + along[1] * y);
        let heights = vec![at(-HALF, -HALF), at(HALF, -HALF), at(-HALF, HALF), at(HALF, HALF)];
        HeightField { corner: [-HALF, -HALF], spacing: 2.0 * HALF, columns: 2, heights }
    }

    /// Half the side of the square over which [`plane`](Self::plane) rises, m.
    const PLANE_HALF: f64 = 500.0;

    /// Returns the rise along x and along y, m per m, of a field that is a [`plane`](Self::plane); `None` for others, and
    /// for a field that is not sound.
    pub fn as_plane(&self) -> Option<[f64; 2]> {
        const HALF: f64 = HeightField::PLANE_HALF;
        let [a, b, c, d] = <[f64; 4]>::try_from(self.heights.as_slice()).ok()?;
        let square = self.corner == [-HALF, -HALF] && self.spacing == 2.0 * HALF && self.columns == 2;
        // Through the origin, which is in the middle, and flat: opposite corners are as far above it as below.
        let even = a == -d && b == -c;
        (square && even && self.fault().is_none()).then(|| [(b - a) / self.spacing, (c - a) / self.spacing])
    }

    /// Returns the greatest slope of all triangles, the height gained for a horizontal distance of 1; not negative,
    /// without unit.
    pub fn steepest(&self) -> f64 {
        let squares =
            (0..self.rows() - 1).flat_map(|row| (0..self.columns - 1).map(move |column| (column, row)));
        let slopes =
            squares.flat_map(|(column, row)| [true, false].map(|low| self.half(column, row, low).slope));
        slopes.map(|[a, b]| libm::hypot(a, b) / self.spacing).fold(0.0, f64::max)
    }

    /// Returns the height of a point of the world (m) above the ground, m; negative below it.
    pub fn above(&self, p: Vec3) -> f64 {
        p.z - self.height(p.x, p.y)
    }

    /// Calls `report` with fractions of a segment's length (0 at `p` to 1 at `q`, both in the world, m) and the
    /// heights above the ground there (m): at its ends and wherever it crosses, seen from above, a side of a
    /// triangle. In between the height is linear. The calls are in no order; the same fraction may come twice.
    pub fn profile(&self, p: Vec3, q: Vec3, mut report: impl FnMut(f64, f64)) {
        let mut sample = |part: f64| report(part, self.above(p + (q - p) * part));
        sample(0.0);
        sample(1.0);
        let (columns, rows) = (self.columns as f64, self.rows() as f64);
        let flat = |v: Vec3| [v.x - self.corner[0], v.y - self.corner[1]].map(|w| w / self.spacing);
        let ([px, py], [qx, qy]) = (flat(p), flat(q));
        // Lines of the same x, of the same y, and of the same difference of both.
        let families = [
            (px, qx, 0.0, columns - 1.0),
            (py, qy, 0.0, rows - 1.0),
            (px - py, qx - qy, 1.0 - rows, columns - 1.0),
        ];
        for (from, to, least, most) in families {
            let first = libm::ceil(from.min(to)).max(least);
            let last = libm::floor(from.max(to)).min(most);
            if from != to && first <= last {
                let lines = (first as i64..=last as i64).map(|line| (line as f64 - from) / (to - from));
                lines.filter(|part| 0.0 < *part && *part < 1.0).for_each(&mut sample);
            }
        }
    }

    /// Returns the point of the segment from `p` to `q` (in the world, m) that is lowest above the ground, as
    /// (position, height): its position as a fraction of the segment's length, 0 to 1, and its height above the
    /// ground, m, negative below it.
    pub fn lowest(&self, p: Vec3, q: Vec3) -> (f64, f64) {
        let mut least = (0.0, f64::INFINITY);
        self.profile(p, q, |part, height| {
            if height < least.1 {
                least = (part, height);
            }
        });
        least
    }

    /// Returns a coordinate in steps of the grid, and true if it was clamped to the rim.
    fn along(&self, axis: usize, at: f64) -> (f64, bool) {
        let count = if axis == 0 { self.columns } else { self.rows() };
        let free = (at - self.corner[axis]) / self.spacing;
        let kept = free.clamp(0.0, (count - 1) as f64);
        (kept, kept != free)
    }

    /// Returns the triangle at a point, and the point's coordinates in it from its square's corner.
    fn triangle(&self, x: f64, y: f64) -> (Half, [f64; 2]) {
        let [u, v] = [self.along(0, x).0, self.along(1, y).0];
        let column = (u as usize).min(self.columns - 2);
        let row = (v as usize).min(self.rows() - 2);
        let [u, v] = [u - column as f64, v - row as f64];
        (self.half(column, row, u >= v), [u, v])
    }

    /// Returns a half of a square: that of greater x, or that of greater y.
    fn half(&self, column: usize, row: usize, low: bool) -> Half {
        let at = |right: usize, up: usize| self.heights[(row + up) * self.columns + column + right];
        let slope = if low {
            [at(1, 0) - at(0, 0), at(1, 1) - at(1, 0)]
        } else {
            [at(1, 1) - at(0, 1), at(0, 1) - at(0, 0)]
        };
        Half { height: at(0, 0), slope }
    }
}

/// Half a square: the height at its corner, and how it grows over a square's side.
struct Half {
    height: f64,
    slope: [f64; 2],
}
