//! The examples in documentation that `modl test` runs; they write nothing.

use super::disk::Project;
use super::terminal::Terminal;
use crate::check::{self, Checked, Entry};
use crate::document::examples::examples;
use crate::interpret::{Host, Mode, Options, SilentHost};
use crate::source::{Diagnostic, Files};

/// The result of running an example.
pub(super) struct Ran {
    /// The name of the example, which `--filter` matches and messages show.
    pub name: String,
    /// The checked program of the example.
    pub checked: Checked,
    /// The errors and warnings of the example, in the order in which they were found.
    pub diagnostics: Vec<Diagnostic>,
    /// True if the example ran without an error.
    pub passed: bool,
    /// True if the user cancelled the example.
    pub cancelled: bool,
}

/// Runs the examples in the documentation of a program whose names contain the filter, in the order of the text; all of
/// them for `None`. Empty if the program can't be read.
pub(super) fn run(
    project: &Project,
    filter: Option<&str>,
    terminal: &Terminal,
    options: &Options,
) -> Vec<Ran> {
    let Ok(bytes) = project.read(&project.name) else { return Vec::new() };
    let text = String::from_utf8_lossy(&bytes);
    let mut ran = Vec::new();
    for example in examples(&text) {
        let name = format!("example in line {}", example.first_line);
        if !name.contains(filter.unwrap_or_default()) {
            continue;
        }
        let entry = Entry {
            name: project.name.clone(),
            text: example.text,
            first_line: example.first_line,
            value: None,
            last: None,
        };
        let checked = check::check_session(project, &[entry]);
        let mut diagnostics = checked.diagnostics.clone();
        let mut cancelled = false;
        if !diagnostics.iter().any(Diagnostic::is_error) {
            let mode = if example.only_checked { Mode::Check } else { Mode::Run };
            let mut host = SilentHost(terminal.cancel_state());
            let mut outcome = crate::execute::run(&checked, mode, project as &dyn Files, &mut host, options);
            diagnostics.append(&mut outcome.diagnostics);
            cancelled = outcome.cancelled;
        }
        let passed = !cancelled && !diagnostics.iter().any(Diagnostic::is_error);
        ran.push(Ran { name, checked, diagnostics, passed, cancelled });
    }
    ran
}
