//! Plots of a study's table.

use crate::cli::choices::TablePlot;
use crate::interpret::study_columns::StudyColumn;
use crate::units::Dimension;
use crate::view::plot::{ParallelPlot, Plot, PlotAxis, PlotKind, PlotSeries, parallel_svg, svg};

/// Returns the name of the file of a plot, beside the table of a study.
pub(super) fn file(wanted: &TablePlot, study: &str) -> String {
    match wanted {
        TablePlot::Front([(x, _), (y, _)]) => format!("{study}-{x}-{y}.svg"),
        TablePlot::Parallel => format!("{study}-parallel.svg"),
        TablePlot::Histogram(name) => format!("{study}-{name}.svg"),
    }
}

/// The numbers of a table: for each row, the values of the columns that hold numbers; rows with errors are left out.
pub(super) struct Numbers {
    axes: Vec<PlotAxis>,
    rows: Vec<Vec<Option<f64>>>,
}

impl Numbers {
    /// Reads the lines of a table without its head, in CSV. `columns`: those between the number of the row and the code.
    pub(super) fn read<'l>(columns: &[StudyColumn], lines: impl Iterator<Item = &'l str>) -> Numbers {
        let kept: Vec<(usize, Dimension)> =
            columns.iter().enumerate().filter_map(|(i, column)| Some((i, column.dimension?))).collect();
        let axes = kept
            .iter()
            .map(|(i, dimension)| PlotAxis { label: columns[*i].name.clone(), dimension: *dimension });
        let axes = axes.collect();
        let row = |line: &str| {
            let fields = fields(line);
            let sound = fields.get(columns.len() + 1).is_some_and(String::is_empty);
            let value = |i: &usize| fields.get(i + 1)?.parse::<f64>().ok().filter(|x| x.is_finite());
            sound.then(|| kept.iter().map(|(i, _)| value(i)).collect())
        };
        Numbers { axes, rows: lines.filter_map(row).collect() }
    }

    /// Returns the index of a column of numbers.
    ///
    /// # Errors
    /// A message if there is none of this name.
    fn column(&self, name: &str) -> Result<usize, String> {
        let found = self.axes.iter().position(|axis| axis.label == name);
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.label.as_str()).collect();
        found.ok_or_else(|| {
            format!("the table has no column of numbers `{name}`; there is {}", names.join(", "))
        })
    }

    /// Returns a plot as the text of an SVG file.
    ///
    /// # Errors
    /// A message if the table has no such column, or no values to draw.
    pub(super) fn drawn(&self, wanted: &TablePlot, title: &str) -> Result<String, String> {
        if self.rows.is_empty() {
            return Err("no row has values to draw".to_owned());
        }
        let title = title.to_owned();
        match wanted {
            TablePlot::Parallel if self.axes.len() < 2 => {
                Err("parallel coordinates need two columns of numbers".to_owned())
            }
            TablePlot::Parallel => {
                let (axes, rows) = (self.axes.clone(), self.rows.clone());
                Ok(parallel_svg(&ParallelPlot { title, axes, rows }))
            }
            TablePlot::Histogram(name) => {
                let column = self.column(name)?;
                let points = self.rows.iter().map(|row| row[column].map(|x| [0.0, x])).collect();
                let number = PlotAxis { label: "rows".to_owned(), dimension: Dimension::NUMBER };
                let series = vec![PlotSeries { name: String::new(), points }];
                let (kind, x) = (PlotKind::Histogram, self.axes[column].clone());
                drawn(Plot { kind, title, x, y: number, series, bins: None })
            }
            TablePlot::Front([(x, x_less), (y, y_less)]) => {
                let (i, j) = (self.column(x)?, self.column(y)?);
                let points: Vec<Option<[f64; 2]>> =
                    self.rows.iter().map(|row| Some([row[i]?, row[j]?])).collect();
                let front = front(points.iter().flatten().copied(), [*x_less, *y_less]);
                let series = vec![
                    PlotSeries { name: "rows".to_owned(), points },
                    PlotSeries { name: "front".to_owned(), points: front.into_iter().map(Some).collect() },
                ];
                let (x, y) = (self.axes[i].clone(), self.axes[j].clone());
                drawn(Plot { kind: PlotKind::Front, title, x, y, series, bins: None })
            }
        }
    }
}

fn drawn(plot: Plot) -> Result<String, String> {
    let any = plot.series.iter().any(|series| series.points.iter().any(Option::is_some));
    if any { Ok(svg(&plot)) } else { Err("no row has values to draw".to_owned()) }
}

/// Returns the points that no other is at least as good as in both coordinates and better in one (Pareto's front), from the
/// best in the first coordinate on. `less`: for each coordinate, true if less is better.
fn front(points: impl Iterator<Item = [f64; 2]>, less: [bool; 2]) -> Vec<[f64; 2]> {
    let sign = less.map(|less| if less { 1.0 } else { -1.0 });
    let mut sorted: Vec<[f64; 2]> = points.map(|[x, y]| [x * sign[0], y * sign[1]]).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for point in sorted {
        if kept.last().is_none_or(|last| point[1] < last[1]) {
            kept.push(point);
        }
    }
    kept.into_iter().map(|[x, y]| [x * sign[0], y * sign[1]]).collect()
}

/// Returns the fields of a line of CSV, as RFC 4180 says.
fn fields(line: &str) -> Vec<String> {
    let (mut all, mut field, mut inside) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if inside && letters.peek() == Some(&'"') => field.extend(letters.next()),
            '"' => inside = !inside,
            ',' if !inside => all.push(std::mem::take(&mut field)),
            letter => field.push(letter),
        }
    }
    all.push(field);
    all
}
