//! RoFI's module against the published formulas, and its files: what is read, written, refused.

#![allow(non_snake_case)]

use crate::language::interpret::{Ran, ran};
use crate::support::suite::MapFiles;
use modl::geometry::pose::{shifted, turned};
use modl::geometry::{Pose, Shape};
use modl::interpret::{Mode, Options};
use modl::source::code;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// The frame of a dock's connection: RoFI's F.
fn face(name: &str) -> Pose {
    match name {
        "+X" => turned(Vector3::z(), PI) * turned(Vector3::y(), FRAC_PI_2),
        "-X" => turned(Vector3::z(), PI) * turned(Vector3::y(), -FRAC_PI_2),
        _ => Pose::identity(),
    }
}

/// From shoe to shoe over two docks at a number of quarter turns, in metres with a pitch of 100 mm.
fn docked(a: &str, turn: usize, b: &str) -> Pose {
    let quarter = turned(Vector3::z(), FRAC_PI_2 * turn as f64);
    face(a) * quarter * shifted(Vector3::new(0.0, 0.0, -0.1)) * turned(Vector3::x(), PI) * face(b).inverse()
}

/// From shoe A to shoe B: `Rx(alpha) Rz(gamma) T(0, 0, 1) Ry(180°) Rx(-beta)`.
fn across(alpha: f64, beta: f64, gamma: f64) -> Pose {
    let (alpha, beta, gamma) = (alpha.to_radians(), beta.to_radians(), gamma.to_radians());
    turned(Vector3::x(), alpha)
        * turned(Vector3::z(), gamma)
        * shifted(Vector3::new(0.0, 0.0, 0.1))
        * turned(Vector3::y(), PI)
        * turned(Vector3::x(), -beta)
}

fn loaded(file: &str, program: &str) -> Ran {
    let mut files = MapFiles::of(program);
    files.0.insert("x.rofi".into(), file.as_bytes().to_vec());
    ran(&files, "main.mod", Mode::Run, &Options::default())
}

