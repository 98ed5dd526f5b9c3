//! Strictly convex quadratic programs by the dual active-set method of Goldfarb and Idnani (1983), for programs to
//! which rows are added while they are being solved: each solution is warm-started from the active set of the last one.
//!
//! With `H = L Lᵀ`, `v = Lᵀ x`, `z = L⁻¹ a` the program is to find the point v nearest to `v₀ = -L⁻¹ c` with `z·v ≤
//! b`
//! for each row. The Gram matrix of the active rows' images z is kept as its Cholesky factor, which grows by a row
//! where a row becomes active and is mended by Givens rotations where one is dropped.
//!
//! A cost `|a·x - b|` is a row whose Lagrange multiplier lies between -1 and 1 (the dual of the absolute value): where that
//! reaches one of them, the row is dropped and goes on to pull with it, and it becomes active again where x comes over to
//! its other side.

use super::linear::{Row, Unsolved};
use super::sparse_cholesky::SparseCholesky;

/// Threshold: a row counts as a linear combination of the active rows if the part of its squared length across them is
/// at most this fraction of the whole, without unit: what is less is rounding.
const TOL_DEPENDENT: f64 = 1e-11;
/// The number of rows that may enter the active set, for each row of the program, before the method gives up.
const CHANGES_MAX: usize = 20;

/// A sparse vector: the indices and values of its entries that are not zero.
#[derive(Clone, Debug, Default)]
struct Sparse {
    at: Vec<usize>,
    value: Vec<f64>,
}

impl Sparse {
    fn dot(&self, dense: &[f64]) -> f64 {
        self.at.iter().zip(&self.value).map(|(i, v)| v * dense[*i]).sum()
    }

    fn add_to(&self, dense: &mut [f64], factor: f64) {
        for (i, v) in self.at.iter().zip(&self.value) {
            dense[*i] += factor * v;
        }
    }
}

/// The kind of a row of a program, which says between which bounds its Lagrange multiplier lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// An equality `a·x = b`.
    Equal,
    /// An inequality `a·x ≤ b`.
    AtMost,
    /// A cost `|a·x - b|`.
    Absolute,
}

impl Kind {
    /// Returns the least and the greatest multiplier.
    fn bounds(self) -> (f64, f64) {
        match self {
            Kind::Equal => (f64::NEG_INFINITY, f64::INFINITY),
            Kind::AtMost => (0.0, f64::INFINITY),
            Kind::Absolute => (-1.0, 1.0),
        }
    }
}

/// The side of `b` on which `a·x` is at the optimum, where `|a·x - b|` is a part of the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Below, `a·x ≤ b`: the multiplier is -1.
    Below,
    /// On neither: `a·x = b`, and the multiplier is between.
    At,
    /// Above, `a·x ≥ b`: the multiplier is 1.
    Above,
}

/// A row of the program.
struct Line {
    terms: Vec<(usize, f64)>,
    right: f64,
    kind: Kind,
    /// The image z, once it was needed, with its product with v₀.
    image: Option<(Sparse, f64)>,
    active: bool,
    /// The multiplier of a row that is not active: 0, or a bound of that of an absolute value.
    held: f64,
}

impl Line {
    /// Returns the image z, which active rows have.
    fn image(&self) -> &Sparse {
        &self.image.as_ref().expect("it was made").0
    }

    fn over(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|(i, a)| a * x[*i]).sum::<f64>() - self.right
    }

    /// Returns by how much a row that is not active, and exceeds its right side by `over`, is violated: the multiplier that it
    /// has is not that of an optimum.
    fn violation(&self, over: f64) -> f64 {
        match self.kind {
            Kind::Equal | Kind::AtMost => over,
            Kind::Absolute if self.held >= 1.0 => -over,
            Kind::Absolute if self.held <= -1.0 => over,
            Kind::Absolute => over.abs(),
        }
    }
}

/// The part of a row's image z across the images of the active rows.
struct Across {
    /// The solution by forward substitution with the Gram matrix of the active rows, for their products with z.
    half: Vec<f64>,
    /// The change of each active row's multiplier for a change of the row's own.
    falls: Vec<f64>,
    /// The squared length of the part across, and of z.
    left: f64,
    square: f64,
}

