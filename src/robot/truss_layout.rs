//! The envelope of a truss's stiffness matrix.

use crate::geometry::Vec3;
use crate::optimize::SymmetricMatrix;
use crate::optimize::cuthill_mckee;
use nalgebra::Matrix3;

/// The order of the nodes of a truss in its stiffness matrix and the matrix's envelope, in which no decomposition
/// fills anything outside.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The number of each node in the matrix.
    position: Vec<usize>,
    /// The first column of each row.
    first: Vec<usize>,
}

impl Layout {
    /// Returns the layout of a truss of `nodes` nodes with `struts` between them, as pairs of indices of nodes: that of
    /// reverse Cuthill and McKee. Panics for a strut of a node that is not there.
    pub fn new(nodes: usize, struts: &[(usize, usize)]) -> Layout {
        let order = cuthill_mckee::reverse_order(nodes, struts.iter().copied());
        let mut position = vec![0; nodes];
        order.iter().enumerate().for_each(|(at, node)| position[*node] = at);
        let mut first: Vec<usize> = (0..nodes).collect();
        for &(a, b) in struts {
            let (high, low) = (position[a].max(position[b]), position[a].min(position[b]));
            first[high] = first[high].min(low);
        }
        Layout { position, first: first.into_iter().flat_map(|node| [3 * node; 3]).collect() }
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.position.len()
    }

    /// Returns the stiffness matrix `Σ k e eᵀ` of struts with the unit vectors `e` along them, in the order of this
    /// layout, with `shift` on its diagonal. `x`: the positions of the nodes, m; `struts`: those of the layout;
    /// `stiffness`: k of each strut by its index.
    pub(super) fn matrix(
        &self,
        x: &[Vec3],
        struts: &[(usize, usize)],
        stiffness: impl Fn(usize) -> f64,
        shift: f64,
    ) -> SymmetricMatrix {
        let mut matrix = SymmetricMatrix::with_envelope(self.first.clone());
        for (strut, &(a, b)) in struts.iter().enumerate() {
            let along = (x[b] - x[a]).normalize();
            let block = along * along.transpose() * stiffness(strut);
            self.add(&mut matrix, a, &block);
            self.add(&mut matrix, b, &block);
            let (high, low) = if self.position[a] > self.position[b] { (a, b) } else { (b, a) };
            let (row, column) = (3 * self.position[high], 3 * self.position[low]);
            for i in 0..3 {
                for j in 0..3 {
                    matrix.add(row + i, column + j, -block[(i, j)]);
                }
            }
        }
        (0..matrix.size()).for_each(|row| matrix.add(row, row, shift));
        matrix
    }

    /// Adds a symmetric block to the diagonal of a matrix of this layout at a node.
    pub(super) fn add(&self, matrix: &mut SymmetricMatrix, node: usize, block: &Matrix3<f64>) {
        let row = 3 * self.position[node];
        for i in 0..3 {
            for j in 0..=i {
                matrix.add(row + i, row + j, block[(i, j)]);
            }
        }
    }

    /// Returns a vector with three coordinates for each node, in the order of the matrix.
    pub(super) fn gathered(&self, nodes: impl Fn(usize) -> Vec3) -> Vec<f64> {
        let mut vector = vec![0.0; 3 * self.position.len()];
        for (node, at) in self.position.iter().enumerate() {
            vector[3 * at..3 * at + 3].copy_from_slice(nodes(node).as_slice());
        }
        vector
    }

    /// Returns the three coordinates that a vector in the order of the matrix has for a node.
    pub(super) fn at(&self, vector: &[f64], node: usize) -> Vec3 {
        let at = 3 * self.position[node];
        Vec3::new(vector[at], vector[at + 1], vector[at + 2])
    }
}
