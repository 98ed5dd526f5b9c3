//! The simulation of folding: against the closed form, against mass points whose motion is
//! differentiated, and against another program's numbers under gravity.

use crate::planners::fold::{MASS, SIDE, TRUTH, near, number, shaken, target, triangle};
use modl::geometry::Vec3;
use modl::geometry::pose::turned;
use modl::planners::fold::dynamics::{Dynamics, Hinging};
use modl::planners::fold::inertia::{Body, Inertia, moment_about};
use modl::planners::fold::kinematics::poses_at;
use modl::planners::fold::simulation::{Circumstances, Count, Torques, simulate};
use modl::planners::fold::{Layout, Target, Weights, energy_order, enumerate, steps};
use proptest::prelude::*;

/// What the other program pulled with, m/s².
const GRAVITY: f64 = 9.8;

fn bodies(target: &Target, inertia: Inertia) -> Vec<Body> {
    Body::of_target(target, &vec![MASS; target.faces.len()], inertia)
}

/// A layout by the order in which its hinges are taken.
fn grown(target: &Target, priorities: &[u32], root: usize) -> Layout {
    let mut hinges: Vec<usize> = (0..target.hinges.len()).collect();
    hinges.sort_by_key(|h| priorities[h % priorities.len()]);
    let mut group: Vec<usize> = (0..target.faces.len()).collect();
    let mut kept = Vec::new();
    for hinge in hinges {
        let [a, b] = target.hinges[hinge].faces.map(|face| group[face]);
        if a != b {
            group.iter_mut().filter(|g| **g == a).for_each(|g| *g = b);
            kept.push(hinge);
        }
    }
    Layout::of_hinges(target, &kept, root).expect("no cycle was closed")
}

/// Every panel as three points in the middles of its sides: as heavy, and as hard to turn.
fn points(target: &Target, face: usize) -> [Vec3; 3] {
    let [a, b, c] = triangle(target, face);
    [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0]
}

/// The torque of each hinge, from the accelerations that second differences of the points' places give
/// (d'Alembert): the points' forces about the hinge, over all that it carries.
fn torques_of_points(
    target: &Target,
    layout: &Layout,
    gravity: Vec3,
    motion: &[Hinging],
    h: f64,
) -> Vec<f64> {
    let places = |t: f64| {
        let poses = poses_at(target, layout, |face| {
            let m = motion[face];
            m.angle + m.speed * t + m.acceleration * t * t / 2.0
        });
        let face_points =
            |face: usize| points(target, face).map(|p| poses[face].transform_point(&p.into()).coords);
        ((0..poses.len()).map(face_points).collect::<Vec<_>>(), poses)
    };
    let ((before, _), (now, poses), (after, _)) = (places(-h), places(0.0), places(h));
    let mut torques = vec![0.0; target.faces.len()];
    for &face in &layout.order[1..] {
        let hinge = &target.hinges[layout.hinge[face].expect("no root")];
        let parent = poses[layout.parent[face]];
        let origin = parent.transform_point(&hinge.point.into()).coords;
        let axis = parent.rotation * hinge.axis_from(layout.parent[face]);
        for below in (0..now.len()).filter(|below| layout.is_above(face, *below)) {
            for k in 0..3 {
                let acceleration = (before[below][k] - now[below][k] * 2.0 + after[below][k]) / (h * h);
                let force = (acceleration - gravity) * (MASS / 3.0);
                torques[face] += axis.dot(&(now[below][k] - origin).cross(&force));
            }
        }
    }
    torques
}

