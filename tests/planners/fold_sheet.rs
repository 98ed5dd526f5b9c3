//! Sheets whose creases close loops: the ways that are known in closed form, and what is no sheet.

use crate::language::interpret::ran;
use crate::planners::fold::near;
use crate::support::suite::MapFiles;
use modl::geometry::Vec3;
use modl::interpret::{Mode, Options};
use modl::planners::fold::Target;
use modl::planners::fold_sheet::path::{Path, between, from_flat};
use modl::planners::fold_sheet::{Loops, NoSheet, folded};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A partly folded Miura-ori of parallelograms with sides of 1 (Schenk and Guest 2013).
fn miura(rows: usize, columns: usize, sector: f64, fold: f64) -> Target {
    let (sine, cosine) = (libm::sin(fold), libm::cos(fold));
    let slope = libm::sqrt(1.0 + libm::pow(cosine * libm::tan(sector), 2.0));
    let pace = libm::sqrt(1.0 - libm::pow(sine * libm::sin(sector), 2.0));
    let width = cosine * libm::tan(sector) / slope;
    let corner = |i: usize, j: usize| {
        Vec3::new(
            width * j as f64,
            pace * i as f64 + (j % 2) as f64 / slope,
            (i % 2) as f64 * sine * libm::sin(sector),
        )
    };
    let corners = (0..=rows).flat_map(|i| (0..=columns).map(move |j| corner(i, j))).collect();
    let at = |i: usize, j: usize| i * (columns + 1) + j;
    let face = |i: usize, j: usize| vec![at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
    let faces: Vec<Vec<usize>> = (0..rows).flat_map(|i| (0..columns).map(move |j| face(i, j))).collect();
    Target::new(corners, &faces).expect("it folds")
}

fn angles(target: &Target) -> Vec<f64> {
    target.hinges.iter().map(|hinge| hinge.angle).collect()
}

fn way(target: &Target) -> Path {
    let loops = Loops::of(target).expect("it is a sheet");
    from_flat(&loops, &angles(target)).expect("a way leads there")
}

/// The angles on the way where those of crease 0 are as given.
fn where_first_is(way: &Path, first: f64) -> Vec<f64> {
    let reaches = |pair: &&[modl::planners::fold_sheet::path::Place]| pair[1].angles[0].abs() >= first.abs();
    let pair = way.places.windows(2).find(reaches).expect("it folds as far");
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        let less = between(&pair[0], &pair[1], middle).0[0].abs() < first.abs();
        if less { low = middle } else { high = middle }
    }
    between(&pair[0], &pair[1], low).0.iter().copied().collect()
}

/// Miura-oris have one degree of freedom, and every form on the way is one that is less folded.
#[test]
fn miura_oris_fold_as_their_formulas_say() {
    for (rows, columns, sector, fold) in [(2, 2, 60.0_f64, 60.0_f64), (3, 4, 70.0, 50.0), (5, 5, 50.0, 65.0)]
    {
        let (sector, fold) = (sector.to_radians(), fold.to_radians());
        let target = miura(rows, columns, sector, fold);
        let way = way(&target);
        assert_eq!(way.freedom, 1);
        assert!(way.gap < 1e-5, "{}", way.gap);
        for part in [0.05, 0.3, 0.5, 0.8, 0.95] {
            let there = angles(&miura(rows, columns, sector, fold * part));
            let found = where_first_is(&way, there[0]);
            let off = there.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-5, "{rows} x {columns} at {part}: {off}");
        }
    }
}

