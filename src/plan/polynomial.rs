//! Polynomials over 0..1 in Bernstein form, the pieces of trajectories, given by their control points: these bound
//! the values, the first and the last are the values at the ends, and reversing them reverses the argument.

/// The greatest degree of a polynomial segment in a plan.
pub const DEGREE_MAX: usize = 15;

/// Returns the value at the argument `u` of the polynomial with these Bernstein control points, by de Casteljau's
/// algorithm, in their unit: exact at both ends, and that of the nearer end outside 0..1. Panics without control
/// points, or with more than [`DEGREE_MAX`] + 1.
pub fn value(control: &[f64], u: f64) -> f64 {
    if u <= 0.0 {
        return control[0];
    }
    if u >= 1.0 {
        return control[control.len() - 1];
    }
    value_and_rate(control, u).0
}

/// Returns the value at the argument `u` as [`value`] does, and the derivative with respect to the argument there.
pub fn value_and_rate(control: &[f64], u: f64) -> (f64, f64) {
    let degree = control.len() - 1;
    if degree == 0 {
        return (control[0], 0.0);
    }
    let u = u.clamp(0.0, 1.0);
    let mut stack = [0.0; DEGREE_MAX + 1];
    let points = &mut stack[..=degree];
    points.copy_from_slice(control);
    for last in (2..=degree).rev() {
        for i in 0..last {
            points[i] = mix(points[i], points[i + 1], u);
        }
    }
    // The last two points are on the tangent.
    (mix(points[0], points[1], u), degree as f64 * (points[1] - points[0]))
}

/// Returns (before, after): the parts of a polynomial before and after the argument `u` (0 to 1) as Bernstein control
/// points, by de Casteljau's algorithm, each over 0..1 and of the same degree. They share the value at `u` to the bit.
/// `control`: the polynomial's control points.
pub fn split(control: &[f64], u: f64) -> (Vec<f64>, Vec<f64>) {
    let mut right = control.to_vec();
    let mut left = Vec::with_capacity(control.len());
    for last in (0..right.len()).rev() {
        left.push(right[0]);
        for i in 0..last {
            right[i] = mix(right[i], right[i + 1], u);
        }
    }
    (left, right)
}

/// Returns the part of a polynomial between the arguments `u0` and `u1` as Bernstein control points over 0..1.
/// `control`: its control points, at least one; `u0 <= u1`, with `u1` not below 0 and `u0` not above 1. A `u0` below
/// 0 counts as 0, a `u1` above 1 as 1.
pub fn part(control: &[f64], u0: f64, u1: f64) -> Vec<f64> {
    let mut points = control.to_vec();
    if u1 < 1.0 {
        points = split(&points, u1).0;
    }
    if u0 > 0.0 {
        points = split(&points, u0 / u1.min(1.0)).1;
    }
    points
}

/// Returns the derivative with respect to the argument, as Bernstein control points over 0..1; that of a constant is
/// `[0]`. Panics without control points.
pub fn derivative(control: &[f64]) -> Vec<f64> {
    let degree = control.len() - 1;
    if degree == 0 {
        return vec![0.0];
    }
    control.windows(2).map(|w| degree as f64 * (w[1] - w[0])).collect()
}

/// Returns (lowest, highest) of the control points, which bound every value over 0..1 (the convex hull property of
/// Bernstein polynomials); infinity and minus infinity without any.
pub fn hull(control: &[f64]) -> (f64, f64) {
    control.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| (low.min(c), high.max(c)))
}

