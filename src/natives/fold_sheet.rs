//! `fold_sheet` and `load_creases`: sheets that fold along all creases at once.

use super::fold_supply::{self, Passive, Sheet, Supply};
use super::{Native, fold_surface, mesh_file};
use crate::formats::{CREASE_FORMATS, CreaseSheet, FormatFault};
use crate::geometry::{Pose, Vec3};
use crate::interpret::argument::{Auto, Choice, Positive, WordOr, arguments, parameters};
use crate::interpret::design::{BondRecord, ConfigDesign, Design, DesignKind, FlatModule};
use crate::interpret::interpreter::Interpreter;
use crate::interpret::native::Call;
use crate::interpret::plan_value::{PlanValue, ReportField, ReportFields};
use crate::interpret::record::Record;
use crate::interpret::robot::Robot;
use crate::interpret::stop::{Eval, Stop, fault};
use crate::interpret::value::{Mesh, Value};
use crate::plan::{CauseId, CheckKind, Plan};
use crate::planners::fold::{Panels, Target, Unfoldable};
use crate::planners::fold_sheet::{self, Problem, Refusal, Report, Settings, SheetWorld, Unassigned};
use crate::planners::{RequestedProgress, Solution};
use crate::robot::State;
use crate::source::{Diagnostic, Span, code};
use crate::units::{Dimension, quantity};
use std::cell::Cell;
use std::f64::consts::PI;
use std::rc::Rc;

// The arguments that diagnostics of `fold_sheet` are about.
const TARGET: &str = "target";
const MODULE: &str = "module";
const ROOT: &str = "root";
const TIME: &str = "time";

/// The argument of `load_creases` that names the file.
const FILE: &str = "file";

/// The argument of `load_creases` that says how far its creases fold.
const FOLD: &str = "fold";

arguments! {
    /// The arguments of `fold_sheet`.
    struct Arguments<'c> {
        target: &'c Value,
        module: &'c Value,
        root: usize as "a face",
        time: WordOr<Auto, Positive> as "the time of the motion",
        ground: SheetWorld,
    }
}

impl Choice for SheetWorld {
    const WORDS: &'static [(&'static str, SheetWorld)] =
        &[("off", SheetWorld::Free), ("settle", SheetWorld::Settling), ("held", SheetWorld::Held)];
}

/// The built-ins of sheets: the key of each with its parameters and its Rust function.
pub(super) const TABLE: &[Native] = &[
    Native::on_run("fold_sheet", Arguments::PARAMETERS, run),
    Native::pure(
        "load_creases",
        parameters![file: &str, scale: Positive, fold: WordOr<Auto, Positive>],
        load_creases,
    ),
];

impl ReportFields for Report {
    const FIELDS: &'static [ReportField<Report>] = &[
        ("panels", |_, _, report| Value::count(report.target.faces.len())),
        ("creases", |_, _, report| Value::count(report.creases)),
        ("loops", |_, _, report| Value::count(report.loops)),
        ("freedom", |_, _, report| Value::count(report.freedom)),
        ("opening", |_, _, report| Value::Quantity(report.gap, Dimension::ANGLE)),
        ("why", |_, _, report| Value::text(why(report))),
        ("angles", |_, _, report| {
            Value::list(report.angles.iter().map(|angle| Value::Quantity(*angle, Dimension::ANGLE)).collect())
        }),
        ("energy", |_, _, report| {
            let energy = report.effort.map(|effort| Value::Quantity(effort.energy, Dimension::ENERGY));
            Value::optional(energy)
        }),
        ("peak_torque", |_, _, report| {
            Value::optional(report.effort.map(|effort| Value::Quantity(effort.peak, Dimension::TORQUE)))
        }),
        ("robot", |_, plan, _| Value::Instance(plan.instance())),
    ];
}

/// Returns what the loops of a sheet leave free, and how closely they stay closed, in words.
fn why(report: &Report) -> String {
    let &Report { creases, loops, freedom, gap, .. } = report;
    let open = quantity(gap, Dimension::ANGLE);
    let count = |number: usize, one: &str, many: &str| match number {
        1 => format!("1 {one}"),
        number => format!("{number} {many}"),
    };
    let [creases, angles] = [count(creases, "crease", "creases"), count(freedom, "angle", "angles")];
    match loops {
        0 => "no loop ties its creases together: all fold at once".into(),
        loops => format!(
            "{} {angles} of {creases} free: all fold on a way on which no loop opens by more than {open}",
            count(loops, "loop leaves", "loops leave"),
        ),
    }
}

