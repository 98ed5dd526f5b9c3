//! Unwinding: how many configurations come to a snake, how long that takes, and whether the judge and a
//! second replay let every plan through.
//!
//! `cargo bench --bench tosnake -- FOLDER`: all `.rofi` files below it, in order of their size.
//! `--tangles=N` instead: N tangles of our own, as many from each line of the table; the number of a
//! tangle is its seed. Each is planned as a program would, with the judge, within `--limit=60` seconds of
//! the processor; `--replay=K` replays every K-th plan in steps of a degree. `--seed=N` and `--budget=N`
//! are the planner's. `--first=N --every=K` takes every K-th of them from the N-th on. `--out=FILE` keeps
//! what was found, and goes on where it was ended; `--peer=FILE` prints another planner's times beside, from
//! a table with `instance`, `success` and `cpu_s`.
//! `--memory` tells the most memory that was taken. `--modules=50,100` instead: one tangle for each number of
//! modules, of `--actions=1000` actions, with the seed 1.

#[path = "../tests/support/replay.rs"]
mod replay;

use modl::interpret::{Host, Mode, Options, WriteError};
use modl::plan::{Body, file};
use modl::source::{Files, ReadError};
use replay::Replay;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The allocator that the tool has.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Modules at which a new line of the table begins.
const BUCKETS: [usize; 7] = [0, 5, 50, 100, 150, 200, usize::MAX];

/// Lines that tangles of our own are for.
const TANGLED: [[usize; 2]; 4] = [[5, 50], [50, 100], [100, 150], [150, 200]];

/// Something to unwind.
struct Instance {
    name: String,
    modules: usize,
    /// How a program names it.
    expression: String,
    text: String,
}

/// What came of it, as it is kept: one line of words.
#[derive(Clone, Default)]
struct Row {
    name: String,
    modules: usize,
    /// Seconds of the processor, for the plan and for the judge.
    planning: f64,
    judging: f64,
    /// `proved`, or why not.
    outcome: String,
    docks: usize,
    steps: usize,
    /// Seconds that the motion takes, and radians that all joints turn together.
    makespan: f64,
    travel: f64,
    /// Empty where it was not replayed.
    replay: String,
}

struct Asked {
    seed: u64,
    budget: u64,
    limit: f64,
    replay: usize,
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let word = |name: &str| args.iter().find_map(|a| a.strip_prefix(name));
    let number = |name: &str, otherwise: u64| word(name).and_then(|w| w.parse().ok()).unwrap_or(otherwise);
    let asked = Asked {
        seed: number("--seed=", 0),
        budget: number("--budget=", 5_000_000),
        limit: number("--limit=", 60) as f64,
        replay: number("--replay=", 0) as usize,
    };
    let mut files = Vec::new();
    args.iter().filter(|a| !a.starts_with("--")).for_each(|a| collect(Path::new(a), &mut files));
    let mut instances: Vec<Instance> = files.iter().filter_map(|path| instance(path)).collect();
    if let Some(sizes) = word("--modules=") {
        let actions = number("--actions=", 1_000) as usize;
        let sizes = sizes.split(',').map(|size| size.parse().expect("numbers of modules"));
        instances.extend(sizes.map(|modules| tangle(modules, actions, 1)));
    }
    if instances.is_empty() {
        instances = tangles(number("--tangles=", 20) as usize);
    }
    instances.sort_by(|a, b| (a.modules, &a.name).cmp(&(b.modules, &b.name)));
    let (first, every) = (number("--first=", 0) as usize, number("--every=", 1) as usize);
    instances = instances.into_iter().skip(first).step_by(every.max(1)).collect();
    let peer = word("--peer=").map(peers).unwrap_or_default();
    let out = word("--out=");
    let known = out.map(kept).unwrap_or_default();
    println!(
        "| configuration | modules | outcome | planning | peer | judging | docks | steps | makespan | turns | replay |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    for (index, instance) in instances.iter().enumerate() {
        let row = known.get(&instance.name).cloned().unwrap_or_else(|| {
            let replays = asked.replay > 0 && index % asked.replay == 0;
            let row = planned(instance, &asked, replays);
            if let Some(out) = out {
                keep(out, &row);
            }
            row
        });
        print(&row, peer.get(&row.name));
        rows.push(row);
    }
    table(&rows, &peer);
    if args.iter().any(|a| a == "--memory") {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        println!(
            "\n{}",
            status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or("memory: not told here")
        );
    }
}

