//! Configurations and gaits of the SMORES tools come in with the geometry and the order that their files state.
//!
//! The files are made here, in the style of published ones. Their places follow from rotation matrices in the frames of the
//! tools: those of the block for `.conf`, a left-handed world with y up for VSPARC.

use super::smores_motions::refused;
use crate::desk::cli::Sandbox;
use crate::support::desk::run_clean;
use crate::support::numbers::Numbers;
use modl::exchange::{ImportFile, Imported, import};
use nalgebra::{Matrix3, Matrix4, Vector3};
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, PI};

/// The rotation about an axis of the frame: 0, 1, 2 for x, y, z.
fn turn(axis: usize, angle: f64) -> Matrix4<f64> {
    let (s, c) = libm::sincos(angle);
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = Matrix4::identity();
    (m[(a, a)], m[(b, b)], m[(b, a)], m[(a, b)]) = (c, c, s, -s);
    m
}

fn along_x(distance: f64) -> Matrix4<f64> {
    Matrix4::new_translation(&Vector3::new(distance, 0.0, 0.0))
}

/// A module of a made-up robot: the face of the one before that it hangs on, its own face, the turn, the joints in the order of
/// the tools.
struct Made {
    on: usize,
    faces: [usize; 2],
    quarter: usize,
    joints: [f64; 4],
    place: Matrix4<f64>,
}

/// A tree of modules. `face`: the frame of a face in that of the module, `flip`: what brings two faces together.
fn tree(
    numbers: &mut Numbers,
    count: usize,
    face: &dyn Fn(usize, &[f64; 4]) -> Matrix4<f64>,
    flip: &dyn Fn(f64) -> Matrix4<f64>,
    range: f64,
) -> Vec<Made> {
    let mut all: Vec<Made> = Vec::new();
    let mut taken = BTreeSet::new();
    for index in 0..count {
        let joints = [
            numbers.between(-PI, PI),
            numbers.between(-PI, PI),
            numbers.between(-PI, PI),
            numbers.between(-range, range),
        ];
        if index == 0 {
            all.push(Made { on: 0, faces: [0, 0], quarter: 0, joints, place: turn(2, 0.4) });
            continue;
        }
        let (on, of) = loop {
            let found = (numbers.below(index), numbers.below(4));
            if taken.insert(found) {
                break found;
            }
        };
        let own = numbers.below(4);
        taken.insert((index, own));
        let quarter = numbers.below(4);
        let mate = face(of, &all[on].joints)
            * flip(quarter as f64 * FRAC_PI_2)
            * face(own, &joints).try_inverse().expect("a displacement");
        let place = all[on].place * mate;
        all.push(Made { on, faces: [of, own], quarter, joints, place });
    }
    all
}

fn quaternion(m: &Matrix4<f64>) -> [f64; 4] {
    let r: Matrix3<f64> = m.fixed_view::<3, 3>(0, 0).into();
    let q = nalgebra::UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(r));
    [q.w, q.i, q.j, q.k]
}

/// A `.conf` file. Every other module states its orientation by roll, pitch and yaw; `angles`: whether turns are stated.
fn conf(made: &[Made], angles: bool) -> String {
    let mut text = "<?xml version=\"1.0\" ?>\n<configuration>\n <modules>\n".to_owned();
    for (index, module) in made.iter().enumerate() {
        let p = module.place.column(3);
        let q = quaternion(&module.place);
        let orientation = if index % 2 == 0 {
            format!("{} {} {} {}", q[0], q[1], q[2], q[3])
        } else {
            let m = &module.place;
            let (roll, pitch) = (libm::atan2(m[(2, 1)], m[(2, 2)]), libm::asin(-m[(2, 0)]));
            format!("{roll} {pitch} {}", libm::atan2(m[(1, 0)], m[(0, 0)]))
        };
        let [a, b, c, d] = module.joints;
        text += &format!(
            "  <module>\n   <name>Module_{index}</name>\n   <position>{} {} {} {orientation}</position>\n   <joints>{a} {b} {c} \
             {d}</joints>\n   <path>SMORE.sdf</path>\n  </module>\n",
            p[0], p[1], p[2]
        );
    }
    text += " </modules>\n <connections>\n";
    for (index, module) in made.iter().enumerate().skip(1) {
        let [on, own] = module.faces;
        let angle = if angles { module.quarter * 90 } else { 0 };
        text += &format!(
            "  <connection><module1>Module_{}</module1><module2>Module_{index}</module2><node1>{on}</node1><node2>{own}</node2>\
             <distance>0.0</distance><angle>{angle}</angle></connection>\n",
            module.on
        );
    }
    text + " </connections>\n</configuration>\n"
}

