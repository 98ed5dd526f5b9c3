//! Bounds of foldings over layouts and orders, against brute force: every layout, every root and every order of small
//! meshes, measured by arithmetic that is not the planner's.

use crate::planners::fold::{MASS, TRUTH, mesh, triangle};
use crate::support::properties::whole;
use modl::geometry::Vec3;
use modl::planners::NoProgress;
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::{
    Conventions, Count, Layout, Minimise, Objective, Orders, Plate, Problem, Report, Sequence, Settings,
    TOLERANCES, Target, plan, steps,
};
use nalgebra::{Rotation3, Unit};
use proptest::prelude::*;
use proptest::strategy::ValueTree;

/// The greatest difference of sums that are taken in another order.
const ROUNDING: f64 = 1e-11;

/// Shapes of four to six triangles, shaken, with faces taken away.
fn small() -> impl Strategy<Value = Target> {
    let names = vec!["tetrahedron", "triangular_bipyramid", "octahedron"];
    let shakes = proptest::collection::vec(-0.02..0.02_f64, 18);
    let taken = proptest::collection::vec(0..8usize, 3);
    (proptest::sample::select(names), shakes, taken, 4..7usize).prop_filter_map(
        "in one piece",
        |(name, shakes, taken, most)| {
            let (mut vertices, mut faces) = mesh(&TRUTH["shapes"][name]);
            for (vertex, shake) in vertices.iter_mut().zip(shakes.chunks(3)) {
                *vertex += Vec3::new(shake[0], shake[1], shake[2]);
            }
            for face in taken {
                if faces.len() > most {
                    faces.remove(face % faces.len());
                }
            }
            Target::new(vertices, &faces).ok().filter(|target| target.faces.len() <= 6)
        },
    )
}

/// Every layout with every root: sets of hinges, counted in binary, that close no ring.
fn every_layout(target: &Target) -> Vec<Layout> {
    let faces = target.faces.len();
    let sets = (0..1u32 << target.hinges.len()).filter(|set| set.count_ones() as usize == faces - 1);
    let hinges =
        |set: u32| (0..target.hinges.len()).filter(|hinge| set >> hinge & 1 == 1).collect::<Vec<_>>();
    let spans = |hinges: &Vec<usize>| {
        let mut piece: Vec<usize> = (0..faces).collect();
        hinges.iter().all(|hinge| {
            let [a, b] = target.hinges[*hinge].faces.map(|face| piece[face]);
            piece.iter_mut().filter(|p| **p == a).for_each(|p| *p = b);
            a != b
        })
    };
    let rooted = |hinges: Vec<usize>| {
        (0..faces).map(move |root| Layout::of_hinges(target, &hinges, root).expect("a tree"))
    };
    sets.map(hinges).filter(spans).flat_map(rooted).collect()
}

/// Every order of the hinges of a layout, one after the other.
fn every_order(layout: &Layout) -> Vec<Vec<usize>> {
    let mut orders: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 1..layout.parent.len() {
        orders = orders
            .into_iter()
            .flat_map(|order| {
                let rest =
                    (0..layout.parent.len()).filter(|face| *face != layout.root && !order.contains(face));
                rest.map(|face| [order.clone(), vec![face]].concat()).collect::<Vec<_>>()
            })
            .collect();
    }
    orders
}

/// The moments of inertia of one layout by face, by the face whose hinge turns it, and by which of the hinges
/// between the two have folded, bit by bit from the turning hinge down. Even triangles: three points in the middles
/// of the sides, which are exact for squares.
struct Moments {
    /// By face: itself and its ancestors up to the root's child, the root's child first.
    paths: Vec<Vec<usize>>,
    /// By face, by place in its path: kg·m².
    moments: Vec<Vec<Vec<f64>>>,
}

