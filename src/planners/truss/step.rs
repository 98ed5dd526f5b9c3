//! One step of sequential quadratic programming (SQP): Algorithm 1 of the paper, mended. A quadratic program
//! over linearised constraints (rows of the constraint Jacobian) gives the displacements of the nodes;
//! whatever constraint they would violate is added as a row, and it is solved again (an active set grown by
//! violation).
//!
//! The rows of the paper ask that a value does not fall to first order. Lengths and distances curve, so a
//! value at its limit falls all the same, and the same row comes back for ever (livelock). Here rows ask for
//! the value itself, and each time that one comes back for more than it fell short, by a multiple that grows.

use super::broad_phase::NeighbourList;
use super::constraint::Constraint;
use super::forces;
use super::motion::{Findings, TimeLaw};
use super::rigidity::{self, MODES, Mode};
use super::structure::Structure;
use super::support_polygon;
use super::threads;
use super::tolerances::Tolerances;
use super::violations::{Search, violated};
use crate::geometry::Vec3;
use crate::interrupt;
use crate::optimize::{QuadraticProgram, Row, Side, Unsolved};
use crate::robot::truss_statics::{Forces, ForcesError};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::mem;

/// The greatest number of quadratic programs solved for one step: few steps are found after more.
const ROUNDS_MAX: usize = 20;
/// The same for thorough steps.
const ROUNDS_THOROUGH: usize = 40;
/// The displacement of a node in a step, units, beyond which linearised constraints tell too little: a program that asks for more
/// gives no step, and an easier one is tried; but for thorough steps.
const LINEAR_RANGE: f64 = 0.3;
/// The part of what rows of one step asked of singular values, beside their limit, that those of the next step ask at
/// once: curvature changes little from step to step.
const CURVATURE_KEPT: f64 = 0.8;
/// The multiple of what a value fell short of the linear one in one step that its row asks for at once in the next.
const CURVATURE_GAIN: f64 = 1.25;

/// The cost `½ uᵀ H u + c·u + Σ |a·u|` over the displacements u of the nodes (m), of which node k has the coordinates
/// 3k to 3k + 2. Costs have no unit of their own: only their ratios count.
#[derive(Clone, Debug, Default)]
pub struct QuadraticCost {
    /// The matrix H as (row, column, value), on and above the diagonal only; repeated entries add up. It must be
    /// positive semidefinite.
    pub hessian: Vec<(usize, usize, f64)>,
    /// The vector c, one entry for each coordinate, three for each node.
    pub linear: Vec<f64>,
    /// The vectors a, each as (coordinate, value) for the entries that are not 0, whose products with u count by their
    /// absolute values.
    pub absolutes: Vec<Vec<(usize, f64)>>,
}

/// The problem of one step: the cost to minimise by displacing the nodes, under the constraints of a truss.
pub struct StepProblem<'a> {
    /// The truss with its limits and surroundings.
    pub truss: &'a Structure,
    /// The positions of the nodes at the start of the step, by index, in the world's frame, m.
    pub x: &'a [Vec3],
    /// The cost of displacements that the step minimises.
    pub cost: &'a QuadraticCost,
    /// The indices of the nodes that keep their positions.
    pub pinned: &'a [usize],
    /// The displacement that the centre of mass makes in the step, m, as (axis of the world, 0 to 2 for x, y, z;
    /// displacement); along other axes it is free.
    pub centre_of_mass: &'a [(usize, f64)],
    /// True if nodes, and struts over uneven ground, must not get below the ground.
    pub ground: bool,
    /// The greatest displacement of a node, m: a longer step is shortened as a whole; infinite for no limit.
    pub displacement_max: f64,
    /// True if the search for the step goes on where it seldom comes to an end: after more quadratic programs, and beyond what
    /// linearised constraints tell.
    pub thorough: bool,
}

