//! The forces in the struts and contacts of a truss that hold it under loads.

use super::truss_layout::{Layout, directions};
use super::truss_stiffness::{Elastic, RESPONSE, RESPONSE_OFTEN, Stiffness};
use crate::geometry::Vec3;
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
/// The factor by which a contact that may grips more firmly in the next search.
const GRIP_GAIN: f64 = 2.0;
/// The part of its friction cone up to which a contact uses so little of it that it may grip more firmly.
const GRIP_FIRM: f64 = 0.2;
/// The part of its friction cone from which on a contact of many grips less where others slide.
const GRIP_NEAR: f64 = 0.7;
/// The part of its grip that such a contact is left with, and the least that a contact is left with at once.
const GRIP_LOSS: f64 = 0.01;
/// The greatest grip of many contacts where some slide.
const GRIP_EASY: f64 = 0.01;
/// The part of its friction cone that a contact is left with as its grip is loosened.
const GRIP_AIM: f64 = 0.8;
/// The part of the mean weight of struts below which none falls, so that the matrix stays well conditioned.
const WEIGHT_MIN: f64 = 1e-2;
/// The greatest number of systems solved until all contacts push within their cones.
const ROUNDS_MAX: usize = 60;
/// The number of contacts of which those that would pull are left out one by one, and for which the search is not eager.
const CONTACTS_FEW: usize = 16;
/// The part of the greatest pull from which on contacts are left out together where there are more.
const LET_GO: f64 = 0.25;
/// The pull of a contact, as a part of the whole load, that counts as none.
const PULL: f64 = 1e-9;
/// The force across a contact beyond its cone, as a part of the whole load, that the least grip may leave.
const LOOSE: f64 = 1e-5;
/// The greatest force, as a part of what struts bear, up to which forces on fewer contacts than there are do.
const RATIO_EASY: f64 = 0.8;
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

impl Contact {
    /// Returns the part of a force along the normal and the part across it.
    fn split(&self, force: &Vec3) -> (f64, Vec3) {
        let normal = force.dot(&self.normal);
        (normal, force - self.normal * normal)
    }

    /// Returns the part of a force along the normal and the size of the part across it.
    fn parts(&self, force: &Vec3) -> (f64, f64) {
        let (normal, across) = self.split(force);
        (normal, across.norm())
    }
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
#[derive(Clone, Debug, Default)]
pub struct Weights {
    /// The weight of the square of each strut's force, of mean 1; empty for equal ones.
    pub struts: Vec<f64>,
    /// The stiffness of each node's contact across its normal.
    grips: Vec<f64>,
    /// True for nodes on the ground that it would have to pull, or would have had to the last time.
    lifted: Vec<bool>,
    /// The stiffness matrix of the last search.
    stiffness: Option<Stiffness>,
    /// The stiffness of each node's contact with which the last search found forces.
    springs: Vec<Matrix3<f64>>,
    /// True if contacts change often.
    restless: bool,
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

/// The change of the forces of struts and contacts that balances a change of the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceChange {
    /// The change of the force of each strut, N.
    pub struts: Vec<f64>,
    /// The change of the force of the ground on each contact, in their order, in the world, N.
    pub contacts: Vec<Vec3>,
}

/// The contacts of a truss, and how forces on them are searched.
#[derive(Clone, Copy)]
struct Ground<'a> {
    contacts: &'a [Contact],
    model: &'a ForceModel,
    /// The whole load, N.
    whole: f64,
    /// True if contacts that would pull are let go all at once, and all grip little as soon as some slide.
    eager: bool,
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
    /// Returns equal weights for searches in which contacts let go and slide often, as where a truss accelerates. Of many contacts all
    /// that would pull let go at once from the first search on.
    pub fn restless() -> Weights {
        Weights { restless: true, ..Weights::default() }
    }

