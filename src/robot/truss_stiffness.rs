//! The stiffness of a truss on its contacts: the displacements of its nodes under loads.

use super::truss_layout::Layout;
use crate::geometry::Vec3;
use crate::optimize::cholesky::PivotRule;
use crate::optimize::sparse_cholesky::SparseCholesky;
use nalgebra::{DMatrix, DVector, Matrix3};
use std::collections::BTreeMap;

/// The least pivot as a part of its diagonal entry: below it nothing holds a node.
const PIVOT: f64 = 1e-11;
/// The residual, as a part of the loads, up to which displacements are accurate where contacts have changed: what rounding leaves of
/// matrices that are nearly singular is some 1e-8, and forces are in equilibrium to more than this, part by part.
const RESIDUAL: f64 = 2e-7;
/// The number of systems whose solution takes as long as that of the three directions of a contact together.
pub(super) const RESPONSE: f64 = 1.5;
/// The same where contacts change so often that what is known of one serves many times.
pub(super) const RESPONSE_OFTEN: f64 = 0.4;

/// The number of columns that are solved together for the three axes: one more is zero, since processors take four at once.
const LANES: usize = 4;

/// The stiffness matrix of a truss at some positions of its nodes, with its decomposition.
#[derive(Clone, Debug)]
pub(super) struct Stiffness {
    /// The positions, m.
    x: Vec<Vec3>,
    /// The weight of each strut, the inverse of its stiffness.
    weights: Vec<f64>,
    /// The stiffness of the contact of each node; zero where there is none.
    springs: Vec<Matrix3<f64>>,
    factor: SparseCholesky,
    /// The displacements under unit forces on a node along each axis, in the order of the layout, by nodes.
    responses: BTreeMap<usize, Vec<[f64; LANES]>>,
}

impl Stiffness {
    /// Returns the weight of each strut, the inverse of its stiffness.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }
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
                let factor = self.decomposed(springs)?;
                let mut u = b;
                factor.solve_permuted(&mut u);
                let (x, weights, springs) = (self.x.to_vec(), self.weights.to_vec(), springs.to_vec());
                *known = Some(Stiffness { x, weights, springs, factor, responses: BTreeMap::new() });
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
        let mut u = b.to_vec();
        known.factor.solve_permuted(&mut u);
        let changed: Vec<usize> =
            (0..springs.len()).filter(|&node| springs[node] != known.springs[node]).collect();
        if changed.is_empty() {
            return Some(u);
        }
        let unknown: Vec<usize> =
            changed.iter().copied().filter(|node| !known.responses.contains_key(node)).collect();
        if self.response * unknown.len() as f64 > layout.solutions() {
            return None;
        }
        for node in unknown {
            let mut response = vec![[0.0; LANES]; u.len()];
            (0..3).for_each(|k| response[layout.row(node) + k][k] = 1.0);
            known.factor.solve_columns(&mut response);
            known.responses.insert(node, response);
        }
        // With the changes D of the springs and the responses C = K⁻¹ E: (I + D Eᵀ C) w = D Eᵀ u, and u - C w.
        let responses: Vec<&Vec<[f64; LANES]>> = changed.iter().map(|node| &known.responses[node]).collect();
        let size = 3 * changed.len();
        let mut matrix = DMatrix::identity(size, size);
        let mut right = DVector::zeros(size);
        for (i, &node) in changed.iter().enumerate() {
            let (row, change) = (layout.row(node), springs[node] - known.springs[node]);
            right.fixed_rows_mut::<3>(3 * i).copy_from(&(change * layout.at(&u, node)));
            for (j, response) in responses.iter().enumerate() {
                let part = Matrix3::from_fn(|r, c| response[row + r][c]);
                let mut block = matrix.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                block += change * part;
            }
        }
        let w = matrix.lu().solve(&right)?;
        for (response, w) in responses.iter().zip(w.as_slice().chunks_exact(3)) {
            u.iter_mut().zip(*response).for_each(|(u, c)| *u -= c[0] * w[0] + c[1] * w[1] + c[2] * w[2]);
        }
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
