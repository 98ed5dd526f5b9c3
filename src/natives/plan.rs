//! Built-ins that plan, judge, print and write.

use super::Native;
use super::one_robot;
use super::show::Form;
use crate::behavior::{self, Problem};
use crate::geometry::HeightField;
use crate::interpret::WriteError;
use crate::interpret::argument::{Choice, Off, Positive, WordOr, parameters};
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::PlanValue;
use crate::interpret::planning::Beginning;
use crate::interpret::record::Record;
use crate::interpret::record::StateValue;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{Behavior, Value};
use crate::interpret::verdicts::failure_line;
use crate::plan::verify::articulated;
use crate::plan::{self, CauseId, DynamicsModel, Ground, Node, Plan, Provenance, Settings, Stability, World};
use crate::robot::{Assembly, State};
use crate::source::{Diagnostic, Span, code, files};
use crate::view;
use std::rc::Rc;
use std::sync::Arc;

/// The built-ins for plans, such as `plan`, `verify`, `emit` and `world`: the key of each with its parameters and its
/// Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("print", parameters![values: &[Value]], print),
    Native::on_run(
        "emit",
        parameters![what: &Value, file: &str, sample: Positive, unstable_for: f64, stability: Stability, reserve: f64, slip_max: Option<f64>, slip: f64],
        emit,
    ),
    Native::pure(
        "world",
        parameters![ground: Ground, gravity: WordOr<Off, f64>, friction: f64, dynamics: DynamicsModel, terrain: Option<&HeightField>],
        world,
    ),
    Native::on_run(
        "plan",
        parameters![behavior: &Rc<Behavior>, from: Option<&StateValue>, world: Option<World>],
        plan_behavior,
    ),
    Native::on_run("load_plan", parameters![file: &str, robot: &Rc<Instance>], load_plan),
    Native::on_run("reverse", parameters![plan: &Value], reverse),
    Native::on_run(
        "verify",
        parameters![what: &Value, sample: Positive, unstable_for: f64, stability: Stability, world: Option<World>, reserve: f64, slip_max: Option<f64>, slip: f64],
        verify,
    ),
    Native::on_run("Plan.at", parameters![self: &Value, time: f64], plan_at),
    Native::on_run("Plan.slice", parameters![self: &Value, times: (f64, f64)], plan_slice),
];

impl Choice for Stability {
    const WORDS: &'static [(&'static str, Stability)] =
        &[("footprint", Stability::Footprint), ("centres", Stability::Centres)];
}

fn print(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let values = call.get::<&[Value]>("values")?;
    if let [value] = values
        && let Some(table) = interpreter.table(value).and_then(|table| interpreter.show_table(&table))
    {
        interpreter.check_text(table.len(), call.span)?;
        interpreter.print_value(value, table.trim_end());
        table.lines().for_each(|line| interpreter.shared.host.print(line.to_string()));
        return Ok(Value::Nothing);
    }
    let shown: Vec<String> = values.iter().map(|value| interpreter.show(value)).collect();
    let line = shown.join(" ");
    interpreter.check_text(line.len(), call.span)?;
    for (value, text) in values.iter().zip(&shown) {
        interpreter.print_value(value, text);
    }
    interpreter.shared.host.print(line);
    Ok(Value::Nothing)
}

/// Runs `world`.
///
/// # Errors
/// A fault where gravity or friction is negative, a robot is to settle without gravity, or the terrain is no slope, or one
/// on which nothing settles.
fn world(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let ground: Ground = call.get("ground")?;
    let gravity = match call.get("gravity")? {
        WordOr::Word(Off) => 0.0,
        WordOr::Value(gravity) => gravity,
    };
    let friction = call.get::<f64>("friction")?;
    let dynamics: DynamicsModel = call.get("dynamics")?;
    if gravity < 0.0 {
        return Err(call.refuse("gravity", "gravity acts downwards, so it can't be negative"));
    }
    if friction < 0.0 {
        return Err(call.refuse("friction", "friction must not be negative"));
    }
    if ground == Ground::Settle && gravity == 0.0 {
        return Err(call.refuse(
            "gravity",
            "without gravity nothing rests on the ground: `ground: off`, `held` or `fixed`",
        ));
    }
    let mut world = World { gravity, ground, friction, dynamics, ..World::default() };
    if let Some(field) = call.get::<Option<&HeightField>>("terrain")? {
        let Some(slope) = field.as_plane() else {
            let why =
                "only a `slope` is ground for the judge: uneven ground is that of `simulate` and `locomote`";
            return Err(call.refuse("terrain", why));
        };
        if ground != Ground::Settle {
            return Err(call.refuse("terrain", "a slope is ground to settle on: `ground: settle`"));
        }
        world.slope = slope;
    }
    Ok(Value::Record(Rc::new(Record::World(world))))
}

