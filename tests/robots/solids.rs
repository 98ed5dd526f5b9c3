//! Shapes, solids and their parts, by closed forms and by counting every point, direction or pair.
#![allow(non_snake_case)]

use crate::support::hollow_meshes::tub;
use crate::support::numbers::Numbers;
use modl::geometry::broad_phase::{Aabb, near_boxes};
use modl::geometry::closest_points::{end_segment, point_segment_distance};
use modl::geometry::distance::{enclosed_depth, separation_along, signed_distance};
use modl::geometry::hull::{extents, faces};
use modl::geometry::pose::shifted;
use modl::geometry::soundness::{Unsound, check, check_placed, check_pose};
use modl::geometry::{Part, Placed, Pose, Shape, Solid, Vec3, contact_point, sin_cos, triangulate};
use std::f64::consts::{PI, TAU};

fn at(pose: Pose, shape: Shape) -> Placed {
    Placed { pose, shape }
}

fn solid(shapes: &[Placed]) -> Solid {
    Solid::new(shapes).expect("sound shapes")
}

/// A shape of each kind, of some centimetres; the points of the hull are about a point beside its frame's origin.
fn shapes(n: &mut Numbers) -> [Shape; 5] {
    let (radius, length, axis) = (n.between(0.01, 0.05), n.between(0.02, 0.1), n.direction());
    let beside = n.vector() * 0.05;
    [
        Shape::Box { size: Vec3::repeat(0.07) + n.vector() * 0.05 },
        Shape::Cylinder { radius, length, axis },
        Shape::Sphere { radius },
        Shape::Capsule { radius, length, axis },
        Shape::Hull { points: (0..10).map(|_| beside + n.vector() * 0.05).collect() },
    ]
}

/// One part of a random shape, in its place.
fn part(n: &mut Numbers) -> Part {
    let kind = n.below(5);
    solid(&[at(shifted(n.vector() * 0.2) * n.rotation(), shapes(n)[kind].clone())]).parts.remove(0)
}

#[test]
fn sines_and_cosines_are_right_to_rounding() {
    for k in -200_000..=200_000 {
        let angle = f64::from(k) * 1.7e-4;
        let (s, c) = sin_cos(angle);
        let (sine, cosine) = libm::sincos(angle);
        assert!((s - sine).abs() < 3e-16 && (c - cosine).abs() < 3e-16, "{angle}");
    }
    assert_eq!(sin_cos(2e5), libm::sincos(2e5));
}

#[test]
fn what_spans_no_volume_has_no_thickness() {
    let point = Vec3::new(0.1, 0.2, 0.3);
    let on_line: Vec<Vec3> = [0.0, 1.0, 2.0, 5.0].iter().map(|x| point + Vec3::new(*x, 0.0, 0.0)).collect();
    let in_plane = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::new(1.0, 1.0, 0.0)].to_vec();
    for points in [vec![point; 4], on_line, in_plane] {
        assert_eq!(extents(&points, 0.0), None);
        assert!(faces(&points).is_none());
        assert_eq!(check(&Shape::Hull { points: points.clone() }), Err(Unsound::Flat));
        assert_eq!(Shape::Hull { points }.thickness(), 0.0);
    }
}

/// A union is as thin as its thinnest part.
#[test]
fn thicknesses_are_least_extents() {
    let ball = Shape::Sphere { radius: 0.03 };
    let rod = Shape::Cylinder { radius: 0.03, length: 0.05, axis: Vec3::x() };
    let disc = Shape::Cylinder { radius: 0.03, length: 0.01, axis: Vec3::x() };
    let plate = Shape::Box { size: Vec3::new(0.2, 0.02, 0.1) };
    let pin = Shape::Capsule { radius: 0.004, length: 0.1, axis: Vec3::x() };
    let all = [(ball, 0.06), (rod, 0.05), (disc, 0.01), (plate, 0.02), (pin, 0.008)];
    for (shape, thickness) in &all {
        assert_eq!(shape.thickness(), *thickness);
    }
    for count in 0..=all.len() {
        let parts = all[..count].iter().map(|(shape, _)| at(Pose::identity(), shape.clone())).collect();
        let least = all[..count].iter().map(|(_, thickness)| *thickness).fold(f64::INFINITY, f64::min);
        assert_eq!(Shape::Union { parts }.thickness(), least);
    }
    let points =
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 1.0, 0.5]].map(Vec3::from).to_vec();
    assert!((Shape::Hull { points }.thickness() - 0.5).abs() < 1e-15);
}

