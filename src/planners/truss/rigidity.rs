//! The least singular values of the rigidity matrix and their gradients over the nodes. If one is zero the
//! lengths of the struts no longer determine the positions of the nodes.
//!
//! The rigidity matrix R has a row for each strut with the unit vector along it at one node and minus that
//! at the other: R times the velocities of the nodes is the rates of length. It is the Jacobian of the
//! lengths.

use super::positions::halfway;
use super::structure::Structure;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::robot::truss_statics::{self as statics, Layout, LowerBound, Modes};
use nalgebra::{Matrix3, Rotation3};

/// The least singular value that planners keep where none is stated, without unit: the judge's default.
const KEPT: f64 = 0.05;
/// The part of the least singular value at the start that they keep if that is less.
const KEPT_PART: f64 = 0.125;

/// The multiple of what half a step may change a singular value by that a bound asks for beyond the limit, so that it
/// serves some steps.
const GAIN: f64 = 6.0;
/// The factors of that multiple where a bound held, and where it did not.
const GAIN_CHANGES: (f64, f64) = (1.5, 0.5);
/// The number of iterations for the bound on a change.
const CHANGE_ITERATIONS: usize = 8;
/// The least entry of its vector, of which the greatest is 1.
const Z_MIN: f64 = 0.01;
/// The number of checks after which more than the limit is asked again.
const MODEST_CHECKS: usize = 8;
/// The part of the limit that singular values keep between the ends and the middle of a step.
const DIP: f64 = 0.5;
/// The number of times that half a step is halved to find where they do not.
const HALVINGS: usize = 6;
/// The multiple of the limit above which singular values are of no interest.
const INTEREST: f64 = 2.0;

/// The part of the limit by which a singular value may be above it at the start of a step so that it has a row in the
/// next.
pub(super) const NEAR: f64 = 0.7;

/// A singular value of the rigidity matrix (the Jacobian of the strut lengths) with its singular vectors: over the
/// struts (left) and over the nodes' coordinates (right).
#[derive(Clone)]
pub(super) struct Mode {
    /// The singular value of the rigidity matrix, without unit.
    pub value: f64,
    struts: Vec<f64>,
    nodes: Vec<Vec3>,
}

/// Returns the modes of the `count` least singular values of the rigidity matrix with the nodes at `x` (m), in
/// ascending order, those of the six rigid motions left out. `known`: modes of nearby positions, from which the search
/// begins, and which become these.
pub(super) fn weakest(truss: &Structure, x: &[Vec3], count: usize, known: &mut Modes) -> Vec<Mode> {
    let along = |strut: usize| {
        let (a, b) = truss.struts[strut];
        (a, b, (x[a] - x[b]).normalize())
    };
    let mode = |mode: statics::Mode| {
        let nodes = mode.nodes;
        let strut = |(a, b, e): (usize, usize, Vec3)| {
            e.dot(&(nodes[a] - nodes[b])) / mode.value.max(f64::MIN_POSITIVE)
        };
        let struts = (0..truss.struts.len()).map(along).map(strut).collect();
        Mode { value: mode.value, struts, nodes }
    };
    known.weakest(&truss.layout, x, &truss.struts, count).into_iter().map(mode).collect()
}

/// Returns the least singular value of the rigidity matrix with the nodes at `x`, m, those of rigid motions left out; `None` of
/// a truss that has no other. `known`: modes of nearby positions, from which the search begins, and which become these.
pub(super) fn least(truss: &Structure, x: &[Vec3], known: &mut Modes) -> Option<f64> {
    known.least(&truss.layout, x, &truss.struts)
}

/// Returns modes for the search of steps, which need not know what is far above the limit of the truss.
pub(super) fn coarse(known: Modes, truss: &Structure) -> Modes {
    known.coarse(INTEREST * truss.limits.rigidity)
}

/// Returns the limit on the least singular value of the rigidity matrix, without unit, that the planners keep where
/// none is stated: 0.05, or an eighth of the value at the start if that is less; 0, for no limit, for a truss that is
/// not rigid at the start. `start`: the positions of the nodes, m; `struts`: the two nodes of each, which must be apart.
pub fn kept(start: &[Vec3], struts: &[(usize, usize)]) -> f64 {
    if struts.iter().any(|&(a, b)| start[a] == start[b]) {
        return 0.0;
    }
    let layout = Layout::new(start.len(), struts);
    let modes = Modes::default().coarse(f64::INFINITY).weakest(&layout, start, struts, 1);
    let least = modes.first().map_or(0.0, |mode| mode.value);
    if least > Tolerances::DEFAULT.not_rigid { KEPT.min(KEPT_PART * least) } else { 0.0 }
}

