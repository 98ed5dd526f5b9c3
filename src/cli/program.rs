//! `modl run`, `modl check` and `modl test`.

use super::arguments::Globals;
use super::disk::{Project, STDIN_NAME};
use super::folders::{self, Found};
use super::judge::{self, PlanFileFault};
use super::report::{self, JsonTest, Report};
use super::terminal::{Terminal, cancelled, listen_for_cancel, print, print_error};
use super::watched::Watched;
use super::{CallError, Ending, examples, show};

use crate::check;
use crate::interpret::{Limits, Mode, Options, Outcome, TestResult};
use crate::plan::Plan;
use crate::source::{Diagnostic, Files};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The task of a command that runs programs: which part is evaluated, and what is done with its plans.
pub(super) enum Task {
    /// Run the program.
    Run,
    /// Run the program, and draw every plan.
    Show {
        /// True if the last page is opened in the browser.
        open: bool,
    },
    /// Run the program, and collect the plans that it emits; no file is written.
    Collect,
    /// Check the program only.
    Check,
    /// Run its tests whose names contain the filter, and the examples in its documentation; all of them for `None`.
    Test(Option<String>),
}

/// The results of all files of one call.
#[derive(Default)]
struct Tally {
    report: Report,
    passed: usize,
    failed: usize,
    cancelled: bool,
}

/// Runs programs one after the other, in order, each as the task says, and prints their results and diagnostics. Files
/// are opened before the first one runs, so that a wrong call does nothing. A folder stands for all programs below it
/// if the task checks or tests. Returns [`Ending::Fine`] if nothing was wrong, [`Ending::Wrong`] if a program has
/// errors or a test failed, [`Ending::Cancelled`] if the user interrupted a program.
///
/// # Errors
/// A message if a file or folder can't be read, a folder holds no program, a file lies outside of the project's root,
/// or the page that [`Task::Show`] opens can't be opened.
pub(super) fn run(files: &[PathBuf], task: Task, globals: &Globals) -> Result<Ending, CallError> {
    run_all(files, &task, globals, None)
}

/// Runs programs as [`run`] does, and records the files that they depend on in `watched`. The evaluation of a program
/// ends early, as if it was interrupted, once one of these files has changed.
///
/// # Errors
/// As for [`run`].
pub(super) fn run_watched(
    files: &[PathBuf],
    task: &Task,
    globals: &Globals,
    watched: &Arc<Watched>,
) -> Result<Ending, CallError> {
    run_all(files, task, globals, Some(watched))
}

/// Runs programs one after the other, as [`run`] says.
///
/// # Errors
/// As for [`run`].
fn run_all(
    files: &[PathBuf],
    task: &Task,
    globals: &Globals,
    watched: Option<&Arc<Watched>>,
) -> Result<Ending, CallError> {
    let files = match task {
        Task::Check | Task::Test(_) => folders::programs(files)?,
        Task::Run | Task::Show { .. } | Task::Collect => {
            files.iter().map(|file| Found { file: file.clone(), folder: None }).collect()
        }
    };
    let open = |found: &Found| {
        // Of a folder, all of it is the project.
        let root = globals.root.as_deref().or(found.folder.as_deref());
        let mut project = Project::open(&found.file, root, globals.stdlib.as_deref())?;
        project.watched = watched.cloned();
        Ok(project)
    };
    // All files are opened first, so that a wrong call does nothing.
    let projects = files.iter().map(open).collect::<Result<Vec<Project>, CallError>>()?;
    listen_for_cancel();
    let mut tally = Tally::default();
    let mut terminal = Terminal::new(globals);
    terminal.watched = watched.cloned();
    for (Found { file, .. }, project) in files.iter().zip(&projects) {
        if files.len() > 1 && matches!(task, Task::Test(_)) && !globals.json {
            print(&format!("{}:\n", file.display()));
        }
        one(file, project, task, &mut terminal, &mut tally, globals);
    }
    tally.report.printed = terminal.printed.take().filter(|_| !matches!(task, Task::Check));
    if tally.report.printed.is_some() {
        tally.report.values = Some(std::mem::take(&mut terminal.values));
    }
    if matches!(task, Task::Test(_)) && !globals.json {
        let programs = match files.len() {
            1 => String::new(),
            many => format!(" in {many} programs"),
        };
        print(&format!("{} passed, {} failed{programs}\n", tally.passed, tally.failed));
    }
    let ok = tally.report.errors == 0 && tally.failed == 0 && !tally.cancelled;
    if files.iter().any(|found| found.folder.is_some()) && matches!(task, Task::Check) {
        tally.report.programs = Some(files.len());
    }
    if matches!(task, Task::Show { open: true })
        && let Some(page) = tally.report.written.iter().flatten().rev().find(|path| path.ends_with(".html"))
    {
        show::open_page(page)?;
    }
    tally.report.finish(ok, globals);
    Ok(match (ok, tally.cancelled) {
        (_, true) => Ending::Cancelled,
        (true, _) => Ending::Fine,
        (false, _) => Ending::Wrong,
    })
}