fn instance(path: &Path) -> Option<Instance> {
    let text = std::fs::read_to_string(path).expect("a text");
    let modules = modl::robot::rofi::read(&text).ok()?.modules.len();
    let name = path.file_stem()?.to_string_lossy().into_owned();
    Some(Instance { name, modules, expression: "load(\"x.rofi\")".into(), text })
}

/// As many for each line of the table, evenly spread over its sizes, 1,000 and 6,000 actions in turns.
fn tangles(count: usize) -> Vec<Instance> {
    let each = count.div_ceil(TANGLED.len());
    let one = |index: usize| {
        let [low, high] = TANGLED[index / each];
        let modules = low + index % each * (high - low) / each;
        tangle(modules, [1_000, 6_000][index % 2], index)
    };
    (0..each * TANGLED.len()).map(one).collect()
}

fn tangle(modules: usize, actions: usize, seed: usize) -> Instance {
    let expression = format!("tangle({modules}, {actions}, seed: {seed})");
    Instance { name: format!("{modules}-{actions}-{seed}"), modules, expression, text: String::new() }
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

/// Plans one in the language, and judges.
fn planned(instance: &Instance, asked: &Asked, replays: bool) -> Row {
    let Asked { seed, budget, limit, .. } = asked;
    let emit = if replays { "emit(p, \"p.plan.json\")\n" } else { "" };
    let program = format!(
        "use std.rofi.{{Rofi, tangle}}\nlet t = {}\nprint(\"begin\")\nlet p = tosnake(t, seed: {seed}, budget: \
         {budget}, timeout: {limit}s)\nprint(\"plan\", p.docks, p.steps, p.duration / 1s, p.joint_travel / 1rad, \
         verify(p).ok)\n{emit}save(t, \"end.rofi\")\n",
        instance.expression
    );
    let files = Memory(vec![("main.mod", program), ("x.rofi", instance.text.clone())]);
    let checked = modl::check::check(&files, "main.mod");
    let mut host = Clock::default();
    let outcome = modl::execute::run(&checked, Mode::Run, &files, &mut host, &Options::default());
    let mut row = Row { name: instance.name.clone(), modules: instance.modules, ..Row::default() };
    row.planning = host.planned.unwrap_or(host.ended) - host.begun;
    row.outcome = match &host.plan[..] {
        [docks, steps, makespan, travel, ok] => {
            let number = |word: &str| word.parse::<f64>().expect("the program prints numbers");
            row.judging = host.ended - host.begun - row.planning;
            (row.docks, row.steps) = (number(docks) as usize, number(steps) as usize);
            (row.makespan, row.travel) = (number(makespan), number(travel));
            (if ok == "true" { "proved" } else { "not proved" }).into()
        }
        _ => {
            let errors = outcome.diagnostics.iter().chain(&checked.diagnostics);
            let errors = errors.filter(|d| d.code.to_string().starts_with('E'));
            errors.map(|d| format!("{} {}", d.code, d.message)).next().unwrap_or_else(|| "no plan".into())
        }
    };
    if let Some(text) = &host.file {
        row.replay = replayed(text);
    }
    row
}

fn replayed(text: &str) -> String {
    let plan = file::read(text).expect("it was written to be read");
    let Body::Tracks(tracks) = &plan.body else { return "no joints".into() };
    let replay = Replay::new(tracks);
    replay.judge().and_then(|()| replay.ends_as_snake()).map_or_else(|fault| fault, |()| "agrees".into())
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

/// Reads the clock where the program begins to plan, where the judge begins, and where the plan is there.
#[derive(Default)]
struct Clock {
    begun: f64,
    planned: Option<f64>,
    ended: f64,
    plan: Vec<String>,
    file: Option<String>,
}

impl Host for Clock {
    fn print(&mut self, line: &str) {
        self.ended = cpu();
        match line.strip_prefix("plan ") {
            Some(words) => self.plan = words.split(' ').map(str::to_owned).collect(),
            None => self.begun = self.ended,
        }
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        // The last thing that is written is not the plan: it makes the program wait for the clock.
        if path.ends_with(".json") {
            self.file = String::from_utf8(bytes.to_vec()).ok();
        }
        Ok(path.to_owned())
    }

    fn progress(&mut self, line: &str) {
        self.ended = cpu();
        if line.starts_with("verifying") {
            self.planned = Some(self.ended);
        }
    }

    fn elapsed(&self) -> f64 {
        cpu()
    }
}

/// Seconds of the processor that this program took, with threads that have ended; where the system does not tell, those of
/// the wall's clock.
fn cpu() -> f64 {
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // User and system time are the 12th and 13th word after the name of the program, which is in parentheses.
    let words = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: Vec<f64> = words.skip(11).take(2).filter_map(|word| word.parse().ok()).collect();
    if let [user, system] = ticks[..] {
        return (user + system) / TICKS;
    }
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(0.0, |since| since.as_secs_f64())
}

/// Times of another planner by name; `None` where it found no plan.
fn peers(path: &str) -> BTreeMap<String, Option<f64>> {
    let text = std::fs::read_to_string(path).expect("the table of the other planner");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().expect("a table has a head");
    let column = |name: &str| head.iter().position(|h| *h == name).expect("the table has this column");
    let (instance, success, time) = (column("instance"), column("success"), column("cpu_s"));
    let row = |words: Vec<&str>| {
        let name = Path::new(words[instance]).file_stem()?.to_string_lossy().into_owned();
        Some((name, if words[success] == "1" { words[time].parse().ok() } else { None }))
    };
    lines.filter_map(row).collect()
}

/// What a run before kept.
fn kept(path: &str) -> BTreeMap<String, Row> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let row = |line: &str| {
        let words: Vec<&str> = line.split('\t').collect();
        let [name, modules, planning, judging, outcome, docks, steps, makespan, travel, replay] = words[..]
        else {
            return None;
        };
        let row = Row {
            name: name.into(),
            modules: modules.parse().ok()?,
            planning: planning.parse().ok()?,
            judging: judging.parse().ok()?,
            outcome: outcome.into(),
            docks: docks.parse().ok()?,
            steps: steps.parse().ok()?,
            makespan: makespan.parse().ok()?,
            travel: travel.parse().ok()?,
            replay: replay.into(),
        };
        Some((row.name.clone(), row))
    };
    text.lines().filter_map(row).collect()
}

fn keep(path: &str, row: &Row) {
    let Row { name, modules, planning, judging, outcome, docks, steps, makespan, travel, replay } = row;
    let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
    let line = format!(
        "{name}\t{modules}\t{planning}\t{judging}\t{outcome}\t{docks}\t{steps}\t{makespan}\t{travel}\t{replay}\n"
    );
    file.and_then(|mut file| file.write_all(line.as_bytes())).expect("the file can be written");
}

fn print(row: &Row, peer: Option<&Option<f64>>) {
    let Row { name, modules, outcome, planning, judging, docks, steps, makespan, travel, replay } = row;
    let peer = match peer {
        Some(Some(time)) => format!("{time:.2} s"),
        Some(None) => "none".into(),
        None => String::new(),
    };
    println!(
        "| {name} | {modules} | {outcome} | {planning:.3} s | {peer} | {judging:.2} s | {docks} | {steps} | \
         {makespan:.1} s | {travel:.0} rad | {replay} |"
    );
}

/// The share that has a proved plan, and times of those, by size.
fn table(rows: &[Row], peer: &BTreeMap<String, Option<f64>>) {
    println!();
    println!(
        "| modules | configurations | starts in itself | proved | share | median | p90 | worst | judging, worst | \
         replayed | disagree | peer |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for ends in BUCKETS.windows(2) {
        let within: Vec<&Row> = rows.iter().filter(|r| (ends[0]..ends[1]).contains(&r.modules)).collect();
        let proved: Vec<&&Row> = within.iter().filter(|r| r.outcome == "proved").collect();
        let mut times: Vec<f64> = proved.iter().map(|r| r.planning).collect();
        times.sort_by(f64::total_cmp);
        let Some(worst) = times.last() else { continue };
        let judging = proved.iter().map(|r| r.judging).fold(0.0, f64::max);
        let overlapping = within.iter().filter(|r| r.outcome.contains("in each other before")).count();
        let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize];
        let replayed: Vec<&&&Row> = proved.iter().filter(|r| !r.replay.is_empty()).collect();
        let disagree = replayed.iter().filter(|r| r.replay != "agrees").count();
        let met: Vec<&Option<f64>> = within.iter().filter_map(|r| peer.get(&r.name)).collect();
        println!(
            "| {}-{} | {} | {overlapping} | {} | {:.1} % | {:.2} s | {:.2} s | {worst:.2} s | {judging:.2} s | {} | \
             {disagree} | {} of {} |",
            ends[0],
            ends[1].saturating_sub(1),
            within.len(),
            proved.len(),
            100.0 * proved.len() as f64 / within.len() as f64,
            at(0.5),
            at(0.9),
            replayed.len(),
            met.iter().filter(|time| time.is_some()).count(),
            met.len()
        );
    }
}
