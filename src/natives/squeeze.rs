//! `squeeze`: the planner of lattices, as it is called.

use super::Native;
use crate::geometry::Vec3;
use crate::interpret::argument::{Choice, Positive, arguments};
use crate::interpret::cells::Cells;
use crate::interpret::design::{Design, DesignKind, Instance, LatticeDesign};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::plan::{Dynamics, World};
use crate::planners::squeeze::{
    self, AnchorFault, Method, ModelChoice, Norm, Problem, Profile, Refusal, Report, Settings,
};
use crate::planners::{RequestedProgress, Solution};
use crate::robot::{Cell, Library};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;
use std::sync::Arc;

/// The built-in `squeeze`: its key with its parameters and its Rust function.
pub const TABLE: &[Native] = &[Native::on_run("squeeze", SqueezeArguments::PARAMETERS, squeeze)];

arguments! {
    /// The arguments of `squeeze`.
    struct SqueezeArguments<'c> {
        from: &'c Rc<Instance>,
        to: &'c Rc<Instance>,
        method: Method,
        model: ModelChoice,
        max_force: Option<Positive> as "the greatest contact force",
        profile: Profile,
        norm: Norm,
        fixed: Option<&'c Rc<Cells>>,
        obstacles: Option<&'c Rc<Cells>>,
        sides: Vec3,
    }
}

impl Choice for Method {
    const WORDS: &'static [(&'static str, Method)] = &[
        ("auto", Method::Auto),
        ("accordion", Method::Accordion),
        ("fold", Method::Fold),
        ("shear", Method::Shear),
        ("arms", Method::Arms),
        ("merge", Method::Merge),
        ("push", Method::Push),
        ("melt", Method::Melt),
        ("spin", Method::Spin),
        ("tunnel", Method::Tunnel),
    ];
}

impl Choice for ModelChoice {
    const WORDS: &'static [(&'static str, ModelChoice)] =
        &[("auto", ModelChoice::Auto), ("balanced", ModelChoice::Balanced), ("paper", ModelChoice::Paper)];
}

impl Choice for Profile {
    const WORDS: &'static [(&'static str, Profile)] =
        &[("bang_bang", Profile::BangBang), ("trapezoid", Profile::Trapezoid)];
}

impl Choice for Norm {
    const WORDS: &'static [(&'static str, Norm)] =
        &[("each_axis", Norm::EachAxis), ("euclidean", Norm::Euclidean)];
}

/// Runs `squeeze`: plans between two lattices of equal cells.
fn squeeze(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let SqueezeArguments { from, to, method, model, max_force, profile, norm, fixed, obstacles, sides } =
        SqueezeArguments::read(call)?;
    let (design, goal) = (from.design.clone(), to.design.clone());
    let (Some((start, cell)), Some((end, other))) = (lattice(&design), lattice(&goal)) else {
        return Ok(Value::Unknown);
    };
    if cell != other {
        let message = format!("cells do not change into others: `{}` and `{}`", cell.name, other.name);
        return Err(Diagnostic::error(code::NO_WAY, message)
            .label(call.at("from"), format!("of {}", cell.name))
            .label(call.at("to"), format!("of {}", other.name))
            .into());
    }
    let problem = Problem {
        cell: cell.clone(),
        start: start.cells.positions.clone(),
        goal: end.cells.positions.clone(),
        fixed: fixed.map_or_else(Vec::new, |cells| cells.positions.clone()),
        obstacles: obstacles.map_or_else(Vec::new, |cells| cells.positions.clone()),
        sides: sides.into(),
    };
    let max_force = max_force.map(|force| force.0);
    let settings = Settings { method, model, profile, max_force, norm };
    crate::interrupt::start_task(format!("squeezing {} to {}", design.name, goal.name));
    let solution = squeeze::plan(&problem, &settings, &mut RequestedProgress)
        .map_err(|refusal| refused(&refusal, cell.slides, call))?;
    Ok(planned(interpreter, call, (design, &goal.name), problem.cell, solution))
}

fn lattice(design: &Design) -> Option<(&LatticeDesign, &Cell)> {
    let DesignKind::Lattice(lattice) = &design.kind else { return None };
    let DesignKind::Cell(cell) = &lattice.of.kind else { return None };
    Some((lattice, cell))
}

