//! Hinges that stop on their way: what they spend, what bounds that, and a shape that needs them.

use crate::language::interpret::{Ran, ran};
use crate::planners::fold::{MASS, near, target};
use crate::support::suite::MapFiles;
use modl::geometry::Vec3;
use modl::interpret::{Mode, Options};
use modl::planners::fold::inertia::{Inertia, moment_about, moment_in};
use modl::planners::fold::kinematics::poses_at;
use modl::planners::fold::simulation::Count;
use modl::planners::fold::turns::{Turn, turns};
use modl::planners::fold::{
    Conventions, Effort, Layout, Minimise, Objective, Orders, Stop, Target, enumerate, steps,
};
use proptest::prelude::*;
use serde_json::Value;

/// Steps of half a second; nothing weighs.
const CONVENTIONS: Conventions =
    Conventions { inertia: Inertia::Lamina, count: Count::Moving, gravity: 0.0, step: 0.5 };

/// The mean of the quintic law's absolute acceleration, and its greatest, over one unit in one second.
const MEAN: f64 = 3.75;
const PEAK: f64 = 5.773_502_691_896_258;

/// A layout by its number among all of a target.
fn layout(target: &Target, number: usize, root: usize) -> Layout {
    let mut all = Vec::new();
    enumerate::each(target, u64::MAX, |hinges| all.push(hinges.to_vec())).expect("few faces");
    Layout::of_hinges(target, &all[number % all.len()], root).expect("a tree")
}

/// One turn of one hinge after the other: each hinge in the order of `picks` goes by the part of `parts` of what is left of
/// its way, and in the end each to its fold angle.
fn stopping(target: &Target, layout: &Layout, picks: &[(usize, f64)]) -> (Vec<Vec<usize>>, Vec<Stop>) {
    let mut angles = vec![0.0; target.faces.len()];
    let (mut steps, mut stops) = (Vec::new(), Vec::new());
    for &(pick, part) in picks {
        let face = layout.order[1 + pick % (target.faces.len() - 1)];
        angles[face] += (layout.angle(target, face) - angles[face]) * part;
        stops.push(Stop { step: steps.len(), face, angle: angles[face] });
        steps.push(vec![face]);
    }
    steps.extend(layout.order[1..].iter().map(|face| vec![*face]));
    (steps, stops)
}

/// Returns the energy that the hinges spend if each turns one rigid body, in the form that it has at the time.
fn spent(target: &Target, layout: &Layout, turns: &[Vec<Turn>]) -> Effort {
    let mut angles = vec![0.0; target.faces.len()];
    let mut effort = Effort { energy: 0.0, peak: 0.0 };
    for &Turn { face, from, to } in turns.iter().flatten() {
        assert_eq!(angles[face], from, "a hinge goes on from where it has stopped");
        let poses = poses_at(target, layout, |face| angles[face]);
        let hinge = &target.hinges[layout.hinge[face].expect("the root does not turn")];
        let above = poses[layout.parent[face]];
        let (point, axis) = (above.transform_point(&hinge.point.into()).coords, above.rotation * hinge.axis);
        let carried = (0..angles.len()).filter(|below| layout.is_above(face, *below));
        let moment: f64 = carried
            .map(|f| moment_in(&poses[f], target.corners(f), MASS, Inertia::Lamina, &point, &axis))
            .sum();
        let by_square = (to - from).abs() * moment / (CONVENTIONS.step * CONVENTIONS.step);
        effort.energy += MEAN * by_square;
        effort.peak = effort.peak.max(PEAK * by_square);
        angles[face] = to;
    }
    for (face, angle) in angles.iter().enumerate() {
        assert!(near(*angle, layout.angle(target, face), 1e-15), "face {face} is folded in the end");
    }
    effort
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// The simulation of turns is what rigid bodies take, and the bound for turns with stops is below it.
    #[test]
    fn stops_cost_what_hinges_carry(
        number in 0usize..384,
        root in 0usize..8,
        picks in prop::collection::vec((0usize..7, 0.05..0.95), 1..9),
    ) {
        let target = target("octahedron");
        let layout = layout(&target, number, root);
        let (steps, stops) = stopping(&target, &layout, &picks);
        let objective = Objective::new(&target, vec![MASS; 8], CONVENTIONS, Minimise::Energy);
        let effort = objective.effort_with_stops(&layout, &steps, &stops);
        let truth = spent(&target, &layout, &turns(&target, &layout, &steps, &stops));
        prop_assert!(near(effort.energy, truth.energy, 1e-9), "{} is not {}", effort.energy, truth.energy);
        prop_assert!(near(effort.peak, truth.peak, 1e-9), "{} is not {}", effort.peak, truth.peak);
        let bound = objective.lower_bound(&[root], Orders::WithStops);
        prop_assert!(bound > 0.0 && bound <= truth.energy);
        prop_assert!(bound <= objective.leaves_first(&layout).energy);
    }
}

