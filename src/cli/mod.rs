//! The command line interface: commands, files on disk, the terminal.
//!
//! The only room with access to the outside. The other rooms have it through two traits:
//! [`Files`](crate::source::Files), implemented by `disk`, and [`Host`](crate::interpret::Host), by
//! `terminal`.

mod arguments;
mod choices;
mod disk;
mod doc;
mod editor;
mod examples;
mod explain;
mod export;
mod fmt;
mod folders;
mod import;
mod judge;
mod live;
mod lsp;
mod manifest;
mod memory;
mod new;
mod output;
mod plan;
mod program;
mod repl;
mod report;
mod show;
mod simulate;
mod study;
mod terminal;
mod verdict;
mod watch;
mod watched;
mod what;

use crate::document::Manual;
use crate::source::suggest::suggest;
use arguments::{Arguments, Command};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};
use std::io::Write;
use std::process::ExitCode;

/// The outcome of a command, which gives the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    /// Everything is fine.
    Fine,
    /// The program, the plan or the file is found wrong.
    Wrong,
    /// The user cancelled it.
    Cancelled,
}

/// A wrong call, with the message for the user.
#[derive(Debug)]
struct CallError(String);

/// Parses the command line, runs the command, and returns the exit code: 0 if all is fine, 1 if the program,
/// plan or file is found wrong, 2 if the call is wrong, standard output can't be written or the system gives no memory
/// for the thread, 130 after Ctrl-C. SIGTERM is not caught: the system ends the process, which a shell tells as 143.
///
/// The command has a thread of its own, because the stack of the first one may be small. Panics if the command does (a
/// defect). `manual`: the manual that sites of documentation hold.
pub fn main(manual: &'static Manual) -> ExitCode {
    let thread = std::thread::Builder::new().name("command".into()).stack_size(STACK_BYTES);
    let command = thread.spawn(|| command(manual));
    match command.map(std::thread::JoinHandle::join) {
        Ok(Ok(code)) => code,
        Ok(Err(panic)) => std::panic::resume_unwind(panic),
        Err(e) => {
            let why = disk::system_words(&e);
            terminal::print_error(&format!("modl: the system gives no memory for the command: {why}\n"));
            ExitCode::from(2)
        }
    }
}

/// The stack of the command, which reads and checks programs: they nest, up to a limit. Pages that are never
/// touched cost nothing.
const STACK_BYTES: usize = 32 << 20;

/// Returns the message for a command that does not exist.
fn unknown_command(told: &clap::Error) -> String {
    let Some(ContextValue::String(word)) = told.get(ContextKind::InvalidSubcommand) else {
        return "there is no such command; `modl --help` lists them".to_owned();
    };
    let commands = Arguments::command();
    let names: Vec<&str> = commands.get_subcommands().map(clap::Command::get_name).collect();
    let what = if word.ends_with(".mod") {
        format!("`modl run {word}` runs a program")
    } else {
        match suggest(word, names) {
            Some(near) => format!("did you mean `modl {near}`?"),
            None => "`modl --help` lists the commands".to_owned(),
        }
    };
    format!("there is no command `{word}`; {what}")
}

/// Returns the message for a command line that can't be read, without the usage that follows it on a terminal.
fn wrong_call(told: &clap::Error) -> String {
    if told.kind() == ErrorKind::InvalidSubcommand {
        return unknown_command(told);
    }
    let text = told.render().to_string();
    let message = text.strip_prefix("error: ").unwrap_or(&text);
    message.split("\n\nUsage:").next().unwrap_or(message).trim().to_owned()
}

/// Returns true if the command line has `--json` among its options, whether or not it can be read.
fn json_is_asked() -> bool {
    std::env::args_os().skip(1).take_while(|word| word != "--").any(|word| word == "--json")
}

/// Carries out the command line.
fn command(manual: &Manual) -> ExitCode {
    let code = match Arguments::try_parse() {
        Ok(arguments) => carry_out(&arguments, manual),
        Err(told) if told.use_stderr() && json_is_asked() => {
            report::json_call_error(&wrong_call(&told));
            2
        }
        Err(told) if told.kind() == ErrorKind::InvalidSubcommand => {
            terminal::print_error(&format!("modl: {}\n", unknown_command(&told)));
            2
        }
        // Help and version come this way, too.
        Err(told) => {
            terminal::note_output(told.print().and_then(|()| std::io::stdout().flush()));
            u8::try_from(told.exit_code()).unwrap_or(2)
        }
    };
    match terminal::output_failure() {
        Some(why) => {
            terminal::print_error(&format!("modl: standard output can't be written: {why}\n"));
            ExitCode::from(2)
        }
        None => ExitCode::from(code),
    }
}

