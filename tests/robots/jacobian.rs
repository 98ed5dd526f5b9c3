//! The geometric Jacobian against finite differences of forward kinematics, on random trees with joints of every kind,
//! and inverse kinematics against closed forms.
#![allow(non_snake_case)]

use crate::support::robots;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Vec3};
use modl::robot::inverse_kinematics::{Reach, Settings, StopReason, TaskSpace, reach};
use modl::robot::jacobian::{LinkFrame, base_jacobian, geometric_jacobian};
use modl::robot::{Assembly, Hinge, Joint, JointKind, Kinematics, Library, Limits, PortRef};
use nalgebra::{DMatrix, Vector6};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Numbers from -1 to 1, one after the other.
struct Numbers<'a>(std::iter::Cycle<std::slice::Iter<'a, f64>>);

impl Numbers<'_> {
    fn next(&mut self) -> f64 {
        *self.0.next().expect("endless")
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn axis(&mut self) -> Vec3 {
        (self.vector() + Vec3::new(1.3, 0.2, 0.1)).normalize()
    }
}

fn free() -> Limits {
    Limits { range: None, speed: None, acceleration: None, effort: None }
}

/// Modules of five links, joined by a turn, a mimic of it, a slide and a fixed joint; with a hinge in every bond.
fn random_robot(numbers: &mut Numbers, hinged: bool) -> Assembly {
    let mut kind = robots::smores();
    for link in &mut kind.links {
        link.pose = shifted(numbers.vector() * 0.1) * turned(numbers.axis(), 2.0 * numbers.next());
    }
    let mut joint = |name: &str, parent, child, kind, mimic| {
        let pose = shifted(numbers.vector() * 0.1) * turned(numbers.axis(), 3.0 * numbers.next());
        let driven = robots::joint(name, (parent, child), kind, pose, numbers.axis(), free());
        Joint { mimic, ..driven }
    };
    kind.joints = vec![
        joint("a", 0, 1, JointKind::Revolute, None),
        joint("b", 1, 2, JointKind::Revolute, Some(vec![(0, -1.5), (2, 4.0)])),
        joint("c", 2, 3, JointKind::Prismatic, None),
        joint("d", 0, 4, JointKind::Fixed, None),
    ];
    for port in &mut kind.ports {
        port.pose = shifted(numbers.vector() * 0.1) * turned(numbers.axis(), numbers.next());
    }
    let mut library: Library = (*robots::smores_library()).clone();
    library.modules = vec![kind];
    let axis = numbers.axis();
    library.connectors[0].hinge = hinged.then(|| Hinge { axis, limits: free() });
    let mut d = robots::Design::new("Random", Arc::new(library));
    let names: Vec<String> = (0..4).map(|i| format!("m{i}")).collect();
    names.iter().for_each(|name| {
        d.add(name);
    });
    // A fork: 0 - 1 - 2, and 3 at 1, docked from the far side.
    d.connect((0, robots::L), (1, robots::T), 1);
    d.connect((1, robots::R), (2, robots::B), 2);
    d.connect((3, robots::L), (1, robots::L), 3);
    d.0
}

fn poses(kinematics: &Kinematics, base: usize, joints: &[f64], X_WB: &Pose) -> Vec<Pose> {
    let mut out = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses_from(base, joints, X_WB, &mut out);
    out
}

/// The velocity between two near poses: of the origin, and the angle about axes of the world.
fn difference(a: &Pose, b: &Pose, step: f64) -> Vector6<f64> {
    let v = (b.translation.vector - a.translation.vector) / step;
    let w = (b.rotation * a.rotation.inverse()).scaled_axis() / step;
    Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
}

fn by_differences(
    kinematics: &Kinematics,
    frame: &LinkFrame,
    base: usize,
    joints: &[f64],
    X_WB: &Pose,
) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let mut jacobian = DMatrix::zeros(6, joints.len());
    for column in 0..joints.len() {
        let at = |by: f64| {
            let mut moved = joints.to_vec();
            moved[column] += by;
            frame.pose(&poses(kinematics, base, &moved, X_WB))
        };
        jacobian.set_column(column, &difference(&at(-STEP), &at(STEP), 2.0 * STEP));
    }
    jacobian
}

