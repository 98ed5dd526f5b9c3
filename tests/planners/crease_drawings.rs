//! Crease patterns from drawings in SVG: what a drawing says, in the forms in which programs write it, and what is refused;
//! and patterns that say no more than which creases are mountains.

use crate::fuzz::inputs::damage::damaged;
use crate::fuzz::inputs::dice::Dice;
use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::formats::{CREASE_FORMATS, CreaseSheet, FormatFault};
use modl::interpret::{Mode, Options};
use std::collections::BTreeMap;

/// A drawing, and what is expected of it.
struct Case {
    name: String,
    faces: Option<usize>,
    creases: Vec<[f64; 5]>,
    refused: Option<Vec<String>>,
    drawing: String,
}

/// Returns a text with each `⟦3×text⟧` repeated.
fn repeated(text: &str) -> String {
    let Some((before, rest)) = text.split_once('⟦') else { return text.to_owned() };
    let (inside, after) = rest.split_once('⟧').expect("a repetition ends");
    let (count, what) = inside.split_once('×').expect("a repetition has a number");
    let count: usize = count.parse().expect("a number");
    let all: String = (0..count).map(|k| what.replace('#', &k.to_string())).collect();
    format!("{before}{all}{}", repeated(after))
}

fn cases() -> Vec<Case> {
    let text = include_str!("crease_drawings.cases");
    let case = |section: &str| {
        let (name, body) = section.split_once('\n').expect("a case has a body");
        let mut case = Case {
            name: name.to_owned(),
            faces: None,
            creases: Vec::new(),
            refused: None,
            drawing: String::new(),
        };
        for line in body.lines() {
            if let Some(count) = line.strip_prefix("= ").and_then(|line| line.strip_suffix(" faces")) {
                case.faces = Some(count.parse().expect("a number of faces"));
            } else if let Some(crease) = line.strip_prefix("= ") {
                let numbers: Vec<f64> = crease.split(' ').map(|x| x.parse().expect("a number")).collect();
                case.creases.push(numbers.try_into().expect("two points and an angle"));
            } else if let Some(words) = line.strip_prefix("! ") {
                let (code, words) = words.split_once(' ').expect("a code, then words");
                case.refused =
                    Some([code].into_iter().chain(words.split(" | ")).map(str::to_owned).collect());
            } else {
                case.drawing.push_str(&repeated(line));
                case.drawing.push('\n');
            }
        }
        case
    };
    text.split("\n--- ").skip(1).map(case).collect()
}

fn read(ending: &str, bytes: &[u8]) -> Result<CreaseSheet, FormatFault> {
    let format = CREASE_FORMATS.iter().find(|format| format.ending == ending).expect("it is read");
    (format.read)(bytes)
}

/// The creases of a sheet with y downwards: the ends, the lesser first, and the angle in degrees.
fn creases(sheet: &CreaseSheet) -> Vec<[f64; 5]> {
    let crease = |(ends, angle): (&[usize; 2], &f64)| {
        let mut ends = ends.map(|end| sheet.vertices[end]).map(|[x, y]| [x, -y]);
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let [[a, b], [c, d]] = ends;
        [a, b, c, d, angle.to_degrees()]
    };
    sheet.angles.iter().map(crease).collect()
}

/// Returns what is said of a program with a file beside it, and what it prints.
fn with_file(program: &str, name: &str, file: &[u8]) -> (Vec<String>, Vec<String>) {
    let mut project = MapFiles::of(program);
    project.0.insert(name.to_owned(), file.to_vec());
    let done = ran(&project, "main.mod", Mode::Run, &Options::default());
    let said = done.outcome.diagnostics.iter();
    let said = said.map(|d| format!("{} {}\n{}", d.code, d.message, d.hints.join("\n"))).collect();
    (done.host.printed, said)
}

