//! The turn of a docking: of those that a connector allows, that which is nearest to how the ports stand.

use super::library::Connector;
use crate::geometry::Pose;
use crate::geometry::Vec3;
use crate::geometry::pose::turned;
use std::f64::consts::{PI, TAU};

/// Tolerance, rad: two turns fit equally well if their angle errors differ by less, because rounding must not choose.
const TOL_TURN_TIE: f64 = 1e-9;

/// Returns (turn, hinge) for the second port of a docking at `X_PQ` (m) in the frame of the first, whose connector this is:
/// the number of the allowed turn whose angle error is least, the least of equals, and the position of the hinge, rad;
/// `None` if the connector has none.
pub fn nearest_turn(connector: &Connector, X_PQ: &Pose) -> (u32, Option<f64>) {
    let mut best = (f64::INFINITY, 0, None);
    for turn in 0..connector.turns {
        let angle = f64::from(turn) * TAU / f64::from(connector.turns);
        let mated = turned(Vec3::z(), PI) * turned(Vec3::x(), angle);
        let left = X_PQ * mated.inverse();
        let hinge = connector.hinge.as_ref().map(|h| twist(&left, &h.axis));
        let rest = match (&connector.hinge, hinge) {
            (Some(h), Some(q)) => turned(h.axis, q).inverse() * left,
            _ => left,
        };
        let off = rest.rotation.angle();
        if off < best.0 - TOL_TURN_TIE {
            best = (off, turn, hinge);
        }
    }
    (best.1, best.2)
}

/// Returns the angle of the turn about an axis that comes nearest to a rotation, rad.
fn twist(pose: &Pose, axis: &Vec3) -> f64 {
    let along = pose.rotation.imag().dot(axis) / axis.norm();
    let angle = 2.0 * libm::atan2(along, pose.rotation.w);
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}
