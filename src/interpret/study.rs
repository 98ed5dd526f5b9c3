//! Studies: their design, evaluated, and the rows of their tables.
//!
//! A row is a function of the program and the row's number alone: whatever was computed for other rows is forgotten
//! before it, but for the values of top-level lets that its study needs, which are evaluated first.

use super::evaluator_thread;
use super::frame::Frame;
use super::host::{Host, Mode, Options};
use super::interpreter::{Interpreter, Memory, Reported, Stack};
use super::memory_errors::{memory_limit, no_memory};
use super::record::{DeclaredRecord, Record};
use super::routines::Routines;
use super::stop::{Eval, Stop, fault};
use super::study_columns::{Cell, StudyColumn};
use super::value::{Lazy, Value};
use crate::check::Checked;
use crate::check::typed::{DefId, DefKind, Expr, Program, SamplerDef, StudyAxis, StudyDef};
use crate::interrupt::{self, Ended};
use crate::source::{Diagnostic, Files, Span, Symbol, code};
use crate::study::{Coordinate, Design, Domain, Goal, POINTS_MAX, ROWS_MAX, Sampler};
use crate::units::Dimension;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

/// A study whose domains and settings are evaluated.
pub struct Study {
    /// The declaration of the study, by identity.
    pub def: DefId,
    /// The axes with their sampler, as numbers.
    pub design: Design,
    /// The number of rows of the table.
    pub rows: u64,
    /// The objective of a search, as (field of the row, direction); `None` for other samplers.
    pub objective: Option<(usize, Goal)>,
    /// The values of the axes, those that the sampler chooses first.
    axes: Vec<AxisValues>,
}

/// The values of an axis, by what a coordinate of it stands for.
enum AxisValues {
    /// The values of a list, by index.
    List(Rc<Vec<Value>>),
    /// The whole numbers from this one on.
    Whole(i64),
    /// The quantities of a dimension.
    Quantity(Dimension),
}

/// The result of a row.
pub struct StudyRow {
    /// The record that the row gave.
    pub outcome: Result<Value, RowFault>,
    /// The number of evaluation steps that it took.
    pub steps: u64,
    /// The paths of the files that it wrote, as the host showed them.
    pub written: Vec<String>,
}

/// The reason that a row has no values: the first error of its evaluation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowFault {
    /// The code of the error.
    pub code: &'static str,
    /// The message of the error.
    pub message: String,
    /// The whole diagnostic of the error; `None` where the task ended without one.
    pub diagnostic: Option<Box<Diagnostic>>,
}

