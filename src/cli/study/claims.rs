//! Locks between drivers on one folder, and the attempts of those that ended.
//!
//! A driver locks the blocks of rows that it works on: another one takes others. The system frees the locks of a process
//! that ends, however it does. That is only to save work: rows are the same whoever computes them.
//!
//! While a driver works, a file of it says which row each of its threads is at. The next driver that finds such a file
//! without an owner notes an attempt for each of these rows.

use crate::cli::CallError;
use crate::cli::disk::system_words;
use crate::cli::output;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::NamedTempFile;

/// The attempts after which a row is set aside.
pub(super) const ATTEMPTS_MAX: u32 = 3;
/// The bytes of a thread's place in the file of a driver: a row's number and a line end.
const PLACE: usize = 21;
/// The ending of the files of drivers.
const DRIVER: &str = ".run";
/// The ending of the files that count attempts.
const ATTEMPTS: &str = ".lost";

/// A lock on a block of rows, which is freed when this is dropped.
pub(super) struct Claim(#[expect(dead_code, reason = "it holds the lock")] File);

/// Locks something by its name; `None` if another driver has it.
///
/// # Errors
/// The failure of the system.
pub(super) fn claim(folder: &Path, name: &str) -> io::Result<Option<Claim>> {
    let folder = folder.join("claims");
    fs::create_dir_all(&folder)?;
    let file = OpenOptions::new()
        .create(true)
        .truncate(false)
        .write(true)
        .open(folder.join(format!("{name}.lock")))?;
    match file.try_lock() {
        Ok(()) => Ok(Some(Claim(file))),
        Err(fs::TryLockError::WouldBlock) => Ok(None),
        // A file system without locks: work may be done twice.
        Err(fs::TryLockError::Error(_)) => Ok(Some(Claim(file))),
    }
}

/// The file of this driver, with the row at which each of its threads is.
pub(super) struct Journal {
    file: Mutex<NamedTempFile>,
}

impl Journal {
    /// Begins the file of a driver with so many threads.
    ///
    /// # Errors
    /// A message if the system refuses.
    pub(super) fn begin(folder: &Path, threads: usize) -> Result<Journal, CallError> {
        let failed = |e: io::Error| {
            CallError(format!("the folder `{}` can't be written: {}", folder.display(), system_words(&e)))
        };
        let running = folder.join("running");
        fs::create_dir_all(&running).map_err(failed)?;
        let mut file = tempfile::Builder::new()
            .prefix("driver-")
            .suffix(DRIVER)
            .tempfile_in(&running)
            .map_err(failed)?;
        // Without locks nobody's file is taken for that of a driver that ended.
        drop(file.as_file().try_lock());
        file.write_all(" ".repeat(PLACE * threads).as_bytes()).map_err(failed)?;
        Ok(Journal { file: Mutex::new(file) })
    }

    /// Notes the row at which a thread is; `None`: at none. A failure is of no consequence but that an attempt may not
    /// be counted.
    pub(super) fn note(&self, thread: usize, row: Option<u64>) {
        let text = row.map_or_else(|| " ".repeat(PLACE), |row| format!("{row:>20}\n"));
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let at = SeekFrom::Start((thread * PLACE) as u64);
        drop(file.seek(at).and_then(|_| file.write_all(text.as_bytes())));
    }
}

/// The attempts at rows whose drivers ended within them.
pub(super) struct Attempts {
    folder: PathBuf,
}

impl Attempts {
    /// Returns the attempts of a study's folder, those included that ended drivers left behind.
    pub(super) fn of(folder: &Path) -> Attempts {
        let attempts = Attempts { folder: folder.join("running") };
        let Ok(entries) = fs::read_dir(&attempts.folder) else { return attempts };
        for entry in entries.flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|ending| DRIVER[1..] == *ending) {
                attempts.take_over(&path);
            }
        }
        attempts
    }

    /// Counts the rows of a driver's file, if its driver has ended.
    fn take_over(&self, path: &Path) {
        let Ok(mut file) = File::open(path) else { return };
        if file.try_lock().is_err() {
            return;
        }
        let mut text = String::new();
        drop(file.read_to_string(&mut text));
        // Of two drivers that find the file, the one that removes it counts.
        if fs::remove_file(path).is_ok() {
            for row in text.split_whitespace().filter_map(|row| row.parse().ok()) {
                self.add(row);
            }
        }
    }

    fn name(row: u64) -> String {
        format!("{row}{ATTEMPTS}")
    }

    /// Returns the number of attempts at a row that ended their drivers.
    pub(super) fn count(&self, row: u64) -> u32 {
        let text = fs::read_to_string(self.folder.join(Attempts::name(row)));
        text.ok().and_then(|text| text.trim().parse().ok()).unwrap_or(0)
    }

    fn add(&self, row: u64) {
        let count = self.count(row).saturating_add(1);
        drop(output::write(&self.folder, &Attempts::name(row), format!("{count}\n").as_bytes()));
    }

    /// Returns true if any attempt was counted: then each row is looked up.
    pub(super) fn any(&self) -> bool {
        let is_count = |entry: fs::DirEntry| entry.file_name().to_string_lossy().ends_with(ATTEMPTS);
        fs::read_dir(&self.folder).is_ok_and(|entries| entries.flatten().any(is_count))
    }

    /// Forgets all attempts.
    pub(super) fn forget(&self) {
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        for entry in entries.flatten().filter(|e| e.file_name().to_string_lossy().ends_with(ATTEMPTS)) {
            drop(fs::remove_file(entry.path()));
        }
    }
}
