//! A contact point of convex parts: for people to look at, not for the judge.

use super::distance::distance_apart;
use super::part::Part;
use super::pose::{Pose, Vec3};

/// The greatest number of rounds of projections; parts that overlap take a few.
const ROUNDS_MAX: usize = 64;

/// Threshold: the projections have converged where a step is shorter than this, m: far less than shapes are known to.
const TOL_STEP: f64 = 1e-7;

/// Returns a point that is in both parts, or midway between their nearest points where they are apart, in a's frame
/// (m); `X_AB` is the pose of b's frame in a's. The method is alternating projections onto the one and the other (von
/// Neumann 1933), from the middle between the parts, until a step is less than `TOL_STEP`, or `ROUNDS_MAX` rounds are
/// done: then the point is approximate.
pub fn contact_point(a: &Part, b: &Part, X_AB: &Pose) -> Vec3 {
    let X_BA = X_AB.inverse();
    let into = |X: &Pose, p: &Vec3| X.transform_point(&(*p).into()).coords;
    let mut on_b = (a.centre + into(X_AB, &b.centre)) / 2.0;
    let mut on_a = on_b;
    for _ in 0..ROUNDS_MAX {
        on_a = nearest(a, &on_b);
        let next = into(X_AB, &nearest(b, &into(&X_BA, &on_a)));
        let step = (next - on_b).norm();
        on_b = next;
        if step < TOL_STEP {
            break;
        }
    }
    (on_a + on_b) / 2.0
}

/// Returns the point of a part that is nearest to a point of its frame: that point itself if it is inside.
fn nearest(part: &Part, p: &Vec3) -> Vec3 {
    let point = Part::sphere(*p, 0.0);
    let gap = distance_apart(&point, part, &Pose::identity(), None, f64::MAX);
    gap.filter(|gap| gap.distance > 0.0).map_or(*p, |gap| p + gap.normal * gap.distance)
}
