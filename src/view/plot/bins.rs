//! Bins of histograms.

use super::scale::round_edges;
use super::{Plot, PlotSeries};

/// The greatest number of bins where the plot states none.
const BINS_MAX: usize = 60;

/// The bins of a histogram, with the number of values in each.
pub(super) struct Bins {
    /// The edges, ascending, one more than there are bins, in SI units. A value on an edge belongs to the bin above it;
    /// one on the last edge to the last bin.
    pub edges: Vec<f64>,
    /// The number of values in each bin, for each series in the order of the plot.
    pub counts: Vec<Vec<usize>>,
}

impl Bins {
    /// Returns the bins of a plot's values: as many as it asks for, from the least value to the greatest; else, at
    /// round edges, about as many as the Rice rule gives for the mean length of a series: twice the cube root of the
    /// number of values.
    pub(super) fn of(plot: &Plot) -> Bins {
        let values: Vec<f64> = plot.points().map(|point| point[1]).collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let edges = match plot.bins {
            Some(count) => {
                let width = if high > low { high - low } else { high.abs().max(1.0) };
                (0..=count).map(|i| low + width * i as f64 / count as f64).collect()
            }
            None => {
                let series = plot.series.len().max(1) as f64;
                let count = 2.0 * libm::cbrt(values.len() as f64 / series);
                round_edges(low, high, (libm::ceil(count) as usize).min(BINS_MAX), plot.x.dimension)
            }
        };
        let counts = plot.series.iter().map(|series| counts(series, &edges)).collect();
        Bins { edges, counts }
    }

    /// Returns the greatest number of values of one series in one bin; 0 without values.
    pub(super) fn most(&self) -> usize {
        self.counts.iter().flatten().copied().max().unwrap_or(0)
    }
}

fn counts(series: &PlotSeries, edges: &[f64]) -> Vec<usize> {
    let bins = edges.len() - 1;
    let mut counts = vec![0; bins];
    for [_, value] in series.points.iter().flatten() {
        let above = edges.partition_point(|edge| edge <= value);
        counts[above.clamp(1, bins) - 1] += 1;
    }
    counts
}
