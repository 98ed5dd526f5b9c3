//! Geometry that judge and planners share, so that neither sees its faults: by closed forms, and by two ways to one number.
#![allow(non_snake_case)]

use crate::support::numbers::Numbers;
use modl::geometry::closest_points::{point_triangle, segment_segment};
use modl::geometry::distance::{Needed, signed_distance, signed_distance_as_needed, signed_distance_within};
use modl::geometry::ground_features::features;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::rigid_transform::rotation_vector;
use modl::geometry::{HeightField, Placed, Pose, Shape, Solid, Vec3};
use std::f64::consts::PI;

/// A shape of each kind, of some centimetres.
fn shapes(n: &mut Numbers) -> [Shape; 5] {
    let (radius, length, axis) = (n.between(0.01, 0.05), n.between(0.02, 0.1), n.direction());
    [
        Shape::Box { size: Vec3::repeat(0.07) + n.vector() * 0.05 },
        Shape::Cylinder { radius, length, axis },
        Shape::Sphere { radius },
        Shape::Capsule { radius, length, axis },
        Shape::Hull { points: (0..10).map(|_| n.vector() * 0.05).collect() },
    ]
}

/// What may touch the ground is told by features, what may touch each other by support functions: both have the same lowest
/// point.
#[test]
fn ground_features_are_as_low_as_the_solid() {
    let mut n = Numbers(1);
    for round in 0..200 {
        for shape in shapes(&mut n) {
            let placed = Placed { pose: shifted(n.vector() * 0.2) * n.rotation(), shape };
            let (all, up) = (features(std::slice::from_ref(&placed)), n.direction());
            let solid = Solid::new(&[placed]).expect("sound");
            let lowest = all.iter().map(|feature| feature.lowest(&up)).fold(f64::INFINITY, f64::min);
            let of_part = solid.parts.iter().map(|part| part.support(&-up).dot(&up));
            let expected = of_part.fold(f64::INFINITY, f64::min);
            assert!((lowest - expected).abs() < 1e-12, "{round}: {lowest} is not {expected}: {solid:?}");
            for feature in &all {
                let (at, height) = (feature.point(0, &up), feature.lowest(&up));
                assert!((at.dot(&up) - height).abs() < 1e-12);
                let mut below = Vec::new();
                feature.points_below(&up, height + 0.004, &mut None, &mut below);
                let points = (0..feature.points()).map(|k| (k, feature.point(k, &up)));
                let expected: Vec<_> = points.filter(|(_, p)| p.dot(&up) < height + 0.004).collect();
                assert_eq!(below.len(), expected.len());
                assert!(below.iter().zip(&expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).norm() < 1e-12));
            }
        }
    }
}

/// A distance that is less than what is enough is exact; another is a bound that is enough.
#[test]
fn distances_below_what_is_enough_are_exact() {
    let mut n = Numbers(2);
    let (mut exact, mut bounds) = (0, 0);
    for round in 0..300 {
        let solid = |n: &mut Numbers, kind: usize| {
            let shape = shapes(n)[kind].clone();
            Solid::new(&[Placed { pose: Pose::identity(), shape }]).expect("sound")
        };
        let (kind, other) = (n.below(5), n.below(5));
        let (a, b) = (solid(&mut n, kind), solid(&mut n, other));
        let X_AB = shifted(n.direction() * n.between(0.1, 0.3)) * n.rotation();
        let (a, b) = (&a.parts[0], &b.parts[0]);
        let whole = signed_distance(a, b, &X_AB).distance;
        if whole <= 1e-3 {
            continue;
        }
        for factor in [0.5, 0.9, 0.999, 1.001, 1.01, 1.1, 2.0] {
            let enough = whole * factor;
            let found = signed_distance_within(a, b, &X_AB, None, enough).distance;
            assert!(found <= whole + 1e-8, "{round}: {found} is beyond {whole}");
            if factor > 1.0 {
                assert!(found >= whole - 1e-8, "{round}: {found} of {whole}, {enough} is enough");
                exact += 1;
            } else {
                assert!(found >= enough - 1e-12, "{round}: {found} is not {enough}");
                bounds += 1;
            }
            // Where a tolerance is allowed from a distance on, a lesser one is exact all the same, and a greater one within it.
            let needed = Needed { exact_below: enough, within: 0.3 * whole, enough: f64::MAX };
            let found = signed_distance_as_needed(a, b, &X_AB, None, &needed).distance;
            let allowed = if factor > 1.0 { 1e-8 } else { needed.within };
            assert!((whole - allowed - 1e-12..=whole + 1e-8).contains(&found), "{round}: {found} of {whole}");
        }
    }
    assert!(exact > 500 && bounds > 500, "{exact} {bounds}");
}

