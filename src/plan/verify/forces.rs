//! The contact forces that load a robot least: is there a set of them for which nothing is
//! overloaded?
//!
//! Each contact pushes within a pyramid inside its friction cone; together they carry the weight.
//! The least greatest load is a linear programme. Its answer is not believed: the forces are brought
//! to exact balance and the loads computed from them, which proves that they exist; and the
//! multipliers give a bound below which no forces whatever can come.

use super::Tolerances;
use super::contact::Touch;
use super::footprint;
use super::model::Model;
use super::stance::Stance;
use super::statics::{Load, LoadKind, Push, Section, Structure};
use crate::geometry::Vec3;
use crate::optimize::linear::{Problem, linear_program};
use nalgebra::{Matrix6, Vector6};

/// The half diagonal of the square inside the unit circle.
const INSCRIBED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Coefficients of a programme that is still tried.
const SIZE_MAX: usize = 4_000_000;

/// Directions in which a moment is bounded in the programme; its true size is judged afterwards.
const DIRECTIONS: [[f64; 3]; 9] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [INSCRIBED, INSCRIBED, 0.0],
    [INSCRIBED, -INSCRIBED, 0.0],
    [INSCRIBED, 0.0, INSCRIBED],
    [INSCRIBED, 0.0, -INSCRIBED],
    [0.0, INSCRIBED, INSCRIBED],
    [0.0, INSCRIBED, -INSCRIBED],
];

/// A unit of a force that may act: an edge of a contact's pyramid, or a component of what a bond that
/// closes a loop transmits.
struct Column {
    pushes: Vec<Push>,
    /// It may also act the other way round.
    free: bool,
}

/// What forces can do.
#[derive(Clone, Debug)]
pub struct Best {
    /// Greatest load by its limit, with forces that balance.
    pub ratio: f64,
    /// Index of that load.
    pub load: usize,
    /// No forces do better than this.
    pub bound: f64,
    /// Sizes of the columns, for the next sample.
    pub recipe: Recipe,
}

/// Which contacts pushed how much: where the contacts stay the same, nearly the same forces do.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Recipe {
    contacts: Vec<(usize, u8)>,
    sizes: Vec<f64>,
}

/// One question about one stance.
pub struct Question<'a> {
    pub model: &'a Model<'a>,
    pub structure: &'a Structure,
    pub stance: &'a Stance,
    pub sections: &'a [Section],
    /// What the cuts hold against the weights alone.
    pub weights: &'a [f64],
    /// The loads that count.
    pub loads: &'a [usize],
    /// Weight, N; and the factor on friction.
    pub weight: f64,
    pub friction: f64,
    pub tolerances: &'a Tolerances,
}