    /// Returns forces that hold a truss at rest, those with the least weighted sum of squares: by the stiffness method,
    /// in which contacts that would pull are left out, and those beyond their friction cone grip less, until none is. The
    /// search begins with the contacts that were left out the last time, but for those that would go into the ground. On many
    /// contacts it begins with all as the last one left them: forces on fewer of them, or with less grip, are in equilibrium
    /// as well, and are taken while they leave much of what struts bear.
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
        let begun = self.restless || !self.lifted.is_empty();
        self.lifted.resize(x.len(), false);
        self.grips.resize(x.len(), GRIP_MAX);
        self.struts.resize(struts.len(), 1.0);
        let whole = model.loads.iter().map(Vec3::norm).sum();
        let many = contacts.len() > CONTACTS_FEW;
        let ground = Ground { contacts, model, whole, eager: many };
        if begun && many || contacts.iter().any(|contact| self.lifted[contact.node]) {
            let (grips, found) = (self.grips.clone(), self.searched(layout, x, struts, &ground));
            if found.is_ok() {
                return found;
            }
            self.grips = grips;
        }
        self.lifted.fill(false);
        self.searched(layout, x, struts, &Ground { eager: false, ..ground })
    }

    /// Returns forces as [`forces`](Weights::forces) does, from the contacts that are left out at first.
    fn searched(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        ground: &Ground,
    ) -> Result<Forces, ForcesError> {
        let Ground { contacts, model, eager, .. } = *ground;
        let mut supposed = contacts.iter().any(|contact| self.lifted[contact.node]);
        let rows = directions(x, struts);
        let mut error = ForcesError::Falls;
        let mut springs = vec![Matrix3::zeros(); x.len()];
        let mut last = Vec::new();
        for _ in 0..ROUNDS_MAX {
            for contact in contacts {
                let lifted = self.lifted[contact.node];
                springs[contact.node] = if lifted { Matrix3::zeros() } else { self.spring(contact) };
            }
            let response = if self.restless { RESPONSE_OFTEN } else { RESPONSE };
            let elastic = Elastic { layout, x, struts, rows: &rows, weights: &self.struts, response };
            let found = elastic.displacements(&springs, &model.loads, &mut self.stiffness);
            let Some(displacements) = found else {
                // The contacts let go last leave nothing that holds the truss: they go in place of those before them.
                self.exchange(contacts, &last)?;
                continue;
            };
            if !eager && std::mem::take(&mut supposed) && self.put_back(contacts, &displacements) {
                continue;
            }
            let push = |contact: &Contact| -(springs[contact.node] * displacements[contact.node]);
            let pushes: Vec<Vec3> = contacts.iter().map(push).collect();
            let gone = self.let_go(ground, &pushes);
            if !gone.is_empty() {
                last = gone;
                continue;
            }
            if let Some(node) = self.loosened(ground, &pushes)? {
                error = ForcesError::Slides(node);
                continue;
            }
            let found = self.found(x, struts, (contacts, pushes), model, (&rows, displacements))?;
            if !eager || found.ratio > RATIO_EASY {
                if std::mem::take(&mut supposed) && self.put_back(contacts, &found.displacements) {
                    continue;
                }
                self.firm(contacts, &found, model);
            }
            self.springs = springs;
            return Ok(found);
        }
        Err(error)
    }

    /// Leaves out the contacts that would have to pull most; all that would if the search is eager. Returns their nodes.
    /// `pushes`: the forces of contacts, N.
    fn let_go(&mut self, ground: &Ground, pushes: &[Vec3]) -> Vec<usize> {
        let Ground { contacts, whole, eager, .. } = *ground;
        let along = |(contact, push): (&Contact, &Vec3)| (contact.node, push.dot(&contact.normal));
        let normals = || contacts.iter().zip(pushes).map(along);
        let most = normals().map(|(_, push)| push).fold(0.0, f64::min);
        if most >= -PULL * whole {
            return Vec::new();
        }
        let part = match contacts.len() > CONTACTS_FEW {
            _ if eager => 0.0,
            true => LET_GO,
            false => 1.0,
        };
        let least = (part * most).min(-PULL * whole);
        let gone: Vec<usize> = normals().filter(|(_, push)| *push <= least).map(|(node, _)| node).collect();
        gone.iter().for_each(|node| self.lifted[*node] = true);
        gone
    }

    /// Puts back all contacts that were left out but the last ones.
    ///
    /// # Errors
    /// There are no others.
    fn exchange(&mut self, contacts: &[Contact], last: &[usize]) -> Result<(), ForcesError> {
        let others = contacts.iter().filter(|contact| !last.contains(&contact.node));
        let before: Vec<usize> =
            others.map(|contact| contact.node).filter(|node| self.lifted[*node]).collect();
        before.iter().for_each(|node| self.lifted[*node] = false);
        if before.is_empty() { Err(ForcesError::NoHold(0)) } else { Ok(()) }
    }

    /// Loosens the grip of contacts beyond their cones, and returns one of them; `None` if there is none. `pushes`: the forces
    /// of contacts, N.
    ///
    /// # Errors
    /// A contact slides though it grips least.
    fn loosened(&mut self, ground: &Ground, pushes: &[Vec3]) -> Result<Option<usize>, ForcesError> {
        let Ground { contacts, model, whole, eager } = *ground;
        let mut loosened = Vec::new();
        let mut slides = None;
        for (contact, push) in contacts.iter().zip(pushes).filter(|(contact, _)| !self.lifted[contact.node]) {
            let node = contact.node;
            let (normal, across) = contact.parts(push);
            let (cone, least) = (model.friction * normal, self.grips[node] <= GRIP_MIN);
            let slack = if least { LOOSE } else { PULL };
            let beyond = across > cone + slack * whole;
            if beyond && least {
                return Err(ForcesError::Slides(node));
            }
            if beyond {
                slides = Some(node);
            }
            if eager && across > GRIP_NEAR * cone {
                loosened.push((node, GRIP_LOSS));
            } else if beyond {
                loosened.push((node, (GRIP_AIM * cone.max(0.0) / across).max(GRIP_LOSS)));
            }
        }
        if slides.is_none() {
            return Ok(None);
        }
        if eager {
            let nodes = contacts.iter().map(|contact| contact.node);
            nodes.for_each(|node| self.grips[node] = self.grips[node].min(GRIP_EASY));
        }
        for (node, part) in loosened {
            self.grips[node] = (self.grips[node] * part).max(GRIP_MIN);
        }
        Ok(slides)
    }

    /// Puts contacts back that were left out and go into the ground by these displacements of the nodes. Returns true if there
    /// are some.
    fn put_back(&mut self, contacts: &[Contact], displacements: &[Vec3]) -> bool {
        let sinks = |contact: &&Contact| {
            self.lifted[contact.node] && displacements[contact.node].dot(&contact.normal) < 0.0
        };
        let sinking: Vec<usize> = contacts.iter().filter(sinks).map(|contact| contact.node).collect();
        sinking.iter().for_each(|node| self.lifted[*node] = false);
        !sinking.is_empty()
    }

    /// Lets contacts that use little of their cones grip more firmly in the next search.
    fn firm(&mut self, contacts: &[Contact], found: &Forces, model: &ForceModel) {
        for (contact, push) in contacts.iter().zip(&found.contacts) {
            let (normal, across) = contact.parts(push);
            if across <= GRIP_FIRM * model.friction * normal {
                let grip = &mut self.grips[contact.node];
                *grip = (*grip * GRIP_GAIN).min(GRIP_MAX);
            }
        }
    }

    /// Returns the forces that belong to displacements, if they are in equilibrium.
    fn found(
        &self,
        x: &[Vec3],
        struts: &[(usize, usize)],
        (contacts, pushes): (&[Contact], Vec<Vec3>),
        model: &ForceModel,
        (rows, displacements): (&[Vec3], Vec<Vec3>),
    ) -> Result<Forces, ForcesError> {
        let held = (contacts, &pushes[..]);
        let forces = balanced((struts, rows), (&self.struts, &displacements), held, &model.loads)
            .map_err(ForcesError::NoHold)?;
        let (mut ratio, mut worst) = (0.0, 0);
        for (strut, (&(a, b), force)) in struts.iter().zip(&forces).enumerate() {
            let part = model.ratio(*force, (x[b] - x[a]).norm());
            if part > ratio {
                (ratio, worst) = (part, strut);
            }
        }
        let energy = model.loads.iter().zip(&displacements).map(|(load, u)| load.dot(u)).sum();
        Ok(Forces { struts: forces, contacts: pushes, ratio, strut: worst, displacements, energy })
    }

    /// Returns a copy of these weights with the decomposition of the last search, which these lose, for searches in which contacts let
    /// go and slide often.
    pub fn with_decomposition_moved(&mut self) -> Weights {
        let stiffness = self.stiffness.take();
        let moved = Weights { restless: true, ..self.clone() };
        // Weights of struts that were levelled since belong to the next search.
        let struts = stiffness.as_ref().map(|known| known.weights().to_vec());
        Weights { struts: struts.unwrap_or_else(|| self.struts.clone()), stiffness, ..moved }
    }

    /// Returns the stiffness of each node's contact with which the last search found forces.
    pub fn springs(&self) -> &[Matrix3<f64>] {
        &self.springs
    }

    /// Begins the next search with the contacts as they are in that of other weights, if there are many.
    pub fn stand_as(&mut self, other: &Weights, contacts: &[Contact]) {
        if contacts.len() > CONTACTS_FEW {
            self.lifted.clone_from(&other.lifted);
            self.grips.clone_from(&other.grips);
        }
    }

    /// Returns the change of the forces of the last search that belongs to a change of the loads (N, by node), while contacts hold as
    /// they do there: by the decomposition of that search. The arguments are those of it. `None` if there is none, or what is found
    /// is not in equilibrium.
    pub fn response(
        &mut self,
        layout: &Layout,
        x: &[Vec3],
        struts: &[(usize, usize)],
        contacts: &[Contact],
        loads: &[Vec3],
    ) -> Option<ForceChange> {
        let weights = self.stiffness.as_ref()?.weights().to_vec();
        let (rows, response) = (directions(x, struts), RESPONSE_OFTEN);
        let elastic = Elastic { layout, x, struts, rows: &rows, weights: &weights, response };
        let displacements = elastic.displacements(&self.springs, loads, &mut self.stiffness)?;
        let push = |contact: &Contact| -(self.springs[contact.node] * displacements[contact.node]);
        let pushes: Vec<Vec3> = contacts.iter().map(push).collect();
        let forces =
            balanced((struts, &rows), (&weights, &displacements), (contacts, &pushes), loads).ok()?;
        Some(ForceChange { struts: forces, contacts: pushes })
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
    /// Returns the multiple of a change, 0 or more, up to which all forces with it stay within what struts bear and contacts within
    /// their cones; infinite where they always do. `lengths`: the length of each strut, m; `contacts`: those of these forces.
    pub fn borne_multiple(
        &self,
        change: &ForceChange,
        lengths: impl Fn(usize) -> f64,
        contacts: &[Contact],
        model: &ForceModel,
    ) -> f64 {
        let of_strut = |(strut, (force, change)): (usize, (&f64, &f64))| {
            let (pull, push) = model.limits(lengths(strut));
            let left = if *change >= 0.0 { pull - force } else { push + force };
            if *change == 0.0 && left >= 0.0 { f64::INFINITY } else { left / change.abs() }
        };
        let struts = self.struts.iter().zip(&change.struts).enumerate().map(of_strut);
        let pushes = self.contacts.iter().zip(&change.contacts);
        let cones = contacts.iter().zip(pushes).map(|(contact, (push, change))| {
            let ((normal, across), (rise, turn)) = (contact.split(push), contact.split(change));
            // Within the cone as long as |across + k turn|² ≤ friction² (normal + k rise)².
            let square = model.friction * model.friction;
            let [a, b, c] = [
                turn.norm_squared() - square * rise * rise,
                across.dot(&turn) - square * normal * rise,
                across.norm_squared() - square * normal * normal,
            ];
            // It pushes, since a cone that points upwards goes on below its tip otherwise.
            let lifts = if rise < 0.0 { normal / -rise } else { f64::INFINITY };
            first_root(a, b, c).min(lifts)
        });
        struts.chain(cones).fold(f64::INFINITY, f64::min).max(0.0)
    }

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

/// Returns the forces of struts that belong to displacements of the nodes, N, if they and the pushes of the contacts balance the loads.
/// `rows`: the unit vector along each strut; `weights`: the weight of each.
///
/// # Errors
/// The node at which most of the loads is left over, if that is more than rounding.
fn balanced(
    (struts, rows): (&[(usize, usize)], &[Vec3]),
    (weights, displacements): (&[f64], &[Vec3]),
    (contacts, pushes): (&[Contact], &[Vec3]),
    loads: &[Vec3],
) -> Result<Vec<f64>, usize> {
    let mut rest = loads.to_vec();
    let mut forces = Vec::with_capacity(struts.len());
    for ((&(a, b), e), weight) in struts.iter().zip(rows).zip(weights) {
        let force = e.dot(&(displacements[b] - displacements[a])) / weight;
        rest[a] += e * force;
        rest[b] -= e * force;
        forces.push(force);
    }
    contacts.iter().zip(pushes).for_each(|(contact, push)| rest[contact.node] += push);
    let whole: f64 = loads.iter().map(Vec3::norm).sum();
    let off = (0..rest.len()).max_by(|&i, &j| rest[i].norm().total_cmp(&rest[j].norm())).unwrap_or(0);
    if rest[off].norm() > RESIDUAL * whole { Err(off) } else { Ok(forces) }
}

/// Returns the least k ≥ 0 from which on `a k² + 2 b k + c` is above 0; infinite if there is none, 0 if it is at once.
fn first_root(a: f64, b: f64, c: f64) -> f64 {
    if c > 0.0 {
        return 0.0;
    }
    let square = b * b - a * c;
    if square < 0.0 || a <= 0.0 && b <= 0.0 {
        return f64::INFINITY;
    }
    // The forms without cancellation.
    if b > 0.0 { -c / (b + square.sqrt()) } else { (square.sqrt() - b) / a }
}
