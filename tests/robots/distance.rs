//! Signed distances against closed forms.
#![allow(non_snake_case)]

use crate::support::hollow_meshes::tub;
use crate::support::robots::{boxed, millimetres};
use modl::geometry::distance::{distance_of_solids, signed_distance};
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Shape, Solid, Vec3};
use proptest::prelude::*;

fn solid(shape: Shape) -> Solid {
    Solid::new(&[Placed { pose: Pose::identity(), shape }]).expect("a sound shape")
}

fn cube(edge: f64) -> Solid {
    solid(Shape::Box { size: Vec3::repeat(edge) })
}

#[track_caller]
fn check(a: &Solid, X_WA: Pose, b: &Solid, X_WB: Pose, expected: f64) {
    for (a, X_WA, b, X_WB) in [(a, X_WA, b, X_WB), (b, X_WB, a, X_WA)] {
        let found = distance_of_solids(a, &X_WA, b, &X_WB);
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }
}

#[test]
fn two_boxes_apart_touching_and_overlapping() {
    let (a, b) = (cube(0.1), cube(0.2));
    for gap in [0.05, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.02] {
        check(&a, Pose::identity(), &b, shifted(Vec3::new(0.15 + gap, 0.01, 0.02)), gap);
    }
    // Corner to corner, and edge to edge after half a right angle.
    check(&a, Pose::identity(), &b, shifted(Vec3::new(0.18, 0.19, 0.15)), 0.05);
    let tilted = shifted(Vec3::new(0.05 + 0.1 * 2f64.sqrt() + 0.01, 0.0, 0.0))
        * turned(Vec3::z(), std::f64::consts::FRAC_PI_4);
    check(&a, Pose::identity(), &b, tilted, 0.01);
}

#[test]
fn round_solids() {
    let ball = solid(Shape::Sphere { radius: 0.1 });
    check(&ball, Pose::identity(), &ball, shifted(Vec3::new(0.3, 0.4, 0.0)), 0.3);
    check(&ball, Pose::identity(), &ball, shifted(Vec3::new(0.15, 0.0, 0.0)), -0.05);
    let rod = solid(Shape::Capsule { radius: 0.02, length: 0.2, axis: Vec3::x() });
    check(&rod, Pose::identity(), &ball, shifted(Vec3::new(0.05, 0.3, 0.0)), 0.18);
    let wheel = solid(Shape::Cylinder { radius: 0.0453, length: 0.006, axis: Vec3::y() });
    let upright = turned(Vec3::x(), std::f64::consts::FRAC_PI_2);
    check(
        &wheel,
        Pose::identity(),
        &wheel,
        upright * shifted(Vec3::new(0.0, 0.1, 0.0)),
        0.1 - 0.003 - 0.0453,
    );
    check(&wheel, Pose::identity(), &wheel, shifted(Vec3::new(0.1, 0.0, 0.0)), 0.1 - 2.0 * 0.0453);
}

#[test]
fn a_union_is_as_near_as_its_nearest_part_and_its_hollow_is_empty() {
    let fork = Solid::new(&[
        boxed(millimetres(0.0, 30.0, 0.0), millimetres(100.0, 40.0, 10.0)),
        boxed(millimetres(0.0, -40.0, 0.0), millimetres(100.0, -30.0, 10.0)),
    ])
    .expect("sound");
    check(&fork, Pose::identity(), &cube(0.04), shifted(millimetres(50.0, 0.0, 5.0)), 0.01);
    assert!((fork.bounds.0 - millimetres(0.0, -40.0, 0.0)).norm() < 1e-15);
    assert!((fork.bounds.1 - millimetres(100.0, 40.0, 10.0)).norm() < 1e-15);
}

#[test]
fn a_mesh_keeps_its_hollow() {
    let (tub, small) = (solid(tub(0.08, 0.02, 1.0).shape), cube(0.04));
    check(&tub, Pose::identity(), &small, shifted(Vec3::new(0.0, 0.0, 0.06)), 0.02);
    check(&tub, Pose::identity(), &small, shifted(Vec3::new(0.05, 0.0, 0.06)), 0.01);
    check(&tub, Pose::identity(), &small, shifted(Vec3::new(0.15, 0.0, 0.06)), 0.03);
    // In the middle of a wall of 20 mm.
    let grain = cube(0.004);
    check(&tub, Pose::identity(), &grain, shifted(Vec3::new(0.09, 0.0, 0.05)), -0.010);
    // Two tubs at one place: their surfaces only touch, but the walls are one in the other. The inner point is in the
    // middle of the bottom of 20 mm.
    check(&tub, Pose::identity(), &tub, Pose::identity(), -0.010);
}

