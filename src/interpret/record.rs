//! Records: what built-ins give back, and the fields by which it is asked.

use super::design::Design;
use super::interpreter::Interpreter;
use super::planning::Planned;
use super::stop::Eval;
use super::value::Value;
use super::verdicts;
use crate::elaborate::robot_of::Robot;
use crate::elaborate::truss::free_motions;
use crate::geometry::{Pose, Vec3};
use crate::natives::folding::{FOLDING, ORDER_SAMPLE, folding_field, layout_field, sample_field};
use crate::natives::refold::{REFOLDING, refolding_field};
use crate::natives::squeeze::Squeezed;
use crate::natives::tosnake::{UNWINDING, unwinding_field};
use crate::natives::truss::{MORPHING, TRAVEL};
use crate::plan::verify::articulated::base_at;
use crate::plan::{Ground, Plan, Verdict, World, Worst};
use crate::planners::fold::random_orders::Sample;
use crate::robot::State;
use crate::source::{Span, Symbol};
use crate::units::{Dimension, quantity};
use std::cell::OnceCell;
use std::rc::Rc;

#[derive(Debug)]
pub enum Record {
    Plan(Rc<Planned>),
    Report(Rc<Verdict>),
    State(StateValue),
    World(World),
    /// Nodes and struts.
    Frame(Vec<Vec3>, Vec<(usize, usize)>),
    /// Of a truss.
    Rigidity(Rc<Design>),
    /// The flat pattern of a plan that folds it.
    Layout(Rc<Planned>),
    /// What random orders of folding take.
    Orders(Sample),
}

/// A state of a robot, with when and where it was taken.
pub struct StateValue {
    pub robot: Rc<Design>,
    pub body: Rc<Robot>,
    pub state: State,
    pub time: f64,
    pub planned: Rc<Planned>,
    /// Where the base is in the world, once it was asked for.
    pub base: OnceCell<Pose>,
}

const ACCELERATION: Dimension = Dimension::ACCELERATION;
const ENERGY: Dimension = Dimension::TORQUE;

impl Interpreter<'_> {
    /// A field of a record; a behaviour is asked as the plan that it gives.
    pub fn field(&mut self, value: &Value, field: Symbol, span: Span) -> Eval<Value> {
        match value {
            Value::Behavior(behavior) => match self.plan_behavior(behavior, span)? {
                Some(planned) => self.plan_field(&planned, field.as_str(), span),
                None => Ok(Value::Unknown),
            },
            Value::Record(record) => Ok(match &**record {
                Record::Plan(planned) if planned.trussed.as_ref().is_some_and(|t| t.has(field.as_str())) => {
                    let trussed = planned.trussed.as_ref().expect("it was asked");
                    self.trussed_field(planned, trussed, field.as_str())
                }
                Record::Plan(planned) => match &planned.squeezed {
                    Some(squeezed) if SQUEEZING.contains(&field.as_str()) => {
                        self.squeezing_field(planned, squeezed, field.as_str())
                    }
                    _ => match &planned.folded {
                        Some(folded) if FOLDING.contains(&field.as_str()) => {
                            folding_field(planned, folded, field.as_str())
                        }
                        _ => match &planned.refolded {
                            Some(refolded) if REFOLDING.contains(&field.as_str()) => {
                                refolding_field(refolded, field.as_str())
                            }
                            _ => match &planned.unwound {
                                Some(unwound) if UNWINDING.contains(&field.as_str()) => {
                                    unwinding_field(unwound, field.as_str())
                                }
                                _ => self.plan_field(planned, field.as_str(), span)?,
                            },
                        },
                    },
                },
                Record::Layout(planned) => match &planned.folded {
                    Some(folded) => layout_field(folded, field.as_str()),
                    None => Value::Unknown,
                },
                Record::Orders(sample) => sample_field(sample, field.as_str()),
                Record::Report(verdict) => report_field(verdict, field.as_str()),
                Record::State(state) => state.field(field.as_str()),
                Record::World(world) => world_field(world, field.as_str()),
                Record::Frame(nodes, struts) => frame_field(nodes, struts, field.as_str()),
                Record::Rigidity(truss) => rigidity_field(truss, field.as_str()),
            }),
            Value::Vec3(v, dimension) => Ok(match field.as_str() {
                "x" => Value::Quantity(v.x, *dimension),
                "y" => Value::Quantity(v.y, *dimension),
                "z" => Value::Quantity(v.z, *dimension),
                other => unreachable!("check knows no field `{other}` of a vector"),
            }),
            Value::Range(ends) => Ok(match field.as_str() {
                "from" => ends.0.clone(),
                "to" => ends.1.clone(),
                other => unreachable!("check knows no field `{other}` of a range"),
            }),
            Value::Pose(pose) => Ok(match field.as_str() {
                "position" => Value::Vec3(pose.translation.vector, Dimension::LENGTH),
                other => unreachable!("check knows no field `{other}` of a pose"),
            }),
            _ => unreachable!("check gives fields to records, vectors, ranges and poses only"),
        }
    }

    fn plan_field(&mut self, planned: &Rc<Planned>, field: &str, span: Span) -> Eval<Value> {
        Ok(match field {
            "duration" => Value::time(planned.plan.body.duration()),
            "actions" => Value::count(planned.actions()),
            "steps" => Value::count(planned.steps()),
            "start" => self.state_at(planned, 0.0, span)?,
            "end" => self.state_at(planned, planned.plan.body.duration(), span)?,
            "assumes" => Value::Record(Rc::new(Record::World(first_world(&planned.plan)))),
            _ => Value::Unknown,
        })
    }
}

