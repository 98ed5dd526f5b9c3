//! `tosnake` and `reconfigure`: the planners of RoFI modules, as they are called.

use super::call::Call;
use super::interpreter::Interpreter;
use super::natives::{Native, on_run};
use super::planning::Planned;
use super::record::Record;
use super::robot_of::Robot;
use super::stop::{Eval, Stop, fault};
use super::unwindings::Sought;
use super::value::Value;
use super::verdicts::failure_line;
use crate::behavior::{self, Problem};
use crate::interrupt;
use crate::plan::{self, CauseId, Ground, World};
use crate::planners::tosnake::assembly::{NoRofi, translated};
use crate::planners::tosnake::{self, Collisions, Found, Progress, Refusal, Settings, Step, Unsound};
use crate::source::{Diagnostic, Span, code};
use crate::units::Dimension;
use std::rc::Rc;

pub const TABLE: &[Native] = &[on_run("tosnake", 6, unwind), on_run("reconfigure", 7, reconfigure)];

/// What the planner says of its plan.
#[derive(Clone, Copy, Default)]
pub struct Unwound {
    pub docks: usize,
    pub undocks: usize,
    /// Of all joints together, rad.
    pub joint_travel: f64,
    /// Pairs of ends that were tried.
    pub tried: u64,
    /// Poses of the robot that were worked out.
    pub work: u64,
}

/// The fields of an `Unwinding` beside those of a plan.
pub const UNWINDING: &[&str] = &["docks", "undocks", "joint_travel", "tried", "work"];

pub fn unwinding_field(unwound: &Unwound, field: &str) -> Value {
    match field {
        "docks" => Value::count(unwound.docks),
        "undocks" => Value::count(unwound.undocks),
        "joint_travel" => Value::Quantity(unwound.joint_travel, Dimension::ANGLE),
        "tried" => Value::count(unwound.tried as usize),
        "work" => Value::count(unwound.work as usize),
        _ => Value::Unknown,
    }
}

/// The options that both calls have, by where they begin.
struct Options {
    world: World,
    seed: u64,
    budget: u64,
    /// Seconds for the whole search.
    timeout: Option<f64>,
    collisions: Collisions,
}

impl Options {
    fn of(call: &Call, first: usize) -> Eval<Options> {
        let world = match call.word(first) {
            Some("off") => World::FREE,
            _ => {
                let gravity = call.number(first)?;
                if gravity < 0.0 {
                    return Err(call.refuse(first, "gravity acts downwards, so it can't be negative"));
                }
                // The base is held: nothing is known of a ground.
                World { gravity, ground: Ground::Fixed, ..World::default() }
            }
        };
        let timeout = call.positive_if(first + 3, "a timeout")?;
        let seed = call.count(first + 1, "a seed")? as u64;
        let budget = call.count(first + 2, "a budget")? as u64;
        let collisions = match call.word(first + 4) {
            Some("none") => Collisions::None,
            Some("detection") => Collisions::Detection,
            Some("avoidance") => Collisions::Avoidance,
            _ => Collisions::Motion,
        };
        Ok(Options { world, seed, budget, timeout, collisions })
    }
}

fn unwind(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let options = Options::of(call, 1)?;
    match unwound(interpreter, call, 0, &options)? {
        Some(planned) => judged(interpreter, call, planned, &options),
        None => Ok(Value::Unknown),
    }
}

fn reconfigure(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let options = Options::of(call, 2)?;
    let (from, to) = (call.instance(0)?.design.clone(), call.instance(1)?.design.clone());
    let (a, b) = (from.module_count(), to.module_count());
    if a != b {
        let message = format!("a robot of {a} modules can't become one of {b}");
        return Err(Diagnostic::error(code::NO_WAY, message)
            .label(call.at(1), format!("{b} modules"))
            .label(call.at(0), format!("{a} modules"))
            .hint("modules are neither added nor taken away")
            .into());
    }
    let Some(there) = unwound(interpreter, call, 0, &options)? else { return Ok(Value::Unknown) };
    let Some(back) = unwound(interpreter, call, 1, &options)? else { return Ok(Value::Unknown) };
    let second = plan::reversed(&back.plan);
    let mut plan = plan::joined(&there.plan, &second).map_err(|unfit| {
        let message = format!("both unwind to a snake, but not to the same one: {unfit}");
        fault(code::NOT_COVERED, call.span, message, "some modules lie in it the other way round")
    })?;
    plan.provenance.planner = "reconfigure".into();
    let both = [&there, &back].map(|planned| planned.unwound.unwrap_or_default());
    let unwound = Unwound {
        docks: both[0].docks + both[1].undocks,
        undocks: both[0].undocks + both[1].docks,
        joint_travel: both[0].joint_travel + both[1].joint_travel,
        tried: both[0].tried + both[1].tried,
        work: both[0].work + both[1].work,
    };
    let causes = there.causes.iter().chain(&back.causes).copied().collect();
    let actions = there.actions + back.actions;
    let planned = Planned::new(there.robot, there.body, plan, causes, actions).with_unwound(unwound);
    judged(interpreter, call, planned, &options)
}

