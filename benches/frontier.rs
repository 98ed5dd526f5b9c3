//! The figures that were not good enough: for each what it was when the aim was set, the aim, today's, and what the
//! paper has. Those of folding and of chains are printed by the programs in `benches/frontier`, one row a line.
//!
//! Before them the motions of lattices beside those of the methods before: one cell of a block that moves, and seeded random shapes that
//! become each other. For each set the median and the greatest time of the motion, in units of
//! time and by the lower bound, and the time that planning took, each plan judged.
//!
//! `cargo bench --bench frontier`; with a number behind `--`, so many pairs of each kind; with names of programs,
//! those only.

#[path = "../tests/support/lattices.rs"]
mod lattices;

use lattices::{block, judged_plan, moved, plan_of, random_shape, unit_cell};
use modl::plan::Body;
use modl::planners::NoProgress;
use modl::planners::squeeze::{Method, Problem, Settings, plan};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

type Shape = Vec<[i64; 3]>;

/// The head of the table of figures.
const HEAD: &str = "\n| figure | then | aim | today | the paper | planned in, s |\n|---|--:|--:|--:|--:|--:|";

fn main() {
    let programs = programs();
    let is_named =
        |path: &PathBuf| std::env::args().any(|argument| path.file_stem() == Some(argument.as_ref()));
    let named: Vec<PathBuf> = programs.iter().filter(|path| is_named(path)).cloned().collect();
    let of_lattices = if named.is_empty() { lattice_table() } else { vec![] };
    println!("{HEAD}");
    of_lattices.iter().for_each(|row| println!("{row}"));
    for file in if named.is_empty() { &programs } else { &named } {
        run(file);
    }
}

/// Returns the programs of `benches/frontier` in the order of their names.
fn programs() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/frontier");
    let entries = std::fs::read_dir(&folder).expect("the programs are there");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files
}

/// Runs a program and prints the rows that it prints, each with the time of the whole program; one that fails is a row
/// with the reason.
fn run(file: &Path) {
    let start = Instant::now();
    let output =
        Command::new(env!("CARGO_BIN_EXE_modl")).arg("run").arg(file).output().expect("the tool runs");
    let spent = start.elapsed().as_secs_f64();
    for row in String::from_utf8_lossy(&output.stdout).lines() {
        println!("{row} {spent:.1} |");
    }
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let reason = said.lines().find_map(|line| line.trim().strip_prefix("× ")).unwrap_or("no reason");
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        println!("| {name} | | | {reason} | | {spent:.1} |");
    }
}

/// Prints the table of lattices, and returns the rows of figures that had an aim.
fn lattice_table() -> Vec<String> {
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
    let mut figures = vec![
        rows("corner of a block of 6 by 6", &from(&square, corner), Method::Merge).row(
            "corner of a block of 6 by 6, T",
            ["54.5", "6.0"],
            |middle| middle.times,
        ),
        rows("corner of a cube of 3", &from(&cube, tip), Method::Melt).row(
            "corner of a cube of 3, T",
            ["158.8", "8.0"],
            |middle| middle.times,
        ),
    ];
    let mut seed = 1;
    for (dimensions, before) in [(2, Method::Merge), (3, Method::Melt)] {
        for branches in [false, true] {
            for count in [12, 24, 48, 64, 128, 400] {
                let mut shape = || random_shape(dimensions, branches, &mut seed, count);
                let sets: Vec<(Shape, Shape)> = (0..pairs).map(|_| (shape(), shape())).collect();
                let name = if branches { "with branches" } else { "random" };
                let found = rows(&format!("{name}, in {dimensions} dimensions"), &sets, before);
                if dimensions == 2 && !branches {
                    let what = format!("random pairs of {count} cells in a plane, T by the bound");
                    figures.push(found.row(&what, ["33.9", "8"], |middle| middle.ratios));
                }
            }
        }
    }
    for (count, figure) in [(64, ["441", "100"]), (400, ["3717", "300"])] {
        let row: Shape = (0..count).map(|x| [x, 0, 0]).collect();
        let mut shape = || random_shape(3, false, &mut seed, count as usize);
        let sets: Vec<(Shape, Shape)> = (0..pairs.min(4)).map(|_| (row.clone(), shape())).collect();
        let found = rows("a row, to random in space", &sets, Method::Melt);
        figures
            .push(found.row(&format!("a row of {count} cells to random in space, T"), figure, |f| f.times));
    }
    figures
}

/// The medians of a set: times of the motion, these by their bounds, and seconds of planning and judging.
struct Medians {
    times: f64,
    ratios: f64,
    spent: f64,
}

impl Medians {
    /// Returns a row of the table of figures, for which no paper has a figure: what it is, the figure before and the aim,
    /// and which of the medians it is.
    fn row(&self, what: &str, [then, aim]: [&str; 2], figure: impl Fn(&Medians) -> f64) -> String {
        format!("| {what} | {then} | {aim} | {:.1} | | {:.2} |", figure(self), self.spent)
    }
}

/// Prints a row of the table for the method before, and one for the default, and returns the medians of the latter.
fn rows(name: &str, sets: &[(Shape, Shape)], before: Method) -> Medians {
    let mut medians = Medians { times: f64::NAN, ratios: f64::NAN, spent: f64::NAN };
    for method in [before, Method::Auto] {
        let (mut times, mut ratios) = (vec![], vec![]);
        let start = Instant::now();
        let mut refused = 0;
        for (from, to) in sets {
            let problem = Problem::floating(unit_cell(), from.clone(), to.clone());
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
        medians = Medians { times: time, ratios: ratio, spent };
    }
    medians
}

/// Returns the median and the greatest of some numbers; NaN if there are none.
fn middle(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let at = |index: usize| values.get(index).copied().unwrap_or(f64::NAN);
    (at(values.len() / 2), at(values.len().saturating_sub(1)))
}
