//! Tries the judge of modl by mutants: small changes of its code, of which the tests should notice every one.
//!
//! All drawn mutants are compiled into one copy of the project, and an environment variable chooses one, because building
//! the project once for each of a thousand would take weeks. `modl-mutants [--seed N] [--count N] [--first N]
//! [--workers N] [--longest SECONDS] [--survivors] [--reasoned] [--built] [--list]` draws, builds and runs, and writes
//! `target/mutants/report.md`:
//!
//! - `--count` mutants are drawn by `--seed` and compiled; of them the `--first` so many are tried (default: all);
//! - tests that take longer than `--longest` are left out; `--workers` tests run at a time;
//! - `--survivors` tries again those that survived the run before, for tests that were written since;
//! - `--reasoned` tries those with a reason to survive, too, which are left out otherwise;
//! - `--built` takes the program of the run before as it is, to go on with a run that ended early;
//! - `--list` prints the first `--count` of the draw, compiled or not, and does no more.

mod build;
mod instrument;
mod mutant;
mod operators;
mod report;
mod sites;
mod trial;

use build::Folders;
use mutant::Mutant;
use report::Reason;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use trial::Fate;

/// The files that are tried: the judge, and what a fault in is seen by neither judge nor planners; folders end in `/`.
const TRIED: &[&str] = &[
    "src/plan/verify/",
    "src/plan/lattice/",
    "src/geometry/",
    "src/robot/dynamics.rs",
    "src/behavior/schedule.rs",
    "src/behavior/run.rs",
    "src/behavior/played.rs",
    "src/behavior/motion.rs",
    "src/behavior/command.rs",
    "src/behavior/cyclic.rs",
    "src/behavior/docking.rs",
];

/// The tests that try them, by the beginnings of their names.
const TESTS: &[&str] =
    &["judge::", "dynamics::", "plans::", "robots::", "behavior::", "planners::", "language::interpret"];

struct Options {
    seed: u64,
    count: usize,
    first: usize,
    workers: usize,
    longest: f64,
    survivors: bool,
    reasoned: bool,
    list: bool,
    built: bool,
}

