//! Meshes from files: one octahedron in every format, folded; files that are none; files cut and
//! changed at random.

use crate::language::interpret::{Ran, ran};
use crate::support::suite::MapFiles;
use modl::interpret::{Mode, Options};
use modl::source::code;
use proptest::prelude::*;

/// Of an octahedron with edges of length 1.
const FACES: [[usize; 3]; 8] =
    [[0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3]];

fn corners() -> [[f64; 3]; 6] {
    let r = std::f64::consts::FRAC_1_SQRT_2;
    [[r, 0., 0.], [-r, 0., 0.], [0., r, 0.], [0., -r, 0.], [0., 0., r], [0., 0., -r]]
}

fn spaced<T: ToString>(items: &[T]) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(" ")
}

fn lines<T>(items: impl IntoIterator<Item = T>, line: impl Fn(T) -> String) -> String {
    items.into_iter().map(|item| line(item) + "\n").collect()
}

/// With normals, texture coordinates, groups and materials, and faces counted from the end.
fn obj() -> String {
    let vertices = lines(corners(), |p| format!("v {}", spaced(&p)));
    let face = |f: [usize; 3]| format!("f {}", spaced(&f.map(|v| format!("-{}/1/1", 6 - v))));
    let (front, back) = (lines(FACES[..4].to_vec(), face), lines(FACES[4..].to_vec(), face));
    format!(
        "# an octahedron\nmtllib none.mtl\n{vertices}vt 0 0\nvn 0 0 1\ng front\nusemtl red\n{front}g back\n{back}l 1 2\n"
    )
}

fn off() -> String {
    let vertices = lines(corners(), |p| spaced(&p));
    let faces = lines(FACES, |f| format!("3 {} 200 0 0", spaced(&f)));
    format!("OFF # an octahedron\n\n6 8 12\n{vertices}{faces}")
}

fn ply_header(format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment an octahedron\nelement vertex 6\nproperty double x\nproperty double y\n\
         property double z\nproperty uchar red\nelement face 8\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

fn ply() -> String {
    let vertices = lines(corners(), |p| format!("{} 7", spaced(&p)));
    ply_header("ascii") + &vertices + &lines(FACES, |f| format!("3 {}", spaced(&f)))
}

fn binary_ply(big: bool) -> Vec<u8> {
    let mut bytes = ply_header(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
    for corner in corners() {
        for x in corner {
            bytes.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
        }
        bytes.push(7);
    }
    for face in FACES {
        bytes.push(3);
        for v in face {
            bytes.extend(if big { (v as i32).to_be_bytes() } else { (v as i32).to_le_bytes() });
        }
    }
    bytes
}

fn stl() -> String {
    let p = corners();
    let vertex = |v: usize| format!("vertex {}", spaced(&p[v]));
    let facet =
        |f: [usize; 3]| format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet", lines(f, vertex));
    format!("solid octahedron\n{}endsolid octahedron\n", lines(FACES, facet))
}

fn formats() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("octa.obj", obj().into()),
        ("octa.off", off().into()),
        ("octa.ply", ply().into()),
        ("little.PLY", binary_ply(false)),
        ("big.ply", binary_ply(true)),
        ("octa.stl", stl().into()),
    ]
}

fn with_file(program: &str, name: &str, bytes: &[u8]) -> Ran {
    let mut files = MapFiles::of(program);
    files.0.insert(name.to_owned(), bytes.to_vec());
    ran(&files, "main.mod", Mode::Run, &Options::default())
}

fn loaded(name: &str, bytes: &[u8]) -> Ran {
    with_file(&format!("print(faces(load_mesh(\"{name}\", scale: 80mm)))\n"), name, bytes)
}

#[test]
fn a_shape_from_a_file_of_any_format_folds() {
    for (name, bytes) in formats() {
        for read in ["load_mesh", "mesh"] {
            let program = format!(
                "use std.mori.Mori\nlet found = fold({read}(\"{name}\", scale: 80mm), module: Mori)\n\
                 print(found.layouts, found.optimal, found.layout.panels)\n"
            );
            let done = with_file(&program, name, &bytes);
            assert!(done.outcome.diagnostics.is_empty(), "{name}: {:?}", done.outcome.diagnostics);
            assert_eq!(done.host.printed, ["384 true 8"], "{name}");
        }
    }
}

/// A quadrangle stays one; as a solid it is two triangles.
#[test]
fn faces_of_a_file_may_be_polygons() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let done = loaded("cube.obj", cube.as_bytes());
    assert_eq!(done.host.printed, ["6"]);
    let program = "module Block {\n mass 8g\n link a = mesh(\"cube.obj\", scale: 10mm)\n}\n\
                   config C { part b: Block }\nprint(com(C()))\n";
    let done = with_file(program, "cube.obj", cube.as_bytes());
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    assert_eq!(done.host.printed, ["[5mm, 5mm, 5mm]"]);
}

