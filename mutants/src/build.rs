//! The instrumented copy of the project, and its build: mutants that don't compile are found by the places of the
//! compiler's errors, and others take their place.

use crate::instrument::{self, Placed};
use crate::mutant::Mutant;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The greatest number of times that the copy is checked by the compiler.
const ROUNDS_MAX: usize = 30;

/// The folders of one run.
pub struct Folders {
    /// The root of the project.
    pub root: PathBuf,
    /// The instrumented copy.
    pub tree: PathBuf,
    /// The folder into which the compiler writes.
    pub build: PathBuf,
}

/// Writes a file unless it stands there already, so that the compiler sees only what changed.
fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    let failed = |why: std::io::Error| format!("{}: {why}", path.display());
    fs::create_dir_all(path.parent().expect("it is below the root")).map_err(failed)?;
    fs::write(path, bytes).map_err(failed)
}

/// Copies all files that git knows or would add, but for those of `instrumented`; removes others from the copy.
pub fn copy(folders: &Folders, instrumented: &BTreeSet<String>) -> Result<(), String> {
    let list = |arguments: &[&str]| -> Result<BTreeSet<String>, String> {
        let output = Command::new("git").current_dir(&folders.root).args(arguments).output();
        let output = output.map_err(|why| format!("git: {why}"))?;
        Ok(String::from_utf8_lossy(&output.stdout)
            .split('\0')
            .filter(|n| !n.is_empty())
            .map(str::to_owned)
            .collect())
    };
    let mut names = list(&["ls-files", "-z", "--cached", "--others", "--exclude-standard"])?;
    names.retain(|name| folders.root.join(name).is_file());
    for name in names.difference(instrumented) {
        let bytes = fs::read(folders.root.join(name)).map_err(|why| format!("{name}: {why}"))?;
        write(&folders.tree.join(name), &bytes)?;
    }
    let sources = Path::new("src");
    for stale in files_below(&folders.tree, sources).into_iter().filter(|name| !names.contains(name)) {
        fs::remove_file(folders.tree.join(&stale)).map_err(|why| format!("{stale}: {why}"))?;
    }
    Ok(())
}

/// Returns the names of all files below a folder of `root`, from `root`.
pub fn files_below(root: &Path, folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let Ok(entries) = fs::read_dir(root.join(folder)) else { return found };
    for entry in entries.flatten() {
        let below = folder.join(entry.file_name());
        if entry.path().is_dir() {
            found.extend(files_below(root, &below));
        } else {
            found.insert(below.to_string_lossy().replace('\\', "/"));
        }
    }
    found
}

/// Writes the instrumented files, and the library's root with the module that chooses. Returns where mutants stand, by file.
pub fn instrumented(
    folders: &Folders,
    files: &BTreeSet<String>,
    mutants: &[Mutant],
) -> Result<BTreeMap<String, (String, Vec<Placed>)>, String> {
    let mut written = BTreeMap::new();
    let read =
        |name: &str| fs::read_to_string(folders.root.join(name)).map_err(|why| format!("{name}: {why}"));
    for name in files {
        let own = mutants.iter().enumerate().filter(|(_, mutant)| mutant.file == *name);
        let own: Vec<_> = own.map(|(at, mutant)| (at + 1, mutant)).collect();
        let (text, placed) = instrument::file(&read(name)?, &own);
        write(&folders.tree.join(name), text.as_bytes())?;
        written.insert(name.clone(), (text, placed));
    }
    // The size of the table does not follow the number of mutants, so that the root stays as it is.
    let root = read("src/lib.rs")? + &instrument::chooser(mutants.len().next_multiple_of(1000));
    write(&folders.tree.join("src/lib.rs"), root.as_bytes())?;
    Ok(written)
}

