//! Crease patterns drawn in SVG: grids of creases in the colours that have a meaning, drawn in every way that lines are drawn,
//! and damaged.

use super::damage::{damaged, damaged_bytes};
use super::dice::Dice;
use std::fmt::Write;

/// Mountains, valleys and creases that stay flat.
const COLOURS: &[&str] = &["#f00", "red", "#0000ff", "rgb(0, 0, 255)", "yellow", "#ff0"];

/// Returns a drawing of a grid as the number of its cells, a line break and the file; the number is left out where the
/// file was damaged.
pub fn file(dice: &mut Dice) -> Vec<u8> {
    let (columns, rows) = (1 + dice.below(5), 1 + dice.below(5));
    let drawing = grid(dice, columns, rows);
    let bytes = match dice.below(4) {
        0 | 1 => return format!("{}\n{drawing}", columns * rows).into_bytes(),
        2 => damaged(dice, &drawing).into_bytes(),
        _ => damaged_bytes(dice, drawing.as_bytes()),
    };
    [b"\n", &bytes[..]].concat()
}

/// Returns a grid of so many cells, each ten units wide and high.
fn grid(dice: &mut Dice, columns: usize, rows: usize) -> String {
    let (wide, high) = (10 * columns, 10 * rows);
    let mut text = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\">\n");
    let style = dice.below(2) == 1;
    if style {
        text.push_str("<style>.edge { stroke: black; fill: none } /* the border */</style>\n");
    }
    let _ = writeln!(text, "<g transform=\"{}\">", transform(dice));
    let border = if style { "class=\"edge\"" } else { "stroke=\"#000\" fill=\"none\"" };
    let _ = match dice.below(4) {
        0 => writeln!(text, "<rect width=\"{wide}\" height=\"{high}\" {border}/>"),
        1 => writeln!(text, "<polygon points=\"0,0 {wide},0 {wide},{high} 0,{high}\" {border}/>"),
        2 => writeln!(text, "<path d=\"M0 0h{wide}v{high}H0z\" {border}/>"),
        _ => writeln!(text, "<path d=\"m 0,0 {wide},0 0,{high} -{wide},0 Z\" style=\"stroke:#000\"/>"),
    };
    for column in 1..columns {
        text.push_str(&line(dice, [10 * column, 0], [10 * column, high]));
    }
    for row in 1..rows {
        text.push_str(&line(dice, [0, 10 * row], [wide, 10 * row]));
    }
    text + "</g>\n</svg>\n"
}

/// Returns a crease from one point to another.
fn line(dice: &mut Dice, [x1, y1]: [usize; 2], [x2, y2]: [usize; 2]) -> String {
    let colour = dice.of(COLOURS);
    match dice.below(4) {
        0 => format!("<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{colour}\"/>\n"),
        1 => format!("<polyline points=\"{x1} {y1} {x2} {y2}\" fill=\"none\" style=\"stroke: {colour}\"/>\n"),
        2 => format!("<path d=\"M{x2} {y2}L{x1} {y1}\" stroke=\"{colour}\" stroke-opacity=\"0.5\"/>\n"),
        _ => format!(
            "<g stroke=\"{colour}\"><line transform=\"translate({x1} {y1})\" x2=\"{}\" y2=\"{}\"/></g>\n",
            x2 - x1,
            y2 - y1
        ),
    }
}

/// Returns a transform that can be undone.
fn transform(dice: &mut Dice) -> String {
    let number = |dice: &mut Dice| dice.below(200) as f64 / 10.0 - 10.0;
    let (a, b) = (number(dice), number(dice));
    match dice.below(5) {
        0 => format!("translate({a}, {b})"),
        1 => format!("rotate({a} {b} 3)"),
        2 => format!("scale({})", 0.5 + a.abs()),
        3 => format!("translate({a}) skewX({b}) scale(1 -1)"),
        _ => format!("matrix(1 {} 0 1 {a} {b})", b / 20.0),
    }
}
