//! Planners whose budget ends: the best so far, with the gap that the proof leaves open, and the reason in words.

use crate::support::desk::run_clean;

/// Budgets that end a search before its first step, in its beginning, and later.
const BUDGETS: [u64; 3] = [0, 100, 100_000];

/// Calls that have an answer whatever the budget, which stands for N, with what is minimised. Few of the cheap
/// layouts of the star and of the torus lie flat.
const CALLS: [(&str, &str); 8] = [
    ("fold(stella_octangula(edge: 80mm), module: Mori, budget: N)", "energy"),
    ("fold(stella_octangula(edge: 80mm), module: Mori, minimise: peak_torque, budget: N)", "peak_torque"),
    ("fold(stella_octangula(edge: 80mm), module: Mori, sequence: least_energy, budget: N)", "energy"),
    (
        "fold(torus(radius: 200mm, tube: 80mm, around: 4, across: 4), module: Panel(thickness: 2mm), budget: N)",
        "energy",
    ),
    ("fold(icosahedron(edge: 80mm), module: Mori, count: all, budget: N)", "energy"),
    ("fold(icosahedron(edge: 80mm), module: Mori, minimise: steps, budget: N)", "energy"),
    ("refold(octahedron(edge: 80mm), boat(edge: 80mm), module: Mori, budget: N)", "changes"),
    (
        "refold(icosahedron(edge: 80mm), tube(sides: 10, rings: 1, edge: 80mm), module: Mori, budget: N)",
        "changes",
    ),
];

/// Plans a call, and returns what was minimised and its bound, in the units of the language. Holds the gap to the two, and
/// the words to the gap.
fn planned(call: &str, minimised: &str) -> [f64; 2] {
    let unit = match minimised {
        "energy" => " / 1J",
        "peak_torque" => " / 1N*m",
        _ => "",
    };
    let text = format!(
        "use std.mori.{{Mori, Panel}}
use std.shapes.{{boat, icosahedron, octahedron, stella_octangula, torus, tube}}
let p = {call}
print(p.{minimised}{unit}, p.bound{unit}, p.gap, verify(p).ok)
print(p.why)
"
    );
    let printed = run_clean(&text).printed;
    let [figures, why] = &printed[..] else { panic!("{call}: {printed:?}") };
    let cells: Vec<&str> = figures.split(' ').collect();
    assert_eq!(cells[3], "true", "{call}");
    let [value, bound, gap] = [0, 1, 2].map(|k| cells[k].parse::<f64>().expect("a number"));
    assert!(bound <= value * (1.0 + 1e-5), "{call}: {figures}");
    let open = if value > 0.0 { 1.0 - bound / value } else { 0.0 };
    assert!((gap - open).abs() < 2e-5, "{call}: {figures}");
    assert_eq!(why.starts_with("proved: "), gap == 0.0, "{call}: {why}");
    assert!(why.starts_with("proved: ") || why.starts_with("not proved: "), "{call}: {why}");
    [value, bound]
}

#[test]
fn the_best_so_far_is_the_answer_where_a_budget_ends() {
    for (call, minimised) in CALLS {
        let found = BUDGETS.map(|budget| planned(&call.replace('N', &budget.to_string()), minimised));
        let least = found.iter().map(|[value, _]| *value).fold(f64::INFINITY, f64::min);
        // A bound of one budget holds for what is found with any other.
        assert!(found.iter().all(|[_, bound]| *bound <= least * (1.0 + 1e-5)), "{call}: {found:?}");
    }
}

#[test]
fn lattices_state_their_gap() {
    let text = "use std.crystal.ExpandingCube
lattice Bar of ExpandingCube = row(16)
lattice Pole of ExpandingCube = column(16)
let still = squeeze(Bar, Bar)
let turned = squeeze(Bar, Pole)
print(still.duration / 1s, still.lower_bound / 1s, still.gap, still.why != \"\")
print(turned.duration / 1s, turned.lower_bound / 1s, turned.gap, turned.why != \"\")
";
    for line in &run_clean(text).printed {
        let cells: Vec<&str> = line.split(' ').collect();
        let [duration, bound, gap] = [0, 1, 2].map(|k| cells[k].parse::<f64>().expect("a number"));
        let open = if duration > 0.0 { 1.0 - bound / duration } else { 0.0 };
        assert!((gap - open).abs() < 2e-5 && (0.0..1.0).contains(&gap), "{line}");
        assert_eq!(cells[3], "true", "{line}");
    }
}
