//! Robot descriptions become modules: written out again, they have the kinematics of the original by Pinocchio.

use crate::desk::cli::{Sandbox, json};
use crate::support::properties::whole;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// An arm in the style of industrial ones: turned joint frames, axes of all directions, cylinders and boxes that are placed,
/// a flange without shape or mass.
const ARM: &str = r#"<?xml version="1.0"?>
<robot name="six-axis arm">
  <link name="base_link">
    <inertial><origin xyz="0 0 0.05"/><mass value="4"/><inertia ixx="0.02" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.05"/><geometry><cylinder radius="0.08" length="0.1"/></geometry></collision>
  </link>
  <joint name="shoulder_pan" type="revolute">
    <parent link="base_link"/><child link="Shoulder"/><origin xyz="0 0 0.12" rpy="0 0 0.7"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" effort="150" velocity="2.5"/>
  </joint>
  <link name="Shoulder">
    <inertial><origin xyz="0.01 -0.02 0.03" rpy="0.3 0.2 0.1"/><mass value="3.1"/><inertia ixx="0.011" iyy="0.012" izz="0.009" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0.02 0.01" rpy="1.57079632679 0 0.4"/><geometry><box size="0.1 0.12 0.09"/></geometry></collision>
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="lift" type="revolute">
    <parent link="Shoulder"/><child link="upper-arm"/><origin xyz="0 0.13 0.01" rpy="-1.5707963267948966 0.2 0"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-2" upper="1" effort="150" velocity="2.5"/><dynamics damping="0.5"/>
  </joint>
  <link name="upper-arm">
    <inertial><origin xyz="0 0 0.2"/><mass value="2"/><inertia ixx="0.03" iyy="0.03" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.04" length="0.4"/></geometry></collision>
  </link>
  <joint name="tool0-fixed" type="fixed"><parent link="upper-arm"/><child link="flange"/><origin xyz="0 0.01 0.41" rpy="0 1.57 0"/></joint>
  <link name="flange"/>
  <joint name="roll" type="continuous">
    <parent link="flange"/><child link="hand"/><origin xyz="0.02 0 0.05" rpy="0.1 0.2 0.3"/><axis xyz="1 0 0"/>
    <limit effort="0" velocity="0"/>
  </joint>
  <link name="hand">
    <inertial><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.06 0.08 0.02"/></geometry></visual>
  </link>
</robot>"#;

/// A gripper: joints that slide, of which one follows the other the other way round, and a mesh in a package.
const GRIPPER: &str = r#"<robot name="gripper">
  <link name="palm"><inertial><mass value="0.4"/><inertia ixx="0.0004" iyy="0.0004" izz="0.0004" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><mesh filename="package://gripper_description/meshes/palm.stl" scale="0.001 0.001 0.001"/></geometry></collision>
    <collision><geometry><mesh filename="package://gripper_description/meshes/cover.dae"/></geometry></collision></link>
  <joint name="left" type="prismatic"><parent link="palm"/><child link="left finger"/><origin xyz="0.02 0 0.05"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/></joint>
  <link name="left finger"><inertial><mass value="0.05"/><inertia ixx="0.00001" iyy="0.00001" izz="0.00001" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.01 0.01 0.05"/></geometry></collision></link>
  <joint name="right" type="prismatic"><parent link="palm"/><child link="right finger"/><origin xyz="0.02 -0.03 0.05"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/><mimic joint="left" multiplier="0.5"/></joint>
  <link name="right finger"><inertial><mass value="0.05"/><inertia ixx="0.00001" iyy="0.00001" izz="0.00001" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.01 0.01 0.05"/></geometry></collision></link>
</robot>"#;