/// Runs `fold_sheet`: reads the folded form and its panels, plans, and returns the plan with the planner's report and
/// verdict.
fn run(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let arguments = Arguments::read(call)?;
    let mut supply = Supply::of(interpreter, call, MODULE, arguments.module)?;
    let target = fold_surface::target(call, TARGET, arguments.target)?;
    let passive = Passive { faces: &[], module: None };
    let (sheet, target) = fold_supply::panels(interpreter, &mut supply, &passive, target)?;
    let time = match arguments.time {
        WordOr::Word(Auto) => None,
        WordOr::Value(Positive(time)) => Some(time),
    };
    let problem = Problem { target, panels: sheet.panels.clone(), root: arguments.root };
    let world = arguments.ground;
    let settings = Settings { time, world, judge: interpreter.judge_settings() };
    let causes = interpreter.planner_causes(call.span);
    let Solution { body, program, report } = fold_sheet::plan(&problem, &settings, &mut RequestedProgress)
        .map_err(|refusal| diagnostic(interpreter, call, &causes.ids, &refusal))?;
    let (design, robot) = joined(&problem, &sheet, &report.angles, call.span);
    let bare =
        interpreter.bare_plan("fold_sheet", body, problem.panels.library.clone(), world.world(), &causes);
    let plan = Plan { program, ..bare };
    let planned = PlanValue::new(design, Some(robot), plan, causes.ids.clone(), report.actions);
    planned.remember_verdict(report.verdict.clone());
    let planned = planned.with_report(report);
    Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))))
}

/// Returns (configuration, robot) of the panels joined at all creases; the start state of the robot has these angles.
fn joined(problem: &Problem, sheet: &Sheet, angles: &[f64], span: Span) -> (Rc<Design>, Rc<Robot>) {
    let Problem { target, panels, root } = problem;
    let (assembly, joints) = fold_sheet::assembly(target, panels, *root).expect("the planner joined it");
    let mut positions = vec![0.0; assembly.joints().count()];
    joints.iter().zip(angles).for_each(|(joint, angle)| positions[joint.0 as usize] = *angle);
    let start = State {
        joints: positions,
        bonds: vec![true; assembly.bonds.len()],
        base: Pose::identity(),
        clusters: vec![],
        misalignments: vec![],
    };
    let robot = Rc::new(Robot::alone(assembly, start));
    let design = configuration(target, panels, *root, &sheet.designs, span);
    let config = design.config().expect("made as a configuration");
    assert!(config.robot.set(Some(robot.clone())).is_ok(), "it was just made");
    (design, robot)
}

/// Returns the configuration of the panels, with a bond for each crease, which close loops.
fn configuration(
    target: &Target,
    panels: &Panels,
    root: usize,
    designs: &[Rc<Design>],
    span: Span,
) -> Rc<Design> {
    let name = |face: usize| -> Rc<str> { format!("panel[{face}]").into() };
    let modules = designs.iter().enumerate();
    let modules = modules.map(|(face, panel)| FlatModule { name: name(face), design: panel.clone() });
    let config = ConfigDesign { closed: true, ..ConfigDesign::of_modules(modules.collect()) };
    for hinge in &target.hinges {
        let [a, b] = [0, 1].map(|end| (hinge.faces[end], hinge.sides[end]));
        config.add_bond(BondRecord { a, b, turn: 0, span, ends: (span, span), instance: "".into() });
    }
    config.base.set(Some(root));
    config.complete.set(true);
    Rc::new(Design {
        // The declaration is that of its panels: it has none of its own.
        def: designs[root].def,
        name: format!("{}[{}]", designs[root].name, panels.kinds.len()),
        args: Vec::new(),
        kind: DesignKind::Config(config),
        broken: Cell::new(false),
    })
}

/// Returns the fault of a refusal; `causes`: the run's number of each cause of the plan.
fn diagnostic(interpreter: &Interpreter, call: &Call, causes: &[CauseId], refusal: &Refusal) -> Stop {
    let message = refusal.to_string();
    let error = |code| Diagnostic::error(code, message.clone());
    match refusal {
        Refusal::NoSheet(_) => error(code::UNFOLDABLE)
            .label(call.at(TARGET), "no sheet")
            .hint("`fold` cuts a surface along edges so that it lies flat")
            .into(),
        Refusal::Overlap { .. } => {
            error(code::UNFOLDABLE).label(call.at(TARGET), "does not lie flat in one piece").into()
        }
        Refusal::TooManyCreases { .. } => {
            fault(code::NOT_COVERED, call.at(TARGET), message, "too many creases")
        }
        Refusal::Stuck(_) => error(code::NOT_COVERED)
            .label(call.at(TARGET), "no way leads here from flat")
            .hint("smaller angles of the same mountains and valleys may be reached")
            .into(),
        Refusal::NoSuchRoot { .. } => call.refuse(ROOT, message),
        Refusal::NoHinge => call.refuse(MODULE, message),
        Refusal::TooShort { least } => Diagnostic::error(code::BAD_VALUE, message)
            .label(call.at(TIME), "too short for the widest angle")
            .hint(format!(
                "{} is long enough; without `time` it is as short as it can be",
                quantity(*least, Dimension::TIME)
            ))
            .into(),
        Refusal::Schedule(refusal) => interpreter.refused(refusal, causes, call.span),
        Refusal::Refused(failure) if failure.kind == CheckKind::Torque => error(code::NO_WAY)
            .label(call.at(MODULE), "the hinges of these panels don't hold the weight")
            .hint("lighter or smaller panels, another `root` that is held, or the ground carry it")
            .into(),
        Refusal::Refused(_) => error(code::NO_WAY)
            .label(call.at(TARGET), "can't be folded together")
            .label(call.at(MODULE), "of these panels")
            .hint("smaller angles or thinner panels leave room")
            .into(),
    }
}

