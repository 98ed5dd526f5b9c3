//! A bound on the distance of two lines while points of them move linearly.

use super::closest_points::Segment;
use super::pose::Vec3;

/// Threshold: the squared sine of the angle of two lines, without unit, up to which rounding may tell what their distance is: at an
/// angle of 1e-3 rad it changes the distance by a part of 1e-13.
const TOL_CROSSING_SINE_SQUARED: f64 = 1e-6;

/// A segment at the start and at the end of a linear motion of its ends.
pub type MovingSegment = (Segment, Segment);

/// Returns true if the lines through two segments of one frame (m), and so the segments, are proved to stay at least `apart` (m)
/// from each other while the ends of the segments move linearly. Of lines that are nearly parallel at some time nothing is proved.
/// With the vectors u and v along them and w from one to the other, the square of the distance is `(w·n)² / n²` for `n = u × v`.
/// Over time n is a quadratic and `w·n` a cubic polynomial; a polynomial is nowhere less than the least of its coefficients in
/// Bernstein's basis (Farouki 2012).
pub fn lines_stay_apart((p_from, p_to): MovingSegment, (q_from, q_to): MovingSegment, apart: f64) -> bool {
    let along = |(a, b): Segment| b - a;
    let (u, v) = ([along(p_from), along(p_to)], [along(q_from), along(q_to)]);
    let w = [p_from.0 - q_from.0, p_to.0 - q_to.0];
    // The coefficients of n, of n² and of w·n.
    let n = [u[0].cross(&v[0]), (u[0].cross(&v[1]) + u[1].cross(&v[0])) / 2.0, u[1].cross(&v[1])];
    let squares = [
        n[0].norm_squared(),
        n[0].dot(&n[1]),
        (n[0].dot(&n[2]) + 2.0 * n[1].norm_squared()) / 3.0,
        n[1].dot(&n[2]),
        n[2].norm_squared(),
    ];
    let longest = |ends: &[Vec3; 2]| ends[0].norm_squared().max(ends[1].norm_squared());
    let least = TOL_CROSSING_SINE_SQUARED * longest(&u) * longest(&v);
    if squares.iter().any(|square| *square <= least) {
        return false;
    }
    let f = [
        w[0].dot(&n[0]),
        (w[1].dot(&n[0]) + 2.0 * w[0].dot(&n[1])) / 3.0,
        (2.0 * w[1].dot(&n[1]) + w[0].dot(&n[2])) / 3.0,
        w[1].dot(&n[2]),
    ];
    // The coefficients of (w·n)² and of n², both of degree 6.
    let products = [
        f[0] * f[0],
        f[0] * f[1],
        (3.0 * f[1] * f[1] + 2.0 * f[0] * f[2]) / 5.0,
        (9.0 * f[1] * f[2] + f[0] * f[3]) / 10.0,
        (3.0 * f[2] * f[2] + 2.0 * f[1] * f[3]) / 5.0,
        f[2] * f[3],
        f[3] * f[3],
    ];
    let [a, b, c, d, e] = squares;
    let raised = [
        a,
        (a + 2.0 * b) / 3.0,
        (a + 8.0 * b + 6.0 * c) / 15.0,
        (b + 3.0 * c + d) / 5.0,
        (e + 8.0 * d + 6.0 * c) / 15.0,
        (e + 2.0 * d) / 3.0,
        e,
    ];
    products.iter().zip(&raised).all(|(product, square)| *product >= apart * apart * square)
}
