//! The fields of a `Folding` beside those of a plan, and of what belongs to it.

use crate::interpret::design::Instance;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::value::{JointValue, Value};
use crate::planners::fold::pattern::Pattern;
use crate::planners::fold::{Report, Sample};
use crate::robot::JointOwner;
use crate::units::Dimension;
use std::rc::Rc;

const ENERGY: Dimension = Dimension::TORQUE;

/// The fields of a `Folding` beside those of a plan.
pub const FOLDING: &[&str] = &[
    "plan",
    "layout",
    "layouts",
    "energy",
    "peak_torque",
    "bound",
    "gap",
    "fewest_steps",
    "optimal",
    "price",
    "ties",
    "tied",
    "root",
    "order",
    "lifting",
    "lifting_bound",
    "too_thick",
    "robot",
    "hinges",
];

/// Reads a field of a `Folding`.
pub fn folding_field(planned: &Rc<Planned>, report: &Report, field: &str) -> Value {
    let numbers = |faces: &[usize]| Value::list(faces.iter().map(|f| Value::count(*f)).collect());
    match field {
        "plan" => Value::Record(Rc::new(Record::Plan(planned.clone()))),
        "layout" => Value::Record(Rc::new(Record::Layout(planned.clone()))),
        "layouts" => Value::whole(report.layouts.clone()),
        "energy" => Value::Quantity(report.effort.energy, ENERGY),
        "peak_torque" => Value::Quantity(report.effort.peak, ENERGY),
        "bound" => Value::Quantity(report.bound, ENERGY),
        "fewest_steps" => Value::count(report.fewest_steps),
        "gap" => Value::number(report.gap()),
        "optimal" => Value::Bool(report.optimal),
        "price" => Value::number(report.price),
        "ties" => numbers(&report.ties),
        "tied" => Value::whole(report.tied.into()),
        "root" => Value::count(report.layout.root),
        "order" => Value::list(report.steps.iter().map(|step| numbers(step)).collect()),
        "lifting" => Value::Quantity(report.lifting, ENERGY),
        "lifting_bound" => Value::Quantity(report.lifting_bound, ENERGY),
        "too_thick" => numbers(&report.too_thick),
        "robot" => Value::Instance(Instance::whole(planned.robot.clone())),
        "hinges" => {
            let layout = &report.layout;
            // The bonds of the robot stand in the order of their faces, behind the root.
            let bond = |hinge| layout.order[1..].iter().position(|face| layout.hinge[*face] == Some(hinge));
            let owners = layout.hinges().into_iter().filter_map(bond).map(JointOwner::Bond);
            let joint =
                |owner| JointValue { robot: planned.robot.clone(), owner, dimension: Dimension::ANGLE };
            Value::list(owners.map(|owner| Value::Joint(joint(owner))).collect())
        }
        _ => Value::Unknown,
    }
}

/// The fields of an `OrderSample`.
pub const ORDER_SAMPLE: &[&str] = &["orders", "worse", "least", "mean", "greatest"];

/// Reads a field of an `OrderSample`.
pub fn sample_field(sample: &Sample, field: &str) -> Value {
    match field {
        "orders" => Value::whole(sample.orders.into()),
        "worse" => Value::number(sample.worse as f64 / sample.orders as f64),
        "least" => Value::Quantity(sample.least, ENERGY),
        "mean" => Value::Quantity(sample.mean, ENERGY),
        "greatest" => Value::Quantity(sample.greatest, ENERGY),
        _ => Value::Unknown,
    }
}

/// Reads a field of a `Layout`.
pub fn layout_field(report: &Report, field: &str) -> Value {
    let Report { target, layout, .. } = report;
    let pair = |[a, b]: [usize; 2]| Value::list(vec![Value::count(a), Value::count(b)]);
    match field {
        "panels" => Value::count(target.faces.len()),
        "hinges" => {
            let hinges = layout.hinges();
            Value::list(hinges.into_iter().map(|hinge| pair(target.hinges[hinge].faces)).collect())
        }
        "overlaps" => Value::list(Pattern::of(target, layout).overlaps().into_iter().map(pair).collect()),
        _ => Value::Unknown,
    }
}