/// A leg of a walker: the tree forks, and names are those of the language.
const LEG: &str = r#"<robot name="2 legs">
  <link name="link"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0.001" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.3 0.2 0.1"/></geometry></collision></link>
  <joint name="for" type="revolute"><parent link="link"/><child link="m"/><origin xyz="0.1 0.14 0" rpy="0 0 1.5707963267948966"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="3"/></joint>
  <link name="m"><inertial><mass value="0.6"/><origin xyz="0 0 -0.1"/><inertia ixx="0.002" iyy="0.002" izz="0.0005" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.1"/><geometry><cylinder radius="0.02" length="0.2"/></geometry></collision></link>
  <joint name="for_" type="revolute"><parent link="link"/><child link="M"/><origin xyz="0.1 -0.14 0"/><axis xyz="0 -1 0"/><limit lower="-1" upper="1" effort="9" velocity="3"/></joint>
  <link name="M"><inertial><mass value="0.6"/><origin xyz="0 0 -0.1"/><inertia ixx="0.002" iyy="0.002" izz="0.0005" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.1"/><geometry><cylinder radius="0.02" length="0.2"/></geometry></collision></link>
</robot>"#;

/// A tetrahedron as ASCII STL, in millimetres.
const PALM: &str = "solid palm
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 50 0\nvertex 50 0 0\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 50 0 0\nvertex 0 0 50\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 50\nvertex 0 50 0\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 50 0 0\nvertex 0 50 0\nvertex 0 0 50\nendloop\nendfacet
endsolid palm\n";

/// Places every link of two descriptions at the same random positions of joints; links and joints of the second go by the
/// order of the first, since names are those of the language there.
const COMPARE: &str = r#"
import sys, numpy, pinocchio
first, second = (pinocchio.buildModelFromUrdf(path) for path in sys.argv[1:])
names = lambda m: [f.name for f in m.frames if f.type == pinocchio.FrameType.BODY and f.name != "universe"]
plain = lambda name: "".join(c for c in name.lower() if c.isalnum())
def key(name):
    own = plain(name.split(".", 1)[-1])
    return {"linklink": "link", "linkm": "m", "m": "m", "linkm2": "m2"}.get(own, own)
ours = {key(name): name for name in names(second)}
theirs = {}
for name in names(first):
    k = plain(name)
    theirs[k + "2" if k in theirs else k] = name
assert set(ours) == set(theirs), (sorted(ours), sorted(theirs))
d1, d2 = first.createData(), second.createData()
rng = numpy.random.default_rng(5)
carried = lambda m, j: key(next(f.name for f in m.frames if f.type == pinocchio.FrameType.BODY and f.parentJoint == j))
worst = 0.0
for _ in range(20):
    q1, q2 = pinocchio.neutral(first), pinocchio.neutral(second)
    assert first.njoints == second.njoints
    by = {}
    for model, q in ((first, q1), (second, q2)):
        order = list(range(1, model.njoints))
        for j in order:
            link = next(f.name for f in model.frames if f.type == pinocchio.FrameType.BODY and f.parentJoint == j)
            k = key(link) if model is second else next(k for k, n in theirs.items() if n == link)
            value = by.setdefault(k, rng.uniform(-1, 1))
            joint = model.joints[j]
            turn = [numpy.cos(value), numpy.sin(value)] if joint.nq == 2 else [value]
            q[joint.idx_q : joint.idx_q + joint.nq] = turn
    pinocchio.framesForwardKinematics(first, d1, q1)
    pinocchio.framesForwardKinematics(second, d2, q2)
    for k in theirs:
        a = d1.oMf[first.getFrameId(theirs[k], pinocchio.FrameType.BODY)].homogeneous
        b = d2.oMf[second.getFrameId(ours[k], pinocchio.FrameType.BODY)].homogeneous
        worst = max(worst, abs(a[:3, :3] - b[:3, :3]).max())
    c1 = pinocchio.centerOfMass(first, d1, q1)
    c2 = pinocchio.centerOfMass(second, d2, q2)
    worst = max(worst, abs(c1 - c2).max())
print(worst)
"#;

fn python() -> Option<PathBuf> {
    let local = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target/python/bin/python");
    let python = std::env::var_os("MODL_PYTHON").map_or(local, PathBuf::from);
    let found = Command::new(&python).args(["-c", "import pinocchio"]).stderr(Stdio::null()).status();
    found.is_ok_and(|status| status.success()).then_some(python)
}