/// Triangles and segments without area: what is nearest lies on the longest edge.
#[test]
fn what_has_no_area_has_nearest_points() {
    let line = [0.0, 1.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0));
    for corners in [line, [line[1], line[0], line[2]], [line[2], line[1], line[0]]] {
        for (x, expected) in [(-1.0, 0.0), (0.5, 0.5), (2.0, 2.0), (4.0, 3.0)] {
            let found = point_triangle(Vec3::new(x, 1.0, 2.0), corners);
            assert!((found - Vec3::new(expected, 0.0, 0.0)).norm() < 1e-15, "{found}");
        }
    }
    let point = Vec3::new(0.2, 0.3, 0.4);
    assert_eq!(point_triangle(Vec3::zeros(), [point; 3]), point);
}

#[test]
fn segments_that_meet_have_a_normal_across_both() {
    let x = (-Vec3::x(), Vec3::x());
    let crossing = segment_segment(x, (-Vec3::y(), Vec3::y()));
    assert_eq!(crossing.distance, 0.0);
    assert!((crossing.normal.z.abs() - 1.0).abs() < 1e-15 && crossing.along == (0.5, 0.5));
    // Along one line, and a point on the other: no direction is across both, and it is upwards.
    for other in [(Vec3::zeros(), Vec3::x() * 2.0), (Vec3::zeros(), Vec3::zeros())] {
        let found = segment_segment(x, other);
        assert_eq!((found.distance, found.normal), (0.0, Vec3::z()));
    }
}

/// The logarithm of a turn is the turn, however small, and up to half a turn.
#[test]
fn rotation_vectors_are_those_of_the_turn() {
    let mut n = Numbers(3);
    for angle in [0.0, 1e-15, 1e-12, 5e-10, 2e-9, 1e-6, 1e-3, 0.5, 1.5, 3.0, PI - 1e-3, PI - 1e-6] {
        for _ in 0..20 {
            let axis = n.direction();
            let matrix = *turned(axis, angle).rotation.to_rotation_matrix().matrix();
            let found = rotation_vector(&matrix);
            // Near half a turn the axis is as exact as the sine of what is missing.
            let tolerance = if angle > 3.0 { 1e-8 } else { 1e-14 + 1e-13 * angle };
            assert!((found - axis * angle).norm() < tolerance, "{found} for {angle} about {axis}");
        }
    }
    // Half a turn about each axis, whose sign is free.
    for axis in [Vec3::x(), Vec3::y(), Vec3::z(), Vec3::new(1.0, -2.0, 2.0) / 3.0] {
        let matrix = *turned(axis, PI).rotation.to_rotation_matrix().matrix();
        let found = rotation_vector(&matrix);
        assert!((found - axis * PI).norm().min((found + axis * PI).norm()) < 1e-8, "{found}");
    }
}

/// Heights of a plane are those of the plane at every point of the field, its rim and corners included; outside they are those
/// of the nearest point of the rim.
#[test]
fn a_field_of_heights_of_a_plane_is_the_plane() {
    let (spacing, columns, rows, corner) = (0.25, 5, 3, [-0.5, 1.0]);
    let plane = |x: f64, y: f64| 0.3 * x - 0.7 * y + 0.2;
    let at =
        |i: usize| (corner[0] + spacing * (i % columns) as f64, corner[1] + spacing * (i / columns) as f64);
    let heights = (0..columns * rows).map(|i| plane(at(i).0, at(i).1)).collect();
    let field = HeightField { corner, spacing, columns, heights };
    let (width, depth) = (spacing * 4.0, spacing * 2.0);
    for i in 0..=40 {
        for j in 0..=40 {
            let (u, v) = (-0.2 + 1.4 * f64::from(i) / 40.0, -0.2 + 1.4 * f64::from(j) / 40.0);
            let (x, y) = (corner[0] + u * width, corner[1] + v * depth);
            let (near_x, near_y) =
                (x.clamp(corner[0], corner[0] + width), y.clamp(corner[1], corner[1] + depth));
            let expected = plane(near_x, near_y);
            assert!((field.height(x, y) - expected).abs() < 1e-12, "{x} {y}");
            let slope = [if near_x == x { 0.3 } else { 0.0 }, if near_y == y { -0.7 } else { 0.0 }];
            let found = field.slope(x, y);
            // A point on the rim may count to either side.
            let on_rim = [u, v].iter().any(|w| w.abs() < 1e-9 || (w - 1.0).abs() < 1e-9);
            assert!(on_rim || (0..2).all(|k| (found[k] - slope[k]).abs() < 1e-12), "{x} {y}: {found:?}");
        }
    }
    assert!((field.height(corner[0] + width, corner[1] + depth) - plane(0.5, 1.5)).abs() < 1e-12);
    assert!((field.steepest() - libm::hypot(0.3, 0.7)).abs() < 1e-12);
}
