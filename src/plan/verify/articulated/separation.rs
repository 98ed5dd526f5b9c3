//! Separation of pairs of modules and bodies over an interval of time, for conservative advancement (see
//! [`collision`](super::collision)): lower bounds on their distance from bounding spheres and from separating slabs.

use super::bodies::{Bodies, Body};
use super::interval_state::{IntervalState, Moving};
use super::reference_links::ReferenceLinks;
use crate::geometry::Vec3;
use crate::geometry::distance::{Needed, signed_distance_as_needed};
use crate::robot::Kinematics;

/// A pair of modules that are not proved to be separated over the present interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModulePair {
    /// The index in the assembly of the first module.
    pub a: u32,
    /// The index in the assembly of the second module.
    pub b: u32,
    /// The level of the modules' reference link, an index in [`ReferenceLinks::levels`].
    pub level: u32,
}

/// A pair of bodies that are not proved to be separated over the present interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyPair {
    /// The index of the first body in [`Bodies::bodies`].
    pub a: u32,
    /// The index of the second body in [`Bodies::bodies`].
    pub b: u32,
    /// The level of the bodies' reference link, an index in [`ReferenceLinks::levels`].
    pub level: u32,
    /// True if the pair counts for the clearance: two links that a joint or a bond joins do not.
    pub counts: bool,
    /// The greatest penetration depth that is not a collision, m.
    pub allowed: f64,
    /// The unit vector of the separating direction from a to b found last, in the frame of a's carrier; zero at first.
    pub normal: Vec3,
}

/// Lower bounds on the signed distance of a pair over an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// A lower bound on the distance of the pair over the whole interval, m.
    pub least: f64,
    /// A lower bound on the distance of the pair in the middle of the interval, m.
    pub middle: f64,
}

/// The present interval, with the part of the robot and the reference links to which its state refers.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    /// The state of the robot in the middle of the interval.
    pub state: &'a IntervalState,
    /// The reference links of the modules.
    pub levels: &'a ReferenceLinks,
    /// The kinematics of the part of the robot that bonds connect.
    pub kinematics: &'a Kinematics,
}

/// A point in uniform motion over an interval, or the difference of two.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// The position of the point in the middle of the interval, m, in the frame of the root link.
    pub p: Vec3,
    /// The velocity of the point, m/s, as seen from the origin of the level's reference link.
    pub v: Vec3,
}

/// Returns lower bounds on the distance of two modules over the interval, from a bounding sphere of each about the
/// origin of its body link. The deviations of both body links must have been required.
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

/// Returns lower bounds on the distance of two bodies over the interval, from a bounding sphere of each about its
/// centre. `level`: that of their reference link; the deviations of their carriers must have been required.
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

/// The slab between two bodies along a unit direction, fixed in a frame that turns with the reference link. Its
/// thickness is the gap between the bodies along it, negative where they overlap. Points of each body move with its
/// velocity and spin; a linear function's least value over a convex body and over the interval is at one of the
/// interval's ends.
pub(super) struct Slab<'a> {
    bodies: (&'a Body, &'a Body),
    carriers: (&'a Moving, &'a Moving),
    /// The unit direction from the first body to the second, in the frame of the root link.
    n: Vec3,
    /// The distance of the centres along `n`, m, and its rate, m/s.
    apart: f64,
    parting: f64,
    /// The rate at which the direction turns as seen from the first body's carrier, 1/s.
    turn_a: Vec3,
    /// The rate at which the direction turns as seen from the second body's carrier, 1/s.
    turn_b: Vec3,
    /// Half the length of the interval, s.
    half: f64,
    /// A bound on the distance by which both bodies together deviate from uniform motion, m.
    drift: f64,
}

impl<'a> Slab<'a> {
    /// Returns the slab between the bodies `a` and `b` along the direction `pair.normal`; the deviations of their
    /// carriers must have been required.
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

    /// Returns the thickness of the slab in the middle of the interval, m.
    pub(super) fn middle(&self) -> f64 {
        self.gap(0.0)
    }

    /// Returns a lower bound on the thickness of the slab over the whole interval, m, and so on the distance of the
    /// bodies.
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

/// Returns the signed distance of two bodies in the middle of the interval, m, as well as it is `needed`; what is not
/// exact is a lower bound. Sets `pair.normal` to the direction of the distance, the first guess of the next call.
pub(super) fn measure(
    state: &IntervalState,
    a: &Body,
    b: &Body,
    pair: &mut BodyPair,
    needed: &Needed,
) -> f64 {
    let X_AB = state.relative(a.carrier, b.carrier);
    let start = (pair.normal != Vec3::zeros()).then_some(pair.normal);
    let found = signed_distance_as_needed(&a.part, &b.part, &X_AB, start, needed);
    pair.normal = found.normal;
    found.distance
}

impl Motion {
    /// Returns the motion of `other` relative to this point.
    pub(super) fn to(&self, other: &Motion) -> Motion {
        Motion { p: other.p - self.p, v: other.v - self.v }
    }

    /// Returns the least distance of the point from the origin, m, from `half` (s) before the middle of the interval
    /// until as long after it.
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

    /// Returns a bound on the distance of a point at the ends of the interval from where uniform motion would take it,
    /// m. `deviation`: a bound on the deviation of its velocity, m/s. Unless a rate jumps, that deviation grows in
    /// proportion to time, which halves the distance.
    pub(super) fn drift(&self, deviation: f64) -> f64 {
        deviation * self.interval.half * if self.interval.smooth { 0.5 } else { 1.0 }
    }
}
