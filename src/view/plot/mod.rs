//! Plots: curves, scatter plots and histograms of quantities, as SVG, as PNG and as text.
//!
//! A plot is laid out once (`layout`), as marks in pixels; SVG and PNG write the same marks. Widths of text are those
//! of the font that is shipped (Roboto, a subset; Apache-2.0), which PNG draws with, so that a layout is the same
//! everywhere; SVG names it and leaves the drawing to the viewer.

mod bins;
mod font;
mod layout;
mod marks;
mod parallel;
mod png;
mod scale;
mod svg;
mod text;

use crate::units::Dimension;

pub use parallel::{ParallelPlot, parallel_svg};
pub use png::png;
pub use svg::svg;
pub use text::text;

/// The kind of a plot: the way in which its values are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotKind {
    /// A curve: lines from point to point.
    Curve,
    /// A scatter plot: a mark at each point.
    Scatter,
    /// A histogram: bars with the number of values in each bin.
    Histogram,
    /// A scatter plot of the first series, through which the others are drawn as lines with marks: the best of its points.
    Front,
}

/// An axis of a plot: its label and the dimension of its values.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotAxis {
    /// The label without unit; may be empty.
    pub label: String,
    /// The dimension of the values along the axis.
    pub dimension: Dimension,
}

/// A series of a plot: points (x, y) with a name, drawn as one curve, point cloud or histogram.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotSeries {
    /// The name of the series in the legend; may be empty.
    pub name: String,
    /// The points (x, y) in SI units, in the order in which a curve joins them; `None` for a missing or infinite value,
    /// which leaves a gap. A histogram reads the second value of each.
    pub points: Vec<Option<[f64; 2]>>,
}

/// A plot of one or more series over common axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The kind of plot, the same for all series.
    pub kind: PlotKind,
    /// The title above the plot; may be empty.
    pub title: String,
    /// The horizontal axis; of a histogram that of the values.
    pub x: PlotAxis,
    /// The vertical axis; of a histogram a number of values.
    pub y: PlotAxis,
    /// The series, at least one, with at least one point that is drawn.
    pub series: Vec<PlotSeries>,
    /// The number of bins of a histogram, at least 1; `None`: as many as the rule of Rice gives, at round edges. Other
    /// plots do not read it.
    pub bins: Option<usize>,
}

impl Plot {
    /// Returns all points that are drawn.
    fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.series.iter().flat_map(|series| series.points.iter().flatten().copied())
    }

    /// Returns the number of missing or infinite values in all series together.
    pub fn gaps(&self) -> usize {
        self.series.iter().flat_map(|series| &series.points).filter(|point| point.is_none()).count()
    }

    /// Returns the content of the plot in words, by the labels of its axes, such as `a curve of height over time`.
    pub fn describe(&self) -> String {
        let named = |axis: &PlotAxis, other: &str| {
            if axis.label.is_empty() { other.to_string() } else { axis.label.clone() }
        };
        let (x, y) = (named(&self.x, "x"), named(&self.y, "y"));
        let count = self.series.len();
        match self.kind {
            PlotKind::Histogram => format!("a histogram of {x}"),
            PlotKind::Curve if count == 1 => format!("a curve of {y} over {x}"),
            PlotKind::Curve => format!("{count} curves of {y} over {x}"),
            PlotKind::Scatter | PlotKind::Front => {
                format!("{} points of {y} over {x}", self.points().count())
            }
        }
    }
}
