//! A still picture of a plan at one time, as PNG, rendered on the processor: the same bytes on every
//! machine.

use super::bodies::{self, Drawn, drawn};
use super::colour::Rgb;
use super::input::RenderInput;
use super::link_paths::LinkPaths;
use super::raster::{Camera, Canvas, Facet};
use super::tolerances::TOLERANCES;
use super::{findings, palette, surroundings};
use crate::geometry::Vec3;

/// Supersampling: a pixel is the mean of this many by this many samples.
const SUPERSAMPLING: usize = 3;

/// The number of rows of samples that are rendered at once, a multiple of [`SUPERSAMPLING`].
const BAND_HEIGHT: usize = 16 * SUPERSAMPLING;

/// The width and height of the shadow map, in samples.
const SHADOW_MAP_SIZE: usize = 1400;

/// The tangent of half the vertical field of view (38 degrees, as on the page).
const HALF_FOV_TANGENT: f64 = 0.344_327_6;

/// The direction towards the sun; unit length.
const SUN: Vec3 = Vec3::new(0.334, -0.437, 0.835);
/// The colour of the sky at the top of the picture.
const ABOVE: Rgb = Rgb([0.906, 0.918, 0.925]);
/// The colour of the sky at the horizon.
const BELOW: Rgb = Rgb([0.965, 0.957, 0.937]);
/// The colour of grid lines and shadows on the ground.
const INK: Rgb = Rgb([0.125, 0.188, 0.235]);

/// The viewpoint of a picture. +x of the world is the front, +z up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The view from the front right, and from above.
    Corner,
    /// The view from the front, from +x of the world.
    Front,
    /// The view from behind, from -x of the world.
    Back,
    /// The view from the left, from +y of the world.
    Left,
    /// The view from the right, from -y of the world.
    Right,
    /// The view from above, from +z of the world, with +x up in the picture.
    Top,
}

impl Side {
    /// Returns the direction from the scene to the camera; not of unit length.
    fn direction(self) -> Vec3 {
        match self {
            Side::Corner => Vec3::new(0.57, -0.71, 0.41),
            Side::Front => Vec3::new(1.0, 0.0, 0.12),
            Side::Back => Vec3::new(-1.0, 0.0, 0.12),
            Side::Left => Vec3::new(0.0, 1.0, 0.12),
            Side::Right => Vec3::new(0.0, -1.0, 0.12),
            // Slightly from behind, so that right and left are defined.
            Side::Top => Vec3::new(-0.001, 0.0, 1.0),
        }
    }
}

/// The options of a still picture. [`png()`] panics for a width or height of 0.
#[derive(Clone, Copy, Debug)]
pub struct StillOptions {
    /// The time of the picture in the plan, s; clamped to the part that is played, from 0 to the first failure or the
    /// end. Default 0.
    pub time: f64,
    /// The viewpoint from which the picture is taken. Default [`Side::Corner`].
    pub side: Side,
    /// The width of the picture in pixels, at least 1. Default 1280.
    pub width: usize,
    /// The height of the picture in pixels, at least 1. Default 800.
    pub height: usize,
}

impl Default for StillOptions {
    fn default() -> StillOptions {
        StillOptions { time: 0.0, side: Side::Corner, width: 1280, height: 800 }
    }
}

/// Returns a still picture of a plan as the bytes of a PNG file with red, green and blue of 8 bits each. `input`: the
/// plan with its title; `options`: time, viewpoint and size. Panics for a width or height of 0.
pub fn png(input: &RenderInput, options: &StillOptions) -> Vec<u8> {
    encoded(options, &scene(input, options).pixels(), None)
}

