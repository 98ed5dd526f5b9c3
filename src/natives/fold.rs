//! `fold`: the planner of folding, as it is called.

use super::fold_clear;
use super::fold_method::Question;
use super::fold_options::{ARGUMENTS, MODULE, Options, PASSIVE, PASSIVE_MODULE, TARGET};
use super::fold_panel;
use super::fold_plan::Task;
use super::fold_supply::{self, Supply};
use super::{Native, on_run};
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::planners::fold::objective::Objective;
use crate::planners::fold::random_orders;
use std::rc::Rc;

pub const TABLE: &[Native] = &[on_run("fold", ARGUMENTS, fold), on_run("random_orders", 3, random_orders)];

/// More orders are not compared at a time.
const ORDERS_MAX: usize = 100_000;

fn fold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut supply = Supply::of(interpreter, call, MODULE)?;
    let target = fold_panel::target(call, TARGET)?;
    let (panels, target) =
        fold_supply::panels(interpreter, &mut supply, [TARGET, PASSIVE, PASSIVE_MODULE], target)?;
    let options = Options::of(call, &panels.weakest, &target)?;
    let must = fold_clear::must_hinge(call, &target, &panels)?;
    crate::interrupt::start_task(format!("folding {} panels", target.faces.len()));
    let objective = Objective::new(&target, panels.masses.clone(), options.conventions, options.minimise);
    let question =
        Question { call, target: &target, objective: &objective, options: &options, panel: &panels.weakest };
    let found = question.answer()?;
    Task { question, panels: &panels, must }.plan(interpreter, &found)
}

fn random_orders(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Value::Record(record) = call.arg(0) else { return Ok(Value::Unknown) };
    let Record::Plan(planned) = &**record else { return Ok(Value::Unknown) };
    let Some(folded) = &planned.folded else { return Ok(Value::Unknown) };
    let orders = call.count(1, "how many orders")?;
    if orders == 0 || orders > ORDERS_MAX {
        return Err(call.refuse(1, format!("from 1 to {ORDERS_MAX} orders are compared")));
    }
    let seed = call.count(2, "a seed")? as u64;
    crate::interrupt::start_task(format!("comparing {orders} orders"));
    let pattern = &folded.pattern;
    let objective =
        Objective::new(&pattern.target, folded.masses.clone(), folded.conventions, folded.minimise);
    let takes = |steps: &[Vec<usize>]| objective.effort(&pattern.layout, steps).energy;
    let found = random_orders::sample(&pattern.layout, orders as u64, seed, folded.effort.energy, takes);
    Ok(Value::Record(Rc::new(Record::Orders(found))))
}
