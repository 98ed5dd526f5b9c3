//! Plans that make exports stumble: odd names, links without mass, a thousand modules, meshes under odd paths.

use super::{exported, planned, text};
use modl::exchange::{Export, PLAN_FORMATS, PlanFormat};
use modl::plan::{Body, Obstacle, Plan};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A plan whose modules have other names.
fn renamed(plan: &Plan, name: impl Fn(usize) -> String) -> Plan {
    let mut plan = plan.clone();
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    for (index, module) in tracks.robot.modules.iter_mut().enumerate() {
        module.name = name(index);
    }
    plan
}

fn chain() -> Plan {
    planned(
        "use std.smores.Chain3\nlet c = Chain3()\nlet p = plan(move(c.m[1].tilt, to: 10deg), world: world(ground: off))",
    )
}

/// Every value of an attribute in XML, as a reader gives it.
fn values(xml: &str, attribute: &str) -> Vec<String> {
    let key = format!(" {attribute}=\"");
    let starts = xml.split(&key).skip(1);
    let plain = |value: &str| {
        let ends = [("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")];
        ends.iter().fold(value.to_owned(), |text, (from, to)| text.replace(from, to))
    };
    starts.map(|rest| plain(rest.split('"').next().expect("a value ends"))).collect()
}

#[test]
fn odd_names_are_the_same_in_all_files() {
    let names = ["a\tb: c", "a_b: c", "- \"x\" & <y> #1, 'z'\n"];
    let plan = renamed(&chain(), |index| names[index].to_owned());
    let files = exported(&plan, "urdf");
    let urdf = text(&files, "plan.urdf");
    let all = values(urdf, "name");
    let distinct: BTreeSet<&String> = all.iter().collect();
    assert_eq!(distinct.len(), all.len(), "every name stands once: {all:?}");
    assert!(all.iter().all(|name| !name.contains(char::is_control)));
    let parents = values(urdf, "link");
    assert!(parents.iter().all(|link| all.contains(link)), "what is referred to is there");
    let json = exported(&plan, "trajectory-json");
    let file: serde_json::Value = serde_json::from_slice(&json[0].bytes).expect("it is JSON");
    let joints = file["joint_names"].as_array().expect("a list");
    assert!(!joints.is_empty());
    for joint in joints {
        let name = joint.as_str().expect("a text").to_owned();
        assert!(all.contains(&name), "{name:?} is in the description");
    }
    let yaml = exported(&plan, "trajectory");
    let listed = text(&yaml, "plan.trajectory.yaml").lines().filter_map(|line| line.strip_prefix("- \""));
    assert_eq!(listed.count(), joints.len());
}

#[test]
fn links_without_mass_have_some() {
    let mut plan = chain();
    let mut library = (*plan.library).clone();
    for link in library.modules.iter_mut().flat_map(|module| &mut module.links[1..]) {
        (link.mass, link.inertia) = (0.0, [0.0; 6]);
    }
    plan.library = Arc::new(library);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.robot.library = plan.library.clone();
    let files = exported(&plan, "urdf");
    let masses = values(text(&files, "plan.urdf"), "value");
    assert!(
        masses.len() == 15 && masses.iter().all(|m| m.parse::<f64>().is_ok_and(|m| m > 0.0)),
        "{masses:?}"
    );
    let moments = values(text(&files, "plan.urdf"), "ixx");
    assert!(moments.iter().all(|m| m.parse::<f64>().is_ok_and(|m| m > 0.0)));
}

/// The number of meshes of a plan's scene in glTF.
fn meshes(plan: &Plan) -> usize {
    let bytes = &exported(plan, "glb")[0].bytes;
    let long = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let scene: serde_json::Value = serde_json::from_slice(&bytes[20..20 + long]).expect("it is JSON");
    scene["meshes"].as_array().map_or(0, Vec::len)
}

/// A file may state an obstacle without shapes: no mesh stands for it, since a mesh has corners.
#[test]
fn obstacles_without_shapes_have_no_mesh() {
    let mut plan = chain();
    let before = meshes(&plan);
    assert!(before > 0);
    let Body::Tracks(tracks) = &mut plan.body else { unreachable!("the robot has joints") };
    tracks.obstacles = Arc::new([Obstacle { name: "none".to_owned(), shapes: Vec::new() }]);
    assert_eq!(meshes(&plan), before);
}

#[test]
fn a_thousand_modules_are_written() {
    let plan = planned(
        "use std.rofi.Snake\nlet c = Snake(n: 1000)\n\
         let p = plan(move(c.m[999].beta, to: 1deg), world: world(ground: off, dynamics: statics))",
    );
    for format in ["urdf", "trajectory", "csv", "glb", "mcap"] {
        let files = exported(&plan, format);
        assert!(!files.is_empty(), "{format}");
    }
    let files = exported(&plan, "urdf");
    let kinds = &plan.library.modules;
    let tracks = plan.body.tracks().expect("it has joints");
    let links: usize = tracks.robot.modules.iter().map(|module| kinds[module.kind].links.len()).sum();
    assert_eq!(text(&files, "plan.urdf").matches("<link name=").count(), links);
    assert_eq!(text(&files, "plan.urdf").matches("<joint name=").count(), links - 1);
}

#[test]
fn meshes_lie_where_descriptions_say() {
    let plan = planned(
        "use std.mori.Mori\nuse std.shapes.octahedron\nlet p = fold(octahedron(edge: 80mm), module: Mori)",
    );
    let urdf = PlanFormat::named("urdf").expect("it is a format");
    let export = Export::new(&plan, "octa", "my plan: 100% ü");
    let files = urdf.write(&export).expect("it has links and no loop");
    let named: BTreeSet<String> =
        values(text(&files, "my plan: 100% ü.urdf"), "filename").into_iter().collect();
    let there: BTreeSet<String> =
        files.iter().map(|file| file.name.clone()).filter(|name| name.ends_with(".stl")).collect();
    assert!(!named.is_empty());
    assert_eq!(named, there);
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    assert!(named.iter().all(|name| name.chars().all(plain)), "{named:?}");
    for file in files.iter().filter(|file| file.name.ends_with(".stl")) {
        let count = u32::from_le_bytes(file.bytes[80..84].try_into().expect("four bytes")) as usize;
        assert!(count >= 4 && file.bytes.len() == 84 + 50 * count && !file.bytes.starts_with(b"solid"));
    }
}

#[test]
fn what_has_no_meaning_is_refused_by_its_reason() {
    let said = |plan: &Plan, format: &str| {
        let format = PlanFormat::named(format).expect("it is a format");
        format.write(&Export::new(plan, "t", "t")).map(|_| ()).map_err(|refusal| refusal.to_string())
    };
    let lattice = planned(
        "use std.crystal.ExpandingCube\nlattice A of ExpandingCube = row(4)\nlattice B of ExpandingCube = column(4)\n\
         let p = squeeze(A, B)",
    );
    for format in PLAN_FORMATS.iter().filter(|format| !["glb", "gif", "frames"].contains(&format.name)) {
        let said = said(&lattice, format.name).expect_err("a lattice has no joints");
        assert!(said.contains("which lattices and trusses have not"), "{said}");
    }
    assert_eq!(said(&lattice, "glb"), Ok(()));
    let ring = planned(
        "use std.smores.Ring12\nlet r = Ring12()\nlet p = plan(Sc(wait(1s), undock(r.m[11].bottom)), world: world(ground: off, gravity: off))",
    );
    let said = said(&ring, "urdf").expect_err("a ring is a loop");
    assert!(
        said.starts_with("URDF has no closed loops, and the bond m[") && said.contains(" closes one at 0 s")
    );
}