/// A strictly convex quadratic program `min ½ xᵀ H x + c·x` under linear rows, with the active set of its solution
/// (dual active-set method; Goldfarb and Idnani 1983).
pub(super) struct ActiveSet {
    factor: SparseCholesky,
    /// The unconstrained optimum v₀.
    free: Vec<f64>,
    lines: Vec<Line>,
    /// The active rows, and their Lagrange multipliers, in the order of the factor's rows.
    active: Vec<usize>,
    multipliers: Vec<f64>,
    /// The point v of the present multipliers.
    point: Vec<f64>,
    /// The lower triangle C of the active rows' Gram matrix, `C Cᵀ`, by rows.
    gram: Vec<Vec<f64>>,
    /// The tolerance of a row, in the units of its right side.
    tolerance: f64,
    work: Vec<f64>,
}

impl ActiveSet {
    /// Returns the program without rows. `factor`: that of `H = L Lᵀ`; `linear`: c, one entry for every variable;
    /// `tolerance`: the most by which a row may be violated, in the unit of its right side.
    pub(super) fn new(factor: SparseCholesky, linear: &[f64], tolerance: f64) -> ActiveSet {
        let mut free: Vec<f64> = factor.permuted(linear).iter().map(|c| -c).collect();
        factor.solve_lower(&mut free);
        ActiveSet {
            work: vec![0.0; free.len()],
            point: free.clone(),
            factor,
            free,
            lines: Vec::new(),
            active: Vec::new(),
            multipliers: Vec::new(),
            gram: Vec::new(),
            tolerance,
        }
    }

    /// Adds a row. Rows are numbered from 0 as they come.
    pub(super) fn add(&mut self, (terms, right): Row, kind: Kind) {
        self.lines.push(Line { terms, right, kind, image: None, active: false, held: 0.0 });
    }

    /// Returns the sides of the absolute values in the order of their rows.
    pub(super) fn sides(&self) -> Vec<Side> {
        let absolutes = self.lines.iter().filter(|line| line.kind == Kind::Absolute);
        let side = |line: &Line| match line.held {
            held if line.active || held.abs() < 1.0 => Side::At,
            held if held > 0.0 => Side::Above,
            _ => Side::Below,
        };
        absolutes.map(side).collect()
    }

    /// Begins the next solution with the absolute values on these sides, in the order of their rows.
    pub(super) fn begin(&mut self, sides: &[Side]) {
        let absolutes = (0..self.lines.len()).filter(|line| self.lines[*line].kind == Kind::Absolute);
        let absolutes: Vec<usize> = absolutes.collect();
        for (line, side) in absolutes.into_iter().zip(sides) {
            self.make_image(line);
            match side {
                Side::Below => self.lines[line].held = -1.0,
                Side::Above => self.lines[line].held = 1.0,
                Side::At => {
                    let Across { half, left, square, .. } = self.across(line);
                    if left > TOL_DEPENDENT * square {
                        self.activate(line, half, left, 0.0);
                    }
                }
            }
        }
    }

    /// Changes the right side of the row of number `line`. Panics if there is none.
    pub(super) fn set(&mut self, line: usize, right: f64) {
        self.lines[line].right = right;
    }

    /// Returns the optimal x for the rows as they are now, beginning with the active set of the last solution.
    /// Equalities enter first, then all violated inequalities, the most violated first, again and again.
    ///
    /// # Errors
    /// [`Unsolved::Infeasible`] where a violated row is a combination of active ones that can't give way,
    /// [`Unsolved::Numerical`] where rounding loses an active row or the limit of changes is reached.
    pub(super) fn solve(&mut self) -> Result<Vec<f64>, Unsolved> {
        self.restart();
        for line in 0..self.lines.len() {
            if self.lines[line].kind == Kind::Equal && !self.lines[line].active {
                self.enter(line)?;
            }
        }
        let mut changes = 0;
        let mut exact = false;
        while changes < CHANGES_MAX * (self.lines.len() + 1) {
            let x = self.solution();
            let violated = self.violated(&x);
            if violated.is_empty() && self.active_hold(&x) {
                return Ok(x);
            }
            let mut entered = false;
            for line in violated {
                changes += 1;
                entered |= self.enter(line)?;
            }
            // Rounding adds up over many changes: once more from the multipliers.
            if !entered && exact {
                return Err(Unsolved::Numerical);
            }
            exact = !entered;
            if exact {
                self.restart();
            }
        }
        Err(Unsolved::Numerical)
    }

    /// Empties the active set, so that the next call of [`solve`](Self::solve) begins without one.
    pub(super) fn forget(&mut self) {
        self.active.clear();
        self.multipliers.clear();
        self.gram.clear();
        self.lines.iter_mut().for_each(|line| (line.active, line.held) = (false, 0.0));
    }