/// A vertex of four creases that folds flat: opposite creases fold alike, and the tangents of half the angles of
/// neighbours are in proportion all the way (Huffman 1976; Lang 2018, *Twists, Tilings, and Tessellations*).
#[test]
fn tangents_of_half_angles_are_in_proportion() {
    let target = miura(2, 2, 55f64.to_radians(), 62f64.to_radians());
    let way = way(&target);
    let ratio = |angles: &[f64]| {
        let tangents: Vec<f64> = angles.iter().map(|angle| libm::tan(angle / 2.0)).collect();
        tangents.iter().map(|t| t / tangents[0]).collect::<Vec<f64>>()
    };
    let end = ratio(&angles(&target));
    for place in &way.places[1..] {
        let here = ratio(place.angles.as_slice());
        for (a, b) in here.iter().zip(&end) {
            assert!(near(*a, *b, 2e-4), "{a} is not {b} at {}", place.part);
        }
    }
    let mut sizes: Vec<f64> = angles(&target).iter().map(|angle| angle.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    assert!(near(sizes[0], sizes[1], 1e-9) && near(sizes[2], sizes[3], 1e-9) && sizes[2] > sizes[1] * 1.1);
}

/// Panels drawn from their own sides on, with the angles of a place: neighbours meet along their creases, all round.
#[test]
fn sheets_stay_in_one_piece() {
    let target = miura(3, 3, 65f64.to_radians(), 55f64.to_radians());
    let whole = way(&target);
    // The flat sheet, from the angles of a form that is hardly folded, and from there to each place.
    let flat = {
        let least = miura(3, 3, 65f64.to_radians(), 0.0);
        let corners: Vec<Vec3> = least.vertices.clone();
        Target::new(corners, &least.faces).expect("it is flat")
    };
    for place in whole.places.iter().step_by(16) {
        let vertices = folded(&flat, place.angles.as_slice()).expect("it closes");
        let there = Target::new(vertices, &flat.faces).expect("it folds");
        for (hinge, angle) in there.hinges.iter().zip(place.angles.iter()) {
            assert!((hinge.angle - angle).abs() < 1e-4, "{} is not {angle}", hinge.angle);
        }
        for face in 0..there.faces.len() {
            for (a, b) in there.side_lengths(face).iter().zip(flat.side_lengths(face)) {
                assert!(near(*a, b, 1e-5));
            }
        }
    }
}

#[test]
fn what_is_no_sheet_is_told() {
    let corners: Vec<Vec3> = (0..6).map(|k| Vec3::ith(k / 2, [1.0, -1.0][k % 2])).collect();
    let all = [[0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3]];
    let of = |faces: &[[usize; 3]]| {
        let faces: Vec<Vec<usize>> = faces.iter().map(|f| f.to_vec()).collect();
        Loops::of(&Target::new(corners.clone(), &faces).expect("it folds")).map(|loops| loops.loops.len())
    };
    // Four triangles of an octahedron come to 240 degrees; two sheets that are joined at a ring of faces have a hole.
    let Err(NoSheet::Curved { vertex: 0, sum }) = of(&all[..4]) else { panic!("it is curved") };
    assert!(near(sum, 240f64.to_radians(), 1e-12));
    assert_eq!(of(&all[..3]), Ok(0));
    assert_eq!(of(&[all[0], all[1], all[5], all[7], all[6], all[2]]), Err(NoSheet::NoDisk));
    assert!(matches!(of(&all), Err(NoSheet::Curved { .. })));
}

/// A vertex of four creases in a square with sectors of 60, 100, 120 and 80 degrees, as a FOLD file with these angles.
fn vertex(fold_angles: [f64; 4], faces: bool, assignment: [&str; 4]) -> Vec<u8> {
    let directions = [0.0, 60.0, 160.0, 280.0_f64].map(f64::to_radians);
    let mut places = vec![[0.0, 0.0]];
    for (k, direction) in directions.iter().enumerate() {
        places.push([libm::cos(*direction), libm::sin(*direction)]);
        // The border bulges between two creases.
        let next = directions.get(k + 1).copied().unwrap_or(2.0 * PI);
        let middle = (direction + next) / 2.0;
        places.push([1.3 * libm::cos(middle), 1.3 * libm::sin(middle)]);
    }
    let mut edges: Vec<[usize; 2]> = (0..4).map(|k| [0, 1 + 2 * k]).collect();
    edges.extend((0..8).map(|k| [1 + k, 1 + (k + 1) % 8]));
    let mut file = serde_json::json!({
        "file_spec": 1.2,
        "vertices_coords": places,
        "edges_vertices": edges,
        "edges_assignment": assignment.iter().copied().chain(["B"; 8]).collect::<Vec<&str>>(),
        "edges_foldAngle": fold_angles.iter().map(|a| serde_json::json!(a)).chain((0..8).map(|_| serde_json::Value::Null)).collect::<Vec<_>>(),
    });
    if faces {
        let face = |k: usize| vec![0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % 8];
        file["faces_vertices"] = serde_json::json!((0..4).map(face).collect::<Vec<_>>());
    }
    file.to_string().into_bytes()
}

/// Returns what a program prints, and what is wrong with it, with this file beside it.
fn with_file(program: &str, file: Vec<u8>) -> (Vec<String>, Vec<String>, BTreeMap<String, Vec<u8>>) {
    let mut project = MapFiles::of(program);
    project.0.insert("vertex.fold".into(), file);
    let done = ran(&project, "main.mod", Mode::Run, &Options::default());
    let said = done.outcome.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect();
    (done.host.printed, said, done.host.written)
}

/// Opposite sectors of 60 and 120, 100 and 80 degrees: it folds flat. The creases between them fold by angles whose halves'
/// tangents are in the proportion sin((a - b)/2) / sin((a + b)/2) of neighbouring sectors, or cos for sin.
#[test]
fn a_vertex_of_four_creases_folds_from_its_file() {
    let (a, b) = (60f64.to_radians(), 100f64.to_radians());
    let ratios = [
        libm::sin((a - b) / 2.0) / libm::sin((a + b) / 2.0),
        libm::cos((a + b) / 2.0) / libm::cos((a - b) / 2.0),
    ];
    let wide = 70f64.to_radians();
    let mut folds = 0;
    for faces in [true, false] {
        for ratio in ratios {
            for (first, second) in [(0, 1), (1, 0)] {
                for sign in [1.0, -1.0] {
                    let narrow = 2.0 * libm::atan(libm::tan(wide / 2.0) * ratio.abs()) * sign;
                    // One pair of opposite creases folds the same way, the other two ways.
                    let mut all = [0.0; 4];
                    (all[first], all[first + 2]) = (wide, wide);
                    (all[second], all[second + 2]) = (narrow, -narrow);
                    let degrees = all.map(|angle: f64| (-angle.to_degrees() * 1e4).round() / 1e4);
                    let letters = degrees.map(|angle| if angle < 0.0 { "M" } else { "V" });
                    let (printed, said, _) = with_file(
                        "use std.mori.Polygon
let sheet = fold_sheet(load_creases(\"vertex.fold\", scale: 100mm), module: Polygon(thickness: 3mm))
print(sheet.panels, sheet.creases, sheet.loops, sheet.freedom, verify(sheet).ok, verify(reverse(sheet)).ok)
print(max([abs(a) for a in sheet.angles]) / 1deg)
",
                        vertex(degrees, faces, letters),
                    );
                    if said.is_empty() {
                        folds += 1;
                        assert_eq!(printed[0], "4 4 1 1 true true");
                        assert!((printed[1].parse::<f64>().expect("a number") - 70.0).abs() < 0.01);
                    } else {
                        assert!(said[0].contains("tears at vertex 0"), "{said:?}");
                    }
                }
            }
        }
    }
    // Two of the eight combinations are the two ways in which the vertex folds, for each of the two files.
    assert_eq!(folds, 4);
}

#[test]
fn files_that_say_no_crease_pattern_are_refused() {
    let program = "print(faces(load_creases(\"vertex.fold\", scale: 100mm)))";
    let refused = |file: Vec<u8>, code: &str, words: &str| {
        let (_, said, _) = with_file(program, file);
        assert!(said.iter().any(|said| said.starts_with(code) && said.contains(words)), "{words}: {said:?}");
    };
    let letters = ["M", "V", "V", "V"];
    refused(vertex([10.0, 0.0, 0.0, 0.0], true, letters), "E0703", "a mountain");
    refused(vertex([-10.0, -5.0, 0.0, 0.0], true, letters), "E0703", "a valley");
    refused(vertex([-200.0, 5.0, 0.0, 0.0], true, letters), "E0703", "180 degrees");
    refused(vertex([0.0; 4], true, ["B", "M", "V", "V"]), "E0703", "on either side");
    refused(vertex([60.0, 60.0, 60.0, 60.0], true, ["V"; 4]), "E0803", "tears at vertex 0");
    for (key, value, words) in [
        ("edges_foldAngle", serde_json::json!([]), "has no fold angle"),
        ("edges_vertices", serde_json::json!([[0, 1], [1, 0]]), "stands there twice"),
        ("edges_vertices", serde_json::json!([[0, 99]]), "vertex"),
        ("vertices_coords", serde_json::json!([[0, 0, 0], [1, 0, 1]]), "out of the plane"),
        ("edges_vertices", serde_json::json!([[0, 1]]), "no edge joins"),
    ] {
        let mut file: serde_json::Value =
            serde_json::from_slice(&vertex([0.0; 4], true, ["M", "V", "M", "V"])).expect("JSON");
        file[key] = value;
        refused(file.to_string().into_bytes(), "E0", words);
    }
}
