//! `fold`, `random_orders` and `compare_layouts`.

use super::fold_design::Joined;
use super::fold_refusal::diagnostic;
use super::fold_supply::{self, Passive, Sheet, Supply};
use super::folding::{LayoutComparison, OrderSample, pair};
use super::{Native, fold_surface};
use crate::interpret::argument::{Auto, Choice, Positive, WordOr, arguments, parameters};
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::plan::{ObjectiveValue, Plan, World};
use crate::planners::fold::{self, Count, MassModel, Method, Minimise, Problem, Sequence, Settings};
use crate::planners::{RequestedProgress, Solution};
use std::any::Any;
use std::rc::Rc;

// The names of arguments that diagnostics of `fold` are about.
/// The name of `fold`'s parameter for the shape to fold into.
pub(super) const TARGET: &str = "target";
/// The name of `fold`'s parameter for the panel module.
pub(super) const MODULE: &str = "module";
/// The name of `fold`'s parameter for the face that stays at rest.
pub(super) const ROOT: &str = "root";
/// The name of `fold`'s parameter for the method by which layouts are searched.
pub(super) const METHOD: &str = "method";
/// The name of `fold`'s parameter for the duration of a step.
pub(super) const STEP: &str = "step";
/// The name of `fold`'s parameter for the order in which hinges fold.
pub(super) const SEQUENCE: &str = "sequence";
/// The name of `fold`'s parameter for a prescribed layout, the hinges that fold.
pub(super) const HINGES: &str = "hinges";

/// The built-ins `fold`, `random_orders` and `compare_layouts`: the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("fold", Arguments::PARAMETERS, fold),
    Native::on_run("random_orders", parameters![of: &Value, orders: usize, seed: usize], random_orders),
    Native::on_run("compare_layouts", parameters![of: &Value, most: usize, seed: usize], compare_layouts),
    Native::pure("LayoutComparison.hinges", parameters![self: &Value, layout: usize], hinges),
];

arguments! {
    /// The arguments of `fold`.
    struct Arguments<'c> {
        target: &'c Value,
        module: &'c Value,
        root: WordOr<Auto, usize> as "a face",
        method: Method,
        step: WordOr<Auto, Positive> as "the time of a step",
        seed: WordOr<Auto, usize> as "a seed",
        budget: usize as "a budget",
        minimise: Minimise,
        inertia: MassModel,
        gravity: Gravity,
        count: Count,
        sequence: Sequence,
        passive: &'c [Value],
        passive_module: Option<&'c Rc<Instance>>,
        hinge_radius: Option<Positive> as "the radius of the hinges",
        hinges: Option<&'c [Value]>,
    }
}

/// Standard gravity or none.
#[derive(Clone, Copy, PartialEq)]
enum Gravity {
    Off,
    On,
}

impl Choice for Gravity {
    const WORDS: &'static [(&'static str, Gravity)] = &[("off", Gravity::Off), ("on", Gravity::On)];
}

impl Choice for Method {
    const WORDS: &'static [(&'static str, Method)] =
        &[("exact", Method::Exact), ("heuristic", Method::Heuristic), ("enumerate", Method::Enumerate)];
}

impl Choice for Minimise {
    const WORDS: &'static [(&'static str, Minimise)] =
        &[("energy", Minimise::Energy), ("peak_torque", Minimise::PeakTorque), ("steps", Minimise::Steps)];
}

impl Choice for MassModel {
    const WORDS: &'static [(&'static str, MassModel)] =
        &[("lamina", MassModel::Lamina), ("prism", MassModel::Prism), ("point", MassModel::Point)];
}

impl Choice for Count {
    const WORDS: &'static [(&'static str, Count)] = &[("moving", Count::Moving), ("all", Count::All)];
}

impl Choice for Sequence {
    const WORDS: &'static [(&'static str, Sequence)] = &[
        ("auto", Sequence::Auto),
        ("leaves_first", Sequence::LeavesFirst),
        ("root_first", Sequence::RootFirst),
        ("least_work", Sequence::LeastWork),
        ("least_energy", Sequence::LeastEnergy),
    ];
}

/// The greatest number of orders that are compared in one call.
const ORDERS_MAX: usize = 100_000;

/// The greatest number of hinges of all layouts that are compared in one call, together.
const HINGES_MAX: usize = 10_000_000;

/// Runs `fold`: reads the shape and its panels, plans, and returns the plan with the planner's report and
/// verdict.
fn fold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let arguments = Arguments::read(call)?;
    let mut supply = Supply::of(interpreter, call, MODULE, arguments.module)?;
    let target = fold_surface::target(call, TARGET, arguments.target)?;
    let passive = Passive { faces: arguments.passive, module: arguments.passive_module };
    let (sheet, target) = fold_supply::panels(interpreter, &mut supply, &passive, target)?;
    let problem = problem(call, &arguments, target, &sheet)?;
    let settings = Settings { judge: interpreter.judge_settings(), ..settings(interpreter, &arguments) };
    let causes = interpreter.planner_causes(call.span);
    let Solution { body, program, report } = fold::plan(&problem, &settings, &mut RequestedProgress)
        .map_err(|refusal| diagnostic(interpreter, call, &causes.ids, &refusal))?;
    let joined =
        Joined { target: &problem.target, layout: &report.layout, designs: &sheet.designs, span: call.span };
    let (design, robot) = joined.design(&problem.panels);
    let bare = interpreter.bare_plan("fold", body, problem.panels.library.clone(), report.world, &causes);
    let mut plan = Plan { program, ..bare };
    plan.provenance.seed = Some(settings.seed);
    if settings.minimise == Minimise::Energy {
        let stated = |value| Some(ObjectiveValue::FoldingEnergy(value));
        plan.provenance.reached = stated(report.effort.energy);
        plan.provenance.bound = stated(report.bound).filter(|_| report.bound > 0.0);
    }
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids.clone(), report.actions);
    planned.remember_verdict(report.verdict.clone());
    let planned = planned.with_report(report);
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

