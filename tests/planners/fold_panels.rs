//! Surfaces of other faces than triangles: counts of nets and sums that are known, and random frusta of any polygon,
//! against every layout.

use crate::language::interpret::{ran, run_text};
use crate::planners::fold::{MASS, near};
use crate::support::properties::whole;
use crate::support::suite::MapFiles;
use modl::geometry::Vec3;
use modl::interpret::{Mode, Options};
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::inertia::{Inertia, moment_about};
use modl::planners::fold::pattern::Pattern;
use modl::planners::fold::{
    Layout, Net, Observer, Plate, Proof, SIDES_MAX, TOLERANCES, Target, Unfoldable, Weights,
    branch_and_bound, spanning_trees,
};
use num_traits::ToPrimitive;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;

const SIDE: f64 = 0.08;

fn points(list: &[[f64; 3]], scale: f64) -> Vec<Vec3> {
    list.iter().map(|p| Vec3::from(*p) * scale).collect()
}

fn cube() -> Target {
    let corners: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|x| x as f64)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .map(|f| f.to_vec());
    Target::new(points(&corners, SIDE), &faces).expect("it folds")
}

fn octahedron() -> Target {
    let corners: Vec<Vec3> = (0..6).map(|k| Vec3::ith(k / 2, [SIDE, -SIDE][k % 2])).collect();
    let faces = [[0, 2, 4], [0, 5, 2], [0, 4, 3], [0, 3, 5], [1, 4, 2], [1, 2, 5], [1, 3, 4], [1, 5, 3]];
    Target::new(corners, &faces.map(|f| f.to_vec())).expect("it folds")
}

/// The solid whose corners are the middles of the faces of another: its faces go round the other's corners.
fn dual(target: &Target) -> Target {
    let faces = (0..target.vertices.len()).map(|vertex| {
        let mut round: Vec<usize> = Vec::new();
        let mut at = target.faces.iter().position(|face| face.contains(&vertex)).expect("it is a corner");
        while !round.contains(&at) {
            round.push(at);
            let (place, sides) = (
                target.faces[at].iter().position(|v| *v == vertex).expect("a corner"),
                target.faces[at].len(),
            );
            // Across the side that ends at the corner.
            let hinge = target.sides[at][(place + sides - 1) % sides].expect("it is closed");
            at = target.hinges[hinge].other(at);
        }
        round
    });
    let middles = (0..target.faces.len()).map(|face| target.centroid(face)).collect();
    Target::new(middles, &faces.collect::<Vec<_>>()).expect("it folds")
}

fn icosahedron() -> Target {
    let (_, shape) =
        crate::planners::fold::shapes().find(|(name, _)| *name == "icosahedron").expect("it is there");
    let (vertices, faces) = crate::planners::fold::mesh(shape);
    Target::new(vertices, &faces).expect("it folds")
}

/// Returns by isometry of the solid the image of each hinge: the first face and its first side go to any face and side, or to
/// their mirror images, and the middles of all hinges along with them.
fn isometries(target: &Target) -> Vec<Vec<usize>> {
    let middle = |hinge: usize| {
        let hinge = &target.hinges[hinge];
        let (face, side) = (hinge.faces[0], hinge.sides[0]);
        let corners = target.corners(face);
        (corners[side] + corners[(side + 1) % corners.len()]) / 2.0
    };
    let centre = target.vertices.iter().sum::<Vec3>() / target.vertices.len() as f64;
    let frame = |face: usize, side: usize, hand: f64| {
        let corners = target.corners(face);
        let z = target.normal(face);
        let x =
            ((corners[side] + corners[(side + 1) % corners.len()]) / 2.0 - target.centroid(face)).normalize();
        nalgebra::Matrix3::from_columns(&[x, z.cross(&x) * hand, z])
    };
    let from = frame(0, 0, 1.0);
    let mut found = Vec::new();
    for face in 0..target.faces.len() {
        for side in 0..target.faces[face].len() {
            for hand in [1.0, -1.0] {
                let turn = frame(face, side, hand) * from.transpose();
                let image = |hinge: usize| {
                    let place = centre + turn * (middle(hinge) - centre);
                    (0..target.hinges.len()).find(|other| (middle(*other) - place).norm() < 1e-9)
                };
                found.extend((0..target.hinges.len()).map(image).collect::<Option<Vec<usize>>>());
            }
        }
    }
    found
}

