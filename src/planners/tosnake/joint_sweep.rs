//! Exact collision checking of a turn of one joint: every ball that moves does so on a circle about the axis,
//! so the angle of first contact has a closed form.

use super::tolerances::TOLERANCES;
use super::tree::{JointRef, Tree};
use crate::geometry::{RigidTransform, Vec3};
use std::f64::consts::TAU;

/// A ball in cylindrical coordinates of the axis.
struct Ball {
    height: f64,
    radius: f64,
    /// Coordinates along two directions across the axis.
    x: f64,
    y: f64,
}

/// Returns the angle by which a joint can turn before the centres of two balls come nearer than `min_distance`
/// (pitches): all of `angle` (rad, either sign), or a part of it with the same sign. Balls that are nearer than that
/// at the start may only move apart, but pairs that are nearer through the whole turn do not bound it. `poses`: of
/// the shoes at the start, in the tree's order ([`Tree::shoe`]), in pitches. Loops that the turn would break are not
/// searched for.
pub fn free_angle(
    tree: &Tree,
    joint: JointRef,
    poses: &[RigidTransform],
    angle: f64,
    min_distance: f64,
) -> f64 {
    let (axis, point) = tree.axis(joint, poses);
    let across = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let u = axis.cross(&across).normalize();
    // With the sign of the turn, so that all turns are counter-clockwise.
    let v = axis.cross(&u) * angle.signum();
    let ball = |pose: &RigidTransform| {
        let p = pose.translation - point;
        let (x, y) = (p.dot(&u), p.dot(&v));
        Ball { height: p.dot(&axis), radius: libm::sqrt(x * x + y * y), x, y }
    };
    let subtree = joint.child..tree.end[joint.child];
    let moving: Vec<Ball> =
        poses[subtree.clone()].iter().map(ball).filter(|b| b.radius > TOLERANCES.on_axis).collect();
    let fixed: Vec<Ball> = poses[..subtree.start]
        .iter()
        .chain(&poses[subtree.end..])
        .map(ball)
        .filter(|b| b.radius > TOLERANCES.on_axis)
        .collect();
    let mut left = angle.abs();
    for m in &moving {
        for f in &fixed {
            let (rise, spread) = (f.height - m.height, f.radius - m.radius);
            // The least squared distance over a whole turn.
            let nearest = rise * rise + spread * spread;
            if nearest >= min_distance * min_distance {
                continue;
            }
            left = left.min(contact_angle(m, f, nearest, min_distance, left));
            if left <= 0.0 {
                return 0.0;
            }
        }
    }
    left * angle.signum()
}

/// Returns the angle at which a ball that turns counter-clockwise comes as near as `min_distance` to a fixed
/// one, from distance² = nearest + 2 · r₁ · r₂ · (1 - cos φ); `left` if it never does.
fn contact_angle(moving: &Ball, fixed: &Ball, nearest: f64, min_distance: f64, left: f64) -> f64 {
    let product = moving.radius * fixed.radius;
    let cosine = (moving.x * fixed.x + moving.y * fixed.y) / product;
    let sine = (moving.x * fixed.y - moving.y * fixed.x) / product;
    let limit = 1.0 - (min_distance * min_distance - nearest) / (2.0 * product);
    if limit <= -1.0 {
        // They are always nearer than that, so they touched before.
        return left;
    }
    let (between, within) = (libm::atan2(sine, cosine), libm::acos(limit));
    if between.abs() <= within + TOLERANCES.turn {
        // Near at once: a ball ahead blocks the turn; from one behind it parts, to meet it after a turn.
        let again = between - within + TAU;
        return if between > -TOLERANCES.turn { 0.0 } else { again };
    }
    let ahead = if between < 0.0 { between + TAU } else { between };
    (ahead - within).max(0.0)
}
