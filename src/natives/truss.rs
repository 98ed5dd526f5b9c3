//! `morph` and `locomote`: the planners of trusses, as they are called, and what they give back.

use super::Native;
use super::shape::obstacles;
use super::truss_limits::{LimitArguments, limits};
use crate::geometry::{HeightField, Vec3};
use crate::interpret::argument::{Auto, Choice, Positive, WordOr, arguments};
use crate::interpret::design::{Design, DesignKind, Instance, TrussDesign};
use crate::interpret::evaluator_thread::HostProxy;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, PlannerReport, ReportField, ReportFields};
use crate::interpret::record::Record;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::{Mesh, Value};
use crate::interrupt;
use crate::plan::{CauseId, DynamicsModel, Exemption, ExemptionKind, World};
use crate::planners::locomote::{self, Hold, Objective};
use crate::planners::morph::{self, TargetShape};
use crate::planners::truss::constraint::Constraint;
use crate::planners::truss::problem::{InvalidTruss, TrussProblem};
use crate::planners::{Progress, Solution};
use crate::robot::Library;
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::rc::Rc;
use std::sync::Arc;

/// The most characters of a target's words in the title of a plan.
const TARGET_WORDS_MAX: usize = 40;

/// The distance that nodes may slide over the ground, summed over all, m, where all that are on it are held.
const SLIP_MAX: f64 = 1.0;

/// The hint for plans that end where forces are at their greatest.
const FORCES_HINT: &str = "stronger or lighter struts, or another `objective`; with `forces: false` the verdict tells what \
                           the path needs";

/// The built-ins `morph` and `locomote`: the key of each with its parameters and its Rust function.
pub const TABLE: &[Native] = &[
    Native::on_run("morph", MorphArguments::PARAMETERS, morph),
    Native::on_run("locomote", LocomoteArguments::PARAMETERS, locomote),
];

arguments! {
    /// The arguments of `morph`.
    struct MorphArguments<'c> {
        truss: &'c Rc<Instance>,
        target: &'c Value,
        tolerance: Positive as "the tolerance",
        budget: usize as "a number of steps",
        orientations: usize as "a number of orientations",
        seed: WordOr<Auto, usize> as "a seed",
        timeout: Option<Positive> as "a timeout",
        ..limits: LimitArguments<'c>,
    }
}

arguments! {
    /// The arguments of `locomote`.
    struct LocomoteArguments<'c> {
        truss: &'c Rc<Instance>,
        path: &'c [Value],
        objective: WordOr<Auto, Objective>,
        hold: WordOr<Auto, Hold>,
        slip: WordOr<Auto, Positive> as "the greatest slip",
        forces: bool,
        friction: Positive as "the friction",
        fallbacks: bool,
        budget: usize as "a budget",
        timeout: Option<Positive> as "a timeout",
        impact: bool,
        terrain: Option<&'c HeightField>,
        lookahead: usize as "a number of steps",
        ..limits: LimitArguments<'c>,
    }
}

impl Choice for Objective {
    const WORDS: &'static [(&'static str, Objective)] = &[
        ("springs", Objective::Springs),
        ("lengths", Objective::LENGTHS),
        ("restoring", Objective::RESTORING),
        ("fewest", Objective::FEWEST),
    ];
}

impl Choice for Hold {
    const WORDS: &'static [(&'static str, Hold)] = &[("three", Hold::Three), ("all", Hold::All)];
}

impl ReportFields for morph::Report {
    const FIELDS: &'static [ReportField<morph::Report>] = &[
        ("rms", |_, _, report| Value::length(report.distance.target_to_surface)),
        ("rms_back", |_, _, report| Value::length(report.distance.surface_to_target)),
        ("worst", |_, _, report| Value::length(report.distance.worst)),
        ("start_rms", |_, _, report| Value::length(report.start.target_to_surface)),
        ("clearance", |interpreter, plan, _| {
            let settings = interpreter.judge_settings();
            let Ok(verdict) = interpreter.judge(plan, settings, None) else { return Value::Unknown };
            Value::length(verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value))
        }),
        ("ended", |_, _, report| Value::text(report.ended.clone())),
    ];
}

impl ReportFields for locomote::Report {
    const FIELDS: &'static [ReportField<locomote::Report>] = &[
        ("distance", |_, _, report| Value::length(report.distance)),
        ("rolls", |_, _, report| Value::count(report.rolls)),
        ("footholds", |_, _, report| Value::count(report.footholds)),
        ("reached", |_, _, report| Value::count(report.reached)),
        ("slip", |_, _, report| Value::length(report.slip)),
        ("relaxed_steps", |_, _, report| Value::count(report.relaxed_steps)),
        ("ended", |_, _, report| Value::text(report.ended.clone())),
    ];
}

