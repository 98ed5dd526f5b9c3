//! Files of other programs, taken in; where there is a writer, written and taken in again.

use super::programs::ran;
use crate::fuzz::inputs::dice::Dice;
use crate::fuzz::inputs::files::parted;
use crate::fuzz::inputs::json::Altered;
use crate::fuzz::inputs::meshes::{self, Mesh};
use crate::fuzz::inputs::plans::ARTICULATED;
use crate::fuzz::inputs::project::Project;
use crate::fuzz::inputs::{crease, descriptions, drawings, rofi as rofi_inputs, smores};
use modl::exchange::mapping::{self, RobotMap};
use modl::exchange::{ImportFile, import};
use modl::formats::{
    CLOUD_FORMATS, CREASE_FORMATS, Content, CreaseSheet, FOLDING_FORMATS, Format, MESH_FORMATS, triangles,
};
use modl::interpret::Mode;
use modl::plan::{Plan, file};
use modl::robot::rofi::{self, World};
use modl::robot::{rofi_assembly, rofi_json};
use modl::source::{Diagnostic, FileId, code};
use serde_json::json;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Returns a file of a mesh.
pub fn mesh_file(dice: &mut Dice) -> Vec<u8> {
    meshes::file(dice)
}

/// Returns the ending of an input's file, and its bytes.
fn ended(input: &[u8]) -> (&str, &[u8]) {
    let at = input.iter().position(|b| *b == b'\n').unwrap_or(input.len());
    (std::str::from_utf8(&input[..at]).unwrap_or(""), input.get(at + 1..).unwrap_or(&[]))
}

/// Reads a mesh and a cloud. A mesh that is read is written in text, and read the same.
pub fn meshes(input: &[u8]) {
    let (ending, bytes) = ended(input);
    let of = |formats: &'static [Format]| formats.iter().find(|format| format.ending == ending);
    if let Some(format) = of(CLOUD_FORMATS) {
        drop(format.read_cloud(bytes));
    }
    let Some(Ok(content)) = of(MESH_FORMATS).map(|format| format.read_mesh(bytes)) else { return };
    assert!(!triangles(&content.faces).is_empty(), "a mesh has triangles");
    let Content { vertices, faces } = content;
    let mesh = Mesh { vertices, faces };
    for (ending, text) in
        [("off", meshes::off(&mesh)), ("ply", meshes::ply(&mesh)), ("obj", meshes::obj(&mesh))]
    {
        let format = MESH_FORMATS.iter().find(|format| format.ending == ending).expect("it is read");
        // A list of PLY here counts at most 255 corners.
        if mesh.faces.iter().any(|face| face.len() > 255) {
            continue;
        }
        let again = match format.read_mesh(text.as_bytes()) {
            Ok(again) => again,
            Err(fault) => panic!("{ending}: {fault}\n{text}"),
        };
        assert!(
            placed(&again.vertices, &again.faces) == placed(&mesh.vertices, &mesh.faces),
            "{ending}: another mesh:\n{text}"
        );
    }
}

