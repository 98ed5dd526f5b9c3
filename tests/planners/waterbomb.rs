//! The waterbomb: a vertex of six creases, of which four fold alike one way and two in line the other way; and sheets of
//! such vertices.
//!
//! The sectors are α, π - 2α, α, α, π - 2α, α from a crease in line on. In the form that is its own mirror image in two
//! planes, let e be the angle by which the middles of the wide sectors are lifted. A quarter of the sphere about the vertex
//! is the triangle of such a middle M, the crease D beside it and the crease H in line, with sides π/2 - α and α. M lies in
//! the one mirror plane, H in the other, and the arc from M to D is perpendicular to the first. Lifted by f, H has the
//! angle α to D where tan(f/2) = tan(α) sin(e). The component of D perpendicular to H that leaves the plane is
//! sin(α) cos(e), so the crease in line folds by h = 2e. The cosine rule for the angle at D gives cos(δ) =
//! 1 - sin(e) sin(f) / (sin(α) cos(α)), which with the former is tan(δ/2) = tan(h/2) / cos(α).

use crate::language::interpret::ran;
use crate::support::suite::MapFiles;
use modl::formats::CREASE_FORMATS;
use modl::geometry::Vec3;
use modl::interpret::{Mode, Options};
use modl::planners::fold::Target;
use modl::planners::fold_sheet::path::from_flat;
use modl::planners::fold_sheet::{Loops, assigned, folded};
use std::f64::consts::PI;

/// The angle of the four creases that fold alike where those in line fold by `in_line`, rad.
fn others(in_line: f64, sector: f64) -> f64 {
    2.0 * libm::atan(libm::tan(in_line / 2.0) / libm::cos(sector))
}

/// The flat vertex with the creases in line along x, and fold angles by their directions: `[in line, others]`, rad.
fn vertex(sector: f64, folds: [f64; 2]) -> (Target, Vec<f64>) {
    let directions = [0.0, sector, PI - sector, PI, PI + sector, -sector];
    let mut corners = vec![Vec3::zeros()];
    corners.extend(directions.map(|a| Vec3::new(libm::cos(a), libm::sin(a), 0.0)));
    let faces: Vec<Vec<usize>> = (1..7).map(|k| vec![0, k, k % 6 + 1]).collect();
    let flat = Target::new(corners, &faces).expect("it is flat");
    let angle = |hinge: &modl::planners::fold::Hinge| {
        let in_line = hinge.axis.y.abs() < 1e-12;
        if in_line { -folds[0] } else { folds[1] }
    };
    let angles = flat.hinges.iter().map(angle).collect();
    (flat, angles)
}

/// The closed form closes the loop, and the way from flat stays on it, though the vertex could fold in three ways at once.
#[test]
fn a_waterbomb_vertex_folds_as_spherical_trigonometry_says() {
    for (sector, in_line) in [(45.0_f64, 40.0_f64), (35.0, 70.0), (60.0, 25.0), (45.0, 90.0)] {
        let (sector, in_line) = (sector.to_radians(), in_line.to_radians());
        let (flat, angles) = vertex(sector, [in_line, others(in_line, sector)]);
        let loops = Loops::of(&flat).expect("it is a sheet");
        assert!(loops.gap(&angles) < 1e-12, "{}", loops.gap(&angles));
        let way = from_flat(&loops, &angles).expect("a way leads there");
        assert_eq!(way.freedom, 3);
        let is_in_line = |crease: usize| flat.hinges[crease].axis.y.abs() < 1e-12;
        for place in &way.places[1..] {
            let at = |kind: bool| (0..6).filter(move |k| is_in_line(*k) == kind).map(|k| place.angles[k]);
            let here: Vec<f64> = at(true).collect();
            let apart = here[0] - here[1];
            assert!(
                here.len() == 2 && here[0] < 0.0 && apart.abs() < 1e-7,
                "{apart} apart at {}",
                place.part
            );
            let wanted = others(-here[0], sector);
            for found in at(false) {
                assert!((found - wanted).abs() < 2e-4 * wanted, "{found} is not {wanted} at {}", place.part);
            }
        }
    }
}

/// The form that is sought by mountains and valleys alone is the same one.
#[test]
fn a_waterbomb_vertex_is_found_by_its_mountains_and_valleys() {
    for (sector, wide) in [(45.0_f64, 60.0_f64), (35.0, 110.0), (60.0, 150.0)] {
        let (sector, wide) = (sector.to_radians(), wide.to_radians());
        let (flat, letters) = vertex(sector, [1.0, 1.0]);
        let found = assigned(&flat, &letters, wide).expect("it folds");
        let in_line = 2.0 * libm::atan(libm::tan(wide / 2.0) * libm::cos(sector));
        let (_, wanted) = vertex(sector, [in_line, wide]);
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-7, "{found} is not {wanted}");
        }
        // Folded the other way at one crease, no form has these letters; all of them turned over, the same one.
        let over: Vec<f64> = letters.iter().map(|letter| -letter).collect();
        let turned = assigned(&flat, &over, wide).expect("it folds");
        assert!(turned.iter().zip(&found).all(|(a, b)| (a + b).abs() < 1e-7));
        assert!(assigned(&flat, &[1.0; 6], wide).is_err());
    }
}

