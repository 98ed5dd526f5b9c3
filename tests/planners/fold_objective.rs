//! What foldings are judged by: peaks and energies under conventions, orders at random, panels without
//! motors, hinges too thick to close.

use crate::planners::fold::{MASS, TRUTH, index, near, number, pairs, permutations, shaken, target};
use modl::planners::fold::Observer;
use modl::planners::fold::branch_and_bound::{Decision, NoLayout};
use modl::planners::fold::heuristic::{Measure, preferred};
use modl::planners::fold::inertia::{Body, Inertia};
use modl::planners::fold::local_search::{Measured, Settings, search};
use modl::planners::fold::random_orders::sample;
use modl::planners::fold::simulation::{Circumstances, Count, simulate};
use modl::planners::fold::{Conventions, Minimise, Objective, Orders};
use modl::planners::fold::{
    Layout, Proof, Target, Unfoldable, Weights, branch_and_bound, edge_exchange, energy_order, enumerate,
    steps, thickness, work_order,
};
use proptest::prelude::*;
use serde_json::Value;

const TEXT: Conventions =
    Conventions { inertia: Inertia::Lamina, count: Count::Moving, gravity: 0.0, step: 1.0 };

fn objective(target: &Target, conventions: Conventions, minimise: Minimise) -> Objective<'_> {
    Objective::new(target, vec![MASS; target.faces.len()], conventions, minimise)
}

fn surveyed(objective: &Objective, target: &Target, root: Option<usize>, budget: u64) -> Measured {
    let roots = root.map_or_else(|| (0..target.faces.len()).collect(), |root| vec![root]);
    let settings = Settings { roots, flat: false, budget, keep: 4, prefilter: None };
    search(target, &objective.weights, &settings, &mut |layout| objective.value(layout), &Observer::none())
}

/// Sums over sets of faces find the same layouts, ties and least values as measuring each.
#[test]
fn a_glance_leaves_out_nothing_that_is_good() {
    for (name, root) in [("octahedron", None), ("triangular_bipyramid", None), ("quadruped_turtle", Some(5))]
    {
        let target = target(name);
        let objective = objective(&target, TEXT, Minimise::PeakTorque);
        let measured = surveyed(&objective, &target, root, u64::MAX);
        let roots = root.map_or_else(|| (0..target.faces.len()).collect(), |root| vec![root]);
        let prefilter = objective.prefilter(u64::MAX);
        assert!(prefilter.is_some());
        let settings = Settings { roots, flat: false, budget: 0, keep: 4, prefilter };
        let (mut made, trees) = (
            0,
            TRUTH["shapes"][name]["spanning_trees"]
                .as_str()
                .and_then(|n| n.parse::<usize>().ok())
                .expect("a number"),
        );
        let glanced = search(
            &target,
            &objective.weights,
            &settings,
            &mut |layout| {
                made += 1;
                objective.value(layout)
            },
            &Observer::none(),
        );
        assert!(glanced.complete && measured.complete, "{name}");
        assert_eq!(glanced.best, measured.best, "{name}");
        assert_eq!((glanced.ties, &glanced.roots), (measured.ties, &measured.roots), "{name}");
        assert!(glanced.least == measured.least && made < trees, "{made} of {trees} {name}");
    }
}

/// The sequences that are also compared with random orders.
fn compared() -> impl Iterator<Item = (&'static Value, &'static Value)> {
    let list = |key: &str| TRUTH[key].as_array().expect("a list").iter();
    list("monte_carlo").flat_map(move |sampled| {
        list("sequences").filter(|s| s["one_optimal_order"] == sampled["order"]).map(move |s| (s, sampled))
    })
}

fn faces(value: &Value) -> Vec<usize> {
    value.as_array().expect("a list").iter().map(index).collect()
}

