//! How fast programs are read: `cargo bench --bench front`. Prints the best of several runs, in
//! lines for each second.

mod generate;

use modl::source::FileId;
use std::time::{Duration, Instant};

const LINES: usize = 50_000;
const RUNS: usize = 10;

fn main() {
    let text = generate::program(LINES);
    let parsed = modl::syntax::parse(FileId(0), &text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
    println!("{} lines, {} bytes", text.lines().count(), text.len());
    report("parse", &text, || drop(modl::syntax::parse(FileId(0), &text)));
}

fn report(what: &str, text: &str, run: impl Fn()) {
    let time = (0..RUNS).map(|_| timed(&run)).min().expect("there are runs");
    let lines = text.lines().count() as f64 / time.as_secs_f64();
    let bytes = text.len() as f64 / time.as_secs_f64();
    println!("{what}: {time:.1?}, {:.0} k lines/s, {:.1} MB/s", lines / 1e3, bytes / 1e6);
}

fn timed(run: impl Fn()) -> Duration {
    let start = Instant::now();
    run();
    start.elapsed()
}