fn problem(call: &Call, arguments: &Arguments, target: fold::Target, sheet: &Sheet) -> Eval<Problem> {
    Ok(Problem {
        target,
        panels: sheet.panels.clone(),
        root: match arguments.root {
            WordOr::Word(Auto) => None,
            WordOr::Value(root) => Some(root),
        },
        gravity: match arguments.gravity {
            Gravity::Off => 0.0,
            Gravity::On => World::default().gravity,
        },
        hinges: arguments.hinges.map(|hinges| pairs(call, hinges)).transpose()?,
    })
}

fn settings(interpreter: &Interpreter, arguments: &Arguments) -> Settings {
    Settings {
        method: arguments.method,
        minimise: arguments.minimise,
        sequence: arguments.sequence,
        step: match arguments.step {
            WordOr::Word(Auto) => None,
            WordOr::Value(Positive(step)) => Some(step),
        },
        inertia: arguments.inertia,
        count: arguments.count,
        hinge_radius: arguments.hinge_radius.map(|Positive(radius)| radius),
        seed: interpreter.seed(arguments.seed),
        budget: arguments.budget as u64,
        ..Settings::default()
    }
}

/// Returns the hinges of a layout as pairs of faces, by index.
///
/// # Errors
/// A fault where an element is no pair of whole numbers.
fn pairs(call: &Call, hinges: &[Value]) -> Eval<Vec<[usize; 2]>> {
    let index = |value: &Value| match value {
        Value::Int(face) => usize::try_from(*face).ok(),
        _ => None,
    };
    let pair = |pair: &Value| {
        let Value::List(pair) = pair else { return None };
        <[usize; 2]>::try_from(pair.iter().filter_map(index).collect::<Vec<_>>()).ok()
    };
    let read = |value| pair(value).ok_or_else(|| call.refuse(HINGES, "a hinge is a pair of faces"));
    hinges.iter().map(read).collect()
}

/// Returns the plan whose report a call is about.
fn planned<'c>(call: &'c Call) -> Option<&'c Rc<PlanValue>> {
    let Value::Record(record) = call.arg("of") else { return None };
    if let Record::Plan(planned) = &**record { Some(planned) } else { None }
}

/// Runs `compare_layouts` on the folding `of`.
fn compare_layouts(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let folded = planned(call).and_then(|planned| planned.report::<fold::Report>());
    let Some(folded) = folded else { return Ok(Value::Unknown) };
    let most = call.count("most", "how many layouts")?;
    let greatest = HINGES_MAX / folded.target.faces.len();
    if most == 0 || most > greatest {
        return Err(call.refuse("most", format!("from 1 to {greatest} layouts are compared")));
    }
    let seed = call.count("seed", "a seed")? as u64;
    crate::interrupt::start_task("comparing layouts".to_owned());
    let found = folded.compare_layouts(most, seed, &mut RequestedProgress);
    Ok(Value::Record(Rc::new(Record::Native(Rc::new(LayoutComparison(found))))))
}

/// Runs `hinges` of a comparison of layouts.
fn hinges(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Value::Record(record) = call.arg("self") else { return Ok(Value::Unknown) };
    let Record::Native(record) = &**record else { return Ok(Value::Unknown) };
    let record: &dyn Any = &**record;
    let Some(LayoutComparison(sample)) = record.downcast_ref() else {
        return Ok(Value::Unknown);
    };
    let layout = call.count("layout", "a layout")?;
    let Some(hinges) = sample.layouts.get(layout) else {
        let count = sample.layouts.len();
        return Err(call.refuse("layout", format!("there are {count} layouts, counted from 0")));
    };
    Ok(Value::list(hinges.iter().copied().map(pair).collect()))
}

fn random_orders(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let folded = planned(call).and_then(|planned| planned.report::<fold::Report>());
    let Some(folded) = folded else { return Ok(Value::Unknown) };
    let orders = call.count("orders", "how many orders")?;
    if orders == 0 || orders > ORDERS_MAX {
        return Err(call.refuse("orders", format!("from 1 to {ORDERS_MAX} orders are compared")));
    }
    let seed = call.count("seed", "a seed")? as u64;
    crate::interrupt::start_task(format!("comparing {orders} orders"));
    let found = folded.random_orders(orders as u64, seed, &mut RequestedProgress);
    Ok(Value::Record(Rc::new(Record::Native(Rc::new(OrderSample(found))))))
}