/// Renders a plan at several times (s) from one viewpoint, so that the camera rests while the robot moves: `see` receives
/// the palette of each picture as (red, green, blue), at most `palette::COLOURS_MAX` colours, and the index in it of
/// each pixel, row by row from the top. `options`: viewpoint and size; its time is not read. Panics for a width or height
/// of 0.
pub fn frames(
    input: &RenderInput,
    options: &StillOptions,
    times: &[f64],
    see: &mut dyn FnMut(Vec<[u8; 3]>, Vec<u8>),
) {
    let paths = LinkPaths::of(input.plan);
    let end = findings::end(input.plan);
    let bodies = |time: f64| match (input.plan.body.tracks(), &paths) {
        (Some(tracks), Some(paths)) => bodies::robot(input, tracks, time, &paths.at(time)),
        _ => drawn(input, time),
    };
    let times: Vec<f64> = times.iter().map(|time| time.clamp(0.0, end)).collect();
    let balls = times.iter().map(|time| ball(&bodies(*time)));
    let Some(around) = balls.reduce(around_both) else { return };
    let slope = surroundings::slope(input.plan).unwrap_or_default();
    let ground = surroundings::floor(input.plan).then_some(slope);
    for time in times {
        let (colours, indices) =
            palette::reduced(&Scene::new(bodies(time), around, ground, options).pixels());
        see(colours, indices);
    }
}

/// Returns the smallest ball around two balls, each as (centre, radius), m.
fn around_both(a: (Vec3, f64), b: (Vec3, f64)) -> (Vec3, f64) {
    let apart = (b.0 - a.0).norm();
    if apart + b.1 <= a.1 {
        a
    } else if apart + a.1 <= b.1 {
        b
    } else {
        let radius = (apart + a.1 + b.1) / 2.0;
        (a.0 + (b.0 - a.0) * ((radius - a.1) / apart), radius)
    }
}

/// Returns a picture as the bytes of a PNG file with at most [`palette::COLOURS_MAX`] colours, a fifth as large, for a
/// page to hold.
pub(super) fn small_png(input: &RenderInput, options: &StillOptions) -> Vec<u8> {
    let (colours, pixels) = palette::reduced(&scene(input, options).pixels());
    encoded(options, &pixels, Some(&colours))
}

/// Returns the bodies at the time of the picture, with camera and light.
fn scene(input: &RenderInput, options: &StillOptions) -> Scene {
    let time = options.time.clamp(0.0, findings::end(input.plan));
    let bodies = drawn(input, time);
    let slope = surroundings::slope(input.plan).unwrap_or_default();
    let ground = surroundings::floor(input.plan).then_some(slope);
    let around = ball(&bodies);
    Scene::new(bodies, around, ground, options)
}

/// A scene with its camera and light; lengths in metres.
struct Scene {
    bodies: Vec<Drawn>,
    camera: Camera,
    /// The orthographic camera of the shadow map, in the direction of the sun.
    sun: Camera,
    /// The shadow map: the depths of the bodies as the sun sees them.
    shadows: Canvas,
    /// The triangles that the camera sees, and of each the indices of its body and of the triangle in its mesh.
    facets: Vec<Facet>,
    triangles: Vec<(usize, usize)>,
    /// The centre of the bodies' bounding box, and half its diagonal.
    middle: Vec3,
    radius: f64,
    /// The rise of the floor along x and along y, m per m; `None` if none is drawn.
    ground: Option<[f64; 2]>,
    /// The width and height in samples.
    width: usize,
    height: usize,
    /// Gamma correction from linear light to sRGB, in 1024 steps.
    gamma: Vec<f32>,
}

