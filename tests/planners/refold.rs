//! From shape to shape through a flat sheet: the plan passes the judge, ends as the second shape, and
//! changes as many connections as it says.

use crate::language::interpret::{Ran, run_text};
use crate::planners::fold::target;
use modl::geometry::Part;
use modl::geometry::{Pose, Vec3};
use modl::interpret::Mode;
use modl::optimize::random::SplitMix64;
use modl::plan::{Body, DockingKind, Plan, Tracks};
use modl::planners::fold::Observer;
use modl::planners::fold::pattern::{Pattern, lattice_corners};
use modl::planners::fold::sweep_collision::Solids;
use modl::planners::fold::{Target, enumerate};
use modl::planners::refold::lattice_sheet::{Corners, LatticeSheet, across, bond, cell};
use modl::planners::refold::rearrangement::{Goal, PanelSolids};
use modl::planners::refold::sheets::{Found, NoRefolding, Settings};
use modl::planners::refold::walks::walked;
use modl::robot::Kinematics;
use std::collections::BTreeSet;

const SETTINGS: Settings = Settings { budget: 200_000, seed: 0, kept: 4 };

/// Returns panels that are almost triangles; the middle of side 0 is on the x axis.
fn plates(count: usize) -> Solids {
    let corner = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        Vec3::new(cosine, sine, 0.0) * (0.98 * 0.08 / libm::sqrt(3.0))
    };
    let plate = Part::points(&[corner(-60.0), corner(60.0), corner(180.0), Vec3::new(0.0, 0.0, 1e-5)]);
    Solids { parts: vec![vec![plate]; count], touch: 1e-5 }
}

fn sheets(from: &Target, to: &Target) -> Result<Found, NoRefolding> {
    let solids = plates(from.faces.len());
    modl::planners::refold::sheets::sheets(from, to, &solids, &SETTINGS, |_| 0.0, &Observer::none())
}

