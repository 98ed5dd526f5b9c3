//! Shapes from STL files: a cube in both of the format's forms, against the built-in box; files that
//! are none.

use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};
use modl::source::code;

/// Two triangles for each side of a cube from 0 to `edge`, seen from outside counter-clockwise.
fn cube(edge: f32) -> Vec<[[f32; 3]; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [0.0, edge] {
            let corner = |a: f32, b: f32| {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, a * edge, b * edge);
                p
            };
            let mut square = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            if side == 0.0 {
                square.reverse();
            }
            triangles.extend([[square[0], square[1], square[2]], [square[0], square[2], square[3]]]);
        }
    }
    triangles
}

fn text(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let facet = |corners: &[[f32; 3]; 3]| {
        let vertex = |p: &[f32; 3]| format!("  vertex {} {} {}\n", p[0], p[1], p[2]);
        let corners: String = corners.iter().map(vertex).collect();
        format!(" facet normal 0 0 0\n outer loop\n{corners} endloop\n endfacet\n")
    };
    let facets: String = triangles.iter().map(facet).collect();
    format!("solid cube\n{facets}endsolid cube\n").into_bytes()
}

fn binary(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const PROGRAM: &str = "
module Pair {
  mass 9g
  link near = box(10mm, 10mm, 10mm)
  link far  = mesh(\"cube.stl\", scale: 1mm) at [90mm, -10mm, -10mm]
  joint slide : near -> far = prismatic(axis: X, range: 0mm..20mm, max_speed: 1m/s)
}
config C { part p: Pair }
let c = C()
print(com(c))
";

fn with_file(stl: Vec<u8>) -> crate::language::interpret::Ran {
    let mut files = MapFiles::of(PROGRAM);
    files.0.insert("cube.stl".into(), stl);
    ran(&files, "main.mod", Mode::Run, &Options::default())
}

/// A cube of 20 mm weighs eight times one of 10 mm: the centre is at 8/9 of 100 mm.
#[test]
fn a_cube_from_a_file_has_the_volume_and_the_centre_of_a_cube() {
    for stl in [text(&cube(20.0)), binary(&cube(20.0))] {
        let done = with_file(stl);
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        assert_eq!(done.host.printed, ["[88.8889mm, 0mm, 0mm]"]);
    }
}

#[test]
fn a_file_that_is_no_mesh_is_refused_with_the_reason() {
    let mut cut = binary(&cube(20.0));
    cut.truncate(cut.len() - 7);
    let mut open = cube(20.0);
    open.pop();
    let mut wild = cube(20.0);
    wild[0][0][0] = f32::NAN;
    let cases = [
        (cut, code::CANNOT_READ, "length"),
        (b"solid nothing\nendsolid\n".to_vec(), code::CANNOT_READ, "no triangles"),
        (b"solid x\nvertex 1 two 3\nendsolid\n".to_vec(), code::CANNOT_READ, "line 2"),
        (binary(&wild), code::CANNOT_READ, "finite"),
        (binary(&open), code::BAD_SHAPE, "closed"),
        (Vec::new(), code::CANNOT_READ, "no triangles"),
    ];
    for (stl, code, word) in cases {
        let done = with_file(stl);
        let [diagnostic] = &done.outcome.diagnostics[..] else { panic!("{:?}", done.outcome.diagnostics) };
        assert_eq!(diagnostic.code, code, "{}", diagnostic.message);
        assert!(diagnostic.message.contains(word), "{}", diagnostic.message);
    }
}

/// A box with walls of 10 mm around a hollow of 20 mm, about the origin, as a mesh of two surfaces.
fn hollow_box() -> Vec<u8> {
    let about_origin = |edge: f32| {
        let moved = move |corner: [f32; 3]| corner.map(|x| x - edge / 2.0);
        cube(edge).into_iter().map(move |triangle| triangle.map(moved))
    };
    let inside_out = about_origin(20.0).map(|[a, b, c]| [a, c, b]);
    binary(&about_origin(40.0).chain(inside_out).collect::<Vec<_>>())
}

/// A ball of 2 mm radius on an invisible arm, `AT` from the middle of the box: its feet stand far outside.
const BALL_IN_BOX: &str = "
connector Plate { mates Plate, turns 4 }
module Hollow {
  mass 20g
  link foot = box(10mm, 10mm, 10mm) at [0mm, 0mm, -100mm]
  link wall = mesh(\"hollow.stl\", scale: 1mm)
  joint stand : foot -> wall = fixed()
  port p : Plate on foot at [0mm, 0mm, -5mm] facing -Z up +X
}
module Pin {
  mass 20g
  link foot = box(10mm, 10mm, 10mm) at [0mm, 0mm, 5mm]
  link ball = sphere(2mm) at [AT, 0mm, -105mm]
  joint slide : foot -> ball = prismatic(axis: X, range: -100mm..100mm, max_speed: 1m/s)
  port p : Plate on foot at [0mm, 0mm, -5mm] facing -Z up +X
}
config Both {
  part pin: Pin
  part hollow: Hollow
  connect pin.p -- hollow.p
  behavior slide_to(q: Length) = move(pin.slide, to: q)
}
";

fn ball_in_box(at: &str, behavior: &str) -> String {
    let both = BALL_IN_BOX.replace("AT", at);
    let program = format!("{both}print(verify(Both(){behavior}, world: world(ground: off, gravity: off)))\n");
    let mut files = MapFiles::of(&program);
    files.0.insert("hollow.stl".into(), hollow_box());
    let done = ran(&files, "main.mod", Mode::Run, &Options::default());
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    done.host.printed.join("\n")
}

#[test]
fn a_link_set_inside_the_wall_of_a_mesh_is_a_collision() {
    // Its centre is in the middle of the wall.
    let said = ball_in_box("15mm", "");
    assert!(said.contains("pin and hollow meet, up to 5mm deep (ball and wall)"), "{said}");
    // So it is wherever it moves within the wall.
    let said = ball_in_box("15mm", ".slide_to(1mm)");
    assert!(said.contains("pin and hollow meet, up to 5mm deep (ball and wall)"), "{said}");
}

#[test]
fn a_link_in_the_hollow_of_a_mesh_is_free() {
    // The ball of 2 mm radius is 8 mm off the nearest wall.
    let said = ball_in_box("0mm", "");
    assert!(said.contains("clearance 8mm") && said.contains("collision: proved"), "{said}");
    let said = ball_in_box("30mm", "");
    assert!(said.contains("clearance 8mm") && said.contains("collision: proved"), "{said}");
    // Out of the hollow it gets through the wall, and what it leaves is the first to be found.
    let said = ball_in_box("0mm", ".slide_to(15mm)");
    assert!(said.contains("pin and hollow meet, up to"), "{said}");
}
