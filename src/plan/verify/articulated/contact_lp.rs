//! The linear program (LP) of the least greatest load, kept sparse: the wrench that is passed on at every cut of the
//! tree is a variable of its own, so that a robot of hundreds of modules is no denser than a small one.

use super::contact_forces::{Column, ContactQuery};
use super::statics::{Load, LoadKind};
use crate::geometry::Vec3;
use crate::optimize::{LinearProgram, LinearSolution};
use nalgebra::Vector6;

const HALF_ROOT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The directions in which a moment is bounded; its true size is judged afterwards.
const DIRECTIONS: [[f64; 3]; 9] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [HALF_ROOT, HALF_ROOT, 0.0],
    [HALF_ROOT, -HALF_ROOT, 0.0],
    [HALF_ROOT, 0.0, HALF_ROOT],
    [HALF_ROOT, 0.0, -HALF_ROOT],
    [0.0, HALF_ROOT, HALF_ROOT],
    [0.0, HALF_ROOT, -HALF_ROOT],
];

/// The LP of the least greatest load. Forces are in fractions of the weight, moments in fractions of the weight times
/// a metre. Its variables are the sizes of the query's columns, then the wrench that each piece of the robot but the
/// first passes on to the one before (six components), then the greatest load as a fraction of its limit.
pub(super) struct ContactLp {
    /// The linear program as it is given to the solver.
    pub problem: LinearProgram,
    /// The rows of loads, which come first among the inequalities.
    rows: Vec<Row>,
}

/// A piece of the robot between cuts.
struct Node {
    /// The index of the piece before it in the tree; of the root's piece its own.
    parent: usize,
    /// The point about which its moments are taken, from the centre of mass in level axes, m.
    reference: Vec3,
    /// The wrench of the weight of its own links about the centre of mass.
    weight: Vector6<f64>,
}

/// A load in one direction: `Σ g·(force, moment beyond the cut) ≤ s`, by cut; the moment about the
/// centre of mass.
struct Row {
    /// The number of the first link beyond each cut, with g.
    terms: Vec<(usize, Vector6<f64>)>,
    /// The columns that load the hinge of a bond that closes a loop, each with its share of the limit.
    columns: Vec<(usize, f64)>,
    /// The share of the weights, as a fraction of the limit.
    constant: f64,
}

impl ContactLp {
    /// Builds the LP of a query. `columns`: the forces that may act, in the order of the LP's first variables.
    pub(super) fn new(query: &ContactQuery, columns: &[Column]) -> ContactLp {
        let (nodes, node_of) = nodes(query);
        let rows = rows(query, columns);
        let first = |node: usize| columns.len() + 6 * (node - 1);
        let last = columns.len() + 6 * (nodes.len() - 1);
        let mut problem = LinearProgram { costs: vec![0.0; last + 1], ..LinearProgram::default() };
        problem.costs[last] = 1.0;
        problem.equal = balances(query, columns, &nodes, &node_of);
        if query.fixed_base {
            // The holder of the root gives whatever force and moment it needs.
            problem.equal.drain(..6);
        }
        for row in &rows {
            let mut terms = vec![(last, -1.0)];
            for (link, g) in &row.terms {
                let node = node_of[*link];
                let local = about(g, &nodes[node].reference);
                terms.extend((0..6).filter(|&i| local[i] != 0.0).map(|i| (first(node) + i, local[i])));
            }
            terms.extend(&row.columns);
            problem.at_most.push((terms, 0.0));
        }
        let pushing = (0..columns.len()).filter(|&k| !columns[k].free);
        problem.at_most.extend(pushing.map(|k| (vec![(k, -1.0)], 0.0)));
        ContactLp { problem, rows }
    }