/// The reason why there is no step, with the constraints that had rows in the last quadratic program.
#[derive(Clone, Debug, PartialEq)]
pub enum StepError {
    /// The rows of the quadratic program contradict each other; the constraints are those that had rows.
    Infeasible(Vec<Constraint>),
    /// The rows did not settle within the rounds allowed, or the solver failed numerically; the constraints are those
    /// that had rows.
    NotConverged(Vec<Constraint>),
}

impl StepError {
    /// Returns the constraints that had rows in the last quadratic program.
    pub fn constraints(&self) -> &[Constraint] {
        let (StepError::Infeasible(constraints) | StepError::NotConverged(constraints)) = self;
        constraints
    }
}

/// The data that one step hands on to the next step of the same truss, so that it needs fewer rounds. The first step
/// begins with the default.
#[derive(Clone, Debug, Default)]
pub struct WarmStart {
    /// The constraints that were nearly active at the end of the last step, each with the amount by which its value curved below the
    /// linear one, m.
    pub active: Vec<(Constraint, f64)>,
    /// The pairs of struts that may come near; `None` before the first step.
    neighbours: Option<NeighbourList>,
    /// The least singular values of the rigidity matrix known last, and a bound on the least of them.
    rigidity: rigidity::Known,
    /// The value that rows of the last step asked of singular values for their curvature, m.
    curvature: f64,
    /// The forces of struts known last.
    forces: forces::Known,
    /// The sides of the absolute values of the cost.
    sides: Vec<Side>,
}

impl WarmStart {
    /// Returns a copy without the list of neighbours and the decomposition for rigidity, which are large, and which the next step
    /// makes again.
    pub fn light_copy(&mut self) -> WarmStart {
        let neighbours = self.neighbours.take();
        let mut copy = self.clone();
        copy.rigidity.forget_decomposition();
        self.neighbours = neighbours;
        copy
    }

    /// Returns the findings of the search for a step from `x` to `y` (m), which is made and timed by a law.
    pub fn findings(&mut self, truss: &Structure, x: &[Vec3], y: &[Vec3], law: &TimeLaw) -> Findings {
        let WarmStart { forces, rigidity, neighbours, .. } = self;
        let mut bear = || match law.accelerations(truss, x, y) {
            Some([start, end]) => forces.bear(truss, (x, y), [&start, &end]),
            None => [false, false],
        };
        let mut distance = || Some(NeighbourList::least_distance(neighbours, truss, y));
        let mut least = || if truss.limits.rigidity > 0.0 { rigidity.least(truss, y) } else { None };
        // Alone the search for the least value has the second thread for itself.
        let (([rises, brakes], distance), least) = match truss.limits.forces {
            Some(_) => threads::both(truss, || (bear(), distance()), least),
            None => ((bear(), distance()), least()),
        };
        Findings { rises, brakes, least, distance }
    }
}

/// Returns the positions of the nodes after one step, m, by sequential quadratic programming (Algorithm 1 of
/// [Usevitch et al.](super), mended). Every constraint holds there up to the tolerance `rounding`, and all but the
/// rigidity hold while the nodes move there linearly, clearances and angles up to the tolerance `clearance_margin`
/// ([`Structure::tightened`] makes up for it). `problem`: the truss, its positions and the cost.
///
/// # Errors
/// [`StepError`] if no step is found; the active constraints of `warm_start` then stay as they were.
pub fn step(problem: &StepProblem, warm_start: &mut WarmStart) -> Result<Vec<Vec3>, StepError> {
    let columns = columns(problem);
    let search =
        Search { rigidity: mem::take(&mut warm_start.rigidity), forces: mem::take(&mut warm_start.forces) };
    let search = RefCell::new(search);
    let forces = OnceCell::new();
    let cost = with_forces(problem, &search, &forces);
    let problem = &StepProblem { cost: cost.as_ref().unwrap_or(problem.cost), ..*problem };
    let mut rows = Rows::new(problem, &columns, search);
    rows.forces = forces;
    rows.curvature = CURVATURE_KEPT * warm_start.curvature;
    let found = stepped(problem, &columns, &mut rows, warm_start);
    let search = rows.search.into_inner();
    (warm_start.rigidity, warm_start.forces) = (search.rigidity, search.forces);
    found
}