fn planned_value(planned: Option<Rc<PlanValue>>) -> Value {
    planned.map_or(Value::Unknown, |planned| Value::Record(Rc::new(Record::Plan(planned))))
}

fn plan_behavior(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let behavior = call.get::<&Rc<Behavior>>("behavior")?.clone();
    let world: Option<World> = call.get("world")?;
    let mut beginning = Beginning { world, ..Beginning::default() };
    if let Some(state) = call.get::<Option<&StateValue>>("from")? {
        let start = match &state.only {
            Some(one) => one_robot::beginning(interpreter, call, &behavior, (state, one))?,
            None => {
                interpreter.common_robot(behavior.robot.as_deref(), Some(&state.robot), call.at("from"))?;
                let mut start = state.state.clone();
                let (before, time) = (&state.planned.plan, state.time);
                if let Some(then) = articulated::standing(before, time) {
                    (start.base, start.clusters) = (then.base, then.clusters);
                    start.misalignments = then.misalignments;
                } else if world.is_none_or(|world| world.ground == Ground::Settle) {
                    start.base = articulated::tipped_base(before, time).unwrap_or(start.base);
                }
                Some(start)
            }
        };
        let Some(start) = start else { return Ok(Value::Unknown) };
        beginning.start = Some(start);
    }
    Ok(planned_value(interpreter.plan_from(&behavior, beginning, call.span)?))
}

fn plan_argument(interpreter: &mut Interpreter, call: &Call, name: &str) -> Eval<Option<Rc<PlanValue>>> {
    interpreter.plan_of(call.arg(name), call.at(name))
}

fn reverse(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, "plan")? else { return Ok(Value::Unknown) };
    let reversed = interpreter.changed(&planned, |plan| Ok(plan::reversed(plan)), None, call.span)?;
    Ok(planned_value(Some(reversed)))
}

/// Runs `load_plan`: returns a plan from a file as a plan of this robot, which must match the plan's own in its
/// start state. The two are joined: a plan of this robot that does nothing, and the one from the file.
///
/// # Errors
/// A fault where the file is not a sound plan, its motion is not that of its program, or the robots differ.
fn load_plan(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, bytes) = interpreter.project_file(call, "file")?;
    let design = call.get::<&Rc<Instance>>("robot")?.design.clone();
    let Some(robot) = interpreter.robot_at(&design, call.at("robot"))? else { return Ok(Value::Unknown) };
    let unsound = |why: &str| {
        let message = format!("`{path}` is no sound plan file: {why}");
        fault(code::BAD_PLAN_FILE, call.at("file"), message, why)
    };
    let text = String::from_utf8(bytes).map_err(|_| unsound("it is not UTF-8 text"))?;
    let stored = plan::file::read(&text).map_err(|error| unsound(&error.to_string()))?;
    // The judge checks the motion; what robots execute is the program.
    if let Some(failure) = behavior::unfaithful(&stored) {
        return Err(unsound(&failure_line(&failure)));
    }
    let mut causes = interpreter.planner_causes(call.span);
    let run = |robot: &Assembly, start: &State, program: Arc<Node>| {
        behavior::schedule(Problem {
            robot: robot.clone(),
            start: start.clone(),
            program,
            start_causes: Vec::new(),
            bond_causes: (0..robot.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        })
    };
    let actions = stored.body.tracks().zip(stored.program.as_ref()).map_or(0, |(tracks, program)| {
        run(&tracks.robot, &tracks.start, program.root.clone()).map_or(0, |played| played.actions)
    });
    let nothing = run(&robot.assembly, &robot.start, Arc::new(Node::Series(Vec::new())))
        .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, call.span))?;
    let world = stored.worlds.first().map_or(World::FREE, |first| first.world);
    let (begun, _) = interpreter.assemble_plan(design.clone(), robot.clone(), nothing, &causes, world);
    let mut plan = plan::joined(&begun.plan, &stored).map_err(|unfit| {
        let message = format!("the plan in `{path}` does not begin with this robot: {unfit}");
        fault(code::NO_MATCH, call.at("robot"), message, "another robot, or in another posture")
    })?;
    let Provenance { planner, seed, budget, .. } = stored.provenance;
    plan.provenance = Provenance { planner, seed, budget, ..plan.provenance };
    // Whatever moved the robot then, what moves it now is this call.
    causes.ids.resize(plan.causes.len(), causes.ids[0]);
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids, actions);
    Ok(planned_value(Some(Rc::new(planned))))
}

