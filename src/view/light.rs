//! The light of still pictures: a wide sun and an evenly bright sky, each as many directions with a depth map each, so that
//! shadows are soft and hollows dark. Pages have the same light (`page/shaders.js`).

use super::bodies::Drawn;
use super::raster::{Camera, Facet};
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;
use std::f64::consts::TAU;

/// The direction towards the middle of the sun; unit length.
pub(super) const SUN: Vec3 = Vec3::new(0.334, -0.437, 0.835);

/// The angle between the middle of the sun and its rim, rad: that of a sun behind thin clouds.
const SUN_RADIUS: f64 = 0.055;

/// The golden angle, rad: directions that turn by it spread evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The samples of a pixel, each of which sees its own part of the directions.
pub(super) const SAMPLES: usize = 9;

/// The number of directions of the sun, and the width and height of their depth maps in texels: of a fine picture, and of a
/// quick one. Samples of a pixel see them in turns.
const SUNS_FINE: (usize, usize) = (SAMPLES, 900);
const SUNS_QUICK: (usize, usize) = (3, 450);
const SUNS_TINY: (usize, usize) = (1, 450);

/// The width and height of depth maps of the sky, in texels.
const SKY_MAP_SIZE: usize = 160;

/// The most texels of a depth map, of the sun and of the sky, for a pixel of the picture's width: finer shadows than a small
/// picture can show would take most of its time.
const SUN_TEXELS: usize = 2;
const SKY_TEXELS: usize = 1;

/// The directions of the sky that each sample sees, in a fine picture, in a quick one, and in one of few pixels.
const DIRECTIONS_FINE: usize = 4;
const DIRECTIONS_QUICK: usize = 2;
const DIRECTIONS_TINY: usize = 1;

/// The width in pixels below which a quick picture has few pixels: its shadows are smaller than one.
const WIDTH_TINY: usize = 100;

/// The cosine of its angle from which a direction of the sky counts as faced by a surface.
const FACING: f64 = 0.1;

/// The number of triangles above which each sample sees one direction of the sky alone.
const TRIANGLES_MANY: usize = 150_000;

/// The fineness of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fineness {
    /// Several directions of the sky a sample, and fine shadows: for pictures that are looked at.
    Fine,
    /// Fewer directions of the sky a sample, and coarser shadows: for small pictures, and those of a film.
    Quick,
}

/// The light seen from a point of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// The visible part of the sun, 0..1.
    pub sun: f64,
    /// The visible part of the sky that shines on the surface, 0..1, weighed by the cosine of its angle.
    pub sky: f64,
    /// The visible part of the whole sky, 0..1.
    pub open: f64,
}

/// The light of a scene.
pub(super) struct Light {
    /// The directions of the sun; sample `i` sees the one of index `i` modulo their number.
    suns: Vec<Map>,
    /// The directions of the sky: those of sample `i` are `i`, `i + SAMPLES`, ...
    skies: Vec<Map>,
    /// The radius of the scene, m.
    radius: f64,
}

/// The depths of a scene as light from one direction meets it.
struct Map {
    /// The unit vector from the bodies towards the light, in the world.
    direction: Vec3,
    /// Column, row and depth of a point p (m, in the world) are `origin[k] + axes[k] · p`.
    axes: [Vec3; 3],
    origin: [f64; 3],
    /// Its width and height in texels.
    size: usize,
    /// The depths of texels, row by row, as in [`Canvas::depths`](super::raster::Canvas).
    depths: Vec<f32>,
}

impl Map {
    /// Returns the map of bodies in a ball, as (centre, radius) in m, for light from a direction.
    fn new(bodies: &[Drawn], (middle, radius): (Vec3, f64), direction: Vec3, size: usize) -> Map {
        let camera = Camera::new(middle + direction * (3.0 * radius), middle, Vec3::y(), 1.1 * radius, true);
        let mut depths = vec![f32::NEG_INFINITY; size * size];
        for (corners, _) in bodies.iter().flat_map(|body| &body.mesh.triangles) {
            let Some(facet) = Facet::new(corners, &camera, size, size) else { continue };
            facet.cover(size, &(0..size), |x, y, depth| {
                let at = &mut depths[y * size + x];
                *at = at.max(depth);
            });
        }
        let scale = size as f64 / 2.0 / camera.half;
        let axes = [camera.right * scale, camera.up * -scale, camera.back];
        // The depth is minus the distance to the camera, and the centre of the first texel is at the column and row 0.
        let shifts = [size as f64 / 2.0 - 0.5, size as f64 / 2.0 - 0.5, 0.0];
        let origin = std::array::from_fn(|k| shifts[k] - axes[k].dot(&camera.at));
        Map { direction, axes, origin, size, depths }
    }

