//! The evaluator of a session: what was computed for one entry is there for the next.
//!
//! Values are immutable and shared, so the memory of a session is copied before every entry, at the
//! cost of a few pointers: an entry that fails, or is taken back, leaves the copy.

use super::causes::Causes;
use super::design::{ConnectorDesign, Design};
use super::eval::Frame;
use super::host::{Host, Mode, Options};
use super::interpreter::Interpreter;
use super::plan_value::PlanValue;
use super::routines::Routines;
use super::stage::{Stage, Standing};
use super::stop::Eval;
use super::value::{Lazy, Value};
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind, Expr, Stmt, StmtKind, Test};
use crate::interrupt::{self, CancelState};
use crate::planners::tosnake::SearchCache;
use crate::source::{Diagnostic, FileId, Files, Span, code};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::Arc;

/// Entries that can be taken back.
pub const UNDO_MAX: usize = 200;

/// Evaluates entries one after the other, each with what those before it left.
pub struct Evaluator(Standing<Task, Answer>);

/// What to do next.
pub struct Task {
    pub checked: Arc<Checked>,
    pub options: Options,
    pub work: Work,
}

pub enum Work {
    /// Evaluate the newest entry.
    Enter(Entered),
    /// Take back the last entry that was kept.
    Undo,
    /// Texts changed: elaborate declarations with their defaults, and forget values that do not hold any
    /// more. Entries before can't be taken back.
    Reload { check: Vec<DefId>, stale: Vec<DefId> },
    /// Forget all values; entries can't be taken back any more.
    Forget,
}

pub struct Entered {
    pub file: FileId,
    /// Declarations of other files to elaborate first.
    pub check: Vec<DefId>,
    /// Declarations whose values do not hold any more.
    pub stale: Vec<DefId>,
    /// Whether what is declared stays. Otherwise all is as if the entry had never been.
    pub keep: bool,
    pub tell: Tell,
}

/// What is printed of an entry besides what it prints itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tell {
    Nothing,
    /// Values of expressions.
    Values,
    /// Values, with their types, and what declarations declare.
    All,
}

#[derive(Default)]
pub struct Answer {
    pub diagnostics: Vec<Diagnostic>,
    /// Paths written, as the host showed them.
    pub written: Vec<String>,
    /// Whether all went well. If not, the memory is as it was before.
    pub ok: bool,
    pub interrupted: bool,
    /// Whether the evaluator itself broke down, which a person's session outlives.
    pub defect: bool,
    /// Whether the memory is another now, so that there is something to take back.
    pub kept: bool,
}

impl Evaluator {
    /// Starts an evaluator on a thread of its own.
    pub fn new(routines: &'static Routines, cancel_state: CancelState) -> Evaluator {
        Evaluator(Standing::new(cancel_state, move |stage| {
            let (mut memory, mut before) = (Memory::default(), Vec::new());
            move |task| work(routines, &task, &stage, &mut memory, &mut before)
        }))
    }

    /// The task before is settled. An interrupted one is waited for no longer than whoever wished its
    /// end does.
    pub fn run(&self, task: Task, files: &dyn Files, host: &mut dyn Host) -> Answer {
        self.0.run(task, files, host).unwrap_or(Answer { interrupted: true, ..Answer::default() })
    }

    /// Whether a task is still being done that nobody waits for any more.
    pub fn is_left(&self) -> bool {
        self.0.is_left()
    }

    /// Waits for a task that was left; says whether it went well after all and changed the memory. `None`:
    /// nobody is to wait any longer.
    pub fn settle(&self) -> Option<bool> {
        self.0.settle().map(|answer| answer.kept)
    }
}

/// What a session keeps: values by declaration, and what they refer to.
#[derive(Clone, Default)]
struct Memory {
    globals: Vec<Lazy>,
    designs: Vec<Vec<Rc<Design>>>,
    connectors: Vec<Option<Option<Rc<ConnectorDesign>>>>,
    plans: Vec<Rc<PlanValue>>,
    search_cache: SearchCache,
    causes: Causes,
    exemptions: BTreeMap<Span, bool>,
}