/// Returns the places of the corners of faces: a reader may leave out vertices of which no face has a corner.
fn placed(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Vec<Vec<[f64; 3]>> {
    faces.iter().map(|face| face.iter().map(|corner| vertices[*corner]).collect()).collect()
}

/// Returns a drawing of a crease pattern.
pub fn drawing(dice: &mut Dice) -> Vec<u8> {
    drawings::file(dice)
}

/// Reads a drawing of a crease pattern. Its faces have corners that it has, and creases lie between two of them; of a grid
/// there is a face for each cell, and all are as large.
pub fn drawn(input: &[u8]) {
    let (cells, bytes) = ended(input);
    let format = CREASE_FORMATS.iter().find(|format| format.ending == "svg").expect("it is read");
    let read = (format.read)(bytes);
    let Ok(cells) = cells.parse::<usize>() else {
        read.iter().for_each(check_sheet);
        return;
    };
    let sheet = match read {
        Ok(sheet) => sheet,
        Err(fault) => panic!("a grid is refused: {fault}\n{}", String::from_utf8_lossy(bytes)),
    };
    check_sheet(&sheet);
    let areas: Vec<f64> = sheet.faces.iter().map(|face| area(&sheet, face)).collect();
    assert_eq!(areas.len(), cells, "a face for each cell");
    assert!(areas.iter().all(|a| (a / areas[0] - 1.0).abs() < 1e-6), "cells are as large: {areas:?}");
}

/// Checks that faces are polygons, counterclockwise, of vertices that there are, and creases edges of two of them.
fn check_sheet(sheet: &CreaseSheet) {
    assert!(sheet.vertices.iter().flatten().all(|x| x.is_finite()));
    let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for face in &sheet.faces {
        assert!(face.len() >= 3 && face.iter().all(|corner| *corner < sheet.vertices.len()), "{face:?}");
        assert!(area(sheet, face) > 0.0, "{face:?} is seen from behind");
        for (a, b) in face.iter().zip(face.iter().cycle().skip(1)) {
            *sides.entry([*a.min(b), *a.max(b)]).or_default() += 1;
        }
    }
    assert!(sheet.angles.keys().all(|edge| sides.get(edge) == Some(&2)), "a crease is between two faces");
    assert!(sheet.angles.values().all(|angle| angle.abs() <= PI), "an angle is at most half a turn");
}

/// Returns the area of a face, positive if its corners are counterclockwise.
fn area(sheet: &CreaseSheet, face: &[usize]) -> f64 {
    let corners: Vec<[f64; 2]> = face.iter().map(|corner| sheet.vertices[*corner]).collect();
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    // From the first corner, so that a sheet far from the origin loses no digits.
    let [x, y] = corners[0];
    sides.map(|(a, b)| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y)).sum::<f64>() / 2.0
}

/// Returns a file of RoFI modules.
pub fn rofi_file(dice: &mut Dice) -> Vec<u8> {
    rofi_inputs::file(dice)
}

/// Reads a configuration of RoFI modules; what is read is written in both formats, read the same, and is a robot.
pub fn rofi(input: &[u8]) {
    let (ending, bytes) = ended(input);
    let text = String::from_utf8_lossy(bytes);
    let read = if ending == "json" { rofi_json::read(&text) } else { rofi::read(&text) };
    let Ok(world) = read else { return };
    let bare = |mut world: World| {
        world.modules.iter_mut().for_each(|module| module.line = 0);
        world.edges.iter_mut().for_each(|edge| edge.line = 0);
        world
    };
    let world = bare(world);
    for again in [rofi::read(&rofi::write(&world)), rofi_json::read(&rofi_json::write(&world))] {
        match again {
            Ok(again) => assert_eq!(bare(again), world, "read as another"),
            Err(error) => panic!("what was written is refused: {error}"),
        }
    }
    let (robot, start) = rofi_assembly::assembly(&world, 0.1);
    assert_eq!(robot.modules.len(), world.modules.len());
    assert_eq!(start.bonds.len(), world.edges.len());
}

/// Returns a description, with a mesh beside it.
pub fn description(dice: &mut Dice) -> Vec<u8> {
    descriptions::file(dice)
}

/// Returns the files of a robot of the SMORES tools.
pub fn smores_files(dice: &mut Dice) -> Vec<u8> {
    smores::files(dice)
}

/// Takes a robot in. Its text is formatted, checks, and is elaborated without errors.
pub fn robots(input: &[u8]) {
    let files = parted(input);
    let beside = |name: &str| {
        let name = name.rsplit('/').next().unwrap_or(name);
        files.iter().find(|(known, _)| known == name).map(|(_, text)| text.clone().into_bytes())
    };
    // A mesh and a part of a structure are named by the files that are given.
    let given = files
        .iter()
        .enumerate()
        .filter(|(index, (name, _))| *index == 0 || !name.ends_with(".obj") && name != "row.conf");
    let given: Vec<ImportFile> = given.map(|(_, (name, text))| ImportFile { name, text }).collect();
    let Ok(imported) = import(&given, &mut |name| beside(name)) else { return };
    super::texts::format(imported.text.as_bytes());
    let formatted = modl::format::format(FileId(0), &imported.text).expect("the meaning stays").text;
    let project = Project::of(&formatted);
    let checked = modl::check::check(&project, "main.mod");
    let errors: Vec<_> = checked.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "what came in does not check: {errors:#?}\n{formatted}");
    let (_, outcome) = ran(&checked, Mode::Check, &project);
    let errors: Vec<_> =
        outcome.diagnostics.iter().filter(|d| d.is_error() && !is_beyond_limits(d)).collect();
    assert!(errors.is_empty(), "what came in makes no robot: {errors:#?}\n{formatted}");
}