    /// Returns the part of the light that reaches a point, 0..1: interpolated between four texels.
    fn seen(&self, p: &Vec3, slack: f64) -> f64 {
        let at = |k: usize| self.axes[k].dot(p) + self.origin[k];
        let (x, y) = (at(0), at(1));
        let last = (self.size - 1) as f64;
        // The bodies lie well within the map.
        if !(x >= 0.0 && x < last && y >= 0.0 && y < last) {
            return 1.0;
        }
        let (left, top) = (x as usize, y as usize);
        let limit = (at(2) + slack) as f32;
        let first = top * self.size + left;
        let lit = |texel: usize| if self.depths[texel] > limit { 0.0 } else { 1.0 };
        let (u, v) = (x - left as f64, y - top as f64);
        let row = |texel: usize| lit(texel) * (1.0 - u) + lit(texel + 1) * u;
        row(first) * (1.0 - v) + row(first + self.size) * v
    }
}

impl Light {
    /// Returns the light of bodies in a ball, as (centre, radius) in m. `width`: the width of the picture in pixels.
    pub(super) fn new(bodies: &[Drawn], around: (Vec3, f64), fineness: Fineness, width: usize) -> Light {
        let triangles: usize = bodies.iter().map(|body| body.mesh.triangles.len()).sum();
        let (each, (suns, size)) = match fineness {
            Fineness::Fine => (DIRECTIONS_FINE, SUNS_FINE),
            Fineness::Quick if width < WIDTH_TINY => (DIRECTIONS_TINY, SUNS_TINY),
            Fineness::Quick => (DIRECTIONS_QUICK, SUNS_QUICK),
        };
        let count = if triangles < TRIANGLES_MANY { SAMPLES * each } else { SAMPLES };
        let (sun_size, sky_size) = (size.min(SUN_TEXELS * width), SKY_MAP_SIZE.min(SKY_TEXELS * width));
        let suns = (0..suns).map(|i| Map::new(bodies, around, sun(i, suns), sun_size)).collect();
        let skies = (0..count).map(|i| Map::new(bodies, around, sky(i, count), sky_size)).collect();
        Light { suns, skies, radius: around.1 }
    }

    /// Returns the light that a sample of a pixel (0 to [`SAMPLES`] - 1) sees at the point `p` of a surface with the unit
    /// normal `n`.
    pub(super) fn seen(&self, p: &Vec3, n: &Vec3, sample: usize) -> Seen {
        let lifted = self.lifted(p, n);
        let slack = TOLERANCES.shadow_depth * self.radius;
        let sun = self.sun(p, n, sample);
        let (mut sky, mut weights, mut open, mut count) = (0.0, 0.0, 0.0, 0.0);
        for map in self.skies.iter().skip(sample).step_by(SAMPLES) {
            let seen = map.seen(&lifted, slack);
            let weight = n.dot(&map.direction).max(0.0) + 0.02;
            (sky, weights) = (sky + weight * seen, weights + weight);
            (open, count) = (open + seen, count + 1.0);
        }
        // The next direction that the surface faces stands for its own, where it faces none of them.
        let mut next = self.skies.iter().cycle().skip(sample).take(self.skies.len());
        let instead = (weights < FACING * count).then(|| next.find(|map| n.dot(&map.direction) > FACING));
        let sky = instead.flatten().map_or(sky / weights, |map| map.seen(&lifted, slack));
        Seen { sun, sky, open: open / count }
    }

    /// Returns the visible part of the sun, 0..1, as [`Self::seen`] has it.
    pub(super) fn sun(&self, p: &Vec3, n: &Vec3, sample: usize) -> f64 {
        let map = &self.suns[sample % self.suns.len()];
        let slack = TOLERANCES.shadow_depth * self.radius;
        if n.dot(&SUN) > 0.0 { map.seen(&self.lifted(p, n), 0.5 * slack) } else { 0.0 }
    }

