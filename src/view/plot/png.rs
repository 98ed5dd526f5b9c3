//! A plot as PNG, drawn on the processor: the same bytes on every machine.
//!
//! Areas are filled by exact coverage: each edge of a polygon adds the signed area to its right, and sums along a row
//! give the part of each pixel that is inside.

use super::Plot;
use super::font;
use super::layout::lay_out;
use super::marks::{Anchor, Colour, Mark, Sheet};
use crate::view::picture::encode_rgb;
use crate::view::tolerances::TOLERANCES;

/// The number of corners of a circle.
const ROUND: usize = 16;

/// Returns a plot as the bytes of a PNG file with red, green and blue of 8 bits each. `width`: in pixels, at least 1;
/// the height follows from the shape of plots. Panics for a width of 0.
pub fn png(plot: &Plot, width: usize) -> Vec<u8> {
    let sheet = lay_out(plot);
    let scale = width as f64 / sheet.size[0];
    let height = libm::round(sheet.size[1] * scale).max(1.0) as usize;
    let mut picture = Picture::new(width, height, scale);
    picture.draw(&sheet);
    let bytes: Vec<u8> = picture.pixels.iter().map(|x| libm::roundf(x.clamp(0.0, 255.0)) as u8).collect();
    encode_rgb(width, height, &bytes)
}

/// A picture that is drawn.
struct Picture {
    width: usize,
    height: usize,
    scale: f64,
    /// Red, green and blue of each pixel, 0 to 255, row by row from the top.
    pixels: Vec<f32>,
    /// The coverage of the mark that is being drawn, two numbers more than pixels in each row.
    coverage: Vec<f32>,
}

impl Picture {
    fn new(width: usize, height: usize, scale: f64) -> Picture {
        let coverage = vec![0.0; (width + 2) * height];
        Picture { width, height, scale, pixels: vec![255.0; width * height * 3], coverage }
    }

    fn draw(&mut self, sheet: &Sheet) {
        for mark in &sheet.marks {
            match mark {
                Mark::Line { points, width, colour, dash } => {
                    let pieces = dash.map_or_else(|| vec![points.clone()], |dash| dashed(points, dash));
                    let mut outlines = Vec::new();
                    pieces.iter().for_each(|piece| stroke(piece, *width, &mut outlines));
                    self.fill(&outlines, *colour);
                }
                Mark::Area { corners, colour } => self.fill(&[counterclockwise(corners.clone())], *colour),
                Mark::Dot { at, radius, colour } => self.fill(&[circle(*at, *radius)], *colour),
                Mark::Text { at, size, colour, anchor, upwards, text } => {
                    let width = font::width(text);
                    let from = match anchor {
                        Anchor::Start => 0.0,
                        Anchor::Middle => -width / 2.0,
                        Anchor::End => -width,
                    };
                    let place = |[x, y]: [f64; 2]| {
                        let (x, y) = ((x + from) * size, y * size);
                        if *upwards { [at[0] - y, at[1] - x] } else { [at[0] + x, at[1] - y] }
                    };
                    let outlines = font::outlines(text);
                    let placed: Vec<Vec<[f64; 2]>> =
                        outlines.into_iter().map(|path| path.into_iter().map(place).collect()).collect();
                    self.fill(&placed, *colour);
                }
            }
        }
    }

    /// Fills closed outlines by their winding number: a point is inside where outlines of one direction outnumber
    /// those of the other.
    fn fill(&mut self, outlines: &[Vec<[f64; 2]>], colour: Colour) {
        let scale = self.scale;
        let (mut top, mut bottom) = (self.height, 0);
        for outline in outlines {
            for (i, a) in outline.iter().enumerate() {
                let b = outline[(i + 1) % outline.len()];
                let (a, b) = (a.map(|c| c * scale), b.map(|c| c * scale));
                let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
                top = top.min(libm::floor(low.max(0.0)) as usize);
                bottom = bottom.max((libm::ceil(high).max(0.0) as usize).min(self.height));
                self.edge(a, b);
            }
        }
        for row in top.min(bottom)..bottom {
            let mut sum = 0.0_f32;
            let cells = &mut self.coverage[row * (self.width + 2)..(row + 1) * (self.width + 2)];
            for (column, cell) in cells.iter_mut().enumerate() {
                sum += std::mem::take(cell);
                let part = sum.abs().min(1.0);
                if column < self.width && f64::from(part) > TOLERANCES.coverage {
                    let at = (row * self.width + column) * 3;
                    for (pixel, ink) in self.pixels[at..at + 3].iter_mut().zip(colour) {
                        *pixel += (f32::from(ink) - *pixel) * part;
                    }
                }
            }
        }
    }

