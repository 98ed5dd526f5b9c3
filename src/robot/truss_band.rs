//! Rigidity of trusses of many nodes. Nodes that struts join are numbered near to each other, so that
//! the rows of the rigidity matrix keep to a band; rotations make it triangular there. Its condition is
//! not squared, and the time grows with the nodes times the square of the band's width.

use super::truss::{motions_of_the_whole, orthonormal};
use crate::geometry::Vec3;
use crate::interrupt;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// A truss whose weakest singular value is less than this part of the largest is not told apart from
/// one that gives way: the square root of what counts as zero would be 3e-5, and rounding is 1e-16.
const CLEAR: f64 = 1e-7;
/// A strut carries a self-stress if this much of its row lies in the span of the others.
const REDUNDANT: f64 = 1e-9;
/// Steps of the iterations for the least and the largest singular value.
const STEPS_MAX: usize = 300;
/// How many directions are followed towards the weakest at once.
const SPACE: usize = 8;
/// An iteration ends when its value changes by less than this part.
const SETTLED: f64 = 1e-11;
/// How often in a row it must.
const SETTLED_TIMES: usize = 4;
/// Nodes nearer to a line than this part of its length lie on it.
const ON_LINE: f64 = 1e-6;

pub(super) struct Facts {
    /// The least singular value that belongs to no motion of the whole, for struts of mean length 1.
    pub weakest: f64,
    pub redundant: Vec<usize>,
}

/// Facts about a truss that is clearly rigid; `None`: it is not, or not clearly.
pub(super) fn facts(nodes: &[Vec3], struts: &[(usize, usize)]) -> Option<Facts> {
    let order = order(nodes.len(), struts);
    let mut place = vec![0; nodes.len()];
    order.iter().enumerate().for_each(|(at, &node)| place[node] = at);
    let nodes: Vec<Vec3> = order.iter().map(|&node| nodes[node]).collect();
    let ends = |&(a, b): &(usize, usize)| (place[a].min(place[b]), place[a].max(place[b]));
    let struts: Vec<(usize, usize)> = struts.iter().map(ends).collect();
    let mean = struts.iter().map(|&(a, b)| (nodes[a] - nodes[b]).norm()).sum::<f64>() / struts.len() as f64;
    let rows: Vec<Row> =
        struts.iter().map(|&(a, b)| Row::strut(a, b, (nodes[a] - nodes[b]) / mean)).collect();
    let mut all = rows.clone();
    all.extend(held(&nodes)?);
    all.sort_by_key(|row| row.first);
    let mut band = Band::new(3 * nodes.len(), all.iter().map(Row::width).max()?);
    for row in &all {
        interrupt::checkpoint();
        band.insert(row);
    }
    if !band.is_full() {
        return None;
    }
    let whole = motions_of_the_whole(&nodes);
    let weakest = least(&band, &rows, &whole)?;
    if weakest <= CLEAR * largest(&rows, 3 * nodes.len()) {
        return None;
    }
    // With as many struts as there are ways to move, each is needed.
    let spare = struts.len() + whole.len() > 3 * nodes.len();
    let needed = |row: &Row| {
        interrupt::checkpoint();
        band.share(row) >= 1.0 - REDUNDANT
    };
    let redundant = if spare { (0..rows.len()).filter(|&s| !needed(&rows[s])).collect() } else { Vec::new() };
    Some(Facts { weakest, redundant })
}

/// Nodes so that those that struts join come near each other (Cuthill and McKee).
fn order(count: usize, struts: &[(usize, usize)]) -> Vec<usize> {
    let mut beside = vec![BTreeSet::new(); count];
    for &(a, b) in struts {
        beside[a].insert(b);
        beside[b].insert(a);
    }
    let from = |start: usize| {
        let mut order = vec![start];
        let mut known = vec![false; count];
        known[start] = true;
        let mut at = 0;
        while let Some(&node) = order.get(at) {
            let mut next: Vec<usize> = beside[node].iter().copied().filter(|&n| !known[n]).collect();
            next.sort_by_key(|&n| (beside[n].len(), n));
            next.iter().for_each(|&n| known[n] = true);
            order.extend(next);
            at += 1;
        }
        order
    };
    // The last one reached from anywhere lies at an end.
    let end = from(0).last().copied().unwrap_or(0);
    let mut order = from(end);
    // What hangs together with nothing of it comes behind.
    let reached: BTreeSet<usize> = order.iter().copied().collect();
    order.extend((0..count).filter(|node| !reached.contains(node)));
    order
}

