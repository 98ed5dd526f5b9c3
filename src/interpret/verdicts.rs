//! The findings of the judge, in words and as diagnostics at the lines that are to blame.

use super::behavior::{in_library, with_instance};
use super::causes::CauseRecord;
use super::interpreter::Interpreter;
use super::plan_value::PlanValue;
use super::stop::Stop;
use crate::behavior::{Reason, Refusal};
use crate::plan::{CauseId, Check, CheckKind, Failure, Measure, Settings, Verdict, Worst, WorstKind};
use crate::source::{Code, Diagnostic, Label, Span, code};
use crate::units::{Dimension, number, quantity};
use std::collections::BTreeSet;

/// The greatest number of failures that are reported one by one; the rest is counted.
const FAILURES_SHOWN: usize = 8;

fn seconds(t: f64) -> String {
    quantity(t, Dimension::TIME)
}

/// Returns a failure of the judge on one line with its time: `at 1.2 s: ...`.
pub fn failure_line(failure: &Failure) -> String {
    format!("at {}: {}", seconds(failure.time), failure.message)
}

/// Returns a check of the judge with its outcome, as one line of text.
pub fn check_line(check: &Check) -> String {
    format!("{}: {}", check.kind.name(), check.status)
}

/// Returns a line of text for each worst value that a verdict has, in the order of
/// [`WORST_VALUES`](crate::plan::WORST_VALUES), with its time and the bodies or joints concerned.
pub fn worst_lines(verdict: &Verdict) -> Vec<String> {
    let line = |(kind, worst): (WorstKind, &Worst)| {
        let value = match kind.measure {
            Measure::Length => quantity(worst.value, Dimension::LENGTH),
            Measure::Angle => quantity(worst.value, Dimension::ANGLE),
            Measure::Speed => quantity(worst.value, Dimension::SPEED),
            Measure::Fraction | Measure::Number => number(worst.value),
        };
        let at = if worst.at.is_empty() { String::new() } else { format!(", {}", worst.at.join(" and ")) };
        format!("{} {value} at {}{at}", kind.name, seconds(worst.time))
    };
    verdict.worst_values().map(line).collect()
}

