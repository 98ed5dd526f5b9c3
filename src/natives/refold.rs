//! `refold`: from shape to shape through a flat sheet, as it is called, and what it gives back.

use super::fold_options::{shortest_step, step_of, too_fast};
use super::fold_panel::{self, Panel};
use super::fold_sheet::{NoSheet, Pieces, Sheet};
use super::fold_supply::Supply;
use super::{Native, on_run};
use crate::behavior::{self, Problem};
use crate::elaborate::robot_of::Robot;
use crate::interpret::call::Call;
use crate::interpret::interpreter::Interpreter;
use crate::interpret::planning::Planned;
use crate::interpret::record::Record;
use crate::interpret::stop::Eval;
use crate::interpret::value::Value;
use crate::plan::{Action, CauseId, Command, Node, Otherwise, Profile, Target as MoveTarget, World};
use crate::planners::fold::collision_free_order::OrderSearch;
use crate::planners::fold::inertia::Inertia;
use crate::planners::fold::sweep_collision::Solids;
use crate::planners::fold::{Layout, Target, Weights, energy_order, steps};
use crate::planners::refold::lattice_sheet::{Side, bond};
use crate::planners::refold::sheets::{self, NoRefolding, Refolding};
use crate::robot::{JointId, PortRef};
use crate::source::{Diagnostic, code};
use crate::units::Dimension;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

pub const TABLE: &[Native] = &[on_run("refold", 6, refold)];

/// Sheets that are tried until one unfolds and folds without collision.
const SHEETS_TRIED: usize = 8;

/// How often each panel of a layout may be opened in the search for an order.
const TURNS: usize = 32;

/// Orders that are put before the judge for either shape.
const ORDERS_TRIED: usize = 2;

/// What the planner says of its plan.
pub struct Refolded {
    pub changes: usize,
    pub bound: usize,
    /// By panel.
    pub becomes: Vec<usize>,
    /// N·m
    pub energy: f64,
}

/// The fields of a `Refolding` beside those of a plan.
pub const REFOLDING: &[&str] = &["changes", "bound", "becomes", "energy"];

pub fn refolding_field(refolded: &Refolded, field: &str) -> Value {
    match field {
        "changes" => Value::count(refolded.changes),
        "bound" => Value::count(refolded.bound),
        "becomes" => Value::list(refolded.becomes.iter().map(|face| Value::count(*face)).collect()),
        "energy" => Value::Quantity(refolded.energy, Dimension::TORQUE),
        _ => Value::Unknown,
    }
}

fn refold(interpreter: &mut Interpreter, call: &Call) -> Eval<Value> {
    let mut supply = Supply::of(interpreter, call, 2)?;
    let from = fold_panel::target(call, 0)?;
    let to = fold_panel::target(call, 1)?;
    let panel = (*supply.panel(interpreter, 0, &from, 0)?).clone();
    for (shape, target) in [(0, &from), (1, &to)] {
        (0..target.faces.len()).try_for_each(|face| supply.check_side(shape, target, face, &panel))?;
    }
    let step = match call.arg(3) {
        Value::Word(_) => shortest_step(&from, &panel).max(shortest_step(&to, &panel)),
        _ => call.positive(3, "the time of a step")?,
    };
    let seed = call.count(4, "a seed")? as u64;
    let budget = call.count(5, "a budget")? as u64;
    crate::interrupt::start_task(format!("refolding {} panels", from.faces.len()));
    let weights = [Weights::uniform(&from, panel.mass), Weights::uniform(&to, panel.mass)];
    let solids = Solids { parts: vec![panel.parts.clone(); from.faces.len()], touch: panel.touch };
    let task = Task { call, panel, solids, from, to, weights, step, seed };
    let settings = sheets::Settings { budget, seed, kept: SHEETS_TRIED };
    let cost = |sheet: &Refolding| task.at_best_root(sheet).1;
    let found = sheets::sheets(&task.from, &task.to, &task.solids, &settings, cost);
    let found = found.map_err(|why| task.refusal(why))?;
    for sheet in &found.best {
        let (sheet, energy) = task.at_best_root(sheet);
        for order in task.orders(&task.to, &sheet.to) {
            for back in task.orders(&task.from, &sheet.from) {
                let Some(planned) = task.judged(interpreter, &sheet, &back, &order)? else {
                    continue;
                };
                // Of the order that was taken only the leaves-first energy has a closed form.
                let energy = energy / (task.step * task.step);
                let (changes, becomes) = (sheet.strokes.len(), sheet.becomes.clone());
                let refolded = Refolded { changes, bound: found.bound, becomes, energy };
                let planned = planned.with_refolded(refolded);
                return Ok(Value::Record(Rc::new(Record::Plan(Rc::new(planned)))));
            }
        }
    }
    let message =
        "no sheet was found that unfolds from the one and folds into the other without panels meeting";
    Err(Diagnostic::error(code::NOT_COVERED, message)
        .label(call.span, "panels meet on the way")
        .hint("another `seed` or a greater `budget` leads to other sheets")
        .into())
}

