//! The state of a session, and its operations.

use super::changes::{Change, changes};
use super::dependencies::{Dependencies, meant};
use super::kept::{FileSnapshot, Project};
use super::reload::stale;
use crate::check::typed::{DefId, DefKind, Stmt, StmtKind};
use crate::check::{self, Checked, Entry, Type};
use crate::interpret::capability::Capabilities;
use crate::interpret::session::{Entered, Evaluator, Shown, Task, UNDO_MAX, Work};
use crate::interpret::{Host, Options};
use crate::source::{Diagnostic, FileId, Files, Symbol, code};
use crate::syntax;
use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A session: the entries so far, the program that they make, and the values of the program.
pub struct Session {
    /// The snapshot of the project's files.
    pub(super) files: Arc<FileSnapshot>,
    /// The accepted entries, oldest first.
    pub(super) entries: Vec<Entry>,
    /// The program that they make.
    pub(super) checked: Arc<Checked>,
    /// The declaration that `_` stands for; `None` while there is none.
    pub(super) last: Option<Symbol>,
    /// The paths in the project of the files that were loaded, or failed to load, in order of loading.
    pub(super) loaded: Vec<String>,
    evaluator: Evaluator,
    options: Options,
    /// The state before each entry that can be undone.
    before: Vec<Before>,
    /// The number of entries so far, failed ones included.
    count: usize,
    /// True if the evaluator holds the outcome of an abandoned entry that must be undone.
    to_take_back: Cell<bool>,
}

/// The state of a session before an entry.
struct Before {
    entries: usize,
    last: Option<Symbol>,
    loaded: Vec<String>,
}

/// A text to enter into a session, with how its result is shown and whether it is kept.
#[derive(Clone, Debug)]
pub struct Input<'t> {
    /// The text of the entry, a piece of a program; no command.
    pub text: &'t str,
    /// The name of the text in diagnostics.
    pub name: &'t str,
    /// The line, from 1, of a longer input at which the text begins; 1 if it is the whole input.
    pub first_line: usize,
    /// The part of the result that is printed.
    pub shown: Shown,
    /// True if the declarations and values of the entry are kept; otherwise the session is afterwards as it was.
    pub keep: bool,
}

/// The outcome of an entry: the program with it, whether it was accepted, and its diagnostics.
pub struct Reply {
    /// The program that was checked, the entry included, with the texts that the diagnostics refer to.
    pub checked: Arc<Checked>,
    /// The errors and warnings about the entry, in the order in which they were found.
    pub diagnostics: Vec<Diagnostic>,
    /// Further messages for the user, one line each.
    pub notes: Vec<String>,
    /// Errors in earlier entries caused by this one, which is accepted nevertheless.
    pub broken: Vec<Diagnostic>,
    /// The paths of the files that were written, as the host showed them.
    pub written: Vec<String>,
    /// The configurations that embed in the robot that the entry gives; `None` if they were not asked for, or the entry
    /// gives no robot.
    pub capabilities: Option<Capabilities>,
    /// True if the entry was evaluated without an error. If not, the session is as it was.
    pub ok: bool,
    /// True if the entry was cancelled.
    pub interrupted: bool,
}

/// The outcome of [`Session::reload`]: that of the evaluation, and the declarations that differ.
pub struct Reloaded {
    /// The outcome of evaluating the reloaded program, or of checking it if that failed.
    pub reply: Reply,
    /// The declarations that changed; also listed if evaluating them failed, and empty if checking them failed.
    pub changes: Vec<Change>,
}

impl Reply {
    /// Returns the outcome of an entry that was not accepted.
    fn refused(checked: Checked, diagnostics: Vec<Diagnostic>) -> Reply {
        Reply { ok: false, diagnostics, ..Reply::fine(Arc::new(checked)) }
    }

    /// Returns the outcome of an accepted entry without messages.
    fn fine(checked: Arc<Checked>) -> Reply {
        Reply {
            checked,
            diagnostics: Vec::new(),
            notes: Vec::new(),
            broken: Vec::new(),
            written: Vec::new(),
            capabilities: None,
            ok: true,
            interrupted: false,
        }
    }
}

