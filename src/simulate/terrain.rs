//! Ground that is not level, and how a robot is put on it.

use crate::geometry::ground_features::Feature;
use crate::geometry::{HeightField, Pose, Vec3};
use crate::plan::forward_dynamics::Model;
use nalgebra::{Matrix2, UnitQuaternion, Vector2};
use std::sync::Arc;

/// The height above level ground up to which points of a robot at rest count as standing on it, m.
const STANDING: f64 = 1e-3;

/// Threshold: the determinant of the spread of the points, relative to that of as wide a spread all around, from which on
/// they are not on one line.
const TOL_LINE: f64 = 1e-6;

/// The ground of a simulation that is not level.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// The heights.
    pub field: Arc<HeightField>,
    /// The pose in the world of the frame in which the plan is: the robot stands on the ground as it does on the plan's
    /// level one, leaning with the plane that lies best through the ground under its feet.
    pub X_WP: Pose,
}

impl Terrain {
    /// Returns the slope that a plan's own world has, on which the plan itself puts the robot.
    pub(super) fn of_plan(field: HeightField) -> Terrain {
        Terrain { field: Arc::new(field), X_WP: Pose::identity() }
    }

    /// Returns the ground with a robot put on it, which stands on level ground at height 0 as the plan begins.
    pub(super) fn under(model: &Model, field: &Arc<HeightField>) -> Terrain {
        let planned: Vec<Vec3> = points(model, &Pose::identity(), &Vec3::z()).collect();
        let level = planned.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        let feet: Vec<Vec3> = planned.into_iter().filter(|p| p.z <= STANDING).collect();
        let middle = match feet.is_empty() {
            true => model.start[0].translation.vector,
            false => feet.iter().sum::<Vec3>() / feet.len() as f64,
        };
        let height = field.height(middle.x, middle.y);
        let slope = fitted(field, &feet, &middle).unwrap_or_else(|| field.slope(middle.x, middle.y));
        let normal = Vec3::new(-slope[0], -slope[1], 1.0).normalize();
        let turn = UnitQuaternion::rotation_between(&Vec3::z(), &normal).unwrap_or_default();
        let shift = Vec3::new(middle.x, middle.y, height) - turn * Vec3::new(middle.x, middle.y, 0.0);
        let leaning = Pose::from_parts(shift.into(), turn);
        // Its lowest point is as high above the ground as it is above level ground.
        let above = points(model, &leaning, &normal).map(|p| field.above(p)).fold(f64::INFINITY, f64::min);
        let lift = if above.is_finite() { level - above } else { 0.0 };
        let X_WP = Pose::from_parts((shift + Vec3::z() * lift).into(), turn);
        Terrain { field: field.clone(), X_WP }
    }
}

/// Iterates over the points of a robot at its start that can touch the ground, with its world at a pose (m); `up`: the
/// normal of the ground.
fn points<'a>(model: &'a Model, X_WP: &'a Pose, up: &'a Vec3) -> impl Iterator<Item = Vec3> + 'a {
    model.bodies.iter().zip(&model.start).flat_map(move |(body, start)| {
        let pose = X_WP * start;
        let own_up = pose.rotation.inverse_transform_vector(up);
        let of = move |feature: &'a Feature| {
            let point = move |k| pose.transform_point(&feature.point(k, &own_up).into()).coords;
            (0..feature.points()).map(point)
        };
        body.features.iter().flat_map(of)
    })
}

/// Returns the slope of the plane that lies best, by least squares, through the ground under some points; `None` if they
/// are on one line. `middle`: the mean of the points.
fn fitted(field: &HeightField, feet: &[Vec3], middle: &Vec3) -> Option<[f64; 2]> {
    let heights = || feet.iter().map(|p| field.height(p.x, p.y));
    let mean = heights().sum::<f64>() / feet.len() as f64;
    let (mut matrix, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for (p, height) in feet.iter().zip(heights()) {
        let from = (p - middle).xy();
        matrix += from * from.transpose();
        right += from * (height - mean);
    }
    let spread = matrix.trace() / 2.0;
    if matrix.determinant() <= TOL_LINE * spread * spread {
        return None;
    }
    matrix.try_inverse().map(|inverse| (inverse * right).into())
}
