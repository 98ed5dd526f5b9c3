//! The contact forces that minimise the greatest load of a robot: they decide if forces exist under which
//! nothing is overloaded.
//!
//! Each contact force lies in a pyramid inside its friction cone (linearised friction); together they carry the
//! weight. The least greatest load is the value of a linear program (LP). Its solution is not trusted: the forces
//! are brought to exact balance and the loads computed from them, which proves that they exist; and the Lagrange
//! multipliers give a lower bound for all contact forces.

use super::contact::ContactPoint;
use super::contact_lp::ContactLp;
use super::model::Model;
use super::stance::Stance;
use super::statics::{Load, Section, Structure, Wrench};
use super::tolerances::NUMERICS;
use super::tolerances::Tolerances;
use crate::geometry::Vec3;
use crate::optimize::solve_linear_program;
use crate::plan::verify::support_polygon;
use nalgebra::{Matrix6, Vector6};

/// The half diagonal of the square inside the unit circle.
const INSCRIBED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The greatest number of columns of an LP that is still solved.
const COLUMNS_MAX: usize = 100_000;

/// A unit force that may act, a column of the LP: along an edge of a contact's friction pyramid, or a component of
/// the wrench that a bond that closes a loop transmits.
pub(super) struct Column {
    /// The wrenches on links, each on one, that one unit of the force makes: the robot's weight, for a component of a
    /// moment the weight times a metre.
    pub wrenches: Vec<Wrench>,
    /// True if the force may also act in the opposite direction.
    pub free: bool,
}

/// Contact forces that balance the weight in one stance, with the loads that they cause.
#[derive(Clone, Debug)]
pub(super) struct ContactForces {
    /// The greatest load as a fraction of its limit, with forces that balance.
    pub ratio: f64,
    /// The index of the load with that ratio in [`Structure::loads`].
    pub load: usize,
    /// A lower bound on the greatest load, as a fraction of its limit, under any contact forces; from the dual
    /// solution of the LP; minus infinity without one.
    pub bound: f64,
    /// The forces found, from which the search at the next sample begins.
    pub warm_start: WarmStart,
    /// The load at every cut under these forces and the weights, in the order of [`Structure::sections`], N or N·m.
    pub held: Vec<f64>,
    /// The forces of the ground on the links, four for each contact along the edges of its pyramid, then the wrenches
    /// that bonds that close loops transmit.
    pub wrenches: Vec<Wrench>,
}

/// Contact forces of an earlier sample: if contacts stay the same, nearly the same forces balance again.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct WarmStart {
    /// The contacts, each as (index of the feature, number of the point), ascending.
    contacts: Vec<(usize, u8)>,
    /// The force of each contact along each edge of its pyramid, as a part of the weight.
    wrenches: Vec<[f64; EDGES]>,
    /// The wrenches of the bonds that close loops, six components each, as parts of the weight.
    loops: Vec<f64>,
}

/// The number of edges of the friction pyramid of a contact.
const EDGES: usize = 4;

/// A query for the contact forces in one stance under which the greatest of some loads is least.
pub(super) struct ContactQuery<'a> {
    /// The model of the robot with the bonds that hold.
    pub model: &'a Model<'a>,
    /// The structure of the robot's loads: its cuts at joints, motors and bonds.
    pub structure: &'a Structure,
    /// The stance of the robot for which forces are sought.
    pub stance: &'a Stance,
    /// The cuts of the robot in that stance.
    pub sections: &'a [Section],
    /// The weights of the links as wrenches, N and N·m.
    pub gravity_wrenches: &'a [Wrench],
    /// The loads at the cuts from the weights alone, in the order of [`Structure::sections`], N or N·m.
    pub weights: &'a [f64],
    /// The indices in [`Structure::loads`] of the loads that count.
    pub loads: &'a [usize],
    /// The weight of the robot, N.
    pub weight: f64,
    /// The factor on the friction coefficients of links, without unit; that of the world.
    pub friction: f64,
    /// True for a fixed base: then the ground does not push, and the fixture of the base balances the rest.
    pub fixed_base: bool,
    /// The tolerances of the judgement.
    pub tolerances: &'a Tolerances,
}

impl ContactForces {
    /// Returns the force of the ground at each contact point that carries something, N, at its point from the centre
    /// of mass in level axes, m, in the order of the contacts.
    pub(super) fn of_ground(&self) -> Vec<Wrench> {
        let edges = &self.wrenches[..self.warm_start.contacts.len() * EDGES];
        let force = |edges: &[Wrench]| Wrench { f: edges.iter().map(|edge| edge.f).sum(), ..edges[0] };
        edges.chunks_exact(EDGES).map(force).filter(|push| push.f.z > 0.0).collect()
    }
}