impl Session {
    /// Returns an empty session in a project. Only the cancellation state of `host` is used. `options`: the limits,
    /// seed and threads of its runs.
    ///
    /// # Errors
    /// The system's words where it gives no memory for the evaluator's thread.
    pub fn new(project: Project, options: Options, host: &dyn Host) -> Result<Session, String> {
        let files = Arc::new(FileSnapshot::new(project));
        let checked = Arc::new(check::check_session(&*files, &[]));
        Ok(Session {
            files,
            entries: Vec::new(),
            checked,
            last: None,
            loaded: Vec::new(),
            evaluator: crate::execute::evaluator(host.cancel_state())?,
            options,
            before: Vec::new(),
            count: 0,
            to_take_back: Cell::new(false),
        })
    }

    /// Returns the checked program that all entries accepted so far make.
    pub fn checked(&self) -> &Checked {
        &self.checked
    }

    /// Returns true if work that the user abandoned is still running.
    pub fn is_abandoned(&self) -> bool {
        self.evaluator.is_abandoned()
    }

    /// Waits for abandoned work to end, and returns true if it has. Returns false if the wait is abandoned, too. There
    /// must be such work ([`is_abandoned`](Self::is_abandoned)): otherwise the wait does not end by itself. A change
    /// that the work still made is taken back before the next entry.
    pub fn wait_for_abandoned(&mut self) -> bool {
        let Some(kept) = self.evaluator.wait_for_abandoned() else { return false };
        // The work ended normally at the last moment, but was reported as cancelled.
        self.to_take_back.set(kept);
        true
    }

    /// Leaves work that does not end, and starts a new evaluator with the current cancellation state of
    /// `host`. All values are computed again when they are needed.
    ///
    /// # Errors
    /// The system's words where it gives no memory for the evaluator.
    pub fn renew(&mut self, host: &dyn Host) -> Result<(), String> {
        self.evaluator = crate::execute::evaluator(host.cancel_state())?;
        self.to_take_back.set(false);
        Ok(())
    }

    /// Checks and evaluates a text as the next entry. A new declaration replaces an earlier one of its name. If the
    /// entry fails, or `input` says not to keep it, the session is as it was. `host` gets what the entry prints and
    /// writes. Panics if abandoned work has not been waited for.
    pub fn enter(&mut self, input: &Input, host: &mut dyn Host) -> Reply {
        self.count += 1;
        let entry = Entry {
            name: input.name.to_owned(),
            text: input.text.to_owned(),
            first_line: input.first_line,
            value: None,
            last: self.last,
        };
        self.take(entry, input, host)
    }

    /// Checks an entry, and evaluates it if it has no errors. The value of its last expression is declared
    /// under a name, so that `_` can stand for it.
    fn take(&mut self, entry: Entry, input: &Input, host: &mut dyn Host) -> Reply {
        let mut entries = self.entries.clone();
        entries.push(entry);
        let mut checked = check::check_session(&*self.files, &entries);
        let file = self.newest(&checked);
        let own = self.about(&checked, file);
        if own.iter().any(Diagnostic::is_error) {
            return Reply::refused(checked, own);
        }
        let value = if input.keep { value_type(&checked, file) } else { None };
        if value.is_some() {
            let name = Symbol::new(&format!("_{}", self.count));
            entries.last_mut().expect("just pushed").value = Some(name);
            checked = check::check_session(&*self.files, &entries);
        }
        let named = entries.last().and_then(|entry| entry.value);
        let checked = Arc::new(checked);
        let (stale, notes) = self.redefined(&checked);
        let check = elaborated(&checked).filter(|def| checked.program.def(*def).file > file).collect();
        let work = Work::Enter(Entered { file, check, stale, keep: input.keep, shown: input.shown });
        let answer = self.run(&checked, work, host);
        let broken = if answer.ok { self.newly_wrong(&checked, file) } else { Vec::new() };
        let mut diagnostics = own;
        diagnostics.extend(answer.diagnostics);
        if answer.ok && input.keep {
            self.remember();
            (self.entries, self.checked) = (entries, checked.clone());
            self.last = named.or(self.last);
        }
        let notes = match (answer.ok, answer.defect) {
            (true, _) => notes,
            (_, true) => vec!["that is a defect of modl; the session goes on without the entry".to_owned()],
            _ => Vec::new(),
        };
        let (ok, interrupted, written) = (answer.ok, answer.interrupted, answer.written);
        let capabilities = answer.capabilities;
        Reply { checked, diagnostics, notes, broken, written, capabilities, ok, interrupted }
    }

