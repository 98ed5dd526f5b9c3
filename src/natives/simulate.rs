//! `simulate`: a plan played by rigid bodies, as it is called, and the record that it gives.

use super::Native;
use super::shape::obstacles;
use crate::geometry::HeightField;
use crate::interpret::argument::{Positive, arguments};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::record::{Field, NativeRecord, Record, field_names, read_field};
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::Value;
use crate::robot::Assembly;
use crate::simulate::{
    Extreme, FailureCounts, Played, Refusal, Run, ServoGains, Settings, Simulation, Spread, is_judged,
    simulate_halving, study,
};
use crate::source::{Diagnostic, code};
use crate::units::Dimension;
use std::rc::Rc;
use std::sync::Arc;

/// The built-in `simulate`: its key with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[Native::on_run("simulate", SimulateArguments::PARAMETERS, simulate)];

arguments! {
    /// The arguments of `simulate`.
    struct SimulateArguments<'c> {
        what: &'c Value,
        step: Positive,
        friction: f64,
        stiffness: Option<Positive>,
        runs: usize,
        seed: usize,
        friction_spread: f64,
        mass_spread: f64,
        torque_spread: f64,
        stiffness_spread: f64,
        joint_spread: f64,
        terrain: Option<&'c HeightField>,
        obstacles: &'c [Value],
    }
}

/// Runs `simulate`: plays a plan with the step and with half of it, and then with what the spreads draw.
///
/// # Errors
/// A fault where the plan is of a lattice or truss or not sound, the step or a spread is out of range, friction is
/// negative, there are too many runs, or the robot has no inertia to move.
fn simulate(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let read = SimulateArguments::read(call)?;
    if read.friction < 0.0 {
        return Err(call.refuse("friction", "friction must not be negative"));
    }
    if read.runs > Spread::RUNS_MAX {
        return Err(call.refuse("runs", format!("at most {} runs", Spread::RUNS_MAX)));
    }
    let spread = Spread {
        friction: read.friction_spread,
        mass: read.mass_spread,
        effort: read.torque_spread,
        stiffness: read.stiffness_spread,
        zero: read.joint_spread,
    };
    if let Some((name, _)) = spread.parts().iter().find(|(_, part)| !(0.0..1.0).contains(part)) {
        let message = "a spread is a part of what is stated, from 0 to below 1";
        return Err(call.refuse(&format!("{name}_spread"), message));
    }
    if !(0.0..=std::f64::consts::PI).contains(&read.joint_spread) {
        return Err(call.refuse("joint_spread", "joints are off by at least 0deg and at most 180deg"));
    }
    let Some(planned) = interpreter.plan_of(read.what, call.at("what"))? else { return Ok(Value::Unknown) };
    let servo = ServoGains { stiffness: read.stiffness.map(|Positive(x)| x), ..ServoGains::default() };
    let terrain = read.terrain.map(|field| Arc::new(field.clone()));
    let (step, friction) = (read.step.0, read.friction);
    let obstacles = obstacles(call, read.obstacles)?.into();
    let settings = Settings { step, friction, servo, terrain, obstacles, ..Settings::default() };
    let refused = |refusal: Refusal| refused(&refusal, call);
    // Lattices and trusses are refused before anything judges them.
    if planned.plan.body.tracks().is_none() {
        return Err(refused(Refusal::Family));
    }
    crate::interrupt::start_task(format!("simulating {}", planned.robot.name));
    let plan = &planned.plan;
    let (outcome, halving) = simulate_halving(plan, &settings).map_err(refused)?;
    let runs = study(plan, &settings, &spread, read.runs, read.seed as u64).map_err(refused)?;
    let judged =
        is_judged(plan, &settings).then(|| interpreter.judge(&planned, plan.settings, None)).transpose()?;
    let verdict = judged.as_deref();
    let played = Played {
        plan,
        settings: &settings,
        outcome: &outcome,
        halving: &halving,
        verdict,
        runs: (&spread, &runs),
    };
    let notes = played.notes();
    Ok(Value::Record(Rc::new(Record::Native(Rc::new(Simulated { planned, outcome, runs, notes })))))
}

