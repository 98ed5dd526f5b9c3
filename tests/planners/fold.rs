//! The planner of folding against its truth: closed forms, counts by another program (`truth/fold.json`),
//! brute force, and what must not change anything.

use modl::geometry::Vec3;
use modl::geometry::pose::turned;
use modl::interpret::Mode;
use modl::planners::fold::branch_and_bound::{self, NoLayout, optimum};
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::heuristic::{Measure, preferred};
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::pattern::Pattern;
use modl::planners::fold::shortest_paths::ShortestPaths;
use modl::planners::fold::{
    Layout, Proof, SIDES_MAX, Target, Unfoldable, Weights, energy_order, spanning_trees, steps, work_order,
};
use modl::planners::fold::{Observer, TOLERANCES};
use proptest::prelude::*;
use serde_json::Value;
use std::sync::LazyLock;

pub static TRUTH: LazyLock<Value> =
    LazyLock::new(|| serde_json::from_str(include_str!("../truth/fold.json")).expect("the truth is JSON"));

pub const MASS: f64 = 0.026;
pub const SIDE: f64 = 0.08;
/// What the truth was computed with, m/s².
pub const GRAVITY: f64 = 9.8;

pub fn shapes() -> impl Iterator<Item = (&'static String, &'static Value)> {
    TRUTH["shapes"].as_object().expect("an object").iter()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

pub fn index(value: &Value) -> usize {
    value.as_u64().expect("a place") as usize
}

pub fn mesh(shape: &Value) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let list = |key: &str| shape[key].as_array().expect("a list").iter();
    let vertices = list("vertices_unit_edge").map(|v| {
        let p = numbers(v);
        Vec3::new(p[0], p[1], p[2]) * SIDE
    });
    let faces = list("faces_ccw").map(|f| f.as_array().expect("a list").iter().map(index).collect());
    (vertices.collect(), faces.collect())
}

/// Returns the corners of a face that is a triangle, m.
pub fn triangle(target: &Target, face: usize) -> [Vec3; 3] {
    target.corners(face).try_into().expect("a triangle has three corners")
}

pub fn target(name: &str) -> Target {
    let (vertices, faces) = mesh(&TRUTH["shapes"][name]);
    Target::new(vertices, &faces).unwrap_or_else(|why| panic!("{name}: {why}"))
}

pub fn weights(target: &Target) -> Weights {
    Weights::uniform(target, MASS)
}

pub fn pairs(value: &Value) -> Vec<[usize; 2]> {
    value.as_array().expect("a list").iter().map(|p| [index(&p[0]), index(&p[1])]).collect()
}

pub fn near(a: f64, b: f64, tol: f64) -> bool {
    (a - b).abs() <= tol * a.abs().max(b.abs())
}

fn at_root(root: usize) -> branch_and_bound::Settings {
    branch_and_bound::Settings { root: Some(root), ..branch_and_bound::Settings::default() }
}

fn all_layouts(root: Option<usize>, spectrum: bool) -> enumerate::Settings {
    enumerate::Settings { root, spectrum, budget: u64::MAX }
}

#[test]
fn layouts_are_counted_as_spanning_trees() {
    for (name, shape) in shapes() {
        assert_eq!(spanning_trees::layouts(&target(name)).to_string(), shape["spanning_trees"], "{name}");
    }
    assert_eq!(spanning_trees::layouts(&target("geodesic80")).to_string(), "3497104100935210106880000000");
}

/// The least energies in closed form; the truth has its corners to twelve places.
#[test]
fn least_energies_are_those_of_the_closed_form() {
    let unit = 3.75 * MASS * SIDE * SIDE;
    let theta = libm::acos(1.0 / 3.0);
    let cases = [
        ("tetrahedron", unit * (std::f64::consts::PI - theta) * 3.0 / 8.0),
        ("octahedron", unit * theta * 19.0 / 6.0),
    ];
    for (name, exact) in cases {
        let target = target(name);
        let found = optimum(&target, &weights(&target), &branch_and_bound::Settings::default())
            .expect("it has layouts");
        assert!(near(found.energy, exact, 1e-11), "{name}: {} is not {exact}", found.energy);
    }
}

