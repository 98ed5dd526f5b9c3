//! Forward kinematics against the published transforms and the library's poses in
//! `truth/smores.json`, which were computed by other people's code, and against identities.

#![allow(non_snake_case)]

use crate::support::robots;
use modl::geometry::pose::turned;
use modl::geometry::{Pose, Vec3};
use modl::robot::{Assembly, Bond, Hinge, JointKind, Kinematics, Library, Limits, ModuleInstance, PortRef};
use nalgebra::{Isometry3, Matrix4, Quaternion, Translation3, UnitQuaternion};
use proptest::prelude::*;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};
use std::sync::Arc;

/// The truths are given to nine digits.
const TOL: f64 = 1e-9;

fn truth() -> Value {
    serde_json::from_str(include_str!("../truth/smores.json")).expect("the truth is JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn matrix(value: &Value) -> Matrix4<f64> {
    let rows = value.as_array().expect("four rows");
    Matrix4::from_row_iterator(rows.iter().flat_map(numbers))
}

fn port_index(face: &str) -> usize {
    ["L", "R", "T", "B"].iter().position(|f| *f == face).expect("one of the four faces")
}

fn poses(robot: &Assembly, joints: &[f64]) -> (Kinematics, Vec<Pose>) {
    let kinematics = Kinematics::new(robot, &vec![true; robot.bonds.len()], 0);
    let mut out = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(joints, &Pose::identity(), &mut out);
    (kinematics, out)
}

fn pair(parent_face: &str, child_face: &str, turn: u32) -> Assembly {
    let mut d = robots::Design::new("Pair", robots::smores_library());
    let (a, b) = (d.add("a"), d.add("b"));
    d.connect((a, port_index(parent_face)), (b, port_index(child_face)), turn);
    d.0
}

/// The truth's frames of old sit on the T block and list (T, L, R, tilt); the right wheel's angle is
/// opposite.
fn from_legacy(joints: &[f64]) -> [f64; 4] {
    [joints[1], -joints[2], joints[0], joints[3]]
}

#[track_caller]
fn close(found: &Matrix4<f64>, expected: &Matrix4<f64>, what: &str) {
    let error = (found - expected).abs().max();
    assert!(error < TOL, "{what}: off by {error:e}\n{found}{expected}");
}

#[test]
fn faces_are_where_the_published_tool_has_them() {
    let robot = robots::chain(1);
    let data = truth();
    let cases = data["module_face_transforms"]["cases"].as_array().expect("cases");
    for case in cases {
        let [l, r, t, tilt] = <[f64; 4]>::try_from(numbers(&case["state"])).expect("four joints");
        let (kinematics, out) = poses(&robot, &[l, r, t, tilt]);
        let face = case["face"].as_str().expect("a face");
        let port = PortRef { module: 0, port: port_index(face) };
        let found = kinematics.port_pose(&robot, port, &out).to_homogeneous();
        close(&found, &matrix(&case["K_recommended"]), face);
    }
    assert_eq!(cases.len(), 28);
}

/// The pose of module b's T block in module a's, in the frames of the published tool.
fn legacy_pair(robot: &Assembly, parent: &[f64; 4], child: &[f64; 4]) -> Matrix4<f64> {
    let (_, out) = poses(robot, &[*parent, *child].concat());
    let chassis_in_legacy = |tilt: f64| turned(Vec3::x(), tilt) * turned(Vec3::z(), -FRAC_PI_2);
    let [X_LA, X_LB] = [parent, child].map(|joints| chassis_in_legacy(joints[robots::TILT]));
    (X_LA * out[5] * X_LB.inverse()).to_homogeneous()
}

#[test]
fn pairs_of_modules_are_where_the_published_tool_has_them() {
    let data = truth();
    let cases = data["pair_transforms"]["cases"].as_array().expect("cases");
    for case in cases {
        let face = |key: &str| case[key].as_str().expect("a face").to_owned();
        let joints = |key: &str| from_legacy(&numbers(&case[key]));
        let robot = pair(&face("parent_face"), &face("child_face"), 0);
        let found = legacy_pair(&robot, &joints("parent_joints"), &joints("child_joints"));
        close(&found, &matrix(&case["child_in_parent_legacy"]), &case.to_string());
    }
    assert_eq!(cases.len(), 48);
}

/// Its defect is not copied: with the child's turntable turned we have the consistent value.
#[test]
fn a_turned_turntable_of_the_child_turns_the_right_way() {
    let data = truth();
    for case in data["reference_defects"]["cases"].as_array().expect("cases") {
        let face = |key: &str| case[key].as_str().expect("a face").to_owned();
        let joints = |key: &str| from_legacy(&numbers(&case[key]));
        let robot = pair(&face("parent_face"), &face("child_face"), 0);
        let found = legacy_pair(&robot, &joints("parent_joints"), &joints("child_joints"));
        close(&found, &matrix(&case["consistent_value"]), &case.to_string());
        let child_turned = numbers(&case["child_joints"]).iter().any(|q| *q != 0.0);
        let differs = (found - matrix(&case["reference_value"])).abs().max() > 0.1;
        assert_eq!(child_turned, differs, "only the child's side of the published tool is wrong");
    }
}

/// A design of the truth, its first listed module being the root.
fn design(spec: &Value) -> Assembly {
    let mut d = robots::Design::new("Truth", robots::smores_library());
    let first = spec["poses"][0]["chassis_pose_in_first_module"].as_object().expect("poses");
    first.keys().for_each(|name| {
        d.add(name);
    });
    for c in spec["connections"].as_array().expect("connections") {
        let end = |module: &str, face: &str| {
            (d.index(c[module].as_str().expect("a name")), port_index(c[face].as_str().expect("a face")))
        };
        let (a, b) = (end("a", "face_a"), end("b", "face_b"));
        d.connect(a, b, (c["roll_deg"].as_f64().expect("degrees") / 90.0) as u32);
    }
    d.0
}

fn state(robot: &Assembly, degrees: &Value) -> Vec<f64> {
    let mut joints = vec![0.0; robot.joints().count()];
    for (module, angles) in degrees.as_object().expect("angles by module") {
        let m = robot.modules.iter().position(|x| x.name == *module).expect("a module of the design");
        for (joint, angle) in angles.as_object().expect("angles by joint") {
            let j = ["L", "R", "T_pan", "B_tilt"].iter().position(|x| x == joint).expect("a joint");
            joints[4 * m + j] = angle.as_f64().expect("degrees").to_radians();
        }
    }
    joints
}

/// The modules are listed in another order than ours where a design's object is sorted, so poses are
/// compared relative to the module that the truth has at the origin.
#[test]
fn the_designs_stand_as_the_truth_has_them() {
    let data = truth();
    let designs = data["proposed_designs"]["designs"].as_object().expect("designs");
    let mut compared = 0;
    for (name, spec) in designs {
        let robot = design(spec);
        for pose in spec["poses"].as_array().expect("poses") {
            let (_, out) = poses(&robot, &state(&robot, &pose["state_deg"]));
            let expected = pose["chassis_pose_in_first_module"].as_object().expect("poses");
            let listed: Vec<Isometry3<f64>> =
                robot.modules.iter().map(|m| listed_pose(&expected[&m.name])).collect();
            for m in 0..robot.modules.len() {
                let found = (out[0].inverse() * out[5 * m]).to_homogeneous();
                let want = (listed[0].inverse() * listed[m]).to_homogeneous();
                // The truth's positions have six digits, its quaternions nine.
                let error = (found - want).abs().max();
                assert!(error < 2e-6, "{name} {} {}: {error:e}", pose["pose"], robot.modules[m].name);
                compared += 1;
            }
        }
    }
    assert!(compared > 300, "only {compared} module poses compared");
}

fn listed_pose(value: &Value) -> Isometry3<f64> {
    let (p, q) = (numbers(&value["position"]), numbers(&value["quat_wxyz"]));
    let q = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
    Isometry3::from_parts(Translation3::new(p[0], p[1], p[2]), q)
}

#[test]
fn our_designs_are_those_of_the_truth() {
    let data = truth();
    let designs = &data["proposed_designs"]["designs"];
    for (name, ours) in
        [("WALK4", robots::walk4()), ("CAR", robots::car()), ("BACKHOE11", robots::backhoe(4))]
    {
        let theirs = design(&designs[name]);
        let (_, a) = poses(&ours, &vec![0.0; ours.joints().count()]);
        let (_, b) = poses(&theirs, &vec![0.0; theirs.joints().count()]);
        let at = |robot: &Assembly, m: &str| robot.modules.iter().position(|x| x.name == m).expect("there");
        for module in &ours.modules {
            let base = &ours.modules[0].name;
            let x = a[0].inverse() * a[5 * at(&ours, &module.name)];
            let y = b[5 * at(&theirs, base)].inverse() * b[5 * at(&theirs, &module.name)];
            close(&x.to_homogeneous(), &y.to_homogeneous(), &module.name);
        }
    }
}

#[test]
fn a_ring_of_twelve_closes_at_thirty_degrees() {
    let robot = robots::ring12_closed();
    let mut joints = vec![0.0; robot.joints().count()];
    (0..12).for_each(|m| joints[4 * m + robots::TILT] = FRAC_PI_6);
    let (kinematics, out) = poses(&robot, &joints);
    // Breadth first from r0 the ring is cut opposite, not at the bond that was added last.
    let residuals = kinematics.residuals(&robot, &joints, &out);
    assert_eq!(residuals.len(), 1);
    assert!(residuals[0].distance < 1e-14 && residuals[0].angle < 1e-7, "{residuals:?}");
    joints[robots::TILT] += 0.1;
    kinematics.link_poses(&joints, &Pose::identity(), &mut vec![Pose::identity(); 60]);
    let (kinematics, out) = poses(&robot, &joints);
    let open = kinematics.residuals(&robot, &joints, &out)[0];
    assert!((open.angle - 0.1).abs() < 1e-9, "a tilt of 0.1 more opens the ring by 0.1: {open:?}");
}

#[test]
fn the_centre_of_mass_of_a_module_is_just_ahead_of_the_axle() {
    let robot = robots::chain(1);
    let (kinematics, out) = poses(&robot, &[0.0; 4]);
    let (com, mass) = kinematics.centre_of_mass(&robot, &out);
    assert!((com.x - 0.001144).abs() < 1e-4 && com.y.abs() < 1e-15, "{com:?}");
    assert!((mass - 0.5572924).abs() < 1e-6);
}

#[test]
fn what_is_not_connected_is_named() {
    let robot = robots::chain(4);
    let kinematics = Kinematics::new(&robot, &[true, false, true], 0);
    assert_eq!(kinematics.tree.loose, [2, 3]);
    assert_eq!(kinematics.path(kinematics.link(0, 0), kinematics.link(3, 0)), None);
    let path = kinematics.path(kinematics.link(0, robots::LEFT_WHEEL), kinematics.link(1, robots::CHASSIS));
    assert_eq!(path, Some(vec![3, 0, 7, 6, 5]), "wheel, chassis, then disc, block and chassis of the next");
}

/// A module of one joint off its axis, one that mimics it, and a slide, none along an axis.
fn oblique() -> Assembly {
    let joint = |name: &str, parent, child, kind, at: Vec3, axis: Vec3| {
        let pose = modl::geometry::pose::shifted(at) * turned(Vec3::new(0.3, -1.0, 0.4), 0.7);
        robots::joint(name, (parent, child), kind, pose, axis.normalize(), Limits::default())
    };
    let mut kind = robots::smores();
    kind.links.iter_mut().enumerate().for_each(|(i, link)| {
        link.pose = modl::geometry::pose::shifted(Vec3::new(0.01, 0.02, 0.03) * i as f64)
            * turned(Vec3::new(1.0, 2.0, -1.0), 0.4 * i as f64);
    });
    let mut follower =
        joint("b", 1, 2, JointKind::Revolute, Vec3::new(0.1, 0.0, 0.05), Vec3::new(1.0, 1.0, 0.0));
    follower.mimic = Some(vec![(0, -2.0)]);
    kind.joints = vec![
        joint("a", 0, 1, JointKind::Revolute, Vec3::new(0.05, 0.02, -0.01), Vec3::new(0.2, 0.5, 1.0)),
        follower,
        joint("c", 2, 3, JointKind::Prismatic, Vec3::new(0.0, 0.1, 0.0), Vec3::new(0.0, 0.6, 0.8)),
        joint("d", 0, 4, JointKind::Fixed, Vec3::zeros(), Vec3::x()),
    ];
    let mut library = (*robots::smores_library()).clone();
    library.modules = vec![kind];
    let mut d = robots::Design::new("Oblique", Arc::new(library));
    d.row(&["a".into(), "b".into()], robots::L, robots::T);
    d.0
}

/// The declaration of a joint, read literally: the child moves by `X_MJ · Rot · X_MJ⁻¹` as drawn.
#[test]
fn joints_move_links_as_their_declaration_says() {
    let robot = oblique();
    let (kinematics, out) = poses(&robot, &[0.3, 9.0, 0.02, 9.0, -0.5, 9.0, 0.04, 9.0]);
    let kind = robot.module_type(0);
    let move_by = |j: usize, q: f64| {
        let joint = &kind.joints[j];
        let moved = match joint.kind {
            JointKind::Prismatic => modl::geometry::pose::shifted(joint.axis * q),
            _ => turned(joint.axis, q),
        };
        joint.pose * moved * joint.pose.inverse()
    };
    let X_ML = |l: usize| kind.links[l].pose;
    let carried = move_by(0, 0.3) * move_by(1, -0.6);
    let expected = [
        X_ML(0),
        move_by(0, 0.3) * X_ML(1),
        carried * X_ML(2),
        carried * move_by(2, 0.02) * X_ML(3),
        X_ML(4),
    ];
    for (link, want) in expected.iter().enumerate() {
        let found = out[0].inverse() * out[kinematics.link(0, link)];
        close(&found.to_homogeneous(), &(X_ML(0).inverse() * want).to_homogeneous(), &format!("link {link}"));
    }
}

/// Two plates whose joint lives in the bond.
fn hinged(swap: bool) -> Assembly {
    let mut library = (*robots::smores_library()).clone();
    library.connectors[0].hinge = Some(Hinge {
        axis: Vec3::new(0.6, 0.0, 0.8),
        limits: Limits { range: Some((-3.0, 3.0)), ..Limits::default() },
    });
    let modules = ["a", "b"].map(|name| ModuleInstance { name: name.into(), kind: 0 }).to_vec();
    let library: Arc<Library> = Arc::new(library);
    let (p, q) = (PortRef { module: 0, port: robots::L }, PortRef { module: 1, port: robots::T });
    let (a, b) = if swap { (q, p) } else { (p, q) };
    let bonds = vec![Bond { a, b, turn: 1 }];
    Assembly { name: "Hinged".into(), library, modules, bonds, base: 0, closed: false, misalignments: vec![] }
}

#[test]
fn a_hinge_in_the_bond_turns_its_first_port() {
    for swap in [false, true] {
        let robot = hinged(swap);
        let joints = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
        let (kinematics, out) = poses(&robot, &joints);
        let bond = robot.bonds[0];
        let [X_WP, X_WQ] = [bond.a, bond.b].map(|port| kinematics.port_pose(&robot, port, &out));
        let want = turned(Vec3::new(0.6, 0.0, 0.8), 0.9)
            * turned(Vec3::z(), std::f64::consts::PI)
            * turned(Vec3::x(), FRAC_PI_2);
        close(&(X_WP.inverse() * X_WQ).to_homogeneous(), &want.to_homogeneous(), "hinge");
    }
}

#[test]
fn sine_and_cosine_are_right_to_a_unit_or_two_in_the_last_place() {
    let angles =
        (0..200_000).map(|i| f64::from(i) * 1.234_567e-4 - 12.0).chain([0.0, 1e4, -99_999.9, 1e9, 1e-300]);
    for angle in angles {
        let (s, c) = modl::geometry::sin_cos(angle);
        let (s0, c0) = libm::sincos(angle);
        assert!((s - s0).abs() <= 4.5e-16 * s0.abs() + 1e-22, "sin {angle}: {s} is not {s0}");
        assert!((c - c0).abs() <= 4.5e-16 * c0.abs() + 1e-22, "cos {angle}: {c} is not {c0}");
    }
    let (s, c) = modl::geometry::sin_cos(f64::NAN);
    assert!(s.is_nan() && c.is_nan());
}

#[test]
fn sines_of_many_angles_are_those_of_each_to_the_bit() {
    let some = (0..10_001).map(|i| f64::from(i) * 4.321e-3 - 20.0);
    let angles: Vec<f64> = some.chain([0.0, -0.0, 1e5, 1e9, -1e300, f64::INFINITY, f64::NAN]).collect();
    let (mut sines, mut cosines) = (angles.clone(), angles.clone());
    modl::geometry::sin_cos_of_all(&angles, &mut sines, &mut cosines);
    for ((angle, s), c) in angles.iter().zip(sines).zip(cosines) {
        let one = modl::geometry::sin_cos(*angle);
        assert!(
            [(s, one.0), (c, one.1)].iter().all(|(many, one)| many.to_bits() == one.to_bits()),
            "{angle}"
        );
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(256))]

    /// `K · K⁻¹`: parent and child may swap roles, whatever the joints and whichever the root.
    #[test]
    fn swapped_roles_are_the_inverse(
        joints in prop::collection::vec(-1.5..1.5f64, 8),
        faces in (0..4usize, 0..4usize),
        turn in 0..4u32,
    ) {
        let names = ["L", "R", "T", "B"];
        let ours = pair(names[faces.0], names[faces.1], turn);
        let swapped = pair(names[faces.1], names[faces.0], turn);
        let (_, a) = poses(&ours, &joints);
        let (_, b) = poses(&swapped, &[&joints[4..], &joints[..4]].concat());
        let error = ((a[5] * b[5]).to_homogeneous() - Matrix4::identity()).abs().max();
        prop_assert!(error < 1e-14, "off by {error:e}");
        // The same from the other end of the tree.
        let kinematics = Kinematics::new(&ours, &[true], 1);
        let mut c = vec![Pose::identity(); 10];
        kinematics.link_poses_from(0, &joints, &Pose::identity(), &mut c);
        for (x, y) in a.iter().zip(&c) {
            prop_assert!((x.to_homogeneous() - y.to_homogeneous()).abs().max() < 1e-14);
        }
    }

    /// Any root gives the same relative poses; the path between two links is one through neighbours.
    #[test]
    fn the_root_does_not_matter(seed in prop::collection::vec(-1.5..1.5f64, 60), root in 0..15usize) {
        let robot = robots::walk4();
        let (_, a) = poses(&robot, &seed);
        let kinematics = Kinematics::new(&robot, &[true; 14], root);
        let mut b = vec![Pose::identity(); 75];
        kinematics.link_poses_from(0, &seed, &Pose::identity(), &mut b);
        for (x, y) in a.iter().zip(&b) {
            prop_assert!((x.to_homogeneous() - y.to_homogeneous()).abs().max() < 1e-13);
        }
        let path = kinematics.path(0, 74).expect("connected");
        for pair in path.windows(2) {
            let joined = |a: usize, b: usize| kinematics.step(a).is_some_and(|s| s.parent == b);
            prop_assert!(joined(pair[0], pair[1]) || joined(pair[1], pair[0]));
        }
    }
}