/// The box is as large as the support function says, and the ball holds all points and is not larger than it need be.
#[test]
fn solids_fit_their_balls_and_boxes() {
    let mut n = Numbers(1);
    for _ in 0..300 {
        let count = 1 + n.below(4);
        let placed: Vec<Placed> = (0..count)
            .map(|_| {
                let kind = n.below(5);
                at(shifted(n.vector() * 0.3) * n.rotation(), shapes(&mut n)[kind].clone())
            })
            .collect();
        let whole = solid(&placed);
        let (low, high) = whole.bounds;
        for axis in 0..3 {
            let reach = |n: Vec3| whole.parts.iter().map(|p| p.support(&n).dot(&n)).fold(f64::MIN, f64::max);
            let way = Vec3::ith(axis, 1.0);
            assert!((reach(way) - high[axis]).abs() < 1e-12 && (reach(-way) + low[axis]).abs() < 1e-12);
        }
        assert!((whole.centre - (low + high) / 2.0).norm() < 1e-15);
        for _ in 0..50 {
            let way = n.direction();
            let points = whole.parts.iter().map(|p| p.support(&way));
            points.for_each(|p| assert!((p - whole.centre).norm() <= whole.radius + 1e-12));
        }
        assert!(whole.radius <= (high - low).norm() / 2.0 + 1e-15);
        let about = |p: &Part| (p.centre - whole.centre).norm() + p.radius;
        assert!(whole.radius <= whole.parts.iter().map(about).fold(0.0, f64::max) + 1e-15);
    }
    // Of a ball it is the ball itself, wherever it is.
    let centre = Vec3::new(0.3, -0.2, 0.1);
    let ball = solid(&[at(shifted(centre), Shape::Sphere { radius: 0.05 })]);
    assert!((ball.radius - 0.05).abs() < 1e-15 && (ball.centre - centre).norm() < 1e-15);
}

/// What is scaled about its centre has its points in proportion.
#[test]
fn scaled_parts_have_scaled_points() {
    let mut n = Numbers(2);
    for _ in 0..300 {
        let (part, factor) = (part(&mut n), n.between(0.1, 3.0));
        let (scaled, way) = (part.scaled(factor), n.direction());
        assert!((scaled.radius - factor * part.radius).abs() < 1e-15);
        let expected = part.centre + (part.support(&way) - part.centre) * factor;
        assert!((scaled.support(&way) - expected).norm() < 1e-12, "{part:?}");
        assert!((scaled.reach(&way) - factor * part.reach(&way)).abs() < 1e-12, "{part:?}");
    }
}

#[test]
fn poses_and_sizes_that_make_no_solid_are_refused() {
    let ball = Shape::Sphere { radius: 0.1 };
    let far = shifted(Vec3::new(0.0, 1001.0, 0.0));
    let endless = shifted(Vec3::new(0.0, 0.0, f64::NAN));
    let mut sheared = Pose::identity();
    sheared.rotation = nalgebra::Unit::new_unchecked(sheared.rotation.into_inner() * 1.001);
    for (pose, fault) in
        [(far, Unsound::NotFinite), (endless, Unsound::NotFinite), (sheared, Unsound::NotRigid)]
    {
        assert_eq!(check_pose(&pose), Err(fault.clone()));
        let placed = at(pose, ball.clone());
        assert_eq!(check_placed(&placed), Err(fault.clone()));
        assert_eq!(check(&Shape::Union { parts: vec![placed] }), Err(fault));
    }
    assert_eq!(check_pose(&shifted(Vec3::new(0.0, 999.0, 0.0))), Ok(()));
    let capsule = |length: f64| Shape::Capsule { radius: 0.1, length, axis: Vec3::z() };
    assert_eq!(check(&capsule(0.0)), Ok(()));
    for length in [-1e-9, -0.5, -2.0] {
        assert_eq!(check(&capsule(length)), Err(Unsound::TooThin { what: "length", value: length }));
    }
}

/// A tetrahedron, and what is wrong with it: turned inside out, with a corner too many, and so small that it holds nothing.
#[test]
fn meshes_are_closed_face_outwards_and_hold_something() {
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let outwards = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = |size: f64, triangles: &[[u32; 3]]| {
        let vertices = corners.iter().map(|p| p * size).collect();
        check(&Shape::Mesh { name: "t.stl".into(), vertices, triangles: triangles.to_vec() })
    };
    assert_eq!(mesh(1.0, &outwards), Ok(()));
    assert_eq!(mesh(1.0, &outwards.map(|[a, b, c]| [a, c, b])), Err(Unsound::NoInside));
    assert_eq!(mesh(1.0, &outwards[..3]), Err(Unsound::Open { a: 1, b: 2 }));
    for (triangle, corner) in [(0, 0), (1, 2), (3, 1)] {
        let mut wrong = outwards;
        wrong[triangle][corner] = 4;
        assert_eq!(mesh(1.0, &wrong), Err(Unsound::NoVertex { triangle }));
    }
    // A sixth of the cube of its edge.
    assert_eq!(mesh(1.8e-6, &outwards), Err(Unsound::NoInside));
    assert_eq!(mesh(1.9e-6, &outwards), Ok(()));
}

