//! Rigidity of trusses of many nodes, by a banded QR decomposition of the rigidity matrix.
//!
//! Nodes are numbered in Cuthill-McKee order, so that the rows of the rigidity matrix keep to a band, and
//! Givens rotations make it triangular there. Unlike normal equations that does not square its condition, and the time
//! grows with the nodes times the square of the band's width.

use super::pinned_nodes::PinnedNodes;
use super::truss::{RigidityReport, TOLERANCES, orthonormal, rigid_motions};
use crate::geometry::Vec3;
use crate::interrupt;
use crate::optimize::cuthill_mckee;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// The greatest number of iterations for the least singular value.
const ITERATIONS_MAX: usize = 300;
/// Dimension of the subspace that is iterated towards the weakest directions.
const SUBSPACE: usize = 8;
/// The number of iterations in a row whose change must be within the tolerance for convergence.
const CONVERGED_TIMES: usize = 4;

/// Returns the rigidity of a truss with nodes at these positions (m) and struts between them (pairs of indices of
/// nodes), by a banded QR decomposition (Givens rotations) of its rigidity matrix; `None` where it is not rigid, or
/// so little that another method must decide.
pub(super) fn examine(nodes: &[Vec3], struts: &[(usize, usize)]) -> Option<RigidityReport> {
    let order = cuthill_mckee_order(nodes.len(), struts);
    let mut position = vec![0; nodes.len()];
    order.iter().enumerate().for_each(|(at, &node)| position[node] = at);
    let nodes: Vec<Vec3> = order.iter().map(|&node| nodes[node]).collect();
    let ends = |&(a, b): &(usize, usize)| (position[a].min(position[b]), position[a].max(position[b]));
    let struts: Vec<(usize, usize)> = struts.iter().map(ends).collect();
    let mean = struts.iter().map(|&(a, b)| (nodes[a] - nodes[b]).norm()).sum::<f64>() / struts.len() as f64;
    let rows: Vec<Row> =
        struts.iter().map(|&(a, b)| Row::strut(a, b, (nodes[a] - nodes[b]) / mean)).collect();
    let mut all = rows.clone();
    all.extend(pinning_rows(&nodes)?);
    all.sort_by_key(|row| row.first);
    let mut band = BandedQr::new(3 * nodes.len(), all.iter().map(Row::width).max()?);
    for row in &all {
        interrupt::checkpoint();
        band.insert(row);
    }
    if !band.is_full() {
        return None;
    }
    let whole = rigid_motions(&nodes);
    let weakest = least_singular_value(&band, &rows, &whole)?;
    if weakest <= TOLERANCES.clearly_rigid * largest_singular_value(&rows, 3 * nodes.len()) {
        return None;
    }
    // With as many struts as there are degrees of freedom, each is needed.
    let spare = struts.len() + whole.len() > 3 * nodes.len();
    let needed = |row: &Row| {
        interrupt::checkpoint();
        band.leverage(row) >= 1.0 - TOLERANCES.redundant
    };
    let redundant = if spare { (0..rows.len()).filter(|&s| !needed(&rows[s])).collect() } else { Vec::new() };
    Some(RigidityReport { weakest, redundant })
}

/// Returns the nodes in Cuthill-McKee order, breadth first from a node at an end of the truss.
fn cuthill_mckee_order(count: usize, struts: &[(usize, usize)]) -> Vec<usize> {
    let neighbours = cuthill_mckee::neighbours(count, struts.iter().copied());
    let from = |start: usize| {
        let mut order = Vec::with_capacity(count);
        cuthill_mckee::number_from(start, &neighbours, &mut vec![false; count], &mut order);
        order
    };
    // The last one reached from anywhere lies at an end.
    let end = from(0).last().copied().unwrap_or(0);
    let mut order = from(end);
    // Nodes that no struts connect with it come last.
    let reached: BTreeSet<usize> = order.iter().copied().collect();
    order.extend((0..count).filter(|node| !reached.contains(node)));
    order
}

