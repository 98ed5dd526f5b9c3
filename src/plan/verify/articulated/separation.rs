//! Separation of pairs of modules and bodies over an interval of time, for conservative advancement (see
//! [`collision`](super::collision)): lower bounds on their distance from bounding spheres and from separating slabs.

use super::bodies::{Bodies, Body};
use super::interval_state::{IntervalState, Moving};
use super::reference_links::ReferenceLinks;
use crate::geometry::Vec3;
use crate::geometry::distance::signed_distance_within;
use crate::robot::Kinematics;

/// Two modules that are not proved to be separated yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModulePair {
    /// The index in the assembly of the first module.
    pub a: u32,
    /// The index in the assembly of the second module.
    pub b: u32,
    /// The level of the modules' reference link, an index in [`ReferenceLinks::levels`].
    pub level: u32,
}

/// Two bodies that are not proved to be separated yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyPair {
    /// The index of the first body in [`Bodies::bodies`].
    pub a: u32,
    /// The index of the second body in [`Bodies::bodies`].
    pub b: u32,
    /// The level of the bodies' reference link, an index in [`ReferenceLinks::levels`].
    pub level: u32,
    /// True if the pair counts for the clearance: two links that a joint joins do not.
    pub counts: bool,
    /// The greatest penetration depth that is no collision, m.
    pub allowed: f64,
    /// The unit vector of the separating direction from a to b found last, in the frame of a's carrier; zero at first.
    pub normal: Vec3,
}

/// Lower bounds on the distance of a pair over an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// A lower bound on the distance of the pair over the whole interval, m.
    pub least: f64,
    /// A lower bound on the distance of the pair in the middle of the interval, m.
    pub middle: f64,
}

/// The state of an interval with what it refers to.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    /// The state of the robot in the middle of the interval.
    pub state: &'a IntervalState,
    /// The reference links of the modules.
    pub levels: &'a ReferenceLinks,
    /// The kinematics of the part of the robot that bonds connect.
    pub kinematics: &'a Kinematics,
}

/// A point that moves: its position in the middle of the interval, and its velocity as seen from a level's origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// The position of the point in the middle of the interval, m, in the frame of the root link.
    pub p: Vec3,
    /// The velocity of the point, m/s, as seen from the origin of the level's reference link.
    pub v: Vec3,
}

/// Returns the bound from a bounding sphere of each module.
pub(super) fn module_bound(view: &View, bodies: &Bodies, pair: &ModulePair) -> Bound {
    let state = view.state;
    let [a, b] = [pair.a, pair.b].map(|m| view.kinematics.link(m as usize, 0));
    let level = pair.level as usize;
    let deviation = state.deviation(level, a).velocity + state.deviation(level, b).velocity;
    let reach = bodies.reach[pair.a as usize] + bodies.reach[pair.b as usize];
    let origin = &state.links[view.levels.origin(level, a)];
    let (x, y) = (&state.links[a], &state.links[b]);
    let between = Motion { p: y.p - x.p, v: y.v - x.v - origin.spin.cross(&(y.p - x.p)) };
    between.bound(state.interval.half, state.drift(deviation), reach)
}

/// Returns the bound from a bounding sphere of each body.
pub(super) fn sphere_bound(view: &View, a: &Body, b: &Body, level: u32) -> Bound {
    let state = view.state;
    let (x, y) = (state.centre(a), state.centre(b));
    let origin = &state.links[view.levels.origin(level as usize, a.carrier)];
    let d = y.p - x.p;
    let between = Motion { p: d, v: y.v - x.v - origin.spin.cross(&d) };
    let deviation = |body: &Body| {
        let deviation = state.deviation(level as usize, body.carrier);
        deviation.velocity + deviation.gradient * body.part.centre.norm()
    };
    between.bound(
        state.interval.half,
        state.drift(deviation(a) + deviation(b)),
        a.part.radius + b.part.radius,
    )
}

/// The slab between two bodies along a direction of the first one's carrier that is held still in the state of the
/// level's origin. Points of each body move with its velocity and spin; a linear function's least value over a convex
/// body and over the interval is at one of the interval's ends.
pub(super) struct Slab<'a> {
    bodies: (&'a Body, &'a Body),
    carriers: (&'a Moving, &'a Moving),
    n: Vec3,
    /// The distance of the centres along `n`, m, and its rate, m/s.
    apart: f64,
    parting: f64,
    turn_a: Vec3,
    turn_b: Vec3,
    half: f64,
    drift: f64,
}