/// Solves the quadratic program of a step until its solution violates nothing.
fn stepped(
    problem: &StepProblem,
    columns: &[Option<usize>],
    rows: &mut Rows,
    warm_start: &mut WarmStart,
) -> Result<Vec<Vec3>, StepError> {
    let StepProblem { truss, .. } = *problem;
    let tolerances = &truss.tolerances;
    // Start where the last step ended, with rows for the constraints that were nearly active there.
    rows.program.begin(&warm_start.sides);
    for (constraint, curvature) in &warm_start.active {
        rows.begin(*constraint, *curvature);
    }
    let (rounds, range) =
        if problem.thorough { (ROUNDS_THOROUGH, f64::INFINITY) } else { (ROUNDS_MAX, LINEAR_RANGE) };
    for _ in 0..rounds {
        interrupt::checkpoint();
        // Solve the quadratic program over the rows so far.
        let (y, fraction, farthest) = match rows.program.solve() {
            Ok(u) => displaced(problem, columns, &u),
            Err(Unsolved::Infeasible) if rows.forget_curvature() => continue,
            Err(Unsolved::Infeasible | Unsolved::Unbounded) => {
                return Err(StepError::Infeasible(rows.constraints()));
            }
            Err(Unsolved::Numerical) => return Err(StepError::NotConverged(rows.constraints())),
        };
        if farthest > range * truss.unit {
            return Err(StepError::NotConverged(rows.constraints()));
        }
        // Check all constraints at the end of the step and during it.
        let violated = violated(problem, &y, &mut warm_start.neighbours, &rows.search);
        if violated.is_empty() {
            let near = |(constraint, asked): (&Constraint, &Asked)| match constraint {
                // The value at the start tells enough, and costs nothing.
                Constraint::Rigidity(..) => {
                    let near = asked.value < rigidity::NEAR * truss.limits.rigidity * truss.unit;
                    near.then_some((*constraint, 0.0))
                }
                Constraint::Force => (asked.value < forces::NEAR * truss.unit).then_some((*constraint, 0.0)),
                _ => {
                    let value = constraint.value(truss, &y);
                    let curvature = asked.curvature(value, fraction.max(tolerances.step_fraction_min));
                    (value < tolerances.active_band * truss.unit).then_some((*constraint, curvature))
                }
            };
            warm_start.active = rows.known.iter().filter_map(near).collect();
            warm_start.curvature = rows.asked_of_modes();
            warm_start.sides = rows.program.sides();
            warm_start.neighbours.iter_mut().for_each(|list| list.moved(truss, &y));
            return Ok(y);
        }
        // Add rows for the violated constraints, or ask more of the rows they have. Rows are about the
        // whole step, so the shortfall of a shortened one is scaled up.
        for (constraint, shortfall) in violated {
            let shortfall = shortfall / fraction.max(tolerances.step_fraction_min);
            rows.add(constraint, shortfall);
            rows.add_related(constraint, shortfall);
        }
    }
    Err(StepError::NotConverged(rows.constraints()))
}

/// The quadratic program of a step, with the value that its row asks of each constraint.
struct Rows<'a> {
    problem: &'a StepProblem<'a>,
    columns: &'a [Option<usize>],
    program: QuadraticProgram,
    known: BTreeMap<Constraint, Asked>,
    modes: OnceCell<Vec<Mode>>,
    forces: OnceCell<Result<Forces, ForcesError>>,
    /// The value that rows of singular values ask for at first, m.
    curvature: f64,
    search: RefCell<Search>,
}

