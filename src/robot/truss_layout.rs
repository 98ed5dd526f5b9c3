//! The places of the entries of a truss's stiffness matrix.

use crate::geometry::Vec3;
use crate::optimize::cuthill_mckee::neighbours;
use crate::optimize::sparse_cholesky::SparseMatrix;
use crate::optimize::{Slot, SymbolicFactor};
use nalgebra::Matrix3;
use std::sync::Arc;

/// The dimension of space: the number of coordinates of a node.
const DIMENSION: usize = 3;

/// The number of multiplications of a decomposition that count for one change of a node's block when all are cubed: a dense system of
/// 3n rows takes 9 n³, each as long as five of the sparse one, and a quarter of the time of another decomposition is worth it.
const CHANGES: f64 = 4.0 * 5.0 * 9.0;

/// The order in which the nodes of a truss are eliminated in its stiffness matrix, so that its decomposition fills
/// little, and where each node's and each strut's entries are. It depends on the graph alone, and is found once for a
/// truss.
#[derive(Clone, Debug)]
pub struct Layout {
    symbolic: Arc<SymbolicFactor>,
    /// The diagonal block of each node.
    nodes: Vec<Slot>,
    /// The block of each strut beside the diagonal.
    struts: Vec<Slot>,
}

impl Layout {
    /// Returns the layout of a truss of `nodes` nodes with `struts` between them, as pairs of indices of nodes: that of
    /// nested dissection. Panics for a strut of a node that is not there.
    pub fn new(nodes: usize, struts: &[(usize, usize)]) -> Layout {
        let symbolic = SymbolicFactor::new(DIMENSION, &neighbours(nodes, struts.iter().copied()));
        Layout {
            nodes: (0..nodes).map(|node| symbolic.slot(node, node)).collect(),
            struts: struts.iter().map(|&(a, b)| symbolic.slot(a, b)).collect(),
            symbolic: Arc::new(symbolic),
        }
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the nodes in the order in which they are eliminated.
    pub fn order(&self) -> &[usize] {
        self.symbolic.order()
    }

    /// Returns the stiffness matrix `Σ k r rᵀ` of struts with the vectors `r` (`rows`) along them from their first node to
    /// the second, in the order of this layout, with `shift` on its diagonal. `struts`: those of the layout; `stiffness`:
    /// k of each strut by its index.
    pub(super) fn matrix(
        &self,
        rows: &[Vec3],
        struts: &[(usize, usize)],
        stiffness: impl Fn(usize) -> f64,
        shift: f64,
    ) -> SparseMatrix {
        let mut matrix = SparseMatrix::new(&self.symbolic);
        let shift = Matrix3::from_diagonal_element(shift);
        let mut sums = vec![shift; self.nodes.len()];
        for (strut, (&(a, b), row)) in struts.iter().zip(rows).enumerate() {
            let block = row * row.transpose() * stiffness(strut);
            sums[a] += block;
            sums[b] += block;
            matrix.add_block(self.struts[strut], &-block);
        }
        for (slot, block) in self.nodes.iter().zip(&sums) {
            matrix.add_block(*slot, block);
        }
        matrix
    }

    /// Adds a symmetric block to the diagonal of a matrix of this layout at a node.
    pub(super) fn add(&self, matrix: &mut SparseMatrix, node: usize, block: &Matrix3<f64>) {
        matrix.add_block(self.nodes[node], block);
    }

    /// Returns the number of systems with the same decomposition whose solution takes as long as another decomposition.
    pub(super) fn solutions(&self) -> f64 {
        self.symbolic.solutions()
    }

    /// Returns the number of nodes with changed blocks for which a system of their own takes a good part of the time of another
    /// decomposition.
    pub(super) fn changes(&self) -> usize {
        libm::cbrt(self.symbolic.work() as f64 / CHANGES) as usize
    }

    /// Returns a vector with three coordinates for each node, in the order of the factor.
    pub(super) fn gathered(&self, nodes: impl Fn(usize) -> Vec3) -> Vec<f64> {
        self.order().iter().flat_map(|node| <[f64; DIMENSION]>::from(nodes(*node))).collect()
    }

    /// Returns the three coordinates that a vector in the order of the factor has for a node.
    pub(super) fn at(&self, vector: &[f64], node: usize) -> Vec3 {
        let at = self.row(node);
        Vec3::new(vector[at], vector[at + 1], vector[at + 2])
    }

    /// Returns the index of the first coordinate that a vector in the order of the factor has for a node.
    pub(super) fn row(&self, node: usize) -> usize {
        DIMENSION * self.symbolic.place(node)
    }
}

/// Returns the unit vectors along struts, from the first node to the second. `x`: the positions of the nodes, m.
pub(super) fn directions(x: &[Vec3], struts: &[(usize, usize)]) -> Vec<Vec3> {
    struts.iter().map(|&(a, b)| (x[b] - x[a]).normalize()).collect()
}
