//! One step: Algorithm 1 of the paper, mended. A quadratic programme gives the nodes' displacements;
//! whatever they would break is added as a row and it is solved again.
//!
//! The paper's rows ask that a value does not fall to first order. Lengths and distances curve, so a
//! value at its limit falls all the same, and the same row comes back for ever. Here rows ask for the
//! value itself, and each time that one comes back for more than it fell short.

use super::between;
use super::bound::Bound;
use super::nearby::Nearby;
use super::passing;
use super::stiffness::{self, Mode};
use super::structure::{ROUNDING, Structure};
use crate::geometry::Vec3;
use crate::interrupt;
use crate::optimize::{QuadraticProgram, Row, Unsolved};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// Programmes of one step.
const ROUNDS_MAX: usize = 40;
/// What a row asks for beyond what it fell short by.
const INSIST: f64 = 1.5;
/// Parts of the unit: how far inside its bound a value is asked to stay at first, how near to it it is
/// kept in mind for the next step, and how much nearer than the clearance of the plan distances may
/// come between the ends of steps (the structure's clearance has it on top).
const INSIDE: f64 = 1e-6;
const NEAR: f64 = 0.02;
pub const CUSHION: f64 = 2e-4;
/// How far, of the unit, a row of the programme may be off: less than it is asked to be inside.
const SOLVED: f64 = 1e-9;
/// A step that is shortened by more than this part is no reason to ask for more.
const PART_MIN: f64 = 0.02;
/// Singular values that are looked at: the least often come several together.
const MODES: usize = 4;
/// Struts whose angle has a smaller sine are nearly parallel.
const PARALLEL: f64 = 0.1;

/// `½ uᵀ H u + c·u + Σ |a·u|` over the displacements u, three for each node; of H what is on and above the
/// diagonal.
#[derive(Clone, Debug, Default)]
pub struct Objective {
    pub hessian: Vec<(usize, usize, f64)>,
    pub linear: Vec<f64>,
    pub sizes: Vec<Vec<(usize, f64)>>,
}

pub struct Task<'a> {
    pub truss: &'a Structure,
    pub x: &'a [Vec3],
    pub objective: &'a Objective,
    /// Nodes that stay where they are.
    pub held: &'a [usize],
    /// The displacement of the centre of mass along these axes, m.
    pub centre: &'a [(usize, f64)],
    pub ground: bool,
    /// The farthest that a node goes, m: a longer step is shortened as a whole.
    pub cap: f64,
}

/// Why there is no step: the bounds that were asked for when it was given up.
#[derive(Clone, Debug, PartialEq)]
pub enum Stuck {
    /// They contradict each other.
    Infeasible(Vec<Bound>),
    /// They come back again and again.
    Unsettled(Vec<Bound>),
}

/// What a step remembers of the one before.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// The bounds that were near.
    pub near: Vec<Bound>,
    pairs: Option<Nearby>,
}

/// Where the nodes are after the step. Every bound holds there and on the way.
pub fn step(task: &Task, memory: &mut Memory) -> Result<Vec<Vec3>, Stuck> {
    let Task { truss, .. } = *task;
    let columns = columns(task);
    let mut rows = Rows::new(task, &columns);
    for bound in &memory.near {
        rows.ask(*bound, 0.0);
    }
    for _ in 0..ROUNDS_MAX {
        interrupt::checkpoint();
        let (y, part) = match rows.programme.solve() {
            Ok(u) => moved(task, &columns, &u),
            Err(Unsolved::Infeasible | Unsolved::Unbounded) => return Err(Stuck::Infeasible(rows.asked())),
            Err(Unsolved::Numerical) => return Err(Stuck::Unsettled(rows.asked())),
        };
        let broken = broken(task, &y, &mut memory.pairs);
        if broken.is_empty() {
            let near = |bound: &Bound| {
                matches!(bound, Bound::Rigid(..)) || bound.value(truss, &y) < NEAR * truss.unit
            };
            memory.near = rows.asked().into_iter().filter(near).collect();
            memory.pairs.iter_mut().for_each(|pairs| pairs.moved(truss, &y));
            return Ok(y);
        }
        for (bound, lack) in broken {
            // Rows are of the whole step.
            let lack = lack / part.max(PART_MIN);
            rows.ask(bound, lack);
            rows.ask_beside(bound, lack);
        }
    }
    Err(Stuck::Unsettled(rows.asked()))
}