    /// Returns a lower bound on the greatest load, as a fraction of its limit, from the multipliers of a solution
    /// (Lagrangian dual bound), which need not be exact; minus infinity if they prove nothing. For any weights `z ≥
    /// 0` of the rows that sum to 1 and any `y`, `s ≥ Σ z row = Σ λ (z row + y balance) + z constant - y·weight`, and
    /// the sizes λ of the contacts' forces sum to 1, so that the least coefficient bounds the sum.
    pub(super) fn bound(&self, query: &ContactQuery, columns: &[Column], solution: &LinearSolution) -> f64 {
        let z: Vec<f64> = solution.z[..self.rows.len()].iter().map(|z| z.max(0.0)).collect();
        let total: f64 = z.iter().sum();
        if total <= 0.0 {
            return f64::NEG_INFINITY;
        }
        // The contribution of a unit force and moment on each link to the weighted rows.
        let model = query.model;
        let mut field = vec![Vector6::zeros(); model.bodies.len()];
        let mut constant = 0.0;
        let mut by_column = vec![0.0; columns.len()];
        for (row, z) in self.rows.iter().zip(&z) {
            constant += z / total * row.constant;
            row.columns.iter().for_each(|(column, share)| by_column[*column] += share * z / total);
            row.terms.iter().for_each(|(link, g)| field[*link] += g * (z / total));
        }
        for step in &model.kinematics.steps {
            let inherited = field[step.parent];
            field[step.link] += inherited;
        }
        let y = match query.fixed_base {
            true => Vector6::zeros(),
            false => Vector6::from_iterator((0..6).map(|i| solution.y[i] / total)),
        };
        // The first six equations are those of the root, about the centre of mass.
        let mut least = f64::INFINITY;
        for (column, of_hinge) in columns.iter().zip(by_column) {
            let own: f64 = column.wrenches.iter().map(|p| field[p.link].dot(&wrench(query, p))).sum();
            let coefficient = own + of_hinge + y.dot(&query.balance(column));
            if !column.free {
                least = least.min(coefficient);
            } else if coefficient.abs() > query.tolerances.balance {
                return f64::NEG_INFINITY;
            }
        }
        // If no contact pushes there is no sum of sizes to bound.
        if query.fixed_base { constant } else { constant - y[2] + least }
    }
}

/// Returns a wrench about the centre of mass, as fractions of the weight (and of the weight times a metre).
fn wrench(query: &ContactQuery, push: &super::statics::Wrench) -> Vector6<f64> {
    let (f, m) = (push.f / query.weight, (push.p.cross(&push.f) + push.m) / query.weight);
    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
}

