//! `fold` and `random_orders`.

use super::fold_design::Joined;
use super::fold_refusal::diagnostic;
use super::fold_supply::{self, Sheet, Supply};
use super::folding::OrderSample;
use super::{Native, fold_surface, on_run};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::plan::{Bound, Plan, World};
use crate::planners::fold::{self, Count, MassModel, Method, Minimise, Problem, Sequence, Settings};
use crate::planners::{RequestedProgress, Solution};
use std::rc::Rc;

/// The arguments of `fold`, in the order of the declaration.
pub(super) const TARGET: usize = 0;
pub(super) const MODULE: usize = 1;
pub(super) const ROOT: usize = 2;
pub(super) const METHOD: usize = 3;
pub(super) const STEP: usize = 4;
const SEED: usize = 5;
const BUDGET: usize = 6;
const MINIMISE: usize = 7;
const INERTIA: usize = 8;
const GRAVITY: usize = 9;
const COUNT: usize = 10;
pub(super) const SEQUENCE: usize = 11;
const PASSIVE: usize = 12;
const PASSIVE_MODULE: usize = 13;
const HINGE_RADIUS: usize = 14;
pub(super) const HINGES: usize = 15;
const ARGUMENTS: usize = 16;

pub(super) const TABLE: &[Native] =
    &[on_run("fold", ARGUMENTS, fold), on_run("random_orders", 3, random_orders)];

/// The greatest number of orders that are compared in one call.
const ORDERS_MAX: usize = 100_000;

fn fold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut supply = Supply::of(interpreter, call, MODULE)?;
    let target = fold_surface::target(call, TARGET)?;
    let shape = [TARGET, PASSIVE, PASSIVE_MODULE];
    let (sheet, target) = fold_supply::panels(interpreter, &mut supply, shape, target)?;
    let problem = problem(call, target, &sheet)?;
    let settings = Settings { judge: interpreter.judge_settings(), ..settings(call)? };
    let causes = interpreter.planner_causes(call.span);
    let Solution { body, program, report } = fold::plan(&problem, &settings, &mut RequestedProgress)
        .map_err(|refusal| diagnostic(interpreter, call, &causes.ids, &refusal))?;
    let joined =
        Joined { target: &problem.target, layout: &report.layout, designs: &sheet.designs, span: call.span };
    let (design, robot) = joined.design(&problem.panels);
    let bare = interpreter.bare_plan("fold", body, problem.panels.library.clone(), report.world, &causes);
    let mut plan = Plan { program, ..bare };
    plan.provenance.seed = Some(settings.seed);
    let energetic = settings.minimise == Minimise::Energy && report.bound > 0.0;
    plan.provenance.bound = energetic.then_some(Bound::FoldingEnergy(report.bound));
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids.clone(), report.actions);
    planned.remember_verdict(report.verdict.clone());
    let planned = planned.with_report(report);
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

fn problem(call: &Call, target: fold::Target, sheet: &Sheet) -> Eval<Problem> {
    let root = match call.arg(ROOT) {
        Value::Word(_) => None,
        _ => Some(call.count(ROOT, "a face")?),
    };
    let gravity = if call.word(GRAVITY) == Some("on") { World::default().gravity } else { 0.0 };
    let hinges = if call.is_missing(HINGES) { None } else { Some(pairs(call)?) };
    Ok(Problem { target, panels: sheet.panels.clone(), root, gravity, hinges })
}

fn settings(call: &Call) -> Eval<Settings> {
    Ok(Settings {
        step: match call.arg(STEP) {
            Value::Word(_) => None,
            _ => Some(call.positive(STEP, "the time of a step")?),
        },
        inertia: match call.word(INERTIA) {
            Some("prism") => MassModel::Prism,
            Some("point") => MassModel::Point,
            _ => MassModel::Lamina,
        },
        count: if call.word(COUNT) == Some("all") { Count::All } else { Count::Moving },
        hinge_radius: call.positive_if(HINGE_RADIUS, "the radius of the hinges")?,
        seed: call.count(SEED, "a seed")? as u64,
        budget: call.count(BUDGET, "a budget")? as u64,
        minimise: match call.word(MINIMISE) {
            Some("peak_torque") => Minimise::PeakTorque,
            Some("steps") => Minimise::Steps,
            _ => Minimise::Energy,
        },
        sequence: match call.word(SEQUENCE) {
            Some("root_first") => Sequence::RootFirst,
            Some("least_work") => Sequence::LeastWork,
            Some("least_energy") => Sequence::LeastEnergy,
            _ => Sequence::LeavesFirst,
        },
        method: match call.word(METHOD) {
            Some("enumerate") => Method::Enumerate,
            Some("heuristic") => Method::Heuristic,
            _ => Method::Exact,
        },
        ..Settings::default()
    })
}

/// Reads the hinges of a layout as pairs of faces.
fn pairs(call: &Call) -> Eval<Vec<[usize; 2]>> {
    let index = |value: &Value| match value {
        Value::Int(face) => usize::try_from(*face).ok(),
        _ => None,
    };
    let pair = |pair: &Value| {
        let Value::List(pair) = pair else { return None };
        <[usize; 2]>::try_from(pair.iter().filter_map(index).collect::<Vec<_>>()).ok()
    };
    let pairs = call
        .list(HINGES)?
        .iter()
        .map(|value| pair(value).ok_or_else(|| call.refuse(HINGES, "a hinge is a pair of faces")));
    pairs.collect()
}

fn random_orders(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Value::Record(record) = call.arg(0) else { return Ok(Value::Unknown) };
    let Record::Plan(planned) = &**record else { return Ok(Value::Unknown) };
    let Some(folded) = planned.report::<fold::Report>() else { return Ok(Value::Unknown) };
    let orders = call.count(1, "how many orders")?;
    if orders == 0 || orders > ORDERS_MAX {
        return Err(call.refuse(1, format!("from 1 to {ORDERS_MAX} orders are compared")));
    }
    let seed = call.count(2, "a seed")? as u64;
    crate::interrupt::start_task(format!("comparing {orders} orders"));
    let found = folded.random_orders(orders as u64, seed, &mut RequestedProgress);
    Ok(Value::Record(Rc::new(Record::Native(Rc::new(OrderSample(found))))))
}
