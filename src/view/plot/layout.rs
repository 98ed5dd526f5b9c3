//! The layout of a plot: axes, grid, series and legend as marks.

use super::bins::Bins;
use super::font;
use super::marks::{Anchor, Colour, Mark, Sheet};
use super::scale::Scale;
use super::{Plot, PlotKind, PlotSeries};

/// Width and height of a plot, pixels.
pub(super) const SIZE: [f64; 2] = [960.0, 600.0];
/// The size of labels, pixels.
pub(super) const LETTER: f64 = 15.0;
/// The size of the title, pixels.
pub(super) const TITLE: f64 = 18.0;
/// The space between things, pixels.
pub(super) const SPACE: f64 = 12.0;

/// The colour of axes and text.
pub(super) const INK: Colour = [0x1d, 0x25, 0x30];
/// The colour of minor text.
const SOFT: Colour = [0x5c, 0x65, 0x70];
/// The colour of grid lines.
const GRID: Colour = [0xe3, 0xe5, 0xe8];

/// The colours of series, which people with colour blindness can tell apart (Okabe and Ito 2008, without yellow).
const COLOURS: [Colour; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x22, 0x22, 0x22],
];

/// The dashes of lines once all colours are used, and of the lines after those.
const DASHES: [Option<[f64; 2]>; 4] = [None, Some([9.0, 5.0]), Some([2.5, 4.0]), Some([14.0, 4.0])];

/// The most names in a legend; the rest is counted.
const NAMES_MAX: usize = 16;
/// The widest legend, in parts of the plot; longer names are cut.
const LEGEND_MAX: f64 = 0.34;
/// The most points of all curves together; of more only what shows is drawn, pixel by pixel.
const POINTS_MAX: usize = 200_000;

/// The rectangle that the axes span.
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Frame {
    fn at(&self, x: f64, y: f64) -> [f64; 2] {
        [self.left + (self.right - self.left) * x, self.bottom - (self.bottom - self.top) * y]
    }
}

/// Lays a plot out: returns its marks (lines, texts, areas) in pixels, with the size of the whole.
pub(super) fn lay_out(plot: &Plot) -> Sheet {
    let bins = (plot.kind == PlotKind::Histogram).then(|| Bins::of(plot));
    let (x, y) = scales(plot, bins.as_ref());
    let legend = legend_names(plot);
    let widest = |texts: &mut dyn Iterator<Item = &str>| texts.map(font::width).fold(0.0, f64::max) * LETTER;
    let legend_width = widest(&mut legend.iter().map(String::as_str));
    let tick_width = widest(&mut y.ticks.iter().map(|(_, text)| text.as_str()));
    let frame = Frame {
        left: SPACE + LETTER + SPACE + tick_width + SPACE / 2.0,
        right: SIZE[0] - 2.0 * SPACE - if legend.is_empty() { 0.0 } else { legend_width + 4.0 * SPACE },
        top: SPACE + if plot.title.is_empty() { LETTER / 2.0 } else { TITLE + 1.5 * SPACE },
        bottom: SIZE[1] - (2.5 * LETTER + 2.0 * SPACE),
    };
    let mut sheet = Sheet { size: SIZE, marks: vec![] };
    axes(&mut sheet, plot, &frame, (&x, &y));
    match &bins {
        Some(bins) => bars(&mut sheet, &frame, (&x, &y), bins),
        None => {
            for (number, series) in plot.series.iter().enumerate() {
                draw_series(&mut sheet, plot, &frame, (&x, &y), (number, series));
            }
        }
    }
    draw_legend(&mut sheet, plot, &frame, &legend);
    notes(&mut sheet, plot, &frame);
    sheet
}

/// Returns the scales of the axes as (horizontal, vertical); `bins` are those of a histogram, `None` for other plots.
pub(super) fn scales(plot: &Plot, bins: Option<&Bins>) -> (Scale, Scale) {
    match bins {
        Some(bins) => {
            (Scale::new(&plot.x, bins.edges.iter().copied(), 9), Scale::of_counts(&plot.y, bins.most(), 7))
        }
        None => (
            Scale::new(&plot.x, plot.points().map(|point| point[0]), 9),
            Scale::new(&plot.y, plot.points().map(|point| point[1]), 7),
        ),
    }
}

fn colour(number: usize) -> Colour {
    COLOURS[number % COLOURS.len()]
}

fn dash(number: usize) -> Option<[f64; 2]> {
    DASHES[number / COLOURS.len() % DASHES.len()]
}

pub(super) fn text(at: [f64; 2], anchor: Anchor, words: &str) -> Mark {
    Mark::Text { at, size: LETTER, colour: INK, anchor, upwards: false, text: words.to_string() }
}

