//! Infinitesimal rigidity of trusses: the motions of the nodes that change no strut's length to first order, and
//! the self-stresses (Maxwell 1864, Calladine 1978). Both are null spaces of the rigidity matrix, the Jacobian of
//! half the squared lengths, with one row for each strut and three columns for each node.

use super::banded_qr;
use super::sparse_rigidity;
use crate::geometry::Vec3;
use nalgebra::{DMatrix, DVector};

/// The number of nodes above which sparse decompositions are tried first: a dense one takes the cube of it.
const NODES_DENSE: usize = 60;

/// The tolerances with which the rigidity of trusses is examined, all relative and without unit.
pub(super) struct RigidityTolerances {
    /// The fraction of the largest singular value up to which a singular value counts as zero. 1e-9: far above
    /// rounding, far below the stiffness of any truss that is worth building.
    pub singular: f64,
    /// The fraction of the largest displacement up to which a displacement counts as none, and the part of a vector
    /// up to which what others leave of it counts as dependent. 1e-6: between rounding and the motions of nodes that
    /// do move.
    pub displacement: f64,
    /// The fraction of a strut's row in the span of the others above which the strut carries a self-stress. 1e-9: far
    /// above rounding.
    pub redundant: f64,
    /// The least singular value, as a fraction of the largest, above which a truss is clearly rigid, so that the banded
    /// decomposition decides. 1e-7: the square root of what counts as zero would be 3e-5, and rounding is 1e-16.
    pub clearly_rigid: f64,
    /// The least singular value, as a fraction of the largest, above which normal equations decide. 1e-4: its square is far
    /// above rounding.
    pub well_conditioned: f64,
    /// The relative change of the value of an iteration up to which the iteration counts as converged. 1e-11: below
    /// what is shown.
    pub converged: f64,
    /// The distance from a line, as a fraction of its length, below which nodes lie on it. 1e-6: far above rounding.
    pub on_line: f64,
}

/// The tolerances with which every truss is examined.
pub(super) const TOLERANCES: RigidityTolerances = RigidityTolerances {
    singular: 1e-9,
    displacement: 1e-6,
    redundant: 1e-9,
    clearly_rigid: 1e-7,
    well_conditioned: 1e-4,
    converged: 1e-11,
    on_line: 1e-6,
};

/// The infinitesimal rigidity of a truss: the rank of its rigidity matrix, and what follows from it (Maxwell 1864;
/// Calladine 1978).
#[derive(Clone, Debug, PartialEq)]
pub struct Rigidity {
    /// The rank of the rigidity matrix, which has a row for each strut and three columns for each node.
    pub rank: usize,
    /// The rank that a rigid truss of these nodes has: 3n - 6 for n nodes, 3n - 5 if they lie on a line, 0 for one
    /// node.
    pub rank_rigid: usize,
    /// The dimension of the space of self-stresses, the states of stress without load: the number of struts less the
    /// rank.
    pub self_stresses: usize,
    /// The least singular value that is not zero, of the rigidity matrix of the truss scaled to a mean strut length
    /// of 1, without unit; infinite if the rank is 0.
    pub weakest: f64,
    /// The indices of the struts of which any one may be taken away without loss of rank, ascending.
    pub redundant: Vec<usize>,
    /// A basis of the infinitesimal mechanisms, the motions that change no length to first order; rigid motions are
    /// left out.
    pub free: Vec<FreeMotion>,
}

/// An infinitesimal mechanism: displacements of the nodes that change no length to first order, scaled so that the
/// largest is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// The nodes that move, each as (index, displacement in the world, without unit); the greatest length of a
    /// displacement is 1.
    pub nodes: Vec<(usize, Vec3)>,
}

/// The rigidity of a large truss whose least singular value is clearly above zero.
pub(super) struct RigidityReport {
    /// The least singular value that belongs to no motion of the whole, for struts of mean length 1.
    pub(super) weakest: f64,
    /// Indices of the struts without any one of which the truss stays rigid, ascending.
    pub(super) redundant: Vec<usize>,
}

impl Rigidity {
    /// Returns true if the truss is infinitesimally rigid: only motions of the whole as a rigid body are free.
    pub fn rigid(&self) -> bool {
        self.free.is_empty()
    }
}

/// Returns the infinitesimal rigidity of a truss with nodes at these positions (m) and struts between them, as pairs
/// of indices of nodes that lie apart, from the singular values of the rigidity matrix; large trusses by sparse normal
/// equations if these are well conditioned, or else by a banded QR decomposition if they are clearly rigid. Panics without nodes, and for a strut of a node that is not there.
pub fn rigidity(nodes: &[Vec3], struts: &[(usize, usize)]) -> Rigidity {
    if nodes.len() > NODES_DENSE
        && let Some(report) =
            sparse_rigidity::examine(nodes, struts).or_else(|| banded_qr::examine(nodes, struts))
    {
        let rank = 3 * nodes.len() - rigid_motions(nodes).len();
        return Rigidity {
            rank,
            rank_rigid: rank,
            self_stresses: struts.len() - rank,
            weakest: report.weakest,
            redundant: report.redundant,
            free: Vec::new(),
        };
    }
    // Decompose the matrix; small singular values count as zero.
    let matrix = rigidity_matrix(nodes, struts);
    let svd = matrix.svd(true, true);
    let largest = svd.singular_values.max();
    let is_zero = |s: f64| s <= largest * TOLERANCES.singular;
    let kept: Vec<usize> =
        (0..svd.singular_values.len()).filter(|&i| !is_zero(svd.singular_values[i])).collect();
    let u = svd.u.as_ref().expect("asked for");
    let v_t = svd.v_t.as_ref().expect("asked for");
    let leverage = |strut: usize| kept.iter().map(|&i| u[(strut, i)] * u[(strut, i)]).sum::<f64>();
    let rigid = rigid_motions(nodes);
    let null: Vec<DVector<f64>> = (0..svd.singular_values.len())
        .filter(|i| !kept.contains(i))
        .map(|i| v_t.row(i).transpose())
        .collect();
    let free = reduced(project_out(null, &rigid), 3 * nodes.len() - kept.len() - rigid.len());
    Rigidity {
        rank: kept.len(),
        rank_rigid: 3 * nodes.len() - rigid.len(),
        self_stresses: struts.len() - kept.len(),
        weakest: kept.iter().map(|&i| svd.singular_values[i]).fold(f64::INFINITY, f64::min),
        redundant: (0..struts.len()).filter(|&s| leverage(s) < 1.0 - TOLERANCES.redundant).collect(),
        free: free.iter().map(free_motion).collect(),
    }
}

