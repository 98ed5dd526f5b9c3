//! Proofs and bounds of folding: none is wrong, whatever the budget; the larger shapes of the truth
//! layout by layer.
//!
//! The latter take minutes: `MODL_WHOLE=1 cargo test --release --test all fold_bounds`.

use crate::planners::fold::{TRUTH, index, mesh, near, number, numbers, shapes, target, weights};
use crate::support::properties::whole;
use modl::geometry::{Vec3, subdivide};
use modl::planners::fold::branch_and_bound::{self, optimum};
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::lagrangian::{AscentLimits, Lagrangian};
use modl::planners::fold::pattern::Pattern;
use modl::planners::fold::{Layout, Proof, Target, Weights, edge_exchange, spanning_trees, symmetry};
use modl::planners::fold::{Observer, TOLERANCES};
use proptest::prelude::*;

/// An icosahedron with its faces cut into `parts`², blown up to a sphere or not.
fn sphere(parts: usize, round: bool) -> (Vec<Vec3>, Vec<Vec<usize>>) {
    let (points, faces) = mesh(&TRUTH["shapes"]["icosahedron"]);
    let faces: Vec<[usize; 3]> = faces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    let (points, faces) = subdivide(&points, &faces, parts);
    let place = |p: Vec3| if round { p.normalize() * 0.1 } else { p };
    (points.into_iter().map(place).collect(), faces.iter().map(|f| f.to_vec()).collect())
}

