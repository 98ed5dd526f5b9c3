//! Protrusions of drawn shapes, by closed forms.

use crate::support::hollow_meshes::tub;
use crate::support::numbers::Numbers;
use modl::geometry::pose::shifted;
use modl::geometry::{Placed, Pose, Shape, Vec3, protrusion};

/// The part of the drawn part's radius by which a bound may be too large.
const NEAR: f64 = 1e-4;

fn block(centre: [f64; 3], size: [f64; 3]) -> Placed {
    Placed { pose: shifted(Vec3::from(centre)), shape: Shape::Box { size: Vec3::from(size) } }
}

/// Asserts the protrusion of shapes, in several poses of all of them together, to the accuracy that is stated.
#[track_caller]
fn sticks_out(shapes: &[Placed], cover: &[Placed], radius: f64, expected: f64) {
    let mut n = Numbers(1);
    for round in 0..4 {
        let pose = if round == 0 { Pose::identity() } else { shifted(n.vector()) * n.rotation() };
        let moved = |all: &[Placed]| -> Vec<Placed> {
            all.iter()
                .map(|placed| Placed { pose: pose * placed.pose, shape: placed.shape.clone() })
                .collect()
        };
        let found = protrusion(&moved(shapes), &moved(cover)).expect("they are solids");
        assert!(found >= expected - 1e-9, "{found} is less than {expected}");
        assert!(found <= expected + NEAR * radius + 1e-9, "{found} is more than {expected}");
    }
}

/// A block of 200 mm covered by two that overlap, or meet, or leave a gap: in its middle the surface is half of it away.
#[test]
fn what_two_blocks_cover_together_does_not_stick_out() {
    let (drawn, radius) = (block([0.0; 3], [0.2, 0.1, 0.06]), libm::sqrt(0.01 + 0.0025 + 0.0009));
    for gap in [-0.05, -0.01, 0.0, 0.002, 0.01, 0.05] {
        let length = 0.1 - gap / 2.0;
        let half = |side: f64| block([side * (0.1 - length / 2.0), 0.0, 0.0], [length, 0.1, 0.06]);
        sticks_out(std::slice::from_ref(&drawn), &[half(-1.0), half(1.0)], radius, gap.max(0.0) / 2.0);
    }
}

/// A block that is higher than what covers it, in one, two or four pieces.
#[test]
fn a_block_sticks_out_by_what_it_is_higher() {
    let (drawn, radius) =
        (block([0.0, 0.0, 0.002], [0.1, 0.1, 0.05]), libm::sqrt(0.0025 + 0.0025 + 0.000_625));
    let whole = block([0.0; 3], [0.1, 0.1, 0.05]);
    let halves = [-0.025, 0.025].map(|x| block([x, 0.0, 0.0], [0.05, 0.1, 0.05]));
    let quarters = [(-0.025, -0.025), (0.025, -0.025), (0.025, 0.025), (-0.025, 0.025)]
        .map(|(x, y)| block([x, y, 0.0], [0.05, 0.05, 0.05]));
    for cover in [&[whole][..], &halves, &quarters] {
        sticks_out(std::slice::from_ref(&drawn), cover, radius, 0.002);
    }
    // Along the middle of each side the corners of two pieces are 20 mm apart: 10 mm away.
    let apart = [-0.03, 0.03].map(|x| block([x, 0.0, 0.0], [0.04, 0.1, 0.05]));
    sticks_out(std::slice::from_ref(&drawn), &apart, radius, libm::sqrt(0.01 * 0.01 + 0.002 * 0.002));
}

/// What is drawn and judged is the same, in another order, or some of it more than once.
#[test]
fn what_covers_itself_does_not_stick_out() {
    let mut n = Numbers(2);
    let axis = n.direction();
    let shapes = [
        Shape::Box { size: Vec3::new(0.1, 0.05, 0.02) },
        Shape::Cylinder { radius: 0.02, length: 0.1, axis },
        Shape::Sphere { radius: 0.03 },
        Shape::Capsule { radius: 0.02, length: 0.1, axis },
        Shape::Hull { points: (0..9).map(|_| n.vector() * 0.05).collect() },
    ];
    let drawn: Vec<Placed> = shapes
        .iter()
        .map(|shape| Placed { pose: shifted(n.vector()) * n.rotation(), shape: shape.clone() })
        .collect();
    let cover: Vec<Placed> = drawn.iter().rev().cloned().collect();
    assert_eq!(protrusion(&drawn, &cover), Ok(0.0));
    assert_eq!(protrusion(&drawn, &drawn[..1]).map(|found| found > 0.0), Ok(true));
    assert_eq!(protrusion(&drawn, &[]), Ok(f64::INFINITY));
    assert_eq!(protrusion(&[], &[]), Ok(0.0));
}