/// Returns a verdict in words, as `print` shows it: a first line with the headline, and below it failures (at most
/// `FAILURES_SHOWN`), worst values, dynamics, checks and notes.
pub fn in_words(verdict: &Verdict, headline: &str) -> String {
    let [x, y, _] = verdict.travel;
    let travel = quantity(libm::hypot(x, y), Dimension::LENGTH);
    let [within, _] = verdict.bounds_in_words();
    let mut lines = vec![format!("{headline}: {}, travels {travel}{within}", seconds(verdict.duration))];
    lines.extend(verdict.failures.iter().take(FAILURES_SHOWN).map(|f| format!("failed {}", failure_line(f))));
    lines.extend(worst_lines(verdict));
    if let Some(dynamics) = &verdict.dynamics {
        lines.extend(dynamics.in_words(verdict.duration).map(|(name, words)| format!("{name} {words}")));
    }
    lines.extend(verdict.checks.iter().map(check_line));
    lines.extend(verdict.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n  ")
}

/// Returns the parts and obstacles of a scene that a failure at its start is about, each as (where it is placed, its name).
fn begins(planned: &PlanValue, failure: &Failure) -> Vec<(Span, String)> {
    let (Some(config), Some(scene)) = (planned.robot.config(), planned.robot.scene()) else { return vec![] };
    let groups = config.parts.get().map_or(&[][..], |groups| groups);
    let mut found: Vec<(Span, String)> = Vec::new();
    for at in &failure.at {
        let of =
            |name: &str| at.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        let part = groups.iter().flat_map(|group| &group.elements).find(|part| of(&part.name));
        let placed = part.and_then(|part| Some((part.place.as_ref()?.span, part.name.to_string())));
        let obstacles = scene.obstacles.borrow();
        let stands = obstacles.iter().find(|obstacle| obstacle.name == *at);
        found.extend(placed.or_else(|| stands.map(|obstacle| (obstacle.span, obstacle.name.clone()))));
    }
    found
}

/// Returns the error code of a failed check.
fn failure_code(kind: CheckKind) -> Code {
    match kind {
        CheckKind::Form | CheckKind::Momentum | CheckKind::Contract => code::NOT_VERIFIED,
        CheckKind::Conflict => code::CONFLICT,
        CheckKind::Collision | CheckKind::Deflection => code::COLLISION,
        CheckKind::JointRange | CheckKind::Speed | CheckKind::Acceleration | CheckKind::Rigidity => {
            code::LIMIT_EXCEEDED
        }
        CheckKind::Torque | CheckKind::StrutLoad => code::OVERLOAD,
        CheckKind::BondLoad => code::BOND_OVERLOAD,
        CheckKind::Docking => code::DOCK_MISS,
        CheckKind::Connectedness => code::FALLS_APART,
        CheckKind::Closure => code::CLOSURE,
        CheckKind::Ground => code::PENETRATION,
        CheckKind::Stability | CheckKind::Balance => code::FALL,
        CheckKind::Traction => code::TRAVEL_UNDETERMINED,
        CheckKind::Slip => code::UNSTABLE,
        CheckKind::Rest => code::NOT_AT_REST,
        CheckKind::Path => code::OFF_PATH,
    }
}

impl Interpreter<'_> {
    /// Reports the failures of a verdict at the commands to blame for them: one finding for all of a kind that the
    /// same commands caused. Failures after a fall follow from it and are not reported. `span`: the call that wants
    /// the verdict; `page`: the file that shows the motion, if one was written. `planned`: the plan that was judged.
    pub fn report_failures(
        &mut self,
        planned: &PlanValue,
        verdict: &Verdict,
        span: Span,
        page: Option<&str>,
    ) {
        let fall = verdict.failures.iter().filter(|f| f.kind == CheckKind::Stability).map(|f| f.time);
        let fall = fall.fold(f64::INFINITY, f64::min);
        let mut told: Vec<(&Failure, Vec<&Failure>)> = Vec::new();
        for failure in verdict.failures.iter().filter(|f| f.time <= fall) {
            let same = |other: &Failure| other.kind == failure.kind && other.blame == failure.blame;
            match told.iter_mut().find(|(first, _)| same(first)) {
                Some((_, more)) => more.push(failure),
                None => told.push((failure, Vec::new())),
            }
        }
        for (failure, more) in told {
            let mut diagnostic = self.failure(planned, failure, span);
            for other in more.iter().take(FAILURES_SHOWN) {
                diagnostic = diagnostic.hint(format!("also {}", failure_line(other)));
            }
            if more.len() > FAILURES_SHOWN {
                diagnostic = diagnostic.hint(format!("and {} more like these", more.len() - FAILURES_SHOWN));
            }
            if let Some(page) = page {
                diagnostic = diagnostic.hint(format!("open `{page}` to see it happen"));
            }
            self.add_report(diagnostic);
        }
    }

    /// Returns the diagnostic of a failure, with labels at the commands to blame and at `span`.
    fn failure(&self, planned: &PlanValue, failure: &Failure, span: Span) -> Diagnostic {
        let time = seconds(failure.time);
        let message = if failure.message.contains(&time) {
            failure.message.clone()
        } else {
            format!("{}, at t = {time}", failure.message)
        };
        if failure.kind == CheckKind::Contract {
            let diagnostic = self.contract_failure(planned, failure, message);
            return add_label(diagnostic, span, "while this plan is verified".to_string());
        }
        let mut diagnostic = Diagnostic::error(failure_code(failure.kind), message);
        let records: Vec<&CauseRecord> =
            failure.blame.iter().map(|id| self.memory.causes.get(planned.causes[id.0 as usize])).collect();
        for (index, record) in records.iter().enumerate() {
            let text = match (failure.blames_start, index) {
                (true, 0) => "the start pose, set here, is to blame",
                (true, _) => "and here",
                (false, 0) if failure.kind == CheckKind::Path => "this states the path",
                (false, 0) => "held still, this would remove the failure",
                (false, _) => "so would this",
            };
            diagnostic = add_label(diagnostic, record.primary(), with_instance(text.to_string(), record));
            if record.caller.is_some() {
                diagnostic = in_library(diagnostic, record);
            }
        }
        let places = if failure.blames_start { begins(planned, failure) } else { vec![] };
        for (at, name) in &places {
            diagnostic = add_label(diagnostic, *at, format!("{name} is here"));
        }
        let diagnostic = add_label(diagnostic, span, "while this plan is verified".to_string());
        match failure.kind {
            CheckKind::Collision if !places.is_empty() => {
                diagnostic.hint("robots and obstacles begin apart: place one of them elsewhere")
            }
            CheckKind::Docking if !planned.plan.body.tracks().is_none_or(|t| t.start.clusters.is_empty()) => {
                diagnostic.hint(
                    "robots dock where their ports are within what the connector captures, and at rest against each \
                     other: bring them there first, and `wait` before the `dock`",
                )
            }
            CheckKind::Stability if failure.until.is_some() => diagnostic
                .hint("`unstable_for:` allows support to be missing for a while, `allows unstable` to tip"),
            CheckKind::Traction if failure.is_slide() => diagnostic
                .hint("a gentler slope or more friction holds it; `allows traction` where it may slide"),
            CheckKind::Collision if failure.at.len() == 1 && planned.body.is_some() => diagnostic.hint(
                "links of one module: leave room between them or narrow the range of their joint; \
                 `touching a b` says that two meet by design",
            ),
            _ => diagnostic,
        }
    }

    /// Records, for each exemption of the user's own files, if a verdict on a plan needed it: one clause covers many
    /// intervals and many plans. `planned`: the plan that was judged.
    pub fn note_exemptions(&mut self, planned: &PlanValue, verdict: &Verdict) {
        for (index, exemption) in planned.plan.exemptions.iter().enumerate() {
            let needed = !verdict.unneeded_exemptions.contains(&index);
            let span = self.memory.causes.get(planned.causes[exemption.cause.0 as usize]).span;
            // Those of the library are not reported, nor those that an option of a planner states for a whole plan.
            if !self.is_library(span) && planned.plan.program.is_some() {
                *self.memory.exemptions.entry(span).or_default() |= needed;
            }
        }
    }

    /// Reports as warnings the exemptions that no plan of the run needed, and forgets all exemptions.
    pub fn report_unneeded(&mut self) {
        for (span, needed) in std::mem::take(&mut self.memory.exemptions) {
            if needed {
                continue;
            }
            let name = self.shared.sources.text(span);
            let message = format!("nothing needed the exemption `{name}`");
            let diagnostic = Diagnostic::warning(code::UNNEEDED_EXEMPTION, message)
                .label(span, "not needed")
                .hint("leave it out, so that the judge may speak");
            self.add_report(diagnostic);
        }
    }

    /// Returns a line of text for each exemption of a plan and for each setting of the judge that is less strict than
    /// by default, each once, to be printed when the plan is written. `planned`: the plan; `settings`: the settings
    /// of the judge.
    pub fn excuses(&self, planned: &PlanValue, settings: &Settings) -> Vec<String> {
        let strict = self.judge_settings();
        let mut lines = Vec::new();
        if settings.unstable_for > strict.unstable_for {
            lines.push(format!("unstable_for: {}", seconds(settings.unstable_for)));
        }
        if settings.sample > strict.sample {
            lines.push(format!("sample: {}", seconds(settings.sample)));
        }
        if settings.stability != strict.stability {
            lines.push("stability: centres".to_string());
        }
        for exemption in &planned.plan.exemptions {
            let cause = &planned.plan.causes[exemption.cause.0 as usize];
            let name = exemption.kind.name();
            lines.push(format!("allows {name} ({}:{})", cause.file, cause.line));
        }
        let mut said = BTreeSet::new();
        lines.retain(|line| said.insert(line.clone()));
        lines
    }
}

