//! Panels that meet on the way: counts by another program for panels without thickness, found again
//! by samples, and the judge's word on panels with thickness.

use crate::fold::{SIDE, TRUTH, index, mesh, pairs, target};
use crate::interpret::run_text;
use modl::geometry::Vec3;
use modl::interpret::Mode;
use modl::planners::fold::folded::poses_at;
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::simulation::quintic;
use modl::planners::fold::{Layout, Target, Weights, enumerate, steps};
use std::fmt::Write;

/// The other program shrank triangles by this part, and looked at 24 to 40 states of each step.
const SHRUNK: f64 = 1e-3;
const SAMPLES: usize = 24;

type Triangle = [Vec3; 3];

/// Whether a plane across some axis has the triangles on its two sides.
fn parted(a: &Triangle, b: &Triangle) -> bool {
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (ea, eb) = (edges(a), edges(b));
    let (na, nb) = (ea[0].cross(&ea[1]), eb[0].cross(&eb[1]));
    let parts = |axis: Vec3| {
        let range = |t: &Triangle| {
            let d = t.map(|p| axis.dot(&p));
            (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
        };
        let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
        axis.norm_squared() > 1e-24 && (high_a < low_b || high_b < low_a)
    };
    let crossed = ea.iter().any(|u| eb.iter().any(|v| parts(u.cross(v))));
    crossed
        || parts(na)
        || parts(nb)
        || ea.iter().any(|u| parts(na.cross(u)))
        || eb.iter().any(|v| parts(nb.cross(v)))
}

/// Whether two panels meet while a layout is folded in these steps; with the step and the faces.
fn meets(target: &Target, layout: &Layout, steps: &[Vec<usize>]) -> Option<(usize, [usize; 2])> {
    let small: Vec<Triangle> = (0..target.faces.len())
        .map(|face| {
            let middle = target.centroid(face);
            target.corners(face).map(|c| middle + (c - middle) * (1.0 - SHRUNK))
        })
        .collect();
    let full = |face: usize| layout.hinge[face].map_or(0.0, |hinge| target.hinges[hinge].angle);
    let mut folded = vec![0.0; small.len()];
    for (number, step) in steps.iter().enumerate() {
        // Two panels move against each other where a hinge between them moves.
        let moves =
            |a: usize, b: usize| step.iter().any(|f| layout.is_above(*f, a) != layout.is_above(*f, b));
        for sample in 1..=SAMPLES {
            let part = quintic(sample as f64 / SAMPLES as f64, 1.0).angle;
            step.iter().for_each(|face| folded[*face] = full(*face) * part);
            let poses = poses_at(target, layout, |face| folded[face]);
            let placed: Vec<Triangle> = small
                .iter()
                .zip(&poses)
                .map(|(t, pose)| t.map(|p| pose.transform_point(&p.into()).coords))
                .collect();
            for b in 0..placed.len() {
                for a in (0..b).filter(|a| moves(*a, b)) {
                    if !parted(&placed[a], &placed[b]) {
                        return Some((number, [a, b]));
                    }
                }
            }
        }
    }
    None
}

/// How many layouts there are, and how many of them meet.
fn count(target: &Target, order: impl Fn(&Layout) -> Vec<Vec<usize>>) -> [usize; 2] {
    let mut found = [0, 0];
    enumerate::each(target, u64::MAX, |hinges| {
        let layout = Layout::of_hinges(target, hinges, 0).expect("a tree");
        found[0] += usize::from(meets(target, &layout, &order(&layout)).is_some());
        found[1] += 1;
    })
    .expect("few faces");
    found
}

/// Ten regular triangles, five about each of two points.
fn pentagonal_bipyramid() -> Target {
    let turn = std::f64::consts::TAU / 5.0;
    let radius = 0.5 * SIDE / libm::sin(turn / 2.0);
    let height = libm::sqrt(SIDE * SIDE - radius * radius);
    let mut points: Vec<Vec3> = (0..5)
        .map(|i| {
            Vec3::new(radius * libm::cos(turn * f64::from(i)), radius * libm::sin(turn * f64::from(i)), 0.0)
        })
        .collect();
    points.extend([Vec3::new(0.0, 0.0, height), Vec3::new(0.0, 0.0, -height)]);
    let faces: Vec<Vec<usize>> =
        (0..5).flat_map(|i| [vec![i, (i + 1) % 5, 5], vec![(i + 1) % 5, i, 6]]).collect();
    Target::new(points, &faces).expect("it folds")
}

#[test]
fn as_many_layouts_collide_as_another_program_found() {
    let truth = &TRUTH["collisions"];
    let octahedron = target("octahedron");
    let leaves = |layout: &Layout| steps::leaves_first(layout);
    assert_eq!(
        count(&octahedron, leaves),
        [index(&truth["octahedron_root0_leaf_first"]), index(&truth["of"])]
    );
    assert_eq!(count(&octahedron, steps::root_first)[0], index(&truth["root_first"]));
    let alone = |layout: &Layout| leaves(layout).concat().into_iter().map(|face| vec![face]).collect();
    assert_eq!(count(&octahedron, alone)[0], index(&truth["one_joint_at_a_time_leaf_first"]));
    let others = [
        ("tetrahedron", target("tetrahedron")),
        ("triangular_bipyramid_root0", target("triangular_bipyramid")),
        ("quadruped_root0", target("quadruped_turtle")),
        ("pentagonal_bipyramid_root0", pentagonal_bipyramid()),
    ];
    for (name, target) in others {
        let [meeting, of] = count(&target, leaves);
        assert_eq!(truth[name], format!("{meeting}/{of}"), "{name}");
    }
}

#[test]
fn half_of_the_best_octahedra_collide() {
    let target = target("octahedron");
    let weights = Weights::new(&target, &[0.026; 8], Inertia::Lamina);
    let mut best: Vec<(f64, bool)> = Vec::new();
    enumerate::each(&target, u64::MAX, |hinges| {
        let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
        let meets = meets(&target, &layout, &steps::leaves_first(&layout)).is_some();
        best.push((layout.energy(&weights), meets));
    })
    .expect("few faces");
    let least = best.iter().map(|b| b.0).fold(f64::INFINITY, f64::min);
    best.retain(|b| b.0 < least * (1.0 + 1e-9));
    assert_eq!(
        (best.len(), best.iter().filter(|b| b.1).count()),
        (24, index(&TRUTH["collisions"]["among_24_MI_optimal"]))
    );
}

/// The example of the truth: its last step sweeps one finished face through another.
#[test]
fn the_judge_names_time_and_faces_of_a_collision() {
    let tree = &TRUTH["collisions"]["example_tree"];
    let target = target("octahedron");
    let layout = Layout::of_pairs(&target, &pairs(tree), 0).expect("a tree");
    let order = steps::leaves_first(&layout);
    assert_eq!(meets(&target, &layout, &order), Some((order.len() - 1, [3, 7])));
    let (vertices, faces) = mesh(&TRUTH["shapes"]["octahedron"]);
    let mut text = "use std.mori.Mori\nlet shape = polyhedron(vertices: [".to_owned();
    for v in vertices {
        write!(text, "[{} * 1m, {} * 1m, {} * 1m], ", v.x, v.y, v.z).expect("it is a text");
    }
    writeln!(text, "], faces: {faces:?})").expect("it is a text");
    let fold = |sequence: &str| {
        let call = format!(
            "let f = fold(shape, module: Mori, root: 0, step: 2s, hinges: {tree}, sequence: {sequence})\nprint(f.steps)\n"
        );
        run_text(&format!("{text}{call}"), Mode::Run)
    };
    let refused = fold("leaves_first").outcome.diagnostics;
    let [said] = &refused[..] else { panic!("{refused:?}") };
    let time = said.message.split("at ").nth(1).and_then(|t| t.split(" s:").next()).expect("a time");
    let time: f64 = time.parse().expect("seconds");
    let last = 2.0 * (order.len() - 1) as f64;
    assert!(last < time && time < last + 2.0, "{}", said.message);
    assert!(said.message.contains("panel[3]") && said.message.contains("panel[7]"), "{}", said.message);
    let other = fold("root_first");
    assert!(other.outcome.diagnostics.is_empty(), "{:?}", other.outcome.diagnostics);
}