/// The text that an import of files makes, which must go well.
pub fn imported(files: &[(&str, &str)]) -> Imported {
    let files: Vec<ImportFile> = files.iter().map(|(name, text)| ImportFile { name, text }).collect();
    import(&files, &mut |_| None)
        .unwrap_or_else(|(file, fault)| panic!("{file}: {fault:?}\n{}", files[file].text))
}

/// The poses of an imported robot's modules, as the language tells them: place, x, y.
fn told(robot: &Imported, kind: &str) -> Vec<[Vector3<f64>; 3]> {
    let parts = ["position(pose(m))", "direction(pose(m), X)", "direction(pose(m), Y)"];
    let values: Vec<String> =
        parts.iter().flat_map(|part| ["x", "y", "z"].map(|axis| format!("{part}.{axis}"))).collect();
    let fields: Vec<String> =
        values.iter().zip("abcdefghi".chars()).map(|(value, name)| format!("{name}: {value}")).collect();
    let types: Vec<String> = "abcdefghi"
        .chars()
        .map(|name| format!("{name}: {}", if name < 'd' { "Length" } else { "Number" }))
        .collect();
    let program = format!(
        "{}\nrecord At {{ {} }}\nsave([At({}) for m in modules({}(), {kind})], \"at.json\")\n",
        robot.text,
        types.join(", "),
        fields.join(", "),
        robot.module
    );
    let desk = run_clean(&program);
    let table: serde_json::Value = serde_json::from_str(desk.text("at.json")).expect("JSON");
    let columns: Vec<Vec<f64>> = table["columns"]
        .as_array()
        .expect("columns")
        .iter()
        .map(|column| {
            let values = column["values"].as_array().expect("values");
            values.iter().map(|x| x.as_f64().expect("a number")).collect()
        })
        .collect();
    let at = |first: usize, row: usize| {
        Vector3::new(columns[first][row], columns[first + 1][row], columns[first + 2][row])
    };
    (0..columns[0].len()).map(|row| [at(0, row), at(3, row), at(6, row)]).collect()
}

/// The greatest difference between the poses that the language tells and those of chassis, both seen from the first module.
fn difference(told: &[[Vector3<f64>; 3]], chassis: &[Matrix4<f64>]) -> f64 {
    assert_eq!(told.len(), chassis.len());
    let mut worst = 0.0f64;
    let [origin, x, y] = told[0];
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]).transpose();
    let first = chassis[0].try_inverse().expect("a displacement");
    for (told, chassis) in told.iter().zip(chassis) {
        let wanted = first * chassis;
        let column = |k: usize| Vector3::new(wanted[(0, k)], wanted[(1, k)], wanted[(2, k)]);
        worst = worst.max((axes * (told[0] - origin) - column(3)).amax());
        worst = worst.max((axes * told[1] - column(0)).amax()).max((axes * told[2] - column(1)).amax());
    }
    worst
}

/// The frame of a face in that of the block: x to the left, y to the back, z up; the joints turn about the tools' axes, the
/// right wheel about the left one's.
fn block_face(face: usize, joints: &[f64; 4]) -> Matrix4<f64> {
    let out = along_x(0.05);
    match face {
        0 => turn(2, -FRAC_PI_2) * out * turn(0, joints[0]),
        1 => turn(0, joints[3]) * out * turn(0, joints[1]),
        2 => turn(0, joints[3]) * turn(2, PI) * out * turn(0, -joints[2]),
        _ => turn(0, joints[3]) * turn(2, FRAC_PI_2) * out,
    }
}

