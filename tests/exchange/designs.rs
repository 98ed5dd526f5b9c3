//! Every design of the library in every format: written where the format has a meaning for it, and else refused with the
//! reason. A sample in the gate, all with `MODL_WHOLE=1`.

use crate::support::desk::{Desk, run};
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::exchange::PLAN_FORMATS;
use modl::interpret::Mode;
use std::path::Path;

/// Designs of each kind, for the gate: open and closed robots, robots with hinges between modules, a scene.
const SAMPLE: [&str; 6] = ["Walk4", "TwoCars", "Snake", "Wheel", "Caterpillar", "Carrier"];

/// Plans without links and joints, each as the beginning of a program.
const LATTICES_AND_TRUSSES: [&str; 2] = [
    "use std.crystal.ExpandingCube
lattice A of ExpandingCube = row(4)
lattice B of ExpandingCube = column(4)
let x = squeeze(A, B)",
    "use std.truss.PneumaticReel
truss Pyramid of PneumaticReel = octet(edge: 2m, divisions: 2, interior: false)
let x = locomote(Pyramid, path: [[0.3m, 0m, 0m]])",
];

/// Foldings, whose plans are of modules with hinged bonds.
const FOLDINGS: [&str; 2] = [
    "use std.mori.Mori\nuse std.shapes.octahedron\nlet x = fold(octahedron(edge: 80mm), module: Mori)",
    "use std.mori.Mori\nuse std.shapes.icosahedron\nlet x = fold(icosahedron(edge: 80mm), module: Mori)",
];

/// The names of the configurations and scenes that a file of the library declares for its users.
fn declared(file: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("stdlib").join(format!("{file}.mod"));
    let text = std::fs::read_to_string(path).expect("a file of the library");
    let names = text.lines().filter_map(|line| {
        let rest = line.strip_prefix("config ").or_else(|| line.strip_prefix("scene "))?;
        let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        (!name.starts_with('_')).then_some(name)
    });
    names.collect()
}

/// The files that a program writes that saves `x` in a format, and the diagnostics.
fn saved(program: &str, ending: &str) -> (Desk, Vec<String>) {
    let (observed, desk, _) =
        run(&MapFiles::of(&format!("{program}\nsave(x, \"design.{ending}\")\n")), Mode::Run);
    let said = observed.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect();
    (desk, said)
}

/// True if a file begins as those of its format do.
fn begins_rightly(name: &str, bytes: &[u8]) -> bool {
    let start: &[u8] = match name.rsplit_once('.').expect("an ending").1 {
        "glb" => b"glTF",
        "mcap" => b"\x89MCAP0\r\n",
        "gif" => b"GIF89a",
        "png" => b"\x89PNG\r\n",
        "urdf" | "xml" => b"<",
        "json" => b"{",
        // Binary STL has a head of 80 bytes of no meaning.
        "stl" => return bytes.len() > 84 && !bytes.starts_with(b"solid"),
        "csv" | "yaml" => return std::str::from_utf8(bytes).is_ok_and(|text| text.lines().count() > 1),
        _ => return false,
    };
    bytes.starts_with(start)
}

/// Saves a robot or a motion with links and joints in all formats; pictures, which take long, where they are wanted.
fn check_articulated(program: &str, pictures: bool) {
    let mut loops = None;
    for format in PLAN_FORMATS {
        if matches!(format.name, "gif" | "frames") && !pictures {
            continue;
        }
        let (desk, said) = saved(program, format.ending);
        if desk.written.is_empty() {
            let [said] = said.as_slice() else {
                panic!("{program}: {}: one error says why: {said:?}", format.name);
            };
            let unsound = said.starts_with("E06") && format.is_motion;
            let looped = said.contains("URDF has no closed loops, and the bond ") && format.name == "urdf";
            // The model for MuJoCo, which is written first, has constraints where bonds are in no tree.
            assert!(unsound || looped && loops == Some(true), "{program}: {}: {said}", format.name);
            continue;
        }
        assert!(said.is_empty(), "{program}: {}: {said:?}", format.name);
        for (name, bytes) in &desk.written {
            assert!(begins_rightly(name, bytes), "{program}: {name} is not what its name says");
        }
        match format.name {
            "mjcf" => {
                let model = desk.text("design.mjcf.xml");
                loops = Some(model.contains("<weld ") || model.contains("<connect "));
            }
            "urdf" => assert_eq!(loops, Some(false), "{program}: a loop is lost"),
            _ => {}
        }
    }
}

#[test]
fn robots_and_scenes_at_rest_are_written_or_refused_with_the_reason() {
    let mut seen = 0;
    for file in ["smores", "rofi", "scenes"] {
        for name in declared(file) {
            if whole() || SAMPLE.contains(&name.as_str()) {
                check_articulated(&format!("use std.{file}.{name}\nlet x = {name}()"), whole());
                seen += 1;
            }
        }
    }
    assert!(seen >= if whole() { 50 } else { SAMPLE.len() }, "{seen} designs");
}

#[test]
fn foldings_are_written() {
    let few = if whole() { FOLDINGS.len() } else { 1 };
    FOLDINGS[..few].iter().for_each(|program| check_articulated(program, whole()));
}

#[test]
fn lattices_and_trusses_are_pictures_and_scenes_and_nothing_else() {
    for program in LATTICES_AND_TRUSSES {
        for format in PLAN_FORMATS {
            let pictures = matches!(format.name, "gif" | "frames");
            if pictures && !whole() {
                continue;
            }
            let (desk, said) = saved(program, format.ending);
            if pictures || format.name == "glb" {
                assert!(said.is_empty(), "{program}: {}: {said:?}", format.name);
                assert!(desk.written.iter().all(|(name, bytes)| begins_rightly(name, bytes)), "{program}");
                assert!(!desk.written.is_empty(), "{program}: {}", format.name);
            } else {
                assert!(desk.written.is_empty(), "{program}: {}", format.name);
                let [said] = said.as_slice() else { panic!("{program}: {}: {said:?}", format.name) };
                assert!(said.contains("which lattices and trusses have not"), "{said}");
            }
        }
    }
}
