//! Operations on plans as values: one after another, and any change of one plan.

use super::interpreter::Interpreter;
use super::plan_value::PlanValue;
use super::planning::Beginning;
use super::record::Record;
use super::stop::{Eval, Stop, fault};
use super::value::Value;
use crate::behavior::ContractInterval;
use crate::plan::{self, CauseId, Change, OperationError, Plan};
use crate::source::{Span, code};
use std::rc::Rc;

impl Interpreter<'_> {
    /// Returns the plan `p ++ q` or `p ++ b`: the concatenation of two plans; a behaviour of the same robot begins in
    /// the state in which the plan before it ends. `Value::Unknown` where one of them is, or could not be planned. `a`
    /// and `b`: the two sides; `span`: the span of the whole expression.
    ///
    /// # Errors
    /// A fault where the plans do not fit together, or a behaviour can't be planned.
    pub fn join_plans(&mut self, a: &Value, b: &Value, span: Span) -> Eval<Value> {
        let Some(first) = self.plan_of(a, span)? else { return Ok(Value::Unknown) };
        let second = match b {
            Value::Behavior(behavior) => {
                let same =
                    behavior.robot.as_ref().is_some_and(|robot| Rc::ptr_eq(&robot.design, &first.robot));
                let mut beginning = Beginning::default();
                if same && let Some(tracks) = first.plan.body.tracks() {
                    beginning.start = Some(tracks.end());
                }
                self.plan_from(behavior, beginning, span)?
            }
            _ => self.plan_of(b, span)?,
        };
        let Some(second) = second else { return Ok(Value::Unknown) };
        let plan = plan::joined(&first.plan, &second.plan).map_err(|unfit| unfitting(&unfit, span))?;
        let causes = first.causes.iter().chain(&second.causes).copied().collect();
        let actions = first.actions + second.actions;
        let renamed = matches!(plan.provenance.history.last(), Some(Change::Joined { renamed, .. }) if !renamed.is_empty());
        let keeps = Rc::ptr_eq(&first.robot, &second.robot) && !renamed;
        let (at, before) = (first.plan.body.duration(), first.causes.len() as u32);
        let later = |use_: &ContractInterval| ContractInterval {
            from: use_.from + at,
            to: use_.to + at,
            cause: CauseId(use_.cause.0 + before),
            ..*use_
        };
        let more = second.contracts().iter().filter(|_| keeps).map(later);
        let uses = first.contracts().iter().copied().chain(more).collect();
        let dropped =
            first.drops_contracts() || second.drops_contracts() || !keeps && !second.contracts().is_empty();
        let joined = PlanValue::new(first.robot.clone(), first.body.clone(), plan, causes, actions)
            .with_uses(uses, dropped);
        Ok(Value::Record(Rc::new(Record::Plan(Rc::new(joined)))))
    }

    /// Returns the plan that `change` makes of a plan, as a plan of the same robot with the same causes and number of
    /// actions, not judged yet. `planned`: the plan that is changed; `kept`: the times (s) between which
    /// the uses of contracts stay, the first of which is the new beginning; `None` where none stays.
    ///
    /// # Errors
    /// A fault at `span` where `change` refuses.
    pub fn changed(
        &mut self,
        planned: &Rc<PlanValue>,
        change: impl FnOnce(&Plan) -> Result<Plan, OperationError>,
        kept: Option<(f64, f64)>,
        span: Span,
    ) -> Eval<Rc<PlanValue>> {
        let plan = change(&planned.plan).map_err(|unfit| unfitting(&unfit, span))?;
        let (robot, body) = (planned.robot.clone(), planned.body.clone());
        let within =
            |use_: &&ContractInterval| kept.is_some_and(|(from, to)| from <= use_.from && use_.to <= to);
        let begins = kept.map_or(0.0, |(from, _)| from);
        let moved = |use_: &ContractInterval| ContractInterval {
            from: use_.from - begins,
            to: use_.to - begins,
            ..*use_
        };
        let uses: Vec<ContractInterval> = planned.contracts().iter().filter(within).map(moved).collect();
        let dropped = planned.drops_contracts() || uses.len() < planned.contracts().len();
        let changed = PlanValue::new(robot, body, plan, planned.causes.clone(), planned.actions);
        Ok(Rc::new(changed.with_uses(uses, dropped)))
    }
}

fn unfitting(unfit: &OperationError, span: Span) -> Stop {
    fault(code::NO_MATCH, span, unfit.to_string(), "these do not fit together")
}