#[test]
fn configurations_have_the_places_that_their_files_state() {
    let flip = |angle: f64| turn(2, PI) * turn(0, angle);
    for seed in 1..=12 {
        let mut numbers = Numbers(seed);
        let made = tree(&mut numbers, 1 + seed as usize, &block_face, &flip, FRAC_PI_2);
        let stated = seed % 2 == 0;
        let robot = imported(&[("some robot.conf", &conf(&made, stated))]);
        assert_eq!((robot.what, robot.module.as_str()), ("config", "SomeRobot"));
        let chassis: Vec<Matrix4<f64>> =
            made.iter().map(|m| m.place * turn(0, m.joints[3]) * turn(2, -FRAC_PI_2)).collect();
        let worst = difference(&told(&robot, "Smores"), &chassis);
        assert!(worst < 1e-9, "seed {seed}: {worst:e}\n{}", robot.text);
        let turned = made.iter().skip(1).filter(|m| m.quarter != 0).count();
        let said = robot.notes.iter().any(|note| note.contains("want other turns"));
        assert_eq!(said, !stated && turned > 0, "{:?}", robot.notes);
    }
}

/// The frame of a face in that of a VSPARC part: x to the front, y to the right, z up, in a left-handed world. Joints turn by
/// the matrices of the same names, degrees in the order front, left, right, body.
fn part_face(face: usize, joints: &[f64; 4]) -> Matrix4<f64> {
    let out = along_x(0.5);
    match face {
        0 => turn(1, joints[3]) * out * turn(0, joints[0]),
        1 => turn(1, joints[1]) * turn(2, -FRAC_PI_2) * out,
        2 => turn(1, joints[2]) * turn(2, FRAC_PI_2) * out,
        _ => turn(2, PI) * out,
    }
}

#[test]
fn vsparc_has_the_places_that_its_files_state() {
    let faces = ["FrontWheel", "LeftWheel", "RightWheel", "BackPlate"];
    let flip = |angle: f64| turn(2, PI) * turn(0, angle);
    for seed in 1..=8 {
        let mut numbers = Numbers(100 + seed);
        let range = if seed == 8 { FRAC_PI_2 } else { 1.39 };
        let made = tree(&mut numbers, 1 + seed as usize, &part_face, &flip, range);
        let mut text = "<?xml version=\"1.0\" encoding=\"Windows-1252\"?>\n<RobotStateObject name=\"\">\n<anchorModuleName>S_0\
                        </anchorModuleName><period>0</period><ModuleStates>\n"
            .to_owned();
        // The world has y up: the part lies flat where x is turned by a quarter.
        let world = turn(0, -FRAC_PI_2);
        for (index, module) in made.iter().enumerate() {
            let m = world * module.place;
            let ([w, x, y, z], p) = (quaternion(&m), m.column(3));
            text += &format!(
                "<ModuleState name=\"S_{index}\"><position><x>{}</x><y>{}</y><z>{}</z></position><rotation><x>{x}</x><y>{y}</y>\
                 <z>{z}</z><w>{w}</w></rotation><period>0</period><JointCommands>\n",
                p[0], p[1], p[2]
            );
            for (joint, name) in ["FrontWheel", "LeftWheel", "RightWheel", "Body"].iter().enumerate() {
                text += &format!(
                    "<JointCommand name=\"{name}\"><commandType>Position</commandType><targetValue>{}</targetValue>\
                     <period>0</period><parametricValue>0</parametricValue></JointCommand>\n",
                    module.joints[joint].to_degrees()
                );
            }
            text += "</JointCommands><PartStates/></ModuleState>\n";
        }
        text += "</ModuleStates><Connections>\n";
        for (index, module) in made.iter().enumerate().skip(1) {
            text += &format!(
                "<Connection><moduleName1>S_{}</moduleName1><moduleName2>S_{index}</moduleName2><nodeName1>{}</nodeName1>\
                 <nodeName2>{}</nodeName2><distance>0</distance><angle>0</angle></Connection>\n",
                module.on, faces[module.faces[0]], faces[module.faces[1]]
            );
        }
        text += "</Connections></RobotStateObject>\n";
        let robot = imported(&[("v.xml", &text)]);
        let wide = made.iter().any(|m| m.joints[3].abs() > 80.0f64.to_radians());
        let (kind, pitch) = if wide { ("Smores", 0.1) } else { ("SmoresEP", 0.08) };
        assert!(robot.text.contains(&format!("use std.smores.{kind}\n")), "{}", robot.text);
        // Seen in a mirror, right is left.
        let mirror = Matrix4::from_diagonal(&nalgebra::Vector4::new(1.0, -1.0, 1.0, 1.0));
        let chassis: Vec<Matrix4<f64>> = made
            .iter()
            .map(|module| {
                let mut m = mirror * module.place * mirror;
                (0..3).for_each(|k| m[(k, 3)] *= pitch);
                m
            })
            .collect();
        let worst = difference(&told(&robot, kind), &chassis);
        assert!(worst < 1e-9, "seed {seed}: {worst:e}\n{}", robot.text);
    }
}