/// The programme of a step, and what each bound is asked for in it.
struct Rows<'a> {
    task: &'a Task<'a>,
    columns: &'a [Option<usize>],
    programme: QuadraticProgram,
    known: BTreeMap<Bound, Asked>,
    modes: OnceCell<Vec<Mode>>,
}

/// What a bound is asked for in a step, m.
struct Asked {
    /// The number of its row, if it has one.
    row: Option<usize>,
    /// What it is at the step's start.
    value: f64,
    wanted: f64,
}

impl<'a> Rows<'a> {
    fn new(task: &'a Task, columns: &'a [Option<usize>]) -> Rows<'a> {
        let Task { truss, objective, .. } = *task;
        let place = |entry: usize| columns[entry / 3].map(|column| column + entry % 3);
        let entry = |&(row, column, value): &(usize, usize, f64)| Some((place(row)?, place(column)?, value));
        let hessian = objective.hessian.iter().filter_map(entry).collect();
        let mut linear = vec![0.0; 3 * columns.iter().flatten().count()];
        for (at, value) in objective.linear.iter().enumerate() {
            if let Some(column) = place(at) {
                linear[column] = *value;
            }
        }
        // Each size is a variable of its own, above what it is the size of.
        let free = linear.len();
        linear.resize(free + objective.sizes.len(), 1.0);
        let mut programme = QuadraticProgram::new(hessian, linear, SOLVED * truss.unit);
        for (i, terms) in objective.sizes.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let signed = |&(at, value): &(usize, f64)| Some((place(at)?, sign * value));
                let terms = terms.iter().filter_map(signed).chain([(free + i, -1.0)]);
                programme.at_most((terms.collect(), 0.0));
            }
        }
        for &(axis, wanted) in task.centre {
            let shares = columns.iter().zip(&truss.shares);
            let terms = shares.filter_map(|(column, share)| Some((column.as_ref()? + axis, *share)));
            programme.equal((terms.collect(), wanted));
        }
        Rows { task, columns, programme, known: BTreeMap::new(), modes: OnceCell::new() }
    }

    /// Asks for a bound; if it was asked for before, for more than it fell short by.
    fn ask(&mut self, bound: Bound, lack: f64) {
        if let Some(asked) = self.known.get_mut(&bound) {
            asked.wanted += INSIST * lack;
            if let Some(row) = asked.row {
                self.programme.set(row, asked.value - asked.wanted);
            }
            return;
        }
        let (value, gradient) = self.slope(bound);
        let wanted = INSIDE * self.task.truss.unit;
        let terms = gradient.iter().filter_map(|(node, g)| Some((self.columns[*node]?, g)));
        let terms: Row = (
            terms.flat_map(|(column, g)| (0..3).map(move |k| (column + k, -g[k]))).collect(),
            value - wanted,
        );
        // Between nodes that stay nothing changes.
        let row = (!terms.0.is_empty()).then(|| self.programme.at_most(terms));
        self.known.insert(bound, Asked { row, value, wanted });
    }

    /// Of a bound at the step's start, the singular values found once.
    fn slope(&self, bound: Bound) -> (f64, Vec<(usize, Vec3)>) {
        let Task { truss, x, .. } = *self.task;
        let Bound::Rigid(i, j) = bound else { return (bound.value(truss, x), bound.gradient(truss, x)) };
        let modes = self.modes.get_or_init(|| stiffness::weakest(truss, x, MODES));
        let mode = stiffness::joined(modes, i, j);
        (mode.spare(truss), mode.gradient(truss, x))
    }

    /// Asks for what comes with a bound that was broken.
    fn ask_beside(&mut self, bound: Bound, lack: f64) {
        let Task { truss, x, .. } = *self.task;
        match bound {
            Bound::Apart(i, j) if parallel(truss, x, i, j) => {
                for end in [
                    Bound::EndApart(i, 0, j),
                    Bound::EndApart(i, 1, j),
                    Bound::EndApart(j, 0, i),
                    Bound::EndApart(j, 1, i),
                ] {
                    if end.value(truss, x) < NEAR * truss.unit {
                        self.ask(end, 0.0);
                    }
                }
            }
            Bound::Rigid(i, _) => {
                for j in (0..MODES).filter(|j| *j != i) {
                    self.ask(Bound::Rigid(i, j), lack);
                    self.ask(Bound::Rigid(j, i), lack);
                }
            }
            // Lengths are convex: what made this one longer than its row foresaw also keeps it from
            // getting as short as the other row fears.
            Bound::Longest(strut) if truss.limits.still.contains(&strut) => {
                self.ease(Bound::Shortest(strut), lack);
            }
            Bound::Most(index) => self.ease(Bound::Least(index), lack),
            _ => {}
        }
    }

    fn ease(&mut self, bound: Bound, lack: f64) {
        if !self.known.contains_key(&bound) {
            self.ask(bound, 0.0);
        }
        self.ask(bound, -lack);
    }

    fn asked(&self) -> Vec<Bound> {
        self.known.keys().copied().collect()
    }
}