/// How often each energy occurs over all layouts and roots, with the exact ratios.
#[test]
fn energies_occur_as_often_as_they_should() {
    let tetrahedron = [(1.0, 4), (16.0 / 9.0, 24), (23.0 / 9.0, 12), (10.0 / 3.0, 24)];
    let spectrum = |name: &str| {
        let target = target(name);
        let found =
            enumerate_energies(&target, &weights(&target), &all_layouts(None, true), &Observer::none())
                .expect("few faces");
        let levels = found.spectrum.expect("asked for").levels();
        levels.into_iter().map(|(energy, times)| (energy / found.least, times)).collect::<Vec<_>>()
    };
    let same = |found: &[(f64, u64)], wanted: &[(f64, u64)]| {
        found.len() == wanted.len()
            && found.iter().zip(wanted).all(|(a, b)| near(a.0, b.0, 1e-8) && a.1 == b.1)
    };
    assert!(same(&spectrum("tetrahedron"), &tetrahedron), "{:?}", spectrum("tetrahedron"));
    let listed =
        TRUTH["shapes"]["octahedron"]["MI_full"]["MI_normalised_spectrum"].as_array().expect("a list");
    let octahedron: Vec<(f64, u64)> =
        listed.iter().map(|l| (number(&l[0]), l[1].as_u64().expect("a count"))).collect();
    assert!(same(&spectrum("octahedron"), &octahedron), "{:?}", spectrum("octahedron"));
    let quadruped = spectrum("quadruped_turtle");
    assert_eq!(quadruped.len(), 844);
    assert_eq!(quadruped.iter().map(|l| l.1).sum::<u64>(), 1944);
    assert!(near(quadruped[843].0, 6.33898, 1e-5));
}

/// Optimum and bound of each shape for every root.
#[test]
fn optima_are_proved_and_those_of_the_truth() {
    for (name, shape) in shapes().filter(|(name, _)| *name != "geodesic80") {
        let (target, wanted) = (target(name), number(&shape["opt_E_dt1_Nm"]));
        let weights = weights(&target);
        let best =
            optimum(&target, &weights, &branch_and_bound::Settings::default()).expect("it has layouts");
        assert_eq!(best.proof, Proof::Optimal, "{name}");
        assert!(near(best.energy, wanted, 1e-9), "{name}: {}, not {wanted}", best.energy);
        assert!(
            best.bound <= best.energy && near(best.bound, best.energy, 3.0 * TOLERANCES.perturbation),
            "{name}"
        );
        let roots: Vec<usize> = shape["best_roots"].as_array().expect("a list").iter().map(index).collect();
        assert_eq!(best.roots, roots, "{name}");
        let bounds = ShortestPaths::new(&target, &weights);
        let mut least_bound = 1.0_f64;
        for (root, ratio) in numbers(&shape["opt_per_root_over_best"]).into_iter().enumerate() {
            let found = optimum(&target, &weights, &at_root(root)).expect("it has layouts");
            assert_eq!((found.layout.root, found.proof), (root, Proof::Optimal), "{name}");
            assert!(near(found.energy, wanted * ratio, 2e-9), "{name} at {root}");
            assert!(near(found.layout.energy(&weights), found.energy, 1e-14));
            least_bound = least_bound.min(bounds.bound(root) / found.energy);
        }
        assert!(near(least_bound, number(&shape["min_root_LB_over_opt"]), 1e-9), "{name}: {least_bound}");
    }
}

#[test]
fn eighty_faces_are_proved() {
    let target = target("geodesic80");
    let found = optimum(&target, &weights(&target), &at_root(1)).expect("it has layouts");
    assert_eq!(found.proof, Proof::Optimal);
    assert!(near(found.energy, number(&TRUTH["shapes"]["geodesic80"]["opt_E_dt1_Nm"]), 1e-9));
}

#[test]
fn the_best_pattern_that_does_not_overlap_is_proved() {
    for (name, shape) in shapes().filter(|(name, _)| *name != "geodesic80") {
        let target = target(name);
        let weights = weights(&target);
        let settings = branch_and_bound::Settings { flat: true, ..at_root(0) };
        let flat = optimum(&target, &weights, &settings).expect("it has layouts");
        let free = optimum(&target, &weights, &at_root(0)).expect("it has layouts");
        assert_eq!(flat.proof, Proof::Optimal, "{name}");
        assert_eq!(Pattern::of(&target, &flat.layout).overlaps(), [[0; 2]; 0], "{name}");
        let price = number(&shape["nonoverlap_price_per_root"][0]);
        assert!(near(flat.energy / free.energy, price, 2e-9), "{name}: {}", flat.energy / free.energy);
    }
}

