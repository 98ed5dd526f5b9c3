//! Studies: what a row costs besides its own work, the memory of a long table, and two threads beside one.
//!
//! `cargo bench --bench studies` prints each as the median of five runs; the memory on Linux only.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

const RUNS: usize = 5;

/// The number of rows that cost next to nothing.
const TINY: usize = 100_000;

/// The number of rows of a large task.
const LARGE: usize = 8;

/// The command that does the work of large tasks without a study.
const PLAIN: &[&str] = &["run", "plain.mod", "--max-steps", "1000000000000"];

/// A study of tiny rows, one of rows of about a second, and the work of the second one without a study.
fn programs() -> (String, String) {
    let work = "fn calls(n: Int) -> Int = if n < 1 { 1 } else { calls(n - 1) + calls(n - 1) }\n";
    let study = format!(
        "{work}record Value {{ x: Number }}\nrecord Count {{ n: Int }}
study tiny(x in 0.0..1) by random({TINY}) = Value(x: 2 * x)
study large(i in 0..{LARGE}) by grid() = Count(n: calls(DEPTH) + i)\n"
    );
    let plain = format!("{work}for i in 0..{LARGE} {{ print(calls(DEPTH) + i) }}\n");
    (study, plain)
}

/// Runs the command in a folder, to its end. Returns the time, and the greatest resident memory in MB, 0 where unknown.
fn ran(folder: &Path, arguments: &[&str]) -> (Duration, f64) {
    let begun = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_modl"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("modl runs");
    let status = format!("/proc/{}/status", child.id());
    let (ended, running) = mpsc::channel::<()>();
    let watched = std::thread::spawn(move || {
        let mut most: f64 = 0.0;
        while running.recv_timeout(Duration::from_millis(1)) == Err(RecvTimeoutError::Timeout) {
            let text = std::fs::read_to_string(&status).unwrap_or_default();
            let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
            let kilobytes: Option<f64> = line.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
            most = most.max(kilobytes.unwrap_or(0.0) / 1e3);
        }
        most
    });
    assert!(child.wait().expect("the child can be waited for").success(), "{arguments:?}");
    let time = begun.elapsed();
    drop(ended);
    (time, watched.join().expect("the thread ends"))
}

/// Returns the median of the times of several runs in seconds, and the greatest memory.
fn median(folder: &Path, arguments: &[&str]) -> (f64, f64) {
    let mut runs: Vec<(f64, f64)> = (0..RUNS)
        .map(|_| {
            std::fs::remove_dir_all(folder.join("out")).ok();
            let (time, memory) = ran(folder, arguments);
            (time.as_secs_f64(), memory)
        })
        .collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    (runs[RUNS / 2].0, runs.iter().map(|run| run.1).fold(0.0, f64::max))
}

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path();
    let (study, plain) = programs();
    let write = |depth: usize| {
        let at = |text: &str| text.replace("DEPTH", &depth.to_string());
        std::fs::write(path.join("study.mod"), at(&study)).expect("the program is written");
        std::fs::write(path.join("plain.mod"), at(&plain)).expect("the program is written");
    };
    // The depth at which one row takes about a second.
    let mut depth = 12;
    let second = loop {
        write(depth);
        let time = ran(path, PLAIN).0.as_secs_f64() / LARGE as f64;
        if time > 0.6 {
            break time;
        }
        depth += 1;
    };
    println!("{LARGE} rows of about {second:.2} s");
    let (alone, _) = median(path, PLAIN);
    let (one, _) = median(path, &["study", "study.mod", "large", "--threads", "1"]);
    let (two, _) = median(path, &["study", "study.mod", "large", "--threads", "2"]);
    println!("  without a study {alone:7.2} s");
    println!("  one thread      {one:7.2} s, {:+.2} %", (one / alone - 1.0) * 100.0);
    println!("  two threads     {two:7.2} s, {:.2} x one", one / two);
    for threads in ["1", "2"] {
        let (time, memory) = median(path, &["study", "study.mod", "tiny", "--threads", threads]);
        let each = time / TINY as f64 * 1e6;
        println!("{TINY} rows, {threads} thread(s) {time:7.2} s, {each:.0} us a row, at most {memory:.0} MB");
    }
}
