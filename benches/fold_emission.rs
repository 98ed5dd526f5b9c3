//! Folding from the call to the plan file: layout with proof, order, motion, judgement, file.
//!
//! `cargo bench --bench fold_emission` prints a table: the whole run of a program that folds and emits, the
//! least of several runs; the judgement of its plan alone; the file's size.

use modl::check::check;
use modl::interpret::{Host, Mode, Options, WriteError};
use modl::plan::{file, verify};
use modl::source::{Files, ReadError};
use std::borrow::Cow;
use std::time::{Duration, Instant};

const RUNS: usize = 5;

const CASES: &[(&str, &str)] = &[
    ("octahedron", "fold(octahedron(edge: 80mm), module: Mori)"),
    ("quadruped", "fold(quadruped18(edge: 80mm), module: Mori)"),
    (
        "quadruped of 25 g panels, gravity",
        "fold(quadruped18(edge: 80mm), module: Mori(weight: 25g), gravity: on, root: 0)",
    ),
    ("icosahedron", "fold(icosahedron(edge: 80mm), module: Mori)"),
    ("stella octangula", "fold(stella_octangula(edge: 80mm), module: Mori)"),
    ("tube 6x3", "fold(tube(sides: 6, rings: 3, edge: 80mm), module: Mori)"),
    ("octahedron to boat", "refold(octahedron(edge: 80mm), boat(edge: 80mm), module: Mori)"),
    (
        "icosahedron to tube 5x2",
        "refold(icosahedron(edge: 80mm), tube(sides: 5, rings: 2, edge: 80mm), module: Mori)",
    ),
    (
        "icosahedron to tube 10x1",
        "refold(icosahedron(edge: 80mm), tube(sides: 10, rings: 1, edge: 80mm), module: Mori)",
    ),
];

fn main() {
    println!("| plan | panels | call to file | judgement alone | file | lasts |");
    println!("|---|---|---|---|---|---|");
    for (name, call) in CASES {
        let text = format!(
            "use std.mori.Mori\nuse std.shapes.{{octahedron, quadruped18, icosahedron, stella_octangula, tube, boat}}\n\
             let planned = {call}\nemit(planned, \"x.plan.json\")\n"
        );
        let files = One(&text);
        let mut host = Kept(Vec::new());
        let whole = least(|| {
            let checked = check(&files, "main.mod");
            let outcome = modl::execute::run(&checked, Mode::Run, &files, &mut host, &Options::default());
            assert!(outcome.diagnostics.iter().all(|d| !d.is_error()), "{:?}", outcome.diagnostics.first());
        });
        let plan = file::read(std::str::from_utf8(&host.0).expect("JSON is text")).expect("it reads back");
        let judged = least(|| assert!(verify::verify(&plan).ok()));
        let modl::plan::Body::Tracks(tracks) = &plan.body else { panic!("an articulated robot") };
        println!(
            "| {name} | {} | {whole:.2?} | {judged:.2?} | {:.0} kB | {:.1} s |",
            tracks.robot.modules.len(),
            host.0.len() as f64 / 1e3,
            plan.body.duration()
        );
    }
}

fn least(mut run: impl FnMut()) -> Duration {
    let timed = |_| {
        let start = Instant::now();
        run();
        start.elapsed()
    };
    (0..RUNS).map(timed).min().expect("there are runs")
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

/// What was written last.
struct Kept(Vec<u8>);

impl Host for Kept {
    fn print(&mut self, _: &str) {}

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<String, WriteError> {
        self.0 = bytes.to_vec();
        Ok(path.to_owned())
    }

    fn progress(&mut self, _: &str) {}
}