/// Enumerations by another program: counts, extremes, levels, overlaps.
#[test]
fn enumerations_agree_with_another_program() {
    for (name, shape) in shapes() {
        let truth = &shape["full_enumeration_root0"];
        if truth.is_null() || shape["faces"].as_u64() > Some(12) {
            continue;
        }
        let target = target(name);
        let found =
            enumerate_energies(&target, &weights(&target), &all_layouts(Some(0), true), &Observer::none())
                .expect("few faces");
        assert!(found.complete);
        assert_eq!(found.layouts, truth["layouts"].as_u64().expect("a count"), "{name}");
        assert!(near(found.least, number(&truth["min_E_dt1"]), 1e-9), "{name}");
        assert!(near(found.greatest / found.least, number(&truth["max_over_min"]), 1e-9), "{name}");
        let levels = found.spectrum.expect("asked for").levels();
        assert_eq!(levels.len() as u64, truth["distinct"].as_u64().expect("a count"), "{name}");
        for (level, wanted) in levels.iter().zip(truth["levels_root0"].as_array().expect("a list")) {
            assert!(near(level.0 / found.least, number(&wanted[0]), 2e-9), "{name}: {level:?}");
            assert_eq!(level.1, wanted[1].as_u64().expect("a count"), "{name}: {level:?}");
        }
        let mut overlapping = 0;
        enumerate::each(&target, u64::MAX, |hinges| {
            let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
            overlapping += u64::from(!Pattern::of(&target, &layout).overlaps().is_empty());
        })
        .expect("few faces");
        assert_eq!(overlapping, truth["overlapping_layouts"].as_u64().expect("a count"), "{name}");
    }
}

#[test]
fn a_budget_ends_an_enumeration_and_says_so() {
    let target = target("octahedron");
    let settings = enumerate::Settings { budget: 100, ..all_layouts(None, false) };
    let some =
        enumerate_energies(&target, &weights(&target), &settings, &Observer::none()).expect("few faces");
    assert_eq!((some.layouts, some.complete), (100, false));
    let all = enumerate::Settings { budget: 384, ..settings };
    let all = enumerate_energies(&target, &weights(&target), &all, &Observer::none()).expect("few faces");
    assert_eq!((all.layouts, all.complete, all.ties), (384, true, 192));
}

#[test]
fn an_optimum_without_budget_has_an_open_gap() {
    let target = target("tube_6x3");
    let settings = branch_and_bound::Settings { budget: 0, ..at_root(0) };
    let found = optimum(&target, &weights(&target), &settings).expect("a first layout needs no budget");
    assert_eq!(found.proof, Proof::Open);
    assert!(found.bound < found.energy);
}

/// Theorem 1 on face-transitive shapes: what it prefers is among the best.
#[test]
fn the_heuristic_prefers_optima_of_tetrahedron_and_octahedron() {
    for (name, ties) in [("tetrahedron", 1), ("octahedron", 24)] {
        let target = target(name);
        let weights = weights(&target);
        let measure = Measure::of_panels(MASS, SIDE);
        let found = preferred(&target, &measure, Some(0), u64::MAX).expect("few faces");
        assert_eq!(found.ties, ties, "{name}");
        let mut preferred = 0;
        let least = number(&TRUTH["shapes"][name]["opt_E_dt1_Nm"]);
        enumerate::each(&target, u64::MAX, |hinges| {
            let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
            if near(measure.of(&target, &layout), found.measure, 1e-9) {
                preferred += 1;
                assert!(near(layout.energy(&weights), least, 1e-9), "{name}");
            }
        })
        .expect("few faces");
        assert_eq!(preferred, ties);
    }
}

