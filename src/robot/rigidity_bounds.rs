//! Bounds on the singular values of the rigidity matrix of a truss while its nodes move.

use crate::geometry::Vec3;
use nalgebra::Matrix3;

/// The number of iterations for the bound on a norm.
const NORM_ITERATIONS: usize = 8;
/// The least entry of its vector, of which the greatest is 1.
const Z_MIN: f64 = 0.01;
/// The part by which bounds that are asked for are greater than the least that would do, which rounding may take.
const ROUNDING: f64 = 512.0 * f64::EPSILON;

/// A linear motion of the nodes of a truss between two positions, which bounds how far the least singular value of the rigidity matrix
/// that belongs to no rigid motion dips on the way.
///
/// The vectors along struts change linearly, too. Let D be the rigidity matrix with these vectors, times a weight for each strut, in
/// the place of directions, and E its change in all: the part t of the way has
/// `DᵀD = (1 - t) D₀ᵀD₀ + t D₁ᵀD₁ - t (1 - t) EᵀE`. With weights of one over the greatest length of each strut, no singular value of D
/// is greater than that of the rigidity matrix, and at the ends none is less than it by more than the part by which a strut is
/// shorter there. A displacement that is across all rigid motions at the start is so at the end but for a part, the sine of the angle
/// by which their space turns. The rest is a parabola in t.
#[derive(Clone, Copy, Debug)]
pub struct LinearMotion {
    /// The least part of the squares of the singular values at start and end that those of D are there, without unit.
    kept: [f64; 2],
    /// An upper bound on the square of the norm of E, without unit.
    change: f64,
}

impl LinearMotion {
    /// Returns the motion between positions of the nodes, m. `struts`: the two nodes of each.
    pub fn new(struts: &[(usize, usize)], x: &[Vec3], y: &[Vec3]) -> LinearMotion {
        let mut shortest = [1.0f64; 2];
        let squares: Vec<f64> = struts
            .iter()
            .map(|&(a, b)| {
                let (from, to) = (x[b] - x[a], y[b] - y[a]);
                let lengths = [from.norm(), to.norm()];
                let longest = lengths[0].max(lengths[1]).max(f64::MIN_POSITIVE);
                shortest = [0, 1].map(|end| shortest[end].min(lengths[end] / longest));
                (to - from).norm_squared() / (longest * longest)
            })
            .collect();
        let norm = norm_bound(struts, x.len(), &squares);
        let [start, end] = shortest.map(|part| part * part);
        LinearMotion { kept: [start, end * turn_cosine_squared(x, y)], change: norm * norm }
    }

    /// Returns a lower bound on the singular value all the way, from bounds at the start and at the end; all without unit.
    pub fn least(&self, [begin, end]: [f64; 2]) -> f64 {
        let e = self.change;
        let [a, b] = [self.kept[0] * begin * begin, self.kept[1] * end * end];
        let t = if e > 0.0 { ((e + a - b) / (2.0 * e)).clamp(0.0, 1.0) } else { 0.0 };
        let least = a.min(b).min(a + t * (b - a) - t * (1.0 - t) * e);
        least.max(0.0).sqrt()
    }

    /// Returns the least bound at the end that, with one at the start, proves `floor` all the way; infinite if none does. All
    /// without unit.
    pub fn end_needed(&self, begin: f64, floor: f64) -> f64 {
        needed(self.kept, self.change, begin, floor)
    }

    /// Returns the least bound at the start that, with one at the end, proves `floor` all the way; infinite if none does. All
    /// without unit.
    pub fn start_needed(&self, end: f64, floor: f64) -> f64 {
        let [start, kept] = self.kept;
        needed([kept, start], self.change, end, floor)
    }
}

/// Returns the bound at one end of a motion that, with the bound `known` at the other, proves `floor` all the way. `kept`: the parts
/// that the squares keep at the known end and at the other; `change`: the square of the norm.
fn needed(kept: [f64; 2], change: f64, known: f64, floor: f64) -> f64 {
    let (above, least) = (kept[0] * known * known - floor * floor, floor * floor);
    if above < 0.0 || kept[1] <= 0.0 {
        return f64::INFINITY;
    }
    // The lowest point of the parabola touches the floor, or is at the other end or beyond.
    let beyond = (change.sqrt() - above.sqrt()).max(0.0);
    (1.0 + ROUNDING) * ((least + beyond * beyond) / kept[1]).sqrt()
}

/// Returns a lower bound on the square of the cosine of the greatest angle by which the rigid motions of nodes at `x` turn, in the
/// space of the displacements of all, until they are those of nodes at `y`, both in m: a rotation of the nodes by an angle displaces
/// them by no less than that times the root of their least moment of inertia, and it differs by no more than that times the
/// displacement of all.
fn turn_cosine_squared(x: &[Vec3], y: &[Vec3]) -> f64 {
    let count = x.len().max(1) as f64;
    let centre = x.iter().sum::<Vec3>() / count;
    let mean = x.iter().zip(y).map(|(p, q)| q - p).sum::<Vec3>() / count;
    let moved: f64 = x.iter().zip(y).map(|(p, q)| (q - p - mean).norm_squared()).sum();
    let squares: Matrix3<f64> = x.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
    let inertia = squares.trace() - squares.symmetric_eigenvalues().max();
    1.0 - (moved / inertia.max(f64::MIN_POSITIVE)).min(1.0)
}

/// Returns an upper bound on the norm of a matrix that has, like a rigidity matrix, for each strut a row with a vector e at one of its
/// two nodes and minus that at the other. `squares`: e² of each. For each strut `(e·(v_a - v_b))² ≤ e² (|v_a| + |v_b|)²`, so that the
/// square of the norm is at most the greatest eigenvalue of the nonnegative matrix M with e² for each strut, and the sums of these on
/// its diagonal; which is at most the greatest of `(M z)_i / z_i`, whatever the positive vector z (Collatz 1942).
pub(crate) fn norm_bound(struts: &[(usize, usize)], nodes: usize, squares: &[f64]) -> f64 {
    let mut z = vec![1.0; nodes];
    let mut bound = f64::INFINITY;
    for _ in 0..NORM_ITERATIONS {
        let mut next = vec![0.0; nodes];
        for (&(a, b), square) in struts.iter().zip(squares) {
            let both = square * (z[a] + z[b]);
            next[a] += both;
            next[b] += both;
        }
        let greatest = next.iter().zip(&z).map(|(next, z)| next / z).fold(0.0, f64::max);
        bound = greatest.min(bound);
        // No entry may become zero.
        z.iter_mut()
            .zip(&next)
            .for_each(|(z, next)| *z = (next / greatest.max(f64::MIN_POSITIVE)).max(Z_MIN));
    }
    bound.sqrt()
}