/// Returns the rigidity matrix: rows `(p_a - p_b)` at a, `(p_b - p_a)` at b, in mean strut lengths; rows of zeros
/// fill it up so that the decomposition has a right vector for every column.
fn rigidity_matrix(nodes: &[Vec3], struts: &[(usize, usize)]) -> DMatrix<f64> {
    let length = |&(a, b): &(usize, usize)| (nodes[a] - nodes[b]).norm();
    let mean = struts.iter().map(length).sum::<f64>() / struts.len().max(1) as f64;
    let columns = 3 * nodes.len();
    let mut matrix = DMatrix::zeros(struts.len().max(columns), columns);
    for (row, &(a, b)) in struts.iter().enumerate() {
        let d = (nodes[a] - nodes[b]) / mean;
        for k in 0..3 {
            matrix[(row, 3 * a + k)] = d[k];
            matrix[(row, 3 * b + k)] = -d[k];
        }
    }
    matrix
}

/// Returns an orthonormal basis of the rigid motions of all nodes together, translations and rotations: vectors with
/// three coordinates for each node.
pub(super) fn rigid_motions(nodes: &[Vec3]) -> Vec<DVector<f64>> {
    let centre = nodes.iter().sum::<Vec3>() / nodes.len().max(1) as f64;
    let moved = |motion: &dyn Fn(&Vec3) -> Vec3| {
        DVector::from_iterator(3 * nodes.len(), nodes.iter().flat_map(|p| motion(p).data.0[0]))
    };
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mut motions: Vec<DVector<f64>> = axes.iter().map(|axis| moved(&|_| *axis)).collect();
    motions.extend(axes.iter().map(|axis| moved(&|p| axis.cross(&(p - centre)))));
    orthonormal(motions)
}

/// Returns an orthonormal basis by the method of Gram and Schmidt, twice for accuracy; vectors that depend on
/// those before are left out.
pub(super) fn orthonormal(vectors: Vec<DVector<f64>>) -> Vec<DVector<f64>> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for vector in vectors {
        let length = vector.norm();
        let mut rest = vector;
        for _ in 0..2 {
            for b in &basis {
                let along = b.dot(&rest);
                rest.axpy(-along, b, 1.0);
            }
        }
        if rest.norm() > length * TOLERANCES.displacement {
            basis.push(rest.normalize());
        }
    }
    basis
}

/// Projects vectors onto the complement of orthonormal ones.
fn project_out(vectors: Vec<DVector<f64>>, basis: &[DVector<f64>]) -> Vec<DVector<f64>> {
    let project = |mut v: DVector<f64>| {
        for b in basis {
            let along = b.dot(&v);
            v.axpy(-along, b, 1.0);
        }
        v
    };
    vectors.into_iter().map(project).collect()
}

/// Returns a basis of the span of vectors, of `count` vectors with as many zeros as Gaussian elimination
/// gives: it depends on the span alone, so on nothing but the truss.
fn reduced(mut rows: Vec<DVector<f64>>, count: usize) -> Vec<DVector<f64>> {
    let mut done: Vec<DVector<f64>> = Vec::new();
    let columns = rows.first().map_or(0, |r| r.len());
    while done.len() < count && !rows.is_empty() {
        let largest = rows.iter().map(|r| r.amax()).fold(0.0, f64::max);
        // The first column that is not small in all rows; in it the row that is largest.
        let Some(column) = (0..columns).find(|&c| rows.iter().any(|r| r[c].abs() > largest * 0.1)) else {
            break;
        };
        let best = (0..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        let pivot = rows.swap_remove(best.expect("rows is not empty"));
        let pivot = &pivot / pivot[column];
        for row in rows.iter_mut().chain(done.iter_mut()) {
            let factor = row[column];
            row.axpy(-factor, &pivot, 1.0);
        }
        done.push(pivot);
    }
    done
}

/// Returns a null vector as a motion of nodes, scaled.
fn free_motion(motion: &DVector<f64>) -> FreeMotion {
    let at = |node: usize| Vec3::new(motion[3 * node], motion[3 * node + 1], motion[3 * node + 2]);
    let count = motion.len() / 3;
    let largest = (0..count).map(|n| at(n).norm()).fold(0.0, f64::max);
    let moving = (0..count).filter(|&n| at(n).norm() > largest * TOLERANCES.displacement);
    FreeMotion { nodes: moving.map(|n| (n, at(n) / largest)).collect() }
}