/// Orders of the listed trees: least work, bound, work of the two simple orders, energies.
#[test]
fn orders_of_folding_are_those_of_the_truth() {
    for case in TRUTH["sequences"].as_array().expect("a list") {
        let name = case["shape"].as_str().expect("a name");
        let target = target(name);
        let n = target.faces.len();
        let layout = Layout::of_pairs(&target, &pairs(&case["tree"]), index(&case["root"])).expect("a tree");
        let (loads, masses) = (vec![MASS * GRAVITY; n], vec![MASS; n]);
        let found = work_order::least_work(&target, &layout, &loads);
        assert!(found.optimal);
        assert!(near(found.work, number(&case["W_opt_J"]), 1e-9), "{name}: {}", found.work);
        assert!(near(work_order::work(&target, &layout, &loads, &found.order), found.work, 1e-9), "{name}");
        assert!(found.bound <= found.work * (1.0 + 1e-12));
        let bound = work_order::bound(&target, &layout, &loads);
        let of_root = number(&case["W_lower_bound_J"]) * (1.0 - 1e-9);
        assert!(of_root <= bound && bound <= found.work * (1.0 + 1e-12), "{name}: {bound}");
        let flat = |steps: Vec<Vec<usize>>| steps.concat();
        let leaves = flat(steps::leaves_first(&layout));
        let first = flat(steps::root_first(&layout));
        let work = |order: &[usize]| work_order::work(&target, &layout, &loads, order);
        assert!(near(work(&leaves), number(&case["W_leaf_first_J"]), 1e-9), "{name}");
        assert!(near(work(&first), number(&case["W_root_first_J"]), 1e-9), "{name}");
        assert_eq!(steps::leaves_first(&layout).len(), index(&case["height"]));
        if case["MI_leaf_first_dt1"].is_null() {
            continue;
        }
        let energy =
            |order: &[usize]| energy_order::energy(&target, &layout, &masses, Inertia::Lamina, order);
        assert!(near(energy(&leaves), number(&case["MI_leaf_first_dt1"]), 1e-9), "{name}");
        assert!(near(energy(&leaves), layout.energy(&weights(&target)), 1e-12), "{name}");
        assert!(near(energy(&first), number(&case["MI_root_first_dt1"]), 1e-9), "{name}");
        let (best, least) =
            energy_order::least_energy(&target, &layout, &masses, Inertia::Lamina).expect("low");
        assert!(near(least, number(&case["MI_opt_over_orders_dt1"]), 1e-9), "{name}: {least}");
        assert!(near(energy(&best), least, 1e-9), "{name}: the order does not cost what it should");
    }
}

pub fn permutations(items: &mut Vec<usize>, from: usize, visit: &mut impl FnMut(&[usize])) {
    if from == items.len() {
        return visit(items);
    }
    for i in from..items.len() {
        items.swap(from, i);
        permutations(items, from + 1, visit);
        items.swap(from, i);
    }
}

/// Every order of every layout of the tetrahedron, and of some of the bipyramid's and octahedron's.
#[test]
fn dynamic_programming_equals_brute_force() {
    let cases = [
        ("tetrahedron", 0, 1),
        ("tetrahedron", 2, 1),
        ("triangular_bipyramid", 4, 9),
        ("octahedron", 3, 190),
    ];
    for (name, root, every) in cases {
        let target = target(name);
        let n = target.faces.len();
        let (loads, masses) = (vec![MASS * GRAVITY; n], vec![MASS; n]);
        let mut number = 0;
        enumerate::each(&target, u64::MAX, |hinges| {
            number += 1;
            if number % every != 0 {
                return;
            }
            let layout = Layout::of_hinges(&target, hinges, root).expect("a tree");
            let (mut work, mut energy) = (f64::INFINITY, f64::INFINITY);
            let mut faces: Vec<usize> = (0..n).filter(|f| *f != root).collect();
            permutations(&mut faces, 0, &mut |order| {
                work = work.min(work_order::work(&target, &layout, &loads, order));
                energy = energy.min(energy_order::energy(&target, &layout, &masses, Inertia::Lamina, order));
            });
            let lifting = work_order::least_work(&target, &layout, &loads);
            assert!(near(lifting.work, work, 1e-9), "{name}: {} and {work}", lifting.work);
            let (_, least) =
                energy_order::least_energy(&target, &layout, &masses, Inertia::Lamina).expect("low");
            assert!(near(least, energy, 1e-9), "{name}: {least} and {energy}");
        })
        .expect("few faces");
    }
}

/// The counterexample to Alg. 3: two leaves below b, folded one before and one after it.
#[test]
fn an_order_in_steps_keeps_its_order_along_paths() {
    let target = target("octahedron");
    let layout = Layout::of_pairs(&target, &[[0, 1], [1, 3], [1, 5], [3, 7], [0, 2], [2, 6], [6, 4]], 0)
        .expect("a tree");
    let steps = steps::of_order(&layout, &[3, 1, 5, 7, 4, 6, 2]);
    assert_eq!(steps, [vec![3, 4], vec![1, 6], vec![2, 5, 7]]);
    let leaves_first = steps::leaves_first(&layout);
    assert_eq!(steps::of_order(&layout, &leaves_first.concat()), leaves_first);
}