fn torus() -> Target {
    let (around, across) = (12, 6);
    let turn = |i: usize, of: usize| libm::sincos(std::f64::consts::TAU * i as f64 / of as f64);
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for i in 0..around {
        for j in 0..across {
            let ((s, c), (t, d)) = (turn(i, around), turn(j, across));
            points.push(Vec3::new((1.0 + 0.4 * d) * c, (1.0 + 0.4 * d) * s, 0.4 * t) * 0.3);
            let at = |i: usize, j: usize| i % around * across + j % across;
            faces.push(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            faces.push(vec![at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Target::new(points, &faces).expect("it folds")
}

fn settings(budget: u64) -> branch_and_bound::Settings {
    branch_and_bound::Settings { budget, ..branch_and_bound::Settings::default() }
}

/// However soon a search ends, its bound is below the optimum and its layout above.
#[test]
fn a_search_that_ends_early_tells_no_lies() {
    let target = target("geodesic80");
    let weights = weights(&target);
    let best = number(&TRUTH["shapes"]["geodesic80"]["opt_E_dt1_Nm"]);
    let mut gaps = Vec::new();
    for budget in [0, 1_000, 100_000, 1_000_000] {
        let found = optimum(&target, &weights, &settings(budget)).expect("it has layouts");
        assert!(found.bound <= best * (1.0 + 1e-9), "{budget}: {} is above {best}", found.bound);
        assert!(found.energy >= best * (1.0 - 1e-9), "{budget}");
        assert!(near(found.layout.energy(&weights), found.energy, 1e-12));
        assert!(found.bound < found.energy);
        gaps.push(1.0 - found.bound / found.energy);
    }
    assert!(gaps[3] < gaps[0] / 4.0, "{gaps:?}");
}

/// Symmetric faces cost the same as roots, and only those are taken for symmetric.
#[test]
fn orbits_of_faces_are_those_of_the_symmetry_group() {
    let orbits = |target: &Target| {
        let first = symmetry::orbits(target, &weights(target));
        let mut different = first.clone();
        different.sort_unstable();
        different.dedup();
        (first, different.len())
    };
    for (name, count) in [
        ("tetrahedron", 1),
        ("octahedron", 1),
        ("icosahedron", 1),
        ("stella_octangula", 1),
        ("triangular_bipyramid", 1),
        ("snub_disphenoid", 2),
        ("geodesic80", 2),
        // The group of order 2 leaves two of the 18 faces in their place.
        ("quadruped_turtle", 10),
    ] {
        assert_eq!(orbits(&target(name)).1, count, "{name}");
    }
    for (name, shape) in shapes().filter(|(name, _)| *name != "geodesic80") {
        let ratios = numbers(&shape["opt_per_root_over_best"]);
        for (face, first) in orbits(&target(name)).0.into_iter().enumerate() {
            assert!(near(ratios[face], ratios[first], 1e-8), "{name}: {face} and {first}");
        }
    }
    let (mut points, faces) = mesh(&TRUTH["shapes"]["icosahedron"]);
    points[0] *= 1.01;
    let dented = Target::new(points, &faces).expect("it folds");
    // What is left is the group of a pentagon: five faces at the corner, and five, five and five.
    assert_eq!(orbits(&dented).1, 4);
}

/// Eighty faces without any symmetry, all roots.
#[test]
fn eighty_faces_without_symmetry_are_proved() {
    let (mut points, faces) = sphere(2, true);
    for (i, point) in points.iter_mut().enumerate() {
        let shake = |k: usize| 0.006 * libm::sin((12.9898 * (3 * i + k) as f64) * 78.233);
        *point += Vec3::new(shake(0), shake(1), shake(2));
    }
    let target = Target::new(points, &faces).expect("it folds");
    let weights = weights(&target);
    let found = optimum(&target, &weights, &settings(20_000_000)).expect("it has layouts");
    assert_eq!(found.proof, Proof::Optimal);
    assert!(near(found.bound, found.energy, 3.0 * TOLERANCES.perturbation));
}

/// The icosahedron split into 80 equal triangles: 3.5e27 layouts, and hinges that stay level.
#[test]
fn eighty_equal_faces_are_proved_and_lie_flat() {
    let (points, faces) = sphere(2, false);
    let target = Target::new(points, &faces).expect("it folds");
    assert_eq!(spanning_trees::layouts(&target).to_string(), "3497104100935210106880000000");
    let settings = branch_and_bound::Settings { flat: true, root: Some(1), ..settings(20_000_000) };
    let found = optimum(&target, &weights(&target), &settings).expect("it has layouts");
    assert_eq!(found.proof, Proof::Optimal);
    assert!(Pattern::of(&target, &found.layout).overlaps().is_empty());
}

#[test]
fn hundreds_of_faces_have_a_small_gap() {
    if !whole() {
        return;
    }
    let (points, faces) = sphere(3, true);
    let geodesic = Target::new(points, &faces).expect("it folds");
    for (target, gap) in [(geodesic, 0.0005), (torus(), 0.01)] {
        let found = optimum(&target, &weights(&target), &settings(100_000_000)).expect("it has layouts");
        assert!(1.0 - found.bound / found.energy < gap, "{} and {}", found.bound, found.energy);
    }
}

/// All layouts with a root, and all with every root, of the shapes with millions of them.
#[test]
fn millions_of_layouts_agree_with_another_program() {
    for name in if whole() { &["icosahedron", "stella_octangula"][..] } else { &[] } {
        let target = target(name);
        let weights = weights(&target);
        let truth = &TRUTH["shapes"][name]["full_enumeration_root0"];
        let asked = enumerate::Settings { root: Some(0), spectrum: true, budget: u64::MAX };
        let found = enumerate_energies(&target, &weights, &asked, &Observer::none()).expect("few faces");
        assert!(found.complete);
        assert_eq!(found.layouts, truth["layouts"].as_u64().expect("a count"), "{name}");
        assert!(near(found.least, number(&truth["min_E_dt1"]), 1e-9), "{name}");
        assert!(near(found.greatest / found.least, number(&truth["max_over_min"]), 1e-9), "{name}");
        let levels = found.spectrum.expect("asked for").levels();
        assert_eq!(levels.len(), index(&truth["distinct"]), "{name}");
        for (level, wanted) in levels.iter().zip(truth["levels_root0"].as_array().expect("a list")) {
            assert!(near(level.0 / found.least, number(&wanted[0]), 2e-9), "{name}: {level:?}");
            assert_eq!(level.1, wanted[1].as_u64().expect("a count"), "{name}: {level:?}");
        }
        let mut seen = 0;
        let middle = levels.iter().find(|level| {
            seen += level.1;
            2 * seen >= found.layouts
        });
        let median = middle.expect("half of them are somewhere").0 / found.least;
        assert!(near(median, number(&truth["median_over_min"]), 1e-6), "{name}: {median}");
        let (mut overlapping, mut flat) = (0, f64::INFINITY);
        enumerate::each(&target, u64::MAX, |hinges| {
            let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
            if Pattern::of(&target, &layout).overlaps().is_empty() {
                flat = flat.min(layout.energy(&weights));
            } else {
                overlapping += 1;
            }
        })
        .expect("few faces");
        assert_eq!(overlapping, truth["overlapping_layouts"].as_u64().expect("a count"), "{name}");
        assert!(near(flat / found.least, number(&truth["best_nonoverlapping_over_min"]), 2e-9), "{name}");
        if *name == "icosahedron" {
            // Every face is as good a root as any other: all 103,680,000 pairs.
            let asked = enumerate::Settings { root: None, ..asked };
            let all = enumerate_energies(&target, &weights, &asked, &Observer::none()).expect("few faces");
            let every = all.spectrum.expect("asked for").levels();
            assert_eq!(every.iter().map(|level| level.1).sum::<u64>(), 5_184_000 * 20);
            assert_eq!(every.len(), levels.len());
            assert!(every.iter().zip(&levels).all(|(a, b)| near(a.0, b.0, 1e-8) && a.1 == 20 * b.1));
        }
    }
}

/// A shape of up to 80 faces, shaken until some of its edges are re-entrant, with faces taken away.
fn shaken() -> impl Strategy<Value = Target> {
    let shakes = proptest::collection::vec(-0.25..0.25_f64, 126);
    let taken = proptest::collection::vec(0..80usize, 0..6);
    (1..3usize, shakes, taken).prop_filter_map("in one piece", |(parts, shakes, taken)| {
        let (mut points, mut faces) = sphere(parts, true);
        let side = (points[faces[0][1]] - points[faces[0][0]]).norm();
        for (i, point) in points.iter_mut().enumerate() {
            *point += Vec3::from_row_slice(&shakes[3 * i..3 * i + 3]) * side;
        }
        for face in taken {
            let count = faces.len();
            faces.remove(face % count);
        }
        Target::new(points, &faces).ok()
    })
}

proptest! {
    #![proptest_config(crate::support::properties::cases(12))]

    /// No layout that growth and exchange find, from anywhere, undercuts a bound.
    #[test]
    fn no_layout_undercuts_a_bound(
        target in shaken(), budget in 0..3_000_000u64, order in proptest::collection::vec(any::<u32>(), 120),
    ) {
        let weights = Weights::uniform(&target, 0.026);
        let found = optimum(&target, &weights, &settings(budget)).expect("it has layouts");
        prop_assert!(found.bound <= found.energy);
        prop_assert!(found.proof == Proof::Open || near(found.bound, found.energy, 3.0 * TOLERANCES.perturbation));
        let hinges = random_tree(&target, &order);
        for root in (0..target.faces.len()).step_by(7) {
            let layout = Layout::of_hinges(&target, &hinges, root).expect("a tree");
            let better = edge_exchange::improved(&target, &weights, layout.clone(), &mut 100_000);
            prop_assert!(better.energy(&weights) <= layout.energy(&weights) * (1.0 + 1e-12));
            prop_assert!(better.energy(&weights) >= found.bound, "{} < {}", better.energy(&weights), found.bound);
        }
    }

    /// The Lagrangian bound of a root by itself: it rises from that of single paths, and stays below
    /// every layout; what it gives up, no better layout uses.
    #[test]
    fn prices_raise_a_bound_that_holds(target in shaken(), root in 0..80usize) {
        let root = root % target.faces.len();
        let weights = Weights::uniform(&target, 0.026);
        let best = optimum(&target, &weights, &branch_and_bound::Settings { root: Some(root), ..settings(20_000_000) });
        let best = best.expect("it has layouts");
        let mut allowed: Vec<u32> = target.sides.iter().map(|sides| {
            (0..3).filter(|k| sides[*k].is_some()).map(|k| 1 << k).sum()
        }).collect();
        allowed[root] = 0;
        let effort = AscentLimits { cutoff: best.energy * 1.01, optimum_estimate: best.energy, rounds: 200, length: 1.0 };
        let mut lagrange = Lagrangian::new(&target, &weights);
        let alone = lagrange.ascend(
            root, &mut allowed.clone(), &[], AscentLimits { rounds: 1, ..effort }, &mut 10_000_000, |_, _| f64::INFINITY,
        );
        let raised = lagrange.ascend(root, &mut allowed, &[], effort, &mut 10_000_000, |_, _| f64::INFINITY);
        prop_assert!(alone.bound <= raised.bound * (1.0 + 1e-12));
        prop_assert!(raised.bound <= best.energy * (1.0 + 1e-9), "{} > {}", raised.bound, best.energy);
        for face in (0..target.faces.len()).filter(|face| *face != root) {
            let side = best.layout.across(&target, face).side;
            prop_assert!(allowed[face] & (1 << side) != 0, "the arc into {} was given up", face);
        }
    }
}

/// A spanning tree of hinges taken in a random order.
fn random_tree(target: &Target, order: &[u32]) -> Vec<usize> {
    let mut hinges: Vec<usize> = (0..target.hinges.len()).collect();
    hinges.sort_by_key(|hinge| order[hinge % order.len()]);
    let mut group: Vec<usize> = (0..target.faces.len()).collect();
    hinges.retain(|hinge| {
        let [a, b] = target.hinges[*hinge].faces.map(|face| group[face]);
        group.iter_mut().filter(|g| **g == b).for_each(|g| *g = a);
        a != b
    });
    hinges
}
