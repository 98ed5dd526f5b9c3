//! Landings: before a truss rolls, it is brought into a shape that carries its weight where it will land.
//!
//! A roll changes which nodes bear the weight at once, and a shape that was good before may be none after it. Near an
//! edge, steps bring down the forces that the truss will bear beyond it; where it could not stand there, it reshapes
//! with its centre of mass held before it rolls.

use super::rollout::{RELAXATIONS, Rollout};
use crate::geometry::Vec3;
use crate::planners::truss::forces;
use crate::planners::truss::roll::{self, Equilibrium};
use crate::planners::truss::step::QuadraticCost;
use crate::planners::truss::support_polygon;
use crate::robot::truss_statics::Forces;
use nalgebra::{Rotation3, Unit};

/// The number of strides within which the centre of mass gets to an edge so that the landing beyond it counts.
const STRIDES_AHEAD: f64 = 8.0;
/// The greatest number of steps in which a truss reshapes before one roll.
pub(super) const RESHAPING_MAX: usize = 60;

/// The forces where a truss will land, and the rotation that brings it there.
struct Landing {
    x: Vec<Vec3>,
    forces: Forces,
    rotation: Rotation3<f64>,
}

impl Rollout<'_> {
    /// Adds to the cost of a step what brings down the forces that the truss will bear after the roll that is ahead by a
    /// stride (m); nothing where none is, or where they are far from their limit.
    pub(super) fn prepare_landing(&mut self, cost: &mut QuadraticCost, stride: [f64; 2], pinned: &[usize]) {
        let Some(landing) = self.landing(stride) else { return };
        let Some(descent) = forces::descent(self.truss, &landing.x, &landing.forces, pinned) else { return };
        for (node, g) in descent.iter().enumerate() {
            let back = landing.rotation.inverse() * g;
            (0..3).for_each(|k| cost.linear[3 * node + k] += back[k]);
        }
    }

    /// Makes a step that brings the truss into a shape that may roll while its centre of mass stays; returns false if
    /// it has come into one, or there is no such step.
    pub(super) fn reshape(&mut self, stride: [f64; 2]) -> bool {
        let contacts = support_polygon::contacts(self.truss, &self.x);
        let standing = &RELAXATIONS[RELAXATIONS.len() - 1];
        let step = (self.reshaped < RESHAPING_MAX).then(|| self.attempt(standing, stride, &contacts));
        self.reshaping = false;
        self.reshaped += 1;
        let Some(Ok(y)) = step else { return false };
        self.travel.steps += 1;
        self.move_to(y);
        self.reshaping = !self.lands_well(stride);
        true
    }

    /// Returns true if forces within the limits would hold the truss where it lands by the roll ahead, or if none is.
    fn lands_well(&mut self, stride: [f64; 2]) -> bool {
        self.landing(stride).is_none_or(|landing| landing.forces.ratio <= 1.0)
    }

    /// Returns the landing of the roll ahead; `None` if none is, if the truss would roll on, or if nothing would hold it.
    fn landing(&mut self, stride: [f64; 2]) -> Option<Landing> {
        self.truss.limits.forces.as_ref()?;
        let contacts = support_polygon::contacts(self.truss, &self.x);
        let hull = support_polygon::hull(&self.x, &contacts);
        let way = Vec3::new(stride[0], stride[1], 0.0) * STRIDES_AHEAD;
        let ahead = self.truss.centre_of_mass(&self.x) + way;
        let (inside, edge) = support_polygon::margin(&self.x, &hull, ahead)?;
        if inside > 0.0 {
            return None;
        }
        let roll = roll::over(self.truss, &self.x, edge)?;
        let axis = Unit::new_normalize(self.x[edge.1] - self.x[edge.0]);
        let rotation = Rotation3::from_axis_angle(&axis, roll.angle);
        let x = roll::rolled(&self.x, roll);
        let feet = support_polygon::contacts(self.truss, &x);
        let Some(Equilibrium::Stable) = roll::equilibrium(self.truss, &x) else { return None };
        let forces = self.landed.at(self.truss, &x, &feet).ok()?;
        Some(Landing { x, forces, rotation })
    }
}
