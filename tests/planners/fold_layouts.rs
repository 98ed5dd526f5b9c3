//! Layouts compared with each other, against values found by hand, by Kirchhoff's theorem and by counting.

use crate::planners::fold::{TRUTH, mesh};
use modl::planners::NoProgress;
use modl::planners::fold::{Layout, Plate, Problem, Report, Sequence, Settings, Target, plan};
use std::collections::BTreeMap;

/// The report of a shape of the truth, folded with the leaves first from its first face.
fn folded(name: &str) -> Report {
    let (vertices, faces) = mesh(&TRUTH["shapes"][name]);
    let target = Target::new(vertices, &faces).expect("it folds");
    let panels = Plate::default().panels(&target).expect("they are panels");
    let problem = Problem { root: Some(0), ..Problem::new(target, panels) };
    let settings = Settings { sequence: Sequence::LeavesFirst, ..Settings::default() };
    plan(&problem, &settings, &mut NoProgress).expect("it folds").report
}

/// By hand, all 64 pairs of a layout and a root of the tetrahedron take 1, 16/9, 23/9 and 10/3 of the least: 4, 24, 12
/// and 24 of them, and a quarter of each with each root, since all its faces are alike.
#[test]
fn the_layouts_of_a_tetrahedron_take_what_they_take_by_hand() {
    let report = folded("tetrahedron");
    let all = report.compare_layouts(1000, 0, &mut NoProgress);
    assert!(all.complete);
    assert_eq!(all.layouts.len(), 16);
    let least = all.energies[all.best()];
    let mut ratios: Vec<f64> = all.energies.iter().map(|energy| energy / least).collect();
    ratios.sort_by(f64::total_cmp);
    let by_hand = [(1.0, 1), (16.0 / 9.0, 6), (23.0 / 9.0, 3), (10.0 / 3.0, 6)];
    let expected: Vec<f64> = by_hand.iter().flat_map(|&(ratio, count)| vec![ratio; count]).collect();
    assert!(ratios.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{ratios:?}");
    // The eighth and the ninth are 23/9.
    assert!((all.median() / least - 23.0 / 9.0).abs() < 1e-9);
    assert!((all.greatest() / least - 10.0 / 3.0).abs() < 1e-9);
    assert_eq!(all.rank(least), 1);
    assert_eq!(all.rank(all.median()), 8);
    // The planner's own layout is the best, with the leaves first.
    assert_eq!(all.rank(all.reference), 1);
}

/// The breadth-first trees of the cube, whose graph is that of the octahedron's faces, take the least: 24 with each root.
#[test]
fn the_best_layouts_of_an_octahedron_are_the_breadth_first_trees() {
    let all = folded("octahedron").compare_layouts(1000, 0, &mut NoProgress);
    assert_eq!(all.layouts.len(), 384);
    let least = all.energies[all.best()];
    assert_eq!(all.energies.iter().filter(|energy| **energy < least * (1.0 + 1e-9)).count(), 24);
    assert!((all.greatest() / least - 3.684_210_526).abs() < 1e-8);
}

/// Each of the sixteen spanning trees of four faces that all touch is drawn as often as any other: Pearson's statistic of
/// fifteen degrees of freedom is above 37.7 once in a thousand.
#[test]
fn random_layouts_are_trees_and_equally_likely() {
    let report = folded("tetrahedron");
    let mut counts: BTreeMap<Vec<[usize; 2]>, u32> = BTreeMap::new();
    for seed in 0..400 {
        let drawn = report.compare_layouts(10, seed, &mut NoProgress);
        assert!(!drawn.complete);
        drawn.layouts.into_iter().for_each(|layout| *counts.entry(layout).or_default() += 1);
    }
    assert_eq!(counts.len(), 16);
    let statistic: f64 = {
        let off = counts.values().map(|count| f64::from(*count) - 250.0);
        off.map(|off| off * off / 250.0).sum()
    };
    assert!(statistic < 37.7, "{statistic}");
    // Of a larger shape: trees, none the same, and the same by the same seed.
    let report = folded("icosahedron");
    let drawn = report.compare_layouts(200, 3, &mut NoProgress);
    let mut different = drawn.layouts.clone();
    different.sort();
    different.dedup();
    assert_eq!(different.len(), 200);
    for layout in &drawn.layouts {
        assert!(Layout::of_pairs(&report.target, layout, 0).is_some());
    }
    assert_eq!(drawn, report.compare_layouts(200, 3, &mut NoProgress));
}