impl Scene {
    /// Sets up the camera so that a ball, as (centre, radius) in m, is in the picture, the sun, and its shadow map.
    fn new(
        bodies: Vec<Drawn>,
        around: (Vec3, f64),
        ground: Option<[f64; 2]>,
        options: &StillOptions,
    ) -> Scene {
        let (middle, radius) = around;
        let (width, height) = (options.width * SUPERSAMPLING, options.height * SUPERSAMPLING);
        let narrow = (width as f64 / height as f64).min(1.0);
        let distance = 0.92 * radius
            / (HALF_FOV_TANGENT / libm::sqrt(1.0 + HALF_FOV_TANGENT * HALF_FOV_TANGENT))
            / narrow;
        let at = middle + options.side.direction().normalize() * distance;
        let camera = Camera::new(at, middle, Vec3::z(), HALF_FOV_TANGENT, false);
        let sun = Camera::new(middle + SUN * (3.0 * radius), middle, Vec3::y(), 1.1 * radius, true);
        let mut shadows = Canvas::new(SHADOW_MAP_SIZE, SHADOW_MAP_SIZE, 0..SHADOW_MAP_SIZE);
        let seen = |camera: &Camera, width: usize, height: usize| -> (Vec<Facet>, Vec<(usize, usize)>) {
            let triangles = bodies.iter().enumerate();
            let triangles =
                triangles.flat_map(|(i, body)| (0..body.mesh.triangles.len()).map(move |j| (i, j)));
            let facet = |at: (usize, usize)| {
                let (corners, _) = &bodies[at.0].mesh.triangles[at.1];
                Some((Facet::new(corners, camera, width, height)?, at))
            };
            triangles.filter_map(facet).unzip()
        };
        shadows.fill(&seen(&sun, SHADOW_MAP_SIZE, SHADOW_MAP_SIZE).0);
        let (facets, triangles) = seen(&camera, width, height);
        let gamma = (0..1024).map(|i| libm::pow(f64::from(i) / 1023.0, 1.0 / 2.2) as f32).collect();
        Scene {
            bodies,
            camera,
            sun,
            shadows,
            facets,
            triangles,
            middle,
            radius,
            ground,
            width,
            height,
            gamma,
        }
    }

    /// Renders the bodies, their sharp edges and the background: red, green and blue of each pixel, row by row from the
    /// top. The samples of a few rows at a time are held, not those of the whole picture.
    fn pixels(&self) -> Vec<u8> {
        let bases: Vec<[f64; 3]> =
            self.bodies.iter().map(|body| body.colour.0.map(|c| libm::pow(c, 2.2))).collect();
        let floor = self.ground.map(|slope| Floor::new(self, slope));
        let mut pixels = Vec::with_capacity(self.width * self.height * 3 / (SUPERSAMPLING * SUPERSAMPLING));
        for top in (0..self.height).step_by(BAND_HEIGHT) {
            let rows = top..(top + BAND_HEIGHT).min(self.height);
            let mut canvas = Canvas::new(self.width, self.height, rows);
            canvas.fill(&self.facets);
            canvas.shade(
                &self.facets,
                &|facet, weights| {
                    let (body, triangle) = self.triangles[facet];
                    let (corners, normals) = &self.bodies[body].mesh.triangles[triangle];
                    let mix = |of: &[Vec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
                    self.lit(bases[body], mix(corners), mix(normals))
                },
                &|x, y| {
                    let part = floor.as_ref().map_or(0.0, |floor| floor.shading(x, y));
                    self.sky(y).mixed(INK, part).0.map(|c| c as f32)
                },
            );
            for body in &self.bodies {
                let dark = Rgb(body.colour.0.map(|c| c * 0.42));
                canvas.lines(&body.mesh.edges, &self.camera, SUPERSAMPLING - 1, dark);
            }
            push_means(&canvas, &mut pixels);
        }
        pixels
    }

    /// Returns the shaded colour of a surface point.
    fn lit(&self, base: [f64; 3], p: Vec3, normal: Vec3) -> [f32; 3] {
        let n = normal.normalize();
        let facing = n.dot(&SUN).max(0.0);
        let direct = if facing > 0.0 {
            facing * self.sunlight(&(p + n * (TOLERANCES.shadow * self.radius)))
        } else {
            0.0
        };
        let sky = 0.5 + 0.5 * n.z;
        let away = (self.camera.at - p).normalize();
        let rim = 1.0 - n.dot(&away).max(0.0);
        const SKY: [(f64, f64, f64); 3] = [(0.30, 0.56, 0.92), (0.29, 0.60, 0.88), (0.28, 0.66, 0.80)];
        let part = |i: usize| {
            let (low, high, sun) = SKY[i];
            let light = low + (high - low) * sky + direct * sun + 0.35 * rim * rim * rim;
            self.shown(base[i] * light)
        };
        [part(0), part(1), part(2)]
    }

    /// Returns linear light in 0..1 as a gamma-corrected value.
    fn shown(&self, light: f64) -> f32 {
        self.gamma[(light.clamp(0.0, 1.0) * 1023.0) as usize]
    }

    /// Returns the part of the sun visible from a point, 0..1, by the shadow map filtered over nine
    /// samples.
    fn sunlight(&self, p: &Vec3) -> f64 {
        let Some(spot) = self.sun.project(p, SHADOW_MAP_SIZE, SHADOW_MAP_SIZE) else { return 1.0 };
        let slack = TOLERANCES.shadow_depth * self.radius;
        let (x, y) = (spot.x.floor() as i64, spot.y.floor() as i64);
        let inside = |c: i64| (0..SHADOW_MAP_SIZE as i64).contains(&c);
        let mut seen = 9;
        for y in (y - 1..=y + 1).filter(|y| inside(*y)) {
            for x in (x - 1..=x + 1).filter(|x| inside(*x)) {
                let depth = self.shadows.depths[y as usize * SHADOW_MAP_SIZE + x as usize];
                seen -= usize::from(f64::from(depth) > spot.depth + slack);
            }
        }
        seen as f64 / 9.0
    }

    /// Returns the colour of the sky in a row of samples.
    fn sky(&self, y: usize) -> Rgb {
        let up = 1.0 - y as f64 / self.height as f64;
        let u = ((up - 0.1) / 0.9).clamp(0.0, 1.0);
        BELOW.mixed(ABOVE, u * u * (3.0 - 2.0 * u))
    }
}

/// The ground of a scene, a plane with a grid and shadows on it.
struct Floor<'a> {
    scene: &'a Scene,
    /// Its rise along x and along y, m per m.
    slope: [f64; 2],
    /// The height of the camera above it, m.
    height: f64,
    /// The distance from the middle of the scene at which it has faded away, m.
    reach: f64,
    /// The distance between grid lines, m: the power of ten below the size of the scene.
    step: f64,
}

