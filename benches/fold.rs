//! Folding: what proving, enumerating and ordering take, shape by shape.
//!
//! `cargo bench --bench fold`

use modl::geometry::Vec3;
use modl::planners::fold::Observer;
use modl::planners::fold::branch_and_bound::{self, Proof, optimum};
use modl::planners::fold::enumerate::{self, enumerate_energies};
use modl::planners::fold::inertia::Inertia;
use modl::planners::fold::simulation::Count;
use modl::planners::fold::sweep_collision::first_collision;
use modl::planners::fold::{Conventions, Minimise, Objective};
use modl::planners::fold::{Target, Weights, energy_order, local_search, steps, work_order};
use std::time::Instant;

const MASS: f64 = 0.026;
const REPEATS: u32 = 20;

fn target(shape: &serde_json::Value) -> Target {
    let rows = |key: &str| shape[key].as_array().expect("a list").clone();
    let point = |row: &serde_json::Value| Vec3::from_fn(|k, _| row[k].as_f64().expect("a number") * 0.08);
    let corners =
        |row: &serde_json::Value| (0..3).map(|k| row[k].as_u64().expect("a place") as usize).collect();
    let faces: Vec<Vec<usize>> = rows("faces_ccw").iter().map(corners).collect();
    Target::new(rows("vertices_unit_edge").iter().map(point).collect(), &faces).expect("it folds")
}

fn main() {
    let truth: serde_json::Value =
        serde_json::from_str(include_str!("../tests/truth/fold.json")).expect("the truth is JSON");
    println!("| shape | faces | all roots, proved | gap | without overlap, best root | order (Eq. 17) |");
    println!("|---|---|---|---|---|---|");
    for (name, shape) in truth["shapes"].as_object().expect("an object") {
        let target = target(shape);
        let weights = Weights::uniform(&target, MASS);
        let repeats = if target.faces.len() > 30 { 1 } else { REPEATS };
        let time = |work: &mut dyn FnMut()| {
            let start = Instant::now();
            (0..repeats).for_each(|_| work());
            start.elapsed() / repeats
        };
        let found =
            optimum(&target, &weights, &branch_and_bound::Settings::default()).expect("it has layouts");
        let exact = time(&mut || {
            optimum(&target, &weights, &branch_and_bound::Settings::default()).expect("it has layouts");
        });
        let settings = branch_and_bound::Settings {
            flat: true,
            root: Some(found.layout.root),
            ..branch_and_bound::Settings::default()
        };
        let flat = time(&mut || {
            optimum(&target, &weights, &settings).expect("it has a flat one");
        });
        let loads = vec![MASS * 9.8; target.faces.len()];
        let ordered = time(&mut || {
            work_order::least_work(&target, &found.layout, &loads);
        });
        let gap = (found.energy - found.bound) / found.energy;
        let proved = if found.proof == Proof::Optimal { "" } else { " (open)" };
        println!(
            "| {name} | {} | {exact:?}, {} nodes{proved} | {gap:.1e} | {flat:?} | {ordered:?} |",
            target.faces.len(),
            found.nodes
        );
    }
    let target = target(&truth["shapes"]["icosahedron"]);
    let start = Instant::now();
    let all = enumerate::Settings { root: None, spectrum: false, budget: u64::MAX };
    let found = enumerate_energies(&target, &Weights::uniform(&target, MASS), &all, &Observer::none())
        .expect("few faces");
    println!("\nicosahedron: {} layouts with 20 roots enumerated in {:?}", found.layouts, start.elapsed());
    dynamics(&truth);
}

/// What one layout takes: measured in closed form, simulated, looked at for collisions, ordered.
fn dynamics(truth: &serde_json::Value) {
    println!(
        "\n| shape | closed form | simulated | collision check | order (MI) | peak torque, all layouts and roots |"
    );
    println!("|---|---|---|---|---|---|");
    for name in ["tetrahedron", "octahedron", "quadruped_turtle", "icosahedron"] {
        let target = target(&truth["shapes"][name]);
        let masses = vec![MASS; target.faces.len()];
        let layout =
            optimum(&target, &Weights::uniform(&target, MASS), &branch_and_bound::Settings::default())
                .expect("it has layouts")
                .layout;
        let steps = steps::leaves_first(&layout);
        let plain = Conventions { inertia: Inertia::Lamina, count: Count::Moving, gravity: 0.0, step: 1.0 };
        let under = Conventions { count: Count::All, gravity: 9.8, ..plain };
        let [closed, simulated] =
            [plain, under].map(|c| Objective::new(&target, masses.clone(), c, Minimise::PeakTorque));
        let time = |work: &mut dyn FnMut()| {
            let start = Instant::now();
            (0..REPEATS).for_each(|_| work());
            start.elapsed() / REPEATS
        };
        let by_form = time(&mut || {
            std::hint::black_box(closed.leaves_first(&layout));
        });
        let by_steps = time(&mut || {
            std::hint::black_box(simulated.leaves_first(&layout));
        });
        let look = time(&mut || {
            std::hint::black_box(first_collision(&target, &layout, &steps, 0.02));
        });
        let order = time(&mut || {
            energy_order::least_energy(&target, &layout, &masses, Inertia::Lamina);
        });
        let all = local_search::Settings {
            roots: (0..target.faces.len()).collect(),
            flat: true,
            budget: closed.measures_max(),
            keep: 64,
            prefilter: closed.prefilter(100_000_000),
        };
        let start = Instant::now();
        let found = local_search::search(
            &target,
            &closed.weights,
            &all,
            &mut |layout| closed.value(layout),
            &Observer::none(),
        );
        let survey = start.elapsed();
        let ending = if found.complete { "proved" } else { "open" };
        println!("| {name} | {by_form:?} | {by_steps:?} | {look:?} | {order:?} | {survey:?}, {ending} |");
    }
}