#[test]
fn descriptions_come_in_and_leave_with_the_same_kinematics() {
    let cases = [("arm", ARM, "SixAxisArm"), ("gripper", GRIPPER, "Gripper"), ("leg", LEG, "Robot2Legs")];
    let python = python();
    for (file, text, module) in cases {
        let name = format!("gripper_description/urdf/{file}.urdf");
        let mesh = ("gripper_description/meshes/palm.stl", PALM.as_bytes());
        let program = format!("use \"{file}.mod\".{{{module}}}\nsave({module}(), \"again.urdf\")\n");
        let main = ("main.mod", program.as_bytes());
        let sandbox = Sandbox::new(&[(&name, text.as_bytes()), mesh, main]);
        let ran = sandbox.run(&["import", &name, "-o", "."]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains(&format!("module {module}")), "{}", ran.err);
        let written = sandbox.path(&format!("{file}.mod"));
        let source = std::fs::read_to_string(&written).expect("it is written");
        let ran = sandbox.run(&["run", "main.mod"]);
        assert!(ran.code == 0 && ran.err.ends_with("wrote out/again.urdf\n"), "{}\n{source}", ran.err);
        let Some(python) = &python else {
            writeln!(std::io::stderr(), "skipped: imported robots: no Python with pinocchio")
                .expect("stderr is open");
            continue;
        };
        let worst = apart(python, &sandbox.path(&name), &sandbox.path("out/again.urdf"));
        assert!(worst.as_ref().is_ok_and(|worst| *worst < 1e-9), "{file}: {worst:?}\n{source}");
    }
}

/// The greatest distance of a link or the centre of mass in two descriptions, m; the error where Python has one.
fn apart(python: &Path, first: &Path, second: &Path) -> Result<f64, String> {
    let output = Command::new(python).args(["-c", COMPARE]).arg(first).arg(second).output();
    let output = output.expect("Python runs, it has before");
    let said = String::from_utf8_lossy(&output.stdout);
    said.trim().parse().map_err(|_| format!("{said}{}", String::from_utf8_lossy(&output.stderr)))
}

/// Robots that people have published, in the wheel `example-robot-data`.
#[test]
fn published_descriptions_come_in_and_leave_with_the_same_kinematics() {
    if !whole() {
        return;
    }
    let found = python().map(|python| {
        let below = "import sysconfig; print(sysconfig.get_path('purelib'))";
        let said = Command::new(&python).args(["-c", below]).output().expect("Python runs").stdout;
        let packages = PathBuf::from(String::from_utf8_lossy(&said).trim());
        (python, packages.join("cmeel.prefix/share/example-robot-data/robots"))
    });
    let Some((python, robots)) = found.filter(|(_, robots)| robots.is_dir()) else {
        writeln!(
            std::io::stderr(),
            "skipped: published robots: no example-robot-data (.ci/full installs it)"
        )
        .expect("stderr is open");
        return;
    };
    let mut open = vec![robots];
    let mut files = vec![];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path())
        {
            if entry.is_dir() {
                open.push(entry);
            } else if entry.extension().is_some_and(|ending| ending == "urdf") {
                files.push(entry);
            }
        }
    }
    files.sort();
    let mut refused = vec![];
    for file in &files {
        let name = file.display();
        let sandbox = Sandbox::new(&[]);
        let ran = sandbox.run(&["import", &file.to_string_lossy(), "-o", "."]);
        if ran.code != 0 {
            assert!(ran.err.contains("E0707"), "{name}: {}", ran.err);
            refused.push(ran.err);
            continue;
        }
        let written =
            std::fs::read_dir(sandbox.path(".")).expect("a folder").map(|entry| entry.expect("an entry"));
        let mut written = written.filter_map(|entry| entry.file_name().into_string().ok());
        let module_file = written.find(|name| name.ends_with(".mod")).expect("it is written");
        let text = std::fs::read_to_string(sandbox.path(&module_file)).expect("it can be read");
        let module = text.lines().find_map(|line| line.strip_prefix("module ")).expect("a module");
        let module = module.split(' ').next().expect("a name");
        let program = format!("use \"{module_file}\".{{{module}}}\nsave({module}(), \"again.urdf\")\n");
        std::fs::write(sandbox.path("main.mod"), program).expect("the sandbox can be written");
        let ran = sandbox.run(&["run", "main.mod"]);
        assert_eq!(ran.code, 0, "{name}: {}", ran.err);
        let worst = apart(&python, file, &sandbox.path("out/again.urdf"));
        assert!(worst.as_ref().is_ok_and(|worst| *worst < 1e-9), "{name}: {worst:?}");
    }
    // One is made of macros, and in one a finger follows a joint that is not there.
    assert!(files.len() >= 60 && refused.len() <= 2, "{} of {}: {refused:#?}", refused.len(), files.len());
}