/// Balls, of which the bound is that of the part that holds them best.
#[test]
fn a_ball_that_looks_out_of_two_blocks_is_seen() {
    let ball = |radius: f64, z: f64| Placed {
        pose: shifted(Vec3::new(0.0, 0.0, z)),
        shape: Shape::Sphere { radius },
    };
    let cover = [-0.05, 0.05].map(|x| block([x, 0.0, 0.0], [0.15, 0.1, 0.1]));
    // In both, which overlap over 50 mm; 3 mm out of their tops.
    assert_eq!(protrusion(&[ball(0.02, 0.0)], &cover), Ok(0.0));
    let found = protrusion(&[ball(0.02, 0.033)], &cover).expect("solids");
    assert!((found - 0.003).abs() < 1e-9, "{found}");
    // Beside them, by the distance and the radius twice.
    let found = protrusion(&[ball(0.02, 0.1)], &cover).expect("solids");
    assert!((found - 0.07).abs() < 1e-9, "{found}");
}

/// A round thing is judged as the prism around it: a rod in a tube of its own size, made of two.
#[test]
fn a_rod_is_covered_by_two_rods_that_meet() {
    let rod = |x: f64, length: f64, radius: f64| Placed {
        pose: shifted(Vec3::new(x, 0.0, 0.0)),
        shape: Shape::Cylinder { radius, length, axis: Vec3::x() },
    };
    let cover = [rod(-0.05, 0.1, 0.02), rod(0.05, 0.1, 0.02)];
    let radius = libm::sqrt(0.01 + 0.0004);
    let found = protrusion(&[rod(0.0, 0.2, 0.02)], &cover).expect("solids");
    assert!((0.0..7.6e-5 * 0.02 + NEAR * radius).contains(&found), "{found}");
    let found = protrusion(&[rod(0.0, 0.2, 0.023)], &cover).expect("solids");
    assert!((0.003..0.003 + 7.6e-5 * 0.023 + NEAR * radius).contains(&found), "{found}");
    // A rod that is longer than what covers it, of one piece.
    let found = protrusion(&[rod(0.0, 0.204, 0.01)], &[rod(0.0, 0.2, 0.02)]).expect("solids");
    assert!((found - 0.002).abs() < 1e-9, "{found}");
}

/// A rod in a block that ends before it, at one end or at the other.
#[test]
fn a_rod_sticks_out_at_either_end_by_what_it_is_longer() {
    let rod = Shape::Cylinder { radius: 0.02, length: 0.1, axis: Vec3::z() };
    let drawn = Placed { pose: Pose::identity(), shape: rod };
    let radius = libm::hypot(0.02, 0.05);
    for side in [-1.0, 1.0] {
        let cover = block([0.0, 0.0, -0.005 * side], [0.1, 0.1, 0.1]);
        sticks_out(std::slice::from_ref(&drawn), &[cover], radius, 0.005);
    }
}

/// A box that is hollow: what is in its wall is covered, and what is in the hollow, open above, is not.
#[test]
fn walls_of_a_mesh_cover_and_its_hollow_does_not() {
    let tub = tub(0.06, 0.04, 1.0);
    let cover = std::slice::from_ref(&tub);
    sticks_out(&[block([0.08, 0.0, 0.05], [0.02, 0.02, 0.02])], cover, 0.017, 0.0);
    sticks_out(&[block([0.01, 0.0, 0.02], [0.04, 0.03, 0.02])], cover, 0.026, 0.0);
    // From the bottom up into the hollow by 10 mm, in its middle.
    sticks_out(&[block([0.0, 0.0, 0.03], [0.02, 0.02, 0.04])], cover, 0.03, 0.01);
}
