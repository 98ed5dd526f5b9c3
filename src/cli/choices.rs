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
