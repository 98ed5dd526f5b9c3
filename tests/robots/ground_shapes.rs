//! What touches the ground, and the ground: by closed forms, and by looking at every point.
#![allow(non_snake_case)]

use crate::support::numbers::Numbers;
use modl::geometry::ground_features::{CIRCLE_POINTS, Feature, Form, features, tread};
use modl::geometry::pose::shifted;
use modl::geometry::{HeightField, Placed, Pose, Shape, Vec3};
use std::f64::consts::FRAC_PI_4;

fn form(n: &mut Numbers, kind: usize) -> Form {
    match kind {
        0 => Form::Vertex,
        1 => Form::Circle(n.direction(), n.between(0.01, 0.1)),
        _ => Form::Sphere(n.between(0.01, 0.1)),
    }
}

/// Just the points that are below a limit are told, whatever the limit, and whether the lowest is.
#[test]
fn points_below_a_limit_are_those_that_are() {
    let mut n = Numbers(1);
    let mut some = [0; CIRCLE_POINTS as usize + 1];
    for round in 0..3000 {
        let feature = Feature { centre: n.vector() * 0.2, form: form(&mut n, round % 3) };
        let up = n.direction();
        // Mostly at the height of the centre, give or take the radius.
        let limit = up.dot(&feature.centre) + n.between(-0.12, 0.12);
        let mut found = Vec::new();
        let lowest = feature.points_below(&up, limit, &mut None, &mut found);
        assert_eq!(lowest, feature.lowest(&up) < limit, "{feature:?}");
        let points = (0..feature.points()).map(|k| (k, feature.point(k, &up)));
        let expected: Vec<_> = points.filter(|(_, p)| p.dot(&up) < limit).collect();
        assert_eq!(found.len(), expected.len(), "{feature:?} {limit}");
        assert!(found.iter().zip(&expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).norm() < 1e-12));
        some[found.len()] += 1;
    }
    // Of circles one, three, five, seven or all.
    assert!([0, 1, 3, 5, 7, 8].iter().all(|k| some[*k] > 10), "{some:?}");
}

/// The points of a circle are eighths of a turn apart, counter-clockwise about its axis, and on it.
#[test]
fn points_of_a_circle_go_round_it_by_eighths() {
    let mut n = Numbers(2);
    for _ in 0..200 {
        let (centre, axis, radius, up) = (n.vector(), n.direction(), n.between(0.1, 1.0), n.direction());
        let circle = Feature { centre, form: Form::Circle(axis, radius) };
        let arm = |k: u8| (circle.point(k, &up) - centre) / radius;
        for k in 0..CIRCLE_POINTS {
            assert!((arm(k).norm() - 1.0).abs() < 1e-12 && arm(k).dot(&axis).abs() < 1e-12);
            let next = arm((k + 1) % CIRCLE_POINTS);
            assert!((arm(k).dot(&next) - libm::cos(FRAC_PI_4)).abs() < 1e-12);
            assert!((arm(k).cross(&next).dot(&axis) - libm::sin(FRAC_PI_4)).abs() < 1e-12);
            assert!(arm(0).dot(&up) <= arm(k).dot(&up) + 1e-12);
        }
    }
}

/// No point of a feature moves farther than the bound says, and a feature that only moves along moves just as far.
#[test]
fn features_move_no_farther_than_their_bound() {
    let mut n = Numbers(3);
    for round in 0..1000 {
        let feature = Feature { centre: n.vector() * 0.2, form: form(&mut n, round % 3) };
        let by = n.vector() * 0.1;
        let pose = shifted(by) * n.rotation();
        let R = *pose.rotation.to_rotation_matrix().matrix();
        let other = feature.placed(&R, &by);
        let bound = feature.moved(&other);
        let least = (feature.centre - other.centre).norm();
        assert!(bound >= least - 1e-15);
        if let (Form::Circle(_, radius), Form::Circle(axis, _)) = (feature.form, other.form) {
            // Where the plane tilts, points of the rim move: those farthest along the other axis.
            let Form::Circle(own, _) = feature.form else { unreachable!("it is a circle") };
            assert!((bound - least - radius * (own - axis).norm()).abs() < 1e-12);
        }
        let along = feature.placed(&nalgebra::Matrix3::identity(), &by);
        assert!((feature.moved(&along) - by.norm()).abs() < 1e-12);
        // A feature reaches no farther than its bound, and its box holds it just.
        let (up, around) = (n.direction(), feature.bounds());
        let lowest = feature.point(0, &up);
        assert!(lowest.norm() <= feature.reach() + 1e-12);
        assert!((0..3).all(|k| {
            (around.low[k]..=around.high[k]).contains(&(lowest[k].clamp(around.low[k], around.high[k])))
        }));
        for axis in 0..3 {
            let way = Vec3::ith(axis, 1.0);
            assert!((feature.lowest(&way) - around.low[axis]).abs() < 1e-12);
            assert!((feature.lowest(&-way) + around.high[axis]).abs() < 1e-12);
        }
    }
}

