//! Lattice plans of rows that become columns: how long it takes to make one, to write it, and to judge
//! it, how large the file is, and how the time of the motion compares with bounds.
//!
//! `cargo bench --bench squeeze`; with a number behind `--`, up to so many cells; with names of methods,
//! those only; with `planar`, irregular shapes in a plane instead, of that number of cells; with `blocks`, random shapes of
//! blocks of cells that do not slide, and of such that do; with `balanced`, random shapes in a plane that do not turn.

#[path = "../tests/support/lattices.rs"]
mod lattices;

use lattices::{PAPER, TERMS, judged_plan, plan_of, random_shape, stages_of, unit_cell};
use modl::plan::{Body, StageEnd};
use modl::planners::NoProgress;
use modl::planners::squeeze::{
    Method, Motion, PlanLimits, Problem, Refusal, Settings, accordion, arms, fold, shear,
};
use modl::robot::{Cell, Library};
use std::time::Instant;

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

type Construction = fn(PlanLimits, u64) -> Result<Motion, Refusal>;

const METHODS: [(&str, Construction); 4] =
    [("accordion", accordion), ("arms", arms), ("fold", fold), ("shear", shear)];
const COUNTS: [u64; 7] = [1_000, 4_096, 10_000, 65_536, 100_000, 999_999, 1_000_000];

fn main() {
    let most = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(u64::MAX);
    let named: Vec<String> = std::env::args().filter(|a| METHODS.iter().any(|(name, _)| name == a)).collect();
    if std::env::args().any(|a| a == "planar") {
        return planar(most.min(1_000_000) as usize);
    }
    if std::env::args().any(|a| a == "blocks") {
        return blocks(most.min(2048) as usize);
    }
    if std::env::args().any(|a| a == "balanced") {
        return balanced(most.min(400) as usize);
    }
    if named.is_empty() {
        makespans();
        println!();
    }
    println!("| n | method | emit | file | write | verify | stages | runs |");
    println!("|---|---|---|---|---|---|---|---|");
    for n in COUNTS.into_iter().filter(|n| *n <= most) {
        let wanted = |name: &str| named.is_empty() || named.iter().any(|n| n == name);
        for (name, construction) in METHODS.into_iter().filter(|(name, _)| wanted(name)) {
            let start = Instant::now();
            let way = construction(TERMS, n).expect("there is a way");
            let emit = start.elapsed();
            let plan = plan_of(stages_of(way, PAPER));
            let Body::Stages(stages) = &plan.body else { unreachable!("it is a lattice") };
            let (count, runs) =
                (stages.stages.len(), stages.stages.iter().map(|s| records(&s.end)).sum::<usize>());
            let start = Instant::now();
            let text = modl::plan::file::write(&plan).expect("it can be written");
            let write = start.elapsed();
            let start = Instant::now();
            let verdict = judged_plan(&plan);
            let verify = start.elapsed();
            assert!(verdict.ok(), "{:?}", verdict.failures);
            println!(
                "| {n} | {name} | {:.2} ms | {:.1} kB | {:.1} ms | {:.2} s | {count} | {runs} |",
                emit.as_secs_f64() * 1e3,
                text.len() as f64 / 1e3,
                write.as_secs_f64() * 1e3,
                verify.as_secs_f64(),
            );
        }
    }
}

/// A merge of two random shapes in a plane.
fn planar(count: usize) {
    let mut seed = 1;
    let mut shape = || random_shape(2, false, &mut seed, count);
    let problem = Problem::floating(unit_cell(), shape(), shape());
    let settings = Settings { method: Method::Merge, ..Settings::default() };
    let start = Instant::now();
    let solution =
        modl::planners::squeeze::plan(&problem, &settings, &mut NoProgress).expect("there is a way");
    let planned = start.elapsed();
    let Body::Stages(stages) = solution.body else { unreachable!("it is a lattice") };
    let (count_of_stages, plan) = (stages.stages.len(), plan_of(stages));
    let start = Instant::now();
    let text = modl::plan::file::write(&plan).expect("it can be written");
    let write = start.elapsed();
    let start = Instant::now();
    let read = modl::plan::file::read(&text).expect("it can be read");
    let reading = start.elapsed();
    assert!(read == plan);
    let start = Instant::now();
    let verdict = judged_plan(&plan);
    let verify = start.elapsed();
    assert!(verdict.ok(), "{:?}", verdict.failures);
    println!("| n | stages | plan | file | write | read | verify |");
    println!("|---|---|---|---|---|---|---|");
    println!(
        "| {count} | {count_of_stages} | {:.2} s | {:.1} MB | {:.2} s | {:.2} s | {:.2} s |",
        planned.as_secs_f64(),
        text.len() as f64 / 1e6,
        write.as_secs_f64(),
        reading.as_secs_f64(),
        verify.as_secs_f64(),
    );
}

