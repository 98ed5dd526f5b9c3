//! Folding: what proving, enumerating and ordering take, shape by shape.
//!
//! `cargo bench --bench fold`

use modl::geometry::Vec3;
use modl::planners::fold::enumerate::{self, census};
use modl::planners::fold::exact::{self, Proof, optimum};
use modl::planners::fold::{Target, Weights, order};
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
        let found = optimum(&target, &weights, &exact::Settings::default()).expect("it has layouts");
        let exact = time(&mut || {
            optimum(&target, &weights, &exact::Settings::default()).expect("it has layouts");
        });
        let settings =
            exact::Settings { flat: true, root: Some(found.layout.root), ..exact::Settings::default() };
        let flat = time(&mut || {
            optimum(&target, &weights, &settings).expect("it has a flat one");
        });
        let loads = vec![MASS * 9.8; target.faces.len()];
        let ordered = time(&mut || {
            order::least_lifting(&target, &found.layout, &loads);
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
    let found = census(&target, &Weights::uniform(&target, MASS), &all).expect("few faces");
    println!("\nicosahedron: {} layouts with 20 roots enumerated in {:?}", found.layouts, start.elapsed());
}
