//! The straight lines of which the outline of an element consists.

use super::numbers::{self, Numbers, shown};
use super::{LINES_MAX, Point, Unread};
use roxmltree::Node;

/// The remedy of a curve.
const CURVE: &str =
    "creases are straight: make lines of curves; paths of `M`, `L`, `H`, `V` and `Z` are read";

/// The lines of an outline that is drawn from point to point.
struct Pen {
    segments: Vec<[Point; 2]>,
    start: Point,
    at: Point,
    segments_max: usize,
}

impl Pen {
    /// Begins a part of the outline at a point.
    fn move_to(&mut self, point: Point) {
        (self.start, self.at) = (point, point);
    }

    /// Draws a line to a point. A line to where the pen is draws nothing.
    ///
    /// # Errors
    /// The reason that there are too many lines.
    fn line_to(&mut self, point: Point) -> Result<(), Unread> {
        if point != self.at {
            if self.segments.len() == self.segments_max {
                let found =
                    format!("the drawing has more than {LINES_MAX} lines, which is as many as are read");
                return Err(Unread::new(
                    found,
                    "sheets of up to 300 creases can be planned: leave out the others",
                ));
            }
            self.segments.push([self.at, point]);
        }
        self.at = point;
        Ok(())
    }
}

/// Returns the lines that an element draws, in its own coordinates, `segments_max` at most; none where it draws none.
///
/// # Errors
/// The reason why they can't be read: it draws curves, lacks a number, or has too many.
pub(super) fn segments(node: Node, segments_max: usize) -> Result<Vec<[Point; 2]>, Unread> {
    let length = |name: &str| node.attribute(name).map_or(Ok(0.0), |text| numbers::length(name, text));
    let mut pen = Pen { segments: Vec::new(), start: [0.0; 2], at: [0.0; 2], segments_max };
    match node.tag_name().name() {
        "line" => {
            pen.move_to([length("x1")?, length("y1")?]);
            pen.line_to([length("x2")?, length("y2")?])?;
        }
        "rect" => {
            if length("rx")? != 0.0 || length("ry")? != 0.0 {
                return Err(Unread::new("the corners of a `rect` are round", CURVE));
            }
            let (x, y, width, height) = (length("x")?, length("y")?, length("width")?, length("height")?);
            // A rectangle without an area is not drawn.
            if width > 0.0 && height > 0.0 {
                pen.move_to([x, y]);
                for corner in [[x + width, y], [x + width, y + height], [x, y + height], [x, y]] {
                    pen.line_to(corner)?;
                }
            }
        }
        name @ ("polyline" | "polygon") => {
            let mut numbers = Numbers::of(node.attribute("points").unwrap_or(""));
            let mut first = true;
            while !numbers.ended() {
                let point = point(&mut numbers, [0.0; 2])?;
                if std::mem::take(&mut first) { pen.move_to(point) } else { pen.line_to(point)? }
            }
            if name == "polygon" {
                pen.line_to(pen.start)?;
            }
        }
        "path" => path(node.attribute("d").unwrap_or(""), &mut pen)?,
        name @ ("circle" | "ellipse") => {
            return Err(Unread::new(format!("the `{name}` has a stroke"), CURVE));
        }
        _ => {}
    }
    Ok(pen.segments)
}

/// Draws the data of a path.
///
/// # Errors
/// The reason why it can't be drawn.
fn path(data: &str, pen: &mut Pen) -> Result<(), Unread> {
    let mut numbers = Numbers::of(data);
    let mut moved = false;
    while !numbers.ended() {
        let rest = numbers.rest();
        let Some(command) = numbers.letter() else {
            let found = format!("`{}` stands in a path where a command is wanted", shown(rest));
            return Err(Unread::new(found, CURVE));
        };
        if !moved && !['M', 'm'].contains(&command) {
            return Err(Unread::new(
                format!("a path begins with `{command}`"),
                "the first command of a path is `M`",
            ));
        }
        moved = true;
        // Numbers that follow each other repeat the command; behind a move they are lines.
        let mut first = true;
        loop {
            let from = if command.is_ascii_lowercase() { pen.at } else { [0.0; 2] };
            match command.to_ascii_uppercase() {
                'M' if first => pen.move_to(point(&mut numbers, from)?),
                'M' | 'L' => pen.line_to(point(&mut numbers, from)?)?,
                'H' => pen.line_to([from[0] + numbers.number()?, pen.at[1]])?,
                'V' => pen.line_to([pen.at[0], from[1] + numbers.number()?])?,
                'Z' => pen.line_to(pen.start)?,
                'C' | 'S' | 'Q' | 'T' | 'A' => {
                    return Err(Unread::new(
                        format!("the command `{command}` of a path draws a curve"),
                        CURVE,
                    ));
                }
                _ => return Err(Unread::new(format!("`{command}` is no command of a path"), CURVE)),
            }
            first = false;
            if !numbers.at_number() || command.eq_ignore_ascii_case(&'Z') {
                break;
            }
        }
    }
    Ok(())
}

/// Reads a point, whose coordinates count from another.
///
/// # Errors
/// The reason why there is none.
fn point(numbers: &mut Numbers, from: Point) -> Result<Point, Unread> {
    Ok([from[0] + numbers.number()?, from[1] + numbers.number()?])
}