/// (file, its text, words of the message)
const REFUSED: &[(&str, &str, &str)] = &[
    ("a.step", "", "`.obj`"),
    ("a", "", "`.obj`"),
    ("a.obj", "", "no faces"),
    ("a.obj", "v 0 0 0\nv 1 0 x\n", "line 2: position"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 two 3\n", "line 4: face"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a vertex that there isn't"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "a vertex that there isn't"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 1 2\n", "a vertex that there isn't"),
    ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "no finite number"),
    ("a.off", "", "empty"),
    ("a.off", "PLY\n", "line 1: `OFF` is wanted"),
    ("a.off", "OFF BINARY\n", "binary OFF"),
    ("a.off", "OFF\n3\n", "line 2: the number of faces"),
    ("a.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", "ends after 1 of 4000000000 vertices"),
    ("a.off", "OFF\n3 1 0\n0 0 0\n# here\n1 0\n0 1 0\n3 0 1 2\n", "line 5 is no vertex"),
    ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "line 6 is no face"),
    ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "face 0 names vertex 3; there are 3"),
    ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "face 0 has fewer than three corners"),
    ("a.ply", "", "Unexpected end"),
    ("a.ply", "ply\nformat ascii 1.0\nend_header\n", "no faces"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n1\n",
        "announces 4000000000",
    ),
    ("a.ply", "ply\nformat ascii 1.0\nelement vertex 2\nend_header\n\n\n", "announces 2"),
    ("a.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\nx\n", "line 7"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
        "vertex 0 has no numbers",
    ),
];

#[test]
fn files_that_are_no_meshes_are_refused_at_their_line() {
    for (name, text, words) in REFUSED {
        let done = loaded(name, text.as_bytes());
        let [said] = &done.outcome.diagnostics[..] else { panic!("{text}: {:?}", done.outcome.diagnostics) };
        let hint = format!("{} {:?}", said.message, said.hints);
        assert_eq!(said.code, code::CANNOT_READ, "{hint}");
        assert!(hint.contains(words), "{hint} does not say `{words}`");
    }
}

/// What does not fold says why, and which faces.
#[test]
fn meshes_of_files_that_do_not_fold_name_their_faces() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0.5 0.8660254037844386 0\nv 0.5 0.2886751345948129 0.816496580927726\n\
                    v 3 0 0\nv 4 0 0\nv 3.5 0.8660254037844386 0\nv 0.5 -0.8660254037844386 0\nv 0.5 -0.5 0\n";
    let cases = [
        ("f 1 2 3\nf 2 1 4\nf 1 2 8\n", "faces 0, 1 and 2 meet at one edge"),
        ("f 1 2 3\nf 1 2 4\n", "faces 0 and 1 are not turned the same way"),
        ("f 1 2 3\nf 5 6 7\n", "from face 0 to face 1"),
        ("f 1 2 3\nf 2 1 1\n", "face 1 has no area"),
        ("f 1 2 3\nf 2 1 3\n", "faces 0 and 1 lie on each other"),
        ("f 1 2 3 4\n", "face 0 is not flat"),
        ("f 1 2 3\nf 2 1 9\n", "face 1 has a side of"),
    ];
    for (faces, words) in cases {
        let program =
            "use std.mori.Mori\nprint(fold(load_mesh(\"a.obj\", scale: 80mm), module: Mori).layouts)\n";
        let done = with_file(program, "a.obj", format!("{vertices}{faces}").as_bytes());
        let [said] = &done.outcome.diagnostics[..] else { panic!("{faces}: {:?}", done.outcome.diagnostics) };
        assert_eq!(said.code, code::UNFOLDABLE, "{}", said.message);
        assert!(said.message.contains(words), "{} does not say `{words}`", said.message);
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(64))]

    /// Bytes changed, cut off and doubled: the file is read or refused, and nothing else happens.
    #[test]
    fn spoilt_files_are_read_or_refused(
        which in 0..6usize,
        changes in proptest::collection::vec((0..2000usize, any::<u8>()), 0..6),
        digits in proptest::collection::vec((0..2000usize, 0..4usize), 0..3),
        cut in proptest::option::of(0..2000usize),
    ) {
        let (name, mut bytes) = formats().swap_remove(which);
        for (at, byte) in changes {
            let length = bytes.len();
            bytes[at % length] = byte;
        }
        for (at, what) in digits {
            let wild = ["-9223372036854775808", "99999999999999999999", "1e999", "-0"][what];
            let at = at % bytes.len();
            bytes.splice(at..at, wild.bytes());
        }
        if let Some(cut) = cut {
            bytes.truncate(cut);
        }
        let done = loaded(name, &bytes);
        let codes: Vec<_> = done.outcome.diagnostics.iter().map(|d| d.code).collect();
        prop_assert!(codes.is_empty() || codes == [code::CANNOT_READ], "{:?}", done.outcome.diagnostics);
    }
}