impl Floor<'_> {
    /// Returns the ground of a scene, a plane of this slope.
    fn new(scene: &Scene, slope: [f64; 2]) -> Floor<'_> {
        let height = above(slope, &scene.camera.at);
        let reach = f64::max(6.0 * scene.radius, 2.5 * scene.camera.distance);
        let step = libm::pow(10.0, libm::floor(libm::log10(scene.radius * 0.9)));
        Floor { scene, slope, height, reach, step }
    }

    /// Returns the darkness of the ground at a sample of the picture, 0..1: grid lines and shadow.
    fn shading(&self, x: usize, y: usize) -> f64 {
        let scene = self.scene;
        let ray = scene.camera.ray(x as f64 + 0.5, y as f64 + 0.5, scene.width, scene.height);
        // The height that a metre along the ray gains.
        let rate = above(self.slope, &ray);
        if rate >= 0.0 || self.height <= 0.0 {
            return 0.0;
        }
        // The point where the ray meets the plane.
        let away = -self.height / rate;
        let p = scene.camera.at + ray * away;
        let out = libm::hypot(p.x - scene.middle.x, p.y - scene.middle.y) / self.reach;
        if out >= 0.95 {
            return 0.0;
        }
        let u = ((out - 0.15) / 0.8).clamp(0.0, 1.0);
        let fade = 1.0 - u * u * (3.0 - 2.0 * u);
        // The footprint of a pixel: across the ray, and along the ground.
        let pixel = 2.0 * HALF_FOV_TANGENT * away / scene.height as f64;
        let long = pixel / -rate;
        let grid = |step: f64| {
            let line = |c: f64| {
                let off = (c / step - libm::round(c / step)).abs() * step;
                (1.5 - off / f64::max(pixel * SUPERSAMPLING as f64 * 0.7, long * 0.7)).clamp(0.0, 1.0)
            };
            f64::max(line(p.x), line(p.y)) * (step / long / SUPERSAMPLING as f64 / 8.0 - 0.25).clamp(0.0, 1.0)
        };
        let lines = f64::max(grid(self.step) * 0.10, grid(10.0 * self.step) * 0.22);
        let shade = (1.0 - scene.sunlight(&p)) * 0.34;
        (1.0 - (1.0 - lines) * (1.0 - shade)) * fade
    }
}

