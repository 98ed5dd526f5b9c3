//! Built-ins that plan, judge, print and write.

use super::show::Form;
use super::{Native, on_run, pure};
use crate::behavior::{self, Problem};
use crate::interpret::call::Call;
use crate::interpret::host::WriteError;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::{Beginning, Planned};
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::interpret::verdicts::failure_line;
use crate::plan::{self, CauseId, Ground, Node, Plan, Provenance, Settings, Stability, World};
use crate::robot::{Assembly, State};
use crate::source::{Diagnostic, code, files};
use crate::view;
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[
    on_run("print", 1, print),
    on_run("emit", 5, emit),
    pure("world", 3, world),
    on_run("plan", 3, plan_behavior),
    on_run("load_plan", 2, load_plan),
    on_run("reverse", 1, reverse),
    on_run("verify", 5, verify),
    on_run("Plan.at", 2, plan_at),
    on_run("Plan.slice", 2, plan_slice),
];

fn print(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let shown: Vec<String> = call.list(0)?.iter().map(|value| interpreter.show(value)).collect();
    let line = shown.join(" ");
    interpreter.check_text(line.len(), call.span)?;
    interpreter.stage.print(line);
    Ok(Value::Nothing)
}

fn world(_: &mut Interpreter, call: &Call) -> Eval<Value> {
    let ground = match call.word(0) {
        Some("fixed") => Ground::Fixed,
        Some("held") => Ground::Held,
        Some("off") => Ground::Off,
        _ => Ground::Settle,
    };
    let gravity = if call.word(1) == Some("off") { 0.0 } else { call.number(1)? };
    let friction = call.number(2)?;
    if gravity < 0.0 {
        return Err(call.refuse(1, "gravity acts downwards, so it can't be negative"));
    }
    if friction < 0.0 {
        return Err(call.refuse(2, "friction must not be negative"));
    }
    if ground == Ground::Settle && gravity == 0.0 {
        return Err(
            call.refuse(1, "without gravity nothing rests on the ground: `ground: off`, `held` or `fixed`")
        );
    }
    Ok(Value::Record(Rc::new(Record::World(World { gravity, ground, friction }))))
}

fn world_at(call: &Call, index: usize) -> Option<World> {
    match call.arg(index) {
        Value::Record(record) => match &**record {
            Record::World(world) => Some(*world),
            _ => None,
        },
        _ => None,
    }
}

fn planned_value(planned: Option<Rc<Planned>>) -> Value {
    planned.map_or(Value::Unknown, |planned| Value::Record(Rc::new(Record::Plan(planned))))
}

fn plan_behavior(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let behavior = call.behavior(0)?.clone();
    let mut beginning = Beginning::default();
    if let Value::Record(record) = call.arg(1)
        && let Record::State(state) = &**record
    {
        interpreter.common_robot(behavior.robot.as_ref(), Some(&state.robot), call.at(1))?;
        beginning.start = Some(state.state.clone());
    }
    if let Some(world) = world_at(call, 2) {
        beginning.world = world;
    }
    Ok(planned_value(interpreter.plan_from(&behavior, beginning, call.span)?))
}

fn plan_argument(interpreter: &mut Interpreter, call: &Call, index: usize) -> Eval<Option<Rc<Planned>>> {
    interpreter.plan_of(call.arg(index), call.at(index))
}

fn reverse(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, 0)? else { return Ok(Value::Unknown) };
    let reversed = interpreter.changed(&planned, |plan| Ok(plan::reversed(plan)), call.span)?;
    Ok(planned_value(Some(reversed)))
}

/// A plan from a file, of a robot that starts as the plan's own does, with the names of this one's modules:
/// it goes on where a plan of this robot ends that does nothing.
fn load_plan(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, bytes) = interpreter.project_file(call, 0)?;
    let design = call.instance(1)?.design.clone();
    let Some(robot) = interpreter.robot_at(&design, call.at(1))? else { return Ok(Value::Unknown) };
    let unsound = |why: &str| {
        let message = format!("`{path}` is no sound plan file: {why}");
        fault(code::BAD_PLAN_FILE, call.at(0), message, why)
    };
    let text = String::from_utf8(bytes).map_err(|_| unsound("it is not UTF-8 text"))?;
    let stored = plan::file::read(&text).map_err(|error| unsound(&error.to_string()))?;
    // The judge looks at the motion; what robots execute is the program.
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
        fault(code::NO_MATCH, call.at(1), message, "another robot, or in another posture")
    })?;
    let Provenance { planner, seed, budget, .. } = stored.provenance;
    plan.provenance = Provenance { planner, seed, budget, ..plan.provenance };
    // Whatever moved the robot then, what moves it now is this call.
    causes.ids.resize(plan.causes.len(), causes.ids[0]);
    let planned = Planned::new(design, Some(robot), plan, causes.ids, actions);
    Ok(planned_value(Some(Rc::new(planned))))
}