/// The fields of a `Squeezing` beside those of a plan.
const SQUEEZING: &[&str] = &[
    "lower_bound",
    "ratio",
    "peak_force",
    "peak_speed",
    "peak_energy",
    "angular_momentum",
    "balanced",
    "method",
    "why",
    "stages",
];

impl Interpreter<'_> {
    fn squeezing_field(&mut self, planned: &Rc<Planned>, squeezed: &Squeezed, field: &str) -> Value {
        // What cells go through is what the judge found.
        let dynamics = |interpreter: &mut Self| {
            let settings = interpreter.judge_settings();
            interpreter.judge(planned, settings, None).dynamics.unwrap_or_default()
        };
        match field {
            "lower_bound" => Value::time(squeezed.lower_bound),
            "ratio" if squeezed.lower_bound > 0.0 => {
                Value::number(planned.plan.body.duration() / squeezed.lower_bound)
            }
            "ratio" => Value::number(1.0),
            "peak_force" => Value::Quantity(dynamics(self).peak_force, Dimension::FORCE),
            "peak_speed" => Value::Quantity(dynamics(self).peak_speed, Dimension::SPEED),
            "peak_energy" => Value::Quantity(dynamics(self).peak_energy, ENERGY),
            "angular_momentum" => {
                Value::Quantity(dynamics(self).angular_momentum, Dimension::ANGULAR_MOMENTUM)
            }
            "balanced" => Value::Bool(squeezed.balanced),
            "method" => Value::text(squeezed.method.name()),
            "why" => Value::text(squeezed.why.clone()),
            "stages" => {
                let line = |(name, duration): &(String, f64)| {
                    Value::text(format!("{name}: {}", quantity(*duration, Dimension::TIME)))
                };
                Value::list(squeezed.stages.iter().map(line).collect())
            }
            _ => Value::Unknown,
        }
    }
}

pub fn first_world(plan: &Plan) -> World {
    plan.worlds.first().map_or_else(World::default, |from| from.world)
}

/// The names of a record's fields, as Rust has them; the tests compare them with the declarations.
pub fn fields_of(record: &str) -> Option<&'static [&'static str]> {
    Some(match record {
        "Plan" => &["duration", "actions", "steps", "start", "end", "assumes"],
        "Squeezing" => SQUEEZING,
        "Folding" => FOLDING,
        "OrderSample" => ORDER_SAMPLE,
        "Refolding" => REFOLDING,
        "Unwinding" => UNWINDING,
        "Morphing" => MORPHING,
        "Travel" => TRAVEL,
        "Layout" => &["panels", "hinges", "overlaps"],
        "Report" => &[
            "ok",
            "clearance",
            "margin",
            "torque_margin",
            "bond_margin",
            "speed_margin",
            "angle",
            "rigidity",
            "travel",
            "displacement",
            "heading",
            "slip",
            "duration",
            "energy",
            "samples",
            "failures",
            "checks",
            "worst",
            "notes",
        ],
        "State" => &["time", "base", "com"],
        "World" => &["gravity", "ground", "friction"],
        "Frame" => &["nodes", "struts"],
        "Rigidity" => &["rigid", "rank", "self_stresses", "weakest", "redundant", "free_motions"],
        _ => return None,
    })
}

