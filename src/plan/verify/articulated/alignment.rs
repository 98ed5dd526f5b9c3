//! The attitude of a robot in a new posture before it settles: aligned with its old one (Kabsch algorithm), its
//! loaded contacts at their heights.

use super::contact::ContactPoint;
use super::model::{Model, Posture};
use super::tolerances::NUMERICS;
use super::tolerances::Tolerances;
use crate::geometry::Mat3;
use crate::geometry::ground_features::Feature;
use crate::geometry::{Vec3, pose::turned};

/// The number of linearised rounds of [`height_keeping_turn`].
const TURN_ROUNDS: usize = 4;

/// Returns the rotation matrix of a rotation vector (axis times angle), rad.
pub(super) fn rotation(omega: Vec3) -> Mat3 {
    *turned(omega, omega.norm()).rotation.to_rotation_matrix().matrix()
}

/// Returns the rotation `R_ON`, from the base's frame N in the new posture to its frame O in the old one, under which
/// the masses move least about the centre of mass, in the mean square (Kabsch 1976; orientations of links count a
/// little). The motion that it leaves does not depend on which module is the base. The identity where the singular
/// value decomposition fails.
pub(super) fn mass_alignment(model: &Model, old: &Posture, new: &Posture) -> Mat3 {
    let mut S = Mat3::zeros();
    for &link in &model.attached {
        let body = &model.bodies[link];
        let a = old.R[link] * body.com + old.p[link] - old.centre;
        let b = new.R[link] * body.com + new.p[link] - new.centre;
        S += (a * b.transpose() + old.R[link] * new.R[link].transpose() * NUMERICS.orientation_weight)
            * body.mass;
    }
    let svd = S.svd(true, true);
    let (Some(U), Some(Vt)) = (svd.u, svd.v_t) else { return Mat3::identity() };
    let mut flip = Vec3::new(1.0, 1.0, 1.0);
    flip[svd.singular_values.imin()] = (U * Vt).determinant().signum();
    U * Mat3::from_diagonal(&flip) * Vt
}

/// Returns the rotation about a horizontal axis, in level axes, that brings the loaded contact points of the sample
/// before nearest to their heights above the ground, by linearised least squares weighted with their loads: without
/// it a swinging arm would tilt the first guess. The identity without loaded contacts. `features`: in the new
/// posture, in level axes from the centre of mass; `contact_points`: those of the sample before.
pub(super) fn height_keeping_turn(
    features: &[Feature],
    contact_points: &[ContactPoint],
    tolerances: &Tolerances,
) -> Mat3 {
    let mut turn = Mat3::identity();
    for _ in 0..TURN_ROUNDS {
        let up = turn.transpose() * Vec3::z();
        let mut normal = Mat3::from_diagonal(&Vec3::new(NUMERICS.turn_weight, NUMERICS.turn_weight, 0.0));
        let mut right = Vec3::zeros();
        for contact_point in contact_points.iter().filter(|t| t.load > tolerances.load_min) {
            let p = turn * features[contact_point.feature].point(contact_point.k, &up);
            let row = Vec3::new(p.y, -p.x, 1.0);
            normal += row * row.transpose() * contact_point.load;
            right += row * ((contact_point.gap - p.z) * contact_point.load);
        }
        let Some(solved) = normal.cholesky().map(|c| c.solve(&right)) else { break };
        turn = rotation(Vec3::new(solved.x, solved.y, 0.0)) * turn;
    }
    turn
}
