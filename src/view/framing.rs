//! Framing: the camera whose picture is filled by what is shown. Pages do the same (`page/framing.js`).

use super::raster::Camera;
use super::tolerances::TOLERANCES;
use crate::geometry::Vec3;

/// The tangent of half the vertical field of view (32 degrees, as on the page).
const HALF_FOV_TANGENT: f64 = 0.286_745_4;

/// The part of the picture's width or height that is filled.
const FILLED: f64 = 0.9;

/// The number of steps in which the distance is found; each takes the greater part of the error away.
const STEPS: usize = 24;

/// Returns the perspective camera in a direction (not of unit length) whose picture, of this width as a multiple of its
/// height, all points just fill; points in m.
pub(super) fn camera(points: &[Vec3], direction: Vec3, aspect: f64) -> Camera {
    let back = direction.normalize();
    let right = Vec3::z().cross(&back).normalize();
    let up = back.cross(&right);
    let seen: Vec<[f64; 3]> = points.iter().map(|p| [p.dot(&right), p.dot(&up), p.dot(&back)]).collect();
    let range = |axis: usize| {
        let values = seen.iter().map(|p| p[axis]);
        values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
    };
    if seen.is_empty() {
        return Camera::new(back * 4.0, Vec3::zeros(), Vec3::z(), HALF_FOV_TANGENT, false);
    }
    let (ranges, (tall, wide)) =
        ([range(0), range(1), range(2)], (FILLED * HALF_FOV_TANGENT, FILLED * HALF_FOV_TANGENT * aspect));
    let sizes = ranges.map(|(low, high)| high - low);
    let size = f64::max(libm::hypot(libm::hypot(sizes[0], sizes[1]), sizes[2]), 2.0 * TOLERANCES.radius);
    let nearest = ranges[2].1;
    let (mut x, mut y) = ((ranges[0].0 + ranges[0].1) / 2.0, (ranges[1].0 + ranges[1].1) / 2.0);
    // The distance of the camera from the nearest point along its direction.
    let mut gap = 2.0 * size;
    for _ in 0..STEPS {
        let grown = [(0, wide), (1, tall)].map(|(axis, most)| {
            let centre = if axis == 0 { &mut x } else { &mut y };
            // The outermost points on both sides as the camera sees them, each with its distance along the view.
            let seen_at =
                |p: &[f64; 3]| ((p[axis] - *centre) / (nearest + gap - p[2]), p[axis], nearest + gap - p[2]);
            let (mut low, mut high) = (seen_at(&seen[0]), seen_at(&seen[0]));
            for found in seen.iter().map(seen_at) {
                if found.0 < low.0 {
                    low = found;
                }
                if found.0 > high.0 {
                    high = found;
                }
            }
            // In between, where both are as far from the middle of the picture.
            *centre = (low.1 * high.2 + high.1 * low.2) / (low.2 + high.2);
            (high.0 - low.0) / 2.0 / most
        });
        gap = f64::max(gap * f64::max(grown[0], grown[1]).clamp(0.4, 2.5), 0.02 * size);
    }
    let depth = (ranges[2].0 + ranges[2].1) / 2.0;
    let target = right * x + up * y + back * depth;
    let distance = nearest + gap - depth;
    Camera::new(target + back * distance, target, Vec3::z(), HALF_FOV_TANGENT, false)
}
