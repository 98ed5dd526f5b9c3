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
use crate::robot::truss_statics::{
    self as statics, Layout, LinearMotion, LowerBound, Modes, ShiftedFactor, norm_bound,
};
use nalgebra::{Matrix3, Rotation3};

/// The least singular value that planners keep where none is stated, without unit: the judge's default.
const KEPT: f64 = 0.05;
/// The part of the least singular value at the start that they keep if that is less.
const KEPT_PART: f64 = 0.125;

/// The part of the limit that singular values keep between the ends and the middle of a step.
const DIP: f64 = 0.5;
/// The part of the limit that they must keep at moments between that are looked at: from right at [`DIP`] nothing would be proved of
/// the moments beside.
const DIP_CLEAR: f64 = 0.6;
/// The multiple of the bounds at the ends of a way that is likely half-way.
const LIKELY: f64 = 1.2;
/// The number of times that half a step is halved to find where they do not.
const HALVINGS: usize = 6;
/// The parts of the least singular value by which it is supposed to fall in a step: what is added to twice what it fell by in the last,
/// and the most.
const FALLS: (f64, f64) = (0.01, 0.05);
/// The parts of the bound asked for far above the limit by which it changes: after it was proved, and after it was not.
const HOPES: (f64, f64) = (1.05, 0.8);
/// The multiple of the limit up to which no more than the limit is asked for.
const HOPELESS: f64 = 1.2;
/// The part of the limit near which singular values are looked for where none is known.
const LOOKED_NEAR: f64 = 0.9;
/// The multiple of the limit above which singular values are of no interest.
const INTEREST: f64 = 2.0;

/// The part of the limit by which a singular value may be above it at the start of a step so that it has a row in the
/// next.
pub(super) const NEAR: f64 = 0.7;

/// The number of singular values of the rigidity matrix that are constrained: the least often come several together.
pub(super) const MODES: usize = 4;

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
/// ascending order, those of the six rigid motions left out.
pub(super) fn weakest(truss: &Structure, x: &[Vec3], count: usize) -> Vec<Mode> {
    with_struts(truss, x, Modes::default().weakest(&truss.layout, x, &truss.struts, count))
}

/// Returns modes with their left singular vectors.
fn with_struts(truss: &Structure, x: &[Vec3], modes: Vec<statics::Mode>) -> Vec<Mode> {
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
    modes.into_iter().map(mode).collect()
}

/// Returns the least singular value of the rigidity matrix with the nodes at `x`, m, those of rigid motions left out; `None` of
/// a truss that has no other. `known`: modes of nearby positions, from which the search begins, and which become these.
pub(super) fn least(truss: &Structure, x: &[Vec3], known: &mut Modes) -> Option<f64> {
    known.least(&truss.layout, x, &truss.struts)
}

/// Returns the limit on the least singular value of the rigidity matrix, without unit, that the planners keep where
/// none is stated: 0.05, or an eighth of the value at the start if that is less; 0, for no limit, for a truss that is
/// not rigid at the start. `start`: the positions of the nodes, m; `struts`: the two nodes of each, which must be apart.
pub fn kept(start: &[Vec3], struts: &[(usize, usize)]) -> f64 {
    if struts.iter().any(|&(a, b)| start[a] == start[b]) {
        return 0.0;
    }
    let layout = Layout::new(start.len(), struts);
    let least = Modes::default().least_anew(&layout, start, struts).unwrap_or(0.0);
    if least > Tolerances::DEFAULT.not_rigid { KEPT.min(KEPT_PART * least) } else { 0.0 }
}

/// Returns the index of the node that moves farthest in the mode of the least singular value, with the nodes at `x`, m.
pub(in crate::planners) fn weakest_node(truss: &Structure, x: &[Vec3]) -> usize {
    let modes = weakest(truss, x, 1);
    let moves = |node: &usize| modes.first().map_or(0.0, |mode| mode.nodes[*node].norm());
    (0..truss.nodes).max_by(|a, b| moves(a).total_cmp(&moves(b))).unwrap_or(0)
}

/// A result that belongs to positions of the nodes, m; to none at first.
#[derive(Clone, Debug, Default)]
struct At<T>(Vec<Vec3>, T);

