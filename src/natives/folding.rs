//! The records of folding: the fields of a `Folding` beside those of a plan, `Layout`,
//! `HingeStop`, `OrderSample` and `LayoutComparison`.

use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::record::{Field, NativeRecord, Record, field_names, read_field};
use crate::interpret::value::{JointValue, Value};
use crate::planners::fold::pattern::Pattern;
use crate::planners::fold::{LayoutSample, Report, Sample, Stop};
use crate::robot::JointOwner;
use crate::units::{Dimension, quantity};
use std::rc::Rc;

impl ReportFields for Report {
    const FIELDS: &'static [ReportField<Report>] = &[
        ("plan", |_, plan, _| Value::Record(Rc::new(Record::Plan(plan.clone())))),
        ("layout", |_, plan, _| Value::Record(Rc::new(Record::Native(Rc::new(LayoutValue(plan.clone())))))),
        ("layouts", |_, _, report| Value::whole(report.layouts.clone())),
        ("energy", |_, _, report| Value::Quantity(report.effort.energy, Dimension::ENERGY)),
        ("peak_torque", |_, _, report| Value::Quantity(report.effort.peak, Dimension::TORQUE)),
        ("bound", |_, _, report| Value::Quantity(report.bound, report.minimise.dimension())),
        ("gap", |_, _, report| Value::number(report.gap())),
        ("why", |_, _, report| Value::text(report.why())),
        ("fewest_steps", |_, _, report| Value::count(report.fewest_steps)),
        ("optimal", |_, _, report| Value::Bool(report.optimal)),
        ("price", |_, _, report| Value::number(report.price)),
        ("ties", |_, _, report| numbers(&report.ties)),
        ("tied", |_, _, report| Value::whole(report.tied.into())),
        ("root", |_, _, report| Value::count(report.layout.root)),
        ("order", |_, _, report| Value::list(report.steps.iter().map(|step| numbers(step)).collect())),
        ("stops", |_, _, report| Value::list(report.stops.iter().map(|stop| hinge_stop(*stop)).collect())),
        ("lifting", |_, _, report| Value::Quantity(report.lifting, Dimension::ENERGY)),
        ("lifting_bound", |_, _, report| Value::Quantity(report.lifting_bound, Dimension::ENERGY)),
        ("too_thick", |_, _, report| numbers(&report.too_thick)),
        ("robot", |_, plan, _| Value::Instance(plan.instance())),
        ("hinges", |_, plan, report| hinges(plan, report)),
    ];
}

fn numbers(faces: &[usize]) -> Value {
    Value::list(faces.iter().map(|face| Value::count(*face)).collect())
}

fn hinge_stop(stop: Stop) -> Value {
    Value::Record(Rc::new(Record::Native(Rc::new(HingeStop(stop)))))
}

/// Returns the joints of the folding robot in the order of the layout's hinges.
fn hinges(plan: &PlanValue, report: &Report) -> Value {
    let layout = &report.layout;
    // The bonds of the robot stand in the order of their faces, after the root.
    let bond = |hinge| layout.order[1..].iter().position(|face| layout.hinge[*face] == Some(hinge));
    let owners = layout.hinges().into_iter().filter_map(bond).map(JointOwner::Bond);
    let robot = plan.instance().robot.clone();
    let joint = |owner| JointValue { robot: robot.clone(), owner, dimension: Dimension::ANGLE };
    Value::list(owners.map(|owner| Value::Joint(joint(owner))).collect())
}

/// The value of the language's record `HingeStop`: a hinge that stops on its way.
#[derive(Debug)]
struct HingeStop(Stop);

/// The fields of a `HingeStop`.
const HINGE_STOP: &[Field<Stop>] = &[
    ("face", |stop| Value::count(stop.face)),
    ("step", |stop| Value::count(stop.step)),
    ("angle", |stop| Value::Quantity(stop.angle, Dimension::ANGLE)),
];

impl NativeRecord for HingeStop {
    fn read(&self, field: &str) -> Value {
        read_field(HINGE_STOP, &self.0, field)
    }

    fn show(&self) -> String {
        let Stop { face, step, angle } = self.0;
        format!("the hinge of face {face} at {} after step {step}", quantity(angle, Dimension::ANGLE))
    }
}

