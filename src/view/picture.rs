//! A still picture of a plan at one time, as PNG, rendered on the processor: the same bytes on every
//! machine.

use super::bodies::{self, Drawn, drawn};
use super::input::RenderInput;
use super::light::Fineness;
use super::scene::{Content, Scene};
use super::{findings, palette, surroundings};
use crate::geometry::Vec3;
use crate::plan::verify::articulated::LinkPaths;

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
    pub(super) fn direction(self) -> Vec3 {
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

/// The width in pixels below which a picture has the light of a quick one: it hardly shows a difference.
const WIDTH_FINE: usize = 600;

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
    /// The look of the picture. Default [`PictureStyle::Room`].
    pub look: PictureStyle,
}

/// The look of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureStyle {
    /// In daylight on a ground with a grid.
    Room,
    /// For print: on white without a grid, edges drawn out.
    Figure,
}

impl Default for StillOptions {
    fn default() -> StillOptions {
        StillOptions { time: 0.0, side: Side::Corner, width: 1280, height: 800, look: PictureStyle::Room }
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
        (Some(tracks), Some(paths)) => bodies::robot(input, tracks, time, &paths.at(time), options.width),
        _ => drawn(input, time, options.width),
    };
    let times: Vec<f64> = times.iter().map(|time| time.clamp(0.0, end)).collect();
    let around: Vec<Vec3> = times.iter().flat_map(|time| corners(&bodies(*time))).collect();
    let ground = ground(input);
    for time in times {
        let content = Content { bodies: bodies(time), around: around.clone(), ground };
        let (colours, indices) = palette::reduced(&Scene::new(content, options, Fineness::Quick).pixels());
        see(colours, indices);
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
    let fineness = if options.width < WIDTH_FINE { Fineness::Quick } else { Fineness::Fine };
    let time = options.time.clamp(0.0, findings::end(input.plan));
    let bodies = drawn(input, time, options.width);
    let around = corners(&bodies);
    Scene::new(Content { bodies, around, ground: ground(input) }, options, fineness)
}

/// Returns the rise of the floor along x and along y, m per m; `None` if there is none.
fn ground(input: &RenderInput) -> Option<[f64; 2]> {
    let slope = surroundings::slope(input.plan).unwrap_or_default();
    surroundings::floor(input.plan).then_some(slope)
}

/// Returns the corners of a box around each body, in m in the world.
fn corners(bodies: &[Drawn]) -> Vec<Vec3> {
    let of = |body: &Drawn| {
        let mut points = body.mesh.triangles.iter().flat_map(|(corners, _)| corners);
        let first = *points.next()?;
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let corner = move |i: usize| {
            let at = |axis: usize| if i >> axis & 1 == 1 { high[axis] } else { low[axis] };
            Vec3::new(at(0), at(1), at(2))
        };
        Some((0..8).map(corner))
    };
    bodies.iter().filter_map(of).flatten().collect()
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
    match colours {
        None => {
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_compression(png::Compression::Balanced);
        }
        Some(colours) => {
            encoder.set_compression(png::Compression::High);
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