    /// Runs work on the evaluator.
    fn run(
        &self,
        checked: &Arc<Checked>,
        work: Work,
        host: &mut dyn Host,
    ) -> crate::interpret::session::Answer {
        let task = |work| Task { checked: checked.clone(), options: self.options.clone(), work };
        if self.to_take_back.take() {
            self.evaluator.run(task(Work::Undo), &*self.files, host);
        }
        self.evaluator.run(task(work), &*self.files, host)
    }

    /// Saves the state for `undo`.
    fn remember(&mut self) {
        self.before.push(Before {
            entries: self.entries.len(),
            last: self.last,
            loaded: self.loaded.clone(),
        });
        let too_many = self.before.len().saturating_sub(UNDO_MAX);
        self.before.drain(..too_many);
    }

    /// Returns the file of the newest entry: files are numbered in the order in which they are read.
    fn newest(&self, checked: &Checked) -> FileId {
        let known = self.checked.sources.files().count();
        let (id, _) = checked.sources.files().nth(known).expect("an entry is a text of its own");
        id
    }

    /// Returns the diagnostics about the newest entry: in its own text, in files that it imports for the
    /// first time, and in what it needs.
    fn about(&self, checked: &Checked, file: FileId) -> Vec<Diagnostic> {
        let dependencies = Dependencies::of(checked);
        let needed = dependencies.needed_by(file);
        let concerns = |diagnostic: &&Diagnostic| match diagnostic.span() {
            None => true,
            Some(span) if span.file >= file => true,
            Some(span) => {
                diagnostic.is_error()
                    && dependencies.declaration_at(span).is_some_and(|id| needed.contains(&id))
            }
        };
        checked.diagnostics.iter().filter(concerns).cloned().collect()
    }

    /// Returns the new errors in earlier texts.
    fn newly_wrong(&self, checked: &Checked, file: FileId) -> Vec<Diagnostic> {
        let live: BTreeSet<DefId> = meant(checked).into_values().collect();
        let dependencies = Dependencies::of(checked);
        let concerns = |d: &&Diagnostic| {
            d.is_error()
                && d.span().is_some_and(|span| {
                    span.file < file && dependencies.declaration_at(span).is_some_and(|id| live.contains(&id))
                })
                && !self.checked.diagnostics.contains(d)
        };
        checked.diagnostics.iter().filter(concerns).cloned().collect()
    }

    /// Returns the declarations whose values are stale because a name stands for something else now, and
    /// messages about them.
    fn redefined(&self, checked: &Checked) -> (Vec<DefId>, Vec<String>) {
        let now = meant(checked);
        let changed = meant(&self.checked).into_iter().filter_map(|(name, old)| {
            let new = *now.get(&name)?;
            (new != old).then_some((name, old, new))
        });
        let changed: Vec<(Symbol, DefId, DefId)> = changed.collect();
        if changed.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let dependencies = Dependencies::of(checked);
        let mut stale = Vec::new();
        let mut notes = Vec::new();
        for (name, old, new) in changed {
            let users = dependencies.users_of(&[new]);
            let follow: Vec<String> = now
                .iter()
                .filter(|(user, id)| users.contains(id) && is_given(**user) && **id < new)
                .map(|(user, _)| format!("`{user}`"))
                .collect();
            if !follow.is_empty() {
                let (verb, them) =
                    if follow.len() == 1 { ("depends", "it is") } else { ("depend", "they are") };
                notes.push(format!(
                    "{} {verb} on `{name}`: {them} worked out again when needed",
                    follow.join(", ")
                ));
            }
            stale.push(old);
            stale.extend(users);
        }
        stale.sort_unstable();
        stale.dedup();
        (stale, notes)
    }