/// Random shapes in space of blocks of eight cells, of up to `most` cells, which tunnel if they do not slide.
fn blocks(most: usize) {
    println!("| cells | bound | tunnel | stages | plan | file | verify | of cells that slide |");
    println!("|---|---|---|---|---|---|---|---|");
    for count in [4_usize, 8, 16, 32, 64, 128, 256].into_iter().filter(|count| 8 * count <= most) {
        let mut seed = count as u64;
        let mut shape = || -> Vec<[i64; 3]> {
            let cells =
                |site: [i64; 3]| (0..8).map(move |k| [0, 1, 2].map(|axis| 2 * site[axis] + (k >> axis & 1)));
            random_shape(3, false, &mut seed, count).into_iter().flat_map(cells).collect()
        };
        let (from, to) = (shape(), shape());
        let solved = |cell: Cell| {
            let problem = Problem::floating(cell, from.clone(), to.clone());
            let start = Instant::now();
            let found = modl::planners::squeeze::plan(&problem, &Settings::default(), &mut NoProgress);
            (found.expect("there is a way"), start.elapsed())
        };
        let docked = Cell { slides: false, ..unit_cell() };
        let (solution, planned) = solved(docked.clone());
        let Body::Stages(stages) = solution.body else { unreachable!("it is a lattice") };
        let (time, number) = (stages.duration(), stages.stages.len());
        let mut plan = plan_of(stages);
        plan.library = std::sync::Arc::new(Library { cells: vec![docked], ..Library::default() });
        let text = modl::plan::file::write(&plan).expect("it can be written");
        let start = Instant::now();
        let verdict = judged_plan(&plan);
        let verify = start.elapsed();
        assert!(verdict.ok(), "{:?}", verdict.failures);
        let (slid, _) = solved(unit_cell());
        println!(
            "| {} | {:.1} | {time:.0} | {number} | {:.2} s | {:.2} MB | {:.2} s | {:.1}, {} |",
            8 * count,
            solution.report.lower_bound,
            planned.as_secs_f64(),
            text.len() as f64 / 1e6,
            verify.as_secs_f64(),
            slid.body.duration(),
            slid.report.method.name(),
        );
    }
}

/// Random shapes in a plane, of up to `most` cells, that become each other without a turn.
fn balanced(most: usize) {
    println!("| cells | bound | `spin` | stages | plan | file | verify | `push` |");
    println!("|---|---|---|---|---|---|---|---|");
    for count in [9_usize, 16, 25, 36, 64, 100, 196, 400].into_iter().filter(|count| *count <= most) {
        let mut seed = count as u64;
        let mut shape = || random_shape(2, false, &mut seed, count);
        let problem = Problem::floating(unit_cell(), shape(), shape());
        let solved = |settings: &Settings| {
            let start = Instant::now();
            let found = modl::planners::squeeze::plan(&problem, settings, &mut NoProgress);
            (found, start.elapsed())
        };
        let model = modl::planners::squeeze::ModelChoice::Balanced;
        let (found, planned) = solved(&Settings { method: Method::Spin, model, ..Settings::default() });
        let Ok(solution) = found else {
            println!("| {count} | no way |");
            continue;
        };
        let Body::Stages(stages) = solution.body else { unreachable!("it is a lattice") };
        let (time, number) = (stages.duration(), stages.stages.len());
        let plan = plan_of(stages);
        let text = modl::plan::file::write(&plan).expect("it can be written");
        let start = Instant::now();
        let verdict = judged_plan(&plan);
        let verify = start.elapsed();
        assert!(verdict.ok(), "{:?}", verdict.failures);
        let (pushed, _) = solved(&Settings { method: Method::Push, ..Settings::default() });
        println!(
            "| {count} | {:.1} | {time:.0} | {number} | {:.2} s | {:.2} MB | {:.2} s | {:.1} |",
            solution.report.lower_bound,
            planned.as_secs_f64(),
            text.len() as f64 / 1e6,
            verify.as_secs_f64(),
            pushed.map_or(f64::NAN, |solution| solution.body.duration()),
        );
    }
}

/// Returns the number of runs, or of classes and spans, that state the end of a stage.
fn records(end: &StageEnd) -> usize {
    match end {
        StageEnd::Runs(runs) => runs.len(),
        StageEnd::Moves(moves) => moves.classes.len() + moves.cells.len(),
    }
}

/// Times in units: of a cell's length at unit acceleration.
fn makespans() {
    println!("| n | unit speed >= | lower bound | shear | arms | accordion | fold | peak force, arms |");
    println!("|---|---|---|---|---|---|---|---|");
    for n in [16, 64, 256, 1024, 4096, 16_384, 65_536, 1_000_000] {
        let time = |construction: Construction| construction(TERMS, n).expect("there is a way").duration();
        let verdict = judged_plan(&plan_of(stages_of(arms(TERMS, n).expect("a way"), PAPER)));
        println!(
            "| {n} | {:.1} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.1} |",
            (n - 1) as f64 / 2.0,
            libm::sqrt(2.0 * (n - 1) as f64),
            time(shear),
            time(arms),
            time(accordion),
            time(fold),
            verdict.dynamics.expect("a lattice has them").peak_force,
        );
    }
}