impl Moments {
    fn new(target: &Target, layout: &Layout, masses: &[f64]) -> Moments {
        let paths: Vec<Vec<usize>> = (0..masses.len())
            .map(|face| {
                let up = std::iter::successors(Some(face), |at| Some(layout.parent[*at]));
                let mut path: Vec<usize> = up.take_while(|at| *at != layout.root).collect();
                path.reverse();
                path
            })
            .collect();
        let line = |face: usize| {
            let hinge = &target.hinges[layout.hinge[face].expect("it is not the root")];
            let away = if hinge.faces[0] == layout.parent[face] { 1.0 } else { -1.0 };
            (hinge.point, hinge.axis * away, hinge.angle)
        };
        let moment = |face: usize, place: usize, folded: usize| {
            let path = &paths[face];
            // The face's own hinge opens first; those above carry its line along.
            let opened = |corner: Vec3| {
                (place + 1..path.len()).rev().filter(|at| folded >> (at - place - 1) & 1 == 0).fold(
                    corner,
                    |p, at| {
                        let (point, axis, angle) = line(path[at]);
                        point + Rotation3::from_axis_angle(&Unit::new_normalize(axis), -angle) * (p - point)
                    },
                )
            };
            let [a, b, c] = triangle(target, face).map(opened);
            let (point, axis, _) = line(path[place]);
            let distances = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0]
                .map(|p| (p - point).cross(&axis).norm_squared());
            masses[face] * distances.iter().sum::<f64>() / 3.0
        };
        let states = |face: usize, place: usize| 1usize << (paths[face].len() - place - 1);
        let of_place = |face: usize, place: usize| {
            (0..states(face, place)).map(|folded| moment(face, place, folded)).collect()
        };
        let of_face = |face: usize| (0..paths[face].len()).map(|place| of_place(face, place)).collect();
        let moments = (0..masses.len()).map(of_face).collect();
        Moments { paths, moments }
    }

    /// The energy that each face takes of the hinges above it in an order, for steps of one second.
    fn shares(&self, target: &Target, layout: &Layout, order: &[usize]) -> Vec<f64> {
        let mut shares = vec![0.0; self.paths.len()];
        self.each(target, layout, order, |face, _, energy| shares[face] += energy);
        shares
    }

    /// The mean torque of each hinge in an order, for steps of one second.
    fn means(&self, target: &Target, layout: &Layout, order: &[usize]) -> Vec<f64> {
        let mut means = vec![0.0; self.paths.len()];
        self.each(target, layout, order, |_, carrier, energy| means[carrier] += energy);
        means
    }

    /// Hands to `take` each face with each face above it whose hinge carries it, and the mean torque that this costs in an order.
    fn each(
        &self,
        target: &Target,
        layout: &Layout,
        order: &[usize],
        mut take: impl FnMut(usize, usize, f64),
    ) {
        let when: Vec<Option<usize>> =
            (0..self.paths.len()).map(|face| order.iter().position(|other| *other == face)).collect();
        for (face, (path, by_place)) in self.paths.iter().zip(&self.moments).enumerate() {
            for (place, moments) in by_place.iter().enumerate() {
                let carrier = path[place];
                let below = path[place + 1..].iter().enumerate();
                let folded: usize =
                    below.filter(|(_, face)| when[**face] < when[carrier]).map(|(i, _)| 1 << i).sum();
                let angle = target.hinges[layout.hinge[carrier].expect("it folds")].angle.abs();
                // The mean of the quintic's |acceleration| is 15/4.
                take(face, carrier, 15.0 / 4.0 * angle * moments[folded]);
            }
        }
    }
}

/// The value that is minimised, without gravity and with the hinges that move counted: the sum of means; or the
/// greatest torque, by the quintic's greatest acceleration of 10/√3.
fn value(means: &[f64], minimise: Minimise) -> f64 {
    match minimise {
        Minimise::PeakTorque => {
            means.iter().copied().fold(0.0, f64::max) * (10.0 / 3.0_f64.sqrt()) / (15.0 / 4.0)
        }
        Minimise::Energy | Minimise::Steps => means.iter().sum(),
    }
}

