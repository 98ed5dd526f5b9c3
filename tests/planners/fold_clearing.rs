//! Layouts that are made so that nothing is in the way: tori, of which no cheap layout folds; and panels
//! that are in each other whatever the layout.

use crate::language::interpret::{Ran, run_text};
use modl::geometry::{Part, Vec3};
use modl::interpret::Mode;
use modl::planners::fold::enumerate;
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::pattern::Pattern;
use modl::planners::fold::strip_layouts::StripSearch;
use modl::planners::fold::sweep_collision::{
    Solids, SweepCheck, first_collision, panel_pose, target_collisions,
};
use modl::planners::fold::{Layout, Target, Weights, steps};
use std::f64::consts::TAU;

/// Quadrangles about a ring, each cut in two, as `std.shapes.torus` has them.
fn torus(radius: f64, tube: f64, around: usize, across: usize) -> Target {
    let turn = |i: usize, of: usize| libm::sincos(TAU * i as f64 / of as f64);
    let point = |i: usize, j: usize| {
        let ((sine, cosine), (up, out)) = (turn(i, around), turn(j, across));
        let far = radius + tube * out;
        Vec3::new(far * cosine, far * sine, tube * up)
    };
    let places = |i: usize| (0..across).map(move |j| (i, j));
    let points = (0..around).flat_map(places).map(|(i, j)| point(i, j)).collect();
    let id = |i: usize, j: usize| (i % around) * across + j % across;
    let halves = |(i, j): (usize, usize)| {
        [vec![id(i, j), id(i + 1, j), id(i + 1, j + 1)], vec![id(i, j), id(i + 1, j + 1), id(i, j + 1)]]
    };
    let faces: Vec<Vec<usize>> = (0..around).flat_map(places).flat_map(halves).collect();
    Target::new(points, &faces).expect("it folds")
}

/// Panels a tenth of a millimetre inside their edges, with bevels for folds of 120 degrees.
fn panels(target: &Target, thickness: f64) -> Solids {
    let panel = |face: usize| {
        let (corners, up) = (target.corners(face), target.normal(face));
        let sides = [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).norm());
        let around: f64 = sides.iter().sum();
        let centre = (corners[0] * sides[1] + corners[1] * sides[2] + corners[2] * sides[0]) / around;
        let radius = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm() / around;
        let inside = radius - 1e-4;
        let outside = inside - thickness / 2.0 * libm::sqrt(3.0);
        let of_corner = |corner: Vec3| {
            let scaled = |to: f64| centre + (corner - centre) * (to / radius);
            let half = up * (thickness / 2.0);
            [scaled(inside), scaled(outside) + half, scaled(outside) - half]
        };
        let points: Vec<Vec3> = corners.iter().copied().flat_map(of_corner).collect();
        vec![Part::points(&points).moved(&panel_pose(corners, &up).inverse())]
    };
    Solids { parts: (0..target.faces.len()).map(panel).collect(), touch: 1e-5 }
}

/// What is found lies flat and meets nowhere, by a look in more states than the search takes, at panels that
/// are larger than those in the search; and the cheapest comes first.
#[test]
fn tori_are_cut_into_strips() {
    for [around, across] in [[6, 4], [8, 4], [12, 6]] {
        let target = torus(0.3, 0.1, around, across);
        let masses = vec![0.026; target.faces.len()];
        let weights = Weights::new(&target, &masses, Inertia::Lamina);
        let (solids, roots) = (panels(&target, 0.002), (0..target.faces.len()).collect::<Vec<_>>());
        assert_eq!(target_collisions(&target, &solids), Vec::<[usize; 2]>::new());
        let mut clearing = StripSearch {
            target: &target,
            weights: &weights,
            solids: &solids,
            roots: &roots,
            cheap: &[],
            seed: 0,
            states_left: 400_000_000,
        };
        let found = clearing.layouts();
        assert!(!found.is_empty(), "{around} by {across}");
        for layout in &found {
            assert_eq!(Pattern::of(&target, layout).overlaps(), Vec::<[usize; 2]>::new());
            assert_eq!(first_collision(&target, layout, &steps::leaves_first(layout), 0.015), None);
        }
        let energies: Vec<f64> = found.iter().map(|layout| layout.energy(&weights)).collect();
        assert!(energies.is_sorted(), "{energies:?}");
    }
}

/// In some layouts of a torus: where pairs meet at all there is
/// a first that meets, which is among them.
#[test]
fn all_that_meet_and_the_first_that_meet() {
    let target = torus(0.3, 0.1, 3, 3);
    let mut looked = [0, 0];
    enumerate::each(&target, 400, |hinges| {
        let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
        let steps = steps::leaves_first(&layout);
        let all = SweepCheck::thin(&target, &layout, 0.02).collisions(&steps, 24, usize::MAX);
        let first = first_collision(&target, &layout, &steps, 0.02);
        assert_eq!(first.is_none(), all.is_empty());
        if let Some(first) = first {
            let [a, b] = first.faces;
            assert!(all.contains(&[a.min(b), a.max(b)]), "{a} and {b} in {all:?}");
        }
        looked[usize::from(first.is_some())] += 1;
    })
    .expect("few faces");
    assert!(looked[1] > 0, "{looked:?}");
}

fn folded(shape: &str, rest: &str) -> Ran {
    let text = format!(
        "use std.mori.Panel
use std.shapes.torus
let ring = fold({shape}, module: Panel(thickness: 2mm), sequence: leaves_first{rest})
print(ring.energy >= ring.bound, ring.gap > 0, ring.gap < 1, ring.price > 1, ring.optimal)
print(len(ring.layout.hinges), len(ring.layout.overlaps))
emit(ring, \"ring.plan.json\")
"
    );
    run_text(&text, Mode::Run)
}

#[test]
fn a_torus_of_48_panels_is_planned() {
    let ran = folded("torus(radius: 200mm, tube: 80mm, around: 6, across: 4)", ", budget: 2_000_000");
    assert!(ran.outcome.diagnostics.is_empty(), "{:?}", ran.outcome.diagnostics);
    assert_eq!(ran.host.printed, ["true true true true false", "47 0"]);
    let plan = modl::plan::file::read(&String::from_utf8_lossy(&ran.host.written["ring.plan.json"]));
    assert!(modl::plan::verify::verify(&plan.expect("it reads back")).ok());
}

/// Across three panels a ring closes by more than 120 degrees at two of three edges, where the panels' bevels
/// leave room for 120 only, on a hinge and off it.
#[test]
fn edges_that_close_farther_than_bevels_leave_room_are_refused_at_once() {
    let ran = folded("torus(radius: 200mm, tube: 80mm, around: 5, across: 3)", ", budget: 2_000_000");
    let [said] = &ran.outcome.diagnostics[..] else { panic!("{:?}", ran.outcome.diagnostics) };
    assert_eq!(said.code.0, "E0803");
    assert!(said.message.contains("at their common edge they close to"), "{said:?}");
}

/// Three sectors about a hole that is too narrow.
#[test]
fn panels_that_are_in_each_other_are_refused_at_once() {
    let ran = folded("torus(radius: 200mm, tube: 80mm, around: 3, across: 3)", "");
    let [said] = &ran.outcome.diagnostics[..] else { panic!("{:?}", ran.outcome.diagnostics) };
    assert_eq!(said.code.0, "E0803");
    assert!(said.message.contains("panels 0 and 2 are in each other"), "{said:?}");
    assert!(said.hints[0].contains("thinner"), "{said:?}");
}
