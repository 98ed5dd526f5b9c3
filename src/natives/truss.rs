//! `morph` and `locomote`: the planners of trusses, as they are called, and what they give back.

use super::truss_around::Around;
use super::truss_limits;
use super::{Native, on_run};
use crate::elaborate::truss::TrussDesign;
use crate::geometry::Vec3;
use crate::interpret::call::Call;
use crate::interpret::design::DesignKind;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::stage::Stage;
use crate::interpret::stop::{Eval, Stop};
use crate::interpret::value::{Mesh, Value};
use crate::interrupt;
use crate::plan::{Body, CauseId, Interpolation, Keyframe, NodePaths, World};
use crate::planners::truss::bound::Bound;
use crate::planners::truss::fit::Distance;
use crate::planners::truss::goal::Goal;
use crate::planners::truss::locomote::{self, Hold, Move, Travel};
use crate::planners::truss::locomotion::Aim;
use crate::planners::truss::morph;
use crate::planners::truss::step::Stuck;
use crate::planners::truss::{Structure, margins, roll};
use crate::robot::{Library, Strut};
use crate::source::{Diagnostic, code};
use crate::units::{Dimension, quantity};
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[on_run("morph", 12, morph), on_run("locomote", 15, locomote)];

/// Points of a target lie about so far apart, in struts.
const APART: f64 = 0.125;
/// Points that a cloud has at least, so that it says something of a shape.
const POINTS_MIN: usize = 4;
/// The centre of mass goes so far in a step, in struts, and is at a place when it is so near.
const STRIDE: f64 = 0.05;
const NEAR: f64 = 0.25;
/// A robot that falls over an edge turns about so fast, rad/s. Nothing depends on it.
const FALL: f64 = 1.0;
/// No step is shorter, s.
const STEP_MIN: f64 = 1e-3;
/// Bounds that are named where they stopped a planner.
const BOUNDS_TOLD: usize = 4;

/// What the planner says of its plan.
pub enum Trussed {
    Morphed {
        distance: Distance,
        start: Distance,
        ended: String,
    },
    Travelled {
        rolls: usize,
        footholds: usize,
        eased: usize,
        distance: f64,
        slip: f64,
        reached: usize,
        ended: String,
    },
}

/// The fields of a `Morphing` and a `Travel` beside those of a plan.
pub const MORPHING: &[&str] = &["rms", "rms_back", "worst", "start_rms", "clearance", "ended"];
pub const TRAVEL: &[&str] = &["distance", "rolls", "footholds", "reached", "slip", "eased", "ended"];

impl Trussed {
    pub fn has(&self, field: &str) -> bool {
        match self {
            Trussed::Morphed { .. } => MORPHING.contains(&field),
            Trussed::Travelled { .. } => TRAVEL.contains(&field),
        }
    }
}

impl Interpreter<'_> {
    pub fn trussed_field(&mut self, planned: &Planned, trussed: &Trussed, field: &str) -> Value {
        match (trussed, field) {
            (Trussed::Morphed { distance, .. }, "rms") => Value::length(distance.there),
            (Trussed::Morphed { distance, .. }, "rms_back") => Value::length(distance.back),
            (Trussed::Morphed { distance, .. }, "worst") => Value::length(distance.worst),
            (Trussed::Morphed { start, .. }, "start_rms") => Value::length(start.there),
            (Trussed::Morphed { .. }, "clearance") => {
                let settings = self.judge_settings();
                let verdict = self.judge(planned, settings, None);
                Value::length(verdict.clearance.as_ref().map_or(f64::INFINITY, |worst| worst.value))
            }
            (Trussed::Travelled { distance, .. }, "distance") => Value::length(*distance),
            (Trussed::Travelled { rolls, .. }, "rolls") => Value::count(*rolls),
            (Trussed::Travelled { footholds, .. }, "footholds") => Value::count(*footholds),
            (Trussed::Travelled { reached, .. }, "reached") => Value::count(*reached),
            (Trussed::Travelled { slip, .. }, "slip") => Value::length(*slip),
            (Trussed::Travelled { eased, .. }, "eased") => Value::count(*eased),
            (Trussed::Morphed { ended, .. } | Trussed::Travelled { ended, .. }, "ended") => {
                Value::text(ended.clone())
            }
            _ => Value::Unknown,
        }
    }
}