/// Returns the index of the node that moves farthest in the mode of the least singular value, with the nodes at `x`, m.
pub(in crate::planners) fn weakest_node(truss: &Structure, x: &[Vec3]) -> usize {
    let modes = weakest(truss, x, 1, &mut Modes::default());
    let moves = |node: &usize| modes.first().map_or(0.0, |mode| mode.nodes[*node].norm());
    (0..truss.nodes).max_by(|a, b| moves(a).total_cmp(&moves(b))).unwrap_or(0)
}

/// A lower bound on the least singular value of the rigidity matrix that belongs to no rigid motion, at some positions of the
/// nodes. It serves all positions that the nodes reach before directions of struts have changed by as much as is to
/// spare.
#[derive(Clone, Debug)]
pub(super) struct Bound {
    /// The positions, m; empty for no bound.
    x: Vec<Vec3>,
    /// The bound there, without unit.
    least: f64,
    /// The positions, m, at which the last step ended that kept the limit, with a bound there, without unit; empty for none.
    stood: (Vec<Vec3>, f64),
    /// The multiple that is asked for the next time.
    gain: f64,
    /// The number of checks for which nothing more than the limit is asked, since more did not hold.
    modest: usize,
    /// The modes of the least singular value at the end of the last step.
    modes: Modes,
    /// The least singular value there, without unit; `None` where it is not known.
    value: Option<f64>,
    /// The positions, m, at which a bound near that value was looked for last, with it.
    near: Option<(Vec<Vec3>, Option<LowerBound>)>,
}

impl Default for Bound {
    fn default() -> Bound {
        Bound {
            x: Vec::new(),
            least: 0.0,
            stood: (Vec::new(), 0.0),
            gain: GAIN,
            modest: 0,
            modes: Modes::default(),
            value: None,
            near: None,
        }
    }
}

