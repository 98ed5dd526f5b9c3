//! The evaluator of a session: what was computed for one entry is there for the next.
//!
//! Values are immutable and shared, so the memory of a session is copied before every entry, at the
//! cost of a few pointers: an entry that fails, or is taken back, leaves the copy.

use super::capability::Capabilities;
use super::evaluator_thread::{EvaluatorThread, HostProxy};
use super::frame::Frame;
use super::host::{Host, Mode, Options};
use super::interpreter::{Interpreter, Memory};
use super::recalled::Recalled;
use super::routines::Routines;
use super::stop::Eval;
use super::value::{Lazy, Value};
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind, Expr, Stmt, StmtKind, Test};
use crate::interrupt::{self, CancelState, Ended};
use crate::source::{Diagnostic, FileId, Files, Span, code};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// The greatest number of entries that can be taken back.
pub const UNDO_MAX: usize = 200;

/// The evaluator of a session, on a thread of its own: it keeps the values of earlier entries, and does one task
/// after another on them.
pub struct Evaluator(EvaluatorThread<Task, Answer>);

/// A task for the evaluator of a session: the work, with the program that it is about.
pub struct Task {
    /// The checked program of the whole session.
    pub checked: Arc<Checked>,
    /// The options of the run: limits, seed and threads.
    pub options: Options,
    /// The work that is to be done.
    pub work: Work,
}

/// The kind of a task: evaluate a new entry, take the last one back, reload changed texts, or forget all values.
pub enum Work {
    /// Evaluation of the newest entry.
    Enter(Entered),
    /// Undoing of the last entry that was kept; without one, all values are forgotten.
    Undo,
    /// Reloading after texts changed: declarations are elaborated with their defaults, and values that do not hold
    /// any more are forgotten. Earlier entries can't be taken back.
    Reload {
        /// The declarations to elaborate with their defaults, by identity.
        check: Vec<DefId>,
        /// The declarations whose values do not hold any more, by identity; they are forgotten.
        stale: Vec<DefId>,
    },
    /// Forgetting of all values; earlier entries can't be taken back.
    Forget,
}

/// An entry of a session that was checked and is to be evaluated, with the declarations that it makes stale.
pub struct Entered {
    /// The file of the entry; its declarations, statements and tests are evaluated in the order of the text.
    pub file: FileId,
    /// The declarations of other files to elaborate first, with their defaults, by identity.
    pub check: Vec<DefId>,
    /// The declarations whose values do not hold any more, by identity; they are forgotten.
    pub stale: Vec<DefId>,
    /// True if the declarations of the entry stay. Otherwise all is as if the entry had never been.
    pub keep: bool,
    /// The part of the result that is printed.
    pub shown: Shown,
}

/// The part of an entry's result that is printed besides what it prints itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Nothing is printed besides what the entry prints itself.
    Nothing,
    /// The values of expressions are printed.
    Values,
    /// The values are printed with their types, and what declarations declare.
    All,
    /// Nothing is printed; the answer lists the configurations that embed in the robot that an expression gives.
    Capabilities,
}

/// The result of a [`Task`]: what it found and wrote, and whether it changed the memory.
#[derive(Default)]
pub struct Answer {
    /// The diagnostics, in the order in which they were found.
    pub diagnostics: Vec<Diagnostic>,
    /// The paths written, as the host showed them.
    pub written: Vec<String>,
    /// The configurations that embed in the robot that the entry gives; `None` if they were not asked for
    /// ([`Shown::Capabilities`]), or the entry gives no robot.
    pub capabilities: Option<Capabilities>,
    /// True if the task found no error. If not, the memory is as it was before, but that an abandoned task may still
    /// change it ([`Evaluator::wait_for_abandoned`]).
    pub ok: bool,
    /// True if the user cancelled or abandoned the task.
    pub interrupted: bool,
    /// True if the evaluator itself panicked; a session survives this.
    pub defect: bool,
    /// True if an entry or a reload changed the memory.
    pub kept: bool,
}

impl Evaluator {
    /// Starts an evaluator on a thread of its own. `routines`: the functions of the higher-level modules;
    /// `cancel_state`: the token by which the user cancels its tasks.
    ///
    /// # Errors
    /// The operating system's message if the thread can't be started.
    pub fn new(routines: &'static Routines, cancel_state: CancelState) -> Result<Evaluator, String> {
        let thread = EvaluatorThread::new(cancel_state, move |proxy| {
            let (mut memory, mut before) = (Memory::default(), Vec::new());
            move |task| work(routines, &task, &proxy, &mut memory, &mut before)
        });
        thread.map(Evaluator)
    }

    /// Runs a task and returns its result. An abandoned task counts as interrupted. `files` and `host` serve the
    /// requests of the task. Panics if an abandoned task has not been waited for
    /// ([`wait_for_abandoned`](Self::wait_for_abandoned)).
    pub fn run(&self, task: Task, files: &dyn Files, host: &mut dyn Host) -> Answer {
        self.0.run(task, files, host).unwrap_or(Answer { interrupted: true, ..Answer::default() })
    }