/// Drawings say the sheets that stand beside them, and those that are refused are so with their words.
#[test]
fn drawings_say_what_stands_beside_them() {
    let mut wrong = Vec::new();
    for case in cases() {
        let bytes = case.drawing.as_bytes();
        if let Some(words) = &case.refused {
            let (_, said) = with_file("print(faces(load_creases(\"c.svg\")))", "c.svg", bytes);
            if !words.iter().all(|word| said.len() == 1 && said[0].contains(word)) {
                wrong.push(format!("{}: {said:?}", case.name));
            }
            continue;
        }
        let sheet = match read("svg", bytes) {
            Ok(sheet) => sheet,
            Err(fault) => {
                wrong.push(format!("{}: {fault}", case.name));
                continue;
            }
        };
        let found = creases(&sheet);
        let near = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-2);
        let all = found.len() == case.creases.len()
            && case.creases.iter().all(|crease| found.iter().any(|other| near(crease, other)));
        if !all || case.faces != Some(sheet.faces.len()) {
            wrong.push(format!("{}: {} faces, {found:?}", case.name, sheet.faces.len()));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// A file in FOLD and the drawing of the same creases.
struct Twins {
    fold: Vec<u8>,
    svg: Vec<u8>,
}

/// Returns both files of a sheet: `edges` with the fold angle of each crease in degrees as FOLD counts it, `None` at the
/// border. The drawing has its lines in another order, turned about, under a transformation.
fn twins(vertices: &[[f64; 2]], edges: &[([usize; 2], Option<f64>)]) -> Twins {
    let letter = |angle: &Option<f64>| match angle {
        None => "B",
        Some(angle) if *angle < 0.0 => "M",
        Some(_) => "V",
    };
    let fold = serde_json::json!({
        "vertices_coords": vertices,
        "edges_vertices": edges.iter().map(|(ends, _)| ends).collect::<Vec<_>>(),
        "edges_assignment": edges.iter().map(|(_, angle)| letter(angle)).collect::<Vec<_>>(),
        "edges_foldAngle": edges.iter().map(|(_, angle)| angle).collect::<Vec<_>>(),
    });
    let mut svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\"><g transform=\"translate(3,4) scale(0.1)\">".to_owned();
    for (ends, angle) in edges.iter().rev() {
        let [[a, b], [c, d]] =
            ends.map(|end| vertices[end]).map(|[x, y]| [(x - 3.0) * 10.0, (-y - 4.0) * 10.0]);
        let colour = match angle {
            None => "#000",
            Some(angle) if *angle < 0.0 => "#f00",
            Some(_) => "#00f",
        };
        let opacity = angle.map_or(1.0, |angle| angle.abs() / 180.0);
        svg += &format!(
            "<line stroke=\"{colour}\" opacity=\"{opacity}\" x1=\"{c}\" y1=\"{d}\" x2=\"{a}\" y2=\"{b}\"/>"
        );
    }
    Twins { fold: fold.to_string().into_bytes(), svg: (svg + "</g></svg>").into_bytes() }
}

/// Both files are the same sheet, its vertices matched by their places, and fold alike.
fn are_alike(twins: &Twins, expected: &str) {
    let (fold, svg) =
        (read("fold", &twins.fold).expect("it is read"), read("svg", &twins.svg).expect("it is read"));
    assert_eq!(fold.vertices.len(), svg.vertices.len());
    let twin = |vertex: &usize| {
        let [x, y] = svg.vertices[*vertex];
        let near = |[a, b]: &[f64; 2]| (a - x).abs() + (b - y).abs() < 1e-9;
        fold.vertices.iter().position(near).expect("a vertex is there in both")
    };
    let cycle = |face: Vec<usize>| {
        let least = (0..face.len()).min_by_key(|k| face[*k]).expect("a face has corners");
        (0..face.len()).map(|k| face[(least + k) % face.len()]).collect::<Vec<usize>>()
    };
    let mut there: Vec<Vec<usize>> = fold.faces.iter().cloned().map(cycle).collect();
    let mut here: Vec<Vec<usize>> =
        svg.faces.iter().map(|face| cycle(face.iter().map(twin).collect())).collect();
    there.sort();
    here.sort();
    assert_eq!(there, here);
    let angles: BTreeMap<[usize; 2], f64> = svg
        .angles
        .iter()
        .map(|([a, b], angle)| {
            let (a, b) = (twin(a), twin(b));
            ([a.min(b), a.max(b)], *angle)
        })
        .collect();
    assert_eq!(angles.len(), fold.angles.len());
    assert!(fold.angles.iter().all(|(ends, angle)| (angles[ends] - angle).abs() < 1e-12));
    for (name, file) in [("c.fold", &twins.fold), ("c.svg", &twins.svg)] {
        let program = format!(
            "use std.mori.Polygon
let sheet = fold_sheet(load_creases(\"{name}\", scale: 80mm), module: Polygon(thickness: 3mm))
print(sheet.panels, sheet.creases, sheet.loops, sheet.freedom, verify(sheet).ok)"
        );
        let (printed, said) = with_file(&program, name, file);
        assert!(said.is_empty(), "{name}: {said:?}");
        assert_eq!(printed, [expected], "{name}");
    }
}

/// The vertex of four creases of `examples/vertex.fold`, whose sectors are 60, 100, 120 and 80 degrees.
#[test]
fn a_vertex_of_four_creases_is_the_same_drawn() {
    let file: serde_json::Value =
        serde_json::from_str(include_str!("../../examples/vertex.fold")).expect("it is JSON");
    let vertices: Vec<[f64; 2]> = serde_json::from_value(file["vertices_coords"].clone()).expect("points");
    let ends: Vec<[usize; 2]> = serde_json::from_value(file["edges_vertices"].clone()).expect("edges");
    let angles: Vec<Option<f64>> = serde_json::from_value(file["edges_foldAngle"].clone()).expect("angles");
    let edges: Vec<_> = ends.into_iter().zip(angles).collect();
    are_alike(&twins(&vertices, &edges), "4 4 1 1 true");
}

/// A Miura-ori of 3 by 3 parallelograms with sides of 1 and a sector of 60 degrees. Its zigzags fold all one way in turns,
/// by twice the angle whose sine is that of a panel's slope; along the straight lines the tangents of half the angles are
/// less by the cosine of the sector (Schenk and Guest 2013; Lang 2018).
#[test]
fn a_miura_ori_is_the_same_drawn() {
    let (sector, wide) = (60f64.to_radians(), 70f64.to_radians());
    let narrow = 2.0 * libm::atan(libm::tan(wide / 2.0) * libm::cos(sector));
    let at = |row: usize, column: usize| row * 4 + column;
    let place = |row: usize, column: usize| {
        let shift = (column % 2) as f64 * libm::cos(sector);
        [column as f64 * libm::sin(sector), row as f64 + shift]
    };
    let vertices: Vec<[f64; 2]> = (0..16).map(|k| place(k / 4, k % 4)).collect();
    let mut edges = Vec::new();
    for row in 0..4 {
        for column in 0..4 {
            let alternating = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            // Along a zigzag all creases fold alike; along a straight line they alternate.
            let zigzag = Some(alternating(row) * wide.to_degrees()).filter(|_| row % 3 != 0);
            let straight = Some(-alternating(row + column) * narrow.to_degrees()).filter(|_| column % 3 != 0);
            if column < 3 {
                edges.push(([at(row, column), at(row, column + 1)], zigzag));
            }
            if row < 3 {
                edges.push(([at(row, column), at(row + 1, column)], straight));
            }
        }
    }
    are_alike(&twins(&vertices, &edges), "9 12 4 1 true");
}

/// The area of a face by the shoelace formula.
fn area(sheet: &CreaseSheet, face: &[usize]) -> f64 {
    let at = |k: usize| sheet.vertices[face[k % face.len()]];
    (0..face.len()).map(|k| at(k)[0] * at(k + 1)[1] - at(k)[1] * at(k + 1)[0]).sum::<f64>() / 2.0
}

/// Chords of a square that cross in k points part it into 1 + n + k faces (Euler), which together are as large as it is.
#[test]
fn chords_part_a_square_as_euler_says() {
    let mut crossings_of_all = 0;
    for seed in 0..1000 {
        let mut dice = Dice::new(seed);
        // Chords from the left to the right, whose ends are apart from each other.
        let count = 1 + dice.below(12);
        let mut heights: Vec<usize> = (1..=count).collect();
        for k in (1..count).rev() {
            heights.swap(k, dice.below(k + 1));
        }
        let height =
            |k: usize, dice: &mut Dice| 100.0 * k as f64 / (count + 1) as f64 + dice.between(-2.0, 2.0);
        let chords: Vec<[f64; 2]> =
            (0..count).map(|k| [height(k + 1, &mut dice), height(heights[k], &mut dice)]).collect();
        let crossing = |a: &[f64; 2], b: &[f64; 2]| {
            ((a[0] - b[0]) * (a[1] - b[1]) < 0.0).then(|| {
                let (from, to) = (a[0] - b[0], a[1] - b[1]);
                let x = 100.0 * from / (from - to);
                [x, a[0] + (a[1] - a[0]) * x / 100.0]
            })
        };
        let mut crossings: Vec<[f64; 2]> = Vec::new();
        for (k, a) in chords.iter().enumerate() {
            crossings.extend(chords[k + 1..].iter().filter_map(|b| crossing(a, b)));
        }
        // A crossing that is near to the border or to a third chord is no case of this.
        let near = |[x, y]: &[f64; 2]| {
            let beside = |chord: &&[f64; 2]| (chord[0] + (chord[1] - chord[0]) * x / 100.0 - y).abs() < 1.0;
            chords.iter().filter(beside).count() > 2 || *x < 1.0 || *x > 99.0
        };
        if crossings.iter().any(near) {
            continue;
        }
        crossings_of_all += crossings.len();
        let lines: String = chords.iter().map(|[a, b]| format!("M0 {a}L100 {b}")).collect();
        let svg = format!(
            "<svg stroke='red'><rect width='100' height='100' stroke='black'/><path d='{lines}'/></svg>"
        );
        let sheet = read("svg", svg.as_bytes()).expect("it is read");
        assert_eq!(sheet.faces.len(), 1 + count + crossings.len(), "{svg}");
        assert_eq!(sheet.angles.len(), count + 2 * crossings.len(), "{svg}");
        let areas: Vec<f64> = sheet.faces.iter().map(|face| area(&sheet, face)).collect();
        assert!(areas.iter().all(|area| *area > 0.0) && (areas.iter().sum::<f64>() - 1e4).abs() < 1e-6);
    }
    assert!(crossings_of_all > 1000, "{crossings_of_all}");
}

/// Drawings that were damaged are refused, or are sheets whose faces lie beside each other.
#[test]
fn damaged_drawings_are_refused_or_sheets() {
    let read_well = |case: &Case| case.refused.is_none();
    let drawings: Vec<String> = cases().into_iter().filter(read_well).map(|case| case.drawing).collect();
    let mut sheets = 0;
    for seed in 0..4000 {
        let mut dice = Dice::new(seed);
        let drawing = drawings[dice.below(drawings.len())].clone();
        let damaged = damaged(&mut dice, &drawing);
        let Ok(sheet) = read("svg", damaged.as_bytes()) else { continue };
        sheets += 1;
        let mut sides = BTreeMap::new();
        for face in &sheet.faces {
            assert!(area(&sheet, face) > 0.0, "{damaged}");
            for (k, a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                assert!(sides.insert([*a, b], ()).is_none(), "{damaged}");
            }
        }
        let inner = sides.keys().filter(|[a, b]| a < b && sides.contains_key(&[*b, *a])).count();
        assert_eq!(inner, sheet.angles.len(), "{damaged}");
    }
    assert!(sheets > 100, "{sheets}");
}

/// A vertex in a hexagon whose creases lead to its corners, with these letters, as a FOLD file without fold angles.
fn lettered(directions: &[f64], letters: &[&str]) -> Vec<u8> {
    let count = directions.len();
    let mut vertices = vec![[0.0, 0.0]];
    vertices.extend(directions.iter().map(|direction| [libm::cos(*direction), libm::sin(*direction)]));
    let mut edges: Vec<[usize; 2]> = (1..=count).map(|k| [0, k]).collect();
    edges.extend((1..=count).map(|k| [k, k % count + 1]));
    let assignment = [letters, vec!["B"; count].as_slice()].concat();
    let file = serde_json::json!({
        "vertices_coords": vertices,
        "edges_vertices": edges,
        "edges_assignment": assignment,
    });
    file.to_string().into_bytes()
}

/// A vertex with sectors of 60, 100, 120 and 80 degrees folds with 4 of its 16 assignments: those of the two ways in which
/// opposite creases fold alike, seen from either side. On each the tangents of half the angles are in a known proportion
/// (Huffman 1976; Lang 2018).
#[test]
fn mountains_and_valleys_alone_say_how_a_vertex_of_four_creases_folds() {
    let (a, b) = (60f64.to_radians(), 100f64.to_radians());
    let ratios = [
        libm::sin((b - a) / 2.0) / libm::sin((a + b) / 2.0),
        libm::cos((a + b) / 2.0) / libm::cos((b - a) / 2.0),
    ];
    let directions = [0.0, 60.0, 160.0, 280.0_f64].map(f64::to_radians);
    let mut found = [0, 0];
    for bits in 0..16_usize {
        let letters = [0, 1, 2, 3].map(|k| if bits >> k & 1 == 1 { "M" } else { "V" });
        let program = "use std.mori.Polygon
let sheet = fold_sheet(load_creases(\"c.fold\", scale: 100mm, fold: 80deg), module: Polygon(thickness: 3mm))
for angle in sheet.angles { print(angle / 1deg) }";
        let (printed, said) = with_file(program, "c.fold", &lettered(&directions, &letters));
        if !said.is_empty() {
            assert!(said.len() == 1 && said[0].starts_with("E0803"), "{said:?}");
            assert!(said[0].contains("fold one of them the other way"), "{said:?}");
            continue;
        }
        let mut angles: Vec<f64> = printed.iter().map(|angle| angle.parse().expect("a number")).collect();
        let mountains = angles.iter().filter(|angle| **angle > 0.0).count();
        assert_eq!(mountains, letters.iter().filter(|letter| **letter == "M").count());
        angles.iter_mut().for_each(|angle| *angle = angle.abs());
        angles.sort_by(f64::total_cmp);
        let narrow = ratios.map(|ratio| 2.0 * libm::atan(libm::tan(40f64.to_radians()) * ratio).to_degrees());
        let way = narrow.iter().position(|narrow| (narrow - angles[0]).abs() < 1e-3);
        found[way.unwrap_or_else(|| panic!("{letters:?}: {angles:?} is not {narrow:?}"))] += 1;
        assert!(
            (angles[1] - angles[0]).abs() < 1e-3
                && (angles[2] - 80.0).abs() < 1e-3
                && (angles[3] - 80.0).abs() < 1e-3
        );
    }
    assert_eq!(found, [2, 2]);
}

/// A pattern without fold angles wants one, a crease folds by less than half a turn, and what stays flat does not fold.
#[test]
fn mountains_and_valleys_alone_want_an_angle() {
    let directions = [0.0, 60.0, 160.0, 280.0_f64].map(f64::to_radians);
    let refused = |program: &str, letters: [&str; 4], words: &[&str]| {
        let (_, said) = with_file(program, "c.fold", &lettered(&directions, &letters));
        assert!(said.len() == 1 && words.iter().all(|word| said[0].contains(word)), "{words:?}: {said:?}");
    };
    let folds = ["M", "V", "M", "M"];
    refused(
        "print(faces(load_creases(\"c.fold\")))",
        folds,
        &["E0703", "edge 0 has no fold angle", "fold: 60deg"],
    );
    refused("print(faces(load_creases(\"c.fold\", fold: 180deg)))", folds, &["E0506", "less than 180"]);
    refused("print(faces(load_creases(\"c.fold\", fold: 0deg)))", folds, &["E0506"]);
    refused(
        "print(faces(load_creases(\"c.fold\", fold: 60deg)))",
        ["F"; 4],
        &["E0803", "no crease is a mountain"],
    );
    refused(
        "print(faces(load_creases(\"c.vector\")))",
        folds,
        &["E0703", "no crease pattern file by its name", "`.svg`"],
    );
}
