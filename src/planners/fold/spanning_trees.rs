//! The number of layouts of a target: Kirchhoff's matrix-tree theorem in whole numbers.

use super::target::Target;
use num_bigint::BigInt;
use num_traits::{One, Zero};

/// Returns the number of layouts of a target without regard to their roots, which are the spanning trees of its
/// faces: the determinant of the Laplacian without one face (Kirchhoff's matrix-tree theorem), by elimination without
/// fractions (Bareiss 1968), in which every division is exact.
pub fn layouts(target: &Target) -> BigInt {
    let n = target.faces.len() - 1;
    let mut m = vec![vec![BigInt::zero(); n]; n];
    for hinge in &target.hinges {
        let [a, b] = hinge.faces;
        for (x, y) in [(a, b), (b, a)] {
            if x < n {
                m[x][x] += 1;
                if y < n {
                    m[x][y] -= 1;
                }
            }
        }
    }
    let mut before = BigInt::one();
    for k in 0..n {
        // The Laplacian without a face is positive definite: no pivot is zero.
        for i in k + 1..n {
            crate::interrupt::checkpoint();
            if m[i][k].is_zero() && m[k][k] == before {
                continue;
            }
            for j in k + 1..n {
                m[i][j] = (&m[i][j] * &m[k][k] - &m[i][k] * &m[k][j]) / &before;
            }
        }
        before = m[k][k].clone();
    }
    before
}
