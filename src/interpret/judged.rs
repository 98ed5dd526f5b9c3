//! Verdicts in short, by the calls that ask for them, and those on behaviours of declarations.

use super::host::Judgement;
use super::interpreter::Interpreter;
use super::stop::Eval;
use super::value::{Lazy, Value};
use super::verdicts::failure_line;
use crate::check::typed::{DefId, DefKind, ExprKind};
use crate::plan::Verdict;
use crate::source::Span;

impl Interpreter<'_> {
    /// Keeps a verdict in short for [`Outcome::judgements`](super::Outcome::judgements), unless the same call had a worse one.
    /// `headline`: that of the verdict; `span`: the call.
    pub fn note_judgement(&mut self, verdict: &Verdict, headline: &str, span: Span) {
        let ok = verdict.ok();
        let more = match verdict.failures.first() {
            Some(failure) => Some(failure_line(failure)),
            None => verdict.least_margin(),
        };
        let words = match more {
            Some(more) if ok => format!("{headline}, {more}"),
            Some(more) => format!("{headline}: {more}"),
            None => headline.to_owned(),
        };
        let loads = [&verdict.torque_margin, &verdict.bond_margin, &verdict.force_margin];
        let least = loads.into_iter().flatten().map(|worst| worst.value).fold(f64::INFINITY, f64::min);
        let margin = if ok { least } else { f64::NEG_INFINITY };
        let judgement = Judgement { ok, words };
        let known = self.reported.judgements.entry(span).or_insert_with(|| (margin, judgement.clone()));
        if margin < known.0 {
            *known = (margin, judgement);
        }
    }

    /// Plans a behaviour of a configuration, both with the defaults of their parameters, and judges it as `emit` would: the
    /// verdict is kept by the behaviour's name, and failures are reported. Does nothing where a parameter has no default.
    /// `config`: the declaration; `behavior`: the index among its behaviours.
    ///
    /// # Errors
    /// A fault where the behaviour can't be planned, or `Stop::Halt` if a limit is reached or the user cancels.
    pub(super) fn judge_behavior(&mut self, config: DefId, behavior: usize) -> Eval<()> {
        let program = self.shared.program;
        let DefKind::Config(declared) = &program.def(config).kind else { return Ok(()) };
        let Some(declared_behavior) = declared.behaviors.get(behavior) else { return Ok(()) };
        if declared.params.iter().any(|param| param.default.is_none()) {
            return Ok(());
        }
        let (span, count) = (declared_behavior.span, declared.params.len());
        let args = super::routines::Args { values: vec![None; count], spans: vec![span; count] };
        let made = (self.shared.routines.instantiate)(self, config, args, span)?;
        let Value::Instance(object) = made else { return Ok(()) };
        let Some(Value::Behavior(value)) = self.default_behavior(&object, declared_behavior)? else {
            return Ok(());
        };
        let Some(planned) = self.plan_behavior(&value, span)? else { return Ok(()) };
        let verdict = self.judge(&planned, self.judge_settings(), None)?;
        self.note_exemptions(&planned, &verdict);
        self.note_judgement(&verdict, &crate::plan::headline(&planned.plan, &verdict), span);
        if !verdict.ok() {
            self.report_failures(&planned, &verdict, span, None);
        }
        Ok(())
    }

    /// Returns the values of top-level `let`s of the project's files that are numbers or quantities and are not written as
    /// such, as text, by the places of their expressions.
    pub(super) fn constants(&self) -> Vec<(Span, String)> {
        let program = self.shared.program;
        let own = program.own.iter().map(|id| (id, program.def(*id)));
        let value = |(id, def): (&DefId, &crate::check::typed::Def)| {
            let DefKind::Let(binding) = &def.kind else { return None };
            if is_literal(&binding.value.kind) {
                return None;
            }
            match self.memory.globals.get(id.0 as usize)? {
                Lazy::Done(value @ (Value::Int(_) | Value::Quantity(..))) => {
                    Some((binding.value.span, self.show(value)))
                }
                _ => None,
            }
        };
        own.filter_map(value).collect()
    }
}

/// Returns true for a number as it is written, with or without a sign.
fn is_literal(kind: &ExprKind) -> bool {
    match kind {
        ExprKind::Number(_) | ExprKind::Int(_) | ExprKind::BigInt(_) => true,
        ExprKind::Unary { operand: inner, .. } | ExprKind::SetDimension(inner) => is_literal(&inner.kind),
        _ => false,
    }
}
