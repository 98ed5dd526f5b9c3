//! Unwinding: how many of the configurations in a folder come to a snake, and how long that takes.
//!
//! `cargo bench --bench tosnake -- FOLDER`: all `.rofi` files below it, in order of their size, each
//! with the default settings. `--judge` puts every plan before the judge, through the language;
//! `--seed=N`, `--budget=N` are the planner's. Without a folder: tangles of our own.

use modl::interpret::{self, Host, Mode, Options, WriteError};
use modl::planners::tosnake::assembly::{of_world, to_world};
use modl::planners::tosnake::{Refusal, Settings, Unsound, sound, tangle, unwind};
use modl::robot::rofi;
use modl::source::{Files, ReadError};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Modules at which a new line of the table begins.
const BUCKETS: [usize; 6] = [0, 5, 50, 100, 150, 200];

struct Row {
    modules: usize,
    /// Seconds; `None` where there was no plan.
    planned: Option<f64>,
    /// Whether the file says what can't be: modules in each other, or in pieces.
    unsound: bool,
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let option = |name: &str| args.iter().find_map(|a| a.strip_prefix(name)?.parse::<u64>().ok());
    let settings = Settings {
        seed: option("--seed=").unwrap_or(0),
        budget: option("--budget=").unwrap_or(Settings::default().budget),
        ..Settings::default()
    };
    let judge = args.iter().any(|a| a == "--judge");
    let mut files = Vec::new();
    args.iter().filter(|a| !a.starts_with("--")).for_each(|a| collect(Path::new(a), &mut files));
    let mut worlds: Vec<(String, String, Option<rofi::World>)> = files
        .iter()
        .map(|path| {
            let text = std::fs::read_to_string(path).expect("a text");
            let name = path.file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            let world = rofi::read(&text).ok();
            (name, text, world)
        })
        .collect();
    if worlds.is_empty() {
        worlds = tangles();
    }
    worlds.sort_by_key(|(name, _, world)| (world.as_ref().map_or(0, |w| w.modules.len()), name.clone()));
    println!("| configuration | modules | planning | docks | steps | poses | judging |");
    println!("|---|---|---|---|---|---|---|");
    let rows: Vec<Row> = worlds
        .iter()
        .filter_map(|(name, text, world)| row(name, text, world.as_ref()?, &settings, judge))
        .collect();
    table(&rows);
}

/// Tangles of our own: for every ten modules one of 1,000 and one of 6,000 actions.
fn tangles() -> Vec<(String, String, Option<rofi::World>)> {
    let sizes = (10..200).step_by(10).flat_map(|n| [(n, 1_000), (n, 6_000)]);
    let one = |(modules, actions)| {
        let world = to_world(&tangle::tangled(modules, actions, modules as u64));
        (format!("tangle({modules}, {actions})"), rofi::write(&world), Some(world))
    };
    sizes.map(one).collect()
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).expect("a folder");
        let mut inside: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        inside.sort();
        inside.iter().for_each(|path| collect(path, files));
    } else if path.extension().is_some_and(|e| e == "rofi") {
        files.push(path.to_owned());
    }
}

fn row(name: &str, text: &str, world: &rofi::World, settings: &Settings, judge: bool) -> Option<Row> {
    let mut robot = of_world(world);
    let modules = robot.modules();
    let start = Instant::now();
    let found = sound::mend(&mut robot)
        .map_err(Refusal::Unsound)
        .and_then(|_| unwind(&robot, settings, &mut |_| true));
    let time = start.elapsed().as_secs_f64();
    let unsound = matches!(found, Err(Refusal::Unsound(Unsound::Loose(_) | Unsound::Overlap(..))));
    match &found {
        Ok(found) => {
            let judged = if judge { judged(text, settings) } else { "".into() };
            println!(
                "| {name} | {modules} | {time:.3} s | {} | {} | {} | {judged} |",
                found.progress.made,
                found.steps.len(),
                found.progress.work
            );
        }
        Err(refusal) => println!("| {name} | {modules} | {time:.3} s: {refusal:?} | | | | |"),
    }
    Some(Row { modules, planned: found.is_ok().then_some(time), unsound })
}

/// Plans again, in the language, and judges.
fn judged(text: &str, settings: &Settings) -> String {
    let Settings { seed, budget, .. } = settings;
    let program = format!(
        "use std.rofi.Rofi\nlet p = tosnake(load(\"x.rofi\"), seed: {seed}, budget: {budget})\n\
         print(p.steps)\nprint(verify(p).ok, p.duration)\n"
    );
    let files = Memory(vec![("main.mod", program), ("x.rofi", text.to_owned())]);
    let checked = modl::check::check(&files, "main.mod");
    let mut host = Clock { lines: Vec::new(), verifying: None, took: 0.0 };
    let outcome = interpret::run(&checked, Mode::Run, &files, &mut host, &Options::default());
    match host.lines.last() {
        Some(line) if line.starts_with("true") => format!("{:.2} s, {line}", host.took),
        _ => outcome.diagnostics.first().map_or("no plan".into(), |d| d.message.clone()),
    }
}

struct Memory(Vec<(&'static str, String)>);

impl Files for Memory {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        found.map(|(_, text)| text.clone().into_bytes()).ok_or(ReadError::NotFound)
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        modl::source::library::text(path).map(Cow::Borrowed)
    }
}

/// Takes the time from the announcement of the judge to the next line that is printed.
struct Clock {
    lines: Vec<String>,
    verifying: Option<Instant>,
    took: f64,
}

impl Host for Clock {
    fn print(&mut self, line: &str) {
        if let Some(begun) = self.verifying.take() {
            self.took = begun.elapsed().as_secs_f64();
        }
        self.lines.push(line.to_owned());
    }

    fn write(&mut self, path: &str, _: &[u8]) -> Result<String, WriteError> {
        Ok(path.to_owned())
    }

    fn progress(&mut self, line: &str) {
        if line.starts_with("verifying") {
            self.verifying = Some(Instant::now());
        }
    }
}

/// The share that was planned, and times of those, by size.
fn table(rows: &[Row]) {
    println!();
    println!("| modules | configurations | can't be | planned | share of the rest | median | p90 | worst |");
    println!("|---|---|---|---|---|---|---|---|");
    for ends in BUCKETS.windows(2) {
        let within: Vec<&Row> = rows.iter().filter(|r| (ends[0]..ends[1]).contains(&r.modules)).collect();
        let mut times: Vec<f64> = within.iter().filter_map(|r| r.planned).collect();
        times.sort_by(f64::total_cmp);
        let (Some(worst), false) = (times.last(), within.is_empty()) else { continue };
        let unsound = within.iter().filter(|r| r.unsound).count();
        let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize];
        println!(
            "| {}-{} | {} | {unsound} | {} | {:.0} % | {:.2} s | {:.2} s | {worst:.2} s |",
            ends[0],
            ends[1] - 1,
            within.len(),
            times.len(),
            100.0 * times.len() as f64 / (within.len() - unsound).max(1) as f64,
            at(0.5),
            at(0.9)
        );
    }
}
