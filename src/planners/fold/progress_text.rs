//! The text of progress reports.

use crate::units::{Dimension, quantity};

/// Returns a line such as `12 of 384 layouts, 1.3J at best`; `least`: the least energy so far, J, `None` if none
/// is known; `what`: the noun of what is counted.
pub(super) fn counted(done: u64, all: &impl ToString, what: &str, least: Option<f64>) -> String {
    format!("{done} of {} {what}{}", all.to_string(), at_best(least))
}

/// Returns a line such as `1200 nodes, 30 wait, 1.3J at best, no less than 1.2J`; energies in J, `least` is
/// `None` if no layout is known.
pub(super) fn searched(nodes: u64, waiting: usize, least: Option<f64>, bound: f64) -> String {
    format!("{nodes} nodes, {waiting} wait{}, no less than {}", at_best(least), energy(bound))
}

fn at_best(least: Option<f64>) -> String {
    least.map_or_else(String::new, |least| format!(", {} at best", energy(least)))
}

fn energy(value: f64) -> String {
    quantity(value, Dimension::ENERGY)
}