/// Faces that fold at the same time, one set after the other; they unfold the other way round.
type Order = Vec<Vec<usize>>;

struct Task<'c> {
    call: &'c Call<'c>,
    panel: Panel,
    /// By panel.
    solids: Solids,
    from: Target,
    to: Target,
    weights: [Weights; 2],
    /// s
    step: f64,
    seed: u64,
}

impl Task<'_> {
    fn refusal(&self, why: NoRefolding) -> Diagnostic {
        let call = self.call;
        match why {
            NoRefolding::Counts => {
                let (a, b) = (self.from.faces.len(), self.to.faces.len());
                let message = format!("a shape of {a} panels can't become one of {b}");
                Diagnostic::error(code::BAD_VALUE, message)
                    .label(call.at(1), format!("{b} faces"))
                    .label(call.at(0), format!("{a} faces"))
                    .hint("panels are neither added nor taken away")
            }
            NoRefolding::Budget { apart, bound } => {
                let message = "no way was found from a sheet of the one to one of the other";
                let said = Diagnostic::error(code::NOT_COVERED, message)
                    .label(call.span, "every pair of sheets that was tried got stuck")
                    .hint("a greater `budget` or another `seed` may find one");
                match apart {
                    Some(apart) => said.hint(format!(
                        "the nearest two sheets differ in {apart} cells and connections; no way takes fewer \
                         than {bound} changes"
                    )),
                    None => said.hint(format!("no way takes fewer than {bound} changes")),
                }
            }
        }
    }

    /// Orders that are tried, where nothing is seen to meet: the leaves first, the one of least energy,
    /// the root's neighbours first; else one that is searched for.
    fn orders(&self, target: &Target, layout: &Layout) -> Vec<Order> {
        let masses = vec![self.panel.mass; target.faces.len()];
        let cheapest = energy_order::least_energy(target, layout, &masses, Inertia::Lamina);
        let cheapest = cheapest.map(|(order, _)| steps::of_order(layout, &order));
        let mut orders = vec![steps::leaves_first(layout)];
        orders.extend(cheapest);
        orders.push(steps::root_first(layout));
        orders.dedup();
        let wished = orders[0].concat();
        let mut passages = OrderSearch::new(target, layout, &self.solids, None, TURNS * target.faces.len());
        orders.retain(|order| passages.is_collision_free(order));
        orders.truncate(ORDERS_TRIED);
        if orders.len() < ORDERS_TRIED
            && let Some(order) = passages.order(&wished)
        {
            orders.push(passages.steps(&order));
        }
        orders
    }

    /// A sheet hung up at the panel with which unfolding and folding cost least together, and that
    /// energy: N·m for steps of one second.
    fn at_best_root(&self, sheet: &Refolding) -> (Refolding, f64) {
        let at = |panel: usize| {
            let sheet = sheet.rerooted(&self.from, &self.to, panel);
            let energy = sheet.from.energy(&self.weights[0]) + sheet.to.energy(&self.weights[1]);
            (sheet, energy)
        };
        let panels = (0..sheet.becomes.len()).map(at);
        panels.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a shape has panels")
    }

    /// The plan, if the judge lets it through.
    fn judged(
        &self,
        interpreter: &mut Interpreter,
        sheet: &Refolding,
        back: &Order,
        order: &Order,
    ) -> Eval<Option<Planned>> {
        let panels = vec![self.panel.design.clone(); sheet.becomes.len()];
        let span = self.call.span;
        let first = Pieces { target: &self.from, layout: &sheet.from, panels: &panels, span };
        let Sheet { design, robot, .. } = first.sheet(interpreter)?.map_err(|why| match why {
            NoSheet::Unsound => self.call.refuse(2, "no triangular panel: its module is not sound"),
            NoSheet::NoHinge => self.call.refuse(2, "no triangular panel: its edges have no hinge"),
        })?;
        let causes = interpreter.planner_causes(span);
        let problem = Problem {
            robot: robot.assembly.as_ref().clone(),
            start: robot.start.clone(),
            program: Program { task: self, sheet, robot: &robot }.whole(back, order),
            start_causes: Vec::new(),
            bond_causes: (0..robot.assembly.bonds.len()).map(|bond| (bond, CauseId(0))).collect(),
            settings: behavior::Settings::default(),
        };
        let scheduled = behavior::schedule(problem)
            .map_err(|refusal| interpreter.refused(&refusal, &causes.ids, span))?;
        let (mut planned, issues) = interpreter.assemble_plan(design, robot, scheduled, &causes, World::FREE);
        if !issues.is_empty() {
            let [from, to] = [&self.from, &self.to].map(|shape| shortest_step(shape, &self.panel));
            return Err(too_fast(self.call, 3, from.max(to)));
        }
        planned.plan.provenance.planner = "refold".into();
        planned.plan.provenance.seed = Some(self.seed);
        let settings = interpreter.judge_settings();
        Ok(interpreter.judge(&planned, settings, None).ok().then_some(planned))
    }
}