impl<'a> Slab<'a> {
    /// Returns the slab along the direction of a pair of bodies.
    pub(super) fn new(view: &View<'a>, a: &'a Body, b: &'a Body, pair: &BodyPair) -> Slab<'a> {
        let state = view.state;
        let level = pair.level as usize;
        let (x, y) = (&state.links[a.carrier], &state.links[b.carrier]);
        let origin = &state.links[view.levels.origin(level, a.carrier)];
        let (p, q) = (state.centre(a), state.centre(b));
        let d = q.p - p.p;
        let n = x.R * pair.normal;
        let deviation = |body: &Body| {
            let deviation = state.deviation(level, body.carrier);
            deviation.velocity + deviation.gradient * body.reach
        };
        Slab {
            bodies: (a, b),
            carriers: (x, y),
            n,
            apart: n.dot(&d),
            parting: n.dot(&(q.v - p.v - origin.spin.cross(&d))),
            turn_a: n.cross(&(x.spin - origin.spin)),
            turn_b: n.cross(&(y.spin - origin.spin)),
            half: state.interval.half,
            drift: state.drift(deviation(a) + deviation(b)),
        }
    }

    /// Returns its thickness in the middle of the interval, m.
    pub(super) fn middle(&self) -> f64 {
        self.gap(0.0)
    }

    /// Returns a lower bound on its thickness over the whole interval, m.
    pub(super) fn least(&self) -> f64 {
        let still = self.turn_a == Vec3::zeros() && self.turn_b == Vec3::zeros() && self.parting == 0.0;
        let ends = if still { self.gap(0.0) } else { self.gap(self.half).min(self.gap(-self.half)) };
        ends - self.drift
    }

    /// Returns its thickness in uniform motion at a time from the middle (s), m.
    fn gap(&self, t: f64) -> f64 {
        let toward_b = self.carriers.0.R.tr_mul(&(self.n + self.turn_a * t));
        let toward_a = -self.carriers.1.R.tr_mul(&(self.n + self.turn_b * t));
        let (a, b) = self.bodies;
        self.apart + self.parting * t - a.part.reach(&toward_b) - b.part.reach(&toward_a)
    }
}

/// Returns the signed distance of two bodies in the middle of the interval (m), or, once it is known to be at least
/// `enough` (m), a lower bound of at least that. Its direction is left in `pair.normal`.
pub(super) fn measure(state: &IntervalState, a: &Body, b: &Body, pair: &mut BodyPair, enough: f64) -> f64 {
    let X_AB = state.relative(a.carrier, b.carrier);
    let start = (pair.normal != Vec3::zeros()).then_some(pair.normal);
    let found = signed_distance_within(&a.part, &b.part, &X_AB, start, enough);
    pair.normal = found.normal;
    found.distance
}

impl Motion {
    /// Returns the motion of another point relative to this one.
    pub(super) fn to(&self, other: &Motion) -> Motion {
        Motion { p: other.p - self.p, v: other.v - self.v }
    }

    /// Returns the least distance from the origin in uniform motion, m, from `half` (s) before the middle until as long
    /// after it.
    pub(super) fn nearest(&self, half: f64) -> f64 {
        let speed2 = self.v.norm_squared();
        let nearest = if speed2 > 0.0 { (-self.p.dot(&self.v) / speed2).clamp(-half, half) } else { 0.0 };
        (self.p + self.v * nearest).norm()
    }

    fn bound(&self, half: f64, drift: f64, reach: f64) -> Bound {
        Bound { least: self.nearest(half) - drift - reach, middle: self.p.norm() - reach }
    }
}

impl IntervalState {
    /// Returns the world position and velocity of a body's centre.
    fn centre(&self, body: &Body) -> Motion {
        let link = &self.links[body.carrier];
        let arm = link.R * body.part.centre;
        Motion { p: link.p + arm, v: link.v + link.spin.cross(&arm) }
    }

    /// Returns the distance of a point from uniform motion at the ends of the interval (m) if its velocity deviates
    /// by so much: if nothing jumps, it deviates in proportion to time.
    pub(super) fn drift(&self, deviation: f64) -> f64 {
        deviation * self.interval.half * if self.interval.smooth { 0.5 } else { 1.0 }
    }
}