/// A wheel bears in the middle between the lowest points of its two rims.
#[test]
fn treads_are_between_the_lowest_points_of_two_rims() {
    let mut n = Numbers(4);
    for _ in 0..500 {
        let (radius, length, axis, up) =
            (n.between(0.01, 0.1), n.between(0.01, 0.1), n.direction(), n.direction());
        let pose = shifted(n.vector() * 0.3) * n.rotation();
        let rims = features(&[Placed { pose, shape: Shape::Cylinder { radius, length, axis } }]);
        let found = tread(&rims[0], &rims[1], &up, &mut None).expect("they are the rims of one wheel");
        let expected = (rims[0].point(0, &up) + rims[1].point(0, &up)) / 2.0;
        assert!((found - expected).norm() < 1e-12, "{found}");
        // Rims of two wheels, and what is no rim.
        let Form::Circle(axis, radius) = rims[0].form else { panic!("a rim is a circle") };
        let wider = Feature { form: Form::Circle(axis, 1.1 * radius), ..rims[1] };
        let turned = Feature { form: Form::Circle(n.direction(), radius), ..rims[1] };
        let ball = Feature { form: Form::Sphere(radius), ..rims[1] };
        for other in [wider, turned, ball] {
            assert_eq!(tread(&rims[0], &other, &up, &mut None), None);
        }
    }
}

/// The features of a union, also of one in another, are those of its parts in their places.
#[test]
fn features_of_unions_are_those_of_their_parts() {
    let mut n = Numbers(5);
    let placed = |n: &mut Numbers, shape: Shape| Placed { pose: shifted(n.vector()) * n.rotation(), shape };
    let plate = Shape::Box { size: Vec3::new(0.1, 0.2, 0.3) };
    let wheel = Shape::Cylinder { radius: 0.1, length: 0.05, axis: n.direction() };
    let pin = Shape::Capsule { radius: 0.1, length: 0.05, axis: n.direction() };
    let inner = vec![placed(&mut n, plate.clone()), placed(&mut n, wheel)];
    let outer = vec![
        placed(&mut n, Shape::Union { parts: inner.clone() }),
        placed(&mut n, pin),
        placed(&mut n, plate),
    ];
    let whole = placed(&mut n, Shape::Union { parts: outer.clone() });
    let found = features(std::slice::from_ref(&whole));
    let at = |pose: Pose, part: &Placed| Placed { pose: pose * part.pose, shape: part.shape.clone() };
    let all = [
        at(whole.pose * outer[0].pose, &inner[0]),
        at(whole.pose * outer[0].pose, &inner[1]),
        at(whole.pose, &outer[1]),
        at(whole.pose, &outer[2]),
    ];
    let expected: Vec<Feature> = all.iter().flat_map(|part| features(std::slice::from_ref(part))).collect();
    assert_eq!((found.len(), expected.len()), (8 + 2 + 2 + 8, 20));
    for (a, b) in found.iter().zip(&expected) {
        assert!((a.centre - b.centre).norm() < 1e-12, "{a:?} {b:?}");
    }
}

