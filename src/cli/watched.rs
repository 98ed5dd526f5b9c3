//! The files that a run depends on, and whether one has changed since.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// The version of a file: time of modification and size; `None` if there is no file.
type Stamp = Option<(SystemTime, u64)>;

/// The files that a run depends on.
#[derive(Debug, Default)]
pub(super) struct Watched {
    stamps: Mutex<BTreeMap<PathBuf, Stamp>>,
    /// True if one of them changed since the run began.
    stale: AtomicBool,
}

impl Watched {
    /// Records that the run depends on a file, which need not exist. It must be called before the file is read, so that
    /// no change is missed.
    pub(super) fn note(&self, file: &Path) {
        let mut stamps = self.stamps.lock().unwrap_or_else(PoisonError::into_inner);
        stamps.entry(file.to_owned()).or_insert_with(|| stamp(file));
    }

    /// Returns the number of files that the run depends on.
    pub(super) fn count(&self) -> usize {
        self.stamps.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Returns true if a file has changed since the run began, so that the run is outdated.
    pub(super) fn stale(&self) -> bool {
        self.stale.load(Ordering::Relaxed)
    }

    /// Compares the files with their state at the beginning of the run; returns true if one has changed, and
    /// [`stale`](Self::stale) does from then on.
    pub(super) fn poll(&self) -> bool {
        let stamps = self.stamps.lock().unwrap_or_else(PoisonError::into_inner);
        let changed = stamps.iter().any(|(file, before)| stamp(file) != *before);
        if changed {
            self.stale.store(true, Ordering::Relaxed);
        }
        changed
    }
}

/// Returns the version of a file; `None` if there is none.
fn stamp(file: &Path) -> Stamp {
    let found = fs::metadata(file).ok()?;
    Some((found.modified().ok()?, found.len()))
}
