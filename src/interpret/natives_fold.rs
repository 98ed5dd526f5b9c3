//! `fold`: the planner of folding, as it is called, and what it gives back.

use super::call::Call;
use super::design::{BondRecord, ConfigDesign, Design, DesignKind, FlatModule, PartElement, PartGroup};
use super::interpreter::Interpreter;
use super::natives::{Native, on_run};
use super::planning::Planned;
use super::record::Record;
use super::robot_of::Robot;
use super::stop::{Eval, Stop, fault};
use super::value::Value;
use crate::behavior::{self, Problem};
use crate::geometry::Pose;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target as MoveTarget, World};
use crate::planners::fold::enumerate::{self, TooManyFaces};
use crate::planners::fold::exact::{self, NoLayout};
use crate::planners::fold::heuristic::{self, Measure};
use crate::planners::fold::weights::Inertia;
use crate::planners::fold::{Layout, Proof, Target, Unfoldable, Weights, count, order_energy, steps};
use crate::robot::{JointId, State};
use crate::source::{Diagnostic, code};
use num_bigint::BigInt;
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[on_run("fold", 7, fold)];

/// How far sides may be off those of the panels, as a part of them.
const TOL_SIDE: f64 = 1e-6;

/// Layouts of the same energy that are tried until one folds without collision.
const TIES_TRIED: u64 = 6;

/// Steps are as long as the fastest hinge needs, up to a multiple of this, s.
const STEP_GRAIN: f64 = 0.01;

/// Greatest speed and acceleration of the quintic motion by one unit in a unit of time.
const QUINTIC_SPEED: f64 = 1.875;
const QUINTIC_ACCELERATION: f64 = 5.773_502_691_896_258;

/// What the planner says of a plan beside the plan itself.
pub struct Folded {
    pub pattern: FlatPattern,
    pub layouts: BigInt,
    pub energy: f64,
    pub bound: f64,
    pub optimal: bool,
    pub ties: Vec<usize>,
    /// Faces that fold at the same time.
    pub steps: Vec<Vec<usize>>,
}

/// A layout with its target.
#[derive(Debug)]
pub struct FlatPattern {
    pub target: Target,
    pub layout: Layout,
}

/// What a triangular panel is to the planner.
struct Panel {
    design: Rc<Design>,
    /// kg
    mass: f64,
    /// m
    side: f64,
}

/// A layout that may be what is wanted, with what is known about it.
struct Choice {
    layout: Layout,
    bound: f64,
    proved: bool,
    ties: Vec<usize>,
}

/// A choice with an order that was judged.
struct Outcome {
    planned: Planned,
    steps: Vec<Vec<usize>>,
    /// N·m
    energy: f64,
    step: f64,
}

fn fold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let panel = panel(call)?;
    let target = target(call, &panel)?;
    let root = match call.arg(2) {
        Value::Word(_) => None,
        _ => Some(call.count(2, "a face")?).filter(|root| *root < target.faces.len()).map_or_else(
            || Err(call.refuse(2, format!("there is no such face: there are {}", target.faces.len()))),
            |root| Ok(Some(root)),
        )?,
    };
    let seed = call.count(5, "a seed")? as u64;
    let budget = call.count(6, "a budget")? as u64;
    interpreter.stage.progress(format!("folding {} panels", target.faces.len()));
    let weights = Weights::uniform(&target, panel.mass);
    let settings = exact::Settings { root, flat: true, budget, seed };
    let first = match call.word(3) {
        Some("enumerate") => enumerated(&target, &weights, &settings, call)?,
        Some("heuristic") => preferred(&target, &panel, &settings, call)?,
        _ => proved(&target, &weights, &settings, call)?,
    };
    let folding = Task { call, panel, target, weights, settings };
    folding.plan(interpreter, first)
}

fn panel(call: &Call) -> Eval<Panel> {
    let design = call.instance(1)?.design.clone();
    let no_panel = |why: &str| call.refuse(1, format!("no triangular panel: {why}"));
    let Some(module) = design.module() else { return Err(no_panel("a module is wanted")) };
    let kind = &module.module;
    let [a, b, c] = &kind.ports[..] else { return Err(no_panel("it needs one port for each edge")) };
    if kind.links.len() != 1 {
        return Err(no_panel("it has more than one link"));
    }
    // From the middle of one edge to those of the others it is half a side.
    let middle = |port: &crate::robot::Port| port.pose.translation.vector;
    let halves = [(a, b), (b, c), (c, a)].map(|(p, q)| (middle(q) - middle(p)).norm());
    let side = 2.0 * halves[0];
    if halves.iter().any(|half| (2.0 * half - side).abs() > TOL_SIDE * side) {
        return Err(no_panel("its ports are not at the middles of equal edges"));
    }
    Ok(Panel { mass: kind.links[0].mass, side, design: design.clone() })
}

