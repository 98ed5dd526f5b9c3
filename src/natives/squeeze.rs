//! `squeeze`: the planner of lattices, as it is called.

use super::{Native, on_run};
use crate::elaborate::lattice::LatticeDesign;
use crate::interpret::call::Call;
use crate::interpret::design::{Design, DesignKind};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::plan::{Body, World};
use crate::planners::squeeze::{self, Demand, Found, Method, Profile, Refusal, Task};
use crate::robot::{Cell, Library};
use crate::source::{Diagnostic, code};
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[on_run("squeeze", 7, squeeze)];

/// What the planner says of a plan beside the plan itself.
pub struct Squeezed {
    /// Seconds.
    pub lower_bound: f64,
    pub method: Method,
    pub balanced: bool,
    pub why: String,
    /// Name and duration (s) of each stage.
    pub stages: Vec<(String, f64)>,
}

fn squeeze(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let design = call.instance(0)?.design.clone();
    let goal = call.instance(1)?.design.clone();
    let (Some((start, cell)), Some((end, other))) = (lattice(&design), lattice(&goal)) else {
        return Ok(Value::Unknown);
    };
    if cell != other {
        let message = format!("cells do not change into others: `{}` and `{}`", cell.name, other.name);
        return Err(Diagnostic::error(code::NO_WAY, message)
            .label(call.at(0), format!("of {}", cell.name))
            .label(call.at(1), format!("of {}", other.name))
            .into());
    }
    let max_force = call.positive_if(4, "the greatest contact force")?;
    let task = Task {
        from: &start.cells.places,
        to: &end.cells.places,
        method: match call.word(2) {
            Some("accordion") => Method::Accordion,
            Some("fold") => Method::Fold,
            Some("shear") => Method::Shear,
            Some("arms") => Method::Arms,
            Some("merge") => Method::Merge,
            Some("melt") => Method::Melt,
            _ => Method::Auto,
        },
        demand: match call.word(3) {
            Some("balanced") => Demand::Balanced,
            Some("paper") => Demand::Paper,
            _ => Demand::Auto,
        },
        profile: if call.word(5) == Some("trapezoid") { Profile::Trapezoid } else { Profile::BangBang },
        max_force,
        euclidean: call.word(6) == Some("euclidean"),
    };
    crate::interrupt::start_task(format!("squeezing {} to {}", design.name, goal.name));
    let found = squeeze::squeeze(cell, 0, &task).map_err(|refusal| refused(&refusal, call))?;
    let cell = cell.clone();
    Ok(planned(interpreter, call, design, cell, found))
}

fn lattice(design: &Design) -> Option<(&LatticeDesign, &Cell)> {
    let DesignKind::Lattice(lattice) = &design.kind else { return None };
    let DesignKind::Cell(cell) = &lattice.of.kind else { return None };
    Some((lattice, cell))
}

fn planned(
    interpreter: &mut Interpreter,
    call: &Call,
    design: Rc<Design>,
    cell: Cell,
    found: Found,
) -> Value {
    let Found { stages, lower_bound, method, balanced, why } = found;
    let causes = interpreter.planner_causes(call.span);
    let told = |stage: &crate::plan::Stage| (stage.name.clone(), stage.duration() * stages.time_unit);
    let squeezed =
        Squeezed { lower_bound, method, balanced, why, stages: stages.stages.iter().map(told).collect() };
    let library = Arc::new(Library { cells: vec![cell], ..Library::default() });
    // The paper's world.
    let plan = interpreter.bare_plan(
        &format!("squeeze ({})", method.name()),
        Body::Stages(stages),
        library,
        World::FREE,
        &causes,
    );
    let planned = Planned::new(design, None, plan, causes.ids, 0).with_squeezed(squeezed);
    Value::Record(Rc::new(Record::Plan(Rc::new(planned))))
}

fn refused(refusal: &Refusal, call: &Call) -> Stop {
    let cells = |n: usize| if n == 1 { "1 cell".to_string() } else { format!("{n} cells") };
    match refusal {
        Refusal::Counts { from, to } => {
            let message = format!("{} do not become {}: there are as many in the end", cells(*from), cells(*to));
            Diagnostic::error(code::NO_WAY, message)
                .label(call.at(0), cells(*from))
                .label(call.at(1), cells(*to))
                .into()
        }
        Refusal::Stiff { smallest } => {
            let part = crate::units::number(smallest.to_f64());
            Diagnostic::error(code::NO_WAY, "the cells do not shrink to half their size, as this method needs")
                .label(call.at(0), format!("these shrink to {part} of their size"))
                .hint("`method: accordion` keeps the size of cells: it takes rows and boxes to each other")
                .into()
        }
        Refusal::Solid { first, most } => {
            let index = usize::from(!first);
            let message = format!("shapes in space of more than {most} cells are not taken to others");
            Diagnostic::error(code::NOT_COVERED, message)
                .label(call.at(index), "neither flat nor a box")
                .hint("covered are all connected shapes in a plane, and boxes of any sides")
                .into()
        }
        Refusal::Method { method } => {
            let wanted = match method {
                Method::Shear => "`shear` takes a row to a column",
                Method::Arms => "`arms` takes a row of at least four cells to a column",
                Method::Fold => "`fold` takes rows to columns, and boxes to boxes whose sides differ by powers of two",
                Method::Accordion => "`accordion` takes rows and boxes to each other",
                Method::Merge => "`merge` takes shapes in a plane to each other",
                Method::Melt => "`melt` takes shapes of up to 400 cells to each other",
                Method::Auto => "no method takes the one to the other",
            };
            Diagnostic::error(code::NOT_COVERED, format!("the method does not fit these shapes: {wanted}"))
                .label(call.at(2), "this method")
                .label(call.at(0), "from here")
                .label(call.at(1), "to here")
                .hint("`method: auto`, the default, takes the fastest that fits")
                .into()
        }
        Refusal::Unbalanced { .. } => {
            Diagnostic::error(code::NOT_COVERED, "no way is known on which the angular momentum stays zero")
                .label(call.at(3), "so a free robot would be turned")
                .label(call.at(0), "from here")
                .label(call.at(1), "to here")
                .hint("`model: auto` takes one that turns little, `paper` the fastest; `p.angular_momentum` says how much")
                .into()
        }
        Refusal::TooLarge => {
            let message = "the numbers of this plan are too large to be kept exactly";
            fault(code::SIZE_LIMIT, call.span, message, "too many cells, or limits too far apart")
        }
        Refusal::Defect(what) => {
            let message = format!("the planner failed: {what}");
            fault(code::NOT_VERIFIED, call.span, message, "a defect of the planner, not of this program")
        }
    }
}
