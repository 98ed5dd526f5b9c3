//! `modl repl`, `modl -e` and `modl what`: a session with a terminal, a pipe, or expressions on the command line.

use super::arguments::Globals;
use super::disk::{self, FILE_BYTES_MAX, Project};
use super::editor::{Lines, Typed};
use super::report::{self, Report};
use super::terminal::{
    Terminal, begin_work, idle, listen_for_cancel, listen_for_interrupt, print, print_error, print_styled,
    settled,
};
use super::{CallError, Ending, output, program, show, what};
use crate::check::Checked;
use crate::interpret::session::Shown;
use crate::interpret::{Options, WriteError};
use crate::session::command::{self, Command};
use crate::session::entry::{goes_on, is_incomplete};
use crate::session::{ChangeKind, Input, Reloaded, Reply, Session};
use crate::source::Diagnostic;
use crate::source::render::{Style, render_one, sorted};
use std::io::{self, IsTerminal};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// The name of the page that `:view` writes.
const VIEW_PAGE: &str = "view.html";

/// The decision after an entry: continue or quit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    GoOn,
    Quit,
}

/// Returns the error of a system that gives no memory for a session.
fn no_memory(why: &str) -> CallError {
    CallError(format!("the system gives no memory for a session: {why}"))
}

/// A session with its terminal.
struct Repl<'g> {
    session: Session,
    terminal: Terminal,
    style: Style,
    globals: &'g Globals,
    /// The JSON object that `-e` answers with.
    report: Report,
    /// True if anything was wrong so far.
    wrong: bool,
    interrupted: bool,
}

/// Runs the command `modl repl`, a session on the terminal, in the project of `file` or of the working folder. Without
/// a terminal it evaluates standard input.
///
/// # Errors
/// A message if the project, the file, the terminal or standard input can't be read, or the evaluator thread can't be
/// started.
pub(super) fn run(file: Option<&Path>, globals: &Globals) -> Result<Ending, CallError> {
    let stdlib = globals.stdlib.as_deref();
    let (project, load) = match file {
        Some(file) => {
            let project = Project::open(file, globals.root.as_deref(), stdlib)?;
            let name = project.name.clone();
            // The file may change during the session.
            (project.unread(), Some(name))
        }
        None => (Project::of_folder(globals.root.as_deref(), stdlib)?, None),
    };
    let mut repl = Repl::new(project, globals)?;
    if io::stdin().is_terminal() {
        listen_for_interrupt();
        print(&format!("modl {}; `:help` tells what there is\n", env!("CARGO_PKG_VERSION")));
        if let Some(name) = &load {
            repl.load(name);
        }
        repl.interact()
    } else {
        listen_for_cancel();
        if let Some(name) = &load {
            repl.load(name);
        }
        let bytes = disk::read(Path::new("-"), FILE_BYTES_MAX)?;
        let text =
            String::from_utf8(bytes).map_err(|_| CallError("standard input is not UTF-8 text".into()))?;
        repl.read_through(&text);
        Ok(repl.ending())
    }
}

/// Runs `modl -e`: evaluates texts one after the other, up to the first that fails.
///
/// # Errors
/// A message if the project can't be read, or the evaluator thread can't be started.
pub(super) fn expressions(texts: &[String], globals: &Globals) -> Result<Ending, CallError> {
    let project = Project::of_folder(globals.root.as_deref(), globals.stdlib.as_deref())?;
    listen_for_cancel();
    let mut repl = Repl::new(project, globals)?;
    for text in texts {
        let input = Input { text, name: "<-e>", first_line: 1, shown: Shown::Values, keep: true };
        repl.enter(&input);
        if repl.wrong {
            break;
        }
    }
    let ending = repl.ending();
    if globals.json {
        repl.report.printed = repl.terminal.printed.take();
        repl.report.values = Some(std::mem::take(&mut repl.terminal.values));
        repl.report.finish(ending == Ending::Fine, globals);
    }
    Ok(ending)
}

/// Runs the command `modl what`, which tells what the standard library can do with a robot: `robot` is an expression over
/// what `file` declares.
///
/// # Errors
/// A message if the project or the file can't be read, or the evaluator thread can't be started.
pub(super) fn what(file: &Path, robot: &str, globals: &Globals) -> Result<Ending, CallError> {
    let project = Project::open(file, globals.root.as_deref(), globals.stdlib.as_deref())?;
    let name = project.name.clone();
    listen_for_cancel();
    let mut repl = Repl::new(project, globals)?;
    let mut loaded = repl.cancellable(|session, terminal| session.load(&name, terminal));
    loaded.notes.clear();
    if repl.print_reply(&loaded) {
        repl.what(robot);
    }
    let ending = repl.ending();
    repl.report.printed = None;
    repl.report.written = None;
    repl.report.finish(ending == Ending::Fine, globals);
    Ok(ending)
}

