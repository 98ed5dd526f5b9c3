//! `tosnake` and `reconfigure`: the planners of RoFI modules, as they are called.

use super::{Native, on_run};
use crate::behavior::{self, Problem};
use crate::elaborate::robot_of::Robot;
use crate::interpret::call::Call;
use crate::interpret::design::Design;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::unwindings::Sought;
use crate::interpret::value::Value;
use crate::interpret::verdicts::failure_line;
use crate::interrupt;
use crate::plan::{self, CauseId, Ground, World};
use crate::planners::tosnake::assembly::{JOINTS, NoRofi, port_name, translated};
use crate::planners::tosnake::scales::weighed;
use crate::planners::tosnake::sweep::LOAD_SPARE;
use crate::planners::tosnake::{
    self, Collisions, Dock, Doing, Found, Heavy, Progress, Refusal, Settings, Step, Unsound, Weight,
};
use crate::source::{Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
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
#[derive(Clone, Copy)]
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
                let stated = if call.word(first) == Some("on") { None } else { Some(call.number(first)?) };
                let gravity = stated.unwrap_or(World::default().gravity);
                if gravity < 0.0 {
                    return Err(call.refuse(first, "gravity acts downwards, so it can't be negative"));
                }
                World { gravity, ground: Ground::Held, ..World::default() }
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
        if world.gravity > 0.0 && collisions != Collisions::Motion {
            let why = "the paper's own method knows no weight: leave out `gravity` or `collisions`";
            return Err(call.refuse(first, why));
        }
        Ok(Options { world, seed, budget, timeout, collisions })
    }
}

fn unwind(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let options = Options::of(call, 1)?;
    let Some(wild) = Wild::of(interpreter, call, 0, &options)? else { return Ok(Value::Unknown) };
    let unwinding = wild.unwound(interpreter, call, &options)?;
    judged(interpreter, call, unwinding.planned, &options)
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
    let Some(first) = Wild::of(interpreter, call, 0, &options)? else { return Ok(Value::Unknown) };
    let Some(second) = Wild::of(interpreter, call, 1, &options)? else { return Ok(Value::Unknown) };
    let there = first.unwound(interpreter, call, &options)?;
    if let Some(weight) = &first.weight {
        return reconfigure_held(interpreter, call, (&there, weight), second, &options);
    }
    let back = second.unwound(interpreter, call, &options)?;
    let planned = there_and_back(call, &there, &back)?;
    judged(interpreter, call, planned, &options)
}

/// The one plan, and then the other backwards.
fn there_and_back(call: &Call, there: &Unwinding, back: &Unwinding) -> Eval<Planned> {
    let second = plan::reversed(&back.planned.plan);
    let mut plan = plan::joined(&there.planned.plan, &second).map_err(|unfit| {
        let message = format!("both unwind to a snake, but not to the same one: {unfit}");
        fault(code::NOT_COVERED, call.span, message, "some modules lie in it the other way round")
    })?;
    plan.provenance.planner = "reconfigure".into();
    let (there, back) = (&there.planned, &back.planned);
    let both = [there, back].map(|planned| planned.unwound.unwrap_or_default());
    let unwound = Unwound {
        docks: both[0].docks + both[1].undocks,
        undocks: both[0].undocks + both[1].docks,
        joint_travel: both[0].joint_travel + both[1].joint_travel,
        tried: both[0].tried + both[1].tried,
        work: both[0].work + both[1].work,
    };
    let causes = there.causes.iter().chain(&back.causes).copied().collect();
    let actions = there.actions + back.actions;
    Ok(Planned::new(there.robot.clone(), there.body.clone(), plan, causes, actions).with_unwound(unwound))
}