/// Runs the command and reports a wrong call, and a command that takes more memory than the limit; returns the exit
/// code.
fn carry_out(arguments: &Arguments, manual: &Manual) -> u8 {
    memory::limit(&arguments.globals);
    let ended = memory::within_limit(&arguments.globals, || run(arguments, manual));
    match ended {
        Ok(Ending::Fine) => 0,
        Ok(Ending::Wrong) => 1,
        Ok(Ending::Cancelled) => 130,
        Err(CallError(message)) => {
            report::call_error(&arguments.globals, &message);
            2
        }
    }
}

/// Runs the command.
///
/// # Errors
/// The message for the user, if the call is wrong.
fn run(arguments: &Arguments, manual: &Manual) -> Result<Ending, CallError> {
    let globals = &arguments.globals;
    let Some(command) = &arguments.command else {
        if arguments.expressions.is_empty() {
            return Err(CallError("what is to be done? `modl --help` lists the commands".to_owned()));
        }
        return repl::expressions(&arguments.expressions, globals);
    };
    if !arguments.expressions.is_empty() {
        return Err(CallError("`-e` stands alone, without a command".to_owned()));
    }
    if globals.json
        && let Some(why) = no_json(command)
    {
        return Err(CallError(why.to_owned()));
    }
    match command {
        Command::Run { file } => program::run(std::slice::from_ref(file), program::Task::Run, globals),
        Command::Check { files } => program::run(files, program::Task::Check, globals),
        Command::Test { files, filter } => program::run(files, program::Task::Test(filter.clone()), globals),
        Command::Watch { files, page: true, port, open, .. } => live::run(files, *port, *open, globals),
        Command::Watch { files, run, test, .. } => {
            let task = match (run, test) {
                (true, _) => program::Task::Run,
                (_, true) => program::Task::Test(None),
                _ => program::Task::Check,
            };
            watch::run(files, &task, globals)
        }
        Command::Verify { files } => judge::run(files, globals),
        Command::Simulate(arguments) => simulate::run(arguments, globals),
        Command::Study(arguments) => study::run(arguments, globals),
        Command::Export { files, to } => export::run(files, to, globals),
        Command::Import { files } => import::run(files, globals),
        Command::Plan { file, series, rate, npy, map } => {
            let wanted = series.as_deref().map(|series| plan::Wanted { series, rate: *rate, npy: *npy });
            plan::run(file, wanted, map.as_deref(), globals)
        }
        Command::Show { file, open } => show::run(file, *open, globals),
        Command::What { file, robot } => repl::what(file, robot, globals),
        Command::Doc { folder, only, open } => doc::run(folder, (!only).then_some(manual), *open, globals),
        Command::Repl { file, .. } => repl::run(file.as_deref(), globals),
        Command::Fmt { files, check } => fmt::run(files, *check, globals),
        Command::Lsp { .. } => lsp::run(globals),
        Command::New { name } => new::run(name, globals),
        Command::Explain { code } => explain::run(code.as_deref(), globals),
        Command::Completions { shell, .. } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "modl", &mut script);
            terminal::print_exact(&String::from_utf8_lossy(&script));
            Ok(Ending::Fine)
        }
    }
}

/// Returns the reason why a command has no answer in JSON; `None` if it has one.
fn no_json(command: &Command) -> Option<&'static str> {
    match command {
        Command::Repl { .. } => Some(
            "a session has no `--json`: `modl -e EXPR --json` answers one question, and `modl run --json FILE` \
             runs a program",
        ),
        Command::Lsp { .. } => Some("`lsp` has no `--json`: it speaks the protocol of editors"),
        Command::Watch { page: true, .. } => Some("`watch --page` has no `--json`: it serves a page"),
        Command::Completions { .. } => {
            Some("`completions` has no `--json`: it prints a script for the shell")
        }
        _ => None,
    }
}
