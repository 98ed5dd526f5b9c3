//! `modl show`: pages of the plans of a program, or of a plan file.

use super::arguments::Globals;
use super::program::{self, Task};
use super::report::{self, Report};
use super::terminal::{listen_for_cancel, print_error};
use super::{CallError, Ending, judge, output};
use crate::interpret::WriteError;
use crate::plan::Plan;
use crate::view::{self, RenderInput};
use std::path::Path;
use std::process::{Command, Stdio};

/// Runs the command `modl show`, which makes pages of the plans of a program or of a plan file; with `open` the last
/// page is opened in the browser, if one was made. A plan file is judged again first.
///
/// # Errors
/// A message if the file can't be read or lies outside of the project's root, or a page can't be opened; of a plan
/// file also if the page can't be written.
pub(super) fn run(file: &Path, open: bool, globals: &Globals) -> Result<Ending, CallError> {
    let is_plan = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    if is_plan {
        return plan_file(file, open, globals);
    }
    program::run(&[file.to_owned()], Task::Show { open }, globals)
}

/// Writes the page of a plan file, which is verified again.
///
/// # Errors
/// A message if the file can't be read, or the page can't be written or opened.
fn plan_file(file: &Path, open: bool, globals: &Globals) -> Result<Ending, CallError> {
    let bytes = judge::read(file)?;
    listen_for_cancel();
    let name = file.to_string_lossy().into_owned();
    let mut report = Report::default();
    let plan = match judge::parsed(&name, bytes) {
        Ok(plan) => plan,
        Err(fault) => {
            let (sources, diagnostic) = *fault;
            report.add(&sources, &[diagnostic], &report::style(globals, ""), globals);
            report.finish(false, globals);
            return Ok(Ending::Wrong);
        }
    };
    let verdict = judge::judged(&plan);
    let ok = verdict.ok();
    let plan = Plan { verdict: Some(verdict), ..plan };
    let own = file.file_name().unwrap_or_default().to_string_lossy();
    let to = view::page_name(&own);
    let stem = to.strip_suffix(".html").unwrap_or(&to);
    let command = format!("modl show {own}");
    let title = title(&plan, stem);
    let input = RenderInput { title: &title, plan: &plan, texts: &[], command: &command };
    let page = view::page(&input);
    let written = output::write(&globals.out, &to, page.as_bytes()).map_err(|e| match e {
        WriteError::Outside => CallError(format!("the page of `{name}` would lie outside the output folder")),
        WriteError::Failed(why) => CallError(format!("the page of `{name}` can't be written: {why}")),
    })?;
    if !globals.json {
        print_error(&format!("wrote {written}\n"));
    }
    if open {
        open_page(&written)?;
    }
    report.written = Some(vec![written]);
    report.finish(ok, globals);
    Ok(if ok { Ending::Fine } else { Ending::Wrong })
}

/// Returns the title of a page: what turns into what, the robot's name, or the stem of the file.
fn title(plan: &Plan, stem: &str) -> String {
    let name = plan.body.tracks().map(|tracks| tracks.robot.name.as_str());
    view::title(plan, name.filter(|name| !name.is_empty()).unwrap_or(stem))
}

/// Opens a page in the system's browser.
///
/// # Errors
/// A message if the program for it can't be started.
pub(super) fn open_page(page: &str) -> Result<(), CallError> {
    open_address(page).map_err(|why| CallError(format!("`{page}` is written, but {why}")))
}

/// Opens a page, by its path or address, in the system's browser.
///
/// # Errors
/// The reason, `... can't open it`, if the program for it can't be started.
pub(super) fn open_address(page: &str) -> Result<(), String> {
    let (program, arguments): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("explorer", &[])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(arguments).arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let opened = command.spawn();
    opened.map(drop).map_err(|e| format!("`{program}` can't open it: {}", super::disk::system_words(&e)))
}
