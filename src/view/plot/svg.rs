//! A plot as SVG.

use super::Plot;
use super::layout::lay_out;
use super::marks::{Anchor, Colour, Mark, Sheet};
use crate::view::drawing::short;
use crate::view::markup::escaped;
use std::fmt::Write as _;

/// The fonts of text: the one that the layout was made with, or similar ones.
const FONTS: &str = "Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// Returns a plot as the text of an SVG file, with lengths in pixels; missing values leave gaps.
pub fn svg(plot: &Plot) -> String {
    let title = if plot.title.is_empty() { plot.describe() } else { plot.title.clone() };
    written(&lay_out(plot), &title)
}

/// Returns a drawing as the text of an SVG file with a title.
pub(super) fn written(sheet: &Sheet, title: &str) -> String {
    let [w, h] = sheet.size.map(short);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"{FONTS}\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>{}</title>\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n",
        escaped(title)
    );
    for mark in &sheet.marks {
        write_mark(&mut out, mark);
    }
    out.push_str("</svg>\n");
    out
}

fn write_mark(out: &mut String, mark: &Mark) {
    let points = |points: &[[f64; 2]]| {
        let points: Vec<String> =
            points.iter().map(|at| format!("{},{}", pixel(at[0]), pixel(at[1]))).collect();
        points.join(" ")
    };
    match mark {
        Mark::Line { points: through, width, colour, dash } => {
            let dash = dash.map_or(String::new(), |[on, off]| format!(" stroke-dasharray=\"{on} {off}\""));
            let (points, colour) = (points(through), code(*colour));
            writeln!(
                out,
                r#"<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"{dash}/>"#
            )
        }
        Mark::Area { corners, colour } => {
            writeln!(out, r#"<polygon points="{}" fill="{}"/>"#, points(corners), code(*colour))
        }
        Mark::Dot { at, radius, colour } => {
            let [x, y] = at.map(pixel);
            writeln!(out, r#"<circle cx="{x}" cy="{y}" r="{radius}" fill="{}"/>"#, code(*colour))
        }
        Mark::Text { at, size, colour, anchor, upwards, text } => {
            let [x, y] = at.map(pixel);
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn = if *upwards { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
            let (colour, words) = (code(*colour), escaped(text));
            writeln!(
                out,
                r#"<text x="{x}" y="{y}" font-size="{size}" fill="{colour}" text-anchor="{anchor}"{turn}>{words}</text>"#
            )
        }
    }
    .expect("text grows");
}

/// Rounds to a hundredth of a pixel.
fn pixel(x: f64) -> f64 {
    short(libm::round(x * 100.0) / 100.0)
}

fn code([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