/// A constraint in the program; values in m.
struct Asked {
    /// The index of its row; `None` if no free node changes it.
    row: Option<usize>,
    /// The value at the start of the step.
    value: f64,
    /// The value wanted at its end.
    wanted: f64,
    /// The part of it that is wanted because of curvature in the step before.
    remembered: f64,
    /// The multiple of its shortfall that it is asked for when it comes back.
    gain: f64,
}

impl Asked {
    /// Returns by how much the value at the end of a step is less than the linear one of a row that is tight, scaled from a fraction of
    /// the step to the whole, m; 0 if it is not.
    fn curvature(&self, end: f64, fraction: f64) -> f64 {
        let linear = self.value + fraction * (self.wanted - self.value);
        ((linear - end) / fraction).max(0.0)
    }

    /// Raises the value that is wanted, m, in the row of a program as well.
    fn raise(&mut self, more: f64, program: &mut QuadraticProgram) {
        self.wanted += more;
        if let Some(row) = self.row {
            program.set(row, self.value - self.wanted);
        }
    }
}

impl<'a> Rows<'a> {
    /// Makes the program of cost and centre of mass, without rows for constraints.
    fn new(problem: &'a StepProblem, columns: &'a [Option<usize>], search: RefCell<Search>) -> Rows<'a> {
        let StepProblem { truss, cost, .. } = *problem;
        // The cost over the coordinates of free nodes.
        let index = |entry: usize| columns[entry / 3].map(|column| column + entry % 3);
        let entry = |&(row, column, value): &(usize, usize, f64)| Some((index(row)?, index(column)?, value));
        // The room is reserved at once, because a filter tells no length: a large vector that grows is moved again and
        // again.
        let mut hessian = Vec::with_capacity(cost.hessian.len());
        hessian.extend(cost.hessian.iter().filter_map(entry));
        let mut linear = vec![0.0; 3 * columns.iter().flatten().count()];
        for (at, value) in cost.linear.iter().enumerate() {
            if let Some(column) = index(at) {
                linear[column] = *value;
            }
        }
        let tolerance = truss.tolerances.qp_residual * truss.unit;
        let order: Vec<usize> =
            truss.layout.order().iter().filter_map(|node| Some(columns[*node]? / 3)).collect();
        let mut program = QuadraticProgram::in_blocks(hessian, linear, tolerance, (3, Some(&order)));
        for terms in &cost.absolutes {
            let terms = terms.iter().filter_map(|&(at, value)| Some((index(at)?, value)));
            program.absolute((terms.collect(), 0.0));
        }
        // The displacement of the centre of mass is the mass-weighted mean of the nodes'.
        for &(axis, wanted) in problem.centre_of_mass {
            let fractions = columns.iter().zip(&truss.mass_fractions);
            let terms = fractions.filter_map(|(column, part)| Some((column.as_ref()? + axis, *part)));
            program.equal((terms.collect(), wanted));
        }
        Rows {
            problem,
            columns,
            program,
            known: BTreeMap::new(),
            modes: OnceCell::new(),
            forces: OnceCell::new(),
            curvature: 0.0,
            search,
        }
    }

    /// Adds a row for a constraint; if there is one, asks it for more than the shortfall, m, by a multiple that grows each time: what
    /// one row asks for is taken from another, so that a fixed multiple may need any number of rounds.
    fn add(&mut self, constraint: Constraint, shortfall: f64) {
        let Tolerances { row_gain, row_gain_max, .. } = self.problem.truss.tolerances;
        if let Some(asked) = self.known.get_mut(&constraint) {
            asked.raise(asked.gain * shortfall, &mut self.program);
            if shortfall > 0.0 {
                asked.gain = (asked.gain * row_gain).min(row_gain_max);
            }
        } else {
            self.begin(constraint, 0.0);
        }
    }

    /// Adds a row for a constraint that has none, whose value fell short of the linear one by `curvature` (m) in the step before.
    fn begin(&mut self, constraint: Constraint, curvature: f64) {
        let truss = self.problem.truss;
        let (value, gradient) = self.linearised(constraint);
        let inset = truss.tolerances.bound_inset * truss.unit;
        let remembered = match constraint {
            // Lengths that are nearly fixed leave no room.
            Constraint::LengthMin(strut) | Constraint::LengthMax(strut)
                if truss.limits.locked.contains(&strut) =>
            {
                0.0
            }
            Constraint::LoopMin(_) | Constraint::LoopMax(_) => 0.0,
            _ => (CURVATURE_GAIN * curvature).min(truss.tolerances.curvature_max * truss.unit),
        };
        let of_modes = matches!(constraint, Constraint::Rigidity(..));
        let wanted = remembered + if of_modes { inset.max(self.curvature) } else { inset };
        let terms = gradient.iter().filter_map(|(node, g)| Some((self.columns[*node]?, g)));
        let terms: Row = (
            terms.flat_map(|(column, g)| (0..3).map(move |k| (column + k, -g[k]))).collect(),
            value - wanted,
        );
        // Between pinned nodes nothing changes.
        let row = (!terms.0.is_empty()).then(|| self.program.at_most(terms));
        let gain = truss.tolerances.row_gain;
        self.known.insert(constraint, Asked { row, value, wanted, remembered, gain });
    }

    /// Makes rows ask for no more than without the step before; returns true if any did.
    fn forget_curvature(&mut self) -> bool {
        let mut any = false;
        for asked in self.known.values_mut().filter(|asked| asked.remembered > 0.0) {
            let remembered = mem::take(&mut asked.remembered);
            asked.raise(-remembered, &mut self.program);
            any |= asked.row.is_some();
        }
        any
    }

    /// Returns value and gradient of a constraint at the start of the step; singular values are found once.
    fn linearised(&self, constraint: Constraint) -> (f64, Vec<(usize, Vec3)>) {
        let StepProblem { truss, x, .. } = *self.problem;
        match constraint {
            Constraint::Rigidity(i, j) => {
                let modes = self.modes.get_or_init(|| self.search.borrow_mut().rigidity.weakest(truss, x));
                let mode = rigidity::joined(modes, i, j);
                (mode.spare(truss), mode.gradient(truss, x))
            }
            Constraint::Force => {
                let found = self.forces.get_or_init(|| begun(self.problem, &self.search));
                let gradient = found.iter().flat_map(|found| forces::gradient(truss, x, found));
                (forces::spare(truss, found), gradient.collect())
            }
            _ => (constraint.value(truss, x), constraint.gradient(truss, x)),
        }
    }

    /// Adds the rows that a violated constraint brings with it, where its gradient alone misleads.
    fn add_related(&mut self, constraint: Constraint, shortfall: f64) {
        let StepProblem { truss, x, .. } = *self.problem;
        match constraint {
            Constraint::Clearance(i, j) if nearly_parallel(truss, x, i, j) => {
                for end in [
                    Constraint::EndClearance(i, 0, j),
                    Constraint::EndClearance(i, 1, j),
                    Constraint::EndClearance(j, 0, i),
                    Constraint::EndClearance(j, 1, i),
                ] {
                    if end.value(truss, x) < truss.tolerances.active_band * truss.unit {
                        self.add(end, 0.0);
                    }
                }
            }
            Constraint::Rigidity(i, _) => {
                for j in (0..MODES).filter(|j| *j != i) {
                    self.add(Constraint::Rigidity(i, j), shortfall);
                    self.add(Constraint::Rigidity(j, i), shortfall);
                }
            }
            // Lengths are convex: what made this one longer than its row predicted also keeps it from getting
            // as short as the other row's bound allows.
            Constraint::LengthMax(strut) if truss.limits.locked.contains(&strut) => {
                self.loosen(Constraint::LengthMin(strut), shortfall);
            }
            Constraint::LoopMax(index) => self.loosen(Constraint::LoopMin(index), shortfall),
            _ => {}
        }
    }

    /// Lowers the value that the row of a constraint asks for.
    fn loosen(&mut self, constraint: Constraint, by: f64) {
        if !self.known.contains_key(&constraint) {
            self.begin(constraint, 0.0);
        }
        let gain = self.problem.truss.tolerances.row_gain;
        if let Some(asked) = self.known.get_mut(&constraint) {
            asked.raise(-gain * by, &mut self.program);
        }
    }

    /// Returns the greatest value that a row asks of singular values, m; 0 without such rows.
    fn asked_of_modes(&self) -> f64 {
        let of_modes =
            self.known.iter().filter(|(constraint, _)| matches!(constraint, Constraint::Rigidity(..)));
        of_modes.map(|(_, asked)| asked.wanted).fold(0.0, f64::max)
    }

    /// Returns the constraints that have rows.
    fn constraints(&self) -> Vec<Constraint> {
        self.known.keys().copied().collect()
    }
}

