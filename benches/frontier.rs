//! The motions of lattices beside those of the methods before: one cell of a block that moves, and seeded
//! random shapes that become each other. For each set the median and the greatest time of the motion, in units of
//! time and by the lower bound, and the time that planning took, each plan judged. Then what the programs in
//! `benches/frontier` print, of folding and of chains.
//!
//! `cargo bench --bench frontier`; with a number behind `--`, so many pairs of each kind; with names of programs,
//! those only.

#[path = "../tests/support/lattices.rs"]
mod lattices;

use lattices::{block, judged_plan, moved, plan_of, random_shape, unit_cell};
use modl::plan::Body;
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, plan};
use std::time::Instant;

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

type Shape = Vec<[i64; 3]>;

fn main() {
    let named: Vec<String> =
        std::env::args().filter(|a| a.starts_with("fold") || a.starts_with("reconfigure")).collect();
    if named.is_empty() {
        lattice_table();
    }
    programs(&named);
}

/// Runs the programs of `benches/frontier` in the order of their names, or those that are named, and prints what they
/// print.
fn programs(named: &[String]) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/frontier");
    let entries = std::fs::read_dir(&folder).expect("the programs are there");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    for file in files {
        let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        if !named.is_empty() && !named.contains(&name) {
            continue;
        }
        let start = Instant::now();
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_modl")).arg("run").arg(&file).output();
        let output = run.expect("the tool runs");
        let spent = start.elapsed().as_secs_f64();
        println!(
            "\n{name}, {spent:.1} s, {}:\n{}",
            output.status,
            String::from_utf8_lossy(&output.stdout).trim_end()
        );
    }
}

fn lattice_table() {
    let pairs = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(12);
    println!(
        "| shapes | cells | method | T, median | greatest | by the bound, median | greatest | plan, s |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let square = block([6, 6, 1]);
    let corner = [[6, 5, 0], [5, 6, 0], [2, -1, 0]].map(|to| moved(square.clone(), [0, 0, 0], to));
    let cube = block([3, 3, 3]);
    let tip = [[3, 2, 2], [2, 2, 3], [1, -1, 2]].map(|to| moved(cube.clone(), [0, 0, 0], to));
    let from = |start: &Shape, goals: [Shape; 3]| goals.map(|goal| (start.clone(), goal)).to_vec();
    rows("corner of a block of 6 by 6", &from(&square, corner), Method::Merge);
    rows("corner of a cube of 3", &from(&cube, tip), Method::Melt);
    let mut seed = 1;
    for (dimensions, before) in [(2, Method::Merge), (3, Method::Melt)] {
        for branches in [false, true] {
            for count in [12, 24, 48, 64, 128, 400] {
                let mut shape = || random_shape(dimensions, branches, &mut seed, count);
                let sets: Vec<(Shape, Shape)> = (0..pairs).map(|_| (shape(), shape())).collect();
                let name = if branches { "with branches" } else { "random" };
                rows(&format!("{name}, in {dimensions} dimensions"), &sets, before);
            }
        }
    }
    for count in [64, 400] {
        let row: Shape = (0..count).map(|x| [x, 0, 0]).collect();
        let mut shape = || random_shape(3, false, &mut seed, count as usize);
        let sets: Vec<(Shape, Shape)> = (0..pairs.min(4)).map(|_| (row.clone(), shape())).collect();
        rows("a row, to random in space", &sets, Method::Melt);
    }
}

/// Prints a row of the table for the method before, and one for the default.
fn rows(name: &str, sets: &[(Shape, Shape)], before: Method) {
    for method in [before, Method::Auto] {
        let (mut times, mut ratios) = (vec![], vec![]);
        let start = Instant::now();
        let mut refused = 0;
        for (from, to) in sets {
            let problem = Problem {
                cell: unit_cell(),
                start: from.clone(),
                goal: to.clone(),
                fixed: vec![],
                obstacles: vec![],
            };
            let settings = Settings { method, ..Settings::default() };
            let Ok(solution) = plan(&problem, &settings, &mut NoProgress) else {
                refused += 1;
                continue;
            };
            let Body::Stages(stages) = solution.body else { unreachable!("it is a lattice") };
            times.push(stages.duration());
            if solution.report.lower_bound > 0.0 {
                ratios.push(stages.duration() / solution.report.lower_bound);
            }
            let verdict = judged_plan(&plan_of(stages));
            assert!(verdict.ok(), "{:?}", verdict.failures);
        }
        let spent = start.elapsed().as_secs_f64() / sets.len() as f64;
        let cells = sets.first().map_or(0, |(from, _)| from.len());
        let word =
            if refused > 0 { format!("{}, {refused} refused", method.name()) } else { method.name().into() };
        let [(time, longest), (ratio, worst)] = [times, ratios].map(middle);
        println!(
            "| {name} | {cells} | {word} | {time:.1} | {longest:.1} | {ratio:.1} | {worst:.1} | {spent:.2} |"
        );
    }
}

/// Returns the median and the greatest of some numbers; NaN if there are none.
fn middle(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let at = |index: usize| values.get(index).copied().unwrap_or(f64::NAN);
    (at(values.len() / 2), at(values.len().saturating_sub(1)))
}
