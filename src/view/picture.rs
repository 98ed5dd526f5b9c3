//! A still picture of a plan at a time, as PNG: drawn on the processor, the same bytes everywhere.

use super::bodies::{Drawn, drawn};
use super::colour::Rgb;
use super::raster::{Canvas, Eye};
use super::{RenderInput, findings, palette, surroundings};
use crate::geometry::Vec3;

/// Pixels of a picture are the mean of so many by so many.
const FINE: usize = 3;

/// Pixels of the map of shadows, each way.
const SHADOWS: usize = 1400;

/// Tangent of half the angle of sight: 38 degrees, as on the page.
const SIGHT: f64 = 0.344_327_6;

const SUN: Vec3 = Vec3::new(0.334, -0.437, 0.835);
const ABOVE: Rgb = Rgb([0.906, 0.918, 0.925]);
const BELOW: Rgb = Rgb([0.965, 0.957, 0.937]);
const INK: Rgb = Rgb([0.125, 0.188, 0.235]);

/// From where a picture is taken. +x is ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Corner,
    Front,
    Back,
    Left,
    Right,
    Top,
}

impl Side {
    /// The direction towards the eye; need not be of unit length.
    fn direction(self) -> Vec3 {
        match self {
            Side::Corner => Vec3::new(0.57, -0.71, 0.41),
            Side::Front => Vec3::new(1.0, 0.0, 0.12),
            Side::Back => Vec3::new(-1.0, 0.0, 0.12),
            Side::Left => Vec3::new(0.0, 1.0, 0.12),
            Side::Right => Vec3::new(0.0, -1.0, 0.12),
            // A little from behind, or there would be no right and left.
            Side::Top => Vec3::new(-0.001, 0.0, 1.0),
        }
    }
}

/// The options of a still picture.
#[derive(Clone, Copy, Debug)]
pub struct StillOptions {
    /// Seconds; clipped to what the page plays.
    pub time: f64,
    pub side: Side,
    /// Pixels.
    pub width: usize,
    pub height: usize,
}

impl Default for StillOptions {
    fn default() -> StillOptions {
        StillOptions { time: 0.0, side: Side::Corner, width: 1280, height: 800 }
    }
}

/// A picture as the bytes of a PNG file.
pub fn png(input: &RenderInput, options: &StillOptions) -> Vec<u8> {
    let pixels = pixels(&canvas(input, options), options);
    encoded(options, &pixels, None)
}

/// The same in a few colours, a fifth as large: for a page to hold.
pub(super) fn small_png(input: &RenderInput, options: &StillOptions) -> Vec<u8> {
    let (colours, pixels) = palette::reduced(&pixels(&canvas(input, options), options));
    encoded(options, &pixels, Some(&colours))
}

fn canvas(input: &RenderInput, options: &StillOptions) -> Canvas {
    let time = options.time.clamp(0.0, findings::end(input.plan));
    let bodies = drawn(input, time);
    Scene::new(bodies, surroundings::floor(input.plan), options).canvas()
}

struct Scene {
    bodies: Vec<Drawn>,
    eye: Eye,
    sun: Eye,
    shadows: Canvas,
    middle: Vec3,
    radius: f64,
    grounded: bool,
    width: usize,
    height: usize,
    /// From light to what a screen is told, in 1024 steps.
    gamma: Vec<f32>,
}

impl Scene {
    fn new(bodies: Vec<Drawn>, grounded: bool, options: &StillOptions) -> Scene {
        let (middle, radius) = ball(&bodies);
        let (width, height) = (options.width * FINE, options.height * FINE);
        let narrow = (width as f64 / height as f64).min(1.0);
        let distance = 0.92 * radius / (SIGHT / libm::sqrt(1.0 + SIGHT * SIGHT)) / narrow;
        let at = middle + options.side.direction().normalize() * distance;
        let eye = Eye::new(at, middle, Vec3::z(), SIGHT, false);
        let sun = Eye::new(middle + SUN * (3.0 * radius), middle, Vec3::y(), 1.1 * radius, true);
        let mut shadows = Canvas::new(SHADOWS, SHADOWS);
        for body in &bodies {
            shadows.fill(&body.mesh, &sun, &mut |_, _| [0.0; 3]);
        }
        let gamma = (0..1024).map(|i| libm::pow(f64::from(i) / 1023.0, 1.0 / 2.2) as f32).collect();
        Scene { bodies, eye, sun, shadows, middle, radius, grounded, width, height, gamma }
    }

    fn canvas(&self) -> Canvas {
        let mut canvas = Canvas::new(self.width, self.height);
        for body in &self.bodies {
            let base = body.colour.0.map(|c| libm::pow(c, 2.2));
            canvas.fill(&body.mesh, &self.eye, &mut |p, n| self.lit(base, p, n));
        }
        for body in &self.bodies {
            let dark = Rgb(body.colour.0.map(|c| c * 0.42));
            canvas.lines(&body.mesh.edges, &self.eye, FINE - 1, dark);
        }
        self.background(&mut canvas);
        canvas
    }

