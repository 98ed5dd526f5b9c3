//! Scales: the range and the ticks of an axis, in a unit that suits its values.

use super::PlotAxis;
use crate::units::{Dimension, fitting_unit};
use crate::view::tolerances::TOLERANCES;

/// The part of the range of values that is left free at either end.
const ROOM: f64 = 0.04;

/// Ticks of this size or more are written with an exponent.
const PLAIN_MAX: f64 = 1e6;

/// Steps between ticks, in powers of ten.
const STEPS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// Steps between ticks of angles in degrees that divide a turn well.
const STEPS_DEGREES: [f64; 9] = [10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0, 360.0, 720.0];

/// A linear scale of an axis, which maps values in SI units to positions along it.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// The label of the axis with the unit: `torque [N·m]`.
    pub label: String,
    /// The ticks of the axis as (position in 0..1, text), in ascending order.
    pub ticks: Vec<(f64, String)>,
    /// The smallest value shown, in the unit.
    low: f64,
    /// The largest value shown, in the unit.
    high: f64,
    /// One of the unit in SI.
    factor: f64,
}

impl Scale {
    /// Returns the scale of an axis that shows these values (SI, finite) with about `count` ticks.
    pub(super) fn new(axis: &PlotAxis, values: impl Iterator<Item = f64>, count: usize) -> Scale {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let (unit, factor) = fitting_unit(low.abs().max(high.abs()), axis.dimension);
        let (low, high) = (low / factor, high / factor);
        // One value alone stands in the middle of a range of its own size.
        let width =
            if high - low > high.abs() * f64::EPSILON * 8.0 { high - low } else { high.abs().max(1.0) };
        let middle = (low + high) / 2.0;
        let half = width * (0.5 + ROOM);
        let mut scale = Scale {
            label: label(axis, &unit),
            ticks: vec![],
            low: middle - half,
            high: middle + half,
            factor,
        };
        let step = step(2.0 * half, count, axis.dimension == Dimension::ANGLE);
        scale.set_ticks(step);
        scale
    }

    /// Returns the scale of counts from 0 to `most`, with about `count` ticks at whole numbers.
    pub(super) fn of_counts(axis: &PlotAxis, most: usize, count: usize) -> Scale {
        let high = most.max(1) as f64 * (1.0 + ROOM);
        let mut scale = Scale { label: label(axis, ""), ticks: vec![], low: 0.0, high, factor: 1.0 };
        scale.set_ticks(step(high, count, false).max(1.0));
        scale
    }

    /// Returns the position along the axis of a value in SI units: 0 at the lower end, 1 at the upper; below 0 or above
    /// 1 for values outside.
    pub(super) fn position(&self, value: f64) -> f64 {
        (value / self.factor - self.low) / (self.high - self.low)
    }

    /// Sets the ticks at multiples of `step`.
    fn set_ticks(&mut self, step: f64) {
        let decimals = (-libm::floor(libm::log10(step) + TOLERANCES.tick)).max(0.0) as usize;
        let (first, last) =
            (libm::ceil(self.low / step - TOLERANCES.tick), libm::floor(self.high / step + TOLERANCES.tick));
        let count = (last - first).max(0.0) as usize;
        self.ticks = (0..=count)
            .map(|i| (first + i as f64) * step)
            .map(|at| ((at - self.low) / (self.high - self.low), tick_text(at, step, decimals)))
            .collect();
    }
}

/// Returns the label of an axis with its unit in brackets.
fn label(axis: &PlotAxis, unit: &str) -> String {
    let unit = unit.replace('*', "·").replace("^2", "²").replace("^3", "³");
    match (axis.label.is_empty(), unit.is_empty()) {
        (_, true) => axis.label.clone(),
        (true, false) => format!("[{unit}]"),
        (false, false) => format!("{} [{unit}]", axis.label),
    }
}

/// Returns the text of a tick, with a true minus sign.
fn tick_text(at: f64, step: f64, decimals: usize) -> String {
    let at = if at.abs() < step / 2.0 { 0.0 } else { at };
    let text = if at.abs() >= PLAIN_MAX || (step < TOLERANCES.plain_step) {
        format!("{at:.2e}").replace(".00e", "e")
    } else {
        format!("{at:.decimals$}")
    };
    text.replace('-', "−")
}

/// Returns a step between ticks with about `count` of them over a width.
fn step(width: f64, count: usize, degrees: bool) -> f64 {
    let wanted = width / count.max(1) as f64;
    if degrees
        && wanted > STEPS_DEGREES[0] / 2.0
        && let Some(step) = STEPS_DEGREES.iter().find(|step| **step >= wanted)
    {
        return *step;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(wanted)));
    // A power of ten below one is not exact; its inverse is.
    let times = |step: f64| if power < 1.0 { step / libm::round(1.0 / power) } else { step * power };
    STEPS
        .iter()
        .map(|step| times(*step))
        .find(|step| *step >= wanted * (1.0 - TOLERANCES.tick))
        .unwrap_or(10.0 * power)
}

/// Returns edges of bins at round values that cover the range `low` to `high`, in SI units of this dimension,
/// ascending; about `count` of them.
pub(super) fn round_edges(low: f64, high: f64, count: usize, dimension: Dimension) -> Vec<f64> {
    let (_, factor) = fitting_unit(low.abs().max(high.abs()), dimension);
    let (low, high) = (low / factor, high / factor);
    let width = if high > low { high - low } else { high.abs().max(1.0) };
    let step = step(width, count, dimension == Dimension::ANGLE);
    let first = libm::floor(low / step + TOLERANCES.tick);
    let last = libm::floor(high / step + TOLERANCES.tick) + 1.0;
    (0..=(last - first) as usize).map(|i| (first + i as f64) * step * factor).collect()
}