/// Returns the records of trusses, each as (name, names of its fields in order).
pub fn records() -> Vec<(&'static str, Vec<&'static str>)> {
    vec![("Morphing", morph::Report::names()), ("Travel", locomote::Report::names())]
}

/// Runs `morph`; warns of a plan that ends short of the target.
fn morph(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let arguments = MorphArguments::read(call)?;
    let design = arguments.truss.design.clone();
    let Some(truss) = problem(call, &design, &arguments.limits, (None, 1.0))? else {
        return Ok(Value::Unknown);
    };
    let problem = morph::Problem { truss, target: target(call, arguments.target)? };
    let settings = morph::Settings {
        tolerance: arguments.tolerance.0,
        steps_max: arguments.budget,
        orientations: arguments.orientations,
        seed: interpreter.seed(arguments.seed),
        ..morph::Settings::default()
    };
    let timeout = arguments.timeout.map(|seconds| seconds.0);
    interrupt::start_task(format!("morphing {}", design.name));
    let host = interpreter.shared.host.clone();
    let found = morph::plan(&problem, &settings, &mut Timed(host.until(timeout)));
    let solution = found.map_err(|refusal| morph_refused(call, &problem.truss, refusal))?;
    let report = &solution.report;
    let [there, back, wanted] =
        [report.distance.target_to_surface, report.distance.surface_to_target, settings.tolerance]
            .map(|x| quantity(x, Dimension::LENGTH));
    match report.end {
        morph::End::Done => {}
        morph::End::Cancelled => {
            let so_far = format!("the truss was within {there} of the target ({back} back)");
            return Err(timed_out(&host, call, &so_far));
        }
        morph::End::Steps | morph::End::Stuck(_) => {
            let message =
                format!("the truss comes within {there} of the target ({back} back), not within {wanted}");
            interpreter.add_report(
                Diagnostic::warning(code::SHORT_OF_GOAL, message)
                    .label(call.span, report.ended.clone())
                    .hint("a greater `budget`, more `orientations`, or a greater `tolerance`"),
            );
        }
    }
    // The target is a surface without a name: the words of the call are one.
    let words = interpreter.shared.sources.text(call.at("target")).split_whitespace();
    let goal: String = words.collect::<Vec<_>>().join(" ").chars().take(TARGET_WORDS_MAX).collect();
    let shapes = Some((design.name.to_string(), goal));
    let made = Made { solution, seed: Some(settings.seed), excused: None };
    Ok(planned(interpreter, call, (design, shapes), ("morph", World::FREE), made))
}

/// Runs `locomote`; warns of a plan that does not reach the end of the path.
fn locomote(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let arguments = LocomoteArguments::read(call)?;
    let friction = arguments.friction.0;
    let design = arguments.truss.design.clone();
    let Some(truss) = problem(call, &design, &arguments.limits, (arguments.terrain, friction))? else {
        return Ok(Value::Unknown);
    };
    // Heights of the path mean nothing.
    let place = |value: &Value| match value {
        Value::Vec3(p, _) => Ok([p.x, p.y]),
        _ => Err(call.refuse("path", "points are wanted")),
    };
    let path = arguments.path.iter().map(place).collect::<Eval<Vec<[f64; 2]>>>()?;
    let problem = locomote::Problem { truss, path };
    let objective = match arguments.objective {
        WordOr::Value(objective) => objective,
        WordOr::Word(Auto) => Objective::usual(problem.truss.nodes.len()),
    };
    // Without impact feet have to slide, or the truss could not leave those behind it.
    let hold = match arguments.hold {
        WordOr::Value(hold) => hold,
        WordOr::Word(Auto) if arguments.impact => Hold::All,
        WordOr::Word(Auto) => Hold::Three,
    };
    let slip_max = match (arguments.slip, hold) {
        (WordOr::Value(slip), _) => slip.0,
        (WordOr::Word(Auto), Hold::All) => SLIP_MAX,
        (WordOr::Word(Auto), Hold::Three) => f64::INFINITY,
    };
    let settings = locomote::Settings {
        objective,
        hold,
        slip_max,
        forces: arguments.forces,
        impact: arguments.impact,
        lookahead: arguments.lookahead,
        fallbacks: arguments.fallbacks,
        steps_max: arguments.budget,
        ..locomote::Settings::default()
    };
    let timeout = arguments.timeout.map(|seconds| seconds.0);
    interrupt::start_task(format!("moving {}", design.name));
    let host = interpreter.shared.host.clone();
    let found = locomote::plan(&problem, &settings, &mut Timed(host.until(timeout)));
    let solution = found.map_err(|refusal| locomote_refused(call, refusal))?;
    let (report, places) = (&solution.report, problem.path.len());
    match report.end {
        locomote::End::Arrived => {}
        locomote::End::Cancelled => {
            let so_far = format!("the truss reached {} of {places} places", report.reached);
            return Err(timed_out(&host, call, &so_far));
        }
        _ => {
            let message = format!("the truss reaches {} of {places} places of its path", report.reached);
            let hint = match &report.end {
                locomote::End::Stuck(error) if error.constraints().contains(&Constraint::Force) => {
                    FORCES_HINT
                }
                locomote::End::Blocked(Constraint::Force) => FORCES_HINT,
                _ => "another `objective` or another path may lead there",
            };
            let warning = Diagnostic::warning(code::SHORT_OF_GOAL, message);
            interpreter.add_report(warning.label(call.span, report.ended.clone()).hint(hint));
        }
    }
    let world = World { dynamics: DynamicsModel::Statics, friction, ..World::default() };
    let excused = (!settings.forces).then_some(ExemptionKind::Overload(None));
    let made = Made { solution, seed: None, excused };
    Ok(planned(interpreter, call, (design, None), ("locomote", world), made))
}

