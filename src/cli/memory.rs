//! The limit of memory, and the end of a command that goes beyond it.

use super::arguments::Globals;
use super::report::{self, Report};
use super::{CallError, Ending};
use crate::interpret::memory_limit;
use crate::interrupt::{self, CancelState, Ended, memory};
use crate::source::Sources;
use std::fs;

/// The limit where the system does not say how much memory it has, bytes.
const DEFAULT: usize = 8_000_000_000;

/// Sets the limit of memory: that of the command line, else three quarters of the memory that the machine, or the
/// container that it runs in, has.
pub(super) fn limit(globals: &Globals) {
    memory::set_limit(
        globals.max_memory.unwrap_or_else(|| available().map_or(DEFAULT, |bytes| bytes / 4 * 3)),
    );
}

/// Returns the memory of the machine, or of the container if that has less, in bytes; `None` where the system does not
/// say.
fn available() -> Option<usize> {
    let machine = fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        let kibibytes: usize = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
        kibibytes.checked_mul(1024)
    });
    // A container without a limit says `max`.
    let container =
        fs::read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse().ok());
    machine.into_iter().chain(container).min()
}

/// Runs a command; where it takes more memory than the limit outside of a program's evaluation, which reports that by
/// itself, reports that.
///
/// # Errors
/// Those of the command.
pub(super) fn within_limit(
    globals: &Globals,
    command: impl FnOnce() -> Result<Ending, CallError>,
) -> Result<Ending, CallError> {
    let ended = interrupt::catch(&CancelState::default(), |_| {}, command);
    match ended {
        Ok(ending) => ending,
        Err(Ended::Cancelled) => Ok(Ending::Cancelled),
        Err(Ended::OutOfMemory) => {
            let mut report = Report::default();
            report.add(&Sources::default(), &[memory_limit()], &report::style(globals, ""), globals);
            report.finish(false, globals);
            Ok(Ending::Wrong)
        }
    }
}