/// Three flaps about one panel spend the same whatever stops, and nothing spends less: the bound is their closed form.
#[test]
fn the_bound_with_stops_is_reached_by_a_star() {
    let target = target("tetrahedron");
    let star = (0..16).map(|number| layout(&target, number, 0)).find(|layout| layout.heights()[0] == 1);
    let star = star.expect("one of them is a star");
    let (steps, stops) = stopping(&target, &star, &[(0, 0.5), (1, 0.25), (0, 0.75)]);
    let objective = Objective::new(&target, vec![MASS; 4], CONVENTIONS, Minimise::Energy);
    let bound = objective.lower_bound(&[0], Orders::WithStops);
    let by = objective.effort_with_stops(&star, &steps, &stops).energy;
    // A triangle about a side of 80 mm: m l²/8. The hinges turn by π - acos(1/3).
    let angle = std::f64::consts::PI - libm::acos(1.0 / 3.0);
    let truth = MEAN * 3.0 * angle * MASS * 0.08 * 0.08 / 8.0 / (CONVENTIONS.step * CONVENTIONS.step);
    assert!(near(by, truth, 1e-9) && near(bound, truth, 1e-9), "{by} and {bound} are not {truth}");
    let whole = objective.effort(&star, &steps::leaves_first(&star)).energy;
    assert!(near(whole, truth, 1e-9));
    // Many stops take as little torque as one likes.
    let objective = Objective::new(&target, vec![MASS; 4], CONVENTIONS, Minimise::PeakTorque);
    assert_eq!(objective.lower_bound(&[0], Orders::WithStops), 0.0);
}

/// The declarations of the example, without what it does with them.
fn declared() -> String {
    let example = include_str!("../../examples/fold_stops.mod");
    example.split("let folding = ").next().expect("there is something before it").to_owned()
}

fn run(program: &str) -> Ran {
    let done = ran(&MapFiles::of(program), "main.mod", Mode::Run, &Options::default());
    assert!(done.outcome.diagnostics.is_empty(), "{:?}", done.outcome.diagnostics);
    done
}

fn printed(call: &str, what: &str) -> Vec<String> {
    run(&format!("{}let folding = {call}\nprint({what})", declared())).host.printed
}

/// The mean torque of a flap about its crease by its angle, in steps of one second; a square metre weighs 1 kg.
fn flap(corners: &[[f64; 2]; 4], rise: f64) -> f64 {
    let points = corners.map(|[along, away]| Vec3::new(along, away, 0.0) / 1000.0);
    let area = (points[2] - points[0]).cross(&(points[3] - points[1])).norm() / 2.0;
    let moment = moment_about(&points, area, Inertia::Lamina, &Vec3::zeros(), &Vec3::x());
    MEAN * (180.0 - rise).to_radians() * moment
}