fn run(from: &str, to: &str, rest: &str) -> Ran {
    run_text(
        &format!(
            "use std.mori.Mori
use std.shapes.{{tetrahedron, octahedron, boat, icosahedron, tube}}
let there = refold({from}, {to}, module: Mori{rest})
print(there.changes, there.bound, there.becomes)
emit(there, \"there.plan.json\")
"
        ),
        Mode::Run,
    )
}

fn plan(ran: &Ran) -> Plan {
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
    let text = String::from_utf8_lossy(&ran.host.written["there.plan.json"]);
    modl::plan::file::read(&text).expect("it reads back")
}

/// Middles of the edges that meet in a shape: pairs of (face, side).
fn edges(target: &Target) -> Vec<[(usize, usize); 2]> {
    target.hinges.iter().map(|h| [(h.faces[0], h.sides[0]), (h.faces[1], h.sides[1])]).collect()
}

/// Middles of all panels, m.
fn panels(tracks: &Tracks, end: bool) -> Vec<Vec3> {
    let state = if end { tracks.end() } else { tracks.start.clone() };
    let robot = &tracks.robot;
    let kinematics = Kinematics::new(robot, &state.bonds, robot.base);
    let mut poses = vec![Pose::identity(); kinematics.link_count()];
    kinematics.link_poses(&state.joints, &Pose::identity(), &mut poses);
    (0..robot.modules.len()).map(|m| poses[kinematics.link(m, 0)].translation.vector).collect()
}

/// Middles of faces with sides of 80 mm, m.
fn middles(points: &[Vec3], faces: &[[usize; 3]]) -> Vec<Vec3> {
    faces.iter().map(|f| f.iter().map(|v| points[*v]).sum::<Vec3>() * (0.08 / 3.0)).collect()
}

/// Whether two lists of places have the same distances, m.
fn same_shape(a: &[Vec3], b: &[Vec3]) -> bool {
    let pairs = (0..a.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    a.len() == b.len()
        && pairs.into_iter().all(|(i, j)| ((a[i] - a[j]).norm() - (b[i] - b[j]).norm()).abs() < 1e-9)
}

#[test]
fn a_shape_becomes_another_and_the_judge_agrees() {
    let ran = run("octahedron(edge: 80mm)", "boat(edge: 80mm)", "");
    let plan = plan(&ran);
    assert!(modl::plan::verify::verify(&plan).ok());
    let Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
    let r = std::f64::consts::FRAC_1_SQRT_2;
    let octahedron =
        [[r, 0., 0.], [-r, 0., 0.], [0., r, 0.], [0., -r, 0.], [0., 0., r], [0., 0., -r]].map(Vec3::from);
    let faces = [[0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3]];
    assert!(same_shape(&panels(tracks, false), &middles(&octahedron, &faces)));
    // Three tetrahedra about the edge between the first two points.
    let mut boat = vec![Vec3::new(0., 0., 0.5), Vec3::new(0., 0., -0.5)];
    boat.extend((0..4).map(|i| {
        let (sine, cosine) = libm::sincos(f64::from(i) * libm::acos(1.0 / 3.0));
        Vec3::new(cosine, sine, 0.0) * libm::sqrt(0.75)
    }));
    let faces = [[2, 0, 1], [0, 2, 3], [0, 3, 4], [0, 4, 5], [1, 3, 2], [1, 4, 3], [1, 5, 4], [5, 1, 0]];
    let faces = middles(&boat, &faces);
    let (numbers, becomes) = ran.host.printed[0].split_once('[').expect("a list");
    let becomes = becomes.trim_end_matches(']').split(", ").map(|f| f.parse::<usize>().expect("a face"));
    let wanted: Vec<Vec3> = becomes.map(|face| faces[face]).collect();
    assert!(same_shape(&panels(tracks, true), &wanted));
    let docks = |kind: DockingKind| tracks.events.iter().filter(|d| d.kind == kind).count();
    let changes: usize = numbers.split(' ').next().expect("a number").parse().expect("a number");
    assert_eq!((docks(DockingKind::Dock), docks(DockingKind::Undock)), (changes, changes));
}

/// Panels that lie in one plane: a connection goes and another comes at the same instant.
#[test]
fn a_change_of_connections_passes_the_judge() {
    let mut files = crate::support::suite::MapFiles::of(
        "use std.mori.Mori
let there = refold(load_mesh(\"a.off\", scale: 80mm), load_mesh(\"b.off\", scale: 80mm), module: Mori)
print(there.changes, there.bound)
emit(there, \"there.plan.json\")
",
    );
    for (name, open) in [("a.off", 2), ("b.off", 3)] {
        let Target { vertices, faces, .. } = fan_with_tail(open);
        let mut text = format!("OFF {} {} 0\n", vertices.len(), faces.len());
        vertices.iter().map(|v| v / 0.08).for_each(|v| text += &format!("{} {} {}\n", v.x, v.y, v.z));
        faces.iter().for_each(|f| text += &format!("3 {} {} {}\n", f[0], f[1], f[2]));
        files.0.insert(name.to_owned(), text.into_bytes());
    }
    let ran =
        crate::language::interpret::ran(&files, "main.mod", Mode::Run, &modl::interpret::Options::default());
    let plan = plan(&ran);
    assert_eq!(ran.host.printed, ["1 1"]);
    assert!(modl::plan::verify::verify(&plan).ok());
    let Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
    assert_eq!(
        tracks.events.iter().map(|d| d.kind).collect::<Vec<_>>(),
        [DockingKind::Dock, DockingKind::Undock]
    );
    assert_eq!(tracks.events[0].time, tracks.events[1].time);
}

#[test]
fn plans_reverse_and_shapes_return() {
    let text = "use std.mori.Mori
use std.shapes.{octahedron, boat}
let there = refold(octahedron(edge: 80mm), boat(edge: 80mm), module: Mori)
emit(reverse(there), \"back.plan.json\")
emit(there ++ reverse(there), \"both.plan.json\")
";
    let ran = run_text(text, Mode::Run);
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
}

/// The sheets themselves: both layouts cover the same cells, and as many connections differ as said.
#[test]
fn both_layouts_of_a_sheet_cover_the_same_cells() {
    for (from, to) in
        [("octahedron", "octahedron"), ("snub_disphenoid", "snub_disphenoid"), ("icosahedron", "icosahedron")]
    {
        let (from, to) = (target(from), target(to));
        let found = sheets(&from, &to).expect("a shape has a sheet in common with itself");
        assert_eq!((found.best[0].strokes.len(), found.bound), (0, 0));
        for sheet in &found.best {
            check(&from, &to, sheet);
        }
    }
}

fn check(from: &Target, to: &Target, sheet: &modl::planners::refold::sheets::Refolding) {
    let n = from.faces.len();
    let mut faces = sheet.becomes.clone();
    faces.sort_unstable();
    assert_eq!(faces, (0..n).collect::<Vec<_>>(), "every face once");
    let first = lattice_corners(from, &sheet.from);
    let second = lattice_corners(to, &sheet.to);
    assert!(Pattern::of(from, &sheet.from).overlaps().is_empty());
    assert!(Pattern::of(to, &sheet.to).overlaps().is_empty());
    // Both hang at one panel, so a turn about it by thirds lays one on the other.
    let root = sheet.from.root;
    assert_eq!(sheet.becomes[root], sheet.to.root);
    let turned = |[i, j]: [i64; 2], times: usize| (0..times).fold([i, j], |[i, j], _| [1 - i - j, i]);
    let times = (0..3)
        .find(|times| {
            (0..3).all(|k| {
                let side = (k + sheet.turns[root]) % 3;
                turned(second[sheet.to.root][side], *times) == first[root][k]
            })
        })
        .expect("the root's sides correspond");
    for panel in 0..n {
        for k in 0..3 {
            let there = second[sheet.becomes[panel]][(k + sheet.turns[panel]) % 3];
            assert_eq!(turned(there, times), first[panel][k], "panel {panel}");
        }
    }
    let bonds_from: Vec<[(usize, usize); 2]> =
        sheet.from.hinges().into_iter().map(|h| edges(from)[h]).collect();
    let own = |(face, side): (usize, usize)| {
        let panel = sheet.becomes.iter().position(|f| *f == face).expect("a panel");
        (panel, sheet.side(panel, side))
    };
    let bonds_to = sheet.to.hinges().into_iter().map(|h| edges(to)[h].map(own));
    let new = bonds_to.filter(|[a, b]| !bonds_from.contains(&[*a, *b]) && !bonds_from.contains(&[*b, *a]));
    assert_eq!(new.count(), sheet.strokes.len());
}

#[test]
fn sheets_of_different_numbers_of_panels_are_refused() {
    let (from, to) = (target("tetrahedron"), target("octahedron"));
    assert_eq!(sheets(&from, &to).err(), Some(NoRefolding::Counts));
}

/// The middles of the panels are those of the faces at both ends, and the others hang on in a flat strip: straight on, its
/// middles are two thirds of a panel's height, a side by the root of three, from each other.
#[test]
fn panels_that_are_too_many_hang_on_in_a_flat_strip() {
    let tetrahedron = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    let four: Vec<Vec3> = tetrahedron.map(|p| Vec3::from(p) / libm::sqrt(8.0)).to_vec();
    let four = middles(&four, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);
    for (from, to, all, few_at_end) in [
        ("tetrahedron", "octahedron", 8, false),
        ("octahedron", "tetrahedron", 8, true),
        ("boat", "tetrahedron", 8, true),
    ] {
        let ran = run(&format!("{from}(edge: 80mm)"), &format!("{to}(edge: 80mm)"), "");
        let plan = plan(&ran);
        assert!(modl::plan::verify::verify(&plan).ok());
        let Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
        let (_, becomes) = ran.host.printed[0].split_once('[').expect("a list");
        let becomes = becomes.trim_end_matches(']').split(", ").map(|f| f.parse().expect("a face"));
        let becomes: Vec<usize> = becomes.collect();
        let places = panels(tracks, few_at_end);
        assert_eq!(places.len(), all);
        // By the number of the face in the shape with fewer.
        let mut faces = places.clone();
        if few_at_end {
            becomes.iter().zip(&places).for_each(|(face, place)| faces[*face] = *place);
        }
        let distances = |list: &[Vec3]| {
            let pairs = (0..list.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
            let mut found: Vec<f64> = pairs.map(|(i, j)| (list[i] - list[j]).norm()).collect();
            found.sort_by(f64::total_cmp);
            found
        };
        let (found, wanted) = (distances(&faces[..4]), distances(&four));
        assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {wanted:?}");
        for pair in faces[4..].windows(2) {
            assert!(((pair[1] - pair[0]).norm() - 0.08 / libm::sqrt(3.0)).abs() < 1e-9);
        }
        for three in faces[4..].windows(3) {
            assert!(((three[2] - three[0]).norm() - 0.08).abs() < 1e-9, "flat, and straight on");
        }
    }
}

/// A star of four triangles and a strip of four: the tetrahedron unfolds into both, but they cover
/// different cells, so no sheet is common to them.
#[test]
fn a_star_is_no_strip() {
    let lattice = |cells: &[[[i64; 2]; 3]]| {
        let mut points: Vec<[i64; 2]> = cells.iter().flatten().copied().collect();
        points.sort_unstable();
        points.dedup();
        let place = |p: &[i64; 2]| {
            let [i, j] = p.map(|x| x as f64);
            Vec3::new(0.08 * (i + j / 2.0), 0.08 * libm::sqrt(0.75) * j, 0.0)
        };
        let at = |p: &[i64; 2]| points.iter().position(|q| q == p).expect("it is one of them");
        let faces: Vec<Vec<usize>> = cells.iter().map(|c| c.iter().map(at).collect()).collect();
        Target::new(points.iter().map(place).collect(), &faces).expect("it folds")
    };
    let star = lattice(&[
        [[0, 0], [1, 0], [0, 1]],
        [[1, 0], [0, 0], [1, -1]],
        [[0, 1], [1, 0], [1, 1]],
        [[0, 0], [0, 1], [-1, 1]],
    ]);
    let strip = lattice(&[
        [[0, 0], [1, 0], [0, 1]],
        [[1, 0], [1, 1], [0, 1]],
        [[1, 0], [2, 0], [1, 1]],
        [[2, 0], [2, 1], [1, 1]],
    ]);
    // The tetrahedron unfolds into both.
    for flat in [&star, &strip] {
        let found = sheets(&target("tetrahedron"), flat).expect("there is one");
        assert_eq!((found.best[0].strokes.len(), found.bound), (0, 0));
        check(&target("tetrahedron"), flat, &found.best[0]);
    }
    // Star and strip have one layout each, and cover different cells: a panel moves.
    for target in [&star, &strip] {
        assert_eq!(enumerate::each(target, 9, |_| {}).expect("few faces").layouts, 1);
    }
    let found = sheets(&star, &strip).expect("a leaf goes about a corner of the star");
    assert_eq!((found.best[0].strokes.len(), found.bound), (1, 1));
    let stroke = &found.best[0].strokes[0];
    // Three panels close as the tetrahedron does.
    assert_eq!(stroke.fold.len(), 2);
    assert!((stroke.angle.abs() - libm::acos(-1.0 / 3.0)).abs() < 1e-12);
}

/// Six triangles round a point without the hinge at one spoke, and a seventh at the outside of one of
/// them: chains that turn the other way round the point cover the same cells.
fn fan_with_tail(open: usize) -> Target {
    let angle = |i: usize| std::f64::consts::FRAC_PI_3 * i as f64;
    let mut points = vec![Vec3::zeros()];
    points.extend((0..6).map(|i| Vec3::new(libm::cos(angle(i)), libm::sin(angle(i)), 0.0) * 0.08));
    // The corner at which it is open is there twice, so that the faces on its two sides have no hinge.
    let corner = |i: usize| if i == 6 { 7 } else { 1 + (open + i) % 6 };
    points.push(points[corner(0)]);
    points.push(points[1] + points[2]);
    let mut faces: Vec<Vec<usize>> = (0..6).map(|i| vec![0, corner(i), corner(i + 1)]).collect();
    faces.push(vec![2, 1, 8]);
    Target::new(points, &faces).expect("it folds")
}

/// Open at one spoke or the next: one change, and none is not enough.
#[test]
fn one_change_is_found_and_proved_necessary() {
    let (first, second) = (fan_with_tail(2), fan_with_tail(3));
    let found = sheets(&first, &second).expect("they cover the same cells");
    assert_eq!((found.best[0].strokes.len(), found.bound), (1, 1));
    check(&first, &second, &found.best[0]);
}

/// Shapes without a common sheet: panels go from one to the other in the plane, each time that a fan
/// closes and opens elsewhere, and the judge agrees.
#[test]
fn panels_walk_from_sheet_to_sheet() {
    let ran = run("icosahedron(edge: 80mm)", "tube(sides: 5, rings: 2, edge: 80mm)", "");
    let plan = plan(&ran);
    assert!(modl::plan::verify::verify(&plan).ok());
    let Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
    let printed: Vec<usize> =
        ran.host.printed[0].split(' ').take(2).map(|n| n.parse().expect("a number")).collect();
    let docks = |kind: DockingKind| tracks.events.iter().filter(|d| d.kind == kind).count();
    assert_eq!((docks(DockingKind::Dock), docks(DockingKind::Undock)), (printed[0], printed[0]));
    assert!(0 < printed[1] && printed[1] <= printed[0], "{printed:?}");
    let (middles, ends) = (panels(tracks, false), panels(tracks, true));
    // An icosahedron's middles are on a ball; those of a tube of five are in four rows of five heights.
    let centre = |places: &[Vec3]| places.iter().sum::<Vec3>() / places.len() as f64;
    let spread = |places: &[Vec3]| {
        let radii: Vec<f64> = places.iter().map(|p| (p - centre(places)).norm()).collect();
        radii.iter().copied().fold(0.0, f64::max) - radii.iter().copied().fold(f64::MAX, f64::min)
    };
    assert!(spread(&middles) < 1e-9 && spread(&ends) > 1e-3);
}

/// A random sheet of panels on the lattice: the corners of each, and the pairs of panels and sides that are joined as a tree.
fn random_sheet(random: &mut SplitMix64, count: usize) -> LatticeSheet {
    let mut below = |limit: usize| (random.next_u64() % limit as u64) as usize;
    let mut corners: Vec<Corners> = vec![[[0, 0], [1, 0], [0, 1]]];
    let mut bonds = BTreeSet::new();
    while corners.len() < count {
        let (panel, side) = (below(corners.len()), below(3));
        let new = across(&corners[panel], side);
        if corners.iter().all(|other| cell(other) != cell(&new)) {
            bonds.insert(bond((panel, side), (corners.len(), 0)));
            corners.push(new);
        }
    }
    LatticeSheet::new(corners, bonds)
}

/// Returns the pairs of cells whose panels are joined.
fn joined_cells(sheet: &LatticeSheet) -> BTreeSet<[[i64; 2]; 2]> {
    let named = sheet.bonds.iter().map(|bond| bond.map(|side| cell(&sheet.corners[side.0])));
    named.map(|[a, b]| if a < b { [a, b] } else { [b, a] }).collect()
}

/// Panels walk one by one from a random sheet to another: each stroke joins a tree again and moves no panel, or one about a
/// corner that it keeps, to a free cell beside others; in the end the cells and the connections are those of the goal.
#[test]
fn single_panels_walk_between_random_sheets() {
    let mut random = SplitMix64(80);
    let mut walks = 0;
    for count in [6, 12, 20, 30, 40, 12, 20, 30, 40] {
        let (start, end) = (random_sheet(&mut random, count), random_sheet(&mut random, count));
        let goal = Goal { cells: end.cells.keys().copied().collect(), bonds: joined_cells(&end) };
        let solids = plates(count);
        let panels = PanelSolids { solids: &solids, side: 0.08 };
        let Some((strokes, reached)) = walked(&start, &goal, panels, usize::MAX, &mut 20_000_000) else {
            continue;
        };
        walks += 1;
        let mut at = start.clone();
        for stroke in &strokes {
            let before = at.clone();
            at.apply(stroke);
            assert!(before.bonds.contains(&stroke.cut) && at.bonds.contains(&stroke.make));
            assert_eq!((at.bonds.len(), at.cells.len()), (count - 1, count));
            assert!((1..count).all(|panel| !at.path(0, panel).is_empty()), "one piece");
            match stroke.moved[..] {
                [] => assert_eq!(stroke.angle, 0.0),
                [(panel, corners)] => {
                    assert!(!before.cells.contains_key(&cell(&corners)));
                    let kept: Vec<usize> =
                        (0..3).filter(|k| before.corners[panel][*k] == corners[*k]).collect();
                    let [k] = kept[..] else { panic!("about one corner: {kept:?}") };
                    // The other corners stay at a distance of 1: of six points about it.
                    let about = corners[k];
                    for other in (0..3).filter(|other| *other != k) {
                        let [i, j] = [0, 1].map(|axis| corners[other][axis] - about[axis]);
                        assert_eq!(i * i + i * j + j * j, 1);
                    }
                    assert!(before.is_free(stroke, &solids, 0.08));
                }
                _ => panic!("more than one panel goes"),
            }
        }
        assert_eq!((&at.corners, &at.bonds), (&reached.corners, &reached.bonds));
        assert_eq!(at.cells.keys().copied().collect::<BTreeSet<_>>(), goal.cells);
        assert_eq!(joined_cells(&at), goal.bonds);
    }
    assert!(walks >= 4, "{walks} walks");
}

/// An icosahedron whose faces are four panels each becomes a tube of as many, 80: at the start 20 middles are those of faces, at the
/// inradius, and three are about each; at the end ten each are at eight heights, at one distance from the axis.
#[test]
fn eighty_panels_walk_to_a_tube() {
    let golden = (1.0 + libm::sqrt(5.0)) / 2.0;
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let mut vertices: Vec<Vec3> = signs.iter().map(|[a, b]| Vec3::new(0.0, *a, b * golden)).collect();
    vertices.extend(signs.iter().map(|[a, b]| Vec3::new(*a, b * golden, 0.0)));
    vertices.extend(signs.iter().map(|[a, b]| Vec3::new(b * golden, 0.0, *a)));
    let near =
        |i: usize, j: usize, vertices: &[Vec3]| ((vertices[i] - vertices[j]).norm() - 2.0).abs() < 1e-9;
    let mut faces = Vec::new();
    for (i, j, k) in (0..12).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| (i, j, k)))) {
        if near(i, j, &vertices) && near(j, k, &vertices) && near(i, k, &vertices) {
            let [a, b, c] = [i, j, k].map(|corner| vertices[corner]);
            let is_outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
            let corners = if is_outward { [a, b, c] } else { [a, c, b] };
            let [x, y, z] = [0, 1, 2].map(|k| (corners[k] + corners[(k + 1) % 3]) / 2.0);
            let [a, b, c] = corners;
            faces.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
        }
    }
    assert_eq!(faces.len(), 80);
    vertices.clear();
    let mut numbered = |p: &Vec3| {
        let known = vertices.iter().position(|other| (other - p).norm() < 1e-9);
        known.unwrap_or_else(|| {
            vertices.push(*p);
            vertices.len() - 1
        })
    };
    let faces: Vec<[usize; 3]> = faces.iter().map(|face| [0, 1, 2].map(|k| numbered(&face[k]))).collect();
    let mut text = format!("OFF {} {} 0\n", vertices.len(), faces.len());
    vertices.iter().for_each(|v| text += &format!("{} {} {}\n", v.x, v.y, v.z));
    faces.iter().for_each(|f| text += &format!("3 {} {} {}\n", f[0], f[1], f[2]));
    let mut files = crate::support::suite::MapFiles::of(
        "use std.mori.Mori
use std.shapes.tube
let there = refold(load_mesh(\"ico.off\", scale: 80mm), tube(sides: 10, rings: 4, edge: 80mm), module: Mori, budget: 200000)
print(there.changes, there.bound, there.why)
emit(there, \"there.plan.json\")
",
    );
    files.0.insert("ico.off".to_owned(), text.into_bytes());
    let ran =
        crate::language::interpret::ran(&files, "main.mod", Mode::Run, &modl::interpret::Options::default());
    let plan = plan(&ran);
    assert!(modl::plan::verify::verify(&plan).ok());
    let Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
    let changes: usize = ran.host.printed[0].split(' ').next().expect("a number").parse().expect("a number");
    let docks = |kind: DockingKind| tracks.events.iter().filter(|d| d.kind == kind).count();
    assert_eq!((docks(DockingKind::Dock), docks(DockingKind::Undock)), (changes, changes));
    let squares = |end: bool| {
        let places = panels(tracks, end);
        let centre = places.iter().sum::<Vec3>() / places.len() as f64;
        let mut squares: Vec<f64> = places.iter().map(|p| (p - centre).norm_squared()).collect();
        squares.sort_by(f64::total_cmp);
        squares
    };
    let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    // Faces with sides of 160 mm at the inradius; the middles of the outer panels are a side by the root of three from it.
    let (side, inradius) = (0.08_f64, 0.16 * golden * golden / (2.0 * libm::sqrt(3.0)));
    let inner = inradius * inradius;
    let start = squares(false);
    assert!(start[..20].iter().all(|s| is_near(*s, inner)), "{start:?}");
    assert!(start[20..].iter().all(|s| is_near(*s, inner + side * side / 3.0)), "{start:?}");
    // A ring is an antiprism of ten sides; middles are at a third and two thirds of its height.
    let radius = side / (2.0 * libm::sin(std::f64::consts::PI / 10.0));
    let chord = 2.0 * radius * libm::sin(std::f64::consts::PI / 20.0);
    let height_squared = side * side - chord * chord;
    let end = squares(true);
    for (group, thirds) in [1.0, 2.0, 4.0, 5.0].into_iter().enumerate() {
        let above = end[0] + (thirds * thirds - 1.0) / 9.0 * height_squared;
        assert!(end[20 * group..20 * (group + 1)].iter().all(|s| is_near(*s, above)), "{end:?}");
    }
}