fn planned(
    interpreter: &mut Interpreter,
    call: &Call,
    (design, goal): (Rc<Design>, &str),
    cell: Cell,
    solution: Solution<Report>,
) -> Value {
    let causes = interpreter.planner_causes(call.span);
    let library = Arc::new(Library { cells: vec![cell], ..Library::default() });
    let planner = format!("squeeze ({})", solution.report.method.name());
    // The paper's world.
    let mut plan = interpreter.bare_plan(&planner, solution.body, library, World::FREE, &causes);
    plan.provenance.shapes = Some((design.name.to_string(), goal.to_string()));
    let planned = PlanValue::new(design, None, plan, causes.ids, 0).with_report(solution.report);
    Value::Record(Rc::new(Record::Plan(Rc::new(planned))))
}

/// Returns the fault of a refusal, at the arguments that it is about; `slides`: whether the cells do.
fn refused(refusal: &Refusal, slides: bool, call: &Call) -> Stop {
    let cells = |n: usize| if n == 1 { "1 cell".to_string() } else { format!("{n} cells") };
    match refusal {
        Refusal::Counts { from, to } => Diagnostic::error(code::NO_WAY, refusal.to_string())
            .label(call.at("from"), cells(*from))
            .label(call.at("to"), cells(*to))
            .into(),
        Refusal::Stiff { smallest } => {
            let part = crate::units::number(smallest.to_f64());
            let refused = Diagnostic::error(code::NO_WAY, refusal.to_string())
                .label(call.at("from"), format!("these shrink to {part} of their size"));
            let keeps = "`method: accordion` keeps the size of cells: it takes rows and boxes to each other";
            let refused = if slides { refused.hint(keeps) } else { refused };
            refused.into()
        }
        Refusal::Docked { .. } => Diagnostic::error(code::NO_WAY, refusal.to_string())
            .label(call.at("method"), "a method for cells that slide")
            .label(call.at("from"), "of cells with `slides false`")
            .hint("`method: tunnel`, which `auto` takes of such cells, is for shapes of blocks of 2 × 2 × 2 cells")
            .into(),
        Refusal::Blocks { first, .. } => {
            let refused = Diagnostic::error(code::NO_WAY, refusal.to_string());
            let at = call.at(if *first { "from" } else { "to" });
            let refused = if slides {
                refused.label(at, "`tunnel` moves whole blocks")
            } else {
                refused.label(at, "of cells with `slides false`, which move as whole blocks only")
            };
            refused
                .hint("`enlarged(cells)` makes a block of 2 × 2 × 2 cells of each cell of an arrangement")
                .into()
        }
        Refusal::TooMany { .. } => Diagnostic::error(code::NOT_COVERED, refusal.to_string())
            .label(call.at("from"), "too many")
            .hint("fewer cells, or parts of the shapes one after another, may be taken to each other")
            .into(),
        Refusal::Solid { first, .. } => Diagnostic::error(code::NOT_COVERED, refusal.to_string())
            .label(call.at(if *first { "from" } else { "to" }), "neither flat nor a box")
            .hint("covered are all connected shapes in a plane, boxes of any sides, and shapes in space that fill a good part of their bounding box")
            .into(),
        Refusal::Method { .. } => Diagnostic::error(code::NOT_COVERED, refusal.to_string())
            .label(call.at("method"), "this method")
            .label(call.at("from"), "from here")
            .label(call.at("to"), "to here")
            .hint("`method: auto`, the default, takes the fastest that fits")
            .into(),
        Refusal::Unbalanced { .. } => Diagnostic::error(code::NOT_COVERED, refusal.to_string())
            .label(call.at("model"), "so a free robot would be turned")
            .label(call.at("from"), "from here")
            .label(call.at("to"), "to here")
            .hint("between shapes in one plane, of up to 400 cells, `spin` mostly knows one: both need two cells at their ends that can slip into cells beside them, and some between these")
            .hint("`model: auto` takes one that turns little, `paper` the fastest; `p.angular_momentum` says how much")
            .into(),
        Refusal::Budget => Diagnostic::error(code::NOT_COVERED, refusal.to_string())
            .label(call.at("from"), "from here")
            .label(call.at("to"), "to here")
            .hint("shapes that are alike, smaller or thicker take fewer stages; shapes between may be gone through one after another")
            .into(),
        Refusal::Anchor(fault) => anchor_refused(*fault, call),
        Refusal::Side { .. } => Diagnostic::error(code::NO_WAY, refusal.to_string())
            .label(call.at("sides"), "to these")
            .label(call.at("from"), "of such cells")
            .into(),
        Refusal::FixedSides => Diagnostic::error(code::NO_WAY, refusal.to_string())
            .label(call.at("sides"), "to be drawn together to these")
            .label(call.at("fixed"), "these stay as they are")
            .into(),
        Refusal::TooLarge => {
            let hint = "too many cells, or limits too far apart";
            fault(code::SIZE_LIMIT, call.span, refusal.to_string(), hint)
        }
        Refusal::Cancelled => Stop::Halt,
        Refusal::Defect(_) => {
            let hint = "a defect of the planner, not of this program";
            fault(code::NOT_VERIFIED, call.span, refusal.to_string(), hint)
        }
    }
}