impl Interpreter<'_> {
    /// Returns a study with its domains and settings evaluated. Panics if the declaration is no study.
    ///
    /// # Errors
    /// A fault where an axis or a point has no value, a number is out of range, or the table would be too long.
    pub fn study(&mut self, def: DefId) -> Eval<Option<Study>> {
        let program = self.shared.program;
        let DefKind::Study(study) = &program.def(def).kind else { unreachable!("it is a study") };
        let mut frame = Frame::new(study.frame, None);
        let mut axes = Vec::new();
        let mut domains = Vec::new();
        for axis in study.axes.iter().chain(&study.each) {
            let Some((values, domain)) = self.axis(axis, &mut frame)? else { return Ok(None) };
            axes.push(values);
            domains.push((domain, axis.domain.span));
        }
        let each = domains.split_off(study.axes.len());
        let counts = each.iter().map(|(domain, _)| match domain {
            Domain::Values(count) => *count,
            Domain::Range(..) => unreachable!("`each` goes through single values"),
        });
        let each: Vec<u64> = counts.collect();
        let Some(sampler) = self.sampler(study, &domains, &mut frame)? else { return Ok(None) };
        let objective = match &study.sampler {
            SamplerDef::Cmaes { objective, maximise, .. } => {
                Some((*objective, if *maximise { Goal::Greatest } else { Goal::Least }))
            }
            _ => None,
        };
        let axes_of = domains.iter().map(|(domain, _)| *domain).collect();
        let design = Design { axes: axes_of, each, sampler, seed: self.shared.options.seed };
        let Some(rows) = design.rows() else {
            let message = format!("a study of more than {ROWS_MAX} rows is not allowed");
            return Err(fault(code::SIZE_LIMIT, study.sampler_span, message, "too many rows"));
        };
        Ok(Some(Study { def, design, rows, objective, axes }))
    }

    /// Evaluates the domain of an axis; `None` where it is unknown.
    fn axis(&mut self, axis: &StudyAxis, frame: &mut Frame) -> Eval<Option<(AxisValues, Domain)>> {
        let span = axis.domain.span;
        let empty =
            || fault(code::BAD_VALUE, span, format!("`{}` has no values", axis.name), "nothing to study");
        Ok(Some(match self.eval(&axis.domain, frame)? {
            Value::List(values) if values.is_empty() => return Err(empty()),
            Value::List(values) => {
                let count = values.len() as u64;
                (AxisValues::List(values), Domain::Values(count))
            }
            Value::Range(ends) => match &*ends {
                (Value::Int(from), Value::Int(to)) if axis.ty == crate::check::Type::Int => {
                    let count = to.checked_sub(*from).and_then(|count| u64::try_from(count).ok());
                    let count = count.filter(|count| *count > 0).ok_or_else(empty)?;
                    (AxisValues::Whole(*from), Domain::Values(count))
                }
                (from, to) => {
                    let Some((from, to)) = from.as_number().zip(to.as_number()) else { return Ok(None) };
                    let dimension = axis.ty.dimension().unwrap_or(Dimension::NUMBER);
                    (AxisValues::Quantity(dimension), Domain::Range(from, to))
                }
            },
            _ => return Ok(None),
        }))
    }

    /// Evaluates the settings of the sampler; `None` where one is unknown.
    fn sampler(
        &mut self,
        study: &StudyDef,
        domains: &[(Domain, Span)],
        frame: &mut Frame,
    ) -> Eval<Option<Sampler>> {
        Ok(match &study.sampler {
            SamplerDef::Error => None,
            SamplerDef::Grid(counts) => {
                let mut all = Vec::new();
                for (index, (domain, _)) in domains.iter().enumerate() {
                    let stated = counts.iter().find(|(axis, _)| *axis == index);
                    all.push(match (domain, stated) {
                        (Domain::Values(count), _) => *count,
                        (Domain::Range(..), Some((_, count))) => {
                            let Some(count) = self.at_least_one(count, "the number of values", frame)? else {
                                return Ok(None);
                            };
                            count
                        }
                        (Domain::Range(..), None) => return Ok(None),
                    });
                }
                Some(Sampler::Grid(all))
            }
            SamplerDef::Sobol(count) => {
                let found = self.at_least_one(count, "the number of points", frame)?;
                if found.is_some_and(|found| found > POINTS_MAX) {
                    let message = format!("the sequence has {POINTS_MAX} points");
                    return Err(fault(code::BAD_VALUE, count.span, message, "too many"));
                }
                found.map(Sampler::Sobol)
            }
            SamplerDef::Random(count) => {
                self.at_least_one(count, "the number of points", frame)?.map(Sampler::Random)
            }
            SamplerDef::Cmaes { budget, .. } => {
                if study.axes.is_empty() {
                    let message = "a search needs an axis to search along";
                    return Err(fault(code::BAD_VALUE, study.sampler_span, message, "no axes"));
                }
                self.at_least_one(budget, "the budget", frame)?.map(Sampler::Search)
            }
        })
    }

    /// Evaluates a whole number that must be at least 1; `None` where it is unknown.
    fn at_least_one(&mut self, e: &Expr, what: &str, frame: &mut Frame) -> Eval<Option<u64>> {
        match self.eval(e, frame)? {
            Value::Int(n) if n >= 1 => Ok(u64::try_from(n).ok()),
            Value::Unknown => Ok(None),
            value => {
                let message = format!("{what} is at least 1; this is {}", self.show(&value));
                Err(fault(code::BAD_VALUE, e.span, message, "a positive whole number is wanted"))
            }
        }
    }

    /// Computes a row from a memory as it was before all rows, and leaves the state of the run as it is. `point`: the
    /// coordinates of the axes that the sampler chooses; `each`: the indices of the others. `None` where the user
    /// cancels.
    pub fn study_row(
        &mut self,
        study: &Study,
        point: &[Coordinate],
        each: &[u64],
        before: &Memory,
    ) -> Option<StudyRow> {
        let memory = std::mem::replace(&mut self.memory, before.clone());
        let reported = std::mem::take(&mut self.reported);
        let mut stack = std::mem::take(&mut self.stack);
        let computed = std::mem::take(&mut self.computed);
        let ended = self.row_value(study, point, each);
        self.forget_computed();
        let steps = self.stack.steps;
        let mut found = std::mem::replace(&mut self.reported, reported);
        self.memory = memory;
        stack.steps = stack.steps.saturating_add(steps);
        self.stack = stack;
        self.computed = computed;
        let error =
            found.reports.iter().position(Diagnostic::is_error).map(|at| found.reports.swap_remove(at));
        let outcome = match (error, ended) {
            (Some(error), _) => Err(RowFault::of(error)),
            (None, Err(Stop::Fault(fault))) => Err(RowFault::of(*fault)),
            (None, Err(Stop::Halt)) => return None,
            (None, Ok(value @ Value::Record(_))) => Ok(value),
            (None, Ok(_)) if self.shared.host.cancelled() => return None,
            (None, Ok(_)) => Err(RowFault::lost()),
        };
        Some(StudyRow { outcome, steps, written: found.written })
    }

    fn row_value(&mut self, study: &Study, point: &[Coordinate], each: &[u64]) -> Eval<Value> {
        let program = self.shared.program;
        let DefKind::Study(declared) = &program.def(study.def).kind else { unreachable!("it is a study") };
        let mut frame = Frame::new(declared.frame, None);
        for (slot, value) in study.values(point, each).into_iter().enumerate() {
            frame.set_slot(slot, value);
        }
        self.eval(&declared.body, &mut frame)
    }

    /// Forgets the members of instances that were computed, so that they are computed again when they are needed.
    fn forget_computed(&mut self) {
        for (instance, key) in self.computed.drain(..) {
            instance.lazy.borrow_mut().remove(&key);
        }
    }

    /// Evaluates the lets that a study needs, as far as they have values, and returns the memory from which its rows
    /// begin.
    ///
    /// # Errors
    /// [`Stop::Halt`] if the user cancels.
    fn prepared(&mut self, checked: &Checked, study: DefId) -> Eval<Memory> {
        for def in needed(checked, study) {
            let reported = std::mem::take(&mut self.reported);
            let stack = std::mem::take(&mut self.stack);
            let value = self.global(def, checked.program.def(def).span);
            let failed = self.reported.errors > 0;
            (self.reported, self.stack) = (reported, stack);
            if self.shared.host.cancelled() {
                return Err(Stop::Halt);
            }
            if failed || !value.is_ok_and(|value| !value.is_unknown()) {
                // Each row that needs it tells why it has no value.
                self.memory.globals[def.0 as usize] = Lazy::Waiting;
                self.forget_computed();
            }
            self.computed.clear();
        }
        Ok(self.memory.clone())
    }
}