    /// Loads a file, by its path in the project: enters an import of all its public names. Returns an outcome like
    /// that of an entry; a file that can't be read or declares nothing is an error in it. The path is remembered in
    /// any case: [`reload`](Self::reload) tries it again. `host` gets what the evaluation prints and writes. Panics
    /// if abandoned work has not been waited for.
    pub fn load(&mut self, path: &str, host: &mut dyn Host) -> Reply {
        if !self.loaded.iter().any(|known| known == path) {
            self.loaded.push(path.to_owned());
        }
        self.count += 1;
        let entry = load_entry(&*self.files, path);
        let entry = match entry {
            Ok(entry) => entry,
            Err(message) => {
                let diagnostic = Diagnostic::error(code::CANNOT_READ, message);
                return Reply {
                    ok: false,
                    diagnostics: vec![diagnostic],
                    ..Reply::fine(self.checked.clone())
                };
            }
        };
        let input = Input { text: "", name: "", first_line: 1, shown: Shown::Nothing, keep: true };
        let mut reply = self.take(entry, &input, host);
        if reply.ok {
            let names = self.names_of(path);
            reply.notes.insert(0, format!("loaded {path}: {}", names.join(", ")));
        }
        reply
    }

    /// Returns the visible names that a file declares.
    fn names_of(&self, path: &str) -> Vec<String> {
        let here = |id: DefId| {
            let file = self.checked.sources.file(self.checked.program.def(id).file);
            !file.library && *file.name == *path
        };
        let visible = meant(&self.checked).into_iter().filter(|(_, id)| here(*id));
        visible.map(|(name, _)| name.to_string()).collect()
    }

    /// Reads all files again, evaluates what changed, and forgets the values that depend on it. If there are errors in
    /// them or in the evaluation, the session stays as it was. Once anything changed, earlier entries can't be undone.
    /// Panics if abandoned work has not been waited for.
    pub fn reload(&mut self, host: &mut dyn Host) -> Reloaded {
        let files = Arc::new(self.files.fresh());
        let mut entries = self.entries.clone();
        let mut missing = self.loaded.clone();
        for entry in &mut entries {
            if let Some(path) = loaded_path(entry) {
                missing.retain(|other| other != path);
                if let Ok(fresh) = load_entry(&*files, path) {
                    *entry = fresh;
                }
            }
        }
        entries.extend(missing.iter().filter_map(|path| load_entry(&*files, path).ok()));
        let checked = Arc::new(check::check_session(&*files, &entries));
        let errors: Vec<Diagnostic> = checked.diagnostics.iter().filter(|d| d.is_error()).cloned().collect();
        let nothing = Reloaded { reply: Reply::fine(checked.clone()), changes: Vec::new() };
        if !errors.is_empty() {
            return Reloaded { reply: Reply { ok: false, diagnostics: errors, ..nothing.reply }, ..nothing };
        }
        let changes = changes(&self.checked, &checked);
        if changes.is_empty() && entries.len() == self.entries.len() {
            return nothing;
        }
        let check: Vec<DefId> = elaborated(&checked).collect();
        // If no identity is preserved, everything is stale.
        let all = || checked.program.identified().map(|(id, _)| id).collect();
        let stale = stale(&self.checked, &checked).unwrap_or_else(all);
        let before = std::mem::replace(&mut self.files, files);
        let answer = self.run(&checked, Work::Reload { check, stale }, host);
        if answer.ok {
            (self.entries, self.checked, self.before) = (entries, checked.clone(), Vec::new());
        } else {
            self.files = before;
        }
        let reply = Reply {
            diagnostics: answer.diagnostics,
            ok: answer.ok,
            interrupted: answer.interrupted,
            ..nothing.reply
        };
        Reloaded { reply, changes }
    }