/// A tub that is wholly in the wall of another is in it, though no surfaces cross, wherever its frame is; in the hollow it is
/// not.
#[test]
fn a_mesh_within_the_wall_of_another_is_enclosed() {
    let big = solid(&[tub(0.08, 0.02, 1.0)]);
    let mut n = Numbers(3);
    for _ in 0..50 {
        // Its frame is up to 0.2 m away from what is a hundredth as large.
        let frame = shifted(n.vector() * 0.2) * n.rotation();
        let small = solid(&[Placed { pose: frame, ..tub(0.08, 0.02, 0.01) }]);
        let place = |x: f64, y: f64, z: f64| shifted(Vec3::new(x, y, z)) * frame.inverse();
        for (x, y, z, inside) in [
            (0.09, 0.0, 0.05, true),
            (0.0, 0.09, 0.03, true),
            (-0.03, 0.02, 0.01, true),
            (0.0, 0.0, 0.05, false),
            (0.15, 0.0, 0.05, false),
            (0.0, 0.0, -0.05, false),
            (0.0, 0.0, 0.15, false),
        ] {
            let depth = enclosed_depth(&big, &small, &place(x, y, z));
            assert_eq!(depth > 0.0, inside, "{x} {y} {z}: {depth}");
            assert!(depth < 0.0101, "{depth}");
            assert!(!inside || depth > 0.008, "{depth}");
        }
    }
}

/// Where parts have one centre, the directions are searched: none of many is better than what is found.
#[test]
fn parts_about_one_centre_are_as_deep_as_the_best_of_many_directions() {
    let mut n = Numbers(4);
    for round in 0..60 {
        let (a, b) = (part(&mut n), part(&mut n));
        let X_AB = n.rotation();
        let offset = a.centre - X_AB.transform_point(&b.centre.into()).coords;
        let X_AB = shifted(offset + n.vector() * [0.0, 1e-3, 5e-3][round % 3]) * X_AB;
        let found = signed_distance(&a, &b, &X_AB);
        assert!((separation_along(&a, &b, &X_AB, &found.normal) - found.distance).abs() < 1e-9);
        for _ in 0..3000 {
            let gap = separation_along(&a, &b, &X_AB, &n.direction());
            assert!(gap <= found.distance + 1e-6, "{round}: {gap} is more than {}", found.distance);
        }
    }
}

/// A ball about the middle of a rod or a block comes out by the nearest way: through the side, or through an end.
#[test]
fn balls_come_out_of_the_middle_by_the_nearest_way() {
    let mut n = Numbers(9);
    for round in 0..8000 {
        let (ball, radius) = (n.between(0.005, 0.05), n.between(0.01, 0.05));
        let (half, place) = (n.between(0.01, 0.05), n.vector() * [0.0, 1e-4, 2e-3][round % 3]);
        let rod = Part::cylinder(Vec3::zeros(), Vec3::z() * half, radius);
        let edges = [radius, n.between(0.01, 0.05), half];
        let block = Part::boxed(Vec3::zeros(), [0, 1, 2].map(|axis| Vec3::ith(axis, edges[axis])));
        let out_of_rod = (radius - place.xy().norm()).min(half - place.z.abs());
        let out_of_block = (0..3).map(|axis| edges[axis] - place[axis].abs()).fold(f64::INFINITY, f64::min);
        let turn = n.rotation();
        for (part, way) in [(rod, out_of_rod), (block, out_of_block)] {
            let (part, ball) = (part.moved(&turn), Part::sphere(Vec3::zeros(), ball));
            let at = shifted(turn * place);
            let found = [
                signed_distance(&part, &ball, &at).distance,
                signed_distance(&ball, &part, &at.inverse()).distance,
            ];
            let expected = -(way + ball.radius);
            assert!(found.iter().all(|d| (d - expected).abs() < 5e-4), "{round}: {found:?} {expected}");
        }
    }
}

