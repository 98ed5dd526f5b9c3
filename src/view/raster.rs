//! A software rasteriser: triangles and lines into pixels with a depth buffer, by edge functions.

use crate::geometry::Vec3;
use std::ops::Range;

/// The near plane: nothing nearer to the camera than this fraction of the distance to the target is drawn.
const NEAR: f64 = 0.02;

/// Lines are drawn as if nearer by this factor, so that they are visible on the surfaces they lie on.
const LINE_LIFT: f64 = 1.0015;

/// The number of columns below which a triangle's sides are not crossed with each row: every pixel is tried.
const NARROW: usize = 12;

/// A camera in the world, perspective or orthographic, with the orthonormal axes right, up and back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// The position of the camera in the world, m.
    pub at: Vec3,
    /// The unit vector to the right of the picture, in the world.
    pub right: Vec3,
    /// The unit vector to the top of the picture, in the world.
    pub up: Vec3,
    /// The unit vector from the target to the camera, in the world.
    pub back: Vec3,
    /// Half the height of what the picture shows: of an orthographic camera in metres, of a perspective one at the
    /// distance 1, thus the tangent of half its angle of view.
    pub half: f64,
    /// True for an orthographic camera, false for a perspective one.
    pub parallel: bool,
    /// The distance of the camera to the target, m.
    pub distance: f64,
}

/// Some rows of an image under construction, with their depth buffer.
pub(super) struct Canvas {
    /// The width of the image in pixels.
    pub width: usize,
    /// The height of the whole image in pixels.
    pub height: usize,
    /// The rows of the image that this canvas holds, counted from the top.
    pub rows: Range<usize>,
    /// Red, green and blue of each pixel, sRGB encoded, in 0..1, row by row from the top; empty until
    /// [`Canvas::shade`].
    pub colours: Vec<[f32; 3]>,
    /// The depths of pixels, in the order of `colours`: one over the distance from the camera along the viewing
    /// direction (1/m), or minus that distance (m) for an orthographic camera; the greater is nearer. Minus infinity
    /// where nothing is drawn.
    pub depths: Vec<f32>,
    /// The index of the triangle seen at each pixel, in the order of `colours`; of no meaning where nothing is drawn.
    seen: Vec<u32>,
    /// True for the pixels that [`Canvas::mark`] marked, in the order of `colours`.
    marked: Vec<bool>,
}

/// A point projected into a picture: x and y in pixels, and its depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected {
    /// The distance from the left edge, in pixels.
    pub x: f64,
    /// The distance from the top edge, in pixels.
    pub y: f64,
    /// The depth of the point, as in [`Canvas::depths`].
    pub depth: f64,
}

impl Camera {
    /// Returns a camera at `at` that is directed at `target`, both in m in the world, with the direction `up` upwards
    /// in the picture; see [`Camera::half`] for `half`. `up` must not point at the target.
    pub(super) fn new(at: Vec3, target: Vec3, up: Vec3, half: f64, parallel: bool) -> Camera {
        let back = (at - target).normalize();
        let right = up.cross(&back).normalize();
        Camera { at, right, up: back.cross(&right), back, half, parallel, distance: (at - target).norm() }
    }

    /// Projects a point of the world, in m, into a picture of this size in pixels; `None` if it is behind the near
    /// plane. One beside the picture is projected, too.
    pub(super) fn project(&self, p: &Vec3, width: usize, height: usize) -> Option<Projected> {
        let d = p - self.at;
        let away = -d.dot(&self.back);
        if !self.parallel && away < NEAR * self.distance {
            return None;
        }
        let scale = height as f64 / 2.0 / self.half / if self.parallel { 1.0 } else { away };
        Some(Projected {
            x: width as f64 / 2.0 + d.dot(&self.right) * scale,
            y: height as f64 / 2.0 - d.dot(&self.up) * scale,
            depth: if self.parallel { -away } else { 1.0 / away },
        })
    }

    /// Returns the unit direction of the ray of a perspective camera through the point (x, y) of a picture of this
    /// size, in pixels.
    pub(super) fn ray(&self, x: f64, y: f64, width: usize, height: usize) -> Vec3 {
        let scale = self.half * 2.0 / height as f64;
        let (u, v) = ((x - width as f64 / 2.0) * scale, (height as f64 / 2.0 - y) * scale);
        (self.right * u + self.up * v - self.back).normalize()
    }
}

/// A triangle projected into a picture. The barycentric coordinates of a point are linear in its place: `spots[0]` has the
/// others at zero, and from there they grow by `slopes`.
pub(super) struct Facet {
    /// Its corners in the picture.
    spots: [Projected; 3],
    /// The gains of the coordinates of its second and of its third corner by a pixel to the right, and by one down.
    slopes: [[f64; 2]; 2],
    /// True for an orthographic camera, false for a perspective one.
    parallel: bool,
}

