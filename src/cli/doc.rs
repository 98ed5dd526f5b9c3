//! `modl doc`: the documentation of a project and of the standard library as a static site.

use super::arguments::Globals;
use super::disk::Project;
use super::report::{self, JsonLink, Report};
use super::terminal::{cancel_state, listen_for_cancel, print_error};
use super::{CallError, Ending, output, show};
use crate::document::{self, LinkFault, Request, Site};
use crate::interpret::WriteError;
use crate::source::Files;
use std::path::Path;

/// The folder of the site below the output folder.
const FOLDER: &str = "doc";

/// The greatest depth of folders that are searched.
const DEPTH_MAX: usize = 16;

/// Runs `modl doc`; `library` is true if the standard library is documented, too.
///
/// # Errors
/// A message if there is no program to document, or a file can't be written or opened.
pub(super) fn run(folder: &Path, library: bool, open: bool, globals: &Globals) -> Result<Ending, CallError> {
    let project =
        Project::of_folder(Some(globals.root.as_deref().unwrap_or(folder)), globals.stdlib.as_deref())?;
    let mut programs = Vec::new();
    collect(&project, "", 0, &mut programs);
    if programs.is_empty() && !library {
        return Err(CallError(format!("no programs in `{}`", folder.display())));
    }
    listen_for_cancel();
    let request = Request { files: &project, programs: &programs, library, cancel_state: cancel_state() };
    let Site { files, faults, wrong } = document::site(&request);
    let mut report = Report::default();
    let style = report::style(globals, &project.folder);
    for (checked, errors) in &wrong {
        report.add(&checked.sources, errors, &style, globals);
    }
    if !globals.json {
        for fault in &faults {
            let of = if fault.entry.is_empty() { String::new() } else { format!(", {}", fault.entry) };
            print_error(&format!("{}{of}: the link `{}` leads nowhere\n", fault.file, fault.link));
        }
    }
    let home = globals.out.join(FOLDER);
    for (name, bytes) in &files {
        output::write(&home, name, bytes).map_err(|e| match e {
            WriteError::Outside => CallError(format!("`{name}` would lie outside the output folder")),
            WriteError::Failed(why) => CallError(format!("`{name}` can't be written: {why}")),
        })?;
    }
    let index = home.join("index.html").to_string_lossy().into_owned();
    if !globals.json {
        print_error(&format!("wrote {index} and {} more\n", files.len() - 1));
    }
    report.written = Some(vec![index.clone()]);
    let ok = faults.is_empty() && wrong.is_empty();
    let link = |fault: LinkFault| JsonLink { page: fault.file, entry: fault.entry, link: fault.link };
    report.broken_links = Some(faults.into_iter().map(link).collect());
    if open {
        show::open_page(&index)?;
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// Collects the programs of a folder and those below it, by path.
fn collect(files: &Project, folder: &str, depth: usize, found: &mut Vec<String>) {
    for name in files.list(folder) {
        let path = if folder.is_empty() { name } else { format!("{folder}/{name}") };
        match path.strip_suffix('/') {
            Some(inner) if depth < DEPTH_MAX => collect(files, inner, depth + 1, found),
            Some(_) => {}
            None if path.ends_with(".mod") => found.push(path),
            None => {}
        }
    }
}