proptest! {
    #![proptest_config(crate::support::properties::cases(40))]

    #[test]
    fn the_jacobian_is_the_derivative_of_forward_kinematics(
        numbers in proptest::collection::vec(-1.0f64..1.0, 97),
        hinged: bool, base in 0usize..4, module in 0usize..4, port in 0usize..4, root in 0usize..4,
    ) {
        let mut numbers = Numbers(numbers.iter().cycle());
        let robot = random_robot(&mut numbers, hinged);
        let kinematics = Kinematics::new(&robot, &[true; 3], root);
        let joints: Vec<f64> = (0..kinematics.joint_count()).map(|_| 0.8 * numbers.next()).collect();
        let X_WB = shifted(numbers.vector()) * turned(numbers.axis(), numbers.next());
        let frame = LinkFrame::of_port(&robot, &kinematics, PortRef { module, port });
        let all = poses(&kinematics, base, &joints, &X_WB);
        let found = geometric_jacobian(&kinematics, &all, &frame, kinematics.link(base, 0)).expect("connected");
        let wanted = by_differences(&kinematics, &frame, base, &joints, &X_WB);
        prop_assert!((&found - &wanted).amax() < 1e-8, "{found}{wanted}");

        // A base that moves carries the frame with it.
        let p = |pose: &Pose| pose.translation.vector;
        let of_base = base_jacobian(&p(&frame.pose(&all)), &p(&X_WB));
        const STEP: f64 = 1e-5;
        for column in 0..6 {
            let at = |by: f64| {
                let moved = match column {
                    0..3 => shifted(Vec3::ith(column, by)) * X_WB,
                    _ => {
                        let turn = turned(Vec3::ith(column - 3, 1.0), by);
                        Pose::from_parts(X_WB.translation, turn.rotation * X_WB.rotation)
                    }
                };
                frame.pose(&poses(&kinematics, base, &joints, &moved))
            };
            let wanted = difference(&at(-STEP), &at(STEP), 2.0 * STEP);
            prop_assert!((of_base.column(column) - wanted).amax() < 1e-8);
        }
    }

    /// A pose that the frame can be at is found again, and it is the pose that counts, not the joints.
    #[test]
    fn poses_that_can_be_reached_are(
        numbers in proptest::collection::vec(-1.0f64..1.0, 97), hinged: bool, port in 0usize..4,
    ) {
        let mut numbers = Numbers(numbers.iter().cycle());
        let robot = random_robot(&mut numbers, hinged);
        let kinematics = Kinematics::new(&robot, &[true; 3], 0);
        let start: Vec<f64> = (0..kinematics.joint_count()).map(|_| 0.8 * numbers.next()).collect();
        let near: Vec<f64> = start.iter().map(|q| q + 0.1 * numbers.next()).collect();
        let frame = LinkFrame::of_port(&robot, &kinematics, PortRef { module: 2, port });
        let X_WB = shifted(numbers.vector());
        let goal = frame.pose(&poses(&kinematics, 0, &near, &X_WB));
        let task = Reach {
            robot: &robot,
            kinematics: &kinematics,
            frame,
            base: (0, X_WB),
            goal,
            task_space: TaskSpace::Pose,
            rest: None,
            tolerance: (1e-9, 1e-9),
        };
        let found = reach(&task, &start, &Settings::default());
        prop_assert_eq!(found.stop, StopReason::Converged);
        let error = goal.inverse() * frame.pose(&poses(&kinematics, 0, &found.joints, &X_WB));
        prop_assert!(error.translation.vector.norm() < 1e-9 && error.rotation.angle() < 1e-7);
    }
}

const UPPER: f64 = 0.5;
const LOWER: f64 = 0.3;

/// An arm of two links in the plane, with its hand at port 0; joints turn about z.
fn arm(elbow: Option<(f64, f64)>) -> (Assembly, Kinematics, LinkFrame) {
    let mut kind = robots::smores();
    kind.links.truncate(3);
    kind.links.iter_mut().for_each(|link| link.pose = Pose::identity());
    kind.joints = vec![
        robots::revolute("shoulder", 0, 1, Vec3::z(), None, 1.0),
        Joint {
            pose: shifted(Vec3::new(UPPER, 0.0, 0.0)),
            ..robots::revolute("elbow", 1, 2, Vec3::z(), elbow, 1.0)
        },
    ];
    kind.ports.truncate(1);
    kind.ports[0].link = 2;
    kind.ports[0].pose = shifted(Vec3::new(UPPER + LOWER, 0.0, 0.0));
    let mut library = (*robots::smores_library()).clone();
    library.modules = vec![kind];
    let mut d = robots::Design::new("Arm", Arc::new(library));
    d.add("arm");
    let kinematics = Kinematics::new(&d.0, &[], 0);
    let hand = LinkFrame::of_port(&d.0, &kinematics, PortRef { module: 0, port: 0 });
    (d.0, kinematics, hand)
}

fn reached(
    arm: &(Assembly, Kinematics, LinkFrame),
    x: f64,
    y: f64,
    start: [f64; 2],
) -> modl::robot::inverse_kinematics::Reached {
    let task = Reach {
        robot: &arm.0,
        kinematics: &arm.1,
        frame: arm.2,
        base: (0, Pose::identity()),
        goal: shifted(Vec3::new(x, y, 0.0)),
        task_space: TaskSpace::Position,
        rest: None,
        tolerance: (1e-10, 1e-10),
    };
    reach(&task, &start, &Settings::default())
}

/// The elbow's angle by the law of cosines, and the shoulder's for it; `side` is its sign.
fn closed_form(x: f64, y: f64, side: f64) -> [f64; 2] {
    let cosine = (x * x + y * y - UPPER * UPPER - LOWER * LOWER) / (2.0 * UPPER * LOWER);
    let elbow = side * libm::acos(cosine);
    let shoulder =
        libm::atan2(y, x) - libm::atan2(LOWER * libm::sin(elbow), UPPER + LOWER * libm::cos(elbow));
    [shoulder, elbow]
}