/// Both halves under weight: one module is held all the time, so the second robot has to be held by a
/// shoe that comes to the same place of the snake. Which one does is only known when it is unwound.
fn reconfigure_held(
    interpreter: &mut Interpreter,
    call: &Call,
    (there, weight): (&Unwinding, &Weight),
    second: Wild,
    options: &Options,
) -> Eval<Value> {
    let place = there.found.robot.beyond(weight.held);
    let own = second.weight.clone().expect("both are weighed");
    let (shoes, modules) = (own.shoes.len(), own.limits.len());
    let (mut work, mut unwound, mut nearest) = (there.found.progress.work, 0, None);
    // Held by each shoe, and with loops opened in each place: first far from where it is held.
    for (held, root) in (0..modules).flat_map(|turn| (0..shoes).map(move |held| (held, held / 2 + turn))) {
        let weight = Weight { held, root: root % modules, down: weight.down, ..own.clone() };
        let wild = Wild { weight: Some(weight), ..second.clone() };
        match wild.search(interpreter, options)? {
            Err(Refusal::Stopped(progress)) => {
                return Err(refused(call, second.index, &second.robot, &Refusal::Stopped(progress)));
            }
            Err(refusal) => nearest = Some(refusal),
            Ok(found) => {
                (work, unwound) = (work + found.progress.work, unwound + 1);
                if found.robot.beyond(held) == place {
                    let back = wild.assembled(interpreter, call, found, options)?;
                    let planned = there_and_back(call, there, &back)?;
                    let settings = interpreter.judge_settings();
                    if interpreter.judge(&planned, settings, None).ok() {
                        return judged(interpreter, call, planned, options);
                    }
                }
            }
        }
        if work > options.budget {
            break;
        }
    }
    match nearest.filter(|_| unwound == 0) {
        Some(refusal) => Err(refused(call, second.index, &second.robot, &refusal)),
        None => {
            let message = format!(
                "no way under gravity: of {unwound} ways in which the second robot unwinds, none is held where the \
                 first one's snake is"
            );
            Err(Diagnostic::error(code::NO_WAY, message)
                .label(call.at(1), "one module is held all the time")
                .hint("another `seed`, or another `base` of the first robot, may do")
                .into())
        }
    }
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
        if options.world.gravity > 0.0 {
            // The planner weighs links at the middles of the balls; other modules may differ.
            let message = format!("no plan was found that holds under gravity: {why}");
            return Err(Diagnostic::error(code::NO_WAY, message)
                .label(call.span, "what was found does not pass the judge")
                .hint("the search takes links for masses in the middle of the balls, as the library's are")
                .into());
        }
        return Err(defect(call, &format!("its plan does not pass the judge: {why}")));
    }
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

/// A robot that is to be unwound, as the planner sees it.
#[derive(Clone)]
struct Wild {
    /// Its place among the arguments.
    index: usize,
    design: Rc<Design>,
    robot: Rc<Robot>,
    start: tosnake::Robot,
    /// Under gravity.
    weight: Option<Weight>,
}

/// A way to the snake, not yet judged.
struct Unwinding {
    planned: Planned,
    found: Rc<Found>,
}

impl Wild {
    /// `None` where the robot is not sound.
    fn of(interpreter: &mut Interpreter, call: &Call, index: usize, options: &Options) -> Eval<Option<Wild>> {
        let design = call.instance(index)?.design.clone();
        let Some(robot) = interpreter.robot_at(&design, call.at(index))? else { return Ok(None) };
        let no_rofi = |no: NoRofi| not_rofi(call, index, &robot, &no);
        let start = translated(&robot.assembly, &robot.start).map_err(no_rofi)?.robot;
        let gravity = options.world.gravity;
        let weighed = || weighed(&robot.assembly, &robot.start.base, gravity).map_err(no_rofi);
        let weight = if gravity > 0.0 { Some(weighed()?) } else { None };
        Ok(Some(Wild { index, design, robot, start, weight }))
    }

    fn unwound(&self, interpreter: &mut Interpreter, call: &Call, options: &Options) -> Eval<Unwinding> {
        let no_way = |refusal| refused(call, self.index, &self.robot, &refusal);
        let found = self.search(interpreter, options)?.map_err(no_way)?;
        self.assembled(interpreter, call, found, options)
    }

    /// Looks for a way, unless one was found before.
    fn search(&self, interpreter: &mut Interpreter, options: &Options) -> Eval<Result<Rc<Found>, Refusal>> {
        let Options { seed, budget, collisions, .. } = *options;
        let (robot, weight) = (self.start.clone(), self.weight.clone());
        let sought = Sought { robot, seed, budget, collisions, weight };
        if let Some(found) = interpreter.unwindings.get(&sought) {
            return Ok(Ok(found));
        }
        let stage = &interpreter.stage;
        let goes_on = stage.until(options.timeout);
        interrupt::start_task(format!("unwinding {}", self.design.name));
        let mut told = None;
        let mut watch = |progress: &Progress| {
            let Progress { needed, made, tried, .. } = progress;
            let words = || format!("{made} of {needed} connections made, {tried} pairs of ends tried");
            if told.replace(*made) == Some(*made) {
                interrupt::progress_checkpoint(words)
            } else {
                interrupt::report_progress(words())
            }
            goes_on()
        };
        let threads = interpreter.options.threads.max(1);
        let settings = Settings { seed, budget, collisions, threads, ..Settings::default() };
        let found = tosnake::unwind_under(&self.start, self.weight.as_ref(), &settings, &mut watch);
        if matches!(found, Err(Refusal::Stopped(_))) && stage.cancelled() {
            return Err(Stop::Halt);
        }
        Ok(found.map(|found| {
            let found = Rc::new(found);
            interpreter.unwindings.keep(sought, found.clone());
            found
        }))
    }

