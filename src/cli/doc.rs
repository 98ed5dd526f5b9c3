//! `modl doc`: the documentation of a project and of the standard library as a static site.

use super::arguments::Globals;
use super::disk::Project;
use super::manifest::{self, Manifest};
use super::report::{self, JsonLink, Report};
use super::terminal::{cancel_state, cancelled, listen_for_cancel, print_error};
use super::{CallError, Ending, output, show};
use crate::document::{self, LinkFault, Manual, Request, Site};
use crate::interpret::WriteError;
use crate::source::Files;
use std::path::Path;

/// The folder of the site below the output folder.
const FOLDER: &str = "doc";

/// The greatest depth of folders that are searched.
const DEPTH_MAX: usize = 16;

/// Runs the command `modl doc`, which writes the documentation site of the project in `folder`. `manual`: the
/// manual, to put it into the site and document the standard library, too; `open`: true to open the site in the browser.
///
/// # Errors
/// A message if there is no program to document, or a file can't be written or opened.
pub(super) fn run(
    folder: &Path,
    manual: Option<&Manual>,
    open: bool,
    globals: &Globals,
) -> Result<Ending, CallError> {
    let project =
        Project::of_folder(Some(globals.root.as_deref().unwrap_or(folder)), globals.stdlib.as_deref())?;
    let home = globals.out.join(FOLDER);
    let mut programs = Vec::new();
    // Programs that pages lead to are copied into the site, and are not documented there.
    collect(&project, "", project.path_below(&home).as_deref(), 0, &mut programs);
    if programs.is_empty() && manual.is_none() {
        return Err(CallError(format!("no programs in `{}`", folder.display())));
    }
    listen_for_cancel();
    let modl = manifest::program();
    let before = Manifest::read(&home);
    let known = before.as_ref().map(|manifest| manifest.known(&home, &project, modl.as_deref()));
    let request = Request {
        files: &project,
        programs: &programs,
        manual,
        cancel_state: cancel_state(),
        known: &known.unwrap_or_default(),
    };
    let site = document::site(&request);
    let mut report = Report::default();
    if cancelled() {
        report.finish(false, globals);
        return Ok(Ending::Cancelled);
    }
    let style = report::style(globals, &project.folder);
    for (checked, errors) in &site.wrong {
        report.add(&checked.sources, errors, &style, globals);
    }
    if !globals.json {
        for fault in &site.faults {
            let of = if fault.entry.is_empty() { String::new() } else { format!(", {}", fault.entry) };
            print_error(&format!("{}{of}: the link `{}` leads nowhere\n", fault.file, fault.link));
        }
    }
    let wrote =
        write(&home, &site, before.as_ref(), &Manifest::of(&site, modl.as_deref().unwrap_or_default()))?;
    let index = home.join("index.html").to_string_lossy().into_owned();
    if !globals.json {
        print_error(&wrote.words(&index, &home));
    }
    report.written = Some(vec![index.clone()]);
    let ok = site.faults.is_empty() && site.wrong.is_empty();
    let link = |fault: LinkFault| JsonLink { page: fault.file, entry: fault.entry, link: fault.link };
    report.broken_links = Some(site.faults.into_iter().map(link).collect());
    if open {
        show::open_page(&index)?;
    }
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// The changes to the files of a site.
struct Wrote {
    /// The number of its files.
    files: usize,
    /// The number of those that were written; the others were so already.
    written: usize,
    /// The number of files of an earlier site that were removed.
    removed: usize,
    /// The names of those that were left, since someone has changed them.
    left: Vec<String>,
}

impl Wrote {
    /// Returns the words for it, in lines; `index` is the path of the first page of the site in `home`.
    fn words(&self, index: &str, home: &Path) -> String {
        let Wrote { files, written, removed, left } = self;
        let home = home.display();
        let left = left.iter().map(|name| format!("left {home}/{name}: it is not as modl wrote it\n"));
        let left: String = left.collect();
        let gone = if *removed == 0 { String::new() } else { format!(", removed {removed}") };
        if written == files {
            format!("{left}wrote {index} and {} more{gone}\n", files - 1)
        } else if *written == 0 && *removed == 0 {
            format!("{left}nothing has changed: {index} and {} more\n", files - 1)
        } else {
            format!("{left}wrote {written} of {files} files in {home}{gone}\n")
        }
    }
}

/// Writes the files of a site that are not there as they should be, and removes those that only the site `before`
/// had.
///
/// # Errors
/// A message if a file can't be written or removed. The files are then partly those of the site before, and the next
/// run mends that.
fn write(
    home: &Path,
    site: &Site,
    before: Option<&Manifest>,
    manifest: &Manifest,
) -> Result<Wrote, CallError> {
    let cannot = |done: &str, name: &str, e| match e {
        WriteError::Outside => CallError(format!("`{name}` would lie outside the output folder")),
        WriteError::Failed(why) => CallError(format!("`{name}` can't be {done}: {why}")),
    };
    let gone = before.map_or(Ok((0, Vec::new())), |before| before.remove_all_but(manifest, home));
    let (removed, left) = gone.map_err(|(name, e)| cannot("removed", &name, e))?;
    // The manifest comes first, so that it names every file that is written: what it says is compared with the files.
    let text = manifest.text();
    output::write_changed(home, manifest::NAME, &text).map_err(|e| cannot("written", manifest::NAME, e))?;
    let mut written = 0;
    for (name, bytes) in &site.files {
        let changed = output::write_changed(home, name, bytes).map_err(|e| cannot("written", name, e))?;
        written += usize::from(changed);
    }
    Ok(Wrote { files: site.files.len(), written, removed, left })
}

/// Collects the programs of a folder and those below it, by path, but for those in the folder `site` and in other
/// sites.
fn collect(files: &Project, folder: &str, site: Option<&str>, depth: usize, found: &mut Vec<String>) {
    for name in files.list(folder) {
        let path = if folder.is_empty() { name } else { format!("{folder}/{name}") };
        match path.strip_suffix('/') {
            Some(inner) if depth < DEPTH_MAX => {
                let manifest = format!("{inner}/{}", manifest::NAME);
                if Some(inner) != site && files.read(&manifest).is_err() {
                    collect(files, inner, site, depth + 1, found);
                }
            }
            Some(_) => {}
            None if path.ends_with(".mod") => found.push(path),
            None => {}
        }
    }
}
