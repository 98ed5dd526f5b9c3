//! `tosnake`: the planner of RoFI modules, as it is called; and what it has in common with `reconfigure`.

use super::Native;
use super::unwind::no_snake;
use crate::interpret::argument::{Auto, Choice, Positive, WordOr, arguments};
use crate::interpret::causes::PlanCauses;
use crate::interpret::design::{Design, Instance, shorten};
use crate::interpret::evaluator_thread::HostProxy;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::record::Record;
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::interpret::verdicts::failure_line;
use crate::interrupt;
use crate::plan::{Body, Ground, Plan, Program, World};
use crate::planners::tosnake::conversion::{JOINTS, port_name};
use crate::planners::tosnake::{
    self, Collisions, Dock, InvalidStart, NotRofi, Operation, Overload, Refusal, Report, SearchStatus,
    Settings, TOLERANCES,
};
use crate::planners::{Progress, Solution, unwind};
use crate::source::{Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The built-in `tosnake`: its key with its parameters and its Rust function.
pub const TABLE: &[Native] = &[Native::on_run("tosnake", TosnakeArguments::PARAMETERS, native_tosnake)];

impl ReportFields for Report {
    const FIELDS: &'static [ReportField<Report>] = &[
        ("docks", |_, _, report| Value::count(report.docks)),
        ("undocks", |_, _, report| Value::count(report.undocks)),
        ("fewest_changes", |_, _, report| Value::count(report.fewest_changes)),
        ("why", |_, _, report| Value::text(why_changes(report))),
        ("joint_travel", |_, _, report| Value::Quantity(report.joint_travel, Dimension::ANGLE)),
        ("tried", |_, _, report| Value::count(report.tried as usize)),
        ("work", |_, _, report| Value::count(report.work as usize)),
    ];
}

/// Returns what the changes of connections on the way to a snake are for, and if fewer would do, in words.
fn why_changes(report: &Report) -> String {
    let &Report { docks, undocks, fewest_changes, .. } = report;
    let changes = docks + undocks;
    if changes == 0 {
        return "the robot is one chain: joints turn alone".into();
    }
    let loops = undocks - docks;
    let closing = match loops {
        0 => String::new(),
        1 => "a connection that closes a loop goes; ".into(),
        loops => format!("{loops} connections that close loops go; "),
    };
    let joining = match docks {
        0 => "one chain is left".into(),
        1 => "two chains become one".into(),
        docks => format!("{docks} times two chains become one"),
    };
    let bound = if changes == fewest_changes {
        "no plan changes fewer connections".into()
    } else {
        format!("{changes} changes, and no plan needs fewer than {fewest_changes}")
    };
    format!("{closing}{joining}: {bound}")
}

arguments! {
    /// The arguments of `tosnake`.
    struct TosnakeArguments<'c> {
        robot: &'c Rc<Instance>,
        ..search: SearchArguments,
    }
}

arguments! {
    /// The arguments about the search, which both calls have.
    pub(super) struct SearchArguments {
        gravity: WordOr<Gravity, f64>,
        seed: WordOr<Auto, usize> as "a seed",
        budget: usize as "a budget",
        timeout: Option<Positive> as "a timeout",
        collisions: Collisions,
    }
}

/// The words of `gravity`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gravity {
    /// The robot floats.
    Off,
    /// The base is held, under the gravity of the earth.
    On,
}

impl Choice for Gravity {
    const WORDS: &'static [(&'static str, Gravity)] = &[("off", Gravity::Off), ("on", Gravity::On)];
}

impl Choice for Collisions {
    const WORDS: &'static [(&'static str, Collisions)] = &[
        ("motion", Collisions::Motion),
        ("none", Collisions::None),
        ("detection", Collisions::Detection),
        ("avoidance", Collisions::Avoidance),
    ];
}

/// The options that both calls have.
#[derive(Clone, Copy)]
pub(super) struct Options {
    pub(super) world: World,
    seed: u64,
    budget: u64,
    /// The time limit of each search, s; `None` for no limit.
    timeout: Option<f64>,
    collisions: Collisions,
}

