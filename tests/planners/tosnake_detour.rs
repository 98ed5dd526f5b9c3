//! Unwinding: a way around where the straight one is not free.

use modl::optimize::random::SplitMix64;
use modl::planners::NoProgress;
use modl::planners::tosnake::TOLERANCES;
use modl::planners::tosnake::broad_phase;
use modl::planners::tosnake::inverse_kinematics::Loop;
use modl::planners::tosnake::random_configuration::random_configuration;
use modl::planners::tosnake::robot::Dock;
use modl::planners::tosnake::rrt_connect::RrtConnect;
use modl::planners::tosnake::state::{Joints, State};
use modl::planners::tosnake::tree::JointRef;
use modl::planners::tosnake::{Settings, unwind};
use std::f64::consts::FRAC_PI_2;

/// The least distance of balls that need not touch, on the straight way between two postures.
fn least(state: &State, from: &Joints, to: &Joints) -> f64 {
    const INSTANTS: usize = 200;
    let mut poses = Vec::new();
    let at = |instant: usize| {
        let t = instant as f64 / INSTANTS as f64;
        let mut joints = from.clone();
        for (module, q) in joints.iter_mut().enumerate() {
            (0..3).for_each(|k| q[k] += t * (to[module][k] - q[k]));
        }
        state.tree.poses(&joints, &mut poses);
        broad_phase::least_distance(&state.tree, &state.docked, &poses, 1.1)
    };
    (0..=INSTANTS).map(at).fold(f64::INFINITY, f64::min)
}

/// Two postures of a tentacle of a tangle, both without overlap, with something between them.
fn hindered(seed: u64) -> Option<(State, Vec<JointRef>, Joints)> {
    let state = State::new(random_configuration(10, 60, seed));
    let mut rng = SplitMix64(seed);
    let [a, b] = [0, 1].map(|_| Dock::red(rng.below(state.tree.shoes())));
    let joints: Vec<JointRef> = Loop::new(&state.tree, a, b).joints.iter().map(|(joint, _)| *joint).collect();
    let mut to = state.robot.joints.clone();
    joints.iter().for_each(|j| to[j.module][j.joint] = FRAC_PI_2 * rng.next_signed());
    let mut poses = Vec::new();
    state.tree.poses(&to, &mut poses);
    let stands =
        broad_phase::least_distance(&state.tree, &state.docked, &poses, 1.1) > TOLERANCES.min_distance;
    let blocked = least(&state, &state.robot.joints, &to) < TOLERANCES.min_distance;
    (stands && blocked && joints.len() >= 9).then_some((state, joints, to))
}

#[test]
fn a_detour_goes_around_what_is_in_the_way() {
    let mut found = 0;
    let cases: Vec<(State, Vec<JointRef>, Joints)> = (0..300).filter_map(hindered).take(8).collect();
    assert_eq!(cases.len(), 8, "the tangles show nothing");
    for (state, joints, to) in &cases {
        let scene = state.scene();
        let from = &state.robot.joints;
        let detour = RrtConnect { scene: &scene, joints };
        let way = |seed: u64| detour.path(from, to, &mut SplitMix64(seed), &mut 0);
        let Some(stops) = way(1) else { continue };
        found += 1;
        assert!(stops.len() >= 2 && stops.last() == Some(to));
        assert_eq!(Some(&stops), way(1).as_ref(), "the same rng, the same way");
        let mut before = from;
        for stop in &stops {
            let distance = least(state, before, stop);
            assert!(distance >= TOLERANCES.min_distance, "balls come as near as {distance}");
            for (module, (a, b)) in before.iter().zip(stop).enumerate() {
                let turns = |k: usize| joints.iter().any(|j| (j.module, j.joint) == (module, k));
                assert!((0..3).all(|k| a[k] == b[k] || turns(k)), "only these joints turn");
            }
            before = stop;
        }
    }
    assert!(found >= 4, "{found} of 8 ways were found");
}

/// Without detours, two chains are left here that nothing brings together until the robot is shaken.
#[test]
fn a_detour_spares_shaking() {
    for (modules, seed) in [(34, 66), (48, 96)] {
        let robot = random_configuration(modules, 1_000, seed);
        let found = |detour_pairs_max: usize| {
            unwind(&robot, None, &Settings { detour_pairs_max, ..Settings::default() }, &mut NoProgress)
                .expect("it unwinds")
        };
        let (without, with) = (found(0), found(Settings::default().detour_pairs_max));
        assert!(without.status.perturbations > 0 && with.status.perturbations == 0, "{:?}", with.status);
        assert!(with.status.tried < without.status.tried);
    }
}