impl Question<'_> {
    /// The forces of a recipe, brought to balance here: a quick answer, or none.
    pub fn again(&self, recipe: &Recipe) -> Option<Best> {
        let contacts = self.contacts();
        let same = contacts.iter().map(|t| (t.feature, t.k)).eq(recipe.contacts.iter().copied());
        let columns = self.columns(&contacts);
        if !same || columns.len() != recipe.sizes.len() {
            return None;
        }
        self.answer(&contacts, &columns, &recipe.sizes, f64::NEG_INFINITY)
    }

    /// Coefficients of the linear programme: what solving it costs.
    pub fn effort(&self) -> usize {
        let columns = self.columns(&self.contacts());
        let rows: usize = self.loads.iter().map(|&i| parts(&self.structure.loads[i]).len()).sum();
        rows.saturating_mul(columns.len())
    }

    /// The least greatest load by linear programming; `None` where no forces balance the weight, or
    /// the solver did not get there.
    pub fn best(&self) -> Option<Best> {
        let contacts = self.contacts();
        let columns = self.columns(&contacts);
        let rows = self.rows(&columns);
        if rows.len().saturating_mul(columns.len()) > SIZE_MAX {
            return None;
        }
        let problem = self.problem(&columns, &rows);
        let solution = linear_program(&problem).ok()?;
        let bound = self.bound(&columns, &rows, &solution.y, &solution.z);
        self.answer(&contacts, &columns, &solution.x[..columns.len()], bound)
    }

    /// Touches that carry weight, reduced to the corners of each link's hull: other points of it push
    /// no differently than their mean.
    fn contacts(&self) -> Vec<Touch> {
        let near: Vec<&Touch> =
            self.stance.touches.iter().filter(|t| t.gap <= self.tolerances.gap_loaded).collect();
        let mut links: Vec<usize> = near.iter().map(|t| t.link).collect();
        links.sort_unstable();
        links.dedup();
        let mut chosen = Vec::new();
        for link in links {
            let own: Vec<&Touch> = near.iter().copied().filter(|t| t.link == link).collect();
            let points: Vec<_> = own.iter().map(|t| [t.p.x, t.p.y]).collect();
            chosen.extend(footprint::hull(&points).into_iter().map(|i| *own[i]));
        }
        chosen
    }

    fn columns(&self, contacts: &[Touch]) -> Vec<Column> {
        let mut columns = Vec::new();
        for touch in contacts {
            let slope = INSCRIBED * self.friction * self.model.bodies[touch.link].friction;
            for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                let f = Vec3::new(x * slope, y * slope, 1.0) * self.weight;
                let push = Push { link: touch.link, p: touch.p, f, m: Vec3::zeros() };
                columns.push(Column { pushes: vec![push], free: false });
            }
        }
        for &(bond, a, b) in &self.structure.closing {
            let p = self.structure.closing_place(self.model, self.stance, bond);
            for axis in 0..6 {
                let unit = Vec3::ith(axis % 3, self.weight);
                let (f, m) = if axis < 3 { (unit, Vec3::zeros()) } else { (Vec3::zeros(), unit) };
                let pushes = vec![Push { link: b, p, f, m }, Push { link: a, p, f: -f, m: -m }];
                columns.push(Column { pushes, free: true });
            }
        }
        columns
    }

    /// Sums of cuts that must stay within limits, both ways round unless they are pulls:
    /// (coefficient of each column, the weights' share), in parts of the limit.
    fn rows(&self, columns: &[Column]) -> Vec<Row> {
        let mut rows = Vec::new();
        for &index in self.loads {
            let load = &self.structure.loads[index];
            for (terms, two_sided) in parts(load) {
                let coefficients = columns.iter().map(|column| self.effect(column, &terms) / load.limit);
                let held = terms.iter().map(|&(cut, factor)| factor * self.weights[cut]);
                let constant = held.sum::<f64>() / load.limit;
                rows.push(Row { coefficients: coefficients.collect(), constant, two_sided });
            }
        }
        rows
    }

    fn effect(&self, column: &Column, terms: &[(usize, f64)]) -> f64 {
        let mut sum = 0.0;
        for &(cut, factor) in terms {
            let section = &self.sections[cut];
            for push in &column.pushes {
                if self.structure.beyond(section.link, push.link) {
                    sum += factor * section.of(&push.p, &push.f, &push.m);
                }
            }
        }
        sum
    }

    /// Force and moment of a column about the centre of mass, in parts of the weight.
    fn balance(&self, column: &Column) -> Vector6<f64> {
        let mut sum = Vector6::zeros();
        for push in column.pushes.iter().filter(|_| !column.free) {
            let (f, m) = (push.f / self.weight, push.p.cross(&push.f) / self.weight);
            sum += Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
        }
        sum
    }

    fn problem(&self, columns: &[Column], rows: &[Row]) -> Problem {
        let n = columns.len();
        let mut problem = Problem { costs: vec![0.0; n + 1], ..Problem::default() };
        problem.costs[n] = 1.0;
        let balances: Vec<_> = columns.iter().map(|c| self.balance(c)).collect();
        for axis in 0..6 {
            let share = |balance: &Vector6<f64>| balance[axis];
            let terms = balances.iter().map(share).enumerate().filter(|(_, share)| *share != 0.0);
            problem.equal.push((terms.collect(), if axis == 2 { 1.0 } else { 0.0 }));
        }
        for row in rows {
            for sign in row.signs() {
                let nonzero = (0..n).filter(|&k| row.coefficients[k] != 0.0);
                let mut terms: Vec<_> = nonzero.map(|k| (k, sign * row.coefficients[k])).collect();
                terms.push((n, -1.0));
                problem.at_most.push((terms, -sign * row.constant));
            }
        }
        let pushing = (0..n).filter(|&k| !columns[k].free);
        problem.at_most.extend(pushing.map(|k| (vec![(k, -1.0)], 0.0)));
        problem
    }

    /// A bound from multipliers, whoever made them: for any weights `z ≥ 0` of the rows that sum to 1
    /// and any `y`, `s ≥ Σ z row = Σ λ (zᵀ row + yᵀ balance) - y·weight`, and the sizes λ of contact
    /// forces sum to 1, so the least coefficient bounds the sum.
    fn bound(&self, columns: &[Column], rows: &[Row], y: &[f64], z: &[f64]) -> f64 {
        let count: usize = rows.iter().map(|row| row.signs().len()).sum();
        let z: Vec<f64> = z[..count].iter().map(|z| z.max(0.0)).collect();
        let total: f64 = z.iter().sum();
        if total <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let y = Vector6::from_iterator((0..6).map(|i| y[i] / total));
        let mut coefficients: Vec<f64> = columns.iter().map(|c| y.dot(&self.balance(c))).collect();
        let mut constant = -y[2];
        let signed = rows.iter().flat_map(|row| row.signs().iter().map(move |sign| (row, *sign)));
        for ((row, sign), z) in signed.zip(&z) {
            let share = sign * z / total;
            constant += share * row.constant;
            coefficients.iter_mut().zip(&row.coefficients).for_each(|(c, r)| *c += share * r);
        }
        let loops = columns.iter().zip(&coefficients).filter(|(c, _)| c.free);
        if loops.map(|(_, c)| c.abs()).fold(0.0, f64::max) > self.tolerances.balance {
            return f64::NEG_INFINITY;
        }
        let pushes = columns.iter().zip(&coefficients).filter(|(c, _)| !c.free);
        constant + pushes.map(|(_, c)| *c).fold(f64::INFINITY, f64::min)
    }

    /// Forces near the given ones that balance to the last digits, and the loads that they make.
    fn answer(&self, contacts: &[Touch], columns: &[Column], sizes: &[f64], bound: f64) -> Option<Best> {
        let sizes = self.balanced(columns, sizes)?;
        let mut pushes = Vec::new();
        for (column, size) in columns.iter().zip(&sizes) {
            pushes.extend(column.pushes.iter().map(|p| Push { f: p.f * *size, m: p.m * *size, ..*p }));
        }
        let mut held = self.structure.held(self.model, self.sections, &pushes);
        held.iter_mut().zip(self.weights).for_each(|(h, w)| *h += w);
        let ratio = |index: usize| {
            let load = &self.structure.loads[index];
            self.structure.size(load, &held) / load.limit
        };
        let worst = self.loads.iter().copied().reduce(|w, i| if ratio(i) > ratio(w) { i } else { w })?;
        let recipe = Recipe { contacts: contacts.iter().map(|t| (t.feature, t.k)).collect(), sizes };
        Some(Best { ratio: ratio(worst), load: worst, bound, recipe })
    }

    /// The nearest sizes that balance, measured by the sizes themselves; `None` where one would have
    /// to pull.
    fn balanced(&self, columns: &[Column], sizes: &[f64]) -> Option<Vec<f64>> {
        let clipped: Vec<f64> =
            columns.iter().zip(sizes).map(|(c, s)| if c.free { *s } else { s.max(0.0) }).collect();
        let balances: Vec<_> = columns.iter().map(|c| self.balance(c)).collect();
        let mut sizes = clipped;
        for _ in 0..3 {
            let mut missing = Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
            let mut normal = Matrix6::identity() * 1e-15;
            for (balance, size) in balances.iter().zip(&sizes) {
                missing -= balance * *size;
                normal += balance * balance.transpose() * size.abs();
            }
            if missing.norm() <= self.tolerances.balance * 1e-6 {
                break;
            }
            let multipliers = normal.cholesky()?.solve(&missing);
            let corrected = sizes.iter().zip(&balances).map(|(s, b)| s + s.abs() * b.dot(&multipliers));
            sizes = corrected.collect();
        }
        let mut missing = Vector6::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
        balances.iter().zip(&sizes).for_each(|(b, s)| missing -= b * *s);
        let pushing = columns.iter().zip(&sizes).all(|(c, s)| c.free || *s >= 0.0);
        (missing.norm() <= self.tolerances.balance && pushing).then_some(sizes)
    }
}

struct Row {
    coefficients: Vec<f64>,
    constant: f64,
    two_sided: bool,
}

impl Row {
    fn signs(&self) -> &'static [f64] {
        if self.two_sided { &[1.0, -1.0] } else { &[1.0] }
    }
}

/// A load as linear parts: one, or for a moment its components in several directions.
fn parts(load: &Load) -> Vec<(Vec<(usize, f64)>, bool)> {
    match load.kind {
        LoadKind::Joint { .. } => vec![(load.terms.clone(), true)],
        LoadKind::Pull => vec![(load.terms.clone(), false)],
        LoadKind::Moment => DIRECTIONS
            .iter()
            .map(|d| (load.terms.iter().zip(d).map(|(&(cut, _), d)| (cut, *d)).collect(), true))
            .collect(),
    }
}
