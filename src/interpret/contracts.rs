//! Contracts of behaviours: how behaviours carry them, and their judgement at each use in a plan.
//!
//! A contract is stated when its behaviour is called, with the values that its block has by then, and judged with the plan:
//! where the judge has the robot at the beginning and at the end of the behaviour's own interval, and by a report on that
//! interval alone.

use super::behavior::with_instance;
use super::causes::CauseRecord;
use super::frame::Frame;
use super::interpreter::Interpreter;
use super::plan_value::PlanValue;
use super::planning::state_value;
use super::record::Record;
use super::stop::Eval;
use super::value::{ContractUse, ContractValue, Value};
use crate::behavior::ContractInterval;
use crate::check::typed::{Contract, ContractKind};
use crate::plan::verify::articulated::base_at;
use crate::plan::{
    self, Body, CauseId, Check, CheckKind, Failure, Ground, Node, Plan, Status, Verdict, WORST_VALUES, Worst,
    verify::verify,
};
use crate::source::{Diagnostic, Span, Symbol, code};
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// The greatest number of uses of contracts that are judged in one plan.
const USES_MAX: usize = 10_000;
/// The greatest number of failures of contracts that a verdict lists.
const FAILURES_MAX: usize = 100;

impl Interpreter<'_> {
    /// Returns the node of a behaviour with the contracts that its block stated, the first outermost. `name`: that of the
    /// behaviour; `called`: the cause of its call, `None` for a declaration without contracts.
    pub(super) fn with_contracts(
        &mut self,
        node: &Arc<Node>,
        name: Symbol,
        stated: Vec<ContractValue>,
        called: Option<CauseId>,
    ) -> Arc<Node> {
        let mut node = node.clone();
        let Some(called) = called else { return node };
        for stated in stated.into_iter().rev() {
            let clause = self.cause(stated.clause.span, Vec::new(), "");
            let cause = match stated.clause.kind {
                ContractKind::Require => called,
                ContractKind::Ensure => clause,
            };
            let number = u32::try_from(self.memory.contracts.len()).expect("steps limit the calls of a run");
            self.memory.contracts.push(Rc::new(ContractUse { stated, behavior: name, called, clause }));
            node = Arc::new(Node::Contract { body: node, number, cause });
        }
        node
    }

    /// Judges the contracts of a plan, and adds the check and its failures to the judge's verdict. `plan`: the plan with the
    /// settings and worlds under which the verdict was given.
    ///
    /// # Errors
    /// No faults, only [`Stop::Halt`](super::stop::Stop::Halt).
    pub(super) fn judge_contracts(
        &mut self,
        planned: &PlanValue,
        plan: &Plan,
        verdict: &mut Verdict,
    ) -> Eval<()> {
        let uses = planned.contracts();
        let status = if uses.len() > USES_MAX {
            let words = format!("more than {USES_MAX} uses of behaviors with contracts are not judged");
            verdict.failures.push(Failure { kind: CheckKind::Contract, ..Failure::form(words) });
            Status::Failed
        } else if !uses.is_empty() {
            let failures = self.broken_contracts(planned, plan, verdict)?;
            let broken = !failures.is_empty();
            verdict.failures.extend(failures);
            verdict.failures.sort_by(|a, b| a.time.total_cmp(&b.time));
            if broken { Status::Failed } else { Status::Sampled(uses.len()) }
        } else if planned.drops_contracts() {
            Status::NotChecked("the plan was changed, and behaviors with contracts in it with it".into())
        } else {
            return Ok(());
        };
        verdict.checks.push(Check { kind: CheckKind::Contract, status });
        Ok(())
    }

    /// Returns the failures of the contracts of a plan, in the order in which their behaviours begin.
    fn broken_contracts(&mut self, planned: &PlanValue, plan: &Plan, whole: &Verdict) -> Eval<Vec<Failure>> {
        let uses = planned.contracts();
        let mut times: Vec<f64> = uses.iter().flat_map(|use_| [use_.from, use_.to]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        // The states are those of the plan under these settings and worlds.
        let (robot, body) = (planned.robot.clone(), planned.body.clone());
        let judged =
            Rc::new(PlanValue::new(robot, body, plan.clone(), planned.causes.clone(), planned.actions));
        let mut intervals = Intervals {
            plan: judged,
            times: Rc::new(times),
            whole,
            states: BTreeMap::new(),
            reports: vec![],
        };
        let mut failures = Vec::new();
        for use_ in uses {
            let failure = self.broken_contract(use_, &mut intervals)?;
            failures.extend(failure.filter(|_| failures.len() < FAILURES_MAX));
        }
        Ok(failures)
    }

    /// Returns the failure of a contract in one of its uses; `None` if it holds.
    fn broken_contract(
        &mut self,
        interval: &ContractInterval,
        intervals: &mut Intervals,
    ) -> Eval<Option<Failure>> {
        let contract = self.memory.contracts[interval.number as usize].clone();
        let ContractUse { stated, behavior, .. } = &*contract;
        let clause = &*stated.clause;
        let mut frame =
            Frame { slots: stated.slots.clone(), this: stated.this.clone(), contracts: Vec::new() };
        let states = [(clause.start, interval.from), (clause.end, interval.to)];
        for (local, time) in states.into_iter().filter_map(|(local, time)| Some((local?, time))) {
            frame.set(local, intervals.state(time));
        }
        if let Some(local) = clause.report.filter(|_| self.names_report(clause)) {
            frame.set(local, intervals.report(interval));
        }
        let call = self.memory.causes.get(contract.called).span;
        let text = self.condition_text(clause);
        let said = self.with_call(call, *behavior, |this| {
            let found = match this.eval(&clause.condition, &mut frame)? {
                Value::Bool(true) => return Ok(None),
                Value::Bool(false) => this.sides(&clause.condition, &mut frame)?,
                _ => "this could not be judged".to_owned(),
            };
            let said = match this.eval_optional(clause.message.as_ref(), &mut frame)? {
                Some(Value::Text(message)) => format!("{message}: "),
                _ => String::new(),
            };
            let found = if found.is_empty() { found } else { format!(": {found}") };
            Ok(Some((said, found)))
        })?;
        let Some((said, found)) = said else { return Ok(None) };
        let (time, stated) = match clause.kind {
            ContractKind::Require => {
                (interval.from, format!("`{behavior}` requires `{text}` where it begins"))
            }
            ContractKind::Ensure => (interval.to, format!("`{behavior}` does not ensure `{text}`")),
        };
        Ok(Some(Failure {
            kind: CheckKind::Contract,
            time,
            blame: vec![interval.cause],
            ..Failure::form(format!("{said}{stated}{found}"))
        }))
    }

    /// Returns true if a clause may look at the report on its interval, which takes a judgement of its own.
    fn names_report(&self, clause: &Contract) -> bool {
        self.shared.sources.text(clause.span).contains("report")
    }

    /// Returns the condition of a contract as it is written, on one line.
    fn condition_text(&self, clause: &Contract) -> String {
        let text = self.shared.sources.text(clause.condition.span);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Returns the diagnostic of a contract that does not hold: at the call for a requirement, at the clause for what is
    /// ensured. `planned`: the plan that was judged; `message`: the words, with the time.
    pub(super) fn contract_failure(
        &self,
        planned: &PlanValue,
        failure: &Failure,
        message: String,
    ) -> Diagnostic {
        let is_use = |interval: &&ContractInterval| {
            let contract = &self.memory.contracts[interval.number as usize];
            let text = format!("`{}`", self.condition_text(&contract.stated.clause));
            failure.blame.first() == Some(&interval.cause) && failure.message.contains(&text)
        };
        let Some(interval) = planned.contracts().iter().find(is_use) else {
            return Diagnostic::error(code::NOT_VERIFIED, message);
        };
        let contract = &self.memory.contracts[interval.number as usize];
        let (called, clause) =
            (self.memory.causes.get(contract.called), self.memory.causes.get(contract.clause));
        let used = (called.primary(), with_instance(format!("this use of `{}`", contract.behavior), called));
        match contract.stated.clause.kind {
            ContractKind::Require => Diagnostic::error(code::REQUIRED_START, message)
                .label(used.0, used.1)
                .label(clause.span, "required here"),
            ContractKind::Ensure => Diagnostic::error(code::ENSURED_END, message)
                .label(own_span(clause, called), "ensured here")
                .label(used.0, used.1),
        }
    }
}

/// Returns the span of a clause; that of the call in the user's own file if the clause is the library's.
fn own_span(clause: &CauseRecord, called: &CauseRecord) -> Span {
    clause.caller.map_or(clause.span, |_| called.primary())
}

/// The states and reports that contracts of one plan look at.
struct Intervals<'v> {
    /// The plan with the settings and worlds under which it is judged.
    plan: Rc<PlanValue>,
    /// The times at which behaviours with contracts begin and end, s, ascending.
    times: Rc<Vec<f64>>,
    /// The judge's verdict on the whole plan.
    whole: &'v Verdict,
    /// The states so far, by the index of their time.
    states: BTreeMap<usize, Value>,
    /// The reports so far, each with its interval in s.
    reports: Vec<((f64, f64), Value)>,
}