/// Without gravity, the hinges that move count, in steps of one second.
const OF_MOVING: Conventions =
    Conventions { inertia: Inertia::Lamina, count: Count::Moving, gravity: 0.0, step: 1.0 };

/// A strip of triangles with sides of 80 mm, folded by these angles about the edges between them.
fn strip(angles: &[f64]) -> Target {
    let mut points =
        vec![Vec3::zeros(), Vec3::new(0.04, 0.04 * 3.0_f64.sqrt(), 0.0), Vec3::new(0.08, 0.0, 0.0)];
    for (i, angle) in angles.iter().enumerate() {
        let [a, b, c] = [points[i], points[i + 1], points[i + 2]];
        let turn = Rotation3::from_axis_angle(&Unit::new_normalize(c - b), *angle);
        points.push(b + turn * (c - a));
    }
    let faces =
        (0..=angles.len()).map(|i| if i % 2 == 0 { vec![i, i + 2, i + 1] } else { vec![i, i + 1, i + 2] });
    Target::new(points, &faces.collect::<Vec<_>>()).expect("it folds")
}

/// A gravity, joints that count, and what is minimised.
fn circumstances() -> Vec<(f64, Count, Minimise)> {
    let mut all = Vec::new();
    for gravity in [0.0, 9.80665] {
        for count in [Count::Moving, Count::All] {
            all.extend([Minimise::Energy, Minimise::PeakTorque].map(|minimise| (gravity, count, minimise)));
        }
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if whole() { 200 } else { 6 }, failure_persistence: None, ..ProptestConfig::default() })]

    /// No order of any layout is below the bound for all orders, none that folds the root first below that for
    /// these, none that folds the leaves first below that.
    #[test]
    fn no_order_of_any_layout_undercuts_a_bound(target in small(), step in 0.5..2.0_f64, pick in 0..1000usize) {
        let masses: Vec<f64> = (0..target.faces.len()).map(|face| MASS * (1.0 + 0.2 * face as f64)).collect();
        let layouts = every_layout(&target);
        for (gravity, count, minimise) in circumstances() {
            let conventions = Conventions { inertia: Inertia::Lamina, count, gravity, step };
            let objective = Objective::new(&target, masses.clone(), conventions, minimise);
            for root in 0..target.faces.len() {
                let bound = |orders| objective.lower_bound(&[root], orders);
                let bounds = [Orders::Any, Orders::RootFirst, Orders::LeavesFirst].map(bound);
                prop_assert!(bounds.iter().all(|bound| *bound > 0.0 || gravity > 0.0), "{bounds:?}");
                let of_root = || layouts.iter().filter(|layout| layout.root == root);
                let mut least = [f64::INFINITY; 3];
                if gravity == 0.0 && count == Count::Moving {
                    for layout in of_root() {
                        let moments = Moments::new(&target, layout, &masses);
                        let value = |order: &[usize]| value(&moments.means(&target, layout, order), minimise) / (step * step);
                        let any = every_order(layout).iter().map(|order| value(order)).fold(f64::INFINITY, f64::min);
                        let found = [any, value(&steps::root_first(layout).concat()), value(&steps::leaves_first(layout).concat())];
                        least.iter_mut().zip(found).for_each(|(least, found)| *least = least.min(found));
                    }
                } else {
                    // Simulated: some of the layouts, in some of the orders, one hinge at a time and several.
                    let few = of_root().count().div_ceil(3);
                    for layout in of_root().skip(pick % few).step_by(few) {
                        let value = |steps: &[Vec<usize>]| {
                            let effort = objective.effort(layout, steps);
                            if minimise == Minimise::PeakTorque { effort.peak } else { effort.energy }
                        };
                        let orders = every_order(layout);
                        let few = orders.len().div_ceil(4);
                        let some = orders.iter().skip(pick % few).step_by(few);
                        let any = some.flat_map(|order| {
                            let alone: Vec<Vec<usize>> = order.iter().map(|face| vec![*face]).collect();
                            [value(&alone), value(&steps::of_order(layout, order))]
                        });
                        let found = [any.fold(f64::INFINITY, f64::min), value(&steps::root_first(layout)), value(&steps::leaves_first(layout))];
                        least.iter_mut().zip(found).for_each(|(least, found)| *least = least.min(found));
                        least[0] = least[0].min(least[1]).min(least[2]);
                    }
                }
                for (bound, least) in bounds.iter().zip(least) {
                    prop_assert!(*bound <= least * (1.0 + ROUNDING), "{bound} > {least}: {gravity} {count:?} {minimise:?}");
                }
            }
        }
    }

    /// The bound for all orders is the sum over the faces of what each takes in the layout and order that are best for it: of
    /// all paths from a face to the root some layout has each.
    #[test]
    fn the_bound_for_all_orders_is_the_sum_of_each_face_at_its_best(target in small()) {
        let masses: Vec<f64> = (0..target.faces.len()).map(|face| MASS * (1.0 + 0.2 * face as f64)).collect();
        let layouts = every_layout(&target);
        let objective = Objective::new(&target, masses.clone(), OF_MOVING, Minimise::Energy);
        for root in 0..target.faces.len() {
            let mut least = vec![f64::INFINITY; target.faces.len()];
            for layout in layouts.iter().filter(|layout| layout.root == root) {
                let moments = Moments::new(&target, layout, &masses);
                for order in every_order(layout) {
                    let shares = moments.shares(&target, layout, &order);
                    least.iter_mut().zip(shares).for_each(|(least, share)| *least = least.min(share));
                }
            }
            let (bound, wanted) = (objective.lower_bound(&[root], Orders::Any), least.iter().sum::<f64>());
            prop_assert!((bound / wanted - 1.0).abs() < 1e-8, "root {root}: {bound}, {wanted}");
        }
    }

    /// A strip has one layout. Its paths are longer than those of which every order is looked at: the bound is below
    /// the best of all orders, and no lower than where each hinge has each face at its nearest.
    #[test]
    fn the_bound_of_a_long_strip_is_between_free_hinges_and_the_best_order(
        angles in proptest::collection::vec(-2.0..2.0_f64, 7),
    ) {
        let target = strip(&angles);
        let masses = vec![MASS; target.faces.len()];
        let hinges: Vec<usize> = (0..target.hinges.len()).collect();
        let layout = Layout::of_hinges(&target, &hinges, 0).expect("a tree");
        let moments = Moments::new(&target, &layout, &masses);
        let energies = every_order(&layout).into_iter().map(|order| moments.means(&target, &layout, &order).iter().sum());
        let least = energies.fold(f64::INFINITY, f64::min);
        let mut free = 0.0;
        for (path, by_place) in moments.paths.iter().zip(&moments.moments) {
            for (carrier, poses) in path.iter().zip(by_place) {
                let angle = target.hinges[layout.hinge[*carrier].expect("it folds")].angle.abs();
                free += 15.0 / 4.0 * angle * poses.iter().copied().fold(f64::INFINITY, f64::min);
            }
        }
        let objective = Objective::new(&target, masses, OF_MOVING, Minimise::Energy);
        let bound = objective.lower_bound(&[0], Orders::Any);
        prop_assert!(bound <= least * (1.0 + ROUNDING) && bound >= free * (1.0 - 1e-9), "{free} {bound} {least}");
    }

    /// The bound for all orders is the least of the cheapest paths: on meshes so small that no path is cut off it
    /// is reached where one hinge folds.
    #[test]
    fn the_bound_of_two_panels_is_reached(angle in 0.1..3.0_f64, height in 0.03..0.1_f64) {
        let (sine, cosine) = libm::sincos(angle);
        let points = [[0.0, 0.0, 0.0], [0.08, 0.0, 0.0], [0.04, height, 0.0], [0.03, -height * cosine, height * sine]];
        let target = Target::new(points.map(Vec3::from).to_vec(), &[vec![0, 1, 2], vec![1, 0, 3]]).expect("it folds");
        let masses = vec![MASS; 2];
        let conventions = Conventions { inertia: Inertia::Lamina, count: Count::Moving, gravity: 0.0, step: 1.0 };
        // A triangle about its side: m h² / 6, with the fold angle.
        let wanted = 15.0 / 4.0 * angle * MASS * height * height / 6.0;
        for minimise in [Minimise::Energy, Minimise::PeakTorque] {
            let objective = Objective::new(&target, masses.clone(), conventions, minimise);
            let wanted = if minimise == Minimise::Energy { wanted } else { wanted * (10.0 / 3.0_f64.sqrt()) / (15.0 / 4.0) };
            for orders in [Orders::Any, Orders::RootFirst, Orders::LeavesFirst] {
                let bound = objective.lower_bound(&[0], orders);
                prop_assert!((bound / wanted - 1.0).abs() < 1e-8, "{orders:?}: {bound}, {wanted}");
            }
        }
    }
}

