//! Panels that meet on the way: counts by another program for panels without thickness, found again
//! by samples, and the judge's word on panels with thickness.

use crate::language::interpret::run_text;
use crate::planners::fold::{SIDE, TRUTH, index, mesh, pairs, target, triangle};
use modl::geometry::{Part, Vec3};
use modl::interpret::Mode;
use modl::planners::fold::collision_free_order::OrderSearch;
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::kinematics::poses_at;
use modl::planners::fold::simulation::quintic;
use modl::planners::fold::sweep_collision::{Collision, Solids, first_collision};
use modl::planners::fold::{Layout, Target, Weights, enumerate, steps};
use modl::source::Diagnostic;
use serde_json::Value;
use std::fmt::Write;

/// The other program shrank triangles by this part, and looked at 24 to 40 states of each step.
const SHRUNK: f64 = 1e-3;

fn meets(target: &Target, layout: &Layout, steps: &[Vec<usize>]) -> Option<Collision> {
    first_collision(target, layout, steps, SHRUNK)
}

/// Whether an edge of one triangle goes through the inside of another.
fn pierced(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let normal = (b[1] - b[0]).cross(&(b[2] - b[0]));
    (0..3).any(|k| {
        let (p, q) = (a[k], a[(k + 1) % 3]);
        let (over, under) = (normal.dot(&(p - b[0])), normal.dot(&(q - b[0])));
        let x = p + (q - p) * (over / (over - under));
        let inside = |k: usize| normal.dot(&(b[(k + 1) % 3] - b[k]).cross(&(x - b[k])));
        over * under < 0.0 && (0..3).all(|k| inside(k) > 1e-9 * normal.norm_squared())
    })
}

/// The same question asked by edges against insides. Two panels that are mirror images of each other
/// meet in their edges only, and are missed.
fn pierces(target: &Target, layout: &Layout, steps: &[Vec<usize>]) -> bool {
    let faces = 0..target.faces.len();
    let full = |face: usize| layout.hinge[face].map_or(0.0, |hinge| target.hinges[hinge].angle);
    let mut angles = vec![0.0; target.faces.len()];
    steps.iter().any(|step| {
        (1..=24).any(|sample| {
            let part = quintic(f64::from(sample) / 24.0, 1.0).angle;
            step.iter().for_each(|face| angles[*face] = full(*face) * part);
            let poses = poses_at(target, layout, |face| angles[face]);
            let placed = |face: usize| {
                let middle = target.centroid(face);
                let small = triangle(target, face).map(|c| middle + (c - middle) * (1.0 - SHRUNK));
                small.map(|p| poses[face].transform_point(&p.into()).coords)
            };
            let placed: Vec<[Vec3; 3]> = faces.clone().map(placed).collect();
            faces
                .clone()
                .any(|b| (0..b).any(|a| pierced(&placed[a], &placed[b]) || pierced(&placed[b], &placed[a])))
        })
    })
}

