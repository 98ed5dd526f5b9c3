//! Masses and inertias of shapes against closed forms, and shapes that are none.

use crate::support::robots::boxed;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Placed, Pose, Shape, Unsound, Vec3, soundness};
use modl::robot::mass::{Mass, of_shapes, split};
use std::f64::consts::PI;

fn of(shape: Shape) -> Mass {
    of_shapes(&[Placed { pose: Pose::identity(), shape }], 1000.0).expect("a sound shape")
}

#[track_caller]
fn check(found: &Mass, mass: f64, com: [f64; 3], inertia: [f64; 6]) {
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{found:?}: {a} is not {b}");
    near(found.mass, mass);
    (0..3).for_each(|i| near(found.com[i], com[i]));
    (0..6).for_each(|i| near(found.inertia[i], inertia[i]));
}

#[test]
fn a_box() {
    let m = of(Shape::Box { size: Vec3::new(0.1, 0.2, 0.3) });
    let i = |a: f64, b: f64| 6.0 / 12.0 * (a * a + b * b);
    check(&m, 6.0, [0.0; 3], [i(0.2, 0.3), i(0.1, 0.3), i(0.1, 0.2), 0.0, 0.0, 0.0]);
}

#[test]
fn a_cylinder_a_sphere_and_a_capsule() {
    let (r, l) = (0.05, 0.2);
    let mass = 1000.0 * PI * r * r * l;
    let across = mass * (3.0 * r * r + l * l) / 12.0;
    let m = of(Shape::Cylinder { radius: r, length: l, axis: Vec3::y() });
    check(&m, mass, [0.0; 3], [across, mass * r * r / 2.0, across, 0.0, 0.0, 0.0]);

    let ball = 1000.0 * 4.0 / 3.0 * PI * r * r * r;
    let about = 0.4 * ball * r * r;
    check(&of(Shape::Sphere { radius: r }), ball, [0.0; 3], [about, about, about, 0.0, 0.0, 0.0]);

    // A half ball about its own centre of mass has 83/320 m r² across its axis.
    let m = of(Shape::Capsule { radius: r, length: l, axis: Vec3::x() });
    let reach = l / 2.0 + 3.0 / 8.0 * r;
    let caps = 2.0 * (83.0 / 320.0 * (ball / 2.0) * r * r + (ball / 2.0) * reach * reach);
    let along = mass * r * r / 2.0 + about;
    check(&m, mass + ball, [0.0; 3], [along, across + caps, across + caps, 0.0, 0.0, 0.0]);
}

fn corners(size: Vec3, at: Vec3) -> Vec<Vec3> {
    let half = |bit: usize| if bit == 0 { -0.5 } else { 0.5 };
    let all = (0..8).map(|i| Vec3::new(half(i & 4), half(i & 2), half(i & 1)));
    all.map(|s| at + s.component_mul(&size)).collect()
}

/// The same box as corners, as triangles, and as two halves.
#[test]
fn a_box_by_other_means() {
    let (size, at) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.0, -2.0, 0.5));
    let plain =
        of_shapes(&[Placed { pose: shifted(at), shape: Shape::Box { size } }], 1000.0).expect("sound");
    let same = |m: Mass| check(&m, 6.0, [1.0, -2.0, 0.5], plain.inertia);
    let vertices = corners(size, at);
    same(of(Shape::Hull { points: vertices.clone() }));
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    same(of(Shape::Mesh { name: "box.stl".into(), vertices, triangles }));
    let half = |z: f64| boxed(at + Vec3::new(-0.05, -0.1, z), at + Vec3::new(0.05, 0.1, z + 0.15));
    same(of(Shape::Union { parts: vec![half(-0.15), half(0.0)] }));
}