/// The value of the language's record `OrderSample`: the energies that random orders of folding take.
#[derive(Debug)]
pub struct OrderSample(pub Sample);

/// The fields of an `OrderSample`.
const ORDER_SAMPLE: &[Field<Sample>] = &[
    ("orders", |sample| Value::whole(sample.orders.into())),
    ("worse", |sample| Value::number(sample.worse as f64 / sample.orders as f64)),
    ("least", |sample| Value::Quantity(sample.least, Dimension::ENERGY)),
    ("mean", |sample| Value::Quantity(sample.mean, Dimension::ENERGY)),
    ("greatest", |sample| Value::Quantity(sample.greatest, Dimension::ENERGY)),
];

impl NativeRecord for OrderSample {
    fn read(&self, field: &str) -> Value {
        read_field(ORDER_SAMPLE, &self.0, field)
    }

    fn show(&self) -> String {
        format!("{} of {} orders take more energy", self.0.worse, self.0.orders)
    }
}

/// The value of the language's record `LayoutComparison`: the energies that layouts of a shape take.
#[derive(Debug)]
pub struct LayoutComparison(pub LayoutSample);

/// The fields of a `LayoutComparison`.
const LAYOUT_COMPARISON: &[Field<LayoutSample>] = &[
    ("layouts", |sample| Value::count(sample.layouts.len())),
    ("complete", |sample| Value::Bool(sample.complete)),
    ("energies", |sample| Value::list(sample.energies.iter().map(|e| energy(*e)).collect())),
    ("best", |sample| Value::count(sample.best())),
    ("least", |sample| energy(sample.energies[sample.best()])),
    ("median", |sample| energy(sample.median())),
    ("greatest", |sample| energy(sample.greatest())),
    ("rank", |sample| Value::count(sample.rank(sample.reference))),
    ("preferred", |sample| Value::count(sample.preferred())),
    ("preferred_rank", |sample| Value::count(sample.rank(sample.energies[sample.preferred()]))),
];

fn energy(value: f64) -> Value {
    Value::Quantity(value, Dimension::ENERGY)
}

impl NativeRecord for LayoutComparison {
    fn read(&self, field: &str) -> Value {
        read_field(LAYOUT_COMPARISON, &self.0, field)
    }

    fn show(&self) -> String {
        let LayoutSample { layouts, complete, .. } = &self.0;
        format!("{} {}layouts compared", layouts.len(), if *complete { "" } else { "random " })
    }
}

/// The value of the language's record `Layout`: the flat pattern in which a folding plan begins.
#[derive(Debug)]
pub struct LayoutValue(Rc<PlanValue>);

impl LayoutValue {
    /// Returns the planner's report of the folding that begins with the pattern.
    pub fn report(&self) -> &Report {
        self.0.report().expect("only plans that fold have a layout")
    }
}

impl NativeRecord for LayoutValue {
    fn read(&self, field: &str) -> Value {
        read_field(LAYOUT, self.report(), field)
    }

    fn show(&self) -> String {
        format!("a flat pattern of {} panels", self.report().target.faces.len())
    }

    fn plan(&self) -> Option<&Rc<PlanValue>> {
        Some(&self.0)
    }
}

/// The fields of a `Layout`.
const LAYOUT: &[Field<Report>] = &[
    ("panels", |report| Value::count(report.target.faces.len())),
    ("hinges", |report| {
        let hinges = report.layout.hinges();
        Value::list(hinges.into_iter().map(|hinge| pair(report.target.hinges[hinge].faces)).collect())
    }),
    ("overlaps", |report| {
        let overlaps = Pattern::of(&report.target, &report.layout).overlaps();
        Value::list(overlaps.into_iter().map(pair).collect())
    }),
];

/// Returns two faces, by their indices, as a list.
pub(super) fn pair([a, b]: [usize; 2]) -> Value {
    Value::list(vec![Value::count(a), Value::count(b)])
}

/// Returns the records of folding, each as (name, names of its fields in order).
pub fn records() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![
        ("Folding", Report::names()),
        ("Layout", field_names(LAYOUT)),
        ("HingeStop", field_names(HINGE_STOP)),
        ("OrderSample", field_names(ORDER_SAMPLE)),
        ("LayoutComparison", field_names(LAYOUT_COMPARISON)),
    ]
}