/// Returns true for a number that a file may state, and that is beyond the limits of the language: a ball of the size of a
/// molecule, a link in another town, a joint that turns faster than its limit.
fn is_beyond_limits(diagnostic: &Diagnostic) -> bool {
    let beyond = [code::TOO_FAST, code::BAD_MODULE, code::BAD_SHAPE, code::BAD_VALUE];
    beyond.contains(&diagnostic.code) && !diagnostic.message.contains("follows")
}

/// A map of a robot, right in its form.
static MAP: LazyLock<Altered> = LazyLock::new(|| {
    let motor = |channel: u32| json!({ "channel": channel, "zero": 0.1, "sign": -1, "range": [-1.0, 1.0], "speed": 2.5 });
    let joint = |name: &str, channel: u32| json!({ "joint": name, "motor": motor(channel) });
    let module = |index: u32| json!({ "module": format!("m[{index}]"), "bus": index, "joints": [joint("bend", 0), joint("slide", 1)] });
    Altered::new(
        json!({ "modules": [module(0), module(1), module(2)], "hinges": [{ "bond": "a.front -- b.back", "bus": 9, "motor": motor(3) }] }),
    )
});

/// The plans that maps are checked against.
static PLANS: LazyLock<Vec<Plan>> = LazyLock::new(|| {
    ARTICULATED.iter().map(|plan| file::read(&plan.file.to_string()).expect("it is right")).collect()
});

/// Returns a map of motors.
pub fn map(dice: &mut Dice) -> Vec<u8> {
    let mut file = MAP.file.clone();
    for _ in 0..dice.below(3) {
        MAP.alter(&mut file, dice, &["/modules", ""]);
    }
    if dice.below(2) == 1
        && let Some(all) = file.as_object_mut()
    {
        all.remove("hinges");
    }
    file.to_string().into_bytes()
}

/// Reads a map, and checks it against the plans; what fits commands motors.
pub fn maps(input: &[u8]) {
    let Ok(map) = RobotMap::read(&String::from_utf8_lossy(input)) else { return };
    for plan in PLANS.iter() {
        if let (Ok(driven), Some(tracks)) = (map.checked(plan), plan.body.tracks()) {
            mapping::without_motor(plan, &driven);
            let table = mapping::targets(tracks, &driven, &[0.0, tracks.duration / 2.0, tracks.duration]);
            assert_eq!(table.rows, 3);
        }
    }
}

/// Returns the eight bytes of a seed.
pub fn seed(dice: &mut Dice) -> Vec<u8> {
    (0..8).map(|_| dice.below(256) as u8).collect()
}

/// Writes a crease pattern, and reads it: its last state has the same places.
pub fn creases(input: &[u8]) {
    let pattern = crease::pattern(&mut Dice::of_bytes(&input.repeat(64)));
    let text = (FOLDING_FORMATS[0].write)(&pattern);
    let value: serde_json::Value = serde_json::from_str(&text).expect("FOLD is JSON");
    let last = match pattern.folded.last() {
        Some(folded) => folded.clone(),
        None => pattern.vertices.iter().map(|[x, y]| [*x, *y, 0.0]).collect(),
    };
    let format = MESH_FORMATS.iter().find(|format| format.ending == "fold").expect("it is read");
    let read = match format.read_mesh(text.as_bytes()) {
        Ok(read) => read,
        Err(fault) => panic!("what was written is refused: {fault}\n{text}"),
    };
    assert_eq!(read.faces.len(), pattern.faces.len());
    let extent = last.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (face, corners) in read.faces.iter().zip(&pattern.faces) {
        for (found, wanted) in face.iter().zip(corners) {
            // Corners that meet become one.
            let apart = (0..3).map(|k| (read.vertices[*found][k] - 1e3 * last[*wanted][k]).abs());
            assert!(apart.fold(0.0, f64::max) <= 4e-6 * 1e3 * extent, "{corners:?} is elsewhere\n{text}");
        }
    }
    assert_eq!(value["edges_vertices"].as_array().map(Vec::len), Some(pattern.edges.len()));
}