impl Facet {
    /// Projects a triangle of the world, corners in m, into a picture of this size in pixels; `None` if a corner is
    /// behind the near plane, the triangle is seen edge on, or no centre of a pixel lies in its bounding box.
    pub(super) fn new(corners: &[Vec3; 3], camera: &Camera, width: usize, height: usize) -> Option<Facet> {
        let a = camera.project(&corners[0], width, height)?;
        let b = camera.project(&corners[1], width, height)?;
        let c = camera.project(&corners[2], width, height)?;
        if pixels([a.x, b.x, c.x], width).is_empty() || pixels([a.y, b.y, c.y], height).is_empty() {
            return None;
        }
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        (area != 0.0 && area.is_finite()).then(|| Facet {
            spots: [a, b, c],
            slopes: [[(c.y - a.y) / area, (a.x - c.x) / area], [(a.y - b.y) / area, (b.x - a.x) / area]],
            parallel: camera.parallel,
        })
    }

    /// Returns the rows of a picture of this height whose centres lie in its bounding box.
    pub(super) fn rows(&self, height: usize) -> Range<usize> {
        pixels(self.spots.each_ref().map(|spot| spot.y), height)
    }

    /// Calls `draw` with column, row and depth for each pixel whose centre lies in the triangle, of these rows of a picture
    /// of this width; see [`Canvas::depths`].
    pub(super) fn cover(&self, width: usize, rows: &Range<usize>, mut draw: impl FnMut(usize, usize, f32)) {
        let [a, b, c] = &self.spots;
        let [[right_b, down_b], [right_c, down_c]] = self.slopes;
        let (deep_b, deep_c) = (b.depth - a.depth, c.depth - a.depth);
        let columns = pixels([a.x, b.x, c.x], width);
        let own = self.rows(rows.end);
        for y in own.start.max(rows.start)..own.end {
            let down = y as f64 + 0.5 - a.y;
            let (row_b, row_c) = (down_b * down, down_c * down);
            for x in self.span(down, &columns) {
                let right = x as f64 + 0.5 - a.x;
                let (v, w) = (right_b * right + row_b, right_c * right + row_c);
                if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                    draw(x, y, (a.depth + v * deep_b + w * deep_c) as f32);
                }
            }
        }
    }

    /// Returns a part of `columns` outside of which no centre of a pixel lies in the triangle, from where its sides cross
    /// the row this many pixels below its first corner.
    fn span(&self, down: f64, columns: &Range<usize>) -> Range<usize> {
        if columns.len() < NARROW {
            return columns.clone();
        }
        let first = self.spots[0].x;
        let [b, c] = self.slopes;
        // The three coordinates along the row: their values below the first corner, and what they gain by a pixel.
        let lines = [[b[1] * down, b[0]], [c[1] * down, c[0]], [1.0 - (b[1] + c[1]) * down, -b[0] - c[0]]];
        let (mut low, mut high) = (columns.start as f64, columns.end as f64);
        for [value, gain] in lines {
            let crossing = first - value / gain;
            // Two pixels, and many times what rounding does to the crossing.
            let margin = 2.0 + 64.0 * f64::EPSILON * (first.abs() + (1.0 + value.abs()) / gain.abs());
            if crossing.is_finite() && margin.is_finite() {
                match gain > 0.0 {
                    true => low = low.max(crossing - margin),
                    false => high = high.min(crossing + margin),
                }
            }
        }
        low as usize..(high.max(low) as usize + 1).min(columns.end)
    }

    /// Returns the barycentric coordinates of the centre of a pixel.
    fn coordinates(&self, x: usize, y: usize) -> [f64; 3] {
        let [a, ..] = &self.spots;
        let (right, down) = (x as f64 + 0.5 - a.x, y as f64 + 0.5 - a.y);
        let [v, w] = self.slopes.map(|[by_right, by_down]| by_right * right + by_down * down);
        [1.0 - v - w, v, w]
    }

    /// Returns the weights of its corners in the world at the centre of a pixel, correct for the perspective.
    fn weights(&self, x: usize, y: usize) -> [f64; 3] {
        let [u, v, w] = self.coordinates(x, y);
        if self.parallel {
            return [u, v, w];
        }
        let [a, b, c] = self.spots;
        let depth = u * a.depth + v * b.depth + w * c.depth;
        [u * a.depth / depth, v * b.depth / depth, w * c.depth / depth]
    }
}

