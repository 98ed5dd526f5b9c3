//! Pairs of bodies, and what a interval of time says of them.

use super::bodies::{Bodies, Body};
use super::interval_state::IntervalState;
use super::reference_links::ReferenceLinks;
use crate::geometry::Vec3;
use crate::geometry::distance::signed_distance_within;
use crate::robot::Kinematics;

/// Two modules that have not been told apart yet.
#[derive(Clone, Copy, Debug)]
pub struct ModulePair {
    pub a: u32,
    pub b: u32,
    pub level: u32,
}

/// Two bodies that have not been told apart yet.
#[derive(Clone, Copy, Debug)]
pub struct BodyPair {
    pub a: u32,
    pub b: u32,
    pub level: u32,
    /// Whether they count for the clearance: two links that a joint joins do not.
    pub counts: bool,
    /// Deeper than this is a collision, m.
    pub allowed: f64,
    /// The direction from a to b along which they were last told apart, in the state of a's carrier;
    /// zero at first.
    pub normal: Vec3,
}

/// What is known of a pair over a interval.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Lower bound of the distance over the whole interval, m.
    pub least: f64,
    /// Lower bound of the distance in the middle, m.
    pub middle: f64,
}

/// A state and how it is looked at.
#[derive(Clone, Copy)]
pub struct View<'a> {
    pub state: &'a IntervalState,
    pub levels: &'a ReferenceLinks,
    pub kinematics: &'a Kinematics,
}

/// A point that moves, as seen from a level's origin: position relative to another, and velocity.
struct Motion {
    p: Vec3,
    v: Vec3,
}

/// Of a ball around each module: nothing of them is nearer than this.
pub fn module_bound(view: &View, bodies: &Bodies, pair: &ModulePair) -> Bound {
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

/// Of a ball around each body.
pub fn sphere_bound(view: &View, a: &Body, b: &Body, level: u32) -> Bound {
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

/// Of the slab between two bodies along a direction of a's carrier that is held still in the state of
/// the level's origin. Points of each body move with its velocity and spin; a linear function's least
/// value over a convex body and over the interval is at one of the interval's ends.
pub fn slab_bound(view: &View, a: &Body, b: &Body, pair: &BodyPair) -> Bound {
    let state = view.state;
    let level = pair.level as usize;
    let (x, y) = (&state.links[a.carrier], &state.links[b.carrier]);
    let origin = &state.links[view.levels.origin(level, a.carrier)];
    let (p, q) = (state.centre(a), state.centre(b));
    let d = q.p - p.p;
    let n = x.R * pair.normal;
    let apart = n.dot(&d);
    let parting = n.dot(&(q.v - p.v - origin.spin.cross(&d)));
    let (turn_a, turn_b) = (n.cross(&(x.spin - origin.spin)), n.cross(&(y.spin - origin.spin)));
    let gap = |t: f64| {
        let toward_b = x.R.tr_mul(&(n + turn_a * t));
        let toward_a = -y.R.tr_mul(&(n + turn_b * t));
        apart + parting * t - a.part.reach(&toward_b) - b.part.reach(&toward_a)
    };
    let deviation = |body: &Body| {
        let deviation = state.deviation(level, body.carrier);
        deviation.velocity + deviation.gradient * body.reach
    };
    let half = state.interval.half;
    let still = turn_a == Vec3::zeros() && turn_b == Vec3::zeros() && parting == 0.0;
    let middle = gap(0.0);
    let ends = if still { middle } else { gap(half).min(gap(-half)) };
    Bound { least: ends - state.drift(deviation(a) + deviation(b)), middle }
}

/// The distance in the middle, no more exactly than to see that it is at least `enough`; leaves its
/// direction in the pair.
pub fn measure(state: &IntervalState, a: &Body, b: &Body, pair: &mut BodyPair, enough: f64) -> f64 {
    let X_AB = state.relative(a.carrier, b.carrier);
    let start = (pair.normal != Vec3::zeros()).then_some(pair.normal);
    let found = signed_distance_within(&a.part, &b.part, &X_AB, start, enough);
    pair.normal = found.normal;
    found.distance
}

impl Motion {
    fn bound(&self, half: f64, drift: f64, reach: f64) -> Bound {
        let speed2 = self.v.norm_squared();
        let nearest = if speed2 > 0.0 { (-self.p.dot(&self.v) / speed2).clamp(-half, half) } else { 0.0 };
        let least = (self.p + self.v * nearest).norm() - drift - reach;
        Bound { least, middle: self.p.norm() - reach }
    }
}

impl IntervalState {
    /// World position and velocity of a body's centre.
    fn centre(&self, body: &Body) -> Motion {
        let link = &self.links[body.carrier];
        let arm = link.R * body.part.centre;
        Motion { p: link.p + arm, v: link.v + link.spin.cross(&arm) }
    }

    /// How far a point gets from uniform motion by the ends of the interval if its velocity deviations by
    /// so much, m: where nothing jumps, velocity deviations in proportion to time.
    fn drift(&self, deviation: f64) -> f64 {
        deviation * self.interval.half * if self.interval.smooth { 0.5 } else { 1.0 }
    }
}