/// The plan, if the judge lets it through; of the paper's method whatever he would say of it.
fn judged(interpreter: &mut Interpreter, call: &Call, planned: Planned, options: &Options) -> Eval<Value> {
    if options.collisions != Collisions::Motion {
        return Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))));
    }
    let settings = interpreter.judge_settings();
    let verdict = interpreter.judge(&planned, settings, None);
    if !verdict.ok() {
        let first = verdict.failures.iter().min_by(|a, b| a.time.total_cmp(&b.time));
        let why = first.map_or_else(|| "it was not judged to its end".to_string(), failure_line);
        if planned.plan.worlds.iter().any(|world| world.world.gravity > 0.0) {
            let message = format!("no plan was found that holds under gravity: {why}");
            return Err(Diagnostic::error(code::NO_WAY, message)
                .label(call.span, "planned without regard to weight, and then judged under it")
                .hint("`gravity: off` is the world that this planner knows")
                .into());
        }
        return Err(defect(call, &format!("its plan does not pass the judge: {why}")));
    }
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

/// The way of a robot to the snake, not yet judged; `None` where the robot is not sound.
fn unwound(
    interpreter: &mut Interpreter,
    call: &Call,
    index: usize,
    options: &Options,
) -> Eval<Option<Planned>> {
    let design = call.instance(index)?.design.clone();
    let Some(robot) = interpreter.robot_at(&design, call.at(index))? else { return Ok(None) };
    let translated =
        translated(&robot.assembly, &robot.start).map_err(|no| not_rofi(call, index, &robot, &no))?;
    let Options { seed, budget, collisions, .. } = *options;
    let sought = Sought { robot: translated.robot.clone(), seed, budget, collisions };
    let known = interpreter.unwindings.get(&sought);
    let found = if let Some(found) = known {
        found
    } else {
        let stage = &interpreter.stage;
        let begun = stage.elapsed();
        interrupt::begin(format!("unwinding {}", design.name));
        let mut told = None;
        let mut watch = |progress: &Progress| {
            let Progress { needed, made, tried, .. } = progress;
            let words = || format!("{made} of {needed} connections made, {tried} pairs of ends tried");
            if told.replace(*made) == Some(*made) {
                interrupt::progress(words)
            } else {
                interrupt::tell(words())
            }
            !stage.cancelled() && options.timeout.is_none_or(|most| stage.elapsed() - begun <= most)
        };
        let settings = Settings { seed, budget, collisions, ..Settings::default() };
        let found = tosnake::unwind(&translated.robot, &settings, &mut watch);
        if matches!(found, Err(Refusal::Stopped(_))) && stage.cancelled() {
            return Err(Stop::Halt);
        }
        let found = Rc::new(found.map_err(|refusal| refused(call, index, &robot, &refusal))?);
        interpreter.unwindings.keep(sought, found.clone());
        found
    };
    let program = translated.program(&found.steps, &found.robot.bonds, CauseId(0));
    let causes = interpreter.planner_causes(call.span);
    let problem = Problem {
        robot: robot.assembly.as_ref().clone(),
        start: robot.start.clone(),
        program,
        start_causes: Vec::new(),
        bond_causes: (0..robot.assembly.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
        settings: behavior::Settings::default(),
    };
    let scheduled = behavior::schedule(problem)
        .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, call.span))?;
    let told = told(&translated.robot, &found);
    let (mut planned, _) =
        interpreter.assemble_plan(design, robot.clone(), scheduled, &causes, options.world);
    planned.plan.provenance.planner = match options.collisions {
        Collisions::Motion => "tosnake",
        Collisions::None => "tosnake, collisions: none",
        Collisions::Detection => "tosnake, collisions: detection",
        Collisions::Avoidance => "tosnake, collisions: avoidance",
    }
    .into();
    planned.plan.provenance.seed = Some(options.seed);
    planned.plan.provenance.budget = Some(options.budget);
    Ok(Some(planned.with_unwound(told)))
}