fn morph(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let Some(task) = Task::of(call, 6, Around::of(call, 11, None)?)? else { return Ok(Value::Unknown) };
    task.around.free(call, task.truss(), &task.structure, &task.start)?;
    let goal = goal(call, &task)?;
    let timeout = call.positive_if(10, "a timeout")?;
    let wish = morph::Wish {
        tolerance: call.positive(2, "the tolerance")?,
        steps_max: call.count(3, "a number of steps")?,
        orientations: call.count(4, "a number of orientations")?,
        seed: call.count(5, "a seed")? as u64,
    };
    let name = task.design.name.clone();
    let stage = interpreter.stage.clone();
    let goes_on = stage.until(timeout);
    interrupt::start_task(format!("morphing {name}"));
    let least = Cell::new(f64::INFINITY);
    let going = |step: usize, distance: &Distance| {
        least.set(least.get().min(distance.there));
        interrupt::progress_checkpoint(|| {
            let [apart, least] = [distance.there, least.get()].map(|d| quantity(d, Dimension::LENGTH));
            format!("step {step} of at most {}, {apart} apart, {least} at best", wish.steps_max)
        });
        goes_on()
    };
    let found = morph::morph(&task.structure, &task.start, &goal, &wish, &going);
    let found = found.map_err(|open| task.no_surface(call, &open.edges))?;
    let ended = match &found.end {
        morph::End::Done => "done".to_string(),
        morph::End::Steps => format!("{} steps were not enough", wish.steps_max),
        morph::End::Stuck(stuck) => task.stuck(stuck),
        morph::End::Cancelled => {
            let [there, back] =
                [found.distance.there, found.distance.back].map(|x| quantity(x, Dimension::LENGTH));
            return Err(over(
                &stage,
                call,
                &format!("the truss was within {there} of the target ({back} back)"),
            ));
        }
    };
    if found.end != morph::End::Done {
        let [there, back, wanted] = [found.distance.there, found.distance.back, wish.tolerance]
            .map(|x| quantity(x, Dimension::LENGTH));
        let message =
            format!("the truss comes within {there} of the target ({back} back), not within {wanted}");
        interpreter.add_report(
            Diagnostic::warning(code::SHORT_OF_GOAL, message)
                .label(call.span, ended.clone())
                .hint("a greater `budget`, some `orientations`, or a greater `tolerance`"),
        );
    }
    let moves = found.steps.into_iter().map(Move::Step).collect();
    let trussed = Trussed::Morphed { distance: found.distance, start: found.start, ended };
    Ok(task.planned(interpreter, call, "morph", World::FREE, moves, trussed))
}

fn locomote(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let around = Around::of(call, 12, Some(13))?;
    let Some(mut task) = Task::of(call, 6, around)? else { return Ok(Value::Unknown) };
    // It rests on the ground, however it was declared.
    let Some(rested) = roll::rested(&task.structure, &task.start) else {
        return Err(call.refuse(0, "the truss does not come to rest on the ground"));
    };
    task.start = rested;
    task.around.free(call, task.truss(), &task.structure, &task.start)?;
    let path = path(call)?;
    let unit = task.structure.unit;
    let wish = locomote::Wish {
        path,
        near: NEAR * unit,
        stride: STRIDE * unit,
        aim: match call.word(2) {
            Some("lengths") => Aim::LENGTHS,
            Some("restoring") => Aim::RESTORING,
            Some("fewest") => Aim::FEWEST,
            _ => Aim::Springs,
        },
        hold: if call.word(3) == Some("all") { Hold::All } else { Hold::Three },
        impact: call.truth(11)?,
        ahead: call.count(14, "a number of steps")?,
        ladder: call.truth(4)?,
        steps_max: call.count(5, "a budget")?,
    };
    let name = task.design.name.clone();
    let places = wish.path.len();
    let stage = interpreter.stage.clone();
    let goes_on = stage.until(call.positive_if(10, "a timeout")?);
    interrupt::start_task(format!("moving {name}"));
    let told = Cell::new(0usize);
    let going = |reached: usize| {
        let step = told.get();
        told.set(step + 1);
        let most = wish.steps_max;
        interrupt::progress_checkpoint(|| {
            format!("step {step} of at most {most}, {reached} of {places} places reached")
        });
        goes_on()
    };
    let travel = locomote::locomote(&task.structure, &task.start, &wish, &going);
    let ended = match &travel.end {
        locomote::End::Arrived => "arrived".to_string(),
        locomote::End::Steps => format!("{} steps were not enough", wish.steps_max),
        locomote::End::Falls => "it does not come to rest on three nodes".to_string(),
        locomote::End::Stuck(stuck) => task.stuck(stuck),
        locomote::End::Blocked(bound) => format!("it would fall over an edge: {}", task.bound(*bound)),
        locomote::End::Cancelled => {
            let reached = travel.reached;
            return Err(over(&stage, call, &format!("the truss reached {reached} of {places} places")));
        }
    };
    if travel.end != locomote::End::Arrived {
        let message = format!("the truss reaches {} of {places} places of its path", travel.reached);
        interpreter.add_report(
            Diagnostic::warning(code::SHORT_OF_GOAL, message)
                .label(call.span, ended.clone())
                .hint("another `objective` or another path may lead there"),
        );
    }
    let distance = task.way_of_centre(&travel);
    let Travel { moves, rolls, footholds, eased, slip, reached, .. } = travel;
    let trussed = Trussed::Travelled { rolls, footholds, eased, distance, slip, reached, ended };
    Ok(task.planned(interpreter, call, "locomote", World::default(), moves, trussed))
}

