//! A still picture under construction: bodies with camera, light and ground, and the colours of its pixels.

use super::bodies::Drawn;
use super::colour::Rgb;
use super::framing;
use super::light::{Fineness, Light, SAMPLES, shaded};
use super::openness::Openness;
use super::picture::{PictureStyle, StillOptions};
use super::raster::{Camera, Canvas, Facet};
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;

/// Supersampling: a pixel is the mean of this many by this many samples.
const SUPERSAMPLING: usize = 3;
const _: () = assert!(SUPERSAMPLING * SUPERSAMPLING == SAMPLES);

/// The number of rows of samples that are rendered at once, a multiple of [`SUPERSAMPLING`].
const BAND_HEIGHT: usize = 16 * SUPERSAMPLING;

/// The colour of the sky at the top of the picture.
const ABOVE: Rgb = Rgb([0.875, 0.894, 0.910]);
/// The colour of the sky at the bottom of the picture.
const BELOW: Rgb = Rgb([0.969, 0.965, 0.953]);
/// The colour of a picture for print behind everything.
const WHITE: Rgb = Rgb([1.0, 1.0, 1.0]);
/// The colour of grid lines and shadows on the ground.
const INK: Rgb = Rgb([0.133, 0.173, 0.212]);
/// The colours of the axes x and y of the world, on the ground: red and green, as robotics has them.
const AXES: [Rgb; 2] = [Rgb([0.698, 0.227, 0.118]), Rgb([0.208, 0.537, 0.247])];

/// The part of its brightness that a surface keeps at its sharp edges, in a room and in print.
const EDGE_ROOM: f32 = 0.84;
const EDGE_FIGURE: f32 = 0.25;

/// The content of a picture.
pub(super) struct Content {
    /// The bodies.
    pub bodies: Vec<Drawn>,
    /// The points that have to be in the picture, m in the world.
    pub around: Vec<Vec3>,
    /// The rise of the floor along x and along y, m per m; `None` if there is none.
    pub ground: Option<[f64; 2]>,
}

/// A scene with its camera and light; lengths in metres.
pub(super) struct Scene {
    bodies: Vec<Drawn>,
    camera: Camera,
    light: Light,
    /// The triangles that the camera sees, and of each the indices of its body and of the triangle in its mesh.
    facets: Vec<Facet>,
    triangles: Vec<(usize, usize)>,
    /// The centre of the bodies' bounding box, half its diagonal, and its lowest height.
    middle: Vec3,
    radius: f64,
    lowest: f64,
    /// The rise of the floor along x and along y, m per m; `None` if there is none.
    ground: Option<[f64; 2]>,
    /// The width and height in samples.
    width: usize,
    height: usize,
    look: PictureStyle,
}

impl Scene {
    /// Sets up a camera that the content fills the picture of, and the light.
    pub(super) fn new(content: Content, options: &StillOptions, fineness: Fineness) -> Scene {
        let Content { bodies, around, ground } = content;
        let (width, height) = (options.width * SUPERSAMPLING, options.height * SUPERSAMPLING);
        let camera = framing::camera(&around, options.side.direction(), width as f64 / height as f64);
        let (low, high) = bounds(&bodies);
        let (middle, radius) = ((low + high) / 2.0, ((high - low).norm() / 2.0).max(TOLERANCES.radius));
        let light = Light::new(&bodies, (middle, radius), fineness, options.width);
        let numbers = bodies.iter().enumerate();
        let numbers = numbers.flat_map(|(i, body)| (0..body.mesh.triangles.len()).map(move |j| (i, j)));
        let facet = |at: (usize, usize)| {
            let (corners, _) = &bodies[at.0].mesh.triangles[at.1];
            Some((Facet::new(corners, &camera, width, height)?, at))
        };
        let (facets, triangles) = numbers.filter_map(facet).unzip();
        Scene {
            bodies,
            camera,
            light,
            facets,
            triangles,
            middle,
            radius,
            lowest: low.z,
            ground,
            width,
            height,
            look: options.look,
        }
    }

