//! The entry of the planner: from one shape to another of the same panels.

use super::lattice_sheet::{Side, bond};
use super::sheets::{self, NoRefolding, Refolding};
use crate::behavior;
use crate::interrupt;
use crate::plan::{self, Command, Node, Verdict, World};
use crate::planners::fold::collision_free_order::OrderSearch;
use crate::planners::fold::inertia::Inertia;
use crate::planners::fold::judgement::{Fault, Judged, Motion, judged};
use crate::planners::fold::sheet::{Sheet, action, turn};
use crate::planners::fold::{Layout, Observer, Panels, Target, Weights, energy_order, steps};
use crate::planners::{Progress, Solution};
use crate::robot::{JointId, PortRef};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// The number of sheets that are tried until one unfolds and folds without collision.
const SHEETS_TRIED: usize = 8;

/// The number of sampled steps for each panel in the search for an order.
const SAMPLES_PER_PANEL: usize = 32;

/// The number of orders that are put before the judge for either shape.
const ORDERS_TRIED: usize = 2;

/// A refolding problem: two shapes of as many equal panels, and the panels.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The shape at the beginning, m: face k is panel k.
    pub from: Target,
    /// The shape at the end, m; its sides have the length of the first shape's.
    pub to: Target,
    /// The panels, one for each face, all of one type and equilateral.
    pub panels: Panels,
    /// The number of the last faces of one of the shapes that hang on it in a flat strip ([`with_equal_counts`]), whose place
    /// was chosen; 0: none.
    ///
    /// [`with_equal_counts`]: super::with_equal_counts
    pub flat: usize,
}

/// The settings of [`plan()`].
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The time of each step, s; `None`: the least that the limits of all hinges allow for the greatest fold angle of
    /// both shapes. Steps that close or open a fan in the plane take longer if their hinges need it. Default `None`.
    pub step: Option<f64>,
    /// The seed of random choices among equals. Default 0.
    pub seed: u64,
    /// The greatest number of sides of panels on growing sheets that are examined for a panel that may come next there:
    /// one half in the search for sheets, the other for the lower bound. Default 20 million.
    pub budget: u64,
    /// The settings of the judge that every plan has to pass. Default [`plan::Settings::default`].
    pub judge: plan::Settings,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { step: None, seed: 0, budget: 20_000_000, judge: plan::Settings::default() }
    }
}

/// The figures of a refolding and of the search for it: its changes with their lower bound, its energy and layout, and
/// the verdict.
#[derive(Clone, Debug)]
pub struct Report {
    /// The number of connections of panels that are made, which is also the number of those undone.
    pub changes: usize,
    /// The lower bound on the number of connections that any motion between the shapes makes; 0 where panels are left flat,
    /// which may hang elsewhere.
    pub bound: usize,
    /// The number of panels that are left flat in one of the shapes.
    pub flat: usize,
    /// The face of the second shape that each panel becomes, as an index, in the order of the first shape's faces.
    pub becomes: Vec<usize>,
    /// The energy of unfolding and folding with the leaves first, whatever the orders taken, without the changes in
    /// the plane: the sum of mean torques, N·m.
    pub energy: f64,
    /// The layout by which the first shape unfolds, rooted at its root.
    pub layout: Layout,
    /// The number of actions of the program.
    pub actions: u64,
    /// The verdict of the judge, which let the plan pass.
    pub verdict: Verdict,
}

impl Report {
    /// Returns the gap between the bound and the changes, as a fraction of these, 0 to 1; 0 where the bound proves that no
    /// motion makes fewer.
    pub fn gap(&self) -> f64 {
        if self.bound >= self.changes { 0.0 } else { 1.0 - self.bound as f64 / self.changes as f64 }
    }

    /// Returns in words what is proved of the number of changes.
    pub fn why(&self) -> String {
        if self.bound >= self.changes {
            "proved: no way makes fewer changes".into()
        } else if self.flat > 0 {
            "not proved: the panels that are left flat may hang elsewhere".into()
        } else {
            format!("not proved: no way makes fewer than {} changes", self.bound)
        }
    }
}

