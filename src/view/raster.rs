//! A software rasteriser: triangles and lines into pixels with a depth buffer, by edge functions.

use crate::geometry::Vec3;
use std::ops::Range;

/// The near plane: nothing nearer to the camera than this fraction of the distance to the target is drawn.
const NEAR: f64 = 0.02;

/// Lines are drawn as if nearer by this factor, so that they are visible on the surfaces they lie on.
const LINE_LIFT: f64 = 1.0015;

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

/// A triangle projected into a picture.
pub(super) struct Facet {
    /// Its corners in the picture.
    spots: [Projected; 3],
    /// Twice its signed area, in square pixels; neither zero nor infinite.
    area: f64,
    /// True for an orthographic camera, false for a perspective one.
    parallel: bool,
}

impl Facet {
    /// Projects a triangle of the world, corners in m, into a picture of this size in pixels; `None` if a corner is
    /// behind the near plane or the triangle is seen edge on.
    pub(super) fn new(corners: &[Vec3; 3], camera: &Camera, width: usize, height: usize) -> Option<Facet> {
        let [a, b, c] = corners.each_ref().map(|p| camera.project(p, width, height));
        let (a, b, c) = (a?, b?, c?);
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        (area != 0.0 && area.is_finite()).then_some(Facet {
            spots: [a, b, c],
            area,
            parallel: camera.parallel,
        })
    }

    /// Returns the pixels of its bounding box along one axis that lie within 0..`size`.
    fn range(&self, pick: fn(&Projected) -> f64, size: usize) -> Range<usize> {
        let values = self.spots.each_ref().map(pick);
        let low = values.iter().copied().fold(f64::MAX, f64::min);
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        low.floor().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(size)
    }

    /// Returns a part of `range` outside of which no centre of a pixel of row `y` lies in the triangle, from where its
    /// sides cross the row.
    fn span(&self, y: usize, range: &Range<usize>) -> Range<usize> {
        let py = y as f64 + 0.5;
        let (mut low, mut high) = (range.start as f64, range.end as f64);
        for side in 0..3 {
            let [p, q] = [self.spots[side], self.spots[(side + 1) % 3]];
            // The edge function along the row is its value at x = 0 plus x times this slope.
            let slope = p.y - q.y;
            let size = p.x.abs().max(q.x.abs()).max((p.y - py).abs()).max((q.y - py).abs());
            let crossing = (p.x * (q.y - py) - (p.y - py) * q.x) / -slope;
            // Two pixels, and many times what rounding does to the crossing.
            let margin = 2.0 + 64.0 * f64::EPSILON * size * size / slope.abs();
            if crossing.is_finite() && margin.is_finite() {
                match slope * self.area > 0.0 {
                    true => low = low.max(crossing - margin),
                    false => high = high.min(crossing + margin),
                }
            }
        }
        low as usize..(high.max(low).ceil() as usize).min(range.end)
    }

    /// Returns the barycentric coordinates of the centre of a pixel, from the edge functions; `None` outside the
    /// triangle.
    fn coordinates(&self, x: usize, y: usize) -> Option<[f64; 3]> {
        let [a, b, c] = self.spots;
        let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
        let u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / self.area;
        let v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / self.area;
        let w = 1.0 - u - v;
        (u >= 0.0 && v >= 0.0 && w >= 0.0).then_some([u, v, w])
    }

    /// Returns the depth at barycentric coordinates; see [`Canvas::depths`].
    fn depth(&self, [u, v, w]: [f64; 3]) -> f64 {
        let [a, b, c] = self.spots;
        u * a.depth + v * b.depth + w * c.depth
    }

    /// Returns the weights of its corners in the world at barycentric coordinates in the picture, correct for the
    /// perspective.
    fn weights(&self, [u, v, w]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.spots;
        let depth = self.depth([u, v, w]);
        match self.parallel {
            true => [u, v, w],
            false => [u * a.depth / depth, v * b.depth / depth, w * c.depth / depth],
        }
    }
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

    /// Rasterises triangles where they are not hidden: their depths, and which one is seen.
    pub(super) fn fill(&mut self, facets: &[Facet]) {
        for (index, facet) in facets.iter().enumerate() {
            let range = facet.range(|s| s.y, self.height);
            let columns = facet.range(|s| s.x, self.width);
            for y in range.start.max(self.rows.start)..range.end.min(self.rows.end) {
                for x in facet.span(y, &columns) {
                    let Some(coordinates) = facet.coordinates(x, y) else { continue };
                    let depth = facet.depth(coordinates) as f32;
                    let at = self.place(x, y);
                    if depth > self.depths[at] {
                        self.depths[at] = depth;
                        self.seen[at] = index as u32;
                    }
                }
            }
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
            let drawn = self.depths[at] > f32::NEG_INFINITY;
            let coordinates = drawn.then(|| facets[index].coordinates(x, y)).flatten();
            self.colours.push(match coordinates {
                Some(coordinates) => {
                    let kept = if self.marked[at] { edge } else { 1.0 };
                    shade(index, facets[index].weights(coordinates), (x, y)).map(|c| c * kept)
                }
                None => behind(x, y),
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