/// Makes the program of a sheet.
struct Program<'p> {
    task: &'p Task<'p>,
    sheet: &'p Refolding,
    /// Joined as the first shape's layout says.
    robot: &'p Robot,
}

impl Program<'_> {
    /// Unfolds, changes connections in the plane, folds. A new connection is made before an old one
    /// goes, at the same instant: the robot stays in one piece.
    fn whole(&self, back: &Order, order: &Order) -> Arc<Node> {
        let mut series = Vec::new();
        let (from, to) = (&self.sheet.from, &self.sheet.to);
        let step = self.task.step;
        for faces in back.iter().rev() {
            let moves = faces.iter().map(|&face| {
                let hinge = from.hinge[face].expect("only the root has none");
                let moves = self.task.from.hinges[hinge].angle != 0.0;
                moves.then(|| turned(self.joint_of_bond(bond_of(from, face)), 0.0, step))
            });
            series.push(Node::Parallel(moves.flatten().collect()));
        }
        let bonds = &self.robot.assembly.bonds;
        let side = |port: PortRef| (port.module, port.port);
        let known = |i: usize| (bond(side(bonds[i].a), side(bonds[i].b)), self.joint_of_bond(i));
        let mut joints: BTreeMap<[Side; 2], usize> = (0..bonds.len()).map(known).collect();
        let port = |(module, port): Side| PortRef { module, port };
        for (made, stroke) in self.sheet.strokes.iter().enumerate() {
            let time = step.max(step_of(stroke.angle.abs(), &self.task.panel));
            let all = |joints: &BTreeMap<[Side; 2], usize>,
                       sides: &mut dyn Iterator<Item = &[Side; 2]>,
                       to: f64| {
                Node::Parallel(sides.map(|sides| turned(joints[sides], to, time)).collect())
            };
            series.push(all(&joints, &mut stroke.fold.iter(), stroke.angle));
            let [a, b] = stroke.make.map(port);
            series.push(action(Command::Dock { a, b }));
            series.push(action(Command::Undock { port: port(stroke.cut[0]) }));
            // A hinge that is made comes behind all that there are.
            joints.insert(stroke.make, self.robot.start.joints.len() + made);
            joints.remove(&stroke.cut);
            let ends = stroke.fold.iter().filter(|sides| **sides != stroke.cut);
            let opens = if stroke.fold.is_empty() { None } else { Some(&stroke.make) };
            series.push(all(&joints, &mut ends.chain(opens), 0.0));
        }
        for faces in order {
            let moves = faces.iter().map(|&face| {
                let angle = self.task.to.hinges[to.hinge[face].expect("only the root has none")].angle;
                (angle != 0.0).then(|| turned(joints[&self.sides(face)], angle, step))
            });
            series.push(Node::Parallel(moves.flatten().collect()));
        }
        let idle = |node: &Node| matches!(node, Node::Parallel(moves) if moves.is_empty());
        Arc::new(Node::Series(series.into_iter().filter(|node| !idle(node)).map(Arc::new).collect()))
    }

    /// The sides of panels that a face of the second shape and its parent join by their hinge.
    fn sides(&self, face: usize) -> [Side; 2] {
        let across = self.sheet.to.across(&self.task.to, face);
        let [a, b] = [(across.parent, across.parent_side), (face, across.side)].map(|(face, side)| {
            let panel = self.sheet.becomes.iter().position(|f| *f == face).expect("every face is a panel");
            (panel, self.sheet.side(panel, side))
        });
        bond(a, b)
    }

    fn joint_of_bond(&self, bond: usize) -> usize {
        self.robot.kinematics.hinge(bond).expect("every bond has a hinge")
    }
}

fn turned(joint: usize, to: f64, time: f64) -> Arc<Node> {
    Arc::new(action(Command::Move {
        joint: JointId(joint as u32),
        target: MoveTarget::To(to),
        duration: Some(time),
        profile: Profile::Smooth,
    }))
}

fn action(command: Command) -> Node {
    let otherwise = Otherwise::Proceed;
    Node::Action(Action { command, until: None, timeout: None, otherwise, cause: CauseId(0) })
}

/// Bonds are made in the layout's order, one for each face but the root.
fn bond_of(layout: &Layout, face: usize) -> usize {
    layout.order.iter().position(|f| *f == face).expect("the order names every face") - 1
}