/// Rates of the other program's thousand orders; ours are as many others.
#[test]
fn random_orders_are_worse_as_often_as_another_program_found() {
    let mut seen = 0;
    for (case, sampled) in compared() {
        seen += 1;
        let target = target(case["shape"].as_str().expect("a name"));
        let layout = Layout::of_pairs(&target, &pairs(&case["tree"]), index(&case["root"])).expect("a tree");
        let masses = vec![MASS; target.faces.len()];
        let energy =
            |order: &[usize]| energy_order::energy(&target, &layout, &masses, Inertia::Lamina, order);
        let objective = objective(&target, TEXT, Minimise::Energy);
        let leaves = energy(&steps::leaves_first(&layout).concat());
        for (reference, rate) in
            [(energy(&faces(&sampled["order"])), "rate_MI_own_nograv"), (leaves, "rate_leaf_own")]
        {
            let found = sample(
                &layout,
                1000,
                7,
                reference,
                |steps| objective.effort(&layout, steps).energy,
                &Observer::none(),
            );
            let wanted = number(&sampled[rate]);
            // Both rates are of a thousand: four standard deviations of their difference.
            let spread = 4.0 * libm::sqrt(2.0 * wanted * (1.0 - wanted) / 1000.0) + 2e-3;
            let rate = found.worse as f64 / 1000.0;
            assert!((rate - wanted).abs() < spread, "{}: {rate}, not {wanted}", sampled["name"]);
            assert!(found.least <= found.mean && found.mean <= found.greatest);
        }
        let loads = vec![MASS * 9.8; masses.len()];
        let work = |steps: &[Vec<usize>]| work_order::work(&target, &layout, &loads, &steps.concat());
        let found = sample(&layout, 1000, 7, number(&sampled["cost"]), work, &Observer::none());
        assert!(near(found.mean, number(&sampled["random_cost_mean"]), 0.01), "{}", sampled["name"]);
        assert!((found.worse as f64 / 1000.0 - number(&sampled["frac_random_cost_gt"])).abs() < 0.07);
    }
    assert_eq!(seen, 3);
}

/// Under gravity, all joints counted, in steps: rates again.
#[test]
fn random_orders_under_gravity_are_worse_as_often() {
    let (case, sampled) = compared().next().expect("there are some");
    let target = target("octahedron");
    let layout = Layout::of_pairs(&target, &pairs(&case["tree"]), 0).expect("a tree");
    let under = Conventions { inertia: Inertia::Point, count: Count::All, gravity: 9.8, step: 0.22 };
    let objective = objective(&target, under, Minimise::Energy);
    let leaves = objective.leaves_first(&layout).energy;
    let found =
        sample(&layout, 300, 3, leaves, |steps| objective.effort(&layout, steps).energy, &Observer::none());
    let rate = found.worse as f64 / 300.0;
    assert!((rate - number(&sampled["rate_leaf_allgrav"])).abs() < 0.11, "{rate}");
}

/// Theorem 1 with each root: how it ranks, and what its choice costs.
#[test]
fn the_heuristic_ranks_as_another_program_found() {
    for name in ["tetrahedron", "octahedron", "quadruped_turtle"] {
        let target = target(name);
        let weights = Weights::uniform(&target, MASS);
        let side = (target.corners(0)[1] - target.corners(0)[0]).norm();
        let measure = Measure::of_panels(MASS, side);
        for case in TRUTH["shapes"][name]["MI_full"]["MII_per_root"].as_array().expect("a list") {
            let root = index(&case["root"]);
            let found = preferred(&target, &measure, Some(root), u64::MAX).expect("few faces");
            assert_eq!(found.ties, case["ties"].as_u64().expect("a count"), "{name} at {root}");
            let mut energies = Vec::new();
            enumerate::each(&target, u64::MAX, |hinges| {
                energies.push(Layout::of_hinges(&target, hinges, root).expect("a tree").energy(&weights));
            })
            .expect("few faces");
            energies.sort_by(f64::total_cmp);
            let chosen = found.layout.energy(&weights);
            let better = energies.iter().filter(|e| **e < chosen * (1.0 - 1e-9)).count();
            assert_eq!(better + 1, index(&case["best_rank"]), "{name} at {root}");
            assert!(near(chosen / energies[0], number(&case["ratio_worst"]), 1e-9), "{name} at {root}");
            assert_eq!(Value::Bool(chosen < energies[energies.len() / 2]), case["below_median"], "{name}");
        }
    }
}

/// Of all orders, how many take the least work.
#[test]
fn as_many_orders_are_optimal_as_another_program_counted() {
    let (case, sampled) = compared().next().expect("there are some");
    let target = target("octahedron");
    let layout = Layout::of_pairs(&target, &pairs(&case["tree"]), 0).expect("a tree");
    let loads = vec![MASS * 9.8; 8];
    let least = number(&sampled["lb"]);
    assert!(near(work_order::bound(&target, &layout, &loads), least, 1e-9));
    let (mut optimal, mut all) = (0, 0);
    permutations(&mut (1..8).collect(), 0, &mut |order| {
        all += 1;
        optimal += usize::from(near(work_order::work(&target, &layout, &loads, order), least, 1e-9));
    });
    assert_eq!([optimal, all], [index(&sampled["optimal_orders"]), index(&sampled["total_orders"])]);
}

