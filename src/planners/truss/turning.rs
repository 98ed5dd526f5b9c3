//! What a truss meets while it turns as one rigid body about a line: the ground, where it is uneven, and
//! obstacles.

use super::bound::{Bound, DIP, POINTS};
use super::structure::Structure;
use super::support;
use crate::geometry::{Vec3, pose::turned};
use std::f64::consts::TAU;

/// A node this near above the ground (parts of the unit) has landed.
const LANDED: f64 = 1e-11;
/// A node on the ground has left it when it is higher than this part of the unit.
const LEFT: f64 = 2e-4;
/// How much nearer than the clearance an obstacle may come, in units.
const CUSHION: f64 = 1e-4;
/// Nodes this near to the line of a turn (parts of the unit) stay where they are.
pub const ON_LINE: f64 = 1e-9;
/// Looks at a turn.
const LOOKS_MAX: usize = 20_000;

/// A line with a direction, about which turns are by the right-hand rule.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub origin: Vec3,
    pub along: Vec3,
}

impl Line {
    pub fn turn(&self, angle: f64) -> impl Fn(Vec3) -> Vec3 + use<> {
        let (origin, rotation) = (self.origin, turned(self.along, angle).rotation);
        move |p| origin + rotation * (p - origin)
    }

    fn reach(&self, p: Vec3) -> f64 {
        let arm = p - self.origin;
        (arm - self.along * self.along.dot(&arm)).norm()
    }
}

/// The turn, rad, that brings a point from above down to uneven ground; a point that begins on it leaves it
/// first. `None` if it does not come there, or stays.
pub fn landing(truss: &Structure, line: &Line, p: Vec3) -> Option<f64> {
    let reach = line.reach(p);
    if reach <= ON_LINE * truss.unit {
        return None;
    }
    // The height changes by no more than this a radian.
    let rate = reach * libm::hypot(1.0, truss.around.steepest);
    let height = |angle: f64| truss.around.above(line.turn(angle)(p));
    let mut angle = 0.0;
    if height(0.0) <= support::ON_GROUND * truss.unit {
        while height(angle) < LEFT * truss.unit {
            angle += LEFT * truss.unit / (2.0 * rate);
            // It goes down from the start.
            if height(angle) < -LEFT * truss.unit {
                return Some(0.0);
            }
            if angle > TAU {
                return None;
            }
        }
    }
    for _ in 0..LOOKS_MAX {
        let above = height(angle);
        if above <= LANDED * truss.unit {
            return Some(angle);
        }
        angle += above / rate;
        if angle > TAU {
            return None;
        }
    }
    Some(angle)
}

/// What keeps a truss from turning: an obstacle, or ground that a strut would meet before its ends do.
pub fn blocked(truss: &Structure, x: &[Vec3], line: &Line, angle: f64) -> Option<Bound> {
    (0..truss.struts.len()).find_map(|strut| {
        let ends = truss.segment(x, strut);
        let reach = line.reach(ends.0).max(line.reach(ends.1));
        let farthest = reach * angle.abs().min(2.0);
        let near = |part: &usize| truss.around.may_meet(ends, *part, truss.clearance + farthest);
        let parts = (0..truss.around.parts.len()).filter(near);
        let hit = parts.into_iter().find(|&part| !clear(truss, (line, angle, reach), ends, part));
        hit.map(|part| Bound::Clear(strut, part, 0))
            .or_else(|| over(truss, (line, angle, reach), ends, strut))
    })
}

fn clear(
    truss: &Structure,
    (line, angle, reach): (&Line, f64, f64),
    ends: (Vec3, Vec3),
    part: usize,
) -> bool {
    let cushion = CUSHION * truss.unit;
    let spare = |done: f64| {
        let turned = line.turn(done * angle.signum());
        let enough = truss.clearance + cushion + reach * (angle.abs() - done);
        truss.around.nearness((turned(ends.0), turned(ends.1)), part, enough).distance - truss.clearance
    };
    let mut done = 0.0;
    for _ in 0..LOOKS_MAX {
        let spare = spare(done);
        if spare < 0.0 || done >= angle.abs() {
            return spare >= 0.0;
        }
        done = (done + (spare + cushion) / reach).min(angle.abs());
    }
    false
}

fn over(
    truss: &Structure,
    (line, angle, reach): (&Line, f64, f64),
    ends: (Vec3, Vec3),
    strut: usize,
) -> Option<Bound> {
    let terrain = truss.around.terrain.as_ref()?;
    let rate = reach * libm::hypot(1.0, truss.around.steepest);
    let mut done = 0.0;
    for _ in 0..LOOKS_MAX {
        let turned = line.turn(done * angle.signum());
        let (part, height) = terrain.lowest(turned(ends.0), turned(ends.1));
        let spare = height + truss.around.sink;
        if spare < DIP * truss.unit {
            let point = libm::round(part * POINTS as f64) as usize;
            return Some(Bound::Over(strut, point.clamp(1, POINTS - 1)));
        }
        if done >= angle.abs() {
            return None;
        }
        done = (done + spare / rate).min(angle.abs());
    }
    Some(Bound::Over(strut, POINTS / 2))
}
