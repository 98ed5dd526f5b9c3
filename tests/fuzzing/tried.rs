//! How many inputs of each target were tried, in all runs of `fuzz/run` together: `fuzz/tried.json`.

use crate::fuzz::inputs::corpus::root;
use crate::fuzz::targets::TARGETS;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The seeds before this one are those of the gate.
pub const FIRST_SEED: u64 = 1_000_000;

/// What was tried of a target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// The seed that is tried next.
    pub next: u64,
    /// The inputs tried.
    pub inputs: u64,
    /// The seconds that this took.
    pub seconds: f64,
    /// The inputs that broke a property when they were tried; each was mended, and is kept in `fuzz/corpus`.
    pub broke: u64,
}

impl Default for Tried {
    fn default() -> Tried {
        Tried { next: FIRST_SEED, inputs: 0, seconds: 0.0, broke: 0 }
    }
}

fn path() -> std::path::PathBuf {
    root().join("fuzz/tried.json")
}

/// Returns what was tried of each target.
pub fn read() -> BTreeMap<String, Tried> {
    let text = std::fs::read_to_string(path()).unwrap_or_else(|_| "{}".to_owned());
    let mut all: BTreeMap<String, Tried> = serde_json::from_str(&text).expect("it was written to be read");
    TARGETS.iter().for_each(|target| {
        all.entry(target.name.to_owned()).or_default();
    });
    all
}

/// Writes what was tried of each target.
pub fn write(all: &BTreeMap<String, Tried>) {
    let mut rounded = all.clone();
    rounded.values_mut().for_each(|tried| tried.seconds = tried.seconds.round());
    let text = serde_json::to_string_pretty(&rounded).expect("it is JSON") + "\n";
    std::fs::write(path(), text).expect("the file can be written");
}