/// The reason why [`plan()`] finds no motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The shapes have different numbers of faces.
    Counts {
        /// The numbers of faces of the first and of the second shape.
        faces: [usize; 2],
    },
    /// No motion between sheets of the two shapes was found.
    NoWay {
        /// The number of lattice cells and connections in which the nearest two sheets differ; `None` where no two
        /// sheets were found.
        apart: Option<usize>,
        /// The lower bound on the number of connections that any motion makes.
        bound: usize,
    },
    /// Every sheet that was found collides in the samples of its orders, or is refused by the judge.
    Collides,
    /// The connectors of panels that have to be joined have no hinge.
    NoHinge,
    /// The time of a step is shorter than the limits of the hinges allow.
    StepTooShort {
        /// The least time of a step that is long enough, s.
        least: f64,
    },
    /// The program can't be scheduled, for the reason given.
    Schedule(behavior::Refusal),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Counts { faces: [a, b] } => {
                write!(f, "a shape of {a} panels can't become one of {b}")
            }
            Refusal::NoWay { .. } => {
                f.write_str("no way was found from a sheet of the one to one of the other")
            }
            Refusal::Collides => f.write_str(
                "no sheet was found that unfolds from the one and folds into the other without panels meeting",
            ),
            Refusal::NoHinge => f.write_str("no triangular panel: its edges have no hinge"),
            Refusal::StepTooShort { .. } => f.write_str("the hinges can't fold as fast as that"),
            Refusal::Schedule(refusal) => refusal.reason.fmt(f),
        }
    }
}

impl std::error::Error for Refusal {}

/// Plans the motion from one shape to another: it unfolds, changes connections in the plane, and folds again, with as
/// few changes as are found, without gravity. All actions of the program have cause 0. `progress` receives reports and
/// may end the search.
///
/// # Errors
/// A [`Refusal`]: shapes of different numbers of faces, panels without hinges, steps that are too short, a program that
/// can't be scheduled, or no motion found that the judge lets through.
///
/// # Example
/// A tetrahedron becomes another one of the same size:
///
/// ```
/// use modl::geometry::Vec3;
/// use modl::planners::{NoProgress, fold, refold};
///
/// let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
/// let vertices = corners.map(|p| Vec3::from(p) * (0.08 / 8.0_f64.sqrt())).to_vec();
/// let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|face| face.to_vec());
/// let from = fold::Target::new(vertices, &faces)?;
/// let panels = fold::Plate::default().panels(&from)?;
///
/// let problem = refold::Problem { to: from.clone(), from, panels, flat: 0 };
/// let settings = refold::Settings { budget: 100_000, ..refold::Settings::default() };
/// let solution = refold::plan(&problem, &settings, &mut NoProgress)?;
/// assert_eq!(solution.report.changes, 0);
/// assert!(solution.report.verdict.ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plan(
    problem: &Problem,
    settings: &Settings,
    progress: &mut dyn Progress,
) -> Result<Solution<Report>, Refusal> {
    let observer = Observer::new(progress);
    let Problem { from, to, panels, flat } = problem;
    interrupt::start_task(format!("refolding {} panels", from.faces.len()));
    let mass = panels.weakest.mass;
    let weights = [Weights::uniform(from, mass), Weights::uniform(to, mass)];
    let step = settings.step.unwrap_or_else(|| least_step(problem));
    let task = Task { problem, settings, weights, step };
    // Sheets that both shapes nearly share, those with the fewest changes first.
    let sought = sheets::Settings { budget: settings.budget, seed: settings.seed, kept: SHEETS_TRIED };
    let cost = |sheet: &Refolding| task.at_best_root(sheet).1;
    let found = sheets::sheets(from, to, &panels.solids, &sought, cost, &observer);
    let found = found.map_err(|why| match why {
        NoRefolding::Counts => Refusal::Counts { faces: [from, to].map(|shape| shape.faces.len()) },
        NoRefolding::Budget { apart, bound } => Refusal::NoWay { apart, bound },
    })?;
    // Orders of folding and unfolding, until the judge accepts a pair.
    for sheet in &found.best {
        let (sheet, energy) = task.at_best_root(sheet);
        for order in task.orders(to, &sheet.to) {
            for back in task.orders(from, &sheet.from) {
                if let Some(solution) = task.judged(&sheet, &back, &order)? {
                    // Of the orders that were taken only the leaves-first energy has a closed form.
                    let energy = energy / (step * step);
                    let bound = if *flat > 0 { 0 } else { found.bound };
                    return Ok(answer(solution, sheet, (bound, *flat), energy));
                }
            }
        }
    }
    Err(Refusal::Collides)
}