#[test]
fn meshes_that_do_not_fold_name_their_faces() {
    let points: Vec<Vec3> =
        [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.], [2., 2., 3.]]
            .into_iter()
            .map(Vec3::from)
            .collect();
    let refused = |faces: &[&[usize]]| {
        let faces: Vec<Vec<usize>> = faces.iter().map(|f| f.to_vec()).collect();
        Target::new(points.clone(), &faces).expect_err("it does not fold")
    };
    assert_eq!(refused(&[]), Unfoldable::Empty);
    assert_eq!(refused(&[&[0, 1]]), Unfoldable::Corners { face: 0, corners: 2, limit: SIDES_MAX });
    // All four corners are as far from the plane through their mean, which is level with y and slanted by 45 degrees.
    let Unfoldable::NotPlanar { face: 0, off, .. } = refused(&[&[0, 1, 2, 3]]) else {
        panic!("it is not flat")
    };
    assert!((off - 1.0 / 8f64.sqrt()).abs() < 1e-12);
    assert_eq!(refused(&[&[0, 1, 2], &[1, 1, 2]]), Unfoldable::Degenerate { face: 1 });
    assert_eq!(refused(&[&[0, 1, 9]]), Unfoldable::Degenerate { face: 0 });
    assert_eq!(
        refused(&[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]),
        Unfoldable::NonManifold { faces: vec![0, 1, 2] }
    );
    assert_eq!(refused(&[&[0, 1, 2], &[0, 1, 3]]), Unfoldable::Orientation { faces: [0, 1] });
    assert_eq!(refused(&[&[0, 1, 2], &[3, 4, 5]]), Unfoldable::Disconnected { faces: [0, 1] });
    assert_eq!(refused(&[&[0, 1, 2], &[1, 0, 2]]), Unfoldable::FoldedFlat { faces: [0, 1] });
    let quadruped = target("quadruped_turtle");
    assert_eq!(quadruped.check_sides(SIDE, 1e-6), Ok(()));
    assert!(matches!(quadruped.check_sides(0.07, 1e-6), Err(Unfoldable::UnequalSides { face: 0, .. })));
}

/// A strip of triangles round a point, more than a full turn of them: every layout overlaps.
#[test]
fn a_target_of_which_every_pattern_overlaps_is_refused() {
    let (mut points, mut faces) = (vec![Vec3::zeros()], Vec::new());
    for i in 0..8u32 {
        let angle = f64::from(i) * std::f64::consts::FRAC_PI_4;
        let height = if i % 2 == 0 { 0.6 } else { -0.6 };
        points.push(Vec3::new(libm::cos(angle), libm::sin(angle), height));
    }
    for i in 1..8 {
        faces.push(vec![0, i, i + 1]);
    }
    let target = Target::new(points, &faces).expect("it folds");
    let settings = branch_and_bound::Settings { flat: true, ..branch_and_bound::Settings::default() };
    assert_eq!(optimum(&target, &weights(&target), &settings).err(), Some(NoLayout::AllOverlap));
    assert!(optimum(&target, &weights(&target), &branch_and_bound::Settings::default()).is_ok());
}

/// Random targets: a shape with its corners shaken and some faces taken away.
pub fn shaken() -> impl Strategy<Value = Target> {
    let names =
        vec!["octahedron", "triangular_bipyramid", "snub_disphenoid", "tetrahedron", "quadruped_turtle"];
    let shakes = proptest::collection::vec(-0.02..0.02_f64, 60);
    (proptest::sample::select(names), shakes, proptest::collection::vec(0..18usize, 0..3)).prop_filter_map(
        "in one piece",
        |(name, shakes, taken)| {
            let (mut vertices, mut faces) = mesh(&TRUTH["shapes"][name]);
            for (i, vertex) in vertices.iter_mut().enumerate() {
                *vertex += Vec3::new(shakes[3 * i], shakes[3 * i + 1], shakes[3 * i + 2]);
            }
            for face in taken {
                let count = faces.len();
                if count > 4 {
                    faces.remove(face % count);
                }
            }
            Target::new(vertices, &faces).ok()
        },
    )
}