/// A ball about the centre of a tetrahedron comes out through the nearest face, whichever it is.
#[test]
fn balls_come_out_of_tetrahedra_through_the_nearest_face() {
    let mut n = Numbers(12);
    for round in 0..3000 {
        let corners: Vec<Vec3> = (0..4).map(|_| n.vector() * 0.1).collect();
        let hull = Shape::Hull { points: corners.clone() };
        let (Ok(()), ball) = (check(&hull), n.between(0.001, 0.05)) else { continue };
        let part = solid(&[at(Pose::identity(), hull)]).parts.remove(0);
        // The distance from the plane of a face, positive on the side of the corner behind it.
        let away = |face: usize| {
            let [own, p, q, r] = [0, 1, 2, 3].map(|k| corners[(face + k) % 4]);
            let normal = (q - p).cross(&(r - p)).normalize();
            (part.centre - p).dot(&normal) * (own - p).dot(&normal).signum()
        };
        let nearest = (0..4).map(away).fold(f64::INFINITY, f64::min);
        if nearest < 0.0 {
            continue;
        }
        let found = signed_distance(&part, &Part::sphere(Vec3::zeros(), ball), &shifted(part.centre));
        assert!((found.distance + nearest + ball).abs() < 1e-6, "{round}: {found:?} of {nearest} and {ball}");
    }
}

/// Distances are the same from either side, from any first guess, and for boxes and hulls of their corners.
#[test]
fn distances_are_the_same_from_either_side() {
    let mut n = Numbers(5);
    for round in 0..10_000 {
        let (a, b) = (part(&mut n), part(&mut n));
        let X_AB = shifted(n.vector() * 0.2) * n.rotation();
        let (one, other) = (signed_distance(&a, &b, &X_AB), signed_distance(&b, &a, &X_AB.inverse()));
        let tolerance = if one.distance > 0.0 { 2e-8 } else { 2e-6 };
        assert!((one.distance - other.distance).abs() < tolerance, "{round}: {one:?} {other:?}");
        assert!(separation_along(&a, &b, &X_AB, &one.normal) <= one.distance + 1e-9, "{round}");
    }
}

/// A point of contact is in both parts where they overlap, and the middle between them where they don't.
#[test]
fn points_of_contact_are_in_both_parts() {
    let mut n = Numbers(6);
    let mut overlapping = 0;
    for round in 0..500 {
        let (a, b) = (part(&mut n), part(&mut n));
        let centre = a.centre - b.centre;
        let X_AB = shifted(centre + n.direction() * n.between(0.0, 0.1));
        let gap = signed_distance(&a, &b, &X_AB).distance;
        let found = contact_point(&a, &b, &X_AB);
        let from = |part: &Part, point: Vec3| {
            signed_distance(&Part::sphere(point, 0.0), part, &Pose::identity()).distance
        };
        let distances = [from(&a, found), from(&b, X_AB.inverse().transform_point(&found.into()).coords)];
        if gap < -1e-3 {
            overlapping += 1;
            // Projections to and fro come near slowly, and stop after some rounds.
            assert!(distances.iter().all(|d| *d < 1e-4), "{round}: {distances:?} of {a:?} {b:?}");
        } else if gap > 1e-3 {
            assert!(distances.iter().all(|d| (d - gap / 2.0).abs() < 1e-3), "{round}: {distances:?} {gap}");
        }
    }
    assert!(overlapping > 100, "{overlapping}");
    // A small ball in a large one: the middle between their centres is in both already.
    let (large, small) = (Part::sphere(Vec3::zeros(), 1.0), Part::sphere(Vec3::new(0.06, 0.0, 0.0), 0.1));
    assert!((contact_point(&large, &small, &Pose::identity()) - Vec3::new(0.03, 0.0, 0.0)).norm() < 1e-12);
}

#[test]
fn ends_of_segments_are_as_near_as_points() {
    let mut n = Numbers(7);
    for round in 0..2000 {
        let p = (n.vector(), n.vector());
        let q = if round % 10 == 0 { (p.0, p.0) } else { (n.vector(), n.vector()) };
        for (end, point) in [(0, p.0), (1, p.1)] {
            let found = end_segment(p, end, q);
            assert!((found.distance - point_segment_distance(point, q)).abs() < 1e-12);
            assert_eq!(found.along.0, end as f64);
            let other = q.0 + (q.1 - q.0) * found.along.1;
            assert!((point - other - found.normal * found.distance).norm() < 1e-12);
        }
    }
}

