//! The force of a touching point.
//!
//! A contact is a spring and a damper along the normal, which only pushes, and a spring and a damper across it that slips
//! where its force would leave the cone of friction (Cundall and Strack 1979): at rest it sticks, and does not creep. Its
//! force is that at the end of the step, so that stiff contacts need no short steps: within a round it is linear in the
//! velocity there, `f = f₀ - C v`.

use super::model::Surface;
use crate::geometry::Vec3;
use crate::geometry::pose::length;

/// The spring across a contact, from one step to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spring {
    /// The number of the step in which the contact was loaded last; 0: never.
    touched: u64,
    /// The displacement across the normal, in the world, m.
    shift: Vec3,
    /// The part of the spring's force that friction bore last, 0 to 1.
    share: f64,
}

/// A point at which something pushes a body. Velocities and forces are in the world, those of the body against what
/// pushes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// The unit normal, towards the body.
    pub normal: Vec3,
    /// The depth of the body in what pushes it, m.
    pub depth: f64,
    /// The stiffness, N/m.
    pub stiffness: f64,
    /// The force per velocity at the end of the step, N·s/m: of damping, and of the way in the step.
    pub resistance: f64,
    /// The coefficient of friction, and that up to which the contact bears more than it does when it slides: while it has
    /// not slid.
    friction: [f64; 2],
    /// The displacement of its spring at the start of the step, m.
    pub shift: Vec3,
    /// True if the contact pushes.
    pub pushes: bool,
    /// The part of the spring's force across the normal that friction bears.
    pub share: f64,
    /// True if the last round changed whether it pushes, or that part.
    pub changed: bool,
    /// The force on the body, N: that of the last round, for the velocity that the round found.
    pub force: Vec3,
}

impl Contact {
    /// Returns a contact at the start of step `now` with what is known of its spring. `normal`: a unit vector; `depth`: m;
    /// `step`: the time step, s.
    #[inline(always)]
    pub(crate) fn new(
        normal: Vec3,
        depth: f64,
        surface: &Surface,
        (known, now): (&Spring, u64),
        step: f64,
    ) -> Contact {
        let lasts = known.touched > 0 && known.touched + 1 >= now;
        let shift = if lasts { across(&normal, &known.shift) } else { Vec3::zeros() };
        let share = if lasts { known.share } else { 1.0 };
        let sticks = if share < 1.0 { surface.friction } else { surface.static_friction };
        Contact {
            normal,
            depth,
            stiffness: surface.stiffness,
            resistance: (step + surface.damping) * surface.stiffness,
            friction: [surface.friction, sticks],
            shift,
            pushes: true,
            share,
            changed: false,
            force: Vec3::zeros(),
        }
    }

    /// Finds the force for the velocity (m/s) that a round found, and how the contact goes on: whether it pushes, and which
    /// part of its spring's force friction bears. Returns the square of how much the force would change, N².
    #[inline(always)]
    pub(crate) fn update(&mut self, velocity: &Vec3) -> f64 {
        let along = self.normal.dot(velocity);
        let slip = velocity - self.normal * along;
        let pressing = self.stiffness * self.depth - self.resistance * along;
        let tried = -self.shift * self.stiffness - slip * self.resistance;
        self.force = match self.pushes {
            true => self.normal * pressing + tried * self.share,
            false => Vec3::zeros(),
        };
        let before = (self.pushes, self.share);
        self.pushes = pressing > 0.0;
        let pressing = pressing.max(0.0);
        let ([slides, sticks], size) = (self.friction.map(|friction| friction * pressing), length(&tried));
        self.share = if size <= sticks { 1.0 } else { slides / size };
        self.changed = before != (self.pushes, self.share);
        (self.normal * pressing + tried * self.share - self.force).norm_squared()
    }

    /// Returns the speed at which it slides, m/s, for the velocity (m/s) at the end of the step; 0 while it sticks or does not
    /// push.
    pub(crate) fn slip(&self, velocity: &Vec3) -> f64 {
        if self.pushes && self.share < 1.0 { length(&across(&self.normal, velocity)) } else { 0.0 }
    }

    /// Returns the spring as the step after that of number `now` finds it, for the velocity (m/s) at the end of this one;
    /// `step`: the time step, s.
    #[inline(always)]
    pub(crate) fn kept(&self, velocity: &Vec3, step: f64, now: u64) -> Spring {
        // A spring that slips is as long as its force says.
        let shift = match self.share < 1.0 {
            true => -across(&self.normal, &self.force) / self.stiffness,
            false => self.shift + across(&self.normal, velocity) * step,
        };
        Spring { touched: now, shift, share: self.share }
    }
}

/// Returns the part of a vector across a unit normal.
fn across(normal: &Vec3, vector: &Vec3) -> Vec3 {
    vector - normal * normal.dot(vector)
}