/// The program that folding is for: plans and a pattern are written, and every plan passes the judge.
#[test]
fn plans_and_patterns_of_a_program_are_written() {
    let text = "use std.mori.Mori
use std.shapes.{octahedron, quadruped18}
let octa = fold(octahedron(edge: 80mm), module: Mori)
show(octa.layout, \"octahedron.svg\")
emit(octa.plan, \"octahedron.plan.json\")
let quad = fold(quadruped18(edge: 80mm), module: Mori, root: 4)
emit(reverse(quad.plan), \"quadruped_unfold.plan.json\")
";
    let ran = crate::language::interpret::run_text(text, Mode::Run);
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
    let written = &ran.host.written;
    let names: Vec<&String> = written.keys().collect();
    assert_eq!(names, ["octahedron.plan.json", "octahedron.svg", "quadruped_unfold.plan.json"]);
    let pattern = String::from_utf8_lossy(&written["octahedron.svg"]);
    assert_eq!(pattern.matches("<polygon").count(), 8, "a panel each");
    for plan in written.iter().filter(|(name, _)| name.ends_with(".json")) {
        let text = String::from_utf8_lossy(plan.1);
        let plan = modl::plan::file::read(&text).expect("it reads back");
        assert!(modl::plan::verify::verify(&plan).ok());
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(24))]

    /// The proof against enumeration, with and without overlap.
    #[test]
    fn proved_optima_are_those_of_enumeration(target in shaken(), root in 0..18usize) {
        let root = root % target.faces.len();
        let weights = Weights::uniform(&target, MASS);
        let found = optimum(&target, &weights, &branch_and_bound::Settings::default()).expect("it has layouts");
        let all = enumerate_energies(&target, &weights, &all_layouts(None, false), &Observer::none()).expect("few faces");
        prop_assert_eq!(spanning_trees::layouts(&target).to_string(), all.layouts.to_string());
        prop_assert_eq!(found.proof, Proof::Optimal);
        prop_assert!(near(found.energy, all.least, 2e-9));
        let flat = optimum(&target, &weights, &branch_and_bound::Settings { flat: true, ..at_root(root) });
        let (mut least, mut overlapping) = (f64::INFINITY, 0);
        if all.layouts < 10_000 {
            enumerate::each(&target, u64::MAX, |hinges| {
                let layout = Layout::of_hinges(&target, hinges, root).expect("a tree");
                let energy = layout.energy(&weights);
                if energy < least {
                    match Pattern::of(&target, &layout).overlaps().is_empty() {
                        true => least = energy,
                        false => overlapping += 1,
                    }
                }
            }).expect("few faces");
            match flat {
                Ok(flat) => prop_assert!(near(flat.energy, least, 2e-9), "{} {least}", flat.energy),
                Err(why) => prop_assert!(why == NoLayout::AllOverlap && least.is_infinite() && overlapping > 0),
            }
        }
    }

    /// Turning, mirroring, growing and renumbering change nothing but the scale.
    #[test]
    fn energies_do_not_depend_on_place_or_numbering(
        target in shaken(), axis in [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0], angle in 0.0..6.0_f64, grow in 0.5..2.0_f64,
        first in 0..8usize,
    ) {
        let least = |target: &Target| {
            optimum(target, &Weights::uniform(target, MASS), &branch_and_bound::Settings::default()).expect("it has layouts").energy
        };
        let plain = least(&target);
        let faces: Vec<Vec<usize>> = target.faces.iter().map(|f| f.to_vec()).collect();
        let turn = turned(Vec3::from(axis), angle);
        let moved = target.vertices.iter().map(|v| turn * v * grow + Vec3::new(1.0, 2.0, 3.0)).collect();
        let mut rolled = faces.clone();
        rolled.rotate_left(first % faces.len());
        rolled.iter_mut().for_each(|f| f.rotate_left(first % 3));
        let moved = Target::new(moved, &rolled).expect("it still folds");
        prop_assert!(near(least(&moved), plain * grow * grow, 1e-8));
        let mirrored = target.vertices.iter().map(|v| Vec3::new(-v.x, v.y, v.z)).collect();
        let turned_round: Vec<Vec<usize>> = faces.iter().map(|f| f.iter().rev().copied().collect()).collect();
        let mirrored = Target::new(mirrored, &turned_round).expect("it still folds");
        prop_assert!(near(least(&mirrored), plain, 1e-8));
    }
}
