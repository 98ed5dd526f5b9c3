//! Rigid rotation of a truss about a line: touchdown of a node on uneven ground, and conservative advancement
//! of the struts against obstacles and ground.

use super::constraint::{Constraint, SAMPLES};
use super::structure::Structure;
use crate::geometry::{Vec3, pose::turned};
use std::f64::consts::TAU;

/// The greatest number of samples of one advancement; a rotation that needs more counts as blocked, a node as landed.
const ADVANCEMENT_STEPS_MAX: usize = 20_000;

/// A directed line in the world's frame; rotations about it are by the right-hand rule.
#[derive(Clone, Copy, Debug)]
pub(in crate::planners) struct Axis {
    /// A point of the axis of rotation, m.
    pub origin: Vec3,
    /// The direction of the axis, a unit vector.
    pub along: Vec3,
}

impl Axis {
    /// Returns the rotation about the axis by an angle (rad) as a function of points (m, in the world's frame).
    pub(super) fn rotation(&self, angle: f64) -> impl Fn(Vec3) -> Vec3 + use<> {
        let (origin, rotation) = (self.origin, turned(self.along, angle).rotation);
        move |p| origin + rotation * (p - origin)
    }

    /// Returns the distance of a point from the axis, m.
    fn radius(&self, p: Vec3) -> f64 {
        let arm = p - self.origin;
        (arm - self.along * self.along.dot(&arm)).norm()
    }
}

/// Returns the angle of rotation (rad) at which the point `p` (m) comes down on uneven ground from above; a point that
/// starts on the ground leaves it first. `None` if it does not come down, or is on the axis.
pub(super) fn touchdown(truss: &Structure, axis: &Axis, p: Vec3) -> Option<f64> {
    let (tolerances, unit) = (&truss.tolerances, truss.unit);
    let radius = axis.radius(p);
    if radius <= tolerances.on_axis * unit {
        return None;
    }
    // The height changes by no more than this a radian.
    let rate = radius * libm::hypot(1.0, truss.surroundings.slope_max);
    let height = |angle: f64| truss.surroundings.height(axis.rotation(angle)(p));
    let mut angle = 0.0;
    // A contact has to lift off first.
    let liftoff_height = tolerances.liftoff_height;
    if height(0.0) <= tolerances.contact_height * unit {
        while height(angle) < liftoff_height * unit {
            angle += liftoff_height * unit / (2.0 * rate);
            // It goes down from the start.
            if height(angle) < -liftoff_height * unit {
                return Some(0.0);
            }
            if angle > TAU {
                return None;
            }
        }
    }
    // Conservative advancement until it touches down.
    for _ in 0..ADVANCEMENT_STEPS_MAX {
        let above = height(angle);
        if above <= tolerances.touchdown_tol * unit {
            return Some(angle);
        }
        angle += above / rate;
        if angle > TAU {
            return None;
        }
    }
    Some(angle)
}

/// Returns a constraint that the truss would violate while it rotates by an angle, rad: a strut meets an obstacle, or
/// ground before its ends do. `None` if the rotation is free. `x`: the positions of the nodes at its start, m.
pub(super) fn blocked(truss: &Structure, x: &[Vec3], axis: &Axis, angle: f64) -> Option<Constraint> {
    (0..truss.struts.len()).find_map(|strut| {
        let ends = truss.segment(x, strut);
        let radius = axis.radius(ends.0).max(axis.radius(ends.1));
        // No point goes farther than its arc, nor than twice its radius.
        let farthest = radius * angle.abs().min(2.0);
        let near = |part: &usize| truss.surroundings.may_collide(ends, *part, truss.clearance + farthest);
        let parts = (0..truss.surroundings.parts.len()).filter(near);
        let sweep = Sweep { axis, angle, radius, ends };
        let hit = parts.into_iter().find(|&part| !sweep.clears(truss, part));
        hit.map(|part| Constraint::ObstacleClearance(strut, part, 0))
            .or_else(|| Some(Constraint::StrutHeight(strut, sweep.ground_contact(truss)?)))
    })
}

/// The rotation of one strut.
struct Sweep<'a> {
    axis: &'a Axis,
    /// The whole rotation, rad.
    angle: f64,
    /// The greatest distance of the strut from the axis, m: the speed of its fastest point a radian.
    radius: f64,
    /// The ends of the strut at the start, m.
    ends: (Vec3, Vec3),
}

impl Sweep<'_> {
    /// Returns the ends of the strut, m, once it has rotated by `done` (rad, not negative).
    fn ends_at(&self, done: f64) -> (Vec3, Vec3) {
        let rotate = self.axis.rotation(done * self.angle.signum());
        (rotate(self.ends.0), rotate(self.ends.1))
    }

    /// Returns true if the strut keeps the clearance from a part, by conservative advancement.
    fn clears(&self, truss: &Structure, part: usize) -> bool {
        let margin = truss.tolerances.roll_clearance_margin * truss.unit;
        let spare = |done: f64| {
            let enough = truss.clearance + margin + self.radius * (self.angle.abs() - done);
            truss.surroundings.signed_distance(self.ends_at(done), part, enough).distance - truss.clearance
        };
        let mut done = 0.0;
        for _ in 0..ADVANCEMENT_STEPS_MAX {
            let spare = spare(done);
            if spare < 0.0 || done >= self.angle.abs() {
                return spare >= 0.0;
            }
            done = (done + (spare + margin) / self.radius).min(self.angle.abs());
        }
        false
    }

    /// Returns the sample point of the strut that gets too far below uneven ground; `None` if none does.
    fn ground_contact(&self, truss: &Structure) -> Option<usize> {
        let terrain = truss.surroundings.terrain.as_ref()?;
        let rate = self.radius * libm::hypot(1.0, truss.surroundings.slope_max);
        let mut done = 0.0;
        for _ in 0..ADVANCEMENT_STEPS_MAX {
            let ends = self.ends_at(done);
            let (along, height) = terrain.lowest(ends.0, ends.1);
            let spare = height + truss.surroundings.sink_depth;
            if spare < truss.tolerances.ground_margin * truss.unit {
                return Some((libm::round(along * SAMPLES as f64) as usize).clamp(1, SAMPLES - 1));
            }
            if done >= self.angle.abs() {
                return None;
            }
            done = (done + spare / rate).min(self.angle.abs());
        }
        Some(SAMPLES / 2)
    }
}