impl Intervals<'_> {
    /// Returns the state at one of the times.
    fn state(&mut self, time: f64) -> Value {
        let index = self.times.partition_point(|known| *known < time);
        let make = || {
            let state = state_value(&self.plan, &self.times, index, OnceCell::new());
            state.map_or(Value::Unknown, |state| Value::Record(Rc::new(Record::State(Box::new(state)))))
        };
        self.states.entry(index).or_insert_with(make).clone()
    }

    /// Returns the report on an interval.
    fn report(&mut self, interval: &ContractInterval) -> Value {
        let key = (interval.from, interval.to);
        if let Some((_, known)) = self.reports.iter().find(|(other, _)| *other == key) {
            return known.clone();
        }
        let plan = &self.plan.plan;
        let verdict = match interval.from <= 0.0 && interval.to >= plan.body.duration() {
            true => self.whole.clone(),
            false => verdict_within(plan, self.whole, interval),
        };
        let headline = plan::headline_under(plan, &plan.worlds, &verdict);
        let report = Value::Record(Rc::new(Record::Report(Rc::new(verdict), headline)));
        self.reports.push((key, report.clone()));
        report
    }
}

/// Returns the verdict on a part of a plan, from where the robot stands at its beginning: of the part alone, but for what its
/// ends make of it where joints move there. The failures are those of the whole plan in that time, and a worst value is
/// that of the whole where this is better: the part has none that is worse.
fn verdict_within(plan: &Plan, whole: &Verdict, interval: &ContractInterval) -> Verdict {
    let (from, to) = (interval.from, interval.to);
    let mut part = match plan::sliced(plan, from, to) {
        Ok(part) => part,
        Err(error) => {
            return Verdict { failures: vec![Failure::form(error.to_string())], ..Verdict::default() };
        }
    };
    let stands = plan.worlds.iter().any(|from| from.world.ground != Ground::Off);
    if let Body::Tracks(tracks) = &mut part.body
        && stands
        && tracks.start.clusters.is_empty()
        && let Some(base) = base_at(plan, from)
    {
        tracks.start.base = base;
    }
    let mut verdict = verify(&part);
    let shifted = |time: f64| (time - from).clamp(0.0, to - from);
    let within = |failure: &&Failure| failure.time <= to && failure.until.unwrap_or(failure.time) >= from;
    let moved = |failure: &Failure| Failure {
        time: shifted(failure.time),
        until: failure.until.map(shifted),
        ..failure.clone()
    };
    verdict.failures = whole.failures.iter().filter(within).map(moved).collect();
    for kind in WORST_VALUES {
        let (Some(own), Some(all)) = ((kind.of)(&verdict), (kind.of)(whole)) else { continue };
        let better = if kind.greatest { all.value < own.value } else { all.value > own.value };
        if better {
            *(kind.of_mut)(&mut verdict) = Some(Worst { time: shifted(all.time), ..all.clone() });
        }
    }
    let cut = from > 0.0 || to < plan.body.duration();
    for check in &mut verdict.checks {
        if verdict.failures.iter().any(|failure| failure.kind == check.kind) {
            check.status = Status::Failed;
        } else if check.status == Status::Failed || check.kind == CheckKind::Rest && cut {
            check.status = Status::NotChecked("joints may move where this interval begins or ends".into());
        }
    }
    verdict
}