fn plan_at(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, "self")? else { return Ok(Value::Unknown) };
    let time = call.get::<f64>("time")?;
    if !(0.0..=planned.plan.body.duration()).contains(&time) {
        return Err(call.refuse("time", "this is before the plan begins or after it ends"));
    }
    interpreter.state_at(&planned, time, call.at("self"))
}

fn plan_slice(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, "self")? else { return Ok(Value::Unknown) };
    let (from, to) = call.get::<(f64, f64)>("times")?;
    if !(0.0 <= from && from < to && to <= planned.plan.body.duration()) {
        return Err(call.refuse("times", "this is no stretch of the plan"));
    }
    let sliced =
        interpreter.changed(&planned, |plan| plan::sliced(plan, from, to), Some((from, to)), call.span)?;
    Ok(planned_value(Some(sliced)))
}

/// Returns the settings of the judge that the arguments `sample`, `unstable_for`, `stability`, `reserve`, `slip_max`
/// and `slip` ask for.
///
/// # Errors
/// A fault where `unstable_for` or `slip_max` is negative, `sample` is not positive, or `reserve` or `slip` is not
/// from 0 to 1.
pub(super) fn settings(interpreter: &Interpreter, call: &Call) -> Eval<Settings> {
    let unstable_for: f64 = call.get("unstable_for")?;
    if unstable_for < 0.0 {
        return Err(call.refuse("unstable_for", "a time must not be negative"));
    }
    let stability: Stability = call.get("stability")?;
    let sample = call.positive("sample", "the time between samples")?;
    let reserve: f64 = call.get("reserve")?;
    if !(0.0..=1.0).contains(&reserve) {
        return Err(call.refuse("reserve", "a reserve is a part of each limit, from 0 to 1"));
    }
    let slip_max: Option<f64> = call.get("slip_max")?;
    if slip_max.is_some_and(|slip| slip < 0.0) {
        return Err(call.refuse("slip_max", "a slip must not be negative"));
    }
    let slip: f64 = call.get("slip")?;
    if !(0.0..=1.0).contains(&slip) {
        return Err(call.refuse("slip", "wheels slip by a part of their speed, from 0 to 1"));
    }
    Ok(Settings { sample, unstable_for, stability, reserve, slip_max, slip, ..interpreter.judge_settings() })
}

fn verify(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let settings = settings(interpreter, call)?;
    let Some(planned) = plan_argument(interpreter, call, "what")? else { return Ok(Value::Unknown) };
    let world: Option<World> = call.get("world")?;
    let verdict = interpreter.judge(&planned, settings, world)?;
    interpreter.note_exemptions(&planned, &verdict);
    if let Some(name) = &interpreter.shared.options.verified_pages {
        let number = interpreter.reported.written.len();
        let page = if number == 0 { format!("{name}.html") } else { format!("{name}-{}.html", number + 1) };
        interpreter.draw(&planned, settings, Form::Page, &page, call.span)?;
    }
    let headline = plan::headline_under(&planned.plan, &planned.worlds_in(world), &verdict);
    interpreter.note_judgement(&verdict, &headline, call.span);
    Ok(Value::Record(Rc::new(Record::Report(verdict, headline))))
}