/// Pairs come by the second box, then by the cell that they share first, then by the first box.
#[test]
fn near_boxes_are_told_in_the_order_of_cells() {
    let along = |from: f64, to: f64, way: usize| {
        let across = Vec3::repeat(0.5) - Vec3::ith(way, 0.5);
        Aabb { low: across + Vec3::ith(way, from), high: across * 1.2 + Vec3::ith(way, to) }
    };
    for way in 0..3 {
        let boxes = [along(1.1, 2.9, way), along(0.1, 0.9, way), along(0.5, 1.5, way), along(2.5, 3.4, way)];
        let mut found = Vec::new();
        near_boxes(&boxes, 0.0, 1.0, |i, j| found.push((i, j)));
        assert_eq!(found, [(1, 2), (0, 2), (0, 3)]);
    }
}

/// A polygon in space whose corners go round a point, in and out, or along combs and steps.
#[test]
fn triangles_of_a_polygon_make_up_its_area_and_do_not_overlap() {
    let mut n = Numbers(8);
    let comb: Vec<[f64; 2]> = (0..5)
        .flat_map(|i| {
            let x = f64::from(i);
            [[x, 0.0], [x, 3.0], [x + 0.5, 3.0], [x + 0.5, 0.25]]
        })
        .chain([[5.0, 0.0], [5.0, -1.0], [0.0, -1.0]])
        .rev()
        .collect();
    for round in 0..100 {
        let count = 3 + n.below(15);
        // Large or small: what turns is told by signs alone.
        let size = libm::pow(10.0, n.between(-2.0, 1.0));
        let star = (0..count).map(|k| {
            let (s, c) = libm::sincos(TAU * k as f64 / count as f64);
            let reach = n.between(0.3, 3.0) * size;
            [c * reach, s * reach]
        });
        let flat: Vec<[f64; 2]> =
            if round % 20 == 0 { comb.iter().map(|c| c.map(|x| x / 64.0)).collect() } else { star.collect() };
        // The comb has corners in line, which rounding takes out of it.
        let (count, pose) = (flat.len(), shifted(n.vector() * 10.0) * n.rotation());
        let corners: Vec<Vec3> =
            flat.iter().map(|[x, y]| pose.transform_point(&Vec3::new(*x, *y, 0.0).into()).coords).collect();
        let twice = |[a, b, c]: [usize; 3]| {
            (flat[b][0] - flat[a][0]) * (flat[c][1] - flat[a][1])
                - (flat[b][1] - flat[a][1]) * (flat[c][0] - flat[a][0])
        };
        let area: f64 = (1..count - 1).map(|k| twice([0, k, k + 1])).sum();
        let triangles = triangulate(&corners);
        assert_eq!(triangles.len(), count - 2);
        // None turns the other way, and they are as large together as the whole: so they don't overlap.
        assert!(triangles.iter().all(|t| twice(*t) * area > -1e-12 * area * area), "{flat:?} {triangles:?}");
        let sum: f64 = triangles.iter().map(|t| twice(*t)).sum();
        assert!((sum - area).abs() < 1e-9 * area.abs(), "{flat:?}");
    }
    assert!(triangulate(&[Vec3::zeros(), Vec3::x()]).is_empty());
}

/// A rod with round ends of a length that varies: from a ball of radius 1 to something long and thin, whose inertia is that of
/// a line.
#[test]
fn capsules_weigh_as_slices_do() {
    use modl::geometry::volume::of_shape;
    for (radius, length) in [(1.0, 0.0), (0.3, 0.1), (0.2, 1.5), (0.01, 2.0)] {
        const SLICES: u32 = 20_000;
        let step = (length + 2.0 * radius) / f64::from(SLICES);
        let (mut volume, mut along, mut across) = (0.0, 0.0, 0.0);
        for k in 0..SLICES {
            let x = -length / 2.0 - radius + step * (f64::from(k) + 0.5);
            let beyond = (x.abs() - length / 2.0).max(0.0);
            let square = radius * radius - beyond * beyond;
            let slice = PI * square * step;
            (volume, along, across) = (volume + slice, along + slice * x * x, across + slice * square / 4.0);
        }
        let found = of_shape(&Shape::Capsule { radius, length, axis: Vec3::y() }).expect("sound");
        assert!((found.volume / volume - 1.0).abs() < 1e-6);
        for (found, expected) in [(found.second[(1, 1)], along), (found.second[(0, 0)], across)] {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        }
        assert!(found.second[(0, 1)].abs() < 1e-15 && found.centre.norm() == 0.0);
    }
}

/// Boxes of nothing are near to nothing.
#[test]
fn empty_boxes_have_no_neighbours() {
    let nothing = Aabb::around([]);
    let some = Aabb::around([Vec3::zeros(), Vec3::x()]);
    for boxes in [vec![], vec![nothing], vec![nothing; 3], vec![some, nothing]] {
        near_boxes(&boxes, 0.5, 0.1, |i, j| panic!("{i} and {j} are not near"));
    }
}