    /// Undoes the last entry that was kept, and returns its text; `None` if there is none to undo. At most
    /// [`UNDO_MAX`] entries can be undone. Panics if abandoned work has not been waited for.
    pub fn undo(&mut self, host: &mut dyn Host) -> Option<String> {
        let before = self.before.pop()?;
        let undone = self.entries.drain(before.entries..).next()?;
        (self.last, self.loaded) = (before.last, before.loaded);
        self.checked = Arc::new(check::check_session(&*self.files, &self.entries));
        self.run(&self.checked, Work::Undo, host);
        Some(undone.text)
    }

    /// Removes all entries and values; files are read again when they are needed. Panics if abandoned work has not been
    /// waited for.
    pub fn reset(&mut self, host: &mut dyn Host) {
        self.files = Arc::new(self.files.fresh());
        (self.entries, self.before, self.loaded) = (Vec::new(), Vec::new(), Vec::new());
        self.last = None;
        self.checked = Arc::new(check::check_session(&*self.files, &[]));
        self.run(&self.checked, Work::Forget, host);
    }
}

/// Returns true if a name was given by the user; values of expressions are stored under other names.
pub(super) fn is_given(name: Symbol) -> bool {
    let digits = name.as_str().strip_prefix('_').unwrap_or("x");
    digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit())
}

/// Returns the type of the expression that ends the newest entry, whose text is `file`; `None` if the entry does not
/// end with an expression, or that has no value.
pub(super) fn value_type(checked: &Checked, file: FileId) -> Option<Type> {
    let program = &checked.program;
    let value = program.statements.statements.last()?;
    let own = program.own.iter().map(|id| program.def(*id)).filter(|def| def.file == file);
    let declared = own.map(|def| def.whole.start).chain(program.tests.iter().map(|test| test.span.start));
    let is_last = declared.max().is_none_or(|start| start < value.span.start);
    is_last.then(|| type_of(value))?
}

/// Returns the type of a statement that is also an expression with a value; `None` for others.
fn type_of(statement: &Stmt) -> Option<Type> {
    match &statement.kind {
        StmtKind::Expr(value) => (!matches!(value.ty, Type::Nothing | Type::Error)).then(|| value.ty.clone()),
        StmtKind::If { then, otherwise, .. } => {
            let (then, otherwise) = (type_of(then.last()?)?, type_of(otherwise.last()?)?);
            // If the types differ, it is a statement, as in a file.
            (then == otherwise).then_some(then)
        }
        _ => None,
    }
}

/// The prefix of the names of entries that stand for loaded files.
const LOAD: &str = "<load ";

/// Returns the path of the file that an entry loads; `None` for an entry that was typed.
pub(super) fn loaded_path(entry: &Entry) -> Option<&str> {
    entry.name.strip_prefix(LOAD)?.strip_suffix('>')
}

/// Returns the entry that imports all public declarations of a file.
///
/// # Errors
/// A message if the file can't be read or declares nothing.
fn load_entry(files: &dyn Files, path: &str) -> Result<Entry, String> {
    let bytes = files.read(path).map_err(|error| check::why_unreadable(path, &error))?;
    let text = String::from_utf8_lossy(&bytes);
    let parsed = syntax::parse(FileId(0), &text);
    let names = parsed
        .file
        .items
        .iter()
        .filter_map(|item| item.kind.name())
        .map(|name| name.text)
        .filter(|name| !name.as_str().starts_with('_'));
    let names: Vec<&str> = names.map(|name| name.as_str()).collect();
    let text = if names.is_empty() && parsed.diagnostics.iter().any(Diagnostic::is_error) {
        // An import of an unknown name, so that the errors of the file are reported.
        format!("use \"{path}\".{{any}}")
    } else if names.is_empty() {
        return Err(format!("`{path}` declares nothing"));
    } else {
        format!("use \"{path}\".{{{}}}", names.join(", "))
    };
    Ok(Entry { name: format!("{LOAD}{path}>"), text, first_line: 1, value: None, last: None })
}

/// Returns the project's own visible declarations with instances.
fn elaborated(checked: &Checked) -> impl Iterator<Item = DefId> {
    let own: BTreeSet<DefId> = checked.program.own.iter().copied().collect();
    let live = meant(checked).into_values().filter(move |id| own.contains(id));
    live.filter(|id| !matches!(checked.program.def(*id).kind, DefKind::Let(_)))
}