impl RowFault {
    /// Returns the fault of a row that ended with an error.
    fn of(diagnostic: Diagnostic) -> RowFault {
        let (code, message) = (diagnostic.code.0, diagnostic.message.clone());
        RowFault { code, message, diagnostic: Some(Box::new(diagnostic)) }
    }

    /// Returns the fault of a row whose task ended the program, or a part of it, instead of answering.
    pub fn lost() -> RowFault {
        let message = "the task ended without an answer: that is a defect of modl, or too little memory";
        RowFault { code: code::NO_ROW.0, message: message.to_owned(), diagnostic: None }
    }
}

impl Study {
    /// Returns the values of all axes at a point. `each`: the indices of the values of the further axes.
    pub fn values(&self, point: &[Coordinate], each: &[u64]) -> Vec<Value> {
        let each = each.iter().map(|index| Coordinate::Index(*index));
        let coordinates = point.iter().copied().chain(each);
        let value = |(axis, coordinate): (&AxisValues, Coordinate)| match (axis, coordinate) {
            (AxisValues::List(values), Coordinate::Index(index)) => usize::try_from(index)
                .ok()
                .and_then(|index| values.get(index))
                .cloned()
                .unwrap_or(Value::Unknown),
            (AxisValues::Whole(from), Coordinate::Index(index)) => {
                Value::Int(from.saturating_add_unsigned(index))
            }
            (AxisValues::Quantity(dimension), Coordinate::Number(x)) => Value::Quantity(x, *dimension),
            _ => Value::Unknown,
        };
        self.axes.iter().zip(coordinates).map(value).collect()
    }