/// Returns the cost of a step with motion beside it that makes the greatest force of a strut less; `None` if forces are
/// not limited, or none hold the truss. `forces`: those at the start, which become known.
fn with_forces(
    problem: &StepProblem,
    search: &RefCell<Search>,
    forces: &OnceCell<Result<Forces, ForcesError>>,
) -> Option<QuadraticCost> {
    let StepProblem { truss, x, cost, ground, .. } = *problem;
    if truss.limits.forces.is_none() || !ground {
        return None;
    }
    let found = forces.get_or_init(|| begun(problem, search)).as_ref().ok()?;
    let descent = forces::descent(truss, x, found, problem.pinned)?;
    let mut cost = cost.clone();
    for (node, g) in descent.iter().enumerate() {
        (0..3).for_each(|k| cost.linear[3 * node + k] += g[k]);
    }
    Some(cost)
}

/// Returns the forces at the start of a step.
fn begun(problem: &StepProblem, search: &RefCell<Search>) -> Result<Forces, ForcesError> {
    let StepProblem { truss, x, .. } = *problem;
    search.borrow_mut().forces.at(truss, x, &support_polygon::contacts(truss, x))
}

/// Returns true if the angle between two struts is so small that their closest points jump from end to end.
fn nearly_parallel(truss: &Structure, x: &[Vec3], i: usize, j: usize) -> bool {
    let along = |strut: usize| {
        let (a, b) = truss.segment(x, strut);
        (b - a).normalize()
    };
    along(i).cross(&along(j)).norm() < truss.tolerances.parallel_sine
}

/// Returns the first column of each node in the program; `None` for pinned nodes.
fn columns(problem: &StepProblem) -> Vec<Option<usize>> {
    let mut next = 0;
    let mut column = |node: usize| {
        let free = !problem.pinned.contains(&node);
        next += if free { 3 } else { 0 };
        free.then(|| next - 3)
    };
    (0..problem.truss.nodes).map(&mut column).collect()
}

/// Returns the positions after displacement by u, m, the fraction to which the step was shortened, and the greatest displacement
/// of a node, m.
fn displaced(problem: &StepProblem, columns: &[Option<usize>], u: &[f64]) -> (Vec<Vec3>, f64, f64) {
    let displacement =
        |column: &Option<usize>| column.map_or_else(Vec3::zeros, |c| Vec3::new(u[c], u[c + 1], u[c + 2]));
    let farthest = columns.iter().map(|c| displacement(c).norm()).fold(0.0, f64::max);
    let fraction = (problem.displacement_max / farthest.max(f64::MIN_POSITIVE)).min(1.0);
    let moved = problem.x.iter().zip(columns).map(|(p, column)| p + displacement(column) * fraction);
    (moved.collect(), fraction, farthest * fraction)
}