/// The number of layouts that no isometry makes of each other, by Burnside's lemma.
fn nets(target: &Target) -> u64 {
    const CHUNK: usize = 10;
    let group = isometries(target);
    // The images of the sets of ten hinges, so that a layout goes by three words.
    let table: Vec<Vec<u64>> = group
        .iter()
        .map(|images| {
            let chunks = images.chunks(CHUNK);
            let of_chunk = |chunk: &[usize]| -> Vec<u64> {
                let image = |bits: usize| {
                    chunk
                        .iter()
                        .enumerate()
                        .filter(|(k, _)| bits >> k & 1 == 1)
                        .map(|(_, to)| 1u64 << to)
                        .sum()
                };
                (0..1 << CHUNK).map(image).collect()
            };
            chunks.flat_map(of_chunk).collect()
        })
        .collect();
    let mut kept = 0u64;
    let all = enumerate::each(target, u64::MAX, |hinges| {
        let set: u64 = hinges.iter().map(|hinge| 1u64 << hinge).sum();
        for images in &table {
            let parts = images.chunks(1 << CHUNK).enumerate();
            let image: u64 =
                parts.map(|(k, part)| part[(set >> (k * CHUNK)) as usize & ((1 << CHUNK) - 1)]).sum();
            kept += u64::from(image == set);
        }
    });
    assert!(all.expect("few faces").complete);
    assert_eq!(kept % group.len() as u64, 0);
    kept / group.len() as u64
}

#[test]
fn the_cube_and_the_octahedron_have_eleven_nets() {
    for target in [cube(), octahedron(), dual(&octahedron())] {
        assert_eq!(isometries(&target).len(), 48);
        assert_eq!(spanning_trees::layouts(&target).to_u64(), Some(384));
        assert_eq!(nets(&target), 11);
    }
}

/// Bouzette and Vandamme, *The regular dodecahedron and icosahedron unfold in 43380 ways*. Its 5,184,000 layouts under 120
/// isometries are looked at where the whole is asked for.
#[test]
fn the_dodecahedron_has_as_many_nets_as_is_known() {
    let target = dual(&icosahedron());
    assert!(target.faces.iter().all(|face| face.len() == 5));
    assert_eq!(isometries(&target).len(), 120);
    assert_eq!(spanning_trees::layouts(&target).to_u64(), Some(5_184_000));
    if whole() {
        assert_eq!(nets(&target), 43_380);
    }
}

/// Horiyama and Shoji (2011): no net of a Platonic solid overlaps itself.
#[test]
fn nets_of_cubes_and_dodecahedra_lie_flat() {
    for (target, every) in [(cube(), 1), (dual(&icosahedron()), 5_003)] {
        let mut count = 0;
        let overlapping = |hinges: &[usize]| {
            let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
            !Pattern::of(&target, &layout).overlaps().is_empty()
        };
        let mut found = 0;
        let all = enumerate::each(&target, u64::MAX, |hinges| {
            count += 1;
            found += u64::from(count % every == 0 && overlapping(hinges));
        });
        assert!(all.expect("few faces").complete);
        assert_eq!(found, 0);
    }
}

/// The best layout of a cube is a cross. Of a square about its own side the moment is m a²/3; the face across, about the
/// sides between, has that about the one and m (a²/3 + a²) about the other.
#[test]
fn a_cube_folds_for_what_its_squares_weigh() {
    let target = cube();
    let weights = Weights::uniform(&target, MASS);
    let settings = branch_and_bound::Settings { root: Some(2), ..branch_and_bound::Settings::default() };
    let best = branch_and_bound::optimum(&target, &weights, &settings).expect("it has layouts");
    let least = 3.75 * PI / 2.0 * MASS * SIDE * SIDE * (5.0 / 3.0 + 4.0 / 3.0);
    assert_eq!(best.proof, Proof::Optimal);
    assert!(near(best.energy, least, 1e-9), "{} is not {least}", best.energy);
    let every = enumerate_energies(&target, &weights, &every(None), &Observer::none()).expect("few faces");
    assert!(near(every.least, least, 1e-12));
}

