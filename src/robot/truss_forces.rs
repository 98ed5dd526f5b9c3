//! The forces in the struts and contacts of a truss that hold it under loads.

use super::truss_layout::{Layout, directions};
use crate::geometry::Vec3;
use crate::optimize::cholesky::PivotRule;
use nalgebra::Matrix3;

/// The coefficient of friction of a truss's nodes on the ground where the world does not change it, without unit: that
/// of rubber on dry concrete, a round figure.
pub const FRICTION: f64 = 0.8;
/// The stiffness of a contact along its normal, relative to a strut's mean: the ground yields like a
/// strut, so that weight spreads over all contacts.
const CONTACT: f64 = 1.0;
/// The greatest stiffness of a contact across its normal.
const GRIP_MAX: f64 = 1.0;
/// The least stiffness of a contact across its normal: below it slides. A contact that bears next to nothing, right before the
/// truss tips, holds nothing across, either, however far a shape that yields much moves it.
const GRIP_MIN: f64 = 1e-8;
/// The factor by which a contact that held within its cone grips more firmly the next time.
const GRIP_GAIN: f64 = 2.0;
/// The part of its friction cone that a contact is left with as its grip is loosened.
const GRIP_AIM: f64 = 0.8;
/// The part of the mean weight of struts below which none falls, so that the matrix stays well conditioned.
const WEIGHT_MIN: f64 = 1e-2;
/// The least pivot as a part of its diagonal entry: below it nothing holds a node.
const PIVOT: f64 = 1e-11;
/// The greatest number of systems solved until all contacts push within their cones.
const ROUNDS_MAX: usize = 60;
/// The number of contacts of which those that would pull are left out one by one.
const CONTACTS_FEW: usize = 16;
/// The part of the greatest pull from which on contacts are left out together where there are more.
const LET_GO: f64 = 0.25;
/// The pull of a contact, as a part of the whole load, that counts as none.
const PULL: f64 = 1e-9;
/// The force across a contact beyond its cone, as a part of the whole load, that the least grip may leave.
const LOOSE: f64 = 1e-5;
/// The residual of equilibrium as a part of the whole load up to which forces are in equilibrium.
const RESIDUAL: f64 = 1e-7;

/// A node that stands on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The index of the node.
    pub node: usize,
    /// The normal of the ground there, a unit vector in the world.
    pub normal: Vec3,
}

/// The loads on a truss and the strength of its struts and contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceModel {
    /// The load on each node by its index, in the world, N: its weight.
    pub loads: Vec<Vec3>,
    /// The coefficient of friction of the contacts, without unit.
    pub friction: f64,
    /// The greatest force of a strut, N.
    pub force_max: f64,
    /// The product of the square of a strut's length and the pressure at which it buckles, N m²: π² times its bending
    /// stiffness; infinite for struts that do not buckle.
    pub buckling: f64,
}

impl ForceModel {
    /// Returns the model of struts that bear a part of what these do, without unit.
    pub fn with_strength(mut self, part: f64) -> ForceModel {
        self.force_max *= part;
        self.buckling *= part;
        self
    }

    /// Returns the greatest pull and the greatest pressure of a strut of a length (m), N.
    pub fn limits(&self, length: f64) -> (f64, f64) {
        (self.force_max, self.force_max.min(self.buckling / (length * length)))
    }

    /// Returns the force of a strut (N, tension positive) of a length (m), as a part of what it can bear.
    pub fn ratio(&self, force: f64, length: f64) -> f64 {
        let (pull, push) = self.limits(length);
        if force >= 0.0 { force / pull } else { -force / push }
    }
}

/// The weights of struts and the grips of contacts with which forces are distributed, by strut and by node. They go on
/// from one search to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// The weight of the square of each strut's force, of mean 1; empty for equal ones.
    pub struts: Vec<f64>,
    /// The stiffness of each node's contact across its normal.
    grips: Vec<f64>,
    /// True for nodes on the ground that it would have to pull, or would have had to the last time.
    lifted: Vec<bool>,
}

/// Forces that hold a truss: in equilibrium with the loads at every node, contacts within their cones.
#[derive(Clone, Debug, PartialEq)]
pub struct Forces {
    /// The force of each strut, N; tension positive.
    pub struts: Vec<f64>,
    /// The force of the ground on each contact, in their order, in the world, N.
    pub contacts: Vec<Vec3>,
    /// The greatest force of a strut as a part of what it can bear.
    pub ratio: f64,
    /// The strut of that force.
    pub strut: usize,
    /// The displacements whose products with the changes of loads are those of the weighted sum of squares.
    displacements: Vec<Vec3>,
    /// The weighted sum of squares.
    energy: f64,
}

