//! A software rasteriser: triangles and lines into pixels with a depth buffer, by edge functions.

use super::colour::Rgb;
use super::mesh::Mesh;
use crate::geometry::Vec3;

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

/// An image under construction, with its depth buffer.
pub(super) struct Canvas {
    /// The width of the canvas in pixels.
    pub width: usize,
    /// The height of the canvas in pixels.
    pub height: usize,
    /// Red, green and blue of each pixel, sRGB encoded, in 0..1, row by row from the top.
    pub colours: Vec<[f32; 3]>,
    /// The depths of pixels, in the order of `colours`: one over the distance from the camera along the viewing
    /// direction (1/m), or minus that distance (m) for an orthographic camera; the greater is nearer. Minus infinity
    /// where nothing is drawn.
    pub depths: Vec<f32>,
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

impl Canvas {
    /// Returns an empty image of this size in pixels: black, with nothing drawn.
    pub(super) fn new(width: usize, height: usize) -> Canvas {
        let pixels = width * height;
        Canvas { width, height, colours: vec![[0.0; 3]; pixels], depths: vec![f32::NEG_INFINITY; pixels] }
    }

    /// Rasterises the triangles of a mesh in the world; `shade` returns the colour of a point, sRGB encoded, by its
    /// position and normal there. Triangles with a corner behind the near plane are left out.
    pub(super) fn fill(
        &mut self,
        mesh: &Mesh,
        camera: &Camera,
        shade: &mut dyn FnMut(Vec3, Vec3) -> [f32; 3],
    ) {
        for (corners, normals) in &mesh.triangles {
            let spots = corners.map(|p| camera.project(&p, self.width, self.height));
            if let [Some(a), Some(b), Some(c)] = spots {
                self.triangle([a, b, c], camera.parallel, &mut |weights| {
                    let mix = |of: &[Vec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
                    shade(mix(corners), mix(normals))
                });
            }
        }
    }

    /// Rasterises one triangle by edge functions where it is not hidden; `colour` gets the barycentric weights of its
    /// corners at a pixel, correct for the perspective.
    fn triangle(
        &mut self,
        spots: [Projected; 3],
        parallel: bool,
        colour: &mut dyn FnMut([f64; 3]) -> [f32; 3],
    ) {
        let [a, b, c] = spots;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        // The pixels of the bounding box within the picture.
        let range = |low: f64, high: f64, size: usize| {
            (low.floor().max(0.0) as usize, (high.ceil().max(0.0) as usize).min(size))
        };
        let bounds = |pick: fn(&Projected) -> f64| {
            let values = spots.each_ref().map(pick);
            (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max))
        };
        let ((left, right), (top, bottom)) = (bounds(|s| s.x), bounds(|s| s.y));
        let ((x0, x1), (y0, y1)) = (range(left, right, self.width), range(top, bottom, self.height));
        for y in y0..y1 {
            for x in x0..x1 {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                // Barycentric coordinates, from the edge functions.
                let u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
                let v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let depth = u * a.depth + v * b.depth + w * c.depth;
                let at = y * self.width + x;
                if depth as f32 > self.depths[at] {
                    self.depths[at] = depth as f32;
                    // Perspective-correct interpolation.
                    let weights = match parallel {
                        true => [u, v, w],
                        false => [u * a.depth / depth, v * b.depth / depth, w * c.depth / depth],
                    };
                    self.colours[at] = colour(weights);
                }
            }
        }
    }

    /// Rasterises lines, given by their ends in the world, of a width in pixels. A line with an end behind the near
    /// plane is left out.
    pub(super) fn lines(&mut self, lines: &[[Vec3; 2]], camera: &Camera, width: usize, colour: Rgb) {
        let colour = colour.0.map(|c| c as f32);
        for [p, q] in lines {
            let (Some(a), Some(b)) =
                (camera.project(p, self.width, self.height), camera.project(q, self.width, self.height))
            else {
                continue;
            };
            let length = f64::max((b.x - a.x).abs(), (b.y - a.y).abs());
            let steps = (length.ceil().max(1.0) as usize).min(4 * (self.width + self.height));
            for i in 0..=steps {
                let u = i as f64 / steps as f64;
                let mix = |from: f64, to: f64| from + (to - from) * u;
                let depth = mix(a.depth, b.depth) * LINE_LIFT;
                let (x, y) = (mix(a.x, b.x) - width as f64 / 2.0, mix(a.y, b.y) - width as f64 / 2.0);
                self.dot(libm::round(x), libm::round(y), width, depth as f32, colour);
            }
        }
    }

    /// Writes a square of pixels where it is not hidden.
    fn dot(&mut self, x: f64, y: f64, width: usize, depth: f32, colour: [f32; 3]) {
        for (dx, dy) in (0..width).flat_map(|dx| (0..width).map(move |dy| (dx as f64, dy as f64))) {
            let (x, y) = (x + dx, y + dy);
            if x < 0.0 || y < 0.0 || x >= self.width as f64 || y >= self.height as f64 {
                continue;
            }
            let at = y as usize * self.width + x as usize;
            if depth >= self.depths[at] {
                self.colours[at] = colour;
            }
        }
    }
}