/// Sheets and needles weigh what their product of sides says, whichever way they lie; corners of a micrometre
/// at metres from the middle are rounded to 1e-9 of it.
#[test]
fn thin_hulls_weigh_what_they_should() {
    for size in [[1.0, 0.5, 1e-3], [1.0, 2.0, 1e-5], [2e-5, 3.0, 1e-3], [1e-5, 1e-5, 2.0], [0.3, 10.0, 2e-6]]
    {
        let size = Vec3::from(size);
        for (axis, angle) in
            [(Vec3::x(), 0.0), (Vec3::new(1.0, 2.0, 3.0), 1.1), (Vec3::new(-3.0, 1.0, 0.2), 2.5)]
        {
            let lies = turned(axis, angle);
            let points = corners(size, Vec3::zeros()).iter().map(|p| lies.rotation * (p + size)).collect();
            let found = of(Shape::Hull { points }).mass;
            let expected = 1000.0 * size.x * size.y * size.z;
            assert!((found / expected - 1.0).abs() < 1e-7, "{size:?}: {found} is not {expected}");
        }
    }
}

/// Turning a shape turns its inertia: `R I Rᵀ` leaves trace and determinant.
#[test]
fn a_turned_box_keeps_its_invariants() {
    let shape = Shape::Box { size: Vec3::new(0.1, 0.2, 0.3) };
    let turned =
        of_shapes(&[Placed { pose: turned(Vec3::new(1.0, 2.0, 3.0), 1.1), shape: shape.clone() }], 1000.0);
    let as_matrix = |m: &Mass| {
        let [xx, yy, zz, xy, xz, yz] = m.inertia;
        nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    };
    let (a, b) = (as_matrix(&of(shape)), as_matrix(&turned.expect("sound")));
    assert!((a.trace() - b.trace()).abs() < 1e-15);
    assert!((a.determinant() / b.determinant() - 1.0).abs() < 1e-12);
    assert!(b[(0, 1)].abs() > 1e-4, "it is really turned");
}

#[test]
fn a_modules_mass_is_split_by_volume() {
    let small = [boxed(Vec3::zeros(), Vec3::new(0.1, 0.1, 0.1))];
    let large = [boxed(Vec3::zeros(), Vec3::new(0.1, 0.1, 0.3))];
    let masses = split(&[(&small, None), (&large, None)], 2.0).expect("sound").expect("enough mass");
    assert!((masses[0].mass - 0.5).abs() < 1e-15 && (masses[1].mass - 1.5).abs() < 1e-15);
    let masses = split(&[(&small, None), (&large, Some(1.9))], 2.0).expect("sound").expect("enough mass");
    assert!((masses[0].mass - 0.1).abs() < 1e-15 && (masses[1].mass - 1.9).abs() < 1e-15);
    assert_eq!(split(&[(&small, Some(3.0)), (&large, None)], 2.0), Ok(None));
}

#[test]
fn what_is_no_solid_is_refused() {
    let refused = |shape: Shape, expected: Unsound| assert_eq!(soundness::check(&shape), Err(expected));
    refused(Shape::Box { size: Vec3::new(1.0, 0.0, 1.0) }, Unsound::TooThin { what: "width", value: 0.0 });
    refused(Shape::Sphere { radius: f64::NAN }, Unsound::NotFinite);
    refused(Shape::Sphere { radius: f64::INFINITY }, Unsound::NotFinite);
    refused(Shape::Cylinder { radius: 1.0, length: 1.0, axis: Vec3::zeros() }, Unsound::NoAxis);
    let square = corners(Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.3, 0.2, 0.1));
    refused(Shape::Hull { points: square.clone() }, Unsound::Flat);
    refused(Shape::Hull { points: square[..2].to_vec() }, Unsound::Flat);
    refused(Shape::Union { parts: vec![] }, Unsound::Empty);
    let mesh = |triangles| Shape::Mesh {
        name: "m".into(),
        vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
        triangles,
    };
    let closed = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    assert_eq!(soundness::check(&mesh(closed.clone())), Ok(()));
    refused(mesh(closed[..3].to_vec()), Unsound::Open { a: 0, b: 2 });
    refused(mesh(vec![[0, 1, 9]]), Unsound::NoVertex { triangle: 0 });
    refused(mesh(closed.iter().map(|&[a, b, c]| [a, c, b]).collect()), Unsound::NoInside);
}