    /// The colour of a point of a surface.
    fn lit(&self, base: [f64; 3], p: Vec3, normal: Vec3) -> [f32; 3] {
        let n = normal.normalize();
        let facing = n.dot(&SUN).max(0.0);
        let direct =
            if facing > 0.0 { facing * self.sunlight(&(p + n * (0.004 * self.radius))) } else { 0.0 };
        let sky = 0.5 + 0.5 * n.z;
        let away = (self.eye.at - p).normalize();
        let rim = 1.0 - n.dot(&away).max(0.0);
        const SKY: [(f64, f64, f64); 3] = [(0.30, 0.56, 0.92), (0.29, 0.60, 0.88), (0.28, 0.66, 0.80)];
        let part = |i: usize| {
            let (low, high, sun) = SKY[i];
            let light = low + (high - low) * sky + direct * sun + 0.35 * rim * rim * rim;
            self.shown(base[i] * light)
        };
        [part(0), part(1), part(2)]
    }

    fn shown(&self, light: f64) -> f32 {
        self.gamma[(light.clamp(0.0, 1.0) * 1023.0) as usize]
    }

    /// How much of the sun a point sees, 0..1.
    fn sunlight(&self, p: &Vec3) -> f64 {
        let Some(spot) = self.sun.spot(p, SHADOWS, SHADOWS) else { return 1.0 };
        let slack = 0.006 * self.radius;
        let mut seen = 0;
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            let (x, y) = (spot.x.floor() as i64 + dx, spot.y.floor() as i64 + dy);
            let inside = |c: i64| (0..SHADOWS as i64).contains(&c);
            let dark = inside(x) && inside(y) && {
                let depth = self.shadows.depths[y as usize * SHADOWS + x as usize];
                f64::from(depth) > spot.depth + slack
            };
            seen += usize::from(!dark);
        }
        seen as f64 / 9.0
    }

    /// The sky, and the ground with its grid and shadows, where nothing else is.
    fn background(&self, canvas: &mut Canvas) {
        for y in 0..self.height {
            let up = 1.0 - y as f64 / self.height as f64;
            let u = ((up - 0.1) / 0.9).clamp(0.0, 1.0);
            let sky = BELOW.mixed(ABOVE, u * u * (3.0 - 2.0 * u));
            for x in 0..self.width {
                let at = y * self.width + x;
                if canvas.depths[at] > f32::NEG_INFINITY {
                    continue;
                }
                let part = if self.grounded { self.ground(x, y) } else { 0.0 };
                canvas.colours[at] = sky.mixed(INK, part).0.map(|c| c as f32);
            }
        }
    }

    /// How much ink the ground has at a pixel.
    fn ground(&self, x: usize, y: usize) -> f64 {
        let ray = self.eye.ray(x as f64 + 0.5, y as f64 + 0.5, self.width, self.height);
        if ray.z >= 0.0 || self.eye.at.z <= 0.0 {
            return 0.0;
        }
        let away = -self.eye.at.z / ray.z;
        let p = self.eye.at + ray * away;
        let reach = f64::max(6.0 * self.radius, 2.5 * self.eye.distance);
        let out = libm::hypot(p.x - self.middle.x, p.y - self.middle.y) / reach;
        if out >= 0.95 {
            return 0.0;
        }
        let u = ((out - 0.15) / 0.8).clamp(0.0, 1.0);
        let fade = 1.0 - u * u * (3.0 - 2.0 * u);
        // What a pixel covers: across the ray, and along the ground.
        let pixel = 2.0 * SIGHT * away / self.height as f64;
        let long = pixel / -ray.z;
        let grid = |step: f64| {
            let line = |c: f64| {
                let off = (c / step - libm::round(c / step)).abs() * step;
                (1.5 - off / f64::max(pixel * FINE as f64 * 0.7, long * 0.7)).clamp(0.0, 1.0)
            };
            f64::max(line(p.x), line(p.y)) * (step / long / FINE as f64 / 8.0 - 0.25).clamp(0.0, 1.0)
        };
        let step = libm::pow(10.0, libm::floor(libm::log10(self.radius * 0.9)));
        let lines = f64::max(grid(step) * 0.10, grid(10.0 * step) * 0.22);
        let shade = (1.0 - self.sunlight(&p)) * 0.34;
        (1.0 - (1.0 - lines) * (1.0 - shade)) * fade
    }
}

/// The middle and half the size of a box around everything, m.
fn ball(bodies: &[Drawn]) -> (Vec3, f64) {
    let points = || bodies.iter().flat_map(|b| b.mesh.triangles.iter().flat_map(|(p, _)| p));
    let Some(first) = points().next() else { return (Vec3::zeros(), 1.0) };
    let bound = |pick: fn(f64, f64) -> f64| points().fold(*first, |m, p| m.zip_map(p, pick));
    let (low, high) = (bound(f64::min), bound(f64::max));
    ((low + high) / 2.0, ((high - low).norm() / 2.0).max(1e-6))
}

/// The fine picture's means: red, green and blue of each pixel.
fn pixels(canvas: &Canvas, options: &StillOptions) -> Vec<u8> {
    let (width, height) = (options.width, options.height);
    let mut pixels = Vec::with_capacity(width * height * 3);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        for part in 0..3 {
            let fine = (0..FINE * FINE).map(|i| {
                let (fx, fy) = (x * FINE + i % FINE, y * FINE + i / FINE);
                canvas.colours[fy * canvas.width + fx][part]
            });
            let mean = fine.sum::<f32>() / (FINE * FINE) as f32;
            pixels.push(libm::roundf(mean * 255.0) as u8);
        }
    }
    pixels
}

/// Pixels as PNG: red, green and blue of each, or its place among the colours.
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