fn work(
    routines: &Routines,
    task: &Task,
    stage: &Stage,
    memory: &mut Memory,
    before: &mut Vec<Memory>,
) -> Answer {
    match &task.work {
        Work::Enter(entered) => {
            let enter = |interpreter: &mut Interpreter| {
                interpreter.check_all(&entered.check)?;
                interpreter.enter(entered)
            };
            let (mut answer, after) = evaluate(routines, task, &entered.stale, stage, memory, enter);
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
            let (mut answer, after) = evaluate(routines, task, stale, stage, memory, again);
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

fn evaluate(
    routines: &Routines,
    task: &Task,
    stale: &[DefId],
    stage: &Stage,
    memory: &Memory,
    work: impl FnOnce(&mut Interpreter) -> Eval<()>,
) -> (Answer, Option<Memory>) {
    let mut interpreter = Interpreter::new(routines, &task.checked, Mode::Run, &task.options, stage.clone());
    interpreter.resume(memory.clone(), stale);
    let caught = catch_unwind(AssertUnwindSafe(|| {
        interrupt::catch(&stage.cancel_state, stage.progress_sink(), || work(&mut interpreter))
    }));
    let defect = caught.is_err();
    let ended = caught.ok().flatten();
    let interrupted = !defect && (ended.is_none() || stage.cancel_state.is_cancelled());
    let ok = !interrupted && ended.is_some_and(|ended| ended.is_ok()) && interpreter.errors == 0;
    if !ok {
        interpreter.forget_failed();
    }
    let answer = Answer {
        diagnostics: std::mem::take(&mut interpreter.reports),
        written: std::mem::take(&mut interpreter.written),
        ok,
        interrupted,
        defect,
        kept: false,
    };
    (answer, ok.then(|| interpreter.memory()))
}

/// A piece of an entry, in the order of the text.
enum Piece<'p> {
    Declaration(DefId),
    Statement(&'p Stmt),
    Test(&'p Test),
}

impl<'a> Interpreter<'a> {
    fn resume(&mut self, memory: Memory, stale: &[DefId]) {
        let count = self.program.defs.len();
        (self.globals, self.designs, self.connectors) = (memory.globals, memory.designs, memory.connectors);
        (self.plans, self.causes, self.exemptions) = (memory.plans, memory.causes, memory.exemptions);
        self.search_cache = memory.search_cache;
        self.globals.resize(count, Lazy::Waiting);
        self.designs.resize(count, Vec::new());
        self.connectors.resize(count, None);
        if stale.len() == count {
            (self.plans, self.causes, self.exemptions) = Default::default();
        }
        for def in stale.iter().map(|def| def.0 as usize) {
            self.globals[def] = Lazy::Waiting;
            self.designs[def].clear();
            self.connectors[def] = None;
        }
    }

    fn memory(self) -> Memory {
        Memory {
            globals: self.globals,
            designs: self.designs,
            connectors: self.connectors,
            plans: self.plans,
            search_cache: self.search_cache,
            causes: self.causes,
            exemptions: self.exemptions,
        }
    }

    /// Members of instances that live on, which failed or were not done when the entry ended: they
    /// are computed anew when they are needed again.
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
        let program = self.program;
        let mut frame = Frame::new(program.statements.frame, None);
        for piece in self.pieces(entered.file) {
            match piece {
                Piece::Declaration(def) => self.enter_declaration(def, entered.tell)?,
                Piece::Statement(Stmt { kind: StmtKind::Expr(expr), .. }) => {
                    let value = self.eval(expr, &mut frame)?;
                    self.tell_value(&value, expr, entered.tell)?;
                }
                Piece::Statement(statement) => self.execute(statement, &mut frame)?,
                Piece::Test(test) => {
                    self.execute_body(&test.body)?;
                    if self.errors == 0 && entered.tell == Tell::All {
                        self.stage.print(format!("test \"{}\" ... ok", test.name));
                    }
                }
            }
            if self.errors > 0 {
                break;
            }
        }
        Ok(())
    }

    fn pieces(&self, file: FileId) -> Vec<Piece<'a>> {
        let program = self.program;
        let own = program.own.iter().filter(|def| program.def(**def).file == file);
        let declared = own.map(|def| (program.def(*def).span.start, Piece::Declaration(*def)));
        let statements = program.statements.statements.iter().map(|s| (s.span.start, Piece::Statement(s)));
        let tests = program.tests.iter().map(|test| (test.span.start, Piece::Test(test)));
        let mut pieces: Vec<(u32, Piece)> = declared.chain(statements).chain(tests).collect();
        pieces.sort_by_key(|(start, _)| *start);
        pieces.into_iter().map(|(_, piece)| piece).collect()
    }

    fn enter_declaration(&mut self, def: DefId, tell: Tell) -> Eval<()> {
        let program = self.program;
        let declared = program.def(def);
        let DefKind::Let(binding) = &declared.kind else {
            self.check_declaration(def)?;
            if self.errors == 0 && tell == Tell::All {
                let line = (self.routines.describe_declaration)(self, def)?;
                self.stage.print(line);
            }
            return Ok(());
        };
        let value = self.global(def, declared.span);
        let value = self.settle(value)?;
        // The value of an expression is kept under a name that nobody gave it.
        if declared.span == binding.value.span {
            return self.tell_value(&value, &binding.value, tell);
        }
        self.check_known(&value, declared.span);
        if self.errors == 0 && tell == Tell::All {
            self.stage.print(format!("{}: {}", declared.name, program.type_name(&binding.ty)));
        }
        Ok(())
    }

    fn tell_value(&mut self, value: &Value, expr: &Expr, tell: Tell) -> Eval<()> {
        self.check_known(value, expr.span);
        if self.errors > 0 || tell == Tell::Nothing || matches!(value, Value::Nothing) {
            return Ok(());
        }
        let display = self.display(value)?;
        // An instance is called by its type.
        let shown = match tell {
            Tell::All if !matches!(value, Value::Instance(_)) => match display.split_once('\n') {
                None => format!("{display}: {}", self.program.type_name(&expr.ty)),
                Some((head, rest)) => format!("{head}: {}\n{rest}", self.program.type_name(&expr.ty)),
            },
            _ => display,
        };
        self.stage.print(shown);
        Ok(())
    }

    /// What failed was said when it failed, and that may have been in an entry before.
    fn check_known(&mut self, value: &Value, span: Span) {
        if value.is_unknown() && self.errors == 0 {
            let message = "this has no value, because of a mistake that was shown before";
            self.add_report(Diagnostic::error(code::BAD_VALUE, message).label(span, "unknown"));
        }
    }
}