impl Options {
    /// Returns the options that the arguments ask for.
    ///
    /// # Errors
    /// A fault where gravity is negative, or the paper's own method is to plan under gravity.
    pub(super) fn of(interpreter: &Interpreter, call: &Call, arguments: &SearchArguments) -> Eval<Options> {
        let SearchArguments { gravity, seed, budget, timeout, collisions } = *arguments;
        let world = world(call, gravity)?;
        if world.gravity > 0.0 && collisions != Collisions::Motion {
            let why = "the paper's own method knows no weight: leave out `gravity` or `collisions`";
            return Err(call.refuse("gravity", why));
        }
        let timeout = timeout.map(|Positive(seconds)| seconds);
        Ok(Options { world, seed: interpreter.seed(seed), budget: budget as u64, timeout, collisions })
    }

    pub(super) fn settings(&self, interpreter: &Interpreter) -> Settings {
        let Options { seed, budget, collisions, .. } = *self;
        let threads = interpreter.shared.options.threads.max(1);
        Settings { seed, budget, collisions, threads, ..Settings::default() }
    }

    /// Returns true if robots of any modules can be planned for with these options.
    pub(super) fn is_for_any_module(&self) -> bool {
        self.world == World::FREE && self.collisions == Collisions::Motion
    }

    /// Returns the settings of the planner for any modules.
    pub(super) fn unwinding(&self) -> unwind::Settings {
        unwind::Settings { seed: self.seed, budget: self.budget, ..unwind::Settings::default() }
    }

    /// Returns the plan of a motion that a search with these options found.
    pub(super) fn plan(
        &self,
        interpreter: &Interpreter,
        planner: &str,
        (body, program): (Body, Option<Program>),
        robot: &Robot,
        causes: &PlanCauses,
    ) -> Plan {
        let library = robot.assembly.library.clone();
        let mut plan = interpreter.bare_plan(planner, body, library, self.world, causes);
        plan.program = program;
        plan.provenance.seed = Some(self.seed);
        plan.provenance.budget = Some(self.budget);
        plan
    }
}

/// Returns the world that the argument `gravity` asks for: with gravity the base is held.
///
/// # Errors
/// A fault where gravity is negative.
fn world(call: &Call, gravity: WordOr<Gravity, f64>) -> Eval<World> {
    let gravity = match gravity {
        WordOr::Word(Gravity::Off) => return Ok(World::FREE),
        WordOr::Word(Gravity::On) => World::default().gravity,
        WordOr::Value(gravity) => gravity,
    };
    if gravity < 0.0 {
        return Err(call.refuse("gravity", "gravity acts downwards, so it can't be negative"));
    }
    Ok(World { gravity, ground: Ground::Held, ..World::FREE })
}

/// Shows progress to the user, and ends a search at the timeout or when the user cancels the run.
pub(super) struct Observer {
    host: HostProxy,
    timeout: Option<f64>,
    goes_on: Box<dyn Fn() -> bool>,
}

impl Observer {
    pub(super) fn new(interpreter: &Interpreter, options: &Options) -> Observer {
        Observer {
            host: interpreter.shared.host.clone(),
            timeout: options.timeout,
            goes_on: Box::new(|| true),
        }
    }
}

impl Progress for Observer {
    fn task_started(&mut self, task: &dyn Fn() -> String) {
        let (host, timeout, begun) = (self.host.clone(), self.timeout, self.host.elapsed());
        self.goes_on =
            Box::new(move || !host.cancelled() && timeout.is_none_or(|most| host.elapsed() - begun <= most));
        interrupt::start_task(task());
    }

    fn report(&mut self, how_far: &dyn Fn() -> String) {
        interrupt::progress_checkpoint(how_far);
    }

    fn milestone(&mut self, reached: &dyn Fn() -> String) {
        interrupt::report_progress(reached());
    }

    fn should_continue(&mut self) -> bool {
        (self.goes_on)()
    }
}

/// A robot among the arguments.
pub(super) struct Subject {
    /// The parameter.
    parameter: &'static str,
    pub(super) design: Rc<Design>,
    pub(super) robot: Rc<Robot>,
}

impl Subject {
    /// Returns the subject of an argument; `None` where the robot is broken.
    pub(super) fn of(
        interpreter: &mut Interpreter,
        call: &Call,
        parameter: &'static str,
        instance: &Instance,
    ) -> Eval<Option<Subject>> {
        let design = instance.design.clone();
        let robot = interpreter.robot_at(&design, call.at(parameter))?;
        Ok(robot.map(|robot| Subject { parameter, design, robot }))
    }