/// A drawing that states the angles by opacity folds by them, and one that states none finds them.
#[test]
fn a_drawn_waterbomb_folds() {
    let in_line = 50f64.to_radians();
    let wide = others(in_line, PI / 4.0);
    let drawing = |opacities: [f64; 2]| {
        format!(
            "<svg><rect width='200' height='200' stroke='black' fill='none'/>\
             <path d='M0 0L200 200M0 200L200 0' stroke='red' opacity='{}'/>\
             <path d='M0 100H200' stroke='blue' opacity='{}'/></svg>",
            opacities[0], opacities[1]
        )
    };
    let folded = |drawing: String, fold: String| {
        let program = format!(
            "use std.mori.Polygon
let sheet = fold_sheet(load_creases(\"c.svg\"{fold}), module: Polygon(thickness: 3mm))
print(sheet.panels, sheet.creases, sheet.loops, sheet.freedom, verify(sheet).ok, verify(reverse(sheet)).ok)
for angle in sheet.angles {{ print(angle / 1rad) }}"
        );
        let mut project = MapFiles::of(&program);
        project.0.insert("c.svg".to_owned(), drawing.into_bytes());
        let done = ran(&project, "main.mod", Mode::Run, &Options::default());
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        assert_eq!(done.host.printed[0], "6 6 1 3 true true");
        let mut angles: Vec<f64> =
            done.host.printed[1..].iter().map(|angle| angle.parse().expect("a number")).collect();
        angles.sort_by(f64::total_cmp);
        angles
    };
    let wanted = [-in_line, -in_line, wide, wide, wide, wide];
    let stated = folded(drawing([wide / PI, in_line / PI]), String::new());
    let sought = folded(drawing([1.0, 1.0]), format!(", fold: {}deg", wide.to_degrees()));
    for found in [stated, sought] {
        assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} is not {wanted:?}");
    }
}

/// Cells of a waterbomb tessellation, two units wide and high, every second row by half a cell aside: mountains along their
/// diagonals, valleys across and between them.
fn tessellation(rows: usize, columns: usize) -> String {
    let (width, height) = (2 * columns, 2 * rows);
    let mut lines = String::new();
    for row in 0..rows {
        let (top, middle, bottom) = (2 * row, 2 * row + 1, 2 * row + 2);
        for half in 0..width {
            // From the corner of a cell to its centre, or from its centre to its corner.
            let from_corner = (half + row) % 2 == 0;
            for edge in [top, bottom] {
                let (from, to) = if from_corner { (edge, middle) } else { (middle, edge) };
                lines += &format!("M{half} {from}L{} {to}", half + 1);
            }
        }
    }
    let across: String = (1..width).map(|x| format!("M{x} 0V{height}")).collect();
    let between: String = (1..rows).map(|row| format!("M0 {}H{width}", 2 * row)).collect();
    format!(
        "<svg><rect width='{width}' height='{height}' stroke='black'/><path stroke='red' d='{lines}'/>\
         <path stroke='blue' d='{across}{between}'/></svg>"
    )
}

/// The loops of a tessellation close together: in the folded form every face has the sides and the shape that it has in the
/// flat sheet, its mountains and valleys are those that were drawn, and it folds before the judge.
#[test]
fn a_tessellation_of_waterbombs_closes_all_its_loops() {
    let svg = CREASE_FORMATS.iter().find(|format| format.ending == "svg").expect("it is read");
    for (rows, columns, panels, loops) in [(2, 2, 24, 6), (3, 2, 36, 11)] {
        let drawing = tessellation(rows, columns);
        let sheet = (svg.read)(drawing.as_bytes()).expect("it is read");
        let corners = sheet.vertices.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        let flat = Target::new(corners, &sheet.faces).expect("it is flat");
        let ends = |hinge: &modl::planners::fold::Hinge| {
            let corners = &flat.faces[hinge.faces[0]];
            let (a, b) = (corners[hinge.sides[0]], corners[(hinge.sides[0] + 1) % corners.len()]);
            [a.min(b), a.max(b)]
        };
        let letters: Vec<f64> = flat.hinges.iter().map(|hinge| sheet.angles[&ends(hinge)]).collect();
        let angles = assigned(&flat, &letters, 60f64.to_radians()).expect("it folds");
        assert!(angles.iter().zip(&letters).all(|(angle, letter)| angle * letter > 0.0));
        assert!(
            (angles.iter().map(|angle| angle.abs()).fold(0.0, f64::max) - 60f64.to_radians()).abs() < 1e-7
        );
        let there = folded(&flat, &angles).expect("it closes");
        for face in &flat.faces {
            for (k, a) in face.iter().enumerate() {
                for b in &face[..k] {
                    let (far, before) =
                        ((there[*a] - there[*b]).norm(), (flat.vertices[*a] - flat.vertices[*b]).norm());
                    assert!((far - before).abs() < 1e-8, "a face is {far} wide, not {before}");
                }
            }
        }
        let program = "use std.mori.Polygon
let sheet = fold_sheet(load_creases(\"c.svg\", scale: 50mm, fold: 60deg), module: Polygon(thickness: 3mm))
print(sheet.panels, sheet.loops, sheet.opening < 0.001deg, verify(sheet).ok)";
        let mut project = MapFiles::of(program);
        project.0.insert("c.svg".to_owned(), drawing.into_bytes());
        let done = ran(&project, "main.mod", Mode::Run, &Options::default());
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        assert_eq!(done.host.printed, [format!("{panels} {loops} true true")]);
    }
}