    /// Returns what a search seeks, in SI units; `None` for other samplers, and where a row has no such number.
    pub fn sought(&self, row: &Value) -> Option<f64> {
        let (field, _) = self.objective?;
        let Value::Record(record) = row else { return None };
        match &**record {
            Record::Declared(DeclaredRecord { fields, .. }) => fields.get(field)?.as_number(),
            _ => None,
        }
    }
}

/// Returns the value of a study's name; that of another declaration that is no `let` is unknown.
pub(super) fn study_value(program: &Program, def: DefId) -> Value {
    if matches!(program.def(def).kind, DefKind::Study(_)) { Value::Study(def) } else { Value::Unknown }
}

/// Returns the lets of the project's own files that a study needs, directly or through what it names, in order.
fn needed(checked: &Checked, study: DefId) -> Vec<DefId> {
    let program = &checked.program;
    let mut found = BTreeSet::from([study]);
    let mut waiting = vec![study];
    while let Some(id) = waiting.pop() {
        let whole = program.def(id).whole;
        let within =
            |span: Span| span.file == whole.file && whole.start <= span.start && span.end <= whole.end;
        let named = checked.uses.iter().filter(|(span, _)| within(*span)).map(|(_, id)| *id);
        waiting.extend(named.filter(|id| found.insert(*id)));
    }
    let own: BTreeSet<DefId> = program.own.iter().copied().collect();
    let is_let = |id: &DefId| own.contains(id) && matches!(program.def(*id).kind, DefKind::Let(_));
    found.into_iter().filter(is_let).collect()
}

/// A thread's evaluator of the rows of one study.
pub struct StudyWorker<'a, 'i> {
    interpreter: &'a mut Interpreter<'i>,
    study: Study,
    columns: Vec<StudyColumn>,
    before: Memory,
    written: Vec<String>,
}

/// A row as a table holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct RowCells {
    /// The cells of the axes.
    pub axes: Vec<Cell>,
    /// The cells of the fields of the row, or why it has none.
    pub outcome: Result<Vec<Cell>, RowFault>,
    /// The objective of a search, in SI units; `None` for other samplers, and where the row has no such number.
    pub sought: Option<f64>,
}

impl StudyWorker<'_, '_> {
    /// Returns the study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Returns the columns of the study's table, the axes first.
    pub fn columns(&self) -> &[StudyColumn] {
        &self.columns
    }

    /// Returns the paths of the files that the last row wrote, as the host showed them.
    pub fn written(&self) -> Vec<String> {
        self.written.clone()
    }

    /// Returns a row that is not computed, because computing it ended the program: with the fault [`RowFault::lost`].
    /// `point` and `each`: as for [`row`](Self::row).
    pub fn set_aside(&self, point: &[Coordinate], each: &[u64]) -> RowCells {
        let values = self.study.values(point, each);
        let axes = values.iter().map(|value| Cell::of(self.interpreter, value)).collect();
        RowCells { axes, outcome: Err(RowFault::lost()), sought: None }
    }