/// A folding that the planner answers with, and what it was asked for.
fn answer(target: &Target, settings: &Settings, hinges: Option<&Layout>, gravity: f64) -> Option<Report> {
    let panels = Plate { thickness: 0.001, ..Plate::default() }.panels(target).ok()?;
    let pairs =
        hinges.map(|layout| layout.hinges().into_iter().map(|hinge| target.hinges[hinge].faces).collect());
    let root = hinges.map(|layout| layout.root);
    let problem = Problem { root, gravity, hinges: pairs, ..Problem::new(target.clone(), panels) };
    plan(&problem, settings, &mut NoProgress).ok().map(|solution| solution.report)
}

fn minimised(report: &Report) -> f64 {
    if report.minimise == Minimise::PeakTorque { report.effort.peak } else { report.effort.energy }
}

/// Asks for a folding in every way and compares with every layout, folded in that way by itself; where the
/// planner took another order, with all orders.
fn compare(
    target: &Target,
    sequence: Sequence,
    gravity: f64,
    count: Count,
    minimise: Minimise,
) -> Option<bool> {
    let settings = Settings { sequence, count, minimise, step: Some(6.0), ..Settings::default() };
    let report = answer(target, &settings, None, gravity)?;
    let (found, what) = (minimised(&report), format!("{sequence:?} {gravity} {count:?} {minimise:?}"));
    assert!(report.bound <= found, "{} > {found}: {what}", report.bound);
    let gap = 1.0 - report.bound / found;
    let is_proved = gap <= TOLERANCES.proof;
    let steps_tie = minimise != Minimise::Steps || report.steps.len() == report.fewest_steps;
    assert_eq!(report.gap(), if is_proved { 0.0 } else { gap }, "{what}");
    assert!(report.optimal == is_proved || !steps_tie && is_proved, "{what}: gap {gap}, {}", report.optimal);
    // The judge and the measure of the planner, one layout at a time.
    let mut least = f64::INFINITY;
    for layout in every_layout(target) {
        let Some(alone) = answer(target, &settings, Some(&layout), gravity) else { continue };
        let fewer = minimise == Minimise::Steps && alone.steps.len() < report.steps.len();
        let more = minimise == Minimise::Steps && alone.steps.len() > report.steps.len();
        assert!(!(report.optimal && fewer), "{what}: {:?} takes fewer steps", alone.steps);
        if !fewer && !more {
            least = least.min(minimised(&alone));
        }
    }
    // Without gravity every order can be measured, whether or not the judge lets it pass.
    if least.is_infinite() && gravity == 0.0 && count == Count::Moving {
        let by_square = 1.0 / (report.conventions.step * report.conventions.step);
        for layout in every_layout(target) {
            let moments = Moments::new(target, &layout, &report.masses);
            for order in every_order(&layout) {
                least = least.min(value(&moments.means(target, &layout, &order), minimise) * by_square);
            }
        }
    }
    assert!(report.bound <= least * (1.0 + ROUNDING), "{} > {least}: {what}", report.bound);
    if report.optimal && least.is_finite() {
        assert!(found <= least * (1.0 + TOLERANCES.proof + ROUNDING), "{found} > {least}: {what}");
    }
    Some(report.optimal)
}