fn same_angle(a: f64, b: f64) -> bool {
    (a - b + PI).rem_euclid(2.0 * PI) - PI < 1e-8
}

#[test]
fn a_two_link_arm_bends_as_the_law_of_cosines_says() {
    let arm = arm(None);
    for i in 0..24 {
        for radius in [0.25, 0.5, 0.75] {
            let (y, x) = libm::sincos(f64::from(i) * PI / 12.0);
            let (x, y) = (radius * x, radius * y);
            for side in [-1.0, 1.0] {
                let [shoulder, elbow] = closed_form(x, y, side);
                let found = reached(&arm, x, y, [shoulder + 0.3, elbow + 0.2 * side]);
                assert_eq!(found.stop, StopReason::Converged, "{x} {y}: {found:?}");
                let is =
                    |[s, e]: [f64; 2]| same_angle(found.joints[0], s) && (found.joints[1] - e).abs() < 1e-7;
                assert!(is([shoulder, elbow]), "{found:?} is not {shoulder}, {elbow}");
            }
        }
    }
}

#[test]
fn what_is_too_far_is_told_so() {
    let arm = arm(None);
    assert_eq!(reached(&arm, 0.9, 0.0, [0.1, 0.1]).stop, StopReason::OutOfReach);
    // Nearer than the lower arm can fold back to: within the links' reach, but of no posture.
    let found = reached(&arm, 0.1, 0.0, [0.1, 0.5]);
    assert_eq!(found.stop, StopReason::Stalled);
    assert!((found.distance - (UPPER - LOWER - 0.1)).abs() < 0.05, "{found:?}");
    let few = Settings { iterations_max: 1, ..Settings::default() };
    let task = Reach {
        robot: &arm.0,
        kinematics: &arm.1,
        frame: arm.2,
        base: (0, Pose::identity()),
        goal: shifted(Vec3::new(0.0, 0.7, 0.0)),
        task_space: TaskSpace::Position,
        rest: None,
        tolerance: (1e-10, 1e-10),
    };
    assert_eq!(reach(&task, &[0.0, 0.1], &few).stop, StopReason::IterationLimit);
}

#[test]
fn limits_are_kept_and_the_other_solution_is_found_only_within_them() {
    // The elbow bends to one side.
    let arm = arm(Some((0.0, 2.5)));
    for i in 0..24 {
        let (y, x) = libm::sincos(f64::from(i) * PI / 12.0);
        let [shoulder, elbow] = closed_form(0.6 * x, 0.6 * y, 1.0);
        let found = reached(&arm, 0.6 * x, 0.6 * y, [shoulder + 0.4, 0.3]);
        assert_eq!(found.stop, StopReason::Converged, "{found:?}");
        assert!((found.joints[1] - elbow).abs() < 1e-7, "{found:?} is not {shoulder}, {elbow}");
    }
    // And not as far as this asks.
    let [_, elbow] = closed_form(0.25, 0.0, 1.0);
    assert!(elbow > 2.4);
    let stiff = self::arm(Some((0.0, 2.0)));
    let found = reached(&stiff, 0.25, 0.0, [0.1, 1.0]);
    assert_eq!(found.stop, StopReason::Stalled);
    assert!((found.joints[1] - 2.0).abs() < 1e-9, "{found:?}");
    let nearest = (UPPER * UPPER + LOWER * LOWER + 2.0 * UPPER * LOWER * libm::cos(2.0)).sqrt() - 0.25;
    assert!((found.distance - nearest).abs() < 1e-4, "{found:?}, {nearest}");
}

/// Of the ways in which a chain reaches a point, that near to the rest positions is taken.
#[test]
fn joints_that_are_free_go_where_they_rest() {
    let robot = robots::chain(4);
    let kinematics = Kinematics::new(&robot, &vec![true; robot.bonds.len()], 0);
    let frame = LinkFrame::of_link(kinematics.link(3, 0));
    let start = vec![0.1; kinematics.joint_count()];
    let mut target = start.clone();
    (0..4).for_each(|m| target[4 * m + robots::TILT] = 0.5);
    let goal = frame.pose(&poses(&kinematics, 0, &target, &Pose::identity()));
    let off = |rest: Option<&[f64]>| {
        let task = Reach {
            robot: &robot,
            kinematics: &kinematics,
            frame,
            base: (0, Pose::identity()),
            goal,
            task_space: TaskSpace::Position,
            rest,
            tolerance: (1e-9, 1e-9),
        };
        let found = reach(&task, &start, &Settings::default());
        assert_eq!(found.stop, StopReason::Converged);
        found.joints.iter().zip(&target).map(|(q, t)| (q - t) * (q - t)).sum::<f64>().sqrt()
    };
    let (with, without) = (off(Some(&target)), off(None));
    assert!(with < 0.95 * without, "{with} and {without}");
    assert!(FRAC_PI_2 > with);
}