#[test]
fn a_prism_and_a_point_are_what_they_are_called() {
    let target = target("octahedron");
    let (corners, hinge) = (target.corners(0), &target.hinges[0]);
    let height = SIDE * libm::sqrt(0.75);
    let of = |inertia| moment_about(corners, MASS, inertia, &hinge.point, &hinge.axis);
    assert!(near(of(Inertia::Lamina), MASS * height * height / 6.0, 1e-9));
    assert!(near(of(Inertia::Point), MASS * height * height / 9.0, 1e-9));
    let prism = MASS * height * height / 6.0 + MASS * 0.006 * 0.006 / 12.0;
    assert!(near(of(Inertia::Prism(0.006)), prism, 1e-9));
    // About its centre of mass: m l²/24 in the plane, m l²/12 across it.
    let body = Body::of_panel(corners, MASS, Inertia::Lamina);
    let normal = target.normal(0);
    assert!(near(normal.dot(&(body.inertia * normal)), MASS * SIDE * SIDE / 12.0, 1e-9));
    assert!(near(hinge.axis.dot(&(body.inertia * hinge.axis)), MASS * SIDE * SIDE / 24.0, 1e-9));
}

/// Gravity, and every joint counted: all layouts, the root on the ground, point masses, 0.22 s. The
/// other program sampled torques in time, so its means are good to a few parts in ten thousand.
#[test]
fn torques_under_gravity_are_those_of_another_program() {
    for name in ["tetrahedron", "octahedron"] {
        let target = target(name);
        let bodies = bodies(&target, Inertia::Point);
        let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
        enumerate::each(&target, u64::MAX, |hinges| {
            let layout = Layout::of_hinges(&target, hinges, 0).expect("a tree");
            let steps = steps::leaves_first(&layout);
            let under = Circumstances { step: 0.22, gravity: GRAVITY };
            let energy = simulate(&target, &layout, &bodies, &steps, &under).energy(Count::All, &steps);
            (least, greatest) = (least.min(energy), greatest.max(energy));
        })
        .expect("few faces");
        let truth = &TRUTH["shapes"][name]["MI_full"]["variant_gravity_all_dt022"];
        assert!(near(least, number(&truth["min"]), 3e-4), "{name}: {least}");
        assert!(near(greatest, number(&truth["max"]), 3e-4), "{name}: {greatest}");
    }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(48))]

    /// Alg. 1 against the closed form: any mesh, tree and root, every joint for itself.
    #[test]
    fn the_closed_form_is_what_is_simulated(
        target in shaken(), priorities in proptest::collection::vec(0..1000u32, 40), root in 0..18usize, kind in 0..3usize,
    ) {
        let layout = grown(&target, &priorities, root % target.faces.len());
        let inertia = [Inertia::Lamina, Inertia::Point, Inertia::Prism(0.006)][kind];
        let masses: Vec<f64> = (0..target.faces.len()).map(|f| if priorities[f] % 3 == 0 { 0.008 } else { MASS }).collect();
        let bodies = Body::of_target(&target, &masses, inertia);
        let under = Circumstances { step: 0.7, gravity: 0.0 };
        let simulated = |order: &[Vec<usize>]| -> Torques { simulate(&target, &layout, &bodies, order, &under) };
        let leaves = steps::leaves_first(&layout);
        let energy = simulated(&leaves).energy(Count::Moving, &leaves);
        let closed = layout.energy(&Weights::new(&target, &masses, inertia)) / (0.7 * 0.7);
        prop_assert!(near(energy, closed, 1e-9), "{energy} {closed}");
        // Other orders, by what turns about what at the time.
        let order = grown_order(&layout, &priorities);
        let laid = steps::of_order(&layout, &order);
        let energy = simulated(&laid).energy(Count::Moving, &laid);
        let by_steps = energy_order::energy(&target, &layout, &masses, inertia, &order) / (0.7 * 0.7);
        prop_assert!(near(energy, by_steps, 1e-9), "{energy} {by_steps}");
    }

    /// Newton-Euler against mass points, any motion of all hinges at once, under gravity.
    #[test]
    fn torques_are_those_of_mass_points(
        target in shaken(), priorities in proptest::collection::vec(0..1000u32, 40), root in 0..18usize,
        rates in proptest::collection::vec(-1.0..1.0_f64, 54), pull in [-10.0..10.0_f64, -10.0..10.0, -10.0..10.0],
    ) {
        let layout = grown(&target, &priorities, root % target.faces.len());
        let gravity = Vec3::from(pull);
        let motion: Vec<Hinging> = (0..target.faces.len())
            .map(|f| Hinging { angle: 2.0 * rates[3 * f], speed: 3.0 * rates[3 * f + 1], acceleration: 5.0 * rates[3 * f + 2] })
            .collect();
        let bodies = bodies(&target, Inertia::Lamina);
        let mut torques = vec![0.0; target.faces.len()];
        Dynamics::new(&target, &layout, &bodies, gravity).torques(|face| motion[face], &mut torques);
        // Two step widths: what is left of the error goes with the fourth power.
        let wide = torques_of_points(&target, &layout, gravity, &motion, 2e-3);
        let narrow = torques_of_points(&target, &layout, gravity, &motion, 1e-3);
        let scale = torques.iter().fold(1e-4_f64, |m, t| m.max(t.abs()));
        for face in 0..torques.len() {
            let limit = narrow[face] + (narrow[face] - wide[face]) / 3.0;
            prop_assert!((torques[face] - limit).abs() < 1e-6 * scale, "{face}: {} {limit}", torques[face]);
        }
    }

    /// Where a target lies, and whether it is mirrored, changes no torque; under gravity, too, for it
    /// pulls where the root's outside is.
    #[test]
    fn torques_do_not_depend_on_place_or_hand(
        target in shaken(), priorities in proptest::collection::vec(0..1000u32, 40), root in 0..18usize,
        axis in [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0], angle in 0.0..6.0_f64, grow in 0.5..2.0_f64,
    ) {
        let root = root % target.faces.len();
        let layout = grown(&target, &priorities, root);
        let spent = |target: &Target, layout: &Layout, gravity: f64, step: f64| {
            let steps = steps::leaves_first(layout);
            let under = Circumstances { step, gravity };
            let torques = simulate(target, layout, &bodies(target, Inertia::Lamina), &steps, &under);
            [torques.energy(Count::Moving, &steps), torques.energy(Count::All, &steps), torques.peak(Count::All, &steps)]
        };
        let faces: Vec<Vec<usize>> = target.faces.iter().map(|f| f.to_vec()).collect();
        let pairs: Vec<[usize; 2]> = layout.hinges().into_iter().map(|h| target.hinges[h].faces).collect();
        let plain = spent(&target, &layout, GRAVITY, 0.3);
        // Grown by a factor, under as much more gravity, everything goes with its square.
        let turn = turned(Vec3::from(axis), angle);
        let moved = target.vertices.iter().map(|v| turn * v * grow + Vec3::new(1.0, 2.0, 3.0)).collect();
        let moved = Target::new(moved, &faces).expect("it still folds");
        let same = Layout::of_pairs(&moved, &pairs, root).expect("the same tree");
        for (a, b) in spent(&moved, &same, GRAVITY * grow, 0.3).into_iter().zip(plain) {
            prop_assert!(near(a, b * grow * grow, 1e-8), "{a} {b}");
        }
        let mirrored = target.vertices.iter().map(|v| Vec3::new(-v.x, v.y, v.z)).collect();
        let turned_round: Vec<Vec<usize>> = faces.iter().map(|f| f.iter().rev().copied().collect()).collect();
        let mirrored = Target::new(mirrored, &turned_round).expect("it still folds");
        let same = Layout::of_pairs(&mirrored, &pairs, root).expect("the same tree");
        for (a, b) in spent(&mirrored, &same, GRAVITY, 0.3).into_iter().zip(plain) {
            prop_assert!(near(a, b, 1e-8), "{a} {b}");
        }
        // Without gravity, with the inverse square of the step.
        let [slow, fast] = [0.5, 0.25].map(|step| spent(&target, &layout, 0.0, step));
        for (a, b) in fast.into_iter().zip(slow) {
            prop_assert!(near(a, 4.0 * b, 1e-9));
        }
    }
}

fn grown_order(layout: &Layout, priorities: &[u32]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..layout.parent.len()).filter(|face| *face != layout.root).collect();
    order.sort_by_key(|face| priorities[face + 3]);
    order
}