    /// Computes a row; `None` where the user cancels. A task that panics, a defect of modl, gives the fault
    /// [`RowFault::lost`]. `point`: the coordinates of the axes that the sampler chooses; `each`: the indices of the
    /// others.
    pub fn row(&mut self, point: &[Coordinate], each: &[u64]) -> Option<RowCells> {
        let values = self.study.values(point, each);
        let host = self.interpreter.shared.host.clone();
        let caught = catch_unwind(AssertUnwindSafe(|| {
            interrupt::catch(
                &host.cancel_state,
                |_| {},
                || self.interpreter.study_row(&self.study, point, each, &self.before),
            )
        }));
        let fault = match caught {
            Ok(Ok(row)) => Ok(row?),
            Ok(Err(Ended::Cancelled)) => return None,
            Ok(Err(Ended::OutOfMemory)) => Err(RowFault::of(memory_limit())),
            Err(_) => Err(RowFault::lost()),
        };
        let row = fault.unwrap_or_else(|fault| {
            // Nothing of the state in which it broke off is left.
            self.interpreter.reset(&self.before);
            StudyRow { outcome: Err(fault), steps: 0, written: Vec::new() }
        });
        self.written = row.written;
        let sought = row.outcome.as_ref().ok().and_then(|value| self.study.sought(value));
        let axes = values.iter().map(|value| Cell::of(self.interpreter, value)).collect();
        let named: Vec<(Symbol, Value)> =
            self.columns.iter().map(|column| Symbol::new(&column.name)).zip(values).collect();
        let outcome = row.outcome.and_then(|value| {
            self.interpreter.row_cells(&value, &named).map_err(|field| RowFault {
                code: code::BAD_STUDY.0,
                message: format!("the field `{field}` has not the value of the axis of its name"),
                diagnostic: None,
            })
        });
        Some(RowCells { axes, outcome, sought })
    }
}

impl Interpreter<'_> {
    /// Drops all that was computed since `before`.
    fn reset(&mut self, before: &Memory) {
        self.memory = before.clone();
        self.reported = Reported::default();
        self.stack = Stack::default();
        self.forget_computed();
    }
}

/// Calls `work` with an evaluator of a study's rows, on a thread of its own, and returns its result; `None` if the user
/// cancels before. `routines`: the functions of the higher-level modules; `files` and `host` serve its requests;
/// `options`: the choices of the user; `study`: the declaration.
///
/// # Errors
/// The diagnostics for which the study has no rows, or that of a system that gives no memory for the thread.
pub fn with_study<T: Send>(
    (routines, checked): (&Routines, &Checked),
    files: &dyn Files,
    host: &mut dyn Host,
    options: &Options,
    study: DefId,
    work: impl FnOnce(&mut StudyWorker) -> T + Send,
) -> Result<Option<T>, Vec<Diagnostic>> {
    let ran = evaluator_thread::run(files, host, |host| {
        let mut interpreter = Interpreter::new(routines, checked, Mode::Run, options, host);
        let cancel_state = interpreter.shared.host.cancel_state.clone();
        let begun = interrupt::catch(
            &cancel_state,
            |_| {},
            || {
                let before = interpreter.prepared(checked, study)?;
                Ok((interpreter.study(study)?, before))
            },
        );
        let (study, before) = match begun {
            Err(Ended::Cancelled) | Ok(Err(Stop::Halt)) if interpreter.reported.errors == 0 => {
                return Ok(None);
            }
            Ok(Ok((Some(study), before))) => (study, before),
            other => {
                interpreter.report_end(other.map(|ended| ended.map(drop)));
                return Err(std::mem::take(&mut interpreter.reported.reports));
            }
        };
        let columns = StudyColumn::all(checked, study.def);
        Ok(Some(work(&mut StudyWorker {
            interpreter: &mut interpreter,
            study,
            columns,
            before,
            written: Vec::new(),
        })))
    });
    ran.unwrap_or_else(|why| Err(vec![no_memory(&why)]))
}