impl<'g> Repl<'g> {
    /// Returns a session without entries.
    ///
    /// # Errors
    /// A message if there is no memory for it.
    fn new(project: Project, globals: &'g Globals) -> Result<Repl<'g>, CallError> {
        let terminal = Terminal::new(globals);
        let style = report::style(globals, &project.folder);
        let seed = if globals.seed == 0 { String::new() } else { format!(" --seed {}", globals.seed) };
        let options = Options {
            seed: globals.seed,
            values: globals.json,
            command: format!("modl repl{seed}"),
            limits: program::limits(globals),
            threads: program::threads(globals),
            ..Options::default()
        };
        let session = Session::new(Arc::new(project), options, &terminal).map_err(|e| no_memory(&e))?;
        let mut report = Report::default();
        report.written = Some(Vec::new());
        Ok(Repl { session, terminal, style, globals, report, wrong: false, interrupted: false })
    }

    /// Returns the outcome of the session.
    fn ending(&self) -> Ending {
        match (self.interrupted, self.wrong) {
            (true, _) => Ending::Cancelled,
            (_, true) => Ending::Wrong,
            _ => Ending::Fine,
        }
    }

    /// Reads and evaluates entries until the user leaves.
    ///
    /// # Errors
    /// A message if the terminal can't be read.
    fn interact(&mut self) -> Result<Ending, CallError> {
        let mut lines = Lines::new(self.style.color)?;
        let mut typed = 0;
        loop {
            let knowledge = self.session.knowledge();
            match idle(|| lines.read(knowledge))? {
                Typed::End => return Ok(Ending::Fine),
                Typed::Nothing => {}
                Typed::NoText => print_error("this is not UTF-8 text, and was discarded\n"),
                Typed::Entry(text) => {
                    self.style.width = report::style(self.globals, "").width;
                    if self.act(&text, typed + 1) == Next::Quit {
                        return Ok(Ending::Fine);
                    }
                    typed += text.lines().count();
                }
            }
        }
    }

    /// Evaluates a text entry by entry.
    fn read_through(&mut self, text: &str) {
        let mut lines = text.lines().enumerate().peekable();
        while let Some((number, line)) = lines.next() {
            let mut entry = line.to_owned();
            let command = entry.trim_start().starts_with([':', '?']);
            while let Some((_, next)) = lines.peek().filter(|_| !command) {
                let blank = next.trim().is_empty();
                if !is_incomplete(&entry) && (blank || !goes_on(next)) {
                    break;
                }
                entry.push('\n');
                entry.push_str(next);
                lines.next();
            }
            if self.act(&entry, number + 1) == Next::Quit || self.interrupted {
                return;
            }
        }
    }

    /// Evaluates an entry or executes a command. `first_line` is the line of the whole input at which it
    /// begins, for diagnostics.
    fn act(&mut self, text: &str, first_line: usize) -> Next {
        if let Some((word, command)) = command::parse_word(text)
            && !self.session.declares(word)
        {
            return self.execute(command);
        }
        match command::parse(text) {
            Some(Ok(command)) => return self.execute(command),
            Some(Err(why)) => self.print_failure(&why),
            None if text.trim().is_empty() => {}
            None if let Some(call) = self.session.call_of(text) => print(&call),
            None => {
                let text = text.trim_end();
                self.enter(&Input { text, name: "<stdin>", first_line, shown: Shown::All, keep: true });
            }
        }
        Next::GoOn
    }

    /// Prints an error message.
    fn print_failure(&mut self, why: &str) {
        self.wrong = true;
        print_error(&format!("{why}\n"));
    }

    /// Runs work that Ctrl-C cancels, once abandoned work has ended or been left.
    fn cancellable<T>(&mut self, work: impl FnOnce(&mut Session, &mut Terminal) -> T) -> T {
        if self.session.is_abandoned() && !settled(|| self.session.wait_for_abandoned()) {
            if let Err(e) = self.session.renew(&self.terminal) {
                // The work that does not end keeps the old evaluator, and there is no other.
                report::call_error(self.globals, &no_memory(&e).0);
                std::process::exit(2);
            }
            print("what was interrupted does not end; values are worked out again when they are needed\n");
        }
        begin_work();
        work(&mut self.session, &mut self.terminal)
    }

    /// Evaluates an entry and prints the outcome; returns true if it was accepted.
    fn enter(&mut self, input: &Input) -> bool {
        let reply = self.cancellable(|session, terminal| session.enter(input, terminal));
        self.print_reply(&reply)
    }

    /// Evaluates the text of a command, and keeps nothing of it; returns true if that went well.
    fn ask(&mut self, text: &str, shown: Shown) -> bool {
        self.enter(&Input { text, name: "<command>", first_line: 1, shown, keep: false })
    }

    fn load(&mut self, path: &str) {
        let reply = self.cancellable(|session, terminal| session.load(path, terminal));
        self.print_reply(&reply);
    }

    /// Prints an outcome; returns true if the entry was accepted.
    fn print_reply(&mut self, reply: &Reply) -> bool {
        self.terminal.clear_progress();
        self.wrong |= !reply.ok;
        if self.globals.json {
            self.report_reply(reply);
            return reply.ok;
        }
        self.show(&reply.checked, &reply.diagnostics);
        reply.notes.iter().for_each(|note| print(&format!("{note}\n")));
        if !reply.broken.is_empty() {
            print("what was declared before does not fit any more:\n");
            self.show(&reply.checked, &reply.broken);
        }
        reply.written.iter().for_each(|path| print_error(&format!("wrote {path}\n")));
        if reply.interrupted {
            print_error("interrupted\n");
            self.interrupted |= !io::stdin().is_terminal();
        }
        reply.ok
    }

    /// Adds an outcome to the JSON object; notes count as printed lines.
    fn report_reply(&mut self, reply: &Reply) {
        for diagnostics in [&reply.diagnostics, &reply.broken] {
            self.report.add(&reply.checked.sources, diagnostics, &self.style, self.globals);
        }
        self.terminal.printed.get_or_insert_default().extend_from_slice(&reply.notes);
        self.report.written.get_or_insert_default().extend_from_slice(&reply.written);
        self.interrupted |= reply.interrupted;
    }

    /// Prints diagnostics.
    fn show(&self, checked: &Checked, diagnostics: &[Diagnostic]) {
        for diagnostic in sorted(diagnostics).into_iter().take(self.style.shown_max) {
            print_styled(&format!("{}\n", render_one(&checked.sources, diagnostic, &self.style)));
        }
    }

    /// Executes a command.
    fn execute(&mut self, command: Command) -> Next {
        match command {
            Command::Quit => return Next::Quit,
            Command::Help => print(&command::help()),
            Command::Type(text) => match self.session.type_of(&text) {
                Ok(ty) => print(&format!("{ty}\n")),
                Err((checked, wrong)) => {
                    self.show(&checked, &wrong);
                    self.wrong = true;
                }
            },
            Command::Doc(name) => self.answer(self.session.doc(&name)),
            Command::Source(name) => self.answer(self.session.source(&name)),
            Command::Ports(text) => {
                self.ask(&format!("for p in ports({text}) {{ print(p) }}"), Shown::Nothing);
            }
            Command::Verify(text) => {
                self.ask(&format!("print(verify({text}))"), Shown::Nothing);
            }
            Command::What(text) => self.what(&text),
            Command::View(text) => self.view(&text),
            Command::Time(text) => {
                let begin = Instant::now();
                self.enter(&Input {
                    text: &text,
                    name: "<command>",
                    first_line: 1,
                    shown: Shown::All,
                    keep: true,
                });
                print(&format!("{:.1} ms\n", begin.elapsed().as_secs_f64() * 1e3));
            }
            Command::Vars => {
                let vars = self.session.vars();
                let wide = vars.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
                vars.iter().for_each(|(name, about)| print(&format!("{name:<wide$}  {about}\n")));
            }
            Command::Load(path) => self.load(&path),
            Command::Reload => self.reload(),
            Command::Save(path) => self.save(&path),
            Command::Undo => match self.cancellable(|session, terminal| session.undo(terminal)) {
                Some(text) => print(&format!("took back: {}\n", text.lines().next().unwrap_or(""))),
                None => self.print_failure("there is nothing to take back"),
            },
            Command::Reset => self.cancellable(|session, terminal| session.reset(terminal)),
        }
        Next::GoOn
    }

    /// Prints a description or an error message.
    fn answer(&mut self, found: Result<String, String>) {
        match found {
            Ok(text) => print(&text),
            Err(why) => self.print_failure(&why),
        }
    }

    /// Tells what the library can do with the robot that an expression gives.
    fn what(&mut self, text: &str) {
        let (reply, repertoire) = self.cancellable(|session, terminal| session.repertoire(text, terminal));
        if self.print_reply(&reply)
            && let Some(repertoire) = repertoire
        {
            what::tell(repertoire, &mut self.report, self.globals);
        }
    }

    fn view(&mut self, text: &str) {
        if self.ask(&format!("show({text}, \"{VIEW_PAGE}\")"), Shown::Nothing) {
            let page = self.globals.out.join(VIEW_PAGE);
            if let Err(CallError(why)) = show::open_page(&page.to_string_lossy()) {
                print_error(&format!("{why}\n"));
            }
        }
    }

    fn reload(&mut self) {
        let Reloaded { reply, changes } = self.cancellable(|session, terminal| session.reload(terminal));
        if !self.print_reply(&reply) {
            return;
        }
        if changes.is_empty() {
            print("nothing changed\n");
        }
        for change in &changes {
            let what = match change.kind {
                ChangeKind::Added => "new",
                ChangeKind::Changed => "changed",
                ChangeKind::Removed => "gone",
            };
            let users = if change.users.is_empty() {
                String::new()
            } else {
                format!("; needed by {}", change.users.join(", "))
            };
            print(&format!("{}: {} is {what}{users}\n", change.file, change.name));
        }
    }

    fn save(&mut self, path: &str) {
        let text = self.session.program();
        // Entries read their files from the working folder, and so will the saved program.
        let written = output::write(Path::new("."), path, text.as_bytes());
        match written {
            Ok(_) => print(&format!("wrote {path}\n")),
            Err(WriteError::Outside) => self.print_failure(&format!("`{path}` leads out of this folder")),
            Err(WriteError::Failed(why)) => self.print_failure(&format!("`{path}` can't be written: {why}")),
        }
    }
}