/// Returns the Bernstein control points of the same polynomial at the degree `degree` (degree elevation); unchanged if
/// its degree is no lower. Panics without control points.
pub fn elevated(control: &[f64], degree: usize) -> Vec<f64> {
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

/// Returns the composition `p(r(w))` of the polynomial with these control points and `r`, which is quadratic with the
/// control points `[0, middle, 1]` (`middle` from 0 to 1), as control points over 0..1 of twice the degree. The method
/// is de Casteljau's rule with products of polynomials in Bernstein form (DeRose 1988): each step is a convex
/// combination, so that the hull of the control points does not grow, and both ends are exact. Panics without control
/// points.
pub fn composed(control: &[f64], middle: f64) -> Vec<f64> {
    let law = [0.0, middle, 1.0];
    let mut points: Vec<Vec<f64>> = control.iter().map(|c| vec![*c]).collect();
    while points.len() > 1 {
        points = points.windows(2).map(|w| mixed(&w[0], &w[1], &law)).collect();
    }
    points.pop().expect("a polynomial has a control point")
}

/// Returns `(1 - r) a + r b` for polynomials `a` and `b` of one degree and a quadratic `r`, in Bernstein form.
fn mixed(a: &[f64], b: &[f64], r: &[f64; 3]) -> Vec<f64> {
    let degree = a.len() - 1;
    let (inner, outer) = (binomials(degree), binomials(degree + 2));
    let weight = |k: usize, j: usize| inner[k - j] * [1.0, 2.0, 1.0][j] / outer[k];
    let point = |k: usize| {
        let terms = (0..3).filter(|&j| j <= k && k - j <= degree);
        terms.map(|j| weight(k, j) * ((1.0 - r[j]) * a[k - j] + r[j] * b[k - j])).sum()
    };
    (0..=degree + 2).map(point).collect()
}

/// Returns the binomial coefficients of a degree.
fn binomials(degree: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for k in 0..degree {
        row.push(row[k] * (degree - k) as f64 / (k + 1) as f64);
    }
    row
}

/// The greatest number of pieces that are examined before the bound is taken instead of the value.
const PIECES_MAX: usize = 4096;

/// Returns (value, argument) of the greatest value over 0..1 of a polynomial, found to a tolerance by subdivision (the
/// convex hull property). The value is below the true one by no more than the fraction `tolerance` of the largest
/// control point, and above it by no more than rounding, unless a polynomial is so oscillatory that the pieces run
/// out. `control`: its Bernstein control points, at least one.
pub fn greatest(control: &[f64], tolerance: f64) -> (f64, f64) {
    let size = control.iter().fold(0.0_f64, |s, c| s.max(c.abs()));
    let (first, last) = (control[0], control[control.len() - 1]);
    let mut best = if last > first { (last, 1.0) } else { (first, 0.0) };
    let mut open = vec![(control.to_vec(), 0.0, 1.0)];
    for _ in 0..PIECES_MAX {
        let Some((points, from, to)) = open.pop() else { return best };
        if hull(&points).1 <= best.0 + tolerance * size {
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

/// Returns (value, argument) of the greatest absolute value over 0..1 of a polynomial, found as by [`greatest`].
/// `control`: its Bernstein control points; `tolerance`: as for [`greatest`].
pub fn greatest_size(control: &[f64], tolerance: f64) -> (f64, f64) {
    let up = greatest(control, tolerance);
    let negated: Vec<f64> = control.iter().map(|c| -c).collect();
    let down = greatest(&negated, tolerance);
    if down.0 > up.0 { down } else { up }
}

/// The greatest number of bisections of an interval for a root: to the last bit of the argument.
const HALVINGS_MAX: usize = 60;

/// Returns the arguments in 0..1 at which the polynomial passes through zero, ascending: the control points are halved
/// until they change sign once or not at all. Roots at the ends, and arguments at which it touches zero without
/// passing through, may be missing; roots that `HALVINGS_MAX` halvings do not part may be found as one.
pub fn roots(control: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    // The part furthest left is on top.
    let mut parts = vec![(control.to_vec(), 0.0, 1.0, 0)];
    while let Some((points, from, to, depth)) = parts.pop() {
        match sign_changes(&points) {
            0 => {}
            1 if passes(&points) => found.push(from + (to - from) * bisect(&points)),
            _ if depth == HALVINGS_MAX => found.push((from + to) / 2.0),
            _ => {
                let (left, right) = split(&points, 0.5);
                let middle = (from + to) / 2.0;
                // A root exactly in the middle belongs to neither part's inside.
                let zero = right[0] == 0.0;
                parts.push((right, middle, to, depth + 1));
                if zero {
                    parts.push((vec![-1.0, 1.0], middle, middle, depth + 1));
                }
                parts.push((left, from, middle, depth + 1));
            }
        }
    }
    found
}

fn sign_changes(points: &[f64]) -> usize {
    let mut signs = points.iter().filter(|p| **p != 0.0).map(|p| *p > 0.0);
    let Some(mut last) = signs.next() else { return 0 };
    let mut changes = 0;
    for sign in signs {
        changes += usize::from(sign != last);
        last = sign;
    }
    changes
}

/// Returns true if the values at the ends have different signs, and neither is 0.
fn passes(points: &[f64]) -> bool {
    let (first, last) = (points[0], points[points.len() - 1]);
    first != 0.0 && last != 0.0 && (first < 0.0) != (last < 0.0)
}

/// Returns the root between two ends of different sign.
fn bisect(points: &[f64]) -> f64 {
    let rising = points[0] < 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS_MAX {
        let middle = (low + high) / 2.0;
        if (value(points, middle) < 0.0) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

fn mix(a: f64, b: f64, u: f64) -> f64 {
    a + (b - a) * u
}