    /// Renders the bodies, their sharp edges and the background: red, green and blue of each pixel, row by row from the
    /// top. The samples of a few rows at a time are held, not those of the whole picture.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let bases: Vec<[f64; 3]> = self.bodies.iter().map(|body| body.colour.0.map(|c| c * c)).collect();
        let floor = Floor::new(self);
        let bands = self.bands();
        let band = |(number, facets): (usize, &Vec<u32>)| {
            let top = number * BAND_HEIGHT;
            let rows = top..(top + BAND_HEIGHT).min(self.height);
            let mut canvas = Canvas::new(self.width, self.height, rows);
            canvas.fill(&self.facets, facets);
            for body in self.bodies.iter().filter(|body| !body.metal) {
                canvas.mark(&body.mesh.edges, &self.camera, SUPERSAMPLING - 1);
            }
            canvas.shade(
                &self.facets,
                &|facet, weights, (x, y)| {
                    let (body, triangle) = self.triangles[facet];
                    let (corners, normals) = &self.bodies[body].mesh.triangles[triangle];
                    let mix = |of: &[Vec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
                    self.lit(&self.bodies[body], bases[body], (mix(corners), mix(normals)), sample(x, y))
                },
                &|x, y| floor.over(self.sky(y), x, y).0.map(|c| c as f32),
                if self.look == PictureStyle::Figure { EDGE_FIGURE } else { EDGE_ROOM },
            );
            let mut pixels = Vec::with_capacity(canvas.width * canvas.rows.len() * 3 / SAMPLES);
            push_means(&canvas, &mut pixels);
            pixels
        };
        bands.iter().enumerate().flat_map(band).collect()
    }

    /// Returns the indices of the triangles in each band of [`BAND_HEIGHT`] rows, from the top.
    fn bands(&self) -> Vec<Vec<u32>> {
        let mut bands = vec![Vec::new(); self.height.div_ceil(BAND_HEIGHT)];
        for (number, facet) in self.facets.iter().enumerate() {
            let rows = facet.rows(self.height);
            let touched = rows.start / BAND_HEIGHT..rows.end.div_ceil(BAND_HEIGHT);
            bands[touched].iter_mut().for_each(|band| band.push(number as u32));
        }
        bands
    }

    /// Returns the shaded colour of a surface point, by its place (m) and normal.
    fn lit(&self, body: &Drawn, base: [f64; 3], (p, normal): (Vec3, Vec3), sample: usize) -> [f32; 3] {
        let n = normal.normalize();
        let seen = self.light.seen(&p, &n, sample);
        let away = (self.camera.at - p).normalize();
        shaded(base, (&n, &away), seen, body.metal, self.look == PictureStyle::Figure)
    }

    /// Returns the colour of the sky in a row of samples.
    fn sky(&self, y: usize) -> Rgb {
        if self.look == PictureStyle::Figure {
            return WHITE;
        }
        let u = 1.0 - y as f64 / self.height as f64;
        BELOW.mixed(ABOVE, u * u * (3.0 - 2.0 * u))
    }
}

/// Returns the number of a sample in its pixel.
fn sample(x: usize, y: usize) -> usize {
    y % SUPERSAMPLING * SUPERSAMPLING + x % SUPERSAMPLING
}

/// The ground of a scene, a plane with a grid and shadows on it; where there is none, a grid below everything.
struct Floor<'a> {
    scene: &'a Scene,
    /// Its rise along x and along y, m per m.
    slope: [f64; 2],
    /// Its unit normal, upwards.
    normal: Vec3,
    /// The height of the camera above it, m.
    height: f64,
    /// The distance from the middle of the scene at which it has faded away, m.
    reach: f64,
    /// The distance between grid lines, m: the power of ten below the size of the scene.
    step: f64,
    /// The part of the sky that it sees; `None` where nothing shades it.
    openness: Option<Openness>,
}