/// The reason why no forces hold a truss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForcesError {
    /// No forces of struts and contacts, of whatever size, balance the loads on this node, or none were found.
    NoHold(usize),
    /// A contact, the index of its node, would have to slide.
    Slides(usize),
    /// The ground would have to pull at some nodes.
    Falls,
}

impl Weights {
    /// Returns forces that hold a truss at rest, those with the least weighted sum of squares: by the stiffness method,
    /// in which contacts that would pull are left out, and those beyond their friction cone grip less, until none is. The
    /// search begins with the contacts that were left out the last time, but for those that would go into the ground.
    /// `x`: the positions of the nodes, m; `struts`: those of the layout; `contacts`: the nodes on the ground.
    ///
    /// # Errors
    /// [`ForcesError`] if none were found.
    pub fn forces(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        contacts: &[Contact],
        model: &ForceModel,
    ) -> Result<Forces, ForcesError> {
        self.lifted.resize(x.len(), false);
        if contacts.iter().any(|contact| self.lifted[contact.node]) {
            let (grips, known) = (self.grips.clone(), self.searched(layout, x, struts, contacts, model));
            if known.is_ok() {
                return known;
            }
            self.grips = grips;
        }
        self.lifted.fill(false);
        self.searched(layout, x, struts, contacts, model)
    }

    /// Returns forces as [`forces`](Weights::forces) does, from the contacts that are left out at first.
    fn searched(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        contacts: &[Contact],
        model: &ForceModel,
    ) -> Result<Forces, ForcesError> {
        let mut supposed = contacts.iter().any(|contact| self.lifted[contact.node]);
        self.grips.resize(x.len(), GRIP_MAX);
        self.struts.resize(struts.len(), 1.0);
        self.grips.iter_mut().for_each(|grip| *grip = (*grip * GRIP_GAIN).min(GRIP_MAX));
        let whole: f64 = model.loads.iter().map(Vec3::norm).sum();
        let rows = directions(x, struts);
        let length = |&(a, b): &(usize, usize)| (x[b] - x[a]).norm();
        let along: Vec<(Vec3, f64)> = rows.iter().copied().zip(struts.iter().map(length)).collect();
        let mut error = ForcesError::Falls;
        for _ in 0..ROUNDS_MAX {
            let mut matrix = layout.matrix(&rows, struts, |strut| 1.0 / self.struts[strut], 0.0);
            for contact in contacts.iter().filter(|contact| !self.lifted[contact.node]) {
                layout.add(&mut matrix, contact.node, &self.spring(contact));
            }
            let mut u = layout.gathered(|node| model.loads[node]);
            let factor = matrix.cholesky(PivotRule::Refuse(PIVOT)).ok_or(ForcesError::NoHold(0))?;
            factor.solve_permuted(&mut u);
            let displacements: Vec<Vec3> = (0..x.len()).map(|node| layout.at(&u, node)).collect();
            // Contacts that were left out on supposition, and would go into the ground.
            if std::mem::take(&mut supposed) {
                let sinks = |contact: &&Contact| {
                    self.lifted[contact.node] && displacements[contact.node].dot(&contact.normal) < 0.0
                };
                let sinking: Vec<usize> = contacts.iter().filter(sinks).map(|contact| contact.node).collect();
                sinking.iter().for_each(|node| self.lifted[*node] = false);
                if !sinking.is_empty() {
                    continue;
                }
            }
            // The contacts that have to change most.
            let mut most = -PULL * whole;
            let mut slides = false;
            let mut pushes = vec![Vec3::zeros(); contacts.len()];
            for (contact, push) in contacts.iter().zip(&mut pushes) {
                let node = contact.node;
                if self.lifted[node] {
                    continue;
                }
                *push = -(self.spring(contact) * displacements[node]);
                most = most.min(push.dot(&contact.normal));
            }
            if most < -PULL * whole {
                let part = if contacts.len() > CONTACTS_FEW { LET_GO } else { 1.0 };
                for (contact, push) in contacts.iter().zip(&pushes) {
                    self.lifted[contact.node] |= push.dot(&contact.normal) <= part * most;
                }
                continue;
            }
            for (contact, push) in contacts.iter().zip(&pushes) {
                if self.lifted[contact.node] {
                    continue;
                }
                let normal = push.dot(&contact.normal).max(0.0);
                let across = (push - contact.normal * push.dot(&contact.normal)).norm();
                let grip = &mut self.grips[contact.node];
                let slack = if *grip > GRIP_MIN { PULL } else { LOOSE };
                if across > model.friction * normal + slack * whole {
                    if *grip <= GRIP_MIN {
                        return Err(ForcesError::Slides(contact.node));
                    }
                    *grip = (*grip * (GRIP_AIM * model.friction * normal / across).max(0.01)).max(GRIP_MIN);
                    slides = true;
                    error = ForcesError::Slides(contact.node);
                }
            }
            if slides {
                continue;
            }
            return self.found(x, struts, (contacts, pushes), model, (&along, displacements));
        }
        Err(error)
    }