/// Draws the first `count` of `order` that compile, and leaves the instrumented copy in place. `refused`: the keys of
/// mutants that are known not to compile, to which those that are found are added.
pub fn draw(
    folders: &Folders,
    files: &BTreeSet<String>,
    order: &[Mutant],
    count: usize,
    refused: &mut BTreeSet<String>,
) -> Result<Vec<Mutant>, String> {
    for round in 1..=ROUNDS_MAX {
        let drawn: Vec<Mutant> =
            order.iter().filter(|mutant| !refused.contains(&mutant.key())).take(count).cloned().collect();
        let placed = instrumented(folders, files, &drawn)?;
        let errors = errors(folders)?;
        eprintln!("round {round}: {} mutants, {} errors", drawn.len(), errors.len());
        if errors.is_empty() {
            return Ok(drawn);
        }
        let before = refused.len();
        for error in &errors {
            let guilty = guilty(error, &placed);
            if guilty.is_empty() {
                eprintln!("{}: no mutant is at {:?}", error.message, error.spans);
            }
            refused.extend(guilty.into_iter().map(|id| drawn[id - 1].key()));
        }
        if refused.len() == before {
            return Err("errors that no mutant is to blame for".to_owned());
        }
    }
    Err(format!("the copy does not compile after {ROUNDS_MAX} rounds"))
}

/// An error of the compiler: its message, and the places that belong to it, in bytes, the primary ones first.
struct Complaint {
    message: String,
    spans: Vec<(String, usize, usize)>,
}

/// Returns the errors of the library in the copy.
fn errors(folders: &Folders) -> Result<Vec<Complaint>, String> {
    let output = Command::new("cargo")
        .current_dir(&folders.tree)
        .env("CARGO_TARGET_DIR", &folders.build)
        .args(["check", "--release", "--lib", "--message-format=json", "--quiet"])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|why| format!("cargo: {why}"))?;
    let mut found = Vec::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let Ok(message) = serde_json::from_str::<Value>(line) else { continue };
        let message = &message["message"];
        if message["level"] != "error" {
            continue;
        }
        let mut spans: Vec<&Value> = message["spans"].as_array().into_iter().flatten().collect();
        spans.sort_by_key(|span| span["is_primary"] != true);
        let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
        let spans = spans.into_iter().map(|span| {
            let file = span["file_name"].as_str().unwrap_or("").to_owned();
            (file, number(&span["byte_start"]), number(&span["byte_end"]))
        });
        let message = message["message"].as_str().unwrap_or("").to_owned();
        found.push(Complaint { message, spans: spans.collect() });
    }
    found.retain(|complaint| !complaint.spans.is_empty());
    if found.is_empty() && !output.status.success() {
        return Err("the copy does not compile, and the compiler names no place".to_owned());
    }
    Ok(found)
}

/// Returns the numbers of the mutants that are to blame for an error: the innermost whose changed text has one of its places,
/// or else the innermost with the original around a place, or else all in the lines around.
fn guilty(error: &Complaint, placed: &BTreeMap<String, (String, Vec<Placed>)>) -> BTreeSet<usize> {
    let innermost = |range: fn(&Placed) -> &std::ops::Range<usize>| {
        error.spans.iter().find_map(|(file, start, end)| {
            let around = |placed: &&Placed| range(placed).start <= *start && *end <= range(placed).end;
            let (_, all) = placed.get(file)?;
            all.iter().filter(around).min_by_key(|placed| range(placed).len()).map(|placed| placed.id)
        })
    };
    if let Some(id) = innermost(|placed| &placed.mutated).or_else(|| innermost(|placed| &placed.whole)) {
        return BTreeSet::from([id]);
    }
    let mut near = BTreeSet::new();
    for (file, start, end) in &error.spans {
        let Some((_, all)) = placed.get(file) else { continue };
        let within = |placed: &&Placed| placed.whole.start < *end && *start < placed.whole.end;
        near.extend(all.iter().filter(within).map(|placed| placed.id));
    }
    near
}

/// Builds the tests of the copy under the project's release profile, and returns the test program.
pub fn tests(folders: &Folders) -> Result<PathBuf, String> {
    let output = Command::new("cargo")
        .current_dir(&folders.tree)
        .env("CARGO_TARGET_DIR", &folders.build)
        .args(["test", "--release", "--test", "all", "--no-run", "--message-format=json", "--quiet"])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|why| format!("cargo: {why}"))?;
    let program = String::from_utf8_lossy(&output.stdout).lines().find_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        let tests = message["target"]["name"] == "all" && message["profile"]["test"] == true;
        message["executable"].as_str().filter(|_| tests).map(PathBuf::from)
    });
    if !output.status.success() {
        return Err("the tests of the copy don't compile".to_owned());
    }
    program.ok_or_else(|| "the build has no test program".to_owned())
}