/// Returns the fault of a refusal, at the argument that it is about.
fn refused(refusal: &Refusal, call: &Call) -> Stop {
    match refusal {
        Refusal::Obstacle(..) => call.refuse("obstacles", refusal.to_string()),
        Refusal::Terrain(_) => call.refuse("terrain", refusal.to_string()),
        Refusal::Step => call.refuse("step", refusal.to_string()),
        Refusal::NoInertia { .. } => Diagnostic::error(code::BAD_VALUE, refusal.to_string())
            .label(call.at("what"), "this can't be simulated")
            .hint("state the `mass` of every link that a joint moves, or take a shorter `step`")
            .into(),
        Refusal::Family
        | Refusal::Invalid(_)
        | Refusal::Unfaithful(_)
        | Refusal::Shape(_)
        | Refusal::Setting(_) => call.refuse("what", refusal.to_string()),
    }
}

/// The value of the language's type `Simulation`.
#[derive(Debug)]
pub(super) struct Simulated {
    pub planned: Rc<PlanValue>,
    pub outcome: Simulation,
    pub runs: Vec<Run>,
    pub notes: Vec<String>,
}

impl Simulated {
    fn assembly(&self) -> Option<&Assembly> {
        self.planned.plan.body.tracks().map(|tracks| &tracks.robot)
    }

    /// Returns falls and what happened to bonds, in order of time.
    fn failures(&self) -> Vec<String> {
        self.assembly().map_or_else(Vec::new, |robot| self.outcome.failures(robot))
    }

    /// Returns one of the numbers of further runs in which something fails.
    fn count(&self, of: fn(FailureCounts) -> usize) -> Value {
        Value::count(of(FailureCounts::of(&self.runs)))
    }
}

/// The fields of a `Simulation`.
const SIMULATION: &[Field<Simulated>] = &[
    ("duration", |s| Value::time(s.outcome.duration)),
    ("travel", |s| Value::length(s.outcome.travel.xy().norm())),
    ("displacement", |s| Value::Vec3(s.outcome.travel, Dimension::LENGTH)),
    ("heading", |s| Value::Quantity(s.outcome.heading, Dimension::ANGLE)),
    ("lean", |s| Value::Quantity(s.outcome.lean, Dimension::ANGLE)),
    ("fell", |s| Value::Bool(s.outcome.fall.is_some())),
    ("fell_at", |s| Value::optional(s.outcome.fall.map(Value::time))),
    ("lag", |s| Value::Quantity(Extreme::value_of(s.outcome.lag), Dimension::ANGLE)),
    ("slide_lag", |s| Value::length(Extreme::value_of(s.outcome.lag_length))),
    ("torque", |s| Value::number(Extreme::value_of(s.outcome.effort))),
    ("saturated", |s| Value::time(Extreme::value_of(s.outcome.saturated))),
    ("bond_load", |s| Value::number(Extreme::value_of(s.outcome.bond_load))),
    ("dock_error", |s| Value::length(Extreme::value_of(s.outcome.dock_error()))),
    ("dock_angle", |s| Value::Quantity(Extreme::value_of(s.outcome.dock_angle()), Dimension::ANGLE)),
    ("slip", |s| Value::length(s.outcome.slip)),
    ("impact", |s| Value::Quantity(s.outcome.impact, Dimension::SPEED)),
    ("energy", |s| Value::Quantity(s.outcome.work, Dimension::ENERGY)),
    ("times", |s| Value::list(s.outcome.motion.iter().map(|moment| Value::time(moment.time)).collect())),
    ("path", |s| {
        let at =
            |moment: &crate::simulate::Moment| Value::Vec3(moment.base.translation.vector, Dimension::LENGTH);
        Value::list(s.outcome.motion.iter().map(at).collect())
    }),
    ("falls", |s| s.count(|counts| counts.falls)),
    ("breaks", |s| s.count(|counts| counts.breaks)),
    ("misses", |s| s.count(|counts| counts.misses)),
    ("stops", |s| s.count(|counts| counts.stops)),
    ("fails", |s| s.count(|counts| counts.fails)),
    ("travels", |s| {
        Value::list(s.runs.iter().map(|run| Value::length(run.outcome.travel.xy().norm())).collect())
    }),
    ("failures", |s| Value::list(s.failures().iter().map(Value::text).collect())),
    ("notes", |s| Value::list(s.notes.iter().map(Value::text).collect())),
];

impl NativeRecord for Simulated {
    fn read(&self, field: &str) -> Value {
        read_field(SIMULATION, self, field)
    }

    fn show(&self) -> String {
        let mut words = self.assembly().map_or_else(Vec::new, |robot| self.outcome.in_words(robot));
        words.extend(self.notes.iter().map(|note| format!("note: {note}")));
        words.join("\n  ")
    }
}

/// Returns the records of this file, each as (name, names of its fields in order).
pub(super) fn records() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![("Simulation", field_names(SIMULATION))]
}