fn target(call: &Call, panel: &Panel) -> Eval<Target> {
    let Value::Mesh(mesh) = call.arg(0) else { return Err(call.refuse(0, "a mesh is wanted")) };
    let unfoldable = |why: Unfoldable| -> Stop {
        let mut said =
            Diagnostic::error(code::UNFOLDABLE, why.to_string()).label(call.at(0), "does not fold");
        if let Unfoldable::UnequalSides { .. } = why {
            said = said.label(call.at(1), "these panels").hint("give the mesh and the module the same side");
        }
        said.into()
    };
    let target = Target::new(mesh.vertices.clone(), &mesh.faces).map_err(unfoldable)?;
    target.check_sides(panel.side, TOL_SIDE * panel.side).map_err(unfoldable)?;
    Ok(target)
}

fn proved(target: &Target, weights: &Weights, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let found = exact::optimum(target, weights, settings).map_err(|why| match why {
        NoLayout::AllOverlap => Stop::from(
            Diagnostic::error(code::NO_WAY, "every flat pattern of this shape overlaps itself")
                .label(call.at(0), "can't lie flat in one piece"),
        ),
        NoLayout::Budget => fault(
            code::NOT_COVERED,
            call.span,
            "the budget ended before any pattern was found that does not overlap",
            "a greater `budget` may find one",
        ),
    })?;
    let proved = found.proof == Proof::Optimal;
    Ok(Choice { layout: found.layout, bound: found.bound, proved, ties: found.roots })
}

fn too_many<'a>(call: &'a Call<'a>) -> impl Fn(TooManyFaces) -> Stop + 'a {
    |TooManyFaces| {
        let limit = enumerate::FACES_MAX;
        let message = format!("shapes of more than {limit} faces have too many layouts to look at each");
        Diagnostic::error(code::NOT_COVERED, message)
            .label(call.at(0), "too many faces")
            .hint("`method: exact` proves its answer without looking at every layout")
            .into()
    }
}

fn enumerated(target: &Target, weights: &Weights, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let asked = enumerate::Settings { root: settings.root, spectrum: false, budget: settings.budget };
    let found = enumerate::census(target, weights, &asked).map_err(too_many(call))?;
    let tie = found.least * (1.0 + exact::TOL_TIE);
    let ties = (0..found.by_root.len()).filter(|root| found.by_root[*root] <= tie).collect();
    let bound = if found.complete { found.least } else { 0.0 };
    Ok(Choice { layout: found.best, bound, proved: found.complete, ties })
}

fn preferred(target: &Target, panel: &Panel, settings: &exact::Settings, call: &Call) -> Eval<Choice> {
    let measure = Measure::of_panels(panel.mass, panel.side);
    let found =
        heuristic::preferred(target, &measure, settings.root, settings.budget).map_err(too_many(call))?;
    let ties = vec![found.layout.root];
    Ok(Choice { layout: found.layout, bound: 0.0, proved: false, ties })
}

struct Task<'c> {
    call: &'c Call<'c>,
    panel: Panel,
    target: Target,
    weights: Weights,
    settings: exact::Settings,
}