/// Returns the fault of fixed cells and obstacles that leave no way, at the arguments that it is about.
fn anchor_refused(fault: AnchorFault, call: &Call) -> Stop {
    let message = fault.to_string();
    match fault {
        AnchorFault::Floating => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("obstacles"), "around a robot that floats")
            .hint("`fixed:` are cells of both shapes that stay where they are, such as `fixed: row(1)`"),
        AnchorFault::NotThere { at_start, .. } => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("fixed"), "these are to stay")
            .label(call.at(if at_start { "from" } else { "to" }), "not all are here")
            .hint("with fixed cells both shapes stand where they are drawn: the last line of a text is at y = 0"),
        AnchorFault::Occupied { at_start, .. } => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("obstacles"), "these stand fast")
            .label(call.at(if at_start { "from" } else { "to" }), "not all of this is free")
            .hint("with obstacles both shapes stand where they are drawn: the last line of a text is at y = 0"),
        AnchorFault::Method(_) => Diagnostic::error(code::NOT_COVERED, message)
            .label(call.at("method"), "this method")
            .hint("`method: push`, or `auto`, the default, lets cells stand fast; so does `tunnel`"),
        AnchorFault::Balanced => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("model"), "asked of the robot alone")
            .label(call.at("fixed"), "held here"),
        AnchorFault::Beside { .. } => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("from"), "these blocks")
            .label(call.at("to"), "and these")
            .hint("with fixed cells both shapes stand where they are drawn: draw one of them a cell further"),
        AnchorFault::NoWay => Diagnostic::error(code::NOT_COVERED, message)
            .label(call.at("from"), "from here")
            .label(call.at("to"), "to here")
            .label(call.at("fixed"), "while these stay")
            .hint("fewer fixed cells or obstacles, or shapes in between, may let one be found"),
    }
    .into()
}

impl ReportFields for Report {
    const FIELDS: &'static [ReportField<Report>] = &[
        ("lower_bound", |_, _, report| Value::time(report.lower_bound)),
        ("ratio", |_, plan, report| {
            let duration = plan.plan.body.duration();
            Value::number(if report.lower_bound > 0.0 { duration / report.lower_bound } else { 1.0 })
        }),
        ("gap", |_, plan, report| {
            let part = report.lower_bound / plan.plan.body.duration();
            Value::number(if part < 1.0 { 1.0 - part } else { 0.0 })
        }),
        ("peak_force", |i, plan, _| Value::Quantity(dynamics(i, plan).peak_force, Dimension::FORCE)),
        ("peak_speed", |i, plan, _| Value::Quantity(dynamics(i, plan).peak_speed, Dimension::SPEED)),
        ("peak_energy", |i, plan, _| Value::Quantity(dynamics(i, plan).peak_energy, Dimension::ENERGY)),
        ("angular_momentum", |i, plan, _| {
            Value::Quantity(dynamics(i, plan).angular_momentum, Dimension::ANGULAR_MOMENTUM)
        }),
        ("balanced", |_, _, report| Value::Bool(report.balanced)),
        ("method", |_, _, report| Value::text(report.method.name())),
        ("why", |_, _, report| Value::text(report.why.clone())),
        ("stages", |_, _, report| {
            let line = |(name, duration): &(String, f64)| {
                Value::text(format!("{name}: {}", quantity(*duration, Dimension::TIME)))
            };
            Value::list(report.stages.iter().map(line).collect())
        }),
    ];
}

/// Returns the greatest dynamic quantities of a plan, as the judge finds them.
fn dynamics(interpreter: &mut Interpreter, plan: &PlanValue) -> Dynamics {
    let settings = interpreter.judge_settings();
    interpreter.judge(plan, settings, None).ok().and_then(|verdict| verdict.dynamics).unwrap_or_default()
}