/// Places for the centre of mass; their height means nothing.
fn path(call: &Call) -> Eval<Vec<[f64; 2]>> {
    let points = super::shape::points(call, 1)?;
    if points.is_empty() {
        return Err(call.refuse(1, "a path has at least one place"));
    }
    Ok(points.iter().map(|p| [p.x, p.y]).collect())
}

fn goal(call: &Call, task: &Task) -> Eval<Goal> {
    let apart = APART * task.structure.unit;
    match call.arg(1) {
        Value::Mesh(mesh) => {
            let triangles = triangles(mesh);
            let area: f64 = triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a)).norm()).sum();
            if area <= 0.0 {
                return Err(call.refuse(1, "a surface without area is no target"));
            }
            Ok(Goal::surface(triangles, apart))
        }
        Value::Cloud(points) if points.len() < POINTS_MIN => {
            Err(call
                .refuse(1, format!("a target has at least {POINTS_MIN} points; these are {}", points.len())))
        }
        Value::Cloud(points) => Ok(Goal::cloud(points.to_vec())),
        _ => Err(call.refuse(1, "a mesh or a cloud of points is wanted")),
    }
}

/// Faces of more than three corners as fans; corners that turn inwards give triangles that overlap.
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

/// What to say when a planner did not go on.
fn over(stage: &Stage, call: &Call, so_far: &str) -> Stop {
    if stage.cancelled() {
        return Stop::Halt;
    }
    Diagnostic::error(code::NO_WAY, format!("no plan within the timeout: {so_far}"))
        .label(call.span, "it was still going on")
        .hint("a greater `timeout`, or a smaller `budget`, which ends with a plan")
        .into()
}

/// A truss before a planner.
struct Task {
    design: Rc<crate::interpret::design::Design>,
    strut: Strut,
    start: Vec<Vec3>,
    structure: Structure,
    around: Around,
}

impl Task {
    /// `limits`: where the parameters of those are.
    fn of(call: &Call, limits: usize, around: Around) -> Eval<Option<Task>> {
        let design = call.instance(0)?.design.clone();
        let DesignKind::Truss(truss) = &design.kind else { return Ok(None) };
        let Some(strut) = truss.strut_kind().cloned() else { return Ok(None) };
        let start: Vec<Vec3> = truss.nodes.iter().map(|node| node.place).collect();
        let limits = truss_limits::of(call, limits, truss)?;
        let structure = Structure::new(&strut, &start, &truss.struts).limited(&start, limits);
        let structure = structure.amid(around.compiled(&strut));
        Ok(Some(Task { strut, start, structure, around, design }))
    }

    fn truss(&self) -> &TrussDesign {
        match &self.design.kind {
            DesignKind::Truss(truss) => truss,
            _ => unreachable!("it was made of a truss"),
        }
    }

    fn no_surface(&self, call: &Call, edges: &[(usize, usize)]) -> Diagnostic {
        let nodes = &self.truss().nodes;
        let name = |&(a, b): &(usize, usize)| format!("{} -- {}", nodes[a].name, nodes[b].name);
        let message = "a truss that morphs has an outer surface: its hull, of triangles of struts";
        let diagnostic = Diagnostic::error(code::NOT_COVERED, message);
        match edges {
            [] => diagnostic.label(call.at(0), "no triangle of struts has all nodes on one side"),
            [first, rest @ ..] => {
                let more = if rest.is_empty() { String::new() } else { format!(", and {} more", rest.len()) };
                diagnostic.label(call.at(0), format!("{} is not between two of them{more}", name(first)))
            }
        }
    }