    /// Returns true while a task is being done that nobody waits for any more.
    pub fn is_abandoned(&self) -> bool {
        self.0.is_abandoned()
    }

    /// Waits for an abandoned task; returns true if the task went well after all and changed the memory. `None` if
    /// the user abandons the wait, too. There must be such a task ([`is_abandoned`](Self::is_abandoned)): otherwise
    /// the wait does not end by itself.
    pub fn wait_for_abandoned(&self) -> Option<bool> {
        self.0.wait_for_abandoned().map(|answer| answer.kept)
    }
}

/// Does a task on the evaluator's thread. `memory`: the values so far; `before`: their copies from before each
/// entry that was kept, the last last.
fn work(
    routines: &Routines,
    task: &Task,
    proxy: &HostProxy,
    memory: &mut Memory,
    before: &mut Vec<Memory>,
) -> Answer {
    match &task.work {
        Work::Enter(entered) => {
            let enter = |interpreter: &mut Interpreter| {
                interpreter.check_all(&entered.check)?;
                interpreter.enter(entered)
            };
            let (mut answer, after) = evaluate(routines, task, &entered.stale, proxy, memory, enter);
            if let Some(after) = after.filter(|_| answer.ok && entered.keep) {
                answer.kept = true;
                before.push(std::mem::replace(memory, after));
                let too_many = before.len().saturating_sub(UNDO_MAX);
                before.drain(..too_many);
            }
            answer
        }
        Work::Reload { check, stale } => {
            let again = |interpreter: &mut Interpreter| interpreter.check_all(check);
            let (mut answer, after) = evaluate(routines, task, stale, proxy, memory, again);
            if let Some(after) = after.filter(|_| answer.ok) {
                answer.kept = true;
                (*memory, *before) = (after, Vec::new());
            }
            answer
        }
        Work::Undo => {
            *memory = before.pop().unwrap_or_default();
            Answer { ok: true, ..Answer::default() }
        }
        Work::Forget => {
            (*memory, *before) = (Memory::default(), Vec::new());
            Answer { ok: true, ..Answer::default() }
        }
    }
}

/// Does `work` with a copy of the memory, of which stale values are dropped. Returns the answer, and the memory
/// after it; `None` if anything failed.
fn evaluate(
    routines: &Routines,
    task: &Task,
    stale: &[DefId],
    proxy: &HostProxy,
    memory: &Memory,
    work: impl FnOnce(&mut Interpreter) -> Eval<()>,
) -> (Answer, Option<Memory>) {
    let mut interpreter = Interpreter::new(routines, &task.checked, Mode::Run, &task.options, proxy.clone());
    interpreter.resume(memory.clone(), stale);
    let caught = catch_unwind(AssertUnwindSafe(|| {
        interrupt::catch(&proxy.cancel_state, proxy.progress_sink(), || work(&mut interpreter))
    }));
    let defect = caught.is_err();
    let ended = caught.unwrap_or(Err(Ended::Cancelled));
    let cancelled = ended.as_ref().is_err_and(|why| *why == Ended::Cancelled);
    let interrupted = !defect && (cancelled || proxy.cancel_state.is_cancelled());
    let finished = ended.as_ref().is_ok_and(Result::is_ok);
    if !defect {
        interpreter.report_end(ended);
        // Values of earlier entries may be unknown, and those entries said why.
        if let Some(span) = interpreter.lost_value() {
            interpreter.check_known(&Value::Unknown, span);
        }
    }
    let ok = !interrupted && finished && interpreter.reported.errors == 0;
    if !ok {
        interpreter.forget_failed();
    }
    let answer = Answer {
        diagnostics: std::mem::take(&mut interpreter.reported.reports),
        written: std::mem::take(&mut interpreter.reported.written),
        capabilities: interpreter.reported.capabilities.take(),
        ok,
        interrupted,
        defect,
        kept: false,
    };
    (answer, ok.then_some(interpreter.memory))
}