    /// Computes the multipliers for the right sides as they are now, and drops rows whose multipliers are beyond their bounds,
    /// the farthest first.
    fn restart(&mut self) {
        let base = loop {
            let base = self.base();
            let violation = |line: &usize| {
                let Line { right, image, .. } = &self.lines[*line];
                let (image, along) = image.as_ref().expect("active rows have images");
                base.as_ref().map_or(*along, |base| image.dot(base)) - right
            };
            let violations: Vec<f64> = self.active.iter().map(violation).collect();
            self.multipliers = self.gram_solved(violations);
            let spare = |(multiplier, line): (&f64, &usize)| {
                let (low, high) = self.lines[*line].kind.bounds();
                (multiplier - low).min(high - multiplier)
            };
            let beyond = self.multipliers.iter().zip(&self.active).map(spare).enumerate();
            let beyond = beyond.filter(|(_, spare)| *spare < 0.0);
            let Some((worst, _)) = beyond.min_by(|a, b| a.1.total_cmp(&b.1)) else { break base };
            self.leave(worst);
        };
        self.point.copy_from_slice(base.as_ref().unwrap_or(&self.free));
        for (line, multiplier) in self.active.iter().zip(&self.multipliers) {
            self.lines[*line].image().add_to(&mut self.point, -multiplier);
        }
    }

    /// Returns the optimum without active rows; `None` where it is v₀, as no other row pulls.
    fn base(&self) -> Option<Vec<f64>> {
        let mut base = None;
        for line in self.lines.iter().filter(|line| !line.active && line.held != 0.0) {
            line.image().add_to(base.get_or_insert_with(|| self.free.clone()), -line.held);
        }
        base
    }

    /// Returns x for the present multipliers.
    fn solution(&self) -> Vec<f64> {
        let mut v = self.point.clone();
        self.factor.solve_upper(&mut v);
        self.factor.restored(&v)
    }

    /// Returns true if the active rows hold: rows whose Gram matrix is nearly singular may be lost to rounding.
    fn active_hold(&self, x: &[f64]) -> bool {
        self.active.iter().all(|line| self.lines[*line].over(x).abs() <= self.tolerance)
    }

    /// Returns the inequalities and absolute values that x violates by more than the tolerance, the most violated first.
    fn violated(&self, x: &[f64]) -> Vec<usize> {
        let open = self.lines.iter().enumerate();
        let open = open.filter(|(_, line)| !line.active && line.kind != Kind::Equal);
        let mut over: Vec<(f64, usize)> = open.map(|(i, line)| (line.violation(line.over(x)), i)).collect();
        over.retain(|(over, _)| *over > self.tolerance);
        over.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        over.into_iter().map(|(_, line)| line).collect()
    }