impl<T> At<T> {
    /// Returns the result if it belongs to these positions, m.
    fn get(&self, x: &[Vec3]) -> Option<&T> {
        (self.0 == x).then_some(&self.1)
    }
}

/// The rigidity at the start of a step, without unit.
#[derive(Clone, Copy, Debug, Default)]
struct Start {
    /// A lower bound on the least singular value.
    bound: f64,
    /// The least singular value, and the part of it by which it fell in the step before; `None` where it is not known.
    value: Option<(f64, f64)>,
}

/// The rigidity known from positions nearby: the least singular value of the rigidity matrix that belongs to no rigid motion, or a
/// lower bound on it, which serves all positions that the nodes reach before directions of struts have changed by as much as is to
/// spare, and the modes found last. All values are without unit.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// The bound proved last.
    bound: At<f64>,
    /// A bound where the last step ended that kept the limit.
    stood: At<f64>,
    /// The modes found last.
    modes: Modes,
    /// The rigidity at the start of the step.
    start: At<Start>,
    /// The least singular value found last.
    found: At<Option<f64>>,
    /// The bound near the value at the start that was looked for last.
    near: At<Option<LowerBound>>,
    /// The bound that is asked for where the value at the start is not known; `None` before the first.
    hope: Option<f64>,
}

impl Known {
    /// Returns those of the positions `y` and half-way to them from `x` (m) at which a singular value is below the limit
    /// of the truss; if there are none, others on the way at which it is far below.
    pub(super) fn violated(&mut self, truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<Vec<Vec3>> {
        let limit = kept_limit(truss);
        let middle = halfway(x, y);
        if self.hope.is_none() {
            self.hope = Some(HOPES.1 * self.value_at(truss, x).unwrap_or(0.0));
        }
        self.begin(truss, x);
        if self.bound.0.len() == y.len() {
            let [half, end] = [&middle, y].map(|z| self.bound.1 - change(truss, &self.bound.0, z));
            if half >= limit && end >= limit {
                return self.dips(truss, x, (&middle, half), (y, end));
            }
        }
        let back = change(truss, y, &middle);
        let proved = match self.start.1.value {
            Some(_) => self.near_value(truss, y),
            None => self.hoped(truss, y),
        };
        if proved >= limit + back {
            self.hope = self.hope.map(|hope| hope.max(proved));
            self.bound = At(y.to_vec(), proved);
            return self.dips(truss, x, (&middle, proved - back), (y, proved));
        }
        // Near the limit the value itself tells more than bounds; it takes long where none leads to it.
        let near = self.near.get(y).is_some_and(Option::is_some);
        let end = if near { self.value_at(truss, y).unwrap_or(0.0) } else { proved };
        self.bound = At(y.to_vec(), end);
        let half = if end - back >= limit { end - back } else { first_proved(truss, &middle, &[limit]) };
        let low: Vec<Vec<Vec3>> = [(y, end), (&middle, half)]
            .iter()
            .filter(|(_, bound)| *bound < limit)
            .map(|(z, _)| z.to_vec())
            .collect();
        if low.is_empty() { self.dips(truss, x, (&middle, half), (y, end)) } else { low }
    }

    /// Returns the modes of the [`MODES`] least singular values with the nodes at `x` (m), in ascending order, for the search of
    /// steps, which need not know what is far above the limit of the truss. The search begins with the modes found last, and with the
    /// decomposition that was made for these positions, if there is one.
    pub(super) fn weakest(&mut self, truss: &Structure, x: &[Vec3]) -> Vec<Mode> {
        let (layout, struts) = (&truss.layout, &truss.struts);
        let within = (MODES, INTEREST * truss.limits.rigidity);
        let near = self.near.get(x).and_then(Option::as_ref);
        let made = match near {
            Some(_) => None,
            None => ShiftedFactor::new(layout, x, struts, LOOKED_NEAR * truss.limits.rigidity),
        };
        let factor = near.map(LowerBound::factor).or(made.as_ref());
        let modes = self.modes.weakest_coarse(layout, x, struts, within, factor);
        with_struts(truss, x, modes)
    }

    /// Returns modes as [`weakest`](Self::weakest) does, whatever modes were found last.
    pub(super) fn weakest_anew(&mut self, truss: &Structure, x: &[Vec3]) -> Vec<Mode> {
        self.modes = Modes::default();
        self.weakest(truss, x)
    }

    /// Begins a step from `x`, m: if the least singular value is known there, the search for that at the end begins near it.
    fn begin(&mut self, truss: &Structure, x: &[Vec3]) {
        if self.start.get(x).is_some() {
            return;
        }
        let value = self.found.get(x).copied().flatten();
        let fall = |value: f64| self.start.1.value.map_or(f64::INFINITY, |(last, _)| 1.0 - value / last);
        let value = value.map(|value| (value, fall(value)));
        // A step begins as the one before ended, but for the first and after rolls.
        let limit = kept_limit(truss);
        let bound = match self.stood.get(x) {
            Some(bound) => bound.max(limit),
            None => first_proved(truss, x, &[limit, DIP_CLEAR * limit]),
        };
        self.start = At(x.to_vec(), Start { bound, value });
    }

    /// Returns a lower bound on the least singular value, proved with the nodes at `y` (m), where that at the start of the step is
    /// known; 0 where it is below the limit of the truss. One that supposes that it falls as before is tried first, since it
    /// leads to the value soon; then the least that still leads there, and the limit.
    fn near_value(&mut self, truss: &Structure, y: &[Vec3]) -> f64 {
        self.near = At(y.to_vec(), None);
        let Some((last, fall)) = self.start.1.value else { return 0.0 };
        let most = last * (1.0 - FALLS.1);
        let first = (last * (1.0 - FALLS.0 - (2.0 * fall).max(0.0))).max(most);
        let limit = kept_limit(truss);
        let Some(bound) = first_bound(truss, y, &[first, most.max(limit), limit]) else { return 0.0 };
        let proved = bound.value;
        self.near.1 = Some(bound).filter(|_| proved >= most);
        proved
    }

    /// Returns a lower bound on the least singular value, proved with the nodes at `y` (m), where that at the start of the step is not
    /// known; 0 where it is below the limit of the truss. As great a one as is likely is tried first, since it serves the steps that
    /// follow, too; then the limit.
    fn hoped(&mut self, truss: &Structure, y: &[Vec3]) -> f64 {
        let limit = kept_limit(truss);
        let hope = self.hope.unwrap_or(limit);
        let first = if hope > HOPELESS * limit { hope } else { limit };
        let proved = first_proved(truss, y, &[first, limit]);
        self.hope = Some((hope * if proved == first { HOPES.0 } else { HOPES.1 }).max(limit));
        proved
    }

    /// Proves the bound with which the search for the least singular value at `y` (m) begins.
    pub(super) fn prepare(&mut self, truss: &Structure, y: &[Vec3]) {
        if self.near.get(y).is_none() {
            self.near_value(truss, y);
        }
    }

    /// Returns the least singular value with the nodes at `y`, m; `None` where the truss has no other than those of rigid motions.
    fn value_at(&mut self, truss: &Structure, y: &[Vec3]) -> Option<f64> {
        if let Some(value) = self.found.get(y) {
            return *value;
        }
        self.prepare(truss, y);
        let (layout, struts) = (&truss.layout, &truss.struts);
        let near = self.near.1.as_ref();
        let known = near.and_then(|bound| self.modes.least_above(layout, y, struts, bound));
        let value = known.or_else(|| self.modes.least_anew(layout, y, struts));
        self.found = At(y.to_vec(), value);
        value
    }

    /// Returns the least singular value at the end `y` (m) of a step that is made; `None` where the truss has no other than those of
    /// rigid motions.
    pub(super) fn least(&mut self, truss: &Structure, y: &[Vec3]) -> Option<f64> {
        let value = self.value_at(truss, y);
        self.begin(truss, y);
        // A value to which no bound led is not proved.
        let proved = self.near.get(y).is_some_and(Option::is_some);
        self.bound = At(y.to_vec(), value.filter(|_| proved).unwrap_or(0.0));
        value
    }

    /// Forgets the decomposition made last, which is large.
    pub(super) fn forget_decomposition(&mut self) {
        self.near = At::default();
    }

    /// Returns positions on the way from `x` (m) over the middle to the end at which a singular value is far below the limit of
    /// the truss, as [`dips_between`] has it. `middle` and `end`: the positions there, m, with lower bounds on the
    /// singular value.
    fn dips(
        &mut self,
        truss: &Structure,
        x: &[Vec3],
        (middle, half): (&[Vec3], f64),
        (y, end): (&[Vec3], f64),
    ) -> Vec<Vec<Vec3>> {
        let floor = DIP * truss.limits.rigidity;
        let begin = self.start.1.bound;
        let found = if LinearMotion::new(&truss.struts, x, y).least([begin, end]) >= floor {
            Vec::new()
        } else {
            let first = dips_between(truss, (x, begin), (middle, half), HALVINGS);
            if first.is_empty() { dips_between(truss, (middle, half), (y, end), HALVINGS) } else { first }
        };
        if found.is_empty() {
            self.stood = At(y.to_vec(), end);
        }
        found
    }
}

/// Returns positions on the way from `x` to `y`, both with a lower bound on the least singular value there, at which it is below
/// [`DIP`] of the limit of the truss, or may be near them after so many halvings of the way; none only if bounds on the way prove
/// that there are none.
fn dips_between(
    truss: &Structure,
    (x, begin): (&[Vec3], f64),
    (y, end): (&[Vec3], f64),
    halvings: usize,
) -> Vec<Vec<Vec3>> {
    let limit = truss.limits.rigidity;
    let (floor, clear) = (DIP * limit, DIP_CLEAR * limit);
    if LinearMotion::new(&truss.struts, x, y).least([begin, end]) >= floor {
        return Vec::new();
    }
    let middle = halfway(x, y);
    // A bound that proves both halves is enough.
    let first = LinearMotion::new(&truss.struts, x, &middle).end_needed(begin, floor);
    let second = LinearMotion::new(&truss.struts, &middle, y).start_needed(end, floor);
    let enough = first.max(second).max(clear);
    let likely = if enough <= LIKELY * begin.max(end) { enough } else { limit };
    let half = first_proved(truss, &middle, &[likely, limit.min(likely), clear]);
    if half >= enough {
        return Vec::new();
    }
    // A way that is not proved counts as violated, as by the judge.
    if half < clear || halvings == 0 {
        return vec![middle];
    }
    let first = dips_between(truss, (x, begin), (&middle, half), halvings - 1);
    if first.is_empty() { dips_between(truss, (&middle, half), (y, end), halvings - 1) } else { first }
}

/// Returns the first of some bounds on the least singular value that is proved with the nodes at `x` (m), without unit; 0 if none is.
fn first_proved(truss: &Structure, x: &[Vec3], bounds: &[f64]) -> f64 {
    first_bound(truss, x, bounds).map_or(0.0, |bound| bound.value)
}

/// Returns the bound of [`first_proved`]. One that is not less than another that was refused is not tried.
fn first_bound(truss: &Structure, x: &[Vec3], bounds: &[f64]) -> Option<LowerBound> {
    let mut refused = f64::INFINITY;
    bounds.iter().find_map(|&bound| {
        if bound >= refused {
            return None;
        }
        refused = bound;
        LowerBound::new(&truss.layout, x, &truss.struts, bound)
    })
}

/// Returns the limit of the truss on singular values but for rounding, without unit: nothing is asked of a step that ends within
/// rounding of it.
fn kept_limit(truss: &Structure) -> f64 {
    truss.limits.rigidity - truss.tolerances.rounding
}

/// Returns an upper bound on what any singular value of the rigidity matrix changes by between two positions of the nodes,
/// m: the norm of the change of the matrix (Weyl 1912), after a rotation of the whole truss, which changes none.
fn change(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> f64 {
    let directions = directions(truss, x, y);
    let turn = rotation(&directions);
    let squares = directions.iter().map(|(from, to)| (to - turn * from).norm_squared());
    norm_bound(&truss.struts, truss.nodes, &squares.collect::<Vec<f64>>())
}

/// Returns the directions of the struts at two positions of the nodes, m.
fn directions(truss: &Structure, x: &[Vec3], y: &[Vec3]) -> Vec<(Vec3, Vec3)> {
    let along = |x: &[Vec3], &(a, b): &(usize, usize)| (x[b] - x[a]).normalize();
    truss.struts.iter().map(|ends| (along(x, ends), along(y, ends))).collect()
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