fn every(root: Option<usize>) -> enumerate::Settings {
    enumerate::Settings { root, spectrum: false, budget: u64::MAX }
}

#[test]
fn faces_that_no_panel_can_be_are_refused() {
    let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    let refused = |corners: &[[f64; 3]]| {
        let face = (0..corners.len()).collect();
        Target::new(points(corners, SIDE), &[face]).expect_err("it does not fold")
    };
    assert!(Target::new(points(&square, SIDE), &[vec![0, 1, 2, 3]]).is_ok());
    // One corner up by a tenth: those at both sides are a quarter of that off the mean plane, and so is it.
    let mut bent = square;
    bent[2][2] = 0.1;
    let Unfoldable::NotPlanar { face: 0, off, .. } = refused(&bent) else { panic!("it is bent") };
    assert!(near(off, 0.025 * SIDE, 0.02), "{off}");
    // Six digits are flat enough.
    bent[2][2] = 1e-6;
    assert!(Target::new(points(&bent, SIDE), &[vec![0, 1, 2, 3]]).is_ok());
    let mut dented = square;
    dented[2] = [0.4, 0.4, 0.];
    assert_eq!(refused(&dented), Unfoldable::NotConvex { face: 0, corner: 2 });
    // A straight corner, a star that goes round twice, and a bow tie.
    assert_eq!(
        refused(&[[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [0., 1., 0.]]),
        Unfoldable::NotConvex { face: 0, corner: 1 }
    );
    let star: Vec<[f64; 3]> =
        (0..5).map(|k| f64::from(k) * 4.0 * PI / 5.0).map(|a| [libm::cos(a), libm::sin(a), 0.]).collect();
    assert!(matches!(refused(&star), Unfoldable::NotConvex { face: 0, .. }));
    assert!(matches!(
        refused(&[[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 0.6, 0.]]),
        Unfoldable::NotConvex { face: 0, .. }
    ));
    let round = |n: usize| -> Vec<[f64; 3]> {
        let at = |k: usize| 2.0 * PI * k as f64 / n as f64;
        (0..n).map(|k| [libm::cos(at(k)), libm::sin(at(k)), 0.]).collect()
    };
    assert_eq!(
        refused(&round(SIDES_MAX + 1)),
        Unfoldable::Corners { face: 0, corners: SIDES_MAX + 1, limit: SIDES_MAX }
    );
    assert!(Target::new(points(&round(SIDES_MAX), SIDE), &[(0..SIDES_MAX).collect()]).is_ok());
}

/// A frustum: a polygon on a circle, drawn together towards an apex, so that all its sides are flat; open above or not.
fn frusta() -> impl Strategy<Value = Target> {
    let gaps = proptest::collection::vec(0.4..1.6_f64, 3..8);
    (gaps, -0.5..0.5_f64, -0.5..0.5_f64, 0.8..3.0_f64, 0.2..0.8_f64, proptest::bool::ANY).prop_map(
        |(gaps, x, y, height, part, is_open)| {
            let n = gaps.len();
            let whole: f64 = gaps.iter().sum();
            let angle = |k: usize| 2.0 * PI * gaps[..k].iter().sum::<f64>() / whole;
            let base: Vec<Vec3> =
                (0..n).map(|k| Vec3::new(libm::cos(angle(k)), libm::sin(angle(k)), 0.0) * SIDE).collect();
            let apex = Vec3::new(x, y, height) * SIDE;
            let top = base.iter().map(|p| p + (apex - p) * part);
            let corners: Vec<Vec3> = base.iter().copied().chain(top).collect();
            let mut faces: Vec<Vec<usize>> = vec![(0..n).rev().collect()];
            faces.extend((0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]));
            if !is_open {
                faces.push((n..2 * n).collect());
            }
            Target::new(corners, &faces).expect("it folds")
        },
    )
}