    /// Adds an edge: in each row that it crosses, the signed area between it and the right end of the row.
    fn edge(&mut self, a: [f64; 2], b: [f64; 2]) {
        if a[1] == b[1] {
            return;
        }
        let (sign, a, b) = if a[1] < b[1] { (1.0, a, b) } else { (-1.0, b, a) };
        let slope = (b[0] - a[0]) / (b[1] - a[1]);
        let first = libm::floor(a[1].max(0.0)) as usize;
        let last = (libm::ceil(b[1]).max(0.0) as usize).min(self.height);
        for row in first..last {
            let (from, to) = (a[1].max(row as f64), b[1].min(row as f64 + 1.0));
            if to <= from {
                continue;
            }
            let (x0, x1) = (a[0] + (from - a[1]) * slope, a[0] + (to - a[1]) * slope);
            self.span(row, (x0.min(x1), x0.max(x1)), sign * (to - from));
        }
    }

    /// Adds a piece of an edge within a row, from one x to another, of a signed height.
    fn span(&mut self, row: usize, (from, to): (f64, f64), height: f64) {
        let (most, start) = (self.width as f64, row * (self.width + 2));
        let (from, to) = (from.clamp(0.0, most), to.clamp(0.0, most));
        let (first, last) = (libm::floor(from) as usize, libm::floor(to) as usize);
        // The covered part right of the edge grows from column to column.
        let mut before = 0.0;
        for column in first..=last {
            let right = column as f64 + 1.0;
            let area = right_of((from, to), right) - right_of((from, to), column as f64);
            self.coverage[start + column] += (height * (area - before)) as f32;
            before = area;
        }
        self.coverage[start + last + 1] += (height * (1.0 - before)) as f32;
    }
}

/// Returns the area right of an edge of height 1, between its start and `x`.
fn right_of((from, to): (f64, f64), x: f64) -> f64 {
    if to == from {
        return (x - from).max(0.0);
    }
    let along = (x.min(to) - from).max(0.0);
    along * along / (2.0 * (to - from)) + (x - to).max(0.0)
}

/// Returns a circle as a polygon.
fn circle([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (s, c) = libm::sincos(std::f64::consts::TAU * i as f64 / ROUND as f64);
        [x + radius * c, y + radius * s]
    };
    (0..ROUND).map(corner).collect()
}

/// Adds the outlines of a line of some width with round joints and ends, all in one direction.
fn stroke(points: &[[f64; 2]], width: f64, outlines: &mut Vec<Vec<[f64; 2]>>) {
    let half = width / 2.0;
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = libm::hypot(dx, dy);
        if length > 0.0 {
            let (nx, ny) = (-dy / length * half, dx / length * half);
            let corners = [
                [a[0] + nx, a[1] + ny],
                [a[0] - nx, a[1] - ny],
                [b[0] - nx, b[1] - ny],
                [b[0] + nx, b[1] + ny],
            ];
            outlines.push(counterclockwise(corners.to_vec()));
        }
    }
    // Pieces that hardly turn meet without a gap, and a joint over both would show as a bead.
    let ends = [points.first(), points.last()].into_iter().flatten();
    let bends = points.windows(3).filter(|three| turns(three)).map(|three| &three[1]);
    if width > 1.5 {
        outlines.extend(ends.chain(bends).map(|at| circle(*at, half)));
    }
}

/// The least cosine of the angle by which a line may turn without a round joint.
const SLIGHT_TURN: f64 = 0.97;

/// Returns true if a line turns at the middle one of three points.
fn turns(three: &[[f64; 2]]) -> bool {
    let step = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
    let (u, v) = (step(three[0], three[1]), step(three[1], three[2]));
    let lengths = libm::hypot(u[0], u[1]) * libm::hypot(v[0], v[1]);
    u[0] * v[0] + u[1] * v[1] < SLIGHT_TURN * lengths
}

/// Returns a polygon in the direction in which its signed area is positive.
fn counterclockwise(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let area: f64 = corners.iter().enumerate().map(|(i, a)| a[0] * next(i)[1] - next(i)[0] * a[1]).sum();
    if area < 0.0 {
        corners.reverse();
    }
    corners
}

/// Returns the pieces of a dashed line.
fn dashed(points: &[[f64; 2]], [on, off]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut pieces = Vec::new();
    let mut piece = points.first().map_or_else(Vec::new, |first| vec![*first]);
    let (mut left, mut drawing) = (on, true);
    for pair in points.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
            if length <= left {
                left -= length;
                if drawing {
                    piece.push(b);
                }
                break;
            }
            let part = left / length;
            a = [a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part];
            if drawing {
                piece.push(a);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![a];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}
