//! `modl export`: plans in the formats of other programs.

use super::arguments::Globals;
use super::judge::{self, PlanFileFault};
use super::program;
use super::report::Report;
use super::terminal::print_error;
use super::{CallError, Ending, output};
use crate::exchange::{Export, FIRST_LINE, PlanFormat, bundle};
use crate::interpret::WriteError;
use crate::plan::Plan;
use crate::source::{Diagnostic, Sources, code};
use std::path::{Path, PathBuf};

/// Runs the command `modl export`, which writes plan files, or the plans that a program emits, in a format of other
/// programs. All files are read before the first is written. `to`: the name of the format, or `bundle`.
///
/// # Errors
/// A message if a file can't be read or is too large, or a program emits no plan or stands among other files.
pub(super) fn run(files: &[PathBuf], to: &str, globals: &Globals) -> Result<Ending, CallError> {
    let mut report = Report::default();
    report.written = Some(Vec::new());
    let written = |name: &str, plan: &Plan, report: &mut Report| exported(name, plan, to, report, globals);
    program::each_plan(files, ("export", "takes"), report, globals, written)
}

/// Writes a plan in a format; returns true.
///
/// # Errors
/// The fault of a plan that failed, that the format can't hold, or that can't be written.
fn exported(
    name: &str,
    plan: &Plan,
    to: &str,
    report: &mut Report,
    globals: &Globals,
) -> Result<bool, PlanFileFault> {
    let fault = |code, message: String| Box::new((Sources::default(), Diagnostic::error(code, message)));
    let format = PlanFormat::named(to);
    let mut plan = plan.clone();
    if format.is_none_or(|format| format.is_motion) {
        let verdict = judge::judged(&plan);
        if !verdict.ok() {
            let what = verdict.failures.first().map_or("", |failure| &failure.message);
            let message = format!("`{name}` fails the judge, and its motion is not written: {what}");
            let (sources, diagnostic) = *fault(code::NOT_EXPORTED, message);
            let told = diagnostic.hint(format!("`modl verify {name}` tells all of it"));
            return Err(Box::new((sources, told)));
        }
        plan.verdict = Some(verdict);
    }
    let stem = stem(name);
    let title = plan.body.tracks().map(|tracks| tracks.robot.name.clone());
    let title = title.filter(|name| !name.is_empty()).unwrap_or_else(|| stem.clone());
    let export = Export::new(&plan, &title, &stem);
    let cannot = |e: WriteError| {
        let why = match e {
            WriteError::Outside => "it would lie outside the output folder".to_owned(),
            WriteError::Failed(why) => why,
        };
        fault(code::CANNOT_WRITE, format!("what `{name}` is exported to can't be written: {why}"))
    };
    let mut shown = Vec::new();
    match format {
        Some(format) => {
            let files = format.write(&export).map_err(|refusal| {
                fault(code::NOT_EXPORTED, format!("`{name}` is not written as {to}: {refusal}"))
            })?;
            for file in files {
                shown.push(output::write(&globals.out, &file.name, &file.bytes).map_err(cannot)?);
            }
        }
        None => {
            let files = bundle(&export);
            let named = files.iter().map(|file| (file.name.as_str(), file.bytes.as_slice()));
            shown.push(output::write_folder(&globals.out, &stem, named, is_bundle).map_err(cannot)?);
        }
    }
    if !globals.json {
        shown.iter().for_each(|path| print_error(&format!("wrote {path}\n")));
    }
    report.written.get_or_insert_default().extend(shown);
    Ok(true)
}

/// Returns true if a folder is a bundle, which another may replace.
fn is_bundle(folder: &Path) -> bool {
    std::fs::read(folder.join("README.md")).is_ok_and(|page| page.starts_with(FIRST_LINE.as_bytes()))
}

/// Returns the stem of the files of a plan: the name of its file without folders and endings.
fn stem(name: &str) -> String {
    let file = name.rsplit('/').next().unwrap_or(name);
    let stem = file.strip_suffix(".json").unwrap_or(file);
    let stem = stem.strip_suffix(".plan").unwrap_or(stem);
    if stem.is_empty() || stem == "-" { "plan".to_owned() } else { stem.to_owned() }
}