/// Returns the truss with its limits, among obstacles and on terrain with a factor on its friction; `None` where the design is not a truss, or its
/// strut is broken.
///
/// # Errors
/// A fault where a strut in an argument is unknown.
fn problem(
    call: &Call,
    design: &Design,
    limited: &LimitArguments,
    (terrain, friction): (Option<&HeightField>, f64),
) -> Eval<Option<TrussProblem>> {
    let obstacles = obstacles(call, limited.obstacles)?;
    let Some(truss) = truss_of(design) else { return Ok(None) };
    let Some(strut) = truss.strut_kind().cloned() else { return Ok(None) };
    Ok(Some(TrussProblem {
        strut,
        node_names: truss.nodes.iter().map(|node| node.name.clone()).collect(),
        nodes: truss.nodes.iter().map(|node| node.position).collect(),
        struts: truss.struts.clone(),
        limits: limits(call, truss, limited)?,
        obstacles,
        terrain: terrain.cloned(),
        friction,
    }))
}

/// Returns the truss that a design is; `None` for another.
pub(super) fn truss_of(design: &Design) -> Option<&TrussDesign> {
    match &design.kind {
        DesignKind::Truss(truss) => Some(truss),
        _ => None,
    }
}

fn target(call: &Call, target: &Value) -> Eval<TargetShape> {
    match target {
        Value::Mesh(mesh) => Ok(TargetShape::Mesh(triangles(mesh))),
        Value::Cloud(points) => Ok(TargetShape::Cloud(points.to_vec())),
        _ => Err(call.refuse("target", "a mesh or a cloud of points is wanted")),
    }
}

/// Returns the triangles of a mesh, by their corners (m); faces of more corners are triangulated.
fn triangles(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    let fan = |face: &Vec<usize>| {
        let corner = |i: usize| mesh.vertices[face[i]];
        crate::geometry::triangulate(&face.iter().map(|&i| mesh.vertices[i]).collect::<Vec<_>>())
            .into_iter()
            .map(|t| t.map(corner))
            .collect::<Vec<_>>()
    };
    mesh.faces.iter().flat_map(fan).collect()
}

/// Answers requests for progress, and ends a search at its timeout or when it is cancelled.
struct Timed<F>(F);

impl<F: Fn() -> bool> Progress for Timed<F> {
    fn report(&mut self, how_far: &dyn Fn() -> String) {
        interrupt::progress_checkpoint(how_far);
    }

    fn should_continue(&mut self) -> bool {
        (self.0)()
    }
}

/// Returns the fault of a planner that was stopped by its timeout; `Stop::Halt` if the user cancelled.
fn timed_out(host: &HostProxy, call: &Call, so_far: &str) -> Stop {
    if host.cancelled() {
        return Stop::Halt;
    }
    Diagnostic::error(code::NO_WAY, format!("no plan within the timeout: {so_far}"))
        .label(call.span, "it was still going on")
        .hint("a greater `timeout`, or a smaller `budget`, which ends with a plan")
        .into()
}