/// Runs a program and returns the plans that it emits, good or not, each with its path; no file is written. Its
/// diagnostics and what it prints are added to the report.
///
/// # Errors
/// A message if the file can't be read, or lies outside of the project's root.
fn plans(file: &Path, report: &mut Report, globals: &Globals) -> Result<Vec<(String, Plan)>, CallError> {
    let project = Project::open(file, globals.root.as_deref(), globals.stdlib.as_deref())?;
    listen_for_cancel();
    let mut terminal = Terminal::new(globals);
    let mut tally = Tally { report: std::mem::take(report), ..Tally::default() };
    let plans = one(file, &project, &Task::Collect, &mut terminal, &mut tally, globals);
    *report = tally.report;
    report.printed = terminal.printed.take();
    if report.printed.is_some() {
        report.values = Some(std::mem::take(&mut terminal.values));
    }
    Ok(plans)
}

/// Does the same with each plan that a program emits, or with each of some plan files, as [`judge::each_plan`] does.
/// `(command, takes)`: the command and what it does with files, for the message of a wrong call.
///
/// # Errors
/// A message if a file can't be read or is too large, or a program emits no plan or stands among other files.
pub(super) fn each_plan(
    files: &[PathBuf],
    (command, takes): (&str, &str),
    mut report: Report,
    globals: &Globals,
    mut work: impl FnMut(&str, &Plan, &mut Report) -> Result<bool, PlanFileFault>,
) -> Result<Ending, CallError> {
    let is_program =
        |file: &PathBuf| file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mod"));
    match files {
        [file] if is_program(file) => {
            let plans = plans(file, &mut report, globals)?;
            let mut ok = report.errors == 0;
            if ok && plans.is_empty() && !cancelled() {
                return Err(CallError(format!(
                    "`{}` emits no plan: add `emit(BEHAVIOR, \"NAME.plan.json\")` for each that `modl {command}` {takes}",
                    file.display()
                )));
            }
            for (name, plan) in plans {
                let found = work(&name, &plan, &mut report);
                ok &= judge::noted(found, &mut report, globals);
                if cancelled() {
                    break;
                }
            }
            report.finish(ok && !cancelled(), globals);
            Ok(match (cancelled(), ok) {
                (true, _) => Ending::Cancelled,
                (false, true) => Ending::Fine,
                (false, false) => Ending::Wrong,
            })
        }
        _ if files.iter().any(is_program) => {
            Err(CallError(format!("`modl {command}` {takes} one program, or plan files")))
        }
        _ => judge::each_plan(files, report, globals, work),
    }
}