fn plan_at(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, 0)? else { return Ok(Value::Unknown) };
    let time = call.number(1)?;
    if !(0.0..=planned.plan.body.duration()).contains(&time) {
        return Err(call.refuse(1, "this is before the plan begins or after it ends"));
    }
    interpreter.state_at(&planned, time, call.at(0))
}

fn plan_slice(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(planned) = plan_argument(interpreter, call, 0)? else { return Ok(Value::Unknown) };
    let (from, to) = call.range(1)?;
    if !(0.0 <= from && from < to && to <= planned.plan.body.duration()) {
        return Err(call.refuse(1, "this is no stretch of the plan"));
    }
    let sliced = interpreter.changed(&planned, |plan| plan::sliced(plan, from, to), call.span)?;
    Ok(planned_value(Some(sliced)))
}

/// `sample`, `unstable_for` and `stability`, which begin at parameter `first`.
pub fn settings(interpreter: &Interpreter, call: &Call, first: usize) -> Eval<Settings> {
    let unstable_for = call.number(first + 1)?;
    if unstable_for < 0.0 {
        return Err(call.refuse(first + 1, "a time must not be negative"));
    }
    let stability =
        if call.word(first + 2) == Some("centres") { Stability::Centres } else { Stability::Footprint };
    let sample = call.positive(first, "the time between samples")?;
    Ok(Settings { sample, unstable_for, stability, ..interpreter.judge_settings() })
}

fn verify(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let settings = settings(interpreter, call, 1)?;
    let Some(planned) = plan_argument(interpreter, call, 0)? else { return Ok(Value::Unknown) };
    let verdict = interpreter.judge(&planned, settings, world_at(call, 4));
    interpreter.note_exemptions(&planned, &verdict);
    Ok(Value::Record(Rc::new(Record::Report(verdict))))
}

fn emit(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let (path, _) = output_path(call, 1)?;
    let settings = settings(interpreter, call, 2)?;
    let Some(planned) = plan_argument(interpreter, call, 0)? else { return Ok(Value::Unknown) };
    let verdict = interpreter.judge(&planned, settings, None);
    interpreter.note_exemptions(&planned, &verdict);
    let page = match interpreter.options.pages {
        true => Some(interpreter.draw(&planned, settings, Form::Page, &view::page_name(&path), call)?),
        false => None,
    };
    if !verdict.ok() {
        interpreter.report_failures(&planned, &verdict, call.at(0), page.as_deref());
        return Ok(Value::Unknown);
    }
    let excuses = interpreter.excuses(&planned, &settings);
    let plan = Plan { settings, verdict: Some(verdict.as_ref().clone()), ..planned.plan.clone() };
    let text = plan::file::write(&plan).map_err(|error| {
        fault(code::CANNOT_WRITE, call.at(0), format!("the plan can't be written: {error}"), "this plan")
    })?;
    write_output(interpreter, call, &path, text.into_bytes())?;
    if !excuses.is_empty() {
        interpreter.stage.print(format!("{path}: verified with {}", excuses.join(", ")));
    }
    note_settling(interpreter, call, &verdict.notes);
    Ok(Value::Nothing)
}

/// The file named by an argument, below the output folder, and its name as written.
pub fn output_path(call: &Call, index: usize) -> Eval<(String, String)> {
    let name = call.text(index)?.to_string();
    match files::join("", &name).filter(|path| !path.is_empty()) {
        Some(path) => Ok((path, name)),
        None => Err(outside(call, &name)),
    }
}

/// Writes a file into the output folder; gives the path to show. The second argument names it.
pub fn write_output(interpreter: &mut Interpreter, call: &Call, path: &str, bytes: Vec<u8>) -> Eval<String> {
    match interpreter.stage.write(path, bytes) {
        Ok(shown) => {
            if !interpreter.written.contains(&shown) {
                interpreter.written.push(shown.clone());
            }
            Ok(shown)
        }
        Err(WriteError::Outside) => Err(outside(call, path)),
        Err(WriteError::Failed(why)) => {
            let message = format!("`{path}` can't be written: {why}");
            Err(fault(code::CANNOT_WRITE, call.at(1), message, why))
        }
    }
}

/// A robot that does not start as it is drawn is worth a note.
fn note_settling(interpreter: &mut Interpreter, call: &Call, notes: &[String]) {
    for note in notes.iter().filter(|note| note.contains("settles")) {
        interpreter.add_report(Diagnostic::note(code::START_SETTLES, note).label(call.at(0), "of this plan"));
    }
}

fn outside(call: &Call, name: &str) -> Stop {
    Diagnostic::error(code::OUTSIDE_OUTPUT, format!("`{name}` leads out of the output folder"))
        .label(call.at(1), "output stays in the output folder")
        .hint("write a path below it, such as `walk.plan.json`")
        .into()
}
