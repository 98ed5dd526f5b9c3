//! The stiffness of a truss on its contacts: the displacements of its nodes under loads.

use super::truss_layout::Layout;
use crate::geometry::Vec3;
use crate::optimize::cholesky::PivotRule;
use crate::optimize::sparse_cholesky::SparseCholesky;
use nalgebra::{DMatrix, DVector, Matrix3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The least pivot as a part of its diagonal entry: below it nothing holds a node.
const PIVOT: f64 = 1e-11;
/// The residual, as a part of the loads, up to which displacements are accurate where contacts have changed: what rounding leaves of
/// matrices that are nearly singular is some 1e-8, and forces are in equilibrium to more than this, part by part.
const RESIDUAL: f64 = 2e-7;
/// The number of systems whose solution takes as long as what is found once of a contact that changes.
pub(super) const RESPONSE: f64 = 1.5;
/// The same where contacts change so often that what is known of one serves many times.
pub(super) const RESPONSE_OFTEN: f64 = 0.4;

/// The number of columns that are solved together for the three axes: one more is zero, since processors take four at once.
const LANES: usize = 4;

/// The half `L⁻¹ E` of the displacements `L⁻ᵀ L⁻¹ E` under unit forces on a node along each axis, in the order of the layout: the rows
/// from the node's own on, before which all are zero.
type HalfResponse = Vec<[f64; LANES]>;

/// The stiffness matrix of a truss at some positions of its nodes, with its decomposition.
#[derive(Clone, Debug)]
pub(super) struct Stiffness {
    /// The positions, m.
    x: Vec<Vec3>,
    /// The weight of each strut, the inverse of its stiffness.
    weights: Vec<f64>,
    /// The stiffness of the contact of each node; zero where there is none.
    springs: Vec<Matrix3<f64>>,
    /// The decomposition, which copies share.
    factor: Arc<SparseCholesky>,
    /// The half responses of nodes, which copies share too.
    halves: BTreeMap<usize, Arc<HalfResponse>>,
    /// The displacements of a node (rows) under unit forces on another one (columns), by these two, of which the first is not
    /// greater.
    compliances: BTreeMap<(usize, usize), Matrix3<f64>>,
    /// The loads b for which displacements were found last, with `L⁻¹ b`, both in the order of the layout.
    loads: (Vec<f64>, Vec<f64>),
}

impl Stiffness {
    /// Returns the weight of each strut, the inverse of its stiffness.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Finds `L⁻¹ b` for loads in the order of the layout, if it is not known.
    fn halve(&mut self, b: &[f64]) {
        let (known, half) = &mut self.loads;
        if known != b {
            (*known, *half) = (b.to_vec(), b.to_vec());
            self.factor.solve_lower(half);
        }
    }

    /// Finds the half responses of nodes of which they are not known, and their compliances with each other and with all others among
    /// `nodes`.
    fn respond(&mut self, layout: &Layout, nodes: &[usize], unknown: &[usize]) {
        for &node in unknown {
            let mut half = vec![[0.0; LANES]; self.factor.size()];
            let row = layout.row(node);
            (0..3).for_each(|k| half[row + k][k] = 1.0);
            self.factor.solve_lower_columns(&mut half);
            self.halves.insert(node, Arc::new(half.split_off(row)));
        }
        let pairs = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| (a, b)));
        for (a, b) in pairs.filter(|(a, b)| a <= b) {
            let (halves, entry) = (&self.halves, self.compliances.entry((a, b)));
            entry.or_insert_with(|| compliance(&halves[&a], &halves[&b]));
        }
    }

    /// Returns the displacements of a node under unit forces on another one, both of those that responses are known of.
    fn compliance(&self, a: usize, b: usize) -> Matrix3<f64> {
        if a <= b { self.compliances[&(a, b)] } else { self.compliances[&(b, a)].transpose() }
    }
}

/// Returns the product of a half response, transposed, with another one.
fn compliance(a: &HalfResponse, b: &HalfResponse) -> Matrix3<f64> {
    let rows = a.len().min(b.len());
    let mut sums = [[0.0; LANES]; 3];
    for (a, b) in a[a.len() - rows..].iter().zip(&b[b.len() - rows..]) {
        for (sums, a) in sums.iter_mut().zip(a) {
            sums.iter_mut().zip(b).for_each(|(sum, b)| *sum += a * b);
        }
    }
    Matrix3::from_fn(|row, column| sums[row][column])
}

/// A truss whose nodes are displaced.
#[derive(Clone, Copy)]
pub(super) struct Elastic<'a> {
    /// The places of the matrix's entries.
    pub layout: &'a Layout,
    /// The positions of the nodes, m.
    pub x: &'a [Vec3],
    /// The two nodes of each strut, those of the layout.
    pub struts: &'a [(usize, usize)],
    /// The unit vector along each strut.
    pub rows: &'a [Vec3],
    /// The weight of each strut, the inverse of its stiffness.
    pub weights: &'a [f64],
    /// The number of systems that the response of a contact counts for.
    pub response: f64,
}