/// The signed distance of a point from the line from `a` to `b`, to its left.
fn left_of([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / libm::hypot(bx - ax, by - ay)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// The proof against every layout; what a face weighs about a line against a grid of points; nets against the faces.
    #[test]
    fn frusta_are_proved(target in frusta(), root in 0..9usize, line in proptest::array::uniform3(-1.0..1.0_f64)) {
        let root = root % target.faces.len();
        let masses: Vec<f64> = (0..target.faces.len()).map(|face| MASS * (1.0 + face as f64)).collect();
        let weights = Weights::new(&target, &masses, Inertia::Lamina);
        let settings = branch_and_bound::Settings {
            root: Some(root), ..branch_and_bound::Settings::default()
        };
        let best = branch_and_bound::optimum(&target, &weights, &settings).expect("it has layouts");
        let all = enumerate_energies(&target, &weights, &every(Some(root)), &Observer::none()).expect("few faces");
        prop_assert_eq!(best.proof, Proof::Optimal);
        prop_assert!((best.energy / all.least - 1.0).abs() < TOLERANCES.proof);
        prop_assert_eq!(Some(all.layouts), spanning_trees::layouts(&target).to_u64());

        // Small triangles about the first corner, each as a point.
        let corners = target.corners(0);
        let axis = Vec3::from(line).normalize();
        let (mut sum, mut area) = (0.0, 0.0);
        for k in 1..corners.len() - 1 {
            let (u, v) = (corners[k] - corners[0], corners[k + 1] - corners[0]);
            const PARTS: usize = 60;
            for i in 0..PARTS {
                for j in 0..PARTS - i {
                    // A small triangle and, but at the edge, the one that fills its parallelogram.
                    for (third, there) in [(1.0 / 3.0, true), (2.0 / 3.0, i + j + 1 < PARTS)] {
                        let at = corners[0] + (u * (i as f64 + third) + v * (j as f64 + third)) / PARTS as f64;
                        let part = if there { u.cross(&v).norm() } else { 0.0 };
                        sum += part * at.cross(&axis).norm_squared();
                        area += part;
                    }
                }
            }
        }
        let exact = moment_about(corners, MASS, Inertia::Lamina, &Vec3::zeros(), &axis);
        prop_assert!(near(exact, MASS * sum / area, 1e-3), "{} is not {}", exact, MASS * sum / area);

        // A net has the sides and angles of the faces; a face is to the left of its own sides.
        let net = Net::of(&target, &best.layout);
        for (face, places) in net.faces.iter().enumerate() {
            let flat: Vec<[f64; 2]> = places.iter().map(|place| net.vertices[*place]).collect();
            let solid = target.corners(face);
            for (a, b) in (0..flat.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
                let apart = libm::hypot(flat[a][0] - flat[b][0], flat[a][1] - flat[b][1]);
                prop_assert!((apart - (solid[a] - solid[b]).norm()).abs() < 1e-12);
            }
            let next = |k: usize| flat[(k + 1) % flat.len()];
            let inside = (0..flat.len()).all(|k| flat.iter().all(|p| left_of(flat[k], next(k), *p) > -1e-12));
            prop_assert!(inside);
        }
        // As many vertices as a disk has: each hinge shares two.
        let corners: usize = target.faces.iter().map(Vec::len).sum();
        prop_assert_eq!(net.vertices.len(), corners - 2 * (target.faces.len() - 1));
        let kinds = Plate { thickness: 1e-4, ..Plate::default() }.panels(&target).expect("they are thin");
        prop_assert_eq!(kinds.kinds.len(), target.faces.len());
    }
}

/// A solid as a file in each format that states polygons; `faces`: corners from 0.
fn files(corners: &[[f64; 3]], faces: &[Vec<usize>]) -> BTreeMap<String, Vec<u8>> {
    let rows = |first: usize, word: &str| -> String {
        let corner =
            |p: &[f64; 3]| format!("{}{} {} {}\n", if word == "f" { "v " } else { "" }, p[0], p[1], p[2]);
        let face = |f: &Vec<usize>| {
            let places: Vec<String> = f.iter().map(|v| (v + first).to_string()).collect();
            let head = if word == "f" { "f".to_owned() } else { f.len().to_string() };
            format!("{head} {}\n", places.join(" "))
        };
        corners.iter().map(corner).chain(faces.iter().map(face)).collect()
    };
    let (n, m) = (corners.len(), faces.len());
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {m}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let fold = serde_json::json!({ "file_spec": 1.2, "vertices_coords": corners, "faces_vertices": faces });
    BTreeMap::from([
        ("solid.obj".to_owned(), rows(1, "f").into_bytes()),
        ("solid.off".to_owned(), format!("OFF {n} {m} 0\n{}", rows(0, "")).into_bytes()),
        ("solid.ply".to_owned(), (head + &rows(0, "")).into_bytes()),
        ("solid.fold".to_owned(), fold.to_string().into_bytes()),
    ])
}

/// Every format gives the same layouts and energy, and the folded form that is written is read as the solid again.
#[test]
fn polygons_come_from_files_and_go_into_them() {
    let ball = dual(&icosahedron());
    for (target, layouts) in [(cube(), 384u64), (ball, 5_184_000)] {
        let corners: Vec<[f64; 3]> =
            target.vertices.iter().map(|p| [p.x, p.y, p.z].map(|x| x / SIDE)).collect();
        let mut program = String::from("use std.mori.Polygon\n");
        for (k, ending) in ["obj", "off", "ply", "fold"].iter().enumerate() {
            let scale = "80mm";
            program += &format!(
                "let f{k} = fold(load_mesh(\"solid.{ending}\", scale: {scale}), module: Polygon(thickness: 2mm), step: 2s, sequence: leaves_first)\n\
                 print(f{k}.layouts, f{k}.optimal, f{k}.layout.overlaps, verify(f{k}).ok, abs(f{k}.energy / f0.energy - 1) < 1e-9)\n"
            );
        }
        program += "save(f0, \"written.fold\")\n";
        let mut project = MapFiles::of(&program);
        project.0.extend(files(&corners, &target.faces));
        let done = ran(&project, "main.mod", Mode::Run, &Options::default());
        assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
        let wanted = format!("{layouts} true [] true true");
        assert_eq!(done.host.printed, vec![wanted; 4]);
        // Read back: millimetres, the folded form last.
        let mut again = MapFiles::of(
            "use std.mori.Polygon\nlet there = fold(load_mesh(\"written.fold\", scale: 1mm), module: Polygon(thickness: 2mm), step: 2s)\nprint(there.layouts, faces(load_mesh(\"written.fold\", scale: 1mm)))\n",
        );
        again.0.insert("written.fold".into(), done.host.written["written.fold"].clone());
        let back = ran(&again, "main.mod", Mode::Run, &Options::default());
        assert!(back.outcome.diagnostics.is_empty(), "{:?}", back.outcome.diagnostics);
        assert_eq!(back.host.printed, vec![format!("{layouts} {}", target.faces.len())]);
    }
}

/// The soccer ball has as many spanning trees as the graph of C60 (Brown, Mallion, Pollak and Roth 1996).
#[test]
fn a_soccer_ball_folds() {
    let done = run_text(
        "use std.mori.Polygon
use std.shapes.truncated_icosahedron
let ball = fold(truncated_icosahedron(edge: 80mm), module: Polygon)
print(ball.layouts, ball.layout.panels, ball.layout.overlaps, verify(ball).ok, ball.bound <= ball.energy)
",
        Mode::Run,
    );
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    assert_eq!(done.host.printed, ["375291866372898816000 32 [] true true"]);
}
