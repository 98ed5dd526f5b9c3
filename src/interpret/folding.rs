//! What `fold` says of a plan beside the plan itself, and the fields by which it is asked.

use super::design::Instance;
use super::planning::Planned;
use super::record::Record;
use super::value::{JointValue, Value};
use crate::planners::fold::pattern::Pattern;
use crate::planners::fold::{Layout, Target};
use crate::robot::JointOwner;
use crate::units::Dimension;
use num_bigint::BigInt;
use std::rc::Rc;

const ENERGY: Dimension = Dimension::TORQUE;

/// What the planner says of a plan beside the plan itself.
pub struct Folded {
    pub pattern: FlatPattern,
    pub layouts: BigInt,
    pub energy: f64,
    pub bound: f64,
    pub optimal: bool,
    pub ties: Vec<usize>,
    /// Faces that fold at the same time.
    pub steps: Vec<Vec<usize>>,
}

/// A layout with its target.
#[derive(Debug)]
pub struct FlatPattern {
    pub target: Target,
    pub layout: Layout,
}

/// The fields of a `Folding` beside those of a plan.
pub const FOLDING: &[&str] =
    &["plan", "layout", "layouts", "energy", "bound", "optimal", "ties", "root", "order", "robot", "hinges"];

pub fn folding_field(planned: &Rc<Planned>, folded: &Folded, field: &str) -> Value {
    let numbers = |faces: &[usize]| Value::list(faces.iter().map(|f| Value::count(*f)).collect());
    match field {
        "plan" => Value::Record(Rc::new(Record::Plan(planned.clone()))),
        "layout" => Value::Record(Rc::new(Record::Layout(planned.clone()))),
        "layouts" => Value::whole(folded.layouts.clone()),
        "energy" => Value::Quantity(folded.energy, ENERGY),
        "bound" => Value::Quantity(folded.bound, ENERGY),
        "optimal" => Value::Bool(folded.optimal),
        "ties" => numbers(&folded.ties),
        "root" => Value::count(folded.pattern.layout.root),
        "order" => Value::list(folded.steps.iter().map(|step| numbers(step)).collect()),
        "robot" => Value::Instance(Instance::whole(planned.robot.clone())),
        "hinges" => {
            let layout = &folded.pattern.layout;
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

pub fn layout_field(pattern: &FlatPattern, field: &str) -> Value {
    let FlatPattern { target, layout } = pattern;
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