/// Three modules in a row, flat on the ground: the first in front.
pub fn row() -> String {
    let place = |k: usize| turn(2, 0.4) * Matrix4::new_translation(&Vector3::new(0.0, 0.1 * k as f64, 0.0));
    let one = |k: usize| Made {
        on: k.saturating_sub(1),
        faces: [3, 0],
        quarter: 0,
        joints: [0.0; 4],
        place: place(k),
    };
    conf(&[one(0), one(1), one(2)], true)
}

#[test]
fn structures_join_configurations_beside_them() {
    let component = |id: &str| {
        format!(
            "<Component><component_id>{id}</component_id><file_path>/robots/parts/row.conf</file_path></Component>"
        )
    };
    let link = |id: usize, ends: [(&str, usize, usize); 2], angle: usize| {
        let [(a, of_a, face_a), (b, of_b, face_b)] = ends;
        format!(
            "\n<Link><link_id>{id}</link_id><component1>{}</component1><component2>{}</component2><module1>Module_{of_a}</module1>\
             <module2>Module_{of_b}</module2><node1>{face_a}</node1><node2>{face_b}</node2><distance>0.0</distance>\
             <angle>{angle}</angle></Link>",
            component(a),
            component(b)
        )
    };
    let structure = |links: &str| {
        let all: String = ["body", "left-leg", "right-leg"].iter().map(|id| component(id)).collect();
        format!("<Structure><Components>{all}</Components><Links>{links}\n</Links></Structure>")
    };
    // A leg hangs on each side of the middle: the left one straight, the right one a quarter turn on.
    let links = link(0, [("body", 1, 1), ("left-leg", 0, 0)], 0)
        + &link(1, [("right-leg", 2, 3), ("body", 1, 2)], 90);
    let sandbox =
        Sandbox::new(&[("s/walker.struct", structure(&links).as_bytes()), ("s/row.conf", row().as_bytes())]);
    let ran = sandbox.run(&["import", "s/walker.struct"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.ends_with("wrote out/walker.mod: config Walker\n"), "{}", ran.err);
    let text = std::fs::read_to_string(sandbox.path("out/walker.mod")).expect("it is written");
    for line in [
        "connect body_module_1.left -- left_leg_module_0.top\n",
        "connect right_leg_module_2.bottom -- body_module_1.right turn 90deg\n",
        "connect left_leg_module_0.bottom -- left_leg_module_1.top\n",
    ] {
        assert!(text.contains(line), "no {line}\n{text}");
    }
    let text = text + "\nlet w = Walker()\nprint(distance(w.left_leg_module_2, w.right_leg_module_0))\n";
    // Three modules out on each side of the middle.
    assert_eq!(run_clean(&text).printed, ["600mm"]);
    let beyond =
        link(0, [("body", 1, 1), ("left-leg", 0, 0)], 0) + &link(1, [("body", 1, 7), ("right-leg", 2, 3)], 0);
    let apart =
        link(0, [("body", 1, 1), ("left-leg", 0, 0)], 0) + &link(1, [("body", 0, 0), ("left-leg", 2, 3)], 0);
    for (links, wanted, line) in [
        (beyond, "`7` is no face of a module", 3),
        (apart, "the top of `body:Module_0` and the bottom of `left-leg:Module_2` are connected, but", 3),
        (link(0, [("body", 1, 1), ("left-leg", 0, 0)], 45), "a turn by 45°", 2),
        (link(0, [("body", 1, 1), ("left-leg", 0, 0)], 0), "nothing connects `right-leg:Module_0` with", 0),
    ] {
        let sandbox =
            Sandbox::new(&[("w.struct", structure(&links).as_bytes()), ("row.conf", row().as_bytes())]);
        refused(&sandbox, &["w.struct"], wanted, line);
    }
    let sandbox = Sandbox::new(&[("w.struct", structure(&links).as_bytes())]);
    refused(&sandbox, &["w.struct"], "there is no file `row.conf` or `parts/row.conf` beside", 1);
}
