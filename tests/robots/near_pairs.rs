//! Closest points against brute force and identities, and the broad phase against all pairs.

use modl::geometry::broad_phase::{Aabb, near_boxes, near_points};
use modl::geometry::closest_points::{
    end_segment, point_box, point_segment, point_segment_distance, point_triangle, segment_part,
    segment_segment, segment_segment_distance,
};
use modl::geometry::moving_lines::lines_stay_apart;
use modl::geometry::{Part, Pose, RigidTransform, Vec3, rigid_transform};
use nalgebra::{Rotation3, Unit};
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = Vec3> {
    (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn segment() -> impl Strategy<Value = (Vec3, Vec3)> {
    // Some are points, some parallel to an axis.
    (vector(), vector(), 0..8).prop_map(|(a, b, kind)| match kind {
        0 => (a, a),
        1 => (a, a + Vec3::x() * b.x),
        2 => (a, a + Vec3::y() * b.y),
        _ => (a, b),
    })
}

const PARTS: usize = 200;

/// The least distance over the points of a grid on both, and how much it may be too large.
fn sampled(p: (Vec3, Vec3), q: (Vec3, Vec3)) -> (f64, f64) {
    let on = |s: (Vec3, Vec3), i: usize| s.0 + (s.1 - s.0) * (i as f64 / PARTS as f64);
    let of = |i: usize| (0..=PARTS).map(move |j| (on(p, i) - on(q, j)).norm()).fold(f64::INFINITY, f64::min);
    let least = (0..=PARTS).map(of).fold(f64::INFINITY, f64::min);
    (least, ((p.1 - p.0).norm() + (q.1 - q.0).norm()) / (2.0 * PARTS as f64))
}

proptest! {
    #![proptest_config(crate::support::properties::cases(200))]

    #[test]
    fn segments_are_as_far_apart_as_samples_say(p in segment(), q in segment()) {
        let found = segment_segment(p, q);
        let (least, coarse) = sampled(p, q);
        prop_assert!(found.distance <= least + 1e-12 && found.distance >= least - coarse);
        // The witnesses are on the segments and as far apart as is said.
        let (s, t) = found.along;
        prop_assert!((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
        let apart = p.0 + (p.1 - p.0) * s - q.0 - (q.1 - q.0) * t;
        prop_assert!((apart - found.normal * found.distance).norm() < 1e-12);
        prop_assert!((found.normal.norm() - 1.0).abs() < 1e-12);
        // The same either way round, and by the exact distance; ends are never nearer.
        prop_assert!((segment_segment(q, p).distance - found.distance).abs() < 1e-12);
        prop_assert!((segment_segment((p.1, p.0), q).distance - found.distance).abs() < 1e-12);
        prop_assert!((segment_segment_distance(p, q) - found.distance).abs() < 1e-12);
        prop_assert!((0..2).all(|end| end_segment(p, end, q).distance >= found.distance - 1e-12));
    }

    /// Segments that cross at a tiny angle meet.
    #[test]
    fn the_exact_distance_holds_at_any_angle(power in 1i32..9, height in 0.0f64..0.1) {
        let slope = libm::pow(10.0, f64::from(-power));
        let p = (Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0));
        let q = (Vec3::new(-1.0, -slope, height), Vec3::new(1.0, slope, height));
        prop_assert!((segment_segment_distance(p, q) - height).abs() < 1e-12);
        prop_assert!((segment_segment(p, q).distance - height).abs() < 4e-5);
    }

    #[test]
    fn a_point_of_a_triangle_is_nearest(point in vector(), a in vector(), b in vector(), c in vector()) {
        let nearest = point_triangle(point, [a, b, c]);
        let distance = (nearest - point).norm();
        for i in 0..=40 {
            for j in 0..=40 - i {
                let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
                prop_assert!((a + (b - a) * u + (c - a) * v - point).norm() >= distance - 1e-12);
            }
        }
        // It is in the triangle: no farther from its corners' plane and edges than rounding.
        prop_assert!((point_triangle(nearest, [c, a, b]) - nearest).norm() < 1e-12);
        let edges = [(a, b), (b, c), (c, a)].map(|edge| point_segment_distance(point, edge));
        prop_assert!(edges.iter().all(|edge| *edge >= distance - 1e-12));
    }

    #[test]
    fn boxes_and_parts_agree(point in vector(), p in segment(), low in vector(), size in vector()) {
        let size = size.abs() + Vec3::repeat(0.05);
        let around = Aabb { low, high: low + size };
        let part = Part::boxed(low + size / 2.0, [0, 1, 2].map(|i| Vec3::ith(i, size[i] / 2.0)));
        let distance = point_box(point, &around);
        let of_part = segment_part((point, point), &part, f64::MAX).distance;
        // Inside, a depth is found that is never too small.
        prop_assert!(of_part <= distance + 1e-8, "{distance} and {of_part}");
        prop_assert!(distance < 0.0 || of_part >= distance - 1e-8, "{distance} and {of_part}");
        // A segment is as near as its nearest point.
        let on = |i: usize| p.0 + (p.1 - p.0) * (i as f64 / PARTS as f64);
        let least = (0..=PARTS).map(|i| point_box(on(i), &around)).fold(f64::INFINITY, f64::min);
        let found = segment_part(p, &part, f64::MAX).distance;
        if least > 0.0 {
            prop_assert!(found <= least + 1e-8 && found >= least - (p.1 - p.0).norm() / PARTS as f64 - 1e-8);
        } else {
            prop_assert!(found <= 1e-8);
        }
    }

    #[test]
    fn a_degenerate_segment_is_a_point(point in vector(), a in vector()) {
        prop_assert_eq!(point_segment(point, (a, a)), 0.0);
        prop_assert_eq!(point_segment_distance(point, (a, a)), (point - a).norm());
    }

    #[test]
    fn grids_find_all_near_pairs_of_points(
        points in proptest::collection::vec(vector(), 0..80), spread in 0.1f64..20.0, reach in 0.05f64..3.0,
        snapped: bool,
    ) {
        let at = |p: &Vec3| if snapped { (p * spread).map(|x| (x / reach).round() * reach) } else { p * spread };
        let points: Vec<Vec3> = points.iter().map(at).collect();
        let mut found = Vec::new();
        near_points(points.len(), |i| points[i], reach, &mut |i, j, squared| {
            assert_eq!(squared, (points[i] - points[j]).norm_squared());
            found.push((i, j));
        });
        let mut again = Vec::new();
        near_points(points.len(), |i| points[i], reach, &mut |i, j, _| again.push((i, j)));
        prop_assert_eq!(&found, &again);
        found.sort_unstable();
        // Whether a pair at just this distance is near is a matter of rounding.
        let nearer = |part: f64| {
            let near = |&(i, j): &(usize, usize)| (points[i] - points[j]).norm() < part * reach;
            let pairs = (0..points.len()).flat_map(|i| (i + 1..points.len()).map(move |j| (i, j)));
            pairs.filter(near).collect::<Vec<(usize, usize)>>()
        };
        let (surely, perhaps) = (nearer(1.0 - 1e-9), nearer(1.0 + 1e-9));
        prop_assert!(surely.iter().all(|pair| found.contains(pair)), "{surely:?} and {found:?}");
        prop_assert!(found.iter().all(|pair| perhaps.contains(pair)), "{perhaps:?} and {found:?}");
        prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "a pair was found twice");
    }

    #[test]
    fn grids_find_all_near_pairs_of_boxes(
        corners in proptest::collection::vec((vector(), vector()), 0..60), spread in 0.5f64..10.0,
        reach in 0.0f64..2.0, cell in 0.05f64..3.0,
    ) {
        let boxes: Vec<Aabb> =
            corners.iter().map(|(a, b)| Aabb::around([a * spread, a * spread + b])).collect();
        let mut found = Vec::new();
        near_boxes(&boxes, reach, cell, |i, j| found.push((i, j)));
        found.sort_unstable();
        let near = |&(i, j): &(usize, usize)| boxes[i].gap(&boxes[j]).iter().all(|gap| *gap <= reach);
        let all: Vec<(usize, usize)> =
            (0..boxes.len()).flat_map(|i| (i + 1..boxes.len()).map(move |j| (i, j))).filter(near).collect();
        prop_assert_eq!(found, all);
    }

    /// The two forms of a rigid displacement are one group.
    #[test]
    fn rigid_transforms_are_poses(a in vector(), b in vector(), p in vector(), turns in vector()) {
        let pose = |axis: Vec3, angle: f64| Pose::new(axis, axis.normalize() * angle);
        let (x, y) = (pose(a, 3.0 * turns.x), pose(b, 3.0 * turns.y));
        let (m, n) = (RigidTransform::from(&x), RigidTransform::from(&y));
        let same = |m: &RigidTransform, x: &Pose| {
            let other = RigidTransform::from(x);
            (m.rotation - other.rotation).amax() < 1e-14 && (m.translation - other.translation).amax() < 1e-14
        };
        prop_assert!(same(&(m * n), &(x * y)) && same(&m.inverse(), &x.inverse()));
        prop_assert!((m.transform_point(&p) - (x * nalgebra::Point3::from(p)).coords).amax() < 1e-14);
        prop_assert!(same(&m, &Pose::from(&m)));
        prop_assert!((rigid_transform::rotation_vector(&m.rotation) - x.rotation.scaled_axis()).amax() < 1e-9);
        // Half turns have an axis, too.
        let half = Rotation3::from_axis_angle(&Unit::new_normalize(a), std::f64::consts::PI);
        let found = rigid_transform::rotation_vector(half.matrix());
        prop_assert!((found.norm() - std::f64::consts::PI).abs() < 1e-9);
        prop_assert!(found.cross(&a).norm() < 1e-7 * a.norm());
    }
}

/// The least distance of two segments over some times while their ends move linearly.
fn least_in_time(p: [(Vec3, Vec3); 2], q: [(Vec3, Vec3); 2]) -> f64 {
    let at = |s: [(Vec3, Vec3); 2], t: f64| (s[0].0.lerp(&s[1].0, t), s[0].1.lerp(&s[1].1, t));
    let distance = |k: i32| {
        let t = f64::from(k) / 300.0;
        segment_segment_distance(at(p, t), at(q, t))
    };
    (0..=300).map(distance).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(crate::support::properties::cases(400))]

    #[test]
    fn lines_that_are_proved_to_stay_apart_do(
        p in (segment(), segment()), q in (segment(), segment()), apart in 0.0f64..1.0, little in 0.0f64..0.2,
    ) {
        // Most motions are small.
        let moved = |(from, to): ((Vec3, Vec3), (Vec3, Vec3))| {
            [from, (from.0.lerp(&to.0, little), from.1.lerp(&to.1, little))]
        };
        let (p, q) = (moved(p), moved(q));
        let least = least_in_time(p, q);
        for apart in [apart, 0.5 * least, 0.99 * least, 1.01 * least] {
            if lines_stay_apart((p[0], p[1]), (q[0], q[1]), apart) {
                prop_assert!(least >= apart - 1e-9, "{} {}", least, apart);
            }
        }
    }
}

#[test]
fn crossing_struts_that_turn_are_proved_to_stay_apart() {
    let (along, across) = (Vec3::x(), Vec3::y());
    let p = (-along, along);
    // Above it, across it, and turned and tilted meanwhile: the distance in the middle stays the same.
    let q = (Vec3::z() * 0.1 - across, Vec3::z() * 0.1 + across);
    let turned = (Vec3::z() * 0.1 - across + along * 0.2, Vec3::z() * 0.1 + across - along * 0.2);
    let tilted = (turned.0 + Vec3::z() * 0.05, turned.1 - Vec3::z() * 0.05);
    assert!(lines_stay_apart((p, p), (q, turned), 0.0999));
    assert!(lines_stay_apart((p, p), (q, tilted), 0.0995));
    assert!(!lines_stay_apart((p, p), (q, tilted), 0.1001));
    // Through each other, and parallel.
    let below = (q.0 - Vec3::z() * 0.2, q.1 - Vec3::z() * 0.2);
    assert!(!lines_stay_apart((p, p), (q, below), 0.0));
    assert!(!lines_stay_apart((p, p), (p, p), 0.0));
    let beside = (p.0 + across, p.1 + across);
    assert!(!lines_stay_apart((p, p), (beside, beside), 0.1));
}
