//! Proofs on random meshes: closed surfaces of 4 to 80 triangles, shaken, re-entrant, with boundary.

use crate::planners::fold::{MASS, TRUTH, mesh, near};
use crate::support::properties::whole;
use modl::geometry::Vec3;
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::pattern::Pattern;
use modl::planners::fold::{Layout, Proof, Target, Weights, branch_and_bound, edge_exchange, spanning_trees};
use modl::planners::fold::{Observer, TOLERANCES};
use num_traits::ToPrimitive;
use proptest::prelude::*;

/// Layouts up to which every one is looked at: a million where the whole is asked for, which is for an
/// optimised build.
fn enumerated() -> u64 {
    if whole() { 1_000_000 } else { 60_000 }
}

/// Work of one search.
const BUDGET: u64 = 300_000;

/// What is done to a shape: a face becomes three about a point over or under it, or an edge of two
/// faces joins their other corners.
#[derive(Clone, Copy, Debug)]
enum Change {
    Raise(usize, f64),
    Flip(usize),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        (0..1000usize, -0.03..0.03_f64).prop_map(|(face, height)| Change::Raise(face, height)),
        (0..1000usize).prop_map(Change::Flip),
    ]
}

pub fn raised(vertices: &mut Vec<Vec3>, faces: &mut Vec<Vec<usize>>, face: usize, height: f64) {
    let face = face % faces.len();
    let [a, b, c] = faces[face][..] else { return };
    let normal = (vertices[b] - vertices[a]).cross(&(vertices[c] - vertices[a])).normalize();
    let top = vertices.len();
    vertices.push((vertices[a] + vertices[b] + vertices[c]) / 3.0 + normal * height);
    faces[face] = vec![a, b, top];
    faces.extend([vec![b, c, top], vec![c, a, top]]);
}

fn flipped(faces: &mut [Vec<usize>], number: usize) {
    let (face, side) = (number % faces.len(), number % 3);
    let (a, b, c) = (faces[face][side], faces[face][(side + 1) % 3], faces[face][(side + 2) % 3]);
    let across = faces.iter().position(|f| (0..3).any(|k| f[k] == b && f[(k + 1) % 3] == a));
    let Some(other) = across else { return };
    let Some(&d) = faces[other].iter().find(|v| **v != a && **v != b) else { return };
    let joined = faces.iter().any(|f| f.contains(&c) && f.contains(&d));
    if !joined {
        faces[face] = vec![c, a, d];
        faces[other] = vec![d, b, c];
    }
}

fn meshes() -> impl Strategy<Value = Target> {
    let names =
        vec!["tetrahedron", "octahedron", "snub_disphenoid", "icosahedron", "stella_octangula", "tube_6x3"];
    let shakes = proptest::collection::vec(-0.01..0.01_f64, 240);
    let taken = proptest::collection::vec(0..1000usize, 0..3);
    (proptest::sample::select(names), proptest::collection::vec(change(), 0..14), shakes, taken)
        .prop_filter_map("it folds", |(name, changes, shakes, taken)| {
            let (mut vertices, mut faces) = mesh(&TRUTH["shapes"][name]);
            for change in changes {
                match change {
                    Change::Raise(face, height) => raised(&mut vertices, &mut faces, face, height),
                    Change::Flip(number) => flipped(&mut faces, number),
                }
            }
            for (vertex, shake) in vertices.iter_mut().zip(shakes.chunks(3)) {
                *vertex += Vec3::new(shake[0], shake[1], shake[2]);
            }
            for face in taken.into_iter().filter(|_| faces.len() > 8).collect::<Vec<_>>() {
                let at = face % faces.len();
                faces.remove(at);
            }
            (faces.len() <= 80).then(|| Target::new(vertices, &faces).ok()).flatten()
        })
}

/// A layout by the order in which hinges are taken.
fn random_layout(target: &Target, seed: usize, root: usize) -> Layout {
    let mut group: Vec<usize> = (0..target.faces.len()).collect();
    let mut kept = Vec::new();
    let count = target.hinges.len();
    // A step that has no divisor in common with the number of hinges visits each.
    let step = (seed..)
        .find(|s| *s > 0 && gcd(*s, count) == 1)
        .expect("one above the number is none of its divisors");
    for hinge in (0..count).map(|i| (i * step + seed) % count) {
        let [a, b] = target.hinges[hinge].faces.map(|face| group[face]);
        if a != b {
            group.iter_mut().filter(|g| **g == a).for_each(|g| *g = b);
            kept.push(hinge);
        }
    }
    Layout::of_hinges(target, &kept, root).expect("no cycle was closed")
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

proptest! {
    #![proptest_config(crate::support::properties::cases(32))]

    #[test]
    fn no_proof_is_wrong(target in meshes(), root in 0..80usize, seed in 0..1000usize) {
        let weights = Weights::uniform(&target, MASS);
        let root = root % target.faces.len();
        let settings = branch_and_bound::Settings { root: Some(root), budget: BUDGET, ..branch_and_bound::Settings::default() };
        let found = branch_and_bound::optimum(&target, &weights, &settings).expect("it has layouts");
        prop_assert!(near(found.layout.energy(&weights), found.energy, 1e-12));
        prop_assert!(found.bound <= found.energy);
        let gap = (found.energy - found.bound) / found.energy;
        prop_assert!(found.proof == Proof::Open || gap < 4.0 * TOLERANCES.perturbation, "{gap}");
        // Nothing that is found another way is below the bound.
        let mut least = f64::INFINITY;
        for i in 0..4 {
            let layout = random_layout(&target, seed + i, root);
            let improved = edge_exchange::improved(&target, &weights, layout.clone(), &mut 2_000);
            least = least.min(layout.energy(&weights)).min(improved.energy(&weights));
        }
        prop_assert!(found.bound <= least && (found.proof == Proof::Open || found.energy <= least * (1.0 + 2.0 * TOLERANCES.perturbation)));
        let layouts = spanning_trees::layouts(&target).to_u64();
        if layouts.is_some_and(|layouts| layouts <= enumerated()) {
            let all = enumerate::Settings { root: Some(root), spectrum: false, budget: u64::MAX };
            let all = enumerate_energies(&target, &weights, &all, &Observer::none()).expect("few faces");
            prop_assert_eq!(Some(all.layouts), layouts);
            prop_assert!(found.proof == Proof::Open || near(found.energy, all.least, 2.0 * TOLERANCES.perturbation));
            prop_assert!(found.bound <= all.least * (1.0 + TOLERANCES.perturbation));
        }
        // The best that lies flat costs no less, and lies flat.
        let flat = branch_and_bound::Settings { flat: true, ..settings };
        if let Ok(flat) = branch_and_bound::optimum(&target, &weights, &flat) {
            prop_assert!(Pattern::of(&target, &flat.layout).overlaps().is_empty());
            prop_assert!(flat.energy >= found.bound && (found.proof == Proof::Open || flat.energy >= found.energy * (1.0 - TOLERANCES.perturbation)));
        }
    }
}