/// Returns the pixels of 0..`size` whose centres lie between the least and the greatest of three coordinates.
fn pixels(of: [f64; 3], size: usize) -> Range<usize> {
    let low = of[0].min(of[1]).min(of[2]);
    let high = of[0].max(of[1]).max(of[2]);
    // A conversion cuts off the fraction, and clamps.
    (low + 0.5) as usize..((high + 0.5) as usize).min(size)
}

impl Canvas {
    /// Returns these rows of an empty image of this size in pixels, with nothing drawn.
    pub(super) fn new(width: usize, height: usize, rows: Range<usize>) -> Canvas {
        let pixels = width * rows.len();
        Canvas {
            width,
            height,
            rows,
            colours: Vec::new(),
            depths: vec![f32::NEG_INFINITY; pixels],
            seen: vec![0; pixels],
            marked: vec![false; pixels],
        }
    }

    /// Returns the index in `colours` and `depths` of a pixel in the rows of the canvas.
    pub(super) fn place(&self, x: usize, y: usize) -> usize {
        (y - self.rows.start) * self.width + x
    }

    /// Rasterises triangles where they are not hidden: their depths, and which one is seen. `numbers`: the indices in `facets`
    /// of those to draw.
    pub(super) fn fill(&mut self, facets: &[Facet], numbers: &[u32]) {
        let (top, width) = (self.rows.start, self.width);
        for &number in numbers {
            facets[number as usize].cover(width, &self.rows, |x, y, depth| {
                let at = (y - top) * width + x;
                if depth > self.depths[at] {
                    self.depths[at] = depth;
                    self.seen[at] = number;
                }
            });
        }
    }

    /// Colours all pixels, after [`Canvas::fill`] with the same triangles: `shade` returns the colour, sRGB encoded, where
    /// one is seen, by its index, the weights of its corners there, column and row, `behind` where none is, by column and
    /// row. Marked pixels keep the part `edge` of their brightness.
    pub(super) fn shade(
        &mut self,
        facets: &[Facet],
        shade: &dyn Fn(usize, [f64; 3], (usize, usize)) -> [f32; 3],
        behind: &dyn Fn(usize, usize) -> [f32; 3],
        edge: f32,
    ) {
        self.colours = Vec::with_capacity(self.depths.len());
        for (y, x) in self.rows.clone().flat_map(|y| (0..self.width).map(move |x| (y, x))) {
            let at = self.colours.len();
            let index = self.seen[at] as usize;
            self.colours.push(if self.depths[at] > f32::NEG_INFINITY {
                let kept = if self.marked[at] { edge } else { 1.0 };
                shade(index, facets[index].weights(x, y), (x, y)).map(|c| c * kept)
            } else {
                behind(x, y)
            });
        }
    }

    /// Marks the pixels of lines, given by their ends in the world, of a width in pixels, where they are not hidden. A line
    /// with an end behind the near plane is left out, and so is what lies before the background.
    pub(super) fn mark(&mut self, lines: &[[Vec3; 2]], camera: &Camera, width: usize) {
        for [p, q] in lines {
            let (Some(a), Some(b)) =
                (camera.project(p, self.width, self.height), camera.project(q, self.width, self.height))
            else {
                continue;
            };
            let rows = (self.rows.start as f64 - width as f64, self.rows.end as f64 + width as f64);
            if a.y.max(b.y) < rows.0 || a.y.min(b.y) > rows.1 {
                continue;
            }
            let length = f64::max((b.x - a.x).abs(), (b.y - a.y).abs());
            let steps = (length.ceil().max(1.0) as usize).min(4 * (self.width + self.height));
            for i in 0..=steps {
                let u = i as f64 / steps as f64;
                let mix = |from: f64, to: f64| from + (to - from) * u;
                let depth = mix(a.depth, b.depth) * LINE_LIFT;
                let (x, y) = (mix(a.x, b.x) - width as f64 / 2.0, mix(a.y, b.y) - width as f64 / 2.0);
                self.dot(libm::round(x), libm::round(y), width, depth as f32);
            }
        }
    }

    /// Marks a square of pixels where it is not hidden.
    fn dot(&mut self, x: f64, y: f64, width: usize, depth: f32) {
        for (dx, dy) in (0..width).flat_map(|dx| (0..width).map(move |dy| (dx as f64, dy as f64))) {
            let (x, y) = (x + dx, y + dy);
            let rows = self.rows.start as f64..self.rows.end as f64;
            if x < 0.0 || x >= self.width as f64 || !rows.contains(&y) {
                continue;
            }
            let at = self.place(x as usize, y as usize);
            if self.depths[at] > f32::NEG_INFINITY && depth >= self.depths[at] {
                self.marked[at] = true;
            }
        }
    }
}