/// Returns the fault of a refusal of `morph`, at the argument that it is about.
fn morph_refused(call: &Call, truss: &TrussProblem, refusal: morph::Refusal) -> Stop {
    match &refusal {
        morph::Refusal::Truss(invalid) => invalid_truss(call, invalid),
        morph::Refusal::TooFar | morph::Refusal::NoArea | morph::Refusal::FewPoints { .. } => {
            call.refuse("target", refusal.to_string())
        }
        morph::Refusal::NoSurface { edges } => {
            let name =
                |&(a, b): &(usize, usize)| format!("{} -- {}", truss.node_names[a], truss.node_names[b]);
            let label = match &edges[..] {
                [] => "no triangle of struts has all nodes on one side".to_string(),
                [first, rest @ ..] => {
                    let more =
                        if rest.is_empty() { String::new() } else { format!(", and {} more", rest.len()) };
                    format!("{} is not between two of them{more}", name(first))
                }
            };
            Diagnostic::error(code::NOT_COVERED, refusal.to_string()).label(call.at("truss"), label).into()
        }
    }
}

fn locomote_refused(call: &Call, refusal: locomote::Refusal) -> Stop {
    match &refusal {
        locomote::Refusal::Truss(invalid) => invalid_truss(call, invalid),
        locomote::Refusal::EmptyPath | locomote::Refusal::TooFar => call.refuse("path", refusal.to_string()),
        locomote::Refusal::NeverRests => call.refuse("truss", refusal.to_string()),
        locomote::Refusal::Overloaded { .. } => Diagnostic::error(code::OVERLOAD, refusal.to_string())
            .label(call.at("truss"), "too heavy for its struts")
            .hint("stronger or lighter struts; `forces: false` plans all the same, and the verdict says so")
            .into(),
        locomote::Refusal::NoHold { .. } => Diagnostic::error(code::FALL, refusal.to_string())
            .label(call.at("truss"), "it does not stand")
            .hint("struts in a further direction hold a node")
            .into(),
        locomote::Refusal::Slides { .. } => Diagnostic::error(code::FALL, refusal.to_string())
            .label(call.at("truss"), "it does not stand")
            .hint("a gentler slope, or a greater `friction`")
            .into(),
    }
}

/// Returns the fault of a truss that can't be planned for, at the argument that it is about.
fn invalid_truss(call: &Call, invalid: &InvalidTruss) -> Stop {
    let name = match invalid {
        InvalidTruss::Incomplete | InvalidTruss::Degenerate { .. } | InvalidTruss::TooFar { .. } => "truss",
        InvalidTruss::AngleLimit => "angle",
        InvalidTruss::RigidityLimit => "rigidity",
        InvalidTruss::ShortLoop => "perimeters",
        InvalidTruss::NotSolid { .. }
        | InvalidTruss::InsideObstacle { .. }
        | InvalidTruss::NearObstacle { .. } => "obstacles",
        InvalidTruss::BelowGround { .. } => "terrain",
    };
    let limit = match invalid {
        InvalidTruss::NearObstacle { clearance, .. } => *clearance,
        InvalidTruss::BelowGround { depth_max, .. } => *depth_max,
        _ => return call.refuse(name, invalid.to_string()),
    };
    let limit = quantity(limit, Dimension::LENGTH);
    Diagnostic::error(code::BAD_VALUE, invalid.to_string())
        .label(call.at(name), format!("{limit} is the limit"))
        .hint("declare the truss elsewhere, or move what is in its way")
        .into()
}

/// The solution of a planner, with what the plan states beside it.
struct Made<R> {
    solution: Solution<R>,
    /// The seed of the search; none for a search without chance.
    seed: Option<u64>,
    /// The check that the call has the whole plan excused from.
    excused: Option<ExemptionKind>,
}

fn planned<R: PlannerReport>(
    interpreter: &mut Interpreter,
    call: &Call,
    (design, shapes): (Rc<Design>, Option<(String, String)>),
    (planner, world): (&str, World),
    made: Made<R>,
) -> Value {
    let causes = interpreter.planner_causes(call.span);
    let strut = truss_of(&design).and_then(TrussDesign::strut_kind).cloned();
    let library = Arc::new(Library { struts: strut.into_iter().collect(), ..Library::default() });
    let Solution { body, report, .. } = made.solution;
    let to = body.duration();
    let mut plan = interpreter.bare_plan(planner, body, library, world, &causes);
    let exemption = |kind| Exemption { kind, from: 0.0, to, cause: CauseId(0) };
    plan.exemptions.extend(made.excused.map(exemption));
    plan.provenance.seed = made.seed.or(plan.provenance.seed);
    plan.provenance.shapes = shapes;
    let planned = PlanValue::new(design, None, plan, causes.ids, 0).with_report(report);
    Value::Record(Rc::new(Record::Plan(Rc::new(planned))))
}
