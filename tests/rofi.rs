//! RoFI's module against the published formulas, and its files: what is read, written, refused.

#![allow(non_snake_case)]

use crate::interpret::{Ran, ran};
use crate::suite::MapFiles;
use modl::geometry::Pose;
use modl::geometry::pose::{shifted, turned};
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
    let done = loaded("C\nM 0 0 0 0\n", "print(count(load(\"x.rofi\")))\n");
    assert_eq!(done.outcome.diagnostics[0].code, code::UNKNOWN_IMPORT);
    let done = loaded("", "use std.smores.Smores\nsave(Smores(), \"s.rofi\")\n");
    assert_eq!(done.outcome.diagnostics[0].code, code::BAD_VALUE);
}