fn parallel(truss: &Structure, x: &[Vec3], i: usize, j: usize) -> bool {
    let along = |strut: usize| {
        let (a, b) = truss.segment(x, strut);
        (b - a).normalize()
    };
    along(i).cross(&along(j)).norm() < PARALLEL
}

/// The first column of each node that may move.
fn columns(task: &Task) -> Vec<Option<usize>> {
    let mut next = 0;
    let mut column = |node: usize| {
        let free = !task.held.contains(&node);
        next += if free { 3 } else { 0 };
        free.then(|| next - 3)
    };
    (0..task.truss.nodes).map(&mut column).collect()
}

/// Where the nodes get to, and by what part the step was shortened for it.
fn moved(task: &Task, columns: &[Option<usize>], u: &[f64]) -> (Vec<Vec3>, f64) {
    let displacement =
        |column: &Option<usize>| column.map_or_else(Vec3::zeros, |c| Vec3::new(u[c], u[c + 1], u[c + 2]));
    let farthest = columns.iter().map(|c| displacement(c).norm()).fold(0.0, f64::max);
    let part = (task.cap / farthest.max(f64::MIN_POSITIVE)).min(1.0);
    (task.x.iter().zip(columns).map(|(p, column)| p + displacement(column) * part).collect(), part)
}

/// Bounds that do not hold at y or on the way there, with by how much, m.
fn broken(task: &Task, y: &[Vec3], pairs: &mut Option<Nearby>) -> Vec<(Bound, f64)> {
    let Task { truss, x, .. } = *task;
    let cushion = CUSHION * truss.unit;
    let pairs = Nearby::candidates(pairs, truss, (x, y), cushion);
    let lengths = (0..truss.struts.len()).flat_map(|strut| [Bound::Shortest(strut), Bound::Longest(strut)]);
    let apart = pairs.iter().map(|&(i, j)| Bound::Apart(i, j));
    let above = (0..truss.nodes).filter(|_| task.ground).map(Bound::Above);
    let angles = truss.corners.iter().map(|&(i, j)| Bound::Angle(i, j));
    let sums = (0..truss.limits.loops.len()).flat_map(|index| [Bound::Least(index), Bound::Most(index)]);
    let mut broken: BTreeMap<Bound, f64> = BTreeMap::new();
    let mut look = |bound: Bound, value: f64| {
        if value < -ROUNDING * truss.unit {
            broken.insert(bound, -value);
        }
    };
    for bound in lengths.chain(apart).chain(above).chain(angles).chain(sums) {
        look(bound, bound.value(truss, y));
    }
    if truss.limits.rigidity > 0.0 {
        for (i, mode) in stiffness::weakest(truss, y, MODES).iter().enumerate() {
            look(Bound::Rigid(i, i), mode.spare(truss));
        }
    }
    let on_the_way = between::shortfalls(truss, x, y, &pairs, cushion);
    let passed = passing::obstacles(truss, x, y, cushion);
    // Of a step far away, before its rows are known, the ground takes long to say more.
    let below = if task.ground && broken.is_empty() { passing::ground(truss, x, y) } else { Vec::new() };
    for (bound, lack) in on_the_way.into_iter().chain(passed).chain(below) {
        broken.entry(bound).and_modify(|known| *known = known.max(lack)).or_insert(lack);
    }
    broken.into_iter().collect()
}
