//! The font of plots: a subset of Roboto Regular (Google Inc., Apache-2.0), with the letters of Western European
//! languages, Greek and some signs. Letters that it lacks are drawn as boxes.

use std::sync::LazyLock;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static FACE: LazyLock<Face<'static>> =
    LazyLock::new(|| Face::parse(include_bytes!("roboto.ttf"), 0).expect("the font is part of the program"));

/// The number of straight pieces that a curve of an outline is drawn as.
const PIECES: usize = 6;

/// Returns the width of a line of text as a multiple of the font size.
pub(super) fn width(text: &str) -> f64 {
    text.chars().map(|letter| advance(glyph(letter))).sum()
}

/// Returns the closed outlines of the letters of a line of text, for a font size of 1, beginning at the origin, with x
/// right and y up; each as its points in order.
pub(super) fn outlines(text: &str) -> Vec<Vec<[f64; 2]>> {
    let mut all = Vec::new();
    let mut from = 0.0;
    for letter in text.chars() {
        let glyph = glyph(letter);
        let mut outline = Outline { from, ..Outline::default() };
        FACE.outline_glyph(glyph, &mut outline);
        all.append(&mut outline.paths);
        from += advance(glyph);
    }
    all
}

/// Returns the glyph of a letter; glyph 0 is the box of those that the font lacks.
fn glyph(letter: char) -> GlyphId {
    FACE.glyph_index(letter).unwrap_or(GlyphId(0))
}

fn advance(glyph: GlyphId) -> f64 {
    f64::from(FACE.glyph_hor_advance(glyph).unwrap_or(0)) / units_per_em()
}

fn units_per_em() -> f64 {
    f64::from(FACE.units_per_em())
}

/// Collects the outline of a glyph as polygons.
#[derive(Default)]
struct Outline {
    from: f64,
    paths: Vec<Vec<[f64; 2]>>,
}

impl Outline {
    fn at(&self, x: f32, y: f32) -> [f64; 2] {
        [self.from + f64::from(x) / units_per_em(), f64::from(y) / units_per_em()]
    }

    fn last(&self) -> [f64; 2] {
        self.paths.last().and_then(|path| path.last()).copied().unwrap_or([self.from, 0.0])
    }

    fn push(&mut self, point: [f64; 2]) {
        if let Some(path) = self.paths.last_mut() {
            path.push(point);
        }
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        let start = self.at(x, y);
        self.paths.push(vec![start]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let end = self.at(x, y);
        self.push(end);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (a, b, c) = (self.last(), self.at(x1, y1), self.at(x, y));
        for i in 1..=PIECES {
            let u = i as f64 / PIECES as f64;
            let v = 1.0 - u;
            self.push([0, 1].map(|k| v * v * a[k] + 2.0 * u * v * b[k] + u * u * c[k]));
        }
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (a, b, c, d) = (self.last(), self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        for i in 1..=PIECES {
            let u = i as f64 / PIECES as f64;
            let v = 1.0 - u;
            let w = [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u];
            self.push([0, 1].map(|k| w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k]));
        }
    }

    fn close(&mut self) {}
}
