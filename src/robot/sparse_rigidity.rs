//! Rigidity of trusses of many nodes, by the normal equations of the rigidity matrix: its least singular value by subspace
//! iteration, and the struts that carry a self-stress by least squares.
//!
//! Normal equations square the condition of the matrix, so that they decide only about trusses that are far from
//! losing their rigidity; [`super::banded_qr`] takes longer and decides about others.

use super::pinned_nodes::PinnedNodes;
use super::truss::{RigidityReport, TOLERANCES, rigid_motions};
use super::truss_layout::Layout;
use super::truss_modes::Modes;
use crate::geometry::Vec3;
use crate::interrupt;
use crate::optimize::cholesky::PivotRule;
use crate::optimize::random::SplitMix64;
use crate::optimize::sparse_cholesky::SparseCholesky;
use nalgebra::Matrix3;

/// The number of random forces whose self-stresses are looked at.
const SELF_STRESSES: usize = 4;
/// The number of power iterations for the largest singular value.
const POWER_ITERATIONS: usize = 20;

/// Returns the rigidity of a truss with nodes at these positions (m) and struts between them (pairs of indices of nodes);
/// `None` where it is not rigid, or not by so much that this method is certain.
pub(super) fn examine(nodes: &[Vec3], struts: &[(usize, usize)]) -> Option<RigidityReport> {
    let layout = Layout::new(nodes.len(), struts);
    let mean = struts.iter().map(|&(a, b)| (nodes[a] - nodes[b]).norm()).sum::<f64>() / struts.len() as f64;
    let rows: Vec<Vec3> = struts.iter().map(|&(a, b)| (nodes[b] - nodes[a]) / mean).collect();
    let weakest = Modes::default().least_of(&layout, nodes, (struts, &rows))?;
    let equations = NormalEquations::new(&layout, nodes, struts, &rows)?;
    if weakest <= TOLERANCES.well_conditioned * equations.largest_singular_value() {
        return None;
    }
    // With as many struts as there are degrees of freedom, each is needed.
    let spare = struts.len() + rigid_motions(nodes).len() > 3 * nodes.len();
    let redundant = if spare { equations.redundant() } else { Vec::new() };
    Some(RigidityReport { weakest, redundant })
}

/// The decomposed normal equations of a truss that is held at three nodes, so that it can't move as a whole.
struct NormalEquations<'a> {
    layout: &'a Layout,
    struts: &'a [(usize, usize)],
    rows: &'a [Vec3],
    factor: SparseCholesky,
}

impl<'a> NormalEquations<'a> {
    /// Returns the equations; `None` where the nodes lie on a line.
    fn new(
        layout: &'a Layout,
        nodes: &[Vec3],
        struts: &'a [(usize, usize)],
        rows: &'a [Vec3],
    ) -> Option<NormalEquations<'a>> {
        let mut matrix = layout.matrix(rows, struts, |_| 1.0, 0.0);
        // These supports span nothing that struts do, so that they change no self-stress.
        let PinnedNodes { second, third, along, normal } = PinnedNodes::of(nodes)?;
        let along = along.normalize();
        layout.add(&mut matrix, 0, &Matrix3::identity());
        layout.add(&mut matrix, second, &(Matrix3::identity() - along * along.transpose()));
        layout.add(&mut matrix, third, &(normal * normal.transpose()));
        let factor =
            matrix.cholesky(PivotRule::Refuse(TOLERANCES.well_conditioned * TOLERANCES.well_conditioned))?;
        Some(NormalEquations { layout, struts, rows, factor })
    }

    /// Returns `Rᵀ f`, the forces on the nodes, in the order of the layout.
    fn forces(&self, f: &[f64]) -> Vec<f64> {
        let mut sums = vec![Vec3::zeros(); self.layout.nodes()];
        for ((&(a, b), row), force) in self.struts.iter().zip(self.rows).zip(f) {
            sums[b] += row * *force;
            sums[a] -= row * *force;
        }
        self.layout.gathered(|node| sums[node])
    }

    /// Returns the part of `f`, with an entry for each strut, that is a self-stress: the residual of least squares,
    /// whose error is the square of that of the solution.
    fn self_stress(&self, f: &[f64]) -> Vec<f64> {
        let mut u = self.forces(f);
        self.factor.solve_permuted(&mut u);
        let at = |node: usize| self.layout.at(&u, node);
        let rest =
            |((&(a, b), row), force): ((&(usize, usize), &Vec3), &f64)| force - row.dot(&(at(b) - at(a)));
        self.struts.iter().zip(self.rows).zip(f).map(rest).collect()
    }

    /// Returns the struts that carry a self-stress, ascending.
    fn redundant(&self) -> Vec<usize> {
        let count = self.struts.len();
        let mut random = SplitMix64(1);
        let mut seen = vec![0.0f64; count];
        for _ in 0..SELF_STRESSES {
            interrupt::checkpoint();
            let f: Vec<f64> = (0..count).map(|_| random.next_signed()).collect();
            let stress = self.self_stress(&f);
            seen.iter_mut().zip(&stress).for_each(|(seen, s)| *seen = seen.max(s * s));
        }
        // The stress of a strut is its row of a projection, whose squared length is p, times f, of at most `count`
        // squared: where it is greater than `count` times the threshold of p, p is above that. Others are looked at
        // one by one.
        let carries = |strut: &usize| {
            interrupt::checkpoint();
            let mut one = vec![0.0; count];
            one[*strut] = 1.0;
            let own = || self.self_stress(&one).iter().map(|s| s * s).sum::<f64>();
            seen[*strut] > TOLERANCES.redundant * count as f64 || own() > TOLERANCES.redundant
        };
        (0..count).filter(carries).collect()
    }

    /// Returns the largest singular value, about, from below.
    fn largest_singular_value(&self) -> f64 {
        let mut random = SplitMix64(2);
        let mut f: Vec<f64> = self.struts.iter().map(|_| random.next_signed()).collect();
        let mut value = 0.0;
        for _ in 0..POWER_ITERATIONS {
            let size = f.iter().map(|f| f * f).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            f.iter_mut().for_each(|f| *f /= size);
            let u = self.forces(&f);
            value = u.iter().map(|u| u * u).sum::<f64>().sqrt();
            let at = |node: usize| self.layout.at(&u, node);
            f = self.struts.iter().zip(self.rows).map(|(&(a, b), row)| row.dot(&(at(b) - at(a)))).collect();
        }
        value
    }
}