    /// Returns the problem of unwinding it, whatever its modules are.
    pub(super) fn unwinding(&self) -> unwind::Problem<'_> {
        unwind::Problem { robot: &self.robot.assembly, start: &self.robot.start }
    }

    /// Returns the robot with its place in the text.
    pub(super) fn place(&self, call: &Call) -> (&Robot, Span) {
        (&self.robot, call.at(self.parameter))
    }
}

/// Runs `tosnake`.
fn native_tosnake(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let TosnakeArguments { robot, search } = TosnakeArguments::read(call)?;
    let options = Options::of(interpreter, call, &search)?;
    let Some(subject) = Subject::of(interpreter, call, "robot", robot)? else { return Ok(Value::Unknown) };
    let causes = interpreter.planner_causes(call.span);
    let settings = options.settings(interpreter);
    let mut observer = Observer::new(interpreter, &options);
    let Robot { assembly, start, .. } = &*subject.robot;
    let problem = tosnake::Problem { robot: assembly, start, world: options.world };
    let solution =
        tosnake::plan_with_cache(&problem, &settings, &mut interpreter.memory.search_cache, &mut observer);
    let solution = match solution {
        // Other modules have a planner of their own, which knows neither weight nor the paper's method.
        Err(Refusal::NotRofi(_)) if options.is_for_any_module() => {
            let found = unwind::plan(&subject.unwinding(), &options.unwinding(), &mut observer);
            found.map_err(|refusal| no_snake(interpreter, call, subject.place(call), &causes, &refusal))?
        }
        other => other.map_err(|refusal| refused(interpreter, call, &subject, &causes, &refusal))?,
    };
    let Solution { body, program, report } = solution;
    let planner = options.collisions.planner();
    let plan = options.plan(interpreter, planner, (body, program), &subject.robot, &causes);
    let Subject { design, robot, .. } = subject;
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids, report.actions).with_report(report);
    judged(interpreter, call, planned, &options)
}

/// Returns the plan if it passes the judge; with the paper's own method, whatever its verdict.
///
/// # Errors
/// A fault with the first failure where it does not pass.
pub(super) fn judged(
    interpreter: &mut Interpreter,
    call: &Call,
    planned: PlanValue,
    options: &Options,
) -> Eval<Value> {
    if options.collisions != Collisions::Motion {
        return Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))));
    }
    let settings = interpreter.judge_settings();
    let verdict = interpreter.judge(&planned, settings, None)?;
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

fn not_rofi(at: Span, robot: &Robot, no: &NotRofi) -> Stop {
    let name = |module: usize| &robot.assembly.modules[module].name;
    let (message, label) = match no {
        NotRofi::Kind(module) => {
            let label =
                "under gravity, and by the paper's own method, only robots of `std.rofi.Rofi` are unwound";
            (format!("{} is no RoFI module", name(*module)), label)
        }
        NotRofi::Pitch(module) => {
            let message = format!("{} has another pitch than {}", name(*module), name(0));
            (message, "modules of one size are wanted")
        }
    };
    fault(code::NOT_COVERED, at, message, label)
}

/// Returns the fault of a refusal of the planner, at the robot that it refuses; `Stop::Halt` if the user cancelled.
pub(super) fn refused(
    interpreter: &Interpreter,
    call: &Call,
    subject: &Subject,
    causes: &PlanCauses,
    refusal: &Refusal,
) -> Stop {
    let (robot, at) = (&subject.robot, call.at(subject.parameter));
    let ended = |what: &str, status: &SearchStatus, hint: &str| fell_short(at, what, status, hint);
    match refusal {
        Refusal::Stopped(_) if interpreter.shared.host.cancelled() => Stop::Halt,
        Refusal::NotRofi(no) => not_rofi(at, robot, no),
        Refusal::InvalidStart(invalid) => invalid_start(at, robot, invalid),
        Refusal::OpenLoop { bond, residual } => {
            let bond = robot.assembly.bonds[*bond];
            let [a, b] = [bond.a, bond.b].map(|port| robot.assembly.port_name(port));
            let message =
                format!("{a} and {b} are connected and do not meet: {residual:.3} of a pitch is missing");
            fault(code::NO_WAY, at, message, "a loop that is open")
        }
        Refusal::DoesNotStand { margin } => {
            let message = if *margin > 0.0 {
                "it does not stand on the floor: its weight is on the brink of what supports it"
            } else {
                "it does not stand on the floor: what supports it spans no area"
            };
            fault(
                code::NO_WAY,
                at,
                message.to_string(),
                "put down as it was drawn, it rolls over until it rests",
            )
        }
        Refusal::GravityUnsupported => fault(code::BAD_VALUE, at, refusal.to_string(), "no gravity"),
        Refusal::BudgetSpent(status) => {
            let hint = "a greater `budget` or another `seed` may find one";
            ended("no way to the snake within the budget", status, hint)
        }
        Refusal::Stopped(status) => {
            let hint = "a greater `timeout` or another `seed` may find one";
            ended("no way to the snake within the timeout", status, hint)
        }
        Refusal::Exhausted(status) => {
            let hint = "the default, `collisions: motion`, does not give up so";
            ended("no order of pairs of tentacles leads to the snake", status, hint)
        }
        Refusal::NoFreeTips(status) => {
            let hint = "a tip is a free dock -Z; connections that take one can be left out";
            ended("no two tentacles have a free tip", status, hint)
        }
        Refusal::Overload(overload) => overloaded(at, robot, overload),
        Refusal::Schedule(refusal) => interpreter.refused(refusal, &causes.ids, call.span),
    }
}