/// Returns the solution of a sheet that the judge has accepted, with its report.
fn answer(
    solution: Solution<Judged>,
    sheet: Refolding,
    (bound, flat): (usize, usize),
    energy: f64,
) -> Solution<Report> {
    let Solution { body, program, report: Judged { actions, verdict } } = solution;
    let Refolding { from: layout, becomes, strokes, .. } = sheet;
    let report = Report { changes: strokes.len(), bound, flat, becomes, energy, layout, actions, verdict };
    Solution { body, program, report }
}

/// Returns the least time of a step that every hinge of both shapes can keep, s.
fn least_step(Problem { from, to, panels, .. }: &Problem) -> f64 {
    let widest = |shape: &Target| shape.hinges.iter().map(|hinge| hinge.angle.abs()).fold(0.0, f64::max);
    let [from, to] = [from, to].map(|shape| panels.weakest.step_time(widest(shape)));
    from.max(to)
}

/// The faces that fold at the same time, step by step; they unfold in the opposite order.
type Order = Vec<Vec<usize>>;

/// A planning call at work.
struct Task<'p> {
    problem: &'p Problem,
    settings: &'p Settings,
    /// The costs of the hinges of the first and of the second shape.
    weights: [Weights; 2],
    /// The time of a step, s.
    step: f64,
}

impl Task<'_> {
    /// Returns orders whose samples show no collision: leaves first, of least energy, root first; else one
    /// that is searched.
    fn orders(&self, target: &Target, layout: &Layout) -> Vec<Order> {
        let panels = &self.problem.panels;
        let masses = vec![panels.weakest.mass; target.faces.len()];
        let cheapest = energy_order::least_energy(target, layout, &masses, Inertia::Lamina);
        let cheapest = cheapest.map(|(order, _)| steps::of_order(layout, &order));
        let mut orders = vec![steps::leaves_first(layout)];
        orders.extend(cheapest);
        orders.push(steps::root_first(layout));
        orders.dedup();
        let preferred = orders[0].concat();
        let samples = SAMPLES_PER_PANEL * target.faces.len();
        let mut search = OrderSearch::new(target, layout, &panels.solids, None, samples);
        orders.retain(|order| search.is_collision_free(order));
        orders.truncate(ORDERS_TRIED);
        if orders.len() < ORDERS_TRIED
            && let Some(order) = search.order(&preferred)
        {
            orders.push(search.steps(&order));
        }
        orders
    }

    /// Returns a sheet rooted at the panel with which unfolding and folding cost the least together, and that
    /// energy, N·m for steps of one second.
    fn at_best_root(&self, sheet: &Refolding) -> (Refolding, f64) {
        let at = |panel: usize| {
            let sheet = sheet.rerooted(&self.problem.from, &self.problem.to, panel);
            let energy = sheet.from.energy(&self.weights[0]) + sheet.to.energy(&self.weights[1]);
            (sheet, energy)
        };
        let panels = (0..sheet.becomes.len()).map(at);
        panels.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a shape has panels")
    }

    /// Returns the plan of a sheet, if the judge lets it through.
    fn judged(
        &self,
        sheet: &Refolding,
        back: &Order,
        order: &Order,
    ) -> Result<Option<Solution<Judged>>, Refusal> {
        let Problem { from, panels, .. } = self.problem;
        let joined = Sheet::new(from, panels, &sheet.from).map_err(|_| Refusal::NoHinge)?;
        let start = joined.folded(from, &sheet.from);
        let program = Program { task: self, sheet, joined: &joined }.whole(back, order);
        let motion = Motion {
            robot: joined.assembly.clone(),
            start,
            program,
            world: World::FREE,
            judge: self.settings.judge,
        };
        match judged(motion) {
            Ok(solution) => Ok(Some(solution)),
            Err(Fault::Refused(_)) => Ok(None),
            Err(Fault::Schedule(refusal)) => Err(Refusal::Schedule(refusal)),
            Err(Fault::TooFast) => Err(Refusal::StepTooShort { least: least_step(self.problem) }),
        }
    }
}

