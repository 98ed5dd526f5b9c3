//! Fields of records: one table from field to reader for each type of record.

use super::argument::Choice;
use super::design::{DesignKind, TrussDesign};
use super::interpreter::Interpreter;
use super::plan_value::PlanValue;
use super::stop::Eval;
use super::value::Value;
use super::verdicts;
use crate::check::typed::DefKind;
use crate::geometry::Vec3;
use crate::plan::verify::articulated::Detail;
use crate::plan::{Verdict, World, Worst};
use crate::source::{Span, Symbol};
use crate::units::Dimension;
use std::rc::Rc;

use super::record::{DeclaredRecord, Field, Record, StateValue, field_names, first_world, read_field};

impl Interpreter<'_> {
    /// Returns a field of a record, vector, range or pose; for a behaviour, that of the plan that it gives, and
    /// unknown where that fails. `value`: the record or other value; `span`: the span of the expression. Panics for
    /// other values and unknown fields, which `check` excludes.
    ///
    /// # Errors
    /// A fault where the behaviour can't be planned.
    pub fn field(&mut self, value: &Value, field: Symbol, span: Span) -> Eval<Value> {
        if let Value::Record(record) = value
            && let Record::Declared(declared) = &**record
        {
            return Ok(self.declared_field(declared, field));
        }
        let field = field.as_str();
        match value {
            Value::Behavior(behavior) => match self.plan_behavior(behavior, span)? {
                Some(planned) => self.plan_field(&planned, field, span),
                None => Ok(Value::Unknown),
            },
            Value::Record(record) => Ok(match &**record {
                Record::Declared(_) => unreachable!("read above"),
                Record::Plan(planned) => return self.plan_field(planned, field, span),
                Record::Report(verdict, _) => read_field(REPORT, verdict, field),
                Record::State(state) => read_field(STATE, state, field),
                Record::World(world) => read_field(WORLD, world, field),
                Record::Frame(..) => read_field(FRAME, record.as_ref(), field),
                Record::Rigidity(design) => {
                    let DesignKind::Truss(truss) = &design.kind else {
                        unreachable!("only trusses are asked")
                    };
                    read_field(RIGIDITY, truss, field)
                }
                Record::Native(record) => record.read(field),
            }),
            Value::Vec3(v, dimension) => Ok(match field {
                "x" => Value::Quantity(v.x, *dimension),
                "y" => Value::Quantity(v.y, *dimension),
                "z" => Value::Quantity(v.z, *dimension),
                other => unreachable!("check knows no field `{other}` of a vector"),
            }),
            Value::Range(ends) => Ok(match field {
                "from" => ends.0.clone(),
                "to" => ends.1.clone(),
                other => unreachable!("check knows no field `{other}` of a range"),
            }),
            Value::Pose(pose) => Ok(match field {
                "position" => Value::Vec3(pose.translation.vector, Dimension::LENGTH),
                other => unreachable!("check knows no field `{other}` of a pose"),
            }),
            _ => unreachable!("check gives fields to records, vectors, ranges and poses only"),
        }
    }

    fn declared_field(&self, record: &DeclaredRecord, field: Symbol) -> Value {
        let DefKind::Record(declared) = &self.shared.program.def(record.def).kind else {
            return Value::Unknown;
        };
        let index = declared.fields.iter().position(|f| f.name == field);
        index.and_then(|index| record.fields.get(index)).cloned().unwrap_or(Value::Unknown)
    }

    fn plan_field(&mut self, plan: &Rc<PlanValue>, field: &str, span: Span) -> Eval<Value> {
        let reported = plan.any_report().and_then(|report| report.read(self, plan, field));
        if let Some(value) = reported {
            return Ok(value);
        }
        let found = PLAN.iter().find(|(name, _)| *name == field);
        let (_, read) =
            found.unwrap_or_else(|| unreachable!("`check` knows no field `{field}` of this plan"));
        read(self, plan, span)
    }
}

