//! `reconfigure`: the planner of the ways from one robot of RoFI modules to another, as it is called.

use super::Native;
use super::tosnake::{Observer, Options, SearchArguments, Subject, judged, refused};
use super::unwind::no_snake;
use crate::interpret::argument::{Choice, arguments};
use crate::interpret::design::Instance;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::Value;
use crate::plan::Ground;
use crate::planners::reconfigure::{self, NoStandingWay, Way};
use crate::planners::tosnake::conversion::JOINTS;
use crate::planners::tosnake::{JointLoad, Refusal};
use crate::planners::{Solution, unwind};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;

/// The built-in `reconfigure`: its key with its parameters and its Rust function.
pub const TABLE: &[Native] =
    &[Native::on_run("reconfigure", ReconfigureArguments::PARAMETERS, native_reconfigure)];

impl ReportFields for reconfigure::Report {
    const FIELDS: &'static [ReportField<reconfigure::Report>] = &[
        ("docks", |_, _, report| Value::count(report.both.docks)),
        ("undocks", |_, _, report| Value::count(report.both.undocks)),
        ("fewest_changes", |_, _, report| Value::count(report.fewest_changes)),
        ("joint_travel", |_, _, report| Value::Quantity(report.both.joint_travel, Dimension::ANGLE)),
        ("way", |_, _, report| Value::text(way_name(&report.way))),
        ("why", |_, _, report| Value::text(why(&report.way))),
        ("tried", |_, _, report| Value::count(report.both.tried as usize)),
        ("work", |_, _, report| Value::count(report.both.work as usize)),
    ];
}

fn way_name(way: &Way) -> &'static str {
    match way {
        Way::Snake { .. } => "snake",
        Way::Direct { .. } | Way::Standing { .. } => "direct",
        Way::Turning => "turning",
    }
}

/// Returns how many connections stay, in words.
fn stay(kept: usize) -> String {
    if kept == 1 { "1 connection stays".into() } else { format!("{kept} connections stay") }
}

/// Returns the reason for a way, in words.
fn why(way: &Way) -> String {
    let seconds = |duration: f64| quantity(duration, Dimension::TIME);
    match way {
        Way::Snake { direct: None } => "through the snake: no direct way is known".into(),
        Way::Snake { direct: Some(direct) } => {
            format!("through the snake: the direct way takes {}", seconds(*direct))
        }
        Way::Standing { kept } => {
            format!("direct: {}, and the robot stands on the floor all the time", stay(*kept))
        }
        Way::Direct { kept, snake } => {
            let stay = stay(*kept);
            match snake {
                Some(snake) => {
                    format!("direct: {stay}, and the way through the snake takes {}", seconds(*snake))
                }
                None => format!("direct: {stay}, and no way through the snake was found"),
            }
        }
        Way::Turning => "the connections are the same: joints turn alone".into(),
    }
}

arguments! {
    /// The arguments of `reconfigure`.
    struct ReconfigureArguments<'c> {
        from: &'c Rc<Instance>,
        to: &'c Rc<Instance>,
        ground: Support,
        ..search: SearchArguments,
    }
}

/// The words of `ground`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Support {
    /// The base is held fast.
    Held,
    /// The robot rests on a floor.
    Settle,
}

impl Choice for Support {
    const WORDS: &'static [(&'static str, Support)] = &[("held", Support::Held), ("settle", Support::Settle)];
}

/// Returns the options with what supports the robot under gravity.
///
/// # Errors
/// A fault where the robot is to rest without gravity.
fn standing_on(call: &Call, ground: Support, mut options: Options) -> Eval<Options> {
    if ground == Support::Settle {
        if options.world.gravity == 0.0 {
            return Err(call.refuse("ground", "nothing rests on it without gravity: say `gravity: on`"));
        }
        options.world.ground = Ground::Settle;
    }
    Ok(options)
}

/// Returns an end of the way.
fn configuration(subject: &Subject) -> reconfigure::Configuration<'_> {
    reconfigure::Configuration { robot: &subject.robot.assembly, state: &subject.robot.start }
}