/// Where the program says that the second module of a file is.
fn second(file: &str) -> [f64; 12] {
    let program = "
use std.rofi.Rofi
let p = pose(modules(load(\"x.rofi\"), Rofi)[1])
let v = [p.position / 1m, direction(p, X), direction(p, Y), direction(p, Z)]
for x in v { print(1e6 * x.x, 1e6 * x.y, 1e6 * x.z) }
";
    let done = loaded(file, program);
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    let numbers = done.host.printed.iter().flat_map(|line| line.split(' '));
    let numbers: Vec<f64> = numbers.map(|n| n.parse::<f64>().expect("a number") * 1e-6).collect();
    numbers.try_into().expect("four vectors")
}

#[test]
fn docks_and_joints_are_where_the_published_formulas_put_them() {
    let (alpha, beta, gamma) = (20.0, -35.0, 50.0);
    for (a, (k, turn), b) in ["+X", "-X", "-Z"].iter().flat_map(|a| {
        let turns = ["N", "E", "S", "W"].into_iter().enumerate();
        turns.flat_map(move |turn| ["+X", "-X", "-Z"].into_iter().map(move |b| (*a, turn, b)))
    }) {
        let file = format!("C\nM 7 {alpha} {beta} {gamma}\nM 9 0 0 0\nE 7 B {a} {turn} {b} A 9\n");
        let X = across(alpha, beta, gamma) * docked(a, k, b);
        let R = X.rotation.to_rotation_matrix();
        let wanted = X.translation.vector.iter().chain(R.matrix().iter()).copied();
        for (found, wanted) in second(&file).iter().zip(wanted) {
            // Six digits are printed.
            assert!((found - wanted).abs() < 2e-6, "{a} {turn} {b}: {found}, not {wanted}");
        }
    }
}

/// Every shoe of the truth's configurations, and every mate of docks, within 1e-9 of a pitch.
#[test]
fn shoes_and_docks_are_where_the_projects_own_library_has_them() {
    let truth: serde_json::Value = serde_json::from_str(include_str!("../truth/rofi.json")).expect("JSON");
    for configuration in truth["configurations"].as_array().expect("a list") {
        let modules = configuration["modules"].as_array().expect("a list");
        let mut file = String::from("C\n");
        for m in modules {
            file += &format!("M {} {} {} {}\n", m["id"], m["alpha"], m["beta"], m["gamma"]);
        }
        for edge in configuration["edges"].as_array().expect("a list") {
            let words: Vec<String> =
                edge.as_array().expect("a list").iter().map(|w| w.to_string().replace('"', "")).collect();
            file += &format!("E {}\n", words.join(" "));
        }
        let shoes = shoes(&file);
        for (m, [a, b]) in modules.iter().zip(&shoes) {
            assert_same(a, &m["A"]);
            assert_same(b, &m["B"]);
        }
    }
    for dock in truth["docks"].as_array().expect("a list") {
        let word = |key: &str| dock[key].as_str().expect("a word");
        let (a, turn, b) = (word("dock1"), word("ori"), word("dock2"));
        let shoes = shoes(&format!("C\nM 0 0 0 0\nM 1 0 0 0\nE 0 A {a} {turn} {b} A 1\n"));
        assert_same(&shoes[1][0], &dock["matrix"]);
    }
}

/// The module that Rust callers get is the one that the library declares.
#[test]
fn the_module_from_rust_is_the_library_s() {
    let done = loaded("", "use std.rofi.Snake\nemit(tosnake(Snake(n: 2)), \"p.plan.json\")\n");
    let text = std::str::from_utf8(&done.host.written["p.plan.json"]).expect("text");
    let plan = modl::plan::file::read(text).expect("a plan");
    let world = modl::robot::rofi::read("C\nM 0 0 0 0\nM 1 0 0 0\nE 0 B -Z N -Z A 1\n").expect("a file");
    let (assembly, start) = modl::robot::rofi_assembly::assembly(&world, 0.1);
    let modl::plan::Body::Tracks(tracks) = &plan.body else { panic!("a plan of joints") };
    assert_eq!(assembly.bonds, tracks.robot.bonds);
    assert_eq!(start, tracks.start);
    let (ours, theirs) = (&assembly.library.modules[0], &plan.library.modules[0]);
    assert_eq!(assembly.library.connectors, plan.library.connectors);
    assert_eq!(
        (&ours.joints, &ours.touching, ours.touch, ours.contact),
        (&theirs.joints, &theirs.touching, theirs.touch, theirs.contact)
    );
    let near = |a: &Pose, b: &Pose| (a.to_homogeneous() - b.to_homogeneous()).amax() < 1e-15;
    assert_eq!((ours.links.len(), ours.ports.len()), (theirs.links.len(), theirs.ports.len()));
    for (a, b) in ours.links.iter().zip(&theirs.links) {
        assert!(near(&a.pose, &b.pose), "{}", a.name);
        let inertia = |i: usize| (a.inertia[i] - b.inertia[i]).abs() < 1e-18;
        assert!((0..6).all(inertia), "{}", a.name);
        assert_eq!(
            (&a.name, &a.collides, a.mass, a.com, a.friction),
            (&b.name, &b.collides, b.mass, b.com, b.friction)
        );
        // The brackets of shoes are drawn through the same points.
        assert_eq!(a.shape.len(), b.shape.len(), "{}", a.name);
        for (ours, theirs) in a.shape.iter().zip(&b.shape) {
            match (&ours.shape, &theirs.shape) {
                (Shape::Hull { points: ours }, Shape::Hull { points: theirs }) => {
                    assert_eq!(ours.len(), theirs.len());
                    assert!(ours.iter().zip(theirs).all(|(p, q)| (p - q).norm() < 1e-15), "{}", a.name);
                }
                (ours, theirs) => assert_eq!(ours, theirs),
            }
        }
    }
    for (a, b) in ours.ports.iter().zip(&theirs.ports) {
        assert_eq!((&a.name, a.link, a.connector), (&b.name, b.link, b.connector));
        assert!(near(&a.pose, &b.pose), "{}", a.name);
    }
}

/// Both shoes of every module of a file against shoe A of the first, in pitches.
fn shoes(file: &str) -> Vec<[Pose; 2]> {
    let world = modl::robot::rofi::read(file).expect("it is a file");
    // The library's module, in a robot of which the bonds and joints are put in the place of those.
    let text =
        format!("use std.rofi.Snake\nemit(tosnake(Snake(n: {})), \"p.plan.json\")\n", world.modules.len());
    let done = loaded("", &text);
    let text = std::str::from_utf8(&done.host.written["p.plan.json"]).expect("text");
    let plan = modl::plan::file::read(text).expect("a plan");
    let modl::plan::Body::Tracks(tracks) = &plan.body else { panic!("a plan of joints") };
    let mut robot = tracks.robot.clone();
    let kind = robot.module_type(0).clone();
    let port = |dock: &modl::robot::rofi::Dock| modl::robot::PortRef {
        module: dock.module,
        port: kind.ports.iter().position(|port| port.name == dock.port()).expect("a dock is a port"),
    };
    robot.bonds = world
        .edges
        .iter()
        .map(|edge| modl::robot::Bond { a: port(&edge.a), b: port(&edge.b), turn: edge.turn })
        .collect();
    let kinematics = modl::robot::Kinematics::new(&robot, &vec![true; robot.bonds.len()], 0);
    let mut joints = vec![0.0; 3 * world.modules.len()];
    for (index, module) in world.modules.iter().enumerate() {
        for (name, degrees) in ["alpha", "beta", "gamma"].iter().zip(module.joints) {
            let joint = kind.joints.iter().position(|joint| joint.name == **name).expect("a joint");
            joints[kinematics.joint(index, joint)] = degrees.to_radians();
        }
    }
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&joints, &Pose::identity(), &mut poses);
    let shoe = |module: usize, name: &str| {
        let link = kind.links.iter().position(|link| link.name == name).expect("a shoe");
        let mut pose = poses[kinematics.link(0, 0)].inverse() * poses[kinematics.link(module, link)];
        pose.translation.vector /= 0.1;
        pose
    };
    (0..robot.modules.len()).map(|m| [shoe(m, "shoe_a"), shoe(m, "shoe_b")]).collect()
}

fn assert_same(pose: &Pose, truth: &serde_json::Value) {
    let found = pose.to_homogeneous();
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let wanted = truth[i][j].as_f64().expect("a number");
        assert!((found[(i, j)] - wanted).abs() < 1e-9, "{found} is not {truth}");
    }
}

#[test]
fn the_newer_format_has_other_names_for_the_same_docks() {
    let program = "
use std.rofi.Rofi
save(load(\"x.rofi\"), \"y.json\")
";
    let file = "C\nM 0 12.5 -90 0\nM 1 0 90 180\nE 0 B +X W -Z A 1\n";
    let done = loaded(file, program);
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    let json = String::from_utf8(done.host.written["y.json"].clone()).expect("text");
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(value["moduleJoints"][0]["from"]["connector"], "B-X");
    assert_eq!(value["moduleJoints"][0]["to"]["connector"], "A-Z");
    assert_eq!(value["moduleJoints"][0]["orientation"], "West");
    assert_eq!(value["modules"][0]["alpha"], 12.5);
    // By name or by number, it reads back to the same.
    for json in [json.clone(), format!("[{json}]"), json.replace("\"B-X\"", "3").replace("West", "W")] {
        let mut files = MapFiles::of("use std.rofi.Rofi\nsave(load(\"y.json\"), \"again.rofi\")\n");
        files.0.insert("y.json".into(), json.into_bytes());
        let done = ran(&files, "main.mod", Mode::Run, &Options::default());
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        assert_eq!(String::from_utf8(done.host.written["again.rofi"].clone()).expect("text"), file);
    }
}

#[test]
fn what_is_wrong_in_the_newer_format_is_told_with_its_place() {
    let one = |modules: &str, joints: &str| {
        format!("{{\n  \"modules\": [\n    {modules}\n  ],\n  \"moduleJoints\": [{joints}]\n}}")
    };
    let module = |id: u32| format!("{{\"id\": {id}, \"type\": \"universal\"}}");
    let two = format!("{}, {}", module(0), module(1));
    let joint = |connector: &str, id: u32, orientation: &str| {
        format!(
            "{{\"from\": {{\"id\": 0, \"connector\": {connector}}}, \"to\": {{\"id\": {id}, \"connector\": \"A-Z\"}}, \
             \"orientation\": \"{orientation}\"}}"
        )
    };
    for (text, place) in [
        ("{\n  \"modules\": [\n".to_owned(), "line 3, column 1: EOF"),
        ("{\n  \"moduleJoints\": []\n}".to_owned(), "missing field `modules`"),
        ("[]".to_owned(), "line 1, column 1: 0 configurations"),
        (one("{\"id\": 0}", ""), "line 3, column 13: missing field `type`"),
        (one("{\"id\": -1, \"type\": \"universal\"}", ""), "line 3, column 13: invalid value"),
        (one("{\"id\": 0, \"type\": \"pad\"}", ""), "line 3, column 5: a module of type `pad`"),
        (one(&format!("{}, {}", module(4), module(4)), ""), "line 3, column 37: a second module 4"),
        (one(&two, &joint("\"B-Z\"", 7, "North")), "line 5, column 20: there is no module 7"),
        (one(&two, &joint("\"C-Z\"", 1, "North")), "line 5, column 20: no such connector"),
        (one(&two, &joint("6", 1, "North")), "line 5, column 20: no such connector"),
        (one(&two, &joint("\"B-Z\"", 1, "Up")), "line 5, column 20: `Up` is no orientation"),
    ] {
        let mut files = MapFiles::of("use std.rofi.Rofi\nprint(count(load(\"y.json\")))\n");
        files.0.insert("y.json".into(), text.clone().into_bytes());
        let done = ran(&files, "main.mod", Mode::Run, &Options::default());
        let [diagnostic] = &done.outcome.diagnostics[..] else { panic!("{:?}", done.outcome.diagnostics) };
        assert_eq!(diagnostic.code, code::CANNOT_READ);
        assert!(diagnostic.message.contains(place), "{text}\n{}", diagnostic.message);
    }
}

#[test]
fn a_tangle_is_the_same_again_for_the_same_seed() {
    let save = |seed: u32| {
        let program = format!(
            "use std.rofi.{{Rofi, tangle}}\nlet t = tangle(9, 150, seed: {seed})\nsave(t, \"t.rofi\")\n\
             let free = world(ground: off, gravity: off)\nprint(verify(t, world: free).ok)\n"
        );
        let done = ran(&MapFiles::of(&program), "main.mod", Mode::Run, &Options::default());
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        assert_eq!(done.host.printed, ["true"]);
        String::from_utf8(done.host.written["t.rofi"].clone()).expect("text")
    };
    assert_eq!(save(1), save(1));
    assert_ne!(save(1), save(2));
    assert!(save(1).lines().any(|line| line.contains("90")), "{}", save(1));
}

/// The shapes of the paper. The fingerprints were taken from the project's own files by another program:
/// the first half of the SHA-256 of what [`code_of`] writes.
const SHAPES: [(&str, &str); 25] = [
    ("Chair", "199c508a6a66d906"),
    ("Snake(n: 8)", "b822bc5522651e2b"),
    ("Spider", "54b7332f5dd63f32"),
    ("Spider(gap: true)", "fef9cc41e1534ff1"),
    ("Spider(gap: true, straight: true)", "b88849a224fdb035"),
    ("Crab", "44e4c979d5c0b137"),
    ("Crab(folded: true)", "21c9339055cfabbb"),
    ("Ball", "b6fceb11cb6fb44c"),
    ("Board", "fb36e227c0a1ed58"),
    ("Caterpillar", "411f57f676e18174"),
    ("Chain", "2e207a8de862e35d"),
    ("HighChair", "b05df6952ea7c6f4"),
    ("Circle", "25be0dd611d6b8e7"),
    ("Column", "6be3a8c520a82aaa"),
    ("DoubleWheel", "094fc294b5c0a122"),
    ("Dumbbell", "5b8194bd93064c77"),
    ("Eight", "3da4b2a501958052"),
    ("Fan", "9b2b212dd35f364f"),
    ("Human", "ad5241a3730f8e6b"),
    ("Infant", "2fe64bd0dc1a7656"),
    ("Puppy", "e7220c1ed5d52139"),
    ("Rectangle", "c3a8c5eef1e7f7d7"),
    ("RoundRectangle", "fd7d4ba363391e0c"),
    ("Snake(n: 10)", "f9ca8b0d8eaf363b"),
    ("Stool", "fad4635b57008732"),
];

#[test]
fn the_shapes_of_the_library_are_those_of_the_paper() {
    let names = "Rofi, Snake, Chair, HighChair, Spider, Crab, Ball, Board, Caterpillar, Chain, Circle, Column, \
                 DoubleWheel, Dumbbell, Eight, Fan, Human, Infant, Puppy, Rectangle, RoundRectangle, Stool";
    let saves: Vec<String> =
        SHAPES.iter().enumerate().map(|(i, (shape, _))| format!("save({shape}, \"{i}.rofi\")\n")).collect();
    let program = format!("use std.rofi.{{{names}}}\n{}", saves.concat());
    let done = ran(&MapFiles::of(&program), "main.mod", Mode::Run, &Options::default());
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    let mut wrong = Vec::new();
    for (i, (shape, fingerprint)) in SHAPES.iter().enumerate() {
        let text = std::str::from_utf8(&done.host.written[&format!("{i}.rofi")]).expect("text");
        let found = modl::plan::file::digest(&code_of(text));
        if !found.contains(fingerprint) {
            wrong.push(format!("{shape}: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A configuration whatever its modules are called: for each module as the first, the others in the
/// order in which they are reached dock by dock, with their joints (thousandths of a degree) and what is
/// at their docks; of all these texts the least.
fn code_of(file: &str) -> String {
    let world = modl::robot::rofi::read(file).expect("it was written to be read");
    let ports = ["a_plus_x", "a_minus_x", "a_minus_z", "b_plus_x", "b_minus_x", "b_minus_z"];
    let port = |dock: &modl::robot::rofi::Dock| ports.iter().position(|p| *p == dock.port()).expect("known");
    let mut at = vec![[None; 6]; world.modules.len()];
    for edge in &world.edges {
        at[edge.a.module][port(&edge.a)] = Some((edge.b.module, port(&edge.b), edge.turn));
        at[edge.b.module][port(&edge.b)] = Some((edge.a.module, port(&edge.a), edge.turn));
    }
    let code = |first: usize| {
        let mut order = vec![first];
        let mut lines: Vec<String> = Vec::new();
        let mut next = 0;
        while next < order.len() {
            let module = order[next];
            let [alpha, beta, gamma] = world.modules[module].joints.map(|q| (q * 1000.0).round() as i64);
            lines.push(format!("M {alpha} {beta} {gamma}"));
            for held in at[module] {
                lines.push(held.map_or("-".into(), |(other, port, turn)| {
                    let known = order.iter().position(|m| *m == other);
                    let number = known.unwrap_or_else(|| {
                        order.push(other);
                        order.len() - 1
                    });
                    format!("{number} {port} {turn}")
                }));
            }
            next += 1;
        }
        lines.join(";")
    };
    (0..world.modules.len()).map(code).min().expect("there are modules")
}

#[test]
fn what_is_saved_reads_back_to_the_same() {
    let program = "
use std.rofi.{Rofi, Ring}
save(load(\"x.rofi\"), \"again.rofi\")
save(Ring(6), \"ring.rofi\")
";
    let file =
        "C\n# a comment\n\nM 0 12.5 -90 0\nM 1 0 90 180\nM 2 0 0 -90\nE 0 B -Z N -Z A 1\nE 1 B +X W -X A 2\n";
    let done = loaded(file, program);
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    let text = |name: &str| String::from_utf8(done.host.written[name].clone()).expect("text");
    assert_eq!(text("again.rofi"), file.replace("# a comment\n\n", ""));
    assert!(text("ring.rofi").starts_with("C\nM 0 30 30 0\nM 1 -30 -30 0\n"), "{}", text("ring.rofi"));
    assert_eq!(text("ring.rofi").matches('E').count(), 6);
}

#[test]
fn what_is_wrong_in_a_file_is_told_with_its_place() {
    let program = "use std.rofi.Rofi\nprint(count(load(\"x.rofi\")))\n";
    for (file, place) in [
        ("", "line 1, column 1: there are no modules"),
        ("M 0 0 0 0\n", "line 1, column 1: a file begins"),
        ("C\nM 0 0 0\n", "line 2, column 8: a joint's position is missing"),
        ("C\nM 0 0 zero 0\n", "line 2, column 7: `zero` is no number"),
        ("C\nM 0 nan 0 0\n", "line 2, column 5: `nan` is no number"),
        ("C\nM 0 0 0 0\nM 0 0 0 0\n", "line 3, column 3: a second module 0"),
        ("C\nM 0 0 0 0\nE 0 A -Z N -Z A 1\n", "line 3, column 17: no module 1"),
        ("C\nM 0 0 0 0\nM 1 0 0 0\nE 0 C -Z N -Z A 1\n", "line 4, column 5: `C` is not a side"),
        ("C\nM 0 0 0 0\nM 1 0 0 0\nE 0 A -Z X -Z A 1\n", "line 4, column 10: `X` is not an orientation"),
        (
            "C\nM 0 0 0 0\nM 1 0 0 0\nE 0 A -Z N -Z A 1\nE 0 A -Z S -Z B 1\n",
            "line 5, column 3: this dock was",
        ),
        ("C\nM 0 95 0 0\n", "line 2, column 1: alpha can't be at 95deg"),
        ("C\nM 0 0 0 0\nM 1 0 0 0\n", "line 3, column 1: module 1 does not hang together"),
        ("C\nQ 1\n", "line 2, column 1: `Q` is none"),
        ("C\nM 0 0 0 0\nC\n", "line 3, column 1: a second configuration"),
    ] {
        let done = loaded(file, program);
        let [diagnostic] = &done.outcome.diagnostics[..] else { panic!("{:?}", done.outcome.diagnostics) };
        assert_eq!(diagnostic.code, code::CANNOT_READ);
        assert!(diagnostic.message.contains(place), "{}", diagnostic.message);
    }
    // The library's module is there where `load` is called, imported or not.
    let done = loaded("C\nM 0 0 0 0\n", "print(count(load(\"x.rofi\")))\n");
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    let done = loaded("C\nM 0 0 0 0\n", "let read = load\nprint(count(read(\"x.rofi\")))\n");
    assert_eq!(done.outcome.diagnostics[0].code, code::UNKNOWN_IMPORT);
    let done = loaded("", "use std.smores.Smores\nsave(Smores(), \"s.rofi\")\n");
    assert_eq!(done.outcome.diagnostics[0].code, code::BAD_VALUE);
}