/// Checks one program, does the task with it, and prints or records its diagnostics, tests and files. Returns the plans
/// that it emits, where they are collected.
fn one(
    file: &Path,
    project: &Project,
    task: &Task,
    terminal: &mut Terminal,
    tally: &mut Tally,
    globals: &Globals,
) -> Vec<(String, Plan)> {
    let checked = check::check(project, &project.name);
    let mut diagnostics = checked.diagnostics.clone();
    let mut outcome = Outcome::default();
    // The sound parts of a wrong program are checked further, but nothing of it is run.
    if matches!(task, Task::Check) || !diagnostics.iter().any(Diagnostic::is_error) {
        outcome = crate::execute::run(
            &checked,
            mode(task),
            project as &dyn Files,
            terminal,
            &options(project, task, globals),
        );
        diagnostics.append(&mut outcome.diagnostics);
    }
    terminal.clear_progress();
    let style = report::style(globals, &project.folder);
    for test in &outcome.tests {
        show_test(file, test, tally, globals);
    }
    tally.report.add(&checked.sources, &diagnostics, &style, globals);
    if let Task::Test(filter) = task
        && !checked.has_errors()
        && !outcome.cancelled
    {
        for example in examples::run(project, filter.as_deref(), terminal, &options(project, task, globals)) {
            tally.cancelled |= example.cancelled;
            show_test(file, &TestResult { name: example.name, passed: example.passed }, tally, globals);
            tally.report.add(&example.checked.sources, &example.diagnostics, &style, globals);
        }
    }
    show_written(outcome.written, tally, task, globals);
    if outcome.cancelled {
        tally.cancelled = true;
        if !terminal.watched.as_ref().is_some_and(|watched| watched.stale()) {
            print_error("interrupted\n");
        }
    }
    outcome.plans
}

/// Prints the result of a test.
fn show_test(file: &Path, test: &TestResult, tally: &mut Tally, globals: &Globals) {
    if test.passed {
        tally.passed += 1
    } else {
        tally.failed += 1
    }
    if !globals.json {
        print(&format!("test \"{}\" ... {}\n", test.name, if test.passed { "ok" } else { "FAILED" }));
    }
    let file = file.to_string_lossy().into_owned();
    let json = JsonTest { file, name: test.name.clone(), passed: test.passed };
    tally.report.tests.get_or_insert_default().push(json);
}

/// Prints the paths of written files.
fn show_written(written: Vec<String>, tally: &mut Tally, task: &Task, globals: &Globals) {
    if !globals.json {
        written.iter().for_each(|path| print_error(&format!("wrote {path}\n")));
    }
    if matches!(task, Task::Run | Task::Show { .. }) {
        tally.report.written.get_or_insert_default().extend(written);
    }
}

/// Returns the interpreter's mode for a task.
fn mode(task: &Task) -> Mode {
    match task {
        Task::Run | Task::Show { .. } | Task::Collect => Mode::Run,
        Task::Check => Mode::Check,
        Task::Test(_) => Mode::Test,
    }
}

/// Returns the interpreter's options.
fn options(project: &Project, task: &Task, globals: &Globals) -> Options {
    let filter = if let Task::Test(filter) = task { filter.clone() } else { None };
    let seed = if globals.seed == 0 { String::new() } else { format!(" --seed {}", globals.seed) };
    let name = if project.name == STDIN_NAME { "-" } else { &project.name };
    let pages = matches!(task, Task::Show { .. });
    let collects = matches!(task, Task::Collect);
    let verb = if pages { "show" } else { "run" };
    let command = format!("modl {verb} {name}{seed}");
    let limits = limits(globals);
    let (seed, values, threads) = (globals.seed, globals.json, threads(globals));
    let verified_pages = None;
    Options {
        filter,
        seed,
        pages,
        verified_pages,
        collects,
        command,
        picture: None,
        limits,
        values,
        constants: false,
        threads,
    }
}

/// Returns the number of threads for planners: that of the command line, or one per processor.
pub(super) fn threads(globals: &Globals) -> usize {
    let processors = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    globals.threads.map_or_else(processors, |n| usize::try_from(n).unwrap_or(1))
}

/// Returns the limits of evaluation: those of the command line where it states one, else the defaults.
pub(super) fn limits(globals: &Globals) -> Limits {
    let defaults = Limits::default();
    let or = |value: Option<u64>, default: usize| {
        value.map_or(default, |n| usize::try_from(n).unwrap_or(usize::MAX))
    };
    Limits {
        steps: globals.max_steps.unwrap_or(defaults.steps),
        modules: or(globals.max_modules, defaults.modules),
        samples: or(globals.max_samples, defaults.samples),
        ..defaults
    }
}
