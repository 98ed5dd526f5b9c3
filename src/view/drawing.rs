//! SVG drawings: lines, polygons, labels and layers.

use super::markup::escaped;
use std::fmt::Write as _;

/// The font family of all labels.
const FONT: &str = "ui-monospace, Menlo, Consolas, 'DejaVu Sans Mono', monospace";
/// The colour of lines and labels, as SVG writes it.
pub(super) const INK: &str = "#1d2530";
/// The colour of minor, paler lines and labels, as SVG writes it.
pub(super) const SOFT: &str = "#7a828c";
/// The colour of the background, as SVG writes it.
pub(super) const PAPER: &str = "#fffefb";

/// Attributes of a halo by which labels stay legible in front of lines.
const HALO: &str = "paint-order=\"stroke\" stroke=\"#fffefb\" stroke-opacity=\"0.8\" stroke-width=\"0.22em\"";

/// Attributes that make a group a layer in Inkscape.
const LAYER: &str =
    "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" inkscape:groupmode=\"layer\"";

/// The width of a letter of the font as a fraction of the font size, without unit.
pub(super) const LETTER: f64 = 0.602;

/// An SVG drawing under construction. Points are (x right, y down), all lengths in the unit that [`Drawing::finish`]
/// gets.
#[derive(Default)]
pub(super) struct Drawing {
    text: String,
}

/// The attributes of lines and surfaces as text in the syntax of SVG, such as `stroke="..."`.
pub(super) type SvgAttributes<'a> = &'a str;

impl Drawing {
    /// Adds a line from `a` to `b` (x right, y down); `look`: its attributes.
    pub(super) fn line(&mut self, a: [f64; 2], b: [f64; 2], look: SvgAttributes) {
        let [x1, y1, x2, y2] = [a[0], a[1], b[0], b[1]].map(short);
        writeln!(self.text, r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {look}/>"#).expect("text grows");
    }

    /// Adds a rectangle of this size (width, height) with its upper left corner at `at`; `round` is the radius of its
    /// corners, `look` its attributes.
    pub(super) fn rect(&mut self, at: [f64; 2], size: [f64; 2], round: f64, look: SvgAttributes) {
        let [x, y, w, h, r] = [at[0], at[1], size[0], size[1], round].map(short);
        writeln!(self.text, r#"<rect x="{x}" y="{y}" width="{w}" height="{h}" rx="{r}" {look}/>"#)
            .expect("text grows");
    }

    /// Adds a circle around the point `at` (x right, y down); `look`: its attributes.
    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, look: SvgAttributes) {
        let [x, y, r] = [at[0], at[1], radius].map(short);
        writeln!(self.text, r#"<circle cx="{x}" cy="{y}" r="{r}" {look}/>"#).expect("text grows");
    }

    /// Adds a closed polygon through points (x right, y down), the last joined with the first; `look`: its attributes.
    pub(super) fn polygon(&mut self, points: &[[f64; 2]], look: SvgAttributes) {
        let points: Vec<String> =
            points.iter().map(|[x, y]| format!("{},{}", short(*x), short(*y))).collect();
        writeln!(self.text, r#"<polygon points="{}" {look}/>"#, points.join(" ")).expect("text grows");
    }

    /// Adds a layer, which drawing programs and cutters can switch on and off by its name; `draw` adds its content. The
    /// name is not escaped.
    pub(super) fn layer(&mut self, name: &str, draw: impl FnOnce(&mut Drawing)) {
        writeln!(self.text, r#"<g id="{name}" {LAYER} inkscape:label="{name}">"#).expect("text grows");
        draw(self);
        self.text.push_str("</g>\n");
    }

    /// Adds a label centred at a point, with letters of height `size`; its text is escaped. `colour` is written as SVG
    /// has it.
    pub(super) fn words(&mut self, at: [f64; 2], size: f64, colour: &str, words: &str) {
        let ([x, y], size) = (at.map(short), short(size));
        let words = escaped(words);
        writeln!(
            self.text,
            r#"<text x="{x}" y="{y}" font-size="{size}" fill="{colour}" text-anchor="middle" dominant-baseline="central" {HALO}>{words}</text>"#
        )
        .expect("text grows");
    }

    /// Returns the whole SVG file. Its visible part has this size (width, height) and its upper left corner at `from`;
    /// `unit` is the unit of a length of 1, `px` or `mm`. `title` is escaped.
    pub(super) fn finish(self, title: &str, from: [f64; 2], size: [f64; 2], unit: &str) -> String {
        let ([x, y], [w, h], title) = (from.map(short), size.map(short), escaped(title));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}{unit}\" height=\"{h}{unit}\" \
             viewBox=\"{x} {y} {w} {h}\" font-family=\"{FONT}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
             <title>{title}</title>\n<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{PAPER}\"/>\n{}</svg>\n",
            self.text
        )
    }
}

/// Rounds a length to a thousandth of its unit; returns 0 for NaN and infinities.
pub(super) fn short(x: f64) -> f64 {
    let x = libm::round(x * 1e3) / 1e3;
    if x.is_finite() { x + 0.0 } else { 0.0 }
}

/// Returns the upper left corner and the size of a bounding box around points (x right, y down), with a margin of
/// `rim` on each side. Without points it is around the origin.
pub(super) fn around(points: impl Iterator<Item = [f64; 2]>, rim: f64) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in points {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    if low[0] > high[0] {
        (low, high) = ([0.0; 2], [0.0; 2]);
    }
    (low.map(|x| x - rim), [0, 1].map(|k| high[k] - low[k] + 2.0 * rim))
}
