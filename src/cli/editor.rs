//! The line editor of a session: entries over several lines, completion, colours, hints, history.

use super::CallError;
use crate::session::complete::{self, Knowledge};
use crate::session::entry::{is_given_up, is_incomplete};
use crate::session::highlight::{Class, Piece, pieces};
use rustyline::completion::{Completer, Pair};
use rustyline::error::ReadlineError;
use rustyline::highlight::{CmdKind, Highlighter};
use rustyline::hint::{Hint, Hinter};
use rustyline::history::FileHistory;
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{CompletionType, Config, Context, Editor, Helper};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::time::Duration;

/// The time limit of completion, up to which an answer feels immediate; without a result in time there are no
/// candidates. The aim is half of it, so that a busy machine keeps the limit.
const COMPLETION_TIMEOUT: Duration = Duration::from_millis(100);

/// The most entries in the history.
const HISTORY_MAX: usize = 10_000;

/// The longest text that is coloured and hinted at, in bytes: both read and draw all of it again at each key.
const COLOURED_MAX: usize = 2000;

/// The prompt of the first line of an entry.
const PROMPT: &str = "modl> ";

/// The prompt on a new line of an entry that is not complete yet, until something is typed there.
const MORE: &str = "...";

/// The result of reading one entry from the terminal.
pub(super) enum Typed {
    /// The text of an entry: complete, or submitted incomplete by an empty line.
    Entry(String),
    /// Ctrl-C: the text typed so far is discarded.
    Nothing,
    /// Bytes that are not UTF-8 text: what was typed so far is discarded.
    NoText,
    /// Ctrl-D, or the terminal is gone.
    End,
}

/// The line editor of a session, with its history.
pub(super) struct Lines {
    editor: Editor<CompletionHelper, FileHistory>,
    history: Option<PathBuf>,
}

impl Lines {
    /// Returns a line editor with the history of earlier sessions; `color`: true for syntax highlighting.
    ///
    /// # Errors
    /// A message if the terminal can't be used.
    pub(super) fn new(color: bool) -> Result<Lines, CallError> {
        let config = Config::builder()
            .max_history_size(HISTORY_MAX)
            .and_then(|config| config.history_ignore_dups(true))
            .map_err(|e| CallError(format!("the terminal can't be used: {e}")))?
            .completion_type(CompletionType::List)
            .completion_show_all_if_ambiguous(true)
            .auto_add_history(false)
            .build();
        let mut editor =
            Editor::with_config(config).map_err(|e| CallError(format!("the terminal can't be used: {e}")))?;
        editor.set_helper(Some(CompletionHelper { knowledge: None, color }));
        let history = history_file();
        if let Some(file) = &history {
            // A missing or unreadable history is an empty one.
            drop(editor.load_history(file));
        }
        Ok(Lines { editor, history })
    }

    /// Reads an entry from the terminal; `knowledge` is the data of the session for completion.
    ///
    /// # Errors
    /// A message if the terminal can't be read.
    pub(super) fn read(&mut self, knowledge: Knowledge) -> Result<Typed, CallError> {
        if let Some(assistant) = self.editor.helper_mut() {
            assistant.knowledge = Some(knowledge);
        }
        match self.editor.readline(PROMPT) {
            Ok(entry) => {
                self.remember(&entry);
                Ok(Typed::Entry(entry))
            }
            Err(ReadlineError::Interrupted) => Ok(Typed::Nothing),
            Err(ReadlineError::Eof) => Ok(Typed::End),
            Err(ReadlineError::Io(e)) if e.kind() == std::io::ErrorKind::InvalidData => Ok(Typed::NoText),
            Err(e) => Err(CallError(format!("the terminal can't be read: {e}"))),
        }
    }

    /// Adds an entry to the history. It is saved at once, since a session may end at any time.
    fn remember(&mut self, entry: &str) {
        if entry.trim().is_empty() {
            return;
        }
        drop(self.editor.add_history_entry(entry.trim_end()));
        if let Some(file) = &self.history {
            let folder = file.parent().map(std::fs::create_dir_all);
            if folder.is_some_and(|made| made.is_ok()) {
                drop(self.editor.append_history(file));
            }
        }
    }
}

/// Returns the file of the history: `MODL_HISTORY`, or a file in the user's state folder; `None` if no folder
/// is known.
fn history_file() -> Option<PathBuf> {
    let folder = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    folder("MODL_HISTORY")
        .or_else(|| Some(folder("XDG_STATE_HOME")?.join("modl/history")))
        .or_else(|| Some(folder("HOME")?.join(".local/state/modl/history")))
        .or_else(|| Some(folder("LOCALAPPDATA")?.join("modl/history")))
}

