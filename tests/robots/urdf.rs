//! The designs as URDF, loaded by an independent kinematics library (pinocchio, from PyPI): the same
//! link poses for random joints. Skipped, with a message, where Python or the library is missing.
#![allow(non_snake_case)]

use crate::support::numbers::Numbers;
use crate::support::robots;
use modl::geometry::Pose;
use modl::robot::mate;
use modl::robot::{Assembly, JointKind, Kinematics, Link, PortRef};
use serde_json::json;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Far above the two libraries' rounding over thirty joints in a row.
const TOL: f64 = 1e-11;

/// A Python that has pinocchio: the one that `MODL_PYTHON` names, or that of the environment that
/// `.ci/run` makes.
pub fn python() -> Option<PathBuf> {
    let local = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/python/bin/python");
    let python = std::env::var_os("MODL_PYTHON").map_or(local, PathBuf::from);
    let found = Command::new(&python).args(["-c", "import pinocchio"]).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success()).then_some(python)
}

/// Runs a script with JSON as its input and its output.
pub fn run(python: &PathBuf, script: &str, input: &serde_json::Value) -> serde_json::Value {
    let mut child = Command::new(python)
        .args(["-c", script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("Python runs, it has before");
    let mut stdin = child.stdin.take().expect("it is piped");
    stdin.write_all(input.to_string().as_bytes()).expect("the script reads all of its input");
    drop(stdin);
    let output = child.wait_with_output().expect("the script ends");
    assert!(output.status.success(), "the script fails");
    serde_json::from_slice(&output.stdout).expect("the script prints JSON")
}

/// A robot as URDF, from its declaration alone. The frame of a URDF link is that of the joint which
/// leads to it, so each link's pose in it is told apart.
pub struct Urdf {
    pub text: String,
    /// `X_UL`: the pose of each link in its URDF frame.
    pub X_UL: Vec<Pose>,
    /// The name of each joint of the assembly.
    pub joints: Vec<String>,
}

impl Urdf {
    pub fn new(robot: &Assembly, kinematics: &Kinematics) -> Urdf {
        let links = kinematics.link_count();
        let text = format!("<robot name=\"{}\">\n", robot.name);
        let joints = vec![String::new(); robot.joints().count()];
        let mut urdf = Urdf { text, X_UL: vec![Pose::identity(); links], joints };
        for &(module, bond) in &kinematics.tree.order {
            let mut entry = 0;
            if let Some(bond) = bond {
                let declared = robot.bonds[bond];
                let forward = declared.b.module == module;
                let (at, to) = if forward { (declared.a, declared.b) } else { (declared.b, declared.a) };
                let X_PQ = if forward { mate(robot, bond) } else { mate(robot, bond).inverse() };
                urdf.add_bond(robot, kinematics, at, to, &X_PQ);
                entry = robot.module_type(module).ports[to.port].link;
            }
            urdf.add_joints(robot, kinematics, module, entry);
        }
        for module in 0..robot.modules.len() {
            for (index, link) in robot.module_type(module).links.iter().enumerate() {
                urdf.link(kinematics.link(module, index), link);
            }
        }
        urdf.text.push_str("</robot>\n");
        urdf
    }

    fn link(&mut self, number: usize, link: &Link) {
        let p = self.X_UL[number].transform_point(&link.com.into());
        let (roll, pitch, yaw) = roll_pitch_yaw(&self.X_UL[number]);
        let [xx, yy, zz, xy, xz, yz] = link.inertia;
        writeln!(
            self.text,
            "  <link name=\"l{number}\"><inertial><origin xyz=\"{} {} {}\" rpy=\"{roll} {pitch} {yaw}\"/>\
             <mass value=\"{}\"/><inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"{xy}\" ixz=\"{xz}\" \
             iyz=\"{yz}\"/></inertial></link>",
            p.x, p.y, p.z, link.mass
        )
        .expect("text grows");
    }

    fn add_bond(&mut self, robot: &Assembly, kinematics: &Kinematics, at: PortRef, to: PortRef, X_PQ: &Pose) {
        let port = |p: PortRef| &robot.module_type(p.module).ports[p.port];
        let (p, q) = (kinematics.link(at.module, port(at).link), kinematics.link(to.module, port(to).link));
        let origin = self.X_UL[p] * port(at).pose * X_PQ * port(to).pose.inverse();
        self.joint(&format!("bond{q}"), "fixed", p, q, &origin, "");
    }

    fn add_joints(&mut self, robot: &Assembly, kinematics: &Kinematics, module: usize, entry: usize) {
        let kind = robot.module_type(module);
        let mut open = vec![entry];
        let mut reached = vec![entry];
        while let Some(from) = open.pop() {
            for (index, joint) in kind.joints.iter().enumerate() {
                let (to, sign) = match (joint.parent == from, joint.child == from) {
                    (true, _) => (joint.child, 1.0),
                    (_, true) => (joint.parent, -1.0),
                    _ => continue,
                };
                if reached.contains(&to) {
                    continue;
                }
                reached.push(to);
                open.push(to);
                assert_eq!(joint.kind, JointKind::Revolute);
                let (p, q) = (kinematics.link(module, from), kinematics.link(module, to));
                let origin = self.X_UL[p] * kind.links[from].pose.inverse() * joint.pose;
                self.X_UL[q] = joint.pose.inverse() * kind.links[to].pose;
                let a = joint.axis * sign;
                let axis = format!("<axis xyz=\"{} {} {}\"/>", a.x, a.y, a.z);
                self.joint(&format!("j{q}"), "revolute", p, q, &origin, &axis);
                self.joints[kinematics.joint(module, index)] = format!("j{q}");
            }
        }
    }

    fn joint(&mut self, name: &str, kind: &str, parent: usize, child: usize, origin: &Pose, axis: &str) {
        let (p, (roll, pitch, yaw)) = (origin.translation.vector, roll_pitch_yaw(origin));
        writeln!(
            self.text,
            "  <joint name=\"{name}\" type=\"{kind}\"><parent link=\"l{parent}\"/><child link=\"l{child}\"/>\
             <origin xyz=\"{} {} {}\" rpy=\"{roll} {pitch} {yaw}\"/>{axis}\
             <limit lower=\"-1000\" upper=\"1000\" effort=\"1\" velocity=\"1\"/></joint>",
            p.x, p.y, p.z
        )
        .expect("text grows");
    }
}

/// The angles of URDF; where the pitch is a right angle the arc sine would lose half of the digits.
fn roll_pitch_yaw(pose: &Pose) -> (f64, f64, f64) {
    let R = *pose.rotation.to_rotation_matrix().matrix();
    let level = libm::hypot(R[(0, 0)], R[(1, 0)]);
    let pitch = libm::atan2(-R[(2, 0)], level);
    if level < 1e-6 {
        return (libm::atan2(-R[(1, 2)], R[(1, 1)]), pitch, 0.0);
    }
    (libm::atan2(R[(2, 1)], R[(2, 2)]), pitch, libm::atan2(R[(1, 0)], R[(0, 0)]))
}

const POSES: &str = r#"
import json, sys, numpy, pinocchio
task = json.load(sys.stdin)
model = pinocchio.buildModelFromXML(task["urdf"])
data = model.createData()
frames = [model.getFrameId("l%d" % i) for i in range(task["links"])]
out = []
for state in task["states"]:
    q = pinocchio.neutral(model)
    for name, value in zip(task["joints"], state):
        q[model.joints[model.getJointId(name)].idx_q] = value
    pinocchio.framesForwardKinematics(model, data, q)
    out.append([data.oMf[f].homogeneous.flatten().tolist() for f in frames])
json.dump(out, sys.stdout)
"#;

#[test]
fn an_independent_library_has_the_same_link_poses() {
    let Some(python) = python() else {
        let why = "no Python with pinocchio (.ci/run installs it)";
        writeln!(std::io::stderr(), "skipped: link poses against another library: {why}")
            .expect("stderr is open");
        return;
    };
    let mut numbers = Numbers(7);
    for robot in [robots::chain(3), robots::walk4(), robots::car(), robots::backhoe(4), robots::ring12()] {
        let kinematics = Kinematics::new(&robot, &vec![true; robot.bonds.len()], robot.base);
        let urdf = Urdf::new(&robot, &kinematics);
        let states: Vec<Vec<f64>> =
            (0..5).map(|_| urdf.joints.iter().map(|_| (numbers.next() - 0.5) * 3.0).collect()).collect();
        let links = kinematics.link_count();
        let task = json!({ "urdf": urdf.text, "links": links, "joints": urdf.joints, "states": states });
        let theirs = run(&python, POSES, &task);
        let root = kinematics.link(robot.base, 0);
        let mut poses = vec![Pose::identity(); links];
        for (state, theirs) in states.iter().zip(theirs.as_array().expect("a list of states")) {
            kinematics.link_poses(state, &Pose::identity(), &mut poses);
            assert_eq!(poses[root], Pose::identity());
            for link in 0..links {
                let ours = (poses[link] * urdf.X_UL[link].inverse()).to_homogeneous();
                for (i, value) in theirs[link].as_array().expect("a matrix").iter().enumerate() {
                    let error = (ours[(i / 4, i % 4)] - value.as_f64().expect("a number")).abs();
                    assert!(error < TOL, "{}: link {link}: {error:e}", robot.name);
                }
            }
        }
    }
}