/// A survey of every layout finds what branch and bound proves, and counts what ties.
#[test]
fn a_survey_of_all_finds_the_optimum() {
    let target = target("octahedron");
    let by_energy = objective(&target, TEXT, Minimise::Energy);
    let all = surveyed(&by_energy, &target, None, 10_000);
    let best = branch_and_bound::optimum(&target, &by_energy.weights, &branch_and_bound::Settings::default())
        .expect("it has layouts");
    assert!(all.complete && near(all.least, best.energy, 1e-9));
    assert_eq!((all.ties, all.roots), (192, (0..8).collect::<Vec<_>>()));
    let some = surveyed(&by_energy, &target, Some(0), 100);
    assert!(!some.complete && near(some.least, best.energy, 1e-9), "exchanges reach it, too");
}

/// Fewest steps: the root's distance to the farthest face; two for a tetrahedron's star is one.
#[test]
fn the_fewest_steps_are_the_radius() {
    for (name, steps) in [("tetrahedron", 1), ("octahedron", 3), ("quadruped_turtle", 4)] {
        let target = target(name);
        let objective = objective(&target, TEXT, Minimise::Steps);
        assert_eq!(objective.fewest_steps(None), steps, "{name}");
        let found = surveyed(&objective, &target, None, 10_000);
        assert_eq!(found.best[0].1[0], steps as f64, "{name}");
        // Of those, the one of least energy, by proof.
        let height =
            branch_and_bound::Settings { height: Some(steps), ..branch_and_bound::Settings::default() };
        let best = branch_and_bound::optimum(&target, &objective.weights, &height).expect("there are some");
        assert_eq!((best.proof, best.layout.heights()[best.layout.root]), (Proof::Optimal, steps), "{name}");
        assert!(near(best.energy, found.best[0].1[1], 1e-9), "{name}");
        let lower = branch_and_bound::Settings { height: Some(steps - 1), ..height };
        assert_eq!(
            branch_and_bound::optimum(&target, &objective.weights, &lower).err(),
            Some(NoLayout::AllOverlap)
        );
    }
}

/// Layouts are asked for in order of their energy, and no other is passed over.
#[test]
fn refused_layouts_are_followed_by_the_next_best() {
    let target = target("triangular_bipyramid");
    let weights = Weights::uniform(&target, MASS);
    let mut energies = Vec::new();
    enumerate::each(&target, u64::MAX, |hinges| {
        energies.push(Layout::of_hinges(&target, hinges, 0).expect("a tree").energy(&weights));
    })
    .expect("few faces");
    energies.sort_by(f64::total_cmp);
    let settings = branch_and_bound::Settings { root: Some(0), ..branch_and_bound::Settings::default() };
    for refused in [0, 1, 5, 74, 75] {
        let mut asked: Vec<Layout> = Vec::new();
        let best = branch_and_bound::optimum_among(&target, &weights, &settings, &mut |layout| {
            assert!(!asked.contains(layout), "each is asked for once");
            asked.push(layout.clone());
            if asked.len() > refused { Decision::Accept } else { Decision::Refuse }
        });
        for (layout, energy) in asked.iter().zip(&energies) {
            assert!(near(layout.energy(&weights), *energy, 3e-9));
        }
        match best {
            Ok(best) => assert!(best.proof == Proof::Optimal && near(best.energy, energies[refused], 3e-9)),
            Err(why) => assert!(refused == 75 && why == NoLayout::AllOverlap && asked.len() == 75),
        }
    }
    let stopped = branch_and_bound::optimum_among(&target, &weights, &settings, &mut |_| Decision::Stop);
    assert_eq!(stopped.err(), Some(NoLayout::Budget));
}

#[test]
fn panels_without_motors_weigh_less_and_share_no_hinge() {
    let target = target("octahedron");
    let mut driven = [true; 8];
    (driven[0], driven[1]) = (false, false);
    let some = target.clone().driven(&driven).expect("the others reach them");
    assert_eq!((some.hinges.len(), some.hinge_between(0, 1)), (target.hinges.len() - 1, None));
    assert!(matches!(target.clone().driven(&[false; 8]), Err(Unfoldable::Undriven { .. })));
    // Less mass, less energy: in proportion where all panels are lighter.
    let light = Weights::new(&target, &[0.008; 8], Inertia::Lamina);
    let best = |weights: &Weights| {
        branch_and_bound::optimum(&target, weights, &branch_and_bound::Settings::default())
            .expect("layouts")
            .energy
    };
    assert!(near(best(&light) / best(&Weights::uniform(&target, MASS)), 8.0 / 26.0, 1e-12));
}