#[test]
fn a_convex_mesh_is_solid() {
    let vertices: Vec<Vec3> =
        (0..8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.1).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = solid(Shape::Mesh { name: "cube.stl".into(), vertices, triangles });
    assert_eq!(mesh.parts.len(), 1);
    check(&mesh, Pose::identity(), &cube(0.02), shifted(Vec3::new(0.05, 0.05, 0.095)), -0.015);
}

/// Whatever is shrunk, a volume remains.
fn spanning(size: f64) -> Vec<Vec3> {
    vec![Vec3::zeros(), Vec3::x() * size, Vec3::y() * size, Vec3::z() * size]
}

/// A direction that tells two parts apart must be had even where faces are parallel and rims in one
/// plane, as in robots they mostly are.
#[test]
fn the_parts_of_a_robot_at_rest_are_told_apart() {
    let robot = crate::support::robots::car();
    let kinematics = modl::robot::Kinematics::new(&robot, &[true; 6], 0);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&[0.0; 28], &Pose::identity(), &mut poses);
    let solids: Vec<Solid> = (0..35)
        .map(|l| Solid::new(&robot.module_type(0).links[l % 5].collides).expect("a sound shape"))
        .collect();
    for (i, j) in (0..35).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let X_AB = poses[i].inverse() * poses[j];
        for (a, b) in solids[i].parts.iter().flat_map(|a| solids[j].parts.iter().map(move |b| (a, b))) {
            let found = signed_distance(a, b, &X_AB);
            let gap = modl::geometry::distance::separation_along(a, b, &X_AB, &found.normal);
            assert!((found.distance - gap).abs() < 1e-7, "links {i} and {j}: {found:?}, gap {gap}");
        }
    }
}

fn any_part() -> impl Strategy<Value = Solid> {
    let size = 0.02..0.1f64;
    let axis =
        prop::array::uniform3(-1.0..1.0f64).prop_filter("has a direction", |a| Vec3::from(*a).norm() > 0.1);
    (
        0..5usize,
        prop::array::uniform3(size),
        axis,
        prop::collection::vec(prop::array::uniform3(-0.1..0.1f64), 12),
    )
        .prop_map(|(kind, [a, b, c], axis, points)| {
            let axis = Vec3::from(axis).normalize();
            solid(match kind {
                0 => Shape::Box { size: Vec3::new(a, b, c) },
                1 => Shape::Cylinder { radius: a, length: b, axis },
                2 => Shape::Sphere { radius: a },
                3 => Shape::Capsule { radius: a, length: b, axis },
                _ => {
                    Shape::Hull { points: points.into_iter().map(Vec3::from).chain(spanning(0.01)).collect() }
                }
            })
        })
}

proptest! {
    #![proptest_config(crate::support::properties::cases(2000))]

    /// Bracketed from both sides: the gap along the normal found is never more than the distance;
    /// no other direction has a larger gap; and a shift by the distance along the normal makes the
    /// two touch.
    #[test]
    fn the_distance_is_the_greatest_gap(
        a in any_part(), b in any_part(),
        p in prop::array::uniform3(-0.2..0.2f64), w in prop::array::uniform3(-2.0..2.0f64),
        others in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 30),
    ) {
        let (a, b) = (&a.parts[0], &b.parts[0]);
        let X_AB = shifted(Vec3::from(p)) * turned(Vec3::from(w), Vec3::from(w).norm());
        let found = signed_distance(a, b, &X_AB);
        let gap = |n: &Vec3| modl::geometry::distance::separation_along(a, b, &X_AB, n);
        prop_assert!((gap(&found.normal) - found.distance).abs() < 1e-6, "{} {found:?}", gap(&found.normal));
        for n in others.iter().filter(|n| Vec3::from(**n).norm() > 0.1) {
            prop_assert!(gap(&Vec3::from(*n).normalize()) <= found.distance + 1e-6);
        }
        let touching = shifted(-found.normal * found.distance) * X_AB;
        let then = signed_distance(a, b, &touching).distance;
        prop_assert!(then.abs() < 1e-5, "{found:?} then {then}");
    }
}