impl Floor<'_> {
    fn new(scene: &Scene) -> Floor<'_> {
        let slope = scene.ground.unwrap_or_default();
        let level = if scene.ground.is_some() { 0.0 } else { scene.lowest };
        let height = above(slope, &scene.camera.at) - level;
        let reach = f64::max(6.0 * scene.radius, 2.5 * scene.camera.distance);
        let step = libm::pow(10.0, libm::floor(libm::log10(scene.radius * 0.9)));
        let normal = Vec3::new(-slope[0], -slope[1], 1.0).normalize();
        let point = |x: f64, y: f64| Vec3::new(x, y, slope[0] * x + slope[1] * y);
        let around = (scene.middle, scene.radius);
        let openness = scene.ground.map(|_| Openness::new(&scene.light, around, &normal, point));
        Floor { scene, slope, normal, height, reach, step, openness }
    }

    /// Returns the colour of the ground at a sample of the picture: grid lines and shadow over what lies behind.
    fn over(&self, behind: Rgb, x: usize, y: usize) -> Rgb {
        let scene = self.scene;
        let ray = scene.camera.ray(x as f64 + 0.5, y as f64 + 0.5, scene.width, scene.height);
        // The height that a metre along the ray gains.
        let rate = above(self.slope, &ray);
        if rate >= 0.0 || self.height <= 0.0 {
            return behind;
        }
        // The point where the ray meets the plane.
        let away = -self.height / rate;
        let p = scene.camera.at + ray * away;
        let out = (p - scene.middle).xy().norm() / self.reach;
        if out >= 0.85 {
            return behind;
        }
        let u = ((out - 0.10) / 0.75).clamp(0.0, 1.0);
        let fade = 1.0 - u * u * (3.0 - 2.0 * u);
        let shade = if self.openness.is_some() { self.shade(&p, sample(x, y)) } else { 0.0 };
        let (lines, ink) = self.lines(&p, away, rate);
        behind.mixed(INK, shade * fade).mixed(ink, lines * fade)
    }

    /// Returns the darkness of the shadow at a point of the ground, 0..1.
    fn shade(&self, p: &Vec3, sample: usize) -> f64 {
        let sun = self.scene.light.sun(p, &self.normal, sample);
        let sky = self.openness.as_ref().map_or(1.0, |openness| openness.at(p));
        1.0 - (1.0 - (1.0 - sun) * 0.24) * (1.0 - 0.55 * (1.0 - sky))
    }

    /// Returns the strength of the line of the grid at a point of the ground, 0..1, and its colour. `away`: the distance of
    /// the point, m; `rate`: the height that a metre along the ray gains.
    fn lines(&self, p: &Vec3, away: f64, rate: f64) -> (f64, Rgb) {
        let scene = self.scene;
        if scene.look == PictureStyle::Figure {
            return (0.0, INK);
        }
        // The footprint of a pixel: across the ray, and along the ground.
        let pixel = 2.0 * scene.camera.half * away / scene.height as f64;
        let long = pixel / -rate;
        let width = f64::max(pixel * SUPERSAMPLING as f64 * 0.7, long * 0.7);
        let grid = |step: f64| {
            let strength = (step / long / SUPERSAMPLING as f64 / 8.0 - 0.25).clamp(0.0, 1.0);
            let line = |c: f64| {
                let part = (c / step).abs();
                // The fraction, without a call of a library.
                let part = part - part as u64 as f64;
                (1.5 - part.min(1.0 - part) * step / width).clamp(0.0, 1.0)
            };
            if strength > 0.0 { f64::max(line(p.x), line(p.y)) * strength } else { 0.0 }
        };
        let part = if scene.ground.is_some() { 1.0 } else { 0.7 };
        let lines = f64::max(grid(self.step) * 0.075, grid(10.0 * self.step) * 0.17) * part;
        let axis = |c: f64| (1.3 - c.abs() / width).clamp(0.0, 1.0) * 0.38 * part;
        let (x, y) = (axis(p.y), axis(p.x));
        if x.max(y) <= lines {
            (lines, INK)
        } else if x >= y {
            (x, AXES[0])
        } else {
            (y, AXES[1])
        }
    }
}

/// Returns the height of a point above a plane of this slope through the origin, m.
fn above(slope: [f64; 2], v: &Vec3) -> f64 {
    v.z - slope[0] * v.x - slope[1] * v.y
}

/// Returns the corners of the bounding box of all bodies, m.
fn bounds(bodies: &[Drawn]) -> (Vec3, Vec3) {
    let mut points = bodies.iter().flat_map(|b| b.mesh.triangles.iter().flat_map(|(p, _)| p));
    let Some(first) = points.next() else { return (Vec3::zeros(), Vec3::repeat(1.0)) };
    points.fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)))
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
