//! The trial: which tests reach which mutants, and which mutants the tests notice.

use crate::build::Folders;
use crate::mutant::Mutant;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, mpsc};
use std::time::{Duration, Instant};

/// The most memory that a test may have under a mutant, KiB: one that asks for more is noticed.
const MEMORY: u64 = 8_000_000;

/// A test may take so many times its usual time and so many seconds besides, before the mutant counts as noticed.
const PATIENCE: (f64, f64) = (10.0, 10.0);

/// A test, with its duration (s) and the numbers of the mutants that it reaches.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Test {
    pub name: String,
    pub seconds: f64,
    pub reached: BTreeSet<usize>,
}

/// What became of a mutant.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub enum Fate {
    /// A test fails.
    Killed { test: String },
    /// A test does not end.
    Endless { test: String },
    /// All tests that reach it pass.
    Survived { tests: usize },
    /// No test reaches it.
    Unreached,
}

impl Fate {
    /// Returns true if the tests notice the mutant.
    pub fn noticed(&self) -> bool {
        matches!(self, Fate::Killed { .. } | Fate::Endless { .. })
    }
}

/// How a test ended.
enum End {
    Passed,
    Failed,
    TimedOut,
}

/// Runs one test as a process of its own, in the copy.
fn run(
    folders: &Folders,
    program: &Path,
    test: &str,
    variable: (&str, &str),
    limit: f64,
) -> Result<End, String> {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MEMORY}; exec \"$@\""), "sh"])
        .arg(program)
        .args([test, "--exact", "--test-threads=1", "--quiet"])
        .current_dir(&folders.tree)
        .env(variable.0, variable.1)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .process_group(0)
        .spawn()
        .map_err(|why| format!("{test}: {why}"))?;
    let (group, (sender, receiver)) = (child.id(), mpsc::channel());
    let waiter = std::thread::spawn(move || sender.send(child.wait()));
    let ended = receiver.recv_timeout(Duration::from_secs_f64(limit));
    if ended.is_err() {
        // With all programs that it started.
        let _ = Command::new("kill").args(["-KILL", "--", &format!("-{group}")]).status();
    }
    let _ = waiter.join();
    match ended {
        Ok(Ok(status)) if status.success() => Ok(End::Passed),
        Ok(Ok(_)) => Ok(End::Failed),
        Ok(Err(why)) => Err(format!("{test}: {why}")),
        Err(_) => Ok(End::TimedOut),
    }
}

/// Works through `count` items with several threads, in order, each item once.
fn share(workers: usize, count: usize, work: impl Fn(usize) + Sync) {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    if at >= count {
                        return;
                    }
                    work(at);
                }
            });
        }
    });
}

/// Returns the names of the tests of a program that begin with one of `prefixes`.
pub fn list(folders: &Folders, program: &Path, prefixes: &[&str]) -> Result<Vec<String>, String> {
    let output = Command::new(program).current_dir(&folders.tree).arg("--list").output();
    let output = output.map_err(|why| format!("{}: {why}", program.display()))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let names = text.lines().filter_map(|line| line.strip_suffix(": test"));
    Ok(names.filter(|name| prefixes.iter().any(|p| name.starts_with(p))).map(str::to_owned).collect())
}

/// Runs every test once without a mutant. Returns the tests that pass in time, the shortest first, and a line for each of
/// the others. `scratch`: a folder for what tests reach; `longest`: the most time that a test may take, s.
pub fn reach(
    folders: &Folders,
    program: &Path,
    names: &[String],
    scratch: &Path,
    (workers, longest): (usize, f64),
) -> Result<(Vec<Test>, Vec<String>), String> {
    fs::create_dir_all(scratch).map_err(|why| format!("{}: {why}", scratch.display()))?;
    let found: Mutex<Vec<Result<Test, String>>> = Mutex::new(Vec::new());
    share(workers, names.len(), |at| {
        let (name, file): (_, PathBuf) = (&names[at], scratch.join(format!("{at}")));
        let _ = fs::remove_file(&file);
        let begin = Instant::now();
        let variable = ("MODL_MUTANTS_REACHED", &*file.to_string_lossy());
        let end = run(folders, program, name, variable, longest);
        let seconds = begin.elapsed().as_secs_f64();
        let text = fs::read_to_string(&file).unwrap_or_default();
        let reached = text.lines().filter_map(|line| line.parse().ok()).collect();
        let result = match end {
            Ok(End::Passed) => Ok(Test { name: name.clone(), seconds, reached }),
            Ok(End::Failed) => Err(format!("{name} fails without a mutant")),
            Ok(End::TimedOut) => Err(format!("{name} takes more than {longest} s")),
            Err(why) => Err(why),
        };
        found.lock().expect("no worker panics").push(result);
    });
    let (mut tests, mut left_out) = (Vec::new(), Vec::new());
    for result in found.into_inner().expect("no worker panics") {
        match result {
            Ok(test) => tests.push(test),
            Err(why) => left_out.push(why),
        }
    }
    tests.sort_by(|a, b| a.seconds.total_cmp(&b.seconds).then_with(|| a.name.cmp(&b.name)));
    left_out.sort();
    Ok((tests, left_out))
}

/// Returns what becomes of the mutants, by their keys. `chosen`: their numbers; `done` gets each result as it comes.
pub fn judge(
    folders: &Folders,
    program: &Path,
    (mutants, chosen): (&[Mutant], &[usize]),
    tests: &[Test],
    workers: usize,
    done: impl Fn(&BTreeMap<String, Fate>) + Sync,
) -> Result<BTreeMap<String, Fate>, String> {
    let fates: Mutex<BTreeMap<String, Fate>> = Mutex::new(BTreeMap::new());
    let failure: Mutex<Option<String>> = Mutex::new(None);
    share(workers, chosen.len(), |at| {
        let id = chosen[at];
        let begin = Instant::now();
        match fate(folders, program, id, tests) {
            Ok(fate) => {
                let mut fates = fates.lock().expect("no worker panics");
                eprintln!(
                    "{}/{} {:.1} s {} {fate:?}",
                    fates.len() + 1,
                    chosen.len(),
                    begin.elapsed().as_secs_f64(),
                    id
                );
                fates.insert(mutants[id - 1].key(), fate);
                done(&fates);
            }
            Err(why) => *failure.lock().expect("no worker panics") = Some(why),
        }
    });
    match failure.into_inner().expect("no worker panics") {
        Some(why) => Err(why),
        None => Ok(fates.into_inner().expect("no worker panics")),
    }
}

/// Returns what becomes of one mutant: the tests that reach it are run, the shortest first, until one fails.
fn fate(folders: &Folders, program: &Path, id: usize, tests: &[Test]) -> Result<Fate, String> {
    let reaching: Vec<&Test> = tests.iter().filter(|test| test.reached.contains(&id)).collect();
    if reaching.is_empty() {
        return Ok(Fate::Unreached);
    }
    let number = id.to_string();
    for test in &reaching {
        let limit = test.seconds * PATIENCE.0 + PATIENCE.1;
        match run(folders, program, &test.name, ("MODL_MUTANT", &number), limit)? {
            End::Passed => {}
            End::Failed => return Ok(Fate::Killed { test: test.name.clone() }),
            End::TimedOut => return Ok(Fate::Endless { test: test.name.clone() }),
        }
    }
    Ok(Fate::Survived { tests: reaching.len() })
}
