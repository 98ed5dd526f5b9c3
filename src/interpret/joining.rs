//! Plans out of plans: one after another, backwards, a stretch of one.

use super::interpreter::Interpreter;
use super::planning::Planned;
use super::stop::Eval;
use super::value::Value;
use crate::plan::Plan;
use crate::source::Span;
use std::rc::Rc;

impl Interpreter<'_> {
    /// `p ++ q`, `p ++ b`
    pub fn join_plans(&mut self, _a: &Value, _b: &Value, span: Span) -> Eval<Value> {
        Err(super::call::not_yet("++".into(), span))
    }

    /// A plan of the same robot made from another.
    pub fn changed(
        &mut self,
        planned: &Rc<Planned>,
        change: impl FnOnce(&Plan) -> Result<Plan, String>,
        span: Span,
    ) -> Eval<Rc<Planned>> {
        let plan = change(&planned.plan)
            .map_err(|why| super::stop::fault(crate::source::code::NO_MATCH, span, why.clone(), why))?;
        let (robot, body) = (planned.robot.clone(), planned.body.clone());
        Ok(Rc::new(Planned::new(robot, body, plan, planned.causes.clone(), planned.actions)))
    }
}