fn told(start: &tosnake::Robot, found: &Found) -> Unwound {
    let mut told = Unwound { tried: found.progress.tried, work: found.progress.work, ..Unwound::default() };
    let mut joints = start.joints.clone();
    for step in &found.steps {
        match step {
            Step::Dock(_) => told.docks += 1,
            Step::Undock(_) => told.undocks += 1,
            Step::Turn(turns) => {
                for &(module, joint, to) in turns {
                    told.joint_travel += (to - joints[module][joint]).abs();
                    joints[module][joint] = to;
                }
            }
        }
    }
    told
}

fn not_rofi(call: &Call, index: usize, robot: &Robot, no: &NoRofi) -> Stop {
    let name = |module: usize| &robot.assembly.modules[module].name;
    let (message, label) = match no {
        NoRofi::Kind(module) => {
            (format!("{} is no RoFI module", name(*module)), "only robots of `std.rofi.Rofi` are unwound")
        }
        NoRofi::Pitch(module) => {
            let message = format!("{} has another pitch than {}", name(*module), name(0));
            (message, "modules of one size are wanted")
        }
    };
    fault(code::NOT_COVERED, call.at(index), message, label)
}

fn refused(call: &Call, index: usize, robot: &Robot, refusal: &Refusal) -> Stop {
    let name = |module: usize| robot.assembly.modules[module].name.clone();
    let at = call.at(index);
    match refusal {
        Refusal::Unsound(Unsound::Loose(module)) => {
            let message = format!("the robot is in pieces: {} hangs on nothing", name(*module));
            fault(code::NO_WAY, at, message, "not in one piece")
        }
        Refusal::Unsound(Unsound::Overlap(a, b, _)) => {
            let message = format!("{} and {} are in each other before anything moves", name(*a), name(*b));
            fault(code::NO_WAY, at, message, "starts with a collision")
        }
        Refusal::Open { bond, missing } => {
            let bond = robot.assembly.bonds[*bond];
            let [a, b] = [bond.a, bond.b].map(|port| robot.assembly.port_name(port));
            let message =
                format!("{a} and {b} are connected and do not meet: {missing:.3} of a pitch is missing");
            fault(code::NO_WAY, at, message, "a loop that is open")
        }
        Refusal::Budget(progress) => {
            let hint = "a greater `budget` or another `seed` may find one";
            fell_short(at, "no way to the snake within the budget", progress, hint)
        }
        Refusal::Stopped(progress) => {
            let hint = "a greater `timeout` or another `seed` may find one";
            fell_short(at, "no way to the snake within the timeout", progress, hint)
        }
        Refusal::Exhausted(progress) => {
            let hint = "the default, `collisions: motion`, does not give up so";
            fell_short(at, "no order of pairs of tentacles leads to the snake", progress, hint)
        }
        Refusal::NoTips(progress) => {
            let hint = "a tip is a free dock -Z; connections that take one can be left out";
            fell_short(at, "no two tentacles have a free tip", progress, hint)
        }
    }
}

/// How far a search came that did not come to its end.
fn fell_short(at: Span, what: &str, progress: &Progress, hint: &str) -> Stop {
    let Progress { needed, made, tried, work, longest, chains } = progress;
    let message =
        format!("{what}: {made} of {needed} connections were made, and {tried} pairs of ends tried");
    let reached = format!("at best {chains} chains, the longest of {longest} modules, after {work} poses");
    Diagnostic::error(code::NO_WAY, message).label(at, reached).hint(hint).into()
}

fn defect(call: &Call, what: &str) -> Stop {
    let message = format!("the planner failed: {what}");
    fault(code::NOT_VERIFIED, call.span, message, "a defect of the planner, not of this program")
}
