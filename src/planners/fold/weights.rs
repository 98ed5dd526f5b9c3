//! The cost of every hinge for every face that it carries, in closed form.
//!
//! With the leaves folded first (Alg. 2), the faces that a hinge moves already have their final form and nothing
//! else moves with it: one rigid body about a fixed axis. With the quintic motion of a step of one
//! second the mean torque of hinge e is `3.75 |φ_e| Σ_j K(e, j)`, over the faces j that it carries,
//! where K is the moment of inertia of face j of the target about the line through e. So the energy
//! of a layout is a sum over faces and the hinges on their paths from the root, and what a pair
//! contributes does not depend on the layout.

use super::inertia::{Inertia, moment_about};
use super::target::Target;

/// The integral of `|s''|` over 0..1, without unit, for the quintic time law `s = 10x³ - 15x⁴ + 6x⁵`: twice its
/// greatest slope.
pub(super) const QUINTIC: f64 = 3.75;

/// The cost of every hinge for carrying every face: the mean absolute torque that the face adds while the hinge folds,
/// N·m for steps of one second. Hinges and faces are given by their indices in [`Target::hinges`] and
/// [`Target::faces`].
#[derive(Clone, Debug)]
pub struct Weights {
    faces: usize,
    /// The weights, by hinge, then by face.
    table: Vec<f64>,
}

impl Weights {
    /// Returns the weights of a target; `masses`: one for each face in the order of [`Target::faces`], kg. `inertia`:
    /// how the mass of a panel is spread. Panics if there are more masses than faces.
    pub fn new(target: &Target, masses: &[f64], inertia: Inertia) -> Weights {
        let faces = target.faces.len();
        let mut table = Vec::with_capacity(faces * target.hinges.len());
        for hinge in &target.hinges {
            for (face, &mass) in masses.iter().enumerate() {
                let corners = target.corners(face);
                let moment = moment_about(corners, mass, inertia, &hinge.point, &hinge.axis);
                table.push(QUINTIC * hinge.angle.abs() * moment);
            }
        }
        Weights { faces, table }
    }

    /// Returns the weights of a target whose panels have one mass each (kg), spread evenly over the face without
    /// thickness.
    pub fn uniform(target: &Target, mass: f64) -> Weights {
        Weights::new(target, &vec![mass; target.faces.len()], Inertia::Lamina)
    }

    /// Returns the cost of `hinge` for carrying `face`, N·m for steps of one second; indices in [`Target::hinges`] and
    /// [`Target::faces`]. Panics if the target has no such hinge.
    #[inline]
    pub fn at(&self, hinge: usize, face: usize) -> f64 {
        self.table[hinge * self.faces + face]
    }

    /// Returns the costs of the hinge of this index in [`Target::hinges`], N·m for steps of one second: entry k is
    /// that for carrying face k of [`Target::faces`]. The hinge costs the same in both directions. Panics if the
    /// target has no such hinge.
    pub fn of_hinge(&self, hinge: usize) -> &[f64] {
        &self.table[hinge * self.faces..][..self.faces]
    }

    /// Returns the greatest weight of any hinge for any face, N·m for steps of one second: the scale for tolerances.
    pub fn greatest(&self) -> f64 {
        self.table.iter().copied().fold(0.0, f64::max)
    }

    /// Returns a copy of the weights in which the cost of each hinge for every face is greater by `extra[hinge]`, N·m
    /// for steps of one second. Panics if `extra` has fewer entries than there are hinges.
    pub(crate) fn perturbed(&self, extra: &[f64]) -> Weights {
        let table = self.table.iter().enumerate().map(|(i, w)| w + extra[i / self.faces]).collect();
        Weights { faces: self.faces, table }
    }
}
