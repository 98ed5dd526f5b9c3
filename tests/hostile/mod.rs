//! Hostile inputs as data: each ends with its code, within a second and 256 MB.

mod case;
mod limits;
mod refusing;
mod system_calls;
mod writers;

use crate::desk::cli::Sandbox;
use case::{Case, cases};
#[cfg(unix)]
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// The most that a case may take of memory, bytes.
const MEMORY_MAX: u64 = 256 << 20;

/// The most that a case may take of the processor, s. Twice the second that is promised: the processor is shared with other
/// tests, whose memory slows it down. Without optimisation, time says nothing.
const PROCESSOR_MAX: f64 = if cfg!(debug_assertions) { f64::INFINITY } else { 2.0 };

/// A robot of two modules, as a file that programs import.
const PARTS: &str = "use std.smores.Smores
config Pair {
  part a: Smores
  part b: Smores
  connect a.top -- b.bottom
  behavior turn = move(a.tilt, to: 20deg)
}
";

/// The contents of all files below a folder, by their paths; folders have none.
#[cfg(unix)]
type Files = BTreeMap<String, Option<Vec<u8>>>;

/// Returns the contents of all files below a folder.
#[cfg(unix)]
fn files(folder: &Path) -> Files {
    fn add(folder: &Path, prefix: &str, found: &mut Files) {
        for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.file_type().expect("a type").is_dir() {
                add(&entry.path(), &format!("{name}/"), found);
                found.insert(name, None);
            } else {
                found.insert(name, Some(std::fs::read(entry.path()).expect("a file")));
            }
        }
    }
    let mut found = Files::new();
    add(folder, "", &mut found);
    found
}

/// What became of a case.
struct Ended {
    code: Option<i32>,
    codes: Vec<String>,
    text: String,
    memory: u64,
    processor: f64,
}

/// Names the folder in which [`measured`] finds what to run, and leaves what it found.
const PLACE: &str = "MODL_TEST_PLACE";

/// Runs a case in a folder of its own, and measures what it takes. The system counts the memory of the program that starts
/// another as that other's, too, so a process of its own, which has little, starts the command: [`measured`].
#[cfg(unix)]
fn run(case: &Case) -> Ended {
    let files: Vec<(&str, &[u8])> = case.files.iter().map(|(name, bytes)| (&**name, &**bytes)).collect();
    let sandbox = Sandbox::new(&files);
    let place = tempfile::TempDir::new().expect("a temporary folder");
    let at = |name: &str| place.path().join(name);
    std::fs::write(at("command"), &case.command).expect("a file");
    std::fs::write(at("input"), &case.input).expect("a file");
    let mut starter = std::process::Command::new(std::env::current_exe().expect("this program"));
    starter.args(["--exact", "hostile::measured", "--test-threads", "1"]);
    starter.env(PLACE, place.path()).current_dir(sandbox.path(""));
    let started = starter.output().expect("the tests start");
    assert!(started.status.success(), "{}", String::from_utf8_lossy(&started.stdout));
    let read = |name: &str| String::from_utf8(std::fs::read(at(name)).expect("a file")).expect("it is UTF-8");
    let measures = read("measures");
    let mut measures = measures.split(' ');
    let mut next = || measures.next().expect("four measures");
    let text = read("out") + &read("err");
    Ended {
        code: next().parse().ok(),
        codes: codes(&text),
        text,
        memory: next().parse().expect("bytes"),
        processor: next().parse().expect("seconds"),
    }
}

/// Runs the command of [`PLACE`], and writes its exit code, its greatest memory in bytes and its time of the processor in
/// seconds.
#[cfg(unix)]
#[test]
fn measured() {
    use std::fs::File;
    use wait4::Wait4;

    // It is started by the tests of hostile inputs, which name a folder.
    let Some(place) = std::env::var_os(PLACE).map(std::path::PathBuf::from) else { return };
    let words = std::fs::read_to_string(place.join("command")).expect("a command");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_modl"));
    command.args(words.split_whitespace()).env_remove("NO_COLOR").env_remove("COLUMNS");
    command.stdin(File::open(place.join("input")).expect("a file"));
    command.stdout(File::create(place.join("out")).expect("a file"));
    command.stderr(File::create(place.join("err")).expect("a file"));
    let used = command.spawn().expect("the command runs").wait4().expect("the command ends");
    let code = used.status.code().map_or("killed".to_owned(), |code| code.to_string());
    let processor = used.rusage.utime.as_secs_f64() + used.rusage.stime.as_secs_f64();
    std::fs::write(place.join("measures"), format!("{code} {} {processor}", used.rusage.maxrss))
        .expect("a file");
}

/// Returns the codes of errors that a text names, sorted, each once.
fn codes(text: &str) -> Vec<String> {
    let bytes = text.as_bytes();
    let is_code = |at: &usize| {
        let before = at.checked_sub(1).is_none_or(|before| !bytes[before].is_ascii_alphanumeric());
        let code = bytes.get(*at..at + 5).is_some_and(|code| code[1..].iter().all(u8::is_ascii_digit));
        before && code && bytes.get(at + 5).is_none_or(|after| !after.is_ascii_alphanumeric())
    };
    let found = text.match_indices('E').map(|(at, _)| at).filter(is_code);
    let mut codes: Vec<String> = found.map(|at| text[at..at + 5].to_owned()).collect();
    codes.sort();
    codes.dedup();
    codes
}

/// Returns the first lines of a text, for a report.
fn shortened(text: &str) -> String {
    text.lines().take(6).map(|line| line.chars().take(160).collect::<String>() + "\n").collect()
}

/// Runs all cases of a file, and fails with all that differ from what it says.
#[cfg(unix)]
fn run_file(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hostile").join(name);
    let text = std::fs::read_to_string(&path).expect("the cases are UTF-8");
    let mut report = String::new();
    let (mut memory, mut processor) = ((0, String::new()), (0.0, String::new()));
    for case in cases(&text) {
        let ended = run(&case);
        let mut wrong = Vec::new();
        if ended.code != Some(case.exit) {
            wrong.push(format!("exit code {:?}, not {}", ended.code, case.exit));
        }
        if ended.codes != case.codes {
            wrong.push(format!("codes {:?}, not {:?}", ended.codes, case.codes));
        }
        wrong.extend(
            case.says
                .iter()
                .filter(|words| !ended.text.contains(*words))
                .map(|words| format!("not said: {words}")),
        );
        if ended.memory > MEMORY_MAX {
            wrong.push(format!("{} MB of memory", ended.memory >> 20));
        }
        if ended.processor > PROCESSOR_MAX {
            wrong.push(format!("{:.2} s of the processor", ended.processor));
        }
        if !wrong.is_empty() {
            let (wrong, said) = (wrong.join("; "), shortened(&ended.text));
            writeln!(report, "{name}: {}: {wrong}\n{said}", case.name).expect("text grows");
        }
        if ended.memory > memory.0 {
            memory = (ended.memory, case.name.clone());
        }
        if ended.processor > processor.0 {
            processor = (ended.processor, case.name);
        }
    }
    println!(
        "{name}: at most {} MB ({}) and {:.2} s ({})",
        memory.0 >> 20,
        memory.1,
        processor.0,
        processor.1
    );
    assert!(report.is_empty(), "\n{report}");
}

#[cfg(unix)]
#[test]
fn hostile_texts_end_with_their_code() {
    run_file("texts.cases");
}

#[cfg(unix)]
#[test]
fn hostile_programs_end_with_their_code() {
    run_file("programs.cases");
}

#[cfg(unix)]
#[test]
fn hostile_files_end_with_their_code() {
    run_file("files.cases");
}