/// Descriptions as people write them: a fixed joint with an axis of zeros, a link that is turned where it stands, masses
/// that no body within the robot can have, limits beyond all numbers.
#[test]
fn descriptions_with_careless_numbers_make_sound_modules() {
    let inertial = |mass: f64, at: &str, moments: [f64; 3]| {
        let [x, y, z] = moments;
        format!(
            "<inertial><origin xyz=\"{at}\"/><mass value=\"{mass}\"/>\
             <inertia ixx=\"{x}\" iyy=\"{y}\" izz=\"{z}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
        )
    };
    let ball = "<collision><geometry><sphere radius=\"0.05\"/></geometry></collision>";
    let links = [
        ("base", inertial(1.0, "0 0 0", [0.001, 0.001, 0.01]), ball),
        ("flat", inertial(1.0, "0 0 0", [1e-4, 1e-4, 0.0]), ball),
        ("heavy", inertial(1e-6, "0 0 0", [1.0, 1.0, 1.0]), ball),
        ("bare", inertial(1.0, "0 0 0.9", [1e-3, 1e-3, 1e-3]), ""),
        ("far", inertial(1.0, "0 2 0", [1e-3, 1e-3, 1e-3]), ball),
    ];
    let joints = [
        ("a", "fixed", "base", "flat", "<axis xyz=\"0 0 0\"/><origin xyz=\"0 0 0\" rpy=\"0 0 1.5\"/>"),
        (
            "b",
            "revolute",
            "flat",
            "heavy",
            "<limit lower=\"-1e16\" upper=\"1e16\" effort=\"1e12\" velocity=\"1e12\"/>",
        ),
        ("c", "continuous", "heavy", "bare", "<axis xyz=\"0 1 0\"/>"),
        (
            "d",
            "prismatic",
            "bare",
            "far",
            "<axis xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"0.1\" effort=\"1\" velocity=\"1\"/>",
        ),
    ];
    let mut text = String::from("<robot name=\"careless\">\n");
    for (name, mass, shape) in &links {
        text.push_str(&format!("<link name=\"{name}\">{mass}{shape}</link>\n"));
    }
    for (name, kind, parent, child, facts) in &joints {
        text.push_str(&format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{facts}</joint>\n"
        ));
    }
    text.push_str("</robot>\n");
    let main = "use \"careless.mod\".{Careless}\nsave(Careless(), \"again.urdf\")\n";
    let sandbox = Sandbox::new(&[("careless.urdf", text.as_bytes()), ("main.mod", main.as_bytes())]);
    let ran = sandbox.run(&["import", "careless.urdf", "-o", "."]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for note in [
        "the moments of inertia of `base` are made more: no body has them",
        "the moments of inertia of `heavy` are made less",
        "a point at the centre of mass of `far` is a part of it: 1.9",
    ] {
        assert!(ran.err.contains(note), "{note}: {}", ran.err);
    }
    let source = std::fs::read_to_string(sandbox.path("careless.mod")).expect("it is written");
    let joint =
        source.lines().find(|line| line.contains("joint b : flat -> heavy = revolute(")).expect("it turns");
    assert!(!joint.contains("range") && !joint.contains("max"), "{source}");
    let ran = sandbox.run(&["run", "main.mod"]);
    assert_eq!(ran.code, 0, "{}\n{source}", ran.err);
    if let Some(python) = python() {
        let worst = apart(&python, &sandbox.path("careless.urdf"), &sandbox.path("out/again.urdf"));
        assert!(worst.as_ref().is_ok_and(|worst| *worst < 1e-9), "{worst:?}\n{source}");
    }
}

