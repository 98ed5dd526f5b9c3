//! Unwinding: which balls are near each other, and which ways are free, beside all pairs of balls at many
//! instants.

use modl::geometry::{RigidTransform, Vec3};
use modl::optimize::random::SplitMix64;
use modl::planners::tosnake::TOLERANCES;
use modl::planners::tosnake::broad_phase;
use modl::planners::tosnake::neighbour_list::NeighbourList;
use modl::planners::tosnake::random_configuration::random_configuration;
use modl::planners::tosnake::state::State;
use nalgebra::Matrix3;
use std::f64::consts::FRAC_PI_2;

/// Pairs of places that are nearer than `reach`, all of them looked at.
fn all_pairs(poses: &[RigidTransform], reach: f64) -> Vec<(usize, usize)> {
    let near = |a: usize, b: usize| (poses[a].translation - poses[b].translation).norm() < reach;
    let pairs = (0..poses.len()).flat_map(|a| (a + 1..poses.len()).map(move |b| (a, b)));
    pairs.filter(|&(a, b)| near(a, b)).collect()
}

fn touch(state: &State, a: usize, b: usize) -> bool {
    broad_phase::always_touch(&state.tree, a, b, &state.docked)
}

#[test]
fn cubes_find_the_pairs_that_are_near() {
    let mut rng = SplitMix64(7);
    // Wide and narrow clouds, and balls that stand on the edges of cubes.
    for (spread, reach, on_lattice) in
        [(3.0, 1.0, false), (30.0, 2.5, false), (4.0, 1.0, true), (1.0, 9.0, true)]
    {
        let mut coordinate = || {
            let x = spread * rng.next_signed();
            if on_lattice { x.round() } else { x }
        };
        let poses: Vec<RigidTransform> = (0..200)
            .map(|_| RigidTransform {
                rotation: Matrix3::identity(),
                translation: Vec3::from_fn(|_, _| coordinate()),
            })
            .collect();
        let mut found = Vec::new();
        broad_phase::pairs(&poses, reach, &mut |a, b, squared| {
            assert_eq!(squared, (poses[b].translation - poses[a].translation).norm_squared());
            found.push((a, b));
        });
        found.sort_unstable();
        assert_eq!(found, all_pairs(&poses, reach), "spread {spread}, reach {reach}");
    }
}

#[test]
fn contacts_are_followed_from_step_to_step() {
    let state = State::new(random_configuration(30, 600, 3));
    let scene = state.scene();
    let count = state.tree.shoes();
    // Modules of a third of the robot turn; in a flow all do.
    for turning in [10, 30] {
        let parts = state.tree.parts(|module| module < turning);
        let (meeting, mut rng) = ((0, count - 1), SplitMix64(5));
        let mut contacts = NeighbourList::new(&scene, meeting, parts.clone());
        let (mut joints, mut poses) = (state.robot.joints.clone(), Vec::new());
        for step in 0..60 {
            // Few large steps, then many small ones, and another reach at every third.
            let size = if step % 20 < 3 { 0.3 } else { 0.002 };
            joints[..turning].iter_mut().flatten().for_each(|q| *q += size * rng.next_signed());
            state.tree.poses(&joints, &mut poses);
            let reach = if step % 3 == 0 { 1.6 } else { 1.2 };
            let mut found: Vec<(usize, usize)> =
                contacts.within(reach, &poses).iter().map(|contact| (contact.a, contact.b)).collect();
            found.sort_unstable();
            let wanted =
                |&(a, b): &(usize, usize)| parts[a] != parts[b] && (a, b) != meeting && !touch(&state, a, b);
            let all: Vec<(usize, usize)> = all_pairs(&poses, reach).into_iter().filter(wanted).collect();
            assert_eq!(found, all, "step {step}, {turning} modules turn");
        }
    }
}

#[test]
fn a_way_is_free_where_nothing_meets_at_any_instant() {
    const INSTANTS: usize = 1_000;
    let mut rng = SplitMix64(11);
    let (mut free, mut hindered, mut poses) = (0, 0, Vec::new());
    for seed in 0..60 {
        // Folded up, or with long arms.
        let (modules, actions) = [(12, 120), (40, 60)][seed as usize % 2];
        let state = State::new(random_configuration(modules, actions, seed));
        let (scene, from) = (state.scene(), &state.robot.joints);
        let mut to = from.clone();
        // One module turns, or several do.
        for _ in 0..1 + seed % 4 {
            let module = rng.below(to.len());
            for q in &mut to[module] {
                *q = (*q + 0.5 * rng.next_signed()).clamp(-FRAC_PI_2, FRAC_PI_2);
            }
        }
        let mut least = f64::INFINITY;
        for instant in 0..=INSTANTS {
            let t = instant as f64 / INSTANTS as f64;
            let mut joints = from.clone();
            for (q, (from, to)) in
                joints.iter_mut().flatten().zip(from.iter().flatten().zip(to.iter().flatten()))
            {
                *q = from + t * (to - from);
            }
            state.tree.poses(&joints, &mut poses);
            for (a, b) in all_pairs(&poses, 1.1).into_iter().filter(|&(a, b)| !touch(&state, a, b)) {
                least = least.min((poses[a].translation - poses[b].translation).norm());
            }
        }
        let says = scene.is_free(from, &to, &mut 0);
        if least < TOLERANCES.min_distance {
            assert!(!says, "tangle {seed}: balls come as near as {least}");
            hindered += 1;
        } else if least > TOLERANCES.min_distance + 5e-4 {
            assert!(says, "tangle {seed}: nothing is nearer than {least}");
            free += 1;
        }
    }
    assert!(free >= 5 && hindered >= 5, "{free} free, {hindered} not: the tangles show nothing");
}
