//! The values that options of the command line take: formats, series, rates.

use crate::exchange::PLAN_FORMATS;
use crate::exchange::series::Series;
use clap::builder::PossibleValuesParser;

/// The target of an export that stands for all formats.
const BUNDLE: &str = "bundle";

/// Returns the parser of `--to`: the names of the formats, and `bundle`.
pub(super) fn targets() -> PossibleValuesParser {
    PossibleValuesParser::new(PLAN_FORMATS.iter().map(|format| format.name).chain([BUNDLE]))
}

/// Returns the parser of `--series`: the names of the series.
pub(super) fn series_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Series::WORDS.iter().map(|(word, _)| *word))
}

/// Returns the rate that a text states, in Hz: a positive number, with `Hz` or `kHz` behind it or nothing.
///
/// # Errors
/// A message that says what is wanted.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    let (number, factor) = match (text.strip_suffix("kHz"), text.strip_suffix("Hz")) {
        (Some(number), _) => (number, 1e3),
        (_, Some(number)) => (number, 1.0),
        _ => (text, 1.0),
    };
    let rate = number.trim().parse::<f64>().ok().map(|rate| rate * factor);
    rate.filter(|rate| *rate > 0.0 && rate.is_finite())
        .ok_or_else(|| "a rate is a positive number, such as `100Hz` or `1kHz`".to_owned())
}

/// Returns the number of bytes that a text states: a positive number, with `kB`, `MB` or `GB` behind it or nothing.
///
/// # Errors
/// A message that says what is wanted.
pub(super) fn bytes(text: &str) -> Result<usize, String> {
    let units = [("kB", 1e3), ("MB", 1e6), ("GB", 1e9)];
    let unit = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, *factor)));
    let (number, factor) = unit.unwrap_or((text, 1.0));
    let bytes = number.trim().parse::<f64>().ok().map(|number| number * factor);
    bytes
        .filter(|bytes| (1.0..1e18).contains(bytes))
        .map(|bytes| bytes as usize)
        .ok_or_else(|| "a size is a positive number of bytes, such as `500MB` or `4GB`".to_owned())
}

/// Reads a part of a study, such as `17/64`.
///
/// # Errors
/// A message if it is none.
pub(super) fn part(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((i, n)) if 1 <= i && i <= n => Ok((i, n)),
        _ => Err("a part is written 17/64, from 1/64 to 64/64".to_owned()),
    }
}

/// A plot of a table, as the command line names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum TablePlot {
    /// A scatter plot of two columns with the rows that no other is better than in both; for each, true if less is better.
    Front([(String, bool); 2]),
    /// A line for each row across all columns of numbers.
    Parallel,
    /// The number of rows by the value of a column.
    Histogram(String),
}

impl TablePlot {
    /// Reads a plot such as `front:speed,-energy`, `parallel` or `histogram:speed`.
    ///
    /// # Errors
    /// A message that says what is wanted.
    pub(super) fn read(text: &str) -> Result<TablePlot, String> {
        let one = |name: &str| match name.trim().strip_prefix('-') {
            Some(name) => (name.to_owned(), true),
            None => (name.trim().to_owned(), false),
        };
        match text.split_once(':') {
            None if text == "parallel" => Ok(TablePlot::Parallel),
            Some(("histogram", name)) if !name.is_empty() => Ok(TablePlot::Histogram(name.to_owned())),
            Some(("front", names)) => match names.split_once(',') {
                Some((x, y)) => Ok(TablePlot::Front([one(x), one(y)])),
                None => Err("a front is of two columns, `front:speed,-energy`".to_owned()),
            },
            _ => Err("a plot is written `front:speed,-energy`, `parallel` or `histogram:speed`".to_owned()),
        }
    }
}