/// Returns `g·(F, M about the origin)` as a functional of (F, M about `reference`).
fn about(g: &Vector6<f64>, reference: &Vec3) -> Vector6<f64> {
    let (force, moment) = (g.fixed_rows::<3>(0).into_owned(), g.fixed_rows::<3>(3).into_owned());
    let force = force + moment.cross(reference);
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Returns (F, M about the origin) taken about `reference`.
fn taken_about(w: &Vector6<f64>, reference: &Vec3) -> Vector6<f64> {
    let (f, m) = (w.fixed_rows::<3>(0).into_owned(), w.fixed_rows::<3>(3).into_owned());
    let m = m - reference.cross(&f);
    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
}

/// Returns the pieces of the tree between the cuts of the loads, the root's first, parents before children;
/// and the piece of every link.
fn nodes(query: &ContactQuery) -> (Vec<Node>, Vec<usize>) {
    let model = query.model;
    let mut cut = vec![false; model.bodies.len()];
    for &load in query.loads {
        for &(index, _) in &query.structure.loads[load].terms {
            cut[query.sections[index].link] = true;
        }
    }
    let mut node_of = vec![0; model.bodies.len()];
    let mut nodes = vec![Node { parent: 0, reference: Vec3::zeros(), weight: Vector6::zeros() }];
    let stance = query.stance;
    for step in &model.kinematics.steps {
        let parent = node_of[step.parent];
        node_of[step.link] = parent;
        if cut[step.link] {
            let reference = stance.R * (stance.posture.p[step.link] - stance.posture.centre);
            node_of[step.link] = nodes.len();
            nodes.push(Node { parent, reference, weight: Vector6::zeros() });
        }
    }
    for push in query.gravity_wrenches {
        nodes[node_of[push.link]].weight += wrench(query, push);
    }
    (nodes, node_of)
}

/// Returns the equations of balance. Each rigid piece passes on the wrench that it gets from its children, from the
/// ground and by its weight; the root has no parent to pass it on to. The root's equations come first.
fn balances(
    query: &ContactQuery,
    columns: &[Column],
    nodes: &[Node],
    node_of: &[usize],
) -> Vec<(Vec<(usize, f64)>, f64)> {
    let first = |node: usize| columns.len() + 6 * (node - 1);
    let mut equal: Vec<(Vec<(usize, f64)>, f64)> = Vec::with_capacity(6 * nodes.len());
    for node in nodes {
        equal.extend((0..6).map(|i| (Vec::new(), -taken_about(&node.weight, &node.reference)[i])));
    }
    for (k, column) in columns.iter().enumerate() {
        for push in &column.wrenches {
            let node = node_of[push.link];
            let local = taken_about(&wrench(query, push), &nodes[node].reference);
            (0..6).filter(|&i| local[i] != 0.0).for_each(|i| equal[6 * node + i].0.push((k, local[i])));
        }
    }
    for (index, node) in nodes.iter().enumerate().skip(1) {
        // To the parent, whose position is elsewhere: the force has a moment there.
        let arm = node.reference - nodes[node.parent].reference;
        for i in 0..6 {
            equal[6 * node.parent + i].0.push((first(index) + i, 1.0));
            equal[6 * index + i].0.push((first(index) + i, -1.0));
        }
        let cross =
            [(0, 1, -arm.z), (0, 2, arm.y), (1, 0, arm.z), (1, 2, -arm.x), (2, 0, -arm.y), (2, 1, arm.x)];
        for (row, column, value) in cross.into_iter().filter(|c| c.2 != 0.0) {
            equal[6 * node.parent + 3 + row].0.push((first(index) + column, value));
        }
    }
    equal
}

/// Returns the rows of every load, in both directions unless it is a pull, in fractions of its limit.
fn rows(query: &ContactQuery, columns: &[Column]) -> Vec<Row> {
    let mut rows = Vec::new();
    let first_of_loops = columns.len() - 6 * query.structure.closing.len();
    for &index in query.loads {
        let load = &query.structure.loads[index];
        for (terms, both) in parts(load) {
            for sign in if both { &[1.0, -1.0][..] } else { &[1.0] } {
                let term = |&(cut, factor): &(usize, f64)| {
                    let section = &query.sections[cut];
                    let scale = sign * factor * query.weight / load.limit;
                    let (f, m) = match section.moment {
                        true => (section.at.cross(&section.dir), section.dir),
                        false => (section.dir, Vec3::zeros()),
                    };
                    (section.link, Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) * scale)
                };
                let held = terms.iter().map(|&(cut, factor)| factor * query.weights[cut]);
                let constant = sign * held.sum::<f64>() / load.limit;
                let by_loop = query.in_loop(load, first_of_loops).into_iter();
                let columns = by_loop.map(|(column, share)| (column, sign * share)).collect();
                rows.push(Row { terms: terms.iter().map(term).collect(), columns, constant });
            }
        }
    }
    rows
}

/// Returns a load as linear parts: one, or for a moment its components in several directions.
fn parts(load: &Load) -> Vec<(Vec<(usize, f64)>, bool)> {
    match load.kind {
        LoadKind::Joint { .. } => vec![(load.terms.clone(), true)],
        LoadKind::Pull => vec![(load.terms.clone(), false)],
        LoadKind::Moment => DIRECTIONS
            .iter()
            .map(|d| (load.terms.iter().zip(d).map(|(&(cut, _), d)| (cut, *d)).collect(), true))
            .collect(),
    }
}