pub(super) fn line(points: Vec<[f64; 2]>, width: f64, colour: Colour) -> Mark {
    Mark::Line { points, width, colour, dash: None }
}

/// Draws grid, ticks, labels and title.
fn axes(sheet: &mut Sheet, plot: &Plot, frame: &Frame, (x, y): (&Scale, &Scale)) {
    let marks = &mut sheet.marks;
    for (at, words) in &x.ticks {
        let [px, _] = frame.at(*at, 0.0);
        marks.push(line(vec![[px, frame.bottom], [px, frame.top]], 1.0, GRID));
        marks.push(text([px, frame.bottom + LETTER + SPACE / 2.0], Anchor::Middle, words));
    }
    for (at, words) in &y.ticks {
        let [_, py] = frame.at(0.0, *at);
        marks.push(line(vec![[frame.left, py], [frame.right, py]], 1.0, GRID));
        marks.push(text([frame.left - SPACE / 2.0, py + LETTER * 0.35], Anchor::End, words));
    }
    let corner = [frame.left, frame.bottom];
    marks.push(line(vec![[frame.left, frame.top], corner, [frame.right, frame.bottom]], 1.25, INK));
    let (middle, centre) = ((frame.left + frame.right) / 2.0, (frame.top + frame.bottom) / 2.0);
    marks.push(text([middle, SIZE[1] - SPACE], Anchor::Middle, &x.label));
    let (at, words) = ([SPACE + LETTER, centre], y.label.clone());
    marks.push(Mark::Text {
        at,
        size: LETTER,
        colour: INK,
        anchor: Anchor::Middle,
        upwards: true,
        text: words,
    });
    if !plot.title.is_empty() {
        let at = [SIZE[0] / 2.0, SPACE + TITLE];
        let words = cut(&plot.title, (SIZE[0] - 2.0 * SPACE) / TITLE);
        marks.push(Mark::Text {
            at,
            size: TITLE,
            colour: INK,
            anchor: Anchor::Middle,
            upwards: false,
            text: words,
        });
    }
}

fn draw_series(
    sheet: &mut Sheet,
    plot: &Plot,
    frame: &Frame,
    (x, y): (&Scale, &Scale),
    (number, series): (usize, &PlotSeries),
) {
    let place = |[px, py]: [f64; 2]| frame.at(x.position(px), y.position(py));
    let radius = if series.points.len() > 500 { 1.8 } else { 3.6 };
    if plot.kind == PlotKind::Scatter || plot.kind == PlotKind::Front && number == 0 {
        let mut places: Vec<[f64; 2]> = series.points.iter().flatten().map(|point| place(*point)).collect();
        let total: usize = plot.series.iter().map(|series| series.points.len()).sum();
        if total > POINTS_MAX {
            // Those that fall on one pixel show as one.
            places = places.into_iter().map(|at| at.map(libm::round)).collect();
            places.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
            places.dedup();
        }
        sheet.marks.extend(places.into_iter().map(|at| point(at, radius, number)));
        return;
    }
    if plot.kind == PlotKind::Front {
        let places = series.points.iter().flatten().map(|at| place(*at));
        sheet.marks.extend(places.map(|at| point(at, 3.6, number)));
    }
    let budget = POINTS_MAX / plot.series.len().max(1);
    for piece in series.points.split(|point| point.is_none()) {
        let places: Vec<[f64; 2]> = piece.iter().flatten().map(|point| place(*point)).collect();
        match places.as_slice() {
            [] => {}
            [one] => sheet.marks.push(Mark::Dot { at: *one, radius: 2.0, colour: colour(number) }),
            _ => {
                let points = if places.len() > budget { thinned(&places, frame, budget) } else { places };
                let (colour, dash) = (colour(number), dash(number));
                sheet.marks.push(Mark::Line { points, width: 2.0, colour, dash });
            }
        }
    }
}

/// Returns the mark of a point of a scatter plot: series differ by shape as well.
fn point(at: [f64; 2], radius: f64, number: usize) -> Mark {
    let [x, y] = at;
    let (r, colour) = (radius, colour(number));
    let corners = match number % 4 {
        0 => return Mark::Dot { at, radius, colour },
        1 => vec![[x - r, y - r], [x + r, y - r], [x + r, y + r], [x - r, y + r]],
        2 => vec![[x, y - 1.3 * r], [x + 1.2 * r, y + r], [x - 1.2 * r, y + r]],
        _ => vec![[x, y - 1.4 * r], [x + 1.4 * r, y], [x, y + 1.4 * r], [x - 1.4 * r, y]],
    };
    Mark::Area { corners, colour }
}

