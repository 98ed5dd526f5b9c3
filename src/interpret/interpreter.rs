//! The state of a run: what has been computed, what was reported, and the position of evaluation.

use super::capability::Capabilities;
use super::causes::Causes;
use super::design::{ConnectorDesign, Design, Instance};
use super::evaluator_thread::{HostProxy, REST_BYTES};
use super::host::{Judgement, Limits, Mode, Options, TestResult};
use super::keyed::Keyed;
use super::memory_errors::memory_limit;
use super::plan_value::PlanValue;
use super::recalled::Recalled;
use super::routines::Routines;
use super::stop::{Eval, Stop};
use super::value::{Behavior, BehaviorCall, ContractUse, Lazy, Value};
use crate::check::Checked;
use crate::check::typed::{Def, DefId, DefKind, Program};
use crate::interrupt::{self, Ended, memory};
use crate::plan::Plan;
use crate::planners::tosnake::SearchCache;
use crate::source::{Code, Diagnostic, Severity, Sources, Span, Symbol, code};
use std::collections::{BTreeMap, HashSet};
use std::rc::Rc;

/// The greatest number of errors of one run, and of its other findings; more help nobody.
const REPORTS_MAX: usize = 200;
/// The hint where calls are nested too deeply, of which it is not known whether they would end.
const CALLS_HINT: &str = "a function that calls itself has to come to a case in which it does not; what goes on for \
    many steps is carried along by `reduce(list, f, from: ...)` or `iterate(f, from: ..., until: ...)`";
/// The least number of calls within each other that are worth a word where evaluation is nested too deeply.
const CALLS_MANY: usize = 100;
/// The greatest number of calls that a message shows.
const CALLS_SHOWN: usize = 4;

/// The state of a run: its inputs, its diagnostics, its memory, and the position of evaluation.
pub struct Interpreter<'a> {
    /// The inputs of the run, which never change.
    pub shared: Shared<'a>,
    /// The findings and outputs of the run so far.
    pub reported: Reported,
    /// The values of declarations that were computed, and what they refer to.
    pub memory: Memory,
    /// The members of instances that were computed in this run, each by its index among the members of the
    /// declaration, for a session that has to forget those that failed.
    pub computed: Vec<(Rc<Instance>, usize)>,
    /// The position of evaluation: its calls and bindings.
    pub stack: Stack,
}

/// The inputs of a run, which it does not change.
pub struct Shared<'a> {
    /// The functions of the higher-level modules.
    pub routines: &'a Routines,
    /// The checked program that is run.
    pub program: &'a Program,
    /// The texts of the program, by which spans are resolved.
    pub sources: &'a Sources,
    /// The options of the run, chosen by the user.
    pub options: &'a Options,
    /// The part of the program that is evaluated.
    pub mode: Mode,
    /// The access to files, terminal and output folder.
    pub host: HostProxy,
    /// The flag of each declaration, by its [`DefId`], that is true if `check` found mistakes in it. Values that
    /// depend on it are unknown.
    pub faulty: Vec<bool>,
}

/// The diagnostics, test results and outputs of a run so far.
#[derive(Default)]
pub struct Reported {
    /// The diagnostics: at most 200 errors and 200 others, one for each code and span; findings of the judge (E06xx)
    /// also one for each message.
    pub reports: Vec<Diagnostic>,
    /// The number of errors, those included that are not in `reports`.
    pub errors: usize,
    known: HashSet<(Code, Option<Span>, Option<String>)>,
    /// The paths written, as the host showed them.
    pub written: Vec<String>,
    /// The plans that were emitted, each with its path, where they are collected.
    pub plans: Vec<(String, Plan)>,
    /// The worst verdict of each call that asked for one, as (its least margin, itself).
    pub judgements: BTreeMap<Span, (f64, Judgement)>,
    /// The size of the values that were told besides their text, in bytes.
    pub values_bytes: usize,
    /// The configurations that embed in the robot that an entry of a session asks about; `None` without the question.
    pub capabilities: Option<Capabilities>,
    /// The results of the tests that were run, in order.
    pub tests: Vec<TestResult>,
    /// True if a condition of the present test is unknown because of an error reported before.
    pub unjudged: bool,
    /// The span of the first expression whose value was unknown; `None` if there was none.
    pub unknown_at: Option<Span>,
}

