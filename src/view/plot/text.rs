//! A plot as text, small, for a terminal: eight dots to a character (Unicode's braille patterns).

use super::bins::Bins;
use super::layout::scales;
use super::{Plot, PlotKind};

/// Width and height of the area between the axes, characters.
const SIZE: [usize; 2] = [64, 14];

/// The dots of a braille pattern: column, then row from the top.
const DOTS: [[u8; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Returns a plot as text for a terminal: a headline, an area of fixed size with dots of braille patterns and axes
/// with ticks, and the names of several series; lines are separated by line breaks, without one at the end.
pub fn text(plot: &Plot) -> String {
    let bins = (plot.kind == PlotKind::Histogram).then(|| Bins::of(plot));
    let (x, y) = scales(plot, bins.as_ref());
    let mut dots = Dots { cells: vec![[0; SIZE[0]]; SIZE[1]] };
    match &bins {
        Some(bins) => {
            for (number, counts) in bins.counts.iter().enumerate() {
                for (bin, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                    let (from, to) = (x.position(bins.edges[bin]), x.position(bins.edges[bin + 1]));
                    let wide = (to - from) / bins.counts.len() as f64;
                    let left = from + wide * number as f64;
                    dots.bar((left, left + wide), y.position(*count as f64));
                }
            }
        }
        None => {
            for series in &plot.series {
                let mut before = None;
                for point in &series.points {
                    let at = point.map(|[px, py]| [x.position(px), y.position(py)]);
                    match (before, at) {
                        (Some(a), Some(b)) if plot.kind == PlotKind::Curve => dots.line(a, b),
                        (_, Some(b)) => dots.line(b, b),
                        (_, None) => {}
                    }
                    before = at;
                }
            }
        }
    }
    let mut lines = vec![headline(plot, &x.label, &y.label)];
    let row_of = |at: f64| SIZE[1] - 1 - ((at * SIZE[1] as f64) as usize).min(SIZE[1] - 1);
    let wide = y.ticks.iter().map(|(_, text)| text.chars().count()).max().unwrap_or(0);
    for (row, cells) in dots.cells.iter().enumerate() {
        let tick = y.ticks.iter().find(|(at, _)| row_of(*at) == row).map_or("", |(_, text)| text);
        let drawn: String = cells.iter().map(|dots| braille(*dots)).collect();
        let axis = if tick.is_empty() { '│' } else { '┤' };
        lines.push(format!("{tick:>wide$} {axis}{}", drawn.trim_end_matches('\u{2800}')));
    }
    lines.push(format!("{} └{}", " ".repeat(wide), "─".repeat(SIZE[0])));
    lines.push(format!("{}  {}", " ".repeat(wide), tick_line(&x.ticks)));
    let names: Vec<&str> = plot.series.iter().map(|series| series.name.as_str()).collect();
    if plot.series.len() > 1 && names.iter().any(|name| !name.is_empty()) {
        lines.push(format!("{}  {}", " ".repeat(wide), names_line(&names)));
    }
    lines.join("\n")
}

/// Returns the line above a plot: its title or its content, with units.
fn headline(plot: &Plot, x: &str, y: &str) -> String {
    let shown = match plot.kind {
        PlotKind::Histogram => format!("number of values over {x}"),
        PlotKind::Curve | PlotKind::Scatter | PlotKind::Front => format!("{y} over {x}"),
    };
    if plot.title.is_empty() { shown } else { format!("{}: {shown}", plot.title) }
}

/// Returns the texts of ticks below their places, those that find room.
fn tick_line(ticks: &[(f64, String)]) -> String {
    let mut line = String::new();
    let mut end = 0;
    for (at, text) in ticks {
        let length = text.chars().count();
        let place = (at * SIZE[0] as f64) as usize;
        let from = place.saturating_sub(length / 2);
        if (from > end || end == 0) && from + length <= SIZE[0] + 4 {
            line.push_str(&" ".repeat(from - end));
            line.push_str(text);
            end = from + length;
        }
    }
    line
}

/// Returns names of series, no more of them than fit a line.
fn names_line(names: &[&str]) -> String {
    const SHOWN: usize = 4;
    let shown = names.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

fn braille(dots: u8) -> char {
    char::from_u32(0x2800 + u32::from(dots)).expect("all 256 patterns are characters")
}

/// Dots in cells of two columns by four rows.
struct Dots {
    cells: Vec<[u8; SIZE[0]]>,
}

impl Dots {
    /// Sets the dot at a place in 0..1 from the lower left corner.
    fn set(&mut self, x: usize, y: usize) {
        let (x, y) = (x.min(2 * SIZE[0] - 1), y.min(4 * SIZE[1] - 1));
        let row = 4 * SIZE[1] - 1 - y;
        self.cells[row / 4][x / 2] |= DOTS[x % 2][row % 4];
    }

    fn line(&mut self, a: [f64; 2], b: [f64; 2]) {
        let place = |at: [f64; 2]| [at[0] * 2.0 * SIZE[0] as f64, at[1] * 4.0 * SIZE[1] as f64];
        let (a, b) = (place(a), place(b));
        let steps = libm::ceil((b[0] - a[0]).abs().max((b[1] - a[1]).abs())).max(1.0) as usize;
        for i in 0..=steps {
            let u = i as f64 / steps as f64;
            let [x, y] = [0, 1].map(|k| (a[k] + (b[k] - a[k]) * u).max(0.0) as usize);
            self.set(x, y);
        }
    }

    fn bar(&mut self, (from, to): (f64, f64), top: f64) {
        let columns = (2 * SIZE[0]) as f64;
        let (first, last) = ((from * columns) as usize, (to * columns) as usize);
        for x in first..last.max(first + 1) {
            for y in 0..((top * (4 * SIZE[1]) as f64) as usize).max(1) {
                self.set(x, y);
            }
        }
    }
}