/// The most candidates that are listed with their whole descriptions.
const DESCRIBED_MAX: usize = 12;
/// The characters of each description in a longer list.
const ABOUT_MAX: usize = 36;

/// Returns a description, shortened if there are many candidates.
fn shortened(about: &str, many: bool) -> Cow<'_, str> {
    match about.char_indices().nth(ABOUT_MAX) {
        Some((end, _)) if many => Cow::Owned(format!("{}...", &about[..end])),
        _ => Cow::Borrowed(about),
    }
}

/// Completion, hints, highlighting and validation for the line editor.
struct CompletionHelper {
    knowledge: Option<Knowledge>,
    color: bool,
}

impl Helper for CompletionHelper {}

impl Completer for CompletionHelper {
    type Candidate = Pair;

    fn complete(&self, line: &str, at: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Pair>)> {
        let Some(knowledge) = self.knowledge.clone() else { return Ok((at, Vec::new())) };
        let (sender, receiver) = channel();
        let text = line.to_owned();
        // After a timeout the receiver is dropped; the thread ends by itself. Without a thread nothing is offered.
        let work = move || drop(sender.send(complete::complete(&knowledge, &text, at)));
        drop(std::thread::Builder::new().spawn(work));
        let Ok(found) = receiver.recv_timeout(COMPLETION_TIMEOUT) else { return Ok((at, Vec::new())) };
        // Many candidates are listed in columns; a single one has the line for itself.
        let many = found.candidates.len() > DESCRIBED_MAX;
        let pair = |named: crate::session::complete::Named| Pair {
            display: if named.about.is_empty() {
                named.name.clone()
            } else {
                format!("{}  {}", named.name.trim_end(), shortened(&named.about, many))
            },
            replacement: named.name,
        };
        Ok((found.start, found.candidates.into_iter().map(pair).collect()))
    }
}

/// A dimmed text after what is typed.
struct Dimmed {
    text: String,
    /// True if the right arrow key takes it over.
    completes: bool,
}

impl Hint for Dimmed {
    fn display(&self) -> &str {
        &self.text
    }

    fn completion(&self) -> Option<&str> {
        self.completes.then_some(&self.text)
    }
}

impl Hinter for CompletionHelper {
    type Hint = Dimmed;

    fn hint(&self, line: &str, at: usize, _: &Context<'_>) -> Option<Dimmed> {
        if at == line.len() && at <= COLOURED_MAX && line.ends_with('\n') && is_incomplete(line) {
            return Some(Dimmed { text: MORE.to_owned(), completes: false });
        }
        let knowledge = self.knowledge.as_ref().filter(|_| at == line.len() && at <= COLOURED_MAX)?;
        complete::hint(knowledge, line).map(|text| Dimmed { text, completes: true })
    }
}

impl Highlighter for CompletionHelper {
    fn highlight<'l>(&self, line: &'l str, _: usize) -> Cow<'l, str> {
        if !self.color || line.len() > COLOURED_MAX {
            return Cow::Borrowed(line);
        }
        let mut out = String::new();
        let mut at = 0;
        for (range, piece) in pieces(line) {
            out.push_str(&line[at..range.start]);
            out.push_str(&format!("\x1b[{}m{}\x1b[0m", colour(piece), &line[range.clone()]));
            at = range.end;
        }
        out.push_str(&line[at..]);
        Cow::Owned(out)
    }

    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.color { Cow::Owned(format!("\x1b[2m{hint}\x1b[0m")) } else { Cow::Borrowed(hint) }
    }

    fn highlight_prompt<'b, 's: 'b, 'p: 'b>(&'s self, prompt: &'p str, _: bool) -> Cow<'b, str> {
        if self.color { Cow::Owned(format!("\x1b[1m{prompt}\x1b[0m")) } else { Cow::Borrowed(prompt) }
    }

    fn highlight_char(&self, line: &str, _: usize, kind: CmdKind) -> bool {
        self.color && line.len() <= COLOURED_MAX && kind != CmdKind::MoveCursor
    }
}

/// Returns the escape sequence parameters of a kind of text.
fn colour(piece: Piece) -> &'static str {
    match piece {
        Piece::Command => "34",
        Piece::Program(Class::Keyword) => "35",
        Piece::Program(Class::Type) => "36",
        Piece::Program(Class::Number) => "33",
        Piece::Program(Class::Text) => "32",
        Piece::Program(Class::Comment) => "2",
    }
}

impl Validator for CompletionHelper {
    fn validate(&self, context: &mut ValidationContext) -> rustyline::Result<ValidationResult> {
        let text = context.input();
        let command = text.trim_start().starts_with([':', '?']);
        let incomplete = !command && is_incomplete(text) && !is_given_up(text);
        Ok(if incomplete { ValidationResult::Incomplete } else { ValidationResult::Valid(None) })
    }
}