/// A piece of an entry, in the order of the text.
enum Piece<'p> {
    /// A declaration.
    Declaration(DefId),
    /// A statement.
    Statement(&'p Stmt),
    /// A test.
    Test(&'p Test),
}

impl<'a> Interpreter<'a> {
    /// Takes over the memory of earlier entries, without the values of the stale declarations. If all are
    /// stale, kept plans, causes and exemptions are dropped, too.
    fn resume(&mut self, memory: Memory, stale: &[DefId]) {
        let count = self.shared.program.defs.len();
        self.memory = memory;
        self.memory.resize(count);
        if !stale.is_empty() {
            self.memory.recalled = Recalled::default();
        }
        if stale.len() == count {
            let Memory { plans, causes, exemptions, .. } = &mut self.memory;
            (*plans, *causes, *exemptions) = Default::default();
        }
        for def in stale.iter().map(|def| def.0 as usize) {
            self.memory.globals[def] = Lazy::Waiting;
            self.memory.designs[def].clear();
            self.memory.connectors[def] = None;
        }
    }

    /// Forgets members of instances that stay, which failed or were not done when the entry ended: they are
    /// computed again when they are needed.
    fn forget_failed(&mut self) {
        for (instance, key) in self.computed.drain(..) {
            let mut lazy = instance.lazy.borrow_mut();
            if !matches!(lazy.get(&key), Some(Lazy::Done(value)) if !value.is_unknown()) {
                lazy.remove(&key);
            }
        }
    }

    fn check_all(&mut self, defs: &[DefId]) -> Eval<()> {
        defs.iter().try_for_each(|def| self.check_declaration(*def))
    }

    /// Evaluates an entry piece by piece, up to the first that fails.
    fn enter(&mut self, entered: &Entered) -> Eval<()> {
        let program = self.shared.program;
        let mut frame = Frame::new(program.statements.frame, None);
        for piece in self.pieces(entered.file) {
            match piece {
                Piece::Declaration(def) => self.enter_declaration(def, entered.shown)?,
                Piece::Statement(Stmt { kind: StmtKind::Expr(expr), .. }) => {
                    let value = self.eval(expr, &mut frame)?;
                    self.tell_value(&value, expr, entered.shown)?;
                }
                Piece::Statement(statement) => self.execute(statement, &mut frame)?,
                Piece::Test(test) => {
                    self.execute_body(&test.body)?;
                    if self.reported.errors == 0 && entered.shown == Shown::All {
                        self.shared.host.print(format!("test \"{}\" ... ok", test.name));
                    }
                }
            }
            if self.reported.errors > 0 {
                break;
            }
        }
        Ok(())
    }

    fn pieces(&self, file: FileId) -> Vec<Piece<'a>> {
        let program = self.shared.program;
        let own = program.own.iter().filter(|def| program.def(**def).file == file);
        let declared = own.map(|def| (program.def(*def).span.start, Piece::Declaration(*def)));
        let statements = program.statements.statements.iter().map(|s| (s.span.start, Piece::Statement(s)));
        let tests = program.tests.iter().map(|test| (test.span.start, Piece::Test(test)));
        let mut pieces: Vec<(u32, Piece)> = declared.chain(statements).chain(tests).collect();
        pieces.sort_by_key(|(start, _)| *start);
        pieces.into_iter().map(|(_, piece)| piece).collect()
    }

    /// Evaluates a declaration: the value of a `let`, otherwise an elaboration with defaults; prints it as
    /// `shown` says.
    fn enter_declaration(&mut self, def: DefId, shown: Shown) -> Eval<()> {
        let program = self.shared.program;
        let declared = program.def(def);
        let DefKind::Let(binding) = &declared.kind else {
            self.check_declaration(def)?;
            if self.reported.errors == 0 && shown == Shown::All {
                let line = (self.shared.routines.describe_declaration)(self, def)?;
                self.shared.host.print(line);
            }
            return Ok(());
        };
        let value = self.global(def, declared.span);
        let value = self.recover(value)?;
        // The value of an expression is kept under a name that nobody gave it.
        if declared.span == binding.value.span {
            return self.tell_value(&value, &binding.value, shown);
        }
        self.check_known(&value, declared.span);
        if self.reported.errors == 0 && shown == Shown::All {
            self.shared.host.print(format!("{}: {}", declared.name, program.type_name(&binding.ty)));
        }
        Ok(())
    }

    fn tell_value(&mut self, value: &Value, expr: &Expr, shown: Shown) -> Eval<()> {
        self.check_known(value, expr.span);
        if self.reported.errors == 0 && shown == Shown::Capabilities {
            return self.tell_capabilities(value, expr);
        }
        if self.reported.errors > 0 || shown == Shown::Nothing || matches!(value, Value::Nothing) {
            return Ok(());
        }
        let display = self.display(value)?;
        self.print_value(value, &display);
        // An instance is called by its type.
        let shown = match shown {
            Shown::All if !matches!(value, Value::Instance(_)) => match display.split_once('\n') {
                None => format!("{display}: {}", self.shared.program.type_name(&expr.ty)),
                Some((head, rest)) => format!("{head}: {}\n{rest}", self.shared.program.type_name(&expr.ty)),
            },
            _ => display,
        };
        self.shared.host.print(shown);
        Ok(())
    }

    /// Reports what the standard library can do with a robot; refuses a value that is none.
    fn tell_capabilities(&mut self, value: &Value, expr: &Expr) -> Eval<()> {
        if let Value::Instance(robot) = value
            && (robot.design.module().is_some() || robot.design.config().is_some())
        {
            self.reported.capabilities = (self.shared.routines.capabilities)(self, robot, expr.span)?;
            return Ok(());
        }
        let ty = self.shared.program.type_name(&expr.ty);
        let diagnostic = Diagnostic::error(code::TYPE_MISMATCH, "a robot of modules is wanted")
            .label(expr.span, format!("this is {ty}"))
            .hint("name a configuration or a module, or write an expression that gives one");
        self.add_report(diagnostic);
        Ok(())
    }

    /// Refuses an unknown value: its failure was reported when it failed, perhaps in an entry before.
    fn check_known(&mut self, value: &Value, span: Span) {
        if value.is_unknown() && self.reported.errors == 0 {
            let message = "this has no value, because of a mistake that was shown before";
            self.add_report(Diagnostic::error(code::BAD_VALUE, message).label(span, "unknown"));
        }
    }
}