    /// Makes a row active, and drops those that block the step to it (step 2 of the dual algorithm): partial steps
    /// up to the first multiplier that reaches a bound, then the full step. Returns false for a row that holds without. An
    /// absolute value whose own multiplier reaches a bound on the way does not become active, and pulls with that.
    ///
    /// # Errors
    /// [`Unsolved::Infeasible`] where the row depends on the active ones and none of them can be dropped.
    fn enter(&mut self, line: usize) -> Result<bool, Unsolved> {
        self.make_image(line);
        let Line { kind, right, held, .. } = self.lines[line];
        let over = self.lines[line].image().dot(&self.point) - right;
        if kind != Kind::Equal && self.lines[line].violation(over) <= self.tolerance / 2.0 {
            return Ok(false);
        }
        let mut own = held;
        loop {
            let Across { half, falls, left, square } = self.across(line);
            let over = self.lines[line].image().dot(&self.point) - right;
            // The sign of the change of the row's own multiplier: a row that v falls short of pushes in the opposite
            // direction.
            let sign = if kind != Kind::AtMost && over < 0.0 { -1.0 } else { 1.0 };
            let room = |multiplier: f64, (low, high): (f64, f64), rate: f64| {
                let to = if rate > 0.0 { high - multiplier } else { multiplier - low };
                if rate == 0.0 { f64::INFINITY } else { (to / rate.abs()).max(0.0) }
            };
            let may_block = falls.iter().zip(&self.multipliers).zip(&self.active).enumerate();
            let blocks = may_block.map(|(i, ((fall, multiplier), other))| {
                (i, room(*multiplier, self.lines[*other].kind.bounds(), -sign * fall))
            });
            let first = blocks.filter(|(_, step)| step.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1));
            let independent = left > TOL_DEPENDENT * square;
            if kind == Kind::Equal && !independent && over.abs() <= self.tolerance {
                return Ok(false);
            }
            let full = if independent { sign * over / left } else { f64::INFINITY };
            let turned = room(own, kind.bounds(), sign);
            let last = full.min(turned);
            let blocked = first.filter(|(_, step)| *step < last);
            let step = sign * blocked.map_or(last, |(_, step)| step);
            if !step.is_finite() {
                return Err(Unsolved::Infeasible);
            }
            own += step;
            self.multipliers.iter_mut().zip(&falls).for_each(|(m, f)| *m -= step * f);
            self.point.iter_mut().zip(&self.work).for_each(|(v, w)| *v -= step * w);
            if let Some((i, _)) = blocked {
                self.leave(i);
                continue;
            }
            if turned < full {
                self.lines[line].held = sign;
            } else {
                self.activate(line, half, left, own);
            }
            return Ok(true);
        }
    }

    /// Returns the part of a row's image across the active ones, and leaves it in `work`.
    fn across(&mut self, line: usize) -> Across {
        let image = self.lines[line].image();
        self.work.fill(0.0);
        image.add_to(&mut self.work, 1.0);
        let square: f64 = image.value.iter().map(|v| v * v).sum();
        let products: Vec<f64> =
            self.active.iter().map(|other| self.lines[*other].image().dot(&self.work)).collect();
        let half = self.gram_forward(products);
        let falls = self.gram_back(half.clone());
        // From the row itself: a difference of squares would be nothing but rounding where it is small.
        for (other, fall) in self.active.iter().zip(&falls) {
            self.lines[*other].image().add_to(&mut self.work, -fall);
        }
        let left: f64 = self.work.iter().map(|w| w * w).sum();
        Across { half, falls, left, square }
    }

    /// Adds a row to the active ones, with this multiplier; `half` and `left` are those of [`across`](Self::across).
    fn activate(&mut self, line: usize, mut half: Vec<f64>, left: f64, multiplier: f64) {
        half.push(left.sqrt());
        self.gram.push(half);
        self.multipliers.push(multiplier);
        self.active.push(line);
        (self.lines[line].active, self.lines[line].held) = (true, 0.0);
    }

    /// Computes the image z of a row, unless it is known.
    fn make_image(&mut self, line: usize) {
        let line = &mut self.lines[line];
        if line.image.is_some() {
            return;
        }
        let mut terms = vec![0.0; self.free.len()];
        line.terms.iter().for_each(|(i, a)| terms[*i] += a);
        let mut z = self.factor.permuted(&terms);
        self.factor.solve_lower(&mut z);
        let mut image = Sparse::default();
        for (i, value) in z.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            image.at.push(i);
            image.value.push(*value);
        }
        let along = image.dot(&self.free);
        line.image = Some((image, along));
    }

    /// Drops the row at an index of the active set, which keeps the bound that its multiplier is at; Givens rotations make the
    /// factor's later rows triangular again.
    fn leave(&mut self, place: usize) {
        let multiplier = self.multipliers.remove(place);
        let line = &mut self.lines[self.active.remove(place)];
        line.active = false;
        line.held = if line.kind == Kind::Absolute { multiplier.signum() } else { 0.0 };
        self.gram.remove(place);
        for k in place..self.gram.len() {
            let (a, b) = (self.gram[k][k], self.gram[k][k + 1]);
            let r = libm::hypot(a, b);
            let (c, s) = if r > 0.0 { (a / r, b / r) } else { (1.0, 0.0) };
            for row in &mut self.gram[k..] {
                let (p, q) = (row[k], row[k + 1]);
                row[k] = c * p + s * q;
                row[k + 1] = c * q - s * p;
            }
            self.gram[k].truncate(k + 1);
        }
    }

    /// Solves by forward substitution with the factor of the Gram matrix.
    fn gram_forward(&self, mut right: Vec<f64>) -> Vec<f64> {
        for (i, row) in self.gram.iter().enumerate() {
            let known: f64 = row[..i].iter().zip(&right).map(|(c, y)| c * y).sum();
            right[i] = (right[i] - known) / row[i];
        }
        right
    }

    /// Solves by backward substitution with its transpose.
    fn gram_back(&self, mut right: Vec<f64>) -> Vec<f64> {
        for (i, row) in self.gram.iter().enumerate().rev() {
            right[i] /= row[i];
            let value = right[i];
            right[..i].iter_mut().zip(row).for_each(|(y, c)| *y -= c * value);
        }
        right
    }

    fn gram_solved(&self, right: Vec<f64>) -> Vec<f64> {
        self.gram_back(self.gram_forward(right))
    }
}