/// Returns six rows, each at one of three nodes, that pin the truss so that it can't move as a rigid body; `None` where
/// all nodes lie on a line.
fn pinning_rows(nodes: &[Vec3]) -> Option<Vec<Row>> {
    let PinnedNodes { second, third, along, normal } = PinnedNodes::of(nodes)?;
    let aside = normal.cross(&along).normalize();
    let mut rows: Vec<Row> = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| Row::node(0, axis)).into();
    rows.extend([Row::node(second, normal), Row::node(second, aside), Row::node(third, normal)]);
    Some(rows)
}

/// A sparse row of the matrix, from column `first` on.
#[derive(Clone)]
struct Row {
    first: usize,
    entries: Vec<f64>,
}

impl Row {
    /// Returns the row that keeps a node from moving along d.
    fn node(node: usize, d: Vec3) -> Row {
        Row { first: 3 * node, entries: d.iter().copied().collect() }
    }

    /// Returns the row of the rigidity matrix of a strut from `a` to `b`, the later of the two, along d.
    fn strut(a: usize, b: usize, d: Vec3) -> Row {
        let mut entries = vec![0.0; 3 * (b - a) + 3];
        for k in 0..3 {
            entries[k] = d[k];
            entries[3 * (b - a) + k] = -d[k];
        }
        Row { first: 3 * a, entries }
    }

    fn width(&self) -> usize {
        self.entries.len()
    }

    /// Returns the two ends of the row, what lies between being zero.
    fn parts(&self) -> [(usize, &[f64]); 2] {
        let tail = self.entries.len() - 3;
        let second = if tail == 0 { &[][..] } else { &self.entries[tail..] };
        [(self.first, &self.entries[..3]), (self.first + tail, second)]
    }

    /// Returns the dot product with x.
    fn times(&self, x: &DVector<f64>) -> f64 {
        let part = |(at, part): (usize, &[f64])| part.iter().zip(at..).map(|(e, c)| e * x[c]).sum::<f64>();
        self.parts().map(part).iter().sum()
    }

    /// Adds the row times a factor to y.
    fn add_to(&self, factor: f64, y: &mut DVector<f64>) {
        for (at, part) in self.parts() {
            part.iter().zip(at..).for_each(|(e, c)| y[c] += factor * e);
        }
    }
}

/// The upper triangular factor R of the QR decomposition, within a narrow band, row by row from the diagonal on.
struct BandedQr {
    columns: usize,
    width: usize,
    rows: Vec<f64>,
    taken: Vec<bool>,
}

impl BandedQr {
    fn new(columns: usize, width: usize) -> BandedQr {
        BandedQr { columns, width, rows: vec![0.0; columns * width], taken: vec![false; columns] }
    }

    fn row(&self, at: usize) -> &[f64] {
        &self.rows[at * self.width..(at + 1) * self.width]
    }

    /// Returns true if R is regular.
    fn is_full(&self) -> bool {
        (0..self.columns).all(|at| self.taken[at] && self.row(at)[0] != 0.0)
    }

    /// Adds a row to the decomposed matrix, by Givens rotations with the rows that are there, until a row is
    /// free.
    fn insert(&mut self, row: &Row) {
        let mut entries = vec![0.0; self.width];
        entries[..row.entries.len()].copy_from_slice(&row.entries);
        for at in row.first..self.columns {
            let own = &mut self.rows[at * self.width..(at + 1) * self.width];
            if entries[0] != 0.0 && !self.taken[at] {
                own.copy_from_slice(&entries);
                self.taken[at] = true;
                return;
            }
            if entries[0] != 0.0 {
                let long = libm::hypot(own[0], entries[0]);
                let (cos, sin) = (own[0] / long, entries[0] / long);
                for (own, entry) in own.iter_mut().zip(&mut entries) {
                    (*own, *entry) = (cos * *own + sin * *entry, cos * *entry - sin * *own);
                }
            }
            entries.copy_within(1.., 0);
            entries[self.width - 1] = 0.0;
        }
    }