/// Returns the fault of a file that can't be read as a crease pattern in a format of this name.
fn unread(call: &Call, path: &str, format: &str, why: &FormatFault) -> Stop {
    let message = format!("`{path}` can't be read as a crease pattern in {format}: {why}");
    let fault = Diagnostic::error(code::CANNOT_READ, message).label(call.at(FILE), why.to_string());
    match why.remedy() {
        Some(remedy) => fault.hint(remedy.to_owned()).into(),
        None => fault.into(),
    }
}

/// Runs `load_creases`: reads a crease pattern and returns its folded form.
fn load_creases(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let scale = call.positive("scale", "the scale of a crease pattern")?;
    let format = mesh_file::by_name(call, FILE, "crease pattern", CREASE_FORMATS, |format| format.ending)?;
    let (path, bytes) = interpreter.project_file(call, FILE)?;
    let sheet = (format.read)(&bytes).map_err(|why| unread(call, &path, format.name, &why))?;
    let fold: WordOr<Auto, Positive> = call.get(FOLD)?;
    if let (WordOr::Word(Auto), Some(edge)) = (fold, sheet.unstated) {
        let why = format!("edge {edge} has no fold angle");
        let message = format!("`{path}` does not say how far it folds: {why}");
        return Err(Diagnostic::error(code::CANNOT_READ, message)
            .label(call.at(FILE), why)
            .hint("`edges_foldAngle` states it; with `fold: 60deg` its mountains and valleys fold by 60 degrees at the widest")
            .into());
    }
    if let WordOr::Value(Positive(widest)) = fold
        && widest >= PI
    {
        return Err(call.refuse(FOLD, "a crease folds by less than 180 degrees"));
    }
    interpreter.check_list(sheet.faces.len().max(sheet.vertices.len()), call.at(FILE))?;
    let flat = sheet.vertices.iter().map(|[x, y]| Vec3::new(x * scale, y * scale, 0.0)).collect();
    let flat = Target::new(flat, &sheet.faces).map_err(|why| {
        let at = if let Unfoldable::NotConvex { face, corner } = why { Some((face, corner)) } else { None };
        let at = at.map(|(face, corner)| sheet.faces[face][corner]);
        unfolding(call, &path, &sheet, (why.to_string(), at), why.remedy())
    })?;
    let ends = |hinge: &crate::planners::fold::Hinge| {
        let corners = &flat.faces[hinge.faces[0]];
        let (a, b) = (corners[hinge.sides[0]], corners[(hinge.sides[0] + 1) % corners.len()]);
        [a.min(b), a.max(b)]
    };
    let angles: Vec<f64> = flat.hinges.iter().map(|hinge| sheet.angles[&ends(hinge)]).collect();
    let angles = match fold {
        WordOr::Word(Auto) => angles,
        WordOr::Value(Positive(widest)) => fold_sheet::assigned(&flat, &angles, widest).map_err(|why| {
            let at = match why {
                Unassigned::Contradicts { crease } => Some(ends(&flat.hinges[crease])),
                _ => None,
            };
            let remedy = "every vertex inside has to fold rigidly with its mountains and valleys; a smaller `fold` may do";
            let at = at.map_or_else(String::new, |[a, b]| {
                format!(": the crease from {} to {}", sheet.place(a), sheet.place(b))
            });
            unfolding(call, &path, &sheet, (format!("{why}{at}"), None), remedy)
        })?,
    };
    let vertices = fold_sheet::folded(&flat, &angles).map_err(|why| {
        let remedy = "mountains and valleys fold by their angles from flat, seen from the front, which have to go together \
                      round every vertex; `fold: 60deg` seeks such angles, of which the widest is 60 degrees";
        unfolding(call, &path, &sheet, (why.to_string(), why.vertex()), remedy)
    })?;
    Ok(Value::Mesh(Rc::new(Mesh { vertices, faces: sheet.faces })))
}

/// Returns the fault of a crease pattern that does not fold for a reason, at a vertex if it is at one.
fn unfolding(
    call: &Call,
    path: &str,
    sheet: &CreaseSheet,
    (why, vertex): (String, Option<usize>),
    remedy: &str,
) -> Stop {
    let at = vertex.map_or_else(String::new, |vertex| format!(", at {} in the file", sheet.place(vertex)));
    Diagnostic::error(code::UNFOLDABLE, format!("`{path}` does not fold as it says: {why}{at}"))
        .label(call.at(FILE), "does not fold")
        .hint(remedy.to_owned())
        .into()
}
