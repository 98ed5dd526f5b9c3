//! How fast programs are read and checked: `cargo bench --bench front`. Prints the best of several
//! runs, in lines for each second. `parse`: text to tree. `types`: text to typed program. `check`: all
//! that `modl check` does, which also elaborates every declaration with its defaults.

mod generate;

use modl::check::check;
use modl::interpret::{Host, Mode, Options, WriteError};
use modl::source::{FileId, Files, ReadError};
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// As in the command.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const LINES: usize = 50_000;
const RUNS: usize = 10;

fn main() {
    let text = generate::program(LINES);
    let parsed = modl::syntax::parse(FileId(0), &text);
    assert!(parsed.diagnostics.is_empty(), "{:?}", parsed.diagnostics.first());
    println!("{} lines, {} bytes", text.lines().count(), text.len());
    report("parse", &text, || drop(modl::syntax::parse(FileId(0), &text)));
    let files = One(&text);
    let checked = check(&files, "main.mod");
    assert!(!checked.has_errors(), "{:?}", checked.diagnostics.first());
    report("types", &text, || drop(check(&files, "main.mod")));
    report("check", &text, || {
        let checked = check(&files, "main.mod");
        let outcome = modl::execute::run(&checked, Mode::Check, &files, &mut Silent, &Options::default());
        assert!(outcome.diagnostics.iter().all(|d| !d.is_error()), "{:?}", outcome.diagnostics.first());
    });
}

/// A project of one file, and the standard library.
struct One<'a>(&'a str);

impl Files for One<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, ReadError> {
        if path == "main.mod" { Ok(self.0.as_bytes().to_vec()) } else { Err(ReadError::NotFound) }
    }

    fn library(&self, path: &str) -> Option<Cow<'static, str>> {
        modl::source::library::text(path).map(Cow::Borrowed)
    }
}

struct Silent;

impl Host for Silent {
    fn print(&mut self, _: &str) {}

    fn write(&mut self, path: &str, _: &[u8]) -> Result<String, WriteError> {
        Ok(path.to_owned())
    }

    fn progress(&mut self, _: &str) {}
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