/// How many layouts there are, how many of them meet, and how many are pierced.
fn count(target: &Target, order: impl Fn(&Layout) -> Vec<Vec<usize>>) -> [usize; 3] {
    let mut found = [0; 3];
    enumerate::each(target, u64::MAX, |hinges| {
        let layout = Layout::of_hinges(target, hinges, 0).expect("a tree");
        let steps = order(&layout);
        let [meets, pierces] = [meets(target, &layout, &steps).is_some(), pierces(target, &layout, &steps)];
        assert!(meets || !pierces, "what is pierced meets");
        found[0] += 1;
        found[1] += usize::from(meets);
        found[2] += usize::from(pierces);
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

/// The other program's counts are those of edges that go through panels; ours are not fewer.
#[test]
fn as_many_layouts_collide_as_another_program_found() {
    let truth = &TRUTH["collisions"];
    let octahedron = target("octahedron");
    let leaves = |layout: &Layout| steps::leaves_first(layout);
    let of_octahedron = index(&truth["octahedron_root0_leaf_first"]);
    assert_eq!(count(&octahedron, leaves), [index(&truth["of"]), of_octahedron, of_octahedron]);
    assert_eq!(count(&octahedron, steps::root_first)[1], index(&truth["root_first"]));
    let alone = |layout: &Layout| leaves(layout).concat().into_iter().map(|face| vec![face]).collect();
    let one_at_a_time = index(&truth["one_joint_at_a_time_leaf_first"]);
    assert_eq!(count(&octahedron, alone)[1..], [one_at_a_time, one_at_a_time]);
    let others = [
        ("tetrahedron", target("tetrahedron")),
        ("triangular_bipyramid_root0", target("triangular_bipyramid")),
        ("quadruped_root0", target("quadruped_turtle")),
        ("pentagonal_bipyramid_root0", pentagonal_bipyramid()),
    ];
    for (name, target) in others {
        let [of, _, pierced] = count(&target, leaves);
        assert_eq!(truth[name], format!("{pierced}/{of}"), "{name}");
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

/// A program that folds a shape of the truth in a given layout.
fn folded(shape: &str, root: usize, tree: &Value, sequence: &str) -> Vec<Diagnostic> {
    let (vertices, faces) = mesh(&TRUTH["shapes"][shape]);
    let mut text = "use std.mori.Mori\nlet shape = polyhedron(vertices: [".to_owned();
    for v in vertices {
        write!(text, "[{} * 1m, {} * 1m, {} * 1m], ", v.x, v.y, v.z).expect("it is a text");
    }
    writeln!(text, "], faces: {faces:?})").expect("it is a text");
    let options = format!("root: {root}, step: 3s, hinges: {tree}, sequence: {sequence}");
    writeln!(text, "let f = fold(shape, module: Mori, {options})\nprint(f.steps)").expect("it is a text");
    run_text(&text, Mode::Run).outcome.diagnostics
}

/// The two panels that a refusal names, and when, s.
fn refusal(said: &[Diagnostic]) -> (Vec<usize>, f64) {
    let [said] = said else { panic!("{said:?}") };
    let number = |text: &str, end: &str| text.split(end).next().and_then(|t| t.parse::<f64>().ok());
    let faces = said.message.split("panel[").skip(1).filter_map(|text| number(text, "]"));
    let time = said.message.split("at ").find_map(|text| number(text, "s:")).expect("a time");
    (faces.map(|face| face as usize).collect(), time)
}

/// The example of the truth: its last step sweeps one finished face through another.
#[test]
fn the_judge_names_time_and_faces_of_a_collision() {
    let tree = &TRUTH["collisions"]["example_tree"];
    let target = target("octahedron");
    let layout = Layout::of_pairs(&target, &pairs(tree), 0).expect("a tree");
    let order = steps::leaves_first(&layout);
    assert_eq!(meets(&target, &layout, &order), Some(Collision { step: order.len() - 1, faces: [3, 7] }));
    let (faces, time) = refusal(&folded("octahedron", 0, tree, "leaves_first"));
    let last = 3.0 * (order.len() - 1) as f64;
    assert!(faces == [3, 7] && last < time && time < last + 3.0, "{faces:?} at {time}");
    assert!(folded("octahedron", 0, tree, "root_first").is_empty());
}

/// None of the quadruped's layouts is pierced. Yet where six panels lie round a point, hips that bend to
/// the outside push two knees into each other, which are mirror images: the judge, who bounds the
/// motion between samples, says the same of panels with thickness.
#[test]
fn samples_and_judge_agree_on_the_quadruped() {
    let target = target("quadruped_turtle");
    let of_quadruped = |case: &&Value| case["shape"] == "quadruped_turtle" && index(&case["root"]) == 0;
    let cases = TRUTH["sequences"].as_array().expect("a list").iter().filter(of_quadruped);
    let mut meeting = 0;
    for case in cases.take(2) {
        let layout = Layout::of_pairs(&target, &pairs(&case["tree"]), 0).expect("a tree");
        let said = folded("quadruped_turtle", 0, &case["tree"], "leaves_first");
        match meets(&target, &layout, &steps::leaves_first(&layout)) {
            None => assert!(said.is_empty(), "{said:?}"),
            Some(Collision { step, faces }) => {
                let (named, time) = refusal(&said);
                assert!(named == faces && (time / 3.0) as usize == step, "{named:?} at {time}");
                meeting += 1;
            }
        }
    }
    assert_eq!(meeting, 1);
}

/// Panels of the octahedron that are almost triangles.
fn plates(target: &Target) -> Solids {
    let radius = SIDE / libm::sqrt(3.0) * (1.0 - SHRUNK);
    let corner = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        Vec3::new(cosine, sine, 0.0) * radius
    };
    // The middle of side 0 is on the x axis.
    let plate = Part::points(&[corner(-60.0), corner(60.0), corner(180.0), Vec3::new(0.0, 0.0, 1e-5)]);
    Solids { parts: vec![vec![plate]; target.faces.len()], touch: 1e-5 }
}

/// Where leaves first collides, an order is found in which nothing meets: by samples of another kind,
/// and of every one of the 384 layouts, for root first is one.
#[test]
fn a_passage_is_found_wherever_there_is_one() {
    let target = target("octahedron");
    let solids = plates(&target);
    let mut colliding = 0;
    enumerate::each(&target, u64::MAX, |hinges| {
        let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
        let wished = steps::leaves_first(&layout);
        if meets(&target, &layout, &wished).is_none() {
            return;
        }
        colliding += 1;
        let mut passages = OrderSearch::new(&target, &layout, &solids, None, 10_000);
        let order = passages.order(&wished.concat()).expect("root first is such an order");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (1..8).collect::<Vec<_>>(), "every face but the root folds once");
        let found = passages.steps(&order);
        assert_eq!(found.concat(), order);
        assert_eq!(meets(&target, &layout, &found), None);
    })
    .expect("few faces");
    assert_eq!(colliding, index(&TRUTH["collisions"]["octahedron_root0_leaf_first"]));
}

/// What is refused is not proposed again, and where nothing is left there is no order.
#[test]
fn refused_steps_are_avoided() {
    let target = target("tetrahedron");
    let layout = Layout::of_pairs(&target, &[[0, 1], [0, 2], [0, 3]], 0).expect("a tree");
    let solids = plates(&target);
    let mut passages = OrderSearch::new(&target, &layout, &solids, None, 100);
    let mut seen = Vec::new();
    while let Some(order) = passages.order(&[1, 2, 3]) {
        passages.forbid(&order, 0);
        seen.push(order[0]);
    }
    seen.sort_unstable();
    assert_eq!(seen, [1, 2, 3], "each can be the first, once");
}

/// Every layout of the stella octangula that lies flat meets itself with the leaves first; in another
/// order the best of them folds, and costs no less than the truth's price of not overlapping.
#[test]
fn the_stella_octangula_folds() {
    let text = "use std.mori.Mori
use std.shapes.stella_octangula
let star = fold(stella_octangula(edge: 80mm), module: Mori, sequence: leaves_first)
print(star.price)
print(star.optimal)
emit(star, \"star.plan.json\")
";
    let ran = run_text(text, Mode::Run);
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
    let price: f64 = ran.host.printed[0].parse().expect("a number");
    assert!(price > 1.0483966 && price < 1.3, "{price}");
    assert_eq!(ran.host.printed[1], "false");
    let plan = modl::plan::file::read(&String::from_utf8_lossy(&ran.host.written["star.plan.json"]));
    assert!(modl::plan::verify::verify(&plan.expect("it reads back")).ok());
}

/// The quadruped that the paper's Figure 4 shows Mori fold, of panels of 26 g, holds by hinges of 0.1 N·m. Panels of 30 g are
/// too heavy: the call says which hinge binds, and by how much.
#[test]
fn gravity_says_what_binds() {
    let fold = |module: &str| {
        let text = format!(
            "use std.mori.Mori
use std.shapes.quadruped18
let robot = fold(quadruped18(edge: 80mm), module: {module}, gravity: on, root: 0)
print(robot.steps)
"
        );
        run_text(&text, Mode::Run).outcome.diagnostics
    };
    let said = fold("Mori(weight: 30g)");
    let [said] = &said[..] else { panic!("{said:?}") };
    let hints = said.hints.join(" ");
    assert!(hints.contains("the hinge between panels") && hints.contains("0.1N*m"), "{hints}");
    assert!(fold("Mori").is_empty());
}