/// Thins a line to what shows: of consecutive points in one column of pixels the first, lowest, highest and last.
fn thinned(places: &[[f64; 2]], frame: &Frame, budget: usize) -> Vec<[f64; 2]> {
    let columns = (budget / 4).max(16) as f64;
    let column = |at: &[f64; 2]| libm::floor((at[0] - frame.left) / (frame.right - frame.left) * columns);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for run in places.chunk_by(|a, b| column(a) == column(b)) {
        let lowest = (0..run.len()).min_by(|i, j| run[*i][1].total_cmp(&run[*j][1])).unwrap_or(0);
        let highest = (0..run.len()).max_by(|i, j| run[*i][1].total_cmp(&run[*j][1])).unwrap_or(0);
        let mut kept = [0, lowest, highest, run.len() - 1];
        kept.sort_unstable();
        for (i, index) in kept.into_iter().enumerate() {
            if i == 0 || kept[i - 1] != index {
                points.push(run[index]);
            }
        }
    }
    points
}

/// Draws the bars of a histogram, those of several series side by side.
fn bars(sheet: &mut Sheet, frame: &Frame, (x, y): (&Scale, &Scale), bins: &Bins) {
    let series = bins.counts.len();
    for (number, counts) in bins.counts.iter().enumerate() {
        for (bin, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let (from, to) = (x.position(bins.edges[bin]), x.position(bins.edges[bin + 1]));
            let wide = (to - from) / series as f64;
            let [left, top] = frame.at(from + wide * number as f64, y.position(*count as f64));
            let [right, _] = frame.at(from + wide * (number + 1) as f64, 0.0);
            // A white line between bars, as far as there is room for one.
            let gap = f64::min(0.75, (right - left) / 8.0);
            let (l, r, b) = (left + gap, right - gap, frame.bottom);
            sheet.marks.push(Mark::Area {
                corners: vec![[l, b], [l, top], [r, top], [r, b]],
                colour: colour(number),
            });
        }
    }
}

/// Returns the lines of the legend: names, cut where they are too long; none where nothing has a name.
fn legend_names(plot: &Plot) -> Vec<String> {
    let named = plot.series.iter().any(|series| !series.name.is_empty());
    let alone = plot.series.len() == 1 && plot.series[0].name == plot.y.label;
    if !named || alone {
        return vec![];
    }
    let shown = plot.series.iter().take(NAMES_MAX);
    let mut names: Vec<String> =
        shown.map(|series| cut(&series.name, SIZE[0] * LEGEND_MAX / LETTER - 4.0)).collect();
    if plot.series.len() > NAMES_MAX {
        names.push(format!("and {} more", plot.series.len() - NAMES_MAX));
    }
    names
}

/// Returns a text cut to a width, in parts of its size.
fn cut(words: &str, width: f64) -> String {
    if font::width(words) <= width {
        return words.to_string();
    }
    let mut kept = String::new();
    for letter in words.chars() {
        kept.push(letter);
        if font::width(&kept) > width - 1.0 {
            break;
        }
    }
    kept.pop();
    kept.push('…');
    kept
}

fn draw_legend(sheet: &mut Sheet, plot: &Plot, frame: &Frame, names: &[String]) {
    let left = frame.right + 1.5 * SPACE;
    for (number, name) in names.iter().enumerate() {
        let y = frame.top + LETTER + number as f64 * LETTER * 1.5;
        sheet.marks.push(text([left + 2.5 * SPACE, y], Anchor::Start, name));
        if number >= NAMES_MAX {
            continue;
        }
        let middle = y - LETTER * 0.35;
        let sample = vec![[left, middle], [left + 2.0 * SPACE, middle]];
        sheet.marks.push(match plot.kind {
            PlotKind::Curve => {
                Mark::Line { points: sample, width: 2.5, colour: colour(number), dash: dash(number) }
            }
            PlotKind::Scatter | PlotKind::Front => point([left + SPACE, middle], 4.5, number),
            PlotKind::Histogram => {
                point([left + SPACE, middle], 5.5, number - number % 4 + 1).coloured(colour(number))
            }
        });
    }
}

impl Mark {
    /// Returns an area in another colour.
    fn coloured(self, colour: Colour) -> Mark {
        match self {
            Mark::Area { corners, .. } => Mark::Area { corners, colour },
            other => other,
        }
    }
}

/// Adds a note of the number of values that are not drawn.
fn notes(sheet: &mut Sheet, plot: &Plot, frame: &Frame) {
    let gaps = plot.gaps();
    if gaps > 0 {
        let words = format!("not drawn: {gaps} missing or infinite");
        let at = [frame.right, frame.top - LETTER * 0.4];
        let (size, anchor) = (LETTER * 0.8, Anchor::End);
        sheet.marks.push(Mark::Text { at, size, colour: SOFT, anchor, upwards: false, text: words });
    }
}