/// Runs `emit`: writes the plan with its verdict, and a page of it if the run draws pages. Of a plan that fails
/// only the page is written, and the failures are reported. A run that collects plans gets it as it is.
fn emit(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, _) = output_path(call, "file")?;
    let settings = settings(interpreter, call)?;
    let Some(planned) = plan_argument(interpreter, call, "what")? else { return Ok(Value::Unknown) };
    if interpreter.shared.options.collects {
        interpreter.reported.plans.push((path, planned.plan.clone()));
        return Ok(Value::Nothing);
    }
    let verdict = interpreter.judge(&planned, settings, None)?;
    interpreter.note_exemptions(&planned, &verdict);
    interpreter.note_judgement(&verdict, &plan::headline(&planned.plan, &verdict), call.span);
    let page = match interpreter.shared.options.pages {
        true => Some(interpreter.draw(
            &planned,
            settings,
            Form::Page,
            &view::page_name(&path),
            call.at("file"),
        )?),
        false => None,
    };
    if !verdict.ok() {
        interpreter.report_failures(&planned, &verdict, call.at("what"), page.as_deref());
        return Ok(Value::Unknown);
    }
    let excuses = interpreter.excuses(&planned, &settings);
    let plan = Plan { settings, verdict: Some(verdict.as_ref().clone()), ..planned.plan.clone() };
    let text = plan::file::write(&plan).map_err(|error| {
        fault(code::CANNOT_WRITE, call.at("what"), format!("the plan can't be written: {error}"), "this plan")
    })?;
    write_output(interpreter, call.at("file"), &path, text.into_bytes())?;
    if !excuses.is_empty() {
        interpreter.shared.host.print(format!("{path}: verified with {}", excuses.join(", ")));
    }
    note_settling(interpreter, call, &verdict.notes);
    Ok(Value::Nothing)
}

/// Returns (path, name) of the file named by the argument `argument`: its path below the output folder, and as the
/// program writes it.
///
/// # Errors
/// A fault where it leads out of the output folder, or names no file.
pub(super) fn output_path(call: &Call, argument: &str) -> Eval<(String, String)> {
    let name = call.get::<&str>(argument)?.to_string();
    match files::join("", &name).filter(|path| !path.is_empty()) {
        Some(path) => Ok((path, name)),
        None => Err(outside(call.at(argument), &name)),
    }
}

/// Writes a file to `path`, below the output folder, and records it among the files written. Returns the path to show.
///
/// # Errors
/// A fault at `at` where it can't be written.
pub(super) fn write_output(
    interpreter: &mut Interpreter,
    at: Span,
    path: &str,
    bytes: Vec<u8>,
) -> Eval<String> {
    if interpreter.shared.options.collects {
        return Ok(path.to_owned());
    }
    match interpreter.shared.host.write(path, bytes) {
        Ok(shown) => {
            if !interpreter.reported.written.contains(&shown) {
                interpreter.reported.written.push(shown.clone());
            }
            Ok(shown)
        }
        Err(WriteError::Outside) => Err(outside(at, path)),
        Err(WriteError::Failed(why)) => {
            let message = format!("`{path}` can't be written: {why}");
            Err(fault(code::CANNOT_WRITE, at, message, why))
        }
    }
}

/// Reports that a robot does not start in its declared pose, if the judge notes that it settles.
fn note_settling(interpreter: &mut Interpreter, call: &Call, notes: &[String]) {
    for note in notes.iter().filter(|note| note.contains("settles")) {
        interpreter
            .add_report(Diagnostic::note(code::START_SETTLES, note).label(call.at("what"), "of this plan"));
    }
}

fn outside(at: Span, name: &str) -> Stop {
    Diagnostic::error(code::OUTSIDE_OUTPUT, format!("`{name}` leads out of the output folder"))
        .label(at, "output stays in the output folder")
        .hint("write a path below it, such as `walk.plan.json`")
        .into()
}
