//! `modl import`: robot descriptions as modules.

use super::arguments::Globals;
use super::report::{self, Report};
use super::terminal::print_error;
use super::{CallError, Ending, disk, output};
use crate::exchange::{ImportFault, import_urdf};
use crate::interpret::WriteError;
use crate::source::{Diagnostic, Sources, Span, code};
use std::path::{Path, PathBuf};

/// The greatest size of a description or of one of its meshes, in bytes.
const BYTES_MAX: usize = 256 << 20;

/// The number of folders above the description in which the meshes of packages are looked for.
const ABOVE_MAX: usize = 4;

/// Runs the command `modl import`, which writes the module of a robot description below the output folder.
///
/// # Errors
/// A message if the file can't be read, or the module can't be written.
pub(super) fn run(file: &Path, globals: &Globals) -> Result<Ending, CallError> {
    let bytes = disk::read(file, BYTES_MAX)?;
    let name = file.to_string_lossy().into_owned();
    let mut report = Report::default();
    let mut wrong = |sources: Sources, diagnostic: Diagnostic| {
        report.add(&sources, &[diagnostic], &report::style(globals, ""), globals);
        std::mem::take(&mut report).finish(false, globals);
        Ok(Ending::Wrong)
    };
    let Ok(text) = String::from_utf8(bytes) else {
        let message = format!("`{name}` is not UTF-8 text");
        return wrong(Sources::default(), Diagnostic::error(code::NOT_IMPORTED, message));
    };
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    let mut open = |mesh: &str| mesh_file(&folder, mesh);
    let source = file.file_name().unwrap_or_default().to_string_lossy();
    let imported = match import_urdf(&text, &source, &mut open) {
        Ok(imported) => imported,
        Err(ImportFault { message, line, column }) => {
            let mut sources = Sources::default();
            let mut diagnostic = Diagnostic::error(
                code::NOT_IMPORTED,
                format!("`{name}` is no robot that modl can have: {message}"),
            );
            if line > 0 {
                let id = sources.add(&name, &text, false);
                let file = sources.file(id);
                let at = file.line_start(line) + column.saturating_sub(1).min(file.line(line).len());
                diagnostic = diagnostic.label(Span::new(id, at, at), "");
            }
            return wrong(sources, diagnostic);
        }
    };
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let stem: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    let to = format!("{}.mod", if stem.is_empty() { "robot" } else { &stem });
    let written = output::write(&globals.out, &to, imported.text.as_bytes()).map_err(|e| match e {
        WriteError::Outside => CallError(format!("`{to}` would lie outside the output folder")),
        WriteError::Failed(why) => CallError(format!("`{to}` can't be written: {why}")),
    })?;
    if !globals.json {
        imported.notes.iter().for_each(|note| print_error(&format!("note: {note}\n")));
        print_error(&format!("wrote {written}: module {}\n", imported.module));
    }
    report.written = Some(vec![written]);
    report.finish(true, globals);
    Ok(Ending::Fine)
}

/// Returns the bytes of a mesh that a description in a folder names, by a path beside it or in a package; `None` if there is
/// no such file.
fn mesh_file(folder: &Path, name: &str) -> Option<Vec<u8>> {
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
