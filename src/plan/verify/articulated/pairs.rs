//! Pairs of bodies, and what a stretch of time says of them.

use super::bodies::{Bodies, Body};
use super::frame::Frame;
use super::levels::Levels;
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
    /// The direction from a to b along which they were last told apart, in the frame of a's carrier;
    /// zero at first.
    pub normal: Vec3,
}

/// What is known of a pair over a stretch.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Lower bound of the distance over the whole stretch, m.
    pub least: f64,
    /// Lower bound of the distance in the middle, m.
    pub middle: f64,
}

/// A frame and how it is looked at.
#[derive(Clone, Copy)]
pub struct View<'a> {
    pub frame: &'a Frame,
    pub levels: &'a Levels,
    pub kinematics: &'a Kinematics,
}

/// A point that moves, as seen from a level's origin: position relative to another, and velocity.
struct Motion {
    p: Vec3,
    v: Vec3,
}

/// Of a ball around each module: nothing of them is nearer than this.
pub fn modules(view: &View, bodies: &Bodies, pair: &ModulePair) -> Bound {
    let frame = view.frame;
    let [a, b] = [pair.a, pair.b].map(|m| view.kinematics.link(m as usize, 0));
    let level = pair.level as usize;
    let stray = frame.stray(level, a).slip + frame.stray(level, b).slip;
    let reach = bodies.reach[pair.a as usize] + bodies.reach[pair.b as usize];
    let origin = &frame.links[view.levels.origin(level, a)];
    let (x, y) = (&frame.links[a], &frame.links[b]);
    let between = Motion { p: y.p - x.p, v: y.v - x.v - origin.spin.cross(&(y.p - x.p)) };
    between.bound(frame.stretch.half, frame.creep(stray), reach)
}

/// Of a ball around each body.
pub fn balls(view: &View, a: &Body, b: &Body, level: u32) -> Bound {
    let frame = view.frame;
    let (x, y) = (frame.centre(a), frame.centre(b));
    let origin = &frame.links[view.levels.origin(level as usize, a.carrier)];
    let d = y.p - x.p;
    let between = Motion { p: d, v: y.v - x.v - origin.spin.cross(&d) };
    let stray = |body: &Body| {
        let stray = frame.stray(level as usize, body.carrier);
        stray.slip + stray.swing * body.part.centre.norm()
    };
    between.bound(frame.stretch.half, frame.creep(stray(a) + stray(b)), a.part.radius + b.part.radius)
}

/// Of the slab between two bodies along a direction of a's carrier that is held still in the frame of
/// the level's origin. Points of each body move with its velocity and spin; a linear function's least
/// value over a convex body and over the stretch is at one of the stretch's ends.
pub fn slab(view: &View, a: &Body, b: &Body, pair: &BodyPair) -> Bound {
    let frame = view.frame;
    let level = pair.level as usize;
    let (x, y) = (&frame.links[a.carrier], &frame.links[b.carrier]);
    let origin = &frame.links[view.levels.origin(level, a.carrier)];
    let (p, q) = (frame.centre(a), frame.centre(b));
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
    let stray = |body: &Body| {
        let stray = frame.stray(level, body.carrier);
        stray.slip + stray.swing * body.reach
    };
    let half = frame.stretch.half;
    let still = turn_a == Vec3::zeros() && turn_b == Vec3::zeros() && parting == 0.0;
    let middle = gap(0.0);
    let ends = if still { middle } else { gap(half).min(gap(-half)) };
    Bound { least: ends - frame.creep(stray(a) + stray(b)), middle }
}

/// The distance in the middle, no more exactly than to see that it is at least `enough`; leaves its
/// direction in the pair.
pub fn measure(frame: &Frame, a: &Body, b: &Body, pair: &mut BodyPair, enough: f64) -> f64 {
    let X_AB = frame.relative(a.carrier, b.carrier);
    let start = (pair.normal != Vec3::zeros()).then_some(pair.normal);
    let found = signed_distance_within(&a.part, &b.part, &X_AB, start, enough);
    pair.normal = found.normal;
    found.distance
}

impl Motion {
    fn bound(&self, half: f64, creep: f64, reach: f64) -> Bound {
        let speed2 = self.v.norm_squared();
        let nearest = if speed2 > 0.0 { (-self.p.dot(&self.v) / speed2).clamp(-half, half) } else { 0.0 };
        let least = (self.p + self.v * nearest).norm() - creep - reach;
        Bound { least, middle: self.p.norm() - reach }
    }
}

impl Frame {
    /// World position and velocity of a body's centre.
    fn centre(&self, body: &Body) -> Motion {
        let link = &self.links[body.carrier];
        let arm = link.R * body.part.centre;
        Motion { p: link.p + arm, v: link.v + link.spin.cross(&arm) }
    }

    /// How far a point gets from uniform motion by the ends of the stretch if its velocity strays by
    /// so much, m: where nothing jumps, velocity strays in proportion to time.
    fn creep(&self, stray: f64) -> f64 {
        stray * self.stretch.half * if self.stretch.smooth { 0.5 } else { 1.0 }
    }
}