/// A ground that rises along a direction is read back as the plane that it is, and nothing else is.
#[test]
fn planes_are_told_by_their_rises() {
    let mut n = Numbers(6);
    for _ in 0..200 {
        let (s, c) = libm::sincos(n.between(-3.0, 3.0));
        let rise = n.between(0.0, 1.4);
        let field = HeightField::plane([c, s], rise);
        let [along_x, along_y] = field.as_plane().expect("it is a plane");
        assert!((along_x - rise * c).abs() < 1e-12 && (along_y - rise * s).abs() < 1e-12);
        assert!((field.steepest() - rise).abs() < 1e-12);
        assert!((field.highest() - 500.0 * rise * (c.abs() + s.abs())).abs() < 1e-9);
        for corner in 0..4 {
            let mut bent = field.clone();
            bent.heights[corner] += 0.1;
            assert_eq!(bent.as_plane(), None);
        }
        assert_eq!(HeightField { spacing: 999.0, ..field.clone() }.as_plane(), None);
        assert_eq!(HeightField { corner: [-500.0, -499.0], ..field.clone() }.as_plane(), None);
    }
}

#[test]
fn fields_that_are_no_ground_are_told() {
    let field = |columns: usize, count: usize, spacing: f64| HeightField {
        corner: [0.0, 0.0],
        spacing,
        columns,
        heights: vec![0.0; count],
    };
    let fault = |field: HeightField| field.fault().unwrap_or("sound");
    assert_eq!(fault(field(2, 4, 0.1)), "sound");
    assert_eq!(fault(field(3, 6, 0.1)), "sound");
    for (columns, count) in [(1, 4), (4, 4), (0, 0), (0, 4), (2, 3), (2, 0)] {
        let expected = "the ground has less than two rows or columns of heights";
        assert_eq!(fault(field(columns, count, 0.1)), expected, "{columns} {count}");
    }
    assert_eq!(fault(field(3, 7, 0.1)), "the rows of the ground have different lengths");
    for spacing in [0.0, -0.1, f64::INFINITY, f64::NAN] {
        assert_eq!(fault(field(2, 4, spacing)), "the heights of the ground are not apart");
    }
    let far = "the ground reaches, or is, farther than 1 km from the origin";
    assert_eq!(fault(field(2, 4, 1001.0)), far);
    assert_eq!(fault(field(2, 4, 999.0)), "sound");
    assert_eq!(fault(HeightField { heights: vec![0.0, 0.0, 1001.0, 0.0], ..field(2, 4, 1.0) }), far);
    assert_eq!(fault(HeightField { corner: [-1001.0, 0.0], ..field(2, 4, 1.0) }), far);
}

/// Between any two fractions that are told the height goes straight, and the highest of all heights is above none.
#[test]
fn heights_are_straight_between_the_points_that_are_told() {
    let mut n = Numbers(7);
    for _ in 0..100 {
        let (columns, rows) = (2 + n.below(4), 2 + n.below(4));
        let heights: Vec<f64> = (0..columns * rows).map(|_| n.between(-1.0, 0.9)).collect();
        let field = HeightField {
            corner: [n.between(-1.0, 1.0), n.between(-1.0, 1.0)],
            spacing: 0.4,
            columns,
            heights,
        };
        assert_eq!(field.highest(), field.heights.iter().copied().fold(-1.0, f64::max));
        let [p, q] =
            [0, 1].map(|_| Vec3::new(n.between(-2.0, 3.0), n.between(-2.0, 3.0), n.between(-1.0, 1.0)));
        let mut told = Vec::new();
        field.profile(p, q, |part, height| told.push((part, height)));
        told.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!((told[0].0, told[told.len() - 1].0), (0.0, 1.0));
        for pair in told.windows(2) {
            for k in 1..8 {
                let share = f64::from(k) / 8.0;
                let part = pair[0].0 + (pair[1].0 - pair[0].0) * share;
                let straight = pair[0].1 + (pair[1].1 - pair[0].1) * share;
                assert!((field.above(p + (q - p) * part) - straight).abs() < 1e-9, "{part}");
            }
        }
        let least = told.iter().map(|(_, height)| *height).fold(f64::INFINITY, f64::min);
        assert_eq!(field.lowest(p, q).1, least);
    }
}