/// The values that were computed and stay: for the rest of the run, and in a session for the next entries.
#[derive(Clone, Default)]
pub struct Memory {
    /// The values of top-level lets, by the declaration's [`DefId`]; others stay [`Lazy::Waiting`].
    pub globals: Vec<Lazy>,
    /// The designs, by the declaration's [`DefId`] and the [`arguments_key`](super::value::arguments_key): one for each list
    /// of arguments.
    pub designs: Vec<Keyed<Design>>,
    /// The connectors, by the declaration's [`DefId`]; `None` for those not elaborated yet, `Some(None)` for those
    /// that are broken.
    pub connectors: Vec<Option<Option<Rc<ConnectorDesign>>>>,
    /// The behaviours that calls gave, by the call, so that the same call gives the same behaviour.
    pub recalled: Recalled<BehaviorCall, Rc<Behavior>>,
    /// The last plans of behaviours, at most 32.
    pub plans: Vec<Rc<PlanValue>>,
    /// The step sequences of the last searches of `tosnake`.
    pub search_cache: SearchCache,
    /// The causes of commands, with their source lines.
    pub causes: Causes,
    /// The contracts of behaviours, one for each time that a call stated one, by the numbers that behaviours have them by.
    pub contracts: Vec<Rc<ContractUse>>,
    /// The exemptions of the user's own files that were judged, each with true if any plan needed it.
    pub exemptions: BTreeMap<Span, bool>,
}

impl Memory {
    /// Makes room for the values of `declarations` declarations; those of any beyond them are dropped.
    pub fn resize(&mut self, declarations: usize) {
        self.globals.resize(declarations, Lazy::Waiting);
        self.designs.resize(declarations, Keyed::default());
        self.connectors.resize(declarations, None);
    }
}

/// The position of evaluation: the calls and loop variables that it is within.
#[derive(Default)]
pub struct Stack {
    /// The calls that evaluation is in, outermost first.
    pub calls: Vec<CallSite>,
    /// The loop variables with their values, outermost first.
    pub binders: Vec<Binder>,
    /// The number of evaluation steps so far.
    pub steps: u64,
    /// The number of calls so far of built-ins with an effect, such as printing.
    pub effects: u64,
    depth: usize,
}

/// A call of a function or behaviour that a user or the library wrote, with its position in the source.
#[derive(Clone, Debug)]
pub struct CallSite {
    /// The span of the call in the source text.
    pub span: Span,
    /// The name of the function that is called.
    pub name: Symbol,
    /// The length of [`Stack::binders`] at the call: those before belong to the caller.
    binders: usize,
}

/// A loop variable with its present value, which errors reported in its loop name.
#[derive(Clone, Debug)]
pub struct Binder {
    /// The name of the loop variable.
    pub name: Symbol,
    /// The present value of the loop variable.
    pub value: Value,
}