/// Runs `reconfigure`.
fn native_reconfigure(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let ReconfigureArguments { from, to, ground, search } = ReconfigureArguments::read(call)?;
    let options = standing_on(call, ground, Options::of(interpreter, call, &search)?)?;
    let counts = [from, to].map(|instance| instance.design.module_count());
    if counts[0] != counts[1] {
        return Err(module_counts_differ(call, counts[0], counts[1]));
    }
    let Some(from) = Subject::of(interpreter, call, "from", from)? else { return Ok(Value::Unknown) };
    let Some(to) = Subject::of(interpreter, call, "to", to)? else { return Ok(Value::Unknown) };
    let causes = interpreter.planner_causes(call.span);
    let judge = interpreter.judge_settings();
    let search = options.settings(interpreter);
    let settings = reconfigure::Settings { search, judge, ..reconfigure::Settings::default() };
    let mut observer = Observer::new(interpreter, &options);
    let problem =
        reconfigure::Problem { from: configuration(&from), to: configuration(&to), world: options.world };
    let solution = reconfigure::plan_with_cache(
        &problem,
        &settings,
        &mut interpreter.memory.search_cache,
        &mut observer,
    );
    let solution = match solution {
        Err(
            reconfigure::Refusal::From(Refusal::NotRofi(_)) | reconfigure::Refusal::To(Refusal::NotRofi(_)),
        ) if options.is_for_any_module() => {
            let ends = [&from, &to].map(|subject| subject.unwinding());
            let found = unwind::between((&ends[0], &ends[1]), &options.unwinding(), judge, &mut observer);
            found.map_err(|refusal| match refusal {
                unwind::BetweenRefusal::From(refusal) => {
                    no_snake(interpreter, call, from.place(call), &causes, &refusal)
                }
                unwind::BetweenRefusal::To(refusal) => {
                    no_snake(interpreter, call, to.place(call), &causes, &refusal)
                }
                unwind::BetweenRefusal::DifferentSnakes(_) => {
                    fault(code::NOT_COVERED, call.span, refusal.to_string(), "another `seed` may find one")
                }
            })?
        }
        Err(reconfigure::Refusal::NoStandingWay(_)) if interpreter.shared.host.cancelled() => {
            return Err(Stop::Halt);
        }
        other => other.map_err(|refusal| match refusal {
            reconfigure::Refusal::From(refusal) => refused(interpreter, call, &from, &causes, &refusal),
            reconfigure::Refusal::To(refusal) => refused(interpreter, call, &to, &causes, &refusal),
            reconfigure::Refusal::NoStandingWay(no) => no_standing_way(call, &from.robot, &no),
            other => no_reconfiguration(call, &other),
        })?,
    };
    let Solution { body, program, report } = solution;
    let mut plan = options.plan(interpreter, "reconfigure", (body, program), &from.robot, &causes);
    plan.provenance.history = report.history.clone();
    plan.provenance.shapes = Some((from.design.name.to_string(), to.design.name.to_string()));
    // Either half has a cause of its own; both are this call.
    plan.causes.extend_from_within(..);
    let ids = causes.ids.repeat(2);
    let planned = PlanValue::new(from.design, Some(from.robot), plan, ids, report.both.actions);
    if let Some(verdict) = &report.verdict {
        planned.remember_verdict(verdict.clone());
    }
    judged(interpreter, call, planned.with_report(report), &options)
}

fn module_counts_differ(call: &Call, from: usize, to: usize) -> Stop {
    let message = reconfigure::Refusal::ModuleCount { from, to }.to_string();
    Diagnostic::error(code::NO_WAY, message)
        .label(call.at("to"), format!("{to} modules"))
        .label(call.at("from"), format!("{from} modules"))
        .hint("modules are neither added nor taken away")
        .into()
}

/// Returns the fault of a reconfiguration both halves of which can be planned.
fn no_reconfiguration(call: &Call, refusal: &reconfigure::Refusal) -> Stop {
    let message = refusal.to_string();
    match refusal {
        reconfigure::Refusal::DifferentSnakes(_) => {
            fault(code::NOT_COVERED, call.span, message, "some modules lie in it the other way round")
        }
        reconfigure::Refusal::NotHeldAlike { .. } => Diagnostic::error(code::NO_WAY, message)
            .label(call.at("to"), "one module is held all the time")
            .hint("another `seed`, or another `base` of the first robot, may do")
            .into(),
        reconfigure::Refusal::ModuleCount { from, to } => module_counts_differ(call, *from, *to),
        reconfigure::Refusal::From(_)
        | reconfigure::Refusal::To(_)
        | reconfigure::Refusal::NoStandingWay(_) => unreachable!("these are told of the robots"),
    }
}

/// Returns the fault of a reconfiguration on the floor for which no way was found.
fn no_standing_way(call: &Call, robot: &Robot, no: &NoStandingWay) -> Stop {
    let NoStandingWay { hindrances, status, rejected, stopped } = no;
    let what = if *stopped { "no way on the floor within the timeout" } else { "no way on the floor" };
    let mut why = vec![format!("{} pairs of docks were tried", status.tried)];
    if *rejected > 0 {
        why.push(format!("{rejected} ways were found that do not pass the judge"));
    }
    if hindrances.falls > 0 {
        why.push(format!("it would have fallen over on {} motions", hindrances.falls));
    }
    if let Some(JointLoad { module, joint, ratio }) = hindrances.least_overload {
        let name = format!("{}.{}", robot.assembly.modules[module].name, JOINTS[joint]);
        let count = hindrances.overloads;
        why.push(format!(
            "{count} motions would have overloaded joints, at the least {name}, {ratio:.2} times"
        ));
    }
    Diagnostic::error(code::NO_WAY, format!("{what}: {}", why.join("; ")))
        .label(call.at("from"), "it rests on the floor, and is to stand all the time")
        .hint("another `seed` may find one, and so may `ground: held`")
        .into()
}