/// Whatever is asked for, the bound that is stated is below everything that could have been the answer, and
/// what is called optimal is.
#[test]
fn stated_bounds_hold_for_all_that_could_have_been_the_answer() {
    let cases = if whole() { 40 } else { 2 };
    let small = small().prop_filter("few layouts", |target| target.faces.len() <= 5);
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut answers, mut optimal) = (0, 0);
    for case in 0..cases {
        let target = small.new_tree(&mut runner).expect("a shape").current();
        let sequences = [
            Sequence::Auto,
            Sequence::LeavesFirst,
            Sequence::RootFirst,
            Sequence::LeastWork,
            Sequence::LeastEnergy,
        ];
        for (index, sequence) in sequences.into_iter().enumerate() {
            for (place, (gravity, count, minimise)) in circumstances().into_iter().enumerate() {
                // Each shape in some of the ways, all ways among them.
                if (case + index + place) % 4 == 0 {
                    let found = compare(&target, sequence, gravity, count, minimise);
                    answers += usize::from(found.is_some());
                    optimal += usize::from(found == Some(true));
                }
            }
            if (case + index) % 4 == 0
                && let Some(is_optimal) = compare(&target, sequence, 0.0, Count::Moving, Minimise::Steps)
            {
                answers += 1;
                optimal += usize::from(is_optimal);
            }
        }
    }
    assert!(answers >= 5 * cases && optimal >= cases, "{optimal} of {answers} proved");
}