/// Eq. 1: panels of 6 mm on hinges of 6 mm close up to 60 degrees, so fold by 120 at most.
#[test]
fn hinges_too_thick_to_close_are_named() {
    let opening = thickness::least_opening(0.006, 0.006);
    assert!(near(opening, std::f64::consts::FRAC_PI_3, 1e-12));
    let tetrahedron = target("tetrahedron");
    let star = Layout::of_pairs(&tetrahedron, &[[0, 1], [0, 2], [0, 3]], 0).expect("a tree");
    assert_eq!(
        thickness::too_thick(&tetrahedron, &star, opening),
        [0; 0],
        "109.47 degrees are less than 120"
    );
    let thicker = thickness::least_opening(0.006, 0.005);
    assert_eq!(thickness::too_thick(&tetrahedron, &star, thicker), [1, 2, 3], "106.3 degrees are less");
    assert!(near(thickness::least_opening(0.006, 0.001), std::f64::consts::PI, 1e-12));
}

proptest! {
    #![proptest_config(crate::support::properties::cases(24))]

    /// Peaks by the closed form are those of the simulation, and no layout undercuts the bounds.
    #[test]
    fn peaks_and_bounds_hold(target in shaken(), root in 0..18usize, pick in 0..1000u64, gravity in 0.0..10.0_f64) {
        let root = root % target.faces.len();
        let mut seen = 0;
        let mut layout = None;
        enumerate::each(&target, pick + 1, |hinges| {
            if seen <= pick {
                layout = Layout::of_hinges(&target, hinges, root);
            }
            seen += 1;
        }).expect("few faces");
        let layout = layout.expect("there is a first");
        let plain = objective(&target, TEXT, Minimise::PeakTorque);
        let order = steps::leaves_first(&layout);
        let bodies = Body::of_target(&target, &vec![MASS; target.faces.len()], Inertia::Lamina);
        let simulated = simulate(&target, &layout, &bodies, &order, &Circumstances { step: 1.0, gravity: 0.0 });
        let peak = plain.leaves_first(&layout).peak;
        prop_assert!(near(peak, simulated.peak(Count::Moving, &order), 1e-9));
        prop_assert!(near(peak, plain.effort(&layout, &order).peak, 1e-9));
        for (count, gravity) in [(Count::Moving, 0.0), (Count::All, 0.0), (Count::Moving, gravity), (Count::All, gravity)] {
            for minimise in [Minimise::Energy, Minimise::PeakTorque] {
                let objective = objective(&target, Conventions { count, gravity, ..TEXT }, minimise);
                let value = objective.value(&layout)[0];
                prop_assert!(objective.lower_bound(&[root], Orders::LeavesFirst) <= value * (1.0 + 1e-9), "{count:?} {gravity} {minimise:?}");
            }
        }
    }
}

/// Where all hinges fold by one angle, what a face gains in height by a hinge is its mean torque by one
/// factor, whatever the layout: the bound under gravity is that factor by the work of lifting all.
#[test]
fn under_gravity_the_bound_of_a_regular_shape_is_its_lifting() {
    for name in ["tetrahedron", "octahedron", "icosahedron"] {
        let target = target(name);
        let conventions = Conventions { gravity: 9.80665, step: 2.0, ..TEXT };
        let objective = objective(&target, conventions, Minimise::Energy);
        let up = -target.normal(0);
        let height = |face: usize| up.dot(&(target.centroid(face) - target.centroid(0)));
        let lifting: f64 = (0..target.faces.len()).map(|face| MASS * 9.80665 * height(face)).sum();
        // The mean of cos(φ (s - 1/2)) by Simpson's rule.
        let angle = target.hinges[0].angle.abs();
        let law = |x: f64| x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
        let value = |x: f64| libm::cos(angle * (law(x) - 0.5));
        let n = 1000;
        let simpson: f64 = (0..=n)
            .map(|i| {
                let factor = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                factor * value(i as f64 / n as f64) / (3.0 * n as f64)
            })
            .sum();
        let wanted = lifting * simpson / (2.0 * libm::sin(angle / 2.0));
        let bound = objective.lower_bound(&[0], Orders::LeavesFirst);
        assert!(near(bound, wanted, 1e-6), "{name}: {bound}, {wanted}");
        let grown = edge_exchange::grown(&target, &objective.weights, 0);
        assert!(bound <= objective.leaves_first(&grown).energy);
    }
}