impl<'a> Interpreter<'a> {
    /// Returns the state at the beginning of a run, with nothing computed. `routines`: the functions of the
    /// higher-level modules; `checked`: the program; `mode`: the part of it that is evaluated; `options`: the choices
    /// of the user; `host`: the access to files and terminal.
    pub fn new(
        routines: &'a Routines,
        checked: &'a Checked,
        mode: Mode,
        options: &'a Options,
        host: HostProxy,
    ) -> Interpreter<'a> {
        let (program, sources) = (&checked.program, &checked.sources);
        let mut memory = Memory::default();
        memory.resize(program.defs.len());
        Interpreter {
            shared: Shared { routines, program, sources, options, mode, host, faulty: faulty(checked) },
            reported: Reported::default(),
            memory,
            computed: Vec::new(),
            stack: Stack::default(),
        }
    }

    /// Returns the limits of the run, as its options state them.
    pub fn limits(&self) -> &'a Limits {
        &self.shared.options.limits
    }

    /// Returns the name of a declaration. Panics if the program has none of this identity.
    pub fn name(&self, def: DefId) -> Symbol {
        self.shared.program.def(def).name
    }

    /// Returns the declaration of a record that the prelude declares by `record`, given by its name. Panics if there
    /// is none.
    pub fn prelude_record(&self, name: &str) -> DefId {
        let declared = |def: &Def| {
            def.name == name
                && &*self.shared.sources.file(def.file).name == "std/prelude.mod"
                && matches!(&def.kind, DefKind::Record(record) if record.build.is_some())
        };
        let index = self.shared.program.defs.iter().position(declared);
        let index = index.and_then(|index| u32::try_from(index).ok());
        DefId(index.expect("natives name records that the prelude declares"))
    }

    /// Counts an evaluation step, of the expression at `span`.
    ///
    /// # Errors
    /// [`Stop::Halt`] at the limit of steps, or when the user cancels.
    pub fn step(&mut self, span: Span) -> Eval<()> {
        self.stack.steps += 1;
        if self.stack.steps > self.limits().steps {
            let message = format!("the program takes more than {} evaluation steps", self.limits().steps);
            return self.halt(
                Diagnostic::error(code::STEP_LIMIT, message)
                    .label(span, "evaluation was here")
                    .hint("`--max-steps` raises the limit"),
            );
        }
        if memory::is_exceeded() {
            return self.halt(memory_limit().label(span, "evaluation was here"));
        }
        if self.shared.host.cancelled() {
            return Err(Stop::Halt);
        }
        if self.shared.host.cancel_state.is_progress_requested() {
            self.tell_steps();
        }
        Ok(())
    }

    fn tell_steps(&self) {
        interrupt::start_task(String::new());
        let (steps, most) = (self.stack.steps, self.limits().steps);
        interrupt::progress_checkpoint(|| format!("evaluating: {steps} steps of at most {most}"));
    }

    /// Runs `body` one level of evaluation deeper. `span`: the expression that is evaluated.
    ///
    /// # Errors
    /// [`Stop::Halt`] where the stack would overflow, besides the errors of `body`.
    pub fn with_depth<T>(&mut self, span: Span, body: impl FnOnce(&mut Self) -> Eval<T>) -> Eval<T> {
        let limit = self.shared.host.nesting_max;
        let bears = stacker::remaining_stack().is_none_or(|left| left >= REST_BYTES);
        if self.stack.depth >= limit || !bears {
            let limit = self.stack.depth;
            let message = format!("evaluation is nested more than {limit} levels deep, which is the limit");
            let diagnostic =
                Diagnostic::error(code::RECURSION_LIMIT, message).label(span, "evaluation was here");
            let calls = self.stack.calls.len();
            return self.halt(if calls < CALLS_MANY {
                diagnostic
            } else {
                diagnostic.hint(format!("{calls} calls are nested here; {CALLS_HINT}"))
            });
        }
        self.stack.depth += 1;
        let result = body(self);
        self.stack.depth -= 1;
        result
    }

    /// Runs `body` as the body of a call of `name` at `span`; loop variables outside are hidden in it.
    ///
    /// # Errors
    /// [`Stop::Halt`] at the limit of recursion, besides the errors of `body`.
    pub fn with_call<T>(
        &mut self,
        span: Span,
        name: Symbol,
        body: impl FnOnce(&mut Self) -> Eval<T>,
    ) -> Eval<T> {
        let binders = self.stack.binders.len();
        self.stack.calls.push(CallSite { span, name, binders });
        let result =
            if self.stack.calls.len() > self.limits().recursion { self.too_deep() } else { body(self) };
        self.stack.calls.pop();
        self.stack.binders.truncate(binders);
        result
    }

    fn too_deep<T>(&mut self) -> Eval<T> {
        let limit = self.limits().recursion;
        let outermost = self.stack.calls.first().expect("a call was just pushed");
        let mut diagnostic = Diagnostic::error(
            code::RECURSION_LIMIT,
            format!("calls are nested more than {limit} deep, which is the limit"),
        )
        .label(outermost.span, "the outermost call");
        let mut shown = HashSet::from([outermost.span]);
        for call in self.stack.calls.iter().rev() {
            if shown.len() <= CALLS_SHOWN && shown.insert(call.span) {
                diagnostic =
                    diagnostic.label(call.span, format!("which led to this call of `{}`", call.name));
            }
        }
        self.halt(diagnostic.hint(CALLS_HINT))
    }

    /// Runs `body` with a loop variable, which errors reported in it name, and returns its result. `value`: the
    /// present value of the variable.
    pub fn with_binding<T>(&mut self, name: Symbol, value: &Value, body: impl FnOnce(&mut Self) -> T) -> T {
        self.stack.binders.push(Binder { name, value: value.clone() });
        let result = body(self);
        self.stack.binders.pop();
        result
    }

    /// Reports a diagnostic, as [`add_report`](Self::add_report) does, and ends the run.
    ///
    /// # Errors
    /// Always [`Stop::Halt`].
    pub fn halt<T>(&mut self, diagnostic: Diagnostic) -> Eval<T> {
        self.add_report(diagnostic);
        Err(Stop::Halt)
    }

    /// Reports a diagnostic with the calls that led to it and, for an error, the loop variables, as
    /// [`add_report`](Self::add_report) does.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        let diagnostic = self.with_calls(diagnostic);
        self.add_report(diagnostic);
    }

    /// Reports a diagnostic as it is, without the calls and loop variables of the present position. It is dropped if
    /// one of its code and span is known (for one of the judge, also of its message), or after `REPORTS_MAX` errors,
    /// or as many others; errors are counted nevertheless.
    pub fn add_report(&mut self, diagnostic: Diagnostic) {
        self.reported.errors += usize::from(diagnostic.is_error());
        // The judge's findings differ from robot to robot, at one and the same line.
        let judged = diagnostic.code.0.starts_with("E06").then(|| diagnostic.message.clone());
        let key = (diagnostic.code, diagnostic.span(), judged);
        // Many warnings leave no error unsaid.
        let alike = self.reported.reports.iter().filter(|d| d.is_error() == diagnostic.is_error()).count();
        if alike < REPORTS_MAX && self.reported.known.insert(key) {
            self.reported.reports.push(diagnostic);
        }
    }

    /// Reports the fault or the limit that ended a run, if one did. `ended`: the result of the run, or why it has none.
    pub fn report_end(&mut self, ended: Result<Eval<()>, Ended>) {
        match ended {
            Ok(Err(Stop::Fault(diagnostic))) => self.report(*diagnostic),
            Err(Ended::OutOfMemory) => self.report(memory_limit()),
            Ok(Ok(()) | Err(Stop::Halt)) | Err(Ended::Cancelled) => {}
        }
    }

    /// Returns the span of the first expression that is unknown although no error says why; `None` if there is
    /// none, if an error was reported, and after cancelling. `None` also in [`Mode::Check`], which leaves
    /// values unknown that only a run computes.
    pub fn lost_value(&self) -> Option<Span> {
        let told = self.reported.reports.iter().any(Diagnostic::is_error);
        let expected = self.shared.mode == Mode::Check || self.shared.host.cancelled();
        self.reported.unknown_at.filter(|_| !told && !expected)
    }

    /// Reports the [`lost_value`](Self::lost_value), if there is one, as a defect of modl.
    pub fn report_lost(&mut self) {
        if let Some(span) = self.lost_value() {
            let message = "this has no value, and no error says why: that is a defect of modl";
            self.add_report(
                Diagnostic::error(code::LOST_VALUE, message)
                    .label(span, "lost here")
                    .hint("please report it with this program"),
            );
        }
    }

    /// Runs `body` and returns (result, diagnostics): its result, and its diagnostics in order, instead of reporting
    /// them. Its errors stay counted.
    pub fn capture_diagnostics<T>(&mut self, body: impl FnOnce(&mut Self) -> T) -> (T, Vec<Diagnostic>) {
        let mark = self.reported.reports.len();
        let value = body(self);
        let found = self.reported.reports.split_off(mark);
        let told = |(_, span, _): &(_, Option<Span>, _)| !found.iter().any(|d| d.span() == *span);
        self.reported.known.retain(told);
        (value, found)
    }

    /// Returns true if an error was found since `mark` (a value of [`Reported::errors`]), reported before or
    /// not.
    pub fn failed_since(&self, mark: usize) -> bool {
        self.reported.errors > mark
    }

    /// Runs a step, reports its fault, and returns its value; `None` after a fault.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn attempt<T>(&mut self, step: impl FnOnce(&mut Self) -> Eval<T>) -> Eval<Option<T>> {
        match step(self) {
            Ok(value) => Ok(Some(value)),
            Err(Stop::Fault(diagnostic)) => {
                self.report(*diagnostic);
                Ok(None)
            }
            Err(halt) => Err(halt),
        }
    }

    /// Returns the value of a result; a fault is reported and gives `Value::Unknown`.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`].
    pub fn recover(&mut self, result: Eval<Value>) -> Eval<Value> {
        match result {
            Err(Stop::Fault(diagnostic)) => {
                self.report(*diagnostic);
                Ok(Value::Unknown)
            }
            other => other,
        }
    }

    /// Returns true if a span lies in a file of the standard library.
    pub fn is_library(&self, span: Span) -> bool {
        self.shared.sources.file(span.file).library
    }

    /// Returns the innermost call that is written in the user's own files; `None` if there is none.
    pub fn user_call(&self) -> Option<&CallSite> {
        self.stack.calls.iter().rev().find(|call| !self.is_library(call.span))
    }

    /// Returns a diagnostic with the loop variables in the message of an error, and labels at the calls that
    /// led to it: the user's own call first if the primary label is in the library, then the four innermost.
    fn with_calls(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        let Some(primary) = diagnostic.span() else { return diagnostic };
        let notes = self.binder_notes();
        if !notes.is_empty() && diagnostic.severity == Severity::Error {
            diagnostic.message = format!("{} (with {notes})", diagnostic.message);
        }
        if self.is_library(primary)
            && let Some(call) = self.user_call()
        {
            let text = format!("in this call of `{}`", call.name);
            diagnostic.labels.insert(0, crate::source::Label { span: call.span, text });
        }
        let mut shown: HashSet<Span> = diagnostic.labels.iter().map(|l| l.span).collect();
        // A declaration that `check` elaborates by itself is called from nowhere: its span is the name.
        let named = |call: &&CallSite| self.shared.sources.text(call.span) != call.name.as_str();
        for call in self.stack.calls.iter().rev().filter(named).take(CALLS_SHOWN) {
            if shown.insert(call.span) {
                diagnostic = diagnostic.label(call.span, format!("called from here: `{}`", call.name));
            }
        }
        diagnostic
    }

    /// Returns the loop variables of the present body in words, `i = 3, j = 0`; empty if there are none. Lists,
    /// records and other values that have no short form are left out.
    pub fn binder_notes(&self) -> String {
        let from = self.stack.calls.last().map_or(0, |call| call.binders);
        let notes = self.stack.binders[from.min(self.stack.binders.len())..]
            .iter()
            .filter_map(|b| self.binder_note(b));
        notes.collect::<Vec<_>>().join(", ")
    }

    fn binder_note(&self, binder: &Binder) -> Option<String> {
        let shown = match &binder.value {
            Value::Instance(instance) if !instance.path.is_empty() => instance.path.to_string(),
            Value::Int(_) | Value::Quantity(..) | Value::Bool(_) | Value::Text(_) | Value::Word(_) => {
                self.show(&binder.value)
            }
            Value::Joint(joint) => joint.name(),
            _ => return None,
        };
        Some(format!("{} = {shown}", binder.name))
    }

    /// Returns a new instance that is the whole of a design: another robot at each call ([`Instance::whole`]).
    pub fn whole(&self, design: &Rc<Design>) -> Rc<Instance> {
        Instance::whole(design.clone())
    }
}

/// Returns, by declaration, true if an error of `check` is in it.
fn faulty(checked: &Checked) -> Vec<bool> {
    let errors = checked.diagnostics.iter().filter(|d| d.is_error());
    let mut places: Vec<Span> = errors.filter_map(Diagnostic::span).collect();
    places.sort_by_key(|place| (place.file, place.start));
    // The first end of a place and all behind it in its file: there may be many places and many declarations.
    let mut first_end: Vec<u32> = places.iter().map(|place| place.end).collect();
    for index in (1..places.len()).rev() {
        if places[index - 1].file == places[index].file {
            first_end[index - 1] = first_end[index - 1].min(first_end[index]);
        }
    }
    let within = |whole: Span| {
        let index = places.partition_point(|place| (place.file, place.start) < (whole.file, whole.start));
        places.get(index).is_some_and(|place| place.file == whole.file && first_end[index] <= whole.end)
    };
    checked.program.defs.iter().map(|def| within(def.whole)).collect()
}