/// No order, method or quantity that can be asked for leads to less energy than the default, which is no less than
/// the least of every order of every layout, as is its bound.
#[test]
fn nothing_that_can_be_asked_for_spends_less_than_the_default() {
    let cases = if whole() { 60 } else { 4 };
    let shapes = small();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut answers = 0;
    for _ in 0..cases {
        let target = shapes.new_tree(&mut runner).expect("a shape").current();
        let plain = Settings { step: Some(6.0), ..Settings::default() };
        let Some(free) = answer(&target, &plain, None, 0.0) else { continue };
        answers += 1;
        let energy = free.effort.energy;
        let sequences =
            [Sequence::LeavesFirst, Sequence::RootFirst, Sequence::LeastWork, Sequence::LeastEnergy];
        for sequence in sequences {
            for minimise in [Minimise::Energy, Minimise::PeakTorque, Minimise::Steps] {
                let settings = Settings { sequence, minimise, ..plain };
                if let Some(other) = answer(&target, &settings, None, 0.0) {
                    let less = other.effort.energy;
                    assert!(
                        energy <= less * (1.0 + TOLERANCES.proof),
                        "{sequence:?} {minimise:?}: {less} < {energy}"
                    );
                }
            }
        }
        let mut least = f64::INFINITY;
        for layout in every_layout(&target) {
            let moments = Moments::new(&target, &layout, &free.masses);
            for order in every_order(&layout) {
                least = least.min(value(&moments.means(&target, &layout, &order), Minimise::Energy) / 36.0);
            }
        }
        assert!(
            energy >= least * (1.0 - ROUNDING) && free.bound <= least * (1.0 + ROUNDING),
            "{energy} {least}"
        );
    }
    assert!(answers >= cases / 2, "{answers} of {cases} shapes were folded");
}