fn add_label(mut diagnostic: Diagnostic, span: Span, text: String) -> Diagnostic {
    if diagnostic.labels.iter().all(|label| label.span != span) {
        diagnostic.labels.push(Label { span, text });
    }
    diagnostic
}

/// Returns the fault of a behaviour that gives no plan, at the action to blame if there is one, and at `span`. `ids`:
/// the run's number of each cause, indexed by the plan's number. `refusal`: the reason why there is none;
/// `interpreter`: the run.
pub fn refused(interpreter: &Interpreter, refusal: &Refusal, ids: &[CauseId], span: Span) -> Stop {
    let diagnostic = Diagnostic::error(refusal_code(&refusal.reason), refusal.reason.to_string());
    let diagnostic = match refusal.cause {
        Some(cause) => {
            let record = interpreter.memory.causes.get(ids[cause.0 as usize]);
            let label = with_instance("this action".to_string(), record);
            in_library(diagnostic.label(record.primary(), label), record)
        }
        None => diagnostic,
    };
    let diagnostic = match refusal.reason {
        Reason::StillTurning { .. } => {
            diagnostic.hint("say how long, `for: 5s`, or end with a command that stops the joint")
        }
        _ => diagnostic,
    };
    add_label(diagnostic, span, "planned here".to_string()).into()
}

/// Returns the error code of a refused behaviour.
fn refusal_code(reason: &Reason) -> Code {
    match reason {
        Reason::NoCommands { .. } => code::PASSIVE_JOINT,
        Reason::Jump { .. } => code::FOLLOW_JUMP,
        Reason::StillTurning { .. } => code::NOT_AT_REST,
        Reason::Aborted { .. } => code::ABORTED,
        Reason::PortTaken { .. }
        | Reason::PortFree { .. }
        | Reason::NoMate { .. }
        | Reason::NotPlanned { .. }
        | Reason::Apart { .. } => code::BAD_DOCK,
        Reason::NoTimeToStop { .. } => code::TOO_FAST,
        Reason::Limit { .. } => code::SIZE_LIMIT,
        Reason::NoSpeed { .. }
        | Reason::BadNumber { .. }
        | Reason::NeverHolds
        | Reason::NotCyclic { .. }
        | Reason::Unresolved { .. }
        | Reason::TooShort => code::BAD_ACTION,
    }
}