/// Flaps that each lie under the next need a turn more than there are hinges, and spend what they weigh.
#[test]
fn tucked_flaps_need_one_stop() {
    let said = "folding.order, folding.stops[0].face, folding.stops[0].step, \
                folding.stops[0].angle / 1deg, len(folding.stops), folding.energy / 1e-9J, folding.optimal, \
                verify(folding).ok, folding.duration / 1s";
    let found = printed("fold(tucked, module: Card)", said);
    let [line] = &found[..] else { panic!("{found:?}") };
    let (order, rest) = line.split_once("]] ").expect("the order comes first");
    assert_eq!(order, "[[3], [1], [2], [3");
    let rest: Vec<&str> = rest.split(' ').collect();
    let number = |place: usize| rest[place].parse::<f64>().expect("a number");
    assert_eq!((rest[0], rest[1], rest[3], rest[5], rest[6]), ("3", "0", "1", "true", "true"));
    // Seven parts of eight, towards the front.
    assert!(near(number(2).abs(), 162.0 * 7.0 / 8.0, 1e-5), "{line}");
    let flaps = [
        flap(&[[190.0, 0.0], [270.0, 0.0], [245.0, 35.0], [80.0, 225.0]], 10.0),
        flap(&[[180.0, 0.0], [260.0, 0.0], [105.0, 120.0], [-60.0, 240.0]], 27.0),
        flap(&[[40.0, 0.0], [175.0, 0.0], [160.0, 10.0], [25.0, 65.0]], 18.0),
    ];
    let step = number(7) / 4.0;
    let truth = flaps.iter().sum::<f64>() / (step * step) / 1e-9;
    assert!(near(number(4), truth, 1e-4), "{} is not {truth}", rest[4]);
}

/// The root on the ground, its back down, carries all flaps; a flap as the root is carried by its own.
#[test]
fn tucked_flaps_fold_under_gravity_and_from_any_root() {
    let said = "len(folding.order), len(folding.stops), verify(folding).ok, \
                folding.bound <= folding.energy, folding.lifting_bound <= folding.lifting";
    for arguments in ["gravity: on", "root: 1", "root: 2", "root: 3, count: all"] {
        let found = printed(&format!("fold(tucked, module: Card, {arguments})"), said);
        assert_eq!(found, ["4 1 true true true"], "{arguments}");
    }
    let said = "folding.bound / 1N*m, folding.gap, folding.optimal, folding.why";
    let found = printed("fold(tucked, module: Card, minimise: peak_torque)", said);
    assert_eq!(found, ["0 1 false not proved: nothing is known of the least torque"]);
}

/// The frames of a FOLD file show the flap where it has stopped, and the shape in the end.
#[test]
fn frames_show_the_flap_where_it_stops() {
    let program = format!("{}save(fold(tucked, module: Card), \"tucked.fold\")", declared());
    let done = run(&program);
    let file: Value = serde_json::from_slice(&done.host.written["tucked.fold"]).expect("it is JSON");
    let highest = |frame: &Value| {
        let corners = frame["vertices_coords"].as_array().expect("a list").iter();
        let height = |corner: &Value| corner[2].as_f64().map_or(0.0, f64::abs);
        corners.map(height).fold(0.0, f64::max)
    };
    let frames = file["file_frames"].as_array().expect("a list");
    assert_eq!(frames.len(), 4);
    // The corners that are the farthest from their creases, in millimetres.
    let stopped = (65.0, 18.0 + 162.0 / 8.0);
    let heights = [stopped, stopped, (240.0, 27.0), (240.0, 27.0)];
    for (frame, (away, rise)) in frames.iter().zip(heights) {
        let truth = away * libm::sin(f64::to_radians(rise));
        assert!(near(highest(frame), truth, 1e-6), "{} is not {truth}", highest(frame));
    }
}

/// A layout of one's own is folded in the order that is asked for, or not at all.
#[test]
fn given_hinges_do_not_stop() {
    let program =
        format!("{}print(fold(tucked, module: Card, hinges: [[0, 1], [0, 2], [0, 3]]).order)", declared());
    let done = ran(&MapFiles::of(&program), "main.mod", Mode::Run, &Options::default());
    let [refused] = &done.outcome.diagnostics[..] else { panic!("{:?}", done.outcome.diagnostics) };
    assert!(refused.message.starts_with("this layout does not fold so"), "{}", refused.message);
}
