//! `modl import`: robots of other programs as modules and configurations.

use super::arguments::Globals;
use super::report::{self, Report};
use super::terminal::print_error;
use super::{CallError, Ending, disk, output};
use crate::exchange::{ImportFault, ImportFile, import};
use crate::format::format;
use crate::interpret::WriteError;
use crate::source::{Diagnostic, Sources, Span, code};
use std::path::{Path, PathBuf};

/// The greatest size of a file, in bytes.
const BYTES_MAX: usize = 256 << 20;

/// The number of folders above the description in which the meshes of packages are looked for.
const ABOVE_MAX: usize = 4;

/// Runs the command `modl import`, which writes the module or configuration of files of other programs below the output
/// folder.
///
/// # Errors
/// A message if a file can't be read, or the program can't be written.
pub(super) fn run(files: &[PathBuf], globals: &Globals) -> Result<Ending, CallError> {
    let mut texts = Vec::new();
    for file in files {
        let name = file.to_string_lossy().into_owned();
        let Ok(text) = String::from_utf8(disk::read(file, BYTES_MAX)?) else {
            let message = format!("`{name}` is not UTF-8 text");
            return Ok(wrong(Sources::default(), Diagnostic::error(code::NOT_IMPORTED, message), globals));
        };
        texts.push((name, file.file_name().unwrap_or_default().to_string_lossy(), text));
    }
    let folder = files[0].parent().unwrap_or(Path::new("")).to_owned();
    let mut open = |named: &str| named_file(&folder, named);
    let given: Vec<ImportFile> = texts.iter().map(|(_, name, text)| ImportFile { name, text }).collect();
    let imported = match import(&given, &mut open) {
        Ok(imported) => imported,
        Err((index, fault)) => {
            let (sources, diagnostic) = told(&texts[index].0, &texts[index].2, &fault);
            return Ok(wrong(sources, diagnostic, globals));
        }
    };
    let stem = files[0].file_stem().unwrap_or_default().to_string_lossy();
    let stem: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    let to = format!("{}.mod", if stem.is_empty() { "robot" } else { &stem });
    let text = if imported.what == "config" { laid_out(imported.text) } else { imported.text };
    let written = output::write(&globals.out, &to, text.as_bytes()).map_err(|e| match e {
        WriteError::Outside => CallError(format!("`{to}` would lie outside the output folder")),
        WriteError::Failed(why) => CallError(format!("`{to}` can't be written: {why}")),
    })?;
    if !globals.json {
        imported.notes.iter().for_each(|note| print_error(&format!("note: {note}\n")));
        print_error(&format!("wrote {written}: {} {}\n", imported.what, imported.module));
    }
    let mut report = Report::default();
    report.written = Some(vec![written]);
    report.finish(true, globals);
    Ok(Ending::Fine)
}

/// Returns a program in the layout of `modl fmt`.
fn laid_out(text: String) -> String {
    let id = Sources::default().add("imported.mod", &text, false);
    format(id, &text).map_or(text, |formatted| formatted.text)
}

/// Reports what is wrong.
fn wrong(sources: Sources, diagnostic: Diagnostic, globals: &Globals) -> Ending {
    let mut report = Report::default();
    report.add(&sources, &[diagnostic], &report::style(globals, ""), globals);
    report.finish(false, globals);
    Ending::Wrong
}

/// Returns the diagnostic of a fault in a file, with the sources that it points into.
fn told(name: &str, text: &str, fault: &ImportFault) -> (Sources, Diagnostic) {
    let mut sources = Sources::default();
    let message = format!("`{name}` is nothing that modl can have: {}", fault.message);
    let mut diagnostic = Diagnostic::error(code::NOT_IMPORTED, message);
    if fault.line > 0 {
        let id = sources.add(name, text, false);
        let file = sources.file(id);
        // Columns count characters.
        let line = file.line(fault.line);
        let before: usize = line.chars().take(fault.column.saturating_sub(1)).map(char::len_utf8).sum();
        let at = file.line_start(fault.line) + before;
        diagnostic = diagnostic.label(Span::new(id, at, at), "");
    }
    (sources, diagnostic)
}

/// Returns the bytes of a file that one in a folder names, by a path beside it or in a package; `None` if there is
/// no such file.
fn named_file(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let read = |path: PathBuf| disk::read(&path, BYTES_MAX).ok();
    if let Some(path) = name.strip_prefix("file://") {
        return read(folder.join(path));
    }
    let Some(inside) = name.strip_prefix("package://") else { return read(folder.join(name)) };
    // The package is a folder above the description, or one beside such a folder.
    let below = inside.split_once('/').map_or(inside, |(_, below)| below);
    let above = std::iter::successors(Some(folder.to_owned()), |path| Some(path.join("..")));
    above.take(ABOVE_MAX).find_map(|path| read(path.join(inside)).or_else(|| read(path.join(below))))
}