impl Elastic<'_> {
    /// Returns the displacement of each node under `loads`, by nodes. `springs`: the stiffness of the contact of each node.
    /// `known`: the matrix that was decomposed last, which serves again if only few contacts have changed. `None` if nothing
    /// holds some node.
    pub(super) fn displacements(
        &self,
        springs: &[Matrix3<f64>],
        loads: &[Vec3],
        known: &mut Option<Stiffness>,
    ) -> Option<Vec<Vec3>> {
        let b = self.layout.gathered(|node| loads[node]);
        let here = known.as_mut().filter(|known| known.x == self.x && known.weights == self.weights);
        let u = match here.and_then(|known| self.nearby(springs, &b, known)) {
            Some(u) => u,
            None => {
                let factor = Arc::new(self.decomposed(springs)?);
                let mut half = b.clone();
                factor.solve_lower(&mut half);
                let mut u = half.clone();
                factor.solve_upper(&mut u);
                let (x, weights, springs) = (self.x.to_vec(), self.weights.to_vec(), springs.to_vec());
                let (halves, compliances, loads) = (BTreeMap::new(), BTreeMap::new(), (b, half));
                *known = Some(Stiffness { x, weights, springs, factor, halves, compliances, loads });
                u
            }
        };
        Some((0..self.x.len()).map(|node| self.layout.at(&u, node)).collect())
    }

    /// Returns the decomposition of the matrix; `None` if nothing holds some node.
    fn decomposed(&self, springs: &[Matrix3<f64>]) -> Option<SparseCholesky> {
        let Elastic { layout, struts, rows, weights, .. } = *self;
        let mut matrix = layout.matrix(rows, struts, |strut| 1.0 / weights[strut], 0.0);
        for (node, spring) in springs.iter().enumerate().filter(|(_, spring)| **spring != Matrix3::zeros()) {
            layout.add(&mut matrix, node, spring);
        }
        matrix.cholesky(PivotRule::Refuse(PIVOT))
    }

    /// Returns the displacements under the loads `b`, both in the order of the layout, by the decomposition of a matrix from which
    /// that of this truss differs at few contacts only: by the formula of Sherman, Morrison and Woodbury. `None` if it takes
    /// longer than to decompose anew, or is not accurate.
    fn nearby(&self, springs: &[Matrix3<f64>], b: &[f64], known: &mut Stiffness) -> Option<Vec<f64>> {
        let layout = self.layout;
        let changed: Vec<usize> =
            (0..springs.len()).filter(|&node| springs[node] != known.springs[node]).collect();
        let unknown: Vec<usize> =
            changed.iter().copied().filter(|node| !known.halves.contains_key(node)).collect();
        if self.response * unknown.len() as f64 > layout.solutions() || changed.len() > layout.changes() {
            return None;
        }
        known.halve(b);
        known.respond(layout, &changed, &unknown);
        let mut u = known.loads.1.clone();
        if changed.is_empty() {
            known.factor.solve_upper(&mut u);
            return Some(u);
        }
        // With the changes D of the springs and K = L Lᵀ: (I + D Eᵀ K⁻¹ E) w = D Eᵀ K⁻¹ b, and L⁻ᵀ (L⁻¹ b - L⁻¹ E w).
        let size = 3 * changed.len();
        let mut matrix = DMatrix::identity(size, size);
        let mut right = DVector::zeros(size);
        for (i, &node) in changed.iter().enumerate() {
            let change = springs[node] - known.springs[node];
            let mut displaced = [0.0; LANES];
            for (half, load) in known.halves[&node].iter().zip(&u[layout.row(node)..]) {
                displaced.iter_mut().zip(half).for_each(|(sum, half)| *sum += half * load);
            }
            let displaced = Vec3::from_column_slice(&displaced[..3]);
            right.fixed_rows_mut::<3>(3 * i).copy_from(&(change * displaced));
            for (j, other) in changed.iter().enumerate() {
                let mut block = matrix.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                block += change * known.compliance(node, *other);
            }
        }
        let w = matrix.lu().solve(&right)?;
        for (node, w) in changed.iter().zip(w.as_slice().chunks_exact(3)) {
            let own = u[layout.row(*node)..].iter_mut().zip(&*known.halves[node]);
            own.for_each(|(u, half)| *u -= half[0] * w[0] + half[1] * w[1] + half[2] * w[2]);
        }
        known.factor.solve_upper(&mut u);
        let image = self.times(springs, &u);
        let rest: f64 = b.iter().zip(&image).map(|(b, image)| (b - image) * (b - image)).sum();
        let whole: f64 = b.iter().map(|b| b * b).sum();
        (rest <= RESIDUAL * RESIDUAL * whole).then_some(u)
    }

    /// Returns the product of the matrix with a vector, both in the order of the layout.
    fn times(&self, springs: &[Matrix3<f64>], v: &[f64]) -> Vec<f64> {
        let Elastic { layout, struts, rows, weights, .. } = *self;
        let mut sums = vec![0.0; v.len()];
        for ((&(a, b), row), weight) in struts.iter().zip(rows).zip(weights) {
            let pull = row.dot(&(layout.at(v, b) - layout.at(v, a))) / weight;
            for (node, pull) in [(a, -pull), (b, pull)] {
                let at = layout.row(node);
                (0..3).for_each(|k| sums[at + k] += row[k] * pull);
            }
        }
        for (node, spring) in springs.iter().enumerate().filter(|(_, spring)| **spring != Matrix3::zeros()) {
            let (at, push) = (layout.row(node), spring * layout.at(v, node));
            (0..3).for_each(|k| sums[at + k] += push[k]);
        }
        sums
    }
}
