//! One joint turns: how far, until two balls touch. Exact: every ball that moves does so on a circle
//! about the joint's axis.

use super::tree::{JointRef, Tree};
use crate::geometry::{RigidTransform, Vec3};
use std::f64::consts::TAU;

/// Balls on circles about one axis, in the axis' own cylindrical coordinates.
struct Ball {
    height: f64,
    radius: f64,
    /// Two directions of the plane across the axis.
    x: f64,
    y: f64,
}

/// How far of `angle` (rad, either sign) a joint can turn before two balls that were farther apart come
/// nearer than `apart`; pairs that are nearer at once may only part. Gives all of `angle` where nothing
/// is in the way. Balls on one side of the joint do not move against each other.
pub fn free(tree: &Tree, joint: JointRef, poses: &[RigidTransform], angle: f64, apart: f64) -> f64 {
    let (axis, point) = tree.axis(joint, poses);
    let across = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let u = axis.cross(&across).normalize();
    // With the sign of the turn, so that all turns are to the left.
    let v = axis.cross(&u) * angle.signum();
    let ball = |pose: &RigidTransform| {
        let p = pose.translation - point;
        let (x, y) = (p.dot(&u), p.dot(&v));
        Ball { height: p.dot(&axis), radius: libm::sqrt(x * x + y * y), x, y }
    };
    let moved = joint.place..tree.end[joint.place];
    let moving: Vec<Ball> = poses[moved.clone()].iter().map(ball).filter(|b| b.radius > ON_AXIS).collect();
    let standing: Vec<Ball> = poses[..moved.start]
        .iter()
        .chain(&poses[moved.end..])
        .map(ball)
        .filter(|b| b.radius > ON_AXIS)
        .collect();
    let mut left = angle.abs();
    for m in &moving {
        for s in &standing {
            let (rise, spread) = (s.height - m.height, s.radius - m.radius);
            // What is as near as that at the nearest is never in the way.
            let nearest = rise * rise + spread * spread;
            if nearest >= apart * apart {
                continue;
            }
            left = left.min(contact(m, s, nearest, apart, left));
            if left <= 0.0 {
                return 0.0;
            }
        }
    }
    left * angle.signum()
}

/// The angle at which a ball that turns to the left comes as near as `apart` to one that stands.
fn contact(moving: &Ball, standing: &Ball, nearest: f64, apart: f64, left: f64) -> f64 {
    let product = moving.radius * standing.radius;
    let cosine = (moving.x * standing.x + moving.y * standing.y) / product;
    let sine = (moving.x * standing.y - moving.y * standing.x) / product;
    // distance² = nearest + 2 · product · (1 - cos(angle between))
    let limit = 1.0 - (apart * apart - nearest) / (2.0 * product);
    if limit <= -1.0 {
        // They are always nearer than that: only where they touch already.
        return left;
    }
    let (between, within) = (libm::atan2(sine, cosine), libm::acos(limit));
    if between.abs() <= within + ROUNDING {
        // Near at once: ahead it is in the way, behind they part, and meet again after a whole turn.
        let again = between - within + TAU;
        return if between > -ROUNDING { 0.0 } else { again };
    }
    let ahead = if between < 0.0 { between + TAU } else { between };
    (ahead - within).max(0.0)
}

/// Balls nearer to the axis than this do not move.
const ON_AXIS: f64 = 1e-9;

/// Angles that rounding explains, rad.
const ROUNDING: f64 = 1e-9;
