//! `modl fmt`: formats programs in place.

use super::arguments::Globals;
use super::disk::{self, FILE_BYTES_MAX, STDIN_NAME, system_words};
use super::folders::{self, Found};
use super::report::{self, Report};
use super::terminal::{print, print_error, print_exact};
use super::{CallError, Ending, output};
use crate::format::format;
use crate::source::{Diagnostic, Sources, code};
use std::path::{Path, PathBuf};

/// Runs the command `modl fmt`, which formats programs; with `check` it writes nothing, and only tells which are not
/// formatted. A folder stands for all programs below it.
///
/// # Errors
/// A message if a file or folder can't be read, a folder holds no program, a file can't be written, or the formatter
/// has a defect.
pub(super) fn run(files: &[PathBuf], check: bool, globals: &Globals) -> Result<Ending, CallError> {
    // All files are read first, so that a wrong call does nothing.
    let programs =
        folders::programs(files)?.into_iter().map(read).collect::<Result<Vec<Program>, CallError>>()?;
    let mut report = Report::default();
    report.written = Some(Vec::new());
    let mut ok = true;
    for program in programs {
        ok &= one(&program, check, &mut report, globals)?;
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// A program to format.
struct Program {
    /// The file; `None` for standard input.
    file: Option<PathBuf>,
    name: String,
    bytes: Vec<u8>,
}

/// Reads a program.
///
/// # Errors
/// A message if it can't be read.
fn read(found: Found) -> Result<Program, CallError> {
    let bytes = disk::read(&found.file, FILE_BYTES_MAX)?;
    Ok(match found.file == Path::new("-") {
        true => Program { file: None, name: STDIN_NAME.to_owned(), bytes },
        false => Program { name: found.file.to_string_lossy().into_owned(), file: Some(found.file), bytes },
    })
}

/// Formats a program, or checks its style. Returns true if it is readable and (with `check`) in style.
///
/// # Errors
/// A message if it can't be written, or the formatter has a defect.
fn one(program: &Program, check: bool, report: &mut Report, globals: &Globals) -> Result<bool, CallError> {
    let Program { file, name, bytes } = program;
    let mut sources = Sources::default();
    let style = report::style(globals, "");
    let Ok(text) = std::str::from_utf8(bytes) else {
        let diagnostic = Diagnostic::error(code::NOT_UTF8, format!("`{name}` is not UTF-8 text"));
        report.add(&sources, &[diagnostic], &style, globals);
        return Ok(false);
    };
    let id = sources.add(name, text, false);
    let Some(formatted) = format(id, text) else {
        return Err(CallError(format!(
            "`{name}` stays as it is: formatting would have changed what it means, a defect of modl"
        )));
    };
    report.add(&sources, &formatted.diagnostics, &style, globals);
    let sound = formatted.diagnostics.is_empty();
    if file.is_none() && !check {
        if globals.json {
            report.printed = Some(formatted.text.lines().map(str::to_owned).collect());
        } else {
            print_exact(&formatted.text);
        }
        return Ok(sound);
    }
    if formatted.text == text {
        return Ok(sound);
    }
    report.written.get_or_insert_default().push(name.clone());
    if check {
        if !globals.json {
            print(&format!("{name}:{}\n", first_difference(text, &formatted.text)));
        }
        return Ok(false);
    }
    if let Some(file) = file {
        output::replace(file, formatted.text.as_bytes())
            .map_err(|e| CallError(format!("the file `{name}` can't be written: {}", system_words(&e))))?;
        if !globals.json {
            print_error(&format!("formatted {name}\n"));
        }
    }
    Ok(sound)
}

/// Returns the first line that differs, from 1.
fn first_difference(a: &str, b: &str) -> usize {
    let same = a.split('\n').zip(b.split('\n')).take_while(|(a, b)| a == b);
    same.count() + 1
}