/// Returns the height of a point above a plane of this slope through the origin, m.
fn above(slope: [f64; 2], v: &Vec3) -> f64 {
    v.z - slope[0] * v.x - slope[1] * v.y
}

/// Returns the centre and half the diagonal of the bounding box of all bodies, in metres.
fn ball(bodies: &[Drawn]) -> (Vec3, f64) {
    let points = || bodies.iter().flat_map(|b| b.mesh.triangles.iter().flat_map(|(p, _)| p));
    let Some(first) = points().next() else { return (Vec3::zeros(), 1.0) };
    let bound = |pick: fn(f64, f64) -> f64| points().fold(*first, |m, p| m.zip_map(p, pick));
    let (low, high) = (bound(f64::min), bound(f64::max));
    ((low + high) / 2.0, ((high - low).norm() / 2.0).max(TOLERANCES.radius))
}

/// Appends red, green and blue of each pixel of some rows: the means of its samples.
fn push_means(canvas: &Canvas, pixels: &mut Vec<u8>) {
    for (y, x) in canvas
        .rows
        .clone()
        .step_by(SUPERSAMPLING)
        .flat_map(|y| (0..canvas.width).step_by(SUPERSAMPLING).map(move |x| (y, x)))
    {
        let mut sums = [0.0_f32; 3];
        for row in y..y + SUPERSAMPLING {
            let at = canvas.place(x, row);
            for colour in &canvas.colours[at..at + SUPERSAMPLING] {
                (0..3).for_each(|part| sums[part] += colour[part]);
            }
        }
        let means = sums.map(|sum| sum / (SUPERSAMPLING * SUPERSAMPLING) as f32);
        pixels.extend(means.map(|mean| libm::roundf(mean * 255.0) as u8));
    }
}

/// Returns pixels as the bytes of a PNG file; `pixels` holds red, green and blue of each, 3 times `width` times
/// `height` bytes, row by row from the top. Panics on another number of them.
pub(super) fn encode_rgb(width: usize, height: usize, pixels: &[u8]) -> Vec<u8> {
    encoded(&StillOptions { width, height, ..StillOptions::default() }, pixels, None)
}

/// Returns a picture with a palette as the bytes of a PNG file. `size`: width and height in pixels; `colours`: the palette
/// as (red, green, blue); `pixels`: the index in it of each pixel, row by row from the top. Panics on another number of
/// pixels than the size says.
pub fn indexed_png(size: (usize, usize), colours: &[[u8; 3]], pixels: &[u8]) -> Vec<u8> {
    let (width, height) = size;
    encoded(&StillOptions { width, height, ..StillOptions::default() }, pixels, Some(colours))
}

/// Returns pixels as PNG: red, green and blue of each, or palette indices if `colours` is given.
fn encoded(options: &StillOptions, pixels: &[u8], colours: Option<&[[u8; 3]]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, options.width as u32, options.height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    match colours {
        None => encoder.set_color(png::ColorType::Rgb),
        Some(colours) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(colours.as_flattened());
            encoder.set_filter(png::Filter::NoFilter);
        }
    }
    let mut writer = encoder.write_header().expect("a picture has at least one pixel");
    writer.write_image_data(pixels).expect("a picture has as many pixels as it says");
    writer.finish().expect("memory takes all bytes");
    bytes
}