    /// Returns the forces that belong to displacements, if they are in equilibrium.
    fn found(
        &self,
        x: &[Vec3],
        struts: &[(usize, usize)],
        (contacts, pushes): (&[Contact], Vec<Vec3>),
        model: &ForceModel,
        (along, displacements): (&[(Vec3, f64)], Vec<Vec3>),
    ) -> Result<Forces, ForcesError> {
        let mut rest = model.loads.clone();
        let mut forces = Vec::with_capacity(struts.len());
        let (mut ratio, mut worst) = (0.0, 0);
        for (strut, (&(a, b), (e, length))) in struts.iter().zip(along).enumerate() {
            let force = e.dot(&(displacements[b] - displacements[a])) / self.struts[strut];
            rest[a] += e * force;
            rest[b] -= e * force;
            let part = model.ratio(force, *length);
            if part > ratio {
                (ratio, worst) = (part, strut);
            }
            forces.push(force);
        }
        contacts.iter().zip(&pushes).for_each(|(contact, push)| rest[contact.node] += push);
        let whole: f64 = model.loads.iter().map(Vec3::norm).sum();
        let off = (0..x.len()).max_by(|&i, &j| rest[i].norm().total_cmp(&rest[j].norm())).unwrap_or(0);
        if rest[off].norm() > RESIDUAL * whole {
            return Err(ForcesError::NoHold(off));
        }
        let energy = model.loads.iter().zip(&displacements).map(|(load, u)| load.dot(u)).sum();
        Ok(Forces { struts: forces, contacts: pushes, ratio, strut: worst, displacements, energy })
    }

    /// Changes the weights of the struts so that the greatest of `forces` becomes less in the next search (Lawson
    /// 1961): each is multiplied by its force. The fixed point is the distribution whose greatest force is least.
    pub fn levelled(&mut self, forces: &Forces, lengths: impl Fn(usize) -> f64, model: &ForceModel) {
        let count = self.struts.len().max(1) as f64;
        let mut sum = 0.0;
        for (strut, weight) in self.struts.iter_mut().enumerate() {
            *weight *=
                model.ratio(forces.struts[strut], lengths(strut)) / forces.ratio.max(f64::MIN_POSITIVE);
            sum += *weight;
        }
        let mean = (sum / count).max(f64::MIN_POSITIVE);
        self.struts.iter_mut().for_each(|weight| *weight = (*weight / mean).max(WEIGHT_MIN));
    }

    /// Returns the stiffness of a contact.
    fn spring(&self, contact: &Contact) -> Matrix3<f64> {
        let normal = contact.normal * contact.normal.transpose();
        normal * CONTACT + (Matrix3::identity() - normal) * self.grips[contact.node]
    }
}

impl Forces {
    /// Returns the gradient of [`ratio`](Forces::ratio) over the positions of the nodes, 1/m, by index, as that of the
    /// weighted sum of squares (the envelope theorem), which near the least greatest force is its own. `x` and
    /// `struts`: as the forces were found for.
    pub fn gradient(&self, x: &[Vec3], struts: &[(usize, usize)]) -> Vec<Vec3> {
        let mut sums = vec![Vec3::zeros(); x.len()];
        let factor = self.ratio / self.energy.max(f64::MIN_POSITIVE);
        for (&(a, b), force) in struts.iter().zip(&self.struts) {
            let d = x[b] - x[a];
            let (e, apart) = (d.normalize(), self.displacements[b] - self.displacements[a]);
            let turned = (apart - e * e.dot(&apart)) * (force / d.norm() * factor);
            sums[a] += turned;
            sums[b] -= turned;
        }
        sums
    }
}