impl Task<'_> {
    /// The first choice that the judge lets through: with the leaves first, then others of the same
    /// energy, then in other orders.
    fn plan(self, interpreter: &mut Interpreter, first: Choice) -> Eval<Value> {
        let mut tried: Vec<Vec<usize>> = Vec::new();
        for tie in 0..=TIES_TRIED {
            let layout = match tie {
                0 => first.layout.clone(),
                // A choice that need not be the best has no ties to look for.
                _ if !first.proved => break,
                _ => {
                    let seed = self.settings.seed.wrapping_add(tie);
                    let settings = exact::Settings { seed, root: Some(first.layout.root), ..self.settings };
                    match exact::optimum(&self.target, &self.weights, &settings) {
                        Ok(other) => other.layout,
                        Err(_) => break,
                    }
                }
            };
            if tried.contains(&layout.hinges()) {
                continue;
            }
            tried.push(layout.hinges());
            let least = first.layout.energy(&self.weights) * (1.0 + exact::TOL_TIE);
            if layout.energy(&self.weights) > least {
                continue;
            }
            let order = steps::leaves_first(&layout);
            if let Some(outcome) = self.judged(interpreter, &layout, order)? {
                return Ok(self.answer(layout, outcome, &first, first.proved));
            }
        }
        let masses = vec![self.panel.mass; self.target.faces.len()];
        let cheap = order_energy::least_energy(&self.target, &first.layout, &masses, Inertia::Lamina);
        let cheap = cheap.map(|(order, _)| steps::of_order(&first.layout, &order));
        for order in cheap.into_iter().chain([steps::root_first(&first.layout)]) {
            if let Some(outcome) = self.judged(interpreter, &first.layout, order)? {
                return Ok(self.answer(first.layout.clone(), outcome, &first, false));
            }
        }
        let message = "no order of folding was found in which no panels meet";
        Err(Diagnostic::error(code::NOT_COVERED, message)
            .label(self.call.at(0), "panels meet on the way")
            .hint("another `root` or `seed` leads to other patterns")
            .into())
    }

    fn answer(&self, layout: Layout, outcome: Outcome, first: &Choice, optimal: bool) -> Value {
        let Outcome { planned, steps, energy, step } = outcome;
        let layouts = count::layouts(&self.target);
        let pattern = FlatPattern { target: self.target.clone(), layout };
        let bound = first.bound / (step * step);
        let ties = first.ties.clone();
        let folded = Folded { pattern, layouts, energy, bound, optimal, ties, steps };
        Value::Record(Rc::new(Record::Plan(Rc::new(planned.with_folded(folded)))))
    }

    /// The plan of an order, if the judge lets it through.
    fn judged(
        &self,
        interpreter: &mut Interpreter,
        layout: &Layout,
        order: Vec<Vec<usize>>,
    ) -> Eval<Option<Outcome>> {
        let (design, robot, flat) = self.robot(interpreter, layout)?;
        let step = match self.call.arg(4) {
            Value::Word(_) => self.shortest_step(&robot, layout),
            _ => self.call.positive(4, "the time of a step")?,
        };
        let causes = interpreter.planner_causes(self.call.span);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start: flat,
            program: self.program(&robot, layout, &order, step),
            start_causes: Vec::new(),
            bond_causes: (0..robot.assembly.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        };
        let scheduled = behavior::schedule(problem)
            .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, self.call.span))?;
        let (mut planned, issues) = interpreter.assemble_plan(design, robot, scheduled, &causes, World::FREE);
        if !issues.is_empty() {
            return Err(self.call.refuse(4, "the hinges can't fold as fast as that"));
        }
        planned.plan.provenance.planner = "fold".into();
        planned.plan.provenance.seed = Some(self.settings.seed);
        let settings = interpreter.judge_settings();
        if !interpreter.judge(&planned, settings, None).ok() {
            return Ok(None);
        }
        let masses = vec![self.panel.mass; self.target.faces.len()];
        let sequence = order.concat();
        let energy = order_energy::energy(&self.target, layout, &masses, Inertia::Lamina, &sequence);
        Ok(Some(Outcome { planned, steps: order, energy: energy / (step * step), step }))
    }

    fn angle(&self, layout: &Layout, face: usize) -> f64 {
        layout.hinge[face].map_or(0.0, |hinge| self.target.hinges[hinge].angle)
    }

    /// What every hinge can do, s.
    fn shortest_step(&self, robot: &Robot, layout: &Layout) -> f64 {
        let angles = (0..self.target.faces.len()).map(|face| self.angle(layout, face).abs());
        let angle = angles.fold(0.0, f64::max);
        let limits = robot.assembly.hinge(0).map(|hinge| hinge.limits).unwrap_or_default();
        let by_speed = limits.speed.map_or(0.0, |speed| QUINTIC_SPEED * angle / speed);
        let by_acceleration =
            limits.acceleration.map_or(0.0, |limit| libm::sqrt(QUINTIC_ACCELERATION * angle / limit));
        let least = by_speed.max(by_acceleration);
        if least > 0.0 { (least / STEP_GRAIN).ceil().max(1.0) * STEP_GRAIN } else { 1.0 }
    }

    fn program(&self, robot: &Robot, layout: &Layout, order: &[Vec<usize>], step: f64) -> Arc<Node> {
        let fold = |face: usize| {
            let joint = robot.kinematics.hinge(bond_of(layout, face)).expect("every bond has a hinge");
            let command = Command::Move {
                joint: JointId(joint as u32),
                target: MoveTarget::To(self.angle(layout, face)),
                duration: Some(step),
                profile: Profile::Smooth,
            };
            let otherwise = Otherwise::Proceed;
            Node::Action(Action { command, until: None, timeout: None, otherwise, cause: CauseId(0) })
        };
        let moving = |faces: &Vec<usize>| -> Vec<Arc<Node>> {
            let faces = faces.iter().filter(|face| self.angle(layout, **face) != 0.0);
            faces.map(|face| Arc::new(fold(*face))).collect()
        };
        let steps = order.iter().map(moving).filter(|moves| !moves.is_empty());
        Arc::new(Node::Series(steps.map(|moves| Arc::new(Node::Parallel(moves))).collect()))
    }

    /// The panels of a layout joined by their hinges: a design whose own pose is the folded one, and
    /// the flat state.
    fn robot(&self, interpreter: &mut Interpreter, layout: &Layout) -> Eval<(Rc<Design>, Rc<Robot>, State)> {
        let flat = self.sheet(layout);
        let Some(robot) = interpreter.robot_of(&flat)? else {
            return Err(self.call.refuse(1, "no triangular panel: its module is not sound"));
        };
        if (0..robot.assembly.bonds.len()).any(|bond| robot.kinematics.hinge(bond).is_none()) {
            return Err(self.call.refuse(1, "no triangular panel: its edges have no hinge"));
        }
        let mut start = robot.start.clone();
        for &face in &layout.order[1..] {
            let joint = robot.kinematics.hinge(bond_of(layout, face)).expect("every bond has a hinge");
            start.joints[joint] = self.angle(layout, face);
        }
        let mut poses = vec![Pose::identity(); robot.kinematics.link_count()];
        robot.kinematics.link_poses(&start.joints, &Pose::identity(), &mut poses);
        let folded =
            Robot { assembly: robot.assembly.clone(), start, kinematics: robot.kinematics.clone(), poses };
        let folded = Rc::new(folded);
        let design = self.sheet(layout);
        let config = design.config().expect("made as a configuration");
        assert!(config.robot.set(Some(folded.clone())).is_ok(), "it was just made");
        Ok((design, folded, robot.start.clone()))
    }

    fn sheet(&self, layout: &Layout) -> Rc<Design> {
        let panel = &self.panel.design;
        let name = |face: usize| -> Rc<str> { format!("panel[{face}]").into() };
        let faces = 0..self.target.faces.len();
        let config = ConfigDesign::default();
        let elements =
            faces.clone().map(|face| PartElement { design: panel.clone(), offset: face, name: name(face) });
        let group = PartGroup { list: true, elements: elements.collect() };
        assert!(config.parts.set(vec![group]).is_ok(), "it was just made");
        let modules = faces.map(|face| FlatModule { name: name(face), design: panel.clone() });
        assert!(config.modules.set(modules.collect()).is_ok(), "it was just made");
        for &face in &layout.order[1..] {
            let hinge = &self.target.hinges[layout.hinge[face].expect("only the root has none")];
            let own = usize::from(hinge.faces[1] == face);
            let span = self.call.span;
            config.add_bond(BondRecord {
                a: (layout.parent[face], hinge.sides[1 - own]),
                b: (face, hinge.sides[own]),
                turn: 0,
                span,
                ends: (span, span),
                instance: "".into(),
            });
        }
        config.base.set(Some(layout.root));
        config.order.set(1);
        config.complete.set(true);
        Rc::new(Design {
            // Of its panels: no declaration of its own stands behind it.
            def: panel.def,
            name: format!("{}[{}]", panel.name, self.target.faces.len()),
            args: Vec::new(),
            kind: DesignKind::Config(config),
            broken: Cell::new(false),
        })
    }
}

/// Bonds are made in the layout's order, one for each face but the root.
fn bond_of(layout: &Layout, face: usize) -> usize {
    layout.order.iter().position(|f| *f == face).expect("the order names every face") - 1
}