    /// The way as a plan.
    fn assembled(
        &self,
        interpreter: &mut Interpreter,
        call: &Call,
        found: Rc<Found>,
        options: &Options,
    ) -> Eval<Unwinding> {
        let robot = &self.robot;
        let translated = translated(&robot.assembly, &robot.start).expect("it was translated before");
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
        let told = told(&self.start, &found);
        let (mut planned, _) =
            interpreter.assemble_plan(self.design.clone(), robot.clone(), scheduled, &causes, options.world);
        planned.plan.provenance.planner = match options.collisions {
            Collisions::Motion => "tosnake",
            Collisions::None => "tosnake, collisions: none",
            Collisions::Detection => "tosnake, collisions: detection",
            Collisions::Avoidance => "tosnake, collisions: avoidance",
        }
        .into();
        planned.plan.provenance.seed = Some(options.seed);
        planned.plan.provenance.budget = Some(options.budget);
        Ok(Unwinding { planned: planned.with_unwound(told), found })
    }
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
        Refusal::Heavy(heavy) => too_heavy(at, robot, heavy),
        Refusal::NoTips(progress) => {
            let hint = "a tip is a free dock -Z; connections that take one can be left out";
            fell_short(at, "no two tentacles have a free tip", progress, hint)
        }
    }
}

/// Which joint would have to hold what, when doing what.
fn too_heavy(at: Span, robot: &Robot, heavy: &Heavy) -> Stop {
    let Heavy { load, doing, progress } = heavy;
    let assembly = &robot.assembly;
    let kind = assembly.module_type(load.module);
    let joint = kind.joints.iter().find(|joint| joint.name == JOINTS[load.joint]);
    let limit = joint.and_then(|joint| joint.limits.effort).unwrap_or(f64::INFINITY);
    let words = |torque: f64| quantity(torque, Dimension::TORQUE);
    let dock =
        |dock: &Dock| format!("{}.{}", assembly.modules[dock.module].name, port_name(dock.module, dock.dock));
    let (name, short) = (&assembly.modules[load.module].name, JOINTS[load.joint]);
    let when = match doing {
        Doing::Standing => "before anything moves".to_string(),
        Doing::Opening => "once its loops are opened".to_string(),
        Doing::Joining(a, b) => format!("when {} and {} are brought together", dock(a), dock(b)),
        Doing::Straightening => "when the snake is straightened".to_string(),
        Doing::Ending => "in the straight snake".to_string(),
    };
    let (would, limit) = (words(load.ratio * limit), words(limit));
    let spare = match load.ratio > 1.0 {
        true => String::new(),
        false => format!(", of which the search leaves {}%", 100.0 * LOAD_SPARE),
    };
    let message =
        format!("too heavy: {when} {name}.{short} would have to hold {would}; it holds {limit}{spare}");
    let Progress { needed, made, tried, .. } = progress;
    let held = &assembly.modules[assembly.base].name;
    let label = match doing {
        Doing::Standing | Doing::Opening => format!("held by {held}"),
        _ => format!(
            "held by {held}; {made} of {needed} connections were made, {tried} pairs of ends tried, and nothing was less heavy"
        ),
    };
    Diagnostic::error(code::NO_WAY, message)
        .label(at, label)
        .hint("another `base` is held elsewhere, another `seed` may find a lighter way; `gravity: off` is weightless")
        .into()
}

/// How far a search came that did not come to its end.
fn fell_short(at: Span, what: &str, progress: &Progress, hint: &str) -> Stop {
    let Progress { needed, made, tried, work, longest, chains, .. } = progress;
    let message =
        format!("{what}: {made} of {needed} connections were made, and {tried} pairs of ends tried");
    let modules = if *longest == 1 { "module" } else { "modules" };
    let reached = format!("at best {chains} chains, the longest of {longest} {modules}, after {work} poses");
    Diagnostic::error(code::NO_WAY, message).label(at, reached).hint(hint).into()
}

fn defect(call: &Call, what: &str) -> Stop {
    let message = format!("the planner failed: {what}");
    fault(code::NOT_VERIFIED, call.span, message, "a defect of the planner, not of this program")
}