impl ContactQuery<'_> {
    /// Returns the forces of an earlier sample brought to exact balance in this stance, which certifies them without
    /// an LP; `None` if they cannot be.
    pub(super) fn warm_started(&self, warm_start: &WarmStart) -> Option<ContactForces> {
        let contacts = self.contacts();
        let columns = self.columns(&contacts);
        let mut sizes = Vec::with_capacity(columns.len());
        for contact_point in &contacts {
            // A new contact pushes nothing yet; the load of a lost one is missed, and the others take it over.
            let index = warm_start.contacts.binary_search(&(contact_point.feature, contact_point.k));
            sizes.extend(index.map_or([0.0; EDGES], |at| warm_start.wrenches[at]));
        }
        let loops = columns.len() - sizes.len();
        sizes.extend(if warm_start.loops.len() == loops {
            warm_start.loops.clone()
        } else {
            vec![0.0; loops]
        });
        self.certified(&contacts, &columns, &sizes, f64::NEG_INFINITY)
    }

    /// Returns the number of columns of the LP plus the number of its loads, as a measure of its cost.
    pub(super) fn lp_size(&self) -> usize {
        self.columns(&self.contacts()).len() + self.loads.len()
    }

    /// Returns contact forces whose greatest load, as a fraction of its limit, is least, by a linear program (LP);
    /// `None` if no forces balance the weight, the LP is too large, or the solver did not converge.
    pub(super) fn minimise_peak_load(&self) -> Option<ContactForces> {
        let contacts = self.contacts();
        let columns = self.columns(&contacts);
        if columns.len() > COLUMNS_MAX {
            return None;
        }
        let lp = ContactLp::new(self, &columns);
        let solution = solve_linear_program(&lp.problem).ok()?;
        let bound = lp.bound(self, &columns, &solution);
        self.certified(&contacts, &columns, &solution.x[..columns.len()], bound)
    }

    /// Returns the contact points that carry weight, reduced to the corners of each link's hull: a force at another
    /// point of it is a mean of forces there. None for a fixed base.
    fn contacts(&self) -> Vec<ContactPoint> {
        if self.fixed_base {
            return vec![];
        }
        let near: Vec<&ContactPoint> =
            self.stance.contact_points.iter().filter(|t| t.gap <= self.tolerances.gap_loaded).collect();
        let mut links: Vec<usize> = near.iter().map(|t| t.link).collect();
        links.sort_unstable();
        links.dedup();
        let mut chosen = Vec::new();
        for link in links {
            let own: Vec<&ContactPoint> = near.iter().copied().filter(|t| t.link == link).collect();
            let points: Vec<_> = own.iter().map(|t| [t.p.x, t.p.y]).collect();
            chosen.extend(support_polygon::hull(&points).into_iter().map(|i| *own[i]));
        }
        chosen.sort_by_key(|t| (t.feature, t.k));
        chosen
    }

    /// Returns the forces that may act: four for each contact, along the edges of its pyramid, then six for each bond
    /// that closes a loop.
    fn columns(&self, contacts: &[ContactPoint]) -> Vec<Column> {
        let mut columns = Vec::new();
        for contact_point in contacts {
            let slope = INSCRIBED * self.friction * self.model.bodies[contact_point.link].friction;
            for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                let f = Vec3::new(x * slope, y * slope, 1.0) * self.weight;
                let push = Wrench { link: contact_point.link, p: contact_point.p, f, m: Vec3::zeros() };
                columns.push(Column { wrenches: vec![push], free: false });
            }
        }
        for &(bond, a, b) in &self.structure.closing {
            let p = self.structure.closing_place(self.model, self.stance, bond);
            for axis in 0..6 {
                let unit = Vec3::ith(axis % 3, self.weight);
                let (f, m) = if axis < 3 { (unit, Vec3::zeros()) } else { (Vec3::zeros(), unit) };
                let wrenches = vec![Wrench { link: b, p, f, m }, Wrench { link: a, p, f: -f, m: -m }];
                columns.push(Column { wrenches, free: true });
            }
        }
        columns
    }

    /// Returns the columns that load the hinge of a bond that closes a loop, each with the part of the hinge's limit that its
    /// unit makes; none for other loads. `first`: the index of the first column of a loop.
    pub(super) fn in_loop(&self, load: &Load, first: usize) -> Vec<(usize, f64)> {
        let Some(hinge) = load.closing else { return vec![] };
        let axis = hinge.axis(self.stance) * (self.weight / load.limit);
        // The moments follow the forces.
        (0..3).map(|k| (first + 6 * hinge.index + 3 + k, axis[k])).collect()
    }

    /// Returns the force of a unit of a column, as a fraction of the weight, and its moment about the centre of mass,
    /// as a fraction of the weight times a metre, in level axes; zero for a column of a loop, which balances itself.
    pub(super) fn balance(&self, column: &Column) -> Vector6<f64> {
        let mut sum = Vector6::zeros();
        for push in column.wrenches.iter().filter(|_| !column.free) {
            let (f, m) = (push.f / self.weight, push.p.cross(&push.f) / self.weight);
            sum += Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
        }
        sum
    }

    /// Returns forces near those of the given sizes that balance up to the tolerance `balance`, and the loads that they
    /// make; `None` if none are found. `bound`: a lower bound on the greatest load, as a fraction of its limit.
    fn certified(
        &self,
        contacts: &[ContactPoint],
        columns: &[Column],
        sizes: &[f64],
        bound: f64,
    ) -> Option<ContactForces> {
        let sizes = self.balanced(columns, sizes)?;
        let mut wrenches = Vec::new();
        for (column, size) in columns.iter().zip(&sizes) {
            wrenches.extend(column.wrenches.iter().map(|p| Wrench { f: p.f * *size, m: p.m * *size, ..*p }));
        }
        let mut held = self.structure.held(self.model, self.sections, &wrenches);
        held.iter_mut().zip(self.weights).for_each(|(h, w)| *h += w);
        let first_of_loops = EDGES * contacts.len();
        let ratio = |index: usize| {
            let load = &self.structure.loads[index];
            let by_loop = self.in_loop(load, first_of_loops);
            let transmitted: f64 = by_loop.iter().map(|(column, share)| sizes[*column] * share).sum();
            self.structure.size(load, &held) / load.limit + transmitted.abs()
        };
        let worst = self.loads.iter().copied().reduce(|w, i| if ratio(i) > ratio(w) { i } else { w })?;
        let ratio = ratio(worst);
        let (edges, loops) = sizes.split_at(contacts.len() * EDGES);
        let edges = edges.chunks_exact(EDGES).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        let names = contacts.iter().map(|t| (t.feature, t.k)).collect();
        let warm_start = WarmStart { contacts: names, wrenches: edges, loops: loops.to_vec() };
        Some(ContactForces { ratio, load: worst, bound, warm_start, held, wrenches })
    }

    /// Returns sizes near the given ones that balance, each corrected in proportion to itself; `None` if none are
    /// found, or if a contact would have to pull.
    fn balanced(&self, columns: &[Column], sizes: &[f64]) -> Option<Vec<f64>> {
        if self.fixed_base {
            // Loops alone: what they transmit balances itself.
            return Some(sizes.to_vec());
        }
        let clipped: Vec<f64> =
            columns.iter().zip(sizes).map(|(c, s)| if c.free { *s } else { s.max(0.0) }).collect();
        let balances: Vec<_> = columns.iter().map(|c| self.balance(c)).collect();
        let mut sizes = clipped;
        let up = self.stance.up();
        let weight = Vector6::new(up.x, up.y, up.z, 0.0, 0.0, 0.0);
        for _ in 0..3 {
            let mut missing = weight;
            let mut normal = Matrix6::identity() * NUMERICS.balance_ridge;
            for (balance, size) in balances.iter().zip(&sizes) {
                missing -= balance * *size;
                normal += balance * balance.transpose() * size.abs();
            }
            if missing.norm() <= self.tolerances.balance * NUMERICS.balance_spare {
                break;
            }
            let multipliers = normal.cholesky()?.solve(&missing);
            let corrected = sizes.iter().zip(&balances).map(|(s, b)| s + s.abs() * b.dot(&multipliers));
            sizes = corrected.collect();
        }
        let mut missing = weight;
        balances.iter().zip(&sizes).for_each(|(b, s)| missing -= b * *s);
        let pushing = columns.iter().zip(&sizes).all(|(c, s)| c.free || *s >= 0.0);
        (missing.norm() <= self.tolerances.balance && pushing).then_some(sizes)
    }
}
