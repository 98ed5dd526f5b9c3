//! Parallel coordinates: a line for each row across one vertical axis for each column (Inselberg 1985).

use super::layout::{INK, LETTER, SIZE, SPACE, TITLE, line, text};
use super::marks::{Anchor, Colour, Mark, Sheet};
use super::scale::Scale;
use super::{PlotAxis, svg};

/// The colours of the least and of the greatest value on the last axis.
const ENDS: [Colour; 2] = [[0x56, 0xb4, 0xe9], [0xd5, 0x5e, 0x00]];
/// The colour of rows without a value on the last axis.
const NONE: Colour = [0xa0, 0xa5, 0xaa];
/// The most lines that are drawn; of more, every second, third and so on.
const LINES_MAX: usize = 2_000;

/// A table whose rows are drawn as lines.
#[derive(Clone, Debug, PartialEq)]
pub struct ParallelPlot {
    /// The title above the plot; may be empty.
    pub title: String,
    /// The axes from left to right, at least two. The last one gives the lines their colours.
    pub axes: Vec<PlotAxis>,
    /// The rows, each with a value in SI units for every axis; `None` for a missing or infinite one, at which the line is
    /// broken.
    pub rows: Vec<Vec<Option<f64>>>,
}

/// Returns a plot of parallel coordinates as the text of an SVG file, with lengths in pixels. Of more than 2000 rows as many
/// are drawn, evenly chosen.
pub fn parallel_svg(plot: &ParallelPlot) -> String {
    let title = if plot.title.is_empty() { "parallel coordinates" } else { &plot.title };
    svg::written(&lay_out(plot), title)
}

fn lay_out(plot: &ParallelPlot) -> Sheet {
    let values = |axis: usize| plot.rows.iter().filter_map(move |row| row.get(axis).copied().flatten());
    let scale = |(axis, of): (usize, &PlotAxis)| values(axis).next().map(|_| Scale::new(of, values(axis), 6));
    let scales: Vec<Option<Scale>> = plot.axes.iter().enumerate().map(scale).collect();
    let (left, right) = (SPACE * 7.0, SIZE[0] - SPACE * 7.0);
    let (top, bottom) = (SPACE + TITLE + 2.5 * SPACE + LETTER, SIZE[1] - 2.0 * SPACE);
    let gaps = plot.axes.len().saturating_sub(1).max(1) as f64;
    let x = |axis: usize| left + (right - left) * axis as f64 / gaps;
    let mut marks = Vec::new();
    let every = plot.rows.len().div_ceil(LINES_MAX).max(1);
    let drawn: Vec<&Vec<Option<f64>>> = plot.rows.iter().step_by(every).collect();
    let width = if drawn.len() > 200 { 0.6 } else { 1.2 };
    for row in drawn {
        let place = |axis: usize| {
            let at = scales.get(axis)?.as_ref()?.position(row.get(axis).copied().flatten()?);
            Some([x(axis), bottom - (bottom - top) * at])
        };
        let last = plot.axes.len().saturating_sub(1);
        let part = scales.get(last).and_then(Option::as_ref).zip(row.get(last).copied().flatten());
        let colour = part.map_or(NONE, |(scale, value)| between(scale.position(value)));
        let places: Vec<Option<[f64; 2]>> = (0..plot.axes.len()).map(place).collect();
        for piece in places.split(Option::is_none) {
            let points: Vec<[f64; 2]> = piece.iter().flatten().copied().collect();
            match points.as_slice() {
                [] => {}
                [one] => marks.push(Mark::Dot { at: *one, radius: 1.5, colour }),
                _ => marks.push(line(points, width, colour)),
            }
        }
    }
    for (axis, scale) in scales.iter().enumerate() {
        marks.push(line(vec![[x(axis), top], [x(axis), bottom]], 1.25, INK));
        let label = scale.as_ref().map_or(plot.axes[axis].label.as_str(), |scale| scale.label.as_str());
        marks.push(text([x(axis), top - SPACE], Anchor::Middle, label));
        for (at, words) in scale.iter().flat_map(|scale| &scale.ticks) {
            let y = bottom - (bottom - top) * at;
            marks.push(line(vec![[x(axis) - 4.0, y], [x(axis), y]], 1.0, INK));
            marks.push(text([x(axis) - 7.0, y + LETTER * 0.35], Anchor::End, words));
        }
    }
    if !plot.title.is_empty() {
        marks.push(text([SIZE[0] / 2.0, SPACE + TITLE], Anchor::Middle, &plot.title));
    }
    Sheet { size: SIZE, marks }
}

/// Returns the colour at a part of the way between the two ends.
fn between(part: f64) -> Colour {
    let part = part.clamp(0.0, 1.0);
    std::array::from_fn(|i| {
        let (from, to) = (f64::from(ENDS[0][i]), f64::from(ENDS[1][i]));
        (from + (to - from) * part) as u8
    })
}
