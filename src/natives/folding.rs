//! What `fold` says of a plan beside the plan itself, and the fields by which it is asked.

use crate::interpret::design::Instance;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::value::{JointValue, Value};
use crate::planners::fold::objective::{Conventions, Effort, Minimise};
use crate::planners::fold::pattern::Pattern;
use crate::planners::fold::random_orders::Sample;
use crate::planners::fold::{Layout, Target};
use crate::robot::JointOwner;
use crate::units::Dimension;
use num_bigint::BigInt;
use std::rc::Rc;

const ENERGY: Dimension = Dimension::TORQUE;

/// What the planner says of its plan.
pub struct Folded {
    pub pattern: FlatPattern,
    pub layouts: BigInt,
    /// Faces that fold at the same time.
    pub steps: Vec<Vec<usize>>,
    pub effort: Effort,
    /// Of what is to be small, or of the energy, N·m.
    pub bound: f64,
    pub fewest_steps: usize,
    pub optimal: bool,
    /// What was to be small, by the least of any layout.
    pub price: f64,
    /// Roots that are as good.
    pub ties: Vec<usize>,
    /// Pairs of a layout and a root that are known to be as good.
    pub tied: u64,
    /// Work against gravity (Eq. 17) in this order, and what no order undercuts, J.
    pub lifting: f64,
    pub lifting_bound: f64,
    /// Faces whose hinges don't close, where a radius was given.
    pub too_thick: Vec<usize>,
    /// By face, kg.
    pub masses: Vec<f64>,
    pub conventions: Conventions,
    pub minimise: Minimise,
}

impl Folded {
    /// What the proof leaves open, as a part of what was to be small.
    fn gap(&self) -> f64 {
        let found = match self.minimise {
            Minimise::PeakTorque => self.effort.peak,
            _ => self.effort.energy,
        };
        // Another order may undercut the bound, which is for the leaves first.
        if self.optimal || found <= 0.0 { 0.0 } else { (1.0 - self.bound / found).max(0.0) }
    }
}

/// A layout with its target.
#[derive(Debug)]
pub struct FlatPattern {
    pub target: Target,
    pub layout: Layout,
}

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

pub fn folding_field(planned: &Rc<Planned>, folded: &Folded, field: &str) -> Value {
    let numbers = |faces: &[usize]| Value::list(faces.iter().map(|f| Value::count(*f)).collect());
    match field {
        "plan" => Value::Record(Rc::new(Record::Plan(planned.clone()))),
        "layout" => Value::Record(Rc::new(Record::Layout(planned.clone()))),
        "layouts" => Value::whole(folded.layouts.clone()),
        "energy" => Value::Quantity(folded.effort.energy, ENERGY),
        "peak_torque" => Value::Quantity(folded.effort.peak, ENERGY),
        "bound" => Value::Quantity(folded.bound, ENERGY),
        "fewest_steps" => Value::count(folded.fewest_steps),
        "gap" => Value::number(folded.gap()),
        "optimal" => Value::Bool(folded.optimal),
        "price" => Value::number(folded.price),
        "ties" => numbers(&folded.ties),
        "tied" => Value::whole(folded.tied.into()),
        "root" => Value::count(folded.pattern.layout.root),
        "order" => Value::list(folded.steps.iter().map(|step| numbers(step)).collect()),
        "lifting" => Value::Quantity(folded.lifting, ENERGY),
        "lifting_bound" => Value::Quantity(folded.lifting_bound, ENERGY),
        "too_thick" => numbers(&folded.too_thick),
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

/// The fields of an `OrderSample`.
pub const ORDER_SAMPLE: &[&str] = &["orders", "worse", "least", "mean", "greatest"];

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