/// Rows that hold three nodes so that the whole can't move, each at one node; `None` where all nodes
/// lie on a line.
fn held(nodes: &[Vec3]) -> Option<Vec<Row>> {
    let far = |weigh: &dyn Fn(&Vec3) -> f64| {
        (0..nodes.len()).max_by(|&i, &j| weigh(&nodes[i]).total_cmp(&weigh(&nodes[j])))
    };
    let first = *nodes.first()?;
    let b = far(&|p| (p - first).norm())?;
    let along = nodes[b] - first;
    let c = far(&|p| along.cross(&(p - first)).norm())?;
    let normal = along.cross(&(nodes[c] - first));
    if normal.norm() <= along.norm_squared() * ON_LINE {
        return None;
    }
    let normal = normal.normalize();
    let aside = normal.cross(&along).normalize();
    let mut rows: Vec<Row> = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| Row::node(0, axis)).into();
    rows.extend([Row::node(b, normal), Row::node(b, aside), Row::node(c, normal)]);
    Some(rows)
}

/// A row of few entries, from column `first` on.
#[derive(Clone)]
struct Row {
    first: usize,
    entries: Vec<f64>,
}

impl Row {
    fn node(node: usize, d: Vec3) -> Row {
        Row { first: 3 * node, entries: d.iter().copied().collect() }
    }

    /// Of a strut from `a` to `b`, the later of the two.
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

    /// The two ends of the row: what lies between is zero.
    fn parts(&self) -> [(usize, &[f64]); 2] {
        let tail = self.entries.len() - 3;
        let second = if tail == 0 { &[][..] } else { &self.entries[tail..] };
        [(self.first, &self.entries[..3]), (self.first + tail, second)]
    }

    fn times(&self, x: &DVector<f64>) -> f64 {
        let part = |(at, part): (usize, &[f64])| part.iter().zip(at..).map(|(e, c)| e * x[c]).sum::<f64>();
        self.parts().map(part).iter().sum()
    }

    fn add_to(&self, factor: f64, y: &mut DVector<f64>) {
        for (at, part) in self.parts() {
            part.iter().zip(at..).for_each(|(e, c)| y[c] += factor * e);
        }
    }
}

/// An upper triangular matrix of a narrow band, row by row from the diagonal on.
struct Band {
    columns: usize,
    width: usize,
    rows: Vec<f64>,
    taken: Vec<bool>,
}

impl Band {
    fn new(columns: usize, width: usize) -> Band {
        Band { columns, width, rows: vec![0.0; columns * width], taken: vec![false; columns] }
    }

    fn row(&self, at: usize) -> &[f64] {
        &self.rows[at * self.width..(at + 1) * self.width]
    }

    fn is_full(&self) -> bool {
        (0..self.columns).all(|at| self.taken[at] && self.row(at)[0] != 0.0)
    }

    /// Rotates a row into those that are there, until a place is free.
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

    /// How much of a row lies in no span of the others: 1 for one that is needed. What holds the whole
    /// still spans nothing that struts do, so it does not change this.
    fn share(&self, row: &Row) -> f64 {
        let mut b = DVector::zeros(self.columns);
        row.add_to(1.0, &mut b);
        self.solve_transposed(&mut b, row.first);
        b.norm_squared()
    }
}

/// Vectors with no direction of their own, the same everywhere.
fn beginnings(columns: usize, count: usize) -> Vec<DVector<f64>> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24) - 0.5
    };
    (0..count).map(|_| DVector::from_fn(columns, |_, _| next())).collect()
}

/// The least singular value of the struts' rows beside those of the motions of the whole, by iteration
/// of a subspace: slender trusses bend in two planes almost alike. The inverse of what is held, between
/// two projections, is the pseudo-inverse of what is not.
fn least(band: &Band, rows: &[Row], whole: &[DVector<f64>]) -> Option<f64> {
    let mut space = beginnings(band.columns, SPACE);
    settled(&mut || {
        let solved = space.drain(..).map(|mut x| {
            clear(&mut x, whole);
            band.solve_transposed(&mut x, 0);
            band.solve(&mut x);
            clear(&mut x, whole);
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

/// Takes the part along orthonormal vectors out.
fn clear(x: &mut DVector<f64>, basis: &[DVector<f64>]) {
    for b in basis {
        let along = b.dot(x);
        x.axpy(-along, b, 1.0);
    }
}

/// The largest singular value, about.
fn largest(rows: &[Row], columns: usize) -> f64 {
    let mut x = beginnings(columns, 1).remove(0).normalize();
    let mut value = 0.0;
    for _ in 0..50 {
        let mut y = DVector::zeros(columns);
        rows.iter().for_each(|row| row.add_to(row.times(&x), &mut y));
        value = y.norm().sqrt();
        x = y.normalize();
    }
    value
}

/// The value at which an iteration comes to rest; `None` where it does not.
fn settled(step: &mut dyn FnMut() -> f64) -> Option<f64> {
    let (mut before, mut times) = (f64::INFINITY, 0);
    for _ in 0..STEPS_MAX {
        interrupt::checkpoint();
        let value = step();
        if !value.is_finite() {
            return None;
        }
        times = if (value - before).abs() <= value * SETTLED { times + 1 } else { 0 };
        if times >= SETTLED_TIMES {
            return Some(value);
        }
        before = value;
    }
    None
}