impl Options {
    fn read(arguments: &[String]) -> Result<Options, String> {
        let mut options = Options {
            seed: 1,
            count: 1000,
            first: usize::MAX,
            workers: 2,
            longest: 20.0,
            survivors: false,
            reasoned: false,
            list: false,
            built: false,
        };
        let mut rest = arguments.iter();
        while let Some(name) = rest.next() {
            let flag = match name.as_str() {
                "--survivors" => Some(&mut options.survivors),
                "--reasoned" => Some(&mut options.reasoned),
                "--list" => Some(&mut options.list),
                "--built" => Some(&mut options.built),
                _ => None,
            };
            if let Some(flag) = flag {
                *flag = true;
                continue;
            }
            let value = rest.next().ok_or_else(|| format!("{name} wants a value"))?;
            let wrong = || format!("{name} wants a number, not `{value}`");
            match name.as_str() {
                "--seed" => options.seed = value.parse().map_err(|_| wrong())?,
                "--count" => options.count = value.parse().map_err(|_| wrong())?,
                "--first" => options.first = value.parse().map_err(|_| wrong())?,
                "--workers" => options.workers = value.parse().map_err(|_| wrong())?,
                "--longest" => options.longest = value.parse().map_err(|_| wrong())?,
                _ => {
                    return Err(format!(
                        "no option `{name}`; there are: --seed --count --first --workers --longest --survivors \
                         --reasoned --built --list"
                    ));
                }
            }
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match Options::read(&arguments).and_then(|options| run(&options)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the names of the files that are tried, in order.
fn tried(root: &Path) -> BTreeSet<String> {
    let one = |name: &&str| match name.strip_suffix('/') {
        Some(folder) => build::files_below(root, Path::new(folder)),
        None => BTreeSet::from([(*name).to_owned()]),
    };
    TRIED.iter().flat_map(one).filter(|name| name.ends_with(".rs")).collect()
}

/// Returns all mutants of the files in the order of their draw.
fn order(root: &Path, files: &BTreeSet<String>, seed: u64) -> Result<Vec<Mutant>, String> {
    let mut all = Vec::new();
    for name in files {
        let text = fs::read_to_string(root.join(name)).map_err(|why| format!("{name}: {why}"))?;
        all.extend(sites::of_file(name, &text)?);
    }
    all.sort_by_cached_key(|mutant| (mutant.rank(seed), mutant.key()));
    Ok(all)
}

/// Reads a file that a run before may have left.
fn read<T: serde::de::DeserializeOwned + Default>(path: &Path) -> T {
    fs::read(path).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
}

fn save(path: &Path, value: &impl serde::Serialize) -> Result<(), String> {
    let text = serde_json::to_string_pretty(value).expect("it has names for keys");
    fs::write(path, text).map_err(|why| format!("{}: {why}", path.display()))
}

/// Returns the tests with what they reach, and a line for each that is left out; those of the run before, if the program is
/// still the same.
fn reach(
    folders: &Folders,
    program: &Path,
    work: &Path,
    options: &Options,
) -> Result<(Vec<trial::Test>, Vec<String>), String> {
    let built = fs::metadata(program).and_then(|data| data.modified()).map_err(|why| why.to_string())?;
    let stamp = format!("{} {built:?} {}", program.display(), options.longest);
    let (before, tests, left_out): (String, _, _) = read(&work.join("tests.json"));
    if before == stamp {
        return Ok((tests, left_out));
    }
    let names = trial::list(folders, program, TESTS)?;
    let limits = (options.workers, options.longest);
    let (tests, left_out) = trial::reach(folders, program, &names, &work.join("reached"), limits)?;
    save(&work.join("tests.json"), &(stamp, &tests, &left_out))?;
    Ok((tests, left_out))
}

fn run(options: &Options) -> Result<(), String> {
    let root =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().map_err(|why| why.to_string())?;
    let work: PathBuf = root.join("target/mutants");
    let folders = Folders { tree: work.join("tree"), build: work.join("build"), root };
    fs::create_dir_all(&folders.tree).map_err(|why| why.to_string())?;
    let text =
        fs::read(folders.root.join("mutants/reasons.json")).map_err(|why| format!("reasons.json: {why}"))?;
    let reasons: Vec<Reason> = serde_json::from_slice(&text).map_err(|why| format!("reasons.json: {why}"))?;

    let files = tried(&folders.root);
    let order = order(&folders.root, &files, options.seed)?;
    eprintln!("{} mutants of {} files", order.len(), files.len());
    if options.list {
        order
            .iter()
            .take(options.count)
            .for_each(|mutant| println!("{}:{} {}", mutant.file, mutant.line, mutant.key()));
        return Ok(());
    }
    let mut refused: BTreeSet<String> = read(&work.join("refused.json"));
    let (drawn, program) = if options.built {
        let known = order.iter().filter(|mutant| !refused.contains(&mutant.key()));
        (known.take(options.count).cloned().collect(), read::<PathBuf>(&work.join("program.json")))
    } else {
        let mut instrumented = files.clone();
        instrumented.insert("src/lib.rs".to_owned());
        build::copy(&folders, &instrumented)?;
        let drawn = build::draw(&folders, &files, &order, options.count, &mut refused);
        save(&work.join("refused.json"), &refused)?;
        let drawn = drawn?;
        let program = build::tests(&folders)?;
        save(&work.join("program.json"), &program)?;
        (drawn, program)
    };

    let begin = Instant::now();
    let (tests, left_out) = reach(&folders, &program, &work, options)?;
    let reaching = begin.elapsed().as_secs_f64();
    eprintln!("{} tests in {reaching:.0} s; {} are left out", tests.len(), left_out.len());

    let results = work.join(format!("results.{}.json", options.seed));
    let before: BTreeMap<String, Fate> =
        if options.survivors || options.built { read(&results) } else { BTreeMap::new() };
    let first = options.first.min(drawn.len());
    // The same program ends for no mutant otherwise than before.
    let again = options.survivors || !options.built;
    let reasoned = |mutant: &Mutant| reasons.iter().any(|reason| reason.fits(mutant));
    let wanted = |id: &usize| {
        let mutant = &drawn[id - 1];
        (options.reasoned || !reasoned(mutant))
            && before.get(&mutant.key()).is_none_or(|fate| again && !fate.noticed())
    };
    let mut chosen: Vec<usize> = (1..=first).filter(wanted).collect();
    // Those that have not been tried come first: most of them end soon.
    chosen.sort_by_key(|id| before.contains_key(&drawn[id - 1].key()));
    let save_all = |fates: &BTreeMap<String, Fate>| {
        let all: BTreeMap<_, _> = before.iter().chain(fates).collect();
        save(&results, &all).unwrap_or_else(|why| eprintln!("{why}"));
    };
    let begin = Instant::now();
    let fates = trial::judge(&folders, &program, (&drawn, &chosen), &tests, options.workers, save_all)?;
    let trying = begin.elapsed().as_secs_f64();

    let mut all = before.clone();
    all.extend(fates);
    let head = format!(
        "{first} mutants drawn by seed {} of {} in {} files. {} tests, which take {:.0} s one after the other; \
         {} mutants tried in {:.2} h by {} workers, after {:.2} h for what tests reach.",
        options.seed,
        order.len(),
        files.len(),
        tests.len(),
        tests.iter().map(|test| test.seconds).sum::<f64>(),
        chosen.len(),
        trying / 3600.0,
        options.workers,
        reaching / 3600.0,
    );
    let tried: Vec<&Mutant> = drawn[..first].iter().collect();
    let (report, share) = report::write(&tried, &all, &reasons, &head, &left_out);
    fs::write(work.join("report.md"), report).map_err(|why| why.to_string())?;
    println!("{share:.1} % killed of those without a reason: {}", work.join("report.md").display());
    Ok(())
}
