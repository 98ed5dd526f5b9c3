//! Greatest values of polynomials in Bernstein form, to within a bound: proved, not sampled.

use super::tolerances::NUMERICS;
use crate::plan::polynomial::{hull, split};

/// The greatest number of pieces that are examined before the bound is taken instead of the value.
const PIECES_MAX: usize = 4096;

/// Returns the greatest value over 0..1 of a polynomial, given by its Bernstein control points (at least one), and the
/// argument where it is reached, by subdivision (the convex hull property). The value is below the true one by no more
/// than `NUMERICS.extremum` of the largest control point, and
/// above it by no more than rounding, unless a polynomial is so oscillatory that the pieces run out.
pub(super) fn greatest(control: &[f64]) -> (f64, f64) {
    let size = control.iter().fold(0.0_f64, |s, c| s.max(c.abs()));
    let (first, last) = (control[0], control[control.len() - 1]);
    let mut best = if last > first { (last, 1.0) } else { (first, 0.0) };
    let mut open = vec![(control.to_vec(), 0.0, 1.0)];
    for _ in 0..PIECES_MAX {
        let Some((points, from, to)) = open.pop() else { return best };
        if hull(&points).1 <= best.0 + NUMERICS.extremum * size {
            continue;
        }
        let middle = (from + to) / 2.0;
        let (left, right) = split(&points, 0.5);
        if right[0] > best.0 {
            best = (right[0], middle);
        }
        open.push((right, middle, to));
        open.push((left, from, middle));
    }
    let bound = open.iter().map(|(points, from, _)| (hull(points).1, *from));
    bound.fold(best, |best, piece| if piece.0 > best.0 { piece } else { best })
}

/// Returns the Bernstein control points of the same polynomial at the degree `degree` (degree elevation); unchanged if
/// its degree is no lower.
pub(super) fn elevated(control: &[f64], degree: usize) -> Vec<f64> {
    let mut points = control.to_vec();
    while points.len() <= degree {
        let n = points.len() as f64;
        let inner = points.windows(2).enumerate().map(|(i, w)| {
            let part = (i + 1) as f64 / n;
            part * w[0] + (1.0 - part) * w[1]
        });
        let ends = (points[0], points[points.len() - 1]);
        points = std::iter::once(ends.0).chain(inner).chain([ends.1]).collect();
    }
    points
}