    /// Solves `Rᵀ y = b` in place, where `b` is zero before `first`.
    fn solve_transposed(&self, b: &mut DVector<f64>, first: usize) {
        for at in first..self.columns {
            let row = self.row(at);
            let y = b[at] / row[0];
            b[at] = y;
            let end = self.columns.min(at + self.width);
            for (column, entry) in (at + 1..end).zip(&row[1..]) {
                b[column] -= entry * y;
            }
        }
    }

    /// Solves `R x = y` in place.
    fn solve(&self, y: &mut DVector<f64>) {
        for at in (0..self.columns).rev() {
            let row = self.row(at);
            let end = self.columns.min(at + self.width);
            let behind: f64 = (at + 1..end).zip(&row[1..]).map(|(column, entry)| entry * y[column]).sum();
            y[at] = (y[at] - behind) / row[0];
        }
    }

    /// Returns the leverage of a row, the squared length of its projection onto the complement of the others, from 0
    /// to 1: 1 for a strut that is needed. The pinning rows span nothing that struts do, so they do not change it.
    fn leverage(&self, row: &Row) -> f64 {
        let mut b = DVector::zeros(self.columns);
        row.add_to(1.0, &mut b);
        self.solve_transposed(&mut b, row.first);
        b.norm_squared()
    }
}

/// Returns pseudo-random vectors to begin iterations with, the same everywhere.
fn starting_vectors(columns: usize, count: usize) -> Vec<DVector<f64>> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24) - 0.5
    };
    (0..count).map(|_| DVector::from_fn(columns, |_, _| next())).collect()
}

/// Returns the least singular value of the struts' rows but those of rigid motions, by inverse subspace iteration:
/// slender trusses bend in two planes almost alike. The inverse of the pinned matrix, between two projections, is the
/// pseudo-inverse of the free one.
fn least_singular_value(band: &BandedQr, rows: &[Row], whole: &[DVector<f64>]) -> Option<f64> {
    let mut space = starting_vectors(band.columns, SUBSPACE);
    converged(&mut || {
        let solved = space.drain(..).map(|mut x| {
            project_out(&mut x, whole);
            band.solve_transposed(&mut x, 0);
            band.solve(&mut x);
            project_out(&mut x, whole);
            x
        });
        space = orthonormal(solved.collect());
        let changes = DMatrix::from_fn(rows.len(), space.len(), |row, x| rows[row].times(&space[x]));
        let svd = changes.svd(false, true);
        // The directions themselves, the weakest among them, are where the iteration goes on.
        let turned = svd.v_t.as_ref().map(|v_t| {
            let mixed =
                |i: usize| space.iter().zip(v_t.row(i).iter()).map(|(x, c)| x * *c).sum::<DVector<f64>>();
            (0..v_t.nrows()).map(mixed).collect()
        });
        space = turned.unwrap_or_default();
        svd.singular_values.min()
    })
}

/// Projects x onto the complement of orthonormal vectors.
fn project_out(x: &mut DVector<f64>, basis: &[DVector<f64>]) {
    for b in basis {
        let along = b.dot(x);
        x.axpy(-along, b, 1.0);
    }
}

/// Returns the largest singular value, about, by power iteration.
fn largest_singular_value(rows: &[Row], columns: usize) -> f64 {
    let mut x = starting_vectors(columns, 1).remove(0).normalize();
    let mut value = 0.0;
    for _ in 0..50 {
        let mut y = DVector::zeros(columns);
        rows.iter().for_each(|row| row.add_to(row.times(&x), &mut y));
        value = y.norm().sqrt();
        x = y.normalize();
    }
    value
}

/// Returns the value to which an iteration converges; `None` where it does not within the limit, or is not finite.
fn converged(step: &mut dyn FnMut() -> f64) -> Option<f64> {
    let (mut before, mut times) = (f64::INFINITY, 0);
    for _ in 0..ITERATIONS_MAX {
        interrupt::checkpoint();
        let value = step();
        if !value.is_finite() {
            return None;
        }
        times = if (value - before).abs() <= value * TOLERANCES.converged { times + 1 } else { 0 };
        if times >= CONVERGED_TIMES {
            return Some(value);
        }
        before = value;
    }
    None
}