/// Shapes beside the origins of links none of which states a mass.
#[test]
fn descriptions_without_masses_are_modules_of_a_kilogram() {
    let ball =
        "<collision><origin xyz=\"0.1 0 0\"/><geometry><sphere radius=\"0.05\"/></geometry></collision>";
    let text = format!("<robot name=\"light\"><link name=\"a\">{ball}</link></robot>");
    let main = "use \"light.mod\".{Light}\nprint(mass(Light()))\n";
    let sandbox = Sandbox::new(&[("light.urdf", text.as_bytes()), ("main.mod", main.as_bytes())]);
    let ran = sandbox.run(&["import", "light.urdf", "-o", "."]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = sandbox.run(&["run", "main.mod"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "1kg\n"), "{}", ran.err);
}

#[test]
fn what_is_left_out_is_told() {
    let name = "gripper_description/urdf/gripper.urdf";
    let mesh = ("gripper_description/meshes/palm.stl", PALM.as_bytes());
    let sandbox = Sandbox::new(&[(name, GRIPPER.as_bytes()), mesh]);
    let ran = sandbox.run(&["import", name]);
    assert!(
        ran.err.contains("cover.dae` of `palm` is left out: `.dae` is none of STL, OBJ, OFF, PLY, FOLD"),
        "{}",
        ran.err
    );
    let text = std::fs::read_to_string(sandbox.path("out/gripper.mod")).expect("it is written");
    assert!(text.contains("hull([[0m, 0m, 0m], ") && text.contains("joint right = 0.5 * left"), "{text}");
    assert!(text.contains("// port front : Face on palm"), "{text}");
}

#[test]
fn descriptions_that_modules_can_not_be_are_refused_where_they_say_so() {
    let robot =
        |inside: &str| format!("<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\n{inside}</robot>");
    let ends = "<parent link=\"a\"/><child link=\"b\"/>";
    let cases = [
        ("<robot".to_owned(), "it is no XML"),
        ("<sdf/>".to_owned(), "`<robot>` is wanted"),
        ("<robot name=\"r\"/>".to_owned(), "the robot has no links"),
        (
            "<robot xmlns:xacro=\"http://wiki.ros.org/xacro\"><xacro:macro name=\"m\"/></robot>".to_owned(),
            "the robot has no links: it is made of macros, which `xacro` expands",
        ),
        (robot(""), "the links are not one tree: nothing carries a, b"),
        (
            robot(&format!("<joint name=\"j\" type=\"floating\">{ends}</joint>")),
            "is `floating`, and modl has joints of one axis",
        ),
        (
            robot("<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/></joint>"),
            "`c`, is no link of the robot",
        ),
        (
            robot(&format!("<joint name=\"j\" type=\"revolute\">{ends}<origin xyz=\"0 0 nan\"/></joint>")),
            "3 finite numbers are wanted",
        ),
        (
            robot(&format!("<joint name=\"j\" type=\"revolute\">{ends}<axis xyz=\"0 0 0\"/></joint>")),
            "has no length",
        ),
        (
            robot(&format!("<joint name=\"j\" type=\"fixed\">{ends}<mimic joint=\"k\"/></joint>")),
            "which is no joint",
        ),
        (
            robot(&format!("<joint name=\"j\" type=\"revolute\">{ends}<mimic joint=\"j\"/></joint>")),
            "the joint `j` follows itself",
        ),
    ];
    for (text, wanted) in cases {
        let sandbox = Sandbox::new(&[("r.urdf", text.as_bytes())]);
        let ran = sandbox.run(&["import", "r.urdf", "--json"]);
        assert_eq!(ran.code, 1, "{text}");
        let said = &json(&ran)["diagnostics"][0];
        assert_eq!(said["code"], "E0707");
        assert!(said["message"].as_str().is_some_and(|m| m.contains(wanted)), "{said}\nin\n{text}");
        assert!(!sandbox.path("out").exists());
    }
}