/// A field of a plan.
type PlanField = (&'static str, fn(&mut Interpreter, &Rc<PlanValue>, Span) -> Eval<Value>);

const PLAN: &[PlanField] = &[
    ("duration", |_, plan, _| Ok(Value::time(plan.plan.body.duration()))),
    ("actions", |_, plan, _| Ok(Value::count(plan.actions()))),
    ("nominal", |_, plan, _| Ok(Value::Bool(plan.plan.nominal))),
    ("steps", |_, plan, _| Ok(Value::count(plan.steps()))),
    ("start", |interpreter, plan, span| interpreter.state_at(plan, 0.0, span)),
    ("end", |interpreter, plan, span| interpreter.state_at(plan, plan.plan.body.duration(), span)),
    ("assumes", |_, plan, _| Ok(Value::Record(Rc::new(Record::World(first_world(&plan.plan)))))),
];

const REPORT: &[Field<Rc<Verdict>>] = &[
    ("ok", |verdict| Value::Bool(verdict.ok())),
    ("clearance", |verdict| worst(verdict.clearance.as_ref(), Dimension::LENGTH)),
    ("margin", |verdict| worst(verdict.margin.as_ref(), Dimension::LENGTH)),
    ("torque_margin", |verdict| worst(verdict.torque_margin.as_ref(), Dimension::NUMBER)),
    ("bond_margin", |verdict| worst(verdict.bond_margin.as_ref(), Dimension::NUMBER)),
    ("speed_margin", |verdict| worst(verdict.speed_margin.as_ref(), Dimension::NUMBER)),
    ("force_margin", |verdict| worst(verdict.force_margin.as_ref(), Dimension::NUMBER)),
    ("elastic_margin", |verdict| worst(verdict.elastic_margin.as_ref(), Dimension::NUMBER)),
    ("impact", |verdict| Value::Quantity(verdict.impact.as_ref().map_or(0.0, |w| w.value), Dimension::SPEED)),
    ("angle", |verdict| worst(verdict.angle.as_ref(), Dimension::ANGLE)),
    ("rigidity", |verdict| worst(verdict.rigidity.as_ref(), Dimension::NUMBER)),
    ("travel", |verdict| Value::length(libm::hypot(verdict.travel[0], verdict.travel[1]))),
    ("displacement", |verdict| Value::Vec3(Vec3::from(verdict.travel), Dimension::LENGTH)),
    ("heading", |verdict| Value::Quantity(verdict.heading, Dimension::ANGLE)),
    ("travel_within", |verdict| Value::length(verdict.travel_within.unwrap_or(f64::INFINITY))),
    ("heading_within", |verdict| {
        Value::Quantity(verdict.heading_within.unwrap_or(f64::INFINITY), Dimension::ANGLE)
    }),
    ("slip", |verdict| Value::length(verdict.slip.as_ref().map_or(0.0, |w| w.value))),
    ("duration", |verdict| Value::time(verdict.duration)),
    ("energy", |verdict| Value::Quantity(verdict.energy, Dimension::ENERGY)),
    ("samples", |verdict| Value::count(verdict.samples)),
    ("failures", |verdict| texts(verdict.failures.iter().map(verdicts::failure_line))),
    ("checks", |verdict| texts(verdict.checks.iter().map(verdicts::check_line))),
    ("worst", |verdict| texts(verdicts::worst_lines(verdict))),
    ("notes", |verdict| texts(verdict.notes.clone())),
];

/// Returns a margin; one that nothing limits is infinite: larger than whatever it is compared with.
fn worst(worst: Option<&Worst>, dimension: Dimension) -> Value {
    Value::Quantity(worst.map_or(f64::INFINITY, |w| w.value), dimension)
}

fn texts(texts: impl IntoIterator<Item = String>) -> Value {
    Value::list(texts.into_iter().map(Value::text).collect())
}

const STATE: &[Field<StateValue>] = &[
    ("time", |state| Value::time(state.time)),
    ("base", |state| Value::Pose(Rc::new(state.base()))),
    ("com", |state| Value::Vec3(state.centre_of_mass(), Dimension::LENGTH)),
    ("margin", |state| length_if(state.judged(Detail::Stance, |known| known.margin).flatten())),
    ("clearance", |state| length_if(state.clearance())),
];

fn length_if(length: Option<f64>) -> Value {
    Value::optional(length.map(Value::length))
}

const WORLD: &[Field<World>] = &[
    ("gravity", |world| Value::Quantity(world.gravity, Dimension::ACCELERATION)),
    ("ground", |world| Value::text(world.ground.word())),
    ("friction", |world| Value::number(world.friction)),
    ("dynamics", |world| Value::text(world.dynamics.word())),
    ("slope", |world| Value::Quantity(world.slope_angle(), Dimension::ANGLE)),
];

const FRAME: &[Field<Record>] = &[
    ("nodes", |record| {
        Value::list(frame(record).0.iter().map(|p| Value::Vec3(*p, Dimension::LENGTH)).collect())
    }),
    ("struts", |record| {
        let pair = |(a, b): &(usize, usize)| Value::list(vec![Value::count(*a), Value::count(*b)]);
        Value::list(frame(record).1.iter().map(pair).collect())
    }),
];

/// Returns the nodes and struts of a frame.
fn frame(record: &Record) -> (&[Vec3], &[(usize, usize)]) {
    match record {
        Record::Frame(nodes, struts) => (nodes, struts),
        _ => unreachable!("only frames are asked"),
    }
}

const RIGIDITY: &[Field<TrussDesign>] = &[
    ("rigid", |truss| Value::Bool(truss.rigidity.rigid())),
    ("rank", |truss| Value::count(truss.rigidity.rank)),
    ("self_stresses", |truss| Value::count(truss.rigidity.self_stresses)),
    ("weakest", |truss| Value::number(truss.rigidity.weakest)),
    ("redundant", |truss| texts(truss.rigidity.redundant.iter().map(|&strut| truss.strut_name(strut)))),
    ("free_motions", |truss| texts(truss.free_motions())),
];

/// Returns the records that no native's file defines, each as (name, names of its fields in order), to be compared
/// with the declarations.
pub fn fields() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![
        ("Plan", PLAN.iter().map(|(name, _)| *name).collect()),
        ("Report", field_names(REPORT)),
        ("State", field_names(STATE)),
        ("World", field_names(WORLD)),
        ("Frame", field_names(FRAME)),
        ("Rigidity", field_names(RIGIDITY)),
    ]
}