/// The program of a sheet.
struct Program<'p> {
    task: &'p Task<'p>,
    sheet: &'p Refolding,
    /// Joined as the first shape's layout says.
    joined: &'p Sheet,
}

impl Program<'_> {
    /// Returns the program that unfolds, changes connections in the plane, and folds. A new connection is made
    /// before an old one is undone, at the same instant, so that the robot stays in one piece.
    fn whole(&self, back: &Order, order: &Order) -> Arc<Node> {
        let mut series = Vec::new();
        let (from, to) = (&self.sheet.from, &self.sheet.to);
        let Problem { from: first, to: second, panels, .. } = self.task.problem;
        let step = self.task.step;
        // Unfolding: the order backwards.
        for faces in back.iter().rev() {
            let moves = faces.iter().map(|&face| {
                let joint = self.joined.joint(from, face);
                (from.angle(first, face) != 0.0).then(|| Arc::new(turn(joint, 0.0, step)))
            });
            series.push(Node::Parallel(moves.flatten().collect()));
        }
        // Strokes in the plane; a hinge that is made gets the index after all that there are.
        let bonds = &self.joined.assembly.bonds;
        let side = |port: PortRef| (port.module, port.port);
        let known = |i: usize| (bond(side(bonds[i].a), side(bonds[i].b)), self.joined.joints[i]);
        let mut joints: BTreeMap<[Side; 2], JointId> = (0..bonds.len()).map(known).collect();
        let port = |(module, port): Side| PortRef { module, port };
        for (made, stroke) in self.sheet.strokes.iter().enumerate() {
            let time = step.max(panels.weakest.step_time(stroke.angle.abs()));
            let all = |joints: &BTreeMap<[Side; 2], JointId>,
                       sides: &mut dyn Iterator<Item = &[Side; 2]>,
                       to: f64| {
                Node::Parallel(sides.map(|sides| Arc::new(turn(joints[sides], to, time))).collect())
            };
            series.push(all(&joints, &mut stroke.fold.iter(), stroke.angle));
            let [a, b] = stroke.make.map(port);
            series.push(action(Command::Dock { a, b }));
            series.push(action(Command::Undock { port: port(stroke.cut[0]) }));
            joints.insert(stroke.make, JointId((self.joined.flat.joints.len() + made) as u32));
            joints.remove(&stroke.cut);
            let ends = stroke.fold.iter().filter(|sides| **sides != stroke.cut);
            let opens = if stroke.fold.is_empty() { None } else { Some(&stroke.make) };
            series.push(all(&joints, &mut ends.chain(opens), 0.0));
        }
        // Folding.
        for faces in order {
            let moves = faces.iter().map(|&face| {
                let angle = to.angle(second, face);
                (angle != 0.0).then(|| Arc::new(turn(joints[&self.sides(face)], angle, step)))
            });
            series.push(Node::Parallel(moves.flatten().collect()));
        }
        let idle = |node: &Node| matches!(node, Node::Parallel(moves) if moves.is_empty());
        Arc::new(Node::Series(series.into_iter().filter(|node| !idle(node)).map(Arc::new).collect()))
    }

    /// Returns the sides of panels that the hinge between a face of the second shape and its parent joins.
    fn sides(&self, face: usize) -> [Side; 2] {
        let across = self.sheet.to.across(&self.task.problem.to, face);
        let [a, b] = [(across.parent, across.parent_side), (face, across.side)].map(|(face, side)| {
            let panel = self.sheet.becomes.iter().position(|f| *f == face).expect("every face is a panel");
            (panel, self.sheet.side(panel, side))
        });
        bond(a, b)
    }
}