    /// Returns the visible part of the sky that shines on the point `p` of a surface with the unit normal `n`, 0..1, by all
    /// directions.
    pub(super) fn sky_over(&self, p: &Vec3, n: &Vec3) -> f64 {
        let (lifted, slack) = (self.lifted(p, n), TOLERANCES.shadow_depth * self.radius);
        let (mut sky, mut weights) = (0.0, 0.0);
        for map in &self.skies {
            let weight = n.dot(&map.direction).max(0.0);
            (sky, weights) = (sky + weight * map.seen(&lifted, slack), weights + weight);
        }
        sky / weights
    }

    /// Returns a point of a surface lifted off it, so that the surface does not shade itself.
    fn lifted(&self, p: &Vec3, n: &Vec3) -> Vec3 {
        p + n * (TOLERANCES.shadow * self.radius)
    }
}

/// Returns one of some directions of the sun: on a spiral over its disc.
fn sun(i: usize, count: usize) -> Vec3 {
    let (side, up) = (SUN.cross(&Vec3::z()).normalize(), SUN.cross(&Vec3::x()).normalize());
    let radius = SUN_RADIUS * ((i as f64 + 0.5) / count as f64).sqrt();
    let (s, c) = libm::sincos(GOLDEN_ANGLE * i as f64);
    (SUN + side * (radius * c) + up * (radius * s)).normalize()
}

/// Returns one of the directions of the sky, spread evenly over it; those of each sample are spread, too.
fn sky(i: usize, count: usize) -> Vec3 {
    let each = count / SAMPLES;
    let order = (i % SAMPLES) * each + i / SAMPLES;
    let z = (1.0 - 0.97 * ((i as f64 + 0.5) / count as f64)).sqrt();
    let (s, c) = libm::sincos(GOLDEN_ANGLE * order as f64 + TAU * i as f64 / SAMPLES as f64);
    let out = (1.0 - z * z).sqrt();
    Vec3::new(out * c, out * s, z)
}

/// Returns the light that a rough surface of a colour sends to the eye, red, green and blue, sRGB encoded in 0..1. `base`: its
/// colour in linear light; `n`: its unit normal; `away`: the unit vector to the eye.
pub(super) fn shaded(
    base: [f64; 3],
    (n, away): (&Vec3, &Vec3),
    seen: Seen,
    metal: bool,
    figure: bool,
) -> [f32; 3] {
    let direct = n.dot(&SUN).max(0.0) * seen.sun;
    let up = n.z * 0.5 + 0.5;
    let side = n.dot(&Vec3::new(-SUN.x, -SUN.y, 0.3).normalize()).max(0.0);
    let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
    let part = if figure { 1.0 } else { 0.0 };
    let sky_part = (0.35 + 0.65 * up) * mix(0.12, 1.0, seen.sky);
    let bounce = (1.0 - up) * mix(0.3, 1.0, seen.open);
    // The highlight of a rough surface (Trowbridge and Reitz 1975), and what the sky leaves at grazing angles.
    let half = (SUN + away).normalize();
    let rough: f64 = if metal { 0.30 } else { 0.42 };
    let a = rough * rough;
    let d = n.dot(&half) * n.dot(&half) * (a * a - 1.0) + 1.0;
    let gloss = (a * a / (4.0 * d * d)).min(6.0) * if metal { 0.24 } else { 0.06 };
    let grazing = 1.0 - n.dot(away).max(0.0);
    let rim = grazing * grazing * grazing * grazing * 0.10 * seen.sky * (0.4 + 0.6 * up);
    const SKY: [f64; 3] = [0.50, 0.54, 0.60];
    const BOUNCE: [f64; 3] = [0.26, 0.245, 0.225];
    const FILL: [f64; 3] = [0.17, 0.175, 0.19];
    const DIRECT: [f64; 3] = [0.74, 0.705, 0.65];
    std::array::from_fn(|i| {
        let ambient = mix(SKY[i], 0.74, part) * sky_part
            + mix(BOUNCE[i], 0.26, part) * bounce
            + side * FILL[i] * mix(0.4, 1.0, seen.open);
        let shine = if metal { mix(1.0, base[i] * 2.2, 0.5) } else { 1.0 };
        let light = base[i] * (ambient + direct * mix(DIRECT[i], 0.52, part))
            + (gloss * direct + rim) * shine * mix(1.0, 0.4, part);
        let light = light / (1.0 + (light - 0.6).max(0.0) * 0.7);
        light.clamp(0.0, 1.0).sqrt() as f32
    })
}