fn invalid_start(at: Span, robot: &Robot, invalid: &InvalidStart) -> Stop {
    let name = |module: usize| &robot.assembly.modules[module].name;
    match invalid {
        InvalidStart::Disconnected(module) => {
            let message = format!("the robot is in pieces: {} hangs on nothing", name(*module));
            fault(code::NO_WAY, at, message, "not in one piece")
        }
        InvalidStart::Overlap { modules: [a, b], bonds, .. } => {
            let message = format!("{} and {} are in each other before anything moves", name(*a), name(*b));
            let ends = |bond: &usize| {
                let bond = robot.assembly.bonds[*bond];
                let [a, b] = [bond.a, bond.b].map(|port| robot.assembly.port_name(port));
                format!("{a} -- {b}")
            };
            let bonds: Vec<String> = bonds.iter().map(ends).collect();
            Diagnostic::error(code::NO_WAY, message)
                .label(at, "starts with a collision")
                .hint(format!("the connections between them put them there: {}", shorten(&bonds)))
                .into()
        }
    }
}

/// Returns the fault of an overload: the joint, its load, and the operation that loads it.
fn overloaded(at: Span, robot: &Robot, overload: &Overload) -> Stop {
    let Overload { load, operation, status } = overload;
    let assembly = &robot.assembly;
    let kind = assembly.module_type(load.module);
    let joint = kind.joints.iter().find(|joint| joint.name == JOINTS[load.joint]);
    let limit = joint.and_then(|joint| joint.limits.effort).unwrap_or(f64::INFINITY);
    let words = |torque: f64| quantity(torque, Dimension::TORQUE);
    let dock =
        |dock: &Dock| format!("{}.{}", assembly.modules[dock.module].name, port_name(dock.module, dock.dock));
    let (name, short) = (&assembly.modules[load.module].name, JOINTS[load.joint]);
    let when = match operation {
        Operation::HoldingStart => "before anything moves".to_string(),
        Operation::OpeningLoops => "once its loops are opened".to_string(),
        Operation::Joining(a, b) => format!("when {} and {} are brought together", dock(a), dock(b)),
        Operation::Straightening => "when the snake is straightened".to_string(),
        Operation::HoldingSnake => "in the straight snake".to_string(),
    };
    let (would, limit) = (words(load.ratio * limit), words(limit));
    let spare = match load.ratio > 1.0 {
        true => String::new(),
        false => format!(", of which the search leaves {}%", 100.0 * TOLERANCES.load_spare),
    };
    let message =
        format!("too heavy: {when} {name}.{short} would have to hold {would}; it holds {limit}{spare}");
    let SearchStatus { needed, made, tried, .. } = status;
    let held = &assembly.modules[assembly.base].name;
    let label = match operation {
        Operation::HoldingStart | Operation::OpeningLoops => format!("held by {held}"),
        _ => format!(
            "held by {held}; {made} of {needed} connections were made, {tried} pairs of ends tried, and nothing was less heavy"
        ),
    };
    Diagnostic::error(code::NO_WAY, message)
        .label(at, label)
        .hint("another `base` is held elsewhere, another `seed` may find a lighter way; `gravity: off` is weightless")
        .into()
}

/// Returns the fault of a search that did not come to its end, with its progress.
fn fell_short(at: Span, what: &str, status: &SearchStatus, hint: &str) -> Stop {
    let SearchStatus { needed, made, tried, work, longest, chains, .. } = status;
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