fn report_field(verdict: &Verdict, field: &str) -> Value {
    // A margin that nothing limits is infinite: larger than whatever it is compared with.
    let worst = |worst: &Option<Worst>, dimension| {
        Value::Quantity(worst.as_ref().map_or(f64::INFINITY, |w| w.value), dimension)
    };
    let texts = |texts: Vec<String>| Value::list(texts.into_iter().map(Value::text).collect());
    let [x, y, z] = verdict.travel;
    match field {
        "ok" => Value::Bool(verdict.ok()),
        "clearance" => worst(&verdict.clearance, Dimension::LENGTH),
        "margin" => worst(&verdict.margin, Dimension::LENGTH),
        "torque_margin" => worst(&verdict.torque_margin, Dimension::NUMBER),
        "bond_margin" => worst(&verdict.bond_margin, Dimension::NUMBER),
        "speed_margin" => worst(&verdict.speed_margin, Dimension::NUMBER),
        "angle" => worst(&verdict.angle, Dimension::ANGLE),
        "rigidity" => worst(&verdict.rigidity, Dimension::NUMBER),
        "travel" => Value::length(libm::hypot(x, y)),
        "displacement" => Value::Vec3(Vec3::new(x, y, z), Dimension::LENGTH),
        "heading" => Value::Quantity(verdict.heading, Dimension::ANGLE),
        "slip" => Value::length(verdict.slip.as_ref().map_or(0.0, |w| w.value)),
        "duration" => Value::time(verdict.duration),
        "energy" => Value::Quantity(verdict.energy, ENERGY),
        "samples" => Value::count(verdict.samples),
        "failures" => texts(verdict.failures.iter().map(verdicts::failure_line).collect()),
        "checks" => texts(verdict.checks.iter().map(verdicts::check_line).collect()),
        "worst" => texts(verdicts::worst_lines(verdict)),
        "notes" => texts(verdict.notes.clone()),
        _ => Value::Unknown,
    }
}

impl std::fmt::Debug for StateValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a state of {}", self.robot.name)
    }
}

impl StateValue {
    fn field(&self, field: &str) -> Value {
        match field {
            "time" => Value::time(self.time),
            "base" => Value::Pose(Rc::new(self.base())),
            "com" => {
                let poses = self.poses();
                let (com, _) = self.body.kinematics.centre_of_mass(&self.body.assembly, &poses);
                Value::Vec3(com, Dimension::LENGTH)
            }
            _ => Value::Unknown,
        }
    }

    /// World poses of all links.
    pub fn poses(&self) -> Vec<Pose> {
        let stood = self.base();
        let mut poses = vec![stood; self.body.kinematics.link_count()];
        let base = self.body.assembly.base;
        self.body.kinematics.link_poses_from(base, &self.state.joints, &stood, &mut poses);
        poses
    }

    /// The pose of the base module's body in the world: where standing, rolling and tipping have brought
    /// it by then.
    fn base(&self) -> Pose {
        let grounded = self.planned.plan.worlds.iter().any(|w| w.world.ground != Ground::Off);
        let stand = || {
            if !grounded {
                return self.state.base;
            }
            base_at(&self.planned.plan, self.time).unwrap_or(self.state.base)
        };
        *self.base.get_or_init(stand)
    }
}

fn world_field(world: &World, field: &str) -> Value {
    match field {
        "gravity" => Value::Quantity(world.gravity, ACCELERATION),
        "ground" => Value::text(match world.ground {
            Ground::Settle => "settle",
            Ground::Fixed => "fixed",
            Ground::Held => "held",
            Ground::Off => "off",
        }),
        "friction" => Value::number(world.friction),
        _ => Value::Unknown,
    }
}

fn frame_field(nodes: &[Vec3], struts: &[(usize, usize)], field: &str) -> Value {
    match field {
        "nodes" => Value::list(nodes.iter().map(|p| Value::Vec3(*p, Dimension::LENGTH)).collect()),
        "struts" => {
            let pair = |(a, b): &(usize, usize)| Value::list(vec![Value::count(*a), Value::count(*b)]);
            Value::list(struts.iter().map(pair).collect())
        }
        _ => Value::Unknown,
    }
}

/// Nodes, and struts by pairs of nodes.
type NodesAndStruts = (Vec<Vec3>, Vec<(usize, usize)>);

/// Nodes and struts of a `Frame`.
pub fn frame_parts(value: &Value) -> Option<NodesAndStruts> {
    match value {
        Value::Record(record) => match &**record {
            Record::Frame(nodes, struts) => Some((nodes.clone(), struts.clone())),
            _ => None,
        },
        _ => None,
    }
}

fn rigidity_field(design: &Rc<Design>, field: &str) -> Value {
    let super::design::DesignKind::Truss(truss) = &design.kind else { return Value::Unknown };
    let rigidity = &truss.rigidity;
    match field {
        "rigid" => Value::Bool(rigidity.rigid()),
        "rank" => Value::count(rigidity.rank),
        "self_stresses" => Value::count(rigidity.self_stresses),
        "weakest" => Value::number(rigidity.weakest),
        "redundant" => {
            Value::list(rigidity.redundant.iter().map(|&s| Value::text(truss.strut_name(s))).collect())
        }
        "free_motions" => Value::list(free_motions(truss).into_iter().map(Value::text).collect()),
        _ => Value::Unknown,
    }
}