    /// Why there was no step, by the bounds that were in the way.
    fn stuck(&self, stuck: &Stuck) -> String {
        let (why, bounds) = match stuck {
            Stuck::Infeasible(bounds) => ("no step keeps all limits", bounds),
            Stuck::Unsettled(bounds) => ("no step was found that keeps all limits", bounds),
        };
        let mut told: Vec<String> = Vec::new();
        // What is around it says more than its own struts, of which many are at some limit.
        let outer = |bound: &&Bound| matches!(bound, Bound::Clear(..) | Bound::Over(..));
        let bounds = bounds.iter().filter(outer).chain(bounds.iter().filter(|bound| !outer(bound)));
        for bound in bounds.map(|bound| self.bound(*bound)) {
            if !told.contains(&bound) {
                told.push(bound);
            }
        }
        let more = told.len().saturating_sub(BOUNDS_TOLD);
        told.truncate(BOUNDS_TOLD);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        if told.is_empty() { why.to_string() } else { format!("{why}: {}{more}", told.join(", ")) }
    }

    fn bound(&self, bound: Bound) -> String {
        let strut = |k: usize| self.truss().strut_name(k);
        match bound {
            Bound::Shortest(k) => format!("{} is at its least length", strut(k)),
            Bound::Longest(k) => format!("{} is at its greatest length", strut(k)),
            Bound::Apart(i, j) | Bound::EndApart(i, _, j) => format!("{} is near {}", strut(i), strut(j)),
            Bound::Above(node) => format!("{} is on the ground", self.truss().nodes[node].name),
            Bound::Over(k, _) => format!("{} is on the ground", strut(k)),
            Bound::Clear(k, part, _) => {
                let obstacle = self.structure.around.parts[part].0 + 1;
                format!("{} is near obstacle {obstacle}", strut(k))
            }
            Bound::Angle(i, j) => format!("{} is near {} in angle", strut(i), strut(j)),
            Bound::Least(k) | Bound::Most(k) => format!("the sum of perimeter {} changes", k + 1),
            Bound::Rigid(..) => "its rigidity is at its least".to_string(),
        }
    }

    /// How long the way of the centre of mass over the ground is, m.
    fn way_of_centre(&self, travel: &Travel) -> f64 {
        let mut x = self.start.clone();
        let mut way = 0.0;
        for step in &travel.moves {
            let before = self.structure.centre(&x);
            x = match step {
                Move::Step(y) => y.clone(),
                Move::Roll(turn) => roll::rolled(&x, *turn),
            };
            let after = self.structure.centre(&x);
            way += libm::hypot(after.x - before.x, after.y - before.y);
        }
        way
    }

    /// The moves as a plan, each in the least time that the struts allow.
    fn planned(
        self,
        interpreter: &mut Interpreter,
        call: &Call,
        planner: &str,
        world: World,
        moves: Vec<Move>,
        trussed: Trussed,
    ) -> Value {
        let causes = interpreter.planner_causes(call.span);
        let places = |x: &[Vec3]| x.iter().map(|p| (*p).into()).collect::<Vec<[f64; 3]>>();
        let cause = CauseId(0);
        let stands = world.gravity > 0.0;
        let margins = |x: &[Vec3]| margins::margins(&self.structure, x, stands);
        let (interpolation, nodes, at_start) =
            (Interpolation::Linear, places(&self.start), margins(&self.start));
        let mut keyframes = vec![Keyframe { time: 0.0, interpolation, nodes, cause, margins: at_start }];
        let (mut time, mut x) = (0.0, self.start.clone());
        for step in moves {
            let (y, interpolation, lasts) = match step {
                Move::Step(y) => {
                    let rate = self.structure.rates(&x, &y).fold(0.0, f64::max);
                    (y, Interpolation::Linear, rate / self.structure.speed)
                }
                Move::Roll(turn) => (
                    roll::rolled(&x, turn),
                    Interpolation::RigidRoll { edge: turn.edge, angle: turn.angle },
                    turn.angle.abs() / FALL,
                ),
            };
            time += lasts.max(STEP_MIN);
            x = y;
            keyframes.push(Keyframe { time, interpolation, nodes: places(&x), cause, margins: margins(&x) });
        }
        let truss = self.truss();
        let paths = NodePaths {
            strut: 0,
            node_names: truss.nodes.iter().map(|node| node.name.clone()).collect(),
            struts: truss.struts.clone(),
            keyframes,
            limits: truss_limits::planned(&self.structure),
            surroundings: self.around.planned(),
        };
        let library = Arc::new(Library { struts: vec![self.strut], ..Library::default() });
        let plan = interpreter.bare_plan(planner, Body::NodePaths(paths), library, world, &causes);
        let planned = Planned::new(self.design, None, plan, causes.ids, 0).with_trussed(trussed);
        Value::Record(Rc::new(Record::Plan(Rc::new(planned))))
    }
}