impl Bound {
    /// Returns those of the positions `y` and half-way to them from `x` (m) at which a singular value is below the limit
    /// of the truss, or within rounding of it; if it is clearly below at none, others on the way at which it is far below.
    pub(super) fn violated(&mut self, truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<Vec<Vec3>> {
        let limit = truss.limits.rigidity;
        let middle = halfway(x, y);
        let bound = |bound: &Bound, z: &[Vec3]| bound.least - change(truss, &bound.x, z);
        if self.x.len() == y.len() {
            let [half, end] = [&middle, y].map(|z| bound(self, z));
            if half >= limit && end >= limit {
                return self.dips(truss, x, (&middle, half), (y, end));
            }
        }
        let back = change(truss, y, &middle);
        // A bound near the value of the step before serves its margin, too.
        let near = self.near_value(truss, y);
        if near >= limit + back {
            (self.x, self.least) = (y.to_vec(), near);
            return self.dips(truss, x, (&middle, near - back), (y, near));
        }
        // As much more as serves the middle and some steps to come.
        while self.modest == 0 {
            let asked = limit + self.gain * back;
            if is_above(truss, y, asked) {
                self.gain *= GAIN_CHANGES.0;
                (self.x, self.least) = (y.to_vec(), asked);
                return self.dips(truss, x, (&middle, asked - back), (y, asked));
            }
            // Little more than the middle needs would not serve another step.
            self.gain *= GAIN_CHANGES.1;
            if self.gain < 1.0 {
                (self.gain, self.modest) = (GAIN, MODEST_CHECKS);
            }
        }
        self.modest = self.modest.saturating_sub(1);
        self.x.clear();
        let is_low = |z: &&[Vec3]| !is_above(truss, z, limit);
        let low: Vec<Vec<Vec3>> = [y, &middle].into_iter().filter(is_low).map(<[Vec3]>::to_vec).collect();
        // Nothing is asked of a step that ends within rounding of the limit, and it may be below on the way.
        let clearly = clear_limit(truss);
        if low.iter().any(|z| !is_above(truss, z, clearly)) {
            return low;
        }
        [low, self.dips(truss, x, (&middle, clearly), (y, clearly))].concat()
    }

    /// Returns a lower bound near the least singular value at the end of the last step, proved with the nodes at `y` (m); 0 where
    /// there is none.
    fn near_value(&mut self, truss: &Structure, y: &[Vec3]) -> f64 {
        let bound = self.value.and_then(|value| LowerBound::near(&truss.layout, y, &truss.struts, value));
        let value = bound.as_ref().map_or(0.0, |bound| bound.value);
        self.near = Some((y.to_vec(), bound));
        value
    }

    /// Proves the bound with which the search for the least singular value at `y` (m) begins.
    pub(super) fn prepare(&mut self, truss: &Structure, y: &[Vec3]) {
        if self.near.as_ref().is_none_or(|(x, _)| x != y) {
            self.near_value(truss, y);
        }
    }

    /// Returns the least singular value at the end `y` (m) of a step that is made; `None` where the truss has no other than those of
    /// rigid motions. The decomposition that proved its limit serves again.
    pub(super) fn least(&mut self, truss: &Structure, y: &[Vec3]) -> Option<f64> {
        self.prepare(truss, y);
        let (layout, struts) = (&truss.layout, &truss.struts);
        let near = self.near.take().and_then(|(_, bound)| bound);
        let known = near.as_ref().and_then(|bound| self.modes.least_above(layout, y, struts, bound));
        self.value = known.or_else(|| self.modes.least_anew(layout, y, struts));
        if let Some(bound) = near {
            (self.x, self.least) = (y.to_vec(), bound.value);
        }
        self.value
    }

    /// Returns positions on the way from `x` (m) over the middle to the end at which a singular value is far below the limit of
    /// the truss, as [`dips`] has it. `middle` and `end`: the positions there, m, with lower bounds on the singular value.
    fn dips(
        &mut self,
        truss: &Structure,
        x: &[Vec3],
        (middle, half): (&[Vec3], f64),
        (y, end): (&[Vec3], f64),
    ) -> Vec<Vec<Vec3>> {
        let change = change_rate(truss, x, y) / 2.0;
        // The start tells of the way to the middle what this does not.
        let first = if half - change >= DIP * truss.limits.rigidity {
            Vec::new()
        } else {
            dips(truss, (x, self.at_start(truss, x)), (middle, half), change, HALVINGS)
        };
        let found =
            if first.is_empty() { dips(truss, (middle, half), (y, end), change, HALVINGS) } else { first };
        if found.is_empty() {
            self.stood = (y.to_vec(), end);
        }
        found
    }

    /// Returns a lower bound on the least singular value at the start of a step, m: one begins as the one before ended, but for the
    /// first and after rolls.
    fn at_start(&self, truss: &Structure, x: &[Vec3]) -> f64 {
        let (clearly, floor) = (clear_limit(truss), DIP * truss.limits.rigidity);
        let (stood, bound) = &self.stood;
        if stood == x {
            bound.max(clearly)
        } else if is_above(truss, x, clearly) {
            clearly
        } else if is_above(truss, x, floor) {
            floor
        } else {
            0.0
        }
    }
}

/// Returns positions on the way from `x` to `y`, both with a lower bound on the least singular value there, at which it is below
/// [`DIP`] of the limit of the truss, or may be near them after so many halvings of the way; none only if bounds on what it
/// changes by prove that there are none. `change`: an upper bound on what it changes by for each way of this length. With the
/// bounds at both ends it is nowhere less than half of their sum without half of that.
fn dips(
    truss: &Structure,
    (x, begin): (&[Vec3], f64),
    (y, end): (&[Vec3], f64),
    change: f64,
    halvings: usize,
) -> Vec<Vec<Vec3>> {
    let floor = DIP * truss.limits.rigidity;
    if begin + end - change >= 2.0 * floor {
        return Vec::new();
    }
    let middle = halfway(x, y);
    // Both halves are proved by so much in the middle.
    let enough = 2.0 * floor + change / 2.0 - begin.min(end);
    let asked = enough.clamp(floor, truss.limits.rigidity.max(floor));
    let half = if is_above(truss, &middle, asked) {
        asked
    } else if asked > floor && is_above(truss, &middle, floor) {
        floor
    } else {
        return vec![middle];
    };
    if half >= enough {
        return Vec::new();
    }
    // A way that is not proved counts as violated, as by the judge.
    if halvings == 0 {
        return vec![middle];
    }
    let first = dips(truss, (x, begin), (&middle, half), change / 2.0, halvings - 1);
    if first.is_empty() { dips(truss, (&middle, half), (y, end), change / 2.0, halvings - 1) } else { first }
}

/// Returns the value below which a singular value is clearly below the limit of the truss, without unit.
fn clear_limit(truss: &Structure) -> f64 {
    truss.limits.rigidity - 2.0 * truss.tolerances.rounding
}

/// Returns true if no more singular values of the rigidity matrix than the six of rigid motions are below a limit.
fn is_above(truss: &Structure, x: &[Vec3], limit: f64) -> bool {
    LowerBound::new(&truss.layout, x, &truss.struts, limit).is_some()
}

/// Returns an upper bound on what any singular value of the rigidity matrix changes by between two positions of the nodes,
/// m: the norm of the change E of the matrix (Weyl 1912), after a rotation of the whole truss, which changes none. For
/// each strut, `(e·(v_a - v_b))² ≤ e² (|v_a| + |v_b|)²`, so that the square of that norm is at most the greatest
/// eigenvalue of the nonnegative matrix M with e² for each strut, and the sums of these on its diagonal; which is at most
/// the greatest of `(M z)_i / z_i`, whatever the positive vector z (Collatz 1942).
fn change(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> f64 {
    let directions = directions(truss, x, y);
    let turn = rotation(&directions);
    let squares = directions.iter().map(|(from, to)| (to - turn * from).norm_squared());
    change_norm(truss, &squares.collect::<Vec<f64>>())
}

/// Returns an upper bound on what any singular value changes by between any two moments of the straight way from `x` to `y`, m, for
/// each part of the whole time between them: as [`change`], by how fast each strut turns at most. A strut with the vector d
/// along it turns at the rate `|d × d'| / d²`, of which the numerator does not change. A rotation of the whole truss is not
/// taken out, since that which suits one moment suits no other.
fn change_rate(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> f64 {
    let squares = truss.struts.iter().map(|&(a, b)| {
        let (from, to) = (x[b] - x[a], y[b] - y[a]);
        let change = to - from;
        let part = (-from.dot(&change) / change.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let nearest = (from + change * part).norm_squared();
        from.cross(&to).norm_squared() / (nearest * nearest).max(f64::MIN_POSITIVE)
    });
    change_norm(truss, &squares.collect::<Vec<f64>>())
}

/// Returns the directions of the struts at two positions of the nodes, m.
fn directions(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<(Vec3, Vec3)> {
    let along = |x: &[Vec3], &(a, b): &(usize, usize)| (x[b] - x[a]).normalize();
    truss.struts.iter().map(|ends| (along(x, ends), along(y, ends))).collect()
}

/// Returns the bound of [`change`] on the norm, for the squares of what the directions of struts change by.
fn change_norm(truss: &Structure, squares: &[f64]) -> f64 {
    let mut z = vec![1.0; truss.nodes];
    let mut bound = f64::INFINITY;
    for _ in 0..CHANGE_ITERATIONS {
        let mut next = vec![0.0; truss.nodes];
        for (&(a, b), square) in truss.struts.iter().zip(squares) {
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

/// Returns the rotation that brings directions nearest to others, by least squares (Horn 1987), from the average of where
/// they are turned to; none where that does not tell.
fn rotation(directions: &[(Vec3, Vec3)]) -> Rotation3<f64> {
    let sum: Matrix3<f64> = directions.iter().map(|(from, to)| to * from.transpose()).sum();
    let svd = sum.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Rotation3::identity() };
    let sign = (u * v).determinant().signum();
    let weakest = svd.singular_values.imin();
    let mut flips = Vec3::repeat(1.0);
    flips[weakest] = sign;
    Rotation3::from_matrix_unchecked(u * Matrix3::from_diagonal(&flips) * v)
}

/// Returns mode i (an index in `modes`) for i = j, else the normalised sum (i < j) or difference (i > j) of two modes,
/// as in [`Constraint::Rigidity`](super::constraint::Constraint). If two singular values nearly coincide, their vectors
/// are any two of the plane that they span, and a step that keeps both values may still lower one in between. Panics if
/// there is no such mode.
pub(super) fn joined(modes: &[Mode], i: usize, j: usize) -> Mode {
    if i == j {
        return modes[i].clone();
    }
    let (a, b) = (&modes[i.min(j)], &modes[i.max(j)]);
    let sign = if i < j { 1.0 } else { -1.0 };
    let part = std::f64::consts::FRAC_1_SQRT_2;
    Mode {
        value: (a.value + b.value) / 2.0,
        struts: a.struts.iter().zip(&b.struts).map(|(p, q)| (p + sign * q) * part).collect(),
        nodes: a.nodes.iter().zip(&b.nodes).map(|(p, q)| (p + q * sign) * part).collect(),
    }
}

impl Mode {
    /// Returns the amount by which the singular value is above its limit
    /// [`Limits::rigidity`](super::structure::Limits), times the unit length of the truss, m; negative if it is below.
    pub(super) fn spare(&self, truss: &Structure) -> f64 {
        (self.value - truss.limits.rigidity) * truss.unit
    }

    /// Returns the gradient of the singular value times the unit length over the positions of the nodes, `uᵀ dR v`, as
    /// (index of a node, derivative by its position), without unit. `x`: the positions, m.
    pub(super) fn gradient(&self, truss: &Structure, x: &[Vec3]) -> Vec<(usize, Vec3)> {
        let mut sums = vec![Vec3::zeros(); truss.nodes];
        for (strut, &(a, b)) in truss.struts.iter().enumerate() {
            let d = x[a] - x[b];
            let e = d.normalize();
            let turns = self.nodes[a] - self.nodes[b];
            let pushed = (turns - e * e.dot(&turns)) * (self.struts[strut] * truss.unit / d.norm());
            sums[a] += pushed;
            sums[b] -= pushed;
        }
        sums.into_iter().enumerate().collect()
    }
}
